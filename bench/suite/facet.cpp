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
