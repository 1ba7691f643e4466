// The list of promises that every scheme makes. `jvari check` examines a single scheme, the tests
// examine all.
//
// A promise is examined on every scene that the scheme represents, on every other scene, or once.
// Numerical claims rest on all other promises and are examined only if these are kept, so a broken
// promise fails under its own name. The last two rest on the claims before them too: a scheme with
// a wrong motion has no right instants, and responds to no number correctly. For each promise
// tests/contract_plugins has a scheme breaking only this promise.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/dispersion.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/judge/judge.hpp"
#include "bench/store/system/listener.hpp"
#include "scenes/scene.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::check {

struct Verdict {
    // excused: a known break of this scheme
    enum class Answer { kept, broken, excused, not_asked } answer = Answer::kept;
    // measured figure, or the reason why the promise could not be examined
    std::string why;
    bool broken() const { return answer == Answer::broken; }
};
Verdict kept(std::string figure = "");
Verdict broken(std::string fault);
Verdict not_asked(std::string why);
const char* name_of(Verdict::Answer);  // "not asked"

struct Case {  // a scheme, a scene, and the settings for its run
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
    const char* name;  // "AllocatesNothingWhileStepping"
    // behaviour that keeps the promise: "allocates nothing while stepping"
    const char* sentence;
    Scope scope;
    Verdict (*of)(const Case&);  // the case has no scene if the promise is examined once
};
std::span<const Promise> promises();  // in reading order

// A known break by a scheme in this tree: a control, which a comparison must detect.
struct Excuse {
    const char *scheme, *promise, *why;
};
std::span<const Excuse> excuses();

std::vector<Case> cases_of(const Descriptor&, Scope);

// Never throws: an exception from the scheme breaks the promise. A refusal for the scheme's own
// reason gives `not_asked`. A known break (Excuse) gives `excused`.
Verdict verdict_on(const Promise&, const Case&);

// ---- One function for each promise, and shared helpers.

// Refusals and declarations: claims.cpp.
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

// Changes of a scene that preserve its motion: symmetries.cpp.
Verdict is_one_motion_in_all_units(const Case&);
Verdict plays_later_as_at_once(const Case&);

// Numerical claims about a whole scheme: claims.cpp, against_references.cpp.
Verdict stores_the_energy_of_the_scene(const Case&);
Verdict partials_are_its_own_relations(const Case&);
Verdict writes_rows_at_their_instants(const Case&);
Verdict converges_to_the_reference(const Case&);
Verdict feels_every_number(const Case&);
Verdict stays_sound_over_a_map(const Case&);

Settings settings_for(const Descriptor&, const Scene&);
// Tests whether the scheme represents the scene and approximates no part of it.
bool is_as_the_scene_says(const Descriptor&, const Scene&);
// Tests whether the scheme touches a profile at points, as many as the option `points` says;
// references have `nodes` instead.
bool has_points_for_a_profile(const Descriptor&);
// An external program exchanges files: only its rows are known, and it refuses at run time.
constexpr const char* in_a_process = "it runs in a process of its own, and gives rows alone";
bool takes(const Descriptor&, const Scene&, const Settings&);  // false if it refuses
Run fresh(const Case&, const RunOptions&);  // runs a new scheme made for the case

// Partials of a run whose rows are its steps: `own` by the scheme's account (Scheme::free_modes),
// and `heard` in a tap by the matrix pencil of analysis/dispersion.hpp. Silent partials are left
// out.
struct HeardPartial {
    int mode;
    FreeMode own;
    Partial heard;
};
std::vector<HeardPartial> heard_partials(const Descriptor&, const Scene&, const Settings&, int tap);

// ---- Scenes on which promises are examined.

// The C3 string of van Walstijn, Bridges & Mehes 2016, Table 1: alone and at rest, with taps at its
// nut and at 0.3 m.
Scene string_at_rest();

constexpr double contract_tap_rate = 44100;  // [Hz]
constexpr int contract_modes = 40, modes_of_an_integrator = 12;
constexpr long contract_rows = 96;
// relative to the whole string, which a grid approaches
constexpr double what_modes_leave_out = 5e-5;
constexpr double what_nodes_leave_out = 1e-2;  // relative to a force on a profile, at any rate

// Library scenes and a few made here, contract_rows long, or longer until the string touches; read
// once.
const std::vector<Scene>& contract_scenes();

// Test scenes with this feature and displacement taps: two minimal strings, then every contract
// scene, with the feature added if missing.
std::vector<Scene> scenes_with(Feature);

// Short and smooth scenes that together have every number of a scene. Each number is large enough
// to affect the taps.
const std::vector<Scene>& scenes_of_numbers();

// Reduces a scene to the features represented by a scheme without approximation; a profile may be
// approximated by points.
Scene as_far_as(const Descriptor&, Scene);

// Writes the tables of a scene into files in the folder, replacing earlier ones: a plugin reads the
// scene again from its text.
Scene in_files(Scene, const std::filesystem::path& folder);

// Copies with only this feature changed: another value, or none. A scheme that heeds the feature
// distinguishes them.
std::vector<Scene> otherwise(const Scene&, Feature);

// ---- Numbers in a scene, from the schema for scene files, so new keys are included.

struct Changed {
    std::string key;  // "string.0.barrier.1.height"
    Scene scene;
};

// Changes number `which` in the scene by a tenth, or by a step if it is 0; each column in a table
// counts as one number. Returns nothing beyond the last.
std::optional<Changed> changed(const Scene&, int which, bool down = false);

// ---- All promises of one scheme: `jvari check` prints and writes them, and its exit code tells
// whether they are kept.

struct Answered {
    const Promise* promise;
    std::string scene;  // "" if examined once
    Verdict verdict;
    double seconds;  // [s]
};

struct Asked {  // selects promises and scenes by name; none named: all
    std::vector<std::string> promises, scenes;
};

struct Checked {
    std::string scheme, source;
    std::vector<const Promise*> examined;
    std::vector<Answered> answers;  // in the order of promises(), then of the scenes
    bool broken() const;
};

// Throws UsageError for an unknown promise or scene.
void must_exist(const Asked&);
// Calls `answered` for each promise once all its scenes are examined. Throws UsageError if no
// selected promise is examined on the selected scenes.
Checked check(const Descriptor&, const Asked&, const store::Listener&,
              const std::function<void(const Checked&, const Promise&)>& answered = {});

std::string line_of(const Checked&, const Promise&);
// Verdict and counts: "14 kept, 5 not asked: it promises no balance".
std::string conclusion_of(const Checked&);
std::string json_of(const std::vector<Checked>&);
// JUnit XML: a test suite for each scheme, a test case for each promise and scene.
std::string junit_of(const std::vector<Checked>&);

}  // namespace jvari::bench::check
