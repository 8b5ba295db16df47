/* calls.h - the calls that scenes consist of: their arguments, a function that makes the call, and its text in C.
   A new call is a struct of arguments, its rows of fields, a function and a row of rel_calls. */
#ifndef REL_CALLS_H
#define REL_CALLS_H
#include "scene.h"
#include "codes.h"

#define REL_N(fields) ((int)(sizeof (fields)/sizeof *(fields)))
/* A row of a field: name is a member of struct A; l, m, t are the powers of length, mass and time. */
#define F(A, name, type, nature, l, m, t) {#name, REL_##type, REL_##nature, l, m, t, offsetof(A, name)}
#define FI(A, name) F(A, name, INT, SCALAR, 0, 0, 0)
#define FN(A, name) F(A, name, REAL, SCALAR, 0, 0, 0)
#define FREF(A, name) F(A, name, REF, SCALAR, 0, 0, 0)

typedef struct rel_run rel_run;
/* ---- world ---- */
typedef struct rel_a_world { dem_world_desc d; int domain_bodies; } rel_a_world;
static const rel_field rel_f_world[] = {
    F(rel_a_world, d.gravity, VEC, VECTOR, 1, 0, -2), F(rel_a_world, d.domain, BOX, POINT, 1, 0, 0),
    F(rel_a_world, d.boundary, INT3, PER_AXIS, 0, 0, 0), FI(rel_a_world, d.planar),
    F(rel_a_world, d.thickness, REAL, SCALAR, 1, 0, 0), FI(rel_a_world, d.normal_law), FI(rel_a_world, d.tangent_law),
    FI(rel_a_world, d.rolling_law), FI(rel_a_world, d.tension), FI(rel_a_world, d.friction_load),
    FI(rel_a_world, d.slider), FI(rel_a_world, d.convention), F(rel_a_world, d.law, CODE, FIXED, 0, 0, 0),
    F(rel_a_world, d.law_rows, CODE, FIXED, 0, 0, 0), FI(rel_a_world, d.law_memory), FI(rel_a_world, d.law_vectors),
    F(rel_a_world, d.law_stiffness, REAL, SCALAR, 0, 1, -2), F(rel_a_world, d.law_range, REAL, SCALAR, 1, 0, 0),
    FN(rel_a_world, d.law_range_radii), FI(rel_a_world, d.law_who), F(rel_a_world, d.body_reals, TEXT, FIXED, 0, 0, 0),
    F(rel_a_world, d.body_reals_fn, CODE, FIXED, 0, 0, 0), F(rel_a_world, d.growth, CODE, FIXED, 0, 0, 0),
    F(rel_a_world, d.growth_interval, REAL, SCALAR, 0, 0, 1), F(rel_a_world, d.groups, TEXT, FIXED, 0, 0, 0),
    F(rel_a_world, d.force, CODE, FIXED, 0, 0, 0), F(rel_a_world, d.body_force, CODE, FIXED, 0, 0, 0),
    FI(rel_a_world, d.integrator), F(rel_a_world, d.dt, REAL, SCALAR, 0, 0, 1),
    F(rel_a_world, d.impact_speed, REAL, SCALAR, 1, 0, -1), FI(rel_a_world, d.response), FI(rel_a_world, d.cone),
    FI(rel_a_world, d.solver), FI(rel_a_world, d.sweeps), F(rel_a_world, d.tolerance, REAL, SCALAR, 1, 0, -1),
    FI(rel_a_world, d.cold_start), FI(rel_a_world, d.search), F(rel_a_world, d.skin, REAL, SCALAR, 1, 0, 0),
    FI(rel_a_world, d.rotation), FI(rel_a_world, d.ellipsoid_overlap), FI(rel_a_world, d.cluster_contacts),
    FI(rel_a_world, d.orientations), FN(rel_a_world, d.overlap_stop), FI(rel_a_world, d.ledger),
    FI(rel_a_world, d.threads), F(rel_a_world, d.law_user, DATA, FIXED, 0, 0, 0),
    F(rel_a_world, d.law_memory_names, TEXT, FIXED, 0, 0, 0), F(rel_a_world, d.law_rate, CODE, FIXED, 0, 0, 0),
    F(rel_a_world, d.body_reals_user, DATA, FIXED, 0, 0, 0), F(rel_a_world, d.growth_user, DATA, FIXED, 0, 0, 0),
    F(rel_a_world, d.force_user, DATA, FIXED, 0, 0, 0), FI(rel_a_world, d.allow_large_dt),
    FI(rel_a_world, d.unsolved_stops), FI(rel_a_world, domain_bodies)      /* of a work group: groups.h */
};
/* ---- materials ---- */
typedef struct rel_a_material { dem_material_desc d; } rel_a_material;
static const rel_field rel_f_material[] = {
    F(rel_a_material, d.density, REAL, SCALAR, -3, 1, 0), F(rel_a_material, d.young, REAL, SCALAR, -1, 1, -2),
    FN(rel_a_material, d.poisson), FN(rel_a_material, d.restitution), FN(rel_a_material, d.friction),
    FN(rel_a_material, d.friction_static), FN(rel_a_material, d.rolling_friction),
    F(rel_a_material, d.stiffness, REAL, SCALAR, 0, 1, -2), FN(rel_a_material, d.stiffness_ratio),
    F(rel_a_material, d.stiffness_unloading, REAL, SCALAR, 0, 1, -2),
    F(rel_a_material, d.stiffness_adhesion, REAL, SCALAR, 0, 1, -2)
};
static int32_t rel_do_material(dem_world *w, void *a) { return dem_material_add(w, &((rel_a_material *)a)->d).id; }
typedef struct rel_a_pair { dem_material a, b; dem_pair d; unsigned char set[32]; } rel_a_pair;
static const rel_field rel_f_pair[] = {
    FREF(rel_a_pair, a), FREF(rel_a_pair, b), FN(rel_a_pair, d.restitution), FN(rel_a_pair, d.friction),
    FN(rel_a_pair, d.rolling_friction), FN(rel_a_pair, d.spinning_friction), FI(rel_a_pair, d.ignored),
    F(rel_a_pair, d.cohesion, REAL, SCALAR, 1, 1, -2), F(rel_a_pair, d.compliance, REAL, SCALAR, 0, -1, 2),
    F(rel_a_pair, d.normal_damping, REAL, SCALAR, 0, 1, -1), FN(rel_a_pair, d.tangent_damping),
    F(rel_a_pair, d.young_eff, REAL, SCALAR, -1, 1, -2), F(rel_a_pair, d.shear_eff, REAL, SCALAR, -1, 1, -2),
    FN(rel_a_pair, d.friction_static), F(rel_a_pair, d.stiffness, REAL, SCALAR, 0, 1, -2),
    FN(rel_a_pair, d.stiffness_ratio), F(rel_a_pair, d.stiffness_adhesion, REAL, SCALAR, 0, 1, -2)
};
/* starts from the pair as it is: only fields that are set change */
static int32_t rel_do_pair(dem_world *w, void *at) {
    rel_a_pair *a = (rel_a_pair *)at;
    dem_pair p;
    int i;
    if (dem_pair_get(w, a->a, a->b, &p) != DEM_OK) return 0;
    for (i = 2; i < REL_N(rel_f_pair); i++)
        if (a->set[i])
            memcpy((char *)&p + (rel_f_pair[i].at - offsetof(rel_a_pair, d)), (char *)at + rel_f_pair[i].at,
                   rel_f_pair[i].type == REL_INT ? sizeof(int32_t) : sizeof(dem_real));
    return dem_pair_set(w, a->a, a->b, &p) == DEM_OK;
}
/* ---- shapes ---- */
typedef struct rel_a_ellipsoid { dem_vec3 axes; } rel_a_ellipsoid;
static const rel_field rel_f_ellipsoid[] = {F(rel_a_ellipsoid, axes, VEC, FIXED, 1, 0, 0)};
static int32_t rel_do_ellipsoid(dem_world *w, void *a) {
    return dem_shape_ellipsoid_add(w, ((rel_a_ellipsoid *)a)->axes).id;
}
typedef struct rel_a_cluster { rel_reals positions, radii; dem_cluster_desc d; } rel_a_cluster;
static const rel_field rel_f_cluster[] = {
    F(rel_a_cluster, positions, REALS, IN_BODY, 1, 0, 0), F(rel_a_cluster, radii, REALS, SCALAR, 1, 0, 0),
    FI(rel_a_cluster, d.mass), FI(rel_a_cluster, d.rays), F(rel_a_cluster, d.radius, REAL, SCALAR, 1, 0, 0),
    F(rel_a_cluster, d.volume, REAL, SCALAR, 3, 0, 0), F(rel_a_cluster, d.centre, VEC, IN_BODY, 1, 0, 0),
    F(rel_a_cluster, d.inertia, REAL_ARRAY, SCALAR, 5, 0, 0)               /* drawn diagonal: mirrors keep it */
};
static int32_t rel_do_cluster(dem_world *w, void *at) {
    rel_a_cluster *a = (rel_a_cluster *)at;
    a->d.count = a->positions.count/3;
    a->d.positions = a->positions.at;
    a->d.radii = a->radii.at;
    return dem_shape_cluster_add(w, &a->d).id;
}
typedef struct rel_a_polyhedron { rel_reals points; } rel_a_polyhedron;
static const rel_field rel_f_polyhedron[] = {F(rel_a_polyhedron, points, REALS, IN_BODY, 1, 0, 0)};
static int32_t rel_do_polyhedron(dem_world *w, void *at) {
    rel_a_polyhedron *a = (rel_a_polyhedron *)at;
    return dem_shape_polyhedron_add(w, a->points.count/3, a->points.at).id;
}
typedef struct rel_a_polygon { rel_reals corners; } rel_a_polygon;
static const rel_field rel_f_polygon[] = {F(rel_a_polygon, corners, REALS, IN_BODY_2, 1, 0, 0)};
static int32_t rel_do_polygon(dem_world *w, void *at) {
    rel_a_polygon *a = (rel_a_polygon *)at;
    return dem_shape_polygon_add(w, a->corners.count/2, a->corners.at).id;
}
typedef struct rel_a_union { dem_shape shapes[8]; rel_reals positions, orientations; } rel_a_union;
static const rel_field rel_f_union[] = {
    F(rel_a_union, shapes, REF_ARRAY, SCALAR, 0, 0, 0), F(rel_a_union, positions, REALS, IN_BODY, 1, 0, 0),
    F(rel_a_union, orientations, REALS, TURN_IN_BODY, 0, 0, 0)
};
static int32_t rel_do_union(dem_world *w, void *at) {
    rel_a_union *a = (rel_a_union *)at;
    return dem_shape_union_add(w, a->positions.count/3, a->shapes, a->positions.at, a->orientations.at).id;
}
/* ---- bodies: a sphere if shape is not set ---- */
typedef struct rel_a_body {
    dem_material material; dem_shape shape;
    dem_real radius, scale;
    dem_vec3 position, velocity, spin;
    dem_quat orientation;
} rel_a_body;
static const rel_field rel_f_body[] = {
    FREF(rel_a_body, material), FREF(rel_a_body, shape), F(rel_a_body, radius, REAL, SCALAR, 1, 0, 0),
    FN(rel_a_body, scale), F(rel_a_body, position, VEC, POINT, 1, 0, 0), F(rel_a_body, velocity, VEC, VECTOR, 1, 0, -1),
    F(rel_a_body, spin, VEC, AXIAL, 0, 0, -1), F(rel_a_body, orientation, QUAT, ORIENTATION, 0, 0, 0)
};
static const rel_a_body rel_body_0 = {{0}, {0}, 0, 1, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0, 0}};
static int32_t rel_do_body(dem_world *w, void *at) {
    rel_a_body *a = (rel_a_body *)at;
    const dem_quat q = a->orientation;
    const dem_real turned[4] = {q.w, q.x, q.y, q.z};
    dem_body_state state;
    dem_body id;
    if (a->shape.id)
        return dem_bodies_add(w, a->material, a->shape, 1, &a->position.x, turned, &a->velocity.x, &a->spin.x,
                              &a->scale) == DEM_OK ? dem_bodies_get(w).count : 0;
    id = dem_sphere_add(w, a->material, a->radius, a->position);
    if (!id.slot || dem_body_get(w, id, &state) != DEM_OK) return 0;
    state.velocity = a->velocity;
    state.spin = a->spin;
    if (dem_body_set(w, id, &state) != DEM_OK) return 0;
    return dem_bodies_get(w).count;            /* its index plus 1: run.h takes its id */
}
typedef struct rel_a_of_body { dem_body body; dem_vec3 velocity, spin; dem_real radius; int fixed; dem_group group;
                               dem_rail_desc d; } rel_a_of_body;
