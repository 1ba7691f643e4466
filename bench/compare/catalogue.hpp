// What a comparison is asked for, and what its names stand for: schemes, references and what
// plugins bring; scenes of the library or from files.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

// ---- What a comparison is asked for: by the command line, a suite, a program

// --option [scheme:]name=value; of one name several: each value is run
struct SchemeOption {
    std::string scheme, name, value;  // scheme "": every scheme that knows the name
    static SchemeOption of(const std::string& key, std::string text) {  // key: [SCHEME:]NAME
        const auto colon = key.find(':');
        return colon == std::string::npos
                   ? SchemeOption{"", key, std::move(text)}
                   : SchemeOption{key.substr(0, colon), key.substr(colon + 1), std::move(text)};
    }
};

struct CompareRequest {
    std::string scene, reference, out;
    std::vector<std::string> schemes;  // none: every scheme that represents the scene
    std::vector<double> rates;         // [Hz]; none: 44100 x 1, 2, 4 ... 64
    std::vector<int> modes;            // none: those below 20 kHz, and what `search` adds
    // 0: doubled until nothing moves; none: those of the cells
    std::optional<int> reference_modes = 0;
    // what is not named is sought: more modes, matched compliance. Not with a cell's reference
    bool search = true;
    // with no schemes named, those that are known to be wrong too
    bool controls = false;
    std::optional<double> duration, tap_rate;  // [s], [Hz]
    std::optional<double> time_limit;          // of each run, of a reference too [s]
    std::vector<std::string> set;              // overrides of the scene, "key.path=value"
    std::string tap;                           // the only one that is compared; "": all
    std::vector<SchemeOption> options;
    // settings of an advice, near which cells are sought as well; modes 0: none
    Settings near{};
    int repeats = 5;
    int jobs = 0;  // 0: as many as there are cores
};

// All that its results depend on but the program, as text.
std::string identity_of(const CompareRequest&);

// ---- Names to things

struct Catalogue {
    explicit Catalogue(const std::vector<std::string>& plugins = {});  // throws UsageError
    // in-tree, then those of plugins
    std::vector<const Descriptor*> schemes;
    std::vector<const Descriptor*> references;  // in order of authority

    // schemes of the table of pairings that are found by their name alone
    std::vector<const Descriptor*> paired;

    // any of them; UsageError suggests the nearest name
    const Descriptor& find(const std::string& name) const;
};

// Warns of plugins that were compiled without optimisation.
void note_slow_plugins(const store::Listener&);

// A file or a library name, with overrides "key.path=value"; throws SceneFileError, BadScene or
// UsageError.
Scene load_scene(const std::string& name, const std::vector<std::string>& overrides,
                 std::optional<double> duration);
Scene load_scene(const CompareRequest&);  // with the tap that is asked for alone

// The place of a tap by its name; of the first for "". Throws UsageError, also for a scene that has
// none.
int tap_named(const Scene&, const std::string& name);

// Of one run at this rate: rows at 44100 Hz unless asked otherwise, or at the rate where that is no
// multiple. Throws UsageError where the rate is no multiple of the rows, or an option is another
// scheme's.
Settings settings_of_run(const Descriptor&, double rate, std::optional<double> tap_rate, int modes,
                         const std::vector<SchemeOption>&);
// the same as typed: "--scheme modal_two_point --rate 44100 --modes 40"
std::string arguments_of(const Descriptor&, const Settings&);
// "modal_two_point compliance=matched, 80 modes, 44100 Hz"
std::string settings_text(const Descriptor&, const Settings&);
bool whole_multiple(double rate, double of);  // rate = n x of, n = 1, 2, ...

// Doubles of state with that many modes; nothing where it cannot be made. A grid has as many
// whatever it is told.
std::optional<int> dofs_with(int modes, const Descriptor&, const Scene&, Settings);
std::vector<std::string> names_in(Features);                  // one by one
Features features_of(const std::vector<std::string>& names);  // throws UsageError
Balance balance_of(const std::string& name);  // "exact", "to tolerance", "none"; UsageError

}  // namespace jvari::bench::compare
