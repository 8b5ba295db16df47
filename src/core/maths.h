/* ---------------------------------------------------------------------------------------------
   >>maths
   Vectors by value, rotations, elementary functions with the same bits on every machine, and random
   numbers. Also the limits that numbers must keep when they enter the library. demi_finite tests
   the exponent bits, because -ffast-math removes comparisons with NaN and infinity.
   --------------------------------------------------------------------------------------------- */
/* Limits of numbers that enter the library. Within them, squares and quotients stay finite. */
#define DEMI_FARTHEST 1e15          /* largest m, m/s, rad/s and s */
#define DEMI_OVERLAP_LIMIT 0.05     /* in radii: above it a material counts as too soft */
#define DEMI_LEAST 1e-12            /* m, smallest extent of a surface */
#define DEMI_MOST 1e30              /* largest modulus, density and stiffness, SI units */
#define DEMI_MOST_RATIO 1e9         /* largest dimensionless coefficient */
#define DEMI_FINEST 1e-15           /* m, smallest radius that a size distribution may draw */
#define DEMI_DT_LEAST 1e-20         /* s, smallest time step */
static double demi_size(dem_vec3 a) {                     /* largest |component| */
    return fmax(fabs((double)a.x), fmax(fabs((double)a.y), fabs((double)a.z)));
}
/* Returns a unit vector perpendicular to n (unit) [DUF17]. */
DEM_INLINE dem_vec3 demi_across(dem_vec3 n) {
    const dem_real s = n.z < 0 ? DEM_R(-1) : DEM_R(1), a = -1/(s + n.z);
    return demi_v(1 + s*n.x*n.x*a, s*n.x*n.y*a, -s*n.x);
}
static dem_vec3 demi_unit(dem_vec3 a) {                   /* unit vector along a; a must not be 0 */
    double x = (double)a.x, y = (double)a.y, z = (double)a.z, l;
    int e;
    (void)frexp(demi_size(a), &e);                        /* scales by a power of two: exact */
    x = ldexp(x, -e); y = ldexp(y, -e); z = ldexp(z, -e);
    l = sqrt(x*x + y*y + z*z);
    return demi_v((dem_real)(x/l), (dem_real)(y/l), (dem_real)(z/l));
}
static int demi_finite_double(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return ((bits >> 52) & 0x7ff) != 0x7ff;
}
static int demi_finite(dem_real x) { return demi_finite_double((double)x); }
static int demi_finite3(dem_vec3 v) { return demi_finite(v.x) && demi_finite(v.y) &&
                                     demi_finite(v.z); }
static int demi_bounded(double x) { return demi_finite_double(x) && fabs(x) <= DEMI_FARTHEST; }
/* True if a position, velocity or spin is finite and within DEMI_FARTHEST. */
static int demi_place(dem_vec3 v) { return demi_finite3(v) && demi_size(v) <= DEMI_FARTHEST; }
/* True unless dt is a usable time step, s, or 0, which lets the library choose. */
static int demi_dt_bad(dem_real dt) {
    return !((double)dt >= DEMI_DT_LEAST || DEMI_ABS(dt) <= 0) || (double)dt > DEMI_FARTHEST;
}

/* Elementary functions. C libraries round them differently, so dem.h has its own and a run has the
   same bits with every library. From <math.h> it uses only functions that are exact or that IEEE
   754 rounds correctly (sqrt, fabs, floor, ceil, fmod, frexp, ldexp). Each function below is a
   series on a short range and accurate to 4 units in the last place. NaN gives NaN; arguments out
   of range give 0 or infinity.

   sin, cos: x = n pi/2 + r, |r| <= pi/4. pi/2 is split into four parts. The first three have 24
   bits, so that n times each of them is exact up to n = 2^29. Infinity gives NaN. */
