// Numbers of modes. By default every cell has the modes below 20 kHz and below half the lowest
// rate, and the reference starts from the same number. If no mode lies below 20 kHz, the lowest
// rate limits the number. variants.cpp adds further numbers. Several strings each have their modes
// below 20 kHz.
//
// Two kinds of schemes take other numbers. A grid takes its nodes from the rate. A scheme whose
// contact points are nodes of its modes may need more modes; a note says so.
#include "bench/compare/compare_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/compare/scene_notes.hpp"
#include "bench/study/cell.hpp"
#include "scenes/modes.hpp"
#include "schemes/controls.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::compare {

void require_rows(const Scene& scene, const Settings& settings) {
    if (scene.duration * settings.tap_rate * static_cast<double>(scene.taps.size() + 3) > 1e9)
        throw store::UsageError(fmt::format("{} s at {} rows a second do not fit in memory",
                                            scene.duration, settings.tap_rate));
    rows_of(scene, settings);  // throws if the scene has no rows
}

namespace {
// Splits a request into groups of rates that have rows in common.
std::vector<CompareRequest> with_common_rows(const CompareRequest& r) {
    std::vector<double> left = r.rates;
    std::ranges::sort(left);
    if (r.tap_rate || left.empty()) return {r};
    std::vector<CompareRequest> all;
    while (!left.empty()) {
        const double rows = whole_multiple(left.front(), 44100) ? 44100 : left.front();
        const auto others = std::stable_partition(
            left.begin(), left.end(), [rows](double rate) { return whole_multiple(rate, rows); });
        all.push_back(r);
        all.back().rates.assign(left.begin(), others);
        left.erase(left.begin(), others);
    }
    return all;
}

int modes_for(const CompareRequest& r, const Scene& scene, double lowest_rate) {
    if (!r.modes.empty()) return r.modes.front();
    if (lowest_rate >= 40e3) {
        if (scene.strings.size() != 1) return 0;
        const int heard = modes_below(scene.strings.front(), 20e3);
        return heard > 0 ? heard : study::modes_held(scene.strings.front(), lowest_rate);
    }
    int fewest = 0;
    for (const String& s : scene.strings) {
        const int n = modes_below(s, 0.5 * lowest_rate);
        fewest = fewest == 0 ? n : std::min(fewest, n);
    }
    return fewest;
}

struct SchemeSize {
    bool refused = false;
    int modes = 0;     // 0: a grid, or unknown
    int contacts = 0;  // number of contact points
};
SchemeSize size_of(const Descriptor& d, const Scene& scene, const Settings& settings) {
    try {
        const auto scheme = make_scheme(d, scene, settings);
        const std::vector<Fact> facts = scheme->facts();
        const auto count = [&facts](const char* name) {
            const double n = fact_of(facts, name);
            return n > 0 ? static_cast<int>(n) : 0;
        };
        return {false, count("interior_nodes"), count("contact_points")};
    } catch (const std::exception&) {  // the cell will give the reason
        return {true};
    }
}

void note(study::Plan& plan, const std::string& text) {
    if (std::ranges::find(plan.notes, text) == plan.notes.end()) plan.notes.push_back(text);
}

// Number of modes for a scheme: the common number, or 0 (the scheme's default) if the scheme has to
// differ. A scheme has to if its contact points are nodes of its modes, and the common number gives
// fewer such points or none.
int modes_of(const Descriptor& d, const Scene& scene, const CompareRequest& r, Settings settings,
             study::Plan& plan) {
    const int all = settings.modes;
    const bool contact = std::any_of(scene.strings.begin(), scene.strings.end(),
                                     [](const String& s) { return s.has_contacts(); });
    if (!r.modes.empty() || all == 0 || !contact) return all;
    const SchemeSize equal = size_of(d, scene, settings);
    if (equal.modes == 0 && !equal.refused) return all;
    settings.modes = 0;
    const SchemeSize own = size_of(d, scene, settings);
    if (own.refused || own.modes == 0 || own.modes == all ||
        (!equal.refused && equal.contacts >= own.contacts))
        return all;
    note(plan, fmt::format("{} carries {} modes on scene {}, reference and other schemes {}: its "
                           "points of contact are nodes of its modes, "
                           "and it needs as many; --modes sets one number for all",
                           d.name, own.modes, scene.name, all));
    return 0;
}

// References with the options requested for them.
std::vector<study::ReferenceChoice> references_for(const CompareRequest& r,
                                                   const Catalogue& catalogue, const Scene& scene,
                                                   const Settings& at_highest,
                                                   const Descriptor& first_scheme,
                                                   std::vector<bool>& used) {
    std::vector<study::ReferenceChoice> choices = study::references_of(
        scene, at_highest, r.reference.empty() ? nullptr : &catalogue.find(r.reference),
        &first_scheme);
    for (study::ReferenceChoice& c : choices)
        for (std::size_t k = 0; k < r.options.size(); ++k)
            if (const SchemeOption& o = r.options[k]; o.scheme == c.scheme->name) {
                if (std::ranges::find(c.settings.options, o.name,
                                      [](auto& x) { return x.first; }) != c.settings.options.end())
                    throw store::UsageError(fmt::format(
                        "--option {}:{}: found more than once, and the reference takes one value",
                        o.scheme, o.name));
                c.settings.options.emplace_back(o.name, o.value);
                used[k] = true;
            }
    return choices;
}

std::vector<double> rates_of(const CompareRequest& r) {
    std::vector<double> rates = r.rates;
    if (rates.empty())
        for (int multiple : {1, 2, 4, 8, 16, 32, 64}) rates.push_back(44100.0 * multiple);
    std::sort(rates.begin(), rates.end());
    rates.erase(std::unique(rates.begin(), rates.end()), rates.end());
    return rates;
}

// Settings at the highest rate, with the common number of modes. Throws if the scene has nothing to
// compare, or too much.
Settings settings_of(const CompareRequest& r, const Scene& scene,
                     const std::vector<double>& rates) {
    tap_named(scene, "");
    Settings settings;
    settings.tap_rate = tap_rate_for(r, rates);
    settings.modes = modes_for(r, scene, rates.front());
    settings.sample_rate = rates.back();
    require_rows(scene, settings);
    return settings;
}

// Adds the cells for one form of a scheme: all numbers of modes, each at the possible rates.
void add_cells(study::Plan& into, study::Job job, const CompareRequest& r, const Descriptor& d,
               Settings settings, const Form& form) {
    const Scene& scene = job.point->scene;
    Settings at_lowest = settings;
    at_lowest.sample_rate = form.rates.front();
    if (d.clock != Clock::continuous) settings.modes = modes_of(d, scene, r, at_lowest, into);
    if (has_own_grid(d) && !r.modes.empty())
        note(into, grid_text(d, fmt::format("{}", fmt::join(r.modes, ","))));
    for (const Rung& rung : rungs_of(r, d, scene, settings, form.rates))
        for (const double rate : rung.rates) {
            job.cell = {&d, settings};
            job.cell.settings.modes = rung.modes;
            job.cell.settings.sample_rate = rate;
            job.cell.added = rung.added;
            job.cell.searched = r.search && rate > 0 && (rung.added || r.rates.empty());
            into.jobs.push_back(job);
        }
}

// Adds a point for rates with common rows; false if all its schemes are already on the point
// before.
bool add_point(study::Plan& into, const CompareRequest& r, const Catalogue& catalogue,
               const study::Point& common, study::Job job, bool first) {
    const std::vector<double> rates = rates_of(r);
    Settings settings = settings_of(r, common.scene, rates);
    std::vector<bool> used(r.options.size(), false);
    const auto schemes = schemes_for(r, catalogue, common.scene);
    study::Point& point = into.points.emplace_back(common);
    point.references = references_for(r, catalogue, common.scene, settings, *schemes.front(), used);
    point.truth_modes = r.reference_modes;
    job.point = &point;
    Untried untried;
    const std::size_t before = into.jobs.size();
    for (const Descriptor* d : schemes) {
        const bool stepped = d->clock != Clock::continuous;
        for (const Form& form :
             forms_of(r, *d, common.scene, settings, stepped ? rates : std::vector<double>{0.0},
                      used, untried)) {
            settings.options = form.options;
            if (stepped || first) add_cells(into, job, r, *d, settings, form);
        }
    }
    for (const std::string& text : untried.notes()) note(into, text);
    must_be_used(r.options, used);
    if (into.jobs.size() > before) return true;
    into.points.pop_back();
    return false;
}
}  // namespace

