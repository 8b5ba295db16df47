/* ---------------------------------------------------------------------------------------------
   >>bodies
   Storage of bodies: adding, removing, reading and setting them, and periodic images of positions.
   The slot of a body is its identity and never changes. Its index in the arrays changes whenever
   the neighbour list is rebuilt. Code that changes indices must call demi_list_drop (>>filed)
   first. Owns w->bodies. Other parts change values of bodies: >>integrators moves them, contacts
   add forces.
   --------------------------------------------------------------------------------------------- */

/* --- periodic images. On a periodic axis a coordinate means all its images, a period apart.
       Between two rebuilds bodies may be up to half a skin outside the box: pairs store which image
       of the partner is nearest, and no body is wrapped while a list is in use. All code that needs
       a position or a distance uses these functions: searches, fills, feeds, outlets, fields,
       getters, writers. Tests: tests/search/test_periodic.c. --- */
/* Periods of the axes, m: begin of the box, half the period, period. An axis that is not periodic
   has the period 0 and a huge half, so that loops need no case for it. any: 1 if some axis is
   periodic. offset: m, along x, of the image across the upper y face of a sheared cell, else 0. */
typedef struct demi_periods { dem_real lo[3], half[3], period[3], offset; int any; } demi_periods;
/* Returns the periods of a world. */
static demi_periods demi_periods_of(const dem_world *w) {
    const dem_vec3 lo = w->desc.domain.lo, size = demi_sub(w->desc.domain.hi, lo);
    demi_periods p;
    int k;
    demi_put(p.lo, lo);
    demi_put(p.period, size);
    p.offset = (dem_real)w->cell.offset;
    for (k = 0, p.any = 0; k < 3; k++) {
        const int periodic = w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC;
        p.any |= periodic;
        p.half[k] = periodic ? p.period[k]/2 : (DEMI_SINGLE ? DEM_R(FLT_MAX) : (dem_real)DBL_MAX);
        if (!periodic) p.period[k] = 0;
    }
    return p;
}
/* Returns the nearest image of a distance d (minimum image convention), valid for |d| < 1.5 period.
   For the innermost loops; other code uses demi_nearest. */
DEM_INLINE dem_real demi_image(dem_real d, dem_real half, dem_real period) {
    const dem_real up = d < -half ? period : 0, down = d > half ? period : 0;
    return d + up - down;
}
/* Returns the image of coordinate x with from <= image < from + period, in spite of rounding; x
   itself if the period is 0. */
DEM_INLINE dem_real demi_into(dem_real x, dem_real from, dem_real period) {
    if (!(period > 0) || (x >= from && x < from + period)) return x;
    if (x < from) x += period*(dem_real)ceil((double)((from - x)/period));
    else x -= period*(dem_real)floor((double)((x - from)/period));
    if (x >= from + period) x -= period;
    return x < from ? from : x;
}
/* A sheared cell: moves x along with the move of y by whole periods into from <= y < from + period.
   */
DEM_INLINE void demi_slide(const demi_periods *p, dem_real from, dem_vec3 *x) {
    if (!(p->offset < 0 || p->offset > 0)) return;
    x->x += p->offset*(dem_real)floor((double)((demi_into(x->y, from, p->period[1]) - x->y)/
                                               p->period[1]) + 0.5);
}
/* Returns the image of a position in the periodic box. */
static dem_vec3 demi_place_of(const demi_periods *p, dem_vec3 x) {
    if (!p->any) return x;
    demi_slide(p, p->lo[1], &x);
    return demi_v(demi_into(x.x, p->lo[0], p->period[0]), demi_into(x.y, p->lo[1], p->period[1]),
                  demi_into(x.z, p->lo[2], p->period[2]));
}
/* Returns the distance between the nearest images of two positions, for a distance of any size. */
static dem_vec3 demi_nearest(const demi_periods *p, dem_vec3 d) {
    if (!p->any) return d;
    demi_slide(p, -p->half[1], &d);
    return demi_v(demi_into(d.x, -p->half[0], p->period[0]),
                  demi_into(d.y, -p->half[1], p->period[1]),
                  demi_into(d.z, -p->half[2], p->period[2]));
}
/* In a sheared cell the images of a body are on a lattice whose y axis is inclined. Searches use
   the coordinate x - offset (y - lo)/period, in which the lattice is rectangular: returns that, or
   x[0]. Two bodies that differ by at most r along x and y differ in it by at most
   r demi_slant. */
DEM_INLINE double demi_upright(const demi_periods *p, const dem_real *x) {
    if (!(p->offset < 0 || p->offset > 0)) return (double)x[0];
    return (double)demi_into(x[0] - p->offset*(x[1] - p->lo[1])/p->period[1], p->lo[0],
                             p->period[0]);
}
static double demi_slant(const demi_periods *p) {
    return p->offset < 0 || p->offset > 0 ? 1 + fabs((double)(p->offset/p->period[1])) : 1;
}
/* Returns the positions of all bodies in the periodic box: count x 4, as bodies.pos. They are valid
   until bodies move or are sorted. */
static const dem_real *demi_wrapped(const dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i;
    if (!p.any) return w->bodies.pos;
    for (i = 0; i < w->bodies.count; i++) {
        demi_put(w->bodies.scratch + 4*i, demi_place_of(&p, demi_at(w->bodies.pos + 4*i)));
        w->bodies.scratch[4*i + 3] = demi_radius(w, i);
    }
    return w->bodies.scratch;
}
/* Gives the two corners of the domain box, m. */
static void demi_domain_limits(const dem_world *w, double *lo, double *hi) {
    lo[0] = (double)w->desc.domain.lo.x; lo[1] = (double)w->desc.domain.lo.y;
    lo[2] = (double)w->desc.domain.lo.z;
    hi[0] = (double)w->desc.domain.hi.x; hi[1] = (double)w->desc.domain.hi.y;
    hi[2] = (double)w->desc.domain.hi.z;
}
/* Wraps positions into the periodic box. Allowed only at a rebuild, when no list stores images. */
static void demi_wrap(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    for (i = 0; i < w->bodies.count && p.any; i++) {
        dem_real to[3];
        demi_put(to, demi_place_of(&p, demi_at(w->bodies.pos + 4*i)));
        for (k = 0; k < 3; k++) {
            if (p.period[k] > 0 && w->bodies.backward)
                w->bodies.last_pos[4*i + k] += to[k] - w->bodies.pos[4*i + k];
            w->bodies.pos[4*i + k] = to[k];
        }
    }
}

