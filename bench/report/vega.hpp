// The npm packages that draw: vega, vega-lite, vega-embed, installed by `npm ci` at the root of the
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
    std::string missing;  // "" or what is missing and how to get it
};
// $JVARI_NODE_MODULES, else node_modules of the sources.
Vega find_vega();

// The three minified libraries, fit to stand inside <script>; nothing where one is missing.
std::optional<std::string> vega_scripts(const Vega&);

// The charts of `data` (report.hpp) as SVG files, drawn by one node with the page's own JavaScript.
struct Drawn {
    std::vector<std::pair<std::string, std::string>> svgs;  // name of the file, content
    std::vector<std::string> notes;                         // what could not be drawn, and why
};
Drawn draw(const Vega&, const nlohmann::ordered_json& data);

constexpr double pixels_per_mm = 96 / 25.4;  // of SVG
double width_of(const std::string& text);    // "85mm", "3.3in" [mm]; throws UsageError

// Text that stands inside <script> without ending it: within a string or a regular expression
// "<\/script" says the same as "</script".
std::string inside_script(std::string);

}  // namespace jvari::bench::report
