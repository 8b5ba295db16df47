/* calls_services.h - calls that write, read and measure: outputs, replays, events, groups, resets, numbers, readers. */
#ifndef REL_CALLS_SERVICES_H
#define REL_CALLS_SERVICES_H

/* ---- outputs ---- */
typedef struct rel_a_output { int kind; const char *path; double interval; dem_output output; dem_output_desc d;
    } rel_a_output;
static const rel_field rel_f_output[] = {
    FI(rel_a_output, d.kind), F(rel_a_output, d.path, PATH, FIXED, 0, 0, 0),
    F(rel_a_output, d.interval, DOUBLE, SCALAR, 0, 0, 1), F(rel_a_output, d.start, DOUBLE, SCALAR, 0, 0, 1),
    F(rel_a_output, d.end, DOUBLE, SCALAR, 0, 0, 1), FREF(rel_a_output, d.wall), FREF(rel_a_output, d.outlet),
    FREF(rel_a_output, d.field), F(rel_a_output, d.columns, TEXT, FIXED, 0, 0, 0),
    F(rel_a_output, d.values, CODE, FIXED, 0, 0, 0), F(rel_a_output, d.function, CODE, FIXED, 0, 0, 0),
    F(rel_a_output, d.mixing.box, BOX, POINT, 1, 0, 0), F(rel_a_output, d.mixing.cells, INT3, PER_AXIS, 0, 0, 0),
    FREF(rel_a_output, d.mixing.material), F(rel_a_output, d.mixing.radius_max, REAL, SCALAR, 1, 0, 0),
    F(rel_a_output, d.z0, REAL, FIXED, 1, 0, 0), F(rel_a_output, d.z1, REAL, FIXED, 1, 0, 0)
};
static int32_t rel_do_output(dem_world *w, void *at) { return dem_output_add(w, &((rel_a_output *)at)->d).id; }
static const rel_field rel_f_every[] = {FI(rel_a_output, kind), F(rel_a_output, path, PATH, FIXED, 0, 0, 0),
                                        F(rel_a_output, interval, DOUBLE, SCALAR, 0, 0, 1)};
static int32_t rel_do_every(dem_world *w, void *at) {
    rel_a_output *a = (rel_a_output *)at;
    return dem_output_every_add(w, (dem_output_kind)a->kind, a->path, a->interval).id;
}
static const rel_field rel_f_output_end[] = {FREF(rel_a_output, output)};
static int32_t rel_do_output_end(dem_world *w, void *at) {
    return dem_output_remove(w, ((rel_a_output *)at)->output) == DEM_OK;
}
/* ---- replays: run.h closes them, because a replay ends before its world ---- */
enum { REL_REPLAYS = 4 };
static dem_replay *rel_replays[REL_REPLAYS];
static void rel_close_replays(void) {
    int i;
    for (i = 0; i < REL_REPLAYS; i++) {
        if (rel_replays[i]) dem_replay_close(rel_replays[i]);
        rel_replays[i] = 0;
    }
}
typedef struct rel_a_replay { const char *path, *name; int32_t replay; double value; dem_replay_desc d; } rel_a_replay;
static const rel_field rel_f_replay[] = {
    F(rel_a_replay, path, PATH, FIXED, 0, 0, 0), F(rel_a_replay, d.title, TEXT, FIXED, 0, 0, 0),
    F(rel_a_replay, d.number_fn, CODE, FIXED, 0, 0, 0), F(rel_a_replay, d.resolution, REAL, SCALAR, 1, 0, 0),
    F(rel_a_replay, d.interval, DOUBLE, SCALAR, 0, 0, 1), FI(rel_a_replay, d.contacts)
};
static int32_t rel_do_replay(dem_world *w, void *at) {
    rel_a_replay *a = (rel_a_replay *)at;
    int i;
    for (i = 0; i < REL_REPLAYS && rel_replays[i]; i++) continue;
    if (i == REL_REPLAYS) return 0;
    rel_replays[i] = dem_replay_open(w, a->path, &a->d);
    return rel_replays[i] ? i + 1 : 0;
}
static const rel_field rel_f_frame[] = {FREF(rel_a_replay, replay), F(rel_a_replay, value, DOUBLE, SCALAR, 0, 0, 0)};
static int32_t rel_do_frame(dem_world *w, void *at) {
    rel_a_replay *a = (rel_a_replay *)at;
    dem_replay *r = a->replay ? rel_replays[a->replay - 1] : 0;
    (void)w;
    if (r && dem_replay_value_set(r, "a [m]", a->value) == DEM_OK) dem_replay_frame_write(r);
    return a->replay != 0;                     /* a replay ends with its world, or by a frame that cannot be written */
}
/* ---- events ---- */
typedef struct rel_a_events { int unused; dem_events_desc d; } rel_a_events;
static const rel_field rel_f_events[] = {F(rel_a_events, d.function, CODE, FIXED, 0, 0, 0), FI(rel_a_events, d.begins)};
static int32_t rel_do_events(dem_world *w, void *at) { return dem_events_record(w,
    &((rel_a_events *)at)->d) == DEM_OK; }
