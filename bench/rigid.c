/* rigid.c - one heap of bench/rigid.h in dem.h, by impulses with the default tolerance. MIT licence.

   build/rigid blocks_rigid            1,000 cubes: one line of numbers, for bench/rigid.sh
   build/rigid rocks_rigid 200 50 7    200 rocks, at most 50 sweeps, places drawn with seed 7 */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "bench/rigid.h"

static dem_vec3 at(const double *x) { return dem_vec3_make((dem_real)x[0], (dem_real)x[1], (dem_real)x[2]); }

int main(int argc, char **argv) {
    rigid_heap h = rigid_begin(argc, argv);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_world *world;
    dem_material rock;
    dem_shape shape[RIGID_KINDS] = {{0}};
    double kinetic = 0, height = 0, seconds = 0, contacts = 0, sweeps = 0;
    dem_body *body = (dem_body *)calloc((size_t)h.count, sizeof *body);
    int i, k, step;
    if (argc > 1 && !strncmp(argv[1], "--", 2)) {
        puts("build/rigid [balls_rigid | blocks_rigid | rocks_rigid [BODIES [SWEEPS [SEED]]]]: see bench/rigid.h");
        return 0;
    }
    desc.gravity.z = DEM_R(-9.81);
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(RIGID_DT);
    desc.sweeps = h.most;
    desc.threads = 1;
    world = dem_world_create(&desc);
    stuff.density = DEM_R(RIGID_DENSITY);
    stuff.friction = DEM_R(RIGID_FRICTION);
    stuff.restitution = 0;
    rock = dem_material_add(world, &stuff);
    for (k = 0; k < 5; k++) {
        double n[3], off, x[3];
        rigid_wall(k, n, &off);
        for (i = 0; i < 3; i++) x[i] = n[i]*off;
        dem_wall_plane_add(world, rock, at(x), at(n));
    }
    for (k = 0; k < RIGID_KINDS; k++) {
        double x[3*RIGID_POINTS];
        dem_real points[3*RIGID_POINTS];
        const int count = rigid_points(&h, k, x);
        for (i = 0; i < 3*count; i++) points[i] = (dem_real)x[i];
        if (count) shape[k] = dem_shape_polyhedron_add(world, count, points);
    }
    for (i = 0; i < h.count; i++) {
        double x[3];
        rigid_place(&h, i, x);
        body[i] = h.shape == RIGID_BALLS ? dem_sphere_add(world, rock, DEM_R(0.5), at(x))
            : dem_body_add(world, rock, shape[i%RIGID_KINDS], at(x), dem_quat_make(1, 0, 0, 0));
    }
    if (dem_world_step(world, RIGID_SETTLE) != DEM_OK) { fprintf(stderr, "%s\n", dem_world_error_get(world)); return 1; }
    for (step = 0; step < RIGID_TIMED; step++) {
        const double since = rigid_seconds();
        dem_counters c;
        if (dem_world_step(world, 1) != DEM_OK) { fprintf(stderr, "%s\n", dem_world_error_get(world)); return 1; }
        seconds += rigid_seconds() - since;
        c = dem_counters_get(world);
        contacts += (double)(c.contacts + c.wall_contacts)/RIGID_TIMED;
        sweeps += (double)c.sweeps/RIGID_TIMED;
    }
    for (i = 0; i < h.count; i++) {
        dem_body_state s;
        if (dem_body_get(world, body[i], &s) != DEM_OK) continue;
        kinetic += 0.5*(double)(s.velocity.x*s.velocity.x + s.velocity.y*s.velocity.y + s.velocity.z*s.velocity.z);
        height += (double)s.position.z;
    }
    rigid_tell(&h, seconds, contacts, kinetic, height, sweeps, (int)dem_counters_get(world).unsolved);
    dem_world_destroy(world);
    free(body);
    return 0;
}
