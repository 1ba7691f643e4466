// Traces to look at and to listen to (sounds.csv, sounds/*.wav): 50 ms sample by sample from where the reference is liveliest, with the
// difference; the whole as its least and greatest value in each of 800 stretches; the sounds level-matched, as many as the page may hold.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/report/identity.hpp"
#include "bench/report/sections/page_sections.hpp"
#include "bench/store/sound.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
constexpr double beginning = 0.05;      // [s]
constexpr std::size_t stretches = 800;  // of the whole
constexpr std::size_t most_drawn = 40;  // waveforms: some 25 kB each
constexpr double longest_heard = 4;     // [s]
constexpr std::size_t most_heard = 120;

struct Track {
    std::size_t row;
    std::string problem, name, detail, file, reference_file;  // name: of the scheme
    store::Sound sound;
    int place;  // in the order in which they are taken: references, highest rates, lowest rates, the rest
};

bool is_reference(const store::Table& t, std::size_t i) {
    return t.at(i, "scheme") == "reference";
}

int place_of(const store::Table& t, std::size_t i) {
    if (is_reference(t, i)) return 0;
    double lowest = HUGE_VAL, highest = 0;
    for (std::size_t k = 0; k < t.rows.size(); ++k)
        if (t.at(k, "problem") == t.at(i, "problem") && t.at(k, "series") == t.at(i, "series")) {
            lowest = std::fmin(lowest, t.number(k, "rate"));
            highest = std::fmax(highest, t.number(k, "rate"));
        }
    const double rate = t.number(i, "rate");
    return !(rate < highest) ? 1 : rate <= lowest ? 2 : 3;
}

std::string reference_name(const Results& r, const std::string& problem) {
    try {
        const Json m = Json::parse(r.manifest);
        if (m.contains("reference")) return m.at("reference").at("name");
    } catch (const Json::exception&) {
    }
    for (std::size_t i = 0; i < r.cells.rows.size(); ++i)
        if (r.cells.at(i, "problem") == problem && !r.cells.at(i, "reference").empty()) return r.cells.at(i, "reference");
    return "";
}

std::vector<Track> tracks_of(const Results& r) {
    const store::Table& t = r.sounds;
    std::vector<Track> tracks;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::string detail = rate_text(t.number(i, "rate"));
        std::string name = t.at(i, "series");
        if (is_reference(t, i)) name = "reference " + reference_name(r, t.at(i, "problem"));
        const std::string& file = t.at(i, "file");
        if (const std::filesystem::path path = file; path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
            throw store::UsageError(
                fmt::format("{}: found the file {}, expected one below the folder", (r.folder / "sounds.csv").string(), file));
        tracks.push_back({i, t.at(i, "problem"), name, detail, file, t.at(i, "reference_file"),
                          store::read_wav(r.folder / file, t.number(i, "peak")), place_of(t, i)});
    }
    std::stable_sort(tracks.begin(), tracks.end(), [](const Track& a, const Track& b) { return a.place < b.place; });
    return tracks;
}

// Where something happens [s]: the first stretch of 10 ms in which the sound changes from sample to sample at least half as much as in its
// liveliest. The slow pull of a finger is left out by it.
double lively_from(const store::Sound& s) {
    const auto length = static_cast<std::size_t>(0.01 * s.rate);
    std::vector<double> changes;
    for (std::size_t from = 0; length > 0 && from + length < s.samples.size(); from += length) {
        double sum = 0;
        for (std::size_t n = from; n < from + length; ++n) sum += std::pow(s.samples[n + 1] - s.samples[n], 2);
        changes.push_back(sum);
    }
    if (changes.empty()) return 0;
    const double half = 0.5 * *std::max_element(changes.begin(), changes.end());
    const auto first = std::find_if(changes.begin(), changes.end(), [half](double x) { return x >= half; });
    return 0.01 * static_cast<double>(first - changes.begin());
}

Json stretch_of(const store::Sound& s, double from) {
    const auto begin = std::min(s.samples.size(), static_cast<std::size_t>(std::lround(from * s.rate)));
    const auto count = std::min(s.samples.size() - begin, static_cast<std::size_t>(beginning * s.rate) + 1);
    const auto at = s.samples.begin() + static_cast<long>(begin);
    return std::vector<int>(at, at + static_cast<long>(count));
}

void add_outline(Json& row, const store::Sound& s) {
    const std::size_t size = s.samples.size(), count = std::min(size, stretches);
    Json low = Json::array(), high = Json::array();
    for (std::size_t k = 0; k < count; ++k) {
        const auto [least, most] = std::minmax_element(s.samples.begin() + static_cast<long>(k * size / count),
                                                       s.samples.begin() + static_cast<long>((k + 1) * size / count));
        low.push_back(*least);
        high.push_back(*most);
    }
    row["step"] = static_cast<double>(size) / s.rate / static_cast<double>(count);
    row["low"] = std::move(low);
    row["high"] = std::move(high);
}

const char* unit_of(const std::string& quantity) {
    return quantity == "displacement" ? "m" : quantity == "velocity" ? "m/s" : "N";
}

struct Waveforms {
    Json beginnings = Json::array(), outlines = Json::array(), reference_of = Json::object(), units = Json::object(), hues = Json::object();
    Menu sounds{"scheme", "sound_field", {}};
    double longest = 0;  // [s]
};

