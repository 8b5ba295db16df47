/* ---------------------------------------------------------------------------------------------
   >>distances
   Distance of a point or sphere from one element of a wall, in the frame of the wall: one function
   for each kind of wall. Contact detection uses them to find candidates, fills and feeds to stay
   clear of walls, and >>touch to find contact points. Uses the geometry of walls only; writes
   nothing.
   --------------------------------------------------------------------------------------------- */

/* Returns the point of the segment from a (corner k) to b (corner l) that is nearest to the origin.
   *where: 1 + k inside the segment, 4 + k or 4 + l at a corner. Rounding may choose either side of
   a border; this moves the point by no more than the rounding. */
DEM_INLINE dem_vec3 demi_side_point(dem_vec3 a, dem_vec3 b, int k, int l, int *where) {
    const dem_vec3 ab = demi_sub(b, a);
    const dem_real t = -demi_dot(a, ab), ll = demi_dot(ab, ab);
    *where = t <= 0 ? 4 + k : t >= ll ? 4 + l : 1 + k;
    return t <= 0 ? a : t >= ll ? b : demi_add(a, demi_scale(ab, t/ll));
}
/* Returns the nearest point of a triangle so thin that it has no plane: that of its nearest
   side. */
static dem_vec3 demi_sides_point(const dem_vec3 *y, int *where) {
    dem_vec3 best = demi_side_point(y[0], y[1], 0, 1, where), d;
    int k, at;
    for (k = 1; k < 3; k++) {
        d = demi_side_point(y[k], y[(k + 1)%3], k, (k + 1)%3, &at);
        if (!(demi_dot(d, d) < demi_dot(best, best))) continue;
        best = d;
        *where = at;
    }
    return best;
}
/* Returns the point of a segment (n = 2) or triangle (n = 3) nearest to the origin [ERI05, 5.1.5].
   *where: 0 inside, 1 .. 3 on a side, 4 .. 6 at a corner. */
