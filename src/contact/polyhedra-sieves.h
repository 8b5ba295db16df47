/* ---------------------------------------------------------------------------------------------
   >>polyhedra-sieves
   Contacts of polyhedra with sieves. With springs, a wire is an infinite cylinder in a frame with z
   along it (>>polyhedra-round), and a plate is solid between its holes. The plate acts by its
   faces, as strips and pieces between holes (with round holes: the cell of a hole minus the hole),
   and by the walls of its holes. Together these are a closed surface, so energy is conserved.

   With gaps, a wire is a line with a radius. A corner of the body belongs to the face, or wall of a
   hole, that it is above or nearest to; rims of holes have the points of the body that lie on them.
   Where wires cross, the volume that they share counts twice. Springs act on sheets without
   thickness through tessellations. Polyhedra have no contacts with reduced holes or sieves cut out
   as a disc: see demi_wall_why in >>bodies. At the end, the table of functions by kinds of walls
   and parts.
   --------------------------------------------------------------------------------------------- */

/* The holes of a plate: half sizes along x and y, and periods. px 0: infinite along x. */
typedef struct demi_plate {
    int round, lattices;           /* lattices 2: every other row is shifted by half a period */
    double a, b, px, py, half;     /* m; half: half the thickness */
} demi_plate;
static demi_plate demi_plate_of(const dem_sieve_desc *s) {
    const double bar = (double)s->bar, hole = (double)s->aperture;
    demi_plate p;
    p.round = s->kind == DEM_SIEVE_ROUND;
    p.lattices = s->staggered ? 2 : 1;
    p.a = s->kind == DEM_SIEVE_SLOTS ? (double)s->length/2 : hole/2;
    p.b = hole/2;
    p.px = p.a > 0 ? 2*p.a + bar : 0;
    p.py = (hole + bar)*(s->staggered ? 1.7320508075688772 : 1);
    p.half = (double)s->thickness/2;
    return p;
}
/* Writes the centre of the hole in whose cell (u, v) lies, and returns its number. */
static int32_t demi_plate_hole(const demi_plate *p, double u, double v, double *c) {
    double best = 1e300;
    int32_t number = 0;
    int k;
    c[0] = u;
    c[1] = v;
    for (k = 0; k < p->lattices; k++) {
        const double i = p->px > 0 ? floor(u/p->px - 0.5*k + 0.5) : 0;
        const double j = floor(v/p->py - 0.5*k + 0.5);
        const double x = p->px > 0 ? (i + 0.5*k)*p->px : u, y = (j + 0.5*k)*p->py;
        if (!((u - x)*(u - x) + (v - y)*(v - y) < best)) continue;
        best = (u - x)*(u - x) + (v - y)*(v - y);
        c[0] = x;
        c[1] = y;
        number = demi_sieve_number(i, j, 4*k);
    }
    return number;
}
/* From the centre of the hole at c to x, rounded to dem_real. */
static demi_d3 demi_plate_from(demi_d3 x, const double *c) {
    return demi_d3_of(demi_d3_real(demi_d(x.x - c[0], x.y - c[1], x.z)));
}
/* True if (u, v) is above solid. n: unit, at the wall of the hole in whose cell it lies, into the
   solid; off: m, how far it is beyond that wall. The second of each is for the other wall of a
   rectangular hole. */
static int demi_plate_solid(const demi_plate *p, double u, double v, demi_d3 *n, double *off) {
    double c[2], x, y, r;
    demi_plate_hole(p, u, v, c);
    x = u - c[0];
    y = v - c[1];
    if (p->round) {
        r = sqrt(x*x + y*y);
        n[0] = r > 0 ? demi_d(x/r, y/r, 0) : demi_d(1, 0, 0);
        off[0] = r - p->a;
        off[1] = -1e300;
        return off[0] > 0;
    }
    n[0] = demi_d(0, y < 0 ? -1 : 1, 0);
    n[1] = demi_d(x < 0 ? -1 : 1, 0, 0);
    off[0] = fabs(y) - p->b;
    off[1] = p->px > 0 ? fabs(x) - p->a : -1e300;
    return off[0] > 0 || off[1] > 0;
}

/* --- springs --- */

