/* ---------------------------------------------------------------------------------------------
   >>responses
   The table of responses: the functions by which springs (soft contacts) and impulses (rigid
   contacts, non-smooth dynamics) settle the time step, compute contact forces, account for energy
   and show a contact to users. A step and the functions that read contacts call the row of
   w->desc.response; DEMI_RESPONSES in >>layout lists the rows and their traits. Whoever reads the
   contacts of a world walks over them (demi_walk), so that all see the same ones. Owns no data.
   --------------------------------------------------------------------------------------------- */
/* Springs: computes the forces of all contacts that domain d owns: first pairs of lone spheres,
   then those of member spheres, then persistent contacts. */
static void demi_springs(dem_world *w, int d) {
    demi_pairs(w, d);
    if (w->effects.clustered) demi_members_pairs(w, d);
    demi_persistent_clear(w, d);
    demi_persistent_respond(w, d);
}
/* Springs: `info` of demi_response_row. Computes the force of one pair of the pruned neighbour list
   again, by the laws of the run and on a copy of its contact history, so that nothing changes. */
static int demi_springs_info(const dem_world *w, int d, int p, dem_contact_info *out,
                             dem_vec3 *gap) {
    demi_run r = demi_run_of(w, 0, w->effects.uniform);
    const demi_span span = demi_span_of(w, d, p, 1);
    dem_real memory[DEMI_MEMORY], coef[DEMI_TILE_COLUMNS];
    demi_tile tile;
    dem_contact c;
    dem_contact_force f;
    int e;
    if (w->effects.clustered) return demi_members_info(w, d, p, out, gap);
    tile.memory[r.same.at_sliding][0] = 0;      /* demi_law reads it from `memory` */
    r.span = &span;
    demi_tile_fetch(&r, 1, &tile);
    if (w->cell.on) demi_tile_flow(&r, 1, &tile);
    *gap = demi_rows_at(&tile.gap, 0);
    demi_touch_one(&tile, &r.same, 0, r.alike && !r.ranged, r.ranged);
    if (!(tile.touch[0] > 0)) return 0;
    if (!out) return 1;
    for (e = 0; e < r.keep; e++) memory[e] = span.memory[(size_t)e*span.stride];
    demi_span_coefs(w, &span, 0, coef);
    for (e = 0; e < DEMI_TILE_COLUMNS; e++) tile.coef[e][0] = coef[e];
    demi_motion_one(&tile, &r.same, 0, r.alike, r.turning, r.following);
    demi_who_clear(&c.who);
    demi_tile_own(&tile, &r, &r.same, 0, w->desc.law_who, &c);
    demi_law(w, &c, memory, &f);
    demi_answer_one(&tile, 0, f.normal, f.tangent, f.moment, r.alike, r.turning, r.parting);
    out->normal = demi_row(tile.normal, 0);
    out->overlap = tile.overlap[0];
    out->force = demi_row(tile.force, 0);
    return 1;
}

/* One response. A null function means that nothing has to be done. */
typedef struct demi_response_row {
    dem_result (*settle)(dem_world *w);         /* checks or chooses the time step */
    int (*room)(dem_world *w);                  /* makes room for contacts; 0: memory ran out */
    void (*respond)(dem_world *w, int domain);  /* computes the forces of a domain's contacts, */
    void (*solve)(dem_world *w);                /* or of all contacts at once */
    void (*book)(dem_world *w);                 /* adds work and losses of a step to the ledger */
    /* Returns 1 if the two spheres of entry p in a domain's pruned neighbour list act on each
       other, or 0. If it returns 1 and `out` is not null, it also writes normal, overlap and force
       to `out`, and the vector from the centre of sphere a to that of b (m) to *gap. */
    int (*info)(const dem_world *w, int domain, int p, dem_contact_info *out, dem_vec3 *gap);
} demi_response_row;
#define DEMI_RESPONSE_ROW(NAME, MEMORY, VECTORS, TRAITS, ...) {__VA_ARGS__},
static const demi_response_row demi_responses[] = {DEMI_RESPONSES(DEMI_RESPONSE_ROW)};
/* Settles the time step of the response in force, unless that has been done for this scene. */
static dem_result demi_dt_settle(dem_world *w) {
    return w->stage.dt_valid ? DEM_OK : demi_responses[w->desc.response].settle(w);
}
/* Writes the contact of entry p in the pruned neighbour list of domain d in the form that users
   see, and returns 1; returns 0 if the two bodies do not act on each other. out: or null, to learn
   only that. *branch, unless null, receives the vector from the centre of a to that of b, m. */
