// The smoke suite against results/smoke: has a number of any scheme moved by more than rounding can move it?
//
// Tolerance of an error figure: 1000 times its noise floor (what a relative change of the start of 1e-12 makes of the reference, on that
// scene, window and tap) and 1e-9 of the figure; a centroid difference is the difference of two tracks of a kilohertz and blind to the
// scale of the start, so 1e-9 of a kilohertz is added to its own. So the tolerance covers what relative changes of 1e-9 would do. Another
// vector width changes the order of sums: with SSE2 in place of AVX-512, 5 of the 6632 figures moved by more than 100 floors, none but
// centroids by more than 350. A changed equation is out by far more. Facts and the modes' own frequencies follow from closed forms: 1e-9.
// What is read from a trace by the matrix pencil: 1e-4 cents.
//
// Every other column of errors.csv is compared too. What follows the motion and has no noise floor of its own (contact force, penetration,
// certificates of stand-ins) may move by 1000 times the largest floor of the row's taps and 1e-6 of itself; residuals of the ledger by 1e-9
// and that; an instant by two rows; a noise floor, which is rounding itself, tenfold; what iterations counted and left, by a hundredth.
// `below_floor` follows from the rest: each error that it names is no larger than its floor, and no other.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "bench/store/records.hpp"
#include "command_line.hpp"

