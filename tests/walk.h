/* walk.h - every field of every desc, found by reading the declarations in dem.h: what a test does with all of them
   covers a field that is added, or fails and names it. Include after dem.h and test.h, with dem.h in the folder where
   the test runs.

       walk_scene base = walk_begin(WALK_SPRINGS);           // every desc of a small scene
       const walk_fields *all = walk_all();                  // name, type and offset of each number in it
       walk_change(&all->field[k], &base, way);              // another value; 0: there is none of that number
       dem_world *world = walk_make(&base);                  // null: some call refused it */
#ifndef WALK_H
#define WALK_H
#include <stddef.h>

/* What a scene is made of; `walk_all` reads this declaration, too. */
typedef struct walk_scene {
    dem_world_desc world;
    dem_material_desc material;
    dem_pair pair;
    dem_sieve_desc sieve;
    dem_motion motion;
    dem_cluster_desc cluster;
    dem_feed_desc feed;
    dem_outlet_desc outlet;
    dem_field_desc field;
    dem_joint_desc joint;
    dem_vec3 plane_point, plane_normal, cylinder_point, cylinder_axis, velocity, spin;
    dem_real cylinder_radius;
} walk_scene;
enum { WALK_SPRINGS, WALK_LAW, WALK_HYSTERETIC, WALK_PLANAR, WALK_IMPULSES, WALKS };

/* --- the fields, from the text of the declarations --- */

