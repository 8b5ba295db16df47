/* ---------------------------------------------------------------------------------------------
   >>rebuild
   Rebuild of the neighbour lists, with everything that depends on them: the laws in force, the
   skin, the order of bodies, work groups and lists. Also inserts single bodies into an existing
   list (demi_list_join). A list contains all pairs with gaps below the skin, so it is valid as long
   as no body has moved farther than half the skin (margin.gone). A wide skin makes lists last
   longer but contain more pairs; demi_skin_choose minimises the total cost. A rebuild that
   fails loses nothing: contact histories are saved by slot (demi_filed), bodies keep their state
   except for their order and periodic image, and the next call tries again.
   --------------------------------------------------------------------------------------------- */

/* Lays out the contact history: as desc says with a user-defined law, the reals of the built-in
   laws one after the other (demi_laws_set), or as the row of the response says. */
static void demi_effects_memory(dem_world *w) {
    const demi_response_kind *response = &demi_response_kinds[w->desc.response];
    demi_laws_set(&w->laws, w->normal, w->effects.tangent, w->effects.rolling, w->effects.sticks,
                  w->effects.twisting);
    if (w->desc.law) {
        w->laws.at_twisting = DEMI_MEMORY;
        w->laws.memory = w->desc.law_memory;
        w->laws.at_sliding = demi_laws_append(&w->laws.memory, w->effects.sticks);
        w->laws.vectors = (1 << 3*w->desc.law_vectors) - 1;
    }
    w->laws.at_grip = demi_laws_append(&w->laws.memory, w->effects.clustered &&
        w->desc.cluster_contacts == DEM_CLUSTER_CONTACTS_MERGED);
    w->memory_stride = response->memory ? response->memory : w->laws.memory;
    w->vector_mask = response->memory ? response->vectors : w->laws.vectors;
}
/* What rubs in some pair of materials that is not ignored: 1 for friction, for rolling friction,
   for static friction above the sliding friction, and for spinning friction, which a user-defined
   law does not have. */
typedef struct demi_rubbing { int friction, rolling, sticks, twisting; } demi_rubbing;
static demi_rubbing demi_pairs_rub(const dem_world *w) {
    demi_rubbing rub = {0, 0, 0, 0};
    int i, j;
    for (i = 0; i < w->material_count; i++)
        for (j = 0; j < w->material_count; j++) {
            const dem_pair *p = &w->pairs[i*DEMI_MATERIALS + j].given;
            if (p->ignored) continue;
            rub.friction |= p->friction > 0 || p->friction_static > 0;
            rub.rolling |= p->rolling_friction > 0;
            rub.sticks |= p->friction_static > p->friction;
            rub.twisting |= p->spinning_friction > 0 && !w->desc.law;
        }
    return rub;
}
/* Returns the largest gap, m, at which a law is called, if the largest radius is `radius`. With
   impulses contacts are found ahead of time: at most one radius and three steps of the points that
   are fastest now, and less in a short period, where a fast partner is found later; at least 0.1
   radii, since lists last while bodies become faster (demi_foreseen: the gap of one step). */
static double demi_reach_of(const dem_world *w, double radius) {
    if (demi_reach_free(w)) {
        const demi_periods p = demi_periods_of(w);
        double seen = DEMI_MIN(demi_three_steps(w), radius);
        int k;
        for (k = 0; k < 3; k++) {
            const double skin = DEMI_MAX((double)w->desc.skin, 0);
            const double room = (double)p.period[k]/2 - 2*radius - skin;
            if (p.period[k] > 0) seen = DEMI_MIN(seen, 0.8*room);
        }
        return DEMI_MAX(0.1*radius, seen);
    }
    return (double)w->desc.law_range + 2*radius*(double)w->desc.law_range_radii;
}
/* True with springs if the scene has a cluster of several spheres or of one off its centre, whether
   or not a body has that shape: all slabs must answer the same. */
