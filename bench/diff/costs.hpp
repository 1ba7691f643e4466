// Costs of two folders, side by side. Source: the rule of ties of this program (two costs whose
// quartiles touch are a tie).
//
// Compared is the lower quartile of processor time, where both folders have it: what other programs
// take of the machine is not in it, and what they disturb is slower. Else the median of wall time.
//
// A clock tells two runs of one machine apart only beyond what the machine itself does meanwhile,
// and that is of two kinds. All cells drift together (another clock frequency, a busy neighbour),
// and single cells are disturbed. Both are measured by the cells themselves. The drift is the
// median ratio of those of the same rate, which are timed in turn, or of all where they are few.
// The disturbance is 1.4826 times the median distance from it, in logarithms (the standard
// deviation, were it a normal one). A series, that is a scheme with its options on a problem over
// its rates, got slower where the median of its ratios lies beyond the drift by 15 % and by five
// disturbances of such a median (sqrt(pi/2n) of those of n cells), and in most of its cells the
// quartiles stay apart after the drift is taken off. With fewer than three series the drift cannot
// be told from them: what is apart has moved. Costs of two machines are not compared.
#pragma once

#include <string>
#include <vector>

#include "bench/diff/folder.hpp"

namespace jvari::bench::diff {

struct Difference;
struct Pair {  // what both have
    std::string name;
    std::size_t before, after;  // rows of the two tables
};

constexpr double least_change = 1.15;  // times
constexpr double disturbances = 5;
constexpr std::size_t fewest_series = 3;
constexpr double told = 1.25;  // times: a drift that a note tells

void compare_costs(const Folder& before, const Folder& after, const std::vector<Pair>&,
                   Difference&);

}  // namespace jvari::bench::diff
