/* ---------------------------------------------------------------------------------------------
   >>measure
   Measurements of the present state: counters, contacts, blinded grains of a sieve, the angle of
   repose, and the digest of a world. Functions that take the world as const change nothing that a
   step uses; dem_contacts_each and dem_bonds_make compute forces first if the scene has changed,
   and let the user change contact histories. Owns no data of the world; what the angle of repose
   needs is allocated and freed within the call.
   --------------------------------------------------------------------------------------------- */
DEM_API dem_counters dem_counters_get(const dem_world *w) {
    dem_counters c;
    const int pressing = w && w->bodies.shaped && demi_response_is(w, DEMI_PRESSING);
    int d, k;
    memset(&c, 0, sizeof c);
    if (!w) return c;
    c.steps = demi_steps_done(w);
    c.rebuilds = w->clock.rebuilds;
    for (d = 0; d < w->domain_count && w->stage.list_valid; d++) {
        c.candidates += w->domains[d].own + w->domains[d].cross;
        if (!demi_contacts_known(w)) continue;
        c.contacts += w->domains[d].contacts;
        c.wall_contacts += w->domains[d].persistent_walls;
        for (k = 0; k < w->domains[d].persistent && pressing; k++) {
            /* a polyhedron presses on a wall at up to four points: one contact */
            const demi_persistent *own = demi_persistent_of(w, d) + k;
            c.wall_contacts -= own->b < 0 && own->overlap > 0 && own->corner;
        }
    }
    c.overlap_max = (dem_real)w->booked.overlap_max;
    c.speed_max = (dem_real)w->booked.speed_max;
    c.skin = (dem_real)w->margin.skin;
    c.dt = w->clock.dt;
    c.search = w->desc.search;
    c.threads = w->desc.threads;
    c.domains = w->domain_count;
    c.sweeps = w->booked.sweeps;
    c.residual = (dem_real)w->booked.residual;
    c.residual_rms = (dem_real)w->booked.residual_rms;
    c.unsolved = w->booked.unsolved;
    c.memory = w->bytes;
    return c;
}
DEM_API void dem_overlap_max_reset(dem_world *w) {
    if (demi_null(w, __func__, w, "world")) return;
    w->booked.overlap_max = 0;
    memset(&w->booked.crushed, 0, sizeof w->booked.crushed);
}

DEM_API int dem_contacts_get(const dem_world *w, dem_contact_info *out, int capacity) {
    if (demi_null_look(w, __func__, w, "world")) return -1;
    demi_walk c = demi_walk_begin();
    int n = 0;
    if (!demi_contacts_known(w)) return demi_list_stale(w, __func__);
    for (c.blind = !out || capacity <= 0; demi_walk_next(w, &c); c.blind |= n >= capacity) {
        if (!c.blind) out[n] = c.info;
        n++;
    }
    return n;
}
/* Brings the contacts up to date if the scene has changed since the last step: the time step, the
   neighbour list if necessary, and forces at the present time. */
static dem_result demi_contacts_settle(dem_world *w, const char *call) {
    const demi_stages *s = &w->stage;
    dem_result result;
    demi_calling was;
    if (s->list_valid && s->forces_valid && !s->pairs_changed) return DEM_OK;
    if (w->look.calling.who)
        return demi_refuse(w, call, "the scene has changed since the last step, so contacts must "
                           "be computed again, which a function that %s calls cannot do; make this "
                           "call before the change or after %s has returned", w->look.calling.who,
                           w->look.calling.who);
    was = demi_calls(w, "a read of the contacts", 1);
    result = demi_dt_settle(w);
    if (result == DEM_OK)                       /* as a step does: inserted grains touch nothing */
        result = s->forces_valid && !s->pairs_changed ? demi_all_rebuild(w) : demi_refresh(w);
    demi_called(w, was);
    return result;
}
/* Calls fn for every contact, and returns their number, or -1. fn gets a copy of the history, which
   is written back: those of sphere pairs are columns of the pruned neighbour list. If fn changes a
   value, forces are computed again before the next step. */
