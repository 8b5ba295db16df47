/* run.h - carries out a scene: creates the world, makes the calls at their steps, steps, and writes down what
   happened. A `rel_how` is a way to run it that must not matter: threads, pieces, a checkpoint, slabs. */
#ifndef REL_RUN_H
#define REL_RUN_H
#include "calls.h"

int rel_domain_bodies = 2048;                  /* groups.h */

/* What a scene is at some step: the bodies in the order in which the scene adds them, absent ones all 0; the force on
   each wall; sums. */
/* noted: what events, functions of outputs and readers have seen (codes_services.h). */
enum { REL_MARKS = 6, REL_MARKS_MOST = 11 };
typedef struct rel_mark {
    int step, bodies, left;
    double *x, speed;
    uint64_t hash, unsolved, noted;
    dem_totals totals;
    double most[2];                            /* sums of the sizes of m v, and of the parts of the angular momentum */
    double impulse[3];                         /* N s, of grains on all walls */
    dem_ledger ledger;
} rel_mark;
enum { REL_PER_BODY = 13 };                    /* position, velocity, spin, orientation */
typedef struct rel_how {
    int threads;                               /* 0: as the scene has it */
    int pieces;                                /* calls of dem_world_step per mark; 0: one */
    int checkpoint;                            /* written and read at each mark, 1: into a new world; 2: a used one */
    int slabs;                                 /* 0: none; -1, -2: see rel_slabs_beside */
    int ledger;                                /* 1: the ledger is on */
    int marks;                                 /* 0: REL_MARKS */
    int64_t refuse;                            /* the allocation that is refused; 0: none */
    int way;                                   /* 1: dem_world_run, 2: dem_world_run_to, 3: dem_world_settle */
    int axis, moved;                           /* of slabs; 1: their borders move at every chance */
} rel_how;
struct rel_run {
    dem_world *w;
    dem_slabs *slabs;
    const rel_scene *s;
    union { int32_t id; dem_body body; } made[REL_OPS];
    rel_mark mark[REL_MARKS_MOST + 1];
    int marks;
    int refused;                               /* 1 + the op that was refused; 0: none */
    int repeated;                              /* the op that was repeated after a refused allocation; 0: none */
    int failed;                                /* 1: a step failed */
    char message[400];
    int contacts, wall_contacts;               /* largest numbers seen */
    dem_ledger ledger;
    dem_body_counts counts;
    uint64_t hash;
    int filed;                                 /* 1: the files were read and removed */
    uint64_t file[REL_OPS];                    /* of the bytes of the file that an op wrote */
    long took[REL_OPS];                        /* bytes that an op wrote, contacts that were recorded, or 1 */
};
static const char *rel_path(const rel_run *r, int text) {
    static char path[120];
    snprintf(path, sizeof path, "build/tmp/relations_%llx_%s", (unsigned long long)r->s->seed, rel_texts[text]);
    return path;
}

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
        case REL_REAL_ARRAY: for (k = 0; k < v->count; k++) ((dem_real *)to)[k] = (dem_real)r->s->pool[v->at + k];
            break;
        case REL_DOUBLE_ARRAY: for (k = 0; k < v->count; k++) ((double *)to)[k] = r->s->pool[v->at + k]; break;
        case REL_CODE: memcpy(to, &rel_codes[(int)v->v[0]].function, sizeof(void (*)(void))); break;
        case REL_TEXT: *(const char **)to = rel_texts[(int)v->v[0]]; break;
        case REL_PATH: *(const char **)to = rel_path(r, (int)v->v[0]); break;
        case REL_DATA: *(void **)to = rel_data[(int)v->v[0]].at; break;
        case REL_WHOLE: *(uint64_t *)to = (uint64_t)v->v[0]; break;
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
    rel_domain_bodies = a.domain_bodies ? a.domain_bodies : 2048;
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
        const uint64_t before = noted;
        const int64_t allocations = rel_allocations.count;
        const int fills = op->call == REL_FILL || op->call == REL_FILL_SHAPE;
        uint64_t bodies;
        int32_t made;
        if (op->step != step) continue;
        bodies = fills ? dem_body_counts_get(r->w).inserted : 0;
        rel_arguments(r, op, a.bytes, pool, ints);
        made = rel_calls[op->call].call(r->w, a.bytes);
        r->took[i] = 1;
        if ((op->call == REL_READ || (fills && dem_body_counts_get(r->w).inserted == bodies)) &&
            allocations < rel_allocations.refuse && rel_allocations.count >= rel_allocations.refuse) {
            noted = before;                    /* again; a fill returns 0 without room, too */
            made = 0;
        }
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
    rel_close_replays();
    noted = 0;
    snprintf(scratch, sizeof scratch, "build/tmp/relations_%llx.out", (unsigned long long)s->seed);
    unit_m = s->unit[0] > 0 ? s->unit[0] : 1;
    unit_s = s->unit[1] > 0 ? s->unit[1] : 1;
    r->w = rel_world(r, how);
    if (!r->w) { r->refused = 1; return 0; }
    return rel_calls_at(r, 1, 0);
}
static int rel_count(const rel_scene *s, int call) {
    int i, n = 0;
    for (i = 0; i < s->count; i++) n += s->op[i].call == call;
    return n;
}
static int rel_bodies(const rel_scene *s) { return rel_count(s, REL_A_BODY); }
static int rel_is_wall(int call) {
    return (call >= REL_PLANE && call <= REL_SIEVE) || call == REL_MESH_FILE || call == REL_PROFILE_FILE;
}
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
    m->noted = noted;
    r->contacts = c.contacts > r->contacts ? c.contacts : r->contacts;
    r->wall_contacts = c.wall_contacts > r->wall_contacts ? c.wall_contacts : r->wall_contacts;
    m->unsolved = c.unsolved;
    m->totals = dem_totals_get(r->w);
    m->ledger = dem_ledger_get(r->w);
    m->speed = m->most[0] = m->most[1] = 0;
    for (k = 0; k < 3; k++) m->impulse[k] = 0;
    if (!x) return;
    for (i = 0; i < r->s->count; i++) {
        dem_body_state b;
        if (r->s->op[i].call != REL_A_BODY) continue;
        if (r->made[i].body.slot && dem_body_get(r->w, r->made[i].body, &b) == DEM_OK) {
            const double all[REL_PER_BODY] = {(double)b.position.x, (double)b.position.y, (double)b.position.z,
                (double)b.velocity.x, (double)b.velocity.y, (double)b.velocity.z, (double)b.spin.x, (double)b.spin.y,
                (double)b.spin.z, (double)b.orientation.w, (double)b.orientation.x, (double)b.orientation.y,
                (double)b.orientation.z};
            const double v = sqrt(all[3]*all[3] + all[4]*all[4] + all[5]*all[5]);
            const double inertia = fmax((double)b.inertia, fmax((double)b.moments.x,
                fmax((double)b.moments.y, (double)b.moments.z)));
            for (k = 0; k < REL_PER_BODY; k++) x[k] = all[k];
            m->most[0] += (double)b.mass*v;
            m->most[1] += (double)b.mass*v*sqrt(all[0]*all[0] + all[1]*all[1] + all[2]*all[2]) +
                          inertia*sqrt(all[6]*all[6] + all[7]*all[7] + all[8]*all[8]);
            m->speed = fmax(m->speed, v);
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
            for (k = 0; k < 3; k++) m->impulse[k] += loads.impulse[k];
        }
        x += 3;
    }
}
/* Reads and removes the files that the scene has written, and asks for what was recorded. */
static void rel_files(rel_run *r) {
    const uint64_t before = noted;
    int i, j;
    if (r->filed || !r->s) return;
    r->filed = 1;
    rel_close_replays();
    for (i = 0; i < r->s->count; i++) {
        const rel_op *op = &r->s->op[i];
        if (op->call == REL_EVENTS && r->w) {
            const dem_material any = {0};
            dem_impacts *n = (dem_impacts *)calloc(1, sizeof *n);
            if (n && dem_impacts_get(r->w, any, any, n) == DEM_OK) r->took[i] = (long)n->ended + n->open;
            free(n);
        }
        for (j = 0; j < op->count; j++)
            if (rel_calls[op->call].fields[op->set[j].field].type == REL_PATH) {
                noted = 0;
                r->took[i] = fold(rel_path(r, (int)op->set[j].v[0]));
                r->file[i] = noted;
            }
    }
    noted = before;
}
/* Makes the calls of a step in a world that has not run: bodies at rest have no temperature to scale. */
static int rel_calls_again(rel_run *r, int step) {
    int from = 1;
    while (!rel_calls_at(r, from, step)) {
        if (!r->refused || r->s->op[r->refused - 1].call != REL_TEMPERATURE) return 0;
        from = r->refused;
        r->refused = 0;
    }
    return 1;
}
/* Writes a checkpoint and continues from it: in a new world (how 1) or in one that has run (2). What was noted after
   the checkpoint was written counts no more. */
