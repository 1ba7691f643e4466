#include <fmt/core.h>

#include <exception>
#include <string_view>

#include "bench/check/promise.hpp"
#include "bench/check/scenes.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

namespace {
using enum Asked;
constexpr Promise all[] = {
    {"NameWhatIsMissing", "refuses what it does not represent, and names what is missing",
     on_other_scenes, refusals_name_what_is_missing},
    {"ItRunsAScene", "runs a scene for each feature that it declares", once, runs_a_scene},
    {"ItHeedsEveryFeatureThatItDoesNotCallApproximated",
     "heeds each feature that it does not call approximated", once, heeds_every_feature},
    {"StartsFromTheScenesShape", "starts from the scene's shape", on_represented_scenes,
     starts_from_the_scenes_shape},
    {"StartsWithoutContactForces", "starts without contact forces", on_represented_scenes,
     starts_without_contact_forces},
    {"StartsAnewAfterAReset", "starts anew after a reset", on_represented_scenes,
     starts_anew_after_a_reset},
    {"GivesNumbersToTheLastRow", "gives numbers to the last row", on_represented_scenes,
     gives_numbers},
    {"GivesTheSameBitsWhateverTheBlockSize", "gives the same bits whatever the block size",
     on_represented_scenes, same_bits_whatever_the_block},
    {"GivesTheSameBitsWithItsEnergyProbed", "gives the same bits with its energy probed",
     on_represented_scenes, same_bits_with_energy_probed},
    {"KeepsItsEnergyLedgerInEveryRow", "keeps its energy ledger in every row",
     on_represented_scenes, keeps_its_ledger_in_every_row},
    {"KeepsItsEnergyLedgerInSum", "keeps its energy ledger in sum", on_represented_scenes,
     keeps_its_ledger_in_sum},
    {"StoresNoNegativeEnergyAndDissipates", "stores no negative energy and dissipates",
     on_represented_scenes, stores_no_negative_energy},
    {"AllocatesNothingWhileStepping", "allocates nothing while stepping", on_represented_scenes,
     allocates_nothing},
    {"CarriesNoMoreStateThanTheSceneNeeds", "carries no more state than the scene needs",
     on_represented_scenes, carries_no_more_state},
    {"NeverPulls", "never pulls the string towards an obstacle", on_represented_scenes,
     never_pulls},
    {"FactsAgreeWithItsRows", "says of its contact forces what its rows say", on_represented_scenes,
     facts_agree_with_its_rows},
    {"PartialsAreWhereItsOwnRelationSays", "sounds the partials that its own relation gives",
     once_all_others_are_kept, partials_are_its_own_relations},
    {"ConvergesToTheReference",
     "comes nearer to the reference with the rate, in every tap on three scenes",
     once_all_others_are_kept, converges_to_the_reference},
    {"StaysSoundOverAMap", "neither diverges nor gains energy at 20 points of a map",
     once_all_others_are_kept, stays_sound_over_a_map},
    {"WritesEachRowAtItsInstant", "writes each row at its instant, to a tenth of a step",
     once_all_before_are_kept, writes_rows_at_their_instants},
    {"FeelsEveryNumber", "answers a change of each number of a scene as the reference does",
     once_all_before_are_kept, feels_every_number},
};

// The one list of what is known to be broken.
constexpr Excuse known[] = {
    {"modal_generalised_alpha", "CarriesNoMoreStateThanTheSceneNeeds",
     "the method's own: it carries each mode's acceleration beside displacement and velocity"}};
Verdict excused(const Promise& p, const Case& c, Verdict v) {
    if (v.broken())
        for (const Excuse& e : known)
            if (c.scheme.name == std::string(e.scheme) && p.name == std::string(e.promise))
                return {Verdict::Answer::excused, v.why + " (" + e.why + ")"};
    return v;
}
}  // namespace

std::span<const Promise> promises() { return all; }
std::span<const Excuse> excuses() { return known; }

Verdict kept(std::string found) { return {Verdict::Answer::kept, std::move(found)}; }
Verdict broken(std::string found) { return {Verdict::Answer::broken, std::move(found)}; }
Verdict not_asked(std::string why) { return {Verdict::Answer::not_asked, std::move(why)}; }
const char* name_of(Verdict::Answer a) {
    constexpr const char* names[] = {"kept", "broken", "excused", "not asked"};
    return names[static_cast<int>(a)];
}

Settings settings_for(const Descriptor& d, const Scene& scene) {
    Settings s{4 * contract_tap_rate, contract_tap_rate, contract_modes, {}};
    if (d.clock == Clock::continuous && needed_by(scene).any(any_profile) && declares(d, "nodes"))
        // points on the profile: what is owed does not depend on them
        s.options = {{"nodes", "6"}};
    if (declares(d, "cells")) s.options = {{"cells", "64"}};  // of a lattice of its own
    return s;
}

bool is_called(const Descriptor& d) { return std::string_view(d.untimed).starts_with("external"); }

bool takes(const Descriptor& d, const Scene& scene, const Settings& settings) {
    try {
        if (!represents(d, scene)) return false;
        const auto scheme = make_scheme(d, scene, settings);
        if (is_called(d)) run(*scheme, scene, settings);
        return true;
    } catch (const Refusal&) {
        return false;
    } catch (const BadScene&) {  // one made here that cannot be
        return false;
    }
}

Run fresh(const Case& c, const RunOptions& options) {
    return run(*make_scheme(c.scheme, c.scene, c.settings), c.scene, c.settings, options);
}

std::vector<Case> cases_of(const Descriptor& d, Asked asked) {
    if (asked == once || asked == once_all_others_are_kept || asked == once_all_before_are_kept)
        return {{d, {}, {}}};
    std::vector<Case> cases;
    for (const Scene& scene : contract_scenes())
        if (represents(d, scene) == (asked == on_represented_scenes))
            cases.push_back({d, scene, settings_for(d, scene)});
    return cases;
}

Verdict ask(const Promise& p, const Case& c) {
    try {
        if (p.asked == on_represented_scenes) try {
                make_scheme(c.scheme, c.scene, c.settings);
            } catch (const Refusal& refusal) {
                const std::string said = refusal.what();
                return said.size() > 20 ? not_asked("refuses it: " + said)
                                        : broken("refuses the scene without a sentence: " + said);
            } catch (const BadScene& e) { return not_asked(e.what()); }
        return excused(p, c, p.of(c));
    } catch (const Refusal& refusal) {
        return is_called(c.scheme)
                   ? not_asked(std::string("refuses it: ") + refusal.what())
                   : broken(fmt::format("refuses the scene after it was made: {}", refusal.what()));
    } catch (const std::exception& e) {
        return broken(fmt::format("it throws: {}", e.what()));
    } catch (...) { return broken("it throws something that is no std::exception"); }
}

}  // namespace jvari::bench::check
