/* ---------------------------------------------------------------------------------------------
   >>facets
   Weights of the faces, edges and corners of a surface, so that the contact force depends on the
   surface and not on how it is divided into facets. Meshes (triangles) and profiles (segments) are
   surfaces of facets.

   A grain of radius r whose centre x is at distance d from a wall stores the energy U(r - d) of the
   normal law. Consider a ball about x whose radius s grows from 0 to r. It reaches the surface S
   first at one point, then perhaps at others; as s grows, these regions join. Let chi(s) be the
   Euler characteristic of the intersection of ball and surface: pieces minus rings. The rule is
       E(x) = integral of chi(s) U'(r - s) ds,  s = 0 .. r       F = -dE/dx
   For one contact point at distance d, chi is 1 from s = d on, and E = U(r - d). One region counts
   once; two that have joined count once, two that have not count twice. chi is additive:
       chi(A or B) = chi(A) + chi(B) - chi(A and B)
   and it is 1 for any convex set. So, summed over the faces, edges and corners X of the surface,
   each convex and closed, at distance d(X) from x,
       E = sum of weight(X) U(r - d(X)),     F = -sum of weight(X) U'(r - d(X)) grad d(X)
       face 1,  edge 1 - (faces at it),  corner 1 - (faces at it) - sum of weights of edges at it
   That is, every point of the surface counts once in total. Dividing a facet changes nothing. E is
   an energy, so elastic contacts conserve energy for any surface. The distance from a convex set
   has a continuous gradient, so F has no jump on any path outside the surface. On an open face, a
   ridge, a rim or a tip there is one nearest point, and only its U' remains, as for an infinite
   plane or cylinder. In a valley there are two nearest points and the edge between them, which
   counts -1: F changes from one contact to two as the valley gets steeper or the overlap smaller.
   (In terms of Morse theory, F is a sum over the critical points of the distance: minima 1, saddles
   -1.) Terms with the same nearest point are added up before the law is called; most cancel, and
   what remains is nearly always one contact. If a ring closes around the grain, chi is 0; >>touch
   handles that.

   The law, with its friction and history, is evaluated at each remaining contact point and
   multiplied by its weight. Surfaces of walls that do not move relative to each other are joined,
   and each wall has its part of common weights. Not joined, so that contacts add up as in a corner:
   facets that intersect or overlap in one plane, cracks, and seams between walls of different
   kinds. That the Euler characteristic is additive is well known; as a contact rule we have not
   found it published. Tests: tests/surface/test_facets.c.
   --------------------------------------------------------------------------------------------- */
DEM_INLINE int demi_wall_is(const demi_wall *wall, int trait) {
    return (demi_wall_kinds[wall->kind].traits & trait) != 0;
}
DEM_INLINE int demi_faceted(const demi_wall *wall) { return demi_wall_is(wall, DEMI_FACETS); }
DEM_INLINE int demi_wall_per(const demi_wall *wall) { return demi_wall_kinds[wall->kind].corners; }

static double demi_far2(const double *a, const double *b) {
    return demi_d3_square(demi_d3_sub(demi_d3_at(a), demi_d3_at(b)));
}

/* A tree of boxes around points, to find those near a line. Node k has the children 2k+1 and 2k+2,
   split across its longest side; each has a range of `order` and the box of its points. */
enum { DEMI_TREE_LEAF = 8 };
typedef struct demi_tree {
    const double *x;               /* points x 3, m: not a copy */
    int32_t *order;                /* points */
    double *box;                   /* nodes x 6: lowest and highest x, y, z */
    size_t points, nodes;
} demi_tree;
/* A search along the line from a to b: nodes still to visit, and the present leaf. */
typedef struct demi_search_line {
    const demi_tree *tree;
    const double *a, *b;
    double off;                    /* m, largest distance from the line */
    int32_t node[64], from[64], to[64];
    int open, at, end;
} demi_search_line;

/* Moves the k-th smallest along an axis to position k, with smaller ones before it [HOA61]. */
static void demi_tree_select(const double *x, int axis, int32_t *order, int count, int k) {
    int lo = 0, hi = count - 1;
    while (lo < hi) {
        const double pivot = x[3*order[k] + axis];
        int i = lo, j = hi;
        while (i <= j) {
            while (x[3*order[i] + axis] < pivot) i++;
            while (x[3*order[j] + axis] > pivot) j--;
            if (i <= j) {
                const int32_t keep = order[i];
                order[i++] = order[j];
                order[j--] = keep;
            }
        }
        if (j < k) lo = i;
        if (i > k) hi = j;
    }
}
/* Sets the box of points from .. to - 1 of the order, and splits it across its longest side until
   few are left. */