/* True if this body is a ghost particle: a copy of one that another slab owns (>>slabs). */
DEM_INLINE int demi_is_ghost(const dem_world *w, int i) {
    return w->bodies.ghost && w->bodies.ghost[w->bodies.slot[i]] == 1;
}

/* --- the arrays of bodies (demi_body_arrays) --- */

/* True if this world has the array. */
static int demi_has(const dem_world *w, const demi_body_array *a) {
    return a->who == DEMI_BACK ? w->bodies.backward : a->who == DEMI_TURNED ? w->bodies.orienting
           : a->who == DEMI_BACK_TURNED ? w->bodies.backward && w->bodies.orienting
           : a->who == DEMI_COUNTED ? w->bodies.real_count > 0
           : a->who == DEMI_ZONED ? w->bodies.zoned : a->who == DEMI_AGED ? w->bodies.aged
           : a->who == DEMI_AVERAGED ? w->bodies.averaged
           : a->who == DEMI_GROUPED ? w->bodies.group_count > 0
           : a->who == DEMI_BOOKED ? w->bodies.booked : 1;
}
/* Returns the bytes of one body in an array. */
static size_t demi_item(const dem_world *w, const demi_body_array *a) {
    return a->item*(a->who == DEMI_COUNTED ? (size_t)w->bodies.real_count : 1);
}
/* True if the array is state of bodies in this world: copied, saved and restored with them. */
static int demi_keeps(const dem_world *w, const demi_body_array *a) {
    return a->what && a->who != DEMI_SLOTS && demi_has(w, a);
}
/* Returns the bytes of all state of one body. */
static size_t demi_body_size(const dem_world *w) {
    size_t size = 0;
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++)
        if (demi_keeps(w, &demi_body_arrays[k])) size += demi_item(w, &demi_body_arrays[k]);
    return size;
}
static char *demi_data(const dem_world *w, const demi_body_array *a) {
    char *data;
    memcpy(&data, (const char *)&w->bodies + a->field, sizeof data);
    return data;
}
/* Returns the element of body i in an array. */
static char *demi_datum(const dem_world *w, const demi_body_array *a, int i) {
    return demi_data(w, a) + (size_t)i*demi_item(w, a);
}
/* Reallocates the arrays of bodies whose `who` is a bit of `chosen`, and copies the first `used`
   elements. Returns 0 if memory ran out; all arrays are then unchanged. */
static int demi_bodies_room(dem_world *w, int chosen, size_t used, size_t room) {
    void *fresh[DEMI_BODY_ARRAYS];
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        fresh[k] = 0;
        if (!(chosen >> a->who & 1) || !room) continue;
        fresh[k] = demi_hold(w, DEMI_RUN, room, demi_item(w, a));
        if (fresh[k]) continue;
        while (k--) demi_free(w, fresh[k]);
        return 0;
    }
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (!fresh[k]) continue;
        if (used) memcpy(fresh[k], demi_data(w, a), used*demi_item(w, a));
        demi_free(w, demi_data(w, a));
        memcpy((char *)&w->bodies + a->field, &fresh[k], sizeof fresh[k]);
    }
    return 1;
}
/* Reserves memory for this total number of bodies and for the slots that new ones may need. Returns
   0 if memory ran out; arrays that have grown already stay so. */
static int demi_bodies_reserve(dem_world *w, size_t count) {
    const size_t old = (size_t)w->bodies.capacity, room = DEMI_MAX(count, old + old/4 + 16);
    /* slots of removed bodies are free only after a rebuild: each new body may need a new slot */
    const size_t more = count > (size_t)w->bodies.count ? count - (size_t)w->bodies.count : 0;
    const size_t slots = (size_t)w->bodies.slot_count + more;
    const int sets =
        1 << DEMI_EVERY | w->bodies.backward << DEMI_BACK | w->bodies.orienting << DEMI_TURNED |
        (w->bodies.backward && w->bodies.orienting) << DEMI_BACK_TURNED |
        (w->bodies.real_count > 0) << DEMI_COUNTED | w->bodies.zoned << DEMI_ZONED |
        w->bodies.aged << DEMI_AGED | w->bodies.averaged << DEMI_AVERAGED |
        w->bodies.booked << DEMI_BOOKED | (w->bodies.group_count > 0) << DEMI_GROUPED;
    if (count > (size_t)(INT_MAX/64) || slots > (size_t)(INT_MAX/64)) return 0;
    if (count > (size_t)w->bodies.capacity) {
        if (!demi_bodies_room(w, sets, (size_t)w->bodies.count, room)) return 0;
        w->bodies.capacity = (int)room;
    }
    if (slots > (size_t)w->bodies.slot_capacity) {
        const size_t slot_room = DEMI_MAX(slots, (size_t)w->bodies.slot_capacity*5/4 + 16);
        if (!demi_bodies_room(w, 1 << DEMI_SLOTS, (size_t)w->bodies.slot_count,
                              slot_room)) return 0;
        w->bodies.slot_capacity = (int)slot_room;
    }
    return 1;
}
/* Sets the state of body i to 0. */
static void demi_body_clear(dem_world *w, int i) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a)) memset(demi_datum(w, a, i), 0, demi_item(w, a));
    }
}
/* Copies the state of body `from` to body `to`. */
static void demi_body_copy(dem_world *w, int from, int to) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a)) memcpy(demi_datum(w, a, to), demi_datum(w, a, from), demi_item(w, a));
    }
}

