// Schemes from outside the tree: a shared object that exports one symbol. Its source ends with
//
//     JVARI_PLUGIN(table)    // an array of Descriptor
//
// The program and the plugin pass C++ structures to each other, and call each other's virtual functions. So both must lay them out alike:
// `plugin_abi` is a hash of the sizes and offsets of all that crosses, of the places and types of the virtual functions, and of the
// compiler. A plugin with another hash is refused. The macro also writes down how the plugin was compiled, for the manifest of what it was
// timed in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>

#include "schemes/making.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// ---- The layout.

// FNV-1a over whole numbers.
constexpr std::uint32_t layout_hash(std::initializer_list<std::size_t> numbers, std::uint32_t hash = 2166136261u) {
    for (std::uint64_t n : numbers)
        for (int byte = 0; byte < 8; ++byte) hash = (hash ^ static_cast<std::uint32_t>(n >> (8 * byte) & 0xff)) * 16777619u;
    return hash;
}

// NOLINTBEGIN(cppcoreguidelines-macro-usage): offsetof takes a name
#define JVARI_AT(member) offsetof(Struct, member)
#define JVARI_LAYOUT(Type, ...)                                                                                     \
    [] {                                                                                                            \
        using Struct = Type;                                                                                        \
        return static_cast<std::size_t>(layout_hash({sizeof(Struct), alignof(Struct) __VA_OPT__(, ) __VA_ARGS__})); \
    }()
// NOLINTEND

// Raised by hand where the meaning of a field changes, and no layout.
constexpr std::size_t interface_version = 5;

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"  // GCC and clang define it for every class without virtual bases
#endif
constexpr std::uint32_t plugin_layout = layout_hash({
    interface_version, static_cast<std::size_t>(feature_count), JVARI_LAYOUT(NoDamping),
        JVARI_LAYOUT(PolynomialDamping, JVARI_AT(sigma0), JVARI_AT(sigma1), JVARI_AT(sigma3)),
        JVARI_LAYOUT(QualityFactorDamping, JVARI_AT(diameter), JVARI_AT(air_viscosity), JVARI_AT(air_density), JVARI_AT(viscoelastic_angle),
                     JVARI_AT(thermoelastic_loss)),
        JVARI_LAYOUT(TableDamping, JVARI_AT(file), JVARI_AT(frequency_hz), JVARI_AT(decay_rate)),
        JVARI_LAYOUT(PerPeriodDamping, JVARI_AT(factor)), JVARI_LAYOUT(Damping),
        JVARI_LAYOUT(LumpedBarrier, JVARI_AT(position), JVARI_AT(width), JVARI_AT(height), JVARI_AT(stiffness), JVARI_AT(exponent),
                     JVARI_AT(contact_loss)),
        JVARI_LAYOUT(TableCurve, JVARI_AT(file), JVARI_AT(x), JVARI_AT(height)),
        JVARI_LAYOUT(ProfileBarrier, JVARI_AT(curve), JVARI_AT(from), JVARI_AT(to), JVARI_AT(stiffness), JVARI_AT(exponent),
                     JVARI_AT(contact_loss)),
        JVARI_LAYOUT(Barrier),
        JVARI_LAYOUT(Thread, JVARI_AT(position), JVARI_AT(width), JVARI_AT(stiffness), JVARI_AT(damping), JVARI_AT(height)),
        JVARI_LAYOUT(ModeInitial, JVARI_AT(number), JVARI_AT(amplitude)),
        JVARI_LAYOUT(TriangleInitial, JVARI_AT(position), JVARI_AT(amplitude), JVARI_AT(smoothing)), JVARI_LAYOUT(Initial),
        JVARI_LAYOUT(Pluck, JVARI_AT(amplitude), JVARI_AT(duration), JVARI_AT(skew), JVARI_AT(start), JVARI_AT(position), JVARI_AT(width)),
        JVARI_LAYOUT(Polarisation, JVARI_AT(rotation), JVARI_AT(pluck_angle)),
        JVARI_LAYOUT(String, JVARI_AT(length), JVARI_AT(linear_density), JVARI_AT(tension), JVARI_AT(bending_stiffness), JVARI_AT(damping),
                     JVARI_AT(barriers), JVARI_AT(thread), JVARI_AT(initial), JVARI_AT(pluck), JVARI_AT(polarisation)),
        JVARI_LAYOUT(Tap, JVARI_AT(name), JVARI_AT(quantity), JVARI_AT(string), JVARI_AT(position)),
        JVARI_LAYOUT(BodyMode, JVARI_AT(mass), JVARI_AT(stiffness), JVARI_AT(damping)),
        JVARI_LAYOUT(Body, JVARI_AT(bridge), JVARI_AT(nut), JVARI_AT(sections), JVARI_AT(modes)),
        JVARI_LAYOUT(Scene, JVARI_AT(name), JVARI_AT(source), JVARI_AT(duration), JVARI_AT(strings), JVARI_AT(taps), JVARI_AT(body)),
        JVARI_LAYOUT(Block, JVARI_AT(rows), JVARI_AT(taps), JVARI_AT(stride), JVARI_AT(tap), JVARI_AT(energy), JVARI_AT(stop),
                     JVARI_AT(caller)),
        JVARI_LAYOUT(Status, JVARI_AT(outcome), JVARI_AT(step)), JVARI_LAYOUT(Fact, JVARI_AT(name), JVARI_AT(value), JVARI_AT(unit)),
        JVARI_LAYOUT(FreeMode, JVARI_AT(omega), JVARI_AT(sigma)),
        JVARI_LAYOUT(Settings, JVARI_AT(sample_rate), JVARI_AT(tap_rate), JVARI_AT(modes), JVARI_AT(options)),
        JVARI_LAYOUT(FactName, JVARI_AT(name), JVARI_AT(unit), JVARI_AT(meaning)),
        JVARI_LAYOUT(Option, JVARI_AT(name), JVARI_AT(fallback), JVARI_AT(meaning), JVARI_AT(choices)),
        JVARI_LAYOUT(Approximation, JVARI_AT(feature), JVARI_AT(fact)), JVARI_LAYOUT(Limit, JVARI_AT(name), JVARI_AT(margin)),
        JVARI_LAYOUT(Confirmation, JVARI_AT(accuracies), JVARI_AT(other_methods)),
        JVARI_LAYOUT(Descriptor, JVARI_AT(name), JVARI_AT(source), JVARI_AT(represents), JVARI_AT(balance), JVARI_AT(clock), JVARI_AT(make),
                     JVARI_AT(options), JVARI_AT(approximates), JVARI_AT(note), JVARI_AT(limit), JVARI_AT(stand_in_rank),
                     JVARI_AT(confirmation), JVARI_AT(all_strings), JVARI_AT(own), JVARI_AT(untimed)),
#if defined(__GXX_ABI_VERSION)
        __GXX_ABI_VERSION,
#endif
#if defined(__GNUC__)
        __GNUC__,
#endif
#if defined(__clang_major__)
        __clang_major__,
#endif
#if defined(_GLIBCXX_USE_CXX11_ABI)
        _GLIBCXX_USE_CXX11_ABI,
#endif
});
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

