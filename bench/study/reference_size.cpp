#include "bench/study/reference_size.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>

#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::study {

namespace {
constexpr int most_modes_found = 4096;
constexpr double rows_of_audio = 44100;  // rate for the numbers below [Hz]
// Budget [s] for a run of ten to twenty seconds. The work is motion [s] times modes^2 (times 1 +
// half the number of barriers beyond the second), or times 14 modes^2 + 2800 points^2 for a
// profile, times the relative cost of the reference. A short or stiff string costs more than
// modes^2.
constexpr double budget = 1.5e6;
// Spacing of the modes [Hz]. Windows of the exact solution get as short as the fastest mode
// requires. With this spacing or less, `modes^2` describes the work. For a shorter or stiffer
// string, the work is modes times the highest frequency divided by this spacing.
constexpr double mode_spacing = 500;

// Relative cost for the same work, in units of the closed forms for a lumped linear contact,
// measured on two_point_bridge and tanpura_c3_release. Integrating a contact in steps costs up to
// twice as much for a lumped barrier, where the windows between contacts are most of the work. For
// a profile it costs 2 to 50 times as much, and the clock ends what takes too long. A stiff
// integrator costs more.
double dearness(const Descriptor& reference, const Scene& scene) {
    const Features needed = needed_by(scene);
    if (reference.name == std::string_view(sundials.name)) return 1000;
    if (!needed.has(Feature::power_law_contact) && !needed.has(Feature::contact_loss)) return 1;
    return 2;
}

// Number of measured modes if all strings are tables; else 0. Such a table is the string itself, so
// no further mode is left out.
int measured_modes(const Scene& scene) {
    int all = 0;
    for (const String& s : scene.strings) {
        const auto modes = modes_measured(s);
        if (!modes) return 0;
        all = all == 0 ? *modes : std::min(all, *modes);
    }
    return all;
}

double highest_of(const String& s, int modes) {  // [Hz]
    return modes_of(s, std::min(modes, modes_measured(s).value_or(modes))).omega0.back() /
           (2 * std::numbers::pi);
}

// Rate [Hz] of the rows, or of rows that would hold the modes from which a reference begins: a
// lower row rate does not make the reference cheaper.
double pace(const Scene& scene, double tap_rate) {
    const int first = modes_to_begin_with(scene, tap_rate, 0);
    double rate = tap_rate;
    for (const String& s : scene.strings)
        if (first > 0) rate = std::max(rate, highest_of(s, first) * rows_of_audio / 20e3);
    return rate;
}

bool is_nodes(const std::pair<std::string, std::string>& o) { return o.first == nodes_option.name; }
}  // namespace

std::string Size::text() const {
    return fmt::format("{} modes", modes) +
           (points > 0 ? fmt::format(" and {} points", points) : "");
}

int Sizes::most_modes() const { return measured > 0 ? measured : 2 * most_modes_found; }

Sizes sizes_of(const ReferenceChoice& c, const Scene& scene, int modes, int begin) {
    Sizes s;
    s.measured = modes == 0 ? measured_modes(scene) : 0;
    const int first =
        s.measured > 0 ? s.measured : modes_to_begin_with(scene, c.settings.tap_rate, begin);
    const auto nodes = std::ranges::find_if(c.settings.options, is_nodes);
    const bool points_asked = nodes != c.settings.options.end();
    int points = 0;
    if (needed_by(scene).any(any_profile))
        points = points_asked ? profile_points(c.settings).count : std::stoi(nodes_option.fallback);
    s.doubled = modes == 0 && !(points_asked && points > 0);
    Size last{modes > 0 ? modes : first, points};
    for (int k = 0; modes == 0 && !s.doubled && s.measured == 0 && k < 2; ++k)
        if (const Size more{2 * last.modes, points};
            within_budget(*c.scheme, scene, c.settings.tap_rate, more))
            last = more;
    const auto add = [&](int part, int part_of_points) {
        const Size one{s.measured > 0 ? last.modes : std::max(1, last.modes / part),
                       points / part_of_points};
        if ((points == 0 || one.points > 0) && (s.each.empty() || one != s.each.back()))
            s.each.push_back(one);
    };
    if (s.doubled) {
        for (const int part : {4, 2, 1})
            if (points > 0 || part == 1) add(part, 4);
        return s;
    }
    add(4, 4);
    for (const int part : {2, 1}) {
        add(part, 2 * part);
        add(part, part);
    }
    return s;
}

bool within_budget(const Descriptor& reference, const Scene& scene, double tap_rate, const Size& s,
                   double effort) {
    std::size_t contacts = 2;  // The closed forms take two contacts at the same cost.
    for (const String& string : scene.strings)
        contacts = std::max(contacts, string.barriers.size() + string.masses.size());
    const double coupled = s.points > 0 ? 13 : 0.5 * static_cast<double>(contacts - 2);
    const double unit = pace(scene, tap_rate) / rows_of_audio;
    double work = 0;
    for (const String& string : scene.strings) {
        const double fastest = highest_of(string, s.modes) / (unit * mode_spacing);
        work += scene.duration * unit *
                (s.modes * std::max<double>(s.modes, fastest) * (1 + coupled) +
                 2800.0 * s.points * s.points);
    }
    return s.points <= most_points && s.modes <= most_modes_found &&
           work * dearness(reference, scene) <= budget * effort;
}

ReferenceChoice sized(ReferenceChoice choice, const Size& s) {
    choice.settings.modes = s.modes;
    if (s.points == 0) return choice;
    std::erase_if(choice.settings.options, is_nodes);
    if (s.points != std::stoi(nodes_option.fallback))
        choice.settings.options.emplace_back(nodes_option.name, std::to_string(s.points));
    return choice;
}

}  // namespace jvari::bench::study
