/* ---------------------------------------------------------------------------------------------
   >>polyhedra-walls
   Where polyhedra touch walls: what >>polyhedra says of each flat piece, in the wall's frame.
   Surfaces whose normals differ by more than 18 degrees are contacts of their own, with all the
   wall's overlap, and as much of its energy as they have of its force; each is four places, the
   corners that its pressure is spread over. A surface is seen from one side, that of the facet, or
   piece, nearest to the body's centre; where it ends near the body, from that from which less of
   the body is beyond, and curtains hang from its ends, so that what is beyond is closed. For
   impulses, and for laws with a range where nothing presses, it is told by gaps in their place
   (>>gaps), by up to four points a direction.
   --------------------------------------------------------------------------------------------- */

/* Pressures on one wall, by the direction of their surfaces. */
typedef struct demi_flats {
    int count;
    int32_t element[DEMI_FLATS];               /* the first of each */
    demi_pressure press[DEMI_FLATS];
} demi_flats;
static void demi_flats_add(demi_flats *f, int32_t element, const demi_pressure *s) {
    const double size = sqrt(demi_dot3(s->force, s->force));
    double most = -2;
    int i, best = 0;
    if (!(s->sum > 0) || !(size > 0)) return;
    for (i = 0; i < f->count; i++) {
        const double *F = f->press[i].force;
        const double along = demi_dot3(F, s->force)/(size*sqrt(demi_dot3(F, F)));
        if (along > most) { most = along; best = i; }
    }
    if (most < 0.95 && f->count < DEMI_FLATS) {
        f->element[f->count] = element;
        f->press[f->count++] = *s;
    } else demi_pressure_add(&f->press[best], s);
}
/* Energy of all that is pressed, m3; < 0: the body's centre is beyond. */
static double demi_flats_energy(const demi_flats *f) {
    double energy = 0;
    int i;
    for (i = 0; i < f->count; i++) energy += f->press[i].shared;
    return energy;
}
/* A surface that ends, from that side from which less of the body is beyond; seen: from its two.
   With energies a and b of these, q = a/(a + b) and t = 4 q - 2: E = (a + b) g(q), where
       g = q for t < -1,    g = (3 - t^2)/8 for -1 < t < 1,    g = 1 - q for t > 1
   so that E and its gradient go from the one to the other without a jump, and a plate that has
   fallen onto an edge has its energy back when it leaves. */
static void demi_flats_sides(const demi_flats *seen, demi_flats *out) {
    const double a = demi_flats_energy(seen), b = demi_flats_energy(seen + 1), all = a + b;
    double share[2];
    int i, k;
    share[1] = a < 0 || b < 0 ? a < 0 : 3*b < a;
    share[0] = 1 - share[1];
    /* the centre is beyond: what is seen from the one side is at least what is left on the other */
    if ((a < 0 && -2*a < b) || (b < 0 && -2*b < a)) share[0] = share[1] = 0;
    if (a > 0 && b > 0 && 3*a > b && 3*b > a) {
        const double t = 4*a/all - 2, g = (3 - t*t)/8;      /* dg/dq = -t */
        share[0] = g - t*b/all;
        share[1] = g + t*a/all;
    }
    for (k = 0; k < 2; k++)
        for (i = 0; i < seen[k].count && share[k] > 0; i++) {
            demi_pressure press = seen[k].press[i];
            demi_pressure_scale(&press, share[k]);
            if (share[!k] > 0 && press.deep > 0.99) press.deep = 1;     /* cut in two: the end */
            demi_flats_add(out, seen[k].element[i], &press);
        }
}
/* Places of all of them, found in a frame of axes R. */
static int demi_flats_places(const demi_view *v, const demi_flats *f, const dem_real *R,
                             const demi_part *part, demi_touching *out) {
    const double r = demi_part_equal(part);
    double shared = 0, force = 0, overlap;
    demi_patch p;
    int i, k, count = 0;
    for (i = 0; i < f->count; i++) {
        shared += f->press[i].shared;
        force += sqrt(demi_dot3(f->press[i].force, f->press[i].force));
    }
    overlap = shared > 0 ? demi_shared_overlap(shared, r) : 0;
    for (i = 0; i < f->count && overlap > 0; i++) {
        if (!demi_pressure_patch(&f->press[i], &p)) continue;
        for (k = 0; k < 4; k++) {
            demi_touching *t = &out[count++];
            t->element = f->element[i];
            t->corner = k;
            t->corners = 4;
            t->overlap = (dem_real)overlap;
            t->share = v->wall->share*(dem_real)(p.force/(4*force));
            t->slope = (dem_real)demi_shared_slope(force, r, overlap);
            t->deep = (dem_real)f->press[i].deep;
            t->couple = p.couple;
            t->normal = demi_rotate(R, p.normal);
            t->spread = demi_rotate(R, demi_patch_spread(&p, k));
            t->point = demi_add(demi_add(v->at, demi_rotate(R, p.point)), t->spread);
            t->shift = v->shift;
        }
    }
    return count;
}
/* The sides of an element of a surface, as half spaces: how many; its plane into n and at, n along
   or (way < 0) against the way its corners turn. 0: it is too thin. origin: of the axes, in the
   wall's frame. */
