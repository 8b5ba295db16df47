/* ---------------------------------------------------------------------------------------------
   >>restore
   Reading checkpoints, and copying a world. The state is read into a twin, an empty world with the
   same scene. If everything is valid, the twin's state replaces that of the world; until then the
   world does not change. Trials and the report of effects run on twins, too (demi_twin_in_state).

   A matching checksum only shows that a file is as it was written, not that its contents are
   possible. Therefore every count is checked before memory is allocated for it, and every index
   and length before it is used. This part owns demi_reader and writes all of the state.
   --------------------------------------------------------------------------------------------- */
/* Checks a checkpoint being read: its counts, later its values. Returns 0 with an error message. */
static int demi_features_counts(const demi_reader *r) {
    int row, ok = 1;
    for (row = 0; row < DEMI_FEATURES && ok; row++)
        if (demi_features[row].counts) ok = demi_features[row].counts(r);
    return ok;
}
static int demi_features_sane(const demi_reader *r) {
    int row, ok = 1;
    for (row = 0; row < DEMI_FEATURES && ok; row++)
        if (demi_features[row].sane) ok = demi_features[row].sane(r);
    return ok;
}
/* Allocates for what will be read. Returns 0 if memory ran out. */
static int demi_features_room(dem_world *t) {
    int row, ok = 1;
    for (row = 0; row < DEMI_FEATURES && ok; row++)
        if (demi_features[row].room) ok = demi_features[row].room(t);
    return ok;
}

/* Gives the twin its domains and its copies of walls, fields, feeds and outlets, into which state
   is read. Returns 0 if memory ran out. */
static int demi_twin_parts(dem_world *t, const dem_world *w) {
    int i;
    t->domains = (demi_domain *)demi_hold(t, DEMI_RUN, DEMI_DOMAINS, sizeof(demi_domain));
    t->cross_incoming_start = (int *)demi_hold(t, DEMI_RUN, DEMI_DOMAINS + 1, sizeof(int));
    t->fields = (demi_field *)demi_hold(t, DEMI_RUN, (size_t)w->field_count, sizeof(demi_field));
    if (!t->domains || !t->cross_incoming_start || (w->field_count && !t->fields) ||
        !DEMI_COPY(t, t->walls, w->walls, w->wall_count) ||
        !DEMI_COPY(t, t->surfaces, w->surfaces, w->surface_count) ||
        !DEMI_COPY(t, t->feeds, w->feeds, w->feed_count) ||
        !DEMI_COPY(t, t->outlets, w->outlets, w->outlet_count)) return 0;
    t->wall_count = w->wall_count;
    t->surface_count = w->surface_count;
    t->feed_count = w->feed_count;
    t->outlet_count = w->outlet_count;
    t->bodies.zoned = w->bodies.zoned;          /* allocated with the other arrays of bodies */
    t->bodies.aged = w->bodies.aged;
    t->bodies.averaged = w->bodies.averaged;
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &t->fields[i];
        *f = w->fields[i];
        f->sums = (double *)demi_hold(t, DEMI_RUN, demi_field_reals(f), sizeof(double));
        t->field_count = i + 1;
        if (!f->sums) return 0;
    }
    return 1;
}
/* Returns an empty world with the scene of w. It has its own walls, fields, feeds and outlets, and
   shares w's pairs of materials, shapes and geometry of walls. Null if memory ran out. */
static dem_world *demi_twin_make(dem_world *w) {
    dem_world *t = (dem_world *)demi_alloc(w, 1, sizeof *t);
    if (!t) return 0;
    t->look.of = w->look.of ? w->look.of : w;
    t->desc = w->desc;
    t->asked = w->asked;
    demi_names_own(t, &w->asked);
    t->material_count = w->material_count;
    memcpy(t->materials, w->materials, sizeof t->materials);
    t->pairs = w->pairs;
    t->shape_count = w->shape_count;
    t->shapes = w->shapes;
    t->normal = (int)w->desc.normal_law;
    t->bodies.backward = w->bodies.backward;
    t->bodies.booked = w->bodies.booked;
    t->events.desc = w->events.desc;
    t->threads = w->threads;
    if (demi_twin_parts(t, w)) return t;
    demi_free_chain(t, DEMI_RUN);
    demi_free(w, t);
    return 0;
}
static void demi_twin_free(dem_world *w, dem_world *t) {
    demi_free_chain(t, DEMI_RUN);
    demi_free_chain(t, DEMI_SCENE);             /* geometry of walls that it has copied */
    demi_free(w, t);
}
/* Replaces the world's state by the twin's and frees the twin. Error messages, outputs, replays and
   the memory of the scene stay those of the world. */
static void demi_twin_adopt(dem_world *w, dem_world *t) {
    size_t bytes;
    int i;
    for (i = 0; i < w->wall_count; i++)
        if (t->walls[i].kind == DEMI_WALL_NONE) demi_wall_free(w, &w->walls[i]);
    demi_free_chain(w, DEMI_RUN);
    t->chains[DEMI_SCENE] = w->chains[DEMI_SCENE];
    bytes = w->bytes + t->bytes;
    memcpy(t->error, w->error, sizeof t->error);
    memcpy(t->refusal, w->refusal, sizeof t->refusal);
    memcpy(t->refused_calls, w->refused_calls, sizeof t->refused_calls);
    t->refused = w->refused;
    t->look = w->look;
    *w = *t;
    demi_names_point(w);
    w->bytes = bytes;
    demi_free(w, t);
    if (w->look.outputs_again) w->look.outputs_again(w);
}

/* --- reading: are the values possible? Each of these functions checks one part of the twin, right
       after it was read, and returns 0 with an error message if a value is not possible --- */

/* Checks the numbers that are not in arrays. Counts come first: they determine what is allocated
   and read next. */
static int demi_numbers_check(const demi_reader *r) {
    const dem_world *t = r->t, *w = r->w;
    const int tangent = demi_tangent_meant(w), rolling = demi_rolling_meant(w);
    const demi_field_row *bad;
    int k;
    if (!demi_left(r, t->bodies.count, demi_body_size(t)) ||
        !demi_left(r, t->bodies.slot_count, 8) ||
        t->bodies.count > INT_MAX/64 || t->bodies.slot_count > INT_MAX/64 ||
            t->bodies.count > t->bodies.slot_count)
        return demi_lie(r, "number of bodies or slots", -1);
    if (t->domain_count < 0 || t->domain_count > DEMI_DOMAINS ||
        (t->stage.list_valid && (!t->domain_count ||
                               t->domain_count > demi_domains_for(4*t->bodies.count + 16,
                                                                  4*t->bodies.count))) ||
        !demi_left(r, t->domain_count, sizeof(demi_domain)))
        return demi_lie(r, "number of domains", -1);
    if (t->join_room < 0 || t->join_room > DEMI_JOIN_MOST)
        return demi_lie(r, "list capacity", -1);
    if (!demi_left(r, t->joint_count, sizeof(demi_joint)) ||
        (t->joint_count && !demi_response_is(w, DEMI_JOINTED)))
        return demi_lie(r, "number of joints", -1);
    if (!demi_features_counts(r)) return 0;
    if (!demi_left(r, t->written_count, sizeof(demi_written)))
        return demi_lie(r, "number of outputs", -1);
    if ((int)t->desc.search < 0 || (int)t->desc.search >= DEMI_SEARCHES || t->levels.count < 0 ||
        t->levels.count > DEMI_LEVELS || (w->asked.search != DEM_SEARCH_AUTO &&
                                         t->desc.search != w->desc.search))
        return demi_lie(r, "search", -1);
    if (t->bodies.shaped < 0 || t->bodies.shaped > (t->bodies.orienting ? t->bodies.count : 0) ||
        (w->asked.orientations && !t->bodies.orienting))
        return demi_lie(r, "number of bodies that are not spheres", -1);
    if (!demi_left(r, t->filed.count, 4) || t->filed.rows < 0 ||
        t->filed.rows > t->bodies.slot_count ||
        t->filed.stride < 0 || t->filed.stride > DEMI_MEMORY ||
            (t->stage.list_valid && t->filed.count))
        return demi_lie(r, "contact history", -1);
    if (((t->effects.tangent || t->stage.list_valid) && t->effects.tangent != tangent &&
         t->effects.tangent != DEM_TANGENT_NONE) || ((t->effects.rolling || t->stage.list_valid) &&
         t->effects.rolling != rolling && t->effects.rolling != DEM_ROLLING_NONE) ||
             (t->effects.uniform & ~1) || (t->effects.sticks & ~1) ||
             (t->effects.twisting & ~1) || (t->effects.twisting && t->desc.law) ||
             t->effects.clustered < 0 || t->effects.clustered > 1 ||
             /* 0 although there are clusters: their shapes were added after the last rebuild */
             (t->stage.list_valid && t->effects.clustered > demi_clustered(t)) ||
             t->effects.species_count < 0 ||
             t->effects.species_count > (t->effects.uniform ? 1 : DEMI_SPECIES + 1))
        return demi_lie(r, "laws in force", -1);
    for (k = 0; k < t->effects.species_count && k < DEMI_SPECIES; k++)
        if (t->effects.species[k].material < 1 ||
            t->effects.species[k].material > t->material_count)
            return demi_lie(r, "table of species", -1);
    for (k = 0; k < 3; k++)
        if (t->desc.boundary[k] == DEM_BOUNDARY_PERIODIC &&
            !(demi_periods_of(t).period[k] > 0)) return demi_lie(r, "periodic cell", -1);
    bad = demi_rows_bad(w, demi_number_rows, t, &k);
    if (!bad) bad = demi_rows_bad(w, demi_booked_rows, &t->booked, &k);
    if (bad) return demi_lie(r, bad->name, -1);
    if (t->clock.since.steps > t->clock.steps || (t->stage.dt_valid && t->bodies.count &&
         (!(t->clock.dt > 0) || (t->desc.dt > 0 && (t->clock.dt < t->desc.dt ||
                                                    t->clock.dt > t->desc.dt)))))
        return demi_lie(r, "time or time step", -1);
    if (t->bodies.balance.present != (uint64_t)t->bodies.count ||
        t->bodies.balance.inserted != t->bodies.balance.present + t->bodies.balance.removed +
            t->bodies.balance.left)
        return demi_lie(r, "body counts", -1);
    return 1;
}
/* True if the counts of domain d are possible and, with a list, its bodies begin where those of the
   domain before end. The caller reports an error. */
static int demi_domain_check(const demi_reader *r, int d) {
    const dem_world *t = r->t;
    const demi_domain *o = &t->domains[d];
    const int64_t counts[] = {o->own, o->cross, o->walls, o->near_own,
        (int64_t)o->near_end - o->near_cross, (int64_t)o->near_shaped_cross - o->near_shaped,
        (int64_t)o->near_shaped_end - o->near_shaped_cross, o->contacts,
        o->persistent, o->persistent_walls, o->near_cross, o->near_end, o->near_shaped,
        o->near_shaped_cross, o->near_shaped_end};
    const int group = DEMI_LANES;
    size_t i;
    for (i = 0; i < sizeof counts/sizeof *counts; i++)
        if (counts[i] < 0 || counts[i] > INT_MAX/64) return 0;
    if (!demi_left(r, o->persistent, sizeof(demi_persistent)) ||
        (o->persistent && !t->wall_count && !t->bodies.orienting)) return 0;
    if (!t->stage.list_valid) return 1;
    return o->begin == (d ? t->domains[d - 1].end : 0) && o->end >= o->begin &&
           o->end <= t->bodies.count && (d + 1 < t->domain_count || o->end == t->bodies.count) &&
           demi_left(r, o->own, 8) && demi_left(r, o->cross, 8) &&
           demi_left(r, o->walls, 12 + 4*sizeof(dem_real)) &&
           demi_left(r, o->near_shaped_end, 8) &&
           o->near_cross == (o->near_own + group - 1)/group*group &&
           o->near_shaped == (o->near_end + group - 1)/group*group &&
           (t->effects.clustered ||
            (o->near_own + o->near_shaped_cross - o->near_shaped <= o->own &&
             o->near_end - o->near_cross + o->near_shaped_end - o->near_shaped_cross <= o->cross));
}
/* Checks all domains. Without a list, it limits their bodies to those that exist: the next rebuild
   starts from these limits. */
static int demi_domains_check(const demi_reader *r) {
    dem_world *t = r->t;
    int d;
    for (d = 0; d < t->domain_count; d++) {
        demi_domain *o = &t->domains[d];
        if (!demi_domain_check(r, d)) return demi_lie(r, "counts of domain", d);
        o->overflow = o->coefs = 0;
        if (t->stage.list_valid) continue;
        /* left from a list that no longer fits */
        o->begin = DEMI_MIN(DEMI_MAX(o->begin, 0), t->bodies.count);
        o->end = DEMI_MIN(DEMI_MAX(o->end, o->begin), t->bodies.count);
    }
    return 1;
}
/* Checks that each body and its slot refer to each other, and that every other slot is in one of
   the two chains of free slots, once. seen: slot_count bytes, all zero. */
static int demi_slots_check(const demi_reader *r, unsigned char *seen) {
    const dem_world *t = r->t;
    int i, chain, left = t->bodies.slot_count - t->bodies.count;
    for (i = 0; i < t->bodies.count; i++) {
        const uint32_t slot = t->bodies.slot[i];
        if (slot >= (uint32_t)t->bodies.slot_count || t->bodies.slot_index[slot] != i)
            return demi_lie(r, "slot of body", i);
    }
    for (chain = 0; chain < 2; chain++) {
        int slot = chain ? t->bodies.slot_pending : t->bodies.slot_free;
        while (slot != -1) {
            if (slot < 0 || slot >= t->bodies.slot_count || seen[slot]++ ||
                t->bodies.slot_index[slot] >= 0 ||
                t->bodies.slot_index[slot] < -2 - t->bodies.slot_count || !left--)
                return demi_lie(r, "chain of free slots", -1);
            slot = -2 - t->bodies.slot_index[slot];
        }
    }
    return left == 0 ? 1 : demi_lie(r, "number of free slots", -1);
}
/* Returns the squared norm of a quaternion. */
static dem_real demi_quat_size2(const dem_real *q) {
    return q[0]*q[0] + q[1]*q[1] + q[2]*q[2] + q[3]*q[3];
}
/* Checks the state of all bodies: finite, positive where it must be, with materials and shapes that
   exist. */
static int demi_bodies_sane(const demi_reader *r) {
    const dem_world *t = r->t;
    const int lost = demi_body_lost(t);
    int i, k, shaped = 0, unlike = 0;
    if (lost >= 0) return demi_lie(r, "state of body", lost);
    for (i = 0; i < t->bodies.count; i++) {
        if (!(demi_radius(t, i) > 0) ||
            !demi_sane((double)t->bodies.mass[i], 0) || !(t->bodies.mass[i] > 0) ||
            !demi_sane((double)t->bodies.inv_mass[i], 0) ||
                !demi_sane((double)t->bodies.inv_inertia[i], 0))
            return demi_lie(r, "position, radius or mass of body", i);
        if (t->bodies.material[i] < 1 || t->bodies.material[i] > t->material_count)
            return demi_lie(r, "material of body", i);
        if (!t->bodies.orienting) continue;
        if (t->bodies.shape[i] < 0 || t->bodies.shape[i] > t->shape_count)
            return demi_lie(r, "shape of body", i);
        if (!(demi_quat_size2(t->bodies.orient + 4*i) > DEM_R(0.98)) ||
            !(demi_quat_size2(t->bodies.orient + 4*i) < DEM_R(1.02)))
            return demi_lie(r, "orientation of body", i);
        if (!t->bodies.shape[i]) continue;
        shaped++;
        unlike += !demi_lone(t, i);
        for (k = 0; k < 3; k++)
            if (!(t->bodies.moment[4*i + k] > 0)) return demi_lie(r, "inertia of body", i);
    }
    return shaped == t->bodies.shaped && (!t->stage.list_valid || unlike == t->effects.unlike)
        ? 1 : demi_lie(r, "number of shaped bodies", -1);
}
/* True if the spheres of entry `at` of the pruned list belong to its bodies. */
static int demi_balls_own(const dem_world *t, int at) {
    const int32_t *start = t->bodies.centre_start;
    const int a = t->near.a[at], b = t->near.b[at];
    return !t->effects.clustered ||
        (t->near.ball_a[at] >= start[a] && t->near.ball_a[at] < start[a + 1] &&
         t->near.ball_b[at] >= start[b] && t->near.ball_b[at] < start[b + 1]);
}
/* Checks the pairs begin .. end - 1 in the pruned neighbour list of domain d. Their candidates must
   be among the `count` candidates of this list, and ascend. With clusters, pairs of two lone
   spheres come first; candidates ascend among them and, from the beginning again, among the others.
   With shaped = 0 all pairs must be of two spheres of known species; with shaped = 1 no pair may be
   of two spheres. Then it makes k the index of the candidate in the list of all domains. */
static int demi_near_check(const demi_reader *r, int d, const demi_list *list, int count, int begin,
                           int end, int shaped) {
    dem_world *t = r->t;
    const int first = d*list->stride;
    int p, last = -1, lone = t->effects.clustered && !shaped;
    for (p = begin; p < end; p++) {
        const int at = d*t->near.stride + p, k = t->near.k[at];
        if (k < 0 || k >= count) return demi_lie(r, "neighbour pair of domain", d);
        if (lone && !(demi_lone(t, list->a[first + k]) && demi_lone(t, list->b[first + k]))) {
            lone = 0;
            last = -1;
        }
        if (k < last || (k == last && (shaped || !t->effects.clustered)) || k >= count ||
            t->near.a[at] != list->a[first + k] || t->near.b[at] != list->b[first + k] ||
            shaped == demi_pair_of_balls(t, t->near.a[at], t->near.b[at]) ||
            (!shaped && (!demi_balls_own(t, at) || !demi_species_has(t, (size_t)at))))
            return demi_lie(r, "neighbour pair of domain", d);
        last = k;
        t->near.k[at] = first + k;
    }
    return 1;
}
/* Checks every index in the lists. A candidate pair must belong to the domain of its lower body,
   pairs of the pruned list must be candidates, and walls and elements must exist. Steps use these
   indices without further checks. */
static int demi_lists_check(const demi_reader *r) {
    dem_world *t = r->t;
    int d, l, k;
    for (d = 0; d < t->domain_count && t->stage.list_valid; d++) {
        const demi_domain *o = &t->domains[d];
        for (l = 0; l < 2; l++) {
            const demi_list *list = l ? &t->cross : &t->own;
            const int count = l ? o->cross : o->own, first = d*list->stride;
            for (k = first; k < first + count; k++) {
                const int a = list->a[k], b = list->b[k];
                if (a < o->begin || a >= o->end || b <= a || b >= t->bodies.count ||
                    (b >= o->end) != l)
                    return demi_lie(r, "candidate pair of domain", d);
            }
            if (!demi_near_check(r, d, list, count, l ? o->near_cross : 0,
                                 l ? o->near_end : o->near_own, 0) ||
                !demi_near_check(r, d, list, count, l ? o->near_shaped_cross : o->near_shaped,
                                 l ? o->near_shaped_end : o->near_shaped_cross, 1)) return 0;
        }
        for (k = d*t->wall_stride; k < d*t->wall_stride + o->walls; k++) {
            const int wall = t->wall_id[k], body = t->wall_body[k];
            if (body < o->begin || body >= o->end || wall < 0 ||
                wall >= t->wall_count + t->surface_count ||
                demi_surface_of(t, wall)->kind == DEMI_WALL_NONE || t->wall_element[k] < 0 ||
                t->wall_element[k] >= demi_surface_of(t, wall)->element_count ||
                !demi_finite3(demi_at(t->wall_shift + 3*(size_t)k)) ||
                (k > d*t->wall_stride && body < t->wall_body[k - 1]))
                return demi_lie(r, "wall candidate of domain", d);
        }
    }
    return 1;
}
/* Checks persistent contacts, which refer to bodies by index, or by slot while there is no list,
   and the contact history of spheres that is saved by slot. */
static int demi_contacts_check(const demi_reader *r) {
    const dem_world *t = r->t;
    const int who = t->stage.list_valid ? t->bodies.count : t->bodies.slot_count;
    int d, k;
    for (d = 0; d < t->domain_count; d++) {
        for (k = 0; k < t->domains[d].persistent; k++) {
            const demi_persistent *c = demi_persistent_of(t, d) + k;
            if (c->a < 0 || c->a >= who || c->b < -1 || c->b >= who || !demi_finite3(c->shift) ||
                (c->b >= 0 && !t->bodies.orienting) ||
                    (c->b < 0 && (c->wall < 0 || c->wall >= t->wall_count ||
                 (t->stage.list_valid && t->walls[c->wall].kind == DEMI_WALL_NONE))))
                return demi_lie(r, "contact of domain", d);
        }
    }
    if (t->stage.list_valid || !t->filed.count) return 1;
    for (k = 0; k <= t->filed.rows; k++)
        if (t->filed.start[k] < (k ? t->filed.start[k - 1] : 0) ||
            t->filed.start[k] > t->filed.count || (!k && t->filed.start[k]))
            return demi_lie(r, "contact history of slot", k);
    if (t->filed.start[t->filed.rows] != t->filed.count)
        return demi_lie(r, "contact history of slot", t->filed.rows);
    for (k = 0; k < t->filed.count; k++) {
        const int32_t p = t->filed.partner[k], other = p < 0 ? ~p : p;
        if (other >= t->bodies.slot_count || t->filed.part[k] < 0)
            return demi_lie(r, "partner in the contact history, entry", k);
    }
    return 1;
}
/* Checks walls: poses must be possible, and motions must be finite and of the kind that the scene
   has. */
static int demi_walls_check(const demi_reader *r) {
    int i, k;
    for (i = 0; i < r->t->wall_count; i++) {
        const demi_wall *wall = &r->t->walls[i], *own = &r->w->walls[i];
        const dem_motion *m = &wall->motion;
        if (wall->kind == DEMI_WALL_NONE) continue;
        if (!demi_pose_sane(&wall->home) || !demi_pose_sane(&wall->pose) ||
            !demi_pose_sane(&wall->mid) || !demi_pose_sane(&wall->ahead) ||
            !demi_pose_sane(&wall->was))
            return demi_lie(r, "pose of wall", i);
        if (m->kind != own->motion.kind || demi_rows_bad(r->w, demi_motion_rows, m, &k) ||
            demi_rows_bad(r->w, demi_servo_rows, &wall->servo, &k) ||
            (wall->idle && !(wall->idle == 1 && demi_wall_waits(wall, r->t->clock.time))))
            return demi_lie(r, "motion of wall", i);
        if (!demi_place(wall->glide) || wall->glides != (demi_dot(wall->glide, wall->glide) > 0))
            return demi_lie(r, "surface velocity of wall", i);
    }
    return 1;
}
/* Checks ages and averages. */
static int demi_ages_check(const demi_reader *r) {
    const demi_bodies *b = &r->t->bodies;
    int i, k;
    for (i = 0; i < b->count; i++) {
        double sum = b->aged ? fabs(b->born[i]) : 0;
        for (k = 0; k < DEMI_MEANS && b->averaged; k++) sum += fabs(b->means[DEMI_MEANS*i + k]);
        if (!demi_finite_double(sum) || (b->averaged && !(b->means[DEMI_MEANS*i] >= 0 &&
            b->means[DEMI_MEANS*i] < 9e15))) return demi_lie(r, "age or averages of body", i);
    }
    return 1;
}

/* Checks the records of outputs: numbers must be within their range and times finite. */
static int demi_outputs_check(const demi_reader *r) {
    int i;
    for (i = 0; i < r->t->written_count; i++) {
        const demi_written *o = &r->t->written[i];
        if (o->next < DEMI_OUTPUT_UNKNOWN || (double)o->next > DEMI_OUTPUT_MOST ||
            !demi_finite_double(o->last)) return demi_lie(r, "state of output", i);
    }
    return 1;
}

/* --- reading: memory, and values that follow from the state --- */

/* Allocates the arrays of bodies as if the bodies were added. Returns 0 if memory ran out. */
static int demi_twin_bodies_room(dem_world *t) {
    const int orienting = t->bodies.orienting, count = t->bodies.count,
        slots = t->bodies.slot_count;
    int ok;
    /* there are no elements yet that growing must preserve */
    t->bodies.orienting = t->bodies.count = t->bodies.slot_count = 0;
    ok = demi_bodies_reserve(t, (size_t)slots) && (!orienting || demi_orient_begin(t));
    t->bodies.count = count;
    t->bodies.slot_count = slots;
    return ok;
}
/* Allocates the lists. Each domain gets as many entries as the largest domain needs, and at least
   as many as a rebuild would allocate. Returns 0 if memory ran out. */
static int demi_twin_lists_room(dem_world *t) {
    int most[5] = {0, 0, 0, 0, 0}, crowd[DEMI_DOMAINS], d, k;
    const int each = t->domain_count ? t->bodies.count/t->domain_count : 0;
    memset(crowd, 0, sizeof crowd);
    for (d = 0; d < t->domain_count; d++) {
        const demi_domain *o = &t->domains[d];
        const int counts[] = {t->stage.list_valid ? o->own : 0, t->stage.list_valid ? o->cross : 0,
                              t->stage.list_valid ? o->near_shaped_end : 0, t->stage.list_valid
                                  ? o->walls : 0, t->domain_count > 1};
        for (k = 0; k < 5; k++) most[k] = DEMI_MAX(most[k], counts[k]);
        crowd[d] = o->persistent;
    }
    if (t->stage.list_valid) {
        most[0] = DEMI_MAX(most[0], DEMI_MAX(64, each*3));
        most[1] = DEMI_MAX(most[1], most[4] ? DEMI_MAX(64, each*3)/4 : 0);
        most[2] = DEMI_MAX(most[2], DEMI_MAX(64, each*5/2));
        most[3] = DEMI_MAX(most[3], 64);
    }
    for (k = 0; k < 4; k++) if (k != 2) most[k] += t->join_room;
    most[2] = (most[2] + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES + DEMI_LANES;
    demi_persistent_lay(t, t->stage.list_valid ? t->domain_count : 0, crowd, t->persistent_first);
    if (!demi_wall_sums_room(t) ||
        !DEMI_GROW(t, t->persistent_now, (size_t)t->persistent_first[DEMI_DOMAINS]) ||
        !DEMI_GROW(t, t->persistent_next, (size_t)t->persistent_first[DEMI_DOMAINS]) ||
        !DEMI_GROW(t, t->coefs, 2*(size_t)t->persistent_first[DEMI_DOMAINS]) ||
        !demi_carry_reserve(t, t->filed.rows, t->filed.count, t->filed.stride)) return 0;
    return !t->stage.list_valid ||
           (demi_list_reserve(t, &t->own, t->domain_count, most[0]) &&
            demi_list_reserve(t, &t->cross, t->domain_count, most[1]) &&
            demi_species_room(t) &&
            demi_near_reserve(t, &t->near, t->domain_count, most[2]) &&
            demi_cross_reserve(t) &&
            demi_wall_lists_reserve(t, most[3]) &&
            demi_quiet_reserve(t, t->bodies.count));
}
/* Computes what follows from the state and is not stored. Returns 0 if memory ran out. */
static int demi_twin_follow(dem_world *t) {
    const demi_periods p = demi_periods_of(t);
    int d, k, l;
    demi_image_shifts(t);
    demi_walls_repeat(t);
    for (k = 0; k < t->wall_count; k++) t->walls[k].symmetric = demi_wall_symmetric(&t->walls[k]);
    if (!t->stage.list_valid) return 1;
    if (!demi_walled_note(t)) return 0;
    if (!t->stage.pairs_changed) demi_species_lay(t);
    demi_species_vary(t);
    for (d = 0; d < t->domain_count; d++) {
        const demi_domain *o = &t->domains[d];
        const int first = d*t->near.stride;
        int run = 0;
        t->domains[d].merging = 0;
        for (l = 0; l < 2; l++) {
            demi_list *list = l ? &t->cross : &t->own;
            const int begin = d*list->stride, count = l ? o->cross : o->own;
            for (k = begin; k < begin + count; k++)
                list->image[k] = demi_pair_image(t, &p, list->a[k], list->b[k]);
        }
        for (k = demi_near_first(o); k < o->near_end; k = demi_near_next(o, k)) {
            const int a = t->near.a[first + k], b = t->near.b[first + k];
            t->near.image[first + k] = demi_pair_image(t, &p, a, b);
            if (t->effects.clustered) t->near.on[first + k] = 1;
            run = k && k != o->near_cross && t->near.k[first + k] == t->near.k[first + k - 1]
                ? run + 1 : 1;
            if (t->effects.clustered)
                t->domains[d].merging = DEMI_MAX(t->domains[d].merging, run);
            if (!t->effects.uniform && !(t->stage.pairs_changed && demi_many_species(t)))
                demi_near_coefs(t, &t->near, d, k);
        }
        for (k = o->near_shaped; k < o->near_shaped_end; k++)
            t->near.image[first + k] = demi_pair_image(t, &p, t->near.a[first + k],
                                                       t->near.b[first + k]);
        demi_near_adopt(t, d);
    }
    if (!demi_merging_reserve(t)) return 0;
    t->touching_valid = 0;
    demi_cross_index(t);
    demi_domains_weigh(t);
    demi_quiet_mark(t);
    return 1;
}

/* Reads the state into the twin, in the order of demi_visit_state, and checks it. If it returns
   DEM_ERROR_MEMORY, the caller provides the error message. *seen is for the caller to free. */
static dem_result demi_twin_read(demi_reader *r, unsigned char **seen) {
    dem_world *t = r->t;
    demi_stream *s = &r->s;
    demi_visit_numbers(t, s);
    if (s->cut) demi_lie(r, "length", -1);
    if (s->cut || !demi_numbers_check(r)) return DEM_ERROR_FORMAT;
    demi_effects_memory(t);
    demi_visit(s, t->domains, (size_t)t->domain_count*sizeof(demi_domain));
    if (!demi_domains_check(r)) return DEM_ERROR_FORMAT;
    *seen = (unsigned char *)demi_alloc(t, (size_t)t->bodies.slot_count + 1, 1);
    if (!*seen || !demi_twin_bodies_room(t) || !demi_twin_lists_room(t) ||
        !demi_features_room(t) || !DEMI_GROW(t, t->written, (size_t)t->written_count))
        return DEM_ERROR_MEMORY;
    demi_visit_bodies(t, s);
    if (!demi_slots_check(r, *seen) || !demi_bodies_sane(r)) return DEM_ERROR_FORMAT;
    demi_visit_lists(t, s);
    demi_visit_contacts(t, s);
    demi_visit_walls(t, s);
    DEMI_ALL_FEATURES(visit, (t, s))
    demi_visit_outputs(t, s);
    if (s->cut || s->left) demi_lie(r, "length", -1);
    if (s->cut || s->left || !demi_walls_check(r) || !demi_ages_check(r) ||
        !demi_features_sane(r) || !demi_outputs_check(r)) return DEM_ERROR_FORMAT;
    DEMI_ALL_FEATURES(resumed, (t))
    if (!t->facets_valid && !demi_surfaces_make(t)) return DEM_ERROR_MEMORY;
    if (t->stage.list_valid && (t->bodies.shaped || t->effects.clustered) && !demi_centres_lay(t))
        return DEM_ERROR_MEMORY;
    if (!demi_lists_check(r) || !demi_contacts_check(r)) return DEM_ERROR_FORMAT;
    return demi_twin_follow(t) ? DEM_OK : DEM_ERROR_MEMORY;
}
/* Changes the twin before the world takes over its state. If it returns DEM_ERROR_MEMORY, the
   caller provides the error message. */
typedef dem_result (*demi_adapt_fn)(dem_world *twin, void *how);
/* Reads a checkpoint of `size` bytes in memory into the world; adapt: null, or what changes it. */
static dem_result demi_checkpoint_parse(dem_world *w, const char *path, const char *data,
                                        size_t size, demi_adapt_fn adapt, void *how) {
    demi_checkpoint_head head;
    demi_reader r;
    unsigned char *seen = 0;
    dem_result result = demi_checkpoint_check(w, path, data, size, &head);
    if (result != DEM_OK) return result;
    memset(&r, 0, sizeof r);
    r.w = w;
    r.path = path;
    r.s.from = data + sizeof head;
    r.s.left = (size_t)head.body_size;
    r.t = demi_twin_make(w);
    if (!r.t) return demi_no_memory(w, "dem_checkpoint_read");
    result = demi_checkpoint_scene(w, r.t, path, &r.s, head.parts);
    demi_facets_outdated(w);                    /* the twin computes the weights of shared walls */
    if (result == DEM_OK) result = demi_twin_read(&r, &seen);
    demi_free(r.t, seen);
    if (result == DEM_OK && adapt) result = adapt(r.t, how);
    if (result == DEM_OK) {
        const int recording = w->events.n.on;
        demi_twin_adopt(w, r.t);
        if (recording && !w->events.n.on) demi_events_start(w);
        return DEM_OK;
    }
    demi_twin_free(w, r.t);
    return result == DEM_ERROR_MEMORY ? demi_no_memory(w, "dem_checkpoint_read") : result;
}
/* Returns the state as a checkpoint would store it, so that a copy equals a restart. *size receives
   its length in bytes. The caller frees it. Null if memory ran out. */
static char *demi_state_keep(dem_world *w, size_t *size) {
    dem_world look = *w;
    demi_stream s = {0, 0, 0, 0, 0, 0, 0};
    char *bytes;
    demi_filed_current(w, &look.filed);
    demi_visit_state(&look, &s);
    *size = s.size;
    bytes = (char *)demi_alloc(w, s.size + 1, 1);
    s.to = bytes;
    if (bytes) demi_visit_state(&look, &s);
    return bytes;
}
/* Returns a copy of w in the state that demi_state_keep has stored, for trials. It shares w's
   shapes and geometry of walls, for which w->facets_valid must hold, and owns everything else. Null
   if memory ran out or the state is not valid. */
static dem_world *demi_twin_in_state(dem_world *w, const char *bytes, size_t size) {
    demi_reader r;
    unsigned char *seen = 0;
    dem_result result;
    memset(&r, 0, sizeof r);
    r.w = w;
    r.path = "a copy of the world";
    r.s.from = bytes;
    r.s.left = size;
    r.t = demi_twin_make(w);
    if (!r.t) return 0;
    r.t->pairs = (demi_pair *)demi_hold(r.t, DEMI_RUN, (size_t)DEMI_MATERIALS*DEMI_MATERIALS,
                                        sizeof(demi_pair));
    if (r.t->pairs)
        memcpy(r.t->pairs, w->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair));
    r.t->facets_valid = 1;
    r.t->sheeted = w->sheeted;
    memset(&r.t->events.desc, 0, sizeof r.t->events.desc);  /* events of a copy are nobody's */
    result = r.t->pairs ? demi_twin_read(&r, &seen) : DEM_ERROR_MEMORY;
    demi_free(r.t, seen);
    if (result == DEM_OK) return r.t;
    demi_twin_free(w, r.t);
    return 0;
}

DEM_API dem_result dem_checkpoint_read(dem_world *w, const char *path) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    char *bytes = 0;
    size_t size = 0;
    dem_result result = demi_load(w, __func__, path, &bytes, &size);
    if (result == DEM_OK)
        result = demi_checkpoint_parse(w, path, bytes, size, 0, 0);
    demi_free(w, bytes);
    return result;
}
