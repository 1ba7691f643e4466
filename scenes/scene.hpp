// Scene: the continuous problem in SI units, with no sample rate, grid or mode count in it.
//
// A plain value: every part is a struct, an absent part is an empty optional or vector. Reading
// from TOML: scene_file.hpp.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace jvari {

// ---- Losses of the free string: sigma(beta) or sigma(mode) [1/s]; damping.hpp contains the laws.

struct NoDamping {
    bool operator==(const NoDamping&) const = default;
};
// sigma = sigma0 + sigma1 beta + sigma3 beta^3   (van Walstijn et al. 2016, eq 18)
struct PolynomialDamping {
    double sigma0 = 0;  // [1/s]
    double sigma1 = 0;  // [m/s]
    double sigma3 = 0;  // [m^3/s]
    bool operator==(const PolynomialDamping&) const = default;
};
struct QualityFactorDamping {       // Issanchou et al. 2016, eq 12 and below
    double diameter = 0;            // [m]
    double air_viscosity = 0;       // [kg/(m s)]
    double air_density = 0;         // [kg/m^3]
    double viscoelastic_angle = 0;  // delta_ve [rad]
    double thermoelastic_loss = 0;  // 1/Q_te
    bool operator==(const QualityFactorDamping&) const = default;
};
struct TableDamping {                  // measured modes: replaces both frequency and decay
    std::string file;                  // path written in the scene
    std::vector<double> frequency_hz;  // one per mode, ascending
    std::vector<double> decay_rate;    // sigma [1/s]
    // numbers of the modes missing from the file; their values are interpolated between their
    // neighbours
    std::vector<int> filled = {};
    bool operator==(const TableDamping&) const = default;
};
// amplitude factor per first-mode period, the same decay rate for every mode (Deshmukh)
struct PerPeriodDamping {
    double factor = 1;
    bool operator==(const PerPeriodDamping&) const = default;
};
using Damping = std::variant<NoDamping, PolynomialDamping, QualityFactorDamping, TableDamping,
                             PerPeriodDamping>;

// ---- The obstacle. V(eta) = k [eta]^(exponent+1)/(exponent+1), eta = h - y the penetration, F =
// V'(eta) >= 0 on the string.

// a stiffness value: the barrier does not give way at all
inline constexpr double rigid = std::numeric_limits<double>::infinity();
struct LumpedStiffness {
    double k = 0;  // [N/m^exponent], or rigid
    bool operator==(const LumpedStiffness&) const = default;
};
struct StiffnessDensity {
    double K = 0;  // [N/m^(exponent+1)], or rigid
    bool operator==(const StiffnessDensity&) const = default;
};
// Effect of a contact loss on the spring's force F_s while the string leaves at the speed v: F_s (1
// - beta v), which pulls if v > 1/beta, or with `clipped` 0 in place of a pull.
enum class LossLaw { hunt_crossley, clipped };
// Side of the string at which a barrier stands. One above pushes the string down, where y > height.
enum class Side { below, above };
// one force, averaged over a cosine footprint (van Walstijn et al. 2016, eqs 5-8)
struct LumpedBarrier {
    double position = 0;  // centre [m]
    double width = 0;     // footprint [m]; 0: a point
    double height = 0;    // [m]
    LumpedStiffness stiffness;
    double exponent = 1;
    double contact_loss = 0;  // Hunt-Crossley beta [s/m]
    LossLaw loss_law = LossLaw::hunt_crossley;
    Side side = Side::below;
    // The law of a barrier below holds for one above in the coordinate -y.
    double sign() const { return side == Side::above ? -1 : 1; }
    bool operator==(const LumpedBarrier&) const = default;
};
struct FlatCurve {  // g = 0
    bool operator==(const FlatCurve&) const = default;
};
struct LineCurve {
    double coefficient = 0;  // g = coefficient x
    bool operator==(const LineCurve&) const = default;
};
struct ParabolaCurve {
    double coefficient = 0;  // g = -coefficient x^2 [1/m]   (Issanchou et al. 2016, eq 29)
    bool operator==(const ParabolaCurve&) const = default;
};
struct TableCurve {
    std::string file;
    std::vector<double> x, height;  // [m], x ascending
    bool operator==(const TableCurve&) const = default;
};
using Curve = std::variant<FlatCurve, LineCurve, ParabolaCurve, TableCurve>;
struct ProfileBarrier {  // a force density along from <= x <= to (Issanchou et al. 2016, eqs 3-4)
    Curve curve;
    double from = 0, to = 0;  // [m]
    StiffnessDensity stiffness;
    double exponent = 1;
    double contact_loss = 0;  // [s/m]
    LossLaw loss_law = LossLaw::hunt_crossley;
    bool operator==(const ProfileBarrier&) const = default;
};
inline bool is_rigid(const LumpedBarrier& b) { return b.stiffness.k == rigid; }
inline bool is_rigid(const ProfileBarrier& b) { return b.stiffness.K == rigid; }
using Barrier = std::variant<LumpedBarrier, ProfileBarrier>;
bool is_rigid(const Barrier&);

