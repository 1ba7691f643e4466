#include "schemes/vector_instructions.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/vector_instructions.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
const char* name_of_target() { return hwy::TargetName(HWY_TARGET); }
}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(name_of_target);

std::string vector_instructions() { return HWY_DYNAMIC_DISPATCH(name_of_target)(); }
}  // namespace jvari
#endif