static const rel_field rel_f_remove[] = {F(rel_a_of_body, body, BODY, SCALAR, 0, 0, 0)};
static int32_t rel_do_remove(dem_world *w, void *at) {
    return dem_body_remove(w, ((rel_a_of_body *)at)->body) == DEM_OK;
}
static const rel_field rel_f_resize[] = {F(rel_a_of_body, body, BODY, SCALAR, 0, 0, 0),
                                         F(rel_a_of_body, radius, REAL, SCALAR, 1, 0, 0)};
static int32_t rel_do_resize(dem_world *w, void *at) {
    rel_a_of_body *a = (rel_a_of_body *)at;
    return dem_body_radius_set(w, a->body, a->radius) == DEM_OK;
}
static const rel_field rel_f_fix[] = {F(rel_a_of_body, body, BODY, SCALAR, 0, 0, 0), FI(rel_a_of_body, fixed)};
static int32_t rel_do_fix(dem_world *w, void *at) {
    rel_a_of_body *a = (rel_a_of_body *)at;
    dem_selection s = DEM_SELECTION;
    s.count = 1;
    s.bodies = &a->body;
    return dem_bodies_fixed_set(w, &s, a->fixed) == 1;
}
static const rel_field rel_f_kick[] = {F(rel_a_of_body, body, BODY, SCALAR, 0, 0, 0),
    F(rel_a_of_body, velocity, VEC, VECTOR, 1, 0, -1), F(rel_a_of_body, spin, VEC, AXIAL, 0, 0, -1)};
