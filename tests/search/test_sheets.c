/* Sheets, surfaces without thickness, separate grains: what is pressed against both sides acts as if it were alone. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

#define R 0.005
static const int fine = sizeof(dem_real) == 8;
static const dem_quat straight = {1, 0, 0, 0};
enum { BALL, EGG, CLUSTER, CUBE, BODIES };
enum { MESH, PROFILE, PERIODIC, MOVED, SIEVE, DISC, TUBE, WALLS };
enum { FREE, FIXED, SLABS, MODES };
static dem_body put(dem_world *w, dem_material m, int kind, dem_vec3 x) {
    static const dem_real at3[9] = {0, 0, 0, DEM_R(0.002), 0, 0, 0, DEM_R(0.002), 0};
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    if (kind == BALL) return dem_sphere_add(w, m, DEM_R(R), x);
    c.count = 3;
    c.positions = at3;
    c.radius = DEM_R(0.004);
    return dem_body_add(w, m, kind == EGG ? dem_shape_ellipsoid_add(w, at(R, 0.8*R, 0.9*R))
                        : kind == CLUSTER ? dem_shape_cluster_add(w, &c) : scene_box(w, R, 1.1*R, 1.2*R), x, straight);
}
/* A sheet in the plane y = 0, or at this end of it. */
static dem_wall sheet(dem_world *w, dem_material m, int kind, double end) {
    const double far = kind == PERIODIC ? 0.03 : 0.1;
    dem_real v[12] = {DEM_R(-0.1), 0, DEM_R(-0.1), 0, 0, DEM_R(-0.1), 0, 0, DEM_R(0.1), DEM_R(-0.1), 0, DEM_R(0.1)};
    const int32_t t[6] = {0, 2, 1, 0, 3, 2}, s[2] = {0, 1};
    dem_sieve_desc holes = DEM_SIEVE_DESC;
    dem_profile line;
    dem_mesh mesh;
    int i;
    for (i = 0; i < 4; i++) {
        v[3*i] = (dem_real)(i == 1 || i == 2 ? end < far ? end : far : -far);
        v[3*i + 2] = (dem_real)(i < 2 ? -far : far);
    }
    if (kind == PROFILE) {
        dem_real x[4] = {DEM_R(-0.1), 0, 0, 0};
        x[2] = (dem_real)end;
        line.vertex_count = 2; line.segment_count = 1; line.vertices = x; line.segments = (int32_t *)(size_t)s;
        return dem_wall_profile_add(w, m, &line, DEM_EDGE_RESOLVED);
    }
    if (kind == DISC || kind == TUBE) {         /* about y; about z, below the plane */
        const dem_real radii[2] = {(dem_real)(kind == DISC ? 0 : 0.05), (dem_real)(kind == DISC ? 0.1 : 0.05)};
        const dem_real heights[2] = {(dem_real)(kind == DISC ? 0 : -0.1), (dem_real)(kind == DISC ? 0 : 0.1)};
        return dem_wall_revolved_add(w, m, at(0, kind == DISC ? 0 : -0.05, 0), at(0, kind == DISC, kind == TUBE), 2,
                                     radii, heights);
    }
    if (kind == SIEVE) {                        /* its bar, at z from 8 to 18 mm */
        holes.kind = DEM_SIEVE_SQUARE;
        holes.normal = at(0, 1, 0);
        holes.along = at(1, 0, 0);
        holes.aperture = DEM_R(0.004);
        holes.bar = DEM_R(0.05);
        return dem_wall_sieve_add(w, m, &holes);
    }
    mesh.vertex_count = 4; mesh.triangle_count = 2; mesh.vertices = v; mesh.triangles = (int32_t *)(size_t)t;
    return dem_wall_mesh_add(w, m, &mesh);
}
/* What a body does that hits the sheet from above while another one, if `both`, does from below. */
static dem_body_state hit(int body, int kind, int impulses, int both, int other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *w;
    dem_material m;
    dem_body_state s;
    dem_body b[2];
    dem_wall wall;
    int i;
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.dt = impulses ? DEM_R(1e-4) : DEM_R(2e-6);
    if (impulses && fine) desc.tolerance = DEM_R(1e-9);      /* m/s: what is compared is not the solver's error */
    desc.allow_large_dt = 1;
    if (kind == PERIODIC) {
        desc.boundary[0] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(-0.03, -1, -0.03, 0.03, 1, 0.03);
    }
    w = dem_world_create(&desc);
    m = scene_material(w, impulses ? 0 : 1e7, 0.5, 0.3, 0);
    wall = sheet(w, m, kind, 0.1);
    CHECK(wall.id);
    if (kind == MOVED) {
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity = at(0, 0.1, 0.1);
        CHECK_EQ(dem_wall_motion_set(w, wall, &motion), DEM_OK);
    }
    for (i = 0; i < 1 + both; i++) {
        b[i] = put(w, m, i ? other : body, at(kind == SIEVE ? 0.027 : kind == PERIODIC ? 0.029 : 0.012 + 0.001*i, (i ? -1 : 1)*1.6*R,
                                  kind == SIEVE ? 0.027 : 0.0123));
        CHECK(b[i].slot);
        scene_move(w, b[i], at(0.2, i ? 0.5 : -0.5, 0), at(0, 0, 0));
    }
    CHECK_EQ(dem_world_run(w, 0.02, 0, 0), DEM_OK);
    s = scene_state(w, b[0]);
    dem_world_destroy(w);
    return s;
}

