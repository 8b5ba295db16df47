/* lesson.h - functions that the twelve lessons share: arguments, rows with measured and expected values, exercises and
   their marking. MIT licence. It contains no physics and calls no function of dem.h.

       int main(int argc, char **argv) {
           const int record = lesson_begin(argc, argv, "01_bounce");
           ...
           lesson_row("rebound [m]", measured, error, expected, 2);      // may differ by 2 %
           return lesson_end();
       }
       const char *const exercises[2] = {                                // at the end of the lesson
           "A ball falls from {2: 1 to 3 by 0.1} m. How long does it fall, in s?", ...};
       double answer(int exercise, const double *x) { return exercise == 1 ? sqrt(2*x[0]/9.81) : ...; }

   {2: 1 to 3 by 0.1} is a number of an exercise: 2 or, for a name, one of 1, 1.1 ... 3.

   Arguments of every lesson:
       (none)                         runs the lesson; exit code 1 if a result is not as expected
       --replay                       also records NN_name.html, a replay for the browser
       --check N VALUE                marks VALUE, in the unit of the exercise, as the answer to exercise N (1 or 2):
                                      exit code 0 if it is right within 5 %, otherwise 1
       --seed NAME                    prints the exercises with the numbers of a student's name
       --seed NAME --check N VALUE    marks the answer with these numbers
       --help                         prints this list; any other argument ends the program with exit code 2 */
#ifndef LESSON_H
#define LESSON_H
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Each lesson defines these two at its end: the texts of its exercises, and the right answer to exercise 1 or 2. The
   array x has the numbers of the exercise in the order of its text. */
extern const char *const exercises[2];
double answer(int exercise, const double *x);

enum { LESSON_NUMBERS = 8 };                    /* at most, of an exercise */
static const uint64_t lesson_unnamed = 14695981039346656037u;   /* the hash of an empty text */
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
/* Returns the FNV-1a hash (64 bits) of a text that follows another text with the given hash. Only letters and digits
   count, and a capital letter of ASCII counts as a small one: "Ada Lovelace" and "ada_lovelace" are the same name. Each
   byte of a letter outside of ASCII counts as it is. */
static inline uint64_t lesson_hash(uint64_t hash, const char *text) {
    for (; *text; text++) {
        unsigned c = (unsigned char)*text;
        if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c >= 128) hash = (hash ^ c)*1099511628211u;
    }
    return hash;
}
/* Returns a number from low to high in steps. It depends only on the hash of the student's name, the lesson, the
   exercise and the index of the number, so a name has the same numbers on every machine. */
static inline double lesson_draw(uint64_t seed, int exercise, int index, double low, double high, double step) {
    const char place[3] = {(char)('0' + exercise), (char)('0' + index), 0};
    const uint64_t choices = (uint64_t)((high - low)/step + 1.5);
    uint64_t hash = lesson_hash(lesson_hash(seed, lesson.name), place);
    hash = (hash ^ hash >> 32)*0xff51afd7ed558ccdu;         /* otherwise neighbours in one text are correlated */
    return low + step*(double)((hash >> 32)%choices);
}
/* Writes the numbers of an exercise: the first in the braces or, for a name with the hash `seed`, one of the range.
   Also prints the text with these numbers if `print` is 1. */
static inline void lesson_exercise(int exercise, uint64_t seed, int print, double x[LESSON_NUMBERS]) {
    int column = print ? printf("%d  ", exercise) : 0, count = 0;
    for (const char *text = exercises[exercise - 1]; *text; text++) {
        double low, high, step;
        int length = 0;
        if (count < LESSON_NUMBERS && *text == '{'
            && sscanf(text, "{%lf: %lf to %lf by %lf}%n", &x[count], &low, &high, &step, &length) == 4 && length) {
            if (seed != lesson_unnamed) x[count] = lesson_draw(seed, exercise, count, low, high, step);
            if (print) column += printf("%g", x[count]);
            count++;
            text += length - 1;
        } else if (print && *text == ' ' && column > 90) column = printf("\n   ") - 1;
        else if (print) column += printf("%c", *text);
    }
    if (print) puts("");
}
/* Prints the exercises with the numbers of a name and ends the program. */
static inline void lesson_exercises(const char *program, const char *name, uint64_t seed) {
    double x[LESSON_NUMBERS];
    printf("%s, exercises for %s\n", lesson.name, name);
    for (int exercise = 1; exercise <= 2; exercise++) lesson_exercise(exercise, seed, 1, x);
    printf("check an answer with %s --seed \"%s\" --check N VALUE\n", program, name);
    exit(0);
}
/* Marks the answer to an exercise and ends the program: exit code 0 if it is right, 1 if it is wrong. */
static inline void lesson_mark(const char *number, const char *text, const char *name, uint64_t seed) {
    double x[LESSON_NUMBERS];
    if (strcmp(number, "1") && strcmp(number, "2"))
        lesson_refuse("the exercises are 1 and 2", "for example --check 1 12.3");
    const int exercise = number[0] - '0';
    lesson_exercise(exercise, seed, 0, x);
    const double value = lesson_number(text), right = answer(exercise, x);
    const int wrong = !(fabs(value - right) <= 0.05*fabs(right));
    printf("exercise %d%s%s: %g is %s\n", exercise, *name ? " for " : "", name, value, wrong ? "wrong" : "right");
    exit(wrong);
}
/* Returns 1 if a replay is to be recorded, otherwise 0. All other arguments end the program here. */
static inline int lesson_begin(int argc, char **argv, const char *name) {
    const char *usage = "[--replay] or [--seed NAME] --check N VALUE (exercise N is 1 or 2) or --seed NAME or --help";
    const char *program = argv[0], *student = "";
    uint64_t seed = lesson_unnamed;
    lesson.name = name;
    if (argc < 2) return 0;
    if (!strcmp(argv[1], "--help")) {
        printf("%s %s\n  --replay         runs the lesson and records %s.html, a replay for the browser\n"
               "  --check N VALUE  marks your answer to exercise N: it is right within 5 %%\n"
               "  --seed NAME      prints the exercises with numbers that depend on your name; --check after it\n"
               "                   marks your answer with these numbers\n"
               "examples/%s.c begins with the question and ends with the theory and the exercises.\n",
               name, usage, name, name);
        exit(0);
    }
    if (!strcmp(argv[1], "--seed")) {
        if (argc < 3 || argv[2][0] == '-') lesson_refuse("--seed needs a name", "for example --seed Ada");
        student = argv[2];
        seed = lesson_hash(seed, student);
        if (seed == lesson_unnamed) lesson_refuse("the name has no letter and no digit", "for example --seed Ada");
        if (argc == 3) lesson_exercises(program, student, seed);
        if (strcmp(argv[3], "--check"))
            lesson_refuse("only --check may follow --seed NAME", "for example --seed Ada --check 1 12.3");
        argc -= 2;
        argv += 2;
    }
    if (!strcmp(argv[1], "--check")) {
        if (argc != 4)
            lesson_refuse("--check needs an exercise and a value",
                          "for example --check 1 12.3 or --seed Ada --check 1 12.3");
        lesson_mark(argv[2], argv[3], student, seed);
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
