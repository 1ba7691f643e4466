#include "schemes/contact/few_contacts.hpp"

#include <algorithm>

#include "schemes/decompositions.hpp"

namespace jvari {

FewContacts::FewContacts(std::span<const ContactLaw> laws, std::span<const double> theta)
    : n_(static_cast<int>(laws.size())) {
    const int n = n_;
    for (int a = 0; a < n; ++a) k_[a] = laws[a].k, give_[a] = 2 / laws[a].k;
    std::copy(theta.begin(), theta.end(), theta_);
    M_.assign(static_cast<std::size_t>(n * n) << n, 0.0);
    for (unsigned set = 1; set < 1u << n; ++set) {
        std::vector<int> in;
        for (int a = 0; a < n; ++a)
            if (set >> a & 1) in.push_back(a);
        std::vector<long double> system;
        for (int a : in)
            for (int c : in) system.push_back((a == c ? give_[a] : 0.0L) + theta[a * n + c]);
        const std::vector<long double> inverse = inverse_of(system, static_cast<int>(in.size()));
        for (std::size_t i = 0; i < inverse.size(); ++i)
            M_[set * n * n + in[i / in.size()] * n + in[i % in.size()]] =
                static_cast<double>(inverse[i]);
    }
}

int FewContacts::solve(const double* eta, const double* b, double* r,
                       double* force) const noexcept {
    switch (n_) {
        case 2: return solve<2>(eta, b, r, force);
        case 3: return solve<3>(eta, b, r, force);
        case 4: return solve<4>(eta, b, r, force);
        default: return solve<5>(eta, b, r, force);
    }
}

}  // namespace jvari