static void demi_tree_node(demi_tree *t, size_t node, int from, int to) {
    double *box = t->box + 6*node;
    const int mid = from + (to - from)/2;
    int i, k, axis = 0;
    for (k = 0; k < 3; k++) {
        box[k] = box[3 + k] = t->x[3*t->order[from] + k];
        for (i = from + 1; i < to; i++) {
            box[k] = DEMI_MIN(box[k], t->x[3*t->order[i] + k]);
            box[3 + k] = DEMI_MAX(box[3 + k], t->x[3*t->order[i] + k]);
        }
        if (box[3 + k] - box[k] > box[3 + axis] - box[axis]) axis = k;
    }
    if (to - from <= DEMI_TREE_LEAF) return;
    demi_tree_select(t->x, axis, t->order + from, to - from, mid - from);
    demi_tree_node(t, 2*node + 1, from, mid);
    demi_tree_node(t, 2*node + 2, mid, to);
}
static void demi_tree_free(dem_world *w, demi_tree *t) {
    demi_free(w, t->order);
    demi_free(w, t->box);
}
/* Builds the tree. Returns 0 if memory ran out; free it in either case. */
static int demi_tree_make(dem_world *w, demi_tree *t, const double *x, int count) {
    int i;
    t->x = x;
    t->points = (size_t)count;
    for (t->nodes = 1, i = count; i > DEMI_TREE_LEAF; i = i - i/2) t->nodes = 2*t->nodes + 1;
    t->order = (int32_t *)demi_alloc(w, t->points, sizeof *t->order);
    t->box = (double *)demi_alloc(w, t->nodes*6, sizeof *t->box);
    if (!t->order || !t->box) return !count;
    for (i = 0; i < count; i++) t->order[i] = i;
    if (count) demi_tree_node(t, 0, 0, count);
    return 1;
}
/* True if a part of the line from a to b is within `off` of the box; also at times slightly
   beyond. */
static int demi_line_meets(const double *a, const double *b, double off, const double *box) {
    double enter = 0, leave = 1;
    int k;
    for (k = 0; k < 3; k++) {
        const double lo = box[k] - off - a[k], hi = box[3 + k] + off - a[k], way = b[k] - a[k];
        if (way > 0 || way < 0) {
            enter = DEMI_MAX(enter, (way > 0 ? lo : hi)/way);
            leave = DEMI_MIN(leave, (way > 0 ? hi : lo)/way);
        } else if (lo > 0 || hi < 0) return 0;
    }
    return enter <= leave*(1 + 1e-12) + 1e-300;
}
/* Starts a search for points within `off` of the line from a to b. */
static void demi_tree_line(demi_search_line *s, const demi_tree *t, const double *a,
                           const double *b, double off) {
    s->tree = t;
    s->a = a;
    s->b = b;
    s->off = off;
    s->open = t->points > 0;
    s->node[0] = s->from[0] = 0;
    s->to[0] = (int32_t)t->points;
    s->at = s->end = 0;
}
/* Returns the next point that may be near the line, -1 after the last. It misses none that is
   near. */
static int32_t demi_tree_next(demi_search_line *s) {
    while (s->at == s->end) {
        int32_t node, from, to;
        if (!s->open) return -1;
        node = s->node[--s->open];
        from = s->from[s->open];
        to = s->to[s->open];
        if (!demi_line_meets(s->a, s->b, s->off, s->tree->box + 6*node)) continue;
        if (to - from <= DEMI_TREE_LEAF) {
            s->at = from;
            s->end = to;
        } else {
            s->node[s->open] = 2*node + 2;
            s->from[s->open] = from + (to - from)/2;
            s->to[s->open++] = to;
            s->node[s->open] = 2*node + 1;
            s->from[s->open] = from;
            s->to[s->open++] = from + (to - from)/2;
        }
    }
    return s->tree->order[s->at++];
}

/* Welding tolerance of each corner, m: a few roundings of the largest coordinate, as stored in
   binary STL, but far less than the shortest side there. */
static void demi_near_by(const double *x, const demi_wall *wall, int first, double *near_by) {
    const int per = demi_wall_per(wall);
    double most = 0;
    int i, k;
    for (i = 0; i < wall->vertex_count; i++) near_by[first + i] = 0;       /* if it is no corner */
    for (i = 0; i < per*wall->element_count; i++)
        for (k = 0; k < 3; k++) most = DEMI_MAX(most, fabs(x[3*(first + wall->corners[i]) + k]));
    for (i = 0; i < per*wall->element_count; i++)
        near_by[first + wall->corners[i]] = 4*(double)FLT_EPSILON*most;
    for (i = 0; i < wall->element_count; i++)
        for (k = 0; k < per; k++) {
            const int a = first + wall->corners[per*i + k];
            const int b = first + wall->corners[per*i + (k + 1)%per];
            const double side = 1e-3*sqrt(demi_far2(x + 3*a, x + 3*b));
            if (!(side > 0)) continue;
            near_by[a] = DEMI_MIN(near_by[a], side);
            near_by[b] = DEMI_MIN(near_by[b], side);
        }
}
/* Welds points: same[i] is the first point at the position of point i. */
static void demi_points_weld(const demi_tree *tree, const double *near_by, int32_t *same) {
    const double *x = tree->x;
    const int count = (int)tree->points;
    demi_search_line near;
    int i;
    for (i = 0; i < count; i++) same[i] = i;
    for (i = 0; i < count; i++) {
        int32_t a, b, other;
        /* a copy of an earlier point, which has the same neighbours */
        if (same[i] != i && near_by[i] <= near_by[same[i]] &&
            !(demi_far2(x + 3*i, x + 3*same[i]) > 0)) continue;
        demi_tree_line(&near, tree, x + 3*i, x + 3*i, near_by[i]);
        while ((other = demi_tree_next(&near)) >= 0) {
            const double most = DEMI_MIN(near_by[i], near_by[other]);
            if (other <= i || !(demi_far2(x + 3*i, x + 3*other) <= most*most)) continue;
            for (a = i; same[a] != a;) a = same[a];
            for (b = other; same[b] != b;) b = same[b];
            same[DEMI_MAX(a, b)] = DEMI_MIN(a, b);
        }
    }
    for (i = 0; i < count; i++) same[i] = same[same[i]];
}
/* True if a facet counts. It does not if two corners coincide, nor if all corners of a triangle are
   within the welding tolerance of its longest side; its other sides and corners are its
   neighbours'. */
