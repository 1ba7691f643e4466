// JUnit XML: the schema that continuous integration reads, https://github.com/testmoapp/junitxml.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "bench/check/promise.hpp"
#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

namespace {
using enum Scope;
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
    {"IsOneMotionInAllUnits", "gives the same motion in other units of mass, length and time",
     on_represented_scenes, is_one_motion_in_all_units},
    {"PartialsAreWhereItsOwnRelationSays", "sounds the partials that its own relation gives",
     once_all_others_are_kept, partials_are_its_own_relations},
    {"StoresTheEnergyOfTheScene", "stores the energy of the scene, at its start and as it decays",
     once_all_others_are_kept, stores_the_energy_of_the_scene},
    {"PlaysLaterAsAtOnce", "plays a pluck after a second as it plays one at once",
     once_all_others_are_kept, plays_later_as_at_once},
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

// All known breaks.
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

Verdict kept(std::string figure) { return {Verdict::Answer::kept, std::move(figure)}; }
Verdict broken(std::string fault) { return {Verdict::Answer::broken, std::move(fault)}; }
Verdict not_asked(std::string why) { return {Verdict::Answer::not_asked, std::move(why)}; }
const char* name_of(Verdict::Answer a) {
    constexpr const char* names[] = {"kept", "broken", "excused", "not asked"};
    return names[static_cast<int>(a)];
}

Settings settings_for(const Descriptor& d, const Scene& scene) {
    Settings s{4 * contract_tap_rate, contract_tap_rate, contract_modes, {}};
    // Slow references get few modes, and few points on a profile: the promises need no more.
    if (declares(d, "rtol")) s.modes = modes_of_an_integrator;
    if (d.clock == Clock::continuous && needed_by(scene).any(any_profile) && declares(d, "nodes"))
        s.options = {{"nodes", "6"}};
    if (declares(d, "cells")) s.options = {{"cells", "64"}};  // cells in a lattice of its own
    return s;
}

bool takes(const Descriptor& d, const Scene& scene, const Settings& settings) {
    try {
        if (!represents(d, scene)) return false;
        const auto scheme = make_scheme(d, scene, settings);
        if (judge::is_external(d)) run(*scheme, scene, settings);
        return true;
    } catch (const Refusal&) {
        return false;
    } catch (const BadScene&) {  // a scene made here may be invalid
        return false;
    }
}

Run fresh(const Case& c, const RunOptions& options) {
    return run(*make_scheme(c.scheme, c.scene, c.settings), c.scene, c.settings, options);
}

std::vector<Case> cases_of(const Descriptor& d, Scope scope) {
    if (scope == once || scope == once_all_others_are_kept || scope == once_all_before_are_kept)
        return {{d, {}, {}}};
    std::vector<Case> cases;
    for (const Scene& scene : contract_scenes())
        if (represents(d, scene) == (scope == on_represented_scenes))
            cases.push_back({d, scene, settings_for(d, scene)});
    return cases;
}

Verdict verdict_on(const Promise& p, const Case& c) {
    try {
        if (p.scope == on_represented_scenes) try {
                make_scheme(c.scheme, c.scene, c.settings);
            } catch (const Refusal& refusal) {
                const std::string sentence = refusal.what();
                return sentence.size() > 20
                           ? not_asked("refuses it: " + sentence)
                           : broken("refuses the scene without a sentence: " + sentence);
            } catch (const BadScene& e) { return not_asked(e.what()); }
        return excused(p, c, p.of(c));
    } catch (const Refusal& refusal) {
        return judge::is_external(c.scheme)
                   ? not_asked(std::string("refuses it: ") + refusal.what())
                   : broken(fmt::format("refuses the scene after it was made: {}", refusal.what()));
    } catch (const std::exception& e) {
        return broken(fmt::format("it throws: {}", e.what()));
    } catch (...) { return broken("it throws something that is no std::exception"); }
}

namespace {
using Json = nlohmann::ordered_json;
using Answer = Verdict::Answer;

bool named(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

struct Count {
    int kept = 0, broken = 0, excused = 0, not_asked = 0;
    const Answered* first = nullptr;  // first scene with the overall answer, else the first scene
    std::map<std::string, int> unasked{};  // number of scenes for each reason
    // Returns the most frequent reason.
    std::string why_not_asked() const {
        const auto most = std::ranges::max_element(unasked, {}, [](auto& r) { return r.second; });
        return most == unasked.end() ? "it represents no scene of it" : most->first;
    }
    Answer answer() const {
        return broken > 0    ? Answer::broken
               : excused > 0 ? Answer::excused
               : kept > 0    ? Answer::kept
                             : Answer::not_asked;
    }
    int& of(Answer a) {
        return a == Answer::broken    ? broken
               : a == Answer::excused ? excused
               : a == Answer::kept    ? kept
                                      : not_asked;
    }
};
Count count_of(const Checked& c, const Promise& p) {
    Count n;
    for (const Answered& a : c.answers) {
        if (a.promise != &p) continue;
        if (a.verdict.answer == Answer::not_asked) ++n.unasked[a.verdict.why];
        if (++n.of(a.verdict.answer) == 1 && (!n.first || a.verdict.answer == n.answer()))
            n.first = &a;
    }
    return n;
}

std::string scenes_text(const Count& n) {
    if (!n.first || n.first->scene.empty()) return "";
    const int bad = n.broken + n.excused;  // one scheme has only one of the two kinds
    return bad > 0 ? fmt::format("{} of {} scenes", bad, bad + n.kept)
                   : fmt::format("{} scenes", n.kept);
}
}  // namespace

bool Checked::broken() const {
    return std::any_of(answers.begin(), answers.end(),
                       [](const Answered& a) { return a.verdict.broken(); });
}

namespace {
// Throws UsageError for an unknown name.
void must_be(const char* what, const std::vector<std::string>& names, const auto& all) {
    std::vector<std::string> known;
    for (const auto& one : all) known.emplace_back(one.name);
    for (const std::string& name : names)
        if (!named(known, name)) throw store::UsageError(store::unknown(what, name, known));
}
}  // namespace

void must_exist(const Asked& selection) {
    must_be("promise", selection.promises, promises());
    if (!selection.scenes.empty()) must_be("scene of a check", selection.scenes, contract_scenes());
}

Checked check(const Descriptor& d, const Asked& selection, const store::Listener& listener,
              const std::function<void(const Checked&, const Promise&)>& answered) {
    Checked c{d.name, d.source, {}, {}};
    const auto progress = listener.begin(std::string("check ") + d.name);
    double done = 0;
    std::string broken, claim_broken;  // first broken promise, and first broken claim
    for (const Promise& p : promises()) {
        if (!selection.promises.empty() && !named(selection.promises, p.name)) continue;
        auto cases = cases_of(d, p.scope);
        if (!selection.scenes.empty()) {
            std::erase_if(cases,
                          [&](const Case& k) { return !named(selection.scenes, k.scene.name); });
            if (cases.empty()) continue;
        }
        c.examined.push_back(&p);
        // Each run of an external program needs a process and a file.
        const bool too_many =
            selection.promises.empty() && judge::is_external(d) && p.of == feels_every_number;
        const bool last = p.scope == Scope::once_all_before_are_kept,
                   claim = last || p.scope == Scope::once_all_others_are_kept;
        const std::string& rests_on = last && broken.empty() ? claim_broken : broken;
        for (const Case& one : cases) {
            progress->show(done / promises().size(), p.name);
            const auto start = std::chrono::steady_clock::now();
            Verdict verdict = claim && !rests_on.empty() ? not_asked("it rests on " + rests_on)
                              : too_many
                                  ? not_asked(fmt::format(
                                        "hundreds of calls of the program, by --only {}", p.name))
                                  : verdict_on(p, one);
            std::string& first = claim ? claim_broken : broken;
            if (first.empty() && verdict.broken()) first = p.name;
            const double seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            c.answers.push_back({&p, one.scene.name, std::move(verdict), seconds});
            done += 1.0 / cases.size();
        }
        if (answered) answered(c, p);
    }
    if (c.examined.empty())
        throw store::UsageError(fmt::format(
            "check {}: found no promise of these that is examined on these scenes", d.name));
    return c;
}

std::string line_of(const Checked& c, const Promise& p) {
    const Count n = count_of(c, p);
    const bool tells = n.first && n.answer() == n.first->verdict.answer &&
                       !n.first->verdict.why.empty() &&
                       (n.answer() != Answer::kept || n.first->scene.empty());
    const std::string where =
        tells && !n.first->scene.empty() && n.broken + n.excused > 0 ? n.first->scene + ": " : "";
    const std::string scenes = scenes_text(n);
    return fmt::format("  {:<9}  {:<48}  {}{}{}", n.broken > 0 ? "BROKEN" : name_of(n.answer()),
                       p.name, scenes, tells && !scenes.empty() ? "; " : "",
                       tells ? where + n.first->verdict.why : "");
}

std::string conclusion_of(const Checked& c) {
    std::map<Answer, int> number;
    std::string excused;
    std::vector<std::string> reasons;
    for (const Promise* p : c.examined) {
        const Count n = count_of(c, *p);
        ++number[n.answer()];
        if (n.excused > 0) excused += (excused.empty() ? "" : ", ") + std::string(p->name);
        if (n.answer() != Answer::not_asked) continue;
        if (std::ranges::find(reasons, n.why_not_asked()) == reasons.end())
            reasons.push_back(n.why_not_asked());
    }
    std::string text =
        number[Answer::broken] > 0
            ? fmt::format("  breaks {} of {} promises", number[Answer::broken], c.examined.size())
        : number[Answer::kept] + number[Answer::excused] > 0 ? "  keeps what it promises"
                                                             : "  nothing could be asked of it";
    if (!excused.empty()) text += ", but for what it is known to break: " + excused;
    std::string counts;
    for (const auto& [answer, count] : number)
        if (count > 0)
            counts +=
                fmt::format("{}{} {}", counts.empty() ? "\n  " : ", ", count, name_of(answer));
    return fmt::format("{}{}{}{}", text, counts, reasons.empty() ? "" : ": ",
                       fmt::join(reasons, "; "));
}

std::string json_of(const std::vector<Checked>& all) {
    Json schemes = Json::array();
    bool any = false;
    for (const Checked& c : all) {
        Json answers = Json::array();
        for (const Answered& a : c.answers)
            answers.push_back({{"promise", a.promise->name},
                               {"scene", a.scene},
                               {"answer", name_of(a.verdict.answer)},
                               {"why", a.verdict.why},
                               {"seconds", a.seconds}});
        Json broken = Json::array(), not_asked = Json::array();
        for (const Promise* p : c.examined) {
            const Count n = count_of(c, *p);
            if (n.broken > 0) broken.push_back(p->name);
            if (n.answer() == Answer::not_asked) not_asked.push_back(p->name);
        }
        any = any || c.broken();
        schemes.push_back({{"scheme", c.scheme},
                           {"source", c.source},
                           {"broken", broken},
                           {"not_asked", not_asked},
                           {"answers", answers}});
    }
    return store::indented({{"status", any ? "broken" : "kept"}, {"schemes", schemes}});
}

std::string junit_of(const std::vector<Checked>& all) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
    for (const Checked& c : all) {
        const auto number = [&c](Answer answer) {
            return std::count_if(c.answers.begin(), c.answers.end(), [answer](const Answered& a) {
                return a.verdict.answer == answer;
            });
        };
        double seconds = 0;
        for (const Answered& a : c.answers) seconds += a.seconds;
        text += fmt::format(
            "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\" "
            "time=\"{:.3f}\">\n",
            store::escaped(c.scheme), c.answers.size(), number(Answer::broken),
            number(Answer::excused) + number(Answer::not_asked), seconds);
        for (const Answered& a : c.answers) {
            text += fmt::format("    <testcase classname=\"{}.{}\" name=\"{}\" time=\"{:.3f}\"",
                                store::escaped(c.scheme), a.promise->name,
                                store::escaped(a.scene.empty() ? a.promise->sentence : a.scene),
                                a.seconds);
            const std::string why = store::escaped(a.verdict.why);
            if (a.verdict.answer == Answer::broken)
                text += fmt::format("><failure message=\"{}\"/></testcase>\n", why);
            else if (a.verdict.answer != Answer::kept)
                text += fmt::format("><skipped message=\"{}\"/></testcase>\n", why);
            else text += "/>\n";
        }
        text += "  </testsuite>\n";
    }
    return text + "</testsuites>\n";
}

}  // namespace jvari::bench::check