static int32_t rel_do_kick(dem_world *w, void *at) {
    rel_a_of_body *a = (rel_a_of_body *)at;
    dem_selection s = DEM_SELECTION;
    s.count = 1;
    s.bodies = &a->body;
    return dem_bodies_velocity_set(w, &s, a->velocity, a->spin) == 1;
}
static const rel_field rel_f_rail[] = {
    F(rel_a_of_body, body, BODY, SCALAR, 0, 0, 0), F(rel_a_of_body, d.axes, INT, AXES, 0, 0, 0),
    F(rel_a_of_body, d.velocity, VEC, VECTOR, 1, 0, -1), F(rel_a_of_body, d.spin, VEC, AXIAL, 0, 0, -1),
    FREF(rel_a_of_body, d.wall)
};
static int32_t rel_do_rail(dem_world *w, void *at) {
    rel_a_of_body *a = (rel_a_of_body *)at;
    return dem_body_rail_set(w, a->body, &a->d) == DEM_OK;
}
/* ---- walls ---- */
typedef struct rel_a_wall {
    dem_material material;
    dem_vec3 point, normal, axis, to;
    dem_real radius, radius_to, share;
    int inside, rule;
    rel_reals vertices, radii, heights;
    rel_ints triangles;
    dem_sieve_desc d;
} rel_a_wall;
#define FW(name, type, nature, l, m, t) F(rel_a_wall, name, type, nature, l, m, t)
static const rel_field rel_f_plane[] = {FREF(rel_a_wall, material), FW(point, VEC, POINT, 1, 0, 0),
                                        FW(normal, VEC, VECTOR, 0, 0, 0)};
