/* ---------------------------------------------------------------------------------------------
   >>polyhedra-round
   Polyhedra and curved pieces of walls in closed form. With springs, the pressure on wires and on
   the walls of round holes (>>polyhedra-sieves) is integrated along each line (generator) of a
   piece and summed over angles, in intervals where the integrand is smooth; they are bounded by
   edges, pyramids and faces that cross the piece or the rings at its ends. (Facets take 10 to 18
   times as long there. On cylinders and surfaces of revolution they take half the time:
   >>tessellate. Their cost grows with the number in reach: a cube of 10 mm that rests in the tip of
   a cone has 528 in reach and 12 contact points; in a tube of 60 mm it has 67 and 4, and a step
   takes an eighth of the time.)

   With impulses, the contact points are corners if a piece curves around the body, points of the
   plane along the nearest line if it curves away, and points of the rings at its ends. (Facets take
   2 to 570 times as long: least on cylinders, most on wires.)
   --------------------------------------------------------------------------------------------- */

/* A piece of a surface of revolution about z: its lines run from radius a to b and height g to h,
   m. side: 1 or -1, the side on which it acts. */
typedef struct demi_generator {
    double a, b, g, h, side;
    int open[2];                   /* 1: the surface ends there, or bends away */
} demi_generator;
/* Adds one line of a piece, at an angle and with a width in angle: the integral of u over the part
   inside the polyhedron. The pyramids divide it into sections on which u is linear. x0: of the
   centre. */
static void demi_generator_press(const demi_solid *s, const demi_generator *l, double angle,
                                 double width, demi_d3 x0, demi_pressure *out) {
    const double c = demi_cos(angle), sn = demi_sin(angle);
    const double out_by = l->b - l->a, up_by = l->h - l->g;
    const double size = sqrt(out_by*out_by + up_by*up_by), tilt = l->side*up_by/size;
    const demi_d3 e = demi_d(out_by*c, out_by*sn, up_by);
    const demi_d3 o = demi_d3_sub(demi_d(l->a*c, l->a*sn, l->g), x0);
    const demi_d3 n = demi_d(tilt*c, tilt*sn, -l->side*out_by/size);
    double lo = 0, hi = 1, from;
    int f, i, face = -1;
    for (f = 0; f < s->faces; f++) {            /* where it is inside */
        const double u = demi_solid_in(s, f, o), slope = -demi_d3_dot(s->face[f].slope, e);
        if (slope > 0) lo = DEMI_MAX(lo, -u/slope);
        else if (slope < 0) hi = DEMI_MIN(hi, -u/slope);
        else if (u < 0) return;
    }
    for (from = lo; from < hi; ) {
        double to = hi, least = 1e300, steep = 0;
        int next = -1;
        for (f = 0; f < s->faces && face < 0; f++) {    /* the face whose pyramid it begins in */
            const double slope = -demi_d3_dot(s->face[f].slope, e);
            const double u = demi_solid_in(s, f, o) + slope*from;
            if (u < least - 1e-12 || (u < least + 1e-12 && slope < steep)) {
                least = u; steep = slope; next = f;
            }
        }
        if (face < 0) face = next;
        next = -1;
        for (f = 0; f < s->faces; f++) {        /* until the next pyramid */
            const double slope = demi_d3_dot(s->face[face].slope, e) -
                demi_d3_dot(s->face[f].slope, e);
            const double over = demi_solid_in(s, f, o) - demi_solid_in(s, face, o);
            if (!(slope < 0)) continue;
            if (-over/slope > from && -over/slope < to) { to = -over/slope; next = f; }
        }
        for (i = 0; i < 3; i++) {
            const double t = from + demi_gauss3_at[i]*(to - from), r = l->a + t*out_by;
            const demi_d3 x = demi_d3_plus(o, t, e);
            demi_pressure_point(out, s, face, x, demi_gauss3[i]*(to - from)*size*r*width, n,
                                demi_d3_dot(x, n));
        }
        from = to;
        face = next;
        if (next < 0) break;
    }
}
/* Writes the angles at which the segment from p to q crosses the surface. Returns their number, 0
   to 2. */
