// Which references agree on a scene, until when, to how much, and at what cost: what a reference
// may be trusted with.
//
// Every reference that represents the scene runs at its default accuracy and at those that it
// offers beside; all pairs are compared tap by tap. Where sundials stands alone, it also runs to a
// finer tolerance and by another method. The noise floor is the first of them against itself,
// started a relative 1e-12 apart: no two programs can agree better for long.
//
// All of these share one cut of the modes and one set of points for each profile, which they agree
// about and which the scene does not have. So the first reference also runs with twice the modes,
// and with twice the points: what that changes is what the model leaves out.
//
// If the first reference takes compliance=matched it runs with it as well, at both accuracies. With
// twice the modes it has it too, for it is nearer to the scene with the same modes.
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
        // its name, "oversampled modal_two_point" for a scheme at a multiple of a rate
        std::string reference;
        Options options;         // as given to it; none: its default
        double sample_rate = 0;  // [Hz], 0 in continuous time
        Status status;
        double reached = 0;       // [s], last valid row
        double wall_seconds = 0;  // of the stepping
        // its own estimate of its error by tap and window; empty where it has none
        std::vector<ByWindow> estimate;
        std::string reason;  // of a refusal; then nothing else is set
        // "modes" or "points": what it has twice as many of; "": it is of the certificate's model
        std::string doubled;
        const Descriptor* scheme = nullptr;  // of a plan; not kept
        std::string name() const;            // "sundials rtol=1e-12"
    };
    struct Pair {
        int first, second;  // entries; relative to the second
        std::vector<Agreement> taps;
    };
    std::string scene;
    int modes = 0;
    double tap_rate = 0, duration = 0;  // [Hz], [s]
    // where its windows begin [s], and the instants of agreements count from: free_from(scene)
    double from = 0;
    std::vector<std::string> taps;
    std::vector<Entry> entries;  // in order of authority
    // of the entries that ran and share a model; one that is doubled has pairs with its own
    // reference alone
    std::vector<Pair> pairs;
    std::vector<Agreement> floor;  // by tap
    std::string scene_hash;        // of the scene whatever its duration
    std::string program = store::run_identity();

    std::string identity() const;  // JSON: all of the above that is known before it runs
    std::string key() const;       // hash_of it
    // the same sources, compiler, flags and vector instructions
    bool of_this_program() const { return program == store::run_identity(); }
};

std::string timeless_hash(const Scene&);  // scene_hash of the scene as if it lasted 1 s

struct CertifySettings {
    int modes = 0;            // 0: every mode below 20 kHz
    double tap_rate = 44100;  // [Hz]
};

// What is going to run: the entries without their outcome. Throws BadScene, or Refusal where
// nothing at all represents the scene.
Certificate certificate_plan(const Scene&, const CertifySettings& = {});

// Runs it, one reference after the other, for their costs are measured. Runs are kept in that
// folder and come from there (kept_run.hpp); "": nowhere. A run that takes longer than `seconds` of
// processor, or than ten minutes, is an entry that says so. Throws as the plan does.
Certificate certify(const Scene&, Certificate plan, const store::Listener& = {},
                    const std::filesystem::path& runs = {}, double seconds = HUGE_VAL);

// ---- As files. <scene>.json has what repeats to the last digit on one program and one type of
// machine; <scene>.cost.json beside it what a clock measured, with date, commit and machine:
// numbers of the two kinds never share a file that is committed.

std::string json_of(const Certificate&);
std::string cost_json_of(const Certificate&);  // wall seconds of each entry

// Nothing where there is no such file, it is not whole, or it is of another format. One that
// another program made is read: its figures are those of the references as they were then. Its wall
// seconds are NaN.
std::optional<Certificate> read_certificate(const std::filesystem::path&);

std::filesystem::path cost_path(const std::filesystem::path& certificate);  // a.json: a.cost.json
// Fills in the wall seconds from the file beside the certificate, if it is of the same identity.
void read_costs(const std::filesystem::path& certificate, Certificate&);

}  // namespace jvari::bench::study
