#include "bench/report/run_chart.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/energy.hpp"
#include "analysis/spectrum.hpp"
#include "bench/report/identity.hpp"
#include "bench/report/page.hpp"
#include "bench/report/spectrogram_chart.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
constexpr long most_points = 1000;  // of a line: beyond, least and greatest value of each stretch
constexpr std::size_t most_contacts = 2000;
constexpr int width = 700;

double shortened(double x) {  // six digits are enough for a point
    return std::isfinite(x) ? std::stod(fmt::format("{:.6g}", x)) : std::nan("");
}

Json axis(const char* field, const std::string& title, Json scale = Json::object(), const char* format = "~g") {
    return {{"field", field},
            {"type", "quantitative"},
            {"scale", std::move(scale)},
            {"axis", {{"title", title}, {"format", format}, {"titleLimit", 260}}}};
}

Json panel(const std::string& title, int height, Json values, Json mark, Json encoding) {
    return {{"title", {{"text", title}, {"anchor", "start"}, {"fontSize", 12}}},
            {"width", width},
            {"height", height},
            {"data", {{"values", std::move(values)}}},
            {"mark", std::move(mark)},
            {"encoding", std::move(encoding)}};
}

Json waveform(const std::string& title, const std::string& unit, std::span<const double> x, double rate, const std::string& hue) {
    const long rows = static_cast<long>(x.size()), count = std::min(rows, most_points);
    Json values = Json::array();
    for (long k = 0; k < count; ++k) {
        const long from = k * rows / count;
        const auto [least, most] = std::minmax_element(x.begin() + from, x.begin() + (k + 1) * rows / count);
        values.push_back({{"t", shortened(static_cast<double>(from) / rate)}, {"a", shortened(*least)}, {"b", shortened(*most)}});
    }
    const bool whole = count == rows;
    Json encoding{{"x", axis("t", "time [s]", {{"nice", false}})}, {"y", axis("a", unit)}};
    if (!whole) encoding["y2"] = {{"field", "b"}};
    return panel(title, 110, values, {{"type", whole ? "line" : "area"}, {"color", hue}, {"strokeWidth", 1.2}, {"line", false}}, encoding);
}

Json spectrum(const std::string& title, std::span<const double> x, double rate, const std::string& hue) {
    const PowerSpectrum s = power_spectrum(x, rate);
    constexpr int bins = 800;
    const double lowest = std::max(20.0, s.bin_hz), highest = rate / 2;
    std::vector<double> strongest(bins, 0);
    for (std::size_t k = 1; k < s.power.size(); ++k)
        if (const double hz = static_cast<double>(k) * s.bin_hz; hz >= lowest && hz <= highest) {
            double& level =
                strongest[static_cast<std::size_t>(std::min<double>(bins - 1, bins * std::log(hz / lowest) / std::log(highest / lowest)))];
            level = std::max(level, s.power[k]);
        }
    const double most = *std::max_element(strongest.begin(), strongest.end());
    Json values = Json::array();
    for (int k = 0; k < bins; ++k)
        if (const double p = strongest[static_cast<std::size_t>(k)]; p > 0)
            values.push_back({{"f", shortened(lowest * std::pow(highest / lowest, (k + 0.5) / bins))},
                              {"l", shortened(std::max(-140.0, 10 * std::log10(p / most)))}});
    return panel(title, 140, values, {{"type", "line"}, {"color", hue}, {"strokeWidth", 1}},
                 {{"x", axis("f", "frequency [Hz]", {{"type", "log"}, {"nice", false}}, ",~r")},
                  {"y", axis("l", "level re strongest [dB]", Json::object(), "d")}});
}

Json spectrogram_panel(const std::string& title, std::span<const double> x, double rate) {
    Json one = Json::parse(spectrogram_spec("", "", {{title, "", "", study::levels_of(x, rate)}}, 2800)).at("concat").at(0);
    one["width"] = width;
    one["height"] = 160;
    one["title"] = {{"text", title}, {"anchor", "start"}, {"fontSize", 12}};
    if (one.contains("encoding")) one["encoding"]["y"]["axis"]["title"] = "frequency [kHz]";
    return one;
}

