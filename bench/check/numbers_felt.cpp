// Tests whether a scheme responds to a change of each number in a scene as the reference does.
//
// Every scene of scenes_of_numbers() is reduced to the features that the scheme represents. It is
// left out if the scheme itself says that its run fails, as an explicit one on a hard bridge. The
// scheme runs the scene unchanged, and then with each number changed by a tenth. The change of each
// tap is compared with the change of the reference's tap. This shows even a wrong number with
// little effect on the motion, because everything else cancels.
//
// The tolerance follows from the scheme's own convergence. The scheme runs at 3, 5 and 8 times 44.1
// kHz, with modes or nodes in proportion. ConvergesToTheReference allows an error that falls to a
// third at 8 times the rate. Such an error is at most |a(r) - a(8)|/((8/r)^p - 1) at 8 times 44.1
// kHz, with 8^p = 3. The three rates are no multiples of each other, because a delay line rounds to
// the same length at multiples.
//
// With contacts the error of the motion itself is added. A contact that begins within a step causes
// an error that jumps with the instant, so the errors of two runs need not cancel. The gap that a
// scheme reports for the state of its contacts is added too. A grid approaches the whole string,
// but the reference has a finite number of modes. Nodes on a profile add their discretisation error
// (promise.hpp). A scheme that touches a profile at points adds nothing, because a reference with
// equally many points has them at the same places.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <set>

#include "bench/check/promise.hpp"
#include "bench/store/fresh_file.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/start.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

namespace {
constexpr int rates[] = {3, 5, 8}, coarse = 3, fine = 8;  // times 44.1 kHz
constexpr int modes_each = 6;                             // modes per 44.1 kHz
constexpr const char* points_of_a_profile = "16";
// Error relative to a tap that counts as none.
constexpr double as_good_as_the_same = 1e-6;
constexpr Features with_events =
    Feature::lumped_barrier | Feature::profile_barrier | Features(Feature::rigid_profile);

Settings at(const Descriptor& d, int times) {
    Settings s{times * contract_tap_rate, contract_tap_rate, times * modes_each, {}};
    if (declares(d, "rtol")) s.options.emplace_back("rtol", "1e-9");
    if (has_points_for_a_profile(d))
        s.options.emplace_back(profile_points_option.name, points_of_a_profile);
    if (d.clock == Clock::continuous && declares(d, "nodes"))
        s.options.emplace_back("nodes", points_of_a_profile);
    if (declares(d, "cells")) s.options.emplace_back("cells", std::to_string(256 * times));
    return s;
}

// Returns nothing if the scheme refuses.
std::optional<jvari::Run> run_where_taken(const Descriptor& d, const Scene& scene, int times) {
    try {
        return run(d, scene, at(d, times));
    } catch (const Refusal&) {
        return std::nullopt;
    } catch (const BadScene&) {  // a scene made here may be invalid
        return std::nullopt;
    }
}

// Exact motion for a limp string without losses whose end at x = 0 rotates the plane of vibration
// at each reflection: the sum of both d'Alembert waves.
Trace turning(const Scene& scene, long rows) {
    Trace t;
    t.tap_rate = contract_tap_rate;
    t.rows = t.stride = rows;
    const String& s = scene.strings.front();
    const double speed = std::sqrt(s.tension / s.linear_density);
    const Modes modes = modes_of(s, 400);
    const auto shape = start_of(modes, s).displacement;
    // Vertical component; the shape lies in the plane at angle 0.
    const auto wave = [&](double x) {
        std::complex<double> turned = std::polar(0.5, s.polarisation->pluck_angle);
        for (; x < 0 || x > s.length; turned = -turned)
            if (x < 0) x = -x, turned *= std::polar(1.0, s.polarisation->rotation);
            else x = 2 * s.length - x;
        double y = 0;
        for (int i = 0; i < modes.count(); ++i) y += shape[i] * std::sin(modes.beta[i] * x);
        return y * turned.real();
    };
    for (const Tap& tap : scene.taps) {
        t.names.push_back(tap.name);
        for (long n = 0; n < rows; ++n) {
            const double way = speed * static_cast<double>(n) / contract_tap_rate;
            t.tap.push_back(wave(tap.position - way) + wave(tap.position + way));
        }
    }
    return t;
}

// nullptr: no reference.
const Trace* truth_for(const Descriptor& d, const Scene& scene, int times = fine) {
    static std::mutex mutex;
    // nothing: the reference refuses the scene
    static std::map<std::string, std::optional<Trace>> known;
    const std::scoped_lock lock(mutex);
    const std::string key = scene_hash(scene) + std::to_string(times);
    if (needed_by(scene).has(Feature::polarisation)) {
        std::optional<Trace>& trace = known[key];
        if (!trace) trace = turning(scene, rows_of(scene, {0, contract_tap_rate, 0, {}}));
        return &*trace;
    }
    for (const Descriptor& reference : references()) {
        if (std::string(reference.name) == d.name ||
            (needed_by(scene) - Feature::profile_barrier).any(approximated(reference)))
            continue;
        const auto [found, is_new] = known.try_emplace(key + reference.name);
        if (is_new)
            if (auto r = run_where_taken(reference, scene, times)) found->second = r->trace;
        if (found->second) return &*found->second;
    }
    return nullptr;
}

using Levels = std::vector<jvari::Run>;  // one run for each rate in `rates`

double norm(std::span<const double> a) {
    double sum = 0;
    for (const double x : a) sum += x * x;
    return std::sqrt(sum);
}
std::vector<double> less(std::span<const double> a, std::span<const double> b) {
    std::vector<double> c;
    for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) c.push_back(a[n] - b[n]);
    return c;
}
// Upper bound for the error at the last rate.
template <class At>
double own_error(At at) {
    const double order = std::log(3.0) / std::log(8.0);
    double most = 0;
    for (const int i : {0, 1})
        most = std::max(most,
                        norm(less(at(i), at(2))) / (std::pow(double(fine) / rates[i], order) - 1));
    return most;
}

