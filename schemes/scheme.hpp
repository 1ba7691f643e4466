// The seam: everything a scheme has to offer, and all that the rest of the program knows of one.
//
// A scheme is made once for a scene and a setting (the only place that allocates or throws), then
// steps block by block into a window of the caller's trace. Checks and values for `make`:
// making.hpp. Out-of-tree schemes come as shared objects: plugin.hpp.
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

// A window of the caller's trace: column-major, one row per tap interval.
struct Block {
    int rows = 0, taps = 0;
    long stride = 0;        // rows of the whole trace
    double* tap = nullptr;  // one column per tap of the scene
    // three columns: stored, supplied, dissipated [J]; nullptr = not probed, in this block
    double* energy = nullptr;
    // one for each string, to be told what its contacts do (impacts.hpp); nullptr: nobody asks
    Impacts* impacts = nullptr;

    // Whether the caller wants no more of this run: advance() then returns at once, and nobody
    // looks at what it returns or wrote. A scheme asks within a row, every few milliseconds of
    // work, so that a long row can be ended; between blocks the caller sees to it itself.
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
constexpr long steps_between_questions = 1024;  // of a step that takes microseconds at most

enum class Outcome { ok, diverged, not_converged };
const char* name_of(Outcome);

struct Status {
    Outcome outcome = Outcome::ok;
    long step = 0;  // where it failed
};

// One number a scheme reports about its run: what it approximated, how hard it worked, what contact
// did.
struct Fact {
    Fact(const FactName& known, double v) : name(known.name), value(v), unit(known.unit) {}
    // a plugin's own
    Fact(std::string n, double v, std::string u)
        : name(std::move(n)), value(v), unit(std::move(u)) {}
    std::string name;
    double value;
    std::string unit;  // "N"
};

// The value of a fact, NaN where the scheme does not report it. Where each of several strings has
// its own: the least of smallest contact forces, of any other the largest.
double fact_of(const std::vector<Fact>&, const std::string& name);
inline double fact_of(const std::vector<Fact>& all, const FactName& known) {
    return fact_of(all, known.name);
}

// A mode of the free string as a scheme's own recursion has it: z = exp((i omega - sigma) dt) is a
// root of it.
struct FreeMode {
    double omega = 0;  // damped angular frequency [rad/s]; 0 where overdamped
    double sigma = 0;  // decay rate [1/s]
};

// Of the modes of one string at one instant.
struct ModalState {
    std::vector<double> displacement, velocity;  // [m], [m/s]
};

class Scheme {
public:
    virtual ~Scheme() = default;
    virtual void reset() noexcept = 0;  // back to t = 0
    // As reset(), but from where another stands between two blocks: a string that sounds is tuned,
    // damped or plucked again without a cut. That one is of the same scheme, with as many modes,
    // barriers and threads. False, and as it was, where the scheme cannot; else there is no start
    // of the scene any more that reset() could go back to. Allocates nothing.
    virtual bool start_from(const Scheme&) noexcept { return false; }

    // For each row: write the state of this instant, then make the steps to the next row's
    // (sample_rate/tap_rate of them). So the first row after reset() is the initial state. Contact
    // forces are means over the interval that ends at the row, 0 in row 0; supplied and dissipated
    // energy are sums over the same interval. Allocates nothing.
    virtual Status advance(const Block& out) noexcept = 0;

    // doubles of state carried: no more than the scene needs
    virtual int dofs() const = 0;
    // of the run so far; between blocks only
    virtual std::vector<Fact> facts() const { return {}; }

    // Modes 1, 2, ... of the string, of several the first, without its barriers and its thread;
    // none where the scheme has no relation in closed form.
    virtual std::vector<FreeMode> free_modes() const { return {}; }

    // At the instant of the next row, where another run that starts from it goes on as this one
    // does: a scheme that keeps more than this, as of its contacts, has none. Between blocks only.
    virtual ModalState state() const { return {}; }
};

struct Settings {
    // [Hz]; a reference in continuous time ignores it
    double sample_rate = 0;
    double tap_rate = 44100;  // [Hz]
    // modes, or interior nodes for a scheme on a grid; 0: the scheme's default
    int modes = 0;
    // of this scheme alone; an unknown one is refused
    std::vector<std::pair<std::string, std::string>> options;
};

// The scheme cannot represent this scene, or not with these settings; the text names what is
// missing.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What a scheme can be told beside its settings. Its value is a word where there are choices, else
// what the meaning says.
struct Option {
    const char* name;
    // as it would be written; "": depends on scene and settings as `meaning` tells
    const char* fallback;
    const char* meaning;          // with the unit
    const char* choices[6] = {};  // the words that it takes; none: a number or another text
    std::span<const char* const> words() const;
};

// A feature that a scheme takes and changes, at any rate and with any number of modes. Where a
// scene needs the feature the scheme reports the fact, which says how; of several facts for one
// feature at least one.
struct Approximation {
    Feature feature;
    FactName fact;
};

// A boundary of soundness that is known: positive on the sound side, 0 on it, NaN where it has
// nothing to say of the scene.
struct Limit {
    const char* name = nullptr;  // as maps call it, "grid_limit"
    // of a scene of one string; margin_of asks for all
    double (*margin)(const Scene&, const Settings&) = nullptr;
};

// How a reference confirms itself in a certificate: options to run it with.
using OptionValues = std::vector<std::pair<std::string, std::string>>;
struct Confirmation {
    // of its own accuracy; {} is what it does unasked
    std::vector<OptionValues> accuracies = {{}};
    // another method, for a scene that no other reference represents
    std::vector<OptionValues> other_methods = {};
};

enum class Balance { exact, to_tolerance, none };  // what the energy columns promise
// continuous: a reference that has no sample rate
enum class Clock { stepped, continuous };

struct Descriptor {
    const char* name;
    const char* source;   // "van Walstijn et al. 2016, eqs 38-49"
    Features represents;  // what it takes, those that it approximates among them
    Balance balance;
    Clock clock;
    // Called by make_scheme alone, for one string or for all on a moving body; throws Refusal or
    // BadScene.
    std::unique_ptr<Scheme> (*make)(const Descriptor&, const Scene&, const Settings&);
    std::span<const Option> options = {};
    std::span<const Approximation> approximates = {};
    // what the features cannot express, one sentence for the capability table
    const char* note = "";
    Limit limit = {};
    // of those able the highest stands in where there is no reference
    int stand_in_rank = 1;
    Confirmation (*confirmation)(const Scene&) = nullptr;  // of a reference
    // `make` gets all strings of a scene also where nothing couples them
    bool all_strings = false;
    // of a scheme from outside: what its `make` knows it by
    const void* own = nullptr;
    // why its cost is no measure: "interpreted, not compared"
    const char* untimed = "";
};

// The only way to make a scheme: refuses features that the scheme does not represent, options that
// it does not declare or finds twice and words that an option does not take, then calls `make`,
// once for each string of the scene, or for all on a moving body. Throws Refusal, BadScene, or
// BadScheme.
std::unique_ptr<Scheme> make_scheme(const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari
