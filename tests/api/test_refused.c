/* Every public function that takes a world, with every argument and every field of every desc bad in turn: null, NaN,
   infinite, negative, zero, an id of nothing, a name that is too long. A call that is refused must leave the world as it
   was, to the bit: the hash is the same, and so is that of each of the steps that follow. The calls are made from dem.h's
   declarations (tests/refused.awk), so a new function is among them; one with an argument of a new type does not compile
   until there is a good_ or take_ function for it here. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include <limits.h>

enum { FIELD_REAL, FIELD_DOUBLE, FIELD_INT, FIELD_POINTER };
enum { BADS = 4 };                              /* bad values of a number */
typedef struct refused_field { const char *type, *name; size_t offset; int kind; size_t size; } refused_field;
typedef struct refuser {
    dem_world *world;
    int bad, kind, spent;                       /* which argument is bad, how; 1: there is no such way */
    char what[80];                              /* in words */
} refuser;
typedef struct refused_call { const char *name; int (*call)(refuser *r); int looks; } refused_call;

/* Way k to be bad, of a number; for a real, an int. */
static double bad_number(int k) { return k == 0 ? NAN : k == 1 ? INFINITY : k == 2 ? -INFINITY : -1; }
static int bad_int(int k) { return k == 0 ? -1 : k == 1 ? INT_MIN : k == 2 ? 0 : -77; }
/* 1 where argument `at` is the bad one, in a way that there is; says which. */
static int is_bad(refuser *r, int at, int ways, const char *name) {
    if (at != r->bad) return 0;
    snprintf(r->what, sizeof r->what, "%s, way %d", name, r->kind);
    if (r->kind >= ways) r->spent = 1;
    return !r->spent;
}
static dem_real take_dem_real(refuser *r, int at, const char *name) {
    if (is_bad(r, at, BADS + 1, name)) return r->kind == BADS ? 0 : (dem_real)bad_number(r->kind);
    return strstr(name, "share") ? DEM_R(0.5) : strstr(name, "dent") ? DEM_R(0) : DEM_R(1e-3);
}
static double take_double(refuser *r, int at, const char *name) {
    return is_bad(r, at, BADS, name) ? bad_number(r->kind) : strstr(name, "budget") ? 0 : 1e-4;
}
static int take_int(refuser *r, int at, const char *name) {
    return is_bad(r, at, BADS, name) ? bad_int(r->kind) : !strcmp(name, "steps") ? 1 : 2;
}
static size_t take_size_t(refuser *r, int at, const char *name) { return is_bad(r, at, 1, name) ? 0 : 3; }
static uint64_t take_uint64_t(refuser *r, int at, const char *name) { return is_bad(r, at, 0, name) ? 0 : 1; }
static dem_vec3 take_dem_vec3(refuser *r, int at_, const char *name) {
    dem_vec3 v = at(0.01, 0.02, 0.03);
    if (is_bad(r, at_, BADS + 1, name)) v.y = r->kind == BADS ? 0 : (dem_real)bad_number(r->kind);
    if (at_ == r->bad && r->kind == BADS) v = at(0, 0, 0);
    return v;
}
static dem_quat take_dem_quat(refuser *r, int at_, const char *name) {
    dem_quat q = dem_quat_make(1, 0, 0, 0);
    if (is_bad(r, at_, 3, name)) q.x = (dem_real)bad_number(r->kind);
    return q;
}
static dem_box take_dem_box(refuser *r, int at_, const char *name) {
    dem_box b = box_of(0.02, 0.02, 0.02, 0.04, 0.04, 0.04);
    if (is_bad(r, at_, BADS + 1, name)) b.hi.y = (dem_real)(r->kind == BADS ? 0.02 : bad_number(r->kind));
    return b;
}
/* A box of bad numbers or without size, or a cylinder along no axis. */
static dem_region take_dem_region(refuser *r, int at_, const char *name) {
    dem_region g = dem_region_make(box_of(0.02, 0.02, 0.02, 0.04, 0.04, 0.04));
    if (!is_bad(r, at_, BADS + 2, name)) return g;
    if (r->kind > BADS) g.cylinder = 'w';
    else g.box.hi.y = (dem_real)(r->kind == BADS ? 0.02 : bad_number(r->kind));
    return g;
}
/* Ids: of nothing, negative, beyond all that there are. */
static int32_t take_id(refuser *r, int at_, const char *name) {
    static const int32_t none[] = {0, -1, 99, INT_MAX, INT_MIN};
    return is_bad(r, at_, 5, name) ? none[r->kind] : 1;
}
#define TAKE_ID(type) static type take_##type(refuser *r, int at_, const char *name) { type id; id.id = take_id(r, at_, name); return id; }
TAKE_ID(dem_material) TAKE_ID(dem_shape) TAKE_ID(dem_wall) TAKE_ID(dem_joint) TAKE_ID(dem_feed) TAKE_ID(dem_outlet) TAKE_ID(dem_field) TAKE_ID(dem_output) TAKE_ID(dem_group)
static dem_body take_dem_body(refuser *r, int at_, const char *name) {
    dem_body id = dem_body_id_get(r->world, 0);
    if (!is_bad(r, at_, 4, name)) return id;
    if (r->kind == 0) id.slot = 0;
    if (r->kind == 1) id.slot = 9999;
    if (r->kind == 2) id.slot = UINT32_MAX;
    if (r->kind == 3) id.generation += 77;      /* stale */
    return id;
}
static dem_edge_rule take_dem_edge_rule(refuser *r, int at_, const char *name) { return (dem_edge_rule)(is_bad(r, at_, 1, name) ? 99 : 0); }
static dem_motor take_dem_motor(refuser *r, int at_, const char *name) { return (dem_motor)(is_bad(r, at_, 1, name) ? 99 : 0); }
static dem_output_kind take_dem_output_kind(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? (dem_output_kind)99 : DEM_OUTPUT_VTP; }
static void no_change(const dem_contact_info *c, dem_real *memory, void *user) { (void)c; (void)memory; (void)user; }
static dem_contact_fn take_dem_contact_fn(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? (dem_contact_fn)0 : no_change; }
static dem_inside_fn take_dem_inside_fn(refuser *r, int at_, const char *name) { (void)is_bad(r, at_, 0, name); return 0; }
static dem_event_fn take_dem_event_fn(refuser *r, int at_, const char *name) { (void)is_bad(r, at_, 0, name); return 0; }
static dem_progress_fn take_dem_progress_fn(refuser *r, int at_, const char *name) { (void)is_bad(r, at_, 0, name); return 0; }
static void *take_out_void(refuser *r, int at_, const char *name) { (void)is_bad(r, at_, 0, name); return 0; }
static const void *take_const_void(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? 0 : "v 0"; }
static FILE *refused_file;
static FILE *take_out_FILE(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? 0 : refused_file; }
static const char *take_const_char(refuser *r, int at_, const char *name) {
    static char endless[600];
    memset(endless, 'x', sizeof endless - 1);
    if (is_bad(r, at_, 5, name))
        return r->kind == 0 ? 0 : r->kind == 1 ? "" : r->kind == 2 ? endless : r->kind == 3 ? "build/tmp" : "build/tmp/no/such/file";
    return "build/tmp/refused.out";
}
static dem_real scratch_reals[4096];
static double scratch_doubles[4096];
static uint32_t scratch_words[4096];
static dem_real *take_out_dem_real(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? 0 : scratch_reals; }
static double *take_out_double(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? 0 : scratch_doubles; }
static uint32_t *take_out_uint32_t(refuser *r, int at_, const char *name) { return is_bad(r, at_, 1, name) ? 0 : scratch_words; }
static const dem_real *take_const_dem_real(refuser *r, int at_, const char *name) {
    static dem_real good[300];
    int i;
    for (i = 0; i < 300; i++) good[i] = DEM_R(0.05) + DEM_R(0.01)*(dem_real)i;
    if (!is_bad(r, at_, BADS + 1, name)) return good;
    if (r->kind == BADS) return 0;
    good[1] = (dem_real)bad_number(r->kind);
    return good;
}
/* A good one of each type that calls take by address. */
static dem_shape good_shape;
static const dem_real corner_reals[12] = {0.1f, 0.1f, 0.1f, 0.2f, 0.1f, 0.1f, 0.1f, 0.2f, 0.1f, 0.1f, 0.1f, 0.2f};
static dem_material_desc good_dem_material_desc(refuser *r) { dem_material_desc d = DEM_MATERIAL_DESC; (void)r; d.density = 2500; d.young = DEM_R(1e6); d.poisson = DEM_R(0.25); d.restitution = DEM_R(0.5); return d; }
static dem_pair good_dem_pair(refuser *r) { dem_pair p; dem_material m; m.id = 1; dem_pair_get(r->world, m, m, &p); return p; }
static dem_sizes good_dem_sizes(refuser *r) { dem_sizes d; (void)r; memset(&d, 0, sizeof d); d.min = DEM_R(1e-3); d.max = DEM_R(2e-3); return d; }
static dem_region good_dem_region(refuser *r) { dem_region g = DEM_REGION; (void)r; g.box = box_of(0.02, 0.02, 0.02, 0.04, 0.04, 0.04); return g; }
static dem_selection good_dem_selection(refuser *r) { dem_selection s = DEM_SELECTION; (void)r; s.radius_min = 1000; return s; }
static dem_body_state good_dem_body_state(refuser *r) { dem_body_state s; dem_body_get(r->world, dem_body_id_get(r->world, 0), &s); return s; }
static dem_cluster_desc good_dem_cluster_desc(refuser *r) { dem_cluster_desc d; (void)r; memset(&d, 0, sizeof d); d.count = 2; d.positions = corner_reals; d.radius = DEM_R(0.2); return d; }
static dem_mesh good_dem_mesh(refuser *r) { static int32_t t[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}; static dem_real v[12]; dem_mesh m; (void)r; memcpy(v, corner_reals, sizeof v); memset(&m, 0, sizeof m); m.vertex_count = 4; m.triangle_count = 4; m.vertices = v; m.triangles = t; return m; }
static dem_shape good_dem_shape(refuser *r) { (void)r; return good_shape; }
static dem_profile good_dem_profile(refuser *r) { static int32_t s[2] = {0, 1}; static dem_real v[4] = {0.1f, 0.1f, 0.2f, 0.2f}; dem_profile p; (void)r; memset(&p, 0, sizeof p); p.vertex_count = 2; p.segment_count = 1; p.vertices = v; p.segments = s; return p; }
static dem_sieve_desc good_dem_sieve_desc(refuser *r) { dem_sieve_desc d; (void)r; memset(&d, 0, sizeof d); d.normal = at(0, 0, 1); d.point = at(0, 0, -1); d.aperture = DEM_R(0.01); d.bar = DEM_R(0.002); return d; }
static dem_motion good_dem_motion(refuser *r) { dem_motion m = DEM_MOTION; (void)r; m.kind = DEM_MOTION_TRANSLATING; m.velocity = at(0, 0, 1e-3); return m; }
static dem_joint_desc good_dem_joint_desc(refuser *r) { dem_joint_desc d = DEM_JOINT_DESC; d.kind = DEM_JOINT_POINT; d.a = dem_body_id_get(r->world, 0); d.b = dem_body_id_get(r->world, 1); return d; }
static dem_rail_desc good_dem_rail_desc(refuser *r) { dem_rail_desc d = DEM_RAIL_DESC; (void)r; d.axes = DEM_RAIL_Z; return d; }
static dem_feed_desc good_dem_feed_desc(refuser *r) { dem_feed_desc d = DEM_FEED_DESC; (void)r; d.material.id = 1; d.class_count = 1; d.radius[0] = DEM_R(1e-3); d.amount[0] = 1; d.rate = 1; d.box = box_of(0.02, 0.02, 0.02, 0.04, 0.04, 0.04); return d; }
static dem_outlet_desc good_dem_outlet_desc(refuser *r) { dem_outlet_desc d = DEM_OUTLET_DESC; (void)r; d.box = box_of(1, 1, 1, 2, 2, 2); return d; }
static dem_trials_desc good_dem_trials_desc(refuser *r) { dem_trials_desc d; (void)r; memset(&d, 0, sizeof d); return d; }
static dem_mixing_desc good_dem_mixing_desc(refuser *r) { dem_mixing_desc d; (void)r; memset(&d, 0, sizeof d); d.box = box_of(0, 0, 0, 1, 1, 1); d.cells[0] = d.cells[1] = d.cells[2] = 2; d.radius_max = DEM_R(0.01); return d; }
static dem_events_desc good_dem_events_desc(refuser *r) { (void)r; return DEM_EVENTS_DESC; }
static dem_field_desc good_dem_field_desc(refuser *r) { dem_field_desc d; (void)r; memset(&d, 0, sizeof d); d.box = box_of(0, 0, 0, 1, 1, 1); d.cells[0] = d.cells[1] = d.cells[2] = 2; return d; }
static dem_cell_desc good_dem_cell_desc(refuser *r) { dem_cell_desc d = DEM_CELL_DESC; (void)r; return d; }
static dem_wall_part good_dem_wall_part(refuser *r) { static const char first[] = "a"; static dem_wall_part two[2]; (void)r; memset(two, 0, sizeof two); two[0].name = two[1].name = first; two[0].material.id = two[1].material.id = 1; return two[0]; }
static dem_grains good_dem_grains(refuser *r) { static dem_real radii[2] = {0.001f, 0.001f}; static dem_real places[6]; dem_grains g; (void)r; memset(&g, 0, sizeof g); memcpy(places, corner_reals, sizeof places); g.count = 2; g.positions = places; g.radii = radii; return g; }
static dem_replay_desc good_dem_replay_desc(refuser *r) { dem_replay_desc d = DEM_REPLAY_DESC; (void)r; return d; }
static dem_output_desc good_dem_output_desc(refuser *r) { dem_output_desc d = DEM_OUTPUT_DESC; (void)r; d.kind = DEM_OUTPUT_VTP; d.path = "build/tmp/refused_####.vtp"; d.interval = 1; d.start = 1; return d; }
static dem_slabs_desc good_dem_slabs_desc(refuser *r) { dem_slabs_desc d = DEM_SLABS_DESC; (void)r; d.count = 2; return d; }
static int slabs_dropped(dem_slabs *s) { dem_slabs_destroy(s); return s != 0; }
static int replay_dropped(dem_replay *film) { if (film) dem_replay_close(film); return film != 0; }

