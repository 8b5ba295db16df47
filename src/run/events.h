/* ---------------------------------------------------------------------------------------------
   >>events
   Contact events: every contact from its beginning to its end, with what it has lost. The loops
   over contacts note the contacts of a step (>>noted). This part adds them, in the order of work
   groups, to the open contact of the two bodies, or of the body and its wall. The notes of the
   step before tell which contact that is. Where they do not, a hash table does. A contact that was
   not noted in a step has ended: it is added to the statistics of its materials, and passed to the
   user's function when the step is complete. The sums of an open contact do not depend on its
   place in the list, so the bits are the same for any number of threads. Slabs note contacts in
   their own worlds, and their head does the rest. With impulses a contact loses its energy during
   the coming step; until then the losses are due (demi_due_book). Owns w->events. In all functions
   w is the head of a team or a single world.
   --------------------------------------------------------------------------------------------- */

/* --- the table of open contacts --- */
static uint32_t demi_event_hash(const dem_event *e) {
    uint32_t h = e->a.slot*UINT32_C(0x9e3779b1) + e->b.slot*UINT32_C(0x85ebca77) +
        (uint32_t)e->wall*UINT32_C(0xc2b2ae3d);
    h ^= h >> 15;
    h *= UINT32_C(0x2c1b3c6d);
    return h ^ h >> 13;
}
static int demi_event_same(const dem_event *x, const dem_event *y) {
    return x->a.slot == y->a.slot && x->b.slot == y->b.slot && x->wall == y->wall &&
        x->a.generation == y->a.generation && x->b.generation == y->b.generation;
}
/* Returns the place of an open contact in the table, or the free place where it belongs. */
static int32_t *demi_event_place(const demi_events *e, const dem_event *key) {
    const uint32_t mask = (uint32_t)e->table_size - 1;
    uint32_t at = demi_event_hash(key) & mask;
    while (e->table[at] && !demi_event_same(&e->open[e->table[at] - 1].event, key))
        at = (at + 1) & mask;
    return e->table + at;
}
/* Returns the index of the open contact with this key, -1 if there is none. Contacts are noted in
   nearly the same order in every step. Therefore four contacts of the last step are tried first,
   from number *next on, because some may have ended; the hash table finds the others. If one of the
   four fits, *next becomes the number after it. */
static int demi_event_find(demi_events *e, const dem_event *key, int *next) {
    int k;
    for (k = *next; k < *next + 4 && k < e->before_count; k++) {
        const int open = e->before[k].open;
        if (open >= e->n.open || !demi_event_same(&e->open[open].event, key)) continue;
        *next = k + 1;
        return open;
    }
    return e->table_size ? *demi_event_place(e, key) - 1 : -1;
}
/* The same for a note, by the indices of its bodies, which must be those of the turn before. Entry
   k tells the open contact only if note k was that contact's first one of the turn before and it
   has none in this turn yet, because demi_event_drop moves entries of `open`. Otherwise, or if none
   of the four fits, this function returns -1. member: index of the world that has noted it. */
DEM_INLINE int demi_event_again(const demi_events *e, const demi_noted *n, int member, int *next) {
    const uint32_t first = e->turn - 1 - (uint32_t)e->before_count;
    int k;
    for (k = *next; k < *next + 4 && k < e->before_count; k++) {
        const demi_matched *m = e->before + k;
        if (m->a != n->a || m->b != n->b || m->member != member) continue;
        if (m->open >= e->n.open || e->last[m->open] != first + (uint32_t)k) return -1;
        *next = k + 1;
        return m->open;
    }
    return -1;
}
/* Prefetches the sums of the open contact that is probably needed some notes after number
   `next` <= before_count. */
DEM_INLINE void demi_event_ahead(const demi_events *e, int next) {
    const int i = e->before[next + DEMI_EVENT_AHEAD - 1].open;
    DEMI_FETCH(e->last + i);
    DEMI_FETCH(e->sums + i);
}
/* Makes room for one more open contact; the table is at most half full. 0: memory ran out. */
static int demi_event_widen(dem_world *w) {
    demi_events *e = &w->events;
    const size_t n = (size_t)e->n.open + 1;
    int i, size = e->table_size ? e->table_size : 64;
    if (!DEMI_GROW(w, e->open, n) || !DEMI_GROW(w, e->sums, n) || !DEMI_GROW(w, e->last, n))
        return 0;
    while ((size_t)size < 2*n) size *= 2;
    if (size == e->table_size) return 1;
    if (!DEMI_GROW(w, e->table, (size_t)size)) return 0;
    e->table_size = size;
    memset(e->table, 0, (size_t)size*sizeof *e->table);
    for (i = 0; i < e->n.open; i++) *demi_event_place(e, &e->open[i].event) = i + 1;
    return 1;
}
/* Removes open contact i; the last one takes its place. Later entries of the table move to where a
   search for them would pass. */
