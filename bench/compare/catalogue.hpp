// Request for a comparison, and the catalogue behind its names: schemes, references and plugins;
// scenes from the library or from files.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

// ---- Request, from the command line, a suite or a program

// --option [scheme:]name=value. If a name comes several times, each value is run.
struct SchemeOption {
    std::string scheme, name, value;  // scheme "": every scheme with such an option
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
    std::vector<int> modes;            // none: all modes below 20 kHz, and those that `search` adds
    // 0: doubled until the result settles; none: the cells' modes
    std::optional<int> reference_modes = 0;
    // true: more modes and matched compliance are tried if the request does not name modes or
    // compliance. Ignored for a reference with the cell's modes.
    bool search = true;
    // true: without named schemes, schemes with known faults are included
    bool controls = false;
    std::optional<double> duration, tap_rate;  // [s], [Hz]
    std::optional<double> time_limit;          // limit for each run, including references [s]
    std::vector<std::string> set;              // overrides of the scene, "key.path=value"
    std::string tap;                           // the only tap to compare; "": all
    std::vector<SchemeOption> options;
    // Settings from an advice; cells near these settings are added. modes 0: none
    Settings near{};
    int repeats = 5;
    int jobs = 0;  // 0: the number of cores
};

// Words for a field of a request. The flag --tap-rate, the suite key tap_rate and Python's argument
// tap_rate have one name.
struct FieldWords {
    const char *name, *meaning, *absent;
};
namespace fields {
inline constexpr FieldWords  //
    schemes{"schemes", "schemes that are compared",
            "every scheme that represents the scene, but for controls"},
    rates{"rates", "sample rates of each scheme", "44100 x 1, 2, 4, 8, 16, 32, 64"},
    modes{"modes", "modes of each string",
          "those below 20 kHz, and in a search 1.5, 2, 3 and 4 times as many where they lie below "
          "rate/2"},
    reference_modes{
        "reference_modes",
        "modes of the reference; 0: doubled until nothing moves, and the points of a profile "
        "with them; cell: those of the schemes",
        "0"},
    duration{"duration", "length of each run", "the scene's"},
    tap_rate{"tap_rate", "rows per second",
             "44100 for its multiples, the lowest rate for others; 44100 and 48000 have each "
             "their own"},
    repeats{"repeats", "timed runs of each cell; a slow cell gets fewer, two at least", "5"};
}

// Text of every setting that affects the results, except the program.
std::string identity_of(const CompareRequest&);

// ---- Names to things

struct Catalogue {
    explicit Catalogue(const std::vector<std::string>& plugins = {});  // throws UsageError
    // in-tree first, then from plugins
    std::vector<const Descriptor*> schemes;
    std::vector<const Descriptor*> references;  // in order of authority

    // schemes from the table of pairings, found by name only
    std::vector<const Descriptor*> paired;

    // Finds a scheme or reference; UsageError suggests the nearest name.
    const Descriptor& find(const std::string& name) const;
};

// Warns about plugins compiled without optimisation.
void note_slow_plugins(const store::Listener&);

// Loads a file or a scene from the library, with overrides "key.path=value". Throws SceneFileError,
// BadScene or UsageError.
Scene load_scene(const std::string& name, const std::vector<std::string>& overrides,
                 std::optional<double> duration);
Scene load_scene(const CompareRequest&);  // with only the requested tap, if any

// Place of a tap by its name; "" gives the first. Throws UsageError for an unknown name or a scene
// without taps.
int tap_named(const Scene&, const std::string& name);

// Settings for a run at this rate. Rows are at 44100 Hz by default, or at `rate` if `rate` is no
// multiple. Throws UsageError if the rate is no multiple of the requested row rate, or an option
// belongs to another scheme.
Settings settings_of_run(const Descriptor&, double rate, std::optional<double> tap_rate, int modes,
                         const std::vector<SchemeOption>&);
// Settings as typed: "--scheme modal_two_point --rate 44100 --modes 40".
std::string arguments_of(const Descriptor&, const Settings&);
// "modal_two_point compliance=matched, 80 modes, 44100 Hz"
std::string settings_text(const Descriptor&, const Settings&);
bool whole_multiple(double rate, double of);  // rate = n x of, n = 1, 2, ...

// Number of doubles in the state with `modes`; nothing if the scheme cannot be made. A grid has the
// same number for any modes.
std::optional<int> dofs_with(int modes, const Descriptor&, const Scene&, Settings);
std::vector<std::string> names_in(Features);                  // single names
Features features_of(const std::vector<std::string>& names);  // throws UsageError
Balance balance_of(const std::string& name);  // "exact", "to tolerance", "none"; UsageError

}  // namespace jvari::bench::compare
