// How messages quote texts and numbers, and find the nearest known word.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace jvari {

std::string number_text(double);                             // the shortest decimal that reads back as the same double
std::optional<double> number_of(std::string_view);           // of a text that is one number and nothing else, as std::from_chars reads it
std::string quote(std::string_view);                         // a TOML basic string: quotes, backslashes and control characters escaped
std::string found_text(std::string_view);                    // quoted, and cut to the length of a line
std::string list_of(const std::vector<std::string>& words);  // "a", "b", "c"

// The known word at the smallest edit distance; empty if half of the letters would have to change.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace jvari