Waveforms waveforms_of(const store::Table& t, std::vector<Track> tracks, std::size_t most) {
    Waveforms w;
    if (tracks.size() > most) tracks.erase(tracks.begin() + static_cast<long>(most), tracks.end());
    std::sort(tracks.begin(), tracks.end(), [](const Track& a, const Track& b) { return a.row < b.row; });
    std::map<std::string, double> from;  // of each problem, by its reference
    for (const Track& track : tracks)
        if (is_reference(t, track.row)) from.emplace(track.problem, lively_from(track.sound));
    for (const Track& track : tracks) {
        const double start = from.emplace(track.problem, 0.0).first->second;
        const bool reference = is_reference(t, track.row);
        Json row{{"sound", track.file},
                 {"who", reference ? "reference" : "scheme"},
                 {"rate", track.sound.rate},
                 {"scale", track.sound.peak / 32767}};
        Json whole = row;
        row["from"] = start;
        row["values"] = stretch_of(track.sound, start);
        add_outline(whole, track.sound);
        w.beginnings.push_back(std::move(row));
        w.outlines.push_back(std::move(whole));
        w.longest = std::max(w.longest, static_cast<double>(track.sound.samples.size()) / track.sound.rate);
        if (reference) continue;
        w.reference_of[track.file] = track.reference_file;
        w.hues[track.file] = identities_of({t.at(track.row, "series")}).front().colour;
        w.units[track.file] = fmt::format("{} [{}]", t.at(track.row, "tap"), unit_of(t.at(track.row, "quantity")));
        w.sounds.choices.emplace_back(json_text(track.file), track.name + (track.detail.empty() ? "" : ", " + track.detail));
        w.sounds.scenes.push_back(track.problem);
    }
    return w;
}

Filling filling_of(const Waveforms& w, const std::string& title, const std::string& shown) {
    return {title,
            "50 ms, with the difference",
            {},
            {{"@reference", families()[families().size() - 2].light}, {"@ink", ink.light}},
            {{"beginnings", w.beginnings.dump()}, {"outlines", w.outlines.dump()}},
            {{"sound_field", shown}, {"reference_of", w.reference_of.dump()}, {"units", w.units.dump()}, {"hues", w.hues.dump()}}};
}

void add_sounds(Section& s, const std::vector<Track>& tracks) {
    double level = 1;
    for (const Track& t : tracks) level = std::min(level, store::loudest_level(t.sound));
    std::size_t size = 0, left_out = 0;
    bool shortened = false;
    std::vector<std::pair<std::size_t, Heard>> heard;
    for (const Track& t : tracks) {
        std::string wav = store::wav_of(store::levelled(t.sound, level, longest_heard));
        if (size + wav.size() * 4 / 3 > sounds_limit || heard.size() >= most_heard) {
            ++left_out;
            continue;
        }
        size += wav.size() * 4 / 3;
        shortened = shortened || static_cast<double>(t.sound.samples.size()) > longest_heard * t.sound.rate;
        heard.emplace_back(t.row, Heard{t.name, t.detail, std::move(wav), t.problem});
    }
    std::sort(heard.begin(), heard.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [row, sound] : heard) s.sounds.push_back(std::move(sound));
    if (shortened) s.left_out.push_back(fmt::format("Sounds end after {} s here; the files in sounds/ are whole.", longest_heard));
    if (left_out > 0) s.left_out.push_back(fmt::format("{} sounds are left out for the page's size; they lie in sounds/.", left_out));
}
}  // namespace

Section waveform_section(const Results& r) {
    Section s{"sounds", "Traces, to look at and to listen to"};
    const auto tracks = tracks_of(r);
    if (tracks.empty()) return s;
    const std::string &tap = r.sounds.at(0, "tap"), &quantity = r.sounds.at(0, "quantity");
    s.notes = {
        fmt::format("Tap {} ({}), as the scheme gives it: {}not differentiated, no body. Sounds are level-matched: the same root mean "
                    "square, their mean taken away.",
                    tap, quantity, quantity == "nut_force" ? "the force that drives the body, " : "")};
    Waveforms w = waveforms_of(r.sounds, tracks, most_drawn);
    if (!w.sounds.choices.empty()) {
        const std::string first = w.sounds.choices.front().first;
        Chart c{"a scheme's trace over its reference's", chart_of("waveforms.json", filling_of(w, r.name, first), Medium::page)};
        c.menus = {w.sounds, {"show", "until_field", {{"0.05", "50 ms"}, {"0.02", "20 ms"}, {"0.005", "5 ms"}}}};
        if (w.longest > beginning) c.menus[1].choices.emplace_back(store::text_of(w.longest), fmt::format("whole, {:.3g} s", w.longest));
        const auto shown = std::find_if(tracks.begin(), tracks.end(), [&](const Track& t) { return json_text(t.file) == first; });
        std::vector<Track> pair{*shown};
        for (const Track& t : tracks)
            if (t.file == shown->reference_file) pair.push_back(t);
        c.twins.push_back(
            {"waveforms.svg", chart_of("waveforms.json",
                                       filling_of(waveforms_of(r.sounds, pair, 2),
                                                  fmt::format("{} {}: {}", r.name, tap, w.sounds.choices.front().second), first),
                                       Medium::print)});
        s.notes.push_back("Drag the picture to move along, turn the wheel with Shift held to zoom, double-click to go back.");
        s.charts.push_back(std::move(c));
        if (tracks.size() > most_drawn)
            s.left_out.push_back(fmt::format("{} waveforms are left out for the page's size.", tracks.size() - most_drawn));
    }
    add_sounds(s, tracks);
    return s;
}

}  // namespace jvari::bench::report
