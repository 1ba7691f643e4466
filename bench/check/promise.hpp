// What every scheme owes the program: the one list of promises. `jvari check` examines one scheme,
// the tests examine all.
//
// A promise is examined on every scene that the scheme represents, on every scene that it does not,
// or once. Claims in numbers rest on all other promises and are examined only where these are kept,
// so a broken promise fails under its own name. The last two rest on the claims before them too: a
// scheme that moves otherwise than the scene is at no instant of it, and answers no number of it.
// tests/contract_plugins has a scheme for each that breaks it and keeps all others.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/dispersion.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/system/listener.hpp"
#include "scenes/scene.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::check {

struct Verdict {
    // excused: broken, as it is known of this scheme
    enum class Answer { kept, broken, excused, not_asked } answer = Answer::kept;
    // what was measured, or why the promise could not be examined
    std::string why;
    bool broken() const { return answer == Answer::broken; }
};
Verdict kept(std::string figure = "");
Verdict broken(std::string fault);
Verdict not_asked(std::string why);
const char* name_of(Verdict::Answer);  // "not asked"

struct Case {  // a scheme, a scene, and the settings of its run
    Descriptor scheme;
    Scene scene;
    Settings settings;
};

enum class Scope {
    on_represented_scenes,
    on_other_scenes,
    once,
    once_all_others_are_kept,
    once_all_before_are_kept
};

struct Promise {
    const char* name;      // "AllocatesNothingWhileStepping"
    const char* sentence;  // what a scheme does that keeps it: "allocates nothing while stepping"
    Scope scope;
    Verdict (*of)(const Case&);  // the case has no scene where the promise is examined once
};
std::span<const Promise> promises();  // in the order in which they are best read

// A scheme of this tree that is known to break a promise: a control, which a comparison has to
// find.
struct Excuse {
    const char *scheme, *promise, *why;
};
std::span<const Excuse> excuses();

std::vector<Case> cases_of(const Descriptor&, Scope);

// Never throws: what the scheme throws breaks the promise. A scene that the scheme refuses for a
// reason of its own gives `not_asked`. A known break (Excuse) gives `excused`.
Verdict verdict_on(const Promise&, const Case&);

// ---- One function for each promise, and what several of them need.

// Refusals and declarations: declared.cpp.
Verdict refusals_name_what_is_missing(const Case&);
Verdict runs_a_scene(const Case&);
Verdict heeds_every_feature(const Case&);

// On a scene: stepping.cpp, rows.cpp.
Verdict allocates_nothing(const Case&);
Verdict gives_numbers(const Case&);
Verdict same_bits_whatever_the_block(const Case&);
Verdict same_bits_with_energy_probed(const Case&);
Verdict starts_anew_after_a_reset(const Case&);
Verdict keeps_its_ledger_in_every_row(const Case&);
Verdict keeps_its_ledger_in_sum(const Case&);
Verdict stores_no_negative_energy(const Case&);
Verdict starts_from_the_scenes_shape(const Case&);
Verdict starts_without_contact_forces(const Case&);
Verdict carries_no_more_state(const Case&);
Verdict never_pulls(const Case&);
Verdict facts_agree_with_its_rows(const Case&);

// Changes of a scene that leave its motion as it is: symmetries.cpp.
Verdict is_one_motion_in_all_units(const Case&);
Verdict plays_later_as_at_once(const Case&);

// Numerical claims of a scheme as a whole: claims.cpp, against_references.cpp.
Verdict stores_the_energy_of_the_scene(const Case&);
Verdict partials_are_its_own_relations(const Case&);
Verdict writes_rows_at_their_instants(const Case&);
Verdict converges_to_the_reference(const Case&);
Verdict feels_every_number(const Case&);
Verdict stays_sound_over_a_map(const Case&);

