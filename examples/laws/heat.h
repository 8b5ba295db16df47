/* heat.h - heat that flows from grain to grain where they touch. MIT licence. Include it after dem.h.

   Batchelor and O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313: two solids that touch on a disc of radius a exchange

       Q = 2 k a (T_b - T_a)  W,   k = 2 k_a k_b/(k_a + k_b)  W/(m K),   a = sqrt(R* d)  m

   of Hertz's contact, which is pressed as the built-in law has it (dem_law_hertz, dem_law_mindlin_rescaled). A grain has
   one temperature, and gains Q/(m c) K/s. A wall keeps its temperature; what it is given is counted in J (`gained` of
   dem_wall_loads). Softened grains touch on larger discs: under a given load a ~ E^(-1/3), so `area` is (E/E_true)^(1/3).

   Range: k 2 a small against what flows inside a grain, a < 0.1 R: Biot's number 2 k a/(pi k R) below 0.1; no gas between
   the grains, no radiation. Euler's step wants dt below m c/(sum of 2 k a), which is above 1e3 steps of the springs of true
   heat capacities: desc.law_rate = heat_rate has dem.h see to it.

   law_who = 1, body_reals = "temperature" (in K, or any scale) or more, `at` telling which. Memory: 4 reals, 1 vector. */
#ifndef HEAT_H
#define HEAT_H
#include <math.h>

/* What law_user points to. */
typedef struct heat {
    const dem_real *conductivity;            /* W/(m K), > 0, of materials 1, 2, ...                      */
    const dem_real *capacity;                /* J/(kg K), > 0, of materials 1, 2, ...                     */
    dem_real area;                           /* disc over that of the softened grains, > 0; 0: 1          */
    int at;                                  /* which of body_reals the temperature is, from 0            */
} heat;

/* W/K: what flows per kelvin. */
static inline dem_real heat_flow(const dem_contact *c) {
    const heat *u = (const heat *)c->user;
    const dem_real ka = u->conductivity[c->material_a - 1], kb = u->conductivity[c->material_b - 1];
    const dem_real a = (u->area > 0 ? u->area : 1)*(dem_real)sqrt((double)(c->r_eff*c->overlap));
    return 4*ka*kb/(ka + kb)*a;
}
/* desc.law_rate: how fast the temperatures of the two follow each other, 1/s. */
static inline void heat_rate(const dem_contact *c, dem_real *rates) {
    const heat *u = (const heat *)c->user;
    const dem_real flow = heat_flow(c);
    rates[0] = flow/(c->who.mass_a*u->capacity[c->material_a - 1]);
    if (!c->wall) rates[1] = flow/(c->who.mass_b*u->capacity[c->material_b - 1]);
}
static inline void heat_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const heat *u = (const heat *)c->user;
    const dem_real Q = heat_flow(c)*(c->who.reals_b[u->at] - c->who.reals_a[u->at]);
    dem_law_hertz(c, memory, f);
    dem_law_mindlin_rescaled(c, memory, f);
    c->who.rate_a[u->at] += Q/(c->who.mass_a*u->capacity[c->material_a - 1]);
    c->who.rate_b[u->at] -= c->wall ? Q : Q/(c->who.mass_b*u->capacity[c->material_b - 1]);
}

/* make law LAW=examples/laws/heat.h */
#ifdef LAW_FILE
static const dem_real heat_mine[] = {1};
static heat heat_here = {heat_mine, heat_mine, 0, 0};
#define LAW {"heat", heat_law, &heat_here, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 1}
#endif
#endif
