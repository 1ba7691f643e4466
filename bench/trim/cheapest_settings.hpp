// Step 1 and 3 of the search: with given parts left out, the cheapest scheme, options, rate and
// number of modes within the tolerance.
//
// Modes are searched up to four times those below 20 kHz, as far as half the rate allows.
//
// Every variant (a scheme, own or matched compliance) is looked at first at two rates, with the
// most modes down to a quarter of them. Whose error is not within at either and would not be at the
// highest rate, even if it fell by twice the order seen between the two, is passed over. The others
// are searched in the order of what the first look says they cost, so that the clock ends the dear
// ones early.
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
// a judged run is probed: it takes at most so much longer
inline constexpr double judged_over_timed = 4;

struct Found {
    Model model;
    double error, cost;  // worst of the starts; [s of processor per s]
    // Cheaper by a twentieth, which a clock can tell; of costs that are closer the more accurate.
    bool better_than(const Found& o) const {
        return cost < worth * o.cost || (worth * cost <= o.cost && error < o.error);
    }
};

struct Variant {
    const Descriptor* scheme;
    OptionValues options;
    std::string name() const;
};
// The values asked for; of options that nobody named compliance=matched too, and with it fewer
// points of a profile.
std::vector<Variant> variants_of(const Descriptor&, const Scene&,
                                 const std::vector<compare::SchemeOption>& = {});

class CheapestSettings {
public:
    CheapestSettings(Judge&, const std::vector<int>& starts, const store::Listener&);

    Judge& judge() { return judge_; }
    // the worst; nothing where one start is not within
    std::optional<double> error_within(const Model&, double limit);
    // limit: a cost [s per s] that makes it pointless
    Verdict judged(const Model&, int start, double limit);

    // Between two rates; nothing that costs `limit` or more is looked for.
    std::optional<Found> of_variant(const Variant&, const std::vector<int>& left_out, double from,
                                    double to, double limit);
    std::optional<Found> of_all(const std::vector<const Descriptor*>&,
                                const std::vector<int>& left_out, double limit);
    // The whole scene with no option set, so that compliance is the scheme's own: the cheapest that
    // serves, else the nearest that was judged; nothing where none was sound.
    std::optional<Found> as_published(const std::vector<const Descriptor*>&, bool& within);

    std::vector<std::string> passed_over() const;  // after a first look: "name (its errors)"

private:
    struct Look {
        Variant variant;
        // [s per s] as judged, at the cheaper rate that is within; infinite where neither is
        double cost;
    };
    std::optional<Found> of_variants(const std::vector<Variant>&, const std::vector<int>& left_out,
                                     double limit);
    std::vector<Look> looked(const std::vector<Variant>&, const std::vector<int>& left_out,
                             double limit);
    std::optional<Model> nearest_;  // as published
    double nearest_error_ = HUGE_VAL;
    bool hopeless(double error_at_the_lower_rate, double at_the_higher) const;
    std::optional<Found> fewest(const Variant&, const std::vector<int>& left_out, double rate,
                                double limit, bool& too_dear);
    std::vector<int> ladder(const Model&) const;

    Judge& judge_;
    std::vector<int> starts_;  // that it is judged by
    std::unique_ptr<store::Progress> progress_;
    std::string best_said_ = "none is within the tolerance yet";
    double tap_rate_;
    std::map<std::string, std::string> passed_over_;  // by variant
};

}  // namespace jvari::bench::trim
