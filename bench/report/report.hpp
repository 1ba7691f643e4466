// From what lies in a folder of compare, suite or trim: report.html beside it, and each of its
// charts as a picture.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/report/vega.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"

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
// The page in less than `limit` bytes: sounds are left out from the last on, and the page says so.
std::string fitting_page_of(nlohmann::ordered_json data, const std::string& scripts,
                            std::size_t limit);

// The data of a page with nothing in it: a title, what it is about, the schemes and references that
// there are (name, is it a control; in the order of their registry), and empty tables, sounds and
// levels.
nlohmann::ordered_json empty_data(const std::string& title, const std::string& about);

}  // namespace jvari::bench::report
