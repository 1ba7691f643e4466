#include "schemes/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace jvari {

#if defined(__SSE2__)
FlushDenormals::FlushDenormals() noexcept : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | 0x8040u);
}  // FTZ | DAZ
FlushDenormals::~FlushDenormals() {
    _mm_setcsr(saved_);
}
#else
FlushDenormals::FlushDenormals() noexcept : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

namespace {
// The first row in [from, to) that no sound run can have: a value that is not finite, or more energy stored than `energy_budget` times what
// was there at the start and has been supplied since. `to` where all are sound. `given` sums the supply.
long first_unsound_row(const Trace& t, long from, long to, double& given) {
    for (long n = from; n < to; ++n) {
        for (int k = 0; k < t.taps(); ++k)
            if (!std::isfinite(t.tap[k * t.stride + n])) return n;
        if (t.energy.empty()) continue;
        const double stored = t.energy[n];
        given += std::abs(n == 0 ? stored : t.energy[t.stride + n]);
        if (!std::isfinite(stored) || stored > energy_budget * given) return n;
    }
    return to;
}

using Steady = std::chrono::steady_clock;
constexpr auto patience = std::chrono::milliseconds(20);  // between two calls of progress
constexpr double most_rows = 1L << 40;

// Tells the caller's progress how far the run is, and keeps what it throws out of a scheme's noexcept code.
class Teller {
public:
    Teller(const std::function<void(long, long)>& progress, long rows) : progress_(progress), rows_(rows) {}
    long done = 0;

    void into(Block& block) {
        if (!progress_) return;
        block.stop = [](void* self) { return static_cast<Teller*>(self)->tell(); };
        block.caller = this;
    }
    bool tell() noexcept {  // true: the run is to end. The clock costs as much as some steps: where questions come fast, few look at it
        if (!thrown_ && ++asked_ < each_) return false;
        asked_ = 0;
        const auto now = Steady::now();
        each_ = now - looked_ < patience / 16 ? std::min(2 * each_, 16) : std::max(1, each_ / 2);
        looked_ = now;
        if (thrown_ || now - last_ < patience) return thrown_ != nullptr;
        last_ = now;
        try {
            progress_(done, rows_);
        } catch (...) {
            thrown_ = std::current_exception();
        }
        return thrown_ != nullptr;
    }
    void rethrow() const {
        if (thrown_) std::rethrow_exception(thrown_);
    }
    void block_done() const {
        if (progress_) progress_(done, rows_);
    }

private:
    const std::function<void(long, long)>& progress_;
    const long rows_;
    Steady::time_point last_ = Steady::now(), looked_ = last_;
    int asked_ = 0, each_ = 1;
    std::exception_ptr thrown_;
};

// A scheme's word about the block it has just made, whose first step is `first` and whose rows have `steps` each.
void check(const Status& status, long first, const Block& block, double steps) {
    if (status.outcome == Outcome::ok) return;
    const double last = static_cast<double>(first) + block.rows * steps;
    if (status.outcome != Outcome::diverged && status.outcome != Outcome::not_converged)
        throw BadScheme("the scheme says how a run ended by the number " + std::to_string(static_cast<int>(status.outcome)) +
                        ", which has no meaning");
    if (status.step < first || static_cast<double>(status.step) > last)
        throw BadScheme("the scheme says that step " + std::to_string(status.step) + " failed, in the block of steps " +
                        std::to_string(first) + " to " + std::to_string(std::lround(last)));
}

// The window of a trace that begins at a row and has this many, or those that are left before `end`.
Block block_at(Trace& trace, long row, int rows, long end) {
    Block block;
    block.rows = static_cast<int>(std::min<long>(rows, end - row));
    block.taps = trace.taps();
    block.stride = trace.stride;
    block.tap = trace.tap.empty() ? nullptr : trace.tap.data() + row;
    block.energy = trace.energy.empty() ? nullptr : trace.energy.data() + row;
    return block;
}

// Steps the scheme once more to the end of the rows that are sound: what a block went on to do beyond them is in none of its facts, which
// would else be a matter of how long the block was.
void replay(Scheme& scheme, Trace& trace, int block_rows, Teller& teller) {
    scheme.reset();
    for (long row = 0; row < trace.rows; row += block_rows) {
        Block block = block_at(trace, row, block_rows, trace.rows);
        teller.into(block);
        scheme.advance(block);
        teller.rethrow();
    }
}

long rows_of(const Scene& scene, const Settings& settings) {
    const double intervals = std::round(scene.duration * settings.tap_rate);
    if (!(intervals >= 0 && intervals < most_rows))
        throw Refusal(std::to_string(scene.duration) + " s at " + std::to_string(settings.tap_rate) +
                      " rows a second: expected no more than " + std::to_string(static_cast<long>(most_rows)) + " rows");
    return static_cast<long>(intervals) + 1;
}
}  // namespace

