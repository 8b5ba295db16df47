/* ---------------------------------------------------------------------------------------------
   >>sizes
   Size distributions. Each kind is a cumulative distribution, the fraction finer than a radius. It
   is truncated and rescaled to rise from 0 below min to 1 at max. A table of the cumulative number
   distribution at radii of equal ratio serves to draw radii and to form classes. Fractions by mass
   become fractions by number with the mass of a grain, proportional to r^3 (planar worlds: r^2).
   Tests: tests/scene/test_sizes.c.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_SIZE_STEPS = 2048 };
/* Cumulative number distribution at radii of equal ratio. */
typedef struct demi_size_table {
    double at[DEMI_SIZE_STEPS + 1];      /* radii, m, from the smallest to the largest */
    double number[DEMI_SIZE_STEPS + 1];  /* fraction of the number up to there; the last is 1 */
} demi_size_table;
/* Error function: 2/sqrt(pi) x exp(-x^2) sum over n of (2 x^2)^n/(1 3 5 ... (2n + 1)). All terms
   have the same sign, so there is no cancellation. */
static double demi_erf(double x) {
    double term = x, sum = x;
    int n;
    if (fabs(x) > 6) return x < 0 ? -1 : 1;
    for (n = 1; n < 300 && fabs(term) > 1e-17*fabs(sum); n++) {
        term *= 2*x*x/(2*n + 1);
        sum += term;
    }
    return 2/sqrt(DEMI_PI)*demi_exp(-x*x)*sum;
}
/* Fraction finer than r (m) before truncation to min and max. For the uniform distribution r
   itself, which demi_size_finer rescales. */
static double demi_size_share(const dem_sizes *d, double r) {
    int k;
    switch (d->kind) {
    case DEM_SIZES_UNIFORM: break;
    case DEM_SIZES_LOGNORMAL:
        return r > 0 ? (1 + demi_erf(demi_log(r/(double)d->median)/(sqrt(2.0)*d->spread)))/2 : 0;
    case DEM_SIZES_NORMAL:
        return (1 + demi_erf((r - (double)d->median)/(sqrt(2.0)*(double)d->deviation)))/2;
    case DEM_SIZES_EXPONENTIAL:
        return r > (double)d->min
            ? 1 - demi_exp(-(r - (double)d->min)/((double)d->scale - (double)d->min)) : 0;
    case DEM_SIZES_WEIBULL:
        return r > 0 ? 1 - demi_exp(-demi_pow(r/(double)d->scale, d->modulus)) : 0;
    case DEM_SIZES_SIEVE_CURVE:
        if (r < (double)d->radius[0]) return 0;
        for (k = 1; k < d->count; k++) {
            const double a = (double)d->radius[k - 1], b = (double)d->radius[k];
            const double more = d->passing[k] - d->passing[k - 1];
            if (r < b) return d->passing[k - 1] + more*(r - a)/(b - a);
        }
        return 1;
    }
    return r;                                   /* uniform */
}
/* Checks a distribution. `why` receives the reason if it is invalid; else it becomes "" and *lo and
   *hi receive the smallest and largest radius, m. */
