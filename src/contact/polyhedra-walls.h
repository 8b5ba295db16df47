/* ---------------------------------------------------------------------------------------------
   >>polyhedra-walls
   Contacts of polyhedra with flat walls: the integrals of >>polyhedra over each flat piece, in the
   frame of the wall. Surfaces whose normals differ by more than 18 degrees are separate contacts.
   Each has the overlap of the whole wall, and takes part in its energy in proportion to its force.
   Each consists of four contact points, the corners of the patch that its pressure is spread over.
   If several walls of a joined surface are under the patch, each wall has these four points, and
   bears the part of the force that its own pressure has. However a surface is divided into walls,
   stiffness, damping and friction are thus those of one wall.

   A surface acts on one side: that of the facet, or piece, nearest to the body's centre. If it ends
   near the body, it acts on the side beyond which there is less of the body, and curtains extend
   from its border along the normals into the wall, so that the volume beyond is closed. Impulses,
   and laws with a range while there is no overlap, use gaps instead (>>gaps), with up to four
   contact points per direction.
   --------------------------------------------------------------------------------------------- */

/* What the pressure of one group does to one wall. */
typedef struct demi_flats_wall {
    int group, wall;
    dem_vec3 shift;                            /* m, image of the first element */
    demi_d3 force, torque;                     /* as in demi_pressure */
} demi_flats_wall;
/* Pressures on one surface, grouped by its direction and its walls' materials. */
typedef struct demi_flats {
    const dem_world *w;
    const demi_wall *wall;                     /* the surface */
    int count, walls;
    dem_vec3 now;                              /* m, shift of the image that is examined */
    int32_t element[DEMI_FLATS];               /* the first of each group */
    dem_vec3 shift[DEMI_FLATS];                /* m, its image */
    demi_pressure press[DEMI_FLATS];
    demi_flats_wall part[DEMI_FLATS_WALLS];
} demi_flats;
static void demi_flats_begin(demi_flats *f, const demi_view *v) {
    f->w = v->w;
    f->wall = v->wall;
    f->count = f->walls = 0;
}
/* True if two elements are of one wall or of walls that friction cannot tell apart. */
static int demi_flats_alike(const demi_flats *f, int32_t element, int32_t other) {
    const demi_wall *a = &f->w->walls[demi_surface_wall(f->w, f->wall, element)];
    const demi_wall *b = &f->w->walls[demi_surface_wall(f->w, f->wall, other)];
    const dem_vec3 glide = demi_rotate(b->pose.rotation, b->glide);
    return a == b || (a->material == b->material && a->glides == b->glides &&
        (!a->glides || !(demi_length(demi_sub(demi_rotate(a->pose.rotation, a->glide), glide)) >
                         DEM_R(1e-6)*demi_length(glide))));
}
/* Notes a force and torque of a group on a wall; if there is no room, on another of its walls. */
static void demi_flats_on(demi_flats *f, int group, int wall, demi_d3 force, demi_d3 torque) {
    demi_flats_wall *p = 0;
    int i;
    for (i = 0; i < f->walls && !(p && p->wall == wall); i++)
        if (f->part[i].group == group) p = &f->part[i];
    if (!(p && p->wall == wall) && f->walls < DEMI_FLATS_WALLS) {
        p = &f->part[f->walls++];
        memset(p, 0, sizeof *p);
        p->group = group;
        p->wall = wall;
        p->shift = f->now;
    }
    if (!p) return;
    p->force = demi_d3_add(p->force, force);
    p->torque = demi_d3_add(p->torque, torque);
}
/* Adds the pressure on an element to the group within 18 degrees, or begins a new group. Returns
   its index, or -1 if there is no pressure. */
static int demi_flats_join(demi_flats *f, int32_t element, const demi_pressure *s) {
    const double size = demi_d3_length(s->force);
    double most = -2;
    int i, best = 0;
    if (!(s->sum > 0) || !(size > 0)) return -1;
    for (i = 0; i < f->count; i++) {
        const demi_d3 F = f->press[i].force;
        const double along = demi_d3_dot(F, s->force)/(size*demi_d3_length(F));
        if (f->count < DEMI_FLATS && !demi_flats_alike(f, f->element[i], element)) continue;
        if (along > most) { most = along; best = i; }
    }
    if (most < 0.95 && f->count < DEMI_FLATS) {
        f->shift[f->count] = f->now;
        f->element[f->count] = element;
        f->press[best = f->count++] = *s;
    } else demi_pressure_add(&f->press[best], s);
    return best;
}
static void demi_flats_add(demi_flats *f, int32_t element, const demi_pressure *s) {
    const int group = demi_flats_join(f, element, s);
    if (group >= 0)
        demi_flats_on(f, group, demi_surface_wall(f->w, f->wall, element), s->force, s->torque);
}
/* Energy I of all groups, m3; < 0: the body's centre is beyond the surface. */
static double demi_flats_energy(const demi_flats *f) {
    double energy = 0;
    int i;
    for (i = 0; i < f->count; i++) energy += f->press[i].shared;
    return energy;
}
/* Combines a surface that ends near the body, as seen from its two sides (seen[0], seen[1]): it
   acts on the side beyond which there is less of the body. With the energies a and b of the two
   sides, q = a/(a + b) and t = 4 q - 2, E = (a + b) g(q), where
       g = q for t < -1,    g = (3 - t^2)/8 for -1 < t < 1,    g = 1 - q for t > 1
   E and its gradient therefore change from one side to the other without a jump, and a plate that
   falls onto an edge gets its energy back when it leaves. */
