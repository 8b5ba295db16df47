/* relate_services.h - relations of what is written and read. */
#ifndef REL_RELATE_SERVICES_H
#define REL_RELATE_SERVICES_H

static int rel_scene_has(const rel_scene *s, int call) {
    int i;
    for (i = 0; i < s->count; i++) if (s->op[i].call == call) return 1;
    return 0;
}
/* Must the file of an op have the same bytes? A replay ends with its world, and after a frame that was not
   written. Checkpoints contain the number of threads, the memory in use, and where dem_world_run should have ended. */
static int rel_file_counts(const rel_op *op, const rel_how *how) {
    const rel_set *kind = op->call == REL_OUTPUT ? rel_find((rel_op *)op, "kind") : 0;
    if (op->call == REL_REPLAY) return !how->checkpoint && !how->refuse;
    return !(kind && (int)kind->v[0] == DEM_OUTPUT_CHECKPOINT && (how->threads || how->checkpoint || how->refuse ||
        how->way));
}
/* Compares files, and what was noted up to each mark. Events stop without memory (dem_events_record). */
static int rel_same_notes(rel_case *c, const rel_run *other, const rel_how *how, const char *what) {
    int k, i;
    if (how->refuse && rel_scene_has(c->s, REL_EVENTS)) return REL_HOLDS;
    for (k = 0; k < other->marks && k < c->base.marks; k++)
        if (other->mark[k].noted != c->base.mark[k].noted)
            return rel_broken(c, "%s: other events or values up to step %d", what, c->base.mark[k].step);
    for (i = 0; i < c->s->count && c->ran; i++)
        if (c->base.file[i] != other->file[i] && rel_file_counts(&c->s->op[i], how))
            return rel_broken(c, "%s: other bytes in %s, %ld instead of %ld", what,
                              rel_texts[(int)rel_find((rel_op *)&c->s->op[i], "path")->v[0]], other->took[i],
                                  c->base.took[i]);
    return REL_HOLDS;
}
static int rel_bits(rel_case *c, const rel_scene *s, const rel_how *how, const char *what);

/* ---- readers change nothing: all at once; if that breaks, the first that does so alone. dem_contacts_each and files
   of contacts compute forces first if the scene has changed, as a step would. With growth the step computes them again
   for the new radii. Then by impulses the first computation has moved spins by rounding, and the search for contacts of
   other shapes than spheres begins with what the first one has found; no comment promises these bits, so such scenes
   are compared without growth. Grains of feeds come between the two computations, too: by impulses scenes are compared
   without feeds. "An outlet checks whenever the neighbour list is rebuilt" (dem_outlet_desc), also one that was read
   before a grain came: scenes with feeds are compared without outlets. ---- */
