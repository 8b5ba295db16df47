/* ---------------------------------------------------------------------------------------------
   >>joints
   Joints: permanent constraints between two bodies, or between a body and a wall or space. A joint
   is up to six rows of a linear system: three for the relative velocity at the common point, two
   more for the spin of a hinge across its axis, and one for a motor. J u is the velocity of a
   relative to b in these rows. All joints are solved simultaneously,
       [ M  -J'  ] [ dv ]   [  0 ]
       [ -J -give] [ dp ] = [ -r ]   (M: mass and inertia; r: residual velocity of the rows)
   by block LDL' factorisation with minimum-degree ordering. A tree is eliminated from its leaves to
   its root in O(n) without fill-in [BAR96]; loops cause a little fill-in. `give` is a small
   softness that regularises the system: 1e-9 of the inverse effective mass of a row (1e-6 in single
   precision), and 1e-6 in groups with loops, whose rows may be redundant (DEMI_GIVE).
   r is the distance between the points, and between the axes, at the next contact detection (in the
   middle of the next step, see demi_ahead), divided by dt. It is predicted with the rotations that
   the integrator will make. This is SHAKE, solved by a few Newton iterations. Its energy oscillates
   with an amplitude of O(dt^2).
   Energy guard: the impulses p of a group of connected joints do the work
   p (J u before + J u after)/2, exactly. If this exceeds the energy that the group has absorbed
   before (remembered up to 1e-3 of its kinetic energy), the target of its rows becomes
   J u after = -q dt/2, with the acceleration q of a relative to b in the rows without forces, and
   if necessary -J u before, which does no work whatever contacts, motors and fields do. With the
   first, J u before = q dt/2, the work is O(dt^4), forces are smooth, and the gap is q dt^2/4.
   Displacements that leave velocities unchanged close it as soon as the energy covers them.
   A motor with a torque limit is a row until it reaches the limit, and then a given torque.
   Owns w->joints; the system and its solution are in >>joints-solved. Tests:
   tests/impulse/test_joints.c.
   --------------------------------------------------------------------------------------------- */

/* Kinds of joints, in the order of dem_joint_kind: the number of their rows in the system, without
   that of a motor. 3 rows hold the point, 5 the axis too, 6 all rotation. Kinds with 5 rows have an
   axis and motors. >>add-joint: a constant there and a number here. */
static const int demi_joint_kinds[] = {
    0,                             /* DEM_JOINT_NONE */
    3,                             /* DEM_JOINT_POINT */
    5,                             /* DEM_JOINT_REVOLUTE */
};
enum { DEMI_JOINT_KINDS = sizeof demi_joint_kinds/sizeof *demi_joint_kinds };
/* Returns the number of rows of a kind; 0 if there is no such kind. */
static int demi_joint_rows(dem_joint_kind kind) {
    return (int)kind > 0 && (int)kind < DEMI_JOINT_KINDS ? demi_joint_kinds[kind] : 0;
}
/* True if both bodies of a joint, or its body and its wall, still exist. */
static int demi_joint_alive(const dem_world *w, const demi_joint *j) {
    if (demi_body_find(w, j->desc.a) < 0) return 0;
    if (j->desc.b.slot) return demi_body_find(w, j->desc.b) >= 0;
    return !j->desc.wall.id || demi_wall_there(w, j->desc.wall);
}
/* Returns the number of joints whose bodies and walls still exist. */
static int demi_joints_in_force(const dem_world *w) {
    int i, n = 0;
    for (i = 0; i < w->joint_count; i++) n += demi_joint_alive(w, w->joints + i);
    return n;
}
/* Returns the index of a joint, or -1 with an error message. Ids ascend and are never used again,
   so w->joints is sorted by id. */
static int demi_joint_find(dem_world *w, const char *call, dem_joint joint) {
    int low = 0, high = w->joint_count;
    while (low < high) {
        const int mid = low + (high - low)/2;
        if (w->joints[mid].id < joint.id) low = mid + 1;
        else high = mid;
    }
    if (low < w->joint_count && w->joints[low].id == joint.id &&
        demi_joint_alive(w, w->joints + low)) return low;
    demi_refuse(w, call, "joint %d does not exist, there are %d; it, one of its bodies or its wall "
                "was removed, or adding it failed", (int)joint.id, demi_joints_in_force(w));
    return -1;
}
/* The limits of a motor are far beyond any machine and keep the squares of the resulting values
   finite. */
