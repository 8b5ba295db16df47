/* Convex polyhedra held apart by impulses, or seen by laws that reach beyond touch: gaps to each other and to walls,
   the points of a contact, blocks, stacks, an arch, impacts. Outside numbers:
     a block on a slope, a stopping distance, a block that tips: closed forms
     an arch: the line of thrust (as in test_polyhedra.c, for springs) */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double earth = 9.81;                   /* m/s2 */
static const int fine = sizeof(dem_real) == 8;
static const dem_quat straight = {1, 0, 0, 0};

static dem_world *rigid_to(double tolerance, double gravity, double restitution, double friction, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, restitution, friction, 0);
    dem_world *w;
    desc.gravity.z = (dem_real)-gravity;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(1e-3);
    desc.tolerance = fine ? (dem_real)tolerance : DEM_R(1e-6);
    desc.sweeps = fine ? 20000 : 500;
    desc.ledger = 1;
    w = dem_world_create(&desc);
    *m = dem_material_add(w, &stuff);
    return w;
}
static dem_world *rigid(double gravity, double restitution, double friction, dem_material *m) {
    return rigid_to(1e-10, gravity, restitution, friction, m);
}
static double tube_radius;                      /* m, of the tube about z that `off` means; < 0: seen from inside */
static double off_tube(const double *x) {
    const double r = sqrt(x[0]*x[0] + x[1]*x[1]);
    return tube_radius > 0 ? r - tube_radius : -tube_radius - r;
}
/* A cone about z, of half angle 30 degrees, its tip above at z = .2 m. */
static double off_cone(const double *x) {
    return sqrt(x[0]*x[0] + x[1]*x[1])*sqrt(0.75) + (x[2] - 0.2)*0.5;
}
/* Least of all gaps, and their number. */
static double least_gap(const demi_gaps *gaps, int *points) {
    double least = 1e300;
    int i, k;
    for (i = 0, *points = 0; i < gaps->count; i++)
        for (k = 0; k < gaps->group[i].count; k++, ++*points) least = fmin(least, gaps->group[i].gap[k]);
    return least;
}
/* A block at rest on a slope: its speed downhill after a time; how fast it turns. floor: 0: plane, 1: mesh, 2: a body. */
static double slides(double angle, double friction, double width, double height, int floor, double *spin) {
    dem_material m;
    dem_world *w = rigid(0, 0, friction, &m);
    dem_body b;
    dem_body_state s;
    if (floor == 0) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    else if (floor == 1) {                      /* 9 x 9 squares of two triangles */
        dem_real v[300];
        int32_t t[600];
        dem_mesh mesh = {100, 162, v, t};
        int i;
        for (i = 0; i < 100; i++) {
            v[3*i] = (dem_real)(-0.9 + 0.2*(i%10));
            v[3*i + 1] = (dem_real)(-0.91 + 0.2*(i/10));
            v[3*i + 2] = 0;
        }
        for (i = 0; i < 81; i++) {
            const int32_t a = i%9 + i/9*10;
            t[6*i] = a; t[6*i + 1] = a + 1; t[6*i + 2] = a + 11;
            t[6*i + 3] = a; t[6*i + 4] = a + 11; t[6*i + 5] = a + 10;
        }
        CHECK(dem_wall_mesh_add(w, m, &mesh).id);
    } else {
        const dem_body under = dem_body_add(w, m, scene_box(w, 2, 2, 0.2), at(0, 0, -0.1), straight);
        s = scene_state(w, under);
        s.fixed = 1;
        dem_body_set(w, under, &s);
    }
    b = dem_body_add(w, m, scene_box(w, width, width, height), at(0.013, 0.021, height/2), straight);
    dem_world_gravity_set(w, at(earth*sin(angle), 0, -earth*cos(angle)));
    CHECK_EQ(dem_world_run(w, 0.2, 0, 0), DEM_OK);
    s = scene_state(w, b);
    *spin = (double)s.spin.y;
    dem_world_destroy(w);
    return (double)s.velocity.x;
}
/* A law that holds on to what is near: 1 N over the last of its range. */
static void holds(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    (void)memory;
    force->normal = c->overlap > 0 ? 1e5*c->overlap : -(1 + c->overlap/c->range);
}

