/* moldyn.h - the files of MOLDYN, the program of [ALK07]: scenes in and out (.cin, .pin, .win),
   frames for the viewers XBALLS (.xb) and ANIM (.str). MIT licence.

   One C99 or C++11 file. Including it in one source is all there is to do: every function is
   static. It uses public functions of dem.h only, and includes it unless that has been done. Memory
   comes from malloc. A scene given by three files runs like this:

       moldyn m = MOLDYN;
       if (moldyn_read(&m, "a.cin", "a.pin", "a.win") != DEM_OK) puts(m.error);
       dem_world_desc desc = moldyn_desc(&m);
       dem_world *world = dem_world_create(&desc);
       if (moldyn_add(&m, world) != DEM_OK) puts(m.error);
       dem_world_run(world, m.end - m.start, 0, 0);
       moldyn_take(&m, world);                     now m holds the grains as they are
       moldyn_write(&m, "b.cin", "b.pin", "b.win");
       moldyn_free(&m);

   Source: the appendix of [ALK07] (the key is that of dem.h's manual). All numbers are in SI units.
     .cin  one key and its value a line; the keys are in moldyn_keys below, with their ranges.
           Required: times.tend, times.dt, control.rho, sd.stiff_lo. All others are 0 by default
     .pin  the number of grains; then a row each: place, velocity, three angles, spin, radius, and
           1 if the grain moves, 0 if it stands still
     .win  the number of walls and their thickness; then a row each: normal, centre
   In space z points up, and rows have 14 numbers (grains) and 6 (walls), as in the appendix. In a
   plane y points up, and rows have 8 (x y, velocity, angle, spin, radius, flag) and 4 (normal,
   centre); the appendix shows no such file, so this is our reading. Numbers are decimal, with a
   point whatever the locale says, within +-1e15. # begins a comment.

   Not in the files, so chosen here: Poisson's ratio is 0.25, which sets the tangential stiffness to
   0.857 of the normal one. Angles are read and written, but a sphere has no use for them. The
   viewers' figures in the appendix are those of a plane, although its text speaks of space.

   Errors. A function that can fail returns a dem_result and leaves one sentence in moldyn.error:
   the call, the file and line or the value, the limit, the likely cause, the remedy.
   DEM_ERROR_FORMAT: a file is not what it should be; DEM_ERROR_FILE: it cannot be opened, read,
   written or renamed; DEM_ERROR_ARGUMENT: a null pointer (if it is that of the moldyn, without a
   sentence) or a value out of its range; DEM_ERROR_MEMORY. Nothing is printed, nothing exits.
   What a file announces is compared with its size before memory is taken.
   Tests: tests/test_moldyn.c; `make fuzz` feeds moldyn_parse with any bytes. */
#ifndef MOLDYN_H
#define MOLDYN_H
#ifndef DEM_H
#include "../dem.h"
#endif
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(__GNUC__) && !defined(__TINYC__)
#define MOLDYN_API static __attribute__((unused))
#define MOLDYN_FORMAT(f, a) __attribute__((format(printf, f, a)))
#else
#define MOLDYN_API static
#define MOLDYN_FORMAT(f, a)
#endif

/* A scene. Zero is the default of every field; required are only those said to be. */
typedef struct moldyn {
    double start, end, dt;           /* s; times.t0, tend (required), dt (required, > 0) */
    double gravity;                  /* m/s2, upwards; control.grav */
    double density;                  /* kg/m3, required, > 0; control.rho */
    double friction_static, friction;/* >= 0; control.mue_s (0: the same as mue_d), mue_d */
    double stiffness;                /* N/m, required, > 0, of loading; sd.stiff_lo */
    double stiffness_unloading;      /* N/m, sd.stiff_k_un; up to `stiffness`: the linear law,
                                        which never pulls; above: the hysteretic law */
    double stiffness_adhesion;       /* N/m, >= 0; sd.stiff_adh, which is negative in the file */
    double damping_grain, damping_wall; /* N s/m, >= 0; sd.damp_particle, damp_wall. 0: from
                                        restitution if the law is linear, else none */
    double restitution;              /* 0..1; sd.e. 0: not given, which the linear law takes as 1 */
    double wall_thickness;           /* m, >= 0; surfaces lie half of it before the centres along
                                        the normals, eq 2.60 */
    int planar;                      /* 1: in a plane */
    int grain_count, wall_count;
    dem_real *grains;                /* grain_count x 14: place (m), velocity (m/s), angles, spin
                                        (rad/s), radius (m), 1 if it moves; axes of dem.h */
    dem_real *walls;                 /* wall_count x 6: normal (any length but 0), centre (m) */

    double origin;                   /* s, file's time when the clock of a world stands at 0: a
                                        world's clock cannot be set, so moldyn keeps the
                                        difference. Set by reading a .cin and by moldyn_add */
    dem_material grain_material, wall_material; /* added by moldyn_add */
    dem_wall *planes;                /* wall_count, added by moldyn_add; null before */
    char error[400];                 /* the sentence of the last call that failed */
} moldyn;
static const moldyn MOLDYN_ZERO = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                   {0}, {0}, 0, ""};
#define MOLDYN MOLDYN_ZERO
typedef enum moldyn_file {
    MOLDYN_CONTROL = 0,              /* .cin */
    MOLDYN_PARTICLES,                /* .pin */
    MOLDYN_WALLS                     /* .win */
} moldyn_file;
enum { MOLDYN_GRAIN = 14, MOLDYN_WALL = 6, MOLDYN_GRAIN_FLAT = 8, MOLDYN_WALL_FLAT = 4 };

/* ---- errors, memory, numbers ---- */

static dem_result moldyn_fail(moldyn *m, dem_result result, const char *format,
                              ...) MOLDYN_FORMAT(3, 4);
static dem_result moldyn_fail(moldyn *m, dem_result result, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(m->error, sizeof m->error, format, args);
    va_end(args);
    return result;
}
static dem_result moldyn_null(moldyn *m, const char *call, const char *name) {
    return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: %s is null; give its address", call, name);
}
static dem_result moldyn_no_memory(moldyn *m, const char *call, double count, const char *what) {
    return moldyn_fail(m, DEM_ERROR_MEMORY, "%s: no memory for %.0f %s; free some", call, count,
                       what);
}
/* On the exponent bits, which -ffast-math cannot fold away. */
static int moldyn_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return ((bits >> 52) & 0x7ff) != 0x7ff;
}
static int moldyn_within(double x, double lo, double hi) {
    return moldyn_finite(x) && x >= lo && x <= hi;
}
/* Rows of zeros; null when there is no room or the product overflows. */
static dem_real *moldyn_rows_new(size_t count, size_t wide) {
    const size_t row = wide*sizeof(dem_real);
    return count > (size_t)-1/2/row ? 0 : (dem_real *)calloc(count, row);
}
static dem_vec3 moldyn_vec3(const dem_real *p) { return dem_vec3_make(p[0], p[1], p[2]); }
static void moldyn_vec3_put(dem_real *p, dem_vec3 v) { p[0] = v.x; p[1] = v.y; p[2] = v.z; }

