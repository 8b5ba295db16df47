/* run.h - carries out a scene: creates the world, makes the calls at their steps, steps, and writes down what
   happened. A `rel_how` is a way to run it that must not matter: threads, pieces, a checkpoint, slabs. */
#ifndef REL_RUN_H
#define REL_RUN_H
#include "calls.h"

/* What a scene is at some step: the bodies in the order in which the scene adds them, absent ones all 0; the force on
   each wall; sums. */
enum { REL_MARKS = 6 };
typedef struct rel_mark { int step, bodies, left; double *x, momentum[3], speed; uint64_t hash; } rel_mark;
enum { REL_PER_BODY = 13 };                    /* position, velocity, spin, orientation */
typedef struct rel_how {
    int threads;                               /* 0: as the scene has it */
    int pieces;                                /* calls of dem_world_step per mark; 0: one */
    int checkpoint;                            /* 1: written and read at each mark, into a new world; 2: into a used one */
    int slabs;                                 /* 0: none */
    int ledger;                                /* 1: the ledger is on */
    int marks;                                 /* 0: REL_MARKS */
    int64_t refuse;                            /* the allocation that is refused; 0: none */
} rel_how;
struct rel_run {
    dem_world *w;
    dem_slabs *slabs;
    const rel_scene *s;
    union { int32_t id; dem_body body; } made[REL_OPS];
    rel_mark mark[REL_MARKS + 1];
    int marks;
    int refused;                               /* 1 + the op that was refused; 0: none */
    int repeated;                              /* the op that was repeated after a refused allocation; 0: none */
    int failed;                                /* 1: a step failed */
    char message[400];
    int contacts, wall_contacts;               /* largest numbers seen */
    dem_ledger ledger;
    dem_body_counts counts;
    uint64_t hash;
};

/* Fills the arguments of an op. Lists are written to `pool`. */
static void rel_arguments(rel_run *r, const rel_op *op, char *a, dem_real *pool, int32_t *ints) {
    const rel_call *c = &rel_calls[op->call];
    int i, k, reals = 0, whole = 0;
    memset(a, 0, c->size);
    if (c->defaults) memcpy(a, c->defaults, c->size);
    for (i = 0; i < op->count; i++) {
        const rel_set *v = &op->set[i];
        const rel_field *f = &c->fields[v->field];
        char *to = a + f->at;
        dem_real real[6];
        for (k = 0; k < 6; k++) real[k] = (dem_real)v->v[k];
        if (op->call == REL_PAIR) ((rel_a_pair *)a)->set[v->field] = 1;
        switch (f->type) {
        case REL_INT: *(int *)to = (int)v->v[0]; break;
        case REL_INT3: for (k = 0; k < 3; k++) ((int *)to)[k] = (int)v->v[k]; break;
        case REL_REAL: memcpy(to, real, sizeof *real); break;
        case REL_DOUBLE: memcpy(to, v->v, sizeof(double)); break;
        case REL_VEC: memcpy(to, real, 3*sizeof *real); break;
        case REL_QUAT: memcpy(to, real, 4*sizeof *real); break;
        case REL_BOX: memcpy(to, real, 6*sizeof *real); break;
        case REL_REF: *(int32_t *)to = v->v[0] < 0 ? 0 : r->made[(int)v->v[0]].id; break;
        case REL_BODY: if (v->v[0] >= 0) *(dem_body *)to = r->made[(int)v->v[0]].body; break;
        case REL_REALS: {
            rel_reals list;
            list.count = v->count;
            list.at = pool + reals;
            for (k = 0; k < v->count; k++) pool[reals++] = (dem_real)r->s->pool[v->at + k];
            memcpy(to, &list, sizeof list);
            break;
        }
        case REL_INTS: {
            rel_ints list;
            list.count = v->count;
            list.at = ints + whole;
            for (k = 0; k < v->count; k++) ints[whole++] = (int32_t)r->s->pool[v->at + k];
            memcpy(to, &list, sizeof list);
            break;
        }
        case REL_REF_ARRAY:
            for (k = 0; k < v->count; k++) {
                const int at = (int)r->s->pool[v->at + k];
                ((int32_t *)to)[k] = at < 0 ? 0 : r->made[at].id;
            }
            break;
        case REL_REAL_ARRAY: for (k = 0; k < v->count; k++) ((dem_real *)to)[k] = (dem_real)r->s->pool[v->at + k]; break;
        case REL_DOUBLE_ARRAY: for (k = 0; k < v->count; k++) ((double *)to)[k] = r->s->pool[v->at + k]; break;
        case REL_CODE: memcpy(to, &rel_codes[(int)v->v[0]].function, sizeof(void (*)(void))); break;
        case REL_TEXT: *(const char **)to = rel_texts[(int)v->v[0]]; break;
        }
    }
}

