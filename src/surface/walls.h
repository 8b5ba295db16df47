/* ---------------------------------------------------------------------------------------------
   >>walls
   Walls: rigid surfaces. A wall consists of elements in a frame of its own and of a motion that
   moves this frame. A wall of many elements has a grid of them in its frame, so the cost of finding
   those near a grain does not depend on their number. Planes and cylinders are one infinite element
   each. Each kind of wall is a row of DEMI_WALLS in >>layout.
   --------------------------------------------------------------------------------------------- */
/* Pointers to the arrays that a wall owns. These are freed, and copied into slabs. */
#define DEMI_WALL_ARRAYS(wall) {&(wall)->vertices, &(wall)->corners, &(wall)->edges, \
    &(wall)->weight, &(wall)->owns, &(wall)->ends, &(wall)->sheet, &(wall)->borders, \
    &(wall)->planes, &(wall)->whose, &(wall)->cell_start, &(wall)->cell_items, \
    &(wall)->motion.table}
/* Frees the arrays of a wall and clears it: it is then a removed wall. */
static void demi_wall_free(dem_world *w, demi_wall *wall) {
    void *places[] = DEMI_WALL_ARRAYS(wall), *data;
    size_t k;
    for (k = 0; k < sizeof places/sizeof *places; k++) {
        memcpy(&data, places[k], sizeof data);
        if (demi_owns(w, wall->chain, data)) demi_free(w, data);    /* a trial copy does not own
                                                                       it */
    }
    memset(wall, 0, sizeof *wall);
}
/* Replaces the arrays that a wall shares with another one by copies. Returns 0 if memory ran out;
   the wall then has no arrays. */
static int demi_wall_own(dem_world *w, demi_wall *wall) {
    void *places[] = DEMI_WALL_ARRAYS(wall), *data, *copy;
    size_t k;
    int ok = 1;
    for (k = 0; k < sizeof places/sizeof *places; k++) {
        memcpy(&data, places[k], sizeof data);
        copy = data ? demi_hold(w, wall->chain, demi_room(data, 1), 1) : 0;
        ok = ok && !copy == !data;
        if (copy) memcpy(copy, data, demi_room(data, 1));
        memcpy(places[k], &copy, sizeof copy);
    }
    if (!ok) demi_wall_free(w, wall);
    return ok;
}

/* Returns a digest of the table of a wall's motion. */
static uint64_t demi_digest_table(const void *item) {
    const dem_motion *m = &((const demi_wall *)item)->motion;
    uint64_t h = DEMI_HASH_START;
    int k;
    for (k = 0; demi_tabled(m) && k < m->table_count; k++) {
        h = demi_hash(h, &m->table[k].time, sizeof m->table->time);
        h = demi_hash(h, &m->table[k].position, sizeof m->table->position);
        h = demi_hash(h, &m->table[k].rotation, sizeof m->table->rotation);
        if (m->kind == DEM_MOTION_SERVO) h = demi_hash(h, &m->table[k].load, sizeof m->table->load);
    }
    return h;
}
/* Bound on the rounding error of a difference of vectors of such a length. */
static dem_real demi_rounding(dem_real length) {
    return 8*(DEMI_SINGLE ? (dem_real)FLT_EPSILON : (dem_real)DBL_EPSILON)*length;
}
/* True if two vectors are equal, but for rounding errors. */
static int demi_vectors_alike(dem_vec3 a, dem_vec3 b) {
    return demi_length(demi_sub(a, b)) <= demi_rounding(demi_length(a));
}
static int demi_equal(double a, double b) { return !(a < b) && !(a > b); }
/* True if a motion may rotate its wall. */
static int demi_motion_turns(const dem_motion *m) {
    int k, turns = m->kind == DEM_MOTION_ROTATING;
    for (k = 0; k < m->table_count && m->kind == DEM_MOTION_TABLE; k++)
        turns |= DEMI_ABS(m->table[k].rotation.w) < 1;
    return turns;
}
/* True if the tables of two walls have the same rows and, if a row rotates the walls, the same
   point. */
static int demi_tables_alike(const demi_wall *a, const demi_wall *b) {
    const dem_motion *m = &a->motion, *o = &b->motion;
    if (m->table_count != o->table_count || m->table_repeats != o->table_repeats) return 0;
    return (!demi_motion_turns(m) || demi_vectors_alike(m->point, o->point)) &&
        demi_digest_table(a) == demi_digest_table(b);
}
/* True if two walls are moved alike, so that they are at rest relative to each other at all times:
   both are fixed, or have equal motions that start together. */
static int demi_walls_alike(const demi_wall *a, const demi_wall *b) {
    const dem_motion *m = &a->motion, *o = &b->motion;
    const dem_vec3 turns = demi_scale(demi_unit(m->axis), m->speed);
    if (a == b) return 1;
    if (m->kind != o->kind || m->kind == DEM_MOTION_USER) return 0;
    if (m->kind == DEM_MOTION_FIXED) return 1;
    if (!demi_equal(m->start, o->start)) return 0;
    if (m->kind == DEM_MOTION_TABLE) return demi_tables_alike(a, b);
    if (!demi_equal(m->ramp, o->ramp)) return 0;
    switch (m->kind) {
    case DEM_MOTION_ROTATING:
        return demi_vectors_alike(turns, demi_scale(demi_unit(o->axis), o->speed)) &&
            demi_length(demi_cross(demi_unit(m->axis), demi_sub(m->point, o->point))) <=
            demi_rounding(demi_length(m->point) + demi_length(o->point));
    case DEM_MOTION_OSCILLATING:
        return demi_vectors_alike(demi_scale(demi_unit(m->velocity), m->amplitude),
                                  demi_scale(demi_unit(o->velocity), o->amplitude)) &&
            demi_equal((double)m->frequency, (double)o->frequency) &&
            demi_equal((double)m->phase, (double)o->phase);
    case DEM_MOTION_SERVO:
        if (!demi_equal((double)m->load, (double)o->load) ||
            !demi_equal((double)m->area, (double)o->area) ||
            !demi_equal((double)m->travel, (double)o->travel) || !demi_tables_alike(a, b))
            return 0;
    /* fall through */
    default: return demi_vectors_alike(m->velocity, o->velocity);
    }
}
/* True if a wall has a motion that has not begun at a time, s, and until then leaves the wall where
   it was set. */