/* Frees the arrays; all is zero then but `error`. */
MOLDYN_API void moldyn_free(moldyn *m) {
    if (!m) return;
    free(m->grains);
    free(m->walls);
    free(m->planes);
    memset(m, 0, offsetof(moldyn, error));
}

/* ---- text in ---- */

/* A text being read, without a zero at its end, and what an error sentence needs. */
typedef struct moldyn_text {
    moldyn *m;
    const char *call, *name;    /* the public function; the file or data it reads */
    const char *word;           /* the present word; null at the end of the text */
    size_t length;              /* of the word; 0 at the end of a line */
    const char *at, *line_end;  /* what is left of the line */
    const char *next, *end;     /* what is left after it */
    long line;                  /* counted from 1 */
    char half[24];              /* 0.5 in this locale: strtod expects its decimal point */
} moldyn_text;

static moldyn_text moldyn_text_make(moldyn *m, const char *call, const char *name,
                                    const char *data, size_t size) {
    moldyn_text t;
    const size_t length = name ? strlen(name) : 0;
    memset(&t, 0, sizeof t);
    t.m = m;
    t.call = call;
    t.name = !name ? "data" : length > 160 ? name + (length - 160) : name;
    t.end = data + size;
    t.next = size >= 3 && memcmp(data, "\xEF\xBB\xBF", 3) == 0 ? data + 3 : data; /* order mark */
    t.at = t.line_end = t.next;
    if (snprintf(t.half, sizeof t.half, "%.1f", 0.5) < 3) memcpy(t.half, "0.5", 4);
    return t;
}
static int moldyn_is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
/* Moves to the next word of the line; 0 when there is none. */
static int moldyn_word(moldyn_text *t) {
    const char *p = t->at;
    while (p < t->line_end && moldyn_is_space(*p)) p++;
    t->word = p;
    while (p < t->line_end && !moldyn_is_space(*p)) p++;
    t->at = p;
    t->length = (size_t)(p - t->word);
    return t->length > 0;
}
/* Moves to the first word of the next line that has one; 0 at the end of the text. */
static int moldyn_line(moldyn_text *t) {
    while (t->next < t->end) {
        const char *p = t->next, *comment;
        t->at = p;
        t->line++;
        while (p < t->end && *p != '\n' && *p != '\r') p++;
        comment = (const char *)memchr(t->at, '#', (size_t)(p - t->at));
        t->line_end = comment ? comment : p;
        if (p < t->end) p += *p == '\r' && t->end - p > 1 && p[1] == '\n' ? 2 : 1;
        t->next = p;
        if (moldyn_word(t)) return 1;
    }
    t->at = t->line_end = t->end;
    t->word = 0;
    t->length = 0;
    return 0;
}
/* Refuses the present word; `expected` says what is allowed. */
static dem_result moldyn_refuse(const moldyn_text *t, const char *expected) {
    char shown[44] = "'";
    const size_t length = t->length < 40 ? t->length : 40;
    size_t i;
    for (i = 0; i < length; i++)
        shown[i + 1] = (char)(t->word[i] >= 32 && t->word[i] < 127 ? t->word[i] : '?');
    shown[length + 1] = '\'';
    return moldyn_fail(t->m, DEM_ERROR_FORMAT, "%s: %s line %ld: found %s where %s", t->call,
                       t->name, t->line, t->length ? shown : t->word ? "the end of the line" :
                       "the end of the file", expected);
}
/* 1 if the present word is this one (given in lower case), in capitals or not. */
static int moldyn_is(const moldyn_text *t, const char *word) {
    size_t i;
    if (t->length != strlen(word)) return 0;
    for (i = 0; i < t->length; i++) {
        const char c = t->word[i];
        if ((c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c) != word[i]) return 0;
    }
    return 1;
}
/* The present word as a decimal number with a point, no nan, inf or hexadecimal; 0 if it is none.
   strtod rounds correctly, but needs a zero at the end and the locale's point: hence the copy. */
static int moldyn_real(const moldyn_text *t, double *value) {
    char copy[160], *end = copy;
    size_t i, n = 0;
    const size_t point = strlen(t->half) - 2;
    int points = 0, bad = t->length == 0 || t->length > 120;
    double number = 0;
    for (i = 0; i < t->length && !bad; i++) {
        const char c = t->word[i];
        if (c == '.' && points++ == 0) {
            memcpy(copy + n, t->half + 1, point);
            n += point;
        } else {
            bad = !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != 'e' && c != 'E';
            copy[n++] = c;
        }
    }
    copy[bad ? 0 : n] = 0;
    if (!bad) number = strtod(copy, &end);
    if (bad || end != copy + n || number > 1e15 || number < -1e15) return 0;
    *value = number < 0 || number > 0 ? number : 0;      /* -0 and 0 are one place */
    return 1;
}
/* The present word as a whole number from 0, of at most 9 digits; 0 if it is none. */
static int moldyn_count(const moldyn_text *t, int *value) {
    size_t i;
    int number = 0;
    if (t->length == 0 || t->length > 9) return 0;
    for (i = 0; i < t->length; i++) {
        if (t->word[i] < '0' || t->word[i] > '9') return 0;
        number = 10*number + (t->word[i] - '0');
    }
    *value = number;
    return 1;
}

/* ---- scenes in ---- */

/* Keys of .cin, where their values go, their ranges, and whether they are required. */
typedef struct moldyn_key { const char *key; size_t at; double lo, hi; int needed; } moldyn_key;
static const moldyn_key moldyn_keys[] = {
    {"times.t0",         offsetof(moldyn, start),               0,     1e15, 0},
    {"times.tend",       offsetof(moldyn, end),                 0,     1e15, 1},
    {"times.dt",         offsetof(moldyn, dt),                  1e-15, 1e15, 1},
    {"control.grav",     offsetof(moldyn, gravity),             -1e15, 1e15, 0},
    {"control.rho",      offsetof(moldyn, density),             1e-15, 1e15, 1},
    {"control.mue_s",    offsetof(moldyn, friction_static),     0,     1e6,  0},
    {"control.mue_d",    offsetof(moldyn, friction),            0,     1e6,  0},
    {"sd.stiff_lo",      offsetof(moldyn, stiffness),           1e-15, 1e15, 1},
    {"sd.stiff_k_un",    offsetof(moldyn, stiffness_unloading), 0,     1e15, 0},
    {"sd.stiff_adh",     offsetof(moldyn, stiffness_adhesion),  -1e15, 0,    0},
    {"sd.damp_particle", offsetof(moldyn, damping_grain),       0,     1e15, 0},
    {"sd.damp_wall",     offsetof(moldyn, damping_wall),        0,     1e15, 0},
    {"sd.e",             offsetof(moldyn, restitution),         0,     1,    0}};