static int demi_facet_sides(const demi_wall *wall, int element, dem_vec3 origin, int way, double *n,
                            double *at, double (*sides)[2][3]) {
    const int corners = demi_wall_kinds[wall->kind].corners;
    dem_vec3 y[3];
    double x[3][3], e[3], f[3], up[3];
    int i, k;
    demi_wall_corners(wall, element, y);
    for (i = 0; i < corners; i++) {
        const dem_vec3 d = demi_sub(y[i], origin);
        x[i][0] = (double)d.x; x[i][1] = (double)d.y; x[i][2] = (double)d.z;
    }
    demi_sub3(x[1], x[0], e);
    if (corners == 2) {                         /* a line, drawn out along z */
        up[0] = e[1]; up[1] = -e[0]; up[2] = 0;
        for (i = 0; i < 2; i++)
            for (k = 0; k < 3; k++) {
                sides[i][0][k] = i ? -e[k] : e[k];
                sides[i][1][k] = x[i][k];
            }
        sides[0][0][2] = sides[1][0][2] = 0;
    } else {
        demi_sub3(x[2], x[0], f);
        demi_cross3(e, f, up);
        for (i = 0; i < 3; i++) {
            demi_sub3(x[(i + 1)%3], x[i], e);
            demi_cross3(up, e, sides[i][0]);
            memcpy(sides[i][1], x[i], sizeof x[i]);
        }
    }
    if (!(demi_unit3(up) > 0)) return 0;
    for (k = 0; k < 3; k++) n[k] = way < 0 ? -up[k] : up[k];
    *at = demi_dot3(n, x[0]);
    return corners;
}
/* --- by how much a polyhedron is apart from walls, and the points that keep it off: for impulses,
       and for laws that reach beyond touch, where no pressure is --- */

enum { DEMI_GAP_POINTS = 24 };
/* Points near one wall, by the direction of its surface there. */
typedef struct demi_gap_group {
    int32_t element;                           /* the first */
    int count;
    double x[DEMI_GAP_POINTS][3], n[DEMI_GAP_POINTS][3], gap[DEMI_GAP_POINTS];
} demi_gap_group;
typedef struct demi_gaps {
    int count, flat;               /* flat: what pushes within 60 degrees of z alone (of plates) */
    double range;
    demi_gap_group group[DEMI_FLATS];
} demi_gaps;
/* Leaves the four that count. */
static void demi_gap_group_pick(demi_gap_group *g) {
    const demi_gap_group all = *g;
    int picked[4], i;
    g->count = demi_spots_pick(g->x, g->gap, g->count, g->n[0], picked);
    for (i = 0; i < g->count; i++) {
        memcpy(g->x[i], all.x[picked[i]], sizeof *g->x);
        memcpy(g->n[i], all.n[picked[i]], sizeof *g->n);
        g->gap[i] = all.gap[picked[i]];
    }
}
/* n: unit, from the polyhedron into the wall. */
static void demi_gaps_add(demi_gaps *gaps, int32_t element, const double *n, const double *x,
                          double gap) {
    demi_gap_group *g;
    double most = -2;
    int i, best = 0;
    if (!(gap < gaps->range) || (gaps->flat && fabs(n[2]) < 0.5)) return;
    for (i = 0; i < gaps->count; i++) {
        const double along = demi_dot3(gaps->group[i].n[0], n);
        if (along > most) { most = along; best = i; }
    }
    if (most < 0.95 && gaps->count < DEMI_FLATS) {
        best = gaps->count++;
        gaps->group[best].element = element;
        gaps->group[best].count = 0;
    }
    g = &gaps->group[best];
    if (g->count == DEMI_GAP_POINTS) demi_gap_group_pick(g);
    memcpy(g->x[g->count], x, sizeof *g->x);
    memcpy(g->n[g->count], n, sizeof *g->n);
    g->gap[g->count++] = gap;
}
/* A plane z = 0 of the wall's frame: corners. height: of the origin over it. */
static void demi_plane_gaps(const demi_solid *s, double height, demi_gaps *gaps) {
    static const double down[3] = {0, 0, -1};
    int i;
    for (i = 0; i < s->corners; i++) {
        const double gap = s->corner[i][2] + height;
        const double x[3] = {s->corner[i][0], s->corner[i][1], s->corner[i][2] - gap/2};
        demi_gaps_add(gaps, 0, down, x, gap);
    }
}
/* A facet as a body: a triangle, or what a profile's line sweeps from reach below to reach above
   the origin of the axes. 0: it is too thin. */
