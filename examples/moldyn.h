/* moldyn.h - the files of MOLDYN, the program of [ALK07]: scenes in and out (.cin, .pin, .win),
   frames for the viewers XBALLS (.xb) and ANIM (.str). MIT licence.

   One C99 or C++11 file. Include it in one source file; all functions are static. It uses only
   public functions of dem.h, which it includes if you have not done so. Memory comes from malloc.
   This runs a scene given by three files:

       moldyn m = MOLDYN;
       if (moldyn_read(&m, "a.cin", "a.pin", "a.win") != DEM_OK) puts(m.error);
       dem_world_desc desc = moldyn_desc(&m);
       dem_world *world = dem_world_create(&desc);
       if (moldyn_add(&m, world) != DEM_OK) puts(m.error);
       dem_world_run(world, m.end - m.start, 0, 0);
       moldyn_take(&m, world);                     now m holds the present grains
       moldyn_write(&m, "b.cin", "b.pin", "b.win");
       moldyn_free(&m);

   Source: the appendix of [ALK07] (the key is that of dem.h's manual). All numbers are in SI units.
     .cin  one key and its value per line; moldyn_keys below lists the keys and their ranges.
           Required: times.tend, times.dt, control.rho, sd.stiff_lo. All others are 0 by default
     .pin  the number of grains; then one row per grain: position, velocity, three angles, spin,
           radius, and 1 if the grain moves, 0 if it is fixed
     .win  the number of walls and their thickness; then one row per wall: normal, centre
   In space z points up, and rows have 14 numbers (grains) and 6 (walls), as in the appendix. In a
   plane y points up, and rows have 8 (x y, velocity, angle, spin, radius, flag) and 4 (normal,
   centre); the appendix shows no such file, so this is our interpretation. Numbers are decimal, with
   a point in every locale, within +-1e15. # begins a comment.

   Polygons, in a plane. According to [ALK07] 2.4.2, MOLDYN has convex and concave ones, and walls
   given by their end points. The appendix shows no file with them, so the format is our
   interpretation, too. A .pin or .win may begin with outlines, and the rest follows as above. Write
   the number of outlines; then for each outline the number of its corners and one row x y (m) per
   corner. Corners follow each other along the outline, in either direction, each once:
     .pin  polygons 2                     .win  polygons 1      # closed: last corner to first
           3                                    4
           0 0                                  -1 0
           .02 0                                ... three more corners
           0 .01                                chains 1        # open
           6                                    2
           ... six corners, two kinds           0 0
           1                                    .1 .02
           0 .1 0 0 .5 0 1 1 2                  0 .003          # no straight walls
   Rows of grains then have a ninth number: 0 for a disc, otherwise the number of its polygon, from 1.
   The seventh number is a factor on all lengths of that polygon (1: as listed), the position is that
   of the centre of mass, and the angle (rad, anticlockwise) is measured from the listed orientation.
   Polygons of grains have 3 to 98 corners (dem_shape_polygon_add), those of walls 3 to 1000, chains
   2 to 1000. No outline may cross or touch itself. The corners of walls are on their surface (the
   thickness is that of straight walls only), and walls repel on both sides (dem_wall_profile_add). A
   chain is a sheet. A polygon can be caught on its sharp ends and gain energy there; where grains
   reach the ends, use a closed outline with a thickness instead.

   Our choices for values that the files do not contain: Poisson's ratio is 0.25, which sets the
   tangential stiffness to 0.857 of the normal one. Angles of spheres are read and written, but not
   used. The figures of the viewers in the appendix show a plane, although its text is about space.
   The files of both viewers have no outlines: a polygon is the disc of its area in .xb, and its
   position and rotation in .str.

   Errors. A function that can fail returns a dem_result and leaves a message in moldyn.error with
   the call, the file and line or the value, the limit, the likely cause and the remedy.
   DEM_ERROR_FORMAT: a file does not follow its format. DEM_ERROR_FILE: it cannot be opened, read,
   written or renamed. DEM_ERROR_ARGUMENT: a value is out of its range, or a pointer is null (without
   a message if it is that of the moldyn). DEM_ERROR_MEMORY: memory ran out. No function prints or
   exits. The numbers of rows in a file are compared with its size before memory is allocated.
   Tests: tests/examples/test_moldyn.c; `make fuzz` feeds moldyn_parse with any bytes. */
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
#include <time.h>

#if defined(__GNUC__) && !defined(__TINYC__)
#define MOLDYN_API static __attribute__((unused))
#define MOLDYN_FORMAT(f, a) __attribute__((format(printf, f, a)))
#else
#define MOLDYN_API static
#define MOLDYN_FORMAT(f, a)
#endif

/* Outlines, one after another: outline i has the corners from ends[i - 1] (the first: 0) to before
   ends[i]. */
typedef struct moldyn_outlines {
    int count;
    int *ends;                       /* count, ascending */
    dem_real *corners;               /* ends[count - 1] x 2, m */
} moldyn_outlines;
/* A scene. The default of every field is zero; comments name the required ones. Arrays come from
   malloc, and moldyn_free frees them. */
typedef struct moldyn {
    double start, end, dt;           /* s; times.t0, tend (required), dt (required, > 0) */
    double gravity;                  /* m/s2, upwards; control.grav */
    double density;                  /* kg/m3, required, > 0; control.rho */
    double friction_static, friction;/* >= 0; control.mue_s (0: the same as mue_d), mue_d */
    double stiffness;                /* N/m, required, > 0, of loading; sd.stiff_lo */
    double stiffness_unloading;      /* N/m, sd.stiff_k_un; up to `stiffness`: the linear law,
                                        which never attracts; above: the hysteretic law */
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
    moldyn_outlines polygons;        /* of grains; planar scenes only, as the next three are */
    int *kinds;                      /* grain_count: 0: a disc; k: the k-th polygon, from 1. For a
                                        polygon the radius in `grains` is the factor on its
                                        lengths. Null: all are discs */
    moldyn_outlines parts, chains;   /* walls: closed ones, open ones */

    double origin;                   /* s, time of the file when the clock of a world is at 0. The
                                        clock of a world cannot be set, so moldyn keeps the
                                        difference. Set by reading a .cin and by moldyn_add */
    dem_material grain_material, wall_material; /* added by moldyn_add */
    dem_wall *planes;                /* those of walls, parts and chains, in this order, added by
                                        moldyn_add; null before */
    int shape_count, body_count;
    dem_shape *shapes;               /* those of polygons, added by moldyn_add; null before */
    dem_body *bodies;                /* those of grains, added by moldyn_add or taken */
    char error[500];                 /* the message of the last call that failed */
} moldyn;
static const moldyn MOLDYN_ZERO = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                   {0, 0, 0}, 0, {0, 0, 0}, {0, 0, 0}, 0,
                                   {0}, {0}, 0, 0, 0, 0, 0, ""};