enum { MOLDYN_KEYS = (int)(sizeof moldyn_keys/sizeof *moldyn_keys) };
/* A value as it stands in the file: there adhesion is a slope, which is negative. */
static double moldyn_value(const moldyn *m, const moldyn_key *key) {
    double value;
    memcpy(&value, (const char *)m + key->at, sizeof value);
    return key->hi > 0 || !(value > 0 || value < 0) ? value : -value;
}

/* One line: a key and its value. */
static dem_result moldyn_key_read(moldyn_text *t, moldyn *fresh, unsigned *seen) {
    const moldyn_key *key = 0;
    double value = 0;
    char expected[160];
    int i;
    for (i = 0; i < MOLDYN_KEYS && !key; i++)
        if (moldyn_is(t, moldyn_keys[i].key) && !(*seen >> i & 1u)) key = &moldyn_keys[i];
    if (!key)
        return moldyn_refuse(t, "a key such as times.dt or sd.stiff_lo is expected, each once; "
                             "see the appendix of the thesis");
    *seen |= 1u << (i - 1);
    if (!moldyn_word(t) || !moldyn_real(t, &value) || value < key->lo || value > key->hi) {
        snprintf(expected, sizeof expected, "the value of %s is expected, a number from %g to %g",
                 key->key, key->lo, key->hi);
        return moldyn_refuse(t, expected);
    }
    if (moldyn_word(t))
        return moldyn_refuse(t, "the end of the line is expected: one value to a key");
    if (!(key->hi > 0) && value < 0) value = -value;
    memcpy((char *)fresh + key->at, &value, sizeof value);
    return DEM_OK;
}
static dem_result moldyn_control(moldyn_text *t) {
    moldyn fresh = *t->m;
    unsigned seen = 0;
    char expected[160];
    dem_result result;
    int i;
    while (moldyn_line(t))
        if ((result = moldyn_key_read(t, &fresh, &seen)) != DEM_OK) return result;
    for (i = 0; i < MOLDYN_KEYS; i++)
        if (moldyn_keys[i].needed && !(seen >> i & 1u)) {
            snprintf(expected, sizeof expected, "a line with %s is expected, which has no default",
                     moldyn_keys[i].key);
            return moldyn_refuse(t, expected);
        }
    if ((fresh.friction_static > 0 && fresh.friction_static < fresh.friction) ||
        fresh.end < fresh.start)
        return moldyn_refuse(t, "control.mue_s of at least control.mue_d (or 0: the same) and "
                             "times.tend of at least times.t0 are expected; correct the file");
    fresh.origin = fresh.start;
    *t->m = fresh;
    return DEM_OK;
}

/* Rows of numbers: `wide` of them in space, `flat` in a plane; the first row tells which. */
typedef struct moldyn_table {
    int of_walls, wide, flat, count;
    int known;                  /* has the other file said whether the scene is in a plane? */
    int columns;                /* of the rows read so far; 0: none yet */
    double thickness;           /* of walls */
    dem_real *rows;             /* count x wide */
} moldyn_table;

/* The first line, and whether the file is long enough for what it announces. */
static dem_result moldyn_table_head(moldyn_text *t, moldyn_table *table) {
    double bytes;
    if (!moldyn_line(t) || !moldyn_count(t, &table->count))
        return moldyn_refuse(t, table->of_walls ? "the number of walls is expected"
                             : "the number of grains is expected");
    if (table->of_walls && (!moldyn_word(t) || !moldyn_real(t, &table->thickness) ||
                            table->thickness < 0))
        return moldyn_refuse(t, "the thickness of the walls is expected, a number >= 0 (m)");
    if (moldyn_word(t)) return moldyn_refuse(t, "the end of the line is expected");
    bytes = (double)(t->end - t->next);
    if (bytes < (double)table->count*(2*table->flat - 1))
        return moldyn_fail(t->m, DEM_ERROR_FORMAT, "%s: %s line %ld: found %d rows announced where "
                           "the file has bytes for at most %.0f; was it cut short?", t->call,
                           t->name, t->line, table->count, bytes/(2*table->flat - 1));
    return DEM_OK;
}
/* The numbers of row i; how many there are is looked at, not what they say. */
static dem_result moldyn_row_numbers(moldyn_text *t, moldyn_table *table, int i, double *value) {
    const int planar = t->m->planar, columns = table->columns ? table->columns
        : table->known && planar ? table->flat : table->wide;
    int n = 0, more = moldyn_line(t);
    char expected[200];
    for (; more && n < table->wide; n++, more = moldyn_word(t))
        if (!moldyn_real(t, &value[n]))
            return moldyn_refuse(t, "a decimal number within +-1e15 is expected");
    if (more || (n != table->wide && n != table->flat) ||
        (table->columns && n != table->columns) ||
        (table->known && planar != (n == table->flat))) {
        snprintf(expected, sizeof expected, "row %d of %d is expected with %d numbers, %s", i + 1,
                 table->count, columns, table->columns ? "as the first" : table->known
                 ? "as the other file" : "or fewer in a plane");
        return moldyn_refuse(t, expected);
    }
    table->columns = n;
    return DEM_OK;
}
/* x y u v angle spin radius flag, or all 14. */
static const char *moldyn_grain_set(dem_real *row, const double *value, int flat) {
    static const int to[MOLDYN_GRAIN_FLAT] = {0, 1, 3, 4, 8, 11, 12, 13};
    int k;
    for (k = 0; k < (flat ? MOLDYN_GRAIN_FLAT : MOLDYN_GRAIN); k++)
        row[flat ? to[k] : k] = (dem_real)value[k];
    if (!(row[12] > 0)) return "a radius > 0 (m) in the last column but one is expected";
    return (row[13] < 0 || row[13] > 0) && (row[13] < 1 || row[13] > 1)
        ? "1 (moves) or 0 (stands) in the last column is expected" : 0;
}
/* Normal and centre. */
static const char *moldyn_wall_set(dem_real *row, const double *value, int flat) {
    const int d = flat ? 2 : 3;
    int k, any = 0;
    for (k = 0; k < d; k++) {
        row[k] = (dem_real)value[k];
        row[3 + k] = (dem_real)value[d + k];
        any |= row[k] < 0 || row[k] > 0;
    }
    return any ? 0 : "a normal that is not 0 is expected";
}
static dem_result moldyn_table_rows(moldyn_text *t, moldyn_table *table) {
    int i;
    for (i = 0; i < table->count; i++) {
        dem_real *row = table->rows + (size_t)i*(size_t)table->wide;
        double value[MOLDYN_GRAIN];
        const char *expected;
        const dem_result result = moldyn_row_numbers(t, table, i, value);
        if (result != DEM_OK) return result;
        expected = (table->of_walls ? moldyn_wall_set : moldyn_grain_set)
            (row, value, table->columns == table->flat);
        if (expected) return moldyn_refuse(t, expected);
    }
    if (moldyn_line(t))
        return moldyn_refuse(t, "the end of the file is expected: there are more rows than its "
                             "first line says");
    return DEM_OK;
}
static dem_result moldyn_table_read(moldyn_text *t, int of_walls) {
    moldyn *m = t->m;
    moldyn_table table = {0, MOLDYN_GRAIN, MOLDYN_GRAIN_FLAT, 0, 0, 0, 0, 0};
    dem_result result;
    table.of_walls = of_walls;
    table.known = of_walls ? m->grain_count > 0 : m->wall_count > 0;
    if (of_walls) { table.wide = MOLDYN_WALL; table.flat = MOLDYN_WALL_FLAT; }
    if ((result = moldyn_table_head(t, &table)) != DEM_OK) return result;
    if (table.count) table.rows = moldyn_rows_new((size_t)table.count, (size_t)table.wide);
    if (table.count && !table.rows)
        return moldyn_no_memory(m, t->call, table.count, of_walls ? "walls" : "grains");
    if ((result = moldyn_table_rows(t, &table)) != DEM_OK) {
        free(table.rows);
        return result;
    }
    if (table.count) m->planar = table.columns == table.flat;
    free(of_walls ? m->walls : m->grains);
    if (of_walls) {
        free(m->planes);                        /* they are those of other rows */
        m->planes = 0;
        m->walls = table.rows;
        m->wall_count = table.count;
        m->wall_thickness = table.thickness;
    } else {
        m->grains = table.rows;
        m->grain_count = table.count;
    }
    return DEM_OK;
}
static dem_result moldyn_parse_as(moldyn *m, const char *call, const char *name, moldyn_file file,
                                  const char *data, size_t size) {
    moldyn_text t = moldyn_text_make(m, call, name, data, size);
    return file == MOLDYN_CONTROL ? moldyn_control(&t) : moldyn_table_read(&t,
                                                                           file == MOLDYN_WALLS);
}
/* Reads one of the three files from memory into what the others have filled in (begin with MOLDYN).
   name is for error sentences; null: "data". If it fails, m stays as it was. */