static int demi_facet_solid(const demi_wall *wall, int element, dem_vec3 origin, double reach,
                            demi_solid *f) {
    static const int32_t triangle[9] = {0, 3, 6, 0, 1, 2, 0, 2, 1};
    static const int32_t strip[11] = {0, 4, 8, 0, 1, 2, 3, 0, 3, 2, 1};
    dem_vec3 y[3];
    double e[3], g[3];
    int i, k;
    demi_wall_corners(wall, element, y);
    f->faces = 2;
    f->corners = demi_wall_kinds[wall->kind].corners == 2 ? 4 : 3;
    f->rim = f->corners == 4 ? strip : triangle;
    f->centre[0] = f->centre[1] = f->centre[2] = 0;
    for (i = 0; i < f->corners; i++) {
        const dem_vec3 d = demi_sub(y[f->corners == 3 ? i : i == 1 || i == 2], origin);
        double *c = f->corner[i];
        c[0] = (double)d.x; c[1] = (double)d.y;
        c[2] = f->corners == 3 ? (double)d.z : i < 2 ? -reach : reach;
        for (k = 0; k < 3; k++) f->centre[k] += c[k]/f->corners;
    }
    demi_sub3(f->corner[1], f->corner[0], e);
    demi_sub3(f->corner[2], f->corner[0], g);
    demi_cross3(e, g, f->plane[0]);
    if (!(demi_unit3(f->plane[0]) > 0)) return 0;
    for (k = 0; k < 3; k++) f->plane[1][k] = -f->plane[0][k];
    f->plane[0][3] = f->plane[1][3] = 1;        /* unit normals, for those who ask for no more */
    return 1;
}
/* Is the facet's part that tells a gap, an edge or a corner (own: which of its corners), what the
   surface has nearest there? Not where another facet that has the same edge, or corner, goes on
   towards the body: that one tells its own. n: unit, from the body. */
static int demi_facet_nearest(const demi_wall *wall, const int32_t *among, int count,
                              const dem_vec3 *own, int owns, const double *n) {
    int i, k, e;
    for (i = 0; i < count; i++) {
        dem_vec3 y[3];
        const int corners = demi_wall_corners(wall, among[i], y);
        int has[3] = {0, 0, 0}, all = 0;
        for (k = 0; k < corners; k++)
            for (e = 0; e < owns && !has[k]; e++)
                all += has[k] = !(demi_length(demi_sub(y[k], own[e])) > 0);
        if (all < owns) continue;
        for (k = 0; k < corners; k++) {
            dem_vec3 way = demi_sub(y[k], own[0]);
            if (has[k]) continue;
            if (owns == 2) {                    /* across the edge */
                const dem_vec3 edge = demi_unit(demi_sub(own[1], own[0]));
                way = demi_sub(way, demi_scale(edge, demi_dot(way, edge)));
            }
            if (-(n[0]*(double)way.x + n[1]*(double)way.y + n[2]*(double)way.z) >
                1e-9*(double)demi_length(way)) return 0;
        }
    }
    return 1;
}
/* The points of a body over a facet, on the side where its centre is, as if the facet went on
   without end. 0: none. */