typedef struct rel_memory { int64_t count, refuse; } rel_memory;
static rel_memory rel_allocations;
static void *rel_alloc(size_t size, void *user) {
    rel_memory *m = (rel_memory *)user;
    return ++m->count == m->refuse ? 0 : malloc(size);
}
static void rel_release(void *at, size_t size, void *user) { (void)size; (void)user; free(at); }

static void rel_tell(rel_run *r, const char *message) { snprintf(r->message, sizeof r->message, "%s", message); }
static dem_world *rel_world(rel_run *r, const rel_how *how) {
    rel_a_world a;
    dem_world *w;
    rel_arguments(r, &r->s->op[0], (char *)&a, 0, 0);
    if (how->threads) a.d.threads = how->threads;
    if (how->ledger) a.d.ledger = 1;
    if (how->refuse) {
        rel_allocations.count = 0;
        rel_allocations.refuse = how->refuse;
        a.d.allocator.alloc_fn = rel_alloc;
        a.d.allocator.free_fn = rel_release;
        a.d.allocator.user = &rel_allocations;
    }
    else rel_allocations.refuse = 0;
    w = dem_world_create(&a.d);
    if (!w && how->refuse) w = dem_world_create(&a.d);
    if (!w) rel_tell(r, dem_world_create_error_get(&a.d));
    return w;
}
/* Makes the calls of a step. Returns 0 if one was refused. */
static int rel_calls_at(rel_run *r, int from, int step) {
    static union { char bytes[4096]; double aligned; } a;
    static dem_real pool[REL_POOL];
    static int32_t ints[REL_POOL];
    int i;
    for (i = from; i < r->s->count; i++) {
        const rel_op *op = &r->s->op[i];
        int32_t made;
        if (op->step != step) continue;
        rel_arguments(r, op, a.bytes, pool, ints);
        made = rel_calls[op->call].call(r->w, a.bytes);
        if (!made && rel_allocations.refuse && rel_allocations.count >= rel_allocations.refuse) {
            rel_allocations.refuse = 0;        /* it succeeds now */
            rel_arguments(r, op, a.bytes, pool, ints);
            made = rel_calls[op->call].call(r->w, a.bytes);
            r->repeated = i;
        }
        if (!made) {
            r->refused = i + 1;
            rel_tell(r, dem_world_error_get(r->w));
            return 0;
        }
        if (op->call == REL_A_BODY) r->made[i].body = dem_body_id_get(r->w, made - 1);
        else r->made[i].id = made;
    }
    return 1;
}
/* Creates the world and makes the calls before the first step. Returns 0 if one was refused. */
static int rel_build(rel_run *r, const rel_scene *s, const rel_how *how) {
    memset(r, 0, sizeof *r);
    r->s = s;
    r->w = rel_world(r, how);
    if (!r->w) { r->refused = 1; return 0; }
    return rel_calls_at(r, 1, 0);
}
static int rel_bodies(const rel_scene *s) {
    int i, n = 0;
    for (i = 0; i < s->count; i++) n += s->op[i].call == REL_A_BODY;
    return n;
}
static int rel_is_wall(int call) { return call >= REL_PLANE && call <= REL_SIEVE; }
static int rel_walls(const rel_scene *s) {
    int i, n = 0;
    for (i = 0; i < s->count; i++) n += rel_is_wall(s->op[i].call);
    return n;
}
static void rel_put_mark(rel_run *r, int step) {
    const dem_counters c = dem_counters_get(r->w);
    const int bodies = rel_bodies(r->s), n = REL_PER_BODY*bodies + 3*rel_walls(r->s);
    rel_mark *m = &r->mark[r->marks++];
    double *x = (double *)calloc((size_t)n + 1, sizeof *x);
    int i, k;
    m->step = step;
    m->bodies = bodies;
    m->x = x;
    m->left = (int)dem_body_counts_get(r->w).left;
    m->hash = dem_world_hash_get(r->w);
    r->contacts = c.contacts > r->contacts ? c.contacts : r->contacts;
    r->wall_contacts = c.wall_contacts > r->wall_contacts ? c.wall_contacts : r->wall_contacts;
    for (k = 0; k < 3; k++) m->momentum[k] = 0;
    m->speed = 0;
    if (!x) return;
    for (i = 0; i < r->s->count; i++) {
        dem_body_state b;
        if (r->s->op[i].call != REL_A_BODY) continue;
        if (r->made[i].body.slot && dem_body_get(r->w, r->made[i].body, &b) == DEM_OK) {
            const double all[REL_PER_BODY] = {(double)b.position.x, (double)b.position.y, (double)b.position.z,
                (double)b.velocity.x, (double)b.velocity.y, (double)b.velocity.z, (double)b.spin.x, (double)b.spin.y,
                (double)b.spin.z, (double)b.orientation.w, (double)b.orientation.x, (double)b.orientation.y,
                (double)b.orientation.z};
            for (k = 0; k < REL_PER_BODY; k++) x[k] = all[k];
            for (k = 0; k < 3; k++) m->momentum[k] += (double)b.mass*all[3 + k];
            m->speed = fmax(m->speed, sqrt(all[3]*all[3] + all[4]*all[4] + all[5]*all[5]));
        }
        x += REL_PER_BODY;
    }
    for (i = 0; i < r->s->count; i++) {
        dem_wall wall;
        dem_wall_loads loads;
        if (!rel_is_wall(r->s->op[i].call)) continue;
        wall.id = r->made[i].id;
        if (wall.id && dem_wall_loads_get(r->w, wall, &loads) == DEM_OK) {
            x[0] = (double)loads.force.x; x[1] = (double)loads.force.y; x[2] = (double)loads.force.z;
        }
        x += 3;
    }
}
/* Writes a checkpoint and continues from it: in a new world (how 1) or in one that has run (2). */
static int rel_checkpoint(rel_run *r, const rel_how *how, int step) {
    char path[64];
    dem_world *w = 0;
    int ok;
    snprintf(path, sizeof path, "build/tmp/relations_%llx.dem", (unsigned long long)r->s->seed);
    ok = dem_checkpoint_write(r->w, path) == DEM_OK;
    if (!ok) rel_tell(r, dem_world_error_get(r->w));
    if (ok && how->checkpoint == 2) {
        w = r->w;
        ok = dem_world_step(w, 3) == DEM_OK;   /* what the file replaces */
    } else if (ok) {                           /* one made by the same calls */
        dem_world *old = r->w;
        int i, at;
        r->w = rel_world(r, how);
        ok = r->w != 0;
        for (at = 0; at <= step && ok; at++) {
            for (i = 1; i < r->s->count && r->s->op[i].step != at; i++) continue;
            if (i < r->s->count && at < step) ok = rel_calls_at(r, 1, at);
        }
        dem_world_destroy(old);
        w = r->w;
    }
    if (ok && dem_checkpoint_read(w, path) != DEM_OK) { rel_tell(r, dem_world_error_get(w)); ok = 0; }
    remove(path);
    return ok;
}
static int rel_step(rel_run *r, const rel_how *how, int steps) {
    int i;
    if (r->slabs) {
        if (dem_slabs_step(r->slabs, steps) == DEM_OK && dem_slabs_collect(r->slabs, r->w) == DEM_OK) return 1;
        rel_tell(r, dem_slabs_error_get(r->slabs));
        return 0;
    }
    for (i = 0; i < (how->pieces && how->pieces < steps ? how->pieces : 1); i++) {
        const int n = how->pieces && how->pieces < steps ? how->pieces : 1;
        const uint64_t end = dem_world_steps_get(r->w) + (uint64_t)(i + 1 < n ? steps/n : steps - (n - 1)*(steps/n));
        int again = how->refuse != 0;
        while (dem_world_step(r->w, (int)(end - dem_world_steps_get(r->w))) != DEM_OK) {
            rel_tell(r, dem_world_error_get(r->w));
            if (!again-- || rel_allocations.count < rel_allocations.refuse) return 0;
        }
    }
    return 1;
}
static int rel_slabs_begin(rel_run *r, const rel_how *how) {
    dem_slabs_desc d = DEM_SLABS_DESC;
    if (!how->slabs || r->slabs) return 1;
    d.count = how->slabs;
    r->slabs = dem_slabs_create(r->w, &d);
    if (r->slabs) return 1;
    rel_tell(r, dem_world_error_get(r->w));
    r->refused = -1;
    return 0;
}
/* Makes the calls of a step, around which slabs end and begin again. A world that was collected has no list until
   dem_candidates_rebuild, and continues as the slabs would after that (dem_slabs_collect). */