static int demi_generator_cross(const demi_generator *l, demi_d3 p, demi_d3 q, double *angle) {
    const demi_d3 d = demi_d3_sub(q, p);
    const int level = !(l->h > l->g || l->h < l->g);
    const double flat = level ? 0 : (l->b - l->a)/(l->h - l->g);
    const double r0 = l->a + flat*(p.z - l->g), dr = flat*d.z;
    const double A = d.x*d.x + d.y*d.y - dr*dr, B = p.x*d.x + p.y*d.y - r0*dr;
    const double C = p.x*p.x + p.y*p.y - r0*r0, D = B*B - A*C;
    double t[2];
    int i, count = 0;
    if (level) {
        if ((p.z > l->g) == (q.z > l->g)) return 0;
        t[0] = (l->g - p.z)/d.z;
        *angle = demi_atan2(p.y + t[0]*d.y, p.x + t[0]*d.x);
        return 1;
    }
    if (!(D > 0)) return 0;
    t[0] = B > 0 ? (-B - sqrt(D))/A : C/(-B + sqrt(D));
    t[1] = B > 0 ? C/(-B - sqrt(D)) : (-B + sqrt(D))/A;
    for (i = 0; i < 2; i++)
        if (t[i] >= 0 && t[i] <= 1)
            angle[count++] = demi_atan2(p.y + t[i]*d.y, p.x + t[i]*d.x);
    return count;
}
/* True if the surface continues from a ring to the ring `to` into the wall, as seen from l's
   side. */
static int demi_ring_away(const demi_wall *wall, int ring, int to, const demi_generator *l) {
    const double out = (double)(wall->ring_radius[to] - wall->ring_radius[ring]);
    const double up = (double)(wall->ring_height[to] - wall->ring_height[ring]);
    return l->side*((l->h - l->g)*out - (l->b - l->a)*up) > 0;
}
/* Returns piece i of a wall, seen from this side. A cylinder is cut to the extent of a body of this
   radius about x. */
static demi_generator demi_generator_of(const demi_wall *wall, int i, dem_vec3 x, dem_real radius,
                                        double side) {
    demi_generator l;
    l.open[0] = l.open[1] = 0;
    if (wall->kind == DEMI_WALL_CYLINDER) {
        l.a = l.b = (double)wall->radius;
        l.g = (double)(x.z - radius);
        l.h = (double)(x.z + radius);
        l.side = wall->inside ? 1 : -1;
    } else {
        l.a = (double)wall->ring_radius[i];
        l.b = (double)wall->ring_radius[i + 1];
        l.g = (double)wall->ring_height[i];
        l.h = (double)wall->ring_height[i + 1];
        l.side = side;
        l.open[0] = i == 0 || demi_ring_away(wall, i, i - 1, &l);
        l.open[1] = i + 2 == wall->ring_count || demi_ring_away(wall, i + 1, i + 2, &l);
    }
    return l;
}
/* Distance from the axis, m. */
DEM_INLINE double demi_off_axis(demi_d3 x) { return sqrt(x.x*x.x + x.y*x.y); }
/* Squared distance of a point from a line in the (radius, height) plane. u, v: from the line's
   start to the point; e, f: from its start to its end. */
static double demi_line_off2(double u, double v, double e, double f) {
    double t = (u*e + v*f)/(e*e + f*f);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return (u - t*e)*(u - t*e) + (v - t*f)*(v - t*f);
}
/* The side of a surface of revolution on which x is: by the nearest piece or, if several are
   equally near, by the one whose infinite line is farthest away. */
