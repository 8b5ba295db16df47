/* ---------------------------------------------------------------------------------------------
   >>joins
   Facets of walls that move together, made into facets of one surface: corners at the same position
   become one, facets that coincide or cover each other in a plane are resolved, and facets are
   divided where corners of others lie on their sides. Before that: which walls move together, and
   how walls repeat in a periodic world. >>surfaces makes the surfaces. Owns the numbers of walls
   that say how they repeat; a demi_join exists only while a surface is made.
   --------------------------------------------------------------------------------------------- */

/* --- periodic images of walls. A wall that is not longer than the period along a periodic axis
   repeats there: it is searched for at the images of bodies and, where it ends exactly where its
   image begins, the two are one surface. A longer wall represents all its images and must extend
   beyond both faces by a grain. Infinite walls are their own images. --- */
static void demi_extent_add(dem_real *lo, dem_real *hi, dem_vec3 x, dem_real pad) {
    dem_real at[3];
    int k;
    demi_put(at, x);
    for (k = 0; k < 3; k++) {
        lo[k] = DEMI_MIN(lo[k], at[k] - pad);
        hi[k] = DEMI_MAX(hi[k], at[k] + pad);
    }
}
/* Sets the extent of a finite wall along the world axes, in its present pose. */
static void demi_wall_span(demi_wall *wall) {
    const dem_pose *p = &wall->pose;
    const dem_real pad = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : 0;
    const dem_real far = DEMI_SINGLE ? DEM_R(FLT_MAX) : (dem_real)DBL_MAX;
    dem_real lo[3] = {far, far, far}, hi[3] = {-far, -far, -far};
    int i;
    for (i = 0; i < wall->vertex_count; i++)
        demi_extent_add(lo, hi, demi_add(p->position, demi_rotate(p->rotation,
                                        demi_at(wall->vertices + 3*i))), pad);
    for (i = 0; i < wall->ring_count; i++) {
        const dem_vec3 n = demi_v(p->rotation[2], p->rotation[5], p->rotation[8]);
        const dem_vec3 x = demi_add(p->position, demi_scale(n, wall->ring_height[i]));
        const dem_vec3 out = demi_v(DEMI_SQRT(DEMI_MAX(1 - n.x*n.x, 0)),
                                    DEMI_SQRT(DEMI_MAX(1 - n.y*n.y, 0)),
                                    DEMI_SQRT(DEMI_MAX(1 - n.z*n.z, 0)));
        demi_extent_add(lo, hi, demi_add(x, demi_scale(out, wall->ring_radius[i])), 0);
        demi_extent_add(lo, hi, demi_sub(x, demi_scale(out, wall->ring_radius[i])), 0);
    }
    if (!wall->vertex_count && !wall->ring_count)
        demi_extent_add(lo, hi, p->position, wall->extent);
    if (demi_wall_is(wall, DEMI_DRAWN)) {
        lo[2] = -far/4;
        hi[2] = far/4;
    }
    memcpy(wall->span_lo, lo, sizeof lo);
    memcpy(wall->span_hi, hi, sizeof hi);
}
/* Lets joined surfaces follow the walls that they move with. */
static void demi_surfaces_follow(dem_world *w) {
    int i;
    for (i = 0; i < w->surface_count; i++) w->surfaces[i].pose = w->walls[w->surfaces[i].lead].pose;
}
/* Sets, for each wall, along which axes it repeats. A joined surface repeats as its walls did when
   it was made. */
static void demi_walls_repeat(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    w->repeating = 0;
    for (k = 0; k < 3; k++) w->wall_period[k] = p.period[k] > 0 ? p.period[k] : w->ring_period[k];
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        memset(wall->repeats, 0, sizeof wall->repeats);
        if (wall->kind == DEMI_WALL_NONE || wall->extent < 0) continue;
        if (!(w->wall_period[0] > 0 || w->wall_period[1] > 0 || w->wall_period[2] > 0)) continue;
        demi_wall_span(wall);
        for (k = 0; k < 3; k++) {
            const dem_real most = DEMI_MAX(DEMI_ABS(wall->span_lo[k]), DEMI_ABS(wall->span_hi[k]));
            const dem_real slack = 8*(dem_real)FLT_EPSILON*most;
            wall->repeats[k] = w->wall_period[k] > 0 &&
                wall->span_hi[k] - wall->span_lo[k] <= w->wall_period[k] + slack;
            w->repeating |= wall->repeats[k];
        }
    }
    demi_surfaces_follow(w);
    for (i = 0; i < w->surface_count; i++) {
        demi_wall *s = &w->surfaces[i];
        for (k = 0; k < 3; k++) w->repeating |= s->repeats[k];
        if (w->repeating) demi_wall_span(s);
    }
}
static dem_vec3 demi_wall_shift(const dem_world *w, int a, int b, int c) {
    return demi_v((dem_real)a*w->wall_period[0], (dem_real)b*w->wall_period[1],
                  (dem_real)c*w->wall_period[2]);
}

/* --- collecting --- */

/* The facets of the walls of a group while they are joined. Points are corners, one wall after the
   other, in the pose in which their motion began or, of a wall that moves alone, in its own frame,
   so that a restart finds the same; then the corners of periodic images that are near. */
