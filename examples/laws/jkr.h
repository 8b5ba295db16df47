/* jkr.h - soft grains that stick: Johnson, Kendall and Roberts. MIT licence. Include it after dem.h.

   Proc. R. Soc. Lond. A 324 (1971) 301. For two grains in contact on a circle of radius a (m):

       d = a^2/R* - B a^(1/2),   F = 4/3 E* a^3/R* - 2 E* B a^(3/2),   B = (2 pi w/E*)^(1/2)

   d: overlap, m; w: work of adhesion, J/m2, twice the surface energy of two equal materials; E*: Pa; R*: m. A contact begins at
   d = 0, where F jumps to -4/3 pi w R*. Under a growing tensile force it ends at -3/2 pi w R*; under a prescribed displacement
   at 5/9 of that, at

       d = -3/4 B (R* B/4)^(1/3)     desc.law_range must be at least that: jkr_range, with the largest R*

   A cycle from there to d = 0 and back loses 7.09 (w^5 R*^4/E*^2)^(1/3) in J: 0.90 of it when the contact begins, the rest when
   it ends. Slow elastic grains stick (Thornton and Ning, Powder Technol. 99 (1998) 154):

       e^2 = 1 - (v_s/v)^2,   v_s^2 = 14.18 (w^5 R*^4/E*^2)^(1/3)/m*

   Range: Tabor's number (R* w^2/(E*^2 z^3))^(1/3) above 5, with z about 0.3e-9 m; below 0.1 use DMT (dmt.h). Softened grains
   stick more: keep w^5/E^2. The dashpot is Hertz's for the circle a. For spheres: with other shapes E* changes with the
   overlap as kn does (dem_contact.kn), and this energy and the ledger are wrong.

   Friction is Mindlin's spring, rescaled [THO13], with 8 G* a; Coulomb's limit is mu (F + 3 pi w R*) (Thornton, J. Phys. D 24
   (1991) 1942). law_stiffness: 0 (Hertz's). History: 6 reals, 1 vector: spring and its stiffness; 1 while in contact; stored
   energy, J. */
#ifndef JKR_H
#define JKR_H
#include <math.h>

/* What law_user points to. */
typedef struct jkr { dem_real w; } jkr;                             /* J/m2, > 0 */

static inline double jkr_range(double w, double E, double R) {      /* m; E: E*, Pa; R: R*, m */
    const double B = sqrt(6.283185307179586*w/E);
    return 0.75*B*pow(R*B/4, 1.0/3);
}
/* Returns c = a^(1/2) at overlap d: the larger root of c^4/R - B c = d, by Newton's method from above. */
static inline dem_real jkr_root(dem_real d, dem_real R, dem_real B) {
    const dem_real far = (dem_real)cbrt((double)(2*R*B));
    dem_real c = d > 0 ? (dem_real)sqrt(sqrt((double)(2*R*d))) : 0;
    int k;
    c = c > far ? c : far;
    for (k = 0; k < 30; k++) {
        const dem_real slope = 4*c*c*c/R - B, step = slope > 0 ? (c*c*c*c/R - B*c - d)/slope : 0;
        c -= step;
        if (!(step > c*DEM_R(1e-14))) break;
    }
    return c;
}
/* Returns the stored energy, J, at c = a^(1/2). */
static inline dem_real jkr_stored(dem_real E, dem_real R, dem_real B, dem_real c) {
    const dem_real a = c*c;
    return E*(a*a*a*a*a*8/(15*R*R) - a*a*a*c*B*4/(3*R) + a*a*B*B/2);
}
static inline void jkr_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const jkr *u = (const jkr *)c->user;
    const dem_real R = c->r_eff, root = (dem_real)sqrt((double)R), E = DEM_R(0.75)*c->kn/root;
    const dem_real B = (dem_real)sqrt(6.283185307179586*(double)(u->w/E));
    const dem_real least = DEM_R(-0.75)*B*(dem_real)cbrt((double)(R*B/4)), stored = memory[5];
    const int sticks = c->overlap > 0 || (memory[4] > 0 && c->overlap > least);
    dem_real x, a, F = 0;
    if (sticks) {
        x = jkr_root(c->overlap, R, B);
        a = x*x;
        F = E*(a*a*a*4/(3*R) - 2*B*a*x);
        f->elastic = F;
        f->energy.elastic = jkr_stored(E, R, B, x);
        f->slope = f->slope_step = 2*E*a;                           /* of the disc that sticks, for rolling laws */
        f->kt = f->kt_step = c->kt*a/root;                          /* 8 G* a */
        f->ct = c->ct*x/(dem_real)sqrt((double)root);
        f->normal = F + c->cn*x/(dem_real)sqrt((double)root)*c->closing_speed;
        dem_law_load(c, f, DEM_R(9.42477796076938)*u->w*R);
    }
    if (sticks && !(memory[4] > 0)) f->energy.sag = -jkr_stored(E, R, B, (dem_real)cbrt((double)(B*R)));  /* at d = 0 */
    if (!sticks && memory[4] > 0) f->energy.sag = stored;
    if (c->dt > 0) {
        memory[4] = sticks ? DEM_R(1) : DEM_R(0);
        memory[5] = f->energy.elastic;
    }
    if (sticks) dem_law_mindlin_rescaled(c, memory, f);
    else if (c->dt > 0) memory[0] = memory[1] = memory[2] = memory[3] = 0;
}

/* make law LAW=examples/laws/jkr.h: E* of 5.33e6 Pa, R* of 5e-4 m, w 0.05 J/m2. */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static jkr jkr_mine = {DEM_R(0.05)};
#define LAW {"jkr", jkr_law, &jkr_mine, 6, 1, 0, DEM_NORMAL_HERTZ, -1, 1e-5, 0}
#endif
#endif
