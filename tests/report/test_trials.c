/* dem_trials_run: trials on copies of a scene, judged by observables. Whether the advice holds is asked of
   runs of their own, which last longer. Which of several good trials is the cheapest is a matter of the
   machine, so sentences here ask what holds for any. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* Scenes: a heap in a tube, a gas that cools, a slice of a mill. All moduli times `stiffness`. */
typedef enum advise_scene { ADVISE_PILE, ADVISE_GAS, ADVISE_MILL } advise_scene;
static dem_world *advise_world(advise_scene scene, double dt, double stiffness) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *world;
    dem_material glass;
    dem_wall drum;
    int i;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    if (scene != ADVISE_GAS) desc.gravity.z = DEM_R(-9.81);
    for (i = 0; i < 3 && scene == ADVISE_GAS; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    if (scene == ADVISE_MILL) {
        desc.planar = 1;
        desc.gravity.y = DEM_R(-9.81);
    }
    desc.domain = box_of(0, 0, 0, 0.02, 0.02, 0.02);
    world = dem_world_create(&desc);
    glass = scene_material(world, (scene == ADVISE_PILE ? 5e6 : 2e7)*stiffness, scene == ADVISE_GAS ? 0.9 : 0.6,
                           scene == ADVISE_GAS ? 0 : 0.4, 0);
    if (scene == ADVISE_PILE) {
        dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
        dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, 1), DEM_R(5e-3), 1);
        dem_spheres_fill(world, glass, DEM_R(1e-3),
                         dem_region_make(box_of(-4e-3, -4e-3, 1e-3, 4e-3, 4e-3, 0.02)), 60, 1);
    }
    if (scene == ADVISE_GAS) {
        dem_spheres_fill(world, glass, DEM_R(1e-3), dem_region_make(desc.domain), 400, 1);
        for (i = 0; i < world->bodies.count; i++)
            scene_move(world, dem_body_id_get(world, i), at(sin(1.0*i), sin(2.3*i), cos(7.1*i)), at(0, 0, 0));
    }
    if (scene == ADVISE_MILL) {
        drum = dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, 1), DEM_R(0.03), 1);
        motion.kind = DEM_MOTION_ROTATING;
        motion.axis = at(0, 0, 1);
        motion.speed = DEM_R(6.0);
        dem_wall_motion_set(world, drum, &motion);
        dem_spheres_fill(world, glass, DEM_R(2e-3), dem_region_make(box_of(-0.02, -0.02, 0, 0.02, 0.015, 0)), 70,
                         1);
    }
    return world;
}
static double advise_power(const dem_world *world, void *user) {
    dem_wall_loads loads;
    dem_wall drum;
    drum.id = 1;
    ++*(int *)user;
    return dem_wall_loads_get(world, drum, &loads) == DEM_OK ? (double)loads.power : 0;
}
static double advise_touching(const dem_world *world, void *user) {
    (void)user;
    return dem_counters_get(world).contacts;
}
static double advise_none(const dem_world *world, void *user) {
    (void)world; (void)user;
    return (double)NAN;
}
/* N: harder and harder towards the origin. */
static dem_vec3 advise_inwards(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    const dem_real k = (dem_real)(-1e5*(double)mass*(1 + 300*time));
    (void)v; (void)radius; (void)user;
    return at((double)(k*x.x), (double)(k*x.y), (double)(k*x.z));
}
/* The mean of an observable over the second half of a run. */
static double advise_mean(dem_world *world, double seconds, const dem_observable *o) {
    double sum = 0;
    int k;
    CHECK_EQ(dem_world_run(world, seconds/2, 0, 0), DEM_OK);
    for (k = 0; k < 32; k++) {
        CHECK_EQ(dem_world_run(world, seconds/64, 0, 0), DEM_OK);
        sum += o->function(world, o->user)/32;
    }
    return sum;
}
/* The scene with every grain up to a millionth of a radius off, from the beginning. */
static dem_world *advise_again(advise_scene scene, const dem_trial *t, uint64_t seed) {
    dem_world *world = advise_world(scene, t->dt, t->stiffness);
    int i;
    if (!strcmp(t->name, "Mindlin's friction"))        /* the only laws that are tried here */
        world->desc.tangent_law = DEM_TANGENT_MINDLIN_RESCALED;
    if (!strcmp(t->name, "linear springs")) {
        world->desc.normal_law = DEM_NORMAL_LINEAR;
        world->desc.impact_speed = 1;
    }
    for (i = 0; i < dem_bodies_get(world).count; i++) {
        const dem_body body = dem_body_id_get(world, i);
        dem_body_state s = scene_state(world, body);
        const double off = 1e-6*(double)s.radius;
        const dem_vec3 d = scene_at(&seed, 2*off, -off, 2*off, -off, 0, 0);
        s.position = demi_add(s.position, d);
        CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
    }
    return world;
}
/* Mean of an observable over runs from different seeds, and the variance of that mean. */
static void advise_runs(advise_scene scene, const dem_trial *t, double begin, double seconds,
                        const dem_observable *o, double *mean, double *variance) {
    enum { runs = 3 };
    double sum = 0, sum2 = 0;
    int k;
    for (k = 0; k < runs; k++) {
        dem_world *world = advise_again(scene, t, (uint64_t)k + 1);
        double m;
        CHECK(!(begin > 0) || dem_world_run(world, begin, 0, 0) == DEM_OK);
        m = advise_mean(world, seconds, o);
        sum += m;
        sum2 += m*m;
        dem_world_destroy(world);
    }
    *mean = sum/runs;
    *variance = (sum2/runs - *mean**mean)/(runs - 1);
}
/* Runs to `begin`, is advised, follows: runs longer beside the reference, each from 3 seeds, since one run is off
   by chance. Followed is the largest step among trials that promise enough: the cheapest by seconds, which the
   advice names, may be another where the machine is busy. */
