// Makes report.html, results.json and a picture for each chart from a folder of compare, suite or
// trim.
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

// Returns the names of the files written. Without node or its packages the page has only tables and
// sounds, there are no pictures, and a note lists the missing programs. `width` of the pictures
// [mm]; 0: a plot of 760 pixels. Throws UsageError if the folder has no results or they cannot be
// read.
std::vector<std::string> write_report(const std::filesystem::path& folder, const store::Listener&,
                                      double width = 0);

// Shortens a large table by the largest columns, but keeps the columns needed for charts.
store::Table fitting(store::Table, nlohmann::ordered_json& left_out);
// Makes the page with less than `limit` bytes by leaving out sounds, the last first, if that
// suffices; the page says so.
std::string fitting_page_of(nlohmann::ordered_json data, const std::string& scripts,
                            std::size_t limit);
// Selects `cells` cells: answers to a question and cells on a front, the best for each scheme, then
// the others in order.
Results best_of(const Results&, std::size_t cells);
// Makes the page for the results' data with less than `limit` bytes: besides sounds, cells are
// left out, and finally whole tables, the largest first.
std::string fitting_page_of(const Results&, nlohmann::ordered_json data, const std::string& scripts,
                            std::size_t limit);
// Data for a page: the values of the results as far as they fit, sounds and spectrograms.
nlohmann::ordered_json data_of(const Results&, std::map<std::string, store::Table> tables);
// Contents of results.json: what a folder of results says, for programs. Manifest, tables, answers
// from each tolerance at which they change, and warnings, with types and nothing left out.
nlohmann::ordered_json values_of(const Results&, const std::map<std::string, store::Table>&);

// Data for an empty page: a title, a description, all schemes and references (name, whether a
// control; in the order of their registry), and empty tables, sounds and levels.
nlohmann::ordered_json empty_data(const std::string& title, const std::string& about);

// Units of a scene's numbers: {"string.barrier.stiffness": "N/m^exponent"}, and of a rate.
nlohmann::ordered_json units();
// Quantities of the taps in a manifest's scenes: {scene: {tap: "nut_force"}}.
nlohmann::ordered_json quantities_in(const nlohmann::ordered_json& manifest);

// ---- The report's page: one file, no network. JavaScript in page/*.js draws the data in the page;
// node makes the SVG files with the same JavaScript (vega.hpp).

// `scripts`: the chart libraries in <script> elements; "": no charts. `data`: described in
// page/data.js, with a title.
std::string page_of(const nlohmann::ordered_json& data, const std::string& scripts);
std::string shared_program();  // shared with node: data.js ... verdict.js

// ---- Files in page/, which the build compiles into the program: the page's frame, style and
// scripts, and the charts in Vega-Lite.

struct PageText {
    const char *name, *text;  // "page.html", its contents
};
std::span<const PageText> page_texts();

const char* page_text(const char* name);  // throws std::logic_error for an unknown file

// ---- `report --playground`: the page built by ./play, folded into a report.

std::string playground();  // the built page; throws UsageError if it is missing
std::string with_playground(const std::string& report, const std::string& play);

// ---- One run in a picture with sound. The picture shows the taps over time, spectrum and
// spectrogram for the first tap, the energy ledger if probed, and the contact intervals. The
// numbers are computed here; page/run.js draws them.

struct DrawnRun {
    std::string title, subtitle, scheme;  // scheme: selects the colour
    const Scene& scene;
    const Trace& trace;
};
// Data for a page. Missing parts are left out: no ledger without energy, no contact without a
// barrier's force among the taps.
nlohmann::ordered_json run_data(const DrawnRun&);

}  // namespace jvari::bench::report
