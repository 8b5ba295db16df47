/* ---------------------------------------------------------------------------------------------
   >>flush
   Fixed polyhedra that touch, such as blocks side by side, act on other bodies as one body with
   their common surface. Each is a body of its own in all lists, so a grain on a seam would touch
   the inner faces between them and their edges, where this surface has none. A contact with one of
   them is therefore left out where it is a contact with the inside of another:
   - of spheres and ellipsoids, if the nearest point of one lies in another that is as near;
   - of polyhedra, by impulses, if its point lies in another that continues beyond its face or, at
     an edge or corner, beyond the plane across its normal.
   Which of two that are equally near keeps the contact depends only on where they are. The one that
   takes over from the other continues its history.

   By springs the pressure of a polyhedron acts on the faces of all that have faces in common, as on
   those of a wall.

   The table has a row for each fixed polyhedron, with its pieces and links to the others that it
   touches. It is made again if one of them is another, or elsewhere, when a list of candidates was
   made. Slabs get that of the whole scene, because a body may touch one that is in another slab.
   This part owns w->flush.
   --------------------------------------------------------------------------------------------- */

/* A piece of a fixed body; part.shape is not valid, shape is its index. */
typedef struct demi_flush_piece { demi_part part; int32_t shape; } demi_flush_piece;
/* True if body i is fixed and consists of polyhedra. */
static int demi_flush_is(const dem_world *w, int i) {
    const demi_shape *shape = demi_shape_of(w, i);
    return w->bodies.inv_mass[i] <= 0 && shape && shape->kind == DEMI_POLYHEDRON;
}
/* Sets the box of body i: middle and half widths, m, a little wider than the body. */
static void demi_flush_box(const dem_world *w, int i, double *middle, double *half) {
    const double hair = 1e-3*(double)demi_radius(w, i);
    int k;
    for (k = 0; k < 3; k++) {
        const dem_vec3 n = demi_v(k == 0, k == 1, k == 2);
        const double hi = (double)demi_support(w, i, n);
        const double lo = -(double)demi_support(w, i, demi_scale(n, -1));
        middle[k] = (double)w->bodies.pos[4*i + k] + (lo + hi)/2;
        half[k] = (hi - lo)/2 + hair;
    }
}
/* The row of a fixed body; null: it touches no other one. */
static const demi_flush_row *demi_flush_of(const dem_world *w, int b) {
    const uint32_t slot = w->bodies.slot[b];
    const int n = (int)slot < w->flush.slots && demi_flush_is(w, b) ? w->flush.of[slot] : -1;
    return n < 0 || w->flush.rows[n].from == w->flush.rows[n].to ? 0 : &w->flush.rows[n];
}
/* True if a body has a face in common with another one. */
static int demi_flush_faced(const dem_world *w, const demi_flush_row *b) {
    int k;
    for (k = b->from; k < b->to; k++) if (w->flush.links[k].faced) return 1;
    return 0;
}
/* The distance, m, below which two bodies count as touching. */
static double demi_flush_tiny(const demi_flush_row *b, const demi_flush_row *o) {
    return 1e-6*(double)(b->radius + o->radius) +
        (DEMI_SINGLE ? 5e-7 : 1e-15)*(double)demi_length(b->at);
}
/* Sets q to piece j of a body whose centre is at `at`. Returns 0 if it is no polyhedron. */
static int demi_flush_piece_of(const dem_world *w, const demi_flush_row *b, int j, dem_vec3 at,
                               demi_part *q) {
    *q = w->flush.pieces[b->first + j].part;
    q->centre = demi_add(q->centre, at);
    q->shape = &w->shapes[w->flush.pieces[b->first + j].shape];
    return q->kind == DEMI_POLYHEDRON;
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
/* Returns how two bodies touch: 1 in a part of a face, 0 in edges or corners or by an overlap, -1
   not at all. way: m, from b to o. */
static int demi_flush_how(const dem_world *w, const demi_flush_row *b, const demi_flush_row *o,
                          dem_vec3 way) {
    const double tiny = demi_flush_tiny(b, o);
    int k, j, how = -1;
    for (k = 0; k < b->count; k++)
        for (j = 0; j < o->count && how < 1; j++) {
            demi_d3 n = demi_d(0, 0, 0);
            demi_simplex simplex;
            demi_solid s, t;
            demi_part p, q;
            if (!demi_flush_piece_of(w, b, k, demi_v(0, 0, 0), &p) ||
                !demi_flush_piece_of(w, o, j, way, &q)) continue;
            demi_solid_of(&p, p.centre, &s);
            demi_solid_of(&q, q.centre, &t);
            if (demi_solids_apart(&s, &t, tiny, 1e300, &n, &simplex) &&
                demi_solids_slab(&s, &t, n) > tiny) continue;
            how = demi_solids_faced(&s, &t, tiny);
        }
    return how;
}
/* Adds to row n its links to those whose boxes it touches. Returns 0 if memory ran out. */
static int demi_flush_link_up(dem_world *w, const demi_tree *tree, int n) {
    const demi_periods p = demi_periods_of(w);
    const double *half = tree->half + 3*n, most = DEMI_MAX(half[0], DEMI_MAX(half[1], half[2]));
    demi_flush *f = &w->flush;
    demi_flush_row *b = &f->rows[n];
    int code, k;
    b->from = f->link_count;
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
            demi_flush_link link;
            for (k = 0; k < 3; k++)
                if (fabs(tree->x[3*other + k] - x[k]) > tree->half[3*other + k] + half[k]) break;
            if (k < 3 || other == n) continue;
            link.to = other;
            link.way = demi_nearest(&p, demi_sub(f->rows[other].at, b->at));
            link.faced = demi_flush_how(w, b, &f->rows[other], link.way);
            if (link.faced < 0) continue;
            if (!DEMI_GROW(w, f->links, (size_t)f->link_count + 1)) return 0;
            f->links[f->link_count++] = link;
        }
    }
    b->to = f->link_count;
    return 1;
}
/* Adds a row for fixed body i, without links. Returns 0 if memory ran out. */
static int demi_flush_add(dem_world *w, int i) {
    demi_flush *f = &w->flush;
    demi_flush_row *b = &f->rows[f->count];
    int k;
    b->slot = (int32_t)w->bodies.slot[i];
    b->material = w->bodies.material[i];
    b->first = f->piece_count;
    b->count = demi_parts_count(w, i);
    b->at = demi_at(w->bodies.pos + 4*i);
    b->radius = demi_radius(w, i);
    if (!DEMI_GROW(w, f->pieces, (size_t)(f->piece_count + b->count))) return 0;
    for (k = 0; k < b->count; k++) {
        demi_flush_piece *piece = &f->pieces[f->piece_count++];
        piece->part = demi_part_of(w, i, k);
        piece->shape = (int32_t)(piece->part.shape - w->shapes);
    }
    f->of[b->slot] = f->count++;
    return 1;
}
/* A digest of all bodies that the table is about; *count receives their number. */
static uint64_t demi_flush_digest(const dem_world *w, int *count) {
    uint64_t digest = UINT64_C(14695981039346656037);
    int slot, k;
    for (slot = *count = 0; slot < w->bodies.slot_count && w->bodies.shaped; slot++) {
        const int i = w->bodies.slot_index[slot];
        double x[11];
        if (i < 0 || !demi_flush_is(w, i)) continue;
        for (k = 0; k < 4; k++) x[k] = (double)w->bodies.pos[4*i + k];
        for (k = 0; k < 4; k++) x[4 + k] = (double)w->bodies.orient[4*i + k];
        x[8] = slot;
        x[9] = w->bodies.shape[i];
        x[10] = w->bodies.material[i];
        digest = demi_hash(digest, x, sizeof x);
        ++*count;
    }
    return digest;
}
/* Makes the table, unless it fits. Returns 0 if memory ran out. */
static int demi_flush_make(dem_world *w) {
    demi_flush *f = &w->flush;
    double *box = 0;
    demi_tree tree;
    int slot, k, n = 0, ok;
    const uint64_t digest = w->bodies.ghost ? f->digest : demi_flush_digest(w, &n);
    f->valid = 1;
    if (digest == f->digest) return 1;
    memset(&tree, 0, sizeof tree);
    f->count = f->piece_count = f->link_count = f->slots = 0;
    f->digest = digest;
    if (n < 2) return 1;
    ok = demi_grow(w, DEMI_LOOSE, &box, sizeof *box, 6*(size_t)n) &&
        DEMI_GROW(w, f->rows, (size_t)n) && DEMI_GROW(w, f->of, (size_t)w->bodies.slot_count);
    for (slot = 0; slot < w->bodies.slot_count && ok; slot++) {
        const int i = w->bodies.slot_index[slot];
        f->of[slot] = -1;
        if (i < 0 || !demi_flush_is(w, i)) continue;
        demi_flush_box(w, i, box + 3*f->count, box + 3*(n + f->count));
        ok = demi_flush_add(w, i);
    }
    tree.half = box + 3*n;
    ok = ok && demi_tree_make(w, &tree, box, n);
    for (k = 0; k < n && ok; k++) ok = demi_flush_link_up(w, &tree, k);
    if (ok) f->slots = w->bodies.slot_count;
    else f->digest = 0;
    if (!ok || !f->link_count) f->count = 0;
    demi_free(w, box);
    demi_tree_free(w, &tree);
    return f->valid = ok;
}
/* Gives a slab the table of the whole scene. Returns 0 if memory ran out. */
static int demi_flush_share(dem_world *to, const dem_world *from) {
    demi_flush *f = &to->flush;
    const demi_flush *own = &from->flush;
    if (!DEMI_COPY(to, f->rows, own->rows, own->count) ||
        !DEMI_COPY(to, f->pieces, own->pieces, own->piece_count) ||
        !DEMI_COPY(to, f->links, own->links, own->link_count) ||
        !DEMI_COPY(to, f->of, own->of, own->slots)) return 0;
    f->count = own->count;
    f->piece_count = own->piece_count;
    f->link_count = own->link_count;
    f->slots = own->slots;
    return 1;
}