/* The half space up to `far` from a point along n. */
static demi_half demi_half_of(demi_d3 middle, demi_d3 n, double far) {
    demi_half half;
    half.n = demi_d3_scale(n, -1);
    half.o = demi_d3_plus(middle, far, n);
    return half;
}
/* Adds a rectangle of a surface. middle: its centre; size: half sizes along two axes of the frame
   (0: infinite); across: the third axis, with the normal along way times it into the solid; x: of
   the body's centre. */
static void demi_plate_flat(const demi_solid *s, demi_d3 x, demi_d3 middle, demi_d3 size,
                            int across, double way, int32_t element, demi_flats *flats) {
    static const demi_d3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const demi_d3 from = demi_d3_sub(middle, x);
    demi_half sides[4];
    demi_pressure press;
    int i, k, count = 0;
    memset(&press, 0, sizeof press);
    for (i = 0; i < 3; i++) {
        const double half = demi_d3_dot(axis[i], size);
        for (k = -1; k < 2 && i != across && half > 0; k += 2)
            sides[count++] = demi_half_of(from, demi_d3_scale(axis[i], k), half);
    }
    demi_solid_on_flat(s, demi_d3_scale(axis[across], way), way*demi_d3_dot(axis[across], from),
                       sides, count, 0, &press);
    demi_flats_add(flats, element, &press);
}
/* Adds the solid of a plate around the square hole or slot at c: half of the bars on both sides,
   and the walls of the hole. */
static void demi_plate_press(const demi_plate *p, const demi_solid *s, demi_d3 x, const double *c,
                             int32_t number, demi_flats *flats) {
    const double bar_x = (p->px - 2*p->a)/4, bar_y = (p->py - 2*p->b)/4;
    const int closed = p->px > 0;
    int k, side;
    for (side = -1; side < 2; side += 2) {
        for (k = -1; k < 2; k += 2) {           /* k: which face */
            const demi_d3 row = demi_d(c[0], c[1] + side*(p->b + bar_y), k*p->half);
            const demi_d3 link = demi_d(c[0] + side*(p->a + bar_x), c[1], k*p->half);
            demi_plate_flat(s, x, row, demi_d(p->px/2, bar_y, 0), 2, -k, DEMI_SIEVE_FACE, flats);
            if (closed)
                demi_plate_flat(s, x, link, demi_d(bar_x, p->b, 0), 2, -k, DEMI_SIEVE_FACE, flats);
        }
        demi_plate_flat(s, x, demi_d(c[0], c[1] + side*p->b, 0), demi_d(p->a, 0, p->half), 1, side,
                        number + (side > 0), flats);
        if (closed)
            demi_plate_flat(s, x, demi_d(c[0] + side*p->a, c[1], 0), demi_d(0, p->b, p->half), 0,
                            side, number + 2 + (side > 0), flats);
    }
}
/* The same for a round hole: the faces of its cell minus the disc of the hole, and its wall. */
static void demi_plate_press_round(const demi_plate *p, const demi_solid *s, demi_d3 x,
                                   const double *c, int32_t number, demi_flats *flats) {
    const demi_d3 middle = demi_d(c[0] - x.x, c[1] - x.y, 0);
    const double hole[3] = {middle.x, middle.y, p->a};
    const int six = p->lattices > 1, count = six ? 6 : 4;
    demi_generator l;
    int i, k;
    memset(&l, 0, sizeof l);
    for (k = -1; k < 2; k += 2) {               /* k: which face */
        demi_half sides[6];
        demi_pressure press;
        memset(&press, 0, sizeof press);
        for (i = 0; i < count; i++) {
            const double turn = DEMI_PI*(six ? i/3.0 : i/2.0);
            sides[i] = demi_half_of(middle, demi_d(demi_cos(turn), demi_sin(turn), 0), p->px/2);
        }
        demi_solid_on_flat(s, demi_d(0, 0, -k), k*x.z - p->half, sides, count, hole, &press);
        demi_flats_add(flats, DEMI_SIEVE_FACE, &press);
    }
    l.a = l.b = p->a;
    l.g = -p->half;
    l.h = p->half;
    l.side = 1;
    demi_solid_on_generator(s, &l, demi_plate_from(x, c), 0, number, flats);
}

