// The seam: everything a scheme has to offer, and all that the rest of the program knows of one.
//
// A scheme is made once for a scene and a setting (the only place that allocates or throws), then steps block by block into a
// window of the caller's trace. Out-of-tree schemes come as shared objects with one exported symbol, `jvari_plugin`.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

struct Modes;

// A window of the caller's trace: column-major, one row per tap interval.
struct Block {
    int rows = 0, taps = 0;
    long stride = 0;           // rows of the whole trace
    double* tap = nullptr;     // one column per tap of the scene
    double* energy = nullptr;  // three columns: stored, supplied, dissipated [J]; nullptr = not probed

    // Whether the caller wants no more of this run: advance() then returns at once, and nobody looks at what it returns or wrote. A scheme
    // asks within a row, every few milliseconds of work, so that a long row can be ended; between blocks the caller sees to it itself.
    bool (*stop)(void* caller) = nullptr;  // nullptr: never
    void* caller = nullptr;
    bool stopped() const noexcept { return stop && stop(caller); }
    bool stopped(long step, long every) const noexcept { return step % every == every - 1 && stopped(); }
};
constexpr long steps_between_questions = 1024;  // of a step that takes microseconds at most

enum class Outcome { ok, diverged, not_converged };
const char* name_of(Outcome);

struct Status {
    Outcome outcome = Outcome::ok;
    long step = 0;  // where it failed
};

// One number a scheme reports about its run: what it approximated, how hard it worked, what contact did.
struct Fact {
    std::string name;  // "smallest_contact_force"
    double value;
    std::string unit;  // "N"
};

// A mode of the free string as a scheme's own recursion has it: z = exp((i omega - sigma) dt) is a root of it.
struct FreeMode {
    double omega = 0;  // damped angular frequency [rad/s]; 0 where overdamped
    double sigma = 0;  // decay rate [1/s]
};

class Scheme {
public:
    virtual ~Scheme() = default;
    virtual void reset() noexcept = 0;  // back to t = 0

    // For each row: write the state of this instant, then make the steps to the next row's (sample_rate/tap_rate of them).
    // So the first row after reset() is the initial state. Contact forces are means over the interval that ends at the row, 0 in row 0;
    // supplied and dissipated energy are sums over the same interval. Allocates nothing.
    virtual Status advance(const Block& out) noexcept = 0;

    virtual int dofs() const = 0;                           // doubles of state carried: no more than the scene needs
    virtual std::vector<Fact> facts() const { return {}; }  // of the run so far; between blocks only

    // Modes 1, 2, ... of the first string, without its barriers and its thread; none where the scheme has no relation in closed form.
    virtual std::vector<FreeMode> free_modes() const { return {}; }
};

struct Settings {
    double sample_rate = 0;                                    // [Hz]; a reference in continuous time ignores it
    double tap_rate = 44100;                                   // [Hz]
    int modes = 0;                                             // modes, or interior nodes for a scheme on a grid; 0: the scheme's default
    std::vector<std::pair<std::string, std::string>> options;  // of this scheme alone; an unknown one is refused
};

// The scheme cannot represent this scene, or not with these settings; the text names what is missing.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// An option that the scheme does not have: a caller with several schemes may give it to the others.
struct UnknownOption : Refusal {
    using Refusal::Refusal;
};

enum class Balance { exact, to_tolerance, none };  // what the energy columns promise
enum class Clock { stepped, continuous };          // continuous: a reference that has no sample rate

struct Descriptor {
    const char* name;
    const char* source;  // "van Walstijn et al. 2016, eqs 38-49"
    Features represents;
    Balance balance;
    Clock clock;
    std::unique_ptr<Scheme> (*make)(const Scene&, const Settings&);  // throws Refusal or BadScene
};

constexpr unsigned plugin_abi = 3;
struct Plugin {
    unsigned abi;  // plugin_abi
    const Descriptor* schemes;
    int count;
};
// A plugin exports:  extern "C" const jvari::Plugin jvari_plugin = {jvari::plugin_abi, schemes, 1};

// ---- Checks that every `make` begins with.

void refuse_missing(const Descriptor&, const Scene&);  // Refusal naming what `represents` lacks
int steps_per_row(const Settings&);                    // sample_rate/tap_rate; Refusal unless a whole number from 1 to 2^31 - 1
int modes_for(const String&, const Settings&);         // settings.modes, or every mode below min(20 kHz, sample_rate/2)
Modes modes_of(const String&, const Settings&);        // those; Refusal where there is none, or more than most_modes

// The value of an option, or `fallback`; option_names lists what the scheme knows. Refusal for an unknown name.
void refuse_unknown_options(const Settings&, std::initializer_list<const char*> option_names);
std::string option(const Settings&, const char* name, const char* fallback);
double number_option(const Settings&, const char* name, double fallback);

}  // namespace jvari
