// Reads the files that a start or a force comes from. Throws SceneFileError with the line.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace jvari {

// CSV: x_m, displacement_m and perhaps velocity_m_per_s; or mode, displacement_m and
// velocity_m_per_s.
TableStart start_from(const std::string& path, const std::string& text);

// CSV: time_s, force_N; or, where the name ends in .wav, a sound of one channel, whose samples are
// newtons, of whole numbers the full scale 1. Sets time, share, peak, amplitude, start, duration.
void force_from(const std::string& path, const std::string& text, Pluck&);

}  // namespace jvari
