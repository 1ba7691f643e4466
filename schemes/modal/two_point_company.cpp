#include "schemes/modal/two_point_company.hpp"

#include <algorithm>

namespace jvari {

namespace {

using Column = TwoPointColumn;
using Member = TwoPointCompany::Member;

constexpr Column weight_columns[company_weights] = {Column::g_b, Column::g_c, Column::c, Column::loss};

double of(const TwoPoint& m, Column column, int mode) {
    return mode < m.size ? m.stream[two_point_at(column, mode)] : 0;
}
double of(const TwoPoint& m, const double* weights, int mode) {  // nullptr: none
    return weights && mode < m.size ? weights[mode] : 0;
}

// Taps that are sums over the modes.
bool from_modes(const TwoPointTap& tap) {
    return tap.from == TwoPointTap::From::modes || tap.from == TwoPointTap::From::modes_and_increment;
}
int quantity_of(TwoPointTap::From force) {
    using enum TwoPointTap::From;
    return force == bridge ? bridge_mean : force == thread ? thread_mean : driving_mean;
}
std::vector<const TwoPointTap*> reads_of(const TwoPoint& m) {
    std::vector<const TwoPointTap*> all;
    for (const TwoPointTap& tap : m.taps)
        if (from_modes(tap)) all.push_back(&tap);
    return all;
}

bool has_thread(const TwoPoint& m) {
    return m.theta_cc > 0;
}
bool same(const TwoPoint& a, const double* x, const double* y) {
    return (!x && !y) || (x && y && std::equal(x, x + a.size, y));
}
bool may_differ(const TwoPoint& a, const TwoPoint& b) {
    return has_thread(a) == has_thread(b) && a.steps_per_row == b.steps_per_row;
}
bool alike(const TwoPoint& a, const TwoPoint& b) {
    if (!may_differ(a, b) || a.modes != b.modes || !same(a, a.g_e, b.g_e)) return false;
    for (const Column column : weight_columns)
        for (int i = 0; i < a.modes; ++i)
            if (of(a, column, i) != of(b, column, i)) return false;
    const auto of_a = reads_of(a), of_b = reads_of(b);
    return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                      [&](const TwoPointTap* x, const TwoPointTap* y) { return same(a, x->on_y, y->on_y) && same(a, x->on_u, y->on_u); });
}

// [bytes] The first-level cache of most processors of the last twenty years. It is not asked for: whether strings go together decides how
// their sums are rounded, and the digits of a result must not depend on the machine's cache.
constexpr std::size_t first_level_cache = 32768;

bool worth_it(std::span<const Member> some, std::size_t lanes) {  // strings that differ, in as many lanes
    std::size_t most = 0, sum = 0;
    for (const Member& m : some) {
        const std::size_t modes = m.string->modes;
        most = std::max(most, modes);
        sum += modes;
    }
    const std::size_t bytes = sizeof(double) * lanes * most * (2 + company_weights + 1);  // state, weights, a tap
    return 4 * sum >= 3 * lanes * most && bytes <= first_level_cache;
}

}  // namespace

