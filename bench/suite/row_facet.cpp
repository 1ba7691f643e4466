#include "bench/suite/row_facet.hpp"

#include "bench/suite/dispersion_facet.hpp"
#include "bench/suite/ensemble_facet.hpp"
#include "bench/suite/figure_rows.hpp"
#include "bench/suite/sound_facet.hpp"

namespace jvari::bench::suite {

std::span<const RowFacet> row_facets() {
    static constexpr RowFacet facets[] = {
        {Facet::dispersion, dispersion_rows}, {Facet::ensemble, ensemble_rows},
        {Facet::trace, trace_rows},           {Facet::extent, extent_rows},
        {Facet::profile, profile_rows},       {Facet::envelope, envelope_rows},
        {Facet::centroid, centroid_rows},     {Facet::sound, sound_rows, write_sound_rows},
    };
    return facets;
}

}  // namespace jvari::bench::suite
