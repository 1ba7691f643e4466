// A comparison: schemes x modes x rates on one scene, each against one reference on the same rows.
//
// Each cell is run once for its errors (energy probe on), then timed (cost.hpp). A cell that refuses or fails stays in the list with its
// reason. Of the cells that were sought and not named, those alone are run whole that the first 50 ms call for (needed_cells.hpp).
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis/statistics.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/compare/errors.hpp"
#include "bench/compare/request.hpp"
#include "bench/compare/summary.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/sound.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "bench/trust/certificate_library.hpp"

namespace jvari::bench::compare {

struct Cell {
    const Descriptor* scheme;
    Settings settings;
    bool refused = false;
    std::string reason{};  // of a refusal or a failure, or why it is not needed
    Summary summary{};     // of the accuracy run; empty where refused
    Errors errors{};       // from the scene's own motion (truth.hpp)
    Errors in_model{};     // from that of a string with as many modes: errors of the scheme alone; empty where none was run
    store::Sound sound{};  // of the headline's nut tap, where the run reached its end
    Spread wall{};         // of the timed runs [s], of the whole scene or up to the failure
    Spread processor{};    // the same in processor time [s], the drift of the machine taken off (cost.cpp)
    double worst_block = std::numeric_limits<double>::quiet_NaN();  // as a fraction of its deadline, see cost.hpp
    store::Stamp stamp{};                                           // of the machine that timed it
    bool searched = false;                                          // its modes or its rate were not named
    bool added = false;                                             // more modes than it takes unasked
    bool needed = true;                                             // false: run over the headline's window alone, and not timed
    int modes() const { return refused ? settings.modes : summary.modes; }
};

struct Comparison {
    Scene scene;
    Headline headline;
    const Descriptor* reference;
    std::string reference_name;  // its name, "oversampled modal_two_point" for a scheme that stands in
    Settings reference_settings;
    Summary reference_summary;
    std::string reference_note;                                 // why this one, where it was not asked for
    Errors floor;                                               // of the reference started 1e-12 apart
    trust::Trust trust;                                         // the figures of its certificate
    trust::Trust model_trust;                                   // of the reference that the errors in the model are measured against
    std::string truth;                                          // how far the doubling of its modes went; "": it has those of the cells
    bool searched = false;                                      // modes or compliance, beside what was named
    double horizon = std::numeric_limits<double>::quiet_NaN();  // of the truth against itself with half its modes [s]
    store::Sound reference_sound;
    std::vector<Cell> cells;
};

Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&);  // throws UsageError, BadScene, Refusal

}  // namespace jvari::bench::compare
