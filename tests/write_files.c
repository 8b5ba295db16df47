/* write_files.c - make readers: writes one small scene in every picture format, and what a reader must
   find in it as plain text: expected.txt, lines of a name and numbers. */
#include "dem.h"
#include <stdlib.h>

static void save(dem_world *world, dem_result result) {
    if (result != DEM_OK) { printf("%s\n", dem_world_error_get(world)); exit(1); }
}

int main(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.y = DEM_R(-9.81);
    desc.domain = dem_box_make(DEM_R(-0.5), -1, DEM_R(-0.5), DEM_R(0.5), 1, DEM_R(0.5));
    desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    dem_world *world = dem_world_create(&desc);
    if (!world) { printf("%s\n", dem_world_create_error_get(&desc)); return 1; }

    /* three materials of beads of three sizes, flying every way */
    dem_material materials[3];
    for (int i = 0; i < 3; i++) {
        dem_material_desc m = DEM_MATERIAL_DESC;
        m.density = DEM_R(1000*(i + 1));
        m.young = DEM_R(1e6);
        m.poisson = DEM_R(0.25);
        m.restitution = DEM_R(0.5);
        m.friction = DEM_R(0.3);
        materials[i] = dem_material_add(world, &m);
        dem_spheres_fill(world, materials[i], DEM_R(0.02*(i + 1)), dem_region_make(desc.domain), 50,
                         (uint64_t)i + 1);
    }
    dem_bodies bodies = dem_bodies_get(world);
    for (int i = 0; i < bodies.count; i++) {
        dem_body body = dem_body_id_get(world, i);
        dem_body_state state;
        save(world, dem_body_get(world, body, &state));
        state.velocity = dem_vec3_make(DEM_R(0.5), DEM_R(i%7 - 3), DEM_R(i%5 - 2));
        state.spin = dem_vec3_make(DEM_R(i), 1, DEM_R(-i));
        save(world, dem_body_set(world, body, &state));
    }

    /* a floor of two triangles below, and a profile of two segments */
    dem_real corners[12] = {-1, -1, -1, 1, -1, -1, 1, -1, 1, -1, -1, 1};
    int32_t triangles[6] = {0, 2, 1, 0, 3, 2};
    dem_mesh mesh;
    mesh.vertex_count = 4; mesh.triangle_count = 2; mesh.vertices = corners; mesh.triangles = triangles;
    dem_wall_mesh_add(world, materials[0], &mesh);
    dem_real line[6] = {-2, -2, 2, -2, 2, 2};
    int32_t segments[4] = {0, 1, 1, 2};
    dem_profile profile;
    profile.vertex_count = 3; profile.segment_count = 2; profile.vertices = line; profile.segments = segments;
    dem_wall_profile_add(world, materials[0], &profile, DEM_EDGE_RESOLVED);

    save(world, dem_world_step(world, 20));
    save(world, dem_vtp_write(world, "grains.vtp"));
    save(world, dem_vtk_write(world, "grains.vtk"));
    save(world, dem_xyz_write(world, "grains.xyz"));
    save(world, dem_walls_vtp_write(world, "walls.vtp", DEM_R(-0.5), DEM_R(0.5)));
    save(world, dem_surfaces_vtp_write(world, "surfaces.vtp"));

    FILE *out = fopen("expected.txt", "w");
    if (!out) { printf("cannot write expected.txt\n"); return 1; }
    fprintf(out, "# grain: id material radius x y z vx vy vz wx wy wz\n");
    fprintf(out, "time %.17g\nwalls 10 6\n", dem_world_time_get(world));   /* 4 + 2*3 corners, 2 + 2*2 triangles */
    bodies = dem_bodies_get(world);
    for (int i = 0; i < bodies.count; i++) {
        const dem_real *p = bodies.positions + 4*i, *v = bodies.velocities + 4*i, *w = bodies.spins + 4*i;
        fprintf(out, "grain %lu %ld %.17g", (unsigned long)bodies.slots[i], (long)bodies.materials[i], (double)p[3]);
        for (int k = 0; k < 3; k++) fprintf(out, " %.17g", (double)p[k]);
        for (int k = 0; k < 3; k++) fprintf(out, " %.17g", (double)v[k]);
        for (int k = 0; k < 3; k++) fprintf(out, " %.17g", (double)w[k]);
        fprintf(out, "\n");
    }
    fclose(out);
    printf("%d grains written\n", bodies.count);
    dem_world_destroy(world);
    return 0;
}