static int demi_clustered(const dem_world *w) {
    int k, any = 0;
    for (k = 0; k < w->shape_count; k++) any |= w->shapes[k].count && !w->shapes[k].lone;
    return any && w->bodies.orienting && demi_response_is(w, DEMI_PRESSING);
}
/* Returns the largest speed of the bodies that can move, m/s. */
static double demi_fastest(const dem_world *w) {
    double most = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++)
        if (w->bodies.inv_mass[i] > 0)
            most = DEMI_MAX(most, (double)demi_dot(demi_at(w->bodies.vel + 4*i),
                                                   demi_at(w->bodies.vel + 4*i)));
    return sqrt(most);
}
/* Books the speeds of bodies, which may be new since the last step. */
static void demi_pace_book(dem_world *w) {
    const double fastest = demi_fastest(w);
    dem_real turn = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++) turn = DEMI_MAX(turn, demi_turn_speed(w, i));
    demi_speed_book(w, fastest);
    w->margin.pace = DEMI_MAX(w->margin.pace, fastest + (double)turn);
}
/* Determines the laws in force, the range of radii, and whether all bodies are alike. */
static void demi_effects(dem_world *w) {
    const demi_rubbing rub = demi_pairs_rub(w);
    int i;
    w->effects.sticks = rub.sticks;
    w->effects.twisting = rub.twisting;
    for (i = w->effects.ignoring = 0; i < w->material_count; i++)
        w->effects.ignoring |= demi_ignorers(w, i) != 0;
    w->normal = (int)w->desc.normal_law;
    w->effects.clustered = demi_clustered(w);
    w->effects.tangent = rub.friction ? demi_tangent_meant(w) : DEM_TANGENT_NONE;
    w->effects.rolling = rub.rolling ? demi_rolling_meant(w) : DEM_ROLLING_NONE;
    demi_effects_memory(w);
    w->effects.uniform = w->bodies.count > 0;
    w->effects.fixed_count = 0;
    w->effects.radius_min = w->effects.radius_max = w->bodies.count ? w->bodies.pos[3] : 0;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real r = demi_radius(w, i);
        w->effects.radius_min = DEMI_MIN(w->effects.radius_min, r);
        w->effects.radius_max = DEMI_MAX(w->effects.radius_max, r);
        w->effects.fixed_count += w->bodies.inv_mass[i] <= 0;
        w->effects.uniform &= w->bodies.material[i] == w->bodies.material[0];
    }
    w->effects.tight = w->effects.unlike = 0;
    for (i = 0; i < w->bodies.count && w->bodies.shaped; i++) {
        const demi_shape *shape = demi_shape_of(w, i);
        w->effects.unlike += !demi_lone(w, i);
        w->effects.uniform &= w->bodies.shape[i] == w->bodies.shape[0];
        w->effects.tight |= shape && shape->radius > 2*shape->equal;
    }
    w->effects.uniform = w->effects.uniform && w->effects.radius_max <= w->effects.radius_min &&
        !w->effects.fixed_count && !(w->effects.clustered && w->bodies.shaped);
    if (demi_reach_free(w)) demi_pace_book(w);
    w->margin.reach = demi_reach_of(w, (double)w->effects.radius_max);
    demi_species_count(w);
}

/* Chooses the skin. The cost is estimated from counts, not from time, so that every run makes the
   same choice: 1 for testing a candidate, 40 per body for a search (bench/ measures both). A larger
   skin makes more candidates, which are tested for every pruned list, and fewer searches. */
