// Steps all strings of a scene on a moving body together, in the form of one string for the driver
// (driver/string_step.hpp). body_step.hpp derives the equations.
//
// Each string here has three functions beside the StringStep ones: inertia(), sum mu_i v_i'' for
// the motion without forces; pluck() [N]; momentum() = sum mu_i v_i' at the instant of the energy.
// A string with three points also has share(), the inertia that its coordinates take from the body:
// sum mu_i^2/m_i, with m_i the least mass that the scheme's energy shows.
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

// Taps on one string, and the weights with which they hear w and w' beside v.
struct BodyTap : HeardTap {
    double on_w = 0, on_speed = 0;  // per m and m/s
};
std::vector<BodyTap> body_taps(const Scene&, int string, std::vector<bool>& heard_already);

template <StringStep String, class Body>
class Instrument {
public:
    static constexpr int levels = Body::levels;
    static constexpr long steps_between_looks = String::steps_between_looks;

    Instrument(const Scene& scene, std::vector<std::unique_ptr<String>> strings, Body body)
        : body_(std::move(body)) {
        std::vector<StringPoints> of_strings;
        std::vector<std::vector<int>> place;
        std::vector<bool> heard(scene.taps.size(), false);
        heard_.resize(scene.taps.size());
        for (int k = 0; k < static_cast<int>(strings.size()); ++k) {
            of_strings.push_back(strings[k]->points());
            const auto& pluck = scene.strings[k].pluck;
            const std::vector<BodyTap> taps = body_taps(scene, k, heard);
            for (int t = 0; t < static_cast<int>(taps.size()); ++t)
                heard_[taps[t].column].push_back({k, t, taps[t]});
            parts_.push_back({std::move(strings[k]),
                              {},
                              std::vector<double>(of_strings.back().count()),
                              pluck ? 1 - pluck->position / scene.strings[k].length : 0});
        }
        gather_points(of_strings);
        for (const Part& p : parts_) place.push_back(p.place);
        step_ = BodyStep(of_strings, place, body_.beta(), body_.kappa());
        points_.theta = step_.theta();
        if constexpr (levels == 2) {
            refuse_light(of_strings);
            for (StringPoints& s : of_strings)
                for (double& theta : s.theta) theta *= 0.5;
            start_ = BodyStep(of_strings, place, 0.5 * body_.beta(), 0.5 * body_.kappa());
            points_.start_theta = start_.theta();
        }
        for (auto* v : {&older_, &now_, &free_}) v->assign(points_.count(), 0.0);
    }

    const StringPoints& points() const { return points_; }
    ThreadStart thread_start() const { return ThreadStart::plain; }
    ReadingsBeforeStep readings() const { return {older_.data(), now_.data(), free_.data()}; }

    void reset() noexcept {
        for (Part& p : parts_) p.string->reset();
        body_.begin();
        if constexpr (levels == 2) gather(start_, {});
    }
    void start(const double* force, double) noexcept {
        start_.pass(force);
        for (Part& p : parts_) p.string->start(own(p, force), start_.a());
        body_.start(start_.f());
    }
    void approach(bool last_of_row) noexcept {
        for (Part& p : parts_) p.string->approach(last_of_row);
        gather(step_, body_.coming());
    }
    Spent pass(const double* force, double, bool probed) noexcept {
        Spent all;
        step_.pass(force);
        for (Part& p : parts_) {
            const Spent spent = p.string->pass(own(p, force), step_.a(), probed);
            all.supplied += spent.supplied;
            all.dissipated += spent.dissipated;
        }
        const BodyMoved moved = body_.pass(step_.f());
        all.supplied += pluck_ * moved.r / levels;
        all.dissipated += moved.lost;
        return all;
    }
    bool failed() const {
        return std::any_of(parts_.begin(), parts_.end(),
                           [](const Part& p) { return p.string->failed(); });
    }

    void reading(int level, double* out) noexcept {
        const double w = body_.displacement(level);
        for (Part& p : parts_) {
            p.string->reading(level, p.own.data());
            for (std::size_t k = 0; k < p.own.size(); ++k)
                out[p.place[k]] = p.own[k] + step_.rides(p.place[k]) * w;
        }
    }
    double stored() noexcept {
        double sum = body_.stored(), momentum = 0;
        for (Part& p : parts_) {
            sum += p.string->stored();
            momentum += p.string->momentum();
        }
        for (int level = 0; level < levels; ++level)
            sum += step_.potential(body_.displacement(level)) / levels;
        return sum + step_.kinetic(body_.velocity_stored(), momentum);
    }
    double tap(int k, const double* mean) noexcept {
        double sum = 0;
        for (const Heard& h : heard_[k]) {
            Part& p = parts_[h.part];
            sum += p.string->tap(h.tap, own(p, mean)) +
                   (h.by.on_w * body_.displacement(0) + h.by.on_speed * body_.velocity());
        }
        return sum;
    }

