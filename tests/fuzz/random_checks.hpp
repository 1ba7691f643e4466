// What every run of every scheme must keep on any scene, and what a certificate of a reference must
// keep.
#pragma once

#include <functional>
#include <string>

#include "random_scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::test {

// Bounds for every run, on ordinary and extreme scenes.
// of the largest stored energy, in one row, if the balance is exact
constexpr double ledger_row = 1e-9;
constexpr double ledger_sum = 1e-8;         // the same, summed over the run
constexpr double ledger_toleranced = 1e-5;  // both, if the balance holds to a tolerance
// True/claimed, where two references certify one another: a claim is the distance to another run,
// which errs as well, if less.
constexpr double claim_allowed = 1.1;
constexpr double claim_allowed_alone = 2;  // where one does so itself, at another accuracy
// what a row may lie outside of the extremes that a run tells, of the largest
constexpr double force_facts = 1e-6;
constexpr double largest_value = 1e12;   // of a tap, in SI units; beyond it the run has diverged
constexpr double sundials_seconds = 10;  // of CPU, for one run

// of a certificate about the scene, at most; those below 20 kHz where they are fewer
constexpr int model_modes = 80;
constexpr int scene_multiple = 8;          // of these is the truth
constexpr double about_scene_seconds = 5;  // of CPU: its certificate and its truth

struct Tally {
    // ended: by its limit; failed: a run that says so itself
    long scenes = 0, runs = 0, ended = 0, refused = 0, failed = 0;
    // figures of certificates that were compared with a truth
    long claims = 0;
    long judged = 0;         // scenes of which they are
    double worst_claim = 0;  // true/claimed, the largest
    // the same of a stand-in's estimate of its own error, which is no bound:
    long estimates = 0;
    long low_estimates = 0;  // how many were below the true error is told, and asserted of none
    double worst_estimate = 0;
    long harmed = 0;     // runs: matched errs by more than own
    double slowest = 0;  // CPU seconds of one run
    std::string slowest_at;
    void add(const Tally&);
};

using Finding = std::function<void(const std::string& scheme, const std::string& what)>;

void check_schemes(const RandomCase&, Tally&, const Finding&,
                   const std::function<void(const std::string&)>& at);
void check_certificate(const RandomCase&, Tally&, const Finding&,
                       const std::function<void(const std::string&)>& at);
// The certificate is for a limited number of modes and points of a profile. What it claims about
// the scene is compared with eight times the modes and four times the points.
void check_certificate_about_scene(const RandomCase&, Tally&, const Finding&,
                                   const std::function<void(const std::string&)>& at);

// Matched modal_two_point must not err by more than 1.2 times as much as own, in a tap whose error
// is above 1e-3. The truth is exact_contact with 4 to 8 times the modes, matched, and for bars and
// wide footprints own with 4 to 16 times; half of these give its uncertainty. What is refused does
// no harm.
// seconds: of CPU, each run of one scene
constexpr double harm = 1.2, harm_matters = 1e-3, matching_seconds = 10;
void check_matching(const RandomCase&, Matching, Tally&, const Finding&,
                    const std::function<void(const std::string&)>& at);
// Figures of two schemes, a line of CSV each (harm_figures.cpp).
extern const char* const harm_columns;
void harm_figures(const RandomCase&, const std::function<void(const std::string&)>& line);

// Relative L2 of a tap, from that instant on [s].
double apart(const Trace&, const Trace& truth, int tap, double from);

}  // namespace jvari::test
