#include "bench/compare/scene_notes.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <variant>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/store/usage.hpp"
#include "reference/references.hpp"
#include "scenes/barrier.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "scenes/start.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
// Length of an instrument's string, from a piano's highest to its lowest [m].
constexpr double least_length = 0.03, most_length = 4;
constexpr double least_pitch = 10, most_pitch = 1e4;  // [Hz]
// Start over length: beyond this ratio, the equations of small motion do not hold.
constexpr double most_start = 0.1;
constexpr double most_stiffness = 1e13;  // [N/m^exponent], a thousand times the stiffest in use

bool plucked(const String& s) { return s.pluck && s.pluck->amplitude != 0; }
bool pressed(const String& s) {  // true if a barrier or a thread pushes or pulls at rest
    const auto above = [](const LumpedBarrier& b) { return b.sign() * b.height > 0; };
    const auto somewhere = [](const ProfileBarrier& b) {
        const auto* table = std::get_if<TableCurve>(&b.curve);
        const auto is_above = [&](double x) { return height(b.curve, x) > 0; };
        return is_above(b.from) || is_above(b.to) ||
               (table && std::ranges::any_of(table->height, [](double h) { return h > 0; }));
    };
    return (s.thread && s.thread->height != 0) ||
           std::ranges::any_of(s.barriers, [&](const Barrier& b) {
               const auto* lumped = std::get_if<LumpedBarrier>(&b);
               return lumped ? above(*lumped) : somewhere(std::get<ProfileBarrier>(b));
           });
}
double highest(const ProfileBarrier& b) {  // with its sign
    double most = 0;
    for (const double g : heights(b.curve, {b.from, b.to}))
        if (std::abs(g) > std::abs(most)) most = g;
    return most;
}
bool set_in_motion(const String& s, double before) {
    const bool table = s.start && std::holds_alternative<TableStart>(*s.start);
    return largest_displacement(s) != 0 || table || s.velocity || pressed(s) ||
           std::ranges::any_of(
               s.masses,
               [](const Mass& m) { return m.velocity > 0 || m.gap < 0 || m.weight > 0; }) ||
           (plucked(s) && s.pluck->start < before);
}
}  // namespace

std::string tuning_text(const String& s) {
    const double f1 = pitch_of(s);
    const std::string note = note_of(f1);
    const auto measured = modes_measured(s);
    return fmt::format("f1 = {:.4g} Hz{}, tension {:.3g} N, {}", f1,
                       note.empty() ? "" : " (" + note + ")", s.tension,
                       s.tension == 0 ? "a bar"
                       : measured     ? fmt::format("{} measured modes", *measured)
                                      : fmt::format("inharmonicity {:.2g}", inharmonicity(s)));
}

std::string untouched_text(const Scene& scene, const Figures& run) {
    const bool any =
        std::ranges::any_of(scene.strings, [](const String& s) { return s.has_contacts(); });
    if (!any || run.largest_contact_force != 0 || run.deepest_penetration > 0) return "";
    return fmt::format(
        "no string of {} touches a barrier or a mass in {:g} s, so no contact is in this run. Are "
        "height [m], position and the side of the start as meant?",
        scene.name, scene.duration);
}