static void demi_flats_sides(const demi_flats *seen, demi_flats *out) {
    const double a = demi_flats_energy(seen), b = demi_flats_energy(seen + 1), all = a + b;
    double share[2];
    int i, k, e, group;
    share[1] = a < 0 || b < 0 ? a < 0 : 3*b < a;
    share[0] = 1 - share[1];
    /* the centre is beyond: one side has at least what is left on the other */
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
            if (share[!k] > 0 && press.deep > 0.99) press.deep = 1;     /* cut in two: stop */
            out->now = seen[k].shift[i];
            group = demi_flats_join(out, seen[k].element[i], &press);
            for (e = 0; e < seen[k].walls && group >= 0; e++) {
                const demi_flats_wall *p = seen[k].part + e;
                out->now = p->shift;
                if (p->group == i)
                    demi_flats_on(out, group, p->wall, demi_d3_scale(p->force, share[k]),
                                  demi_d3_scale(p->torque, share[k]));
            }
        }
}
/* Makes the four contact points t those of one wall's part of its group, of patch p. weight: sum of
   the forces of the group's walls. */
static void demi_flats_divide(const demi_flats_wall *part, const demi_patch *p, double weight,
                              const dem_real *R, int rank, demi_touching *t) {
    const double phi = demi_d3_length(part->force)/weight, unit = 1/(phi*p->force);
    const demi_d3 n = demi_d3_of(p->normal), at = demi_d3_of(p->point);
    const demi_d3 lean = demi_d3_sub(demi_d3_scale(part->force, unit), n);
    const demi_d3 own = demi_d3_sub(part->torque, demi_d3_cross(at, part->force));
    const demi_d3 turn = demi_d3_plus(demi_d3_scale(own, unit), -(double)p->couple, n);
    int k;
    for (k = 0; k < 4; k++) {
        t[k].wall = part->wall;
        t[k].rank = rank;
        t[k].part = (dem_real)phi;
        t[k].share *= (dem_real)phi;
        t[k].shift = part->shift;
        t[k].lean = demi_rotate(R, demi_d3_real(lean));
        t[k].turn = demi_rotate(R, demi_d3_real(turn));
    }
}
/* Writes the contact points of all groups, found in a frame of axes R, in which the part is given.
   Returns their number. */
static int demi_flats_places(const demi_view *v, const demi_flats *f, const dem_real *R,
                             const demi_part *part, demi_touching *out) {
    const double r = demi_part_equal(part);
    double shared = 0, force = 0, overlap;
    demi_patch p;
    int i, k, e, count = 0;
    for (i = 0; i < f->count; i++) {
        shared += f->press[i].shared;
        force += demi_d3_length(f->press[i].force);
    }
    overlap = shared > 0 ? demi_shared_overlap(shared, r) : 0;
    for (i = 0; i < f->count && overlap > 0; i++) {
        const demi_flats_wall *own = f->part, *first = 0;
        double weight = 0;
        int rank = 0;
        if (!demi_pressure_patch(&f->press[i], &part->q, 0, &p)) continue;
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
            t->shift = f->shift[i];
            t->part = 0;
        }
        for (e = 0; e < f->walls; e++)
            if (own[e].group == i) weight += demi_d3_length(own[e].force);
        for (e = 0; e < f->walls; e++) {
            if (own[e].group != i || !(demi_d3_length(own[e].force) > 0)) continue;
            if (!first) { first = &own[e]; continue; }
            memcpy(&out[count], &out[count - 4*(++rank)], 4*sizeof *out);
            demi_flats_divide(&own[e], &p, weight, R, rank, &out[count]);
            count += 4;
        }
        if (rank) demi_flats_divide(first, &p, weight, R, 0, &out[count - 4*(rank + 1)]);
    }
    return count;
}
/* Writes the corners of an element, about an origin in the frame of the wall, and returns their
   number. A line of a profile, which extends along z, gets a third corner above its first, so that
   it has the normal of a triangle. */
static int demi_facet_corners(const demi_wall *wall, int element, dem_vec3 origin, demi_d3 *x) {
    const int corners = demi_wall_kinds[wall->kind].corners;
    dem_vec3 y[3];
    int i;
    demi_wall_corners(wall, element, y);
    for (i = 0; i < corners; i++) x[i] = demi_d3_of(demi_sub(y[i], origin));
    if (corners == 3) return 3;
    x[0].z = x[1].z = 0;
    x[2] = demi_d(x[0].x, x[0].y, 1);
    return 2;
}
/* Writes the sides of an element as half spaces and its plane as n and at, with n along (way < 0:
   against) the normal by the order of its corners. Returns the number of sides; 0: it is too thin.
   origin: of the axes, in the frame of the wall. */