#define DEMI_MOTOR_MOST 1e12
#define DEMI_OF dem_joint_desc
static const demi_field_row demi_joint_fields[] = {
    DEMI_LIMITED(DEMI_OF, kind, 'i', DEMI_OVER, DEMI_JOINT_KINDS - 1, ""),
    DEMI_ROW_ENUM(DEMI_OF, motor, DEMI_FROM, 0, "none speed torque"), DEMI_ROW(DEMI_OF, a, 'i'),
    DEMI_ROW(DEMI_OF, b, 'i'), DEMI_ROW(DEMI_OF, wall, 'i'), DEMI_ROW(DEMI_OF, collide, 'i'),
    DEMI_LIMITED(DEMI_OF, point, 'v', DEMI_ANY, DEMI_FARTHEST, "m"), DEMI_ROW(DEMI_OF, axis, 'v'),
    DEMI_LIMITED(DEMI_OF, speed, 'r', DEMI_ANY, DEMI_MOTOR_MOST, "rad/s"),
    DEMI_LIMITED(DEMI_OF, torque, 'r', DEMI_ANY, DEMI_MOTOR_MOST, "N m"), DEMI_ROW_END};
#undef DEMI_OF
/* True if the numbers of a desc and its motor are allowed; 0 with an error message otherwise. */
static int demi_motor_sane(dem_world *w, const char *call, const dem_joint_desc *d) {
    if (demi_rows_check(w, call, demi_joint_fields, d, "",
                        "start from DEM_JOINT_DESC, in SI units")) return 0;
    if (d->motor == DEM_MOTOR_NONE || (demi_joint_rows(d->kind) == 5 &&
                                       !(d->motor == DEM_MOTOR_SPEED && d->torque < 0))) return 1;
    demi_refuse(w, call, "motor is %d, torque %g N m; only revolute joints have motors, and the "
                "limit on torque of DEM_MOTOR_SPEED must be >= 0 (0: no limit)", (int)d->motor,
                (double)d->torque);
    return 0;
}
/* Returns x in the frame of body `index`: a point, m, relative to its centre if `place` is 1, a
   direction if it is 0. */
static dem_vec3 demi_joint_from_body(const dem_world *w, int index, dem_vec3 x, int place) {
    const demi_periods p = demi_periods_of(w);
    if (place) x = demi_nearest(&p, demi_sub(x, demi_at(w->bodies.pos + 4*index)));
    return dem_quat_unrotate(demi_quat_at(w->bodies.orient + 4*index), x);
}
/* True if a desc is allowed; 0 with an error message otherwise. */
static int demi_joint_sane(dem_world *w, const char *call, const dem_joint_desc *d) {
    const dem_real size = demi_length(d->axis);
    const int hinged = demi_joint_rows(d->kind) == 5;
    int a, b = -1;
    if (!demi_response_is(w, DEMI_JOINTED)) {
        demi_refuse(w, call, "contacts of this world are springs, but joints need impulses; create "
                    "the world with desc.response = DEM_RESPONSE_IMPULSES");
        return 0;
    }
    if (!demi_motor_sane(w, call, d)) return 0;
    if (hinged && (!(size > 0) || !demi_finite(size))) {
        demi_refuse(w, call, "axis is (%g, %g, %g), must be finite and not 0 for a revolute joint",
                    (double)d->axis.x, (double)d->axis.y, (double)d->axis.z);
        return 0;
    }
    if (w->desc.planar && hinged && !(DEMI_ABS(d->axis.z) > DEM_R(0.9999)*size)) {
        demi_refuse(w, call, "axis is (%g, %g, %g), must be along z, because discs rotate about no "
                    "other axis", (double)d->axis.x, (double)d->axis.y, (double)d->axis.z);
        return 0;
    }
    a = demi_body_index(w, call, d->a);
    if (a < 0) return 0;
    if (d->b.slot && (b = demi_body_index(w, call, d->b)) < 0) return 0;
    if (!d->b.slot && d->wall.id && demi_wall_find(w, call, d->wall) < 0) return 0;
    if (!w->desc.orientations && (!demi_shape_of(w, a) || (b >= 0 && !demi_shape_of(w, b)))) {
        demi_refuse(w, call, "body %u is a sphere, and this world does not follow the orientations "
                    "of spheres; create the world with desc.orientations = 1",
                    (unsigned)(demi_shape_of(w, a) ? d->b.slot : d->a.slot));
        return 0;
    }
    if (a != b && w->bodies.inv_mass[a] + (b >= 0 ? w->bodies.inv_mass[b] : 0) > 0) return 1;
    demi_refuse(w, call, "a is body %u and b is body %u (0: none), but %s; a joint holds two "
                "different bodies, at least one of which can move", (unsigned)d->a.slot,
                (unsigned)d->b.slot, a == b ? "they are the same" : "neither can move");
    return 0;
}
DEM_API dem_joint dem_joint_add(dem_world *w, const dem_joint_desc *d) {
    demi_joint j;
    dem_joint id;
    if (demi_null(w, __func__, d, "desc")) return demi_no_joint;
    if (!demi_joint_sane(w, __func__, d)) return demi_no_joint;
    if (!demi_orient_begin(w) || !DEMI_GROW(w, w->joints, (size_t)w->joint_count + 1)) {
        demi_no_memory(w, __func__);
        return demi_no_joint;
    }
    memset(&j, 0, sizeof j);
    j.desc = *d;
    j.desc.axis = demi_joint_rows(d->kind) == 5 ? demi_unit(d->axis) : demi_v(0, 0, 0);
    if (d->b.slot) j.desc.wall.id = 0;          /* b is a body, so the wall is ignored */
    else j.desc.b.generation = 0;
    j.arm[0] = demi_joint_from_body(w, demi_body_index(w, __func__, d->a), d->point, 1);
    j.axis[0] = demi_joint_from_body(w, demi_body_index(w, __func__, d->a), j.desc.axis, 0);
    j.arm[1] = d->point;
    j.axis[1] = j.desc.axis;
    if (d->b.slot) {
        const int b = demi_body_index(w, __func__, d->b);
        j.arm[1] = demi_joint_from_body(w, b, d->point, 1);
        j.axis[1] = demi_joint_from_body(w, b, j.desc.axis, 0);
    } else if (d->wall.id) {
        const dem_pose *pose = &w->walls[demi_wall_place(d->wall)].pose;
        j.arm[1] = demi_unrotate(pose->rotation, demi_sub(d->point, pose->position));
        j.axis[1] = demi_unrotate(pose->rotation, j.desc.axis);
    }
    id.id = j.id = ++w->joint_last;
    w->joints[w->joint_count++] = j;
    demi_scene_changed(w);
    demi_built(w, __func__);
    return id;
}
DEM_API dem_result dem_joint_motor_set(dem_world *w, dem_joint joint, dem_motor motor,
                                       dem_real speed, dem_real torque) {
    dem_joint_desc d;
    int i;
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    i = demi_joint_find(w, __func__, joint);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    d = w->joints[i].desc;
    d.motor = motor;
    d.speed = speed;
    d.torque = torque;
    if (!demi_motor_sane(w, __func__, &d)) return DEM_ERROR_ARGUMENT;
    w->joints[i].desc = d;
    demi_scene_changed(w);
    return DEM_OK;
}
DEM_API dem_result dem_joint_get(const dem_world *w, dem_joint joint, dem_joint_state *state) {
    int i;
    if (demi_null_look(w, __func__, state, "state")) return DEM_ERROR_ARGUMENT;
    i = demi_joint_find((dem_world *)w, __func__, joint);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *state = w->joints[i].state;
    return DEM_OK;
}
DEM_API dem_result dem_joint_remove(dem_world *w, dem_joint joint) {
    int i;
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    i = demi_joint_find(w, __func__, joint);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    w->joint_count--;
    memmove(w->joints + i, w->joints + i + 1, (size_t)(w->joint_count - i)*sizeof *w->joints);
    demi_scene_changed(w);
    return DEM_OK;
}
/* --- joints in a checkpoint, see >>features. They are state and not scene, because they appear and
       disappear with bodies. --- */

