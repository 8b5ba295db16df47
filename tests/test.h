/* test.h - the test runner, one page.

       int main(int argc, char **argv) {
           test_begin(argc, argv);                       // an argument: only sentences that contain it
           TEST("two equal spheres swap velocities when restitution is one") {
               CHECK_NEAR(v, 1, 1e-12);                  // dt = tc/50, second order: 1e-12 is round-off
           }
           return test_end();                            // prints "test_x: N passed, N failed"
       }

   With the environment variable TEST_NUMBERS set, every test also prints one row of a table: its sentence and
   the number that came nearest to its tolerance (tests/validation.awk makes docs/data/validation.csv of these).
   With TEST_TIMES set, every test prints its processor seconds.

   A check that fails prints the sentence and the numbers, and the test goes on. A test without a check
   fails. `continue` leaves a test early. Works with any C99 or C++11 compiler. */
#ifndef TEST_H
#define TEST_H
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct test_state {
    const char *program, *filter, *sentence;  /* sentence: null between tests */
    int passed, failed;                       /* tests */
    int checks, wrong;                        /* of the present test */
    int numbers;                              /* print rows? */
    int times;                                /* print processor seconds? */
    clock_t began;
    double used, value, expected, tolerance;  /* of the tightest number of the present test */
    const char *text;
} test_state;
static test_state test_now;
enum { test_shown_most = 5 };                 /* failures printed per test */

static inline void test_begin(int argc, char **argv) {
    const char *slash = argc > 0 ? strrchr(argv[0], '/') : 0;
    test_now.program = slash ? slash + 1 : argc > 0 ? argv[0] : "test";
    test_now.filter = argc > 1 ? argv[1] : "";
    test_now.numbers = getenv("TEST_NUMBERS") != 0;
    test_now.times = getenv("TEST_TIMES") != 0;
}
static inline int test_close(void) {          /* 0: the for of TEST ends */
    if (!test_now.sentence) return 0;
    if (test_now.checks == 0) printf("FAILED %s: \"%s\"\n    checks nothing\n", test_now.program, test_now.sentence);
    if (test_now.wrong > test_shown_most) printf("    ... and %d more\n", test_now.wrong - test_shown_most);
    if (test_now.numbers && test_now.text)
        printf("| %s | `%s` | %.9g | %.9g | %.2g | %.0f %% |\n", test_now.sentence, test_now.text, test_now.value,
               test_now.expected, test_now.tolerance, 100*test_now.used);
    if (test_now.times)
        printf("%8.2f s  %s: %s\n", (double)(clock() - test_now.began)/CLOCKS_PER_SEC, test_now.program, test_now.sentence);
    if (test_now.wrong > 0 || test_now.checks == 0) test_now.failed++;
    else test_now.passed++;
    test_now.sentence = 0;
    fflush(stdout);
    return 0;
}
static inline int test_open(const char *sentence) {
    test_close();                             /* the last one, when it was left by break */
    if (!strstr(sentence, test_now.filter)) return 0;
    test_now.sentence = sentence;
    test_now.began = clock();
    test_now.checks = test_now.wrong = 0;
    test_now.text = 0;
    test_now.used = 0;
    return 1;
}
static inline int test_end(void) {            /* exit code of the program */
    test_close();
    printf("%s: %d passed, %d failed\n", test_now.program, test_now.passed, test_now.failed);
    return test_now.failed > 0;
}
static inline int test_check(int right, const char *file, int line, const char *text) {  /* 1: print numbers */
    test_now.checks++;
    if (right) return 0;
    if (++test_now.wrong == 1) printf("FAILED %s: \"%s\"\n", test_now.program, test_now.sentence);
    if (test_now.wrong > test_shown_most) return 0;
    printf("    %s:%d: %s\n", file, line, text);
    return 1;
}
static inline void test_near(double value, double expected, double tolerance, const char *file, int line,
                             const char *text) {
    const double used = tolerance > 0 ? fabs(value - expected)/tolerance : 0;
    if (!test_now.text || used > test_now.used) {
        test_now.used = used; test_now.value = value; test_now.expected = expected;
        test_now.tolerance = tolerance; test_now.text = text;
    }
    if (test_check(fabs(value - expected) <= tolerance, file, line, text))  /* false for NaN */
        printf("        is %.17g, expected %.17g +- %g, off by %g\n", value, expected, tolerance,
               value - expected);
}
static inline void test_equal(long long a, long long b, const char *file, int line, const char *text) {
    if (test_check(a == b, file, line, text)) printf("        is %lld, expected %lld\n", a, b);
}
static inline void test_find(const char *haystack, const char *needle, const char *file, int line,
                             const char *text) {
    if (test_check(haystack && strstr(haystack, needle), file, line, text))
        printf("        is \"%s\"\n        lacks \"%s\"\n", haystack ? haystack : "(null)", needle);
}

#define TEST(sentence) for (int test_goes = test_open(sentence); test_goes; test_goes = test_close())
#define CHECK(cond) ((void)test_check((cond) ? 1 : 0, __FILE__, __LINE__, #cond))
#define CHECK_NEAR(value, expected, tolerance) \
    test_near((double)(value), (double)(expected), (double)(tolerance), __FILE__, __LINE__, #value)
#define CHECK_REL(value, expected, rel) /* rel: share of expected */ \
    test_near((double)(value), (double)(expected), (double)(rel)*fabs((double)(expected)), __FILE__, __LINE__, #value)
#define CHECK_EQ(a, b) test_equal((long long)(a), (long long)(b), __FILE__, __LINE__, #a " == " #b)
#define CHECK_STR(haystack, needle) test_find(haystack, needle, __FILE__, __LINE__, #haystack)
#endif
