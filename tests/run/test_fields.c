/* Means on a grid: stress against weight, virial and the gas law, classes, coarse graining, images. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */

/* Sum over a field's cells of column e of a block, times the volume of a cell, over samples. */
static double all_of(const dem_field_data *d, const double *block, int n, int e) {
    const dem_vec3 size = dem_vec3_make(d->box.hi.x - d->box.lo.x, d->box.hi.y - d->box.lo.y, d->box.hi.z - d->box.lo.z);
    const int cells = d->cells[0]*d->cells[1]*d->cells[2];
    double sum = 0;
    int i;
    for (i = 0; i < cells; i++) sum += block[n*i + e];
    return sum*(double)size.x*(double)size.y*(double)size.z/cells/(double)d->samples;
}
static dem_field field_of(dem_world *world, dem_box box, int x, int y, int z, double interval, double width) {
    dem_field_desc d;
    memset(&d, 0, sizeof d);
    d.box = box;
    d.cells[0] = x; d.cells[1] = y; d.cells[2] = z;
    d.interval = interval;
    d.stress = 1;
    d.width = (dem_real)width;
    return dem_field_add(world, &d);
}

/* A spring, and a weak pull within the range. */
static void weak_pull(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = c->overlap > 0 ? DEM_R(1e4)*c->overlap + c->closing_speed : -DEM_R(1e-4);
}
enum { SPHERES, EGGS, CLUSTERS, BRICKS, SHAPES };
/* 27 bodies of one shape in a pile on a plane, in a box of 0.1 m; joined: each pair of neighbours along x by a joint. */
static dem_world *pile(int shape, int response, int joined, int range) {
    const dem_real two[6] = {0, 0, 0, 0, DEM_R(0.001), 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_joint_desc joint = DEM_JOINT_DESC;
    dem_world *w;
    dem_material m;
    dem_shape s = {0};
    dem_body last = {0};
    int i;
    desc.response = (dem_response)response;
    desc.gravity = at(0, 0, -9.81);
    desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
    desc.orientations = joined;
    desc.dt = (dem_real)(response ? 1e-3 : 1e-5);
    if (range) {
        desc.law = weak_pull;
        desc.law_stiffness = DEM_R(1e4);
        desc.law_range = DEM_R(2e-3);
    }
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 0.5, 0.5, 0);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    cluster.count = 2;
    cluster.positions = two;
    cluster.radius = DEM_R(0.01);
    if (shape == EGGS) s = dem_shape_ellipsoid_add(w, at(0.012, 0.01, 0.01));
    if (shape == CLUSTERS) s = dem_shape_cluster_add(w, &cluster);
    if (shape == BRICKS) s = scene_box(w, 0.02, 0.02, 0.02);
    for (i = 0; i < 27; i++) {
        const dem_vec3 x = at(0.03 + 0.0199*(i%3), 0.03 + 0.021*(i/3%3), 0.00995 + 0.0199*(i/9));
        const dem_body body = shape ? dem_body_add(w, m, s, x, dem_quat_make(1, 0, 0, 0))
            : dem_sphere_add(w, m, DEM_R(0.01), x);
        joint.kind = DEM_JOINT_POINT;
        joint.a = last;
        joint.b = body;
        joint.point = demi_sub(x, at(0.01, 0, 0));
        if (joined && i%3) CHECK(dem_joint_add(w, &joint).id > 0);
        last = body;
    }
    CHECK_EQ(scene_step(w, response ? 20 : 400), DEM_OK);
    return w;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("two spheres in contact: stress times volume is force times branch vector, in cells, coarse-grained, "
         "periodic, planar") {
        int periodic, planar, width;
        for (periodic = 0; periodic < 2; periodic++)
            for (planar = 0; planar < 2; planar++)
                for (width = 0; width < 2; width++) {
                    dem_world_desc desc = DEM_WORLD_DESC;
                    const double x0 = periodic ? 0 : 0.5, z = planar ? 0 : 0.5;
                    dem_world *world;
                    dem_material m;
                    dem_field f;
                    dem_field_data d;
                    dem_contact_info c;
                    desc.planar = planar;
                    if (periodic) desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
                    desc.domain = box_of(0, 0, 0, 1, 1, 1);
                    world = dem_world_create(&desc);
                    m = scene_material(world, 1e6, 0.9, 0.5, 0);
                    dem_sphere_add(world, m, DEM_R(0.05), at(x0 - 0.049 + periodic, 0.5, z));
                    dem_sphere_add(world, m, DEM_R(0.06), at(x0 + 0.060, 0.51, z));
                    f = field_of(world, planar ? box_of(0, 0, -0.5, 1, 1, 0.5) : box_of(0, 0, 0, 1, 1, 1), 40, 40,
                                 planar ? 1 : 40, 1e-9, width ? 0.06 : 0);
                    CHECK_EQ(scene_step(world, 1), DEM_OK);
                    CHECK_EQ(dem_contacts_get(world, &c, 1), 1);
                    dem_field_get(world, f, &d);
                    CHECK_EQ(d.samples, 1);
                    /* of the kernel the grid sees a sum over centres of cells */
                    CHECK_REL(all_of(&d, d.stress, 6, 0), fabs((double)c.force.x)*0.109, width ? 5e-3 : fine ? 1e-3 : 1e-2);
                    CHECK_REL(all_of(&d, d.stress, 6, 3), (fabs((double)c.force.x)*0.01 + fabs((double)c.force.y)*0.109)/2,
                              width ? 5e-3 : fine ? 1e-3 : 1e-2);
                    CHECK_REL(all_of(&d, d.contacts, 1, 0)*1600*(planar ? 1 : 40), 2, width ? 5e-3 : 1e-6);
                    CHECK_REL(all_of(&d, d.grains, 1, 0)*1600*(planar ? 1 : 40), 2, width ? 5e-3 : 1e-6);
                    dem_world_destroy(world);
                }
    }

    TEST("in a bed at rest the vertical stress is the weight above per area, and the grains carry each contact twice") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_field f, small, large;
        dem_field_desc part;
        dem_field_data d;
        dem_field_cell cell, a, b;
        double weight = 0;
        int k;
        desc.gravity = at(0, 0, -9.81);
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(0, 0, 0, 0.04, 0.04, 1);
        world = dem_world_create(&desc);
        m = scene_material(world, 5e6, 0.3, 0.5, 0.1);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_spheres_fill(world, m, DEM_R(0.0030), dem_region_make(box_of(0, 0, 0, 0.04, 0.04, 0.16)), 300, 1);
        dem_spheres_fill(world, m, DEM_R(0.0022), dem_region_make(box_of(0, 0, 0, 0.04, 0.04, 0.16)), 500, 2);
        CHECK_EQ(dem_world_settle(world, 5, DEM_R(5e-4), 0, 0), DEM_OK);
        f = field_of(world, box_of(0, 0, 0, 0.04, 0.04, 0.08), 1, 1, 8, 2e-4, 0);
        memset(&part, 0, sizeof part);
        part.box = box_of(0, 0, 0, 0.04, 0.04, 0.08);
        part.cells[0] = part.cells[1] = part.cells[2] = 1;
        part.interval = 2e-4;
        part.stress = 1;
        part.radius_max = DEM_R(0.0025);
        small = dem_field_add(world, &part);
        part.radius_min = part.radius_max;
        part.radius_max = 0;
        part.material = m;
        large = dem_field_add(world, &part);
        CHECK_EQ(dem_world_run(world, 0.02, 0, 0), DEM_OK);
        dem_field_get(world, f, &d);
        CHECK(d.samples > 90);
        for (k = 7; k >= 0; k--) {
            const double own = d.mass[k]/(double)d.samples*9.81;
            dem_field_cell_get(world, f, 0, 0, k, &cell);
            /* the cell's own weight: half of it is above its middle */
            if (weight > 0.05) CHECK_REL(cell.stress[2], (weight + own/2)/(0.04*0.04), 0.05);
            if (weight > 0.05) CHECK(cell.stress[0] > 0.2*cell.stress[2] && cell.stress[0] < cell.stress[2]);
            weight += own;
        }
        CHECK_REL(weight, 9.81*dem_totals_get(world).mass, fine ? 1e-9 : 1e-4);
        dem_field_cell_get(world, f, 0, 0, 2, &cell);
        CHECK(cell.coordination > 3.5 && cell.coordination < 6.5);
        CHECK(cell.solid > 0.5 && cell.solid < 0.68);
        CHECK_REL(cell.density, 2500*cell.solid, fine ? 1e-9 : 1e-4);
        /* classes: both together are all */
        CHECK_EQ(dem_field_cell_get(world, small, 0, 0, 0, &a), DEM_OK);
        CHECK_EQ(dem_field_cell_get(world, large, 0, 0, 0, &b), DEM_OK);
        CHECK_NEAR(a.grains + b.grains, 800, 1e-6);
        CHECK_NEAR(a.grains, 500, 1e-6);
        CHECK_REL((a.stress[2] + b.stress[2])*0.08, (all_of(&d, d.stress, 6, 2) + all_of(&d, d.flux, 6, 2))/1.6e-3, 1e-3);
        CHECK_EQ(dem_field_cell_get(world, small, 0, 1, 0, &a), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "cell (0, 1, 0) does not exist, the field has 1 x 1 x 1");
        dem_world_destroy(world);
    }

    TEST("counters, stress, fields, mixing and the list agree how many contacts there are: of every shape, with springs, a law "
         "with a range, impulses and joints") {
        int shape, way;
        for (shape = 0; shape < SHAPES; shape++)
            for (way = 0; way < 4; way++) {
                const int response = way >= 2 ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
                dem_world *w = pile(shape, response, way == 3, way == 1);
                const dem_field f = field_of(w, box_of(0, 0, 0, 0.1, 0.1, 0.1), 1, 1, 1, 1e-9, 0);
                dem_mixing_desc half = DEM_MIXING_DESC;
                dem_contact_info info[2000];
                dem_field_cell cell;
                dem_counters c;
                dem_mixing mixing;
                dem_stress s;
                int i, n, between = 0, walls = 0;
                CHECK_EQ(scene_step(w, 1), DEM_OK);
                c = dem_counters_get(w);
                CHECK(c.contacts >= 9 && c.wall_contacts >= 9);
                CHECK_EQ(dem_stress_get(w, &s), DEM_OK);
                CHECK_EQ(s.contacts, c.contacts);
                CHECK_NEAR(27*s.coordination, 2*c.contacts + c.wall_contacts, 1e-9);
                CHECK_EQ(dem_field_cell_get(w, f, 0, 0, 0, &cell), DEM_OK);
                CHECK_NEAR(27*cell.coordination, 2*c.contacts + c.wall_contacts, 1e-9);
                half.box = box_of(0, 0, 0, 0.1, 0.1, 0.1);
                half.cells[0] = half.cells[1] = half.cells[2] = 1;
                half.radius_max = 1;
                CHECK_EQ(dem_mixing_get(w, &half, &mixing), DEM_OK);
                CHECK_EQ(mixing.contacts, c.contacts);
                n = dem_contacts_get(w, info, 2000);
                CHECK(n > 0 && n <= 2000);
                CHECK_EQ(dem_contacts_get(w, 0, 0), n);
                for (i = 0; i < n && response == DEM_RESPONSE_SPRINGS; i++)
                    if (info[i].overlap > 0 && !info[i].further) *(info[i].wall ? &walls : &between) += 1;
                if (response == DEM_RESPONSE_SPRINGS) {
                    CHECK_EQ(between, c.contacts);
                    CHECK_EQ(walls, c.wall_contacts);
                }
                for (i = 0; i < n && way == 3; i++)     /* joined neighbours along x overlap and have no contact */
                    CHECK(info[i].wall || !(info[i].normal.x*info[i].normal.x > DEM_R(0.9)));
                dem_world_destroy(w);
            }
    }
    TEST("the kinetic pressure of a dilute gas is density times temperature, for any mean velocity") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_field f;
        dem_field_cell cell;
        double T;
        int i;
        desc.boundary[0] = desc.boundary[1] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 1, 0, 0);
        dem_spheres_fill(world, m, DEM_R(2e-4), dem_region_make(desc.domain), 400, 4);
        for (i = 0; i < 400; i++) scene_move(world, dem_body_id_get(world, i), at(0.5, 0, 0), at(0, 0, 0));
        CHECK_EQ(dem_temperature_set(world, 0.04, 9), DEM_OK);
        f = field_of(world, desc.domain, 1, 1, 1, 1e-9, 0);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        T = dem_temperature_get(world);
        dem_field_cell_get(world, f, 0, 0, 0, &cell);
        CHECK_REL(cell.temperature, T, fine ? 1e-9 : 1e-4);
        CHECK_REL(cell.stress[0] + cell.stress[1] + cell.stress[2], 3*cell.density*T, fine ? 1e-6 : 1e-3);
        CHECK_REL(cell.velocity[0], 0.5, fine ? 1e-9 : 1e-5);
        dem_world_destroy(world);
    }

    TEST("a coarse-grained field loses no mass across periodic faces, and varies less than the grains do") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_field f, cells;
        dem_field_data d, e;
        double least[2] = {1e9, 1e9}, most[2] = {0, 0};
        int i;
        desc.boundary[0] = desc.boundary[1] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(0, 0, 0, 0.05, 0.05, 0.05);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 1, 0, 0);
        dem_spheres_fill(world, m, DEM_R(1.5e-3), dem_region_make(desc.domain), 1500, 4);
        f = field_of(world, desc.domain, 10, 10, 10, 1e-9, 0.006);
        cells = field_of(world, desc.domain, 10, 10, 10, 1e-9, 0);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        dem_field_get(world, f, &d);
        dem_field_get(world, cells, &e);
        CHECK_REL(all_of(&d, d.mass, 1, 0), all_of(&e, e.mass, 1, 0), 5e-3);
        for (i = 0; i < 1000; i++) {
            if (d.solid[i] < least[0]) least[0] = d.solid[i];
            if (d.solid[i] > most[0]) most[0] = d.solid[i];
            if (e.solid[i] < least[1]) least[1] = e.solid[i];
            if (e.solid[i] > most[1]) most[1] = e.solid[i];
        }
        CHECK(most[0] - least[0] < 0.3*(most[1] - least[1]));
        dem_world_destroy(world);
    }

    TEST("in planar worlds the depth of the box along z changes no field, and a square counts with its area") {
        int k;
        for (k = 0; k < 4; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            const dem_real square[8] = {0, 0, DEM_R(0.2), 0, DEM_R(0.2), DEM_R(0.2), 0, DEM_R(0.2)};
            const double deep = k%2 ? 0.25 : 1, thick = k/2 ? 0.1 : 1, r = 0.05, area = 0.04 + DEMI_PI*r*r;
            dem_world *w;
            dem_material m;
            dem_field f, spread;
            dem_field_cell cell;
            dem_field_data d, e;
            dem_contact_info c[2];
            double sum = 0;
            int i;
            desc.planar = 1;
            desc.thickness = (dem_real)thick;
            w = dem_world_create(&desc);
            m = scene_material(w, 1e7, 0.5, 0.5, 0);
            dem_body_add(w, m, dem_shape_polygon_add(w, 4, square), at(0.45, 0.5, 0), dem_quat_make(1, 0, 0, 0));
            dem_sphere_add(w, m, (dem_real)r, at(0.599, 0.5, 0));
            f = field_of(w, box_of(0, 0, -deep/2, 1, 1, deep/2), 1, 1, 1, 1e-9, 0);
            spread = field_of(w, box_of(0, 0, -deep/2, 1, 1, deep/2), 40, 40, 1, 1e-9, 0.06);
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            CHECK_EQ(dem_field_cell_get(w, f, 0, 0, 0, &cell), DEM_OK);
            CHECK_REL(cell.solid, area, 1e-5);
            CHECK_REL(cell.density, 2500*area, 1e-5);
            dem_field_get(w, f, &d);
            CHECK_REL(d.solid[0], area, 1e-5);
            CHECK_REL(d.mass[0], 2500*area*thick, 1e-5);
            CHECK(dem_contacts_get(w, c, 2) >= 1);
            CHECK_REL(d.stress[0]*thick, fabs((double)c[0].force.x)*0.149, 0.02);
            dem_field_get(w, spread, &e);
            for (i = 0; i < 1600; i++) sum += e.solid[i]/1600;
            CHECK_REL(sum, area, 5e-3);
            dem_world_destroy(w);
        }
    }

    TEST("fields sample every 100 steps unless an interval is given, and then at each multiple of it") {
        static const int steps[3] = {100, 10, 1};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_field f[3];
        dem_field_data d;
        uint64_t had[3] = {0, 0, 0};
        int i, k, last[3] = {0, 0, 0}, off[3] = {0, 0, 0};
        desc.dt = DEM_R(1e-5);                          /* sums of which are not exact */
        desc.allow_large_dt = 1;
        world = dem_world_create(&desc);
        dem_sphere_add(world, scene_material(world, 1e7, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
        for (k = 0; k < 3; k++)
            f[k] = field_of(world, box_of(-1, -1, -1, 1, 1, 1), 1, 1, 1, k ? steps[k]*(double)desc.dt : 0, 0);
        for (i = 1; i <= 5000; i++) {
            if (scene_step(world, 1) != DEM_OK) break;
            for (k = 0; k < 3; k++) {
                dem_field_get(world, f[k], &d);
                if (d.samples == had[k]) continue;
                off[k] += had[k] > 1 && i - last[k] != steps[k];
                had[k] = d.samples;
                last[k] = i;
            }
        }
        for (k = 0; k < 3; k++) {
            CHECK_EQ(off[k], 0);
            CHECK(last[k] > 5000 - steps[k]);
        }
        dem_world_destroy(world);
    }

    TEST("a field that is added late samples at start plus multiples of its interval, as if it had been there from the start") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_field f;
        dem_field_data d;
        uint64_t had = 0;
        int i;
        desc.dt = DEM_R(1e-5);
        desc.allow_large_dt = 1;
        world = dem_world_create(&desc);
        dem_sphere_add(world, scene_material(world, 1e7, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
        CHECK_EQ(scene_step(world, 104), DEM_OK);
        f = field_of(world, box_of(-1, -1, -1, 1, 1, 1), 1, 1, 1, 10*(double)desc.dt, 0);
        CHECK_EQ(scene_step(world, 1), DEM_OK);         /* 105: the first one is overdue */
        dem_field_get(world, f, &d);
        CHECK_EQ(d.samples, 1);
        for (i = 106; i <= 150; i++) {
            had = d.samples;
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            dem_field_get(world, f, &d);
            CHECK_EQ(d.samples - had, i%10 == 0);
        }
        dem_world_destroy(world);
    }
    TEST("a field whose window ends at a step has the sample of that step, however its time is rounded") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_field_desc d = DEM_FIELD_DESC;
        dem_field_data data;
        dem_world *world;
        int n;
        desc.dt = DEM_R(1e-4);
        desc.allow_large_dt = 1;
        world = dem_world_create(&desc);
        dem_sphere_add(world, scene_material(world, 1e7, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
        d.box = box_of(-1, -1, -1, 1, 1, 1);
        d.cells[0] = d.cells[1] = d.cells[2] = 1;
        d.interval = 1e-4;
        for (n = 1; n <= 50; n++) {
            d.end = n/1e4;                     /* s; 3e-4 s is less than 3 x 1e-4 s, as they are rounded */
            CHECK_EQ(dem_field_add(world, &d).id, n);
        }
        CHECK_EQ(scene_step(world, 60), DEM_OK);
        for (n = 1; n <= 50; n++) {
            dem_field field;
            field.id = n;
            dem_field_get(world, field, &data);
            CHECK_EQ(data.samples, n);
        }
        dem_world_destroy(world);
    }
    TEST("a planar world rejects a field whose box has no bodies, because z = 0 is not in it, and stays as it was") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        uint64_t hash;
        desc.planar = 1;
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.5, 0.3, 0);
        dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        hash = dem_world_hash_get(world);
        CHECK_EQ(field_of(world, box_of(-1, -1, 1, 1, 1, 2), 1, 1, 1, 0, 0).id, 0);
        CHECK_STR(dem_world_error_get(world), "dem_field_add: box is from z = 1 to 2 m, must contain 0");
        CHECK_EQ(field_of(world, box_of(-1, -1, -2, 1, 1, -1), 1, 1, 1, 0, 0).id, 0);
        CHECK_STR(dem_world_error_get(world), "box is from z = -2 to -1 m");
        CHECK(dem_world_hash_get(world) == hash);
        CHECK_EQ(field_of(world, box_of(-1, -1, 0, 1, 1, 2), 1, 1, 1, 0, 0).id, 1);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        dem_world_destroy(world);
    }

    TEST("fields with bad widths and classes are rejected with the value named") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        dem_field_desc d;
        memset(&d, 0, sizeof d);
        d.box = box_of(0, 0, 0, 1, 1, 1);
        d.cells[0] = d.cells[1] = d.cells[2] = 2;
        d.width = -1;
        CHECK_EQ(dem_field_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "width is -1 m");
        d.width = 0;
        d.radius_min = 2;
        d.radius_max = 1;
        CHECK_EQ(dem_field_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "radius_max is 1 m, must be 0 or >= radius_min (2 m)");
        d.radius_min = d.radius_max = 0;
        d.material.id = 3;
        CHECK_EQ(dem_field_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "material 3 does not exist");
        dem_world_destroy(world);
    }
    return test_end();
}