#define MOLDYN MOLDYN_ZERO
typedef enum moldyn_file {
    MOLDYN_CONTROL = 0,              /* .cin */
    MOLDYN_PARTICLES,                /* .pin */
    MOLDYN_WALLS                     /* .win */
} moldyn_file;
enum { MOLDYN_GRAIN = 14, MOLDYN_WALL = 6, MOLDYN_GRAIN_FLAT = 8, MOLDYN_WALL_FLAT = 4,
       MOLDYN_POLYGON_CORNERS = 98, MOLDYN_WALL_CORNERS = 1000 };

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
/* Tests the exponent bits, because -ffast-math would remove a comparison. */
static int moldyn_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return ((bits >> 52) & 0x7ff) != 0x7ff;
}
static int moldyn_within(double x, double lo, double hi) {
    return moldyn_finite(x) && x >= lo && x <= hi;
}
/* Returns rows of zeros; null if memory runs out or the product overflows. */
static dem_real *moldyn_rows_new(size_t count, size_t wide) {
    const size_t row = wide*sizeof(dem_real);
    return count > (size_t)-1/2/row ? 0 : (dem_real *)calloc(count, row);
}
static dem_vec3 moldyn_vec3(const dem_real *p) { return dem_vec3_make(p[0], p[1], p[2]); }
static void moldyn_vec3_put(dem_real *p, dem_vec3 v) { p[0] = v.x; p[1] = v.y; p[2] = v.z; }

static void moldyn_outlines_free(moldyn_outlines *o) {
    free(o->ends);
    free(o->corners);
    memset(o, 0, sizeof *o);
}
/* Frees the arrays and sets all fields except `error` to zero. */
MOLDYN_API void moldyn_free(moldyn *m) {
    if (!m) return;
    free(m->grains);
    free(m->walls);
    free(m->planes);
    free(m->kinds);
    free(m->shapes);
    free(m->bodies);
    moldyn_outlines_free(&m->polygons);
    moldyn_outlines_free(&m->parts);
    moldyn_outlines_free(&m->chains);
    memset(m, 0, offsetof(moldyn, error));
}

/* ---- reading text ---- */

/* A text that is read, without a zero at its end, and the data for error messages. */
typedef struct moldyn_text {
    moldyn *m;
    const char *call, *name;    /* the public function; the file or data it reads */
    const char *word;           /* the present word; null at the end of the text */
    size_t length;              /* of the word; 0 at the end of a line */
    const char *at, *line_end;  /* the rest of the line */
    const char *next, *end;     /* the rest of the text after it */
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
/* Moves to the next word of the line; returns 0 if there is none. */
static int moldyn_word(moldyn_text *t) {
    const char *p = t->at;
    while (p < t->line_end && moldyn_is_space(*p)) p++;
    t->word = p;
    while (p < t->line_end && !moldyn_is_space(*p)) p++;
    t->at = p;
    t->length = (size_t)(p - t->word);
    return t->length > 0;
}
/* Moves to the first word of the next line that has one; returns 0 at the end of the text. */
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
/* Returns 1 if the present word is this one (given in lower case), in capitals or not. */
static int moldyn_is(const moldyn_text *t, const char *word) {
    size_t i;
    if (t->length != strlen(word)) return 0;
    for (i = 0; i < t->length; i++) {
        const char c = t->word[i];
        if ((c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c) != word[i]) return 0;
    }
    return 1;
}
/* Reads the present word as a decimal number with a point; returns 0 if it is none, or nan, inf or
   hexadecimal. strtod rounds correctly, but needs a zero at the end and the locale's point: hence the
   copy. */
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
    *value = number < 0 || number > 0 ? number : 0;      /* -0 becomes 0 */
    return 1;
}
/* Reads the present word as a whole number from 0, of at most 9 digits; returns 0 if it is none. */
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

/* ---- outlines ---- */

/* The names of a kind of outline in files and messages, and its limits on corners. */
typedef struct moldyn_outline_kind {
    const char *key, *name;
    int least, most, closed;
} moldyn_outline_kind;
static const moldyn_outline_kind moldyn_polygon = {"polygons", "polygon", 3,
                                                   MOLDYN_POLYGON_CORNERS, 1};
static const moldyn_outline_kind moldyn_part = {"polygons", "polygon", 3, MOLDYN_WALL_CORNERS, 1};
static const moldyn_outline_kind moldyn_chain = {"chains", "chain", 2, MOLDYN_WALL_CORNERS, 0};

/* Returns the corners of outline i, and their number. */
static const dem_real *moldyn_corners(const moldyn_outlines *o, int i, int *count) {
    const int first = i ? o->ends[i - 1] : 0;
    *count = o->ends[i] - first;
    return o->corners + 2*(size_t)first;
}
/* Computes area (m2), centre (m), second moment about it (m4), and the distance of the farthest corner
   from it (m). Coordinates are relative to the first corner, so that a distant outline loses no digits. */
typedef struct moldyn_measure { double area, middle[2], second, radius; } moldyn_measure;
static moldyn_measure moldyn_measure_of(const dem_real *corners, int count) {
    const double x0 = (double)corners[0], y0 = (double)corners[1];
    moldyn_measure s = {0, {0, 0}, 0, 0};
    int i;
    for (i = 1; i + 1 < count; i++) {
        const double a = (double)corners[2*i] - x0, b = (double)corners[2*i + 1] - y0;
        const double c = (double)corners[2*i + 2] - x0, d = (double)corners[2*i + 3] - y0;
        const double area = (a*d - b*c)/2;
        s.area += area;
        s.middle[0] += area*(a + c)/3;
        s.middle[1] += area*(b + d)/3;
        s.second += area*(a*a + a*c + c*c + b*b + b*d + d*d)/6;
    }
    if (!(s.area < 0 || s.area > 0)) return s;
    s.middle[0] /= s.area;
    s.middle[1] /= s.area;
    s.second = fabs(s.second - s.area*(s.middle[0]*s.middle[0] + s.middle[1]*s.middle[1]));
    s.area = fabs(s.area);
    s.middle[0] += x0;
    s.middle[1] += y0;
    for (i = 0; i < count; i++)
        s.radius = fmax(s.radius, hypot((double)corners[2*i] - s.middle[0],
                                        (double)corners[2*i + 1] - s.middle[1]));
    return s;
}
/* Returns twice the area of a triangle of corners, > 0 if they are anticlockwise. */
static double moldyn_turn(const dem_real *x, int a, int b, int c) {
    const double ax = (double)x[2*a], ay = (double)x[2*a + 1];
    return ((double)x[2*b] - ax)*((double)x[2*c + 1] - ay) -
           ((double)x[2*b + 1] - ay)*((double)x[2*c] - ax);
}
/* Returns 1 if the sides from a to b and from c to d, which have no corner in common, cross or touch. */
static int moldyn_sides_meet(const dem_real *x, int a, int b, int c, int d) {
    const double abc = moldyn_turn(x, a, b, c), abd = moldyn_turn(x, a, b, d);
    const double cda = moldyn_turn(x, c, d, a), cdb = moldyn_turn(x, c, d, b);
    int k;
    for (k = 0; k < 2; k++)                     /* one wholly before the other */
        if (fmax((double)x[2*a + k], (double)x[2*b + k]) <
            fmin((double)x[2*c + k], (double)x[2*d + k]) ||
            fmax((double)x[2*c + k], (double)x[2*d + k]) <
            fmin((double)x[2*a + k], (double)x[2*b + k])) return 0;
    return !((abc > 0 && abd > 0) || (abc < 0 && abd < 0) || (cda > 0 && cdb > 0) ||
             (cda < 0 && cdb < 0));
}
/* Checks an outline, the index-th of its kind from 0. Returns 0 if it is right; otherwise `fault` gets
   the reason. */