MOLDYN_API dem_result moldyn_parse(moldyn *m, const char *name, moldyn_file file, const void *data,
                                   size_t size) {
    if (!m) return DEM_ERROR_ARGUMENT;
    if (!data && size) return moldyn_null(m, "moldyn_parse", "data");
    if ((int)file < 0 || file > MOLDYN_WALLS)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "moldyn_parse: file is %d, must be "
                           "MOLDYN_CONTROL, MOLDYN_PARTICLES or MOLDYN_WALLS", (int)file);
    return moldyn_parse_as(m, "moldyn_parse", name, file, data ? (const char *)data : "", size);
}

/* Loads a file whole into *bytes, which the caller frees, also after a failure. */
static dem_result moldyn_load(moldyn *m, const char *call, const char *path, char **bytes,
                              size_t *size) {
    size_t room = 0;
    dem_result result = DEM_OK;
    FILE *file;
    errno = 0;
    file = fopen(path, "rb");
    while (file && !feof(file) && !ferror(file) && result == DEM_OK) {
        char *more = *bytes;
        if (*size == room) {
            room = 2*room + 65536;
            more = (char *)realloc(*bytes, room);
        }
        if (more) {
            *bytes = more;
            *size += fread(more + *size, 1, room - *size, file);
        } else result = moldyn_no_memory(m, call, (double)room, "bytes of a file");
    }
    if (result == DEM_OK && (!file || ferror(file)))
        result = moldyn_fail(m, DEM_ERROR_FILE, "%s: cannot read %.160s: %s; check its name and "
                             "permissions", call, path, errno ? strerror(errno) : "unknown cause");
    if (file) fclose(file);
    return result;
}
/* Reads the three files. pin and win may be null: no grains, no walls. What m held is freed first,
   so m must be MOLDYN or filled in before; if reading fails, m is MOLDYN but for the sentence. */
MOLDYN_API dem_result moldyn_read(moldyn *m, const char *cin, const char *pin, const char *win) {
    static const char call[] = "moldyn_read";
    const char *paths[3];
    dem_result result = DEM_OK;
    int k;
    if (!m) return DEM_ERROR_ARGUMENT;
    moldyn_free(m);
    if (!cin) return moldyn_null(m, call, "cin");
    paths[0] = cin; paths[1] = pin; paths[2] = win;
    for (k = 0; k < 3 && result == DEM_OK; k++) {
        char *bytes = 0;
        size_t size = 0;
        if (!paths[k]) continue;
        result = moldyn_load(m, call, paths[k], &bytes, &size);
        if (result == DEM_OK)
            result = moldyn_parse_as(m, call, paths[k], (moldyn_file)k, bytes ? bytes : "", size);
        free(bytes);
    }
    if (result != DEM_OK) moldyn_free(m);
    return result;
}

/* ---- from a scene to a world and back ---- */

static int moldyn_linear(const moldyn *m) { return m->stiffness_unloading <= m->stiffness; }
/* The desc of a world for this scene: law, gravity, time step, plane or space. All other fields are
   yours to set. Of a null moldyn: DEM_WORLD_DESC. */
MOLDYN_API dem_world_desc moldyn_desc(const moldyn *m) {
    dem_world_desc d = DEM_WORLD_DESC;
    if (!m) return d;
    d.planar = m->planar;
    if (m->planar) d.gravity.y = (dem_real)m->gravity;
    else d.gravity.z = (dem_real)m->gravity;
    d.dt = (dem_real)m->dt;
    d.normal_law = moldyn_linear(m) ? DEM_NORMAL_LINEAR : DEM_NORMAL_HYSTERETIC;
    return d;
}

/* A point of the surface of wall i, and its unit normal. */
static void moldyn_plane(const moldyn *m, int i, double *point, double *normal) {
    const dem_real *row = m->walls + (size_t)i*MOLDYN_WALL;
    double most = 0, length = 0;
    int k, e;
    for (k = 0; k < 3; k++) most = fmax(most, fabs((double)row[k]));
    (void)frexp(most, &e);                      /* a power of two: exact, and squares fit */
    for (k = 0; k < 3; k++) {
        normal[k] = ldexp((double)row[k], -e);
        length += normal[k]*normal[k];
    }
    for (k = 0; k < 3; k++) {
        normal[k] /= sqrt(length);
        point[k] = (double)row[3 + k] + normal[k]*m->wall_thickness/2;
    }
}
/* Can dem_real hold the mass of a sphere (or disc 1 m thick), its moment of inertia and the
   inverses of both? */
