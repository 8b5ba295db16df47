/* Periodic cells that deform: flow, images, stress, targets, energy; every shape and search. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* A periodic cube of side `side` (m), with springs. */
static dem_world_desc cell_desc(double side) {
    dem_world_desc desc = DEM_WORLD_DESC;
    int k;
    desc.domain = box_of(0, 0, 0, side, side, side);
    for (k = 0; k < 3; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    desc.threads = 1;
    return desc;
}
static dem_cell_desc cell_rates(double x, double y, double z, double shear) {
    dem_cell_desc d = DEM_CELL_DESC;
    d.rate = at(x, y, z);
    d.shear = (dem_real)shear;
    return d;
}
static dem_cell_desc cell_targets(double stress, double most) {
    dem_cell_desc d = DEM_CELL_DESC;
    d.stress = at(stress, stress, stress);
    d.rate_most = at(most, most, most);
    return d;
}
/* Adds a part that cannot follow a cell: a wall, a rail, a feed, an outlet, a field. Returns 1 if the world takes it. */
static int cell_part_add(dem_world *w, int part, dem_material m, dem_body body) {
    const dem_box box = box_of(0.1, 0.1, 0.1, 0.3, 0.3, 0.3);
    dem_rail_desc rail = DEM_RAIL_DESC;
    dem_feed_desc feed = DEM_FEED_DESC;
    dem_outlet_desc outlet = DEM_OUTLET_DESC;
    dem_field_desc field = DEM_FIELD_DESC;
    rail.axes = DEM_RAIL_X;
    feed.material = m;
    feed.class_count = 1;
    feed.radius[0] = DEM_R(0.01);
    feed.amount[0] = feed.rate = 1;
    feed.box = outlet.box = field.box = box;
    field.cells[0] = field.cells[1] = field.cells[2] = 1;
    switch (part) {
    case 0: return dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1)).id > 0;
    case 1: return dem_body_rail_set(w, body, &rail) == DEM_OK;
    case 2: return dem_feed_add(w, &feed).id > 0;
    case 3: return dem_outlet_add(w, &outlet).id > 0;
    default: return dem_field_add(w, &field).id > 0;
    }
}
/* Returns the error of x, m, of a sphere after 0.4 s of free flight in a cell that is sheared or compressed. */
static double cell_flight(int compressed, dem_integrator integrator, double dt) {
    dem_world_desc desc = cell_desc(1);
    const dem_cell_desc d = compressed ? cell_rates(-0.5, -0.25, 0.1, 0) : cell_rates(0, 0, 0, 2);
    dem_world *w;
    dem_body b;
    double t, x;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    desc.integrator = integrator;
    w = dem_world_create(&desc);
    b = dem_sphere_add(w, scene_material(w, 1e3, 0.5, 0, 0), DEM_R(0.01), at(0.4, 0.4, 0.4));
    scene_move(w, b, at(0.2, 0.15, 0), at(0, 0, 0));
    CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
    CHECK_EQ(dem_world_run(w, 0.4, 0, 0), DEM_OK);
    t = dem_world_time_get(w);
    x = compressed ? 0.5 - 0.1*exp(-0.5*t) + 0.4*sinh(0.5*t) : 0.4;     /* shear: 0.2 m/s - 2/s * 0.1 m = 0 */
    x = fabs((double)scene_state(w, b).position.x - x);
    dem_world_destroy(w);
    return x;
}
/* Returns the residual of 64 elastic spheres after 15 ms in a cell that is sheared, compressed or led, relative to the
   energy that went through it. */
