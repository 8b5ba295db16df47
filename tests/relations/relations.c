/* relations.c - draws scenes and checks relations that must hold (make relations). A scene is drawn from its seed, so
   the same number is the same scene on every machine.

       build/relations --scenes 600                 the scenes 1 .. 600, each with three drawn relations
       build/relations --seed 97                    one scene with all relations
       build/relations --seed 97 --relation slabs --print     ... made smaller, as a C program
       build/relations --scenes 100000 --log build/relations.log     continues where the log ends
       build/relations --scenes 100000 --share 1/2 --log build/one.log     every second scene, from 1 on
       build/relations --add build/one.log --add build/two.log   the sums of two shares, without a run
       build/relations --scenes 600 --page docs/relations.md  also writes the table
       build/relations --scenes 600 --messages                ... and what refused or stopped scenes said
       build/relations --scenes 600 --hashes        no relations: prints the hash of each scene after its last step,
                                                    to see with diff in which scenes two versions of dem.h differ

   The last line is "relations: N scenes, C checks, B broken"; the exit code is 1 if a relation is broken. */
#include "shrink.h"
#include "program.h"

typedef struct rel_counts {
    uint64_t last;                             /* seeds 1 .. last are done; below are numbers of type int only */
    int scenes, refused, failed, still, checks, broken;
    int relation[REL_RELATIONS][REL_RESULTS];   /* holds, broken, skipped, known */
    int pair[REL_ROWS][REL_ROWS];              /* scenes in which both acted */
    rel_halves halves;
    int pair_refused[REL_ROWS][REL_ROWS];      /* scenes with both that were refused by name */
} rel_counts;
static rel_counts rel_all;
static double rel_seconds[REL_RELATIONS];
static int rel_hashing;                        /* --hashes */
enum { REL_MESSAGES = 200, REL_ATTEMPTS = 3 };
static struct { char head[200]; int count, stopped; } rel_said[REL_MESSAGES];

static int rel_log_get(const char *path, rel_counts *to) {
    FILE *file = fopen(path, "rb");
    int ok = 1;
    if (!file) return 1;
    ok = fread(to, sizeof *to, 1, file) == 1;
    fclose(file);
    if (!ok) fprintf(stderr, "relations: %s was written by another version; remove it to begin again\n", path);
    return ok;
}
/* Adds the counts of a share that has ended. All shares must have ended at the same scene. */
static int rel_log_add(const char *path) {
    static rel_counts one;
    int *to = &rel_all.scenes, *from = &one.scenes;
    size_t i;
    memset(&one, 0, sizeof one);
    if (!rel_log_get(path, &one)) return 0;
    if (!one.last || (rel_all.last && one.last != rel_all.last)) {
        fprintf(stderr, "relations: the share of %s ended at scene %llu, another at %llu\n", path,
                (unsigned long long)one.last, (unsigned long long)rel_all.last);
        return 0;
    }
    for (i = 0; i < (sizeof one - offsetof(rel_counts, scenes))/sizeof(int); i++) to[i] += from[i];
    rel_all.last = one.last;
    rel_halved_all = rel_all.halves;
    return 1;
}
static int rel_log_write(const char *path) {
    char part[500];
    FILE *file;
    int ok;
    rel_all.halves = rel_halved_all;
    snprintf(part, sizeof part, "%s.part", path);
    file = fopen(part, "wb");
    if (!file) return 0;
    ok = fwrite(&rel_all, sizeof rel_all, 1, file) == 1;
    return !fclose(file) && ok && !rename(part, path);
}
static void rel_features_print(const rel_scene *s) {
    int k, n = 0;
    printf("    ");
    for (k = 0; k < REL_ROWS; k++) if (s->has[k]) printf("%s%s", n++ ? ", " : "", rel_features[k].name);
    printf("\n");
}
static void rel_pairs(int to[REL_ROWS][REL_ROWS], const rel_scene *s, const rel_run *r) {
    int i, k;
    for (i = 0; i < REL_ROWS; i++)
        for (k = 0; k < REL_ROWS; k++)
            to[i][k] += s->has[i] && s->has[k] && (!r || (rel_acted(r, i) && rel_acted(r, k)));
}
/* Counts messages of scenes that were refused or stopped. */
static void rel_complain(int stopped, const char *message) {
    char head[200];
    int i;
    snprintf(head, sizeof head, "%.199s", message);
    for (i = 0; head[i]; i++) if (head[i] >= '0' && head[i] <= '9') head[i] = '#';
    for (i = 0; i < REL_MESSAGES && rel_said[i].count && strcmp(rel_said[i].head, head); i++) continue;
    if (i == REL_MESSAGES) return;
    memcpy(rel_said[i].head, head, sizeof head);
    rel_said[i].count++;
    rel_said[i].stopped = stopped;
}
/* Opens a case; a scene in which nothing happens is drawn again from its seed, faster. */
static int rel_open_again(rel_case *c, rel_scene *s) {
    int attempt, ok;
    for (attempt = 1;; attempt++) {
        ok = rel_open_case(c, s);
        if (!ok || !c->ran || c->base.contacts + c->base.wall_contacts || attempt > REL_ATTEMPTS) return ok;
        rel_close_case(c);
        if (!rel_draw_again(s, s->seed, attempt)) return rel_open_case(c, s);
    }
}
/* Is a relation checked in this precision? Those of rounding have their limits in double precision. */
static int rel_promised(const rel_relation *relation) {
    return sizeof(dem_real) == sizeof(double) || !strncmp(relation->promise, "same", 4) ||
        !strncmp(relation->promise, "hash", 4) ||
        !strcmp(relation->promise, "exact");
}
/* Checks `most` drawn relations of a scene, or all if `most` is 0, or the one called `only`. Returns the number that
   are broken. */
