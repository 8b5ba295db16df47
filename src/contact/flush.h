/* ---------------------------------------------------------------------------------------------
   >>flush
   Fixed polyhedra that touch, such as blocks side by side, act on other bodies as one body with
   their common surface. Each is a body of its own in all lists, so a grain on a seam would touch
   the inner faces between them and their edges, where this surface has none. A contact with one of
   them is therefore left out where it is a contact with the inside of another:
   - of spheres and ellipsoids, if the nearest point of one lies in another that is as near;
   - of polyhedra, by impulses, if its point lies in another that continues beyond its face or, at an
     edge or corner, beyond the plane across its normal.
   Which of two that are equally near keeps the contact depends only on where they are. The one that
   takes over from the other continues its history.

   The table lists, for every fixed polyhedron, the others whose boxes it touches. It is made once
   for each list of candidates. This part owns the flush_... fields of dem_world.
   --------------------------------------------------------------------------------------------- */

/* c->from of a contact that has taken over the history of another one, c->memory. */
enum { DEMI_TAKEN_OVER = -2 };
/* True if body i is fixed and consists of polyhedra. */
static int demi_flush_is(const dem_world *w, int i) {
    const demi_shape *shape = demi_shape_of(w, i);
    return w->bodies.inv_mass[i] <= 0 && shape && shape->kind == DEMI_POLYHEDRON;
}
/* Sets the box of body i: middle and half widths, m, a little wider than the body. */
static void demi_flush_box(const dem_world *w, int i, double *middle, double *half) {
    const double hair = 1e-3*(double)w->bodies.pos[4*i + 3];
    int k;
    for (k = 0; k < 3; k++) {
        const dem_vec3 n = demi_v(k == 0, k == 1, k == 2);
        const double hi = (double)demi_support(w, i, n);
        const double lo = -(double)demi_support(w, i, demi_scale(n, -1));
        middle[k] = (double)w->bodies.pos[4*i + k] + (lo + hi)/2;
        half[k] = (hi - lo)/2 + hair;
    }
}
/* Appends to the table the boxes that box n touches; `of` are their bodies. Returns 0 if memory ran
   out. */
static int demi_flush_beside(dem_world *w, const demi_tree *tree, const int32_t *of, int n) {
    const demi_periods p = demi_periods_of(w);
    const double *half = tree->half + 3*n;
    int code, k;
    for (code = 0; code < 27; code++) {
        const int c[3] = {code%3, code/3%3, code/9};
        demi_search_line line;
        double x[3];
        int32_t other;
        for (k = 0; k < 3 && !(c[k] && !(p.period[k] > 0)); k++)
            x[k] = tree->x[3*n + k] + (c[k] - 3*(c[k] == 2))*(double)p.period[k];
        if (k < 3) continue;
        x[0] += (c[1] - 3*(c[1] == 2))*(double)p.offset;
        demi_tree_line(&line, tree, x, x, DEMI_MAX(half[0], DEMI_MAX(half[1], half[2])));
        while ((other = demi_tree_next(&line)) >= 0) {
            for (k = 0; k < 3; k++)
                if (fabs(tree->x[3*other + k] - x[k]) > tree->half[3*other + k] + half[k]) break;
            if (k < 3 || other == n) continue;
            if (!DEMI_GROW(w, w->flush_with, (size_t)w->flush_count + 1)) return 0;
            w->flush_with[w->flush_count++] = of[other];
        }
    }
    return 1;
}
/* Makes the table. Returns 0 if memory ran out. */
static int demi_flush_make(dem_world *w) {
    double *box = 0;
    int32_t *of = 0;
    demi_tree tree;
    int i, n, ok;
    memset(&tree, 0, sizeof tree);
    w->flush_count = 0;
    for (i = n = 0; i < w->bodies.count && w->effects.fixed_count > 1 && w->bodies.shaped; i++)
        n += demi_flush_is(w, i);
    w->flush_valid = n < 2;
    if (w->flush_valid) return 1;
    ok = demi_grow(w, DEMI_LOOSE, &box, sizeof *box, 6*(size_t)n) &&
        demi_grow(w, DEMI_LOOSE, &of, sizeof *of, (size_t)n) &&
        DEMI_GROW(w, w->flush_start, (size_t)w->bodies.count + 1);
    for (i = n = 0; i < w->bodies.count && ok; i++) if (demi_flush_is(w, i)) of[n++] = i;
    for (i = 0; i < n && ok; i++) demi_flush_box(w, of[i], box + 3*i, box + 3*(n + i));
    tree.half = box + 3*n;
    ok = ok && demi_tree_make(w, &tree, box, n);
    for (i = n = 0; i < w->bodies.count && ok; i++) {
        w->flush_start[i] = w->flush_count;
        if (demi_flush_is(w, i)) ok = demi_flush_beside(w, &tree, of, n++);
    }
    if (ok) w->flush_start[i] = w->flush_count;
    demi_free(w, box);
    demi_free(w, of);
    demi_tree_free(w, &tree);
    return w->flush_valid = ok;
}