static int demi_facet_counts(const double *x, const double *near_by, const int32_t *c, int per) {
    double side[3], longest, most;
    demi_d3 normal;
    int k;
    if (c[0] == c[1]) return 0;
    if (per == 2) return 1;
    if (c[1] == c[2] || c[2] == c[0]) return 0;
    for (k = 0; k < 3; k++) side[k] = demi_far2(x + 3*c[k], x + 3*c[(k + 1)%3]);
    normal = demi_d3_normal(demi_d3_at(x + 3*c[0]), demi_d3_at(x + 3*c[1]), demi_d3_at(x + 3*c[2]));
    longest = DEMI_MAX(side[0], DEMI_MAX(side[1], side[2]));
    most = DEMI_MIN(near_by[c[0]], DEMI_MIN(near_by[c[1]], near_by[c[2]]));
    return demi_d3_square(normal) > most*most*longest;
}

/* A side of a facet, from point lo to point hi. */
typedef struct demi_side { int32_t lo, hi, facet, side; } demi_side;
/* Sorts sides by their corners, those with the same corners by facet. */
static int demi_side_compare(const void *x, const void *y) {
    const demi_side *a = (const demi_side *)x, *b = (const demi_side *)y;
    if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
    if (a->hi != b->hi) return a->hi < b->hi ? -1 : 1;
    if (a->facet != b->facet) return a->facet < b->facet ? -1 : 1;
    return a->side < b->side ? -1 : a->side > b->side;
}
/* A side, with its corners in ascending order: it has no direction. */
static demi_side demi_side_of(int32_t a, int32_t b, int facet, int side) {
    demi_side s;
    s.lo = DEMI_MIN(a, b);
    s.hi = DEMI_MAX(a, b);
    s.facet = facet;
    s.side = side;
    return s;
}

/* Sets the planes of a wall's elements; most elements out of reach are rejected by them. */
static void demi_facet_planes(demi_wall *wall, const double *x) {
    const int n = demi_wall_per(wall);
    double far = 0;
    int i;
    for (i = 0; i < 3*wall->vertex_count; i++) far = DEMI_MAX(far, fabs(x[i]));
    wall->plane_slack = (dem_real)(16*far*(DEMI_SINGLE ? (double)FLT_EPSILON : DBL_EPSILON));
    for (i = 0; i < wall->element_count; i++) {
        const int32_t *c = wall->corners + n*i;
        const demi_d3 a = demi_d3_at(x + 3*c[0]);
        const demi_d3 v = n == 3 ? demi_d3_sub(demi_d3_at(x + 3*c[2]), a) : demi_d(0, 0, 1);
        demi_d3 u = demi_d3_sub(demi_d3_at(x + 3*c[1]), a), m;
        double l;
        if (n == 2) u.z = 0;                    /* a segment is infinite along z */
        m = demi_d3_cross(u, v);
        l = demi_d3_length(m);
        if (!(l*l > 1e-8*demi_d3_square(u)*demi_d3_square(v))) continue;
        demi_put(wall->planes + 4*i, demi_d3_real(demi_d3_over(m, l)));
        wall->planes[4*i + 3] = (dem_real)(demi_d3_dot(m, a)/l);
    }
}
/* Welds the corners of a wall, numbers its edges and decides which element owns which edge and
   corner. Elements with two coinciding corners do not count. Returns 0 if memory ran out. */