static void demi_event_drop(demi_events *e, int i) {
    const uint32_t mask = (uint32_t)e->table_size - 1;
    uint32_t hole = (uint32_t)(demi_event_place(e, &e->open[i].event) - e->table), at = hole;
    const int last = e->n.open - 1;
    for (at = (at + 1) & mask; e->table[at]; at = (at + 1) & mask) {
        const uint32_t home = demi_event_hash(&e->open[e->table[at] - 1].event) & mask;
        if (((at - home) & mask) < ((at - hole) & mask)) continue;
        e->table[hole] = e->table[at];
        hole = at;
    }
    e->table[hole] = 0;
    if (i < last) {
        *demi_event_place(e, &e->open[last].event) = i + 1;
        e->open[i] = e->open[last];
        e->sums[i] = e->sums[last];
        e->last[i] = e->last[last];
    }
    e->n.open--;
}

/* --- wear --- */

/* Returns the element of a wall of facets that is nearest to x, in space. It looks at the cells
   around the point, farther away until no facet outside can be nearer. */
static int demi_worn_facet(const demi_wall *wall, dem_vec3 x) {
    dem_vec3 at = demi_unrotate(wall->pose.rotation, demi_sub(x, wall->pose.position));
    dem_real best = DEM_R(1e30), reach;
    int i, y, z, f[3], l[3], nearest = 0;
    if (demi_wall_is(wall, DEMI_DRAWN)) at.z = 0;
    for (i = 0; i < wall->element_count && !wall->cell_start; i++) {
        const dem_real far = demi_wall_distance(wall, i, at, best);
        if (far < best) { best = far; nearest = i; }
    }
    for (reach = wall->cell/4; wall->cell_start && reach < DEM_R(1e30); reach *= 2) {
        const dem_vec3 out = demi_v(reach, reach, reach);
        demi_wall_cells(wall, demi_sub(at, out), demi_add(at, out), f, l);
        for (z = f[2]; z <= l[2]; z++)
            for (y = f[1]; y <= l[1]; y++) {
                const int32_t *row = wall->cell_start + wall->cells[0]*(y + wall->cells[1]*z);
                for (i = row[f[0]]; f[0] <= l[0] && i < row[l[0] + 1]; i++) {
                    const int element = wall->cell_items[i];
                    const dem_real far = demi_wall_distance(wall, element, at, best);
                    if (!(far < best)) continue;
                    best = far;
                    nearest = element;
                }
            }
        if (best <= reach) break;
    }
    return nearest;
}
/* Makes room for the wear of all walls; that of a new wall is 0. Returns 0 if memory ran out. */
static int demi_events_room(dem_world *w) {
    demi_events *e = &w->events;
    int i;
    if (!DEMI_GROW(w, e->walls, (size_t)w->wall_count)) return 0;
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const int faceted = demi_wall_kinds[wall->kind].corners > 1;
        const int facets = faceted ? wall->element_count : 0;
        demi_worn *worn = &e->walls[i];
        if (i < e->n.walls && worn->id == wall->id) continue;
        if (!DEMI_GROW(w, e->facets, (size_t)e->n.facets + (size_t)facets)) return 0;
        memset(worn, 0, sizeof *worn);
        worn->id = wall->id;
        worn->first = e->n.facets;
        worn->count = facets;
        for (; e->n.facets < worn->first + facets; e->n.facets++) e->facets[e->n.facets] = 0;
        e->n.walls = DEMI_MAX(e->n.walls, i + 1);
    }
    return 1;
}
/* Books losses on the wall of a contact, J: normal, by sliding on this facet. */
static void demi_event_wear(dem_world *w, int32_t wall, int facet, double normal, double slide) {
    demi_worn *worn = &w->events.walls[(wall - 1)%DEMI_WALLS_MOST];
    if (worn->id != wall) return;               /* removed since */
    worn->normal += normal;
    worn->slide += slide;
    if (facet < worn->count) w->events.facets[worn->first + facet] += slide;
}

/* --- contacts of a step --- */