static int rel_change(rel_run *r, const rel_how *how, int step) {
    int i;
    for (i = 1; i < r->s->count && r->s->op[i].step != step; i++) continue;
    if (i == r->s->count) return 1;
    if (r->slabs) {
        dem_slabs_destroy(r->slabs);
        r->slabs = 0;
        if (dem_candidates_rebuild(r->w) != DEM_OK) { rel_tell(r, dem_world_error_get(r->w)); return 0; }
    }
    return rel_calls_at(r, 1, step) && rel_slabs_begin(r, how);
}
/* Runs a scene to its end. Returns 1 unless a call was refused or a step failed; the marks up to there are valid. */
static int rel_go(rel_run *r, const rel_scene *s, const rel_how *how) {
    const int marks = s->marks ? s->marks : REL_MARKS;
    int step = 0, next, i, k, mark;
    if (!rel_build(r, s, how)) return 0;
    if (!rel_slabs_begin(r, how)) return 0;
    for (k = 1; k <= marks; k++) {
        mark = s->steps*k/marks;
        while (step < mark) {
            for (next = mark, i = 1; i < s->count; i++)
                if (s->op[i].step > step && s->op[i].step < next) next = s->op[i].step;
            if (!rel_step(r, how, next - step)) { r->failed = 1; return 0; }
            step = next;
            if (step < mark && !rel_change(r, how, step)) return 0;
        }
        rel_put_mark(r, step);
        if (how->checkpoint && k < marks && !rel_checkpoint(r, how, step)) { r->failed = 2; return 0; }
        if (k < marks && !rel_change(r, how, step)) return 0;
    }
    r->hash = dem_world_hash_get(r->w);
    r->ledger = dem_ledger_get(r->w);
    r->counts = dem_body_counts_get(r->w);
    return 1;
}
static void rel_end(rel_run *r) {
    int k;
    for (k = 0; k < r->marks; k++) free(r->mark[k].x);
    if (r->slabs) dem_slabs_destroy(r->slabs);
    dem_world_destroy(r->w);
    r->w = 0;
    r->slabs = 0;
    r->marks = 0;
}
#endif