static int demi_facet_sides(const demi_wall *wall, int element, dem_vec3 origin, int way,
                            demi_d3 *n, double *at, demi_half *sides) {
    demi_d3 x[3], up;
    const int corners = demi_facet_corners(wall, element, origin, x);
    int i;
    up = demi_d3_normal(x[0], x[1], x[2]);
    for (i = 0; i < corners; i++) {
        const demi_d3 e = demi_d3_sub(x[(i + 1)%corners], x[i]);
        sides[i].n = corners == 2 ? e : demi_d3_cross(up, e);   /* a line extends along z */
        sides[i].o = x[i];
    }
    if (!(demi_d3_length(up) > 0)) return 0;
    *n = demi_d3_scale(demi_d3_unit(up), way < 0 ? -1 : 1);
    *at = demi_d3_dot(*n, x[0]);
    return corners;
}
/* --- gaps between a polyhedron and walls, and the contact points: for impulses, and for laws with
   a range while there is no pressure --- */

enum { DEMI_GAP_POINTS = 24 };                  /* largest number of points in a group */
/* Points near one wall with similar normals. */
typedef struct demi_gap_group {
    int count;
    int32_t element[DEMI_GAP_POINTS];
    demi_d3 x[DEMI_GAP_POINTS], n[DEMI_GAP_POINTS];
    dem_vec3 shift[DEMI_GAP_POINTS];           /* m, image of the body */
    double gap[DEMI_GAP_POINTS];
} demi_gap_group;
/* All groups of points near one surface. Points with gaps of `range` (m) or more are ignored. */
typedef struct demi_gaps {
    int count, flat;               /* flat: only normals within 60 degrees of z (plates) */
    double range;
    dem_vec3 now;                  /* m, shift of the image that is examined */
    demi_gap_group group[DEMI_FLATS];
} demi_gaps;
/* Reduces a group to the four points that matter. */
static void demi_gap_group_pick(demi_gap_group *g) {
    const demi_gap_group all = *g;
    int picked[4], i;
    g->count = demi_spots_pick(g->x, g->gap, g->count, g->n[0], picked);
    for (i = 0; i < g->count; i++) {
        g->x[i] = all.x[picked[i]];
        g->n[i] = all.n[picked[i]];
        g->gap[i] = all.gap[picked[i]];
        g->shift[i] = all.shift[picked[i]];
        g->element[i] = all.element[picked[i]];
    }
}
/* Adds a point x with its gap. n: unit, from the polyhedron into the wall. */
static void demi_gaps_add(demi_gaps *gaps, int32_t element, demi_d3 n, demi_d3 x, double gap) {
    demi_gap_group *g;
    double most = -2;
    int i, best = 0;
    if (!(gap < gaps->range) || (gaps->flat && fabs(n.z) < 0.5)) return;
    for (i = 0; i < gaps->count; i++) {
        const double along = demi_d3_dot(gaps->group[i].n[0], n);
        if (along > most) { most = along; best = i; }
    }
    if (most < 0.95 && gaps->count < DEMI_FLATS) {
        best = gaps->count++;
        gaps->group[best].count = 0;
    }
    g = &gaps->group[best];
    if (g->count == DEMI_GAP_POINTS) demi_gap_group_pick(g);
    g->x[g->count] = x;
    g->n[g->count] = n;
    g->shift[g->count] = gaps->now;
    g->element[g->count] = element;
    g->gap[g->count++] = gap;
}
/* Adds the corners above the plane z = 0 of the frame of the wall. height: of the origin above
   it. */
static void demi_plane_gaps(const demi_solid *s, double height, demi_gaps *gaps) {
    int i;
    for (i = 0; i < s->corners; i++) {
        const demi_d3 c = s->corner[i];
        const double gap = c.z + height;
        demi_gaps_add(gaps, 0, demi_d(0, 0, -1), demi_d(c.x, c.y, c.z - gap/2), gap);
    }
}
/* Makes a flat body of a facet: a triangle, or the rectangle that a profile's line sweeps from
   reach below to reach above the origin. Returns 0 if it is too thin. */
static int demi_facet_solid(const demi_wall *wall, int element, dem_vec3 origin, double reach,
                            demi_solid *f) {
    static const int32_t triangle[9] = {0, 3, 6, 0, 1, 2, 0, 2, 1};
    static const int32_t strip[11] = {0, 4, 8, 0, 1, 2, 3, 0, 3, 2, 1};
    demi_d3 x[3], up;
    const int line = demi_facet_corners(wall, element, origin, x) == 2;
    int i;
    f->faces = 2;
    f->corners = line ? 4 : 3;
    f->rim = line ? strip : triangle;
    f->centre = demi_d(0, 0, 0);
    for (i = 0; i < f->corners; i++) {
        demi_d3 *c = &f->corner[i];
        *c = x[line ? i == 1 || i == 2 : i];
        if (line) c->z = i < 2 ? -reach : reach;
        f->centre = demi_d3_add(f->centre, demi_d3_over(*c, f->corners));
    }
    up = demi_d3_normal(f->corner[0], f->corner[1], f->corner[2]);
    if (!(demi_d3_length(up) > 0)) return 0;
    f->face[0].slope = demi_d3_unit(up);
    f->face[1].slope = demi_d3_scale(f->face[0].slope, -1);
    f->face[0].high = f->face[1].high = 1;      /* unit normals suffice here */
    return 1;
}
/* True if an edge or corner of a facet (own: its `owns` corners) is really the nearest point of the
   surface. It is not if another facet with the same edge or corner continues towards the body; that
   facet then gives the gap. n: unit, from the body; start: all facets near it; x: the body, in the
   image of this facet. */