static void advise_follow(advise_scene scene, double begin, double duration, double tolerance,
                          const dem_observable *observable) {
    dem_world *world = advise_world(scene, 0, 1);
    dem_trials_desc desc = DEM_TRIALS_DESC;
    dem_trials trials;
    double right, chance, mean, variance;
    int k, good = 0;
    CHECK(!(begin > 0) || dem_world_run(world, begin, 0, 0) == DEM_OK);
    desc.duration = duration;
    desc.budget = 1e9;
    desc.tolerance = tolerance;
    desc.observable_count = 1;
    desc.observables[0] = *observable;
    CHECK_EQ(dem_trials_run(world, &desc, &trials), DEM_OK);
    dem_world_destroy(world);
    CHECK(trials.trial[trials.best].promise <= tolerance);
    CHECK(!strcmp(trials.trial[trials.reference].name, "step quartered"));
    for (k = 0; k < trials.count; k++)
        if (trials.trial[k].promise <= tolerance && trials.trial[k].dt > trials.trial[good].dt) good = k;
    advise_runs(scene, &trials.trial[trials.reference], begin, 2*duration, observable, &right, &chance);
    advise_runs(scene, &trials.trial[good], begin, 2*duration, observable, &mean, &variance);
    CHECK_NEAR(mean, right, tolerance*fabs(right) + 2*sqrt(chance + variance));    /* two standard errors */
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("two bodies that touch have one contact each, spheres, ellipsoids and clusters alike") {
        int shape;
        for (shape = 0; shape < 3; shape++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world = dem_world_create(&desc);
            const dem_material m = scene_material(world, 1e7, 0.5, 0, 0);
            const dem_real centre[3] = {0, 0, 0};
            dem_cluster_desc one = DEM_CLUSTER_DESC;
            dem_shape s = {0};
            one.count = 1; one.positions = centre; one.radius = DEM_R(0.01);
            if (shape) s = shape == 1 ? dem_shape_ellipsoid_add(world, at(0.01, 0.01, 0.01)) : dem_shape_cluster_add(world, &one);
            if (shape) {
                dem_body_add(world, m, s, at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
                dem_body_add(world, m, s, at(0.01999, 0, 0), dem_quat_make(1, 0, 0, 0));
            } else {
                dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
                dem_sphere_add(world, m, DEM_R(0.01), at(0.01999, 0, 0));
            }
            CHECK_EQ(dem_world_step(world, 1), DEM_OK);
            CHECK_NEAR(dem_observer_contacts(world, 0), 1, 0);
            dem_world_destroy(world);
        }
    }
    TEST("advice on grains that fall into a heap, followed, holds in runs twice as long: the height within 5 %") {
        const dem_observable height = {"height", "m", dem_observer_height, 0, 0};
        advise_follow(ADVISE_PILE, 0, 0.12, 0.05, &height);
    }
    TEST("advice on a gas that cools, followed, holds in runs twice as long: the energy within 5 %") {
        const dem_observable kinetic = {"kinetic", "J", dem_observer_kinetic, 0, 0};
        advise_follow(ADVISE_GAS, 0.005, 0.02, 0.05, &kinetic);
    }
    TEST("advice on a slice of a mill, followed, holds in runs twice as long: the power within 20 %") {
        int asked = 0;
        const dem_observable power = {"power", "W", advise_power, &asked, 0};
        advise_follow(ADVISE_MILL, 0.5, 1, 0.2, &power);
        CHECK(asked > 32*3*6);
    }
    TEST("dem_trials_run changes no bit of the world's run and keeps no memory") {
        dem_world *asked = advise_world(ADVISE_MILL, 0, 1), *control = advise_world(ADVISE_MILL, 0, 1);
        dem_trials_desc desc = DEM_TRIALS_DESC;
        dem_trials trials;
        size_t bytes;
        CHECK_EQ(scene_step(asked, 700), DEM_OK);
        CHECK_EQ(scene_step(control, 700), DEM_OK);
        bytes = dem_counters_get(asked).memory;
        desc.duration = 0.01;
        desc.budget = 1e9;
        CHECK_EQ(dem_trials_run(asked, &desc, &trials), DEM_OK);
        CHECK_EQ(trials.observable_count, 3);
        CHECK_EQ(trials.count, DEM_TRIALS);
        CHECK_EQ(dem_counters_get(asked).memory, bytes);
        CHECK_EQ(dem_world_hash_get(asked), dem_world_hash_get(control));
        CHECK_EQ(scene_step(asked, 700), DEM_OK);
        CHECK_EQ(scene_step(control, 700), DEM_OK);
        CHECK_EQ(dem_world_hash_get(asked), dem_world_hash_get(control));
        dem_world_destroy(asked);
        dem_world_destroy(control);
    }
    TEST("dem_trials_run works before the first step and with mesh walls") {
        dem_world *asked = advise_world(ADVISE_PILE, 0, 1), *control = advise_world(ADVISE_PILE, 0, 1);
        dem_world *worlds[2];
        dem_trials_desc desc = DEM_TRIALS_DESC;
        dem_trials trials;
        int k;
        worlds[0] = asked; worlds[1] = control;
        for (k = 0; k < 2; k++) {
            dem_material stuff;
            stuff.id = 1;
            scene_floor(worlds[k], stuff, -0.01, -0.01, 0.02, 0.02, 3, 3);
        }
        desc.duration = 1e-3;
        desc.budget = 1e9;
        CHECK_EQ(dem_trials_run(asked, &desc, &trials), DEM_OK);
        CHECK_EQ(scene_step(asked, 300), DEM_OK);
        CHECK_EQ(scene_step(control, 300), DEM_OK);
        CHECK_EQ(dem_world_hash_get(asked), dem_world_hash_get(control));
        dem_world_destroy(asked);
        dem_world_destroy(control);
    }
    TEST("grains on both sides of a sheet do not touch in trials either") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_trials_desc ask = DEM_TRIALS_DESC;
        dem_trials trials;
        dem_world *world;
        dem_material stuff;
        int i;
        desc.dt = DEM_R(1e-6);
        world = dem_world_create(&desc);
        stuff = scene_material(world, 1e7, 0.5, 0, 0);
        scene_floor(world, stuff, -0.01, -0.01, 0.01, 0.01, 1, 1);
        for (i = -1; i < 2; i += 2) {
            const dem_body b = dem_sphere_add(world, stuff, DEM_R(1e-3), at(1e-3, 0, 9.9e-4*i));
            scene_move(world, b, at(0, 0, -i), at(0, 0, 0));       /* towards the sheet */
        }
        ask.duration = 1e-4;
        ask.budget = 1e9;
        ask.observable_count = 1;
        ask.observables[0].name = "grains that touch";
        ask.observables[0].function = advise_touching;
        ask.observables[0].scale = 1;
        CHECK_EQ(dem_trials_run(world, &ask, &trials), DEM_OK);
        CHECK(trials.count > 2 && trials.trial[0].done > 0);
        for (i = 0; i < trials.count; i++) CHECK_NEAR(trials.trial[i].value[0], 0, 0);
        CHECK_EQ(scene_step(world, 50), DEM_OK);
        CHECK_EQ(dem_counters_get(world).contacts, 0);
        CHECK_EQ(dem_counters_get(world).wall_contacts, 2);
        dem_world_destroy(world);
    }
    TEST("trials detect a step so large that impacts gain energy, and advise another") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_trials_desc how = DEM_TRIALS_DESC;
        dem_trials trials;
        dem_world *world;
        dem_material steel;
        int i;
        desc.gravity.z = DEM_R(-9.81);
        desc.threads = 1;
        desc.allow_large_dt = 1;
        desc.dt = DEM_R(3e-5);                  /* some t_c/3 of an impact at 0.8 m/s */
        world = dem_world_create(&desc);
        steel = scene_material(world, 1e8, 1, 0, 0);
        dem_wall_plane_add(world, steel, at(0, 0, 0), at(0, 0, 1));
        for (i = 0; i < 20; i++) dem_sphere_add(world, steel, DEM_R(1e-3), at(0.01*i, 0, 0.03 + 1e-3*i));
        how.duration = 1;
        how.tolerance = 0.01;
        how.budget = 1e9;
        how.observable_count = 1;
        how.observables[0].name = "height";
        how.observables[0].function = dem_observer_height;
        CHECK_EQ(dem_trials_run(world, &how, &trials), DEM_OK);
        CHECK(trials.trial[0].promise > how.tolerance);     /* t_c/3 */
        CHECK(trials.trial[1].promise > 1);                 /* t_c/1.7 */
        CHECK(trials.best > 1);
        CHECK(trials.trial[trials.best].promise < how.tolerance);
        dem_world_destroy(world);
    }
    TEST("with dt = 0 trials use a fraction of the step chosen as the run goes on, even when the scene speeds up a "
         "thousandfold") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_trials_desc how = DEM_TRIALS_DESC;
        dem_trials trials;
        dem_world *world;
        dem_material glass;
        dem_real before;
        desc.threads = 1;
        desc.force = advise_inwards;
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e7, 0.8, 0, 0);
        dem_sphere_add(world, glass, DEM_R(1e-3), at(-0.003, 0, 0));
        dem_sphere_add(world, glass, DEM_R(1e-3), at(0.003, 0, 0));
        dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0.004, 0));
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        before = dem_counters_get(world).dt;
        how.duration = 0.03;
        how.budget = 1e9;
        CHECK_EQ(dem_trials_run(world, &how, &trials), DEM_OK);
        CHECK_EQ(trials.trial[0].done, 3);
        CHECK_EQ(dem_world_run(world, 0.03, 0, 0), DEM_OK);
        CHECK((double)dem_counters_get(world).dt < 0.8*(double)before);
        CHECK(trials.trial[0].dt < 0.8*(double)before);
        CHECK(trials.trial[2].dt < 0.6*trials.trial[0].dt);
        dem_world_destroy(world);
    }
    TEST("dem_trials_run fails for bad durations, seeds, observables, an empty world or too small a budget, each with "
         "an error") {
        dem_world *world = advise_world(ADVISE_PILE, 0, 1), *empty;
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_trials_desc good = DEM_TRIALS_DESC, bad;
        dem_trials trials;
        good.duration = 1e-3;
        good.budget = 1e9;
        bad = good; bad.duration = 0;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(world), "duration is 0 s") != 0);
        bad = good; bad.seeds = 1;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(world), "seeds is 1, must be 2 to 16") != 0);
        bad = good; bad.observable_count = DEM_OBSERVABLES + 1;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        bad = good; bad.observable_count = 1;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(world), "observable 1 has no function") != 0);
        bad.observables[0].name = "nothing";
        bad.observables[0].function = advise_none;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_UNSTABLE);
        CHECK(strstr(dem_world_error_get(world), "nothing is not finite") != 0);
        bad = good; bad.budget = 1e-9;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(world), "at least 64 steps") != 0);
        CHECK_EQ(dem_trials_run(world, 0, &trials), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_trials_run(world, &good, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_trials_run(0, &good, &trials), DEM_ERROR_ARGUMENT);
        empty = dem_world_create(&desc);
        CHECK_EQ(dem_trials_run(empty, &good, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(empty), "no bodies") != 0);
        dem_world_destroy(empty);
        bad = good; bad.duration = 1e-5;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(world), "duration is 1e-05 s, must be at least 64 steps") != 0);
        bad = good; bad.tolerance = (double)INFINITY;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        bad = good; bad.observable_count = 1;
        bad.observables[0].name = "height";
        bad.observables[0].function = dem_observer_height;
        bad.observables[0].scale = (double)INFINITY;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        bad.observables[0].scale = -1;
        CHECK_EQ(dem_trials_run(world, &bad, &trials), DEM_ERROR_ARGUMENT);
        CHECK(strstr(dem_world_error_get(world), "scale of observable 1 is -1") != 0);
        {
            dem_material none;
            none.id = 1;
            dem_wall_plane_add(world, none, at(0, 0, 0), at(0, 0, 0));   /* refused, and nobody reads why */
            CHECK_EQ(dem_trials_run(world, &good, &trials), DEM_ERROR_ARGUMENT);
            CHECK(strstr(dem_world_error_get(world), "dem_wall_plane_add") != 0);
        }
        CHECK_EQ(dem_trials_run(world, &good, &trials), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("trials that run out of memory, at any allocation, report it, leak nothing and leave the world unchanged") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_trials_desc how = DEM_TRIALS_DESC;
        scene_memory memory;
        dem_trials trials;
        dem_world *world;
        dem_material glass;
        uint64_t hash;
        long first, k, refused = 0;
        size_t bytes;
        int i, cut;
        scene_memory_use(&memory, &desc);
        desc.threads = 1;
        desc.gravity.z = DEM_R(-9.81);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e7, 0.8, 0.3, 0);
        scene_floor(world, glass, -0.01, -0.01, 0.02, 0.02, 1, 1);
        scene_block(world, glass, 3, 3, 3, 1e-3, 1, 0.1, 3);
        CHECK_EQ(scene_step(world, 20), DEM_OK);
        hash = dem_world_hash_get(world);
        bytes = memory.bytes;
        how.duration = 1e-3;
        how.budget = 1e9;
        how.seeds = 2;
        for (k = 1, first = memory.calls;; k += 1 + k/8) {
            dem_result result;
            memory.refuse = memory.calls + k;
            memory.refused = 0;
            result = dem_trials_run(world, &how, &trials);
            CHECK_EQ(memory.bytes, bytes);
            CHECK_EQ(dem_world_hash_get(world), hash);
            if (!memory.refused) { CHECK_EQ(result, DEM_OK); break; }
            refused++;                          /* in a run of a trial, it is that trial's end */
            CHECK(result == DEM_ERROR_MEMORY || result == DEM_ERROR_UNSTABLE || result == DEM_OK);
            for (i = cut = 0; i < trials.count && result == DEM_OK; i++)
                cut += strstr(trials.trial[i].refusal, "memory") != 0;
            CHECK_EQ(cut, result == DEM_OK);
        }
        CHECK(refused > 30);
        CHECK(memory.calls > first);
        dem_world_destroy(world);
        CHECK_EQ(memory.blocks, 0);
        CHECK_EQ(memory.wrong, 0);
    }
    return test_end();
}