/* --- what another body covers. a, p: a body and its part, about whose centre positions are; b, j:
   a fixed body and its part --- */

/* Sets s to the part of the fixed body as p sees it: scaled, if p is an ellipsoid, so that this is
   the unit sphere. Returns 0 if it is no polyhedron or farther from p than `reach`, m. */
static int demi_flush_solid(const dem_world *w, int a, const demi_part *p, int b, int j,
                            dem_real reach, demi_solid *s) {
    const demi_periods periods = demi_periods_of(w);
    const demi_part q = demi_part_now(w, b, j);
    const dem_vec3 way = demi_nearest(&periods, demi_sub(demi_at(w->bodies.pos + 4*b),
                                                         demi_at(w->bodies.pos + 4*a)));
    const dem_vec3 gap = demi_add(demi_sub(way, p->centre), q.centre);
    if (q.kind != DEMI_POLYHEDRON || !(demi_length(gap) < reach + q.radius)) return 0;
    if (p->kind == DEMI_ELLIPSOID) demi_solid_measure(&q, p, gap, s);
    else demi_solid_of(&q, gap, s);
    return 1;
}
/* The distance, m, below which fixed bodies b and o count as touching. */
static double demi_flush_tiny(const dem_world *w, int b, int o) {
    const dem_real far = demi_length(demi_at(w->bodies.pos + 4*b));
    return 1e-6*(double)(w->bodies.pos[4*b + 3] + w->bodies.pos[4*o + 3]) +
        (DEMI_SINGLE ? 5e-7 : 1e-15)*(double)far;
}
/* True if x is in s or at most tiny, m, beyond one of its faces. */
static int demi_solid_about(const demi_solid *s, demi_d3 x, double tiny) {
    int f;
    for (f = 0; f < s->faces; f++)
        if (!(demi_solid_in(s, f, x)*s->face[f].high > -tiny)) return 0;
    return 1;
}
/* True if fixed body b comes before fixed body o: on an axis on which they differ. */
static int demi_flush_first(const dem_world *w, int b, int o) {
    const demi_periods p = demi_periods_of(w);
    const dem_vec3 d = demi_nearest(&p, demi_sub(demi_at(w->bodies.pos + 4*o),
                                                 demi_at(w->bodies.pos + 4*b)));
    if (d.x > 0 || d.x < 0) return d.x > 0;
    if (d.y > 0 || d.y < 0) return d.y > 0;
    return d.z > 0 || (!(d.z < 0) && w->bodies.slot[b] < w->bodies.slot[o]);
}
/* True if body a ignores body o. */
static int demi_flush_ignores(const dem_world *w, int a, int o) {
    return w->effects.ignoring &&
        demi_ignores(w, w->bodies.material[a] - 1, w->bodies.material[o] - 1);
}
/* True if another fixed body covers the point of b nearest to p, a sphere or an ellipsoid. */
static int demi_flush_covers(const dem_world *w, int a, const demi_part *p, int b, int j) {
    const dem_real reach = 2*p->radius + 2*demi_range(w, p->radius + w->bodies.pos[4*b + 3]);
    demi_solid s, t;
    demi_d3 x, y;
    double off = 0;
    int k, i;
    for (k = w->flush_start[b]; k < w->flush_start[b + 1]; k++) {
        const int o = w->flush_with[k], parts = demi_parts_count(w, o);
        if (demi_flush_ignores(w, a, o)) continue;
        if (!(off > 0 || off < 0)) {
            if (!demi_flush_solid(w, a, p, b, j, reach, &s)) return 0;
            off = demi_solid_near(&s, demi_d(0, 0, 0), &x);
        }
        for (i = 0; i < parts; i++) {
            double its;
            if (!demi_flush_solid(w, a, p, o, i, reach, &t) ||
                !demi_solid_about(&t, x, demi_flush_tiny(w, b, o))) continue;
            its = demi_solid_near(&t, demi_d(0, 0, 0), &y);
            if (its < off || (!(off < its) && demi_flush_first(w, o, b))) return 1;
        }
    }
    return 0;
}
/* True if another fixed body continues where polyhedron p touches b at x, with the normal n from p
   to b (unit). */
