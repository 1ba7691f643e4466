#include "bench/report/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/energy.hpp"
#include "analysis/spectrum.hpp"
#include "bench/report/results.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
using store::Table;
// points in a line; a longer signal shows smallest and largest value for each interval
constexpr long most_points = 1000;
constexpr std::size_t most_contacts = 2000;
constexpr double longest_kept = 20;  // [s]

store::Field short_number(double x) { return store::Field::rounded(x, 6); }

Table wave_of(std::span<const double> x, double rate) {
    Table t{{"t", "low", "high"}, {}};
    const long rows = static_cast<long>(x.size()), count = std::min(rows, most_points);
    for (long k = 0; k < count; ++k) {
        const long from = k * rows / count;
        const auto [least, most] =
            std::minmax_element(x.begin() + from, x.begin() + (k + 1) * rows / count);
        t.rows.push_back({short_number(static_cast<double>(from) / rate), short_number(*least),
                          short_number(*most)});
    }
    return t;
}

Table spectrum_of(std::span<const double> x, double rate) {  // strongest bin in each band
    const PowerSpectrum s = power_spectrum(x, rate);
    constexpr int bands = 800;
    const double lowest = std::max(20.0, s.bin_hz), span = std::log(rate / 2 / lowest);
    std::vector<double> strongest(bands, 0);
    for (std::size_t k = 1; k < s.power.size(); ++k)
        if (const double hz = static_cast<double>(k) * s.bin_hz; hz >= lowest && hz <= rate / 2) {
            double& level = strongest[static_cast<std::size_t>(
                std::min<double>(bands - 1, bands * std::log(hz / lowest) / span))];
            level = std::max(level, s.power[k]);
        }
    const double most = *std::max_element(strongest.begin(), strongest.end());
    Table t{{"f", "level"}, {}};
    for (int k = 0; k < bands; ++k)
        if (const double p = strongest[static_cast<std::size_t>(k)]; p > 0)
            t.rows.push_back({short_number(lowest * std::exp(span * (k + 0.5) / bands)),
                              short_number(std::max(-140.0, 10 * std::log10(p / most)))});
    return t;
}

Table ledger_of(const Trace& trace) {
    const long count = std::min(trace.rows, most_points);
    const auto stored = trace.energy_column(0), supplied = trace.energy_column(1),
               dissipated = trace.energy_column(2);
    Table t{{"t", "stored", "supplied", "dissipated"}, {}};
    double in = 0, out = 0;
    std::size_t row = 0;
    for (long k = 0; k < count; ++k) {
        for (const auto until = static_cast<std::size_t>((k + 1) * trace.rows / count); row < until;
             ++row) {
            if (row == 0) continue;  // sums cover the interval before a row
            in += supplied[row];
            out += dissipated[row];
        }
        t.rows.push_back({short_number(static_cast<double>(row - 1) / trace.tap_rate),
                          short_number(stored[row - 1]), short_number(in), short_number(out)});
    }
    return t;
}

Table contacts_of(const DrawnRun& r, Json& caption) {
    Table t{{"tap", "from", "to"}, {}};
    double sum = 0;
    std::size_t count = 0;
    const double rate = r.trace.tap_rate;
    for (int k = 0; k < r.trace.taps(); ++k) {
        if (r.scene.taps.at(static_cast<std::size_t>(k)).quantity != Quantity::bridge_force)
            continue;
        const auto force = r.trace.column(k);
        for (std::size_t n = 0; n < force.size(); ++n) {
            if (force[n] == 0) continue;  // mean over the interval before the row
            const std::size_t first = n;
            while (n + 1 < force.size() && force[n + 1] != 0) ++n;
            const double from = (static_cast<double>(first) - 1) / rate,
                         to = static_cast<double>(n) / rate;
            sum += to - from;
            if (++count <= most_contacts)
                t.rows.push_back({r.trace.names[static_cast<std::size_t>(k)], short_number(from),
                                  short_number(to)});
        }
    }
    const double until = static_cast<double>(r.trace.rows - 1) / rate;
    caption = {
        {"until", until},
        {"title",
         fmt::format(
             "contact: {} times, {:.2g} % of the time{}", count, 100 * sum / until,
             count > most_contacts ? fmt::format("; the first {} are drawn", most_contacts) : "")}};
    return t;
}

int heard_tap(const DrawnRun& r) {  // prefers the force on the nut, which drives the body
    for (int k = 0; k < r.trace.taps(); ++k)
        if (r.scene.taps.at(static_cast<std::size_t>(k)).quantity == Quantity::nut_force) return k;
    return 0;
}
}  // namespace

Json run_data(const DrawnRun& r) {
    const Trace& t = r.trace;
    Json data = empty_data(r.title, r.subtitle);
    Json taps = Json::array(), contact;
    std::vector<int> order;  // contact forces first
    for (int k = 0; k < t.taps(); ++k) order.push_back(k);
    const auto quantity = [&r](int k) {
        return r.scene.taps.at(static_cast<std::size_t>(k)).quantity;
    };
    std::stable_partition(order.begin(), order.end(),
                          [&](int k) { return quantity(k) == Quantity::bridge_force; });
    const auto add = [&data](const std::string& name, const Table& table) {
        data["tables"][name] = store::table_json(table);
    };
    for (const int k : order) {
        add("waves_" + std::to_string(taps.size()), wave_of(t.column(k), t.tap_rate));
        taps.push_back({{"name", t.names[static_cast<std::size_t>(k)]},
                        {"quantity", name_of(quantity(k))},
                        {"unit", unit_of(quantity(k))}});
    }
    const int tap = t.taps() > 0 ? heard_tap(r) : 0;
    std::string heard;
    if (t.taps() > 0 && t.rows > 64) {
        heard = t.names[static_cast<std::size_t>(tap)];
        add("spectrum", spectrum_of(t.column(tap), t.tap_rate));
        data["levels"].push_back(json_of(study::levels_of(t.column(tap), t.tap_rate)));
        if (const store::Sound sound = store::sound_of(t.column(tap), t.tap_rate);
            !sound.samples.empty()) {
            Json one = json_of(sound, longest_kept);
            one.update({{"name", r.scheme},
                        {"tap", heard},
                        {"quantity", name_of(quantity(tap))},
                        {"problem", ""}});
            data["sounds"].push_back(std::move(one));
        }
    }
    std::string open;
    if (!t.energy.empty() && std::isfinite(energy_balance(t).accumulated)) {
        add("ledger", ledger_of(t));
        open = fmt::format("{:.1e}", energy_balance(t).accumulated);
    }
    add("contacts", contacts_of(r, contact));
    data["run"] = {{"scheme", r.scheme},
                   {"taps", taps},
                   {"heard", heard},
                   {"contact", contact},
                   {"ledger_open", open}};
    return data;
}

}  // namespace jvari::bench::report
