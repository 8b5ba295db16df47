/* ---------------------------------------------------------------------------------------------
   >>feed
   Feeds insert grains during a run, and outlets remove or count them. A feed inserts between two
   steps and appends the new grains to the candidate list (demi_list_join). An outlet acts within a
   step, after bodies have moved, when lists are rebuilt and every DEMI_OUTLET_REST steps. A feed
   draws from its own random state in a fixed order: first the class, then positions and velocities
   until a position is free. The number of grains that are due depends only on the time. A
   demi_feeder finds room and inserts the grains: here a world, in >>slabs-run all slabs.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_FEED_TRIES = 40, DEMI_FEED_REST = 16 };  /* positions tried; steps until the next try */
enum { DEMI_FEED_NEAR = 256 };                       /* neighbours that a new grain may have */
/* Steps after which outlets act at the latest (see demi_step_answer); limit of counting outlets. */
enum { DEMI_OUTLET_REST = 64, DEMI_ZONES = 16 };

static demi_feed *demi_feed_at(const dem_world *w, int i) { return w->feeds + i; }
static demi_outlet *demi_outlet_at(const dem_world *w, int i) {
    return w->outlets + i;
}
/* Fails and returns 1 if a box is not finite or has no volume (in planar worlds: no area). */
static int demi_box_empty(dem_world *w, const char *call, dem_box b, int planar) {
    if (demi_place(b.lo) && demi_place(b.hi) && b.hi.x > b.lo.x && b.hi.y > b.lo.y &&
        (b.hi.z > b.lo.z || (planar && b.hi.z >= b.lo.z))) return 0;
    demi_refuse(w, call, "the box goes from (%g, %g, %g) to (%g, %g, %g) m, must be finite with lo "
                "below hi on every axis, at most %g m from the origin; as it is nothing can be in "
                "it: give desc.box two corners that differ", (double)b.lo.x, (double)b.lo.y,
                (double)b.lo.z, (double)b.hi.x, (double)b.hi.y, (double)b.hi.z, DEMI_FARTHEST);
    return 1;
}
/* True if a box is not finite or lo is above hi; it may be a rectangle, a line or a point. */
static int demi_box_bad(dem_box b, int planar) {
    return !demi_finite3(b.lo) || !demi_finite3(b.hi) || !(b.hi.x >= b.lo.x) ||
           !(b.hi.y >= b.lo.y) || (!planar && !(b.hi.z >= b.lo.z));
}
/* Index of the material of class k. */
static int demi_feed_material(const dem_feed_desc *d, int k) {
    return (d->materials[k].id ? d->materials[k].id : d->material.id) - 1;
}
/* Scale at which the shape of class k has the volume of a sphere of this radius (of spheres: the
   radius), and the radius, m, of its bounding sphere. */
static dem_real demi_feed_scale(const dem_world *w, const dem_feed_desc *d, int k,
                                dem_real radius) {
    return d->shapes[k].id ? radius/w->shapes[d->shapes[k].id - 1].equal : radius;
}
static dem_real demi_feed_reach(const dem_world *w, const dem_feed_desc *d, int k,
                                dem_real radius) {
    if (!d->shapes[k].id) return radius;
    return w->shapes[d->shapes[k].id - 1].radius*demi_feed_scale(w, d, k, radius);
}
/* Computes the size distribution and the mean mass of class k. Returns 0 with an error message if
   it fails. */
