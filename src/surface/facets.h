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
   multiplied by its weight. Walls that do not move relative to each other are joined to one surface
   (>>surfaces). Not joined, so that contacts add up as in a corner: facets that intersect, cracks,
   and seams between walls of different kinds. That the Euler characteristic is additive is well
   known; as a contact rule we have not found it published. Tests: tests/surface/test_facets.c.
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
    const double *x, *half;        /* points x 3, m: not a copy; half sizes of boxes about them, or
                                      null */
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
        box[k] = 1e300;
        box[3 + k] = -1e300;
        for (i = from; i < to; i++) {
            const int p = 3*t->order[i] + k;
            const double at = t->x[p], half = t->half ? t->half[p] : 0;
            box[k] = DEMI_MIN(box[k], at - half);
            box[3 + k] = DEMI_MAX(box[3 + k], at + half);
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
    wall->owns = (unsigned char *)demi_hold(w, wall->chain, (size_t)all, 1);
    wall->edges = (int32_t *)demi_hold(w, wall->chain, (size_t)all*3, sizeof(int32_t));
    wall->planes = (dem_real *)demi_hold(w, wall->chain, (size_t)all*4, sizeof(dem_real));
    wall->ends = (unsigned char *)demi_hold(w, wall->chain, (size_t)all, 1);
    if (!x || !same || !sides || !near_by || !wall->owns || !wall->edges || !wall->planes ||
        !wall->ends) goto done;
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
        wall->ends[i] = 1;                      /* until weights are there */
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
    wall->weight = (dem_real *)demi_hold(w, wall->chain,
                                         (size_t)all + (size_t)wall->edge_count + vertices,
                                          sizeof(dem_real));
    ok = wall->weight != 0;
    for (i = 0; i < all && ok; i++) wall->weight[i] = (dem_real)wall->ends[i];
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
