/* exam.c - the exam of a contact law, and its curves on one page. MIT licence.

   make law LAW=path/to/my_law.h        examines your law; without LAW the built-in laws
   build/exam [--out FOLDER]            writes a page NAME.html per law to build/out/exam

   A user-defined law is a header with its function and one line that describes it:

       #define LAW {"my law", my_law, 0, 3, 1, 1e5}     // name, function, c->user, reals, vectors, N/m

   The last five are law, law_user, law_memory, law_vectors and law_stiffness of the world desc. Five more fields are
   optional: the built-in law that supplies the coefficients (DEM_NORMAL_HERTZ); -1 (only the built-in laws below use this
   field); law_range in m; 1 if the law needs law_who (its grains then carry eight numbers, all zero); and the function that
   makes a bond (dem_contact_fn, its user is the world). With it paths begin bonded, in contact. docs/laws.md explains the
   lines of the exam and the curves. The exit code is 1 if a law fails a line. Two failures do not count: that of the line
   `quick`, and that of the line that a built-in law is known to fail. On Unix your law runs in a process of its own: if it
   crashes, ends the program or takes more than 20 s for a line, the exam says so, and the exit code is 1. */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200112L                  /* fork, alarm */
#define EXAM_APART 1                             /* a law is examined in a process of its own */
#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>
#endif
#include "../dem.h"
#include "study.h"
#include "exam.h"
#include "exam_curves.h"

#ifdef LAW_FILE
#include LAW_FILE
#ifndef LAW
#error the file of the law has no line "#define LAW {...}", which names the function: see examples/exam.c
#endif
#endif

/* An examined law. known: the line that a built-in law is known to fail, or -1. */
typedef struct examinee {
    const char *name;
    dem_law_fn law;
    void *user;
    int memory, vectors;
    double stiffness;
    dem_normal_law coefficients;
    int known;
    double range;
    int who;
    dem_contact_fn made;
} examinee;

#ifdef LAW
static const examinee examinees[] = {LAW};       /* missing fields are 0 */
enum { KNOWN = 0 };
#else
enum { KNOWN = 1 };
static void hertz_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
}
static void hertz_mindlin(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_mindlin(c, memory, f);
}
static void hertz_mindlin_rescaled(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_mindlin_rescaled(c, memory, f);
}
static void hertz_rescaled_epsd(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_mindlin_rescaled(c, memory + 3, f);         /* vectors come first */
    dem_law_roll_epsd(c, memory, f);
}
static void linear_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_linear(c, memory, f);
    dem_law_spring(c, memory, f);
}
static void hertz_viscous(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_viscous(c, memory, f);
}
static const examinee examinees[] = {
    {"hertz_spring", hertz_spring, 0, 3, 1, 0, DEM_NORMAL_HERTZ, EXAM_MIXED, 0, 0, 0},
    {"hertz_mindlin", hertz_mindlin, 0, 4, 1, 0, DEM_NORMAL_HERTZ, EXAM_MIXED, 0, 0, 0},
    {"hertz_mindlin_rescaled", hertz_mindlin_rescaled, 0, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 0, 0},
    {"hertz_rescaled_epsd", hertz_rescaled_epsd, 0, 7, 2, 0, DEM_NORMAL_HERTZ, -1, 0, 0, 0},
    {"linear_spring", linear_spring, 0, 3, 1, 0, DEM_NORMAL_LINEAR, -1, 0, 0, 0},
    {"hertz_viscous", hertz_viscous, 0, 0, 0, 0, DEM_NORMAL_HERTZ, -1, 0, 0, 0}};
#endif

/* ---- the page ---- */