static int demi_facets_begin(dem_world *w, demi_wall *wall) {
    const int n = demi_wall_per(wall), all = wall->element_count;
    const size_t vertices = (size_t)wall->vertex_count;
    double *x = (double *)demi_alloc(w, vertices*3, sizeof *x);
    int32_t *same = (int32_t *)demi_alloc(w, vertices, sizeof *same);
    demi_side *sides = (demi_side *)demi_alloc(w, (size_t)all*3, sizeof *sides);
    double *near_by = (double *)demi_alloc(w, vertices, sizeof *near_by);
    demi_tree tree;
    int i, k, count = 0, ok = 0;
    memset(&tree, 0, sizeof tree);
    wall->owns = (unsigned char *)demi_hold(w, DEMI_SCENE, (size_t)all, 1);
    wall->edges = (int32_t *)demi_hold(w, DEMI_SCENE, (size_t)all*3, sizeof(int32_t));
    wall->planes = (dem_real *)demi_hold(w, DEMI_SCENE, (size_t)all*4, sizeof(dem_real));
    if (!x || !same || !sides || !near_by || !wall->owns || !wall->edges || !wall->planes)
        goto done;
    for (i = 0; i < 3*wall->vertex_count; i++) x[i] = (double)wall->vertices[i];
    if (!demi_tree_make(w, &tree, x, wall->vertex_count)) goto done;
    demi_near_by(x, wall, 0, near_by);
    demi_points_weld(&tree, near_by, same);
    for (i = 0; i < n*all; i++) wall->corners[i] = same[wall->corners[i]];
    demi_facet_planes(wall, x);
    memset(same, 0, vertices*sizeof *same);     /* from here on: has it an owner? */
    for (i = 0; i < all; i++) {
        const int32_t *c = wall->corners + n*i;
        if (!demi_facet_counts(x, near_by, c, n)) continue;
        for (k = 0; k < n; k++) {
            if (!same[c[k]]) wall->owns[i] = (unsigned char)(wall->owns[i] | 8 << k);
            same[c[k]] = 1;
            if (n == 3) sides[count++] = demi_side_of(c[k], c[(k + 1)%3], i, k);
        }
    }
    qsort(sides, (size_t)count, sizeof *sides, demi_side_compare);
    for (i = 0; i < count; i++) {
        const demi_side *s = sides + i;
        const int again = i > 0 && s[-1].lo == s->lo && s[-1].hi == s->hi;
        if (!again) {
            wall->owns[s->facet] = (unsigned char)(wall->owns[s->facet] | 1 << s->side);
            wall->edge_count++;
        }
        wall->edges[3*s->facet + s->side] = wall->edge_count - 1;
    }
    wall->weight = (dem_real *)demi_hold(w, DEMI_SCENE,
                                         (size_t)all + (size_t)wall->edge_count + vertices,
                                          sizeof(dem_real));
    ok = wall->weight != 0;
done:
    demi_free(w, x);
    demi_tree_free(w, &tree);
    demi_free(w, same);
    demi_free(w, sides);
    demi_free(w, near_by);
    return ok;
}

/* True if any element counts: the first one that does owns its corners. */
static int demi_facets_any(const demi_wall *wall) {
    int i;
    for (i = 0; i < wall->element_count; i++) if (wall->owns[i]) return 1;
    return 0;
}

/* True if two walls are at rest relative to each other: both fixed, or moved alike. */
static int demi_walls_together(const demi_wall *a, const demi_wall *b) {
    const dem_motion *m = &a->motion, *o = &b->motion;
    if (a == b) return 1;
    if (m->kind != o->kind || m->kind == DEM_MOTION_USER || m->kind == DEM_MOTION_TABLE) return 0;
    if (m->kind == DEM_MOTION_FIXED) return 1;
    if (memcmp(&m->start, &o->start, sizeof m->start) ||
        memcmp(&m->ramp, &o->ramp, sizeof m->ramp) ||
        memcmp(&m->velocity, &o->velocity, sizeof m->velocity)) return 0;
    return m->kind == DEM_MOTION_TRANSLATING ? 1 : m->kind == DEM_MOTION_ROTATING
        ? !memcmp(&m->point, &o->point, sizeof m->point) &&
          !memcmp(&m->axis, &o->axis, sizeof m->axis) &&
          !memcmp(&m->speed, &o->speed, sizeof m->speed)
        : !memcmp(&m->amplitude, &o->amplitude, sizeof m->amplitude) &&
          !memcmp(&m->frequency, &o->frequency, sizeof m->frequency) &&
          !memcmp(&m->phase, &o->phase, sizeof m->phase);
}

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
/* Sets, for each wall, along which axes it repeats. */
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
}
static dem_vec3 demi_wall_shift(const dem_world *w, int a, int b, int c) {
    return demi_v((dem_real)a*w->wall_period[0], (dem_real)b*w->wall_period[1],
                  (dem_real)c*w->wall_period[2]);
}

/* The surfaces of a group of walls, joined to one. Points are the corners of all of them, one wall
   after the other, in the pose in which their motion began (so that a restart finds the same);
   facets are their elements, without those that have no size. */
typedef struct demi_join {
    int per;                       /* corners of a facet: 3 (meshes) or 2 (profiles) */
    int points, facets, sides, cuts;
    int images;                    /* of facets: the last ones; their wall is -1 */
    double *x, *near_by;           /* points: x 3; m, welding tolerance */
    demi_tree tree;                /* of points */
    int32_t *same, *mark;          /* points: the first one here; scratch */
    double *faces, *corners;       /* points: facets there, in all and with a corner */
    double *edges;                 /* points: sum of weights of edges that end there */
    double *own;                   /* points: facets of one wall with a corner there */
    int32_t *facet;                /* facets x 5: wall, element, points of its corners */
    double *count;                 /* facets: 1; 1/n if they coincide in n walls */
    demi_side *side, *piece;       /* uncut, and cut: side 3 + k is a piece of side k */
    int32_t *cut;                  /* cuts x 6: wall, element, points, number, side */
    double *cut_weight;
    size_t point_room, facet_room, cut_room;
} demi_join;

