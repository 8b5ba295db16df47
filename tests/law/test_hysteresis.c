/* The hysteretic normal law with adhesion, DEM_NORMAL_HYSTERETIC: its branches one by one, what it
   loses in a loop and in an impact, what it takes to tear a sticky pair apart, and grains at rest. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

enum { KL = 1000, KUN = 4000, KAD = 500 };          /* N/m; e = .5 */
static const double q = (KUN + KAD)/(double)(KUN - KL);  /* depth over overlap on the pulling line */

static dem_material_desc sticky(double kun, double kad) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2500;
    m.poisson = DEM_R(0.25);
    m.stiffness = KL;
    m.stiffness_unloading = (dem_real)kun;
    m.stiffness_adhesion = (dem_real)kad;
    return m;
}
static dem_world *world_of(double dt, double g) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.normal_law = DEM_NORMAL_HYSTERETIC;
    desc.ledger = 1;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.gravity = at(0, 0, -g);
    return dem_world_create(&desc);
}

/* The law alone, at an overlap, on a memory. */
static double force_at(double overlap, dem_real *memory, dem_contact_energy *part) {
    dem_contact c;
    dem_contact_force push;
    memset(&c, 0, sizeof c);
    memset(&push, 0, sizeof push);
    c.normal = at(1, 0, 0);
    c.overlap = (dem_real)overlap;
    c.kn = KL; c.kun = KUN; c.kad = KAD;
    c.dt = 1;                                    /* with 0 the history stays */
    dem_law_hysteretic(&c, memory, &push);
    if (part) *part = push.energy;
    return (double)push.normal;
}
/* Goes to an overlap in small steps; answers the work done by the force against the path, and adds
   up what the law says it dissipated. */
static double walk(double from, double to, dem_real *memory, double *lost) {
    const int n = 20000;
    double work = 0, before = force_at(from, memory, 0);
    int i;
    for (i = 1; i <= n; i++) {
        dem_contact_energy part;
        const double x = from + (to - from)*i/n, f = force_at(x, memory, &part);
        work += (f + before)/2*(to - from)/n;
        *lost += (double)(part.dashpot + part.sag);
        before = f;
    }
    return work;
}

/* Fires a grain at a fixed one at a speed (m/s), contact time over `steps`; speed after over before,
   0 when it stays. */
static double impact(const dem_material_desc *m, double speed, int steps, double *residual,
                     double *lost) {
    dem_world *world = world_of(0, 0);
    dem_material stuff = dem_material_add(world, m);
    dem_body a = dem_sphere_add(world, stuff, DEM_R(0.01), at(-0.0200001, 0, 0));
    dem_body b = dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0));
    dem_body_state s = scene_state(world, b);
    dem_world_desc desc;
    dem_coefficients k;
    dem_ledger l;
    double e, mass;
    s.fixed = 1;
    dem_body_set(world, b, &s);
    mass = (double)scene_state(world, a).mass;
    dem_coefficients_get(world, stuff, stuff, DEM_R(0.01), DEM_R(0.01), &k);
    desc = dem_world_desc_get(world);
    dem_world_destroy(world);

    desc.dt = (dem_real)(3.14159265358979/sqrt((double)k.kun/mass)/steps);
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, m);
    a = dem_sphere_add(world, stuff, DEM_R(0.01), at(-0.0200001, 0, 0));
    b = dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0));
    s = scene_state(world, b);
    s.fixed = 1;
    dem_body_set(world, b, &s);
    scene_move(world, a, at(speed, 0, 0), at(0, 0, 0));
    CHECK_EQ(scene_step(world, (int)(1.3*1e-7/speed/(double)desc.dt) + 12*steps), DEM_OK);
    l = dem_ledger_get(world);
    if (residual) *residual = fabs(l.residual)/(mass*speed*speed/2);
    if (lost) *lost = l.normal/(mass*speed*speed/2);
    e = dem_counters_get(world).contacts ? 0 : -(double)scene_state(world, a).velocity.x/speed;
    dem_world_destroy(world);
    return e;
}