static int demi_feed_sizes(dem_world *w, const char *call, demi_feed *f, int k) {
    const dem_sizes *d = f->desc.sizes[k];
    const int m = demi_feed_material(&f->desc, k);
    const double one = demi_sphere_mass(w, m, 1);
    demi_size_table *t;
    double mean = 0;
    int i;
    f->lo[k] = f->hi[k] = (double)f->desc.radius[k];
    if (d && !demi_size_ends(w, call, d, &f->lo[k], &f->hi[k])) return 0;
    for (i = 0; i < 2; i++) {
        const dem_real r = (dem_real)(i ? f->hi[k] : f->lo[k]);
        if (demi_mass_refuse(w, call, m, f->desc.shapes[k].id - 1,
                             demi_feed_scale(w, &f->desc, k, r), k)) return 0;
    }
    f->mass[k] = demi_sphere_mass(w, m, f->lo[k]);
    f->desc.radius[k] = (dem_real)f->lo[k];     /* the smallest, for the time step */
    if (!d) return 1;
    f->desc.sizes[k] = 0;
    t = (demi_size_table *)demi_alloc(w, 1, sizeof *t);
    if (!t) { demi_no_memory(w, call); return 0; }
    demi_size_table_make(w, d, f->lo[k], f->hi[k], t);
    for (i = 0; i <= DEMI_FEED_SIZES; i++) {
        const double b = t->at[i*(DEMI_SIZE_STEPS/DEMI_FEED_SIZES)];
        const double a = i ? t->at[(i - 1)*(DEMI_SIZE_STEPS/DEMI_FEED_SIZES)] : b;
        f->finer[k][i] = t->number[i*(DEMI_SIZE_STEPS/DEMI_FEED_SIZES)];
        mean += (f->finer[k][i] - (i ? f->finer[k][i - 1] : 0))*
            (w->desc.planar ? (a*a + a*b + b*b)/3 : (a + b)*(a*a + b*b)/4);
    }
    f->mass[k] = one*mean;
    demi_free(w, t);
    return 1;
}
/* Returns the radius, m, below which this fraction of the number of class k lies. */
static double demi_feed_size(const demi_feed *f, int k, double share) {
    const double step = demi_log(f->hi[k]/f->lo[k])/(int)DEMI_FEED_SIZES, *finer = f->finer[k];
    int lo = 0, hi = DEMI_FEED_SIZES;
    double a, b;
    if (!(f->hi[k] > f->lo[k]) || share < finer[0]) return f->lo[k];
    while (hi - lo > 1) {
        const int mid = (lo + hi)/2;
        if (finer[mid] <= share) lo = mid;
        else hi = mid;
    }
    a = f->lo[k]*demi_exp(lo*step);
    b = f->lo[k]*demi_exp(hi*step);
    return a + (b - a)*(share - finer[lo])/DEMI_MAX(finer[hi] - finer[lo], 1e-300);
}
/* Fails and returns 1 if class k has a material or a shape that does not exist, or a shape that a
   wall does not support. */
static int demi_feed_strange(dem_world *w, const char *call, const dem_feed_desc *d, int k) {
    int m;
    if (d->materials[k].id && demi_material_index(w, call, d->materials[k], &m) != DEM_OK) return 1;
    if (!d->shapes[k].id) return 0;
    m = demi_shape_index(w, call, d->shapes[k]);
    return m < 0 || demi_walls_strange(w, call, m);
}
/* Digest of the size distributions that a feed has copied. */
static uint64_t demi_digest_sizes(const void *item) {
    const demi_feed *f = (const demi_feed *)item;
    const uint64_t h = demi_hash(DEMI_HASH_START, f->lo, sizeof f->lo);
    return demi_hash(demi_hash(h, f->hi, sizeof f->hi), f->finer, sizeof f->finer);
}
/* Rows of the desc, which is the first member of a demi_feed. The name of each row is
   part of a checkpoint's digest, so `desc.inside` keeps it. */
#define DEMI_FED(field, type) DEMI_ROW(dem_feed_desc, field, type)
static const demi_field_row demi_feed_rows[] = {DEMI_FED(material, 'i'),
    {"class_count", 0, DEMI_WHERE(dem_feed_desc, class_count), 'i', 0, DEMI_OVER, DEM_CLASSES, "",
     0, 0, 0, "set it to the number of entries of radius and amount"}, DEMI_FED(radius, 'r'),
    DEMI_FED(amount, 'd'), DEMI_FED(limited, 'i'), DEMI_FED(by_mass, 'i'),
    DEMI_LIMITED(dem_feed_desc, rate, 'd', DEMI_FROM | DEMI_UNDER, 1e15, "1/s"),
    DEMI_LIMITED(dem_feed_desc, start, 'd', DEMI_FROM, DBL_MAX, "s"),
    DEMI_LIMITED_IF(dem_feed_desc, end, 'd', DEMI_FROM, DBL_MAX, "s", 0, 1, 0, 0),
    DEMI_FED(box, 'v'), DEMI_FED(round, 'i'),
    DEMI_LIMITED(dem_feed_desc, velocity, 'v', DEMI_ANY, DEMI_FARTHEST, "m/s"),
    DEMI_LIMITED(dem_feed_desc, spread, 'r', DEMI_FROM, DEMI_FARTHEST, "m/s"), DEMI_FED(seed, 'u'),
    DEMI_FED(materials, 'i'), DEMI_FED(shapes, 'i'), DEMI_ROW_NULL(demi_feed, desc.inside),
    DEMI_ROW_DIGEST("sizes", demi_digest_sizes), DEMI_ROW_FREE(dem_feed_desc, inside_user),
    DEMI_ROW_FREE(dem_feed_desc, sizes), DEMI_ROW_END};
