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

   By springs the pressure of a polyhedron acts on the faces of all that have faces in common, as on
   those of a wall.

   The table lists, for every fixed polyhedron by slot, the others that it touches: twice their slot,
   plus 1 if the two have a part of a face in common. It is made again if one of them is another, or
   elsewhere, when a list of candidates was made. This part owns the flush_... fields of dem_world.
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
/* The other bodies that fixed body b touches are entries begin .. end - 1 of the table. */
DEM_INLINE int demi_flush_begin(const dem_world *w, int b) {
    return w->flush_start[w->bodies.slot[b]];
}
DEM_INLINE int demi_flush_end(const dem_world *w, int b) {
    return w->flush_start[w->bodies.slot[b] + 1];
}
DEM_INLINE int demi_flush_body(const dem_world *w, int k) {
    return w->bodies.slot_index[w->flush_with[k] >> 1];
}
/* True if the two have a part of a face in common. */
DEM_INLINE int demi_flush_faced(const dem_world *w, int k) { return w->flush_with[k] & 1; }
/* True if fixed body b has a face in common with another one. */
static int demi_flush_jointed(const dem_world *w, int b) {
    int k;
    for (k = demi_flush_begin(w, b); k < demi_flush_end(w, b); k++)
        if (demi_flush_faced(w, k)) return 1;
    return 0;
}
/* The distance, m, below which fixed bodies b and o count as touching. */
static double demi_flush_tiny(const dem_world *w, int b, int o) {
    const dem_real far = demi_length(demi_at(w->bodies.pos + 4*b));
    return 1e-6*(double)(w->bodies.pos[4*b + 3] + w->bodies.pos[4*o + 3]) +
        (DEMI_SINGLE ? 5e-7 : 1e-15)*(double)far;
}
/* True if face f of s and face g of t are in one plane, with opposite normals. */
static int demi_faces_opposite(const demi_solid *s, int f, const demi_solid *t, int g,
                               double tiny) {
    const demi_d3 n = demi_d3_scale(s->face[f].slope, s->face[f].high);
    const demi_d3 m = demi_d3_scale(t->face[g].slope, t->face[g].high);
    if (!(demi_d3_length(demi_d3_add(n, m)) < (DEMI_SINGLE ? 1e-5 : 1e-6))) return 0;
    return fabs(s->face[f].high + t->face[g].high +
                demi_d3_dot(n, demi_d3_sub(s->centre, t->centre))) < tiny;
}
/* Writes the sides of face f of s as half spaces and returns their number. */
static int demi_face_sides(const demi_solid *s, int f, demi_half *sides) {
    int i, count = 0;
    for (i = s->rim[f]; i < s->rim[f + 1]; i++, count++) {
        sides[count].o = demi_solid_corner(s, f, i);
        sides[count].n = demi_d3_cross(s->face[f].slope, demi_d3_sub(
            demi_solid_corner(s, f, i + 1), sides[count].o));
    }
    return count;
}
/* True if the two have a part of a face in common. */
static int demi_solids_faced(const demi_solid *s, const demi_solid *t, double tiny) {
    demi_half sides[DEM_POLYHEDRON_FACES];
    demi_d3 x[DEMI_SECTION], area;
    int f, g, i, k, count, all;
    for (f = 0; f < s->faces; f++)
        for (g = 0; g < t->faces; g++) {
            if (!demi_faces_opposite(s, f, t, g, tiny)) continue;
            for (i = s->rim[f], count = 0; i < s->rim[f + 1]; i++)
                x[count++] = demi_solid_corner(s, f, i);
            all = demi_face_sides(t, g, sides);
            for (k = 0; k < all && count > 2; k++)
                count = demi_polygon_clip(x, count, sides[k].n, sides[k].o);
            for (i = 2, area = demi_d(0, 0, 0); i < count; i++)
                area = demi_d3_add(area, demi_d3_normal(x[0], x[i - 1], x[i]));
            if (demi_d3_length(area) > tiny*demi_solid_radius(s)) return 1;
        }
    return 0;
}
/* Returns how fixed bodies i and o touch: 1 in a part of a face, 0 in edges or corners or by an
   overlap, -1 not at all. way: m, from i to o. */
