#include "bench/study/verdict.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "analysis/energy.hpp"

namespace jvari::bench::study {

namespace {
constexpr std::array all = {Verdict::sound,          Verdict::unjudged,      Verdict::inaccurate, Verdict::adhesive,
                            Verdict::energy_gaining, Verdict::not_converged, Verdict::diverged,   Verdict::refused};
}  // namespace

std::span<const Verdict> verdicts() {
    return all;
}

const char* name_of(Verdict v) {
    constexpr std::array names = {"sound", "unjudged", "inaccurate", "adhesive", "energy_gaining", "not_converged", "diverged", "refused"};
    static_assert(names.size() == all.size());
    return names[static_cast<std::size_t>(v)];
}

Verdict verdict_named(const std::string& name) {
    for (const Verdict v : all)
        if (name == name_of(v)) return v;
    throw std::runtime_error("unknown outcome " + name);
}

Judgement judge(const Cell& cell, double error) {
    if (!cell.ran()) return {Verdict::refused, cell.reason, 0};
    const Summary& s = cell.summary;
    const bool promised = cell.scheme->balance == Balance::exact;
    const double pull = pull_of(s.smallest_contact_force, s.largest_contact_force);
    if (s.status.outcome == Outcome::diverged) return {Verdict::diverged, fmt::format("at step {}", s.status.step), s.status.step};
    if (s.largest_displacement > std::sqrt(energy_budget))
        return {Verdict::diverged, fmt::format("displacement {:.3g} times what its energy allows", s.largest_displacement), 0};
    if (s.status.outcome != Outcome::ok) return {Verdict::not_converged, fmt::format("at step {}", s.status.step), s.status.step};
    if (s.energy_gain > (promised ? energy_allowed : gain_allowed_unpromised))
        return {Verdict::energy_gaining, fmt::format("{:.3g} of its energy gained", s.energy_gain), 0};
    if (pull > pull_allowed) return {Verdict::adhesive, fmt::format("pulls by {:.3g} of the largest contact force", pull), 0};
    if (error > error_allowed) return {Verdict::inaccurate, fmt::format("error {:.3g}", error), 0};
    if (std::isnan(s.largest_displacement) && std::isnan(s.energy_gain) && std::isnan(pull) && std::isnan(error))
        return {Verdict::unjudged, "no energy, no smallest contact force and no reference to judge it by", 0};
    return {Verdict::sound, std::isnan(error) ? "" : fmt::format("error {:.3g}", error), 0};
}

}  // namespace jvari::bench::study
