/* heat.h - heat conduction through contacts. MIT licence. Include it after dem.h.

   Batchelor and O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313. Two solids in contact on a disc of radius a exchange

       Q = 2 k a (T_b - T_a)  W,   k = 2 k_a k_b/(k_a + k_b)  W/(m K),   a = sqrt(R* d)  m

   with the overlap d of Hertz's law. Forces are those of dem_law_hertz and dem_law_mindlin_rescaled. A grain has one
   temperature and gains Q/(m c) in K/s. A wall keeps its temperature; `gained` of dem_wall_loads is the heat it receives, J.
   Softened grains have larger discs: under a given load a is proportional to E^(-1/3). `area` = (E/E_true)^(1/3) corrects it.

   Range: a grain conducts well inside compared with its contacts: Biot's number 2 k a/(pi k R) below 0.1, a < 0.1 R. No gas
   between the grains, no radiation. Euler's step needs dt below m c/(sum of 2 k a), which for true heat capacities is more than
   1e3 steps of the springs; with desc.law_rate = heat_rate dem.h checks it.

   law_who = 1; body_reals = "temperature" (in K or any scale) or more names, `at` is its index. History: 4 reals, 1 vector. */
#ifndef HEAT_H
#define HEAT_H
#include <math.h>

/* What law_user points to. */
typedef struct heat {
    const dem_real *conductivity;            /* W/(m K), > 0, of materials 1, 2, ...                      */
    const dem_real *capacity;                /* J/(kg K), > 0, of materials 1, 2, ...                     */
    dem_real area;                           /* radius of the disc over that of softened grains; 0: 1     */
    int at;                                  /* index of the temperature in body_reals, from 0            */
} heat;

/* Returns the thermal conductance of a contact, W/K. */
static inline dem_real heat_flow(const dem_contact *c) {
    const heat *u = (const heat *)c->user;
    const dem_real ka = u->conductivity[c->material_a - 1], kb = u->conductivity[c->material_b - 1];
    const dem_real a = (u->area > 0 ? u->area : 1)*(dem_real)sqrt((double)(c->r_eff*c->overlap));
    return 4*ka*kb/(ka + kb)*a;
}
/* For desc.law_rate: the rates at which the temperatures of the two approach each other, 1/s. */
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
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static const dem_real heat_mine[] = {1};
static heat heat_here = {heat_mine, heat_mine, 0, 0};
#define LAW {"heat", heat_law, &heat_here, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 1}
#endif
#endif
