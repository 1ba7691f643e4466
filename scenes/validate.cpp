// Validates a scene: the range of each number (a pass over the schema), then rules that involve
// several values.
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <span>

#include "scenes/modes.hpp"
#include "scenes/schema.hpp"
#include "scenes/wording.hpp"

namespace jvari {

namespace {
struct Ranges : Pass<Ranges> {
    void number(const char* key, double x, const Range& range, const char* unit,
                std::optional<double> = {}) {
        if (!range.holds(x))
            throw BadScene(at(key), number_text(x),
                           range.says + (*unit ? " [" + std::string(unit) + "]" : ""));
    }
    void stiffness(const char* key, double k, const char* unit) {
        if (k != rigid) number(key, k, positive_or_rigid, unit);
    }
    void tension(const String& s) { number("tension", s.tension, not_negative, "N"); }
    void count(const char* key, int n) {
        if (n < 1) throw BadScene(at(key), std::to_string(n), "a whole number >= 1");
    }
    void columns(const char* key, const std::string&, const Column& first,
                 const std::vector<double>& a, const Column& second, const std::vector<double>& b) {
        const std::string here = *key ? at(key) : path;
        if (a.size() != b.size())
            throw BadScene(here,
                           std::to_string(a.size()) + " and " + std::to_string(b.size()) + " rows",
                           "columns of one length");
        if (a.empty()) throw BadScene(here, "no rows", "at least one");
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (!first.range.holds(a[i]) || (i > 0 && !(a[i - 1] < a[i])))
                throw BadScene(here,
                               std::string(first.name) + " " + number_text(a[i]) + " in row " +
                                   std::to_string(i + 1),
                               std::string(first.range.says) + ", above that of the row before");
            if (!second.range.holds(b[i]))
                throw BadScene(here,
                               std::string(second.name) + " " + number_text(b[i]) + " in row " +
                                   std::to_string(i + 1),
                               second.range.says);
        }
    }
    void start_table(const TableStart& t) {
        const Column at{t.of_modes ? "mode" : "x_m", "", not_negative};
        columns("", t.file, at, t.at, {"displacement_m", "", any}, t.displacement);
        columns("", t.file, at, t.at, {"velocity_m_per_s", "", any}, t.velocity);
    }
    void force(const char* key, const Pluck& p) {
        if (!p.file.empty())
            columns(key, p.file, {"time_s", "", not_negative}, p.time, {"force_N", "", any},
                    p.share);
    }
};

// ---- Against the string
struct On {
    const String& string;
    std::string path;
    // rounding can put the footprint of a whole string past its end
    double slack = 1e-12 * string.length;

    std::string between(const char* sign) const {
        return std::string("0 ") + sign + " x " + sign + " " + number_text(string.length) +
               " [m], on the string";
    }