DEM_API dem_feed dem_feed_add(dem_world *w, const dem_feed_desc *d) {
    if (demi_null(w, __func__, d, "desc")) return demi_no_feed;
    demi_feed feed;
    dem_feed id;
    int k, m = 0, shaped = 0;
    id.id = 0;
    if (demi_material_index(w, __func__, d->material, &m) != DEM_OK) return id;
    if (demi_rows_check(w, __func__, demi_feed_rows, d, "",
                        "start from DEM_FEED_DESC and set only what differs") ||
        (w->cell.on && demi_cell_bars(w, __func__, DEMI_CELL_FEEDS))) return id;
    memset(&feed, 0, sizeof feed);
    feed.desc = *d;
    for (k = 0; k < d->class_count; k++) {
        if (demi_feed_strange(w, __func__, d, k)) return id;
        if ((!d->sizes[k] && !(d->radius[k] > 0)) || !demi_finite(d->radius[k]) ||
            !(d->amount[k] > 0) || !(d->amount[k] < 1e15) || !demi_finite_double(d->amount[k])) {
            demi_refuse(w, __func__, "class %d has radius %g m and amount %g, must be > 0 and "
                        "finite; leave out classes that do not occur", k, (double)d->radius[k],
                        d->amount[k]);
            return id;
        }
        if (!demi_feed_sizes(w, __func__, &feed, k)) return id;
        shaped |= d->shapes[k].id > 0;
        if (d->limited) {
            const double count = d->amount[k]/(d->by_mass ? feed.mass[k] : 1) + 0.5;
            if (!(count >= 1 && count < 1e15)) {
                demi_refuse(w, __func__, "class %d has amount %g, which is %.3g grains of %g kg, "
                            "must be 1 to 1e15; check amount and by_mass", k, d->amount[k],
                            count - 0.5, feed.mass[k]);
                return id;
            }
            feed.limit[k] = (uint64_t)count;
        }
    }
    if (!(d->rate > 0) && !d->limited) {
        demi_refuse(w, __func__, "rate is 0, which means all grains at once, and such a feed needs "
                    "`limited`, or it never ends; set limited or a rate");
        return id;
    }
    if (demi_box_bad(d->box, w->desc.planar)) {
        demi_refuse(w, __func__, "the box is not finite or lo is above hi; set it to the region of "
                    "the centres of new grains");
        return id;
    }
    if (!DEMI_GROW(w, w->feeds, (size_t)w->feed_count + 1) ||
        (shaped && (!demi_list_drop(w) || !demi_orient_begin(w)))) {
        demi_no_memory(w, __func__);
        return id;
    }
    feed.random = d->seed;
    feed.next = -1;
    *demi_feed_at(w, w->feed_count++) = feed;
    demi_dt_outdated(w);                        /* new grains may need a shorter one */
    demi_built(w, __func__);
    id.id = w->feed_count;
    return id;
}
static int demi_feed_left(const demi_feed *f) {              /* 1: more grains will come */
    int k, more = !f->desc.limited;
    for (k = 0; k < f->desc.class_count && !more; k++) more = f->limit[k] > f->state.fed[k];
    return more;
}
/* Draws the next grain. The probability of a class is proportional to the number of grains left, if
   the feed is limited, else to the class's fraction by number. Then the size and orientation are
   drawn. */
static void demi_feed_draw(const dem_world *w, demi_feed *f) {
    double weight[DEM_CLASSES], sum = 0, at;
    const int n = f->desc.class_count;
    int k;
    for (k = 0; k < n; k++) {
        weight[k] = f->desc.limited ? (double)(f->limit[k] - f->state.fed[k])
            : f->desc.by_mass ? f->desc.amount[k]/f->mass[k] : f->desc.amount[k];
        sum += weight[k];
    }
    at = sum*demi_uniform(&f->random);
    for (k = 0; k < n - 1 && at >= weight[k]; k++) at -= weight[k];
    while (k > 0 && !(weight[k] > 0)) k--;      /* round-off at the end */
    f->next = k;
    f->drawn.radius = (dem_real)(f->hi[k] > f->lo[k]
                                 ? demi_feed_size(f, k, demi_uniform(&f->random)) : f->lo[k]);
    f->drawn.reach = demi_feed_reach(w, &f->desc, k, f->drawn.radius);
    f->drawn.mass = demi_sphere_mass(w, demi_feed_material(&f->desc, k), (double)f->drawn.radius);
    f->drawn.orientation = f->desc.shapes[k].id ? demi_quat_random(w, &f->random)
                                                : dem_quat_make(1, 0, 0, 0);
}
/* Inserts grains into a world or into slabs. look: collects the bodies near a feed's region. put:
   inserts the grain that was drawn and returns 1; 0 if there is no room; minus a dem_result if it
   failed with an error message and changed nothing. */
