/* charge.h - grains that charge each other in contact. MIT licence. Include it after dem.h.

   The condenser model (Harper, Contact and Frictional Electrification, 1967; Laurentie, Traore and Dascalescu, J.
   Electrost. 71 (2013) 951). Where new area dA comes into contact, charge crosses a gap z until the field there balances the
   difference of the work functions:

       dq_a = eps0/z (phi_a - phi_b - z E) dA,   E = (q_a/R_a^2 - q_b/R_b^2)/(4 pi eps0)

   phi: work functions of the materials over e, V; A = pi R* d, m2, counted up to its largest value in this contact; q: C;
   E: V/m, of the charges of these two grains, each spread over its sphere; a wall counts as uncharged. For a grain that hits
   a wall dq/dA = s - q/(4 pi R^2), with s = eps0 (phi_a - phi_b)/z in C/m2: its charge approaches 4 pi R^2 s, of which an
   area A gives the fraction 1 - exp(-A/(4 pi R^2)). One grain gains the charge that the other loses; `gained` in
   dem_wall_loads is the charge that a wall gains.

   Limits: no charge flows back when a contact ends, and none leaks. Charges exert no force here; a force field can add it,
   because it can read the charges in dem_bodies. Normal force and friction: dem_law_hertz, dem_law_mindlin_rescaled.

   law_who = 1; body_reals = "charge" (in C) or more names, `at` is its index. History: 5 reals, 1 vector; the last is A, m2. */
#ifndef CHARGE_H
#define CHARGE_H

/* What law_user points to. */
typedef struct charge {
    const dem_real *work;                    /* V, work functions over e of materials 1, 2, ...           */
    dem_real gap;                            /* m, z > 0: some 1e-9 (metals) to 5e-7 (polymers)           */
    int at;                                  /* index of the charge in body_reals, from 0                 */
} charge;

static inline void charge_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const charge *u = (const charge *)c->user;
    const dem_real pi = DEM_R(3.141592653589793), eps0 = DEM_R(8.8541878128e-12);
    const dem_real area = pi*c->r_eff*c->overlap, more = area - memory[4];
    const dem_real ra = c->who.radius_a, rb = c->who.radius_b;
    const dem_real side_a = c->who.reals_a[u->at]/(4*pi*ra*ra);
    const dem_real side_b = c->wall ? 0 : c->who.reals_b[u->at]/(4*pi*rb*rb);
    const dem_real density = eps0*(u->work[c->material_a - 1] - u->work[c->material_b - 1])/u->gap;
    dem_law_hertz(c, memory, f);
    dem_law_mindlin_rescaled(c, memory, f);
    if (!(more > 0) || !(c->dt > 0)) return;
    c->who.rate_a[u->at] += (density - side_a + side_b)*more/c->dt;
    c->who.rate_b[u->at] -= (density - side_a + side_b)*more/c->dt;
    memory[4] = area;
}

/* make law LAW=examples/laws/charge.h */
#if defined LAW_FILE && __INCLUDE_LEVEL__ < 2     /* examined itself, not a law that includes it */
static const dem_real charge_mine[] = {DEM_R(4.5)};
static charge charge_here = {charge_mine, DEM_R(1e-7), 0};
#define LAW {"charge", charge_law, &charge_here, 5, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 1}
#endif
#endif
