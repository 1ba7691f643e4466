// Stepping loop: turns a scheme, a scene and a duration into a trace and its cost.
#pragma once

#include <functional>

#include "schemes/scheme.hpp"
#include "schemes/trace.hpp"

namespace jvari {

struct RunOptions {
    bool energy = false;  // keep the energy columns
    int block_rows = 64;  // rows per advance(); the output does not depend on it
    // Evaluates no energy except for the rows that are kept; another run checks that this one stays
    // within its energy.
    bool timed = false;
    bool state = false;  // keeps the state at the last row
    // one for each string, filled with its contacts; nullptr: not requested
    Impacts* impacts = nullptr;

    // Receives the run's progress every few hundredths of a second. The calls come from within the
    // rows if the scheme asks there (Block::stop); otherwise they come between blocks, which are
    // then equally short. An exception from this function ends the run and is passed on.
    std::function<void(long done, long rows)> progress = {};

    // Called once, between two blocks, after the run has taken `long_run`, with the scheme's facts.
    std::function<void(long done, long rows, const std::vector<Fact>&)> slow = {};
};

struct Run {
    Trace trace;
    Status status;
    int dofs = 0;
    long steps = 0;           // 0 for a continuous-time reference
    double wall_seconds = 0;  // stepping only
    // time for the longest whole block after the first [s of computing]; 0 if there is none
    double worst_block = 0;
    std::vector<Fact> facts;
    ModalState state;  // at the last row, if requested and if the scheme has a state
};

// Factor that defines divergence. A run has diverged if its stored energy exceeds this many times
// the initial plus the supplied energy, or if a value is not finite. It has also diverged if a tap
// exceeds the bound for this many times the scene's own energy (tap_bounds, scenes/excitation.hpp).
// The taps are checked because a scheme may report no energy, or, beyond its limit, keep an
// indefinite energy constant to rounding while the string flies off. Status and rows are the same
// whether or not the energy is kept (looks.hpp).
constexpr double energy_budget = 10;
constexpr double long_run = 2;  // [s] of computing

// True energy, relative to the initial and supplied energy, that a scheme without a promised
// balance may gain and still count sound.
constexpr double gain_allowed_unpromised = 1e-2;

// round(duration x tap_rate) + 1. Throws BadScene if a row is longer than the run, Refusal if there
// are too many rows to count.
long rows_of(const Scene&, const Settings&);

// Steps with denormals flushed to zero. Throws Refusal or BadScene before the first step, and
// BadScheme at any time. A run that fails on the way returns its status and the valid rows.
Run run(const Descriptor&, const Scene&, const Settings&, const RunOptions& = {});
// an existing scheme, from t = 0
Run run(Scheme&, const Scene&, const Settings&, const RunOptions& = {});

// Flushes denormals to zero on this thread while the object lives, then restores the previous
// setting.
class FlushDenormals {
public:
    FlushDenormals() noexcept;
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    [[maybe_unused]] unsigned saved_;
};

}  // namespace jvari