DEM_INLINE dem_vec3 demi_facet_point(const dem_vec3 *y, int n, int *where) {
    dem_vec3 ab, ac, normal;
    dem_real d1, d2, d3, d4, d5, d6, nn;
    if (n == 2) {
        const dem_vec3 p = demi_side_point(y[0], y[1], 0, 1, where);
        if (*where != 1) return p;
        *where = 0;                             /* in the plane: exactly along the normal */
        ab = demi_sub(y[1], y[0]);
        if (y[0].z < 0 || y[0].z > 0 || ab.z < 0 || ab.z > 0) return p;
        normal = demi_v(-ab.y, ab.x, 0);
        return demi_scale(normal, demi_dot(normal, y[0])/demi_dot(ab, ab));
    }
    ab = demi_sub(y[1], y[0]);
    ac = demi_sub(y[2], y[0]);
    d1 = -demi_dot(ab, y[0]); d2 = -demi_dot(ac, y[0]);
    if (d1 <= 0 && d2 <= 0) { *where = 4; return y[0]; }
    d3 = -demi_dot(ab, y[1]); d4 = -demi_dot(ac, y[1]);
    if (d3 >= 0 && d4 <= d3) { *where = 5; return y[1]; }
    d5 = -demi_dot(ab, y[2]); d6 = -demi_dot(ac, y[2]);
    if (d6 >= 0 && d5 <= d6) { *where = 6; return y[2]; }
    if (d1*d4 - d3*d2 <= 0 && d1 >= 0 && d3 <= 0) return demi_side_point(y[0], y[1], 0, 1, where);
    if (d5*d2 - d1*d6 <= 0 && d2 >= 0 && d6 <= 0) return demi_side_point(y[2], y[0], 2, 0, where);
    if (d3*d6 - d5*d4 <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return demi_side_point(y[1], y[2], 1, 2, where);
    *where = 0;                                 /* along the normal, exact for any size */
    normal = demi_cross(ab, ac);
    nn = demi_dot(normal, normal);
    if (!(nn > (DEMI_SINGLE ? DEM_R(1e-10) : DEM_R(1e-20))*demi_dot(ab, ab)*demi_dot(ac, ac)))
        return demi_sides_point(y, where);
    return demi_scale(normal, demi_dot(normal, y[0])/nn);
}

/* A vector in the measure in which the ellipsoid is the unit sphere. */
DEM_INLINE dem_vec3 demi_in_measure(const demi_part *part, dem_vec3 v) {
    v = dem_quat_unrotate(part->q, v);
    return demi_v(v.x/part->axes.x, v.y/part->axes.y, v.z/part->axes.z);
}
/* Corners of an element relative to a body at x, in the body's measure if `part` (an ellipsoid) is
   not null. Segments are infinite along z: only components across z count. */
DEM_INLINE int demi_facet_seen(const demi_wall *wall, int element, dem_vec3 x,
                               const demi_part *part, dem_vec3 *y) {
    const int n = demi_wall_corners(wall, element, y);
    int k;
    for (k = 0; k < n; k++) {
        y[k] = demi_sub(y[k], x);
        if (n == 2) y[k].z = 0;
        if (part) y[k] = demi_in_measure(part, y[k]);
    }
    if (n == 2 && part) {
        const dem_vec3 u = demi_unit(demi_in_measure(part, demi_v(0, 0, 1)));
        for (k = 0; k < 2; k++) y[k] = demi_sub(y[k], demi_scale(u, demi_dot(y[k], u)));
    }
    return n;
}

/* Half the thickness of a sieve, m. */
static dem_real demi_sieve_half(const dem_sieve_desc *s) {
    return (demi_sieve_wires(s) ? s->bar + s->lift : s->thickness)/2;
}

/* Returns the squared distance, m2, of (x.x, x.y) from the centre of the nearest round hole. at:
   its numbers along both axes; *other: 1 if it is one of those between the rows. */
static dem_real demi_round_hole(const dem_sieve_desc *s, dem_vec3 x, dem_vec3 *centre, double *at,
                                int *other) {
    const dem_real pitch = s->aperture + s->bar;
    const dem_real rows = s->staggered ? pitch*DEM_R(1.7320508075688772) : pitch;
    dem_real best = -1, l;
    int k;
    for (k = 0; k < 1 + (s->staggered != 0); k++) {    /* the nearest hole of either lattice */
        const dem_real shift = k ? DEM_R(0.5) : DEM_R(0);
        const double ix = floor((double)(x.x/pitch - shift) + 0.5);
        const double iy = floor((double)(x.y/rows - shift) + 0.5);
        const dem_vec3 c = demi_v(((dem_real)ix + shift)*pitch, ((dem_real)iy + shift)*rows, 0);
        l = (x.x - c.x)*(x.x - c.x) + (x.y - c.y)*(x.y - c.y);
        if (best >= 0 && l >= best) continue;
        best = l;
        *centre = c;
        at[0] = ix;
        at[1] = iy;
        *other = k;
    }
    return best;
}
/* True if x, in the plane of a plate, is in a hole or beyond the disc. */
static int demi_plate_open(const dem_sieve_desc *s, dem_vec3 x) {
    const dem_real wide = s->kind == DEM_SIEVE_SLOTS ? s->length : s->aperture;
    const dem_real a = wide + s->bar, b = s->aperture + s->bar;
    dem_vec3 c;
    double at[2];
    int other;
    if (s->radius > 0 && x.x*x.x + x.y*x.y > s->radius*s->radius) return 1;
    if (s->kind == DEM_SIEVE_ROUND)
        return demi_round_hole(s, x, &c, at, &other) < s->aperture*s->aperture/4;
    c.x = x.x - (dem_real)floor((double)(x.x/a) + 0.5)*a;
    c.y = x.y - (dem_real)floor((double)(x.y/b) + 0.5)*b;
    return (!(wide > 0) || DEMI_ABS(c.x) < wide/2) && DEMI_ABS(c.y) < s->aperture/2;
}
/* True if the segment from x to x + to crosses a surface of revolution. With radius r and height z,
   the piece from (R, H) to (R + e, H + f) is on the cone f r = e (z - H) + f R. Squared, that is a
   quadratic equation for the fraction of the segment; it includes the cone's other half. */
static int demi_revolved_crossed(const demi_wall *wall, dem_vec3 x, dem_vec3 to) {
    const double A = (double)(to.x*to.x + to.y*to.y), B = (double)(x.x*to.x + x.y*to.y);
    const double C = (double)(x.x*x.x + x.y*x.y);
    int i, k;
    for (k = 0; k + 1 < wall->ring_count; k++) {
        const double R = (double)wall->ring_radius[k], H = (double)wall->ring_height[k];
        const double e = (double)wall->ring_radius[k + 1] - R;
        const double f = (double)wall->ring_height[k + 1] - H, size = e*e + f*f;
        const double u = e*((double)x.z - H) + f*R, v = e*(double)to.z;
        const double a = f*f*A - v*v, b = f*f*B - u*v, c = f*f*C - u*u, root = b*b - a*c;
        double q, t, r, along;
        if (root < -1e-12*b*b) continue;        /* a flat piece has a double root */
        q = -b - (b < 0 ? -1 : 1)*sqrt(DEMI_MAX(root, 0));
        for (i = 0; i < 2; i++) {
            t = i ? c/q : q/a;
            if (!(t >= 0 && t <= 1)) continue;
            r = sqrt(DEMI_MAX(C + t*(2*B + t*A), 0));
            along = (r - R)*e + ((double)x.z + t*(double)to.z - H)*f;
            if (along > -1e-6*size && along < (1 + 1e-6)*size &&
                f*(u + v*t) > -1e-9*size*(r + R)) return 1;
        }
    }
    return 0;
}
/* True if the segment from x to x + to, in the frame of a wall, crosses it: a surface of revolution
   or a plate without thickness. */
static int demi_round_crossed(const demi_wall *wall, dem_vec3 x, dem_vec3 to) {
    if (wall->kind == DEMI_WALL_REVOLVED) return demi_revolved_crossed(wall, x, to);
    if ((x.z > 0) == (x.z + to.z > 0)) return 0;
    return !demi_plate_open(&wall->sieve, demi_sub(x, demi_scale(to, x.z/to.z)));
}

/* --- one sphere against one element, in the frame of the wall: sets normal (grain -> wall) and
   point, and returns the overlap, m (negative: apart). The search for candidates uses these too.
   --- */
typedef dem_real (*demi_near_fn)(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                 dem_vec3 *normal, dem_vec3 *point);
/* z = 0 of the frame of the wall, grains above. */
DEM_INLINE dem_real demi_plane_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                dem_vec3 *normal, dem_vec3 *point) {
    (void)wall; (void)element;
    *normal = demi_v(0, 0, -1);
    *point = demi_v(x.x, x.y, 0);
    return r - x.z;
}
/* About z. A grain on the axis is arbitrarily pushed along x. */
DEM_INLINE dem_real demi_cylinder_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                   dem_vec3 *normal, dem_vec3 *point) {
    const dem_real l = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_vec3 d = l > 0 ? demi_v(x.x/l, x.y/l, 0) : demi_v(1, 0, 0);
    (void)element;
    *point = demi_v(d.x*wall->radius, d.y*wall->radius, x.z);
    *normal = wall->inside ? d : demi_scale(d, -1);
    return wall->inside ? r + l - wall->radius : r + wall->radius - l;
}
/* Distance, m, of a point (`out` from the axis, at a height) from piece k of a surface of
   revolution. *r, *h receive the nearest point of the piece, *end whether that is its first end
   (-1), its last (1) or between (0). */