/* Fills in who touches. Returns 1 if the two of the note are exchanged: b has the lower slot. */
static int demi_event_key(const dem_world *m, const demi_noted *n, dem_event *key) {
    const dem_body a = dem_body_id_get(m, n->a);
    const dem_body b = n->b < 0 ? demi_no_body : dem_body_id_get(m, n->b);
    const int flip = n->b >= 0 && b.slot < a.slot;
    key->a = flip ? b : a;
    key->b = flip ? a : b;
    key->wall = n->b < 0 ? m->walls[-1 - n->b].id : 0;
    return flip;
}
/* Fills in how a contact begins. m: the world that has noted it. */
static void demi_event_begin(const dem_world *w, const dem_world *m, const demi_noted *n,
                             const demi_noted_at *noted, dem_event *e) {
    const demi_bodies *b = &m->bodies;
    const demi_wall *wall = n->b < 0 ? &m->walls[-1 - n->b] : 0;
    const demi_periods all = demi_periods_of(w), own = demi_periods_of(m);
    const dem_vec3 centre = demi_at(b->pos + 4*n->a);
    const dem_vec3 way = wall ? centre :        /* to the other centre; not used for a wall */
        demi_nearest(&own, demi_sub(demi_at(b->pos + 4*n->b), centre));
    dem_vec3 normal, arm, v, slip;
    dem_real inv = b->inv_mass[n->a];
    const int flip = demi_event_key(m, n, e);
    const int32_t material_a = b->material[n->a];
    const int32_t material_b = wall ? wall->material + 1 : b->material[n->b];
    if (n->kind & DEMI_NOTED_SPHERES) {
        const dem_real length = demi_length(way), radius = b->pos[4*n->a + 3];
        normal = demi_scale(way, 1/DEMI_MAX(length, DEM_R(1e-30)));
        arm = demi_note_arm(normal, radius, length, radius + b->pos[4*n->b + 3]);
    } else {
        normal = noted->normal;
        arm = noted->arm;
    }
    v = demi_velocity_at(b->vel, b->spin, n->a, arm);
    if (wall)
        v = demi_sub(v, demi_surface_at(&wall->pose, demi_add(demi_add(centre, arm),
                                                              noted->shift)));
    if (wall && wall->glides) v = demi_sub(v, demi_glide_at(wall, &wall->pose, normal));
    if (!wall) {
        v = demi_sub(v, demi_velocity_at(b->vel, b->spin, n->b, demi_sub(arm, way)));
        if (m->cell.on) v = demi_sub(v, demi_cell_flow(m, way));
        inv += b->inv_mass[n->b];
    }
    slip = demi_sub(v, demi_scale(normal, demi_dot(v, normal)));
    e->kind = DEM_EVENT_BEGIN;
    e->material_a.id = flip ? material_b : material_a;
    e->material_b.id = flip ? material_a : material_b;
    e->cut = w->events.n.fresh && (n->kind & DEMI_NOTED_OLD);
    e->point = demi_place_of(&all, demi_add(centre, arm));
    e->normal = demi_scale(normal, flip ? -1 : 1);
    e->begin = e->end = w->clock.time;
    e->closing_speed = (double)demi_dot(v, normal);
    e->slip_speed = (double)demi_length(slip);
    e->mass = inv > 0 ? 1/(double)inv : 0;
}
/* Adds a contact to those that wait for the user's function. Returns 0 if memory ran out. */
static int demi_event_wait(dem_world *w, const dem_event *event) {
    demi_events *e = &w->events;
    if (!e->desc.function || (event->kind == DEM_EVENT_BEGIN && !e->desc.begins)) return 1;
    if (!DEMI_GROW(w, e->pending, (size_t)e->n.pending + 1)) return 0;
    e->pending[e->n.pending++] = *event;
    return 1;
}
/* True if the scene has changed and nothing moves. What a tangential spring then gains is `growth`
   in the ledger, not work of the contact. So that it does not count as a loss, it is added to the
   work. */
static int demi_event_changed(const dem_world *w) { return !demi_member(w, 0)->stage.forces_valid; }
/* Returns the index of the open contact of a note, which begins if there is none; -1 if memory ran
   out. *next: as for demi_event_find. */
