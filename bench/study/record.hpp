// Record of a finished job: one file per job, FOLDER/<id>.json, written by rename. Numbers stay
// numbers until a table is written.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/store/records.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/certificate_library.hpp"

namespace jvari::bench::study {

// Spectrogram, coarse enough to be drawn: the strongest bin in each row of frequency, frame by
// frame.
struct Levels {
    int frames = 0, rows = 0;
    double start = 0, hop = 0;  // left edge of the first frame, and distance between frames [s]
    double row_hz = 0;
    // frames x rows, tenths of a decibel re the squared unit; -4000 and below is silence
    std::vector<int> level;
};
constexpr int silent_level = -4000;  // [0.1 dB]

// Computes at most 60 frames of 46 ms (Hann; shorter for a short signal) and 100 rows. Empty for a
// signal below 64 rows.
Levels levels_of(std::span<const double> signal, double rate);

struct Against {            // reference of a cell
    std::string reference;  // name; "" without a reference: then the other fields are empty
    int modes = 0;
    std::string doubling;      // how far the modes were doubled
    Errors floor;              // errors of the reference started 1e-12 apart
    Trust trust, model_trust;  // trust in the reference, and in the reference with the cells' modes
    double limit_hz = nan;     // Truth::limit_hz
};

struct Record {
    Cell cell;
    Against against;
    // spectrogram; empty if nobody asked for one
    Levels levels;
    store::Sound reference_sound;  // sound at the cell's tap; empty likewise
    std::string beside{};          // JSON from Job::beside; "": nothing
    bool timed() const { return cell.clock.wall.count > 0; }
};

// Excludes the measured times, which are stored apart (cost.hpp).
std::string json_of(const Record&, const std::string& identity);
// Reads the record of the cell `planned`. Returns nothing if the file is absent, unreadable, from
// another job, or has a wrong checksum.
std::optional<Record> read_record(const std::filesystem::path&, const std::string& identity,
                                  const Cell& planned);
// Spectrogram in such a file, empty if the run made none. Nothing if the job did not measure
// `name`, or the file cannot be read.
std::optional<Levels> read_levels(const std::filesystem::path&, const std::string& name);

}  // namespace jvari::bench::study
