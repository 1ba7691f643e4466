// Contacts, and perhaps a thread, under a string of a few modes drawn at random: what obstacle
// rules are tested on.
#pragma once

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "schemes/contact/obstacle.hpp"

namespace jvari {

constexpr int many = 3;        // of contacts
constexpr double span = 1e-5;  // of a step [s]

using Real = long double;

inline Real potential(const ContactLaw& law, Real eta) {
    return eta > 0 ? law.k * std::pow(eta, Real(law.alpha) + 1) / (Real(law.alpha) + 1) : 0;
}

struct Points {
    Contacts contacts;
    std::optional<Thread> thread;
    std::vector<double> theta;  // [m/N], a row for each point
    int count() const { return contacts.count() + (thread ? 1 : 0); }
    std::vector<Thread> threads() const {
        return thread ? std::vector{*thread} : std::vector<Thread>{};
    }
};

// Theta of five modes whose weights lie within `most` of 0.
inline void couple(Points& p, std::mt19937& random, double most) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const int n = p.count(), modes = 5;
    std::vector<double> g(n * modes);
    for (double& x : g) x = most * unit(random);
    p.theta.assign(n * n, 0.0);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b)
            for (int i = 0; i < modes; ++i)
                p.theta[a * n + b] += g[a * modes + i] * g[b * modes + i];
}

}  // namespace jvari