static int demi_facet_nearest(const demi_view *start, dem_vec3 x, const dem_vec3 *own, int owns,
                              demi_d3 n) {
    const demi_wall *wall = start->wall;
    const dem_real same = 2*wall->plane_slack;  /* m: images differ by rounding */
    demi_view v = *start;
    int i, k, e;
    while (demi_view_next(&v)) for (i = 0; i < v.count; i++) {
        dem_vec3 y[3];
        const int corners = demi_wall_corners(wall, v.element[i], y);
        int has[3] = {0, 0, 0}, all = 0;
        for (k = 0; k < corners; k++) {
            y[k] = demi_add(y[k], demi_sub(x, v.x));
            for (e = 0; e < owns && !has[k]; e++)
                all += has[k] = !(demi_length(demi_sub(y[k], own[e])) > same);
        }
        if (all < owns) continue;
        for (k = 0; k < corners; k++) {
            dem_vec3 way = demi_sub(y[k], own[0]);
            if (has[k]) continue;
            if (owns == 2) {                    /* across the edge */
                const dem_vec3 edge = demi_unit(demi_sub(own[1], own[0]));
                way = demi_sub(way, demi_scale(edge, demi_dot(way, edge)));
            }
            if (-demi_d3_dot(n, demi_d3_of(way)) > 1e-9*(double)demi_length(way)) return 0;
        }
    }
    return 1;
}
/* True if q, from the centre of the body, is on a facet with the normal n, of either sign. */
static int demi_facets_have(const demi_view *start, demi_d3 n, demi_d3 q, double near) {
    demi_view v = *start;
    demi_half sides[3];
    demi_d3 up;
    double at;
    int i, k, count;
    while (demi_view_next(&v)) for (i = 0; i < v.count; i++) {
        const dem_real *plane = v.wall->planes + 4*v.element[i];
        if (!(fabs(demi_d3_dot(n, demi_d3_of(demi_at(plane)))) > 1 - 1e-9)) continue;
        count = demi_facet_sides(v.wall, v.element[i], v.x, 1, &up, &at, sides);
        if (!count || fabs(demi_d3_dot(up, q) - at) > near) continue;
        for (k = 0; k < count; k++)
            if (demi_d3_dot(demi_d3_unit(sides[k].n), demi_d3_sub(q, sides[k].o)) < -near) break;
        if (k == count) return 1;
    }
    return 0;
}
/* True if q, in the plane of a facet, is on sides of it beyond which other facets continue its
   plane: a point of a seam, where the surface has no edge. */
static int demi_facet_seam(const demi_view *start, const demi_view *v, int element, demi_d3 q,
                           double near) {
    demi_half sides[3];
    demi_d3 n;
    double at;
    const int count = demi_facet_sides(v->wall, element, v->x, 1, &n, &at, sides);
    int k, on = 0;
    for (k = 0; k < count; k++) {
        const demi_d3 in = demi_d3_unit(sides[k].n);
        if (demi_d3_dot(in, demi_d3_sub(q, sides[k].o)) > near) continue;
        on = 1;
        if (!demi_facets_have(start, n, demi_d3_plus(q, -10*near, in), near)) return 0;
    }
    return on;
}
/* Adds the points of a body above a face of a facet, with gaps from its plane: corners of the body,
   and points above sides of the facet that are no seams. Thus the division of a floor into facets
   changes nothing. Returns the number of points within range, those of seams included. */
static int demi_facet_points(const demi_view *start, const demi_view *v, int element,
                             const demi_solid *s, const demi_solid *f, int side, demi_gaps *gaps) {
    demi_d3 x[DEMI_SECTION], up;
    double gap[DEMI_SECTION];
    const double near = DEMI_TOUCHING*demi_solid_radius(s) + (double)v->wall->plane_slack;
    int count = demi_faces_over(f, side, s, x, gap, &up), face = count, i, k, e, some = 0;
    for (k = 0; k < s->corners && count < DEMI_SECTION; k++) {     /* those of other faces */
        const demi_d3 c = s->corner[k];
        gap[count] = demi_d3_dot(up, demi_d3_sub(c, f->corner[0]));
        x[count] = demi_d3_plus(c, -gap[count]/2, up);
        if (!(gap[count] < gaps->range)) continue;
        for (i = 0; i < face; i++)
            if (!(demi_d3_length(demi_d3_sub(x[i], x[count])) > near)) break;
        if (i < face) continue;
        for (e = f->rim[side]; e < f->rim[side + 1]; e++) {
            const demi_d3 o = demi_solid_corner(f, side, e);
            const demi_d3 to = demi_d3_sub(demi_solid_corner(f, side, e + 1), o);
            if (demi_d3_dot(demi_d3_cross(up, to), demi_d3_sub(c, o)) < 0) break;
        }
        count += e == f->rim[side + 1];
    }
    for (i = 0; i < count; i++) {
        const demi_d3 c = demi_d3_plus(x[i], gap[i]/2, up);
        if (!(gap[i] < gaps->range)) continue;
        some++;
        for (k = 0; k < s->corners && i < face; k++)
            if (!(demi_d3_length(demi_d3_sub(s->corner[k], c)) > near)) break;
        if (k < s->corners || i >= face ||
            !demi_facet_seam(start, v, element, demi_d3_plus(c, -gap[i], up), near))
            demi_gaps_add(gaps, element + v->base, demi_d3_scale(up, -1), x[i], gap[i]);
    }
    return some;
}
/* False if all corners of a body about x are at least `range` (m) from the plane of an element, on
   the side of x. */
