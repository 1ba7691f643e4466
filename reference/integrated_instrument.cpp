#include "reference/integrated_instrument.hpp"

#include <algorithm>
#include <cmath>

#include "reference/instrument_equations.hpp"
#include "reference/profile_points.hpp"
#include "reference/readout.hpp"
#include "scenes/excitation.hpp"
#include "scenes/start.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
void add_taps(const Block& out, int row, const std::vector<BodyTap>& taps, const double* of_v,
              double w, double speed) noexcept {
    for (std::size_t t = 0; t < taps.size(); ++t) {
        double& cell = out.tap[taps[t].column * out.stride + row];
        const double heard = of_v[t] + (taps[t].on_w * w + taps[t].on_speed * speed);
        cell = taps[t].first ? heard : cell + heard;
    }
}

struct Heard {  // on one string
    Readout readout;
    std::vector<BodyTap> taps;
};

class IntegratedInstrument final : public Scheme {
public:
    IntegratedInstrument(const Scene& scene, const std::vector<String>& strings,
                         std::vector<Modes> modes, double tap_rate,
                         const Integrator::Settings& integrator)
        : modes_(std::move(modes)),
          equations_(strings, modes_, scene.body->modes),
          integrator_(equations_, integrator),
          tap_rate_(tap_rate) {
        std::vector<bool> heard(scene.taps.size(), false);
        std::size_t most_taps = 0, most_modes = 0;
        for (int k = 0; k < static_cast<int>(strings.size()); ++k) {
            heard_.push_back({Readout(alone(scene, k), modes_[k]), body_taps(scene, k, heard)});
            most_taps = std::max(most_taps, heard_.back().taps.size());
            most_modes = std::max(most_modes, static_cast<std::size_t>(modes_[k].count()));
        }
        start_.resize(equations_.size());
        for (std::size_t k = 0; k < strings.size(); ++k) {
            const ModalStart start = start_of(modes_[k], strings[k]);
            const auto& s = equations_.strings[k];
            for (int i = 0; i < s.count; ++i) {
                start_[s.first + i] = modes_[k].omega0[i] * start.displacement[i];
                start_[equations_.padded + s.first + i] = start.velocity[i];
            }
        }
        seen_.assign(equations_.sums, 0.0);
        sums_ = seen_;
        tap_.assign(most_taps, 0.0);
        y_.assign(most_modes, 0.0);
        IntegratedInstrument::reset();
    }

    void reset() noexcept override {
        integrator_.reset();
        std::copy(start_.begin(), start_.end(), integrator_.state());
        std::fill(sums_.begin(), sums_.end(), 0.0);
        row_ = 0;
        events_ = 0;
        for (int a = 0; a < equations_.contacts; ++a)
            equations_.touched[a] = equations_.penetration(a, integrator_.state()) > 0;
        restart(0);
    }

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            if (!interval(out)) return {Outcome::not_converged, row_};
            ++row_;
        }
        return {};
    }

    int dofs() const override { return 2 * equations_.padded; }
    std::vector<Fact> facts() const override { return integrator_.facts(events_, false); }

private:
    void restart(double time) noexcept {  // from the state there is
        double* z = integrator_.state();
        std::fill_n(z + 2 * equations_.padded, equations_.sums, 0.0);
        std::fill(seen_.begin(), seen_.end(), 0.0);
        equations_.time = begun_ = time;
        for (auto& s : equations_.strings)
            s.plucked =
                s.pluck && time >= s.pluck->start && time < s.pluck->start + s.pluck->duration;
        integrator_.restart(1 / equations_.pace(z));
    }

    bool interval(const Block& out) noexcept {  // to the next row
        const double from = row_ / tap_rate_, to = (row_ + 1) / tap_rate_;
        int idle = 0;
        for (double at = from; at < to;) {
            double edge = HUGE_VAL;  // time at which a pluck begins, ends or has a knot
            for (const auto& s : equations_.strings)
                if (s.pluck) edge = std::min(edge, next_knot(*s.pluck, at));
            const double until = std::min(edge, to);
            const auto stop = integrator_.advance(until - begun_, out);
            if (stop == Integrator::Stop::failed || out.stopped()) return false;
            take_sums();
            const double reached = stop == Integrator::Stop::reached
                                       ? until
                                       : std::min(begun_ + integrator_.time(), until);
            idle = reached - at > 1e-15 / tap_rate_ ? 0 : idle + 1;
            if (idle > 1000) return false;
            if (stop == Integrator::Stop::crossed) {
                char& touched = equations_.touched[integrator_.crossed()];
                touched = !touched;
                ++events_;
            }
            at = reached;
            if (stop == Integrator::Stop::crossed || edge <= to) restart(at);
        }
        return true;
    }
    void take_sums() noexcept {
        const double* sum = integrator_.state() + 2 * equations_.padded;
        for (int k = 0; k < equations_.sums; ++k) {
            sums_[k] += sum[k] - seen_[k];
            seen_[k] = sum[k];
        }
    }

    void write(const Block& out, int row) noexcept {
        const double* z = integrator_.state();
        const double w = equations_.w(z), speed = equations_.w_speed(z);
        for (std::size_t k = 0; k < heard_.size(); ++k) {
            const auto& s = equations_.strings[k];
            const Heard& h = heard_[k];
            const Block own{
                1, static_cast<int>(h.taps.size()), 1, tap_.data(), nullptr, nullptr, nullptr};
            for (int i = 0; i < s.count; ++i)
                y_[i] = z[s.first + i] / equations_.omega(s.first + i);
            h.readout.write(own, 0, y_.data(), z + equations_.padded + s.first, 1,
                            sums_[s.bridge] * tap_rate_, sums_[s.thread] * tap_rate_);
            add_taps(out, row, h.taps, tap_.data(), w, speed);
        }
        if (out.energy)
            write_energy(out, row, equations_.energy(z), sums_[equations_.sums - 2],
                         sums_[equations_.sums - 1]);
        std::fill(sums_.begin(), sums_.end(), 0.0);
    }

    std::vector<Modes> modes_;
    InstrumentEquations equations_;
    Integrator integrator_;
    std::vector<Heard> heard_;
    std::vector<double> start_, tap_, y_;
    // the integrator's sums: already taken; since the last row
    std::vector<double> seen_, sums_;
    double tap_rate_;
    double begun_ = 0;  // t = 0 in the integrator's time [s]
    long row_ = 0;
    double events_ = 0;
};
}  // namespace

std::unique_ptr<Scheme> integrated_instrument(const Descriptor& descriptor, const Scene& scene,
                                              const Settings& settings,
                                              const Integrator::Settings& integrator) {
    matched_without_loss(descriptor, scene, settings);
    std::vector<Modes> modes;
    std::vector<String> strings;
    for (const String& s : scene.strings) {
        modes.push_back(modes_of(s, settings));
        strings.push_back(with_points(s, modes.back().count(), profile_points(settings)));
    }
    return std::make_unique<IntegratedInstrument>(scene, strings, std::move(modes),
                                                  settings.tap_rate, integrator);
}

}  // namespace jvari
