// Reads tables: measured modes, profiles of a bridge, starts and forces of a scene, and strings on
// sale.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "scenes/modes.hpp"
#include "scenes/schema.hpp"

namespace jvari {

// Text of a file with at most `limit` bytes. Throws std::runtime_error ("cannot be read", "is
// larger than ...").
std::string text_of_file(const std::string& path, std::size_t limit);

// Reads columns, found by their names, aliases or other spellings in the header, in small or
// capital letters. Other columns and lines that begin with # are skipped. Throws SceneFileError
// with the line in the CSV file, also if the last line has no end: a file truncated there has a
// wrong last number.
struct ColumnTo {
    Column column;
    // numbers; numbers whose cell may be empty; words, none of them empty
    std::variant<std::vector<double>*, std::vector<std::optional<double>>*,
                 std::vector<std::string>*>
        to;
    bool may_lack = false;  // then `to` stays empty
};
// Returns the line number of each row.
std::vector<int> read_columns(const std::string& path, const std::string& text,
                              std::span<const ColumnTo>);

// ---- Modes (damping.cpp), starts (start.cpp) and forces. All throw SceneFileError with the line.

inline constexpr Range mode_number{"the number of a mode, a whole number from 1 to 1048576", 1,
                                   most_modes};

// CSV: the columns of a frequency and a decay rate, and optionally mode, the number of each row's
// mode. Modes absent from such a file are interpolated: (f/m)^2 is a straight line in m^2 between
// the neighbours, which a stiff string obeys, and the decay rate a straight line in m.
void modes_from(const std::string& path, const std::string& text, const Column& frequency,
                const Column& decay, TableDamping&);

// CSV: x_m, displacement_m and optionally velocity_m_per_s; or mode, displacement_m and
// velocity_m_per_s. A first line "# state of NAME" names the scene to which the state belongs.
TableStart start_from(const std::string& path, const std::string& text);

// CSV: time_s, force_N; or a RIFF WAVE file with one channel, whose samples are newtons; for whole
// numbers the full scale is 1. Sets time, share, peak, amplitude, start, duration.
void force_from(const std::string& path, const std::string& text, Pluck&);

// A string on sale, a row in gauges.csv with figures from two makers. The file comes from the
// working directory or, if absent there, from the library.
struct SoldString {
    std::string maker, series;
    double gauge;                // [in]
    double linear_density;       // [kg/m]
    std::optional<double> core;  // core diameter [m]; for a plain string its own; none: not known
};

// Throws SceneFileError with the line.
std::vector<SoldString> sold_strings();

// Finds the string in a series with thickness `diameter` [m], to 1e-4 in. Throws SceneFileError,
// which names the nearest gauges, if the series lacks it.
SoldString sold_string(const std::vector<SoldString>&, const std::string& series, double diameter);

}  // namespace jvari
