/* Gaps of polyhedra by GJK and EPA (>>gaps) beside brute force and MPR, which know nothing of them: tests/convex.h.
   PAIRS=100000 for more pairs; GAPS_NUMBERS=1 prints how far they are off, and times. */
#include "../convex.h"
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include <stdlib.h>
#include <time.h>

static void solid_from(const convex_solid *from, demi_solid *s) {
    int i;
    memset(s, 0, sizeof *s);
    s->corners = from->corners;
    for (i = 0; i < s->corners; i++) {
        s->corner[i] = demi_d3_at(from->corner + 3*i);
        s->centre = demi_d3_add(s->centre, demi_d3_over(s->corner[i], s->corners));
    }
}
static double seconds(void) { return (double)clock()/CLOCKS_PER_SEC; }

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("GJK with EPA, MPR and brute force agree on contact, gap and depth of polyhedra, 1e-5 to 10 m, aspect ratios "
         "to 50") {
        const long pairs = getenv("PAIRS") ? atol(getenv("PAIRS")) : 400;
        static convex_solid a, b;
        static demi_solid p, q;
        uint64_t state = 20261124;
        double worst = 0, time[3] = {0, 0, 0}, since;
        long k, other = 0, near_miss = 0, strange = 0, shallow = 0, short_of = 0, off[8] = {0};
        for (k = 0; k < pairs; k++) {
            demi_simplex tells;
            demi_d3 n = demi_d(0, 0, 0);
            double gap, size, error;
            convex_body one, two;
            convex_gap g;
            convex_verdict v;
            int i;
            convex_pair(&a, &b, &state);
            one = convex_view(&a);
            two = convex_view(&b);
            size = convex_radius(&one) + convex_radius(&two);
            since = seconds();
            g = convex_brute(&one, &two);
            time[0] += seconds() - since;
            solid_from(&a, &p);
            solid_from(&b, &q);
            since = seconds();
            gap = demi_solids_gap(&p, &q, 1e300, &n, &tells);
            time[1] += seconds() - since;
            since = seconds();
            v = convex_mpr(&one, &two);
            time[2] += seconds() - since;
            error = fabs(gap - g.gap)/size;
            for (i = 0; i < 7 && error >= pow(10, -16 + 2*i); i++) continue;
            off[i]++;
            worst = fmax(worst, error);
            strange += !(gap > -1e300 && gap < 1e300) || fabs(demi_d3_square(n) - 1) > 1e-12;
            if (fabs(g.gap) > 1e-12*size) other += (gap < 0) != (g.gap < 0) || v.touching != (g.gap < 0);
            else near_miss++;
            shallow += gap > g.gap + 1e-13*size;        /* a plane that parts them can do no more than the distance */
            short_of += v.touching && v.depth < -g.gap - 1e-13*size;
        }
        if (getenv("GAPS_NUMBERS")) {
            printf("%ld pairs, %ld nearer than 1e-12: %ld other verdicts, worst %.3g of the pair's size\n", pairs, near_miss, other,
                   worst);
            printf("off by < 1e-16 1e-14 1e-12 1e-10 1e-8 1e-6 1e-4, more: %ld %ld %ld %ld %ld %ld %ld %ld\n", off[0], off[1],
                   off[2], off[3], off[4], off[5], off[6], off[7]);
            printf("us a pair: brute force %.3g, GJK and EPA %.3g, MPR %.3g\n", 1e6*time[0]/(double)pairs,
                   1e6*time[1]/(double)pairs, 1e6*time[2]/(double)pairs);
        }
        CHECK_EQ(strange, 0);
        CHECK_EQ(other, 0);
        CHECK_EQ(shallow, 0);
        CHECK_EQ(short_of, 0);
        CHECK(worst < 1e-6);
    }

    TEST("a gap is independent of the order and orientation of its two polyhedra, for parallel faces and edges too") {
        const long pairs = getenv("PAIRS") ? atol(getenv("PAIRS")) : 400;
        static convex_solid a, b;
        static demi_solid p[2], q[2];
        uint64_t state = 55;
        double worst = 0;
        long k, touching = 0;
        for (k = 0; k < pairs; k++) {
            const double small = 1/convex_power(&state, 1, 100);
            convex_spot one, two;
            convex_body body;
            double way[3], size = 0, gap[4];
            uint64_t same;
            int i;
            convex_shape(&a, &state, 1);
            convex_shape(&b, &state, small);
            for (i = 0; i < 3; i++) way[i] = 1e-5*(2*convex_random(&state) - 1);
            one = convex_spot_of(&a, &state, CONVEX_CORNER);
            two = convex_spot_of(&b, &state, CONVEX_CORNER);
            convex_move(&b, one.at[0] - two.at[0] + way[0], one.at[1] - two.at[1] + way[1], one.at[2] - two.at[2] + way[2]);
            for (i = 0; i < 2; i++) {
                solid_from(&a, &p[i]);
                solid_from(&b, &q[i]);
                same = state;
                convex_turn(&a, &same);
                convex_turn(&b, &state);        /* by the same numbers */
            }
            body = convex_view(&a);
            size += convex_radius(&body);
            body = convex_view(&b);
            size += convex_radius(&body);
            for (i = 0; i < 4; i++) {
                demi_d3 n = demi_d(0, 0, 0);
                demi_simplex tells;
                gap[i] = i & 1 ? demi_solids_gap(&q[i/2], &p[i/2], 1e300, &n, &tells)
                    : demi_solids_gap(&p[i/2], &q[i/2], 1e300, &n, &tells);
                worst = fmax(worst, fabs(gap[i] - gap[0])/size);
            }
            touching += gap[0] < 0;
        }
        if (getenv("GAPS_NUMBERS")) printf("%ld pairs, %ld touching: worst %.3g of the pair's size\n", pairs, touching, worst);
        CHECK(touching > pairs/2);
        CHECK(worst < 1e-9);
    }

    TEST("a gap that is sought up to a range only is the same below it, and is not below it otherwise") {
        static convex_solid a, b;
        static demi_solid p, q;
        uint64_t state = 57;
        long k, below = 0, beyond = 0, ended = 0, wrong = 0;
        for (k = 0; k < 2000; k++) {
            demi_d3 n = demi_d(0, 0, 0), other = demi_d(0, 0, 0);
            demi_simplex tells;
            convex_body one, two;
            double gap, up_to, range, tiny;
            convex_pair(&a, &b, &state);
            solid_from(&a, &p);
            solid_from(&b, &q);
            gap = demi_solids_gap(&p, &q, 1e300, &n, &tells);
            range = k & 1 ? 2*fabs(gap)*convex_random(&state) : 0;
            up_to = demi_solids_gap(&p, &q, range, &other, &tells);
            below += gap < range;
            beyond += !(gap < range);
            ended += up_to < gap;
            one = convex_view(&a);
            two = convex_view(&b);
            tiny = 1e-7*fmin(convex_radius(&one), convex_radius(&two));     /* below, EPA finds some gap that is less */
            wrong += gap < range - tiny ? up_to < gap || up_to > gap
                : up_to < fmin(range, gap) - tiny || up_to > gap + tiny;
        }
        CHECK(below > 200);
        CHECK(beyond > 200);
        CHECK(ended > 100);                     /* these were spared most of the search */
        CHECK_EQ(wrong, 0);
    }

    TEST("of five points of which none is on one side, the nearest stays, however many are farther away") {
        const demi_d3 x[5] = {demi_d(0, 0, 0), demi_d(1, 0, 0), demi_d(0.5, 0.01, 0), demi_d(0, 1, 0), demi_d(1, 1, 0)};
        const double gap[5] = {0.057, 0.0574, 0.0623, 0.35, 0.36};     /* touch: 0.057 and 1e-4 of the distance */
        int out[4], i, count, has = 0;
        count = demi_spots_pick(x, gap, 5, demi_d(0, 0, 1), out);
        for (i = 0; i < count; i++) has |= 1 << out[i];
        CHECK_EQ(count, 4);
        CHECK_EQ(has & 7, 7);                   /* they touch first */
    }
    TEST("of a card that is tilted about one edge the far corners are among its four points, and not those beside the edge") {
        const demi_d3 x[6] = {demi_d(0, 0, 0), demi_d(1, 0, 0), demi_d(0, 0.01, 0), demi_d(1, 0.01, 0), demi_d(0, 1, 0),
                              demi_d(1, 1, 0)};
        const double gap[6] = {0, 0, 0.02, 0.02, 0.04, 0.041};
        int out[4], i, count, has = 0;
        count = demi_spots_pick(x, gap, 6, demi_d(0, 0, 1), out);
        for (i = 0; i < count; i++) has |= 1 << out[i];
        CHECK_EQ(count, 4);
        CHECK_EQ(has, 1 | 2 | 16 | 32);
    }

    TEST("two cubes that touch to round-off do not overlap, whatever EPA ends at") {
        /* corners of either, m, from a tower of blocks of 1 mm that had rested for a second */
        static const double corner[8][6] = {
            {0.00049999999999999, -0.0005000000000000104, 0.0004999999999999996, 0.00046999999999999863, -0.000470000000000002, 0.0014999999999999996},
            {0.0004999999999999892, -0.0005000000000000104, -0.0005000000000000004, 0.00046999999999999776, -0.000470000000000002, 0.0004999999999999996},
            {0.00050000000000001, 0.0004999999999999896, -0.0005000000000000006, 0.0004700000000000032, 0.000529999999999998, 0.0004999999999999996},
            {0.0005000000000000109, 0.0004999999999999896, 0.0004999999999999995, 0.00047000000000000405, 0.000529999999999998, 0.0014999999999999996},
            {-0.0005000000000000109, -0.0004999999999999896, -0.0004999999999999995, -0.0005300000000000023, -0.00046999999999999657, 0.0005000000000000004},
            {-0.00049999999999999, 0.0005000000000000104, -0.0004999999999999996, -0.0005299999999999968, 0.0005300000000000035, 0.0005000000000000004},
            {-0.00050000000000001, -0.0004999999999999896, 0.0005000000000000006, -0.0005300000000000014, -0.00046999999999999657, 0.0015000000000000005},
            {-0.0004999999999999892, 0.0005000000000000104, 0.0005000000000000004, -0.000529999999999996, 0.0005300000000000035, 0.0015000000000000005}
        };
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        const demi_part cube = scene_part(world, scene_box(world, 1e-3, 1e-3, 1e-3), dem_quat_make(1, 0, 0, 0));
        demi_d3 n = demi_d(9.68259193809812e-16, 5.581615694132755e-18, 1.0);
        static demi_solid s, t;
        demi_simplex tells;
        int i;
        demi_solid_of(&cube, at(0, 0, 0), &s);
        demi_solid_of(&cube, at(-3e-5, 3e-5, 1e-3), &t);
        for (i = 0; i < 8; i++) {
            s.corner[i] = demi_d(corner[i][0], corner[i][1], corner[i][2]);
            t.corner[i] = demi_d(corner[i][3], corner[i][4], corner[i][5]);
        }
        t.centre = demi_d(-3e-5, 3e-5, 1e-3);
        CHECK_NEAR(demi_solids_gap(&s, &t, 2e-5, &n, &tells), 0, 1e-15);
        CHECK_NEAR(n.z, 1, 1e-9);
        dem_world_destroy(world);
    }
    return test_end();
}