    void inside(const std::string& part, double position) const {
        if (!(position > 0 && position < string.length))
            throw BadScene(path + part + ".position", number_text(position), between("<"));
    }
    void footprint(const std::string& part, double position, double width) const {
        inside(part, position);
        if (position - 0.5 * width < -slack || position + 0.5 * width > string.length + slack)
            throw BadScene(path + part + ".width", number_text(width),
                           "at most " +
                               number_text(2 * std::min(position, string.length - position)) +
                               " [m], so that the footprint ends on the string");
    }
    void curve(const std::string& part, const ProfileBarrier& b, const TableCurve& c) const {
        if (c.x.size() < 2)
            throw BadScene(path + part + ".file", std::to_string(c.x.size()) + " rows",
                           "at least two");
        for (const double x : {c.x.front(), c.x.back()})
            if (std::abs(x) > string.length + slack)
                throw BadScene(path + part + ".file", "x_m " + number_text(x),
                               between("<=") + "; is the table in mm?");
        if (c.x.front() > b.from || c.x.back() < b.to)
            throw BadScene(path + part + ".file",
                           "heights from " + number_text(c.x.front()) + " to " +
                               number_text(c.x.back()) + " m",
                           "them from " + number_text(b.from) + " to " + number_text(b.to) + " m");
    }
    void barrier(const std::string& part, const LumpedBarrier& b) const {
        footprint(part, b.position, b.width);
    }
    void without_law(const std::string& part, const auto& b) const {
        if (b.exponent != 1)
            throw BadScene(path + part + ".exponent", number_text(b.exponent),
                           "none, as the barrier is rigid");
        if (b.contact_loss != 0)
            throw BadScene(path + part + ".contact_loss", number_text(b.contact_loss),
                           "none, as the barrier is rigid");
    }
    // The string part under a width moves like a mass, 8 mu w/pi^2. Over a rigid barrier a law of
    // impact would have to define its rebound (docs/compliance-matching.md, "Rigid barriers"). A
    // stiffness 1e4 to 1e5 times the string's over that width represents rigid.
    void rigid_point(const std::string& part, const LumpedBarrier& b) const {
        constexpr double pi = std::numbers::pi, stiffer = 1e5, stiffest = 1e13;  // [1], [N/m]
        if (b.width == 0) return;
        const double of_string = string.tension / b.width +
                                 string.bending_stiffness * pi * pi / std::pow(b.width, 3),
                     instead = std::pow(10, std::floor(std::log10(stiffer * of_string)));
        throw BadScene(
            path + part + ".width", number_text(b.width),
            "0, as the barrier is rigid: over a width the string has a mass, and nothing "
            "says how a mass rebounds from what does not give way. To keep the width take "
            "stiffness = " +
                number_text(std::min(instead, stiffest)) + " [N/m]");
    }
    void rigid_point(const std::string&, const ProfileBarrier&) const {}
    void barrier(const std::string& part, const ProfileBarrier& b) const {
        if (b.from < 0 || b.from >= string.length)
            throw BadScene(path + part + ".from", number_text(b.from), between("<="));
        if (b.to < 0 || b.to > string.length + slack)
            throw BadScene(path + part + ".to", number_text(b.to), between("<="));
        if (b.from >= b.to)
            throw BadScene(path + part + ".to", number_text(b.to),
                           "a number above from, " + number_text(b.from) + " [m]");
        if (const auto* table = std::get_if<TableCurve>(&b.curve)) curve(part, b, *table);
    }
    void mass(const std::string& part, const Mass& m) const {
        footprint(part, m.position, m.width);
        if (m.weight > 0 && m.damping > 0 && m.spring == 0)
            throw BadScene(path + part + ".damping", number_text(m.damping),
                           "none beside a weight without a spring");
        if ((m.weight > 0 || m.joined()) && string.start &&
            std::holds_alternative<RestStart>(*string.start))
            throw BadScene(path + "start", "\"rest\"",
                           "another start beside a mass with a spring, a damper or a weight");
    }
    void without_tension() const {
        if (string.bending_stiffness == 0)
            throw BadScene(path + "tension", "0",
                           "a positive number [N], or beside it a bending_stiffness: a bar");
        if (std::holds_alternative<QualityFactorDamping>(string.damping))
            throw BadScene(path + "damping.law", "\"quality_factor\" without tension",
                           "another law: the bending loss of this one is a share of the tension");
    }
    void all() const {
        if (string.tension == 0) without_tension();
        for (std::size_t i = 0; i < string.barriers.size(); ++i) {
            const std::string part = "barrier." + std::to_string(i);
            std::visit([&](const auto& b) { barrier(part, b); }, string.barriers[i]);
            if (is_rigid(string.barriers[i]))
                std::visit(
                    [&](const auto& b) {
                        without_law(part, b);
                        rigid_point(part, b);
                    },
                    string.barriers[i]);
        }
        for (std::size_t k = 0; k < string.masses.size(); ++k)
            mass("mass." + std::to_string(k), string.masses[k]);
        if (string.thread) footprint("thread", string.thread->position, string.thread->width);
        if (string.pluck) footprint("pluck", string.pluck->position, string.pluck->width);
        if (string.velocity) shape("velocity", *string.velocity);
        if (!string.start) return;
        if (const auto* table = std::get_if<TableStart>(&*string.start)) rows(*table);
        if (const auto* triangle = std::get_if<TriangleShape>(&*string.start))
            shape("start", *triangle);
    }
    void shape(const std::string& part, const Shape& s) const {
        const auto* triangle = std::get_if<TriangleShape>(&s);
        if (!triangle) return;
        inside(part, triangle->position);
        if (triangle->smoothing > string.length)
            throw BadScene(
                path + part + ".smoothing", number_text(triangle->smoothing),
                "at most the length of the string, " + number_text(string.length) + " [m]");
    }
    void rows(const TableStart& t) const {
        for (std::size_t k = 0; k < t.at.size(); ++k) {
            const double x = t.at[k];
            if (t.of_modes ? x < 1 || x > most_modes || x != std::floor(x) : x > string.length)
                throw BadScene(path + "start", (t.of_modes ? "mode " : "x_m ") + number_text(x),
                               t.of_modes ? "whole numbers from 1 to " + std::to_string(most_modes)
                                          : between("<=") + "; is the table in mm?");
            if (!t.of_modes && (x == 0 || x == string.length) &&
                (t.displacement[k] != 0 || t.velocity[k] != 0))
                throw BadScene(path + "start", "an end of the string that is not at rest at 0",
                               "0 m and 0 m/s at both ends");
        }
    }
};

// ---- Taps
bool name_is_plain(const std::string& name) {  // the name heads a column in CSV files
    return !name.empty() &&
           name.find_first_not_of(
               "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-") ==
               std::string::npos &&
           name != "time_s" && name.rfind("energy_", 0) != 0;
}

void check(const Tap& tap, const Scene& scene, const std::string& path) {
    if (!name_is_plain(tap.name))
        throw BadScene(path + "name", found_text(tap.name),
                       "letters, digits, _ . and -, neither time_s nor energy_...");
    if (tap.string && (*tap.string < 0 || *tap.string >= static_cast<int>(scene.strings.size())))
        throw BadScene(path + "string", std::to_string(*tap.string),
                       "a string of the scene, 0 to " + std::to_string(scene.strings.size() - 1));
    if (!tap.string && (has_position(tap.quantity) || tap.mass))
        throw BadScene(path + "string", "nothing",
                       "the string whose " + std::string(name_of(tap.quantity)) + " is meant");
    if (tap.mass && !has_position(tap.quantity) && tap.quantity != Quantity::bridge_force)
        throw BadScene(path + "quantity", quote(name_of(tap.quantity)) + " of a mass",
                       "its \"displacement\", \"velocity\" or \"bridge_force\"");
    const char* lack = nullptr;
    if (tap.string) {
        const String& s = scene.strings[static_cast<std::size_t>(*tap.string)];
        lack = lacks(s, tap.quantity, tap.mass);
        if (has_position(tap.quantity) && !(tap.position >= 0 && tap.position <= s.length))
            throw BadScene(path + "position", number_text(tap.position), On{s, ""}.between("<="));
    } else {
        for (const String& s : scene.strings)
            if (!(lack = lacks(s, tap.quantity))) break;
    }
    if (lack)
        throw BadScene(path + "quantity",
                       quote(name_of(tap.quantity)) + " of a string without " + lack,
                       "a quantity that the string has");
}
}  // namespace

