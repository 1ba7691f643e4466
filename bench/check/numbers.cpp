// Changes the numbers in a scene separately, and builds scenes that together have all numbers.
#include <vector>

#include "bench/check/promise.hpp"
#include "scenes/schema.hpp"

namespace jvari::bench::check {

namespace {
struct Change : Pass<Change> {
    int left;      // how many numbers precede the changed number
    double tenth;  // sign gives the direction
    std::string key{};

    Change(int which, double by) : left(which), tenth(by) {}
    bool is_it(const char* name) {
        if (left-- != 0) return false;
        key = at(name);
        return true;
    }
    double other(double x, const std::string& unit) const {
        const double of = x != 0                                             ? x
                          : unit == "m" || unit == "s" || unit == "m or m/s" ? 1e-3
                          : unit == "N m^2"                                  ? 1e-3
                                                                             : 1;
        return x + tenth * of;
    }
    void number(const char* name, double& x, const Range&, const char* unit, auto&&...) {
        if (is_it(name)) x = other(x, unit);
    }
    void stiffness(const char* name, double& k, const char* unit) {
        if (k != rigid) number(name, k, positive, unit);
    }
    void tension(String& s) { number("tension", s.tension, positive, "N"); }
    void count(const char* name, int& n) {
        if (is_it(name)) n += 1;
    }
    void start_table(TableStart& t) {
        for (const auto& [name, values] : {std::pair{"x_m", &t.at},
                                           {"displacement_m", &t.displacement},
                                           {"velocity_m_per_s", &t.velocity}})
            if (!(t.of_modes && values == &t.at) && is_it(name))
                for (double& x : *values) x = other(x, "m");
    }
    void force(const char*, Pluck& p) {
        if (p.file.empty() || !is_it("time_s")) return;
        for (double& t : p.time) t = other(t, "s");
        p.start = p.time.front(), p.duration = p.time.back() - p.start;
    }
    void columns(const char* name, const std::string&, const Column& first, std::vector<double>& a,
                 const Column& second, std::vector<double>& b) {
        for (const auto& [column, values] : {std::pair{first, &a}, {second, &b}})
            if (is_it(name)) {
                key += std::string(".") + column.name;
                for (double& x : *values) x = other(x, x == 0 ? "m" : "");
            }
    }
};
}  // namespace

std::optional<Changed> changed(const Scene& scene, int which, bool down) {
    Changed c{"", scene};
    Change change(which, down ? -0.1 : 0.1);
    fields(change, c.scene);
    if (change.key.empty()) return std::nullopt;
    c.key = change.key;
    return c;
}

namespace {
std::vector<Scene> make_scenes_of_numbers() {
    constexpr double L = 0.3;  // [m]: 437 Hz
    String played;
    played.length = L;
    played.linear_density = 4.83e-4;
    played.tension = 33.1;
    played.bending_stiffness = 2e-3;
    played.damping = PolynomialDamping{40, 1, 2e-4};
    played.start = TriangleShape{0.1, 1e-3, 0.15};
    const auto scene = [&](const char* name, std::vector<String> strings) {
        Scene s;
        s.name = name;
        s.duration = 3e-3;
        s.strings = std::move(strings);
        for (int k = 0; k < static_cast<int>(s.strings.size()); ++k) {
            const auto hear = [&](const char* what, Quantity q, double x) {
                s.taps.push_back({what + std::to_string(k), q, k, x});
            };
            hear("y", Quantity::displacement, 0.11);
            hear("v", Quantity::velocity, 0.17);
            hear("nut", Quantity::nut_force, 0);
            if (!s.strings[k].barriers.empty()) hear("bridge", Quantity::bridge_force, 0);
            if (s.strings[k].thread) hear("thread", Quantity::thread_force, 0);
            if (!s.strings[k].barriers.empty() || s.strings[k].thread)
                hear("driving", Quantity::driving_force, 0);
        }
        return s;
    };
    std::vector<Scene> all;
    // changes to the played string, separately for each string
    const auto add = [&](const char* name, auto... changes) {
        std::vector<String> strings;
        (changes(strings.emplace_back(played)), ...);
        all.push_back(scene(name, std::move(strings)));
    };
    using Barriers = std::vector<Barrier>;
    const auto over = [](const Barriers& b) { return [b](String& s) { s.barriers = b; }; };
    const auto limp = [](String& s) { s.bending_stiffness = 0, s.damping = NoDamping{}; };
    add("free", [](String&) {});
    add("struck", [](String& s) {
        s.start.reset();
        s.velocity = TriangleShape{0.12, 2, 0.15};
    });
    add("hammered", [](String& s) {
        s.masses = {{2e-3, 0.12, 0.08, 1, 2e-4, 3e4, 1.5, 0.3},
                    {3e-3, 0.2, 0.06, 0.8, 1e-4, 2e4, 1, 0}};
    });
    for (const int mass : {0, 1}) {
        const std::string number = std::to_string(mass);
        all.back().taps.push_back({"z" + number, Quantity::displacement, 0, 0, mass});
        all.back().taps.push_back({"mass" + number, Quantity::bridge_force, 0, 0, mass});
    }
    add("ring", [](String& s) {  // on a spring, and with a weight
        s.masses = {{2e-3, 0.12, 0.08, 1, 2e-4, 3e4, 1.5, 10, LossLaw::clipped}};
        Mass& ring = s.masses.front();
        ring.spring = 400, ring.damping = 0.4, ring.weight = 0.5;
    });
    all.back().taps.push_back({"z0", Quantity::displacement, 0, 0, 0});
    LumpedBarrier above{0.08, 0.08, 3e-4, {900}, 1, 0};
    above.side = Side::above;
    add("jaws", over({above, LumpedBarrier{0.2, 0.1, -4e-4, {1500}, 1, 0}}));
    add("from_modes", [](String& s) {
        s.start = TableStart{
            "modes", "", true, {1, 2, 3, 5}, {1e-3, 4e-4, -2e-4, 1e-4}, {1, -0.8, 0.5, 0.2}};
    });
    add("from_points", [](String& s) {
        s.start = TableStart{"points",
                             "",
                             false,
                             {0.05, 0.12, 0.2, 0.26},
                             {6e-4, 1e-3, 7e-4, 2e-4},
                             {0.4, 0.6, 0.8, 0.2}};
    });
    add("measured_force", [](String& s) {
        s.start.reset();
        s.pluck = Pluck{
            0.5, 1.9e-3, 0, 3e-4, 0.13, 0.1, "force", {3e-4, 8e-4, 1.5e-3, 2.2e-3}, {0, 1, -0.4, 0},
            0.5};
    });
    add("plucked", [](String& s) {
        s.thread = Thread{0.2, 0.08, 900, 0.2, 2e-4};
        s.pluck = Pluck{0.5, 2e-3, 3, 5e-4, 0.13, 0.1};
    });
    add("two_strings",
        over({LumpedBarrier{0.08, 0.08, -3e-4, {900}, 1, 0},
              LumpedBarrier{0.2, 0.1, -4e-4, {1500}, 1, 0}}),
        [](String& s) {
            s.tension = 25;
            s.barriers = {LumpedBarrier{0.1, 0.08, -2e-4, {1200}, 1, 0}};
        });
    add("power_law", over({LumpedBarrier{0.08, 0.08, -3e-4, {3e4}, 1.5, 0.6},
                           LumpedBarrier{0.2, 0.1, -4e-4, {8e4}, 1.6, 0.9}}));
    add("contact_loss", over({LumpedBarrier{0.08, 0.08, -3e-4, {900}, 1, 0.6}}));
    add("clipped_loss", over({LumpedBarrier{0.08, 0.08, -3e-4, {900}, 1, 10, LossLaw::clipped}}));
    add("at_rest", [&over](String& s) {
        over({LumpedBarrier{0.2, 0.1, 3e-4, {900}, 1, 0}})(s);
        s.start = RestStart{};
        s.thread = Thread{0.08, 0.06, 900, 0.2, 2e-4};
        s.pluck = Pluck{0.3, 2e-3, 3, 5e-4, 0.13, 0.1};
    });
    // hard for the string as bridges of the library are: k L/T = 1e4, 1e6
    add("hard_bridge", over({LumpedBarrier{0.08, 0.08, -3e-4, {1e6}, 1, 0}}));
    add("harder_bridge", over({LumpedBarrier{0.08, 0.08, -3e-4, {1e8}, 1, 0}}));
    add("flat", over({ProfileBarrier{FlatCurve{}, 0.04, 0.12, {3e4}, 1, 0}}));
    add("line", over({ProfileBarrier{LineCurve{-0.002}, 0.04, 0.12, {3e4}, 1, 0}}));
    add("parabola", over({ProfileBarrier{ParabolaCurve{0.02}, 0.04, 0.12, {1e6}, 1.4, 0.4}}));
    const TableCurve table{"table", {0, 0.1, 0.3}, {-2e-4, -1e-4, -4e-4}};
    add("table_curve", over({ProfileBarrier{table, 0.05, 0.15, {3e4}, 1, 0}}));
    for (auto one = all.end() - 4; one != all.end(); ++one) one->duration = 2e-3;
    add("rigid_profile", [&](String& s) {
        limp(s);
        s.barriers = {ProfileBarrier{ParabolaCurve{0.05}, 0, 0.1, {rigid}, 1, 0}};
    });
    add("quality_factor", [](String& s) {
        s.damping = QualityFactorDamping{1e-3, 1.8e-4, 1.2, 1e-3, 0.02};
    });
    add("per_period", [](String& s) { s.damping = PerPeriodDamping{0.8}; });
    add("measured", [](String& s) {
        TableDamping t;
        t.file = "measured";
        for (int i = 1; i <= 48; ++i)
            t.frequency_hz.push_back(430.0 * i * (1 + 1e-3 * i)),
                t.decay_rate.push_back(30.0 + 5 * i);
        s.damping = t;
        s.bending_stiffness = 0;
    });
    add("body", over({LumpedBarrier{0.1, 0.1, -3e-4, {900}, 1, 0}}),
        [](String& s) { s.tension = 25; });
    for (String& s : all.back().strings) s.bending_stiffness = 1e-4;
    all.back().body = Body{"", "", {{0.02, 2.5e4, 3}, {0.05, 2e5, 10}}};
    all.back().duration = 2.5e-3;
    all.back().taps.push_back({"support", Quantity::velocity, 0, 0});
    add("stretching", [](String& s) { s.axial_stiffness = 5e4; });
    add("two_planes", [&](String& s) {
        limp(s);
        s.polarisation = Polarisation{0.3, 0.4};
    });
    all.back().taps.resize(1);
    return all;
}
}  // namespace

const std::vector<Scene>& scenes_of_numbers() {
    static const std::vector<Scene> scenes = make_scenes_of_numbers();
    return scenes;
}

}  // namespace jvari::bench::check
