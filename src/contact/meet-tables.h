/* ---------------------------------------------------------------------------------------------
   >>meet-tables
   Tables that select a function by the kinds of two parts, or of a part and a wall. After them,
   functions that write the overlap, arm and radius of contacts with walls, whose points >>touch has
   found. Owns nothing, and writes only the contacts that it is given.
   --------------------------------------------------------------------------------------------- */
/* The functions by kind of wall and kind of part. */
#define DEMI_WALL_TOUCH(KIND, C, M, T, N, NEAR, TOUCH, BEND, TESS) DEMI_LIST TOUCH,
static const demi_touch_fn demi_touches[][DEMI_SHAPE_KINDS] = {{0}, DEMI_WALLS(DEMI_WALL_TOUCH)};
/* The function for two kinds of parts; the table is indexed by the higher kind first. */
#define DEMI_SHAPE_MEET(KIND, NAME, WORD, GAP, TOUCH) DEMI_LIST TOUCH,
static const demi_meet_fn demi_meets[][DEMI_SHAPE_KINDS] = {DEMI_SHAPES(DEMI_SHAPE_MEET)};
DEM_INLINE demi_meet_fn demi_meet_of(int kind, int other) {
    return demi_meets[DEMI_MAX(kind, other)][DEMI_MIN(kind, other)];
}

/* --- overlap, arm and radius of a part's contact with a wall, from a contact point that was found
   --- */
typedef void (*demi_on_wall_fn)(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                const demi_touching *place, demi_persistent *c);
/* A sphere's. */
DEM_INLINE void demi_ball_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                  const demi_touching *place, demi_persistent *c) {
    (void)w; (void)wall;
    c->overlap = place->overlap;
    c->deep = c->overlap/p->radius;
    c->r_eff = p->radius;
    c->arm_a = demi_add(p->centre, demi_scale(c->normal, p->radius));
}
/* An ellipsoid's. place->overlap is 1 - W0, see dem_overlap. */
static void demi_ellipsoid_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                   const demi_touching *place, demi_persistent *c) {
    demi_ellipsoid_overlap(w, p, place->overlap,
                           demi_wall_is(wall, DEMI_BALLS) ? wall->radius : DEM_R(0), c);
    c->arm_a = demi_add(p->centre, c->arm_a);
}
/* A polyhedron's. R* is the radius of the sphere of equal volume; against a wall of grains it is
   set so large that demi_wall_r_eff returns the radius of these grains. */
static void demi_polyhedron_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                    const demi_touching *place, demi_persistent *c) {
    const int ball = demi_wall_is(wall, DEMI_BALLS);
    c->overlap = place->overlap;
    c->deep = place->deep;
    c->slope = place->slope;
    c->corner = place->corner;
    c->corners = place->corners;
    demi_persistent_odd(c)->couple = place->couple;
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
