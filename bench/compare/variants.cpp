#include "bench/compare/compare_plan.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/compare/catalogue.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/usage.hpp"
#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double multiples[] = {1.5, 2, 3, 4};  // factors on the default number of modes

std::optional<std::string> refusal_of(const Descriptor& d, const Scene& scene,
                                      const Settings& settings) {
    try {
        make_scheme(d, scene, settings);
        return std::nullopt;
    } catch (const std::exception& e) {  // Refusal, BadScene
        return e.what();
    }
}

// Forms with own and with matched compliance; matched has only the possible rates.
std::vector<Form> both(const Form& form, const Descriptor& d, const Scene& scene, Settings settings,
                       Untried& untried) {
    Form own = form, matched{form.options, {}};
    own.options.emplace_back(compliance_option.name, "own");
    matched.options.emplace_back(compliance_option.name, "matched");
    settings.options = matched.options;
    std::vector<double> refused;
    std::string reason;
    for (const double rate : form.rates) {
        settings.sample_rate = rate;
        const auto why = refusal_of(d, scene, settings);
        (why ? refused : matched.rates).push_back(rate);
        if (why && reason.empty()) reason = *why;
    }
    if (!refused.empty()) untried.add(d, refused, matched.rates.empty(), reason);
    if (matched.rates.empty()) return {form};
    return {own, matched};
}
}  // namespace

bool touched(const Scene& scene) {
    return std::any_of(scene.strings.begin(), scene.strings.end(),
                       [](const String& s) { return s.thread || s.has_contacts(); });
}

bool sets(const OptionValues& values, const Option& option) {
    return std::ranges::any_of(values, [&option](const auto& v) { return v.first == option.name; });
}

std::vector<OptionValues> combinations_of(const std::vector<SchemeOption>& options,
                                          const Descriptor& d, std::vector<bool>& used) {
    std::vector<OptionValues> all{{}};
    const auto takes = [&d](const SchemeOption& o) {
        return o.scheme.empty() ? declares(d, o.name) : o.scheme == d.name;
    };
    for (std::size_t k = 0; k < options.size(); ++k) {
        if (!takes(options[k])) continue;
        const auto same = [&](const SchemeOption& o) {
            return takes(o) && o.name == options[k].name;
        };
        const auto first = std::ranges::find_if(options, same);
        if (first->scheme != options[k].scheme)
            throw store::UsageError(fmt::format(
                "--option {}: found more than once for {}, expected one value or one list",
                first->name, d.name));
        used[k] = true;
        if (&*first != &options[k]) continue;  // done with the first value of the option
        std::vector<OptionValues> more;
        for (const OptionValues& values : all)
            for (const SchemeOption& o : options)
                if (same(o)) more.emplace_back(values).emplace_back(o.name, o.value);
        all = std::move(more);
    }
    return all;
}

void must_be_used(const std::vector<SchemeOption>& options, const std::vector<bool>& used) {
    for (std::size_t k = 0; k < used.size(); ++k)
        if (!used[k])
            throw store::UsageError(
                fmt::format("--option {}{}{}: {}", options[k].scheme,
                            options[k].scheme.empty() ? "" : ":", options[k].name,
                            options[k].scheme.empty() ? "no compared scheme has it"
                                                      : "that scheme is not compared"));
}

void Untried::add(const Descriptor& d, const std::vector<double>& rates, bool at_all,
                  const std::string& reason) {
    std::string who = d.name, why = reason;
    if (!at_all) {
        std::vector<std::string> at;
        for (const double rate : rates) at.push_back(fmt::format("{:.4g}", rate / 1000));
        who += fmt::format(" at {} kHz", fmt::join(at, ", "));
    }
    if (const std::string name = d.name + std::string(": "); why.starts_with(name))
        why.erase(0, name.size());
    std::string& all = who_[why];
    all += (all.empty() ? "" : ", ") + who;
}

std::vector<std::string> Untried::notes() const {
    std::vector<std::string> all;
    for (const auto& [why, who] : who_)
        all.push_back(fmt::format("{}: run as published only, for {}", who, why));
    return all;
}

std::vector<Form> forms_of(const CompareRequest& r, const Descriptor& d, const Scene& scene,
                           const Settings& settings, const std::vector<double>& rates,
                           std::vector<bool>& used, Untried& untried) {
    std::vector<Form> forms;
    for (const OptionValues& values : combinations_of(r.options, d, used))
        forms.push_back({values, rates});
    const bool compliance = sets(forms.front().options, compliance_option);
    const bool measured = std::ranges::any_of(
        scene.strings, [](const String& s) { return modes_measured(s).has_value(); });
    const bool has_both = d.clock != Clock::continuous && declares(d, compliance_option.name) &&
                          touched(scene) && !measured;
    if (!r.search || !r.reference_modes || compliance || !has_both) return forms;
    std::vector<Form> all;
    for (const Form& form : forms)
        for (Form& one : both(form, d, scene, settings, untried)) all.push_back(std::move(one));
    return all;
}

int most_modes_sought(const Scene& scene, int unasked, double rate) {
    int most = static_cast<int>(std::lround(std::end(multiples)[-1] * unasked));
    for (const String& s : scene.strings) most = std::min(most, modes_below(s, 0.5 * rate));
    return std::max(most, unasked);
}

std::vector<Rung> rungs_of(const CompareRequest& r, const Descriptor& d, const Scene& scene,
                           const Settings& settings, const std::vector<double>& rates) {
    std::vector<Rung> rungs;
    for (const int modes : r.modes) rungs.push_back({modes, rates, false});
    if (rungs.size() > 1 && has_own_grid(d)) rungs.resize(1);  // all rungs are the same cell
    if (!rungs.empty()) return rungs;
    rungs.push_back({settings.modes, rates, false});
    // a scheme with its own number, for example with points of contact at its nodes
    const bool its_own = settings.modes == 0 && scene.strings.size() == 1;
    if (!r.search || !r.reference_modes || d.clock == Clock::continuous || its_own) return rungs;
    const int unasked = settings.modes > 0 ? settings.modes : modes_for(scene, settings);
    for (const double multiple : multiples) {
        Rung rung{static_cast<int>(std::lround(multiple * unasked)), {}, true};
        for (const double rate : rates)
            if (rung.modes <= most_modes_sought(scene, unasked, rate)) rung.rates.push_back(rate);
        if (!rung.rates.empty()) rungs.push_back(std::move(rung));
    }
    if (const Settings& near = r.near; near.modes > 0) {
        Rung rung{near.modes, {}, true};
        for (const double rate : rates)
            if (near.sample_rate <= 2 * rate && rate <= 2 * near.sample_rate &&
                std::ranges::all_of(scene.strings, [&](const String& s) {
                    return rung.modes <= modes_below(s, rate / 2);
                }))
                rung.rates.push_back(rate);
        const bool known = std::ranges::find(rungs, rung.modes, &Rung::modes) != rungs.end();
        if (!known && !rung.rates.empty()) rungs.push_back(std::move(rung));
    }
    if (rungs.size() == 1) return rungs;
    Settings at_lowest = settings;
    at_lowest.sample_rate = rungs[1].rates.front();
    if (dofs_with(settings.modes, d, scene, at_lowest) ==
        dofs_with(rungs[1].modes, d, scene, at_lowest))
        rungs.resize(1);
    return rungs;
}

}  // namespace jvari::bench::compare
