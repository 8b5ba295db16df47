/* ---------------------------------------------------------------------------------------------
   >>meets
   Narrow phase for parts of two bodies: geometry only, into a contact that >>kept has begun.
   Spheres use their centres, ellipsoids the contact point of Perram and Wertheim [PW85], two
   polyhedra their common volume (>>polyhedra) or their gaps (>>gaps), and unlike parts the nearest
   point. A table selects the function by the kinds of the parts. At the end of this part, functions
   write the overlap, arm and radius of contacts with walls, whose points >>touch has found. Owns
   nothing, and writes only the contacts that it is given.
   --------------------------------------------------------------------------------------------- */

/* --- Each function returns 1 if two parts touch, and writes the geometry to c. gap: m, from p's
   centre to q's; lambda: a start value, 0: unknown. spots: set if the contact has several points,
   each with its own gap, relative to p's centre; otherwise its count stays 0. --- */
typedef int (*demi_meet_fn)(const dem_world *w, const demi_part *p, const demi_part *q,
                            dem_vec3 gap, double lambda, demi_kept *c, demi_spots *spots);
/* Two spheres of radii r and s, at x and y from the centres of their bodies. The contact point
   divides their distance in the ratio of the radii. */
DEM_INLINE int demi_balls_meet(const dem_world *w, dem_vec3 x, dem_real r, dem_vec3 y, dem_real s,
                               dem_vec3 gap, demi_kept *c) {
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
                            dem_vec3 gap, double lambda, demi_kept *c,
                            demi_spots *spots) {
    (void)lambda; (void)spots;
    return demi_balls_meet(w, p->centre, p->radius, q->centre, q->radius, gap, c);
}
/* Writes the contact of two ellipsoids, row k of a tile, to c, except for its arms; one of them may
   be a sphere. p, q: the two; not read if the overlap is the conservative one. */
