/* relate_bits.h - relations of bits: two runs of a scene that must be the same, bit by bit. */
#ifndef REL_RELATE_BITS_H
#define REL_RELATE_BITS_H
#include "edit.h"
#include "relate_services.h"

/* ---- bits ---- */
static int rel_bits(rel_case *c, const rel_scene *s, const rel_how *how, const char *what) {
    static rel_run other;
    const int ran = rel_go(&other, s, how);
    int k, result = REL_HOLDS;
    c->how = *how;
    c->other_ran = ran;
    c->repeated = other.repeated;
    if (ran != c->ran)
        result = rel_broken(c, "%s: %s", what, ran ? "runs, the base does not" : other.message);
    for (k = 0; k < other.marks && k < c->base.marks && result == REL_HOLDS; k++)
        if (other.mark[k].hash != c->base.mark[k].hash)
            result = rel_broken(c, "%s: other bits at step %d", what, c->base.mark[k].step);
    if (result == REL_HOLDS && !c->unheard) result = rel_same_notes(c, &other, how, what);
    rel_end(&other);
    return result;
}
/* Compares one thread with those of `how`, in work groups of 16 bodies. */
static int rel_in_groups(rel_case *c, const rel_how *how) {
    static rel_scene groups;
    static rel_run one, more;
    const rel_how with_one = {0};
    int k, ran, other, result = REL_HOLDS;
    rel_copy(&groups, c->s);
    rel_put(&groups.op[0], "domain_bodies", 16);
    ran = rel_go(&one, &groups, &with_one);
    other = rel_go(&more, &groups, how);
    c->image = &groups;
    c->how = *how;
    c->other_ran = other;
    if (ran != other) result = rel_broken(c, "3 threads in groups of 16: %s", other ? one.message : more.message);
    for (k = 0; k < more.marks && k < one.marks && result == REL_HOLDS; k++)
        if (more.mark[k].hash != one.mark[k].hash)
            result = rel_broken(c, "3 threads in groups of 16: other bits at step %d", one.mark[k].step);
    rel_end(&one);
    rel_end(&more);
    return result;
}
static int rel_threads(rel_case *c) {
    rel_how how = {0};
    int result;
    how.threads = 2;
    result = rel_bits(c, c->s, &how, "2 threads");
    if (result != REL_HOLDS) return result;
    how.threads = 3;
    if (rel_has(c, "groups of 16")) return rel_bits(c, c->s, &how, "3 threads");
    return rel_in_groups(c, &how);
}
static int rel_pieces(rel_case *c) {
    rel_how how = {0};
    how.pieces = 2 + rel_below(&c->rng, 4);
    return rel_bits(c, c->s, &how, "in pieces");
}
static int rel_restart(rel_case *c) {
    rel_how how = {0};
    how.checkpoint = 1;
    return c->ran ? rel_bits(c, c->s, &how, "continued in a new world") : REL_SKIPPED;
}
/* What was written after the checkpoint stays: files of numbered frames that the continued run does not write again,
   because their output has ended. */
