// What all charts share: colours, shapes and dashes that stay apart for the colour-blind, and templates (page/*.json) filled in.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/store/records.hpp"

namespace jvari::bench::report {

// Vega-Lite encodings as JSON text: the colour, the shape of points and the dash of lines of each series, in the order of the names.
std::string colour_of_series(const std::vector<std::string>&, const std::string& field = "series");
std::string shape_of_series(const std::vector<std::string>&, const std::string& field = "series");
std::string dash_of_series(const std::vector<std::string>&, const std::string& field = "series");

enum class Medium { page, print };               // fills its container and takes its colours | 760 pixels on white
std::string config_of(Medium, bool has_legend);  // JSON

// A template is Vega-Lite in which "@colour", "@shape" and "@dash" stand for the encodings of the series, and any other "@word" for a text.
struct Filling {
    std::string title, subtitle;
    std::vector<std::string> series;
    std::vector<std::pair<std::string, std::string>> words;     // "@x_title", its text
    std::vector<std::pair<std::string, std::string>> datasets;  // name, JSON rows
    std::vector<std::pair<std::string, std::string>> values;    // of parameters, as JSON
};
std::string chart_of(const char* template_file, const Filling&, Medium);

// Rows as JSON objects: the named columns, as numbers where they are some (not finite: null).
std::string rows_of(const store::Table&, const std::vector<std::string>& texts, const std::vector<std::string>& numbers);
std::string json_text(const std::string&);  // a string as JSON

}  // namespace jvari::bench::report
