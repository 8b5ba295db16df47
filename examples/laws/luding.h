/* luding.h - cohesive powder: grains that yield; the harder they were pressed, the more they stick. MIT licence.
   Include it after dem.h.

   Luding, Granular Matter 10 (2008) 235. D (m) is the depth in the contact history:

       loading             F = k1 d
       un- and reloading   F = k2 (d - d0),   d0 = (1 - k1/k2) D
       tension             F >= -kc d; on this line D decreases: D = d (k2 + kc)/(k2 - k1)
       k2                  k1 + (k2p - k1) D/Dp for D < Dp, then k2p: at Dp the contact has yielded completely; beyond, it
                           is loaded along k2p, and D stays at Dp

   k1 <= k2p, kc: N/m; d: overlap, m. The largest attraction is at d = (k2 - k1) D/(k2 + kc). An impact at g (m/s) with the
   reduced mass m (kg) reaches D = g sqrt(m/k1). If that is below Dp, with the k2 there:

       e^2 = k1/k2 - kc (k2 - k1)^2/(k1 k2 (k2 + kc));   negative: e = 0, they stick

   Range: kc up to about k1. With a constant k2 dem.h has this law as DEM_NORMAL_HYSTERETIC. Limits: as there, a grain at rest
   on the unloading line oscillates without end unless `damping` (N s/m) is set. The ledger closes for spheres only
   (dem_contact.kn). law_stiffness: k2p.

   Friction is a spring with kt = 2/7 k1; Coulomb's limit is mu (F + kc d), which is 0 at the limit of tension.
   History: 6 reals, 1 vector: spring, D, and overlap and force of the last step, for the energy account. */
#ifndef LUDING_H
#define LUDING_H
#include <math.h>

/* What law_user points to. */
typedef struct luding {
    dem_real k1, k2p, kc;        /* N/m: loading > 0; unloading after complete yield >= k1; adhesion >= 0 */
    dem_real Dp;                 /* m, > 0: depth of complete yield; 0: k2 = k2p at any depth, no limit */
    dem_real damping;            /* N s/m, >= 0                                               */
} luding;

static inline dem_real luding_k2(const luding *l, dem_real D) {
    return D < l->Dp ? l->k1 + (l->k2p - l->k1)*D/l->Dp : l->k2p;
}
/* Returns D, reduced on the line of tension: D (k2(D) - k1) = d (k2(D) + kc). */
static inline dem_real luding_depth(const luding *l, dem_real D, dem_real d) {
    const dem_real soft = l->k2p - l->k1, full = d*(l->k2p + l->kc)/(soft > 0 ? soft : DEM_R(1e-30));
    dem_real s, b, least = full;                                    /* s D^2 = d (k1 + s D + kc) */
    if (l->Dp > 0 && full < l->Dp) {
        s = soft/l->Dp;
        b = s*d;
        least = (b + (dem_real)sqrt((double)(b*b + 4*s*d*(l->k1 + l->kc))))/(2*s);
    }
    return D < least ? D : least;
}

static inline void luding_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const luding *l = (const luding *)c->user;
    dem_real *own = memory + 3, d = c->overlap, D = own[0] > d ? own[0] : d, k2, was, before;
    if (l->Dp > 0 && D > l->Dp) D = l->Dp;
    D = luding_depth(l, D, d);
    k2 = luding_k2(l, D);
    was = luding_k2(l, own[0]);
    before = own[2]*own[2]/(2*was);
    f->elastic = k2*d - (k2 - l->k1)*D;
    f->normal = f->elastic + l->damping*c->closing_speed;
    f->slope = f->slope_step = l->k1;
    f->kt = f->kt_step = l->k1*2/7;
    dem_law_load(c, f, l->kc*d);
    f->energy.elastic = f->elastic*f->elastic/(2*k2);
    f->energy.sag = (f->elastic + own[2])/2*(d - own[1]) - (f->energy.elastic - before);
    if (c->dt > 0) { own[0] = D; own[1] = d; own[2] = f->elastic; }
    dem_law_spring(c, memory, f);
}

/* Returns the square of the restitution at g (m/s) for D < Dp or Dp = 0; negative: they stick. m: reduced mass, kg. */
static inline double luding_restitution2(const luding *l, double m, double g) {
    const double k1 = (double)l->k1, kc = (double)l->kc;
    const double k2 = (double)luding_k2(l, (dem_real)(g*sqrt(m/k1))), soft = k2 - k1;
    return k1/k2 - kc*soft*soft/(k1*k2*(k2 + kc));
}

/* make law LAW=examples/laws/luding.h */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static luding luding_mine = {DEM_R(1e4), DEM_R(5e4), DEM_R(5e3), DEM_R(4e-5), 0};
#define LAW {"luding", luding_law, &luding_mine, 6, 1, 5e4, DEM_NORMAL_LINEAR, -1, 0, 0}
#endif
#endif
