/* ---------------------------------------------------------------------------------------------
   >>placing
   Free positions for new grains, for fills, packings and feeds. A region defines the possible
   positions: a box (without faces on an axis where it holds a whole period), a cylinder in it, or a
   user-defined function. An occupancy tree ("crowd") finds the spheres near a position. It is a
   binary tree of boxes; a box with more than DEMI_CROWD_LEAF spheres is halved along its longest
   side. Each box stores the largest radius in it, so a search skips boxes that are too far away and
   visits few bodies even for radii of 1:100 and more. Walls are tested through their own cells.
   Fills use random sequential addition: positions are tried at random, one after another, and no
   grain moves another. They have their own random numbers, so the same seed gives the same
   positions.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_CROWD_LEAF = 8, DEMI_CROWD_DEPTH = 60 };     /* spheres of a leaf; depth of the tree */
/* Tries for one grain: positions that are occupied, and positions outside the region. */
enum { DEMI_FILL_TRIES = 2000, DEMI_FILL_OUTSIDE = 200000 };
/* Lattice sites that a packing may test. */
#define DEMI_PACK_MOST 3e8

/* A node of the tree. */
typedef struct demi_crowd_node {
    int32_t child;                 /* the first of its two halves; 0: a leaf */
    int32_t first, count;          /* of a leaf: its first sphere, linked by `next`; their number */
    dem_real largest;              /* m, largest radius in it */
} demi_crowd_node;
/* A sphere in the tree. body: index of its body; -1: not a body yet. next: -1: the last. */
typedef struct demi_sphere { dem_vec3 at; dem_real radius; int32_t next, body; } demi_sphere;
/* An occupancy tree. Its spheres and nodes are w->crowd and w->crowd_nodes. */
typedef struct demi_crowd {
    demi_periods p;
    int material;                  /* index of that of the new grains: bodies and walls that it
                                      ignores do not occupy a position */
    double lo[3], size[3];         /* m, of the root's box; on a periodic axis the whole period */
    int count, nodes;
} demi_crowd;
/* A node and its box during the descent. */
typedef struct demi_nook { int32_t node; double lo[3], size[3]; } demi_nook;

static int demi_longest(const double *size) {
    const int k = size[1] > size[0];
    return size[2] > size[k] ? 2 : k;
}
/* Returns the half of a box below (upper 0) or above (1) its middle. */
static demi_nook demi_nook_half(const demi_nook *n, int32_t child, int upper) {
    demi_nook h = *n;
    const int k = demi_longest(n->size);
    h.node = child + upper;
    h.size[k] = n->size[k]/2;
    if (upper) h.lo[k] += h.size[k];
    return h;
}
/* 1 if x is in the upper half. */
static int demi_nook_upper(const demi_nook *n, dem_vec3 x) {
    const int k = demi_longest(n->size);
    return (double)(k == 0 ? x.x : k == 1 ? x.y : x.z) >= n->lo[k] + n->size[k]/2;
}
/* Returns the root. */
static demi_nook demi_crowd_root(const demi_crowd *c) {
    demi_nook n;
    n.node = 0;
    memcpy(n.lo, c->lo, sizeof n.lo);
    memcpy(n.size, c->size, sizeof n.size);
    return n;
}
/* Links sphere i into a leaf, as its first. */
static void demi_leaf_put(demi_crowd_node *leaf, demi_sphere *all, int32_t i) {
    all[i].next = leaf->first;
    leaf->first = i;
    leaf->count++;
    leaf->largest = DEMI_MAX(leaf->largest, all[i].radius);
}
/* Splits a leaf into two halves. Returns 0 if memory runs out; the leaf is then unchanged. */
static int demi_leaf_split(dem_world *w, demi_crowd *c, const demi_nook *at) {
    demi_sphere *all = w->crowd;
    demi_crowd_node *nodes;
    int32_t i, next;
    int k;
    if (!DEMI_GROW(w, w->crowd_nodes, (size_t)c->nodes + 2)) return 0;
    nodes = w->crowd_nodes;
    nodes[at->node].child = c->nodes;
    for (k = 0; k < 2; k++) {
        demi_crowd_node *half = nodes + c->nodes++;
        half->child = half->count = 0;
        half->first = -1;
        half->largest = 0;
    }
    for (i = nodes[at->node].first; i >= 0; i = next) {
        next = all[i].next;
        demi_leaf_put(nodes + nodes[at->node].child + demi_nook_upper(at, all[i].at), all, i);
    }
    return 1;
}
/* Adds a sphere to the tree. A sphere outside the root's box goes to the nearest leaf. That leaf is
   never farther from a position in the box than the sphere is, so no search misses it. body: its
   index, or -1. Returns 0 if memory runs out. */