typedef struct demi_join {
    int per;                       /* corners of a facet: 3 (meshes) or 2 (profiles) */
    int points, facets, sides, lead;
    int changed;                   /* facets were removed or divided */
    int alone;                     /* 1: no other wall is part of the group */
    double *x, *near_by;           /* points x 3, m; welding tolerance, m */
    demi_tree tree;                /* of points */
    int32_t *same;                 /* points: the first one at this position */
    int32_t *facet;                /* facets x 5: points of its corners, wall, and the closed shell
                                      that it is part of, or -1 */
    demi_side *side;
    int32_t *root;                 /* facets: a tree of those that are connected */
    unsigned char *mark;           /* facets, points: DEMI_JOIN_... */
} demi_join;
enum { DEMI_JOIN_OPEN = 1, DEMI_JOIN_PAIRED = 2, DEMI_JOIN_ANCHORED = 4, DEMI_JOIN_GONE = 8 };

static void demi_join_free(dem_world *w, demi_join *j) {
    demi_free(w, j->x);
    demi_free(w, j->near_by);
    demi_tree_free(w, &j->tree);
    demi_free(w, j->same);
    demi_free(w, j->facet);
    demi_free(w, j->side);
    demi_free(w, j->root);
    demi_free(w, j->mark);
}
/* True if a wall is part of a join: of this group, kind of facet, and axes along which it repeats.
   lead: the first such wall. */
static int demi_join_member(const dem_world *w, int wall, int lead, int per) {
    const demi_wall *m = &w->walls[wall];
    return demi_faceted(m) && m->group == w->walls[lead].group && per == demi_wall_per(m) &&
        !memcmp(m->repeats, w->walls[lead].repeats, sizeof m->repeats);
}
/* True if a wall stays at rest relative to its image along an axis: it does not turn, or only about
   this axis. A wall that a function moves counts as one that does not turn. */
static int demi_wall_keeps(const dem_world *w, const demi_wall *wall, int axis) {
    /* a surface has no table; it moves as its first wall */
    const dem_motion *m = demi_tabled(&wall->motion) && !wall->motion.table
        ? &w->walls[wall->lead].motion : &wall->motion;
    const dem_vec3 e = demi_v(axis == 0, axis == 1, axis == 2);
    int k, keeps = wall->repeats[axis];
    if (demi_wall_rests(wall)) return keeps;
    if (m->kind == DEM_MOTION_ROTATING)
        keeps = keeps && demi_length(demi_cross(demi_unit(m->axis), e)) <= DEM_R(1e-6);
    for (k = 0; k < m->table_count && demi_tabled(m); k++) {
        const dem_quat q = m->table[k].rotation;
        keeps = keeps && !(demi_length(demi_cross(demi_v(q.x, q.y, q.z), e)) > DEM_R(1e-6));
    }
    return keeps;
}
/* Sets *by, m, to the displacement of the n-th periodic image (0 .. 26; 13 is the wall itself).
   Returns 0 if the wall does not repeat there. */
static int demi_join_shift(const dem_world *w, const demi_wall *wall, int n, demi_d3 *by) {
    const int s[3] = {n%3 - 1, n/3%3 - 1, n/9 - 1};
    int k, use = n != 13;
    for (k = 0; k < 3; k++) use = use && (!s[k] || demi_wall_keeps(w, wall, k));
    *by = demi_d3_of(demi_wall_shift(w, s[0], s[1], s[2]));
    return use;
}
/* Adds, or counts if `fill` is 0, the corners of images within the box of the walls. Returns their
   number. */
static int demi_join_images(const dem_world *w, demi_join *j, int fill) {
    const demi_wall *wall = &w->walls[j->lead];
    double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300}, slack = 0;
    const int own = j->points;
    int i, k, n, count = 0;
    for (i = 0; i < own; i++)
        for (k = 0; k < 3; k++) {
            lo[k] = DEMI_MIN(lo[k], j->x[3*i + k]);
            hi[k] = DEMI_MAX(hi[k], j->x[3*i + k]);
            slack = DEMI_MAX(slack, 8*(double)FLT_EPSILON*fabs(j->x[3*i + k]));
        }
    for (n = 0; n < 27; n++) {
        demi_d3 by;
        if (!demi_join_shift(w, wall, n, &by)) continue;
        for (i = 0; i < own; i++) {
            double x[3];
            int near = 1;
            demi_d3_put(x, demi_d3_add(demi_d3_at(j->x + 3*i), by));
            for (k = 0; k < 3; k++) near = near && x[k] >= lo[k] - slack && x[k] <= hi[k] + slack;
            if (!near) continue;
            count++;
            if (!fill) continue;
            memcpy(j->x + 3*j->points, x, sizeof x);
            j->near_by[j->points++] = j->near_by[i];
        }
    }
    return count;
}
/* The pose in which the corners of a wall are joined. A wall that moves alone keeps its surface
   when it gets a new motion, so that its pose then does not count. */
