/* dmt.h - small hard grains that stick: Derjaguin, Muller and Toporov. MIT licence. Include it after dem.h.

   J. Colloid Interface Sci. 53 (1975) 314: Hertz's spring, and a pull that is the same as long as the two touch,

       F = kn d^(3/2) - 2 pi w R*,   nothing before they touch and after

   d m, overlap; kn N/m^(3/2), as Hertz's; w J/m2, work of adhesion, twice the surface energy of two alike; R* m. They are
   torn apart by 2 pi w R*, at d = 0. Range: Tabor's number (R* w^2/(E*^2 z^3))^(1/3) below 0.1, z some 0.3e-9 m; JKR
   (jkr.h) where it is above 5. Limits: adhesion itself loses nothing here; what is lost goes to Hertz's dashpot, so that
   elastic grains never stick. The force begins with its full pull: t_c/200 and below for the energy to close.

   Friction is Mindlin's spring, rescaled [THO13]; its limit is mu (F + 2 pi w R*). Memory: 4 reals, 1 vector. */
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
#ifdef LAW_FILE
static dmt dmt_mine = {DEM_R(0.05)};
#define LAW {"dmt", dmt_law, &dmt_mine, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 0}
#endif
#endif