static int demi_facet_in_reach(const demi_wall *wall, int element, dem_vec3 x, const demi_solid *s,
                               double range) {
    const demi_d3 n = demi_d3_of(demi_at(wall->planes + 4*element));
    const double off = demi_d3_dot(n, demi_d3_of(x)) - (double)wall->planes[4*element + 3];
    const double way = off < 0 ? 1 : -1;
    const int far = demi_solid_far(s, demi_d3_scale(n, way));
    return !(-way*off - demi_d3_dot(demi_d3_scale(n, way), s->corner[far]) > range +
             (double)wall->plane_slack);
}
/* Adds the gaps of one facet. start: all facets nearby; v: those of this image. Beside an edge at
   which the surface continues towards the body, the shortest separation is not that of the surface,
   and would lead across that edge if the body is slightly inside. The facet is then treated as
   infinite, for laws with a range only if the body is inside. */
static void demi_element_gaps(const demi_view *start, const demi_view *v, int element,
                              const demi_solid *s, double reach, demi_gaps *gaps) {
    const demi_wall *wall = v->wall;
    demi_simplex tells;
    demi_solid f;
    demi_spots spots;
    demi_d3 n = demi_d(0, 0, 0);
    dem_vec3 y[3], own[3];
    double gap, along;
    int i, k, owns = 0, has[3] = {0, 0, 0};
    if (!demi_facet_in_reach(wall, element, v->x, s, gaps->range) ||
        !demi_facet_solid(wall, element, v->x, reach, &f)) return;
    gap = demi_solids_gap(s, &f, gaps->range, &n, &tells);
    if (!(gap < gaps->range)) return;
    along = demi_d3_dot(n, f.face[0].slope);
    if (fabs(along) >= DEMI_FLUSH && demi_facet_points(start, v, element, s, &f, along > 0, gaps))
        return;
    demi_solids_manifold(s, &f, 1, gaps->range, gap, n, &tells, &spots);
    if (fabs(along) < DEMI_FLUSH) {
        const int strip = f.corners == 4;       /* two of its corners are one of the profile */
        demi_wall_corners(wall, element, y);
        for (i = 0; i < tells.count; i++) {
            k = tells.at[i].b;
            if (!(tells.part[i] > 0)) continue;
            k = strip ? k == 1 || k == 2 : k;
            if (!has[k]) own[owns++] = y[k];
            has[k] = 1;
        }
        if (owns < (strip ? 2 : 3) && !demi_facet_nearest(start, v->x, own, owns, spots.normal)) {
            if (spots.gap[0] < 0 || !demi_response_is(start->w, DEMI_PRESSING))
                demi_facet_points(start, v, element, s, &f,
                                  demi_d3_dot(f.face[0].slope, f.corner[0]) > 0, gaps);
            return;
        }
    }
    for (i = 0; i < spots.count; i++)
        demi_gaps_add(gaps, element + v->base, spots.normal, spots.x[i], spots.gap[i]);
}
/* Writes the contact points of all groups: with impulses the four of each direction that matter;
   for a law with a range the nearest one of each direction without pressure (demi_spots_nearest),
   four times. pressed: the number of contact points before `out`. Returns the number written. */
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
        if (pressing)
            nearest = demi_spots_nearest(g->x, g->gap, g->count, 1e-3*(double)demi_part_thin(part));
        for (k = 0; k < places; k++) {
            demi_touching *t = &out[count];
            e = pressing ? nearest : k;
            memset(t, 0, sizeof *t);
            t->element = g->element[e];
            t->corner = k;
            t->corners = places;
            t->overlap = (dem_real)-g->gap[e];
            t->share = v->wall->share/(dem_real)places;
            t->slope = 1;
            t->deep = t->overlap/demi_part_thin(part);
            t->normal = demi_rotate(R, demi_d3_real(g->n[e]));
            t->point = demi_add(v->at, demi_rotate(R, demi_d3_real(g->x[e])));
            t->shift = g->shift[e];
            for (e = 1; e <= pressed; e++)
                if (demi_dot(out[-e].normal, t->normal) > DEM_R(0.95)) break;
            /* at gap 0 nothing presses, but a law with a range is called */
            if (e <= pressed || (pressing &&
                                 !(t->overlap < (dem_real)DEMI_TOUCHING*demi_part_thin(part))))
                break;
            if (pressing) t->overlap = DEMI_MIN(t->overlap, 0);
            count++;
        }
    }
    return count;
}
/* Writes the contact points by pressure and by gaps. */
static int demi_wall_places(const demi_view *v, const demi_flats *flats, demi_gaps *gaps,
                            const dem_real *R, const demi_part *part, demi_touching *out) {
    const int pressed = demi_flats_places(v, flats, R, part, out);
    return pressed + demi_gaps_places(v, gaps, R, part, pressed, out + pressed);
}
/* The sheets of a surface near a body (>>sheets), and the side on which each acts: that of the
   body's centre as seen from the nearest facet or, if several are equally near (at an edge), from
   the one that it is highest above. The slope behind a ridge is thus also seen from outside where a
   body overlaps it. For a sheet that ends near the body see demi_sheets_press. */