static dem_pose demi_join_pose(const demi_join *j, const demi_wall *wall) {
    dem_pose pose = wall->home;
    if (!j->alone) return pose;
    if (!wall->repeats[0] && !wall->repeats[1] && !wall->repeats[2]) demi_pose_identity(&pose);
    pose.position = demi_v(0, 0, 0);
    return pose;
}
/* Collects the points and facets of all walls of a group. Returns 0 if memory ran out. */
static int demi_join_begin(dem_world *w, demi_join *j, int lead, int per) {
    size_t points = 0, facets = 0, images;
    int i, e, k, first = 0;
    memset(j, 0, sizeof *j);
    j->per = per;
    j->lead = lead;
    j->alone = 1;
    for (i = 0; i < w->wall_count; i++)
        if (i != lead && w->walls[i].kind != DEMI_WALL_NONE &&
            w->walls[i].group == w->walls[lead].group) j->alone = 0;
    for (i = lead; i < w->wall_count; i++) {
        if (!demi_join_member(w, i, lead, per)) continue;
        points += (size_t)w->walls[i].vertex_count;
        facets += (size_t)w->walls[i].element_count;
    }
    if (points > INT_MAX/8 || facets > INT_MAX/8) return 0;
    j->x = (double *)demi_alloc(w, points*3, sizeof(double));
    j->near_by = (double *)demi_alloc(w, points, sizeof(double));
    j->facet = (int32_t *)demi_alloc(w, facets*5, sizeof(int32_t));
    j->side = (demi_side *)demi_alloc(w, facets*3, sizeof(demi_side));
    j->root = (int32_t *)demi_alloc(w, facets, sizeof(int32_t));
    if (!j->x || !j->near_by || !j->facet || !j->side || !j->root) return 0;
    for (i = lead; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const dem_pose pose = demi_join_pose(j, wall);
        if (!demi_join_member(w, i, lead, per)) continue;
        for (k = 0; k < wall->vertex_count; k++)
            demi_d3_put(j->x + 3*j->points++, demi_d3_of(demi_add(pose.position,
                        demi_rotate(pose.rotation, demi_at(wall->vertices + 3*k)))));
        demi_near_by(j->x, wall, first, j->near_by);
        first += wall->vertex_count;
    }
    images = (size_t)demi_join_images(w, j, 0);
    if (images && (!demi_grow(w, DEMI_LOOSE, &j->x, sizeof(double), 3*(points + images)) ||
                   !demi_grow(w, DEMI_LOOSE, &j->near_by, sizeof(double), points + images)))
        return 0;
    demi_join_images(w, j, 1);
    points += images;
    j->same = (int32_t *)demi_alloc(w, points, sizeof(int32_t));
    j->mark = (unsigned char *)demi_alloc(w, DEMI_MAX(points, facets), 1);
    if (!j->same || !j->mark || !demi_tree_make(w, &j->tree, j->x, j->points)) return 0;
    demi_points_weld(&j->tree, j->near_by, j->same);
    for (i = lead, first = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, lead, per)) continue;
        for (e = 0; e < wall->element_count; e++) {
            int32_t *f = j->facet + 5*j->facets;
            for (k = 0; k < 3; k++)
                f[k] = k < per ? j->same[first + wall->corners[per*e + k]] : f[1];
            f[3] = i;
            j->facets += demi_facet_counts(j->x, j->near_by, f, per);
        }
        first += wall->vertex_count;
    }
    return 1;
}
/* Lists the sides of all facets (of profiles their ends), sorted by their points. */
static void demi_join_sides(demi_join *j) {
    int i, k;
    for (i = 0, j->sides = 0; i < j->facets; i++)
        for (k = 0; k < j->per; k++) {
            const int32_t *f = j->facet + 5*i;
            j->side[j->sides++] = demi_side_of(f[k], f[j->per == 3 ? (k + 1)%3 : k], i, k);
        }
    qsort(j->side, (size_t)j->sides, sizeof *j->side, demi_side_compare);
}
/* Returns the end of the run of sides with the same points that begins at i. */
static int demi_sides_end(const demi_side *side, int count, int i) {
    int end = i + 1;
    while (end < count && side[end].lo == side[i].lo && side[end].hi == side[i].hi) end++;
    return end;
}
/* +1 if a facet runs along its side from the lower to the higher point, or begins at this corner of
   a profile; otherwise -1. */
static int demi_join_sign(const demi_join *j, const demi_side *s) {
    return j->per == 2 ? 1 - 2*s->side : j->facet[5*s->facet + s->side] == s->lo ? 1 : -1;
}
static int32_t demi_join_root(demi_join *j, int32_t i) {
    while (j->root[i] != i) i = j->root[i] = j->root[j->root[i]];
    return i;
}
static void demi_join_unite(demi_join *j, int32_t a, int32_t b) {
    a = demi_join_root(j, a);
    b = demi_join_root(j, b);
    j->mark[DEMI_MIN(a, b)] |= j->mark[DEMI_MAX(a, b)] & (DEMI_JOIN_OPEN | DEMI_JOIN_ANCHORED);
    j->root[DEMI_MAX(a, b)] = DEMI_MIN(a, b);
}
/* A facet at a side: its angle about the side, rad, and whether the volume that it bounds begins
   there (1) or ends (0). */
typedef struct demi_leaf { double at; int facet, begins; } demi_leaf;
enum { DEMI_LEAVES = 64 };
/* Fills in a leaf. Where a volume ends as another one begins, as between boxes side by side, the
   end comes first. inside: the facets of the wall face their volume. */
static demi_leaf demi_leaf_of(const demi_join *j, const demi_side *s, int inside) {
    const int32_t *f = j->facet + 5*s->facet;
    const demi_d3 o = demi_d3_at(j->x + 3*s->lo);
    const demi_d3 e = j->per == 2 ? demi_d(0, 0, 1)
        : demi_d3_unit(demi_d3_sub(demi_d3_at(j->x + 3*s->hi), o));
    const demi_d3 u = j->per == 2 ? demi_d(1, 0, 0) : demi_d3_of(demi_across(demi_d3_real(e)));
    const int32_t tip = f[j->per == 2 ? 1 - s->side : (s->side + 2)%3];
    const demi_d3 d = demi_d3_sub(demi_d3_at(j->x + 3*tip), o);
    const double x = demi_d3_dot(u, d), y = demi_d3_dot(demi_d3_cross(e, u), d);
    const double slack = 1e-6 + 4*j->near_by[tip]/sqrt(x*x + y*y + 1e-300);
    demi_leaf leaf;
    leaf.facet = s->facet;
    leaf.begins = (demi_join_sign(j, s) > 0) == (j->per == 2 ? !inside : inside);
    leaf.at = demi_atan2(y, x) + (leaf.begins ? 1 : -1)*DEMI_MIN(slack, 1e-3);
    if (leaf.at < 0) leaf.at += 2*DEMI_PI;
    return leaf;
}
/* Unites the facets of one part at a side that bound the same volume there: around the side, the
   facet where it begins and the one where it ends. count: of the sides s, which may be of other
   parts, too. */