/* How far the body that was added last extends above or below its centre, m. */
static double reach_of(const dem_world *w, int kind, int up) {
    const demi_shape *s = w->shape_count ? &w->shapes[w->shape_count - 1] : 0;
    double most = kind == BALL ? R : kind == EGG ? 0.8*R : 0.55*R;
    int i;
    if (kind == CLUSTER)
        for (most = 0, i = 0; i < s->count; i++)
            most = fmax(most, (double)(s->parts[4*i + 3] + (up ? 1 : -1)*s->parts[4*i + 1]));
    return most;
}
/* What a body does that dips into a sheet, below which another one, if `both`, is at rest at a distance of
   0.03 radii: free or fixed, or in another slab. *moved receives the speed of the other, m/s. */
static dem_body_state dip(int body, int other, int kind, int impulses, double skin, int mode, int both, double *moved) {
    const double x = kind == PERIODIC && mode != SLABS ? 0.029 : -0.0005;
    dem_slabs_desc split = DEM_SLABS_DESC;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_selection lower = DEM_SELECTION_ZERO;
    dem_body_state s[2];
    dem_slabs *slabs;
    dem_material m;
    dem_world *w;
    dem_body b[2];
    int i, ghosts = 0;
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.dt = impulses ? DEM_R(1e-4) : DEM_R(4e-5);
    desc.threads = 1;
    desc.skin = (dem_real)skin;
    desc.domain = box_of(-0.03, -1, -0.03, 0.03, 1, 0.03);
    if (kind == PERIODIC) desc.boundary[0] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    w = dem_world_create(&desc);
    m = scene_material(w, impulses ? 0 : 1e6, 0.5, 0.3, 0);
    CHECK(sheet(w, m, kind, 0.1).id);
    for (i = 0; i < 1 + both; i++) {
        const int what = i ? other : body;
        b[i] = put(w, m, what, at(i ? -x : x, 0, 0.0123));
        CHECK(b[i].slot);
        s[i] = scene_state(w, b[i]);
        s[i].position = at(i && x < 0 ? -x : x, i ? -reach_of(w, what, 1) - 0.03*R : reach_of(w, what, 0) + 0.1*R, 0.0123);
        s[i].velocity.y = i ? 0 : DEM_R(-0.5);
        CHECK_EQ(dem_body_set(w, b[i], &s[i]), DEM_OK);
        lower.count = i;
        lower.bodies = b + i;
        if (i && mode == FIXED) CHECK_EQ(dem_bodies_fixed_set(w, &lower, 1), 1);
    }
    if (mode == SLABS) {
        split.count = 2;
        split.balance = -1;
        slabs = dem_slabs_create(w, &split);
        CHECK(slabs != 0);
        if (slabs) {
            CHECK_EQ(dem_slabs_step(slabs, 50), DEM_OK);
            for (i = 0; i < 2 && both; i++) ghosts += slabs->slabs[i].world->bodies.count - 1;
            CHECK_EQ(ghosts, both);             /* one of the two slabs has the other's body, too */
            CHECK_EQ(dem_slabs_step(slabs, 150), DEM_OK);
            CHECK_EQ(dem_slabs_collect(slabs, w), DEM_OK);
        }
        dem_slabs_destroy(slabs);
    } else CHECK_EQ(dem_world_run(w, 8e-3, 0, 0), DEM_OK);
    for (i = 0; i < 1 + both; i++) s[i] = scene_state(w, b[i]);
    *moved = both ? (double)(demi_size(s[1].velocity) + DEM_R(R)*demi_size(s[1].spin)) : 0;
    dem_world_destroy(w);
    return s[0];
}

