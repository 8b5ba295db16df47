/* Laws that reach beyond touch: whom they are asked about, whatever touches what, however it is
   found; that memory lasts until the law ends it; and what a law is told of who touches. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* A spring that begins at the range: what a grain thicker by it would feel at touch. */
static void shell(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = 200*(c->overlap + c->range);
}
/* A bridge: forms at touch, pulls with 2e-5 N, breaks at a gap of 0.3 mm; memory: is there one? */
static const double rupture = 3e-4;
static void bridge(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real there = c->overlap > 0 ? 1 : c->overlap > -(dem_real)rupture ? memory[0] : 0;
    if (c->dt > 0) memory[0] = there;
    f->normal = there*DEM_R(-2e-5);
    if (c->overlap > 0) f->normal += 200*c->overlap + DEM_R(0.03)*c->closing_speed;
}
static dem_world_desc desc_of(dem_law_fn law, double range, double radii) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.law = law;
    desc.law_memory = 1;
    desc.law_stiffness = 200;
    desc.law_range = (dem_real)range;
    desc.law_range_radii = (dem_real)radii;
    desc.dt = DEM_R(5e-6);
    desc.threads = 1;
    return desc;
}

/* --- one body of 1 mm above a wall, thrown at it: as it is with a range of g, or thicker by g --- */
enum { PLANE, INSIDE, OUTSIDE, STEP, TRENCH, PROFILE, GRAINS, WIRES, BARS, SQUARE, SLOTS, ROUND,
       REDUCED, WALLS };