typedef struct demi_feeder {
    dem_result (*look)(void *who, const demi_region *g, dem_real radius);
    int (*put)(void *who, demi_feed *f, const demi_region *g);
    void *who;
} demi_feeder;
/* Draws a position and a velocity. Returns 0 if the position is outside the region. */
static int demi_feed_try(const dem_world *w, demi_feed *f, const demi_region *g, dem_vec3 *x,
                         dem_vec3 *v) {
    const dem_feed_desc *d = &f->desc;
    double u[6];
    int k;
    for (k = 0; k < 6; k++) u[k] = demi_uniform(&f->random);
    *v = demi_v(d->velocity.x + d->spread*(dem_real)(2*u[3] - 1),
                d->velocity.y + d->spread*(dem_real)(2*u[4] - 1),
                d->velocity.z + d->spread*(dem_real)(2*u[5] - 1));
    if (w->desc.planar) v->z = 0;
    return demi_region_at(g, u, f->drawn.reach, x);
}
/* Appends the drawn grain as a body and returns its index. The caller has reserved memory. */
static int demi_feed_append(dem_world *w, const demi_feed *f, dem_vec3 x, dem_vec3 v) {
    const int k = (int)f->next, shape = f->desc.shapes[k].id;
    const uint32_t slot = demi_body_append(w, demi_feed_material(&f->desc, k), f->drawn.radius, x);
    const int i = w->bodies.slot_index[slot];
    dem_real velocity[3];
    if (shape)
        demi_body_shape(w, i, shape - 1, demi_feed_scale(w, &f->desc, k, f->drawn.radius),
                        f->drawn.orientation);
    demi_put(velocity, v);
    demi_body_start(w, i, velocity, 0, 0);
    demi_speed_book(w, (double)demi_length(v));
    return i;
}
/* Counts the drawn grain as inserted. */
static void demi_feed_count(demi_feed *f) {
    f->state.fed[f->next]++;
    f->state.total++;
    f->state.mass += f->drawn.mass;
    f->next = -1;
}
/* A feeder for one world: occupancy tree of the bodies near the region (>>placing). */
typedef struct demi_world_feeder { dem_world *w; demi_crowd crowd; } demi_world_feeder;
static dem_result demi_world_look(void *who, const demi_region *g, dem_real radius) {
    demi_world_feeder *to = (demi_world_feeder *)who;
    return demi_crowd_begin(to->w, &to->crowd, g, radius, 0, demi_periods_of(to->w)) ? DEM_OK
        : demi_no_memory(to->w, "dem_world_step");
}
/* Inserts the drawn grain at the first of up to DEMI_FEED_TRIES positions that is free. If
   possible, the grain is appended to the present candidate list, which leaves the state of the
   others untouched. Otherwise lists are rebuilt before the step. */
