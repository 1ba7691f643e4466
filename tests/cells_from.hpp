// Cells of a table that is made up, for what reads cells: a row per cell, columns by the names of
// study/cells.hpp. A measure's own column is of the headline's tap, and one with _TAP behind it of
// another; floor_, certificate_l2_ and error_in_model_l2_ stand for what errors.csv has beside it.
#pragma once

#include "bench/study/cells.hpp"

namespace jvari::test {

inline bench::study::Cells cells_from(const bench::store::Table& t) {
    namespace study = bench::study;
    study::Cells cells(t.rows.size());
    const auto set = [&](const std::string& column, const std::string& begins, std::size_t measure,
                         double study::Figure::*part) {
        if (column != begins && !column.starts_with(begins + "_")) return;
        const std::string tap = column == begins ? "headline" : column.substr(begins.size() + 1);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            std::vector<std::string>& taps = cells[i].taps;
            auto& figures = cells[i].figures;
            const auto k = static_cast<std::size_t>(std::ranges::find(taps, tap) - taps.begin());
            if (k == taps.size())
                taps.push_back(tap), figures.emplace_back(study::measures().size());
            figures[k][measure].*part = t.number(i, column);
        }
    };
    for (const std::string& column : t.columns)
        for (std::size_t m = 0; m < study::measures().size(); ++m) {
            const std::string name = study::measures()[m].column;
            set(column, name, m, &study::Figure::value);
            set(column, "floor_" + name, m, &study::Figure::floor);
            if (!study::is_waveform(m)) continue;
            set(column, "certificate" + name.substr(5), m, &study::Figure::certificate);
            set(column, "error_in_model" + name.substr(5), m, &study::Figure::in_model);
        }
    for (std::size_t i = 0; i < cells.size(); ++i) {
        study::TabledCell& c = cells[i];
        c.cell = t.text(i, "cell");
        c.headline_nut = c.headline_bridge = "headline";
        for (const study::Column& column : study::columns())
            if (t.column(column.name) >= 0) column.read(c, t.at(i, column.name));
    }
    return cells;
}

}  // namespace jvari::test