static int32_t rel_do_plane(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return dem_wall_plane_add(w, a->material, a->point, a->normal).id;
}
static const rel_field rel_f_cylinder[] = {FREF(rel_a_wall, material), FW(point, VEC, POINT, 1, 0, 0),
    FW(axis, VEC, VECTOR, 0, 0, 0), FW(radius, REAL, SCALAR, 1, 0, 0), FI(rel_a_wall, inside)};
static int32_t rel_do_cylinder(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return dem_wall_cylinder_add(w, a->material, a->point, a->axis, a->radius, a->inside).id;
}
static const rel_field rel_f_revolved[] = {FREF(rel_a_wall, material), FW(point, VEC, POINT, 1, 0, 0),
    FW(axis, VEC, VECTOR, 0, 0, 0), FW(radii, REALS, SCALAR, 1, 0, 0), FW(heights, REALS, SCALAR, 1, 0, 0)};
static int32_t rel_do_revolved(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return dem_wall_revolved_add(w, a->material, a->point, a->axis, a->radii.count, a->radii.at, a->heights.at).id;
}
static const rel_field rel_f_cone[] = {FREF(rel_a_wall, material), FW(point, VEC, POINT, 1, 0, 0),
    FW(to, VEC, POINT, 1, 0, 0), FW(radius, REAL, SCALAR, 1, 0, 0), FW(radius_to, REAL, SCALAR, 1, 0, 0)};
static int32_t rel_do_cone(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return dem_wall_cone_add(w, a->material, a->point, a->to, a->radius, a->radius_to).id;
}
static const rel_field rel_f_mesh[] = {FREF(rel_a_wall, material), FW(vertices, REALS, POINT, 1, 0, 0),
                                       FW(triangles, INTS, SCALAR, 0, 0, 0)};
static int32_t rel_do_mesh(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    dem_mesh mesh;
    mesh.vertex_count = a->vertices.count/3;
    mesh.triangle_count = a->triangles.count/3;
    mesh.vertices = a->vertices.at;
    mesh.triangles = a->triangles.at;
    return dem_wall_mesh_add(w, a->material, &mesh).id;
}
static const rel_field rel_f_profile[] = {FREF(rel_a_wall, material), FW(vertices, REALS, POINT_2, 1, 0, 0),
                                          FW(triangles, INTS, SCALAR, 0, 0, 0), FI(rel_a_wall, rule)};
static int32_t rel_do_profile(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    dem_profile p;
    p.vertex_count = a->vertices.count/2;
    p.segment_count = a->triangles.count/2;
    p.vertices = a->vertices.at;
    p.segments = a->triangles.at;
    return dem_wall_profile_add(w, a->material, &p, (dem_edge_rule)a->rule).id;
}
static const rel_field rel_f_grains[] = {FREF(rel_a_wall, material), FW(vertices, REALS, POINT, 1, 0, 0),
                                         FW(radius, REAL, SCALAR, 1, 0, 0), FN(rel_a_wall, share)};
static const rel_a_wall rel_wall_0 = {{0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 0}, 0, 0, 1, 1, 0, {0, 0}, {0, 0},
                                      {0, 0}, {0, 0}};          /* d: DEM_ZERO */
static int32_t rel_do_grains(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return dem_wall_grains_add(w, a->material, a->vertices.count/3, a->vertices.at, a->radius, a->share).id;
}
static const rel_field rel_f_sieve[] = {
    FREF(rel_a_wall, material), FI(rel_a_wall, d.kind), FW(d.point, VEC, POINT, 1, 0, 0),
    FW(d.normal, VEC, VECTOR, 0, 0, 0), FW(d.along, VEC, VECTOR, 0, 0, 0), FW(d.aperture, REAL, SCALAR, 1, 0, 0),
    FW(d.bar, REAL, SCALAR, 1, 0, 0), FW(d.length, REAL, SCALAR, 1, 0, 0), FW(d.thickness, REAL, SCALAR, 1, 0, 0),
    FW(d.lift, REAL, SCALAR, 1, 0, 0), FI(rel_a_wall, d.staggered), FW(d.radius, REAL, SCALAR, 1, 0, 0),
    FI(rel_a_wall, d.model), FN(rel_a_wall, d.clearance)
};
static int32_t rel_do_sieve(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return dem_wall_sieve_add(w, a->material, &a->d).id;
}
typedef struct rel_a_motion {
    dem_wall wall;
    dem_vec3 velocity;
    dem_motion d;
    rel_reals times, places, turns, loads;
} rel_a_motion;
#define REL_MOTION_FIELDS \
    FREF(rel_a_motion, wall), FI(rel_a_motion, d.kind), F(rel_a_motion, d.velocity, VEC, VECTOR, 1, 0, -1), \
    F(rel_a_motion, d.point, VEC, POINT, 1, 0, 0), F(rel_a_motion, d.axis, VEC, VECTOR, 0, 0, 0), \
    F(rel_a_motion, d.speed, REAL, FIXED, 0, 0, -1), F(rel_a_motion, d.amplitude, REAL, SCALAR, 1, 0, 0), \
    F(rel_a_motion, d.frequency, REAL, SCALAR, 0, 0, -1), FN(rel_a_motion, d.phase), \
    F(rel_a_motion, d.start, DOUBLE, SCALAR, 0, 0, 1), F(rel_a_motion, d.ramp, DOUBLE, SCALAR, 0, 0, 1), \
    F(rel_a_motion, d.load, REAL, SCALAR, 1, 1, -2), F(rel_a_motion, d.travel, REAL, SCALAR, 1, 0, 0), \
    F(rel_a_motion, d.function, CODE, FIXED, 0, 0, 0), F(rel_a_motion, d.user, DATA, FIXED, 0, 0, 0), \
    F(rel_a_motion, d.area, REAL, SCALAR, 2, 0, 0), FI(rel_a_motion, d.table_repeats)
