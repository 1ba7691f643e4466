// Reads the CSV tables of a scene: measured modes and profiles of a bridge.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/schema.hpp"

namespace jvari {

// The text of a file of at most `limit` bytes. Throws std::runtime_error ("cannot be read", "is
// larger than ...").
std::string text_of_file(const std::string& path, std::size_t limit);

// Reads columns, found by their names or aliases in the header. Other columns and lines that begin
// with # are skipped. Throws SceneFileError with the line of the CSV file.
struct ColumnTo {
    Column column;
    std::vector<double>& to;
    bool may_lack = false;  // then `to` stays empty
};
void read_columns(const std::string& path, const std::string& text, std::span<const ColumnTo>);

}  // namespace jvari
