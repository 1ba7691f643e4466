// Names to things: schemes, references and what plugins bring; scenes of the library or from files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/compare/request.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

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
bool whole_multiple(double rate, double of);  // rate = n x of, n = 1, 2, ...

// Doubles of state with that many modes; nothing where it cannot be made. A grid has as many
// whatever it is told.
std::optional<int> dofs_with(int modes, const Descriptor&, const Scene&, Settings);
std::vector<std::string> names_in(Features);  // one by one

}  // namespace jvari::bench::compare
