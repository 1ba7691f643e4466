#include "schemes/contact/eliminated_thread.hpp"

#include "schemes/decompositions.hpp"

namespace jvari {

EliminatedThreads::EliminatedThreads(std::vector<Thread> threads, int contacts,
                                     std::span<const double> theta, double span)
    : laws_(std::move(threads)), contacts_(contacts), span_(span) {
    const int n = contacts, m = count(), all = n + m;
    if (m == 0) return;
    for (const Thread& t : laws_) phi_.push_back(0.5 * t.stiffness + t.damping / span);
    // Round only once: a rounding error here would enter the balance in every step with the same
    // sign.
    const auto pull = [&](int t, int point) {
        return static_cast<long double>(phi_[t]) * theta[(n + t) * all + point];
    };
    std::vector<long double> give;
    for (int t = 0; t < m; ++t)
        for (int u = 0; u < m; ++u) give.push_back((t == u ? 1 : 0) + pull(t, n + u));
    const std::vector<long double> inverse = inverse_of(give, m);
    for (int t = 0; t < m; ++t) {
        for (int u = 0; u < m; ++u) inverse_.push_back(static_cast<double>(inverse[t * m + u]));
        for (int a = 0; a < n; ++a) {
            long double answer = 0;
            for (int u = 0; u < m; ++u) answer += inverse[t * m + u] * pull(u, a);
            answer_.push_back(static_cast<double>(answer));
        }
    }
    for (int a = 0; a < n; ++a)
        for (int t = 0; t < m; ++t) coupling_.push_back(theta[a * all + n + t]);
    one_ = {laws_[0].stiffness, laws_[0].height,          phi_[0],
            inverse_[0],        n > 0 ? coupling_[0] : 0, n > 0 ? answer_[0] : 0};
}

std::vector<double> EliminatedThreads::between_contacts(std::span<const double> theta) const {
    const int n = contacts_, all = n + count();
    std::vector<double> between(static_cast<std::size_t>(n) * n);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b <= a; ++b) {  // symmetric to the last bit
            long double sum = theta[static_cast<std::size_t>(a) * all + b];
            for (int t = 0; t < count(); ++t)
                sum -= static_cast<long double>(coupling(a, t)) * answer(t, b);
            between[static_cast<std::size_t>(a) * n + b] =
                between[static_cast<std::size_t>(b) * n + a] = static_cast<double>(sum);
        }
    return between;
}

}  // namespace jvari
