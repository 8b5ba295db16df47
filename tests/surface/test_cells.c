/* Every kind of wall with every kind of body, by springs and impulses: each cell of the table comes to rest in contact, or is
   refused with a reason. CELLS=1 prints the table of docs/shapes.md. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const dem_quat straight = {1, 0, 0, 0};
enum { PLANE, CYLINDER, CONE, MESH, PROFILE, FRACTION, GRAINS, WEAVE, BARS, SQUARE, SLOTS, ROUND, SHEET, DISC, REDUCED, WALLS };
enum { SPHERE, CLUSTER, EGG, ROCK, UNION, POLYGON, BODIES };
static const char *const walls[WALLS] = {"plane", "cylinder", "cone, surface of revolution", "mesh", "profile",
    "profile of DEM_EDGE_FRACTION", "wall of grains", "weave", "bars", "square holes", "slots", "round holes",
    "holes in a sheet without thickness", "sieve cut from a disc", "reduced holes"};
static const char *const bodies[BODIES] = {"sphere", "cluster", "ellipsoid", "polyhedron", "union", "polygon"};
/* A wall whose surface is at y = 0 above x = z = 0. */
static dem_wall wall_of(dem_world *w, dem_material m, int kind) {
    static const dem_sieve_kind kinds[] = {DEM_SIEVE_WIRES, DEM_SIEVE_BARS, DEM_SIEVE_SQUARE, DEM_SIEVE_SLOTS,
                                           DEM_SIEVE_ROUND, DEM_SIEVE_SQUARE, DEM_SIEVE_SQUARE, DEM_SIEVE_REDUCED};
    dem_real v[12] = {-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1}, line[4] = {-1, 0, 1, 0};
    int32_t t[6] = {0, 2, 1, 0, 3, 2}, s[2] = {0, 1};
    dem_sieve_desc d = DEM_SIEVE_DESC;
    dem_profile profile;
    dem_mesh mesh;
    int i;
    if (kind == PLANE) return dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 1, 0));
    if (kind == CYLINDER) return dem_wall_cylinder_add(w, m, at(0, 0.1, 0), at(0, 0, 1), DEM_R(0.1), 1);
    if (kind == CONE) return dem_wall_cone_add(w, m, at(0, -0.002, 0), at(0, 0.05, 0), DEM_R(0.003), DEM_R(0.08));
    if (kind == MESH) {
        mesh.vertex_count = 4; mesh.triangle_count = 2; mesh.vertices = v; mesh.triangles = t;
        return dem_wall_mesh_add(w, m, &mesh);
    }
    if (kind == PROFILE || kind == FRACTION) {
        profile.vertex_count = 2; profile.segment_count = 1; profile.vertices = line; profile.segments = s;
        return dem_wall_profile_add(w, m, &profile, kind == PROFILE ? DEM_EDGE_RESOLVED : DEM_EDGE_FRACTION);
    }
    if (kind == GRAINS) {
        dem_real x[3*81];
        for (i = 0; i < 81; i++) {
            x[3*i] = (dem_real)(0.004*(i%9 - 4));
            x[3*i + 1] = DEM_R(-0.003);
            x[3*i + 2] = (dem_real)(0.004*(i/9 - 4));
        }
        return dem_wall_grains_add(w, m, 81, x, DEM_R(0.003), 1);
    }
    d.kind = kinds[kind - WEAVE];
    d.normal = at(0, 1, 0);
    d.along = at(1, 0, 0);
    d.aperture = DEM_R(0.004);
    d.bar = DEM_R(0.004);
    if (kind >= SQUARE && kind <= ROUND) d.thickness = DEM_R(0.002);
    if (kind == SLOTS) d.length = DEM_R(0.02);
    if (kind == DISC) d.radius = DEM_R(0.05);
    if (kind == REDUCED) d.clearance = 1;
    return dem_wall_sieve_add(w, m, &d);
}
static dem_body body_of(dem_world *w, dem_material m, int kind) {
    static const dem_real member[9] = {0, 0, 0, DEM_R(0.003), 0, 0, 0, 0, DEM_R(0.003)};
    const dem_real side[6] = {0, 0, 0, DEM_R(0.004), 0, 0}, corner[8] = {DEM_R(-0.005), DEM_R(-0.005), DEM_R(0.005),
        DEM_R(-0.005), DEM_R(0.005), DEM_R(0.005), DEM_R(-0.005), DEM_R(0.005)};
    const dem_vec3 x = at(0, 0.012, 0);
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    uint64_t random = 3;
    dem_shape two[2], shape;
    if (kind == SPHERE) return dem_sphere_add(w, m, DEM_R(0.006), x);
    c.count = 3;
    c.positions = member;
    c.radius = DEM_R(0.005);
    if (kind == UNION) two[0] = two[1] = scene_box(w, 0.008, 0.008, 0.01);
    shape = kind == CLUSTER ? dem_shape_cluster_add(w, &c) : kind == EGG ? dem_shape_ellipsoid_add(w, at(0.007, 0.005, 0.006))
        : kind == ROCK ? scene_rock(w, &random, 20, 0.009) : kind == UNION ? dem_shape_union_add(w, 2, two, side, 0)
        : dem_shape_polygon_add(w, 4, corner);
    return dem_body_add(w, m, shape, x, straight);
}
/* Tries a cell. Returns 0 if it is refused, else 1, or 2 if the body touches facets of a tessellation. why: room for the
   reason. */