static int demi_world_put(void *who, demi_feed *f, const demi_region *g) {
    dem_world *w = ((demi_world_feeder *)who)->w;
    demi_crowd *c = &((demi_world_feeder *)who)->crowd;
    const dem_real r = f->drawn.reach;
    const uint64_t random = f->random;
    dem_vec3 x, v;
    int32_t found[DEMI_FEED_NEAR];
    int tries, i, count = 0, free_place = 0, joins;
    c->material = demi_feed_material(&f->desc, (int)f->next);
    for (tries = 0; tries < DEMI_FEED_TRIES && !free_place; tries++)
        free_place = demi_feed_try(w, f, g, &x, &v) && demi_room_free(w, c, x, r);
    if (!free_place) return 0;
    x = demi_place_of(&c->p, x);
    joins = !f->desc.shapes[f->next].id && demi_join_possible(w, c->material, r);
    /* if it is appended, velocities may stay at the half step */
    if (!joins || !w->stage.primed) demi_finish(w);
    if (joins)
        count = demi_crowd_look(w, c, x, r + DEM_R(1.001)*demi_cover(w), found, DEMI_FEED_NEAR);
    joins = joins && count <= DEMI_FEED_NEAR;
    if (!demi_crowd_put(w, c, x, r, w->bodies.count) || (!joins && !demi_list_drop(w)) ||
        !demi_bodies_reserve(w, (size_t)w->bodies.count + 1) ||
        (joins && !demi_quiet_reserve(w, w->bodies.count + 1))) {
        f->random = random;
        return -(int)demi_no_memory(w, "dem_world_step");
    }
    i = demi_feed_append(w, f, x, v);
    if (joins) {
        qsort(found, (size_t)count, sizeof *found, demi_int_compare);
        joins = demi_list_join(w, i, found, count);
        /* then lists are rebuilt */
        if (!joins && !demi_list_drop(w)) w->stage.pairs_changed = 1;
    }
    if (!joins) demi_dt_outdated(w);
    if (w->desc.force || w->desc.body_force || w->margin.reach > 0) {
        v = demi_at(w->bodies.vel + 4*i);       /* the open half kick is not due to this grain */
        demi_finish(w);
        demi_put(w->bodies.vel + 4*i, v);
        demi_put(w->bodies.half_vel + 4*i, v);
        demi_scene_changed(w);                  /* forces may act on it */
    }
    /* it touches nothing, so no force acts on it yet */
    else if (w->stage.primed) demi_prime_body(w, i);
    demi_feed_count(f);
    return 1;
}
/* Region of the centres of new grains; the same for all sizes. */
static int demi_feed_region(const dem_world *w, const dem_feed_desc *d, demi_region *g) {
    dem_region region = dem_region_make(d->box);
    region.cylinder = d->round ? 'z' : 0;
    region.inside = d->inside;
    region.user = d->inside_user;
    return demi_region_make(w, &region, 0, g);
}
/* Inserts all grains that are due at the time of w, which owns the feeds. */
static dem_result demi_feeds_run(dem_world *w, const demi_feeder *feeder) {
    dem_result result;
    int i, k;
    for (i = 0; i < w->feed_count; i++) {
        demi_feed *f = demi_feed_at(w, i);
        const dem_feed_desc *d = &f->desc;
        const double until = d->end > 0 && w->clock.time > d->end ? d->end : w->clock.time;
        const double due = d->rate > 0 ? d->rate*(until - d->start) : 1e300;
        int looked = 0;                         /* 1: look() was called */
        demi_region g;
        while (w->clock.time >= d->start && w->clock.steps >= f->again && demi_feed_left(f)) {
            int done;
            if (f->next < 0) {
                const uint64_t random = f->random;
                double one = 1, fed = (double)f->state.total;          /* grains or kg */
                demi_feed_draw(w, f);
                if (d->by_mass) { one = f->drawn.mass; fed = f->state.mass; }
                if (fed + one > due + 1e-9*(one + due)) {    /* at 3/s, 3 are due at 1 s */
                    f->random = random;         /* not due yet: the same draw is repeated later */
                    f->next = -1;
                    break;
                }
            }
            if (!looked) {
                dem_real r = 0;
                for (k = 0; k < d->class_count; k++) {
                    const dem_real reach = demi_feed_reach(w, d, k, (dem_real)f->hi[k]);
                    r = DEMI_MAX(r, reach);
                }
                demi_feed_region(w, d, &g);
                result = feeder->look(feeder->who, &g, r + demi_cover(w));
                if (result != DEM_OK) return result;
                looked = 1;
            }
            done = feeder->put(feeder->who, f, &g);
            if (done < 0) return (dem_result)-done;
            if (!done) f->again = w->clock.steps + DEMI_FEED_REST;
        }
        f->state.waiting = 0;
        if (f->next >= 0) {
            double waits = d->by_mass || !(d->rate > 0) ? 1 : due - (double)f->state.total;
            uint64_t most = 0;
            for (k = 0; k < d->class_count; k++) most += f->limit[k] - f->state.fed[k];
            if (!(d->rate > 0) || (d->limited && waits > (double)most)) waits = (double)most;
            waits = DEMI_MIN(DEMI_MAX(waits, 0), 1e18);        /* fits into uint64_t */
            f->state.waiting = (uint64_t)(waits + 1e-9*waits);
        }
        f->state.done = f->next < 0 &&
            (!demi_feed_left(f) || (d->end > 0 && w->clock.time > d->end));
    }
    return DEM_OK;
}
/* Inserts all grains that are due before a step, in a world without slabs. */
static dem_result demi_world_feed(dem_world *w) {
    demi_world_feeder to;
    const demi_feeder feeder = {demi_world_look, demi_world_put, &to};
    to.w = w;
    return demi_feeds_run(w, &feeder);
}
DEM_API dem_result dem_feed_get(const dem_world *w, dem_feed id, dem_feed_state *state) {
    if (demi_null_look(w, __func__, state, "state")) return DEM_ERROR_ARGUMENT;
    if (id.id < 1 || id.id > w->feed_count)
        return demi_refuse(w, __func__, "feed %d does not exist, ids in this world are 1 to "
                           "%d; adding it failed or it belongs to another world: check the id that "
                           "dem_feed_add returned", (int)id.id, w->feed_count);
    *state = demi_feed_at(w, id.id - 1)->state;
    return DEM_OK;
}

