#include "random_checks.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "analysis/energy.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/certificate_library.hpp"
#include "bench/study/judgement.hpp"
#include "bench/study/run.hpp"
#include "reference/oversampled.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari::test {

namespace {
namespace study = bench::study;

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string text(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g", x);
    return buffer;
}

// k eta^a (1 + beta eta') is negative where the string leaves fast enough
bool pulls_by_law(const Scene& scene) { return needed_by(scene).has(Feature::contact_loss); }

Settings settings_for(const Descriptor& d, const RandomCase& c) {
    Settings s = c.settings;
    if (d.clock != Clock::continuous) return s;
    s.sample_rate = 0;
    // what is owed does not depend on them
    if (needed_by(c.scene).has(Feature::profile_barrier)) s.options = {{"nodes", "6"}};
    return s;
}

// ---- One run

void check_ledger(const Descriptor& d, const Trace& t, const Finding& finding) {
    for (const double x : t.energy)
        if (!std::isfinite(x)) return finding(d.name, "an energy that is not finite");
    if (d.balance == Balance::none) return;
    const EnergyBalance b = energy_balance(t);
    const bool exact = d.balance == Balance::exact;
    if (b.step > (exact ? ledger_row : ledger_toleranced))
        finding(d.name, "ledger open by " + text(b.step) + " in row " + std::to_string(b.step_row));
    else if (b.accumulated > (exact ? ledger_sum : ledger_toleranced))
        finding(d.name, "ledger open by " + text(b.accumulated) + " in all");
}

void check_pull(const Descriptor& d, const RandomCase& c, const study::Summary& summary,
                const Trace& t, const Finding& finding) {
    if (pulls_by_law(c.scene)) return;
    double least = summary.smallest_contact_force, most = summary.largest_contact_force;
    for (int k = 0; k < t.taps(); ++k)
        if (c.scene.taps[static_cast<std::size_t>(k)].quantity == Quantity::bridge_force)
            for (const double f : t.column(k))
                most = std::fmax(most, f), least = std::fmin(least, f);
    if (const double pull = study::pull_of(least, most); pull > study::pull_allowed)
        finding(d.name, "contact pulls by " + text(pull) + " of its largest push");
}

// A row of a single contact's force is the mean of what its facts are the extremes of; a reference
// in continuous time interpolates between its steps.
void check_force_facts(const Descriptor& d, const RandomCase& c, const study::Summary& summary,
                       const Trace& t, const Finding& finding) {
    if (c.scene.strings.size() > 1 || c.scene.strings[0].barriers.size() != 1 ||
        std::isnan(summary.largest_contact_force))
        return;
    if (needed_by(c.scene).any(any_profile)) return;
    const double scale = std::max(summary.largest_contact_force, -summary.smallest_contact_force),
                 room = force_facts * scale;
    for (int k = 0; k < t.taps(); ++k) {
        if (c.scene.taps[static_cast<std::size_t>(k)].quantity != Quantity::bridge_force) continue;
        for (const double f : t.column(k))
            if (f > summary.largest_contact_force + room ||
                f < std::min(0.0, summary.smallest_contact_force) - room)
                return finding(d.name, "a row's contact force of " + text(f) +
                                           " N lies outside of its facts, " +
                                           text(summary.smallest_contact_force) + " to " +
                                           text(summary.largest_contact_force) + " N");
    }
}

bool same_bits(const Trace& a, const Trace& b) {
    const long rows = std::min(a.rows, b.rows);
    for (int k = 0; k < a.taps(); ++k)
        if (!std::equal(a.column(k).begin(), a.column(k).begin() + rows, b.column(k).begin()))
            return false;
    for (int k = 0; k < 3 && !a.energy.empty() && !b.energy.empty(); ++k)
        if (!std::equal(a.energy_column(k).begin(), a.energy_column(k).begin() + rows,
                        b.energy_column(k).begin()))
            return false;
    return true;
}

struct PastItsLimit {};
// modes than the truth would take: there is none to hold a certificate against
struct FewerWereMeasured {};

void check_trace(const Descriptor& d, const RandomCase& c, const Settings& settings,
                 const study::Ran& ran, const Finding& finding) {
    const Trace& t = ran.trace;
    const study::Summary& summary = ran.cell.summary;
    const bool ok = summary.status.outcome == Outcome::ok;
    if (t.rows < 0 || t.rows > t.stride || (ok && t.rows != t.stride))
        return finding(d.name,
                       std::to_string(t.rows) + " rows are valid of " + std::to_string(t.stride));
    for (int k = 0; k < t.taps(); ++k)
        for (const double x : t.column(k))
            if (!std::isfinite(x) || (ok && std::abs(x) > largest_value))
                return finding(d.name, "a value of " + text(x) + " is called valid");
    if (ok) {
        check_ledger(d, t, finding);
        check_pull(d, c, summary, t, finding);
        check_force_facts(d, c, summary, t, finding);
    }
    const bool probed = c.seed % 4 == 1;
    const Run again =
        run(d, c.scene, settings, {.energy = probed, .block_rows = probed ? 11 : 1000});
    if (!same_bits(t, again.trace))
        finding(d.name,
                probed ? "the block size changes a bit" : "block size or probe change a bit");
    if (again.status.outcome != summary.status.outcome ||
        again.status.step != summary.status.step || again.trace.rows != t.rows)
        finding(d.name, "block size or probe change the outcome");
}

// A scheme on the scene as a job of a study: judged by nothing but what is looked at here.
//
// The integrator takes steps as short as the fastest decay asks, however slow the motion: under a
// contact loss of 100 s/m that is minutes for a row. It is ended by a limit, and that is no
// finding. No other run has one but that of its scene.
void check_run(const Descriptor& d, const RandomCase& c, Tally& tally, const Finding& finding) {
    study::Plan plan;
    study::Point& point = plan.points.emplace_back();
    point.scene = c.scene;
    study::Job& job = plan.jobs.emplace_back(study::Job{&point, {&d, settings_for(d, c)}});
    job.judged = false;
    if (d.name == std::string("sundials")) job.patience = sundials_seconds;
    job.measure = [&](const study::Ran& ran, study::Record&) {
        check_trace(d, c, job.cell.settings, ran, finding);
    };
    study::References none;
    study::Kept nowhere;
    const study::Cell cell = study::record_of(job, none, nowhere, [](long, long) {})->cell;
    if (cell.failure == "past_time_limit") ++tally.ended;
    else if (cell.failure == "refused") ++tally.refused;
    else if (!cell.ran()) finding(d.name, "throws what is no refusal: " + cell.reason);
    if (!cell.ran()) return;
    ++tally.runs;
    tally.failed += cell.summary.status.outcome != Outcome::ok;
    if (const double took = cell.summary.processor_seconds; took > tally.slowest)
        tally.slowest = took,
        tally.slowest_at = std::string(d.name) + " on seed " + std::to_string(c.seed);
    if (!represents(d, c.scene)) finding(d.name, "runs a scene that it says it cannot represent");
}
}  // namespace

