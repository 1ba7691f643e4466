// Interface between the schemes and the rest of the program.
//
// A scheme is made once for a scene and a setting; only then may it allocate or throw. Afterwards
// it steps block by block into a window of the caller's trace. Checks and values for `make`:
// making.hpp. Out-of-tree schemes come in shared objects: plugin.hpp.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/facts.hpp"

namespace jvari {

class Impacts;

// Window of the caller's trace: column-major, one row per tap interval.
struct Block {
    int rows = 0, taps = 0;
    long stride = 0;        // rows in the whole trace
    double* tap = nullptr;  // one column per tap
    // three columns: stored, supplied, dissipated [J]; nullptr = not probed, in this block
    double* energy = nullptr;
    // one for each string, to be filled with its contacts (impacts.hpp); nullptr: not requested
    Impacts* impacts = nullptr;

    // Tells whether the caller has abandoned this run. advance() then returns at once, and both its
    // result and the rows are ignored. A scheme asks within a row, every few milliseconds of work,
    // so that a long row can be ended. Between blocks the caller checks for itself.
    bool (*stop)(void* caller) = nullptr;  // nullptr: never
    void* caller = nullptr;
    bool stopped() const noexcept { return stop && stop(caller); }
    bool stopped(long step, long every) const noexcept {
        return step % every == every - 1 && stopped();
    }
};
inline void write_energy(const Block& out, int row, double stored, double supplied,
                         double dissipated) noexcept {
    out.energy[row] = stored;
    out.energy[out.stride + row] = supplied;
    out.energy[2 * out.stride + row] = dissipated;
}
constexpr long steps_between_questions = 1024;  // for steps that take microseconds at most

enum class Outcome { ok, diverged, not_converged };
const char* name_of(Outcome);

struct Status {
    Outcome outcome = Outcome::ok;
    long step = 0;  // the failing step
};

// Number that a scheme reports about its run: an approximation, the work done, or a property of its
// contacts.
struct Fact {
    Fact(const FactName& known, double v) : name(known.name), value(v), unit(known.unit) {}
    // a plugin's own
    Fact(std::string n, double v, std::string u)
        : name(std::move(n)), value(v), unit(std::move(u)) {}
    std::string name;
    double value;
    std::string unit;  // "N"
};

// Value of a fact, or NaN if the scheme does not report it. If several strings report the fact, the
// value is the least for smallest contact forces and the largest for any other fact.
double fact_of(const std::vector<Fact>&, const std::string& name);
inline double fact_of(const std::vector<Fact>& all, const FactName& known) {
    return fact_of(all, known.name);
}

// Mode in the scheme's own recursion for the free string, which has the root z = exp((i omega -
// sigma) dt).
struct FreeMode {
    double omega = 0;  // damped angular frequency [rad/s]; 0 if overdamped
    double sigma = 0;  // decay rate [1/s]
};

// Modal displacements and velocities on one string at one instant.
struct ModalState {
    std::vector<double> displacement, velocity;  // [m], [m/s]
};

class Scheme {
public:
    virtual ~Scheme() = default;
    virtual void reset() noexcept = 0;  // back to t = 0
    // Starts like reset(), but from the state of another scheme between two blocks: a sounding
    // string is tuned, damped or plucked again without a cut. The other object is the same scheme,
    // with equally many modes, barriers and threads. Returns false and changes nothing if the
    // scheme cannot do this. After success there is no start of the scene left for reset() to
    // restore. Allocates nothing.
    virtual bool start_from(const Scheme&) noexcept { return false; }

    // For each row: writes the state of this instant, then makes the steps to the next row
    // (sample_rate/tap_rate of them). So the first row after reset() is the initial state. Contact
    // forces are means over the interval that ends at the row, 0 in row 0; supplied and dissipated
    // energy are sums over the same interval. Allocates nothing.
    virtual Status advance(const Block& out) noexcept = 0;

