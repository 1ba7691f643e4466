#include "bench/study/truth.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>
#include <string_view>

#include "analysis/error.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/errors.hpp"
#include "reference/agreement.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::study {

namespace {
constexpr int most_modes_found = 4096;
constexpr std::array windows = {10e-3, 50e-3, HUGE_VAL};  // [s], those of Trust
// Windows of the exact solution are as short as the fastest mode asks. On a string whose modes lie
// this far apart [Hz], or less, the work of `modes^2` takes the time that `budget` says; on a
// shorter or stiffer one, that of modes times the highest frequency over this.
constexpr double mode_spacing = 500;
// [s] that the doublings take together, and at most as long again for own modes beside them
constexpr double patience = 60;

struct Size {
    int modes, points;  // points of a profile; 0: none, or they were asked for
    Size twice(int most) const { return {std::min(2 * modes, most), 2 * points}; }
    bool operator==(const Size&) const = default;
    std::string text() const {
        return fmt::format("{} modes", modes) +
               (points > 0 ? fmt::format(" and {} points", points) : "");
    }
};

// How many times longer than the closed forms of a lumped linear contact a reference takes for the
// same work, as measured on two_point_bridge and tanpura_c3_release: a contact that is integrated
// in steps, and a stiff integrator. Points as on sitar_parabola.
double dearness(const Descriptor& reference, const Scene& scene) {
    const Features needed = needed_by(scene);
    if (reference.name == std::string_view(sundials.name)) return 1000;
    return needed.has(Feature::power_law_contact) || needed.has(Feature::contact_loss) ? 10 : 1;
}

bool within_budget(const Descriptor& reference, const Scene& scene, const Size& s) {
    std::size_t contacts = 2;  // the closed forms take two alike
    for (const String& string : scene.strings)
        contacts = std::max(contacts, string.barriers.size() + string.masses.size());
    const double coupled = s.points > 0 ? s.points : static_cast<double>(contacts - 2);
    const int size = std::max(s.modes, s.points);  // few measured modes may lie under many points
    double work = 0;
    for (const String& string : scene.strings) {
        const int modes = std::min(s.modes, modes_measured(string).value_or(s.modes));
        const double highest = modes_of(string, modes).omega0.back() / (2 * std::numbers::pi);
        work += scene.duration * size * std::max<double>(size, highest / mode_spacing) *
                (1 + 2.5 * coupled);
    }
    return s.points <= most_points && s.modes <= most_modes_found &&
           work * dearness(reference, scene) <= budget;
}

// Of a scene whose strings are tables of measured modes: those tables are the strings, and no
// further mode is left out of them.
std::optional<int> measured(const Scene& scene) {
    std::optional<int> all;
    for (const String& s : scene.strings) {
        const auto modes = modes_measured(s);
        if (!modes) return {};
        all = std::min(all.value_or(*modes), *modes);
    }
    return all;
}

// Modes below 20 kHz, or all that were measured, and the points that a reference takes unasked.
Size first_size(const Scene& scene, const OptionValues& options) {
    const bool asked = std::any_of(options.begin(), options.end(), [](const auto& o) {
        return o.first == std::string(nodes_option.name);
    });
    const bool profile = needed_by(scene).any(any_profile);
    return {measured(scene).value_or(modes_for(scene, {})),
            profile && !asked ? std::stoi(nodes_option.fallback) : 0};
}

ReferenceChoice sized(ReferenceChoice choice, const Size& s) {
    choice.settings.modes = s.modes;
    if (s.points > 0 && s.points != std::stoi(nodes_option.fallback))
        choice.settings.options.emplace_back(nodes_option.name, std::to_string(s.points));
    return choice;
}

double change(const Trace& more, const Trace& fewer, int tap, double from, double window) {
    const double rate = more.tap_rate;
    return relative_difference(rows_from(fewer.column(tap), from, rate),
                               rows_from(more.column(tap), from, rate), rate, window);
}

// How far the model is solved is what its certificate says, else its noise floor: an error of
// rounding grows like a change of the start. What the model leaves out is what is left after the
// doublings.
Trust trust_of(const Trust& solved, const Truth& truth, const Size& of, double from) {
    Trust t = solved;
    const Reference &last = truth.reference, &before = truth.coarser.back();
    const Trace &more = last.run.trace, &fewer = before.run.trace;
    const auto taps = static_cast<std::size_t>(more.taps());
    if (!t.any()) t.figure.assign(taps, {nan, nan, nan});
    const double until =
        static_cast<double>(std::min(more.rows, fewer.rows) - 1) / more.tap_rate - from;
    t.left_out.assign(taps, {nan, nan, nan});
    for (std::size_t k = 0; k < taps; ++k)
        for (std::size_t w = 0; w < windows.size(); ++w) {
            const double end = windows[w];
            if (w < 2 && end > until + 1e-6) continue;
            const auto apart = [&](const Trace& a, const Trace& b) {
                return change(b, a, static_cast<int>(k), from, end);
            };
            // beyond the certificate, too
            if (std::isnan(t.figure[k][w])) t.figure[k][w] = apart(more, last.moved.trace);
            t.left_out[k][w] = left_out(truth, apart, t.figure[k][w]);
        }
    t.doubled = of.points == 0                                               ? "modes"
                : last.choice.settings.modes == before.choice.settings.modes ? "points"
                                                                             : "modes and points";
    return t;
}

// Own modes beside a matched reference: extrapolated from as many, and from half as many.
std::vector<Trace> own_motion(const ReferenceChoice& matched, const Scene& scene, const Size& size,
                              int jobs, const store::Listener& listener, double time_limit) {
    ReferenceChoice own = matched;
    std::erase_if(own.settings.options,
                  [](const auto& o) { return o.first == compliance_option.name; });
    std::vector<Trace> runs, result;
    for (int part = 1; part <= 4; part *= 2) {
        if (size.modes / part < 1) return {};
        own.settings.modes = size.modes / part;
        runs.push_back(run_reference({own}, scene, jobs, listener, time_limit, true).run.trace);
    }
    for (std::size_t k = 0; k < 2; ++k) {
        Trace& t = result.emplace_back(runs[k]);
        t.rows = std::min(runs[k].rows, runs[k + 1].rows);
        for (int tap = 0; tap < t.taps(); ++tap)
            std::ranges::copy(extrapolated(runs[k].column(tap), runs[k + 1].column(tap)),
                              t.tap.begin() + tap * t.stride);
    }
    return result;
}

// What another solver makes of the same modes: how far a table of modes is solved. Over 50 ms where
// the whole would take it too long.
void confirm(Reference& r, Scene scene, const Size& size, int jobs, const store::Listener& listener,
             double time_limit) {
    if (r.trust.any() || r.choice.scheme->name == std::string_view(sundials.name) ||
        !represents(sundials, scene))
        return;
    const double from = free_from(scene);
    if (!within_budget(sundials, scene, size))
        scene.duration = std::min(scene.duration, from + 50e-3);
    if (!within_budget(sundials, scene, size)) return;
    ReferenceChoice other = sized(r.choice, size);
    other.scheme = &sundials;
    std::erase_if(other.settings.options,
                  [](const auto& o) { return o.first != std::string(nodes_option.name); });
    const Run run = run_reference({other}, scene, jobs, listener, time_limit, true).run;
    const double until = static_cast<double>(run.trace.rows - 1) / run.trace.tap_rate - from;
    const bool whole = run.trace.rows == r.run.trace.rows;
    for (int k = 0; k < run.trace.taps(); ++k) {
        auto& figure = r.trust.figure.emplace_back();
        for (std::size_t w = 0; w < figure.size(); ++w) {
            const double end = windows[w];
            const bool covered = w == 2 ? whole : end <= until + 1e-6;
            figure[w] = covered ? change(r.run.trace, run.trace, k, from, end) : nan;
        }
    }
    r.trust.against = sundials.name;
    r.trust.missing.clear();
}
}  // namespace

