/* ---------------------------------------------------------------------------------------------
   >>lists
   Wall candidates (the wall elements that a body may touch before the next rebuild), allocation of
   all lists, and the transfer of persistent contacts (>>persistent) from the old lists, by slot, to
   the new ones. All memory is allocated before any contact moves, so a rebuild that runs out of
   memory loses none. This part writes the wall_..., cross_..., touching_... and persistent_...
   fields of dem_world.
   --------------------------------------------------------------------------------------------- */

/* The gap, m, of a candidate that is only a sheet between bodies: larger than any. */
#define DEMI_ONLY_SHEET DEM_R(1e30)
/* Appends an element of a wall to the wall candidates of work group d. gap: m, between body and
   element; shift: m, from the body to its image at the wall; cell: of a tessellation. */
static void demi_wall_offer(dem_world *w, demi_domain *domain, int d, int body, int wall,
                            int element, dem_real gap, dem_vec3 shift, int32_t cell) {
    int k = domain->walls;
    if (k >= w->wall_stride) { domain->overflow |= 4; return; }
    domain->walls++;
    k += d*w->wall_stride;
    w->wall_body[k] = body;
    w->wall_id[k] = wall;
    w->wall_element[k] = element;
    w->wall_gap[k] = gap - demi_radius(w, body)/10000;    /* allows for rounding */
    demi_put(w->wall_shift + 3*(size_t)k, shift);
    w->wall_cell[k] = cell;
}
/* Sorts the candidates of one body and wall, from entry `first` on, by element and removes
   duplicates, so that their order does not depend on the wall's cells. */
static void demi_walls_order(dem_world *w, demi_domain *domain, int d, int first) {
    int32_t *e = w->wall_element + d*w->wall_stride;
    dem_real *gap = w->wall_gap + d*w->wall_stride;
    const int count = domain->walls - first;
    int step, i, k, n = first;
    for (step = 1; step < count/3; step = 3*step + 1) continue;
    for (; step > 0; step /= 3)                 /* Shell's sort */
        for (k = first + step; k < domain->walls; k++) {
            const int32_t t = e[k];
            const dem_real g = gap[k];
            for (i = k; i >= first + step && e[i - step] > t; i -= step) {
                e[i] = e[i - step];
                gap[i] = gap[i - step];
            }
            e[i] = t;
            gap[i] = g;
        }
    for (k = first; k < domain->walls; k++) {
        if (k > first && e[k] == e[k - 1]) continue;
        e[n] = e[k];
        gap[n++] = gap[k];
    }
    domain->walls = n;
}
/* Lists the elements of surface j (demi_surface_of) near body i, displaced by `shift` (m) to one of
   its images, which is at `at` in the frame of the surface, or of a cell of it. */
static void demi_wall_look(dem_world *w, demi_domain *domain, int d, int i, int j, dem_vec3 shift,
                           dem_vec3 at, int32_t cell) {
    const demi_wall *wall = demi_surface_of(w, j);
    const dem_real r = demi_radius(w, i), near_by = r + demi_cover(w);
    const int first = domain->walls;
    const dem_vec3 out = demi_v(near_by, near_by, near_by);
    dem_real away;
    int k, x, y, z, f[3], l[3];
    if (demi_wall_is(wall, DEMI_DRAWN)) at.z = 0;
    if (!wall->cell_start) {
        for (k = 0; k < wall->element_count; k++) {
            away = demi_wall_distance(wall, k, at, near_by);
            if (away < near_by) demi_wall_offer(w, domain, d, i, j, k, away - r, shift, cell);
        }
    } else {
        demi_wall_cells(wall, demi_sub(at, out), demi_add(at, out), f, l);
        for (z = f[2]; z <= l[2]; z++)
            for (y = f[1]; y <= l[1]; y++)
                for (x = f[0]; x <= l[0]; x++) {
                    const int32_t *box = wall->cell_start + x + wall->cells[0]*(y +
                                                                               wall->cells[1]*z);
                    for (k = box[0]; k < box[1]; k++) {
                        const int element = wall->cell_items[k];
                        const int32_t *e = w->wall_element + d*w->wall_stride;
                        int q = DEMI_MAX(first, domain->walls - 16);       /* few duplicates */
                        while (q < domain->walls && e[q] != element) q++;
                        if (q < domain->walls) continue;
                        away = demi_wall_distance(wall, element, at, near_by);
                        if (away < near_by)
                            demi_wall_offer(w, domain, d, i, j, element, away - r, shift, cell);
                    }
                }
    }
    if (domain->walls > first) demi_walls_order(w, domain, d, first);
}
/* Sets *shift, m, to the displacement from a position to the n-th of its images (n = 0, 1, ...)
   that may be nearer to a wall than `far`. Returns 0 if there are no more. */