void note_scene(const Scene& scene, const store::Listener& listener) {
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        const auto doubt = [&](bool doubtful, const char* key, double value, const char* unit,
                               const char* usual) {
            if (doubtful)
                listener.warn(
                    fmt::format("string {}: {} = {:g} {}; expected {}. Is the unit right?", i, key,
                                value, unit, usual));
        };
        doubt(s.length < least_length || s.length > most_length, "length", s.length, "m",
              "0.03 to 4 m");
        doubt(tuned_pitch(s) < least_pitch || tuned_pitch(s) > most_pitch,
              "the pitch that length, tension and linear_density give", tuned_pitch(s), "Hz",
              "10 to 10000 Hz");
        const double start = largest_displacement(s);
        doubt(start > most_start * s.length, "start.amplitude", start, "m",
              "less than a tenth of the length");
        for (const Barrier& b : s.barriers) {
            if (const auto* profile = std::get_if<ProfileBarrier>(&b)) {
                const double g = highest(*profile);
                doubt(std::abs(g) > most_start * s.length, "barrier height", g, "m",
                      "less than a tenth of the length");
            }
            if (const auto* lumped = std::get_if<LumpedBarrier>(&b)) {
                doubt(std::abs(lumped->height) > most_start * s.length, "barrier.height",
                      lumped->height, "m", "less than a tenth of the length");
                const double k = lumped->stiffness.k;
                doubt(std::isfinite(k) && k > most_stiffness, "barrier.stiffness", k,
                      "N/m^exponent", "at most 1e13, or \"rigid\"");
            }
        }
        doubt(plucked(s) && s.tension > 0 && std::abs(s.pluck->amplitude) > s.tension,
              "pluck.amplitude", plucked(s) ? s.pluck->amplitude : 0, "N", "less than the tension");
    }
    note_tables(scene, listener);
    const auto moves = [&](const String& s) { return set_in_motion(s, scene.duration); };
    // a moving string shakes the others
    if (scene.body && !scene.body->modes.empty() && std::ranges::any_of(scene.strings, moves))
        return;
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        if (moves(s)) continue;
        const std::string why =
            plucked(s) ? fmt::format("its pluck begins at {:g} s, and the run ends at {:g} s",
                                     s.pluck->start, scene.duration)
                       : "nothing sets it in motion; give it [string.start] or [string.pluck]";
        listener.warn(fmt::format("string {} of {} stays silent: {}", i, scene.name, why));
    }
}

void note_windows(const Scene& scene, const store::Listener& listener) {
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const auto& p = scene.strings[i].pluck;
        if (!p) continue;
        const auto from = steady_from(*p, scene.duration);
        if (p->kind == PluckKind::blow)
            listener.note(
                fmt::format("string {}: its pluck is a blow, and errors are measured from "
                            "its start on, {:g} s",
                            i, p->start));
        else if (p->file.empty() && p->skew == 0 && p->duration < 1 / lowest_pitch(scene))
            listener.note(
                fmt::format("string {}: errors are measured from {:g} s on, where its pluck "
                            "ends; kind = \"blow\" there measures from its start",
                            i, p->start + p->duration));
        else if (from && force(*p, *from) != 0)
            listener.note(
                fmt::format("string {}: the force of {} stays to the end of the run and is steady "
                            "from {:g} s on: errors are of the motion under it",
                            i, p->file, *from));
    }
}

void refuse_slow_rate(const Scene& scene, double rate) {
    if (const double pitch = lowest_pitch(scene); rate < 2 * pitch)
        throw store::UsageError(
            fmt::format("found the rate {:g} Hz, expected at least twice the pitch of {}, {:.4g} "
                        "Hz. Is it in kHz? Those are written {:g}k",
                        rate, scene.name, pitch, rate));
}

void note_force_files(const Scene& scene, double sample_rate, const store::Listener& listener) {
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        if (!s.pluck || s.pluck->time.empty() || !(sample_rate > 0)) continue;
        const std::vector<double>& t = s.pluck->time;
        double closest = HUGE_VAL;
        for (std::size_t k = 1; k < t.size(); ++k) closest = std::min(closest, t[k] - t[k - 1]);
        constexpr double rounding = 1e-6;  // for instants, in steps
        if (closest * sample_rate < 1 - rounding)
            listener.note(fmt::format(
                "string {}: rows of {} are {:.3g} s apart, less than a step of {:g} Hz: each step "
                "pushes with the mean of the force over it",
                i, s.pluck->file, closest, sample_rate));
    }
}