static int demi_contacts_visit(dem_world *w, const char *call, dem_contact_fn fn, void *user) {
    demi_walk c = demi_walk_begin();
    dem_real memory[DEMI_MEMORY];
    int e, n = 0, changed = 0;
    if (demi_contacts_settle(w, call) != DEM_OK) return -1;
    for (; demi_walk_next(w, &c); n++) {
        const int keep = c.own ? DEMI_MEMORY : w->memory_stride;
        const size_t step = c.own ? 1 : (size_t)w->near.stride;
        dem_real *row = c.own ? c.own->memory : !keep ? memory
            : w->near.memory + (size_t)c.d*(size_t)keep*step + c.entry;
        for (e = 0; e < keep; e++) memory[e] = row[(size_t)e*step];
        DEMI_USER(w, call, 0, fn(&c.info, memory, user))
        for (e = 0; e < keep; e++) {
            dem_real *now = row + (size_t)e*step;
            changed |= memory[e] < *now || memory[e] > *now;
            *now = memory[e];
        }
    }
    if (changed) demi_scene_changed(w);
    return n;
}
DEM_API int dem_contacts_each(dem_world *w, dem_contact_fn fn, void *user) {
    return demi_null(w, __func__, fn ? w : 0, "fn") ? -1
                                                    : demi_contacts_visit(w, __func__, fn, user);
}
/* What dem_bonds_make passes to demi_bond_make: the user's function and its argument, the largest
   gap (m), and the number of pairs so far. */
typedef struct demi_bonds { dem_contact_fn make; void *user; dem_real gap; int count; } demi_bonds;
static void demi_bond_make(const dem_contact_info *c, dem_real *memory, void *user) {
    demi_bonds *b = (demi_bonds *)user;
    if (c->wall || !(c->overlap > -b->gap)) return;
    DEMI_USER_WITHIN(b->make(c, memory, b->user));
    b->count++;
}
DEM_API int dem_bonds_make(dem_world *w, dem_real gap, dem_contact_fn make, void *user) {
    if (demi_null(w, __func__, make ? w : 0, "make")) return -1;
    demi_bonds b = {make, user, gap, 0};
    double least = -1, most;
    int i, k;
    for (i = 0; i < w->bodies.count; i++)       /* parts meet, not their bodies */
        for (k = demi_parts_count(w, i) - 1; k >= 0; k--) {
            const double r = demi_shape_of(w, i) ? (double)demi_part_of(w, i, k).radius
                : (double)demi_radius(w, i);
            if (least < 0 || r < least) least = r;
        }
    most = (double)w->desc.law_range + (double)w->desc.law_range_radii*2*least;
    if (!(gap >= 0) || (double)gap > most)
        return demi_refuse(w, __func__, "gap is %g m, must be >= 0 and at most %g m, the "
                           "range of your law for the smallest grains; set a larger law_range or "
                           "law_range_radii when the world is created", (double)gap,
                           DEMI_MAX(most, 0)), -1;
    return dem_contacts_each(w, demi_bond_make, &b) < 0 ? -1 : b.count;
}

/* Extends the digest h by one contact history, whose reals are `stride` apart. flip: components of
   vectors change their sign, since the other body is a. Only reals that are not 0 and belong to an
   effect of the scene count, each with a number that does not depend on which other laws are in
   force. So the digest is the same whether or not the neighbour list has been rebuilt since
   friction was added or removed. *any receives 1 if at least one real counts, otherwise 0. */
static uint64_t demi_memory_hash(const dem_world *w, uint64_t h, const dem_real *memory,
                                 size_t stride, int flip, int *any) {
    const demi_laws *laws = &w->laws;
    demi_rubbing rub = {1, 1, 1, 1};
    int i;
    *any = 0;
    if (w->memory_stride) rub = demi_pairs_rub(w);
    for (i = 0; i < demi_memory_told(w); i++) {
        dem_real m = memory[(size_t)i*stride];
        int number = i;
        if (demi_response_is(w, DEMI_LAWS) && i == laws->at_sliding) {
            if (!rub.sticks) continue;
            number = 24;
        } else if (demi_laws_keep(w) && i == laws->at_twisting) {
            if (!rub.twisting) continue;
            number = 25;
        } else if (demi_laws_keep(w)) {
            if (i < laws->at_rolling ? !rub.friction : i < laws->at_normal && !rub.rolling)
                continue;
            if (i >= laws->at_normal) number = 16 + i - laws->at_normal;
            else if (i >= laws->at_rolling) number = 8 + i - laws->at_rolling;
        }
        if (!(m < 0) && !(m > 0)) continue;
        if (flip && (w->vector_mask >> i & 1)) m = -m;
        h = demi_hash(demi_hash(h, &number, sizeof number), &m, sizeof m);
        *any = 1;
    }
    return h;
}
/* Returns the digest of the contact history of two spheres of the bodies in slots sa and sb, the
   same whichever of them is a; 0 if the history is empty. part: as in demi_filed. */
