/* ---------------------------------------------------------------------------------------------
   >>coarsen
   Facets that lie in one plane are merged, so that the cost of a contact does not depend on how
   finely a file divides a flat surface. A region is a connected set of facets of one wall in the
   plane of its first facet. A point is removed if all facets at it are of one region, or if it lies
   on the straight border of a region: of one other region, or of the surface. The hole is filled
   with fewer triangles. Shape, borders and conformity stay as they were. A facet is never farther
   from the surface given than the rounding of its file. Owns nothing; it works on a demi_join.
   --------------------------------------------------------------------------------------------- */

/* The facets at each point, and the region of each facet. */
typedef struct demi_coarse {
    demi_join *j;
    int32_t *head, *next;          /* points: 3*facet + corner, or -1; facets x 3: the next one */
    int32_t *region;               /* facets: seed facet, -1: removed */
    double tiny;                   /* m, distance at which points count as in a plane */
    int keep_borders;              /* 1: points on the border of the surface stay */
} demi_coarse;

/* The distance, m, within which points of a file lie in its planes: the rounding of its numbers,
   which are often of single precision. */
static double demi_coarse_tiny(const dem_world *w, const demi_join *j) {
    double most = 0;
    int i, k, rough = DEMI_SINGLE;
    for (i = j->lead; i < w->wall_count && !rough; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, j->lead, j->per)) continue;
        for (k = 0, rough = 1; k < 3*wall->vertex_count && rough; k++) {
            const double x = (double)wall->vertices[k], y = (double)(float)x;
            rough = !(x < y) && !(x > y);
        }
    }
    for (i = 0; i < 3*j->points; i++) most = DEMI_MAX(most, fabs(j->x[i]));
    return most*(rough ? 2*(double)FLT_EPSILON : 64*DBL_EPSILON);
}
static demi_d3 demi_coarse_normal(const demi_join *j, int f) {
    const int32_t *c = j->facet + 5*f;
    return demi_d3_unit(demi_d3_normal(demi_d3_at(j->x + 3*c[0]), demi_d3_at(j->x + 3*c[1]),
                                       demi_d3_at(j->x + 3*c[2])));
}
/* Finds the regions. stack: room for all facets. Uses c->next for the facet across each side. */
static void demi_coarse_regions(const demi_coarse *c, int32_t *stack) {
    demi_join *j = c->j;
    int32_t *beside = c->next;
    int f, k, m, count, end;
    for (f = 0; f < 3*j->facets; f++) beside[f] = -1;
    demi_join_sides(j);
    for (f = 0; f < j->sides; f = end) {        /* two facets, in opposite directions */
        const demi_side *s = j->side + f;
        end = demi_sides_end(j->side, j->sides, f);
        if (end != f + 2 || demi_join_sign(j, s) == demi_join_sign(j, s + 1) ||
            j->facet[5*s->facet + 3] != j->facet[5*s[1].facet + 3]) continue;
        beside[3*s->facet + s->side] = s[1].facet;
        beside[3*s[1].facet + s[1].side] = s->facet;
    }
    for (f = 0; f < j->facets; f++) c->region[f] = -1;
    for (f = 0; f < j->facets; f++) {
        const demi_d3 n = demi_coarse_normal(j, f), o = demi_d3_at(j->x + 3*j->facet[5*f]);
        if (c->region[f] >= 0) continue;
        c->region[f] = f;
        stack[0] = f;
        for (count = 1; count > 0;) {
            const int32_t g = stack[--count];
            for (k = 0; k < 3; k++) {
                const int32_t other = beside[3*g + k];
                if (other < 0 || c->region[other] >= 0) continue;
                for (m = 0; m < 3; m++)
                    if (!(fabs(demi_d3_dot(n, demi_d3_sub(demi_d3_at(
                        j->x + 3*j->facet[5*other + m]), o))) <= c->tiny)) break;
                if (m < 3 || !(demi_d3_dot(n, demi_coarse_normal(j, other)) > 0.999)) continue;
                c->region[other] = f;
                stack[count++] = other;
            }
        }
    }
}
/* A star: the sides opposite to a point of the facets at it, in order. */
typedef struct demi_star {
    int count, open;               /* open: 1 if it ends at borders of the surface */
    int32_t facet[DEMI_POLYGON], from[DEMI_POLYGON], to[DEMI_POLYGON];
} demi_star;
/* Finds the star of point v. Returns 0 if its facets are not one row or ring. */
static int demi_coarse_star(const demi_coarse *c, int32_t v, demi_star *s) {
    const demi_join *j = c->j;
    demi_star all;
    int32_t at;
    int i, k, first = 0;
    all.count = s->open = 0;
    for (at = c->head[v]; at >= 0; at = c->next[at]) {
        if (all.count == DEMI_POLYGON - 2) return 0;
        all.facet[all.count] = at/3;
        all.from[all.count] = j->facet[5*(at/3) + (at + 1)%3];
        all.to[all.count++] = j->facet[5*(at/3) + (at + 2)%3];
    }
    if (all.count < 2) return 0;
    for (i = 0; i < all.count; i++) {           /* begin behind a border, else behind a region */
        for (k = 0; k < all.count && all.to[k] != all.from[i]; k++) continue;
        if (k == all.count) { s->open++; first = i; }
        else if (!s->open && c->region[all.facet[k]] != c->region[all.facet[i]]) first = i;
    }
    if (s->open > 1) return 0;
    for (s->count = 0; s->count < all.count; s->count++) {
        s->facet[s->count] = all.facet[first];
        s->from[s->count] = all.from[first];
        s->to[s->count] = all.to[first];
        for (k = 0, i = -1; k < all.count; k++) {
            if (all.from[k] != s->to[s->count]) continue;
            if (i >= 0) return 0;
            i = k;
        }
        if (i < 0) break;
        first = i;
    }
    if (s->open) return s->count == all.count - 1 && ++s->count;
    return s->count == all.count && s->to[s->count - 1] == s->from[0];
}
/* True if point v lies on the line between points p and q. */
static int demi_coarse_between(const demi_coarse *c, int32_t v, int32_t p, int32_t q) {
    const demi_d3 a = demi_d3_sub(demi_d3_at(c->j->x + 3*p), demi_d3_at(c->j->x + 3*v));
    const demi_d3 b = demi_d3_sub(demi_d3_at(c->j->x + 3*q), demi_d3_at(c->j->x + 3*v));
    const demi_d3 way = demi_d3_unit(demi_d3_sub(b, a));
    return demi_d3_dot(a, b) < 0 && demi_d3_length(demi_d3_cross(way, a)) <= c->tiny;
}
/* Fills the polygon of the sides first .. end - 1 of a star with triangles, `closed` if it is the
   whole ring. Writes their points, x 3, and returns their number; 0: it cannot be filled. */