static int demi_crowd_put(dem_world *w, demi_crowd *c, dem_vec3 x, dem_real radius, int body) {
    demi_nook at = demi_crowd_root(c);
    demi_sphere *s;
    demi_crowd_node *node;
    int depth = 0;
    if (!DEMI_GROW(w, w->crowd, (size_t)c->count + 1)) return 0;
    s = w->crowd + c->count;
    s->at = demi_place_of(&c->p, x);
    s->radius = radius;
    s->body = body;
    for (;;) {
        node = w->crowd_nodes + at.node;
        node->largest = DEMI_MAX(node->largest, radius);
        if (!node->child && node->count >= DEMI_CROWD_LEAF && depth < DEMI_CROWD_DEPTH &&
            !demi_leaf_split(w, c, &at)) return 0;
        node = w->crowd_nodes + at.node;
        if (!node->child) break;
        at = demi_nook_half(&at, node->child, demi_nook_upper(&at, s->at));
        depth++;
    }
    demi_leaf_put(node, w->crowd, c->count++);
    return 1;
}
/* Lower bound on the squared distance, m2, of position x from a box. */
static double demi_nook_far2(const demi_crowd *c, const demi_nook *n, const double *x) {
    double d2 = 0;
    int k;
    for (k = 0; k < 3; k++) {
        const double below = n->lo[k] - x[k], above = x[k] - n->lo[k] - n->size[k];
        const double period = (double)c->p.period[k];
        double d = below > above ? below : above;
        if (!(d > 0)) continue;
        if (period > 0) {                       /* the other way round the period */
            const double round = period - n->size[k] - d;
            d = round < 0 ? 0 : DEMI_MIN(d, round);
        }
        d2 += d*d;
    }
    return d2;
}
/* Returns the number of spheres in the tree that overlap this one and are not ignored by the
   material of the new grains, and stores their bodies in `found`, which holds `room`. Stops at the
   first that does not fit and returns room + 1. The centre must be in the root's box. */
static int demi_crowd_look(const dem_world *w, const demi_crowd *c, dem_vec3 centre,
                           dem_real radius, int32_t *found, int room) {
    const demi_sphere *all = w->crowd;
    const demi_crowd_node *nodes = w->crowd_nodes;
    const dem_vec3 at = demi_place_of(&c->p, centre);
    demi_nook stack[DEMI_CROWD_DEPTH + 2];
    double x[3];
    int top = 0, count = 0, i;
    if (!c->count) return 0;
    x[0] = (double)at.x; x[1] = (double)at.y; x[2] = (double)at.z;
    stack[top++] = demi_crowd_root(c);
    while (top) {
        const demi_nook n = stack[--top];
        const demi_crowd_node *node = nodes + n.node;
        const double cut = (double)(radius + node->largest);
        if (demi_nook_far2(c, &n, x) >= cut*cut) continue;
        if (node->child) {                      /* visits the half that contains it first */
            const int upper = demi_nook_upper(&n, at);
            stack[top++] = demi_nook_half(&n, node->child, !upper);
            stack[top++] = demi_nook_half(&n, node->child, upper);
            continue;
        }
        for (i = node->first; i >= 0; i = all[i].next) {
            const dem_vec3 d = demi_nearest(&c->p, demi_sub(all[i].at, at));
            const dem_real s = all[i].radius + radius;
            if (!(demi_dot(d, d) < s*s)) continue;
            if (demi_ignores(w, c->material, all[i].body < 0 ? c->material
                             : w->bodies.material[all[i].body] - 1)) continue;
            if (count++ == room) return count;
            found[count - 1] = all[i].body;
        }
    }
    return count;
}
/* True if a sphere overlaps no sphere in the tree. */
static int demi_crowd_free(const dem_world *w, const demi_crowd *c, dem_vec3 centre,
                           dem_real radius) {
    return !demi_crowd_look(w, c, centre, radius, 0, 0);
}