static void demi_sin_cos(double x, double *sine, double *cosine) {
    const double n = floor(x/1.5707963267948966 + 0.5);
    const double r = (((x - n*1.570796251296997) - n*7.549789415861596e-08) -
                      n*5.390302529957765e-15) - n*3.282003415807913e-22;
    const double u = r*r, quarter = n - 4*floor(n/4);
    const double s = r + r*u*(-1.0/6 + u*(1.0/120 + u*(-1.0/5040 + u*(1.0/362880 +
        u*(-1.0/39916800 + u*(1.0/6227020800 + u*(-1.0/1307674368000 + u/355687428096000)))))));
    const double c = 1 - u/2 + u*u*(1.0/24 + u*(-1.0/720 + u*(1.0/40320 + u*(-1.0/3628800 +
        u*(1.0/479001600 + u*(-1.0/87178291200 + u*(1.0/20922789888000 - u/6402373705728000)))))));
    if (!demi_finite_double(x)) { *sine = *cosine = x - x; return; }
    *sine = quarter < 1 ? s : quarter < 2 ? c : quarter < 3 ? -s : -c;
    *cosine = quarter < 1 ? c : quarter < 2 ? -s : quarter < 3 ? -c : s;
}
static double demi_sin(double x) { double s, c; demi_sin_cos(x, &s, &c); return s; }
static double demi_cos(double x) { double s, c; demi_sin_cos(x, &s, &c); return c; }
/* log(m 2^e) = e log 2 + 2 artanh((m - 1)/(m + 1)), m from 0.7 to 1.4. 0 gives -infinity, x < 0
   NaN. */
static double demi_log(double x) {
    int e;
    double m, s, u;
    if (!(x > 0)) return x < 0 ? (x - x)/(x - x) : x > -1 ? -HUGE_VAL : x;
    if (!demi_finite_double(x)) return x;
    m = frexp(x, &e);
    if (m < 0.7071067811865476) { m *= 2; e--; }
    s = (m - 1)/(m + 1);
    u = s*s;
    u = 2*s*u*(1.0/3 + u*(1.0/5 + u*(1.0/7 + u*(1.0/9 + u*(1.0/11 + u*(1.0/13 + u*(1.0/15 +
        u*(1.0/17 + u*(1.0/19 + u*(1.0/21 + u/23))))))))));
    return e*0.6931471803691238 + (2*s + (u + e*1.9082149292705877e-10));
}
/* exp(x) = 2^n exp(r), |r| <= log(2)/2 */
static double demi_exp(double x) {
    const double n = floor(x/0.6931471805599453 + 0.5);
    const double r = (x - n*0.6931471803691238) - n*1.9082149292705877e-10;
    double sum = 1;
    int k;
    if (!(x > -746 && x < 710)) return x > 0 ? HUGE_VAL : x < 0 ? 0 : x;
    for (k = 14; k > 0; k--) sum = 1 + r*sum/k;
    return ldexp(sum, (int)n);
}
/* x^y for x >= 0 */
static double demi_pow(double x, double y) {
    return x > 0 ? demi_exp(y*demi_log(x)) : y > 0 ? x : y < 0 ? HUGE_VAL : 1;
}
/* Cube root, for x >= 0. A factor of 8 in x is exactly a factor of 2 in it, so that lengths from
   volumes have the same bits in other units of length (powers of two). */
static double demi_cube_root(double x) {
    int e = 0, n;
    const double m = frexp(x, &e);
    n = (int)floor(e/3.0);
    return ldexp(demi_pow(ldexp(m, e - 3*n), 1.0/3), n);
}
static double demi_atan(double x) { /* halves the angle twice, then sums the series */
    double u;
    int k;
    if (x > 1 || x < -1) return (x > 0 ? 1.5707963267948966 : -1.5707963267948966) - demi_atan(1/x);
    for (k = 0; k < 2; k++) x = x/(1 + sqrt(1 + x*x));
    u = x*x;
    return 4*(x - x*u*(1.0/3 - u*(1.0/5 - u*(1.0/7 - u*(1.0/9 - u*(1.0/11 - u*(1.0/13 -
        u*(1.0/15 - u*(1.0/17 - u*(1.0/19 - u*(1.0/21 - u/23)))))))))));
}
static double demi_atan2(double y, double x) {
    const double pi = 3.141592653589793;
    if (fabs(y) > fabs(x)) return (y > 0 ? pi/2 : -pi/2) - demi_atan(x/y);
    return x > 0 ? demi_atan(y/x) : x < 0 ? demi_atan(y/x) + (y < 0 ? -pi : pi) : 0;
}
static double demi_acos(double x) { return 2*demi_atan2(sqrt(1 - x), sqrt(1 + x)); }

