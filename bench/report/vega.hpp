// npm packages for drawing: vega, vega-lite, vega-embed, installed by `npm ci` at the root of the
// sources.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace jvari::bench::report {

struct Vega {
    std::string folder;   // node_modules
    std::string missing;  // "", or the missing package and how to install the package
};
// Looks in $JVARI_NODE_MODULES, else in node_modules of the sources.
Vega find_vega();

// The three minified libraries, escaped for <script>; nothing if a library is missing.
std::optional<std::string> vega_scripts(const Vega&);

// Draws the charts in `data` (report.hpp) into SVG files, in one node process with the page's own
// JavaScript.
struct Drawn {
    std::vector<std::pair<std::string, std::string>> svgs;  // file name, content
    std::vector<std::string> notes;  // charts that could not be drawn, with the reason
};
Drawn draw(const Vega&, const nlohmann::ordered_json& data);

constexpr double pixels_per_mm = 96 / 25.4;  // in SVG
double width_of(const std::string& text);    // "85mm", "3.3in" [mm]; throws UsageError

// Escapes text for <script>, so the text cannot end the element: within a string or a regular
// expression "<\/script" means the same as "</script".
std::string inside_script(std::string);

}  // namespace jvari::bench::report