/* --- regions --- */

/* Possible positions of centres, in the form that drawing needs. */
typedef struct demi_region {
    dem_vec3 lo;                   /* m, lower corner and size of the box of centres */
    double size[3];
    int cylinder;                  /* 1 + axis of the cylinder in it; 0: the whole box */
    const dem_world *world;
    dem_inside_fn inside;
    void *user;
} demi_region;

/* Sets up the region of centres at least `off` (m) from the faces of the box. A box that holds a
   whole period has no faces on that axis. Returns 0 if nothing is left. */
static int demi_region_make(const dem_world *w, const dem_region *from, double off,
                            demi_region *to) {
    const demi_periods p = demi_periods_of(w);
    dem_real lo[3], hi[3];
    int k, ok = 1;
    demi_put(lo, from->box.lo);
    demi_put(hi, from->box.hi);
    for (k = 0; k < 3; k++) {
        const double side = (double)hi[k] - (double)lo[k], period = (double)p.period[k];
        to->size[k] = side - 2*off;
        if (period > 0 && side >= period*(1 - 1e-6)) {
            to->size[k] = period;
            lo[k] = from->cylinder ? lo[k] + (dem_real)((side - period)/2) : p.lo[k];
        } else lo[k] += (dem_real)off;
        if (k == 2 && w->desc.planar) {
            to->size[k] = 0;
            lo[k] = 0;
        }
        ok = ok && to->size[k] >= 0;
    }
    to->lo = demi_at(lo);
    to->cylinder = from->cylinder ? 1 + from->cylinder - 'x' : 0;
    to->world = w;
    to->inside = from->inside;
    to->user = from->user;
    return ok && demi_finite3(from->box.lo) && demi_finite3(from->box.hi);
}
/* True if the centre x is in the region. u: its position relative to the box, 0 to 1 on each axis.
   An axis of size 0 counts as the middle of the cylinder. */
static int demi_region_keeps(const demi_region *g, const double *u, dem_vec3 x, dem_real radius) {
    double round = 0;
    int k;
    for (k = 0; k < 3; k++)
        if (g->cylinder && g->cylinder != 1 + k && g->size[k] > 0)
            round += (2*u[k] - 1)*(2*u[k] - 1);
    k = round <= 1;
    if (k && g->inside)
        DEMI_USER(g->world, "a fill, feed or selection", 1, k = g->inside(x, radius, g->user) != 0)
    return k;
}
/* Sets *x to the position with relative coordinates u. Returns 0 if it is outside the region. */
static int demi_region_at(const demi_region *g, const double *u, dem_real radius, dem_vec3 *x) {
    *x = demi_v(g->lo.x + (dem_real)(g->size[0]*u[0]), g->lo.y + (dem_real)(g->size[1]*u[1]),
                g->lo.z + (dem_real)(g->size[2]*u[2]));
    return demi_region_keeps(g, u, *x, radius);
}
/* True if a centre in the box is in the region. */
static int demi_region_has(const demi_region *g, dem_vec3 x, dem_real radius) {
    const dem_vec3 off = demi_sub(x, g->lo);
    const double at[3] = {(double)off.x, (double)off.y, (double)off.z};
    double u[3];
    int k;
    for (k = 0; k < 3; k++) u[k] = g->size[k] > 0 ? at[k]/g->size[k] : 0;
    return demi_region_keeps(g, u, x, radius);
}