static void demi_join_around(demi_join *j, const demi_side *s, int count, const int32_t *part,
                             int own, int inside) {
    demi_leaf leaf[DEMI_LEAVES];
    int stack[DEMI_LEAVES], depth = 0, n = 0, i, k, first = -1;
    for (i = 0; i < count; i++) {
        demi_leaf one;
        if (part[s[i].facet] != own) continue;
        if (first < 0) first = s[i].facet;
        if (n == DEMI_LEAVES) {                 /* too many: one volume */
            for (k = 0; k < n; k++) demi_join_unite(j, first, leaf[k].facet);
            demi_join_unite(j, first, s[i].facet);
            continue;
        }
        one = demi_leaf_of(j, s + i, inside);
        for (k = n++; k > 0 && leaf[k - 1].at > one.at; k--) leaf[k] = leaf[k - 1];
        leaf[k] = one;
    }
    for (i = 0; i < 2*n; i++) {                 /* as parentheses match, around the side */
        const demi_leaf *at = leaf + i%n;
        if (at->begins && i < n) stack[depth++] = at->facet;
        else if (!at->begins && depth) demi_join_unite(j, stack[--depth], at->facet);
    }
}
/* Twice the area, or six times the volume, that a facet adds to what its wall bounds. */
static double demi_join_bounds(const demi_join *j, const int32_t *f, const int32_t *about) {
    const demi_d3 o = demi_d3_at(j->x + 3*about[0]);
    const demi_d3 a = demi_d3_sub(demi_d3_at(j->x + 3*f[0]), o);
    const demi_d3 b = demi_d3_sub(demi_d3_at(j->x + 3*f[1]), o), n = demi_d3_cross(a, b);
    return j->per == 2 ? demi_d3_dot(n, demi_d(0, 0, 1))
        : demi_d3_dot(n, demi_d3_sub(demi_d3_at(j->x + 3*f[2]), o));
}
/* Divides the facets of each part, a number of facets (-1: none), into shells that bound one volume
   each. Connected facets are open, and no shell, unless at each side as many of them run in one
   direction as in the other. bounds: room for a number of each facet. */
static void demi_join_part_shells(demi_join *j, const int32_t *part, double *bounds) {
    int i, k, m, end, many = 0;
    for (i = 0; i < j->facets; i++) { j->root[i] = i; j->mark[i] = 0; }
    for (i = 0; i < j->sides; i = end) {
        end = demi_sides_end(j->side, j->sides, i);
        for (k = i; k < end; k++) {
            const int own = part[j->side[k].facet];
            int sum = 0;
            for (m = i; m < end && own >= 0; m++) {
                if (part[j->side[m].facet] != own) continue;
                sum += demi_join_sign(j, &j->side[m]);
                demi_join_unite(j, j->side[k].facet, j->side[m].facet);
            }
            if (sum) j->mark[demi_join_root(j, j->side[k].facet)] |= DEMI_JOIN_OPEN;
        }
        many |= end - i > 2;
    }
    for (i = 0; i < j->facets; i++) {
        int32_t *f = j->facet + 5*i;
        if (part[i] < 0) continue;
        f[4] = demi_join_root(j, i);
        j->mark[i] |= j->mark[f[4]] & DEMI_JOIN_OPEN;
        bounds[i] = 0;
        bounds[f[4]] += demi_join_bounds(j, f, j->facet + 5*f[4]);
    }
    for (i = 0; i < j->facets && many; i++) j->root[i] = i;
    for (i = 0; i < j->sides && many; i = end) {
        end = demi_sides_end(j->side, j->sides, i);
        for (k = i; k < end; k++) {
            const int f = j->side[k].facet, own = part[f];
            for (m = i; m < k && part[j->side[m].facet] != own; m++) continue;
            if (m == k && own >= 0 && !(j->mark[f] & DEMI_JOIN_OPEN))
                demi_join_around(j, j->side + i, end - i, part, own, bounds[j->facet[5*f + 4]] < 0);
        }
    }
    for (i = 0; i < j->facets; i++)
        if (part[i] >= 0)
            j->facet[5*i + 4] = j->mark[i] & DEMI_JOIN_OPEN ? -1 : demi_join_root(j, i);
}
/* Finds the shells of each wall by itself, and then those of what is left open of all walls: a
   closed body may be divided among walls. Returns 0 if memory ran out. */