static int moldyn_outline_fault(const moldyn_outline_kind *kind, int index, const dem_real *x,
                                int count, char *fault, size_t room) {
    const int sides = kind->closed ? count : count - 1;
    int i, k;
    for (i = 0; i < 2*count; i++)
        if (!moldyn_within((double)x[i], -1e15, 1e15))
            return snprintf(fault, room, "corner %d of %s %d is (%g, %g) m, must be finite and "
                            "within +-1e15; correct it", i/2 + 1, kind->name, index + 1,
                            (double)x[i/2*2], (double)x[i/2*2 + 1]);
    for (i = 0; i < sides; i++) {
        const int b = (i + 1)%count;
        if (!(x[2*i] < x[2*b] || x[2*i] > x[2*b] || x[2*i + 1] < x[2*b + 1] ||
              x[2*i + 1] > x[2*b + 1]))
            return snprintf(fault, room, "corners %d and %d of %s %d are both (%g, %g) m, must be "
                            "apart; give each corner once%s", i + 1, b + 1, kind->name, index + 1,
                            (double)x[2*i], (double)x[2*i + 1],
                            b ? "" : ", the first not again at the end");
    }
    for (i = 0; i < sides; i++) {
        const int b = (i + 1)%count;
        for (k = i + 2; k < sides; k++)
            if ((k + 1)%count != i && moldyn_sides_meet(x, i, b, k, (k + 1)%count))
                return snprintf(fault, room, "%s %d crosses or touches itself: its sides from "
                                "corner %d, (%g, %g) m, and from corner %d, (%g, %g) m, must be "
                                "apart; give the corners in turn, each once%s", kind->name,
                                index + 1, i + 1, (double)x[2*i], (double)x[2*i + 1], k + 1,
                                (double)x[2*k], (double)x[2*k + 1], kind->closed ? ""
                                : ", or list it under polygons if it is closed");
    }
    if (kind->closed && !(moldyn_measure_of(x, count).area > 0))
        return snprintf(fault, room, "the area of %s %d is 0 m2, must be > 0; give corners that "
                        "are not on one line", kind->name, index + 1);
    return 0;
}

/* Reads the rows of an outline's corners and checks the outline. */
static dem_result moldyn_outline_rows(moldyn_text *t, const moldyn_outline_kind *kind, int index,
                                      dem_real *corners, int count) {
    const long line = t->line;
    char text[300];
    int i;
    for (i = 0; i < 2*count; i++) {
        double value;
        if (!(i & 1 ? moldyn_word(t) : moldyn_line(t)) || !moldyn_real(t, &value)) {
            snprintf(text, sizeof text, "corner %d of the %d of %s %d is expected, two decimal "
                     "numbers within +-1e15 (m)", i/2 + 1, count, kind->name, index + 1);
            return moldyn_refuse(t, text);
        }
        corners[i] = (dem_real)value;
        if ((i & 1) && moldyn_word(t)) return moldyn_refuse(t, "the end of the line is expected: "
                                                            "a corner has two numbers");
    }
    if (moldyn_outline_fault(kind, index, corners, count, text, sizeof text))
        return moldyn_fail(t->m, DEM_ERROR_FORMAT, "%s: %s line %ld: %s", t->call, t->name, line,
                           text);
    return DEM_OK;
}
static dem_result moldyn_too_short(const moldyn_text *t, int found, const char *what, double most) {
    return moldyn_fail(t->m, DEM_ERROR_FORMAT, "%s: %s line %ld: found %d %s announced where the "
                       "file has bytes for at most %.0f; was it cut short?", t->call, t->name,
                       t->line, found, what, most);
}
/* Reads one outline and adds it to o; room: corners for which there is memory. */
static dem_result moldyn_outline_read(moldyn_text *t, const moldyn_outline_kind *kind,
                                      moldyn_outlines *o, int *room) {
    const int had = o->count ? o->ends[o->count - 1] : 0;
    char expected[160];
    double bytes;
    int count = 0;
    dem_result result;
    if (!moldyn_line(t) || !moldyn_count(t, &count) || count < kind->least || count > kind->most) {
        snprintf(expected, sizeof expected, "the number of corners of %s %d is expected, %d to %d",
                 kind->name, o->count + 1, kind->least, kind->most);
        return moldyn_refuse(t, expected);
    }
    if (moldyn_word(t)) return moldyn_refuse(t, "the end of the line is expected");
    bytes = (double)(t->end - t->next) + 1;     /* "0 0" and the line's end, but for the last */
    if (bytes < 4.0*count) return moldyn_too_short(t, count, "corners", floor(bytes/4));
    if (count > *room - had) {
        const double more = 2.0*had + count;
        dem_real *grown = more > 1e9 ? 0 : (dem_real *)realloc(o->corners, (size_t)more*2*
                                                               sizeof *o->corners);
        if (!grown) return moldyn_no_memory(t->m, t->call, more, "corners");
        o->corners = grown;
        *room = (int)more;
    }
    result = moldyn_outline_rows(t, kind, o->count, o->corners + 2*(size_t)had, count);
    if (result == DEM_OK) o->ends[o->count++] = had + count;
    return result;
}
/* Reads all outlines of a kind; the present word is its key. o is empty; the caller frees it. */
static dem_result moldyn_outlines_read(moldyn_text *t, const moldyn_outline_kind *kind,
                                       moldyn_outlines *o) {
    const double least = 2 + 4.0*kind->least;
    double bytes;
    dem_result result = DEM_OK;
    int count = 0, room = 0, i;
    if (!moldyn_word(t) || !moldyn_count(t, &count))
        return moldyn_refuse(t, kind->closed ? "the number of polygons is expected"
                             : "the number of chains is expected");
    if (moldyn_word(t)) return moldyn_refuse(t, "the end of the line is expected");
    bytes = (double)(t->end - t->next) + 1;
    if (bytes < least*count) return moldyn_too_short(t, count, kind->key, floor(bytes/least));
    if (!count) return DEM_OK;
    o->ends = (int *)calloc((size_t)count, sizeof *o->ends);
    if (!o->ends) return moldyn_no_memory(t->m, t->call, count, kind->key);
    for (i = 0; i < count && result == DEM_OK; i++) result = moldyn_outline_read(t, kind, o, &room);
    return result;
}

/* ---- reading scenes ---- */

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
/* Returns a value as in the file, where adhesion is a slope, which is negative. */
static double moldyn_value(const moldyn *m, const moldyn_key *key) {
    double value;
    memcpy(&value, (const char *)m + key->at, sizeof value);
    return key->hi > 0 || !(value > 0 || value < 0) ? value : -value;
}

/* Reads one line: a key and its value. */
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

/* A table of rows. A row has `wide` numbers in space and `flat` in a plane; rows of grains have one
   more if there may be polygons. The first row decides. Outlines may precede the rows. */
