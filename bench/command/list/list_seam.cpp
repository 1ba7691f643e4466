#include "bench/command/list/list_seam.hpp"

#include "bench/compare/catalogue.hpp"
#include "bench/study/columns.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "schemes/controls.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

const char* name_of(Balance b) {
    return b == Balance::exact ? "exact" : b == Balance::to_tolerance ? "to tolerance" : "none";
}

// "damping (fact start_phase_error)"
std::vector<std::string> approximations_of(const Descriptor& d) {
    std::vector<std::string> all;
    for (const Approximation& a : d.approximates)
        all.push_back(fmt::format("{} (fact {})", jvari::name_of(a.feature), a.fact.name));
    return all;
}

// ---- Options, the same one of several schemes together.

struct Listed {
    const Option* option;
    std::vector<std::string> schemes;
};

bool same(const Option& a, const Option& b) {
    const auto x = a.words(), y = b.words();
    return std::string(a.name) == b.name && std::string(a.fallback) == b.fallback &&
           std::string(a.meaning) == b.meaning &&
           std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [](const std::string& p, const std::string& q) { return p == q; });
}

std::vector<Listed> options_of(const std::vector<const Descriptor*>& schemes) {
    std::vector<Listed> all;
    for (const Descriptor* d : schemes)
        for (const Option& o : d->options) {
            const auto known = std::find_if(all.begin(), all.end(),
                                            [&o](const Listed& l) { return same(*l.option, o); });
            if (known != all.end()) known->schemes.emplace_back(d->name);
            else all.push_back({&o, {d->name}});
        }
    return all;
}

std::vector<std::string> words_of(const Option& o) {
    const auto words = o.words();
    return {words.begin(), words.end()};
}

std::string meaning_of(const Option& o) {
    return o.words().empty() ? o.meaning
                             : fmt::format("{}; one of {}", o.meaning, fmt::join(o.words(), ", "));
}
}  // namespace

Listing list_descriptors(const char* title, const std::vector<const Descriptor*>& list) {
    Json json = Json::array();
    std::size_t width = 0;
    for (const Descriptor* d : list) width = std::max(width, std::string(d->name).size());
    std::string text = fmt::format("{}\n", title);
    for (const Descriptor* d : list) {
        const std::string note = d->note;
        const Features not_quite = approximated(*d);
        Json approximates = Json::array(), options = Json::array();
        for (const Approximation& a : d->approximates)
            approximates.push_back({{"feature", jvari::name_of(a.feature)}, {"fact", a.fact.name}});
        for (const Option& o : d->options) options.push_back(o.name);
        json.push_back({{"name", d->name},
                        {"source", d->source},
                        {"represents", compare::names_in(d->represents)},
                        {"approximates", approximates},
                        {"note", note},
                        {"options", options},
                        {"control", is_control(*d)},
                        {"limit", d->limit.name ? Json(d->limit.name) : Json()},
                        {"balance", name_of(d->balance)},
                        {"clock", d->clock == Clock::continuous ? "continuous" : "stepped"}});

        text += fmt::format("  {:<{}}  {}\n  {:<{}}  energy balance {}{}; represents {}\n", d->name,
                            width, d->source, "", width, name_of(d->balance),
                            d->clock == Clock::continuous ? "; continuous time" : "",
                            fmt::join(compare::names_in(d->represents - not_quite), ", "));
        if (!not_quite.empty())
            text += fmt::format("  {:<{}}  approximates {}\n", "", width,
                                fmt::join(approximations_of(*d), ", "));
        if (!note.empty()) text += fmt::format("  {:<{}}  {}\n", "", width, note);
    }
    return {std::move(json), text + (list.empty() ? "  none\n" : "")};
}

Listing list_pairings() {
    std::size_t width = 0;
    for (const Pairing& p : pairings()) width = std::max(width, std::string(p.rule).size());
    Json json = Json::array();
    std::string text = "pairings of a string and an obstacle rule\n", string;
    for (const Pairing& p : pairings()) {
        json.push_back(
            {{"string", p.string}, {"rule", p.rule}, {"scheme", p.scheme}, {"options", p.options}});
        if (p.string != string) text += fmt::format("  {}\n", string = p.string);
        text += fmt::format("    {:<{}}  {}{}{}\n", p.rule, width, p.scheme,
                            p.options.empty() ? "" : " ", p.options);
    }
    return {std::move(json), text};
}

Listing list_options(const std::vector<const Descriptor*>& schemes) {
    Json json = Json::array();
    std::string text = "options\n";
    for (const Listed& l : options_of(schemes)) {
        const Option& o = *l.option;
        json.push_back({{"name", o.name},
                        {"default", o.fallback},
                        {"meaning", o.meaning},
                        {"choices", words_of(o)},
                        {"schemes", l.schemes}});
        text += fmt::format("  {:<16}{:<10}{}\n  {:<26}{}\n", o.name, o.fallback, meaning_of(o), "",
                            fmt::join(l.schemes, ", "));
    }
    return {std::move(json), text};
}

Listing list_measured(const char* title, int name_width, int unit_width,
                      const std::vector<Measured>& all) {
    Json json = Json::array();
    std::string text = fmt::format("{}\n", title);
    // one name, or several with a comma between them
    for (const auto& [names, unit, meaning] : all) {
        json.push_back({{"name", names}, {"unit", unit}, {"meaning", meaning}});
        text += fmt::format("  {:<{}}{:<{}}{}\n", names, name_width, unit, unit_width, meaning);
    }
    return {std::move(json), text};
}

Listing list_facts() {
    std::vector<Measured> all;
    for (const FactName& f : facts::table) all.push_back({f.name, f.unit, f.meaning});
    all.push_back({"largest_over_bound", "",
                   "largest value of a tap over what the energy of the scene can make of it [1]; a "
                   "run beyond the root of ten has diverged"});
    return list_measured("facts", 28, 7, all);
}

Listing list_columns() {
    std::vector<Measured> all;
    for (const study::Column& c : study::columns()) {
        std::string name = c.name;
        if (name == "{m}") {
            for (const study::Measure& m : study::measures())
                all.push_back({m.column, m.unit, m.title});
            continue;
        }
        for (const auto& [slot, word] : {std::pair{"{m}", "<error>"},
                                         {"{d}", "<error>"},
                                         {"{M}", "<error_in_model>"},
                                         {"{w}", "<window>"},
                                         {"{f}", "<fact>"},
                                         {"{t}", "<tap>"}})
            if (const auto at = name.find(slot); at != std::string::npos) name.replace(at, 3, word);
        if (*c.meaning) all.push_back({name, c.unit, c.meaning});
        else all.back().name += ", " + name;
    }
    return list_measured("columns", 28, 7, all);
}

Listing list_taps() {
    constexpr std::pair<Quantity, const char*> taps[] = {
        {Quantity::displacement, "of the string at a place, positive away from the barrier"},
        {Quantity::velocity, "of the string at a place"},
        {Quantity::nut_force,
         "of the string on its end at x = length, which on a guitar is the saddle"},
        {Quantity::bridge_force, "of the barriers on the string, the mean over a row"},
        {Quantity::thread_force, "of the thread on the string, the mean over a row"},
        {Quantity::driving_force,
         "-(bridge_force + thread_force): of the string on what it touches"}};
    std::vector<Measured> all;
    for (const auto& [q, meaning] : taps) all.push_back({jvari::name_of(q), unit_of(q), meaning});
    return list_measured("taps", 14, 5, all);
}

}  // namespace jvari::bench::command