static int demi_join_volumes(dem_world *w, demi_join *j) {
    double *bounds = (double *)demi_alloc(w, (size_t)j->facets, sizeof *bounds);
    int32_t *part = (int32_t *)demi_alloc(w, (size_t)j->facets, sizeof *part);
    const int ok = bounds && part;
    int i, first = -1, several = 0;
    for (i = 0; i < j->facets && ok; i++) part[i] = j->facet[5*i + 3];
    if (ok) demi_join_part_shells(j, part, bounds);
    for (i = 0; i < j->facets && ok; i++) {
        const int32_t *f = j->facet + 5*i;
        part[i] = f[4] < 0 ? 0 : -1;
        if (f[4] < 0 && first < 0) first = f[3];
        several |= f[4] < 0 && f[3] != first;
    }
    if (ok && several) demi_join_part_shells(j, part, bounds);
    demi_free(w, bounds);
    demi_free(w, part);
    return ok;
}
/* True if a facet lies in a plane that is a wall of this group, and grains may touch its upper
   side: the plane then acts alone. A segment is a strip along z. */
static int demi_join_in_plane(const dem_world *w, const demi_join *j, int i) {
    const int32_t *f = j->facet + 5*i;
    int p, k;
    for (p = 0; p < w->wall_count; p++) {
        const demi_wall *plane = &w->walls[p];
        const dem_real *R = plane->home.rotation;
        const demi_d3 n = demi_d3_of(demi_v(R[2], R[5], R[8]));
        const demi_d3 o = demi_d3_of(plane->home.position);
        if (plane->kind != DEMI_WALL_PLANE || plane->group != w->walls[j->lead].group ||
            (j->per == 2 && fabs(n.z) > 1e-6)) continue;
        for (k = 0; k < j->per; k++)
            if (!(fabs(demi_d3_dot(n, demi_d3_sub(demi_d3_at(j->x + 3*f[k]), o))) <=
                  j->near_by[f[k]])) break;
        if (k == j->per && (f[4] < 0 || j->per == 2 || demi_d3_dot(n, demi_d3_normal(
            demi_d3_at(j->x + 3*f[0]), demi_d3_at(j->x + 3*f[1]), demi_d3_at(j->x + 3*f[2]))) > 0))
            return 1;
    }
    return 0;
}
/* The orientation of a facet relative to its corners in ascending order: +1 or -1. */
static int demi_facet_turn(const int32_t *f, int per) {
    if (per == 2) return f[0] < f[1] ? 1 : -1;
    return (f[0] < f[1]) + (f[1] < f[2]) + (f[2] < f[0]) == 2 ? 1 : -1;
}
/* Of facets that coincide, keeps the first. Where the boundaries of two closed bodies coincide with
   opposite orientations, as where two boxes stand side by side, nothing remains: there is no
   surface between them. A patch of such pairs counts only if at some side of it two other facets
   continue the surface. So a sheet that is given twice, in either winding, remains. Returns 0
   if memory ran out. */
static int demi_join_double(dem_world *w, demi_join *j) {
    demi_side *s = j->side;
    int i, k, m, end, left;
    demi_join_sides(j);
    if (!demi_join_volumes(w, j)) return 0;
    for (i = 0; i < j->facets; i++) {           /* facets by their corners */
        const int32_t *f = j->facet + 5*i, last = j->per == 3 ? f[2] : f[1];
        const int32_t lo = DEMI_MIN(f[0], DEMI_MIN(f[1], last));
        const int32_t hi = DEMI_MAX(f[0], DEMI_MAX(f[1], last));
        s[i] = demi_side_of(lo, hi, j->per == 3 ? f[0] + f[1] + f[2] - lo - hi : 0, i);
        j->root[i] = i;
    }
    qsort(s, (size_t)j->facets, sizeof *s, demi_side_compare);
    for (i = 0; i < j->facets; i = end) {
        int turns = 0, way[2] = {0, 0};
        for (end = i; end < j->facets && s[end].lo == s[i].lo && s[end].hi == s[i].hi &&
             s[end].facet == s[i].facet; end++) {
            const int f = s[end].side;
            if (end > i) j->mark[f] |= DEMI_JOIN_GONE;
            if (!(j->mark[f] & DEMI_JOIN_OPEN)) way[demi_facet_turn(j->facet + 5*f, j->per) > 0]++;
        }
        turns = end - i == 2 && way[0] == 1 && way[1] == 1;
        for (k = i; k < end && turns; k++) j->mark[s[k].side] |= DEMI_JOIN_PAIRED;
    }
    demi_join_sides(j);
    for (i = 0; i < j->sides; i = end) {        /* patches of pairs, and what continues at them */
        int first = -1, beside = 0;
        end = demi_sides_end(s, j->sides, i);
        for (k = i; k < end; k++) {
            const unsigned char mark = j->mark[s[k].facet];
            if (!(mark & DEMI_JOIN_PAIRED)) beside += !(mark & DEMI_JOIN_GONE);
            else if (first < 0) first = s[k].facet;
            else demi_join_unite(j, first, s[k].facet);
        }
        if (first >= 0 && beside > 1) j->mark[demi_join_root(j, first)] |= DEMI_JOIN_ANCHORED;
    }
    for (i = left = 0; i < j->facets; i++) {
        const int root = demi_join_root(j, i), paired = j->mark[i] & DEMI_JOIN_PAIRED;
        if (paired ? j->mark[root] & DEMI_JOIN_ANCHORED || j->mark[i] & DEMI_JOIN_GONE
            : j->mark[i] & DEMI_JOIN_GONE || demi_join_in_plane(w, j, i)) continue;
        for (m = 0; m < 5; m++) j->facet[5*left + m] = j->facet[5*i + m];
        left++;
    }
    j->changed |= left < j->facets;
    j->facets = left;
    return 1;
}

/* --- facets in one plane that cover each other --- */

