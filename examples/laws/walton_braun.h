/* walton_braun.h - grains that yield: unloading is stiffer than loading, and the difference grows with the
   largest force. MIT licence. Include it after dem.h.

   Walton and Braun, J. Rheol. 30 (1986) 949. D (m) is the largest overlap so far:

       loading             F = k1 d
       un- and reloading   F = k2 (d - d0),   d0 = (1 - k1/k2) D,   never attractive
       k2                  k1 stiffer + S k1 D: grows with D, or is constant if S (1/m) is 0

   k1, k2: N/m; d: overlap, m. An impact at g (m/s) with the reduced mass m (kg) reaches D = g sqrt(m/k1), so that

       e = sqrt(k1/k2(D))

   With `stiffer` = 1 and S > 0, e falls from 1 at speed 0; with S = 0 it is the same at any speed. No dashpot is needed.
   Range: e from 0.1 to 1. Limits: a grain at rest on the unloading line oscillates, because nothing is lost there: set
   `damping` (N s/m) where grains must come to rest. The dent is forgotten when the contact ends. The ledger closes for spheres
   only (dem_contact.kn). law_stiffness: the largest k2 that occurs, for the time step.

   Friction is a spring with kt = 2/7 k1 [CS79]. History: 6 reals, 1 vector: spring, D, and overlap and force of the last
   step, for the energy account. */
#ifndef WALTON_BRAUN_H
#define WALTON_BRAUN_H
#include <math.h>

/* What law_user points to. */
typedef struct walton_braun {
    dem_real k1;                 /* N/m, > 0: loading                                         */
    dem_real stiffer;            /* k2/k1 at D = 0, >= 1                                      */
    dem_real S;                  /* 1/m, >= 0: growth of k2/k1 with D                         */
    dem_real damping;            /* N s/m, >= 0                                               */
} walton_braun;

static inline void walton_braun_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const walton_braun *w = (const walton_braun *)c->user;
    dem_real *own = memory + 3;                                     /* vectors come first */
    const dem_real D = own[0] > c->overlap ? own[0] : c->overlap;
    const dem_real k2 = w->k1*(w->stiffer + w->S*D), out = k2*c->overlap - (k2 - w->k1)*D;
    const dem_real stored = own[2]*own[2]/(2*w->k1*(w->stiffer + w->S*own[0]));
    f->elastic = out > 0 ? out : 0;
    f->normal = f->elastic + w->damping*c->closing_speed;
    f->slope = f->slope_step = w->k1;
    f->kt = f->kt_step = w->k1*2/7;
    dem_law_load(c, f, 0);
    f->energy.elastic = f->elastic*f->elastic/(2*k2);               /* work that is not stored is lost */
    f->energy.sag = (f->elastic + own[2])/2*(c->overlap - own[1]) - (f->energy.elastic - stored);
    if (c->dt > 0) { own[0] = D; own[1] = c->overlap; own[2] = f->elastic; }
    dem_law_spring(c, memory, f);
}

/* Returns the restitution of an impact at g (m/s); m: reduced mass, kg. */
static inline double walton_braun_restitution(const walton_braun *w, double m, double g) {
    return 1/sqrt((double)w->stiffer + (double)w->S*g*sqrt(m/(double)w->k1));
}

/* make law LAW=examples/laws/walton_braun.h */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static walton_braun walton_braun_mine = {DEM_R(1e4), 1, DEM_R(3e4), 0};
#define LAW {"walton_braun", walton_braun_law, &walton_braun_mine, 6, 1, 5e4, DEM_NORMAL_LINEAR, -1, 0, 0}
#endif
#endif
