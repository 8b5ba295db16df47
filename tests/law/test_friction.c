/* Static friction above that of sliding: what a contact that slides remembers. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double half_turn = 3.14159265358979323846;
static const double mu_slide = 0.3, mu_hold = 0.6, g_earth = 9.81, ball = 0.005;

/* What slides, and on what. Spheres are spun at constant speed, since they would roll; the others
   lie on a belt. */
enum { SPHERE_ON_PLANE, SPHERE_ON_SPHERE, CLUSTER_ON_BELT, BOX_ON_BELT, CARRIERS };
static const char *const carriers[] = {"sphere on plane", "sphere on sphere", "cluster", "box"};
typedef struct slide {
    int carrier;
    dem_world_desc desc;
    double dt;                     /* s; 0: chosen by dem.h */
    double belt;                   /* m/s, slip */
    double stiffness, damping;     /* N/m, N s/m: of the spring that holds the slider back */
    /* results */
    dem_world *world;
    dem_body body;
    dem_vec3 rest;                 /* m, where that spring is slack */
    double mass, torque_time;      /* kg; s, of the controller of the spin */
} slide;
/* The spring along x and, for spheres, a stiff guide along y and a controller of the spin. */
static void slide_held(const dem_body_state *body, dem_body id, double time, dem_vec3 *force,
                       dem_vec3 *torque, void *user) {
    const slide *s = (const slide *)user;
    const double inertia = 0.4*s->mass*ball*ball, per = inertia/s->torque_time;
    (void)time;
    if (id.slot != s->body.slot) return;
    force->x = (dem_real)(s->stiffness*((double)s->rest.x - (double)body->position.x) -
                          s->damping*(double)body->velocity.x);
    force->y = (dem_real)(s->stiffness*((double)s->rest.y - (double)body->position.y) -
                          s->damping*(double)body->velocity.y);
    if (s->carrier > SPHERE_ON_SPHERE) {         /* as if it pulled at the height of the belt: */
        torque->y = -(dem_real)ball*force->x;    /* no point of contact is pressed more than another */
        return;
    }
    torque->x = (dem_real)(-per*(double)body->spin.x);
    torque->y = (dem_real)(per*(-s->belt/ball - (double)body->spin.y));
    torque->z = (dem_real)(-per*(double)body->spin.z);
}
/* The user's law: Hertz and the spring of Cundall and Strack. */
static void slide_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, 0, f);
    dem_law_spring(c, memory, f);
}
static dem_shape slide_shape(slide *s) {
    const dem_real spots[9] = {DEM_R(0.01), 0, 0, DEM_R(-0.005), DEM_R(0.00866), 0, DEM_R(-0.005),
                               DEM_R(-0.00866), 0};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    if (s->carrier == BOX_ON_BELT) return scene_box(s->world, 4*ball, 4*ball, 2*ball);
    cluster.count = 3;
    cluster.positions = spots;
    cluster.radius = (dem_real)ball;
    return dem_shape_cluster_add(s->world, &cluster);
}
static void slide_begin(slide *s) {
    dem_material_desc m = scene_stuff(1e7, 0.3, mu_slide, 0);
    dem_motion motion = DEM_MOTION;
    dem_material stuff;
    dem_wall plane;
    const double high = s->carrier == SPHERE_ON_SPHERE ? 3*ball : ball;
    m.friction_static = (dem_real)mu_hold;
    s->desc.gravity = at(0, 0, -g_earth);
    s->desc.threads = 1;
    s->desc.dt = (dem_real)s->dt;
    s->desc.body_force = slide_held;
    s->desc.force_user = s;
    s->world = dem_world_create(&s->desc);
    stuff = dem_material_add(s->world, &m);
    plane = dem_wall_plane_add(s->world, stuff, at(0, 0, 0), at(0, 0, 1));
    if (s->carrier == SPHERE_ON_SPHERE) {
        dem_body_state fixed;
        const dem_body below = dem_sphere_add(s->world, stuff, (dem_real)ball, at(0, 0, ball));
        fixed = scene_state(s->world, below);
        fixed.fixed = 1;
        dem_body_set(s->world, below, &fixed);
    }
    if (s->carrier > SPHERE_ON_SPHERE) {
        const dem_shape shape = slide_shape(s);
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity = at(s->belt, 0, 0);
        dem_wall_motion_set(s->world, plane, &motion);
        s->body = dem_body_add(s->world, stuff, shape, at(0, 0, high), dem_quat_make(1, 0, 0, 0));
    } else s->body = dem_sphere_add(s->world, stuff, (dem_real)ball, at(0, 0, high));
    s->mass = (double)scene_state(s->world, s->body).mass;
    s->rest = at(0, 0, high);
}
/* Mean of the spring's force over the second half of `time` of a steady slide, over mu N. */
static double steady(slide s, double time) {
    double sum = 0;
    int n = 0;
    slide_begin(&s);
    s.stiffness = mu_slide*s.mass*g_earth/1e-6;            /* gives way by 1e-6 m */
    s.damping = 2*sqrt(s.stiffness*s.mass);          /* critical: it never catches up with the belt */
    s.torque_time = s.desc.response == DEM_RESPONSE_IMPULSES ? 2e-3 : 2e-5;
    CHECK_EQ(dem_world_run(s.world, time/2, 0, 0), DEM_OK);
    while (dem_world_time_get(s.world) < time && dem_world_step(s.world, 1) == DEM_OK) {
        sum += s.stiffness*(double)scene_state(s.world, s.body).position.x;
        n++;
    }
    dem_world_destroy(s.world);
    return fabs(sum/n)/(mu_slide*s.mass*g_earth);
}
static slide slide_of(int carrier, double dt) {
    slide s;
    memset(&s, 0, sizeof s);
    s.carrier = carrier;
    s.dt = dt;
    s.belt = 1e-3;
    s.torque_time = 1;
    s.desc = DEM_WORLD_DESC;
    return s;
}

