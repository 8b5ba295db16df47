/* shrink.h - makes a scene smaller while it still breaks a relation: fewer ops, fields, steps and triangles, rounder
   numbers, until nothing changes or the limit of work is reached. */
#ifndef REL_SHRINK_H
#define REL_SHRINK_H
#include "edit.h"
#include "relate_all.h"
#include <time.h>

typedef int (*rel_predicate)(const rel_scene *s, void *user);
typedef struct rel_shrinking {
    rel_scene *s;
    rel_predicate breaks;
    void *user;
    int seeds;                                 /* random choices of the relation that are tried for each scene */
    int evaluations, most;                     /* calls of `breaks`, and how many are allowed */
    double seconds;                            /* of processor time allowed */
    clock_t began;
} rel_shrinking;
static rel_scene rel_smaller;                  /* the scene that is tried */

static int rel_spent(const rel_shrinking *h) {
    return h->evaluations >= h->most || (double)(clock() - h->began) > h->seconds*CLOCKS_PER_SEC;
}
/* Takes over rel_smaller if it breaks. */
static int rel_take(rel_shrinking *h) {
    int k;
    rel_settle(&rel_smaller);
    for (k = 0; k < h->seeds && !rel_spent(h); k++) {
        rel_smaller.seed = h->s->seed + (uint64_t)k;
        h->evaluations++;
        if (h->breaks(&rel_smaller, h->user)) { rel_copy(h->s, &rel_smaller); return 1; }
    }
    return 0;
}
static int rel_fewer_ops(rel_shrinking *h) {
    int chunk, from, changed = 0;
    for (chunk = h->s->count/2; chunk; chunk /= 2)
        for (from = h->s->count - chunk; h->s->count > 1;) {       /* from the end: what refers to others goes first */
            if (from < 1) from = 1;
            rel_copy(&rel_smaller, h->s);
            rel_drop_ops(&rel_smaller, from, from + chunk);
            if (rel_take(h)) changed = 1;
            if (from == 1) break;
            from -= chunk;
            if (from > h->s->count - chunk) from = h->s->count - chunk;
        }
    return changed;
}
/* Fields back to defaults, references to the first op of a kind, spheres instead of shapes, joints to the ground. */
static int rel_fewer_fields(rel_shrinking *h) {
    int i, j, k, changed = 0;
    for (i = 0; i < h->s->count; i++)
        for (j = h->s->op[i].count - 1; j >= 0; j--) {
            const rel_set *v = &h->s->op[i].set[j];
            const rel_field *f = rel_field_at(&h->s->op[i], j);
            rel_op *op = &rel_smaller.op[i];
            rel_copy(&rel_smaller, h->s);
            if (!rel_needed(&h->s->op[i], f)) rel_drop_set(op, j);
            else if (!strcmp(f->name, "shape") && op->call == REL_A_BODY) {
                rel_drop_set(op, j);
                rel_put(op, "radius", 1e-3);
            } else if (!strcmp(f->name, "d.b") && f->type == REL_BODY && v->v[0] >= 0) op->set[j].v[0] = -1;
            else if (f->type == REL_REF && v->v[0] >= 0) {
                for (k = 0; k < (int)v->v[0] && h->s->op[k].call != h->s->op[(int)v->v[0]].call; k++) continue;
                if (k == (int)v->v[0]) continue;
                op->set[j].v[0] = k;
            } else continue;
            changed |= rel_take(h);
        }
    return changed;
}
/* Fewer comparisons, fewer steps, and later calls earlier. */
static int rel_fewer_steps(rel_shrinking *h) {
    int i, k, n, changed = 0;
    const int marks = h->s->marks ? h->s->marks : REL_MARKS;
    for (n = 1; n <= 2 && n < marks; n++)
        for (k = 1; k <= marks; k++) {
            rel_copy(&rel_smaller, h->s);
            rel_smaller.marks = n;
            rel_smaller.steps = h->s->steps*k/marks;
            if (rel_smaller.steps > 0 && rel_take(h)) return 1;
        }
    for (k = 0; k < 3;) {
        const int less[3] = {h->s->steps/2, h->s->steps*9/10, h->s->steps - 1};
        rel_copy(&rel_smaller, h->s);
        rel_smaller.steps = less[k];
        if (less[k] > 0 && less[k] < h->s->steps && rel_take(h)) changed = 1;
        else k++;
    }
    for (i = 1; i < h->s->count; i++)
        for (k = 0; k < 3 && h->s->op[i].step > 0;) {
            const int at = h->s->op[i].step, less[3] = {0, at/2, at - 1};
            rel_copy(&rel_smaller, h->s);
            rel_smaller.op[i].step = less[k];
            if (less[k] < at && rel_take(h)) changed = 1;
            else k++;
        }
    return changed;
}
static int rel_fewer_items(rel_shrinking *h) {
    int i, j, chunk, from, changed = 0;
    for (i = 1; i < h->s->count; i++)
        for (j = 0; j < h->s->op[i].count; j++) {
            const rel_set *v = &h->s->op[i].set[j];
            const int per = rel_group(&h->s->op[i], rel_field_at(&h->s->op[i], j)->name);
            for (chunk = per ? v->count/per/2 : 0; chunk; chunk /= 2)
                for (from = 0; from + chunk <= v->count/per;) {
                    rel_set *less = &rel_smaller.op[i].set[j];
                    double *at = rel_smaller.pool + v->at + per*from;
                    rel_copy(&rel_smaller, h->s);
                    less->count -= per*chunk;
                    memmove(at, at + per*chunk, (size_t)(less->count - per*from)*sizeof *at);
                    if (h->s->op[i].call == REL_MESH || h->s->op[i].call == REL_PROFILE)
                        rel_drop_vertices(&rel_smaller, &rel_smaller.op[i]);
                    if (less->count > 0 && rel_take(h)) changed = 1;
                    else from += chunk;
                }
        }
    return changed;
}
/* Rounds the numbers `from` to `to` - 1 of a set. Returns 0 if this changes nothing. */
static int rel_round(rel_op *op, int j, int from, int to, int digits) {
    const char *name = rel_field_at(op, j)->name;
    const int down = op->call == REL_WORLD && !strcmp(name, "d.dt");
    int n, k, changed = 0;
    if (!digits && op->call == REL_WORLD && (down || !strcmp(name, "d.tolerance"))) return 0;
    double *x = rel_numbers_of(&rel_smaller, op, &op->set[j], &n);
    for (k = from; k < n && k < to; k++) {
        const double y = x[k] < 0 || x[k] > 0 ? rel_rounder(x[k], digits, down) : 0;
        changed |= x[k] < y || x[k] > y;
        x[k] = y;
    }
    return changed;
}
static int rel_rounder_numbers(rel_shrinking *h) {
    static const int digits[] = {0, 1, 2, 3};
    int i, j, k, d, n, some, changed = 0;
    for (d = 3; d > 0; d--) {                  /* all at once */
        rel_copy(&rel_smaller, h->s);
        for (some = i = 0; i < h->s->count; i++)
            for (j = 0; j < h->s->op[i].count; j++) some |= rel_round(&rel_smaller.op[i], j, 0, REL_POOL, d);
        if (some && rel_take(h)) changed = 1;
    }
    for (i = 0; i < h->s->count; i++)
        for (j = 0; j < h->s->op[i].count; j++) {
            rel_numbers_of(h->s, &h->s->op[i], &h->s->op[i].set[j], &n);
            for (k = n > 1 ? -1 : 0; k < n; k++)           /* a set at once, then one after the other */
                for (d = 0; d < 4; d++) {
                    rel_copy(&rel_smaller, h->s);
                    if (!rel_round(&rel_smaller.op[i], j, k < 0 ? 0 : k, k < 0 ? REL_POOL : k + 1, digits[d]) ||
                        !rel_take(h)) continue;
                    changed = 1;
                    break;
                }
        }
    return changed;
}
/* Makes a scene smaller while `breaks` returns 1. Returns the number of evaluations. */
static int rel_shrink_while(rel_scene *s, rel_predicate breaks, void *user, int seeds, int most, double seconds) {
    rel_shrinking h = {0};
    int changed = 1;
    h.s = s; h.breaks = breaks; h.user = user; h.seeds = seeds; h.most = most; h.seconds = seconds;
    h.began = clock();
    while (changed && !rel_spent(&h)) {
        changed = rel_fewer_ops(&h);
        changed |= rel_fewer_steps(&h);
        changed |= rel_fewer_items(&h);
        changed |= rel_fewer_fields(&h);
        changed |= rel_rounder_numbers(&h);
    }
    return h.evaluations;
}
/* What must stay: the relation, whether the other run differs or ends otherwise, and that it differs by more than
   rounding if it does. */
typedef struct rel_wanted { int relation, ends; double excess; } rel_wanted;
static int rel_breaks(const rel_scene *s, void *user) {
    static rel_scene own;
    static rel_case c;
    rel_wanted *wanted = (rel_wanted *)user;
    int broken, ends;
    rel_copy(&own, s);
    broken = rel_open_case(&c, &own) && rel_judge(&c, wanted->relation) == REL_BROKEN;
    ends = c.ran != c.other_ran;
    rel_close_case(&c);
    if (broken && wanted->ends < 0) {
        wanted->ends = ends;
        wanted->excess = c.excess < 100 ? 0 : 100;
    }
    return broken && ends == wanted->ends && !(c.excess < wanted->excess);
}
enum { REL_SHRINK_MOST = 20000, REL_SHRINK_SECONDS = 60 };
/* Makes a scene that breaks a relation smaller. The time step becomes explicit. An allocation that is refused is
   another one in each smaller scene, so several are tried. Returns the number of evaluations; 0: it does not break. */
static int rel_shrink(rel_scene *s, int relation) {
    static rel_case c;
    const int opened = rel_open_case(&c, s), seeds = relation == REL_IS_MEMORY ? 30 : 1;
    rel_wanted wanted;
    wanted.relation = relation;
    wanted.ends = -1;
    rel_close_case(&c);
    if (!opened || !rel_breaks(s, &wanted)) return 0;
    return rel_shrink_while(s, rel_breaks, &wanted, seeds, REL_SHRINK_MOST, REL_SHRINK_SECONDS);
}
#endif
