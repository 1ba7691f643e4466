// Exports a table of Descriptor from a shared object. The schemes are written like the tree's
// schemes and linked with jvari's libraries. The source ends with
//
//     JVARI_PLUGIN(table)    // an array of Descriptor
//
// Only C crosses the boundary (open/jvari_scheme.h). The scene is read again from its text, so its
// obstacle tables must be found from the program's working directory. open/jvari_scheme.hpp is for
// schemes that need the problem's arrays and no library. Leaves out: limits.
#pragma once

#include <deque>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "schemes/open/jvari_scheme.h"
#include "schemes/scheme.hpp"

namespace jvari::plugin {

inline Scene scene_of(const jvari_problem& p) {
    if (p.measured == 0) return parse_scene(p.scene, p.name);
    Scene scene = parse_scene(p.scene, p.name, {"string.0.damping.law=none"});
    scene.strings.front().damping = TableDamping{"",
                                                 {p.measured_hz, p.measured_hz + p.measured},
                                                 {p.measured_decay, p.measured_decay + p.measured}};
    return scene;
}
inline Settings settings_of(const jvari_problem& p) {
    Settings s{p.sample_rate, p.tap_rate, static_cast<int>(p.modes_asked), {}};
    for (std::int64_t k = 0; k < p.options; ++k)
        s.options.emplace_back(p.option_names[k], p.option_values[k]);
    return s;
}

struct State {
    std::unique_ptr<Scheme> scheme;
    std::vector<double> omega, decay;
    std::vector<Fact> facts;
    std::string failure;
};

inline void tell(jvari_made& result, const std::string& why, bool failed) {
    why.copy(result.why, sizeof result.why - 1);
    result.failed = failed;
}
inline void* make(const jvari_scheme* table, const jvari_problem* problem, jvari_made* result) {
    try {
        auto state = std::make_unique<State>();
        const auto& d = *static_cast<const Descriptor*>(table->own);
        state->scheme = d.make(d, scene_of(*problem), settings_of(*problem));
        if (!state->scheme)
            return tell(*result,
                        std::string(d.name) + " makes no scheme, and does not refuse it either",
                        true),
                   nullptr;
        for (const FreeMode& m : state->scheme->free_modes())
            state->omega.push_back(m.omega), state->decay.push_back(m.sigma);
        result->dofs = state->scheme->dofs();
        result->free_modes = static_cast<std::int64_t>(state->omega.size());
        result->omega = state->omega.data(), result->decay = state->decay.data();
        return state.release();
    } catch (const Refusal& e) { tell(*result, e.what(), false); } catch (const BadScene& e) {
        tell(*result, e.what(), false);
    } catch (const std::exception& e) { tell(*result, e.what(), true); } catch (...) {
        tell(*result, "the scheme throws something that is no std::exception while it is made",
             true);
    }
    return nullptr;
}
inline int advance(void* self, jvari_rows* rows) {
    Block out{static_cast<int>(rows->rows), static_cast<int>(rows->taps),
              static_cast<long>(rows->stride), rows->tap, rows->energy};
    if (rows->stop) {
        out.stop = [](void* caller) {
            return static_cast<jvari_rows*>(caller)->stop(
                       static_cast<jvari_rows*>(caller)->caller) != 0;
        };
        out.caller = rows;
    }
    const Status status = static_cast<State*>(self)->scheme->advance(out);
    rows->failed_step = status.step;
    return static_cast<int>(status.outcome);
}
inline std::int64_t facts(void* self, jvari_fact* to, std::int64_t room) {
    State& state = *static_cast<State*>(self);
    try {
        state.facts = state.scheme->facts();
        for (std::int64_t k = 0; k < std::min(room, static_cast<std::int64_t>(state.facts.size()));
             ++k) {
            const Fact& f = state.facts[static_cast<std::size_t>(k)];
            to[k] = {f.name.c_str(), f.unit.c_str(), f.value};
        }
        return static_cast<std::int64_t>(state.facts.size());
    } catch (const std::exception& e) { state.failure = e.what(); } catch (...) {
        state.failure =
            "the scheme throws something that is no std::exception while it tells its facts";
    }
    to[0].name = state.failure.c_str();
    return -1;
}

class Tables {  // tables for the schemes in one plugin, made on first use
public:
    explicit Tables(std::span<const Descriptor> all, const char* flags, bool optimised) {
        for (const Descriptor& d : all) add(d);
        for (const jvari_scheme& s : schemes_) pointers_.push_back(&s);
        plugin_ = {sizeof plugin_,   JVARI_SCHEME_VERSION,
                   pointers_.data(), static_cast<std::int64_t>(pointers_.size()),
                   __VERSION__,      flags,
                   optimised};
    }
    Tables(const Tables&) = delete;
    Tables& operator=(const Tables&) = delete;
    const jvari_plugin& table() const { return plugin_; }

private:
    const char* keep(std::string text) { return texts_.emplace_back(std::move(text)).c_str(); }
    void add(const Descriptor& d) {
        jvari_scheme& s = schemes_.emplace_back();
        s.size = sizeof s;
        s.name = d.name, s.source = d.source, s.note = d.note, s.own = &d;
        s.represents = keep(names_of(d.represents));
        s.balance = d.balance == Balance::exact  ? "exact"
                    : d.balance == Balance::none ? "none"
                                                 : "to tolerance";
        std::string approximates;
        for (const Approximation& a : d.approximates)
            approximates += (approximates.empty() ? "" : ", ") + std::string(name_of(a.feature)) +
                            ": " + a.fact.name;
        s.approximates = keep(approximates);
        auto& options = options_.emplace_back();
        for (const Option& o : d.options) {
            std::string words;
            for (const char* word : o.words())
                words += (words.empty() ? "" : " ") + std::string(word);
            options.push_back(
                {o.name, o.fallback, o.meaning, words.empty() ? nullptr : keep(words)});
        }
        s.options = options.data(), s.option_count = static_cast<std::int64_t>(options.size());
        if (d.make) s.make = make;
        s.reset = [](void* self) { static_cast<State*>(self)->scheme->reset(); };
        s.advance = advance;
        s.release = [](void* self) { delete static_cast<State*>(self); };
        s.facts = facts;
    }
    std::deque<jvari_scheme> schemes_;
    std::deque<std::string> texts_;
    std::deque<std::vector<jvari_option>> options_;
    std::vector<const jvari_scheme*> pointers_;
    jvari_plugin plugin_{};
};

#if defined(__OPTIMIZE__)
inline constexpr bool optimised = true;
#else
inline constexpr bool optimised = false;
#endif
inline const std::string& compiled_with() {  // compiler flags of the plugin
    static const std::string flags = std::string(optimised ? "optimised" : "not optimised") +
#if defined(NDEBUG)
                                     ", NDEBUG"
#else
                                     ", assertions"
#endif
#if defined(__AVX512F__)
                                     ", AVX-512"
#elif defined(__AVX2__)
                                     ", AVX2"
#elif defined(__AVX__)
                                     ", AVX"
#endif
#if defined(__FMA__)
                                     ", FMA"
#endif
#if defined(__FAST_MATH__)
                                     ", fast math"
#endif
        ;
    return flags;
}

// Exported although the rest is compiled with -fvisibility=hidden.
#define JVARI_PLUGIN(schemes)                                                                      \
    extern "C" JVARI_EXPORT const jvari_plugin* jvari_schemes(void) {                              \
        static const jvari::plugin::Tables tables(schemes, jvari::plugin::compiled_with().c_str(), \
                                                  jvari::plugin::optimised);                       \
        return &tables.table();                                                                    \
    }

}  // namespace jvari::plugin
