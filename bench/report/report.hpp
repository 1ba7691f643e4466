// From what lies in a folder of compare, suite or trim: report.html beside it, and each of its
// charts as a picture.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "bench/report/results.hpp"
#include "bench/report/vega.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::report {

// Returns the names of the files written. Without node or its packages the page comes with tables
// and sounds alone, the pictures not at all, and a note says what is missing. `width` of the
// pictures [mm]; 0: a plot of 760 pixels. Throws UsageError where the folder does not hold results
// or they cannot be read.
std::vector<std::string> write_report(const std::filesystem::path& folder, const store::Listener&,
                                      double width = 0);

// A table that is too large goes without the columns that take most room, those that charts need
// excepted.
store::Table fitting(store::Table, nlohmann::ordered_json& left_out);
// The page in less than `limit` bytes, as far as leaving out sounds from the last on does that; the
// page says so.
std::string fitting_page_of(nlohmann::ordered_json data, const std::string& scripts,
                            std::size_t limit);
// So many cells of a folder's: those that answer a question or are on a front, the best of each
// scheme, then the others as they stand.
Results best_of(const Results&, std::size_t cells);
// The page of `data_of(results)` in less than `limit` bytes: beyond sounds, cells are left out, and
// at last whole tables, the largest first.
std::string fitting_page_of(const Results&, nlohmann::ordered_json data, const std::string& scripts,
                            std::size_t limit);
nlohmann::ordered_json data_of(const Results&);

// The data of a page with nothing in it: a title, what it is about, the schemes and references that
// there are (name, is it a control; in the order of their registry), and empty tables, sounds and
// levels.
nlohmann::ordered_json empty_data(const std::string& title, const std::string& about);

// ---- The report's page: one file, no network. Its JavaScript (page/*.js) makes what is seen of
// the data that the page carries; the same JavaScript under node makes the SVG files (vega.hpp).

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

// ---- One run, one picture: its taps over time, spectrum and spectrogram of the first of them, the
// energy ledger where it was probed, when the string touched; and its sound. Here are the numbers;
// page/run.js draws them.

struct DrawnRun {
    std::string title, subtitle, scheme;  // in whose hue it is drawn
    const Scene& scene;
    const Trace& trace;
};
// The data of a page. What the run lacks is left out:
// no ledger without energy, no contact without a barrier's force among the taps.
nlohmann::ordered_json run_data(const DrawnRun&);

}  // namespace jvari::bench::report