static void demi_skin_choose(dem_world *w) {
    const double r = (double)(w->effects.radius_min > 0 ? w->effects.radius_min : 1);
    const double steps = (double)(w->clock.steps - w->clock.last_rebuild);
    int k;
    /* the bodies may have been replaced since */
    w->margin.skin_auto = DEMI_MIN(w->margin.skin_auto, 2*r);
    if (w->desc.skin > 0) { w->margin.skin = (double)w->desc.skin; return; }
    if (w->desc.skin < 0) { w->margin.skin = 0; return; }
    if (w->margin.skin_auto <= 0) w->margin.skin_auto = 0.1*r;
    else if (steps > 0 && w->clock.rebuilds > 1 && w->bodies.count > 0) {
        double n = 0, hits = 0, slope, best;
        const double per_step =
            DEMI_MAX(2*w->margin.gone, w->margin.gone + w->margin.walls_gone)/steps;
        const double looks = DEMI_MIN(DEMI_MAX(w->margin.span/(double)w->clock.dt, 1), 100);
        int d;
        for (d = 0; d < w->domain_count; d++) {
            n += w->domains[d].own + w->domains[d].cross;
            hits += w->domains[d].contacts;
        }
        slope = DEMI_MAX((n - hits)/w->bodies.count, 0.02)/w->margin.skin_auto;
        best = sqrt(40*per_step*looks/slope);
        best = DEMI_MIN(DEMI_MAX(best, 0.5*w->margin.skin_auto), 2*w->margin.skin_auto);
        w->margin.skin_auto = DEMI_MIN(DEMI_MAX(sqrt(best*w->margin.skin_auto), 0.01*r), 2*r);
    }
    for (k = 0; k < 3; k++) {  /* a period: at least twice the largest diameter and the skin */
        const double room = (double)demi_periods_of(w).period[k]/2*(1 - 1e-6) -
            2*(double)w->effects.radius_max - w->margin.reach;
        if (w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC && room > 0)
            w->margin.skin_auto = DEMI_MIN(w->margin.skin_auto, room);
    }
    w->margin.skin = w->margin.skin_auto;
}

/* True if user-defined functions act on bodies. */
static int demi_own(const dem_world *w) {
    return w->desc.law || w->desc.body_reals_fn || w->desc.force || w->desc.body_force;
}

/* Returns the number of work groups: 1, 2, 4 or a multiple of 8, which divides evenly among most
   numbers of threads. It depends only on the scene, so bits do not depend on threads. shaped: the
   number of bodies that pairs do not see as lone spheres. Such a body costs about as much as eight
   spheres, so a few thousand need several groups for each thread: where bodies fall, all contacts
   may be in the lowest one. */
static int demi_domains_for(int count, int shaped) {
    const int work = count + 7*shaped;
    int n = 1;
    while (n < 8 && n*DEM_DOMAIN_BODIES < work) n *= 2;
    return n < 8 ? n : DEMI_MIN(DEMI_MAX(work/DEM_DOMAIN_BODIES/8*8, 8), (int)DEMI_DOMAINS);
}

/* Clears a work group that is out of use, because old counts must not influence later choices. Its
   number of persistent contacts stays, because these are still to be moved. */
static void demi_domain_forget(demi_domain *o) {
    const int persistent = o->persistent;
    memset(o, 0, sizeof *o);
    o->persistent = persistent;
}
/* Fails because a body has no valid position: the run blew up earlier and was continued. */
static dem_result demi_lost(dem_world *w, int body) {
    const dem_real *x = w->bodies.pos + 4*body;
    return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its position is "
                     "(%g, %g, %g) m, must be finite and at most %g m from the origin; the run "
                     "blew up earlier (two grains at the same position, dt too large, or a "
                     "user-defined law, field or motion that divides by zero): remove the body, "
                     "or go back to a checkpoint", (unsigned long long)w->clock.steps,
                     (unsigned)w->bodies.slot[body] + 1, (double)x[0], (double)x[1], (double)x[2],
                     DEMI_FARTHEST);
}
/* Fails and returns 1 if a search would take minutes. All bodies of a cell are tested with each
   other, and many share a cell if they lie on each other, or if few far away stretch the grid. */
