#include "bench/suite/figure_facets.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "analysis/spectrum.hpp"
#include "bench/sound/radiation.hpp"
#include "bench/store/usage.hpp"
#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

namespace {
constexpr const char* profile_tap = "profile_";

// A pressure is a filter of a force, whose tap has its name.
struct Pressure {
    const char* tap;
    sound::RadiatingEnd end;
};
constexpr Pressure pressures[] = {{"bridge_pressure", sound::bridge_end}, {"nut_pressure", sound::nut_end}};
const Pressure* pressure_of(const std::string& tap) {
    const auto* p = std::ranges::find_if(pressures, [&tap](const Pressure& one) { return tap == one.tap; });
    return p == std::end(pressures) ? nullptr : p;
}
bool is_drawn_alone(const Tap& t) {
    return t.name.rfind(profile_tap, 0) == 0 || pressure_of(t.name);
}

std::string short_text(double x) {
    return std::isfinite(x) ? fmt::format("{:.8g}", x) : "";
}

std::vector<double> column_of(const MeasuredCell& m, const std::string& tap) {
    const auto copy = [](std::span<const double> x) { return std::vector<double>(x.begin(), x.end()); };
    if (tap == "energy") return m.trace.energy.empty() ? std::vector<double>() : copy(m.trace.energy_column(0));
    const auto name = std::find(m.trace.names.begin(), m.trace.names.end(), tap);
    const auto x = m.trace.column(static_cast<int>(name - m.trace.names.begin()));
    const Pressure* p = pressure_of(tap);
    if (!p) return copy(x);
    return sound::radiation_of(*m.scene.body, p->end, m.trace.tap_rate)(x);
}

double position_of(const FigureRows& p, int i) {
    return p.count == 1 ? p.from : p.from + (p.to - p.from) * i / (p.count - 1);
}

using store::needed;
store::Key<FigureRows> taps_key() {
    return needed("taps", &FigureRows::taps, store::several(store::text()), "names of taps, or energy, bridge_pressure, nut_pressure");
}

std::vector<std::pair<std::string, Quantity>> quantities() {
    std::vector<std::pair<std::string, Quantity>> all;
    for (int q = 0; q <= static_cast<int>(Quantity::driving_force); ++q)
        all.emplace_back(name_of(static_cast<Quantity>(q)), static_cast<Quantity>(q));
    return all;
}
}  // namespace

store::Key<FigureFacets> figure_taps_key() {
    const auto tap =
        store::table(std::vector{store::needed("name", &Tap::name, store::text(), "what it is called"),
                                 store::needed("quantity", &Tap::quantity, store::one_of("quantity", quantities()), "what is heard"),
                                 store::key("string", &Tap::string, store::whole(0, 1000), "which one", "of forces, the sum over strings"),
                                 store::key("position", &Tap::position, store::not_negative("m"), "of displacement and velocity")});
    store::Key<FigureFacets> key = store::key("taps", &FigureFacets::taps, store::several(tap), "taps beside those of the scene");
    key.read = [read = key.read](FigureFacets& f, const store::Entry& e) {
        read(f, e);
        f.identity += "taps=" + e.identity() + ";";
    };
    return key;
}

store::Key<FigureFacets> figure_rows_key(const char* facet, const store::Kind<FigureRows>& kind) {
    return {{facet, kind.says, "", fmt::format("describes the measure `{}`", facet), false, kind.below},
            [facet, read = kind.read](FigureFacets& f, const store::Entry& e) {
                f.rows[facet] = read(e);
                f.identity += std::string(facet) + "=" + e.identity() + ";";
            }};
}

Scene with_figure_taps(Scene scene, const FigureFacets& f) {
    scene.taps.insert(scene.taps.end(), f.taps.begin(), f.taps.end());
    std::vector<std::string> names{"energy"};
    for (const Tap& t : scene.taps) names.push_back(t.name);
    for (const auto& [facet, rows] : f.rows)
        for (const std::string& tap : rows.taps) {
            if (std::find(names.begin(), names.end(), tap) != names.end()) continue;
            const Pressure* p = pressure_of(tap);
            if (!p) throw store::UsageError(facet + ": " + store::unknown("tap", tap, names));
            if (!scene.body || ((*scene.body).*p->end.response).empty())
                throw store::UsageError(fmt::format("{}: tap {}: the scene has no {}", facet, tap, p->end.key));
            scene.taps.push_back({tap, p->end.force, {}, 0});
            names.push_back(tap);
        }
    if (const auto profile = f.rows.find("profile"); profile != f.rows.end())
        for (int i = 0; i < profile->second.count; ++i)
            scene.taps.push_back({fmt::format("{}{}", profile_tap, i), Quantity::displacement, 0, position_of(profile->second, i)});
    validate(scene);
    return scene;
}

Scene without_drawn_taps(Scene scene) {
    std::erase_if(scene.taps, is_drawn_alone);
    return scene;
}

store::Kind<FigureRows> trace_table() {
    return store::table(std::vector{
        taps_key(),
        needed("windows", &FigureRows::windows, store::several(store::from_to(store::not_negative("s"))), "every row of each is kept")});
}