static const double R = 1e-3, g = 4e-4;
static void wall_add(dem_world *w, dem_material m, int kind) {
    dem_sieve_desc s = DEM_SIEVE_DESC;
    /* floor, riser and floor a millimetre lower (or higher); two strips each */
    dem_real v[8*3], deep = kind == STEP ? DEM_R(-1e-3) : DEM_R(1e-3);
    int32_t t[18] = {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4, 4, 5, 7, 4, 7, 6};
    const dem_mesh mesh = {8, 6, v, t};
    dem_real u[8] = {-0.03f, 0, 0, 0, 0, DEM_R(-1e-3), 0.03f, DEM_R(-1e-3)};
    int32_t e[6] = {0, 1, 1, 2, 2, 3};
    const dem_profile profile = {4, 3, u, e};
    dem_real balls[3*25];
    int i;
    for (i = 0; i < 8; i++) {
        const double x[] = {-0.03, 0, 0, 0.03};
        v[3*i] = (dem_real)x[i/2];
        v[3*i + 1] = i%2 ? DEM_R(0.03) : DEM_R(-0.03);
        v[3*i + 2] = i/2 < 2 ? 0 : deep;
    }
    for (i = 0; i < 25; i++) {
        balls[3*i] = (dem_real)((i%5 - 2)*2.4e-3);
        balls[3*i + 1] = (dem_real)((i/5 - 2)*2.4e-3);
        balls[3*i + 2] = 0;
    }
    s.aperture = DEM_R(1.1e-3);
    s.bar = DEM_R(0.5e-3);
    s.length = kind == SLOTS ? DEM_R(3e-3) : 0;
    s.thickness = kind > BARS && kind < REDUCED ? DEM_R(0.4e-3) : 0;
    s.clearance = kind == REDUCED ? DEM_R(0.5) : 0;
    s.lift = kind == WIRES ? DEM_R(0.2e-3) : 0;
    s.kind = kind == WIRES ? DEM_SIEVE_WIRES : kind == BARS ? DEM_SIEVE_BARS
        : kind == SQUARE ? DEM_SIEVE_SQUARE : kind == SLOTS ? DEM_SIEVE_SLOTS
        : kind == ROUND ? DEM_SIEVE_ROUND : DEM_SIEVE_REDUCED;
    switch (kind) {
    case PLANE: dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1)); break;
    case INSIDE: dem_wall_cylinder_add(w, m, at(0, 0, 5e-3), at(0, 1, 0), DEM_R(5e-3), 1); break;
    case OUTSIDE: dem_wall_cylinder_add(w, m, at(0, 0, -4e-3), at(0, 1, 0), DEM_R(4e-3), 0); break;
    case STEP: case TRENCH: dem_wall_mesh_add(w, m, &mesh); break;
    case PROFILE: dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED); break;
    case GRAINS: dem_wall_grains_add(w, m, 25, balls, DEM_R(1.2e-3), 1); break;
    default: dem_wall_sieve_add(w, m, &s);
    }
}
/* Where the body is after 8 ms, and how often it has bounced off (in *turns). */
static dem_vec3 thrown(int kind, int cluster, int thicker, uint64_t seed, int *turns) {
    dem_world_desc desc = desc_of(shell, thicker ? 0 : g, 0);
    const double r = thicker ? R + g : R;
    const dem_real three[] = {DEM_R(-4e-4), 0, DEM_R(2e-4), DEM_R(4e-4), 0, 0, 0, DEM_R(5e-4), 0};
    dem_cluster_desc balls = DEM_CLUSTER_DESC;
    dem_world *w;
    dem_material m;
    dem_body body;
    dem_vec3 x;
    dem_real last = 0;
    int i;
    desc.cluster_contacts = DEM_CLUSTER_CONTACTS_SEPARATE;
    desc.gravity = kind == PROFILE ? at(0, -9.81, 0) : at(0, 0, -9.81);
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 1, 0, 0);
    wall_add(w, m, kind);
    x = scene_at(&seed, 4e-3, -2e-3, 4e-3, -2e-3, 0.5e-3, 2.9e-3);
    if (kind == PROFILE) x = at((double)x.x, (double)x.z, (double)x.y);
    if (cluster) {
        dem_shape shape;
        balls.count = 3;
        balls.positions = three;
        balls.radius = (dem_real)r;
        balls.mass = DEM_CLUSTER_GIVEN;
        balls.volume = DEM_R(6e-9);
        for (i = 0; i < 3; i++) balls.inertia[i] = (dem_real)((3 + i)*1e-15);
        shape = dem_shape_cluster_add(w, &balls);
        body = dem_body_add(w, m, shape, x, dem_quat_make(1, DEM_R(0.3), DEM_R(-0.2), DEM_R(0.6)));
    } else {
        /* of the same mass */
        dem_material_desc heavy = scene_stuff(1e7, 1, 0, 0);
        heavy.density *= (dem_real)((R/r)*(R/r)*(R/r));
        body = dem_sphere_add(w, dem_material_add(w, &heavy), (dem_real)r, x);
    }
    scene_move(w, body, scene_at(&seed, 0.4, -0.2, 0.4, -0.2, -0.3, -0.2), at(0, 0, 0));
    if (kind == PROFILE) scene_move(w, body, at(0.1, -0.4, 0.1), at(0, 0, 0));
    *turns = 0;
    for (i = 0; i < 1600; i++) {
        dem_body_state s;
        dem_real up;
        CHECK_EQ(scene_step(w, 1), DEM_OK);
        s = scene_state(w, body);
        up = kind == PROFILE ? s.velocity.y : s.velocity.z;
        *turns += last < 0 && up >= 0;
        last = up;
        x = s.position;
    }
    dem_world_destroy(w);
    return x;
}