static int rel_restart_used(rel_case *c) {
    static const int ends[] = {REL_OUTPUT_END, -1};
    rel_how how = {0};
    how.checkpoint = 2;
    if (c->ran && rel_has(c, "output ended")) {
        rel_copy(&rel_own, c->s);
        rel_leave_calls(&rel_own, ends, 0);
        if (!rel_instead(c)) return REL_SKIPPED;
    }
    return c->ran ? rel_bits(c, c->s, &how, "continued in a used world") : REL_SKIPPED;
}
static int rel_ledger_same(rel_case *c) {
    rel_how how = {0};
    rel_run other;
    int k, ran, result = REL_HOLDS;
    if (!c->ran || rel_has(c, "ledger")) return REL_SKIPPED;
    how.ledger = 1;
    ran = c->other_ran = rel_go(&other, c->s, &how);
    if (!ran) result = rel_broken(c, "with the ledger: %s", other.message);
    for (k = 0; k < other.marks && k < c->base.marks && result == REL_HOLDS; k++)
        if (memcmp(other.mark[k].x, c->base.mark[k].x, (size_t)(REL_PER_BODY*c->base.mark[k].bodies)*sizeof(double)))
            result = rel_broken(c, "the ledger changes the motion by step %d", c->base.mark[k].step);
    rel_end(&other);
    return result;
}
static int rel_memory_refused(rel_case *c) {
    rel_how how = {0};
    rel_run other;
    int64_t all;
    if (!c->ran) return REL_SKIPPED;
    how.refuse = INT64_MAX;
    if (!rel_go(&other, c->s, &how)) { rel_end(&other); return REL_SKIPPED; }
    rel_end(&other);
    all = rel_allocations.count;
    how.refuse = 1 + (int64_t)(rel_next(&c->rng)%(uint64_t)all);
    return rel_bits(c, c->s, &how, "after a refused allocation");
}
/* Calls that must be refused. Each returns 1 if it was. */
static int rel_bad_call(dem_world *w, int k) {
    const dem_vec3 o = {0, 0, 0}, huge = {(dem_real)1e30, 0, 0};
    dem_material m = {1}, none = {77};
    dem_motion motion = DEM_MOTION;
    dem_wall wall = {999};
    dem_body body = {9999, 1};
    dem_body_state state;
    memset(&state, 0, sizeof state);
    switch (k) {
    case 0: return !dem_sphere_add(w, m, -1, o).slot;
    case 1: return !dem_sphere_add(w, none, (dem_real)1e-3, o).slot;
    case 2: return !dem_wall_plane_add(w, m, o, o).id;
    case 3: motion.kind = DEM_MOTION_ROTATING; return dem_wall_motion_set(w, wall, &motion) != DEM_OK;
    case 4: return dem_body_set(w, body, &state) != DEM_OK;
    case 5: return dem_world_dt_set(w, -1) != DEM_OK;
    case 6: return !dem_sphere_add(w, m, (dem_real)1e-3, huge).slot;
    case 7: return dem_world_gravity_set(w, dem_vec3_make((dem_real)NAN, 0, 0)) != DEM_OK;
    case 8: return dem_checkpoint_read(w, "build/tmp/there is no such file") != DEM_OK;
    case 9: return dem_shape_polyhedron_add(w, 0, 0).id == 0;
    default: return dem_body_remove(w, body) != DEM_OK;
    }
}
enum { REL_BAD = 11 };
static int rel_refusal(rel_case *c) {
    rel_run other;
    const rel_how how = {0};
    const int k = rel_below(&c->rng, REL_BAD);
    int result = REL_HOLDS;
    uint64_t before;
    if (!c->ran || c->base.marks < 1) return REL_SKIPPED;
    if (!rel_build(&other, c->s, &how)) { rel_end(&other); return REL_SKIPPED; }
    c->bad = k;
    before = dem_world_hash_get(other.w);
    if (!rel_bad_call(other.w, k)) result = rel_broken(c, "wrong call %d was carried out", k);
    else if (!*dem_world_error_get(other.w)) result = rel_broken(c, "wrong call %d left no message", k);
    else if (dem_world_hash_get(other.w) != before) result = rel_broken(c, "wrong call %d changed the world", k);
    else if (c->base.mark[0].step > 0) {
        int step = 0, next, i;
        while (step < c->base.mark[0].step && result == REL_HOLDS) {       /* up to the first mark */
            for (next = c->base.mark[0].step, i = 1; i < c->s->count; i++)
                if (c->s->op[i].step > step && c->s->op[i].step < next) next = c->s->op[i].step;
            if (!rel_step(&other, &how, next - step)) {
                result = rel_broken(c, "after wrong call %d: %s", k, other.message);
                break;
            }
            step = next;
            if (step < c->base.mark[0].step && !rel_calls_at(&other, 1, step)) break;
            rel_bad_call(other.w, k);
            dem_world_error_get(other.w);      /* unread, it stops the next step */
        }
        if (result == REL_HOLDS && dem_world_hash_get(other.w) != c->base.mark[0].hash)
            result = rel_broken(c, "wrong call %d, refused, changed later bits", k);
    }
    rel_end(&other);
    return result;
}
/* ---- strength 0 ---- */
/* An effect that is switched on with strength 0 changes no bit. Each row makes a scene without the effect (on: 0) or
   with it (1), and returns 0 if it does not suit the scene. */