static int demi_coarse_fill(const demi_coarse *c, const demi_star *s, int first, int end,
                            int closed, int32_t *out) {
    const demi_join *j = c->j;
    const demi_d3 n = demi_coarse_normal(j, c->region[s->facet[first]]);
    const demi_d3 o = demi_d3_at(j->x + 3*s->from[first]);
    const dem_vec3 across = demi_across(demi_d3_real(n));
    const demi_d3 u = demi_d3_of(across), v = demi_d3_cross(n, u);
    demi_cut_out piece[DEMI_POLYGON];
    int32_t point[DEMI_POLYGON];
    double x[2*DEMI_POLYGON];
    int i, k, count = 0, pieces;
    for (i = first; i < end; i++) point[count++] = s->from[i];
    if (!closed) point[count++] = s->to[end - 1];
    for (i = 0; i < count; i++) {
        const demi_d3 d = demi_d3_sub(demi_d3_at(j->x + 3*point[i]), o);
        x[2*i] = demi_d3_dot(u, d);
        x[2*i + 1] = demi_d3_dot(v, d);
    }
    pieces = demi_polygon_ears(x, count, piece);
    for (i = 0; i < pieces; i++) {
        for (k = 0; k < 3; k++) out[3*i + k] = point[piece[i].corner[k]];
        if (!demi_facet_counts(j->x, j->near_by, out + 3*i, 3)) return 0;
    }
    return pieces;
}
static void demi_coarse_link(const demi_coarse *c, int f, int k) {
    const int32_t p = c->j->facet[5*f + k];
    c->next[3*f + k] = c->head[p];
    c->head[p] = 3*f + k;
}
static void demi_coarse_unlink(const demi_coarse *c, int f) {
    int k;
    for (k = 0; k < 3; k++) {
        int32_t *at = &c->head[c->j->facet[5*f + k]];
        while (*at != 3*f + k) at = &c->next[*at];
        *at = c->next[*at];
    }
}
/* Removes point v if the surface stays the same without it. Returns 1 if it did. */
static int demi_coarse_drop(const demi_coarse *c, int32_t v) {
    int32_t fill[6*DEMI_POLYGON];
    demi_star s;
    int i, k, f, turn = 0, changes = 0, pieces[2] = {0, 0};
    if (!demi_coarse_star(c, v, &s)) return 0;
    for (i = 1; i < s.count; i++)
        if (c->region[s.facet[i]] != c->region[s.facet[i - 1]]) { changes++; turn = i; }
    if (s.open ? changes || c->keep_borders || !demi_coarse_between(c, v, s.from[0],
                                                                    s.to[s.count - 1])
        : changes > 1 || (changes && !demi_coarse_between(c, v, s.from[0], s.from[turn]))) return 0;
    if (!changes) turn = s.count;
    pieces[0] = demi_coarse_fill(c, &s, 0, turn, !s.open && !changes, fill);
    if (!pieces[0]) return 0;
    if (changes) {
        pieces[1] = demi_coarse_fill(c, &s, turn, s.count, 0, fill + 3*pieces[0]);
        if (!pieces[1]) return 0;
    }
    for (i = 0; i < s.count; i++) demi_coarse_unlink(c, s.facet[i]);
    for (i = 0; i < s.count; i++) {             /* facets of either fan take its triangles */
        const int second = i >= turn, own = second ? i - turn : i;
        f = s.facet[i];
        if (own >= pieces[second]) { c->region[f] = -1; continue; }
        for (k = 0; k < 3; k++)
            c->j->facet[5*f + k] = fill[3*(own + (second ? pieces[0] : 0)) + k];
        for (k = 0; k < 3; k++) demi_coarse_link(c, f, k);
    }
    return 1;
}
/* Merges flat neighbours. Returns 0 if memory ran out. */
static int demi_join_coarsen(dem_world *w, demi_join *j) {
    demi_coarse c;
    int32_t *stack = (int32_t *)demi_alloc(w, (size_t)j->facets, sizeof *stack);
    int i, k, left, dropped, any = 0, ok;
    c.j = j;
    c.head = (int32_t *)demi_alloc(w, (size_t)j->points, sizeof *c.head);
    c.next = (int32_t *)demi_alloc(w, (size_t)j->facets*3, sizeof *c.next);
    c.region = (int32_t *)demi_alloc(w, (size_t)j->facets, sizeof *c.region);
    c.tiny = demi_coarse_tiny(w, j);
    c.keep_borders = w->repeating;
    ok = stack && c.head && c.next && c.region &&
        demi_grow(w, DEMI_LOOSE, &j->side, sizeof(demi_side), 3*(size_t)j->facets);
    if (ok) demi_coarse_regions(&c, stack);
    for (i = 0; i < j->points && ok; i++) c.head[i] = -1;
    for (i = 0; i < j->facets && ok; i++) for (k = 0; k < 3; k++) demi_coarse_link(&c, i, k);
    do {
        for (i = dropped = 0; i < j->points && ok; i++)
            if (c.head[i] >= 0) dropped += demi_coarse_drop(&c, i);
        any |= dropped;
    } while (dropped);
    for (i = left = 0; i < j->facets && any; i++) {
        if (c.region[i] < 0) continue;
        memmove(j->facet + 5*left++, j->facet + 5*i, 5*sizeof *j->facet);
    }
    if (any) { j->facets = left; j->changed = 1; }
    demi_free(w, stack);
    demi_free(w, c.head);
    demi_free(w, c.next);
    demi_free(w, c.region);
    return ok;
}