/* Spoils field after field of a desc: 0: there is no way k. */
static int spoil(refuser *r, void *desc, const char *type);
#define TAKE_CONST(type) static const type *take_const_##type(refuser *r, int at_, const char *name) { \
    static type value[3]; \
    value[0] = value[1] = value[2] = good_##type(r); \
    if (at_ != r->bad) return value; \
    if (r->kind == 0) { snprintf(r->what, sizeof r->what, "%s null", name); return 0; } \
    r->spent = !spoil(r, value + (sizeof(type) > 4 && !strcmp(#type, "dem_wall_part")), #type); \
    return value; }
#define TAKE_OUT(type) static type *take_out_##type(refuser *r, int at_, const char *name) { \
    static type value[64]; memset(value, 0, sizeof value); return is_bad(r, at_, 1, name) ? 0 : value; }
#include "../refused.h"
static int spoil(refuser *r, void *desc, const char *type) {
    const refused_field *f = refused_fields;
    const int field = (r->kind - 1)/BADS, way = (r->kind - 1)%BADS;
    char *to;
    int k = 0;
    for (; f->type; f++) if (!strcmp(f->type, type) && k++ == field) break;
    if (!f->type) return 0;
    snprintf(r->what, sizeof r->what, "%s.%s, way %d", type, f->name, way);
    to = (char *)desc + f->offset;
    if (f->kind == FIELD_REAL) { const dem_real v = (dem_real)bad_number(way); memcpy(to, &v, sizeof v); }
    if (f->kind == FIELD_DOUBLE) { const double v = bad_number(way); memcpy(to, &v, sizeof v); }
    if (f->kind == FIELD_INT) { const int v = bad_int(way); memcpy(to, &v, sizeof v); }
    if (f->kind == FIELD_POINTER) memset(to, 0, f->size);
    return 1;
}

/* Grains in a heap and, with impulses, a joint; one of each thing that has an id. Two of them are the same to the bit. */
static dem_world *refused_world(int impulses) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material stuff;
    refuser r;
    dem_world *w;
    dem_real x[3*27];
    int i;
    memset(&r, 0, sizeof r);
    desc.gravity.z = DEM_R(-9.81);
    desc.threads = 1;
    desc.body_reals = "charge";
    desc.groups = "one";
    desc.orientations = 1;                      /* of spheres: a joint asks for them */
    desc.ledger = 1;                            /* events ask for it */
    desc.dt = impulses ? DEM_R(1e-4) : DEM_R(1e-5);
    if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
    r.world = w = dem_world_create(&desc);
    stuff = scene_material(w, 1e6, 0.5, 0.5, 0);
    dem_wall_plane_add(w, stuff, at(0, 0, 0), at(0, 0, 1));
    good_shape = dem_shape_ellipsoid_add(w, at(1e-3, 2e-3, 1e-3));
    for (i = 0; i < 27; i++) {
        x[3*i] = DEM_R(1.99e-3)*(dem_real)(i%3);
        x[3*i + 1] = DEM_R(1.99e-3)*(dem_real)(i/3%3) + DEM_R(1e-4)*(dem_real)(i/9);
        x[3*i + 2] = DEM_R(0.999e-3) + DEM_R(1.99e-3)*(dem_real)(i/9);
    }
    dem_spheres_add(w, stuff, 27, x, 0, 0, DEM_R(1e-3));
    { const dem_feed_desc d = good_dem_feed_desc(&r); dem_feed_add(w, &d); }
    { const dem_outlet_desc d = good_dem_outlet_desc(&r); dem_outlet_add(w, &d); }
    { dem_field_desc d = good_dem_field_desc(&r); d.bodies = 1; dem_field_add(w, &d); }
    if (impulses) { const dem_joint_desc d = good_dem_joint_desc(&r); dem_joint_add(w, &d); }
    dem_events_record(w, &DEM_EVENTS_DESC);
    if (dem_world_step(w, 5) != DEM_OK) printf("        %s\n", dem_world_error_get(w));
    return w;
}
/* Calls one function in every bad way. A world that took a bad call is not looked at further. */
static long refuse_all(const refused_call *one, int impulses) {
    dem_world *a = refused_world(impulses), *b = refused_world(impulses);
    const uint64_t hash = dem_world_hash_get(b);
    long refused = 0;
    int k, same = 1;
    refuser r;
    memset(&r, 0, sizeof r);
    for (r.bad = 2; r.bad < 12; r.bad++)
        for (r.kind = 0, r.spent = 0;; r.kind++) {
            r.world = a;
            r.what[0] = 0;
            a->error[0] = 0;
            /* taken, or stopped after some steps: the good call is among these */
            if (one->call(&r) || !a->error[0] || dem_world_steps_get(a) != dem_world_steps_get(b)) {
                if (!one->looks) { dem_world_destroy(a); a = refused_world(impulses); }
            } else {
                refused += !r.spent && r.what[0];
                if (dem_world_hash_get(a) != hash && same)
                    printf("        %s (%s): refused, and the hash is another: %s\n", one->name, r.what, a->error);
                same = same && dem_world_hash_get(a) == hash;
            }
            if (r.spent || !r.what[0]) break;
        }
    dem_world_error_get(a);
    for (k = 0; k < 100 && same; k++) {
        const dem_result result = dem_world_step(a, 1);
        same = result == dem_world_step(b, 1) && dem_world_hash_get(a) == dem_world_hash_get(b);
        if (!same) printf("        %s: refused %ld times, and other bits %d steps later; %s\n", one->name, refused, k + 1, dem_world_error_get(a));
    }
    CHECK(same);
    dem_world_destroy(a);
    dem_world_destroy(b);
    return refused;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    refused_file = tmpfile();
    TEST("a failing call with any bad argument changes no bit of the next 100 steps") {
        const refused_call *one;
        long refused = 0;
        int impulses;
        FILE *f = fopen("build/tmp/refused.out", "w");
        fputs("v 0 0 2\nv 1 0 2\nv 0 1 2\no a\nf 1 2 3\n", f);
        fclose(f);
        for (impulses = 0; impulses < 2; impulses++)
            for (one = refused_calls; one->name; one++)
                refused += refuse_all(one, impulses);
        CHECK(refused > 1000);
    }
    if (refused_file) fclose(refused_file);
    return test_end();
}