typedef struct moldyn_table {
    int of_walls, wide, flat, count;
    int known, planar;          /* 1: the other file has shown whether the scene is in a plane; 1: it is */
    int columns;                /* of the rows read so far; 0: none yet */
    double thickness;           /* of walls */
    dem_real *rows;             /* count x wide */
    int *kinds;                 /* count, of grains: null if all are discs */
    moldyn_outlines closed, open;
} moldyn_table;

/* Reads the outlines before the first line of the table, which then is the present line. */
static dem_result moldyn_table_outlines(moldyn_text *t, moldyn_table *table) {
    dem_result result = DEM_OK;
    int seen[2] = {0, 0}, k;
    while (result == DEM_OK && moldyn_line(t)) {
        const moldyn_outline_kind *kind = table->of_walls ? &moldyn_part : &moldyn_polygon;
        for (k = 0; k < 1 + table->of_walls && !moldyn_is(t, kind->key); k++) kind = &moldyn_chain;
        if (k > table->of_walls || seen[k]++) break;
        if (table->known && !table->planar)
            return moldyn_refuse(t, "rows are expected: the scene is in space, as the other file "
                                 "says, and polygons and chains are for scenes in a plane");
        result = moldyn_outlines_read(t, kind, k ? &table->open : &table->closed);
    }
    if (table->closed.count || table->open.count) table->known = table->planar = 1;
    return result;
}
/* Reads the first line, and checks that the file is long enough for that number of rows. */
static dem_result moldyn_table_head(moldyn_text *t, moldyn_table *table) {
    double bytes;
    if (!moldyn_count(t, &table->count))
        return moldyn_refuse(t, table->of_walls ? "the number of walls is expected"
                             : "the number of grains is expected");
    if (table->of_walls && (!moldyn_word(t) || !moldyn_real(t, &table->thickness) ||
                            table->thickness < 0))
        return moldyn_refuse(t, "the thickness of the walls is expected, a number >= 0 (m)");
    if (moldyn_word(t)) return moldyn_refuse(t, "the end of the line is expected");
    bytes = (double)(t->end - t->next);
    if (bytes < (double)table->count*(2*table->flat - 1))
        return moldyn_too_short(t, table->count, "rows", bytes/(2*table->flat - 1));
    return DEM_OK;
}
/* Reads the numbers of row i; checks their number, not their values. */
static dem_result moldyn_row_numbers(moldyn_text *t, moldyn_table *table, int i, double *value) {
    const int outlined = table->closed.count > 0, flat = table->flat + (outlined &&
                                                                        !table->of_walls);
    const int columns = table->columns ? table->columns
        : table->known && table->planar ? flat : table->wide;
    int n = 0, more = moldyn_line(t), is_flat;
    char expected[200];
    for (; more && n < table->wide; n++, more = moldyn_word(t))
        if (!moldyn_real(t, &value[n]))
            return moldyn_refuse(t, "a decimal number within +-1e15 is expected");
    is_flat = n == table->flat || (n == table->flat + 1 && !table->of_walls);
    if (more || (n != table->wide && !is_flat) || (table->columns && n != table->columns) ||
        (table->known && table->planar != is_flat)) {
        snprintf(expected, sizeof expected, "row %d of %d is expected with %d numbers, %s", i + 1,
                 table->count, columns, table->columns ? "as the first"
                 : outlined || table->open.count ? "in a plane, as polygons and chains are"
                 : table->known ? "as the other file" : "or fewer in a plane");
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
        ? "1 (moves) or 0 (fixed) in the last column is expected" : 0;
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
/* Row i of nine numbers; the last one is the polygon of the grain. */
static dem_result moldyn_kind_set(moldyn_text *t, moldyn_table *table, int i, const double *row) {
    const int most = table->closed.count;
    const double value = row[MOLDYN_GRAIN_FLAT];
    int kind = 0;
    if (moldyn_grain_set(table->rows + (size_t)i*MOLDYN_GRAIN, row, 1))
        return moldyn_fail(t->m, DEM_ERROR_FORMAT, "%s: %s line %ld: found radius (or factor of a "
                           "polygon) %g and flag %g in columns 7 and 8, must be > 0, and 1 (moves) "
                           "or 0 (fixed); correct the row", t->call, t->name, t->line, row[6],
                           row[7]);
    if (value >= 0 && value <= most) kind = (int)value;
    if (value < kind || value > kind)
        return moldyn_fail(t->m, DEM_ERROR_FORMAT, "%s: %s line %ld: found polygon %g in the last "
                           "column, must be 0 (a disc) to %d, as many as the file lists before its "
                           "grains; list it, or correct the row", t->call, t->name, t->line, value,
                           most);
    if (kind) table->kinds[i] = kind;
    return DEM_OK;
}
static dem_result moldyn_table_rows(moldyn_text *t, moldyn_table *table) {
    int i;
    for (i = 0; i < table->count; i++) {
        dem_real *row = table->rows + (size_t)i*(size_t)table->wide;
        double value[MOLDYN_GRAIN];
        const char *expected;
        dem_result result = moldyn_row_numbers(t, table, i, value);
        if (result != DEM_OK) return result;
        if (!table->of_walls && table->columns == MOLDYN_GRAIN_FLAT + 1) {
            if ((result = moldyn_kind_set(t, table, i, value)) != DEM_OK) return result;
            continue;
        }
        expected = (table->of_walls ? moldyn_wall_set : moldyn_grain_set)
            (row, value, table->columns == table->flat);
        if (expected) return moldyn_refuse(t, expected);
    }
    if (moldyn_line(t))
        return moldyn_refuse(t, "the end of the file is expected: there are more rows than its "
                             "first line says");
    return DEM_OK;
}
/* Reads the file of a table into `table`, which the caller frees, also after a failure. */
static dem_result moldyn_table_all(moldyn_text *t, moldyn_table *table) {
    dem_result result = moldyn_table_outlines(t, table);
    if (result == DEM_OK) result = moldyn_table_head(t, table);
    if (result != DEM_OK || !table->count) return result != DEM_OK ? result
        : moldyn_table_rows(t, table);
    table->rows = moldyn_rows_new((size_t)table->count, (size_t)table->wide);
    if (!table->of_walls && table->closed.count)
        table->kinds = (int *)calloc((size_t)table->count, sizeof *table->kinds);
    if (!table->rows || (!table->of_walls && table->closed.count && !table->kinds))
        return moldyn_no_memory(t->m, t->call, table->count, table->of_walls ? "walls" : "grains");
    return moldyn_table_rows(t, table);
}
static void moldyn_table_free(moldyn_table *table) {
    free(table->rows);
    free(table->kinds);
    moldyn_outlines_free(&table->closed);
    moldyn_outlines_free(&table->open);
}
static dem_result moldyn_table_read(moldyn_text *t, int of_walls) {
    moldyn *m = t->m;
    moldyn_table table;
    dem_result result;
    memset(&table, 0, sizeof table);
    table.of_walls = of_walls;
    table.wide = of_walls ? MOLDYN_WALL : MOLDYN_GRAIN;
    table.flat = of_walls ? MOLDYN_WALL_FLAT : MOLDYN_GRAIN_FLAT;
    table.known = of_walls ? m->grain_count > 0 || m->polygons.count > 0
                           : m->wall_count > 0 || m->parts.count > 0 || m->chains.count > 0;
    table.planar = m->planar;
    if ((result = moldyn_table_all(t, &table)) != DEM_OK) {
        moldyn_table_free(&table);
        return result;
    }
    if (table.count) m->planar = table.columns != table.wide;
    else if (table.closed.count || table.open.count) m->planar = 1;
    if (of_walls) {
        free(m->planes);                        /* they belong to the old rows */
        free(m->walls);
        moldyn_outlines_free(&m->parts);
        moldyn_outlines_free(&m->chains);
        m->planes = 0;
        m->walls = table.rows;
        m->wall_count = table.count;
        m->wall_thickness = table.thickness;
        m->parts = table.closed;
        m->chains = table.open;
    } else {
        free(m->grains);
        free(m->kinds);
        free(m->shapes);
        free(m->bodies);
        moldyn_outlines_free(&m->polygons);
        m->shapes = 0;
        m->bodies = 0;
        m->shape_count = m->body_count = 0;
        m->grains = table.rows;
        m->kinds = table.kinds;
        m->grain_count = table.count;
        m->polygons = table.closed;
    }
    return DEM_OK;
}
static dem_result moldyn_parse_as(moldyn *m, const char *call, const char *name, moldyn_file file,
                                  const char *data, size_t size) {
    moldyn_text t = moldyn_text_make(m, call, name, data, size);
    return file == MOLDYN_CONTROL ? moldyn_control(&t) : moldyn_table_read(&t,
                                                                           file == MOLDYN_WALLS);
}
/* Reads one of the three files from memory into m, which may hold the others already (begin with
   MOLDYN). name is for error messages; null: "data". If it fails, m stays as it was. */
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
/* Reads the three files. pin and win may be null: no grains, no walls. The old contents of m are freed
   first, so m must be MOLDYN or a valid scene. If reading fails, m is MOLDYN except for the message. */
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
/* Returns the desc of a world for this scene: law, gravity, time step, plane or space. You may set all
   other fields. For a null moldyn it is DEM_WORLD_DESC. */
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

/* Computes a point of the surface of wall i, and its unit normal. */
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
/* Returns the polygon of grain i, from 1; 0: a disc or a sphere. */
static int moldyn_kind(const moldyn *m, int i) { return m->kinds ? m->kinds[i] : 0; }
/* Returns 1 if dem_real can hold the mass of grain i (in a plane 1 m thick), its moment of inertia and
   the inverses of both. */
static int moldyn_weighs(const moldyn *m, int i) {
    const double least = sizeof(dem_real) == sizeof(float) ? 1e-37 : 1e-300;
    const double r = (double)m->grains[(size_t)i*MOLDYN_GRAIN + 12];
    double mass = m->density*3.14159265358979323846*r*r*(m->planar ? 1 : 4*r/3);
    double inertia = mass*r*r*(m->planar ? 0.5 : 0.4);
    if (moldyn_kind(m, i)) {
        int count;
        const dem_real *corners = moldyn_corners(&m->polygons, moldyn_kind(m, i) - 1, &count);
        const moldyn_measure s = moldyn_measure_of(corners, count);
        mass = m->density*s.area*r*r;
        inertia = m->density*s.second*r*r*r*r;
    }
    return moldyn_within(mass, least, 1/least) && moldyn_within(inertia, least, 1/least);
}
static dem_result moldyn_grain_check(moldyn *m, const char *call, int i) {
    const dem_real *row = m->grains + (size_t)i*MOLDYN_GRAIN;
    const double radius = (double)row[12], flag = (double)row[13];
    const int kind = moldyn_kind(m, i);
    int k, ok = radius > 0 && (flag < 1 ? !(flag < 0 || flag > 0) : !(flag > 1));
    for (k = 0; k < MOLDYN_GRAIN; k++) ok = ok && moldyn_within((double)row[k], -1e15, 1e15);
    if (!ok)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: grain %d has radius %g m and flag %g or a "
                           "number beyond 1e15; must be > 0, and 0 or 1; mend its row in moldyn",
                           call, i, radius, flag);
    if (kind < 0 || kind > m->polygons.count)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: grain %d is of kind %d, must be 0 (a disc) "
                           "to %d, as many as there are polygons; mend kinds in moldyn", call, i,
                           kind, m->polygons.count);
    if (!moldyn_weighs(m, i))
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: grain %d has %s %g, which at %g kg/m3 "
                           "gives it a mass too small or too large to calculate with; lengths are "
                           "in metres: check the unit", call, i,
                           kind ? "a polygon's factor of" : "a radius in m of", radius, m->density);
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
static dem_result moldyn_outlines_check(moldyn *m, const char *call, const moldyn_outlines *o,
                                        const moldyn_outline_kind *kind) {
    char fault[300];
    int i, count, ok = o->count >= 0 && (!o->count || (o->ends && o->corners));
    for (i = 0; i < o->count && ok; i++) {
        count = o->ends[i] - (i ? o->ends[i - 1] : 0);
        ok = count >= kind->least && count <= kind->most;
    }
    if (!ok)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: of %d %s number %d has not %d to %d "
                           "corners, or their arrays are null; mend them in moldyn", call, o->count,
                           kind->key, i, kind->least, kind->most);
    if (o->count && !m->planar)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: there are %d %s and planar is 0, must be 1: "
                           "they are for scenes in a plane; in space use "
                           "dem_shape_polyhedron_add and dem_wall_mesh_add", call, o->count, kind->key);
    for (i = 0; i < o->count; i++) {
        const dem_real *corners = moldyn_corners(o, i, &count);
        if (moldyn_outline_fault(kind, i, corners, count, fault, sizeof fault))
            return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: %s", call, fault);
    }
    return DEM_OK;
}
/* Checks for values that files cannot contain, but that a program can write into a moldyn. */
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
    result = moldyn_outlines_check(m, call, &m->polygons, &moldyn_polygon);
    if (result == DEM_OK) result = moldyn_outlines_check(m, call, &m->parts, &moldyn_part);
    if (result == DEM_OK) result = moldyn_outlines_check(m, call, &m->chains, &moldyn_chain);
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
    if (bodies || dem_world_steps_get(world) || !have.planar != !need.planar ||
        have.normal_law != need.normal_law)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: the world has %d bodies, has made %.0f "
                           "steps, or has another law or dimension; make an empty one with "
                           "moldyn_desc", call, bodies, (double)dem_world_steps_get(world));
    return DEM_OK;
}
/* The user should read the world's error message. Until then the world refuses to run without the part
   that it refused. */
