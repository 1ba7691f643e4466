// Search for the truth of a scene: a first size, doublings, own modes beside a matched reference,
// and a description of the result.
#include <fmt/core.h>

#include <algorithm>

#include "analysis/error.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/errors.hpp"
#include "bench/study/reference.hpp"
#include "bench/study/truth.hpp"
#include "reference/agreement.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::study {

namespace {
// limit for all doublings together, and the same limit again for own modes beside them [s]
constexpr double patience = 60;

// Confirms a table of modes by another solver with the same modes, over 50 ms if the whole run
// would take too long.
void confirm(Reference& r, Scene scene, const Size& size, int jobs, const store::Listener& listener,
             double time_limit) {
    if (r.trust.any() || r.choice.scheme->name == std::string_view(sundials.name) ||
        !represents(sundials, scene))
        return;
    const double from = free_from(scene);
    if (!within_budget(sundials, scene, r.choice.settings.tap_rate, size))
        scene.duration = std::min(scene.duration, from + 50e-3);
    if (!within_budget(sundials, scene, r.choice.settings.tap_rate, size)) return;
    ReferenceChoice other = sized(r.choice, size);
    other.scheme = &sundials;
    std::erase_if(other.settings.options,
                  [](const auto& o) { return o.first != std::string(nodes_option.name); });
    const Run run = run_reference({other}, scene, jobs, listener, {time_limit}, true).run;
    const double until = static_cast<double>(run.trace.rows - 1) / run.trace.tap_rate - from;
    const bool whole = run.trace.rows == r.run.trace.rows;
    for (int k = 0; k < run.trace.taps(); ++k) {
        auto& figure = r.trust.figure.emplace_back();
        for (std::size_t w = 0; w < figure.size(); ++w) {
            const double end = measures()[w].window;
            const bool covered = std::isinf(end) ? whole : end <= until + 1e-6;
            figure[w] = covered ? change(r.run.trace, run.trace, k, from, w) : nan;
        }
    }
    r.trust.against = sundials.name;
    r.trust.missing.clear();
}

class Search {
public:
    Search(const Scene& s, int jobs, const store::Listener& listener, double time_limit, bool find,
           double effort, bool settles_whole)
        : scene_(s),
          jobs_(jobs),
          listener_(listener),
          time_limit_(time_limit),
          find_(find),
          effort_(effort),
          end_(settles_whole ? HUGE_VAL : headline_window(s)) {}
    Truth of(const std::vector<ReferenceChoice>&, int modes, int begin);

private:
    Truth first(const std::vector<ReferenceChoice>&, int modes, int begin);
    std::vector<Size> next() const;  // the first one that is not too long is to be run
    bool more();                     // false: this is the last size
    void judge();
    double left(bool points) const;  // estimate for the headline figure, also from coarser runs
    bool lacks(bool points) const;   // no doubling of the modes, or of the points, ends here
    void half();
    void add_coarser(const Size&);
    void own();
    void describe();
    void say_what_would_help();
    bool unknown() const {
        return t_.coarser.empty() && std::isnan(t_.reference.trust.of_scene(tap(), window_));
    }
    std::size_t tap() const { return static_cast<std::size_t>(headline_of(scene_).nut); }
    Reference run(const ReferenceChoice& c, TimeLimit limit) const {
        return run_reference({c}, scene_, jobs_, listener_, limit);
    }