static int demi_contact_force(const dem_world *w, int d, int p, dem_contact_info *out,
                              dem_vec3 *branch) {
    const size_t at = (size_t)d*(size_t)w->near.stride + (size_t)p;
    const int a = w->near.a[at], b = w->near.b[at];
    const dem_real ra = demi_near_radius(w, at, 0), rb = demi_near_radius(w, at, 1);
    const demi_periods periods = demi_periods_of(w);
    dem_vec3 gap;
    if (!demi_responses[w->desc.response].info(w, d, p, out, &gap)) return 0;
    if (!out) return 1;
    out->a = dem_body_id_get(w, a);
    out->b = dem_body_id_get(w, b);
    out->wall = out->further = 0;
    out->point = demi_place_of(&periods, demi_add(demi_add(demi_at(w->bodies.pos + 4*a),
        demi_near_arm(w, at, 0)), demi_scale(gap, ra/(ra + rb))));
    if (branch) *branch = demi_response_is(w, DEMI_LAWS) ? demi_near_bodies_way(w, at) : gap;
    return 1;
}
/* Returns the vector from the centre of a to the point at which a wall acts on it, m. It is on the
   surface of the wall, whereas the arm leads to that of a, which overlaps. The arm of polyhedra
   leads to the wall if they press on it, otherwise half way across the gap. At both points the
   normal force has the same moment; that of impulses acts at the arm. */
static dem_vec3 demi_wall_branch(const dem_world *w, const demi_persistent *c) {
    const int pressing = demi_response_is(w, DEMI_PRESSING);
    const dem_vec3 out = pressing && c->odd ? c->more.outset : demi_v(0, 0, 0);
    dem_real past = c->overlap/c->slope - demi_dot(out, c->normal);
    if (c->corners) past = pressing && c->overlap > 0 ? 0 : c->overlap/2;
    return demi_sub(demi_sub(c->arm_a, out), demi_scale(c->normal, past));
}
/* Writes a persistent contact (demi_persistent: any contact other than sphere on sphere) in the
   form that users see. branch: m, from the centre of a to the contact point. */
static void demi_persistent_info(const dem_world *w, const demi_persistent *c, dem_vec3 branch,
                                 dem_contact_info *out) {
    const demi_periods p = demi_periods_of(w);
    out->a = dem_body_id_get(w, c->a);
    out->b = dem_body_id_get(w, c->b);
    out->wall = c->b < 0 ? w->walls[c->wall].id : 0;
    out->normal = c->normal;
    out->point = demi_place_of(&p, demi_add(demi_at(w->bodies.pos + 4*c->a), branch));
    out->overlap = c->overlap;
    out->force = c->force;
    out->further = c->corner > 0;
}
/* A walk over all contacts: of each work group pairs of spheres, then persistent contacts. */
typedef struct demi_walk {
    int blind;                     /* set it to 1 only to count: then `info` and `branch` are not
                                      written */
    int d, at, persistent; /* work group; next entry of the pruned or, with `persistent`, of the
                                      persistent list */
    int counted;                   /* a point of the present pair of polyhedra has counted */
    /* the contact: indices of the bodies (b -1: a wall); entry of the pruned list, or persistent */
    int a, b, entry;
    demi_persistent *own;
    /* 1: it counts as one contact: the bodies touch or, with impulses, push; of the points at which
       a polyhedron touches, one counts */
    int counts;
    dem_contact_info info;
    dem_vec3 branch;               /* m, from the centre of a to that of b, or to the point on a
                                      wall */
} demi_walk;
static demi_walk demi_walk_begin(void) {
    demi_walk c;
    memset(&c, 0, sizeof c);
    c.at = -1;
    return c;
}
/* Writes the present contact of a walk, entry `at` of its list. Returns 0 if it is none. */
static int demi_walk_look(const dem_world *w, demi_walk *c, int at) {
    const size_t stride = (size_t)w->near.stride, entry = (size_t)c->d*stride + (size_t)at;
    const int solved = demi_response_is(w, DEMI_MIDWAY);
    c->entry = at;
    c->own = c->persistent ? demi_persistent_of(w, c->d) + at : 0;
    c->a = c->own ? c->own->a : w->near.a[entry];
    c->b = c->own ? c->own->b : w->near.b[entry];
    if (c->own ? !demi_persistent_asked(w, c->own)
        : !demi_contact_force(w, c->d, at, c->blind ? 0 : &c->info, &c->branch)) return 0;
    if (w->joint_count && demi_parted(w, c->a, c->b, c->own ? c->own->wall : -1)) return 0;
    if (c->blind) return 1;
    if (c->own) {
        c->branch = c->b < 0 ? demi_wall_branch(w, c->own) : c->own->arm_a;
        demi_persistent_info(w, c->own, c->branch, &c->info);
        if (c->b >= 0) c->branch = demi_sub(c->branch, c->own->arm_b);
    }
    if (!c->info.further) c->counted = 0;
    c->counts = !c->counted && (!solved ? c->info.overlap > 0 : c->own ? c->own->memory[6] > 0
        : w->near.memory[((size_t)c->d*DEMI_IMPULSE_REALS + 6)*stride + (size_t)at] > 0);
    c->counted |= c->counts;
    return 1;
}
/* Goes to the next contact. Returns 0 if there is none. */
static int demi_walk_next(const dem_world *w, demi_walk *c) {
    for (; c->d < w->domain_count; c->d++, c->persistent = 0, c->at = -1) {
        const demi_domain *domain = &w->domains[c->d];
        if (c->at < 0) c->at = demi_near_first(domain);
        for (; !c->persistent; c->persistent = 1, c->at = 0)
            while (c->at < domain->near_end) {
                const int at = c->at;
                c->at = demi_near_next(domain, at);
                if (demi_walk_look(w, c, at)) return 1;
            }
        while (c->at < domain->persistent) if (demi_walk_look(w, c, c->at++)) return 1;
    }
    return 0;
}

