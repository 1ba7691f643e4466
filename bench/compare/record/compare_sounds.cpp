// What of a comparison is kept to be heard.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/compare/record/compare_record.hpp"

namespace jvari::bench::compare {

namespace {
constexpr std::size_t most_samples = 12'000'000;  // 24 MB of files

bool at_an_end(const Comparison& c, const study::Cell& cell) {  // of the rates of its scheme and options
    bool lowest = true, highest = true;
    for (const study::Record& r : c.outcome.records) {
        const study::Cell& other = r.cell;
        if (other.scheme != cell.scheme || other.settings.options != cell.settings.options || other.sound.samples.empty()) continue;
        lowest = lowest && cell.settings.sample_rate <= other.settings.sample_rate;
        highest = highest && cell.settings.sample_rate >= other.settings.sample_rate;
    }
    return lowest || highest;
}

std::string file_of(const study::Cell& cell) {  // "modal_two_point-compliance=matched-88200-133"
    std::string name = store::variant_name(cell.scheme->name, store::options_text(cell.settings.options));
    std::ranges::replace(name, ' ', '-');
    if (cell.settings.sample_rate > 0) name += fmt::format("-{}", store::text_of(cell.settings.sample_rate));
    return fmt::format("{}-{}", name, cell.modes());
}
}  // namespace

void write_sounds(const Comparison& c, const std::filesystem::path& folder) {
    const Tap& tap = c.scene().taps.at(c.headline.nut);
    std::size_t samples = 0;
    for (const study::Record& r : c.outcome.records) samples += r.cell.sound.samples.size();
    std::vector<store::NamedSound> sounds;
    const bool compared = !c.reference_sound.samples.empty();
    if (compared) sounds.push_back({{"reference", "", "", ""}, "reference", tap.name, name_of(tap.quantity), &c.reference_sound, ""});
    for (const study::Record& r : c.outcome.records) {
        const study::Cell& cell = r.cell;
        if (cell.sound.samples.empty() || (samples > most_samples && !at_an_end(c, cell))) continue;
        const std::string rate = cell.scheme->clock == Clock::continuous ? "" : store::text_of(cell.settings.sample_rate);
        sounds.push_back({{cell.scheme->name, store::options_text(cell.settings.options), rate, std::to_string(cell.modes())},
                          file_of(cell),
                          tap.name,
                          name_of(tap.quantity),
                          &cell.sound,
                          compared && cell.sound.rate == c.reference_sound.rate ? "reference" : ""});
    }
    if (!sounds.empty()) store::write_sounds(folder, {"scheme", "options", "rate", "modes"}, sounds);
}

}  // namespace jvari::bench::compare
