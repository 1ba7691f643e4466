#include "bench/study/columns.hpp"
#include "bench/study/judgement.hpp"
#include "scenes/excitation.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace jvari::bench::study {

namespace {
struct Field {  // of one record: what a column is asked for
    const Job& job;
    const Record& record;
    Headline headline;
    std::size_t measure = 0, window = 0;
    std::size_t tap = none;
    std::string fact{};
    static constexpr auto none = static_cast<std::size_t>(-1);

    const Cell& cell() const { return record.cell; }
    const Summary& summary() const { return record.cell.summary; }
    bool ran() const { return cell().ran(); }
    std::size_t at() const {  // the tap that is meant, the headline's where none is named
        return tap != none ? tap : static_cast<std::size_t>(headline.tap(measures()[measure]));
    }
    std::size_t nut() const { return tap != none ? tap : static_cast<std::size_t>(headline.nut); }
    double in(const Errors& e) const { return at() < e.size() ? e[at()][measure] : store::nan; }
    double seconds() const {
        return ran() && summary().duration > 0 ? summary().duration : store::nan;
    }
    double of(double x) const { return ran() ? x : store::nan; }
    const char* untimed() const { return ran() && !record.timed() ? cell().scheme->untimed : ""; }
    // nothing where none was timed
    double clock(double x) const { return cell().clock.wall.median > 0 ? of(x) : store::nan; }
};

std::string count(long n, bool known) { return known ? std::to_string(n) : ""; }
std::string number(double x) { return store::text_of(x); }

// Headline errors that are no larger than what the reference's own sensitivity makes of 1e-12.
std::string ties_of(Field f) {
    std::string ties;
    for (f.measure = 0; f.measure < measures().size(); ++f.measure)
        if (measures()[f.measure].less_is_better &&
            f.in(f.record.cell.errors) <= f.in(f.record.against.floor))
            ties += (ties.empty() ? "" : " ") + measures()[f.measure].column;
    return ties;
}

bool failed(const Field& f) { return f.ran() && f.summary().status.outcome != Outcome::ok; }

struct Declared : Column {
    std::string (*value)(const Field&);
};

// In the order in which they stand in a table.
const std::vector<Declared>& declared() {
    using F = const Field&;
    static const std::vector<Declared> all = {
        {{"scheme", "", Rule::text, "the scheme"},
         [](F f) { return std::string(f.cell().scheme->name); }},
        {{"options", "", Rule::text, "its options, where they are not the default"},
         [](F f) { return store::options_text(f.cell().settings.options); }},
        {{"rate", "Hz", Rule::closed_form,
          "steps per second; empty for a scheme in continuous time"},
         [](F f) {
             return number(f.cell().scheme->clock == Clock::continuous
                               ? store::nan
                               : f.cell().settings.sample_rate);
         }},
        {{"modes", "", Rule::closed_form, "modes of the first string; interior nodes of a grid"},
         [](F f) { return count(f.cell().modes(), f.cell().modes() > 0); }},
        {{"status", "", Rule::text,
          "`ok`, `diverged`, `not_converged`, `refused`, `past_time_limit`, `error` or "
          "`not_needed`"},
         [](F f) { return f.cell().status(); }},
        {{"flags", "", Rule::text,
          "what the run's own figures say against it: `adhesion`, `psi_gap`, `energy`, "
          "`modes_above_nyquist`"},
         [](F f) { return f.ran() ? names_of(flags_of(f.summary())) : std::string(); }},
        {{"{m}", "1, s, dB, Hz", Rule::error, "each error, of the headline's tap"},
         [](F f) { return number(f.in(f.cell().errors)); }},
        {{"cost_s_per_s", "1", Rule::clock,
          "computing time per second of sound: median of the timed runs"},
         [](F f) {
             return *f.untimed() ? f.untimed()
                                 : number(f.clock(f.cell().clock.wall.median) / f.seconds());
         }},
        {{"cost_lower", "1", Rule::clock, "its quartiles"},
         [](F f) { return number(f.clock(f.cell().clock.wall.lower) / f.seconds()); }},
        {{"cost_upper", "1", Rule::clock, ""},
         [](F f) { return number(f.clock(f.cell().clock.wall.upper) / f.seconds()); }},
        {{"processor_s_per_s", "1", Rule::clock,
          "the same in processor time. A slow-down that all samples of a round at one rate share "
          "counts as drift of the machine and is "
          "subtracted"},
         [](F f) { return number(f.clock(f.cell().clock.processor.median) / f.seconds()); }},
        {{"processor_lower", "1", Rule::clock, ""},
         [](F f) { return number(f.clock(f.cell().clock.processor.lower) / f.seconds()); }},
        {{"processor_upper", "1", Rule::clock, ""},
         [](F f) { return number(f.clock(f.cell().clock.processor.upper) / f.seconds()); }},
        {{"wall_seconds", "s", Rule::clock, "of the whole run"},
         [](F f) { return number(f.clock(f.cell().clock.wall.median)); }},
        {{"wall_seconds_lower", "s", Rule::clock, ""},
         [](F f) { return number(f.clock(f.cell().clock.wall.lower)); }},
        {{"wall_seconds_upper", "s", Rule::clock, ""},
         [](F f) { return number(f.clock(f.cell().clock.wall.upper)); }},
        {{"ns_per_step", "ns", Rule::clock, "`wall_seconds` over the steps"},
         [](F f) {
             return number(f.summary().steps > 0 ? f.clock(f.cell().clock.wall.median) * 1e9 /
                                                       static_cast<double>(f.summary().steps)
                                                 : store::nan);
         }},
        {{"times_real_time", "1", Rule::clock, "1 / `cost_s_per_s`"},
         [](F f) { return number(f.seconds() / f.clock(f.cell().clock.wall.median)); }},
        {{"worst_block_of_deadline", "1", Rule::clock,
          "worst-case load: computing time of the slowest block of 64 rows over the time that "
          "those rows sound, the best of all timed "
          "runs. "
          "Above 1 a player would stutter"},
         [](F f) { return number(f.clock(f.cell().clock.worst_block)); }},
        {{"repeats", "", Rule::clock, "how many samples the clock took"},
         [](F f) { return count(f.cell().clock.wall.count, f.ran() && f.record.timed()); }},
        {{"machine", "", Rule::clock, "what timed it: costs compare on one kind of machine alone"},
         [](F f) { return f.ran() ? f.cell().clock.stamp.name : std::string(); }},
        {{"load", "", Rule::clock, "of that machine while it did"},
         [](F f) { return f.ran() ? f.cell().clock.stamp.load : std::string(); }},
        {{"governor", "", Rule::clock, "of its processors' clock"},
         [](F f) { return f.ran() ? f.cell().clock.stamp.governor : std::string(); }},
        {{"below_floor", "", Rule::name,
          "the headline errors that are no larger than their noise floor: a tie with every other "
          "such cell"},
         [](F f) { return ties_of(f); }},
        {{"floor_{d}", "as the error", Rule::floor, "noise floor of each headline error"},
         [](F f) { return number(f.in(f.record.against.floor)); }},
        {{"energy_residual_per_step", "1", Rule::ledger,
          "how far the energy ledger is from closing, relative to the largest stored energy"},
         [](F f) { return number(f.of(f.summary().energy_residual_per_step)); }},
        {{"energy_residual_accumulated", "1", Rule::ledger, ""},
         [](F f) { return number(f.of(f.summary().energy_residual_accumulated)); }},
        {{"smallest_contact_force", "N", Rule::force, "a negative force pulls"},
         [](F f) { return number(f.of(f.summary().smallest_contact_force)); }},
        {{"deepest_penetration", "m", Rule::depth, "how far the string went into the barrier"},
         [](F f) { return number(f.of(f.summary().deepest_penetration)); }},
        {{"dofs", "", Rule::closed_form, "doubles of state"},
         [](F f) { return count(f.summary().dofs, f.ran()); }},
        {{"state_bytes", "bytes", Rule::closed_form, "the same in bytes"},
         [](F f) { return count(8L * f.summary().dofs, f.ran()); }},
        {{"steps", "", Rule::closed_form, "steps taken"},
         [](F f) { return count(f.summary().steps, f.ran()); }},
        {{"failed_step", "", Rule::step, "where it failed"},
         [](F f) { return count(f.summary().status.step, failed(f)); }},
        {{"failed_at_s", "s", Rule::instant, ""},
         [](F f) { return number(failed(f) ? f.summary().duration : store::nan); }},
        {{"fact_{f}", "", Rule::fact,
          "whatever else the scheme reports of itself (`jvari list facts`)"},
         [](F f) { return number(fact_of(f.summary().facts, f.fact)); }},
        {{"{m}_{t}", "as the error", Rule::error, "each of the errors on each tap"},
         [](F f) { return number(f.in(f.cell().errors)); }},
        {{"floor_{d}_{t}", "as the error", Rule::floor, "the noise floor of each"},
         [](F f) { return number(f.in(f.record.against.floor)); }},
        {{"reference", "", Rule::text, "what the errors are measured against"},
         [](F f) { return f.record.against.reference; }},
        {{"reason", "", Rule::text, "of a refusal or a failure"},
         [](F f) { return f.cell().reason; }},
        {{"certificate_{w}", "1", Rule::motion,
          "the uncertainty of the reference for the scene: the same in every row"},
         [](F f) { return number(f.record.against.trust.of_scene(f.nut(), f.window)); }},
        {{"certificate_{w}_{t}", "1", Rule::motion, "of each tap"},
         [](F f) { return number(f.record.against.trust.of_scene(f.nut(), f.window)); }},
        {{"reference_modes", "", Rule::closed_form, "modes of the reference"},
         [](F f) { return count(f.record.against.modes, f.record.against.modes > 0); }},
        {{"free_from_s", "s", Rule::closed_form,
          "where the windows of the errors begin: the end of the last pluck, 0 without one"},
         [](F f) { return number(free_from(f.job.point->scene)); }},
        {{"reference_horizon_s", "s", Rule::instant,
          "until when the reference stays within 10 % of itself, started a relative 1e-12 apart"},
         [](F f) { return number(horizon_of(f.record.against.floor, f.headline)); }},
        {{"reference_doubling", "", Rule::text, "how far its modes were doubled"},
         [](F f) { return f.record.against.doubling; }},
        {{"{M}", "as the error", Rule::error,
          "the same errors against a reference with as many modes as the scheme, and matched "
          "compliance where that has it: of scheme and "
          "step, without the cut. Empty where no such reference was run"},
         [](F f) { return number(f.in(f.cell().in_model)); }},
        {{"{M}_{t}", "as the error", Rule::error, ""},
         [](F f) { return number(f.in(f.cell().in_model)); }},
        {{"certificate_in_model_{w}", "1", Rule::motion, "how far that reference solves its model"},
         [](F f) { return number(f.record.against.model_trust.in_model(f.nut(), f.window)); }},
        {{"certificate_in_model_{w}_{t}", "1", Rule::motion, ""},
         [](F f) { return number(f.record.against.model_trust.in_model(f.nut(), f.window)); }},
    };
    return all;
}

// error_l2_50ms: error_in_model_l2_50ms; third_octave_db: third_octave_db_in_model.
std::string in_model(const std::string& column) {
    const std::string error = "error_";
    return column.starts_with(error) ? error + "in_model_" + column.substr(error.size())
                                     : column + "_in_model";
}

// What stands in the place of a slot in a declared name, one after the other; "" stands for
// nothing.
struct Slot {
    const char* mark;
    std::size_t Field::*index;
    std::vector<std::string> names;
};
const std::vector<Slot>& slots() {  // but those of a record's taps and facts
    static const std::vector<Slot> all = [] {
        std::vector<Slot> some{{"{m}", &Field::measure, {}},
                               {"{d}", &Field::measure, {}},
                               {"{M}", &Field::measure, {}},
                               {"{w}", &Field::window, {}}};
        for (const Measure& m : measures()) {
            some[0].names.push_back(m.column);
            some[1].names.push_back(m.less_is_better ? m.column : "");
            some[2].names.push_back(in_model(m.column));
        }
        for (const std::string column : trust::Trust::columns)
            some[3].names.push_back(column.substr(std::string("certificate_").size()));
        return some;
    }();
    return all;
}

// Calls each(name, field) for each column that a declaration stands for; of facts and taps those of
// the field's record.
void expand(const std::string& pattern, Field f,
            const std::function<void(const std::string&, const Field&)>& each) {
    const auto with = [&](std::size_t at, const std::string& name) {
        if (!name.empty()) expand(std::string(pattern).replace(at, 3, name), f, each);
    };
    // the tap is in the outer loop: all columns of one stand together
    if (const auto at = pattern.find("{t}"); at != std::string::npos) {
        for (f.tap = 0; f.tap < f.job.point->scene.taps.size(); ++f.tap)
            with(at, f.job.point->scene.taps[f.tap].name);
        return;
    }
    for (const Slot& s : slots())
        if (const auto at = pattern.find(s.mark); at != std::string::npos) {
            for (f.*s.index = 0; f.*s.index < s.names.size(); ++(f.*s.index))
                with(at, s.names[f.*s.index]);
            return;
        }
    const auto at = pattern.find("{f}");
    if (at == std::string::npos) return each(pattern, f);
    for (const Fact& fact : f.summary().facts) with(at, f.fact = fact.name);
}

// What a declaration's name has before its slot for a tap or a fact, with its other slots filled in
// each way.
std::vector<std::string> beginnings(const std::string& pattern) {
    std::vector<std::string> all;
    for (const Slot& s : slots())
        if (const auto at = pattern.find(s.mark); at != std::string::npos)
            for (const std::string& name : s.names)
                if (!name.empty()) all.push_back(std::string(pattern).replace(at, 3, name));
    if (all.empty()) all.push_back(pattern);
    for (std::string& name : all)
        name = name.substr(0, std::min(name.find("{t}"), name.find("{f}")));
    return all;
}
}  // namespace