static int demi_facet_under(const demi_solid *s, const demi_solid *f, double range,
                            demi_spots *out) {
    double x[DEMI_SECTION][3], gap[DEMI_SECTION], up[3];
    int picked[4], i, k, left = 0, count;
    count = demi_faces_over(f, demi_dot3(f->plane[0], f->corner[0]) > 0, s, x, gap, up);
    for (i = 0; i < count; i++) {
        if (!(gap[i] < range)) continue;
        memmove(x[left], x[i], sizeof *x);
        gap[left++] = gap[i];
    }
    for (k = 0; k < 3; k++) out->normal[k] = -up[k];
    out->count = left ? demi_spots_pick(x, gap, left, up, picked) : 0;
    for (i = 0; i < out->count; i++) {
        memcpy(out->x[i], x[picked[i]], sizeof *x);
        out->gap[i] = gap[picked[i]];
    }
    return out->count;
}
/* One facet. among: all that are near. Deep in it by little beside an edge that goes on, the least
   way out leads over the edge, into the facet beyond; then it is told as if it had no end. */
static void demi_element_gaps(const demi_wall *wall, int element, const int32_t *among, int count,
                              const demi_solid *s, dem_vec3 x, double reach, demi_gaps *gaps) {
    static const double anywhere[3] = {0, 0, 0};
    demi_simplex tells;
    demi_solid f;
    demi_spots spots;
    dem_vec3 y[3], own[3];
    int i, k, owns = 0, has[3] = {0, 0, 0};
    if (!demi_facet_solid(wall, element, x, reach, &f) ||
        !demi_solids_spots(s, &f, 1, gaps->range, anywhere, &tells, &spots)) return;
    if (fabs(demi_dot3(spots.normal, f.plane[0])) < DEMI_FLUSH) {
        const int strip = f.corners == 4;       /* two of its corners are one of the profile */
        demi_wall_corners(wall, element, y);
        for (i = 0; i < tells.count; i++) {
            k = tells.at[i].b;
            if (!(tells.part[i] > 0)) continue;
            k = strip ? k == 1 || k == 2 : k;
            if (!has[k]) own[owns++] = y[k];
            has[k] = 1;
        }
        if (owns < (strip ? 2 : 3) &&
            !demi_facet_nearest(wall, among, count, own, owns, spots.normal) &&
            (!(spots.gap[0] < 0) || !demi_facet_under(s, &f, gaps->range, &spots))) return;
    }
    for (i = 0; i < spots.count; i++)
        demi_gaps_add(gaps, element, spots.normal, spots.x[i], spots.gap[i]);
}
/* Places of all of them: by impulses the four of each direction that count; by a law with a range
   the nearest of all of a direction in which nothing presses, four times. pressed: how many places
   there are before `out`. */
static int demi_gaps_places(const demi_view *v, demi_gaps *gaps, const dem_real *R,
                            const demi_part *part, int pressed, demi_touching *out) {
    const int pressing = demi_response_is(v->w, DEMI_PRESSING);
    int i, k, e, count = 0;
    for (i = 0; i < gaps->count; i++) {
        demi_gap_group *g = &gaps->group[i];
        int nearest = 0, places = 4;
        if (!pressing) {
            demi_gap_group_pick(g);
            places = g->count;
        }
        for (k = 1; k < g->count; k++) if (g->gap[k] < g->gap[nearest]) nearest = k;
        for (k = 0; k < places; k++) {
            demi_touching *t = &out[count];
            e = pressing ? nearest : k;
            memset(t, 0, sizeof *t);
            t->element = g->element;
            t->corner = k;
            t->corners = places;
            t->overlap = (dem_real)-g->gap[e];
            t->share = v->wall->share/(dem_real)places;
            t->slope = 1;
            t->deep = t->overlap/demi_part_thin(part);
            t->normal = demi_rotate(R, demi_v((dem_real)g->n[e][0], (dem_real)g->n[e][1],
                                              (dem_real)g->n[e][2]));
            t->point = demi_add(v->at, demi_rotate(R, demi_v((dem_real)g->x[e][0],
                                                             (dem_real)g->x[e][1],
                                                             (dem_real)g->x[e][2])));
            t->shift = v->shift;
            for (e = 1; e <= pressed; e++)
                if (demi_dot(out[-e].normal, t->normal) > DEM_R(0.95)) break;
            if (e <= pressed || (pressing && !(t->overlap < 0))) break;
            count++;
        }
    }
    return count;
}
/* Places of both, of one image of the body. */
static int demi_wall_places(const demi_view *v, const demi_flats *flats, demi_gaps *gaps,
                            const dem_real *R, const demi_part *part, demi_touching *out) {
    const int pressed = demi_flats_places(v, flats, R, part, out);
    return pressed + demi_gaps_places(v, gaps, R, part, pressed, out + pressed);
}
/* Sides of an element where its sheet ends: bits. There it is alone, or one of three or more; not
   where another lies along part of it. */
