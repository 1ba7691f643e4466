// The vector instructions that the kernels of this tree choose on this machine (Highway): the last digits of a trace depend on them.
#pragma once

#include <string>

namespace jvari {

std::string vector_instructions();  // "AVX2"

}  // namespace jvari
