// Why no cell is as accurate as asked, and what to do: a few sentences where a table would say
// "none".
//
// They name the closest cell and what stands in the way: the motion's sensitivity, the reference,
// the modes left out, or the rate. Of the rate there are three cases: too few rates to extrapolate,
// errors that do not fall, and a rate that would do or is out of reach. The last sentence says what
// can be judged instead.
#pragma once

#include <string>

#include "bench/compare/bound.hpp"

namespace jvari::bench::compare {

// `rows`: of one scene, timed and trusted; `measure`: a relative L2; `most`: what none of them is
// within.
std::string why_none(const study::Cells&, const study::Rows&, std::size_t measure, double most);

std::string percent(double share);  // "0.43 %", "97 %"
// "1.3 %", "\u2264 20 %" where the reference's uncertainty counts, "2.1 dB"
std::string quoted(const Bound&, std::size_t measure);
std::string time_text(double seconds);  // "8 ms", "280 ms", "1.2 s"

}  // namespace jvari::bench::compare
