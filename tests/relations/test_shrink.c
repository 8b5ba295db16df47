/* Scenes are made smaller while they break a relation, and printed as programs. */
#include "shrink.h"
#include "program.h"
#include "../test.h"

static int calls_of(const rel_scene *s, int call) {
    int i, n = 0;
    for (i = 0; i < s->count; i++) n += s->op[i].call == call;
    return n;
}
/* An ellipsoid that is used, a mesh and gravity are present, and there are at least 40 steps. */
static int has_three(const rel_scene *s, void *user) {
    const rel_set *g = rel_given(&s->op[0], "d.gravity", 9);
    int i, used = 0;
    for (i = 0; i < s->count; i++) {
        const rel_set *shape = s->op[i].call == REL_A_BODY ? rel_given(&s->op[i], "shape", 5) : 0;
        if (shape && s->op[(int)shape->v[0]].call == REL_ELLIPSOID) used = 1;
    }
    ++*(int *)user;
    return used && calls_of(s, REL_ELLIPSOID) && calls_of(s, REL_MESH) && g && g->v[2] < -1 && s->steps >= 40;
}
/* Two bodies and a wall that is removed later. */
static int has_later(const rel_scene *s, void *user) {
    (void)user;
    return calls_of(s, REL_A_BODY) > 1 && calls_of(s, REL_WALL_REMOVE);
}
/* The first scene, from a seed on, for which `is` returns 1 and which has at least `ops` ops. */
static int draw_until(rel_scene *s, rel_predicate is, int ops, uint64_t seed) {
    int user = 0, k;
    for (k = 0; k < 20000; k++)
        if (rel_draw_scene(s, seed + (uint64_t)k) && s->count >= ops && is(s, &user)) return 1;
    return 0;
}
static int refers_backwards(const rel_scene *s) {
    int i, j;
    for (i = 0; i < s->count; i++)
        for (j = i; j < s->count; j++) if (rel_refers(s, &s->op[i], j)) return 0;
    return 1;
}
/* Prints to a file and reads it: lines, and braces and parentheses that are open at the end. */
static int lines_of(const rel_scene *s, int relation, int *open) {
    FILE *f = tmpfile();
    int c, lines = 0;
    *open = 0;
    if (!f) return -1;
    rel_print_program(f, s, relation, "a test");
    rewind(f);
    while ((c = fgetc(f)) != EOF) {
        lines += c == '\n';
        *open += (c == '{') - (c == '}') + (c == '(') - (c == ')');
    }
    fclose(f);
    return lines;
}

