/* dmt.h - small hard grains that stick: Derjaguin, Muller and Toporov. MIT licence. Include it after dem.h.

   J. Colloid Interface Sci. 53 (1975) 314: Hertz's spring, and an attractive force that is constant during contact:

       F = kn d^(3/2) - 2 pi w R*;   no force before and after contact

   d: overlap, m; kn: as in Hertz's law, N/m^(3/2); w: work of adhesion, J/m2, twice the surface energy of two equal materials;
   R*: m. The pull-off force is 2 pi w R*, at d = 0. Range: Tabor's number (R* w^2/(E*^2 z^3))^(1/3) below 0.1, with z about
   0.3e-9 m; above 5 use JKR (jkr.h). Limits: adhesion itself loses no energy here; only Hertz's dashpot does, so elastic
   grains never stick. The force begins with its full attraction: the energy balance closes with t_c/200 and below,
   for spheres only (dem_contact.kn).

   Friction is Mindlin's spring, rescaled [THO13]; Coulomb's limit is mu (F + 2 pi w R*). History: 4 reals, 1 vector. */
#ifndef DMT_H
#define DMT_H

/* What law_user points to. */
typedef struct dmt { dem_real w; } dmt;                             /* J/m2, >= 0 */

static inline void dmt_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dmt *u = (const dmt *)c->user;
    const dem_real pull = DEM_R(6.283185307179586)*u->w*c->r_eff;
    dem_law_hertz(c, memory, f);                                    /* load: of Hertz's force alone */
    f->normal -= pull;
    f->energy.elastic -= pull*c->overlap;
    dem_law_mindlin_rescaled(c, memory, f);
}

/* make law LAW=examples/laws/dmt.h */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static dmt dmt_mine = {DEM_R(0.05)};
#define LAW {"dmt", dmt_law, &dmt_mine, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 0}
#endif
#endif
