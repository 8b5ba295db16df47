/* dem.h's own sin, cos, log, exp, pow, atan2, acos (>>maths), beside those of the C library. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* Distance of a from b, in units in the last place of b. */
static double maths_ulp(double a, double b) {
    int e;
    frexp(b, &e);
    return fabs(a - b)/ldexp(1, (e < -1021 ? -1021 : e) - 53);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("sin, cos, log, exp, atan2 and acos match the C library to 4 units in the last place, pow to 1e-14, over a "
         "run's range") {
        uint64_t state = 7;
        double worst[7] = {0, 0, 0, 0, 0, 0, 0};
        int k, j;
        for (k = 0; k < 200000; k++) {
            const double u = 2*scene_random(&state) - 1, v = scene_random(&state);
            const double x = u*pow(10, 8*v), y = (2*scene_random(&state) - 1)*pow(10, 12*v - 6);   /* rad, to 1e8 */
            const double p = exp(40*u);
            /* near their zeros sin and cos are as good as x itself: half a unit of it */
            worst[0] = fmax(worst[0], fabs(demi_sin(x) - sin(x))/(4*DBL_EPSILON + 1e-22*fabs(x)));
            worst[1] = fmax(worst[1], fabs(demi_cos(x) - cos(x))/(4*DBL_EPSILON + 1e-22*fabs(x)));
            worst[2] = fmax(worst[2], fabs(demi_log(p) - log(p)) < DBL_EPSILON ? 0 : maths_ulp(demi_log(p), log(p))/4);
            worst[3] = fmax(worst[3], maths_ulp(demi_exp(700*u), exp(700*u))/4);
            worst[4] = fmax(worst[4], fabs(demi_pow(p, 5*u*v)/pow(p, 5*u*v) - 1)/(2e-14 + 4e-16*fabs(200*u*u*v)));
            worst[5] = fmax(worst[5], maths_ulp(demi_atan2(y, u), atan2(y, u))/4);
            worst[6] = fmax(worst[6], fabs(demi_acos(u) - acos(u))/(8*DBL_EPSILON));
        }
        for (j = 0; j < 7; j++) {
            CHECK(worst[j] <= 1);
            if (!(worst[j] <= 1)) printf("    function %d: %g times what is allowed\n", j, worst[j]);
        }
    }
    TEST("out-of-range arguments of the maths functions give NaN, 0, infinity or the quadrant as the C library does") {
        const double huge = HUGE_VAL, none = HUGE_VAL - HUGE_VAL;
        CHECK(demi_sin(none) != demi_sin(none) && demi_cos(huge) != demi_cos(huge));
        CHECK(demi_exp(none) != demi_exp(none) && demi_log(none) != demi_log(none) && demi_log(-1) != demi_log(-1));
        CHECK_EQ(demi_exp(1000) >= huge, 1);
        CHECK_EQ(demi_log(huge) >= huge, 1);
        CHECK_EQ(demi_log(0) <= -huge, 1);
        CHECK_NEAR(demi_exp(-1000), 0, 0);
        CHECK_NEAR(demi_exp(0), 1, 0);
        CHECK_NEAR(demi_log(1), 0, 0);
        CHECK_NEAR(demi_pow(0, 0), 1, 0);
        CHECK_NEAR(demi_pow(0, 2), 0, 0);
        CHECK_NEAR(demi_log(5e-324)/log(5e-324), 1, 1e-15);
        CHECK_NEAR(demi_sin(0), 0, 0);
        CHECK_NEAR(demi_cos(0), 1, 0);
        CHECK_NEAR(demi_atan2(0, -1), 3.141592653589793, 0);
        CHECK_NEAR(demi_atan2(-1, 0), -1.5707963267948966, 0);
        CHECK_NEAR(demi_atan2(0, 0), 0, 0);
        CHECK_NEAR(demi_acos(-1), 3.141592653589793, 0);
        CHECK_NEAR(demi_acos(1), 0, 0);
    }
    return test_end();
}
