#include "bench/map/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <utility>
#include <vector>

#include "scenes/reduction.hpp"
#include "schemes/grid/finite_difference.hpp"
#include "schemes/making.hpp"
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

// The parts that are taken away, in turn: what is large goes first, and one string and something that moves it stay.
bool is_removal(const Reduction& r) {
    return r.part != Part::contact_stiffness && r.part != Part::footprint && r.part != Part::damping_term && r.part != Part::tap;
}

// The first tap alone: what fails is judged by taps of its own.
Scene heard_at_one_point(const Scene& scene) {
    Scene one = listened(scene);
    one.taps.resize(1);
    return one;
}

bool remove_what_can_be(Trial& t, const Fails& fails) {
    bool smaller = false;
    std::vector<Reduction> left = reductions_of(t.scene);
    while (!left.empty()) {
        const Reduction r = std::move(left.back());
        left.pop_back();
        if (!is_removal(r)) continue;
        Trial x = t;
        r.apply(x.scene);
        if (x.scene.taps.empty()) x.scene = heard_at_one_point(x.scene);  // they went with their string
        if (!still(fails, x)) continue;
        t = std::move(x);
        left = reductions_of(t.scene);  // the others may have changed their places
        smaller = true;
    }
    return smaller;
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
        smaller = remove_what_can_be(t, fails);  // while there is time and bandwidth enough to fail without
        smaller = shorten(t, fails) || smaller;
    }
    return t;
}

}  // namespace jvari::bench::map