const std::vector<Column>& columns() {
    static const std::vector<Column> all(declared().begin(), declared().end());
    return all;
}

Rule rule_of(const std::string& column) {
    if (column == "pareto") return Rule::clock;
    if (column == "scene") return Rule::text;
    Rule found = Rule::name;
    std::size_t longest = 0;
    for (const Column& c : columns())
        for (const std::string& begins : beginnings(c.name)) {
            const bool open = begins.ends_with('_');
            if ((open ? column.starts_with(begins) : column == begins) && begins.size() > longest)
                longest = begins.size(), found = c.rule;
        }
    return found;
}

store::Table table_of(const Plan& plan, const std::vector<Record>& records) {
    struct Placed {
        std::size_t rank;  // of the declaration
        std::string name;
    };
    std::vector<Placed> placed;
    std::set<std::string> known;
    std::vector<std::map<std::string, std::string>> values(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        for (std::size_t rank = 0; rank < declared().size(); ++rank) {
            const Declared& d = declared()[rank];
            expand(d.name, {plan.jobs[i], records[i], headline_of(plan.jobs[i].point->scene)},
                   [&](const std::string& name, const Field& f) {
                       if (known.insert(name).second) placed.push_back({rank, name});
                       values[i][name] = d.value(f);
                   });
        }
    std::ranges::stable_sort(placed, {}, &Placed::rank);
    store::Table t{{"cell", "scene"}, {}};
    for (const Job& job : plan.jobs)
        for (const auto& [key, value] : job.point->swept)
            if (t.column(key) < 0) t.columns.push_back(key);
    for (const Placed& p : placed) t.columns.push_back(p.name);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Job& job = plan.jobs[i];
        auto& row = t.rows.emplace_back();
        for (const std::string& name : t.columns) {
            const auto swept =
                std::ranges::find(job.point->swept, name, [](const auto& s) { return s.first; });
            row.push_back(name == "cell"                    ? job.id
                          : name == "scene"                 ? job.point->scene.name
                          : swept != job.point->swept.end() ? swept->second
                                                            : values[i][name]);
        }
    }
    return t;
}

