/* program.h - a scene that breaks a relation as a C program that needs dem.h alone. It carries out both runs, compares
   what the relation compares, and exits with 1 if they differ. `run(0)` is the scene, `run(1)` its other run. */
#ifndef REL_PROGRAM_H
#define REL_PROGRAM_H
#include "relate_all.h"
#include "print.h"
#include "program_services.h"

typedef struct rel_program {
    FILE *out;
    const rel_scene *s, *image;                /* the same where the relation has no image */
    const rel_case *c;
    int relation;
} rel_program;
/* The wrong calls of rel_bad_call. */
static const char *const rel_bad_texts[REL_BAD] = {
    "dem_sphere_add(w, m, -1, V(0, 0, 0));", "dem_sphere_add(w, (dem_material){77}, 1e-3, V(0, 0, 0));",
    "dem_wall_plane_add(w, m, V(0, 0, 0), V(0, 0, 0));",
    "dem_motion a = DEM_MOTION; a.kind = DEM_MOTION_ROTATING; dem_wall_motion_set(w, (dem_wall){999}, &a);",
    "dem_body_state s = {0}; dem_body_set(w, (dem_body){9999, 1}, &s);", "dem_world_dt_set(w, -1);",
    "dem_sphere_add(w, m, 1e-3, V(1e30, 0, 0));", "dem_world_gravity_set(w, V(NAN, 0, 0));",
    "dem_checkpoint_read(w, \"there is no such file\");", "dem_shape_polyhedron_add(w, 0, 0);",
    "dem_body_remove(w, (dem_body){9999, 1});"
};
static int rel_is(const rel_program *p, int (*check)(rel_case *)) { return rel_relations[p->relation].check == check; }
static void rel_put_lines(FILE *out, const char *const *lines) { for (; *lines; lines++) fprintf(out, "%s\n", *lines); }

