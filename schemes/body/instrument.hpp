// All strings of a scene on a body that moves, as one scheme: what body_step.hpp derives, stepped. Rows, instants and ledger are those of
// driver.hpp.
//
// Beside what a StringStep has, the string has here: inertia(), sum mu_i v_i'' of the motion without forces; pluck() [N]; momentum() = sum
// mu_i v_i' at the instant of the energy. Of three points it also has share(), the inertia that its coordinates take of the body's: sum
// mu_i^2/m_i, m_i the least mass that the energy of the scheme shows.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "schemes/body/body_step.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/scheme.hpp"
#include "schemes/several_strings.hpp"

namespace jvari {

// The taps of a scene on one of its strings, and how much of w and w' they hear beside v.
struct BodyTap : HeardTap {
    double on_w = 0, on_speed = 0;  // per m and m/s
};
std::vector<BodyTap> body_taps(const Scene&, int string, std::vector<bool>& heard_already);
void add_taps(const Block& out, int row, const std::vector<BodyTap>&, const double* of_v, double w, double speed) noexcept;

template <StringStep String, class Body>
class Instrument final : public Scheme {
public:
    Instrument(const Scene& scene, std::vector<std::unique_ptr<String>> strings, Body body, int steps_per_row)
        : body_(std::move(body)), steps_(steps_per_row) {
        std::vector<StringPoints> at;
        std::vector<bool> heard(scene.taps.size(), false);
        std::size_t taps = 0;
        for (int k = 0; k < static_cast<int>(strings.size()); ++k) {
            at.push_back(strings[k]->points());
            Part part{std::move(strings[k]), body_taps(scene, k, heard), RowForces(at.back(), Body::levels, steps_per_row),
                      at.back().count(), 0};
            if (const auto& pluck = scene.strings[k].pluck) part.finger = 1 - pluck->position / scene.strings[k].length;
            taps = std::max(taps, part.taps.size());
            parts_.push_back(std::move(part));
        }
        step_ = BodyStep(at, body_.beta(), body_.kappa(), body_.span());
        if constexpr (Body::levels == 2) {
            start_ = step_.halved();
            double taken = 0, ends = 0;
            for (const Part& p : parts_) taken += p.string->share();
            for (const StringPoints& s : at) ends += s.mass / 3;
            if (!(body_.least_mass() + ends > taken))
                throw Refusal("the body is too light at this rate: the strings take " + std::to_string(taken) + " kg of its " +
                              std::to_string(body_.least_mass() + ends) + " kg, and the energy would have no least value");
        }
        for (auto* v : {&older_, &now_, &free_, &force_}) v->assign(step_.points(), 0.0);
        tap_.assign(taps, 0.0);
        Instrument::reset();
    }

    void reset() noexcept override {
        step_.clear();
        body_.begin();
        status_ = {};
        done_ = 0;
        supplied_ = dissipated_ = 0;
        for (Part& p : parts_) {
            p.string->reset();
            p.means.clear();
        }
        std::fill(force_.begin(), force_.end(), 0.0);
        if constexpr (Body::levels == 2) {
            BodyMotion rest;
            if (!solve(start_, rest)) status_ = {Outcome::not_converged, 0};
            const double* force = force_.data();
            for (Part& p : parts_) {
                p.string->start(force, start_.a());
                force += p.points;
            }
            body_.start(start_.f());
        }
    }

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows && status_.outcome == Outcome::ok; ++row) {
            write(out, row);
            for (int i = 0; i < steps_ && status_.outcome == Outcome::ok; ++i) {
                step(out.energy != nullptr, i + 1 == steps_);
                if (out.stopped(i, steps_between_looks)) return {};
            }
        }
        return status_;
    }

    int dofs() const override {
        int sum = 2 * body_.modes();
        for (const Part& p : parts_) sum += p.string->dofs();
        return sum;
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> all;
        if (step_.contacts().contacts() > 0) all = step_.contacts().facts();
        for (std::size_t k = 0; k < parts_.size(); ++k)
            for (Fact& f : of_string(k)) all.push_back(std::move(f));
        return all;
    }