/* A convex piece of a triangle. */
enum { DEMI_PIECE_CORNERS = 12 };
typedef struct demi_facet_piece { int count; demi_d3 x[DEMI_PIECE_CORNERS]; } demi_facet_piece;
/* The width of a piece, m: twice its area over the length of its outline. */
static double demi_piece_width(const demi_facet_piece *s) {
    demi_d3 area = demi_d(0, 0, 0);
    double around = 0;
    int k;
    for (k = 0; k < s->count; k++) {
        const demi_d3 a = s->x[k], b = s->x[(k + 1)%s->count];
        area = demi_d3_add(area, demi_d3_cross(demi_d3_sub(a, s->x[0]), demi_d3_sub(b, s->x[0])));
        around += demi_d3_length(demi_d3_sub(b, a));
    }
    return around > 0 ? demi_d3_length(area)/around : 0;
}
static demi_facet_piece demi_piece_of(const demi_join *j, int i) {
    demi_facet_piece s;
    for (s.count = 0; s.count < 3; s.count++)
        s.x[s.count] = demi_d3_at(j->x + 3*j->facet[5*i + s.count]);
    return s;
}
static demi_d3 demi_piece_normal(const demi_facet_piece *t) {
    return demi_d3_unit(demi_d3_normal(t->x[0], t->x[1], t->x[2]));
}
/* The directions into a triangle from its sides, unit. */
static void demi_piece_inward(const demi_facet_piece *t, demi_d3 *in) {
    const demi_d3 n = demi_piece_normal(t);
    int k;
    for (k = 0; k < 3; k++)
        in[k] = demi_d3_unit(demi_d3_cross(n, demi_d3_sub(t->x[(k + 1)%3], t->x[k])));
}
/* True if a triangle of corners c (x 3) is beyond a side of triangle s, or touches it there. in: of
   s. */
DEM_INLINE int demi_piece_beyond(const demi_facet_piece *s, const demi_d3 *in, const double *c,
                                 double tiny) {
    int k;
    for (k = 0; k < 3; k++) {
        const double at = demi_d3_dot(in[k], s->x[k]) + tiny;
        const double p = demi_d3_dot(in[k], demi_d3_at(c)), q = demi_d3_dot(in[k],
                                                                            demi_d3_at(c + 3));
        if (p <= at && q <= at && demi_d3_dot(in[k], demi_d3_at(c + 6)) <= at) return 1;
    }
    return 0;
}
/* Clips a piece to side k of triangle t; out: to what is beyond that side. */
static void demi_piece_clip(demi_facet_piece *s, const demi_facet_piece *t, int k, int out) {
    const demi_d3 e = demi_d3_sub(t->x[(k + 1)%3], t->x[k]);
    const demi_d3 in = demi_d3_cross(demi_piece_normal(t), e);
    s->count = demi_polygon_clip(s->x, s->count, out ? demi_d3_scale(in, -1) : in, t->x[k]);
}
/* True if triangle t covers a part of triangle s wider than `tiny`, m, in the same plane. */
static int demi_piece_covered(const demi_facet_piece *s, const demi_facet_piece *t, double tiny) {
    const demi_d3 n = demi_piece_normal(t);
    demi_facet_piece common = *s;
    int k;
    for (k = 0; k < 3; k++)
        if (!(fabs(demi_d3_dot(n, demi_d3_sub(s->x[k], t->x[0]))) <= tiny)) return 0;
    for (k = 0; k < 3; k++) demi_piece_clip(&common, t, k, 0);
    return demi_piece_width(&common) > tiny;
}
/* Removes from the pieces of a facet what triangle t covers. Returns 0 if memory ran out. */
static int demi_pieces_less(dem_world *w, demi_facet_piece **pieces, int *count,
                            const demi_facet_piece *t, double tiny) {
    const int all = *count;
    int i, k, left = 0;
    if (!demi_grow(w, DEMI_LOOSE, pieces, sizeof **pieces, 4*(size_t)all)) return 0;
    memmove(*pieces + 3*all, *pieces, (size_t)all*sizeof **pieces);
    for (i = 0; i < all; i++) {
        demi_facet_piece rest = (*pieces)[3*all + i];
        for (k = 0; k < 3 && rest.count < DEMI_PIECE_CORNERS; k++) {
            demi_facet_piece *out = &(*pieces)[left];
            *out = rest;
            demi_piece_clip(out, t, k, 1);
            left += demi_piece_width(out) > tiny;
            demi_piece_clip(&rest, t, k, 0);
        }
        if (k < 3) (*pieces)[left++] = rest;    /* too many corners: covered twice, but no hole */
    }
    *count = left;
    return 1;
}
/* Adds the pieces of facet i as facets. Returns 0 if memory ran out. */
static int demi_join_pieces(dem_world *w, demi_join *j, int i, const demi_facet_piece *piece,
                            int count) {
    int p, k, m;
    for (p = 0; p < count; p++, piece++) {
        const size_t points = (size_t)(j->points + piece->count);
        if (!demi_grow(w, DEMI_LOOSE, &j->x, sizeof(double), 3*points) ||
            !demi_grow(w, DEMI_LOOSE, &j->near_by, sizeof(double), points) ||
            !demi_grow(w, DEMI_LOOSE, &j->facet, sizeof(int32_t),
                       5*(size_t)(j->facets + piece->count))) return 0;
        for (k = 2; k < piece->count; k++) {
            int32_t *f = j->facet + 5*j->facets++;
            f[0] = j->points;
            f[1] = j->points + k - 1;
            f[2] = j->points + k;
            for (m = 3; m < 5; m++) f[m] = j->facet[5*i + m];
        }
        for (k = 0; k < piece->count; k++) {
            demi_d3_put(j->x + 3*j->points, piece->x[k]);
            j->near_by[j->points++] = j->near_by[j->facet[5*i]];
        }
    }
    return 1;
}
/* Welds all points again after facets were added, and drops facets `gone` and those without size.
   Returns 0 if memory ran out. */