/* Frees the join; weights, cuts and owners have been handed to the walls by then. */
static void demi_join_free(dem_world *w, demi_join *j) {
    demi_free(w, j->x);
    demi_free(w, j->near_by);
    demi_tree_free(w, &j->tree);
    demi_free(w, j->same);
    demi_free(w, j->mark);
    demi_free(w, j->faces);
    demi_free(w, j->corners);
    demi_free(w, j->edges);
    demi_free(w, j->own);
    demi_free(w, j->facet);
    demi_free(w, j->count);
    demi_free(w, j->side);
    demi_free(w, j->piece);
    demi_free(w, j->cut);
    demi_free(w, j->cut_weight);
}
static int demi_join_member(const dem_world *w, int wall, int group, int per) {
    const demi_wall *m = &w->walls[wall];
    return demi_faceted(m) && m->group == group && per == demi_wall_per(m);
}
/* True if a wall stays at rest relative to its image along an axis. */
static int demi_wall_keeps(const demi_wall *wall, int axis) {
    const dem_motion *m = &wall->motion;
    const dem_vec3 n = demi_unit(m->axis), e = demi_v(axis == 0, axis == 1, axis == 2);
    return wall->repeats[axis] && (m->kind != DEM_MOTION_ROTATING ||
                                   demi_length(demi_cross(n, e)) <= DEM_R(1e-6));
}
/* Adds images of facets that touch the group. They count for the weights of edges and corners at
   them, and get no weight themselves. fill 0: only counts them, with one point per corner. */
static void demi_join_images(const dem_world *w, demi_join *j, int group, int fill) {
    double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300}, slack = 0;
    int i, e, k, c, n, first = 0;
    if (!w->repeating) return;
    for (i = group; i < w->wall_count; i++)
        for (k = 0; k < 3 && demi_join_member(w, i, group, j->per); k++) {
            lo[k] = DEMI_MIN(lo[k], (double)w->walls[i].span_lo[k]);
            hi[k] = DEMI_MAX(hi[k], (double)w->walls[i].span_hi[k]);
            if (k == 2 && j->per == 2) continue;
            slack = DEMI_MAX(slack, 8*(double)FLT_EPSILON*DEMI_MAX(fabs(lo[k]), fabs(hi[k])));
        }
    for (i = group; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, group, j->per)) continue;
        for (n = 0; n < 27; n++) {
            const int s[3] = {n%3 - 1, n/3%3 - 1, n/9 - 1};
            const dem_vec3 by = demi_wall_shift(w, s[0], s[1], s[2]);
            int use = n != 13;
            for (k = 0; k < 3; k++) use = use && (!s[k] || demi_wall_keeps(wall, k));
            for (e = 0; e < wall->element_count && use; e++) {
                double x[9], a = 0, b = 0;
                int near = 1;
                for (c = 0; c < j->per; c++) {
                    const dem_vec3 at = demi_add(by, demi_add(wall->pose.position,
                        demi_rotate(wall->pose.rotation, demi_at(wall->vertices + 3*
                                                               wall->corners[j->per*e + c]))));
                    demi_d3_put(x + 3*c, demi_d3_of(at));
                }
                for (k = 0; k < 3; k++) {
                    for (c = 0; c < j->per; c++) {
                        a = c ? DEMI_MIN(a, x[3*c + k]) : x[k];
                        b = c ? DEMI_MAX(b, x[3*c + k]) : x[k];
                    }
                    near = near && a <= hi[k] + slack && b >= lo[k] - slack;
                }
                if (!near) continue;
                if (!fill) {
                    j->point_room += (size_t)j->per;
                    j->facet_room++;
                    continue;
                }
                memcpy(j->x + 3*j->points, x, (size_t)j->per*3*sizeof *x);
                for (c = 0; c < j->per; c++)    /* as for the wall's own corners */
                    j->near_by[j->points + c] = j->near_by[first + wall->corners[j->per*e + c]];
                j->points += j->per;
                j->images++;
            }
        }
        first += wall->vertex_count;
    }
}
/* Collects the points and facets of all walls of a group. Returns 0 if memory ran out. */
static int demi_join_begin(dem_world *w, demi_join *j, int group, int per) {
    int i, e, k, first = 0, real_points;
    memset(j, 0, sizeof *j);
    j->per = per;
    for (i = group; i < w->wall_count; i++) {
        if (!demi_join_member(w, i, group, per)) continue;
        j->point_room += (size_t)w->walls[i].vertex_count;
        j->facet_room += (size_t)w->walls[i].element_count;
    }
    demi_join_images(w, j, group, 0);
    if (j->point_room > INT_MAX/8 || j->facet_room > INT_MAX/8) return 0;
    j->x = (double *)demi_alloc(w, j->point_room*3, sizeof(double));
    j->near_by = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->same = (int32_t *)demi_alloc(w, j->point_room, sizeof(int32_t));
    j->mark = (int32_t *)demi_alloc(w, j->point_room, sizeof(int32_t));
    j->faces = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->corners = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->edges = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->own = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->facet = (int32_t *)demi_alloc(w, j->facet_room*5, sizeof(int32_t));
    j->count = (double *)demi_alloc(w, j->facet_room, sizeof(double));
    j->side = (demi_side *)demi_alloc(w, j->facet_room*3, sizeof(demi_side));
    if (!j->x || !j->near_by || !j->same || !j->mark || !j->faces || !j->corners ||
        !j->edges || !j->own || !j->facet || !j->count || !j->side) return 0;
    for (i = group; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, group, per)) continue;
        for (k = 0; k < wall->vertex_count; k++) {
            const dem_vec3 at = demi_add(wall->home.position, demi_rotate(wall->home.rotation,
                                         demi_at(wall->vertices + 3*k)));
            demi_d3_put(j->x + 3*j->points++, demi_d3_of(at));
        }
        demi_near_by(j->x, wall, first, j->near_by);
        first += wall->vertex_count;
    }
    real_points = j->points;
    demi_join_images(w, j, group, 1);
    first = 0;
    if (!demi_tree_make(w, &j->tree, j->x, j->points)) return 0;
    demi_points_weld(&j->tree, j->near_by, j->same);
    for (i = group; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, group, per)) continue;
        for (e = 0; e < wall->element_count; e++) {
            int32_t *f = j->facet + 5*j->facets;
            f[0] = i;
            f[1] = e;
            for (k = 0; k < per; k++) f[2 + k] = j->same[first + wall->corners[per*e + k]];
            if (!demi_facet_counts(j->x, j->near_by, f + 2, per)) continue;
            j->count[j->facets++] = 1;
        }
        first += wall->vertex_count;
    }
    for (i = 0; i < j->images; i++) {
        int32_t *f = j->facet + 5*j->facets;
        f[0] = f[1] = -1;
        for (k = 0; k < per; k++) f[2 + k] = j->same[real_points + per*i + k];
        if (!demi_facet_counts(j->x, j->near_by, f + 2, per)) continue;
        j->count[j->facets++] = 1;
    }
    return 1;
}
/* Facets that coincide, such as the touching sides of two boxes, count once in total: the first of
   each wall counts, in equal parts. */
