// Sources of this build. Every edit compiles this file again, and so it has nothing else.
#include "bench/provenance.hpp"  // written at build time by provenance.cmake
#include "bench/store/machine.hpp"

namespace jvari::bench::store {

const Sources build_sources{JVARI_COMMIT, JVARI_RUN_SOURCES, JVARI_CELL_SOURCES};

}  // namespace jvari::bench::store
