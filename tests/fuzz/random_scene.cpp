#include "random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "scenes/modes.hpp"

namespace jvari::test {

namespace {
struct Dice {
    std::mt19937_64 engine;
    bool extreme = false;

    double unit() { return static_cast<double>(engine() >> 11) * 0x1p-53; }  // in [0, 1)
    bool chance(double p) { return unit() < p; }
    int upto(int n) { return static_cast<int>(unit() * n); }  // 0 .. n - 1
    double between(double low, double high) { return low + (high - low) * unit(); }
    double decades(double low, double high) { return low * std::pow(high / low, unit()); }
    double sign() { return chance(0.5) ? 1 : -1; }
    // Of an extreme scene, one number in four may lie `wider` times outside its range, in decades.
    double scale(double low, double high, double wider = 1e3) {
        return extreme && chance(0.25) ? decades(low / wider, high * wider) : decades(low, high);
    }
    template <class T>
    T one_of(std::initializer_list<T> all) {
        return all.begin()[upto(static_cast<int>(all.size()))];
    }
};

Damping damping_of(Dice& d, const String& s) {
    const double f1 = std::sqrt(s.tension / s.linear_density) / (2 * s.length);
    switch (d.upto(6)) {
        case 0: return NoDamping{};
        case 1: return PolynomialDamping{d.scale(0.1, 10), 0, 0};
        case 2:
            return PolynomialDamping{d.scale(0.1, 10), d.scale(1e-4, 1e-2), d.scale(1e-7, 1e-5)};
        case 3:
            return QualityFactorDamping{d.scale(2e-4, 1e-3), 1.8e-5, 1.2, d.scale(1e-3, 1e-2),
                                        d.scale(1e-5, 1e-3)};
        case 4: return PerPeriodDamping{d.between(0.9, 1)};
        default: {
            TableDamping table{"measured.csv", {}, {}};
            for (int i = 1; i <= 64; ++i) {
                table.frequency_hz.push_back(f1 * i * (1 + 1e-4 * i * i) *
                                             d.between(0.9999, 1.0001));
                table.decay_rate.push_back(d.scale(0.1, 100));
            }
            return table;
        }
    }
}

double exponent_of(Dice& d) {
    return d.extreme && d.chance(0.3) ? d.between(1, 8)
                                      : d.one_of({1.0, 1.0, 1.0, 1.3, 1.5, 2.0, 2.5, 3.0});
}

Barrier barrier_of(Dice& d, double L) {
    const double exponent = exponent_of(d), loss = d.chance(0.2) ? d.scale(0.01, 1) : 0;
    if (d.chance(0.7)) {
        const double x = d.chance(0.5) ? d.between(0.005, 0.05) * L : d.between(0.05, 0.95) * L;
        const double width = d.chance(0.5) ? 0 : d.between(0, 1.9) * std::min(x, L - x) * 0.3;
        const double height = d.chance(0.4) ? 0 : d.sign() * d.scale(1e-6, 1e-3);
        return LumpedBarrier{x, width, height, {d.scale(1e4, 1e9)}, exponent, loss};
    }
    const double from = d.chance(0.5) ? 0 : d.between(0, 0.5) * L,
                 to = from + d.between(0.005, 0.06) * L;
    Curve curve = FlatCurve{};
    switch (d.upto(4)) {
        case 1: curve = LineCurve{d.sign() * d.scale(1e-4, 1e-2)}; break;
        case 2: curve = ParabolaCurve{d.scale(0.1, 10)}; break;
        case 3: {
            TableCurve table{"bridge.csv", {}, {}};
            for (int i = 0; i <= 4; ++i) {
                table.x.push_back(from + (to - from) * i / 4);
                table.height.push_back(d.between(-1e-3, 0));
            }
            table.x.back() = to;
            curve = table;
            break;
        }
        default: break;
    }
    return ProfileBarrier{curve, from, to, {d.scale(1e6, 1e11)}, exponent, loss};
}

void set_in_motion(Dice& d, String& s) {
    const double L = s.length;
    const int how = d.upto(10);
    if (how < 4) {
        s.start = ModeShape{1 + d.upto(4), d.sign() * d.scale(1e-5, 3e-3, 100)};
    } else if (how < 7) {
        s.start = TriangleShape{d.between(0.05, 0.95) * L, d.sign() * d.scale(1e-5, 3e-3, 100),
                                d.chance(0.5) ? 0 : d.between(0, 0.2) * L};
    }
    if (how >= 6 && how < 9) {
        const double x = d.between(0.1, 0.9) * L;
        const double width = d.chance(0.5) ? 0 : d.between(0, 2) * std::min(x, L - x);
        s.pluck = Pluck{d.sign() * d.scale(0.01, 1),
                        d.scale(2e-4, 5e-3),
                        d.chance(0.5) ? 0 : d.between(0, 30),
                        d.chance(0.5) ? 0 : d.between(0, 1e-3),
                        x,
                        width};
    }  // 9: left to what touches it
}

String string_of(Dice& d) {
    String s;
    s.length = d.scale(0.3, 1.3, 10);
    s.linear_density = d.scale(3e-4, 5e-3, 10);
    s.tension = d.scale(15, 100);
    s.bending_stiffness = d.chance(0.3) ? 0 : d.scale(1e-6, 1e-3);
    s.damping = damping_of(d, s);
    for (int n = d.one_of({0, 1, 1, 1, 1, 2, 3}); n > 0; --n)
        s.barriers.push_back(barrier_of(d, s.length));
    if (d.chance(0.3)) {
        const double x = d.between(0.003, 0.3) * s.length;
        s.thread = Thread{x, d.chance(0.5) ? 0 : d.between(0, 0.5) * x, d.scale(1e2, 1e6),
                          d.chance(0.3) ? 0 : d.scale(0.01, 2),
                          d.chance(0.7) ? 0 : d.sign() * d.scale(1e-6, 1e-3)};
    }
    set_in_motion(d, s);
    if (d.chance(0.06)) s.polarisation = Polarisation{d.between(-0.2, 0.2), d.between(0, 1.5)};
    return s;
}

void listen(Dice& d, Scene& scene, int i) {
    const String& s = scene.strings[static_cast<std::size_t>(i)];
    const std::string of = std::to_string(i);
    scene.taps.push_back({"nut" + of, Quantity::nut_force, i, 0});
    scene.taps.push_back({"y" + of, Quantity::displacement, i, d.between(0, 1) * s.length});
    if (d.chance(0.4))
        scene.taps.push_back({"v" + of, Quantity::velocity, i, d.between(0, 1) * s.length});
    if (!s.barriers.empty()) scene.taps.push_back({"bridge" + of, Quantity::bridge_force, i, 0});
    if (s.thread) scene.taps.push_back({"thread" + of, Quantity::thread_force, i, 0});
    if ((!s.barriers.empty() || s.thread) && d.chance(0.3))
        scene.taps.push_back({"driving" + of, Quantity::driving_force, i, 0});
}

// One string alone often gets a companion on the body.
void put_on_a_body(Dice& d, Scene& scene) {
    Body body;
    for (int n = 1 + d.upto(4); n > 0; --n) {
        const double mass = d.scale(1e-3, 1), omega = 2 * std::numbers::pi * d.scale(60, 3e3),
                     Q = d.scale(5, 500);
        body.modes.push_back({mass, mass * omega * omega, d.chance(0.2) ? 0 : mass * omega / Q});
    }
    scene.body = body;
    if (scene.strings.size() == 1 && d.chance(0.6)) {
        scene.strings.push_back(string_of(d));
        listen(d, scene, 1);
    }
    for (String& s : scene.strings) s.polarisation.reset();  // nothing represents both
    if (d.chance(0.5)) scene.taps.push_back({"support", Quantity::velocity, 0, 0});
}

RandomCase drawn(Dice& d) {
    RandomCase c;
    d.extreme = c.extreme = d.chance(0.1);
    c.scene.name = "random";
    for (int n = d.chance(0.1) ? 2 : 1; n > 0; --n) c.scene.strings.push_back(string_of(d));
    for (std::size_t i = 0; i < c.scene.strings.size(); ++i)
        listen(d, c.scene, static_cast<int>(i));
    c.settings.tap_rate = d.one_of({44100.0, 44100.0, 48000.0, 22050.0});
    c.settings.sample_rate = c.settings.tap_rate * d.one_of({1, 1, 2, 3, 4});
    c.settings.modes = 1 + d.upto(40);
    c.scene.duration = d.between(20, d.chance(0.1) ? 900 : 220) / c.settings.tap_rate;
    // the default
    if (d.chance(0.2) && modes_below(c.scene.strings.front(), 20e3) <= 100) c.settings.modes = 0;
    // last: what others draw stays
    if (d.chance(0.06)) put_on_a_body(d, c.scene);
    return c;
}
// So many modes are below 20 kHz, of which tension carries the first alone or the first few.
void stiffen(Dice& d, String& s) {
    const double modes = d.decades(10, 60), first = 20e3 / (modes * modes);
    s.bending_stiffness =
        s.linear_density * std::pow(2 * first * s.length * s.length / std::numbers::pi, 2);
    s.tension = s.bending_stiffness * std::pow(d.decades(0.3, 10) / s.length, 2);
}

bool to_be_matched(Dice& d, String& s, Matching kind) {
    if (kind == Matching::bar) stiffen(d, s);
    std::erase_if(s.barriers,
                  [](const Barrier& b) { return !std::holds_alternative<LumpedBarrier>(b); });
    if (s.barriers.size() > 1) s.barriers.resize(1);
    if (kind != Matching::string && s.barriers.empty()) return false;
    for (Barrier& any : s.barriers) {
        LumpedBarrier& b = std::get<LumpedBarrier>(any);
        b.contact_loss = 0;
        if (kind != Matching::wide) continue;
        b.width = d.between(0.01, 0.06);
        b.position = d.between(0.5 * b.width, s.length - 0.5 * b.width);
    }
    s.polarisation.reset();
    s.thread.reset();
    if (d.chance(0.7))
        s.thread = Thread{(0.003 + d.unit() * d.one_of({0.03, 0.3})) * s.length, 0,
                          d.decades(1e3, 3e5), d.chance(0.1) ? 0 : d.decades(3e-3, 2), 0};
    const int modes = modes_below(s, 20e3);
    return modes >= 8 && modes <= 150 && (s.thread || !s.barriers.empty()) &&
           !std::holds_alternative<TableDamping>(s.damping);
}
}  // namespace

RandomCase matching_case(std::uint64_t seed, Matching kind) {
    Dice d{std::mt19937_64(seed)};
    RandomCase c;
    c.seed = seed;
    c.settings.tap_rate = c.settings.sample_rate = 44100;
    c.scene.name = "matched" + std::to_string(seed);
    c.scene.duration = 0.01;
    c.scene.strings.resize(1);
    do c.scene.strings[0] = string_of(d);
    while (!to_be_matched(d, c.scene.strings[0], kind));
    const String& s = c.scene.strings[0];
    c.settings.modes = modes_below(s, 20e3);
    c.scene.taps = {{"nut", Quantity::nut_force, 0, 0},
                    {"y", Quantity::displacement, 0, 0.3 * s.length}};
    if (!s.barriers.empty()) c.scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    if (s.thread) c.scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    validate(c.scene);
    return c;
}

RandomCase random_case(std::uint64_t seed) {
    Dice d{std::mt19937_64(seed)};
    for (;;) try {
            RandomCase c = drawn(d);
            c.seed = seed;
            c.scene.name += std::to_string(seed);
            validate(c.scene);
            return c;
        } catch (const BadScene&) {  // an extreme number that does not fit the string
        }
}

}  // namespace jvari::test