static int demi_wall_image(const dem_world *w, const demi_wall *wall, dem_vec3 place, dem_real far,
                           int n, dem_vec3 *shift) {
    dem_real x[3];
    int k;
    demi_put(x, place);
    for (k = 0; k < 3; k++) {
        const dem_real period = w->wall_period[k], lo = wall->span_lo[k] - far - x[k];
        const dem_real hi = wall->span_hi[k] + far - x[k];
        const int repeats = wall->repeats[k];
        const int first = repeats ? (int)ceil((double)lo/(double)period) : 0;
        const int count = repeats ? (int)floor((double)hi/(double)period) - first + 1 : 1;
        if (count < 1) return 0;
        x[k] = (dem_real)(first + n%count)*period;
        n /= count;
    }
    *shift = demi_at(x);
    return !n;
}
/* Lists the elements of surface j near one image of body i: of all cells that are near. */
static void demi_wall_look_all(dem_world *w, demi_domain *domain, int d, int i, int j,
                               dem_vec3 shift) {
    const demi_wall *wall = demi_surface_of(w, j);
    const dem_vec3 at = demi_unrotate(wall->pose.rotation, demi_sub(demi_add(demi_at(
        w->bodies.pos + 4*i), shift), wall->pose.position)), *step = wall->step;
    const double far = (double)(demi_radius(w, i) + demi_cover(w));
    const dem_box *box = &wall->box;
    double u, v, to_u, to_v;
    dem_vec3 n;
    if (demi_tessellation_beyond(w, wall, at, &n)) {
        demi_wall_offer(w, domain, d, i, j, 0, -demi_radius(w, i), shift, 0);
        return;
    }
    if (!(step[0].x > 0)) { demi_wall_look(w, domain, d, i, j, shift, at, 0); return; }
    v = ceil(((double)(at.y - box->hi.y) - far)/(double)step[1].y);
    to_v = ((double)(at.y - box->lo.y) + far)/(double)step[1].y;
    for (; v <= to_v; v++) {
        const double x = (double)at.x - v*(double)step[1].x;
        u = ceil((x - (double)box->hi.x - far)/(double)step[0].x);
        to_u = (x - (double)box->lo.x + far)/(double)step[0].x;
        for (; u <= to_u; u++) {
            const int32_t cell = demi_cell_pack(u, v);
            demi_wall_look(w, domain, d, i, j, shift, demi_sub(at, demi_cell_shift(wall, cell, at)),
                           cell);
        }
    }
}
/* Lists the elements of all surfaces near body i that it does not ignore. A fixed body and a ghost
   have no contacts with walls: their candidates are sheets only, with the gap DEMI_ONLY_SHEET. */
static void demi_body_walls(dem_world *w, int d, int i) {
    demi_domain *domain = &w->domains[d];
    const int touches = !(w->effects.fixed_count && w->bodies.inv_mass[i] <= 0) &&
        !demi_is_ghost(w, i);
    int j, n, k = d*w->wall_stride + domain->walls;
    if (!touches && !w->sheeted) return;
    for (j = 0; j < w->wall_count + w->surface_count; j++) {
        const demi_wall *wall = demi_surface_of(w, j);
        dem_vec3 shift;
        if (wall->kind == DEMI_WALL_NONE || wall->joined || wall->covered ||
            (!touches && !wall->open) || demi_surface_scale(w, j, i) != wall->scale ||
            (w->effects.ignoring && demi_ignores(w, w->bodies.material[i] - 1, wall->material)))
            continue;
        for (n = 0; demi_wall_image(w, wall, demi_at(w->bodies.pos + 4*i),
                                    demi_radius(w, i) + demi_cover(w), n, &shift); n++)
            demi_wall_look_all(w, domain, d, i, j, shift);
    }
    for (; !touches && k < d*w->wall_stride + domain->walls; k++) w->wall_gap[k] = DEMI_ONLY_SHEET;
}
/* Lists the wall candidates of a work group, body by body; those of a body and a wall are
   consecutive. */
