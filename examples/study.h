/* study.h - functions that the studies and benches share: options, progress, results, CSV, pictures
   (SVG). MIT licence. It needs only libc and libm, and dem.h does not need it. Include it in one file of
   a program.

       static double speed = 0.7;                            // the present value is the default of the option
       static const study_option table[] = {
           {"speed", STUDY_REAL, &speed, 0.01, 3, "of critical", "speed of the mill"},
       };
       study_options(argc, argv, "what it does", table, 1);  // --help; exit code 2 on a mistake
       study_begin("build/results");                         // makes folder and summary.txt
       study_progress("mill", 0.1, particle_steps);          // as often as you like; prints on stderr
       study_sweep_run(&sweep, result);                      // many cases on all cores, into one CSV
       study_result("torque_mean", 0.031, "N m");            // prints on stdout and into summary.txt
       return study_end();                                   // 0, or 1 if something failed
*/
#ifndef STUDY_H
#define STUDY_H

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#define STUDY_POSIX 1
#define study_terminal() isatty(2)
#else
#define study_terminal() 0
#endif
#ifdef _OPENMP
#include <omp.h>
#endif
#if defined(__GNUC__)
#define STUDY_FN static __attribute__((unused))
#else
#define STUDY_FN static
#endif

typedef struct study_state {
    const char *program;          /* name in messages */
    char root[400], folder[480];  /* results of the whole study; of the present part of it */
    char prefix[64];              /* put before the names of results */
    int files, failures;          /* written; things that went wrong */
    int quiet;                    /* 1: writes and prints failures only, because another process does the rest */
    double begun, shown;          /* s, wall clock: of this progress line */
    int tenths, open;             /* tenths printed; 1: a line is open on the terminal */
    char told[64];                /* task that the line reports */
    char replay[1024];            /* file of the replay, printed by study_end; "": none */
} study_state;
static study_state study;

/* ---- small things ---- */

STUDY_FN double study_clock(void) { /* s, wall clock */
#ifdef STUDY_POSIX
    struct timeval now;
    gettimeofday(&now, 0);
    return (double)now.tv_sec + 1e-6*(double)now.tv_usec;
#else
    return (double)time(0);
#endif
}