namespace jvari::test {
namespace {

constexpr double floors = 1000, rounding = 1e-9, centroid = 1e3;  // [Hz]

using Rows = std::map<std::string, std::size_t>;
Rows rows_by_name(const bench::store::Table& t, const std::vector<std::string>& names) {
    Rows rows;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string key;
        for (const std::string& name : names) key += t.at(i, name) + " ";
        rows[key] = i;
    }
    return rows;
}

struct Tally {
    int compared = 0, different = 0;
    void number(double then, double now, double tolerance, const std::string& what) {
        ++compared;
        if (std::isnan(then) && std::isnan(now)) return;
        if (then == now || std::abs(then - now) <= tolerance) return;
        if (++different <= 20) ADD_FAILURE() << what << ": was " << then << ", is " << now << ", tolerance " << tolerance;
    }
};

constexpr double row = 1.0 / 44100;  // [s]

bool is_text(const std::string& column) {
    for (const char* name : {"scene", "scheme", "options", "status", "flags", "reference", "reference_doubling", "reason"})
        if (column == name) return true;
    return false;
}

bool is_closed_form(const std::string& column) {  // or a count that the settings fix
    for (const char* name :
         {"fact_static_compliance", "fact_start_phase_offset", "fact_start_phase_error", "fact_period_error_cents", "fact_loss_fit_",
          "fact_grid_intervals", "fact_interior_nodes", "fact_modes_above_nyquist", "fact_contact_points", "fact_bridge_nodes",
          "fact_theta", "fact_stable_stiffness_limit", "rate", "modes", "dofs", "state_bytes", "steps"})
        if (column.starts_with(name)) return true;
    return false;
}

// The row's own sensitivity: the largest noise floor of its relative L2 errors.
double sensitivity(const bench::store::Table& t, std::size_t i) {
    double largest = 0;
    for (const std::string& column : t.columns)
        if (column.starts_with("floor_error_l2_whole")) largest = std::fmax(largest, t.number(i, column));
    return largest;
}

double tolerance_of(const std::string& column, const bench::store::Table& then, std::size_t i) {
    const double old = std::abs(then.number(i, column)), motion = (floors * sensitivity(then, i) + 1e-6) * old;
    if (const double floor = then.number(i, "floor_" + column); !std::isnan(floor))
        return floors * floor + rounding * (old + (column.starts_with("centroid_hz") ? centroid : 0));
    if (column.starts_with("floor_")) return 9 * old + 1e-9;
    if (column.starts_with("horizon_s") || column == "failed_at_s") return 2 * row;
    if (column == "failed_step") return 2;
    if (column.starts_with("energy_residual")) return 1e-9 + motion;
    if (column == "smallest_contact_force") return 1e-9 + motion;  // [N]
    if (column == "deepest_penetration") return 1e-15 + motion;    // [m]
    if (is_closed_form(column)) return rounding * old;
    if (column.starts_with("fact_")) return 1e-9 + 1e-2 * old;
    return motion;
}

void expect_below_floor(const bench::store::Table& t, std::size_t i, const std::string& name) {
    const std::string named = " " + t.at(i, "below_floor") + " ";
    for (const std::string& column : t.columns)
        if (column.starts_with("floor_") && t.column(column.substr(6)) < t.column("below_floor")) {
            EXPECT_EQ(named.find(" " + column.substr(6) + " ") != std::string::npos, t.number(i, column.substr(6)) <= t.number(i, column))
                << name << column;
        }
}

TEST(Regression, TheSmokeSuiteIsWhatItWasWhenItWasRecorded) {
    const std::filesystem::path kept = std::filesystem::path(JVARI_SOURCE) / "results" / "smoke";
    const Scratch scratch;
    std::string suite = content(std::filesystem::path(JVARI_SOURCE) / "bench" / "suites" / "smoke.toml");
    for (std::size_t at; (at = suite.find("\"cost\"")) != std::string::npos;) suite.replace(at, 6, "\"errors\"");  // no clock here
    std::ofstream(scratch / "smoke.toml") << suite;
    const Outcome o = jvari(scratch, "suite " + (scratch / "smoke.toml") + " --jobs 2 --quiet --out " + (scratch / "now"));
    ASSERT_EQ(o.code, 0) << o.err;

    const bench::store::Table then = bench::store::read_csv(content(kept / "errors.csv")),
                              now = bench::store::read_csv(content(scratch / "now/errors.csv"));
    const std::vector<std::string> names{"scene", "scheme", "options", "rate"};
    const Rows was = rows_by_name(then, names), is = rows_by_name(now, names);
    ASSERT_EQ(was.size(), is.size());
    EXPECT_EQ(was.size(), then.rows.size()) << "two rows of one name";
    Tally tally;
    for (const auto& [name, i] : was) {
        ASSERT_TRUE(is.contains(name)) << name;
        const std::size_t k = is.at(name);
        for (const std::string& column : then.columns) {
            if (column == "cell" || column == "below_floor") continue;  // the first is of the program that recorded it
            if (is_text(column)) {
                EXPECT_EQ(then.at(i, column), now.at(k, column)) << name << column;
            } else tally.number(then.number(i, column), now.number(k, column), tolerance_of(column, then, i), name + column);
        }
        expect_below_floor(now, k, name);
    }
    EXPECT_EQ(then.columns, now.columns);
    EXPECT_GT(tally.compared, 10000);

    const bench::store::Table modes_then = bench::store::read_csv(content(kept / "dispersion.csv")),
                              modes_now = bench::store::read_csv(content(scratch / "now/dispersion.csv"));
    const std::vector<std::string> mode{"scene", "scheme", "options", "rate", "mode"};
    const Rows mode_was = rows_by_name(modes_then, mode), mode_is = rows_by_name(modes_now, mode);
    ASSERT_EQ(mode_was.size(), mode_is.size());
    for (const auto& [name, i] : mode_was) {
        ASSERT_TRUE(mode_is.contains(name)) << name;
        const std::size_t k = mode_is.at(name);
        const auto number = [&](const char* column, double tolerance) {
            tally.number(modes_then.number(i, column), modes_now.number(k, column), tolerance, name + column);
        };
        number("own_cents", 1e-8);
        number("own_decay_per_s", 1e-8);
        number("trace_cents", 1e-4);
        number("trace_decay_per_s", 1e-3);
    }
    EXPECT_EQ(tally.different, 0) << "of " << tally.compared << " numbers";
}

}  // namespace
}  // namespace jvari::test