static int demi_flush_how(const dem_world *w, int i, int o, dem_vec3 way) {
    const double tiny = demi_flush_tiny(w, i, o);
    int k, j, how = -1;
    for (k = 0; k < demi_parts_count(w, i); k++)
        for (j = 0; j < demi_parts_count(w, o) && how < 1; j++) {
            const demi_part p = demi_part_now(w, i, k), q = demi_part_now(w, o, j);
            demi_d3 n = demi_d(0, 0, 0);
            demi_simplex s;
            demi_solid a, b;
            if (p.kind != DEMI_POLYHEDRON || q.kind != DEMI_POLYHEDRON) continue;
            demi_solid_of(&p, p.centre, &a);
            demi_solid_of(&q, demi_add(way, q.centre), &b);
            if (demi_solids_apart(&a, &b, tiny, &n, &s) && demi_solids_slab(&a, &b, n) > tiny)
                continue;
            how = demi_solids_faced(&a, &b, tiny);
        }
    return how;
}
/* Appends to the table the bodies that the one of box n touches; `of` are the bodies of the boxes.
   Returns 0 if memory ran out. */
static int demi_flush_beside(dem_world *w, const demi_tree *tree, const int32_t *of, int n) {
    const demi_periods p = demi_periods_of(w);
    const double *half = tree->half + 3*n, most = DEMI_MAX(half[0], DEMI_MAX(half[1], half[2]));
    int code, k, how;
    for (code = 0; code < 27; code++) {
        const int c[3] = {code%3 - 1, code/3%3 - 1, code/9 - 1};
        demi_search_line line;
        double x[3];
        int32_t other;
        for (k = 0; k < 3 && !(c[k] && !(p.period[k] > 0)); k++)
            x[k] = tree->x[3*n + k] + c[k]*(double)p.period[k];
        if (k < 3) continue;
        x[0] += c[1]*(double)p.offset;
        demi_tree_line(&line, tree, x, x, most);
        while ((other = demi_tree_next(&line)) >= 0) {
            const dem_vec3 way = demi_sub(demi_at(w->bodies.pos + 4*of[other]),
                                          demi_at(w->bodies.pos + 4*of[n]));
            for (k = 0; k < 3; k++)
                if (fabs(tree->x[3*other + k] - x[k]) > tree->half[3*other + k] + half[k]) break;
            if (k < 3 || other == n) continue;
            how = demi_flush_how(w, of[n], of[other], demi_nearest(&p, way));
            if (how < 0) continue;
            if (!DEMI_GROW(w, w->flush_with, (size_t)w->flush_count + 1)) return 0;
            w->flush_with[w->flush_count++] = 2*(int32_t)w->bodies.slot[of[other]] + how;
        }
    }
    return 1;
}
/* A digest of all bodies that the table is about; *count receives their number. */
static uint64_t demi_flush_digest(const dem_world *w, int *count) {
    uint64_t digest = UINT64_C(14695981039346656037);
    int slot, k;
    for (slot = *count = 0; slot < w->bodies.slot_count; slot++) {
        const int i = w->bodies.slot_index[slot];
        double x[9];
        const unsigned char *at = (const unsigned char *)x;
        if (i < 0 || !demi_flush_is(w, i)) continue;
        for (k = 0; k < 4; k++) x[k] = (double)w->bodies.pos[4*i + k];
        for (k = 0; k < 4; k++) x[4 + k] = (double)w->bodies.orient[4*i + k];
        x[8] = slot + w->bodies.shape[i]*4294967296.0;
        for (k = 0; k < (int)sizeof x; k++) digest = (digest ^ at[k])*UINT64_C(1099511628211);
        ++*count;
    }
    return digest;
}
/* Makes the table, unless it fits. Returns 0 if memory ran out. */
static int demi_flush_make(dem_world *w) {
    const int some = w->bodies.shaped && w->effects.fixed_count > 1;
    double *box = 0;
    int32_t *of = 0;
    demi_tree tree;
    int slot, n = 0, boxes, ok;
    const uint64_t digest = some ? demi_flush_digest(w, &n) : 0;
    w->flush_valid = 1;
    if (digest == w->flush_digest) return 1;
    memset(&tree, 0, sizeof tree);
    w->flush_count = 0;
    w->flush_digest = digest;
    if (n < 2) return 1;
    ok = demi_grow(w, DEMI_LOOSE, &box, sizeof *box, 6*(size_t)n) &&
        demi_grow(w, DEMI_LOOSE, &of, sizeof *of, (size_t)n) &&
        DEMI_GROW(w, w->flush_start, (size_t)w->bodies.slot_count + 1);
    for (slot = boxes = 0; slot < w->bodies.slot_count && ok; slot++) {
        const int i = w->bodies.slot_index[slot];
        if (i < 0 || !demi_flush_is(w, i)) continue;
        demi_flush_box(w, i, box + 3*boxes, box + 3*(n + boxes));
        of[boxes++] = i;
    }
    tree.half = box + 3*n;
    ok = ok && demi_tree_make(w, &tree, box, n);
    for (slot = boxes = 0; slot < w->bodies.slot_count && ok; slot++) {
        w->flush_start[slot] = w->flush_count;
        if (boxes < n && (int)w->bodies.slot[of[boxes]] == slot)
            ok = demi_flush_beside(w, &tree, of, boxes++);
    }
    if (ok) w->flush_start[slot] = w->flush_count;
    else w->flush_digest = 0;
    demi_free(w, box);
    demi_free(w, of);
    demi_tree_free(w, &tree);
    return w->flush_valid = ok;
}

