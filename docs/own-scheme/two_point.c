/* The modal two-point scheme of van Walstijn, Bridges & Mehes 2016 (eqs 33, 38-48), from plain
 * arrays:
 *     cc -O3 -shared -fPIC -I FOLDER_OF_jvari_scheme.h two_point.c -o libtwo_point.so -lm
 *     jvari check --plugin ./libtwo_point.so
 * One contact of exponent 1 and a thread at most. */
#include <math.h>
#include <stdlib.h>

#include "jvari_scheme.h"

struct mine {
    const struct jvari_problem *p; /* lives as long as the scheme */
    const double *g_b, *g_c, *g_e; /* weights, zeros where there is none */
    double *a, *b, *J, *y, *q, *u; /* modes each */
    double dt, xi, theta, theta_bc, phi_c, inverse_c, beta_c, mean_b, mean_c, supplied, lost;
    int64_t n;
};

static double dot(const struct mine *s, const double *g, const double *y) {
    double sum = 0;
    for (int64_t i = 0; i < s->p->modes; ++i) sum += g[i] * y[i];
    return sum;
}
/* what 1 N through h adds to the increment at g */
static double shared(const struct mine *s, const double *g, const double *h) {
    double sum = 0;
    for (int64_t i = 0; i < s->p->modes; ++i) sum += g[i] * h[i] * s->xi / s->J[i];
    return sum;
}
static void reset(void *self) {
    struct mine *s = self;
    for (int64_t i = 0; i < s->p->modes; ++i) s->y[i] = s->p->start[i], s->q[i] = 0;
    s->n = 0, s->mean_b = s->mean_c = s->supplied = s->lost = 0;
}
static void *make(const struct jvari_scheme *scheme, const struct jvari_problem *p,
                  struct jvari_made *made) {
    (void)scheme;
    /* and its arrays behind it; the last stays 0 */
    struct mine *s = calloc(1, sizeof *s + sizeof(double) * (size_t)(7 * p->modes));
    double *room = (double *)(s + 1), *none = room + 6 * p->modes;
    s->p = p, s->dt = 1 / p->sample_rate, s->xi = s->dt * s->dt / (2 * p->modal_mass);
    s->a = room, s->J = room + p->modes, s->y = room + 2 * p->modes;
    s->q = room + 3 * p->modes, s->u = room + 4 * p->modes, s->b = room + 5 * p->modes;
    s->g_b = p->contacts ? p->contact_weights : none;
    s->g_c = p->threads ? p->thread_weights : none;
    s->g_e = p->plucks ? p->pluck_weights : none;
    for (int64_t i = 0; i < p->modes; ++i) { /* (33) */
        const double square = p->omega0[i] * p->omega0[i] - p->sigma[i] * p->sigma[i];
        const double turn = square > 0 ? cos(sqrt(square) * s->dt) : cosh(sqrt(-square) * s->dt);
        const double R = exp(-p->sigma[i] * s->dt), twice = 2 * R * turn, sum = 1 + twice + R * R;
        s->a[i] = (1 - twice + R * R) / sum, s->b[i] = 2 * (1 - R * R) / sum;
        s->J[i] = 1 + s->a[i] + s->b[i];
    }
    s->phi_c = p->thread_stiffness / 2 + p->thread_damping / s->dt;
    s->inverse_c = 1 / (1 + s->phi_c * shared(s, s->g_c, s->g_c));
    s->theta_bc = shared(s, s->g_b, s->g_c);
    s->beta_c = s->phi_c * s->theta_bc * s->inverse_c; /* (47) */
    s->theta = shared(s, s->g_b, s->g_b) - s->beta_c * s->theta_bc;
    made->dofs = 2 * p->modes;
    return s;
}
/* F of r + b = theta F (48): the four cases of fig 4 */
static double contact(double d, double b, double theta, double k) {
    const double phi = theta * k / 2;
    if (k == 0 || (d <= 0 && d + b <= 0)) return 0;
    if (d > 0 && d * (1 - phi) + b > 0) return ((2 * phi * d - b) / (1 + phi) + b) / theta;
    if (d > 0) return ((-b + sqrt(b * b + 4 * phi * d * d)) / 2 + b) / theta;
    return (-(b - 2 * phi * d + sqrt(b * b - 4 * phi * d * (b + d))) / (2 * (1 + phi)) + b) / theta;
}
static double pluck(const struct jvari_problem *p, int64_t n) {
    return n < p->pluck_samples ? p->pluck_force[n] : 0;
}
static void step(struct mine *s) {
    const struct jvari_problem *p = s->p;
    const double h = p->contacts ? *p->contact_height : 0;
    const double k = p->contacts ? *p->contact_stiffness : 0;
    const double F_e = (pluck(p, s->n) + pluck(p, s->n + 1)) / 2;
    for (int64_t i = 0; i < p->modes; ++i) /* (42) */
        s->u[i] = (2 * (s->q[i] - s->a[i] * s->y[i]) + s->xi * s->g_e[i] * F_e) / s->J[i];
    const double stretched = p->thread_height - dot(s, s->g_c, s->y);
    const double v_c =
        (p->thread_stiffness * stretched - s->phi_c * dot(s, s->g_c, s->u)) * s->inverse_c;
    const double d = h - dot(s, s->g_b, s->y);
    const double F_b = contact(d, -dot(s, s->g_b, s->u) - s->theta_bc * v_c, s->theta, k);
    const double F_c = v_c - s->beta_c * F_b;
    for (int64_t i = 0; i < p->modes; ++i) {
        const double r = s->u[i] + s->xi / s->J[i] * (s->g_b[i] * F_b + s->g_c[i] * F_c); /* (41) */
        s->y[i] += r, s->q[i] = r - s->q[i]; /* (40) */
        s->u[i] = r, s->lost += s->b[i] * r * r / s->xi;
    }
    const double r_c = dot(s, s->g_c, s->u); /* (51), (52) */
    s->lost += p->thread_damping / s->dt * r_c * r_c;
    s->supplied += F_e * dot(s, s->g_e, s->u);
    s->mean_b += F_b / (double)p->steps_per_row, s->mean_c += F_c / (double)p->steps_per_row;
    ++s->n;
}
static double stored(const struct mine *s) { /* (49) */
    const struct jvari_problem *p = s->p;
    const double d_b = p->contacts ? fmax(0, *p->contact_height - dot(s, s->g_b, s->y)) : 0;
    const double d_c = p->threads ? p->thread_height - dot(s, s->g_c, s->y) : 0;
    double sum = 0;
    for (int64_t i = 0; i < p->modes; ++i)
        sum += (s->q[i] * s->q[i] + s->a[i] * s->y[i] * s->y[i]) / s->xi;
    if (p->contacts) sum += *p->contact_stiffness * d_b * d_b / 2;
    return sum + p->thread_stiffness * d_c * d_c / 2;
}
/* driving force; bridge and thread force; velocity; displacement and nut force */
static double tap(const struct mine *s, const char *of, const double *w) {
    if (of[0] == 'd' && of[1] == 'r') return -s->mean_b - s->mean_c;
    if (*of == 'b') return s->mean_b;
    if (*of == 't') return s->mean_c;
    return *of == 'v' ? 2 / s->dt * dot(s, w, s->q) : dot(s, w, s->y);
}
static int advance(void *self, struct jvari_rows *out) {
    struct mine *s = self;
    for (int64_t row = 0; row < out->rows; ++row) {
        for (int64_t k = 0; k < out->taps; ++k)
            out->tap[k * out->stride + row] =
                tap(s, s->p->tap_quantities[k], s->p->tap_weights + k * s->p->modes);
        double *energy = out->energy ? out->energy + row : NULL;
        if (energy) energy[0] = stored(s), energy[out->stride] = s->supplied;
        if (energy) energy[2 * out->stride] = s->lost;
        s->mean_b = s->mean_c = s->supplied = s->lost = 0;
        for (int64_t n = 0; n < s->p->steps_per_row; ++n) step(s);
    }
    return JVARI_OK;
}

static const struct jvari_scheme scheme = {
    .size = sizeof scheme,
    .name = "two_point_in_c",
    .source = "van Walstijn et al. 2016, eqs 33, 38-48",
    .represents = "bending stiffness, damping, frequency-dependent damping, measured modes, "
                  "lumped barrier, thread, initial shape, pluck",
    .balance = "exact",
    .make = make,
    .reset = reset,
    .advance = advance,
    .release = free};
static const struct jvari_scheme *const schemes[] = {&scheme};
static const struct jvari_plugin plugin = {.size = sizeof plugin,
                                           .version = JVARI_SCHEME_VERSION,
                                           .schemes = schemes,
                                           .count = 1,
                                           .optimised = 1};
const struct jvari_plugin *jvari_schemes(void) { return &plugin; }
