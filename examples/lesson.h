/* lesson.h - what the twelve lessons share: arguments, rows of what was measured beside what is expected, the marking
   of exercises. MIT licence. There is no physics in it, and no call of dem.h: those are in the lessons.

       static double answer(int exercise);                              // 1 or 2; at the end of the lesson
       int main(int argc, char **argv) {
           const int replay = lesson_begin(argc, argv, "01_bounce", answer);
           ...
           lesson_row("rebound [m]", measured, error, expected, 2);      // 2 % may be missing
           return lesson_end();
       }

   Arguments of every lesson:
       (none)             runs it; exit code 1 when something measured is not as expected
       --replay           the same, with a film NN_name.html for the browser
       --check N VALUE    marks your answer to exercise N (1 or 2), in the unit that the exercise names: within 5 % is
                          right, exit code 0; else wrong, 1
       --help             says so; anything else is refused, exit code 2 */
#ifndef LESSON_H
#define LESSON_H
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct lesson_state { const char *name; char film[64]; int rows, wrong; } lesson = {"", "", 0, 0};

/* Ends the program for a bad argument: one sentence, exit code 2. */
static inline void lesson_refuse(const char *what, const char *remedy) {
    fprintf(stderr, "%s: %s; %s\n", lesson.name, what, remedy);
    exit(2);
}
/* A number, with a decimal point and no unit. */
static inline double lesson_number(const char *text) {
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end || !(fabs(value) < 1e300))
        lesson_refuse("VALUE is no number", "write it as 12.3 or 1.23e1, without a unit");
    return value;
}
/* 1: a film is wanted, 0: not. --help, --check and bad arguments end the program here. */
static inline int lesson_begin(int argc, char **argv, const char *name, double (*answer)(int exercise)) {
    const char *usage = "[--replay] or --check N VALUE, N being the exercise, 1 or 2; --help";
    lesson.name = name;
    if (argc < 2) return 0;
    if (!strcmp(argv[1], "--help")) {
        printf("%s %s\n  --replay         runs the lesson and writes %s.html, a film for the browser\n"
               "  --check N VALUE  marks your answer to exercise N: within 5 %% is right\n"
               "The question, the physics and the exercises are in the first comment of examples/%s.c\n", name, usage,
               name, name);
        exit(0);
    }
    if (!strcmp(argv[1], "--check")) {
        if (argc != 4) lesson_refuse("--check takes an exercise and a value", "such as --check 1 12.3");
        if (strcmp(argv[2], "1") && strcmp(argv[2], "2"))
            lesson_refuse("there are exercises 1 and 2", "such as --check 1 12.3");
        const int exercise = argv[2][0] - '0';
        const double value = lesson_number(argv[3]), right = answer(exercise);
        const int wrong = !(fabs(value - right) <= 0.05*fabs(right));
        printf("exercise %d: %g is %s\n", exercise, value, wrong ? "wrong" : "right");
        exit(wrong);
    }
    if (argc != 2 || strcmp(argv[1], "--replay")) lesson_refuse("these arguments mean nothing here", usage);
    snprintf(lesson.film, sizeof lesson.film, "%s.html", name);
    remove(lesson.film);                        /* that of an earlier run: lesson_end looks whether there is a new one */
    return 1;
}

/* Mean of n values from runs that differ by chance, and its standard error. */
static inline double lesson_mean(const double *values, int n, double *error) {
    double sum = 0, squares = 0;
    for (int i = 0; i < n; i++) sum += values[i];
    for (int i = 0; i < n; i++) squares += (values[i] - sum/n)*(values[i] - sum/n);
    *error = n > 1 ? sqrt(squares/(n - 1)/n) : 0;
    return sum/n;
}
static inline void lesson_tell(const char *name, double value, double error, int right) {
    char bar[32] = "";
    if (!lesson.rows++) printf("\n%-42s %10s %-11s   %s\n", "", "measured", "", "expected");
    if (error > 0) snprintf(bar, sizeof bar, "+- %.2g", error);
    printf("%-42s %10.5g %-11s ", name, value, bar);
    lesson.wrong += !right;
}
/* What was measured (error: its standard error, 0: none) beside what is expected, within so many per cent of that. */
static inline void lesson_row(const char *name, double value, double error, double expected, double percent) {
    const int right = fabs(value - expected) <= percent/100*fabs(expected);
    lesson_tell(name, value, error, right);
    printf("%s %.5g within %g %%\n", right ? " " : "!", expected, percent);
}
/* The same, where theory or other people's measurements name a range. */
static inline void lesson_range(const char *name, double value, double error, double low, double high) {
    const int right = value >= low && value <= high;
    lesson_tell(name, value, error, right);
    printf("%s %.5g to %.5g\n", right ? " " : "!", low, high);
}
/* The exit code: 1 when a row, marked with !, was not as expected, or a film that was wanted is not there. */
static inline int lesson_end(void) {
    if (*lesson.film) {
        FILE *film = fopen(lesson.film, "rb");
        printf(film ? "open %s in a browser: it plays the run\n" : "%s could not be written: is this folder yours?\n",
               lesson.film);
        if (!film) return 1;
        fclose(film);
    }
    if (lesson.wrong) printf("%s: %d of %d rows are not as expected, see !\n", lesson.name, lesson.wrong, lesson.rows);
    return lesson.wrong > 0 || lesson.rows == 0;
}
#endif