static int rel_check_scene(rel_scene *s, int most, const char *only, int print) {
    static rel_case c;
    static rel_scene smaller;
    int order[REL_RELATIONS], i, k, first = 0, broken = 0, checked = 0;
    clock_t began;
    const int ok = rel_open_again(&c, s);
    rel_rng r;
    if (!ok || !c.ran) {
        if (!most && !only) printf("scene %llu: %s\n", (unsigned long long)s->seed, c.base.message);
        rel_complain(ok, c.base.message);
        rel_all.refused += !ok;
        rel_all.failed += ok;
        rel_pairs(rel_all.pair_refused, s, 0);
        rel_close_case(&c);
        return 0;
    }
    if (!(c.base.contacts + c.base.wall_contacts)) { rel_all.still++; rel_close_case(&c); return 0; }
    rel_all.scenes++;
    if (rel_hashing) {
        printf("%llu %016llx\n", (unsigned long long)s->seed, (unsigned long long)c.base.hash);
        rel_close_case(&c);
        return 0;
    }
    rel_pairs(rel_all.pair, s, &c.base);
    r.s = s->seed*2 + 1;
    for (i = 0; i < REL_RELATIONS; i++) order[i] = i;
    for (i = REL_RELATIONS - 1; i > 0; i--) {
        const int with = rel_below(&r, i + 1), was = order[i];
        order[i] = order[with];
        order[with] = was;
    }
    for (k = 0; k < REL_RELATIONS && (!most || checked < most); k++) {
        const rel_relation *relation = &rel_relations[order[k]];
        int result;
        if (only ? strcmp(only, relation->name) != 0 : !rel_promised(relation)) continue;
        began = clock();
        result = rel_judge(&c, order[k]);
        rel_seconds[order[k]] += (double)(clock() - began)/CLOCKS_PER_SEC;
        first = order[k];
        rel_all.relation[order[k]][result]++;
        checked += result != REL_SKIPPED;
        rel_all.checks += result != REL_SKIPPED;
        if (result == REL_KNOWN && (only || !most))
            printf("known: scene %llu, %s: %s\n", (unsigned long long)s->seed, relation->name,
                rel_known_break(&c, relation->name));
        if (result != REL_BROKEN) continue;
        broken++;
        printf("BROKEN scene %llu, %s: %s\n", (unsigned long long)s->seed, relation->name, c.why);
        rel_features_print(s);
        if (!print) continue;
        rel_copy(&smaller, s);
        rel_shrink(&smaller, order[k]);
        rel_print_program(stdout, &smaller, order[k], 0);
    }
    if (print && !broken) rel_print_program(stdout, s, first, 0);
    rel_close_case(&c);
    rel_all.broken += broken;
    return broken;
}