static int demi_crowd_refuse(dem_world *w) {
    const int32_t *start = w->cell_start;
    const int n = w->cells[0]*w->cells[1]*w->cells[2];
    double work = 0;
    int c, crowd = 0;
    for (c = 0; c < n; c++) {
        const int here = start[c + 1] - start[c];
        work += (double)here*here;
        crowd = DEMI_MAX(crowd, here);
    }
    if (!demi_searches[w->desc.search].crowds || work <= 1e9 + 2e4*w->bodies.count) return 0;
    demi_refuse(w, "dem_world_step", "a search would compare %.2g pairs: %d of %d bodies are in "
                "one cell of %.3g by %.3g by %.3g m; either they lie on each other, or a few "
                "bodies far away stretch the grid: remove those (an outflow boundary does), or "
                "spread the others", work, crowd, w->bodies.count, w->cell_size[0], w->cell_size[1],
                w->cell_size[2]);
    return 1;
}
/* A wall longer than the period does not repeat, so it must extend beyond the box far enough for
   every body in it. Fails and returns 1 if one ends too early. */
static int demi_walls_end(dem_world *w, const char *call) {
    const demi_periods p = demi_periods_of(w);
    const double reach = demi_reach_free(w) ? 0 : w->margin.reach;
    const dem_real need = w->effects.radius_max*DEM_R(0.999) + (dem_real)reach;
    int j, k;
    for (j = 0; j < w->wall_count; j++)
        for (k = 0; k < 3; k++) {
            const demi_wall *wall = &w->walls[j];
            const dem_real lo = p.lo[k], hi = lo + p.period[k];
            if (wall->kind == DEMI_WALL_NONE || wall->extent < 0 || wall->repeats[k] ||
                !(p.period[k] > 0) || !(w->bodies.count > 0) ||
                (wall->span_lo[k] <= lo - need && wall->span_hi[k] >= hi + need)) continue;
            demi_refuse(w, call, "wall %d goes from %g to %g m along periodic axis %d, which is "
                        "longer than the period of %g m, so that it does not repeat; extend it by "
                        "%g m (the largest radius%s) beyond the faces at %g and %g m, or make it "
                        "no longer than the period", (int)wall->id, (double)wall->span_lo[k],
                        (double)wall->span_hi[k], k, (double)p.period[k],
                        (double)w->effects.radius_max + reach,
                        reach > 0 ? " and the law's range" : "", (double)lo, (double)hi);
            return 1;
        }
    return 0;
}
/* --- insertion into an existing list, so that a steady feed does not cause a rebuild for every
       grain. A new sphere belongs to the last work group, and its candidates are appended to the
       lists. Whether there is room depends only on counts and not on what was allocated, because a
       run continued from a checkpoint must do the same. --- */
enum { DEMI_JOIN_MOST = 8192 };                 /* limit of w->join_room */

/* Returns the lists that lack room for join_room more candidates: bits 1 pairs inside, 2 pairs with
   later groups, 4 walls. */
static int demi_join_lack(const dem_world *w) {
    const int last = w->domain_count - 1;
    int d, lack = 0;
    if (!w->join_room) return 0;
    if (w->domains[last].own + w->join_room > w->own.stride) lack = 1;
    for (d = 0; d < last; d++)
        if (w->domains[d].cross + w->join_room > w->cross.stride) lack |= 2;
    return lack | (w->domains[last].walls + w->join_room > w->wall_stride ? 4 : 0);
}
/* True if a sphere may be inserted into the list: not if it would bring in a new effect or species,
   and only if all bodies are spheres. */
static int demi_join_possible(const dem_world *w, int material, dem_real radius) {
    if (!w->stage.list_valid || w->stage.pairs_changed || !w->bodies.count || w->bodies.shaped ||
        w->effects.clustered || w->bodies.ghost) return 0;
    return demi_species_known(w, material, radius);
}
/* True if the two belong in the pruned list, by the test of demi_near_pick. */
static int demi_join_near(const dem_world *w, const demi_periods *p, int a, int b) {
    const dem_vec3 x = demi_nearest(p, demi_sub(demi_at(w->bodies.pos + 4*b),
                                                demi_at(w->bodies.pos + 4*a)));
    const dem_vec3 u = demi_sub(demi_at(w->bodies.vel + 4*b), demi_at(w->bodies.vel + 4*a));
    return demi_length(x) < demi_radius(w, a) + demi_radius(w, b) +
           demi_near_margin(w) + (dem_real)w->margin.span*demi_length(u);
}
/* Inserts body i, just appended, into the list. found: all bodies whose gap to it may be below the
   skin, ascending. Returns 0 if there is no room; then a rebuild is needed. It does not allocate:
   demi_world_put has reserved what it needs, because here running out of memory would look like a
   lack of room. */
static int demi_list_join(dem_world *w, int i, const int32_t *found, int count) {
    const int last = w->domain_count - 1, walls = w->domains[last].walls;
    const demi_periods p = demi_periods_of(w);
    int k, leading = 0;
    w->domains[last].end = i + 1;
    if (demi_response_is(w, DEMI_MIDWAY)) w->margin.gone += w->margin.step_gone/2;
    if (count >= w->join_room || demi_scale_missing(w, i) ||
        demi_radius(w, i) > w->effects.radius_max)
        return 0;
    w->join_room -= count;
    for (k = 0; k < count; k++) {
        const int a = found[k], d = demi_domain_of(w, a);
        demi_domain *domain = &w->domains[d];
        demi_list *list = d == last ? &w->own : &w->cross;
        const int at = d == last ? domain->own : domain->cross;
        list->place[d*list->stride + at] = 0;
        demi_pair_offer(w, d, &p, demi_cover(w), a, i);
        leading |= d < last;
        w->stage.near_stale |= demi_join_near(w, &p, a, i);
    }
    if (leading) demi_cross_index(w);
    demi_body_walls(w, last, i);
    if (w->domains[last].walls - walls >= w->join_room) return 0;
    w->join_room -= w->domains[last].walls - walls;
    if (w->domains[last].walls > walls) w->touching_valid = 0;
    if (w->sheeted) demi_walled_add(w, last*w->wall_stride + walls,
                                    last*w->wall_stride + w->domains[last].walls);
    demi_quiet_at(w, last, i)->restless = 2;
    w->effects.radius_min = DEMI_MIN(w->effects.radius_min, demi_radius(w, i));
    return 1;
}

/* Converts a contact history from the previous laws (was, old) to those in force (now, m): the
   reals of each law that is still in force move to its new position, the others become 0. own:
   number of reals of a user-defined law, which come first; -1: built-in laws. */
static void demi_memory_map(const demi_laws *was, const demi_laws *now, int own,
                            const dem_real *old, dem_real *m) {
    int k;
    for (k = 0; k < now->memory; k++) m[k] = k < own ? old[k] : 0;
    if (was->at_sliding < DEMI_MEMORY && now->at_sliding < DEMI_MEMORY)
        m[now->at_sliding] = old[was->at_sliding];
    if (was->at_twisting < DEMI_MEMORY && now->at_twisting < DEMI_MEMORY)
        m[now->at_twisting] = old[was->at_twisting];
    if (was->at_grip < DEMI_MEMORY && now->at_grip < DEMI_MEMORY)
        m[now->at_grip] = old[was->at_grip];
    if (own >= 0) return;
    for (k = 0; k < now->tangent->memory && was->tangent == now->tangent; k++) m[k] = old[k];
    for (k = 0; k < now->rolling->memory && was->rolling == now->rolling; k++)
        m[now->at_rolling + k] = old[was->at_rolling + k];
    for (k = 0; k < now->normal->memory; k++) m[now->at_normal + k] = old[was->at_normal + k];
}
/* Converts all contact histories, saved ones and those of persistent contacts, while there is no
   list. Returns 0 if memory runs out; then it has changed nothing. */
