// Nothing is planted here: this one keeps every promise.
#include "tests/contract_plugins/honest.hpp"

JVARI_PLANTED(honest, jvari::Honest)
