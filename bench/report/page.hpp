// The report's page: one file, no network. Its JavaScript (page/*.js) makes what is seen of the
// data that the page carries; the same JavaScript under node makes the SVG files (vega.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace jvari::bench::report {

// `scripts`: the chart libraries as <script> elements; "": no chart. `data`: what page/data.js
// describes, with its title.
std::string page_of(const nlohmann::ordered_json& data, const std::string& scripts);
std::string shared_program();  // what node runs as well: data.js ... verdict.js

// ---- The files of page/, which the build puts into the program: the page's frame, style and
// scripts, and its charts as Vega-Lite.

struct PageText {
    const char *name, *text;  // "page.html", what it holds
};
std::span<const PageText> page_texts();

const char* page_text(const char* name);  // throws std::logic_error where there is no such file

// ---- `report --playground`: the page that ./play builds, folded into a report.

std::string playground();  // the built page; throws UsageError where there is none
std::string with_playground(const std::string& report, const std::string& play);

}  // namespace jvari::bench::report