TwoPointCompany::TwoPointCompany(std::vector<Member> members, bool alike, const CompanyKernel& kernel)
    : members_(std::move(members)), alike_(alike), kernel_(kernel) {
    Company& m = company_;
    m.lanes = kernel.lanes;
    m.steps_per_row = members_.front().string->steps_per_row;
    std::size_t reads = 0;
    for (const Member& member : members_) {
        const TwoPoint& s = *member.string;
        m.modes = std::max(m.modes, s.modes);
        reads = std::max(reads, reads_of(s).size());
    }
    m.state = AlignedVector(2 * static_cast<std::size_t>(m.modes) * m.lanes);
    // [mode][column][lane], or [mode][column] of the first where all are alike
    const auto packed = [&](int columns, auto value) {
        const int wide = alike_ ? 1 : m.lanes;
        AlignedVector all(static_cast<std::size_t>(m.modes) * columns * wide);
        for (int i = 0; i < m.modes; ++i)
            for (int c = 0; c < columns; ++c)
                for (int k = 0; k < std::min<int>(wide, members_.size()); ++k)
                    all.data()[(i * columns + c) * wide + k] = value(*members_[k].string, c, i);
        return all;
    };
    m.weights = packed(company_weights, [](const TwoPoint& s, int column, int i) { return of(s, weight_columns[column], i); });
    m.g_e = packed(1, [](const TwoPoint& s, int, int i) { return of(s, s.g_e, i); });
    for (std::size_t r = 0; r < reads; ++r) {
        const auto read = [r](const TwoPoint& s) {
            const auto all = reads_of(s);
            return r < all.size() ? *all[r] : TwoPointTap{TwoPointTap::From::modes};
        };
        CompanyRead& tap = m.reads.emplace_back();
        tap.on_y = packed(1, [&](const TwoPoint& s, int, int i) { return of(s, read(s).on_y, i); });
        if (std::any_of(members_.begin(), members_.end(), [&](const Member& x) { return read(*x.string).on_u; }))
            tap.on_u = packed(1, [&](const TwoPoint& s, int, int i) { return of(s, read(s).on_u, i); });
    }
    for (std::size_t k = 0; k < members_.size(); ++k) {
        const TwoPoint& s = *members_[k].string;
        m.k.of[k] = s.barrier.k;
        m.lost_c.of[k] = s.r_c / s.dt;
        const std::pair<PerString Company::*, double> constants[] = {{&Company::h_b, s.h_b},      {&Company::k_c, s.k_c},
                                                                     {&Company::h_c, s.h_c},      {&Company::theta, s.theta},
                                                                     {&Company::phi_c, s.phi_c},  {&Company::inverse_c, s.inverse_c},
                                                                     {&Company::beta_c, s.beta_c}};
        for (const auto& [lanes, value] : constants) (m.*lanes).of[k] = value;
        m.plucks[k] = {s.pluck, s.pluck_first, s.pluck_steps};
        const auto dot = [&s](auto a, auto b) {
            long double sum = 0;
            for (int i = 0; i < s.modes; ++i) sum += static_cast<long double>(of(s, a, i)) * of(s, b, i);
            return static_cast<double>(sum);
        };
        m.theta_bb.of[k] = dot(Column::g_b, Column::g_b);
        m.theta_bc.of[k] = dot(Column::g_b, Column::g_c);
        m.theta_cc.of[k] = dot(Column::g_c, Column::g_c);
        m.theta_be.of[k] = dot(Column::g_b, s.g_e);
        m.theta_ce.of[k] = dot(Column::g_c, s.g_e);
    }
    m.rows.resize(company_rows * (first_read + reads));
    for (std::size_t k = 0; k < members_.size(); ++k) {
        int read = first_read;
        for (const TwoPointTap& tap : members_[k].string->taps) {
            const int quantity = from_modes(tap) ? read++ : quantity_of(tap.from);
            columns_.push_back({quantity, static_cast<int>(k), nullptr});
        }
    }
    for (std::size_t k = 0; k < members_.size(); ++k)
        for (const int quantity : {stored_energy, supplied_energy, dissipated_energy})
            columns_.push_back({quantity, static_cast<int>(k), nullptr});
}

void TwoPointCompany::begin() noexcept {
    for (std::size_t k = 0; k < members_.size(); ++k)
        for (int i = 0; i < company_.modes; ++i) {
            double* of_mode = company_.state.data() + 2 * static_cast<std::ptrdiff_t>(i) * company_.lanes + k;
            of_mode[0] = of(*members_[k].string, Column::y, i);
            of_mode[company_.lanes] = of(*members_[k].string, Column::u, i);
        }
    kernel_.begin(company_);
}

void TwoPointCompany::advance(std::span<Lane> all) noexcept {
    if (members_.front().string->step != company_.step) begin();
    const Block& asks = all[members_.front().place].out;
    std::size_t column = 0;
    for (const Member& member : members_) {
        const Block& out = all[member.place].out;
        for (int t = 0; t < out.taps; ++t) columns_[column++].to = out.tap + t * out.stride;
    }
    for (const Member& member : members_) {
        const Block& out = all[member.place].out;
        for (int c = 0; out.energy && c < 3; ++c) columns_[column++].to = out.energy + c * out.stride;
    }
    kernel_.advance(company_, std::span(columns_).first(column), asks);
    for (std::size_t k = 0; k < members_.size(); ++k) {
        TwoPoint& m = *members_[k].string;
        m.step = company_.step;
        m.least_force = company_.least_force.of[k];
        m.most_force = company_.most_force.of[k];
        m.depth = company_.depth.of[k];
        all[members_[k].place].status = {};
    }
}

std::vector<std::unique_ptr<TwoPointCompany>> companies_of(std::span<TwoPoint* const> strings) {
    std::vector<std::unique_ptr<TwoPointCompany>> all;
    std::vector<TwoPoint*> left(strings.begin(), strings.end());
    for (const bool are_alike : {true, false})
        for (std::size_t first = 0; first < left.size(); ++first) {
            if (!left[first]) continue;
            const CompanyKernel kernel = company_kernel(are_alike, has_thread(*left[first]));
            std::vector<Member> some;
            for (std::size_t k = first; k < left.size() && some.size() < kernel.lanes; ++k)
                if (left[k] && (are_alike ? alike : may_differ)(*left[first], *left[k])) some.push_back({left[k], k});
            if (some.empty() || 4 * some.size() < 3 * kernel.lanes || !(are_alike || worth_it(some, kernel.lanes))) continue;
            for (const Member& m : some) left[m.place] = nullptr;
            all.push_back(std::make_unique<TwoPointCompany>(std::move(some), are_alike, kernel));
        }
    return all;
}

}  // namespace jvari