static dem_result moldyn_refused(moldyn *m, const char *call, dem_result result, const char *what,
                                 int i) {
    return moldyn_fail(m, result, "%s: the world refused %s %d and holds a part of the scene only; "
                       "dem_world_error_get tells why; destroy the world", call, what, i);
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
        m->planes[i] = dem_wall_plane_add(world, m->wall_material, dem_vec3_make((dem_real)p[0],
                                     (dem_real)p[1], (dem_real)p[2]), dem_vec3_make((dem_real)n[0],
                                     (dem_real)n[1], (dem_real)n[2]));
        if (!m->planes[i].id) return moldyn_refused(m, call, DEM_ERROR_MEMORY, "wall", i);
    }
    return DEM_OK;
}
/* Adds walls of outlines, with segments from corner to corner. planes receives their ids. */
static dem_result moldyn_outlines_add(moldyn *m, const char *call, dem_world *world,
                                      const moldyn_outlines *o, const moldyn_outline_kind *kind,
                                      dem_wall *planes) {
    dem_real corners[2*MOLDYN_WALL_CORNERS];
    int32_t ends[2*MOLDYN_WALL_CORNERS];
    int i, k;
    for (i = 0; i < o->count; i++) {
        const dem_real *from = moldyn_corners(o, i, &k);
        dem_profile profile;
        profile.vertex_count = k;
        profile.segment_count = kind->closed ? k : k - 1;
        profile.vertices = corners;
        profile.segments = ends;
        memcpy(corners, from, (size_t)k*2*sizeof *corners);
        for (k = 0; k < profile.segment_count; k++) {
            ends[2*k] = k;
            ends[2*k + 1] = (k + 1)%profile.vertex_count;
        }
        planes[i] = dem_wall_profile_add(world, m->wall_material, &profile, DEM_EDGE_RESOLVED);
        if (!planes[i].id) return moldyn_refused(m, call, DEM_ERROR_ARGUMENT, kind->name, i + 1);
    }
    return DEM_OK;
}
static dem_result moldyn_shapes_add(moldyn *m, const char *call, dem_world *world) {
    int i, count;
    for (i = 0; i < m->polygons.count; i++) {
        const dem_real *corners = moldyn_corners(&m->polygons, i, &count);
        m->shapes[i] = dem_shape_polygon_add(world, count, corners);
        if (!m->shapes[i].id) return moldyn_refused(m, call, DEM_ERROR_ARGUMENT, "polygon", i + 1);
    }
    return DEM_OK;
}
/* Adds the polygon of a row; slot 0: the world refused it. */
static dem_body moldyn_polygon_add(const moldyn *m, dem_world *world, int i) {
    const dem_real *row = m->grains + (size_t)i*MOLDYN_GRAIN;
    const dem_quat q = dem_quat_about(dem_vec3_make(0, 0, 1), row[8]);
    dem_real turn[4];
    dem_body none;
    none.slot = none.generation = 0;
    turn[0] = q.w; turn[1] = q.x; turn[2] = q.y; turn[3] = q.z;
    if (dem_bodies_add(world, m->grain_material, m->shapes[m->kinds[i] - 1], 1, row, turn, row + 3,
                       row + 9, row + 12) != DEM_OK) return none;
    return dem_body_id_get(world, dem_bodies_get(world).count - 1);
}
static dem_result moldyn_grains_add(moldyn *m, const char *call, dem_world *world) {
    int i;
    for (i = 0; i < m->grain_count; i++) {
        const dem_real *row = m->grains + (size_t)i*MOLDYN_GRAIN;
        const int polygon = moldyn_kind(m, i) > 0;
        const dem_body body = polygon ? moldyn_polygon_add(m, world, i)
            : dem_sphere_add(world, m->grain_material, row[12], moldyn_vec3(row));
        dem_body_state s;
        m->bodies[i] = body;
        if (!body.slot || dem_body_get(world, body, &s) != DEM_OK)
            return moldyn_refused(m, call, DEM_ERROR_MEMORY, "grain", i);
        s.velocity = moldyn_vec3(row + 3);
        s.spin = moldyn_vec3(row + 9);
        s.fixed = row[13] < DEM_R(0.5);
        if ((!polygon || s.fixed) && dem_body_set(world, body, &s) != DEM_OK)
            return moldyn_refused(m, call, DEM_ERROR_MEMORY, "the velocity of grain", i);
    }
    return DEM_OK;
}
/* Allocates the ids of walls, shapes and bodies again. */
static dem_result moldyn_ids_new(moldyn *m, const char *call) {
    const size_t walls = (size_t)m->wall_count + (size_t)m->parts.count + (size_t)m->chains.count;
    dem_wall *planes = (dem_wall *)calloc(walls + 1, sizeof *planes);
    dem_shape *shapes = (dem_shape *)calloc((size_t)m->polygons.count + 1, sizeof *shapes);
    dem_body *bodies = (dem_body *)calloc((size_t)m->grain_count + 1, sizeof *bodies);
    if (!planes || !shapes || !bodies) {
        free(planes);
        free(shapes);
        free(bodies);
        return moldyn_no_memory(m, call, (double)walls + m->grain_count, "walls and grains");
    }
    free(m->planes);
    free(m->shapes);
    free(m->bodies);
    m->planes = planes;
    m->shapes = shapes;
    m->bodies = bodies;
    m->shape_count = m->polygons.count;
    m->body_count = m->grain_count;
    return DEM_OK;
}
/* Adds materials, walls and grains, in the order of their rows, to a world made with moldyn_desc
   that has no bodies yet and has not run. It checks everything before it adds anything. After that
   only memory can run out, or a polygon be too thin for dem_shape_polygon_add; then destroy the world.
   The world's clock begins at 0, not at start. */