// ---- The table of virtual functions.

// Of a virtual function: its place in the table, which a pointer to it holds (Itanium C++ ABI: GCC and clang), and its type, which the name
// of this instance holds. No constant expression can read the place.
template <class Function>
std::size_t place_of(Function function) {
    std::size_t words[sizeof(Function) / sizeof(std::size_t)];
    std::memcpy(words, &function, sizeof words);
    std::uint32_t hash = layout_hash({});
    for (const std::size_t word : words) hash = layout_hash({word}, hash);
    for (const char* c = __PRETTY_FUNCTION__; *c; ++c) hash = layout_hash({static_cast<std::size_t>(*c)}, hash);
    return hash;
}
struct PastTheTable : Scheme {
    virtual void place() = 0;  // the first after those of Scheme: it moves where one is added
};

inline std::uint32_t plugin_abi() {
    return layout_hash({plugin_layout, place_of(&Scheme::reset), place_of(&Scheme::advance), place_of(&Scheme::dofs),
                        place_of(&Scheme::facts), place_of(&Scheme::free_modes), place_of(&PastTheTable::place)});
}

// ---- What a plugin exports.

struct Plugin {
    std::uint32_t abi;  // plugin_abi(); read before all else
    const Descriptor* table;
    int count;
    const char* compiler;  // "12.2.0"
    const char* flags;     // what can be told from inside: "optimised, NDEBUG, AVX2"
    bool optimised;

    std::span<const Descriptor> schemes() const { return {table, static_cast<std::size_t>(count)}; }
};

#if defined(__OPTIMIZE__)
#define JVARI_OPTIMISED true
#define JVARI_FLAG_OPTIMISED "optimised"
#else
#define JVARI_OPTIMISED false
#define JVARI_FLAG_OPTIMISED "not optimised"
#endif
#if defined(NDEBUG)
#define JVARI_FLAG_NDEBUG ", NDEBUG"
#else
#define JVARI_FLAG_NDEBUG ", assertions"
#endif
#if defined(__AVX512F__)
#define JVARI_FLAG_VECTOR ", AVX-512"
#elif defined(__AVX2__)
#define JVARI_FLAG_VECTOR ", AVX2"
#elif defined(__AVX__)
#define JVARI_FLAG_VECTOR ", AVX"
#else
#define JVARI_FLAG_VECTOR ""
#endif
#if defined(__FMA__)
#define JVARI_FLAG_FMA ", FMA"
#else
#define JVARI_FLAG_FMA ""
#endif
#if defined(__FAST_MATH__)
#define JVARI_FLAG_FAST_MATH ", fast math"
#else
#define JVARI_FLAG_FAST_MATH ""
#endif

// Exported although all else is compiled with -fvisibility=hidden.
#define JVARI_PLUGIN(schemes)                                                                                                         \
    extern "C" __attribute__((visibility("default")))                                                                                 \
    const jvari::Plugin jvari_plugin = {jvari::plugin_abi(),                                                                          \
                                        std::data(schemes),                                                                           \
                                        static_cast<int>(std::size(schemes)),                                                         \
                                        __VERSION__,                                                                                  \
                                        JVARI_FLAG_OPTIMISED JVARI_FLAG_NDEBUG JVARI_FLAG_VECTOR JVARI_FLAG_FMA JVARI_FLAG_FAST_MATH, \
                                        JVARI_OPTIMISED};

}  // namespace jvari