double left_out(const Truth& t, const Apart& apart, double solved_to) {
    std::vector<double> changes;
    for (std::size_t n = 0; n < t.coarser.size(); ++n)
        changes.push_back(
            apart(t.coarser[n].run.trace,
                  (n + 1 < t.coarser.size() ? t.coarser[n + 1] : t.reference).run.trace));
    if (changes.empty()) return nan;
    double left = left_after(changes, t.matched);
    // what is no more than either is solved to does not grow
    if (std::isnan(left) && changes.back() <= solved_to)
        left = left_after({&changes.back(), 1}, t.matched);
    return t.own.empty()
               ? left
               : no_less(left, apart(t.own[0], t.reference.run.trace), apart(t.own[1], t.own[0]));
}

Truth run_truth(const std::vector<ReferenceChoice>& choices, const Scene& scene, int modes,
                int jobs, const store::Listener& listener, double time_limit) {
    const bool find = modes == 0;
    std::vector<ReferenceChoice> first;
    for (const ReferenceChoice& c : choices) {
        const Size size{find ? first_size(scene, c.settings.options).modes : std::max(1, modes / 4),
                        0};
        if (const auto nearer =
                c.oversampled ? std::nullopt : matched(*c.scheme, scene, c.settings.options)) {
            first.push_back(sized(c, size));
            first.back().settings.options = *nearer;
        }
        first.push_back(c.oversampled ? c : sized(c, size));
    }
    Truth truth;
    truth.reference = run_reference(first, scene, jobs, listener, time_limit);
    if (truth.reference.choice.oversampled) {
        truth.description = "a stand-in, as it is: no modes to double";
        return truth;
    }
    const ReferenceChoice choice = truth.reference.choice;
    Settings certified = choice.settings;
    certified.modes = first_size(scene, choice.settings.options).modes;
    const Trust solved = trust_of(scene, choice.scheme->name, certified, scene.duration);
    const int tap = headline_of(scene).nut;
    const double from = free_from(scene), end = headline_window(scene);
    const std::size_t window = std::isinf(end) ? 2 : end >= 50e-3 ? 1 : 0;
    truth.matched =
        is_matched(choice.settings.options) || needed_by(scene).has(Feature::rigid_barrier);
    Size size{choice.settings.modes, find ? first_size(scene, choice.settings.options).points : 0};
    double unsettled = HUGE_VAL;  // by what is left out of the headline figure
    double spent = truth.reference.run.wall_seconds;
    const int all = find ? measured(scene).value_or(0) : 0;  // that were measured; 0: no table
    const int most = all > 0 ? all : 2 * most_modes_found;
    const auto next = [&] {
        return find ? size.twice(most) : Size{size.modes < modes / 2 ? modes / 2 : modes, 0};
    };
    const auto judge = [&] {
        truth.reference.trust = trust_of(solved, truth, size, from);
        unsettled = truth.reference.trust.left_out[static_cast<std::size_t>(tap)][window];
        const Trace &finer = truth.reference.run.trace, &fewer = truth.coarser.back().run.trace;
        const auto free = [&](const Trace& t) {
            return rows_from(t.column(tap), from, t.tap_rate);
        };
        truth.horizon = horizon(free(fewer), free(finer), finer.tap_rate);
    };
    while (find ? !(unsettled < settled) && next() != size &&
                      within_budget(*choice.scheme, scene, next())
                : size.modes < modes) {
        Reference more;
        const double left = patience - spent;
        if (find && left <= 0) break;
        try {
            more = run_reference({sized(choice, next())}, scene, jobs, listener,
                                 find ? std::min(time_limit, left) : time_limit);
            spent += more.run.wall_seconds;
        } catch (const store::PastItsLimit&) {
            // the best so far is the answer, with the bound that it has
            if (!find || time_limit <= left) throw;
            break;
        } catch (const BadScene&) {
            // no string has as many, or there are no more that were measured
            break;
        } catch (const Refusal&) {
            // these are all that were measured: nothing is left out that could be matched
            break;
        }
        size = next();
        truth.coarser.push_back(std::move(truth.reference));
        truth.reference = std::move(more);
        judge();
    }
    // without a doubling: by a certificate, or not at all
    const auto unknown = [&] {
        const Trust& t = truth.reference.trust;
        return truth.coarser.empty() &&
               std::isnan(t.of_scene(static_cast<std::size_t>(tap), window));
    };
    // where even one doubling takes too long, half as many tell something, too
    const Size half{all > 0 ? size.modes : size.modes / 2, size.points / 2};
    if (find && unknown() && half.modes > 0 && half != size) try {
            truth.coarser.push_back(
                run_reference({sized(choice, half)}, scene, jobs, listener, time_limit));
            judge();
        } catch (const Refusal&) {}
    if (!truth.coarser.empty() && is_matched(choice.settings.options)) {
        try {
            truth.own = own_motion(choice, scene, size, jobs, listener,
                                   find ? std::min(time_limit, patience) : time_limit);
        } catch (const store::PastItsLimit&) {  // without it the doublings alone tell
        } catch (const Refusal&) {}
        if (!truth.own.empty()) truth.reference.trust = trust_of(solved, truth, size, from);
        unsettled = truth.reference.trust.left_out[static_cast<std::size_t>(tap)][window];
    }
    truth.description =
        size.text() + (is_matched(choice.settings.options) ? ", compliance matched" : "");
    if (all > 0) {
        double highest = HUGE_VAL;
        for (const String& s : scene.strings)
            highest = std::min(highest, std::get<TableDamping>(s.damping).frequency_hz[all - 1]);
        truth.description +=
            fmt::format(", all that were measured: what lies above {:.2g} kHz is not in your table",
                        highest / 1000);
    }
    if (!truth.coarser.empty()) {
        truth.description += fmt::format(
            "; half of them change {} over {} by {:.1e}", scene.taps.at(tap).name,
            std::isinf(end) ? "the whole run" : fmt::format("{:.0f} ms", 1e3 * end),
            change(truth.reference.run.trace, truth.coarser.back().run.trace, tap, from, end));
    }
    if (!truth.coarser.empty() && std::isnan(unsettled))
        truth.description +=
            ". The last doubling changes it most, so what they leave out is unknown. A start with "
            "a sharp corner can do that to forces: try a `smoothing`";
    const bool profile = needed_by(scene).any(any_profile);
    if (all > 0 && !profile) {
        confirm(truth.reference, scene, size, jobs, listener, time_limit);
    } else if (find && !(unsettled < settled)) {
        truth.description += "; twice as many would take too long";
        if (unknown()) truth.description += ", so what they leave out is unknown";
        else if (size.points > 0 && std::isfinite(unsettled))
            truth.description += fmt::format(
                ". With {} points of the profile it is known to {:.2g} %: --option {}:nodes={} "
                "takes more",
                size.points, 100 * unsettled, choice.scheme->name, 2 * size.points);
        if (profile) truth.description += "; a shorter --duration lets more points be tried";
    }
    return truth;
}

const Reference* of_modes(const Cell& cell, const Reference& model, const Truth& truth) {
    const int modes = cell.settings.modes == 0 ? model.choice.settings.modes : cell.settings.modes;
    const bool matched = is_matched(cell.settings.options);
    const auto is_model = [&](const Reference& r) {
        return r.choice.settings.modes == modes && is_matched(r.choice.settings.options) == matched;
    };
    for (const Reference& r : truth.coarser)
        if (is_model(r)) return &r;
    if (is_model(truth.reference)) return &truth.reference;
    return is_model(model) || (model.choice.settings.modes == modes && !matched) ? &model : nullptr;
}

}  // namespace jvari::bench::study