static void demi_domain_walls(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    int i;
    domain->walls = 0;
    domain->overflow &= ~4;
    for (i = domain->begin; i < domain->end; i++) demi_body_walls(w, d, i);
}
/* Notes wall candidates first .. end - 1, those of one work group, with their bodies. */
static void demi_walled_add(dem_world *w, int first, int end) {
    int k;
    for (k = first; k < end; k++) {
        demi_walled *of = w->walled + w->wall_body[k];
        if (!of->end) of->first = k;
        of->end = k + 1;
        if (!demi_surface_of(w, w->wall_id[k])->open) continue;
        w->by_sheet[w->wall_body[k]] = 1;
        of->gap = DEMI_MIN(of->gap, w->wall_gap[k] < DEMI_ONLY_SHEET ? w->wall_gap[k]
                                                                     : -DEMI_ONLY_SHEET);
    }
}
/* Notes the wall candidates of each body, while some surface is a sheet. 0: memory ran out. */
static int demi_walled_note(dem_world *w) {
    const demi_walled none = {0, 0, DEMI_ONLY_SHEET};
    const int n = w->bodies.count + w->join_room;
    int d, i;
    if (!w->sheeted) return 1;
    if (!DEMI_GROW(w, w->walled, (size_t)n) || !DEMI_GROW(w, w->by_sheet, (size_t)n)) return 0;
    for (i = 0; i < n; i++) { w->walled[i] = none; w->by_sheet[i] = 0; }
    for (d = 0; d < w->domain_count; d++)
        demi_walled_add(w, d*w->wall_stride, d*w->wall_stride + w->domains[d].walls);
    return 1;
}

/* Allocates a candidate list of `stride` entries per work group. Returns 0 if memory runs out;
   arrays that have grown stay valid. */
static int demi_list_reserve(dem_world *w, demi_list *list, int domains, int stride) {
    const size_t n = (size_t)domains*(size_t)stride;
    const int ok = n <= (size_t)INT_MAX/8 && DEMI_GROW(w, list->a, n) && DEMI_GROW(w, list->b, n) &&
                   DEMI_GROW(w, list->place, n) && DEMI_GROW(w, list->image, n);
    if (ok) list->stride = stride;
    return ok;
}
/* True if there are more species than the table holds, so that every pair of the pruned list stores
   its own coefficients. */
static int demi_many_species(const dem_world *w) {
    return w->effects.species_count > DEMI_SPECIES;
}
/* As demi_list_reserve, for a pruned neighbour list. */
static int demi_near_reserve(dem_world *w, demi_near *near, int domains, int stride) {
    const size_t n = (size_t)domains*(size_t)stride, m = n*(size_t)w->memory_stride;
    const int ok = n <= (size_t)INT_MAX/8 && DEMI_GROW(w, near->a, n) && DEMI_GROW(w, near->b, n) &&
                   DEMI_GROW(w, near->k, n) && DEMI_GROW(w, near->image, n) &&
                   DEMI_GROW(w, near->balls, !w->effects.clustered && w->effects.unlike ? n : 0) &&
                   (!w->effects.clustered || (DEMI_GROW(w, near->ball_a, n) &&
                    DEMI_GROW(w, near->ball_b, n) && DEMI_GROW(w, near->on, n) &&
                    DEMI_GROW(w, near->hit, n))) && DEMI_GROW(w, near->memory, m) &&
                   (w->effects.uniform || (demi_many_species(w)
                       ? DEMI_GROW(w, near->coef, n*DEMI_PAIR_COLUMNS)
                       : DEMI_GROW(w, near->row, n)));
    if (ok) near->stride = stride;
    return ok;
}
/* The same for wall candidates. */
static int demi_wall_lists_reserve(dem_world *w, int stride) {
    const size_t n = (size_t)w->domain_count*(size_t)stride;
    const int ok = n <= (size_t)INT_MAX/8 && DEMI_GROW(w, w->wall_body, n) &&
                   DEMI_GROW(w, w->wall_id, n) && DEMI_GROW(w, w->wall_shift, 3*n) &&
                   DEMI_GROW(w, w->wall_cell, n) && DEMI_GROW(w, w->wall_gap, n) &&
                   DEMI_GROW(w, w->wall_element, n);
    if (ok) w->wall_stride = stride;
    return ok;
}
/* Allocates the sums of forces of each work group on each wall. */
static int demi_wall_sums_room(dem_world *w) {
    const size_t n = (size_t)w->domain_count*(size_t)w->wall_count;
    return DEMI_GROW(w, w->wall_sums, n) &&
           (!demi_exchanges(w) || DEMI_GROW(w, w->wall_rates, (size_t)w->bodies.real_count*n));
}
/* Allocates the forces of all entries that `cross` can hold. */
static int demi_cross_reserve(dem_world *w) {
    const size_t entries = (size_t)w->domain_count*(size_t)w->cross.stride;
    const size_t reals = (size_t)w->bodies.real_count*(entries + DEMI_LANES + 1);
    return DEMI_GROW(w, w->cross_incoming, entries) &&
        DEMI_GROW(w, w->cross_force, 6*(entries + DEMI_LANES + 1)) &&
        (!demi_exchanges(w) || DEMI_GROW(w, w->cross_rate, reals));
}
/* Returns the work group of a body. */
static int demi_domain_of(const dem_world *w, int body) {
    int d = (int)((int64_t)body*w->domain_count/w->bodies.count);
    while (body >= w->domains[d].end) d++;
    while (body < w->domains[d].begin) d--;
    return d;
}
/* Lists the entries of `cross` by the work group of body b, so that each group can add the forces
   of pairs that earlier groups compute. */
