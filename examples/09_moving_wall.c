/* 09_moving_wall.c - lesson 9: a conveyor belt. You learn: meshes from files, moving walls, the energy ledger.

   Build:     cc -O2 -o 09_moving_wall 09_moving_wall.c ../dem.c -lm      (in the folder examples)
   Run:       ./09_moving_wall or, with a replay on the mesh, ./09_moving_wall --replay; both write belt.stl
   Question:  A ball at rest is put on a belt that runs at V = 1 m/s. Is its final speed 1 m/s? What fraction of the
              belt's work becomes heat? Does the ball notice the edges of the belt's triangles? Write down three
              answers, then run.
   Note:      STL files contain no unit, and drawings are usually in mm; dem.h is in m. When it reads a mesh, it counts
              defects and suggests a unit. */
#include "../dem.h"
#include "lesson.h"

/* Writes a belt of 12 x 1 squares of 50 mm, two triangles each, as drawing programs do: text, in mm. */
static int write_belt(const char *path) {
    FILE *file = fopen(path, "w");
    if (!file) return 0;
    fputs("solid belt\n", file);
    for (int i = 0; i < 24; i++) {
        const int x = 50*(i/2) - 500, upper = i%2;                  /* mm */
        fprintf(file, "facet normal 0 0 1\n outer loop\n  vertex %d %d 0\n  vertex %d %d 0\n  vertex %d 25 0\n"
                " endloop\nendfacet\n", x, upper ? 25 : -25, x + 50, -25, x + (upper ? 50 : 0));
    }
    fputs("endsolid belt\n", file);
    return fclose(file) == 0;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "09_moving_wall");
    const double V = 1, mu = 0.3, g = 9.81, radius = 0.01;          /* m/s, -, m/s2, m */
    if (!write_belt("belt.stl")) { puts("cannot write belt.stl: is this folder writable?"); return 1; }
    dem_world *worlds[2];
    dem_wall belt[2];
    dem_body ball[2];
    dem_mesh_health health;
    for (int i = 0; i < 2; i++) {                                   /* 0: mesh, 1: plane */
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.gravity.z = -g;
        desc.ledger = 1;                                            /* account for energy */
        desc.orientations = 1;                                      /* so that the replay shows the rotation */
        dem_world *world = worlds[i] = dem_world_create(&desc);
        dem_material_desc rubber_desc = DEM_MATERIAL_DESC;
        rubber_desc.density = 1200;                                 /* kg/m3 */
        rubber_desc.young = 1e8;                                    /* Pa */
        rubber_desc.poisson = 0.45;
        rubber_desc.restitution = 0.3;
        rubber_desc.friction = mu;
        dem_material rubber = dem_material_add(world, &rubber_desc);
        if (i == 0) {
            dem_mesh mesh;
            if (dem_mesh_read(world, "belt.stl", &mesh, &health) != DEM_OK) {
                puts(dem_world_error_get(world));
                return 1;
            }
            printf("belt.stl: %d triangles, %d open edges, %d slivers. %s\n", mesh.triangle_count, health.open_edges,
                   health.slivers, health.hint);
            dem_mesh_place(world, &mesh, 1e-3, dem_quat_make(1, 0, 0, 0), dem_vec3_make(0, 0.003, 0));  /* mm to m */
            belt[i] = dem_wall_mesh_add(world, rubber, &mesh);           /* has its own copy */
            dem_mesh_free(world, &mesh);
        } else belt[i] = dem_wall_plane_add(world, rubber, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
        dem_motion motion = DEM_MOTION;
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity.x = V;
        dem_wall_motion_set(world, belt[i], &motion);
        ball[i] = dem_sphere_add(world, rubber, radius, dem_vec3_make(0, 0, radius));
        dem_world_check_print(world, stdout);
    }

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.002;                                   /* s */
    dem_replay *replay = record ? dem_replay_open(worlds[0], "09_moving_wall.html", &replay_desc) : 0;
    dem_body_state state[2];
    double apart = 0;
    puts("time [s]  speed [m/s]  expected [m/s]");
    for (int i = 1; i <= 60; i++) {
        for (int k = 0; k < 2; k++) {
            if (dem_world_run(worlds[k], 0.0025, 0, 0) != DEM_OK) { puts(dem_world_error_get(worlds[k])); return 1; }
            dem_body_get(worlds[k], ball[k], &state[k]);
        }
        const double t = dem_world_time_get(worlds[0]), sliding = mu*g*t, rolling = 2*V/7;
        const dem_vec3 a = state[0].position, b = state[1].position;
        apart = fmax(apart, hypot(a.x - b.x, a.z - b.z));
        dem_replay_value_set(replay, "speed (m/s)", state[0].velocity.x);
        dem_replay_value_set(replay, "-R w (m/s)", -radius*state[0].spin.y);
        if (i%10 == 0) printf("%8.3f  %11.4f  %14.4f\n", t, state[0].velocity.x, sliding < rolling ? sliding : rolling);
    }
    dem_wall_loads loads;
    dem_wall_loads_get(worlds[0], belt[0], &loads);
    const dem_ledger ledger = dem_ledger_get(worlds[0]);
    const double mv2 = state[0].mass*V*V;                           /* J */
    lesson_row("final speed [m/s]", state[0].velocity.x, 0, 2*V/7, 1);
    lesson_row("final -R w [m/s]", -radius*state[0].spin.y, 0, 5*V/7, 1);
    lesson_row("work of the belt [mJ]", 1e3*loads.work, 0, 2e3*mv2/7, 1);
    lesson_row("heat of sliding [mJ]", 1e3*(ledger.slide + ledger.tangent), 0, 1e3*mv2/7, 1);
    lesson_range("residual of the ledger over energy supplied", fabs(ledger.residual)/ledger.throughput, 0, 0, 1e-3);
    lesson_range("distance of paths on mesh and plane [m]", apart, 0, 0, 1e-9);
    lesson_row("open edges of the mesh", health.open_edges, 0, 26, 0);
    lesson_claim("the mesh gets a hint about its unit", *health.hint);
    dem_replay_close(replay);
    for (int i = 0; i < 2; i++) dem_world_destroy(worlds[i]);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    First the ball slides. It gains the speed mu g t and rotates against the belt (w). Sliding ends
              when both surfaces move alike:
                  v = 2/7 V,   R w = 5/7 V   at t = 2 V/(7 mu g)
              The belt has then done the work 2/7 m V^2. Half of it is energy of the ball; the other half is heat.
   Output:    speeds, work and heat within 1 %; an energy ledger that closes; the same path on triangles and on a plane
              within 1e-9 m; a mesh with 26 open edges, those of its rim */
/* Exercises for ./09_moving_wall --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "V = {2: 0.5 to 3 by 0.1} m/s, mu = {0.25: 0.1 to 0.5 by 0.05}. How long does the ball slide, in s?",
    "V = {1.5: 0.5 to 4 by 0.1} m/s. What is the final speed of a cylinder that lies across the belt (planar = 1, "
    "gravity along y), in m/s?"};
/* Marking. Stop here if you want to find the answers yourself. A body with inertia k m R^2 ends at V k/(1 + k). */
double answer(int exercise, const double *x) { return exercise == 1 ? 2*x[0]/(7*x[1]*9.81) : x[0]*0.5/1.5; }
