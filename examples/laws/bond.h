/* bond.h - cement between grains: bonds that stretch, shear, bend, twist and break. MIT licence. Include it after dem.h.

   Potyondy and Cundall, Int. J. Rock Mech. Min. Sci. 41 (2004) 1329, parallel bonds. A bond is a round beam of radius r
   between the centres of two grains, whose distance is l when it is made. With A = pi r^2, I = pi r^4/4, J = 2 I:

       tension E A/l per m    shear E/k A/l per m    bending E I/l per rad    twist E/k J/l per rad

   E: Young's modulus of the cement, Pa; k: ratio of normal to shear stiffness (2.5 for an isotropic cement with Poisson's
   ratio 1/4). A bond breaks for good when a stress (Pa) exceeds its strength:

       tensile force/A + |M| r/I > tension          |shear force|/A + |twist| r/J > shear

   `dem_bonds_make(world, gap, bond_make, world)` makes bonds between all pairs of spheres with smaller gaps, not with walls.
   A beam of n bonds bends under a force F at its end by F l^3/(E I) (n^3/3 - n/12) + F n l k/(E A), for large n by
   F L^3/(3 E I) with L = n l. beta: damping of each bond over its critical damping. It hardly damps slow vibrations of a
   whole beam.

   law_range: above `gap`, and above the stretch at rupture, tension l/E. law_stiffness: 4 E A/l. law_who = 1. Limits: small
   rotations of a bond; grains without a bond use the linear law with a spring (set normal_law to linear). Where a bond breaks
   under pressure, its grains repel from the distance at rupture on until they have parted, so that no energy is created.
   History: 8 reals, 2 vectors: shear (m), bending (rad), twist (rad), and the state (0: no bond; > 0: l; < 0: broken, minus
   the distance at rupture, or minus the sum of the radii once the grains have parted). */
#ifndef BOND_H
#define BOND_H
#include <math.h>
typedef struct bond {                        /* law_user points to it */
    dem_real E, k, radius;                   /* Pa > 0; > 0; m > 0                     */
    dem_real tension, shear, beta;           /* Pa, strengths > 0; >= 0                                   */
} bond;
enum { BOND_LENGTH = 7 };                    /* index of the state in the history              */

/* For dem_bonds_make: makes a bond of the present distance. user: the world. */
static inline void bond_make(const dem_contact_info *c, dem_real *memory, void *user) {
    dem_body_state a, b; int k;
    for (k = 0; k < BOND_LENGTH; k++) memory[k] = 0;
    if (dem_body_get((const dem_world *)user, c->a, &a) == DEM_OK &&
        dem_body_get((const dem_world *)user, c->b, &b) == DEM_OK)
        memory[BOND_LENGTH] = a.radius + b.radius - c->overlap;
}
/* For dem_contacts_each: counts intact bonds in user[0], and broken ones whose grains are still near in user[1]. */
static inline void bond_count(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)c; ((int *)user)[memory[BOND_LENGTH] < 0] += memory[BOND_LENGTH] < 0 || memory[BOND_LENGTH] > 0;
}
static inline dem_real bond_dot(dem_vec3 v, dem_vec3 w) { return v.x*w.x + v.y*w.y + v.z*w.z; }
/* Returns the energy stored in a bond (J) with these stiffnesses (N/m, N/m, N m, N m), stretch, shear, bending, twist. */
static inline dem_real bond_stored(const dem_real *stiff, dem_real x, dem_vec3 s, dem_vec3 b, dem_real twist) {
    return (stiff[0]*x*x + stiff[1]*bond_dot(s, s) + stiff[2]*bond_dot(b, b) + stiff[3]*twist*twist)/2;
}

