// What a comparison is asked for, whoever asks: the command line, a suite, a program.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace jvari::bench::compare {

// --option [scheme:]name=value; of one name several: each value is run
struct SchemeOption {
    std::string scheme, name, value;  // scheme "": every scheme that knows the name
    static SchemeOption of(const std::string& key, std::string text) {  // key: [SCHEME:]NAME
        const auto colon = key.find(':');
        return colon == std::string::npos
                   ? SchemeOption{"", key, std::move(text)}
                   : SchemeOption{key.substr(0, colon), key.substr(colon + 1), std::move(text)};
    }
};

struct CompareRequest {
    std::string scene, reference, out;
    std::vector<std::string> schemes;  // none: every scheme that represents the scene
    std::vector<double> rates;         // [Hz]; none: 44100 x 1, 2, 4 ... 64
    std::vector<int> modes;            // none: those below 20 kHz, and what `search` adds
    // 0: doubled until nothing moves; none: those of the cells
    std::optional<int> reference_modes = 0;
    // what is not named is sought: more modes, matched compliance. Not with a cell's reference
    bool search = true;
    // with no schemes named, those that are known to be wrong too
    bool controls = false;
    std::optional<double> duration, tap_rate;  // [s], [Hz]
    std::vector<std::string> set;              // overrides of the scene, "key.path=value"
    std::string tap;                           // the only one that is compared; "": all
    std::vector<SchemeOption> options;
    int repeats = 5;
    int jobs = 0;  // 0: as many as there are cores
};

}  // namespace jvari::bench::compare
