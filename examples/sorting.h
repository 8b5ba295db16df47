/* sorting.h - how well a screening machine sorts: efficiency, gangue and rate of several outlets.
   MIT licence. Include it after dem.h.

   Of each outlet (dem_outlet_add) two kinds of grains are counted: s of the radii wanted there, and
   g others, the gangue. Of M outlets together, by number of grains and by mass, [ALK07]:

       efficiency   1/M sum s/(s + g)               eq 4.33, 4.35
       gangue       sum g/sum (s + g)               eq 4.41
       rate         sum (s + g)/(time counted)      eq 4.40

   An outlet that nothing has left yet counts as 0 in the efficiency, and `silent` says how many
   these are; [ALK07] takes 1 for the lowest deck from the start. Its eq 4.36 contains the density
   twice, which we take for a misprint. The time is counted from the creation of the world or the
   last dem_outlet_reset, whichever outlet's is the earliest.
   Tests: tests/scene/test_feed.c. Used by examples/screener.c. */
#ifndef SORTING_H
#define SORTING_H
#include <stdio.h>
#include <string.h>

typedef struct sorting {
    double efficiency_number, efficiency_mass; /* 0..1 */
    double gangue_number, gangue_mass;         /* 0..1, share of gangue in all that left */
    double rate_number, rate_mass;             /* grains/s, kg/s */
    int silent;                                /* outlets that nothing has left yet */
    char error[200];                           /* why sorting_get failed, else "" */
} sorting;

/* Fills in *out; count outlets, >= 0. DEM_ERROR_ARGUMENT and a sentence in out->error: a null
   pointer, or an outlet that the world does not have. */
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