/* Starts a tree with all bodies that spheres of this radius in the region could overlap. p: the
   periods of the scene; those of a slab differ. material: index of that of the new grains. Returns
   0 if memory runs out. */
static int demi_crowd_begin(dem_world *w, demi_crowd *c, const demi_region *g, dem_real radius,
                            int material, demi_periods p) {
    dem_vec3 mid;
    double half[3];
    demi_crowd_node *root;
    int i, k;
    c->p = p;
    c->material = material;
    demi_walls_repeat(w);
    c->count = 0;
    c->nodes = 1;
    if (!DEMI_GROW(w, w->crowd_nodes, 1)) return 0;
    root = w->crowd_nodes;
    root->child = root->count = 0;
    root->first = -1;
    root->largest = 0;
    c->lo[0] = (double)g->lo.x; c->lo[1] = (double)g->lo.y; c->lo[2] = (double)g->lo.z;
    for (k = 0; k < 3; k++) half[k] = g->size[k]/2;
    mid = demi_v((dem_real)(c->lo[0] + half[0]), (dem_real)(c->lo[1] + half[1]),
                 (dem_real)(c->lo[2] + half[2]));
    for (k = 0; k < 3; k++) {
        c->size[k] = g->size[k];
        if (!(c->p.period[k] > 0)) continue;
        c->lo[k] = (double)c->p.lo[k];
        c->size[k] = (double)c->p.period[k];
    }
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real r = demi_radius(w, i);
        const dem_vec3 d = demi_nearest(&c->p, demi_sub(demi_at(w->bodies.pos + 4*i), mid));
        /* 0.1 % more, so that rounding does not lose a neighbour */
        const double s = 1.001*(double)(r + radius);
        if (fabs((double)d.x) > half[0]*1.001 + s || fabs((double)d.y) > half[1]*1.001 + s ||
            fabs((double)d.z) > half[2]*1.001 + s) continue;
        if (!demi_crowd_put(w, c, demi_at(w->bodies.pos + 4*i), r, i)) return 0;
    }
    return 1;
}
/* Frees the arrays of the tree. Feeds do not call this, because they need them again. */
static void demi_crowd_end(dem_world *w) {
    demi_free(w, w->crowd);
    demi_free(w, w->crowd_nodes);
    demi_free(w, w->crowd_turned);
    w->crowd = 0;
    w->crowd_nodes = 0;
    w->crowd_turned = 0;
}

/* --- walls --- */

/* True if a sphere touches no element of a wall. at: its centre in the wall's frame. */
static int demi_wall_clear(const demi_wall *wall, dem_vec3 at, dem_real radius) {
    const dem_real touch = radius*(DEMI_SINGLE ? DEM_R(0.9999) : DEM_R(0.999999999));
    const dem_vec3 out = demi_v(radius, radius, radius);
    int k, x, y, z, f[3], l[3];
    if (demi_wall_is(wall, DEMI_DRAWN)) at.z = 0;
    if (!wall->cell_start) {
        for (k = 0; k < wall->element_count; k++)
            if (demi_wall_distance(wall, k, at, radius) < touch) return 0;
        return 1;
    }
    demi_wall_cells(wall, demi_sub(at, out), demi_add(at, out), f, l);
    for (z = f[2]; z <= l[2]; z++)
        for (y = f[1]; y <= l[1]; y++)
            for (x = f[0]; x <= l[0]; x++) {
                const int cell = x + wall->cells[0]*(y + wall->cells[1]*z);
                for (k = wall->cell_start[cell]; k < wall->cell_start[cell + 1]; k++)
                    if (demi_wall_distance(wall, wall->cell_items[k], at, radius) < touch) return 0;
            }
    return 1;
}
/* True if a sphere of a material (index) touches no wall at the walls' present poses. It may
   overlap walls that it ignores. Positions behind a plane or on the wrong side of a cylinder count
   as touching, and so does the whole sheet of a sieve with its holes. The inside of a closed mesh
   counts as free. */
