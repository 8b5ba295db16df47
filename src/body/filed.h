/* ---------------------------------------------------------------------------------------------
   >>filed
   Contact histories of spheres between two neighbour lists. While a list is valid they are columns
   of the pruned list; demi_list_drop files them by slot and member sphere, so that the next list
   can restore them although indices have changed. Owns w->filed.
   --------------------------------------------------------------------------------------------- */
/* Allocates the file of contact histories (demi_filed): number of rows (slots), of entries, and of
   reals per entry. Returns 0 if memory ran out. */
static int demi_carry_reserve(dem_world *w, int rows, int count, int stride) {
    const size_t reals = (size_t)count*(size_t)stride;
    const int ok = DEMI_GROW(w, w->filed.start, (size_t)rows + 2) &&
                   DEMI_GROW(w, w->filed.partner, (size_t)count) &&
                   DEMI_GROW(w, w->filed.part, (size_t)count) &&
                   DEMI_GROW(w, w->filed.memory, reals);
    return ok;
}

/* True if entry p of domain d's pruned neighbour list has a contact history. */
static int demi_near_remembers(const dem_world *w, int d, int p) {
    const dem_real *m = w->near.memory + (size_t)d*(size_t)w->memory_stride*(size_t)w->near.stride;
    int e;
    for (e = 0; e < w->memory_stride; e++) {
        const dem_real value = m[(size_t)e*(size_t)w->near.stride + (size_t)p];
        if (value < 0 || value > 0) return 1;
    }
    return 0;
}
/* Returns the pair after p in a domain's pruned neighbour list. Its pairs are
   p = 0 .. near_own - 1, then near_cross .. near_end - 1. */
DEM_INLINE int demi_near_next(const demi_domain *domain, int p) {
    return p + 1 == domain->near_own ? domain->near_cross : p + 1;
}
DEM_INLINE int demi_near_first(const demi_domain *domain) {
    return domain->near_own ? 0 : domain->near_cross;
}

/* Returns the key of an entry's two member spheres in the file of contact histories. */
static int32_t demi_near_part_key(const dem_world *w, size_t at) {
    const int a = w->near.a[at], b = w->near.b[at];
    const int32_t *start = w->bodies.centre_start;
    int32_t i, j;
    if (!w->effects.clustered) return 0;
    i = w->near.ball_a[at] - start[a];
    j = w->near.ball_b[at] - start[b];
    return w->bodies.slot[a] < w->bodies.slot[b] ? DEMI_BALLS_MOST*i + j : DEMI_BALLS_MOST*j + i;
}
/* Discards the filed contact histories: they are in a new list, or belong to other laws. */
static void demi_filed_forget(dem_world *w) { w->filed.count = 0; }
/* Files the contact history of all pairs of spheres by slot. The row is the lower slot. The
   partner is the higher slot, or its complement if that was body a of the pair. Returns 0 if memory
   ran out. */
static int demi_carry_collect(dem_world *w) {
    const int stride = w->memory_stride;
    int d, p, e, k, total = 0, pass;
    demi_filed_forget(w);
    if (!stride || !w->domain_count) return 1;
    if (!demi_carry_reserve(w, w->bodies.slot_count, 0, stride)) return 0;
    memset(w->filed.start, 0, ((size_t)w->bodies.slot_count + 2)*sizeof(int32_t));
    for (pass = 0; pass < 2; pass++) {          /* count by row, then fill */
        for (d = 0; d < w->domain_count; d++) {
            const demi_domain *domain = &w->domains[d];
            const dem_real *m = w->near.memory + (size_t)d*(size_t)stride*(size_t)w->near.stride;
            for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
                const int at = d*w->near.stride + p;
                int32_t a, b, row;
                dem_real *to;
                if (!demi_near_remembers(w, d, p)) continue;
                a = (int32_t)w->bodies.slot[w->near.a[at]];
                b = (int32_t)w->bodies.slot[w->near.b[at]];
                row = DEMI_MIN(a, b);
                if (pass == 0) { w->filed.start[row + 2]++; total++; continue; }
                w->filed.partner[w->filed.start[row + 1]] = a < b ? b : ~a;
                w->filed.part[w->filed.start[row + 1]] = demi_near_part_key(w, (size_t)at);
                to = w->filed.memory + (size_t)w->filed.start[row + 1]++*(size_t)stride;
                for (e = 0; e < stride; e++)
                    to[e] = m[(size_t)e*(size_t)w->near.stride + (size_t)p];
            }
        }
        if (pass == 0) {
            if (!demi_carry_reserve(w, w->bodies.slot_count, total, stride)) return 0;
            for (k = 2; k < w->bodies.slot_count +
                 2; k++) w->filed.start[k] += w->filed.start[k - 1];
        }
    }
    w->filed.count = total;
    w->filed.rows = w->bodies.slot_count;
    w->filed.stride = stride;
    return 1;
}