std::vector<const Descriptor*> schemes_for(const CompareRequest& r, const Catalogue& catalogue,
                                           const Scene& scene) {
    std::vector<const Descriptor*> chosen;
    for (const std::string& name : r.schemes) {
        const Descriptor* d = &catalogue.find(name);
        if (std::find(chosen.begin(), chosen.end(), d) == chosen.end()) chosen.push_back(d);
    }
    if (!r.schemes.empty()) return chosen;
    for (const Descriptor* d : catalogue.schemes)
        if (represents(*d, scene) && (r.controls || !left_out_unasked(*d, scene)))
            chosen.push_back(d);
    if (chosen.empty())
        throw Refusal("no scheme represents scene " + scene.name + ": it needs " +
                      names_of(needed_by(scene)));
    return chosen;
}

double tap_rate_for(const CompareRequest& r, const std::vector<double>& rates) {
    if (r.tap_rate) return *r.tap_rate;
    const auto divides_all = [&rates](double f) {
        return std::all_of(rates.begin(), rates.end(),
                           [f](double rate) { return whole_multiple(rate, f); });
    };
    const double lowest = *std::min_element(rates.begin(), rates.end());
    if (divides_all(44100)) return 44100;
    if (divides_all(lowest)) return lowest;
    throw store::UsageError(fmt::format(
        "--rates: neither 44100 nor {} divides all of them; say --tap-rate HZ", lowest));
}

void add_jobs(study::Plan& into, const CompareRequest& r, const Catalogue& catalogue,
              const study::Point& common, const study::Job& like) {
    std::vector<double> kinds;  // row rates
    for (const CompareRequest& part : with_common_rows(r))
        if (add_point(into, part, catalogue, common, like, kinds.empty()))
            kinds.push_back(into.points.back().references.front().settings.tap_rate);
    if (kinds.size() > 1)
        note(into, fmt::format("rates of {} rows a second: each kind has rows and a run of the "
                               "reference of its own, for they have no rows "
                               "in common. Nothing is resampled",
                               fmt::join(kinds, " and ")));
}

std::vector<study::ReferenceChoice> references_of(const CompareRequest& r,
                                                  const Catalogue& catalogue, const Scene& scene) {
    std::vector<bool> used(r.options.size(), false);
    return references_for(r, catalogue, scene, settings_of(r, scene, rates_of(r)),
                          *schemes_for(r, catalogue, scene).front(), used);
}

}  // namespace jvari::bench::compare
