// How messages name what was found: quoted texts, shortest numbers, the nearest known word.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace jvari {

std::string number_text(double);                             // the shortest decimal that reads back as the same double
std::optional<double> number_of(std::string_view);           // of a text that is one number and nothing else, as std::from_chars reads it
std::string quote(std::string_view);                         // a TOML basic string: quotes, backslashes and control characters escaped
std::string found_text(std::string_view);                    // quoted, and cut where it is longer than a line of a message should be
std::string list_of(const std::vector<std::string>& words);  // "a", "b", "c"

// The known word at the smallest edit distance, empty where half of the letters would have to change.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace jvari