static void demi_join_double(demi_join *j) {
    demi_side *s = j->side;
    int i, k, end;
    for (i = 0; i < j->facets; i++) {
        int32_t c[3];
        for (k = 0; k < 3; k++) c[k] = j->facet[5*i + 2 + (k < j->per ? k : 0)];
        s[i] = demi_side_of(DEMI_MIN(c[0], DEMI_MIN(c[1], c[2])),
                            DEMI_MAX(c[0], DEMI_MAX(c[1], c[2])), 0, i);
        if (j->per == 3) s[i].facet = c[0] + c[1] + c[2] - s[i].lo - s[i].hi;
    }
    qsort(s, (size_t)j->facets, sizeof *s, demi_side_compare);
    for (i = 0; i < j->facets; i = end) {
        int walls = 0;
        for (end = i; end < j->facets && s[end].lo == s[i].lo && s[end].hi == s[i].hi &&
             s[end].facet == s[i].facet; end++) {
            const int wall = j->facet[5*s[end].side];      /* ascending, as facets are */
            j->count[s[end].side] = end == i || wall != j->facet[5*s[end - 1].side];
            walls += j->count[s[end].side] > 0;
        }
        for (k = i; k < end; k++) j->count[s[k].side] /= walls;
    }
    for (i = 0; i < j->facets; i++)
        for (k = 0; k < j->per; k++) {
            j->faces[j->facet[5*i + 2 + k]] += j->count[i];
            j->corners[j->facet[5*i + 2 + k]] += j->count[i];
        }
}
/* Finds the points on the line from a to b, without its ends, once per position and in order.
   Returns their number; out may be null. */
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
        if (j->same[at] != at || at == a || at == b || !(j->corners[at] > 0)) continue;
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
/* Cuts the sides of triangles at corners of others that lie on them. Returns 0 if memory ran
   out. */
static int demi_join_cut(dem_world *w, demi_join *j) {
    int32_t *between = 0;
    size_t most = 0, room = 0;
    int i, k, end, cuts, n = 0, pass;
    for (i = 0; i < j->facets; i++)
        for (k = 0; k < 3; k++)
            j->side[j->sides++] = demi_side_of(j->facet[5*i + 2 + k], j->facet[5*i + 2 + (k + 1)%3],
                                               i, k);
    qsort(j->side, (size_t)j->sides, sizeof *j->side, demi_side_compare);
    for (pass = 0; pass < 2; pass++) {          /* count, then make them */
        for (i = 0; i < j->sides; i = end) {
            const demi_side *s = j->side + i;
            for (end = i; end < j->sides && j->side[end].lo == s->lo && j->side[end].hi == s->hi;)
                end++;
            cuts = demi_join_between(j, s->lo, s->hi, between);
            most = DEMI_MAX(most, (size_t)cuts);
            room += pass ? 0 : (size_t)(end - i)*((size_t)cuts + 1);
            j->cut_room += pass || !cuts ? 0 : (size_t)(end - i)*((size_t)cuts + 1);
            for (; pass && s < j->side + end; s++) {
                for (k = 0; k <= cuts; k++)
                    j->piece[n++] = demi_side_of(k ? between[k - 1] : s->lo, k < cuts ? between[k]
                                                 : s->hi, s->facet, s->side + (cuts ? 3 : 0));
                for (k = 0; k < cuts; k++) j->faces[between[k]] += j->count[s->facet];
            }
        }
        if (pass) break;
        if (room > INT_MAX/8) return 0;
        j->piece = (demi_side *)demi_alloc(w, room, sizeof *j->piece);
        between = (int32_t *)demi_alloc(w, most, sizeof *between);
        j->cut = (int32_t *)demi_alloc(w, j->cut_room*6, sizeof *j->cut);
        j->cut_weight = (double *)demi_alloc(w, j->cut_room, sizeof *j->cut_weight);
        if ((room && !j->piece) || (most && !between) ||
            (j->cut_room && (!j->cut || !j->cut_weight))) break;
    }
    j->sides = n;
    if (pass == 1 && n) qsort(j->piece, (size_t)n, sizeof *j->piece, demi_side_compare);
    demi_free(w, between);
    return pass == 1;
}
/* Assigns one wall's part, `more`, of the weight at sides first .. end - 1 of the join: to one of
   its edges, or else to the first of its cuts; the other cuts record its number. */