namespace {
constexpr double least_order = 0.5;  // Below this order, a sufficient rate is out of reach.
constexpr double hardly = 0.1;       // A smaller order counts as none.
constexpr double furthest = 64;      // limit of an extrapolation, as a ratio of rates
// If the error in the model is a smaller share of the error, the modes left out cause the rest.
constexpr double of_the_modes = 0.3;
// Limits for mentioning a horizon: a share of the end, and an instant [s].
constexpr double before_the_end = 0.98, first_of_all = 1e-3;

std::string rate_text(double hertz) { return fmt::format("{:.4g} kHz", hertz / 1000); }

using Cell = study::TabledCell;
using study::Cells, study::Rows;

bool is_grid(const Cell& c) { return c.fact(facts::grid_intervals.name) > 0; }

const Cell* least(const Cells& cells, const Rows& rows, std::size_t measure) {
    const Cell* best = nullptr;
    const auto shown = [&](const Cell& c) { return bound_of(c, measure).shown(); };
    for (const std::size_t i : rows)
        if (std::isfinite(shown(cells[i])) && (!best || shown(cells[i]) < shown(*best)))
            best = &cells[i];
    return best;
}

const Cell* cheapest_within(const Cells& cells, const Rows& rows, std::size_t measure,
                            double most) {
    const Cell* best = nullptr;
    for (const std::size_t i : rows)
        if (bound_of(cells[i], measure).most() <= most &&
            (!best || cells[i].cost_s_per_s < best->cost_s_per_s))
            best = &cells[i];
    return best;
}

// Order over all rates in the series of `cell`, from errors beyond noise and reference uncertainty.
Order order_of(const Cells& cells, const Cell& cell, std::size_t measure) {
    Rows series = study::all_rows(cells);
    std::erase_if(series, [&](std::size_t i) {
        return !cells[i].flags.empty() || !cells[i].same_series(cell) ||
               (!is_grid(cell) && cells[i].modes != cell.modes);
    });
    return fall_over_rates(cells, series, measure).order;
}

std::string of_the_rate(const Order& o, const Cell& cell, std::size_t measure, double most) {
    if (!std::isfinite(o.half_width))  // two points lie on every line
        return o.points < 2 ? "" : " Two rates are too few to extrapolate: run a third.";
    if (o.order - o.half_width <= 0 && o.order + o.half_width >= least_order)
        return " From these rates it cannot be told whether a higher rate helps.";
    if (o.order < hardly || o.order - o.half_width <= 0)
        return fmt::format(
            " The error hardly falls with the rate (order {:.2f}), so a higher rate will not help.",
            std::max(0.0, o.order));
    const double rate = cell.rate * std::pow(cell.figure(measure).value / most, 1 / o.order);
    if (o.order < least_order || rate > furthest * cell.rate)
        return fmt::format(
            " The error falls with the rate (order {:.2g}), but no rate within reach is enough.",
            o.order);
    return fmt::format(
        " The error falls with the rate (order {:.2g}): {} would be enough, extrapolated and not "
        "run.",
        o.order, rate_text(rate));
}

std::string of_the_modes_left_out(const Cells& cells, const Cell& cell, std::size_t measure) {
    const study::Figure& f = cell.figure(measure);
    if (is_grid(cell) || !(cell.modes > 0)) return "";
    if (f.in_model < of_the_modes * f.value)
        return fmt::format(" Most of that comes from the modes left out: try `--modes {:.0f}`.",
                           2 * cell.modes);
    for (const Cell& other : cells) {  // fewer modes at the same rate
        const double order =
            std::log(other.figure(measure).value / f.value) / std::log(cell.modes / other.modes);
        if (other.modes < cell.modes && reached(other) && order >= least_order &&
            other.rate == cell.rate && other.same_series(cell))
            return fmt::format(" The error falls with the modes: try `--modes {:.0f}`.",
                               2 * cell.modes);
    }
    return "";
}

// Advice to try more modes if no run with the same modes tells whether they limit the accuracy.
std::string of_more_modes(const Cell& cell, std::size_t measure) {
    const double modes = cell.modes, most = cell.reference_modes;
    if (is_grid(cell) || std::isfinite(cell.figure(measure).in_model) ||
        !(modes > 0 && modes < most))
        return "";
    return fmt::format(" More modes may help: try `--modes {:.0f}`.", std::min(2 * modes, most));
}

std::string of_the_compliance(const Cells& cells, const Rows& rows, const Cell& cell) {
    const auto matched = [&](std::size_t i) { return is_matched(cells[i].options); };
    const auto has_both = [&](const Descriptor& d) {
        return d.name == cell.scheme && declares(d, compliance_option.name);
    };
    const bool measured = cell.fact(study::reference_limit) > 0;
    if (!(cell.deepest_penetration > 0) || measured || std::ranges::any_of(rows, matched) ||
        std::ranges::none_of(schemes(), has_both))
        return "";
    return " compliance=matched was not run.";
}

std::string instead(const Cells& cells, const Rows& rows, std::size_t measure, double most) {
    const std::size_t octaves = study::measure("third_octave_db"),
                      first = study::measure("error_l2_10ms");
    for (const double db : {1.0, 3.0})
        if (const Cell* c = cheapest_within(cells, rows, octaves, db))
            return fmt::format(" By third octaves {:g} dB is reached by {}.", db, c->run());
    if (measure != first)
        if (const Cell* c = cheapest_within(cells, rows, first, most))
            return fmt::format(" Over the first 10 ms{} {} is within {}.", after_pluck(*c),
                               c->run(), percent(most));
    const Cell* c = least(cells, rows, octaves);
    return c ? fmt::format(" By third octaves the closest is {}, {:.2g} dB.", c->run(),
                           c->figure(octaves).value)
             : "";
}
}  // namespace

