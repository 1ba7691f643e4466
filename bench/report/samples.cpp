#include "bench/report/results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/base64.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

namespace {
// How much a reader wants of a row of sounds: 0 a reference, 1 the cheapest within an accuracy, 2 a
// scheme at its highest rate, 3 at its lowest, 4 else.
int place_of(const store::Table& t, std::size_t i, const store::Table& cheapest) {
    if (t.at(i, "scheme") == "reference") return 0;
    for (std::size_t k = 0; k < cheapest.rows.size(); ++k)
        if (std::ranges::all_of(
                std::initializer_list<const char*>{"problem", "scheme", "options", "rate"},
                [&](const char* name) { return cheapest.at(k, name) == t.at(i, name); }))
            return 1;
    double lowest = HUGE_VAL, highest = 0;
    for (std::size_t k = 0; k < t.rows.size(); ++k)
        if (t.at(k, "problem") == t.at(i, "problem") && t.at(k, "series") == t.at(i, "series")) {
            lowest = std::fmin(lowest, t.number(k, "rate"));
            highest = std::fmax(highest, t.number(k, "rate"));
        }
    const double rate = t.number(i, "rate");
    return !(rate < highest) ? 2 : rate <= lowest ? 3 : 4;
}
}  // namespace

Json json_of(const study::Levels& l) {
    return {{"start", l.start},
            {"hop", l.hop},
            {"row_hz", l.row_hz},
            {"frames", l.frames},
            {"rows", l.rows},
            {"level", store::base64(std::vector<std::int16_t>(l.level.begin(), l.level.end()))}};
}

Json json_of(const store::Sound& s, double longest) {
    return {{"rate", s.rate},
            {"peak", s.peak},
            {"samples", store::base64(std::span(s.samples).first(std::min(
                            s.samples.size(), static_cast<std::size_t>(longest * s.rate))))}};
}

fs::path sound_file(const Results& r, std::size_t row) {
    const fs::path file = r.sounds.at(row, "file");
    if (file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end())
        throw store::UsageError(fmt::format("{}: found the file {}, expected one below the folder",
                                            (r.folder / "sounds.csv").string(), file.string()));
    return r.folder / file;
}

Json heard(const Results& r, const store::Table& cheapest, double longest, std::size_t limit,
           Json& left_out) {
    std::vector<std::pair<int, std::size_t>> order;
    for (std::size_t i = 0; i < r.sounds.rows.size(); ++i)
        order.emplace_back(place_of(r.sounds, i, cheapest), i);
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json all = Json::array();
    std::size_t size = 0, too_many = 0;
    bool shortened = false;
    for (const auto& [place, row] : order) {
        const store::Sound sound =
            store::read_wav(sound_file(r, row), r.sounds.number(row, "peak"));
        Json one = json_of(sound, longest);
        const std::size_t more = one.at("samples").get_ref<const std::string&>().size();
        if (size + more > limit) {
            ++too_many;
            continue;
        }
        size += more;
        shortened = shortened || static_cast<double>(sound.samples.size()) > longest * sound.rate;
        one["row"] = row;
        all.push_back(std::move(one));
    }
    std::sort(all.begin(), all.end(),
              [](const Json& a, const Json& b) { return a.at("row") < b.at("row"); });
    if (shortened)
        left_out.push_back(
            fmt::format("Sounds end after {} s here; the files in sounds/ are whole.", longest));
    if (too_many > 0)
        left_out.push_back(fmt::format(
            "{} sounds are left out for the page's size; they lie in sounds/.", too_many));
    return all;
}

}  // namespace jvari::bench::report