static DEMI_APART int demi_event_open(dem_world *w, const dem_world *m, const demi_noted *n,
                                      const demi_noted_at *at, int *next) {
    demi_events *e = &w->events;
    dem_event key;
    int i;
    demi_event_key(m, n, &key);
    i = demi_event_find(e, &key, next);
    if (i >= 0) return i;
    if (!demi_event_widen(w)) return -1;
    i = e->n.open;
    memset(&e->open[i], 0, sizeof e->open[i]);
    memset(&e->sums[i], 0, sizeof e->sums[i]);
    e->last[i] = e->turn - 1;
    demi_event_begin(w, m, n, at, &e->open[i].event);
    if (!demi_event_wait(w, &e->open[i].event)) return -1;
    *demi_event_place(e, &key) = ++e->n.open;
    return i;
}
/* What holds for all notes of a turn. */
typedef struct demi_turn {
    double dt;                     /* s, 0 if the bodies have not moved yet */
    int lasting, changed, fresh;   /* DEMI_LASTING of the response; demi_event_changed; n.fresh */
    int after, listed;             /* 1: there are notes of the turn before; the lists stayed */
} demi_turn;
/* Adds note number `number` to open contact i. */
DEM_INLINE void demi_event_add(dem_world *w, const dem_world *m, const demi_noted *n,
                               const demi_noted_at *at, int i, uint32_t number,
                               const demi_turn *turn) {
    demi_events *e = &w->events;
    const demi_wall *wall = n->b < 0 ? &m->walls[-1 - n->b] : 0;
    const int known = !(turn->fresh && (n->kind & DEMI_NOTED_OLD));
    demi_sums *s = &e->sums[i];
    int facet = 0;
    if (e->last[i] - e->turn > number - e->turn) {     /* its first note of this turn */
        e->last[i] = number;
        s->most = DEMI_MAX(s->most, s->force);
        if (turn->changed) s->work -= s->stored;
        s->force = s->stored = 0;
    }
    s->force += n->force;
    s->stored += n->stored;
    if (known && turn->changed) s->work += n->stored;
    if (wall && n->slide > 0 && demi_wall_kinds[wall->kind].corners > 1)
        facet = demi_worn_facet(wall, demi_add(demi_add(at->arm, at->shift),
                                               demi_at(m->bodies.pos + 4*n->a)));
    if (turn->lasting) {
        s->normal += n->normal;
        s->slide += n->slide;
        s->rolling += n->rolling;
        /* a spring that exists already: what it stored before is unknown, but not lost */
        s->work += known ? n->work : n->slide + n->stored;
        s->impulse += n->force*turn->dt;
        if (wall) demi_event_wear(w, wall->id, facet, n->normal, n->slide);
    } else {
        demi_ongoing *o = &e->open[i];
        o->due[0] += n->normal;
        o->due[1] += n->slide;
        o->due[2] += n->rolling;
        o->due[3] += n->force*turn->dt;
        o->facet = facet;
    }
}
/* Impulses: books what was due when bodies have moved, see demi_due_book. */
static void demi_events_due(dem_world *w) {
    demi_events *e = &w->events;
    int i;
    for (i = 0; i < e->n.open && !demi_response_is(w, DEMI_LASTING); i++) {
        demi_ongoing *o = &e->open[i];
        demi_sums *s = &e->sums[i];
        s->normal += o->due[0];
        s->slide += o->due[1];
        s->rolling += o->due[2];
        s->work += o->due[1];                   /* no springs: all of it slides */
        s->impulse += o->due[3];
        if (o->event.wall) demi_event_wear(w, o->event.wall, o->facet, o->due[0], o->due[1]);
        memset(o->due, 0, sizeof o->due);
    }
}
/* Returns open contact i as users see it. */
static dem_event demi_event_shown(const dem_world *w, int i, dem_event_kind kind) {
    const demi_sums *s = &w->events.sums[i];
    dem_event e = w->events.open[i].event;
    e.kind = kind;
    e.end = w->clock.time;
    e.force = DEMI_MAX(s->most, s->force);
    e.impulse = s->impulse;
    e.lost_normal = s->normal;
    e.lost_slide = s->slide;
    e.lost_tangent = s->work - s->slide - (kind == DEM_EVENT_END ? 0 : s->stored);
    e.lost_rolling = s->rolling;
    return e;
}

/* --- the end of a contact --- */

/* Returns the sums of the contacts of two materials (indices); null if memory ran out. */
static demi_impacts *demi_impacts_of(dem_world *w, int a, int b) {
    demi_events *e = &w->events;
    demi_impacts *p;
    int i;
    for (i = 0; i < e->n.pairs; i++)
        if (e->pairs[i].a == DEMI_MIN(a, b) && e->pairs[i].b == DEMI_MAX(a, b)) return &e->pairs[i];
    if (!DEMI_GROW(w, e->pairs, (size_t)i + 1)) return 0;
    p = &e->pairs[e->n.pairs++];
    memset(p, 0, sizeof *p);
    p->a = DEMI_MIN(a, b);
    p->b = DEMI_MAX(a, b);
    return p;
}
/* Returns the bin of an energy, J: five per decade from 1e-18 J on. */
static int demi_impact_bin(double energy) {
    const double at = energy > 0 ? 5*(demi_log(energy)*0.43429448190325183 + 18) : 0;
    return at > 0 ? (int)DEMI_MIN(at, DEM_IMPACT_BINS - 1) : 0;
}
/* Adds a contact that has ended to the statistics. Returns 0 if memory ran out. */
static int demi_impacts_add(dem_world *w, const dem_event *e) {
    demi_impacts *p = demi_impacts_of(w, (int)e->material_a.id - 1, (int)e->material_b.id - 1);
    const double lost = e->lost_normal + e->lost_slide + e->lost_tangent + e->lost_rolling;
    const int bin = demi_impact_bin(lost);
    const double v = DEMI_MAX(e->closing_speed, 0);
    if (!p) return 0;
    p->ended++;
    p->lost[0] += e->lost_normal;
    p->lost[1] += e->lost_slide;
    p->lost[2] += e->lost_tangent;
    p->lost[3] += e->lost_rolling;
    p->losses[bin]++;
    p->energy[bin] += lost;
    if (!(e->cut & 1)) p->impacts[demi_impact_bin(e->mass*v*v/2)]++;
    return 1;
}
/* True if the body is in the scene. */
static int demi_event_exists(const dem_world *w, dem_body b) {
    int k;
    for (k = 0; k < demi_members(w); k++) {
        const demi_bodies *m = &demi_member(w, k)->bodies;
        if ((int)b.slot <= m->slot_count && m->slot_index[b.slot - 1] >= 0 &&
            m->slot_generation[b.slot - 1] == b.generation) return 1;
    }
    return 0;
}
/* Returns the last open contact, of those up to i, that was not noted in the turn that has just
   ended; -1 if there is none. */
