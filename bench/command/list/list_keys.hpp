// What `jvari list keys` says: the keys of suite files, table by table, and what can be measured.
#pragma once

#include "bench/command/list/list_seam.hpp"

namespace jvari::bench::command {

Listing list_keys();

}  // namespace jvari::bench::command
