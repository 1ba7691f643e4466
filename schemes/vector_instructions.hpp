// The vector instructions that the kernels of this tree run with on this machine: the last digits
// of a trace depend on them. They are the best of those that the processor has and Highway
// compiled, by the same dispatch as the kernels'.
#pragma once

#include <string>

namespace jvari {

std::string vector_instructions();  // "AVX2"

}  // namespace jvari