static rel_scene scene, before;
int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a scene keeps an ellipsoid, its body, a mesh, a material, gravity and the fewest steps") {
        int evaluations = 0;
        CHECK(draw_until(&scene, has_three, 30, 1));
        rel_shrink_while(&scene, has_three, &evaluations, 1, 20000, 30);
        CHECK(has_three(&scene, &evaluations));
        CHECK_EQ(scene.count, 5);
        CHECK_EQ(scene.steps, 40);
        CHECK_EQ(scene.op[0].count, 1 + (rel_given(&scene.op[0], "d.dt", 4) != 0));
        CHECK(evaluations < 2000);
    }
    TEST("references of a smaller scene point to earlier calls of the right kind") {
        CHECK(draw_until(&scene, has_later, 25, 1));
        rel_shrink_while(&scene, has_later, 0, 1, 20000, 30);
        CHECK_EQ(calls_of(&scene, REL_A_BODY), 2);
        CHECK_EQ(calls_of(&scene, REL_WALL_REMOVE), 1);
        CHECK_EQ(scene.count, 6);
        CHECK(refers_backwards(&scene));
    }
    TEST("removing a call removes what refers to it and nothing else") {
        CHECK(draw_until(&scene, has_three, 30, 50));
        rel_copy(&before, &scene);
        rel_drop_ops(&scene, 1, 2);            /* a material, which walls and bodies have */
        CHECK(scene.count < before.count - 1);
        CHECK(refers_backwards(&scene));
        rel_copy(&scene, &before);
        rel_drop_ops(&scene, before.count - 1, before.count);
        CHECK_EQ(scene.count, before.count - 1);
    }
    TEST("the image of a body of a shape is rotated, also if its orientation is the default one") {
        rel_map m = rel_same;
        int i, k, seen = 0;
        m.m[0][0] = m.m[1][1] = 0;             /* by 90 degrees about z */
        m.m[0][1] = -1;
        m.m[1][0] = 1;
        CHECK(draw_until(&before, has_three, 30, 1));
        for (i = 0; i < before.count; i++)
            for (k = before.op[i].count - 1; k >= 0 && before.op[i].call == REL_A_BODY; k--)
                if (!strcmp(rel_field_at(&before.op[i], k)->name, "orientation")) rel_drop_set(&before.op[i], k);
        rel_map_scene(&scene, &before, &m);
        for (i = 0; i < scene.count; i++) {
            const rel_set *q = scene.op[i].call == REL_A_BODY ? rel_given_in(&scene.op[i], "orientation") : 0;
            const int shaped = scene.op[i].call == REL_A_BODY && rel_given_in(&scene.op[i], "shape");
            CHECK_EQ(q != 0, shaped);
            if (q) { seen++; CHECK_NEAR(q->v[0], sqrt(0.5), 1e-15); CHECK_NEAR(q->v[3], sqrt(0.5), 1e-15); }
        }
        CHECK(seen);
    }
    TEST("each row is drawn in 3000 scenes, with what it needs and without what it excludes") {
        static int drawn[REL_ROWS];
        int seed, i, k, bad = 0;
        for (seed = 1; seed <= 3000; seed++) {
            if (!rel_draw_scene(&scene, (uint64_t)seed)) continue;
            for (i = 0; i < REL_ROWS; i++)
                for (drawn[i] += scene.has[i], k = 0; k < REL_ROWS && scene.has[i]; k++)
                    bad += (scene.has[k] && rel_excludes[i][k]) || (!scene.has[k] && rel_needs[i][k]);
        }
        CHECK_EQ(bad, 0);
        for (i = 0; i < REL_ROWS; i++) if (!(drawn[i] > 20)) CHECK_STR(rel_features[i].name, "drawn");
    }
    TEST("the work of a search for a smaller scene is limited") {
        int evaluations = 0;
        CHECK(draw_until(&scene, has_three, 30, 1));
        CHECK_EQ(rel_shrink_while(&scene, has_three, &evaluations, 1, 25, 30), 25);
        CHECK(has_three(&scene, &evaluations));
    }
    TEST("a scene in which a relation holds is not made smaller") {
        CHECK(rel_draw_scene(&scene, 1));
        CHECK_EQ(rel_shrink(&scene, REL_IS_COUNTS), 0);
        CHECK(scene.count > 5);
        (void)rel_acted;
    }
    TEST("numbers are rounded to few digits, time steps never upwards") {
        CHECK_NEAR(rel_rounder(0.0017361, 3, 0), 0.00174, 1e-18);
        CHECK_NEAR(rel_rounder(-0.0017361, 1, 0), -0.002, 1e-18);
        CHECK_NEAR(rel_rounder(1.76e-5, 1, 1), 1e-5, 1e-20);
        CHECK_NEAR(rel_rounder(1e-5, 1, 1), 1e-5, 1e-20);
        CHECK_EQ(rel_rounder(7, 0, 0) < 0 || rel_rounder(7, 0, 0) > 0, 0);
    }
    TEST("the program of a small scene has fewer than 60 lines for each relation") {
        int relation, open = 0;
        CHECK(draw_until(&scene, has_later, 25, 1));
        rel_shrink_while(&scene, has_later, 0, 1, 20000, 30);
        for (relation = 0; relation < REL_RELATIONS; relation++) {
            const int lines = lines_of(&scene, relation, &open);
            CHECK(lines > 20);
            if (lines >= 60) CHECK_STR(rel_relations[relation].name, "shorter");
            CHECK_EQ(open, 0);
        }
    }
    TEST("numbers that differ between a scene and its image are written side by side") {
        rel_new_page(0);
        rel_say("b[0] = f(w1, 2.5e-3, V(1, -2, 3));");
        rel_new_page(1);
        rel_say("b[0] = f(w1, 2.5e-3, V(1, 2e-3, 3));");
        CHECK_EQ(rel_merge(), 1);
        CHECK_STR(rel_paper[2], "b[0] = f(w1, 2.5e-3, V(1, I(-2, 2e-3), 3));");
        rel_new_page(1);
        rel_say("b[0] = f(w2, 2.5e-3, V(1, 2e-3, 3));");
        CHECK_EQ(rel_merge(), 0);
    }
    return test_end();
}
