// Plain vector arithmetic in a fixed order of summation (eight partial sums), so that every
// instruction set gives the same bits. A function of JVARI_CLONES is compiled once for each set and
// chosen when the program starts.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define JVARI_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define JVARI_CLONES
#endif

namespace jvari {

constexpr int lanes = 8;
typedef double Lanes __attribute__((vector_size(lanes * sizeof(double)), aligned(8), may_alias));

// by reference: a vector argument would depend on the instruction set
inline double total(const Lanes& lane) {
    const double* s = reinterpret_cast<const double*>(&lane);
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

}  // namespace jvari
