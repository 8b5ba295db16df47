/* write_replays FOLDER: writes two replays for tests/browser.sh. shapes.html has beads, ellipsoids and clusters that carry
   a number and come and go, on a mesh that rotates in a drum. sieve.html has beads on a shaken sieve above a profile, with
   the contact forces of every other frame. */
#include "dem.h"
#include <stdio.h>

static dem_world *world_of(const char *reals, dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc glass = DEM_MATERIAL_DESC;
    dem_world *w;
    desc.gravity.y = DEM_R(-9.81);
    desc.body_reals = reals;
    desc.ledger = 1;
    desc.threads = 1;
    w = dem_world_create(&desc);
    glass.density = 2500; glass.young = DEM_R(1e6); glass.poisson = DEM_R(0.25);
    glass.restitution = DEM_R(0.5); glass.friction = DEM_R(0.4);
    stuff[0] = dem_material_add(w, &glass);
    glass.density = 1500;
    stuff[1] = dem_material_add(w, &glass);
    return w;
}
/* Runs the world and writes its replay. Half way one body is removed and another added. */
static int replay(dem_world *w, const char *path, const char *title, dem_material stuff, int frames, dem_body gone, int contacts) {
    dem_replay_desc desc = DEM_REPLAY_DESC;
    dem_replay *r;
    int k;
    desc.title = title;
    desc.contacts = contacts;
    r = dem_replay_open(w, path, &desc);
    for (k = 0; r && k < frames; k++) {
        if (k && dem_world_run(w, 0.01, 0, 0) != DEM_OK) break;
        if (k == frames/2) {
            dem_body_remove(w, gone);
            dem_sphere_add(w, stuff, DEM_R(0.003), dem_vec3_make(0, DEM_R(0.03), 0));
        }
        dem_replay_value_set(r, "kinetic energy (J)", dem_totals_get(w).kinetic);
        dem_replay_value_set(r, "rotational energy (J)", dem_totals_get(w).rotational);
        dem_replay_value_set(r, "contacts", dem_counters_get(w).contacts);
        if (dem_replay_frame_write(r) != DEM_OK) break;
    }
    k = r && k == frames && dem_replay_close(r) == DEM_OK;
    if (!k) fprintf(stderr, "%s\n", dem_world_error_get(w));
    dem_world_destroy(w);
    return k;
}
static int shapes(const char *path) {
    static dem_real square[12] = {DEM_R(-0.02), 0, DEM_R(-0.02), DEM_R(0.02), 0, DEM_R(-0.02), DEM_R(0.02), DEM_R(0.004),
                                  DEM_R(0.02), DEM_R(-0.02), DEM_R(0.004), DEM_R(0.02)};
    static int32_t corners[6] = {0, 1, 2, 0, 2, 3};
    static const dem_real centres[6] = {DEM_R(-0.001), 0, 0, DEM_R(0.001), 0, 0};
    dem_cluster_desc twin_desc = DEM_CLUSTER_DESC;
    dem_motion turning = DEM_MOTION;
    dem_mesh mesh;
    dem_material stuff[2];
    dem_world *w = world_of("warmth", stuff);
    const dem_box box = dem_box_make(DEM_R(-0.015), 0, DEM_R(-0.015), DEM_R(0.015), DEM_R(0.03), DEM_R(0.015));
    dem_shape egg = dem_shape_ellipsoid_add(w, dem_vec3_make(DEM_R(0.003), DEM_R(0.001), DEM_R(0.0015))), twin;
    dem_body gone;
    dem_wall plate;
    dem_real warmth;
    int k;
    mesh.vertex_count = 4; mesh.triangle_count = 2; mesh.vertices = square; mesh.triangles = corners;
    twin_desc.count = 2; twin_desc.positions = centres; twin_desc.radius = DEM_R(0.0015);
    twin = dem_shape_cluster_add(w, &twin_desc);
    dem_wall_cylinder_add(w, stuff[0], dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1), DEM_R(0.04), 1);
    plate = dem_wall_mesh_add(w, stuff[0], &mesh);
    turning.kind = DEM_MOTION_ROTATING; turning.axis = dem_vec3_make(0, 1, 0); turning.speed = 6;
    dem_wall_motion_set(w, plate, &turning);
    dem_bodies_fill(w, stuff[0], egg, dem_region_make(box), 40, 1);
    dem_bodies_fill(w, stuff[1], twin, dem_region_make(box), 40, 2);
    dem_spheres_fill(w, stuff[1], DEM_R(0.001), dem_region_make(box), 60, 3);
    gone = dem_sphere_add(w, stuff[0], DEM_R(0.002), dem_vec3_make(0, DEM_R(0.035), 0));
    for (k = 0; k < dem_bodies_get(w).count; k++) {
        warmth = 300 + k;
        dem_body_reals_set(w, dem_body_id_get(w, k), &warmth);
    }
    return replay(w, path, "shapes </script> & \"quotes\"", stuff[0], 40, gone, 0);
}
static int sieve(const char *path) {
    static dem_real line[8] = {DEM_R(-0.03), DEM_R(-0.03), DEM_R(-0.01), DEM_R(-0.04), DEM_R(0.01), DEM_R(-0.04),
                               DEM_R(0.03), DEM_R(-0.03)};
    static int32_t segments[6] = {0, 1, 1, 2, 2, 3};
    dem_sieve_desc deck = DEM_SIEVE_DESC;
    dem_motion shaking = DEM_MOTION;
    dem_profile trough;
    dem_material stuff[2];
    dem_world *w = world_of(0, stuff);
    dem_wall wall;
    dem_body gone;
    trough.vertex_count = 4; trough.segment_count = 3; trough.vertices = line; trough.segments = segments;
    dem_wall_profile_add(w, stuff[0], &trough, DEM_EDGE_RESOLVED);
    dem_wall_plane_add(w, stuff[0], dem_vec3_make(0, DEM_R(-0.045), 0), dem_vec3_make(0, 1, 0));
    deck.kind = DEM_SIEVE_SQUARE; deck.normal = dem_vec3_make(0, 1, 0); deck.aperture = DEM_R(0.004);
    deck.bar = DEM_R(0.002); deck.radius = DEM_R(0.025);
    wall = dem_wall_sieve_add(w, stuff[0], &deck);
    shaking.kind = DEM_MOTION_OSCILLATING; shaking.velocity = dem_vec3_make(1, 1, 0);
    shaking.amplitude = DEM_R(0.002); shaking.frequency = 20;
    dem_wall_motion_set(w, wall, &shaking);
    dem_spheres_fill(w, stuff[0], DEM_R(0.0015),
                     dem_region_make(dem_box_make(DEM_R(-0.015), DEM_R(0.005), DEM_R(-0.015), DEM_R(0.015), DEM_R(0.03), DEM_R(0.015))),
                     150, 1);
    gone = dem_sphere_add(w, stuff[1], DEM_R(0.003), dem_vec3_make(0, DEM_R(0.035), 0));
    return replay(w, path, "a sieve", stuff[0], 40, gone, 2);
}
int main(int argc, char **argv) {
    char path[2][400];
    const char *folder = argc > 1 ? argv[1] : ".";
    snprintf(path[0], sizeof path[0], "%.380s/shapes.html", folder);
    snprintf(path[1], sizeof path[1], "%.380s/sieve.html", folder);
    return shapes(path[0]) && sieve(path[1]) ? 0 : 1;
}
