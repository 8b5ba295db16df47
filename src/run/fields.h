/* ---------------------------------------------------------------------------------------------
   >>fields
   Fields: averages of grains and contacts on a grid (binning, or coarse graining [GOL10]). A sample
   adds a grain to the cell of its centre, and the stress of a contact to the cells along its branch
   vector. With coarse graining it spreads both over the cells nearby. In a periodic world every
   image inside the grid counts. This part owns w->fields and their sums; it reads bodies and
   contacts, and completes the half kick of velocities (demi_finish) before it samples grains.
   A field is one array of sums, block after block, so that checkpoints, copies and slabs treat it
   as plain numbers.
   --------------------------------------------------------------------------------------------- */
/* Blocks of a field's sums. The block of constant c begins at c x cells; within it, the numbers of
   one cell are adjacent (3 of momentum; 6 of flux and of stress: xx yy zz xy xz yz). The last
   constant is the number of reals per cell; without desc.stress only the first DEMI_FLUX exist.
   desc.variance adds twice as many: squares, and a copy of the first blocks. */
enum { DEMI_SOLID = 0, DEMI_MASS = 1, DEMI_MOMENTUM = 2, DEMI_GRAINS = 5, DEMI_FLUX = 6,
       DEMI_STRESS = 12, DEMI_CONTACTS = 18, DEMI_FIELD_REALS = 19 };
static size_t demi_field_cells(const demi_field *f) {
    return (size_t)f->desc.cells[0]*(size_t)f->desc.cells[1]*(size_t)f->desc.cells[2];
}
/* Returns where the squares of desc.variance begin in `sums`, and the length of `sums`. The blocks
   of squares are solid^2, mass^2, momentum^2/mass and grains^2 of each sample, summed. */
static size_t demi_field_squares(const demi_field *f) {
    return demi_field_cells(f)*(f->desc.stress ? DEMI_FIELD_REALS : DEMI_FLUX);
}
static size_t demi_field_reals(const demi_field *f) {
    return demi_field_squares(f) + (f->desc.variance ? 2*DEMI_FLUX*demi_field_cells(f) : 0);
}
/* The geometry of a field's grid, computed once per sample. */
typedef struct demi_grid {
    demi_field *field;
    double lo[3], size[3], period[3];   /* m; period 0: not periodic */
    /* m3, of a cell; m, radius beyond which Lucy's function of coarse graining is 0; 1/m3, factor
       of that function (planar: 1/m2, over the depth). Without coarse graining the last two are
       0. */
    double volume, reach, norm;
    int axes;                           /* along which it spreads: 3; planar: 2 */
} demi_grid;
/* Volume of a cell, m3; in planar worlds cells are as deep as the discs. */
static double demi_field_volume(const dem_world *w, const dem_box *box, const int cells[3]) {
    const double x = (double)(box->hi.x - box->lo.x)/cells[0];
    const double y = (double)(box->hi.y - box->lo.y)/cells[1];
    return x*y*(w->desc.planar ? (double)w->desc.thickness
                               : (double)(box->hi.z - box->lo.z)/cells[2]);
}
/* Computes the grid of field f. */
static demi_grid demi_grid_of(const dem_world *w, demi_field *f) {
    const demi_periods p = demi_periods_of(w);
    const dem_field_desc *d = &f->desc;
    demi_grid g;
    double c;
    int k;
    g.field = f;
    g.lo[0] = (double)d->box.lo.x; g.lo[1] = (double)d->box.lo.y; g.lo[2] = (double)d->box.lo.z;
    g.size[0] = ((double)d->box.hi.x - g.lo[0])/d->cells[0];
    g.size[1] = ((double)d->box.hi.y - g.lo[1])/d->cells[1];
    g.size[2] = ((double)d->box.hi.z - g.lo[2])/d->cells[2];
    g.volume = demi_field_volume(w, &d->box, d->cells);
    for (k = 0; k < 3; k++)        /* the world of a slab has no period along a ring of slabs */
        g.period[k] = (double)DEMI_MAX(p.period[k], w->ring_period[k]);
    g.axes = w->desc.planar ? 2 : 3;
    g.reach = c = 2*(double)d->width;
    g.norm = !(c > 0) ? 0 : g.axes == 2 ? 5/(DEMI_PI*c*c*(double)w->desc.thickness)
                                        : 105/(16*DEMI_PI*c*c*c);
    return g;
}
/* Adds n numbers, times weight, to the cell of indices `at` in a block that has n per cell. */
static void demi_cell_add(demi_grid *g, const int *at, int block, int n, const double *value,
                          double weight) {
    const int *cells = g->field->desc.cells;
    const size_t cell = (size_t)at[0] + (size_t)cells[0]*((size_t)at[1] +
                                                          (size_t)cells[1]*(size_t)at[2]);
    double *sum = g->field->sums + (size_t)block*demi_field_cells(g->field) + (size_t)n*cell;
    int k;
    for (k = 0; k < n; k++) sum[k] += weight*value[k];
}
/* Adds n numbers at point x (m): to its cell, or by Lucy's function to all cells whose centres are
   within `reach`, weighted by its value times the volume of a cell. Points outside the grid add
   nothing to it. */
