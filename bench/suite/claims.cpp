#include "bench/suite/claims.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/store/folder.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/columns.hpp"

namespace jvari::bench::suite {

namespace fs = std::filesystem;

namespace {
struct CannotTell {  // a number that is not there
    std::string why;
};

struct Number {
    double value, uncertainty;  // NaN: unknown
    std::string rests_on;       // "" where it is the run's own
};

class Tables {  // of a folder, each read once
public:
    explicit Tables(const fs::path& folder) : folder_(store::folder_at(folder)) {}
    const store::Table& of(const std::string& name) {
        store::Table& t = read_[name];
        if (t.columns.empty()) t = folder_.table(name);
        return t.columns.empty() ? throw CannotTell{name + ".csv is not in the folder"} : t;
    }

private:
    store::Folder folder_;
    std::map<std::string, store::Table> read_;
};

bool carries(const std::string& field, const std::string& wanted) {
    const double a = store::number_of(field), b = store::number_of(wanted);
    return field == wanted || a == b;
}

std::string text_of(const Where& where) {
    std::string text;
    for (const auto& [column, value] : where) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", column, value);
    return text;
}

// The uncertainty of one field, and what it rests on.
std::pair<double, const char*> uncertainty_of(const store::Table& t, std::size_t row, const std::string& column) {
    if (column.starts_with("error_")) return {compare::bound_of(t, row, column).certificate, "the reference's certificate"};
    if (study::rule_of(column) != study::Rule::clock) return {0, ""};
    const double cost = t.number(row, "cost_s_per_s"),
                 apart = std::max(t.number(row, "cost_upper") - cost, cost - t.number(row, "cost_lower"));
    return {t.number(row, column) * apart / cost, "quartiles"};
}

struct Picked {
    Series series;
    double uncertainty = 0;
    std::string rests_on;
};
Picked picked(Tables& tables, const Pick& q, const Where& also) {
    const store::Table& t = tables.of(q.table);
    Where where = q.where;
    for (const Where* more : {&also, &q.own})
        for (const auto& w : *more) {
            std::erase_if(where, [&w](const auto& other) { return other.first == w.first; });
            where.push_back(w);
        }
    std::vector<std::string> named{q.column};
    if (!q.along.empty()) named.push_back(q.along);
    for (const auto& [column, value] : where) named.push_back(column);
    for (const std::string& column : named)
        if (t.column(column) < 0) throw CannotTell{fmt::format("{}.csv: {}", q.table, store::unknown("column", column, t.columns))};
    Picked p;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (std::ranges::any_of(where, [&](const auto& w) { return !carries(t.at(i, w.first), w.second); })) continue;
        const double x = q.along.empty() ? static_cast<double>(i) : t.number(i, q.along), y = t.number(i, q.column);
        if (std::isnan(y) || (!q.along.empty() && !(q.from <= x && x <= q.to))) continue;
        if (!p.series.emplace(x, y).second) throw CannotTell{fmt::format("{}.csv: two rows at {} {}", q.table, q.along, x)};
        const auto [u, rests_on] = uncertainty_of(t, i, q.column);
        if (std::isnan(u) || u > p.uncertainty) p.uncertainty = u;  // once unknown, it stays so
        if (*rests_on) p.rests_on = rests_on;
    }
    if (p.series.empty()) throw CannotTell{fmt::format("{}.csv: no row with {} has {}", q.table, text_of(where), q.column)};
    return p;
}

Number reduced(Tables& tables, const Pick& q, const std::optional<Pick>& against, const Where& also) {
    Picked p = picked(tables, q, also);
    if (against) {
        const Picked other = picked(tables, *against, also);
        for (auto& [x, y] : p.series) {
            const auto there = other.series.find(x);
            if (there == other.series.end()) throw CannotTell{fmt::format("{}.csv: no other row at {} {}", q.table, q.along, x)};
            y -= there->second;
        }
        p.uncertainty += other.uncertainty;
    }
    const Reduced r = q.take->of(p.series);
    if (!r.why.empty()) throw CannotTell{fmt::format("{}.csv: {}", q.table, r.why)};
    return {r.value, p.uncertainty + r.half_width, r.half_width > 0 ? "95 % interval" : p.rests_on};
}

Number measured(Tables& tables, const Claim& c, const Where& also) {
    Number n = reduced(tables, *c.measured, c.against, also);
    const auto with = [&n](const Number& other, double value, double uncertainty) {
        n = {value, uncertainty, n.rests_on.empty() ? other.rests_on : n.rests_on};
    };
    if (c.minus) {
        const Number other = reduced(tables, *c.minus, {}, also);
        with(other, n.value - other.value, n.uncertainty + other.uncertainty);
    }
    if (c.over) {
        const Number other = reduced(tables, *c.over, {}, also);
        const double ratio = n.value / other.value;
        with(other, ratio, (n.uncertainty + std::abs(ratio) * other.uncertainty) / std::abs(other.value));
    }
    if (c.uncertainty > 0) n = {n.value, n.uncertainty + c.uncertainty, n.rests_on.empty() ? "the claim's own" : n.rests_on};
    return n;
}

enum Verdict { holds, cannot_be_told, does_not_hold };  // the gravest of several sets of rows counts
constexpr const char* names[] = {"holds", "cannot be told", "does not hold"};

Verdict verdict_on(const Claim& c, const Number& n) {
    const double low = n.value - n.uncertainty, high = n.value + n.uncertainty;
    if (c.least <= low && high <= c.most) return holds;
    return high < c.least || low > c.most ? does_not_hold : cannot_be_told;  // NaN: neither
}

std::string expected(const Claim& c) {
    const std::string least = fmt::format("{:.6g}", c.least), most = fmt::format("{:.6g}", c.most);
    if (std::isinf(c.least)) return std::isinf(c.most) ? "" : "at most " + most;
    return std::isinf(c.most) ? "at least " + least : least + " to " + most;
}

struct Judged {
    Verdict verdict = holds;
    std::optional<Number> shown;
    std::string why;
};
Judged judged(Tables& tables, const Claim& c) {
    Judged j;
    double margin = HUGE_VAL;
    try {
        for (const Where& also : c.each) {
            const Number n = measured(tables, c, also);
            j.verdict = std::max(j.verdict, verdict_on(c, n));
            const double own = std::min(n.value - c.least, c.most - n.value);
            if (!j.shown || own < margin) j.shown = n, margin = own;
        }
    } catch (const CannotTell& e) {
        return {cannot_be_told, {}, e.why};
    }
    if (std::isnan(j.shown->uncertainty)) j.why = "how far the reference is off is not known";
    return j;
}
}  // namespace