static int demi_event_left(const demi_events *e, int i) {
    const uint32_t *last = e->last, turn = e->turn, count = (uint32_t)e->before_count;
    while (i >= 0 && last[i] - turn < count) i--;
    return i;
}
/* Ends open contact i. Returns 0 if memory ran out. */
static int demi_event_end(dem_world *w, int i) {
    demi_events *e = &w->events;
    dem_event event;
    dem_wall wall;
    if (demi_event_changed(w)) e->sums[i].work -= e->sums[i].stored;
    event = demi_event_shown(w, i, DEM_EVENT_END);
    wall.id = event.wall;
    if (!demi_event_exists(w, event.a) || (wall.id ? !demi_wall_there(w, wall)
                                           : !demi_event_exists(w, event.b))) event.cut |= 2;
    demi_event_drop(e, i);
    return demi_impacts_add(w, &event) && demi_event_wait(w, &event);
}
/* Empties a recording. */
static void demi_events_clear(dem_world *w) {
    demi_events *e = &w->events;
    memset(&e->n, 0, sizeof e->n);
    e->before_count = 0;
    if (e->table) memset(e->table, 0, (size_t)e->table_size*sizeof *e->table);
}
/* Allocates what a recording of the present counts needs. Returns 0 if memory ran out. */
static int demi_events_reserve(dem_world *w) {
    demi_events *e = &w->events;
    int size = 64;
    while (size/2 < e->n.open) size *= 2;
    if (!e->n.on) return 1;
    if (!DEMI_GROW(w, e->open, (size_t)e->n.open) || !DEMI_GROW(w, e->sums, (size_t)e->n.open) ||
        !DEMI_GROW(w, e->last, (size_t)e->n.open) ||
        !DEMI_GROW(w, e->pending, (size_t)e->n.pending) ||
        !DEMI_GROW(w, e->pairs, (size_t)e->n.pairs) ||
        !DEMI_GROW(w, e->walls, (size_t)e->n.walls) ||
        !DEMI_GROW(w, e->facets, (size_t)e->n.facets) || !DEMI_GROW(w, e->table, (size_t)size))
        return 0;
    e->table_size = size;
    return 1;
}
/* Fills the table of a recording that was read or copied. */
static void demi_events_index(dem_world *w) {
    demi_events *e = &w->events;
    int i;
    e->before_count = 0;
    if (!e->n.on) return;
    memset(e->table, 0, (size_t)e->table_size*sizeof *e->table);
    for (i = 0; i < e->n.open; i++) {
        *demi_event_place(e, &e->open[i].event) = i + 1;
        e->last[i] = e->turn;                   /* before the next turn */
    }
}
/* Copies the recording of another world. Returns 0 if memory ran out; then the old one stays. */
static int demi_events_copy(dem_world *to, const dem_world *from) {
    const demi_events *f = &from->events;
    demi_events *e = &to->events;
    const demi_event_counts old = e->n;
    e->n = f->n;
    if (f->n.on && !demi_events_reserve(to)) { e->n = old; return 0; }
    if (!old.on) e->desc = f->desc;
    if (!f->n.on) return 1;
    if (e->n.open) memcpy(e->open, f->open, (size_t)e->n.open*sizeof *e->open);
    if (e->n.open) memcpy(e->sums, f->sums, (size_t)e->n.open*sizeof *e->sums);
    if (e->n.pending) memcpy(e->pending, f->pending, (size_t)e->n.pending*sizeof *e->pending);
    if (e->n.pairs) memcpy(e->pairs, f->pairs, (size_t)e->n.pairs*sizeof *e->pairs);
    if (e->n.walls) memcpy(e->walls, f->walls, (size_t)e->n.walls*sizeof *e->walls);
    if (e->n.facets) memcpy(e->facets, f->facets, (size_t)e->n.facets*sizeof *e->facets);
    demi_events_index(to);
    return 1;
}
/* Sets whether the members of a team note contacts. */
static void demi_events_switch(dem_world *w, int on) {
    int k;
    w->events.n.on = on;
    for (k = 0; k < demi_members(w); k++) demi_member(w, k)->events.n.on = on;
}
/* Ends a recording for lack of memory; demi_events_tell reports it. */
static void demi_events_fail(dem_world *w) {
    demi_events_clear(w);
    demi_events_switch(w, 0);
    w->events.failed = 1;
}
/* Takes over the contacts that work group d of member m has noted. count: notes taken before, and
   afterwards with these; *next: as for demi_event_find. Returns 0 if memory ran out. */
