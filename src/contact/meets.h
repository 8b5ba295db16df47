/* ---------------------------------------------------------------------------------------------
   >>meets
   Narrow phase for parts of two bodies: geometry only, into a contact that >>persistent has begun.
   Spheres use their centres, ellipsoids the contact point of Perram and Wertheim [PW85]. Owns
   nothing, and writes only the contacts that it is given.
   --------------------------------------------------------------------------------------------- */

/* --- Each function returns 1 if two parts touch, and writes the geometry to c. gap: m, from p's
   centre to q's; lambda: a start value, 0: unknown. spots: set if the contact has several points,
   each with its own gap, relative to p's centre; otherwise its count stays 0. --- */
typedef int (*demi_meet_fn)(const dem_world *w, const demi_part *p, const demi_part *q,
                            dem_vec3 gap, double lambda, demi_persistent *c, demi_spots *spots);
/* Two spheres of radii r and s, at x and y from the centres of their bodies. The contact point
   divides their distance in the ratio of the radii. */
DEM_INLINE int demi_balls_meet(const dem_world *w, dem_vec3 x, dem_real r, dem_vec3 y, dem_real s,
                               dem_vec3 gap, demi_persistent *c) {
    const dem_real d = demi_length(gap), sum = r + s;
    if (!(d < sum + demi_range(w, sum))) return 0;
    c->normal = d > 0 ? demi_scale(gap, 1/d) : demi_v(0, 0, 1);
    c->overlap = sum - d;
    c->deep = c->overlap/DEMI_MIN(r, s);
    c->r_eff = r*s/sum;
    c->arm_a = demi_add(x, demi_scale(c->normal, d*r/sum));
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(x, gap), y));
    c->bend = -1/DEMI_MAX(d, sum/10);
    return 1;
}
static int demi_balls_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                            dem_vec3 gap, double lambda, demi_persistent *c, demi_spots *spots) {
    (void)lambda; (void)spots;
    return demi_balls_meet(w, p->centre, p->radius, q->centre, q->radius, gap, c);
}
/* Writes the contact of two ellipsoids, row k of a tile, to c, except for its arms; one of them may
   be a sphere. p, q: the two; not read if the overlap is the conservative one. */
DEM_INLINE void demi_ellipsoids_set(const dem_world *w, demi_ellipsoid_tile *t, int k,
                                    const demi_part *p, const demi_part *q, demi_persistent *c) {
    c->lambda = t->to[k];
    c->normal = demi_d3_real(demi_ellipsoids_at(t->normal, k));
    c->deep = (dem_real)t->deep[k];
    c->overlap = (dem_real)t->overlap[k];
    c->r_eff = (dem_real)t->r_eff[k];
    if (w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE) c->slope = (dem_real)t->slope[k];
    else {
        const double l = t->to[k], both = t->both[k];
        const double ra = demi_part_round(w, p, l*both), rb = demi_part_round(w, q, (1 - l)*both);
        c->r_eff = (dem_real)(ra*rb/(ra + rb));
        /* across a gap there is no chord */
        c->overlap = (dem_real)(w->desc.ellipsoid_overlap == DEM_OVERLAP_CHORD && t->w0[k] < 1
            ? demi_ellipsoids_chord(t, k) : (1 - t->w0[k])*both);
    }
}
static int demi_ellipsoids_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                 dem_vec3 gap, double lambda, demi_persistent *c,
                                 demi_spots *spots) {
    demi_ellipsoid_tile t;
    dem_real thin = demi_ellipsoid_put(&t, 0, 0, p->q, demi_part_axes(p));
    (void)spots;
    thin += demi_ellipsoid_put(&t, 0, 1, q->q, demi_part_axes(q));
    t.equal[0][0] = demi_part_equal(p);
    t.equal[1][0] = demi_part_equal(q);
    demi_ellipsoids_row(&t, 0, gap, lambda, (double)demi_range(w, p->radius + q->radius), thin);
    demi_ellipsoids_solve_one(&t, 0);
    if (!demi_ellipsoids_meet(&t, 0)) return 0;
    demi_ellipsoids_set(w, &t, 0, p, q, c);
    c->arm_a = demi_add(p->centre, demi_d3_real(demi_ellipsoids_at(t.point, 0)));
    /* to the same point, exactly: conserves angular momentum */
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* Sets overlap and arm of an ellipsoid at its normal, from left = 1 - W0: with a plane or a
   polyhedron (edge 0) or a grain of a wall (edge: its radius). As for two ellipsoids, the overlap
   is l (1 - W0), where l includes `edge`, or is measured along the normal. The arm leads to the
   deepest point, as for a sphere. The gradient of l (1 - W0) passes through the point of the wall,
   at W0 times the arm. */
static void demi_ellipsoid_overlap(const dem_world *w, const demi_part *p, dem_real left,
                                   dem_real edge, demi_persistent *c) {
    const dem_real h = demi_ellipsoid_arm(p, c->normal, &c->arm_a);
    c->overlap = left*(h + edge);
    c->deep = c->overlap/h;
    c->r_eff = (dem_real)demi_part_round(w, p, (double)h);
    if (w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE) {
        const dem_real l = (dem_real)demi_part_equal(p) + edge;
        c->overlap = left*l;
        c->slope = l/(h + edge);
        demi_persistent_odd(c)->outset = demi_scale(c->arm_a, left);
    }
}