store::Table verdicts_on(const std::vector<Claim>& claims, const fs::path& folder) {
    store::Table t;
    t.columns = {"claim", "place", "verdict", "measured", "uncertainty", "unit", "expected", "rests_on", "note"};
    Tables tables(folder);
    for (const Claim& c : claims) {
        Judged j = c.measured ? judged(tables, c) : Judged{cannot_be_told, {}, ""};
        if (!c.open.empty()) j.verdict = cannot_be_told;
        std::string note;
        for (const std::string& part : {j.why, c.open, c.note})
            if (!part.empty()) note += (note.empty() ? "" : "; ") + part;
        const auto digits = [](double x) { return std::isnan(x) ? "" : fmt::format("{:.5g}", x); };
        t.rows.push_back({c.says, c.place, names[j.verdict], j.shown ? digits(j.shown->value) : "",
                          j.shown && !j.shown->rests_on.empty() ? digits(j.shown->uncertainty) : "", c.unit, expected(c),
                          j.shown ? (j.shown->rests_on.empty() ? "the run itself" : j.shown->rests_on) : "", note});
    }
    return t;
}

std::vector<Claim> claims_on(const fs::path& folder) {
    std::error_code error;
    if (const fs::path own = folder / suite_file; fs::is_regular_file(own, error)) return read_suite(own.string()).claims;
    const std::string suite = store::folder_at(folder).manifest().value("suite", "");
    if (suite.empty()) throw store::UsageError(folder.string() + "/manifest.json: it names no suite, and claims stand in suites");
    return read_suite(suite).claims;
}

std::string claims_summary(const store::Table& verdicts) {
    std::map<std::string, int> counted;
    for (std::size_t i = 0; i < verdicts.rows.size(); ++i) ++counted[verdicts.at(i, "verdict")];
    return fmt::format("{} claims: {} hold, {} do not hold, {} cannot be told", verdicts.rows.size(), counted[names[holds]],
                       counted[names[does_not_hold]], counted[names[cannot_be_told]]);
}

}  // namespace jvari::bench::suite