static int demi_facet_ends(const demi_wall *wall, int e) {
    const int n = demi_wall_per(wall), edges = wall->element_count;
    int k, open = 0;
    for (k = 0; k < n; k++) {
        const dem_real count = wall->weight[n == 3 ? edges + wall->edges[3*e + k]
                                            : edges + wall->edge_count + wall->corners[2*e + k]];
        open |= (!(count < 0 || count > 0) || count < DEM_R(-1.5)) << k;
    }
    for (k = wall->cut_start ? wall->cut_start[e] : 0;
         wall->cut_start && k < wall->cut_start[e + 1]; k++) open &= ~(1 << wall->cuts[k].side);
    return open;
}

/* The sheets of a surface that are near a body, and from which side it sees each: from that on
   which its centre is, by the facet that is nearest to it, of equally near ones (at an edge) by
   that which it stands over most. So the slope behind a ridge is seen from outside, too, where a
   body lies over it. Near an end of the sheet: see demi_sheets_press. */
enum { DEMI_SHEETS = 16 };
typedef struct demi_sheets {
    int count;
    int32_t sheet[DEMI_SHEETS];
    int way[DEMI_SHEETS];          /* of the normal into the surface, by the sheet's first facet */
    int ends[DEMI_SHEETS];         /* does it end near the body? */
    double near2[DEMI_SHEETS], over[DEMI_SHEETS];      /* m2; m */
} demi_sheets;
DEM_INLINE int32_t demi_sheet_of(const demi_wall *wall, int element) {
    const int32_t own = wall->sheet[element];
    return own < 0 ? -own : own;
}
/* m2: how far a segment is from the origin. */
static double demi_segment_near2(const double *p, const double *q) {
    double part[2], d2 = 0;
    int k;
    demi_near_segment(p, q, part);
    for (k = 0; k < 3; k++) d2 += (part[0]*p[k] + part[1]*q[k])*(part[0]*p[k] + part[1]*q[k]);
    return d2;
}
/* within: m, how far the body reaches. */
static void demi_sheets_add(demi_sheets *s, const demi_wall *wall, int element, dem_vec3 origin,
                            double within) {
    const int32_t sheet = demi_sheet_of(wall, element);
    const int corners = demi_wall_kinds[wall->kind].corners, open = demi_facet_ends(wall, element);
    double x[3][3], part[3] = {0, 0, 0}, e[3], f[3] = {0, 0, 1}, up[3], v[3], d2, over;
    dem_vec3 y[3];
    int i, k;
    demi_wall_corners(wall, element, y);
    for (i = 0; i < corners; i++) {
        const dem_vec3 d = demi_sub(y[i], origin);
        x[i][0] = (double)d.x; x[i][1] = (double)d.y; x[i][2] = corners == 2 ? 0 : (double)d.z;
    }
    demi_sub3(x[1], x[0], e);
    if (corners == 3) demi_sub3(x[2], x[0], f);
    if (corners == 3) demi_near_triangle(x[0], x[1], x[2], part);
    else demi_near_segment(x[0], x[1], part);
    demi_cross3(e, f, up);
    if (!(demi_unit3(up) > 0)) return;
    for (k = 0; k < 3; k++)
        for (i = 0, v[k] = 0; i < corners; i++) v[k] += part[i]*x[i][k];
    d2 = demi_dot3(v, v);
    over = demi_dot3(up, x[0])*(wall->sheet[element] < 0 ? -1 : 1);
    for (i = 0; i < s->count && s->sheet[i] != sheet; i++) continue;
    if (i == DEMI_SHEETS) return;
    if (i == s->count) s->ends[s->count++] = 0;
    else if (d2 > s->near2[i]*(1 + 1e-9) ||
             (d2 > s->near2[i]*(1 - 1e-9) && !(fabs(over) > fabs(s->over[i])))) d2 = -1;
    for (k = 0; k < corners && !s->ends[i]; k++)
        s->ends[i] = open >> k & 1 &&
            demi_segment_near2(x[k], x[corners == 3 ? (k + 1)%3 : k]) < within*within;
    if (d2 < 0) return;
    s->sheet[i] = sheet;
    s->near2[i] = d2;
    s->over[i] = over;
    s->way[i] = over < 0 ? -1 : 1;
}
/* Which of the sheets an element is of; -1: there was no room for a note of it. */
static int demi_sheets_which(const demi_sheets *s, const demi_wall *wall, int element) {
    const int32_t sheet = demi_sheet_of(wall, element);
    int i;
    for (i = 0; i < s->count; i++) if (s->sheet[i] == sheet) return i;
    return -1;
}
/* The way of one element's normal; x: of the body, for sheets of which there is no note. */
static int demi_sheets_way(const demi_sheets *s, const demi_wall *wall, int element, dem_vec3 x) {
    const dem_real *plane = wall->planes + 4*element;
    const int i = demi_sheets_which(s, wall, element);
    if (i >= 0) return wall->sheet[element] < 0 ? -s->way[i] : s->way[i];
    return plane[3] - demi_dot(demi_at(plane), x) < 0 ? -1 : 1;
}
/* One element, from a polyhedron about the origin of the axes. way: of its normal. */
static void demi_solid_on_element(const demi_wall *wall, int element, const demi_solid *s,
                                  dem_vec3 x, int way, demi_pressure *press) {
    double sides[3][2][3], n[3], at;
    int count;
    memset(press, 0, sizeof *press);
    if (wall->kind == DEMI_WALL_PLANE) {
        n[0] = n[1] = 0;
        n[2] = -1;
        demi_solid_on_flat(s, n, (double)x.z, 0, 0, 0, press);
    } else if ((count = demi_facet_sides(wall, element, x, way, n, &at, sides)) != 0)
        demi_solid_on_flat(s, n, at, sides, count, 0, press);
}
/* The elements of one sheet that are near a body, seen from one side: of the sheet's first facet
   way. within: how far the body reaches, m. */
