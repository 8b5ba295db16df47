/* sorting.h - how well a screening machine sorts: efficiency, gangue and rate of several outlets.
   MIT licence. Include it after dem.h.

   Each outlet (dem_outlet_add) counts two kinds of grains: s of the radii wanted there, and g others,
   the gangue. Measures of M outlets together, by number of grains or by mass [ALK07]:

       efficiency   1/M sum s/(s + g)               eq 4.33, 4.35
       gangue       sum g/sum (s + g)               eq 4.41
       rate         sum (s + g)/(time counted)      eq 4.40

   An outlet through which no grain has left yet counts as 0 in the efficiency; `silent` is the number
   of these outlets. [ALK07] counts the lowest deck as 1 from the start. Its eq 4.36 contains the
   density twice, which we take for a misprint. The time begins at the earliest start of an outlet:
   its addition or its last dem_outlet_reset.
   Tests: tests/scene/test_feed.c. Used by examples/screener.c. */
#ifndef SORTING_H
#define SORTING_H
#include <stdio.h>
#include <string.h>

typedef struct sorting {
    double efficiency_number, efficiency_mass; /* 0..1 */
    double gangue_number, gangue_mass;         /* 0..1, share of gangue in all that left */
    double rate_number, rate_mass;             /* grains/s, kg/s */
    int silent;                                /* outlets through which no grain has left yet */
    char error[200];                           /* why sorting_get failed, else "" */
} sorting;

/* Computes the measures of `count` outlets (>= 0) into *out. DEM_ERROR_ARGUMENT, with a message in
   out->error, for a null pointer or an outlet that the world does not have. */
static inline dem_result sorting_get(const dem_world *world, const dem_outlet *outlets, int count,
                                     sorting *out) {
    double number = 0, mass = 0, gangue = 0, gangue_mass = 0, seconds = 0;
    const double now = dem_world_time_get(world);
    int i;
    if (!out) return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    if (!world || count < 0 || (count && !outlets)) {
        snprintf(out->error, sizeof out->error, "sorting_get: %s is null or count, %d, is "
                 "negative; give both, and as many outlets as count says", world ? "outlets"
                 : "world", count);
        return DEM_ERROR_ARGUMENT;
    }
    for (i = 0; i < count; i++) {
        dem_outlet_state o;
        if (dem_outlet_get(world, outlets[i], &o) != DEM_OK) {
            memset(out, 0, sizeof *out);
            snprintf(out->error, sizeof out->error, "sorting_get: outlet %ld, number %d of %d, "
                     "does not exist; give ids that dem_outlet_add has returned",
                     (long)outlets[i].id, i + 1, count);
            return DEM_ERROR_ARGUMENT;
        }
        if (now - o.since > seconds) seconds = now - o.since;
        if (!o.total) { out->silent++; continue; }
        out->efficiency_number += (double)o.sorted/(double)o.total/count;
        out->efficiency_mass += o.sorted_mass/o.total_mass/count;
        number += (double)o.total;
        mass += o.total_mass;
        gangue += (double)o.gangue;
        gangue_mass += o.gangue_mass;
    }
    if (number > 0) {
        out->gangue_number = gangue/number;
        out->gangue_mass = gangue_mass/mass;
    }
    if (seconds > 0) {
        out->rate_number = number/seconds;
        out->rate_mass = mass/seconds;
    }
    return DEM_OK;
}
#endif