static int demi_wall_waits(const demi_wall *wall, double time) {
    const dem_motion *m = &wall->motion;
    if (m->kind == DEM_MOTION_FIXED || m->kind == DEM_MOTION_USER || !(time < m->start)) return 0;
    return m->kind != DEM_MOTION_TABLE || (!(demi_size(m->table->position) > 0) &&
                                           !(DEMI_ABS(m->table->rotation.w) < 1));
}
/* True if a wall is where it was when its motion was set, and does not move: it is fixed, its
   motion has not begun (wall->idle), or its speed is 0. */
static int demi_wall_rests(const demi_wall *wall) {
    const dem_motion *m = &wall->motion;
    switch (m->kind) {
    case DEM_MOTION_FIXED: return 1;
    case DEM_MOTION_TRANSLATING: return wall->idle || !(demi_size(m->velocity) > 0);
    case DEM_MOTION_ROTATING: return wall->idle || !(DEMI_ABS(m->speed) > 0);
    case DEM_MOTION_OSCILLATING: return wall->idle || !(DEMI_ABS(m->amplitude) > 0);
    default: return wall->idle;
    }
}
/* True if two walls are at rest relative to each other. */
static int demi_walls_together(const demi_wall *a, const demi_wall *b) {
    return (demi_wall_rests(a) && demi_wall_rests(b)) || demi_walls_alike(a, b);
}
/* True if wall `place` is at rest relative to the same other walls when it becomes `next`, and the
   surface that it is part of remains as it is. */
static int demi_wall_remains(const dem_world *w, const demi_wall *next, int place) {
    const demi_wall *wall = &w->walls[place];
    const int rests = demi_wall_rests(wall) && demi_wall_rests(next);
    int i;
    for (i = 0; i < w->wall_count; i++)
        if (i != place && w->walls[i].kind != DEMI_WALL_NONE &&
            (demi_walls_together(&w->walls[i], wall) ? !rests
             : demi_walls_together(&w->walls[i], next))) return 0;
    return 1;
}
/* Called when a wall is added, removed or moved otherwise. Surfaces are made again (>>surfaces),
   and the numbers of their features change: contacts are followed by direction once. */
static void demi_surfaces_outdated(dem_world *w) {
    int d, k;
    demi_facets_outdated(w);
    for (d = 0; d < DEMI_DOMAINS; d++)
        for (k = 0; k < w->domains[d].persistent; k++) {
            demi_persistent *c = demi_persistent_of(w, d) + k;
            if (c->b < 0 && demi_faceted(&w->walls[c->wall])) c->element = -1;
        }
}
/* Returns the number of corners of an element and writes their coordinates. */
static int demi_wall_corners(const demi_wall *wall, int element, dem_vec3 *out) {
    const int n = demi_wall_per(wall);
    int k;
    for (k = 0; k < n; k++)
        out[k] = demi_at(wall->vertices + 3*(wall->corners ? wall->corners[n*element + k]
                                             : element));
    return n;
}

/* Writes the range of cells of the element grid that a box touches. */
static void demi_wall_cells(const demi_wall *wall, dem_vec3 lo, dem_vec3 hi, int *first,
                            int *last) {
    double a[3], b[3], o[3];
    int k;
    a[0] = (double)lo.x; a[1] = (double)lo.y; a[2] = (double)lo.z;
    b[0] = (double)hi.x; b[1] = (double)hi.y; b[2] = (double)hi.z;
    o[0] = (double)wall->box.lo.x; o[1] = (double)wall->box.lo.y; o[2] = (double)wall->box.lo.z;
    for (k = 0; k < 3; k++) {
        const double f = floor((a[k] - o[k])/(double)wall->cell);
        const double l = floor((b[k] - o[k])/(double)wall->cell);
        first[k] = f < 0 ? 0 : f > wall->cells[k] ? wall->cells[k] : (int)f;
        last[k] = l >= wall->cells[k] ? wall->cells[k] - 1 : l < -1 ? -1 : (int)l;
    }
}

/* Returns the box of an element; grains of a wall extend it by their radius. */
static dem_box demi_wall_element_box(const demi_wall *wall, int element) {
    const dem_real pad = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : 0;
    dem_vec3 c[3];
    dem_box box;
    int k, n;
    c[0] = demi_v(0, 0, 0);
    n = demi_wall_corners(wall, element, c);
    box.lo = box.hi = c[0];
    for (k = 1; k < n; k++) {
        box.lo = demi_v(DEMI_MIN(box.lo.x, c[k].x), DEMI_MIN(box.lo.y, c[k].y),
                        DEMI_MIN(box.lo.z, c[k].z));
        box.hi = demi_v(DEMI_MAX(box.hi.x, c[k].x), DEMI_MAX(box.hi.y, c[k].y),
                        DEMI_MAX(box.hi.z, c[k].z));
    }
    box.lo = demi_sub(box.lo, demi_v(pad, pad, pad));
    box.hi = demi_add(box.hi, demi_v(pad, pad, pad));
    return box;
}
/* Sets the box of all elements, and their largest distance from the origin of the frame. */
static void demi_wall_bounds(demi_wall *wall) {
    const dem_real pad = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : 0;
    dem_real extent = 0;
    int i;
    wall->box = demi_wall_element_box(wall, 0);
    for (i = 1; i < wall->element_count; i++) {
        const dem_box b = demi_wall_element_box(wall, i);
        wall->box.lo = demi_v(DEMI_MIN(wall->box.lo.x, b.lo.x), DEMI_MIN(wall->box.lo.y, b.lo.y),
                              DEMI_MIN(wall->box.lo.z, b.lo.z));
        wall->box.hi = demi_v(DEMI_MAX(wall->box.hi.x, b.hi.x), DEMI_MAX(wall->box.hi.y, b.hi.y),
                              DEMI_MAX(wall->box.hi.z, b.hi.z));
    }
    for (i = 0; i < wall->vertex_count; i++)
        extent = DEMI_MAX(extent, demi_length(demi_at(wall->vertices + 3*i)) + pad);
    wall->extent = extent;
}
/* Chooses the cell size of the element grid: the size of the mean element, so that each is in few
   cells, or less if elements are long and thin; then larger until there are not too many cells and
   entries. */
