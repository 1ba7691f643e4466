#include "bench/command/list_seam.hpp"

#include "bench/study/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

const char* name_of(Balance b) {
    return b == Balance::exact ? "exact" : b == Balance::to_tolerance ? "to tolerance" : "none";
}

std::vector<std::string> approximations_of(const Descriptor& d, const char* quote) {  // "damping (fact start_phase_error)"
    std::vector<std::string> all;
    for (const Approximation& a : d.approximates)
        all.push_back(fmt::format("{} (fact {}{}{})", jvari::name_of(a.feature), quote, a.fact.name, quote));
    return all;
}

// ---- Options, the same one of several schemes together.

struct Listed {
    const Option* option;
    std::vector<std::string> schemes;
};

bool same(const Option& a, const Option& b) {
    const auto x = a.words(), y = b.words();
    return std::string(a.name) == b.name && std::string(a.fallback) == b.fallback && std::string(a.meaning) == b.meaning &&
           std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const std::string& p, const std::string& q) { return p == q; });
}

std::vector<Listed> options_of(const compare::Catalogue& catalogue) {
    std::vector<Listed> all;
    for (const auto* list : {&catalogue.schemes, &catalogue.references})
        for (const Descriptor* d : *list)
            for (const Option& o : d->options) {
                const auto known = std::find_if(all.begin(), all.end(), [&o](const Listed& l) { return same(*l.option, o); });
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
    return o.words().empty() ? o.meaning : fmt::format("{}; one of {}", o.meaning, fmt::join(o.words(), ", "));
}
}  // namespace

Listing list_descriptors(const char* title, const std::vector<const Descriptor*>& list) {
    Json json = Json::array();
    std::size_t width = 0;
    for (const Descriptor* d : list) width = std::max(width, std::string(d->name).size());
    std::string text = fmt::format("{}\n", title), head = "| scheme | several strings | body |", rule = "|---|:-:|:-:|", body, notes;
    for (int i = 0; i < feature_count; ++i) {
        head += fmt::format(" {} |", jvari::name_of(static_cast<Feature>(1u << i)));
        rule += ":-:|";
    }
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
                        {"limit", d->limit.name ? Json(d->limit.name) : Json()},
                        {"balance", name_of(d->balance)},
                        {"clock", d->clock == Clock::continuous ? "continuous" : "stepped"}});

        text += fmt::format("  {:<{}}  {}\n  {:<{}}  energy balance {}{}; represents {}\n", d->name, width, d->source, "", width,
                            name_of(d->balance), d->clock == Clock::continuous ? "; continuous time" : "",
                            fmt::join(compare::names_in(d->represents - not_quite), ", "));
        if (!not_quite.empty()) text += fmt::format("  {:<{}}  approximates {}\n", "", width, fmt::join(approximations_of(*d, ""), ", "));
        if (!note.empty()) text += fmt::format("  {:<{}}  {}\n", "", width, note);

        body += fmt::format("| `{}` | ● | ● |", d->name);  // each string is a scheme of its own, a body filters what they give
        for (int i = 0; i < feature_count; ++i) {
            const auto feature = static_cast<Feature>(1u << i);
            body += not_quite.has(feature) ? " ◐ |" : d->represents.has(feature) ? " ● |" : "  |";
        }
        body += fmt::format(" {} | {} |\n", name_of(d->balance), d->source);
        if (!not_quite.empty() || !note.empty())
            notes += fmt::format("- `{}`:{}{}\n", d->name,
                                 not_quite.empty() ? "" : fmt::format(" ◐ {}.", fmt::join(approximations_of(*d, "`"), ", ")),
                                 note.empty() ? "" : " " + note);
    }
    return {json.dump(), text + (list.empty() ? "  none\n" : ""),
            head + " energy balance | source |\n" + rule + "---|---|\n" + body +
                "\n● as the scene says; ◐ changed, at any rate and with any number of modes, and a fact of the run says how.\n\n" + notes};
}

Listing list_options(const compare::Catalogue& catalogue) {
    Json json = Json::array();
    std::string text = "options\n", markdown = "| option | default | meaning | schemes |\n|---|---|---|---|\n";
    for (const Listed& l : options_of(catalogue)) {
        const Option& o = *l.option;
        json.push_back(
            {{"name", o.name}, {"default", o.fallback}, {"meaning", o.meaning}, {"choices", words_of(o)}, {"schemes", l.schemes}});
        text += fmt::format("  {:<16}{:<10}{}\n  {:<26}{}\n", o.name, o.fallback, meaning_of(o), "", fmt::join(l.schemes, ", "));
        std::vector<std::string> quoted;
        for (const std::string& name : l.schemes) quoted.push_back("`" + name + "`");
        markdown += fmt::format("| `{}` | {} | {} | {} |\n", o.name, o.fallback, meaning_of(o), fmt::join(quoted, ", "));
    }
    return {json.dump(), text, markdown};
}

Listing list_facts() {
    Json json = Json::array();
    std::string text = "facts\n", markdown = "| fact | unit | meaning |\n|---|---|---|\n";
    for (const FactName& f : facts::table) {
        json.push_back({{"name", f.name}, {"unit", f.unit}, {"meaning", f.meaning}});
        text += fmt::format("  {:<28}{:<7}{}\n", f.name, f.unit, f.meaning);
        markdown += fmt::format("| `{}` | {} | {} |\n", f.name, f.unit, f.meaning);
    }
    return {json.dump(), text, markdown};
}

Listing list_columns() {
    struct Line {
        std::string names;
        std::string unit, meaning;
    };
    std::vector<Line> lines;
    for (const study::Column& c : study::columns()) {
        std::string name = c.name;
        if (name == "{m}") {
            for (const study::Measure& m : study::measures()) lines.push_back({"`" + m.column + "`", m.unit, m.title});
            continue;
        }
        for (const auto& [slot, word] : {std::pair{"{m}", "<error>"},
                                         {"{d}", "<error>"},
                                         {"{M}", "<error_in_model>"},
                                         {"{w}", "<window>"},
                                         {"{f}", "<fact>"},
                                         {"{t}", "<tap>"}})
            if (const auto at = name.find(slot); at != std::string::npos) name.replace(at, 3, word);
        if (*c.meaning) lines.push_back({"`" + name + "`", c.unit, c.meaning});
        else lines.back().names += ", `" + name + "`";
    }
    Json json = Json::array();
    std::string text = "columns\n", markdown = "| column | unit | meaning |\n|---|---|---|\n";
    for (const Line& l : lines) {
        std::string names = l.names;
        std::erase(names, '`');
        json.push_back({{"name", names}, {"unit", l.unit}, {"meaning", l.meaning}});
        text += fmt::format("  {:<28}{:<7}{}\n", names, l.unit, l.meaning);
        markdown += fmt::format("| {} | {} | {} |\n", l.names, l.unit, l.meaning);
    }
    return {json.dump(), text, markdown};
}

}  // namespace jvari::bench::command
