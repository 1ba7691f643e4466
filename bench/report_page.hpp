// The page: one file, no network. Chart, menus, a table that sorts, what it was measured with.
#pragma once

#include <string>

namespace jvari {

struct Page {
    std::string title;
    std::string scripts;   // the chart libraries as <script> elements; "": no chart
    std::string spec;      // Vega-Lite
    std::string table;     // JSON {columns, rows}
    std::string manifest;  // JSON
    std::string choices;   // JSON {errors: [[column, title], ...], costs: ...}
    std::string missing;   // why there is no chart
};
std::string page_of(const Page&);

}  // namespace jvari