DEM_INLINE void demi_eggs_set(const dem_world *w, demi_egg_tile *t, int k, const demi_part *p,
                              const demi_part *q, demi_kept *c) {
    c->lambda = t->to[k];
    c->normal = demi_d3_real(demi_eggs_at(t->normal, k));
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
            ? demi_eggs_chord(t, k) : (1 - t->w0[k])*both);
    }
}
static int demi_ellipsoids_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                 dem_vec3 gap, double lambda, demi_kept *c,
                                 demi_spots *spots) {
    demi_egg_tile t;
    dem_real thin = demi_egg_put(&t, 0, 0, p->q, demi_part_axes(p));
    (void)spots;
    thin += demi_egg_put(&t, 0, 1, q->q, demi_part_axes(q));
    t.equal[0][0] = demi_part_equal(p);
    t.equal[1][0] = demi_part_equal(q);
    demi_eggs_row(&t, 0, gap, lambda, (double)demi_range(w, p->radius + q->radius), thin);
    demi_eggs_solve_one(&t, 0);
    if (!demi_eggs_meet(&t, 0)) return 0;
    demi_eggs_set(w, &t, 0, p, q, c);
    c->arm_a = demi_add(p->centre, demi_d3_real(demi_eggs_at(t.point, 0)));
    /* to the same point, exactly: conserves angular momentum */
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* Sets overlap and arm of an ellipsoid at its normal, from left = 1 - W0: with a plane or a
   polyhedron (edge 0) or a grain of a wall (edge: its radius). As for two ellipsoids, the overlap
   is l (1 - W0), where l includes `edge`, or is measured along the normal. The arm leads to the
   deepest point, as for a sphere. The gradient of l (1 - W0) passes through the point of the wall,
   at W0 times the arm. */
static void demi_egg_overlap(const dem_world *w, const demi_part *p, dem_real left, dem_real edge,
                             demi_kept *c) {
    const dem_real h = demi_ellipsoid_arm(p, c->normal, &c->arm_a);
    c->overlap = left*(h + edge);
    c->deep = c->overlap/h;
    c->r_eff = (dem_real)demi_part_round(w, p, (double)h);
    if (w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE) {
        const dem_real l = (dem_real)demi_part_equal(p) + edge;
        c->overlap = left*l;
        c->slope = l/(h + edge);
        demi_kept_odd(c)->inset = 1 - left;
    }
}
/* A sphere and a polyhedron, at the nearest point; R* is the sphere's radius, as on a plane. */
static int demi_solid_ball_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                 dem_vec3 gap, demi_kept *c) {
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
    c->normal = off > 0 || off < 0 ? demi_scale(c->normal, (dem_real)(1/off))
                                   : demi_unit(gap);
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
static int demi_solid_egg_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                dem_vec3 gap, demi_kept *c) {
    const int first = p->kind == DEMI_ELLIPSOID;
    const demi_part *egg = first ? p : q;
    dem_vec3 at, n;
    demi_d3 near;
    double W0;
    demi_solid s;
    demi_solid_measure(first ? q : p, egg, first ? gap : demi_scale(gap, -1), &s);
    W0 = demi_solid_near(&s, demi_d(0, 0, 0), &near);
    if (!(W0 < 1 + (double)demi_range(w, p->radius + q->radius)/(double)demi_part_thin(egg)))
        return 0;
    at = demi_d3_real(near);
    n = demi_v(at.x/egg->axes.x, at.y/egg->axes.y, at.z/egg->axes.z);
    at = demi_v(at.x*egg->axes.x, at.y*egg->axes.y, at.z*egg->axes.z);
    if (W0 > 1 && !((double)demi_length(at)*(1 - 1/W0) <
                    (double)demi_range(w, p->radius + q->radius))) return 0;
    c->normal = demi_unit(dem_quat_rotate(egg->q, demi_scale(n, W0 < 0 ? DEM_R(-1) : DEM_R(1))));
    demi_egg_overlap(w, egg, (dem_real)(1 - W0), 0, c);
    /* the force passes through the polyhedron's point */
    c->arm_a = dem_quat_rotate(egg->q, at);
    demi_kept_odd(c)->inset = 1;
    if (!first) {
        c->normal = demi_scale(c->normal, -1);
        c->arm_a = demi_add(c->arm_a, gap);
    }
    return 1;
}
static int demi_solid_round_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                  dem_vec3 gap, double lambda, demi_kept *c, demi_spots *spots) {
    const int ball = p->kind == DEMI_BALL || q->kind == DEMI_BALL;
    (void)lambda; (void)spots;
    if (!(ball ? demi_solid_ball_touch : demi_solid_egg_touch)(w, p, q, gap, c)) return 0;
    c->arm_a = demi_add(c->arm_a, p->centre);
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* Two polyhedra by the points of least gap: always with impulses; with springs only for a law with
   a range, while there is no overlap. Then the nearest point is repeated four times, since contact
   by pressure has four points. */
static int demi_polyhedra_near(const dem_world *w, const demi_part *p, const demi_part *q,
                               dem_vec3 gap, demi_kept *c, demi_spots *spots) {
    const double ra = demi_part_equal(p), rb = demi_part_equal(q);
    const double range = (double)demi_range(w, p->radius + q->radius);
    const dem_vec3 from = demi_dot(c->normal, c->normal) > 0 ? c->normal : gap;
    demi_simplex tells;
    demi_solid a, b;
    double least;
    int k, nearest = 0;
    demi_solid_of(p, demi_v(0, 0, 0), &a);
    demi_solid_of(q, gap, &b);
    if (!demi_solids_spots(&a, &b, 0, range, demi_d3_of(from), &tells, spots)) return 0;
    c->normal = demi_d3_real(spots->normal);
    c->r_eff = (dem_real)(ra*rb/(ra + rb));
    c->arm_a = p->centre;
    c->arm_b = demi_sub(p->centre, demi_sub(demi_add(p->centre, gap), q->centre));
    if (!demi_response_is(w, DEMI_PRESSING)) return 1;
    for (k = 1; k < spots->count; k++) if (spots->gap[k] < spots->gap[nearest]) nearest = k;
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
                           const demi_part *q, dem_vec3 gap, demi_kept *c, demi_spots *spots) {
    const double r = demi_part_equal(o->part);
    demi_flush_press press;
    demi_kept_more *more;
    demi_patch at;
    double overlap;
    if (demi_face_keeps(p, q, gap) || demi_face_keeps(q, p, demi_scale(gap, -1)) ||
        !demi_flush_pressed(w, o, &press) ||
        !demi_pressure_patch(&press.own, &o->part->q, 0, &at))
        return w->margin.reach > 0 && demi_polyhedra_near(w, p, q, gap, c, spots);
    overlap = demi_shared_overlap(press.shared, r);
    c->normal = o->first ? demi_scale(at.normal, -1) : at.normal;
    c->overlap = (dem_real)overlap;
    c->slope = (dem_real)demi_shared_slope(press.force, r, overlap);
    c->deep = (dem_real)press.own.deep;
    c->share = (dem_real)(at.force/press.force);
    c->r_eff = (dem_real)r;
    c->corners = 4;
    more = demi_kept_odd(c);
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
                                dem_vec3 gap, double lambda, demi_kept *c, demi_spots *spots) {
    const double ra = demi_part_equal(p), rb = demi_part_equal(q), r_eff = ra*rb/(ra + rb);
    demi_solid a, b;
    demi_patch at;
    demi_kept_more *more;
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
        demi_pressure_patch(&s, &p->q, &q->q, &at)
        ? demi_shared_overlap(s.shared, r_eff) : 0;
    if (!(overlap > 0)) return w->margin.reach > 0 && demi_polyhedra_near(w, p, q, gap, c, spots);
    c->normal = at.normal;
    c->overlap = (dem_real)overlap;
    c->slope = (dem_real)demi_shared_slope(at.force, r_eff, overlap);
    c->deep = (dem_real)s.deep;
    c->r_eff = (dem_real)r_eff;
    c->corners = 4;
    more = demi_kept_odd(c);
    more->couple = at.couple;
    more->spread = at.spread[0];
    more->aside = at.spread[1];    /* until demi_kept_spread */
    c->arm_a = demi_add(p->centre, at.point);
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* The function for two kinds of parts; the table is indexed by the higher kind first. */
#define DEMI_SHAPE_MEET(KIND, NAME, WORD, GAP, TOUCH) DEMI_LIST TOUCH,
static const demi_meet_fn demi_meets[][DEMI_SHAPE_KINDS] = {DEMI_SHAPES(DEMI_SHAPE_MEET)};
DEM_INLINE demi_meet_fn demi_meet_of(int kind, int other) {
    return demi_meets[DEMI_MAX(kind, other)][DEMI_MIN(kind, other)];
}

/* --- overlap, arm and radius of a part's contact with a wall, from a contact point that was found
   --- */
typedef void (*demi_on_wall_fn)(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                const demi_touching *place, demi_kept *c);
/* A sphere's. */
DEM_INLINE void demi_ball_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                  const demi_touching *place, demi_kept *c) {
    (void)w; (void)wall;
    c->overlap = place->overlap;
    c->deep = c->overlap/p->radius;
    c->r_eff = p->radius;
    c->arm_a = demi_add(p->centre, demi_scale(c->normal, p->radius));
}
/* An ellipsoid's. place->overlap is 1 - W0, see dem_overlap. */
static void demi_ellipsoid_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                   const demi_touching *place, demi_kept *c) {
    demi_egg_overlap(w, p, place->overlap, demi_wall_is(wall, DEMI_BALLS) ? wall->radius : DEM_R(0),
                     c);
}
/* A polyhedron's. R* is the radius of the sphere of equal volume; against a wall of grains it is
   set so large that demi_wall_r_eff returns the radius of these grains. */
