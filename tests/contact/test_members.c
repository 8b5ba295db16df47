/* Contacts of clusters with springs: pairs of member spheres in the pruned neighbour list (>>members). They are compared with
   lone spheres, with closed forms, and with what the library lists, in beds of several work groups. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int wide = sizeof(dem_real) == sizeof(double);

/* A cluster of `count` spheres of radius r in a row, `pitch` apart. */
static dem_shape row(dem_world *w, int count, double r, double pitch) {
    dem_cluster_desc d = DEM_CLUSTER_DESC;
    dem_real x[30] = {0};
    int k;
    for (k = 0; k < count; k++) x[3*k] = (dem_real)((k - (count - 1)/2.0)*pitch);
    d.count = count;
    d.positions = x;
    d.radius = (dem_real)r;
    return dem_shape_cluster_add(w, &d);
}
/* A law of its own: a spring and dashpot, friction by a spring in the first three reals, a weak pull within a range. */
static void own_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_vec3 s = demi_v(memory[0], memory[1], memory[2]);
    if (!(c->overlap > 0)) { f->normal = -DEM_R(1e-4); memory[0] = memory[1] = memory[2] = 0; return; }
    f->normal = 800*c->overlap + DEM_R(0.01)*c->closing_speed;
    s = demi_add(s, demi_scale(c->slip_step, c->dt));
    demi_put(memory, s);
    f->tangent = demi_scale(s, -200);
}
/* A falling heap in a box that is periodic along x and y: spheres, clusters and ellipsoids, as `kinds` says (bits 1, 2, 4). */
static dem_world *heap(dem_world_desc desc, int kinds, int each) {
    const dem_box room = box_of(0, 0, 0, 0.008, 0.008, 0.03);
    const double r = 7e-4;
    dem_world *w;
    dem_material m;
    uint64_t seed = 9;
    int k;
    desc.dt = DEM_R(4e-6);
    desc.gravity = at(0, 0, -9.81);
    desc.domain = room;
    for (k = 0; k < 2; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    w = dem_world_create(&desc);
    m = scene_material(w, 2e6, 0.5, 0.4, 0);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    if (kinds & 2) dem_bodies_fill(w, m, row(w, 3, r, 1.2*r), dem_region_make(room), each, 5);
    if (kinds & 4) dem_bodies_fill(w, m, dem_shape_ellipsoid_add(w, at(1e-3, 7e-4, 7e-4)), dem_region_make(room), each, 6);
    if (kinds & 1) dem_spheres_fill(w, m, (dem_real)r, dem_region_make(room), each, 7);
    CHECK_STR(dem_world_error_get(w), "");
    for (k = 0; k < dem_bodies_get(w).count; k++)
        scene_move(w, dem_body_id_get(w, k), scene_at(&seed, 0.2, -0.1, 0.2, -0.1, 0, -2), at(20, 0, 0));
    return w;
}
static double sum[2000][3];
static void add_force(const dem_contact_info *c, dem_real *memory, void *user) {
    dem_world *w = (dem_world *)user;
    const double f[3] = {(double)c->force.x, (double)c->force.y, (double)c->force.z};
    int k;
    (void)memory;
    for (k = 0; k < 3; k++) {
        sum[demi_body_index(w, "test", c->a)][k] += f[k];
        if (!c->wall) sum[demi_body_index(w, "test", c->b)][k] -= f[k];
    }
}
/* Largest difference between the force on a body and the sum of its listed contacts, over the largest force. */
static double sums_apart(dem_world *w) {
    double worst = 0, most = 0;
    int i, k;
    memset(sum, 0, sizeof sum);
    CHECK_EQ(dem_world_gravity_set(w, at(0, 0, -9.81)), DEM_OK);    /* forces are computed again, with present velocities */
    CHECK(dem_contacts_each(w, add_force, w) > 5);
    for (i = 0; i < dem_bodies_get(w).count; i++)
        for (k = 0; k < 3; k++) {
            const double f = (double)w->bodies.force[4*i + k];
            worst = DEMI_MAX(worst, fabs(f - sum[i][k]));
            most = DEMI_MAX(most, fabs(f));
        }
    return worst/most;
}
enum { MIXED = 300 };
/* A bed in which every fourth body is an ellipsoid (kind 0) or a cluster of two (kind 1), or none is (kind 2). The others
   are spheres, or clusters of one sphere (lone 1). */
static dem_world *mixed_bed(int kind, int lone, int threads) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    dem_shape one = {0}, more = {0};
    uint64_t seed = 4;
    int i;
    desc.dt = DEM_R(4e-6);
    desc.gravity = at(0, 0, -98.1);
    desc.threads = threads;
    w = dem_world_create(&desc);
    m = scene_material(w, 2e6, 0.5, 0.4, 0.1);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    if (lone) one = row(w, 1, 1e-3, 0);
    if (kind < 2) more = kind ? row(w, 2, 8e-4, 6e-4) : dem_shape_ellipsoid_add(w, at(1e-3, 8e-4, 9e-4));
    for (i = 0; i < MIXED; i++) {
        const int layer = i/36;
        const dem_vec3 x = demi_scale(at(i%6 + 0.1*layer, i/6%6, 0.6 + layer), DEM_R(2.05e-3));
        const dem_quat q = scene_turn(&seed);
        const int other = kind < 2 && i%4 == 0;
        if (other || lone) dem_body_add(w, m, other ? more : one, x, q);
        else dem_sphere_add(w, m, DEM_R(1e-3), x);
    }
    return w;
}