static double demi_rings_side(const demi_wall *wall, demi_d3 x) {
    const double out = demi_off_axis(x);
    double least = 1e300, far = 0, side = 1;
    int i;
    for (i = 0; i + 1 < wall->ring_count; i++) {
        const double a = (double)wall->ring_radius[i], g = (double)wall->ring_height[i];
        const double e = (double)wall->ring_radius[i + 1] - a;
        const double f = (double)wall->ring_height[i + 1] - g;
        const double u = out - a, v = x.z - g, over = (v*e - u*f)/sqrt(e*e + f*f);
        const double d2 = demi_line_off2(u, v, e, f);
        if (d2 > least*(1 + 1e-9) || (d2 > least*(1 - 1e-9) && !(fabs(over) > fabs(far)))) continue;
        least = DEMI_MIN(least, d2);
        far = over;
        side = over > 0 ? 1 : -1;
    }
    return side;
}
/* True if a body of this radius about x reaches the piece. */
static int demi_generator_near(const demi_generator *l, demi_d3 x, double radius) {
    const double out = demi_off_axis(x);
    return demi_line_off2(out - l->a, x.z - l->g, l->b - l->a, l->h - l->g) < radius*radius;
}
/* True if x is behind the piece. n receives the direction into the wall. */
static int demi_generator_beyond(const demi_generator *l, demi_d3 x, demi_d3 *n) {
    const double out = demi_off_axis(x), e = l->b - l->a, f = l->h - l->g;
    const double size = sqrt(e*e + f*f), flat = l->side*f/size;
    *n = demi_d(flat*(out > 0 ? x.x/out : 1), flat*(out > 0 ? x.y/out : 0), -l->side*e/size);
    return l->side*((l->a - out)*f - (l->g - x.z)*e) < 0;
}
/* Radius of the surface at a height, m. */
static double demi_generator_radius(const demi_generator *l, double z) {
    return l->h > l->g || l->h < l->g ? l->a + (l->b - l->a)/(l->h - l->g)*(z - l->g) : l->a;
}
/* Writes the angles at which lines of the surface come into the plane of a face, at its lowest and
   highest corners. Returns their number, 0 to 4. */
static int demi_generator_face(const demi_generator *l, const demi_solid *s, int f, demi_d3 x0,
                               double *angle) {
    const demi_d3 a = s->face[f].slope;
    const double size = demi_off_axis(a);
    double z[2] = {1e300, -1e300};
    int i, count = 0;
    for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
        const double up = demi_solid_corner(s, f, i).z + x0.z;
        z[0] = DEMI_MIN(z[0], up);
        z[1] = DEMI_MAX(z[1], up);
    }
    for (i = 0; i < 2; i++) {
        const double to = size*demi_generator_radius(l, z[i]);
        const double c = 1 + a.x*x0.x + a.y*x0.y - a.z*(z[i] - x0.z);
        double half, mid;
        if (!(fabs(c) < to)) continue;
        mid = demi_atan2(a.y, a.x);
        half = demi_atan2(sqrt((to - c)*(to + c)), c);
        angle[count++] = mid - half;
        angle[count++] = mid + half;
    }
    return count;
}
/* Writes the angles at which a ring, where a piece ends, crosses a plane n.y = c (y from the
   centre) within the body. Returns their number, 0 to 2. */
static int demi_ring_cross(const demi_solid *s, double r, double z, demi_d3 n, double c,
                           demi_d3 x0, double *angle) {
    const double to = r*demi_off_axis(n);
    const double over = c + n.x*x0.x + n.y*x0.y - n.z*(z - x0.z);
    double mid, half;
    int i, f, count = 0;
    if (!(fabs(over) < to)) return 0;
    mid = demi_atan2(n.y, n.x);
    half = demi_atan2(sqrt((to - over)*(to + over)), over);
    for (i = -1; i < 2; i += 2) {
        const double at = mid + i*half;
        const demi_d3 y = demi_d3_sub(demi_d(r*demi_cos(at), r*demi_sin(at), z), x0);
        for (f = 0; f < s->faces && demi_solid_in(s, f, y) > -1e-9; f++) continue;
        if (f == s->faces) angle[count++] = at;
    }
    return count;
}
/* The same for all faces, and for the sides of the pyramids. radius: of the body. */
static int demi_generator_end(const demi_solid *s, double r, double z, demi_d3 x0, double radius,
                              double *angle) {
    const double off = demi_off_axis(x0) - r, up = x0.z - z;
    int f, i, count = 0;
    if (!(r > 0) || !(off*off + up*up < radius*radius)) return 0;
    for (f = 0; f < s->faces; f++) {
        count += demi_ring_cross(s, r, z, s->face[f].slope, 1, x0, angle + count);
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
            const int32_t a = demi_solid_number(s, f, i), b = demi_solid_number(s, f, i + 1);
            if (a > b) continue;
            count += demi_ring_cross(s, r, z, demi_d3_cross(s->corner[a], s->corner[b]), 0, x0,
                                     angle + count);
        }
    }
    return count;
}
/* Largest number of angles: edges and lines to corners, twice each; faces at two heights; planes at
   two rings. */