static const rel_field rel_f_events_stop[] = {FI(rel_a_events, unused)};
static int32_t rel_do_events_stop(dem_world *w, void *at) { (void)at; return dem_events_stop(w) == DEM_OK; }
/* ---- groups, resets, numbers ---- */
typedef struct rel_a_member { dem_body body; dem_wall wall; dem_field field; dem_outlet outlet; const char *name;
    int member;
                              rel_reals reals; } rel_a_member;
static const rel_field rel_f_member[] = {F(rel_a_member, body, BODY, SCALAR, 0, 0, 0),
                                        F(rel_a_member, name, TEXT, FIXED, 0, 0, 0), FI(rel_a_member, member)};
static const rel_a_member rel_member_0 = {{0, 0}, {0}, {0}, {0}, "coarse", 1, {0, 0}};
static int32_t rel_do_member(dem_world *w, void *at) {
    rel_a_member *a = (rel_a_member *)at;
    dem_selection s = DEM_SELECTION;
    s.count = 1;
    s.bodies = &a->body;
    return dem_bodies_group_set(w, &s, dem_group_get(w, a->name), a->member) >= 0;
}
static const rel_field rel_f_loads_reset[] = {FREF(rel_a_member, wall)};
static int32_t rel_do_loads_reset(dem_world *w, void *at) {
    return dem_wall_loads_reset(w, ((rel_a_member *)at)->wall) == DEM_OK;
}
static const rel_field rel_f_field_reset[] = {FREF(rel_a_member, field)};
static int32_t rel_do_field_reset(dem_world *w, void *at) {
    return dem_field_reset(w, ((rel_a_member *)at)->field) == DEM_OK;
}
static const rel_field rel_f_outlet_reset[] = {FREF(rel_a_member, outlet)};
static int32_t rel_do_outlet_reset(dem_world *w, void *at) {
    return dem_outlet_reset(w, ((rel_a_member *)at)->outlet) == DEM_OK;
}
static const rel_field rel_f_overlap_reset[] = {FI(rel_a_member, member)};
static int32_t rel_do_overlap_reset(dem_world *w, void *at) { (void)at; dem_overlap_max_reset(w); return 1; }
static const rel_field rel_f_reals[] = {F(rel_a_member, body, BODY, SCALAR, 0, 0, 0),
                                        F(rel_a_member, reals, REALS, SCALAR, 0, 0, 0)};
static int32_t rel_do_reals(dem_world *w, void *at) {
    rel_a_member *a = (rel_a_member *)at;
    return dem_body_reals_set(w, a->body, a->reals.at) == DEM_OK;
}
static const rel_field rel_f_wall_reals[] = {FREF(rel_a_member, wall), F(rel_a_member, reals, REALS, SCALAR, 0, 0, 0)};
static int32_t rel_do_wall_reals(dem_world *w, void *at) {
    rel_a_member *a = (rel_a_member *)at;
    return dem_wall_reals_set(w, a->wall, a->reals.at) == DEM_OK;
}
/* ---- what changes the scene and has no row elsewhere ---- */
typedef struct rel_a_change { dem_material material; dem_shape shape; dem_body body; dem_joint joint; int way,
    count, motor;
                              double temperature; dem_real radius, speed, torque, friction; dem_box box;
                              rel_reals positions; } rel_a_change;
/* way 0: equal spheres; 1: by sizes; 2: a packing */
static const rel_field rel_f_fill[] = {
    FREF(rel_a_change, material), FI(rel_a_change, way), FI(rel_a_change, count),
    F(rel_a_change, radius, REAL, SCALAR, 1, 0, 0), F(rel_a_change, box, BOX, POINT, 1, 0, 0)
};
static int32_t rel_do_fill(dem_world *w, void *at) {
    const rel_a_change *a = (const rel_a_change *)at;
    return fill(w, a->material, a->way, a->radius, a->box, a->count) >= 0;
}
static const rel_field rel_f_fill_shape[] = {FREF(rel_a_change, material), FREF(rel_a_change, shape),
    FI(rel_a_change, count),
                                             F(rel_a_change, box, BOX, POINT, 1, 0, 0)};