/* Hertz's law, called in gaps, too. */
static void reaching(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    if (c->overlap > 0) dem_law_hertz(c, memory, f);
}
/* Pushes grains towards the plane y = 0 from both sides. */
static dem_vec3 inwards(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    (void)v; (void)radius; (void)time; (void)user;
    return at(0, x.y > 0 ? -20*mass : 20*mass, 0);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("sheets: bodies that hit both sides of a mesh, a profile, a periodic seam or a moving sheet bounce as if each were "
         "alone, by springs and impulses") {
        int body, kind, impulses;
        for (body = 0; body < BODIES; body++)
            for (kind = 0; kind < WALLS; kind++)
                for (impulses = 0; impulses < 2; impulses++) {
                    const double close = fine ? impulses ? 1e-5 : 1e-9 : 1e-3;
                    dem_body_state one, two;
                    if (kind == TUBE || (kind == SIEVE && (body != EGG || impulses))) continue;    /* see `dip` */
                    one = hit(body, kind, impulses, 0, body);
                    two = hit(body, kind, impulses, 1, body);
                    CHECK(one.velocity.y > DEM_R(0.1));
                    CHECK((double)demi_size(demi_sub(one.velocity, two.velocity)) < close);
                    CHECK((double)demi_size(demi_sub(one.spin, two.spin))*R < close);
                    CHECK((double)demi_size(demi_sub(one.position, two.position)) < close*R);
                }
    }

    TEST("sheets: a body that dips into a wall without thickness leaves another one below it at rest, for any skin") {
        static const double skins[] = {0, 1e-6, -1};
        int body, other, kind, impulses, mode, k;
        for (kind = 0; kind < WALLS; kind++)
            for (body = 0; body < BODIES && kind != MOVED; body++)
                for (impulses = 0; impulses < 2; impulses++) {
                    double moved;
                    const dem_body_state one = dip(body, body, kind, impulses, 0, FREE, 0, &moved);
                    CHECK(one.velocity.y > DEM_R(0.1));
                    for (mode = 0; mode < (impulses ? SLABS : MODES); mode++)
                        for (k = mode || impulses ? 2 : 0; k < 3; k++)
                            for (other = 0; other < BODIES; other++) {
                                dem_body_state two;
                                if (other != body && (k < 2 || mode || impulses || (kind + body + other)%2)) continue;
                                two = dip(body, other, kind, impulses, skins[k], mode, 1, &moved);
                                CHECK_NEAR(demi_size(demi_sub(one.velocity, two.velocity)), 0,
                                           fine ? impulses ? 1e-5 : 1e-9 : 1e-3);
                                CHECK_NEAR(moved, 0, 0);
                            }
                }
    }

    TEST("sheets: a ball that overlaps a sheet does not touch one near its other side, in either order") {
        int first, range;
        for (range = 0; range < 2; range++)
            for (first = 0; first < 2; first++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_body b[2];
                dem_world *w;
                dem_material m;
                int i;
                desc.skin = DEM_R(0.1*R);
                if (range) { desc.law = reaching; desc.law_range = DEM_R(0.3*R); }
                w = dem_world_create(&desc);
                m = scene_material(w, 1e7, 0.5, 0, 0);
                CHECK(sheet(w, m, MESH, 0.1).id);
                for (i = 0; i < 2; i++)
                    b[i] = dem_sphere_add(w, m, DEM_R(R), at(0, i == first ? 0.7*R : -1.05*R, 0.0123));
                CHECK_EQ(scene_step(w, 1), DEM_OK);
                CHECK(scene_state(w, b[first]).velocity.y > 0);
                CHECK_NEAR((double)scene_state(w, b[1 - first]).velocity.y, 0, 0);
                dem_world_destroy(w);
            }
    }

    TEST("sheets: balls on both sides of a hole touch through it, and those beside it do not") {
        int kind, beside, i, n;
        for (kind = DEM_SIEVE_NONE; kind <= DEM_SIEVE_REDUCED + 2; kind++)
            for (beside = 0; beside < 2; beside++) {
                const int other = kind > DEM_SIEVE_REDUCED;    /* holes between rows; endless slots */
                const dem_real radii[2] = {DEM_R(0.002), DEM_R(0.05)}, heights[2] = {0, 0};
                dem_sieve_desc holes = DEM_SIEVE_DESC;
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_contact_info c[8];
                dem_vec3 x = at(0, 0, 0);
                dem_material m;
                dem_world *w;
                if (kind == DEM_SIEVE_WIRES || kind == DEM_SIEVE_BARS) continue;       /* they have thickness */
                desc.skin = -1;
                w = dem_world_create(&desc);
                m = scene_material(w, 1e7, 0.5, 0.3, 0);
                if (kind == DEM_SIEVE_NONE)     /* a disc with a hole */
                    CHECK(dem_wall_revolved_add(w, m, at(0, 0, 0), at(0, 0, 1), 2, radii, heights).id);
                else {
                    holes.kind = (dem_sieve_kind)(!other ? kind : kind == DEM_SIEVE_REDUCED + 1 ? DEM_SIEVE_ROUND
                                                  : DEM_SIEVE_SLOTS);
                    holes.aperture = DEM_R(0.004);
                    holes.bar = DEM_R(0.02);
                    holes.staggered = other && holes.kind == DEM_SIEVE_ROUND;
                    holes.length = (dem_real)(holes.kind == DEM_SIEVE_SLOTS && !other ? 0.03 : 0);
                    x = at(holes.length > 0 ? 2*0.05 : holes.staggered ? 2.5*0.024 : 2*0.024,
                           (holes.staggered ? 1.7320508075688772*-1.5 : -3)*0.024, 0);
                    CHECK(dem_wall_sieve_add(w, m, &holes).id);
                }
                if (beside) x.y += DEM_R(0.012);        /* half a pitch: the middle of a bar */
                for (i = 0; i < 2; i++) put(w, m, BALL, demi_add(x, at(0, 0, (i ? -0.95 : 0.95)*R)));
                CHECK_EQ(scene_step(w, 1), DEM_OK);
                n = dem_contacts_get(w, c, 8);
                CHECK_EQ(n, beside ? 2 : kind == DEM_SIEVE_REDUCED ? 3 : 1);   /* those repel larger balls */
                for (i = 0; i < n; i++) CHECK(beside ? c[i].b.slot == 0 : c[0].b.slot > 0);
                dem_world_destroy(w);
            }
    }

    TEST("sheets: a ball and an ellipsoid on both sides of a sieve without thickness do not touch, whichever is above") {
        int above;
        for (above = 0; above < 2; above++) {
            const dem_body_state one = hit(above ? EGG : BALL, SIEVE, 0, 0, BALL);
            const dem_body_state two = hit(above ? EGG : BALL, SIEVE, 0, 1, above ? BALL : EGG);
            CHECK(one.velocity.y > DEM_R(0.1));
            CHECK((double)demi_size(demi_sub(one.velocity, two.velocity)) < (fine ? 1e-9 : 1e-3));
        }
    }

    TEST("sheets: balls beside a sheet's end touch each other, and those on both sides of it do not") {
        int beyond;
        for (beyond = 0; beyond < 2; beyond++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *w;
            dem_material m;
            dem_body b;
            desc.impact_speed = 1;
            w = dem_world_create(&desc);
            m = scene_material(w, 1e7, 1, 0, 0);
            sheet(w, m, MESH, 0);
            b = put(w, m, BALL, at(beyond ? 0.0101 : -0.001, 1.05*R, 0));
            scene_move(w, put(w, m, BALL, at(beyond ? 0.0101 : -0.001, -1.05*R, 0)), at(0, 0.5, 0), at(0, 0, 0));
            CHECK_EQ(dem_world_run(w, 0.01, 0, 0), DEM_OK);
            CHECK_NEAR((double)scene_state(w, b).velocity.y, beyond ? 0.5 : 0, fine ? 1e-3 : 1e-2);
            dem_world_destroy(w);
        }
    }

    TEST("sheets: grains on both sides of a sheet that turns give the same bits after a restart and for any threads, and "
         "almost the same path in slabs") {
        uint64_t hash[3];
        dem_world *kept[4];
        double apart = 0;
        int k, i;
        for (k = 0; k < 4; k++) {               /* 1 thread; 2; on from a checkpoint; three slabs */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_motion motion = DEM_MOTION;
            dem_world *w;
            dem_material m;
            desc.force = inwards;
            desc.threads = 1 + (k == 1);
            desc.impact_speed = 1;
            w = kept[k] = dem_world_create(&desc);
            m = scene_material(w, 1e6, 0.5, 0.3, 0);
            motion.kind = DEM_MOTION_ROTATING;
            motion.axis = at(0, 1, 0);
            motion.speed = 3;
            CHECK_EQ(dem_wall_motion_set(w, sheet(w, m, MESH, 0.1), &motion), DEM_OK);
            dem_wall_cylinder_add(w, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.06), 1);
            dem_wall_plane_add(w, m, at(0, 0, -0.02), at(0, 0, 1));
            dem_wall_plane_add(w, m, at(0, 0, 0.02), at(0, 0, -1));
            for (i = 0; i < 2; i++)
                dem_spheres_fill(w, m, DEM_R(0.003), dem_region_make(box_of(-0.04, i ? -0.035 : 0.005, -0.015, 0.04,
                                                                            i ? -0.005 : 0.035, 0.015)), 60, 3);
            if (k < 2) CHECK_EQ(dem_world_run(w, 0.1, 0, 0), DEM_OK);
            if (k == 1) CHECK_EQ(dem_checkpoint_write(w, "build/tmp/sheets.dem"), DEM_OK);
            if (k >= 2) CHECK_EQ(dem_checkpoint_read(w, "build/tmp/sheets.dem"), DEM_OK);
            if (k == 3) {
                dem_slabs_desc split = DEM_SLABS_DESC;
                dem_slabs *slabs;
                split.axis = 0;
                split.count = 3;
                slabs = dem_slabs_create(w, &split);
                CHECK(slabs != 0);
                CHECK_EQ(dem_slabs_step(slabs, 600), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, w), DEM_OK);
                dem_slabs_destroy(slabs);
            } else CHECK_EQ(scene_step(w, 600), DEM_OK);
            if (k < 3) hash[k] = dem_world_hash_get(w);
        }
        CHECK(hash[1] == hash[0] && hash[2] == hash[0]);
        for (i = 0; i < kept[0]->bodies.slot_count; i++) {
            const dem_vec3 a = demi_at(kept[0]->bodies.pos + 4*kept[0]->bodies.slot_index[i]);
            const dem_vec3 b = demi_at(kept[3]->bodies.pos + 4*kept[3]->bodies.slot_index[i]);
            apart = fmax(apart, (double)demi_size(demi_sub(a, b)));
        }
        CHECK(apart < (fine ? 1e-7 : 1e-2)*R);     /* rounding, after 600 steps of a heap */
        for (k = 0; k < 4; k++) dem_world_destroy(kept[k]);
    }
    return test_end();
}