/* Gives bodies orientations. Returns 0 if memory ran out; nothing has changed then. */
static int demi_orient_begin(dem_world *w) {
    int i;
    if (w->bodies.orienting) return 1;
    if (!demi_bodies_room(w, 1 << DEMI_TURNED | w->bodies.backward << DEMI_BACK_TURNED, 0,
                          (size_t)w->bodies.capacity)) return 0;
    w->bodies.orienting = 1;
    for (i = 0; i < w->bodies.count; i++) {
        w->bodies.orient[4*i] = 1;
        demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
    }
    return 1;
}

/* Gives bodies the arrays of this `who`, set to 0, unless *has, which becomes 1. Returns 0 if
   memory ran out. */
static int demi_array_begin(dem_world *w, int who, int *has) {
    if (*has) return 1;
    if (!demi_bodies_room(w, 1 << who, 0, (size_t)w->bodies.capacity)) return 0;
    *has = 1;
    return 1;
}
/* Begins measuring the ages of bodies. The present ones are inserted now. Returns 0 if memory ran
   out. */
static int demi_ages_begin(dem_world *w) {
    const int has = w->bodies.aged;
    int i;
    if (!demi_array_begin(w, DEMI_AGED, &w->bodies.aged)) return 0;
    for (i = 0; i < w->bodies.count && !has; i++) w->bodies.born[i] = w->clock.time;
    return 1;
}

/* Returns the kinetic energy of body i, J; 0 if it is fixed. */
static double demi_body_energy(const dem_world *w, int i) {
    const dem_real *v = w->bodies.vel + 4*i;
    const double m = (double)w->bodies.mass[i];
    if (w->bodies.inv_mass[i] <= 0) return 0;
    return m*(double)(v[0]*v[0] + v[1]*v[1] + v[2]*v[2])/2 +
        (double)demi_dot(demi_angular_of(w, i), demi_at(w->bodies.spin + 4*i))/2;
}

/* Marks forces, the time step and isolated bodies as outdated, after a change of the scene. */
static void demi_scene_changed(dem_world *w) {
    w->stage.quiet = 0;
    demi_forces_outdated(w);
    demi_dt_outdated(w);
}
/* Prepares a world without bodies. */
static void demi_bodies_begin(dem_world *w) {
    w->bodies.slot_free = w->bodies.slot_pending = -1;
    w->stage.synced = 1;
}

/* Appends one sphere to the arrays and returns its slot. Memory must be reserved and the neighbour
   list dropped. */
static uint32_t demi_body_append(dem_world *w, int material, dem_real radius, dem_vec3 x) {
    const int i = w->bodies.count++;
    const double m = demi_sphere_mass(w, material, (double)radius);
    int slot = w->bodies.slot_free;
    /* list of free slots: slot_index is -2 - next */
    if (slot >= 0) w->bodies.slot_free = -2 - w->bodies.slot_index[slot];
    else { slot = w->bodies.slot_count++; w->bodies.slot_generation[slot] = 1; }
    demi_body_clear(w, i);
    demi_put(w->bodies.pos + 4*i, x);
    if (w->desc.planar) w->bodies.pos[4*i + 2] = 0;
    w->bodies.pos[4*i + 3] = radius;
    w->bodies.mass[i] = (dem_real)m;
    w->bodies.inv_mass[i] = (dem_real)(1/m);
    w->bodies.inv_inertia[i] = (dem_real)(1/demi_sphere_inertia(w, m, (double)radius));
    w->bodies.slot[i] = (uint32_t)slot;
    w->bodies.material[i] = material + 1;
    w->bodies.slot_index[slot] = i;
    if (w->bodies.aged) w->bodies.born[i] = w->clock.time;
    if (w->bodies.orienting) {
        demi_quat_put(w->bodies.orient + 4*i, dem_quat_make(1, 0, 0, 0));
        demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
    }
    demi_lll_outdated(w);
    w->bodies.balance.inserted++;
    w->bodies.balance.present++;
    return (uint32_t)slot;
}
/* Returns the largest time step, s, at which polyhedra rest on each other under gravity, or 0 for
   any: 0.15 sqrt(L/g), where L is the edge of a cube that fits into the circumscribed sphere of the
   smallest polyhedron. In a longer step bodies fall so far before their contacts act that an arch
   does not bear its weight. */
static double demi_rest_limit(const dem_world *w) {
    const double g = (double)demi_length(w->desc.gravity);
    double least = DBL_MAX;
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_shape *shape = demi_shape_of(w, i);
        if (shape && shape->kind == DEMI_POLYHEDRON && w->bodies.inv_mass[i] > 0)
            least = DEMI_MIN(least, (double)demi_radius(w, i));
    }
    return g > 0 && least < DBL_MAX ? 0.15*sqrt(2*least/(sqrt(3.0)*g)) : 0;
}
/* True if a part touches a wall through a tessellation: if the wall's row has no function for the
   two, or one that finds only gaps while springs need pressure. */