class Felt {  // test of one scheme on one scene
public:
    Felt(const Descriptor& d, Scene scene, const std::filesystem::path& folder)
        : d_(d),
          by_points_(has_points_for_a_profile(d) ? Features(Feature::profile_barrier) : Features()),
          scene_(std::move(scene)),
          folder_(folder) {
        before_ = levels(scene_);
        const bool fails = std::ranges::any_of(
            before_, [](const jvari::Run& r) { return r.status.outcome != Outcome::ok; });
        if (fails || before_.empty() || !truth_for(d_, scene_)) before_.clear();
        else truth_ = levels_of_truth(scene_);
    }
    int examined() const { return examined_; }

    std::string wrong() {  // "": nothing is wrong
        if (before_.empty()) return "";
        if (std::string fault = compared(scene_, "as it is", truth_, before_, true); !fault.empty())
            return fault;
        for (int which = 0;; ++which) {
            auto other = changed(scene_, which);
            if (!other) return "";
            if (other->key == "duration") continue;
            Levels is = levels(other->scene);
            if (is.empty()) {
                other = changed(scene_, which, true);
                is = levels(other->scene);
            }
            if (is.empty() || !truth_for(d_, other->scene)) continue;
            ++examined_;
            if (std::string fault =
                    compared(other->scene, other->key, levels_of_truth(other->scene), is, false);
                !fault.empty())
                return fault;
        }
    }

private:
    // Returns no levels if the scheme refuses the scene or approximates it.
    Levels levels(const Scene& s) const {
        try {
            validate(s);
        } catch (const BadScene&) { return {}; }  // another number bounds the changed one
        if (!represents(d_, s) || (needed_by(s) - by_points_).any(approximated(d_))) return {};
        Levels all;
        for (const int times : rates) {
            if (times != fine && d_.clock != Clock::stepped) {
                all.emplace_back();
                continue;
            }
            auto r = run_where_taken(d_, in_files(s, folder_), times);
            if (!r) return {};
            all.push_back(std::move(*r));
        }
        return all;
    }
    // References with cells run at each level, because they err by about a cell; all others run at
    // the last.
    std::vector<const Trace*> levels_of_truth(const Scene& s) const {
        std::vector<const Trace*> all;
        for (const int times : rates)
            all.push_back(
                truth_for(d_, s, needed_by(s).has(Feature::rigid_profile) ? times : fine));
        return all;
    }
    std::string compared(const Scene& other, const std::string& key,
                         const std::vector<const Trace*>& truth, const Levels& is,
                         bool itself) const {
        for (int k = 0; k < truth[2]->taps(); ++k) {
            const auto change = [&](int i) {
                const int level = d_.clock == Clock::stepped ? i : 2;
                return itself ? less(is[level].trace.column(k),
                                     std::vector<double>(is[level].trace.rows))
                              : less(is[level].trace.column(k), before_[level].trace.column(k));
            };
            const auto true_change = [&](int i) {
                return itself ? less(truth[i]->column(k), std::vector<double>(truth[i]->rows))
                              : less(truth[i]->column(k), truth_[i]->column(k));
            };
            const auto is_here = change(2), is_there = true_change(2);
            const double all = std::max(norm(truth[2]->column(k)), norm(truth_[2]->column(k)));
            double allowed = own_error(change) + own_error(true_change) +
                             (d_.represents.has(Feature::measured_modes) ? as_good_as_the_same
                                                                         : what_modes_leave_out) *
                                 all;
            if (!itself && d_.clock == Clock::stepped && needed_by(other).any(with_events))
                for (const Levels* l : {&is, &before_})
                    allowed += own_error([&](int i) { return (*l)[i].trace.column(k); });
            if ((needed_by(other) - by_points_).any(any_profile))
                allowed += what_nodes_leave_out * all;
            // The scheme reports this error of its contacts.
            for (const Levels* l : {&is, itself ? nullptr : &before_})
                if (const double gap = l ? fact_of((*l)[2].facts, facts::psi_gap) : 0; gap > 0)
                    allowed += gap * all;
            const double error = norm(less(is_here, is_there));
            if (!(error <= allowed) || is_here.size() != is_there.size())
                return fmt::format(
                    "{}: {}{}: tap {} {} by {:.4g} {} (root of the sum of squares) where the "
                    "reference's does by {:.4g}; they differ by {:.2g}, at most {:.2g} is its own "
                    "error",
                    scene_.name, key, itself ? "" : " changed by a tenth", truth[2]->names[k],
                    itself ? "moves" : "changes", norm(is_here), unit_of(scene_.taps[k].quantity),
                    norm(is_there), error, allowed);
        }
        return "";
    }

    const Descriptor& d_;
    const Features by_points_;
    Scene scene_;
    const std::filesystem::path& folder_;  // for the tables of the scene
    std::vector<const Trace*> truth_;
    Levels before_;
    int examined_ = 0;
};
}  // namespace

Verdict feels_every_number(const Case& c) {
    const store::Scratch folder;
    int examined = 0;
    std::set<std::string> seen;
    for (const Scene& whole : scenes_of_numbers()) {
        Scene scene = as_far_as(c.scheme, whole);
        scene.name = "";
        // Skips a scene if the distinguishing feature is not represented.
        if (!seen.insert(scene_hash(scene)).second) continue;
        scene.name = whole.name;
        Felt felt(c.scheme, scene, folder.path);
        if (const std::string fault = felt.wrong(); !fault.empty()) return broken(fault);
        examined += felt.examined();
    }
    return examined > 0 ? kept(fmt::format("{} numbers", examined))
                        : not_asked("no reference represents what it does");
}

}  // namespace jvari::bench::check