static const rel_field rel_f_motion[] = {REL_MOTION_FIELDS};
static const rel_field rel_f_table[] = {
    REL_MOTION_FIELDS, F(rel_a_motion, times, REALS, SCALAR, 0, 0, 1), F(rel_a_motion, places, REALS, VECTOR, 1, 0, 0),
    F(rel_a_motion, turns, REALS, TURN, 0, 0, 0), F(rel_a_motion, loads, REALS, SCALAR, 1, 1, -2)
};
static const rel_a_motion rel_motion_0 = {{0}, {0, 0, 0}, DEM_ZERO, {0, 0}, {0, 0}, {0, 0}, {0, 0}};
static int32_t rel_do_motion(dem_world *w, void *at) {
    rel_a_motion *a = (rel_a_motion *)at;
    return dem_wall_motion_set(w, a->wall, &a->d) == DEM_OK;
}
static int32_t rel_do_table(dem_world *w, void *at) {
    rel_a_motion *a = (rel_a_motion *)at;
    dem_motion_row row[8];
    int k;
    memset(row, 0, sizeof row);
    for (k = 0; k < a->times.count && k < 8; k++) {
        const dem_real *x = a->places.at + 3*k, *q = a->turns.at + 4*k;
        row[k].time = (double)a->times.at[k];
        row[k].position = dem_vec3_make(x[0], x[1], x[2]);
        row[k].rotation = dem_quat_make(q[0], q[1], q[2], q[3]);
        row[k].load = a->loads.at[k];
    }
    a->d.table = row;
    a->d.table_count = k;
    return dem_wall_motion_set(w, a->wall, &a->d) == DEM_OK;
}
static const rel_field rel_f_belt[] = {FREF(rel_a_motion, wall), F(rel_a_motion, velocity, VEC, VECTOR, 1, 0, -1)};
static int32_t rel_do_belt(dem_world *w, void *at) {
    rel_a_motion *a = (rel_a_motion *)at;
    return dem_wall_surface_velocity_set(w, a->wall, a->velocity) == DEM_OK;
}
static const rel_field rel_f_wall_remove[] = {FREF(rel_a_motion, wall)};
static int32_t rel_do_wall_remove(dem_world *w, void *at) {
    return dem_wall_remove(w, ((rel_a_motion *)at)->wall) == DEM_OK;
}
/* ---- joints, feeds, outlets, the world later ---- */
typedef struct rel_a_joint { dem_joint_desc d; } rel_a_joint;
static const rel_field rel_f_joint[] = {
    FI(rel_a_joint, d.kind), FI(rel_a_joint, d.motor), F(rel_a_joint, d.a, BODY, SCALAR, 0, 0, 0),
    F(rel_a_joint, d.b, BODY, SCALAR, 0, 0, 0), FREF(rel_a_joint, d.wall), FI(rel_a_joint, d.collide),
    F(rel_a_joint, d.point, VEC, POINT, 1, 0, 0), F(rel_a_joint, d.axis, VEC, AXIAL, 0, 0, 0),
    F(rel_a_joint, d.speed, REAL, SCALAR, 0, 0, -1), F(rel_a_joint, d.torque, REAL, SCALAR, 2, 1, -2)
};
static int32_t rel_do_joint(dem_world *w, void *at) { return dem_joint_add(w, &((rel_a_joint *)at)->d).id; }
typedef struct rel_a_feed { dem_feed_desc d; dem_sizes sizes; } rel_a_feed;
#define REL_FEED_FIELDS \
    FREF(rel_a_feed, d.material), FI(rel_a_feed, d.class_count), F(rel_a_feed, d.radius, REAL_ARRAY, SCALAR, 1, 0, 0), \
    F(rel_a_feed, d.amount, DOUBLE_ARRAY, SCALAR, 0, 0, 0), FI(rel_a_feed, d.limited), \
    F(rel_a_feed, d.rate, DOUBLE, SCALAR, 0, 0, -1), F(rel_a_feed, d.start, DOUBLE, SCALAR, 0, 0, 1), \
    F(rel_a_feed, d.box, BOX, POINT, 1, 0, 0), FI(rel_a_feed, d.round), \
    F(rel_a_feed, d.velocity, VEC, VECTOR, 1, 0, -1), F(rel_a_feed, d.spread, REAL, SCALAR, 1, 0, -1), \
    F(rel_a_feed, d.shapes, REF_ARRAY, SCALAR, 0, 0, 0), F(rel_a_feed, d.materials, REF_ARRAY, SCALAR, 0, 0, 0), \
    FI(rel_a_feed, d.by_mass), F(rel_a_feed, d.end, DOUBLE, SCALAR, 0, 0, 1), \
    F(rel_a_feed, d.seed, WHOLE, SCALAR, 0, 0, 0), \
    F(rel_a_feed, d.inside, CODE, FIXED, 0, 0, 0), F(rel_a_feed, d.inside_user, DATA, FIXED, 0, 0, 0), \
    F(rel_a_feed, d.amount, DOUBLE_ARRAY, SCALAR, 0, 1, 0), \
    F(rel_a_feed, d.rate, DOUBLE, SCALAR, 0, 1, -1)    /* by mass */
