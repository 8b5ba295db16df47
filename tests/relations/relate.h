/* relate.h - the relations: what must hold between two runs of a scene, or of a scene and its image. Each returns
   REL_HOLDS, REL_BROKEN with a reason, or REL_SKIPPED if it says nothing about this scene.

   Relations of bits compare hashes. Relations of rounding compare positions, velocities and spins with the growth of
   a difference of 1e-13 radii in the same scene: a thousand times that is allowed, as long as it is below 1e-6 radii.
   Solvers of impulses stop at a tolerance, so two of their solutions differ by some of it. */
#ifndef REL_RELATE_H
#define REL_RELATE_H
#include "draw.h"

enum { REL_HOLDS, REL_BROKEN, REL_SKIPPED };
typedef struct rel_map { double m[3][3], det, to[3], drift[3], length, time, mass; int exact; } rel_map;
typedef struct rel_case {                      /* a scene, its run, and the run of its disturbed twin */
    const rel_scene *s;
    rel_run base, twin;
    int ran;                                   /* 1: without a refusal */
    int lists;                                 /* 1: the other run makes its lists at other steps */
    rel_rng rng;
    char why[600];
    /* what the relation that was checked last compared with what: program.h writes it down */
    const rel_scene *image;                    /* the other scene; 0: the same */
    rel_how how;                               /* how the other run is carried out */
    rel_map map;
    int other_ran, repeated, reversed, bad;    /* reversed: its bodies are; bad: the wrong call */
    double allowed[2];                         /* m and m/s */
} rel_case;
static const rel_map rel_same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1, {0, 0, 0}, {0, 0, 0}, 1, 1, 1, 0};