static DEMI_APART int demi_events_add(dem_world *w, const dem_world *m, int d, int *count,
                                      int *next, const demi_turn *of) {
    demi_events *e = &w->events;
    const demi_turn turn = *of;
    const demi_noted *n = m->events.noted + m->events.noted_first[d];
    const demi_noted *const end = n + m->events.noted_count[d];
    const demi_noted_at *at = m->events.noted_at + m->events.noted_first[d];
    demi_matched *now = e->matched + *count;
    uint32_t number = e->turn + (uint32_t)*count;
    *count += (int)(end - n);
    for (; n < end; n++, at++, now++, number++) {
        const int again = turn.listed ? demi_event_again(e, n, m->member, next) : -1;
        const int open = again >= 0 ? again : demi_event_open(w, m, n, at, next);
        if (open < 0) return 0;
        if (turn.after) demi_event_ahead(e, *next);
        now->a = n->a;
        now->b = n->b;
        now->member = m->member;
        now->open = open;
        demi_event_add(w, m, n, at, open, number, &turn);
    }
    return 1;
}
/* Takes over the contacts that all members have noted, and ends those that nobody noted. If memory
   runs out, recording stops; demi_events_tell reports it. */
static void demi_events_take(dem_world *w) {
    demi_events *e = &w->events;
    demi_matched *const before = e->before;
    demi_turn turn;
    int i, k, d, ok, next = 0, count = 0;
    turn.lasting = demi_response_is(w, DEMI_LASTING);
    turn.changed = demi_event_changed(w);
    turn.fresh = e->n.fresh;
    turn.after = e->before_count > 0;
    turn.listed = e->rebuilds == w->clock.rebuilds;
    turn.dt = !turn.lasting || w->stage.forces_valid ? (double)w->clock.dt : 0;
    for (k = 0; k < demi_members(w); k++)
        for (d = 0; d < DEMI_DOMAINS; d++) count += demi_member(w, k)->events.noted_count[d];
    e->turn += (uint32_t)e->before_count + 1;
    ok = DEMI_GROW(w, e->matched, (size_t)count + DEMI_EVENT_AHEAD);
    count = 0;
    for (i = 0; i < e->n.open && !turn.lasting; i++)
        memset(e->open[i].due, 0, sizeof e->open[i].due);   /* a new solution replaces the last */
    for (k = 0; k < demi_members(w); k++)
        for (d = 0; d < demi_member(w, k)->domain_count && ok; d++)
            ok = demi_events_add(w, demi_member(w, k), d, &count, &next, &turn);
    if (ok) memset(e->matched + count, 0, DEMI_EVENT_AHEAD*sizeof *e->matched);
    e->before = e->matched;                     /* this turn is now the one before */
    e->matched = before;
    e->before_count = count;
    e->rebuilds = w->clock.rebuilds;
    for (i = e->n.open - 1; ok && (i = demi_event_left(e, i)) >= 0; i--) ok = demi_event_end(w, i);
    e->n.fresh = 0;
    if (!ok) demi_events_fail(w);
}
/* Impulses: notes the present contacts, whose losses the coming step will book, from their
   histories. Returns 0 if memory ran out. */
static int demi_events_note(dem_world *w) {
    demi_walk c = demi_walk_begin();
    if (!demi_events_room(w) || !demi_notes_room(w)) return 0;
    while (demi_walk_next(w, &c)) {
        const size_t step = c.own ? 1 : (size_t)w->near.stride;
        const dem_real *y = c.own ? c.own->memory
            : w->near.memory + (size_t)c.d*DEMI_IMPULSE_REALS*step + c.entry;
        const dem_real *lost = y + DEMI_IMPULSE_LOST*step;
        const dem_real ra = demi_radius(w, c.a);
        const int wall = c.b < 0;
        double energy[DEMI_E_ROLL + 1] = {0};
        demi_noted_at *at;
        energy[DEMI_E_DASHPOT] = (double)lost[0];
        energy[DEMI_E_SLIDE] = energy[DEMI_E_SHEAR_WORK] = (double)lost[step];
        energy[DEMI_E_ROLL] = (double)lost[2*step];
        at = demi_note(w, c.d, c.a, wall ? -1 - c.own->wall : c.b, DEMI_NOTED_OLD, 0, y[6*step],
                       energy);
        if (!at) continue;
        at->normal = c.info.normal;
        at->arm = c.own ? c.own->arm_a
            : demi_note_arm(at->normal, ra, demi_length(c.branch), ra + demi_radius(w, c.b));
        at->shift = wall ? c.own->shift : demi_v(0, 0, 0);
    }
    demi_events_take(w);
    return 1;
}
/* Begins a recording. */
static void demi_events_start(dem_world *w) {
    demi_events_clear(w);
    w->events.n.fresh = 1;
    w->events.n.since = w->clock.time;
    demi_events_switch(w, 1);
    if (demi_response_is(w, DEMI_LASTING) || !w->stage.list_valid || !w->stage.forces_valid) return;
    if (!demi_events_note(w)) demi_events_fail(w);
}
/* Order in which contacts are passed on: those that begin, then those that end; by time, which
   differs only after a call that computes forces between two steps; by ids. */