MOLDYN_API dem_result moldyn_add(moldyn *m, dem_world *world) {
    static const char call[] = "moldyn_add";
    dem_result result;
    if (!m) return DEM_ERROR_ARGUMENT;
    if ((result = moldyn_suits(m, call, world)) != DEM_OK) return result;
    if ((result = moldyn_check(m, call)) != DEM_OK) return result;
    if ((result = moldyn_ids_new(m, call)) != DEM_OK) return result;
    m->origin = m->start - dem_world_time_get(world);
    result = moldyn_materials_add(m, call, world);
    if (result == DEM_OK) result = moldyn_planes_add(m, call, world);
    if (result == DEM_OK)
        result = moldyn_outlines_add(m, call, world, &m->parts, &moldyn_part,
                                     m->planes + m->wall_count);
    if (result == DEM_OK)
        result = moldyn_outlines_add(m, call, world, &m->chains, &moldyn_chain,
                                     m->planes + m->wall_count + m->parts.count);
    if (result == DEM_OK) result = moldyn_shapes_add(m, call, world);
    return result == DEM_OK ? moldyn_grains_add(m, call, world) : result;
}

/* The present bodies of a world, in the order in which they were added. */
typedef struct moldyn_bodies {
    int count, *index;
    int *row;                   /* by slot of dem_body less 1: which row of m it may be, or -1; part
                                   of index */
} moldyn_bodies;
static dem_result moldyn_bodies_get(moldyn *m, const char *call, const dem_world *world,
                                    moldyn_bodies *all) {
    const dem_bodies b = dem_bodies_get(world);
    uint32_t top = 0, slot;
    int i, n = 0;
    all->count = b.count;
    all->index = 0;
    if (!world) return moldyn_null(m, call, "world");
    for (i = 0; i < b.count; i++) top = b.slots[i] > top ? b.slots[i] : top;
    all->index = (int *)malloc(2*((size_t)top + 1)*sizeof *all->index);
    if (!all->index) return moldyn_no_memory(m, call, b.count, "numbers of bodies");
    all->row = all->index + top + 1;
    for (slot = 0; slot <= top; slot++) all->index[slot] = all->row[slot] = -1;
    for (i = 0; i < m->body_count && i < m->grain_count; i++)
        if (m->bodies[i].slot && m->bodies[i].slot - 1 <= top)
            all->row[m->bodies[i].slot - 1] = i;
    for (i = 0; i < b.count; i++) all->index[b.slots[i]] = i;
    for (slot = 0; slot <= top; slot++)         /* closes the gaps of bodies that have left */
        if (all->index[slot] >= 0) all->index[n++] = all->index[slot];
    return DEM_OK;
}
static dem_body_state moldyn_body(const dem_world *world, const moldyn_bodies *all, int i) {
    dem_body_state s;
    memset(&s, 0, sizeof s);
    dem_body_get(world, dem_body_id_get(world, all->index[i]), &s);
    return s;
}
/* Returns the polygon of m that a shape of the world is, from 1; 0: none. The polygons may have been
   added to another world, so it compares area and size (of a prism, see dem_shape_polygon_add). */
