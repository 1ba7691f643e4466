#include "bench/command/list/list_keys.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/suite/facet.hpp"
#include "bench/suite/suite_file.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

struct Writer {  // a line for each key, those of inner tables behind a dot
    std::string text;

    Json table(const std::vector<store::KeyWords>& keys, const std::string& within = "") {
        Json all = Json::array();
        for (const store::KeyWords& k : keys) {
            const std::string beside = k.needed           ? "; needed"
                                       : k.absent.empty() ? ""
                                                          : "; absent: " + k.absent;
            text += fmt::format("  {:<22}{}: {}{}\n", within + k.name, k.value, k.meaning, beside);
            Json one{{"key", k.name},
                     {"value", k.value},
                     {"needed", k.needed},
                     {"absent", k.absent},
                     {"meaning", k.meaning}};
            if (!k.below.empty()) one["keys"] = table(k.below, within + k.name + ".");
            all.push_back(std::move(one));
        }
        return all;
    }
};
}  // namespace

Listing list_keys() {
    Writer w;
    Json json = Json::object();
    for (const suite::TableWords& t : suite::suite_keys()) {
        w.text += t.table.empty() ? "keys of a suite file\n" : "[[" + t.table + "]]\n";
        json[t.table.empty() ? "file" : t.table] = w.table(t.keys);
    }
    w.text += "measure\n";
    for (const suite::Facet& f : suite::facets()) {
        w.text += fmt::format("  {:<22}{}\n", f.name, f.meaning);
        json["measure"].push_back({{"name", f.name}, {"meaning", f.meaning}});
    }
    return {std::move(json), w.text};
}

}  // namespace jvari::bench::command
