// One identity for a scheme in every chart, picture and suite: the hue says its family, the marker which of the family it is, the dash what
// options it was given. Controls are thin and grey. Names that are no scheme (elements, plugins) take what is left, in the order of the
// alphabet.
//
// Colours: found by a search for the largest least distance in CIELAB between families, as seen with normal sight and without one kind of
// cones (Machado, Oliveira & Fernandes 2009), at a contrast of 3 or more to the page. charts_test.cpp measures both.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace jvari::bench::report {

struct Family {
    const char *name, *prefix;  // of the schemes' names
    const char *light, *dark;   // on a light page and on a dark one
};
std::span<const Family> families();  // in the order of legends; the last but one is of controls, the last of all others

// What is no scheme: a difference is in ink, the front a track with edges. The edges have a contrast of 3 or more to the page, what lies
// between them leaves the lines on it seen.
struct Neutral {
    const char *light, *dark;
};
constexpr Neutral ink{"#1d2329", "#e6eaee"}, front_edge{"#868c92", "#6f7780"}, front_track{"#f0f2f4", "#20272d"};

struct Identity {
    int family = 0;
    bool control = false;
    std::string colour, shape;  // on a light page; a symbol of Vega
    std::vector<int> dash;
};
// Of each name: "modal_two_point", "modal_two_point compliance=matched", "modal_two_point, 40 modes".
std::vector<Identity> identities_of(const std::vector<std::string>& names);

// The names as a legend has them: family by family, controls last.
std::vector<std::string> in_order(std::vector<std::string> names);

}  // namespace jvari::bench::report