/* ---- the page ---- */
static void rel_page_rules(FILE *out) {
    int i;
    fprintf(out, "\n## Rules\n\nFeatures of one group exclude each other, too; so does what a feature needs.\n\n"
        "| features | | of | reason |\n|---|---|---|---|\n");
    for (i = 0; i < REL_RULES; i++)
        fprintf(out, "| %s | %s | %s | %s |\n", rel_rules[i].rows, rel_rules[i].needs ? "need each" : "exclude each",
            rel_rules[i].others, rel_rules[i].why);
}
/* Pairs of rows that acted together in fewer than 20 scenes; by name only after a run that is long enough for it. */
static void rel_page_pairs(FILE *out) {
    enum { LONG = 50000 };
    int i, k, n, few = 0, none = 0, apart = 0;
    for (i = 0; i < REL_ROWS; i++)
        for (k = i + 1; k < REL_ROWS; k++) {
            if (rel_excludes[i][k]) apart++;
            else { none += !rel_all.pair[i][k]; few += rel_all.pair[i][k] < 20; }
        }
    fprintf(out, "\n## Pairs\n\nOf %d pairs of features, %d are excluded by rules. Of the other %d, %d acted together "
        "in at least 20 scenes and %d in none.", REL_ROWS*(REL_ROWS - 1)/2, apart, REL_ROWS*(REL_ROWS - 1)/2 - apart,
        REL_ROWS*(REL_ROWS - 1)/2 - apart - few, none);
    if (rel_all.last < LONG || !few) { fprintf(out, "\n"); return; }
    fprintf(out, " The table lists those with fewer than 20, with the number of scenes; \"refused\" means that dem.h "
        "refused a scene with both by name.\n\n| feature | with |\n|---|---|\n");
    for (i = 0; i < REL_ROWS; i++) {
        for (k = i + 1, n = 0; k < REL_ROWS; k++) {
            if (rel_excludes[i][k] || rel_all.pair[i][k] >= 20) continue;
            if (n++) fprintf(out, ", ");
            else fprintf(out, "| %s | ", rel_features[i].name);
            fprintf(out, "%s %d%s", rel_features[k].name, rel_all.pair[i][k],
                rel_all.pair_refused[i][k] ? " (refused)" : "");
        }
        if (n) fprintf(out, " |\n");
    }
}
static void rel_page_features(FILE *out) {
    int i, k;
    fprintf(out, "\n## Features\n\nThe number of scenes in which a feature acted, and of the other features with which "
        "it acted in at least 20 scenes.\n\n| feature | scenes | with |\n|---|---|---|\n");
    for (i = 0; i < REL_ROWS; i++) {
        int with = 0;
        for (k = 0; k < REL_ROWS; k++) with += k != i && rel_all.pair[i][k] >= 20;
        fprintf(out, "| %s | %d | %d |\n", rel_features[i].name, rel_all.pair[i][i], with);
    }
}
static void rel_page_relations(FILE *out) {
    int i;
    fprintf(out, "The program drew %d scenes, of which %d ran with contacts and %d without. dem.h refused %d by name, "
        "and %d stopped with a message. %d relations were checked, %d were broken.\n\n| relation | promise | holds | "
        "broken | known to break | does not apply |\n|---|---|---|---|---|---|\n",
        rel_all.scenes + rel_all.still + rel_all.refused + rel_all.failed, rel_all.scenes, rel_all.still,
        rel_all.refused, rel_all.failed, rel_all.checks, rel_all.broken);
    for (i = 0; i < REL_RELATIONS; i++)
        fprintf(out, "| %s | %s | %d | %d | %d | %d |\n", rel_relations[i].name, rel_relations[i].promise,
            rel_all.relation[i][0], rel_all.relation[i][REL_BROKEN], rel_all.relation[i][REL_KNOWN],
            rel_all.relation[i][REL_SKIPPED]);
    fprintf(out, "\nHalf the time step leaves more than 0.55 of the residual in %d of %d scenes. Known to break: ",
        rel_halved_all.more, rel_halved_all.scenes);
    for (i = 0; i < (int)(sizeof rel_known_breaks/sizeof *rel_known_breaks); i++)
        fprintf(out, "%s\"%s\" with %s and %s (%s)", i ? "; " : "", rel_known_breaks[i].relation,
            rel_known_breaks[i].rows[0], rel_known_breaks[i].rows[1], rel_known_breaks[i].why);
    fprintf(out, ".\n");
}
static void rel_page(const char *path) {
    FILE *out = fopen(path, "w");
    if (!out) { fprintf(stderr, "relations: cannot write %s\n", path); return; }
    rel_rules_read();
    fprintf(out, "# Relations\n\nThis page shows which features of dem.h were tried together, and which relations "
        "between runs were checked. A program draws small scenes from rows of features. For each scene it draws three "
        "relations that must hold, for instance the same bits with other numbers of threads, or the same motion in "
        "rotated axes. `make relations` runs it on 400 scenes in about a minute:\n\n```\n"
        "make relations              # scenes 1 to 400\n"
        "make relations SEED=97      # one scene, all relations\n"
        "make relations N=100000     # a long run; after an interruption the same command continues\n```\n\n"
        "If a relation is broken, `SEED=` makes the scene smaller and prints a C program that shows it. The rows are "
        "in `tests/relations/`: features in `draw.h` and `draw_more.h`, which of them need or exclude others in "
        "`rules.h`, relations in `relate_*.h`.\n\n"
        "Relations of rounding allow a thousand times the difference that a disturbance of 1e-16 m has caused by then; "
        "those of physics say in `relate_physics.h` what they allow. A scene in which nothing touches is drawn again, "
        "up to three times. The command that wrote this page is `make relations N=%llu`.\n\n",
        (unsigned long long)rel_all.last);
    rel_page_relations(out);
    rel_page_features(out);
    rel_page_pairs(out);
    rel_page_rules(out);
    if (fclose(out)) fprintf(stderr, "relations: %s was not written in full\n", path);
}