static void read_depth(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)c;
    *(double *)user = (double)memory[0];
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a hysteretic contact loads along k_l, unloads along k_un and is free of force at (1 - k_l/k_un) of its "
         "maximum") {
        dem_real memory[DEMI_MEMORY] = {0};
        CHECK_REL(force_at(0.001, memory, 0), KL*0.001, 1e-12);
        CHECK_REL(force_at(0.002, memory, 0), KL*0.002, 1e-12);
        CHECK_REL(force_at(0.0018, memory, 0), KL*0.002 - KUN*0.0002, 1e-12);
        CHECK_NEAR(force_at(0.002*(1 - KL/(double)KUN), memory, 0), 0, 1e-12); /* eq 2.44 */
        CHECK_REL(force_at(0.002, memory, 0), KL*0.002, 1e-12);  /* and back on the same line */
        CHECK_REL(force_at(0.003, memory, 0), KL*0.003, 1e-12);
    }

    TEST("a hysteretic contact attracts most at d_ad = (1 - e2) k_l D/(k_l + k_ad e2), and less down to zero overlap") {
        dem_real memory[DEMI_MEMORY] = {0};
        const double D = 0.003, e2 = KL/(double)KUN, d_ad = (1 - e2)*KL*D/(KL + KAD*e2);
        CHECK_REL(d_ad, D/q, 1e-12);             /* eq 2.49, adhesion as a size, is (kun - kl)/(kun + kad) */
        force_at(D, memory, 0);
        CHECK_REL(force_at(d_ad*1.01, memory, 0), KUN*d_ad*1.01 - (KUN - KL)*D, 1e-9);
        CHECK_REL(force_at(d_ad, memory, 0), -KAD*d_ad, 1e-9);
        CHECK_REL(force_at(d_ad/2, memory, 0), -KAD*d_ad/2, 1e-12);
        CHECK_NEAR(force_at(1e-12, memory, 0), 0, 1e-9);
        CHECK_NEAR((double)memory[0], 0, 1e-11);
    }

    TEST("a hysteretic contact reloads with slope k_un from every branch and joins the loading line where the two "
         "cross") {
        static const double turn[4] = {0.0029, 0.0021, 0.0015, 0.0004};  /* pushing to pulling */
        int i;
        for (i = 0; i < 4; i++) {
            dem_real memory[DEMI_MEMORY] = {0};
            double from, D;
            force_at(0.003, memory, 0);
            from = force_at(turn[i], memory, 0);
            D = (double)memory[0];
            CHECK_REL(D, turn[i] > 0.003/q ? 0.003 : q*turn[i], 1e-12);
            CHECK_NEAR(force_at(turn[i] + 1e-5, memory, 0), from + KUN*1e-5, 1e-9);
            CHECK_NEAR(force_at(turn[i], memory, 0), from, 1e-9);
            CHECK_REL(force_at(D, memory, 0), KL*D, 1e-9);
            CHECK_REL(force_at(1.1*D, memory, 0), 1.1*KL*D, 1e-9);
        }
    }

    TEST("a hysteretic contact dissipates the area of its loop on any path") {
        static const double path[] = {0, 0.003, 0.0024, 0.0028, 0.0011, 0.0025, 0.0035, 0.0002,
                                      0.0009, 0};
        dem_real memory[DEMI_MEMORY] = {0};
        double work = 0, lost = 0, one = 0;
        int i;
        for (i = 1; i < (int)(sizeof path/sizeof *path); i++)
            work += walk(path[i - 1], path[i], memory, &lost);
        CHECK_REL(lost, work, 1e-4);             /* trapezia of 20000 parts a leg cut its corners */
        CHECK(work > 0);
        memset(memory, 0, sizeof memory);
        lost = 0;
        one = walk(0, 0.003, memory, &lost) + walk(0.003, 0, memory, &lost);
        /* triangle above the axis, and the one below it */
        CHECK_REL(one, KL*0.003*0.003/2*(1 - KL/(double)KUN) +
                  KAD*0.003/q*(1 - KL/(double)KUN)*0.003/2, 1e-6);
        CHECK_REL(lost, one, 1e-6);
    }

    TEST("without adhesion the restitution of the hysteretic law is sqrt(k_l/k_un) at any speed") {
        static const double kun[3] = {1100, 4000, 25000};
        int i, k;
        for (i = 0; i < 3; i++)
            for (k = 0; k < 2; k++) {
                const dem_material_desc m = sticky(kun[i], 0);
                double lost = 0, residual = 0;
                const double e = impact(&m, k ? 2 : 0.02, 200, &residual, &lost);
                CHECK_NEAR(e, sqrt(KL/kun[i]), 1e-3);
                CHECK_NEAR(lost, 1 - KL/kun[i], 2e-3);
                CHECK(residual < 1e-3);          /* dt = t_c/200, second order */
            }
    }

    TEST("a contact without adhesion lasts pi/2 (sqrt(m/k_l) + sqrt(m/k_un)); restitution may replace k_un") {
        dem_world *world = world_of(0, 0);
        dem_material_desc m = sticky(0, 0);
        dem_material a, b;
        dem_coefficients k;
        dem_advice advice;
        double mass;
        m.restitution = DEM_R(0.5);
        a = dem_material_add(world, &m);
        m = sticky(KUN, 0);
        b = dem_material_add(world, &m);
        CHECK_EQ(dem_coefficients_get(world, a, b, DEM_R(0.01), 0, &k), DEM_OK);
        mass = (double)k.m_eff;
        CHECK_REL(k.kun, KUN, 1e-6);
        CHECK_REL(k.contact_time, 3.14159265358979/2*(sqrt(mass/KL) + sqrt(mass/KUN)), 1e-6);
        dem_sphere_add(world, a, DEM_R(0.01), at(0, 0, 0.01));
        dem_wall_plane_add(world, b, at(0, 0, 0), at(0, 0, 1));
        CHECK_EQ(dem_step_advice_get(world, &advice), DEM_OK);
        CHECK_REL(advice.contact_time, 3.14159265358979*sqrt(mass/KUN), 1e-6); /* steepest branch */
        dem_world_destroy(world);
    }

    TEST("a fast sticky grain leaves with the energy that its loop leaves it, and a slow one stays") {
        /* The loop loses k_l D2/2 (1 - e2)(1 + kad/(kl q)); all scale with v2: so whether it leaves
           hangs on the stiffnesses alone, and a wall of gravity is needed to tell speeds apart. */
        const dem_material_desc weak = sticky(KUN, 100), strong = sticky(KUN, 1800);
        const double e2 = KL/(double)KUN;
        const double left = 1 - (1 - e2)*(1 + 100*(KUN - KL)/(double)(KUN + 100)/KL);
        double residual = 0;
        CHECK_NEAR(impact(&weak, 0.5, 400, &residual, 0), sqrt(left), 2e-3);
        CHECK(residual < 1e-3);
        CHECK_NEAR(impact(&weak, 0.05, 400, &residual, 0), sqrt(left), 2e-3);
        CHECK(1 - (1 - e2)*(1 + 1800*(KUN - KL)/(double)(KUN + 1800)/KL) < 0);
        CHECK_NEAR(impact(&strong, 0.5, 400, &residual, 0), 0, 0);
        CHECK(residual < 2e-3);
    }

    TEST("a sticky grain hangs from a ceiling under loads below the maximum adhesive force, and falls above it") {
        /* pressed to D by a push, it can hold kad d_ad; its weight is chosen around that */
        static const double load[2] = {0.97, 1.03};
        int i;
        for (i = 0; i < 2; i++) {
            const dem_material_desc m = sticky(KUN, KAD);
            const double radius = 0.01, mass = 2500*4/3.0*3.14159265358979*1e-6, D = 2e-4;
            const double pull = KAD*D/q, g = load[i]*pull/mass;
            dem_world *world = world_of(2e-5, g);
            dem_material stuff = dem_material_add(world, &m);
            dem_body grain;
            int k;
            dem_wall_plane_add(world, stuff, at(0, 0, 0.5), at(0, 0, -1));
            grain = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, 0.5 - radius + D));
            scene_step(world, 1);                /* it now remembers D */
            /* let it down slowly: its speed is taken from it at every step, until it is settled */
            for (k = 0; k < 6000; k++) {
                scene_move(world, grain, at(0, 0, 0.98*(double)scene_state(world, grain).velocity.z),
                           at(0, 0, 0));
                scene_step(world, 1);
            }
            CHECK_EQ(dem_counters_get(world).wall_contacts, i == 0);
            dem_world_destroy(world);
        }
    }

    TEST("a sticky pair separated slowly or at once ends free of force, and its next contact starts fresh") {
        static const double away[2] = {0.002, 3};
        int i;
        for (i = 0; i < 2; i++) {
            const dem_material_desc m = sticky(KUN, KAD);
            dem_world *world = world_of(2e-5, 0);
            dem_material stuff = dem_material_add(world, &m);
            dem_body a = dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0)), b;
            dem_contact_info info;
            double most = 0;
            int k;
            b = dem_sphere_add(world, stuff, DEM_R(0.01), at(0.0197, 0, 0));
            scene_step(world, 1);
            for (k = 0; k < 20000 && dem_contacts_get(world, &info, 1) > 0; k++) {
                most = fmax(most, (double)info.force.x);        /* on a, towards b: a pull */
                scene_move(world, a, at(0, 0, 0), at(0, 0, 0));
                scene_move(world, b, at(away[i], 0, 0), at(0, 0, 0));
                scene_step(world, 1);
            }
            CHECK(k > 1 && k < 20000);
            if (i == 0) CHECK_REL(most, KAD*0.0003/q, 0.01);    /* met every 4e-8 m of the way */
            scene_move(world, a, at(0, 0, 0), at(0, 0, 0));
            scene_move(world, b, at(0, 0, 0), at(0, 0, 0));
            scene_step(world, 1);
            CHECK_NEAR(scene_state(world, a).force.x, 0, 0);
            {
                dem_body_state s = scene_state(world, b);
                s.position = at((double)scene_state(world, a).position.x + 0.0199, 0, 0);
                dem_body_set(world, b, &s);
                scene_step(world, 1);
                CHECK_EQ(dem_contacts_get(world, &info, 1), 1);
                CHECK_REL(-(double)info.force.x, KL*(double)info.overlap, 1e-3);  /* it moved on by v dt */
            }
            dem_world_destroy(world);
        }
    }

    TEST("maximum overlaps survive rebuilt lists and exchanged pairs, with friction and rolling of every kind") {
        static const dem_tangent_law tangents[3] = {DEM_TANGENT_NONE, DEM_TANGENT_SPRING,
                                                    DEM_TANGENT_MINDLIN_RESCALED};
        int i, k;
        for (i = 0; i < 6; i++) {
            dem_material_desc m = sticky(KUN, KAD);
            dem_world *world;
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material stuff;
            dem_contact_info before, after;
            desc.normal_law = DEM_NORMAL_HYSTERETIC;
            desc.tangent_law = tangents[i%3];
            desc.threads = 1;
            desc.dt = DEM_R(1e-9);               /* nothing moves */
            world = dem_world_create(&desc);
            m.friction = DEM_R(0.3);
            m.rolling_friction = i < 3 ? 0 : DEM_R(0.1);
            stuff = dem_material_add(world, &m);
            dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0));
            dem_sphere_add(world, stuff, DEM_R(0.01), at(0.0190, 0, 0));
            dem_world_step(world, 1);
            for (k = 0; k < 2; k++) {            /* one of them drawn back: unloading */
                dem_body_state s = scene_state(world, dem_body_id_get(world, k));
                s.position.x += s.position.x > DEM_R(0.01) ? DEM_R(0.0001) : 0;
                dem_body_set(world, dem_body_id_get(world, k), &s);
            }
            dem_world_step(world, 1);
            dem_contacts_get(world, &before, 1);
            CHECK_NEAR(fabs((double)before.force.x), KUN*0.0009 - (KUN - KL)*0.001, 1e-4);
            /* grains far to the left push the two to other places in the arrays, the last first */
            for (k = 0; k < 7; k++)
                dem_sphere_add(world, stuff, DEM_R(0.01), at(-0.1 - 0.05*(k%3), 0.1*k, 0.2));
            for (k = 0; k < 2; k++) {
                dem_body_state s = scene_state(world, dem_body_id_get(world, k));
                (void)s;
                dem_candidates_rebuild(world);
                dem_world_step(world, 1);
            }
            dem_contacts_get(world, &after, 1);
            CHECK_NEAR(fabs((double)after.force.x), fabs((double)before.force.x), 1e-6);
            dem_world_destroy(world);
        }
    }

    TEST("a grain on a slope held by static friction neither trembles nor creeps, sticky or not") {
        int i;
        for (i = 0; i < 2; i++) {
            dem_material_desc m = sticky(1.2*KL, i ? KAD : 0);
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material stuff;
            dem_body a;
            dem_pair pair;
            dem_body_state first, last;
            const double angle = 0.2;
            desc.normal_law = DEM_NORMAL_HYSTERETIC;
            desc.threads = 1;
            desc.gravity = at(9.81*sin(angle), 0, -9.81*cos(angle));
            world = dem_world_create(&desc);
            m.friction = DEM_R(0.25);            /* tan(.2) = .203 */
            m.friction_static = DEM_R(0.35);
            m.rolling_friction = DEM_R(0.3);     /* or it would roll */
            stuff = dem_material_add(world, &m);
            dem_pair_get(world, stuff, stuff, &pair);
            pair.normal_damping = 1;             /* along k_un nothing else is lost */
            dem_pair_set(world, stuff, stuff, &pair);
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
            a = dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0.0099));
            CHECK_EQ(dem_world_run(world, 3, 0, 0), DEM_OK);
            first = scene_state(world, a);
            CHECK_EQ(dem_world_run(world, 3, 0, 0), DEM_OK);
            last = scene_state(world, a);
            CHECK_NEAR(last.velocity.x, 0, 1e-6);   /* the Coulomb jump would give mu g dt = 1e-3 */
            CHECK_NEAR(last.velocity.z, 0, 1e-5);
            CHECK_NEAR(last.position.x, (double)first.position.x, 1e-6);
            dem_world_destroy(world);
        }
    }

    TEST("a contact keeps its maximum overlap when friction is set or removed: ball on ball, ball and cluster on a "
         "plane") {
        static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
        static const dem_real radii[2] = {DEM_R(0.006), DEM_R(0.006)};
        double height[6][3];
        int run, i;
        for (run = 0; run < 6; run++) {         /* ball on ball, or none that touch */
            const int how = run%3;              /* none; friction, then rolling friction too; and gone again */
            dem_world *world = world_of(1e-5, 9.81);
            const dem_material_desc d = sticky(KUN, 0);
            const dem_material m = dem_material_add(world, &d);
            dem_cluster_desc c = DEM_CLUSTER_DESC;
            dem_body body[3];
            dem_pair pair;
            c.count = 2;
            c.positions = places;
            c.radii = radii;
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            body[0] = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.0099));
            body[1] = dem_sphere_add(world, m, DEM_R(0.01), run < 3 ? at(0, 0, 0.0297) : at(0.3, 0, 0.0099));
            body[2] = dem_body_add(world, m, dem_shape_cluster_add(world, &c), at(0.1, 0, 0.0059),
                                   dem_quat_make(1, 0, 0, 0));
            scene_step(world, 300);             /* past the turning point, on the line of unloading */
            for (i = 0; i < 2 && how; i++) {
                dem_pair_get(world, m, m, &pair);
                pair.friction = DEM_R(0.3);
                pair.rolling_friction = i ? DEM_R(0.1) : 0;
                if (how == 2 && i) pair.friction = pair.rolling_friction = 0;
                dem_pair_set(world, m, m, &pair);
                if (!i) {                       /* also while there is no list, and by way of a file */
                    dem_sphere_add(world, m, DEM_R(0.01), at(1, 1, 1));
                    CHECK_EQ(dem_checkpoint_write(world, "build/tmp/depth.ckpt"), DEM_OK);
                    CHECK_EQ(dem_checkpoint_read(world, "build/tmp/depth.ckpt"), DEM_OK);
                    remove("build/tmp/depth.ckpt");
                }
                scene_step(world, 20);
            }
            scene_step(world, how ? 160 : 200);
            for (i = 0; i < 3; i++) height[run][i] = (double)scene_state(world, body[i]).position.z;
            dem_world_destroy(world);
        }
        for (run = 0; run < 6; run++)
            for (i = 0; i < 3; i++) CHECK_NEAR(height[run][i], height[run/3*3][i], DEMI_SINGLE ? 1e-7 : 1e-15);
    }
    TEST("values of the hysteretic law outside their limits are rejected with the value named") {
        dem_world *world = world_of(0, 0);
        dem_material_desc m = sticky(KL/2, 0);
        CHECK_EQ(dem_material_add(world, &m).id, 0);
        CHECK_STR(dem_world_error_get(world), "stiffness_unloading is 500");
        m = sticky(KUN, -3);
        CHECK_EQ(dem_material_add(world, &m).id, 0);
        CHECK_STR(dem_world_error_get(world), "stiffness_adhesion is -3");
        m = sticky(0, 0);
        CHECK_EQ(dem_material_add(world, &m).id, 0);
        CHECK_STR(dem_world_error_get(world), "restitution is 0");
        m = sticky(KUN, 0);
        m.restitution = DEM_R(0.7);
        CHECK_EQ(dem_material_add(world, &m).id, 0);
        CHECK_STR(dem_world_error_get(world), "give one of the two");
        m.restitution = DEM_R(0.5);
        CHECK(dem_material_add(world, &m).id > 0);
        dem_world_destroy(world);
    }

    TEST("reading contacts of a body that was moved in and back leaves the maximum overlap as it was") {
        int wall;
        for (wall = 0; wall < 2; wall++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc m = scene_stuff(0, 0.5, 0, 0);
            dem_world *world;
            dem_material stuff;
            dem_body body;
            dem_body_state s;
            double depth = 0;
            desc.dt = DEM_R(1e-6);
            desc.normal_law = DEM_NORMAL_HYSTERETIC;
            world = dem_world_create(&desc);
            m.stiffness = DEM_R(1e4);
            stuff = dem_material_add(world, &m);
            if (wall) dem_wall_plane_add(world, stuff, at(0, 0, 0), at(1, 0, 0));
            else dem_sphere_add(world, stuff, DEM_R(0.01), at(-0.01, 0, 0));
            body = dem_sphere_add(world, stuff, DEM_R(0.01), at(0.01 - 1e-5, 0, 0));
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            s = scene_state(world, body);
            s.position.x -= DEM_R(1e-4);               /* 1.1e-4 m deep, but in no step */
            dem_body_set(world, body, &s);
            CHECK_EQ(dem_contacts_each(world, read_depth, &depth), 1);
            CHECK_NEAR(depth, 1e-5, 1e-8);
            s.position.x += DEM_R(1e-4);
            dem_body_set(world, body, &s);
            CHECK_EQ(dem_contacts_each(world, read_depth, &depth), 1);
            CHECK_NEAR(depth, 1e-5, 1e-8);
            CHECK_REL(scene_state(world, body).force.x, 0.1, 1e-2);    /* k_l times 1e-5 m: it still loads */
            dem_world_destroy(world);
        }
    }
    TEST("what a hysteretic contact loses because a grain was placed or moved into overlap is booked once, and supplied") {
        int moved;
        for (moved = 0; moved < 3; moved++) {
            const dem_material_desc m = sticky(KUN, 0);
            dem_world *world = world_of(1e-6, 0);
            const dem_material stuff = dem_material_add(world, &m);
            const double d = 1e-5, work = KL*d*d/2, lost = work*(1 - (double)KL/KUN);
            const double at_first = moved ? 0.02 : 0.01 - d;
            double depth = 0;
            dem_body body;
            dem_body_state s;
            dem_ledger l;
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(1, 0, 0));
            body = dem_sphere_add(world, stuff, DEM_R(0.01), at(at_first, 0, 0));
            if (moved) CHECK_EQ(scene_step(world, 1), DEM_OK);
            if (moved == 2) {                          /* deeper, read there, and back, in no step */
                s = scene_state(world, body);
                s.position.x = (dem_real)(0.01 - 5*d);
                dem_body_set(world, body, &s);
                CHECK_EQ(dem_contacts_each(world, read_depth, &depth), 1);
            }
            s = scene_state(world, body);
            s.position.x = (dem_real)(0.01 - d);
            dem_body_set(world, body, &s);
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            l = dem_ledger_get(world);
            CHECK_REL(l.growth, work, 1e-3);
            CHECK_REL(l.normal, lost, 1e-3);
            CHECK_REL(l.elastic, work - lost, 1e-3);
            CHECK_NEAR(l.residual, 0, 1e-4*work);
            CHECK_EQ(scene_step(world, 4000), DEM_OK);         /* it leaves with the rest */
            l = dem_ledger_get(world);
            CHECK_REL(l.kinetic, work - lost, 1e-2);
            CHECK_NEAR(l.residual, 0, 1e-2*work);
            dem_world_destroy(world);
        }
    }

    return test_end();
}