enum { DEMI_SHEETS = 16 };
typedef struct demi_sheets {
    int count;
    int32_t sheet[DEMI_SHEETS];
    int image[DEMI_SHEETS];        /* number of the image; 0 if the surface continues there */
    int way[DEMI_SHEETS];          /* of the normal into the wall, at the first facet */
    int ends[DEMI_SHEETS];         /* does it end near the body? */
    double near2[DEMI_SHEETS], over[DEMI_SHEETS];      /* m2, squared distance; m, height */
} demi_sheets;
DEM_INLINE int32_t demi_sheet_of(const demi_wall *wall, int element) {
    const int32_t own = wall->sheet[element];
    return own < 0 ? -own : own;
}
/* The index of an element's sheet, as seen in an image; the number of sheets if it is not in the
   list. */
static int demi_sheets_which(const demi_sheets *s, const demi_wall *wall, int element, int image) {
    const int32_t sheet = demi_sheet_of(wall, element);
    int i;
    for (i = 0; i < s->count; i++)
        if (s->sheet[i] == sheet && (wall->wraps || s->image[i] == image)) break;
    return i;
}
/* Adds an element to its sheet. within: radius of the body, m. */
static void demi_sheets_add(demi_sheets *s, const demi_wall *wall, int element, int image,
                            dem_vec3 origin, double within) {
    const int open = wall->ends[element];
    double part[3] = {0, 0, 0}, d2, over;
    demi_d3 x[3], up;
    const int corners = demi_facet_corners(wall, element, origin, x);
    int i, k;
    up = demi_d3_normal(x[0], x[1], x[2]);
    if (!(demi_d3_length(up) > 0)) return;
    if (corners == 3) demi_near_triangle(x[0], x[1], x[2], part);
    else demi_near_segment(x[0], x[1], part);
    d2 = demi_d3_square(demi_triangle_point(part, x[0], x[1], x[2]));
    over = demi_d3_dot(demi_d3_unit(up), x[0])*(wall->sheet[element] < 0 ? -1 : 1);
    i = demi_sheets_which(s, wall, element, image);
    if (i == DEMI_SHEETS) return;
    if (i == s->count) s->ends[s->count++] = 0;
    else if (d2 > s->near2[i]*(1 + 1e-9) ||
             (d2 > s->near2[i]*(1 - 1e-9) && !(fabs(over) > fabs(s->over[i])))) d2 = -1;
    for (k = 0; k < corners && !s->ends[i]; k++)
        s->ends[i] = open >> k & 1 &&
            demi_near_segment(x[k], x[corners == 3 ? (k + 1)%3 : k], part) < within*within;
    if (d2 < 0) return;
    s->sheet[i] = demi_sheet_of(wall, element);
    s->image[i] = image;
    s->near2[i] = d2;
    s->over[i] = over;
    s->way[i] = over < 0 ? -1 : 1;
}
/* The direction of an element's normal; x: of the body, for sheets that are not in the list. */
static int demi_sheets_way(const demi_sheets *s, const demi_wall *wall, int element, int image,
                           dem_vec3 x) {
    const dem_real *plane = wall->planes + 4*element;
    const int i = demi_sheets_which(s, wall, element, image);
    if (i < s->count) return wall->sheet[element] < 0 ? -s->way[i] : s->way[i];
    return plane[3] - demi_dot(demi_at(plane), x) < 0 ? -1 : 1;
}
/* True if the plane of an element is farther from x than `within`, m. */
DEM_INLINE int demi_element_far(const demi_wall *wall, int element, dem_vec3 x, dem_real within) {
    const dem_real *plane = wall->planes ? wall->planes + 4*element : 0;
    return plane && DEMI_ABS(demi_dot(demi_at(plane), x) - plane[3]) > within + wall->plane_slack;
}
/* Sets the pressure of one element on a polyhedron about the origin. way: direction of its
   normal. */
static void demi_solid_on_element(const demi_wall *wall, int element, const demi_solid *s,
                                  dem_vec3 x, int way, demi_pressure *press) {
    demi_half sides[3];
    demi_d3 n;
    double at;
    int count;
    memset(press, 0, sizeof *press);
    if (wall->kind == DEMI_WALL_PLANE)
        demi_solid_on_flat(s, demi_d(0, 0, -1), (double)x.z, 0, 0, 0, press);
    else if ((count = demi_facet_sides(wall, element, x, way, &n, &at, sides)) != 0)
        demi_solid_on_flat(s, n, at, sides, count, 0, press);
}
/* The elements of one sheet near a body, seen from one side. way: direction of the normal at the
   sheet's first facet; within: radius of the body, m; start: all elements near the body. */
typedef struct demi_sheet {
    const demi_view *start;
    const demi_wall *wall;
    dem_real within;
    int way, image;
    int32_t sheet;
} demi_sheet;
/* Returns the direction of the normal of element i of an image, or 0 if it does not belong to the
   sheet. */
DEM_INLINE int demi_sheet_turn(const demi_sheet *t, const demi_view *v, int i, int image) {
    const int element = v->element[i];
    if (v->gap[i] > v->gone || demi_sheet_of(t->wall, element) != t->sheet) return 0;
    if (!t->wall->wraps && image != t->image) return 0;
    return t->wall->sheet[element] < 0 ? -t->way : t->way;
}
/* Returns the mean normals of the sheet at both corners of a side, or null if it does not end
   there. */
