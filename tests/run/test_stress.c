/* The contact points with walls, as contacts are listed, and the stress that follows from them. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "tests/test.h"
#include "tests/scene.h"

enum { BALL, EGG, PAIR, CUBE, SHAPES, PLANE = 0, MESH, WALLS };
static const double R = 0.005;
/* Above z = 0, its lowest point at -depth: a ball; an ellipsoid, two joined spheres or a cube, rotated by
   `angle` about y. Returns the body. */
static dem_body body_on(dem_world *w, dem_material m, int shape, double angle, double depth) {
    static dem_real centres[] = {DEM_R(-0.003), 0, 0, DEM_R(0.003), 0, 0};
    const double s = fabs(sin(angle)), c = fabs(cos(angle));
    const dem_quat q = dem_quat_make((dem_real)cos(angle/2), 0, (dem_real)sin(angle/2), 0);
    dem_cluster_desc pair = DEM_CLUSTER_DESC;
    pair.count = 2; pair.positions = centres; pair.radius = (dem_real)R;
    if (shape == BALL) return dem_sphere_add(w, m, (dem_real)R, at(0.001, 0.002, R - depth));
    if (shape == EGG) return dem_body_add(w, m, dem_shape_ellipsoid_add(w, at(2*R, R, R)),
                                          at(0.001, 0.002, R*sqrt(4*s*s + c*c) - depth), q);
    if (shape == PAIR) return dem_body_add(w, m, dem_shape_cluster_add(w, &pair),
                                           at(0.001, 0.002, R + 0.003*s - depth), q);
    return dem_body_add(w, m, scene_box(w, 2*R, 2*R, 2*R), at(0.001, 0.002, R*(s + c) - depth), q);
}
static void floor_of(dem_world *w, dem_material m, int wall) {
    static dem_real v[] = {DEM_R(-0.05), DEM_R(-0.04), 0, DEM_R(0.05), DEM_R(-0.04), 0, 0, DEM_R(0.07), 0};
    static int32_t t[] = {0, 1, 2};
    dem_mesh mesh;
    mesh.vertex_count = 3; mesh.triangle_count = 1; mesh.vertices = v; mesh.triangles = t;
    if (wall == PLANE) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    else CHECK(dem_wall_mesh_add(w, m, &mesh).id > 0);
}
/* One step of a body on a floor. The listed points must lie on the floor, give the body's torque, and give
   the stress of the domain and of a field. Impulses move the body after they have found its contacts. */
static void check_floor(int response, int overlap, int wall, int shape, double angle, double depth) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_field_desc field = DEM_FIELD_DESC;
    dem_contact_info c[16];
    dem_field_cell cell;
    dem_body_state b;
    dem_stress stress;
    dem_vec3 torque = at(0, 0, 0), force = at(0, 0, 0);
    dem_material m;
    dem_world *w;
    dem_field f;
    dem_body body;
    double size, work, far;         /* far: m, how far the step has moved it */
    int i, n;
    desc.domain = box_of(-0.05, -0.05, -0.05, 0.05, 0.05, 0.05);
    desc.gravity = at(0, 0, -10);
    desc.response = (dem_response)response;
    desc.ellipsoid_overlap = (dem_overlap)overlap;
    desc.dt = DEM_R(1e-6);
    w = dem_world_create(&desc);
    m = scene_material(w, 1e6, 0.5, 0, 0);
    floor_of(w, m, wall);
    body = body_on(w, m, shape, angle, depth);
    field.box = desc.domain; field.stress = 1; field.interval = 1e-9;
    field.cells[0] = field.cells[1] = field.cells[2] = 1;
    f = dem_field_add(w, &field);
    b = scene_state(w, body);
    CHECK_EQ(scene_step(w, 1), DEM_OK);
    far = (double)b.position.z;
    b = scene_state(w, body);
    far = response == DEM_RESPONSE_IMPULSES ? 1.01*fabs((double)b.position.z - far) : 0;
    CHECK(far < depth/4);
    n = dem_contacts_get(w, c, 16);
    CHECK(n > 0);
    for (i = 0; i < n; i++) {
        const dem_vec3 arm = demi_sub(c[i].point, b.position);
        CHECK_NEAR(c[i].point.z, 0, far + R*(DEMI_SINGLE ? 1e-5 : 1e-10));
        torque = demi_add(torque, demi_cross(arm, c[i].force));
        force = demi_add(force, c[i].force);
    }
    CHECK(force.z > 0);
    size = (double)force.z*R;
    CHECK_NEAR(torque.x/size, b.torque.x/size, far/R + (DEMI_SINGLE ? 1e-4 : 1e-9));
    CHECK_NEAR(torque.y/size, b.torque.y/size, far/R + (DEMI_SINGLE ? 1e-4 : 1e-9));
    work = (double)force.z*(double)b.position.z;       /* force x distance of the centre from the floor */
    CHECK_EQ(dem_stress_get(w, &stress), DEM_OK);
    CHECK_NEAR(stress.contact[2]*stress.volume/work, 1, far/R + (DEMI_SINGLE ? 1e-5 : 1e-10));
    CHECK_EQ(dem_field_cell_get(w, f, 0, 0, 0, &cell), DEM_OK);
    CHECK_NEAR(cell.stress[2]*stress.volume/work, 1, far/R + (DEMI_SINGLE ? 1e-5 : 1e-10));
    dem_world_destroy(w);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("the stress of a body on a flat wall is its force times its height, and the listed points give its torque") {
        const double angles[] = {0, 0.3, 0.7};
        int overlap, wall, shape, k;
        for (wall = PLANE; wall < WALLS; wall++)
            for (shape = BALL; shape < SHAPES; shape++)
                for (k = 0; k < 3; k++)
                    for (overlap = 0; overlap < (shape == EGG ? 3 : 1); overlap++) {
                        check_floor(DEM_RESPONSE_SPRINGS, overlap, wall, shape, angles[k], 0.01*R);
                        check_floor(DEM_RESPONSE_SPRINGS, overlap, wall, shape, angles[k], 0.1*R);
                        if (wall == PLANE)
                            check_floor(DEM_RESPONSE_IMPULSES, overlap, wall, shape, angles[k], 0.01*R);
                    }
    }
    return test_end();
}