/* A spring, and an attraction that is the same at every distance. */
static void attracts(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = (c->overlap > 0 ? 500*c->overlap : 0) - DEM_R(0.03);
}
int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a bed of clusters of one sphere moves as one of lone spheres") {
        int merged, k, i;
        for (merged = 0; merged < 2; merged++) {
            dem_world *w[2];
            double most = 0;
            for (k = 0; k < 2; k++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material m;
                dem_shape one = {0};
                uint64_t seed = 3;
                desc.dt = DEM_R(4e-6);
                desc.gravity = at(0, 0, -9.81);
                desc.cluster_contacts = merged ? DEM_CLUSTER_CONTACTS_MERGED : DEM_CLUSTER_CONTACTS_SEPARATE;
                w[k] = dem_world_create(&desc);
                m = scene_material(w[k], 2e6, 0.5, 0.4, 0.1);
                dem_wall_plane_add(w[k], m, at(0, 0, 0), at(0, 0, 1));
                if (k) one = row(w[k], 1, 1e-3, 0);
                for (i = 0; i < 125; i++) {
                    const dem_vec3 x = demi_scale(at(i%5 + 0.1*(i/25), i/5%5, 0.6 + i/25), DEM_R(2.05e-3));
                    scene_move(w[k], k ? dem_body_add(w[k], m, one, x, scene_turn(&seed)) : dem_sphere_add(w[k], m, DEM_R(1e-3), x),
                               at(0, 0, 0), at(0, 0, 0));
                    if (!k) scene_turn(&seed);
                }
                CHECK_EQ(scene_step(w[k], 2000), DEM_OK);
            }
            CHECK(dem_counters_get(w[0]).contacts > 20);
            for (i = 0; i < 125; i++) {         /* bodies keep their slots */
                const dem_vec3 x = demi_at(w[0]->bodies.pos + 4*w[0]->bodies.slot_index[i]);
                const dem_vec3 y = demi_at(w[1]->bodies.pos + 4*w[1]->bodies.slot_index[i]);
                most = DEMI_MAX(most, (double)demi_length(demi_sub(x, y)));
            }
            CHECK_NEAR(most, 0, wide ? 1e-9 : 1e-4);
            for (k = 0; k < 2; k++) dem_world_destroy(w[k]);
        }
    }
    TEST("clusters of one sphere move as spheres, alone or among others, and continue from a checkpoint on two threads") {
        int kind, k, i;
        for (kind = 0; kind < 3; kind++) {
            dem_world *w[3];
            double most = 0;
            for (k = 0; k < 3; k++) w[k] = mixed_bed(kind, k > 0, 1 + k/2);
            for (k = 0; k < 2; k++) CHECK_EQ(scene_step(w[k], 1200), DEM_OK);
            CHECK_EQ(w[1]->effects.clustered, kind == 1);
            CHECK_EQ(w[1]->effects.unlike, kind < 2 ? MIXED/4 : 0);
            CHECK(w[1]->domain_count > 7);
            CHECK_EQ(dem_checkpoint_write(w[1], "build/tmp/members.dem"), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(w[2], "build/tmp/members.dem"), DEM_OK);
            remove("build/tmp/members.dem");
            for (k = 0; k < 3; k++) CHECK_EQ(scene_step(w[k], 300), DEM_OK);
            CHECK(dem_counters_get(w[0]).contacts > 20);
            CHECK_EQ(dem_world_hash_get(w[1]), dem_world_hash_get(w[2]));
            for (i = 0; i < MIXED; i++) {
                const dem_vec3 x = demi_at(w[0]->bodies.pos + 4*w[0]->bodies.slot_index[i]);
                const dem_vec3 y = demi_at(w[1]->bodies.pos + 4*w[1]->bodies.slot_index[i]);
                most = DEMI_MAX(most, (double)demi_length(demi_sub(x, y)));
            }
            CHECK_NEAR(most, 0, wide ? 1e-6 : 5e-4);        /* radii are 1e-3 */
            for (k = 0; k < 3; k++) dem_world_destroy(w[k]);
        }
    }
    TEST("a shape that is added between two steps leaves the world as it was: checkpoint, cost of effects, next steps") {
        int kind, k;
        for (kind = 0; kind < 3; kind += 2) {       /* the cluster of two is the first larger one */
            dem_world *w[2];
            dem_effect all[DEM_EFFECTS];
            for (k = 0; k < 2; k++) w[k] = mixed_bed(kind, 1, 1);
            CHECK_EQ(scene_step(w[0], 400), DEM_OK);
            for (k = 0; k < 2; k++) row(w[k], 2, 8e-4, 6e-4);
            CHECK_EQ(dem_checkpoint_write(w[0], "build/tmp/members.dem"), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(w[1], "build/tmp/members.dem"), DEM_OK);
            remove("build/tmp/members.dem");
            CHECK_EQ(dem_effects_get(w[0], 0.02, all), DEM_EFFECTS);
            for (k = 0; k < 2; k++) CHECK_EQ(scene_step(w[k], 400), DEM_OK);
            CHECK_EQ(dem_world_hash_get(w[0]), dem_world_hash_get(w[1]));
            for (k = 0; k < 2; k++) dem_world_destroy(w[k]);
        }
    }
    TEST("two clusters that collide off centre part with the restitution of their material at the contact") {
        int turn;
        for (turn = 0; turn < 5; turn++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            const double e = 0.6, r = 1e-3, side = 1.5e-3;
            dem_world *w;
            dem_material m;
            dem_body a, b;
            dem_body_state s, o;
            dem_shape two;
            const dem_quat q = dem_quat_about(at(0, 0, 1), (dem_real)(0.1*turn));
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.dt = DEM_R(1e-7);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e8, e, 0, 0);
            two = row(w, 2, r, 2*side);
            /* spheres at the ends of two parallel dumbbells meet along z */
            a = dem_body_add(w, m, two, at(0, 0, 0), q);
            b = dem_body_add(w, m, two, demi_add(dem_quat_rotate(q, at(2*side, 0, 0)), at(0, 0, 2.001*r)), q);
            scene_move(w, b, at(0, 0, -0.1), at(0, 0, 0));
            CHECK_EQ(scene_step(w, 3000), DEM_OK);
            CHECK_EQ(dem_counters_get(w).contacts, 0);
            s = scene_state(w, a);
            o = scene_state(w, b);
            {
                const dem_vec3 arm = dem_quat_rotate(s.orientation, at(side, 0, 0));
                const dem_vec3 other = dem_quat_rotate(o.orientation, at(-side, 0, 0));
                const dem_vec3 v = demi_add(s.velocity, demi_cross(s.spin, arm));
                const dem_vec3 u = demi_add(o.velocity, demi_cross(o.spin, other));
                CHECK_NEAR(u.z - v.z, e*0.1, 2e-3*0.1);
            }
            dem_world_destroy(w);
        }
    }
    TEST("two clusters under a law that attracts across gaps keep their momentum and their angular momentum, merged or "
         "separate") {
        const dem_real place[] = {DEM_R(-4e-4), 0, DEM_R(2e-4), DEM_R(4e-4), 0, 0, 0, DEM_R(5e-4), 0};
        int separate, k;
        for (separate = 0; separate < 2; separate++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_cluster_desc three = DEM_CLUSTER_DESC;
            dem_totals before, after;
            dem_body_state s;
            dem_shape shape;
            dem_material m;
            dem_world *w;
            dem_body body;
            desc.law = attracts;
            desc.law_stiffness = 500;
            desc.law_range = DEM_R(3e-4);
            desc.cluster_contacts = separate ? DEM_CLUSTER_CONTACTS_SEPARATE : DEM_CLUSTER_CONTACTS_MERGED;
            desc.dt = DEM_R(1e-6);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e6, 1, 0, 0);
            three.count = 3;
            three.positions = place;
            three.radius = DEM_R(8e-4);
            shape = dem_shape_cluster_add(w, &three);
            dem_body_add(w, m, shape, at(0, 0, 0), dem_quat_make(1, DEM_R(0.3), DEM_R(-0.2), DEM_R(0.6)));
            body = dem_body_add(w, m, shape, at(2.6e-3, 3e-4, 1e-4),
                                dem_quat_make(1, DEM_R(-0.1), DEM_R(0.4), DEM_R(0.2)));
            s = scene_state(w, body);
            s.velocity = at(-0.5, 0.02, 0.1);
            dem_body_set(w, body, &s);
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            before = dem_totals_get(w);
            CHECK_EQ(scene_step(w, 3000), DEM_OK);
            after = dem_totals_get(w);
            for (k = 0; k < 3; k++) {
                const double part = DEMI_SINGLE ? 1e-2 : 1e-11;
                CHECK_NEAR(after.momentum[k], before.momentum[k], fabs(before.momentum[0])*part);
                CHECK_NEAR(after.angular[k], before.angular[k], fabs(before.angular[1])*part);
            }
            dem_world_destroy(w);
        }
    }
    TEST("a hit spins a cluster of one sphere whose centre of mass is off its centre by J c/I") {
        const double r = 1e-3, c = 3e-4, e = 0.6, speed = 0.1, V = 4.18879*r*r*r, moment = 0.5*V*r*r;
        const dem_real centre[3] = {0};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_cluster_desc d = DEM_CLUSTER_DESC;
        dem_world *w;
        dem_material m;
        dem_body loaded, ball;
        double J, mass;
        int k;
        desc.normal_law = DEM_NORMAL_LINEAR;
        desc.dt = DEM_R(1e-7);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e8, e, 0, 0);
        d.count = 1;
        d.positions = centre;
        d.radius = (dem_real)r;
        d.mass = DEM_CLUSTER_GIVEN;
        d.volume = (dem_real)V;
        d.centre = at(0, c, 0);
        for (k = 0; k < 3; k++) d.inertia[k] = (dem_real)moment;
        loaded = dem_body_add(w, m, dem_shape_cluster_add(w, &d), at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
        ball = dem_sphere_add(w, m, (dem_real)r, at(-2.001*r, -c, 0));
        scene_move(w, ball, at(speed, 0, 0), at(0, 0, 0));
        CHECK_EQ(scene_step(w, 1000), DEM_OK);
        CHECK_EQ(dem_counters_get(w).contacts, 0);
        mass = (double)scene_state(w, ball).mass;
        J = (1 + e)*speed/(2/mass + c*c*V/(mass*moment));
        CHECK_NEAR(scene_state(w, loaded).spin.z, J*c*V/(mass*moment), 2e-3*J*c*V/(mass*moment));
        CHECK_NEAR(scene_state(w, loaded).velocity.x, J/mass, 2e-3*J/mass);
        dem_world_destroy(w);
    }
    TEST("forces of listed contacts between spheres, clusters and ellipsoids add up to those on the bodies") {
        int kinds, way;
        for (kinds = 1; kinds < 8; kinds++)
            for (way = 0; way < 3; way++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *w;
                desc.cluster_contacts = way == 1 ? DEM_CLUSTER_CONTACTS_SEPARATE : DEM_CLUSTER_CONTACTS_MERGED;
                if (way == 2) {
                    desc.law = own_law;
                    desc.law_memory = 3;
                    desc.law_vectors = 1;
                    desc.law_stiffness = 800;
                    desc.law_range = DEM_R(5e-5);
                }
                w = heap(desc, kinds, 80);
                CHECK_EQ(scene_step(w, 5000), DEM_OK);
                CHECK(sums_apart(w) < (wide ? 1e-10 : 1e-4));
                dem_world_destroy(w);
            }
    }
    TEST("forces of listed contacts add up also where no two clusters of a work group touch each other") {
        int way, i;
        for (way = 0; way < 2; way++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *w;
            dem_material m;
            dem_shape s;
            uint64_t seed = 7;
            int alone = 0;
            desc.cluster_contacts = way ? DEM_CLUSTER_CONTACTS_SEPARATE : DEM_CLUSTER_CONTACTS_MERGED;
            desc.dt = DEM_R(1e-6);
            w = dem_world_create(&desc);
            m = scene_material(w, 2e6, 0.5, 0.4, 0);
            s = row(w, 3, 5e-4, 5e-4);
            for (i = 0; i < 64; i++)
                dem_body_add(w, m, s, demi_scale(at(i%4, i/4%4, i/16), DEM_R(1.4e-3)), scene_turn(&seed));
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            for (i = 0; i < w->domain_count; i++)
                alone += w->domains[i].near_cross == 0 && w->domains[i].near_end > 0;
            CHECK(alone > 0);
            CHECK(sums_apart(w) < (wide ? 1e-10 : 1e-4));
            dem_world_destroy(w);
        }
    }
    TEST("a heap with clusters has the same bits for lists rebuilt at every step") {
        int kinds, how;
        for (kinds = 2; kinds < 8; kinds++) {
            uint64_t hash[2];
            if (!(kinds & 2)) continue;
            for (how = 0; how < 2; how++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *w;
                int k;
                desc.threads = 1;
                desc.ledger = 1;
                desc.skin = DEM_R(2e-4);        /* chosen, it depends on how long lists last */
                w = heap(desc, kinds, 60);
                for (k = 0; k < 6000; k++) {
                    if (how) w->margin.span = 0;        /* the pruned list is rebuilt */
                    if (dem_world_step(w, 1) != DEM_OK) break;
                }
                CHECK_EQ(k, 6000);
                CHECK(dem_counters_get(w).contacts > 5);
                hash[how] = dem_world_hash_get(w);
                CHECK_EQ(hash[how], hash[0]);
                dem_world_destroy(w);
            }
        }
    }
    return test_end();
}