static const demi_field_row demi_outlet_rows[] = {
    DEMI_ROW(dem_outlet_desc, frame, 'i'), DEMI_ROW(dem_outlet_desc, box, 'v'),
    DEMI_LIMITED(dem_outlet_desc, beyond, 'r', DEMI_FROM, DBL_MAX, "m"),
    DEMI_LIMITED(dem_outlet_desc, wanted_min, 'r', DEMI_FROM, DBL_MAX, "m"),
    DEMI_LIMITED(dem_outlet_desc, wanted_max, 'r', DEMI_FROM, DBL_MAX, "m"),
    DEMI_LIMITED(dem_outlet_desc, class_count, 'i', DEMI_FROM, DEM_CLASSES, ""),
    DEMI_ROW(dem_outlet_desc, radius, 'r'), DEMI_ROW(dem_outlet_desc, material, 'i'),
    DEMI_ROW(dem_outlet_desc, keep, 'i'),
    DEMI_LIMITED(dem_outlet_desc, residence_bin, 'd', DEMI_FROM, DEMI_FARTHEST, "s"),
    DEMI_ROW_END};
DEM_API dem_outlet dem_outlet_add(dem_world *w, const dem_outlet_desc *d) {
    if (demi_null(w, __func__, d, "desc")) return demi_no_outlet;
    demi_outlet outlet;
    dem_outlet id;
    int bad = d->wanted_max > 0 && !(d->wanted_max > d->wanted_min), kept = 0, k;
    id.id = 0;
    if (demi_rows_check(w, __func__, demi_outlet_rows, d, "",
                        "start from DEM_OUTLET_DESC and set only what differs") ||
        (w->cell.on && demi_cell_bars(w, __func__, DEMI_CELL_OUTLETS))) return id;
    for (k = 0; k < d->class_count && !bad; k++)
        bad = !(d->radius[k] > (k ? d->radius[k - 1] : 0)) || !demi_finite(d->radius[k]);
    if (bad) {
        demi_refuse(w, __func__, "wanted is %g to %g m, and there are %d classes; wanted_min must "
                    "be below wanted_max, and the radii of classes > 0, finite and ascending",
                    (double)d->wanted_min, (double)d->wanted_max, d->class_count);
        return id;
    }
    if (demi_box_empty(w, __func__, d->box, w->desc.planar)) return id;
    if (d->frame.id && demi_wall_find(w, __func__, d->frame) < 0) return id;
    if (d->material.id && demi_material_index(w, __func__, d->material, &k) != DEM_OK) return id;
    for (k = 0; k < w->outlet_count; k++) kept += demi_outlet_at(w, k)->desc.keep != 0;
    if (d->keep && kept == DEMI_ZONES) {
        demi_refuse(w, __func__, "keep is %d, but %d outlets that keep their grains exist already, "
                    "which is the limit; count by classes instead", d->keep, kept);
        return id;
    }
    if ((d->keep && !demi_array_begin(w, DEMI_ZONED, &w->bodies.zoned)) ||
        (d->residence_bin > 0 && !demi_ages_begin(w)) ||
        !DEMI_GROW(w, w->outlets, (size_t)w->outlet_count + 1)) {
        demi_no_memory(w, __func__);
        return id;
    }
    memset(&outlet, 0, sizeof outlet);
    outlet.desc = *d;
    outlet.state.since = w->clock.time;
    outlet.zone = d->keep ? kept : -1;
    *demi_outlet_at(w, w->outlet_count++) = outlet;
    demi_built(w, __func__);
    id.id = w->outlet_count;
    return id;
}
/* Class of a grain: the one with the nearest radius. */
static int demi_outlet_class(const dem_outlet_desc *d, dem_real r) {
    int k = 0;
    while (k + 1 < d->class_count && 2*r > d->radius[k] + d->radius[k + 1]) k++;
    return k;
}
/* Counts grain i: in its class, and as wanted or not. */
static void demi_outlet_book(dem_world *w, demi_outlet *o, int i) {
    const dem_outlet_desc *d = &o->desc;
    const dem_real r = demi_radius(w, i);
    const double m = (double)w->bodies.mass[i];
    const int k = demi_outlet_class(d, r);
    const int wanted = r >= d->wanted_min && (!(d->wanted_max > 0) || r <= d->wanted_max);
    o->state.count[k]++;
    o->state.mass[k] += m;
    o->state.total++;
    o->state.total_mass += m;
    *(wanted ? &o->state.sorted : &o->state.gangue) += 1;
    *(wanted ? &o->state.sorted_mass : &o->state.gangue_mass) += m;
    o->state.last = w->clock.time;
    if (d->residence_bin > 0) {
        const double stay = w->clock.time - w->bodies.born[i], bin = stay/d->residence_bin;
        o->state.residence[k] += stay;
        o->state.residence_square[k] += stay*stay;
        o->state.residence_count[(int)DEMI_MAX(DEMI_MIN(bin, DEM_RESIDENCE_BINS - 1), 0)]++;
    }
}
/* True if x, in the outlet's frame, is in the box and at least `beyond` from the z axis. */
static int demi_outlet_has(const dem_outlet_desc *d, dem_vec3 x) {
    return x.x >= d->box.lo.x && x.x <= d->box.hi.x && x.y >= d->box.lo.y && x.y <= d->box.hi.y &&
           x.z >= d->box.lo.z && x.z <= d->box.hi.z && x.x*x.x + x.y*x.y >= d->beyond*d->beyond;
}
/* Transforms a position into the frame of an outlet's region. In a periodic world it uses the image
   nearest to the region's centre, or, for an unbounded region, the image in the domain. */
