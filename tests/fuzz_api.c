/* fuzz_api.c - any bytes as a program of public calls, see fuzz_api.h. `make fuzz` builds it for clang's
   fuzzer. By itself, with any compiler (POSIX):

       cc -g -O1 -fopenmp -fsanitize=address,undefined -DFUZZ_MAIN -I. tests/fuzz_api.c -o build/fuzz_api -lm
       build/fuzz_api SECONDS [FIRST_SEED]         runs seeds; a failing one is shrunk and printed
       build/fuzz_api seed SEED                    shrinks and prints the one
   With -DFUZZ_LINKED the implementation is linked from an object of its own. */
#ifdef FUZZ_MAIN
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#endif
#ifndef DEM_DOMAIN_BODIES
#define DEM_DOMAIN_BODIES 16
#endif
#ifndef FUZZ_LINKED
#define DEM_IMPLEMENTATION
#endif
#include "../dem.h"
#include "fuzz_api.h"

#ifndef FUZZ_MAIN
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    int at;
    fuzz_folder = "build";
    if (fuzz_run_program(data, size, 0, &at)) {
        fuzz_run_program(data, size, 1, &at);
        printf("=> %s\n", fuzz_wrong);
        fflush(stdout);
        abort();
    }
    return 0;
}
#else
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { BATCH = 25, PATIENCE = 60 };             /* programs to a process; s, then it hangs */

/* FUZZ_TRY="null_arguments memory_refused": has in what fuzz_avoids leaves out; "all": everything. */
static void try_also(const char *names) {
    const struct { const char *name; int *avoided; } all[] = {
        {"null_arguments", &fuzz_avoids.null_arguments}, {"unusable_values", &fuzz_avoids.unusable_values},
        {"checkpoint_after_pairs", &fuzz_avoids.checkpoint_after_pairs},
        {"checkpoint_after_remove", &fuzz_avoids.checkpoint_after_remove},
        {"checkpoint_oriented_reader", &fuzz_avoids.checkpoint_oriented_reader},
        {"stale_domains", &fuzz_avoids.stale_domains},
        {"step_refused_after_feed", &fuzz_avoids.step_refused_after_feed},
        {"slabs_in_one_world", &fuzz_avoids.slabs_in_one_world},
        {"slabs_collect_changed", &fuzz_avoids.slabs_collect_changed},
        {"memory_refused", &fuzz_avoids.memory_refused},
        {"memory_refused_hash", &fuzz_avoids.memory_refused_hash},
        {"going_on_after_unstable", &fuzz_avoids.going_on_after_unstable}};
    size_t i;
    for (i = 0; names && i < sizeof all/sizeof *all; i++)
        if (strstr(names, all[i].name) || strstr(names, "all")) *all[i].avoided = 0;
}
static int mask_of(uint64_t seed) {
    static const int masks[] = {FUZZ_EVERYTHING, FUZZ_GRAINS | FUZZ_KEPT, FUZZ_GRAINS | FUZZ_SHAPES | FUZZ_KEPT,
        FUZZ_GRAINS | FUZZ_FLOW | FUZZ_KEPT, FUZZ_GRAINS | FUZZ_SLABS, FUZZ_EVERYTHING & ~FUZZ_SLABS};
    return masks[seed%6];
}
/* In a process of its own: 1 when it fails in whatever way. */
static int fails_apart(const unsigned char *bytes, size_t size) {
    int status = 0, at;
    pid_t pid;
    fflush(stdout);
    if ((pid = fork()) == 0) {
        if (!freopen("/dev/null", "w", stderr)) _exit(3);
        alarm(PATIENCE);
        _exit(fuzz_run_program(bytes, size, 0, &at));
    }
    waitpid(pid, &status, 0);
    return status != 0;
}
static void tell(uint64_t seed, int whole) {
    unsigned char bytes[FUZZ_BYTES];
    size_t size = fuzz_make(seed, mask_of(seed), bytes);
    int status = 0, at;
    pid_t pid;
    printf("==== seed %llu (parts %d)\n", (unsigned long long)seed, mask_of(seed));
    if (!whole) size = fuzz_shrink(bytes, size, fails_apart);
    fflush(stdout);
    if ((pid = fork()) == 0) {
        int wrong;
        alarm(PATIENCE);
        wrong = fuzz_run_program(bytes, size, 1, &at);
        printf("=> %s\n", wrong ? fuzz_wrong : "as it should be");
        fflush(stdout);
        _exit(wrong);
    }
    waitpid(pid, &status, 0);
    if (WIFSIGNALED(status))
        printf("\n=> signal %d%s\n", WTERMSIG(status), WTERMSIG(status) == SIGALRM ? " (hangs)" : "");
    else if (WEXITSTATUS(status) > 1) printf("\n=> ended with code %d\n", WEXITSTATUS(status));
    fflush(stdout);
}
int main(int argc, char **argv) {
    const time_t begin = time(0);
    uint64_t seed = argc > 2 ? strtoull(argv[2], 0, 10) : 1;
    const long seconds = argc > 1 ? atol(argv[1]) : 60;
    long programs = 0, failures = 0;
    fuzz_folder = getenv("FUZZ_FOLDER") ? getenv("FUZZ_FOLDER") : "build/tmp";
    try_also(getenv("FUZZ_TRY"));
    if (argc > 2 && !strcmp(argv[1], "seed")) { tell(seed, argc > 3); return 0; }
    while (time(0) - begin < seconds && failures < 20) {
        int way[2], status = 0;
        uint64_t at = seed, one;
        pid_t pid;
        if (pipe(way)) return 1;
        fflush(stdout);
        if ((pid = fork()) == 0) {                       /* says which seed it begins */
            int wrong = 0, where;
            if (!freopen("/dev/null", "w", stderr)) _exit(3);
            for (one = seed; one < seed + BATCH && !wrong; one++) {
                unsigned char bytes[FUZZ_BYTES];
                const size_t size = fuzz_make(one, mask_of(one), bytes);
                if (write(way[1], &one, sizeof one) != (ssize_t)sizeof one) _exit(3);
                alarm(PATIENCE);
                wrong = fuzz_run_program(bytes, size, 0, &where);
            }
            _exit(wrong);
        }
        close(way[1]);
        while (read(way[0], &one, sizeof one) == (ssize_t)sizeof one) { at = one; programs++; }
        close(way[0]);
        waitpid(pid, &status, 0);
        if (status) { failures++; tell(at, 0); }
        seed = at + 1;
    }
    printf("%ld programs, %ld failures, next seed %llu\n", programs, failures, (unsigned long long)seed);
    return failures > 0;
}
#endif