static const demi_border *demi_facet_border(const demi_wall *wall, int32_t side) {
    int lo = 0, hi = wall->border_count;
    while (lo < hi) {
        const int mid = (lo + hi)/2;
        if (wall->borders[mid].side < side) lo = mid + 1;
        else hi = mid;
    }
    return lo < wall->border_count && wall->borders[lo].side == side ? &wall->borders[lo] : 0;
}
/* Adds half of the curtain of a side, from its corner at o to its midpoint c, extending along m.
   way: along the side, so that m x way is the normal of the curtain. */
static void demi_curtain_half(const demi_solid *s, demi_d3 o, demi_d3 c, demi_d3 m, demi_d3 way,
                              demi_pressure *press) {
    const demi_d3 e = demi_d3_sub(c, o), n = demi_d3_unit(demi_d3_cross(m, way));
    const double along = demi_d3_dot(e, m), size = demi_d3_square(e);
    demi_half by[3];
    if (!(demi_d3_square(n) > 0)) return;
    by[0].n = demi_d3_plus(m, -along/size, e);
    by[1].n = demi_d3_plus(e, -along, m);
    by[2].n = demi_d3_scale(by[1].n, -1);
    by[0].o = by[1].o = o;
    by[2].o = c;
    demi_solid_on_flat(s, n, demi_d3_dot(n, o), by, 3, 0, press);
}
/* Adds what is missing between both halves at the midpoint of a side, if the sheet's normals differ
   at its corners (a before, b behind): the sector between lines along both. */
static void demi_curtain_fold(const demi_solid *s, demi_d3 c, demi_d3 a, demi_d3 b,
                              demi_pressure *press) {
    const demi_d3 across = demi_d3_cross(a, b), n = demi_d3_unit(across);
    const double along = demi_d3_dot(a, b);
    demi_half by[2];
    if (!(demi_d3_length(across) > 1e-9)) return;
    by[0].n = demi_d3_plus(b, -along, a);
    by[1].n = demi_d3_plus(a, -along, b);
    by[0].o = by[1].o = c;
    demi_solid_on_flat(s, n, demi_d3_dot(n, c), by, 2, 0, press);
}
/* True if the curtain at a side (3*element + side) extends above the plane of its element (normal
   n), as happens where the sheet is sharply folded. */
static int demi_curtain_bends(const demi_sheet *t, int32_t side, demi_d3 n) {
    const demi_border *mean = demi_facet_border(t->wall, side);
    const dem_vec3 up = demi_d3_real(n);
    return mean && (demi_dot(mean->normal[0], up)*(dem_real)t->way < 0 ||
                    demi_dot(mean->normal[1], up)*(dem_real)t->way < 0);
}
/* Sets the pressure of the curtain at a side (3*element + side) where its sheet ends. The curtain
   extends from there along the sheet's normal without end. The volume behind the sheet and within
   its curtains is closed and does not change as the body moves, so energy is conserved. n: the
   element's normal. */
static void demi_sheet_curtain(const demi_sheet *t, int32_t side, const demi_half *sides,
                               demi_d3 n, const demi_solid *s, demi_pressure *press) {
    const demi_half *end = sides + side%3, *next = sides + (side + 1)%3;
    const demi_d3 in = demi_d3_unit(end->n), way = demi_d3_cross(in, n);       /* n x way = in */
    const demi_border *mean;
    demi_d3 m[2], c;
    int q;
    memset(press, 0, sizeof *press);
    if (demi_wall_per(t->wall) == 2) {
        demi_half by;
        by.n = n;
        by.o = end->o;
        demi_solid_on_flat(s, in, demi_d3_dot(in, by.o), &by, 1, 0, press);
        return;
    }
    mean = demi_facet_border(t->wall, side);
    if (!mean) return;
    for (q = 0; q < 2; q++)
        m[q] = demi_d3_of(demi_scale(mean->normal[q], (dem_real)t->way));
    c = demi_d3_scale(demi_d3_add(end->o, next->o), 0.5);
    demi_curtain_half(s, end->o, c, m[0], way, press);
    demi_curtain_half(s, next->o, c, m[1], way, press);
    q = demi_d3_dot(way, demi_d3_sub(next->o, end->o)) < 0;    /* from which corner to which */
    demi_curtain_fold(s, c, m[q], m[!q], press);
}
/* Adds all of a sheet with its curtains. */
static void demi_sheet_seen(const demi_sheet *t, const demi_solid *s, demi_flats *flats) {
    demi_view v = *t->start;
    demi_pressure press;
    demi_half sides[3];
    demi_d3 n;
    double at;
    int i, k, count, ends, beyond, image = 0;
    for (; demi_view_next(&v); image++) for (i = 0; i < v.count; i++) {
        const int element = v.element[i], way = demi_sheet_turn(t, &v, i, image);
        if (!way || demi_element_far(t->wall, element, v.x, t->within)) continue;
        count = demi_facet_sides(t->wall, element, v.x, way, &n, &at, sides);
        if (!count) continue;
        flats->now = v.shift;
        ends = t->wall->ends[element];
        beyond = demi_d3_dot(n, s->corner[demi_solid_far(s, n)]) > at;
        memset(&press, 0, sizeof press);
        if (beyond) demi_solid_on_flat(s, n, at, sides, count, 0, &press);
        if (beyond) demi_flats_add(flats, element + v.base, &press);
        for (k = 0; k < count; k++) {
            if (!(ends >> k & 1) || !(beyond || demi_curtain_bends(t, 3*element + k, n))) continue;
            demi_sheet_curtain(t, 3*element + k, sides, n, s, &press);
            demi_flats_add(flats, element + v.base, &press);
        }
    }
}
/* Adds sheets that end near the body. The common volume is that of the body and the fixed solid
   behind the sheet and its curtains, so the force has an energy. There is such a solid on either
   side; the one with less of the body counts. A body that does not touch the sheet has nothing in
   one of them. */