static const rel_field rel_f_feed[] = {REL_FEED_FIELDS};
static const rel_field rel_f_feed_sizes[] = {
    REL_FEED_FIELDS, FI(rel_a_feed, sizes.kind), FI(rel_a_feed, sizes.by_count),
        F(rel_a_feed, sizes.min, REAL, SCALAR, 1, 0, 0),
    F(rel_a_feed, sizes.max, REAL, SCALAR, 1, 0, 0), F(rel_a_feed, sizes.median, REAL, SCALAR, 1, 0, 0),
    F(rel_a_feed, sizes.spread, DOUBLE, SCALAR, 0, 0, 0), F(rel_a_feed, sizes.scale, REAL, SCALAR, 1, 0, 0),
    F(rel_a_feed, sizes.modulus, DOUBLE, SCALAR, 0, 0, 0), F(rel_a_feed, sizes.deviation, REAL, SCALAR, 1, 0, 0),
    FI(rel_a_feed, sizes.count), F(rel_a_feed, sizes.radius, REAL_ARRAY, SCALAR, 1, 0, 0),
    F(rel_a_feed, sizes.passing, DOUBLE_ARRAY, SCALAR, 0, 0, 0)
};
static int32_t rel_do_feed(dem_world *w, void *at) { return dem_feed_add(w, &((rel_a_feed *)at)->d).id; }
static int32_t rel_do_feed_sizes(dem_world *w, void *at) {
    rel_a_feed *a = (rel_a_feed *)at;
    a->d.sizes[0] = &a->sizes;
    return dem_feed_add(w, &a->d).id;
}
typedef struct rel_a_outlet { dem_outlet_desc d; } rel_a_outlet;
static const rel_field rel_f_outlet[] = {
    FREF(rel_a_outlet, d.frame), F(rel_a_outlet, d.box, BOX, POINT, 1, 0, 0), FI(rel_a_outlet, d.keep),
    F(rel_a_outlet, d.residence_bin, DOUBLE, SCALAR, 0, 0, 1), FREF(rel_a_outlet, d.material),
    F(rel_a_outlet, d.beyond, REAL, SCALAR, 1, 0, 0), F(rel_a_outlet, d.wanted_min, REAL, SCALAR, 1, 0, 0),
    F(rel_a_outlet, d.wanted_max, REAL, SCALAR, 1, 0, 0), FI(rel_a_outlet, d.class_count),
    F(rel_a_outlet, d.radius, REAL_ARRAY, SCALAR, 1, 0, 0)
};
static int32_t rel_do_outlet(dem_world *w, void *at) { return dem_outlet_add(w, &((rel_a_outlet *)at)->d).id; }
typedef struct rel_a_field { dem_field_desc d; } rel_a_field;
static const rel_field rel_f_field[] = {
    F(rel_a_field, d.box, BOX, POINT, 1, 0, 0), F(rel_a_field, d.cells, INT3, PER_AXIS, 0, 0, 0),
    F(rel_a_field, d.interval, DOUBLE, SCALAR, 0, 0, 1), FI(rel_a_field, d.stress),
    F(rel_a_field, d.width, REAL, SCALAR, 1, 0, 0), FI(rel_a_field, d.variance),
        F(rel_a_field, d.start, DOUBLE, SCALAR, 0, 0, 1),
    F(rel_a_field, d.end, DOUBLE, SCALAR, 0, 0, 1), FREF(rel_a_field, d.material),
    F(rel_a_field, d.radius_min, REAL, SCALAR, 1, 0, 0), F(rel_a_field, d.radius_max, REAL, SCALAR, 1, 0, 0),
    FI(rel_a_field, d.group.id), FI(rel_a_field, d.bodies)
};
static int32_t rel_do_field(dem_world *w, void *at) { return dem_field_add(w, &((rel_a_field *)at)->d).id; }
typedef struct rel_a_later { dem_vec3 gravity; dem_real dt; dem_cell_desc d; } rel_a_later;
static const rel_field rel_f_gravity[] = {F(rel_a_later, gravity, VEC, VECTOR, 1, 0, -2)};
static int32_t rel_do_gravity(dem_world *w, void *at) {
    return dem_world_gravity_set(w, ((rel_a_later *)at)->gravity) == DEM_OK;
}
static const rel_field rel_f_cell[] = {
    F(rel_a_later, d.rate, VEC, PER_AXIS, 0, 0, -1), F(rel_a_later, d.shear, REAL, FIXED, 0, 0, -1),
    F(rel_a_later, d.stress, VEC, PER_AXIS, -1, 1, -2), F(rel_a_later, d.rate_most, VEC, PER_AXIS, 0, 0, -1)
};
static int32_t rel_do_cell(dem_world *w, void *at) { return dem_cell_set(w, &((rel_a_later *)at)->d) == DEM_OK; }

