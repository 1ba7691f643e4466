// A comparison: schemes x rates on one scene, each against one reference on the same rows.
//
// Each cell is run once for its errors (energy probe on), then timed (cost.hpp). A cell that refuses or fails stays in the list with its
// reason.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis/statistics.hpp"
#include "bench/arguments.hpp"
#include "bench/catalogue.hpp"
#include "bench/certificate_library.hpp"
#include "bench/console.hpp"
#include "bench/errors.hpp"
#include "bench/sound.hpp"
#include "bench/summary.hpp"

namespace jvari {

struct Cell {
    const Descriptor* scheme;
    Settings settings;
    bool refused = false;
    std::string reason;  // of a refusal or a failure
    Summary summary{};   // of the accuracy run; empty where refused
    Errors errors;
    Sound sound{};                                                  // of the headline's nut tap, where the run reached its end
    Spread wall{};                                                  // of the timed runs [s], of the whole scene or up to the failure
    double worst_block = std::numeric_limits<double>::quiet_NaN();  // as a fraction of its deadline, see cost.hpp
    int modes() const { return refused ? settings.modes : summary.modes; }
};

struct Comparison {
    Scene scene;
    Headline headline;
    const Descriptor* reference;
    std::string reference_name;  // its name, "oversampled modal_two_point" for a scheme that stands in
    Settings reference_settings;
    Summary reference_summary;
    std::string reference_note;  // why this one, where it was not asked for
    Errors floor;                // of the reference started 1e-12 apart
    Trust trust;                 // the figures of its certificate
    Sound reference_sound;
    std::vector<Cell> cells;
};

Comparison compare(const CompareRequest&, const Catalogue&, const Console&);  // throws UsageError, BadScene, Refusal

}  // namespace jvari
