#include "bench/compare/cheapest.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/store/cell_rows.hpp"

namespace jvari {

namespace {
struct Target {
    bool waveform;
    double most;
};
constexpr Target targets[] = {{true, 0.1}, {true, 0.01}, {true, 0.001}, {false, 3}, {false, 1}};
}  // namespace

Table cheapest_of(const Table& cells, const std::string& waveform, const std::string& scene) {
    const std::vector<std::string> swept = swept_keys(cells);
    Table t;
    t.columns = {"scene"};
    t.columns.insert(t.columns.end(), swept.begin(), swept.end());
    for (const char* name : {"measure", "target", "scheme", "options", "rate", "modes", "error", "cost_s_per_s", "ties"})
        t.columns.push_back(name);
    std::vector<std::string> naming = swept;
    naming.insert(naming.begin(), "scene");
    for (const Rows& group : alike(cells, all_rows(cells), naming)) {
        Rows rows;
        for (const std::size_t i : group)
            if (cells.at(i, "status") == "ok" && cells.at(i, "flags").empty() && cells.number(i, "cost_s_per_s") > 0) rows.push_back(i);
        if (rows.empty()) continue;  // nothing was timed
        std::vector<std::string> key{cells.column("scene") < 0 ? scene : cells.at(rows.front(), "scene")};
        for (const std::string& name : swept) key.push_back(cells.at(rows.front(), name));
        const auto known = [&](const std::string& measure) {
            return std::any_of(rows.begin(), rows.end(), [&](std::size_t i) { return std::isfinite(cells.number(i, measure)); });
        };
        std::string window = waveform;
        for (const char* shorter : {"error_l2_10ms", "error_l2_whole"})
            if (!known(window)) window = shorter;
        for (const Target& target : targets) {
            const std::string measure = target.waveform ? window : "third_octave_db";
            if (!known(measure)) continue;  // the run is too short for it
            const auto meets = [&](std::size_t i) { return cells.number(i, measure) <= target.most; };
            std::size_t best = cells.rows.size();
            for (const std::size_t i : rows)
                if (meets(i) && (best == cells.rows.size() || cells.number(i, "cost_s_per_s") < cells.number(best, "cost_s_per_s")))
                    best = i;
            auto& row = t.rows.emplace_back(key);
            row.push_back(measure);
            row.push_back(text_of(target.most));
            if (best == cells.rows.size()) {
                row.resize(t.columns.size());
                continue;
            }
            std::string ties;
            for (const std::size_t i : rows)
                if (meets(i) && cells.at(i, "scheme") != cells.at(best, "scheme") &&
                    cells.number(i, "cost_lower") <= cells.number(best, "cost_upper") &&
                    (" " + ties + " ").find(" " + cells.at(i, "scheme") + " ") == std::string::npos)
                    ties += (ties.empty() ? "" : " ") + cells.at(i, "scheme");
            for (const std::string& field : {cells.at(best, "scheme"), cells.at(best, "options"), cells.at(best, "rate"),
                                             cells.at(best, "modes"), cells.at(best, measure), cells.at(best, "cost_s_per_s"), ties})
                row.push_back(field);
        }
    }
    return t;
}

std::string goal_name(const Table& t, std::size_t row) {
    const double most = t.number(row, "target");
    return t.at(row, "measure") == "third_octave_db" ? fmt::format("{:g} dB", most) : fmt::format("{:g} %", 100 * most);
}

std::string cheapest_text(const Table& t) {
    std::string text, last;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string scene = t.rows[i][0];
        for (int k = 1; k < t.column("measure"); ++k)
            if (!t.rows[i][k].empty()) scene += " " + t.columns[k] + "=" + t.rows[i][k];
        if (scene != last) text += fmt::format("{}the cheapest scheme on {}\n", text.empty() ? "" : "\n", scene);
        last = scene;
        text += fmt::format("  {:<16} within {:<6}  ", t.at(i, "measure"), goal_name(t, i));
        if (t.at(i, "scheme").empty()) text += "none\n";
        else
            text += fmt::format("{}{} at {} Hz, {:.3g} s per s{}\n", t.at(i, "scheme"),
                                t.at(i, "options").empty() ? "" : " " + t.at(i, "options"), t.at(i, "rate"), t.number(i, "cost_s_per_s"),
                                t.at(i, "ties").empty() ? "" : "; a tie with " + t.at(i, "ties"));
    }
    if (!text.empty()) text.pop_back();
    return text;
}

}  // namespace jvari