    const Scene& scene_;
    const int jobs_;
    const store::Listener& listener_;
    const double time_limit_;
    const bool find_;      // true: the size is found by doubling, not given by the user
    const double effort_;  // factor on all limits that nobody asked for
    const double end_;     // end of the window to settle [s]
    const double from_ = free_from(scene_);
    const std::size_t window_ = waveform_over(end_);
    Truth t_;
    ReferenceChoice choice_{};
    Trust solved_;
    Sizes sizes_;
    Size size_{};
    double spent_ = 0;                            // [s]
    std::array<bool, 2> too_long_{false, false};  // twice the modes; twice the points
    double unsettled_ = HUGE_VAL;  // effect on the headline figure of the modes and points left out
};

// Runs the coarsest size, matched if possible.
Truth Search::first(const std::vector<ReferenceChoice>& choices, int modes, int begin) {
    std::vector<ReferenceChoice> first;
    for (const ReferenceChoice& c : choices) {
        if (c.oversampled) {
            first.push_back(c);
            continue;
        }
        const Size size = sizes_of(c, scene_, modes, begin).each.front();
        if (const auto nearer = matched(*c.scheme, scene_, c.settings.options)) {
            first.push_back(c);
            first.back().settings.options = *nearer;
            first.back() = sized(first.back(), size);
        }
        first.push_back(sized(c, size));
    }
    const TimeLimit limit = find_ ? first_run(time_limit_, effort_) : TimeLimit{time_limit_};
    try {
        Truth t;
        t.reference = run_reference(first, scene_, jobs_, listener_, limit);
        return t;
    } catch (const store::PastItsLimit& e) {
        if (limit.seconds == time_limit_) throw;
        throw store::PastItsLimit(
            fmt::format("{}. Its contacts open and close too often, or it has too many modes. A "
                        "shorter --duration may help; --reference-modes N, below {}, takes as long "
                        "as it takes",
                        e.what(), first.front().settings.modes));
    }
}

double Search::left(bool points) const {
    const auto steps = doublings(t_, points);
    if (steps.empty()) return HUGE_VAL;
    const Apart apart = [this](const Trace& coarse, const Trace& fine) {
        return change(fine, coarse, static_cast<int>(tap()), from_, window_);
    };
    const double left =
        left_by(steps, t_.matched, apart, t_.reference.trust.in_model(tap(), window_));
    return std::isnan(left) ? HUGE_VAL : left;
}

bool Search::lacks(bool points) const { return !ends_at_reference(doublings(t_, points), t_); }

std::vector<Size> Search::next() const {
    const auto at = std::ranges::find(sizes_.each, size_);
    if (at != sizes_.each.end() && at + 1 != sizes_.each.end()) return {*(at + 1)};
    if (!sizes_.doubled) return {};
    const double by_modes = t_.all_modes ? 0 : left(false),
                 by_points = t_.has_points ? left(true) : 0;
    if (by_modes + by_points < settled) return {};
    std::vector<Size> all{{std::min(2 * size_.modes, sizes_.most_modes()), size_.points},
                          {size_.modes, 2 * size_.points}};
    if (by_points > by_modes) std::swap(all[0], all[1]);
    std::erase_if(all, [&](const Size& s) {
        return s == size_ || too_long_[s.modes == size_.modes] ||
               !within_budget(*choice_.scheme, scene_, choice_.settings.tap_rate, s, effort_);
    });
    return all;
}

bool Search::more() {
    for (const Size& size : next()) {
        const double left = sizes_.doubled ? patience * effort_ - spent_ : HUGE_VAL;
        if (left <= 0) return false;
        // the other one of modes and points may still be affordable
        const double judged_after = t_.has_points ? left / 4 : HUGE_VAL;
        Reference finer;
        try {
            finer = run(sized(choice_, size), TimeLimit{std::min(time_limit_, left), judged_after});
        } catch (const store::PastItsLimit&) {
            // The best result so far stands, with its bound.
            if (time_limit_ <= left) throw;
            too_long_[size.modes == size_.modes] = true;
            continue;
        } catch (const BadScene&) {
            continue;  // No string has so many modes, or the table has no more.
        } catch (const Refusal&) {
            continue;  // All measured modes are in: none is left out that could be matched.
        }
        spent_ += finer.run.wall_seconds;
        size_ = size;
        t_.coarser.push_back(std::move(t_.reference));
        t_.reference = std::move(finer);
        judge();
        return true;
    }
    return false;
}

void Search::judge() {
    t_.reference.trust = trust_of(solved_, t_, from_);
    unsettled_ = t_.reference.trust.left_out[tap()][window_];
    t_.horizon = HUGE_VAL;
    for (const bool points : {false, true}) {
        const auto steps = doublings(t_, points);
        if (steps.empty()) continue;
        const Trace &finer = steps.back().fine->run.trace, &fewer = steps.back().coarse->run.trace;
        const auto free = [&](const Trace& t) {
            return rows_from(t.column(static_cast<int>(tap())), from_, t.tap_rate);
        };
        t_.horizon = std::min(t_.horizon, horizon(free(fewer), free(finer), finer.tap_rate));
    }
}

void Search::add_coarser(const Size& size) {
    const double limit =
        find_ && t_.has_points ? std::min(time_limit_, patience * effort_) : time_limit_;
    try {
        t_.coarser.push_back(run(sized(choice_, size), TimeLimit{limit}));
        judge();
    } catch (const store::PastItsLimit&) {
        if (!t_.has_points || !find_) throw;
    } catch (const Refusal&) {}
}

// Runs half the modes of the last size, or half the points, if no doubling ends there. Half the
// size also tells something about the error if even one doubling takes too long.
void Search::half() {
    const bool by_modes = t_.has_points ? lacks(false) : find_ && unknown();
    if (by_modes && !t_.all_modes && size_.modes > 1) add_coarser({size_.modes / 2, size_.points});
    if (t_.has_points && lacks(true) && size_.points > 1)
        add_coarser({size_.modes, size_.points / 2});
}

void Search::own() {
    if (t_.coarser.empty() || !is_matched(choice_.settings.options)) return;
    try {
        t_.own = own_motion(choice_, scene_, size_, jobs_, listener_,
                            find_ ? std::min(time_limit_, patience * effort_) : time_limit_);
    } catch (const store::PastItsLimit&) {  // the doublings alone then give the estimate
    } catch (const Refusal&) {}
    if (!t_.own.empty()) t_.reference.trust = trust_of(solved_, t_, from_);
    unsettled_ = t_.reference.trust.left_out[tap()][window_];
}

void Search::describe() {
    t_.description =
        size_.text() + (is_matched(choice_.settings.options) ? ", compliance matched" : "");
    if (sizes_.measured > 0) {
        t_.limit_hz = HUGE_VAL;
        for (const String& s : scene_.strings)
            t_.limit_hz = std::min(
                t_.limit_hz, std::get<TableDamping>(s.damping).frequency_hz[sizes_.measured - 1]);
        t_.description +=
            fmt::format(", all that were measured: what lies above {:.2g} kHz is not in your table",
                        t_.limit_hz / 1000);
    }
    if (t_.coarser.empty()) return;
    const auto half_of = [&](bool points) {
        const auto [coarse, fine] = doublings(t_, points).back();
        return fmt::format("{:.1e}", change(fine->run.trace, coarse->run.trace,
                                            static_cast<int>(tap()), from_, window_));
    };
    const std::string what =
        fmt::format("change {} over {} by ", scene_.taps.at(tap()).name,
                    std::isinf(end_) ? "the whole run" : fmt::format("{:.0f} ms", 1e3 * end_));
    if (!t_.has_points) t_.description += "; half of them " + what + half_of(false);
    else if (!t_.all_modes && !lacks(false))
        t_.description += "; half the modes " + what + half_of(false);
    if (t_.has_points && !lacks(true))
        t_.description += "; half the points " + what + half_of(true);
    if (t_.has_points && (lacks(true) || (lacks(false) && !t_.all_modes)))
        t_.description += ", so what they leave out is unknown";
    else if (std::isnan(unsettled_))
        t_.description +=
            ". The last doubling changes it most, so what they leave out is unknown. A start with "
            "a sharp corner can do that to forces, and few points of a profile: try a `smoothing`, "
            "or more points";
}

void Search::say_what_would_help() {
    if (sizes_.doubled) t_.description += "; twice as many would take too long";
    if (unknown()) t_.description += ", so what they leave out is unknown";
    if (size_.points > 0 && 2 * size_.points <= most_points) {
        if (std::isfinite(unsettled_))
            t_.description += fmt::format(". With {} points of the profile it is known to {:.2g} %",
                                          size_.points, 100 * unsettled_);
        t_.description += fmt::format(": --option {}:nodes={} takes more, for as long as they take",
                                      choice_.scheme->name, 2 * size_.points);
    }
    if (size_.points > 0) t_.description += "; a shorter --duration lets more points be tried";
}

Truth Search::of(const std::vector<ReferenceChoice>& choices, int modes, int begin) {
    t_ = first(choices, modes, begin);
    if (t_.reference.choice.oversampled) {
        t_.description =
            "a stand-in with as many modes as the schemes, if it has modes: what those "
            "leave out is unknown";
        return std::move(t_);
    }
    choice_ = t_.reference.choice;
    const auto declared = std::ranges::find_if(choices, [&](const ReferenceChoice& c) {
        return c.scheme == choice_.scheme && !c.oversampled;
    });
    sizes_ = sizes_of(*declared, scene_, modes, begin);
    size_ = sizes_.each.front();
    spent_ = t_.reference.run.wall_seconds;
    Settings certified = declared->settings;
    certified.options = choice_.settings.options;  // with the default number of points
    std::erase_if(certified.options,
                  [](const auto& o) { return o.first == std::string(nodes_option.name); });
    certified.modes =
        sizes_.measured > 0 ? sizes_.measured : modes_to_begin_with(scene_, certified.tap_rate, 0);
    solved_ = trust_of(scene_, choice_.scheme->name, certified, scene_.duration);
    t_.has_points = size_.points > 0;
    t_.all_modes = sizes_.measured > 0;
    t_.matched =
        is_matched(choice_.settings.options) || needed_by(scene_).has(Feature::rigid_barrier);
    while (more()) {}
    half();
    own();
    describe();
    if (sizes_.measured > 0 && !needed_by(scene_).any(any_profile))
        confirm(t_.reference, scene_, size_, jobs_, listener_, time_limit_);
    else if (find_ && !(unsettled_ < settled)) say_what_would_help();
    return std::move(t_);
}
}  // namespace

Truth run_truth(const std::vector<ReferenceChoice>& choices, const Scene& scene, int modes,
                int jobs, const store::Listener& listener, double time_limit, int begin,
                double effort, bool settles_whole) {
    return Search(scene, jobs, listener, time_limit, modes == 0, effort, settles_whole)
        .of(choices, modes, begin);
}

}  // namespace jvari::bench::study
