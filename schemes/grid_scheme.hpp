// The seam for schemes on grids: one stepped string per string of the scene, each adding its part to the taps and the energy columns.
//
// OneString has reset(), Status advance(const Block&) that adds to columns, dofs(), facts(), free_modes(). Strings do not act on each
// other, so each runs through the whole block on its own.
#pragma once

#include <algorithm>

#include "schemes/finite_difference.hpp"
#include "schemes/obstacle_step.hpp"

namespace jvari {

template <class OneString>
class GridScheme final : public Scheme {
public:
    explicit GridScheme(std::vector<OneString> strings) : strings_(std::move(strings)) { GridScheme::reset(); }

    void reset() noexcept override {
        for (auto& s : strings_) s.reset();
    }
    Status advance(const Block& out) noexcept override {
        for (int k = 0; k < out.taps; ++k) std::fill_n(out.tap + k * out.stride, out.rows, 0.0);
        if (out.energy)
            for (int k = 0; k < 3; ++k) std::fill_n(out.energy + k * out.stride, out.rows, 0.0);
        Status worst;
        for (auto& s : strings_) {
            const Status status = s.advance(out);
            if (status.outcome != Outcome::ok && (worst.outcome == Outcome::ok || status.step < worst.step)) worst = status;
        }
        return worst;
    }
    int dofs() const override {
        int sum = 0;
        for (const auto& s : strings_) sum += s.dofs();
        return sum;
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> all;
        for (std::size_t k = 0; k < strings_.size(); ++k)
            for (Fact f : strings_[k].facts()) {
                if (strings_.size() > 1) f.name = std::string("string.").append(std::to_string(k)).append(".").append(f.name);
                all.push_back(f);
            }
        return all;
    }
    std::vector<FreeMode> free_modes() const override { return strings_.front().free_modes(); }

private:
    std::vector<OneString> strings_;
};

// Facts that every string on a grid reports.
std::vector<Fact> grid_facts(const GridString&, const ObstacleStep&);

// A run has diverged where the kinetic energy passes this many times what the string was given (initial energy and work of the pluck): a
// stable scheme near its limit may hold a multiple of it in its highest mode, an unstable one passes any multiple.
constexpr double divergence_factor = 1e4;
constexpr long divergence_check = 64;  // [steps]

}  // namespace jvari