store::Table errors_only(const store::Table& cells) {
    std::vector<std::string> names;
    for (const std::string& name : cells.columns)
        if (rule_of(name) != Rule::clock) names.push_back(name);
    return cells.only(names);
}

store::Table cost_only(const store::Table& cells) {
    std::vector<std::string> names{"cell", "scene", "scheme", "options", "rate", "modes", "status"};
    for (const std::string& name : cells.columns)
        if (rule_of(name) == Rule::clock) names.push_back(name);
    return cells.only(names);
}

store::Table rows_of(const std::string& facet, const Plan& plan,
                     const std::vector<Record>& records) {
    const store::Table cells = table_of(plan, records);
    std::vector<std::string> names(cells.columns.begin(),
                                   cells.columns.begin() + cells.column("options") + 1);
    names.insert(names.end(), {"rate", "modes"});
    store::Table t = cells.only(names);
    t.rows.clear();
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto own = records[i].rows.find(facet);
        if (own == records[i].rows.end()) continue;
        if (t.columns.size() == names.size())
            t.columns.insert(t.columns.end(), own->second.columns.begin(),
                             own->second.columns.end());
        std::vector<std::string> who;
        for (const std::string& name : names) who.push_back(cells.at(i, name));
        for (const auto& fields : own->second.rows) {
            t.rows.push_back(who);
            t.rows.back().insert(t.rows.back().end(), fields.begin(), fields.end());
        }
    }
    return t;
}

}  // namespace jvari::bench::study