static int32_t rel_do_fill_shape(dem_world *w, void *at) {
    const rel_a_change *a = (const rel_a_change *)at;
    return dem_bodies_fill(w, a->material, a->shape, dem_region_make(a->box), a->count, 7) >= 0;
}
static const rel_field rel_f_spheres[] = {FREF(rel_a_change, material), F(rel_a_change, positions, REALS, POINT, 1,
    0, 0),
                                          F(rel_a_change, radius, REAL, SCALAR, 1, 0, 0)};
static int32_t rel_do_spheres(dem_world *w, void *at) {
    const rel_a_change *a = (const rel_a_change *)at;
    return dem_spheres_add(w, a->material, a->positions.count/3, a->positions.at, 0, 0, a->radius) == DEM_OK;
}
static const rel_field rel_f_temperature[] = {F(rel_a_change, temperature, DOUBLE, SCALAR, 2, 0, -2)};
static int32_t rel_do_temperature(dem_world *w, void *at) {
    return dem_temperature_set(w, ((rel_a_change *)at)->temperature, 0) == DEM_OK;
}
static const rel_field rel_f_remove_some[] = {F(rel_a_change, body, BODY, SCALAR, 0, 0, 0)};
static int32_t rel_do_remove_some(dem_world *w, void *at) {
    dem_selection s = DEM_SELECTION;
    s.count = 1;
    s.bodies = &((rel_a_change *)at)->body;
    return dem_bodies_remove(w, &s) >= 0;
}
static const rel_field rel_f_rub[] = {FREF(rel_a_change, material), FN(rel_a_change, friction)};
static int32_t rel_do_rub(dem_world *w, void *at) {
    const rel_a_change *a = (const rel_a_change *)at;
    return rub(w, a->material, a->friction) == DEM_OK;
}
static const rel_field rel_f_motor_set[] = {FREF(rel_a_change, joint), FI(rel_a_change, motor),
    F(rel_a_change, speed, REAL, SCALAR, 0, 0, -1), F(rel_a_change, torque, REAL, SCALAR, 2, 1, -2)};
static int32_t rel_do_motor_set(dem_world *w, void *at) {
    const rel_a_change *a = (const rel_a_change *)at;
    return dem_joint_motor_set(w, a->joint, (dem_motor)a->motor, a->speed, a->torque) == DEM_OK;
}
static const rel_field rel_f_joint_remove[] = {FREF(rel_a_change, joint)};
static int32_t rel_do_joint_remove(dem_world *w, void *at) {
    return dem_joint_remove(w, ((rel_a_change *)at)->joint) == DEM_OK;
}
/* ---- readers ---- */
typedef void (*rel_reader)(dem_world *w);
typedef struct rel_a_read { rel_reader what; } rel_a_read;
static const rel_field rel_f_read[] = {F(rel_a_read, what, CODE, FIXED, 0, 0, 0)};
static int32_t rel_do_read(dem_world *w, void *at) {
    const rel_reader what = ((rel_a_read *)at)->what;
    if (what) what(w);
    return 1;
}
/* ---- meshes and profiles that were files: relate_services.h puts them in place of REL_MESH and REL_PROFILE, whose
   fields they have. rule: by which function they are read. ---- */
static const rel_field rel_f_mesh_file[] = {FREF(rel_a_wall, material), FW(vertices, REALS, POINT, 1, 0, 0),
                                            FW(triangles, INTS, SCALAR, 0, 0, 0), FI(rel_a_wall, rule)};
static int32_t rel_do_mesh_file(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return mesh_file(w, a->material, a->vertices.count/3, a->vertices.at, a->triangles.count/3, a->triangles.at,
        a->rule).id;
}
static const rel_field rel_f_profile_file[] = {FREF(rel_a_wall, material), FW(vertices, REALS, FIXED, 1, 0, 0),
                                               FW(triangles, INTS, SCALAR, 0, 0, 0), FI(rel_a_wall, rule)};