static void demi_sheets_press(const demi_sheets *sheets, demi_sheet *t, const demi_solid *s,
                              demi_flats *flats) {
    demi_flats seen[2];
    int i, k;
    for (i = 0; i < sheets->count; i++) {
        if (!sheets->ends[i]) continue;
        t->sheet = sheets->sheet[i];
        t->image = sheets->image[i];
        for (k = 0; k < 2; k++) {
            t->way = k ? -sheets->way[i] : sheets->way[i];
            demi_flats_begin(&seen[k], t->start);
            if (!k || seen[0].count) demi_sheet_seen(t, s, &seen[k]);
        }
        demi_flats_sides(seen, flats);
    }
}
/* A polyhedron and any wall of flat elements. */
static int demi_flat_polyhedron(const demi_view *start, const demi_part *part, demi_touching *out) {
    demi_view v;
    const demi_wall *wall = start->wall;
    const demi_part local = demi_part_local(wall->pose.rotation, part);
    const int pressing = demi_response_is(start->w, DEMI_PRESSING);
    demi_flats flats;
    demi_gaps gaps;
    demi_pressure press;
    demi_sheets sheets;
    demi_sheet sheet;
    demi_solid s;
    dem_vec3 n;
    int k, way, image;
    demi_flats_begin(&flats, start);
    gaps.range = (double)demi_range(start->w, part->radius);
    gaps.flat = gaps.count = sheets.count = 0;
    sheet.start = start;
    sheet.wall = wall;
    sheet.within = part->radius*DEM_R(1.001);
    demi_solid_of(&local, demi_v(0, 0, 0), &s);
    for (v = *start, image = 0; wall->sheet && pressing && demi_view_next(&v); image++)
        for (k = 0; k < v.count; k++)
            if (!(v.gap[k] > v.gone) && !demi_element_far(wall, v.element[k], v.x, sheet.within))
                demi_sheets_add(&sheets, wall, v.element[k], image, v.x, (double)sheet.within);
    demi_sheets_press(&sheets, &sheet, &s, &flats);
    for (v = *start; pressing && wall->scale && demi_view_next(&v);)
        if (demi_tessellation_beyond(start->w, wall, v.x, &n)) {
            memset(&press, 0, sizeof press);
            demi_pressure_beyond(&s, demi_d3_of(n), &press);
            flats.count = flats.walls = 0;
            flats.now = v.shift;
            demi_flats_add(&flats, v.element[0], &press);
            return demi_wall_places(start, &flats, &gaps, wall->pose.rotation, &local, out);
        }
    for (v = *start, image = 0; demi_view_next(&v); image++) for (k = 0; k < v.count; k++) {
        const int32_t element = v.element[k];
        const int which = !pressing || !wall->sheet ? sheets.count
            : demi_sheets_which(&sheets, wall, element, image);
        if (v.gap[k] > v.gone ||
            demi_element_far(wall, element, v.x, sheet.within + (dem_real)gaps.range)) continue;
        flats.now = gaps.now = v.shift;
        if (pressing && (which == sheets.count || !sheets.ends[which])) {
            way = wall->sheet ? demi_sheets_way(&sheets, wall, element, image, v.x) : 1;
            demi_solid_on_element(wall, element, &s, v.x, way, &press);
            demi_flats_add(&flats, element + v.base, &press);
        }
        if (!(gaps.range > 0)) continue;
        if (wall->kind == DEMI_WALL_PLANE) demi_plane_gaps(&s, (double)v.x.z, &gaps);
        else demi_element_gaps(start, &v, element, &s, 2*(double)part->radius + gaps.range, &gaps);
    }
    return demi_wall_places(start, &flats, &gaps, wall->pose.rotation, &local, out);
}
/* A polyhedron and a wall of grains, each a sphere. */
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
        const demi_d3 c = demi_d3_of(ball);
        demi_d3 q;
        double off;
        demi_touching *t = &out[count];
        if (v.gap[k] > v.gone) continue;
        off = demi_solid_near(&s, c, &q);
        if (!(off < (double)(wall->radius + demi_range(v.w, part->radius)))) continue;
        memset(t, 0, sizeof *t);
        t->element = v.element[k];
        t->overlap = wall->radius - (dem_real)off;
        t->deep = t->overlap/wall->radius;
        t->share = wall->share;
        t->slope = 1;
        t->point = demi_add(v.at, demi_rotate(R, demi_d3_real(q)));
        t->normal = demi_d3_real(demi_d3_sub(c, q));
        t->normal = off < 0 || off > 0 ? demi_scale(demi_rotate(R, t->normal), (dem_real)(1/off))
                                       : demi_unit(demi_rotate(R, ball));
        t->shift = v.shift;
        count++;
    }
    return count;
}