static int cell(int wall, int body, int impulses, char *why, size_t room) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    dem_body b;
    int i, touched = 0, facets;
    *why = 0;
    desc.gravity = at(0, -9.81, 0);
    desc.planar = body == POLYGON;
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.dt = impulses ? DEM_R(1e-3) : DEM_R(2e-5);
    desc.allow_large_dt = 1;
    w = dem_world_create(&desc);
    m = scene_material(w, impulses ? 0 : body == POLYGON ? 1e7 : 1e6, 0.2, 0.5, 0.05);
    if (!wall_of(w, m, wall).id || !(b = body_of(w, m, body)).slot) {
        const char *told = strchr(dem_world_error_get(w), ':'), *reason = told ? strchr(told + 1, ':') : 0;
        snprintf(why, room, "%.*s", (int)strcspn(reason ? reason + 2 : told + 2, ";"), reason ? reason + 2 : told + 2);
        dem_world_destroy(w);
        return 0;
    }
    for (i = 0; i < 12; i++) {
        CHECK_EQ(scene_step(w, impulses ? 20 : 700), DEM_OK);
        touched += dem_contacts_get(w, 0, 0) > 0;
    }
    facets = w->domains[0].walls && demi_surface_of(w, w->wall_id[0])->scale;
    CHECK(touched > 3);
    CHECK((double)scene_state(w, b).position.y > -0.004);
    CHECK((double)demi_length(scene_state(w, b).velocity) < 0.1);
    dem_world_destroy(w);
    return 1 + facets;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("cells: every body comes to rest on every wall, by springs and impulses, or dem.h refuses it with a reason") {
        static char reasons[16][200];
        int wall, body, impulses, i, known = 0, filled = 0, refused = 0;
        if (getenv("CELLS")) {
            printf("| wall |");
            for (body = 0; body < BODIES; body++) printf(" %s |", bodies[body]);
            printf("\n|---|---|---|---|---|---|---|\n");
        }
        for (wall = 0; wall < WALLS; wall++) {
            if (getenv("CELLS")) printf("| %s |", walls[wall]);
            for (body = 0; body < BODIES; body++) {
                int how[2];
                for (impulses = 0; impulses < 2; impulses++) {
                    char why[200];
                    how[impulses] = cell(wall, body, impulses, why, sizeof why);
                    if (how[impulses]) { filled++; continue; }
                    refused++;
                    CHECK(strlen(why) > 20);
                    for (i = 0; i < known && strcmp(reasons[i], why); i++) continue;
                    if (i == known && known < 16) snprintf(reasons[known++], sizeof reasons[0], "%s", why);
                    how[impulses] = -1 - i;
                }
                if (!getenv("CELLS")) continue;
                for (impulses = 0; impulses < 1 + (how[1] != how[0]); impulses++) {
                    printf("%s", impulses ? ", impulses" : "");
                    if (how[impulses] < 0) printf(" %c", 'a' - 1 - how[impulses]);
                    else printf(" %s", how[impulses] == 2 ? "facets" : "closed");
                }
                printf(" |");
            }
            if (getenv("CELLS")) printf("\n");
        }
        for (i = 0; i < known && getenv("CELLS"); i++) printf("%c: %s\n", 'a' + i, reasons[i]);
        CHECK_EQ(filled + refused, 2*WALLS*BODIES);
        CHECK(filled > 130);
    }
    return test_end();
}