/* --- a gas in a periodic box: spheres of two radii, and clusters or ellipsoids if asked for --- */
static dem_world *gas(dem_world_desc desc, int shapes, int walls, double thicker, double wider) {
    const dem_real two[] = {DEM_R(-5e-4), 0, 0, DEM_R(5e-4), 0, 0};
    dem_cluster_desc pair = DEM_CLUSTER_DESC;
    dem_world *w;
    dem_material_desc stuff[2];
    dem_material m[2], given;                  /* of grains; of what has a given volume */
    uint64_t seed = 11;
    int i, k;
    for (k = 0; k < 3; k++) desc.boundary[k] = k < 2 || !walls ? DEM_BOUNDARY_PERIODIC
                                                               : DEM_BOUNDARY_OPEN;
    desc.domain = box_of(0, 0, 0, 0.02, 0.016, 0.016);
    w = dem_world_create(&desc);
    for (k = 0; k < 2; k++) {
        const double r = k ? 1e-3 : 0.7e-3, thick = r*(1 + wider) + thicker;
        stuff[k] = scene_stuff(1e7, 1, 0, 0);
        stuff[k].density *= (dem_real)(r*r*r/(thick*thick*thick));
        m[k] = dem_material_add(w, &stuff[k]);
    }
    given = scene_material(w, 1e7, 1, 0, 0);
    pair.count = 2;
    pair.positions = two;
    pair.radius = (dem_real)(0.7e-3 + thicker);
    pair.mass = DEM_CLUSTER_GIVEN;
    pair.volume = DEM_R(2e-9);
    for (i = 0; i < 3; i++) pair.inertia[i] = (dem_real)((3 + i)*1e-16);
    for (i = 0; i < 120; i++) {                /* places of a lattice: nothing overlaps */
        const double r = i%2 ? 1e-3 : 0.7e-3, x = (i%6 + 0.5)/6*0.02, y = (i/6%5 + 0.5)/5*0.016;
        const double z = (i/30 + 0.5)/4*0.016;
        const dem_vec3 place = scene_at(&seed, 2e-4, x, 2e-4, y, 2e-4, z);
        const dem_vec3 v = scene_at(&seed, 2, -1, 2, -1, 2, -1);
        dem_body body;
        if (shapes && i%4 == 1)
            body = dem_body_add(w, given, i%8 == 1 || shapes == 1 ? dem_shape_cluster_add(w, &pair)
                : dem_shape_ellipsoid_add(w, at(1.2e-3, 0.6e-3, 0.8e-3)), place,
                dem_quat_make(1, (dem_real)i, 2, -1));
        else body = dem_sphere_add(w, m[i%2], (dem_real)(r*(1 + wider) + thicker), place);
        scene_move(w, body, v, at(0, 0, 0));
    }
    if (walls) {
        dem_real v[12] = {-0.01f, -0.01f, 0, 0.03f, -0.01f, 0, 0.03f, 0.03f, 0, -0.01f, 0.03f, 0};
        int32_t t[6] = {0, 1, 2, 0, 2, 3};
        const dem_mesh floor_ = {4, 2, v, t};
        dem_wall_mesh_add(w, m[0], &floor_);
        dem_wall_plane_add(w, m[0], at(0, 0, 0.016), at(0, 0, -1));
    }
    return w;
}
static double apart(dem_world *a, dem_world *b) {
    const dem_bodies p = dem_bodies_get(a), q = dem_bodies_get(b);
    double most = 0;
    int i, j, k;
    for (i = 0; i < p.count; i++)
        for (j = 0; j < q.count; j++)
            for (k = 0; p.slots[i] == q.slots[j] && k < 3; k++) {
                double d = fabs((double)(p.positions[4*i + k] - q.positions[4*j + k]));
                if (d > 0.008) d = 0;          /* on either side of a periodic face */
                if (d > most) most = d;
            }
    return most;
}
/* A gas of bridges: what is left of it after 800 steps. bridges: how many there are then. */
static uint64_t bridges(int search, double skin, int threads, int slabs, int *count) {
    dem_world_desc desc = desc_of(bridge, 4e-4, 0);
    dem_world *w;
    static dem_contact_info list[4000];
    uint64_t hash;
    int n, i;
    desc.search = (dem_search)search;
    desc.skin = (dem_real)skin;
    desc.threads = threads;
    w = gas(desc, 2, 1, 0, 0);
    if (slabs) {
        dem_slabs_desc sd = DEM_SLABS_DESC;
        dem_slabs *s;
        sd.axis = 0;
        sd.count = slabs;
        s = dem_slabs_create(w, &sd);
        CHECK(s != 0);
        CHECK_EQ(dem_slabs_step(s, 800), DEM_OK);
        if (dem_slabs_error_get(s)[0]) puts(dem_slabs_error_get(s));
        CHECK_EQ(dem_slabs_collect(s, w), DEM_OK);
        dem_slabs_destroy(s);
    } else CHECK_EQ(scene_step(w, 800), DEM_OK);
    dem_candidates_rebuild(w);
    n = dem_contacts_get(w, list, 4000);
    for (i = 0, *count = 0; i < n; i++)
        *count += !(list[i].overlap > 0) && demi_length(list[i].force) > 0;
    hash = dem_world_hash_get(w);
    dem_world_destroy(w);
    return hash;
}

/* The gap at which a bridge of two lets go that meet and are drawn apart: everything moves on at
   `along` besides, across periodic borders and many lists. other: what the first meets, a sphere
   of 1 mm: 0: another, 1: a plane, 2: a cluster, 3: an ellipsoid. */
