// A trace as a file: its sound (.wav), and its numbers (.csv, at the end).
//
// The sound is the force on the nut, which drives the body; 16 bit, scaled to its own peak. It is
// as the scheme gave it: not differentiated, no body. A scene without a nut force is heard at its
// first tap.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari::bench::store {

struct Sound {
    double rate = 0;                    // [Hz]
    double peak = 0;                    // what 32767 stands for, in the tap's unit
    std::vector<std::int16_t> samples;  // none: nothing to hear
};
// None for a signal that is not finite or silent, or a rate that is no whole number.
Sound sound_of(std::span<const double> signal, double rate);

std::string wav_of(const Sound&);                           // of a .wav file; its peak is not in it
Sound read_wav(const std::filesystem::path&, double peak);  // throws UsageError

// What a sound file of one channel holds, in the unit that its samples are in: floating point as it
// is, whole numbers of full scale 1.
struct Signal {
    double rate = 0;  // [Hz]
    std::vector<double> samples;
};
Signal read_signal(const std::filesystem::path&);  // throws UsageError
Signal read_signal(const std::filesystem::path&,
                   // which throws: "which has 2 channels"
                   const std::function<void(const std::string& why)>& refuse);

struct NamedSound {
    std::vector<std::string> who;  // the cell columns
    std::string file;              // without folder and extension
    std::string tap, quantity;
    const Sound* sound;
    std::string reference;  // the file of its reference, "" where there is none
};
// sounds/<file>.wav and sounds.csv: who, tap, quantity, sample_rate, peak, file, reference_file.
void write_sounds(const std::filesystem::path& folder, const std::vector<std::string>& who,
                  const std::vector<NamedSound>&);

// ---- A trace on disk as .csv, with 17 significant digits:
// time_s,<taps>[,energy_stored_J,energy_supplied_J,energy_dissipated_J].

inline constexpr const char* energy_names[] = {"energy_stored_J", "energy_supplied_J",
                                               "energy_dissipated_J"};

// Throws UsageError for a path that cannot be written; before the run, so that no work is lost.
void check_trace_file(const std::filesystem::path&);

// Throws Unwritable.
void write_trace(const std::filesystem::path&, const Trace&);

}  // namespace jvari::bench::store