static dem_real demi_ring_piece(const demi_wall *wall, int k, dem_real out, dem_real height,
                                dem_real *r, dem_real *h, int *end) {
    const dem_real *R = wall->ring_radius + k, *H = wall->ring_height + k;
    const dem_real a = R[1] - R[0], b = H[1] - H[0];
    const dem_real t = ((out - R[0])*a + (height - H[0])*b)/(a*a + b*b);
    *end = t <= 0 ? -1 : t >= 1 ? 1 : 0;
    *r = *end < 0 ? R[0] : *end ? R[1] : R[0] + t*a;
    *h = *end < 0 ? H[0] : *end ? H[1] : H[0] + t*b;
    return DEMI_SQRT((out - *r)*(out - *r) + (height - *h)*(height - *h));
}
/* The nearest point of all pieces of a surface of revolution. */
static dem_real demi_revolved_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                   dem_vec3 *normal, dem_vec3 *point) {
    const dem_real l = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_vec3 d = l > 0 ? demi_v(x.x/l, x.y/l, 0) : demi_v(1, 0, 0);
    dem_real least = 0, a, b;
    int k, end;
    (void)element;
    for (k = 0; k + 1 < wall->ring_count; k++) {
        const dem_real dist = demi_ring_piece(wall, k, l, x.z, &a, &b, &end);
        if (k && !(dist < least)) continue;
        least = dist;
        *point = demi_v(d.x*a, d.y*a, b);
    }
    *normal = demi_sub(*point, x);
    *normal = least > 0 ? demi_scale(*normal, 1/least) : d;
    return r - least;
}
/* The plate that a sieve lies in, with or without holes. */
static dem_real demi_sieve_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                dem_vec3 *normal, dem_vec3 *point) {
    dem_real l = DEMI_ABS(x.z) - demi_sieve_half(&wall->sieve);
    (void)element;
    if (wall->radius > 0)                       /* ends of wires project from it */
        l = DEMI_MAX(l, DEMI_SQRT(x.x*x.x + x.y*x.y) - wall->radius - wall->sieve.bar/2);
    *normal = demi_v(0, 0, x.z > 0 ? DEM_R(-1) : DEM_R(1));
    *point = demi_v(x.x, x.y, 0);
    return r - l;
}
/* Overlap, m, with a point at d from the centre; reach: the radii of both. */
DEM_INLINE dem_real demi_point_near(dem_vec3 d, dem_real reach, dem_vec3 *normal) {
    const dem_real l = demi_length(d);
    *normal = l > 0 ? demi_scale(d, 1/l) : demi_v(0, 0, -1);
    return reach - l;
}
static dem_real demi_facet_distance(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                    dem_vec3 *normal, dem_vec3 *point) {
    dem_vec3 c[3], d;
    int where;
    d = demi_facet_point(c, demi_facet_seen(wall, element, x, 0, c), &where);
    *point = demi_add(x, d);
    return demi_point_near(d, r, normal);
}
static dem_real demi_grain_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                dem_vec3 *normal, dem_vec3 *point) {
    *point = demi_at(wall->vertices + 3*element);
    return demi_point_near(demi_sub(*point, x), r + wall->radius, normal);
}
#define DEMI_WALL_NEAR(KIND, C, M, T, N, NEAR, TOUCH, BEND, TESS) NEAR,
static const demi_near_fn demi_nears[] = {0, DEMI_WALLS(DEMI_WALL_NEAR)};

