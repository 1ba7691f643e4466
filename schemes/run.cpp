#include "schemes/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <stdexcept>

#include "scenes/excitation.hpp"
#include "scenes/start.hpp"
#include "scenes/wording.hpp"
#include "schemes/looks.hpp"
#include "schemes/making.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace jvari {

#if defined(__SSE2__)
FlushDenormals::FlushDenormals() noexcept : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | 0x8040u);
}  // FTZ | DAZ
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }
#elif defined(__aarch64__)
namespace {
std::uint64_t control() noexcept {
    std::uint64_t fpcr = 0;
    asm volatile("mrs %0, fpcr" : "=r"(fpcr));
    return fpcr;
}
void set_control(std::uint64_t fpcr) noexcept { asm volatile("msr fpcr, %0" : : "r"(fpcr)); }
}  // namespace
FlushDenormals::FlushDenormals() noexcept : saved_(static_cast<unsigned>(control())) {
    set_control(saved_ | 1u << 24);  // FZ
}
FlushDenormals::~FlushDenormals() { set_control(saved_); }
#else
FlushDenormals::FlushDenormals() noexcept : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

namespace {
using Steady = std::chrono::steady_clock;
constexpr auto patience = std::chrono::milliseconds(20);  // between two progress calls
constexpr double most_rows =
    std::min(0x1p40, 0.5 * static_cast<double>(std::numeric_limits<long>::max()));

// Reports progress to the caller, and carries the callback's exceptions past the scheme's noexcept
// code.
class Teller {
public:
    Teller(const std::function<void(long, long)>& progress, long rows)
        : progress_(progress), rows_(rows) {}
    long done = 0;

    void into(Block& block) {
        if (!progress_) return;
        block.stop = [](void* self) { return static_cast<Teller*>(self)->tell(); };
        block.caller = this;
    }
    // true: the run is to end. Reading the clock costs about the same time that some steps cost, so
    // only a few of many fast questions read it
    bool tell() noexcept {
        if (!thrown_ && ++calls_ < each_) return false;
        calls_ = 0;
        const auto now = Steady::now();
        each_ = now - looked_ < patience / 16 ? std::min(2 * each_, 16) : std::max(1, each_ / 2);
        looked_ = now;
        if (thrown_ || now - last_ < patience) return thrown_ != nullptr;
        last_ = now;
        try {
            progress_(done, rows_);
        } catch (...) { thrown_ = std::current_exception(); }
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
    int calls_ = 0, each_ = 1;
    std::exception_ptr thrown_;
};

// Checks a scheme's status for the block just made, whose first step is `first` and whose rows have
// `steps` each.
void check(const Status& status, long first, const Block& block, double steps) {
    if (status.outcome == Outcome::ok) return;
    const double last = static_cast<double>(first) + block.rows * steps;
    if (status.outcome != Outcome::diverged && status.outcome != Outcome::not_converged)
        throw BadScheme("the scheme says how a run ended by the number " +
                        std::to_string(static_cast<int>(status.outcome)) +
                        ", which has no meaning");
    if (status.step < first || static_cast<double>(status.step) > last)
        throw BadScheme("the scheme says that step " + std::to_string(status.step) +
                        " failed, in the block of steps " + std::to_string(first) + " to " +
                        std::to_string(std::lround(last)));
}

std::vector<Fact> facts_of(const Scheme& scheme) {
    return with_context("tells its facts", [&] { return scheme.facts(); });
}

// Makes the rows of a trace, and decides which rows are sound. In a sound row the taps are within
// the bound for `energy_budget` times the scene's energy. Its stored energy is at most
// `energy_budget` times the initial plus the supplied energy.
class Stepper {
public:
    Stepper(Scheme& scheme, Trace& trace, const Scene& scene, int modes, const RunOptions& options,
            Teller& teller)
        : scheme_(scheme),
          trace_(trace),
          options_(options),
          teller_(teller),
          looks_(scene, trace.tap_rate, trace.stride),
          kept_(options.energy),
          bounds_(tap_bounds(scene, modes)),
          beside_(static_cast<std::size_t>(options.block_rows) * (trace.names.size() + 3)) {
        // An aliasing mode has another compliance than the string's.
        const bool aliases = fact_of(facts_of(scheme), facts::modes_above_nyquist) > 0;
        constexpr double most = std::numeric_limits<double>::max();
        for (double& b : bounds_) b = aliases ? most : std::min(std::sqrt(energy_budget) * b, most);
    }

