#include "bench/store/usage.hpp"

#include "scenes/wording.hpp"

namespace jvari::bench::store {

std::string unknown(const std::string& kind, const std::string& word,
                    const std::vector<std::string>& known) {
    const std::string near = nearest(word, known);
    return "unknown " + kind + " " + found_text(word) + "; " +
           (!near.empty()   ? "did you mean " + quote(near) + "?"
            : known.empty() ? "there is none"
                            : "there is " + list_of(known));
}

}  // namespace jvari::bench::store