/* --- what another body covers. a, p: a body and its part, about whose centre positions are; b, j:
   a fixed body and its part --- */

/* From the centre of p to that of the fixed body, m. */
static dem_vec3 demi_flush_way(const dem_world *w, int a, const demi_part *p, int b) {
    const demi_periods periods = demi_periods_of(w);
    return demi_sub(demi_nearest(&periods, demi_sub(demi_at(w->bodies.pos + 4*b),
                                                    demi_at(w->bodies.pos + 4*a))), p->centre);
}
/* Sets s to the part of the fixed body as p sees it: scaled, if p is an ellipsoid, so that this is
   the unit sphere. Returns 0 if it is no polyhedron or farther from p than `reach`, m. */
static int demi_flush_solid(const dem_world *w, int a, const demi_part *p, int b, int j,
                            dem_real reach, demi_solid *s) {
    const demi_part q = demi_part_now(w, b, j);
    const dem_vec3 gap = demi_add(demi_flush_way(w, a, p, b), q.centre);
    if (q.kind != DEMI_POLYHEDRON || !(demi_length(gap) < reach + q.radius)) return 0;
    if (p->kind == DEMI_ELLIPSOID) demi_solid_measure(&q, p, gap, s);
    else demi_solid_of(&q, gap, s);
    if (w->desc.planar && demi_response_is(w, DEMI_PRESSING)) demi_solid_stretch(s);
    return 1;
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
    for (k = demi_flush_begin(w, b); k < demi_flush_end(w, b); k++) {
        const int o = demi_flush_body(w, k), parts = demi_parts_count(w, o);
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
    if (demi_flush_begin(w, b) == demi_flush_end(w, b) || !demi_flush_solid(w, a, p, b, j, reach, &s))
        return 0;
    f = demi_solid_facing(&s, out, &along);
    if (along >= DEMI_FLUSH) {                  /* a little into the face */
        demi_d3 middle = demi_d(0, 0, 0);
        for (i = s.rim[f]; i < s.rim[f + 1]; i++)
            middle = demi_d3_plus(middle, 1.0/(s.rim[f + 1] - s.rim[f]), demi_solid_corner(&s, f, i));
        x = demi_d3_between(x, middle, 1e-3);
    }
    for (k = demi_flush_begin(w, b); k < demi_flush_end(w, b); k++) {
        const int o = demi_flush_body(w, k), parts = demi_parts_count(w, o);
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

/* --- pressure of polyhedra on the common surface, by springs (>>polyhedra): as on a rigid wall of
   the faces of all bodies, without what two of them have in common --- */

enum { DEMI_FLUSH_NEAR = 128 };    /* largest number of fixed bodies that a polyhedron presses on */
typedef struct demi_flush_press {
    demi_pressure own;             /* on the part in question */
    double shared, force;          /* m3, m2: I; sum of the forces on all parts */
} demi_flush_press;
/* Adds to out the pressure of s on face f of t; with `other`, minus that on what the face has in
   common with face g of other. */
static void demi_flush_face(const demi_solid *s, const demi_solid *t, int f,
                            const demi_solid *other, int g, demi_pressure *out) {
    demi_half sides[2*DEM_POLYHEDRON_FACES];
    const demi_d3 up = demi_d3_scale(t->face[f].slope, t->face[f].high);
    int count = demi_face_sides(t, f, sides);
    demi_pressure press;
    if (other) count += demi_face_sides(other, g, sides + count);
    memset(&press, 0, sizeof press);
    demi_solid_on_flat(s, demi_d3_scale(up, -1), -demi_d3_dot(up, t->centre) - t->face[f].high,
                       sides, count, 0, &press);
    if (other) demi_pressure_scale(&press, -1);
    demi_pressure_add(out, &press);
}
/* Sets *out to the pressure of p (s: about its centre) on part i of fixed body o: on its faces
   without what others cover. */
static void demi_flush_part(const dem_world *w, int a, const demi_part *p, const demi_solid *s,
                            int o, int i, demi_pressure *out) {
    demi_solid t, other;
    int f, g, k, j;
    memset(out, 0, sizeof *out);
    if (!demi_flush_solid(w, a, p, o, i, p->radius, &t)) return;
    for (f = 0; f < t.faces; f++) demi_flush_face(s, &t, f, 0, 0, out);
    if (demi_solid_holds(&t, s->centre))
        demi_pressure_beyond(s, demi_d3_unit(t.centre), out);
    for (k = demi_flush_begin(w, o); k < demi_flush_end(w, o) && out->sum > 0; k++) {
        const int b = demi_flush_body(w, k);
        const int parts = demi_flush_faced(w, k) ? demi_parts_count(w, b) : 0;
        const double tiny = demi_flush_tiny(w, o, b);
        for (j = 0; j < parts && !demi_flush_ignores(w, a, b); j++) {
            if (!demi_flush_solid(w, a, p, b, j, p->radius, &other)) continue;
            for (f = 0; f < t.faces; f++)
                for (g = 0; g < other.faces; g++)
                    if (demi_faces_opposite(&t, f, &other, g, tiny))
                        demi_flush_face(s, &t, f, &other, g, out);
        }
    }
}
/* Sets *out to the pressure of polyhedron p on part j of fixed body b, which others touch, and on
   all that belong to the same surface near p. Returns 0 if there is none on b. */
static int demi_flush_pressed(const dem_world *w, int a, const demi_part *p, int b, int j,
                              demi_flush_press *out) {
    int32_t near[DEMI_FLUSH_NEAR];
    demi_pressure press;
    demi_solid s;
    int n, i, k, m, count = 1;
    demi_solid_of(p, demi_v(0, 0, 0), &s);
    demi_flush_part(w, a, p, &s, b, j, &out->own);
    out->shared = out->force = 0;
    if (!(out->own.sum > 0)) return 0;
    for (near[0] = b, n = 0; n < count; n++) {
        const int o = near[n], parts = demi_parts_count(w, o);
        for (i = 0; i < parts; i++) {
            if (o == b && i == j) press = out->own;
            else demi_flush_part(w, a, p, &s, o, i, &press);
            out->shared += press.shared;
            out->force += demi_d3_length(press.force);
        }
        for (k = demi_flush_begin(w, o); k < demi_flush_end(w, o); k++) {
            const int next = demi_flush_body(w, k);
            const dem_vec3 way = demi_flush_way(w, a, p, next);
            for (m = 0; m < count && near[m] != next; m++) continue;
            if (m == count && m < DEMI_FLUSH_NEAR && demi_flush_faced(w, k) &&
                !demi_flush_ignores(w, a, next) &&
                demi_length(way) < p->radius + w->bodies.pos[4*next + 3]) near[count++] = next;
        }
    }
    return out->shared > 0 && demi_d3_length(out->own.force) > 1e-9*out->force;
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
   fixed body, at nearly the same normal: of spheres and ellipsoids one that b now covers. */
static void demi_flush_take_over(const dem_world *w, int a, const demi_part *p, int part, int b,
                                 demi_kept *c) {
    const demi_kept *best = 0, *o, *end;
    dem_real most = DEM_R(0.95), turn = 1;
    int k, e;
    for (k = demi_flush_begin(w, b); k < demi_flush_end(w, b); k++) {
        const int other = demi_flush_body(w, k), low = DEMI_MIN(a, other), high = DEMI_MAX(a, other);
        for (o = demi_flush_old(w, low, &end); o < end && o->a == low; o++) {
            const dem_real side = (o->a == a) == (c->a == a) ? DEM_R(1) : DEM_R(-1);
            const dem_real along = side*demi_dot(o->normal, c->normal);
            if (o->b != high || (o->a == a ? o->part_a : o->part_b) != part || !(along > most) ||
                (c->corners ? o->corner != (side > 0 ? c->corner : c->corner ^ 1)
                 : !demi_flush_covers(w, a, p, other, o->a == a ? o->part_b : o->part_a)))
                continue;
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
/* The same for all points of a new contact c of parts p and q. */
static void demi_flush_follow(const dem_world *w, demi_kept *c, const demi_part *p,
                              const demi_part *q) {
    const int first = demi_flush_is(w, c->a), points = DEMI_MAX(c->corners, 1);
    int i;
    if (!(first || (c->b >= 0 && demi_flush_is(w, c->b))) || c->from >= 0) return;
    for (i = 0; i < points; i++)
        if (c[i].from < 0)
            demi_flush_take_over(w, first ? c->b : c->a, first ? q : p,
                                 first ? c->part_b : c->part_a, first ? c->a : c->b, &c[i]);
}
/* True if contact c of parts p and q, which have just been found to touch, is none of the common
   surface of fixed bodies. gap: from p's centre to q's, m; spots: its points, if it has several. */
static int demi_flush_within(const dem_world *w, const demi_kept *c, const demi_part *p,
                             const demi_part *q, dem_vec3 gap, demi_spots *spots) {
    const int first = demi_flush_is(w, c->a);
    if (!(first || demi_flush_is(w, c->b)) || (first ? p : q)->kind != DEMI_POLYHEDRON) return 0;
    if (spots->count) return !demi_flush_spots(w, c, p, q, gap, spots);
    if ((first ? q : p)->kind == DEMI_POLYHEDRON) return 0;
    return first ? demi_flush_covers(w, c->b, q, c->a, c->part_a)
        : demi_flush_covers(w, c->a, p, c->b, c->part_b);
}
/* True if one of the bodies of contact c of two polyhedra is fixed and has faces in common with
   another. */
static int demi_flush_surface(const dem_world *w, const demi_kept *c) {
    return (demi_flush_is(w, c->a) && demi_flush_jointed(w, c->a)) ||
        (demi_flush_is(w, c->b) && demi_flush_jointed(w, c->b));
}
