/* program_services.h - what printed programs need for outputs, replays, events and readers: the functions of
   codes_services.h that they use, and a comparison of what was noted and of files. */
#ifndef REL_PROGRAM_SERVICES_H
#define REL_PROGRAM_SERVICES_H

static int rel_has_path(const rel_op *op) {
    int j;
    for (j = 0; j < op->count; j++) if (rel_calls[op->call].fields[op->set[j].field].type == REL_PATH) return 1;
    return 0;
}
static int rel_has_paths(const rel_scene *s) {
    int i;
    for (i = 0; i < s->count; i++) if (rel_has_path(&s->op[i])) return 1;
    return 0;
}
/* The code of a field of an op; 0: none is used. */
static const rel_code *rel_code_in(const rel_op *op, int j) {
    const rel_set *v = &op->set[j];
    return rel_calls[op->call].fields[v->field].type == REL_CODE ? &rel_codes[(int)v->v[0]] : 0;
}
/* Does some code that is used contain a word? */
static int rel_says(const rel_scene *s, const char *word) {
    int i, j;
    for (i = 0; i < s->count; i++)
        for (j = 0; j < s->op[i].count; j++)
            if (rel_code_in(&s->op[i], j) && strstr(rel_code_in(&s->op[i], j)->text, word)) return 1;
    return 0;
}
static int rel_notes(const rel_scene *s) { return rel_has_paths(s) || rel_says(s, "note("); }
/* Functions that come before the codes of a scene. */
static void rel_print_services(FILE *out, const rel_scene *s, int relation) {
    const int back = relation == REL_IS_GRAIN_FILES;
    const int restart = relation == REL_IS_RESTART || relation == REL_IS_USED;
    const int walls = rel_scene_has(s, REL_MESH_FILE) || rel_scene_has(s, REL_PROFILE_FILE);
    if (rel_notes(s) || back || walls || restart) fprintf(out,
        "#include <math.h>\n#include <stdlib.h>\n#include <string.h>\n");
    if (rel_says(s, "scratch") || back || walls) fprintf(out, "static char scratch[] = \"relation.out\";\n");
    if (rel_notes(s)) rel_line(out, 0, rel_text_note);
    if (rel_has_paths(s) || rel_says(s, "fold(")) rel_line(out, 0, rel_text_fold);
    if (restart || rel_says(s, "twice(")) rel_line(out, 0, rel_text_twice);
    if (back || walls) rel_line(out, 0, rel_text_whole);
    if (back) rel_line(out, 0, rel_text_grains_back);
    if (rel_scene_has(s, REL_FILL)) rel_line(out, 0, rel_text_fill);
    if (rel_scene_has(s, REL_RUB)) rel_line(out, 0, rel_text_rub);
    if (rel_scene_has(s, REL_MESH_FILE)) rel_line(out, 0, rel_text_mesh_file);
    if (rel_scene_has(s, REL_PROFILE_FILE)) rel_line(out, 0, rel_text_profile_file);
}
/* Closes the replays of a world before it ends. */
static void rel_print_closes(FILE *out, const rel_scene *s, int indent) {
    int i;
    for (i = 0; i < s->count; i++)
        if (s->op[i].call == REL_REPLAY) fprintf(out, "%*sif (r%d) dem_replay_close(r%d);\n%*sr%d = 0;\n", indent,
            "", i, i, indent, "", i);
}
/* A run by another function than dem_world_step. */
static void rel_print_way(FILE *out, int way, int fails) {
    fprintf(out, "    const uint64_t end = dem_world_steps_get(w) + n;\n"
            "    const double seconds = n*(double)dem_world_desc_get(w).dt;\n");
    fprintf(out, "    if (image) %s;\n", way == 1 ? "dem_world_run(w, seconds, 0, 0)" :
            way == 2 ? "dem_world_run_to(w, dem_world_time_get(w) + seconds, 0, 0)" :
                "dem_world_settle(w, seconds, 1e-12, 0, 0)");
    if (way == 3)
        fprintf(out, "    if (image && dem_world_steps_get(w) < end)\n"
            "        dem_world_step(w, (int)(end - dem_world_steps_get(w)));\n");
    if (fails)
        fprintf(out, "    if (image && dem_world_steps_get(w) != end) {\n"
            "        puts(\"another number of steps\");\n        failed[1] = 1;\n    }\n");
    fprintf(out, "    if (image) return;\n");
}
/* main: compares hashes, and what was noted with the bytes of files. */
static void rel_print_noted(FILE *out, const rel_scene *s, const rel_how *how, const char *arguments, int fails) {
    int i, j;
    fprintf(out, "int main(void) {\n    uint64_t p[2], q[2];\n    int k;\n"
            "    for (k = 0; k < 2; k++) {\n        noted = 0;\n"
            "        p[k] = dem_world_hash_get(run(k%s));\n", arguments);
    for (i = 0; i < s->count; i++)
        for (j = 0; j < s->op[i].count; j++)
            if (rel_calls[s->op[i].call].fields[s->op[i].set[j].field].type == REL_PATH)
                fprintf(out, "        %sfold(\"%s\");\n", rel_file_counts(&s->op[i], how) ? "" : "if (0) ",
                        rel_texts[(int)s->op[i].set[j].v[0]]);
    fprintf(out, "        q[k] = noted;\n    }\n"
            "    printf(\"%%016llx %%016llx, noted %%016llx %%016llx\\n\", (unsigned long long)p[0],\n"
            "           (unsigned long long)p[1], (unsigned long long)q[0], (unsigned long long)q[1]);\n"
            "    return p[0] != p[1] || q[0] != q[1]%s;\n}\n", fails ? " || failed[0] != failed[1]" : "");
}
#endif
