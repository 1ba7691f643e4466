// The reference for any contact law: an adaptive integrator with event location, and exact flight
// between contacts.
//
// Sources: string_equations.hpp (van Walstijn et al. 2016, eqs 5-22, with any exponent; Issanchou
// et al. 2016, eq 24). While no barrier is touched the motion is linear and flies exactly, its next
// contact isolated rigorously (flight.hpp); while one is, SUNDIALS integrates to a stated tolerance
// and finds the crossings (integrator.hpp). With flight = integrate, and where the string
// stretches, everything is integrated, by steps short enough for root finding to see contacts,
// which is a belief and not a bound: the option is there to be compared with, because exact_contact
// flies by the same code.
// On a body that moves there is no exact flight: all strings are integrated together
// (integrated_instrument.hpp). A profile acts as the points of profile_points.hpp. Leaves out:
// polarisation.
#include <algorithm>
#include <cmath>

#include "reference/exact/flight.hpp"
#include "reference/integrated_instrument.hpp"
#include "reference/integrator.hpp"
#include "reference/masses.hpp"
#include "reference/pluck_parts.hpp"
#include "reference/profile_points.hpp"
#include "reference/readout.hpp"
#include "reference/references.hpp"
#include "reference/string_equations.hpp"
#include "scenes/start.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

namespace {
struct Choice {
    Integrator::Settings integrator;
    bool exact_flight;
};

class IntegratedContact final : public Scheme {
public:
    IntegratedContact(const String& s, const Scene& scene, const Modes& modes, double tap_rate,
                      const Choice& choice, const std::optional<InSeries>& series)
        : modes_(with_masses(modes, s)),
          equations_(modes_, s, series),
          flight_(modes_, s, 1 / tap_rate, series),
          integrator_(equations_, choice.integrator),
          readout_(scene, modes_),
          choice_(choice),
          parts_(s.pluck),
          tap_rate_(tap_rate),
          interval_(flight_.window.osc.rate / tap_rate) {
        if (s.pluck) pluck_.push_back(*s.pluck);
        ModalStart start = with_masses(
            start_of(modes, s, series ? Yield{{}, series->C.C, series->C.pluck} : Yield{}), modes,
            s);
        for (double& v : start.velocity) v /= flight_.window.osc.rate;
        start_ = flight_.window.osc.pad(start.displacement);
        start_u_ = flight_.window.osc.pad(start.velocity);
        if (series) start_z_ = series->resting(start.force);
        untouched_.assign(equations_.contacts + 1, 0);
        falling_ = falling(modes_, s);
        y_ = u_ = start_;
        reset();
    }
    void reset() noexcept override {
        std::copy(start_.begin(), start_.end(), y_.begin());
        std::copy(start_u_.begin(), start_u_.end(), u_.begin());
        std::fill(equations_.touched.begin(), equations_.touched.end(), 0);
        flight_.reset();
        std::copy(start_z_.begin(), start_z_.end(), flight_.z.begin());
        integrator_.reset();
        readout_.begin(u_.data(), flight_.window.osc.rate, tap_rate_);
        row_ = idle_ = 0;
        leaving_ = -1;
        running_ = false;
        sums_ = {};
        events_ = 0;
        // the exact flight finds the touched barriers from the start
        if (choice_.exact_flight) return;
        start(false, 0);
        for (int a = 0; a < equations_.contacts; ++a)
            equations_.touched[a] = equations_.penetration(a, integrator_.state()) > 0;
        running_ = false;
    }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            readout_.write(out, row, y_.data(), u_.data(), flight_.window.osc.rate,
                           sums_.bridge * tap_rate_, sums_.thread * tap_rate_);
            if (series()) add_series(out, row, *series(), flight_.z.data(), 0);
            if (out.energy)
                write_energy(out, row, stored(), sums_.energies.supplied,
                             sums_.energies.dissipated);
            if (!interval(out)) return {Outcome::not_converged, row_};
            ++row_;
        }
        return {};
    }
    int dofs() const override { return 2 * modes_.count(); }
    ModalState state() const override {
        return series() || readout_.masses() > 0
                   ? ModalState{}
                   : state_of(y_, u_, modes_.count(), flight_.window.osc.rate);
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> all = integrator_.facts(events_, true);
        if (choice_.exact_flight) all.push_back({facts::detection_tolerance, flight_.tolerance()});
        return all;
    }

