/* ---------------------------------------------------------------------------------------------
   >>polyhedra-sieves
   Where polyhedra touch sieves. To springs a wire is a cylinder without end, in a frame whose z
   goes along it (>>polyhedra-round), and a plate is solid between its holes: they press on its
   faces, strips and pieces between holes (round: the cell of a hole less the hole), and on the
   walls of its holes; together these are a closed surface, so that energy is conserved. For gaps a
   wire is a line with a radius; a corner of the body is told by the face, or wall of a hole, that
   it is over or nearest to, and the rims of holes by the points of the body that lie on them. Where
   wires cross, what they share counts twice. Reduced holes, sieves cut out as a disc, and to
   springs sheets without thickness, which have no inside, know no polyhedra: demi_wall_why. Then
   the table of who touches what.
   --------------------------------------------------------------------------------------------- */

/* Holes of a plate: half sizes across x and y, and from hole to hole; along x without end: 0. */
typedef struct demi_plate {
    int round, lattices;           /* 2: every other row is shifted by half a hole */
    double a, b, px, py, half;     /* m; half: of the thickness */
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
/* The middle of the hole in whose cell (u, v) lies; number: its own. */
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
/* Is (u, v) over solid? n: unit, at the wall of the hole in whose cell it lies, into the solid;
   off: m, how far it is beyond that wall. Of a corner of a hole two walls: two: the other one's. */
static int demi_plate_solid(const demi_plate *p, double u, double v, double (*n)[3], double *off) {
    double c[2], x, y, r;
    demi_plate_hole(p, u, v, c);
    x = u - c[0];
    y = v - c[1];
    memset(n, 0, 2*sizeof *n);
    if (p->round) {
        r = sqrt(x*x + y*y);
        n[0][0] = r > 0 ? x/r : 1;
        n[0][1] = r > 0 ? y/r : 0;
        off[0] = r - p->a;
        off[1] = -1e300;
        return off[0] > 0;
    }
    n[0][1] = y < 0 ? -1 : 1;
    n[1][0] = x < 0 ? -1 : 1;
    off[0] = fabs(y) - p->b;
    off[1] = p->px > 0 ? fabs(x) - p->a : -1e300;
    return off[0] > 0 || off[1] > 0;
}

/* --- for springs --- */

/* A rectangle of a surface: middle, half sizes along two axes of the frame, normal along the third
   into the solid. half 0: without end. x: of the centre. */
static void demi_plate_flat(const demi_solid *s, const double *x, const double *middle,
                            const double *half, int across, double way, int32_t element,
                            demi_flats *flats) {
    double sides[4][2][3], n[3] = {0, 0, 0}, at;
    demi_pressure press;
    int i, k, e, count = 0;
    n[across] = way;
    at = way*(middle[across] - x[across]);
    memset(sides, 0, sizeof sides);
    memset(&press, 0, sizeof press);
    for (i = 0; i < 3; i++)
        for (k = -1; k < 2 && i != across && half[i] > 0; k += 2) {
            sides[count][0][i] = -k;
            for (e = 0; e < 3; e++) sides[count][1][e] = middle[e] - x[e];
            sides[count++][1][i] += k*half[i];
        }
    demi_solid_on_flat(s, n, at, sides, count, 0, &press);
    demi_flats_add(flats, element, &press);
}
/* Solid of a plate with square holes or slots about the hole at c: half of the bars on both sides
   of it, and the hole's walls. */
static void demi_plate_press(const demi_plate *p, const demi_solid *s, const double *x,
                             const double *c, int32_t number, demi_flats *flats) {
    const double bar_x = (p->px - 2*p->a)/4, bar_y = (p->py - 2*p->b)/4;
    int k, side;
    for (side = -1; side < 2; side += 2) {
        for (k = -1; k < 2; k += 2) {           /* k: which face */
            const double row[3] = {c[0], c[1] + side*(p->b + bar_y), k*p->half};
            const double link[3] = {c[0] + side*(p->a + bar_x), c[1], k*p->half};
            const double row_half[3] = {p->px/2, bar_y, 0}, link_half[3] = {bar_x, p->b, 0};
            demi_plate_flat(s, x, row, row_half, 2, -k, DEMI_SIEVE_FACE, flats);
            if (p->px > 0) demi_plate_flat(s, x, link, link_half, 2, -k, DEMI_SIEVE_FACE, flats);
        }
        {
            const double row[3] = {c[0], c[1] + side*p->b, 0};
            const double link[3] = {c[0] + side*p->a, c[1], 0};
            const double row_half[3] = {p->a, 0, p->half}, link_half[3] = {0, p->b, p->half};
            demi_plate_flat(s, x, row, row_half, 1, side, number + (side > 0), flats);
            if (p->px > 0) demi_plate_flat(s, x, link, link_half, 0, side,
                                           number + 2 + (side > 0), flats);
        }
    }
}
/* The same about a round one: the faces of its cell less the hole's disc, and its wall. */
static void demi_plate_press_round(const demi_plate *p, const demi_solid *s, const double *x,
                                   const double *c, int32_t number, demi_flats *flats) {
    const dem_vec3 from = demi_v((dem_real)(x[0] - c[0]), (dem_real)(x[1] - c[1]), (dem_real)x[2]);
    const double hole[3] = {c[0] - x[0], c[1] - x[1], p->a};
    const int six = p->lattices > 1, count = six ? 6 : 4;
    demi_generator l;
    int i, k, e;
    memset(&l, 0, sizeof l);
    for (k = -1; k < 2; k += 2) {               /* k: which face */
        const double n[3] = {0, 0, -(double)k}, at = k*x[2] - p->half;
        double sides[6][2][3];
        demi_pressure press;
        memset(sides, 0, sizeof sides);
        memset(&press, 0, sizeof press);
        for (i = 0; i < count; i++) {
            const double turn = DEMI_PI*(six ? i/3.0 : i/2.0);
            const double way[2] = {demi_cos(turn), demi_sin(turn)};
            for (e = 0; e < 2; e++) {
                sides[i][0][e] = -way[e];
                sides[i][1][e] = c[e] - x[e] + way[e]*p->px/2;
            }
        }
        demi_solid_on_flat(s, n, at, sides, count, hole, &press);
        demi_flats_add(flats, DEMI_SIEVE_FACE, &press);
    }
    l.a = l.b = p->a;
    l.g = -p->half;
    l.h = p->half;
    l.side = 1;
    demi_solid_on_generator(s, &l, from, 0, number, flats);
}

/* --- for impulses, and laws with a range --- */

/* The corners of a body, x the place of its centre. A sheet has no inside: a corner is beyond it
   where the way to it from the centre passes through solid. */
static void demi_plate_corners(const demi_plate *p, const demi_solid *s, const double *x,
                               demi_gaps *gaps) {
    const int sheet = !(p->half > 0);
    int i, k, e;
    for (i = 0; i < s->corners; i++) {
        const double *c = s->corner[i];
        const double at[3] = {x[0] + c[0], x[1] + c[1], x[2] + c[2]};
        double n[3][3], off[2], gap[3], o[3], t = 1;
        int solid, one, count = 1;
        if (sheet && (at[2] > 0) != (x[2] > 0)) t = x[2]/(x[2] - at[2]);
        solid = demi_plate_solid(p, x[0] + t*c[0], x[1] + t*c[1], n, off);
        n[2][0] = n[2][1] = 0;
        n[2][2] = (sheet ? x[2] : at[2]) < 0 ? 1 : -1;
        gap[0] = -off[0];
        gap[1] = -off[1];
        gap[2] = -n[2][2]*at[2] - p->half;
        one = 2;
        if (!solid) {                           /* in a hole: beside its walls, if there at all */
            if (sheet || gap[2] > 0) continue;
            one = 0;
            count = p->round || !(p->px > 0) ? 1 : 2;
        } else if (!sheet && !(off[0] > 0 && off[1] > 0))
            for (e = 0; e < 2; e++)             /* in solid: out by the shortest way */
                if (off[e] > 0 && gap[e] > gap[one]) one = e;
        for (e = one; e < one + count; e++) {
            for (k = 0; k < 3; k++) o[k] = c[k] + n[e][k]*gap[e]/2;
            demi_gaps_add(gaps, DEMI_SIEVE_FACE, n[e], o, gap[e]);
        }
    }
}
/* A line from a to b, in a body's frame, and what lies `thick` around it: a wire, or (0) the rim of
   a hole, where neither the face, which goes on along out, nor the hole's wall, along down (a sheet
   has none), goes on towards the body. A face of the body that lies along the line is held by both
   ends of what it covers. */
static void demi_line_gaps(const demi_solid *s, const double *a, const double *b, double thick,
                           const double *out, const double *down, int32_t element,
                           demi_gaps *gaps) {
    const int32_t *loop = s->rim + s->faces + 1;
    demi_solid line;
    demi_simplex tells;
    double n[3] = {0, 0, 0}, along[3], t[2] = {0, 1}, on, gap;
    int i, k, f;
    line.faces = 0;
    line.rim = 0;
    line.corners = 2;
    for (k = 0; k < 3; k++) {
        line.corner[0][k] = a[k];
        line.corner[1][k] = b[k];
        line.centre[k] = (a[k] + b[k])/2;
    }
    gap = demi_solids_gap(s, &line, n, &tells) - thick;
    if (!(gap < gaps->range) || -demi_dot3(n, out) > 1e-9 || -demi_dot3(n, down) > 1e-9)
        return;
    f = demi_solid_facing(s, n, &on);
    demi_sub3(b, a, along);
    if (on >= DEMI_FLUSH && fabs(demi_dot3(s->plane[f], along)*s->plane[f][3]) <
        sqrt((1 - DEMI_FLUSH*DEMI_FLUSH)*demi_dot3(along, along)))
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {       /* between the sides of the face */
            const double *p = s->corner[loop[i]];
            const double *q = s->corner[loop[i + 1 < s->rim[f + 1] ? i + 1 : s->rim[f]]];
            double e[3], in[3], from[3], at, way;
            demi_sub3(q, p, e);
            demi_cross3(s->plane[f], e, in);
            demi_sub3(a, p, from);
            at = demi_dot3(in, from);
            way = demi_dot3(in, along);
            if (way > 0) t[0] = DEMI_MAX(t[0], -at/way);
            else if (way < 0) t[1] = DEMI_MIN(t[1], -at/way);
            else if (at < 0) t[1] = -1;
        }
    else t[1] = -1;
    for (i = 0; i < 2; i++) {
        const int ends = t[0] < t[1];
        double x[3] = {0, 0, 0}, m[3], d[3];
        for (k = 0; k < 3; k++) m[k] = ends ? s->plane[f][k]*s->plane[f][3] : n[k];
        for (k = 0; k < 3 && ends; k++) x[k] = a[k] + t[i]*along[k];
        for (f = ends ? f : 0; f < tells.count && !ends; f++)
            for (k = 0; k < 3; k++) x[k] += tells.part[f]*line.corner[tells.at[f].b][k];
        if (ends) {
            demi_sub3(x, s->corner[loop[s->rim[f]]], d);
            gap = demi_dot3(m, d) - thick;
        }
        for (k = 0; k < 3; k++) x[k] -= m[k]*(thick + gap/2);
        demi_gaps_add(gaps, element, m, x, gap);
        if (!ends) break;
    }
}
/* The rims of the hole at c, above and below; reach: how far a rim without end is followed, m. */
static void demi_plate_rims(const demi_plate *p, const demi_solid *s, const double *x,
                            const double *c, int32_t number, double reach, demi_gaps *gaps) {
    const double far = 2*p->a + reach;
    demi_wall washer;
    int k, side, set;
    if (p->round) {
        const dem_vec3 from = demi_v((dem_real)(x[0] - c[0]), (dem_real)(x[1] - c[1]),
                                     (dem_real)x[2]);
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
                const double down[3] = {0, 0, p->half > 0 ? -(double)k : 0};
                double a[3], b[3], out[3] = {0, 0, 0};
                a[set] = c[set] - x[set] - size;
                b[set] = c[set] - x[set] + size;
                a[!set] = b[!set] = c[!set] - x[!set] + off;
                a[2] = b[2] = k*p->half - x[2];
                out[!set] = side;
                demi_line_gaps(s, a, b, 0, out, down, number + 2*set + (side > 0), gaps);
            }
}

/* --- both --- */

/* A plate, about x, up to reach from there: the cells of holes that the body lies over. A body that
   ends within `hair` of a face lies on it: it does not catch at the rims of holes that it slides
   over. */
static void demi_plate_touch(const dem_sieve_desc *sieve, const demi_solid *s, const double *x,
                             double reach, double hair, int pressing, demi_flats *flats,
                             demi_gaps *gaps) {
    const demi_plate p = demi_plate_of(sieve);
    const double cell[2] = {0.6*p.px, 0.6*p.py};        /* of one with six sides, too */
    double lo[3], hi[3], u, v, c[2];
    int i, k;
    for (k = 0; k < 3; k++) {
        lo[k] = hi[k] = 0;
        for (i = 0; i < s->corners; i++) {
            lo[k] = DEMI_MIN(lo[k], s->corner[i][k]);
            hi[k] = DEMI_MAX(hi[k], s->corner[i][k]);
        }
        lo[k] += x[k] - gaps->range - (k < 2 ? cell[k] : 0);
        hi[k] += x[k] + gaps->range + (k < 2 ? cell[k] : 0);
    }
    if (lo[2] > p.half || hi[2] < -p.half) return;
    gaps->flat = fabs(lo[2] + gaps->range - p.half) < hair ||
        fabs(hi[2] - gaps->range + p.half) < hair;
    if (gaps->range > 0) demi_plate_corners(&p, s, x, gaps);
    for (k = 0; k < p.lattices; k++) {
        const double du = p.px > 0 ? p.px : 1, shift_x = k*p.px/2, shift_y = k*p.py/2;
        const double u0 = p.px > 0 ? (floor((lo[0] - shift_x)/du) + 1)*du + shift_x : x[0];
        const double u1 = p.px > 0 ? hi[0] : x[0] + 0.5;
        const double v0 = (floor((lo[1] - shift_y)/p.py) + 1)*p.py + shift_y;
        for (v = v0; v < hi[1]; v += p.py)
            for (u = u0; u < u1; u += du) {
                const int32_t number = demi_plate_hole(&p, u, v, c);
                if (pressing && p.round) demi_plate_press_round(&p, s, x, c, number, flats);
                else if (pressing) demi_plate_press(&p, s, x, c, number, flats);
                if (gaps->range > 0) demi_plate_rims(&p, s, x, c, number, reach, gaps);
            }
    }
}
/* One set of parallel wires: each a cylinder about z of a frame of axes turn. x: of the centre, in
   the sieve's. */
static void demi_wires_touch(const dem_sieve_desc *sieve, int set, const demi_solid *s, dem_vec3 x,
                             double reach, int pressing, demi_flats *flats, demi_gaps *gaps) {
    const double pitch = (double)(sieve->aperture + sieve->bar), q = (double)sieve->bar/2;
    const double h = (double)(set ? -sieve->lift/2 : sieve->lift/2);
    const double u = (double)(set ? x.y : x.x), v = (double)(set ? x.x : x.y);
    const double last = floor((u + reach + q)/pitch - 0.5), none[3] = {0, 0, 0};
    demi_generator l;
    double k;
    memset(&l, 0, sizeof l);
    l.a = l.b = q;
    l.g = v - reach;
    l.h = v + reach;
    l.side = -1;
    for (k = floor((u - reach - q)/pitch - 0.5) + 1; k <= last; k++) {
        const dem_real across = (dem_real)(u - (k + 0.5)*pitch), up = x.z - (dem_real)h;
        const dem_vec3 from = set ? demi_v(across, up, x.x) : demi_v(up, across, x.y);
        const int32_t number = demi_sieve_number(k, 0, set);
        if (pressing) demi_solid_on_generator(s, &l, from, 1, number, flats);
        if (gaps->range > 0) {
            const double a[3] = {-(double)from.x, -(double)from.y, -reach};
            const double b[3] = {-(double)from.x, -(double)from.y, reach};
            demi_line_gaps(s, a, b, q, none, none, number, gaps);
        }
    }
}
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
        const double x0[3] = {(double)v.x.x, (double)v.x.y, (double)v.x.z};
        if (*v.gap > v.gone) continue;
        for (set = 0; set < sets; set++) {
            dem_real turn[9];
            demi_part local;
            for (i = 0; i < 3; i++)             /* wires: z along the wire, x and y follow */
                for (e = 0; e < 3; e++) turn[3*e + i] = R[3*e + (wires ? (i + 2 - set)%3 : i)];
            local = demi_part_local(turn, part);
            demi_solid_of(&local, demi_v(0, 0, 0), &s);
            flats.count = gaps.count = 0;
            if (wires) demi_wires_touch(sieve, set, &s, v.x, reach, pressing, &flats, &gaps);
            else demi_plate_touch(sieve, &s, x0, reach, 1e-3*(double)demi_part_thin(part), pressing,
                                  &flats, &gaps);
            count += demi_wall_places(&v, &flats, &gaps, turn, part, out + count);
        }
    }
    return count;
}

