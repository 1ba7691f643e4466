// How messages quote texts and numbers, and find the nearest known word.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace jvari {

std::string number_text(double);  // the shortest decimal that reads back to the same double

// Parses a text that is one decimal number and nothing else: 10, 010, +1e3, -.5, inf, nan. It
// refuses 0x10, 1_000, 1e400, 1,5 and "1 ". A number too small for a double is 0. All readers of
// options, scene overrides or CSV files use this function.
std::optional<double> number_of(std::string_view);
// prefix that spreadsheets write in a CSV file
inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
// a TOML basic string: quotes, backslashes and control characters escaped
std::string quote(std::string_view);
bool is_text(std::string_view);  // UTF-8 without control characters
// "" if a name can be part of a file name; otherwise the reason.
std::string unfit_as_file(std::string_view name);
// quoted, and cut to the length of a line
std::string found_text(std::string_view);
std::string list_of(const std::vector<std::string>& words);  // "a", "b", "c"

// Known word at the smallest edit distance; empty if half of the letters would have to change.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace jvari