static int32_t rel_do_profile_file(dem_world *w, void *at) {
    rel_a_wall *a = (rel_a_wall *)at;
    return profile_file(w, a->material, a->vertices.count/2, a->vertices.at, a->triangles.count/2, a->triangles.at,
        a->rule).id;
}

#define REL_SERVICE_NAMES REL_OUTPUT, REL_EVERY, REL_OUTPUT_END, REL_REPLAY, REL_FRAME, REL_EVENTS, REL_EVENTS_STOP, \
    REL_MEMBER, \
       REL_LOADS_RESET, REL_FIELD_RESET, REL_OUTLET_RESET, REL_OVERLAP_RESET, REL_REALS_SET, REL_WALL_REALS, REL_READ, \
       REL_MESH_FILE, REL_PROFILE_FILE, REL_FILL, REL_FILL_SHAPE, REL_SPHERES, REL_TEMPERATURE, REL_REMOVE_SOME, \
           REL_RUB, \
       REL_MOTOR_SET, REL_JOINT_REMOVE
#define REL_SERVICE_CALLS \
    C_(output, rel_a_output, 0, "o", "dem_output", "dem_output_desc", "DEM_OUTPUT_DESC", "dem_output_add(w, &d)"), \
    C_(every, rel_a_output, 0, "o", "dem_output", "", "", "dem_output_every_add(w, $kind, $path, $interval)"), \
    C_(output_end, rel_a_output, 0, "", "", "", "", "dem_output_remove(w, $output)"), \
    C_(replay, rel_a_replay, 0, "r", "dem_replay *", "dem_replay_desc", "DEM_REPLAY_DESC", \
        "dem_replay_open(w, $path, &d)"), \
    C_(frame, rel_a_replay, 0, "", "", "", "", \
        "dem_replay_value_set($replay, \"a [m]\", $value); dem_replay_frame_write($replay)"), \
    C_(events, rel_a_events, 0, "", "", "dem_events_desc", "DEM_EVENTS_DESC", "dem_events_record(w, &d)"), \
    C_(events_stop, rel_a_events, 0, "", "", "", "", "dem_events_stop(w)"), \
    C_(member, rel_a_member, &rel_member_0, "", "", "", "", "group(w, $body, $name, $member)"), \
    C_(loads_reset, rel_a_member, 0, "", "", "", "", "dem_wall_loads_reset(w, $wall)"), \
    C_(field_reset, rel_a_member, 0, "", "", "", "", "dem_field_reset(w, $field)"), \
    C_(outlet_reset, rel_a_member, 0, "", "", "", "", "dem_outlet_reset(w, $outlet)"), \
    C_(overlap_reset, rel_a_member, 0, "", "", "", "", "dem_overlap_max_reset(w)"), \
    C_(reals, rel_a_member, 0, "", "", "", "", "dem_body_reals_set(w, $body, $reals)"), \
    C_(wall_reals, rel_a_member, 0, "", "", "", "", "dem_wall_reals_set(w, $wall, $reals)"), \
    C_(read, rel_a_read, 0, "", "", "", "", "$what(w)"), \
    C_(mesh_file, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "", \
       "mesh_file(w, $material, #vertices/3, $vertices, #triangles/3, $triangles, $rule)"), \
    C_(profile_file, rel_a_wall, &rel_wall_0, "w", "dem_wall", "", "", \
       "profile_file(w, $material, #vertices/2, $vertices, #triangles/2, $triangles, $rule)"), \
    C_(fill, rel_a_change, 0, "", "", "", "", "fill(w, $material, $way, $radius, $box, $count)"), \
    C_(fill_shape, rel_a_change, 0, "", "", "", "", \
        "dem_bodies_fill(w, $material, $shape, dem_region_make($box), $count, 7)"), \
    C_(spheres, rel_a_change, 0, "", "", "", "", \
        "dem_spheres_add(w, $material, #positions/3, $positions, 0, 0, $radius)"), \
    C_(temperature, rel_a_change, 0, "", "", "", "", "dem_temperature_set(w, $temperature, 0)"), \
    C_(remove_some, rel_a_change, 0, "", "", "", "", "remove_some(w, $body)"), \
    C_(rub, rel_a_change, 0, "", "", "", "", "rub(w, $material, $friction)"), \
    C_(motor_set, rel_a_change, 0, "", "", "", "", "dem_joint_motor_set(w, $joint, $motor, $speed, $torque)"), \
    C_(joint_remove, rel_a_change, 0, "", "", "", "", "dem_joint_remove(w, $joint)")
#endif