static int demi_walls_clear(const dem_world *w, int material, dem_vec3 x, dem_real radius) {
    int j, n;
    for (j = 0; j < w->wall_count; j++) {
        const demi_wall *wall = &w->walls[j];
        dem_vec3 shift;
        if (wall->kind == DEMI_WALL_NONE || demi_ignores(w, material, wall->material)) continue;
        for (n = 0; demi_wall_image(w, wall, x, radius, n, &shift); n++)
            if (!demi_wall_clear(wall, demi_unrotate(wall->pose.rotation,
                                     demi_sub(demi_add(x, shift), wall->pose.position)), radius))
                return 0;
    }
    return 1;
}
/* True if a sphere touches neither a sphere of the tree nor a wall. */
static int demi_room_free(const dem_world *w, const demi_crowd *c, dem_vec3 x, dem_real radius) {
    /* moved into the domain first: a region may be too many periods away to count them */
    return demi_crowd_free(w, c, x, radius) &&
        demi_walls_clear(w, c->material, demi_place_of(&c->p, x), radius);
}

/* --- fills --- */

/* Draws a uniform random orientation (Shoemake 1992); in a planar world a rotation about z. */
static dem_quat demi_quat_random(const dem_world *w, uint64_t *state) {
    const double u = demi_uniform(state), a = 2*DEMI_PI*demi_uniform(state);
    const double b = 2*DEMI_PI*demi_uniform(state), r = sqrt(1 - u), s = sqrt(u);
    if (w->desc.planar)
        return dem_quat_make((dem_real)demi_cos(a/2), 0, 0, (dem_real)demi_sin(a/2));
    return dem_quat_make((dem_real)(r*demi_sin(a)), (dem_real)(r*demi_cos(a)),
                         (dem_real)(s*demi_sin(b)), (dem_real)(s*demi_cos(b)));
}
/* Adds bodies for the spheres of the tree from `first` on. shape: -1: spheres. Returns 0 if memory
   runs out; then it adds none. */
static int demi_crowd_settle(dem_world *w, const demi_crowd *c, int first, int material,
                             int shape) {
    const demi_sphere *s = w->crowd;
    const dem_real *q = w->crowd_turned;
    int i;
    if (!demi_list_drop(w) ||
        !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)(c->count - first)) ||
        (shape >= 0 && !demi_orient_begin(w))) return 0;
    for (i = first; i < c->count; i++) {
        demi_body_append(w, material, s[i].radius, s[i].at);
        if (shape >= 0)
            demi_body_shape(w, w->bodies.count - 1, shape, 1,
                            demi_quat_at(q + 4*(size_t)(i - first)));
    }
    if (c->count > first) demi_scene_changed(w);
    return 1;
}
/* Finds positions in a region for up to `count` spheres and adds them to the tree. They have one
   radius, or those in `radii` unless it is null. turned: 1: also draws orientations. Returns the
   number of spheres; -1 if memory runs out. */
static int demi_fill_places(dem_world *w, demi_crowd *c, const dem_region *region, dem_real radius,
                            const dem_real *radii, int turned, int count, uint64_t state) {
    demi_region g;
    int i, k;
    for (i = 0; i < count; i++) {
        int taken = 0, outside = 0;
        dem_vec3 x;
        if (radii) radius = radii[i];
        demi_region_make(w, region, (double)radius, &g);
        for (;;) {
            double u[3];
            for (k = 0; k < 3; k++) u[k] = k == 2 && w->desc.planar ? 0 : demi_uniform(&state);
            if (!demi_region_at(&g, u, radius, &x)) {
                if (++outside == DEMI_FILL_OUTSIDE) return i;
                continue;
            }
            if (demi_room_free(w, c, x, radius)) break;
            if (++taken == DEMI_FILL_TRIES) return i;
        }
        if (!demi_crowd_put(w, c, x, radius, -1)) return -1;
        if (!turned) continue;
        if (!DEMI_GROW(w, w->crowd_turned, 4*((size_t)i + 1))) return -1;
        demi_quat_put(w->crowd_turned + 4*(size_t)i, demi_quat_random(w, &state));
    }
    return count;
}
/* Sets up the region of centres of spheres of this radius. Returns 0 with an error message if the
   cylinder has no axis, or the box is not finite or too small. */
