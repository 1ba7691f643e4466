// Several strings as one scheme. Strings act on each other only through a body; without one each is
// a scheme of its own, and what is heard of all of them is a sum.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

// One scheme per string of the scene, advanced one after the other: taps of one string are that
// string's, forces of all strings and the energy columns are sums in the order of the strings. The
// outcome is that of the string that fails first; what fails names its string.
std::unique_ptr<Scheme> several_strings(const Descriptor&, const Scene&, const Settings&);

// ---- One string of several, for whatever steps them together.

struct HeardTap {  // of the scene, by one string
    int column;
    bool first;  // the first string that is heard there, so that nothing is added to nothing
};
std::vector<HeardTap> heard_taps(const Scene&, int string, std::vector<bool>& heard_already);

std::vector<Fact> facts_of_string(int, std::vector<Fact>);  // named after it
std::string named_after_string(int, const char* refusal);
// its key: that of the scene of this string alone
BadScene named_after_string(int, const BadScene&);

// make(scene of that string alone); what it refuses names the string, where there are several.
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