static int moldyn_weighs(const moldyn *m, double r) {
    const double least = sizeof(dem_real) == sizeof(float) ? 1e-37 : 1e-300;
    const double mass = m->density*3.14159265358979323846*r*r*(m->planar ? 1 : 4*r/3);
    const double inertia = mass*r*r*(m->planar ? 0.5 : 0.4);
    return moldyn_within(mass, least, 1/least) && moldyn_within(inertia, least, 1/least);
}
static dem_result moldyn_grain_check(moldyn *m, const char *call, int i) {
    const dem_real *row = m->grains + (size_t)i*MOLDYN_GRAIN;
    const double radius = (double)row[12], flag = (double)row[13];
    int k, ok = radius > 0 && (flag < 1 ? !(flag < 0 || flag > 0) : !(flag > 1));
    for (k = 0; k < MOLDYN_GRAIN; k++) ok = ok && moldyn_within((double)row[k], -1e15, 1e15);
    if (!ok)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: grain %d has radius %g m and flag %g or a "
                           "number beyond 1e15; must be > 0, and 0 or 1; mend its row in moldyn",
                           call, i, radius, flag);
    if (!moldyn_weighs(m, radius))
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: grain %d has radius %g m, which at %g kg/m3 "
                           "gives it a mass too small or too large to calculate with; lengths are "
                           "in metres: check the unit", call, i, radius, m->density);
    return DEM_OK;
}
static dem_result moldyn_wall_check(moldyn *m, const char *call, int i) {
    const dem_real *row = m->walls + (size_t)i*MOLDYN_WALL;
    double point[3], normal[3];
    int k, ok = 1, any = 0;
    for (k = 0; k < 6; k++) ok = ok && moldyn_within((double)row[k], -1e15, 1e15);
    for (k = 0; k < 3; k++) any = any || row[k] < 0 || row[k] > 0;
    if (ok && any) {
        moldyn_plane(m, i, point, normal);
        for (k = 0; k < 3; k++) ok = ok && moldyn_within(point[k], -1e15, 1e15);
    }
    if (!ok || !any)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: wall %d has normal (%g, %g, %g) and centre "
                           "(%g, %g, %g), must be within +-1e15, and the normal not 0; mend its "
                           "row in moldyn", call, i, (double)row[0], (double)row[1],
                           (double)row[2], (double)row[3], (double)row[4], (double)row[5]);
    return DEM_OK;
}
/* Finds what the files cannot hold, but a moldyn filled in by hand can. */
static dem_result moldyn_check(moldyn *m, const char *call) {
    dem_result result = DEM_OK;
    int i;
    if (m->grain_count < 0 || m->wall_count < 0 || (m->grain_count && !m->grains) ||
        (m->wall_count && !m->walls))
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: grain_count is %d and wall_count %d, must "
                           "be >= 0 with as many rows in grains and walls; mend them in moldyn",
                           call, m->grain_count, m->wall_count);
    for (i = 0; i < MOLDYN_KEYS; i++) {
        const moldyn_key *key = &moldyn_keys[i];
        const double value = moldyn_value(m, key);
        if (!moldyn_within(value, key->lo, key->hi))
            return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: %s is %g, must be %g to %g; mend it in "
                               "moldyn", call, key->key, value, key->lo, key->hi);
    }
    if (!moldyn_within(m->wall_thickness, 0, 1e15) || m->end < m->start ||
        (m->friction_static > 0 && m->friction_static < m->friction))
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: wall_thickness is %g m, must be 0 to 1e15; "
                           "end %g s, must be at least start, %g s; friction_static %g, must be 0 "
                           "or at least friction, %g; mend them in moldyn", call,
                           m->wall_thickness, m->end, m->start, m->friction_static, m->friction);
    for (i = 0; i < m->grain_count && result == DEM_OK; i++)
        result = moldyn_grain_check(m, call, i);
    for (i = 0; i < m->wall_count && result == DEM_OK; i++) result = moldyn_wall_check(m, call, i);
    return result;
}
/* Is the world one for this scene? */
static dem_result moldyn_suits(moldyn *m, const char *call, const dem_world *world) {
    const dem_world_desc have = dem_world_desc_get(world), need = moldyn_desc(m);
    const int bodies = dem_bodies_get(world).count;
    if (!world) return moldyn_null(m, call, "world");
    if (bodies || dem_world_steps(world) || !have.planar != !need.planar ||
        have.normal_law != need.normal_law)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: the world has %d bodies, has made %.0f "
                           "steps, or has another law or dimension; make an empty one with "
                           "moldyn_desc", call, bodies, (double)dem_world_steps(world));
    return DEM_OK;
}
/* The world's own sentence is left to the user: as long as nobody reads it, the world does not run
   without what was refused. */
