/* ---------------------------------------------------------------------------------------------
   >>continued
   Which persistent contact of the step before a new one of >>persistent continues. The functions
   return its index within its work group, or -1. `old` and `olds` are the contacts that body a had
   in the step before, and their number. Writes the field `from` of new contacts only.
   --------------------------------------------------------------------------------------------- */

/* Returns the old contact with the same partner and parts or, at a wall, with the same wall, part,
   element and corner; -1 if there is none. */
DEM_INLINE int demi_persistent_same(const dem_world *w, int d, const demi_persistent *old, int olds,
                                    const demi_persistent *c) {
    const int first = (int)(old - demi_persistent_of(w, d));
    int *next = &w->domains[d].persistent_same, n, i = *next - first;
    if (i < 0 || i >= olds) i = 0;              /* usually the one after the last match */
    for (n = 0; n < olds; n++) {
        if (old[i].element == c->element && old[i].wall == c->wall &&
            old[i].part_a == c->part_a && old[i].b == c->b && old[i].part_b == c->part_b &&
            old[i].corner == c->corner) {
            *next = first + i + 1;
            return first + i;
        }
        if (++i == olds) i = 0;
    }
    return -1;
}
/* Which old contact fits best, if no such key identifies it:
       TURNED   polyhedron on a wall, soft contacts: the nearest normal within 45 degrees, of the
                same element and corner (round walls, wires and holes are one element all around)
       NEAREST  polyhedra, rigid contacts: the nearest point of the same pair or wall, with a
                normal within about 18 degrees, that no new contact nearer to it continues
       SLID     any wall, if nothing else fits: the body slid onto a neighbouring element */
enum demi_fit { DEMI_FIT_TURNED, DEMI_FIT_NEAREST, DEMI_FIT_SLID };
/* The number of the surface that contact c is with. */
static int demi_persistent_surface(const dem_world *w, const demi_persistent *c) {
    return demi_surface_for(w, c->wall, c->a);
}
/* Returns how well old contact o (index `from`) fits contact c, which slid onto this element, or
   DEMI_FAR_OFF if it may not be continued. The criterion is the cosine between the normals. If
   several are nearly equal (within some 3 degrees), contacts that nothing continues yet come first,
   then those with the same sign of the weight, then those of the same wall. Walls at rest relative
   to each other count as one wall. On facets a contact point that begins at depth has split off an
   older one and copies its history. Copies do not add friction: each split also creates a contact
   of negative weight (>>facets). On other walls only one new contact may continue o. */
static dem_real demi_persistent_slid(const dem_world *w, const demi_persistent *o, int from,
                                     const demi_persistent *fresh, int freshs,
                                     const demi_persistent *c) {
    const dem_real hair = DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10);
    const demi_wall *wall = &w->walls[c->wall],
        *s = demi_surface_of(w, demi_persistent_surface(w, c));
    const int crossed = demi_wall_is(s, DEMI_CROSSED), faceted = demi_faceted(s);
    const int alike = (o->weight < 0) == (c->share < 0);
    int j, taken = 0;
    if (w->walls[o->wall].group != wall->group || ((crossed || !(c->share < 0)) && !alike))
        return DEMI_FAR_OFF;
    for (j = 0; j < freshs && !taken; j++)
        taken = fresh[j].wall == o->wall && fresh[j].element == o->element;
    for (j = 0; j < freshs && !taken && !faceted; j++) {        /* only the nearest one */
        const dem_real nearer = demi_dot(o->normal, demi_sub(fresh[j].normal, c->normal));
        taken = fresh + j != c && (!crossed || (fresh[j].share < 0) == (c->share < 0)) &&
            (fresh[j].from == from || (fresh[j].from < 0 &&
             (nearer > 0 || (!(nearer < 0) && fresh + j < c))));
    }
    if (taken && (!faceted || !(2*c->overlap > o->overlap))) return DEMI_FAR_OFF;
    return demi_dot(o->normal, c->normal) + (taken ? 0 : DEM_R(1e-3)) +
        (o->wall == c->wall ? hair : 0) + (alike ? 2*hair : 0);
}
/* True if two contacts, of body and wall or of two bodies, have the same partner, where walls that
   are joined to one surface are the same. */
DEM_INLINE int demi_persistent_one(const dem_world *w, const demi_persistent *a,
                                   const demi_persistent *b) {
    return a->wall == b->wall || (a->wall >= 0 && b->wall >= 0 &&
        demi_surface_number(w, a->wall) == demi_surface_number(w, b->wall));
}
/* Squared distance of the points of two contacts of one body, m2, as seen from its centre. */
DEM_INLINE dem_real demi_persistent_off2(const demi_persistent *a, const demi_persistent *b) {
    const dem_vec3 way = demi_sub(a->arm_a, b->arm_a);
    return demi_dot(way, way);
}
/* Returns the best old contact for c, or -1. `fresh` and `freshs`: all new contacts of this pair or
   with this wall. */
static int demi_persistent_best(const dem_world *w, int d, const demi_persistent *old, int olds,
                                const demi_persistent *fresh, int freshs, const demi_persistent *c,
                                enum demi_fit how) {
    const int first = (int)(old - demi_persistent_of(w, d));
    dem_real most = DEMI_FAR_OFF;
    int i, k, best = -1;
    for (i = 0; i < olds; i++) {
        const demi_persistent *o = &old[i];
        dem_real fit = demi_dot(o->normal, c->normal);
        if (!(fit > (how == DEMI_FIT_TURNED ? DEM_R(0.7) : DEM_R(0.95))) || o->b != c->b ||
            o->part_a != c->part_a || o->part_b != c->part_b ||
            (how != DEMI_FIT_SLID && !demi_persistent_one(w, o, c)) ||
            (o->corner != c->corner && how != DEMI_FIT_NEAREST) ||
            (o->element != c->element && how == DEMI_FIT_TURNED) ||
            demi_persistent_later(o)) continue;
        if (how == DEMI_FIT_SLID) fit = demi_persistent_slid(w, o, first + i, fresh, freshs, c);
        if (how == DEMI_FIT_NEAREST) fit = -demi_persistent_off2(o, c);
        if (!(fit > most)) continue;
        for (k = 0; how == DEMI_FIT_NEAREST && k < freshs; k++)
            if (fresh[k].from == first + i && !(demi_persistent_off2(o, &fresh[k]) > -fit)) break;
        if (how == DEMI_FIT_NEAREST && k < freshs) continue;
        most = fit;
        best = first + i;
    }
    return best;
}
/* Finds which old contacts `count` new ones of one pair or wall continue, by DEMI_FIT_NEAREST. A
   new contact takes an old one from another that is farther from it; that one looks again. So the
   order of contacts changes nothing. */
static void demi_persistent_nearest(const dem_world *w, int d, const demi_persistent *old, int olds,
                                    demi_persistent *fresh, int count) {
    int i, k, next;
    for (i = 0; i < count; i++) fresh[i].from = -1;
    for (i = 0; i < count; i++)
        for (k = i; k < count; k = next) {
            const int from = demi_persistent_best(w, d, old, olds, fresh, count, &fresh[k],
                                                  DEMI_FIT_NEAREST);
            for (next = 0; next < count && (from < 0 || fresh[next].from != from); next++);
            if (next < count) fresh[next].from = -1;
            fresh[k].from = from;
        }
}