typedef struct demi_sheet {
    const demi_view *v;
    const demi_wall *wall;
    dem_real within;
    int way;
    int32_t sheet;
} demi_sheet;
/* Is element i of the list one of the sheet's? Then, which way its normal goes; 0: it is not. */
DEM_INLINE int demi_sheet_turn(const demi_sheet *t, int i) {
    const int element = t->v->element[i];
    if (t->v->gap[i] > t->v->gone || demi_sheet_of(t->wall, element) != t->sheet) return 0;
    return t->wall->sheet[element] < 0 ? -t->way : t->way;
}
/* The sheet's mean normals at both corners of a side where it ends; 0: it does not. */
static const demi_border *demi_facet_border(const demi_wall *wall, int32_t side) {
    int lo = 0, hi = wall->border_count;
    while (lo < hi) {
        const int mid = (lo + hi)/2;
        if (wall->borders[mid].side < side) lo = mid + 1;
        else hi = mid;
    }
    return lo < wall->border_count && wall->borders[lo].side == side ? &wall->borders[lo] : 0;
}
/* Half of the curtain of a side, from its corner at o to its middle c, down along m; way: along the
   side, so that m x way is the curtain's normal. */
static void demi_curtain_half(const demi_solid *s, const double *o, const double *c,
                              const double *m, const double *way, demi_pressure *press) {
    double by[3][2][3], e[3], n[3], along, size;
    int k;
    demi_sub3(c, o, e);
    demi_cross3(m, way, n);
    if (!(demi_unit3(n) > 0)) return;
    along = demi_dot3(e, m);
    size = demi_dot3(e, e);
    for (k = 0; k < 3; k++) {
        by[0][0][k] = m[k] - along/size*e[k];
        by[1][0][k] = e[k] - along*m[k];
        by[2][0][k] = -by[1][0][k];
        by[0][1][k] = by[1][1][k] = o[k];
        by[2][1][k] = c[k];
    }
    demi_solid_on_flat(s, n, demi_dot3(n, o), by, 3, 0, press);
}
/* What is missing between both halves at the middle of a side, where the sheet's normal is a at the
   corner before and b at that behind: the sector between lines along both. */
static void demi_curtain_fold(const demi_solid *s, const double *c, const double *a,
                              const double *b, demi_pressure *press) {
    const double along = demi_dot3(a, b);
    double by[2][2][3], n[3];
    int k;
    demi_cross3(a, b, n);
    if (!(demi_unit3(n) > 1e-9)) return;
    for (k = 0; k < 3; k++) {
        by[0][0][k] = b[k] - along*a[k];
        by[1][0][k] = a[k] - along*b[k];
        by[0][1][k] = by[1][1][k] = c[k];
    }
    demi_solid_on_flat(s, n, demi_dot3(n, c), by, 2, 0, press);
}
/* Does the curtain at a side (3*element + side) reach over the plane of its element, n the normal,
   where the sheet is folded sharply? */
