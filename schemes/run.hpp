// The stepping loop: a scheme, a scene, a duration -> a trace and what it cost.
#pragma once

#include <functional>

#include "schemes/scheme.hpp"
#include "schemes/trace.hpp"

namespace jvari {

struct RunOptions {
    bool energy = false;  // keep the energy columns
    int block_rows = 64;  // rows per advance(); the output does not depend on it
    // no energy is asked for but what is kept: another run tells whether this one stays within its
    // energy
    bool timed = false;
    bool state = false;  // keep that of the last row
    // one for each string: what its contacts did; nullptr: not asked for
    Impacts* impacts = nullptr;

    // Told how far the run is, every few hundredths of a second where the scheme asks within its
    // rows (Block::stop), else between blocks, which are then as short as that. What it throws ends
    // the run and comes out of it.
    std::function<void(long done, long rows)> progress = {};

    // Told once, between two blocks, that the run has taken `long_run` and what the scheme says of
    // itself.
    std::function<void(long done, long rows, const std::vector<Fact>&)> slow = {};
};

struct Run {
    Trace trace;
    Status status;
    int dofs = 0;
    long steps = 0;           // 0 for a continuous-time reference
    double wall_seconds = 0;  // of the stepping alone
    // the longest whole block after the first [s of computing]; 0 where there is none
    double worst_block = 0;
    std::vector<Fact> facts;
    ModalState state;  // of the last row, where it is asked for and the scheme has one
};

// A run whose stored energy exceeds this many times what was there at the start and has been
// supplied since has diverged. So has one with a value that is not finite, or a tap beyond what as
// many times the scene's own energy could make of it (tap_bounds, scenes/excitation.hpp): a scheme
// may tell no energy, or beyond its limit keep an indefinite one constant to rounding while the
// string flies off. Status and rows are the same whether the energy is kept or not (looks.hpp).
constexpr double energy_budget = 10;
constexpr double long_run = 2;  // [s] of computing

// True energy, as a part of what there was, that a scheme without a promised balance may gain and
// still count as sound.
constexpr double gain_allowed_unpromised = 1e-2;

// round(duration x tap_rate) + 1. Throws BadScene where a row is longer than the run, Refusal where
// there are more than can be counted.
long rows_of(const Scene&, const Settings&);

// Denormals are flushed to zero while stepping. Throws Refusal or BadScene before the first step,
// and BadScheme at any time; a run that fails on the way ends with its status and the rows that are
// valid.
Run run(const Descriptor&, const Scene&, const Settings&, const RunOptions& = {});
// an existing scheme, from t = 0
Run run(Scheme&, const Scene&, const Settings&, const RunOptions& = {});

// Flushes denormals to zero on this thread for the life of the object, then restores what was set.
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