static int moldyn_kind_of(const moldyn *m, const dem_world *world, dem_shape shape,
                          dem_shape_info *info) {
    const double thickness = (double)dem_world_desc_get(world).thickness;
    int i, count;
    for (i = 0; i < m->shape_count && i < m->polygons.count; i++) {
        const dem_real *corners = moldyn_corners(&m->polygons, i, &count);
        moldyn_measure s;
        if (m->shapes[i].id != shape.id || dem_shape_get(world, shape, info) != DEM_OK) continue;
        s = moldyn_measure_of(corners, count);
        s.radius = hypot(s.radius, 2*sqrt(s.area/3.14159265358979323846)/3);
        if (fabs((double)info->volume/(s.area*thickness) - 1) < 1e-3 &&
            fabs((double)info->radius/s.radius - 1) < 1e-3) return i + 1;
    }
    return 0;
}
/* Computes the angle about z and the factor of a polygon's body for its row. row: the row from which
   this body was added, or null. Its factor is kept to the last bit, and its angle if the body has not
   rotated. */
static void moldyn_polygon_put(dem_real *to, const dem_body_state *s, const dem_shape_info *info,
                               const dem_real *row) {
    const double least = sizeof(dem_real) == sizeof(float) ? 1e-6 : 2e-15;
    const double w = (double)s->orientation.w, z = (double)s->orientation.z;
    const double angle = 2*(w < 0 ? atan2(-z, -w) : atan2(z, w));
    to[8] = (dem_real)angle;
    to[12] = s->radius/info->radius;
    if (!row) return;
    if (fabs(remainder(angle - (double)row[8], 6.283185307179586477)) <
        least*(1 + fabs((double)row[8]))) to[8] = row[8];
    if (fabs((double)to[12] - (double)row[12]) < least*(double)row[12]) to[12] = row[12];
}
/* The arrays that moldyn_take fills in. */
typedef struct moldyn_taken { dem_real *rows; int *kinds; dem_body *bodies; } moldyn_taken;
static void moldyn_taken_free(moldyn_taken *to) {
    free(to->rows);
    free(to->kinds);
    free(to->bodies);
}
/* Takes all bodies; was: the rows of m by the slot of the body added from them. Returns the number of
   bodies that are neither spheres (discs) nor polygons of m. */
static int moldyn_taken_fill(const moldyn *m, const dem_world *world, const moldyn_bodies *all,
                             moldyn_taken *to) {
    int i, strange = 0;
    for (i = 0; i < all->count; i++) {
        const dem_body_state s = moldyn_body(world, all, i);
        dem_real *row = to->rows + (size_t)i*MOLDYN_GRAIN;
        to->bodies[i] = dem_body_id_get(world, all->index[i]);
        moldyn_vec3_put(row, s.position);
        moldyn_vec3_put(row + 3, s.velocity);
        moldyn_vec3_put(row + 9, s.spin);
        row[12] = s.radius;
        row[13] = s.fixed ? DEM_R(0) : DEM_R(1);
        if (s.shape.id) {
            const dem_body body = to->bodies[i];
            const int k = all->row[body.slot - 1];
            dem_shape_info info;
            to->kinds[i] = moldyn_kind_of(m, world, s.shape, &info);
            if (!to->kinds[i]) strange++;
            else moldyn_polygon_put(row, &s, &info, k >= 0 && moldyn_kind(m, k) == to->kinds[i]
                                    && m->bodies[k].generation == body.generation
                                    ? m->grains + (size_t)k*MOLDYN_GRAIN : 0);
        }
    }
    return strange;
}
/* Replaces the grains of m by the present grains of a world, in the order in which they were added.
   Angles of polygons are within -pi and pi, or the old ones if they have not rotated; other angles are
   0. start becomes the start at which the grains were added plus dem_world_time_get(world), and end is
   at least that. The bodies must be spheres, or discs and polygons of m that moldyn_add has added.
   If it fails, m stays as it was. */
MOLDYN_API dem_result moldyn_take(moldyn *m, const dem_world *world) {
    static const char call[] = "moldyn_take";
    moldyn_taken to = {0, 0, 0};
    moldyn_bodies all;
    dem_result result;
    int strange = 0;
    if (!m) return DEM_ERROR_ARGUMENT;
    if (world && !dem_world_desc_get(world).planar != !m->planar)
        return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: the world is %s and moldyn is not; take "
                           "from a world made with moldyn_desc", call,
                           m->planar ? "in space" : "planar");
    if ((result = moldyn_bodies_get(m, call, world, &all)) != DEM_OK) return result;
    if (all.count) {
        to.rows = moldyn_rows_new((size_t)all.count, MOLDYN_GRAIN);
        to.kinds = (int *)calloc((size_t)all.count, sizeof *to.kinds);
        to.bodies = (dem_body *)calloc((size_t)all.count, sizeof *to.bodies);
        if (!to.rows || !to.kinds || !to.bodies)
            result = moldyn_no_memory(m, call, all.count, "grains");
    }
    if (result == DEM_OK) strange = moldyn_taken_fill(m, world, &all, &to);
    free(all.index);
    if (strange)
        result = moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: %d bodies are not spheres, nor polygons "
                             "that moldyn_add has added, which MOLDYN files cannot hold; use "
                             "dem_vtp_write or a checkpoint", call, strange);
    if (result != DEM_OK) {
        moldyn_taken_free(&to);
        return result;
    }
    free(m->grains);
    free(m->kinds);
    free(m->bodies);
    m->grains = to.rows;
    m->kinds = to.kinds;
    m->bodies = to.bodies;
    m->grain_count = m->body_count = all.count;
    m->start = m->origin + dem_world_time_get(world);
    if (m->end < m->start) m->end = m->start;
    return DEM_OK;
}

/* ---- writing files ---- */

/* Writes a number with a decimal point in every locale, and the character `after` it: with `digits`
   significant digits, or with six decimals if digits is 0. */
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

/* A file under a temporary name. An empty file or a device such as /dev/null is written to directly,
   because nothing can be lost there. A symbolic link is replaced by a file. */
typedef struct moldyn_out {
    moldyn *m;
    const char *call, *path;
    char *temporary;            /* path.XXXXXXXX.tmp; null: path itself is written to */
    FILE *file;
} moldyn_out;

