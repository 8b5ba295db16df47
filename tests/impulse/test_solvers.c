/* Solvers of impulses (desc.solver), and what impulses know beside friction: cohesion, compliance, spinning friction. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double g = 9.81;                   /* m/s2 */

static dem_world_desc solver_desc(dem_solver solver, dem_cone cone) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = (dem_real)-g;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(1e-3);
    desc.solver = solver;
    desc.cone = cone;
    desc.threads = 1;
    return desc;
}
/* One step of a heap of grains that have just fallen onto each other: always the same one. Answers the counters;
   velocities: count x 3, m/s. */
enum { heap_side = 5, heap_count = heap_side*heap_side*heap_side };
static dem_counters heap_step(dem_world_desc desc, double compliance, int shaped, double *velocities) {
    dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
    dem_world *world = dem_world_create(&desc);
    const dem_material m = dem_material_add(world, &stuff);
    dem_counters c;
    dem_shape shape = {0};
    dem_body bodies[heap_count];
    dem_pair pair;
    uint64_t seed = 5;
    int i, k;
    dem_pair_get(world, m, m, &pair);
    pair.compliance = (dem_real)compliance;
    CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(world, m, at(0, 0, 0), at(1, 0, 0));
    if (shaped) shape = dem_shape_ellipsoid_add(world, at(0.01, 0.009, 0.0095));
    for (i = 0; i < heap_count; i++) {
        const int x = i%heap_side, y = i/heap_side%heap_side, z = i/heap_side/heap_side;
        const dem_vec3 place = scene_at(&seed, 1e-3, 0.0098 + 0.0192*x, 1e-3, 0.01 + 0.0192*y, 1e-4, 0.0098 + 0.0192*z);
        bodies[i] = shaped ? dem_body_add(world, m, shape, place, dem_quat_make(1, 0, 0, 0))
            : dem_sphere_add(world, m, DEM_R(0.01), place);
        scene_move(world, bodies[i], scene_at(&seed, 0.2, -0.1, 0.2, -0.1, 0.2, -0.15), at(0, 0, 0));
    }
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    c = dem_counters_get(world);
    for (i = 0; i < heap_count && velocities; i++) {
        const dem_vec3 v = scene_state(world, bodies[i]).velocity;
        velocities[3*i] = (double)v.x; velocities[3*i + 1] = (double)v.y; velocities[3*i + 2] = (double)v.z;
    }
    for (k = 0; k < 3 && velocities; k++) CHECK(velocities[k] < 1e300);
    dem_world_destroy(world);
    return c;
}
static double farthest(const double *a, const double *b, int count) {
    double most = 0;
    int i;
    for (i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

/* Number of contacts of two grains that have hit each other and separated, on a floor that they nearly touch. */
static int solver_separated(dem_solver solver) {
    dem_world_desc desc = solver_desc(solver, DEM_CONE_COULOMB);
    dem_world *w;
    dem_material m;
    int i, contacts;
    desc.gravity.z = 0;
    desc.dt = DEM_R(1e-4);
    w = dem_world_create(&desc);
    m = scene_material(w, 0, 0.5, 0, 0);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 2; i++) {
        const dem_body grain = dem_sphere_add(w, m, DEM_R(1e-3), at(2e-3*i, 0, 1.0001e-3));
        scene_move(w, grain, at(0.2 - 0.2*i, 0, 0), at(0, 0, 0));
    }
    CHECK_EQ(scene_step(w, 1), DEM_OK);
    contacts = dem_counters_get(w).contacts;
    CHECK(scene_state(w, dem_body_id_get(w, 0)).velocity.x < scene_state(w, dem_body_id_get(w, 1)).velocity.x);
    dem_world_destroy(w);
    return contacts;
}
/* Velocity, m/s, at which a grain that has bounced off a floor, sliding, could approach it again; friction 0.1. */
static double solver_target(dem_solver solver) {
    dem_world_desc desc = solver_desc(solver, DEM_CONE_COULOMB);
    dem_world *w;
    dem_material m;
    dem_body grain;
    double bias;
    desc.gravity.z = 0;
    desc.dt = DEM_R(1e-4);
    w = dem_world_create(&desc);
    m = scene_material(w, 0, 0.5, 0.1, 0);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 1e-3));
    scene_move(w, grain, at(5, 0, -1), at(0, 0, 0));
    CHECK_EQ(scene_step(w, 1), DEM_OK);
    bias = (double)w->solver.contacts[0].bias;
    dem_world_destroy(w);
    return bias;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("impulses: projected impulses lie in the cone, nearest in the contact's metric, and projecting again changes "
         "nothing") {
        uint64_t seed = 11;
        double out = 0, moved = 0, off = 0, polar = 0;
        int i;
        for (i = 0; i < 20000; i++) {
            demi_impulse c;
            dem_vec3 slip, was, again;
            dem_real push, first, second;
            double size, dn, gn, gt, cross, edge;
            memset(&c, 0, sizeof c);
            c.mu = (dem_real)(2*scene_random(&seed));
            c.gn = (dem_real)(0.1 + scene_random(&seed));
            c.gt = c.gn*(dem_real)(1 + 3*scene_random(&seed));
            c.per_n = 1/c.gn;
            c.per_t = 1/c.gt;
            c.normal = at(0, 0, 1);
            was = scene_at(&seed, 2, -1, 2, -1, 0, 0);
            first = push = (dem_real)(2*scene_random(&seed) - 1);
            slip = was;
            demi_impulse_bound(&c, &push, &slip, 1);
            size = sqrt((double)(slip.x*slip.x + slip.y*slip.y));
            out = fmax(out, fmax(-(double)push, size - (double)c.mu*(double)push));
            second = push;
            again = slip;
            demi_impulse_bound(&c, &second, &again, 1);
            moved = fmax(moved, fabs((double)(second - push)) + fabs((double)(again.x - slip.x)));
            /* what was taken off is at right angles to what is left, and in the polar cone */
            gn = (double)c.gn; gt = (double)c.gt;
            dn = (double)(first - push)*gn;
            cross = dn*(double)push + gt*((double)(was.x - slip.x)*(double)slip.x + (double)(was.y - slip.y)*(double)slip.y);
            off = fmax(off, fabs(cross));
            edge = gt*sqrt((double)((was.x - slip.x)*(was.x - slip.x) + (was.y - slip.y)*(was.y - slip.y)));
            polar = fmax(polar, dn + (double)c.mu*edge);
        }
        CHECK(out < 1e-14);
        CHECK(moved < 1e-14);
        CHECK(off < 1e-14);
        CHECK(polar < 1e-14);
    }
    TEST("impulses: four solvers agree on a heap's velocities to 1e-8 m/s in the convex law, for spheres and "
         "ellipsoids") {
        int k, shaped, soft;
        for (shaped = 0; shaped < 2; shaped++)
            for (soft = 0; soft < 2; soft++) {
                double v[4][3*heap_count];
                for (k = 0; k < 4; k++) {
                    dem_world_desc desc = solver_desc((dem_solver)k, DEM_CONE_CONVEX);
                    dem_counters c;
                    desc.sweeps = 200000;
                    desc.tolerance = DEM_R(1e-12);
                    c = heap_step(desc, soft ? 1e-4 : 0, shaped, v[k]);
                    CHECK_EQ(c.unsolved, 0);
                    CHECK((double)c.residual <= 1e-12 && c.residual_rms <= c.residual);
                    CHECK(farthest(v[k], v[0], 3*heap_count) < 1e-8);
                }
            }
    }
    TEST("impulses: with Coulomb's law all four solvers end below a residual of 1e-9 m/s") {
        int k;
        for (k = 0; k < 4; k++) {
            dem_world_desc desc = solver_desc((dem_solver)k, DEM_CONE_COULOMB);
            dem_counters c;
            desc.sweeps = 200000;
            desc.tolerance = DEM_R(1e-9);
            c = heap_step(desc, 0, 1, 0);
            CHECK_EQ(c.unsolved, 0);
            CHECK((double)c.residual <= 1e-9 && c.sweeps > 1);
        }
    }
    TEST("impulses: sweeps end at the limit set, and counters and report give the residual") {
        dem_world_desc desc = solver_desc(DEM_SOLVER_GAUSS_SEIDEL, DEM_CONE_COULOMB);
        dem_counters c;
        desc.sweeps = 3;
        desc.tolerance = DEM_R(1e-12);
        c = heap_step(desc, 0, 0, 0);
        CHECK_EQ(c.sweeps, 3);
        CHECK_EQ(c.unsolved, 2);                /* the one that finds the first forces counts */
        CHECK((double)c.residual > 1e-12);
    }
    TEST("a step that ends unsolved names the contacts at their friction limit: all four of a sliding box") {
        dem_world_desc desc = solver_desc(DEM_SOLVER_GAUSS_SEIDEL, DEM_CONE_COULOMB);
        dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
        dem_world *world;
        dem_material m;
        dem_body box;
        desc.sweeps = 1;
        desc.tolerance = DEM_R(1e-12);
        desc.unsolved_stops = 1;
        stuff.friction = DEM_R(0.2);
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        box = dem_body_add(world, m, scene_box(world, 0.01, 0.01, 0.01), at(0, 0, 0.005), dem_quat_make(1, 0, 0, 0));
        scene_move(world, box, at(1, 0, 0), at(0, 0, 0));
        CHECK_EQ(dem_world_step(world, 5), DEM_ERROR_STOPPED);
        CHECK_STR(dem_world_error_get(world), "4 of 4 contacts are at their friction limit, where sweeps converge slowly");
        scene_report_has(world, "4 contacts were at their friction limit");
        dem_world_destroy(world);
    }
    TEST("impulses: cohesion holds up lighter bodies and releases heavier ones, and a contact reports its tension") {
        double low;
        int k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = solver_desc(DEM_SOLVER_GAUSS_SEIDEL, DEM_CONE_COULOMB);
            dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
            dem_world *world = dem_world_create(&desc);
            const dem_material m = dem_material_add(world, &stuff);
            dem_body ball;
            dem_pair pair;
            double weight;
            const dem_wall ceiling = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, -1));
            ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, -0.01));
            weight = (double)scene_state(world, ball).mass*g;
            dem_pair_get(world, m, m, &pair);
            pair.cohesion = (dem_real)(weight*(k ? 0.999 : 1.001));
            CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
            CHECK_EQ(scene_step(world, 300), DEM_OK);
            low = (double)scene_state(world, ball).position.z;
            if (k) CHECK(low < -0.0102);
            else {
                dem_wall_loads loads;
                CHECK_NEAR(low, -0.01, 1e-12);
                CHECK_EQ(dem_wall_loads_get(world, ceiling, &loads), DEM_OK);
                CHECK_REL(loads.force.z, -weight, 1e-9);
            }
            dem_world_destroy(world);
        }
    }
    TEST("impulses: on a compliant floor a ball sinks by compliance times weight") {
        dem_world_desc desc = solver_desc(DEM_SOLVER_GAUSS_SEIDEL, DEM_CONE_COULOMB);
        dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
        dem_world *world = dem_world_create(&desc);
        const dem_material m = dem_material_add(world, &stuff);
        dem_body ball;
        dem_pair pair;
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        dem_pair_get(world, m, m, &pair);
        pair.compliance = DEM_R(2e-3);
        CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
        CHECK_EQ(scene_step(world, 2000), DEM_OK);
        CHECK_NEAR(scene_state(world, ball).position.z, 0.01 - 2e-3*(double)scene_state(world, ball).mass*g, 1e-9);
        dem_world_destroy(world);
    }
    TEST("impulses: a ball that spins on the spot stops after 2/5 r w/(mu_s g)") {
        dem_world_desc desc = solver_desc(DEM_SOLVER_GAUSS_SEIDEL, DEM_CONE_COULOMB);
        dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
        dem_world *world = dem_world_create(&desc);
        const dem_material m = dem_material_add(world, &stuff);
        const double w = 40, stop = 0.4*0.01*w/(0.1*g);         /* s */
        dem_body ball;
        dem_pair pair;
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        scene_move(world, ball, at(0, 0, 0), at(0, 0, w));
        dem_pair_get(world, m, m, &pair);
        pair.spinning_friction = DEM_R(0.1);
        CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
        CHECK_EQ(dem_world_run(world, stop/2, 0, 0), DEM_OK);
        CHECK_REL(scene_state(world, ball).spin.z, w/2, 0.02);
        CHECK_EQ(dem_world_run(world, stop/2 + 0.002, 0, 0), DEM_OK);
        CHECK_NEAR(scene_state(world, ball).spin.z, 0, 1e-9);
        dem_world_destroy(world);
    }
    TEST("impulses: options unknown to springs or to a solver are rejected with the option named") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.5, 0.1);
        dem_world *world = dem_world_create(&desc);
        dem_material m = dem_material_add(world, &stuff);
        dem_pair pair;
        dem_pair_get(world, m, m, &pair);
        pair.cohesion = 1;
        CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "cohesion of materials 1 and 1 is 1 N, must be >= 0 N, and 0 where springs answer");
        dem_world_destroy(world);
        desc = solver_desc(DEM_SOLVER_APGD, DEM_CONE_COULOMB);
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
        CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "rolling or spinning friction, which the solver APGD does not support");
        dem_world_destroy(world);
    }
    TEST("grains that separate after an impact are no contacts, with every solver") {
        CHECK_EQ(solver_separated(DEM_SOLVER_GAUSS_SEIDEL), 0);
        CHECK_EQ(solver_separated(DEM_SOLVER_JACOBI), 0);
        CHECK_EQ(solver_separated(DEM_SOLVER_APGD), 0);
        CHECK_EQ(solver_separated(DEM_SOLVER_SPECTRAL), 0);
    }
    TEST("solvers leave the target of a contact as it was given") {
        const double want = solver_target(DEM_SOLVER_GAUSS_SEIDEL);
        CHECK_NEAR(solver_target(DEM_SOLVER_JACOBI), want, 1e-4);      /* m/s; they may be off by 5e-5 */
        CHECK_NEAR(solver_target(DEM_SOLVER_APGD), want, 1e-4);
        CHECK_NEAR(solver_target(DEM_SOLVER_SPECTRAL), want, 1e-4);
    }
    return test_end();
}