    // Returns the next rows, at most `rows`. Their energy is evaluated for all or for none.
    Block next(int rows) {
        const long row = trace_.rows;
        look_ = options_.timed ? Look{false, trace_.stride} : looks_.at(row);
        return block_at(row, std::min(row + rows, look_.until), look_.now);
    }
    Status advance(const Block& block) {
        Block with_impacts = block;
        with_impacts.impacts = options_.impacts;
        return advance(with_impacts, trace_.rows);
    }

    // Returns the end of the sound rows up to `end`, after a block was made. If a row seems
    // unsound, or the scheme has failed, the supply is summed row by row, and the rows since the
    // last look are evaluated too.
    long sound_until(const Block& block, long end, bool failed) {
        double given = given_;
        const auto stands_for = [this](long row) { return looks_.stands_for(row); };
        const long sound = look_.now ? first_unsound(block, trace_.rows, end, given, stands_for)
                                     : first_out_of_bounds(block, trace_.rows, end);
        if (options_.timed) return sound;
        if (sound < end || failed) return look_back(end);
        if (look_.now) given_ = given;
        // rows that are evaluated together stay together in blocks of any size
        if (look_.now && end == look_.until) unlooked_ = end;
        return end;
    }

    // Makes the rows up to `end` once more. The scheme's facts then exclude the rest of the block
    // beyond the sound rows, and so do not depend on the block length.
    void make_anew(long end) {
        scheme_.reset();
        for (long row = 0; row < end; row += options_.block_rows)
            make(row, std::min(row + options_.block_rows, end), false);
    }

private:
    Block block_at(long row, long end, bool probed) {
        Block block;
        block.rows = static_cast<int>(end - row);
        block.taps = trace_.taps();
        if (probed && !kept_) {
            block.stride = options_.block_rows;
            block.tap = beside_.data();
            block.energy = beside_.data() + block.taps * block.stride;
        } else {
            block.stride = trace_.stride;
            block.tap = trace_.tap.empty() ? nullptr : trace_.tap.data() + row;
            block.energy = kept_ ? trace_.energy.data() + row : nullptr;
        }
        return block;
    }
    Status advance(const Block& block, long row) {
        Block asking = block;
        teller_.into(asking);
        const Status status = scheme_.advance(asking);
        for (int k = 0; block.tap == beside_.data() && k < block.taps; ++k)
            std::copy_n(block.tap + k * block.stride, block.rows,
                        trace_.tap.data() + k * trace_.stride + row);
        return status;
    }
    Block make(long row, long end, bool probed) {
        const Block block = block_at(row, end, probed);
        advance(block, row);
        teller_.rethrow();
        return block;
    }

    // For a block that begins at `row`; `end` if all are within bounds.
    long first_out_of_bounds(const Block& block, long row, long end) const {
        for (long n = row; n < end; ++n)
            for (int k = 0; k < block.taps; ++k)
                if (!(std::abs(block.tap[k * block.stride + n - row]) <=
                      bounds_[static_cast<std::size_t>(k)]))
                    return n;
        return end;
    }
    // Likewise, for rows with evaluated energy; `given` sums the supply.
    template <class StandsFor>
    long first_unsound(const Block& block, long row, long end, double& given,
                       const StandsFor& stands_for) const {
        end = first_out_of_bounds(block, row, end);
        for (long n = row; n < end; ++n) {
            const double rows = n == 0 ? 1 : static_cast<double>(stands_for(n)),
                         stored = block.energy[n - row];
            if (rows == 0) continue;
            given += rows * std::abs(n == 0 ? stored : block.energy[block.stride + n - row]);
            if (!std::isfinite(stored) || stored > energy_budget * given) return n;
        }
        return end;
    }
    long look_back(long end) {
        double given = 0;
        if (!kept_) scheme_.reset();
        for (long row = 0, to = 0; row < end; row = to) {
            const Look look = looks_.back_at(row, unlooked_);
            to = std::min({row + options_.block_rows, look.until, end});
            const Block block = kept_ ? block_at(row, to, true) : make(row, to, look.now);
            if (!look.now) continue;
            if (const long sound = first_unsound(block, row, to, given, [](long) { return 1; });
                sound < to)
                return sound;
        }
        given_ = given, unlooked_ = end;
        return end;
    }