static int rel_add_reader(rel_scene *s, int reader, int step) {
    rel_op *op = &s->op[s->count++];
    if (s->count >= REL_OPS) return 0;
    memset(op, 0, sizeof *op);
    op->call = REL_READ;
    op->step = step;
    rel_put(op, "what", reader);
    return 1;
}
static int rel_read_only(rel_case *c) {
    const int marks = c->s->marks ? c->s->marks : REL_MARKS;
    const int steps[3] = {0, 1 + rel_below(&c->rng, c->s->steps), c->s->steps*(1 + rel_below(&c->rng, marks))/marks};
    static const char *const growth[] = {"growth", 0};
    static const int feeds[] = {REL_FEED, REL_FEED_SIZES, -1}, outlets[] = {REL_OUTLET, -1};
    const rel_how how = {0};
    const int solved = rel_has(c, "impulses");
    int k, e, only, result = REL_HOLDS, at, shapes = 0, fed = 0;
    if (!c->ran) return REL_SKIPPED;
    for (k = 0; k < c->s->count; k++) {
        shapes |= c->s->op[k].call >= REL_ELLIPSOID && c->s->op[k].call <= REL_UNION;
        fed |= rel_among(feeds, c->s->op[k].call);
    }
    if ((rel_has(c, "growth") && (solved || shapes)) || (fed && (solved || rel_has(c, "outlet")))) {
        rel_copy(&rel_own, c->s);
        if (solved) rel_leave_calls(&rel_own, feeds, 0);
        else if (fed) rel_leave_calls(&rel_own, outlets, 0);
        rel_leave_fields(&rel_own, REL_WORLD, growth);
        if (!rel_instead(c)) return REL_SKIPPED;
    }
    for (only = -1; only < 0 || rel_reader_at(only) >= 0; only++) {
        int alone;
        rel_copy(&rel_image, c->s);
        for (k = 0; (at = rel_reader_at(k)) >= 0; k++) {
            const int slow = !strcmp(rel_codes[at].name, "read_trials") || !strcmp(rel_codes[at].name, "read_costs") ||
                !strcmp(rel_codes[at].name, "read_apart");
            if (only < 0 && slow && rel_below(&c->rng, 16)) continue;       /* they take long */
            for (e = 0; e < (slow ? 1 : 3) && (only < 0 || only == k); e++)
                if (steps[e] < c->s->steps && !rel_add_reader(&rel_image, at, steps[e])) return REL_SKIPPED;
        }
        c->unheard = 1;
        alone = rel_bits(c, &rel_image, &how, only < 0 ? "with all readers" : rel_codes[rel_reader_at(only)].name);
        c->unheard = 0;
        c->image = &rel_image;
        if (only < 0) result = alone;
        if (alone == REL_BROKEN ? only >= 0 : only < 0) break;
    }
    return result;
}
/* ---- other ways to step ---- */
static int rel_run_ways(rel_case *c) {
    static const char *const names[] = {"", "dem_world_run", "dem_world_run_to", "dem_world_settle"};
    rel_how how = {0};
    if (!c->ran) return REL_SKIPPED;
    how.way = 1 + rel_below(&c->rng, 3);
    if (how.way == 3 && rel_has(c, "endless feed")) how.way = 1;       /* dem_world_settle refuses it */
    return rel_bits(c, c->s, &how, names[how.way]);
}
/* ---- files. profile_file adds profiles with DEM_EDGE_RESOLVED ---- */
static int rel_walls_filed(rel_case *c) {
    const rel_how how = {0};
    int i, n = 0;
    if (!c->ran) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    for (i = 0; i < c->s->count; i++) {
        rel_op *op = &rel_image.op[i];
        if (op->call != REL_MESH && op->call != REL_PROFILE) continue;
        if (op->call == REL_PROFILE && rel_has(c, "fractions of segments")) continue;
        op->call = op->call == REL_MESH ? REL_MESH_FILE : REL_PROFILE_FILE;
        rel_put(op, "rule", rel_below(&c->rng, 4));
        n++;
    }
    c->image = &rel_image;
    return n ? rel_bits(c, &rel_image, &how, "walls from files") : REL_SKIPPED;
}
/* Files have a line for each sphere of a cluster, and the bounding radius of other shapes in tables only. */
static int rel_other_than_spheres(const rel_scene *s) {
    int i;
    for (i = 0; i < s->count; i++) if (s->op[i].call == REL_A_BODY && rel_find((rel_op *)&s->op[i], "shape")) return 1;
    return 0;
}
static int rel_grains_filed(rel_case *c) {
    static const char *const shaped[] = {"feed of shapes", "fill of shapes", 0};
    int k;
    if (!c->ran || rel_other_than_spheres(c->s) || rel_has_any(c, shaped)) return REL_SKIPPED;
    for (k = 0; k < 4; k++)
        if (!grains_back(c->base.w, k)) {
            c->bad = k;
            return rel_broken(c, "the grains of file %d are others", k);
        }
    return REL_HOLDS;
}
#define REL_SERVICE_RELATIONS \
    {"readers", "same bits with and without", rel_read_only}, {"run, run to a time, settle", "same bits", \
        rel_run_ways}, \
    {"walls from files", "same bits", rel_walls_filed}, {"grains from files", "digits of the format", rel_grains_filed}
#endif