static int touch_calls, beyond_calls;
static void bonds(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    touch_calls++;
    beyond_calls += c->overlap < -c->range;
    f->normal = memory[0] > 0 ? 1000*c->overlap : 0;
}
static void bond_all(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)c; (void)user;
    memory[0] = 1;
}
static dem_world *bonding(int planar, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    desc.planar = planar;
    desc.law = bonds;
    desc.law_memory = 1;
    desc.law_stiffness = 1000;
    desc.law_range = DEM_R(0.01);
    desc.dt = DEM_R(1e-5);
    desc.ellipsoid_overlap = DEM_OVERLAP_NORMAL;
    w = dem_world_create(&desc);
    *m = scene_material(w, 1e7, 0.5, 0, 0);
    touch_calls = beyond_calls = 0;
    return w;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("rocks: gaps between rocks equal the separating planes' when overlapping, and never exceed the feature "
         "distance when apart") {
        dem_material m;
        dem_world *w = rigid(0, 0, 0, &m);
        uint64_t random = 11;
        int k, overlaps = 0;
        for (k = 0; k < 400; k++) {
            static demi_solid a, b;
            const dem_shape one = scene_rock(w, &random, 8 + k%9, 0.01), two = k%3 ? one : scene_box(w, 0.012, 0.006, 0.015);
            const demi_part p = scene_part(w, one, scene_turn(&random)), q = scene_part(w, two, scene_turn(&random));
            demi_simplex tells;
            demi_d3 n = demi_d(0, 0, 0), turned = n;
            double gap, other, best = -1e300;
            int i, f, pass;
            demi_solid_of(&p, at(0, 0, 0), &a);
            demi_solid_of(&q, scene_at(&random, 0.03, -0.015, 0.03, -0.015, 0.02, -0.01), &b);
            gap = demi_solids_gap(&a, &b, 1e300, &n, &tells);
            other = demi_solids_gap(&b, &a, 1e300, &turned, &tells);
            CHECK_NEAR(gap, other, 1e-12);
            CHECK_NEAR(demi_d3_length(demi_d3_add(n, turned)), 0, gap > 1e-6 ? 1e-6 : 2);
            for (pass = 0; pass < 2; pass++)    /* no face's plane keeps them farther apart than the gap is */
                for (f = 0; f < (pass ? b.faces : a.faces); f++) {
                    const demi_d3 way = pass ? demi_d3_scale(b.face[f].slope, -b.face[f].high)
                        : demi_d3_scale(a.face[f].slope, a.face[f].high);
                    best = fmax(best, demi_solids_slab(&a, &b, way));
                }
            CHECK(best < gap + (fine ? 1e-12 : 1e-8));    /* planes and corners are rounded apart */
            if (gap < 0) {
                overlaps++;                     /* moved by its depth along the normal, it only just is apart */
                for (i = 0; i < b.corners; i++) b.corner[i] = demi_d3_plus(b.corner[i], 1e-9 - gap, n);
                b.centre = demi_d3_plus(b.centre, 1e-9 - gap, n);
                turned = demi_d(0, 0, 0);
                CHECK_NEAR(demi_solids_gap(&a, &b, 1e300, &turned, &tells), 1e-9, 1e-11);
            }
        }
        CHECK(overlaps > 50 && overlaps < 350);
        dem_world_destroy(w);
    }

    TEST("rocks: the gap to a tube, inside and outside, and to a cone equals that of sampled surface points") {
        dem_material m;
        dem_world *w = rigid(0, 0, 0, &m);
        uint64_t random = 3;
        int k;
        for (k = 0; k < 120; k++) {
            static demi_solid s, placed;
            static demi_gaps gaps;
            const dem_shape shape = k%2 ? scene_rock(w, &random, 12, 0.01) : scene_box(w, 0.02, 0.012, 0.008);
            const demi_part p = scene_part(w, shape, scene_turn(&random));
            const int kind = k%3;               /* tube outside, tube inside, cone */
            const double angle = 6.2831*scene_random(&random);
            const double out = kind == 1 ? 0.03 + 0.004*scene_random(&random) : 0.05 + 0.006*scene_random(&random);
            const dem_vec3 x = at(out*cos(angle), out*sin(angle), kind == 2 ? 0.13 : 0.01);
            demi_generator l = {0.04, 0.04, -0.1, 0.1, -1, {0, 0}};
            double gap, wanted;
            int points;
            if (kind == 1) l.side = 1;
            if (kind == 2) { l.a = 0.1154700538379252; l.g = 0; l.b = 0; l.h = 0.2; }
            tube_radius = kind == 1 ? -0.04 : 0.04;
            demi_solid_of(&p, at(0, 0, 0), &s);
            demi_solid_of(&p, x, &placed);
            gaps.count = 0;
            gaps.range = 1;
            demi_generator_gaps(&s, &l, demi_d3_of(x), 0, &gaps);
            gap = least_gap(&gaps, &points);
            wanted = scene_sampled(&placed, kind == 2 ? off_cone : off_tube);
            CHECK(points > 0);
            CHECK(gap < wanted + 1e-12);        /* samples lie on the faces, and may miss the nearest point */
            CHECK(gap > wanted - (kind == 1 ? 1e-12 : 3e-5));
        }
        dem_world_destroy(w);
    }

    TEST("rocks: a block sticks up to atan mu, slides at g (sin - mu cos) above and tips at width/height, on any flat "
         "surface") {
        const double pi = 3.14159265358979, limit = atan(0.5), part = 0.05*pi/180;
        double spin;
        int floor;
        for (floor = 0; floor < 3; floor++) {
            CHECK_NEAR(slides(limit - part, 0.5, 0.1, 0.05, floor, &spin), 0, fine ? 1e-7 : 1e-4);
            CHECK_NEAR(spin, 0, fine ? 1e-6 : 1e-2);
            CHECK(slides(limit + part, 0.5, 0.1, 0.05, floor, &spin) > 1e-4);
            CHECK_REL(slides(0.7, 0.5, 0.1, 0.05, floor, &spin), 0.2*earth*(sin(0.7) - 0.5*cos(0.7)), fine ? 1e-3 : 1e-2);
            CHECK_NEAR(spin, 0, fine ? 1e-5 : 1e-2);
            slides(atan(0.5) - 0.2*pi/180, 2, 0.1, 0.2, floor, &spin);
            CHECK_NEAR(spin, 0, fine ? 1e-6 : 1e-3);
            slides(atan(0.5) + 0.2*pi/180, 2, 0.1, 0.2, floor, &spin);
            CHECK(spin > 1e-3);
        }
    }

    TEST("rocks: a cube that falls flat leaves with its restitution without rotation; on a corner it does so at that "
         "corner") {
        int k, corner;
        for (k = 0; k <= 4; k++)
            for (corner = 0; corner < 2; corner++) {
                dem_material m;
                dem_world *w = rigid_to(1e-12, 0, 0.25*k, 0, &m);
                const dem_quat q = corner ? dem_quat_about(at(1, -0.7, 0), DEM_R(0.8)) : straight;
                const dem_vec3 x = at(0.003, 0.001, 0.021);
                dem_quat turned;
                dem_body b;
                dem_body_state s;
                dem_vec3 low = at(0, 0, 1);
                double rise;
                int i;
                dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
                b = dem_body_add(w, m, scene_box(w, 0.02, 0.02, 0.02), x, q);
                scene_move(w, b, at(0, 0, -1), at(0, 0, 0));
                for (i = 0; i < 30 && !(scene_state(w, b).velocity.z > DEM_R(-0.999)); i++) scene_step(w, 1);
                turned = k ? q : scene_state(w, b).orientation;     /* as the impulse found it */
                if (!k) scene_step(w, 1);       /* it came to touch in the step before */
                s = scene_state(w, b);
                for (i = 0; i < 8; i++) {
                    const dem_vec3 arm = dem_quat_rotate(turned, at(i & 1 ? 0.01 : -0.01, i & 2 ? 0.01 : -0.01,
                                                                    i & 4 ? 0.01 : -0.01));
                    if (arm.z < low.z) low = arm;
                }
                rise = (double)s.velocity.z + (double)demi_cross(s.spin, low).z;
                /* without restitution what turns comes to the floor once more: by its gap, 1e-5 m, in a step of 1 ms */
                if (corner && !k) CHECK(rise > -0.02 && rise < 1e-3);
                else CHECK_NEAR(corner ? rise : (double)s.velocity.z, 0.25*k, fine ? 1e-9 : 1e-3);
                if (!corner) CHECK_NEAR((double)demi_length(s.spin), 0, fine ? 1e-9 : 0.1);
                else CHECK((double)demi_length(s.spin) > 1);
                dem_world_destroy(w);
            }
    }

    TEST("rocks: cubes, needles and tetrahedra on edges and corners stay on a floor of two triangles as on a plane") {
        int pose, k, depth;
        for (pose = 0; pose < 3; pose++)
            for (depth = 0; depth < 3; depth++)
                for (k = 0; k < 4; k++) {
                    static const double off[4] = {0, 3e-7, 3e-5, 1e-2};
                    const double deep = depth == 0 ? 1e-9 : depth == 1 ? 1e-6 : 1e-4, half = 0.01, pi = 3.14159265358979;
                    const dem_real spike[12] = {0, 0, DEM_R(-0.01), DEM_R(0.01), DEM_R(0.01), DEM_R(0.01), DEM_R(-0.01), DEM_R(0.01),
                                                DEM_R(0.011), 0, DEM_R(-0.01), DEM_R(0.01)};
                    dem_real v[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
                    int32_t t[6] = {0, 1, 2, 0, 2, 3};
                    dem_mesh mesh;
                    dem_material m;
                    dem_world *w = rigid_to(1e-9, earth, 0, 0.5, &m);
                    const dem_quat along = dem_quat_about(at(0, 0, 1), (dem_real)(pi/4));
                    const dem_quat q = pose == 2 ? straight : dem_quat_multiply(along, dem_quat_about(at(1, 0, 0), (dem_real)(pi/4)));
                    const dem_shape shape = pose == 2 ? dem_shape_polyhedron_add(w, 4, spike)
                        : scene_box(w, pose ? 0.1 : 2*half, 2*half, 2*half);
                    dem_shape_info info;
                    dem_body b;
                    double most;
                    mesh.vertex_count = 4; mesh.triangle_count = 2; mesh.vertices = v; mesh.triangles = t;
                    dem_wall_mesh_add(w, m, &mesh);
                    dem_shape_get(w, shape, &info);
                    b = dem_body_add(w, m, shape, pose == 2
                                     ? at(0.2 + off[k] + (double)info.centre.x, 0.2 + (double)info.centre.y,
                                          half - deep + (double)info.centre.z)
                                     : at(0.2 + off[k], 0.2, half*sqrt(2.0) - deep), q);
                    most = (double)scene_state(w, b).position.z;
                    CHECK_EQ(scene_step(w, 400), DEM_OK);
                    CHECK((double)scene_state(w, b).position.z > (pose == 2 ? 0.3 : 0.99)*half);     /* it may tip over */
                    CHECK((double)scene_state(w, b).position.z < most + (fine ? 1e-6 : 1e-4) + 2*deep);
                    dem_world_destroy(w);
                }
    }

    TEST("rocks: a plate dropped onto the rim of a tube or cone rests on it or falls off, and is nowhere deep in it") {
        int kind, k;
        for (kind = 0; kind < 3; kind++)
            for (k = 0; k < 5; k++) {
                static const double off[5] = {-1e-3, -1e-5, 1e-5, 5e-4, 1e-3};
                const dem_real r[3][4] = {{DEM_R(0.04), DEM_R(0.04)}, {DEM_R(0.04), DEM_R(0.04), DEM_R(0.042), DEM_R(0.042)},
                                          {DEM_R(0.01), DEM_R(0.05)}};
                const dem_real z[3][4] = {{DEM_R(-0.05), 0}, {DEM_R(-0.05), 0, 0, DEM_R(-0.05)}, {DEM_R(-0.04), 0}};
                dem_material m;
                dem_world *w = rigid_to(1e-7, earth, 0.2, 0.5, &m);
                dem_body b;
                int i, deep = 0;
                CHECK(dem_wall_revolved_add(w, m, at(0, 0, 0), at(0, 0, 1), kind == 1 ? 4 : 2, r[kind], z[kind]).id);
                b = dem_body_add(w, m, scene_box(w, 0.006, 0.006, 0.004), at((kind == 2 ? 0.05 : 0.04) + off[k], 0, 2.3e-3), straight);
                dem_world_dt_set(w, DEM_R(1e-4));
                for (i = 0; i < 400; i++) {
                    if (scene_step(w, 1) != DEM_OK) break;
                    deep += (double)dem_counters_get(w).overlap_max > 0.3;
                }
                CHECK_EQ(i, 400);
                CHECK_EQ(deep, 0);
                CHECK((double)demi_length(scene_state(w, b).velocity) < 1);
                dem_world_destroy(w);
            }
    }

    TEST("rocks: thousands of impacts of mixed shapes in a box never gain energy, and conserve momentum between "
         "bodies") {
        int friction;
        for (friction = 0; friction < 2; friction++) {
            dem_material m;
            dem_world *w = rigid(0, 1, friction ? 0.5 : 0, &m);
            uint64_t random = 17;
            double before, first;
            dem_totals had;
            int k, gained = 0;
            for (k = 0; k < 6; k++) {
                const double x = k & 1 ? 0.04 : -0.04, sign = k & 1 ? -1 : 1;
                if (friction) dem_wall_plane_add(w, m, at(k/2 == 0 ? x : 0, k/2 == 1 ? x : 0, k/2 == 2 ? x : 0),
                                            at(k/2 == 0 ? sign : 0, k/2 == 1 ? sign : 0, k/2 == 2 ? sign : 0));
            }
            for (k = 0; k < 27; k++) {
                const dem_vec3 x = at(0.024*(k%3 - 1), 0.024*(k/3%3 - 1), 0.024*(k/9 - 1));
                const dem_body b = k%5 == 4 ? dem_sphere_add(w, m, DEM_R(0.007), x)
                    : dem_body_add(w, m, k%5 == 3 ? dem_shape_ellipsoid_add(w, at(0.006, 0.008, 0.01))
                                   : k%5 == 2 ? scene_box(w, 0.012, 0.012, 0.012) : scene_rock(w, &random, 12, 0.01), x,
                                   scene_turn(&random));
                scene_move(w, b, at(-20*(double)x.x, -20*(double)x.y, -20*(double)x.z + 0.1*(k%3)), at(10, -20, 5));
            }
            had = dem_totals_get(w);
            first = before = (double)(dem_ledger_get(w).kinetic + dem_ledger_get(w).rotational);
            for (k = 0; k < 300; k++) {
                double now;
                if (scene_step(w, 1) != DEM_OK) break;
                now = (double)(dem_ledger_get(w).kinetic + dem_ledger_get(w).rotational);
                gained += k > 0 && now > before*(1 + 1e-6);
                before = now;
            }
            CHECK_EQ(k, 300);
            CHECK_EQ(gained, 0);
            CHECK(before < first && before > 0.02*first);
            if (!friction)
                for (k = 0; k < 3; k++) CHECK_NEAR(dem_totals_get(w).momentum[k]/(had.mass*0.2), had.momentum[k]/(had.mass*0.2), fine ? 1e-12 : 1e-4);
            dem_world_destroy(w);
        }
    }

    TEST("rocks: a stack of ten cubes is stable for 600 steps of 1 ms, creeps below 1e-6 m/s, and loads its floor "
         "with its weight") {
        dem_material m;
        dem_world *w = rigid_to(1e-7, earth, 0, 0.5, &m);
        dem_shape cube = scene_box(w, 0.02, 0.02, 0.02);
        dem_body b[10];
        dem_wall_loads loads;
        dem_vec3 from;
        dem_wall floor = dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
        int k;
        for (k = 0; k < 10; k++)
            b[k] = dem_body_add(w, m, cube, at(k%2 ? 2e-4 : 0, k%3 ? 1e-4 : 0, 0.01 + 0.02*k),
                                dem_quat_about(at(0, 0, 1), (dem_real)(0.02*k)));
        CHECK_EQ(scene_step(w, 300), DEM_OK);
        from = scene_state(w, b[9]).position;
        CHECK_EQ(scene_step(w, 300), DEM_OK);
        CHECK_NEAR((double)demi_length(demi_sub(scene_state(w, b[9]).position, from))/0.3, 0, fine ? 1e-6 : 1e-3);
        CHECK_NEAR((double)scene_state(w, b[9]).position.z, 0.19, 1e-5);
        CHECK_NEAR((double)demi_length(scene_state(w, b[9]).spin), 0, fine ? 1e-4 : 1e-1);
        CHECK_EQ(dem_wall_loads_get(w, floor, &loads), DEM_OK);
        CHECK_REL((double)loads.force.z, -10*2500*8e-6*earth, fine ? 1e-4 : 1e-2);
        dem_world_destroy(w);
    }

    TEST("rocks: a law with a range acts over the gap of two cubes, and of a cube and a plane, mesh, tube and ball") {
        int k;
        for (k = 0; k < 5 && fine; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            const double gap = 0.0007, range = 0.001;
            dem_material_desc stuff = scene_stuff(1e7, 0.5, 0, 0);
            dem_world *w;
            dem_material m;
            dem_body b;
            dem_shape cube;
            desc.law = holds;
            desc.law_stiffness = DEM_R(1e5);
            desc.law_range = (dem_real)range;
            desc.dt = DEM_R(1e-6);
            w = dem_world_create(&desc);
            m = dem_material_add(w, &stuff);
            cube = scene_box(w, 0.02, 0.02, 0.02);
            b = dem_body_add(w, m, cube, at(k == 3 ? 0.05 - 0.01 - gap : 0, 0, 0.01 + gap), straight);
            CHECK(b.slot);
            if (k == 0) dem_body_add(w, m, cube, at(0.001, 0.002, -0.01), straight);
            if (k == 1) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
            if (k == 2) {
                dem_real v[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
                int32_t t[6] = {0, 1, 2, 0, 2, 3};
                const dem_mesh mesh = {4, 2, v, t};
                dem_wall_mesh_add(w, m, &mesh);
            }
            if (k == 3) dem_wall_plane_add(w, m, at(0.05, 0, 0), at(-1, 0, 0));
            if (k == 4) dem_sphere_add(w, m, DEM_R(0.01), at(0, 0, -0.01));
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            CHECK_REL((double)demi_length(demi_at(w->bodies.force + 4*(w->bodies.pos[2] > 0 ? 0 : 1))), 1 - gap/range, 1e-6);
            dem_world_destroy(w);
        }
        CHECK(1);
    }

    TEST("rocks: a law with a range acts and bonds are made where faces of cubes, squares and planes touch exactly") {
        static const double sizes[4] = {1, 0.1, 0.3, 0.07};       /* multiples of the last three are rounded */
        int k, i, n;
        for (k = 0; k < 3; k++) {                      /* cubes, squares, a cube on a plane */
            const dem_real square[8] = {DEM_R(-0.5), DEM_R(-0.5), DEM_R(0.5), DEM_R(-0.5),
                                        DEM_R(0.5), DEM_R(0.5), DEM_R(-0.5), DEM_R(0.5)};
            dem_material m;
            dem_world *w = bonding(k == 1, &m);
            const dem_shape cube = k == 1 ? dem_shape_polygon_add(w, 4, square) : scene_box(w, 1, 1, 1);
            dem_body_add(w, m, cube, at(0.5, 0, 0), straight);
            if (k == 2) dem_wall_plane_add(w, m, at(0, 0, 0), at(1, 0, 0));
            else dem_body_add(w, m, cube, at(-0.5, 0, 0), straight);
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            CHECK(touch_calls > 0);
            CHECK_EQ(dem_contacts_get(w, 0, 0), 4);
            CHECK_EQ(dem_bonds_make(w, DEM_R(0.005), bond_all, 0), k == 2 ? 0 : 4);    /* bonds hold bodies */
            dem_world_destroy(w);
        }
        for (k = 0; k < 4; k++) {                      /* four points in each of nine joints of a row */
            dem_material m;
            dem_world *w = bonding(0, &m);
            const dem_shape brick = scene_box(w, sizes[k], sizes[k], sizes[k]);
            for (i = 0; i < 10; i++) dem_body_add(w, m, brick, at(sizes[k]*i, 0, 0), straight);
            n = dem_bonds_make(w, DEM_R(0.005), bond_all, 0);
            CHECK_EQ(n, 36);
            dem_world_destroy(w);
        }
    }

    TEST("rocks: a law with a range is not called for the needle of a union that ends beyond it above a block") {
        dem_material m;
        dem_world *w = bonding(0, &m);
        const dem_shape block = scene_box(w, 6, 6, 2);
        dem_shape pieces[2];
        dem_shape both;
        dem_real places[6] = {0, 0, DEM_R(1.05), 1, 0, DEM_R(0.5)};
        dem_shape_info info;
        pieces[0] = dem_shape_ellipsoid_add(w, at(0.1, 0.1, 1));
        pieces[1] = scene_box(w, 1, 1, 1);
        both = dem_shape_union_add(w, 2, pieces, places, 0);
        CHECK_EQ(dem_shape_get(w, both, &info), DEM_OK);
        /* the cube touches, the tip of the needle is 0.05 m above the block, five times the range */
        dem_body_add(w, m, both, at((double)info.centre.x, (double)info.centre.y, (double)info.centre.z - 1e-5),
                     straight);
        dem_body_add(w, m, block, at(0, 0, -1), straight);
        CHECK_EQ(scene_step(w, 2), DEM_OK);
        CHECK(touch_calls > 0);
        CHECK_EQ(beyond_calls, 0);
        CHECK_EQ(dem_contacts_get(w, 0, 0), 4);
        dem_world_destroy(w);
    }

    return test_end();
}