static int demi_wall_faceted(const dem_world *w, const demi_wall *wall, int part) {
    const demi_wall_kind *kind = &demi_wall_kinds[wall->kind];
    const int gaps = kind->traits & DEMI_ONLY_GAPS ||
        (wall->sieve.kind && !demi_sieve_wires(&wall->sieve) && !(wall->sieve.thickness > 0));
    return kind->tessellate[0] != '0' && demi_listed(demi_wall_kinds[DEMI_WALL_MESH].touch, part) &&
        (!demi_listed(kind->touch, part) ||
         (part == DEMI_POLYHEDRON && gaps && demi_response_is(w, DEMI_PRESSING)));
}
/* Returns why a part cannot touch a wall, and the remedy; 0 if it can. */
static const char *demi_wall_why(const dem_world *w, const demi_wall *wall, int part) {
    if (!demi_listed(demi_wall_kinds[wall->kind].touch, part) && !demi_wall_faceted(w, wall, part))
        return "contacts between the two are not available; use a mesh or a resolved profile";
    if (part == DEMI_BALL) return 0;
    if (w->desc.planar && (wall->sieve.kind || wall->ring_count))
        return "a polygon is a prism along z, and the wall is not; use a profile";
    if (wall->sieve.kind == DEM_SIEVE_REDUCED)
        return "reduced holes are only for spheres; use DEM_SIEVE_SQUARE";
    if (wall->sieve.radius > 0)
        return "a sieve cut from a disc is only for spheres; set its radius to 0, add a cylinder";
    return 0;
}
/* Returns the first kind of part of a shape (null: a sphere) whose contacts with a wall are not
   available; -1 if there is none. */
static int demi_shape_strange(const dem_world *w, const demi_wall *wall, const demi_shape *shape) {
    const int pieces = shape && shape->pieces ? shape->pieces : 1;
    int i;
    for (i = 0; i < pieces; i++) {
        const demi_shape *one = shape && shape->pieces ? &w->shapes[shape->piece[i].shape] : shape;
        if (demi_wall_why(w, wall, demi_shape_kind(one))) return demi_shape_kind(one);
    }
    return -1;
}
/* Fails with the reason why a body and a wall cannot be combined. number: the wall's id; body: its
   slot, -1 for one that is to be added; part: its kind. */
static dem_result demi_strangers(dem_world *w, const char *call, const demi_wall *wall, int number,
                                 int body, int part) {
    char who[32] = "the body";
    if (body >= 0) demi_words(who, sizeof who, "body %d", body + 1);
    return demi_refuse(w, call, "wall %d is a %s and %s a%s %s: %s; nothing was added", number,
                       demi_wall_kinds[wall->kind].name, who, demi_an(demi_shape_rows[part].name),
                       demi_shape_rows[part].name, demi_wall_why(w, wall, part));
}
/* Returns 1 with an error message if contacts between a shape and some wall are not available. */
static int demi_walls_strange(dem_world *w, const char *call, int shape) {
    int j;
    for (j = 0; j < w->wall_count; j++) {
        const demi_wall *wall = &w->walls[j];
        const int part = wall->kind == DEMI_WALL_NONE ? -1
            : demi_shape_strange(w, wall, &w->shapes[shape]);
        if (part < 0) continue;
        demi_strangers(w, call, wall, (int)wall->id, -1, part);
        return 1;
    }
    return 0;
}
/* Returns the mass of a body of this shape and scale, kg. Planar bodies keep their thickness. */
static double demi_shape_mass(const dem_world *w, int material, int shape, double scale) {
    return (double)w->materials[material].density*w->shapes[shape].volume*scale*scale*
        (w->desc.planar ? 1 : scale);
}
/* Writes the mass, kg, of a sphere of radius `size`, m (shape -1), or of a shape of scale `size`.
   Returns 1 if the size is not positive or too large, or if dem_real cannot hold the mass, the
   moments of inertia or their inverses: accelerations would be 0 or infinite. */
static int demi_mass_bad(const dem_world *w, int material, int shape, dem_real size, double *mass) {
    const double s = (double)size;
    double x[3];
    int k, bad = !(size > 0) ||
        !(size*(shape < 0 ? 1 : w->shapes[shape].radius) <= DEM_R(DEMI_FARTHEST));
    *mass = x[0] = shape < 0 ? demi_sphere_mass(w, material, s)
        : demi_shape_mass(w, material, shape, s);
    x[1] = x[2] = shape < 0 ? demi_sphere_inertia(w, *mass, s) : *mass*s*s;
    if (shape >= 0) {
        const dem_vec3 I = w->shapes[shape].inertia;
        x[1] *= (double)DEMI_MIN(I.x, DEMI_MIN(I.y, I.z));
        x[2] *= (double)DEMI_MAX(I.x, DEMI_MAX(I.y, I.z));
    }
    for (k = 0; k < 3; k++) {
        const dem_real one = (dem_real)x[k], inverse = (dem_real)(1/x[k]);
        bad = bad || !(one > 0) || !demi_finite(one) || !(inverse > 0) || !demi_finite(inverse);
    }
    return bad;
}
/* Fails and returns 1 if that is so. i: the number of the body in the message. */
static int demi_mass_refuse(dem_world *w, const char *call, int material, int shape, dem_real size,
                            int i) {
    double mass;
    if (!demi_mass_bad(w, material, shape, size, &mass)) return 0;
    demi_refuse(w, call, "the %s %d is %g%s, must be > 0 and finite, and its mass is %g kg, must "
                "be neither too small nor too large to calculate with in %s precision; lengths are "
                "in metres: check the unit; nothing was added", shape < 0 ? "radius of sphere"
                : "scale of body", i, (double)size, shape < 0 ? " m" : "", mass,
                DEMI_SINGLE ? "single" : "double");
    return 1;
}
/* Returns the part of an orientation that is a rotation about z, for planar worlds. */
static dem_quat demi_quat_flat(dem_quat given) {
    const dem_quat q = demi_quat_unit(given);
    const dem_real l = DEMI_SQRT(q.w*q.w + q.z*q.z);
    return l > 0 ? dem_quat_make(q.w/l, 0, 0, q.z/l) : dem_quat_make(1, 0, 0, 0);
}
/* Makes the sphere just appended a body of a shape, with its scale and orientation. */
static void demi_body_shape(dem_world *w, int i, int shape, dem_real scale, dem_quat orientation) {
    const demi_shape *as = &w->shapes[shape];
    const double m = demi_shape_mass(w, w->bodies.material[i] - 1, shape, (double)scale);
    w->bodies.shape[i] = shape + 1;
    w->bodies.pos[4*i + 3] = as->radius*scale;
    w->bodies.mass[i] = (dem_real)m;
    w->bodies.inv_mass[i] = (dem_real)(1/m);
    w->bodies.inv_inertia[i] = 0;
    demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
    w->bodies.moment[4*i + 3] = as->moment_arm*scale;
    demi_quat_put(w->bodies.orient + 4*i, demi_quat_unit(dem_quat_multiply(
        w->desc.planar ? demi_quat_flat(orientation) : orientation, as->frame)));
    w->bodies.shaped++;
}
/* Returns the rail of a body, or null. */
static demi_rail *demi_rail_of(const dem_world *w, dem_body body) {
    int k;
    for (k = 0; k < w->rail_count; k++)
        if (!memcmp(&w->rails[k].body, &body, sizeof body)) return &w->rails[k];
    return 0;
}
/* Gives body i a velocity, m/s, and a spin, rad/s; null: those that it has. A fixed body rests, one
   of a planar world stays in its plane, one on a rail keeps those along locked axes. Nothing else
   is kept of earlier steps. before: the kinetic energy, J, that the ledger has counted already; the
   rest counts as inserted. */