static dem_result moldyn_refused(moldyn *m, const char *call, dem_result result, const char *what,
                                 int i) {
    return moldyn_fail(m, result, "%s: the world refused %s %d and holds a part of the scene only; "
                       "dem_world_error tells why; destroy the world", call, what, i);
}
static dem_result moldyn_materials_add(moldyn *m, const char *call, dem_world *world) {
    dem_material_desc d = DEM_MATERIAL_DESC;
    dem_material grain, wall;
    dem_pair pair;
    dem_result result;
    d.density = (dem_real)m->density;
    d.poisson = DEM_R(0.25);                    /* kt/kn = .857; the files do not say */
    d.stiffness = (dem_real)m->stiffness;
    if (moldyn_linear(m)) d.restitution = m->restitution > 0 ? (dem_real)m->restitution : 1;
    else {
        d.stiffness_unloading = (dem_real)m->stiffness_unloading;
        d.stiffness_adhesion = (dem_real)m->stiffness_adhesion;
    }
    d.friction = (dem_real)m->friction;
    d.friction_static = (dem_real)m->friction_static;
    m->grain_material = grain = dem_material_add(world, &d);
    m->wall_material = wall = dem_material_add(world, &d);
    if (!grain.id || !wall.id)
        return moldyn_refused(m, call, DEM_ERROR_ARGUMENT, "material", grain.id ? 1 : 0);
    result = dem_pair_get(world, grain, grain, &pair);
    pair.normal_damping = (dem_real)m->damping_grain;
    if (result == DEM_OK) result = dem_pair_set(world, grain, grain, &pair);
    pair.normal_damping = (dem_real)m->damping_wall;
    if (result == DEM_OK) result = dem_pair_set(world, grain, wall, &pair);
    return result == DEM_OK ? DEM_OK : moldyn_refused(m, call, result, "the damping of material",
                                                      0);
}
static dem_result moldyn_planes_add(moldyn *m, const char *call, dem_world *world) {
    int i;
    for (i = 0; i < m->wall_count; i++) {
        double p[3], n[3];
        moldyn_plane(m, i, p, n);
        m->planes[i] = dem_plane_add(world, m->wall_material, dem_vec3_make((dem_real)p[0],
                                     (dem_real)p[1], (dem_real)p[2]), dem_vec3_make((dem_real)n[0],
                                     (dem_real)n[1], (dem_real)n[2]));
        if (!m->planes[i].id) return moldyn_refused(m, call, DEM_ERROR_MEMORY, "wall", i);
    }
    return DEM_OK;
}
static dem_result moldyn_grains_add(moldyn *m, const char *call, dem_world *world) {
    int i;
    for (i = 0; i < m->grain_count; i++) {
        const dem_real *row = m->grains + (size_t)i*MOLDYN_GRAIN;
        const dem_body body = dem_sphere_add(world, m->grain_material, row[12], moldyn_vec3(row));
        dem_body_state s;
        if (!body.slot || dem_body_get(world, body, &s) != DEM_OK)
            return moldyn_refused(m, call, DEM_ERROR_MEMORY, "grain", i);
        s.velocity = moldyn_vec3(row + 3);
        s.spin = moldyn_vec3(row + 9);
        s.fixed = row[13] < DEM_R(0.5);
        if (dem_body_set(world, body, &s) != DEM_OK)
            return moldyn_refused(m, call, DEM_ERROR_MEMORY, "the velocity of grain", i);
    }
    return DEM_OK;
}
/* Adds materials, walls and grains, in the order of their rows, to a world made with moldyn_desc
   that has no bodies yet and has not run. All is checked before any is added; what can still fail
   then is memory: destroy the world. The world's clock begins at 0, not at start. */
MOLDYN_API dem_result moldyn_add(moldyn *m, dem_world *world) {
    static const char call[] = "moldyn_add";
    dem_wall *planes = 0;
    dem_result result;
    if (!m) return DEM_ERROR_ARGUMENT;
    if ((result = moldyn_suits(m, call, world)) != DEM_OK) return result;
    if ((result = moldyn_check(m, call)) != DEM_OK) return result;
    if (m->wall_count) planes = (dem_wall *)calloc((size_t)m->wall_count, sizeof *planes);
    if (m->wall_count && !planes) return moldyn_no_memory(m, call, m->wall_count, "walls");
    free(m->planes);
    m->planes = planes;
    m->origin = m->start - dem_world_time(world);
    result = moldyn_materials_add(m, call, world);
    if (result == DEM_OK) result = moldyn_planes_add(m, call, world);
    return result == DEM_OK ? moldyn_grains_add(m, call, world) : result;
}

/* All bodies of a world as they are now, in the order in which they came. */
typedef struct moldyn_bodies { int count, *index; } moldyn_bodies;
static dem_result moldyn_bodies_get(moldyn *m, const char *call, const dem_world *world,
                                    moldyn_bodies *all) {
    const dem_bodies b = dem_bodies_get(world);
    uint32_t top = 0, slot;
    int i, n = 0;
    all->count = b.count;
    all->index = 0;
    if (!world) return moldyn_null(m, call, "world");
    for (i = 0; i < b.count; i++) top = b.slots[i] > top ? b.slots[i] : top;
    all->index = (int *)malloc(((size_t)top + 1)*sizeof *all->index);
    if (!all->index) return moldyn_no_memory(m, call, b.count, "numbers of bodies");
    for (slot = 0; slot <= top; slot++) all->index[slot] = -1;
    for (i = 0; i < b.count; i++) all->index[b.slots[i]] = i;
    for (slot = 0; slot <= top; slot++)         /* closes the gaps of those that left */
        if (all->index[slot] >= 0) all->index[n++] = all->index[slot];
    return DEM_OK;
}
static dem_body_state moldyn_body(const dem_world *world, const moldyn_bodies *all, int i) {
    dem_body_state s;
    memset(&s, 0, sizeof s);
    dem_body_get(world, dem_bodies_id(world, all->index[i]), &s);
    return s;
}
/* Takes the grains of a world as they are now in place of those of m, in the order in which they
   came; angles are 0. Then start is what it was when they were added plus dem_world_time(world),
   and end at least that. The bodies must be spheres (or discs). If it fails, m stays as it was. */
MOLDYN_API dem_result moldyn_take(moldyn *m, const dem_world *world) {
    static const char call[] = "moldyn_take";
    const dem_bodies b = dem_bodies_get(world);
    moldyn_bodies all;
    dem_real *rows = 0;
    dem_result result;
    int i, shaped = 0;
    if (!m) return DEM_ERROR_ARGUMENT;
    for (i = 0; b.shapes && i < b.count; i++) shaped += b.shapes[i] != 0;
    if (shaped)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: %d bodies are not spheres, which MOLDYN's "
                           "files cannot tell; use dem_vtp_write or a checkpoint", call, shaped);
    if (world && !dem_world_desc_get(world).planar != !m->planar)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: the world is %s and moldyn is not; take "
                           "from a world made with moldyn_desc", call,
                           m->planar ? "in space" : "planar");
    if ((result = moldyn_bodies_get(m, call, world, &all)) != DEM_OK) return result;
    if (all.count) rows = moldyn_rows_new((size_t)all.count, MOLDYN_GRAIN);
    for (i = 0; rows && i < all.count; i++) {
        const dem_body_state s = moldyn_body(world, &all, i);
        dem_real *row = rows + (size_t)i*MOLDYN_GRAIN;
        moldyn_vec3_put(row, s.position);
        moldyn_vec3_put(row + 3, s.velocity);
        moldyn_vec3_put(row + 9, s.spin);
        row[12] = s.radius;
        row[13] = s.fixed ? DEM_R(0) : DEM_R(1);
    }
    free(all.index);
    if (all.count && !rows) return moldyn_no_memory(m, call, all.count, "grains");
    free(m->grains);
    m->grains = rows;
    m->grain_count = all.count;
    m->start = m->origin + dem_world_time(world);
    if (m->end < m->start) m->end = m->start;
    return DEM_OK;
}

/* ---- files out ---- */

/* Writes a number, with a decimal point in every locale, and what comes after it: so many
   significant digits; or, if digits is 0, six decimals. */
static void moldyn_put(FILE *file, double value, int digits, char after) {
    char raw[400], out[400];
    size_t i, n = 0;
    if (digits) snprintf(raw, sizeof raw, "%.*g", digits, value);
    else snprintf(raw, sizeof raw, "%.6f", value);
    for (i = 0; raw[i]; i++) {
        if (strchr("0123456789+-einfa", raw[i])) out[n++] = raw[i];
        else if (n == 0 || out[n - 1] != '.') out[n++] = '.';
    }
    out[n] = 0;
    fprintf(file, "%s%c", out, after);
}

