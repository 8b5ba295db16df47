/* ---------------------------------------------------------------------------------------------
   >>meets-polyhedra
   Narrow phase of a polyhedron and another body: a sphere or an ellipsoid at the nearest point, two
   polyhedra by their common volume (>>polyhedra) or their gaps (>>gaps). Owns nothing, and writes
   only the contacts that it is given.
   --------------------------------------------------------------------------------------------- */
/* A sphere and a polyhedron, at the nearest point; R* is the sphere's radius, as on a plane. */
static int demi_solid_ball_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                 dem_vec3 gap, demi_persistent *c) {
    const int first = p->kind == DEMI_BALL;
    const demi_part *ball = first ? p : q;
    demi_d3 at;
    double off;
    demi_solid s;
    demi_solid_of(first ? q : p, first ? gap : demi_scale(gap, -1), &s);
    off = demi_solid_near(&s, demi_d(0, 0, 0), &at);
    c->overlap = ball->radius - (dem_real)off;
    if (!(c->overlap > -demi_range(w, p->radius + q->radius))) return 0;
    c->normal = demi_d3_real(at);
    c->normal = off > 0 || off < 0 ? demi_scale(c->normal, (dem_real)(1/off)) : demi_unit(gap);
    c->deep = c->overlap/ball->radius;
    c->r_eff = ball->radius;
    c->arm_a = demi_d3_real(at);
    if (!first) {
        c->normal = demi_scale(c->normal, -1);
        c->arm_a = demi_add(c->arm_a, gap);
    }
    return 1;
}
/* An ellipsoid and a polyhedron, as with walls: at the point that the ellipsoid touches first when
   it is scaled, by W0. */
