// What a suite can measure of a cell: errors and cost as compare has them, a spectrogram, and its
// sound.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "bench/study/job.hpp"

namespace jvari::bench::suite {

struct Facet {
    const char *name, *meaning;
};
std::span<const Facet> facets();

// A cell's samples and its reference's lie in its record, and become sounds/*.wav and sounds.csv.
void keep_sounds(const study::Ran&, study::Record&);
void write_sounds(const std::filesystem::path& folder, const study::Plan&,
                  const std::vector<study::Record>&);

}  // namespace jvari::bench::suite