/* Prints a message on stderr and counts a failure, so that study_end returns 1. */
STUDY_FN void study_fail(const char *sentence, ...) {
    va_list arguments;
    study.failures++;
    fprintf(stderr, "%s%s: ", study.open ? "\n" : "", study.program ? study.program : "study");
    study.open = 0;
    va_start(arguments, sentence);
    vfprintf(stderr, sentence, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

/* Returns zeroed memory; ends the program if there is none. */
STUDY_FN void *study_alloc(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) { study_fail("no memory for %.0f bytes", (double)count*(double)size); exit(1); }
    return memory;
}

/* ---- options ---- */

typedef enum study_kind { STUDY_FLAG, STUDY_INT, STUDY_REAL, STUDY_TEXT, STUDY_CHOICE } study_kind;
typedef struct study_option {
    const char *name;             /* without the dashes */
    study_kind kind;
    void *value;                  /* int *, int *, double *, const char **, const char ** */
    double lo, hi;                /* limits of numbers */
    const char *unit;             /* unit; of a choice: "one|another" */
    const char *help;
} study_option;

/* Help text of the option --values of sweeps. */
#define STUDY_VALUES "values for the sweep, such as 20,25,30; for a sweep over named cases their numbers, from 0"
/* Help text of the flag --short. Every study accepts it together with all its other options; tests/studies.sh uses it. */
#define STUDY_SHORT "for tests: all runs that were asked for, in seconds, whatever else is said of their length"

STUDY_FN void study_help(const char *about, const study_option *table, int count) {
    static const char *const kinds[5] = {"", " N", " X", " TEXT", " WORD"};
    int i;
    printf("%s\n\nusage: %s [options]          defaults are in brackets\n", about, study.program);
    for (i = 0; i < count; i++) {
        const study_option *o = &table[i];
        char left[64], now[128] = "";
        const char *text = o->kind >= STUDY_TEXT ? *(const char **)o->value : 0;
        snprintf(left, sizeof left, "--%s%s", o->name, kinds[o->kind]);
        if (o->kind == STUDY_INT) snprintf(now, sizeof now, " [%d", *(int *)o->value);
        if (o->kind == STUDY_REAL) snprintf(now, sizeof now, " [%g", *(double *)o->value);
        if (text && *text) snprintf(now, sizeof now, " [%s", text);
        printf("  %-20s %s%s%s%s%s%s%s\n", left, o->help, o->kind == STUDY_CHOICE ? ": " : "",
               o->kind == STUDY_CHOICE ? o->unit : "", now, *now && *o->unit && !text ? " " : "",
               *now && !text ? o->unit : "", *now ? "]" : "");
    }
    printf("  %-20s this text\n", "--help");
}

/* Returns 1 if `word` is one of the words of `list`, which are separated by |. */
STUDY_FN int study_one_of(const char *list, const char *word) {
    const size_t length = strlen(word);
    if (strchr(word, '|')) return 0;
    for (; list; list = strchr(list, '|')) {
        list += *list == '|';
        if (!strncmp(list, word, length) && (list[length] == '|' || !list[length])) return 1;
    }
    return 0;
}
/* Reads --name value, --name=value and --flag into the variables of the table. --help prints the table
   and exits with 0. A wrong option prints a message and exits with 2. */
STUDY_FN void study_options(int argc, char **argv, const char *about, const study_option *table,
                            int count) {
    int i, k, bad;
    const char *slash = strrchr(argv[0], '/');
    study.program = slash ? slash + 1 : argv[0];
    for (i = 1; i < argc; i++)
        if (!strcmp(argv[i], "--help")) { study_help(about, table, count); exit(0); }
    for (i = 1; i < argc; i++) {
        const char *word = argv[i], *equal = strchr(word, '='), *value;
        size_t length = equal ? (size_t)(equal - word) : strlen(word);
        const study_option *o = 0;
        char *end = 0;
        double number;
        for (k = 0; k < count && !o; k++)
            if (length > 2 && !strncmp(word, "--", 2) && strlen(table[k].name) + 2 == length &&
                !strncmp(word + 2, table[k].name, length - 2)) o = &table[k];
        if (!o) { study_fail("unknown option %s; --help lists those there are", word); exit(2); }
        if (o->kind == STUDY_FLAG && !equal) { *(int *)o->value = 1; continue; }
        value = equal ? equal + 1 : i + 1 < argc ? argv[++i] : 0;
        number = o->kind == STUDY_INT || o->kind == STUDY_REAL ? strtod(value ? value : "", &end)
                                                               : 0;
        bad = end && (end == value || *end || !(number >= o->lo && number <= o->hi) ||
                      (o->kind == STUDY_INT && floor(number) != number));
        if (o->kind == STUDY_FLAG) study_fail("--%s takes no value", o->name);
        else if (!value) study_fail("--%s needs a value", o->name);
        else if (o->kind == STUDY_CHOICE && !study_one_of(o->unit, value))
            study_fail("--%s is one of %s, not '%s'", o->name, o->unit, value);
        else if (bad)
            study_fail("--%s needs a %s from %g to %g%s%s, not '%s'", o->name,
                       o->kind == STUDY_INT ? "whole number" : "number", o->lo, o->hi,
                       *o->unit ? " " : "", o->unit, value);
        if (study.failures) exit(2);
        if (o->kind >= STUDY_TEXT) *(const char **)o->value = value;
        else if (o->kind == STUDY_INT) *(int *)o->value = (int)number;
        else *(double *)o->value = number;
    }
}

/* Reads numbers with commas between them, such as "20,25,30", at most `most`. name: of the option that has them. Returns
   how many; 0 after a message. */
STUDY_FN int study_values(const char *name, const char *text, double *value, int most) {
    int count = 0;
    const char *at = text;
    char *end;
    for (;; at = end + 1) {
        const double number = strtod(at, &end);
        if (end == at || !(number > -1e300 && number < 1e300) || (*end && *end != ',')) {
            study_fail("--%s needs numbers with commas between them, such as 20,25,30, not '%s'", name, text);
            return 0;
        }
        if (count == most) {
            study_fail("--%s has more than %d values; give at most %d", name, most, most);
            return 0;
        }
        value[count++] = number;
        if (!*end) return count;
    }
}
/* Returns 1 if the numbers of `copy` that differ from those at `base` are within the limits of the table; 0 after a message.
   base: the structure in which the table has its variables; copy: another one of this kind, which a sweep has changed. */
STUDY_FN int study_within(const study_option *table, int count, const void *base, const void *copy) {
    int i;
    for (i = 0; i < count; i++) {
        const study_option *o = &table[i];
        const void *at = (const char *)copy + ((const char *)o->value - (const char *)base);
        double number, before;
        if (o->kind != STUDY_INT && o->kind != STUDY_REAL) continue;
        number = o->kind == STUDY_INT ? *(const int *)at : *(const double *)at;
        before = o->kind == STUDY_INT ? *(const int *)o->value : *(const double *)o->value;
        if ((number >= o->lo && number <= o->hi) || !(number < before || number > before)) continue;
        study_fail("a run of this sweep would have --%s %g, must be from %g to %g%s%s; give other --values", o->name, number,
                   o->lo, o->hi, *o->unit ? " " : "", o->unit);
        return 0;
    }
    return 1;
}
/* Replaces the values of a sweep, `count` of at most `most`, by those of --values in rising order. text: that of the option;
   words: the sweep has names for its cases, which are numbered from 0. Returns the new count; 0 after a message. */
STUDY_FN int study_values_take(const char *text, int words, double *value, int count, int most) {
    const int given = *text ? study_values("values", text, value, most) : count;
    int i, k;
    for (i = 0; i < given && words && *text; i++)
        if (!(value[i] >= 0 && value[i] < count && floor(value[i]) == value[i])) {
            study_fail("--values has %g, but the cases of this sweep are numbered from 0 to %d", value[i], count - 1);
            return 0;
        }
    for (i = 1; i < given && *text; i++)
        for (k = i; k > 0 && value[k] < value[k - 1]; k--) {
            const double larger = value[k - 1];
            value[k - 1] = value[k];
            value[k] = larger;
        }
    return given;
}
/* Ends the program if --values is given and `what` has no use for it. */
STUDY_FN void study_values_unused(const char *text, const char *what) {
    if (!*text) return;
    study_fail("--values is '%s', but %s has no values to replace; leave it out", text, what);
    exit(2);
}

/* ---- folders, files, results ---- */

/* Makes a folder and those above it. A failure appears when files are opened. */
STUDY_FN void study_make_folder(const char *path) {
    char part[512] = "mkdir ";
    size_t i;
    for (i = 0; path[i] && i + 7 < sizeof part; i++) {
        part[i + 6] = path[i];
        if (path[i + 1] != '/' && path[i + 1] != 0) continue;
#ifdef STUDY_POSIX
        if (mkdir(part + 6, 0777) && errno != EEXIST) return;
#else
        if (system(part)) continue; /* it may exist already */
#endif
    }
}

/* Returns the path of a file in the present folder. It is valid during the next three calls. */
STUDY_FN const char *study_path(const char *name) {
    static char paths[4][1024];
    static int next;
    next = (next + 1)%4;
    snprintf(paths[next], sizeof paths[next], "%s/%s", study.folder, name);
    return paths[next];
}
STUDY_FN FILE *study_open(const char *name) {
    FILE *file;
    if (study.quiet) return 0;
    file = fopen(study_path(name), "wb");
    if (!file) study_fail("cannot write %s: %s", study_path(name), strerror(errno));
    return file;
}
STUDY_FN void study_close(FILE *file, const char *name) {
    int bad = file && ferror(file);
    if (!file) return;
    bad |= fclose(file);
    if (bad) study_fail("%s was not written in full: is the disk full?", study_path(name));
    else study.files++;
}

STUDY_FN void study_begin(const char *folder) {
    snprintf(study.root, sizeof study.root, "%s", folder);
    snprintf(study.folder, sizeof study.folder, "%s", folder);
    if (study.quiet) return;
    study_make_folder(folder);
    study_close(study_open("summary.txt"), "summary.txt");
    if (study.failures) exit(1);
}
/* From now on files go to this folder inside that of the study, and names of results begin with its
   name; "": back to the folder of the study. */
STUDY_FN void study_part(const char *name) {
    snprintf(study.folder, sizeof study.folder, "%s%s%s", study.root, *name ? "/" : "", name);
    snprintf(study.prefix, sizeof study.prefix, "%s%s", name, *name ? "_" : "");
    study_make_folder(study.folder);
}

STUDY_FN void study_result_text(const char *name, const char *value, const char *unit) {
    char text[512];
    FILE *file;
    if (study.quiet) return;
    snprintf(text, sizeof text, "%s/summary.txt", study.root);
    file = fopen(text, "ab");
    snprintf(text, sizeof text, "%s%s = %s%s%s\n", study.prefix, name, value, *unit ? " " : "",
             unit);
    fputs(text, stdout);
    fflush(stdout);
    if (!file || fputs(text, file) < 0 || fclose(file))
        study_fail("cannot write summary.txt in %s", study.root);
}
STUDY_FN void study_result(const char *name, double value, const char *unit) {
    char text[64];
    const int whole = floor(value) >= value && fabs(value) < 1e15;
    snprintf(text, sizeof text, whole ? "%.0f" : "%.6g", value);
    study_result_text(name, text, unit);
    if (value != value) study_fail("%s%s could not be measured", study.prefix, name);
}

/* Prints a note on stderr; it does not count as a failure. */
STUDY_FN void study_say(const char *sentence, ...) {
    va_list arguments;
    if (study.quiet) return;
    fprintf(stderr, "%s%s: ", study.open ? "\n" : "", study.program ? study.program : "study");
    study.open = 0;
    va_start(arguments, sentence);
    vfprintf(stderr, sentence, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}
STUDY_FN void study_replay_print(void) {
    if (study.replay[0]) study_say("open %s in a browser: it plays the run", study.replay);
    study.replay[0] = 0;
}
STUDY_FN int study_end(void) { /* returns the exit code; prints the file of the replay last, below all results */
    fflush(stdout);
    if (!study.quiet)
        fprintf(stderr, "%s: %d files in %s\n", study.program, study.files, study.root);
    study_replay_print();
    if (study.failures) fprintf(stderr, "%s: failures above: %d\n", study.program, study.failures);
    return study.failures ? 1 : 0;
}

/* Writes a table: columns of `rows` numbers each, under a heading such as "time_s,torque_Nm". */
STUDY_FN void study_csv(const char *name, const char *heading, int rows, int columns,
                        const double *const *column) {
    FILE *file = study_open(name);
    int r, c;
    if (!file) return;
    fprintf(file, "%s\n", heading);
    for (r = 0; r < rows; r++)
        for (c = 0; c < columns; c++)
            fprintf(file, "%.9g%c", column[c][r], c + 1 < columns ? ',' : '\n');
    study_close(file, name);
}

/* ---- progress ---- */

/* Reports the progress of the task `what`: done, 0 to 1; work, grains times steps since it began, 0 prints no rate. The
   first call for a new `what` starts its clock; the call with done = 1 ends the line. On a terminal
   one line is rewritten, a file gets a line every 10 %. */
STUDY_FN void study_progress(const char *what, double done, double work) {
    double now = study_clock(), spent, left;
    char rate[64] = "";
    int terminal = study_terminal();
    if (study.quiet) return;
    if (strcmp(study.told, what)) {
        snprintf(study.told, sizeof study.told, "%s", what);
        study.begun = study.shown = now;
        study.tenths = (int)(10*done + 1e-9);
        return;
    }
    if (terminal ? now - study.shown < 0.2 && done < 1 : (int)(10*done + 1e-9) <= study.tenths)
        return;
    study.shown = now;
    study.tenths = (int)(10*done + 1e-9);
    spent = now - study.begun;
    left = done < 1 ? spent*(1 - done)/(done > 0 ? done : 1) : spent;
    if (work > 0) snprintf(rate, sizeof rate, "  %6.2f M particle-steps/s", spent > 0 ? 1e-6*work/spent : 0);
    fprintf(stderr, "%s%s %3.0f %%%s  %d:%02d %s%s", terminal ? "\r" : "",
            what, 100*done, rate, (int)left/60, (int)left%60,
            done < 1 ? "left " : "spent", terminal && done < 1 ? "" : "\n");
    fflush(stderr);
    study.open = terminal && done < 1;
    if (done >= 1) study.told[0] = 0;
}

/* ---- sweeps: many cases on all cores ---- */

/* A case computes `result` from `parameter`, and returns 0, or another value if it failed. It runs in a process of its
   own with one thread, where there is fork, so that it can only return its results. Print nothing in it. */
typedef int (*study_case_fn)(const double *parameter, double *result, void *user);
/* A sweep. Its CSV has one row per case: the parameters, then the results, under `heading`. A case whose row is in the
   file is not run again, so that a sweep can be interrupted, extended by further cases, and continued. */
typedef struct study_sweep {
    const char *csv, *heading;    /* name of the file in the present folder; "friction,seed,angle_deg" */
    int cases, parameters, results;
    const double *parameter;      /* cases x parameters */
    study_case_fn run;
    void *user;
    int jobs;                     /* processes at a time; 0: one per core; 1: no process, one case after the other */
} study_sweep;
typedef struct study_job { long id; int at, from; } study_job;      /* process; case; end of the pipe for reading */

/* Writes the row of a case without its results, as it begins in the file. */
STUDY_FN int study_row(char *row, size_t size, const double *value, int count) {
    int k, n = 0;
    for (k = 0; k < count && n < (int)size; k++) n += snprintf(row + n, size - (size_t)n, "%.12g,", value[k]);
    return n;
}
/* Reads the results that the file has. done: by case, 1 if its row is complete. Returns 0 if the file has another
   heading. A row that was cut short is not complete. */
STUDY_FN int study_sweep_read(const study_sweep *s, double *result, char *done, char **text) {
    FILE *file = fopen(study_path(s->csv), "rb");
    char key[1024], *line, *end;
    long size = 0;
    int i, k;
    *text = 0;
    if (!file) return 1;
    fseek(file, 0, SEEK_END);
    size = ftell(file);
    rewind(file);
    *text = (char *)study_alloc((size_t)size + 1, 1);
    size = (long)fread(*text, 1, (size_t)size, file);
    fclose(file);
    (*text)[size] = 0;
    if (!size) return 1;
    end = strchr(*text, '\n');
    if (!end || strlen(s->heading) != (size_t)(end - *text) || strncmp(*text, s->heading, (size_t)(end - *text))) {
        study_fail("%s has other columns than %s; remove the file, or give another name", study_path(s->csv), s->heading);
        return 0;
    }
    for (line = end + 1; (end = strchr(line, '\n')) != 0; line = end + 1)
        for (i = 0; i < s->cases; i++) {
            const int n = study_row(key, sizeof key, s->parameter + i*s->parameters, s->parameters);
            char *at = line + n;
            if (end - line < n || strncmp(line, key, (size_t)n)) continue;
            for (k = 0; k < s->results && at < end; k++) {
                char *next;
                result[i*s->results + k] = strtod(at, &next);
                if (next == at || (*next != ',' && *next != '\n')) break;
                at = next + 1;
            }
            done[i] = (char)(k == s->results && at == end + 1);
        }
    return 1;
}
STUDY_FN void study_sweep_row(const study_sweep *s, FILE *file, const double *result, int at) {
    char key[1024];
    int k;
    study_row(key, sizeof key, s->parameter + at*s->parameters, s->parameters);
    fputs(key, file);
    for (k = 0; k < s->results; k++)
        fprintf(file, "%.9g%c", result[at*s->results + k], k + 1 < s->results ? ',' : '\n');
}
/* Replaces the file by one with all rows in the order of the cases; rows of other cases, which the file had before,
   come last. */
STUDY_FN void study_sweep_write(const study_sweep *s, const double *result, const char *done, const char *before) {
    char key[1024], path[1024], fresh[1040];
    const char *line = before ? strchr(before, '\n') : 0, *end;
    FILE *file;
    int i, bad;
    snprintf(path, sizeof path, "%s", study_path(s->csv));
    snprintf(fresh, sizeof fresh, "%s.tmp", path);
    file = fopen(fresh, "wb");
    if (!file) { study_fail("cannot write %s: %s", fresh, strerror(errno)); return; }
    fprintf(file, "%s\n", s->heading);
    for (i = 0; i < s->cases; i++) if (done[i] == 1) study_sweep_row(s, file, result, i);
    for (; line && (end = strchr(line + 1, '\n')) != 0; line = end) {
        for (i = 0; i < s->cases; i++) {
            const int n = study_row(key, sizeof key, s->parameter + i*s->parameters, s->parameters);
            if (!strncmp(line + 1, key, (size_t)n)) break;
        }
        if (i == s->cases) fwrite(line + 1, 1, (size_t)(end - line), file);
    }
    bad = ferror(file);
    bad |= fclose(file);
#ifndef STUDY_POSIX
    remove(path);
#endif
    if (bad || rename(fresh, path)) study_fail("%s was not written in full: is the disk full?", path);
}
#ifdef STUDY_POSIX
/* Starts a case in a process of its own. Returns 0 if the system refuses one. */
STUDY_FN int study_job_start(const study_sweep *s, int at, study_job *job) {
    int ends[2], bad;
    double *result;
    if (pipe(ends)) return 0;
    fflush(0);
    job->id = (long)fork();
    job->at = at;
    job->from = ends[0];
    if (job->id < 0) { close(ends[0]); close(ends[1]); return 0; }
    if (job->id) { close(ends[1]); return 1; }
#ifdef _OPENMP
    omp_set_num_threads(1);
#endif
    result = (double *)study_alloc((size_t)s->results, sizeof *result);
    bad = s->run(s->parameter + at*s->parameters, result, s->user) != 0;
    fflush(0);
    bad |= write(ends[1], result, (size_t)s->results*sizeof *result) != (long)((size_t)s->results*sizeof *result);
    _exit(bad);
    return 0;                     /* never reached */
}
/* Waits for the end of any of `count` jobs, reads its results and returns its index; *good: 1 if it has them. */
STUDY_FN int study_job_end(const study_sweep *s, const study_job *job, int count, double *result, int *good) {
    int state, k;
    for (;;) {
        const long id = (long)wait(&state);
        for (k = 0; k < count && job[k].id != id; k++) {}
        if (k < count || (id < 0 && errno != EINTR)) break;
    }
    if (k == count) k = 0;        /* no child is left: somebody else has waited for it */
    *good = read(job[k].from, result + job[k].at*s->results, (size_t)s->results*sizeof *result) ==
        (long)((size_t)s->results*sizeof *result) && WIFEXITED(state) && !WEXITSTATUS(state);
    close(job[k].from);
    return k;
}
#endif
/* Books a case that ended: appends its row to the file. */
STUDY_FN void study_sweep_book(const study_sweep *s, const double *result, char *done, int at, int good, int ended) {
    char key[1024];
    const int n = study_row(key, sizeof key, s->parameter + at*s->parameters, s->parameters);
    FILE *file = good ? fopen(study_path(s->csv), "ab") : 0;
    done[at] = (char)(good ? 1 : 2);
    if (file) study_sweep_row(s, file, result, at);
    if (!good) study_fail("%s: the case %.*s failed; it is run again next time", s->csv, n - 1, key);
    else if (!file || fclose(file)) study_fail("cannot write %s", study_path(s->csv));
    study_progress(s->csv, (double)ended/s->cases, 0);
}
/* Runs the cases whose rows are missing, and writes the CSV after each. result: cases x results; the rows of failed
   cases hold NaN. Returns the number of cases that were run now, -1 if the CSV is that of another sweep. */
STUDY_FN int study_sweep_run(const study_sweep *s, double *result) {
    char *done = (char *)study_alloc((size_t)s->cases, 1), *before = 0;
    int i, k, ran = 0, ended = 0;
    if (!study_sweep_read(s, result, done, &before)) { free(done); free(before); return -1; }
    study_sweep_write(s, result, done, before);         /* without rows that were cut short */
    for (i = 0; i < s->cases; i++) ended += done[i];
    study_progress(s->csv, (double)ended/s->cases, 0);
#ifdef STUDY_POSIX
    if (s->jobs != 1) {
        const int most = s->jobs > 0 ? s->jobs : (int)sysconf(_SC_NPROCESSORS_ONLN);
        study_job *job = (study_job *)study_alloc((size_t)(most > 0 ? most : 1), sizeof *job);
        int running = 0, good;
        for (i = 0; i < s->cases || running;) {
            if (i < s->cases && done[i]) { i++; continue; }
            if (i < s->cases && running < most && study_job_start(s, i, &job[running])) { i++; running++; continue; }
            if (!running) break;  /* the system starts no process: the loop below runs the rest */
            k = study_job_end(s, job, running, result, &good);
            study_sweep_book(s, result, done, job[k].at, good, ended + ++ran);
            job[k] = job[--running];
        }
        free(job);
    }
#endif
    for (i = 0; i < s->cases; i++)
        if (!done[i]) {
            const int good = !s->run(s->parameter + i*s->parameters, result + i*s->results, s->user);
            study_sweep_book(s, result, done, i, good, ended + ++ran);
        }
    study_sweep_write(s, result, done, before);
    for (i = 0; i < s->cases; i++)
        for (k = 0; k < s->results && done[i] == 2; k++) result[i*s->results + k] = (double)NAN;
    study.files++;
    free(done);
    free(before);
    return ran;
}
/* Returns the mean of `count` values, `step` apart, without NaN; *error, unless null: its standard error. */
STUDY_FN double study_mean(const double *value, int count, int step, double *error) {
    double sum = 0, square = 0;
    int i, n = 0;
    for (i = 0; i < count; i++) if (value[i*step] == value[i*step]) { sum += value[i*step]; n++; }
    for (i = 0; i < count; i++)
        if (value[i*step] == value[i*step]) square += (value[i*step] - sum/n)*(value[i*step] - sum/n);
    if (error) *error = n > 1 ? sqrt(square/(n - 1)/n) : (double)NAN;
    return n ? sum/n : (double)NAN;
}
/* Prints the mean of a result over `count` runs and, of several, its standard error. */
STUDY_FN void study_mean_tell(const char *name, const double *value, int count, const char *unit) {
    char text[96];
    double error;
    study_result(name, study_mean(value, count, 1, &error), unit);
    snprintf(text, sizeof text, "%s_error", name);
    if (count > 1) study_result(text, error, unit);
}

/* ---- pictures ---- */

typedef enum study_style {
    STUDY_LINE, STUDY_DASHED, STUDY_FAINT, STUDY_DOTS, STUDY_OUTLINE
} study_style;
typedef struct study_series {
    const char *name;             /* in the legend; null: not in it */
    study_style style;
    int count;
    const double *x, *y;
} study_series;

/* A figure: curves over a map (value), over arrows (u, v) or over discs (disc_*). Set all to zero, then
   fill it in. */
#define STUDY_CURVES 40
typedef struct study_figure {
    const char *title, *x_label, *y_label;
    double size;                  /* width of the plot; 0: 620 */
    double x0, x1, y0, y1;        /* range; equal: that of the curves */
    int equal, log_x, log_y;      /* one scale for both axes; logarithmic axes */
    int curve_count;
    study_series curves[STUDY_CURVES];
    int nx, ny;                   /* cells over the range */
    const double *value;          /* map, nx x ny; NaN stays white */
    const double *u, *v;          /* nx x ny arrows, coloured by length */
    int disc_count;
    const double *disc_x, *disc_y, *disc_r, *disc_value;
    const char *bar_label;
    double lo, hi;                /* range of the colours; equal: 0 to the largest */
} study_figure;

STUDY_FN void study_curve(study_figure *f, const char *name, study_style style, int count,
                          const double *x, const double *y) {
    study_series s;
    s.name = name; s.style = style; s.count = count; s.x = x; s.y = y;
    if (f->curve_count < STUDY_CURVES) f->curves[f->curve_count++] = s;
}

/* Adds error bars, from y - error to y + error, which live until the program ends. */
STUDY_FN void study_bars(study_figure *f, int count, const double *x, const double *y, const double *error) {
    double *to = (double *)study_alloc(6*(size_t)count, sizeof *to);
    int i, k;
    for (i = 0; i < count; i++)
        for (k = 0; k < 3; k++) {
            to[3*i + k] = k < 2 ? x[i] : (double)NAN;
            to[3*(count + i) + k] = k < 2 ? y[i] + (k ? error[i] : -error[i]) : (double)NAN;
        }
    study_curve(f, 0, STUDY_OUTLINE, 3*count, to, to + 3*count);
}

/* Returns the colour of a value, 0 to 1, in the scale Viridis: its lightness grows evenly, which the colour-blind see, too.
   Valid until the next call. */
STUDY_FN const char *study_colour(double t) {
    static const unsigned char anchor[11][3] = {
        {68, 1, 84}, {72, 36, 117}, {65, 68, 135}, {53, 95, 141}, {42, 120, 142}, {33, 145, 140},
        {34, 168, 132}, {68, 191, 112}, {122, 209, 81}, {189, 223, 38}, {253, 231, 37}};
    static char text[8];
    double at = 10*(t > 0 ? t < 1 ? t : 1 : 0);
    unsigned i = at < 10 ? (unsigned)at : 9, c, rgb[3];
    for (c = 0; c < 3; c++)
        rgb[c] = (unsigned)(anchor[i][c] + (at - i)*(anchor[i + 1][c] - anchor[i][c]) + 0.5) & 255u;
    snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    return text;
}

STUDY_FN void study_text(FILE *f, double x, double y, const char *anchor, int size, int turn,
                         const char *text) {
    fprintf(f, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\"", x, y, anchor,
            size);
    if (size > 16) fputs(" font-weight=\"bold\"", f);
    if (turn) fprintf(f, " transform=\"rotate(-90 %.1f %.1f)\"", x, y);
    for (fputc('>', f); *text; text++)
        if (*text == '&' || *text == '<') fputs(*text == '&' ? "&amp;" : "&lt;", f);
        else fputc(*text, f);
    fputs("</text>\n", f);
}

/* Chooses about `most` ticks at 1, 2 or 5 times a power of ten; on a logarithmic axis at powers of
   ten. */
STUDY_FN int study_ticks(double lo, double hi, int logarithmic, int most, double at[20]) {
    int count = 0, k;
    double step = 1, power, want = (hi - lo)/most;
    if (!logarithmic) {
        power = pow(10, floor(log10(want)));
        step = power*(want <= power ? 1 : want <= 2*power ? 2 : want <= 5*power ? 5 : 10);
    }
    for (k = (int)ceil(lo/step - 1e-6); k*step <= hi + 1e-6*step && count < 20; k++)
        at[count++] = k*step;
    return count;
}

/* Returns the level of colour of a cell, of 64; -1 for an empty cell. */
STUDY_FN int study_level(const study_figure *f, int cell, const double *range) {
    double value = f->value ? f->value[cell] : hypot(f->u[cell], f->v[cell]);
    double at = 64*(value - range[0])/(range[1] - range[0]);
    return at != at ? -1 : at < 0 ? 0 : at >= 64 ? 63 : (int)at;
}

/* Draws cells as runs of equal colour (map) or as arrows, one path per colour, so that files are small. */
STUDY_FN void study_cells(FILE *file, const study_figure *f, double left, double top, double w,
                          double h, const double *range) {
    double dx = w/f->nx, dy = h/f->ny, a, b, n, wide;
    int level, k, from;
    for (level = 0; level < 64; level++) {
        fprintf(file, "<path fill=\"%s\"%s d=\"M0 0", study_colour((level + 0.5)/64),
                f->value ? " shape-rendering=\"crispEdges\"" : "");
        for (k = 0; k < f->nx*f->ny; k++) {
            double x = left + (k%f->nx)*dx, y = top + h - (k/f->nx + 1)*dy; /* corner of the cell */
            if (study_level(f, k, range) != level) continue;
            if (f->value) { /* as far as the colour stays the same */
                for (from = k; (k + 1)%f->nx && study_level(f, k + 1, range) == level;) k++;
                a = (k + 1 - from)*dx;
                fprintf(file, "M%.2f %.2fh%.2fv%.2fh%.2fz", x, y, a, dy, -a);
            } else { /* tip, barb, notch, barb; the longest arrow has 2.5 cells */
                a = 2.5*dx*f->u[k]/range[1];
                b = -2.5*dx*f->v[k]/range[1];
                n = hypot(a, b);
                wide = n < 1.1*dx ? 0.3 : 0.16;
                if (n < 0.7*dx && n > 0) { a *= 0.7*dx/n; b *= 0.7*dx/n; }
                fprintf(file, "M%.2f %.2fl%.2f %.2fl%.2f %.2fl%.2f %.2fz", x + (dx + a)/2,
                        y + (dy + b)/2, -a - wide*b, -b + wide*a, 0.22*a + wide*b,
                        0.22*b - wide*a, -0.22*a + wide*b, -0.22*b - wide*a);
            }
        }
        fputs("\"/>\n", file);
    }
}

/* Finds the ranges that the caller left open: r = x0, x1, y0, y1 (logarithms on logarithmic axes), lo, hi. */
STUDY_FN void study_ranges(const study_figure *f, double r[6]) {
    int c, i, axis;
    r[0] = f->x0; r[1] = f->x1; r[2] = f->y0; r[3] = f->y1; r[4] = f->lo; r[5] = f->hi;
    for (axis = 0; axis < 2; axis++) {
        double *lo = r + 2*axis, *hi = lo + 1, room;
        int count = 0, dots = 0, logarithmic = axis ? f->log_y : f->log_x;
        if (*lo != *hi) continue;
        for (c = 0; c < f->curve_count; c++)
            for (i = 0; i < f->curves[c].count; i++) {
                double p = axis ? f->curves[c].y[i] : f->curves[c].x[i];
                if (logarithmic) p = log10(p);
                if (!(fabs(p) < 1e300)) continue;
                if (!count || p < *lo) *lo = p;
                if (!count || p > *hi) *hi = p;
                count++;
                dots |= f->curves[c].style == STUDY_DOTS;
            }
        if (!(*hi > *lo)) { /* a constant */
            room = *lo < 0 || *lo > 0 ? 0.1*fabs(*lo) : 0.5;
            *lo -= room;
            *hi += room;
            continue;
        }
        room = axis ? 0.06*(*hi - *lo) : dots ? 0.03*(*hi - *lo) : 0;
        *hi += room;
        if (axis && !logarithmic && *lo >= 0 && *lo < 0.3**hi) *lo = 0;
        else *lo -= room;
    }
    if (r[4] != r[5]) return;
    for (i = 0; i < f->nx*f->ny; i++)
        r[5] = fmax(r[5], f->value ? f->value[i] : hypot(f->u[i], f->v[i]));
    for (i = 0; i < f->disc_count; i++) r[5] = fmax(r[5], f->disc_value[i]);
    if (r[5] == r[4]) r[5] = r[4] + 1;
}

/* Returns the position of a value between lo and hi on a part of the paper. */
STUDY_FN double study_place(double p, int logarithmic, const double *range, double from,
                            double length) {
    return from + length*((logarithmic ? log10(p) : p) - range[0])/(range[1] - range[0]);
}

/* The beginning of a line's path; a dot. */
STUDY_FN void study_stroke(FILE *file, study_style style, const char *colour) {
    fprintf(file, "<path fill=\"none\" clip-path=\"url(#plot)\" stroke=\"%s\" "
            "stroke-width=\"%s\"%s d=\"", colour, style >= STUDY_FAINT ? "1.2" : "2",
            style == STUDY_DASHED ? " stroke-dasharray=\"7 4\"" : "");
}
STUDY_FN void study_dot(FILE *file, double x, double y, double radius, const char *colour) {
    fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.2f\" fill=\"%s\" stroke=\"#fff\" "
            "stroke-width=\".4\"/>\n", x, y, radius, colour);
}

STUDY_FN void study_rectangle(FILE *file, double x, double y, double w, double h,
                              const char *more) {
    fprintf(file, "<rect x=\"%.1f\" y=\"%.2f\" width=\"%.1f\" height=\"%.2f\" %s/>\n", x, y, w, h,
            more);
}

STUDY_FN void study_figure_write(const study_figure *f, const char *name) {
    static const char *const inks[10] = {"#1b6ca8", "#d1495b", "#2a9d5c", "#8e5ea2", "#e08e0b",
                                         "#5b5b5b", "#17b8c9", "#8a4b1f", "#e377c2", "#a3a500"};
    FILE *file = study_open(name);
    double r[6], at[20], left = 86, top = 52, w = f->size > 0 ? f->size : 620, h = 0.62*w;
    double right = 40, bottom = 64;
    int bar = f->value || f->u || f->disc_count, c, i, count, ink = 0, entry = 0;
    char text[96];
    if (!file) return;
    study_ranges(f, r);
    if (f->equal) h = w*(r[3] - r[2])/(r[1] - r[0]);
    for (c = 0; c < f->curve_count; c++)
        if (f->curves[c].name) right = fmax(right, 68 + 7.8*(double)strlen(f->curves[c].name));
    if (bar) right += right > 40 ? 90 : 64;

    /* paper, grid, ticks, labels */
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
            "font-family=\"Helvetica, Arial, sans-serif\" fill=\"#222\">\n", left + w + right,
            top + h + bottom);
    study_rectangle(file, 0, 0, left + w + right, top + h + bottom, "fill=\"#fff\"");
    study_text(file, left, 32, "start", 18, 0, f->title);
    for (c = 0; c < 2; c++) { /* the axes: 0 x, 1 y */
        int logarithmic = c ? f->log_y : f->log_x;
        count = study_ticks(r[2*c], r[2*c + 1], logarithmic, c ? 7 : 8, at);
        for (i = 0; i < count; i++) {
            double p = study_place(at[i], 0, r + 2*c, c ? top + h : left, c ? -h : w);
            double x = c ? left : p, y = c ? p : top + h;
            char along = c ? 'h' : 'v';
            if (!bar)
                fprintf(file, "<path d=\"M%.1f %.1f%c%.1f\" stroke=\"#e4e4e4\"/>\n", x, y, along,
                        c ? w : -h);
            fprintf(file, "<path d=\"M%.1f %.1f%c%d\" stroke=\"#222\"/>\n", x, y, along,
                    c ? -5 : 5);
            snprintf(text, sizeof text, "%.6g", logarithmic ? pow(10, at[i]) : at[i]);
            study_text(file, c ? x - 9 : x, c ? y + 5 : y + 21, c ? "end" : "middle", 14, 0, text);
        }
    }
    study_text(file, left + w/2, top + h + 48, "middle", 15, 0, f->x_label);
    study_text(file, 22, top + h/2, "middle", 15, 1, f->y_label);
    fputs("<clipPath id=\"plot\">\n", file);
    study_rectangle(file, left, top, w, h, "");
    fputs("</clipPath>\n", file);

    /* map or arrows, discs, frame */
    if (f->value || f->u) study_cells(file, f, left, top, w, h, r + 4);
    for (i = 0; i < f->disc_count; i++)
        study_dot(file, study_place(f->disc_x[i], 0, r, left, w),
                  study_place(f->disc_y[i], 0, r + 2, top + h, -h), w*f->disc_r[i]/(r[1] - r[0]),
                  study_colour((f->disc_value[i] - r[4])/(r[5] - r[4])));
    study_rectangle(file, left, top, w, h, "fill=\"none\" stroke=\"#222\"");

    /* curves and legend */
    for (c = 0; c < f->curve_count; c++) {
        const study_series *s = &f->curves[c];
        const char *colour = s->style == STUDY_OUTLINE ? "#222" :
                             s->style == STUDY_FAINT ? "#b9c4cd" : inks[ink++%10];
        double x, y, px = 0, py = 0;
        int down = 0;
        if (s->style != STUDY_DOTS) study_stroke(file, s->style, colour);
        for (i = 0; i < s->count; i++) {
            x = study_place(s->x[i], f->log_x, r, left, w);
            y = study_place(s->y[i], f->log_y, r + 2, top + h, -h);
            if (!(fabs(x) < 1e6 && fabs(y) < 1e6)) down = 0; /* not a number: a gap */
            else if (s->style == STUDY_DOTS) study_dot(file, x, y, 3.5, colour);
            else if (!down || i + 1 == s->count || fabs(x - px) > 0.4 || fabs(y - py) > 0.4) {
                fprintf(file, "%c%.1f %.1f", down++ ? 'L' : 'M', x, y);
                px = x;
                py = y;
            }
        }
        if (s->style != STUDY_DOTS) fputs("\"/>\n", file);
        if (!s->name) continue;
        x = left + w + 16 + (bar ? 90 : 0);
        y = top + 12 + 22*entry++;
        if (s->style == STUDY_DOTS) study_dot(file, x + 12, y, 3.5, colour);
        else {
            study_stroke(file, s->style, colour);
            fprintf(file, "M%.1f %.1fh24\" style=\"clip-path:none\"/>\n", x, y);
        }
        study_text(file, x + 31, y + 5, "start", 14, 0, s->name);
    }

    /* colour bar */
    for (i = 0; i < 64 && bar; i++) {
        snprintf(text, sizeof text, "fill=\"%s\" shape-rendering=\"crispEdges\"",
                 study_colour((i + 0.5)/64));
        study_rectangle(file, left + w + 18, top + h*(63 - i)/64, 16, h/64 + 0.5, text);
    }
    count = bar ? study_ticks(r[4], r[5], 0, 7, at) : 0;
    for (i = 0; i < count; i++) {
        snprintf(text, sizeof text, "%.6g", at[i]);
        study_text(file, left + w + 40, study_place(at[i], 0, r + 4, top + h, -h) + 5, "start", 14,
                   0, text);
    }
    if (bar && f->bar_label)
        study_text(file, left + w + 92, top + h/2, "middle", 15, 1, f->bar_label);
    fputs("</svg>\n", file);
    study_close(file, name);
}

#endif /* STUDY_H */