static void demi_cross_index(dem_world *w) {
    int d, k, e;
    for (d = 0; d <= w->domain_count; d++) w->cross_incoming_start[d] = 0;
    for (d = 0; d < w->domain_count; d++)
        for (k = 0; k < w->domains[d].cross; k++) {
            e = demi_domain_of(w, w->cross.b[d*w->cross.stride + k]);
            w->cross_incoming_start[e + 1]++;
        }
    for (d = 0; d < w->domain_count; d++)
        w->cross_incoming_start[d + 1] += w->cross_incoming_start[d];
    w->cross_entries = w->cross_incoming_start[w->domain_count];
    for (d = w->domain_count - 1; d >= 0; d--)
        for (k = w->domains[d].cross - 1; k >= 0; k--) {
            const int entry = d*w->cross.stride + k;
            e = demi_domain_of(w, w->cross.b[entry]);
            w->cross_incoming[--w->cross_incoming_start[e + 1]] = entry;
        }
    for (d = 0; d < w->domain_count; d++)
        w->cross_incoming_start[d] = w->cross_incoming_start[d + 1];
    w->cross_incoming_start[w->domain_count] = w->cross_entries;
}

/* Returns the largest number of contact points of one body with one wall. Its candidates in work
   group d begin at k; *end receives the first of the next body or wall. A polyhedron may have four
   points in each of the ways in which it touches (the two sides of facets, the skirts at open
   edges), and four more by gaps. A joined surface has them for each of its walls. */
static int demi_places_of(const dem_world *w, int d, int k, int *end) {
    const int base = d*w->wall_stride, body = w->wall_body[base + k], id = w->wall_id[base + k];
    const demi_wall *wall = demi_surface_of(w, id);
    const demi_wall_kind *kind = &demi_wall_kinds[wall->kind];
    const int sets = wall->kind == DEMI_WALL_SIEVE ? 2 : 1, ways = sets*DEMI_FLATS;    /* wires */
    const int parts = wall->whose ? DEMI_FLATS_WALLS : ways;
    int n = 0, flats = 0;
    for (; k < w->domains[d].walls && w->wall_body[base + k] == body &&
           w->wall_id[base + k] == id; k++) {
        n += kind->most;
        flats += kind->corners ? 4*ways + 4 : 8*ways;
    }
    if (kind->corners && !w->repeating) flats = DEMI_MIN(flats, 4*(ways + parts));
    *end = k;
    return w->bodies.shaped ? DEMI_MAX(n, flats) : n;
}
/* Returns the largest number of wall contacts of work group d with the present candidates. */
static int demi_places_most(const dem_world *w, int d) {
    int k = 0, n = 0;
    while (k < w->domains[d].walls) n += demi_places_of(w, d, k, &k);
    return n;
}
/* Allocates w->touching for the contact points of one body and wall, with a segment for each work
   group. Returns 0 if memory runs out. */
static int demi_touching_reserve(dem_world *w) {
    size_t n = 0;
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        int most = DEMI_SIEVE_MOST;
        w->domains[d].touching_first = (int)n;
        for (k = 0; k < w->domains[d].walls;) {
            const int places = demi_places_of(w, d, k, &k);
            most = DEMI_MAX(most, places);
        }
        n += (size_t)most;
        if (n > (size_t)INT_MAX/8) return 0;
    }
    w->touching_valid = DEMI_GROW(w, w->touching, n) && DEMI_GROW(w, w->touching_links, n) &&
                        DEMI_GROW(w, w->touching_table, 4*n);
    return w->touching_valid;
}
/* Computes where the persistent contacts of each work group begin (first). A group gets room for
   one contact per wall candidate or, if more, for the contacts that continue (crowd), plus a
   quarter. Slabs of spheres do not allocate in the middle of a step, so they get room for the
   largest possible number of wall contacts. Groups from `listed` on are out of use and only hold
   contacts that continue. */
