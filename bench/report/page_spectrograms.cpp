// Spectrograms of a suite's cells that asked for them (cells/*.json, "levels"), on one scale; and the pictures that others laid into the
// folder.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/report/page_sections.hpp"
#include "bench/report/spectrogram_chart.hpp"
#include "bench/store/fresh_file.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct Kept {
    bool asked = false;
    suite::Levels levels;
};

Kept levels_in(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};
    try {
        const Json j = Json::parse(store::read_whole(file));
        const Json &l = j.at("levels"), &measure = j.at("cell").at("measure");
        const bool asked = std::find(measure.begin(), measure.end(), "spectrogram") != measure.end();
        Kept k{asked, {l.at("frames"), l.at("rows"), l.at("start"), l.at("hop"), l.at("row_hz"), l.at("tenths_of_db")}};
        if (k.levels.level.size() != static_cast<std::size_t>(k.levels.frames) * k.levels.rows) return {};
        return k;
    } catch (const Json::exception&) {
        return {};
    }
}
}  // namespace

Section spectrogram_section(const Results& r) {
    Section s{"spectrograms", "Spectrograms"};
    const store::Table& t = r.cells;
    std::vector<Panel> panels;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (t.at(i, "cell").empty()) continue;
        Kept k = levels_in(r.folder / "cells" / (t.at(i, "cell") + ".json"));
        if (!k.asked) continue;
        rows.push_back(i);
        panels.push_back({t.at(i, "problem"), t.at(i, "series"), t.at(i, "status"), std::move(k.levels)});
    }
    if (panels.empty()) return s;
    if (distinct(t, "rate").size() > 1)
        for (std::size_t k = 0; k < panels.size(); ++k) panels[k].down += fmt::format(" at {} Hz", t.at(rows[k], "rate"));
    const std::string spec = spectrogram_spec(r.name, "spectrograms; " + r.source, panels);
    Json on_page = Json::parse(spec);
    for (const char* key : {"background", "title"}) on_page.erase(key);
    s.charts.push_back({"spectrograms side by side", on_page.dump(), true, {}, {{"spectrograms.svg", spec}}});
    s.notes = {"Columns are scenes, rows schemes; decibels below the maximum of all panels."};
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
