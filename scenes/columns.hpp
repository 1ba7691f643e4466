// CSV tables that a scene names: measured modes, profiles of a bridge.
#pragma once

#include <string>
#include <vector>

namespace jvari {

struct Column;

// At most `limit` bytes of a file; throws std::runtime_error that says why not ("cannot be read", "is larger than ...").
std::string text_of_file(const std::string& path, std::size_t limit);

// Two columns found by their names (or aliases) in the header; lines that begin with # and other columns are skipped.
// Throws SceneFileError with the line of the CSV file.
void read_columns(const std::string& path, const std::string& text, const Column& first, std::vector<double>& a, const Column& second,
                  std::vector<double>& b);

}  // namespace jvari
