// Facets: a suite's measurements on a cell.
#include "bench/suite/suite.hpp"

#include <map>

#include "bench/store/encoding.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::suite {

namespace {
const Tap& heard_tap(const Scene& scene) { return scene.taps.at(study::headline_of(scene).nut); }
}  // namespace

void keep_sounds(const study::Ran& c, study::Record& into) {
    const int tap = study::headline_of(c.point.scene).nut;
    const auto whole = static_cast<std::size_t>(c.point.scene.duration * c.trace.tap_rate);
    if (c.trace.column(tap).size() < whole) return;  // the run failed on its way
    into.cell.sound = store::sound_of(c.trace.column(tap), c.trace.tap_rate);
    if (c.reference && !into.cell.sound.samples.empty())
        into.reference_sound = store::sound_of(c.reference->column(tap), c.trace.tap_rate);
}

void write_sounds(const std::filesystem::path& folder, const study::Plan& plan,
                  const std::vector<study::Record>& records) {
    const store::Table all = study::table_of(study::cells_of(plan, records), study::Contents::cost);
    std::vector<std::string> who(all.columns.begin(),
                                 all.columns.begin() + all.column("options") + 1);
    who.insert(who.end(), {"rate", "modes"});
    const store::Table cells = all.only(who);
    // samples, file: cells with the same reference share the file
    std::map<std::string, std::string> references;
    std::vector<store::NamedSound> named;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const study::Record& r = records[i];
        if (r.cell.sound.samples.empty()) continue;
        const Tap& tap = heard_tap(plan.jobs[i].point->scene);
        store::NamedSound own{cells.rows[i],         cells.text(i, "cell"), tap.name,
                              name_of(tap.quantity), &r.cell.sound,         ""};
        if (!r.reference_sound.samples.empty()) {
            const std::string samples =
                store::base64(r.reference_sound.samples) + store::text_of(r.reference_sound.peak);
            std::string& file = references[samples];
            if (file.empty()) {
                file = "reference-" + store::hash_of(samples);
                store::NamedSound& reference = named.emplace_back(own);
                reference.file = file;
                reference.sound = &r.reference_sound;
                for (const char* column : {"cell", "options", "rate"})
                    reference.who[static_cast<std::size_t>(cells.column(column))] = {};
                reference.who[static_cast<std::size_t>(cells.column("scheme"))] = "reference";
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
        {measured::sound, "of cell and reference, to be heard"},
        {measured::advice, "what two runs advise for 1 %, as a cell, and whether it holds"},
        {measured::outcome,
         "of each run on a map, over one or two swept keys, with its boundaries and failures"},
        {measured::share, "of the strings of a population that are solved, and advice on each"},
    };
    return all;
}

}  // namespace jvari::bench::suite