    // size of the state in doubles, no more than the scene needs
    virtual int dofs() const = 0;
    // Facts of the run so far; call this between blocks only.
    virtual std::vector<Fact> facts() const { return {}; }

    // Modes 1, 2, ... on the string (on the first, if there are several), without its barriers and
    // its thread. Empty if the scheme has no relation in closed form.
    virtual std::vector<FreeMode> free_modes() const { return {}; }

    // State at the instant of the next row, from which another run would continue like this one. A
    // scheme that keeps further state, for example of its contacts, returns an empty one. Call this
    // between blocks only.
    virtual ModalState state() const { return {}; }
};

struct Settings {
    // [Hz]; a reference in continuous time ignores it
    double sample_rate = 0;
    double tap_rate = 44100;  // [Hz]
    // modes, or interior nodes for a scheme on a grid; 0: the scheme's default
    int modes = 0;
    // options of this scheme; an unknown one is refused
    std::vector<std::pair<std::string, std::string>> options;
};

// Thrown if the scheme cannot represent this scene, or not with these settings; the text names the
// missing part.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Option of a scheme beside its settings. If there are choices the value is a word; otherwise the
// meaning describes it.
struct Option {
    const char* name;
    // written like a value of the option; "": depends on scene and settings, see `meaning`
    const char* fallback;
    const char* meaning;          // with the unit
    const char* choices[6] = {};  // the words that the option takes; none: a number or another text
    std::span<const char* const> words() const;
};

// Feature that a scheme takes but changes, at any rate and with any number of modes. If a scene
// needs the feature, the scheme reports the fact, which says how. Among several facts for one
// feature the scheme reports at least one.
struct Approximation {
    Feature feature;
    FactName fact;
};

// Known limit of soundness: positive on the sound side, 0 at the limit, NaN if the limit does not
// apply to the scene.
struct Limit {
    const char* name = nullptr;  // name in maps, "grid_limit"
    // for a scene with one string; margin_of covers all strings
    double (*margin)(const Scene&, const Settings&) = nullptr;
};

// Confirms a reference in its certificate: options for further runs.
using OptionValues = std::vector<std::pair<std::string, std::string>>;
struct Confirmation {
    // other accuracies of this reference; {} is the default run
    std::vector<OptionValues> accuracies = {{}};
    // another method, for a scene that no other reference represents
    std::vector<OptionValues> other_methods = {};
};

enum class Balance { exact, to_tolerance, none };  // promise about the energy columns
// continuous: a reference without a sample rate
enum class Clock { stepped, continuous };

struct Descriptor {
    const char* name;
    const char* source;   // "van Walstijn et al. 2016, eqs 38-49"
    Features represents;  // all features that it takes, including the approximated ones
    Balance balance;
    Clock clock = Clock::stepped;
    // Called only by make_scheme, for one string or for all on a moving body; throws Refusal or
    // BadScene.
    std::unique_ptr<Scheme> (*make)(const Descriptor&, const Scene&, const Settings&);
    std::span<const Option> options = {};
    std::span<const Approximation> approximates = {};
    // one sentence for the capability table about properties that the features cannot express
    const char* note = "";
    Limit limit = {};
    // The highest-ranked able scheme stands in if there is no reference.
    int stand_in_rank = 1;
    Confirmation (*confirmation)(const Scene&) = nullptr;  // for a reference
    // `make` gets all strings even if nothing couples them
    bool all_strings = false;
    // for a scheme from outside: a pointer by which its `make` recognises it
    const void* own = nullptr;
    // reason why the cost is not a measurement: "interpreted, not compared"
    const char* untimed = "";
};

// Makes a scheme; there is no other way. Refuses features that the scheme does not represent,
// options that it does not declare or finds twice, and words that an option does not take. Then
// calls `make`, once for each string, or once for all on a moving body. Throws Refusal, BadScene,
// or BadScheme.
std::unique_ptr<Scheme> make_scheme(const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari
