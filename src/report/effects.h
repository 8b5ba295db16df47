/* ---------------------------------------------------------------------------------------------
   >>effects
   Effects: the laws and features that a scene may use (friction, walls, ledger, ...), one row each.
   A row says whether the scene uses the effect and whether it has happened so far, and how to
   switch it off in a copy of the world. The cost of an effect is measured on two copies, with and
   without it. They are timed in turn, so that disturbances by other programs affect both alike.
   All this happens on copies. A measurement changes the world itself only as the start of a run
   would: it settles the time step and the weights of facets.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_EFFECT_TURNS = 41, DEMI_EFFECT_STEPS = 24 };
/* Returns the state of an effect. Also writes e->text (what acts, or why nothing does) and
   e->missing (how many pairs of materials, walls and the like have the effect but have not been
   touched). */
typedef dem_effect_state (*demi_look_fn)(const dem_world *w, dem_effect *e);

/* Writes e->text. Returns the state of an effect that the scene contains: active if it has
   happened, else idle. */
DEMI_FORMAT(3, 4) static dem_effect_state demi_say(dem_effect *e, int happened, const char *format,
                                                   ...) {
    va_list arguments;
    va_start(arguments, format);
    demi_words_of(e->text, sizeof e->text, format, arguments);
    va_end(arguments);
    return happened ? DEM_EFFECT_ACTIVE : DEM_EFFECT_IDLE;
}
/* Writes e->text for an effect that the scene does not contain, and returns that state. */
static dem_effect_state demi_look_off(dem_effect *e, const char *why) {
    demi_say(e, 0, "%s", why);
    return DEM_EFFECT_OFF;
}
/* True if materials i and j have touched so far. */
DEM_INLINE int demi_met(const dem_world *w, int i, int j) {
    return (int)(w->booked.met[DEMI_MIN(i, j)] >> DEMI_MAX(i, j) & 1);
}
/* State of an effect that is a property of pairs of materials. `of` returns the property, > 0 if
   the pair has the effect. Off if no pair has it, idle if none of those that have it has touched
   so far, otherwise active. missing counts pairs that could touch and have not. what: begins
   e->text. */
static dem_effect_state demi_look_pairs(const dem_world *w, dem_real (*of)(const dem_pair *p),
                                        const char *what, dem_effect *e) {
    int i, j, have = 0, possible = 0, met = 0, first = 0, second = 0;
    uint64_t grains, walls;
    demi_made_of(w, &grains, &walls);
    for (i = 0; i < w->material_count; i++)
        for (j = i; j < w->material_count; j++) {
            const int a = (int)(grains >> i & 1), b = (int)(grains >> j & 1);
            if (!(of(&w->pairs[i*DEMI_MATERIALS + j].given) > 0) || demi_ignores(w, i, j)) continue;
            have++;
            if (!(a && (b || walls >> j & 1)) && !(b && walls >> i & 1)) continue;
            possible++;
            if (demi_met(w, i, j)) { met++; continue; }
            first = i + 1;
            second = j + 1;
        }
    e->missing = possible - met;
    if (!have) return demi_look_off(e, "no pair of materials has it");
    if (!possible) return demi_say(e, 0, "%s; no two materials that can touch have it", what);
    if (met == possible) return demi_say(e, 1, "%s", what);
    if (first == second)
        return demi_say(e, met, "%s; material %d has not touched itself so far", what, first);
    return demi_say(e, met, "%s; materials %d and %d have not touched so far", what, first, second);
}
/* Properties of pairs, for `of` above. */
static dem_real demi_any(const dem_pair *p) { (void)p; return 1; }
static dem_real demi_rubs(const dem_pair *p) { return DEMI_MAX(p->friction, p->friction_static); }
static dem_real demi_rolls(const dem_pair *p) { return p->rolling_friction; }
static dem_real demi_sticks(const dem_pair *p) { return p->stiffness_adhesion; }
static dem_real demi_coheres(const dem_pair *p) { return p->cohesion; }

/* State of an effect of contacts. name: the built-in law with this effect, or null; `none` then
   says why no law has it. Impulses have no laws and always have the effect; a user-defined law
   replaces it. */
static dem_effect_state demi_look_response(const dem_world *w, dem_real (*of)(const dem_pair *),
                                           const char *name, const char *none, dem_effect *e) {
    if (w->desc.law) return demi_look_off(e, "left to the user-defined law");
    if (!demi_laws_keep(w)) name = demi_response_kinds[w->desc.response].name;
    return name ? demi_look_pairs(w, of, name, e) : demi_look_off(e, none);
}
static dem_effect_state demi_look_contacts(const dem_world *w, dem_effect *e) {
    return demi_look_response(w, demi_any, demi_normal_laws[w->desc.normal_law].name, "", e);
}
static dem_effect_state demi_look_law(const dem_world *w, dem_effect *e) {
    if (!w->desc.law) return demi_look_off(e, "desc.law is null");
    return demi_look_pairs(w, demi_any, "replaces the built-in laws", e);
}
static dem_effect_state demi_look_friction(const dem_world *w, dem_effect *e) {
    const int law = demi_tangent_meant(w);
    return demi_look_response(w, demi_rubs, law == DEM_TANGENT_NONE ? 0
                              : demi_tangent_laws[law].name, "tangent_law is DEM_TANGENT_NONE", e);
}
static dem_effect_state demi_look_rolling(const dem_world *w, dem_effect *e) {
    const int law = demi_rolling_meant(w);
    int i;
    for (i = 0; i < w->material_count; i++) {
        const char *lacks = demi_law_lacks(w, i);
        if (!lacks) continue;
        demi_say(e, 0, "desc.law ignores the %s of material %d", lacks, i + 1);
        return DEM_EFFECT_OFF;
    }
    return demi_look_response(w, demi_rolls, law == DEM_ROLLING_NONE ? 0
                              : demi_rolling_laws[law].name, "rolling_law is DEM_ROLLING_NONE", e);
}
static dem_effect_state demi_look_adhesion(const dem_world *w, dem_effect *e) {
    if (!demi_response_is(w, DEMI_LAWS))
        return demi_look_pairs(w, demi_coheres, "cohesion under impulses", e);
    return demi_look_response(w, demi_sticks, demi_normal_is(w, DEMI_BRANCHED) ? "hysteretic law"
                              : 0, "only the hysteretic normal law has it", e);
}
/* State of force fields: active if they exert a force or torque on some body now. Calls the user's
   functions for every body that can move. */
static dem_effect_state demi_look_field(const dem_world *w, dem_effect *e) {
    int i, pushed = 0;
    if (!w->desc.force && !w->desc.body_force)
        return demi_look_off(e, "desc.force and desc.body_force are null");
    for (i = 0; i < w->bodies.count; i++) {
        const dem_body id = dem_body_id_get(w, i);
        dem_vec3 force = demi_v(0, 0, 0), torque = force;
        dem_body_state body;
        if (!(w->bodies.inv_mass[i] > 0) || dem_body_get(w, id, &body) != DEM_OK) continue;
        if (w->desc.body_force)
            DEMI_USER(w, "a report of effects", 1,
                      w->desc.body_force(&body, id, w->clock.time, &force, &torque,
                                         w->desc.force_user))
        if (w->desc.force)
            DEMI_USER(w, "a report of effects", 1,
                      force = demi_add(force, w->desc.force(
                          body.position, body.velocity, demi_radius(w, i),
                          w->bodies.mass[i], w->clock.time, w->desc.force_user)))
        pushed += demi_dot(force, force) > 0 || demi_dot(torque, torque) > 0;
    }
    return demi_say(e, pushed, "acts on %d of %d bodies now", pushed, w->bodies.count);
}
/* State of desc.growth: active if some radius changes now. Calls the user's function for every
   body. */
static dem_effect_state demi_look_growth(const dem_world *w, dem_effect *e) {
    int i, moving = 0;
    if (!w->desc.growth) return demi_look_off(e, "desc.growth is null");
    for (i = 0; i < w->bodies.count; i++) {
        const dem_body id = dem_body_id_get(w, i);
        dem_body_state body;
        dem_real rate;
        if (dem_body_get(w, id, &body) != DEM_OK) continue;
        DEMI_USER(w, "a report of effects", 1,
                  rate = w->desc.growth(&body, id, w->clock.time, w->desc.growth_user))
        moving += rate < 0 || rate > 0;
    }
    return demi_say(e, moving, "the radii of %d of %d bodies change now", moving, w->bodies.count);
}
/* State of user-defined numbers of bodies: active if contacts change them on some body now, or if
   body_reals_fn may. */
static dem_effect_state demi_look_reals(const dem_world *w, dem_effect *e) {
    const int n = w->bodies.real_count;
    int i, k, moving = 0;
    if (!n) return demi_look_off(e, "desc.body_reals is null");
    if (!demi_exchanges(w) && !w->desc.body_reals_fn)
        return demi_say(e, 0, "%s: constant; no law gives rates (law_who), and body_reals_fn is "
                        "null", w->real_names);
    for (i = 0; i < w->bodies.count; i++) {
        for (k = 0; k < n && !(DEMI_ABS(w->bodies.rates[n*i + k]) > 0);) k++;
        moving += k < n;
    }
    return demi_say(e, moving || w->desc.body_reals_fn, "%s: contacts change them on %d of %d "
                    "bodies now", w->real_names, moving, w->bodies.count);
}
static dem_effect_state demi_look_walls(const dem_world *w, dem_effect *e) {
    int i, count = 0, touched = 0, some = 0;
    for (i = 0; i < w->wall_count; i++) {
        if (w->walls[i].kind == DEMI_WALL_NONE) continue;
        count++;
        if (w->walls[i].loads.touched) touched++;
        else if (!some) some = (int)w->walls[i].id;
    }
    if (!count) return demi_look_off(e, "there are none");
    e->missing = count - touched;
    if (touched == count) return demi_say(e, 1, "%d", count);
    return demi_say(e, touched, "%d; wall %d%s never touched", count, some,
                    count - touched == 1 ? " was" : " and others were");
}
static dem_effect_state demi_look_motions(const dem_world *w, dem_effect *e) {
    int i, count = 0, touched = 0;
    for (i = 0; i < w->wall_count; i++) {
        if (w->walls[i].kind == DEMI_WALL_NONE ||
            (w->walls[i].motion.kind == DEM_MOTION_FIXED && !w->walls[i].glides)) continue;
        count++;
        touched += w->walls[i].loads.touched;
    }
    if (!count) return demi_look_off(e, "no wall moves");
    e->missing = count - touched;
    return demi_say(e, touched, "%d wall%s%s", count, count == 1 ? "" : "s",
                    touched ? "" : ", never touched");
}
/* State of periodic faces: active if a pair of the pruned neighbour list crosses one. */
static dem_effect_state demi_look_periodic(const dem_world *w, dem_effect *e) {
    int d, p, k, faces = 0, across = 0;
    for (k = 0; k < 3; k++) faces += w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC;
    if (!faces) return demi_look_off(e, "no boundary is periodic");
    for (d = 0; d < w->domain_count && w->stage.list_valid; d++) {
        const demi_domain *domain = &w->domains[d];
        for (p = 0; p < domain->near_shaped_end; p++) {
            const dem_real *shift;
            if (p >= domain->near_own && p < domain->near_cross) continue;
            if (p >= domain->near_end && p < domain->near_shaped) continue;
            shift = w->image_shift + w->near.image[d*w->near.stride + p];
            across += demi_dot(demi_at(shift), demi_at(shift)) > 0;
        }
    }
    if (across) return demi_say(e, 1, "along %d ax%s; %d neighbour pairs cross a face", faces,
                                faces == 1 ? "is" : "es", across);
    return demi_say(e, 0, "along %d ax%s; no neighbour pair crosses a face now", faces,
                    faces == 1 ? "is" : "es");
}
static dem_effect_state demi_look_cell(const dem_world *w, dem_effect *e) {
    if (!w->cell.on) return demi_look_off(e, "the sides of the domain do not move");
    return demi_say(e, 1, "strain rates %.3g %.3g %.3g, shear rate %.3g 1/s", w->cell.rate[0],
                    w->cell.rate[1], w->cell.rate[2], w->cell.shear);
}
static dem_effect_state demi_look_unlike(const dem_world *w, dem_effect *e) {
    if (w->effects.uniform || !w->bodies.count)
        return demi_look_off(e, "all bodies are alike: coefficients are computed once");
    return demi_say(e, 1, "%s", demi_many_species(w) ? "coefficients per neighbour pair"
                    : "coefficients per pair of species");
}
static dem_effect_state demi_look_shapes(const dem_world *w, dem_effect *e) {
    if (!w->bodies.shaped) return demi_look_off(e, "all bodies are spheres");
    return demi_say(e, 1, w->effects.unlike ? "%d of %d bodies are not spheres"
                    : "%d of %d bodies are clusters of one sphere, computed as spheres",
                    w->bodies.shaped, w->bodies.count);
}
static dem_effect_state demi_look_orientations(const dem_world *w, dem_effect *e) {
    if (w->bodies.shaped) return demi_look_off(e, "included in shapes");
    if (!w->desc.orientations) return demi_look_off(e, "desc.orientations is 0");
    if (w->shape_count) return demi_look_off(e, "grains of a shape may come");
    if (w->joint_count) return demi_look_off(e, "joints turn with bodies");
    return demi_say(e, 1, "followed because desc.orientations is 1; no force depends on them");
}
static dem_effect_state demi_look_ledger(const dem_world *w, dem_effect *e) {
    if (!w->desc.ledger) return demi_look_off(e, "desc.ledger is 0");
    return demi_say(e, 1, "every contact reports where its energy goes");
}
static dem_effect_state demi_look_feeds(const dem_world *w, dem_effect *e) {
    uint64_t came = 0;
    int i;
    if (!w->feed_count) return demi_look_off(e, "there are none");
    for (i = 0; i < w->feed_count; i++) came += demi_feed_at(w, i)->state.total;
    return demi_say(e, came > 0, "%d; %llu grains so far", w->feed_count, (unsigned long long)came);
}
static dem_effect_state demi_look_outlets(const dem_world *w, dem_effect *e) {
    uint64_t went = 0;
    int i;
    if (!w->outlet_count) return demi_look_off(e, "there are none");
    for (i = 0; i < w->outlet_count; i++) went += demi_outlet_at(w, i)->state.total;
    return demi_say(e, went > 0, "%d; %llu grains so far", w->outlet_count,
                    (unsigned long long)went);
}
static dem_effect_state demi_look_events(const dem_world *w, dem_effect *e) {
    const demi_event_counts *n = &w->events.n;
    double ended = 0;
    int i;
    if (!n->on) return demi_look_off(e, "contacts are not recorded (dem_events_record)");
    for (i = 0; i < n->pairs; i++) ended += w->events.pairs[i].ended;
    return demi_say(e, ended > 0 || n->open, "%.0f contacts have ended, %d exist", ended, n->open);
}

/* --- copies without an effect --- */

/* User data of the functions below, which stand in for the user's law and force fields in a copy.
   They call the original `times` times, once or twice, and use only the last result. desc: of the
   original world; memory: reals in the contact history of its law. */
typedef struct demi_again { dem_world_desc desc; int memory, times; } demi_again;
/* Switches an effect off in the copy t, or makes it call the user's functions through *own. */
typedef void (*demi_leave_fn)(dem_world *t, demi_again *own);
/* Changes all pairs of materials of the copy by a function of one pair. */
static void demi_leave_pairs(dem_world *t, void (*leave)(dem_pair *p)) {
    int i, j;
    for (i = 0; i < t->material_count; i++)
        for (j = i; j < t->material_count; j++) {
            dem_pair p = t->pairs[i*DEMI_MATERIALS + j].given;
            leave(&p);
            demi_pair_put(t, i, j, &p);
        }
}
static void demi_leave_pair_rolling(dem_pair *p) { p->rolling_friction = p->spinning_friction = 0; }
static void demi_leave_pair_friction(dem_pair *p) {
    p->friction = p->friction_static = 0;
    demi_leave_pair_rolling(p);
}
static void demi_leave_pair_adhesion(dem_pair *p) { p->stiffness_adhesion = p->cohesion = 0; }
/* Rolling friction goes too: there are loops for neither, for friction, and for both. Impulses have
   the coefficients only, no laws. */
static void demi_leave_friction(dem_world *t, demi_again *own) {
    (void)own;
    t->desc.tangent_law = DEM_TANGENT_NONE;
    t->desc.rolling_law = DEM_ROLLING_NONE;
    if (!demi_response_is(t, DEMI_LASTING)) demi_leave_pairs(t, demi_leave_pair_friction);
}
static void demi_leave_rolling(dem_world *t, demi_again *own) {
    (void)own;
    t->desc.rolling_law = DEM_ROLLING_NONE;
    if (!demi_response_is(t, DEMI_LASTING)) demi_leave_pairs(t, demi_leave_pair_rolling);
}
static void demi_leave_growth(dem_world *t, demi_again *own) {
    (void)own;
    t->desc.growth = 0;
}
static void demi_leave_events(dem_world *t, demi_again *own) {
    (void)own;
    demi_events_clear(t);
    demi_events_switch(t, 0);
}
static void demi_leave_ledger(dem_world *t, demi_again *own) {
    t->desc.ledger = 0;
    demi_leave_events(t, own);                  /* they need it */
}
static void demi_leave_orientations(dem_world *t, demi_again *own) {
    (void)own;
    t->desc.orientations = t->bodies.orienting = 0;
}
static void demi_leave_adhesion(dem_world *t, demi_again *own) {
    (void)own;
    demi_leave_pairs(t, demi_leave_pair_adhesion);
}
static void demi_leave_motions(dem_world *t, demi_again *own) {
    dem_wall id;
    int i;
    (void)own;
    /* weights of facets will be computed again, so every wall of the copy needs arrays of its own.
       If there is no memory for them, demi_wall_own removes the wall */
    for (i = 0; i < t->wall_count; i++)
        if (demi_wall_own(t, &t->walls[i]) && t->walls[i].kind != DEMI_WALL_NONE) {
            id.id = t->walls[i].id;
            dem_wall_motion_set(t, id, &DEM_MOTION);
            dem_wall_surface_velocity_set(t, id, demi_v(0, 0, 0));
        }
}
static void demi_leave_walls(dem_world *t, demi_again *own) {
    dem_wall id;
    int i;
    (void)own;
    for (i = 0; i < t->wall_count; i++) {
        id.id = t->walls[i].id;
        if (t->walls[i].kind != DEMI_WALL_NONE) dem_wall_remove(t, id);
    }
}
/* Stands in for the user's law. Additional calls work on copies of the contact history, of the
   force and of the rates, so that only the last call counts. */
static void demi_law_again(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const demi_again *own = (const demi_again *)c->user;
    dem_contact mine = *c;
    int i;
    mine.user = own->desc.law_user;
    for (i = 1; i < own->times; i++) {
        dem_real spare[DEMI_MEMORY], rates[2*DEM_BODY_REALS];
        dem_contact_force other = *f;
        dem_contact twin = mine;
        memcpy(spare, memory, (size_t)own->memory*sizeof *spare);
        if (c->who.rate_a) {
            memset(rates, 0, sizeof rates);
            twin.who.rate_a = rates;
            twin.who.rate_b = rates + DEM_BODY_REALS;
        }
        DEMI_USER_WITHIN(own->desc.law(&twin, spare, &other));
    }
    DEMI_USER_WITHIN(own->desc.law(&mine, memory, f));
}
static void demi_rate_again(const dem_contact *c, dem_real *rates) {
    const demi_again *own = (const demi_again *)c->user;
    dem_contact mine = *c;
    mine.user = own->desc.law_user;
    DEMI_USER_WITHIN(own->desc.law_rate(&mine, rates));
}
static dem_vec3 demi_force_again(dem_vec3 position, dem_vec3 velocity, dem_real radius,
                                 dem_real mass, double time, void *user) {
    const demi_again *own = (const demi_again *)user;
    int i;
    for (i = 1; i < own->times; i++)
        DEMI_USER_WITHIN(own->desc.force(position, velocity, radius, mass, time,
                                         own->desc.force_user));
    return DEMI_USER_WITHIN(own->desc.force(position, velocity, radius, mass, time,
                                            own->desc.force_user));
}
static void demi_body_force_again(const dem_body_state *body, dem_body id, double time,
                                  dem_vec3 *force, dem_vec3 *torque, void *user) {
    const demi_again *own = (const demi_again *)user;
    int i;
    for (i = 1; i < own->times; i++) {
        dem_vec3 f = *force, t = *torque;
        DEMI_USER_WITHIN(own->desc.body_force(body, id, time, &f, &t, own->desc.force_user));
    }
    DEMI_USER_WITHIN(own->desc.body_force(body, id, time, force, torque, own->desc.force_user));
}
static void demi_again_law(dem_world *t, demi_again *own) {
    t->desc.law = demi_law_again;
    t->desc.law_rows = 0;
    if (t->desc.law_rate) t->desc.law_rate = demi_rate_again;
    t->desc.law_user = own;
}
static void demi_again_field(dem_world *t, demi_again *own) {
    if (t->desc.force) t->desc.force = demi_force_again;
    if (t->desc.body_force) t->desc.body_force = demi_body_force_again;
    t->desc.force_user = own;
}

/* >>add-effect: add a row here and its functions above. */
typedef struct demi_effect_row {
    const char *name;
    demi_look_fn look;
    demi_leave_fn leave;           /* null: the effect cannot be switched off */
    int twice;                     /* 1: nothing can replace the user's function, so the copies call
                                      it once and twice instead of once and not at all */
} demi_effect_row;
static const demi_effect_row demi_effect_rows[DEM_EFFECTS] = {
    {"contacts",         demi_look_contacts,     0,                       0},
    {"friction",         demi_look_friction,     demi_leave_friction,     0},
    {"rolling friction", demi_look_rolling,      demi_leave_rolling,      0},
    {"adhesion",         demi_look_adhesion,     demi_leave_adhesion,     0},
    {"user-defined law", demi_look_law,          demi_again_law,          1},
    {"force field",      demi_look_field,        demi_again_field,        1},
    {"body_reals",       demi_look_reals,        0,                       0},
    {"growth",           demi_look_growth,       demi_leave_growth,       0},
    {"walls",            demi_look_walls,        demi_leave_walls,        0},
    {"moving walls",     demi_look_motions,      demi_leave_motions,      0},
    {"periodic faces",   demi_look_periodic,     0,                       0},
    {"deforming cell",   demi_look_cell,         0,                       0},
    {"unlike grains",    demi_look_unlike,       0,                       0},
    {"shapes",           demi_look_shapes,       0,                       0},
    {"orientations",     demi_look_orientations, demi_leave_orientations, 0},
    {"ledger",           demi_look_ledger,       demi_leave_ledger,       0},
    {"feeds",            demi_look_feeds,        0,                       0},
    {"outlets",          demi_look_outlets,      0,                       0},
    {"events",           demi_look_events,       demi_leave_events,       0}};

/* Computes the states of all effects without their costs. look: a copy of struct dem_world, in
   which the materials that have touched, or the laws in force, are brought up to date. */
static void demi_effects_look(dem_world *look, dem_effect *out) {
    int k;
    if (look->stage.list_valid) demi_met_look(look, look->booked.met);
    else demi_effects(look);
    memset(out, 0, DEM_EFFECTS*sizeof *out);
    for (k = 0; k < DEM_EFFECTS; k++) {
        out[k].name = demi_effect_rows[k].name;
        out[k].state = demi_effect_rows[k].look(look, &out[k]);
        if (out[k].state == DEM_EFFECT_IDLE && !out[k].missing) out[k].missing = 1;
    }
}

#ifndef DEM_NO_TRIALS
/* --- costs of effects --- */

/* Returns a copy of w in the saved state that keeps the present time step, after `leave` (or null)
   has changed it. Null if memory runs out. */
static dem_world *demi_effect_twin(dem_world *w, const char *state, size_t size,
                                   demi_leave_fn leave, demi_again *own) {
    dem_world *t = demi_twin_in_state(w, state, size);
    if (!t) return 0;
    demi_finish(t);
    t->desc.dt = t->clock.dt;
    if (leave) leave(t, own);
    demi_pairs_changed(t);
    demi_halves_outdated(t);
    return t;
}
/* Returns the wall time (s) of `steps` steps; does nothing if *result is an error already. */
static double demi_steps_time(dem_world *t, int steps, dem_result *result) {
    const double begun = demi_clock();
    if (*result == DEM_OK) *result = dem_world_step(t, steps);
    return demi_clock() - begun;
}
static int demi_double_compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}
/* Measures once: returns the time of steps without the effect over that with it; 0 if memory runs
   out, < 0 if a copy does not run. Both copies are new. Some steps let them build lists and
   allocate memory; those timed are fewer than a contact lasts, so that both copies remain in nearly
   the same state. turn: odd turns time the copy with the effect first, even turns the other. */
static double demi_effect_turn(dem_world *w, const char *state, size_t size,
                               const demi_effect_row *row, int turn) {
    demi_again once = {w->desc, w->desc.law_memory, 1}, twice = {w->desc, w->desc.law_memory, 2};
    dem_world *with, *without;
    dem_result result = DEM_OK;
    double first, second, ratio = 0;
    with = demi_effect_twin(w, state, size, row->twice ? row->leave : 0, &once);
    without = with ? demi_effect_twin(w, state, size, row->leave, &twice) : 0;
    if (without) {
        demi_steps_time(with, DEMI_EFFECT_STEPS/4, &result);
        demi_steps_time(without, DEMI_EFFECT_STEPS/4, &result);
        first = demi_steps_time(turn & 1 ? with : without, DEMI_EFFECT_STEPS, &result) + 1e-9;
        second = demi_steps_time(turn & 1 ? without : with, DEMI_EFFECT_STEPS, &result) + 1e-9;
        ratio = result != DEM_OK ? -1 : turn & 1 ? second/first : first/second;
        demi_twin_free(w, without);
    }
    if (with) demi_twin_free(w, with);
    return ratio;
}
/* Measures the cost of an effect: the median over as many turns as the budget (s) allows, 5 to
   DEMI_EFFECT_TURNS, and its standard error from the interquartile range. Returns 0 if memory runs
   out. If a copy does not run, nothing is measured. */
static int demi_effect_cost(dem_world *w, const char *state, size_t size,
                            const demi_effect_row *row, double budget, dem_effect *out) {
    double ratio[DEMI_EFFECT_TURNS];
    const double begun = demi_clock();
    int n = 0;
    while (n < 5 || (n < DEMI_EFFECT_TURNS && demi_clock() - begun < budget)) {
        ratio[n] = demi_effect_turn(w, state, size, row, n);
        if (!(ratio[n] > 0)) return ratio[n] < 0;
        n++;
    }
    qsort(ratio, (size_t)n, sizeof *ratio, demi_double_compare);
    out->measured = 1;
    out->share = (row->twice ? -1 : 1)*(1 - ratio[n/2]);
    /* the interquartile range of a normal distribution is 1.35 standard deviations; a median has
       1.25 times the standard error of a mean */
    out->error = (ratio[3*n/4] - ratio[n/4])/1.35*1.25/sqrt((double)n);
    return 1;
}
/* dem_effects_get after its checks: states, then costs if there is a budget. */
static int demi_effects_ask(dem_world *w, double budget, dem_effect out[DEM_EFFECTS]) {
    dem_result result = DEM_OK;
    dem_world look;
    int k, count = 0, ok = 1;
    size_t size;
    char *state;
    if (budget > 0 && w->bodies.count) {
        if (!w->facets_valid && !demi_surfaces_make(w))
            result = demi_no_memory(w, "dem_effects_get");
        else result = demi_dt_settle(w);        /* fails as a run would */
        if (result != DEM_OK) return -1;
    }
    look = *w;
    demi_effects_look(&look, out);
    for (k = 0; k < DEM_EFFECTS; k++)
        count += out[k].state != DEM_EFFECT_OFF && demi_effect_rows[k].leave;
    if (!(budget > 0) || !count || !w->bodies.count) return DEM_EFFECTS;
    state = demi_state_keep(w, &size);
    for (k = 0; k < DEM_EFFECTS && state && ok; k++)
        if (out[k].state != DEM_EFFECT_OFF && demi_effect_rows[k].leave)
            ok = demi_effect_cost(w, state, size, &demi_effect_rows[k], budget/count, &out[k]);
    if (state) demi_free(w, state);
    if (state && ok) return DEM_EFFECTS;
    demi_no_memory(w, "dem_effects_get");
    return -1;
}
DEM_API int dem_effects_get(dem_world *w, double budget, dem_effect out[DEM_EFFECTS]) {
    demi_calling was;
    int count;
    if (demi_null(w, __func__, out, "effects")) return -1;
    if (!(budget >= 0) || !demi_finite_double(budget)) {
        demi_refuse(w, __func__, "budget is %g s, must be >= 0 and finite; 0 gives only "
                    "states, and 5 s are enough on a quiet machine", budget);
        return -1;
    }
    if (demi_unbuilt(w, __func__) != DEM_OK) return -1;
    was = demi_calls(w, __func__, 1);  /* copies call the user's functions */
    count = demi_effects_ask(w, budget, out);
    demi_called(w, was);
    return count;
}
/* Prints one line per effect. A cost is too noisy if its standard error is above 10 % of a step, or
   if it is below -10 % or above 100 %. */
static void demi_effects_lines(const dem_effect *e, FILE *out) {
    static const char *states[] = {"off", "idle", "active"};
    int k, noisy = 0;
    for (k = 0; k < DEM_EFFECTS; k++) {
        char share[32] = "";
        if (e[k].measured && !(e[k].error <= 0.1 && e[k].share >= -0.1 && e[k].share <= 1)) {
            demi_words(share, sizeof share, "too noisy");
            noisy++;
        } else if (e[k].measured)
            demi_words(share, sizeof share, "%5.1f %% +- %.1f", 100*e[k].share, 100*e[k].error);
        demi_print(out, "  %-17s%-7s%-17s%s\n", e[k].name, states[e[k].state], share, e[k].text);
    }
    if (noisy)
        demi_print(out, "  too noisy: other programs used the machine while %d of them %s "
                   "measured; measure again on a quiet machine, or with a larger budget\n", noisy,
                   noisy > 1 ? "were" : "was");
}
DEM_API void dem_effects_print(dem_world *w, double budget, FILE *out) {
    dem_effect effects[DEM_EFFECTS];
    if (demi_null_look(w, __func__, out, "out")) return;
    if (dem_effects_get(w, budget, effects) < 0) return;
    demi_print(out, "effects, and the share of a step's time that each costs\n");
    demi_effects_lines(effects, out);
}
#endif /* DEM_NO_TRIALS */
