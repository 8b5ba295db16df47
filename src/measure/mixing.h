/* ---------------------------------------------------------------------------------------------
   >>mixing
   Mixing and segregation of two components. All indices compare the present places of the grains
   with those that a random exchange of all grains would give. Reads bodies and contacts, and
   changes nothing. Memory is allocated and freed within the call.

   Lacey's index [LAC54] uses cells. p: fraction of the component among the N grains; n_i, phi_i:
   number of grains and fraction in cell i; K: number of cells with grains.
       s2 = sum n_i (phi_i - p)^2/N,  s0 = p (1 - p),  sr = p (1 - p) (K - 1)/(N - 1)
       M  = (s0 - s2)/(s0 - sr): 0 segregated, 1 random
   s0 is s2 of cells that hold one component each. sr is the mean of s2 over all ways to deal the
   grains to the places. We differ from the source in two ways. Cells need not have equal numbers of
   grains, so that n_i weights them. sr is exact for finite K and N; for large ones it is p (1 -
   p)/n with n = N/K, as in the source. Limits: the index depends on the size of the cells, and
   components count by number, not by volume.

   The rank measure [MW47] needs no cells. U counts the pairs of a grain of the component and
   another grain in which the former is ahead (a tie counts 1/2); S = 2 U/(Na Nb) - 1. It is 1 if
   all grains of the component are ahead of all others, -1 if they are behind, and 0 on average over
   random mixtures, with the variance (N + 1)/(3 Na Nb).

   The contact measure compares the number of contacts between the two components with its mean over
   all ways to deal the grains to the places, 2 Na Nb/(N (N - 1)) of all contacts.
   --------------------------------------------------------------------------------------------- */
/* A grain and its coordinate; mine: 1 if it is of the component. */
typedef struct demi_mix_key { double x; int mine; } demi_mix_key;
static int demi_mix_compare(const void *a, const void *b) {
    const double x = ((const demi_mix_key *)a)->x, y = ((const demi_mix_key *)b)->x;
    return (x > y) - (x < y);
}
/* Returns the rank measure of n grains, of which `part` are of the component. Sorts `key`. */
static double demi_mix_rank(demi_mix_key *key, int n, int part) {
    const double pairs = (double)part*(n - part);
    double ahead = 0, below = 0;                /* below: other grains with a smaller coordinate */
    int i, k;
    qsort(key, (size_t)n, sizeof *key, demi_mix_compare);
    for (i = 0; i < n; i = k) {
        int mine = 0;
        for (k = i; k < n && !(key[k].x > key[i].x); k++) mine += key[k].mine;
        ahead += mine*(below + (k - i - mine)/2.0);
        below += k - i - mine;
    }
    return pairs > 0 ? 2*ahead/pairs - 1 : (double)NAN;
}
/* Returns the cell of body i; -1 if it does not count: outside the box, fixed, or a ghost
   particle. */
static int demi_mix_cell(const dem_world *w, const demi_periods *p, const dem_mixing_desc *d,
                         int i) {
    const dem_vec3 at = demi_place_of(p, demi_at(w->bodies.pos + 4*i));
    const double x[3] = {(double)at.x, (double)at.y, (double)at.z};
    const double lo[3] = {(double)d->box.lo.x, (double)d->box.lo.y, (double)d->box.lo.z};
    const double hi[3] = {(double)d->box.hi.x, (double)d->box.hi.y, (double)d->box.hi.z};
    int k, cell = 0;
    if (demi_is_ghost(w, i) || !(w->bodies.inv_mass[i] > 0)) return -1;
    for (k = 2; k >= 0; k--) {
        const double q = hi[k] > lo[k] ? (x[k] - lo[k])/(hi[k] - lo[k])*d->cells[k] : 0;
        if (!(x[k] >= lo[k] && x[k] <= hi[k])) return -1;
        cell = cell*d->cells[k] + (int)DEMI_MIN(q, d->cells[k] - 1);
    }
    return cell;
}
/* True if body i is of the component. */
static int demi_mix_mine(const dem_world *w, const dem_mixing_desc *d, int i) {
    const dem_real r = demi_radius(w, i);
    return (!d->material.id || w->bodies.material[i] == d->material.id) && r >= d->radius_min &&
        (!(d->radius_max > 0) || r <= d->radius_max);
}
/* Computes Lacey's index from the numbers of grains per cell: all, and those of the component. */
static void demi_mix_cells(const int32_t *all, const int32_t *mine, int cells, dem_mixing *out) {
    const double n = out->grains, p = out->fraction;
    double sum = 0, seg, rnd;
    int i;
    for (i = 0; i < cells; i++) {
        const double off = all[i] ? (double)mine[i]/all[i] - p : 0;
        out->cells += all[i] > 0;
        sum += all[i]*off*off;
    }
    if (!out->grains) return;
    out->variance = sum/n;
    seg = out->variance_segregated = p*(1 - p);
    rnd = out->variance_random = n > 1 ? seg*(out->cells - 1)/(n - 1) : seg;
    if (!(rnd < seg) || out->cells < 2) return;
    out->lacey = (seg - out->variance)/(seg - rnd);
    out->kramer = (sqrt(seg) - sqrt(out->variance))/(sqrt(seg) - sqrt(rnd));
}
/* Counts the contacts of grains in the box, and compares those between the components with random
   ones. kind: by body, 1: of the component, 0: another, -1: not counted. */