static void demi_image_put(demi_grid *g, const double *x, int block, int n, const double *value) {
    const int *cells = g->field->desc.cells;
    int from[3], to[3], at[3], k;
    for (k = 0; k < 3; k++) {
        const double reach = k < g->axes ? g->reach : 0;
        const double a = floor((x[k] - reach - g->lo[k])/g->size[k]);
        const double b = floor((x[k] + reach - g->lo[k])/g->size[k]);
        if (!(b >= 0 && a < cells[k])) return;
        from[k] = (int)DEMI_MAX(a, 0);
        to[k] = (int)DEMI_MIN(b, cells[k] - 1);
    }
    if (!(g->reach > 0)) { demi_cell_add(g, from, block, n, value, 1); return; }
    for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
        for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
            for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {
                double rr = 0, u;
                for (k = 0; k < g->axes; k++) {
                    const double d = g->lo[k] + (at[k] + 0.5)*g->size[k] - x[k];
                    rr += d*d;
                }
                u = sqrt(rr)/g->reach;
                if (u < 1)
                    demi_cell_add(g, at, block, n, value,
                                  g->norm*g->volume*(1 + 3*u)*(1 - u)*(1 - u)*(1 - u));
            }
}
/* Adds n numbers at `place` (m) and at all its periodic images that reach the grid, at most 101
   along each axis. */