/* --- what another body covers. a, p: a body and its part, about whose centre positions are; b, j:
   the row of a fixed body and its piece; way: m, to its centre --- */

/* From the centre of p to that of a fixed body, m. */
static dem_vec3 demi_flush_way(const dem_world *w, int a, const demi_part *p, int b) {
    const demi_periods periods = demi_periods_of(w);
    return demi_sub(demi_nearest(&periods, demi_sub(demi_at(w->bodies.pos + 4*b),
                                                    demi_at(w->bodies.pos + 4*a))), p->centre);
}
/* Sets s to a piece of a fixed body as p sees it: scaled, if p is an ellipsoid, so that this is the
   unit sphere. Returns 0 if it is no polyhedron or farther from p than `reach`, m. */
static int demi_flush_solid(const dem_world *w, const demi_part *p, const demi_flush_row *b, int j,
                            dem_vec3 way, dem_real reach, demi_solid *s) {
    demi_part q;
    if (!demi_flush_piece_of(w, b, j, way, &q) ||
        !(demi_length(q.centre) < reach + q.radius)) return 0;
    if (p->kind == DEMI_ELLIPSOID) demi_solid_measure(&q, p, q.centre, s);
    else demi_solid_of(&q, q.centre, s);
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
/* True if the body at the end of a link comes before that at its begin. */
static int demi_flush_before(const demi_flush_link *l) {
    if (l->way.x > 0 || l->way.x < 0) return l->way.x < 0;
    if (l->way.y > 0 || l->way.y < 0) return l->way.y < 0;
    return l->way.z < 0;
}
static int demi_flush_ignores(const dem_world *w, int a, const demi_flush_row *o) {
    return w->effects.ignoring && demi_ignores(w, w->bodies.material[a] - 1, o->material - 1);
}
/* How far from p pieces may matter, m. */
static dem_real demi_flush_reach(const dem_world *w, const demi_part *p, const demi_flush_row *b) {
    return 2*p->radius + 2*demi_range(w, p->radius + b->radius);
}
/* True if x may be in o, which link l of b leads to. way: to the centre of b, m. */
static int demi_flush_around(const demi_flush_row *b, const demi_flush_row *o,
                             const demi_flush_link *l, dem_vec3 way, demi_d3 x) {
    const demi_d3 to = demi_d3_sub(x, demi_d3_of(demi_add(way, l->way)));
    return demi_d3_length(to) < (double)o->radius*1.001 + demi_flush_tiny(b, o);
}
/* True if another fixed body covers the point of b nearest to p, a sphere or an ellipsoid. */
static int demi_flush_covers(const dem_world *w, int a, const demi_part *p,
                             const demi_flush_row *b, int j, dem_vec3 way) {
    const dem_real reach = demi_flush_reach(w, p, b);
    demi_solid s, t;
    demi_d3 x, y;
    double off, even;
    int k, i;
    if (!demi_flush_solid(w, p, b, j, way, reach, &s)) return 0;
    off = demi_solid_near(&s, demi_d(0, 0, 0), &x);
    even = (DEMI_SINGLE ? 1e-6 : 1e-13)*(fabs(off) + demi_d3_length(s.centre));
    for (k = b->from; k < b->to; k++) {
        const demi_flush_link *l = &w->flush.links[k];
        const demi_flush_row *o = &w->flush.rows[l->to];
        for (i = 0; i < o->count && !demi_flush_ignores(w, a, o); i++) {
            double its;
            if (!(p->kind == DEMI_ELLIPSOID || demi_flush_around(b, o, l, way, x)) ||
                !demi_flush_solid(w, p, o, i, demi_add(way, l->way), reach, &t) ||
                !demi_solid_about(&t, x, demi_flush_tiny(b, o))) continue;
            its = demi_solid_near(&t, demi_d(0, 0, 0), &y);
            if (its < off - even || (its <= off + even && demi_flush_before(l))) return 1;
        }
    }
    return 0;
}
/* True if another fixed body continues where polyhedron p touches b at x, with the normal n from p
   to b (unit). */
static int demi_flush_continues(const dem_world *w, int a, const demi_part *p,
                                const demi_flush_row *b, int j, dem_vec3 way, demi_d3 x,
                                demi_d3 n) {
    const dem_real reach = demi_flush_reach(w, p, b);
    const demi_d3 out = demi_d3_scale(n, -1);
    demi_solid s, t;
    double along;
    int k, i, c, f;
    if (!demi_flush_solid(w, p, b, j, way, reach, &s)) return 0;
    f = demi_solid_facing(&s, out, &along);
    if (along >= DEMI_FLUSH) {                  /* a little into the face */
        const double part = 1.0/(s.rim[f + 1] - s.rim[f]);
        demi_d3 middle = demi_d(0, 0, 0);
        for (i = s.rim[f]; i < s.rim[f + 1]; i++)
            middle = demi_d3_plus(middle, part, demi_solid_corner(&s, f, i));
        x = demi_d3_between(x, middle, 1e-3);
    }
    for (k = b->from; k < b->to; k++) {
        const demi_flush_link *l = &w->flush.links[k];
        const demi_flush_row *o = &w->flush.rows[l->to];
        if (!demi_flush_around(b, o, l, way, x)) continue;
        for (i = 0; i < o->count && !demi_flush_ignores(w, a, o); i++) {
            if (!demi_flush_solid(w, p, o, i, demi_add(way, l->way), reach, &t) ||
                !demi_solid_about(&t, x, demi_flush_tiny(b, o))) continue;
            if (along >= DEMI_FLUSH) return 1;
            for (c = 0; c < t.corners; c++) {
                const demi_d3 to = demi_d3_sub(t.corner[c], x);
                if (demi_d3_dot(to, out) > 1e-4*demi_d3_length(to)) return 1;
            }
        }
    }
    return 0;
}
/* The bodies of a contact, one of which is fixed: that one's row, null if it touches no other one;
   the free one, its part, and the way to the fixed one's centre. */
typedef struct demi_flush_pair {
    const demi_flush_row *row;
    const demi_part *part;
    dem_vec3 way;
    int first, a, of, piece;       /* first: the fixed one is a of the contact; a, of: the free one
                                      and its part's number */
} demi_flush_pair;
static demi_flush_pair demi_flush_pair_of(const dem_world *w, const demi_persistent *c,
                                          const demi_part *p, const demi_part *q) {
    demi_flush_pair o;
    int b;
    memset(&o, 0, sizeof o);
    o.first = w->bodies.inv_mass[c->a] <= 0;
    b = o.first ? c->a : c->b;
    if ((o.first ? p : q)->kind == DEMI_POLYHEDRON) o.row = demi_flush_of(w, b);
    if (!o.row) return o;
    o.a = o.first ? c->b : c->a;
    o.of = o.first ? c->part_b : c->part_a;
    o.piece = o.first ? c->part_a : c->part_b;
    o.part = o.first ? q : p;
    o.way = demi_flush_way(w, o.a, o.part, b);
    return o;
}
/* Removes points of a contact of polyhedra where the fixed body has an inner face. gap: m, from the
   centre of the first one to that of the other. Returns the number of the others. */
static int demi_flush_spots(const dem_world *w, const demi_flush_pair *o, dem_vec3 gap,
                            demi_spots *spots) {
    const demi_d3 off = o->first ? demi_d3_of(gap) : demi_d(0, 0, 0);
    const demi_d3 n = demi_d3_scale(spots->normal, o->first ? -1 : 1);
    int k, left = 0;
    for (k = 0; k < spots->count; k++) {
        const demi_d3 x = demi_d3_plus(demi_d3_sub(spots->x[k], off), spots->gap[k]/2, n);
        if (demi_flush_continues(w, o->a, o->part, o->row, o->piece, o->way, x, n)) continue;
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
/* Sets *out to the pressure of p (s: about its centre) on piece i of fixed body o: on its faces
   without what others cover. */
static void demi_flush_part(const dem_world *w, int a, const demi_part *p, const demi_solid *s,
                            const demi_flush_row *o, int i, dem_vec3 way, demi_pressure *out) {
    unsigned char pressed[DEM_POLYHEDRON_FACES];
    demi_solid t, other;
    demi_part own;
    int f, g, k, j;
    memset(out, 0, sizeof *out);
    if (!demi_flush_piece_of(w, o, i, way, &own) ||
        demi_face_keeps(&own, p, demi_scale(own.centre, -1)) ||
        !demi_flush_solid(w, p, o, i, way, p->radius, &t)) return;
    for (f = 0; f < t.faces; f++) {
        const double had = out->sum;
        demi_flush_face(s, &t, f, 0, 0, out);
        pressed[f] = out->sum > had;
    }
    if (demi_solid_holds(&t, s->centre))
        demi_pressure_beyond(s, demi_d3_unit(t.centre), out);
    for (k = o->from; k < o->to && out->sum > 0; k++) {
        const demi_flush_link *l = &w->flush.links[k];
        const demi_flush_row *b = &w->flush.rows[l->to];
        if (!l->faced || demi_flush_ignores(w, a, b)) continue;
        for (j = 0; j < b->count; j++) {
            const demi_part *q = &w->flush.pieces[b->first + j].part;
            const demi_d3 x = demi_d3_of(demi_add(demi_add(way, l->way), q->centre));
            for (f = 0; f < t.faces && !(pressed[f] && demi_solid_in(&t, f, x) < 1e-6); f++);
            if (f == t.faces ||         /* it is beyond no face with pressure */
                !demi_flush_solid(w, p, b, j, demi_add(way, l->way), p->radius, &other)) continue;
            for (; f < t.faces; f++)
                for (g = 0; g < other.faces && pressed[f]; g++)
                    if (demi_faces_opposite(&t, f, &other, g, demi_flush_tiny(o, b)))
                        demi_flush_face(s, &t, f, &other, g, out);
        }
    }
}
/* Sets *out to the pressure of polyhedron p on piece j of fixed body b, and on all that belong to
   the same surface near p. Returns 0 if there is none on b. */
static int demi_flush_pressed(const dem_world *w, const demi_flush_pair *c, demi_flush_press *out) {
    const demi_part *p = c->part;
    int32_t found[DEMI_FLUSH_NEAR];
    dem_vec3 way[DEMI_FLUSH_NEAR];
    demi_pressure press;
    demi_solid s;
    int n, i, k, m, count = 1;
    demi_solid_of(p, demi_v(0, 0, 0), &s);
    demi_flush_part(w, c->a, p, &s, c->row, c->piece, c->way, &out->own);
    out->shared = out->force = 0;
    if (!(out->own.sum > 0)) return 0;
    found[0] = (int32_t)(c->row - w->flush.rows);
    way[0] = c->way;
    for (n = 0; n < count; n++) {
        const demi_flush_row *o = &w->flush.rows[found[n]];
        for (i = 0; i < o->count; i++) {
            if (!n && i == c->piece) press = out->own;
            else demi_flush_part(w, c->a, p, &s, o, i, way[n], &press);
            out->shared += press.shared;
            out->force += demi_d3_length(press.force);
        }
        for (k = o->from; k < o->to; k++) {
            const demi_flush_link *l = &w->flush.links[k];
            const demi_flush_row *next = &w->flush.rows[l->to];
            const dem_vec3 to = demi_add(way[n], l->way);
            for (m = 0; m < count && found[m] != l->to; m++) continue;
            if (m < count || m == DEMI_FLUSH_NEAR || !l->faced ||
                demi_flush_ignores(w, c->a, next) ||
                !(demi_length(to) < p->radius + next->radius)) continue;
            found[count] = l->to;
            way[count++] = to;
        }
    }
    return out->shared > 0 && demi_d3_length(out->own.force) > 1e-9*out->force;
}

/* --- the history of a contact that takes over from another one --- */

/* Returns the first old contact of body a with a body, of its work group; null if it has none. */
static const demi_persistent *demi_flush_old(const dem_world *w, int a,
                                             const demi_persistent **end) {
    const int d = demi_domain_of(w, a);
    const demi_persistent *old = demi_persistent_of(w, d);
    int lo = 0, hi = w->domains[d].persistent;
    *end = old + hi;
    while (lo < hi) {
        const int mid = lo + (hi - lo)/2;
        if (old[mid].a < a) lo = mid + 1;
        else hi = mid;
    }
    return old + lo;
}
/* Lets a new contact c of two bodies (o) continue an old one of the free body with another fixed
   body, at nearly the same normal: of spheres and ellipsoids one that is covered now. */
static void demi_flush_take_over(const dem_world *w, const demi_flush_pair *o, demi_persistent *c) {
    const demi_persistent *best = 0, *old, *end;
    dem_real most = DEM_R(0.95), turn = 1;
    int k, e;
    for (k = o->row->from; k < o->row->to; k++) {
        const demi_flush_link *l = &w->flush.links[k];
        const demi_flush_row *row = &w->flush.rows[l->to];
        const int other = w->bodies.slot_index[row->slot];
        if (other < 0) continue;                /* in another slab */
        old = demi_flush_old(w, DEMI_MIN(o->a, other), &end);
        for (; old < end && old->a == DEMI_MIN(o->a, other); old++) {
            const int swapped = (old->a == o->a) == o->first;
            const dem_real side = swapped ? DEM_R(-1) : DEM_R(1);
            const dem_real along = side*demi_dot(old->normal, c->normal);
            if (old->b != DEMI_MAX(o->a, other) || !(along > most) ||
                (old->a == o->a ? old->part_a : old->part_b) != o->of ||
                (c->corners ? old->corner != (swapped ? c->corner ^ 1 : c->corner)
                 : !demi_flush_covers(w, o->a, o->part, row,
                                      old->a == o->a ? old->part_b : old->part_a,
                                      demi_add(o->way, l->way)))) continue;
            most = along;
            best = old;
            turn = side;
        }
    }
    if (!best) return;
    for (e = 0; e < w->memory_stride; e++)
        c->memory[e] = w->vector_mask >> e & 1 ? turn*best->memory[e] : best->memory[e];
    c->from = DEMI_TAKEN_OVER;
}
/* The same for all points of a contact c of parts p and q. */
static void demi_flush_follow(const dem_world *w, demi_persistent *c, const demi_part *p,
                              const demi_part *q) {
    const int points = DEMI_MAX(c->corners, 1);
    demi_flush_pair o;
    int i;
    if (c->from >= 0) return;
    o = demi_flush_pair_of(w, c, p, q);
    for (i = 0; i < points && o.row; i++)
        if (c[i].from < 0) demi_flush_take_over(w, &o, &c[i]);
}
/* True if contact c of parts p and q, which have just been found to touch, is none of the common
   surface of fixed bodies. gap: from p's centre to q's, m; spots: its points, if it has several. */
static int demi_flush_within(const dem_world *w, const demi_persistent *c, const demi_part *p,
                             const demi_part *q, dem_vec3 gap, demi_spots *spots) {
    const demi_flush_pair o = demi_flush_pair_of(w, c, p, q);
    if (!o.row) return 0;
    if (spots->count) return !demi_flush_spots(w, &o, gap, spots);
    return o.part->kind != DEMI_POLYHEDRON &&
        demi_flush_covers(w, o.a, o.part, o.row, o.piece, o.way);
}