store::Table trace_rows(const MeasuredCell& m) {
    store::Table t{{"tap", "window_s", "time_s", "value"}, {}};
    const FigureRows& f = m.set.figures.rows.at("trace");
    for (const std::string& tap : f.taps) {
        const auto x = column_of(m, tap);
        for (const auto& [from, to] : f.windows) {
            const double rate = m.trace.tap_rate, last = std::min<double>(std::floor(to * rate + 1e-6), static_cast<double>(x.size()) - 1);
            for (auto n = static_cast<long>(std::ceil(from * rate - 1e-6)); static_cast<double>(n) <= last; ++n)
                t.rows.push_back({tap, short_text(from), short_text(static_cast<double>(n) / rate), short_text(x[n])});
        }
    }
    return t;
}

store::Kind<FigureRows> extent_table() {
    return store::table(
        std::vector{taps_key(), needed("intervals", &FigureRows::count, store::whole(1, 100'000), "equal parts of the run")});
}

store::Table extent_rows(const MeasuredCell& m) {
    store::Table t{{"tap", "time_s", "low", "high"}, {}};
    const FigureRows& f = m.set.figures.rows.at("extent");
    for (const std::string& tap : f.taps) {
        const auto x = column_of(m, tap);
        const double each = static_cast<double>(x.size()) / f.count;
        for (int i = 0; i < f.count; ++i) {
            const auto first = static_cast<std::size_t>(i * each), end = std::min(x.size(), static_cast<std::size_t>((i + 1) * each));
            if (first >= end) continue;
            const auto [low, high] = std::minmax_element(x.begin() + first, x.begin() + end);
            t.rows.push_back({tap, short_text((i + 0.5) * each / m.trace.tap_rate), short_text(*low), short_text(*high)});
        }
    }
    return t;
}

store::Kind<FigureRows> profile_table() {
    const auto from_below_to = [](FigureRows& p, const store::Entry& e) {
        if (!(p.from < p.to)) e.need("to").refuse("more than from");
    };
    return store::table(
        std::vector{needed("instants", &FigureRows::instants, store::several(store::not_negative("s")), "the row nearest each is kept"),
                    needed("from", &FigureRows::from, store::not_negative("m"), "along string 0"),
                    needed("to", &FigureRows::to, store::positive("m"), "along string 0"),
                    needed("positions", &FigureRows::count, store::whole(1, 2000), "between them")},
        +from_below_to);
}

store::Table profile_rows(const MeasuredCell& m) {
    store::Table t{{"time_s", "position_m", "displacement_m"}, {}};
    const FigureRows& f = m.set.figures.rows.at("profile");
    const int first = m.trace.taps() - f.count;
    for (const double instant : f.instants) {
        const long row = std::lround(instant * m.trace.tap_rate);
        if (row >= m.trace.rows) continue;
        for (int i = 0; i < f.count; ++i)
            t.rows.push_back({short_text(static_cast<double>(row) / m.trace.tap_rate), short_text(position_of(f, i)),
                              short_text(m.trace.column(first + i)[row])});
    }
    return t;
}

store::Kind<FigureRows> envelope_table() {
    return store::table(std::vector{
        taps_key(), needed("width_hz", &FigureRows::width_hz, store::positive("Hz"), "the largest bin within half of it is the envelope"),
        needed("to_hz", &FigureRows::to_hz, store::positive("Hz"), "the last point"),
        needed("points", &FigureRows::count, store::whole(1, 100'000), "spaced evenly")});
}

store::Table envelope_rows(const MeasuredCell& m) {
    store::Table t{{"tap", "frequency_hz", "level_db"}, {}};
    const FigureRows& f = m.set.figures.rows.at("envelope");
    for (const std::string& tap : f.taps) {
        const PowerSpectrum s = power_spectrum(column_of(m, tap), m.trace.tap_rate);
        const auto envelope = spectral_envelope(s, f.width_hz);
        for (int i = 1; i <= f.count; ++i) {
            const double frequency = f.to_hz * i / f.count;
            const auto bin = static_cast<std::size_t>(std::lround(frequency / s.bin_hz));
            if (bin < envelope.size()) t.rows.push_back({tap, short_text(frequency), short_text(envelope[bin])});
        }
    }
    return t;
}

store::Kind<FigureRows> centroid_table() {
    return store::table(std::vector{taps_key(), needed("window", &FigureRows::window, store::positive("s"), "of a frame"),
                                    needed("hop", &FigureRows::hop, store::positive("s"), "from frame to frame"),
                                    store::key("from_hz", &FigureRows::from_hz, store::not_negative("Hz"), "what is below does not count"),
                                    store::key("to_hz", &FigureRows::to_hz, store::positive("Hz"), "what is above does not count", "all")});
}

store::Table centroid_rows(const MeasuredCell& m) {
    store::Table t{{"tap", "time_s", "centroid_hz"}, {}};
    const FigureRows& f = m.set.figures.rows.at("centroid");
    for (const std::string& tap : f.taps) {
        const int window = std::max(2, static_cast<int>(std::lround(f.window * m.trace.tap_rate)));
        const int hop = std::max(1, static_cast<int>(std::lround(f.hop * m.trace.tap_rate)));
        const Spectrogram s = spectrogram(column_of(m, tap), m.trace.tap_rate, window, hop);
        for (int i = 0; i < s.frames; ++i) {
            double power = 0, moment = 0;
            for (int k = 0; k < s.bins; ++k)
                if (k * s.bin_hz >= f.from_hz && k * s.bin_hz <= f.to_hz) power += s.frame(i)[k], moment += k * s.bin_hz * s.frame(i)[k];
            t.rows.push_back({tap, short_text(s.centre + i * s.hop), short_text(power > 0 ? moment / power : NAN)});
        }
    }
    return t;
}

}  // namespace jvari::bench::suite