static uint64_t demi_pair_digest(const dem_world *w, uint32_t sa, uint32_t sb, int32_t part,
                                 const dem_real *memory, size_t stride) {
    const uint32_t lo = DEMI_MIN(sa, sb), hi = DEMI_MAX(sa, sb);
    uint64_t one = demi_hash(DEMI_HASH_START, &lo, sizeof lo);
    int any;
    if (part) one = demi_hash(one, &part, sizeof part);
    one = demi_memory_hash(w, demi_hash(one, &hi, sizeof hi), memory, stride, sa > sb, &any);
    return any ? one : 0;
}
/* Returns the digest of one persistent contact, the same whichever of its bodies is a. While there
   is no neighbour list, such a contact names slots instead of indices. */
static uint64_t demi_persistent_hash(const dem_world *w, const demi_persistent *c) {
    const int pushes = c->share > 0, slots = !w->stage.list_valid;
    uint32_t who[4];
    uint64_t h = DEMI_HASH_START;
    int i, flip;
    who[0] = slots ? (uint32_t)c->a : w->bodies.slot[c->a];
    who[1] = c->b < 0 ? (uint32_t)c->element : slots ? (uint32_t)c->b : w->bodies.slot[c->b];
    who[2] = (uint32_t)c->part_a;
    who[3] = c->b >= 0 ? (uint32_t)c->part_b : (uint32_t)c->wall;
    flip = c->b >= 0 && who[0] > who[1];
    for (i = 0; i < 4; i++) h = demi_hash(h, &who[flip ? i ^ 1 : i], sizeof *who);
    h = demi_hash(h, &pushes, sizeof pushes);
    return demi_memory_hash(w, h, c->memory, 1, flip, &i);
}
/* Extends the digest h by all contact histories. It uses the sum of their individual digests, so
   neither the order of contacts matters, nor whether there is a neighbour list. While there is
   none, the histories of sphere pairs are in w->filed, by slot. */
static uint64_t demi_contacts_hash(const dem_world *w, uint64_t h) {
    uint64_t sum = 0;
    int d, k, i;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        for (k = w->stage.list_valid ? demi_near_first(domain)
             : domain->near_end; k < domain->near_end;
             k = demi_near_next(domain, k)) {
            const demi_span span = demi_span_of(w, d, k, 1);
            const size_t at = (size_t)d*span.stride + (size_t)k;
            if (demi_near_remembers(w, d, k))
                sum += demi_pair_digest(w, w->bodies.slot[span.a[0]], w->bodies.slot[span.b[0]],
                                        demi_near_part_key(w, at), span.memory, span.stride);
        }
        for (k = 0; k < domain->persistent; k++)
            sum += demi_persistent_hash(w, demi_persistent_of(w, d) + k);
    }
    for (i = 0; !w->stage.list_valid && w->filed.count && w->filed.stride == w->memory_stride &&
                i < w->filed.rows; i++)
        for (k = w->filed.start[i]; k < w->filed.start[i + 1]; k++) {
            const int32_t p = w->filed.partner[k];
            const uint32_t row = (uint32_t)i, other = (uint32_t)(p < 0 ? ~p : p);
            sum += demi_pair_digest(w, p < 0 ? other : row, p < 0 ? row : other, w->filed.part[k],
                                    w->filed.memory + (size_t)k*(size_t)w->filed.stride, 1);
        }
    return demi_hash(h, &sum, sizeof sum);
}

/* Returns 1 if persistent contact k of domain d touches this wall, otherwise 0. *body receives the
   body of the contact, *normal its unit normal (body to wall), *mu the static friction of that body
   and the wall. */
