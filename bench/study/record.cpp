#include "bench/study/record.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "analysis/spectrum.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"

namespace jvari::bench::study {

namespace {
using Json = nlohmann::ordered_json;

template <class Lines>
Json numbers(const Lines& lines) {  // texts, because JSON has no NaN
    Json all = Json::array();
    for (const auto& line : lines) {
        Json row = Json::array();
        for (const double x : line) row.push_back(store::text_of(x));
        all.push_back(row);
    }
    return all;
}
Errors errors_in(const Json& j) {
    Errors errors;
    for (const Json& row : j) {
        errors.emplace_back();
        for (const Json& x : row) errors.back().push_back(store::number_of(x));
        if (errors.back().size() != measures().size())
            throw std::runtime_error("not one number for each measure");
    }
    return errors;
}
std::vector<Trust::ByWaveform> figures_in(const Json& j) {
    std::vector<Trust::ByWaveform> figures;
    for (const Json& row : j)
        for (auto& of_tap = figures.emplace_back(); double& x : of_tap)
            x = store::number_of(row.at(static_cast<std::size_t>(&x - of_tap.data())));
    return figures;
}

Json summary_json(const Summary& s) {
    Json j{{"scheme", s.scheme},
           {"scene", s.scene},
           {"status", {name_of(s.status.outcome), s.status.step}},
           {"facts", Json::array()}};
    each_figure(s, [&j]<class Number>(const char* name, Number x) {
        if constexpr (std::is_integral_v<Number>) j[name] = x;
        else j[name] = store::text_of(x);
    });
    for (const Fact& f : s.facts) j["facts"].push_back({f.name, store::text_of(f.value), f.unit});
    return j;
}
Summary summary_in(const Json& j) {
    Summary s{};
    s.scheme = j.at("scheme");
    s.scene = j.at("scene");
    s.status = {store::outcome_named(j.at("status").at(0)),
                store::whole<long>(j.at("status").at(1))};
    each_figure(s, [&j]<class Number>(const char* name, Number& x) {
        if constexpr (std::is_integral_v<Number>) x = store::whole<Number>(j.at(name));
        else x = store::number_of(j.at(name));
    });
    for (const Json& f : j.at("facts"))
        s.facts.push_back({f.at(0), store::number_of(f.at(1)), f.at(2)});
    return s;
}

Json sound_json(const store::Sound& s) {
    return {store::text_of(s.rate), store::text_of(s.peak), store::base64(s.samples)};
}
store::Sound sound_in(const Json& j) {
    return {store::number_of(j.at(0)), store::number_of(j.at(1)),
            store::samples_of_base64(j.at(2).get<std::string>())};
}

Json levels_json(const Levels& l) {
    return {{"frames", l.frames}, {"rows", l.rows},     {"start", l.start},
            {"hop", l.hop},       {"row_hz", l.row_hz}, {"tenths_of_db", l.level}};
}
Levels levels_in(const Json& j) {
    Levels l{store::whole<int>(j.at("frames")),
             store::whole<int>(j.at("rows")),
             j.at("start"),
             j.at("hop"),
             j.at("row_hz"),
             {}};
    for (const Json& tenths : j.at("tenths_of_db")) l.level.push_back(store::whole<int>(tenths));
    if (l.frames < 0 || l.rows < 0 || l.level.size() != static_cast<std::size_t>(l.frames) * l.rows)
        throw std::runtime_error("not one level for each frame and row");
    return l;
}
}  // namespace

std::string json_of(const Record& r, const std::string& identity) {
    const Cell& c = r.cell;
    const Against& a = r.against;
    return store::kept_text(identity, {{"failure", c.failure},
                                       {"beside", r.beside},
                                       {"reason", c.reason},
                                       {"cause", c.cause},
                                       {"summary", summary_json(c.summary)},
                                       {"errors", numbers(c.errors)},
                                       {"in_model", numbers(c.in_model)},
                                       {"against",
                                        {{"reference", a.reference},
                                         {"modes", a.modes},
                                         {"doubling", a.doubling},
                                         {"limit_hz", store::text_of(a.limit_hz)},
                                         {"floor", numbers(a.floor)},
                                         {"certificate", numbers(a.trust.figure)},
                                         {"left_out", numbers(a.trust.left_out)},
                                         {"certificate_in_model", numbers(a.model_trust.figure)}}},
                                       {"sound", sound_json(c.sound)},
                                       {"reference_sound", sound_json(r.reference_sound)},
                                       {"levels", levels_json(r.levels)}});
}

std::optional<Record> read_record(const std::filesystem::path& path, const std::string& identity,
                                  const Cell& planned) {
    return store::read_kept(path, identity, [&planned](const Json& j) {
        Record r{planned, {}, {}, {}};
        r.cell.failure = j.at("failure");
        r.cell.reason = j.at("reason");
        r.cell.cause = j.value("cause", "");
        r.cell.summary = summary_in(j.at("summary"));
        r.cell.errors = errors_in(j.at("errors"));
        r.cell.in_model = errors_in(j.at("in_model"));
        r.cell.sound = sound_in(j.at("sound"));
        const Json& a = j.at("against");
        r.against.reference = a.at("reference");
        r.against.modes = store::whole<int>(a.at("modes"));
        r.against.doubling = a.at("doubling");
        r.against.limit_hz = store::number_of(a.at("limit_hz"));
        r.against.floor = errors_in(a.at("floor"));
        r.against.trust.figure = figures_in(a.at("certificate"));
        r.against.trust.left_out = figures_in(a.at("left_out"));
        r.against.model_trust.figure = figures_in(a.at("certificate_in_model"));
        r.reference_sound = sound_in(j.at("reference_sound"));
        r.levels = levels_in(j.at("levels"));
        r.beside = j.value("beside", "");
        return r;
    });
}

std::optional<Levels> read_levels(const std::filesystem::path& path, const std::string& name) {
    return store::read_kept(path, [&name](const Json& j) {
        const Json measured = store::parsed(j.at("of").at("measured").get<std::string>());
        if (std::find(measured.begin(), measured.end(), name) == measured.end())
            throw std::runtime_error("it was not measured");
        return levels_in(j.at("levels"));
    });
}

// ---- A spectrogram

namespace {
constexpr double highest_hz = 8000;
}

Levels levels_of(std::span<const double> signal, double rate) {
    Levels l;
    const int size = static_cast<int>(signal.size());
    int window = 64;
    while (2 * window <= 0.047 * rate && 8 * window <= size) window *= 2;
    if (size < window) return l;
    const int hop = std::max(1, (size - window) / 59);
    const Spectrogram s = spectrogram(signal, rate, window, hop);
    const double highest = std::min(highest_hz, rate / 2);
    l.frames = s.frames;
    l.rows = std::max(1, std::min(100, static_cast<int>(highest / s.bin_hz)));
    l.row_hz = highest / l.rows;
    l.start = s.centre - s.hop / 2;
    l.hop = s.hop;
    l.level.assign(static_cast<std::size_t>(l.frames) * l.rows, silent_level);
    for (int m = 0; m < s.frames; ++m)
        for (int k = 0; k < s.bins && k * s.bin_hz < highest; ++k) {
            const int row = std::min(l.rows - 1, static_cast<int>(k * s.bin_hz / l.row_hz));
            const double power = s.frame(m)[k];
            int& level = l.level[static_cast<std::size_t>(m) * l.rows + row];
            if (power > 1e-40)
                level = std::max(level, static_cast<int>(std::lround(100 * std::log10(power))));
        }
    return l;
}

}  // namespace jvari::bench::study