static int demi_region_check(dem_world *w, const char *call, const dem_region *region,
                             dem_real radius, demi_region *g) {
    if (region->cylinder && (region->cylinder < 'x' || region->cylinder > 'z'))
        demi_refuse(w, call, "region.cylinder is %d, must be 'x', 'y' or 'z', the axis of the "
                    "cylinder, or 0 for the whole box", region->cylinder);
    else if (!demi_place(region->box.lo) || !demi_place(region->box.hi))
        demi_refuse(w, call, "the box goes from (%g, %g, %g) to (%g, %g, %g) m, must be finite and "
                    "at most %g m from the origin", (double)region->box.lo.x,
                    (double)region->box.lo.y, (double)region->box.lo.z, (double)region->box.hi.x,
                    (double)region->box.hi.y, (double)region->box.hi.z, DEMI_FARTHEST);
    else if (demi_cell_slid(w))
        demi_refuse(w, call, "the periodic cell is sheared, its images are displaced by %g m, "
                    "which the search for room does not see; fill the cell before it is sheared, "
                    "or add bodies at given positions", w->cell.offset);
    else if (!demi_region_make(w, region, (double)radius, g))
        demi_refuse(w, call, "the box is smaller than one sphere of radius %g m; give lo below hi "
                    "by at least a diameter", (double)radius);
    else return 1;
    return 0;
}
/* Fills a region with spheres of one radius, or of the given radii (largest first), or with bodies
   of a shape (>= 0) whose bounding sphere has this radius. Returns the number of bodies added. */
static int demi_fill(dem_world *w, const char *call, dem_material material, int shape,
                     dem_real radius, const dem_real *radii, const dem_region *region, int count,
                     uint64_t seed) {
    demi_region g;
    demi_crowd c;
    int m = 0, first, done;
    if (demi_material_index(w, call, material, &m) != DEM_OK) return 0;
    if (radii) radius = radii[0];
    if (!(radius > 0) || !demi_finite(radius) || count < 0) {
        demi_refuse(w, call, "radius is %g m and count is %d; the radius must be > 0 and finite, "
                    "the count >= 0", (double)radius, count);
        return 0;
    }
    if (demi_mass_refuse(w, call, m, shape, shape >= 0 ? 1 : radii && count ? radii[count - 1]
                         : radius, 0) ||
        (shape >= 0 && demi_walls_strange(w, call, shape))) return 0;
    if (!demi_region_check(w, call, region, radius, &g)) return 0;
    /* the region of the smallest contains the centres of all */
    if (radii) demi_region_make(w, region, (double)radii[DEMI_MAX(count, 1) - 1], &g);
    done = demi_crowd_begin(w, &c, &g, radius, m, demi_periods_of(w)) ? 0 : -1;
    first = c.count;
    if (!done) done = demi_fill_places(w, &c, region, radius, radii, shape >= 0, count, seed);
    if (done >= 0 && !demi_crowd_settle(w, &c, first, m, shape)) done = -1;
    demi_crowd_end(w);
    if (done < 0) {
        demi_no_memory(w, call);
        return 0;
    }
    if (done < count)
        demi_refuse(w, call, "%d of %d %s of radius %g m found a free position, clear of other "
                    "bodies and walls, in %d tries each; enlarge the %s, or %s", done, count,
                    shape < 0 ? "spheres" : "bodies with bounding spheres",
                    (double)(radii ? radii[done] : radius), (int)DEMI_FILL_TRIES,
                    region->inside ? "region" : "box", shape < 0 ? "pack them with dem_spheres_pack"
                    : "place them with dem_bodies_add");
    demi_built(w, call);                        /* also if fewer fit: the caller sees the number */
    return done;
}
DEM_API int dem_spheres_fill(dem_world *w, dem_material material, dem_real radius,
                             dem_region region, int count, uint64_t seed) {
    if (demi_null(w, __func__, w, "world")) return 0;
    return demi_fill(w, __func__, material, -1, radius, 0, &region, count, seed);
}
DEM_API int dem_bodies_fill(dem_world *w, dem_material material, dem_shape shape,
                            dem_region region, int count, uint64_t seed) {
    const int i = demi_null(w, __func__, w, "world") ? -1 : demi_shape_index(w, __func__, shape);
    if (i < 0) return 0;
    return demi_fill(w, __func__, material, i, w->shapes[i].radius, 0, &region, count, seed);
}
DEM_API int dem_sizes_fill(dem_world *w, dem_material material, const dem_sizes *sizes,
                           dem_region region, int count, uint64_t seed) {
    dem_real *radii;
    int i, done = 0;
    if (demi_null(w, __func__, sizes, "sizes")) return 0;
    radii = (dem_real *)demi_alloc(w, (size_t)DEMI_MAX(count, 0) + 1, sizeof *radii);
    if (!radii) { demi_no_memory(w, __func__); return 0; }
    /* even for count 0 the region must have room for one */
    if (demi_sizes_draw(w, __func__, sizes, count ? count : 1, 0, radii) == DEM_OK) {
        for (i = 0; i < count/2; i++) {         /* the largest first */
            const dem_real r = radii[i];
            radii[i] = radii[count - 1 - i];
            radii[count - 1 - i] = r;
        }
        done = demi_fill(w, __func__, material, -1, 0, radii, &region, count, seed);
    }
    demi_free(w, radii);
    return done;
}

