/* ---------------------------------------------------------------------------------------------
   >>platform
   Portability layer: compiler attributes, floating-point rules, OpenMP and the clock. Apart from a
   few pragmas around single kernels and the calls of operating systems, differences between
   compilers are handled here. The only parallel loop is demi_parallel. It hands whole work groups
   ("domains" in the code) to threads, and the functions that it calls do not depend on the number
   of threads. DEM_INLINE forces inlining, because a kernel is specialised only where it is inlined
   into its variants.
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
#define DEMI_ALIGNED __attribute__((aligned(64)))           /* start on a cache line */
#define DEMI_RESTRICT __restrict__
#define DEMI_FETCH(p) __builtin_prefetch(p)                 /* prefetch */
#define DEMI_APART __attribute__((noinline))                /* never inline: its register
                                                               pressure stays out of the caller */
#define DEMI_FORMAT(f, a) __attribute__((format(printf, f, a)))
#else
#define DEMI_ALIGNED
#define DEMI_RESTRICT
#define DEMI_FETCH(p) (void)(p)
#define DEMI_APART
#define DEMI_FORMAT(f, a)
#endif

/* From here to the end of the implementation, every product and every sum is rounded separately,
   whatever the compiler options are. GNU C fuses them by default where the processor can. One
   expression could then have two values in two places, and an interrupted run would differ from an
   uninterrupted one. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif

/* Keeps the compiler from turning a loop that copies into gather instructions, which are slower. */
#if defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_ONE_BY_ONE(i) __asm__ __volatile__("" : "+r"(i))
#else
#define DEMI_ONE_BY_ONE(i) ((void)0)
#endif

/* In front of a short loop of constant length, which compilers do not unroll at -O2. */
#if defined(__clang__)
#define DEMI_UNROLL _Pragma("unroll")
#elif defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_UNROLL _Pragma("GCC unroll 16")
#else
#define DEMI_UNROLL
#endif

#ifndef DEM_DOMAIN_BODIES
#define DEM_DOMAIN_BODIES 2048
#endif

#define DEMI_MIN(a, b) ((a) < (b) ? (a) : (b))
#define DEMI_MAX(a, b) ((a) > (b) ? (a) : (b))
#define DEMI_PI 3.14159265358979323846

/* Calls task(w, i) for i = 0 .. count - 1. Tasks must not depend on each other. Each thread has a
   share of consecutive tasks, because neighbours share data, and it takes some tenths of a
   microsecond until a thread sees what another one wrote. Phases of a step differ in where their
   work is, so a thread that has done its share takes tasks of the others. Who computes a task
   changes no result. middle: for each task the part, 0 .. 1, of all work that is done once half of
   this task is, ascending; null: all tasks are equal. */
typedef void (*demi_task)(dem_world *w, int index);
typedef struct demi_share { int next, end; char apart[56]; } demi_share;   /* a cache line */
static void demi_parallel(dem_world *w, int threads, int count, const double *middle,
                          demi_task task) {
    int i;
#if DEMI_OPENMP
    enum { MOST = 256 };
    threads = threads < MOST ? threads : MOST;
    if (threads > 1 && count > 1) {
        demi_share share[MOST];
        int t;
        for (t = i = 0; t < threads; t++) {
            share[t].next = i;
            while (i < count && (int)((middle ? middle[i] : (i + 0.5)/count)*threads) <= t) i++;
            share[t].end = t + 1 < threads ? i : count;
        }
        #pragma omp parallel num_threads(threads) private(t, i)
        for (t = 0; t < threads; t++) {
            demi_share *s = &share[(omp_get_thread_num() + t)%threads];
            for (;;) {
#if _OPENMP >= 201107
                #pragma omp atomic capture
#else
                #pragma omp critical(demi_share)
#endif
                i = s->next++;
                if (i >= s->end) break;
                task(w, i);
            }
        }
        return;
    }
#endif
    (void)threads;
    (void)middle;
    for (i = 0; i < count; i++) task(w, i);
}
/* 1: worlds use as many threads as their desc says. See >>team. */
#ifdef DEM_THREADS_FIXED
enum { DEMI_THREADS_FIXED = 1 };
#else
enum { DEMI_THREADS_FIXED = !DEMI_OPENMP };
#endif
/* Number of threads to use if desc.threads is 0. */
static int demi_threads_available(void) {
#if DEMI_OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}
static double demi_clock(void) {                          /* wall time, s; for progress only */
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