static double let_go(int other, double along, double skin) {
    dem_world_desc desc = desc_of(bridge, 4e-4, 0);
    const dem_real two[] = {0, 0, DEM_R(2e-4), 0, 0, DEM_R(-2e-4)};
    dem_cluster_desc pair = DEM_CLUSTER_DESC;
    dem_world *w;
    dem_material m;
    dem_body a, b;
    double gap = -1;
    int i, met = 0;
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    desc.domain = box_of(0, 0, -0.01, 0.01, 0.01, 0.01);
    desc.skin = (dem_real)skin;
    desc.ellipsoid_overlap = DEM_OVERLAP_NORMAL;           /* there gaps are distances */
    desc.dt = DEM_R(1e-6);
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 1, 0, 0);
    pair.count = 2;
    pair.positions = two;
    pair.radius = DEM_R(0.8e-3);
    a = dem_sphere_add(w, m, DEM_R(1e-3), at(9.9e-3, 9.9e-3, 1.05e-3));
    b.slot = b.generation = 0;
    if (other == 0) b = dem_sphere_add(w, m, DEM_R(1e-3), at(9.9e-3, 9.9e-3, -1e-3));
    if (other == 1) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    if (other >= 2) b = dem_body_add(w, m, other == 2 ? dem_shape_cluster_add(w, &pair)
        : dem_shape_ellipsoid_add(w, at(0.7e-3, 0.8e-3, 1e-3)), at(9.9e-3, 9.9e-3, -1e-3),
        dem_quat_make(1, 0, 0, 0));
    for (i = 0; i < 40000 && gap < 0; i++) {   /* held by hand: down, then up */
        dem_body_state s = scene_state(w, a);
        dem_contact_info c[4];
        int n, k, pulls = 0;
        const double z = i < 2000 ? 1.05e-3 - 5e-8*i : 0.95e-3 + 5e-8*(i - 2000);
        s.position = at(fmod(9.9e-3 + along*i*1e-6, 0.01), fmod(9.9e-3 + along*i*1e-6, 0.01), z);
        s.velocity = at(along, along, i < 2000 ? -5e-2 : 5e-2);
        dem_body_set(w, a, &s);
        if (b.slot) {
            dem_body_state t = scene_state(w, b);
            t.position = at((double)s.position.x, (double)s.position.y, -1e-3);
            t.velocity = at(along, along, 0);
            t.spin = at(0, 0, 0);
            t.orientation = dem_quat_make(1, 0, 0, 0);
            dem_body_set(w, b, &t);
        }
        CHECK_EQ(scene_step(w, 1), DEM_OK);
        n = dem_contacts_get(w, c, 4);
        for (k = 0; k < n; k++) pulls |= demi_length(c[k].force) > 0;
        if (!met) CHECK(z < 1.001e-3 || !pulls);
        met |= pulls;
        if (met && !pulls) gap = z - 1e-3;
    }
    dem_world_destroy(w);
    return gap;
}

static dem_contact seen;
static void look(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory; (void)f;
    seen = *c;
}