static void demi_join_edge(dem_world *w, demi_join *j, int first, int end, int id, double more) {
    demi_wall *wall = &w->walls[id];
    int k, whole = -1, number = 0;
    for (k = first; k < end && whole < 0; k++) {
        const int32_t *f = j->facet + 5*j->piece[k].facet;
        if (f[0] == id && j->piece[k].side < 3)
            whole = wall->edges[3*f[1] + j->piece[k].side];
    }
    if (whole >= 0) {
        number = wall->element_count + whole;
        wall->weight[number] = (dem_real)more;
    } else number = wall->element_count + wall->edge_count + wall->vertex_count + wall->cut_count;
    for (k = first; k < end; k++) {
        const demi_side *s = j->piece + k;
        const int32_t *f = j->facet + 5*s->facet;
        int32_t *c;
        if (f[0] != id || s->side < 3) continue;
        c = j->cut + 6*j->cuts;
        c[0] = id; c[1] = f[1]; c[2] = s->lo; c[3] = s->hi; c[4] = number; c[5] = s->side - 3;
        j->cut_weight[j->cuts++] = whole < 0 ? more : 0;
        wall->cut_count++;
        whole = 0;                              /* the first cut has it */
    }
}
/* Computes the weights of edges and divides them among walls. */
static void demi_join_edges(dem_world *w, demi_join *j) {
    int i, k, end, other;
    for (i = 0; i < j->sides; i = end) {
        const demi_side *s = j->piece + i;
        double all = 0;
        for (end = i; end < j->sides && j->piece[end].lo == s->lo && j->piece[end].hi == s->hi;)
            all += j->count[j->piece[end++].facet];
        j->edges[s->lo] += all > 0 ? 1 - all : 0;
        j->edges[s->hi] += all > 0 ? 1 - all : 0;
        for (k = i; k < end; k++) {             /* each wall at its first side */
            const int id = j->facet[5*j->piece[k].facet];
            double mine = 0;
            int first = k;
            if (id < 0) continue;               /* an image */
            for (other = i; other < end; other++) {
                if (j->facet[5*j->piece[other].facet] != id) continue;
                first = DEMI_MIN(first, other);
                mine += j->count[j->piece[other].facet];
            }
            if (first == k)
                demi_join_edge(w, j, i, end, id, all > 0 ? mine*(1 - all)/all : 0);
        }
    }
}
/* Corners of profiles that lie on other segments also count as corners of those. */
static int demi_join_profiles(dem_world *w, demi_join *j) {
    int32_t *between = (int32_t *)demi_alloc(w, (size_t)j->points, sizeof *between);
    int i, k;
    if (!between) return 0;
    for (i = 0; i < j->facets; i++) {
        const int n = demi_join_between(j, j->facet[5*i + 2], j->facet[5*i + 3], between);
        for (k = 0; k < n; k++) j->faces[between[k]] += j->count[i];
    }
    demi_free(w, between);
    return 1;
}
/* Computes the weights of corners and faces. */
static void demi_join_corners(dem_world *w, demi_join *j) {
    int f, end, g, k;
    for (f = 0; f < j->facets; f = end) {       /* one wall after the other */
        const int id = j->facet[5*f];
        demi_wall *wall = &w->walls[id < 0 ? 0 : id];
        dem_real *corner;
        if (id < 0) return;                     /* images get no weight */
        corner = wall->weight + wall->element_count + wall->edge_count;
        memset(j->own, 0, (size_t)j->points*sizeof *j->own);
        for (end = f; end < j->facets && j->facet[5*end] == id; end++) {
            wall->weight[j->facet[5*end + 1]] = (dem_real)j->count[end];
            for (k = 0; k < j->per; k++) j->own[j->facet[5*end + 2 + k]] += j->count[end];
        }
        for (g = f; g < end; g++) {
            const int element = j->facet[5*g + 1];
            for (k = 0; k < j->per; k++) {
                const int32_t at = j->facet[5*g + 2 + k];
                if (!(wall->owns[element] >> (3 + k) & 1) || !(j->own[at] > 0)) continue;
                corner[wall->corners[j->per*element + k]] =
                    (dem_real)((1 - j->faces[at] - j->edges[at])*j->own[at]/j->corners[at]);
                j->own[at] = 0;
            }
        }
    }
}
static dem_vec3 demi_join_local(const demi_join *j, const demi_wall *wall, int32_t point) {
    return demi_unrotate(wall->home.rotation, demi_sub(demi_d3_real(demi_d3_at(j->x + 3*point)),
                                                       wall->home.position));
}
/* Hands the cuts to their walls, by element. Returns 0 if memory ran out. */
static int demi_join_hand(dem_world *w, const demi_join *j, int group) {
    int32_t *own = j->mark;                     /* by point: number of the wall's corner there */
    int i, k, e, first = 0, passed = 0;
    for (i = group; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        const size_t n = (size_t)wall->element_count + 1;
        if (!demi_join_member(w, i, group, j->per)) continue;
        first = passed;
        passed += wall->vertex_count;
        wall->number_count += wall->cut_count;
        if (!wall->cut_count) continue;
        wall->cut_start = (int32_t *)demi_hold(w, DEMI_SCENE, n, sizeof(int32_t));
        wall->cuts = (demi_cut *)demi_hold(w, DEMI_SCENE, (size_t)wall->cut_count,
                                           sizeof(demi_cut));
        if (!wall->cut_start || !wall->cuts) return 0;
        for (k = 0; k < j->points; k++) own[k] = -1;
        for (k = 0; k < wall->vertex_count; k++) {
            const int32_t at = j->same[first + k];
            if (own[at] < 0) own[at] = wall->element_count + wall->edge_count + k;
        }
        for (k = 0; k < j->cuts; k++) if (j->cut[6*k] == i) wall->cut_start[j->cut[6*k + 1] + 1]++;
        for (k = 0; k < wall->element_count; k++) wall->cut_start[k + 1] += wall->cut_start[k];
        for (k = j->cuts - 1; k >= 0; k--) {    /* backwards: starts end where they were */
            const int32_t *c = j->cut + 6*k;
            demi_cut *to;
            if (c[0] != i) continue;
            to = wall->cuts + --wall->cut_start[c[1] + 1];
            to->a = demi_join_local(j, wall, c[2]);
            to->b = demi_join_local(j, wall, c[3]);
            to->number = c[4];
            to->side = c[5];
            for (e = 0; e < 2; e++)             /* corners of other walls: beyond its own numbers */
                to->end[e] = own[c[2 + e]] >= 0 ? own[c[2 + e]]
                    : wall->number_count + c[2 + e];
            to->weight = (dem_real)j->cut_weight[k];
        }
        for (k = 0; k < wall->element_count; k++) wall->cut_start[k] = wall->cut_start[k + 1];
        wall->cut_start[wall->element_count] = wall->cut_count;
        wall->number_count += j->points;
    }
    return 1;
}
/* Removes the cuts of a wall: then only facets that share corners are neighbours. */
static void demi_facets_drop_cuts(dem_world *w, demi_wall *wall) {
    demi_free(w, wall->cut_start);
    demi_free(w, wall->cuts);
    wall->cut_start = 0;
    wall->cuts = 0;
    wall->cut_count = 0;
}
/* Marks the walls of a group that share nothing with others or with their own images. */
static void demi_join_lone(dem_world *w, int group, int per) {
    int i, members = 0;
    for (i = group; i < w->wall_count; i++) members += demi_join_member(w, i, group, per);
    for (i = group; i < w->wall_count; i++) {
        const int *repeats = w->walls[i].repeats;
        if (demi_join_member(w, i, group, per))
            w->walls[i].lone = members == 1 && !repeats[0] && !repeats[1] && !repeats[2];
    }
}
/* Groups the walls and computes the weights of their facets again. Returns 0 if memory ran out; the
   next call then tries again. */