enum { DEMI_CROSSINGS = 2*(3*DEM_POLYHEDRON_FACES + DEMI_HULL_CORNERS) +
       4*DEM_POLYHEDRON_FACES + 4*4*DEM_POLYHEDRON_FACES + 4 };
/* True if the body is entirely above or below a piece, or beyond the tangent plane of its widest
   ring at the point nearest to the body's centre. */
static int demi_generator_apart(const demi_solid *s, const demi_generator *l, demi_d3 x0) {
    const double wide = DEMI_MAX(l->a, l->b)*demi_off_axis(x0);
    int i, above = 0, below = 0, beyond = 0;
    for (i = 0; i < s->corners; i++) {
        const demi_d3 c = demi_d3_add(x0, s->corner[i]);
        above += c.z > DEMI_MAX(l->g, l->h);
        below += c.z < DEMI_MIN(l->g, l->h);
        beyond += x0.x*c.x + x0.y*c.y > wide;
    }
    return above == s->corners || below == s->corners || beyond == s->corners;
}
/* Adds one piece of a surface of revolution. The integrand is smooth between the angles at which
   edges of the polyhedron, or of its pyramids, cross it. From inside, where the surface is convex,
   only corners and the lines to them reach it. x0: of the centre; whole: the centre must not be
   beyond. */
static void demi_solid_on_generator(const demi_solid *s, const demi_generator *l, demi_d3 x0,
                                    int whole, int32_t element, demi_flats *flats) {
    const double here = demi_generator_radius(l, x0.z), radius = demi_solid_radius(s);
    const int level = !(l->h > l->g || l->h < l->g);
    const int inside = !level && x0.x*x0.x + x0.y*x0.y < here*here;
    unsigned char beyond[DEMI_HULL_CORNERS];
    demi_d3 p[DEMI_HULL_CORNERS], n;
    double angle[DEMI_CROSSINGS];
    demi_pressure press;
    int f, i, k, count = 0, any = 0;
    memset(&press, 0, sizeof press);
    if (whole && demi_generator_beyond(l, x0, &n)) {
        demi_pressure_beyond(s, n, &press);
        demi_flats_add(flats, element, &press);
        return;
    }
    if (demi_generator_apart(s, l, x0)) return;
    for (i = 0; i < s->corners; i++) {
        double r;
        p[i] = demi_d3_add(x0, s->corner[i]);
        r = demi_generator_radius(l, p[i].z);
        beyond[i] = !inside || !(r > 0) || p[i].x*p[i].x + p[i].y*p[i].y > r*r;
        any |= beyond[i];
    }
    if (!any) return;
    for (f = 0; f < s->faces; f++)
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
            const int32_t a = demi_solid_number(s, f, i), b = demi_solid_number(s, f, i + 1);
            if (a < b && (beyond[a] || beyond[b]))      /* once per edge of two faces */
                count += demi_generator_cross(l, p[a], p[b], angle + count);
        }
    for (i = 0; i < s->corners; i++)
        if (beyond[i]) count += demi_generator_cross(l, x0, p[i], angle + count);
    for (f = 0; f < s->faces && !inside && !level; f++)
        count += demi_generator_face(l, s, f, x0, angle + count);
    count += demi_generator_end(s, l->a, l->g, x0, radius, angle + count);
    count += demi_generator_end(s, l->b, l->h, x0, radius, angle + count);
    for (i = 0; i < count; i++)                 /* modulo 2 pi */
        angle[i] -= 2*DEMI_PI*floor(angle[i]/(2*DEMI_PI));
    if (!count) angle[count++] = 0;
    qsort(angle, (size_t)count, sizeof *angle, demi_double_order);
    angle[count] = angle[0] + 2*DEMI_PI;
    for (i = 0; i <= count; i++) {
        const double width = i < count ? angle[i + 1] - angle[i] : 0, had = press.sum;
        const int pieces = 1 + (int)(width/0.2);
        for (f = 0; f < pieces && (!f || press.sum > had); f++)     /* no line, or all */
            for (k = 0; k < 4 && width > 1e-15; k++)
                demi_generator_press(s, l, angle[i] + (f + demi_gauss4_at[k])*width/pieces,
                                     demi_gauss4[k]*width/pieces, x0, &press);
        if (width > 1e-9 && press.sum > had) continue;
        if (width > 1e-9 || i == count) {       /* a gap: the rest is another contact */
            demi_flats_add(flats, element, &press);
            memset(&press, 0, sizeof press);
        }
    }
}
/* Adds a point of a body above one piece of a surface of revolution, and returns its gap, m; 1e300
   if it is beside the piece. At an end where the surface bends towards the body, a point that the
   next piece lets overlap is still above this one. n: unit, into the wall; the rest: as below. */