static void demi_persistent_lay(const dem_world *w, int listed, const int *crowd, int *first) {
    int d;
    for (d = 0, first[0] = 0; d < DEMI_DOMAINS; d++) {
        const demi_domain *domain = &w->domains[d];
        int n = d < listed ? domain->walls : 0;
        if (d == listed - 1 && w->wall_count) n += w->join_room;
        n = DEMI_MAX(n, crowd[d]);
        n += n ? n/4 + 16 : 0;
        if (d < listed && w->bodies.ghost) n = DEMI_MAX(n, demi_places_most(w, d));
        if (d < listed && w->effects.unlike) n += DEMI_MAX(64, 4*(domain->end - domain->begin));
        first[d + 1] = first[d] + n;
    }
}
/* Allocates the persistent contacts of a new list and the walls' sums; moves nothing yet. first
   receives where those of each work group will begin. Returns 0 if memory runs out. */
static int demi_persistent_room(dem_world *w, int *first) {
    int crowd[DEMI_DOMAINS], d, k, total = 0;
    memset(crowd, 0, sizeof crowd);
    for (d = 0; d < DEMI_DOMAINS; d++) total += w->domains[d].persistent;
    for (d = 0; d < DEMI_DOMAINS; d++)          /* upper bound per group */
        for (k = 0; k < w->domains[d].persistent; k++) {
            const demi_persistent *c = demi_persistent_of(w, d) + k;
            const int a = w->bodies.slot_index[c->a], b = c->b < 0 ? a : w->bodies.slot_index[c->b];
            if (a >= 0 && b >= 0) crowd[demi_domain_of(w, DEMI_MIN(a, b))]++;
        }
    demi_persistent_lay(w, w->domain_count, crowd, first);
    return demi_wall_sums_room(w) &&
           DEMI_GROW(w, w->persistent_next, (size_t)DEMI_MAX(first[DEMI_DOMAINS], total)) &&
           DEMI_GROW(w, w->persistent_now, (size_t)first[DEMI_DOMAINS]) &&
           DEMI_GROW(w, w->coefs, 2*(size_t)first[DEMI_DOMAINS]);
}
/* Moves the contacts whose bodies and walls still exist from the old list (by slot) into the work
   groups of the new one. Body a becomes the one with the lower index. Where this exchanges a and b,
   the normal and the vectors of the history change sign, and arms and parts are exchanged. */
static void demi_persistent_move(dem_world *w, const int *first) {
    int d, k, e = 0, i;
    for (d = 0; d < DEMI_DOMAINS; d++) {
        for (k = 0; k < w->domains[d].persistent; k++) {
            demi_persistent c = demi_persistent_of(w, d)[k];
            const int pair = c.b >= 0;
            c.a = w->bodies.slot_index[c.a];
            if (pair) c.b = w->bodies.slot_index[c.b];
            if (c.a < 0 || (pair && c.b < 0) ||
                (!pair && w->walls[c.wall].kind == DEMI_WALL_NONE)) continue;
            if (pair && c.b < c.a) {
                const dem_vec3 arm = c.arm_a;
                i = c.a; c.a = c.b; c.b = i;
                i = c.part_a; c.part_a = c.part_b; c.part_b = i;
                c.arm_a = c.arm_b; c.arm_b = arm;
                c.normal = demi_scale(c.normal, -1);
                c.lambda = c.lambda > 0 ? 1 - c.lambda : 0;
                if (c.corners) c.corner ^= 1;
                for (i = 0; i < w->memory_stride; i++)
                    if (w->vector_mask >> i & 1) c.memory[i] = -c.memory[i];
            }
            w->persistent_next[e++] = c;
        }
        w->domains[d].persistent = w->domains[d].persistent_walls = 0;
        w->domains[d].coefs = 0;                /* materials may have changed */
    }
    memcpy(w->persistent_first, first, sizeof w->persistent_first);
    /* counting sort by body a; bodies.order is free after the search and holds the counts */
    if (e) memset(w->bodies.order, 0, (size_t)w->bodies.count*sizeof *w->bodies.order);
    for (k = 0; k < e; k++) w->bodies.order[w->persistent_next[k].a]++;
    for (d = 0; d < w->domain_count; d++)
        for (i = w->domains[d].begin; e && i < w->domains[d].end; i++) {
            const int here = w->bodies.order[i];
            w->bodies.order[i] = w->domains[d].persistent;
            w->domains[d].persistent += here;
        }
    for (k = 0; k < e; k++) {
        const demi_persistent *c = &w->persistent_next[k];
        d = demi_domain_of(w, c->a);
        demi_persistent_of(w, d)[w->bodies.order[c->a]++] = *c;
        w->domains[d].persistent_walls += c->b < 0 &&
            (c->overlap > 0 || c->row < 0); /* as respond */
    }
}
