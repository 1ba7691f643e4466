#include "bench/compare/truth.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "analysis/error.hpp"
#include "bench/compare/errors.hpp"
#include "bench/compare/time_limit.hpp"
#include "bench/store/records.hpp"
#include "reference/agreement.hpp"
#include "reference/certificate.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double further = and_further_ones - 1;  // the first doubling was done

struct Size {
    int modes, points;  // points of a profile; 0: none, or they were asked for
    Size half() const { return {modes / 2, points / 2}; }
    Size twice() const { return {2 * modes, 2 * points}; }
    std::string text() const { return fmt::format("{} modes", modes) + (points > 0 ? fmt::format(" and {} points", points) : ""); }
};

// How many times longer than the closed forms of a lumped linear contact a reference takes for the same work, as measured on
// two_point_bridge and tanpura_c3_release: a contact that is integrated in steps, and a stiff integrator.
double dearness(const Descriptor& reference, const Scene& scene) {
    const Features needed = needed_by(scene);
    if (reference.name == std::string_view(sundials.name)) return 1000;
    return needed.has(Feature::power_law_contact) || needed.has(Feature::contact_loss) ? 10 : 1;
}

bool within_budget(const Descriptor& reference, const Scene& scene, const Size& s) {
    const double work = scene.duration * scene.strings.size() * s.modes * s.modes * (1 + s.points * s.points / 4.0);
    return s.points <= most_points && work * dearness(reference, scene) <= budget;
}

// Modes below 20 kHz, and the points that a reference takes unasked.
Size first_size(const Scene& scene, const OptionValues& options) {
    const bool asked = std::any_of(options.begin(), options.end(), [](const auto& o) { return o.first == std::string(nodes_option.name); });
    const bool profile = needed_by(scene).has(Feature::profile_barrier);
    return {modes_for(scene, {}), profile && !asked ? std::stoi(nodes_option.fallback) : 0};
}

ReferenceChoice sized(ReferenceChoice choice, const Size& s) {
    choice.settings.modes = s.modes;
    if (s.points > 0 && s.points != std::stoi(nodes_option.fallback))
        choice.settings.options.emplace_back(nodes_option.name, std::to_string(s.points));
    return choice;
}

double change(const Run& more, const Run& fewer, int tap, double until) {
    return relative_difference(fewer.trace.column(tap), more.trace.column(tap), more.trace.tap_rate, until);
}

// How far a model is solved is what the certificate of the modes below 20 kHz says; what it leaves out is what the last doubling changed.
trust::Trust trust_of(const trust::Trust& solved, const Run& more, const Run& fewer, const Size& of) {
    trust::Trust t = solved;
    if (!t.any()) t.figure.assign(static_cast<std::size_t>(more.trace.taps()), {0, 0, 0});
    const double until = static_cast<double>(std::min(more.trace.rows, fewer.trace.rows) - 1) / more.trace.tap_rate;
    t.left_out.assign(t.figure.size(), {});
    for (std::size_t k = 0; k < t.left_out.size(); ++k)
        for (std::size_t w = 0; w < t.left_out[k].size(); ++w) {
            const double end = std::array{10e-3, 50e-3, until}[w];
            t.left_out[k][w] =
                end > until + 1e-6 ? std::nan("") : further * change(more, fewer, static_cast<int>(k), w == 2 ? HUGE_VAL : end);
            if (std::isnan(t.figure[k][w])) t.figure[k][w] = 0;  // beyond the certificate: what was left out outweighs it
        }
    t.doubled = of.points > 0 ? "modes and points" : "modes";
    return t;
}
}  // namespace

Truth run_truth(const std::vector<ReferenceChoice>& choices, const Scene& scene, int modes, int jobs, const store::Listener& listener,
                double time_limit, const std::function<double(const Trace&)>& enough) {
    const bool find = modes == 0;
    std::vector<ReferenceChoice> first;
    for (const ReferenceChoice& c : choices)
        first.push_back(c.oversampled ? c : sized(c, {find ? first_size(scene, c.settings.options).modes : std::max(1, modes / 2), 0}));
    Truth truth{run_reference(first, scene, jobs, listener, time_limit), {}};
    if (truth.reference.choice.oversampled) {
        truth.said = "a stand-in, as it is: no modes to double";
        return truth;
    }
    const ReferenceChoice choice = truth.reference.choice;
    Settings certified = choice.settings;
    certified.modes = first_size(scene, choice.settings.options).modes;
    const trust::Trust solved = trust::trust_of(scene, choice.scheme->name, certified, scene.duration);
    const int tap = headline_of(scene).nut;
    const double window = headline_window(scene.duration);
    Size size{choice.settings.modes, find ? first_size(scene, choice.settings.options).points : 0};
    double moved_by = HUGE_VAL, may_move = settled;
    while (find ? moved_by >= may_move && within_budget(*choice.scheme, scene, size.twice()) : std::isinf(moved_by)) {
        Reference fewer = std::move(truth.reference);
        size = find ? size.twice() : Size{modes, 0};
        try {
            truth.reference = run_reference({sized(choice, size)}, scene, jobs, listener, time_limit);
        } catch (const BadScene&) {  // no string has as many, or there are no more that were measured
            truth.reference = std::move(fewer);
            size = size.half();
            break;
        }
        Run &more = truth.reference.run, &less = fewer.run;
        truth.reference.trust = trust_of(solved, more, less, size);
        moved_by = change(more, less, tap, window);
        if (enough) may_move = std::max(settled, enough(more.trace));
        truth.horizon = horizon(less.trace.column(tap), more.trace.column(tap), more.trace.tap_rate);
    }
    const std::string figure =
        fmt::format("{} over {}", scene.taps.at(tap).name, std::isinf(window) ? "the whole run" : fmt::format("{:.0f} ms", 1e3 * window));
    truth.said = size.text();
    if (!std::isinf(moved_by)) truth.said += fmt::format("; half of them change {} by {:.1e}", figure, moved_by);
    if (find && moved_by >= may_move)
        truth.said += fmt::format("; the budget of the reference ended the doubling{}",
                                  std::isinf(moved_by) ? " before it began" : fmt::format(" above {:.0e}", may_move));
    return truth;
}

}  // namespace jvari::bench::compare