// A scheme in continuous time has no rate: its rows are its steps.
Run run(Scheme& scheme, const Scene& scene, const Settings& settings, const RunOptions& options) {
    Run result;
    Trace& trace = result.trace;
    trace.tap_rate = settings.tap_rate;
    trace.stride = rows_of(scene, settings);
    for (const Tap& tap : scene.taps) trace.names.push_back(tap.name);
    trace.tap.assign(trace.stride * trace.names.size(), 0.0);
    if (options.energy) trace.energy.assign(trace.stride * 3, 0.0);
    result.dofs = scheme.dofs();
    const bool continuous = settings.sample_rate == 0;
    const double steps_per_row = continuous ? 1 : settings.sample_rate / settings.tap_rate;

    scheme.reset();
    const FlushDenormals flush;
    Steady::duration stepping{};
    double given = 0;
    bool told = false;
    Teller teller(options.progress, trace.stride);
    const bool listened = options.progress || options.slow;
    int rows = listened ? 1 : options.block_rows;  // of the next block
    while (trace.rows < trace.stride && result.status.outcome == Outcome::ok) {
        Block block = block_at(trace, trace.rows, rows, trace.stride);
        teller.into(block);
        const auto start = Steady::now();
        result.status = scheme.advance(block);
        const auto took = Steady::now() - start;
        stepping += took;
        if (trace.rows > 0 && block.rows == options.block_rows)
            result.worst_block = std::max(result.worst_block, std::chrono::duration<double>(took).count());
        if (!listened) rows = options.block_rows;
        else if (took > patience) rows = std::max(1, rows / 2);
        else if (took < patience / 4) rows = std::min(options.block_rows, 2 * rows);

        teller.rethrow();
        check(result.status, std::lround(static_cast<double>(trace.rows) * steps_per_row), block, steps_per_row);
        long end = trace.rows + block.rows;
        if (result.status.outcome != Outcome::ok) end = std::min(end, static_cast<long>(result.status.step / steps_per_row) + 1);
        const long sound = first_unsound_row(trace, trace.rows, end, given);
        trace.rows = teller.done = sound;
        if (sound < end) {
            result.status = {Outcome::diverged, std::lround(sound * steps_per_row)};
            replay(scheme, trace, options.block_rows, teller);
        }
        teller.block_done();
        if (options.slow && !told && stepping > std::chrono::duration<double>(long_run) && trace.rows < trace.stride) {
            told = true;
            options.slow(trace.rows, trace.stride, heard("tells its facts", [&] { return scheme.facts(); }));
        }
    }
    if (!continuous) result.steps = std::lround(steps_per_row * static_cast<double>(trace.rows));
    result.wall_seconds = std::chrono::duration<double>(stepping).count();
    result.facts = heard("tells its facts", [&] { return scheme.facts(); });
    return result;
}

Run run(const Descriptor& descriptor, const Scene& scene, const Settings& settings, const RunOptions& options) {
    Settings own = settings;
    if (descriptor.clock == Clock::continuous) own.sample_rate = 0;
    return run(*make_scheme(descriptor, scene, own), scene, own, options);
}

}  // namespace jvari