Settings settings_for(const Descriptor&, const Scene&);
// it represents it, and approximates nothing of it
bool is_as_the_scene_says(const Descriptor&, const Scene&);
// it touches a profile at as many points as its option `points` says, where a reference has `nodes`
bool has_points_for_a_profile(const Descriptor&);
// a program by files: of it only rows are known, and it refuses when it runs
bool is_called(const Descriptor&);
constexpr const char* in_a_process = "it runs in a process of its own, and gives rows alone";
bool takes(const Descriptor&, const Scene&, const Settings&);  // false where it refuses
Run fresh(const Case&, const RunOptions&);                     // of a scheme made for it

// Of a run whose rows are its steps: the scheme's own partials (Scheme::free_modes), and where the
// matrix pencil of analysis/dispersion.hpp hears them in a tap. Silent ones are left out.
struct HeardPartial {
    int mode;
    FreeMode own;
    Partial heard;
};
std::vector<HeardPartial> heard_partials(const Descriptor&, const Scene&, const Settings&, int tap);

// ---- The scenes on which promises are examined

// The C3 string of van Walstijn, Bridges & Mehes 2016, Table 1: alone and at rest, with taps at its
// nut and at 0.3 m.
Scene string_at_rest();

constexpr double contract_tap_rate = 44100;  // [Hz]
constexpr int contract_modes = 40, modes_of_an_integrator = 12;
constexpr long contract_rows = 96;
constexpr double what_modes_leave_out = 5e-5;  // of the whole string, which a grid nears
constexpr double what_nodes_leave_out = 1e-2;  // of a force on a profile, at any rate

// the library and a few made here, of contract_rows, or until they touch; read once
const std::vector<Scene>& contract_scenes();

// Test scenes with this feature and displacement taps: two minimal strings, then every contract
// scene, the feature added where it is missing.
std::vector<Scene> scenes_with(Feature);

// Short and smooth scenes that together have every number of a scene, each large enough to change
// the taps.
const std::vector<Scene>& scenes_of_numbers();

// As far as a scheme represents it without an approximation but the points of a profile.
Scene as_far_as(const Descriptor&, Scene);

// With its tables as files of that folder, the last ones written over: a plugin reads the scene
// again from its text.
Scene in_files(Scene, const std::filesystem::path& folder);

// The same scene with this one feature otherwise: another value of it, or none. A scheme that heeds
// the feature tells the two apart.
std::vector<Scene> otherwise(const Scene&, Feature);

// ---- The numbers of a scene, from the schema of scene files, which a new key of it joins

struct Changed {
    std::string key;  // "string.0.barrier.1.height"
    Scene scene;
};

// The scene with its number `which` changed by a tenth, one that is 0 by a step; each column of a
// table is one number. Nothing beyond the last.
std::optional<Changed> changed(const Scene&, int which, bool down = false);

// ---- All promises of one scheme: what `jvari check` prints, writes and returns

struct Answered {
    const Promise* promise;
    std::string scene;  // "" where it is examined once
    Verdict verdict;
    double seconds;  // [s]
};

struct Asked {  // of promises and scenes those alone that are named; none named: all
    std::vector<std::string> promises, scenes;
};

struct Checked {
    std::string scheme, source;
    std::vector<const Promise*> examined;
    std::vector<Answered> answers;  // in the order of promises(), then of the scenes
    bool broken() const;
};

// Calls `answered` for each promise as soon as all its scenes are examined. Throws UsageError: a
// promise or a scene that there is not, or no promise that is examined on it.
Checked check(const Descriptor&, const Asked&, const store::Listener&,
              const std::function<void(const Checked&, const Promise&)>& answered = {});

std::string line_of(const Checked&, const Promise&);
// whether it keeps them, and how many: "14 kept, 5 not asked: it promises no balance"
std::string conclusion_of(const Checked&);
std::string json_of(const std::vector<Checked>&);
// a test suite a scheme, a test case a promise and scene
std::string junit_of(const std::vector<Checked>&);

}  // namespace jvari::bench::check