static int demi_event_compare(const void *x, const void *y) {
    const dem_event *a = (const dem_event *)x, *b = (const dem_event *)y;
    const double s = a->kind == DEM_EVENT_BEGIN ? a->begin : a->end;
    const double t = b->kind == DEM_EVENT_BEGIN ? b->begin : b->end;
    const uint32_t p[] = {a->kind == DEM_EVENT_END, a->a.slot, a->b.slot, (uint32_t)a->wall,
                          a->a.generation, a->b.generation};
    const uint32_t q[] = {b->kind == DEM_EVENT_END, b->a.slot, b->b.slot, (uint32_t)b->wall,
                          b->a.generation, b->b.generation};
    int k;
    if (a->kind == b->kind && (s < t || s > t)) return s < t ? -1 : 1;
    for (k = 0; k < 5 && p[k] == q[k];) k++;
    return (p[k] > q[k]) - (p[k] < q[k]);
}
/* Calls the user's function for the contacts that have begun or ended, when a step is complete.
   call: the public function that runs. */
static dem_result demi_events_tell(dem_world *w, const char *call) {
    demi_events *e = &w->events;
    int i;
    if (e->failed) {
        e->failed = 0;
        return demi_fail(w, DEM_ERROR_MEMORY, "%s: step %llu is complete, but memory ran out for "
                         "its contact events; they are no longer recorded: free memory, call "
                         "dem_events_record again and continue", call,
                         (unsigned long long)w->clock.steps);
    }
    if (!e->n.pending) return DEM_OK;
    if (e->desc.function) demi_all(w, demi_member_finish);  /* it may look at velocities */
    qsort(e->pending, (size_t)e->n.pending, sizeof *e->pending, demi_event_compare);
    for (i = 0; i < e->n.pending && e->desc.function; i++) {
        DEMI_USER(w, call, 0, e->desc.function(&e->pending[i], e->desc.user))
    }
    e->n.pending = 0;
    return DEM_OK;
}

/* --- public functions --- */

/* Fails unless contacts are recorded. */
static dem_result demi_events_needed(dem_world *w, const char *call) {
    if (w->events.n.on) return DEM_OK;
    return demi_refuse(w, call, "contacts are not recorded; call dem_events_record before the run");
}
DEM_API dem_result dem_events_record(dem_world *w, const dem_events_desc *desc) {
    if (demi_null(w, __func__, desc, "desc")) return DEM_ERROR_ARGUMENT;
    if (!w->desc.ledger)
        return demi_refuse(w, __func__, "desc.ledger is 0, must be 1, because contacts only then "
                           "report what they lose; set it when the world is created");
    if (desc->begins < 0 || desc->begins > 1)
        return demi_refuse(w, __func__, "begins is %d, must be 0 or 1; start from DEM_EVENTS_DESC",
                           desc->begins);
    w->events.desc = *desc;
    if (!desc->function) w->events.n.pending = 0;
    if (w->events.n.on) return DEM_OK;
    demi_events_start(w);
    if (!w->events.failed) return DEM_OK;
    w->events.failed = 0;
    return demi_no_memory(w, __func__);
}
DEM_API dem_result dem_events_stop(dem_world *w) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    demi_events_clear(w);
    demi_events_switch(w, 0);
    memset(&w->events.desc, 0, sizeof w->events.desc);
    return DEM_OK;
}
DEM_API int dem_events_open_each(dem_world *w, dem_event_fn fn, void *user) {
    dem_event *all = 0;
    int i, n;
    if (demi_null(w, __func__, w, "world") || demi_events_needed(w, __func__) != DEM_OK) return -1;
    n = w->events.n.open;
    if (!fn || !n) return n;
    all = (dem_event *)demi_alloc(w, (size_t)n, sizeof *all);
    if (!all) { demi_no_memory(w, __func__); return -1; }
    for (i = 0; i < n; i++) all[i] = demi_event_shown(w, i, DEM_EVENT_OPEN);
    qsort(all, (size_t)n, sizeof *all, demi_event_compare);
    for (i = 0; i < n; i++) DEMI_USER(w, __func__, 0, fn(&all[i], user))
    demi_free(w, all);
    return n;
}
/* Recording in a step, see >>features. */
static int demi_events_on(const dem_world *h) { return h->events.n.on; }
static int demi_events_share(dem_world *slab, const dem_world *from, int first) {
    (void)first;
    slab->events.n.on = from->events.n.on;
    return 1;
}
static dem_result demi_events_ready(dem_world *h) {
    return demi_events_room(h) ? DEM_OK : demi_no_memory(h, "dem_world_step");
}
static dem_result demi_events_taken(dem_world *h) { demi_events_take(h); return DEM_OK; }
/* --- the recording in a checkpoint, see >>features --- */