static void demi_wall_cells_choose(demi_wall *wall) {
    const dem_vec3 size = demi_sub(wall->box.hi, wall->box.lo);
    const double volume = (double)size.x*(double)size.y*(double)size.z, n = wall->element_count;
    double extent = 0, mean, fine, entries;
    int i, k, f[3], l[3];
    for (i = 0; i < wall->element_count; i++) {
        dem_vec3 c[3];
        const int corners = demi_wall_corners(wall, i, c);
        for (k = 1; k < corners; k++)
            extent += (double)demi_length(demi_sub(c[k], c[0]))/(corners - 1);
        if (corners == 1) extent += 2*(double)wall->radius;
    }
    mean = extent/n;
    fine = volume > 0 ? demi_cube_root(volume/(16*n)) : mean;
    wall->cell = (dem_real)DEMI_MAX(DEMI_MIN(mean, fine), 1e-6*(double)demi_length(size));
    for (;; wall->cell *= DEM_R(1.26)) {
        wall->cells[0] = (int)DEMI_MIN(size.x/wall->cell, DEM_R(1e6)) + 1;
        wall->cells[1] = (int)DEMI_MIN(size.y/wall->cell, DEM_R(1e6)) + 1;
        wall->cells[2] = (int)DEMI_MIN(size.z/wall->cell, DEM_R(1e6)) + 1;
        if ((double)wall->cells[0]*wall->cells[1]*wall->cells[2] > 32*n + 64) continue;
        for (i = 0, entries = 0; i < wall->element_count; i++) {
            const dem_box b = demi_wall_element_box(wall, i);
            demi_wall_cells(wall, b.lo, b.hi, f, l);
            entries += (double)(l[0] - f[0] + 1)*(l[1] - f[1] + 1)*(l[2] - f[2] + 1);
        }
        if (entries <= 48*n + 64) return;
    }
}
/* Builds the grid of a wall's elements. Returns 0 if memory ran out. */
static int demi_wall_index(dem_world *w, demi_wall *wall) {
    int i, n, pass, x, y, z, f[3], l[3];
    if (wall->element_count <= 4) return 1;     /* a few: all are examined */
    demi_wall_cells_choose(wall);
    n = wall->cells[0]*wall->cells[1]*wall->cells[2];
    wall->cell_start = (int32_t *)demi_hold(w, wall->chain, (size_t)n + 1, sizeof(int32_t));
    if (!wall->cell_start) return 0;
    for (pass = 0; pass < 2; pass++) {          /* count, then fill from the back */
        for (i = wall->element_count - 1; i >= 0; i--) {
            const dem_box b = demi_wall_element_box(wall, i);
            demi_wall_cells(wall, b.lo, b.hi, f, l);
            for (z = f[2]; z <= l[2]; z++)
                for (y = f[1]; y <= l[1]; y++)
                    for (x = f[0]; x <= l[0]; x++) {
                        int32_t *slot = &wall->cell_start[x +
                                                          wall->cells[0]*(y + wall->cells[1]*z)];
                        if (pass == 0) ++*slot; else wall->cell_items[--*slot] = i;
                    }
        }
        if (pass == 0) {
            for (i = 1; i <= n; i++) wall->cell_start[i] += wall->cell_start[i - 1];
            wall->cell_item_count = wall->cell_start[n];
            wall->cell_items = (int32_t *)demi_hold(w, wall->chain, (size_t)wall->cell_item_count,
                                                     sizeof(int32_t));
            if (!wall->cell_items) return 0;
        }
    }
    return 1;
}

/* Returns the index for one more wall: the first that a removed wall has left and whose ids are not
   used up, otherwise a new one. */
static int demi_wall_vacant(const dem_world *w) {
    int i;
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind == DEMI_WALL_NONE && w->walls[i].id <= INT32_MAX - DEMI_WALLS_MOST)
            return i;
    return i;
}
/* The id of the next wall at this index. */
static dem_wall demi_wall_next(const dem_world *w, int place) {
    dem_wall id;
    id.id = place < w->wall_count && w->walls[place].id ? w->walls[place].id + DEMI_WALLS_MOST
                                                        : place + 1;
    return id;
}
/* Adds a prepared wall, which then belongs to the world, and returns its id; or frees it and
   returns id 0 with an error message. */
static dem_wall demi_wall_enter(dem_world *w, const char *call, demi_wall *wall) {
    dem_wall id;
    int i;
    id.id = 0;
    for (i = 0; i < w->bodies.count && w->bodies.shaped; i++) {
        const int part = demi_shape_strange(w, wall, demi_shape_of(w, i));
        if (part < 0) continue;
        demi_strangers(w, call, wall, (int)demi_wall_next(w, demi_wall_vacant(w)).id,
                       (int)w->bodies.slot[i], part);
        demi_wall_free(w, wall);
        return id;
    }
    for (i = 0; i < w->feed_count*DEM_CLASSES; i++) {       /* also those that feeds will insert */
        const dem_feed_desc *feed = &w->feeds[i/DEM_CLASSES].desc;
        const int used = i%DEM_CLASSES < feed->class_count;
        const int shape = used ? feed->shapes[i%DEM_CLASSES].id : 0;
        const int part = demi_shape_strange(w, wall, shape ? &w->shapes[shape - 1] : 0);
        if (part < 0) continue;
        demi_strangers(w, call, wall, (int)demi_wall_next(w, demi_wall_vacant(w)).id, -1, part);
        demi_wall_free(w, wall);
        return id;
    }
    i = demi_wall_vacant(w);
    if (i == DEMI_WALLS_MOST || !DEMI_GROW(w, w->walls, (size_t)i + 1) || !demi_list_drop(w)) {
        demi_wall_free(w, wall);
        if (i == DEMI_WALLS_MOST)
            demi_refuse(w, call, "a world holds at most %d walls; put several surfaces into one "
                        "mesh", (int)DEMI_WALLS_MOST);
        else demi_no_memory(w, call);
        return id;
    }
    id = demi_wall_next(w, i);
    w->walls[i] = *wall;
    w->walls[i].id = id.id;
    w->wall_count = DEMI_MAX(w->wall_count, i + 1);
    demi_surfaces_outdated(w);
    demi_built(w, call);
    demi_scene_changed(w);
    return id;
}
/* Removes the wall that was added last; the world is as it was before. */
static void demi_wall_leave(dem_world *w, dem_wall wall) {
    const int place = demi_wall_place(wall);
    demi_wall_free(w, &w->walls[place]);
    if (wall.id > DEMI_WALLS_MOST) w->walls[place].id = wall.id - DEMI_WALLS_MOST;
    else w->wall_count = place;
}
/* Adds a wall at rest in its first pose. */
static dem_wall demi_wall_adopt(dem_world *w, const char *call, demi_wall *wall) {
    wall->pose = wall->mid = wall->ahead = wall->was = wall->first = wall->home;
    return demi_wall_enter(w, call, wall);
}