static dem_vec3 demi_outlet_place(const dem_world *w, const demi_periods *p,
                                  const dem_outlet_desc *d, dem_vec3 x) {
    const dem_pose *pose = d->frame.id ? &w->walls[demi_wall_place(d->frame)].pose : 0;
    dem_vec3 c = demi_scale(demi_add(d->box.lo, d->box.hi), DEM_R(0.5));
    if (p->any) {
        dem_real at[3], mid[3];
        int k;
        if (pose) c = demi_add(pose->position, demi_rotate(pose->rotation, c));
        demi_put(at, x);
        demi_put(mid, c);
        for (k = 0; k < 3; k++)
            at[k] = demi_into(at[k], DEMI_ABS(mid[k] - p->lo[k]) < 1000*p->period[k]
                              ? mid[k] - p->half[k] : p->lo[k], p->period[k]);
        x = demi_at(at);
    }
    return pose ? demi_unrotate(pose->rotation, demi_sub(x, pose->position)) : x;
}
/* True if grain i is in the region and has the outlet's material (if one is set). */
static int demi_outlet_sees(const dem_world *w, const demi_periods *p, const demi_outlet *o,
                            int i) {
    const dem_outlet_desc *d = &o->desc;
    if (d->frame.id && !demi_wall_there(w, d->frame)) return 0;
    if (d->material.id && w->bodies.material[i] != d->material.id) return 0;
    return demi_outlet_has(d, demi_outlet_place(w, p, d, demi_at(w->bodies.pos + 4*i)));
}
/* Updates a counting outlet for grain i: counts it if it has entered the region or gone back. in: 1
   if it is in the region now. The first look at a grain counts nothing. */
static void demi_outlet_count(dem_world *w, demi_outlet *o, int i, int in) {
    const uint32_t bit = 1u << o->zone, known = bit << DEMI_ZONES, before = w->bodies.zones[i];
    const int k = demi_outlet_class(&o->desc, demi_radius(w, i));
    if (before & known) {
        if (in && !(before & bit)) demi_outlet_book(w, o, i);
        if (!in && (before & bit)) {
            o->state.back[k]++;
            o->state.back_mass[k] += (double)w->bodies.mass[i];
            o->state.back_total++;
            o->state.back_total_mass += (double)w->bodies.mass[i];
        }
    }
    w->bodies.zones[i] = (before & ~bit) | known | (in ? bit : 0);
}
/* Runs the outlets after bodies have moved. Counting outlets count. Then the first removing outlet
   that contains a grain removes it. */