/* Who touches what: walls by kind, and parts by theirs. */
#define DEMI_WALL_TOUCH(KIND, C, M, T, N, NEAR, TOUCH, BEND) DEMI_LIST TOUCH,
static const demi_touch_fn demi_touches[][DEMI_SHAPE_KINDS] = {{0}, DEMI_WALLS(DEMI_WALL_TOUCH)};
/* Why a part does not know a wall, and what to do; 0: it does. */
static const char *demi_wall_why(const dem_world *w, const demi_wall *wall, int part) {
    const dem_sieve_desc *s = &wall->sieve;
    if (!demi_touches[wall->kind][part])
        return "contacts between the two are not available; make bodies clusters of spheres, or "
               "the wall a mesh or a resolved profile";
    if (part != DEMI_POLYHEDRON || wall->kind != DEMI_WALL_SIEVE) return 0;
    if (s->kind == DEM_SIEVE_REDUCED)
        return "reduced holes are only for spheres; use DEM_SIEVE_SQUARE";
    if (s->radius > 0)
        return "a sieve cut from a disc is only for spheres; leave its radius at 0, and put a "
               "cylinder around it";
    if (!demi_sieve_wires(s) && !(s->thickness > 0) && demi_response_is(w, DEMI_PRESSING))
        return "a sheet without thickness has no inside for springs to act on; give the sieve a "
            "thickness, or use impulses";
    return 0;
}
