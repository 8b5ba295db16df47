/* tests/convex.h, the oracles of contact of convex polyhedra: against closed forms, and against each other.
   PAIRS in the environment is how many pairs are drawn, CONVEX_NUMBERS prints what was found. */
#include "../test.h"
#include "../convex.h"

static int pairs_drawn(int share) {
    return (getenv("PAIRS") ? atoi(getenv("PAIRS")) : 300)/share + 1;
}
static double pair_size(const convex_body *a, const convex_body *b) { return convex_radius(a) + convex_radius(b); }
static convex_gap gap_of(const convex_solid *a, const convex_solid *b) {
    const convex_body one = convex_view(a), two = convex_view(b);
    return convex_brute(&one, &two);
}
static convex_verdict verdict_of(const convex_solid *a, const convex_solid *b) {
    const convex_body one = convex_view(a), two = convex_view(b);
    return convex_mpr(&one, &two);
}
static void rotate(convex_solid *s, double angle, double x, double y, double z) {
    const double none[3] = {0, 0, 0}, length = sqrt(x*x + y*y + z*z), f = sin(angle/2)/length;
    double R[9];
    convex_matrix(cos(angle/2), f*x, f*y, f*z, R);
    convex_place(s, R, none);
}
/* How far a point stands out of a body, at most. */
static double stands_out(const convex_body *s, const double *x) {
    double most = -1e300;
    int f;
    for (f = 0; f < s->faces; f++) most = fmax(most, convex_dot(s->plane + 4*f, x) - s->plane[4*f + 3]);
    return most;
}
/* Width of the slab square to n between a and b; < 0: the way along n that parts them. */
static double slab_width(const convex_body *a, const convex_body *b, const double *n) {
    double x[3];
    convex_minus(convex_support(b, n, -1), convex_support(a, n, 1), x);
    return convex_dot(n, x);
}
static double off_by(const convex_gap *g) {        /* how far b - a is from gap*normal */
    double most = 0;
    int k;
    for (k = 0; k < 3; k++) most = fmax(most, fabs(g->b[k] - g->a[k] - g->gap*g->normal[k]));
    return most;
}
static double step_of(int i) {                      /* 1e-9, 1e-8 to 0.1 for i = 1 to 9, and with the sign of i */
    return i == 0 ? 0 : (i < 0 ? -1 : 1)*pow(10, abs(i) - 10);
}

