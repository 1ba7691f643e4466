#include "bench/command/list/list_keys.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/suite/facet.hpp"
#include "bench/suite/suite_file.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

struct Writer {  // one form for each key, those of inner tables behind a dot
    std::string text, markdown;

    Json table(const std::vector<store::KeyWords>& keys, const std::string& within = "") {
        Json all = Json::array();
        for (const store::KeyWords& k : keys) {
            const std::string absent = k.needed ? "needed" : k.absent, beside = absent.empty() ? "" : "; absent: " + absent;
            text += fmt::format("  {:<22}{}: {}{}\n", within + k.name, k.value, k.meaning, k.needed ? "; needed" : beside);
            markdown += fmt::format("| `{}{}` | {} | {} | {} |\n", within, k.name, k.value, absent, k.meaning);
            Json one{{"key", k.name}, {"value", k.value}, {"needed", k.needed}, {"absent", k.absent}, {"meaning", k.meaning}};
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
        w.markdown += (t.table.empty() ? "Of the file:" : "Of `[[" + t.table + "]]`:") +
                      std::string("\n\n| key | value | absent | meaning |\n|---|---|---|---|\n");
        json[t.table.empty() ? "file" : t.table] = w.table(t.keys);
        w.markdown += '\n';
    }
    w.text += "measure\n";
    w.markdown += "What a set can `measure`:\n\n| measure | of a cell |\n|---|---|\n";
    for (const suite::Facet& f : suite::facets()) {
        w.text += fmt::format("  {:<22}{}\n", f.name, f.meaning);
        w.markdown += fmt::format("| `{}` | {} |\n", f.name, f.meaning);
        json["measure"].push_back({{"name", f.name}, {"meaning", f.meaning}});
    }
    return {std::move(json), w.text, w.markdown};
}

}  // namespace jvari::bench::command
