#include "bench/map/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <utility>

#include "schemes/grid/finite_difference.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::map {

namespace {
bool still(const Fails& fails, const Trial& t) {
    try {
        validate(t.scene);
        return fails(t);
    } catch (const std::exception&) {
        return false;
    }
}

using Change = std::function<bool(Trial&)>;  // false: nothing there to change

// The first tap alone: what fails is judged by taps of its own.
Scene heard_at_one_point(const Scene& scene) {
    Scene one = listened(scene);
    one.taps.resize(1);
    return one;
}

std::vector<Change> removals(const Trial& t) {
    std::vector<Change> all;
    for (int s = static_cast<int>(t.scene.strings.size()) - 1; s >= 0; --s)
        all.push_back([s](Trial& x) {
            if (x.scene.strings.size() < 2 || s >= static_cast<int>(x.scene.strings.size())) return false;
            x.scene.strings.erase(x.scene.strings.begin() + s);
            x.scene = heard_at_one_point(x.scene);
            return true;
        });
    const auto of_a_string = [&all](int s, auto change) {  // change(String&): whether there was something to change
        all.push_back([s, change](Trial& x) { return s < static_cast<int>(x.scene.strings.size()) && change(x.scene.strings[s]); });
    };
    const auto each_barrier = [](String& s, auto change) {
        bool changed = false;
        for (Barrier& b : s.barriers) changed = std::visit(change, b) || changed;
        return changed;
    };
    for (int k = 0; k < static_cast<int>(t.scene.strings.size()); ++k) {
        for (int b = static_cast<int>(t.scene.strings[k].barriers.size()) - 1; b >= 0; --b)
            of_a_string(k, [b](String& s) {
                if (b >= static_cast<int>(s.barriers.size())) return false;
                return s.barriers.erase(s.barriers.begin() + b), true;
            });
        of_a_string(k, [](String& s) { return std::exchange(s.thread, std::nullopt).has_value(); });
        of_a_string(k, [](String& s) { return s.initial && std::exchange(s.pluck, std::nullopt).has_value(); });
        of_a_string(k, [](String& s) { return s.pluck && std::exchange(s.initial, std::nullopt).has_value(); });
        of_a_string(k, [](String& s) { return std::exchange(s.polarisation, std::nullopt).has_value(); });
        of_a_string(k, [](String& s) { return !std::holds_alternative<NoDamping>(s.damping) && (s.damping = NoDamping{}, true); });
        of_a_string(k, [](String& s) { return std::exchange(s.bending_stiffness, 0.0) != 0; });
        of_a_string(k,
                    [each_barrier](String& s) { return each_barrier(s, [](auto& b) { return std::exchange(b.contact_loss, 0.0) != 0; }); });
        of_a_string(k, [each_barrier](String& s) { return each_barrier(s, [](auto& b) { return std::exchange(b.exponent, 1.0) != 1; }); });
    }
    return all;
}

// The least n for which `fails_with` holds on a descent by n/2, n/4, ... 1.
long shortened(long n, long least, const std::function<bool(long)>& fails_with) {
    for (long cut = n / 2; cut >= 1; cut = std::min(cut / 2, n / 2))
        while (n - cut >= least && fails_with(n - cut)) n -= cut;
    return n;
}

// A grid takes no modes: they would only take them from the reference.
bool has_modes(const Trial& t) {
    const auto dofs = [&t](int modes) {
        Settings s = t.settings;
        s.modes = modes;
        return make_scheme(*t.scheme, t.scene, s)->dofs();
    };
    try {
        return dofs(5) != dofs(6);
    } catch (const std::exception&) {
        return false;
    }
}

bool shorten(Trial& t, const Fails& fails) {
    bool shorter = false;
    const auto try_out = [&](long& value, long least, const std::function<void(Trial&, long)>& apply) {
        const long n = shortened(value, least, [&](long k) {
            Trial x = t;
            apply(x, k);
            return still(fails, x);
        });
        if (n == value) return;
        apply(t, value = n);
        shorter = true;
    };
    long rows = std::lround(t.scene.duration * t.settings.tap_rate);
    try_out(rows, 1, [](Trial& x, long k) { x.scene.duration = static_cast<double>(k) / x.settings.tap_rate; });
    if (t.settings.modes > 0 && has_modes(t)) {
        long modes = t.settings.modes;
        try_out(modes, 1, [](Trial& x, long k) { x.settings.modes = static_cast<int>(k); });
    }
    for (std::size_t i = 0; i < t.settings.options.size(); ++i)
        if (t.settings.options[i].first == grid_option.name) {
            long intervals = std::atol(t.settings.options[i].second.c_str());
            try_out(intervals, 5, [i](Trial& x, long k) { x.settings.options[i].second = std::to_string(k); });
        }
    return shorter;
}
}  // namespace

Trial minimised(Trial t, const Fails& fails) {
    if (t.settings.modes == 0 && has_modes(t)) {  // the default, said aloud
        Trial explicit_modes = t;
        explicit_modes.settings.modes = modes_for(t.scene, t.settings);
        if (still(fails, explicit_modes)) t = std::move(explicit_modes);
    }
    t.scene = heard_at_one_point(t.scene);
    for (bool smaller = true; smaller;) {
        smaller = false;
        for (const Change& change : removals(t)) {  // while there is time and bandwidth enough to fail without
            Trial x = t;
            if (!change(x) || !still(fails, x)) continue;
            t = std::move(x);
            smaller = true;
        }
        smaller = shorten(t, fails) || smaller;
    }
    return t;
}

}  // namespace jvari::bench::map