static void demi_grid_put(demi_grid *g, dem_vec3 place, int block, int n, const double *value) {
    const int *cells = g->field->desc.cells;
    double x[3], first[3], last[3], at[3];
    int k;
    x[0] = (double)place.x; x[1] = (double)place.y; x[2] = (double)place.z;
    for (k = 0; k < 3; k++) {
        const double hi = g->lo[k] + g->size[k]*cells[k], P = g->period[k];
        first[k] = last[k] = 0;
        if (!(P > 0)) continue;
        first[k] = ceil((g->lo[k] - g->reach - x[k])/P);
        last[k] = DEMI_MIN(floor((hi + g->reach - x[k])/P), first[k] + 100);
        /* if the field is as long as the period, its upper end is its lower end */
        if (!(g->reach > 0) && x[k] + last[k]*P >= hi) last[k]--;
    }
    for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                double image[3];
                for (k = 0; k < 3; k++) image[k] = x[k] + at[k]*g->period[k];
                demi_image_put(g, image, block, n, value);
            }
}
/* True if the field includes body i, by group, material and radius. */
static int demi_field_counts(const dem_world *w, const dem_field_desc *d, int i) {
    const dem_real r = demi_radius(w, i);
    return demi_in_group(w, d->group, i) &&
           (!d->material.id || w->bodies.material[i] == d->material.id) && r >= d->radius_min &&
           (!(d->radius_max > 0) || r <= d->radius_max);
}
/* Adds grain i: volume, mass, momentum and number; with desc.stress the flux m v v. */
static void demi_field_grain(const dem_world *w, demi_grid *g, int i) {
    const double m = (double)w->bodies.mass[i];
    const double v[3] = {(double)w->bodies.vel[4*i], (double)w->bodies.vel[4*i + 1],
                         (double)w->bodies.vel[4*i + 2]};
    double sum[DEMI_FLUX], flux[6];
    sum[DEMI_SOLID] = m/(double)w->materials[w->bodies.material[i] - 1].density/g->volume;
    sum[DEMI_MASS] = m;
    sum[2] = m*v[0];
    sum[3] = m*v[1];
    sum[4] = m*v[2];
    sum[DEMI_GRAINS] = 1;
    demi_grid_put(g, demi_at(w->bodies.pos + 4*i), DEMI_SOLID, 1, sum + DEMI_SOLID);
    demi_grid_put(g, demi_at(w->bodies.pos + 4*i), DEMI_MASS, 1, sum + DEMI_MASS);
    demi_grid_put(g, demi_at(w->bodies.pos + 4*i), DEMI_MOMENTUM, 3, sum + DEMI_MOMENTUM);
    demi_grid_put(g, demi_at(w->bodies.pos + 4*i), DEMI_GRAINS, 1, sum + DEMI_GRAINS);
    if (!g->field->desc.stress) return;
    flux[0] = m*v[0]*v[0]/g->volume; flux[1] = m*v[1]*v[1]/g->volume;
    flux[2] = m*v[2]*v[2]/g->volume; flux[3] = m*v[0]*v[1]/g->volume;
    flux[4] = m*v[0]*v[2]/g->volume; flux[5] = m*v[1]*v[2]/g->volume;
    demi_grid_put(g, demi_at(w->bodies.pos + 4*i), DEMI_FLUX, 6, flux);
}
/* Adds a contact: its stress, and 1 to the number of contacts of each grain if it counts. The
   stress is the symmetric part of force x (-branch) over the volume of a cell; it is divided
   equally among eight points of the branch. */
static void demi_field_branch(const dem_world *w, demi_grid *g, const demi_walk *c) {
    const int pieces = 8, a = c->a, b = c->b;
    const dem_vec3 force = c->info.force, branch = c->branch;
    const dem_field_desc *d = &g->field->desc;
    const double f[3] = {(double)force.x, (double)force.y, (double)force.z};
    const double l[3] = {-(double)branch.x, -(double)branch.y, -(double)branch.z};
    const int is_a = demi_field_counts(w, d, a), is_b = b >= 0 && demi_field_counts(w, d, b);
    const dem_vec3 from = demi_at(w->bodies.pos + 4*a);
    const double one = 1;
    double part[6];
    int k;
    part[0] = f[0]*l[0]; part[1] = f[1]*l[1]; part[2] = f[2]*l[2];
    part[3] = (f[0]*l[1] + f[1]*l[0])/2;
    part[4] = (f[0]*l[2] + f[2]*l[0])/2;
    part[5] = (f[1]*l[2] + f[2]*l[1])/2;
    for (k = 0; k < 6; k++) part[k] /= pieces*g->volume;
    for (k = 0; k < pieces; k++) {
        /* each of two grains accounts for the half of the branch on its side */
        if (b >= 0 && k < pieces/2 ? !is_a : b >= 0 ? !is_b : !is_a) continue;
        demi_grid_put(g, demi_add(from, demi_scale(branch, (dem_real)((k + 0.5)/pieces))),
                      DEMI_STRESS, 6, part);
    }
    if (is_a && c->counts) demi_grid_put(g, from, DEMI_CONTACTS, 1, &one);
    if (is_b && c->counts) demi_grid_put(g, demi_at(w->bodies.pos + 4*b), DEMI_CONTACTS, 1, &one);
}
/* Adds all contacts of the world. */
static void demi_field_contacts(const dem_world *w, demi_grid *g) {
    demi_walk c = demi_walk_begin();
    while (demi_walk_next(w, &c)) demi_field_branch(w, g, &c);
}
/* Before a sample: copies the sums of grains. After it: adds the squares of what the sample has
   added to them. Momentum^2 over mass weights the square of a cell's velocity by its mass, as the
   mean velocity does. */