/* Ends a file: renames it if all was written, otherwise removes it. Where rename refuses to replace a
   file (Windows), the old file is removed first, but never a folder of that name. */
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
    if (!whole && o->file && !o->temporary) {   /* empties it again */
        FILE *empty = fopen(o->path, "wb");
        if (empty) fclose(empty);
    }
    free(o->temporary);
    if (whole) return DEM_OK;
    return moldyn_fail(o->m, DEM_ERROR_FILE, "%s: cannot write %.160s: %s; check that its folder "
                       "exists, may be written to and has room", o->call, o->path,
                       cause ? strerror(cause) : "unknown cause");
}
/* Begins a file. If it fails, there is nothing to close. */
static dem_result moldyn_out_open(moldyn_out *o, moldyn *m, const char *call, const char *path) {
    const size_t length = strlen(path);
    unsigned long tries = 0;
    FILE *there = fopen(path, "r+b");           /* does not wait for the other end of a pipe */
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
    o->temporary = (char *)malloc(length + sizeof ".XXXXXXXX.tmp");
    if (!o->temporary) return moldyn_no_memory(m, call, (double)length, "letters of a file name");
    for (; !o->file && tries < 100; tries++) {
        sprintf(o->temporary, "%s.%08lx.tmp", path,
                ((unsigned long)time(0)*2654435761UL + (unsigned long)clock()*40503UL + tries) & 0xffffffffUL);
        errno = 0;
        o->file = fopen(o->temporary, "wbx");   /* C11: refuses an existing name, also a link */
        if (!o->file && errno != EEXIST) break;
    }
    if (!o->file && errno == EINVAL) o->file = fopen(o->temporary, "wb");       /* a library before C11 */
    return o->file ? DEM_OK : moldyn_out_close(o);
}
/* Writes the columns of rows: all, or in a plane those named by `flat`. of: the scene whose kinds are
   the last column, or null. */
static void moldyn_rows_put(FILE *file, const dem_real *rows, int count, int wide, int columns,
                            const int *flat, const moldyn *of) {
    int i, k;
    for (i = 0; i < count; i++) {
        for (k = 0; k < columns; k++)
            moldyn_put(file, (double)rows[(size_t)i*(size_t)wide + (size_t)(flat ? flat[k] : k)],
                       17, k + 1 < columns || of ? ' ' : '\n');
        if (of) fprintf(file, "%d\n", moldyn_kind(of, i));
    }
}
static void moldyn_outlines_put(FILE *file, const moldyn_outlines *o,
                                const moldyn_outline_kind *kind) {
    int i, k, count;
    if (o->count) fprintf(file, "%s %d\n", kind->key, o->count);
    for (i = 0; i < o->count; i++) {
        const dem_real *corners = moldyn_corners(o, i, &count);
        fprintf(file, "%d\n", count);
        for (k = 0; k < 2*count; k++)
            moldyn_put(file, (double)corners[k], 17, k & 1 ? '\n' : ' ');
    }
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
        moldyn_outlines_put(file, &m->polygons, &moldyn_polygon);
        fprintf(file, "%d\n", m->grain_count);
        moldyn_rows_put(file, m->grains, m->grain_count, MOLDYN_GRAIN,
                        planar ? MOLDYN_GRAIN_FLAT : MOLDYN_GRAIN, planar ? grain : 0,
                        m->polygons.count ? m : 0);
    }
    if (which == MOLDYN_WALLS) {
        moldyn_outlines_put(file, &m->parts, &moldyn_part);
        moldyn_outlines_put(file, &m->chains, &moldyn_chain);
        fprintf(file, "%d ", m->wall_count);
        moldyn_put(file, m->wall_thickness, 17, '\n');
        moldyn_rows_put(file, m->walls, m->wall_count, MOLDYN_WALL,
                        planar ? MOLDYN_WALL_FLAT : MOLDYN_WALL, planar ? wall : 0, 0);
    }
}
/* Writes the three files, except those whose paths are null. Each is written under a new temporary name
   (path.XXXXXXXX.tmp) and renamed, so that an existing file stays whole if writing fails. Reading the
   files gives the same numbers. */
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

/* Opens a file for appending; *fresh: 1 if it is new or empty. */
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
/* Returns the radius that a viewer of discs draws; for a polygon that of the disc of its area. */
static dem_real moldyn_round_radius(const dem_world *world, const dem_body_state *s) {
    const dem_world_desc desc = dem_world_desc_get(world);
    dem_shape_info info;
    if (!desc.planar || !s->shape.id || dem_shape_get(world, s->shape, &info) != DEM_OK)
        return s->radius;
    return (dem_real)(sqrt((double)info.volume/(3.14159265358979323846*(double)desc.thickness))*
                      (double)(s->radius/info.radius));
}
/* Appends a frame for XBALLS: a line with count, time (s, of the file: origin + dem_world_time_get) and
   the corners of box; then one line per grain: x, y (in space: z), their velocities, radius (of a
   polygon: that of the disc of its area), spin. The text of the appendix calls these six numbers
   position and velocity in space. m holds the origin of time and the error message; it may be MOLDYN. */
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
    moldyn_put(file, m->origin + dem_world_time_get(world), 12, ' ');
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
        moldyn_put(file, (double)moldyn_round_radius(world, &s), 0, ' ');
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
static void moldyn_str_body(FILE *file, const dem_body_state *s, int planar) {
    dem_quat q = s->orientation;
    dem_real R[9];
    int i;
    if (planar) q.x = q.y = 0;                  /* they are 0 except for round-off */
    for (i = 0; i < 3; i++) {
        const dem_vec3 e = dem_quat_rotate(q, dem_vec3_make(i == 0, i == 1, i == 2));
        R[i] = e.x; R[3 + i] = e.y; R[6 + i] = e.z;
    }
    moldyn_str_row(file, R, s->position);
}
/* Returns 1 if the head of the file, "interval frames bodies", has this number of bodies. */
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
        if (dem_wall_pose_get(world, walls[i], &pose) != DEM_OK)
            return moldyn_fail(m, DEM_ERROR_ARGUMENT, "%s: walls[%d] has id %ld, which the world "
                               "does not have; leave out walls that were removed", call, i,
                               (long)walls[i].id);
    return DEM_OK;
}
/* Appends a frame for ANIM. A new file begins with interval (s, >= 0, between frames), frames (their
   final number) and the number of bodies. Then there is one line per grain and per wall with rotation
   matrix and position (m). The matrix of a sphere without orientation is the identity. A polygon has
   its rotation from the listed orientation, and its centre of mass. Polygons and chains of walls have
   those of their frame, the identity and 0 until they move. walls: the walls to draw, such as m.planes
   (straight ones, then polygons, then chains); null if wall_count is 0. The number of bodies must be
   the same in all frames. */
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
        moldyn_str_body(file, &s, dem_world_desc_get(world).planar);
    }
    for (i = 0; i < wall_count; i++) {
        dem_pose pose;
        if (dem_wall_pose_get(world, walls[i], &pose) == DEM_OK)
            moldyn_str_row(file, pose.rotation, pose.position);
    }
    free(all.index);
    return moldyn_append_close(m, call, path, file);
}
#endif