static int demi_wall_press(const dem_world *w, int d, int k, int wall, int *body, dem_vec3 *normal,
                           dem_real *mu) {
    const demi_persistent *c = demi_persistent_of(w, d) + k;
    *body = c->a;
    *normal = c->normal;
    *mu = demi_static_friction(w, w->bodies.material[c->a] - 1, w->walls[wall].material);
    return c->b < 0 && c->wall == wall && c->overlap > 0;
}
/* The contacts of one grain are adjacent in the list. A grain is stuck if two of its contacts with
   the sieve oppose each other and friction holds both: the components n_xy of their normals in the
   plane of the sieve have a scalar product below -0.25, and both normals lie within the friction
   angle of that plane, |n_z| <= mu |n_xy|. */
DEM_API int dem_sieve_blinded_get(const dem_world *w, dem_wall sieve, dem_real speed) {
    if (demi_null_look(w, __func__, w, "world")) return -1;
    const int id = demi_wall_find((dem_world *)w, __func__, sieve);
    const demi_wall *wall = id < 0 ? 0 : &w->walls[id];
    dem_vec3 across, n, m;
    dem_real mu, mu_m;
    int d, k, j, body, same, count = 0;
    if (!wall) return -1;
    if (!wall->sieve.kind) {
        demi_refuse(w, __func__, "wall %d is not a sieve; pass the id that "
                    "dem_wall_sieve_add returned", (int)sieve.id);
        return -1;
    }
    if (!demi_contacts_known(w)) return demi_list_stale(w, __func__);
    across = demi_v(wall->pose.rotation[2], wall->pose.rotation[5], wall->pose.rotation[8]);
    for (d = 0; d < w->domain_count; d++) {
        const int all = w->domains[d].persistent;
        int last = -1;                          /* the grain counted last: counted only once */
        for (k = 0; k < all; k++) {
            dem_vec3 v, flat;
            dem_real z;
            if (!demi_wall_press(w, d, k, id, &body, &n, &mu) || body == last) continue;
            v = demi_sub(demi_at(w->bodies.vel + 4*body), demi_add(wall->pose.velocity,
                demi_cross(wall->pose.spin, demi_sub(demi_at(w->bodies.pos + 4*body),
                                                     wall->pose.position))));
            z = demi_dot(n, across);
            flat = demi_sub(n, demi_scale(across, z));
            if ((speed > 0 && demi_length(v) > speed) || z*z > mu*mu*(1 - z*z)) continue;
            for (j = k + 1; j < all && last != body; j++) {
                const int here = demi_wall_press(w, d, j, id, &same, &m, &mu_m);
                if (same != body) break;
                z = demi_dot(m, across);
                if (here && z*z <= mu_m*mu_m*(1 - z*z) && demi_dot(flat, m) < DEM_R(-0.25)) {
                    count++;
                    last = body;
                }
            }
        }
    }
    return count;
}

/* The free surface of a heap or of the charge of a drum, as heights over a horizontal grid. Rows
   follow each other in the direction of the slope, a mean grain diameter wide; columns divide each
   row across it. A cell holds the top of its highest grain. */
typedef struct demi_surface {
    /* m, origin; unit vectors: horizontal, across rows (in a drum the direction in which its bottom
       moves); horizontal, along rows (in a drum its axis); against gravity */
    dem_vec3 centre, out, along, up;
    int around;                        /* 1: a heap, rows by distance from the vertical through
                                          `centre`, columns by angle; uses nearest images */
    double width, from;                /* m: of a row; where the first row begins */
    int rows, columns;
    double *top;                       /* rows x columns, m above the lowest grain; < 0: empty */
    int32_t *root, heap;               /* of each body: a body that names its heap, -1: none; the
                                          name of the heaviest heap, the one measured */
} demi_surface;
/* Returns the mean height (m) of a row over its columns that are not empty; -1 if all are. */
static double demi_surface_row(const demi_surface *s, int row) {
    double sum = 0;
    int k, n = 0;
    for (k = 0; k < s->columns; k++) {
        const double top = s->top[row*s->columns + k];
        if (top >= 0) { sum += top; n++; }
    }
    return n ? sum/n : -1;
}
/* Fits a straight line to the heights of rows first .. last - 1 by least squares and writes its
   angle, standard error and number of points. Returns 0 if fewer than four rows have grains. */