void validate(const Scene& scene) {
    Ranges ranges;
    fields(ranges, scene);
    if (const std::string wrong = scene.name.empty() ? "" : unfit_as_file(scene.name);
        !wrong.empty())
        throw BadScene("name", found_text(scene.name) + ", which " + wrong,
                       "a name that files can be called by");
    if (scene.strings.empty()) throw BadScene("string", "no string", "at least one [[string]]");
    for (std::size_t i = 0; i < scene.strings.size(); ++i)
        On{scene.strings[i], "string." + std::to_string(i) + "."}.all();
    std::set<std::string> names;
    for (std::size_t i = 0; i < scene.taps.size(); ++i) {
        const std::string path = "tap." + std::to_string(i) + ".";
        check(scene.taps[i], scene, path);
        if (!names.insert(scene.taps[i].name).second)
            throw BadScene(path + "name", quote(scene.taps[i].name) + " a second time",
                           "a unique name");
    }
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        const bool moves = s.axial_stiffness != 0 || (scene.body && !scene.body->modes.empty());
        if (moves && s.start && std::holds_alternative<RestStart>(*s.start))
            throw BadScene("string." + std::to_string(i) + ".start", "\"rest\"",
                           "another start of a string that stretches or ends on a moving body");
        if (moves && needed_by(scene).has(Feature::barrier_above))
            throw BadScene("string." + std::to_string(i) + ".barrier", "one above",
                           "none on a string that stretches or ends on a moving body");
        if (moves && !s.masses.empty())
            throw BadScene("string." + std::to_string(i) + ".mass", "a mass",
                           "none on a string that stretches or ends on a moving body");
    }
    if (scene.body && scene.body->bridge.empty() && scene.body->nut.empty() &&
        scene.body->modes.empty())
        throw BadScene("body", "neither bridge nor nut nor mode", "at least one of them");
}

}  // namespace jvari
