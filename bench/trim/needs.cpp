#include "bench/trim/needs.hpp"

#include <algorithm>
#include <cmath>

namespace jvari::bench::trim {

namespace {
constexpr int rounds_of_needs = 5;

Model turned_round(Model m, int k) {
    const auto at = std::ranges::find(m.left_out, k);
    if (at != m.left_out.end()) m.left_out.erase(at);
    else m.left_out.insert(std::ranges::lower_bound(m.left_out, k), k);
    return m;
}

double error_of(Judge& judge, const Model& m, const std::vector<int>& starts) {
    try {
        double worst = 0;
        for (const int s : starts) {
            const Verdict v = judge.verdict(m, s);
            if (v.status != "ok") return std::nan("");
            worst = std::max(worst, v.error);
        }
        return worst;
    } catch (const std::exception&) {  // what is left makes no scene
        return std::nan("");
    }
}
}  // namespace

std::vector<Need> needs_of(Judge& judge, const Model& whole, const Model& trimmed, const std::vector<int>& starts) {
    std::vector<Need> needs;
    std::vector<Model> timed{whole};
    std::vector<std::size_t> timed_needs;
    std::vector<bool> gone;  // from the whole model already: a tap that is not judged
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        if (!judge.may_go(k)) continue;
        const Reduction& r = judge.reductions()[k];
        const Model alone = turned_round(whole, k);
        Need n{r.key,
               r.becomes.empty() ? "left out" : r.becomes,
               error_of(judge, alone, starts),
               std::nan(""),
               std::nan(""),
               std::ranges::binary_search(trimmed.left_out, k),
               true};
        if (!std::isnan(n.error)) {
            n.needed = !std::ranges::all_of(starts, [&](int s) { return judge.within(judge.verdict(alone, s), s); });
            timed.push_back(alone);
            timed_needs.push_back(needs.size());
            gone.push_back(std::ranges::binary_search(whole.left_out, k));
        }
        n.error_in_trimmed = error_of(judge, turned_round(trimmed, k), starts);
        needs.push_back(n);
    }
    const std::vector<Spread> costs = judge.costs(timed, rounds_of_needs);
    for (std::size_t k = 0; k < timed_needs.size(); ++k) {
        const double whole_cost = costs[0].median, other = costs[k + 1].median;
        needs[timed_needs[k]].saved = gone[k] ? 1 - whole_cost / other : 1 - other / whole_cost;
    }
    return needs;
}

}  // namespace jvari::bench::trim
