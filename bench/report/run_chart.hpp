// One run, one picture: its taps over time, spectrum and spectrogram of the first of them, the energy ledger where it was probed, and when
// the string touched.
#pragma once

#include <string>

#include "bench/report/chart_style.hpp"
#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::report {

struct DrawnRun {
    std::string title, subtitle, scheme;  // in whose hue it is drawn
    const Scene& scene;
    const Trace& trace;
};
// Vega-Lite. Panels without data are left out: no ledger without energy, no contact without a barrier's force among the taps.
std::string run_spec(const DrawnRun&, Medium);

// The same as a page of its own (needs the chart libraries, see vega.hpp).
std::string run_page(const DrawnRun&, const std::string& scripts);

}  // namespace jvari::bench::report
