// What a job came to, as it is kept: one file per job, FOLDER/<id>.json, written by rename. Numbers
// stay numbers until a table is written.
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

// A spectrogram made coarse enough to be drawn: the strongest bin in each row of frequency, frame
// by frame.
struct Levels {
    int frames = 0, rows = 0;
    double start = 0, hop = 0;  // of the first frame's left edge, from frame to frame [s]
    double row_hz = 0;
    // frames x rows, tenths of a decibel re the unit squared; -4000 and below is silence
    std::vector<int> level;
};
constexpr int silent_level = -4000;  // [0.1 dB]

// At most 60 frames of 46 ms (Hann; shorter where the signal is) and 100 rows; none for fewer than
// 64 rows of signal.
Levels levels_of(std::span<const double> signal, double rate);

struct Against {            // what a cell was measured against
    std::string reference;  // its name, "" where there is none: then the rest is empty
    int modes = 0;
    std::string doubling;      // how far the doubling of its modes went
    Errors floor;              // of the reference started 1e-12 apart
    Trust trust, model_trust;  // of the reference, and of the one with the cells' modes
};

struct Record {
    Cell cell;
    Against against;
    // of the spectrogram; none where it was not asked for
    Levels levels;
    store::Sound reference_sound;  // of the tap of the cell's; none likewise
    std::string beside{};          // JSON of what was found out beside the cell; "": nothing
    bool timed() const { return cell.clock.wall.count > 0; }
};

// Without what the clock said: that is kept apart (cost.hpp).
std::string json_of(const Record&, const std::string& identity);
// Of the cell in `planned`. Nothing where there is no such file, it is of another job, its checksum
// is not its own, or it cannot be read.
std::optional<Record> read_record(const std::filesystem::path&, const std::string& identity,
                                  const Cell& planned);
// The spectrogram in such a file, empty where the run made none.
// Nothing where the job did not measure what is called `name`, or the file cannot be read.
std::optional<Levels> read_levels(const std::filesystem::path&, const std::string& name);

}  // namespace jvari::bench::study
