// Reads the files of a scene: measured modes, profiles of a bridge, starts and forces.
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

// What a start or a force comes from. Both throw SceneFileError with the line.

// CSV: x_m, displacement_m and perhaps velocity_m_per_s; or mode, displacement_m and
// velocity_m_per_s.
TableStart start_from(const std::string& path, const std::string& text);

// CSV: time_s, force_N; or, where the name ends in .wav, a sound of one channel, whose samples are
// newtons, of whole numbers the full scale 1. Sets time, share, peak, amplitude, start, duration.
void force_from(const std::string& path, const std::string& text, Pluck&);

}  // namespace jvari
