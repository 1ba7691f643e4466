// jvari_scheme.h for C++: a class as a scheme. It needs no library of jvari, and any compiler.
//
//     struct Mine {
//         explicit Mine(const jvari_problem&);      // may throw a std::exception: the scene is
//         refused with its sentence
//         void reset();
//         int advance(const jvari_rows&);           // JVARI_OK, or a jvari_outcome and
//         rows.failed_step
//         int64_t dofs() const;
//     };
//     JVARI_SCHEME(Mine, "mine", "A. Author 2026, eqs 3-9", "damping, thread, pluck", "none")
#pragma once

#include <cstdio>
#include <exception>

#include "jvari_scheme.h"

namespace jvari_open {

template <class Made>
void* make(const jvari_scheme*, const jvari_problem* problem, jvari_made* result) {
    try {
        auto* scheme = new Made(*problem);
        result->dofs = scheme->dofs();
        return scheme;
    } catch (const std::exception& e) {
        std::snprintf(result->why, sizeof result->why, "%s", e.what());
    } catch (...) {
        std::snprintf(result->why, sizeof result->why,
                      "the scheme throws something that is no std::exception while it is made");
        result->failed = 1;
    }
    return nullptr;
}
template <class Made>
jvari_scheme scheme(const char* name, const char* source, const char* represents,
                    const char* balance) {
    jvari_scheme s{};
    s.size = sizeof s;
    s.name = name, s.source = source, s.represents = represents, s.balance = balance;
    s.make = make<Made>;
    s.reset = [](void* self) { static_cast<Made*>(self)->reset(); };
    s.advance = [](void* self, jvari_rows* rows) {
        return static_cast<int>(static_cast<Made*>(self)->advance(*rows));
    };
    s.release = [](void* self) { delete static_cast<Made*>(self); };
    return s;
}

}  // namespace jvari_open

#define JVARI_SCHEME(Made, name, source, represents, balance)                 \
    extern "C" JVARI_EXPORT const jvari_plugin* jvari_schemes(void) {         \
        static const jvari_scheme one =                                       \
            jvari_open::scheme<Made>(name, source, represents, balance);      \
        static const jvari_scheme* const all[] = {&one};                      \
        static const jvari_plugin plugin = {                                  \
            sizeof plugin, JVARI_SCHEME_VERSION, all, 1, __VERSION__, "", 1}; \
        return &plugin;                                                       \
    }