static int demi_curtain_bends(const demi_sheet *t, int32_t side, const double *n) {
    const demi_border *mean = demi_facet_border(t->wall, side);
    const dem_vec3 up = demi_v((dem_real)n[0], (dem_real)n[1], (dem_real)n[2]);
    return mean && (demi_dot(mean->normal[0], up)*(dem_real)t->way < 0 ||
                    demi_dot(mean->normal[1], up)*(dem_real)t->way < 0);
}
/* The curtain at a side (3*element + side) where its sheet ends: from there down along the sheet's
   normal, without end. What is beyond the sheet and within its curtains is closed and does not
   change as the body moves, so that energy is conserved. n: the element's normal. */
static void demi_sheet_curtain(const demi_sheet *t, int32_t side, double (*sides)[2][3],
                               const double *n, const demi_solid *s, demi_pressure *press) {
    const int k = side%3;
    const demi_border *mean;
    const double *end[2];
    double m[2][3], in[3], way[3], edge[3], c[3];
    int q;
    memset(press, 0, sizeof *press);
    memcpy(in, sides[k][0], sizeof in);
    demi_unit3(in);
    if (demi_wall_per(t->wall) == 2) {
        double by[1][2][3];
        memcpy(by[0][0], n, sizeof by[0][0]);
        memcpy(by[0][1], sides[k][1], sizeof by[0][1]);
        demi_solid_on_flat(s, in, demi_dot3(in, by[0][1]), by, 1, 0, press);
        return;
    }
    mean = demi_facet_border(t->wall, side);
    if (!mean) return;
    for (q = 0; q < 2; q++) {
        const dem_vec3 d = demi_scale(mean->normal[q], (dem_real)t->way);
        end[q] = sides[(k + q)%3][1];
        m[q][0] = (double)d.x; m[q][1] = (double)d.y; m[q][2] = (double)d.z;
    }
    demi_sub3(end[1], end[0], edge);
    for (q = 0; q < 3; q++) c[q] = (end[0][q] + end[1][q])/2;
    demi_cross3(in, n, way);                    /* n x way = in */
    for (q = 0; q < 2; q++) demi_curtain_half(s, end[q], c, m[q], way, press);
    q = demi_dot3(way, edge) < 0;               /* from which corner to which */
    demi_curtain_fold(s, c, m[q], m[!q], press);
}
/* All of a sheet with its curtains. */
static void demi_sheet_seen(const demi_sheet *t, const demi_solid *s, demi_flats *flats) {
    demi_pressure press;
    double sides[3][2][3], n[3], at;
    int i, k, count, ends, beyond;
    for (i = 0; i < t->v->count; i++) {
        const int element = t->v->element[i], way = demi_sheet_turn(t, i);
        const dem_real *plane = t->wall->planes + 4*element;
        const dem_real off = demi_dot(demi_at(plane), t->v->x) - plane[3];
        if (!way || DEMI_ABS(off) > t->within + t->wall->plane_slack) continue;
        count = demi_facet_sides(t->wall, element, t->v->x, way, n, &at, sides);
        if (!count) continue;
        ends = demi_facet_ends(t->wall, element);
        beyond = demi_dot3(n, s->corner[demi_solid_far(s, n)]) > at;
        memset(&press, 0, sizeof press);
        if (beyond) demi_solid_on_flat(s, n, at, sides, count, 0, &press);
        if (beyond) demi_flats_add(flats, element, &press);
        for (k = 0; k < count; k++) {
            if (!(ends >> k & 1) || !(beyond || demi_curtain_bends(t, 3*element + k, n))) continue;
            demi_sheet_curtain(t, 3*element + k, sides, n, s, &press);
            demi_flats_add(flats, element, &press);
        }
    }
}
/* Sheets that end near the body: what each shares with it is the body's part beyond the sheet and
   its curtains, a solid that stands still, so that this is an energy; of two such solids, one on
   either side, the one of which there is less. A body that does not touch the sheet has nothing of
   one of them. */
