// One run, one picture: its taps over time, spectrum and spectrogram of the first of them, the
// energy ledger where it was probed, when the string touched; and its sound. Here are the numbers;
// page/run.js draws them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::report {

struct DrawnRun {
    std::string title, subtitle, scheme;  // in whose hue it is drawn
    const Scene& scene;
    const Trace& trace;
};
// The data of a page (page.hpp). What the run lacks is left out:
// no ledger without energy, no contact without a barrier's force among the taps.
nlohmann::ordered_json run_data(const DrawnRun&);

}  // namespace jvari::bench::report
