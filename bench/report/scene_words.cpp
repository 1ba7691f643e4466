// Words about a scene that the page shows: the units of its numbers, and what its taps measure.
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <variant>

#include "bench/report/report.hpp"
#include "scenes/document.hpp"
#include "scenes/schema.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

struct Units : Pass<Units> {  // visits every alternative of every part
    Json all = Json::object();

    void number(const char* key, const auto&, const Range&, const std::string& unit, auto&&...) {
        const char* start = path.ends_with("velocity") ? "m/s" : "m";
        if (!unit.empty()) all[at(key)] = unit == "m or m/s" ? start : unit;
    }
    void stiffness(const char* key, const auto&, const char* unit) { all[at(key)] = unit; }
    void tension(const auto&) { all[at("tension")] = "N"; }
    void one_of(const char*, auto& variant, auto&&...) { each(variant); }
    template <class... Parts>
    void each(const std::variant<Parts...>&) {
        const auto visit = [this](auto... parts) { (fields(*this, parts), ...); };
        visit(Parts{}...);
    }
    template <class Part>
    void part(const char* key, Part& p) {
        if constexpr (requires { p.has_value(); }) {
            typename Part::value_type one{};
            part(key, one);
        } else {
            Pass<Units>::part(key, p);
        }
    }
    template <class Part>
    void parts(const char* key, std::vector<Part>&) {
        Part one{};
        part(key, one);
    }
};

template <class T>
const T& content(const Value& table, const char* key) {
    const Value* found = table.find(key);
    return found ? std::get<T>(found->content) : throw std::out_of_range(key);
}
}  // namespace

Json units() {
    Units units;
    Scene any;
    fields(units, any);
    units.all["rate"] = "Hz";
    return units.all;
}

Json quantities_in(const Json& manifest) {
    Json all = Json::object(), scenes = manifest.value("scenes", Json::object());
    if (const auto scene = manifest.find("scene"); scene != manifest.end())
        scenes[scene->value("name", "")] = scene->value("text", "");
    for (const auto& [name, toml] : scenes.items()) try {
            const Document document = parse_document(toml.get<std::string>(), name, {});
            for (const Value& tap : content<Array>(document.root, "tap"))
                all[name][content<std::string>(tap, "name")] =
                    content<std::string>(tap, "quantity");
        } catch (const std::exception&) {  // somebody edited the manifest
        }
    return all;
}

}  // namespace jvari::bench::report
