// What a suite file says of its figures, as its [[figure]] tables; figure_file.cpp declares their keys. They draw the rows that facets make
// of cells (figure_facets.hpp), or cells.csv.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/store/keys.hpp"

namespace jvari::bench::suite {

struct FigureAxis {
    std::string column, to, title;
    double factor = 1;
    bool log = false;
    std::optional<std::array<double, 2>> domain;
};
enum class FigureKind { lines, points, band, spectrogram };
struct Figure {
    std::string name, paper, title, statement, table;
    FigureKind kind = FigureKind::lines;
    FigureAxis x, y;
    std::vector<std::string> colour, panels;
    std::vector<std::pair<std::string, std::vector<std::string>>> where;
    std::vector<std::pair<std::string, std::string>> labels;
    int across = 1, width = 640, height = 240;
    bool free = false;
    std::string beside;  // the figure at its right in one picture; "": none
};

// [[figure]] tables of a suite.
store::Kind<std::vector<Figure>> figures();

}  // namespace jvari::bench::suite