    int dofs() const {
        int sum = 2 * body_.modes();
        for (const Part& p : parts_) sum += p.string->dofs();
        return sum;
    }
    std::vector<Fact> facts() const {
        std::vector<Fact> all;
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            auto facts = parts_[k].string->facts();
            if (parts_.size() > 1) facts = facts_of_string(static_cast<int>(k), std::move(facts));
            all.insert(all.end(), facts.begin(), facts.end());
        }
        return all;
    }
    std::vector<FreeMode> free_modes() const { return {}; }

private:
    struct Part {
        std::unique_ptr<String> string;
        std::vector<int> place;   // index of each point among all points
        std::vector<double> own;  // workspace: the part for this string's points alone
        double finger;            // psi at the pluck's position
    };
    struct Heard {  // a tap in the scene, on one string
        int part, tap;
        BodyTap by;
    };

    void gather_points(const std::vector<StringPoints>& of_strings) {
        points_.dt = of_strings.front().dt;
        const auto place = [&](std::size_t k, std::size_t p) {
            parts_[k].place.push_back(points_.count());
            points_.positions.push_back(of_strings[k].positions[p]);
        };
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            points_.contacts.add(of_strings[k].contacts, static_cast<int>(k));
            for (int a = 0; a < of_strings[k].contacts.count(); ++a) place(k, a);
        }
        for (std::size_t k = 0; k < parts_.size(); ++k)
            for (const Thread& thread : of_strings[k].threads) {
                points_.threads.push_back(thread);
                place(k, of_strings[k].contacts.count());
            }
        points_.start_velocity.assign(points_.count(), 0.0);
        for (std::size_t k = 0; k < parts_.size(); ++k)
            for (std::size_t p = 0; p < of_strings[k].start_velocity.size(); ++p)
                points_.start_velocity[parts_[k].place[p]] = of_strings[k].start_velocity[p];
    }
    void refuse_light(const std::vector<StringPoints>& of_strings) const {
        double taken = 0, ends = 0;
        for (const Part& p : parts_) taken += p.string->share();
        for (const StringPoints& s : of_strings) ends += s.mass / 3;
        if (!(body_.least_mass() + ends > taken))
            throw Refusal("the body is too light at this rate: the strings take " +
                          std::to_string(taken) + " kg of its " +
                          std::to_string(body_.least_mass() + ends) +
                          " kg, and the energy would have no least value");
    }

    const double* own(Part& p, const double* all) noexcept {
        for (std::size_t k = 0; k < p.own.size(); ++k) p.own[k] = all[p.place[k]];
        return p.own.data();
    }
    // Call this after the free motion of every string.
    void gather(BodyStep& by, const BodyMotion& motion) noexcept {
        double inertia = 0;
        pluck_ = 0;
        for (Part& p : parts_) {
            const ReadingsBeforeStep at = p.string->readings();
            for (std::size_t k = 0; k < p.place.size(); ++k) {
                older_[p.place[k]] = at.older[k];
                now_[p.place[k]] = at.now[k];
                free_[p.place[k]] = at.free[k];
            }
            inertia += p.string->inertia();
            pluck_ += p.finger * p.string->pluck();
        }
        by.approach(inertia, pluck_, motion, older_.data(), now_.data(), free_.data());
    }

    Body body_;
    std::vector<Part> parts_;
    std::vector<std::vector<Heard>> heard_;  // for each tap of the scene
    StringPoints points_;
    BodyStep step_, start_;
    std::vector<double> older_, now_, free_;
    double pluck_ = 0;  // for the step: sum psi(x_e) F_e [N]
};

// Makes a single-string scheme for each string in the scene; a refusal names its string.
template <class String, class Make>  // make(single-string scene) -> std::unique_ptr<String>
std::vector<std::unique_ptr<String>> each_string(const Scene& scene, Make make) {
    std::vector<std::unique_ptr<String>> all;
    for (int k = 0; k < static_cast<int>(scene.strings.size()); ++k)
        all.push_back(made_of_string(scene, k, make));
    return all;
}

// Makes the scheme for one string by a rule, or for all strings on a moving body. `make` is the
// same function; body() returns the body in the scheme's own form.
template <class String, class Make, class MakeBody>
std::unique_ptr<Scheme> on_its_support(const Descriptor& scheme, const Scene& scene,
                                       const Settings& settings, const RuleChoice& rule, Make make,
                                       MakeBody body) {
    using All = Instrument<String, decltype(body())>;
    if (needed_by(scene).has(Feature::moving_body))
        return driven(std::make_unique<All>(scene, each_string<String>(scene, make), body()),
                      scheme, settings, rule);
    return driven(make(scene), scheme, settings, rule);
}

}  // namespace jvari