Json ledger(const Trace& t, const std::string& hue) {
    const long count = std::min(t.rows, most_points);
    const auto stored = t.energy_column(0), supplied = t.energy_column(1), dissipated = t.energy_column(2);
    Json values = Json::array();
    double in = 0, out = 0;
    long row = 0;
    for (long k = 0; k < count; ++k) {
        for (const long until = (k + 1) * t.rows / count; row < until; ++row) {
            if (row == 0) continue;  // the sums are over the interval that ends at a row
            in += supplied[static_cast<std::size_t>(row)];
            out += dissipated[static_cast<std::size_t>(row)];
        }
        const double at = static_cast<double>(row - 1) / t.tap_rate;
        for (const auto& [what, joule] : {std::pair("stored", stored[static_cast<std::size_t>(row - 1)]), std::pair("supplied so far", in),
                                          std::pair("dissipated so far", out)})
            values.push_back({{"t", shortened(at)}, {"what", what}, {"j", shortened(joule)}});
    }
    const EnergyBalance b = energy_balance(t);
    return panel(fmt::format("energy ledger, open by {:.1e} of the largest stored energy", b.accumulated), 110, values,
                 {{"type", "line"}, {"color", hue}, {"strokeWidth", 1.4}},
                 {{"x", axis("t", "time [s]", {{"nice", false}})},
                  {"y", axis("j", "J")},
                  {"strokeDash",
                   {{"field", "what"},
                    {"type", "nominal"},
                    {"scale", {{"domain", {"stored", "supplied so far", "dissipated so far"}}, {"range", {{1, 0}, {6, 3}, {2, 3}}}}},
                    {"legend", {{"title", nullptr}, {"symbolType", "stroke"}, {"symbolSize", 500}, {"symbolStrokeWidth", 1.4}}}}}});
}

struct Contact {
    std::string tap;
    double from, to;  // [s]
};

std::vector<Contact> contacts_of(const DrawnRun& r) {
    std::vector<Contact> contacts;
    for (int k = 0; k < r.trace.taps(); ++k) {
        if (r.scene.taps.at(static_cast<std::size_t>(k)).quantity != Quantity::bridge_force) continue;
        const auto force = r.trace.column(k);
        for (std::size_t n = 0; n < force.size(); ++n) {
            if (force[n] == 0) continue;  // the mean over the interval that ends at the row
            const double end = static_cast<double>(n) / r.trace.tap_rate, begin = end - 1 / r.trace.tap_rate;
            if (n > 0 && force[n - 1] != 0) contacts.back().to = end;
            else contacts.push_back({r.trace.names[static_cast<std::size_t>(k)], begin, end});
        }
    }
    return contacts;
}

Json contact_panel(const std::vector<Contact>& contacts, double until, const std::string& hue) {
    Json values = Json::array();
    double sum = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        sum += contacts[k].to - contacts[k].from;
        if (k < most_contacts)
            values.push_back({{"a", shortened(contacts[k].from)}, {"b", shortened(contacts[k].to)}, {"tap", contacts[k].tap}});
    }
    return panel(fmt::format("contact: {} times, {:.2g} % of the time{}", contacts.size(), 100 * sum / until,
                             contacts.size() > most_contacts ? fmt::format("; the first {} are drawn", most_contacts) : ""),
                 26, values, {{"type", "bar"}, {"height", 16}, {"color", hue}},
                 {{"x", axis("a", "time [s]", {{"domain", {0, shortened(until)}}, {"nice", false}})},
                  {"x2", {{"field", "b"}}},
                  {"y", {{"field", "tap"}, {"type", "nominal"}, {"title", nullptr}}}});
}
}  // namespace

std::string run_spec(const DrawnRun& r, Medium medium) {
    const Trace& t = r.trace;
    const std::string hue = identities_of({r.scheme}).front().colour;
    Json panels = Json::array();
    for (int k = 0; k < std::min(t.taps(), 4); ++k) {
        const auto& tap = r.scene.taps.at(static_cast<std::size_t>(k));
        panels.push_back(
            waveform(fmt::format("{} ({})", tap.name, name_of(tap.quantity)), unit_of(tap.quantity), t.column(k), t.tap_rate, hue));
    }
    if (t.taps() > 0 && t.rows > 64) {
        panels.push_back(spectrum("spectrum of " + t.names[0], t.column(0), t.tap_rate, hue));
        panels.push_back(spectrogram_panel("spectrogram of " + t.names[0], t.column(0), t.tap_rate));
    }
    if (!t.energy.empty() && std::isfinite(energy_balance(t).accumulated)) panels.push_back(ledger(t, hue));
    if (const auto contacts = contacts_of(r); !contacts.empty())
        panels.push_back(contact_panel(contacts, static_cast<double>(t.rows - 1) / t.tap_rate, hue));
    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"}, {"padding", 12}, {"spacing", 16}, {"vconcat", panels}};
    spec["resolve"] = {{"scale", {{"color", "independent"}, {"strokeDash", "independent"}}}};
    spec["config"] = Json::parse(config_of(Medium::page, false));
    if (medium == Medium::print) {
        spec["title"] = {{"text", r.title}, {"subtitle", r.subtitle}, {"anchor", "start"}, {"offset", 14}};
        spec["background"] = "white";
    }
    return spec.dump();
}

std::string run_page(const DrawnRun& r, const std::string& scripts) {
    Page page;
    page.title = r.title;
    page.about = r.subtitle;
    page.scripts = scripts;
    page.manifest = "{}";
    Section s{"run", "The run"};
    s.charts.push_back({"waveforms, spectrum, spectrogram, energy and contact of the run", run_spec(r, Medium::page), true});
    page.sections.push_back(std::move(s));
    return page_of(page);
}

}  // namespace jvari::bench::report