static void demi_joints_visit(dem_world *w, demi_stream *s) {
    if (w->joint_count) demi_visit(s, w->joints, (size_t)w->joint_count*sizeof(demi_joint));
}
static int demi_joints_grow(dem_world *t) {
    return DEMI_GROW(t, t->joints, (size_t)t->joint_count);
}
/* Checks joints: kinds and walls must exist, and numbers must be finite. Bodies need no check: the
   id of a body that no longer exists names nothing. */
static int demi_joints_check(const demi_reader *r) {
    int i, k;
    for (i = 0; i < r->t->joint_count; i++) {
        const demi_joint *j = &r->t->joints[i];
        const dem_joint_state *o = &j->state;
        if (demi_rows_bad(r->w, demi_joint_fields, &j->desc, &k) || !r->t->bodies.orienting ||
            (j->desc.motor != DEM_MOTOR_NONE && demi_joint_rows(j->desc.kind) != 5) ||
            j->desc.wall.id < 0 || (j->desc.wall.id &&
             demi_wall_place(j->desc.wall) >= r->t->wall_count) ||
            j->id <= (i ? j[-1].id : 0) || j->id > r->t->joint_last ||
            !demi_finite_double(j->bank) || !demi_finite_double(j->held) ||
            !demi_finite(j->left) || !demi_finite(j->apart) ||
            !demi_place(j->arm[0]) || !demi_place(j->arm[1]) || !demi_finite3(j->axis[0]) ||
            !demi_finite3(j->axis[1]) || !demi_finite3(o->force) || !demi_finite3(o->torque) ||
            !demi_finite(o->power) || !demi_finite(o->motor_torque) ||
            !demi_finite_double(o->turned) || !demi_finite_double(o->work))
            return demi_lie(r, "joint", i);
    }
    return 1;
}