int main(int argc, char **argv) {
    const int numbers = getenv("CONVEX_NUMBERS") != 0;
    test_begin(argc, argv);

    TEST("convex shapes have the corners, faces and edges of their kind, and planes that bound all corners") {
        convex_solid s;
        uint64_t random = 3;
        int i, sides;
        convex_box(&s, 1, 2, 3);
        CHECK(s.corners == 8 && s.faces == 6 && s.edges == 12);
        convex_tetrahedron(&s);
        CHECK(s.corners == 4 && s.faces == 4 && s.edges == 6);
        convex_octahedron(&s);
        CHECK(s.corners == 6 && s.faces == 8 && s.edges == 12);
        for (sides = 3; sides <= 12; sides++) {
            convex_prism(&s, sides);
            CHECK(s.corners == 2*sides && s.faces == sides + 2 && s.edges == 3*sides);
        }
        for (i = 0; i < 20; i++) {
            convex_body view = convex_view(&s);
            double out = 0;
            int c;
            convex_rock(&s, &random, i%2 ? 14 : 50);
            CHECK(s.faces == 2*s.corners - 4 && s.edges == 3*s.corners - 6);
            convex_stretch(&s, 5, 0.1, 1);
            convex_turn(&s, &random);
            view = convex_view(&s);
            for (c = 0; c < s.corners; c++) out = fmax(out, stands_out(&view, s.corner + 3*c));
            CHECK_NEAR(out, 0, 1e-15);
        }
    }

    TEST("two axis-aligned boxes have Pythagoras' distance, or the least of three overlaps as depth") {
        uint64_t random = 5;
        int i, k, deep = 0;
        for (i = 0; i < 300; i++) {
            const double size = convex_power(&random, 1e-5, 10);
            convex_solid a, b;
            convex_gap g;
            convex_verdict v;
            double p[2][3], x[3], square = 0, depth = 1e300, expected;
            for (k = 0; k < 6; k++) p[k/3][k%3] = size*convex_power(&random, 0.02, 1);
            for (k = 0; k < 3; k++) {
                double off;
                x[k] = size*(0.8*convex_random(&random) - 0.4);
                off = fabs(x[k]) - (p[0][k] + p[1][k])/2;
                if (off > 0) square += off*off;
                depth = fmin(depth, -off);
            }
            expected = depth > 0 ? -depth : sqrt(square);
            convex_box(&a, p[0][0], p[0][1], p[0][2]);
            convex_box(&b, p[1][0], p[1][1], p[1][2]);
            convex_move(&b, x[0], x[1], x[2]);
            g = gap_of(&a, &b);
            v = verdict_of(&a, &b);
            CHECK_NEAR(g.gap/size, expected/size, 4e-16);       /* round-off of the corners */
            CHECK_NEAR(off_by(&g)/size, 0, 4e-16);
            CHECK_EQ(v.touching, depth > 0);
            CHECK(v.sure && (depth > 0 ? v.depth > depth - 4e-16*size : -v.depth < expected + 4e-16*size));
            deep += depth > 0;
        }
        CHECK(deep > 30 && deep < 270);
    }

    TEST("a cube on its corner has the corner's height as its distance from a face, and its depth below it") {
        int i;
        for (i = -9; i <= 9; i++) {
            const double high = step_of(i);
            convex_solid a, b;
            convex_gap g;
            convex_verdict v;
            convex_box(&a, 3, 3, 1);
            convex_box(&b, 1, 1, 1);
            rotate(&b, acos(-1/sqrt(3.0)), -1, 1, 0);           /* takes (1, 1, 1) to (0, 0, -1) */
            convex_move(&b, 0.2, -0.1, 0.5 + sqrt(3.0)/2 + high);
            g = gap_of(&a, &b);
            v = verdict_of(&a, &b);
            CHECK_NEAR(g.gap, high, 5e-16);
            CHECK_NEAR(g.normal[2], 1, 1e-15);
            CHECK_NEAR(g.b[0], 0.2, 1e-15);
            CHECK_NEAR(g.a[1], -0.1, 1e-15);
            CHECK_NEAR(g.b[2], 0.5 + high, 1e-15);
            if (i) CHECK_EQ(v.touching, i < 0);
            if (i < 0) CHECK_NEAR(v.depth, -high, 1e-15);       /* the ray leaves by the face: exact there */
        }
    }

    TEST("two bars with crossed edges have the distance of the edges as gap or depth") {
        int i;
        for (i = -9; i <= 9; i++) {
            const double high = step_of(i), angle = 0.3 + 0.06*(i + 9);
            convex_solid a, b;
            convex_gap g;
            convex_verdict v;
            convex_box(&a, 5, 1, 1);
            convex_box(&b, 5, 1.4, 1.4);
            rotate(&a, atan(1.0), 1, 0, 0);                     /* an edge up, along x */
            rotate(&b, atan(1.0), 1, 0, 0);
            rotate(&b, angle, 0, 0, 1);
            convex_move(&b, 0.3, 0, 1.2*sqrt(2.0) + high);
            g = gap_of(&a, &b);
            v = verdict_of(&a, &b);
            CHECK_NEAR(g.gap, high, 1e-15);
            CHECK_NEAR(g.normal[2], 1, 1e-15);
            CHECK_NEAR(g.a[0], 0.3, 4e-15);
            CHECK_NEAR(g.b[1], 0, 4e-15);
            CHECK_NEAR(g.a[2], sqrt(0.5), 1e-15);
            if (i) CHECK_EQ(v.touching, i < 0);
            if (i < 0) CHECK(v.depth > -high - 1e-15);
        }
        for (i = 0; i < 40; i++) {                              /* almost parallel: 1/10 of the angle times the length */
            const double angle = pow(10, -1 - 0.25*i), high = (i%2 ? 0.5 : -0.5)*angle;
            convex_solid a, b;
            convex_verdict v;
            convex_box(&a, 5, 1, 1);
            convex_box(&b, 5, 1.4, 1.4);
            rotate(&a, atan(1.0), 1, 0, 0);
            rotate(&b, atan(1.0), 1, 0, 0);
            rotate(&b, angle, 0, 0, 1);
            convex_move(&b, 0, 0, 1.2*sqrt(2.0) + high);
            rotate(&a, i, 1, 2, 3);                             /* along no axis: their coordinates are rounded */
            rotate(&b, i, 1, 2, 3);
            CHECK_NEAR(gap_of(&a, &b).gap, high, 2e-15);
            v = verdict_of(&a, &b);
            CHECK(v.touching == (high < 0));
            CHECK(high > 0 ? -v.depth < high + 2e-15 : v.depth > -high - 2e-15);
        }
    }

    TEST("concentric cubes have half the sum of their edges as depth, an octahedron and a cube the least of face, "
         "edge and corner") {
        int i;
        for (i = 1; i <= 40; i++) {
            const double c = 0.05*i, r = 0.5;                   /* the cube's edge; the octahedron's corner */
            convex_solid a, b;
            convex_verdict v;
            double expected;
            convex_box(&a, 1, 1, 1);
            convex_box(&b, c, c, c);
            CHECK_NEAR(gap_of(&a, &b).gap, -(1 + c)/2, 1e-15);
            v = verdict_of(&a, &b);
            CHECK(v.touching && v.sure);
            CHECK(v.depth >= (1 + c)/2 - 1e-15);
            rotate(&b, 0.1*i, 0, 0, 1);
            CHECK_NEAR(gap_of(&a, &b).gap, -(1 + c)/2, 1e-15);  /* they leave along z */
            convex_octahedron(&a);
            convex_box(&b, c, c, c);
            expected = fmin(c/2 + r, fmin((c + r)/sqrt(2.0), (1.5*c + r)/sqrt(3.0)));
            CHECK_NEAR(gap_of(&a, &b).gap, -expected, 1e-15);
            v = verdict_of(&a, &b);
            CHECK(v.touching && v.sure);
            CHECK(v.depth >= expected - 1e-15);
        }
    }

    TEST("MPR survives rays along edges and through corners: concentric, tip-to-tip and coplanar configurations") {
        /* with rules that look at two signs only these tetrahedra, 1/sqrt 5 and 2/sqrt 11 apart, touch */
        static const double at_a[2][12] = {{0, 6, 4, 2, 2, 6, 4, 4, 4, 6, 0, 2}, {0, 2, 6, 2, 4, 6, 6, 2, 4, 6, 0, 2}};
        static const double at_b[2][12] = {{9, 3, 6, 5, 3, 2, 8, 7, 4, 5, 3, 4}, {0, 2, 8, 3, 0, 10, 2, 2, 6, 5, 4, 8}};
        convex_solid a, b;
        convex_verdict v;
        uint64_t random = 8;
        int i;
        for (i = 0; i < 2; i++) {
            CHECK(convex_hull(&a, 4, at_a[i]) && convex_hull(&b, 4, at_b[i]));
            v = verdict_of(&a, &b);
            CHECK_NEAR(gap_of(&a, &b).gap, i ? 2/sqrt(11.0) : 1/sqrt(5.0), 1e-15);
            CHECK(v.sure && !v.touching);
        }
        for (i = 0; i < 60; i++) {
            convex_shape(&a, &random, 1);
            if (i%3) convex_turn(&a, &random);
            b = a;
            v = verdict_of(&a, &b);
            CHECK(v.sure && v.touching && v.depth >= -gap_of(&a, &b).gap - 1e-15);
        }
        for (i = -8; i <= 8; i++) {
            const double high = i*1e-3;
            convex_octahedron(&a);
            convex_octahedron(&b);
            convex_move(&b, 0, 0, 1 + high);
            v = verdict_of(&a, &b);
            CHECK_NEAR(gap_of(&a, &b).gap, i > 0 ? high : high/sqrt(3.0), 1e-15);
            if (i) CHECK(v.sure && v.touching == (i < 0));
            if (i < 0) CHECK(v.depth >= -high/sqrt(3.0) - 1e-15 && v.depth < 1.001*-high);
        }
    }

    TEST("every gap has a proof: witness points and a separating slab, or a separating move and directions that do no "
         "better") {
        const int count = pairs_drawn(4);
        uint64_t random = UINT64_C(88172645463325252);
        double worst[4] = {0, 0, 0, 0};
        int i, k, m;
        for (i = 0; i < count; i++) {
            convex_solid a, b;
            convex_body one, two;
            convex_gap g;
            double size;
            convex_pair(&a, &b, &random);
            one = convex_view(&a);
            two = convex_view(&b);
            size = pair_size(&one, &two);
            g = convex_brute(&one, &two);
            worst[0] = fmax(worst[0], fmax(stands_out(&one, g.a), stands_out(&two, g.b))/size);
            worst[1] = fmax(worst[1], off_by(&g)/size);
            worst[2] = fmax(worst[2], fabs(slab_width(&one, &two, g.normal) - g.gap)/size);
            CHECK_NEAR(convex_dot(g.normal, g.normal), 1, 1e-15);
            worst[2] = fmax(worst[2], fabs(g.gap - g.slab)/size);
            for (m = 0; m < 60 && g.gap < 0; m++) {             /* anywhere, and near by */
                const double share = m < 30 ? 0 : 1, spread = pow(10, -(m%10));
                double n[3];
                for (k = 0; k < 3; k++) n[k] = share*g.normal[k] + spread*(2*convex_random(&random) - 1);
                convex_unit(n);
                worst[2] = fmax(worst[2], (slab_width(&one, &two, n) - g.gap)/size);
            }
            if (g.gap >= 0) continue;
            convex_move(&b, -g.gap*g.normal[0], -g.gap*g.normal[1], -g.gap*g.normal[2]);
            worst[3] = fmax(worst[3], fabs(convex_brute(&one, &two).gap)/size);
        }
        CHECK_NEAR(worst[0], 0, 4e-15);                         /* some units of the last digit of a coordinate, which */
        CHECK_NEAR(worst[1], 0, 4e-15);                         /* is up to ten sizes of a pair */
        CHECK_NEAR(worst[2], 0, 4e-15);
        CHECK_NEAR(worst[3], 0, 4e-15);
        if (numbers)
            printf("%d pairs: points outside %.2g, b - a %.2g, slabs %.2g, moved out %.2g of the size\n", count, worst[0],
                   worst[1], worst[2], worst[3]);
    }

    TEST("gaps scale exactly with powers of two, and exchanged or rotated bodies have the same gap") {
        const int count = pairs_drawn(8);
        uint64_t random = 4711;
        int i, f;
        for (i = 0; i < count; i++) {
            const double by = i%2 ? ldexp(1, 20) : ldexp(1, -20);
            convex_solid a, b, c, d;
            convex_gap g, h;
            convex_verdict v, w;
            convex_body one, two;
            double size;
            convex_pair(&a, &b, &random);
            one = convex_view(&a);
            two = convex_view(&b);
            size = pair_size(&one, &two);
            c = a;
            d = b;
            convex_stretch(&c, by, by, by);
            convex_stretch(&d, by, by, by);
            for (f = 0; f < 4*c.faces; f++) c.plane[f] = f%4 < 3 ? a.plane[f] : by*a.plane[f];    /* to the bit */
            for (f = 0; f < 4*d.faces; f++) d.plane[f] = f%4 < 3 ? b.plane[f] : by*b.plane[f];
            g = gap_of(&a, &b);
            h = gap_of(&c, &d);
            v = verdict_of(&a, &b);
            w = verdict_of(&c, &d);
            CHECK(h.gap == by*g.gap && h.normal[0] == g.normal[0] && h.b[2] == by*g.b[2]);
            CHECK(w.depth == by*v.depth && w.touching == v.touching && w.normal[1] == v.normal[1]);
            h = gap_of(&b, &a);
            CHECK_NEAR(h.gap/size, g.gap/size, 1e-15);
            rotate(&a, i, 1, 2, 3);
            rotate(&b, i, 1, 2, 3);
            CHECK_NEAR(gap_of(&a, &b).gap/size, g.gap/size, 1e-14);
        }
    }

    TEST("MPR agrees with brute force on contact within 1e-14 of the size; its depth is never below the true one, its "
         "gap never above") {
        const int count = pairs_drawn(1);
        uint64_t random = 20260101;
        int kinds[CONVEX_KINDS] = {0}, i, touching = 0, close = 0, wrong = 0, unsure = 0, again = 0, steps = 0, near_by = 0;
        double under = 0, over = 0, excess = 0;
        for (i = 0; i < count; i++) {
            convex_solid a, b;
            convex_body one, two;
            convex_gap g;
            convex_verdict v;
            double size;
            kinds[convex_pair(&a, &b, &random)]++;
            one = convex_view(&a);
            two = convex_view(&b);
            size = pair_size(&one, &two);
            g = convex_brute(&one, &two);
            v = convex_mpr(&one, &two);
            CHECK(isfinite(g.gap) && isfinite(v.depth) && isfinite(v.normal[0] + v.normal[1] + v.normal[2]));
            CHECK(slab_width(&one, &two, v.normal) <= g.gap + 1e-14*size);
            CHECK_NEAR(slab_width(&one, &two, v.normal)/size, -v.depth/size, 1e-14);
            touching += g.gap < 0;
            unsure += !v.sure;
            again += v.starts > 1;
            if (v.steps > steps) steps = v.steps;
            near_by += fabs(g.gap) < 2e-6*size;
            if (fabs(g.gap) < 1e-14*size) close++;
            else if (v.touching != (g.gap < 0)) wrong++;
            else if (v.touching) {
                under = fmax(under, (-g.gap - v.depth)/size);
                if (-g.gap > 1e-12*size) excess = fmax(excess, v.depth/-g.gap);
            } else over = fmax(over, (-v.depth - g.gap)/size);
        }
        CHECK_EQ(wrong, 0);
        CHECK_EQ(unsure, 0);
        CHECK_NEAR(under, 0, 1e-14);
        CHECK_NEAR(over, 0, 1e-14);
        CHECK(steps < 200);
        if (count > 200) {
            CHECK(touching > count*2/5 && touching < count*7/10 && close < count/6 && near_by > count/4);
            for (i = 0; i < CONVEX_KINDS; i++) CHECK(kinds[i] > count/20);
        }
        if (numbers)
            printf("%d pairs: %d touching, %d within 2e-6, %d within 1e-14; wrong %d, unsure %d, started again %d, at "
                   "most %d support points; depth short by %.2g, width over by %.2g, depth at most %.3g times the true one\n",
                   count, touching, near_by, close, wrong, unsure, again, steps, under, over, excess);
    }
    return test_end();
}
