/* lesson.h - functions that the twelve lessons share: arguments, rows with measured and expected values, marking of
   exercises. MIT licence. It contains no physics and calls no function of dem.h.

       static double answer(int exercise);                              // exercise 1 or 2; at the end of the lesson
       int main(int argc, char **argv) {
           const int record = lesson_begin(argc, argv, "01_bounce", answer);
           ...
           lesson_row("rebound [m]", measured, error, expected, 2);      // may differ by 2 %
           return lesson_end();
       }

   Arguments of every lesson:
       (none)             runs the lesson; exit code 1 if a result is not as expected
       --replay           also records NN_name.html, a replay for the browser
       --check N VALUE    marks VALUE, in the unit of the exercise, as the answer to exercise N (1 or 2): exit code 0
                          if it is right within 5 %, otherwise 1
       --help             prints this list; any other argument ends the program with exit code 2 */
#ifndef LESSON_H
#define LESSON_H
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct lesson_state { const char *name; char replay[64]; int rows, wrong; } lesson = {"", "", 0, 0};

/* Ends the program because of a bad argument: prints the reason and the remedy, exit code 2. */
static inline void lesson_refuse(const char *reason, const char *remedy) {
    fprintf(stderr, "%s: %s; %s\n", lesson.name, reason, remedy);
    exit(2);
}
/* Returns the number that a text holds; ends the program if the text is anything else. */
static inline double lesson_number(const char *text) {
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end || !(fabs(value) < 1e300))
        lesson_refuse("VALUE is not a number", "write it as 12.3 or 1.23e1, without a unit");
    return value;
}
/* Returns 1 if a replay is to be recorded, otherwise 0. --help, --check and bad arguments end the program here. */
static inline int lesson_begin(int argc, char **argv, const char *name, double (*answer)(int exercise)) {
    const char *usage = "[--replay] or --check N VALUE (exercise N is 1 or 2) or --help";
    lesson.name = name;
    if (argc < 2) return 0;
    if (!strcmp(argv[1], "--help")) {
        printf("%s %s\n  --replay         runs the lesson and records %s.html, a replay for the browser\n"
               "  --check N VALUE  marks your answer to exercise N: it is right within 5 %%\n"
               "examples/%s.c begins with the question and ends with the theory and the exercises.\n",
               name, usage, name, name);
        exit(0);
    }
    if (!strcmp(argv[1], "--check")) {
        if (argc != 4) lesson_refuse("--check needs an exercise and a value", "for example --check 1 12.3");
        if (strcmp(argv[2], "1") && strcmp(argv[2], "2"))
            lesson_refuse("the exercises are 1 and 2", "for example --check 1 12.3");
        const int exercise = argv[2][0] - '0';
        const double value = lesson_number(argv[3]), right = answer(exercise);
        const int wrong = !(fabs(value - right) <= 0.05*fabs(right));
        printf("exercise %d: %g is %s\n", exercise, value, wrong ? "wrong" : "right");
        exit(wrong);
    }
    if (argc != 2 || strcmp(argv[1], "--replay")) lesson_refuse("unknown arguments", usage);
    snprintf(lesson.replay, sizeof lesson.replay, "%s.html", name);
    remove(lesson.replay);                      /* so that lesson_end cannot mistake an old file for the new one */
    return 1;
}

/* Returns the mean of n values from independent runs and writes its standard error. */
static inline double lesson_mean(const double *values, int n, double *error) {
    double sum = 0, squares = 0;
    for (int i = 0; i < n; i++) sum += values[i];
    for (int i = 0; i < n; i++) squares += (values[i] - sum/n)*(values[i] - sum/n);
    *error = n > 1 ? sqrt(squares/(n - 1)/n) : 0;
    return sum/n;
}
/* Prints a value with four significant digits or, if its error is not 0, with the decimals of the error's first two
   digits. */
static inline void lesson_print(const char *name, double value, double error, int right) {
    char text[64];
    int decimals = error > 0 ? 1 - (int)floor(log10(error)) : 0;
    decimals = decimals < 0 ? 0 : decimals > 6 ? 6 : decimals;
    if (!lesson.rows++) printf("\n%-46s %-18s  %s\n", "(! marks a value outside of its limits)", "measured", "expected");
    if (error > 0) snprintf(text, sizeof text, "%.*f +- %.*f", decimals, value, decimals, error);
    else snprintf(text, sizeof text, "%.4g", value);
    printf("%-46s %-18s%s ", name, text, right ? " " : "!");
    lesson.wrong += !right;
}
/* Prints a measured value (error: its standard error; 0: none) and the expected one, from which it may differ by some
   per cent. */
static inline void lesson_row(const char *name, double value, double error, double expected, double percent) {
    lesson_print(name, value, error, fabs(value - expected) <= percent/100*fabs(expected));
    if (percent > 0) printf("%.4g within %g %%\n", expected, percent);
    else printf("%.4g\n", expected);
}
/* The same with an expected range. */
static inline void lesson_range(const char *name, double value, double error, double low, double high) {
    lesson_print(name, value, error, value >= low && value <= high);
    printf("%.4g to %.4g\n", low, high);
}
/* Checks a claim about the program itself; prints it only if it does not hold. */
static inline void lesson_claim(const char *claim, int holds) {
    if (holds) return;
    printf("! this should hold, but does not: %s\n", claim);
    lesson.wrong++;
}
/* Returns the exit code: 1 if a row, marked with !, or a claim is wrong, or if the replay was not written. */
static inline int lesson_end(void) {
    if (*lesson.replay) {
        FILE *file = fopen(lesson.replay, "rb");
        printf(file ? "open %s in a browser: it plays the run\n" : "cannot write %s: is this folder writable?\n",
               lesson.replay);
        if (!file) return 1;
        fclose(file);
    }
    if (lesson.wrong) printf("%s: %d results are not as expected: the rows with !\n", lesson.name, lesson.wrong);
    return lesson.wrong > 0 || lesson.rows == 0;
}
#endif