/* Distance, m, from a point to an element. If it is `enough` or more it need not be exact: a
   triangle whose plane is too far away is rejected at once. */
static dem_real demi_wall_distance(const demi_wall *wall, int element, dem_vec3 local,
                                   dem_real enough) {
    dem_vec3 n, p;
    if (demi_wall_per(wall) == 3) {
        dem_vec3 c[3];
        dem_real h;
        demi_wall_corners(wall, element, c);
        n = demi_cross(demi_sub(c[1], c[0]), demi_sub(c[2], c[0]));
        h = demi_dot(n, demi_sub(local, c[0]));
        if (h*h >= enough*enough*demi_dot(n, n) && demi_dot(n, n) > 0) return enough;
    }
    return -demi_nears[wall->kind](wall, element, local, 0, &n, &p);
}
/* True if x, in the frame of a tessellation, is behind a wall that acts on one side. *normal: from
   there into the wall. */
static int demi_tessellation_beyond(const dem_world *w, const demi_wall *surface, dem_vec3 x,
                                    dem_vec3 *normal) {
    const demi_wall *wall = surface->scale ? &w->walls[surface->lead] : surface;
    dem_vec3 p;
    return surface->scale && demi_wall_is(wall, DEMI_SMOOTH) &&
        demi_nears[wall->kind](wall, 0, x, 0, normal, &p) > 0;
}
