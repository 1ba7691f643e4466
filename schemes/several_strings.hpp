// Runs several strings in one scheme. Strings act on each other only through a body. Without a body
// each string is a separate scheme, and a tap that hears several strings hears the sum.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

// Makes one scheme per string and advances them one after the other. A tap on a string comes from
// that string alone; forces on all strings and the energy columns are sums in string order. The
// outcome comes from the string that fails first, and a failure names its string.
std::unique_ptr<Scheme> several_strings(const Descriptor&, const Scene&, const Settings&);

// ---- Single strings, for any scheme that steps them together.

struct HeardTap {  // a tap of the scene, on one string
    int column;
    bool first;  // true for the first string heard there, so that nothing is added to nothing
};
std::vector<HeardTap> heard_taps(const Scene&, int string, std::vector<bool>& heard_already);

std::vector<Fact> facts_of_string(int, std::vector<Fact>);  // names each fact after the string
std::string named_after_string(int, const char* refusal);
// The error gets the key from this string's own scene.
BadScene named_after_string(int, const BadScene&);

// Calls make(scene of that string alone); a refusal names the string if there are several.
template <class Make>
auto made_of_string(const Scene& scene, int string, Make make) {
    if (scene.strings.size() == 1) return make(alone(scene, string));
    try {
        return make(alone(scene, string));
    } catch (const BadScene& e) { throw named_after_string(string, e); } catch (const Refusal& e) {
        throw Refusal(named_after_string(string, e.what()));
    }
}

}  // namespace jvari
