// What a suite measures of a cell.
#include "bench/suite/facet.hpp"

#include <deque>
#include <map>

#include "bench/store/base64.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/sound.hpp"
#include "bench/study/errors.hpp"
#include "bench/suite/suite.hpp"

namespace jvari::bench::suite {

// ---- The row facet `sound`: one row per cell, its samples and its reference's as base64 of 16
// bit, which become files when all cells are there.

store::Table sound_rows(const study::Ran& c) {
    store::Table t{{"tap", "quantity", "sample_rate", "peak", "samples", "reference_peak",
                    "reference_samples"},
                   {}};
    const int tap = study::headline_of(c.point.scene).nut;
    const auto whole = static_cast<std::size_t>(c.point.scene.duration * c.trace.tap_rate);
    if (c.trace.column(tap).size() < whole) return t;  // it failed on its way
    const store::Sound own = store::sound_of(c.trace.column(tap), c.trace.tap_rate);
    if (own.samples.empty()) return t;
    const store::Sound reference =
        c.reference ? store::sound_of(c.reference->column(tap), c.reference->tap_rate)
                    : store::Sound{};
    t.rows.push_back({c.point.scene.taps.at(tap).name, name_of(c.point.scene.taps.at(tap).quantity),
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
    };
    return all;
}

}  // namespace jvari::bench::suite