static double demi_generator_add(const demi_generator *l, demi_d3 n, demi_d3 x0, demi_d3 x,
                                 double out, double up, double level, int32_t element,
                                 demi_gaps *gaps) {
    const demi_d3 y = demi_d3_add(x0, x);
    const double e = l->b - l->a, f = l->h - l->g, across = demi_off_axis(n);
    const double size = sqrt(e*e + f*f), past = 0.01*size*demi_d3_length(x);
    const double r = across > 0 ? fabs(n.x*y.x + n.y*y.y)/across : demi_off_axis(y);
    const double gap = out*r + up*y.z - level, along = (r - l->a)*e + (y.z - l->g)*f;
    if (along < l->open[0]*past - past || along > e*e + f*f + past - l->open[1]*past) return 1e300;
    /* deeper than its distance from an end: the ring there, or the next piece, gives the gap */
    if (gap < 0 && ((l->open[0] && along < -gap*size) ||
                    (l->open[1] && e*e + f*f - along < -gap*size))) return 1e300;
    demi_gaps_add(gaps, element, n, demi_d3_plus(x, gap/2, n), gap);
    return gap;
}
/* Adds the gaps of one piece of a surface of revolution that curves away from the body. It finds
   the plane through one of its lines that separates most, by bisection on the side of the body's
   nearest corner, then the points where the plane through that line and the axis cuts the body. x0:
   of the centre; out, up: the surface's normal m towards the body; level: m.x of its points. */