/* A file under a temporary name. What is there but empty (a file, a device such as /dev/null) is
   written to as it is: it has nothing to lose. A symbolic link is replaced by a file. */
typedef struct moldyn_out {
    moldyn *m;
    const char *call, *path;
    char *temporary;            /* path.tmp; null: path itself is written to */
    FILE *file;
} moldyn_out;

/* Ends a file: renames it to its place if all was written, removes it if not. Where rename refuses
   to replace a file (Windows), the old one is removed first; a folder of that name never is. */
static dem_result moldyn_out_close(moldyn_out *o) {
    int whole = o->file && fflush(o->file) == 0 && !ferror(o->file), cause = errno;
    if (o->file && fclose(o->file) != 0 && whole) {
        whole = 0;
        cause = errno;
    }
    if (whole && o->temporary && rename(o->temporary, o->path) != 0) {
        cause = errno;
        whole = (cause == EEXIST || cause == EACCES) && remove(o->path) == 0 &&
                rename(o->temporary, o->path) == 0;
    }
    if (!whole && o->file && o->temporary) remove(o->temporary);
    if (!whole && o->file && !o->temporary) {   /* it was empty: so it is again */
        FILE *empty = fopen(o->path, "wb");
        if (empty) fclose(empty);
    }
    free(o->temporary);
    if (whole) return DEM_OK;
    return moldyn_fail(o->m, DEM_ERROR_FILE, "%s: cannot write %.160s: %s; check that its folder "
                       "exists, may be written to and has room", o->call, o->path,
                       cause ? strerror(cause) : "unknown cause");
}
/* Begins a file. If this fails there is nothing to close. */
static dem_result moldyn_out_open(moldyn_out *o, moldyn *m, const char *call, const char *path) {
    const size_t length = strlen(path);
    FILE *there = fopen(path, "r+b");           /* of a pipe: does not wait for its other end */
    memset(o, 0, sizeof *o);
    o->m = m;
    o->call = call;
    o->path = path;
    if (there && fseek(there, 0, SEEK_END) != 0) {
        fclose(there);
        return moldyn_fail(m, DEM_ERROR_FILE, "%s: %.160s is a pipe or a terminal, must be a file, "
                           "which is written whole or not at all; write a file and send that",
                           call, path);
    }
    errno = 0;
    if (there && ftell(there) == 0) {
        o->file = there;
        return DEM_OK;
    }
    if (there) fclose(there);
    o->temporary = (char *)malloc(length + 5);
    if (!o->temporary) return moldyn_no_memory(m, call, (double)length, "letters of a file name");
    memcpy(o->temporary, path, length);
    memcpy(o->temporary + length, ".tmp", 5);
    errno = 0;
    o->file = fopen(o->temporary, "wb");
    return o->file ? DEM_OK : moldyn_out_close(o);
}
/* The columns of rows that a file has: all, or those named by `flat` in a plane. */
static void moldyn_rows_put(FILE *file, const dem_real *rows, int count, int wide, int columns,
                            const int *flat) {
    int i, k;
    for (i = 0; i < count; i++)
        for (k = 0; k < columns; k++)
            moldyn_put(file, (double)rows[(size_t)i*(size_t)wide + (size_t)(flat ? flat[k] : k)],
                       17, k + 1 < columns ? ' ' : '\n');
}
static void moldyn_file_put(FILE *file, const moldyn *m, moldyn_file which) {
    static const int grain[MOLDYN_GRAIN_FLAT] = {0, 1, 3, 4, 8, 11, 12, 13};
    static const int wall[MOLDYN_WALL_FLAT] = {0, 1, 3, 4};
    const int planar = m->planar != 0;
    int i;
    if (which == MOLDYN_CONTROL)
        for (i = 0; i < MOLDYN_KEYS; i++) {
            fprintf(file, "%-17s ", moldyn_keys[i].key);
            moldyn_put(file, moldyn_value(m, &moldyn_keys[i]), 17, '\n');
        }
    if (which == MOLDYN_PARTICLES) {
        fprintf(file, "%d\n", m->grain_count);
        moldyn_rows_put(file, m->grains, m->grain_count, MOLDYN_GRAIN,
                        planar ? MOLDYN_GRAIN_FLAT : MOLDYN_GRAIN, planar ? grain : 0);
    }
    if (which == MOLDYN_WALLS) {
        fprintf(file, "%d ", m->wall_count);
        moldyn_put(file, m->wall_thickness, 17, '\n');
        moldyn_rows_put(file, m->walls, m->wall_count, MOLDYN_WALL,
                        planar ? MOLDYN_WALL_FLAT : MOLDYN_WALL, planar ? wall : 0);
    }
}
/* Writes the three files; null paths are left out. Each is written to a temporary name (path.tmp)
   and renamed, so that a file that was there stays whole on failure. Read back, they are the same
   numbers. */
MOLDYN_API dem_result moldyn_write(moldyn *m, const char *cin, const char *pin, const char *win) {
    const char *paths[3];
    dem_result result;
    int k;
    if (!m) return DEM_ERROR_ARGUMENT;
    paths[0] = cin; paths[1] = pin; paths[2] = win;
    result = moldyn_check(m, "moldyn_write");
    for (k = 0; k < 3 && result == DEM_OK; k++) {
        moldyn_out o;
        if (!paths[k]) continue;
        result = moldyn_out_open(&o, m, "moldyn_write", paths[k]);
        if (result != DEM_OK) return result;
        moldyn_file_put(o.file, m, (moldyn_file)k);
        result = moldyn_out_close(&o);
    }
    return result;
}

/* ---- frames ---- */

/* Opens a file to append to; *fresh: it is new or empty. */
static FILE *moldyn_append_open(moldyn *m, const char *call, const char *path, int *fresh) {
    FILE *file = fopen(path, "ab");
    *fresh = file && fseek(file, 0, SEEK_END) == 0 && ftell(file) == 0;
    if (!file) moldyn_fail(m, DEM_ERROR_FILE, "%s: cannot append to %.160s; check that its folder "
                           "exists and may be written to", call, path);
    return file;
}
static dem_result moldyn_append_close(moldyn *m, const char *call, const char *path, FILE *file) {
    const int bad = ferror(file);
    if (fclose(file) || bad)
        return moldyn_fail(m, DEM_ERROR_FILE, "%s: %.160s was not written in full; is the disk "
                           "full?", call, path);
    return DEM_OK;
}
/* Appends a frame for XBALLS: a line with count, time (s, of the file: origin + dem_world_time) and
   the corners of box; then a line a grain: x, y (in space: z), their velocities, radius, spin. The
   text of the appendix calls these six numbers place and velocity in space. m: MOLDYN will do, if
   there is no other; it holds the origin of time and the sentence. */
