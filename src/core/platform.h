/* ---------------------------------------------------------------------------------------------
   >>platform
   What differs between compilers lives here and nowhere else. Kernels must be inlined into their
   variants to be specialised, hence DEM_INLINE; compilers vectorise a root only when told that it
   does not set errno. There is one parallel loop, demi_parallel: it deals whole domains to threads,
   and what it calls never knows how many threads there are.
   --------------------------------------------------------------------------------------------- */
#include <float.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(_OPENMP) && !defined(DEM_NO_OPENMP)
#include <omp.h>
#define DEMI_OPENMP 1
#else
#define DEMI_OPENMP 0
#endif

#if defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_ALIGNED __attribute__((aligned(64)))           /* to a cache line */
#define DEMI_RESTRICT __restrict__
#define DEMI_FETCH(p) __builtin_prefetch(p)                 /* will be read soon */
#define DEMI_APART __attribute__((noinline))                /* keeps its registers to itself */
#define DEMI_FORMAT(f, a) __attribute__((format(printf, f, a)))
#else
#define DEMI_ALIGNED
#define DEMI_RESTRICT
#define DEMI_FETCH(p) (void)(p)
#define DEMI_APART
#define DEMI_FORMAT(f, a)
#endif
#if defined(__clang__)
#define DEMI_VECTOR                      /* clang checks for aliases itself, and warns when asked */
#elif defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_VECTOR _Pragma("GCC ivdep")
#else
#define DEMI_VECTOR
#endif

/* Products and sums are rounded one by one, whatever the compiler was told. Fused, as GNU C does it
   by default where processors can, one expression gives two answers at two places, and a run that
   is interrupted another one than a run that is not. To the end of the implementation. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif

/* In a loop that copies: keeps compilers from making gathers of it, which are slower. */
#if defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_ONE_BY_ONE(i) __asm__ __volatile__("" : "+r"(i))
#else
#define DEMI_ONE_BY_ONE(i) ((void)0)
#endif

/* Statements for 0 to 7, written out: compilers leave loops as loops at -O2. */
#define DEMI_EIGHT(DO) do { DO(0); DO(1); DO(2); DO(3); DO(4); DO(5); DO(6); DO(7); } while (0)

/* Kernels are compiled twice where that costs the user nothing: for any processor of the target,
   and for those with wider vectors, which the loader finds out. "avx2" does not bring fused
   multiplying and adding along, so both give the same bits. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__) && defined(__x86_64__) && \
    !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(DEM_NO_CLONES)
#define DEMI_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define DEMI_CLONES
#endif

#ifndef DEM_DOMAIN_BODIES
#define DEM_DOMAIN_BODIES 2048
#endif

#define DEMI_MIN(a, b) ((a) < (b) ? (a) : (b))
#define DEMI_MAX(a, b) ((a) > (b) ? (a) : (b))
#define DEMI_PI 3.14159265358979323846

/* Calls task(world, i) for i = 0 .. count-1. Tasks must not depend on each other. */
typedef void (*demi_task)(dem_world *w, int index);
static void demi_parallel(dem_world *w, int threads, int count, demi_task task) {
    int i;
#if DEMI_OPENMP
    if (threads > 1 && count > 1) {
        /* a few runs of neighbours to each thread, dealt in turns: where a scene is dense, it is so
           in several domains side by side */
        const int run = DEMI_MAX(1, count/(4*threads));
        #pragma omp parallel for num_threads(threads) schedule(static, run)
        for (i = 0; i < count; i++) task(w, i);
        return;
    }
#endif
    (void)threads;
    for (i = 0; i < count; i++) task(w, i);
}
/* Threads that a world may have when its desc leaves the number open. */
static int demi_threads_available(void) {
#if DEMI_OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}
static double demi_clock(void) {                          /* s of wall time, for progress only */
#if DEMI_OPENMP
    return omp_get_wtime();
#elif defined(TIME_UTC)
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
#else
    return (double)clock()/CLOCKS_PER_SEC;
#endif
}