static int rel_broken(rel_case *c, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(c->why, sizeof c->why, format, list);
    va_end(list);
    return REL_BROKEN;
}
static int rel_has(const rel_case *c, const char *name) {
    int i;
    for (i = 0; i < REL_ROWS && strcmp(rel_features[i].name, name); i++) continue;
    if (i == REL_ROWS) { fprintf(stderr, "relations: no feature %s\n", name); exit(2); }
    return c->s->has[i];
}
static int rel_has_any(const rel_case *c, const char *const *names) {
    for (; *names; names++) if (rel_has(c, *names)) return 1;
    return 0;
}
static rel_set *rel_find(rel_op *op, const char *name) {
    const int f = rel_field_of(op->call, name);
    int i;
    for (i = 0; i < op->count; i++) if (op->set[i].field == f) return &op->set[i];
    return 0;
}
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
    rel_end(&other);
    return result;
}
static int rel_threads(rel_case *c) {
    rel_how how = {0};
    int n, result = REL_HOLDS;
    for (n = 2; n <= 3 && result == REL_HOLDS; n++) {
        how.threads = n;
        result = rel_bits(c, c->s, &how, n == 2 ? "2 threads" : "3 threads");
    }
    return result;
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
static int rel_restart_used(rel_case *c) {
    rel_how how = {0};
    how.checkpoint = 2;
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
            if (!rel_step(&other, &how, next - step)) { result = rel_broken(c, "after wrong call %d: %s", k, other.message); break; }
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
/* ---- rounding ---- */
/* Compares another run with the base, mapped. A step whose sweeps did not reach the tolerance has no solution that
   others could be compared with (dem_counters.unsolved). Outlets act whenever lists are made and every 64 steps
   (dem_outlet_desc), so a run that makes them at other steps is compared until a body has left. */
static int rel_compare(rel_case *c, const rel_run *other, const rel_map *map, const char *what) {
    double floor = 1e-9, R = 1e-3;
    int k, i, e, f;
    if (dem_counters_get(c->base.w).unsolved + dem_counters_get(other->w).unsolved) return REL_SKIPPED;
    if (rel_has(c, "impulses")) floor = 1e-4;
    c->map = *map;
    for (k = 0; k < c->base.marks && k < other->marks; k++) {
        const rel_mark *p = &c->base.mark[k], *q = &other->mark[k], *t = &c->twin.mark[k];
        const double time = p->step*(double)dem_counters_get(c->base.w).dt;
        double chaos = 0, speed = p->speed, tolerance;
        if (k >= c->twin.marks) return REL_HOLDS;
        if (c->lists && rel_has(c, "outlet") && (p->left || q->left)) return REL_HOLDS;
        for (i = 0; i < p->bodies; i++)
            for (e = 0; e < 3; e++)
                chaos = fmax(chaos, fmax(fabs(t->x[REL_PER_BODY*i + e] - p->x[REL_PER_BODY*i + e]),
                                         time*fabs(t->x[REL_PER_BODY*i + 3 + e] - p->x[REL_PER_BODY*i + 3 + e])));
        if (chaos > 1e-6*R) return REL_HOLDS;
        tolerance = 1e3*chaos + floor*R;
        c->allowed[0] = tolerance*map->length;
        c->allowed[1] = 1e3*tolerance/R*(speed + 1e-3);
        for (i = 0; i < p->bodies; i++) {
            const double *a = p->x + REL_PER_BODY*i, *b = q->x + REL_PER_BODY*i;
            for (e = 0; e < 3; e++) {
                double x = map->to[e] + map->drift[e]*time, v = map->drift[e];
                for (f = 0; f < 3; f++) {
                    x += map->m[e][f]*a[f]*map->length;
                    v += map->m[e][f]*a[3 + f]*map->length/map->time;
                }
                if (!(a[0] < 0 || a[0] > 0 || a[1] < 0 || a[1] > 0)) continue;      /* absent */
                if (!(fabs(b[e] - x) <= tolerance*map->length))
                    return rel_broken(c, "%s: at step %d body %d is off by %.3g m (allowed: %.3g m; %d contacts)", what, p->step, i,
                                      fabs(b[e] - x), tolerance, c->base.contacts + c->base.wall_contacts);
                if (!(fabs(b[3 + e] - v) <= c->allowed[1]))
                    return rel_broken(c, "%s: at step %d the velocity of body %d is off by %.3g m/s of %.3g m/s", what, p->step, i,
                                      fabs(b[3 + e] - v), speed);
            }
        }
    }
    return REL_HOLDS;
}
static int rel_near(rel_case *c, const rel_scene *s, const rel_how *how, const rel_map *map, const char *what) {
    static rel_run other;
    const int ran = rel_go(&other, s, how);
    int result;
    c->image = s;
    c->other_ran = ran;
    if (ran != c->ran && !(c->ran && other.failed == 1))
        result = rel_broken(c, "%s: %s", what, ran ? "runs, the base does not" : other.message);
    else result = rel_compare(c, &other, map, what);
    rel_end(&other);
    return result;
}
static rel_scene rel_image;
/* Sets a field of the world. */
static int rel_with(rel_case *c, const char *field, double value, const char *what) {
    const rel_how how = {0};
    rel_copy(&rel_image, c->s);
    rel_put(&rel_image.op[0], field, value);
    return rel_near(c, &rel_image, &how, &rel_same, what);
}
static int rel_search(rel_case *c) {
    static const int kinds[] = {DEM_SEARCH_ALL_PAIRS, DEM_SEARCH_GRID, DEM_SEARCH_LINKED_LIST, DEM_SEARCH_HIERARCHICAL,
                                DEM_SEARCH_BINS};
    if (!c->ran) return REL_SKIPPED;
    return rel_with(c, "search", kinds[rel_below(&c->rng, 5)], "another search");
}
static int rel_skin(rel_case *c) {
    static const double skins[] = {-1, 1e-5, 1e-4, 5e-4};
    int result;
    if (!c->ran) return REL_SKIPPED;
    c->lists = 1;
    result = rel_with(c, "skin", skins[rel_below(&c->rng, 4)], "another skin");
    c->lists = 0;
    return result;
}
static int rel_slabs(rel_case *c) {
    rel_how how = {0};
    rel_run other;
    int ran, result = REL_HOLDS;
    if (!c->ran) return REL_SKIPPED;
    how.slabs = 1 + rel_below(&c->rng, 3);
    ran = c->other_ran = rel_go(&other, c->s, &how);
    c->how = how;
    c->lists = 1;
    if (other.refused < 0) result = REL_SKIPPED;           /* by name: counted elsewhere */
    else if (!ran && !other.refused) result = rel_broken(c, "%d slabs: %s", how.slabs, other.message);
    else if (ran) result = rel_compare(c, &other, &rel_same, how.slabs == 1 ? "1 slab" : how.slabs == 2 ? "2 slabs" : "3 slabs");
    c->lists = 0;
    rel_end(&other);
    return result;
}
/* ---- images of the scene ---- */
static void rel_turn(const rel_map *m, const double *x, double *to, double sign) {
    double y[3];
    int i, k;
    for (i = 0; i < 3; i++) for (y[i] = 0, k = 0; k < 3; k++) y[i] += m->m[i][k]*x[k]*sign;
    memcpy(to, y, sizeof y);
}
/* The image of a scene under a map. */
static void rel_map_scene(rel_scene *to, const rel_scene *from, const rel_map *m) {
    int i, j, k, e;
    rel_copy(to, from);
    for (i = 0; i < to->count; i++) {
        rel_op *op = &to->op[i];
        for (j = 0; j < rel_calls[op->call].field_count; j++) {    /* points and directions left at defaults move, too */
            const rel_field *f = &rel_calls[op->call].fields[j];
            const char *defaults = (const char *)rel_calls[op->call].defaults;
            dem_vec3 x = {0, 0, 0};
            if (f->type != REL_VEC || (f->nature != REL_POINT && f->nature != REL_VECTOR && f->nature != REL_AXIAL) ||
                rel_find(op, f->name)) continue;
            if (defaults) memcpy(&x, defaults + f->at, sizeof x);
            if (f->nature == REL_POINT || fabs(x.x) + fabs(x.y) + fabs(x.z) > 0) rel_put3(op, f->name, x.x, x.y, x.z);
        }
        for (j = 0; j < op->count; j++) {
            rel_set *v = &op->set[j];
            const rel_field *f = &rel_calls[op->call].fields[v->field];
            const double unit = pow(m->length, f->length)*pow(m->mass, f->mass)*pow(m->time, f->time);
            const int list = f->type == REL_REALS, array = f->type == REL_REAL_ARRAY || f->type == REL_DOUBLE_ARRAY;
            double *x = v->v;
            if (f->type == REL_INT || f->type == REL_REF || f->type == REL_BODY || f->type == REL_INTS ||
                f->type == REL_REF_ARRAY || f->type == REL_CODE || f->type == REL_TEXT) continue;
            if (list || array) {
                x = to->pool + v->at;
                for (k = 0; k < v->count; k++) x[k] *= unit;
            } else for (k = 0; k < 6 && f->type != REL_INT3; k++) x[k] *= unit;
            if (op->call == REL_MOTION && !strcmp(f->name, "d.speed")) x[0] *= m->det;
            for (k = 0; k + 3 <= (list ? v->count : 3); k += 3) {
                if (f->nature == REL_POINT && f->type != REL_BOX) {
                    rel_turn(m, x + k, x + k, 1);
                    for (e = 0; e < 3; e++) x[k + e] += m->to[e];
                }
                if (f->nature == REL_VECTOR) rel_turn(m, x + k, x + k, 1);
                if (f->nature == REL_AXIAL) rel_turn(m, x + k, x + k, m->det);
                if (f->nature == REL_IN_BODY && m->det < 0) rel_turn(m, x + k, x + k, 1);
            }
            if (f->nature == REL_PER_AXIS) {
                double y[3];
                for (e = 0; e < 3; e++) for (y[e] = 0, k = 0; k < 3; k++) y[e] += fabs(m->m[e][k])*x[k];
                memcpy(x, y, sizeof y);
            }
            if (f->type == REL_BOX) {
                double lo[3], hi[3];
                rel_turn(m, x, lo, 1);
                rel_turn(m, x + 3, hi, 1);
                for (e = 0; e < 3; e++) {
                    x[e] = fmin(lo[e], hi[e]) + m->to[e];
                    x[3 + e] = fmax(lo[e], hi[e]) + m->to[e];
                }
            }
            if (f->nature == REL_ORIENTATION) {
                if (m->det < 0) rel_turn(m, x + 1, x + 1, -1);
                else {                          /* the rotation of the axes, then its own */
                    const double w = sqrt(fmax(0, 1 + m->m[0][0] + m->m[1][1] + m->m[2][2]))/2;
                    if (w > 0.1) {
                        const double a = (m->m[2][1] - m->m[1][2])/(4*w), b = (m->m[0][2] - m->m[2][0])/(4*w),
                                     d = (m->m[1][0] - m->m[0][1])/(4*w), q0 = x[0], q1 = x[1], q2 = x[2], q3 = x[3];
                        x[0] = w*q0 - a*q1 - b*q2 - d*q3;
                        x[1] = w*q1 + a*q0 + b*q3 - d*q2;
                        x[2] = w*q2 - a*q3 + b*q0 + d*q1;
                        x[3] = w*q3 + a*q2 - b*q1 + d*q0;
                    }
                }
            }
        }
    }
}
static int rel_code_flag(const rel_case *c, int turned) {
    int i, j;
    for (i = 0; i < c->s->count; i++)
        for (j = 0; j < c->s->op[i].count; j++)
            if (rel_calls[c->s->op[i].call].fields[c->s->op[i].set[j].field].type == REL_CODE) {
                const rel_code *code = &rel_codes[(int)c->s->op[i].set[j].v[0]];
                if (turned ? !code->turned : !code->scaled) return 1;
            }
    return 0;
}
static const char *const rel_not_turned[] = {"profile", "feed", "rail", "cell", "polygons", 0};
static int rel_image_near(rel_case *c, const rel_map *map, const char *what) {
    const rel_how how = {0};
    rel_map_scene(&rel_image, c->s, map);
    return rel_near(c, &rel_image, &how, map, what);
}
static int rel_rotated(rel_case *c) {
    rel_map m = rel_same;
    const int axis = rel_has(c, "planar") ? 2 : rel_below(&c->rng, 3), x = (axis + 1)%3, y = (axis + 2)%3;
    if (!c->ran || rel_has_any(c, rel_not_turned) || rel_code_flag(c, 1)) return REL_SKIPPED;
    m.m[x][x] = m.m[y][y] = 0;
    m.m[x][y] = -1;
    m.m[y][x] = 1;
    return rel_image_near(c, &m, axis == 0 ? "rotated about x" : axis == 1 ? "rotated about y" : "rotated about z");
}
static int rel_mirrored(rel_case *c) {
    rel_map m = rel_same;
    const int axis = rel_below(&c->rng, rel_has(c, "planar") ? 2 : 3);
    if (!c->ran || rel_has_any(c, rel_not_turned) || rel_code_flag(c, 1)) return REL_SKIPPED;
    m.m[axis][axis] = -1;
    m.det = -1;
    return rel_image_near(c, &m, axis == 0 ? "mirrored in x" : axis == 1 ? "mirrored in y" : "mirrored in z");
}
static int rel_translated(rel_case *c) {
    static const char *const without[] = {"profile", 0};
    rel_map m = rel_same;
    if (!c->ran || rel_has_any(c, without)) return REL_SKIPPED;
    m.to[0] = ldexp(1, -6);
    m.to[1] = -ldexp(1, -7);
    if (!rel_has(c, "planar")) m.to[2] = ldexp(1, -5);
    return rel_image_near(c, &m, "translated");
}
static int rel_galilei(rel_case *c) {
    static const char *const without[] = {"translating", "rotating", "oscillating", "user motion", "servo", "fixed body", "feed",
        "outlet", "rail", "force", "body force", "cell", "periodic", "periodic floor", "point joint", "hinge", "motor",
        "average", "wall removed", "kick", 0};
    const double V[3] = {0.125, -0.0625, rel_has(c, "planar") ? 0 : 0.25};
    const rel_how how = {0};
    rel_map m = rel_same;
    int i, k;
    if (!c->ran || rel_has_any(c, without)) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    for (i = 0; i < c->s->count; i++) {
        rel_op *op = &rel_image.op[i];
        if (op->call == REL_A_BODY) {
            rel_set *v = rel_find(op, "velocity");
            for (k = 0; k < 3; k++) v->v[k] += V[k];
        }
        if (rel_is_wall(op->call)) {
            rel_op *move = &rel_image.op[rel_image.count++];
            if (rel_image.count >= REL_OPS) return REL_SKIPPED;
            memset(move, 0, sizeof *move);
            move->call = REL_MOTION;
            rel_put(move, "wall", i);
            rel_put(move, "kind", DEM_MOTION_TRANSLATING);
            rel_put3(move, "velocity", V[0], V[1], V[2]);
        }
    }
    for (k = 0; k < 3; k++) m.drift[k] = V[k];
    return rel_near(c, &rel_image, &how, &m, "with a constant velocity");
}
static int rel_scaled(rel_case *c) {
    const rel_how how = {0};
    rel_map m = rel_same;
    rel_run other;
    int k, i, e, ran, result = REL_HOLDS;
    if (!c->ran || rel_code_flag(c, 0)) return REL_SKIPPED;
    if ((rel_has(c, "linear") || rel_has(c, "hysteretic") || rel_has(c, "own law")) && !rel_has(c, "stiffness"))
        return REL_SKIPPED;                    /* fifth roots */
    /* square, cube and fourth roots of these are exact */
    m.length = ldexp(1, 12*rel_below(&c->rng, 3) - 12);
    m.time = ldexp(1, 4*rel_below(&c->rng, 3) - 4);
    m.mass = ldexp(1, 4*rel_below(&c->rng, 5) - 8);
    rel_map_scene(&rel_image, c->s, &m);
    ran = c->other_ran = rel_go(&other, &rel_image, &how);
    c->image = &rel_image;
    c->map = m;
    if (!ran) result = rel_broken(c, "lengths times %g, masses times %g, times times %g: %s", m.length, m.mass, m.time, other.message);
    for (k = 0; k < other.marks && k < c->base.marks && result == REL_HOLDS; k++)
        for (i = 0; i < c->base.mark[k].bodies && result == REL_HOLDS; i++)
            for (e = 0; e < 9; e++) {          /* velocities that decay may underflow (DEMI_TINY) */
                const double unit = e < 3 ? m.length : e < 6 ? m.length/m.time : 1/m.time;
                const double a = c->base.mark[k].x[REL_PER_BODY*i + e]*unit, b = other.mark[k].x[REL_PER_BODY*i + e];
                if ((a < b || a > b) && fmax(fabs(a), fabs(b))/unit > 1e-100) {
                    result = rel_broken(c, "lengths times %g, masses times %g, times times %g: %s of body %d at step %d is %.17g, not %.17g",
                                        m.length, m.mass, m.time, e < 3 ? "the position" : e < 6 ? "the velocity" : "the spin", i,
                                        c->base.mark[k].step, b/unit, a/unit);
                    break;
                }
            }
    rel_end(&other);
    return result;
}
/* Exchanges the values of two ops of one kind, and all references to them. */
static void rel_exchange(rel_scene *s, int a, int b) {
    const rel_op op = s->op[a];
    int i, j;
    s->op[a] = s->op[b];
    s->op[b] = op;
    for (i = 0; i < s->count; i++)
        for (j = 0; j < s->op[i].count; j++) {
            rel_set *v = &s->op[i].set[j];
            const rel_type type = rel_calls[s->op[i].call].fields[v->field].type;
            if (type != REL_REF && type != REL_BODY) continue;
            if ((int)v->v[0] == a) v->v[0] = b;
            else if ((int)v->v[0] == b) v->v[0] = a;
        }
}
static int rel_order(rel_case *c, int walls) {
    const rel_how how = {0};
    rel_run other;
    int at[REL_OPS], n = 0, i, k, e, ran, result = REL_HOLDS;
    if (!c->ran || rel_has(c, "impulses") || rel_has(c, "feed")) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    for (i = 0; i < c->s->count && !(walls && (c->s->op[i].call == REL_MOTION || c->s->op[i].call == REL_BELT)); i++)
        if (walls ? rel_is_wall(c->s->op[i].call) && !c->s->op[i].step : c->s->op[i].call == REL_A_BODY) at[n++] = i;
    if (n < 2) return REL_SKIPPED;
    for (i = 0; i < n/2; i++) rel_exchange(&rel_image, at[i], at[n - 1 - i]);
    if (walls) return rel_near(c, &rel_image, &how, &rel_same, "walls in another order");
    ran = c->other_ran = rel_go(&other, &rel_image, &how);
    c->image = &rel_image;
    c->reversed = 1;
    if (!ran && !other.failed) result = rel_broken(c, "bodies in another order: %s", other.message);
    for (k = 0; k < other.marks; k++)          /* back into the order of the base */
        for (i = 0; i < n/2; i++)
            for (e = 0; e < REL_PER_BODY; e++) {
                double *x = other.mark[k].x, y = x[REL_PER_BODY*i + e];
                x[REL_PER_BODY*i + e] = x[REL_PER_BODY*(n - 1 - i) + e];
                x[REL_PER_BODY*(n - 1 - i) + e] = y;
            }
    if (result == REL_HOLDS) result = rel_compare(c, &other, &rel_same, "bodies in another order");
    rel_end(&other);
    return result;
}
static int rel_body_order(rel_case *c) { return rel_order(c, 0); }
static int rel_wall_order(rel_case *c) { return rel_order(c, 1); }
/* ---- walls divided otherwise ---- */
static int rel_cut(rel_case *c) {
    static double x[3*600], t[3*1600];
    const rel_how how = {0};
    rel_op *op;
    rel_set *v, *f;
    int i, k, e, n;
    for (i = 0; i < c->s->count && c->s->op[i].call != REL_MESH; i++) continue;
    if (!c->ran || i == c->s->count) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    op = &rel_image.op[i];
    v = rel_find(op, "vertices");
    f = rel_find(op, "triangles");
    n = v->count/3;
    if (n + f->count > 600 || rel_image.pool_count + 3*n + 7*f->count > REL_POOL) return REL_SKIPPED;
    memcpy(x, rel_image.pool + v->at, (size_t)v->count*sizeof *x);
    for (k = 0; k < f->count/3; k++) {
        const double *c3 = rel_image.pool + f->at + 3*k;
        int mid[3], a[3];
        for (e = 0; e < 3; e++) a[e] = (int)c3[e];
        for (e = 0; e < 3; e++) {
            int q;
            double p[3];
            for (q = 0; q < 3; q++) p[q] = (x[3*a[e] + q] + x[3*a[(e + 1)%3] + q])/2;
            for (q = 0; q < n && memcmp(x + 3*q, p, sizeof p); q++) continue;
            mid[e] = q;
            if (q == n) memcpy(x + 3*n++, p, sizeof p);
        }
        {
            const int four[12] = {a[0], mid[0], mid[2], mid[0], a[1], mid[1], mid[2], mid[1], a[2], mid[0], mid[1], mid[2]};
            for (e = 0; e < 12; e++) t[12*k + e] = four[e];
        }
    }
    k = f->count;
    v->at = rel_image.pool_count;
    v->count = 3*n;
    memcpy(rel_image.pool + v->at, x, (size_t)v->count*sizeof *x);
    f->at = v->at + v->count;
    f->count = 4*k;
    memcpy(rel_image.pool + f->at, t, (size_t)f->count*sizeof *t);
    rel_image.pool_count = f->at + f->count;
    return rel_near(c, &rel_image, &how, &rel_same, "each triangle cut into four");
}
static int rel_several(rel_case *c) {
    const rel_how how = {0};
    rel_op *op, *more;
    rel_set *f;
    int i, k, at, count = c->s->count;
    for (i = 0; i < count && c->s->op[i].call != REL_MESH; i++) continue;
    if (!c->ran || i == count) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    op = &rel_image.op[i];
    f = rel_find(op, "triangles");
    if (f->count < 6) return REL_SKIPPED;
    more = &rel_image.op[rel_image.count++];
    *more = *op;
    at = rel_image.count - 1;
    k = f->count/6*3;
    rel_find(more, "triangles")->at = f->at + k;
    rel_find(more, "triangles")->count = f->count - k;
    f->count = k;
    for (k = 0; k < count; k++) {              /* what moves the one moves the other */
        rel_set *wall;
        if (rel_image.op[k].call != REL_MOTION && rel_image.op[k].call != REL_BELT && rel_image.op[k].call != REL_WALL_REMOVE) continue;
        wall = rel_find(&rel_image.op[k], "wall");
        if (!wall || (int)wall->v[0] != i || rel_image.count >= REL_OPS) continue;
        rel_image.op[rel_image.count] = rel_image.op[k];
        rel_find(&rel_image.op[rel_image.count++], "wall")->v[0] = at;
    }
    return rel_near(c, &rel_image, &how, &rel_same, "a mesh as two walls");
}
/* ---- sums ---- */
static int rel_momentum(rel_case *c) {
    static const char *const without[] = {"gravity", "tilted gravity", "gravity later", "force", "body force", "fixed body", "rail",
        "feed", "outlet", "removal", "kick", "cell", "servo", "growth", "new radius", "point joint", "hinge", "motor", 0};
    int k, e;
    double all = 0;
    if (!c->ran || rel_has_any(c, without) || rel_walls(c->s) || !c->base.contacts) return REL_SKIPPED;
    for (e = 0; e < 3; e++) all = fmax(all, fabs(c->base.mark[0].momentum[e]));
    for (k = 1; k < c->base.marks; k++)
        for (e = 0; e < 3; e++)
            if (fabs(c->base.mark[k].momentum[e] - c->base.mark[0].momentum[e]) > 1e-11*(all + 1e-6))
                return rel_broken(c, "momentum changes by %.3g of %.3g kg m/s", c->base.mark[k].momentum[e] - c->base.mark[0].momentum[e], all);
    return REL_HOLDS;
}
static int rel_counted(rel_case *c) {
    const dem_body_counts n = c->base.counts;
    if (!c->ran) return REL_SKIPPED;
    if (n.inserted != n.present + n.removed + n.left)
        return rel_broken(c, "%d inserted, %d present, %d removed, %d left", (int)n.inserted, (int)n.present, (int)n.removed, (int)n.left);
    return REL_HOLDS;
}
static int rel_energy(rel_case *c) {
    const rel_how with = {0, 0, 0, 0, 1, 0, 0};
    rel_run other;
    int result = REL_HOLDS;
    double stored, limit;
    if (!c->ran || rel_has(c, "forward Euler")) return REL_SKIPPED;
    if (rel_go(&other, c->s, &with)) {
        const dem_ledger *l = &other.ledger;
        stored = l->kinetic + l->rotational + l->elastic;
        limit = 0.05*(stored + l->throughput + fabs(l->normal) + fabs(l->slide) + fabs(l->tangent) + fabs(l->rolling));
        if (!(fabs(l->residual) <= limit))
            result = rel_broken(c, "the ledger's residual is %.3g J of %.3g J supplied, %.3g J stored", l->residual, l->throughput, stored);
    }
    rel_end(&other);
    return result;
}

typedef struct rel_relation { const char *name, *promise; int (*check)(rel_case *c); } rel_relation;
static const rel_relation rel_relations[] = {
    {"threads", "same bits", rel_threads}, {"pieces", "same bits", rel_pieces}, {"restart", "same bits", rel_restart},
    {"restart in a used world", "same bits", rel_restart_used}, {"with a ledger", "same motion, bit by bit", rel_ledger_same},
    {"refused memory", "same bits after the call is repeated", rel_memory_refused},
    {"refused call", "hash and later bits unchanged", rel_refusal},
    {"slabs", "rounding", rel_slabs}, {"search", "rounding", rel_search}, {"skin", "rounding", rel_skin},
    {"rotation by 90 degrees", "rounding", rel_rotated}, {"mirror", "rounding", rel_mirrored},
    {"translation", "rounding", rel_translated}, {"Galilei", "rounding", rel_galilei},
    {"units", "same bits", rel_scaled}, {"order of bodies", "rounding", rel_body_order},
    {"order of walls", "rounding", rel_wall_order}, {"triangles cut", "rounding", rel_cut},
    {"mesh in two walls", "rounding", rel_several}, {"momentum", "1e-11", rel_momentum},
    {"counts", "exact", rel_counted}, {"ledger closes", "5 %", rel_energy}
};
enum { REL_RELATIONS = (int)(sizeof rel_relations/sizeof *rel_relations) };
/* The rows that program.h writes in a way of their own. */
enum { REL_IS_THREADS, REL_IS_PIECES, REL_IS_RESTART, REL_IS_USED, REL_IS_LEDGER, REL_IS_MEMORY, REL_IS_REFUSED, REL_IS_SLABS,
       REL_IS_UNITS = 14, REL_IS_MOMENTUM = 19, REL_IS_COUNTS, REL_IS_CLOSED };
/* Checks one relation. Its random choices follow from the seed of the scene, whichever were checked before. */
static int rel_judge(rel_case *c, int relation) {
    c->rng.s = c->s->seed ^ 0x5bd1e995u;
    *c->why = 0;
    c->image = 0;
    memset(&c->how, 0, sizeof c->how);
    c->map = rel_same;
    c->other_ran = c->ran;
    c->repeated = c->reversed = c->bad = 0;
    c->allowed[0] = c->allowed[1] = 0;
    return rel_relations[relation].check(c);
}

/* Runs the base and its disturbed twin, with the time step that dem.h chose made explicit. `s` is changed so. */
static int rel_open_case(rel_case *c, rel_scene *s) {
    static rel_scene disturbed;
    const rel_how how = {0};
    int i;
    c->s = s;
    c->rng.s = s->seed ^ 0x5bd1e995u;
    c->lists = 0;
    *c->why = 0;
    c->ran = rel_go(&c->base, s, &how);
    if (!c->base.w || c->base.refused) return 0;
    if (!rel_find(&s->op[0], "dt")) {          /* as it was chosen */
        rel_put(&s->op[0], "dt", (double)dem_counters_get(c->base.w).dt);
        rel_end(&c->base);
        c->ran = rel_go(&c->base, s, &how);
        if (!c->base.w || c->base.refused) return 0;
    }
    rel_copy(&disturbed, s);
    for (i = 0; i < s->count; i++)
        if (s->op[i].call == REL_A_BODY) {
            rel_set *x = rel_find(&disturbed.op[i], "position");
            x->v[0] += i%2 ? 1e-16 : -1e-16;
            x->v[1] += i%3 ? 1e-16 : -1e-16;
        }
    rel_go(&c->twin, &disturbed, &how);
    return 1;
}
static void rel_close_case(rel_case *c) { rel_end(&c->base); rel_end(&c->twin); }
#endif