MOLDYN_API dem_result moldyn_xb_append(moldyn *m, const dem_world *world, const char *path,
                                       dem_box box) {
    static const char call[] = "moldyn_xb_append";
    const int planar = dem_world_desc_get(world).planar;
    moldyn_bodies all;
    FILE *file;
    dem_result result;
    int i, fresh;
    if (!m) return DEM_ERROR_ARGUMENT;
    if (!path) return moldyn_null(m, call, "path");
    if ((result = moldyn_bodies_get(m, call, world, &all)) != DEM_OK) return result;
    file = moldyn_append_open(m, call, path, &fresh);
    if (!file) { free(all.index); return DEM_ERROR_FILE; }
    fprintf(file, "%d ", all.count);
    moldyn_put(file, m->origin + dem_world_time(world), 12, ' ');
    moldyn_put(file, (double)box.lo.x, 0, ' ');
    moldyn_put(file, (double)(planar ? box.lo.y : box.lo.z), 0, ' ');
    moldyn_put(file, (double)box.hi.x, 0, ' ');
    moldyn_put(file, (double)(planar ? box.hi.y : box.hi.z), 0, '\n');
    for (i = 0; i < all.count; i++) {
        const dem_body_state s = moldyn_body(world, &all, i);
        moldyn_put(file, (double)s.position.x, 0, ' ');
        moldyn_put(file, (double)(planar ? s.position.y : s.position.z), 0, ' ');
        moldyn_put(file, (double)s.velocity.x, 0, ' ');
        moldyn_put(file, (double)(planar ? s.velocity.y : s.velocity.z), 0, ' ');
        moldyn_put(file, (double)s.radius, 0, ' ');
        moldyn_put(file, (double)(planar ? s.spin.z : -s.spin.y), 0, '\n');  /* anticlockwise */
    }
    free(all.index);
    return moldyn_append_close(m, call, path, file);
}

static void moldyn_str_row(FILE *file, const dem_real *R, dem_vec3 x) {
    int k;
    for (k = 0; k < 9; k++) {
        const int whole = R[k] >= 1 && R[k] <= 1 ? 1 : R[k] >= 0 && R[k] <= 0 ? 0 : -1;
        if (whole >= 0) fprintf(file, "%d ", whole);
        else moldyn_put(file, (double)R[k], 0, ' ');
    }
    moldyn_put(file, (double)x.x, 0, ' ');
    moldyn_put(file, (double)x.y, 0, ' ');
    moldyn_put(file, (double)x.z, 0, '\n');
}
static void moldyn_str_body(FILE *file, const dem_body_state *s) {
    dem_real R[9];
    int i;
    for (i = 0; i < 3; i++) {
        const dem_vec3 e = dem_quat_rotate(s->orientation, dem_vec3_make(i == 0, i == 1, i == 2));
        R[i] = e.x; R[3 + i] = e.y; R[6 + i] = e.z;
    }
    moldyn_str_row(file, R, s->position);
}
/* Does the head of the file, "interval frames bodies", say so many bodies? */
static int moldyn_str_holds(const char *path, int bodies) {
    char head[200] = "", *at = head;
    FILE *file = fopen(path, "rb");
    int k, ok = file && fgets(head, sizeof head, file);
    if (file) fclose(file);
    for (k = 0; k < 2 && ok; k++) {
        at += strcspn(at, " ");
        at += strspn(at, " ");
    }
    return ok && strtol(at, 0, 10) == bodies;
}
static dem_result moldyn_str_check(moldyn *m, const char *call, const dem_world *world,
                                   const char *path, double interval, int frames,
                                   const dem_wall *walls, int wall_count) {
    dem_pose pose;
    int i;
    if (!world || !path) return moldyn_null(m, call, world ? "path" : "world");
    if (!moldyn_within(interval, 0, 1e15) || frames < 0)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: interval is %g s and frames %d, must be "
                           "0 to 1e15 and >= 0", call, interval, frames);
    if (wall_count < 0 || (wall_count && !walls))
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: wall_count is %d, must be >= 0 with as many "
                           "walls; give m.planes and m.wall_count, or 0", call, wall_count);
    for (i = 0; i < wall_count; i++)
        if (dem_wall_pose(world, walls[i], &pose) != DEM_OK)
            return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: walls[%d] has id %ld, which the world "
                               "does not have; leave out walls that were removed", call, i,
                               (long)walls[i].id);
    return DEM_OK;
}
/* Appends a frame for ANIM. A new file begins with interval (s, >= 0, between frames), frames (how
   many there will be) and the number of bodies. Then a line a grain and a line a wall: rotation
   matrix and place (m); the identity for spheres that nothing turns. walls: those to draw, such as
   m.planes; null if wall_count is 0. The number of bodies must stay what it was. */
MOLDYN_API dem_result moldyn_str_append(moldyn *m, const dem_world *world, const char *path,
                                        double interval, int frames, const dem_wall *walls,
                                        int wall_count) {
    static const char call[] = "moldyn_str_append";
    moldyn_bodies all;
    FILE *file;
    dem_result result;
    int i, fresh;
    if (!m) return DEM_ERROR_ARGUMENT;
    result = moldyn_str_check(m, call, world, path, interval, frames, walls, wall_count);
    if (result != DEM_OK) return result;
    if ((result = moldyn_bodies_get(m, call, world, &all)) != DEM_OK) return result;
    file = moldyn_append_open(m, call, path, &fresh);
    if (!file) { free(all.index); return DEM_ERROR_FILE; }
    if (!fresh && !moldyn_str_holds(path, all.count + wall_count)) {
        fclose(file);
        free(all.index);
        return moldyn_fail(m, DEM_ERROR_FORMAT, "%s: %.160s is not of %d bodies, as there are now "
                           "(%d grains, %d walls), and its format has one number for all frames; "
                           "begin a new file", call, path, all.count + wall_count, all.count,
                           wall_count);
    }
    if (fresh) {
        moldyn_put(file, interval, 12, ' ');
        fprintf(file, "%d %d\n", frames, all.count + wall_count);
    }
    for (i = 0; i < all.count; i++) {
        const dem_body_state s = moldyn_body(world, &all, i);
        moldyn_str_body(file, &s);
    }
    for (i = 0; i < wall_count; i++) {
        dem_pose pose;
        if (dem_wall_pose(world, walls[i], &pose) == DEM_OK)
            moldyn_str_row(file, pose.rotation, pose.position);
    }
    free(all.index);
    return moldyn_append_close(m, call, path, file);
}
#endif
