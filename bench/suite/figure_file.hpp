// What a suite file says of its figures: [[figure]] tables, and the facets that a set of cells brings for them (figure_facets.hpp).
//
//   [[figure]]
//   name = "06-left"                       figure-06-left.svg
//   paper = "fig. 6, left"                 title = "..."     statement = "what the paper says of it"        (absent: "")
//   kind = "lines"                         points (lines with marks), band (from y to y.to), spectrogram
//   table = "profile"                      cells or a row facet's file; a spectrogram has none
//   x = { column = "position_m", title = "position [mm]", factor = 1e3, log = true, domain = [0, 25] }      or "position_m"
//   y = { column = "low", to = "high", title = "force [N]" }
//   colour = ["scheme", "rate"]            columns whose texts, joined, name the lines                      (absent: one line)
//   panels = ["tap"]                       the same for panels; of a spectrogram colour goes across and panels down
//   across = 2                             panels in a row                                                  (absent: 1)
//   free = true                            each panel has a scale of its own
//   where = { tap = ["nut"], rate = 44100 }        rows with one of the values
//   labels = { "44100" = "44.1 kHz" }              what stands for a name
//   width = 640     height = 240                   of a panel [px]
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/suite/figure_facets.hpp"

namespace jvari {
struct Value;
}
namespace jvari::bench::store {
class SuiteReader;
}

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
};

// Both throw SceneFileError "suite.toml:12: figure.0.knid: ...".
std::vector<Figure> figures_of(const store::SuiteReader&, const Value& root);
FigureFacets figure_facets_of(const store::SuiteReader&, const Value& set, const std::string& within);

}  // namespace jvari::bench::suite