static void demi_size_why(const dem_sizes *d, double *lo, double *hi, char *why, size_t room) {
    const double median = (double)d->median, scale = (double)d->scale;
    const double last = d->passing[DEMI_MIN(DEMI_MAX(d->count, 1), DEM_SIEVES) - 1];
    int k;
    *why = 0;
    *lo = (double)d->min;
    *hi = (double)d->max;
#define DEMI_SIZE_NEEDS(good, text, value) \
    if (!*why && !(good)) demi_words(why, room, text, value)
    DEMI_SIZE_NEEDS((int)d->kind >= 0 && d->kind <= DEM_SIZES_EXPONENTIAL, "kind is %d, must be "
                    "one of the enum values", (int)d->kind);
    DEMI_SIZE_NEEDS(demi_finite(d->min) && *lo >= 0, "min is %g m, must be finite and >= 0", *lo);
    DEMI_SIZE_NEEDS(demi_finite(d->max) && *hi >= 0, "max is %g m, must be finite and >= 0", *hi);
    if (d->kind == DEM_SIZES_LOGNORMAL || d->kind == DEM_SIZES_NORMAL)
        DEMI_SIZE_NEEDS(median > 0 && demi_finite(d->median), "median is %g m, must be > 0",
                        median);
    if (d->kind == DEM_SIZES_LOGNORMAL) {
        DEMI_SIZE_NEEDS(d->spread > 0 && d->spread < 10, "spread is %g, must be > 0 and < 10: it "
                        "is the standard deviation of ln(radius)", d->spread);
        if (!*why && !(*lo > 0)) *lo = DEMI_MAX(median*demi_exp(-6*d->spread), DEMI_FINEST);
        if (!*why && !(*hi > 0)) *hi = median*demi_exp(6*d->spread);
    }
    if (d->kind == DEM_SIZES_NORMAL) {
        const double far = 6*(double)d->deviation;
        DEMI_SIZE_NEEDS(far > 0 && demi_finite(d->deviation), "deviation is %g m, must be > 0",
                        far/6);
        if (!*why && !(*lo > 0)) *lo = DEMI_MAX(median - far, median/1000);
        if (!*why && !(*hi > 0)) *hi = median + far;
    }
    if (d->kind == DEM_SIZES_EXPONENTIAL) {
        DEMI_SIZE_NEEDS(scale > *lo && demi_finite(d->scale), "scale is %g m, must be above min",
                        scale);
        if (!*why && !(*hi > 0)) *hi = *lo + (scale - *lo)*-demi_log(1e-9);
    }
    if (d->kind == DEM_SIZES_WEIBULL) {
        DEMI_SIZE_NEEDS(scale > 0 && demi_finite(d->scale), "scale is %g m, must be > 0", scale);
        DEMI_SIZE_NEEDS(d->modulus > 0.05 && d->modulus < 1e3, "modulus is %g, must be > 0.05 and "
                        "< 1000", d->modulus);
        if (!*why && !(*hi > 0)) *hi = scale*demi_pow(-demi_log(1e-9), 1/d->modulus);
    }
    if (d->kind == DEM_SIZES_SIEVE_CURVE) {
        DEMI_SIZE_NEEDS(d->count >= 2 && d->count <= DEM_SIEVES, "count is %d sieves, must be 2 to "
                        "32", d->count);
        DEMI_SIZE_NEEDS(fabs(last - 1) < 1e-9, "the last entry of passing is %g, must be 1 (not "
                        "100 per cent): divide all entries by it", last);
        for (k = 0; k < d->count && !*why; k++) {
            DEMI_SIZE_NEEDS(demi_finite(d->radius[k]) && d->radius[k] > (k ? d->radius[k - 1] : 0),
                            "radius[%d] must be > 0, finite and above the one before", k);
            DEMI_SIZE_NEEDS(d->passing[k] >= (k ? d->passing[k - 1] : 0),
                            "passing[%d] must be >= 0 and at least the one before", k);
        }
        if (!*why && !(*lo > 0)) *lo = (double)d->radius[0];
        if (!*why && !(*hi > 0)) *hi = (double)d->radius[d->count - 1];
    }
    DEMI_SIZE_NEEDS(*lo >= DEMI_FINEST, "the least radius is %g m, must be 0 < min <= max and at "
                    "least 1e-15 m", *lo);
    DEMI_SIZE_NEEDS(*hi >= *lo && *hi < DEMI_FARTHEST, "the largest radius is %g m, must be at "
                    "least min and below 1e15 m", *hi);
    DEMI_SIZE_NEEDS(!(*hi > *lo) || d->kind == DEM_SIZES_UNIFORM ||
                    demi_size_share(d, *hi) > demi_size_share(d, *lo), "the distribution has no "
                    "grains between min and max (%g m); change min or max", *hi);
#undef DEMI_SIZE_NEEDS
}
/* Sets *lo and *hi to the smallest and largest radius, m. Returns 0 and fails in the name of `call`
   if the distribution is invalid. */