void Tally::add(const Tally& t) {
    scenes += t.scenes, runs += t.runs, ended += t.ended, refused += t.refused, failed += t.failed,
        claims += t.claims;
    estimates += t.estimates, low_estimates += t.low_estimates;
    judged += t.judged;
    harmed += t.harmed;
    worst_claim = std::max(worst_claim, t.worst_claim);
    worst_estimate = std::max(worst_estimate, t.worst_estimate);
    if (t.slowest > slowest) slowest = t.slowest, slowest_at = t.slowest_at;
}

void check_schemes(const RandomCase& c, Tally& tally, const Finding& finding,
                   const std::function<void(const std::string&)>& at) {
    for (const auto& table : {schemes(), std::span(schemes_of_pairings()), references()})
        for (const Descriptor& d : table) {
            at(d.name);
            check_run(d, c, tally, finding);
        }
}

// ---- Certificates

double apart(const Trace& a, const Trace& b, int k, double from) {
    return relative_difference(rows_from(a.column(k), from, a.tap_rate),
                               rows_from(b.column(k), from, b.tap_rate));
}

namespace {
struct Claim {  // of one tap, over the whole run
    std::string tap;
    double is, claimed;
    double ratio() const { return is / claimed; }
};

// What is known of an error against what is claimed of it: the distance from the truth less what
// the truth itself may be off. Figures within the noise floor are left out: no two programs can
// agree better.
std::vector<Claim> claims(const bench::study::Trust& trust, const Trace& trace, const Trace& truth,
                          double from, const std::vector<double>& off,
                          const std::vector<double>& floor, bool about_scene = false) {
    std::vector<Claim> all;
    for (std::size_t k = 0; k < trust.figure.size(); ++k) {
        const double is = apart(trace, truth, static_cast<int>(k), from) - off[k];
        if (const double claimed = about_scene ? trust.of_scene(k, 2) : trust.in_model(k, 2);
            !std::isnan(claimed) && is > floor[k])
            all.push_back({trace.names[k], is, claimed});
    }
    return all;
}

// the floor is of one rounding at the start, a run is made of many
constexpr double above_floor = 3;
constexpr int stand_in_multiple = 64;  // as compare has it
}  // namespace