static void demi_field_squares_begin(demi_field *f) {
    const size_t n = DEMI_FLUX*demi_field_cells(f);
    if (f->desc.variance) memcpy(f->sums + demi_field_squares(f) + n, f->sums, n*sizeof(double));
}
static DEMI_APART void demi_field_squares_add(demi_field *f) {      /* see demi_means_add */
    const size_t n = demi_field_cells(f);
    double *square = f->sums + demi_field_squares(f);
    const double *was = square + DEMI_FLUX*n;
    size_t k;
    for (k = 0; f->desc.variance && k < DEMI_FLUX*n; k++) {
        const int moves = k >= DEMI_MOMENTUM*n && k < DEMI_GRAINS*n;
        const size_t cell = DEMI_MASS*n + (k - DEMI_MOMENTUM*n)/3;
        const double x = f->sums[k] - was[k], m = moves ? f->sums[cell] - was[cell] : 1;
        if (m > 0) square[k] += x*x/m;
    }
}
/* Adds a sample to the averages of body i: means[0] counts samples; then come the means of
   velocity, spin and force, and for each the sum of squares about its mean (recursion of [WEL62],
   exact also for small variances about a large mean). Not inlined: gcc 12 stops with an internal
   error at -O2 -flto -march=native otherwise. */
static DEMI_APART void demi_means_add(const dem_world *w, int i) {
    const demi_bodies *b = &w->bodies;
    const dem_real *const from[3] = {b->vel + 4*i, b->spin + 4*i, b->force + 4*i};
    double *means = b->means + DEMI_MEANS*i;
    int k;
    means[0]++;
    for (k = 0; k < 9; k++) {
        const double x = (double)from[k/3][k%3], off = x - means[1 + k];
        means[1 + k] += off/means[0];
        means[10 + k] += off*(x - means[1 + k]);
    }
}
/* True if the field is due for a sample at the present time. */
static int demi_field_due(const dem_world *w, const demi_field *f) {
    return f->used && w->clock.time >= f->next - 1e-6*(double)w->clock.dt &&
        !(f->desc.end > 0 && w->clock.time > f->desc.end + 1e-6*(double)w->clock.dt);
}
/* The time of the sample after the present one: start plus a multiple of the interval, s. */
static double demi_field_next(const dem_world *w, const dem_field_desc *d) {
    const double now = w->clock.time + 1e-6*(double)w->clock.dt;
    return d->interval > 0 ? d->start + d->interval*(floor((now - d->start)/d->interval) + 1)
        : w->clock.time + 100*(double)w->clock.dt;
}
/* Samples all fields that are due. Contacts come first, while velocities are still the predicted
   ones: the present forces were computed from them, and slabs have exchanged them. demi_finish then
   completes the half kick, and grains are sampled with the velocities of the full step. */
static void demi_fields_sample(dem_world *w) {
    int f, i, any = 0;
    for (f = 0; f < w->field_count; f++) {
        demi_field *field = &w->fields[f];
        demi_grid g = demi_grid_of(w, field);
        if (demi_field_due(w, field)) any = 1;
        if (demi_field_due(w, field) && field->desc.stress) demi_field_contacts(w, &g);
    }
    if (any) demi_finish(w);
    for (f = 0; f < w->field_count; f++) {
        demi_field *field = &w->fields[f];
        const dem_field_desc *d = &field->desc;
        demi_grid g = demi_grid_of(w, field);
        if (!demi_field_due(w, field)) continue;
        field->next = demi_field_next(w, d);
        demi_field_squares_begin(field);
        for (i = 0; i < w->bodies.count; i++) {
            if (demi_is_ghost(w, i) || !demi_field_counts(w, d, i)) continue;
            demi_field_grain(w, &g, i);
            if (d->bodies) demi_means_add(w, i);
        }
        demi_field_squares_add(field);
        field->samples++;
    }
}

#define DEMI_FIELD_MOST 268435456.0
#define DEMI_FIELD(field, type, how, unit, other) \
    DEMI_LIMITED_IF(dem_field_desc, field, type, how, DBL_MAX, unit, 0, other, 0, 0)