static int demi_join_again(dem_world *w, demi_join *j, const unsigned char *gone, int all) {
    int i, k, left;
    demi_tree_free(w, &j->tree);
    j->changed = 1;
    if (!demi_grow(w, DEMI_LOOSE, &j->same, sizeof(int32_t), (size_t)j->points) ||
        !demi_grow(w, DEMI_LOOSE, &j->mark, 1, (size_t)DEMI_MAX(j->points, j->facets)) ||
        !demi_grow(w, DEMI_LOOSE, &j->side, sizeof(demi_side), 3*(size_t)j->facets) ||
        !demi_grow(w, DEMI_LOOSE, &j->root, sizeof(int32_t), (size_t)j->facets) ||
        !demi_tree_make(w, &j->tree, j->x, j->points)) return 0;
    demi_points_weld(&j->tree, j->near_by, j->same);
    for (i = left = 0; i < j->facets; i++) {
        int32_t *f = j->facet + 5*left;
        if (i < all && gone[i]) continue;
        memmove(f, j->facet + 5*i, 5*sizeof *f);
        for (k = 0; k < 3; k++) f[k] = j->same[f[k]];
        left += demi_facet_counts(j->x, j->near_by, f, 3);
    }
    j->facets = left;
    return 1;
}
/* Resolves facets in one plane that cover each other, such as folded triangles and floors that
   overlap: the first one keeps what is common, the others keep the rest. Where the boundaries of
   two closed bodies touch, neither keeps it. Returns 0 if memory ran out. */
static int demi_join_cover(dem_world *w, demi_join *j) {
    const int all = j->facets;
    double *middle = (double *)demi_alloc(w, (size_t)all*3, sizeof *middle);
    double *half = (double *)demi_alloc(w, (size_t)all*3, sizeof *half);
    double *corner = (double *)demi_alloc(w, (size_t)all*9, sizeof *corner);
    unsigned char *gone = (unsigned char *)demi_alloc(w, (size_t)all, 1);
    demi_facet_piece *pieces = 0;
    demi_tree tree;
    int i, k, m, any = 0, ok = middle && half && corner && gone;
    memset(&tree, 0, sizeof tree);
    for (i = 0; i < all && ok; i++)
        for (k = 0; k < 3; k++) {
            double lo = 1e300, hi = -1e300;
            for (m = 0; m < 3; m++) {
                corner[9*i + 3*m + k] = j->x[3*j->facet[5*i + m] + k];
                lo = DEMI_MIN(lo, corner[9*i + 3*m + k]);
                hi = DEMI_MAX(hi, corner[9*i + 3*m + k]);
            }
            middle[3*i + k] = (lo + hi)/2;
            half[3*i + k] = (hi - lo)/2;
        }
    tree.half = half;
    ok = ok && demi_tree_make(w, &tree, middle, all);
    for (i = 0; i < all && ok; i++) {
        const double *at = middle + 3*i, *size = half + 3*i;
        const demi_facet_piece own = demi_piece_of(j, i);
        const double tiny = j->near_by[j->facet[5*i]];
        demi_search_line line;
        demi_d3 in[3];
        int32_t other;
        int count = 0;
        demi_piece_inward(&own, in);
        demi_tree_line(&line, &tree, at, at, DEMI_MAX(size[0], DEMI_MAX(size[1], size[2])));
        while (ok && (other = demi_tree_next(&line)) >= 0) {
            const int32_t shell = j->facet[5*i + 4], its = j->facet[5*other + 4];
            const int closed = shell >= 0 && its >= 0 && shell != its;
            demi_facet_piece t;
            if (other == i || (other > i && !closed)) continue;
            for (k = 0; k < 3; k++)
                if (fabs(middle[3*other + k] - at[k]) > half[3*other + k] + size[k] + tiny) break;
            if (k < 3 || demi_piece_beyond(&own, in, corner + 9*(size_t)other, tiny)) continue;
            t = demi_piece_of(j, other);
            if (other > i && demi_d3_dot(demi_piece_normal(&t), demi_piece_normal(&own)) > 0)
                continue;
            if (!demi_piece_covered(&own, &t, tiny)) continue;
            if (!gone[i]) {
                ok = demi_grow(w, DEMI_LOOSE, &pieces, sizeof *pieces, 1);
                if (ok) pieces[0] = own;
                count = 1;
                any = gone[i] = 1;
            }
            if (ok && count) ok = demi_pieces_less(w, &pieces, &count, &t, tiny);
        }
        if (ok && gone[i]) ok = demi_join_pieces(w, j, i, pieces, count);
    }
    if (ok && any) ok = demi_join_again(w, j, gone, all);
    demi_free(w, middle);
    demi_free(w, half);
    demi_free(w, corner);
    demi_free(w, gone);
    demi_free(w, pieces);
    demi_tree_free(w, &tree);
    return ok;
}
/* Finds the points on the line from a to b, without its ends, in order. Returns their number; out
   may be null. */
