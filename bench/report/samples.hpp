// Sounds and spectrograms as the page carries them: 16 bit samples as base64.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "bench/report/results.hpp"
#include "bench/store/sound.hpp"
#include "bench/study/spectrogram_levels.hpp"

namespace jvari::bench::report {

nlohmann::ordered_json json_of(const study::Levels&);
nlohmann::ordered_json json_of(const store::Sound&, double longest);  // [s]

// of sounds.csv; throws UsageError where it is not below the folder
std::filesystem::path sound_file(const Results&, std::size_t row);
// The sounds of the folder that fit into `limit` bytes:
// references, runs that are the cheapest within an accuracy, highest rates, lowest rates, the rest.
nlohmann::ordered_json heard(const Results&, const store::Table& cheapest, double longest,
                             std::size_t limit, nlohmann::ordered_json& left_out);

}  // namespace jvari::bench::report
