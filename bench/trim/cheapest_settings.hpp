// Step 1 and 3 of the search: with given parts left out, the cheapest scheme, options, rate and number of modes within the tolerance.
//
// Every variant (a scheme, own or matched compliance) is looked at first with all its modes at two rates. Whose error is not within at
// either and would not be at the highest rate, even if it fell by twice the order seen between the two, is passed over. The others are
// searched in the order of what the first look says they cost, so that the clock ends the dear ones early.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/trim/judge.hpp"

namespace jvari::bench::trim {

inline constexpr std::array multiples{1, 2, 4, 8, 16, 32};  // of the tap rate
inline constexpr double longest = 10;                       // of one judged run [s]
inline constexpr double judged_over_timed = 4;              // a judged run is probed: it takes at most so much longer

struct Found {
    Model model;
    double error, cost;  // worst of the starts; [s of processor per s]
};

struct Variant {
    const Descriptor* scheme;
    OptionValues options;
    std::string name() const;
};
std::vector<Variant> variants_of(const Descriptor&, const Scene&);

class CheapestSettings {
public:
    CheapestSettings(Judge&, int judged_starts, const store::Listener&);

    Judge& judge() { return judge_; }
    std::optional<double> error_within(const Model&, double limit);  // the worst; nothing where one start is not within
    double worst_error(const Model&);                                // NaN where one start fails
    Verdict judged(const Model&, int start, double limit);           // limit: a cost [s per s] that makes it pointless

    // Between two rates; nothing that costs `limit` or more is looked for.
    std::optional<Found> of_variant(const Variant&, const std::vector<int>& left_out, double from, double to, double limit);
    std::optional<Found> of_all(const std::vector<const Descriptor*>&, const std::vector<int>& left_out, double limit);

    std::vector<std::string> passed_over() const;  // after a first look: "name (its errors)"

private:
    struct Look {
        Variant variant;
        double cost;  // [s per s] as judged, at the cheaper rate that is within; infinite where neither is
    };
    std::vector<Look> looked(const std::vector<Variant>&, const std::vector<int>& left_out, double limit);
    bool hopeless(double error_at_the_lower_rate, double at_the_higher) const;
    std::optional<Found> fewest(const Variant&, const std::vector<int>& left_out, double rate, double limit, bool& too_dear);
    std::vector<int> ladder(const Model&) const;

    Judge& judge_;
    int starts_;
    std::unique_ptr<store::Progress> progress_;
    std::string best_said_ = "none is within the tolerance yet";
    double tap_rate_;
    std::map<std::string, std::string> passed_over_;  // by variant
};

}  // namespace jvari::bench::trim