/* Finds the contact with the largest overlap, relative to the smaller radius: bodies *a and *b, or
   body *a and *wall, with *b below 0. Returns that overlap, 0 if nothing overlaps. It visits all
   contacts; demi_overlap knows the value without. */
static double demi_deepest(const dem_world *w, int *a, int *b, int *wall) {
    double most = 0;
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        const demi_persistent *own = demi_persistent_of(w, d);
        for (k = demi_near_first(domain); k < domain->near_end; k = demi_near_next(domain, k)) {
            const size_t at = (size_t)d*(size_t)w->near.stride + (size_t)k;
            const dem_real p = demi_near_radius(w, at, 0), q = demi_near_radius(w, at, 1);
            const double deep = (double)((p + q - demi_length(demi_near_way(w, at)))/
                                         DEMI_MIN(p, q));
            if (!(deep > most) || (w->joint_count && demi_parted(w, w->near.a[at], w->near.b[at],
                                                                 -1))) continue;
            most = deep;
            *a = w->near.a[at];
            *b = w->near.b[at];
        }
        for (k = 0; k < domain->persistent; k++) {
            if (!((double)own[k].deep > most) || (w->joint_count && demi_parted(w, own[k].a,
                own[k].b, own[k].wall))) continue;
            most = (double)own[k].deep;
            *a = own[k].a;
            *b = own[k].b;
            *wall = own[k].wall;
        }
    }
    return most;
}
/* Returns the largest overlap in the forces just computed, relative to the smaller radius. */
static double demi_overlap(const dem_world *w) {
    double overlap = 0;
    int d;
    for (d = 0; d < w->domain_count; d++) overlap = DEMI_MAX(overlap, w->domains[d].overlap);
    return overlap;
}
/* Notes where the overlap is that has just become larger than crushed.next. Each note raises that
   limit to a value 1.1^n DEMI_OVERLAP_LIMIT, so that the contacts are visited at most 32 times in a
   run, and the notes of slabs merge to that of the whole world. */
static void demi_crushed_note(dem_world *w) {
    demi_crushed *c = &w->booked.crushed;
    int a = 0, b = 0, wall = 0;
    if (!(demi_deepest(w, &a, &b, &wall) > 0)) return;
    if (!(c->next > 0)) c->since = w->clock.time;
    c->time = w->clock.time;
    for (c->next = DEMI_OVERLAP_LIMIT; c->next < w->booked.overlap_max;) c->next *= 1.1;
    c->a = (int32_t)w->bodies.slot[a] + 1;
    c->b = b < 0 ? 0 : (int32_t)w->bodies.slot[b] + 1;
    c->wall = b < 0 ? w->walls[wall].id : 0;
}
/* Merges the note of a slab into that of the whole world. */
static void demi_crushed_add(demi_crushed *c, const demi_crushed *part) {
    const double since = c->next > 0 ? DEMI_MIN(c->since, part->since) : part->since;
    if (!(part->next > 0)) return;
    if (part->next > c->next || (!(part->next < c->next) && part->time < c->time)) *c = *part;
    c->since = since;
}
/* Writes since when overlaps have been above the limit and where the largest was, for the report
   and the progress line; "" if none was above it. Returns `text`. */
static const char *demi_crushed_text(const dem_world *w, char *text, size_t size) {
    const demi_crushed *c = &w->booked.crushed;
    *text = 0;
    if (c->next > 0)
        demi_words(text, size, "since t = %.4g s, body %d, %s %d: jammed or too soft", c->since,
                   (int)c->a, c->b ? "body" : "wall", (int)(c->b ? c->b : c->wall));
    return text;
}