/* Initialises what all kinds of walls have. Returns 0 with an error message if there is no such
   material. */
static int demi_wall_begin(dem_world *w, const char *call, dem_material material, int kind,
                           demi_wall *wall) {
    memset(wall, 0, sizeof *wall);
    demi_pose_identity(&wall->home);
    wall->kind = kind;
    wall->share = 1;
    wall->chain = DEMI_SCENE;
    wall->symmetric = 1;                        /* until it moves */
    return demi_material_index(w, call, material, &wall->material) == DEM_OK &&
        !(w->cell.on && demi_cell_bars(w, call, DEMI_CELL_WALLS));
}

DEM_API dem_wall dem_wall_plane_add(dem_world *w, dem_material material, dem_vec3 point,
                               dem_vec3 normal) {
    if (demi_null(w, __func__, w, "world")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, __func__, material, DEMI_WALL_PLANE, &wall)) return none;
    if (!demi_place(point) || !demi_finite3(normal) || !(demi_size(normal) > 0)) {
        demi_refuse(w, __func__, "normal is (%g, %g, %g), must be finite and not zero; "
                    "point is (%g, %g, %g) m, must be within %g m of the origin", (double)normal.x,
                    (double)normal.y, (double)normal.z, (double)point.x, (double)point.y,
                    (double)point.z, DEMI_FARTHEST);
        return none;
    }
    wall.element_count = 1;
    wall.home.position = point;
    wall.motion.point = point;
    wall.motion.axis = demi_unit(normal);
    demi_frame_of(wall.home.rotation, demi_unit(normal));
    wall.extent = -1;
    return demi_wall_adopt(w, __func__, &wall);
}

DEM_API dem_wall dem_wall_cylinder_add(dem_world *w, dem_material material, dem_vec3 point,
                                  dem_vec3 axis,
                                  dem_real radius, int inside) {
    if (demi_null(w, __func__, w, "world")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, __func__, material, DEMI_WALL_CYLINDER, &wall)) return none;
    if (!demi_place(point) || !demi_finite3(axis) || !(demi_dot(axis, axis) > 0) ||
        !(radius > 0) || !demi_bounded((double)radius)) {
        demi_refuse(w, __func__, "radius is %g m and axis is (%g, %g, %g); the "
                    "radius must be > 0, the axis not zero, the radius and the coordinates of the "
                    "point at most %g m", (double)radius, (double)axis.x, (double)axis.y,
                    (double)axis.z, DEMI_FARTHEST);
        return none;
    }
    wall.element_count = 1;
    wall.radius = radius;
    wall.inside = inside != 0;
    wall.home.position = point;
    wall.motion.point = point;
    wall.motion.axis = demi_unit(axis);
    demi_frame_of(wall.home.rotation, demi_unit(axis));
    wall.extent = -1;
    return demi_wall_adopt(w, __func__, &wall);
}