static int demi_memory_move(dem_world *w, const demi_laws *was) {
    const size_t from = (size_t)w->filed.stride, to = (size_t)w->laws.memory;
    const int own = w->desc.law ? w->desc.law_memory : -1;
    dem_real old[DEMI_MEMORY], *fresh = 0;
    int d, k;
    if (w->filed.stride != was->memory) demi_filed_forget(w);
    if (!DEMI_GROW(w, fresh, (size_t)w->filed.count*to)) return 0;
    for (k = 0; k < w->filed.count; k++)
        demi_memory_map(was, &w->laws, own, w->filed.memory + (size_t)k*from, fresh + (size_t)k*to);
    demi_free(w, w->filed.memory);
    w->filed.memory = fresh;
    w->filed.stride = (int)to;
    for (d = 0; d < DEMI_DOMAINS; d++) {        /* a new slab has contacts, and no work group yet */
        for (k = 0; k < w->domains[d].persistent; k++) {
            demi_persistent *c = demi_persistent_of(w, d) + k;
            memcpy(old, c->memory, sizeof old);
            memset(c->memory, 0, sizeof c->memory);
            demi_memory_map(was, &w->laws, own, old, c->memory);
        }
    }
    return 1;
}
/* Determines the effects of the present scene. If this changes the laws in force, for example
   because friction was added, it converts the contact histories. Returns 0 if memory runs out; then
   the previous laws stay in force. */
static int demi_effects_take(dem_world *w) {
    const demi_laws was = w->laws, *now = &w->laws;
    const int tangent = w->effects.tangent, rolling = w->effects.rolling;
    const int sticks = w->effects.sticks, twisting = w->effects.twisting;
    demi_effects(w);
    if (demi_species_room(w) && (!demi_response_is(w, DEMI_LAWS) || !was.normal ||
        (was.memory == now->memory && was.at_twisting == now->at_twisting &&
         (w->desc.law || (was.tangent == now->tangent && was.rolling == now->rolling))) ||
        demi_memory_move(w, &was))) {
        demi_species_lay(w);
        demi_species_vary(w);
        return 1;
    }
    w->effects.tangent = tangent;
    w->effects.rolling = rolling;
    w->effects.sticks = sticks;
    w->effects.twisting = twisting;
    demi_effects_memory(w);
    return 0;
}
/* Fails and returns 1 if a period is so short that a pair could touch through two images. */
static int demi_periods_refuse(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    const double need = 2*(2*(double)w->effects.radius_max + (double)demi_cover(w));
    int k;
    for (k = 0; k < 3; k++)
        if (w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC && (double)p.period[k] < need) {
            demi_refuse(w, "dem_world_step", "the domain is %g m long on periodic axis %d, must be "
                        "at least %g m (twice the sum of the largest diameter and the skin%s); "
                        "make it longer or the grains smaller", (double)p.period[k], k, need,
                        w->margin.reach > 0 ? " and the law's range" : "");
            return 1;
        }
    return 0;
}
/* Estimates the work of each work group from its bodies, pairs and persistent contacts. Where some
   bodies lie and others fall, few groups have nearly all contacts. The estimate decides which
   thread computes a group, never what is computed. */
static void demi_domains_weigh(dem_world *w) {
    /* a sphere's contact with a wall costs about as much as four pairs of spheres, a pair with a
       body of another shape too, and the contact of such a body more */
    const double persistent = w->effects.unlike ? 16 : 4;
    double work[DEMI_DOMAINS], all = 0, before = 0;
    int d;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *o = &w->domains[d];
        const int pairs = o->near_own + o->near_end - o->near_cross;
        const int shaped = o->near_shaped_end - o->near_shaped;
        work[d] = 1 + o->end - o->begin + pairs + 4.0*shaped + persistent*o->persistent;
        all += work[d];
    }
    for (d = 0; d < w->domain_count; d++) {
        w->domain_middle[d] = (before + work[d]/2)/all;
        before += work[d];
    }
}
/* Divides the sorted bodies among the work groups. */
static void demi_domains_deal(dem_world *w) {
    int d;
    for (d = w->domain_count; d < DEMI_DOMAINS; d++) demi_domain_forget(&w->domains[d]);
    w->domain_count = demi_domains_for(w->bodies.count, w->effects.unlike);
    for (d = 0; d < w->domain_count; d++) {
        w->domains[d].begin = (int)((int64_t)w->bodies.count*d/w->domain_count);
        w->domains[d].end = (int)((int64_t)w->bodies.count*(d + 1)/w->domain_count);
        w->domains[d].overflow = 0;
    }
    demi_domains_weigh(w);
}
/* Returns which of the lists in `lists` (bits 1 own, 2 cross, 4 walls) were too short in some work
   group. */