void check_certificate(const RandomCase& c, Tally& tally, const Finding& finding,
                       const std::function<void(const std::string&)>& at) try {
    const Descriptor* best = best_reference(c.scene);
    const Features needs = needed_by(c.scene);
    if (!best || !needs.has(Feature::lumped_barrier) || needs.has(Feature::profile_barrier)) return;
    at("certificate");
    const double until = std::round(c.scene.duration * c.settings.tap_rate) / c.settings.tap_rate;
    using namespace bench::study;
    const Certificate certificate =
        certify(c.scene, certificate_plan(c.scene, {c.settings.modes, c.settings.tap_rate}));
    const auto with = [&](const char* rtol) {
        return Settings{0, c.settings.tap_rate, certificate.modes, {{"rtol", rtol}}};
    };
    const Settings own{0, c.settings.tap_rate, certificate.modes, {}};
    // finer than any entry of the certificate
    const Run r = run(*best, c.scene, own), truth = run(sundials, c.scene, with("1e-14"));
    // Near its rounding the integrator is no truth to more than this: exact_contact may be nearer
    // to the motion, and claim to be.
    const Run coarser = run(sundials, c.scene, with("1e-13"));
    if (r.status.outcome != Outcome::ok || truth.status.outcome != Outcome::ok ||
        coarser.status.outcome != Outcome::ok)
        return;
    std::vector<double> off, none(r.trace.names.size(), 0.0);
    for (int k = 0; k < r.trace.taps(); ++k)
        off.push_back(apart(coarser.trace, truth.trace, k, certificate.from));
    std::vector<double> floor;
    for (const Agreement& a : certificate.floor)
        floor.push_back(above_floor * std::max(floor_displacement, a.relative_l2.back()));
    const bool alone =
        // certified by another of its own settings, whose error adds to the difference
        best->name == std::string("sundials");
    for (const Claim& x : claims(trust_of(certificate, best->name, {}, until), r.trace, truth.trace,
                                 certificate.from, off, floor)) {
        ++tally.claims;
        tally.worst_claim = std::max(tally.worst_claim, x.ratio());
        if (!(x.ratio() < (alone ? claim_allowed_alone : claim_allowed)))
            finding(best->name,
                    x.tap + ": error " + text(x.is) + ", certified to " + text(x.claimed));
    }
    const Descriptor* scheme = nullptr;
    for (const Descriptor& d : schemes())
        if (const std::string name = d.name;
            !scheme && (name == "modal_two_point" || name == "modal_spatial_newton"))
            if ((needs - d.represents).empty()) scheme = &d;
    if (!scheme) return;
    at(std::string("oversampled ") + scheme->name);
    const Oversampled o = oversampled(
        *scheme, c.scene, {c.settings.tap_rate, c.settings.tap_rate, certificate.modes, {}},
        stand_in_multiple);
    if (o.run.status.outcome != Outcome::ok) return;
    for (const Claim& x : claims(bench::study::trust_of(o, until - certificate.from), o.run.trace,
                                 r.trace, certificate.from, none, floor)) {
        ++tally.estimates;
        tally.low_estimates += x.ratio() >= 1;
        tally.worst_estimate = std::max(tally.worst_estimate, x.ratio());
    }
} catch (const Refusal&) { ++tally.refused; } catch (const std::exception& e) {
    finding("certificate", std::string("throws what is no refusal: ") + e.what());
}