/* dem_wall_revolved_add on behalf of `call`. */
static dem_wall demi_revolved_make(dem_world *w, const char *call, dem_material material,
                                   dem_vec3 point, dem_vec3 axis, int count,
                                   const dem_real *radii, const dem_real *heights) {
    demi_wall wall;
    int k, bad = -1;
    if (!demi_wall_begin(w, call, material, DEMI_WALL_REVOLVED, &wall)) return demi_no_wall;
    if (count < 2 || count > DEM_RINGS || !demi_place(point) || !demi_finite3(axis) ||
        !(demi_dot(axis, axis) > 0)) {
        demi_refuse(w, call, "count is %d and axis is (%g, %g, %g); there must be 2 to %d rings, "
                    "the axis must not be zero, the point must be finite", count, (double)axis.x,
                    (double)axis.y, (double)axis.z, (int)DEM_RINGS);
        return demi_no_wall;
    }
    for (k = 0; k < count && bad < 0; k++) {
        const dem_real r = radii[k], h = heights[k];
        if (!(r >= 0) || !demi_finite(r) || !demi_finite(h) || !((double)r < DEMI_FARTHEST) ||
            !(fabs((double)h) < DEMI_FARTHEST)) bad = k;
        else if (k && !(demi_size(demi_v(r - radii[k - 1], h - heights[k - 1], 0)) > DEMI_LEAST))
            bad = k;
        else if (k && !(r > 0) && !(radii[k - 1] > 0)) bad = k;
        wall.ring_radius[k] = r;
        wall.ring_height[k] = h;
        wall.radius = DEMI_MAX(wall.radius, r);
        wall.extent = DEMI_MAX(wall.extent, DEMI_SQRT(r*r + h*h));
    }
    if (bad >= 0) {
        demi_refuse(w, call, "ring %d has radius %g m at height %g m; both must be finite, the "
                    "radius >= 0, not 0 for two rings in a row, and no ring equal to the one "
                    "before", bad, (double)radii[bad], (double)heights[bad]);
        return demi_no_wall;
    }
    wall.ring_count = count;
    wall.open = (radii[0] > 0 || radii[count - 1] > 0) &&
        demi_size(demi_v(radii[0] - radii[count - 1], heights[0] - heights[count - 1], 0)) > 0;
    wall.element_count = 1;
    wall.home.position = wall.motion.point = point;
    wall.motion.axis = demi_unit(axis);
    demi_frame_of(wall.home.rotation, wall.motion.axis);
    return demi_wall_adopt(w, call, &wall);
}
DEM_API dem_wall dem_wall_revolved_add(dem_world *w, dem_material material, dem_vec3 point,
                                  dem_vec3 axis, int count, const dem_real *radii,
                                  const dem_real *heights) {
    if (demi_null(w, __func__, radii, "radii") ||
        demi_null(w, __func__, heights, "heights")) return demi_no_wall;
    return demi_revolved_make(w, __func__, material, point, axis, count, radii, heights);
}
DEM_API dem_wall dem_wall_cone_add(dem_world *w, dem_material material, dem_vec3 from, dem_vec3 to,
                              dem_real radius_from, dem_real radius_to) {
    const dem_vec3 way = demi_sub(to, from);
    dem_real radii[2], heights[2];
    if (demi_null(w, __func__, w, "world")) return demi_no_wall;
    radii[0] = radius_from;
    radii[1] = radius_to;
    heights[0] = 0;
    heights[1] = demi_length(way);
    return demi_revolved_make(w, __func__, material, from, way, 2, radii, heights);
}
/* Number of flat sides that a surface of revolution has in pictures. */
enum { DEMI_RING_SIDES = 48 };
static void demi_ring_corner(const demi_wall *wall, int ring, int side, dem_real *out) {
    const double a = 2*DEMI_PI*side/(int)DEMI_RING_SIDES, r = (double)wall->ring_radius[ring];
    out[0] = (dem_real)(r*demi_cos(a));
    out[1] = (dem_real)(r*demi_sin(a));
    out[2] = wall->ring_height[ring];
}
/* Corner c of triangle t (two per side and piece) of such a picture: ring*SIDES + side. */
static int demi_ring_triangle(int t, int c) {
    const int side = t/2%DEMI_RING_SIDES, piece = t/2/DEMI_RING_SIDES, next = side + 1;
    const int a = piece*DEMI_RING_SIDES + side, b = piece*DEMI_RING_SIDES + next%DEMI_RING_SIDES;
    if (t & 1) return c == 0 ? b : c == 1 ? b + DEMI_RING_SIDES : a + DEMI_RING_SIDES;
    return c == 0 ? a : c == 1 ? b : a + DEMI_RING_SIDES;
}

/* Copies vertices (dimension `per_vertex`) and corners into a wall and prepares its facets and
   grid. Returns 0 with an error message if they are invalid or memory ran out. */
static int demi_wall_load(dem_world *w, const char *call, demi_wall *wall, int vertices,
                          const dem_real *xyz,
                          int per_vertex, int elements, const int32_t *corners, int per_element) {
    int i, k;
    if (!demi_mesh_sound(w, call, vertices, xyz, per_vertex, elements, corners, per_element))
        return 0;
    wall->vertex_count = vertices;
    wall->element_count = elements;
    wall->vertices = (dem_real *)demi_hold(w, DEMI_SCENE, (size_t)vertices*3, sizeof(dem_real));
    if (per_element) wall->corners = (int32_t *)demi_hold(w, DEMI_SCENE,
                                                           (size_t)elements*(size_t)per_element,
                                                           sizeof(int32_t));
    if (!wall->vertices || (per_element && !wall->corners)) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return 0;
    }
    for (i = 0; i < vertices; i++)
        for (k = 0; k < per_vertex; k++) wall->vertices[3*i + k] = xyz[per_vertex*i + k];
    if (per_element) memcpy(wall->corners, corners,
                            (size_t)elements*(size_t)per_element*sizeof(int32_t));
    if (per_element && (!demi_facets_begin(w, wall) || !demi_wall_sheets(w, wall))) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return 0;
    }
    demi_wall_bounds(wall);
    if (per_element && (!demi_facets_any(wall) ||
                        !(demi_size(demi_sub(wall->box.hi, wall->box.lo)) > DEMI_LEAST))) {
        demi_refuse(w, call, "none of the %d elements has a size: corners coincide, triangles have "
                    "no height, or all lie within %g m; check that coordinates were read and are "
                    "in metres", elements, DEMI_LEAST);
        demi_wall_free(w, wall);
        return 0;
    }
    if (!demi_wall_index(w, wall)) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return 0;
    }
    return 1;
}

DEM_API dem_wall dem_wall_profile_add(dem_world *w, dem_material material,
                                      const dem_profile *profile,
                                 dem_edge_rule rule) {
    if (demi_null(w, __func__, profile, "profile")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, __func__, material, rule == DEM_EDGE_FRACTION
                         ? DEMI_WALL_SEGMENTS : DEMI_WALL_PROFILE, &wall)) return none;
    if (rule < DEM_EDGE_RESOLVED || rule > DEM_EDGE_FRACTION) {
        demi_refuse(w, __func__, "rule is %d, must be DEM_EDGE_RESOLVED (0) to "
                    "DEM_EDGE_FRACTION (%d); was it set?", (int)rule, (int)DEM_EDGE_FRACTION);
        return none;
    }
    if (rule == DEM_EDGE_FRACTION && (w->desc.law_range > 0 || w->desc.law_range_radii > 0)) {
        demi_refuse(w, __func__, "rule is DEM_EDGE_FRACTION, but the law of this "
                    "world has a range; that rule weighs the chord of a segment inside a grain, "
                    "which does not exist before the two touch: use DEM_EDGE_RESOLVED");
        return none;
    }
    wall.rule = rule;
    if (!demi_wall_load(w, __func__, &wall, profile->vertex_count, profile->vertices, 2,
                        profile->segment_count, profile->segments, 2)) return none;
    wall.motion.axis = demi_v(0, 0, 1);
    return demi_wall_adopt(w, __func__, &wall);
}

/* Makes a wall of triangles that is not added yet. Returns 0 with an error message if it is
   invalid. */
