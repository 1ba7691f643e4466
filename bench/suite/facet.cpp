#include "bench/suite/facet.hpp"

#include "schemes/making.hpp"

namespace jvari::bench::suite {

std::span<const Facet> facets() {
    static constexpr Facet all[] = {
        {measured::errors, "against the reference"},
        {measured::cost, "by the clock; with errors alone: no speed without an error"},
        {measured::spectrogram, "of the tap"},
        {"sound", "of cell and reference, to be heard", sound_rows, write_sound_rows},
        {"motion", "of the string, frame by frame, beside its reference's: what the page's moving string is drawn of", motion_rows,
         write_motion},
        {"dispersion", "pitch and decay of each mode", dispersion_rows},
        {measured::ensemble, "is the cell statistically its reference?", ensemble_rows},
        {"trace", "every row of a tap in windows", trace_rows, nullptr, trace_table},
        {"extent", "smallest and largest value of a tap in parts of the run", extent_rows, nullptr, extent_table},
        {"profile", "displacement along the string at instants", profile_rows, nullptr, profile_table},
        {"envelope", "upper envelope of a tap's spectrum over the run (Hann)", envelope_rows, nullptr, envelope_table},
        {"centroid", "of a tap's power spectrum, frame by frame", centroid_rows, nullptr, centroid_table},
    };
    return all;
}

Settings beside(const MeasuredCell& c, const Descriptor& reference) {
    const int asked = c.set.reference_modes.value_or(0), own = c.settings.modes > 0 ? c.settings.modes : modes_for(c.scene, c.settings);
    Settings settings{0, c.settings.tap_rate, asked > 0 ? asked : own, {}};
    for (const study::ReferenceChoice& choice : c.references)
        if (choice.scheme->name == reference.name) settings.options = choice.settings.options;
    return settings;
}

}  // namespace jvari::bench::suite
