// One signal as a sound file holds it, in the unit that its samples are in: floating point as it is, whole numbers of full scale 1.
#pragma once

#include <filesystem>
#include <vector>

namespace jvari::bench::sound {

struct Signal {
    double rate = 0;  // [Hz]
    std::vector<double> samples;
};
Signal read_signal(const std::filesystem::path&);  // throws UsageError where it cannot be read or has several channels

}  // namespace jvari::bench::sound