private:
    // to the next row
    bool interval(const Block& out) noexcept {
        sums_ = {};
        return parts_.each(row_ / tap_rate_, interval_, 1 / flight_.window.osc.rate,
                           [&](double from, double to, bool plucked) {
                               // lines from a file meet at an angle
                               if (plucked && !pluck_[0].time.empty()) running_ = false;
                               return stretch(from, to, plucked, out);
                           });
    }
    // within one interval
    bool stretch(double from, double to, bool plucked, const Block& out) noexcept {
        const double nothing = 1e-15 * interval_;  // the library cannot step so little
        for (double at = from; to - at > nothing;) {
            const double left = to - at;
            const double since_pluck = plucked ? std::max(0.0, row_ / tap_rate_ - pluck_[0].start +
                                                                   at / flight_.window.osc.rate)
                                               : 0;
            double step;
            if (exact_flight()) {
                const auto landing = flight_.fly(left, plucked, since_pluck, leaving_, y_.data(),
                                                 u_.data(), sums_, out.energy != nullptr);
                step = landing.length;
                leaving_ = -1;
                if (landing.contact >= 0) toggle(landing.contact);
            } else step = integrate(left, plucked, since_pluck, out);
            if (!(step >= 0) || out.stopped()) return false;
            idle_ = step > nothing ? 0 : idle_ + 1;
            if (idle_ > 1000) return false;
            at = step == left ? to : at + step;
        }
        return true;
    }
    // no further than the next crossing; how far [1/rate]
    double integrate(double left, bool plucked, double since_pluck, const Block& out) noexcept {
        if (!running_ || plucked != equations_.plucked) start(plucked, since_pluck);
        const double before = integrator_.time();
        const auto stop = integrator_.advance(before + left / flight_.window.osc.rate, out);
        if (stop == Integrator::Stop::failed) return -1;
        const double* z = integrator_.state();
        for (int i = 0; i < modes_.count(); ++i) {
            y_[i] = z[i] / equations_.scale(i);
            u_[i] = z[equations_.padded + i] / flight_.window.osc.rate;
        }
        equations_.read_series(z, flight_.z.data());
        const double* sum = z + 2 * equations_.padded;
        double since[StringEquations::sums];
        for (int k = 0; k < StringEquations::sums; ++k) {
            since[k] = sum[k] - seen_[k];
            seen_[k] = sum[k];
        }
        sums_.bridge += since[StringEquations::bridge_impulse];
        sums_.thread += since[StringEquations::thread_impulse];
        sums_.energies.supplied += since[StringEquations::supplied];
        sums_.energies.dissipated += since[StringEquations::dissipated];
        if (stop == Integrator::Stop::reached) return left;
        toggle(integrator_.crossed());
        return std::min((integrator_.time() - before) * flight_.window.osc.rate, left);
    }
    // y, u -> the integrator's state
    void start(bool plucked, double since_pluck) noexcept {
        double* z = integrator_.state();
        std::fill_n(z, equations_.size(), 0.0);
        for (int i = 0; i < modes_.count(); ++i) {
            z[i] = equations_.scale(i) * y_[i];
            z[equations_.padded + i] = flight_.window.osc.rate * u_[i];
        }
        equations_.put_series(flight_.z.data(), z);
        std::fill(std::begin(seen_), std::end(seen_), 0.0);
        equations_.plucked = plucked;
        equations_.pluck_time = since_pluck;
        const double longest_step = choice_.exact_flight ? 3 : 1;
        // BDF takes stiff decays in long steps
        integrator_.restart(longest_step / pace(choice_.integrator.method == Method::adams));
        running_ = true;
    }
    void toggle(int contact) noexcept {
        char& touched = equations_.touched[contact];
        touched = !touched;
        leaving_ = touched ? -1 : contact;
        running_ = false;
        ++events_;
    }
    // rate of the fastest motion [1/s]; decays: including a contact in series
    double pace(bool decays) noexcept {
        return std::max(flight_.window.springs.growth(untouched_.data()) * flight_.window.osc.rate,
                        equations_.pace(integrator_.state(), decays));
    }
    double stored() const noexcept {
        double kinetic = 0, energy = 0, reach = 0;
        for (int i = 0; i < modes_.count(); ++i) {
            const double v = flight_.window.osc.rate * u_[i], p = modes_.omega0[i] * y_[i];
            kinetic += v * v + p * p;
            reach += equations_.reach(i) * p * p;
            kinetic -= 2 * falling_[i] * y_[i] / modes_.mass;
        }
        energy = 0.5 * modes_.mass * kinetic + equations_.stretching(reach);
        if (series()) energy += series()->stored(flight_.z.data());
        for (int a = 0; a < equations_.points; ++a) {
            const double* g = flight_.window.springs.weights.data() +
                              static_cast<long>(a) * flight_.window.osc.padded;
            double y = series() ? flight_.z[a] : 0;
            for (int i = 0; i < modes_.count(); ++i) y += g[i] * y_[i];
            energy += equations_.potential(a, y);
        }
        return energy;
    }
    const std::optional<InSeries>& series() const noexcept { return flight_.window.series(); }
    bool exact_flight() const noexcept {
        return choice_.exact_flight &&
               std::find(equations_.touched.begin(), equations_.touched.end(), 1) ==
                   equations_.touched.end();
    }

    Modes modes_;
    StringEquations equations_;
    Flight flight_;
    Integrator integrator_;
    Readout readout_;
    Choice choice_;
    std::vector<Pluck> pluck_;  // none or one
    PluckParts parts_;
    double tap_rate_, interval_;
    std::vector<double> start_, start_u_, start_z_, falling_;
    std::vector<char> untouched_;

    std::vector<double> y_, u_;
    long row_ = 0;
    int leaving_ = -1;  // the barrier just left
    int idle_ = 0;
    Flight::Sums sums_;
    bool running_ = false;                     // true if the integrator's state is the present one
    double seen_[StringEquations::sums] = {};  // the integrator's sums already taken by sums_
    double events_ = 0;
};

