// Contacts push and never pull, except by a loss: a Hunt-Crossley law may pull where the string leaves fast.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/check/judges.hpp"
#include "bench/study/summary.hpp"

namespace jvari::bench::check {

Verdict never_pulls(const Case& c) {
    const auto touches = [](const String& s) { return !s.barriers.empty(); };
    if (std::none_of(c.scene.strings.begin(), c.scene.strings.end(), touches)) return not_asked("the string touches nothing");
    if (needed_by(c.scene).has(Feature::contact_loss)) return not_asked("a contact with a loss may pull");
    Case one = c;
    one.scene.taps = {{"contact", Quantity::bridge_force, std::nullopt, 0}};
    const jvari::Run r = fresh(one, {});
    double least = study::fact(r.facts, facts::smallest_contact_force), largest = study::fact(r.facts, facts::largest_contact_force);
    for (const double force : r.trace.column(0)) {  // what it says of single steps and of their means has to be so
        least = std::fmin(least, force);
        largest = std::fmax(largest, force);
    }
    const double pull = study::pull_of(least, largest);
    return pull <= study::pull_allowed ? kept()
                                       : broken(fmt::format("pulls with {:.2g} N, and pushes with {:.2g} N at most", -least, largest));
}

}  // namespace jvari::bench::check