void check_certificate_about_scene(const RandomCase& c, Tally& tally, const Finding& finding,
                                   const std::function<void(const std::string&)>& at) try {
    const Descriptor* best = best_reference(c.scene);
    if (!best) return;
    const double from = cpu_seconds();
    const auto look = [from] {
        if (cpu_seconds() - from > about_scene_seconds) throw PastItsLimit{};
    };
    const bool profile = needed_by(c.scene).has(Feature::profile_barrier);
    struct Ear : bench::store::Listener {
        struct Line : bench::store::Progress {
            std::function<void()> look;
            void show(double, const std::string&) override { look(); }
        };
        std::function<void()> look;
        std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
            auto line = std::make_unique<Line>();
            line->look = look;
            return line;
        }
    } ear;
    ear.look = look;
    at("certificate about the scene");
    using namespace bench::study;
    const Certificate certificate =
        certify(c.scene,
                certificate_plan(
                    c.scene, {std::min(model_modes, modes_for(c.scene, {})), c.settings.tap_rate}),
                ear);
    const auto trust_in = [&](const OptionValues& options) {
        return trust_of(certificate, best->name, options,
                        std::round(c.scene.duration * c.settings.tap_rate) / c.settings.tap_rate);
    };
    const bench::study::Trust trust = trust_in({});
    const auto matching = matched(*best, c.scene, {});
    // there are no more modes than those that were measured
    if (trust.doubled != (profile ? "modes and points" : "modes")) return;
    RunOptions looked_at;
    looked_at.progress = [&](long, long) { look(); };
    const auto larger = [&](int modes, int points, const OptionValues& options) {
        Settings s{0, c.settings.tap_rate, modes * certificate.modes, options};
        if (profile)
            s.options = {
                {nodes_option.name, std::to_string(points * std::stoi(nodes_option.fallback))}};
        try {
            return run(*best, c.scene, s, looked_at);
        } catch (const BadScene&) { throw FewerWereMeasured{}; }
    };
    const OptionValues nearer = matching.value_or(OptionValues{});
    const Run r = larger(1, 1, {}), half = larger(scene_multiple / 2, 2, nearer),
              truth = larger(scene_multiple, 4, nearer);
    for (const Run* each : {&r, &half, &truth})
        if (each->status.outcome != Outcome::ok) return;
    std::vector<double> off, floor;
    const auto norm = [&](const Trace& t, int k) {
        const std::span<const double> x = rows_from(t.column(k), certificate.from, t.tap_rate);
        return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0));
    };
    for (int k = 0; k < r.trace.taps(); ++k)  // relative to the reference, as its certificate is
        off.push_back(apart(half.trace, truth.trace, k, certificate.from) * norm(truth.trace, k) /
                      norm(r.trace, k));
    for (const Agreement& a : certificate.floor)
        floor.push_back(above_floor * std::max(floor_displacement, a.relative_l2.back()));
    ++tally.judged;
    const auto hold = [&](const bench::study::Trust& claimed, const Trace& trace) {
        for (const Claim& x :
             claims(claimed, truth.trace, trace, certificate.from, off, floor, true)) {
            if (!(x.claimed < 1)) continue;  // as large as the motion itself: nothing is claimed
            ++tally.claims;
            tally.worst_claim = std::max(tally.worst_claim, x.ratio());
            if (!(x.ratio() < claim_allowed))
                finding(best->name, x.tap + " of the scene: error " + text(x.is) +
                                        ", certified to " + text(x.claimed));
        }
    };
    hold(trust, r.trace);
    if (matching) hold(trust_in(*matching), larger(1, 1, *matching).trace);
} catch (const PastItsLimit&) { ++tally.ended; } catch (const Refusal&) {
    ++tally.refused;
} catch (const FewerWereMeasured&) { ++tally.refused; } catch (const std::exception& e) {
    finding("certificate about the scene", std::string("throws what is no refusal: ") + e.what());
}