static void demi_body_start(dem_world *w, int i, const dem_real *v, const dem_real *spin,
                            double before) {
    const int fixed = w->bodies.inv_mass[i] <= 0;
    const demi_rail *rail = w->rail_count ? demi_rail_of(w, dem_body_id_get(w, i)) : 0;
    const int locked = rail ? rail->state.desc.axes : 0;
    dem_real *own = w->bodies.vel + 4*i, *turn = w->bodies.spin + 4*i;
    int k;
    for (k = 0; k < 3; k++) {
        if (fixed) own[k] = turn[k] = 0;
        if (v && !fixed && !(locked >> k & 1)) own[k] = v[k];
        if (spin && !fixed && !(locked >> (3 + k) & 1)) turn[k] = spin[k];
    }
    if (w->desc.planar) own[2] = turn[0] = turn[1] = 0;
    demi_put(w->bodies.half_vel + 4*i, demi_at(own));
    demi_put(w->bodies.half_spin + 4*i, demi_at(turn));
    if (w->bodies.orienting) demi_put(w->bodies.angular + 4*i, demi_angular_of(w, i));
    if (w->bodies.backward) w->bodies.went[i] = 0;
    if (w->bodies.booked) demi_put(w->bodies.late + 4*i, demi_v(0, 0, 0));
    w->booked.inserted += demi_body_energy(w, i) - before;
}
/* Fails and returns 1 if a position, velocity or spin in a row of arrays (count x 3; null: not
   given) is not finite or too large. body: the number that the message names. */
static int demi_motion_refuse(dem_world *w, const char *call, int body, int row, const dem_real *x,
                              const dem_real *v, const dem_real *spin) {
    static const char *const name[] = {"position", "velocity", "spin"},
        *const unit[] = {"m", "m/s", "rad/s"};
    const dem_real *given[3];
    int k;
    given[0] = x; given[1] = v; given[2] = spin;
    for (k = 0; k < 3; k++) {
        const dem_vec3 is = given[k] ? demi_at(given[k] + 3*row) : demi_v(0, 0, 0);
        if (demi_place(is)) continue;
        demi_refuse(w, call, "%s of body %d is (%g, %g, %g) %s, must be finite and at most %g %s; "
                    "check what it was computed from; nothing was changed", name[k], body,
                    (double)is.x, (double)is.y, (double)is.z, unit[k], DEMI_FARTHEST, unit[k]);
        return 1;
    }
    return 0;
}

DEM_API dem_result dem_spheres_add(dem_world *w, dem_material material, int count,
                                   const dem_real *positions,
                                   const dem_real *velocities, const dem_real *radii,
                                   dem_real radius) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    int i, m = 0;
    if (demi_material_index(w, __func__, material, &m) != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (count < 0 || (count > 0 && !positions))
        return demi_refuse(w, __func__, "count is %d, must be >= 0 with positions (count "
                           "x 3); check the caller's array", count);
    for (i = 0; i < count; i++) {
        if (demi_mass_refuse(w, __func__, m, -1, radii ? radii[i] : radius, i) ||
            demi_motion_refuse(w, __func__, i, i, positions, velocities, 0))
            return DEM_ERROR_ARGUMENT;
    }
    if (!demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)count) || !demi_list_drop(w))
        return demi_no_memory(w, __func__);
    for (i = 0; i < count; i++) {
        const uint32_t slot = demi_body_append(w, m, radii ? radii[i] : radius,
                                               demi_at(positions + 3*i));
        demi_body_start(w, w->bodies.slot_index[slot], velocities ? velocities + 3*i : 0, 0, 0);
    }
    demi_scene_changed(w);
    demi_built(w, __func__);
    return DEM_OK;
}

DEM_API dem_body dem_sphere_add(dem_world *w, dem_material material, dem_real radius,
                                dem_vec3 position) {
    if (demi_null(w, __func__, w, "world")) return demi_no_body;
    dem_body id;
    dem_real x[3];
    id.slot = id.generation = 0;
    demi_put(x, position);
    if (dem_spheres_add(w, material, 1, x, 0, 0, radius) != DEM_OK) return id;
    return dem_body_id_get(w, w->bodies.count - 1);
}