static int demi_surface_line(const demi_surface *s, int first, int last, dem_repose *out) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, slope, rest;
    int k;
    for (k = first; k < last; k++) {
        const double h = demi_surface_row(s, k), at = s->from + (k + 0.5)*s->width;
        if (h < 0) continue;
        n++; x += at; y += h; xx += at*at; xy += at*h; yy += h*h;
    }
    if (n < 4) return 0;
    xx -= x*x/n; xy -= x*y/n; yy -= y*y/n;
    slope = xy/xx;
    rest = DEMI_MAX(yy - slope*xy, 0)/(n - 2);
    out->angle = demi_atan2(slope, 1);
    out->error = sqrt(rest/xx)/(1 + slope*slope);
    out->places = (int)n;
    return 1;
}
/* True if grain i, at x, can move and is inside the box; a box of size 0 means everywhere. */
static int demi_repose_sees(const dem_world *w, dem_box b, int i, dem_vec3 x) {
    const dem_vec3 size = demi_sub(b.hi, b.lo);
    if (!(w->bodies.inv_mass[i] > 0)) return 0;
    if (!(demi_dot(size, size) > 0)) return 1;
    return x.x >= b.lo.x && x.x <= b.hi.x && x.y >= b.lo.y && x.y <= b.hi.y && x.z >= b.lo.z &&
        x.z <= b.hi.z;
}
/* Returns the body that names the heap of body i (union-find with path halving). */
static int32_t demi_heap_of(int32_t *root, int32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
}
/* Joins the heap of grain i with those of all grains whose gap to it is below half the mean radius
   of the two, also across periodic faces. tree: the centres of all bodies; most: m, the largest
   radius. */
static void demi_heap_join(const dem_world *w, const demi_tree *tree, int i, double most,
                           int32_t *root) {
    const double r = (double)demi_radius(w, i);
    const demi_periods p = demi_periods_of(w);
    demi_search_line line;
    double x[3];
    int n, k;
    for (n = 0; n < 27; n++) {
        const int s[3] = {n%3 - 1, n/3%3 - 1, n/9 - 1};
        int32_t other, use = 1;
        for (k = 0; k < 3; k++) {
            use = use && (!s[k] || p.period[k] > 0);
            x[k] = tree->x[3*i + k] + s[k]*(double)p.period[k];
        }
        if (!use) continue;
        demi_tree_line(&line, tree, x, x, 1.25*(r + most));
        while ((other = demi_tree_next(&line)) >= 0) {
            const double reach = 1.25*(r + (double)demi_radius(w, other));
            if (root[other] < 0 || !(demi_far2(x, tree->x + 3*other) < reach*reach)) continue;
            other = demi_heap_of(root, other);
            k = demi_heap_of(root, i);
            root[DEMI_MAX(k, other)] = DEMI_MIN(k, other);
        }
    }
}
/* Finds the heaps that the grains in the box form, and the heaviest of them: s->root and s->heap.
   Grains that ran away or fly form small heaps of their own, which are not measured. Returns 0 if
   memory runs out. */
static int demi_heaps(dem_world *w, dem_box box, demi_surface *s) {
    const demi_periods p = demi_periods_of(w);
    const int n = w->bodies.count;
    double *x = (double *)demi_alloc(w, 3*(size_t)n + 1, sizeof *x);
    double *mass = (double *)demi_alloc(w, (size_t)n + 1, sizeof *mass), most = 0;
    demi_tree tree;
    int i, ok;
    memset(&tree, 0, sizeof tree);
    s->root = (int32_t *)demi_alloc(w, (size_t)n + 1, sizeof *s->root);
    for (i = 0; i < n && x && s->root; i++) {
        const dem_vec3 at = demi_place_of(&p, demi_at(w->bodies.pos + 4*i));
        x[3*i] = (double)at.x; x[3*i + 1] = (double)at.y; x[3*i + 2] = (double)at.z;
        s->root[i] = demi_repose_sees(w, box, i, at) ? i : -1;
        most = DEMI_MAX(most, (double)demi_radius(w, i));
    }
    ok = x && mass && s->root && demi_tree_make(w, &tree, x, n);
    for (i = 0; i < n && ok; i++) if (s->root[i] >= 0) demi_heap_join(w, &tree, i, most, s->root);
    for (i = 0; i < n && ok; i++) {
        if (s->root[i] < 0) continue;
        s->root[i] = demi_heap_of(s->root, i);
        mass[s->root[i]] += (double)w->bodies.mass[i];
        s->heap = mass[s->root[i]] > mass[s->heap] ? s->root[i] : s->heap;
    }
    demi_tree_free(w, &tree);
    demi_free(w, x);
    demi_free(w, mass);
    return ok;
}
/* Computes the row and column of grain i, and returns the height of its top above s->centre, m. The
   row is a double, because a grain far away may have a number that no int holds. */