static int demi_mesh_make(dem_world *w, dem_material material, const dem_mesh *mesh,
                          demi_wall *wall) {
    if (!demi_wall_begin(w, "dem_wall_mesh_add", material, DEMI_WALL_MESH, wall) ||
        !demi_wall_load(w, "dem_wall_mesh_add", wall, mesh->vertex_count, mesh->vertices, 3,
                        mesh->triangle_count, mesh->triangles, 3)) return 0;
    wall->motion.axis = demi_v(0, 0, 1);
    return 1;
}
DEM_API dem_wall dem_wall_mesh_add(dem_world *w, dem_material material, const dem_mesh *mesh) {
    if (demi_null(w, __func__, mesh, "mesh")) return demi_no_wall;
    demi_wall wall;
    return demi_mesh_make(w, material, mesh, &wall) ? demi_wall_adopt(w, __func__, &wall)
                                                    : demi_no_wall;
}

DEM_API dem_wall dem_wall_grains_add(dem_world *w, dem_material material, int count,
                                     const dem_real *positions,
                                     dem_real radius, dem_real share) {
    if (demi_null(w, __func__, w, "world")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, __func__, material, DEMI_WALL_GRAINS, &wall)) return none;
    if (!(radius > 0) || !demi_bounded((double)radius) || !(share > 0) || !(share <= 1)) {
        demi_refuse(w, __func__, "radius is %g m and share is %g; the radius must be "
                    "> 0 and at most %g m, the share > 0 and at most 1", (double)radius,
                    (double)share, DEMI_FARTHEST);
        return none;
    }
    wall.radius = radius;
    wall.share = share;
    wall.motion.axis = demi_v(0, 0, 1);
    if (!demi_wall_load(w, __func__, &wall, count, positions, 3, count, 0, 0)) return none;
    return demi_wall_adopt(w, __func__, &wall);
}

static uint64_t demi_digest_vertices(const void *item) {
    const demi_wall *w = (const demi_wall *)item;
    return demi_hash(DEMI_HASH_START, w->vertices, w->vertices
                     ? (size_t)w->vertex_count*3*sizeof(dem_real) : 0);
}
static uint64_t demi_digest_elements(const void *item) {
    const demi_wall *w = (const demi_wall *)item;
    return demi_hash(DEMI_HASH_START, w->corners, w->corners ? (size_t)w->element_count*
                     sizeof(int32_t)*(size_t)demi_wall_per(w) : 0);
}
/* A field that only some kinds of sieves have. */
static int demi_zero_sieve(const dem_world *w, const void *item, const demi_field_row *r) {
    (void)w;
    return r->kinds >> ((const demi_wall *)item)->sieve.kind & 1 ? DEMI_0_TOO : DEMI_0_ALONE;
}
#define DEMI_ROW_SIEVE(field, type, how, most, unit, other, which, kinds) DEMI_LIMITED_IF( \
    demi_wall, sieve.field, type, how, most, unit, "and 0 except for " which, other, kinds, \
    demi_zero_sieve)
/* kind and id come first: see demi_checkpoint_scene. The numbers of a motion are part of the
   state. */
static const demi_field_row demi_wall_rows[] = {
    DEMI_ROW_ENUM(demi_wall, kind, 0, 0, "none plane cylinder profile segments mesh grains sieve "
                  "revolved"), DEMI_ROW(demi_wall, id, 'i'), DEMI_ROW(demi_wall, material, 'i'),
    DEMI_ROW(demi_wall, inside, 'i'), DEMI_ROW_ENUM(demi_wall, rule, 0, 0, "resolved fraction"),
    DEMI_ROW(demi_wall, radius, 'r'), DEMI_ROW(demi_wall, share, 'r'),
    DEMI_ROW(demi_wall, vertex_count, 'i'), DEMI_ROW(demi_wall, element_count, 'i'),
    DEMI_ROW_AS(demi_wall, "position", first.position, 'v'),
    DEMI_ROW_AS(demi_wall, "rotation", first.rotation, 'r'),
    DEMI_ROW_ENUM(demi_wall, sieve.kind, DEMI_OVER, 0,
                  "none wires bars square round slots reduced"),
    DEMI_LIMITED(demi_wall, sieve.aperture, 'r', DEMI_OVER, DEMI_FARTHEST, "m"),
    DEMI_LIMITED(demi_wall, sieve.bar, 'r', DEMI_OVER, DEMI_FARTHEST, "m"),
    DEMI_ROW_SIEVE(length, 'r', DEMI_FROM, DEMI_FARTHEST, "m", 2, "slots", 1 << DEM_SIEVE_SLOTS),
    DEMI_ROW_SIEVE(thickness, 'r', DEMI_FROM, DEMI_FARTHEST, "m", 0, "plates",
                   1 << DEM_SIEVE_SQUARE | 1 << DEM_SIEVE_ROUND | 1 << DEM_SIEVE_SLOTS),
    DEMI_ROW_SIEVE(lift, 'r', DEMI_FROM, DEMI_FARTHEST, "m", 0, "wires", 1 << DEM_SIEVE_WIRES),
    DEMI_ROW_SIEVE(staggered, 'i', DEMI_ANY, INT_MAX, "", 0, "round holes", 1 << DEM_SIEVE_ROUND),
    DEMI_LIMITED(demi_wall, sieve.radius, 'r', DEMI_FROM, DEMI_FARTHEST, "m"),
    DEMI_ROW_SIEVE(model, 'i', DEMI_FROM, 2, "", 0, "reduced holes", 1 << DEM_SIEVE_REDUCED),
    DEMI_ROW_SIEVE(clearance, 'r', DEMI_FROM, 1, "", 0, "reduced holes", 1 << DEM_SIEVE_REDUCED),
    DEMI_ROW_AS(demi_wall, "rings", ring_count, 'i'),
    DEMI_ROW_AS(demi_wall, "radii", ring_radius, 'r'),
    DEMI_ROW_AS(demi_wall, "heights", ring_height, 'r'), DEMI_ROW_ENUM(demi_wall, motion.kind, 0, 0,
                  "fixed translating rotating oscillating user table servo"),
    DEMI_ROW(demi_wall, motion.table_count, 'i'), DEMI_ROW(demi_wall, motion.table_repeats, 'i'),
    DEMI_ROW_DIGEST("vertices", demi_digest_vertices), DEMI_ROW_DIGEST("elements",
    demi_digest_elements), DEMI_ROW_DIGEST("motion.table", demi_digest_table), DEMI_ROW_END};
