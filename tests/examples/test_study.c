/* Sweeps of examples/study.h: all cores or one, resumed, with cases that fail; means with their errors. */
#include "../test.h"
#include "../../examples/study.h"

/* Adds a letter to a file, so that the test sees which cases have run; case 3 fails while `broken` is set. */
static int broken;
static int square_of(const double *p, double *result, void *user) {
    FILE *log = fopen("build/tmp/study_ran.txt", "ab");
    fprintf(log, "%c", 'a' + (int)p[0]);
    fclose(log);
    result[0] = p[0]*p[0] + *(double *)user;
    result[1] = p[1]/3;
    if (broken && p[0] > 2.5 && p[0] < 3.5) {
        if (broken == 2) abort();
        return 1;
    }
    return 0;
}
static char text[2000];
static const char *read_all(const char *path) {
    FILE *f = fopen(path, "rb");
    text[0] = 0;
    if (f) { text[fread(text, 1, sizeof text - 1, f)] = 0; fclose(f); }
    return text;
}
static int ran(void) { return (int)strlen(read_all("build/tmp/study_ran.txt")); }

int main(int argc, char **argv) {
    double parameter[16], result[16], more = 100;
    study_sweep s;
    char whole[2000];
    int i, jobs;
    test_begin(argc, argv);
    study.program = "test_study";
    snprintf(study.root, sizeof study.root, "build/tmp");
    snprintf(study.folder, sizeof study.folder, "build/tmp");
    memset(&s, 0, sizeof s);
    s.csv = "study_sweep.csv";
    s.heading = "x,y,square,third";
    s.cases = 8; s.parameters = s.results = 2;
    s.parameter = parameter;
    s.run = square_of;
    s.user = &more;
    for (i = 0; i < 8; i++) { parameter[2*i] = i; parameter[2*i + 1] = 1e-3*(7 - i); }

    for (jobs = 0; jobs < 4; jobs++)
        TEST("a sweep has the same rows for any number of processes, and resumes where it was stopped") {
            remove("build/tmp/study_sweep.csv");
            remove("build/tmp/study_ran.txt");
            s.jobs = jobs;
            CHECK_EQ(study_sweep_run(&s, result), 8);
            CHECK_EQ(ran(), 8);
            for (i = 0; i < 8; i++) {
                CHECK_NEAR(result[2*i], i*i + 100, 0);
                CHECK_NEAR(result[2*i + 1], 1e-3*(7 - i)/3, 0);
            }
            strcpy(whole, read_all("build/tmp/study_sweep.csv"));
            CHECK_STR(whole, "x,y,square,third\n0,0.007,100,0.00233333333\n1,0.006,101,0.002\n");
            memset(result, 0, sizeof result);
            CHECK_EQ(study_sweep_run(&s, result), 0);        /* nothing is missing */
            CHECK_EQ(ran(), 8);
            CHECK_NEAR(result[14], 149, 0);
            {   /* the last two rows are lost, one of them in the middle of a number; a row of another sweep is there */
                FILE *f = fopen("build/tmp/study_sweep.csv", "wb");
                char *cut = strstr(whole, "6,0.001,136");
                fprintf(f, "x,y,square,third\n55,1,2,3\n%.*s6,0.001,13", (int)(cut - strchr(whole, '\n') - 1),
                        strchr(whole, '\n') + 1);
                fclose(f);
            }
            memset(result, 0, sizeof result);
            CHECK_EQ(study_sweep_run(&s, result), 2);
            CHECK_EQ(ran(), 10);
            CHECK_NEAR(result[12], 136, 0);
            strcat(whole, "55,1,2,3\n");
            CHECK(!strcmp(read_all("build/tmp/study_sweep.csv"), whole));
        }

    TEST("a case that fails or crashes is reported and run again, the others keep their rows") {
        for (jobs = 1; jobs < 4; jobs++) {
            const int before = study.failures;
            remove("build/tmp/study_sweep.csv");
            s.jobs = jobs;
            broken = jobs == 2 ? 2 : 1;                      /* a crash needs a process of its own */
            CHECK_EQ(study_sweep_run(&s, result), 8);
            CHECK_EQ(study.failures, before + 1);
            CHECK(result[6] != result[6] && result[8] == 116);
            broken = 0;
            CHECK_EQ(study_sweep_run(&s, result), 1);
            CHECK_NEAR(result[6], 109, 0);
        }
        s.heading = "x,y,square,fourth";
        CHECK_EQ(study_sweep_run(&s, result), -1);
        CHECK_STR(read_all("build/tmp/study_sweep.csv"), "third");      /* it stays as it was */
    }

    TEST("a sweep takes the values of --values, and refuses text, too many values, and values out of range") {
        static struct { double speed, other; } base = {10, -1}, copy = {10, -1};
        const study_option table[2] = {{"speed", STUDY_REAL, &base.speed, 1, 50, "1/min", ""},
                                       {"other", STUDY_REAL, &base.other, 0, 9, "", ""}};
        double value[4] = {1, 2, 3, 4};
        const int failures = study.failures;
        CHECK_EQ(study_values_take("", 0, value, 4, 4), 4);
        CHECK_EQ(study_values_take("20,2.5e1", 0, value, 4, 4), 2);
        CHECK_NEAR(value[0], 20, 0);
        CHECK_NEAR(value[1], 25, 0);
        CHECK_EQ(study_values_take("3,0,1", 1, value, 4, 4), 3);     /* cases by their numbers, in rising order */
        CHECK(value[0] < 0.5 && value[1] < 1.5 && value[2] > 2.5);
        CHECK_EQ(study.failures, failures);
        CHECK_EQ(study_values_take("4", 1, value, 4, 4), 0);
        CHECK_EQ(study_values_take("0.5", 1, value, 4, 4), 0);
        CHECK_EQ(study_values_take("1,2,3,4,5", 0, value, 4, 4), 0);
        CHECK_EQ(study_values_take("1,,2", 0, value, 4, 4), 0);
        CHECK_EQ(study_values_take("1,", 0, value, 4, 4), 0);
        CHECK_EQ(study_values_take("nan", 0, value, 4, 4), 0);
        CHECK_EQ(study_values_take("1 2", 0, value, 4, 4), 0);
        CHECK_EQ(study.failures, failures + 7);
        CHECK(study_within(table, 2, &base, &copy));                 /* a default may be outside: -1 */
        copy.speed = 60;
        CHECK(!study_within(table, 2, &base, &copy));
        CHECK_EQ(study.failures, failures + 8);
        study.failures = failures;
    }

    TEST("the mean leaves out missing values and has the standard error of the others") {
        const double x[8] = {1, 9, 2, 9, NAN, 9, 3, 9};
        double error;
        CHECK_NEAR(study_mean(x, 4, 2, &error), 2, 1e-15);
        CHECK_NEAR(error, 1/sqrt(3.0), 1e-15);
        CHECK(!(study_mean(x + 4, 1, 1, &error) > 0) && error != error);
    }
    return test_end();
}
