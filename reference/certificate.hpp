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

#include <functional>
#include <string>
#include <vector>

#include "reference/agreement.hpp"
#include "schemes/run.hpp"

namespace jvari {

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
};

struct CertifySettings {
    // 0: every mode below 20 kHz
    int modes = 0;
    double tap_rate = 44100;  // [Hz]
    // before each run
    std::function<void(const std::string& reference, int done, int of)> progress = {};
    // of the run under way
    std::function<void(double fraction)> within = {};
};

// Throws BadScene, or Refusal where nothing at all represents the scene.
Certificate certify(const Scene&, const CertifySettings& = {});

// What it is going to run: the certificate's head, and its entries without their outcome. Throws
// Refusal as well.
Certificate certificate_plan(const Scene&, const CertifySettings& = {});

constexpr double floor_displacement = 1e-12;

// What all doublings of modes or points together change, over what the first does, for an order of
// one half: 1/(1 - 2^-1/2), rounded up. Displacements have an order above one. But the force of a
// stiff contact is slow: C3's at 60 modes needs 3.2.
constexpr double and_further_ones = 3.5;
// Matched modes change little at first, and then unevenly: a corner that is pressed on a stiff
// barrier in the open string needs 7.1.
constexpr double matched_and_further_ones = 8;

// The scene with every initial shape and every pluck scaled.
Scene moved(Scene, double factor);

}  // namespace jvari