static int demi_solid_ellipsoid_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                dem_vec3 gap, demi_persistent *c) {
    const int first = p->kind == DEMI_ELLIPSOID;
    const demi_part *ellipsoid = first ? p : q;
    dem_vec3 at, n;
    demi_d3 near;
    double W0;
    demi_solid s;
    demi_solid_measure(first ? q : p, ellipsoid, first ? gap : demi_scale(gap, -1), &s);
    W0 = demi_solid_near(&s, demi_d(0, 0, 0), &near);
    if (!(W0 < 1 + (double)demi_range(w, p->radius + q->radius)/(double)demi_part_thin(ellipsoid)))
        return 0;
    at = demi_d3_real(near);
    n = demi_v(at.x/ellipsoid->axes.x, at.y/ellipsoid->axes.y, at.z/ellipsoid->axes.z);
    at = demi_v(at.x*ellipsoid->axes.x, at.y*ellipsoid->axes.y, at.z*ellipsoid->axes.z);
    if (W0 > 1 && !((double)demi_length(at)*(1 - 1/W0) <
                    (double)demi_range(w, p->radius + q->radius))) return 0;
    c->normal = demi_unit(dem_quat_rotate(ellipsoid->q, W0 < 0 ? demi_scale(n, -1) : n));
    demi_ellipsoid_overlap(w, ellipsoid, (dem_real)(1 - W0), 0, c);
    /* the force passes through the polyhedron's point */
    c->arm_a = dem_quat_rotate(ellipsoid->q, at);
    demi_persistent_odd(c)->outset = demi_v(0, 0, 0);
    if (!first) {
        c->normal = demi_scale(c->normal, -1);
        c->arm_a = demi_add(c->arm_a, gap);
    }
    return 1;
}
static int demi_solid_round_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                  dem_vec3 gap, double lambda, demi_persistent *c,
                                  demi_spots *spots) {
    const int ball = p->kind == DEMI_BALL || q->kind == DEMI_BALL;
    (void)lambda; (void)spots;
    if (!(ball ? demi_solid_ball_touch : demi_solid_ellipsoid_touch)(w, p, q, gap, c)) return 0;
    c->arm_a = demi_add(c->arm_a, p->centre);
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* Two polyhedra by the points of least gap: always with impulses; with springs only for a law with
   a range, while there is no overlap. Then the nearest point is repeated four times, since contact
   by pressure has four points. */
static int demi_polyhedra_near(const dem_world *w, const demi_part *p, const demi_part *q,
                               dem_vec3 gap, demi_persistent *c, demi_spots *spots) {
    const double ra = demi_part_equal(p), rb = demi_part_equal(q);
    const double range = (double)demi_range(w, p->radius + q->radius);
    const dem_vec3 from = demi_dot(c->normal, c->normal) > 0 ? c->normal : gap;
    demi_simplex tells;
    demi_solid a, b;
    double least;
    int k, nearest;
    demi_solid_of(p, demi_v(0, 0, 0), &a);
    demi_solid_of(q, gap, &b);
    if (!demi_solids_spots(&a, &b, 0, range, demi_d3_of(from), &tells, spots)) return 0;
    c->normal = demi_d3_real(spots->normal);
    c->r_eff = (dem_real)(ra*rb/(ra + rb));
    c->arm_a = p->centre;
    c->arm_b = demi_sub(p->centre, demi_sub(demi_add(p->centre, gap), q->centre));
    if (!demi_response_is(w, DEMI_PRESSING)) return 1;
    nearest = demi_spots_nearest(spots->x, spots->gap, spots->count, 1e-3*DEMI_MIN(ra, rb));
    least = spots->gap[nearest];
    for (k = 0; k < 4; k++) {
        spots->x[k] = spots->x[nearest];
        spots->gap[k] = DEMI_MAX(least, 0);     /* below 0 by rounding: they touch */
    }
    spots->count = 4;
    return least > -DEMI_TOUCHING*(ra + rb);
}
/* A polyhedron and a fixed one that has faces in common with others (o): by its pressure on their
   common surface. c becomes the first of four contact points, which have this body's part of the
   force. */
static int demi_flush_meet(const dem_world *w, const demi_flush_pair *o, const demi_part *p,
                           const demi_part *q, dem_vec3 gap, demi_persistent *c,
                           demi_spots *spots) {
    const double r = demi_part_equal(o->part);
    demi_flush_press press;
    demi_persistent_more *more;
    demi_patch at;
    double overlap;
    if (demi_face_keeps(p, q, gap) || demi_face_keeps(q, p, demi_scale(gap, -1)) ||
        !demi_flush_pressed(w, o, &press) || !demi_pressure_patch(&press.own, &o->part->q, 0, &at))
        return w->margin.reach > 0 && demi_polyhedra_near(w, p, q, gap, c, spots);
    overlap = demi_shared_overlap(press.shared, r);
    c->normal = o->first ? demi_scale(at.normal, -1) : at.normal;
    c->overlap = (dem_real)overlap;
    c->slope = (dem_real)demi_shared_slope(press.force, r, overlap);
    c->deep = (dem_real)press.own.deep;
    c->share = (dem_real)(at.force/press.force);
    c->r_eff = (dem_real)r;
    c->corners = 4;
    more = demi_persistent_odd(c);
    more->part = c->share;
    more->couple = at.couple;
    more->spread = at.spread[0];
    more->aside = demi_scale(at.spread[1], o->first ? DEM_R(-1) : DEM_R(1));
    c->arm_a = demi_add(p->centre, o->first ? demi_add(gap, at.point) : at.point);
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* Two polyhedra by their common volume. c becomes the first of four contact points. */
static int demi_polyhedra_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                dem_vec3 gap, double lambda, demi_persistent *c,
                                demi_spots *spots) {
    const double ra = demi_part_equal(p), rb = demi_part_equal(q), r_eff = ra*rb/(ra + rb);
    demi_solid a, b;
    demi_patch at;
    demi_persistent_more *more;
    demi_pressure s;
    double overlap;
    (void)lambda;
    if (w->flush.count && demi_response_is(w, DEMI_PRESSING)) {
        const demi_flush_pair o = demi_flush_pair_of(w, c, p, q);
        if (o.row && demi_flush_faced(w, o.row))
            return demi_flush_meet(w, &o, p, q, gap, c, spots);
    }
    if (!demi_response_is(w, DEMI_PRESSING) || demi_face_keeps(p, q, gap) ||
        demi_face_keeps(q, p, demi_scale(gap, -1)))
        return w->margin.reach > 0 && demi_polyhedra_near(w, p, q, gap, c, spots);
    demi_solid_of(p, demi_v(0, 0, 0), &a);
    demi_solid_of(q, gap, &b);
    overlap = (w->desc.planar ? demi_prisms_press : demi_solids_press)(&a, &b, &s) &&
        demi_pressure_patch(&s, &p->q, &q->q, &at) ? demi_shared_overlap(s.shared, r_eff) : 0;
    if (!(overlap > 0)) return w->margin.reach > 0 && demi_polyhedra_near(w, p, q, gap, c, spots);
    c->normal = at.normal;
    c->overlap = (dem_real)overlap;
    c->slope = (dem_real)demi_shared_slope(at.force, r_eff, overlap);
    c->deep = (dem_real)s.deep;
    c->r_eff = (dem_real)r_eff;
    c->corners = 4;
    more = demi_persistent_odd(c);
    more->couple = at.couple;
    more->spread = at.spread[0];
    more->aside = at.spread[1];    /* until demi_persistent_spread */
    c->arm_a = demi_add(p->centre, at.point);
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
