/* viscoelastic.h - viscoelastic spheres: the faster the impact, the more energy is lost. MIT licence. Include it after dem.h.

   Brilliantov, Spahn, Hertzsch and Poeschel, Phys. Rev. E 53 (1996) 5382: Hertz's force, with a dashpot that follows from
   the same deformation field:

       F = kn d^(3/2) + 3/2 A kn d^(1/2) v,   never attractive

   kn: as in Hertz's law, N/m^(3/2) (c->kn, from Young's modulus of the materials); d: overlap, m; v: closing speed, m/s; A: s,
   follows from the two viscosities of the material and is measured in impacts. The coefficient of restitution e falls with the
   impact speed g (m/s); the built-in dashpots give the same e at any speed:

       e = 1 - C1 a + 3/5 C1^2 a^2 - ...,   a = 3/2 A (kn/m)^(2/5) g^(1/5),   C1 = 1.15344

   m: reduced mass, kg (Schwager and Poeschel, Phys. Rev. E 57 (1998) 650). Range: a below 0.3, which means e above 0.7; beyond,
   the series needs more terms. Limits: impacts much slower than sound in the grain. A is the same for other sizes, but not at
   other temperatures. The time step is that of Hertz's law with the restitution of the materials.

   Friction is Mindlin's spring, rescaled [THO13]. History: 4 reals, 1 vector. */
#ifndef VISCOELASTIC_H
#define VISCOELASTIC_H
#include <math.h>

/* What law_user points to. */
typedef struct viscoelastic { dem_real A; } viscoelastic;           /* s, >= 0 */

static inline void viscoelastic_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const viscoelastic *v = (const viscoelastic *)c->user;
    dem_law_hertz(c, memory, f);                                    /* spring and tangential stiffness */
    f->normal = f->elastic + v->A*f->slope*c->closing_speed;        /* slope: 3/2 kn d^(1/2) */
    if (f->normal < 0) f->normal = 0;
    f->load = f->normal;
    f->energy.dashpot = (f->normal - f->elastic)*c->closing_speed*c->dt;
    dem_law_mindlin_rescaled(c, memory, f);
}

/* Returns the restitution by the first terms of the series, up to a^4. kn: N/m^(3/2); m: reduced mass, kg; g: m/s. */
static inline double viscoelastic_restitution(double A, double kn, double m, double g) {
    const double a = 1.5*A*pow(kn/m, 0.4)*pow(g, 0.2);
    return 1 - 1.15344*a + 0.79826*a*a - 0.48358*a*a*a + 0.28528*a*a*a*a;
}

/* make law LAW=examples/laws/viscoelastic.h: grains of 1 mm with e = 0.8 at 0.1 m/s. */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static viscoelastic viscoelastic_mine = {DEM_R(4e-6)};
#define LAW {"viscoelastic", viscoelastic_law, &viscoelastic_mine, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 0}
#endif
#endif
