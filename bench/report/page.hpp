// The report's page: one file, no network. Its JavaScript (page/*.js) makes what is seen of the data that the page carries; the same
// JavaScript under node makes the SVG files (vega.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace jvari::bench::report {

// `scripts`: the chart libraries as <script> elements; "": no chart. `data`: what page/data.js describes, with its title.
std::string page_of(const nlohmann::ordered_json& data, const std::string& scripts);
std::string shared_program();  // what node runs as well: data.js ... verdict.js

}  // namespace jvari::bench::report