/* A law whose contacts of larger spheres slide. memory[0]: 1 + what the contact returned last; 0 at its beginning. */
static int slide_calls, slide_wrong;
static void says_sliding(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const int slides = c->r_eff > DEM_R(0.00501), keeps = *(const int *)c->user;
    const int last = keeps && memory[0] > DEM_R(1.5);
    if (c->overlap > 0) {
        slide_calls++;
        slide_wrong += (c->sliding > 0) != last;
    }
    f->normal = 1000*c->overlap;
    f->sliding = c->dt > 0 ? (dem_real)slides : c->sliding;
    if (c->dt > 0) memory[0] = (dem_real)(1 + slides);
}
DEM_LAW_ROWS(says_sliding_rows, says_sliding, 1)

int main(int argc, char **argv) {
    int carrier, fine, k;
    test_begin(argc, argv);

    TEST("the mean force of a steady slide is mu N for any time step") {
        for (carrier = 0; carrier < CARRIERS; carrier++)
            for (fine = 0; fine < 2; fine++) {
                const slide s = slide_of(carrier, fine ? 2e-6 : 1.2e-5);
                /* 1e-6 m of way aside turn the normal by 1e-4: 3e-4 of mu N on a sphere */
                CHECK_NEAR(steady(s, 0.06), 1, 0.005);
                if (test_now.wrong) printf("    %s\n", carriers[carrier]);
            }
    }

    TEST("every friction law keeps a sliding body sliding at mu N") {
        static const dem_slider sliders[] = {DEM_SLIDER_PARALLEL, DEM_SLIDER_REMAINDER, DEM_SLIDER_SPRING};
        for (k = DEM_TANGENT_VISCOUS; k <= DEM_TANGENT_MINDLIN_RESCALED; k++)
            for (carrier = 0; carrier < CARRIERS; carrier++) {
                slide s = slide_of(carrier, 1.2e-5);
                s.desc.tangent_law = (dem_tangent_law)k;
                if (k <= DEM_TANGENT_STEP) s.belt = 0.05;        /* those without a spring creep below */
                s.desc.slider = sliders[(k + carrier)%3];
                s.desc.ledger = carrier & 1;
                CHECK_NEAR(steady(s, 0.06), 1, 0.005);
                if (test_now.wrong) printf("    law %d, %s\n", k, carriers[carrier]);
            }
    }

    TEST("a user-defined law that calls a friction law slides at mu N") {
        for (carrier = 0; carrier < CARRIERS; carrier++) {
            slide s = slide_of(carrier, 1.2e-5);
            s.desc.law = slide_law;
            s.desc.law_memory = carrier == CLUSTER_ON_BELT ? (int)DEM_LAW_MEMORY : 3;
            s.desc.law_vectors = 1;
            CHECK_NEAR(steady(s, 0.06), 1, 0.005);
        }
    }

    TEST("steady sliding under impulses takes mu N, too") {
        for (carrier = 0; carrier < CARRIERS; carrier++)
            for (fine = 0; fine < 2; fine++) {
                slide s = slide_of(carrier, fine ? 5e-5 : 2e-4);
                s.desc.response = DEM_RESPONSE_IMPULSES;
                s.belt = 0.05;
                CHECK_NEAR(steady(s, 0.2), 1, 0.005);
                if (test_now.wrong) printf("    %s\n", carriers[carrier]);
            }
    }

    /* A slider of mass m on a belt of speed v, held by a spring K, w^2 = K/m, sticks until the spring
       pulls with mu_s m g, slips to as far below mu m g, and sticks again:
       T = 2 A/v + 2/w (pi - atan(A w/v)), A = (mu_s - mu) m g/K. A cluster's three springs are unequally
       stretched when it sticks, so that one lets go before the others: there 2 % are missing. */
    TEST("a slider on a belt sticks and slips with the period of the closed form") {
        for (k = 0; k < 4; k++) {
            const double w = 60, v = 0.02, A = (mu_hold - mu_slide)*g_earth/(w*w);
            const double period = 2*A/v + 2/w*(half_turn - atan(A*w/v));
            slide s = slide_of(k == 3 ? CLUSTER_ON_BELT : BOX_ON_BELT, k > 1 ? 5e-5 : k ? 6e-6 : 1.2e-5);
            double last = 0, before = 0, x = 0, rising = 0;
            int n = 0;
            s.belt = v;
            if (k > 1) s.desc.response = DEM_RESPONSE_IMPULSES;
            slide_begin(&s);
            s.stiffness = w*w*s.mass;
            while (n < 5 && dem_world_time_get(s.world) < 6*period) {    /* instants of the largest pull */
                CHECK_EQ(dem_world_step(s.world, 1), DEM_OK);
                before = x;
                x = (double)scene_state(s.world, s.body).velocity.x;
                if (before > 0 && x <= 0 && dem_world_time_get(s.world) - last > period/4) {
                    if (n == 1) rising = dem_world_time_get(s.world);
                    last = dem_world_time_get(s.world);
                    n++;
                }
            }
            CHECK_EQ(n, 5);
            /* springs: the contact itself gives way by some 1e-3 of A */
            CHECK_NEAR((last - rising)/3/period, 1, 0.01);
            if (test_now.wrong) printf("    %s, response %d\n", carriers[s.carrier], k > 1);
            dem_world_destroy(s.world);
        }
    }

    TEST("an impact of a slipping sphere takes mu (1 + e) v under springs and impulses, however far ahead impulses look") {
        static const double dts[] = {1e-6, 1e-3, 1e-4, 1e-5};
        for (k = 0; k < 4; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc m = scene_stuff(1e8, 0.8, 0.1, 0);
            dem_material stuff;
            dem_world *world;
            dem_body body;
            dem_vec3 before = at(5, 0, -0.5);
            int bounces = 0, steps;
            m.friction_static = DEM_R(0.5);
            desc.gravity = at(0, 0, -g_earth);
            desc.threads = 1;
            desc.dt = (dem_real)dts[k];
            desc.response = k ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
            world = dem_world_create(&desc);
            stuff = dem_material_add(world, &m);
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
            body = dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0.0101));
            scene_move(world, body, before, at(0, 0, 0));
            for (steps = 0; bounces < 3 && steps < 200000; steps++) {
                dem_body_state s;
                dem_vec3 v;
                if (dem_world_step(world, 1) != DEM_OK) break;
                s = scene_state(world, body);
                v = s.velocity;
                if (!((double)s.position.z > 0.01)) continue;          /* in contact */
                if (v.z > 0 && before.z < 0) {
                    CHECK_NEAR((double)(before.x - v.x)/(0.1*1.8*(double)-before.z), 1, 0.1);
                    bounces++;
                    before = v;
                }
                if (v.z < 0) before = v;
            }
            CHECK_EQ(bounces, 3);
            dem_world_destroy(world);
        }
    }
    TEST("static friction set and removed in mid-run keeps springs and the user's memory") {
        for (k = 0; k < 2*CARRIERS; k++) {
            slide s = slide_of(k%CARRIERS, 1.2e-5), t = s;
            dem_material stuff = {1};
            dem_pair pair;
            int e;
            if (k/CARRIERS) { s.desc.law = slide_law; s.desc.law_memory = 3; s.desc.law_vectors = 1; }
            t.desc = s.desc;
            slide_begin(&s);
            slide_begin(&t);
            s.stiffness = t.stiffness = 0.2*s.mass*g_earth/1e-5;     /* holds: below mu N */
            s.damping = t.damping = 2*sqrt(s.stiffness*s.mass);
            s.rest.x = t.rest.x = DEM_R(0.7e-5);
            s.belt = t.belt = 0;
            s.torque_time = t.torque_time = 2e-5;
            for (e = 0; e < 4; e++) {
                scene_step(s.world, 50);
                scene_step(t.world, 50);
                dem_pair_get(s.world, stuff, stuff, &pair);
                CHECK_EQ(dem_pair_set(s.world, stuff, stuff, &pair), DEM_OK);
                pair.friction_static = e & 1 ? (dem_real)mu_hold : pair.friction;
                CHECK_EQ(dem_pair_set(t.world, stuff, stuff, &pair), DEM_OK);
                dem_candidates_rebuild(s.world);
                dem_candidates_rebuild(t.world);
            }
            scene_step(s.world, 50);
            scene_step(t.world, 50);
            CHECK_NEAR((double)scene_state(s.world, s.body).position.x,
                       (double)scene_state(t.world, t.body).position.x, 0);
            dem_world_destroy(s.world);
            dem_world_destroy(t.world);
        }
    }

    TEST("a user-defined law receives its own sliding of the last step if a pair has static friction, "
         "and otherwise 0") {
        int keeps, rows, i;
        for (keeps = 0; keeps < 2; keeps++)
            for (rows = 0; rows < 2; rows++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material_desc stuff = scene_stuff(1e7, 0.5, mu_slide, 0);
                dem_world *w;
                dem_material m;
                desc.threads = 1;                      /* the law counts its calls */
                desc.law = says_sliding;
                if (rows) desc.law_rows = says_sliding_rows;
                desc.law_user = &keeps;
                desc.law_memory = 1;
                desc.law_stiffness = 1000;
                desc.dt = DEM_R(1e-5);
                w = dem_world_create(&desc);
                if (keeps) stuff.friction_static = (dem_real)mu_hold;
                m = dem_material_add(w, &stuff);
                for (i = 0; i < 100; i++) {            /* pairs, alternately of two sizes */
                    const double r = i & 1 ? 0.01 : 0.011;
                    dem_sphere_add(w, m, (dem_real)r, at(0.1*i, 0, 0));
                    dem_sphere_add(w, m, (dem_real)r, at(0.1*i + 2*r - 1e-4, 0, 0));
                }
                slide_calls = slide_wrong = 0;
                CHECK_EQ(scene_step(w, 10), DEM_OK);
                CHECK(slide_calls >= 1000);
                CHECK_EQ(slide_wrong, 0);
                dem_world_destroy(w);
            }
    }
    return test_end();
}
