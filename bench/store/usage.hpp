// Errors for requests that cannot be met.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scenes/wording.hpp"

namespace jvari::bench::store {

// The request is invalid; the message says which input was expected.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The output could not be written: a full disk, or a reader that went away.
struct Unwritable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// "unknown scheme "modal_two": did you mean modal_two_point?", or the list of known names.
inline std::string unknown(const std::string& kind, const std::string& word,
                           const std::vector<std::string>& known) {
    const std::string near = nearest(word, known);
    return "unknown " + kind + " " + found_text(word) + "; " +
           (!near.empty()   ? "did you mean " + quote(near) + "?"
            : known.empty() ? "there is none"
            : known.size() > 12
                ? std::string(kind == "promise" ? "`jvari help check`" : "`jvari list`") +
                      " has all that there are"
                : "there is " + list_of(known));
}

}  // namespace jvari::bench::store