static void demi_generator_line(const demi_solid *s, demi_d3 x0, double out, double up,
                                double level, const demi_generator *l, int32_t element,
                                demi_gaps *gaps) {
    double lo = 0, hi = 0, c = 1, sn = 0, least = 0, lowest = 1e300, off[DEMI_HULL_CORNERS];
    const double middle = demi_off_axis(x0);
    const double ax = middle > 0 ? x0.x/middle : 1, ay = middle > 0 ? x0.y/middle : 0;
    demi_d3 at[DEMI_HULL_CORNERS], n;
    int i, f, turn, nearest = 0;
    for (i = 0; i < s->corners; i++) {          /* radial, tangential, up */
        const demi_d3 y = demi_d3_add(x0, s->corner[i]);
        at[i] = demi_d(ax*y.x + ay*y.y, ax*y.y - ay*y.x, y.z);
        off[i] = demi_atan2(at[i].y, at[i].x);
        lo = DEMI_MIN(lo, off[i]);
        hi = DEMI_MAX(hi, off[i]);
    }
    for (turn = 0; turn < 52; turn++) {
        const double angle = (lo + hi)/2;
        c = demi_cos(angle);
        sn = demi_sin(angle);
        least = 1e300;
        for (i = 0; i < s->corners; i++) {
            const double d = out*(at[i].x*c + at[i].y*sn) + up*at[i].z - level;
            if (d < least) { least = d; nearest = i; }
        }
        if (!turn && !(lo < 0 || hi > 0)) break;
        if (off[nearest] > angle) lo = angle;
        else hi = angle;
        if (!(hi - lo > 1e-15)) break;
    }
    if (!(least < gaps->range)) return;
    n = demi_d(-out*(ax*c - ay*sn), -out*(ay*c + ax*sn), -up);
    for (f = 0; f < s->faces; f++)
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
            const int32_t a = demi_solid_number(s, f, i), b = demi_solid_number(s, f, i + 1);
            const double p = at[a].y*c - at[a].x*sn, q = at[b].y*c - at[b].x*sn;
            double gap;
            if (a > b || (p > 0) == (q > 0)) continue;
            gap = demi_generator_add(l, n, x0, demi_d3_between(s->corner[a], s->corner[b],
                                                               p/(p - q)), out, up, level,
                                     element, gaps);
            lowest = DEMI_MIN(lowest, gap);
        }
    if (lowest > least + 1e-9*middle)           /* a corner that the plane does not cut */
        demi_generator_add(l, n, x0, s->corner[nearest], out, up, level, element, gaps);
}
/* Adds the gaps of one piece of a surface of revolution. If it curves around the body: the
   corners. */
static void demi_generator_gaps(const demi_solid *s, const demi_generator *l, demi_d3 x0,
                                int32_t element, demi_gaps *gaps) {
    const double e = l->b - l->a, f = l->h - l->g, size = sqrt(e*e + f*f);
    const double out = -l->side*f/size, up = l->side*e/size, level = out*l->a + up*l->g;
    int i;
    if (out > 0) {
        demi_generator_line(s, x0, out, up, level, l, element, gaps);
        return;
    }
    for (i = 0; i < s->corners; i++) {
        const demi_d3 y = demi_d3_add(x0, s->corner[i]);
        const double r = demi_off_axis(y);
        const demi_d3 n = demi_d(r > 0 ? -out*y.x/r : -out, r > 0 ? -out*y.y/r : 0, -up);
        demi_generator_add(l, n, x0, s->corner[i], out, up, level, element, gaps);
    }
}
/* Returns the distance, m, from the body to the point of a ring at an angle about the axis. If tell
   is not null, it is added as that element, unless a piece that ends in the ring continues towards
   the body. */
static double demi_ring_point(const demi_wall *wall, int ring, const demi_solid *s, demi_d3 x0,
                              double angle, const int32_t *tell, demi_gaps *gaps) {
    const double r = (double)wall->ring_radius[ring], z = (double)wall->ring_height[ring];
    const double c = demi_cos(angle), sn = demi_sin(angle);
    const demi_d3 y = demi_d3_sub(demi_d(r*c, r*sn, z), x0);
    demi_d3 to, n;
    const double off = demi_solid_near(s, y, &to);
    int i;
    if (!tell || !(off < gaps->range) || !(off > 0 || off < 0)) return off;
    n = demi_d3_over(demi_d3_sub(y, to), off);
    for (i = -1; i < 2; i += 2) {
        const int other = ring + i;
        double along;
        if (other < 0 || other >= wall->ring_count) continue;
        along = (n.x*c + n.y*sn)*((double)wall->ring_radius[other] - r) +
            n.z*((double)wall->ring_height[other] - z);
        if (-along > 1e-9*r) return off;
    }
    demi_gaps_add(gaps, *tell, n, demi_d3_scale(demi_d3_add(y, to), 0.5), off);
    return off;
}
/* Adds the gaps of a ring of a surface of revolution: points all around within reach of a body of
   this radius, since a face may lie on it; and next to each point that is nearer, or deeper, than
   its neighbours, the local minimum (golden section). */