/* Rotates a vector from the local frame to the world, and back. R: row-major 3 x 3. */
DEM_INLINE dem_vec3 demi_rotate(const dem_real *R, dem_vec3 a) {
    return demi_v(R[0]*a.x + R[1]*a.y + R[2]*a.z, R[3]*a.x + R[4]*a.y + R[5]*a.z, R[6]*a.x +
                  R[7]*a.y + R[8]*a.z);
}
DEM_INLINE dem_vec3 demi_unrotate(const dem_real *R, dem_vec3 a) {
    return demi_v(R[0]*a.x + R[3]*a.y + R[6]*a.z, R[1]*a.x + R[4]*a.y + R[7]*a.z, R[2]*a.x +
                  R[5]*a.y + R[8]*a.z);
}
/* A vector in double precision, for geometry that float cannot resolve. Sums are evaluated from
   left to right: x, y, z. */
typedef struct demi_d3 { double x, y, z; } demi_d3;
DEM_INLINE demi_d3 demi_d(double x, double y, double z) {
    demi_d3 a;
    a.x = x; a.y = y; a.z = z;
    return a;
}
DEM_INLINE demi_d3 demi_d3_at(const double *p) { return demi_d(p[0], p[1], p[2]); }
DEM_INLINE void demi_d3_put(double *p, demi_d3 a) { p[0] = a.x; p[1] = a.y; p[2] = a.z; }
DEM_INLINE demi_d3 demi_d3_of(dem_vec3 a) { return demi_d((double)a.x, (double)a.y, (double)a.z); }
DEM_INLINE dem_vec3 demi_d3_real(demi_d3 a) {
    return demi_v((dem_real)a.x, (dem_real)a.y, (dem_real)a.z);
}
DEM_INLINE demi_d3 demi_d3_add(demi_d3 a, demi_d3 b) {
    return demi_d(a.x + b.x, a.y + b.y, a.z + b.z);
}
DEM_INLINE demi_d3 demi_d3_sub(demi_d3 a, demi_d3 b) {
    return demi_d(a.x - b.x, a.y - b.y, a.z - b.z);
}
DEM_INLINE demi_d3 demi_d3_scale(demi_d3 a, double s) { return demi_d(a.x*s, a.y*s, a.z*s); }
DEM_INLINE demi_d3 demi_d3_over(demi_d3 a, double s) { return demi_d(a.x/s, a.y/s, a.z/s); }
DEM_INLINE double demi_d3_dot(demi_d3 a, demi_d3 b) { return a.x*b.x + a.y*b.y + a.z*b.z; }
DEM_INLINE demi_d3 demi_d3_cross(demi_d3 a, demi_d3 b) {
    return demi_d(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}
DEM_INLINE double demi_d3_square(demi_d3 a) { return demi_d3_dot(a, a); }
DEM_INLINE double demi_d3_length(demi_d3 a) { return sqrt(demi_d3_dot(a, a)); }
DEM_INLINE demi_d3 demi_d3_unit(demi_d3 a) {              /* 0 gives 0 */
    const double l = demi_d3_length(a);
    return l > 0 ? demi_d3_over(a, l) : demi_d(0, 0, 0);
}
/* a + t b, and the linear interpolation from a (t = 0) to b (t = 1). */
DEM_INLINE demi_d3 demi_d3_plus(demi_d3 a, double t, demi_d3 b) {
    return demi_d3_add(a, demi_d3_scale(b, t));
}
DEM_INLINE demi_d3 demi_d3_between(demi_d3 a, demi_d3 b, double t) {
    return demi_d3_plus(a, t, demi_d3_sub(b, a));
}
/* (b - a) x (c - a): normal of a triangle, on the side from which a, b, c run anticlockwise. Its
   length is twice the triangle's area. */
DEM_INLINE demi_d3 demi_d3_normal(demi_d3 a, demi_d3 b, demi_d3 c) {
    return demi_d3_cross(demi_d3_sub(b, a), demi_d3_sub(c, a));
}
/* Minimum and maximum by component. */
DEM_INLINE demi_d3 demi_d3_lowest(demi_d3 a, demi_d3 b) {
    return demi_d(DEMI_MIN(a.x, b.x), DEMI_MIN(a.y, b.y), DEMI_MIN(a.z, b.z));
}
DEM_INLINE demi_d3 demi_d3_highest(demi_d3 a, demi_d3 b) {
    return demi_d(DEMI_MAX(a.x, b.x), DEMI_MAX(a.y, b.y), DEMI_MAX(a.z, b.z));
}
/* demi_rotate in double precision. */
DEM_INLINE demi_d3 demi_d3_rotate(const double *R, demi_d3 a) {
    return demi_d(R[0]*a.x + R[1]*a.y + R[2]*a.z, R[3]*a.x + R[4]*a.y + R[5]*a.z,
                  R[6]*a.x + R[7]*a.y + R[8]*a.z);
}
/* Rotation matrix, row-major, by `angle` (rad) about the unit axis (x, y, z) (Rodrigues). */
static void demi_rotation(double *R, double x, double y, double z, double angle) {
    double c = demi_cos(angle), s = demi_sin(angle), v = 1 - c;
    R[0] = c + x*x*v;   R[1] = x*y*v - z*s; R[2] = x*z*v + y*s;
    R[3] = y*x*v + z*s; R[4] = c + y*y*v;   R[5] = y*z*v - x*s;
    R[6] = z*x*v - y*s; R[7] = z*y*v + x*s; R[8] = c + z*z*v;
}
/* A rotation whose third column is the unit vector n, so that it maps local z to n [DUF17]. */
static void demi_frame_of(dem_real *R, dem_vec3 n) {
    dem_real s = n.z >= 0 ? DEM_R(1) : DEM_R(-1), a = -1/(s + n.z), b = n.x*n.y*a;
    R[0] = 1 + s*n.x*n.x*a; R[3] = s*b;           R[6] = -s*n.x;
    R[1] = b;               R[4] = s + n.y*n.y*a; R[7] = -n.y;
    R[2] = n.x;             R[5] = n.y;           R[8] = n.z;
}

/* The next 64 random bits: splitmix64, with one 64-bit state; good enough for placing grains. */
static uint64_t demi_random(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}
static double demi_uniform(uint64_t *state) {                    /* 0 <= u < 1 */
    return (double)(demi_random(state) >> 11)/9007199254740992.0;
}

/* Of mean 0 and variance 1 (Box and Muller 1958, one of the two). */
static double demi_gauss(uint64_t *state) {
    const double u = 1 - demi_uniform(state), a = 2*DEMI_PI*demi_uniform(state);
    return sqrt(-2*demi_log(u))*demi_cos(a);
}

/* FNV-1a, 64 bits: check sums and state hashes. */
#define DEMI_HASH_START UINT64_C(14695981039346656037)
static uint64_t demi_hash(uint64_t h, const void *data, size_t size) {
    const unsigned char *p = (const unsigned char *)data;
    size_t i;
    for (i = 0; i < size; i++) h = (h ^ p[i])*UINT64_C(1099511628211);
    return h;
}