/* Returns the persistent contacts of domain d. */
DEM_INLINE demi_persistent *demi_persistent_of(const dem_world *w, int d) {
    return w->persistent_now + w->persistent_first[d];
}
/* True if a contact is a later part of one with several walls: it continues what the first does. */
DEM_INLINE int demi_persistent_later(const demi_persistent *c) {
    return c->odd && c->more.rank > 0;
}
/* Returns the index of the old contact that a later part c continues: of the parts of the one that
   its first part continues, that with the same wall, else the first. end: of the body's old
   contacts. */
static int demi_persistent_part(const dem_world *w, int d, const demi_persistent *end,
                                const demi_persistent *c) {
    const int from = c[-c->more.rank*c->corners].from;
    const demi_persistent *now = demi_persistent_of(w, d), *o = from < 0 ? end : now + from;
    do o += c->corners;
    while (o < end && demi_persistent_later(o) && o->wall != c->wall);
    return o < end && demi_persistent_later(o) ? (int)(o - now) : from;
}
/* Lets each of the four points c[0] .. c[3] of a pressure continue the old point that lies where it
   does. This has another number if the direction in which the pressure is spread most has reversed
   in this step, or has turned by a right angle (demi_patch_along). Springs that pass to the
   opposite point would reverse the moment of friction about the normal. */
static void demi_persistent_turn(const dem_world *w, int d, demi_persistent *c) {
    static const unsigned char turned[4][4] = {{0, 1, 2, 3}, {2, 0, 3, 1}, {3, 2, 1, 0},
                                               {1, 3, 0, 2}};
    const demi_persistent *now = demi_persistent_of(w, d);
    dem_vec3 is[4] = DEM_ZERO, was[4] = DEM_ZERO;
    dem_real same, right;
    int from[4], k, turns;
    if (!demi_response_is(w, DEMI_PRESSING) || demi_persistent_later(c)) return;
    for (k = 0; k < 4; k++) {
        if (c[k].from < 0 || now[c[k].from].corners != 4) return;
        from[c[k].corner] = c[k].from;
        is[c[k].corner] = c[k].more.spread;
        was[c[k].corner] = now[c[k].from].more.spread;
    }
    same = demi_dot(is[0], was[0]) + demi_dot(is[1], was[1]);
    right = demi_dot(is[1], was[0]) - demi_dot(is[0], was[1]);
    turns = DEMI_ABS(right) > DEMI_ABS(same) ? (right > 0 ? 1 : 3) : same < 0 ? 2 : 0;
    for (k = 0; k < 4 && turns; k++) c[k].from = from[turned[turns][c[k].corner]];
}
/* The weight of friction of all parts of a contact. */
DEM_INLINE dem_real demi_persistent_whole(const demi_persistent *c) {
    return c->odd && c->more.part > 0 ? c->grip/c->more.part : c->grip;
}
/* Marks in met[] which materials have touched. Persistent contacts are marked when they begin.
   Pairs of spheres are examined only before a list is dropped: contacts shorter than the life of a
   list may be missed, lasting ones are always found. */
static void demi_met_look(const dem_world *w, uint64_t *met) {
    int d, p;
    for (d = 0; d < w->domain_count && w->material_count > 1; d++) {
        const demi_domain *domain = &w->domains[d];
        for (p = 0; p < w->material_count; p++) met[p] |= domain->met[p];
        for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
            const int at = d*w->near.stride + p, a = w->near.a[at], b = w->near.b[at];
            const int i = w->bodies.material[a] - 1, j = w->bodies.material[b] - 1;
            const uint64_t bit = UINT64_C(1) << DEMI_MAX(i, j);
            const dem_real radii = demi_near_radius(w, (size_t)at, 0) +
                demi_near_radius(w, (size_t)at, 1);
            const dem_vec3 way = demi_near_way(w, (size_t)at);
            if (demi_dot(way, way) < radii*radii) met[DEMI_MIN(i, j)] |= bit;
        }
    }
}
/* Marks the neighbour list as invalid and files the contact history. Persistent contacts refer to
   slots instead of indices from here on. Returns 0 if memory ran out; nothing has changed then. */
static int demi_list_drop(dem_world *w) {
    int d, k;
    w->bodies.centres_valid = 0;
    if (!w->stage.list_valid) return 1;
    if (!demi_carry_collect(w)) return 0;
    demi_met_look(w, w->booked.met);
    for (d = 0; d < w->domain_count; d++) {
        memset(w->domains[d].met, 0, sizeof w->domains[d].met);
        for (k = 0; k < w->domains[d].persistent; k++) {
            demi_persistent *c = demi_persistent_of(w, d) + k;
            c->a = (int32_t)w->bodies.slot[c->a];
            if (c->b >= 0) c->b = (int32_t)w->bodies.slot[c->b];
        }
    }
    demi_list_outdated(w);
    return 1;
}