/* ---- selections of bodies ---- */
typedef struct rel_a_select { dem_selection d; dem_region region; dem_vec3 velocity, spin; int group; dem_real gap;
    } rel_a_select;
#define REL_SELECTION \
    FI(rel_a_select, d.group.id), FREF(rel_a_select, d.material), FREF(rel_a_select, d.shape), \
    F(rel_a_select, d.radius_min, REAL, SCALAR, 1, 0, 0), F(rel_a_select, d.radius_max, REAL, SCALAR, 1, 0, 0)
static const rel_field rel_f_push[] = {
    REL_SELECTION, F(rel_a_select, region.box, BOX, POINT, 1, 0, 0), FI(rel_a_select, region.cylinder),
    F(rel_a_select, region.inside, CODE, FIXED, 0, 0, 0), F(rel_a_select, region.user, DATA, FIXED, 0, 0, 0),
    F(rel_a_select, velocity, VEC, VECTOR, 1, 0, -1), F(rel_a_select, spin, VEC, AXIAL, 0, 0, -1)
};
static int32_t rel_do_push(dem_world *w, void *at) {
    rel_a_select *a = (rel_a_select *)at;
    a->d.region = &a->region;
    return dem_bodies_velocity_set(w, &a->d, a->velocity, a->spin) >= 0;
}
static const rel_field rel_f_group[] = {REL_SELECTION, FI(rel_a_select, group)};
static int32_t rel_do_group(dem_world *w, void *at) {
    rel_a_select *a = (rel_a_select *)at;
    dem_group group;
    group.id = a->group;
    return dem_bodies_group_set(w, &a->d, group, 1) >= 0;
}
static const rel_field rel_f_bonds[] = {F(rel_a_select, gap, REAL, SCALAR, 1, 0, 0)};
static int32_t rel_do_bonds(dem_world *w, void *at) {
    return dem_bonds_make(w, ((rel_a_select *)at)->gap, bond_make, w) >= 0;
}

static const rel_a_feed rel_feed_sizes_0 = {DEM_ZERO, DEM_ZERO};
static const rel_a_select rel_select_0 = {DEM_ZERO, DEM_ZERO, {0, 0, 0}, {0, 0, 0}, 1, 0};

#include "calls_services.h"
/* makes: the letter of the variable that holds its result in a printed program; 0: none. desc: type and name of the
   default of `d`. text: the call, where $name is a value. */
typedef struct rel_call {
    const char *name;
    const rel_field *fields;
    int field_count;
    size_t size;
    const void *defaults;
    int32_t (*call)(dem_world *w, void *arguments);
    const char *makes, *type, *desc, *zero, *text;
} rel_call;
enum { REL_WORLD, REL_MATERIAL, REL_PAIR, REL_ELLIPSOID, REL_CLUSTER, REL_POLYHEDRON, REL_POLYGON, REL_UNION,
    REL_A_BODY,
       REL_REMOVE, REL_RESIZE, REL_FIX, REL_KICK, REL_RAIL, REL_PLANE, REL_CYLINDER, REL_REVOLVED, REL_CONE, REL_MESH,
       REL_PROFILE, REL_GRAINS, REL_SIEVE, REL_MOTION, REL_BELT, REL_WALL_REMOVE, REL_JOINT, REL_FEED, REL_OUTLET,
       REL_FIELD, REL_GRAVITY, REL_CELL, REL_TABLE, REL_FEED_SIZES, REL_PUSH, REL_GROUP, REL_BONDS, REL_SERVICE_NAMES,
       REL_CALLS };