typedef struct rel_zero { const char *name; int (*make)(const rel_case *c, rel_scene *s, int on); } rel_zero;
static void rel_leave_call(rel_scene *s, int call) {
    int list[2];
    list[0] = call;
    list[1] = -1;
    rel_leave_calls(s, list, 0);
}
static void rel_leave_feeds(rel_scene *s) {
    static const int feeds[] = {REL_FEED, REL_FEED_SIZES, -1};
    rel_leave_calls(s, feeds, 0);
}
static void rel_leave_field(rel_scene *s, int call, const char *name) {
    const char *list[2];
    list[0] = name;
    list[1] = 0;
    rel_leave_fields(s, call, list);
}
/* A field of the world. */
static int rel_zero_world(rel_scene *s, const char *name, double value, int on) {
    rel_leave_field(s, REL_WORLD, name);
    if (on) rel_put(&s->op[0], name, value);
    return 1;
}
static int rel_first(const rel_scene *s, int call) {
    int i;
    for (i = 0; i < s->count && s->op[i].call != call; i++) continue;
    return i < s->count ? i : -1;
}
static int rel_first_wall(const rel_scene *s) {
    int i;
    for (i = 0; i < s->count && !(rel_is_wall(s->op[i].call) && !s->op[i].step); i++) continue;
    return i < s->count ? i : -1;
}
/* Where a feed adds a grain into a force field, the field acts on it at once, so all forces are computed again. */
static int rel_zero_force(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    rel_leave_feeds(s);
    return rel_zero_world(s, "force", rel_code_of("no_force"), on);
}
/* Without friction spins stay as they are, although the torques of contacts have some round-off; a body force may bring
   torques, so spins are integrated then. Both scenes have friction. */
static int rel_zero_couple(const rel_case *c, rel_scene *s, int on) {
    int i;
    (void)c;
    rel_leave_field(s, REL_PAIR, "friction");
    for (i = 0; i < s->count; i++) {
        const rel_set *v = s->op[i].call == REL_MATERIAL ? rel_given_in(&s->op[i], "friction") : 0;
        if (s->op[i].call == REL_MATERIAL && (!v || !(v->v[0] > 0))) rel_put(&s->op[i], "friction", 0.3);
    }
    rel_leave_feeds(s);
    return rel_zero_world(s, "body_force", rel_code_of("no_couple"), on);
}
static int rel_zero_growth(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    return rel_zero_world(s, "growth", rel_code_of("no_growth"), on);
}
static int rel_zero_numbers(const rel_case *c, rel_scene *s, int on) {
    if (rel_has(c, "charge") || rel_has(c, "heat")) return 0;      /* laws that read them */
    rel_leave_field(s, REL_WORLD, "body_reals_fn");
    return rel_zero_world(s, "body_reals", 0, on);
}
static int rel_zero_followed(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    return rel_zero_world(s, "orientations", 1, on);
}
static int rel_zero_rolling(const rel_case *c, rel_scene *s, int law, int on) {
    rel_leave_field(s, REL_MATERIAL, "rolling_friction");
    rel_leave_field(s, REL_PAIR, "rolling_friction");
    return !rel_has(c, "impulses") && rel_zero_world(s, "rolling_law", law, on);
}
static int rel_zero_constant(const rel_case *c, rel_scene *s, int on) {
    return rel_zero_rolling(c, s, DEM_ROLLING_CONSTANT, on);
}
static int rel_zero_epsd(const rel_case *c, rel_scene *s, int on) {
    return rel_zero_rolling(c, s, DEM_ROLLING_EPSD, on);
}
/* Static friction that is not larger than friction. Pairs have the friction of their materials, because a pair of
   its own keeps the mixed friction_static, which must be >= its friction ("start from dem_pair_get and change only
   what differs", dem_pair_set), and for the same reason friction stays as it was set first. */
static int rel_zero_static(const rel_case *c, rel_scene *s, int on) {
    int i;
    (void)c;
    rel_leave_call(s, REL_RUB);
    rel_leave_field(s, REL_MATERIAL, "friction_static");
    rel_leave_field(s, REL_PAIR, "friction");
    for (i = 0; i < s->count && on; i++) {
        const rel_set *v = s->op[i].call == REL_MATERIAL ? rel_find(&s->op[i], "friction") : 0;
        if (v) rel_put(&s->op[i], "friction_static", v->v[0]);
    }
    return 1;
}
/* A field of the pair of the first material with itself. The other scene sets this pair to what it is, because
   dem_material_set does not mix pairs again that dem_pair_set has replaced. */