static double demi_surface_place(const dem_world *w, const demi_surface *s, int i, double *row,
                                 int *column) {
    const demi_periods p = demi_periods_of(w);
    const dem_vec3 to = demi_sub(demi_at(w->bodies.pos + 4*i), s->centre);
    const dem_vec3 d = s->around ? demi_nearest(&p, to) : to;
    const double x = (double)demi_dot(d, s->out), y = (double)demi_dot(d, s->along);
    const double far = s->around ? sqrt(x*x + y*y) : x;
    const double n = s->columns, across = floor(y/s->width);
    const double at = s->around ? (demi_atan2(y, x)/(2*DEMI_PI) + 0.5)*n
        : across - n*floor(across/n);
    *row = floor((far - s->from)/s->width);
    *column = DEMI_MIN(DEMI_MAX((int)at, 0), s->columns - 1);
    return (double)demi_dot(d, s->up) + (double)demi_radius(w, i);
}
/* Returns the centre of mass (m) of the heap, also if it extends across periodic faces. Along a
   periodic axis, positions are mapped to a circle; the mean direction on it gives a point in the
   middle of the grains. The centre of mass is then that of the images nearest to this point. */
static dem_vec3 demi_heap_centre(const dem_world *w, const demi_surface *s) {
    const demi_periods p = demi_periods_of(w);
    double mass = 0, mean[3] = {0, 0, 0};
    dem_vec3 sum = demi_v(0, 0, 0), midst;
    int i, k;
    for (k = 0; k < 3; k++) {
        double x = 0, y = 0;
        for (i = 0; i < w->bodies.count && p.period[k] > 0; i++) {
            const double turn = 2*DEMI_PI/(double)p.period[k];
            if (s->root[i] != s->heap) continue;
            x += (double)w->bodies.mass[i]*demi_cos(turn*(double)w->bodies.pos[4*i + k]);
            y += (double)w->bodies.mass[i]*demi_sin(turn*(double)w->bodies.pos[4*i + k]);
        }
        mean[k] = demi_atan2(y, x)*(double)p.period[k]/(2*DEMI_PI);
    }
    midst = demi_v((dem_real)mean[0], (dem_real)mean[1], (dem_real)mean[2]);
    for (i = 0; i < w->bodies.count; i++) {
        const dem_vec3 to = demi_sub(demi_at(w->bodies.pos + 4*i), midst);
        if (s->root[i] != s->heap) continue;
        sum = demi_add(sum, demi_scale(demi_nearest(&p, to), w->bodies.mass[i]));
        mass += (double)w->bodies.mass[i];
    }
    return mass > 0 ? demi_add(midst, demi_scale(sum, (dem_real)(1/mass))) : midst;
}
/* Measures the free surface of the heap: width, rows, columns and heights above its lowest grain.
   Returns 0 if memory runs out. `top` stays null, and there is no surface, if the heap has no
   grains or one of them is 1e5 rows away. */