/* Returns 0 with an error message if an array for new bodies has a bad value. */
static int demi_bodies_check(dem_world *w, const char *call, int count, const dem_real *x,
                             const dem_real *q, const dem_real *v, const dem_real *spin) {
    int i;
    if (count < 0 || (count > 0 && !x)) {
        demi_refuse(w, call, "count is %d, must be >= 0 with positions (count x 3); check the "
                    "caller's array", count);
        return 0;
    }
    for (i = 0; i < count; i++) {
        const dem_quat o = q ? demi_quat_at(q + 4*i) : dem_quat_make(1, 0, 0, 0);
        if (demi_motion_refuse(w, call, i, i, x, v, spin)) return 0;
        if (!demi_quat_finite(o) || !(demi_quat_most(o) > 0)) {
            demi_refuse(w, call, "orientation of body %d is (%g, %g, %g, %g), must be finite and "
                        "not zero; (1, 0, 0, 0) is no rotation; no body was added", i, (double)o.w,
                        (double)o.x, (double)o.y, (double)o.z);
            return 0;
        }
    }
    return 1;
}
/* Adds bodies of a shape. All checks come first, then the allocations, then what cannot fail, so a
   call that fails adds no body. */
static dem_result demi_bodies_add(dem_world *w, const char *call, dem_material material,
                                  dem_shape shape, int count, const dem_real *positions,
                                  const dem_real *orientations, const dem_real *velocities,
                                  const dem_real *spins, const dem_real *scales) {
    int i, m = 0, f;
    if (demi_material_index(w, call, material, &m) != DEM_OK ||
        (f = demi_shape_index(w, call, shape)) < 0 ||
        !demi_bodies_check(w, call, count, positions, orientations, velocities, spins) ||
        demi_walls_strange(w, call, f))
        return DEM_ERROR_ARGUMENT;
    for (i = 0; i < count; i++)
        if (demi_mass_refuse(w, call, m, f, scales ? scales[i] : 1, i)) return DEM_ERROR_ARGUMENT;
    if (!demi_list_drop(w) || !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)count) ||
        !demi_orient_begin(w)) return demi_no_memory(w, call);
    for (i = 0; i < count; i++) {
        const uint32_t slot = demi_body_append(w, m, 1, demi_at(positions + 3*i));
        const int k = w->bodies.slot_index[slot];
        demi_body_shape(w, k, f, scales ? scales[i] : 1, orientations
                        ? demi_quat_unit(demi_quat_at(orientations + 4*i))
                        : dem_quat_make(1, 0, 0, 0));
        demi_body_start(w, k, velocities ? velocities + 3*i : 0, spins ? spins + 3*i : 0, 0);
    }
    demi_scene_changed(w);
    demi_built(w, call);
    return DEM_OK;
}
DEM_API dem_result dem_bodies_add(dem_world *w, dem_material material, dem_shape shape, int count,
                                  const dem_real *positions, const dem_real *orientations,
                                  const dem_real *velocities, const dem_real *spins,
                                  const dem_real *scales) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    return demi_bodies_add(w, __func__, material, shape, count, positions, orientations,
                           velocities, spins, scales);
}
DEM_API dem_body dem_body_add(dem_world *w, dem_material material, dem_shape shape,
                              dem_vec3 position, dem_quat orientation) {
    if (demi_null(w, __func__, w, "world")) return demi_no_body;
    dem_body id;
    dem_real x[3], q[4];
    id.slot = id.generation = 0;
    demi_put(x, position);
    demi_quat_put(q, orientation);
    if (demi_bodies_add(w, __func__, material, shape, 1, x, q, 0, 0, 0) != DEM_OK) return id;
    return dem_body_id_get(w, w->bodies.count - 1);
}

/* Returns the index of a body, or -1 with an error message. */
static int demi_body_index(dem_world *w, const char *call, dem_body b) {
    if (b.slot < 1 || b.slot > (uint32_t)w->bodies.slot_count ||
        w->bodies.slot_generation[b.slot - 1] != b.generation ||
        w->bodies.slot_index[b.slot - 1] < 0) {
        demi_refuse(w, call, "body %u (generation %u) does not exist; it was removed, has left the "
                    "domain, or was never added", (unsigned)b.slot, (unsigned)b.generation);
        return -1;
    }
    return w->bodies.slot_index[b.slot - 1];
}

/* Removes body i; the last body takes its index. The slot is not used again before the next rebuild
   (demi_slots_release), because filed contact history still refers to it. Its generation increases,
   so that old ids become invalid. */
static void demi_body_take_out(dem_world *w, int i) {
    const int last = w->bodies.count - 1, slot = (int)w->bodies.slot[i];
    if (demi_shape_of(w, i)) w->bodies.shaped--;
    if (i != last) {
        demi_body_copy(w, last, i);
        w->bodies.slot_index[w->bodies.slot[i]] = i;
    }
    w->bodies.slot_index[slot] = -2 - w->bodies.slot_pending;
    w->bodies.slot_pending = slot;
    w->bodies.slot_generation[slot]++;
    demi_lll_outdated(w);
    w->bodies.count = last;
    w->bodies.balance.present--;
}
/* The same for a body that leaves the scene. Books its energy, and counts it in *count. */
static void demi_body_lose(dem_world *w, int i, uint64_t *count) {
    w->booked.removed += demi_body_energy(w, i);
    demi_body_take_out(w, i);
    ++*count;
}