constexpr Option method_option{
    "method", "adams", "multistep method of the integrator", {"bdf", "adams"}};
constexpr Option rtol_option{"rtol", "1e-13", "relative tolerance below 1"};
constexpr Option flight_option{"flight",
                               "exact",
                               "motion between contacts: exact, or integrated like the rest",
                               {"exact", "integrate"}};
constexpr Option options[] = {method_option, rtol_option, flight_option, nodes_option,
                              compliance_option};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    const Features needed = needed_by(scene);
    const bool moves = needed.has(Feature::moving_body),
               stretches = needed.has(Feature::tension_modulation);
    if (moves && stretches)
        throw Refusal(std::string(descriptor.name) + ": a string that stretches ends at rest");
    Choice choice;
    choice.exact_flight = choice_option(settings, flight_option) == "exact" && !stretches;
    Integrator::Settings& i = choice.integrator;
    i.method = choice_option(settings, method_option) == "bdf" ? Method::bdf : Method::adams;
    i.tolerance = number_option(settings, rtol_option);
    if (!(i.tolerance > 0 && i.tolerance < 1))
        throw Refusal("option rtol: expected a tolerance between 0 and 1");
    Settings unsampled = settings;
    unsampled.sample_rate = 0;
    if (moves) return integrated_instrument(descriptor, scene, unsampled, i);
    const Modes modes = modes_of(scene.strings.at(0), unsampled);
    const auto series = in_series(descriptor, scene, modes, settings);
    if (series && scene.strings.front().pluck)
        throw Refusal(
            std::string(descriptor.name) +
            ": compliance=matched takes strings that are released; exact_contact takes a pluck");
    const String s = with_points(scene.strings.at(0), modes.count(), profile_points(settings));
    return std::make_unique<IntegratedContact>(s, scene, modes, settings.tap_rate, choice, series);
}

}  // namespace

const Descriptor sundials = {
    .name = "sundials",
    .source =
        "modal equations of van Walstijn et al. 2016, eqs 5-22, by SUNDIALS with event location",
    .represents = modal_features_of_points | Feature::moving_body | Feature::tension_modulation |
                  Feature::clipped_loss | Feature::free_mass | Feature::weighed_mass |
                  Feature::barrier_above,
    .balance = Balance::to_tolerance,
    .clock = Clock::continuous,
    .make = make,
    .options = options,
    .approximates = points_for_a_profile,
    .confirmation = [](const Scene&) {
        return Confirmation{{{}},
                            {{{rtol_option.name, "1e-14"}},
                             {{method_option.name, "bdf"}, {rtol_option.name, "1e-14"}}}};
    }};

}  // namespace jvari
