// Certificate of the references: which references agree on a scene, until when, how closely, and at
// what cost. The certificate tells how far a reference may be trusted.
//
// Every reference that represents the scene runs at its default accuracy and at the other
// accuracies on offer. All pairs are compared tap by tap. If sundials is the only reference, a
// finer tolerance and another integration method run too. The noise floor compares the first
// reference with itself, started a relative 1e-12 apart: no two programs can agree more closely for
// long.
//
// All these runs share the same cut of the modes and the same points for each profile. They agree
// about both, but the scene has neither. So the first reference also runs with twice the modes, and
// with twice the points. The change shows the effect of the modes and points left out.
//
// If the first reference takes compliance=matched, it runs with this option too, at both
// accuracies. The run with twice the modes is also matched, because matched compliance is nearer to
// the scene with the same modes.
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/store/machine.hpp"
#include "bench/store/system/listener.hpp"
#include "reference/agreement.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

struct Certificate {
    using Options = std::vector<std::pair<std::string, std::string>>;
    using ByWindow = std::array<double, agreement_windows.size()>;
    struct Entry {
        // name of the reference; "oversampled modal_two_point" for a scheme at a multiple of a rate
        std::string reference;
        Options options;         // options given to the reference; none: its default
        double sample_rate = 0;  // [Hz], 0 in continuous time
        Status status;
        double reached = 0;       // [s], last valid row
        double wall_seconds = 0;  // duration of the stepping
        // own error estimate by tap and window; empty if the reference makes none
        std::vector<ByWindow> estimate;
        std::string reason;  // reason of a refusal; if set, the entry has no results
        // "modes" or "points": the size that is doubled; "": the size of the certificate's model
        std::string doubled;
        const Descriptor* scheme = nullptr;                   // set in a plan only, not stored
        std::string name() const;                             // "sundials rtol=1e-12"
        bool oversampled() const { return sample_rate > 0; }  // a stand-in
    };
    struct Pair {
        int first, second;  // places of two entries; differences are relative to the second
        std::vector<Agreement> taps;
    };
    std::string scene;
    int modes = 0;
    double tap_rate = 0, duration = 0;  // [Hz], [s]
    // start of the windows and zero for instants of agreement [s]: free_from(scene)
    double from = 0;
    std::vector<std::string> taps;
    std::vector<Entry> entries;  // in order of authority
    // Pairs of entries that ran and share a model. A doubled entry is paired with its own reference
    // only.
    std::vector<Pair> pairs;
    std::vector<Agreement> floor;  // by tap
    std::string scene_hash;        // hash of the scene, independent of its duration
    std::string program = store::run_identity();

    std::string identity() const;  // JSON of all fields above that are known before the runs
    std::string key() const;       // hash_of(identity)
    // true for the same sources, compiler, flags and vector instructions
    bool of_this_program() const { return program == store::run_identity(); }
};

std::string timeless_hash(const Scene&);  // scene_hash of the scene with its duration set to 1 s

struct CertifySettings {
    int modes = 0;            // 0: every mode below 20 kHz
    double tap_rate = 44100;  // [Hz]
};

// Lists the entries to run, without results. Throws BadScene, or Refusal if no reference represents
// the scene.
Certificate certificate_plan(const Scene&, const CertifySettings& = {});

// Runs the plan, one reference after the other because their costs are measured. Runs are kept in
// the folder `runs` and read from there (reference.hpp); "": nowhere. A run longer than `seconds`
// of processor time, or than ten minutes, becomes an entry with this reason. Throws the exceptions
// of certificate_plan.
Certificate certify(const Scene&, Certificate plan, const store::Listener& = {},
                    const std::filesystem::path& runs = {}, double seconds = HUGE_VAL);

// ---- Files. <scene>.json holds the numbers that repeat to the last digit with one program on one
// type of machine. <scene>.cost.json beside it holds the measured times, with date, commit and
// machine. Numbers of the two kinds never share a committed file.

std::string json_of(const Certificate&);
std::string cost_json_of(const Certificate&);  // wall seconds of each entry

// Reads a certificate. Returns nothing if the file is absent, incomplete or in another format. A
// certificate from another program is accepted: its figures describe that program's references. The
// wall seconds are NaN.
std::optional<Certificate> read_certificate(const std::filesystem::path&);

// path of the cost file: a.cost.json for a.json
std::filesystem::path cost_path(const std::filesystem::path& certificate);
// Fills in the wall seconds from the file beside the certificate, if both have the same identity.
void read_costs(const std::filesystem::path& certificate, Certificate&);

}  // namespace jvari::bench::study