typedef struct rel_options {
    uint64_t seed, scenes, share, shares;      /* of every `shares` scenes the one numbered `share` */
    const char *only, *log, *page;
    int print, messages, added;                /* added: number of logs */
} rel_options;
static int rel_options_read(rel_options *o, int count, char **argument) {
    int i;
    memset(o, 0, sizeof *o);
    o->scenes = 600;
    o->share = o->shares = 1;
    for (i = 1; i < count; i++) {
        const char *value = i + 1 < count ? argument[i + 1] : "";
        char *end;
        if (!strcmp(argument[i], "--print")) { o->print = 1; continue; }
        if (!strcmp(argument[i], "--messages")) { o->messages = 1; continue; }
        if (!strcmp(argument[i], "--hashes")) { rel_hashing = 1; continue; }
        if (!strcmp(argument[i], "--seed")) o->seed = strtoull(value, 0, 10);
        else if (!strcmp(argument[i], "--scenes")) o->scenes = strtoull(value, 0, 10);
        else if (!strcmp(argument[i], "--relation")) o->only = value;
        else if (!strcmp(argument[i], "--log")) o->log = value;
        else if (!strcmp(argument[i], "--page")) o->page = value;
        else if (!strcmp(argument[i], "--add")) {
            if (!rel_log_add(value)) return 0;
            o->added++;
        } else if (!strcmp(argument[i], "--share")) {
            o->share = strtoull(value, &end, 10);
            o->shares = *end ? strtoull(end + 1, 0, 10) : 0;
            if (!o->share || o->share > o->shares) {
                fprintf(stderr, "relations: --share %s, but it is I/K with 1 <= I <= K\n", value);
                return 0;
            }
        } else {
            fprintf(stderr, "relations: unknown option %s; the first lines of relations.c list them\n", argument[i]);
            return 0;
        }
        i++;
    }
    return 1;
}
static void rel_draw_all(rel_scene *s, const rel_options *o) {
    const clock_t began = clock();
    uint64_t k;
    for (k = rel_all.last + 1; k <= o->scenes; k++) {
        if ((k - 1) % o->shares == o->share - 1 && rel_draw_scene(s, k)) {
            rel_check_scene(s, o->only ? 0 : 3, o->only, 0);
            fflush(stdout);
        }
        rel_all.last = k;
        if (k%1000) continue;
        fprintf(stderr, "%llu scenes, %d checks, %d broken, %.0f s\n", (unsigned long long)k, rel_all.checks,
            rel_all.broken,
                (double)(clock() - began)/CLOCKS_PER_SEC);
        if (o->log) rel_log_write(o->log);
    }
}
int main(int count, char **argument) {
    static rel_scene s;
    rel_options o;
    int i;
    if (!rel_options_read(&o, count, argument)) return 2;
    if (o.seed) {
        rel_draw_scene(&s, o.seed);
        rel_features_print(&s);
        i = rel_check_scene(&s, 0, o.only, o.print);
        printf("relations: scene %llu, %d checks, %d broken\n", (unsigned long long)o.seed, rel_all.checks, i);
        return i > 0;
    }
    if (o.log) {
        if (!rel_log_get(o.log, &rel_all)) return 2;
        rel_halved_all = rel_all.halves;
    }
    if (!o.added) rel_draw_all(&s, &o);
    if (o.shares == 1 && !rel_halved_end()) {
        printf("BROKEN halved dt: %d of %d residuals do not halve\n", rel_halved_all.more, rel_halved_all.scenes);
        rel_all.broken++;
    }
    if (o.log && !o.added) rel_log_write(o.log);
    for (i = 0; i < REL_RELATIONS && o.messages; i++) printf("%6.1f s %s\n", rel_seconds[i], rel_relations[i].name);
    for (i = 0; i < REL_MESSAGES && o.messages; i++)
        if (rel_said[i].count)
            printf("%5d %s %s\n", rel_said[i].count, rel_said[i].stopped ? "stopped" : "refused", rel_said[i].head);
    if (o.page) rel_page(o.page);
    if (o.shares > 1) printf("share %llu of %llu", (unsigned long long)o.share, (unsigned long long)o.shares);
    else printf("relations");
    printf(": %llu scenes, %d checks, %d broken\n", (unsigned long long)rel_all.last, rel_all.checks,
        rel_all.broken);
    return rel_all.broken > 0;
}
