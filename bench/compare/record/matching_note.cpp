#include "bench/compare/record/matching_note.hpp"

#include <fmt/core.h>

#include "schemes/contact/matching_facts.hpp"

namespace jvari::bench::compare {

std::string matching_note(const store::Table& t) {
    std::string text;
    for (const MatchingLimit& limit : matching_limits) {
        const std::string name = limit.fact.name;
        double most = limit.most;
        std::string loudest;
        for (const std::string& column : t.columns) {
            if (!column.starts_with("fact_") || !column.ends_with(name)) continue;  // with several strings string.<k>. stands between
            for (std::size_t i = 0; i < t.rows.size(); ++i) {
                if (!(t.number(i, column) > most)) continue;
                most = t.number(i, column);
                loudest = store::variant_name(t.at(i, "scheme"), t.at(i, "options")) + " at " + t.at(i, "rate") + " Hz";
            }
        }
        if (loudest.empty()) continue;
        text += fmt::format(
            "{}compliance=matched may be less accurate here than own: {}\n    ({} {:.2g} with {}; above {:.2g} it counts). "
            "Compare with compliance=own.",
            text.empty() ? "" : "\n", limit.cause, name, most, loudest, limit.most);
    }
    return text;
}

}  // namespace jvari::bench::compare