static int demi_lists_overflow(const dem_world *w, int lists) {
    int d, over = demi_join_lack(w);
    for (d = 0; d < w->domain_count; d++) over |= w->domains[d].overflow;
    return over & lists;
}
/* Finds the candidate pairs and repeats the search with more room until those of every work group
   fit. Returns 0 if memory runs out. */
static int demi_pairs_find(dem_world *w) {
    const int n = w->domain_count, stride = DEMI_MAX(64, w->bodies.count/n*3);
    int over;
    if (demi_searches[w->desc.search].lay && !demi_searches[w->desc.search].lay(w)) return 0;
    w->join_room = w->feed_count ? DEMI_MIN(512 + w->bodies.count/16, DEMI_JOIN_MOST) : 0;
    if (!demi_list_reserve(w, &w->own, n, DEMI_MAX(stride, (int)w->own.stride)) ||
        !demi_list_reserve(w, &w->cross, n, n == 1 ? 0 : DEMI_MAX(stride/4, (int)w->cross.stride)))
        return 0;
    do {
        demi_domains_do(w, demi_domain_search);
        over = demi_lists_overflow(w, 3);
        if ((over & 1 && !demi_list_reserve(w, &w->own, n, w->own.stride/2*3 + 64)) ||
            (over & 2 && !demi_list_reserve(w, &w->cross, n, w->cross.stride/2*3 + 64))) return 0;
    } while (over);
    if (!demi_cross_reserve(w)) return 0;
    demi_cross_index(w);
    return 1;
}
/* The same for wall candidates. */
static int demi_walls_find(dem_world *w) {
    int room = DEMI_MAX(w->wall_stride, 64);
    do {
        if (!demi_wall_lists_reserve(w, room)) return 0;
        demi_domains_do(w, demi_domain_walls);
        room = w->wall_stride/2*3 + 64;
    } while (demi_lists_overflow(w, 4));
    return demi_walled_note(w);
}
/* Moves the persistent contacts to the new lists. Allocates everything first, because the move
   cannot be undone. Returns 0 if memory runs out. */
static int demi_contacts_move(dem_world *w) {
    int first[DEMI_DOMAINS + 1];
    if (!demi_persistent_room(w, first) || !demi_touching_reserve(w)) return 0;
    demi_persistent_move(w, first);
    return 1;
}
/* Makes the slots freed since the last list available again. */
static void demi_slots_release(dem_world *w) {
    while (w->bodies.slot_pending >= 0) {
        const int slot = w->bodies.slot_pending;
        w->bodies.slot_pending = -2 - w->bodies.slot_index[slot];
        w->bodies.slot_index[slot] = -2 - w->bodies.slot_free;
        w->bodies.slot_free = slot;
    }
}
/* Marks the lists as new. */
static void demi_lists_made(dem_world *w) {
    w->margin.gone = w->margin.walls_gone = 0;
    w->clock.last_rebuild = w->clock.steps;
    w->clock.rebuilds++;
    w->stage.list_valid = 1;
    w->flush.valid = 0;
}
/* Rebuilds everything that a step needs to find contacts: makes the checks, sorts the bodies,
   builds the lists and moves the contact histories to them. After DEM_ERROR_MEMORY no body and no
   history is lost, and the next call tries again. */
