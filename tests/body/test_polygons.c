/* Polygons of planar worlds, and unions: mass properties against closed forms, what is refused, contacts that conserve
   energy, blocks on slopes, the same bits. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;
static const dem_quat straight = {1, 0, 0, 0};
static const dem_real ell[12] = {0, 0, DEM_R(0.02), 0, DEM_R(0.02), DEM_R(0.006), DEM_R(0.006), DEM_R(0.006), DEM_R(0.006),
                                 DEM_R(0.02), 0, DEM_R(0.02)};     /* an L, m */

static dem_world *flat(double weight, int impulses, dem_material *m, double restitution, double friction) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e8, restitution, friction, 0);
    dem_world *w;
    desc.planar = 1;
    desc.thickness = DEM_R(0.01);
    desc.gravity.y = (dem_real)-weight;
    desc.ledger = 1;
    if (impulses) {
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-3);
        desc.tolerance = fine ? DEM_R(1e-9) : DEM_R(1e-6);
    }
    w = dem_world_create(&desc);
    *m = dem_material_add(w, &stuff);
    return w;
}
/* A star of so many points. */
static void star(int points, double inner, double outer, dem_real *x) {
    int k;
    for (k = 0; k < 2*points; k++) {
        const double r = k%2 ? inner : outer, a = 3.14159265358979*k/points;
        x[2*k] = (dem_real)(r*cos(a));
        x[2*k + 1] = (dem_real)(r*sin(a));
    }
}
/* A brick of two halves side by side. */
static dem_shape halves_add(dem_world *w, double a, double b, double c) {
    const dem_shape half = scene_box(w, a/2, b, c);
    dem_shape two[2];
    dem_real x[6];
    two[0] = two[1] = half;
    memset(x, 0, sizeof x);
    x[0] = (dem_real)(-a/4);
    x[3] = (dem_real)(a/4);
    return dem_shape_union_add(w, 2, two, x, 0);
}
static double stored(const dem_world *w) {
    const dem_ledger l = dem_ledger_get(w);
    return (double)(l.kinetic + l.rotational + l.elastic);
}
/* Ls, stars, hexagons and discs that fall into a box. */
static dem_world *heap(int impulses) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e8, 0.4, 0.5, 0);
    dem_real five[20], six[12];
    dem_shape shapes[3];
    dem_material m;
    dem_world *w;
    int k;
    desc.planar = 1;
    desc.thickness = DEM_R(0.01);
    desc.gravity.y = DEM_R(-9.81);
    desc.threads = 1;
    if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = impulses ? DEM_R(1e-3) : DEM_R(5e-6);
    w = dem_world_create(&desc);
    m = dem_material_add(w, &stuff);
    star(5, 0.005, 0.012, five);
    for (k = 0; k < 6; k++) {
        six[2*k] = (dem_real)(0.008*cos(1.0471976*k));
        six[2*k + 1] = (dem_real)(0.008*sin(1.0471976*k));
    }
    shapes[0] = dem_shape_polygon_add(w, 6, ell);
    shapes[1] = dem_shape_polygon_add(w, 10, five);
    shapes[2] = dem_shape_polygon_add(w, 6, six);
    for (k = 0; k < 3; k++)
        dem_wall_plane_add(w, m, at(k == 1 ? -0.06 : k == 2 ? 0.06 : 0, 0, 0), at(k == 1 ? 1 : k == 2 ? -1 : 0, k ? 0 : 1, 0));
    for (k = 0; k < 24; k++) {
        const dem_vec3 x = at(-0.045 + 0.03*(k%4), 0.016 + 0.03*(k/4), 0);
        dem_body b = k%4 == 3 ? dem_sphere_add(w, m, DEM_R(0.007), x)
            : dem_body_add(w, m, shapes[k%4], x, dem_quat_about(at(0, 0, 1), DEM_R(1)*k));
        scene_move(w, b, at(0, -1, 0), at(0, 0, 3));
    }
    return w;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("polygons: area, centre and moment of an L, a star and 98 corners equal the closed forms, in either winding") {
        dem_material m;
        dem_world *w = flat(0, 0, &m, 1, 0);
        dem_shape_info info;
        dem_real x[196], back[12];
        /* the L as two rectangles: 20 x 6 mm, and 6 x 14 mm on it */
        const double A[2] = {1.2e-4, 0.84e-4}, cx[2] = {0.01, 0.003}, cy[2] = {0.003, 0.013}, area = A[0] + A[1];
        const double X = (A[0]*cx[0] + A[1]*cx[1])/area, Y = (A[0]*cy[0] + A[1]*cy[1])/area;
        const double I = A[0]*((4e-4 + 0.36e-4)/12 + (cx[0] - X)*(cx[0] - X) + (cy[0] - Y)*(cy[0] - Y)) +
            A[1]*((0.36e-4 + 1.96e-4)/12 + (cx[1] - X)*(cx[1] - X) + (cy[1] - Y)*(cy[1] - Y));
        int k, turn;
        for (turn = 0; turn < 2; turn++) {
            for (k = 0; k < 6; k++) {
                back[2*k] = ell[2*(turn ? 5 - k : k)];
                back[2*k + 1] = ell[2*(turn ? 5 - k : k) + 1];
            }
            CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 6, back), &info), DEM_OK);
            CHECK_REL((double)info.volume, area*0.01, fine ? 1e-12 : 1e-5);
            CHECK_NEAR((double)info.centre.x - X, 0, fine ? 1e-15 : 1e-8);
            CHECK_NEAR((double)info.centre.y - Y, 0, fine ? 1e-15 : 1e-8);
            CHECK_REL((double)info.inertia.z, I*0.01, fine ? 1e-12 : 1e-5);
            CHECK_EQ(info.pieces, 2);
        }
        star(7, 0.004, 0.011, x);
        CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 14, x), &info), DEM_OK);
        CHECK_REL((double)info.volume, 7*0.004*0.011*sin(3.14159265358979/7)*0.01, fine ? 1e-12 : 1e-5);
        CHECK_NEAR((double)demi_length(info.centre), 0, fine ? 1e-15 : 1e-8);
        for (k = 0; k < 98; k++) {
            x[2*k] = (dem_real)(0.01*cos(6.28318530717959*k/98));
            x[2*k + 1] = (dem_real)(0.01*sin(6.28318530717959*k/98));
        }
        CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 98, x), &info), DEM_OK);
        CHECK_REL((double)info.volume, 49e-6*sin(6.28318530717959/98), fine ? 1e-12 : 1e-5);
        CHECK_REL((double)info.inertia.z, (double)info.volume*1e-4/6*(2 + cos(6.28318530717959/98)), fine ? 1e-12 : 1e-5);
        CHECK_EQ(info.pieces, 0);
        dem_world_destroy(w);
    }

    TEST("polygons with crossing sides, zero area, too few corners or in a 3D world are rejected and leave no pieces") {
        const dem_real bow[8] = {0, 0, 1, 1, 1, 0, 0, 1}, line[6] = {0, 0, 1, 1, 2, 2};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material m;
        dem_world *w = flat(0, 0, &m, 1, 0);
        CHECK(!dem_shape_polygon_add(w, 4, bow).id);
        CHECK_STR(dem_world_error_get(w), "from point 0 and from point 2 cross");
        CHECK(!dem_shape_polygon_add(w, 3, line).id);
        CHECK_STR(dem_world_error_get(w), "dem_shape_polygon_add");
        CHECK(!dem_shape_polygon_add(w, 2, line).id);
        CHECK_STR(dem_world_error_get(w), "must be 3 to 98");
        CHECK(!dem_shape_polygon_add(w, 3, 0).id);
        CHECK_EQ(w->shape_count, 0);
        dem_world_destroy(w);
        w = dem_world_create(&desc);
        CHECK(!dem_shape_polygon_add(w, 6, ell).id);
        CHECK_STR(dem_world_error_get(w), "not planar");
        dem_world_destroy(w);
    }

    TEST("polygons with collinear sides, such as a U, plus, E and comb, are cut; overlapping sides are rejected") {
        const dem_real u[16] = {0, 0, 3, 0, 3, 3, 2, 3, 2, 1, 1, 1, 1, 3, 0, 3};
        const dem_real plus[24] = {1, 0, 2, 0, 2, 1, 3, 1, 3, 2, 2, 2, 2, 3, 1, 3, 1, 2, 0, 2, 0, 1, 1, 1};
        const dem_real e[24] = {0, 0, 3, 0, 3, 1, 1, 1, 1, 2, 3, 2, 3, 3, 1, 3, 1, 4, 3, 4, 3, 5, 0, 5};
        const dem_real back[10] = {0, 0, 2, 0, 2, 1, 2, 0, 0, 1};
        dem_real comb[196];
        dem_material m;
        dem_world *w = flat(0, 0, &m, 1, 0);
        dem_shape_info info;
        int k;
        CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 8, u), &info), DEM_OK);
        CHECK_REL((double)info.volume, 7*0.01, fine ? 1e-12 : 1e-5);
        CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 12, plus), &info), DEM_OK);
        CHECK_REL((double)info.volume, 5*0.01, fine ? 1e-12 : 1e-5);
        CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 12, e), &info), DEM_OK);
        CHECK_REL((double)info.volume, 11*0.01, fine ? 1e-12 : 1e-5);
        comb[0] = 0; comb[1] = 0; comb[2] = 48; comb[3] = 0;
        for (k = 0; k < 96; k++) {              /* 24 teeth, from the right */
            comb[4 + 2*k] = (dem_real)(48 - (k + 1)/2);
            comb[5 + 2*k] = k/2%2 ? 1 : 3;
        }
        CHECK_EQ(dem_shape_get(w, dem_shape_polygon_add(w, 98, comb), &info), DEM_OK);
        CHECK_REL((double)info.volume, (48*1 + 24*2)*0.01, fine ? 1e-12 : 1e-5);
        CHECK(!dem_shape_polygon_add(w, 5, back).id);
        CHECK_STR(dem_world_error_get(w), "cross or touch");
        dem_world_destroy(w);
    }

    TEST("unions: two half bricks have the mass and moments of a whole one; clusters, unions and bad positions are "
         "rejected") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w = dem_world_create(&desc);
        dem_cluster_desc pair = DEM_CLUSTER_DESC;
        dem_shape one = scene_box(w, 0.03, 0.02, 0.01), two = halves_add(w, 0.03, 0.02, 0.01), ball;
        dem_real x[6] = {0, 0, 0, DEM_R(0.003), 0, 0}, far[3] = {(dem_real)INFINITY, 0, 0}, none[4] = {0, 0, 0, 0};
        dem_shape_info a, b;
        pair.count = 2;
        pair.positions = x;
        pair.radius = DEM_R(0.002);
        ball = dem_shape_cluster_add(w, &pair);
        CHECK_EQ(dem_shape_get(w, one, &a), DEM_OK);
        CHECK_EQ(dem_shape_get(w, two, &b), DEM_OK);
        CHECK_EQ(b.pieces, 2);
        CHECK_REL((double)b.volume, (double)a.volume, fine ? 1e-13 : 1e-5);
        CHECK_REL((double)b.inertia.x, (double)a.inertia.x, fine ? 1e-12 : 1e-5);
        CHECK_REL((double)b.inertia.y, (double)a.inertia.y, fine ? 1e-12 : 1e-5);
        CHECK_REL((double)b.inertia.z, (double)a.inertia.z, fine ? 1e-12 : 1e-5);
        CHECK_REL((double)b.radius, (double)a.radius, fine ? 1e-12 : 1e-5);
        CHECK(!dem_shape_union_add(w, 1, &ball, x, 0).id);
        CHECK_STR(dem_world_error_get(w), "is a cluster or a union");
        CHECK(!dem_shape_union_add(w, 1, &two, x, 0).id);
        CHECK(!dem_shape_union_add(w, 1, &one, far, 0).id);
        CHECK_STR(dem_world_error_get(w), "piece 0");
        CHECK(!dem_shape_union_add(w, 1, &one, x, none).id);
        CHECK(!dem_shape_union_add(w, 0, &one, x, 0).id);
        CHECK(!dem_shape_union_add(w, 1, &one, 0, 0).id);
        dem_world_destroy(w);
    }

    TEST("unions: elastic crosses of bricks, planar Ls, stars and a disc conserve energy, better at smaller steps") {
        double error[2];
        int k, space;
        for (space = 0; space < 2 && fine; space++) {
            for (k = 0; k < 2; k++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material_desc stuff = scene_stuff(2e7, 1, 0, 0);
                dem_world *w;
                dem_material m;
                dem_shape shapes[2];
                dem_real x[20];
                double before;
                int i;
                desc.planar = !space;
                desc.thickness = DEM_R(0.01);
                desc.ledger = 1;
                desc.dt = k ? DEM_R(1e-6) : DEM_R(4e-6);
                w = dem_world_create(&desc);
                m = dem_material_add(w, &stuff);
                if (space) {
                    const dem_shape brick = scene_box(w, 0.02, 0.006, 0.006);
                    dem_shape cross[3];
                    const dem_real places[9] = {0, 0, 0, 0, DEM_R(0.003), 0, 0, 0, DEM_R(0.004)};
                    const dem_real turns[12] = {1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0};
                    cross[0] = cross[1] = brick;
                    cross[2] = dem_shape_ellipsoid_add(w, at(0.004, 0.005, 0.006));
                    shapes[0] = shapes[1] = dem_shape_union_add(w, 3, cross, places, turns);
                } else {
                    star(5, 0.005, 0.012, x);
                    shapes[0] = dem_shape_polygon_add(w, 6, ell);
                    shapes[1] = dem_shape_polygon_add(w, 10, x);
                }
                for (i = 0; i < (space ? 6 : 4); i++) {
                    const double side = i & 1 ? 0.04 : -0.04, n = i & 1 ? -1 : 1;
                    dem_wall_plane_add(w, m, at(i/2 == 0 ? side : 0, i/2 == 1 ? side : 0, i/2 == 2 ? side : 0),
                                  at(i/2 == 0 ? n : 0, i/2 == 1 ? n : 0, i/2 == 2 ? n : 0));
                }
                for (i = 0; i < 5; i++) {
                    const dem_vec3 place = at(i == 4 ? 0 : i & 1 ? 0.02 : -0.02, i == 4 ? 0 : i & 2 ? 0.02 : -0.02, 0);
                    const dem_body b = i == 4 ? dem_sphere_add(w, m, DEM_R(0.006), place)
                        : dem_body_add(w, m, shapes[i%2], place, dem_quat_about(at(0, 0, 1), DEM_R(1)*i));
                    scene_move(w, b, at(cos(1.0 + i), sin(1.0 + i), 0), at(0, 0, 20.0*i - 40));
                }
                scene_step(w, 1);
                before = stored(w);
                CHECK_EQ(dem_world_run_to(w, 0.1, 0, 0), DEM_OK);
                error[k] = fabs(stored(w)/before - 1);
                if (getenv("POLYGONS_NUMBERS")) printf("%s, dt %g: %g\n", space ? "space" : "plane", (double)desc.dt, error[k]);
                dem_world_destroy(w);
            }
            CHECK(error[1] < error[0]/2 && error[1] < 1e-6);
        }
        CHECK(1);
    }

    TEST("unions: an elastic pair of ellipsoids keeps its energy as it bounces from a plane, a cylinder or a grain") {
        int kind;
        for (kind = 0; kind < 3 && fine; kind++) {
            const dem_real apart[6] = {DEM_R(0.3e-3), 0, 0, DEM_R(-0.3e-3), 0, 0}, grain[3] = {0, 0, 0};
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(2e6, 1, 0, 0);
            dem_shape two[2];
            dem_world *w;
            dem_material m;
            dem_body b;
            double before;
            desc.ledger = 1;
            desc.dt = DEM_R(5e-7);
            w = dem_world_create(&desc);
            m = dem_material_add(w, &stuff);
            two[0] = two[1] = dem_shape_ellipsoid_add(w, at(0.7e-3, 0.7e-3, 0.5e-3));
            if (kind == 0) CHECK(dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1)).id);
            if (kind == 1) CHECK(dem_wall_cylinder_add(w, m, at(0, 0, 5e-3), at(0, 1, 0), DEM_R(5e-3), 1).id);
            if (kind == 2) CHECK(dem_wall_grains_add(w, m, 1, grain, DEM_R(1e-3), 1).id);
            b = dem_body_add(w, m, dem_shape_union_add(w, 2, two, apart, 0), at(0, 0, kind == 2 ? 2.2e-3 : 1.2e-3),
                             dem_quat_make(DEM_R(0.8), -1, DEM_R(-0.7), 0));
            scene_move(w, b, at(0, 0, -1), at(0, 0, 0));
            before = stored(w);
            CHECK_EQ(dem_world_step(w, 1600), DEM_OK);
            if (getenv("POLYGONS_NUMBERS")) printf("union, wall %d: %g, spins %g\n", kind, stored(w)/before - 1,
                                                   dem_ledger_get(w).rotational/before);
            CHECK_NEAR(stored(w)/before, 1, 1e-5);      /* 0.12 off if the arm begins at the centre of the body */
            CHECK(dem_ledger_get(w).rotational > 0.01*before);
            dem_world_destroy(w);
        }
        CHECK(1);
    }

    TEST("polygons: elastic squares and hexagons that hit the end of a line from any side recover their energy") {
        double worst = 0, left = 0;
        int k;
        for (k = 0; k < 60 && fine; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(2e7, 1, 0, 0);
            dem_real line[4] = {0, 0, 0, 0}, corner[12];
            int32_t ends[2] = {0, 1};
            const int corners = k%2 ? 6 : 4;
            const double turn = 0.37*k, way = 3.14159265358979*(k%12 - 2)/10, off = 0.01*(k%7 - 3)/3.2;
            dem_profile profile;
            dem_world *w;
            dem_body b;
            dem_material m;
            double before;
            int i;
            desc.planar = 1;
            desc.thickness = DEM_R(0.01);
            desc.ledger = 1;
            desc.dt = DEM_R(2e-6);
            w = dem_world_create(&desc);
            m = dem_material_add(w, &stuff);
            line[k%3 ? 3 : 2] = DEM_R(-0.2);
            profile.vertex_count = 2;
            profile.segment_count = 1;
            profile.vertices = line;
            profile.segments = ends;
            CHECK(dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED).id);
            for (i = 0; i < corners; i++) {
                corner[2*i] = (dem_real)(0.01*cos(6.28318530717959*i/corners));
                corner[2*i + 1] = (dem_real)(0.01*sin(6.28318530717959*i/corners));
            }
            b = dem_body_add(w, m, dem_shape_polygon_add(w, corners, corner),
                             at(0.02*cos(way) - off*sin(way), 0.02*sin(way) + off*cos(way), 0),
                             dem_quat_about(at(0, 0, 1), (dem_real)turn));
            scene_move(w, b, at(-cos(way), -sin(way), 0), at(0, 0, 20*sin(3*turn)));
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            before = stored(w);
            CHECK_EQ(dem_world_run(w, 0.08, 0, 0), DEM_OK);
            left += !(dem_ledger_get(w).elastic > 0);
            worst = fmax(worst, fabs(stored(w)/before - 1));
            dem_world_destroy(w);
        }
        if (getenv("POLYGONS_NUMBERS")) printf("ends of lines: worst %.2g of the energy, %g of 60 have left\n", worst, left);
        CHECK(worst < 1e-6);                    /* 3e-8; without curtains 49 */
        CHECK(!fine || left > 50);
    }

    TEST("unions: a brick of two halves slides down a slope as a whole one, under springs and impulses, in 2D too") {
        int k, impulses;
        for (k = 0; k < 3; k++)
            for (impulses = 0; impulses < 2; impulses++) {
                const double angle = 0.6, mu = 0.4, weight = 9.81;
                const dem_real brick[8] = {DEM_R(-0.015), DEM_R(-0.005), DEM_R(0.015), DEM_R(-0.005), DEM_R(0.015),
                                           DEM_R(0.005), DEM_R(-0.015), DEM_R(0.005)};
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material_desc stuff = scene_stuff(1e8, 0.2, mu, 0);
                dem_world *w;
                dem_material m;
                dem_body b;
                double v0;
                desc.planar = k == 2;
                desc.thickness = DEM_R(0.01);
                desc.dt = impulses ? DEM_R(1e-3) : DEM_R(5e-6);
                if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
                if (impulses && fine) desc.tolerance = DEM_R(1e-9);
                desc.gravity = at(weight*sin(angle), -weight*cos(angle), 0);
                w = dem_world_create(&desc);
                m = dem_material_add(w, &stuff);
                dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 1, 0));
                b = dem_body_add(w, m, k == 2 ? dem_shape_polygon_add(w, 4, brick)
                                 : k ? halves_add(w, 0.03, 0.01, 0.02) : scene_box(w, 0.03, 0.01, 0.02), at(0, 0.005, 0), straight);
                CHECK(b.slot);
                CHECK_EQ(dem_world_run_to(w, 0.1, 0, 0), DEM_OK);
                v0 = (double)scene_state(w, b).velocity.x;
                CHECK_EQ(dem_world_run_to(w, 0.15, 0, 0), DEM_OK);
                CHECK_NEAR(((double)scene_state(w, b).velocity.x - v0)/0.05, weight*(sin(angle) - mu*cos(angle)), fine ? 5e-3 : 5e-2);
                CHECK_NEAR((double)demi_length(scene_state(w, b).spin), 0, 1e-2);
                dem_world_destroy(w);
            }
    }

    TEST("polygons: a planar heap stays exactly in its plane, by springs and by impulses") {
        int i, impulses;
        for (impulses = 0; impulses < 2; impulses++) {
            dem_world *w = heap(impulses);
            double off = 0;
            CHECK_EQ(scene_step(w, impulses ? 150 : 6000), DEM_OK);
            CHECK(dem_counters_get(w).contacts > (impulses ? 10 : 0));
            for (i = 0; i < w->bodies.count; i++)
                off = fmax(off, fabs((double)w->bodies.pos[4*i + 2]) + fabs((double)w->bodies.spin[4*i]) +
                                fabs((double)w->bodies.spin[4*i + 1]));
            CHECK_NEAR(off, 0, 0);
            dem_world_destroy(w);
        }
    }

    TEST("unions: the semi-axes of a union follow from its moments, whichever piece comes first") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w = dem_world_create(&desc);
        dem_shape pieces[2][2];
        dem_real x[2][6] = {{0, 0, 0, DEM_R(0.01), 0, 0}, {DEM_R(0.01), 0, 0, 0, 0, 0}};
        dem_shape_info a, b;
        pieces[0][0] = pieces[1][1] = dem_shape_ellipsoid_add(w, at(0.01, 0.008, 0.006));
        pieces[0][1] = pieces[1][0] = scene_box(w, 0.01, 0.01, 0.01);
        CHECK_EQ(dem_shape_get(w, dem_shape_union_add(w, 2, pieces[0], x[0], 0), &a), DEM_OK);
        CHECK_EQ(dem_shape_get(w, dem_shape_union_add(w, 2, pieces[1], x[1], 0), &b), DEM_OK);
        /* I = V (b^2 + c^2)/5 of an ellipsoid, for the union's own V */
        CHECK_REL(a.semi_axes.x, sqrt(2.5*(double)((a.inertia.y + a.inertia.z - a.inertia.x)/a.volume)),
                  fine ? 1e-12 : 1e-4);
        CHECK_REL(a.semi_axes.x, (double)b.semi_axes.x, fine ? 1e-9 : 1e-4);
        CHECK_REL(a.semi_axes.y, (double)b.semi_axes.y, fine ? 1e-9 : 1e-4);
        CHECK_REL(a.semi_axes.z, (double)b.semi_axes.z, fine ? 1e-9 : 1e-4);
        CHECK(a.semi_axes.z > DEM_R(0.004));
        dem_world_destroy(w);
    }

    return test_end();
}