static int rel_zero_pair(rel_scene *s, const char *name, int on) {
    const int m = rel_first(s, REL_MATERIAL);
    rel_op *pair;
    rel_leave_field(s, REL_PAIR, name);
    if (m < 0) return 0;
    pair = rel_more(s, REL_PAIR, 0);
    rel_put(pair, "a", m);
    rel_put(pair, "b", m);
    if (on) rel_put(pair, name, 0);
    return 1;
}
static int rel_zero_cohesion(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    return rel_zero_pair(s, "cohesion", on);
}
static int rel_zero_compliance(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    return rel_zero_pair(s, "compliance", on);
}
static int rel_zero_spinning(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    return rel_zero_pair(s, "spinning_friction", on);
}
static int rel_zero_rail(const rel_case *c, rel_scene *s, int on) {
    const int b = rel_first(s, REL_A_BODY);
    rel_op *rail;
    rel_leave_call(s, REL_RAIL);
    rel_leave_call(s, REL_FIX);                /* a fixed body takes no rail */
    if (b < 0 || rel_has(c, "impulses")) return 0;
    if (!on) return 1;
    rail = rel_more(s, REL_RAIL, 0);
    rel_put(rail, "body", rel_first(s, REL_A_BODY));
    rel_put(rail, "d.axes", 0);
    rel_put3(rail, "d.velocity", 0.1, 0.2, 0);
    return 1;
}
/* A motion of speed 0. A body on the rail of a moving wall is placed by the pose of that wall, with its rounding. */
static rel_op *rel_zero_motion(rel_scene *s, int kind, int on) {
    rel_op *m;
    rel_leave_call(s, REL_RAIL);
    rel_leave_call(s, REL_MOTION);
    rel_leave_call(s, REL_TABLE);
    if (!on) return &s->op[0];
    m = rel_more(s, REL_MOTION, 0);
    rel_put(m, "wall", rel_first_wall(s));
    rel_put(m, "kind", kind);
    return m;
}
static int rel_zero_translating(const rel_case *c, rel_scene *s, int on) {
    (void)c;
    if (rel_first_wall(s) < 0) return 0;
    rel_zero_motion(s, DEM_MOTION_TRANSLATING, on);
    return 1;
}
static int rel_zero_rotating(const rel_case *c, rel_scene *s, int on) {
    rel_op *m;
    (void)c;
    if (rel_first_wall(s) < 0) return 0;
    m = rel_zero_motion(s, DEM_MOTION_ROTATING, on);
    if (on) rel_put3(m, "axis", 0, 0, 1);
    return 1;
}
static int rel_zero_belt(const rel_case *c, rel_scene *s, int on) {
    rel_op *b;
    (void)c;
    rel_leave_call(s, REL_BELT);
    if (rel_first_wall(s) < 0) return 0;
    if (!on) return 1;
    b = rel_more(s, REL_BELT, 0);
    rel_put(b, "wall", rel_first_wall(s));
    rel_put3(b, "velocity", 0, 0, 0);
    return 1;
}
/* A feed that begins after the end of the run, of grains as there are. */
static int rel_zero_feed(const rel_case *c, rel_scene *s, int on) {
    const int b = rel_first(s, REL_A_BODY), m = rel_first(s, REL_MATERIAL);
    const rel_set *radius = b < 0 ? 0 : rel_given_in(&s->op[b], "radius");
    rel_op *f;
    (void)c;
    rel_leave_feeds(s);
    if (!radius || m < 0 || rel_has(c, "cell")) return 0;
    if (!on) return 1;
    f = rel_more(s, REL_FEED, 0);
    rel_put(f, "material", m);
    rel_put(f, "class_count", 1);
    rel_slot(f, "radius");
    rel_slot(f, "amount");
    f->set[f->count - 2].at = s->pool_count;
    f->set[f->count - 1].at = s->pool_count + 1;
    f->set[f->count - 2].count = f->set[f->count - 1].count = 1;
    s->pool[s->pool_count++] = radius->v[0];
    s->pool[s->pool_count++] = 1;
    rel_put(f, "rate", 100);
    rel_put(f, "start", 1e6);
    if (rel_has(c, "planar")) rel_put_box(f, "box", -1e-3, 3e-3, -1e-3, 1e-3, 5e-3, 1e-3);
    else rel_put_box(f, "box", -1e-3, -1e-3, 3e-3, 1e-3, 1e-3, 5e-3);
    return 1;
}
static int rel_zero_average(const rel_case *c, rel_scene *s, int on) {
    rel_op *f;
    rel_leave_call(s, REL_FIELD);
    if (!on) return !rel_has(c, "cell");
    f = rel_more(s, REL_FIELD, 0);
    if (rel_has(c, "planar")) rel_put_box(f, "box", -5e-3, -5e-3, -1e-3, 5e-3, 5e-3, 1e-3);
    else rel_put_box(f, "box", -5e-3, -5e-3, 0, 5e-3, 5e-3, 5e-3);
    rel_put3(f, "cells", 2, 2, 1);
    rel_put(f, "interval", 1e-4);
    rel_put(f, "stress", 1);
    return !rel_has(c, "cell");
}
/* An outlet that only counts. */
static int rel_zero_outlet(const rel_case *c, rel_scene *s, int on) {
    rel_op *o;
    rel_leave_call(s, REL_OUTLET);
    if (!on) return !rel_has(c, "cell");
    o = rel_more(s, REL_OUTLET, 0);
    rel_put_box(o, "box", -5e-3, -5e-3, -1e-3, 5e-3, 5e-3, 5e-3);
    rel_put(o, "keep", 1);
    return !rel_has(c, "cell");
}
static int rel_zero_cell(const rel_case *c, rel_scene *s, int on) {
    static const char *const without[] = {"impulses", "point joint", "hinge", "motor", "rail", "feed", "outlet", 0};
    rel_leave_call(s, REL_CELL);
    if (!rel_has(c, "periodic") || rel_has_any(c, without)) return 0;
    if (on) rel_put3(rel_more(s, REL_CELL, 0), "rate", 0, 0, 0);
    return 1;
}
static int rel_zero_motor(const rel_case *c, rel_scene *s, int on) {
    int i, n = 0;
    (void)c;
    for (i = 0; i < s->count; i++) {
        const rel_set *kind = s->op[i].call == REL_JOINT ? rel_find(&s->op[i], "kind") : 0;
        if (!kind || (int)kind->v[0] != DEM_JOINT_REVOLUTE) continue;
        n++;
        rel_put(&s->op[i], "motor", on ? DEM_MOTOR_TORQUE : DEM_MOTOR_NONE);
        rel_put(&s->op[i], "speed", 0);
        rel_put(&s->op[i], "torque", 0);
    }
    return n > 0;
}
static const rel_zero rel_zeros[] = {
    {"force", rel_zero_force}, {"body force", rel_zero_couple}, {"growth", rel_zero_growth}, 
    {"numbers", rel_zero_numbers},
    {"orientations", rel_zero_followed}, {"constant rolling", rel_zero_constant}, {"EPSD rolling", rel_zero_epsd},
    {"static friction", rel_zero_static}, {"cohesion", rel_zero_cohesion}, {"compliance", rel_zero_compliance},
    {"spinning friction", rel_zero_spinning}, {"rail", rel_zero_rail}, {"translating", rel_zero_translating},
    {"rotating", rel_zero_rotating}, {"belt", rel_zero_belt}, {"feed", rel_zero_feed}, {"average", rel_zero_average},
    {"outlet", rel_zero_outlet}, {"cell", rel_zero_cell}, {"motor", rel_zero_motor}
};
enum { REL_ZEROS = (int)(sizeof rel_zeros/sizeof *rel_zeros) };
static rel_scene rel_zeroed;
/* One row that suits the scene: positions, velocities and spins have the same bits. Hashes contain what is switched
   on. */