DEM_API dem_result dem_body_remove(dem_world *w, dem_body body) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    int i = demi_body_index(w, __func__, body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    if (!demi_list_drop(w)) return demi_no_memory(w, __func__);
    demi_body_lose(w, i, &w->bodies.balance.removed);
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_result dem_body_get(const dem_world *world, dem_body body, dem_body_state *s) {
    if (demi_null_look(world, __func__, s, "state")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;
    demi_periods p;
    int i = demi_body_index(w, __func__, body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    p = demi_periods_of(w);
    s->position = demi_place_of(&p, demi_at(w->bodies.pos + 4*i));
    s->velocity = demi_at(w->bodies.vel + 4*i);
    s->spin = demi_at(w->bodies.spin + 4*i);
    s->force = demi_at(w->bodies.force + 4*i);
    s->torque = demi_at(w->bodies.torque + 4*i);
    s->radius = demi_radius(w, i);
    s->mass = w->bodies.mass[i];
    s->moments = demi_moments_of(w, i);
    s->reals = w->bodies.real_count ? w->bodies.reals + w->bodies.real_count*i : 0;
    s->inertia = DEMI_MIN(s->moments.x, DEMI_MIN(s->moments.y, s->moments.z));
    s->material.id = w->bodies.material[i];
    s->fixed = w->bodies.inv_mass[i] <= 0;
    s->shape.id = w->bodies.orienting ? w->bodies.shape[i] : 0;
    s->orientation = dem_quat_make(1, 0, 0, 0);
    if (w->bodies.orienting) s->orientation = demi_quat_at(w->bodies.orient + 4*i);
    if (demi_shape_of(w, i))                     /* as the user gave it */
        s->orientation = dem_quat_multiply(s->orientation,
                                        demi_quat_conjugate(demi_shape_of(w, i)->frame));
    return DEM_OK;
}

DEM_API dem_result dem_body_set(dem_world *w, dem_body body, const dem_body_state *s) {
    if (demi_null(w, __func__, s, "state")) return DEM_ERROR_ARGUMENT;
    int i = demi_body_index(w, __func__, body);
    const demi_shape *shape;
    const dem_quat q = s->orientation;
    dem_real x[3], v[3], spin[3];
    double before, m;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    shape = demi_shape_of(w, i);
    if (w->bodies.orienting && (!demi_quat_finite(q) || !(demi_quat_most(q) > 0)))
        return demi_refuse(w, __func__, "orientation of body %u is (%g, %g, %g, %g), must be "
                           "finite and not zero; fill the state with dem_body_get first",
                           (unsigned)body.slot, (double)q.w, (double)q.x, (double)q.y, (double)q.z);
    demi_put(x, s->position);
    demi_put(v, s->velocity);
    demi_put(spin, s->spin);
    if (demi_motion_refuse(w, __func__, (int)body.slot, 0, x, v, spin)) return DEM_ERROR_ARGUMENT;
    if (!demi_list_drop(w)) return demi_no_memory(w, __func__);
    before = demi_body_energy(w, i);
    m = (double)w->bodies.mass[i];
    demi_put(w->bodies.pos + 4*i, s->position);
    if (w->desc.planar) w->bodies.pos[4*i + 2] = 0;
    w->bodies.inv_mass[i] = s->fixed ? 0 : (dem_real)(1/m);
    w->bodies.inv_inertia[i] = s->fixed || shape ? 0 : (dem_real)(1/demi_sphere_inertia(w, m,
        (double)demi_radius(w, i)));
    if (w->bodies.orienting)
        demi_quat_put(w->bodies.orient + 4*i,
                      demi_quat_unit(shape ? dem_quat_multiply(w->desc.planar ? demi_quat_flat(q)
                                                               : q, shape->frame) : q));
    demi_body_start(w, i, v, spin, before);
    demi_scene_changed(w);
    return DEM_OK;
}

/* Returns the granular temperature of the bodies that can move, m2/s2: the mass-weighted variance
   of velocity per axis. Also gives their mass, kg, number and mean velocity, m/s. */
static double demi_temperature(const dem_world *w, double *mass, int *count, double *mean) {
    const int axes = w->desc.planar ? 2 : 3;
    double sum = 0, rest;
    int pass, i, k;
    *mass = 0;
    *count = 0;
    memset(mean, 0, 3*sizeof *mean);
    for (pass = 0; pass < 2; pass++)
        for (i = 0; i < w->bodies.slot_count; i++) {      /* by slot: independent of the order */
            const int b = w->bodies.slot_index[i];
            const double m = b < 0 ? 0 : (double)w->bodies.mass[b];
            if (b < 0 || !(w->bodies.inv_mass[b] > 0)) continue;
            if (!pass) { *mass += m; ++*count; }
            for (k = 0; k < axes; k++) {
                const double v = (double)w->bodies.vel[4*b + k];
                if (!pass) mean[k] += m*v;
                else sum += m*(v - mean[k]/ *mass)*(v - mean[k]/ *mass);
            }
        }
    for (k = 0; k < 3 && *mass > 0; k++) mean[k] /= *mass;
    if (*count < 2) return 0;
    sum /= axes* *mass;
    rest = mean[0]*mean[0] + mean[1]*mean[1] + mean[2]*mean[2];
    /* 0 if the velocities are equal up to round-off */
    return sum > 1e-12*DEMI_SINGLE*rest + 1e-28*rest ? sum : 0;
}
DEM_API double dem_temperature_get(const dem_world *w) {
    double mass, mean[3];
    int count;
    if (demi_null_look(w, __func__, w, "world")) return 0;
    return demi_temperature(w, &mass, &count, mean);
}
DEM_API dem_result dem_temperature_set(dem_world *w, double temperature, uint64_t seed) {
    const int axes = w && w->desc.planar ? 2 : 3;
    double mass, mean[3], drawn[3], was;
    int count, i, k, pass;
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    was = demi_temperature(w, &mass, &count, mean);
    if (!(temperature >= 0) || !demi_finite_double(temperature) || count < 2 ||
        (!seed && temperature > 0 && !(was > 0)))
        return demi_refuse(w, __func__, "temperature is %g m2/s2, for %d bodies that "
                           "can move and have %g m2/s2 now; it must be finite and >= 0, for two "
                           "bodies at least, and bodies at rest have no velocities to scale: give "
                           "a seed to draw velocities", temperature, count, was);
    if (!demi_list_drop(w)) return demi_no_memory(w, __func__);
    /* pass 0, with a seed: draws velocities; pass 1: scales them */
    for (pass = seed ? 0 : 1; pass < 2; pass++) {
        double now = demi_temperature(w, &mass, &count, drawn), scale;
        scale = now > 0 ? sqrt(temperature/now) : 0;
        for (i = 0; i < w->bodies.slot_count; i++) {
            const int b = w->bodies.slot_index[i];
            dem_real v[3];
            double before;
            if (b < 0 || !(w->bodies.inv_mass[b] > 0)) continue;
            before = demi_body_energy(w, b);
            demi_put(v, demi_at(w->bodies.vel + 4*b));
            for (k = 0; k < axes; k++)
                v[k] = pass ? (dem_real)(mean[k] + scale*((double)v[k] - drawn[k]))
                    : (dem_real)(demi_gauss(&seed)/sqrt((double)w->bodies.mass[b]));
            demi_body_start(w, b, v, 0, before);
        }
    }
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_bodies dem_bodies_get(const dem_world *w) {
    dem_bodies b;
    memset(&b, 0, sizeof b);
    if (!w) return b;
    b.count = w->bodies.count;
    b.positions = demi_wrapped(w);
    b.velocities = w->bodies.vel;
    b.spins = w->bodies.spin;
    b.forces = w->bodies.force;
    b.torques = w->bodies.torque;
    b.masses = w->bodies.mass; b.slots = w->bodies.slot; b.materials = w->bodies.material;
    b.orientations = w->bodies.orient;
    b.shapes = w->bodies.shape;
    b.real_count = w->bodies.real_count;
    b.reals = w->bodies.reals;
    b.rates = w->bodies.rates;
    b.groups = w->bodies.groups;
    return b;
}
/* Fails if bodies have no user-defined numbers, or, with `setting`, if a number is not finite. */
static dem_result demi_reals_ask(const dem_world *world, const char *call, const dem_real *reals,
                                 int count, int setting) {
    dem_world *w = (dem_world *)world;
    int k;
    if (setting ? demi_null(w, call, reals, "reals") : demi_null_look(w, call, reals, "reals"))
        return DEM_ERROR_ARGUMENT;
    if (!w->bodies.real_count)
        return demi_refuse(w, call, "bodies carry no user-defined numbers; name the numbers in "
                           "desc.body_reals when the world is created");
    for (k = 0; setting && k < count*w->bodies.real_count; k++)
        if (!demi_finite(reals[k]))
            return demi_refuse(w, call, "number %d is %g, must be finite; check what it was "
                               "computed from", k, (double)reals[k]);
    return DEM_OK;
}
DEM_API dem_result dem_body_reals_get(const dem_world *w, dem_body body, dem_real *reals) {
    const dem_result result = demi_reals_ask(w, __func__, reals, 1, 0);
    int i;
    if (result != DEM_OK) return result;
    i = demi_body_index((dem_world *)w, __func__, body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    memcpy(reals, w->bodies.reals + w->bodies.real_count*i,
           (size_t)w->bodies.real_count*sizeof *reals);
    return DEM_OK;
}
DEM_API dem_result dem_body_reals_set(dem_world *w, dem_body body, const dem_real *reals) {
    const dem_result result = demi_reals_ask(w, __func__, reals, 1, 1);
    int i;
    if (result != DEM_OK) return result;
    i = demi_body_index(w, __func__, body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    memcpy(w->bodies.reals + w->bodies.real_count*i, reals,
           (size_t)w->bodies.real_count*sizeof *reals);
    return DEM_OK;
}
DEM_API dem_result dem_bodies_reals_set(dem_world *w, const dem_real *reals) {
    const dem_result result = demi_reals_ask(w, __func__, reals, w ? w->bodies.count : 0, 1);
    if (result != DEM_OK) return result;
    if (w->bodies.count)
        memcpy(w->bodies.reals, reals,
               (size_t)(w->bodies.count*w->bodies.real_count)*sizeof *reals);
    return DEM_OK;
}
DEM_API dem_body dem_body_id_get(const dem_world *w, int index) {
    if (demi_null_look(w, __func__, w, "world")) return demi_no_body;
    dem_body id;
    id.slot = id.generation = 0;
    if (index < 0 || index >= w->bodies.count) return id;
    id.slot = w->bodies.slot[index] + 1;
    id.generation = w->bodies.slot_generation[w->bodies.slot[index]];
    return id;
}
DEM_API dem_body_counts dem_body_counts_get(const dem_world *w) {
    dem_body_counts none;
    memset(&none, 0, sizeof none);
    return w ? w->bodies.balance : none;
}
/* Returns the index of the body with this id, or -1 if it does not exist (any more). */
static int demi_body_find(const dem_world *w, dem_body b) {
    if (b.slot < 1 || b.slot > (uint32_t)w->bodies.slot_count ||
        w->bodies.slot_generation[b.slot - 1] != b.generation) return -1;
    return DEMI_MAX(w->bodies.slot_index[b.slot - 1], -1);
}
/* True if a joint without `collide` connects bodies a and b (b < 0: body a and the wall), so that
   they have no contact. Needs no solver; demi_joined is faster within a step. */
static int demi_parted(const dem_world *w, int a, int b, int wall) {
    int k, found = 0;
    for (k = 0; k < w->joint_count && !found; k++) {
        const dem_joint_desc *j = &w->joints[k].desc;
        const int p = demi_body_find(w, j->a), q = j->b.slot ? demi_body_find(w, j->b) : -1;
        found = !j->collide && (b < 0 ? p == a && !j->b.slot && j->wall.id == w->walls[wall].id
                                : (p == a && q == b) || (p == b && q == a));
    }
    return found;
}