static int demi_size_ends(dem_world *w, const char *call, const dem_sizes *d, double *lo,
                          double *hi) {
    static const char *const names[] = {"uniform", "log-normal", "Weibull", "sieves", "normal",
                                        "exponential"};
    const int kind = (int)d->kind;
    char why[160];
    demi_size_why(d, lo, hi, why, sizeof why);
    if (!*why) return 1;
    demi_refuse(w, call, "sizes, %s: %s; start from DEM_SIZES and set what this kind needs",
                kind >= 0 && kind < 6 ? names[kind] : "unknown", why);
    return 0;
}
/* Fraction finer than r of the distribution truncated to lo .. hi. */
static double demi_size_finer(const dem_sizes *d, double lo, double hi, double r) {
    /* grains that pass the first sieve count as of its size: a step of the distribution */
    const int step = d->kind == DEM_SIZES_SIEVE_CURVE && lo <= (double)d->radius[0];
    const double below = step ? 0 : demi_size_share(d, lo);
    if (r < lo) return 0;
    if (r >= hi) return 1;
    return (demi_size_share(d, r) - below)/(demi_size_share(d, hi) - below);
}
/* Mass of a grain, up to a factor. */
static double demi_size_mass(const dem_world *w, double r) { return w->desc.planar ? r*r : r*r*r; }
/* Fills the table of the cumulative number distribution. */
static void demi_size_table_make(const dem_world *w, const dem_sizes *d, double lo, double hi,
                                 demi_size_table *t) {
    const int n = DEMI_SIZE_STEPS;
    const double ratio = demi_log(hi/lo)/n;
    double share = demi_size_finer(d, lo, hi, lo);    /* all of the smallest size */
    int k;
    t->at[0] = lo;
    t->number[0] = d->by_count ? share : share/demi_size_mass(w, lo);
    for (k = 1; k <= n; k++) {
        const double b = t->at[k] = k < n ? lo*demi_exp(k*ratio) : hi, a = t->at[k - 1];
        const double more = DEMI_MAX(demi_size_finer(d, lo, hi, b) - share, 0);    /* rounding */
        share += more;
        t->number[k] = t->number[k - 1] + (d->by_count ? more : more/demi_size_mass(w, (a + b)/2));
    }
    for (k = 0; k <= n; k++) t->number[k] /= t->number[n] > 0 ? t->number[n] : 1;
    t->number[n] = 1;
}
/* Returns the radius, m, below which this fraction of the number lies. */
static double demi_size_draw(const demi_size_table *t, double share) {
    int lo = 0, hi = DEMI_SIZE_STEPS;
    if (share < t->number[0]) return t->at[0];
    while (hi - lo > 1) {
        const int mid = (lo + hi)/2;
        if (t->number[mid] <= share) lo = mid;
        else hi = mid;
    }
    return t->at[lo] + (t->at[hi] - t->at[lo])*(share - t->number[lo])/
        DEMI_MAX(t->number[hi] - t->number[lo], 1e-300);
}
DEM_API double dem_sizes_finer_get(dem_world *w, const dem_sizes *d, dem_real radius) {
    double lo, hi;
    if (demi_null_look(w, __func__, d, "sizes")) return -1;
    if (!demi_size_ends(w, __func__, d, &lo, &hi)) return -1;
    return demi_size_finer(d, lo, hi, (double)radius);
}
/* As dem_sizes_draw, with error messages in the name of `call`. */
static dem_result demi_sizes_draw(dem_world *w, const char *call, const dem_sizes *d, int count,
                                  uint64_t seed, dem_real *radii) {
    demi_size_table *t;
    double lo, hi;
    int i;
    if (count < 0) return demi_refuse(w, call, "count is %d, must be >= 0", count);
    if (!demi_size_ends(w, call, d, &lo, &hi)) return DEM_ERROR_ARGUMENT;
    t = (demi_size_table *)demi_alloc(w, 1, sizeof *t);
    if (!t) return demi_no_memory(w, call);
    demi_size_table_make(w, d, lo, hi, t);
    for (i = 0; i < count; i++)
        radii[i] = (dem_real)demi_size_draw(t, seed ? demi_uniform(&seed) : (i + 0.5)/count);
    demi_free(w, t);
    return DEM_OK;
}
DEM_API dem_result dem_sizes_draw(dem_world *w, const dem_sizes *d, int count, uint64_t seed,
                                  dem_real *radii) {
    if (demi_null_look(w, __func__, d, "sizes")) return DEM_ERROR_ARGUMENT;
    if (demi_null_look(w, __func__, radii, "radii")) return DEM_ERROR_ARGUMENT;
    return demi_sizes_draw(w, __func__, d, count, seed, radii);
}
DEM_API int dem_sizes_classes_get(dem_world *w, const dem_sizes *d, int class_count,
                                  dem_real *radius,
                              double *amount) {
    demi_size_table *t;
    double lo, hi, all = 0;
    int i, k = 0, n = 0;
    if (demi_null_look(w, __func__, d, "sizes") || demi_null_look(w, __func__, radius, "radius") ||
        demi_null_look(w, __func__, amount, "amount")) return 0;
    if (class_count < 1 || class_count > DEM_CLASSES) {
        demi_refuse(w, __func__, "class_count is %d, must be 1 to %d", class_count,
                    (int)DEM_CLASSES);
        return 0;
    }
    if (!demi_size_ends(w, __func__, d, &lo, &hi)) return 0;
    t = (demi_size_table *)demi_alloc(w, 1, sizeof *t);
    if (!t) { demi_no_memory(w, __func__); return 0; }
    demi_size_table_make(w, d, lo, hi, t);
    for (i = 0; i < class_count; i++) {
        const double end = i + 1 < class_count ? lo*demi_pow(hi/lo, (i + 1.0)/class_count) : 2*hi;
        double number = 0, mass = 0, share;
        for (; k <= DEMI_SIZE_STEPS && t->at[k] < end*(1 + 1e-9); k++) {
            const double one = k ? t->number[k] - t->number[k - 1] : t->number[0];
            number += one;
            mass += one*demi_size_mass(w, k ? (t->at[k] + t->at[k - 1])/2 : lo);
        }
        all += share = d->by_count ? number : mass;
        if (!(number > 0)) continue;
        amount[n] = share;
        radius[n++] = (dem_real)(w->desc.planar ? sqrt(mass/number) : demi_cube_root(mass/number));
    }
    for (i = 0; i < n; i++) amount[i] /= all;
    demi_free(w, t);
    return n;
}