static void demi_events_visit(dem_world *w, demi_stream *s) {
    demi_events *e = &w->events;
    demi_visit(s, e->open, (size_t)e->n.open*sizeof *e->open);
    demi_visit(s, e->sums, (size_t)e->n.open*sizeof *e->sums);
    demi_visit(s, e->pending, (size_t)e->n.pending*sizeof *e->pending);
    demi_visit(s, e->pairs, (size_t)e->n.pairs*sizeof *e->pairs);
    demi_visit(s, e->walls, (size_t)e->n.walls*sizeof *e->walls);
    demi_visit(s, e->facets, (size_t)e->n.facets*sizeof *e->facets);
}
static int demi_events_counts(const demi_reader *r) {
    const dem_world *t = r->t, *w = r->w;
    if ((t->events.n.on & ~1) || !demi_left(r, t->events.n.open,
                                             sizeof(demi_ongoing) + sizeof(demi_sums)) ||
        !demi_left(r, t->events.n.pending, sizeof(dem_event)) ||
        !demi_left(r, t->events.n.pairs, sizeof(demi_impacts)) ||
        !demi_left(r, t->events.n.walls, sizeof(demi_worn)) ||
        !demi_left(r, t->events.n.facets, sizeof(double)) ||
        (!t->events.n.on && (t->events.n.open || t->events.n.pending || t->events.n.pairs ||
                             t->events.n.walls || t->events.n.facets)) ||
        t->events.n.open > INT_MAX/4 || t->events.n.walls > t->wall_count ||
        !demi_finite_double(t->events.n.since) || (t->events.n.on && !w->desc.ledger))
        return demi_lie(r, "number of contact events", -1);
    return 1;
}
/* True if the ids of an event are possible and its numbers finite. */
static int demi_event_sane(const dem_world *t, const dem_event *e) {
    const double sum = e->begin + e->end + e->closing_speed + e->slip_speed + e->mass + e->force +
        e->impulse + e->lost_normal + e->lost_slide + e->lost_tangent + e->lost_rolling;
    return demi_finite_double(sum) && demi_finite3(e->point) && demi_finite3(e->normal) &&
        e->a.slot >= 1 && e->a.slot <= (uint32_t)t->bodies.slot_count &&
        (e->wall ? e->wall > 0 : e->b.slot >= 1 && e->b.slot <= (uint32_t)t->bodies.slot_count) &&
        (!e->wall || (e->wall - 1)%DEMI_WALLS_MOST < t->wall_count) &&
        e->material_a.id >= 1 && e->material_a.id <= t->material_count &&
        e->material_b.id >= 1 && e->material_b.id <= t->material_count;
}
/* Checks the recording of contacts: ids, materials and numbers of facets must be possible. */
static int demi_events_check(const demi_reader *r) {
    const dem_world *t = r->t;
    const demi_events *e = &t->events;
    double sum;
    int i, k;
    for (i = 0; i < e->n.open; i++) {
        const demi_ongoing *o = &e->open[i];
        const demi_sums *s = &e->sums[i];
        sum = s->normal + s->slide + s->rolling + s->work + s->impulse + s->stored +
            s->force + s->most + o->due[0] + o->due[1] + o->due[2] + o->due[3];
        if (!demi_event_sane(t, &o->event) || o->facet < 0 || !demi_finite_double(sum) ||
            (o->event.wall && (o->event.wall - 1)%DEMI_WALLS_MOST >= e->n.walls))
            return demi_lie(r, "contact event", i);
    }
    for (i = 0; i < e->n.pending; i++)
        if (!demi_event_sane(t, &e->pending[i])) return demi_lie(r, "contact that has ended", i);
    for (i = 0; i < e->n.pairs; i++) {
        const demi_impacts *p = &e->pairs[i];
        sum = p->ended + p->lost[0] + p->lost[1] + p->lost[2] + p->lost[3];
        for (k = 0; k < DEM_IMPACT_BINS; k++) sum += p->impacts[k] + p->losses[k] + p->energy[k];
        if (p->a < 0 || p->b < p->a || p->b >= t->material_count || !demi_finite_double(sum))
            return demi_lie(r, "spectrum", i);
    }
    for (i = 0, sum = 0; i < e->n.facets; i++) sum += e->facets[i];
    if (!demi_finite_double(sum)) return demi_lie(r, "wear of facets", -1);
    for (i = 0; i < e->n.walls; i++)
        if (!demi_finite_double(e->walls[i].slide + e->walls[i].normal) ||
            e->walls[i].first < 0 || e->walls[i].count < 0 ||
            e->walls[i].count > e->n.facets - e->walls[i].first ||
            (e->walls[i].id == t->walls[i].id && t->walls[i].kind != DEMI_WALL_NONE &&
             e->walls[i].count && e->walls[i].count != t->walls[i].element_count))
            return demi_lie(r, "wear of wall", i);
    return 1;
}
