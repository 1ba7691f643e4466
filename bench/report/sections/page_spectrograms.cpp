// Spectrograms of a suite's cells that asked for them (cells/*.json, "levels"), on one scale; and the pictures that others laid into the
// folder.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/report/sections/page_sections.hpp"
#include "bench/report/spectrogram_chart.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/sound.hpp"
#include "bench/study/record.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

// Of each problem whose reference was heard: the truth that the panels beside it are to be seen against.
std::map<std::string, study::Levels> references_in(const Results& r) {
    std::map<std::string, study::Levels> references;
    const store::Table& t = r.sounds;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::filesystem::path file = t.at(i, "file");
        if (t.at(i, "scheme") != "reference" || file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end()) continue;
        const store::Sound sound = store::read_wav(r.folder / file, t.number(i, "peak"));
        std::vector<double> signal;
        for (const int x : sound.samples) signal.push_back(x * sound.peak / 32767);
        references[t.at(i, "problem")] = study::levels_of(signal, sound.rate);
    }
    return references;
}

bool on_one_grid(const study::Levels& a, const study::Levels& b) {
    const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-6 * std::abs(x) + 1e-9; };
    return a.frames > 0 && b.frames > 0 && near(a.start, b.start) && near(a.hop, b.hop) && near(a.row_hz, b.row_hz);
}

constexpr std::size_t across = 4;

// Four panels across, each with its name above it in lines that fit, axes at the left and below.
Json wrapped(const std::string& spec) {
    Json chart = Json::parse(spec);
    for (const char* key : {"background", "title"}) chart.erase(key);
    chart["columns"] = across;
    Json& panels = chart["concat"];
    for (std::size_t k = 0; k < panels.size(); ++k) {
        std::string name = panels[k]["title"]["text"];
        Json lines = Json::array();
        for (auto at = name.find(" | "); at != std::string::npos; at = name.find(" | ")) {
            lines.push_back(name.substr(0, at));
            name.erase(0, at + 3);
        }
        lines.push_back(name);
        panels[k]["title"] = {{"text", lines}, {"fontSize", 10}, {"anchor", "start"}};
        if (!panels[k].contains("encoding")) continue;
        const auto axis = [&panels, k](const char* which, bool shown, const char* title) {
            panels[k]["encoding"][which]["axis"].update({{"labels", shown}, {"title", shown ? Json(title) : Json()}});
        };
        axis("x", k + across >= panels.size(), "time [s]");
        axis("y", k % across == 0, "frequency [kHz]");
    }
    return chart;
}
}  // namespace

Section spectrogram_section(const Results& r) {
    Section s{"spectrograms", "Spectrograms"};
    const store::Table& t = r.cells;
    const auto references = references_in(r);
    const bool several_rates = distinct(t, "rate").size() > 1;
    std::vector<Panel> panels, on_page;
    std::set<std::string> problems;
    bool without = false, differences = false;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (t.at(i, "cell").empty()) continue;
        std::optional<study::Levels> kept = study::read_levels(r.folder / "cells" / (t.at(i, "cell") + ".json"), "spectrogram");
        if (!kept) continue;
        const std::string &problem = t.at(i, "problem"),
                          rate = several_rates ? fmt::format(" at {:g} kHz", t.number(i, "rate") / 1000) : "";
        if (problems.insert(problem).second) {
            if (const auto truth = references.find(problem); truth != references.end())
                on_page.push_back({problem + " | reference", "", "", truth->second});
            else without = true;
        }
        Panel& shown = on_page.emplace_back(
            Panel{problem + " | " + t.at(i, "series") + (rate.empty() ? "" : " |" + rate), "", t.at(i, "status"), *kept});
        if (const auto truth = references.find(problem); truth != references.end() && on_one_grid(*kept, truth->second)) {
            shown.against = truth->second;
            differences = true;
        }
        panels.push_back({problem, t.at(i, "series") + rate, t.at(i, "status"), std::move(*kept)});
    }
    if (panels.empty()) return s;
    std::vector<Menu> menus;
    if (differences)
        menus.push_back({"show", "shown_field", {{"\"level\"", "levels"}, {"\"difference\"", "difference from the reference"}}});
    s.charts.push_back({"spectrograms side by side, the reference first",
                        wrapped(spectrogram_spec(r.name, "", on_page)).dump(),
                        true,
                        std::move(menus),
                        {{"spectrograms.svg", spectrogram_spec(r.name, "spectrograms; " + r.source, panels)}}});
    s.notes = {"Decibels below the maximum of all panels; the reference comes first."};
    if (differences)
        s.notes[0] += " A difference is that of the levels, where either lies above the background: orange is louder than the reference.";
    if (without) s.notes.emplace_back("Where a scene has no reference here, the suite kept no sound of it.");
    return s;
}

Section picture_section(const Results& r, const std::vector<std::string>& own) {
    Section s{"figures", "Figures"};
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(r.folder, error))
        if (entry.path().extension() == ".svg" && std::find(own.begin(), own.end(), entry.path().filename()) == own.end())
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::size_t size = 0;
    std::string left_out;
    for (const fs::path& file : files) {
        std::string svg = store::read_whole(file);
        if (size + svg.size() > pictures_limit) {
            left_out += " " + file.filename().string();
            continue;
        }
        size += svg.size();
        s.pictures.push_back({file.stem().string(), std::move(svg)});
    }
    if (!left_out.empty()) s.left_out.push_back("Left out for the page's size, they lie beside it:" + left_out + ".");
    return s;
}

}  // namespace jvari::bench::report