/* --- impulses, and laws with a range --- */

/* Adds the gaps of the corners of a body centred at x. A sheet without thickness has no inside: a
   corner is beyond it if the line to it from the centre passes through solid. */
static void demi_plate_corners(const demi_plate *p, const demi_solid *s, demi_d3 x,
                               demi_gaps *gaps) {
    const int sheet = !(p->half > 0);
    int i, e;
    for (i = 0; i < s->corners; i++) {
        const demi_d3 c = s->corner[i], at = demi_d3_add(x, c);
        demi_d3 n[3];
        double off[2], gap[3], t = 1;
        int solid, one, count = 1;
        if (sheet && (at.z > 0) != (x.z > 0)) t = x.z/(x.z - at.z);
        solid = demi_plate_solid(p, x.x + t*c.x, x.y + t*c.y, n, off);
        n[2] = demi_d(0, 0, (sheet ? x.z : at.z) < 0 ? 1 : -1);
        gap[0] = -off[0];
        gap[1] = -off[1];
        gap[2] = -n[2].z*at.z - p->half;
        one = 2;
        if (!solid) {                           /* in a hole: beside its walls, if at all */
            if (sheet || gap[2] > 0) continue;
            one = 0;
            count = p->round || !(p->px > 0) ? 1 : 2;
        } else if (!sheet && !(off[0] > 0 && off[1] > 0))
            for (e = 0; e < 2; e++)             /* in solid: out by the shortest way */
                if (off[e] > 0 && gap[e] > gap[one]) one = e;
        for (e = one; e < one + count; e++)
            demi_gaps_add(gaps, DEMI_SIEVE_FACE, n[e], demi_d3_plus(c, gap[e]/2, n[e]), gap[e]);
    }
}
/* Adds the gaps of a line from a to b, in the frame of a body, with radius `thick`: a wire, or (0)
   the rim of a hole. A rim gives a gap only where neither the face, which continues along `out`,
   nor the wall of the hole, which continues along `down` (a sheet has none), extends towards the
   body. A face of the body that lies along the line touches at both ends of the part that it
   covers. */
static void demi_line_gaps(const demi_solid *s, demi_d3 a, demi_d3 b, double thick, demi_d3 out,
                           demi_d3 down, int32_t element, demi_gaps *gaps) {
    const demi_d3 along = demi_d3_sub(b, a);
    demi_solid line;
    demi_simplex tells;
    demi_d3 n = demi_d(0, 0, 0);
    double t[2] = {0, 1}, on, gap;
    int i, k, f, ends;
    line.faces = 0;
    line.rim = 0;
    line.corners = 2;
    line.corner[0] = a;
    line.corner[1] = b;
    line.centre = demi_d3_scale(demi_d3_add(a, b), 0.5);
    gap = demi_solids_gap(s, &line, gaps->range + thick, &n, &tells) - thick;
    if (!(gap < gaps->range) || -demi_d3_dot(n, out) > 1e-9 || -demi_d3_dot(n, down) > 1e-9)
        return;
    f = demi_solid_facing(s, n, &on);
    ends = on >= DEMI_FLUSH && fabs(demi_d3_dot(s->face[f].slope, along)*s->face[f].high) <
        sqrt((1 - DEMI_FLUSH*DEMI_FLUSH)*demi_d3_square(along));
    for (i = ends ? s->rim[f] : 0; ends && i < s->rim[f + 1]; i++) {   /* sides of the face */
        const demi_d3 p = demi_solid_corner(s, f, i);
        const demi_d3 e = demi_d3_sub(demi_solid_corner(s, f, i + 1), p);
        const demi_d3 in = demi_d3_cross(s->face[f].slope, e);
        const double at = demi_d3_dot(in, demi_d3_sub(a, p)), way = demi_d3_dot(in, along);
        if (way > 0) t[0] = DEMI_MAX(t[0], -at/way);
        else if (way < 0) t[1] = DEMI_MIN(t[1], -at/way);
        else if (at < 0) t[1] = -1;
    }
    ends = ends && t[0] < t[1];
    if (ends) n = demi_d3_scale(s->face[f].slope, s->face[f].high);
    for (i = 0; i < 1 + ends; i++) {
        demi_d3 x = ends ? demi_d3_plus(a, t[i], along) : demi_d(0, 0, 0);
        for (k = 0; k < tells.count && !ends; k++)
            x = demi_d3_plus(x, tells.part[k], line.corner[tells.at[k].b]);
        if (ends)
            gap = demi_d3_dot(n, demi_d3_sub(x, demi_solid_corner(s, f, s->rim[f]))) - thick;
        demi_gaps_add(gaps, element, n, demi_d3_plus(x, -(thick + gap/2), n), gap);
    }
}
/* Adds the gaps of the rims of the hole at c, above and below. reach: length of an infinite rim
   that is considered, m. */
