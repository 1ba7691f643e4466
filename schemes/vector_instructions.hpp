// Names the kernels' vector instructions on this machine: the last digits of a trace depend on
// them. They are the best set that the processor has and Highway compiled, chosen by the kernels'
// own dispatch.
#pragma once

#include <string>

namespace jvari {

std::string vector_instructions();  // "AVX2"

}  // namespace jvari
