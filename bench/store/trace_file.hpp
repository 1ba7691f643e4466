// Writes a trace to a file: sound (.wav), and numbers (.csv, at the end).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/store/records.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::store {

struct Sound {
    double rate = 0;                    // [Hz]
    double peak = 0;                    // value of sample 32767, in the tap's unit
    std::vector<std::int16_t> samples;  // empty: no sound
};
// Returns no samples for a silent signal, for a signal with infinite or NaN values, or for an
// unplayable sample rate. Players need a whole number between 3 kHz and 768 kHz.
Sound sound_of(std::span<const double> signal, double rate);

std::string wav_of(const Sound&);  // contents of a .wav file, without the peak
Sound read_wav(const std::filesystem::path&, double peak);  // throws UsageError

// Signal in a sound file with one channel, in the samples' own unit: floating point unchanged,
// whole numbers scaled to full scale 1.
struct Signal {
    double rate = 0;  // [Hz]
    std::vector<double> samples;
};
Signal read_signal(const std::filesystem::path&);  // throws UsageError
Signal read_signal(const std::filesystem::path&,
                   // `refuse` throws, for example "which has 2 channels"
                   const std::function<void(const std::string& why)>& refuse);

struct NamedSound {
    std::vector<Field> who;  // cell columns
    std::string file;        // without folder and extension
    std::string tap, quantity;
    const Sound* sound;
    std::string reference;  // file of the reference's sound, "" if there is none
};
// Writes sounds/<file>.wav and sounds.csv: who, tap, quantity, sample_rate, peak, file,
// reference_file.
void write_sounds(const std::filesystem::path& folder, const std::vector<std::string>& who,
                  const std::vector<NamedSound>&);

// ---- A trace on disk as .csv, with 17 significant digits:
// time_s,<taps>[,energy_stored_J,energy_supplied_J,energy_dissipated_J].

inline constexpr const char* energy_names[] = {"energy_stored_J", "energy_supplied_J",
                                               "energy_dissipated_J"};

// Throws UsageError for an unwritable path. Called before the run, so no work is lost.
void check_trace_file(const std::filesystem::path&);

// Throws Unwritable.
void write_trace(const std::filesystem::path&, const Trace&);

}  // namespace jvari::bench::store