/* --- packings --- */

/* Centre (i, j, k) of a hexagonal close packing of spheres of radius r, with the first at the
   origin. Even and odd layers alternate. In planar worlds k = 0 gives a triangular lattice. */
static dem_vec3 demi_pack_site(int64_t i, int64_t j, int64_t k, double r) {
    return demi_v((dem_real)(r*(double)(2*i + ((j + k) & 1))),
                  (dem_real)(r*sqrt(3.0)*((double)j + (double)(k & 1)/3.0)),
                  (dem_real)(r*(double)k*2*sqrt(6.0)/3));
}
/* Lattice of a packing. */
typedef struct demi_lattice {
    dem_vec3 lo;                   /* m, first site */
    double size[3], r;             /* m: largest distance of the last site from it; half pitch */
    dem_real radius;
    const demi_region *room;
    int count;                     /* limit of spheres; 0: as many as fit */
    double looked;                 /* sites tested */
} demi_lattice;
/* Appends the free sites of the lattice to the array of spheres, in layers along z. They are not
   added to the tree, because they do not overlap each other. Returns their number; -1 if memory
   runs out. */
static int demi_lattice_fill(dem_world *w, demi_crowd *c, demi_lattice *g) {
    const double slack = 1e-9*g->r;
    int64_t i, j, k;
    int done = 0;
    for (k = 0;; k++) {
        if ((double)demi_pack_site(0, 0, k, g->r).z > g->size[2] + slack ||
            (k > 0 && w->desc.planar)) return done;
        for (j = 0;; j++) {
            if ((double)demi_pack_site(0, j, k, g->r).y > g->size[1] + slack) break;
            for (i = 0;; i++) {
                const dem_vec3 s = demi_pack_site(i, j, k, g->r);
                const dem_vec3 x = demi_v(g->lo.x + s.x, g->lo.y + s.y,
                                          w->desc.planar ? 0 : g->lo.z + s.z);
                demi_sphere *to;
                if ((double)s.x > g->size[0] + slack) break;
                if (++g->looked > DEMI_PACK_MOST || c->count == INT_MAX/64) return done;
                if (!demi_region_has(g->room, x, g->radius)) continue;
                if (!demi_room_free(w, c, x, g->radius*DEM_R(0.999999))) continue;
                if (!DEMI_GROW(w, w->crowd, (size_t)c->count + (size_t)done + 1)) return -1;
                to = w->crowd + c->count + done++;
                to->at = x;
                to->radius = g->radius;
                if (g->count && done == g->count) return done;
            }
        }
    }
}
/* Estimates the number of sites of a lattice. */
static double demi_lattice_places(const dem_world *w, const demi_lattice *g) {
    const double rows = g->size[1]/(g->r*sqrt(3.0)) + 1, layers = g->size[2]/(g->r*1.633) + 1;
    return (g->size[0]/(2*g->r) + 1)*rows*(w->desc.planar ? 1 : layers);
}
/* Sets up a lattice in the region of centres. padding: m, gap between spheres. Returns 0 if a
   period is shorter than the pitch. */