std::string percent(double share) {
    return share >= 0.0995 ? fmt::format("{:.0f} %", 100 * share)
                           : fmt::format("{:.2g} %", 100 * share);
}

std::string quoted(const Bound& b, std::size_t measure) {
    const bool bounded = b.says() == Bound::Says::at_most || b.says() == Bound::Says::unknown;
    const std::string text = study::measures()[measure].unit == "dB"
                                 ? fmt::format("{:.2g} dB", b.shown())
                                 : percent(b.shown());
    return (bounded ? "\u2264 " : "") + text;
}

std::string time_text(double seconds) {
    return seconds >= 0.995 ? fmt::format("{:.2g} s", seconds)
                            : fmt::format("{:.3g} ms", 1e3 * seconds);
}

std::string why_none(const Cells& cells, const Rows& rows, std::size_t measure, double most) {
    const Cell* best = least(cells, rows, measure);
    if (!best) return "No run covers the window.";
    const Bound b = bound_of(*best, measure);
    std::string text = fmt::format("Closest: {}, {} error.", best->run(), quoted(b, measure));
    if (b.floor > most) {
        text += fmt::format(" A change of the start by 1e-12 alone makes {}.", percent(b.floor));
    } else if (b.certificate > most) {
        text += fmt::format(" The reference is known to {} only.", percent(b.certificate));
    } else {
        const std::string modes = of_the_modes_left_out(cells, *best, measure);
        const Order o = order_of(cells, *best, measure);
        const bool falls = o.order - o.half_width > 0;
        text += modes.empty() ? of_the_rate(o, *best, measure, most) +
                                    (falls ? "" : of_more_modes(*best, measure))
                              : modes;
        text += of_the_compliance(cells, rows, *best);
    }
    const double h = best->figure(study::measure("horizon_s")).value, from = best->free_from_s,
                 end = best->wall_seconds / best->cost_s_per_s - (from > 0 ? from : 0);
    if (h > first_of_all && h < before_the_end * end)
        text += fmt::format(" Its waveform is within 10 % for {}.", time_text(h));
    return text + instead(cells, rows, measure, most);
}

}  // namespace jvari::bench::compare