static dem_result demi_lists_make(dem_world *w, const char *call) {
    double least;
    int k;
    for (k = 0; k < w->bodies.count; k++)
        if (!demi_place(demi_at(w->bodies.pos + 4*k))) return demi_lost(w, k);
    if (!demi_list_drop(w) || !demi_effects_take(w)) return demi_no_memory(w, call);
    if (!w->stage.skin_chosen || w->bodies.ghost) demi_skin_choose(w);
    w->stage.skin_chosen = 1;
    if (demi_periods_refuse(w)) return DEM_ERROR_ARGUMENT;
    demi_walls_repeat(w);
    if (demi_walls_end(w, call)) return DEM_ERROR_ARGUMENT;
    demi_cell_upright(w);
    demi_wrap(w);                               /* after checks, which must not move bodies */
    if (!demi_scales_take(w) || (!w->facets_valid && !demi_surfaces_make(w)))
        return demi_no_memory(w, call);
    demi_levels_choose(w);
    least = 2*(w->levels.wide ? w->levels.fine : (double)w->effects.radius_max) +
        (double)demi_cover(w);
    if (!demi_grid_lay(w, least + 1e-300)) return demi_no_memory(w, call);
    demi_bodies_sort(w);
    if (!w->levels.count && demi_crowd_refuse(w)) return DEM_ERROR_ARGUMENT;
    if (((w->bodies.shaped || w->effects.clustered) && !demi_centres_lay(w)) ||
        (w->levels.count && !demi_levels_lay(w)))
        return demi_no_memory(w, call);
    demi_image_shifts(w);
    demi_domains_deal(w);
    if (!demi_pairs_find(w)) return demi_no_memory(w, call);
    if (!w->stage.near_chosen) demi_near_choose(w);
    w->stage.near_chosen = 1;
    if (!demi_walls_find(w) || !demi_near_make(w, 1) || !demi_contacts_move(w))
        return demi_no_memory(w, call);
    demi_quiet_mark(w);
    demi_slots_release(w);
    demi_filed_forget(w);
    w->stage.skin_chosen = w->stage.near_chosen = 0;
    demi_lists_made(w);
    return DEM_OK;
}
/* Rebuilds the lists. A rebuild that fails restores the number of work groups. */
static dem_result demi_rebuild(dem_world *w, const char *call) {
    const int domains = w->domain_count;
    const dem_result result = demi_lists_make(w, call);
    if (result != DEM_OK) w->domain_count = domains;    /* contacts are still in those */
    return result;
}

/* Rebuilds the lists outside of a step. Contacts of spheres by springs follow from the list; others
   are those of the last forces, which may belong to another scene. */
static dem_result demi_list_make(dem_world *w, const char *call) {
    const dem_result result = demi_rebuild(w, call);
    if (result == DEM_OK && !w->stage.forces_valid &&
        (w->wall_count || w->bodies.shaped || demi_response_is(w, DEMI_MIDWAY)))
        w->stage.list_valid = DEMI_LIST_ALONE;
    return result;
}
/* Fails because the list does not fit the bodies or walls any more. Returns -1. */
static int demi_list_stale(const dem_world *world, const char *call) {
    demi_refuse(world, call, "bodies or walls were added or changed after the last step, so the "
                "contacts are not known; first call dem_world_step, or dem_contacts_each, which "
                "computes them (for dem_candidates_get alone: dem_candidates_rebuild)");
    return -1;
}
DEM_API int dem_candidates_get(const dem_world *w, uint32_t *out, int capacity) {
    if (demi_null_look(w, __func__, w, "world")) return -1;
    int d, l, k, n = 0;
    if (!w->stage.list_valid) return demi_list_stale(w, __func__);
    for (d = 0; d < w->domain_count; d++)
        for (l = 0; l < 2; l++) {
            const demi_list *list = l ? &w->cross : &w->own;
            const int count = l ? w->domains[d].cross : w->domains[d].own;
            for (k = d*list->stride; k < d*list->stride + count; k++, n++) {
                if (n >= capacity || !out) continue;
                out[2*n] = w->bodies.slot[list->a[k]] + 1;
                out[2*n + 1] = w->bodies.slot[list->b[k]] + 1;
            }
        }
    return n;
}
DEM_API dem_result dem_candidates_rebuild(dem_world *w) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    return demi_list_make(w, __func__);
}