static int demi_lattice_make(const dem_world *w, const demi_region *room, dem_real radius,
                             dem_real padding, demi_lattice *g) {
    const demi_periods p = demi_periods_of(w);
    dem_real lo[3];
    int k;
    memset(g, 0, sizeof *g);
    g->r = (double)radius + (double)padding/2;
    g->radius = radius;
    g->room = room;
    demi_put(lo, room->lo);
    for (k = 0; k < 3; k++) {                   /* the last must not overlap the first's image */
        const int full = p.period[k] > 0 && room->size[k] >= (double)p.period[k];
        g->size[k] = room->size[k] - (full ? 2*g->r : 0);
        if (full) lo[k] += radius;
        if (!(g->size[k] >= 0)) return 0;
    }
    g->lo = demi_at(lo);
    return 1;
}
DEM_API int dem_spheres_pack(dem_world *w, dem_material material, dem_real radius, dem_real padding,
                             dem_region region, int count) {
    demi_region room;
    demi_crowd c;
    demi_lattice g;
    int m = 0, first, done;
    if (demi_null(w, __func__, w, "world") ||
        demi_material_index(w, __func__, material, &m) != DEM_OK) return 0;
    if (!(radius > 0) || !(padding >= 0) || !demi_finite(radius) || !demi_finite(padding) ||
        count < 0) {
        demi_refuse(w, __func__, "radius is %g m, padding is %g m, count is %d; the radius must be "
                    "> 0, padding and count >= 0", (double)radius, (double)padding, count);
        return 0;
    }
    if (demi_mass_refuse(w, __func__, m, -1, radius, 0) ||
        !demi_region_check(w, __func__, &region, radius, &room)) return 0;
    if (!demi_lattice_make(w, &room, radius, padding, &g)) {
        demi_refuse(w, __func__, "a period is shorter than one sphere of radius %g m with its "
                    "padding of %g m; lengthen the domain", (double)radius, (double)padding);
        return 0;
    }
    g.count = count;
    if (!count && !region.inside && demi_lattice_places(w, &g) > 1.1*(INT_MAX/64)) {
        demi_refuse(w, __func__, "the box has room for about %.3g spheres of radius %g m, must be "
                    "at most %d, the limit of a world; make the box smaller or give a count",
                    demi_lattice_places(w, &g), (double)radius, INT_MAX/64);
        return 0;
    }
    done = demi_crowd_begin(w, &c, &room, radius, m, demi_periods_of(w)) ? 0 : -1;
    first = c.count;
    if (!done) done = demi_lattice_fill(w, &c, &g);
    c.count += DEMI_MAX(done, 0);
    if (done >= 0 && !demi_crowd_settle(w, &c, first, m, -1)) done = -1;
    demi_crowd_end(w);
    if (done < 0) {
        demi_no_memory(w, __func__);
        return 0;
    }
    if (g.looked > DEMI_PACK_MOST || c.count >= INT_MAX/64)
        demi_refuse(w, __func__, "stopped after %.3g trial positions, with %d spheres of radius %g "
                    "m packed; the limits are %d bodies and %g trial positions: make the box "
                    "smaller", g.looked, done, (double)radius, INT_MAX/64, DEMI_PACK_MOST);
    demi_built(w, __func__);
    return done;
}
