#include "bench/suite/facet.hpp"

#include "bench/suite/suite_file.hpp"

namespace jvari::bench::suite {

std::span<const Facet> facets() {
    static constexpr Facet all[] = {
        {measured::errors, "against the reference"},
        {measured::cost, "by the clock; with errors alone: no speed without an error"},
        {measured::spectrogram, "of the tap"},
        {"sound", "of cell and reference, to be heard", sound_rows},
        {"dispersion", "pitch and decay of each mode", dispersion_rows},
    };
    return all;
}

}  // namespace jvari::bench::suite