static void demi_plate_rims(const demi_plate *p, const demi_solid *s, demi_d3 x, const double *c,
                            int32_t number, double reach, demi_gaps *gaps) {
    const double far = 2*p->a + reach;
    demi_wall washer;
    int k, side, set;
    if (p->round) {
        const demi_d3 from = demi_plate_from(x, c);
        memset(&washer, 0, sizeof washer);
        washer.ring_count = p->half > 0 ? 4 : 2;
        for (k = 0; k < washer.ring_count; k++) {
            washer.ring_radius[k] = (dem_real)(k == 1 || k == 2 ? p->a : far);
            washer.ring_height[k] = (dem_real)(k < 2 ? p->half : -p->half);
        }
        demi_ring_gaps(&washer, 1, number + 1, s, from, reach, gaps);
        if (p->half > 0) demi_ring_gaps(&washer, 2, number + 2, s, from, reach, gaps);
        return;
    }
    for (k = 1; k > (p->half > 0 ? -2 : 0); k -= 2)
        for (side = -1; side < 2; side += 2)
            for (set = 0; set < 1 + (p->px > 0); set++) {   /* along x; along y */
                const double off = side*(set ? p->a : p->b), half = set ? p->b : p->a;
                const double size = half > 0 ? half : reach;
                const demi_d3 along = demi_d(!set, set, 0), aside = demi_d(set, !set, 0);
                const demi_d3 rim = demi_d3_plus(demi_d(c[0] - x.x, c[1] - x.y, k*p->half - x.z),
                                                 off, aside);
                demi_line_gaps(s, demi_d3_plus(rim, -size, along), demi_d3_plus(rim, size, along),
                               0, demi_d3_scale(aside, side),
                               demi_d(0, 0, p->half > 0 ? -k : 0), number + 2*set + (side > 0),
                               gaps);
            }
}

/* --- both --- */

/* Adds the contacts of a plate with a body about x, of extent `reach`: all cells of holes that the
   body covers. A body that ends within `hair` of a face lies on it, and does not catch on the rims
   of holes that it slides over. */
static void demi_plate_touch(const dem_sieve_desc *sieve, const demi_solid *s, demi_d3 x,
                             double reach, double hair, int pressing, demi_flats *flats,
                             demi_gaps *gaps) {
    const demi_plate p = demi_plate_of(sieve);
    const double r = gaps->range;
    const demi_d3 cell = demi_d(0.6*p.px, 0.6*p.py, 0); /* covers hexagonal cells too */
    const demi_d3 range = demi_d(r, r, r);
    demi_d3 lo = demi_d(0, 0, 0), hi = lo;
    double u, v, c[2];
    int i, k;
    for (i = 0; i < s->corners; i++) {
        lo = demi_d3_lowest(lo, s->corner[i]);
        hi = demi_d3_highest(hi, s->corner[i]);
    }
    lo = demi_d3_add(lo, demi_d3_sub(demi_d3_sub(x, range), cell));
    hi = demi_d3_add(hi, demi_d3_add(demi_d3_add(x, range), cell));
    if (lo.z > p.half || hi.z < -p.half) return;
    gaps->flat = fabs(lo.z + r - p.half) < hair || fabs(hi.z - r + p.half) < hair;
    if (gaps->range > 0) demi_plate_corners(&p, s, x, gaps);
    for (k = 0; k < p.lattices; k++) {
        const double du = p.px > 0 ? p.px : 1, shift_x = k*p.px/2, shift_y = k*p.py/2;
        const double u0 = p.px > 0 ? (floor((lo.x - shift_x)/du) + 1)*du + shift_x : x.x;
        const double u1 = p.px > 0 ? hi.x : x.x + 0.5;
        const double v0 = (floor((lo.y - shift_y)/p.py) + 1)*p.py + shift_y;
        for (v = v0; v < hi.y; v += p.py)
            for (u = u0; u < u1; u += du) {
                const int32_t number = demi_plate_hole(&p, u, v, c);
                if (pressing && p.round) demi_plate_press_round(&p, s, x, c, number, flats);
                else if (pressing) demi_plate_press(&p, s, x, c, number, flats);
                if (gaps->range > 0) demi_plate_rims(&p, s, x, c, number, reach, gaps);
            }
    }
}
/* Adds the contacts of one set of parallel wires, each a cylinder about z of a frame of axes
   `turn`. x: of the centre, in the frame of the sieve. */