static int demi_join_between(const demi_join *j, int32_t a, int32_t b, int32_t *out) {
    const double *p = j->x + 3*a, *q = j->x + 3*b;
    const demi_d3 way = demi_d3_sub(demi_d3_at(q), demi_d3_at(p));
    const double size2 = demi_far2(p, q), ends = DEMI_MIN(j->near_by[a], j->near_by[b]);
    demi_search_line line;
    int32_t at;
    int i, n = 0;
    demi_tree_line(&line, &j->tree, p, q, ends);
    while ((at = demi_tree_next(&line)) >= 0) {
        const demi_d3 to = demi_d3_sub(demi_d3_at(j->x + 3*at), demi_d3_at(p));
        const double most = DEMI_MIN(ends, j->near_by[at]), t = demi_d3_dot(to, way)/size2;
        if (j->same[at] != at || at == a || at == b || !j->mark[at]) continue;
        if (!(t > 0 && t < 1) || !(demi_d3_square(demi_d3_plus(to, -t, way)) <= most*most))
            continue;
        n++;
        if (!out) continue;
        for (i = n - 1; i > 0 && demi_far2(p, j->x + 3*out[i - 1]) > t*t*size2; i--)
            out[i] = out[i - 1];
        out[i] = at;
    }
    return n;
}
/* Replaces facet i by the facets of its outline, `count` points: of a profile the segments between
   them, of a mesh triangles about the middle. Returns 0 if memory ran out. */
static int demi_join_fan(dem_world *w, demi_join *j, int i, const int32_t *outline, int count) {
    const int pieces = j->per == 3 ? count : count - 1;
    const int32_t wall = j->facet[5*i + 3], shell = j->facet[5*i + 4];
    demi_d3 middle = demi_d(0, 0, 0);
    int k;
    if (!demi_grow(w, DEMI_LOOSE, &j->facet, sizeof(int32_t), 5*(size_t)(j->facets + pieces)) ||
        !demi_grow(w, DEMI_LOOSE, &j->near_by, sizeof(double), (size_t)(j->points + 1)) ||
        !demi_grow(w, DEMI_LOOSE, &j->x, sizeof(double), 3*(size_t)(j->points + 1))) return 0;
    for (k = 0; k < 3; k++)
        middle = demi_d3_plus(middle, 1.0/3, demi_d3_at(j->x + 3*j->facet[5*i + k]));
    j->near_by[j->points] = j->near_by[j->facet[5*i]];
    if (j->per == 3) demi_d3_put(j->x + 3*j->points, middle);
    for (k = 0; k < pieces; k++) {
        int32_t *f = j->facet + 5*(k ? j->facets++ : i);
        f[0] = outline[k];
        f[1] = outline[(k + 1)%count];
        f[2] = j->per == 3 ? j->points : f[1];
        f[3] = wall;
        f[4] = shell;
    }
    j->points += j->per == 3;
    j->changed = 1;
    return 1;
}
/* Divides facets at corners of others, and of images, that lie on their sides. Returns 0 if memory
   ran out. */
static int demi_join_divide(dem_world *w, demi_join *j) {
    const int all = j->facets, points = j->points;
    unsigned char *cut = (unsigned char *)demi_alloc(w, (size_t)all, 1);
    int32_t *outline = 0;
    size_t room = 0;
    int i, k, m, count, end, ok = cut != 0;
    if (!ok || !demi_grow(w, DEMI_LOOSE, &j->mark, 1, (size_t)points)) {
        demi_free(w, cut);
        return 0;
    }
    for (i = 0; i < points; i++) j->mark[i] = 0;
    for (i = 0; i < 5*all; i++) if (i%5 < j->per) j->mark[j->facet[i]] = 1;
    if (w->repeating) for (i = 0; i < points; i++) j->mark[i] = j->same[i] == i;
    for (i = 0; i < all && j->per == 2; i++) cut[i] = 1;
    demi_join_sides(j);
    for (i = 0; i < j->sides && j->per == 3; i = end) {        /* each side once; most are whole */
        end = demi_sides_end(j->side, j->sides, i);
        if (!demi_join_between(j, j->side[i].lo, j->side[i].hi, 0)) continue;
        for (k = i; k < end; k++) cut[j->side[k].facet] = 1;
    }
    for (i = 0; i < all && ok; i++) {
        const int32_t *f = j->facet + 5*i, corner[3] = {f[0], f[1], f[2]};
        if (!cut[i]) continue;
        for (k = count = 0; k < j->per && (j->per == 3 || !k); k++) {
            const int32_t a = corner[k], b = corner[(k + 1)%j->per];
            /* the same result from either side */
            const int cuts = demi_join_between(j, DEMI_MIN(a, b), DEMI_MAX(a, b), 0);
            if ((size_t)(count + cuts + 4) > room) {
                room = 2*(size_t)(count + cuts + 4);
                ok = demi_grow(w, DEMI_LOOSE, &outline, sizeof *outline, room);
                if (!ok) break;
            }
            outline[count] = a;
            demi_join_between(j, DEMI_MIN(a, b), DEMI_MAX(a, b), outline + count + 1);
            for (m = 0; m < cuts/2 && a > b; m++) {
                const int32_t t = outline[count + 1 + m];
                outline[count + 1 + m] = outline[count + cuts - m];
                outline[count + cuts - m] = t;
            }
            count += cuts + 1;
        }
        if (j->per == 2 && ok) outline[count++] = corner[1];
        if (ok && count > j->per) ok = demi_join_fan(w, j, i, outline, count);
    }
    demi_free(w, outline);
    demi_free(w, cut);
    return ok;
}
