/* dem_effects_get: what a scene calls for, what is off and why, what was asked for and never happened, and that
   copies on which shares are measured leave the world as it was. How large shares are hangs on the machine, and
   is no matter for a test; that each is measured on what it names is. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* A grain of glass and one of steel, with rolling friction, over a floor of glass and a lid of steel. */
typedef struct effects_scene { dem_world *world; dem_body glass, steel; } effects_scene;
static effects_scene effects_world(dem_world_desc desc) {
    effects_scene s;
    dem_material glass, steel;
    dem_pair pair;
    desc.threads = 1;
    desc.gravity.z = DEM_R(-9.81);
    s.world = dem_world_create(&desc);
    glass = scene_material(s.world, 1e7, 0.5, 0.3, 0);
    steel = scene_material(s.world, 1e7, 0.5, 0.3, 0);
    dem_pair_get(s.world, glass, steel, &pair);
    pair.rolling_friction = DEM_R(0.1);
    dem_pair_set(s.world, glass, steel, &pair);
    dem_wall_plane_add(s.world, glass, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(s.world, steel, at(0, 0, 1), at(0, 0, -1));
    s.glass = dem_sphere_add(s.world, glass, DEM_R(1e-3), at(0, 0, 0.999e-3));
    s.steel = dem_sphere_add(s.world, steel, DEM_R(1e-3), at(0.3, 0, 0.5));
    return s;
}
/* The effect of that name as it is now. */
static dem_effect effects_of(dem_world *world, const char *name) {
    static dem_effect none;
    dem_effect all[DEM_EFFECTS];
    int k;
    CHECK_EQ(dem_effects_get(world, 0, all), DEM_EFFECTS);
    for (k = 0; k < DEM_EFFECTS; k++) if (!strcmp(all[k].name, name)) return all[k];
    CHECK(!"there is such an effect");
    return none;
}
static void effects_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    ++*(long *)c->user;
    memory[0] += 1;
    f->normal = DEM_R(1e4)*c->overlap + c->closing_speed;
}
static long effects_asked, effects_strange;    /* calls of the law; calls of its rate with another user's data */
static void effects_rate(const dem_contact *c, dem_real *rates) {
    effects_strange += c->user != &effects_asked;
    rates[0] = rates[1] = 1;
}
static dem_vec3 effects_wind(dem_vec3 position, dem_vec3 velocity, dem_real radius, dem_real mass, double time,
                             void *user) {
    (void)velocity; (void)radius; (void)mass; (void)time;
    ++*(long *)user;
    return at(position.x > DEM_R(0.2) ? 1e-6 : 0, 0, 0);
}

/* Looks, in the copies that dem_effects_get steps, at a ball that begins to roll down a plane: its spin over that of a
   ball without rolling friction. Copies without friction have 0, those without rolling friction 1, all others a
   number between. */
typedef struct effects_roll { double begun, pull, radius; int watching; long slid, rolled, between; } effects_roll;
static void effects_look(const dem_body_state *b, dem_body body, double time, dem_vec3 *force, dem_vec3 *torque,
                         void *user) {
    effects_roll *r = (effects_roll *)user;
    const double elapsed = time - r->begun;
    (void)body; (void)force; (void)torque;
    if (r->watching && elapsed > 9.5e-4 && b->velocity.z > DEM_R(-5e-3)) {     /* in copies without walls it falls */
        const double share = (double)b->spin.y*r->radius/(5.0/7*r->pull*elapsed);
        r->slid += fabs(share) < 0.01;
        r->rolled += fabs(share - 1) < 0.1;
        r->between += share > 0.2 && share < 0.8;
    }
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("unused effects are off, with the reason: friction, rolling friction, adhesion, fields, ledger, shapes") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        dem_effect all[DEM_EFFECTS];
        dem_material glass = scene_material(world, 1e7, 0.5, 0, 0);
        int k;
        dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0));
        CHECK_EQ(dem_effects_get(world, 0, all), DEM_EFFECTS);
        for (k = 1; k < DEM_EFFECTS; k++) {
            CHECK_EQ(all[k].state, DEM_EFFECT_OFF);
            CHECK(all[k].text[0] && !all[k].measured && !all[k].missing);
        }
        CHECK(strstr(effects_of(world, "friction").text, "no pair of materials") != 0);
        CHECK(strstr(effects_of(world, "ledger").text, "desc.ledger is 0") != 0);
        CHECK_EQ(effects_of(world, "contacts").state, DEM_EFFECT_IDLE);
        dem_world_destroy(world);
    }
    TEST("the cost of orientations is not measured where a feed adds shapes, or where a joint turns with spheres") {
        int joint;
        for (joint = 0; joint < 2; joint++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            dem_effect all[DEM_EFFECTS];
            dem_feed_desc d = DEM_FEED_DESC;
            dem_joint_desc j = DEM_JOINT_DESC;
            desc.orientations = 1;
            desc.dt = DEM_R(1e-6);
            desc.response = joint ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e7, 0.5, 0, 0);
            j.a = dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0));
            j.b = dem_sphere_add(world, glass, DEM_R(1e-3), at(3e-3, 0, 0));
            j.point = at(1.5e-3, 0, 0);
            j.kind = DEM_JOINT_POINT;
            d.material = glass;
            d.class_count = 1;
            d.amount[0] = 1;
            d.radius[0] = DEM_R(1e-3);
            d.box = box_of(0.01, 0, 0, 0.1, 0.1, 0.1);
            if (joint) CHECK(dem_joint_add(world, &j).id);
            else {
                d.shapes[0] = dem_shape_ellipsoid_add(world, at(1e-3, 1e-3, 5e-4));
                d.rate = 1e6;
                CHECK(dem_feed_add(world, &d).id);
            }
            CHECK_EQ(dem_effects_get(world, 1e-3, all), DEM_EFFECTS);
            CHECK_EQ(effects_of(world, "orientations").state, DEM_EFFECT_OFF);
            CHECK(effects_of(world, "orientations").text[0]);
            dem_world_destroy(world);
        }
    }
    TEST("cohesion under impulses counts as adhesion, and the pair table prints the impulse-only columns") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_pair pair;
        dem_material glass;
        char text[2000] = "";
        FILE *out = tmpfile();
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-4);
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e7, 0.5, 0, 0);
        dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0));
        dem_sphere_add(world, glass, DEM_R(1e-3), at(2e-3, 0, 0));
        CHECK_EQ(effects_of(world, "adhesion").state, DEM_EFFECT_OFF);
        CHECK(!strstr(effects_of(world, "adhesion").text, "only push"));
        dem_pair_get(world, glass, glass, &pair);
        pair.spinning_friction = DEM_R(0.125);
        pair.cohesion = DEM_R(3.75e-6);
        pair.compliance = DEM_R(6.25e-5);
        CHECK_EQ(dem_pair_set(world, glass, glass, &pair), DEM_OK);
        CHECK(effects_of(world, "adhesion").state != DEM_EFFECT_OFF);
        CHECK_EQ(dem_world_step(world, 2), DEM_OK);
        CHECK_EQ(effects_of(world, "adhesion").state, DEM_EFFECT_ACTIVE);
        dem_pairs_print(world, out);
        rewind(out);
        CHECK(fread(text, 1, sizeof text - 1, out) > 0);
        CHECK(strstr(text, "mu_spin cohesion [N] compliance [m/N]") && strstr(text, " 0.125 ") && strstr(text, " 3.75e-06 ") &&
              strstr(text, " 6.25e-05\n"));
        fclose(out);
        dem_world_destroy(world);
    }
    TEST("rolling friction without a contact and an untouched wall are idle, until steel has touched glass") {
        dem_world_desc desc = DEM_WORLD_DESC;
        effects_scene s = effects_world(desc);
        CHECK_EQ(scene_step(s.world, 2000), DEM_OK);
        CHECK_EQ(effects_of(s.world, "friction").state, DEM_EFFECT_ACTIVE);
        CHECK_EQ(effects_of(s.world, "rolling friction").state, DEM_EFFECT_IDLE);
        CHECK_EQ(effects_of(s.world, "rolling friction").missing, 1);
        CHECK_EQ(effects_of(s.world, "walls").missing, 1);
        CHECK(strstr(effects_of(s.world, "walls").text, "wall 2 was never touched") != 0);
        scene_report_has(s.world, "rolling friction: EPSD; materials 1 and 2 have not touched so far");
        scene_report_has(s.world, "wall 2 was never touched");
        {
            dem_body_state state = scene_state(s.world, s.steel);
            state.position = at(0, 0.02, 0.999e-3);
            CHECK_EQ(dem_body_set(s.world, s.steel, &state), DEM_OK);
        }
        CHECK_EQ(scene_step(s.world, 2000), DEM_OK);
        CHECK_EQ(effects_of(s.world, "rolling friction").state, DEM_EFFECT_ACTIVE);
        CHECK_EQ(effects_of(s.world, "rolling friction").missing, 0);
        CHECK_EQ(effects_of(s.world, "friction").missing, 1);           /* steel on steel: the lid */
        CHECK(strstr(effects_of(s.world, "friction").text, "material 2 has not touched itself so far") != 0);
        dem_world_destroy(s.world);
    }
    TEST("contacts of the past count as touched, after a checkpoint and a reset of loads too") {
        dem_world_desc desc = DEM_WORLD_DESC;
        effects_scene s = effects_world(desc), t = effects_world(desc);
        dem_wall_loads loads;
        dem_wall ground;
        int k;
        CHECK_EQ(scene_step(s.world, 100), DEM_OK);
        for (k = 0; k < 2; k++) {                                       /* both far away */
            dem_body_state state = scene_state(s.world, k ? s.steel : s.glass);
            state.position = at(k, 0, 0.5);
            CHECK_EQ(dem_body_set(s.world, k ? s.steel : s.glass, &state), DEM_OK);
        }
        CHECK_EQ(scene_step(s.world, 10), DEM_OK);
        ground.id = 1;
        CHECK_EQ(dem_wall_loads_reset(s.world, ground), DEM_OK);
        CHECK_EQ(dem_wall_loads_get(s.world, ground, &loads), DEM_OK);
        CHECK(loads.touched && !loads.contacts);
        CHECK_EQ(effects_of(s.world, "contacts").state, DEM_EFFECT_ACTIVE);
        CHECK_EQ(effects_of(s.world, "walls").missing, 1);
        CHECK_EQ(effects_of(t.world, "contacts").state, DEM_EFFECT_IDLE);
        CHECK_EQ(dem_checkpoint_write(s.world, "effects.dem"), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(t.world, "effects.dem"), DEM_OK);
        CHECK_EQ(effects_of(t.world, "contacts").state, DEM_EFFECT_ACTIVE);
        CHECK_EQ(effects_of(t.world, "walls").missing, 1);
        dem_world_destroy(s.world);
        dem_world_destroy(t.world);
        remove("effects.dem");
    }
    TEST("a field without force, unused feeds and outlets, uncrossed periodic faces and a moving wall far away are "
         "idle") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_motion motion = DEM_MOTION;
        dem_feed_desc feed;
        effects_scene s;
        dem_wall lid;
        long asked = 0;
        desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(-1, -0.5, -1, 1, 0.5, 2);
        desc.force = effects_wind;
        desc.force_user = &asked;
        s = effects_world(desc);
        dem_body_remove(s.world, s.steel);
        lid.id = 2;
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity = at(0, 0, 1e-3);
        CHECK_EQ(dem_wall_motion_set(s.world, lid, &motion), DEM_OK);
        memset(&feed, 0, sizeof feed);
        feed.material.id = 2;
        feed.class_count = 1;
        feed.radius[0] = DEM_R(1e-3);
        feed.amount[0] = 1;
        feed.rate = 1;
        feed.start = 1000;
        feed.box = box_of(0.3, -0.1, 0.3, 0.4, 0.1, 0.4);
        CHECK(dem_feed_add(s.world, &feed).id > 0);
        CHECK_EQ(scene_step(s.world, 50), DEM_OK);
        CHECK_EQ(effects_of(s.world, "force field").state, DEM_EFFECT_IDLE);
        CHECK_EQ(effects_of(s.world, "feeds").state, DEM_EFFECT_IDLE);
        CHECK_EQ(effects_of(s.world, "periodic faces").state, DEM_EFFECT_IDLE);
        CHECK_EQ(effects_of(s.world, "moving walls").state, DEM_EFFECT_IDLE);
        CHECK_EQ(effects_of(s.world, "rolling friction").missing, 1);   /* steel is to come */
        dem_sphere_add(s.world, feed.material, DEM_R(1e-3), at(0.3, 0.4995, 0.5));
        dem_sphere_add(s.world, feed.material, DEM_R(1e-3), at(0.3, -0.4986, 0.5));
        CHECK_EQ(scene_step(s.world, 1), DEM_OK);
        CHECK_EQ(effects_of(s.world, "force field").state, DEM_EFFECT_ACTIVE);
        CHECK_EQ(effects_of(s.world, "periodic faces").state, DEM_EFFECT_ACTIVE);
        dem_world_destroy(s.world);
    }
    TEST("effect costs are measured on copies, also of user-defined laws and fields, and change no bit of the world") {
        int own, k;
        for (own = 0; own < 4; own++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_effect all[DEM_EFFECTS];
            effects_scene s, plain;
            uint64_t memory;
            effects_asked = effects_strange = 0;
            desc.ledger = 1;
            desc.orientations = own == 0;
            if (own == 0) desc.force = effects_wind;
            if (own == 1) desc.normal_law = DEM_NORMAL_HYSTERETIC;
            if (own == 3) {
                desc.law_rate = effects_rate;
                desc.law_who = 1;
                desc.body_reals = "heat";
            }
            if (own >= 2) {
                desc.law = effects_law;
                desc.law_memory = 1;
                desc.law_stiffness = DEM_R(1e4);
            }
            desc.law_user = desc.force_user = &effects_asked;
            s = effects_world(desc);
            plain = effects_world(desc);
            CHECK_EQ(scene_step(s.world, 300), DEM_OK);
            CHECK_EQ(scene_step(plain.world, 300), DEM_OK);
            memory = dem_counters_get(s.world).memory;
            effects_asked = 0;
            CHECK_EQ(dem_effects_get(s.world, 1e-3, all), DEM_EFFECTS);
            CHECK(own == 1 || effects_asked > 100);
            CHECK_EQ(effects_strange, 0);
            CHECK_EQ(dem_counters_get(s.world).memory, memory);
            for (k = 0; k < DEM_EFFECTS; k++) {
                const int can = strcmp(all[k].name, "contacts") && strcmp(all[k].name, "unlike grains") &&
                    strcmp(all[k].name, "body_reals");
                CHECK_EQ(all[k].measured, all[k].state != DEM_EFFECT_OFF && can);
                CHECK(all[k].error >= 0 && all[k].share < 1);
            }
            CHECK_EQ(dem_world_hash_get(s.world), dem_world_hash_get(plain.world));
            CHECK_EQ(scene_step(s.world, 300), DEM_OK);
            CHECK_EQ(scene_step(plain.world, 300), DEM_OK);
            CHECK_EQ(dem_world_hash_get(s.world), dem_world_hash_get(plain.world));
            dem_world_destroy(s.world);
            dem_world_destroy(plain.world);
        }
    }
    TEST("slabs record which materials have touched, and the collected world has the record") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_slabs_desc deal = DEM_SLABS_DESC;
        effects_scene s = effects_world(desc);
        dem_slabs *slabs;
        deal.count = 2;
        slabs = dem_slabs_create(s.world, &deal);
        CHECK(slabs != 0);
        CHECK_EQ(dem_slabs_step(slabs, 100), DEM_OK);
        CHECK_EQ(dem_slabs_collect(slabs, s.world), DEM_OK);
        CHECK_EQ(effects_of(s.world, "walls").state, DEM_EFFECT_ACTIVE);
        CHECK_EQ(effects_of(s.world, "walls").missing, 1);
        CHECK_EQ(effects_of(s.world, "contacts").state, DEM_EFFECT_ACTIVE);
        dem_slabs_destroy(slabs);
        dem_world_destroy(s.world);
    }
    TEST("dem_effects_get fails without a world, room, a valid budget or a scene that runs") {
        dem_world_desc desc = DEM_WORLD_DESC;
        effects_scene s = effects_world(desc);
        dem_effect all[DEM_EFFECTS];
        dem_material none;
        none.id = 9;
        CHECK_EQ(dem_effects_get(0, 0, all), -1);
        CHECK_EQ(dem_effects_get(s.world, 0, 0), -1);
        CHECK_EQ(dem_effects_get(s.world, -1, all), -1);
        CHECK(strstr(dem_world_error_get(s.world), "dem_effects_get: budget is -1 s") != 0);
        CHECK_EQ(dem_effects_get(s.world, (double)INFINITY, all), -1);
        CHECK(!dem_wall_plane_add(s.world, none, at(0, 0, 0), at(0, 0, 1)).id);
        CHECK_EQ(dem_effects_get(s.world, 0, all), -1);
        CHECK(strstr(dem_world_error_get(s.world), "dem_wall_plane_add") != 0);
        CHECK_EQ(dem_effects_get(s.world, 0, all), DEM_EFFECTS);
        dem_world_destroy(s.world);
    }
    TEST("dem_effects_get reports any failing allocation, leaks nothing and leaves the world unchanged") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_effect all[DEM_EFFECTS];
        scene_memory memory;
        effects_scene s;
        uint64_t hash;
        size_t bytes;
        long k, refused = 0;
        int e, unmeasured;
        scene_memory_use(&memory, &desc);
        desc.ledger = 1;
        s = effects_world(desc);
        CHECK_EQ(scene_step(s.world, 50), DEM_OK);
        hash = dem_world_hash_get(s.world);
        bytes = memory.bytes;
        for (k = 1;; k += 1 + k/8) {
            int count;
            memory.refuse = memory.calls + k;
            memory.refused = 0;
            count = dem_effects_get(s.world, 1e-9, all);
            CHECK_EQ(memory.bytes, bytes);
            CHECK_EQ(dem_world_hash_get(s.world), hash);
            if (!memory.refused) { CHECK_EQ(count, DEM_EFFECTS); break; }
            refused++;
            for (e = 0, unmeasured = 0; e < DEM_EFFECTS && count == DEM_EFFECTS; e++)
                unmeasured += !all[e].measured && !strcmp(all[e].name, "friction") + !strcmp(all[e].name, "walls") +
                    !strcmp(all[e].name, "rolling friction") + !strcmp(all[e].name, "ledger");
            CHECK(count < 0 ? strstr(dem_world_error_get(s.world), "memory") != 0 : unmeasured == 1);
        }
        CHECK(refused > 30);
        dem_world_destroy(s.world);
        CHECK_EQ(memory.blocks, 0);
        CHECK_EQ(memory.wrong, 0);
    }
    TEST("an impossible cost is printed as too noisy, with a remedy, and columns stay separate") {
        static const double shares[] = {0.12, -34.3, 2.5, 0.2, (double)NAN}, errors[] = {0.01, 1e3, 0.01, 0.5, 0.01};
        static char text[16000];
        dem_effect effects[DEM_EFFECTS];
        FILE *file = tmpfile();
        int k, found = 0;
        char *at_word;
        CHECK(file != 0);
        memset(effects, 0, sizeof effects);
        for (k = 0; k < DEM_EFFECTS; k++) {
            effects[k].name = "friction";
            effects[k].state = DEM_EFFECT_ACTIVE;
            effects[k].measured = k < 5;
            if (k < 5) { effects[k].share = shares[k]; effects[k].error = errors[k]; }
            strcpy(effects[k].text, "text");
        }
        demi_effects_lines(effects, file);
        rewind(file);
        text[fread(text, 1, sizeof text - 1, file)] = 0;
        fclose(file);
        for (at_word = text; (at_word = strstr(at_word, "too noisy        text")) != 0; at_word++) found++;
        CHECK_EQ(found, 4);
        CHECK_STR(text, " 12.0 % +- 1.0   text");
        CHECK_STR(text, "measure again on a quiet machine");
    }
    TEST("under impulses the copies without friction and without rolling friction have none") {
        effects_roll roll = {0, 1, 0.005, 0, 0, 0, 0};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_effect all[DEM_EFFECTS];
        dem_world *world;
        dem_material glass;
        desc.threads = 1;
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-4);
        desc.gravity = at(roll.pull, 0, -9.81);
        desc.body_force = effects_look;
        desc.force_user = &roll;
        world = dem_world_create(&desc);
        glass = scene_material(world, 1e7, 0, 0.5, 0.05);
        dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(world, glass, (dem_real)roll.radius, at(0, 0, roll.radius));
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        roll.begun = dem_world_time_get(world);
        roll.watching = 1;
        CHECK_EQ(dem_effects_get(world, 0.01, all), DEM_EFFECTS);
        roll.watching = 0;
        CHECK_STR(all[1].name, "friction");
        CHECK_STR(all[2].name, "rolling friction");
        CHECK(all[1].measured && all[2].measured);
        CHECK(roll.slid > 5);
        CHECK(roll.rolled > 5);
        CHECK(roll.between > 5);
        dem_world_destroy(world);
    }
    TEST("dem_world_report counts the walls that exist") {
        dem_world_desc desc = DEM_WORLD_DESC;
        effects_scene s = effects_world(desc);
        dem_wall ground;
        ground.id = 1;
        CHECK_EQ(scene_step(s.world, 10), DEM_OK);
        scene_report_has(s.world, "; walls 2;");
        CHECK_EQ(dem_wall_remove(s.world, ground), DEM_OK);
        scene_report_has(s.world, "; walls 1;");
        CHECK_EQ(scene_step(s.world, 10), DEM_OK);
        scene_report_has(s.world, "; walls 1;");
        dem_world_destroy(s.world);
    }
    return test_end();
}