static double seen_overlap;
static void notes_overlap(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    seen_overlap = (double)c->overlap;
    f->normal = 0;
}
static int large_calls;
static void counts_large(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    large_calls += c->who.radius_a > DEM_R(4e-3) && c->who.radius_b > DEM_R(4e-3);
    f->normal = 0;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a law with a range acts on a wall as on a grain thicker by the range, for walls of every kind") {
        int kind, cluster, turns, most = 0, again;
        uint64_t seed;
        for (kind = 0; kind < WALLS; kind++)
            for (cluster = 0; cluster < 2; cluster++)
                for (seed = 1, most = 0; seed < 7; seed++) {
                    dem_vec3 x, y;
                    /* what a hole lets pass, and how two rims share, go by the grain itself */
                    if (kind == ROUND || kind == REDUCED) continue;
                    x = thrown(kind, cluster, 0, seed, &turns);
                    y = thrown(kind, cluster, 1, seed, &again);
                    most = turns > most ? turns : most;
                    /* round-off, after up to 5 bounces */
                    CHECK_NEAR(demi_length(demi_sub(x, y)), 0, DEMI_SINGLE ? 2e-5 : 1e-10);
                    if (seed == 6) CHECK(most > 0);
                }
    }
    TEST("plates with round holes and reduced holes keep a grain at the range") {
        int kind, turns;
        uint64_t seed;
        for (kind = ROUND; kind <= REDUCED; kind++)
            for (seed = 1; seed < 7; seed++) {
                const dem_vec3 x = thrown(kind, 0, 0, seed, &turns);
                CHECK(turns > 0 && (double)x.z > R);
            }
    }
    TEST("in a gas of spheres and clusters a law with a range acts as thicker ones do") {
        int shapes, k;
        for (shapes = 0; shapes < 2; shapes++)
            for (k = 0; k < 2; k++) {          /* in m; in radii */
                dem_world_desc desc = desc_of(shell, k ? 0 : 3e-4, k ? 0.2 : 0);
                dem_world *a, *b;
                desc.cluster_contacts = DEM_CLUSTER_CONTACTS_SEPARATE;
                if (shapes && k) continue;     /* a cluster's spheres would not lie as they did */
                a = gas(desc, shapes, 0, 0, 0);
                desc.law_range = desc.law_range_radii = 0;
                b = gas(desc, shapes, 0, k ? 0 : 1.5e-4, k ? 0.2 : 0);
                CHECK_EQ(scene_step(a, 500), DEM_OK);
                CHECK_EQ(scene_step(b, 500), DEM_OK);
                /* round-off, grown by some collisions each */
                CHECK_NEAR(apart(a, b), 0, DEMI_SINGLE ? 3e-4 : 1e-9);
                CHECK(dem_counters_get(b).contacts > 0);
                dem_world_destroy(a);
                dem_world_destroy(b);
            }
    }
    TEST("bridges have the same bits for any search, and the same number for any skin") {
        int first = 0, count = 0, k;
        const uint64_t hash = bridges(DEM_SEARCH_ALL_PAIRS, 0, 1, 0, &first);
        CHECK(first > 20);
        for (k = DEM_SEARCH_GRID; k <= DEM_SEARCH_HIERARCHICAL; k++) {
            CHECK_EQ(bridges(k, 0, 1, 0, &count), hash);
            CHECK_EQ(count, first);
        }
        for (k = -1; k < 2; k++) {             /* lists then are made at other times: other sums */
            bridges(0, k < 0 ? -1 : k ? 5e-4 : 1e-5, 2, 0, &count);
            CHECK_EQ(count, first);
        }
    }
    TEST("bridges across slab borders have the same bits for any threads, and the number of one world") {
        int first, count = 0, k;
        bridges(0, 0, 1, 0, &first);
        for (k = 2; k < 4; k++) {
            const uint64_t hash = bridges(0, 0, 1, k, &count);
            CHECK_NEAR(count, first, 4);       /* sums have another order there: a gas tells */
            CHECK_EQ(bridges(0, 0, 2, k, &count), hash);
        }
    }
    TEST("a bridge forms at contact and lasts to its rupture, across periodic borders and rebuilt lists") {
        int other;
        for (other = 0; other < 4; other++) {
            /* a step of 5e-8 m, and that of the time at which it is looked at */
            CHECK_NEAR(let_go(other, 0, 0), rupture, 1.5e-7);
            CHECK_NEAR(let_go(other, 0.7, 2e-5), rupture, 1.5e-7);
            CHECK_NEAR(let_go(other, -0.7, -1), rupture, 1.5e-7);
        }
    }
    TEST("a law with a range sees two ellipsoids, or one and a grain of a wall, as soon as they are within the range") {
        uint64_t seed = 5;
        int i, wall, listed[2] = {0, 0}, not_listed[2] = {0, 0};
        for (i = 0; i < 3000; i++) {
            dem_world_desc desc = desc_of(look, 2e-4, 0);
            dem_world *w;
            dem_material m;
            const dem_vec3 axes = at(1e-3, 0.5e-3, 0.2e-3);
            dem_ellipsoid p = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0, 0}}, q = p;
            dem_ellipsoid_contact c;
            dem_contact_info one;
            double gap;
            wall = i%2;
            desc.dt = DEM_R(1e-6);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e7, 1, 0, 0);
            p.semi_axes = q.semi_axes = axes;
            if (wall) p.semi_axes = at(0.6e-3, 0.6e-3, 0.6e-3);
            q.position = scene_at(&seed, 2.4e-3, -1.2e-3, 2.4e-3, -1.2e-3, 1.6e-3, -0.8e-3);
            q.orientation = dem_quat_make(1, (dem_real)scene_random(&seed), (dem_real)scene_random(&seed), 0);
            c = dem_ellipsoids_contact_get(&p, &q, 0);
            gap = (double)demi_length(q.position)*(1 - 1/(double)c.scale);
            if (wall) dem_wall_grains_add(w, m, 1, &p.position.x, p.semi_axes.x, 1);
            else dem_body_add(w, m, dem_shape_ellipsoid_add(w, axes), p.position, p.orientation);
            dem_body_add(w, m, dem_shape_ellipsoid_add(w, axes), q.position, q.orientation);
            if (fabs(gap - 2e-4) > 1e-7 && gap > -5e-5) {      /* not on the edge; not too deep */
                CHECK_EQ(scene_step(w, 1), DEM_OK);            /* nothing pushes, nothing moves */
                CHECK_EQ(dem_contacts_get(w, &one, 1), gap < 2e-4);
                if (gap < 2e-4) listed[wall]++; else not_listed[wall]++;
            }
            dem_world_destroy(w);
        }
        for (wall = 0; wall < 2; wall++) CHECK(listed[wall] > 100 && not_listed[wall] > 100);
    }
    TEST("across a gap a law acts at the middle of an edge or a face that is parallel to a wall or to another body") {
        const double tilts[] = {0, 1e-4, 1e-2};         /* rad */
        int kind, below, i;
        for (kind = 0; kind < 6; kind++) {      /* shape: the edge of a tetrahedron, the face of a box; on what */
            double arm[3];
            below = kind/2;
            for (i = 0; i < 3; i++) {
                dem_world_desc desc = desc_of(shell, g, 0);
                dem_sieve_desc s = DEM_SIEVE_DESC;
                dem_real four[12] = {-1e-3f, 0, 0, 1e-3f, 0, 0, 0, -1e-3f, DEM_R(1.4e-3), 0, 1e-3f, DEM_R(1.4e-3)};
                const double half = tilts[i]/2;
                dem_shape shape;
                dem_material m;
                dem_world *w;
                desc.dt = DEM_R(1e-7);
                w = dem_world_create(&desc);
                m = scene_material(w, 1e7, 1, 0, 0);
                shape = kind%2 ? scene_box(w, 1e-3, 1e-3, 1e-3) : dem_shape_polyhedron_add(w, 4, four);
                s.kind = DEM_SIEVE_SQUARE;
                s.aperture = DEM_R(1e-2);
                s.bar = DEM_R(1e-2);
                s.thickness = DEM_R(1e-3);
                if (below == 0) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
                if (below == 1) dem_wall_sieve_add(w, m, &s);     /* its top: half its thickness higher */
                if (below == 2) {
                    dem_body_add(w, m, scene_box(w, 5e-3, 5e-3, 1e-3), at(0, 0, -5e-4), dem_quat_make(1, 0, 0, 0));
                    dem_bodies_fixed_set(w, 0, 1);
                }
                dem_body_add(w, m, shape, at(below == 1 ? 0.01 : 0, 0, (kind%2 ? 0.7e-3 : 0.9e-3) + (below == 1 ? 5e-4 : 0)),
                             dem_quat_make(1, 0, DEM_R(half), 0));
                CHECK_EQ(scene_step(w, 1), DEM_OK);
                arm[i] = (double)w->bodies.torque[4*(below == 2) + 1]/(double)w->bodies.force[4*(below == 2) + 2];
                dem_world_destroy(w);
            }
            CHECK_NEAR(arm[0], 0, DEMI_SINGLE ? 1e-7 : 1e-12);
            CHECK(arm[1] < -2e-5 && arm[1] > -4e-4);           /* on the way from the middle to one end */
            CHECK_NEAR(arm[2], kind%2 ? -5e-4 : -1e-3, 1e-5);
        }
    }
    TEST("a law with law_who receives ids, radii, masses, position and time") {
        dem_world_desc desc = desc_of(look, 0, 0);
        dem_world *w;
        dem_material m;
        dem_body a, b;
        desc.law_who = 1;
        w = dem_world_create(&desc);
        m = scene_material(w, 1e7, 1, 0, 0);
        a = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 0));
        b = dem_sphere_add(w, m, DEM_R(2e-3), at(0, 0, 2.9e-3));
        CHECK_EQ(scene_step(w, 3), DEM_OK);
        CHECK_EQ(seen.who.a.slot, a.slot);
        CHECK_EQ(seen.who.b.slot, b.slot);
        CHECK_EQ(seen.who.b.generation, b.generation);
        CHECK_NEAR(seen.who.radius_b, 2e-3, 1e-9);
        CHECK_NEAR(seen.who.mass_a, scene_state(w, a).mass, 1e-12);
        CHECK_NEAR(seen.who.point.z, 2.9e-3/3, 1e-9);
        CHECK_NEAR(seen.who.time, 1.5e-5, 1e-9);
        dem_body_remove(w, b);
        dem_wall_plane_add(w, m, at(0, 0, -0.9e-3), at(0, 0, 1));
        CHECK_EQ(scene_step(w, 1), DEM_OK);
        CHECK_EQ(seen.who.b.slot, 0);
        CHECK_EQ(seen.wall, 1);
        CHECK_NEAR(seen.who.radius_a, 1e-3, 1e-9);
        CHECK_NEAR(seen.who.radius_b, 0, 1e-12);
        CHECK_NEAR(seen.who.point.z, -1e-3, 1e-9);
        dem_world_destroy(w);
    }
    TEST("a feed's grain within range of others feels them from its first step on") {
        dem_world_desc desc = desc_of(shell, 5e-4, 0);
        dem_feed_desc feed;
        dem_world *w;
        dem_material m;
        dem_bodies all;
        int i;
        memset(&feed, 0, sizeof feed);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e7, 1, 0, 0);
        feed.material = m;
        feed.class_count = 1;
        feed.radius[0] = DEM_R(1e-3);
        feed.amount[0] = 1;
        feed.rate = 1e4;
        feed.end = 3.5e-3;
        feed.box = box_of(0, 0, 0, 8e-3, 8e-3, 8e-3);
        dem_feed_add(w, &feed);
        for (i = 0; i < 4; i++) dem_sphere_add(w, m, DEM_R(1e-3), at(2e-3*i, 2e-3, 2.2e-3));
        CHECK_EQ(scene_step(w, 400), DEM_OK);
        all = dem_bodies_get(w);
        CHECK(all.count > 10);
        {                                      /* momentum: a force that one of two felt alone */
            double sum[3] = {0, 0, 0};
            int k;
            for (i = 0; i < all.count; i++)
                for (k = 0; k < 3; k++)
                    sum[k] += (double)all.masses[i]*(double)all.velocities[4*i + k];
            for (k = 0; k < 3; k++) CHECK_NEAR(sum[k], 0, DEMI_SINGLE ? 1e-9 : 1e-16);
        }
        dem_world_destroy(w);
    }
    TEST("energy of a law that does not set force->energy is reported as unknown to the ledger") {
        int k;
        for (k = 0; k < 2; k++) {              /* a law of 4 lines; one that calls dem.h's */
            dem_world_desc desc = desc_of(k ? dem_law_linear : shell, 0, 0);
            dem_world *w;
            dem_material m;
            dem_body body;
            dem_ledger l;
            desc.ledger = 1;
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.law_memory = 0;
            w = dem_world_create(&desc);
            m = scene_material(w, 1e5, 0.5, 0, 0);
            dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
            body = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 1e-3));
            scene_move(w, body, at(0, 0, -0.5), at(0, 0, 0));
            CHECK_EQ(scene_step(w, 4), DEM_OK);
            l = dem_ledger_get(w);
            if (k) {
                CHECK(l.elastic > 0 && fabs(l.residual) > 0);
                CHECK_NEAR(l.unknown, 0, 0);
                scene_report_has(w, "of the throughput)");
            } else {                           /* what the spring holds now: k d^2/2 */
                const double d = 1e-3 - (double)scene_state(w, body).position.z;
                CHECK_NEAR(l.unknown, -100*d*d, 1e-2*100*d*d);     /* half a step of 4 */
                CHECK_NEAR(l.residual, 0, 0);
                scene_report_has(w, "unknown to the ledger: -");
            }
            dem_world_destroy(w);
        }
    }
    TEST("the report gives the range of a law") {
        dem_world_desc desc = desc_of(shell, 1e-4, 0.1);
        dem_world *w = dem_world_create(&desc);
        dem_sphere_add(w, scene_material(w, 1e5, 0.5, 0, 0), DEM_R(1e-3), at(0, 0, 1e-3));
        CHECK_EQ(scene_step(w, 1), DEM_OK);
        scene_report_has(w, "gaps below 0.0003 m");
        dem_world_destroy(w);
    }
    TEST("a range without a law, below 0 or with DEM_EDGE_FRACTION segments is rejected with an error") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_real v[4] = {0, 0, 1, 0};
        int32_t s[2] = {0, 1};
        const dem_profile p = {2, 1, v, s};
        dem_world *w;
        desc.law_range = 1;
        CHECK_STR(dem_world_create_error_get(&desc), "law is null");
        desc.law = shell;
        desc.law_range_radii = -1;
        CHECK_STR(dem_world_create_error_get(&desc), "law_range_radii must be finite and >= 0");
        desc.law_range_radii = 0;
        w = dem_world_create(&desc);
        CHECK_EQ(dem_wall_profile_add(w, scene_material(w, 1e7, 1, 0, 0), &p, DEM_EDGE_FRACTION).id, 0);
        CHECK_STR(dem_world_error_get(w), "DEM_EDGE_RESOLVED");
        dem_world_destroy(w);
    }

    TEST("across a gap the overlap of an ellipsoid with an ellipsoid, sphere or plane is minus the gap, "
         "also by chords") {
        static const dem_overlap overlaps[2] = {DEM_OVERLAP_CHORD, DEM_OVERLAP_NORMAL};
        static const double gaps[3] = {0.01, 0.04, -0.01};
        int mode, other, k;
        for (mode = 0; mode < 2; mode++)
            for (other = 0; other < 3; other++)
                for (k = 0; k < 3; k++) {
                    dem_world_desc desc = desc_of(notes_overlap, 0.05, 0);
                    dem_world *w;
                    dem_material m;
                    dem_shape egg;
                    desc.ellipsoid_overlap = overlaps[mode];
                    w = dem_world_create(&desc);
                    m = scene_material(w, 1e7, 1, 0, 0);
                    egg = dem_shape_ellipsoid_add(w, at(0.3, 0.4, 0.5));
                    dem_body_add(w, m, egg, at(0, 0, 0.5), dem_quat_make(1, 0, 0, 0));
                    if (other == 0) dem_body_add(w, m, egg, at(0, 0, -0.5 - gaps[k]), dem_quat_make(1, 0, 0, 0));
                    if (other == 1) dem_sphere_add(w, m, DEM_R(0.5), at(0, 0, -0.5 - gaps[k]));
                    if (other == 2) dem_wall_plane_add(w, m, at(0, 0, -gaps[k]), at(0, 0, 1));
                    seen_overlap = 9;
                    CHECK_EQ(scene_step(w, 1), DEM_OK);
                    CHECK_NEAR(seen_overlap, -gaps[k], sizeof(dem_real) == 4 ? 1e-5 : 1e-9);
                    dem_world_destroy(w);
                }
    }

    TEST("law_range_radii reaches as far between fed grains that are larger than all before as between added ones") {
        int fed, i;
        for (fed = 0; fed < 2; fed++) {
            dem_world_desc desc = desc_of(counts_large, 0, 0.5);
            dem_feed_desc feed = DEM_FEED_DESC;
            dem_world *w;
            dem_material m;
            desc.law_who = 1;
            desc.dt = DEM_R(1e-5);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e7, 1, 0, 0);
            for (i = 0; i < 60; i++) dem_sphere_add(w, m, (dem_real)(1e-3 + 1e-6*i), at(0.02*i, 0.3, 0));
            feed.material = m;
            feed.class_count = 1;
            feed.radius[0] = DEM_R(5e-3);
            feed.amount[0] = 1;
            feed.limited = 1;
            feed.start = 20e-5 - 1e-9;
            for (i = 0; i < 2; i++) {                  /* gap 4 mm, range 0.5 (5 + 5) = 5 mm */
                feed.box = box_of(0.014*i, 0, 0, 0.014*i, 0, 0);
                if (fed) CHECK(dem_feed_add(w, &feed).id);
            }
            CHECK_EQ(scene_step(w, 20), DEM_OK);
            for (i = 0; i < 2 && !fed; i++) dem_sphere_add(w, m, DEM_R(5e-3), at(0.014*i, 0, 0));
            CHECK_EQ(scene_step(w, 2), DEM_OK);
            large_calls = 0;
            CHECK_EQ(scene_step(w, 50), DEM_OK);
            CHECK_EQ(dem_body_counts_get(w).present, 62);
            CHECK_EQ(large_calls, 50);
            dem_world_destroy(w);
        }
    }
    return test_end();
}
