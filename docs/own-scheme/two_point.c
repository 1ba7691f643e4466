/* The modal two-point scheme of van Walstijn, Bridges & Mehes 2016 (eqs 33, 38-48), from plain arrays:
 *     cc -O3 -shared -fPIC -I FOLDER_OF_jvari_scheme.h two_point.c -o libtwo_point.so -lm && jvari check --plugin ./libtwo_point.so
 * One contact of exponent 1 and a thread at most. Leaves out: the energy columns. */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "jvari_scheme.h"

struct mine {
    const struct jvari_problem *p; /* lives as long as the scheme */
    double *a, *b, *J, *y, *q, *u; /* modes each */
    double dt, xi, theta, theta_bc, phi_c, inverse_c, beta_c, sum_b, sum_c;
    int64_t n;
};

static double dot(int64_t modes, const double *g, const double *y) {
    double sum = 0;
    for (int64_t i = 0; g && i < modes; ++i) sum += g[i] * y[i];
    return sum;
}
static double shared(const struct mine *s, const double *g, const double *h) { /* what a unit force through h adds to the increment at g */
    double sum = 0;
    for (int64_t i = 0; g && h && i < s->p->modes; ++i) sum += g[i] * h[i] * s->xi / s->J[i];
    return sum;
}
static void reset(void *self) {
    struct mine *s = self;
    for (int64_t i = 0; i < s->p->modes; ++i) s->y[i] = s->p->start[i], s->q[i] = 0;
    s->n = 0, s->sum_b = s->sum_c = 0;
}
static void release(void *self) {
    free(((struct mine *)self)->a);
    free(self);
}
static void *make(const struct jvari_scheme *scheme, const struct jvari_problem *p, struct jvari_made *made) {
    (void)scheme;
    struct mine *s = calloc(1, sizeof *s);
    double *room = calloc((size_t)(6 * p->modes), sizeof *room);
    s->p = p, s->dt = 1 / p->sample_rate, s->xi = s->dt * s->dt / (2 * p->modal_mass);
    s->a = room, s->b = room + p->modes, s->J = room + 2 * p->modes, s->y = room + 3 * p->modes, s->q = room + 4 * p->modes, s->u = room + 5 * p->modes;
    for (int64_t i = 0; i < p->modes; ++i) {
        const double complex omega = csqrt(p->omega0[i] * p->omega0[i] - p->sigma[i] * p->sigma[i]);
        const double R = exp(-p->sigma[i] * s->dt), E = expm1(-p->sigma[i] * s->dt);
        const double den = creal(E * E + 4 * R * cpow(ccos(omega * s->dt / 2), 2));
        s->a[i] = creal(E * E + 4 * R * cpow(csin(omega * s->dt / 2), 2)) / den; /* (33) */
        s->b[i] = -2 * expm1(-2 * p->sigma[i] * s->dt) / den;
        s->J[i] = 1 + s->a[i] + s->b[i];
    }
    const double *g_b = p->contacts ? p->contact_weights : NULL, *g_c = p->threads ? p->thread_weights : NULL;
    s->phi_c = p->thread_stiffness / 2 + p->thread_damping / s->dt;
    s->inverse_c = 1 / (1 + s->phi_c * shared(s, g_c, g_c)), s->theta_bc = shared(s, g_b, g_c);
    s->beta_c = s->phi_c * s->theta_bc * s->inverse_c; /* (47) */
    s->theta = shared(s, g_b, g_b) - s->beta_c * s->theta_bc;
    made->dofs = 2 * p->modes;
    reset(s);
    return s;
}
static double contact(double d, double b, double theta, double k) { /* F of r + b = theta F (48): the four cases of fig 4 */
    const double phi = theta * k / 2;
    if (k == 0 || (d <= 0 && d + b <= 0)) return 0;
    if (d > 0 && d * (1 - phi) + b > 0) return ((2 * phi * d - b) / (1 + phi) + b) / theta;
    if (d > 0) return ((-b + sqrt(b * b + 4 * phi * d * d)) / 2 + b) / theta;
    return (-(b - 2 * phi * d + sqrt(b * b - 4 * phi * d * (b + d))) / (2 * (1 + phi)) + b) / theta;
}
static void step(struct mine *s) {
    const struct jvari_problem *p = s->p;
    const double *g_b = p->contacts ? p->contact_weights : NULL, *g_c = p->threads ? p->thread_weights : NULL;
    const double pluck = ((s->n < p->pluck_samples ? p->pluck_force[s->n] : 0) + (s->n + 1 < p->pluck_samples ? p->pluck_force[s->n + 1] : 0)) / 2;
    for (int64_t i = 0; i < p->modes; ++i) s->u[i] = (2 * (s->q[i] - s->a[i] * s->y[i]) + (p->plucks ? s->xi * p->pluck_weights[i] * pluck : 0)) / s->J[i];
    const double v_c = (p->thread_stiffness * (p->thread_height - dot(p->modes, g_c, s->y)) - s->phi_c * dot(p->modes, g_c, s->u)) * s->inverse_c;
    const double h = p->contacts ? *p->contact_height : 0, k = p->contacts ? *p->contact_stiffness : 0;
    const double F_b = contact(h - dot(p->modes, g_b, s->y), -dot(p->modes, g_b, s->u) - s->theta_bc * v_c, s->theta, k);
    const double F_c = g_c ? v_c - s->beta_c * F_b : 0; /* (46) */
    for (int64_t i = 0; i < p->modes; ++i) {
        const double r = s->u[i] + s->xi / s->J[i] * ((g_b ? g_b[i] * F_b : 0) + (g_c ? g_c[i] * F_c : 0)); /* (41) */
        s->y[i] += r, s->q[i] = r - s->q[i];                                                               /* (40) */
    }
    s->sum_b += F_b, s->sum_c += F_c, ++s->n;
}
static int advance(void *self, struct jvari_rows *out) {
    struct mine *s = self;
    const struct jvari_problem *p = s->p;
    for (int64_t row = 0; row < out->rows; ++row) {
        for (int64_t k = 0; k < out->taps; ++k) {
            const double *w = p->tap_weights + k * p->modes;
            const char *of = p->tap_quantities[k]; /* told apart by their first letter: bridge, thread, driving force; velocity */
            out->tap[k * out->stride + row] = of[0] == 'b'   ? s->sum_b / (double)p->steps_per_row
                                              : of[0] == 't' ? s->sum_c / (double)p->steps_per_row
                                              : of[1] == 'r' ? -(s->sum_b + s->sum_c) / (double)p->steps_per_row
                                              : of[0] == 'v' ? 2 / s->dt * dot(p->modes, w, s->q)
                                                             : dot(p->modes, w, s->y);
        }
        s->sum_b = s->sum_c = 0;
        for (int64_t n = 0; n < p->steps_per_row; ++n) step(s);
    }
    return JVARI_OK;
}

static const struct jvari_scheme scheme = {
    .size = sizeof scheme, .name = "two_point_in_c", .source = "van Walstijn et al. 2016, eqs 33, 38-48", .balance = "none",
    .represents = "bending stiffness, damping, frequency-dependent damping, measured modes, lumped barrier, thread, initial shape, pluck",
    .make = make, .reset = reset, .advance = advance, .release = release};
static const struct jvari_scheme *const schemes[] = {&scheme};
static const struct jvari_plugin plugin = {.size = sizeof plugin, .version = JVARI_SCHEME_VERSION, .schemes = schemes, .count = 1, .optimised = 1};
const struct jvari_plugin *jvari_schemes(void) { return &plugin; }
