#include "schemes/vector_instructions.hpp"

#include <hwy/highway.h>

namespace jvari {

std::string vector_instructions() {
    const auto usable = hwy::SupportedTargets() & HWY_TARGETS;
    return hwy::TargetName(usable & -usable);  // the best is the lowest bit
}

}  // namespace jvari