struct Thread {            // spring and damper, never detaches (van Walstijn et al. 2016, eq 7)
    double position = 0;   // [m]
    double width = 0;      // [m]
    double stiffness = 0;  // [N/m]
    double damping = 0;    // [kg/s]
    double height = 0;     // [m]
    bool operator==(const Thread&) const = default;
};

// Moving barrier: a mass on the barriers' side of the string, which meets the string at its top.
// Its contact pushes the string by k [eta]^exponent, and the mass by the opposite force. A spring
// and a damper may join it to the ground; the spring is relaxed at t = 0.
struct Mass {
    double mass = 0;      // [kg]
    double position = 0;  // [m]
    double width = 0;     // footprint [m]
    double velocity = 0;  // at t = 0, positive upwards like y, towards the string [m/s]
    double gap = 0;       // at t = 0, from its top up to y = 0, the line of the straight string [m]
    double stiffness = 0;  // [N/m^exponent]
    double exponent = 1;
    double contact_loss = 0;  // [s/m]
    LossLaw loss_law = LossLaw::hunt_crossley;
    double spring = 0, damping = 0;  // to the ground [N/m], [kg/s]
    double weight = 0;               // steady force towards the string [N]
    bool joined() const { return spring > 0 || damping > 0; }
    // place at which spring and weight are in balance [m]; without a spring, at t = 0
    double rest() const { return spring > 0 ? weight / spring - gap : -gap; }
    bool operator==(const Mass&) const = default;
};

// ---- Excitation.

struct ModeShape {
    int number = 1;
    double amplitude = 0;
    bool operator==(const ModeShape&) const = default;
};
struct TriangleShape {
    double position = 0;  // [m]
    double amplitude = 0;
    double smoothing = 0;  // full width of a Hann smoothing [m]
    bool operator==(const TriangleShape&) const = default;
};
using Shape = std::variant<ModeShape, TriangleShape>;  // amplitude [m]; for a velocity [m/s]
// rows along the string, with straight lines between them and to its ends, or rows of modes
struct TableStart {
    std::string file;                  // path written in the scene
    std::string state_of = {};         // the scene to which the state belongs; "": unknown
    bool of_modes = false;             // true if `at` contains mode numbers
    std::vector<double> at;            // x [m] or mode number, ascending
    std::vector<double> displacement;  // [m]
    std::vector<double> velocity;      // [m/s]
    bool operator==(const TableStart&) const = default;
};
// the static equilibrium under barriers, thread and the pluck's force at t = 0
struct RestStart {
    bool operator==(const RestStart&) const = default;
};
using Start = std::variant<ModeShape, TriangleShape, TableStart, RestStart>;

// A pull lets go at its end, a blow sounds from its start.
enum class PluckKind { pull, blow };
// Force: from a file, with straight lines between its rows, or by van Walstijn et al. 2016, eqs
// 14-15.
struct Pluck {
    double amplitude = 0;   // a_e; for a file the largest force [N]
    double duration = 0;    // tau_e [s]
    double skew = 0;        // beta_e
    double start = 0;       // t_e [s]
    double position = 0;    // [m]
    double width = 0;       // [m]
    std::string file = {};  // path written in the scene; "": none
    // from the file: instants [s], ascending, and the force relative to the largest one
    std::vector<double> time = {}, share = {};
    double peak = 0;  // the largest force in the file [N]
    PluckKind kind = PluckKind::pull;
    bool operator==(const Pluck&) const = default;
};
struct Polarisation {
    double rotation = 0;     // [rad] per reflection at the bridge (Deshmukh & Rayavarapu, eq 14)
    double pluck_angle = 0;  // [rad] from the vertical
    bool operator==(const Polarisation&) const = default;
};

struct String {
    double length = 0;             // L [m]
    double linear_density = 0;     // mu [kg/m]
    double tension = 0;            // T [N]; 0: a bar, which its bending stiffness alone holds
    double bending_stiffness = 0;  // EI [N m^2]
    // EA [N]: the tension grows when the string stretches (Kirchhoff, Carrier); 0: the tension is
    // constant
    double axial_stiffness = 0;
    Damping damping;
    std::vector<Barrier> barriers;
    std::optional<Thread> thread;
    std::vector<Mass> masses;
    std::optional<Start> start;     // displacement at t = 0
    std::optional<Shape> velocity;  // at t = 0, in addition to a table's velocity
    std::optional<Pluck> pluck;
    std::optional<Polarisation> polarisation;
    bool has_contacts() const { return !barriers.empty() || !masses.empty(); }
    bool operator==(const String&) const = default;
};

// ---- Taps.

