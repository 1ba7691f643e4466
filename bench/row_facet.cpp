#include "bench/row_facet.hpp"

#include "bench/dispersion_facet.hpp"

namespace jvari {

std::span<const RowFacet> row_facets() {
    static constexpr RowFacet all[] = {{Facet::dispersion, dispersion_rows}};
    return all;
}

}  // namespace jvari