private:
    static constexpr long steps_between_looks = 64;
    struct Part {
        std::unique_ptr<String> string;
        std::vector<BodyTap> taps;
        RowForces means;
        int points;
        double finger;  // psi where the pluck acts
    };

    std::vector<Fact> of_string(std::size_t k) const {
        auto facts = parts_[k].string->facts();
        return parts_.size() > 1 ? facts_of_string(static_cast<int>(k), std::move(facts)) : facts;
    }

    bool solve(BodyStep& by, const BodyMotion& motion) noexcept {  // after approach() of every string
        double inertia = 0, *older = older_.data(), *now = now_.data(), *free = free_.data();
        pluck_ = 0;
        for (Part& p : parts_) {
            const ReadingsBeforeStep at = p.string->readings();
            std::copy_n(at.older, p.points, older);
            std::copy_n(at.now, p.points, now);
            std::copy_n(at.free, p.points, free);
            older += p.points;
            now += p.points;
            free += p.points;
            inertia += p.string->inertia();
            pluck_ += p.finger * p.string->pluck();
        }
        return by.solve(older_.data(), now_.data(), free_.data(), inertia, pluck_, motion, force_.data());
    }

    void step(bool probed, bool last_of_row) noexcept {
        for (Part& p : parts_) p.string->approach(last_of_row);
        if (!solve(step_, body_.coming())) status_ = {Outcome::not_converged, done_};
        const double* force = force_.data();
        for (Part& p : parts_) {
            p.means.count(force);
            const Spent spent = p.string->pass(force, step_.a(), probed);
            supplied_ += spent.supplied;
            dissipated_ += spent.dissipated;
            force += p.points;
            if (p.string->failed() && status_.outcome == Outcome::ok) status_ = {Outcome::diverged, done_};
        }
        const double r = body_.pass(step_.f());
        supplied_ += pluck_ * r / Body::levels;
        dissipated_ += body_.span() / Body::levels * step_.lost();
        ++done_;
    }

    void write(const Block& out, int row) noexcept {
        const double w = body_.displacement(0), speed = body_.velocity();
        double stored = 0, momentum = 0;
        const double* force = force_.data();
        for (Part& p : parts_) {
            const auto [bridge, thread] = p.means.take(force, done_ == 0);
            force += p.points;
            p.string->write({1, static_cast<int>(p.taps.size()), 1, tap_.data(), nullptr, nullptr, nullptr}, 0, bridge, thread);
            add_taps(out, row, p.taps, tap_.data(), w, speed);
            if (!out.energy) continue;
            momentum += p.string->momentum();
            stored += p.string->stored();
        }
        const double lost = body_.take_lost();
        if (out.energy) {
            stored += body_.stored() + step_.kinetic(body_.velocity_stored(), momentum);
            for (int level = 0; level < Body::levels; ++level) {
                double* reading = older_.data();
                for (Part& p : parts_) {
                    p.string->reading(level, reading);
                    reading += p.points;
                }
                stored += step_.potential(older_.data(), body_.displacement(level)) / Body::levels;
            }
            write_energy(out, row, stored, supplied_, dissipated_ + lost);
        }
        supplied_ = dissipated_ = 0;
    }

    Body body_;
    int steps_;
    std::vector<Part> parts_;
    BodyStep step_, start_;
    std::vector<double> older_, now_, free_, force_, tap_;
    double pluck_ = 0, supplied_ = 0, dissipated_ = 0;  // since the last row
    long done_ = 0;                                     // steps
    Status status_;
};

// One scheme of one string for each string of the scene; what it refuses names its string.
template <class String, class Make>  // make(scene of one string) -> std::unique_ptr<String>
std::vector<std::unique_ptr<String>> each_string(const Scene& scene, Make make) {
    std::vector<std::unique_ptr<String>> all;
    for (int k = 0; k < static_cast<int>(scene.strings.size()); ++k) all.push_back(made_of_string(scene, k, make));
    return all;
}

// The scheme of one string by a rule, or of all strings on a moving body, by the rule of discrete gradients. make as above, body() -> the
// body in the form of that scheme.
template <class String, class Rule, class Make, class MakeBody>
std::unique_ptr<Scheme> on_its_support(const Scene& scene, int steps_per_row, Make make, MakeBody body) {
    if (!needed_by(scene).has(Feature::moving_body)) return std::make_unique<Driver<String, Rule>>(make(scene), steps_per_row);
    auto strings = each_string<String>(scene, make);
    return std::make_unique<Instrument<String, decltype(body())>>(scene, std::move(strings), body(), steps_per_row);
}

}  // namespace jvari
