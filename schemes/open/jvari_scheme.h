/* A scheme for jvari from any language that can be called from C. This header is C99 and needs
 * nothing else: copy it.
 *
 * A shared object exports one function, jvari_schemes(), that returns a table of schemes. The
 * program asks each for four functions: make, reset, advance, release. It passes the problem as
 * plain arrays; docs/own-scheme has the shape, unit and equation of each.
 *
 * Every structure begins with its size, as known where it was filled, and grows at its end alone:
 * a reader looks at no member beyond that size. A plugin of another version is refused. */
#ifndef JVARI_SCHEME_H
#define JVARI_SCHEME_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* raised where a member changes its meaning; a new member at an end does not raise it */
#define JVARI_SCHEME_VERSION 1

/* One string as a modal scheme needs it, in SI units. Matrices lie row by row.
 * M = modes, P = contacts, D = threads (0 or 1), N = P + D. */
struct jvari_problem {
    size_t size;
    const char *name, *scene; /* of the scene; all of it as a scene file (TOML) */
    double sample_rate;       /* steps per second [Hz] */
    double tap_rate;          /* rows per second [Hz] */
    double duration;          /* [s] */
    int64_t rows;             /* of the trace: row n is at n/tap_rate, row 0 is the start */
    int64_t steps_per_row;    /* sample_rate/tap_rate */
    int64_t modes, contacts, threads, plucks, taps;
    /* by the caller; 0: `modes` is every mode below min(20 kHz, sample_rate/2) */
    int64_t modes_asked;

    /* L [m], mu [kg/m], T [N], EI [N m^2] */
    double length, linear_density, tension, bending_stiffness;
    double modal_mass;                                         /* mu L/2 [kg] */
    /* M: wavenumber [1/m], undamped frequency [rad/s], decay rate [1/s] */
    const double *beta, *omega0, *sigma;
    /* M: modal displacements at t = 0 [m], at rest */
    const double* start;

    /* P: centre and footprint [m] */
    const double *contact_position, *contact_width;
    /* P x M: displacement at the contact = weights . modal displacements */
    const double* contact_weights;
    /* P: k [N/m^exponent]; force on the string k [height - y]_+^exponent */
    const double* contact_stiffness;
    /* P: 1, [m], Hunt-Crossley [s/m] */
    const double *contact_exponent, *contact_height, *contact_loss;

    double thread_position, thread_width;                   /* [m] */
    const double* thread_weights;                           /* D x M */
    double thread_stiffness, thread_damping, thread_height; /* [N/m], [kg/s], [m] */

    double pluck_position, pluck_width; /* [m] */
    const double* pluck_weights;        /* plucks x M */
    /* pluck_samples: the force about t = n/sample_rate [N], its mean over the step before and the
       step after with the weight 1 there and 0 at their far ends, at n = 0 over the step after; 0
       beyond. So (F[n] + F[n+1])/2 in a two-point step, F[n] in a three-point one, half of F[0] in
       its first half step, bring the whole impulse */
    const double* pluck_force;
    int64_t pluck_samples;

    const char *const *tap_names, *const *tap_quantities; /* taps: "nut", "nut_force" */
    const double* tap_position;                           /* taps: [m]; 0 of forces */
    /* taps x M: of displacement, velocity and nut force; 0 of contact forces */
    const double* tap_weights;

    /* N x N: what the true string yields at a point of 1 N of steady force at another [m/N] */
    const double* compliance;
    const double* tap_compliance; /* taps x N: what a tap of displacement or nut force reads then */
    const double* radiation;      /* N: what the modes beyond M resist at a point [kg/s] */

    /* modes of a table, 0 where there is none; omega0 and sigma are taken from it */
    int64_t measured;
    /* measured: damped frequency [Hz], decay rate [1/s] */
    const double *measured_hz, *measured_decay;

    int64_t options; /* asked for, of those that the scheme declares */
    const char *const *option_names, *const *option_values;
};

/* Rows that the scheme is to write, column by column: tap k of row n is tap[k*stride + n]. Of each
 * row it writes the state of its instant, then makes the steps to the next row's. Contact forces
 * are means over the interval that ends at the row. */
struct jvari_rows {
    size_t size;
    int64_t rows, taps, stride;
    double* tap;
    /* three columns likewise: stored, supplied, dissipated [J], the last two of that interval;
     * NULL: not asked for, 0 where left alone */
    double* energy;
    /* NULL, or asked every few milliseconds: not 0 means that nobody needs the rest, so return */
    int (*stop)(void* caller);
    void* caller;
    int64_t failed_step; /* written by a scheme that fails: the step, counted from the start */
};
enum jvari_outcome { JVARI_OK = 0, JVARI_DIVERGED = 1, JVARI_NOT_CONVERGED = 2 };

struct jvari_fact { /* a number that a scheme reports of its run */
    const char *name, *unit;
    double value;
};

struct jvari_made { /* what `make` reports beside the scheme that it returns */
    size_t size;
    char why[1024];              /* where it returns NULL: what is missing, as a sentence */
    /* where it returns NULL: not 0 if that is no refusal of the scene but a failure of the
     * scheme */
    int64_t failed;
    int64_t dofs;                /* doubles of state */
    int64_t free_modes;          /* of its own relation, in closed form; 0: none */
    /* of those: damped frequency [rad/s], decay rate [1/s]; they live as long as the scheme */
    const double *omega, *decay;
};

struct jvari_option {
    const char *name, *fallback, *meaning;
    /* "own matched": the words that it takes; NULL: a number or another text */
    const char* choices;
};

struct jvari_scheme {
    size_t size;
    const char *name, *source; /* "mine", "A. Author 2026, eqs 3-9" */
    /* features as `jvari list schemes --json` names them: "damping, thread, pluck" */
    const char* represents;
    /* what the energy columns promise: "exact", "to tolerance", "none" */
    const char* balance;
    /* NULL: refused */
    void* (*make)(const struct jvari_scheme*, const struct jvari_problem*, struct jvari_made*);
    /* back to t = 0 */
    void (*reset)(void*);
    /* allocates nothing; jvari_outcome */
    int (*advance)(void*, struct jvari_rows*);
    void (*release)(void*);
    /* All below may be 0. */
    const char* note;                   /* what the features cannot express */
    /* "profile barrier: contact_points": a feature, and the fact that says how */
    const char* approximates;
    const struct jvari_option* options; /* of this scheme alone */
    int64_t option_count;
    /* Writes as many as there is room for and returns how many there are; -1: it cannot, and the
     * name of the first says why. */
    int64_t (*facts)(void*, struct jvari_fact*, int64_t room);
    const void* own; /* the plugin's */
};

struct jvari_plugin {
    size_t size;
    int64_t version; /* JVARI_SCHEME_VERSION */
    const struct jvari_scheme* const* schemes;
    int64_t count;
    /* for the manifest of what the scheme was timed in; may be NULL */
    const char *compiler, *flags;
    int64_t optimised;            /* 0: the program warns that its times say nothing */
};

#if defined(__GNUC__)
#define JVARI_EXPORT __attribute__((visibility("default")))
#elif defined(_WIN32)
#define JVARI_EXPORT __declspec(dllexport)
#else
#define JVARI_EXPORT
#endif
JVARI_EXPORT const struct jvari_plugin* jvari_schemes(void);

#ifdef __cplusplus
}
#endif
#endif
