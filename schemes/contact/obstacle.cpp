#include "schemes/contact/obstacle.hpp"

namespace jvari {

namespace {
std::vector<double> with_series(std::span<const double> theta, const std::optional<Residual>& z) {
    std::vector<double> all(theta.begin(), theta.end());
    for (std::size_t i = 0; z && i < all.size(); ++i) all[i] += z->K(i);
    return all;
}
}  // namespace

Obstacle::Obstacle(const Contacts& contacts, std::vector<Thread> threads,
                   std::span<const double> theta, double span, int levels, const MakeRule& make,
                   const MissingMatrix* series)
    : Obstacle(contacts, std::move(threads), theta, span, levels, levels, make, series) {}

Obstacle::Obstacle(const Contacts& contacts, std::vector<Thread> threads,
                   std::span<const double> theta, double span, int levels, int levels_of_series,
                   const MakeRule& make, const MissingMatrix* series)
    : contacts_(contacts), span_(span), levels_(levels) {
    if (series) series_.emplace(*series, span, levels_of_series);
    theta_ = with_series(theta, series_);
    threads_ = EliminatedThreads(std::move(threads), contacts.count(), theta_, span);
    const std::vector<double> between = threads_.between_contacts(theta_);
    rule_ = make(contacts.laws, between, levels);
    between_ = between;
    std::vector<StepLoss> losses;
    for (int a = 0; a < contacts.count(); ++a)
        losses.push_back({contacts.loss[a] / span, contacts.loss_law[a] == LossLaw::clipped});
    const bool loses =
        std::any_of(losses.begin(), losses.end(), [](const StepLoss& l) { return l.kappa != 0; });
    if (loses) rule_->lose(losses);
    centred_ = rule_->centred();
    one_.contact = contacts.count() == 1;
    one_.thread = threads_.count() == 1;
    fused_ = threads_.count() <= 1 &&
             (contacts.count() == 0 ||
              (one_.contact && contacts.loss[0] == 0 && rule_->is_discrete_gradient()));
    if (one_.contact) {
        one_.law = contacts.laws[0];
        one_.height = contacts.heights[0];
        one_.theta = between[0];
    }
    one_.of_thread = threads_.one();
    const bool linear = std::all_of(contacts.laws.begin(), contacts.laws.end(),
                                    [](const ContactLaw& l) { return l.alpha == 1 && !l.rigid(); });
    if (levels == 1 && contacts.count() > 1 && points() <= FewContacts::most &&
        threads_.count() <= 1 && linear && !loses && rule_->is_discrete_gradient())
        few_.emplace(contacts.laws, between);
    for (auto* v : {&eta_, &now_, &b_, &r_, &gained_}) v->assign(contacts.count(), 0.0);
    for (auto* v : {&pull_, &from_}) v->assign(threads_.count(), 0.0);
    for (auto* v : {&older_points_, &now_points_, &free_points_}) v->assign(points(), 0.0);
}

Obstacle Obstacle::halved(ThreadStart how, std::span<const double> theta,
                          const MissingMatrix* series) const {
    Contacts elastic = contacts_;
    std::fill(elastic.loss.begin(), elastic.loss.end(), 0.0);
    std::vector<Thread> threads = threads_.laws();
    for (Thread& thread : threads)
        // so that phi = k
        if (how == ThreadStart::taut) thread.damping = 0.25 * thread.stiffness * span_;
    const MakeRule same = [this](auto&&...) { return rule_; };
    return {elastic, std::move(threads), theta, 0.5 * span_, levels_, 1, same, series};
}

void Obstacle::begin(const double* reading, const double* moving, const double* force) {
    if (series_) series_->rest(force);
    for (int a = 0; a < contacts(); ++a)
        eta_[a] = contacts_.heights[a] - (reading[a] + (series_ ? series_->yields(0)[a] : 0));
    rule_->set(between_);
    rule_->begin(eta_.data(), moving);
}

void Obstacle::set(std::span<const double> theta) noexcept {
    rule_->set(theta);
    one_.theta = theta.empty() ? 0 : theta[0];
    few_.reset();
}

void Obstacle::follow(const Obstacle& first) {
    rule_->set(between_);
    one_.tally = first.one_.tally;
    if (series_) series_->follow(*first.series_);
}

// Penetration eta on the level on which the rule centres the step (obstacle_rule.hpp). thread:
// force in the first thread.
double Obstacle::centre(int a, const ReadingsBeforeStep& at, double b, double thread) const {
    const double now = contacts_.heights[a] - at.now[a];
    if (!centred_) return now;
    if (!series_) return levels_ == 1 ? now + 0.5 * b : now;
    if (threads_.count() == 0) return now;
    const double K = series_->K(static_cast<std::size_t>(a) * points() + contacts());
    return now - (K + 0.5 * (threads_.coupling(a, 0) - K)) * thread;
}

GramSolution Obstacle::solve_contacts(const BeforeStep& before, double* force,
                                      bool at_start) noexcept {
    if (at_start) return rule_->start(before, r_.data(), force);
    if (few_)  // to the bits of the kernels' whole steps
        if (const int iterations = few_->solve(before.older, before.b, r_.data(), force);
            iterations >= 0)
            return {iterations, 0, true};
    return rule_->solve(before, r_.data(), force);
}

bool Obstacle::solve_points(const ReadingsBeforeStep& at, double* force, bool at_start,
                            bool in_full) noexcept {
    const int n = contacts(), m = threads_.count();
    lost_by_rule_ = 0;
    threads_.alone(at.older, at.free, pull_.data());
    for (int a = 0; a < n; ++a) {
        eta_[a] = contacts_.heights[a] - at.older[a];
        b_[a] = -at.free[a];
        for (int t = 0; t < m; ++t) b_[a] -= threads_.coupling(a, t) * pull_[t];
        now_[a] = centre(a, at, b_[a], m > 0 ? pull_[0] : 0);
    }
    const BeforeStep before{eta_.data(), now_.data(), b_.data()};
    bool converged = true;
    for (int a = 0; in_full && a < n; ++a) gained_[a] = -held_by(a, eta_[a]);
    if (rule_->acts(before)) {
        const GramSolution s = solve_contacts(before, force, at_start);
        converged = s.converged;
        for (int a = 0; a < n; ++a) {
            for (int t = 0; t < m; ++t) pull_[t] -= threads_.answer(t, a) * force[a];
            one_.tally.note(force[a], std::max(contacts_.heights[a] - at.now[a], eta_[a] - r_[a]));
        }
        one_.tally.note(s.iterations, s.residual);
        lost_by_rule_ = rule_->lost();
    } else {
        for (int a = 0; a < n; ++a) force[a] = 0, r_[a] = -b_[a];
    }
    for (int a = 0; in_full && a < n; ++a) gained_[a] += held_by(a, eta_[a] - r_[a]);
    for (int t = 0; t < m; ++t) force[n + t] = pull_[t], from_[t] = at.older[n + t];
    return converged;
}

// Points touch at the level to which the series spring has yielded; (6) is the same equation.
bool Obstacle::solve_in_series(const ReadingsBeforeStep& at, double* force, bool in_full) noexcept {
    const int n = points();
    for (int p = 0; p < n; ++p) {
        older_points_[p] = at.older[p] + series_->yields(0)[p];
        now_points_[p] = at.now[p] + series_->yields(series_->centre())[p];
        free_points_[p] = at.free[p] - series_->pulled()[p];
    }
    const ReadingsBeforeStep there{older_points_.data(), now_points_.data(), free_points_.data()};
    const bool converged =
        fused_ && !in_full ? solve_one(there, force) : solve_points(there, force, false, in_full);
    series_->step(force);
    return converged;
}

double Obstacle::potential(const double* reading, int level) const {
    double sum = series_ ? series_->stored(level) : 0;
    const auto at = [&](int p) { return reading[p] + (series_ ? series_->yields(level)[p] : 0); };
    for (int a = 0; a < contacts(); ++a) sum += rule_->potential(a, contacts_.heights[a] - at(a));
    for (int t = 0; t < threads_.count(); ++t) sum += threads_.stored(t, at(contacts() + t));
    return sum;
}

double Obstacle::loss() const {
    double power = ((series_ ? series_->lost() : 0) + levels_ * lost_by_rule_) / span_;
    for (int t = 0; t < threads_.count(); ++t)
        power += threads_.lost(t, threads_.moved(t, from_[t], pull_[t]));
    return power;
}

std::vector<Fact> Obstacle::facts() const {
    const ContactTally& tally = one_.tally;
    std::vector<Fact> f = {{facts::contact_points, static_cast<double>(contacts())},
                           {facts::smallest_contact_force, tally.force.least},
                           {facts::largest_contact_force, tally.force.most},
                           {facts::deepest_penetration, tally.deepest}};
    if (rule_->iterates()) {
        const double solves = static_cast<double>(tally.solves);
        f.push_back({facts::contact_solves, solves});
        f.push_back({facts::contact_iterations_mean,
                     solves > 0 ? static_cast<double>(tally.iterations) / solves : 0});
        f.push_back({facts::contact_iterations_most, static_cast<double>(tally.most_iterations)});
        f.push_back({facts::contact_residual, tally.residual});
    }
    for (Fact& fact : rule_->facts()) f.push_back(std::move(fact));
    return f;
}

}  // namespace jvari
