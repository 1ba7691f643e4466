// Wraps FFTW, which no other file includes. Its plans are estimated, not measured: the same signal
// gives the same bits in each run.
#include "analysis/convolution.hpp"
#include "analysis/squared_transform.hpp"

#include <fftw3.h>

#include <algorithm>
#include <stdexcept>

namespace jvari {

namespace {
[[maybe_unused]] const bool planner_locks_itself = (fftw_make_planner_thread_safe(), true);

struct Free {
    void operator()(void* p) const { fftw_free(p); }
};
using Rows = std::unique_ptr<double[], Free>;
using Spectrum = std::unique_ptr<fftw_complex[], Free>;

Spectrum silent_spectrum(int bins) {
    Spectrum s(fftw_alloc_complex(bins));
    std::fill_n(&s[0][0], 2 * bins, 0.0);
    return s;
}
}  // namespace

struct Convolution::State {
    State(std::span<const double> response, int rows)
        : block(rows), bins(rows + 1), now(fftw_alloc_real(2 * rows)), sum(silent_spectrum(bins)) {
        forward = fftw_plan_dft_r2c_1d(2 * block, now.get(), sum.get(), FFTW_ESTIMATE);
        back = fftw_plan_dft_c2r_1d(2 * block, sum.get(), now.get(), FFTW_ESTIMATE);
        for (std::size_t from = 0; from < response.size(); from += block) {
            const auto part =
                response.subspan(from, std::min<std::size_t>(block, response.size() - from));
            std::fill(std::copy(part.begin(), part.end(), now.get()), now.get() + 2 * block, 0.0);
            responses.push_back(silent_spectrum(bins));
            fftw_execute_dft_r2c(forward, now.get(), responses.back().get());
            inputs.push_back(silent_spectrum(bins));
        }
        last.assign(block, 0.0);
    }
    ~State() {
        fftw_destroy_plan(forward);
        fftw_destroy_plan(back);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // sum = the product of the p-th last input's spectrum with the p-th part's, over all p.
    void multiply() {
        std::fill_n(&sum[0][0], 2 * bins, 0.0);
        for (std::size_t p = 0; p < responses.size(); ++p) {
            const fftw_complex *x = inputs[(newest + inputs.size() - p) % inputs.size()].get(),
                               *h = responses[p].get();
            for (int k = 0; k < bins; ++k) {
                sum[k][0] += x[k][0] * h[k][0] - x[k][1] * h[k][1];
                sum[k][1] += x[k][0] * h[k][1] + x[k][1] * h[k][0];
            }
        }
    }

    int block, bins;
    Rows now;  // two blocks: the previous and the current one, then their convolution
    Spectrum sum;
    fftw_plan forward, back;
    // by partition; a ring with the spectra of the last inputs
    std::vector<Spectrum> responses, inputs;
    std::size_t newest = 0;
    std::vector<double> last;  // the last block
};

Convolution::Convolution(std::span<const double> response, int block) {
    if (response.empty() || block < 1)
        throw std::invalid_argument(
            "convolution: expected a response and a block of at least one row each");
    state_ = std::make_unique<State>(response, block);
}
Convolution::~Convolution() = default;
Convolution::Convolution(Convolution&&) noexcept = default;

int Convolution::block() const { return state_->block; }

void Convolution::advance(std::span<const double> in, std::span<double> out) {
    State& s = *state_;
    std::copy(s.last.begin(), s.last.end(), s.now.get());
    std::copy_n(in.begin(), s.block, s.now.get() + s.block);
    std::copy_n(in.begin(), s.block, s.last.begin());
    s.newest = (s.newest + 1) % s.inputs.size();
    fftw_execute_dft_r2c(s.forward, s.now.get(), s.inputs[s.newest].get());
    s.multiply();
    fftw_execute(s.back);
    for (int n = 0; n < s.block; ++n) out[n] = s.now[s.block + n] / (2 * s.block);
}

void Convolution::reset() {
    for (Spectrum& x : state_->inputs) std::fill_n(&x[0][0], 2 * state_->bins, 0.0);
    std::ranges::fill(state_->last, 0.0);
}

std::vector<double> convolved(std::span<const double> signal, std::span<const double> response) {
    constexpr int block = 512;
    Convolution convolution(response, block);
    std::vector<double> out(signal.begin(), signal.end());
    out.resize((signal.size() + block - 1) / block * block, 0.0);
    for (std::size_t n = 0; n < out.size(); n += block) {
        const auto rows = std::span(out).subspan(n, block);
        convolution.advance(rows, rows);
    }
    out.resize(signal.size());
    return out;
}

struct SquaredTransform::State {
    explicit State(int rows) : n(rows), in(fftw_alloc_real(n)), out(fftw_alloc_complex(n / 2 + 1)) {
        plan = fftw_plan_dft_r2c_1d(n, in.get(), out.get(), FFTW_ESTIMATE);
    }
    ~State() { fftw_destroy_plan(plan); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    int n;
    std::unique_ptr<double, Free> in;
    std::unique_ptr<fftw_complex, Free> out;
    fftw_plan plan = nullptr;
};

SquaredTransform::SquaredTransform(int rows) : state_(std::make_unique<State>(rows)) {}
SquaredTransform::~SquaredTransform() = default;

std::span<double> SquaredTransform::rows() {
    return {state_->in.get(), static_cast<std::size_t>(state_->n)};
}

void SquaredTransform::write(double* power) {
    fftw_execute(state_->plan);
    for (int k = 0; k <= state_->n / 2; ++k) {
        const double re = state_->out.get()[k][0], im = state_->out.get()[k][1];
        power[k] = re * re + im * im;
    }
}

}  // namespace jvari
