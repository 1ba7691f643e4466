// What a comparison is asked for, whoever asks: the command line, a suite, a program.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace jvari::bench::compare {

struct SchemeOption {                 // --option [scheme:]name=value
    std::string scheme, name, value;  // scheme "": every scheme that knows the name
};

struct CompareRequest {
    std::string scene, reference, out;
    std::vector<std::string> schemes;  // none: every scheme that represents the scene
    std::vector<double> rates;         // [Hz]
    int modes = 0;
    std::optional<int> reference_modes;        // 0: doubled until nothing moves; absent: until no error that is shown depends on it
    bool controls = false;                     // with no schemes named, those that are known to be wrong too
    std::optional<double> duration, tap_rate;  // [s], [Hz]
    std::vector<std::string> set;              // overrides of the scene, "key.path=value"
    std::vector<SchemeOption> options;
    int repeats = 5;
    int jobs = 0;  // 0: as many as there are cores
};

}  // namespace jvari::bench::compare