static dem_result demi_outlets_run(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    for (i = 0; i < w->bodies.count && w->outlet_count; i++) {
        demi_outlet *takes = 0;
        for (k = 0; k < w->outlet_count && !demi_is_ghost(w, i); k++) {
            demi_outlet *o = demi_outlet_at(w, k);
            if (takes && o->zone < 0) continue;
            if (o->zone >= 0) demi_outlet_count(w, o, i, demi_outlet_sees(w, &p, o, i));
            else if (demi_outlet_sees(w, &p, o, i)) takes = o;
        }
        if (!takes) continue;
        if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
        demi_outlet_book(w, takes, i);
        demi_body_lose(w, i--, &w->bodies.balance.left);
    }
    return DEM_OK;
}
static demi_outlet *demi_outlet_find(const dem_world *w, const char *call, dem_outlet id) {
    if (id.id >= 1 && id.id <= w->outlet_count) return demi_outlet_at(w, id.id - 1);
    demi_refuse(w, call, "outlet %d does not exist, ids in this world are 1 to %d; adding it "
                "failed or it belongs to another world: check the id that dem_outlet_add returned",
                (int)id.id, w->outlet_count);
    return 0;
}
DEM_API dem_result dem_outlet_get(const dem_world *w, dem_outlet id, dem_outlet_state *state) {
    if (demi_null_look(w, __func__, state, "state")) return DEM_ERROR_ARGUMENT;
    const demi_outlet *o = demi_outlet_find(w, __func__, id);
    const demi_periods p = demi_periods_of(w);
    int i;
    if (!o) return DEM_ERROR_ARGUMENT;
    *state = o->state;
    for (i = 0; i < w->bodies.count && o->zone >= 0; i++) {
        const int k = demi_outlet_class(&o->desc, demi_radius(w, i));
        const double m = (double)w->bodies.mass[i];
        if (!demi_outlet_sees(w, &p, o, i)) continue;
        state->held[k]++;
        state->held_mass[k] += m;
        state->held_total++;
        state->held_total_mass += m;
    }
    return DEM_OK;
}
DEM_API dem_result dem_outlet_reset(dem_world *w, dem_outlet id) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    demi_outlet *o = demi_outlet_find(w, __func__, id);
    if (!o) return DEM_ERROR_ARGUMENT;
    memset(&o->state, 0, sizeof o->state);
    o->state.since = w->clock.time;
    return DEM_OK;
}
/* Feeds in a step, see >>features. */
static int demi_feeds_on(const dem_world *h) { return h->feed_count > 0; }
static dem_result demi_feeds_ready(dem_world *h) {
    return h->team ? h->team->feed(h) : demi_world_feed(h);
}
/* States of feeds and outlets in a checkpoint. A feed with limits cannot have fed more grains than
   its desc allows. */
static void demi_feeds_visit(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->feed_count; i++) {
        demi_feed *f = demi_feed_at(w, i);
        demi_visit(s, &f->state, sizeof f->state);
        demi_visit(s, &f->random, sizeof f->random);
        demi_visit(s, &f->next, sizeof f->next);
        demi_visit(s, &f->drawn, sizeof f->drawn);
        demi_visit(s, &f->again, sizeof f->again);
    }
}
static int demi_feeds_check(const demi_reader *r) {
    int i, k;
    for (i = 0; i < r->t->feed_count; i++) {
        const demi_feed *f = demi_feed_at(r->t, i);
        if (f->next < -1 || f->next >= f->desc.class_count || !demi_sane(f->state.mass, 0))
            return demi_lie(r, "state of feed", i);
        for (k = 0; k < f->desc.class_count; k++)
            if (f->desc.limited && f->state.fed[k] > f->limit[k])
                return demi_lie(r, "state of feed", i);
    }
    return 1;
}
static void demi_outlets_visit(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->outlet_count; i++)
        demi_visit(s, &demi_outlet_at(w, i)->state, sizeof(dem_outlet_state));
}
/* Every slab has all outlets, and applies them to its own grains. */
static int demi_outlets_share(dem_world *slab, const dem_world *from, int first) {
    (void)first;
    if (!DEMI_COPY(slab, slab->outlets, from->outlets, from->outlet_count)) return 0;
    slab->outlet_count = from->outlet_count;
    return (!from->bodies.zoned || demi_array_begin(slab, DEMI_ZONED, &slab->bodies.zoned)) &&
        (!from->bodies.aged || demi_ages_begin(slab));
}