static void demi_polyhedron_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                    const demi_touching *place, demi_kept *c) {
    const int ball = demi_wall_is(wall, DEMI_BALLS);
    c->overlap = place->overlap;
    c->deep = place->deep;
    c->slope = place->slope;
    c->corner = place->corner;
    c->corners = place->corners;
    demi_kept_odd(c)->couple = place->couple;
    c->more.spread = place->spread;
    if (place->part > 0) {
        c->wall = place->wall;
        c->more.part = place->part;
        c->more.rank = place->rank;
        c->more.lean = place->lean;
        c->more.turn = place->turn;
    }
    c->r_eff = ball ? DEM_R(1e30) : (dem_real)demi_part_equal(p);
    c->arm_a = demi_sub(place->point, demi_at(w->bodies.pos + 4*c->a));
}
#define DEMI_SHAPE_ON_WALL(KIND, NAME, WORD, GAP, TOUCH) demi_##NAME##_on_wall,
static const demi_on_wall_fn demi_on_walls[] = {DEMI_SHAPES(DEMI_SHAPE_ON_WALL)};
/* Effective radius R* [m] of a part of radius r with a wall. On a round wire of radius q the two
   principal radii of the contact differ: r and r q/(r + q). Their geometric mean gives a force 1.5
   % below that of Hertz's ellipse if the wire is as thick as the grain, and 7 % below for a wire a
   fifth as thick. */
static double demi_wall_r_eff(const demi_wall *wall, double r) {
    const double q = (double)wall->sieve.bar/2;
    if (demi_wall_is(wall, DEMI_BALLS)) return r*(double)wall->radius/(r + (double)wall->radius);
    return demi_sieve_wires(&wall->sieve) ? r*sqrt(q/(r + q)) : r;
}
