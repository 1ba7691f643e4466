/* A plugin as it was written against version 1 of jvari_scheme.h, which lies here as it was. It is frozen: later programs run it or refuse it with a
 * sentence, whatever the header of the tree says. Each mode of a free string rings by itself, exactly. */
#include <math.h>
#include <stdlib.h>

#include "jvari_scheme.h"

struct mine {
    const struct jvari_problem *p;
    int64_t row;
};
static void *make(const struct jvari_scheme *scheme, const struct jvari_problem *p, struct jvari_made *made) {
    (void)scheme;
    struct mine *s = calloc(1, sizeof *s);
    s->p = p, made->dofs = 1;
    return s;
}
static void reset(void *self) { ((struct mine *)self)->row = 0; }
static int advance(void *self, struct jvari_rows *out) {
    struct mine *s = self;
    const struct jvari_problem *p = s->p;
    for (int64_t n = 0; n < out->rows; ++n, ++s->row)
        for (int64_t k = 0; k < out->taps; ++k) {
            const double t = (double)s->row / p->tap_rate;
            double sum = 0;
            for (int64_t i = 0; i < p->modes; ++i) {
                const double omega = sqrt(p->omega0[i] * p->omega0[i] - p->sigma[i] * p->sigma[i]);
                const double y = exp(-p->sigma[i] * t) * (cos(omega * t) + p->sigma[i] / omega * sin(omega * t));
                sum += p->tap_weights[k * p->modes + i] * p->start[i] * y;
            }
            out->tap[k * out->stride + n] = sum;
        }
    return JVARI_OK;
}

static const struct jvari_scheme scheme = {.size = sizeof scheme, .name = "decays", .source = "closed form", .balance = "none", .make = make,
                                           .represents = "bending stiffness, damping, frequency-dependent damping, initial shape",
                                           .reset = reset, .advance = advance, .release = free};
static const struct jvari_scheme *const schemes[] = {&scheme};
static const struct jvari_plugin plugin = {.size = sizeof plugin, .version = JVARI_SCHEME_VERSION, .schemes = schemes, .count = 1, .optimised = 1};
const struct jvari_plugin *jvari_schemes(void) { return &plugin; }
