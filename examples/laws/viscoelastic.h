/* viscoelastic.h - spheres of a material that flows a little as it is pressed: the faster they meet, the more they lose.
   MIT licence. Include it after dem.h.

   Brilliantov, Spahn, Hertzsch and Poeschel, Phys. Rev. E 53 (1996) 5382: Hertz's force, with a dashpot that follows
   from the same field of deformation,

       F = kn d^(3/2) + 3/2 A kn d^(1/2) v,   never pulling

   kn N/m^(3/2), as Hertz's (c->kn: from the Young's modulus of the materials); d m, overlap; v m/s, approach; A s, which
   the two viscosities of the material make, and which is measured in impacts. The coefficient of restitution e falls with
   the speed g (m/s) of an impact, where built-in dashpots give the same at any speed:

       e = 1 - C1 a + 3/5 C1^2 a^2 - ...,   a = 3/2 A (kn/m)^(2/5) g^(1/5),   C1 = 1.15344

   m kg, reduced mass (Schwager and Poeschel, Phys. Rev. E 57 (1998) 650). Range: a below 0.3, that is e above 0.7; above,
   the series needs more terms. Limits: slower than sound in the grain, by far; A of other sizes is the same, of other
   temperatures not. The time step is that of Hertz's law with the restitution of the materials.

   Friction is Mindlin's spring, rescaled [THO13]. Memory: 4 reals, 1 vector. */
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

/* Restitution of an impact, by the first four terms of the series. kn: N/m^(3/2); m: kg, reduced; g: m/s. */
static inline double viscoelastic_restitution(double A, double kn, double m, double g) {
    const double a = 1.5*A*pow(kn/m, 0.4)*pow(g, 0.2);
    return 1 - 1.15344*a + 0.79826*a*a - 0.48358*a*a*a + 0.28528*a*a*a*a;
}

/* make law LAW=examples/laws/viscoelastic.h: glass-like grains of 1 mm that keep 0.8 of 0.1 m/s. */
#ifdef LAW_FILE
static viscoelastic viscoelastic_mine = {DEM_R(4e-6)};
#define LAW {"viscoelastic", viscoelastic_law, &viscoelastic_mine, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 0}
#endif
#endif