DEM_API dem_wall dem_wall_sieve_add(dem_world *w, dem_material material, const dem_sieve_desc *d) {
    if (demi_null(w, __func__, d, "desc")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    dem_vec3 n = d->normal, t = d->along;
    dem_real *R = wall.home.rotation;
    none.id = 0;
    if (!demi_wall_begin(w, __func__, material, DEMI_WALL_SIEVE, &wall)) return none;
    wall.sieve = *d;
    if (demi_rows_check(w, __func__, demi_wall_rows, &wall, "",
                        "start from DEM_SIEVE_DESC and set only what differs")) return none;
    if (!demi_place(d->point) || !demi_finite3(n) || !demi_finite3(t)) {
        demi_refuse(w, __func__, "point, normal or along is not finite, or point is "
                    "farther than %g m from the origin; check how it was computed", DEMI_FARTHEST);
        return none;
    }
    n = demi_size(n) > 0 ? demi_unit(n) : demi_v(0, 0, 1);
    if (demi_size(t) > 0) t = demi_unit(t);
    t = demi_sub(t, demi_scale(n, demi_dot(t, n)));
    if (!(demi_dot(t, t) > DEM_R(1e-6))) {      /* not given, or normal to the sieve: x, else y */
        const dem_vec3 x = DEMI_ABS(n.x) < DEM_R(0.9) ? demi_v(1, 0, 0) : demi_v(0, 1, 0);
        t = demi_sub(x, demi_scale(n, demi_dot(x, n)));
    }
    t = demi_unit(t);
    t = demi_unit(demi_sub(t, demi_scale(n, demi_dot(t, n))));      /* removes round-off */
    R[0] = t.x; R[3] = t.y; R[6] = t.z;
    R[2] = n.x; R[5] = n.y; R[8] = n.z;
    t = demi_cross(n, t);
    R[1] = t.x; R[4] = t.y; R[7] = t.z;
    wall.open = !demi_sieve_wires(d) && !(d->thickness > 0);
    wall.element_count = 1;
    wall.radius = d->radius;
    wall.home.position = wall.motion.point = d->point;
    wall.motion.axis = n;
    wall.extent = d->radius > 0 ? d->radius + d->thickness + d->lift + d->bar : -1;
    return demi_wall_adopt(w, __func__, &wall);
}

/* Returns the index of a wall, or -1 with an error message. */
static int demi_wall_find(dem_world *w, const char *call, dem_wall wall) {
    const int place = demi_wall_place(wall);
    if (wall.id < 1 || place >= w->wall_count) {
        demi_refuse(w, call, "wall %d does not exist, ids in this world are 1 to %d; adding it "
                    "failed (dem_world_error_get says why) or it belongs to another world: check "
                    "the id that adding it returned", (int)wall.id, w->wall_count);
        return -1;
    }
    if (!demi_wall_there(w, wall)) {
        demi_refuse(w, call, "wall %d does not exist any more, because dem_wall_remove removed it; "
                    "add it again and use the id that this returns", (int)wall.id);
        return -1;
    }
    return place;
}

/* True if the motion of a wall leaves its surface in place, as a rotation about its axis of
   symmetry does. */
static int demi_wall_symmetric(const demi_wall *wall) {
    const dem_motion *m = &wall->motion;
    dem_vec3 z, off;
    if (m->kind == DEM_MOTION_FIXED) return 1;
    if (m->kind != DEM_MOTION_ROTATING || (wall->extent >= 0 && !wall->ring_count)) return 0;
    z = demi_v(wall->home.rotation[2], wall->home.rotation[5], wall->home.rotation[8]);
    if (demi_length(demi_cross(z, demi_unit(m->axis))) > DEM_R(1e-6)) return 0;
    if (demi_wall_is(wall, DEMI_FLAT)) return 1;
    off = demi_sub(m->point, wall->home.position);
    return demi_length(demi_cross(z, off)) <= DEM_R(1e-6)*wall->radius;
}

/* Checks what only a servo wall needs. */
static dem_result demi_servo_check(dem_world *w, dem_wall id, const dem_motion *m) {
    if (!demi_response_is(w, DEMI_LASTING))
        return demi_refuse(w, "dem_wall_motion_set", "wall %d has kind DEM_MOTION_SERVO, which "
                           "needs contacts with a stiffness, but contacts of this world are "
                           "impulses; use DEM_RESPONSE_SPRINGS, or a heavy body instead of the "
                           "wall", (int)id.id);
    if (!(demi_dot(m->velocity, m->velocity) > 0))
        return demi_refuse(w, "dem_wall_motion_set", "velocity of servo wall %d is zero, but gives "
                           "the direction in which it presses and its largest speed; set it",
                           (int)id.id);
    if (w->desc.planar && fabs((double)m->velocity.z) > 0)
        return demi_refuse(w, "dem_wall_motion_set", "velocity of servo wall %d has the z "
                           "component %g m/s, must be 0 in a planar world, where no grain can bear "
                           "its load", (int)id.id, (double)m->velocity.z);
    return DEM_OK;
}
/* Checks a motion for the wall with this id, which need not exist yet. */
static dem_result demi_motion_check(dem_world *w, dem_wall id, const dem_motion *motion) {
    char of[24];
    demi_words(of, sizeof of, " of wall %d", (int)id.id);
    if (demi_rows_check(w, "dem_wall_motion_set", demi_motion_rows, motion, of,
                        "start from DEM_MOTION")) return DEM_ERROR_ARGUMENT;
    if (motion->kind == DEM_MOTION_ROTATING && !(demi_dot(motion->axis, motion->axis) > 0))
        return demi_refuse(w, "dem_wall_motion_set", "axis of rotating wall %d is zero; give a "
                           "direction", (int)id.id);
    if (motion->kind == DEM_MOTION_OSCILLATING && !(demi_dot(motion->velocity,
                                                             motion->velocity) > 0))
        return demi_refuse(w, "dem_wall_motion_set", "velocity of oscillating wall %d is zero, but "
                           "gives the direction of its motion; set it", (int)id.id);
    if (motion->kind == DEM_MOTION_OSCILLATING && !(motion->ramp > 0) &&
        fabs(demi_sin((double)motion->phase)) > 1e-6 &&
        (w->clock.steps || motion->start > w->clock.time))
        return demi_refuse(w, "dem_wall_motion_set", "wall %d would jump by %.3g m (amplitude "
                           "sin(phase)) as its oscillation begins, must be 0 after the first step: "
                           "it would throw the grains in its way; set motion.ramp, or phase 0",
                           (int)id.id, (double)motion->amplitude* demi_sin((double)motion->phase));
    if (motion->kind == DEM_MOTION_USER && !motion->function)
        return demi_refuse(w, "dem_wall_motion_set", "wall %d has kind DEM_MOTION_USER and no "
                           "function; set motion.function", (int)id.id);
    if (motion->kind == DEM_MOTION_SERVO && demi_servo_check(w, id, motion) != DEM_OK)
        return DEM_ERROR_ARGUMENT;
    return demi_tabled(motion) ? demi_table_check(w, (int)id.id, motion) : DEM_OK;
}
/* Sets *next to wall `wall` (of this id, which need not exist yet) with a new motion. If that
   fails, *next is unchanged. */
static dem_result demi_motion_lay(dem_world *w, dem_wall id, const dem_motion *motion,
                                  const demi_wall *wall, demi_wall *next) {
    demi_wall laid = *wall;
    dem_motion_row *rows = 0;
    if (demi_motion_check(w, id, motion) != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (!demi_table_make(w, motion, &rows)) return demi_no_memory(w, "dem_wall_motion_set");
    laid.home = laid.pose;                      /* starts from its present pose */
    laid.home.velocity = laid.home.spin = demi_v(0, 0, 0);
    laid.motion = *motion;
    laid.motion.table = rows;
    if (!(demi_dot(motion->axis, motion->axis) > 0)) laid.motion.axis = demi_v(0, 0, 1);
    laid.motion.start = DEMI_MAX(motion->start, w->clock.time);
    memset(&laid.servo, 0, sizeof laid.servo);
    laid.servo.time = laid.motion.start;
    laid.symmetric = demi_wall_symmetric(&laid);
    laid.idle = demi_wall_waits(&laid, w->clock.time);
    demi_wall_pose_at(w, &laid, w->clock.time, &laid.pose);
    laid.mid = laid.pose;
    if (!demi_pose_sane(&laid.pose)) {
        demi_free(w, rows);
        return demi_refuse(w, "dem_wall_motion_set", "the motion of wall %d gives a pose that is "
                           "not finite, whose matrix is not a rotation, or that is beyond %g m, "
                           "m/s or rad/s now, at %g s; check the motion", (int)id.id, DEMI_FARTHEST,
                           w->clock.time);
    }
    *next = laid;
    return DEM_OK;
}
/* Deletes the persistent contacts of a wall that is removed, since another wall may get its index.
   Call demi_list_drop first. */
static void demi_wall_forget(dem_world *w, int wall) {
    int d, k, left;
    for (d = 0; d < DEMI_DOMAINS; d++) {
        demi_persistent *c = w->domains[d].persistent ? demi_persistent_of(w, d) : 0;
        for (k = left = 0; k < w->domains[d].persistent; k++) {
            const int next = k + 4;             /* the part of the next wall, if there is one */
            if (c[k].b >= 0 || c[k].wall != wall) c[left++] = c[k];
            else if (next < w->domains[d].persistent && demi_persistent_later(&c[next]) &&
                     !demi_persistent_later(&c[k])) c[next].more.rank = 0;
        }
        w->domains[d].persistent = left;
    }
}
DEM_API dem_result dem_wall_remove(dem_world *w, dem_wall id) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, __func__, id);
    int k;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    for (k = 0; k < w->outlet_count; k++)
        if (w->outlets[k].desc.frame.id == id.id)
            return demi_refuse(w, __func__, "outlet %d moves with wall %d and would stop "
                               "working without it; keep the wall", k + 1, (int)id.id);
    if (!demi_list_drop(w)) return demi_no_memory(w, __func__);
    demi_wall_forget(w, i);
    demi_wall_free(w, &w->walls[i]);            /* other walls keep their indices */
    w->walls[i].id = id.id;
    demi_surfaces_outdated(w);
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_result dem_wall_reals_get(const dem_world *w, dem_wall id, dem_real *reals) {
    const dem_result result = demi_reals_ask(w, __func__, reals, 1, 0);
    int i;
    if (result != DEM_OK) return result;
    i = demi_wall_find((dem_world *)w, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    memcpy(reals, w->walls[i].reals, (size_t)w->bodies.real_count*sizeof *reals);
    return DEM_OK;
}
DEM_API dem_result dem_wall_reals_set(dem_world *w, dem_wall id, const dem_real *reals) {
    const dem_result result = demi_reals_ask(w, __func__, reals, 1, 1);
    int i;
    if (result != DEM_OK) return result;
    i = demi_wall_find(w, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    memcpy(w->walls[i].reals, reals, (size_t)w->bodies.real_count*sizeof *reals);
    return DEM_OK;
}
DEM_API dem_result dem_wall_loads_get(const dem_world *world, dem_wall id, dem_wall_loads *loads) {
    if (demi_null_look(world, __func__, loads, "loads")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find((dem_world *)world, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *loads = world->walls[i].loads;
    return DEM_OK;
}
static void demi_loads_reset(dem_wall_loads *loads) {
    memset(loads->impulse, 0, sizeof loads->impulse);
    memset(loads->gained, 0, sizeof loads->gained);
    loads->torque_impulse = loads->work = loads->time = 0;
}
DEM_API dem_result dem_wall_loads_reset(dem_world *w, dem_wall id) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    demi_loads_reset(&w->walls[i].loads);
    return DEM_OK;
}