/* Copies a picture that study.h has written into the page. */
static void paste(FILE *page, const char *name) {
    FILE *in = fopen(study_path(name), "r");
    char text[4096];
    size_t n;
    fputs("<figure>", page);
    while (in && (n = fread(text, 1, sizeof text, in)) > 0) fwrite(text, 1, n, page);
    if (in) fclose(in);
    if (in) study.files--;                      /* it is part of the page now */
    remove(study_path(name));
    fputs("</figure>\n", page);
}
static void draw(FILE *page, const char *title, const char *x, const char *y, int log_x, double top, int count,
                 const exam_curve *curves, const char *const *names) {
    study_figure f;
    int k;
    memset(&f, 0, sizeof f);
    f.title = title; f.x_label = x; f.y_label = y; f.log_x = log_x; f.size = 420; f.y1 = top;  /* 0: automatic */
    for (k = 0; k < count; k++)
        study_curve(&f, names ? names[k] : 0, STUDY_LINE, curves[k].count, curves[k].x, curves[k].y);
    study_figure_write(&f, "part.svg");
    paste(page, "part.svg");
}
static void portrait(const exam *e, const exam_sheet *sheet) {
    static const char *const rates[2] = {"quasi-static", "at impact speed"}, *const sizes[3] = {"small", "medium", "large"};
    static exam_curve c[3];
    char name[120];
    FILE *page;
    int k;
    snprintf(name, sizeof name, "%.100s.html", e->name);
    page = study_open(name);
    if (!page) return;
    fprintf(page, "<!DOCTYPE html><meta charset=\"utf-8\"><title>%s</title>\n<style>body{font-family:Helvetica,Arial,"
            "sans-serif;max-width:1240px;margin:2em auto;color:#222}figure{display:inline-block;margin:0}td{padding:.2em "
            "1em .2em 0;vertical-align:top}.found{color:#b3261e;font-weight:bold}</style>\n<h1>%s: %d of %d lines passed"
            "</h1>\n<p>Two grains of radius %g m, %g kg/m3, Young's modulus %g Pa, restitution %g, friction %g, rolling "
            "friction %g; paths to an overlap of %g radii, impacts at %g m/s. docs/laws.md explains the lines.</p>\n"
            "<table>\n", e->name, e->name, sheet->passed, (int)EXAM_LINES, e->radius, (double)e->material.density,
            (double)e->material.young, (double)e->material.restitution, (double)e->material.friction,
            (double)e->material.rolling_friction, e->deep, e->speed);
    for (k = 0; k < EXAM_LINES; k++)
        fprintf(page, "<tr><td%s<td>%s<td>%s\n", sheet->line[k].passed ? ">passed" : " class=\"found\">found",
                sheet->line[k].asks, sheet->line[k].found);
    fputs("</table>\n", page);
    exam_press(e, 1e-5*e->speed, &c[0]);
    exam_press(e, e->speed, &c[1]);
    draw(page, "Loaded, unloaded, reloaded", "overlap (m)", "normal force (N)", 0, 0, 2, c, rates);
    for (k = 0; k < 3; k++) exam_cycle(e, e->deep*e->radius*(k == 0 ? 0.1 : k == 1 ? 0.4 : 2), 0, &c[k]);
    draw(page, "Slid to and fro", "slip (m)", "tangential force (N)", 0, 0, 3, c, sizes);
    for (k = 0; k < 3; k++) exam_cycle(e, k == 0 ? 0.002 : k == 1 ? 0.01 : 0.05, 1, &c[k]);
    draw(page, "Rolled to and fro", "angle (rad)", "moment (N m)", 0, 0, 3, c, sizes);
    if (e->made) { study_close(page, name); return; }      /* bonded grains do not bounce */
    exam_bounces(e, &c[0]);
    draw(page, "Head-on impacts", "speed (m/s)", "restitution", 1, 1.1, 1, c, 0);
    exam_slants(e, &c[0], &c[1]);
    draw(page, "Oblique impacts: energy left", "angle from the normal (degrees)", "energy after over before", 0, 1.1, 1, c, 0);
    draw(page, "Oblique impacts: slip", "angle from the normal (degrees)", "slip after over normal speed before", 0, 0, 1,
         c + 1, 0);
    study_close(page, name);
}

/* Examines law k, and writes its page. */
static void examine(int k, void (*tell)(int line)) {
    const examinee *x = &examinees[k];
    exam e = exam_of(x->name, x->law, x->user, x->memory, x->vectors, x->stiffness);
    exam_sheet sheet;
    int line;
    e.coefficients = x->coefficients;
    e.range = x->range;
    e.who = x->who;
    e.made = x->made;
    e.tell = tell;
    if (exam_take(&e, &sheet) != DEM_OK) { study_fail("%s", sheet.line[0].found); return; }
    exam_print(&sheet, stdout);
    portrait(&e, &sheet);
    for (line = 0; line < EXAM_LINES; line++)
        if (!sheet.line[line].passed && !(KNOWN && line == x->known) && line != EXAM_COST)
            study_fail("%s: %s: %s", x->name, sheet.line[line].asks, sheet.line[line].found);
    study_result(x->name, sheet.passed, "lines passed");
}
#ifdef EXAM_APART
/* The process of a law tells the line that it begins; the last one, EXAM_LINES + 1, means that it has ended by itself. */
enum { SECONDS = 20 };                           /* for each line, and for the page */
static int told[2];
static void tell_line(int line) {
    const char byte = (char)line;
    alarm(SECONDS);                              /* ends the process */
    if (write(told[1], &byte, 1) != 1) _exit(1);
}
static int examine_apart(int k) {
    int status = 0, line = -1;
    char byte;
    pid_t child;
    if (pipe(told)) return -1;
    fflush(stdout);
    child = fork();
    if (child < 0) return -1;
    if (!child) {
        int code;
        close(told[0]);
        examine(k, tell_line);
        code = study_end();
        fflush(stdout);
        tell_line(EXAM_LINES + 1);
        _exit(code);
    }
    close(told[1]);
    while (read(told[0], &byte, 1) == 1) line = byte;
    close(told[0]);
    waitpid(child, &status, 0);
    if (line > EXAM_LINES) return WEXITSTATUS(status);
    printf("FOUND   %-38s  ", line < 0 ? "before the first line" : line < EXAM_LINES ? exam_rows()[line].asks
           : "the curves of the page");
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        printf("the law does not end: more than %d s: look for a loop whose condition stays true\n", SECONDS);
    else if (WIFSIGNALED(status))
        printf("the law crashes (signal %d): look for an index beyond its memory, or a null pointer\n",
               WTERMSIG(status));
    else printf("the law ends the program (exit code %d): a law returns, and calls neither exit nor abort\n",
                WEXITSTATUS(status));
    printf("%s: the exam ended at this line\n%s = 0 lines passed\n", examinees[k].name, examinees[k].name);
    return 1;
}
#endif

int main(int argc, char **argv) {
    const char *out = "build/out/exam";
    const study_option table[] = {{"out", STUDY_TEXT, &out, 0, 0, "", "folder of the results"}};
    int k;
    study_options(argc, argv, "The exam of contact laws: one page per law in build/out/exam. A user-defined law: make law LAW=my_law.h",
                  table, 1);
    study_begin(out);
#ifdef EXAM_APART
    if (!KNOWN) {
        const int code = examine_apart(0);
        if (code >= 0) return code;
    }
#endif
    for (k = 0; k < (int)(sizeof examinees/sizeof *examinees); k++) examine(k, 0);
    return study_end();
}