static int demi_facets_weigh(dem_world *w) {
    int i, k, per, ok = 1;
    demi_walls_repeat(w);
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        for (k = 0; k < i; k++)
            if (w->walls[k].kind != DEMI_WALL_NONE && demi_walls_together(&w->walls[k], wall))
                break;
        wall->group = k;
        if (!demi_faceted(wall)) continue;
        demi_facets_drop_cuts(w, wall);
        wall->number_count = wall->element_count + wall->edge_count + wall->vertex_count;
        memset(wall->weight, 0, ((size_t)wall->element_count + (size_t)wall->edge_count +
                                 (size_t)wall->vertex_count)*sizeof(dem_real));
    }
    for (i = 0; i < w->wall_count && ok; i++)
        for (per = 2; per <= 3 && ok; per++) {
            demi_join j;
            if (w->walls[i].kind == DEMI_WALL_NONE || w->walls[i].group != i) continue;
            for (k = i; k < w->wall_count && !demi_join_member(w, k, i, per);) k++;
            if (k == w->wall_count) continue;
            demi_join_lone(w, i, per);
            ok = demi_join_begin(w, &j, i, per);
            if (ok) demi_join_double(&j);
            if (ok) ok = per == 3 ? demi_join_cut(w, &j) : demi_join_profiles(w, &j);
            if (ok && per == 3) demi_join_edges(w, &j);
            if (ok) demi_join_corners(w, &j);
            if (ok) ok = demi_join_hand(w, &j, i);
            demi_join_free(w, &j);
        }
    w->facets_valid = ok;
    return ok;
}