enum { DEMI_RING_POINTS = 17 };
static void demi_ring_gaps(const demi_wall *wall, int ring, int32_t element, const demi_solid *s,
                           demi_d3 x0, double radius, demi_gaps *gaps) {
    static const double golden = 0.6180339887498949;
    const double r = (double)wall->ring_radius[ring], reach = (radius + gaps->range)/r;
    const double off = demi_off_axis(x0) - r, angle = demi_atan2(x0.y, x0.x);
    const double up = x0.z - (double)wall->ring_height[ring];
    const double half = reach < 1 ? demi_atan2(reach, sqrt(1 - reach*reach)) : DEMI_PI;
    const double step = 2*half/(DEMI_RING_POINTS - 1);
    double far[DEMI_RING_POINTS];
    int i, turn;
    if (!(off*off + up*up < (radius + gaps->range)*(radius + gaps->range))) return;
    for (i = 0; i < DEMI_RING_POINTS; i++)
        far[i] = demi_ring_point(wall, ring, s, x0, angle - half + i*step, &element, gaps);
    for (i = 0; i < DEMI_RING_POINTS; i++) {
        const int last = i + 1 == DEMI_RING_POINTS;
        double lo = angle - half + (i - 1)*step, hi = lo + 2*step, at[2], found[2];
        if ((i && far[i - 1] < far[i]) || (!last && far[i + 1] < far[i]) ||
            !(far[i] < gaps->range + step*r)) continue;
        for (turn = 0; turn < 2; turn++) {
            at[turn] = turn ? lo + golden*(hi - lo) : hi - golden*(hi - lo);
            found[turn] = demi_ring_point(wall, ring, s, x0, at[turn], 0, gaps);
        }
        for (turn = 0; turn < 30; turn++) {
            const int less = found[1] < found[0];
            if (less) lo = at[0];
            else hi = at[1];
            at[!less] = at[less];
            found[!less] = found[less];
            at[less] = less ? lo + golden*(hi - lo) : hi - golden*(hi - lo);
            found[less] = demi_ring_point(wall, ring, s, x0, at[less], 0, gaps);
        }
        demi_ring_point(wall, ring, s, x0, (lo + hi)/2, &element, gaps);
    }
}
/* A polyhedron and a cylinder or a surface of revolution, piece by piece. */
static int demi_round_polyhedron(const demi_view *start, const demi_part *part,
                                 demi_touching *out) {
    demi_view v = *start;
    const demi_wall *wall = v.wall;
    const demi_part local = demi_part_local(wall->pose.rotation, part);
    const int tube = wall->kind == DEMI_WALL_CYLINDER, pieces = tube ? 1 : wall->ring_count - 1;
    const double radius = (double)part->radius;
    demi_gaps gaps;
    demi_solid s;
    int i, count = 0;
    gaps.range = (double)demi_range(v.w, part->radius);
    gaps.flat = 0;
    demi_solid_of(&local, demi_v(0, 0, 0), &s);
    while (demi_view_next(&v)) {
        const demi_d3 x0 = demi_d3_of(v.x);
        const double side = demi_rings_side(wall, x0);
        gaps.count = 0;
        gaps.now = v.shift;
        if (*v.gap > v.gone) continue;
        for (i = 0; i < pieces; i++) {
            const demi_generator l = demi_generator_of(wall, i, v.x, part->radius, side);
            if (tube || demi_generator_near(&l, x0, radius + gaps.range))  /* also if deep inside */
                demi_generator_gaps(&s, &l, x0, i, &gaps);
        }
        for (i = 0; i <= pieces && !tube; i++)
            demi_ring_gaps(wall, i, pieces + i, &s, x0, radius, &gaps);
        count += demi_gaps_places(&v, &gaps, wall->pose.rotation, part, 0, out + count);
    }
    return count;
}
