// The report's page: one file, no network. What was found as its title, the first chart with the answers beside it, the player; then
// sections that are opened by a click: charts with menus, pictures, tables; what it was measured with at the foot.
//
// A section is made by one page_*.cpp of the files that lie in a folder; the page is put together here and shown by bench/report/page/*.js.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/store/records.hpp"

namespace jvari::bench::report {

struct Menu {  // a <select>: sets a signal of the chart
    std::string label, signal;
    std::vector<std::pair<std::string, std::string>> choices;  // value as JSON, what stands in the menu; the first is shown
    std::vector<std::string> scenes{};                         // of each choice, where a choice is of one
};

struct Twin {  // a picture for papers, beside the page
    std::string file, spec;
};

struct Chart {
    std::string name;      // what it shows, in a few words: for those who cannot see it
    std::string spec;      // Vega-Lite that fills its container
    bool scrolls = false;  // has a width of its own
    std::vector<Menu> menus{};
    std::vector<Twin> twins{};
    std::vector<std::pair<std::string, std::vector<std::string>>> offers{};  // of each scene the errors that it has, its default first
};

struct Picture {  // an SVG that others made
    std::string name, svg;
};

struct Heard {
    std::string scheme, detail;  // "modal_two_point", "44.1 kHz"
    std::string wav;             // of the file
    std::string problem{};       // whose string it is
};

struct Shown {  // what stands in a field of a table in place of its number
    std::size_t row;
    std::string column, text;
};

struct Section {
    std::string id, heading;
    std::vector<std::string> notes{};  // sentences above the charts
    std::vector<Chart> charts{};
    std::vector<Picture> pictures{};
    std::vector<Heard> sounds{};
    std::vector<std::string> left_out{};  // sentences: what is not there for the page's size
    store::Table table{};
    std::vector<std::string> first_columns{};  // shown before "every column" is asked for; empty: all
    std::vector<Shown> shown{};
};

struct Answer {          // who is the cheapest within one tolerance
    std::string within;  // "waveform within 10 %, first 50 ms"
    std::string scheme;  // "none" and "cannot be decided" too
    std::string modes, rate, error, cost, certain;
    std::string colour{};  // of the scheme in the charts; "": there is none
};

struct Verdict {  // on one scene
    std::string scene;
    std::string finding;  // in a sentence without its full stop: the page's title while the scene is shown
    std::vector<Answer> answers;
    std::vector<std::string> sentences;
};

struct Page {
    std::string title, about, command;  // command: that made it, "" where it is not known
    std::string finding;                // where there is no verdict
    std::vector<Verdict> verdicts;      // the first is shown first
    std::string scripts;                // the chart libraries as <script> elements; "": no chart
    std::string missing;                // why there is no chart
    std::vector<Section> sections;
    std::string manifest;  // JSON
};
std::string page_of(const Page&);
// The page in less than 5 MB: pictures, then sounds are left out from the last on, and the page says so.
std::string fitting_page_of(Page, std::size_t limit = 4'900'000);

// What parts of a page may weigh [bytes].
constexpr std::size_t sounds_limit = 2'000'000;    // as the WAV data stands in the page
constexpr std::size_t pictures_limit = 1'500'000;  // as files
constexpr std::size_t table_limit = 600'000;       // one table; beyond, its first columns alone, then fewer rows

}  // namespace jvari::bench::report