static void demi_wires_touch(const dem_sieve_desc *sieve, int set, const demi_solid *s, dem_vec3 x,
                             double reach, int pressing, demi_flats *flats, demi_gaps *gaps) {
    const double pitch = (double)(sieve->aperture + sieve->bar), q = (double)sieve->bar/2;
    const double h = (double)(set ? -sieve->lift/2 : sieve->lift/2);
    const double u = (double)(set ? x.y : x.x), v = (double)(set ? x.x : x.y);
    const double last = floor((u + reach + q)/pitch - 0.5);
    const demi_d3 none = demi_d(0, 0, 0);
    demi_generator l;
    double k;
    memset(&l, 0, sizeof l);
    l.a = l.b = q;
    l.g = v - reach;
    l.h = v + reach;
    l.side = -1;
    for (k = floor((u - reach - q)/pitch - 0.5) + 1; k <= last; k++) {
        const dem_real across = (dem_real)(u - (k + 0.5)*pitch), up = x.z - (dem_real)h;
        const demi_d3 from = demi_d3_of(set ? demi_v(across, up, x.x) : demi_v(up, across, x.y));
        const int32_t number = demi_sieve_number(k, 0, set);
        if (pressing) demi_solid_on_generator(s, &l, from, 1, number, flats);
        if (gaps->range > 0)
            demi_line_gaps(s, demi_d(-from.x, -from.y, -reach), demi_d(-from.x, -from.y, reach), q,
                           none, none, number, gaps);
    }
}
/* A polyhedron and a sieve of wires or a plate. */
static int demi_sieve_polyhedron(const demi_view *start, const demi_part *part,
                                 demi_touching *out) {
    demi_view v = *start;
    const dem_sieve_desc *sieve = &v.wall->sieve;
    const dem_real *R = v.wall->pose.rotation;
    const int wires = demi_sieve_wires(sieve), sets = sieve->kind == DEM_SIEVE_WIRES ? 2 : 1;
    const int pressing = demi_response_is(v.w, DEMI_PRESSING);
    const double range = (double)demi_range(v.w, part->radius);
    const double reach = (double)part->radius + range;
    demi_flats flats;
    demi_gaps gaps;
    demi_solid s;
    int set, i, e, count = 0;
    gaps.range = range;
    gaps.flat = 0;
    while (demi_view_next(&v)) {
        if (*v.gap > v.gone) continue;
        for (set = 0; set < sets; set++) {
            dem_real turn[9];
            demi_part local;
            for (i = 0; i < 3; i++)             /* wires: z along the wire, x and y follow */
                for (e = 0; e < 3; e++) turn[3*e + i] = R[3*e + (wires ? (i + 2 - set)%3 : i)];
            local = demi_part_local(turn, part);
            demi_solid_of(&local, demi_v(0, 0, 0), &s);
            demi_flats_begin(&flats, &v);
            gaps.count = 0;
            flats.now = gaps.now = v.shift;
            if (wires) demi_wires_touch(sieve, set, &s, v.x, reach, pressing, &flats, &gaps);
            else demi_plate_touch(sieve, &s, demi_d3_of(v.x), reach,
                                  1e-3*(double)demi_part_thin(part), pressing, &flats, &gaps);
            count += demi_wall_places(&v, &flats, &gaps, turn, &local, out + count);
        }
    }
    return count;
}