static int demi_surface_look(dem_world *w, demi_surface *s) {
    double diameter = 0, lowest = 1e300, least = 1e300, most = -1e300, row;
    int i, column, count = 0;
    s->top = 0;
    s->width = 1;
    s->from = 0;
    s->columns = 1;
    for (i = 0; i < w->bodies.count; i++) {
        double h;
        if (s->root[i] != s->heap) continue;
        h = demi_surface_place(w, s, i, &row, &column);
        lowest = DEMI_MIN(lowest, h - 2*(double)demi_radius(w, i));
        diameter += 2*(double)demi_radius(w, i);
        count++;
    }
    if (!count) return 1;
    s->width = diameter/count;                  /* until here rows were 1 m wide */
    for (i = 0; i < w->bodies.count; i++) {
        if (s->root[i] != s->heap) continue;
        demi_surface_place(w, s, i, &row, &column);
        least = DEMI_MIN(least, row);
        most = DEMI_MAX(most, row);
    }
    s->from = least*s->width;
    if (!(most - least < 1e5)) return 1;        /* a grain is too far away: no surface */
    s->rows = (int)(most - least) + 1;
    s->columns = w->desc.planar ? (s->around ? 2 : 1) : s->around ? 12 : 16;
    s->top = (double *)demi_alloc(w, (size_t)s->rows*(size_t)s->columns, sizeof(double));
    if (!s->top) return 0;
    for (i = 0; i < s->rows*s->columns; i++) s->top[i] = -1;
    for (i = 0; i < w->bodies.count; i++) {
        double h, *top;
        if (s->root[i] != s->heap) continue;
        h = demi_surface_place(w, s, i, &row, &column) - lowest;
        if (!(row >= 0 && row < s->rows)) continue;
        top = &s->top[(int)row*s->columns + column];
        *top = DEMI_MAX(*top, h);
    }
    return 1;
}
/* Begins both measurements of an angle of repose: checks gravity and box, sets the directions of
   the surface, and finds the heaps. axis: of a drum; (0, 0, 0) takes any horizontal direction, in a
   planar world z. On an error nothing is left to free. */
static dem_result demi_repose_begin(dem_world *w, const char *call, dem_box box, dem_vec3 axis,
                                    demi_surface *s) {
    const double g = (double)demi_length(w->desc.gravity);
    dem_real R[9];
    memset(s, 0, sizeof *s);
    if (!(g > 0) || demi_box_bad(box, 0))
        return demi_refuse(w, call, "gravity is %g m/s2, must not be 0, because it defines the "
                           "slope; the box must be finite with lo below hi, or both 0", g);
    s->up = demi_scale(w->desc.gravity, (dem_real)(-1/g));
    demi_frame_of(R, s->up);
    s->along = demi_v(R[0], R[3], R[6]);
    if (demi_dot(axis, axis) > 0) {             /* its horizontal part */
        s->along = demi_sub(axis, demi_scale(s->up, demi_dot(axis, s->up)));
        if (!(demi_dot(s->along, s->along) > DEM_R(0.01)*demi_dot(axis, axis)))
            return demi_refuse(w, call, "axis (%g, %g, %g) is vertical, must be horizontal; give "
                               "the axis of rotation of the drum", (double)axis.x, (double)axis.y,
                               (double)axis.z);
        s->along = demi_unit(s->along);
    } else if (w->desc.planar) s->along = demi_v(0, 0, 1);
    s->out = demi_cross(s->up, s->along);       /* motion of the drum at its bottom */
    if (demi_heaps(w, box, s)) return DEM_OK;
    demi_free(w, s->root);
    return demi_no_memory(w, call);
}
/* Ends both measurements: frees the surface and returns the result. good: 1 the line was fitted, 0
   too few points, -1 memory ran out. */
static dem_result demi_repose_end(dem_world *w, const char *call, demi_surface *s, int good) {
    int i, all = 0, heap = 0;
    for (i = 0; i < w->bodies.count; i++) {
        all += s->root[i] >= 0;
        heap += s->root[i] == s->heap;
    }
    if (!good)
        demi_refuse(w, call, "the surface of the heap has %d columns of one mean diameter, too few "
                    "to fit a line, must be some 10; the largest heap has %d of the %d grains: "
                    "check the box, or add grains", s->top ? s->rows : 0, heap, all);
    demi_free(w, s->top);
    demi_free(w, s->root);
    return good > 0 ? DEM_OK : good ? demi_no_memory(w, call) : DEM_ERROR_ARGUMENT;
}
DEM_API dem_result dem_repose_heap_get(const dem_world *world, dem_box box, dem_repose *out) {
    dem_world *w = (dem_world *)world;          /* for error messages and temporary memory */
    demi_surface s;
    double highest = 0;
    dem_result result;
    int i, first, last, good = 0;
    if (demi_null_look(world, __func__, out, "repose")) return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    result = demi_repose_begin(w, __func__, box, demi_v(0, 0, 0), &s);
    if (result != DEM_OK) return result;
    s.centre = demi_heap_centre(w, &s);
    s.around = 1;
    if (!demi_surface_look(w, &s)) good = -1;
    for (i = 0; s.top && i < s.rows; i++) highest = DEMI_MAX(highest, demi_surface_row(&s, i));
    /* outward from the last row above 80 % of the height to the first below 20 % */
    for (first = 0, i = 0; s.top && i < s.rows; i++)
        if (demi_surface_row(&s, i) > 0.8*highest) first = i;
    for (last = first; s.top && last < s.rows; last++)
        if (!(demi_surface_row(&s, last) >= 0.2*highest)) break;
    if (s.top) good = demi_surface_line(&s, first, last, out);
    out->angle = -out->angle;                   /* the slope of a heap falls outward */
    return demi_repose_end(w, __func__, &s, good);
}
DEM_API dem_result dem_repose_drum_get(const dem_world *world, dem_box box, dem_vec3 axis,
                                   dem_repose *out) {
    dem_world *w = (dem_world *)world;
    demi_surface s;
    dem_result result;
    int good = 0;
    if (demi_null_look(world, __func__, out, "repose")) return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    if (!demi_finite3(axis) || !(demi_dot(axis, axis) > 0))
        return demi_refuse(w, __func__, "axis is (%g, %g, %g), must be finite and not zero",
                           (double)axis.x, (double)axis.y, (double)axis.z);
    result = demi_repose_begin(w, __func__, box, axis, &s);
    if (result != DEM_OK) return result;
    if (!demi_surface_look(w, &s)) good = -1;
    if (s.top) good = demi_surface_line(&s, s.rows/4, s.rows - s.rows/4, out);
    return demi_repose_end(w, __func__, &s, good);
}