void check_matching(const RandomCase& c, Matching kind, Tally& tally, const Finding& finding,
                    const std::function<void(const std::string&)>& at) try {
    const Descriptor& scheme =
        *std::find_if(schemes().begin(), schemes().end(),
                      [](const Descriptor& d) { return std::string(d.name) == "modal_two_point"; });
    const bool own = kind != Matching::string;  // the truth is no matter of what is looked at
    const int modes = c.settings.modes, multiple = std::clamp(600 / modes, 4, own ? 16 : 8);
    const auto reference = [&](int of_modes) {
        return std::vector<study::ReferenceChoice>{
            {&exact_contact, {0, c.settings.tap_rate, of_modes, {{"compliance", "matched"}}}, ""}};
    };
    study::Plan plan;
    study::Point& point = plan.points.emplace_back();
    point.scene = c.scene;
    point.references = reference(modes * multiple);
    point.truth_modes = std::nullopt;
    point.alone = true;
    point.time_limit = matching_seconds;
    constexpr int rates[] = {1, 4, 16};  // times the tap rate
    for (const int rate : rates)
        for (const char* compliance : {"own", "matched"})
            if (rate <= 4 || kind == Matching::bar)
                plan.jobs.push_back({&point,
                                     {&scheme,
                                      {rate * c.settings.sample_rate,
                                       c.settings.tap_rate,
                                       modes,
                                       {{"compliance", compliance}}}}});
    study::address(plan, "{}");
    study::References references(plan.jobs);
    references.hold(point);
    study::Kept nowhere;
    at(scheme.name);
    const std::vector<study::Record> cells =
        study::run(plan, references, nowhere, 1, bench::store::Listener()).records;
    const study::References::Of known = references.make(point, 1, bench::store::Listener());
    for (const study::Record& r : cells)
        if (r.cell.failure == "past_time_limit") throw PastItsLimit{};
    if (!known.truth) throw Refusal(known.refused);
    const Trace& truth = known.truth->reference.run.trace;
    const study::Errors off =
        study::errors_of(study::run_reference(reference(modes * multiple / 2), c.scene, 1, {},
                                              {matching_seconds}, true)
                             .run.trace,
                         truth, {}, free_from(c.scene));
    for (std::size_t pair = 0; pair < cells.size(); pair += 2) {
        const std::size_t whole = study::measure("error_l2_whole");
        double worst = 0;
        std::string tap;
        if (!cells[pair].cell.ran() || !cells[pair + 1].cell.ran()) {
            ++tally.refused;
            continue;
        }
        ++tally.runs;
        for (std::size_t k = 0; k < off.size(); ++k) {
            const double uncertain = off[k][whole], unmatched = cells[pair].cell.errors[k][whole],
                         error = cells[pair + 1].cell.errors[k][whole],
                         ratio = (error - uncertain) / (unmatched + uncertain);
            if (error > harm_matters && ratio > worst)
                worst = ratio, tap = truth.names[k] + " errs by " + text(error);
        }
        tally.harmed += worst > harm;
        if (worst > harm)
            finding(scheme.name, "matched at " + std::to_string(rates[pair / 2]) +
                                     " times the rate: " + tap + ", " + text(worst) +
                                     " times as much as own");
    }
    ++tally.judged;
} catch (const PastItsLimit&) { ++tally.ended; } catch (const bench::store::PastItsLimit&) {
    ++tally.ended;
} catch (const Refusal&) { ++tally.refused; }

}  // namespace jvari::test