/* zero_at: null, or an A with the defaults; a compiler warns if it is of another type. */
#define C_(name, A, zero_at, makes, type, desc, zero, text) \
    {"dem_" #name, rel_f_##name, REL_N(rel_f_##name), sizeof(A) + 0*sizeof(1 ? (zero_at) : (const A *)0), zero_at, \
     rel_do_##name, makes, type, desc, zero, text}
static int32_t rel_do_world(dem_world *w, void *at) { (void)w; (void)at; return 1; }        /* run.h creates it */
static const rel_call rel_calls[REL_CALLS] = {
    C_(world, rel_a_world, 0, "", "", "dem_world_desc", "DEM_WORLD_DESC", "w = dem_world_create(&d)"),
    C_(material, rel_a_material, 0, "m", "dem_material", "dem_material_desc", "DEM_MATERIAL_DESC",
       "dem_material_add(w, &d)"),
    C_(pair, rel_a_pair, 0, "", "", "dem_pair", "{0}", "dem_pair_set(w, $a, $b, &d)"),
    C_(ellipsoid, rel_a_ellipsoid, 0, "s", "dem_shape", "", "", "dem_shape_ellipsoid_add(w, $axes)"),
    C_(cluster, rel_a_cluster, 0, "s", "dem_shape", "dem_cluster_desc", "DEM_CLUSTER_DESC",
        "dem_shape_cluster_add(w, &d)"),
    C_(polyhedron, rel_a_polyhedron, 0, "s", "dem_shape", "", "", "dem_shape_polyhedron_add(w, #points/3, $points)"),
    C_(polygon, rel_a_polygon, 0, "s", "dem_shape", "", "", "dem_shape_polygon_add(w, #corners/2, $corners)"),
    C_(union, rel_a_union, 0, "s", "dem_shape", "", "", "dem_shape_union_add(w, #positions/3, $shapes, $positions, "
        "$orientations)"),
    C_(body, rel_a_body, &rel_body_0, "b", "dem_body", "", "", ""),             /* print.h writes it */
    C_(remove, rel_a_of_body, 0, "", "", "", "", "dem_body_remove(w, $body)"),
    C_(resize, rel_a_of_body, 0, "", "", "", "", "dem_body_radius_set(w, $body, $radius)"),
    C_(fix, rel_a_of_body, 0, "", "", "", "", "fix(w, $body, $fixed)"),
    C_(kick, rel_a_of_body, 0, "", "", "", "", "kick(w, $body, $velocity, $spin)"),
    C_(rail, rel_a_of_body, 0, "", "", "dem_rail_desc", "DEM_RAIL_DESC", "dem_body_rail_set(w, $body, &d)"),
    C_(plane, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "", "dem_wall_plane_add(w, $material, $point, $normal)"),
    C_(cylinder, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "",
       "dem_wall_cylinder_add(w, $material, $point, $axis, $radius, $inside)"),
    C_(revolved, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "",
       "dem_wall_revolved_add(w, $material, $point, $axis, #radii, $radii, $heights)"),
    C_(cone, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "",
       "dem_wall_cone_add(w, $material, $point, $to, $radius, $radius_to)"),
    C_(mesh, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "",
       "mesh(w, $material, #vertices/3, $vertices, #triangles/3, $triangles)"),
    C_(profile, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "",
       "profile(w, $material, #vertices/2, $vertices, #triangles/2, $triangles, $rule)"),
    C_(grains, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "",
       "dem_wall_grains_add(w, $material, #vertices/3, $vertices, $radius, $share)"),
    C_(sieve, rel_a_wall, &rel_wall_0, "w", "dem_wall", "dem_sieve_desc", "DEM_SIEVE_DESC",
       "dem_wall_sieve_add(w, $material, &d)"),
    C_(motion, rel_a_motion, &rel_motion_0, "", "", "dem_motion", "DEM_MOTION", "dem_wall_motion_set(w, $wall, &d)"),
    C_(belt, rel_a_motion, &rel_motion_0, "", "", "", "", "dem_wall_surface_velocity_set(w, $wall, $velocity)"),
    C_(wall_remove, rel_a_motion, &rel_motion_0, "", "", "", "", "dem_wall_remove(w, $wall)"),
    C_(joint, rel_a_joint, 0, "j", "dem_joint", "dem_joint_desc", "DEM_JOINT_DESC",
        "dem_joint_add(w, &d)"),
    C_(feed, rel_a_feed, 0, "f", "dem_feed", "dem_feed_desc", "DEM_FEED_DESC", "dem_feed_add(w, &d)"),
    C_(outlet, rel_a_outlet, 0, "o", "dem_outlet", "dem_outlet_desc", "DEM_OUTLET_DESC",
       "dem_outlet_add(w, &d)"),
    C_(field, rel_a_field, 0, "g", "dem_field", "dem_field_desc", "DEM_FIELD_DESC",
        "dem_field_add(w, &d)"),
    C_(gravity, rel_a_later, 0, "", "", "", "", "dem_world_gravity_set(w, $gravity)"),
    C_(cell, rel_a_later, 0, "", "", "dem_cell_desc", "DEM_CELL_DESC", "dem_cell_set(w, &d)"),
    C_(table, rel_a_motion, &rel_motion_0, "", "", "dem_motion", "DEM_MOTION",
       "table(w, $wall, &d, #times, $times, $places, $turns, $loads)"),
    C_(feed_sizes, rel_a_feed, &rel_feed_sizes_0, "f", "dem_feed", "dem_sizes sizes = DEM_SIZES; dem_feed_desc",
        "DEM_FEED_DESC",
       "(d.sizes[0] = &sizes, dem_feed_add(w, &d))"),
    C_(push, rel_a_select, &rel_select_0, "", "", "dem_region region = DEM_REGION; dem_selection", "DEM_SELECTION",
       "d.region = &region; dem_bodies_velocity_set(w, &d, $velocity, $spin)"),
    C_(group, rel_a_select, &rel_select_0, "", "", "dem_selection", "DEM_SELECTION",
       "dem_bodies_group_set(w, &d, (dem_group){$group}, 1)"),
    C_(bonds, rel_a_select, &rel_select_0, "", "", "", "", "dem_bonds_make(w, $gap, bond_make, w)"),
    REL_SERVICE_CALLS
};

/* The field of a call by name, with or without "d.". */
static int rel_field_of(int call, const char *name) {
    const rel_call *c = &rel_calls[call];
    int i;
    for (i = 0; i < c->field_count; i++) {
        const char *own = c->fields[i].name;
        if (!strcmp(own, name) || (!strncmp(own, "d.", 2) && !strcmp(own + 2, name))) return i;
    }
    fprintf(stderr, "relations: %s has no field %s\n", c->name, name);
    exit(2);
}
#endif