/* By impulses a read of the contacts computes impulses once more than a step does (see "readers"); scenes are compared
   without. */
static int rel_strength_zero(rel_case *c) {
    static const int reads[] = {REL_READ, -1};
    static rel_run other;
    const rel_how how = {0};
    const char *name;
    int k, i, n, ran, result = REL_HOLDS, row = rel_below(&c->rng, REL_ZEROS);
    if (!c->ran) return REL_SKIPPED;
    for (n = 0; n < REL_ZEROS; n++, row = (row + 1)%REL_ZEROS) {
        rel_copy(&rel_own, c->s);
        if (rel_has(c, "impulses")) rel_leave_calls(&rel_own, reads, 0);
        if (rel_zeros[row].make(c, &rel_own, 0)) break;
    }
    if (n == REL_ZEROS) return REL_SKIPPED;
    name = rel_zeros[row].name;
    if (!rel_instead(c)) return REL_SKIPPED;
    rel_copy(&rel_zeroed, &rel_own);
    if (!rel_zeros[row].make(c, &rel_zeroed, 1)) return REL_SKIPPED;
    ran = c->other_ran = rel_go(&other, &rel_zeroed, &how);
    c->image = &rel_zeroed;
    if (!ran) result = rel_broken(c, "%s with strength 0: %s", name, other.message);
    for (k = 0; k < other.marks && k < c->base.marks && result == REL_HOLDS; k++)
        for (i = 0; i < c->base.mark[k].bodies && result == REL_HOLDS; i++)
            if (memcmp(other.mark[k].x + REL_PER_BODY*i, c->base.mark[k].x + REL_PER_BODY*i, 9*sizeof(double)))
                result = rel_broken(c, "%s with strength 0 changes the motion of body %d by step %d", name, i,
                                    c->base.mark[k].step);
    rel_end(&other);
    return result;
}
#endif
