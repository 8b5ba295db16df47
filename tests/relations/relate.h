/* relate.h - what relations are made of: a scene with its run and the run of a disturbed twin, copies of a scene in
   which something is left out, and comparisons. The relations are in relate_bits.h, relate_images.h and
   relate_physics.h, their table in relate_all.h. Each returns REL_HOLDS, REL_BROKEN with a reason, or REL_SKIPPED if
   it says nothing about this scene.

   Relations of bits compare hashes. Relations of rounding compare positions and velocities with the growth of a
   difference of 1e-13 radii in the same scene (rel_compare). A relation that does not hold for some calls leaves them
   out of a copy of the scene, and compares runs of the copy (rel_instead). */
#ifndef REL_RELATE_H
#define REL_RELATE_H
#include "draw.h"

enum { REL_HOLDS, REL_BROKEN, REL_SKIPPED, REL_KNOWN, REL_RESULTS };
typedef struct rel_map { double m[3][3], det, to[3], drift[3], length, time, mass; int exact; } rel_map;
typedef struct rel_case {                      /* a scene, its run, and the run of its disturbed twin */
    const rel_scene *s;
    rel_scene *given;                          /* s, or the scene that s is a copy of, with something left out */
    rel_run base, twin;
    rel_run contrary[3];                       /* of twins disturbed otherwise; only where a comparison fails */
    int doubted;                               /* 3: they run and count */
    int ran;                                   /* 1: without a refusal */
    int lists;                                 /* 1: the other run makes its lists at other steps */
    int unheard;                               /* 1: the other run notes more */
    rel_rng rng;
    char why[600];
    /* what the relation that was checked last compared with what: program.h writes it down */
    const rel_scene *image;                    /* the other scene; 0: the same */
    rel_how how;                               /* how the other run is carried out */
    rel_map map;
    int other_ran, repeated, reversed, bad;    /* reversed: its bodies are; bad: the wrong call */
    double allowed[2];                         /* m and m/s */
    double excess;                             /* what rel_compare found, in units of what is allowed */
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
/* The value of a field; 0: it has its default. */
static const rel_set *rel_given_in(const rel_op *op, const char *name) {
    const int f = rel_field_of(op->call, name);
    int i;
    for (i = 0; i < op->count && op->set[i].field != f; i++) continue;
    return i < op->count ? &op->set[i] : 0;
}
/* ---- rounding ---- */
/* Writes what the disturbance has caused by mark k, m and m/s: the largest of what it has caused in the twins
   that have run. Returns 0 if it has grown too large to compare. */
static int rel_calm(const rel_case *c, int k, double *chaos) {
    const rel_mark *p = &c->base.mark[k];
    const double R = 1e-3, time = p->step*(double)dem_counters_get(c->base.w).dt;
    int i, e, twin, unsolved = p->unsolved;
    chaos[0] = chaos[1] = 0;
    for (twin = 0; twin <= c->doubted; twin++) {
        const rel_run *run = twin ? &c->contrary[twin - 1] : &c->twin;
        const rel_mark *t = &run->mark[k];
        if (k >= run->marks) return 0;
        for (i = 0; i < p->bodies; i++)
            for (e = 0; e < 6; e++)
                chaos[e/3] = fmax(chaos[e/3], fabs(t->x[REL_PER_BODY*i + e] - p->x[REL_PER_BODY*i + e]));
        unsolved |= t->unsolved;
    }
    return !unsolved && chaos[0] <= 1e-6*R && time*chaos[1] <= 1e-6*R;
}
/* Runs a twin of the base, whose bodies are displaced by 1e-16 m along x and y, times `sign`, and z, times `up`, and
   rotated by 4e-16 rad, times `turn`. */
static void rel_twin(const rel_case *c, rel_run *twin, double sign, double up, double turn) {
    static rel_scene disturbed;
    const rel_how how = {0};
    int i, k;
    rel_copy(&disturbed, c->s);
    for (i = 0; i < c->s->count; i++)
        if (c->s->op[i].call == REL_A_BODY) {
            rel_set *x = rel_find(&disturbed.op[i], "position"), *q = rel_find(&disturbed.op[i], "orientation");
            x->v[0] += sign*(i%2 ? 1e-16 : -1e-16);
            x->v[1] += sign*(i%3 ? 1e-16 : -1e-16);
            if (!rel_has(c, "planar")) x->v[2] += up*1e-16;
            if (!(fabs(turn) > 0) || !rel_find(&disturbed.op[i], "shape")) continue;
            if (!q) { q = rel_slot(&disturbed.op[i], "orientation"); q->v[0] = 1; }
            for (k = rel_has(c, "planar") ? 3 : 1; k < 4; k++) q->v[k] += turn*2e-16;
        }
    rel_go(twin, &disturbed, &how);
}
/* Compares another run with the base, mapped. Both are rounded otherwise, which the twin's disturbance of 1e-16 m
   shows: positions and velocities may differ by a thousand times what it has caused by then, and by a floor. With
   springs it is 1e-9 radii, which a contact turns into a velocity within a step at most. With impulses the sweeps of a
   step end when no contact changes its velocity by more than the tolerance in one sweep (dem_world_desc.tolerance).
   If each sweep leaves the same part of the error, and 2,000 of them led from 0.5 m/s to a change of 1e-9 m/s, this
   part is 0.9925, and 133 tolerances are still missing, in both runs; errors of all steps add up, and a gap, which
   closes within a step, turns a position into a velocity.
   A step whose sweeps did not reach the tolerance (dem_counters.unsolved) has no solution that others could be compared
   with, nor have later ones. Outlets act whenever lists are made and every 64 steps
   (dem_outlet_desc), so a run that makes them at other steps is compared until a body has left. */
static int rel_leaves(const rel_case *c) { return rel_has(c, "outlet") || rel_has(c, "outflow"); }
static int rel_compare_now(rel_case *c, const rel_run *other, const rel_map *map, const char *what) {
    const double R = 1e-3, dt = (double)dem_counters_get(c->base.w).dt;
    /* Half a metre away, coordinates are rounded to 1e-16 m, which faces and friction enlarge: there, what fails and
       what is off by 1e-3 radii counts. */
    const double far = fabs(map->to[0]) > 0.1 ? 1e6 : 1;
    const rel_set *tolerance = rel_given_in(&c->s->op[0], "tolerance");
    int k, i, e, f, n = 0;
    c->map = *map;
    c->allowed[0] = 1e-9*R*far;                /* if the other run ends before the first mark */
    c->allowed[1] = c->allowed[0]/dt;
    for (k = 0; k < c->base.marks && k < other->marks && k < c->twin.marks; k++, n++) {
        const rel_mark *p = &c->base.mark[k], *q = &other->mark[k];
        const double time = p->step*dt;
        double chaos[2], least[2];
        if (q->unsolved || !rel_calm(c, k, chaos)) break;
        if (c->lists && rel_leaves(c) && (p->left || q->left)) break;
        least[0] = 1e-9*R*far;
        least[1] = least[0]/dt;
        if (rel_has(c, "impulses")) {
            least[1] = 2*133*(tolerance ? tolerance->v[0] : 1e-9)*p->step;
            least[0] = least[1]*time;
            least[1] += least[0]/dt;
        }
        c->allowed[0] = (1e3*chaos[0] + least[0])*map->length;
        c->allowed[1] = (1e3*chaos[1] + least[1])*map->length/map->time;
        for (i = 0; i < p->bodies; i++) {
            const double *a = p->x + REL_PER_BODY*i, *b = q->x + REL_PER_BODY*i;
            for (e = 0; e < 3; e++) {
                double x = map->to[e] + map->drift[e]*time, v = map->drift[e];
                for (f = 0; f < 3; f++) {
                    x += map->m[e][f]*a[f]*map->length;
                    v += map->m[e][f]*a[3 + f]*map->length/map->time;
                }
                if (!(a[0] < 0 || a[0] > 0 || a[1] < 0 || a[1] > 0)) continue;      /* absent */
                c->excess = fmax(c->excess, fmax(fabs(b[e] - x)/c->allowed[0], fabs(b[3 + e] - v)/c->allowed[1]));
                if (!(fabs(b[e] - x) <= c->allowed[0]))
                    return rel_broken(c, "%s: at step %d body %d is off by %.3g m (allowed: %.3g m; %d contacts)",
                                      what, p->step, i,
                                      fabs(b[e] - x), c->allowed[0], c->base.contacts + c->base.wall_contacts);
                if (!(fabs(b[3 + e] - v) <= c->allowed[1]))
                    return rel_broken(c, "%s: step %d: the speed of body %d is off by %.3g of %.3g m/s (%.3g allowed)",
                                      what, p->step, i, fabs(b[3 + e] - v), p->speed, c->allowed[1]);
            }
        }
    }
    if (c->ran && other->failed == 1 && n == other->marks && n < c->base.marks && n < c->twin.marks &&
        !rel_has(c, "unsolved stops") && !(c->lists && rel_leaves(c))) {
        double chaos[2];                       /* a step failed that the base made, and its twin alike */
        if (rel_calm(c, n, chaos)) return rel_broken(c, "%s: %s", what, other->message);
    }
    return n ? REL_HOLDS : REL_SKIPPED;
}
/* A contact begins on one side only: at a gap of 0, as of a body that was laid on a plane, a disturbance that closes it
   brings a contact one step earlier, with a damping force that grows like the fourth root of the overlap by Hertz's law
   and with a jump by the linear one. One that opens the gap, or is along the plane, changes nothing. So a difference
   counts only if it also exceeds what the opposite disturbance causes, and one along z of either sign. A rotated scene
   also rounds orientations. A cube that lies on a plane at a gap of 0 then presses with an edge, where a law with a
   range attracts it (at a gap in the middle of the face), which no displacement shows. So one twin is rotated only. */
static int rel_compare(rel_case *c, const rel_run *other, const rel_map *map, const char *what) {
    const double before = c->excess;
    int result = rel_compare_now(c, other, map, what);
    if (result != REL_BROKEN) return result;
    rel_twin(c, &c->contrary[0], -1, 1, 0);
    rel_twin(c, &c->contrary[1], -1, -1, 0);
    rel_twin(c, &c->contrary[2], 0, 0, 1);
    c->doubted = 3;
    *c->why = 0;
    c->excess = before;
    result = rel_compare_now(c, other, map, what);
    for (; c->doubted > 0; c->doubted--) rel_end(&c->contrary[c->doubted - 1]);
    return result;
}
static int rel_near(rel_case *c, const rel_scene *s, const rel_how *how, const rel_map *map, const char *what) {
    static rel_run other;
    const int ran = rel_go(&other, s, how);
    int result;
    c->image = s;
    c->other_ran = ran;
    if (ran != c->ran && !(c->ran && (other.failed == 1 || (c->lists && rel_leaves(c)))))
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
/* ---- the base, its disturbed twin, and copies ---- */
/* Runs the base and its twin, with the time step that dem.h chose made explicit. `s` is changed so. */
static int rel_open_runs(rel_case *c, rel_scene *s) {
    const rel_how how = {0};
    c->s = s;
    c->ran = rel_go(&c->base, s, &how);
    if (!c->base.w || c->base.refused) return 0;
    if (!(c->base.contacts + c->base.wall_contacts)) return 1;             /* nothing to compare */
    if (!rel_find(&s->op[0], "dt")) {          /* as it was chosen */
        rel_put(&s->op[0], "dt", (double)dem_counters_get(c->base.w).dt);
        rel_end(&c->base);
        c->ran = rel_go(&c->base, s, &how);
        if (!c->base.w || c->base.refused) return 0;
    }
    rel_twin(c, &c->twin, 1, 0, 0);
    return 1;
}
static int rel_open_case(rel_case *c, rel_scene *s) {
    c->given = s;
    c->rng.s = s->seed ^ 0x5bd1e995u;
    c->lists = c->unheard = 0;
    *c->why = 0;
    c->base.w = c->twin.w = 0;
    c->base.marks = c->twin.marks = c->doubted = 0;
    return rel_open_runs(c, s);
}
static void rel_close_case(rel_case *c) { rel_end(&c->base); rel_end(&c->twin); }
/* A copy of the scene, from which a relation leaves out what it says nothing about. */
static rel_scene rel_own;
/* Continues with the copy. Returns 1 if it ran and something touched. */
static int rel_instead(rel_case *c) {
    if (rel_own.count != c->s->count || rel_own.steps != c->s->steps || rel_own.marks != c->s->marks ||
        memcmp(rel_own.op, c->s->op, (size_t)rel_own.count*sizeof *rel_own.op)) {
        rel_close_case(c);
        if (!rel_open_runs(c, &rel_own)) c->ran = 0;
        c->other_ran = c->ran;
    }
    return c->ran && c->base.contacts + c->base.wall_contacts > 0;
}
#endif