static const demi_field_row demi_field_rows[] = {DEMI_ROW(dem_field_desc, box, 'v'),
    DEMI_LIMITED(dem_field_desc, cells, 'i', DEMI_OVER, DEMI_FIELD_MOST, ""),
    DEMI_FIELD(start, 'd', DEMI_FROM, "s", 0), DEMI_FIELD(end, 'd', DEMI_ANY, "s", 0),
    DEMI_FIELD(interval, 'd', DEMI_FROM, "s", 0), DEMI_ROW(dem_field_desc, material, 'i'),
    DEMI_FIELD(radius_min, 'r', DEMI_FROM, "m", 0), DEMI_FIELD(radius_max, 'r', DEMI_FROM, "m", 1),
    DEMI_ROW(dem_field_desc, stress, 'i'), DEMI_FIELD(width, 'r', DEMI_FROM, "m", 0),
    DEMI_ROW(dem_field_desc, group, 'i'), DEMI_ROW(dem_field_desc, variance, 'i'),
    DEMI_ROW(dem_field_desc, bodies, 'i'), DEMI_ROW_END};
DEM_API dem_field dem_field_add(dem_world *w, const dem_field_desc *d) {
    if (demi_null(w, __func__, d, "desc")) return demi_no_field;
    dem_field id;
    demi_field field;
    int k;
    id.id = 0;
    if (demi_rows_check(w, __func__, demi_field_rows, d, "",
                        "start from DEM_FIELD_DESC and set only what differs") ||
        (demi_cell_slides(w) && demi_cell_bars(w, __func__, DEMI_CELL_FIELDS))) return id;
    if ((double)d->cells[0]*d->cells[1]*d->cells[2] > DEMI_FIELD_MOST) {
        demi_refuse(w, __func__, "cells are %d x %d x %d, must be at most 2^28 in all; "
                    "choose longer cells", d->cells[0], d->cells[1], d->cells[2]);
        return id;
    }
    if (demi_box_empty(w, __func__, d->box, 0)) return id;
    if (w->desc.planar && (d->box.lo.z > 0 || d->box.hi.z < 0)) {
        demi_refuse(w, __func__, "box is from z = %g to %g m, must contain 0, where all bodies of "
                    "a planar world are", (double)d->box.lo.z, (double)d->box.hi.z);
        return id;
    }
    if (demi_group_check(w, __func__, d->group, 0) != DEM_OK ||
        (d->material.id && demi_material_index(w, __func__, d->material, &k) != DEM_OK))
        return id;
    for (k = 0; k < w->field_count && d->bodies; k++)
        if (w->fields[k].desc.bodies) {
            demi_refuse(w, __func__, "bodies is %d, but field %d averages bodies already, "
                        "and each body has room for one average; set bodies to 0, or use that "
                        "field", d->bodies, k + 1);
            return id;
        }
    memset(&field, 0, sizeof field);
    field.used = 1;
    field.desc = *d;
    field.next = d->start;
    field.sums = (double *)demi_hold(w, DEMI_RUN, demi_field_reals(&field), sizeof(double));
    if (!field.sums || !DEMI_GROW(w, w->fields, (size_t)w->field_count + 1) ||
        (d->bodies && !demi_array_begin(w, DEMI_AVERAGED, &w->bodies.averaged))) {
        demi_free(w, field.sums);
        demi_no_memory(w, __func__);
        return id;
    }
    w->fields[w->field_count++] = field;
    demi_built(w, __func__);
    id.id = w->field_count;
    return id;
}
/* Returns the field of an id, or null with an error message in the name of `call`. */
static demi_field *demi_field_find(dem_world *w, const char *call, dem_field id) {
    if (id.id >= 1 && id.id <= w->field_count) return &w->fields[id.id - 1];
    demi_refuse(w, call, "field %d does not exist, there are %d; check the id that dem_field_add "
                "returned", (int)id.id, w->field_count);
    return 0;
}
DEM_API dem_result dem_field_get(const dem_world *w, dem_field id, dem_field_data *data) {
    if (demi_null_look(w, __func__, data, "data")) return DEM_ERROR_ARGUMENT;
    size_t n;
    const demi_field *f = demi_field_find((dem_world *)w, __func__, id);
    if (!f) return DEM_ERROR_ARGUMENT;
    memcpy(data->cells, f->desc.cells, sizeof data->cells);
    data->box = f->desc.box;
    data->samples = f->samples;
    n = demi_field_cells(f);
    data->solid = f->sums + DEMI_SOLID*n;
    data->mass = f->sums + DEMI_MASS*n;
    data->momentum = f->sums + DEMI_MOMENTUM*n;
    data->grains = f->sums + DEMI_GRAINS*n;
    data->flux = f->desc.stress ? f->sums + DEMI_FLUX*n : 0;
    data->stress = f->desc.stress ? f->sums + DEMI_STRESS*n : 0;
    data->contacts = f->desc.stress ? f->sums + DEMI_CONTACTS*n : 0;
    return DEM_OK;
}
DEM_API dem_result dem_field_reset(dem_world *w, dem_field id) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    demi_field *f = demi_field_find(w, __func__, id);
    if (!f) return DEM_ERROR_ARGUMENT;
    memset(f->sums, 0, demi_field_reals(f)*sizeof(double));
    if (f->desc.bodies && w->bodies.count)
        memset(w->bodies.means, 0, DEMI_MEANS*(size_t)w->bodies.count*sizeof(double));
    f->samples = 0;
    return DEM_OK;
}
DEM_API dem_result dem_body_means_get(const dem_world *w, dem_body body, dem_body_means *out) {
    int i, k;
    if (demi_null_look(w, __func__, out, "means")) return DEM_ERROR_ARGUMENT;
    if (!w->bodies.averaged)
        return demi_refuse(w, __func__, "no field averages bodies; add one with bodies "
                           "= 1 (dem_field_desc)");
    i = demi_body_index((dem_world *)w, __func__, body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    out->samples = (uint64_t)w->bodies.means[DEMI_MEANS*i];
    for (k = 0; k < 9 && out->samples; k++) {
        double *const mean[3] = {out->velocity, out->spin, out->force};
        double *const variance[3] = {out->velocity_variance, out->spin_variance,
                                     out->force_variance};
        mean[k/3][k%3] = w->bodies.means[DEMI_MEANS*i + 1 + k];
        variance[k/3][k%3] = w->bodies.means[DEMI_MEANS*i + 10 + k]/(double)out->samples;
    }
    return DEM_OK;
}

/* Computes the variances over n samples of cell c, of this volume (m3), from the means in `out`. */
static void demi_cell_variances(const demi_field *f, size_t c, double n, double volume,
                                dem_field_cell *out) {
    const size_t cells = demi_field_cells(f);
    const double *square = f->sums + demi_field_squares(f);
    const double mass = f->sums[DEMI_MASS*cells + c];
    int e;
    if (!f->desc.variance) return;
    out->solid_variance = DEMI_MAX(square[DEMI_SOLID*cells + c]/n - out->solid*out->solid, 0);
    out->density_variance = DEMI_MAX(square[DEMI_MASS*cells + c]/(n*volume*volume) -
                                     out->density*out->density, 0);
    out->grains_variance = DEMI_MAX(square[DEMI_GRAINS*cells + c]/n - out->grains*out->grains, 0);
    for (e = 0; e < 3 && mass > 0; e++)
        out->velocity_variance[e] = DEMI_MAX(square[DEMI_MOMENTUM*cells + 3*c + (size_t)e]/mass -
                                             out->velocity[e]*out->velocity[e], 0);
}
/* Fluctuations about the mean velocity v of the cell give the kinetic stress, <m v v>/volume -
   density v v, which is added to the stress of contacts. The granular temperature is the trace of
   the kinetic stress over density and number of dimensions. */
DEM_API dem_result dem_field_cell_get(const dem_world *w, dem_field id, int i, int j, int k,
                                      dem_field_cell *out) {
    dem_field_data d;
    size_t c;
    double n, volume, v[3];
    int e;
    if (demi_null_look(w, __func__, out, "cell")) return DEM_ERROR_ARGUMENT;
    if (!demi_field_find((dem_world *)w, __func__, id)) return DEM_ERROR_ARGUMENT;
    dem_field_get(w, id, &d);
    if (i < 0 || j < 0 || k < 0 || i >= d.cells[0] || j >= d.cells[1] || k >= d.cells[2])
        return demi_refuse(w, __func__, "cell (%d, %d, %d) does not exist, the field "
                           "has %d x %d x %d cells; indices start at 0", i, j, k, d.cells[0],
                           d.cells[1], d.cells[2]);
    memset(out, 0, sizeof *out);
    if (!d.samples) return DEM_OK;
    c = (size_t)i + (size_t)d.cells[0]*((size_t)j + (size_t)d.cells[1]*(size_t)k);
    n = (double)d.samples;
    volume = demi_field_volume(w, &d.box, d.cells);
    out->grains = d.grains[c]/n;
    out->solid = d.solid[c]/n;
    out->density = d.mass[c]/n/volume;
    for (e = 0; e < 3; e++)
        out->velocity[e] = v[e] = d.mass[c] > 0 ? d.momentum[3*c + (size_t)e]/d.mass[c] : 0;
    demi_cell_variances(&w->fields[id.id - 1], c, n, volume, out);
    if (!d.stress) return DEM_OK;
    for (e = 0; e < 6; e++) {
        const double vv = e < 3 ? v[e]*v[e] : e == 3 ? v[0]*v[1] : e == 4 ? v[0]*v[2] : v[1]*v[2];
        const double moves = d.flux[6*c + (size_t)e]/n - out->density*vv;
        out->stress[e] = d.stress[6*c + (size_t)e]/n + moves;
        if (e < 3 && out->density > 0) out->temperature += moves/out->density/
            (w->desc.planar ? 2 : 3);
    }
    out->coordination = d.grains[c] > 0 ? d.contacts[c]/d.grains[c] : 0;
    return DEM_OK;
}
/* Sampling in a step, see >>features. */
static int demi_fields_on(const dem_world *h) { return demi_member(h, 0)->field_count > 0; }
static dem_result demi_member_sample(dem_world *w) { demi_fields_sample(w); return DEM_OK; }
static dem_result demi_fields_ended(dem_world *h) { return demi_all(h, demi_member_sample); }
/* Sums of fields in a checkpoint. */
static void demi_fields_visit(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &w->fields[i];
        demi_visit(s, &f->samples, sizeof f->samples);
        demi_visit(s, &f->next, sizeof f->next);
        demi_visit(s, f->sums, demi_field_reals(f)*sizeof(double));
    }
}
static int demi_fields_check(const demi_reader *r) {
    int i;
    for (i = 0; i < r->t->field_count; i++)
        if (!demi_finite_double(r->t->fields[i].next))
            return demi_lie(r, "next sampling time of field", i);
    return 1;
}
static dem_result demi_fields_whole(dem_world *w, const char *call) {
    int i;
    for (i = 0; i < w->field_count; i++)
        if (w->fields[i].desc.variance)
            return demi_refuse(w, call, "field %d has variance %d, must be 0, because a cell may "
                               "lie in two slabs, and neither knows the squares of the whole; "
                               "leave variance out, or use threads", i + 1,
                               w->fields[i].desc.variance);
    return DEM_OK;
}
/* Each slab sums the contributions of its own grains. The first one starts with the sums of the
   world, the others start at 0. */
static int demi_fields_share(dem_world *slab, const dem_world *from, int first) {
    int i;
    for (i = 0; i < from->field_count; i++) {
        const demi_field *a = &from->fields[i];
        if (dem_field_add(slab, &a->desc).id != i + 1) return 0;
        slab->fields[i].next = a->next;
        slab->fields[i].samples = a->samples;
        if (first) memcpy(slab->fields[i].sums, a->sums, demi_field_reals(a)*sizeof(double));
    }
    return 1;
}