static void demi_sheets_press(const demi_sheets *sheets, demi_sheet *t, const demi_solid *s,
                              demi_flats *flats) {
    demi_flats seen[2];
    int i, k;
    for (i = 0; i < sheets->count; i++) {
        if (!sheets->ends[i]) continue;
        t->sheet = sheets->sheet[i];
        for (k = 0; k < 2; k++) {
            t->way = k ? -sheets->way[i] : sheets->way[i];
            seen[k].count = 0;
            if (!k || seen[0].count) demi_sheet_seen(t, s, &seen[k]);
        }
        demi_flats_sides(seen, flats);
    }
}
/* Any wall whose elements are flat. */
static int demi_flat_polyhedron(const demi_view *start, const demi_part *part, demi_touching *out) {
    demi_view v = *start;
    const demi_wall *wall = v.wall;
    const demi_part local = demi_part_local(wall->pose.rotation, part);
    const int pressing = demi_response_is(v.w, DEMI_PRESSING);
    demi_flats flats;
    demi_gaps gaps;
    demi_pressure press;
    demi_sheets sheets;
    demi_sheet sheet;
    demi_solid s;
    int k, way, count = 0;
    gaps.range = (double)demi_range(v.w, part->radius);
    gaps.flat = 0;
    sheet.v = &v;
    sheet.wall = wall;
    sheet.within = part->radius*DEM_R(1.001);
    demi_solid_of(&local, demi_v(0, 0, 0), &s);
    while (demi_view_next(&v)) {
        flats.count = gaps.count = sheets.count = 0;
        for (k = 0; wall->sheet && pressing && k < v.count; k++)
            if (!(v.gap[k] > v.gone) && wall->sheet[v.element[k]])
                demi_sheets_add(&sheets, wall, v.element[k], v.x, (double)sheet.within);
        demi_sheets_press(&sheets, &sheet, &s, &flats);
        for (k = 0; k < v.count; k++) {
            const int32_t element = v.element[k];
            const int which = !pressing || !wall->sheet ? -1
                : demi_sheets_which(&sheets, wall, element);
            if (v.gap[k] > v.gone || (wall->sheet && !wall->sheet[element])) continue;
            if (pressing && (which < 0 || !sheets.ends[which])) {
                way = wall->sheet ? demi_sheets_way(&sheets, wall, element, v.x) : 1;
                demi_solid_on_element(wall, element, &s, v.x, way, &press);
                demi_flats_add(&flats, element, &press);
            }
            if (!(gaps.range > 0)) continue;
            if (wall->kind == DEMI_WALL_PLANE) demi_plane_gaps(&s, (double)v.x.z, &gaps);
            else demi_element_gaps(wall, element, v.element, v.count, &s, v.x,
                                   2*(double)part->radius + gaps.range, &gaps);
        }
        count += demi_wall_places(&v, &flats, &gaps, wall->pose.rotation, part, out + count);
    }
    return count;
}
/* A wall of grains, each a ball. */
static int demi_grain_polyhedron(const demi_view *start, const demi_part *part,
                                 demi_touching *out) {
    demi_view v = *start;
    const demi_wall *wall = v.wall;
    const dem_real *R = wall->pose.rotation;
    const demi_part local = demi_part_local(wall->pose.rotation, part);
    demi_solid s;
    int k, count = 0;
    demi_solid_of(&local, demi_v(0, 0, 0), &s);
    while (demi_view_next(&v)) for (k = 0; k < v.count; k++) {
        const dem_vec3 ball = demi_sub(demi_at(wall->vertices + 3*v.element[k]), v.x);
        const double c[3] = {(double)ball.x, (double)ball.y, (double)ball.z};
        double q[3], off;
        demi_touching *t = &out[count];
        if (v.gap[k] > v.gone) continue;
        off = demi_solid_near(&s, c, q);
        if (!(off < (double)(wall->radius + demi_range(v.w, part->radius)))) continue;
        memset(t, 0, sizeof *t);
        t->element = v.element[k];
        t->overlap = wall->radius - (dem_real)off;
        t->deep = t->overlap/wall->radius;
        t->share = wall->share;
        t->slope = 1;
        t->point = demi_add(v.at, demi_rotate(R, demi_v((dem_real)q[0], (dem_real)q[1],
                                                        (dem_real)q[2])));
        t->normal = demi_v((dem_real)(c[0] - q[0]), (dem_real)(c[1] - q[1]),
                           (dem_real)(c[2] - q[2]));
        t->normal = off < 0 || off > 0 ? demi_scale(demi_rotate(R, t->normal), (dem_real)(1/off))
                                       : demi_unit(demi_rotate(R, ball));
        t->shift = v.shift;
        count++;
    }
    return count;
}
