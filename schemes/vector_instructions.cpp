#include "schemes/vector_instructions.hpp"

#include <hwy/highway.h>
#include <hwy/targets.h>

namespace jvari {

std::string vector_instructions() {
    const std::int64_t supported = hwy::SupportedTargets();  // a bit each, the best is the lowest
    return hwy::TargetName(supported & -supported);
}

}  // namespace jvari