enum { WALK_FIELDS = 800 };
typedef struct walk_field {
    char name[72], of[24];       /* as in C; of a pointer: what to */
    char type;                   /* i: int or enum, u: uint64_t, r: dem_real, d: double, p: pointer */
    size_t offset;
} walk_field;
typedef struct walk_fields {
    int count, wrong;            /* wrong: declarations that were not understood */
    walk_field field[WALK_FIELDS];
} walk_fields;
/* Fields that a struct declares by a macro, written out. */
#define WALK_STRING(...) #__VA_ARGS__
#define WALK_FIELDS_OF(...) WALK_STRING(__VA_ARGS__)
static inline void walk_expand(char *text, const char *macro, const char *fields) {
    while ((text = strstr(text, macro)) != 0) {
        memmove(text + strlen(fields), text + strlen(macro), strlen(text + strlen(macro)) + 1);
        memcpy(text, fields, strlen(fields));
    }
}
/* Reads files, one behind the other, without comments. */
static inline char *walk_text(void) {
    static const char *const names[] = {"dem.h", "tests/walk.h"};
    char *text = (char *)calloc(1, 4000000);
    size_t n = 0;
    int k, c, before;
    for (k = 0; k < 2 && text; k++) {
        char path[64] = "../../../";            /* the folder of a case of tests/check.sh is three below the top */
        FILE *f = fopen(names[k], "rb");
        if (!f) f = fopen(strcat(path, names[k]), "rb");
        CHECK(f != 0);
        if (!f) continue;
        for (before = 0; (c = fgetc(f)) != EOF && n < 3999990; before = c) {
            if (before == '/' && c == '*') {
                n--;
                for (before = 0; (c = fgetc(f)) != EOF && !(before == '*' && c == '/'); before = c) {}
                c = ' ';
            }
            text[n++] = (char)c;
        }
        fclose(f);
    }
    walk_expand(text, "DEM_LAW_COEFFICIENTS(DEM_PROPERTY_FIELD)",
                WALK_FIELDS_OF(DEM_LAW_COEFFICIENTS(DEM_PROPERTY_FIELD)));
    return text;
}
static inline size_t walk_size(char type) {
    return type == 'i' ? 4 : type == 'u' ? sizeof(uint64_t) : type == 'r' ? sizeof(dem_real)
        : type == 'd' ? sizeof(double) : sizeof(void *);
}
static inline size_t walk_align(char type) {
    typedef struct { char c; uint64_t x; } walk_u;
    typedef struct { char c; dem_real x; } walk_r;
    typedef struct { char c; double x; } walk_d;
    typedef struct { char c; void *x; } walk_p;
    return type == 'i' ? 4 : type == 'u' ? offsetof(walk_u, x) : type == 'r' ? offsetof(walk_r, x)
        : type == 'd' ? offsetof(walk_d, x) : offsetof(walk_p, x);
}
static inline int walk_letter(int c) { return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
static inline const char *walk_find(const char *text, const char *before, const char *word, const char *after) {
    char all[96];
    snprintf(all, sizeof all, "%s%s%s", before, word, after);
    return strstr(text, all);
}
static inline size_t walk_struct(const char *text, const char *word, const char *name, size_t offset, size_t *align,
                          walk_fields *out);
/* A declarator of the type `word` at *size (of the struct so far); the struct begins at `offset`. */
static inline void walk_declare(const char *text, const char *word, const char *name, int pointer, int count, size_t offset,
                         size_t *size, size_t *align, walk_fields *out) {
    const char type = pointer || walk_find(text, "(*", word, ")(") ? 'p' : !strcmp(word, "int") ||
        !strcmp(word, "int32_t") || !strcmp(word, "uint32_t") || walk_find(text, "typedef enum ", word, " {") ? 'i'
        : !strcmp(word, "uint64_t") ? 'u' : !strcmp(word, "dem_real") ? 'r' : !strcmp(word, "double") ? 'd' : 0;
    int k;
    for (k = 0; k < count; k++) {
        char one[72];
        size_t a = type ? walk_align(type) : 1, n;
        if (count > 1) snprintf(one, sizeof one, "%.56s[%d]", name, k);
        else snprintf(one, sizeof one, "%.68s", name);
        if (!type) {                             /* twice: its alignment comes out of reading it */
            const int before = out->count;
            walk_struct(text, word, one, 0, &a, out);
            out->count = before;
        }
        if (*align < a) *align = a;
        *size = (*size + a - 1)/a*a;
        if (!type) n = walk_struct(text, word, one, offset + *size, &a, out);
        else {
            n = walk_size(type);
            if (out->count < WALK_FIELDS) {
                walk_field *f = &out->field[out->count++];
                snprintf(f->name, sizeof f->name, "%s", one);
                snprintf(f->of, sizeof f->of, "%.23s", word);
                f->type = type;
                f->offset = offset + *size;
            } else out->wrong++;
        }
        *size += n;
    }
}
/* The fields of a struct; answers its size. */
static inline size_t walk_struct(const char *text, const char *word, const char *name, size_t offset, size_t *align,
                          walk_fields *out) {
    const char *at = walk_find(text, "typedef struct ", word, " {"), *end;
    size_t size = 0;
    *align = 1;
    if (!at) { printf("        no declaration of %s for %s\n", word, name); out->wrong++; return 0; }
    for (at = strchr(at, '{') + 1; (end = strchr(at, ';')) != 0 && memchr(at, '}', (size_t)(end - at)) == 0; at = end + 1) {
        char type[40] = "", field[72];
        while (at < end) {                       /* words before the first declarator; const, struct are no types */
            size_t n = 0;
            while (!walk_letter(*at) && *at != '*' && *at != '(' && at < end) at++;
            while (walk_letter(at[n])) n++;
            if (!n) break;
            if (*type && strcmp(type, "const") && strcmp(type, "struct")) break;
            snprintf(type, sizeof type, "%.*s", (int)n, at);
            at += n;
        }
        while (at < end) {                       /* declarators: *name[count], or a pointer to a function */
            const int function = memchr(at, '(', (size_t)(end - at)) != 0;
            int pointer = 0, count = 1;
            size_t n = 0;
            for (; at < end && !walk_letter(*at); at++) pointer |= *at == '*';
            while (walk_letter(at[n])) n++;
            snprintf(field, sizeof field, "%s%s%.*s", name, *name ? "." : "", (int)n, at);
            at += n;
            if (*at == '[') {
                const char *number = ++at;
                char many[40];
                for (n = 0; walk_letter(at[n]); n++) {}
                snprintf(many, sizeof many, "%.*s", (int)n, at);
                if (many[0] > '9') number = walk_find(text, "enum { ", many, " = ");
                if (number && many[0] > '9') number = strchr(number, '=') + 1;
                count = number ? atoi(number) : 0;
                if (!count) out->wrong++;
                at += n + 1;
            }
            walk_declare(text, type, field, pointer || function, count, offset, &size, align, out);
            at = function ? end : at;
            while (at < end && *at != ',') at++;
        }
    }
    return (size + *align - 1) / *align * *align;
}
/* All of walk_scene; made once. */
static inline const walk_fields *walk_all(void) {
    static walk_fields all;
    size_t align;
    char *text;
    if (all.count) return &all;
    text = walk_text();
    CHECK_EQ(walk_struct(text, "walk_scene", "", 0, &align, &all), sizeof(walk_scene));
    CHECK_EQ(all.wrong, 0);
    free(text);
    return &all;
}

/* --- values --- */

static inline void walk_law(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    push->normal = 1000*c->overlap + c->closing_speed/100;
    if (c->dt > 0) memory[3] += c->dt;
}
DEM_LAW_ROWS(walk_law_rows, walk_law, 6)
static inline void walk_rate(const dem_contact *c, dem_real *rates) { rates[0] = c->overlap; }
static inline dem_vec3 walk_force(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    (void)v; (void)radius; (void)time; (void)user;
    return dem_vec3_make(-mass*x.x, 0, 0);
}
static inline void walk_body_force(const dem_body_state *b, dem_body id, double time, dem_vec3 *f, dem_vec3 *t, void *user) {
    (void)id; (void)time; (void)t; (void)user;
    f->y = -b->mass*b->position.y;
}
static inline void walk_reals(dem_real *reals, const dem_real *rates, const dem_body_state *b, dem_body id, double time,
                       dem_real dt, void *user) {
    (void)rates; (void)b; (void)id; (void)time; (void)user;
    reals[0] += dt;
}
static inline dem_real walk_growth(const dem_body_state *b, dem_body id, double time, void *user) {
    (void)b; (void)time; (void)user;
    return (dem_real)(1e-5*(id.slot%2));        /* m/s */
}
static inline void walk_motion(double time, dem_pose *pose, void *user) { (void)time; (void)pose; (void)user; }
static inline int walk_inside(dem_vec3 x, dem_real radius, void *user) { (void)radius; (void)user; return x.x > 0; }
static dem_motion_row walk_rows[8], walk_rows_other[8];       /* the walk changes their count, too */
static dem_sizes walk_sizes[2];
static dem_real walk_centres[24] = {0, 0, 0, DEM_R(8e-4), 0, 0}, walk_centres_other[24] = {0, 0, 0, 0, DEM_R(7e-4), 0};
/* Another address of the kind of pointer that `f` is; 0: none is known. */
static inline int walk_pointer(const walk_field *f, void *out) {
#define WALK_TO(name, kind, value) \
    if (!strcmp(f->of, name)) { kind *p = value; memcpy(out, &p, sizeof p); return 1; }
#define WALK_FUNCTION(name, value) \
    if (!strcmp(f->of, #name)) { name p = value; memcpy(out, &p, sizeof p); return 1; }
    WALK_FUNCTION(dem_law_fn, walk_law) WALK_FUNCTION(dem_law_rows_fn, walk_law_rows)
    WALK_FUNCTION(dem_law_rate_fn, walk_rate) WALK_FUNCTION(dem_force_fn, walk_force)
    WALK_FUNCTION(dem_body_force_fn, walk_body_force) WALK_FUNCTION(dem_reals_fn, walk_reals)
    WALK_FUNCTION(dem_growth_fn, walk_growth)
    WALK_FUNCTION(dem_motion_fn, walk_motion) WALK_FUNCTION(dem_inside_fn, walk_inside)
    WALK_TO("char", const char, "b a") WALK_TO("dem_motion_row", const dem_motion_row, walk_rows_other)
    WALK_TO("dem_sizes", const dem_sizes, &walk_sizes[1]) WALK_TO("dem_real", const dem_real, walk_centres_other)
    if (!strcmp(f->of, "void") && !strstr(f->name, "_fn")) { void *p = walk_sizes; memcpy(out, &p, sizeof p); return 1; }
    return 0;
}
/* Another value of a field, the way-th; 0: there are no more ways. */
static inline int walk_change(const walk_field *f, walk_scene *s, int way) {
    static const double factor[] = {1.25, 0.75, 1, 1, 1, 1}, plus[] = {0, 0, 1, 1e-3, 1e-6, 0.3};
    static const int more[] = {1, -1, 2, 3, -2, 5};
    char *at = (char *)s + f->offset;
    double d = 0;
    dem_real r = 0;
    int32_t i;
    uint64_t u;
    void *p;
    if (way > 5) return 0;
    switch (f->type) {
    case 'i': memcpy(&i, at, sizeof i); i += more[way]; memcpy(at, &i, sizeof i); return 1;
    case 'u': memcpy(&u, at, sizeof u); u++; memcpy(at, &u, sizeof u); return way == 0;
    case 'p':
        if (way > 1) return 0;
        if (way == 0) return walk_pointer(f, at);
        p = 0;
        memcpy(at, &p, sizeof p);
        return 1;
    case 'd': memcpy(&d, at, sizeof d); break;
    default: memcpy(&r, at, sizeof r); d = (double)r;
    }
    d = d*factor[way] + plus[way];
    r = (dem_real)d;
    if (f->type == 'd') memcpy(at, &d, sizeof d);
    else memcpy(at, &r, sizeof r);
    return 1;
}
static inline void walk_put(const walk_field *f, walk_scene *s, double d) {
    const dem_real r = (dem_real)d;
    if (f->type == 'd') memcpy((char *)s + f->offset, &d, sizeof d);
    if (f->type == 'r') memcpy((char *)s + f->offset, &r, sizeof r);
}

/* --- the scene --- */

static inline walk_scene walk_begin(int kind) {
    walk_scene s;
    int k;
    memset(&s, 0, sizeof s);
    for (k = 0; k < 8; k++) {
        walk_rows[k].time = walk_rows_other[k].time = 0.01*k;
        walk_rows[k].position.z = k == 1 ? DEM_R(1e-4) : 0;
        walk_rows_other[k].position.z = k == 1 ? DEM_R(2e-4) : 0;
    }
    for (k = 0; k < 2; k++) { walk_sizes[k].min = DEM_R(4e-4); walk_sizes[k].max = DEM_R(k ? 6e-4 : 5e-4); }
    s.world.threads = 1;
    s.world.gravity.z = kind == WALK_PLANAR ? 0 : DEM_R(-9.81);
    if (kind == WALK_PLANAR) s.world.gravity.y = DEM_R(-9.81);
    s.world.domain = dem_box_make(DEM_R(-0.1), DEM_R(-0.1), DEM_R(-0.1), DEM_R(0.1), DEM_R(0.1), DEM_R(0.1));
    s.world.dt = kind == WALK_IMPULSES ? DEM_R(1e-4) : DEM_R(1e-6);
    s.world.body_reals = "heat";
    s.world.groups = "one two";
    s.world.ledger = 1;
    if (kind == WALK_LAW) { s.world.law = walk_law; s.world.law_who = 1; s.world.law_memory = 6; s.world.law_stiffness = 1000; s.world.law_memory_names = "a b c d e f"; }
    if (kind == WALK_HYSTERETIC) s.world.normal_law = DEM_NORMAL_HYSTERETIC;
    if (kind == WALK_IMPULSES) { s.world.response = DEM_RESPONSE_IMPULSES; s.world.orientations = 1; s.world.tolerance = DEM_R(1e-5); }
    s.material.density = 2500; s.material.young = DEM_R(1e6); s.material.poisson = DEM_R(0.25);
    s.material.restitution = s.material.friction = DEM_R(0.5); s.material.rolling_friction = DEM_R(0.1);
    if (kind == WALK_HYSTERETIC) { s.material.stiffness = 1000; s.material.stiffness_unloading = 2000; s.material.restitution = 0; }
    s.pair.young_eff = DEM_R(5e5); s.pair.shear_eff = DEM_R(1e5); s.pair.restitution = DEM_R(0.6);
    s.pair.friction = DEM_R(0.4); s.pair.tangent_damping = 1; s.pair.stiffness = 800; s.pair.stiffness_ratio = DEM_R(0.8);
    s.sieve.kind = kind == WALK_SPRINGS ? DEM_SIEVE_SLOTS : kind == WALK_LAW ? DEM_SIEVE_WIRES
        : kind == WALK_HYSTERETIC ? DEM_SIEVE_REDUCED : DEM_SIEVE_ROUND;
    s.sieve.point.z = DEM_R(-0.05); s.sieve.aperture = DEM_R(1e-3); s.sieve.bar = DEM_R(5e-4);
    if (s.sieve.kind == DEM_SIEVE_SLOTS) s.sieve.length = DEM_R(5e-3);
    if (s.sieve.kind != DEM_SIEVE_WIRES && s.sieve.kind != DEM_SIEVE_REDUCED) s.sieve.thickness = DEM_R(4e-4);
    s.motion.kind = kind == WALK_SPRINGS ? DEM_MOTION_ROTATING : kind == WALK_LAW ? DEM_MOTION_TABLE
        : kind == WALK_IMPULSES ? DEM_MOTION_TRANSLATING : DEM_MOTION_OSCILLATING;
    s.motion.axis.z = 1; s.motion.velocity.z = DEM_R(1e-3); s.motion.speed = 1; s.motion.amplitude = DEM_R(1e-5);
    s.motion.frequency = 50; s.motion.ramp = 1e-3;
    if (kind == WALK_LAW) { s.motion.table = walk_rows; s.motion.table_count = 3; }
    s.cluster.count = 2; s.cluster.positions = walk_centres; s.cluster.radius = DEM_R(6e-4); s.cluster.rays = 32;
    s.cluster.mass = kind == WALK_LAW ? DEM_CLUSTER_GIVEN : kind == WALK_SPRINGS ? DEM_CLUSTER_UNION : DEM_CLUSTER_SUM;
    s.cluster.volume = DEM_R(2e-9); s.cluster.inertia[0] = s.cluster.inertia[1] = s.cluster.inertia[2] = DEM_R(4e-16);
    s.cluster.centre.x = DEM_R(4e-4);
    s.feed.material.id = 1; s.feed.class_count = 2; s.feed.rate = kind == WALK_IMPULSES ? 400 : 4e4; s.feed.seed = 3;
    s.feed.radius[0] = DEM_R(5e-4); s.feed.radius[1] = DEM_R(4e-4); s.feed.amount[0] = s.feed.amount[1] = 3;
    s.feed.box = dem_box_make(0, 0, DEM_R(0.02), DEM_R(0.02), DEM_R(0.02), DEM_R(0.03));
    if (kind == WALK_PLANAR) s.feed.box = dem_box_make(0, DEM_R(0.02), DEM_R(-0.01), DEM_R(0.02), DEM_R(0.03), DEM_R(0.01));
    s.feed.spread = DEM_R(0.1);
    if (kind == WALK_SPRINGS) s.feed.sizes[0] = &walk_sizes[0];
    s.outlet.box = dem_box_make(-1, -1, DEM_R(-0.09), 1, 1, DEM_R(-0.08));
    s.outlet.class_count = 2; s.outlet.radius[0] = DEM_R(4e-4); s.outlet.radius[1] = DEM_R(1e-3);
    s.field.box = dem_box_make(0, 0, 0, DEM_R(0.01), DEM_R(0.01), DEM_R(0.01));
    for (k = 0; k < 3; k++) s.field.cells[k] = 2;
    s.field.interval = 1e-5;
    s.joint.kind = DEM_JOINT_REVOLUTE; s.joint.motor = DEM_MOTOR_SPEED;
    s.joint.point.x = DEM_R(1e-3); s.joint.axis.z = 1; s.joint.speed = 1; s.joint.torque = DEM_R(1e-6);
    s.plane_normal.z = kind == WALK_PLANAR ? 0 : 1;
    s.plane_normal.y = kind == WALK_PLANAR;
    s.cylinder_axis.z = 1; s.cylinder_radius = DEM_R(0.05);
    return s;
}
/* A world of this scene: grains on a moving plane, a cylinder around them; but for planar ones a sieve and a cluster;
   with impulses a joint. Null, with the sentence in *why, where a call refuses it. */
static inline dem_world *walk_make(const walk_scene *s, char *why) {
    dem_world *w = dem_world_create(&s->world);
    dem_body body[5];
    dem_material m;
    dem_wall plane;
    int i, good;
    if (why) *why = 0;
    if (!w) { if (why) snprintf(why, 512, "%s", dem_world_create_error_get(&s->world)); return 0; }
    memset(body, 0, sizeof body);
    m = dem_material_add(w, &s->material);
    dem_material_add(w, &s->material);
    dem_pair_set(w, m, m, &s->pair);
    plane = dem_wall_plane_add(w, m, s->plane_point, s->plane_normal);
    dem_wall_motion_set(w, plane, &s->motion);
    dem_wall_cylinder_add(w, m, s->cylinder_point, s->cylinder_axis, s->cylinder_radius, 1);
    for (i = 0; i < 4; i++) {
        const double up = 0.998e-3 + 1.99e-3*(i/2), aside = 1.99e-3*(i%2);
        const dem_vec3 x = s->plane_normal.y > 0 ? dem_vec3_make((dem_real)aside, (dem_real)up, 0)
            : dem_vec3_make((dem_real)aside, 0, (dem_real)up);
        body[i] = dem_sphere_add(w, m, DEM_R(1e-3), x);
    }
    if (!s->world.planar && !(s->plane_normal.y > 0)) {
        const dem_shape pair = dem_shape_cluster_add(w, &s->cluster);
        dem_wall_sieve_add(w, m, &s->sieve);
        body[4] = dem_body_add(w, m, pair, dem_vec3_make(0, DEM_R(5e-3), DEM_R(0.7e-3)), dem_quat_make(1, 0, 0, 0));
    }
    if (s->world.response == DEM_RESPONSE_IMPULSES) {
        dem_joint_desc j = s->joint;
        j.a = body[0];
        j.b = body[1];
        dem_joint_add(w, &j);
    }
    dem_feed_add(w, &s->feed);
    dem_outlet_add(w, &s->outlet);
    dem_field_add(w, &s->field);
    {
        dem_body_state state;
        good = dem_body_get(w, body[3], &state) == DEM_OK;
        state.velocity = dem_vec3_make(s->velocity.x + DEM_R(0.1), s->velocity.y, s->velocity.z);
        state.spin = s->spin;
        good = good && dem_body_set(w, body[3], &state) == DEM_OK;
    }
    if (good && !*dem_world_error_get(w)) return w;
    if (why) snprintf(why, 512, "%s", dem_world_error_get(w));
    dem_world_destroy(w);
    return 0;
}
#endif