    Scheme& scheme_;
    Trace& trace_;
    const RunOptions& options_;
    Teller& teller_;
    const Looks looks_;
    const bool kept_;    // the energy, in the trace
    Look look_{};        // for the rows in the current block
    long unlooked_ = 0;  // the first row since the last look
    double given_ = 0;   // energy until then [J]
    // for the taps; finite, so that a value that is not finite is beyond
    std::vector<double> bounds_;
    // evaluated rows for which the trace keeps no energy: taps, then energy
    std::vector<double> beside_;
};
}  // namespace

long rows_of(const Scene& scene, const Settings& settings) {
    constexpr double rounding = 1e-9;
    const double intervals = scene.duration * settings.tap_rate;
    if (!(intervals > 1 - rounding))
        throw BadScene("duration", number_text(scene.duration) + " s",
                       "no less than a row, which is " + number_text(1 / settings.tap_rate) +
                           " s at this tap rate");
    if (!(intervals < most_rows))
        throw Refusal(std::to_string(scene.duration) + " s at " +
                      std::to_string(settings.tap_rate) + " rows a second: expected no more than " +
                      std::to_string(static_cast<long>(most_rows)) + " rows");
    return std::lround(intervals) + 1;
}

namespace {
Trace empty_trace(const Scene& scene, const Settings& settings, bool energy) {
    Trace trace;
    trace.tap_rate = settings.tap_rate;
    trace.stride = rows_of(scene, settings);
    for (const Tap& tap : scene.taps) trace.names.push_back(tap.name);
    trace.tap.assign(trace.stride * trace.names.size(), 0.0);
    if (energy) trace.energy.assign(trace.stride * 3, 0.0);
    return trace;
}
}  // namespace

// A scheme in continuous time has no rate: its rows count as steps.
Run run(Scheme& scheme, const Scene& scene, const Settings& settings, const RunOptions& options) {
    Run result;
    Trace& trace = result.trace = empty_trace(scene, settings, options.energy);
    result.dofs = scheme.dofs();
    const bool continuous = settings.sample_rate == 0;
    const double steps_per_row = continuous ? 1 : settings.sample_rate / settings.tap_rate;

    scheme.reset();
    const FlushDenormals flush;
    Steady::duration stepping{};
    bool reported = false;
    Teller teller(options.progress, trace.stride);
    Stepper stepper(scheme, trace, scene, modes_for(scene, settings), options, teller);
    const bool listened = options.progress || options.slow;
    int rows = listened ? 1 : options.block_rows;  // rows in the next block
    while (trace.rows < trace.stride && result.status.outcome == Outcome::ok) {
        const long before_last = trace.stride - 1 - trace.rows;
        if (options.state && before_last == 0) result.state = scheme.state();
        const bool ends_there = options.state && before_last > 0 && before_last < rows;
        const Block block = stepper.next(ends_there ? static_cast<int>(before_last) : rows);
        const auto start = Steady::now();
        result.status = stepper.advance(block);
        const auto took = Steady::now() - start;
        stepping += took;
        if (trace.rows > 0 && block.rows == options.block_rows)
            result.worst_block =
                std::max(result.worst_block, std::chrono::duration<double>(took).count());
        if (!listened) rows = options.block_rows;
        else if (took > patience) rows = std::max(1, rows / 2);
        else if (took < patience / 4) rows = std::min(options.block_rows, 2 * rows);

        teller.rethrow();
        check(result.status, std::lround(static_cast<double>(trace.rows) * steps_per_row), block,
              steps_per_row);
        const bool failed = result.status.outcome != Outcome::ok;
        long end = trace.rows + block.rows;
        if (failed) end = std::min(end, static_cast<long>(result.status.step / steps_per_row) + 1);
        trace.rows = teller.done = stepper.sound_until(block, end, failed);
        if (trace.rows < end) {
            result.status = {Outcome::diverged,
                             std::lround(static_cast<double>(trace.rows) * steps_per_row)};
            stepper.make_anew(trace.rows);
        }
        teller.block_done();
        if (options.slow && !reported && stepping > std::chrono::duration<double>(long_run) &&
            trace.rows < trace.stride) {
            reported = true;
            options.slow(trace.rows, trace.stride, facts_of(scheme));
        }
    }
    for (std::size_t k = 0; k < scene.taps.size() && trace.rows > 0; ++k)
        if (const auto force = force_of_a_corner(scene, scene.taps[k]))
            trace.tap[k * static_cast<std::size_t>(trace.stride)] = *force;
    if (!continuous) result.steps = std::lround(steps_per_row * static_cast<double>(trace.rows));
    result.wall_seconds = std::chrono::duration<double>(stepping).count();
    result.facts = facts_of(scheme);
    return result;
}

Run run(const Descriptor& descriptor, const Scene& scene, const Settings& settings,
        const RunOptions& options) {
    Settings own = settings;
    if (descriptor.clock == Clock::continuous) own.sample_rate = 0;
    return run(*make_scheme(descriptor, scene, own), scene, own, options);
}

}  // namespace jvari
