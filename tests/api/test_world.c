/* The world as its user meets it: what it refuses and how it says so, what it counts, what it
   leaves alone, and what walls do. A call that is refused leaves the digest of the world as it was.
   */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double pi = 3.14159265358979323846;
static const double nan_number = (double)NAN, infinite = (double)INFINITY;

static dem_vec3 cross(dem_vec3 a, dem_vec3 b) {
    return dem_vec3_make(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}
static double length(dem_vec3 a) { return sqrt((double)(a.x*a.x + a.y*a.y + a.z*a.z)); }
static double apart(dem_vec3 a, dem_vec3 b) {
    return length(dem_vec3_make(a.x - b.x, a.y - b.y, a.z - b.z));
}

/* A few grains with friction on a plane, after some steps: something to lose. */
static dem_world *small_world(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    desc.threads = 1;
    desc.dt = DEM_R(2e-6);
    desc.gravity = at(0, 0, -9.81);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.5, 0.3, 0);
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    scene_block(world, glass, 3, 3, 2, 1e-3, 1, 0.2, 1);
    scene_step(world, 20);
    return world;
}
/* The call that gave `result` was refused: code, sentence, and the world as `hash` says. */
static void refused(const dem_world *world, dem_result result, dem_result code, uint64_t hash,
                    const char *call,
                    const char *value, const char *limit) {
    CHECK_EQ(result, code);
    CHECK(strncmp(dem_world_error_get(world), call, strlen(call)) == 0);
    CHECK_STR(dem_world_error_get(world), call);
    CHECK_STR(dem_world_error_get(world), value);
    CHECK_STR(dem_world_error_get(world), limit);
    CHECK(strlen(dem_world_error_get(world)) > 30);
    CHECK_EQ(dem_world_hash_get(world), hash);
}
/* The same for a call that answers an id. */
static void refused_id(const dem_world *world, int id, uint64_t hash, const char *call,
                       const char *value,
                       const char *limit) {
    CHECK_EQ(id, 0);
    refused(world, DEM_ERROR_ARGUMENT, DEM_ERROR_ARGUMENT, hash, call, value, limit);
}

static void *alloc_nothing(size_t size, void *user) { (void)size; (void)user; return 0; }
static void *alloc_some(size_t size, void *user) { ++*(int *)user; return malloc(size); }
static void free_some(void *memory, size_t size, void *user) {
    (void)size;
    --*(int *)user;
    free(memory);
}

static dem_vec3 nan_force(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double time, void *user) {
    (void)x; (void)v; (void)r; (void)m;
    return at(time >= *(double *)user ? nan_number : 0, 0, 0);
}
static dem_vec3 up_force(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double time, void *user) {
    (void)x; (void)v; (void)r; (void)time; (void)user;
    return at(0, 0, 5*(double)m);
}
static void nan_motion(double time, dem_pose *pose, void *user) {
    pose->position = at(0, 0, time >= *(double *)user ? nan_number : 0);
}
/* A wall that circles with 3 cm and turns about z: any smooth motion will do. */
static void circling(double time, dem_pose *pose, void *user) {
    const double w = *(double *)user, c = cos(w*time), s = sin(w*time);
    pose->position = at(0.03*c, 0.03*s, 0);
    pose->velocity = at(-0.03*w*s, 0.03*w*c, 0);
    pose->rotation[0] = (dem_real)c; pose->rotation[1] = (dem_real)-s; pose->rotation[2] = 0;
    pose->rotation[3] = (dem_real)s; pose->rotation[4] = (dem_real)c;  pose->rotation[5] = 0;
    pose->rotation[6] = 0;           pose->rotation[7] = 0;            pose->rotation[8] = 1;
    pose->spin = at(0, 0, w);
}

/* The built-in linear law with viscous friction, spelled out. */
static void linear_law(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    const dem_real fn = c->kn*c->overlap + c->cn*c->closing_speed, limit =
        fn > 0 ? c->friction*fn : 0;
    const dem_vec3 t = dem_vec3_make(-c->ct*c->slip.x, -c->ct*c->slip.y, -c->ct*c->slip.z);
    const double size = length(t);
    const dem_real cut = size > (double)limit ? (dem_real)((double)limit/size) : 1;
    (void)memory;
    push->normal = fn;
    push->tangent = dem_vec3_make(cut*t.x, cut*t.y, cut*t.z);
}

/* One grain slides over a floor of a kind; its force at each of `steps` steps. */
enum { FLOOR_PLANE, FLOOR_MESH, FLOOR_PROFILE };
enum { SLIDE_STEPS = 400 };
static void slide(int floor_kind, dem_tangent_law law, dem_vec3 start, dem_vec3 velocity,
                  dem_vec3 *force,
                  dem_vec3 *torque) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    dem_body ball;
    int i;
    desc.threads = 1;
    desc.dt = DEM_R(2e-6);
    desc.allow_large_dt = 1;
    desc.tangent_law = law;
    desc.gravity = floor_kind == FLOOR_PROFILE ? at(0, -9.81, 0) : at(0, 0, -9.81);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e6, 0.6, 0.4, 0);
    if (floor_kind == FLOOR_MESH) scene_floor(world, glass, -4e-3, -4e-3, 4e-3, 4e-3, 8, 8);
    else if (floor_kind == FLOOR_PLANE) dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, glass, DEM_R(1e-3), start);
    scene_move(world, ball, velocity, at(0, 0, 0));
    for (i = 0; i < SLIDE_STEPS; i++) {
        dem_body_state s;
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        s = scene_state(world, ball);
        force[i] = s.force;
        torque[i] = s.torque;
    }
    dem_world_destroy(world);
}

