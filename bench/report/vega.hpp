// The npm packages that draw: vega, vega-lite, vega-embed, installed by `npm ci` at the root of the sources.
#pragma once

#include <optional>
#include <string>
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

// Vega-Lite specifications as SVG, all by one process; nothing for one that cannot be drawn, or where node is missing. `why` says what was
// the first.
std::vector<std::optional<std::string>> svgs_of(const Vega&, const std::vector<std::string>& specs, std::string& why);
std::optional<std::string> svg_of(const Vega&, const std::string& spec, std::string& why);

// Text that stands inside <script> without ending it: within a string or a regular expression "<\/script" says the same as "</script".
std::string inside_script(std::string);

}  // namespace jvari::bench::report