/* Bodies enter the digest in the order of their slots and contact histories as a sum of individual
   digests, so that it does not depend on the order of bodies or contacts in the arrays. */
DEM_API uint64_t dem_world_hash_get(const dem_world *w) {
    if (demi_null_look(w, __func__, w, "world")) return 0;
    const demi_periods p = demi_periods_of(w);
    uint64_t h = DEMI_HASH_START;
    int i;
    h = demi_hash(h, &w->clock.time, sizeof w->clock.time);
    if (w->cell.on) h = demi_hash(h, w->cell.side, sizeof w->cell.side + sizeof w->cell.offset);
    for (i = 0; i < w->bodies.slot_count; i++) {
        const int b = w->bodies.slot_index[i];
        dem_real x[4];
        if (b < 0) continue;
        /* positions inside the periodic box, where the next rebuild of the list puts them */
        demi_put(x, demi_place_of(&p, demi_at(w->bodies.pos + 4*b)));
        x[3] = demi_radius(w, b);
        h = demi_hash(h, &i, sizeof i);
        h = demi_hash(h, x, sizeof x);
        h = demi_hash(h, w->bodies.vel + 4*b, 3*sizeof(dem_real));
        h = demi_hash(h, w->bodies.spin + 4*b, 3*sizeof(dem_real));
        if (!w->bodies.orienting) continue;
        h = demi_hash(h, w->bodies.orient + 4*b, 4*sizeof(dem_real));
        h = demi_hash(h, w->bodies.angular + 4*b, 3*sizeof(dem_real));
    }
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE) {
            h = demi_hash(h, &w->walls[i].pose.position, sizeof(dem_vec3));
            h = demi_hash(h, w->walls[i].pose.rotation, sizeof w->walls[i].pose.rotation);
        }
    for (i = 0; i < w->joint_count; i++)
        h = demi_hash(h, &w->joints[i].state.force, 2*sizeof(dem_vec3));
    for (i = 0; i < w->feed_count; i++) {
        const demi_feed *f = demi_feed_at(w, i);
        const int64_t next = f->next;
        h = demi_hash(h, &f->random, sizeof f->random);
        h = demi_hash(h, &next, sizeof next);
        h = demi_hash(h, f->state.fed, sizeof f->state.fed);
    }
    for (i = 0; i < w->outlet_count; i++) {
        const dem_outlet_state *o = &demi_outlet_at(w, i)->state;
        h = demi_hash(h, o->count, sizeof o->count);
        h = demi_hash(h, &o->total, sizeof o->total);
    }
    return demi_contacts_hash(w, h);
}

DEM_API dem_world_desc dem_world_desc_get(const dem_world *w) {
    if (!w) return DEM_WORLD_DESC;
    dem_world_desc d = w->desc;
    if (w->clock.dt > 0) d.dt = w->clock.dt;
    d.skin = (dem_real)w->margin.skin;
    return d;
}