/* Has a scene a function with constants of a unit? */
static int rel_needs_units(const rel_scene *s) {
    int i, j;
    for (i = 0; i < s->count; i++)
        for (j = 0; j < s->op[i].count; j++)
            if (rel_calls[s->op[i].call].fields[s->op[i].set[j].field].type == REL_CODE &&
                strstr(rel_codes[(int)s->op[i].set[j].v[0]].text, "unit_")) return 1;
    return 0;
}
/* Functions of scenes, and the variables for what is made. */
static void rel_print_head(const rel_program *p, const char *why) {
    const rel_scene *s = p->image;
    int i, j, k, n = 0, call;
    fprintf(p->out, "/* %s: %s.\n   cc -std=c99 %s%s-I. prog.c -lm */\n", rel_relations[p->relation].name, why,
            sizeof(dem_real) < sizeof(double) ? "-DDEM_REAL=float " : "",
                p->relation == REL_IS_THREADS ? "-fopenmp " : "");
    if (rel_given(&s->op[0], "domain_bodies", 13))
        fprintf(p->out, "static int domain_bodies = 2048;\n#define DEM_DOMAIN_BODIES domain_bodies\n#define "
            "DEM_THREADS_FIXED\n");
    fprintf(p->out, "#define DEM_IMPLEMENTATION\n#include \"dem.h\"\n%s#define V dem_vec3_make\n",
            p->relation == REL_IS_MEMORY ? "#include <stdlib.h>\n" : "");
    if (rel_needs_units(s)) fprintf(p->out, "static double unit_m = 1, unit_s = 1;\n");
    rel_print_services(p->out, s, p->relation);
    for (k = 0; k < REL_CODES; k++)
        for (i = 0, n = 0; i < s->count; i++)
            for (j = 0; j < s->op[i].count; j++)
                if (rel_calls[s->op[i].call].fields[s->op[i].set[j].field].type == REL_CODE &&
                    (int)s->op[i].set[j].v[0] == k && !n++) rel_line(p->out, 0, rel_codes[k].text);
    for (k = 0; k < REL_DATA_COUNT; k++)
        for (i = 0, n = 0; i < s->count; i++)
            for (j = 0; j < s->op[i].count; j++)
                if (rel_calls[s->op[i].call].fields[s->op[i].set[j].field].type == REL_DATA &&
                    (int)s->op[i].set[j].v[0] == k && !n++) rel_line(p->out, 0, rel_data[k].text);
    if (s != p->s) fprintf(p->out, "#define I(a, b) (image ? b : a)\n");
    fprintf(p->out, "static dem_body b[%d];\n", rel_bodies(s) ? rel_bodies(s) : 1);
    for (call = 0; call < REL_CALLS; call++) {
        if (call == REL_A_BODY || !*rel_calls[call].makes) continue;
        rel_new_page(0);
        for (i = n = 0; i < s->count; i++) {
            const int other = i < p->s->count && p->s->op[i].call == call && rel_kept(p->s, i);
            if ((s->op[i].call != call || !rel_kept(s, i)) && !other) continue;
            if (n++) rel_say(", ");
            else rel_say("static %s ", rel_calls[call].type);
            rel_say("%s%d", rel_calls[call].makes, i);
        }
        if (n) { rel_say(";"); rel_line(p->out, 0, rel_paper[0]); }
    }
    rel_print_helpers(p->out, s);
    if (rel_is(p, rel_joints)) rel_line(p->out, 0, rel_text_joint_wrong);
    if (rel_is(p, rel_samples)) rel_line(p->out, 0, rel_text_samples_wrong);
    if (rel_is(p, rel_left)) rel_line(p->out, 0, rel_text_outlet_wrong);
    if (rel_is(p, rel_slabs_beside)) rel_line(p->out, 0, rel_text_touch);
}
/* Do the runs fail, or does one of them? */
static int rel_fails(const rel_program *p) { return !p->c->ran || p->c->other_ran != p->c->ran; }
static int rel_plain(const rel_program *p) {
    return !rel_fails(p) && p->relation != REL_IS_PIECES && p->relation != REL_IS_MEMORY &&
        p->relation != REL_IS_SLABS && p->relation != REL_IS_RUN;
}
/* Steps run 0 and run 1, where a step of run 1 is not only dem_world_step. */
static void rel_print_go(const rel_program *p) {
    const char *step = "dem_world_step(w, n)";
    if (rel_fails(p)) fprintf(p->out, "static int failed[2];\n");
    if (p->relation == REL_IS_SLABS) fprintf(p->out, "static dem_slabs *slabs;\n");
    if (!rel_plain(p)) fprintf(p->out, "static void go(dem_world *w, int n, int image) {\n");
    switch (p->relation) {
    case REL_IS_PIECES:
        fprintf(p->out, "    const int pieces = image && n > %d ? %d : 1;\n    int i;\n", p->c->how.pieces,
            p->c->how.pieces);
        fprintf(p->out, "    for (i = 1; i < pieces; i++) dem_world_step(w, n/pieces);\n");
        step = "dem_world_step(w, n - (pieces - 1)*(n/pieces))";
        break;
    case REL_IS_MEMORY:
        fprintf(p->out, "    const uint64_t end = dem_world_steps_get(w) + n;\n    if (dem_world_step(w, n) == "
            "DEM_OK || !image) return;\n");
        step = "dem_world_step(w, (int)(end - dem_world_steps_get(w)))";
        break;
    case REL_IS_SLABS:
        fprintf(p->out, "    dem_slabs_desc d = DEM_SLABS_DESC;\n    d.count = %d; d.axis = %d;%s\n"
                "    if (image && !slabs) slabs = dem_slabs_create(w, &d);\n", p->c->how.slabs,
                p->c->how.axis, p->c->how.moved ? " d.balance = d.balance_interval = 1;" : "");
        fprintf(p->out, "    if (image && dem_slabs_step(slabs, n) == DEM_OK) dem_slabs_collect(slabs, w);\n");
        if (rel_fails(p)) fprintf(p->out, "    if (image && *dem_slabs_error_get(slabs)) { "
            "puts(dem_slabs_error_get(slabs)); failed[1] = 1; }\n");
        fprintf(p->out, "    if (image) return;\n");
        break;
    case REL_IS_RESTART: if (rel_fails(p)) fprintf(p->out, "    if (image == 2) return;\n"); break;
    case REL_IS_RUN: rel_print_way(p->out, p->c->how.way, rel_fails(p)); break;
    default: break;
    }
    if (!rel_fails(p) && !rel_plain(p)) fprintf(p->out, "    %s;\n}\n", step);
    if (rel_fails(p)) fprintf(p->out, "    if (%s == DEM_OK) return;\n    failed[image] = 1;\n"
                 "    printf(\"run %%d: %%s\\n\", image, dem_world_error_get(w));\n}\n", step);
    if (p->relation == REL_IS_REFUSED) {
        fprintf(p->out, "static void wrong_call(dem_world *w) {\n    const dem_material m = {1};\n    ");
        fprintf(p->out, "%s\n    (void)m;\n    dem_world_error_get(w);\n}\n", rel_bad_texts[p->c->bad]);
    }
    if (p->relation == REL_IS_MEMORY)
        fprintf(p->out, "static int allocations;\n"
                "static void *give(size_t n, void *u) { (void)u; return ++allocations == %d ? 0 : malloc(n); }\n"
                "static void take(void *m, size_t n, void *u) { (void)n; (void)u; free(m); }\n", (int)p->c->how.refuse);
}
static int rel_unit_differs(const rel_program *p) { return p->image->unit[0] > 0 && rel_needs_units(p->image); }
/* The world of run 0, and what run 1 has instead. */
static void rel_print_world(const rel_program *p) {
    const rel_op *a = &p->s->op[0], *b = &p->image->op[0];
    const rel_call *c = &rel_calls[REL_WORLD];
    const rel_check check = rel_relations[p->relation].check;
    int i, k;
    if (rel_unit_differs(p)) fprintf(p->out, "    unit_m = image ? %s : 1;\n", rel_number(p->image->unit[0]));
    if (rel_unit_differs(p)) fprintf(p->out, "    unit_s = image ? %s : 1;\n", rel_number(p->image->unit[1]));
    fprintf(p->out, "    dem_world_desc d = DEM_WORLD_DESC;\n    dem_world *w;\n");
    rel_new_page(0);
    for (i = 0; i < a->count; i++) rel_assign(p->s, &c->fields[a->set[i].field], &a->set[i]);
    rel_new_page(1);
    for (i = 0; i < a->count; i++) {
        const char *name = c->fields[a->set[i].field].name;
        rel_assign(p->image, &c->fields[a->set[i].field], rel_given(b, name, strlen(name)));
    }
    rel_merge();
    rel_line(p->out, 4, rel_paper[2]);
    for (i = 0; i < b->count; i++) {
        const rel_field *f = &c->fields[b->set[i].field];
        if (rel_given(a, f->name, strlen(f->name))) continue;
        rel_new_page(0);
        rel_say("if (image) ");
        rel_assign(p->image, f, &b->set[i]);
        rel_line(p->out, 4, rel_paper[0]);
    }
    k = p->relation;
    if (k == REL_IS_THREADS) fprintf(p->out, "    if (image) d.threads = %d;\n", p->c->how.threads);
    if (k == REL_IS_LEDGER) fprintf(p->out, "    if (image) d.ledger = 1;\n");
    if (check == rel_energy || check == rel_no_gain || check == rel_halved || check == rel_joints) 
        fprintf(p->out, "    d.ledger = 1;\n");
    if (k == REL_IS_MEMORY) fprintf(p->out, "    if (image) { d.allocator.alloc_fn = give; d.allocator.free_fn = "
        "take; }\n");
    fprintf(p->out, "    w = dem_world_create(&d);\n");
    if (k == REL_IS_MEMORY) fprintf(p->out, "    if (!w) w = dem_world_create(&d);\n");
}
/* The calls of a step. Where the image differs: both. */
static void rel_print_calls(const rel_program *p, int step) {
    int i, said = 0;
    for (i = 1; i < p->image->count; i++) {
        const int two = i < p->s->count, kept = rel_kept(p->image, i) || (two && rel_kept(p->s, i));
        const char *a = rel_paper[0], *b = rel_paper[1];
        if (p->image->op[i].step != step) continue;
        if (step && !said++ && p->relation == REL_IS_SLABS)
            fprintf(p->out, "    if (image) { dem_slabs_destroy(slabs); slabs = 0; }\n");
        rel_new_page(0);
        if (two) rel_statement(p->s, i, kept);
        rel_new_page(1);
        if (!two) rel_say("if (image) ");
        rel_statement(p->image, i, kept);
        if (!two) rel_line(p->out, 4, b);
        else if (rel_is(p, rel_left) && p->s->op[i].call == REL_OUTLET) {
            rel_new_page(2);
            rel_say("if (!image) %s", a);
            rel_line(p->out, 4, rel_paper[2]);
        } else if (rel_merge()) rel_line(p->out, 4, rel_paper[2]);
        else {
            rel_new_page(2);
            rel_say("if (!image) %s", a);
            rel_line(p->out, 4, rel_paper[2]);
            rel_new_page(2);
            rel_say("else %s", b);
            rel_line(p->out, 4, rel_paper[2]);
        }
        if (p->relation == REL_IS_MEMORY && p->c->repeated == i) {
            rel_new_page(1);
            rel_say("if (image) %s", a);
            rel_line(p->out, 4, b);
        }
    }
}
static void rel_print_restart(const rel_program *p) {
    static const char *const restart[] = {"    if (!twice(old, \"relation.dem\")) exit(1);", "    w = run(2, step);",
        "    dem_world_destroy(old);", "    if (dem_checkpoint_read(w, \"relation.dem\") != DEM_OK) "
            "puts(dem_world_error_get(w));",
        "    remove(\"relation.dem\");", 0};
    const int notes = rel_notes(p->image);
    fprintf(p->out, "static dem_world *run(int image, int until);\nstatic dem_world *continued(dem_world *old, int "
        "step) {\n%s    dem_world *w;\n",
            notes ? "    const uint64_t before = noted;\n" : "");
    rel_print_closes(p->out, p->image, 4);
    rel_put_lines(p->out, restart);
    fprintf(p->out, "%s    return w;\n}\n", notes ? "    noted = before;\n" : "");
}
/* The function that makes a scene and carries it out, step by step as rel_go does. */
static void rel_print_run(const rel_program *p) {
    const rel_scene *s = p->s;
    const int marks = s->marks ? s->marks : REL_MARKS;
    const int plain = rel_plain(p);
    int step = 0, k, i, next;
    if (p->relation == REL_IS_RESTART) rel_print_restart(p);
    fprintf(p->out, "static dem_world *run(int image%s) {\n", p->relation == REL_IS_RESTART ? ", int until" : "");
    rel_print_world(p);
    rel_print_calls(p, 0);
    if (p->relation == REL_IS_REFUSED)
        fprintf(p->out, "    { const uint64_t before = dem_world_hash_get(w);\n"
                "      if (image) { wrong_call(w); if (dem_world_hash_get(w) != before) puts(\"changed\"); } }\n");
    for (k = 1; k <= marks; k++) {
        const int mark = s->steps*k/marks;
        while (step < mark) {
            for (next = mark, i = 1; i < s->count; i++)
                if (s->op[i].step > step && s->op[i].step < next) next = s->op[i].step;
            fprintf(p->out, !plain ? "    go(w, %d, image);\n" : p->relation == REL_IS_RESTART ? "    if (image < 2) "
                "dem_world_step(w, %d);\n" :
                    "    dem_world_step(w, %d);\n", next - step);
            step = next;
            if (step < mark) {
                if (p->relation == REL_IS_RESTART) fprintf(p->out, "    if (until == %d) return w;\n", step);
                rel_print_calls(p, step);
            }
            if (p->relation == REL_IS_REFUSED && step < mark) fprintf(p->out, "    if (image) wrong_call(w);\n");
        }
        if (k == 1 && (p->relation == REL_IS_MOMENTUM || rel_relations[p->relation].check == rel_angular ||
                       rel_relations[p->relation].check == rel_rest)) fprintf(p->out, "    if (!image) return w;\n");
        if (k == marks) break;
        if (rel_is(p, rel_slabs_beside)) fprintf(p->out, "    touch(w, %d, image);\n", rel_count(s, REL_MATERIAL));
        if (p->relation == REL_IS_RESTART)
            fprintf(p->out, "    if (until == %d) return w;\n    if (image == 1) w = continued(w, %d);\n", step, step);
        if (p->relation == REL_IS_USED)
            fprintf(p->out, "    if (image) {\n%s        if (!twice(w, \"relation.dem\")) exit(1);\n        "
                "dem_world_step(w, 3);\n"
                    "        if (dem_checkpoint_read_changed(w, \"relation.dem\", \"\") != DEM_OK) "
                        "puts(dem_world_error_get(w));\n"
                    "        remove(\"relation.dem\");\n%s    }\n",
                    rel_notes(p->image) ? "        const uint64_t before = noted;\n" : "",
                        rel_notes(p->image) ? "        noted = before;\n" : "");
        rel_print_calls(p, step);
    }
    rel_print_closes(p->out, p->image, 4);
    fprintf(p->out, "    return w;\n}\n");
}
/* Component e of what the map makes of a position x, a velocity v and a spin o. */
static void rel_mapped(const rel_map *m, int e, double time) {
    const int part = e/3, row = e%3;
    const double unit = part == 0 ? m->length : part == 1 ? m->length/m->time : 1/m->time;
    const double add = part == 0 ? m->to[row] + m->drift[row]*time : part == 1 ? m->drift[row] : 0;
    int f, said = 0;
    if (add < 0 || add > 0) { rel_say("%s", rel_number(add)); said = 1; }
    for (f = 0; f < 3; f++) {
        const double x = m->m[row][f]*unit;
        if (!(x < 0 || x > 0)) continue;
        rel_say("%s", x < 0 ? (said ? " - " : "-") : said ? " + " : "");
        if (fabs(x) < 1 || fabs(x) > 1) rel_say("%s*", rel_number(fabs(x)));
        rel_say("%c.%c", "xvo"[part], 'x' + f);
        said = 1;
    }
}
/* main: compares positions and velocities; spins, too, where they must be the same. */
static void rel_print_near(const rel_program *p) {
    const int exact = p->relation == REL_IS_UNITS || p->relation == REL_IS_LEDGER ||
        rel_relations[p->relation].check == rel_strength_zero, parts = exact ? 9 : 6;
    const int leave = rel_uses(p->image, REL_REMOVE) || rel_uses(p->image, REL_OUTLET);
    const rel_set *dt = rel_given(&p->s->op[0], "d.dt", 4);
    const char *const of = p->c->reversed ? "N - 1 - i" : "i";
    int e;
    fprintf(p->out, "enum { N = %d };\nint main(void) {\n    static dem_body_state s[2][N];\n    int k, i, e, wrong "
        "= 0;\n"
            "    for (k = 0; k < 2; k++) {\n        dem_world *w = run(k);\n"
            "        for (i = 0; i < N; i++) dem_body_get(w, b[i], &s[k][i]);\n    }\n    for (i = 0; i < N; i++) {\n",
            rel_bodies(p->s));
    fprintf(p->out, "        const dem_vec3 x = s[0][i].position, v = s[0][i].velocity%s;\n",
        exact ? ", o = s[0][i].spin" : "");
    fprintf(p->out, "        const dem_vec3 y = s[1][%s].position, u = s[1][%s].velocity%s;\n", of, of,
        exact ? ", c = s[1][i].spin" : "");
    rel_new_page(0);
    rel_say("const double want[] = {");
    for (e = 0; e < parts; e++) {
        if (e) rel_say(", ");
        rel_mapped(&p->c->map, e, dt ? dt->v[0]*p->s->steps : 0);
    }
    rel_say("};");
    rel_line(p->out, 8, rel_paper[0]);
    fprintf(p->out, "        const double is[] = {y.x, y.y, y.z, u.x, u.y, u.z%s};\n", exact ? ", c.x, c.y, c.z" : "");
    fprintf(p->out, "        for (e = 0; e < %d; e++) {\n", parts);
    fprintf(p->out, "            if (%s", leave ? "(x.x == 0 && x.y == 0) || " : "");
    if (exact) fprintf(p->out, "is[e] == want[e]) continue;\n");
    else fprintf(p->out, "fabs(is[e] - want[e]) <= (e < 3 ? %.3g : %.3g)) continue;\n", p->c->allowed[0],
        p->c->allowed[1]);
    fprintf(p->out, "            printf(\"body %%d, number %%d: %%.17g, should be %%.17g\\n\", i, e, is[e], want[e]);\n"
            "            wrong = 1;\n        }\n    }\n    return %s;\n}\n",
            rel_fails(p) ? "wrong || failed[0] != failed[1]" : "wrong");
}
/* Relations of physics on one run: what of it must be how large. */
static int rel_print_physics(const rel_program *p) {
    const rel_check check = rel_relations[p->relation].check;
    const int first = p->s->steps/(p->s->marks ? p->s->marks : REL_MARKS);
    if (check == rel_angular)
        fprintf(p->out, "int main(void) {\n    const dem_totals a = dem_totals_get(run(0)), b = "
            "dem_totals_get(run(1));\n    int e, wrong = 0;\n"
                "    for (e = 0; e < 3; e++) {\n        printf(\"%%.17g %%.17g kg m2/s\\n\", a.angular[e], "
                    "b.angular[e]);\n"
                "        wrong |= !(fabs(b.angular[e] - a.angular[e]) <= %.3g);\n    }\n    return wrong;\n}\n",
                    p->c->allowed[0]);
    else if (check == rel_weight)
        fprintf(p->out, "int main(void) {\n    dem_world *w = run(0);\n    double force[3] = {0, 0, 0};\n    int i;\n"
                "    for (i = 1; i < 20; i++) {\n        dem_wall_loads l;\n        if (dem_wall_loads_get(w, "
                    "(dem_wall){i}, &l) != DEM_OK) continue;\n"
                "        force[0] += l.force.x; force[1] += l.force.y; force[2] += l.force.z;\n    }\n"
                "    printf(\"%%.9g %%.9g %%.9g N on the walls, weight %%.9g N\\n\", force[0], force[1], force[2],\n"
                "           9.81*dem_totals_get(w).mass);\n    return 0;\n}\n");
    else if (check == rel_rest)
        fprintf(p->out, "int main(void) {\n    const double a = dem_counters_get(run(0)).speed_max, b = "
            "dem_counters_get(run(1)).speed_max;\n"
                "    printf(\"%%g m/s after %d steps, %%g m/s at the end\\n\", a, b);\n    return b > %.3g;\n}\n",
                    first, p->c->allowed[0]);
    else if (check == rel_no_gain || check == rel_energy)
        fprintf(p->out, "int main(void) {\n    const dem_ledger l = dem_ledger_get(run(0));\n"
                "    const double out = l.normal + l.slide + l.tangent + l.rolling;\n"
                "    printf(\"residual %%g J; normal %%g, slide %%g, tangent %%g, rolling %%g J\\n\", l.residual, "
                    "l.normal, l.slide, l.tangent,\n"
                "           l.rolling);\n    return l.residual%s > %.3g;\n}\n", check == rel_energy ? "" : " - out",
                p->c->allowed[0]);
    else if (check == rel_halved)
        fprintf(p->out, "int main(void) {\n    const dem_ledger l = dem_ledger_get(run(0));\n"
                "    printf(\"residual %%g J\\n\", l.residual);\n    return 0;\n}\n");
    else return 0;
    return 1;
}
/* main of the relations that ask about one scene (relate_asked.h). */
static void rel_print_asked(const rel_program *p) {
    const rel_scene *s = p->s;
    int i, outlet = -1;
    fprintf(p->out, "int main(void) {\n    dem_world *w = run(0);\n    int wrong = 0;\n");
    for (i = 0; i < s->count; i++) {
        const rel_op *op = &s->op[i];
        if (op->call == REL_OUTLET && !(rel_or(op, "keep", 0) > 0)) outlet = i;
        rel_new_page(0);
        if (rel_is(p, rel_joints) && op->call == REL_JOINT) {
            const rel_set *b = rel_given(op, "d.b", 3);
            rel_say("wrong |= joint_wrong(w, ");
            rel_name(s, i);
            rel_say(", ");
            rel_name(s, (int)rel_given(op, "d.a", 3)->v[0]);
            rel_say(", ");
            if (b && b->v[0] >= 0) rel_name(s, (int)b->v[0]);
            else rel_say("(dem_body){0, 0}");
            rel_say(");");
        }
        if (rel_is(p, rel_samples) && op->call == REL_FIELD) {
            rel_say("wrong |= samples_wrong(w, ");
            rel_name(s, i);
            rel_say(", %s", rel_number(rel_or(op, "start", 0)));
            rel_say(", %s", rel_number(rel_or(op, "end", 0)));
            rel_say(", %s, %d);", rel_number(rel_or(op, "interval", 0)), op->step);
        }
        rel_line(p->out, 4, rel_paper[0]);
    }
    if (rel_is(p, rel_left)) {
        fprintf(p->out, "    dem_world *all = run(1);           /* without the outlet */\n    dem_body_state s;\n    "
            "int i;\n"
                "    for (i = 0; i < %d; i++) {\n        if (dem_body_get(w, b[i], &s) == DEM_OK || "
                    "dem_body_get(all, b[i], &s) != DEM_OK) continue;\n",
                rel_bodies(s));
        fprintf(p->out, "        wrong |= outlet_wrong(all, ");
        rel_new_page(0);
        rel_name(s, outlet < 0 ? -1 : (int)rel_or(&s->op[outlet], "frame", -1));
        fprintf(p->out, "%s, (double[]){", strcmp(rel_paper[0], "none") ? rel_paper[0] : "(dem_wall){0}");
        for (i = 0; i < 6 && outlet >= 0; i++)
            fprintf(p->out, "%s%s", i ? ", " : "", rel_number(rel_given(&s->op[outlet], "d.box", 5)->v[i]));
        fprintf(p->out, "},\n            %s, (double[]){s.position.x, s.position.y, s.position.z});\n",
            rel_number(outlet < 0 ? 0 : rel_or(&s->op[outlet], "beyond", 0)));
        fprintf(p->out, "        printf(\"body %%d left at %%.9g %%.9g %%.9g m\\n\", i, s.position.x, s.position.y, "
            "s.position.z);\n    }\n");
    }
    fprintf(p->out, "    puts(wrong ? \"wrong\" : \"right\");\n    return wrong;\n}\n");
}
static void rel_print_main(const rel_program *p) {
    const char *const arguments = p->relation == REL_IS_RESTART ? ", -1" : "";
    if (rel_print_physics(p)) return;
    if (rel_is(p, rel_joints) || rel_is(p, rel_samples) || rel_is(p, rel_left)) rel_print_asked(p);
    else if (p->relation == REL_IS_COUNTS)
        fprintf(p->out, "int main(void) {\n    const dem_body_counts n = dem_body_counts_get(run(0));\n"
                "    printf(\"%%d inserted, %%d present, %%d removed, %%d left\\n\", (int)n.inserted, "
                    "(int)n.present, (int)n.removed,\n"
                "           (int)n.left);\n    return n.inserted != n.present + n.removed + n.left;\n}\n");
    else if (p->relation == REL_IS_MOMENTUM)
        fprintf(p->out, "int main(void) {\n    double p[2][3] = {{0}};\n    int k, i, e, wrong = 0;\n    for (k = 0; "
            "k < 2; k++) {\n"
                "        dem_world *w = run(k);\n        for (i = 0; i < %d; i++) {\n            dem_body_state s;\n"
                "            if (dem_body_get(w, b[i], &s) != DEM_OK) continue;\n            p[k][0] += "
                    "s.mass*s.velocity.x;\n"
                "            p[k][1] += s.mass*s.velocity.y;\n            p[k][2] += s.mass*s.velocity.z;\n        "
                    "}\n    }\n"
                "    for (e = 0; e < 3; e++) {\n        printf(\"%%.17g %%.17g kg m/s\\n\", p[0][e], p[1][e]);\n"
                "        wrong |= fabs(p[1][e] - p[0][e]) > %.3g;\n    }\n"
                "    return wrong;\n}\n", rel_bodies(p->s), p->c->allowed[0]);
    else if (p->relation == REL_IS_LEDGER || (p->relation >= REL_IS_SLABS &&
        (p->relation < REL_IS_READERS || p->relation > REL_IS_GRAIN_FILES) &&
              !rel_is(p, rel_slabs_beside))) rel_print_near(p);
    else if (p->relation == REL_IS_GRAIN_FILES)
        fprintf(p->out, "int main(void) { return !grains_back(run(0), %d); }\n", p->c->bad);
    else if (rel_notes(p->image) && p->relation != REL_IS_READERS && p->relation != REL_IS_REFUSED)
        rel_print_noted(p->out, p->image, &p->c->how, arguments, rel_fails(p));
    else
        fprintf(p->out, "int main(void) {\n    dem_world *first = run(0%s), *second = run(1%s);\n"
                "    const uint64_t p = dem_world_hash_get(first), q = dem_world_hash_get(second);\n"
                "    printf(\"%%016llx %%016llx\\n\", (unsigned long long)p, (unsigned long long)q);\n"
                "    return %s;\n}\n", arguments, arguments,
                    rel_fails(p) ? "p != q || failed[0] != failed[1]" : "p != q");
}
/* Prints the program. why: null: what the relation says. Returns 1 if the scene breaks the relation. */
static int rel_print_program(FILE *out, const rel_scene *s, int relation, const char *why) {
    static rel_scene own;
    static rel_case c;
    rel_program p;
    int broken;
    rel_copy(&own, s);
    c.image = 0;
    broken = rel_open_case(&c, &own) && rel_judge(&c, relation) == REL_BROKEN;
    if (relation == REL_IS_REFUSED) {          /* compared at the first mark */
        own.steps /= own.marks ? own.marks : REL_MARKS;
        own.marks = 1;
    }
    p.out = out;
    p.s = c.s;                                 /* a copy, if the relation has one */
    p.image = c.image ? c.image : p.s;
    if (relation == REL_IS_THREADS) p.s = p.image;         /* both in groups of 16 */
    p.c = &c;
    p.relation = relation;
    rel_named = rel_is(&p, rel_joints) ? REL_JOINT : rel_is(&p, rel_samples) ? REL_FIELD : -1;
    rel_print_head(&p, why ? why : *c.why ? c.why : "holds");
    rel_print_go(&p);
    rel_print_run(&p);
    rel_print_main(&p);
    rel_named = -1;
    rel_close_case(&c);
    return broken;
}
#endif