static void demi_mix_contacts(const dem_world *w, const signed char *kind, dem_mixing *out) {
    const double n = out->grains, even = 2.0*out->part*(n - out->part)/(n*(n - 1));
    demi_walk c = demi_walk_begin();
    double unlike = 0;
    out->contacts = demi_contacts_known(w) ? 0 : -1;
    while (out->contacts >= 0 && demi_walk_next(w, &c)) {
        if (!c.counts || c.b < 0 || kind[c.a] < 0 || kind[c.b] < 0) continue;
        out->contacts++;
        unlike += kind[c.a] != kind[c.b];
    }
    if (out->contacts > 0 && even > 0)
        out->contact_segregation = 1 - unlike/out->contacts/even;
}
/* Computes the rank measures along x, y and z, and of the distance from the axis. */
static void demi_mix_ranks(const dem_world *w, const demi_periods *p, const dem_mixing_desc *d,
                           const signed char *kind, demi_mix_key *key, dem_mixing *out) {
    const dem_vec3 axis = demi_unit(d->axis);
    int i, k;
    for (k = 0; k < (demi_dot(d->axis, d->axis) > 0 ? 4 : 3); k++) {
        int n = 0;
        for (i = 0; i < w->bodies.count; i++) {
            const dem_vec3 x = demi_place_of(p, demi_at(w->bodies.pos + 4*i));
            const dem_vec3 away = demi_cross(axis, demi_sub(x, d->centre));
            if (kind[i] < 0) continue;
            key[n].x = (double)(k == 0 ? x.x : k == 1 ? x.y : k == 2 ? x.z : demi_length(away));
            key[n++].mine = kind[i];
        }
        *(k < 3 ? out->segregation + k : &out->segregation_radial) =
            demi_mix_rank(key, n, out->part);
    }
}

#define DEMI_MIX(field, type, how, unit, other) \
    DEMI_LIMITED_IF(dem_mixing_desc, field, type, how, DBL_MAX, unit, 0, other, 0, 0)
static const demi_field_row demi_mixing_rows[] = {DEMI_ROW(dem_mixing_desc, box, 'v'),
    DEMI_LIMITED(dem_mixing_desc, cells, 'i', DEMI_OVER, DEMI_FIELD_MOST, ""),
    DEMI_ROW(dem_mixing_desc, material, 'i'), DEMI_MIX(radius_min, 'r', DEMI_FROM, "m", 0),
    DEMI_MIX(radius_max, 'r', DEMI_FROM, "m", 1), DEMI_MIX(centre, 'v', DEMI_ANY, "m", 0),
    DEMI_MIX(axis, 'v', DEMI_ANY, "", 0), DEMI_ROW_END};
/* Returns DEM_OK if a mixing desc is possible, otherwise fails in the name of `call`. */
static dem_result demi_mixing_check(dem_world *w, const char *call, const dem_mixing_desc *d) {
    int k;
    if (demi_rows_check(w, call, demi_mixing_rows, d, "",
                        "start from DEM_MIXING_DESC and set only what differs") ||
        demi_box_empty(w, call, d->box, w->desc.planar) ||
        (d->material.id && demi_material_index(w, call, d->material, &k) != DEM_OK))
        return DEM_ERROR_ARGUMENT;
    if ((double)d->cells[0]*d->cells[1]*d->cells[2] > DEMI_FIELD_MOST)
        return demi_refuse(w, call, "cells are %d x %d x %d, must be at most 2^28 in all; choose "
                           "longer cells", d->cells[0], d->cells[1], d->cells[2]);
    if (d->material.id || d->radius_min > 0 || d->radius_max > 0) return DEM_OK;
    return demi_refuse(w, call, "material, radius_min and radius_max are all 0, so that every "
                       "grain is of the component; give the material or the radii of one of the "
                       "two");
}
DEM_API dem_result dem_mixing_get(const dem_world *world, const dem_mixing_desc *d,
                                  dem_mixing *out) {
    dem_world *w = (dem_world *)world;
    demi_periods p;
    demi_mix_key *key;
    signed char *kind;
    int32_t *count;
    int i, cells;
    if (demi_null_look(w, __func__, d, "desc") || demi_null_look(w, __func__, out, "mixing") ||
        demi_mixing_check(w, __func__, d) != DEM_OK) return DEM_ERROR_ARGUMENT;
    p = demi_periods_of(w);
    cells = d->cells[0]*d->cells[1]*d->cells[2];
    key = (demi_mix_key *)demi_alloc(w, (size_t)w->bodies.count + 1, sizeof *key);
    kind = (signed char *)demi_alloc(w, (size_t)w->bodies.count + 1, 1);
    count = (int32_t *)demi_alloc(w, 2*(size_t)cells, sizeof *count);
    memset(out, 0, sizeof *out);
    out->fraction = out->lacey = out->kramer = out->segregation_radial = (double)NAN;
    out->contact_segregation = (double)NAN;
    for (i = 0; i < w->bodies.count && key && kind && count; i++) {
        const int cell = demi_mix_cell(w, &p, d, i);
        kind[i] = (signed char)(cell < 0 ? -1 : demi_mix_mine(w, d, i));
        if (cell < 0) continue;
        out->grains++;
        out->part += kind[i];
        count[cell]++;
        count[cells + cell] += kind[i];
    }
    if (key && kind && count) {
        if (out->grains) out->fraction = (double)out->part/out->grains;
        demi_mix_cells(count, count + cells, cells, out);
        demi_mix_ranks(w, &p, d, kind, key, out);
        demi_mix_contacts(w, kind, out);
    }
    i = key && kind && count;
    demi_free(w, key);
    demi_free(w, kind);
    demi_free(w, count);
    return i ? DEM_OK : demi_no_memory(w, __func__);
}
