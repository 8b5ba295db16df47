/* capillary.h - wet grains: a liquid bridge between any two that have touched. MIT licence. Include it after dem.h.

   Willett, Adams, Johnson and Seville, Langmuir 16 (2000) 9396. For spheres of radius R with a gap S (m) between them:

       F = -2 pi R g cos(t)/(1 + 1.05 s + 2.5 s^2),   s = S (R/V)^(1/2)      eq 12, within 10 % of the full solution
       rupture at S = (1 + t/2) V^(1/3)                                      Lian, Thornton and Adams 1993, t in rad

   g: surface tension, N/m (water 0.073); t: contact angle, rad; V: volume of each bridge, m3. R = 2 R* (Derjaguin's mean) is
   accurate to a few % for ratios of radii up to 2, and for a wall. In contact the force is 2 pi R g cos(t) for any volume.
   A bridge forms when two grains touch, not before: approaching grains feel nothing, and the work of separation, the
   integral of F (J), is lost. desc.law_range must be at least capillary_rupture.

   Range: V below about 0.01 R^3, t below 0.7, grains below the capillary length (2.7e-3 m for water). Limits: no viscous
   force of the liquid, no flow of liquid between grains, no bridges that merge. The ledger closes for spheres only
   (dem_contact.kn).

   In contact: Hertz's law and Mindlin's spring, rescaled [THO13]. Coulomb's limit is mu times the elastic force of Hertz's
   law, which the bridge increases. History: 5 reals, 1 vector: spring and its stiffness; 1 while there is a bridge. */
#ifndef CAPILLARY_H
#define CAPILLARY_H
#include <math.h>

/* What law_user points to. */
typedef struct capillary { dem_real tension, angle, volume; } capillary;    /* N/m, >= 0; rad, 0 .. 1.5; m3, > 0 */

static inline double capillary_rupture(const capillary *u) {                /* m, gap at rupture */
    return (1 + (double)u->angle/2)*cbrt((double)u->volume);
}
static inline double capillary_force(const capillary *u, double R, double S) {      /* N, attraction; R: m, S: m, >= 0 */
    const double s = S*sqrt(R/(double)u->volume);
    return 6.283185307179586*R*(double)u->tension*cos((double)u->angle)/(1 + 1.05*s + 2.5*s*s);
}
/* Returns the integral of the force from S to rupture, J. */
static inline double capillary_work(const capillary *u, double R, double S) {
    const double k = sqrt(R/(double)u->volume), q = sqrt(4*2.5 - 1.05*1.05);
    return capillary_force(u, R, 0)*2/(q*k)*(atan((5*k*capillary_rupture(u) + 1.05)/q) - atan((5*k*S + 1.05)/q));
}
static inline void capillary_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const capillary *u = (const capillary *)c->user;
    const double S = c->overlap < 0 ? -(double)c->overlap : 0, R = 2*(double)c->r_eff;
    const int touch = c->overlap > 0, there = touch || (memory[4] > 0 && S < capillary_rupture(u));
    if (touch) {
        dem_law_hertz(c, memory, f);
        dem_law_mindlin_rescaled(c, memory, f);
    } else if (c->dt > 0) memory[0] = memory[1] = memory[2] = memory[3] = 0;
    if (there) {
        const double pull = capillary_force(u, R, S), held = capillary_work(u, R, 0);
        f->normal -= (dem_real)pull;
        f->energy.elastic -= (dem_real)(touch ? held + pull*(double)c->overlap : capillary_work(u, R, S));
        if (!(memory[4] > 0)) f->energy.sag = (dem_real)(held + pull*(double)c->overlap);   /* wetting: this energy is lost */
    }
    if (c->dt > 0) memory[4] = there ? DEM_R(1) : DEM_R(0);
}

/* make law LAW=examples/laws/capillary.h: water, bridges of a thousandth of a grain of 1 mm. */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static capillary capillary_mine = {DEM_R(0.073), DEM_R(0.3), DEM_R(4e-12)};
#define LAW {"capillary", capillary_law, &capillary_mine, 5, 1, 0, DEM_NORMAL_HERTZ, -1, 2e-4, 0}
#endif
#endif