static int demi_flush_continues(const dem_world *w, int a, const demi_part *p, int b, int j,
                                demi_d3 x, demi_d3 n) {
    const dem_real reach = 2*p->radius + 2*demi_range(w, p->radius + w->bodies.pos[4*b + 3]);
    const demi_d3 out = demi_d3_scale(n, -1);
    demi_solid s, t;
    double along;
    int k, i, c, f;
    if (w->flush_start[b] == w->flush_start[b + 1] || !demi_flush_solid(w, a, p, b, j, reach, &s))
        return 0;
    f = demi_solid_facing(&s, out, &along);
    if (along >= DEMI_FLUSH) {                  /* a little into the face */
        demi_d3 middle = demi_d(0, 0, 0);
        for (i = s.rim[f]; i < s.rim[f + 1]; i++)
            middle = demi_d3_plus(middle, 1.0/(s.rim[f + 1] - s.rim[f]), demi_solid_corner(&s, f, i));
        x = demi_d3_between(x, middle, 1e-3);
    }
    for (k = w->flush_start[b]; k < w->flush_start[b + 1]; k++) {
        const int o = w->flush_with[k], parts = demi_parts_count(w, o);
        for (i = 0; i < parts && !demi_flush_ignores(w, a, o); i++) {
            if (!demi_flush_solid(w, a, p, o, i, reach, &t) ||
                !demi_solid_about(&t, x, demi_flush_tiny(w, b, o))) continue;
            if (along >= DEMI_FLUSH) return 1;
            for (c = 0; c < t.corners; c++) {
                const demi_d3 to = demi_d3_sub(t.corner[c], x);
                if (demi_d3_dot(to, out) > 1e-4*demi_d3_length(to)) return 1;
            }
        }
    }
    return 0;
}
/* Removes points of contact c of polyhedra p and q where a fixed body has an inner face. gap: from
   p's centre to q's, m. Returns the number of the others. */
static int demi_flush_spots(const dem_world *w, const demi_kept *c, const demi_part *p,
                            const demi_part *q, dem_vec3 gap, demi_spots *spots) {
    const int first = demi_flush_is(w, c->a);   /* the fixed one */
    const demi_d3 off = first ? demi_d3_of(gap) : demi_d(0, 0, 0);
    const demi_d3 n = demi_d3_scale(spots->normal, first ? -1 : 1);
    int k, left = 0;
    for (k = 0; k < spots->count; k++) {
        const demi_d3 x = demi_d3_plus(demi_d3_sub(spots->x[k], off), spots->gap[k]/2, n);
        if (first ? demi_flush_continues(w, c->b, q, c->a, c->part_a, x, n)
            : demi_flush_continues(w, c->a, p, c->b, c->part_b, x, n)) continue;
        spots->x[left] = spots->x[k];
        spots->gap[left++] = spots->gap[k];
    }
    return spots->count = left;
}

/* --- the history of a contact that takes over from another one --- */

/* Returns the first old contact of body a with a body, of its work group; null if it has none. */
static const demi_kept *demi_flush_old(const dem_world *w, int a, const demi_kept **end) {
    const int d = demi_domain_of(w, a);
    const demi_kept *old = demi_kept_of(w, d);
    int lo = 0, hi = w->domains[d].kept;
    *end = old + hi;
    while (lo < hi) {
        const int mid = lo + (hi - lo)/2;
        if (old[mid].a < a) lo = mid + 1;
        else hi = mid;
    }
    return old + lo;
}
/* Lets a new contact c of part p of body a with a fixed body b continue an old one of p with another
   fixed body, at nearly the same normal, which b now covers. */
static void demi_flush_take_over(const dem_world *w, int a, const demi_part *p, int part, int b,
                                 demi_kept *c) {
    const demi_kept *best = 0, *o, *end;
    dem_real most = DEM_R(0.95), turn = 1;
    int k, e;
    for (k = w->flush_start[b]; k < w->flush_start[b + 1]; k++) {
        const int other = w->flush_with[k], low = DEMI_MIN(a, other), high = DEMI_MAX(a, other);
        for (o = demi_flush_old(w, low, &end); o < end && o->a == low; o++) {
            const dem_real side = (o->a == a) == (c->a == a) ? DEM_R(1) : DEM_R(-1);
            const dem_real along = side*demi_dot(o->normal, c->normal);
            if (o->b != high || (o->a == a ? o->part_a : o->part_b) != part || !(along > most) ||
                !demi_flush_covers(w, a, p, other, o->a == a ? o->part_b : o->part_a)) continue;
            most = along;
            best = o;
            turn = side;
        }
    }
    if (!best) return;
    for (e = 0; e < w->memory_stride; e++)
        c->memory[e] = w->vector_mask >> e & 1 ? turn*best->memory[e] : best->memory[e];
    c->from = DEMI_TAKEN_OVER;
}
/* True if contact c of parts p and q, which have just been found to touch, is none of the common
   surface of fixed bodies. gap: from p's centre to q's, m; spots: its points, if it has several. */
static int demi_flush_within(const dem_world *w, demi_kept *c, const demi_part *p,
                             const demi_part *q, dem_vec3 gap, demi_spots *spots) {
    const int first = demi_flush_is(w, c->a);
    const int a = first ? c->b : c->a, b = first ? c->a : c->b;
    const int part = first ? c->part_b : c->part_a, its = first ? c->part_a : c->part_b;
    if (!(first || demi_flush_is(w, b)) || (first ? p : q)->kind != DEMI_POLYHEDRON) return 0;
    if (spots->count) return !demi_flush_spots(w, c, p, q, gap, spots);
    if ((first ? q : p)->kind == DEMI_POLYHEDRON) return 0;
    if (demi_flush_covers(w, a, first ? q : p, b, its)) return 1;
    if (c->from < 0) demi_flush_take_over(w, a, first ? q : p, part, b, c);
    return 0;
}