static double cell_residual(int how, uint64_t seed, double dt) {
    dem_world_desc desc = cell_desc(0.1);
    const dem_cell_desc d = how == 0 ? cell_rates(0, 0, 0, 50) : how == 1 ? cell_rates(-8, -8, -8, 0) : cell_targets(2e4, 5);
    dem_world *w;
    dem_material m;
    dem_ledger l;
    int i;
    desc.dt = (dem_real)dt;
    desc.ledger = 1;
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 1, 0, 0);
    for (i = 0; i < 64; i++) {
        const dem_vec3 x = scene_at(&seed, 0.004, 0.025*(i%4 + 0.4), 0.004, 0.025*(i/4%4 + 0.4), 0.004, 0.025*(i/16 + 0.4));
        scene_move(w, dem_sphere_add(w, m, DEM_R(0.008), x), scene_at(&seed, 4, -2, 4, -2, 4, -2), at(0, 0, 0));
    }
    CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
    CHECK_EQ(dem_world_run(w, 0.015, 0, 0), DEM_OK);
    l = dem_ledger_get(w);
    CHECK(fabs(l.cell) > 0.05*l.throughput);
    dem_world_destroy(w);
    return l.residual/l.throughput;
}
/* Shapes of the mixed scene; the last one is mixed spheres of two sizes. */
enum { CELL_SPHERES, CELL_ELLIPSOIDS, CELL_CLUSTERS, CELL_HULLS, CELL_SIZES, CELL_SHAPES };
/* 64 bodies in a cube of side 0.1 m, dense, every position moved by `by`; the search as given. */
static dem_world *cell_scene(int shape, dem_vec3 by, dem_search search, int ledger, dem_integrator integrator) {
    dem_world_desc desc = cell_desc(0.1);
    dem_world *w;
    dem_material m;
    dem_shape s = {0};
    const dem_real parts[9] = {DEM_R(-0.005), 0, 0, DEM_R(0.005), 0, 0, 0, DEM_R(0.006), 0};
    const dem_real radii[3] = {DEM_R(0.01), DEM_R(0.009), DEM_R(0.008)};
    uint64_t seed = 7;
    int i;
    desc.search = search;
    desc.threads = 1;
    desc.ledger = ledger;
    desc.integrator = integrator;
    desc.dt = DEM_R(1e-5);
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 0.5, 0.4, 0.05);
    if (shape == CELL_ELLIPSOIDS) s = dem_shape_ellipsoid_add(w, at(0.015, 0.012, 0.01));
    if (shape == CELL_HULLS) s = scene_box(w, 0.02, 0.019, 0.022);
    if (shape == CELL_CLUSTERS) {
        dem_cluster_desc c = DEM_CLUSTER_DESC;
        c.count = 3;
        c.positions = parts;
        c.radii = radii;
        s = dem_shape_cluster_add(w, &c);
    }
    for (i = 0; i < 64; i++) {
        const dem_vec3 x = scene_at(&seed, 0.002, 0.025*(i%4 + 0.5), 0.002, 0.025*(i/4%4 + 0.5), 0.002, 0.025*(i/16 + 0.5));
        const dem_vec3 v = scene_at(&seed, 0.4, -0.2, 0.4, -0.2, 0.4, -0.2), to = demi_add(x, by);
        const dem_quat q = scene_turn(&seed);
        const dem_body id = shape == CELL_SPHERES || shape == CELL_SIZES
            ? dem_sphere_add(w, m, (dem_real)(shape == CELL_SPHERES ? 0.0128 : i%8 ? 0.0095 : 0.016), to)
            : dem_body_add(w, m, s, to, q);
        scene_move(w, id, v, at(0, 0, 0));
    }
    return w;
}
/* Positions relative to the first body, by nearest images in the cell as it is, and velocities: 6 numbers per body. */
static void cell_state(const dem_world *w, double *out) {
    const demi_periods p = demi_periods_of(w);
    const dem_bodies b = dem_bodies_get(w);
    int i, k, first = 0;
    for (i = 0; i < b.count; i++) if (b.slots[i] == 0) first = i;
    for (i = 0; i < b.count; i++) {
        const dem_vec3 d = demi_sub(demi_at(b.positions + 4*i), demi_at(b.positions + 4*first));
        dem_real x[3];
        demi_put(x, demi_nearest(&p, d));
        for (k = 0; k < 3; k++) {
            out[6*b.slots[i] + (uint32_t)k] = (double)x[k];
            out[6*b.slots[i] + 3 + (uint32_t)k] = (double)b.velocities[4*i + k];
        }
    }
}
static dem_stress cell_stress(const dem_world *w) {
    dem_stress s;
    memset(&s, 0, sizeof s);
    CHECK_EQ(dem_stress_get(w, &s), DEM_OK);
    return s;
}
static dem_cell_state cell_of(const dem_world *w) {
    dem_cell_state c;
    memset(&c, 0, sizeof c);
    CHECK_EQ(dem_cell_state_get(w, &c), DEM_OK);
    return c;
}
static void cell_step(dem_world *w, int steps) {
    if (dem_world_step(w, steps) != DEM_OK) { CHECK(0); puts(dem_world_error_get(w)); }
}
static const int fine = sizeof(dem_real) == 8;

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a body at rest follows the flow, and one that moves keeps its whole velocity in shear") {
        dem_world_desc desc = cell_desc(1);
        dem_world *w;
        dem_material m;
        dem_body a, b;
        dem_cell_desc d = cell_rates(0.5, -0.25, 0.1, 0);
        dem_body_state s;
        double f[3] = {1, 1, 1}, v;
        int i;
        desc.dt = DEM_R(1e-4);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e6, 0.5, 0, 0);
        a = dem_sphere_add(w, m, DEM_R(0.01), at(0.75, 0.75, 0.25));
        CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
        cell_step(w, 2000);
        for (i = 0; i < 2000; i++) { f[0] *= 1 + 0.5e-4 + 0.125e-8; f[1] *= 1 - 0.25e-4 + 0.03125e-8; f[2] *= 1 + 0.1e-4 + 0.005e-8; }
        s = scene_state(w, a);
        CHECK_NEAR(s.position.x, 0.5 + 0.25*f[0], fine ? 1e-12 : 1e-4);
        CHECK_NEAR(s.position.y, 0.5 + 0.25*f[1], fine ? 1e-12 : 1e-4);
        CHECK_NEAR(s.position.z, 0.5 - 0.25*f[2], fine ? 1e-12 : 1e-4);
        CHECK_NEAR(cell_of(w).box.hi.x, 0.5 + 0.5*f[0], fine ? 1e-12 : 1e-6);
        CHECK_NEAR(cell_of(w).strain[1], log(f[1]), fine ? 1e-12 : 1e-7);
        dem_world_destroy(w);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e6, 0.5, 0, 0);
        b = dem_sphere_add(w, m, DEM_R(0.01), at(0.5, 0.5, 0.5));
        scene_move(w, b, at(0.2, 0.3, 0), at(0, 0, 0));
        d = cell_rates(0, 0, 0, 2);
        CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
        cell_step(w, 10000);
        s = scene_state(w, b);                  /* 0.3 m along y: x moves by 0.2, c by -2*0.3 */
        v = (double)s.velocity.x + 2*((double)s.position.y - 0.5);
        CHECK_NEAR(v, 0.2, fine ? 1e-9 : 1e-3);
        CHECK_NEAR(s.velocity.y, 0.3, fine ? 1e-12 : 1e-5);
        CHECK_NEAR(s.position.x, 0.7, fine ? 1e-9 : 1e-3);
        CHECK_NEAR(s.position.y, 0.8, fine ? 1e-9 : 1e-3);
        CHECK_NEAR(cell_of(w).shear, 2, fine ? 1e-9 : 1e-6);
        dem_world_destroy(w);
    }
    TEST("free flight in a deforming cell is exact in shear and of second order in compression") {
        static const dem_integrator schemes[] = {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_INTEGRATOR_POSITION_VERLET, DEM_INTEGRATOR_LEAPFROG,
                                                 DEM_INTEGRATOR_SYMPLECTIC_EULER, DEM_INTEGRATOR_FORWARD_EULER};
        int i;
        for (i = 0; i < 5; i++) {
            CHECK_NEAR(cell_flight(0, schemes[i], 4e-3), 0, fine ? 1e-11 : 1e-4);
            if (fine && i < 3) {
                const double coarse = cell_flight(1, schemes[i], 4e-3), half = cell_flight(1, schemes[i], 2e-3);
                CHECK_NEAR(coarse/half, 4, 0.2);
                CHECK_NEAR(half/cell_flight(1, schemes[i], 1e-3), 4, 0.2);
            }
        }
    }
    TEST("the residual of an elastic gas is of second order in sheared, compressed and led cells") {
        int how;
        for (how = 0; how < 3; how++) {
            double off[3] = {0, 0, 0};          /* root mean square over scenes: instants of impacts scatter single ones */
            uint64_t seed;
            int k;
            for (k = 0; k < 3; k++) {
                for (seed = 1; seed < 9; seed++) off[k] += pow(cell_residual(how, seed, 1e-5/(1 << k)), 2)/8;
                off[k] = sqrt(off[k]);
            }
            if (fine) CHECK(off[0] > 3*off[1] && off[1] > 3*off[2]);
            CHECK_NEAR(off[1], 0, fine ? 1e-5 : 1e-3);
        }
    }
    TEST("no place of the cell differs from another: a moved scene of any shape takes the same course") {
        static double one[384], other[384];
        int shape, k;
        for (shape = 0; shape < CELL_SHAPES; shape++) {
            double most = 0;
            dem_cell_desc d = cell_rates(-4, -2, 2, 100);
            dem_world *w = cell_scene(shape, at(0, 0, 0), DEM_SEARCH_AUTO, 0, DEM_INTEGRATOR_VELOCITY_VERLET);
            dem_world *t = cell_scene(shape, at(0.031, 0.047, 0.013), DEM_SEARCH_AUTO, 0, DEM_INTEGRATOR_VELOCITY_VERLET);
            CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
            CHECK_EQ(dem_cell_set(t, &d), DEM_OK);
            cell_step(w, 400);
            cell_step(t, 400);
            cell_state(w, one);
            cell_state(t, other);
            for (k = 0; k < 384; k++) most = fmax(most, fabs(one[k] - other[k]));
            CHECK(dem_counters_get(w).contacts > 10);
            if (fine) CHECK(most < 1e-7);
            dem_world_destroy(w);
            dem_world_destroy(t);
        }
    }
    TEST("the ledger closes in strain, shear and a led cell, for every shape") {
        int shape, k;
        for (shape = 0; shape < CELL_SHAPES; shape++)
            for (k = 0; k < 2; k++) {
                dem_cell_desc d = k ? cell_targets(2e4, 5) : cell_rates(-2, 1, -1, 20);
                dem_world *w = cell_scene(shape, at(0, 0, 0), DEM_SEARCH_AUTO, 1, DEM_INTEGRATOR_VELOCITY_VERLET);
                dem_ledger l;
                double before;                  /* overlaps at the start: not booked as inserted */
                CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
                cell_step(w, 1);
                before = dem_ledger_get(w).residual;
                cell_step(w, 800);
                l = dem_ledger_get(w);
                l.residual -= before;
                CHECK(fabs(l.cell) > 0.01*l.throughput);
                CHECK(fabs(l.residual) < (fine ? 2e-3 : 1e-2)*(l.throughput + before));
                dem_world_destroy(w);
            }
    }
    TEST("all searches give the same bits in a cell that is sheared and led") {
        const dem_search searches[] = {DEM_SEARCH_ALL_PAIRS, DEM_SEARCH_GRID, DEM_SEARCH_LINKED_LIST, DEM_SEARCH_HIERARCHICAL,
                                       DEM_SEARCH_BINS};
        dem_cell_desc d = cell_targets(1e4, 20);
        uint64_t hash = 0;
        int k, shape;
        d.shear = 100;
        for (shape = CELL_SIZES; shape >= CELL_ELLIPSOIDS; shape -= CELL_SIZES - CELL_CLUSTERS)
            for (k = 0; k < 5; k++) {
                dem_world *w = cell_scene(shape, at(0, 0, 0), searches[k], 0, DEM_INTEGRATOR_VELOCITY_VERLET);
                CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
                cell_step(w, 700);
                if (!k) hash = dem_world_hash_get(w);
                CHECK(dem_world_hash_get(w) == hash);
                CHECK_NEAR(cell_of(w).shear, 0.7, 1e-6);    /* past the nearest image: 0.5 */
                dem_world_destroy(w);
            }
    }
    TEST("a lattice of springs has the stress and the energy of its closed form, by any integrator") {
        /* simple cubic, spacing a: F = k (2 R - a) on each of three contacts per sphere, stress F/a^2 */
        static const dem_integrator schemes[] = {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_INTEGRATOR_SYMPLECTIC_EULER,
            DEM_INTEGRATOR_POSITION_VERLET, DEM_INTEGRATOR_LEAPFROG};
        int i, k, planar;
        for (k = 0; k < 8; k++) {
            dem_world_desc desc = cell_desc(0.1);
            dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
            dem_material m;
            dem_world *w;
            dem_stress s;
            dem_coefficients c;
            dem_cell_desc d;
            double a, f;
            planar = k > 3;
            desc.integrator = schemes[k%4];
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.planar = planar;
            desc.dt = DEM_R(1e-5);
            desc.thickness = DEM_R(0.02);
            if (planar) { desc.boundary[2] = DEM_BOUNDARY_OPEN; desc.domain.lo.z = desc.domain.hi.z = 0; }
            stuff.stiffness = 1000;
            w = dem_world_create(&desc);
            m = dem_material_add(w, &stuff);
            for (i = 0; i < (planar ? 16 : 64); i++)
                dem_sphere_add(w, m, DEM_R(0.0125), at(0.025*(i%4 + 0.5), 0.025*(i/4%4 + 0.5), planar ? 0 : 0.025*(i/16 + 0.5)));
            d = cell_rates(-1, -1, planar ? 0 : -1, 0);
            CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
            cell_step(w, 2000);
            a = 0.025*pow(1 - 1e-5 + 0.5e-10, 2000);
            f = 1000*(0.025 - a);
            s = cell_stress(w);
            CHECK_EQ(dem_coefficients_get(w, m, m, DEM_R(0.0125), DEM_R(0.0125), &c), DEM_OK);
            CHECK_REL(s.contact[0], (f + (double)c.cn*a)/(planar ? a*0.02 : a*a), fine ? 1e-4 : 2e-2);
            d = cell_rates(0, 0, 0, 0);
            CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
            cell_step(w, 1);
            s = cell_stress(w);
            CHECK_REL(s.contact[0], f/(planar ? a*0.02 : a*a), fine ? 1e-6 : 1e-2);
            CHECK_REL(s.contact[1], s.contact[0], fine ? 1e-9 : 1e-2);
            CHECK_NEAR(s.contact[3], 0, (fine ? 1e-9 : 1e-2)*s.contact[0]);
            CHECK_NEAR(s.fabric[0], planar ? 0.5 : 1.0/3, 1e-6);
            CHECK_EQ(s.contacts, planar ? 32 : 192);
            CHECK_REL(s.volume, planar ? 16*a*a*0.02 : 64*a*a*a, 1e-6);
            CHECK_NEAR(s.total[0] - s.contact[0], 0, fine ? 1e-9*s.contact[0] : 1);
            dem_world_destroy(w);
        }
    }
    TEST("a cell reaches its target stress along every axis, and the stress of a sum over contacts is that of the cell") {
        int shape, k;
        for (shape = 0; shape < CELL_SHAPES; shape++) {
            dem_cell_desc d = cell_targets(3e4, 20);
            dem_world *w = cell_scene(shape, at(0, 0, 0), DEM_SEARCH_AUTO, 0, DEM_INTEGRATOR_VELOCITY_VERLET);
            dem_stress s;
            d.stress.x = 2e4;
            CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
            cell_step(w, 3000);
            s = cell_stress(w);
            for (k = 0; k < 3; k++) {
                const double target = k ? 3e4 : 2e4;
                CHECK_REL(cell_of(w).stress[k], target, 2e-2);
                CHECK_REL(s.total[k], target, 2e-2);
            }
            cell_step(w, 1);                    /* looks at the state that s belongs to */
            for (k = 0; k < 3; k++) CHECK_REL(cell_of(w).stress[k], s.total[k], fine ? 1e-3 : 1e-2);
            dem_world_destroy(w);
        }
    }
    TEST("files and reports of a sheared cell: the lattice is inclined by the displacement of its images") {
        dem_cell_desc d = cell_rates(0, 0, 0, 40);
        dem_world *w = cell_scene(CELL_SPHERES, at(0, 0, 0), DEM_SEARCH_AUTO, 0, DEM_INTEGRATOR_VELOCITY_VERLET);
        const dem_real *x;
        double lattice[9] = {0};
        char line[400] = "";
        FILE *f;
        int i;
        CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
        cell_step(w, 500);
        CHECK_EQ(dem_xyz_write(w, "build/tmp/cell.xyz"), DEM_OK);
        f = fopen("build/tmp/cell.xyz", "r");
        CHECK(f && fgets(line, sizeof line, f) && fgets(line, sizeof line, f));
        if (f) fclose(f);
        CHECK_EQ(sscanf(line, "Lattice=\"%lf %lf %lf %lf %lf %lf %lf %lf %lf", lattice, lattice + 1, lattice + 2, lattice + 3,
                        lattice + 4, lattice + 5, lattice + 6, lattice + 7, lattice + 8), 9);
        CHECK_NEAR(lattice[3], 0.02, 1e-6);     /* 40 * 500 * 1e-5 * 0.1 m */
        CHECK_NEAR(lattice[4], 0.1, 1e-6);
        scene_report_has(w, "cell       strain 0 0 0, shear 0.2;");
        for (i = 0; i < 64; i++) {
            x = dem_bodies_get(w).positions + 4*i;
            CHECK(x[0] >= 0 && x[0] < DEM_R(0.1) && x[1] >= 0 && x[1] < DEM_R(0.1));
        }
        dem_world_destroy(w);
    }
    TEST("a cell and what cannot follow it refuse each other, whichever comes first, and the world steps on") {
        const char *const says[] = {"walls would not follow it", "bodies on rails would not follow", "the regions of feeds",
                                    "the regions of outlets", "fields would not follow it"};
        int part, k;
        for (part = 0; part < 5; part++)
            for (k = 0; k < 2; k++) {
                dem_world_desc desc = cell_desc(1);
                dem_cell_desc d = cell_rates(0.1, 0, 0, 0.1);
                dem_world *w = dem_world_create(&desc);
                dem_material m = scene_material(w, 1e6, 0.5, 0, 0);
                dem_body body = dem_sphere_add(w, m, DEM_R(0.01), at(0.5, 0.5, 0.5));
                if (k) {
                    CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
                    cell_step(w, 1);
                }
                CHECK(cell_part_add(w, part, m, body) == !k);
                if (!k) CHECK_EQ(dem_cell_set(w, &d), DEM_ERROR_ARGUMENT);
                CHECK_STR(dem_world_error_get(w), says[part]);
                cell_step(w, 1);
                dem_world_destroy(w);
            }
    }
    TEST("the cell refuses by name whatever cannot follow it") {
        dem_world_desc desc = cell_desc(1), open = cell_desc(1), hard = cell_desc(1);
        dem_cell_desc d = cell_rates(1, 0, 0, 1), both = cell_rates(1, 0, 0, 0);
        dem_slabs_desc slabs = DEM_SLABS_DESC;
        dem_region region = DEM_REGION;
        dem_world *w = dem_world_create(&desc);
        dem_material m = scene_material(w, 1e6, 0.5, 0, 0);
        dem_field_desc field = DEM_FIELD_DESC;
        dem_wall wall = dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(w, m, DEM_R(0.01), at(0.5, 0.5, 0.5));
        CHECK_EQ(dem_cell_set(w, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "dem_cell_set: the periodic cell deforms or is sheared (dem_cell_set), and walls would not follow it");
        CHECK_EQ(dem_wall_remove(w, wall), DEM_OK);
        both.rate_most.x = 1;
        CHECK_EQ(dem_cell_set(w, &both), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "axis 0 has the strain rate 1 1/s and the largest rate 1 1/s");
        both.rate.x = (dem_real)NAN;
        CHECK_EQ(dem_cell_set(w, &both), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "nan 1/s, must be >= -1e+15");   /* some compilers print -nan */
        CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
        cell_step(w, 3);
        slabs.count = 1;
        CHECK(!dem_slabs_create(w, &slabs));
        CHECK_STR(dem_world_error_get(w), "the periodic cell of this world has been deformed");
        region.box = box_of(0, 0, 0, 1, 1, 1);
        CHECK_EQ(dem_spheres_fill(w, m, DEM_R(0.01), region, 1, 1), 0);
        CHECK_STR(dem_world_error_get(w), "the periodic cell is sheared");
        field.box = box_of(0, 0, 0, 1, 1, 1);
        field.cells[0] = field.cells[1] = field.cells[2] = 1;
        CHECK_EQ(dem_field_add(w, &field).id, 0);
        CHECK_STR(dem_world_error_get(w), "dem_field_add: the periodic cell deforms or is sheared (dem_cell_set), and fields would not follow it: it is sheared");
        d = cell_rates(0, 0, -1e9, 0);
        dem_world_destroy(w);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e6, 0.5, 0, 0);
        dem_sphere_add(w, m, DEM_R(0.01), at(0.5, 0.5, 0.5));
        CHECK_EQ(dem_cell_set(w, &d), DEM_OK);
        CHECK_EQ(dem_world_step(w, 1), DEM_ERROR_TIME_STEP);
        CHECK_STR(dem_world_error_get(w), "must be at most 0.01");
        dem_world_destroy(w);
        open.boundary[1] = DEM_BOUNDARY_OPEN;
        w = dem_world_create(&open);
        d = cell_rates(0, 0, 0, 1);
        CHECK_EQ(dem_cell_set(w, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "axis 1 is to be sheared, but its boundary is not periodic");
        dem_world_destroy(w);
        hard.response = DEM_RESPONSE_IMPULSES;
        hard.dt = DEM_R(1e-3);
        w = dem_world_create(&hard);
        CHECK_EQ(dem_cell_set(w, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "contacts of this world are impulses");
        dem_world_destroy(w);
    }
    return test_end();
}