static inline void bond_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const bond *u = (const bond *)c->user;
    const dem_real l = c->who.radius_a + c->who.radius_b - c->overlap, r = u->radius, dt = c->dt;
    const dem_real rest = memory[BOND_LENGTH] > 0 ? memory[BOND_LENGTH] : l, A = DEM_R(3.141592653589793)*r*r, I = A*r*r/4;
    const dem_real stiff[4] = {u->E*A/rest, u->E/u->k*A/rest, u->E*I/rest, u->E/u->k*2*I/rest};
    const dem_vec3 n = c->normal, v = c->slip, w = c->spin_step, slip = c->slip_step;
    dem_real x, twist, along, damp[2];
    dem_vec3 s, b; double pull, side;
    if (!(memory[BOND_LENGTH] > 0)) {                  /* no bond, or broken */
        dem_contact own = *c;
        const dem_real radii = c->who.radius_a + c->who.radius_b, offset = radii + memory[BOND_LENGTH];
        if (memory[BOND_LENGTH] < 0 && offset > 0) own.overlap -= offset;
        if (own.overlap > 0) { dem_law_linear(&own, memory, f); dem_law_spring(&own, memory, f); }
        else if (dt > 0) memory[0] = memory[1] = memory[2] = 0;
        if (dt > 0 && memory[BOND_LENGTH] < 0 && !(c->overlap > 0)) memory[BOND_LENGTH] = -radii;
        return;
    }
    s = dem_memory_rotate(c, dem_vec3_make(memory[0], memory[1], memory[2]));
    b = dem_memory_rotate(c, dem_vec3_make(memory[3], memory[4], memory[5]));
    along = bond_dot(w, n); x = l - rest;    /* rad/s; m, stretch */
    s = dem_vec3_make(s.x + dt*slip.x, s.y + dt*slip.y, s.z + dt*slip.z);
    b = dem_vec3_make(b.x + dt*(w.x - along*n.x), b.y + dt*(w.y - along*n.y), b.z + dt*(w.z - along*n.z));
    twist = memory[6] + dt*along;
    pull = (double)(stiff[0]*x)/(double)A + (double)stiff[2]*sqrt((double)bond_dot(b, b))*(double)(r/I);
    side = (double)stiff[1]*sqrt((double)bond_dot(s, s))/(double)A + fabs((double)(stiff[3]*twist))*(double)(r/(2*I));
    if (dt > 0 && (pull > (double)u->tension || side > (double)u->shear)) {
        f->energy.sag = bond_stored(stiff, x, s, b, twist);          /* its stored energy is lost */
        memory[BOND_LENGTH] = -l;
        memory[0] = memory[1] = memory[2] = memory[3] = memory[4] = memory[5] = memory[6] = 0;
        return;
    }
    damp[0] = 2*u->beta*(dem_real)sqrt((double)(stiff[0]*c->m_eff));
    damp[1] = 2*u->beta*(dem_real)sqrt((double)(stiff[1]*c->m_eff));
    f->normal = -stiff[0]*x + damp[0]*c->closing_speed;
    f->tangent = dem_vec3_make(-stiff[1]*s.x - damp[1]*v.x, -stiff[1]*s.y - damp[1]*v.y, -stiff[1]*s.z - damp[1]*v.z);
    f->moment = dem_vec3_make(-stiff[2]*b.x - stiff[3]*twist*n.x, -stiff[2]*b.y - stiff[3]*twist*n.y,
                              -stiff[2]*b.z - stiff[3]*twist*n.z);
    f->energy.dashpot = (damp[0]*c->closing_speed*c->closing_speed + damp[1]*bond_dot(v, v))*dt;
    f->energy.elastic = bond_stored(stiff, x, s, b, twist);
    if (!(dt > 0)) return;
    memory[0] = s.x; memory[1] = s.y; memory[2] = s.z; memory[3] = b.x; memory[4] = b.y; memory[5] = b.z; memory[6] = twist;
}
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static bond bond_mine = {DEM_R(1e8), DEM_R(2.5), DEM_R(5e-4), DEM_R(1e9), DEM_R(1e9), DEM_R(0.1)};
#define LAW {"bond", bond_law, &bond_mine, 8, 2, 1.6e5, DEM_NORMAL_LINEAR, -1, 2e-4, 1, bond_make}
#endif
#endif
