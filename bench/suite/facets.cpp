// What a suite measures of a cell. Dispersion: the true modes are those of van Walstijn et al.
// 2016, eqs 17-18 (scenes/modes.hpp): omega^2 = omega0^2 - sigma^2. Leaves out: the second plane of
// vibration, strings after the first, modes of string and thread together.
#include "bench/suite/facet.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numbers>

#include "analysis/dispersion.hpp"
#include "bench/store/base64.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/sound.hpp"
#include "bench/study/cause.hpp"
#include "bench/study/errors.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::suite {

namespace {
constexpr double two_pi = 2 * std::numbers::pi, nan = std::numeric_limits<double>::quiet_NaN();
constexpr double heard_below = 0.95;  // of half the rate

struct Heard {
    std::vector<double> signal;
    double rate = 0;   // [Hz]
    std::string note;  // why there is none
};

Heard heard(const MeasuredCell& c) {
    const String& s = c.scene.strings.front();
    if (const std::string why = study::why_no_partials(c.scene); !why.empty()) return {{}, 0, why};
    int tap = c.tap;
    for (int k = 0; k < c.trace.taps() && !study::hears_the_string(c.scene.taps[tap].quantity); ++k)
        tap = k;
    if (!study::hears_the_string(c.scene.taps[tap].quantity))
        return {{}, 0, "no tap hears the string"};
    Trace own;
    const Trace* trace = &c.trace;
    // else modes above half the tap rate fold back
    if (c.scheme.clock == Clock::stepped && c.settings.sample_rate > c.trace.tap_rate) {
        Settings every = c.settings;
        every.tap_rate = every.sample_rate;
        own = run(c.scheme, c.scene, every).trace;
        trace = &own;
    }
    std::span<const double> signal = trace->column(tap);
    if (s.pluck) {  // free from here on
        const double end = (s.pluck->start + s.pluck->duration) * trace->tap_rate;
        signal =
            signal.subspan(std::min(signal.size(), static_cast<std::size_t>(std::ceil(end)) + 1));
    }
    return {{signal.begin(), signal.end()}, trace->tap_rate, ""};
}
}  // namespace

store::Table dispersion_rows(const MeasuredCell& c) {
    store::Table t;
    t.columns = {"mode",        "frequency_hz",    "own_cents",         "trace_cents",
                 "decay_per_s", "own_decay_per_s", "trace_decay_per_s", "note"};
    const String& s = c.scene.strings.front();
    const bool stepped = c.scheme.clock == Clock::stepped;
    const double rate = stepped ? c.settings.sample_rate : c.trace.tap_rate;
    const int carried = stepped                ? modes_for(s, c.settings)
                        : c.settings.modes > 0 ? c.settings.modes
                                               : dispersion_modes;
    const int count =
        std::min({dispersion_modes, carried, modes_below(s, 0.5 * heard_below * rate)});
    if (count == 0) return t;
    const Modes modes = modes_of(s, count);
    const std::vector<FreeMode> own = make_scheme(c.scheme, c.scene, c.settings)->free_modes();
    const Heard h = heard(c);
    // the partials of a string lie no closer [Hz]
    const double gap = modes.omega0.front() / two_pi;
    for (int i = 0; i < count; ++i) {
        const double square = omega_squared_damped(modes.omega0[i], modes.sigma[i]);
        if (!(square > 0)) continue;
        const double hertz = std::sqrt(square) / two_pi;
        const bool known = i < static_cast<int>(own.size()) && own[i].omega > 0;
        const double own_hertz = known ? own[i].omega / two_pi : nan;
        Partial p{nan, nan, nan, nan};
        if (h.note.empty())
            p = strongest_near(h.signal, h.rate, known ? own_hertz : hertz, 0.4 * gap);
        if (!known && std::isnan(p.frequency) && !h.note.empty()) continue;  // nothing to say
        t.rows.push_back({std::to_string(i + 1), store::text_of(hertz),
                          store::text_of(cents(own_hertz, hertz)),
                          store::text_of(cents(p.frequency, hertz)), store::text_of(modes.sigma[i]),
                          store::text_of(known ? own[i].sigma : nan), store::text_of(p.decay),
                          !h.note.empty()           ? h.note
                          : std::isnan(p.frequency) ? "not heard"
                                                    : ""});
    }
    return t;
}

// ---- The row facet `sound`: one row per cell, its samples and its reference's as base64 of 16
// bit, which become files when all cells are there.

store::Table sound_rows(const MeasuredCell& c) {
    store::Table t{{"tap", "quantity", "sample_rate", "peak", "samples", "reference_peak",
                    "reference_samples"},
                   {}};
    const int tap = study::headline_of(c.scene).nut;
    const auto whole = static_cast<std::size_t>(c.scene.duration * c.trace.tap_rate);
    if (c.trace.column(tap).size() < whole) return t;  // it failed on its way
    const store::Sound own = store::sound_of(c.trace.column(tap), c.trace.tap_rate);
    if (own.samples.empty()) return t;
    const store::Sound reference =
        c.reference ? store::sound_of(c.reference->column(tap), c.reference->tap_rate)
                    : store::Sound{};
    t.rows.push_back({c.scene.taps.at(tap).name, name_of(c.scene.taps.at(tap).quantity),
                      store::text_of(own.rate), store::text_of(own.peak),
                      store::base64(own.samples), store::text_of(reference.peak),
                      store::base64(reference.samples)});
    return t;
}

void write_sound_rows(const std::filesystem::path& folder, const store::Table& g) {
    const std::vector<std::string> who(g.columns.begin(), g.columns.begin() + g.column("tap"));
    std::deque<store::Sound> sounds;
    // samples, file: cells of one reference share it
    std::map<std::string, std::string> references;
    std::vector<store::NamedSound> named;
    for (std::size_t i = 0; i < g.rows.size(); ++i) {
        const auto keep = [&](const char* peak, const char* samples) {
            return &sounds.emplace_back(store::Sound{g.number(i, "sample_rate"), g.number(i, peak),
                                                     store::samples_of_base64(g.at(i, samples))});
        };
        store::NamedSound own{
            {g.rows[i].begin(), g.rows[i].begin() + static_cast<long>(who.size())},
            g.at(i, "cell"),
            g.at(i, "tap"),
            g.at(i, "quantity"),
            keep("peak", "samples"),
            ""};
        if (const std::string& truth = g.at(i, "reference_samples"); !truth.empty()) {
            std::string& file = references[truth + g.at(i, "reference_peak")];
            if (file.empty()) {
                file = "reference-" + store::hash_of(truth + g.at(i, "reference_peak"));
                store::NamedSound reference{own.who,
                                            file,
                                            own.tap,
                                            own.quantity,
                                            keep("reference_peak", "reference_samples"),
                                            ""};
                for (const char* column : {"cell", "options", "rate"})
                    if (const int k = g.column(column); k >= 0)
                        reference.who[static_cast<std::size_t>(k)].clear();
                reference.who[static_cast<std::size_t>(g.column("scheme"))] = "reference";
                named.push_back(std::move(reference));
            }
            own.reference = file;
        }
        named.push_back(std::move(own));
    }
    if (!named.empty()) store::write_sounds(folder, who, named);
}

std::span<const Facet> facets() {
    static constexpr Facet all[] = {
        {measured::errors, "against the reference"},
        {measured::cost, "by the clock; with errors alone: no speed without an error"},
        {measured::spectrogram, "of the tap"},
        {"sound", "of cell and reference, to be heard", sound_rows},
        {"dispersion", "pitch and decay of each mode", dispersion_rows},
    };
    return all;
}

}  // namespace jvari::bench::suite