enum class Quantity {
    displacement,
    velocity,
    nut_force,
    bridge_force,
    thread_force,
    driving_force
};
const char* name_of(Quantity);
const char* unit_of(Quantity);  // "N"

struct Tap {
    std::string name;
    Quantity quantity = Quantity::displacement;
    std::optional<int> string;  // absent: the sum over strings (forces only)
    double position = 0;        // [m], displacement and velocity only
    // Selects a mass on the string: the tap hears its displacement, its velocity or its force on
    // the string (bridge_force)
    std::optional<int> mass = {};
    // Limit for the modes that the tap sums [Hz]. No file has it: modal schemes read so for the
    // error of what is heard (bench/study/errors.hpp).
    double below = std::numeric_limits<double>::infinity();
    bool operator==(const Tap&) const = default;
};
// an oscillator driven by the bridge; all strings pull at the sum of the displacements
struct BodyMode {
    double mass = 0;       // [kg], at the bridge
    double stiffness = 0;  // [N/m]
    double damping = 0;    // [kg/s]
    bool operator==(const BodyMode&) const = default;
};
struct Body {
    // filters for the driving_force and nut_force taps: files with impulse responses; "": none
    std::string bridge, nut;
    std::vector<BodyMode> modes;  // none: the bridge does not move
    bool operator==(const Body&) const = default;
};

struct Scene {
    std::string name, source;
    double duration = 0;  // [s]
    std::vector<String> strings;
    std::vector<Tap> taps;
    std::optional<Body> body;
    bool operator==(const Scene&) const = default;
};

// Name of the part that the tap needs and the string lacks ("a barrier"); nullptr if the string has
// it.
const char* lacks(const String&, Quantity, std::optional<int> mass = {});

// Scene with one of the strings: that string, and the taps that hear it, in their order.
Scene alone(const Scene&, int string);
bool hears(const Tap&, const Scene&, int string);

Scene unfiltered(Scene);  // removes the body's filters; moving parts stay

// ---- Features that a scene needs from a scheme. Neither several strings nor a body that only
// filters counts.

enum class Feature : unsigned {
    bending_stiffness = 1u << 0,
    damping = 1u << 1,                      // any loss on the free string
    frequency_dependent_damping = 1u << 2,  // a loss that differs from mode to mode
    measured_modes = 1u << 3,               // a table in place of the string's own frequencies
    lumped_barrier = 1u << 4,
    profile_barrier = 1u << 5,
    several_barriers = 1u << 6,   // on one string
    power_law_contact = 1u << 7,  // exponent other than 1
    contact_loss = 1u << 8,
    thread = 1u << 9,
    initial_shape = 1u << 10,
    pluck = 1u << 11,
    polarisation = 1u << 12,
    moving_body = 1u << 13,  // the strings' end at x = 0 moves with the body
    rigid_barrier = 1u << 14,
    rigid_profile = 1u << 15,  // in place of profile_barrier
    tension_modulation = 1u << 16,
    initial_velocity = 1u << 17,
    equilibrium = 1u << 18,   // a start at rest under pressing barriers
    clipped_loss = 1u << 19,  // a contact loss that does not pull
    free_mass = 1u << 20,     // a mass that meets the string
    joined_mass = 1u << 21,   // one on a spring or a damper
    weighed_mass = 1u << 22,  // one with a weight
    barrier_above = 1u << 23,
};
constexpr int feature_count = 24;
const char* name_of(Feature);

struct Features {
    unsigned bits = 0;
    constexpr Features() = default;
    // NOLINT: a feature is a set of one
    constexpr Features(Feature f) : bits(static_cast<unsigned>(f)) {}
    constexpr explicit Features(unsigned b) : bits(b) {}
    constexpr bool has(Feature f) const { return (bits & static_cast<unsigned>(f)) != 0; }
    constexpr bool any(Features f) const { return (bits & f.bits) != 0; }
    constexpr bool empty() const { return bits == 0; }
    friend constexpr bool operator==(Features, Features) = default;
};
constexpr Features operator|(Features a, Features b) { return Features(a.bits | b.bits); }
constexpr Features operator|(Feature a, Feature b) { return Features(a) | Features(b); }
constexpr Features operator-(Features a, Features b) {
    return Features(a.bits & ~b.bits);
}  // in a and not in b
std::string names_of(Features);  // "thread, pluck"
constexpr Features any_rigid = Feature::rigid_barrier | Feature::rigid_profile,
                   any_profile = Feature::profile_barrier | Feature::rigid_profile,
                   any_mass = Feature::free_mass | Feature::joined_mass | Feature::weighed_mass;

Features needed_by(const Scene&);

// Reports an impossible value: `key` is its path in a scene file ("string.0.barrier.1.width").
struct BadScene : std::runtime_error {
    BadScene(std::string key, std::string found, std::string expected);
    std::string key, found, expected;
};
void validate(const Scene&);  // throws BadScene

}  // namespace jvari
