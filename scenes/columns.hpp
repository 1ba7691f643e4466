// Reads the CSV tables of a scene: measured modes and profiles of a bridge.
#pragma once

#include <string>
#include <vector>

namespace jvari {

struct Column;

// The text of a file of at most `limit` bytes. Throws std::runtime_error ("cannot be read", "is
// larger than ...").
std::string text_of_file(const std::string& path, std::size_t limit);

// Reads two columns, found by their names or aliases in the header. Other columns and lines that
// begin with # are skipped. Throws SceneFileError with the line of the CSV file.
void read_columns(const std::string& path, const std::string& text, const Column& first,
                  std::vector<double>& a, const Column& second, std::vector<double>& b);

}  // namespace jvari