static int rel_checkpoint(rel_run *r, const rel_how *how, int step) {
    const uint64_t before = noted;
    char path[64];
    dem_world *w = 0;
    int ok;
    rel_close_replays();
    snprintf(path, sizeof path, "build/tmp/relations_%llx.dem", (unsigned long long)r->s->seed);
    ok = dem_checkpoint_write(r->w, path) == DEM_OK;
    if (!ok) rel_tell(r, dem_world_error_get(r->w));
    else if (!twice(r->w, path)) { rel_tell(r, "a checkpoint that is written twice is another file"); ok = 0; }
    if (ok && how->checkpoint == 2) {
        w = r->w;
        ok = dem_world_step(w, 3) == DEM_OK;   /* what the file replaces */
        if (!ok) rel_tell(r, dem_world_error_get(w));
    } else if (ok) {                           /* one made by the same calls */
        dem_world *old = r->w;
        int i, at;
        r->w = rel_world(r, how);
        ok = r->w != 0;
        for (at = 0; at <= step && ok; at++) {
            for (i = 1; i < r->s->count && r->s->op[i].step != at; i++) continue;
            if (i < r->s->count && at < step) ok = rel_calls_again(r, at);
        }
        dem_world_destroy(old);
        w = r->w;
    }
    if (ok && (how->checkpoint == 2 ? dem_checkpoint_read_changed(w, path, "") : dem_checkpoint_read(w,
        path)) != DEM_OK) { rel_tell(r, dem_world_error_get(w)); ok = 0; }
    remove(path);
    noted = before;
    return ok;
}
/* Reads slabs. The sums of loads that this sets to 0 are not compared. */
static void rel_read_slabs(dem_slabs *slabs) {
    dem_slab one;
    int k;
    for (k = 0; dem_slab_get(slabs, k, &one) == DEM_OK; k++) note(one.lo);
    note((double)dem_slabs_counters_get(slabs).steps);
    dem_slabs_loads_reset(slabs);
}
/* Steps by another function. dem_world_settle ends earlier if all is at rest. */
static int rel_step_by(rel_run *r, int way, int steps) {
    const uint64_t end = dem_world_steps_get(r->w) + (uint64_t)steps;
    const double seconds = steps*(double)dem_world_desc_get(r->w).dt;
    const dem_result result = way == 1 ? dem_world_run(r->w, seconds, 0, 0) :
        way == 2 ? dem_world_run_to(r->w, dem_world_time_get(r->w) + seconds, 0, 0) :
        dem_world_settle(r->w, seconds, (dem_real)1e-12, 0, 0);
    if (way == 3 && (result == DEM_OK || result == DEM_ERROR_STOPPED) && dem_world_steps_get(r->w) < end)
        return dem_world_step(r->w, (int)(end - dem_world_steps_get(r->w))) == DEM_OK;
    if (result != DEM_OK && !(way == 3 && result == DEM_ERROR_STOPPED)) { rel_tell(r, dem_world_error_get(r->w));
        return 0; }
    if (dem_world_steps_get(r->w) == end) return 1;
    snprintf(r->message, sizeof r->message, "%g s were %d steps, not %d", seconds,
             (int)(dem_world_steps_get(r->w) + (uint64_t)steps - end), steps);
    return 0;
}
static int rel_step(rel_run *r, const rel_how *how, int steps) {
    int i;
    if (how->way) return rel_step_by(r, how->way, steps);
    if (r->slabs) {
        if (dem_slabs_step(r->slabs, steps) == DEM_OK && dem_slabs_collect(r->slabs, r->w) == DEM_OK) {
            rel_read_slabs(r->slabs);
            return 1;
        }
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
/* Friction of all pairs is changed and changed back. With `make`, slabs are made of the world, stepped and destroyed in
   between. */
CODE(touch, static void touch(dem_world *w, int materials, int make) {
    dem_slabs_desc d = DEM_SLABS_DESC;
    dem_slabs *s = 0;
    dem_pair pair[9];
    int i, k;
    for (k = 0; k < 2; k++) {
        for (i = 0; i < materials*materials; i++) {
            const dem_material a = {1 + i/materials}, b = {1 + i%materials};
            dem_pair p;
            if (!k) dem_pair_get(w, a, b, &pair[i]);
            p = pair[i];
            if (!k) p.friction = p.rolling_friction = p.spinning_friction = 0;
            dem_pair_set(w, a, b, &p);
        }
        d.count = 2;
        if (!k && make) s = dem_slabs_create(w, &d);
    }
    if (s) dem_slabs_step(s, 1);
    dem_slabs_destroy(s);
    dem_world_error_get(w);
})
static int rel_slabs_begin(rel_run *r, const rel_how *how) {
    dem_slabs_desc d = DEM_SLABS_DESC;
    if (how->slabs <= 0 || r->slabs) return 1;
    d.count = how->slabs;
    d.axis = how->axis;
    if (how->moved) { d.balance = 1; d.balance_interval = 1; }
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
static int rel_go_on(rel_run *r, const rel_scene *s, const rel_how *how) {
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
        if (how->slabs < 0 && k < marks) touch(r->w, rel_count(s, REL_MATERIAL), how->slabs == -2);
        if (how->checkpoint && k < marks && !rel_checkpoint(r, how, step)) { r->failed = 2; return 0; }
        if (k < marks && !rel_change(r, how, step)) return 0;
    }
    r->hash = dem_world_hash_get(r->w);
    r->ledger = dem_ledger_get(r->w);
    r->counts = dem_body_counts_get(r->w);
    return 1;
}
/* Runs a scene to its end. Returns 1 unless a call was refused or a step failed; the marks up to there are valid. */
static int rel_go(rel_run *r, const rel_scene *s, const rel_how *how) {
    const int ran = rel_go_on(r, s, how);
    rel_files(r);
    return ran;
}
static void rel_end(rel_run *r) {
    int k;
    rel_files(r);
    for (k = 0; k < r->marks; k++) free(r->mark[k].x);
    if (r->slabs) dem_slabs_destroy(r->slabs);
    dem_world_destroy(r->w);
    r->w = 0;
    r->slabs = 0;
    r->marks = 0;
}
#endif
