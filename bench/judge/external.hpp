// Any program as a scheme, by files: COMMAND problem.json trace.csv reads the problem, as `jvari
// export` writes it without its reference, and writes the rows that foreign_trace.hpp reads. It is
// called once for each scene and setting.
#pragma once

#include <string>

namespace jvari::bench::judge {

// Makes it a scheme, whose name is that of its file ("octave-cli mine.m": mine), and returns the
// path of its guest. What it computes is known again by the command and the files that it names, as
// the shell reads it: scripts, data, and programs on the PATH.
std::string enter_external(const std::string& command);

}  // namespace jvari::bench::judge