/* A grain of 1 mm held `overlap` deep at x against one wall; its force. */
static dem_vec3 press(dem_world *world, dem_vec3 x, dem_wall_loads *loads, dem_wall wall) {
    dem_material glass;
    dem_body ball;
    dem_body_state s;
    glass.id = 1;
    ball = dem_sphere_add(world, glass, DEM_R(1e-3), x);
    s = scene_state(world, ball);
    s.fixed = 0;
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    s = scene_state(world, ball);
    CHECK_EQ(dem_wall_loads_get(world, wall, loads), DEM_OK);
    CHECK_NEAR(apart(loads->force, at(-(double)s.force.x, -(double)s.force.y,
                                         -(double)s.force.z)), 0,
               1e-12*length(s.force));
    return s.force;
}
static dem_world *one_wall_world(dem_material *glass) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.threads = 1;
    desc.dt = DEM_R(1e-9);
    world = dem_world_create(&desc);
    *glass = scene_material(world, 1e7, 1, 0.3, 0);
    return world;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("bodies can be added and removed any number of times between two steps") {
        dem_world *world = dem_world_create(&DEM_WORLD_DESC);
        const dem_material glass = scene_material(world, 1e7, 0.5, 0.3, 0);
        const dem_body keep = dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0));
        int i;
        for (i = 0; i < 1000; i++) {
            const dem_body body = dem_sphere_add(world, glass, DEM_R(1e-3), at(0.01*i, 1, 0));
            if (i%10) CHECK_EQ(dem_body_remove(world, body), DEM_OK);
        }
        CHECK_EQ(dem_body_counts_get(world).present, 101);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_NEAR(scene_state(world, keep).radius, 1e-3, 1e-9);
        dem_world_destroy(world);
    }
    TEST("a bad value in a world desc is rejected with one error message, and a good desc has none") {
        int what, refusals = 0;
        for (what = 0; what < 20; what++) {
            dem_world_desc d = DEM_WORLD_DESC;
            switch (what) {
            case 0: d.gravity.y = (dem_real)nan_number; break;
            case 1: d.boundary[1] = DEM_BOUNDARY_PERIODIC; break;
            case 2: d.boundary[0] = DEM_BOUNDARY_OUTFLOW; d.domain = box_of(1, 0, 0, 0, 1, 1);
            break;
            case 3: d.boundary[2] = (dem_boundary)7; break;
            case 4: d.planar = 1; d.boundary[2] = DEM_BOUNDARY_PERIODIC; d.domain.hi.z = 1; break;
            case 5: d.thickness = -1; break;
            case 6: d.dt = DEM_R(-1e-6); break;
            case 7: d.dt = (dem_real)infinite; break;
            case 8: d.impact_speed = -1; break;
            case 9: d.skin = (dem_real)nan_number; break;
            case 10: d.threads = 65; break;
            case 11: d.threads = -1; break;
            case 12: d.law_memory = 17; break;
            case 13: d.law_memory = 5; d.law_vectors = 2; break;
            case 14: d.normal_law = (dem_normal_law)3; break;
            case 15: d.tangent_law = (dem_tangent_law)99; break;
            case 16: d.rolling_law = (dem_rolling_law)(-1); break;
            case 17: d.integrator = (dem_integrator)5; break;
            case 18: d.search = (dem_search)9; break;
            default: d.allocator.alloc_fn = alloc_nothing; break;
            }
            refusals += dem_world_create(&d) == 0;
            CHECK(strncmp(dem_world_create_error_get(&d), "dem_world_create: ", 18) == 0);
            CHECK(strlen(dem_world_create_error_get(&d)) > 40);
        }
        CHECK_EQ(refusals, 20);
        CHECK(*dem_world_create_error_get(&DEM_WORLD_DESC) == 0);
        CHECK(dem_world_create_checked(&DEM_WORLD_DESC, DEM_VERSION + 1, sizeof(dem_real)) == 0);
        CHECK(dem_world_create_checked(&DEM_WORLD_DESC, DEM_VERSION, sizeof(dem_real)/2) == 0);
        CHECK_STR(dem_world_error_get(0), "dem_world_create_error_get");
        dem_world_destroy(0);
    }
    TEST("an unknown tension or convention is rejected as the other choices do") {
        dem_world_desc d = DEM_WORLD_DESC;
        d.tension = (dem_tension)5;
        CHECK(*dem_world_create_error_get(&d) != 0);
        d = DEM_WORLD_DESC;
        d.convention = (dem_convention)5;
        CHECK(*dem_world_create_error_get(&d) != 0);
    }
    TEST("a bad material is rejected with the field, its value and the limit") {
        static const struct { int field; double value; const char *name, *limit; } rows[] = {
            {0, 0, "density is 0", "> 0 kg/m3"}, {0, -1, "density is -1", "> 0"},
                {1, 0, "young is 0", "> 0 Pa"},
            {2, 0.5, "poisson is 0.5", "< 0.5"}, {2, -0.1, "poisson is -0.1", ">= 0"},
            {3, 0, "restitution is 0", "> 0 and <= 1"}, {3, 1.1, "restitution is 1.1", "<= 1"},
            {4, -0.1, "friction is -0.1", ">= 0"}, {5, 0.1, "friction_static is 0.1",
                "sliding friction"},
            {6, -1, "rolling_friction is -1", ">= 0"}, {7, -1, "stiffness is -1", ">= 0 N/m"},
            {8, -1, "stiffness_ratio is -1", ">= 0"}};
        dem_world *world = small_world();
        const uint64_t hash = dem_world_hash_get(world);
        size_t i;
        for (i = 0; i < sizeof rows/sizeof *rows; i++) {
            dem_material_desc m = scene_stuff(1e7, 0.5, 0.3, 0);
            dem_real *fields[9];
            fields[0] = &m.density; fields[1] = &m.young; fields[2] = &m.poisson; fields[3] =
                &m.restitution;
            fields[4] = &m.friction; fields[5] = &m.friction_static; fields[6] =
                &m.rolling_friction;
            fields[7] = &m.stiffness; fields[8] = &m.stiffness_ratio;
            *fields[rows[i].field] = (dem_real)rows[i].value;
            refused_id(world, dem_material_add(world, &m).id, hash, "dem_material_add: ",
                       rows[i].name, rows[i].limit);
            *fields[rows[i].field] = (dem_real)nan_number;
            refused_id(world, dem_material_add(world, &m).id, hash, "dem_material_add: ", "nan",
                       "must be");
            *fields[rows[i].field] = (dem_real)infinite;
            refused_id(world, dem_material_add(world, &m).id, hash, "dem_material_add: ", "inf",
                       "must be");
        }
        dem_world_destroy(world);
    }
    TEST("the 65th material is rejected") {
        dem_world *world = dem_world_create(&DEM_WORLD_DESC);
        int i;
        for (i = 0; i < 64; i++) CHECK_EQ(scene_material(world, 1e7, 1, 0, 0).id, i + 1);
        refused_id(world, scene_material(world, 1e7, 1, 0, 0).id, dem_world_hash_get(world),
                   "dem_material_add: ", "64", "limit");
        dem_world_destroy(world);
    }
    TEST("a bad pair is rejected with the field, its value, the limit and both materials") {
        dem_world *world = small_world();
        const uint64_t hash = dem_world_hash_get(world);
        dem_material glass, no;
        dem_pair good, p;
        int i;
        glass.id = 1; no.id = 2;
        refused(world, dem_pair_get(world, glass, no, &p), DEM_ERROR_ARGUMENT, hash,
                "dem_pair_get: ", "material 2", "there are 1");
        CHECK_EQ(dem_pair_get(world, glass, glass, &good), DEM_OK);
        refused(world, dem_pair_set(world, no, glass, &good), DEM_ERROR_ARGUMENT, hash,
                "dem_pair_set: ", "material 2", "there are 1");
        for (i = 0; i < 9; i++) {
            static const char *const names[] = {"young_eff", "shear_eff", "restitution", "friction",
                "friction_static",
                "rolling_friction", "stiffness", "stiffness_ratio", "tangent_damping"};
            dem_real *fields[9];
            fields[0] = &p.young_eff; fields[1] = &p.shear_eff; fields[2] = &p.restitution;
            fields[3] = &p.friction;
            fields[4] = &p.friction_static; fields[5] = &p.rolling_friction; fields[6] =
                &p.stiffness;
            fields[7] = &p.stiffness_ratio; fields[8] = &p.tangent_damping;
            p = good;
            *fields[i] = -1;
            refused(world, dem_pair_set(world, glass, glass, &p), DEM_ERROR_ARGUMENT, hash,
                    "dem_pair_set: ", names[i], "-1");
            p = good;
            *fields[i] = (dem_real)nan_number;
            refused(world, dem_pair_set(world, glass, glass, &p), DEM_ERROR_ARGUMENT, hash,
                    "dem_pair_set: ", names[i], "nan");
        }
        dem_world_destroy(world);
    }
    TEST("a pair without stiffness under the world's law is rejected") {
        dem_world *world = small_world();
        const uint64_t hash = dem_world_hash_get(world);
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc m = scene_stuff(0, 0.5, 0, 0);
        dem_material glass, rubber, spring;
        dem_coefficients k;
        dem_pair p;
        glass.id = 1;
        dem_pair_get(world, glass, glass, &p);
        p.young_eff = 0;
        p.stiffness = 1000;                    /* a spring constant, which Hertz does not look at */
        refused(world, dem_pair_set(world, glass, glass, &p), DEM_ERROR_ARGUMENT, hash,
                "dem_pair_set: ", "young_eff", "> 0");
        dem_world_destroy(world);
        /* one material with a spring constant only, one with a modulus only */
        desc.normal_law = DEM_NORMAL_LINEAR;
        world = dem_world_create(&desc);
        m.stiffness = 1000;
        spring = dem_material_add(world, &m);
        rubber = scene_material(world, 1e7, 0.5, 0, 0);
        if (spring.id && rubber.id) {
            CHECK_EQ(dem_coefficients_get(world, spring, rubber, 1, 1, &k), DEM_OK);
            CHECK((double)k.kn > 0);
        } else CHECK(*dem_world_error_get(world) != 0);
        dem_world_destroy(world);
    }
    TEST("grains with bad numbers are rejected, all or nothing") {
        dem_world *world = small_world();
        const uint64_t hash = dem_world_hash_get(world);
        const dem_body_counts before = dem_body_counts_get(world);
        dem_body_counts after;
        dem_material glass, no;
        dem_real x[6] = {0, 0, 1, 0, 0, 2}, v[6] = {0, 0, 0, 0, 0, 0}, r[2] = {1, 0};
        glass.id = 1; no.id = 0;
        refused_id(world, (int)dem_sphere_add(world, no, 1, at(0, 0, 0)).slot, hash, "dem_sphere",
                   "material 0", "there are 1");
        refused_id(world, (int)dem_sphere_add(world, glass, 0, at(0, 0, 0)).slot, hash,
                   "dem_sphere", "is 0", "> 0 and finite");
        refused_id(world, (int)dem_sphere_add(world, glass, (dem_real)infinite, at(0, 0, 0)).slot,
                   hash, "dem_sphere", "inf", "> 0 and finite");
        refused_id(world, (int)dem_sphere_add(world, glass, 1, at(nan_number, 0, 0)).slot, hash,
                   "dem_sphere", "position", "finite");
        refused(world, dem_spheres_add(world, glass, 2, x, 0, r, 0), DEM_ERROR_ARGUMENT, hash,
                "dem_spheres_add: ", "sphere 1", "> 0 and finite");
        refused(world, dem_spheres_add(world, glass, -1, x, 0, 0, 1), DEM_ERROR_ARGUMENT, hash,
                "dem_spheres_add: ", "-1", ">= 0");
        refused(world, dem_spheres_add(world, glass, 2, 0, 0, 0, 1), DEM_ERROR_ARGUMENT, hash,
                "dem_spheres_add: ", "positions", ">= 0");
        v[4] = (dem_real)infinite;
        refused(world, dem_spheres_add(world, glass, 2, x, v, 0, 1), DEM_ERROR_ARGUMENT, hash,
                "dem_spheres_add: ", "velocity of body 1", "finite");
        refused_id(world, dem_spheres_fill(world, no, 1, dem_region_make(box_of(0, 0, 0, 9, 9, 9)), 1, 1), hash,
                   "dem_spheres_fill: ", "material", "there are 1");
        refused_id(world, dem_spheres_fill(world, glass, -1, dem_region_make(box_of(0, 0, 0, 9, 9, 9)), 1, 1), hash,
                   "dem_spheres_fill: ", "-1", "> 0");
        refused_id(world, dem_spheres_fill(world, glass, 1, dem_region_make(box_of(0, 0, 0, 1, 9, 9)), 1, 1), hash,
                   "dem_spheres_fill: ", "radius 1 m", "diameter");
        refused_id(world, dem_spheres_fill(world, glass, 1, dem_region_make(box_of(0, 0, 0, 9, infinite, 9)), 1,
                                           1),
                   hash, "dem_spheres_fill: ", "box", "");
        refused_id(world, dem_spheres_pack(world, glass, 1, -1, dem_region_make(box_of(0, 0, 0, 9, 9, 9)), 0),
                   hash, "dem_spheres_pack: ", "padding is -1 m", ">= 0");
        refused_id(world, dem_spheres_pack(world, no, 1, 0, dem_region_make(box_of(0, 0, 0, 9, 9, 9)), 0),
                   hash, "dem_spheres_pack: ", "material", "there are 1");
        after = dem_body_counts_get(world);
        CHECK(memcmp(&before, &after, sizeof before) == 0);
        dem_world_destroy(world);
    }
    TEST("a box that is too full takes what fits, and the error gives the number and a remedy") {
        dem_world *world = dem_world_create(&DEM_WORLD_DESC);
        dem_material glass = scene_material(world, 1e7, 1, 0, 0);
        const int n = dem_spheres_fill(world, glass, 1, dem_region_make(box_of(0, 0, 0, 8, 8, 8)), 200, 1);
        char text[40];
        CHECK(n > 20 && n < 100);
        snprintf(text, sizeof text, "%d of 200", n);
        CHECK_STR(dem_world_error_get(world), text);
        CHECK_STR(dem_world_error_get(world), "enlarge the box");
        CHECK_EQ(dem_bodies_get(world).count, n);
        dem_world_destroy(world);
    }
    TEST("a body that was removed, has left or never existed is rejected, also when its slot is reused") {
        dem_world *world = small_world();
        uint64_t hash;
        dem_body gone = dem_body_id_get(world, 4), never, again_there;
        dem_body_state s = scene_state(world, gone);
        dem_material glass;
        glass.id = 1;
        CHECK_EQ(dem_body_remove(world, gone), DEM_OK);
        scene_step(world, 2);
        again_there = dem_sphere_add(world, glass, DEM_R(1e-3), at(0.1, 0.1, 0.1));
        CHECK_EQ(again_there.slot, gone.slot);
        CHECK(again_there.generation != gone.generation);
        scene_step(world, 2);
        hash = dem_world_hash_get(world);
        refused(world, dem_body_remove(world, gone), DEM_ERROR_ARGUMENT, hash, "dem_body_remove: ",
                "generation 1", "removed");
        refused(world, dem_body_get(world, gone, &s), DEM_ERROR_ARGUMENT, hash, "dem_body_get: ",
                "generation 1", "removed");
        refused(world, dem_body_set(world, gone, &s), DEM_ERROR_ARGUMENT, hash, "dem_body_set: ",
                "generation 1", "removed");
        never.slot = 0; never.generation = 0;
        refused(world, dem_body_get(world, never, &s), DEM_ERROR_ARGUMENT, hash, "dem_body_get: ",
                "body 0", "never added");
        never.slot = 4000; never.generation = 1;
        refused(world, dem_body_remove(world, never), DEM_ERROR_ARGUMENT, hash, "dem_body_remove: ",
                "body 4000", "never added");
        s = scene_state(world, again_there);
        s.velocity.x = (dem_real)nan_number;
        refused(world, dem_body_set(world, again_there, &s), DEM_ERROR_ARGUMENT, hash,
                "dem_body_set: ", "velocity", "finite");
        CHECK_EQ(dem_body_id_get(world, -1).slot, 0);
        CHECK_EQ(dem_body_id_get(world, dem_bodies_get(world).count).slot, 0);
        dem_world_destroy(world);
    }
    TEST("walls with bad numbers are rejected") {
        dem_world *world = small_world();
        const uint64_t hash = dem_world_hash_get(world);
        dem_material glass, no;
        dem_real v[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        int32_t t[3] = {0, 1, 2};
        dem_mesh mesh;
        dem_profile profile;
        glass.id = 1; no.id = 9;
        mesh.vertex_count = 3; mesh.triangle_count = 1; mesh.vertices = v; mesh.triangles = t;
        profile.vertex_count = 3; profile.segment_count = 1; profile.vertices = v;
        profile.segments = t;
        refused_id(world, dem_wall_plane_add(world, no, at(0, 0, 0), at(0, 0, 1)).id, hash,
                   "dem_wall_plane_add: ", "material 9", "there are 1");
        refused_id(world, dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 0)).id, hash,
                   "dem_wall_plane_add: ", "(0, 0, 0)", "not zero");
        refused_id(world, dem_wall_plane_add(world, glass, at(nan_number, 0, 0), at(0, 0, 1)).id, hash,
                   "dem_wall_plane_add: ", "point", "finite");
        refused_id(world, dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, 1), 0, 1).id, hash,
                   "dem_wall_cylinder_add: ", "radius is 0", "> 0");
        refused_id(world, dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, 0), 1, 1).id, hash,
                   "dem_wall_cylinder_add: ", "axis is (0, 0, 0)", "not zero");
        refused_id(world, dem_wall_grains_add(world, glass, 3, v, 0, 1).id, hash,
                   "dem_wall_grains_add: ", "radius is 0", "> 0");
        refused_id(world, dem_wall_grains_add(world, glass, 3, v, 1, 2).id, hash,
                   "dem_wall_grains_add: ", "share is 2", "at most 1");
        refused_id(world, dem_wall_grains_add(world, glass, 0, v, 1, 1).id, hash,
                   "dem_wall_grains_add: ", "0 vertices", "at least one");
        t[2] = 3;
        refused_id(world, dem_wall_mesh_add(world, glass, &mesh).id, hash, "dem_wall_mesh_add: ", "vertex 3",
                   "0 to 2");
        t[1] = -1;
        refused_id(world, dem_wall_profile_add(world, glass, &profile, DEM_EDGE_RESOLVED).id, hash,
                   "dem_wall_profile_add: ", "vertex -1", "0 to 2");
        t[1] = 1; t[2] = 2; v[5] = (dem_real)nan_number;
        refused_id(world, dem_wall_mesh_add(world, glass, &mesh).id, hash, "dem_wall_mesh_add: ", "vertex 1",
                   "finite");
        dem_world_destroy(world);
    }
    TEST("a missing wall, or a motion with bad numbers, is rejected") {
        dem_world *world = small_world();
        dem_wall floor, no;
        dem_motion m = DEM_MOTION;
        dem_pose pose;
        dem_wall_loads ch;
        uint64_t hash;
        dem_material glass;
        int i;
        glass.id = 1; floor.id = 1; no.id = 2;
        hash = dem_world_hash_get(world);
        refused(world, dem_wall_motion_set(world, no, &m), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_motion_set: ", "wall 2", "ids in this world are 1 to 1");
        refused(world, dem_wall_pose_get(world, no, &pose), DEM_ERROR_ARGUMENT, hash, "dem_wall_pose_get: ",
                "wall 2", "ids in this world are 1 to 1");
        refused(world, dem_wall_remove(world, no), DEM_ERROR_ARGUMENT, hash, "dem_wall_remove: ",
                "wall 2", "ids in this world are 1 to 1");
        refused(world, dem_wall_loads_get(world, no, &ch), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_loads_get: ", "wall 2", "ids in this world are 1 to 1");
        refused(world, dem_wall_loads_reset(world, no), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_loads_reset: ", "wall 2", "ids in this world are 1 to 1");
        m.kind = DEM_MOTION_ROTATING;
        refused(world, dem_wall_motion_set(world, floor, &m), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_motion_set: ", "axis", "direction");
        m.kind = DEM_MOTION_OSCILLATING;
        refused(world, dem_wall_motion_set(world, floor, &m), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_motion_set: ", "velocity", "direction");
        m.kind = DEM_MOTION_USER;
        refused(world, dem_wall_motion_set(world, floor, &m), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_motion_set: ", "no function", "motion.function");
        m.kind = (dem_motion_kind)9;
        refused(world, dem_wall_motion_set(world, floor, &m), DEM_ERROR_ARGUMENT, hash,
                "dem_wall_motion_set: ", "9", "");
        for (i = 0; i < 7; i++) {
            static const char *const names[] = {"velocity", "point", "speed", "amplitude", "frequency", "phase", "start"};
            const double bad = i == 6 ? infinite : nan_number;
            m = DEM_MOTION;
            m.kind = DEM_MOTION_OSCILLATING;
            m.velocity = at(0, 0, 1);
            m.amplitude = DEM_R(1e-3);
            m.frequency = 10;
            if (i == 0) m.velocity.x = (dem_real)infinite;
            if (i == 1) m.point.x = (dem_real)bad;
            if (i == 2) m.speed = (dem_real)bad;
            if (i == 3) m.amplitude = (dem_real)bad;
            if (i == 4) m.frequency = (dem_real)bad;
            if (i == 5) m.phase = (dem_real)bad;
            if (i == 6) m.start = bad;
            refused(world, dem_wall_motion_set(world, floor, &m), DEM_ERROR_ARGUMENT, hash,
                    "dem_wall_motion_set: ", names[i], " of wall 1 is ");
            if (test_now.wrong) { printf("        with bad number %d\n", i); break; }
        }
        CHECK_EQ(dem_wall_remove(world, floor), DEM_OK);
        CHECK_EQ(dem_wall_remove(world, floor), DEM_ERROR_ARGUMENT);
        /* ids are not used again */
        m = DEM_MOTION;
        CHECK(dem_wall_plane_add(world, glass, at(0, 0, -1), at(0, 0, 1)).id != floor.id);
        CHECK_EQ(dem_wall_motion_set(world, floor, &m), DEM_ERROR_ARGUMENT);
        dem_world_destroy(world);
    }
    TEST("a time step beyond t_c/20 is rejected with t_c/20 in the message, unless it is allowed") {
        dem_world_desc desc = DEM_WORLD_DESC;
        int allowed;
        for (allowed = 0; allowed < 2; allowed++) {
            dem_world *world;
            dem_material glass;
            dem_advice a;
            char limit[60];
            uint64_t hash;
            desc.dt = DEM_R(1e-3);
            desc.impact_speed = 1;
            desc.allow_large_dt = allowed;
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e7, 0.5, 0.3, 0);
            dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0));
            CHECK_EQ(dem_step_advice_get(world, &a), DEM_OK);
            snprintf(limit, sizeof limit, "at most t_c/20 = %g s", (double)a.dt_max);
            hash = dem_world_hash_get(world);
            if (allowed) CHECK_EQ(dem_world_step(world, 1), DEM_OK);
            else {
                refused(world, dem_world_step(world, 1), DEM_ERROR_TIME_STEP, hash,
                        "dem_world_step: ", "dt is 0.001 s", limit);
                refused(world, dem_world_run(world, 1, 0, 0), DEM_ERROR_TIME_STEP, hash,
                        "dem_world_", "dt is 0.001 s", limit);
            }
            dem_world_destroy(world);
        }
    }
    TEST("with impact_speed set the chosen step ignores speeds; without it the step follows them") {
        int given, k;
        for (given = 0; given < 2; given++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            desc.gravity.z = DEM_R(-9.81);
            desc.impact_speed = given ? DEM_R(0.05) : 0;
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e6, 0.5, 0.3, 0);
            for (k = 0; k < 8; k++)
                dem_sphere_add(world, glass, DEM_R(2e-3), at(0.01*k, 0, 0));
            CHECK_EQ(scene_step(world, 10), DEM_OK);
            while (dem_world_time_get(world) < 0.1) CHECK_EQ(scene_step(world, 10), DEM_OK);
            CHECK(dem_counters_get(world).rebuilds > 5);
            if (given) CHECK_EQ((int)world->clock.press_since, 0);
            else CHECK((int)world->clock.press_since > 0);
            dem_world_destroy(world);
        }
    }
    TEST("dt = 0 chooses t_c/50 of the shortest contact in the scene, walls and fixed grains included") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material soft, hard;
        dem_advice a;
        dem_coefficients k;
        dem_body peg;
        dem_body_state s;
        desc.impact_speed = 2;
        world = dem_world_create(&desc);
        CHECK_EQ(dem_step_advice_get(world, &a), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_step_advice_get: the world has no grain");
        soft = scene_material(world, 1e6, 1, 0, 0);
        hard = scene_material(world, 1e9, 1, 0, 0);
        dem_sphere_add(world, soft, DEM_R(2e-3), at(0, 0, 1));
        dem_sphere_add(world, soft, DEM_R(1e-3), at(0, 0, 2));
        dem_coefficients_get(world, soft, soft, DEM_R(1e-3), DEM_R(1e-3), &k);
        CHECK_EQ(dem_step_advice_get(world, &a), DEM_OK);
        CHECK_REL(a.contact_time, (double)k.contact_time, 1e-12);
        CHECK_REL(a.dt, (double)k.contact_time/50, 1e-12);
        CHECK_REL(a.dt_max, (double)k.contact_time/20, 1e-12);
        CHECK_STR(a.binds, "0.001");
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_REL(dem_counters_get(world).dt, (double)k.contact_time/50, 1e-12);
        CHECK_REL(dem_world_desc_get(world).dt, (double)k.contact_time/50, 1e-12);
        /* a fixed grain of a harder material: shorter contacts, whoever of the two moves. Mass:
           that of the grain */
        peg = dem_sphere_add(world, hard, DEM_R(0.1), at(0, 0, 9));
        s = scene_state(world, peg);
        s.fixed = 1;
        dem_body_set(world, peg, &s);
        dem_coefficients_get(world, soft, hard, DEM_R(1e-3), DEM_R(0.1), &k);
        CHECK_EQ(dem_step_advice_get(world, &a), DEM_OK);
        CHECK((double)a.contact_time <= 1.001*(double)k.contact_time);
        dem_world_destroy(world);
    }
    TEST("after dem_world_dt_set(0) a fast wall motion shortens the step, as in a world created without dt") {
        double dt[2], speed[2];
        int given;
        for (given = 0; given < 2; given++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_motion rise = DEM_MOTION;
            dem_world *world;
            dem_material glass;
            dem_wall floor;
            dem_body ball;
            dem_advice advice;
            desc.dt = given ? DEM_R(1e-7) : 0;
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e7, 0.5, 0.3, 0);
            floor = dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
            ball = dem_sphere_add(world, glass, DEM_R(0.01), at(0, 0, 0.0105));
            dem_sphere_add(world, glass, DEM_R(0.01), at(0.05, 0, 0.3));
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            if (given) CHECK_EQ(dem_world_dt_set(world, 0), DEM_OK);
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            rise.kind = DEM_MOTION_TRANSLATING;
            rise.velocity = at(0, 0, 2);
            rise.start = dem_world_time_get(world);
            CHECK_EQ(dem_wall_motion_set(world, floor, &rise), DEM_OK);
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            CHECK_EQ(dem_step_advice_get(world, &advice), DEM_OK);
            dt[given] = (double)dem_counters_get(world).dt;
            CHECK_REL(dt[given], advice.dt, 1e-6);
            CHECK_EQ(dem_world_run(world, 0.01, 0, 0), DEM_OK);
            speed[given] = (double)scene_state(world, ball).velocity.z;
            dem_world_destroy(world);
        }
        CHECK_REL(dt[1], dt[0], 1e-6);
        CHECK_REL(speed[1], 3, 0.01);           /* the floor's 2 m/s and half of them */
        CHECK_REL(speed[1], speed[0], 1e-3);
    }
    TEST("an overlap of more than a radius stops the run with step, overlap and remedy") {
        int wall;
        for (wall = 0; wall < 2; wall++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            desc.dt = DEM_R(1e-7);
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e6, 0.5, 0, 0);
            dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, -0.5e-3));
            if (wall) dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
            else dem_sphere_add(world, glass, DEM_R(2e-3), at(0, 0, 1.2e-3));
            CHECK_EQ(dem_world_step(world, 3), DEM_ERROR_UNSTABLE);
            CHECK_STR(dem_world_error_get(world), "dem_world_step: step 0");
            CHECK_STR(dem_world_error_get(world),
                      wall ? "body 1 overlaps wall 1 by 1.5" : "overlap by 1.3");
            CHECK_STR(dem_world_error_get(world), "must be below 1");
            CHECK_STR(dem_world_error_get(world), "too soft");
            CHECK_EQ(dem_world_steps_get(world), 0);
            dem_world_destroy(world);
        }
    }
    TEST("a force that is NaN stops the run in its step and names a body") {
        int late;
        for (late = 0; late < 2; late++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            double since = late ? 5.5e-6 : 0;
            int i;
            desc.dt = DEM_R(1e-6);
            desc.force = nan_force;
            desc.force_user = &since;
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e6, 0.5, 0, 0);
            dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 1));
            for (i = 1; i < (late ? 6 : 1); i++) CHECK_EQ(dem_world_step(world, 1), DEM_OK);
            CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_UNSTABLE);
            CHECK_STR(dem_world_error_get(world), "body 1");
            CHECK_STR(dem_world_error_get(world), "finite");
            CHECK_STR(dem_world_error_get(world), "force field");
            CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_UNSTABLE);    /* and stays stopped */
            dem_world_destroy(world);
        }
    }
    TEST("a user-defined motion that returns NaN stops the run") {
        int kind;
        for (kind = 0; kind < 2; kind++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            dem_motion m = DEM_MOTION;
            dem_wall wall;
            double since = 2.5e-6;
            desc.dt = DEM_R(1e-6);
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e6, 0.5, 0, 0);
            dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0.99e-3));
            if (kind) wall = dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
            else wall = scene_floor(world, glass, -1, -1, 1, 1, 1, 1);
            m.kind = DEM_MOTION_USER;
            m.function = nan_motion;
            m.user = &since;
            dem_wall_motion_set(world, wall, &m);
            CHECK_EQ(dem_world_step(world, 2), DEM_OK);
            CHECK_EQ(dem_world_step(world, 2), DEM_ERROR_UNSTABLE);
            CHECK_STR(dem_world_error_get(world), "motion");
            dem_world_destroy(world);
        }
    }
    TEST("a periodic box shorter than twice the largest diameter and the skin is rejected") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass;
        uint64_t hash;
        desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(0, 0, 0, 1, 3, 1);
        desc.skin = DEM_R(0.25);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e7, 1, 0, 0);
        dem_sphere_add(world, glass, 1, at(0.5, 0.5, 0.5));
        hash = dem_world_hash_get(world);
        refused(world, dem_world_step(world, 1), DEM_ERROR_ARGUMENT, hash, "dem_world_step: ",
                "3 m long on periodic axis 1", "4.5 m");
        dem_world_destroy(world);
    }
    TEST("steps, seconds, fields and checks with bad numbers are rejected") {
        dem_world *world = small_world();
        const uint64_t hash = dem_world_hash_get(world);
        dem_field_desc f;
        dem_field id;
        dem_field_data data;
        dem_material glass, no;
        dem_coefficients k;
        int i;
        glass.id = 1; no.id = 7;
        refused(world, dem_world_step(world, -1), DEM_ERROR_ARGUMENT, hash, "dem_world_step: ",
                "-1", ">= 0");
        refused(world, dem_world_run(world, -1, 0, 0), DEM_ERROR_ARGUMENT, hash, "dem_world_run: ",
                "-1", ">= 0");
        refused(world, dem_world_run(world, nan_number, 0, 0), DEM_ERROR_ARGUMENT, hash,
                "dem_world_run: ", "nan", "finite");
        refused(world, dem_coefficients_get(world, glass, no, 1, 1, &k), DEM_ERROR_ARGUMENT, hash,
                "dem_coefficients_get: ", "material 7", "there are 1");
        refused(world, dem_coefficients_get(world, glass, glass, 0, 1, &k), DEM_ERROR_ARGUMENT,
                hash, "dem_coefficients_get: ", "0 and 1", "> 0");
        id.id = 1;
        refused(world, dem_field_get(world, id, &data), DEM_ERROR_ARGUMENT, hash, "dem_field_get: ",
                "field 1", "there are 0");
        refused(world, dem_field_reset(world, id), DEM_ERROR_ARGUMENT, hash, "dem_field_reset: ",
                "field 1", "there are 0");
        for (i = 0; i < 6; i++) {
            static const char *const wrong[][2] = {{"cells is 0", "> 0"}, {"cells are 4096 x 4096 x 4096", "2^28"},
                {"the box goes", "lo below hi"}, {"interval is -1 s", ">= 0 s"}, {"start is ", ">= 0 s"},
                {"the box goes", "lo below hi"}};
            memset(&f, 0, sizeof f);
            f.box = box_of(0, 0, 0, 1, 1, 1);
            f.cells[0] = f.cells[1] = f.cells[2] = i == 1 ? 4096 : 2;
            if (i == 0) f.cells[1] = 0;
            if (i == 2) f.box.hi.y = 0;
            if (i == 3) f.interval = -1;
            if (i == 4) f.start = nan_number;
            if (i == 5) f.box.lo.z = (dem_real)nan_number;
            refused_id(world, dem_field_add(world, &f).id, hash, "dem_field_add: ", wrong[i][0], wrong[i][1]);
        }
        CHECK_EQ(dem_world_step(world, 0), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_hash_get(world), hash);
        for (i = DEM_OK; i <= DEM_ERROR_STOPPED; i++) CHECK(strcmp(dem_result_name_get((dem_result)i),
                                                                   "unknown") != 0);
        CHECK_STR(dem_result_name_get((dem_result)99), "unknown");
        dem_world_destroy(world);
    }

    TEST("discs stay in their plane under any load: z, its velocity and spins about x and y are 0") {
        int integrator;
        for (integrator = DEM_INTEGRATOR_VELOCITY_VERLET; integrator <= DEM_INTEGRATOR_LEAPFROG; integrator++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            dem_bodies b;
            dem_body disc;
            double off = 0;
            int i, step;
            desc.planar = 1;
            desc.integrator = (dem_integrator)integrator;
            desc.gravity = at(0, -9.81, -9.81);
            desc.force = up_force;             /* along z */
            desc.threads = 1;
            desc.thickness = DEM_R(2e-3);
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e6, 0.5, 0.5, 0.1);
            dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 1, 0));
            for (i = 0; i < 20; i++) dem_sphere_add(world, glass, DEM_R(1e-3),
                                                    at(1.9e-3*(i%5), 1e-3 + 1.9e-3*(i/5),
                                                       0.1*(i == 7)));
            disc = dem_body_id_get(world, 3);
            scene_move(world, disc, at(1, 0, 1), at(9, 9, 9));
            for (step = 0; step < 200; step++) {
                b = dem_bodies_get(world);
                for (i = 0; i < b.count; i++)
                    off += fabs((double)b.positions[4*i + 2]) +
                        fabs((double)b.velocities[4*i + 2]) +
                           fabs((double)b.spins[4*i]) + fabs((double)b.spins[4*i + 1]);
                CHECK_EQ(scene_step(world, 1), DEM_OK);
            }
            CHECK_NEAR(off, 0, 0);
            CHECK((double)dem_counters_get(world).overlap_max > 0);
            dem_world_destroy(world);
        }
    }
    TEST("the report lists laws, time step, search, balance, pairs, walls and ledger, and changes nothing") {
        int changed;
        for (changed = 0; changed < 2; changed++) {
            dem_world *w[2];
            char text[8000];
            int i;
            for (i = 0; i < 2; i++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material glass;
                size_t n;
                FILE *f = tmpfile();
                desc.threads = 1;
                desc.ledger = 1;
                desc.gravity = at(0, 0, -9.81);
                w[i] = dem_world_create(&desc);
                glass = scene_material(w[i], 1e7, 0.5, 0.3, 0);
                dem_wall_plane_add(w[i], glass, at(0, 0, 0), at(0, 0, 1));
                scene_block(w[i], glass, 4, 4, 3, 1e-3, 1, 0.2, 1);
                scene_step(w[i], 50);
                if (changed) {                 /* between two lists, with other laws than before */
                    dem_sphere_add(w[i], glass, DEM_R(1e-3), at(0.002, 0.002, 0.02));
                    scene_material(w[i], 1e7, 0.5, 0.3, 0.2);
                }
                if (i == 1 && f) {
                    dem_world_report(w[i], f);
                    rewind(f);
                    n = fread(text, 1, sizeof text - 1, f);
                    text[n] = 0;
                    CHECK_STR(text, "velocity Verlet");
                    CHECK_STR(text, "Hertz");
                    CHECK_STR(text, "spring");
                    CHECK_STR(text, "t_c/20");
                    CHECK_STR(text, "uniform grid");
                    CHECK_STR(text, "inserted = ");
                    CHECK_STR(text, "wall 1");
                    CHECK_STR(text, "ledger [J]");
                    CHECK_STR(text, " 1 - 1 ");
                }
                if (f) fclose(f);
                scene_step(w[i], 50);
            }
            CHECK_EQ(dem_world_hash_get(w[0]), dem_world_hash_get(w[1]));
            dem_world_destroy(w[0]);
            dem_world_destroy(w[1]);
        }
    }
    TEST("a material without grains changes nothing when it is added in mid-run") {
        dem_world *w[2];
        dem_bodies b;
        double worst = 0;
        int with, i;
        for (with = 0; with < 2; with++) {     /* grains pressed on a slope that friction holds */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material glass;
            desc.threads = 1;
            desc.dt = DEM_R(2e-6);
            desc.gravity = at(100, 0, -500);
            w[with] = dem_world_create(&desc);
            glass = scene_material(w[with], 1e7, 0.3, 0.6, 0);
            dem_wall_plane_add(w[with], glass, at(0, 0, 0), at(0, 0, 1));
            for (i = 0; i < 12; i++)
                dem_sphere_add(w[with], glass, DEM_R(1e-3), at(2.5e-3*(i%4), 2.5e-3*(i/4), 1e-3));
            CHECK_EQ(scene_step(w[with], 1500), DEM_OK);
            /* out of order: index and slot of a body differ from here on */
            CHECK_EQ(dem_body_remove(w[with], dem_body_id_get(w[with], 2)), DEM_OK);
            CHECK_EQ(scene_step(w[with], 500), DEM_OK);
            if (with) CHECK_EQ(scene_material(w[with], 1e7, 0.5, 0.3, 0).id, 2);
            CHECK_EQ(scene_step(w[with], 500), DEM_OK);
        }
        b = dem_bodies_get(w[0]);
        for (i = 0; i < b.count; i++) {
            const dem_body id = dem_body_id_get(w[0], i);
            worst = fmax(worst, apart(scene_state(w[0], id).position,
                                      scene_state(w[1], id).position));
        }
        CHECK_NEAR(worst, 0, 1e-9);
        /* m; forces are looked at once more, with velocities that
                                                  differ by half a kick;
                                                  a lost spring slips 1e-7 m */
        dem_world_destroy(w[0]);
        dem_world_destroy(w[1]);
    }
    TEST("a pair set in mid-run acts from the next step on, on existing contacts and walls too") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass;
        dem_pair pair;
        dem_contact_info c[3];
        dem_real force[2];
        int i, n = 0;
        desc.dt = DEM_R(1e-9);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e7, 1, 0, 0);
        dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0.99e-3));
        dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 2.98e-3));
        for (i = 0; i < 2; i++) {
            int k;
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            n = dem_contacts_get(world, c, 3);
            CHECK_EQ(n, 2);
            for (k = 0; k < n; k++) force[k] =
                (dem_real)(i ? length(c[k].force)/(double)force[k] : length(c[k].force));
            dem_pair_get(world, glass, glass, &pair);
            pair.young_eff *= 2;
            if (!i) CHECK_EQ(dem_pair_set(world, glass, glass, &pair), DEM_OK);
        }
        CHECK_NEAR(force[0], 2, 1e-3);         /* two steps of 1e-9 s move nothing */
        CHECK_NEAR(force[1], 2, 1e-3);
        dem_world_destroy(world);
    }
    TEST("the forces of the contacts add up to the forces on the grains") {
        static dem_contact_info infos[500];
        dem_world *world = small_world();
        dem_bodies b;
        double worst = 0, most = 0;
        int n, i, k;
        scene_step(world, 100);
        dem_candidates_rebuild(world);                 /* velocities of the full step from here on */
        scene_step(world, 1);
        n = dem_contacts_get(world, infos, 500);
        b = dem_bodies_get(world);
        for (i = 0; i < b.count; i++) {
            dem_vec3 f = at(0, 0, 0);
            for (k = 0; k < n; k++) {
                const dem_vec3 g = infos[k].force;
                if (infos[k].a.slot == b.slots[i] + 1) f =
                    at((double)(f.x + g.x), (double)(f.y + g.y), (double)(f.z + g.z));
                else if (infos[k].b.slot == b.slots[i] + 1) f =
                    at((double)(f.x - g.x), (double)(f.y - g.y), (double)(f.z - g.z));
            }
            worst = fmax(worst, apart(f, at((double)b.forces[4*i], (double)b.forces[4*i + 1],
                                            (double)b.forces[4*i + 2])));
            most = fmax(most, length(f));
        }
        /* the law sees velocities half a kick later than the run did */
        CHECK(worst < 0.05*most);
        CHECK(most > 0);
        dem_world_destroy(world);
    }
    TEST("a user-defined copy of the built-in law moves the grains alike") {
        dem_body_state s;
        dem_world *w[2];
        dem_bodies b;
        double worst = 0;
        int own, i;
        for (own = 0; own < 2; own++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc m = scene_stuff(1e7, 0.5, 0.3, 0);
            dem_material glass;
            desc.threads = 1;
            desc.gravity = at(0, 0, -9.81);
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.tangent_law = DEM_TANGENT_VISCOUS;
            desc.dt = DEM_R(2e-6);
            desc.law = own ? linear_law : 0;
            desc.law_stiffness = 5000;
            w[own] = dem_world_create(&desc);
            m.stiffness = 5000;
            glass = dem_material_add(w[own], &m);
            dem_wall_plane_add(w[own], glass, at(0, 0, 0), at(0, 0, 1));
            scene_block(w[own], glass, 4, 4, 3, 1e-3, 1, 0.5, 1);
            CHECK_EQ(scene_step(w[own], 500), DEM_OK);
        }
        b = dem_bodies_get(w[0]);
        for (i = 0; i < b.count; i++) {
            dem_body id = dem_body_id_get(w[0], i);
            CHECK_EQ(dem_body_get(w[1], id, &s), DEM_OK);
            worst = fmax(worst, apart(s.position, scene_state(w[0], id).position));
        }
        /* m; they differ in the last bit of the cap, for 500 steps */
        CHECK_NEAR(worst, 0, 1e-10);
        dem_world_destroy(w[0]);
        dem_world_destroy(w[1]);
    }
    TEST("two worlds in two threads do not disturb each other") {
        uint64_t alone, hash[4] = {0, 0, 0, 0};
        dem_world *world = small_world();
        int i;
        scene_step(world, 300);
        alone = dem_world_hash_get(world);
        dem_world_destroy(world);
#if DEMI_OPENMP
        #pragma omp parallel for num_threads(4)
#endif
        for (i = 0; i < 4; i++) {
            dem_world *mine = small_world();
            dem_world_step(mine, 300);
            hash[i] = dem_world_hash_get(mine);
            dem_world_destroy(mine);
        }
        for (i = 0; i < 4; i++) CHECK_EQ(hash[i], alone);
    }
    TEST("all memory comes from the allocator of the desc and returns to it") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        int out = 0;
        desc.allocator.alloc_fn = alloc_some;
        desc.allocator.free_fn = free_some;
        desc.allocator.user = &out;
        world = dem_world_create(&desc);
        scene_block(world, scene_material(world, 1e7, 1, 0.3, 0), 3, 3, 3, 1e-3, 0, 0, 1);
        scene_step(world, 10);
        CHECK(out > 20);
        dem_world_destroy(world);
        CHECK_EQ(out, 0);
        desc.allocator.alloc_fn = alloc_nothing;
        CHECK(dem_world_create(&desc) == 0);
    }

    TEST("every kind of wall repels a grain along its normal with Hertz's force") {
        static const dem_real line[] = {-1, 0, 1, 0}, beads[] = {0, 0, 0, 1, 0, 0};
        static const int32_t segments[] = {0, 1};
        const double d = 1e-5, r = 1e-3;
        int kind;
        for (kind = 0; kind < 6; kind++) {
            dem_material glass;
            dem_world *world = one_wall_world(&glass);
            dem_profile profile;
            dem_wall wall;
            dem_wall_loads ch;
            dem_coefficients k;
            dem_vec3 x, n, f;                  /* place, direction away from the wall */
            double hertz;
            profile.vertex_count = 2; profile.segment_count = 1;
            profile.vertices = (dem_real *)(uintptr_t)line;
            profile.segments = (int32_t *)(uintptr_t)segments;
            wall.id = 0;
            x = n = at(0, 0, 0);
            if (kind == 0) {
                wall = dem_wall_plane_add(world, glass, at(1, 1, 1), at(3, 0, 4));
                n = at(0.6, 0, 0.8);
                x = at(1 + 0.6*(r - d), 1, 1 + 0.8*(r - d));
            }
            if (kind == 1) {
                wall = dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 2, 0), DEM_R(0.05), 1);
                n = at(-1, 0, 0);
                x = at(0.05 - r + d, 7, 0);
            }
            if (kind == 2) {
                wall = dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, -1), DEM_R(0.05), 0);
                n = at(0, 1, 0);
                x = at(0, 0.05 + r - d, 7);
            }
            if (kind == 3) {
                wall = dem_wall_profile_add(world, glass, &profile, DEM_EDGE_RESOLVED);
                n = at(0, -1, 0);
                x = at(0.3, -r + d, 5);
            }
            if (kind == 4) {
                wall = scene_floor(world, glass, -1, -1, 1, 1, 3, 3);
                n = at(0, 0, -1);
                x = at(0.1, 0.3, -r + d);
            }
            if (kind == 5) {
                wall = dem_wall_grains_add(world, glass, 2, beads, DEM_R(0.5), DEM_R(0.25));
                n = at(0, 0, 1);
                x = at(0, 0, 0.5 + r - d);
            }
            CHECK(wall.id == 1);
            f = press(world, x, &ch, wall);
            dem_coefficients_get(world, glass, glass, DEM_R(1e-3), kind == 5 ? DEM_R(0.5) : 0, &k);
            hertz = 4.0/3*1e7/(2*(1 - 0.0625))*sqrt(kind == 5 ? r*0.5/(r + 0.5) : r)*pow(d,
                    1.5)*(kind == 5 ? 0.25 : 1);
            /* after 1e-9 s */
            CHECK_NEAR(apart(f, at((double)n.x*hertz, (double)n.y*hertz, (double)n.z*hertz)), 0,
                       1e-4*hertz);
            CHECK_EQ(ch.contacts, 1);
            dem_world_destroy(world);
        }
    }
    TEST("a flat mesh gives the plane's forces and torques over faces, edges and vertices, with friction history") {
        static const double ways[][2] = {{1, 0}, {0.8, 0.6},
            {0.70710678118654752, 0.70710678118654752}, {-0.5, 0.8660254037844386}};
        static dem_vec3 f[2][SLIDE_STEPS], t[2][SLIDE_STEPS];
        int law;
        size_t i;
        for (law = DEM_TANGENT_SPRING; law <= DEM_TANGENT_MINDLIN_RESCALED; law++)
            for (i = 0; i < 4; i++) {
                const double speed = 3, depth = 5e-5;
                const dem_vec3 start = at(-1.2e-3*ways[i][0], -1.2e-3*ways[i][1], 1e-3 - depth);
                const dem_vec3 v = at(speed*ways[i][0], speed*ways[i][1], 0);
                double most = 0, worst = 0;
                int k;
                slide(FLOOR_PLANE, (dem_tangent_law)law, start, v, f[0], t[0]);
                slide(FLOOR_MESH, (dem_tangent_law)law, start, v, f[1], t[1]);
                for (k = 0; k < SLIDE_STEPS; k++) most = fmax(most, length(f[0][k]));
                for (k = 0; k < SLIDE_STEPS; k++) {
                    worst = fmax(worst, apart(f[0][k], f[1][k])/most);
                    worst = fmax(worst, apart(t[0][k], t[1][k])/(1e-3*most));
                }
                /* of the largest force; 400 steps, 2.4 mm: over five vertices or edges */
                CHECK_NEAR(worst, 0, 1e-11);
            }
    }
    TEST("a sphere over many small triangles feels one plane") {
        double force[2];
        int fine;
        for (fine = 0; fine < 2; fine++) {
            dem_material glass;
            dem_world *world = one_wall_world(&glass);
            dem_wall_loads ch;
            dem_wall wall = scene_floor(world, glass, -1e-3, -1e-3, 1e-3, 1e-3, fine ? 40 : 1,
                                        fine ? 40 : 1);
            force[fine] = (double)press(world, at(1.23e-5, 0.37e-5, 0.9e-3), &ch, wall).z;
            CHECK_EQ(ch.contacts, 1);
            dem_world_destroy(world);
        }
        CHECK_REL(force[1], force[0], 1e-11);
    }
    TEST("DEM_EDGE_FRACTION: a segment's force is a^2(3-2a) of its line's, a the fraction of the chord inside") {
        const double r = 1e-3, depth = 1e-4, chord = sqrt(r*r - (r - depth)*(r - depth));
        double whole = 0;
        int i;
        for (i = 0; i < 9; i++) {              /* the end of the segment at x = 0 */
            static const dem_real line[] = {-1, 0, 0, 0};
            static const int32_t segments[] = {0, 1};
            const double x = i == 0 ? -0.5 : (0.25*(i - 1) - 1)*chord, a =
                i == 0 ? 1 : (chord - x)/(2*chord);
            dem_material glass;
            dem_world *world = one_wall_world(&glass);
            dem_profile profile;
            dem_wall_loads ch;
            dem_wall wall;
            dem_vec3 f;
            profile.vertex_count = 2; profile.segment_count = 1;
            profile.vertices = (dem_real *)(uintptr_t)line;
            profile.segments = (int32_t *)(uintptr_t)segments;
            wall = dem_wall_profile_add(world, glass, &profile, DEM_EDGE_FRACTION);
            f = press(world, at(x, r - depth, 0), &ch, wall);
            if (i == 0) whole = (double)f.y;
            CHECK_NEAR(f.y/(dem_real)whole, a*a*(3 - 2*a), 1e-5);  /* after one step of 1e-9 s */
            CHECK_NEAR(f.x, 0, 1e-12*whole);
            dem_world_destroy(world);
        }
    }
    TEST("at rest the floor's force is the weight, its impulse weight times time, and no wall "
         "works") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass;
        dem_wall floor;
        dem_wall_loads ch;
        dem_totals t;
        double weight;
        int k;
        desc.threads = 1;
        desc.gravity = at(0, 0, -9.81);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e6, 0.1, 0.5, 0);
        floor = scene_floor(world, glass, -0.01, -0.01, 0.02, 0.02, 3, 3);
        for (k = 0; k < 4; k++)
            dem_wall_plane_add(world, glass, at(k == 1 ? 7.9e-3 : 0, k == 3 ? 7.9e-3 : 0, 0),
                          at((k == 0) - (k == 1), (k == 2) - (k == 3), 0));
        for (k = 0; k < 12; k++) dem_sphere_add(world, glass, DEM_R(1.2e-3),
                                                at(1.3e-3 + 2.6e-3*(k%3), 1.3e-3 + 2.6e-3*(k/3%2),
                                                   1.2e-3 + 2.4e-3*(k/6)));
        CHECK_EQ(scene_step(world, 12000), DEM_OK);
        t = dem_totals_get(world);
        weight = t.mass*9.81;
        dem_wall_loads_reset(world, floor);
        CHECK_EQ(scene_step(world, 500), DEM_OK);
        dem_wall_loads_get(world, floor, &ch);
        CHECK_REL(-(double)ch.force.z, weight, 2e-3);          /* what still quivers */
        CHECK_REL(-ch.impulse[2], weight*ch.time, 2e-3);
        CHECK_REL(ch.time, 500*(double)dem_counters_get(world).dt, 1e-9);
        CHECK_NEAR(ch.work, 0, 0);
        dem_world_destroy(world);
    }
    TEST("a rotating cylinder's power is torque times omega, and its work is in the ledger") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass;
        dem_wall drum;
        dem_motion m = DEM_MOTION;
        dem_wall_loads ch;
        double most = 0;
        int i;
        memset(&ch, 0, sizeof ch);
        desc.threads = 1;
        desc.ledger = 1;
        desc.gravity = at(0, -9.81, 0);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e6, 0.5, 0.5, 0);
        drum = dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, 1), DEM_R(0.01), 1);
        m.kind = DEM_MOTION_ROTATING;
        m.axis = at(0, 0, 3);
        m.speed = 30;
        CHECK_EQ(dem_wall_motion_set(world, drum, &m), DEM_OK);
        for (i = 0; i < 24; i++) dem_sphere_add(world, glass, DEM_R(1e-3),
                                                at(-4e-3 + 2.1e-3*(i%4), -6e-3 + 2.1e-3*(i/8),
                                                   2.1e-3*(i/4%2)));
        for (i = 0; i < 100; i++) {
            CHECK_EQ(scene_step(world, 50), DEM_OK);
            dem_wall_loads_get(world, drum, &ch);
            CHECK_NEAR(ch.power, -30*(double)ch.torque_axial, 1e-9*(1e-6 + fabs((double)ch.power)));
            CHECK_REL(ch.torque_axial, (double)ch.torque.z, 1e-12);
            most = fmax(most, fabs((double)ch.power));
        }
        CHECK(most > 1e-6);
        CHECK_REL(ch.work, dem_ledger_get(world).walls, 1e-9);
        CHECK_REL(ch.work, -30*ch.torque_impulse, 1e-9);
        dem_world_destroy(world);
    }
    TEST("walls that translate, rotate, oscillate or follow a function have the velocities of finite differences") {
        int kind;
        for (kind = DEM_MOTION_TRANSLATING; kind <= DEM_MOTION_USER; kind++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            dem_wall wall;
            dem_motion m = DEM_MOTION;
            dem_pose p[3];
            double omega = 7, worst_v = 0, worst_w = 0;
            const double dt = 1e-4;
            int i, k;
            desc.dt = (dem_real)dt;
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e7, 1, 0, 0);
            wall = scene_floor(world, glass, -0.1, -0.1, 0.1, 0.1, 2, 2);
            m.kind = (dem_motion_kind)kind;
            m.velocity = at(1, 2, -2);
            m.point = at(0.3, 0, 0.1);
            m.axis = at(1, 1, 4);
            m.speed = -12;
            m.amplitude = DEM_R(0.01);
            m.frequency = 3;
            m.phase = 1;
            m.function = circling;
            m.user = &omega;
            CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
            for (i = 0; i < 3; i++) { dem_wall_pose_get(world, wall, &p[i]); scene_step(world, 1); }
            for (i = 0; i < 500; i++) {
                dem_vec3 v, spin;
                v = at((double)(p[2].position.x - p[0].position.x)/(2*dt),
                       (double)(p[2].position.y - p[0].position.y)/(2*dt),
                       (double)(p[2].position.z - p[0].position.z)/(2*dt));
                worst_v = fmax(worst_v, apart(v, p[1].velocity));
                for (k = 0; k < 3; k++) {      /* each axis of the frame turns as spin x axis */
                    const dem_vec3 axis = dem_vec3_make(p[1].rotation[k], p[1].rotation[3 + k],
                                                        p[1].rotation[6 + k]);
                    spin = at((double)(p[2].rotation[k] - p[0].rotation[k])/(2*dt),
                              (double)(p[2].rotation[3 + k] - p[0].rotation[3 + k])/(2*dt),
                              (double)(p[2].rotation[6 + k] - p[0].rotation[6 + k])/(2*dt));
                    worst_w = fmax(worst_w, apart(spin, cross(p[1].spin, axis)));
                }
                p[0] = p[1]; p[1] = p[2];
                dem_wall_pose_get(world, wall, &p[2]);
                scene_step(world, 1);
            }
            /* central differences are off by w^3 R dt^2/6: 12^3 x .33 x 1e-8/6 = 1e-6, 20^3 x .01 x
               1e-8/6 */
            CHECK_NEAR(worst_v, 0, 2e-6);
            CHECK_NEAR(worst_w, 0, 5e-6);
            CHECK(kind == DEM_MOTION_TRANSLATING || length(p[1].velocity) > 0);
            if (kind == DEM_MOTION_OSCILLATING) {
                const double t = dem_world_time_get(world) - dt, at_t = 0.01*sin(2*pi*3*t + 1);
                CHECK_NEAR(apart(p[2].position, at(at_t/3, 2*at_t/3, -2*at_t/3)), 0, 1e-12);
            }
            if (kind == DEM_MOTION_TRANSLATING)
                CHECK_NEAR(p[2].position.y, 2*(dem_world_time_get(world) - dt), 1e-12);
            dem_world_destroy(world);
        }
    }
    TEST("a wall of grains that moves up carries a grain resting on it") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass;
        dem_wall wall;
        dem_motion m = DEM_MOTION;
        dem_real beads[3*25];
        dem_body ball;
        dem_body_state s;
        int i;
        desc.threads = 1;
        desc.gravity = at(0, 0, -9.81);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e6, 0.3, 0.5, 0);
        for (i = 0; i < 25; i++) {
            beads[3*i] = (dem_real)(2e-3*(i%5));
            beads[3*i + 1] = (dem_real)(2e-3*(i/5));
            beads[3*i + 2] = 0;
        }
        wall = dem_wall_grains_add(world, glass, 25, beads, DEM_R(1e-3), 1);
        ball = dem_sphere_add(world, glass, DEM_R(1e-3), at(3e-3, 3e-3, 1.42e-3));
        m.kind = DEM_MOTION_TRANSLATING;
        m.velocity = at(0, 0, 0.05);
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        s = scene_state(world, ball);
        /* four beads below it */
        CHECK_NEAR(s.position.z, 0.05*dem_world_time_get(world) + sqrt(2.0)*1e-3, 2e-5);
        CHECK_NEAR(s.velocity.z, 0.05, 2e-3);
        dem_world_destroy(world);
    }
    return test_end();
}
