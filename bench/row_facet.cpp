#include "bench/row_facet.hpp"

#include "bench/sound_facet.hpp"

namespace jvari {

std::span<const RowFacet> row_facets() {
    static constexpr RowFacet all[] = {
        {Facet::sound, sound_rows, write_sound_rows},
    };
    return all;
}

}  // namespace jvari
