/* One surface: bodies slide over floors that are made of several walls, triangles, images and bodies, as over one plane.
   Every cell of a table body x floor x response x start, without friction and with it. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */
static const double R = 2e-3;
enum { BALL, CLUMP, ELLIPSOID, CUBE, ROCK, UNION, ROD, POLYGON, BODIES, KEEL = BODIES };
static const char *const bodies[] = {"ball", "clump", "ellipsoid", "cube", "rock", "union", "rod", "polygon"};
enum { SLIDE, FALL, FALL_AGAIN, TURN, STARTS };
static const char *const starts[] = {"slides", "falls", "falls otherwise", "turns"};
enum { PLANE, MESH, MESHES, PLANES, PLANE_AND_MESH, PROFILES, SQUARES, BOXES, BOXES_IN_MESH, CROSSED, STACKED, JUNCTIONS, FOLDS, OVERLAPS, SLIVERS,
       DOUBLED, PERIODIC, IMAGES, WAITING, RESTING, TURNING, TABLED, BELTS, FIXED, FLOORS };
static const char *const floors[] = {"plane", "one mesh", "two meshes", "two planes", "plane and mesh", "two profiles", "squares",
    "ten boxes", "ten boxes in a mesh", "ten boxes in a mesh with crossed diagonals", "boxes on a box", "T-junctions", "folded triangles", "meshes that overlap", "slivers", "doubled triangles",
    "periodic seam", "periodic seam that turns later", "boxes whose motions begin later", "boxes of speed 0", "boxes that turn alike", "boxes led by equal tables",
    "belts", "ten fixed bodies"};

/* Rectangles x0 z0 x1 z1 (count x 4, m) at y = 0, two triangles each. */
static dem_wall floor_of(dem_world *w, dem_material m, int count, const double *q) {
    dem_real v[12*24];
    int32_t t[6*24];
    dem_mesh mesh;
    int i, k;
    for (i = 0; i < count; i++) {
        static const int32_t two[6] = {0, 2, 1, 0, 3, 2};
        for (k = 0; k < 4; k++) {
            v[12*i + 3*k] = (dem_real)q[4*i + (k == 1 || k == 2 ? 2 : 0)];
            v[12*i + 3*k + 1] = 0;
            v[12*i + 3*k + 2] = (dem_real)q[4*i + (k > 1 ? 3 : 1)];
        }
        for (k = 0; k < 6; k++) t[6*i + k] = 4*i + two[k];
    }
    mesh.vertex_count = 4*count;
    mesh.triangle_count = 2*count;
    mesh.vertices = v;
    mesh.triangles = t;
    return dem_wall_mesh_add(w, m, &mesh);
}
/* Boxes from x = -6.5 R on, `count` of width 1.3 R, closed, their tops at y = 0; in one mesh or in one each. */
static dem_wall boxes_of(dem_world *w, dem_material m, int count, int one, double width, double y0, double y1, double depth) {
    /* the diagonal of side x = 0 of an odd box, if `one` is 2, crosses that of its neighbour; it faces inwards if `one` < 0 */
    static const int32_t crossed[12] = {0, 4, 2, 4, 6, 2, 1, 3, 5, 3, 7, 5};
    static const int32_t side[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3,
                                     7, 1, 7, 5};
    dem_real v[24*10];
    int32_t t[36*10];
    dem_wall wall;
    dem_mesh mesh;
    int i, k;
    wall.id = 0;
    for (i = 0; i < count; i++) {
        const int at = one ? i : 0;
        for (k = 0; k < 8; k++) {
            v[24*at + 3*k] = (dem_real)(-6.5*R + width*(i + (k & 1)));
            v[24*at + 3*k + 1] = (dem_real)(k & 2 ? y1 : y0);
            v[24*at + 3*k + 2] = (dem_real)(k & 4 ? depth : -depth);
        }
        for (k = 0; k < 36; k++) {
            const int corner = one < 0 ? k - k%3 + 2 - k%3 : k;
            t[36*at + k] = 8*at + (k > 23 && abs(one) == 2 && i%2 ? crossed[corner - 24] : side[corner]);
        }
        mesh.vertex_count = 8*(at + 1);
        mesh.triangle_count = 12*(at + 1);
        mesh.vertices = v;
        mesh.triangles = t;
        if (!one || i == count - 1) wall = dem_wall_mesh_add(w, m, &mesh);
    }
    return wall;
}
/* A rotation about the y axis, written in several ways. */
static dem_motion turn_of(int k, double speed) {
    dem_motion m = DEM_MOTION;
    m.kind = DEM_MOTION_ROTATING;
    m.axis = at(0, k%3 - 1.5, 0);
    m.speed = (dem_real)(k%3 < 2 ? -speed : speed);
    m.point = at(0, k*R, 0);
    return m;
}
/* Gives the first walls, such as the boxes of a floor, motions that leave them at rest relative to each other. */
static void boxes_move(dem_world *w, int kind, int count) {
    dem_motion_row rows[3];
    int k;
    for (k = 0; k < count; k++) {
        dem_motion m = turn_of(k, kind == TURNING ? 4 : kind == RESTING ? 0 : 9);
        dem_wall wall;
        wall.id = k + 1;
        memset(rows, 0, sizeof rows);
        rows[1].time = 0.01;
        rows[2].time = 0.02;
        rows[1].position = at(0, 0, 0.1*R);
        rows[2].position = at(0.2*R, kind == WAITING ? R : 0, 0.1*R);
        if (kind == TABLED || (kind == WAITING && k == 4)) {
            m.kind = DEM_MOTION_TABLE;
            m.table = rows;
            m.table_count = 3;
        } else if (kind != TURNING && k%5 != 1) {
            if (k%5 == 0) continue;             /* fixed */
            m.kind = k%5 == 2 ? DEM_MOTION_TRANSLATING : DEM_MOTION_OSCILLATING;
            if (k == 9 && kind == WAITING && w->desc.response == DEM_RESPONSE_SPRINGS) m.kind = DEM_MOTION_SERVO;
            if (kind == WAITING || k%5 > 2) m.velocity = at(0, 1 + k, 0);
            m.frequency = 50;
            m.load = 1;
            m.amplitude = kind == WAITING ? (dem_real)R : 0;
        }
        if (kind == WAITING) m.start = 3 + k%2;
        CHECK_EQ(dem_wall_motion_set(w, wall, &m), DEM_OK);
    }
}
/* A floor at y = 0 about x = 0; answers its last wall. */
static dem_wall floor_add(dem_world *w, dem_material m, int kind) {
    const double L = 30*R;
    dem_motion motion = DEM_MOTION;
    dem_wall last;
    int i;
    last.id = 0;
    switch (kind) {
    case PLANES: dem_wall_plane_add(w, m, at(0.1, 0, 0), at(0, 1, 0)); /* fall through */
    case PLANE: return dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 1, 0));
    case PLANE_AND_MESH: {
        const double q[4] = {0, -L, L, L};
        dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 1, 0));
        return floor_of(w, m, 1, q);
    }
    case MESH: { const double q[4] = {-L, -L, L, L}; return floor_of(w, m, 1, q); }
    case PERIODIC: case IMAGES: {
        const double q[4] = {-10*R, -10*R, 10*R, 10*R};
        last = floor_of(w, m, 1, q);
        motion = turn_of(1, 9);
        motion.start = 3;
        if (kind == IMAGES) dem_wall_motion_set(w, last, &motion);
        return last;
    }
    case MESHES: case BELTS: {
        const double a[4] = {-L, -L, 0, L}, b[4] = {0, -L, L, L};
        floor_of(w, m, 1, a);
        last = floor_of(w, m, 1, b);
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity = at(0, 0, 0.1);
        if (kind == BELTS) dem_wall_motion_set(w, last, &motion);
        return last;
    }
    case PROFILES: {
        dem_real a[4] = {(dem_real)-L, 0, 0, 0}, b[4] = {0, 0, (dem_real)L, 0};
        int32_t s[2] = {0, 1};
        dem_profile profile;
        profile.vertex_count = 2;
        profile.segment_count = 1;
        profile.vertices = a;
        profile.segments = s;
        dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED);
        profile.vertices = b;
        return dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED);
    }
    case WAITING: case RESTING: case TURNING: case TABLED:
        last = boxes_of(w, m, 10, 0, 1.3*R, -4*R, 0, L);
        boxes_move(w, kind, 10);
        return last;
    case BOXES: return boxes_of(w, m, 10, 0, 1.3*R, -4*R, 0, L);
    case CROSSED: return boxes_of(w, m, 10, 2, 1.3*R, -4*R, 0, L);
    case SQUARES: {
        dem_real v[80];
        int32_t sides[80];
        dem_profile profile;
        for (i = 0; i < 40; i++) {
            v[2*i] = (dem_real)(1.3*R*(i/4 - 5 + (i%4 == 1 || i%4 == 2)));
            v[2*i + 1] = (dem_real)(i%4 > 1 ? 0 : -4*R);
            sides[2*i] = i;
            sides[2*i + 1] = i%4 == 3 ? i - 3 : i + 1;
        }
        profile.vertex_count = profile.segment_count = 40;
        profile.vertices = v;
        profile.segments = sides;
        return dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED);
    }
    case FIXED: {
        const dem_shape box = scene_box(w, 1.3*R, 4*R, 20*R);
        for (i = 0; i < 10; i++) {
            const dem_body b = dem_body_add(w, m, box, at((1.3*(i + 0.5) - 6.5)*R, -2*R, 0), dem_quat_make(1, 0, 0, 0));
            dem_body_state s = scene_state(w, b);
            s.fixed = 1;
            dem_body_set(w, b, &s);
        }
        last.id = 1;
        return last;
    }
    case BOXES_IN_MESH: return boxes_of(w, m, 10, 1, 1.3*R, -4*R, 0, L);
    case STACKED: boxes_of(w, m, 1, 0, 13*R, -8*R, -4*R, 2*L); return boxes_of(w, m, 10, 0, 1.3*R, -4*R, 0, L);
    case JUNCTIONS: { const double q[12] = {-L, -L, 0, L, 0, -L, L, 0.3*R, 0, 0.3*R, L, L}; return floor_of(w, m, 3, q); }
    case OVERLAPS: {
        const double a[4] = {-L, -L, 0.7*R, L}, b[4] = {-0.4*R, -0.9*L, L, 0.8*L};
        floor_of(w, m, 1, a);
        return floor_of(w, m, 1, b);
    }
    case DOUBLED: { const double q[12] = {-L, -L, 0, L, 0, -L, L, L, 0, -L, L, L}; return floor_of(w, m, 3, q); }
    case SLIVERS: {
        double q[80];
        for (i = 0; i < 20; i++) {
            q[4*i] = i ? -0.5*R + (i - 1)*R/20 + 1e-5*R*(i%3) : -L;
            q[4*i + 1] = -L;
            q[4*i + 3] = L;
        }
        for (i = 0; i < 20; i++) q[4*i + 2] = i < 19 ? q[4*i + 4] : L;
        return floor_of(w, m, 20, q);
    }
    default: {                                  /* folds: triangles 0 and 1 lie on the same side of the edge they share */
        dem_real v[24] = {0, 0, -1, 0, 0, 1, 1, 0, DEM_R(0.003), 1, 0, -1, 1, 0, 1, -1, 0, 0, -1, 0, -1, -1, 0, 1};
        int32_t t[21] = {0, 1, 2, 0, 1, 4, 0, 2, 3, 1, 4, 2, 0, 5, 1, 0, 6, 5, 1, 5, 7};
        dem_mesh mesh;
        for (i = 0; i < 24; i++) v[i] *= (dem_real)L;
        mesh.vertex_count = 8;
        mesh.triangle_count = 7;
        mesh.vertices = v;
        mesh.triangles = t;
        return dem_wall_mesh_add(w, m, &mesh);
    }
    }
}
static dem_shape shape_of(dem_world *w, int body) {
    dem_real p[24];
    uint64_t seed = 7;
    dem_shape two[2];
    switch (body) {
    case CLUMP: {
        dem_cluster_desc c = DEM_CLUSTER_DESC;
        const double x[9] = {0, 0, 0, 0.8, 0, 0, -0.5, 0, 0.6};
        int i;
        for (i = 0; i < 9; i++) p[i] = (dem_real)(x[i]*R);
        c.count = 3;
        c.positions = p;
        c.radius = (dem_real)(0.7*R);
        c.rays = 64;
        return dem_shape_cluster_add(w, &c);
    }
    case ELLIPSOID: return dem_shape_ellipsoid_add(w, at(1.2*R, 0.8*R, 0.9*R));
    case ROCK: return scene_rock(w, &seed, 20, R);
    case UNION: {
        const double x[6] = {-0.4, 0, 0, 0.5, 0, 0.1};
        int i;
        for (i = 0; i < 6; i++) p[i] = (dem_real)(x[i]*R);
        two[0] = scene_box(w, R, R, R);
        two[1] = scene_box(w, R, R, 1.4*R);
        return dem_shape_union_add(w, 2, two, p, 0);
    }
    case POLYGON: {
        const double x[8] = {-0.8, -0.8, 0.8, -0.8, 0.8, 0.8, -0.8, 0.8};
        int i;
        for (i = 0; i < 8; i++) p[i] = (dem_real)(x[i]*R);
        return dem_shape_polygon_add(w, 4, p);
    }
    case KEEL: {                                /* the end of the keel is less steep than its sides */
        const double x[18] = {-1.2, -0.6, 0, 0.6, -0.6, 0, -1.2, 0.2, -0.4, -1.2, 0.2, 0.4, 1.2, 0.2, -0.4, 1.2, 0.2, 0.4};
        int i;
        for (i = 0; i < 18; i++) p[i] = (dem_real)(x[i]*R);
        return dem_shape_polyhedron_add(w, 6, p);
    }
    case ROD: return scene_box(w, 3*R, 0.8*R, 0.8*R);
    default: return scene_box(w, 1.6*R, 1.6*R, 1.6*R);
    }
}
static double floor_restitution = 0.3, floor_friction = 0, floor_tolerance = 0;
static scene_memory *floor_memory;
/* Hertz with a dashpot, and an attraction that fades with the gap and ends at floor_range, m. */
static double floor_range = 0;
static void attract(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real gap = DEMI_MAX(-c->overlap, 0)/(dem_real)floor_range, d = DEMI_MAX(c->overlap, 0);
    (void)memory;
    f->normal = c->kn*d*DEMI_SQRT(d) + c->cn*DEMI_SQRT(DEMI_SQRT(d))*c->closing_speed;
    if (gap < 1) f->normal -= DEM_R(1e-3)*(1 - gap);
}
static dem_world *floor_world(int body, int floor, int impulses, dem_body *b) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_material m;
    dem_world *w;
    d.threads = 1;
    d.gravity = at(0, -9.81, 0);
    d.planar = body == POLYGON;
    d.impact_speed = DEM_R(0.2);
    if (impulses) { d.response = DEM_RESPONSE_IMPULSES; d.dt = DEM_R(1e-4); }
    if (impulses && floor_tolerance > 0) { d.tolerance = (dem_real)floor_tolerance; d.sweeps = 20000; }
    if (floor_range > 0) { d.law = attract; d.law_range = (dem_real)floor_range; }
    if (floor_memory) scene_memory_use(floor_memory, &d);
    if (floor == PERIODIC || floor == IMAGES) {
        d.boundary[0] = DEM_BOUNDARY_PERIODIC;
        d.domain = box_of(-10*R, -20*R, -20*R, 10*R, 20*R, 20*R);
    }
    w = dem_world_create(&d);
    m = scene_material(w, 1e7, floor_restitution, floor_friction, 0);
    CHECK(floor_add(w, m, floor).id > 0);
    *b = body == BALL ? dem_sphere_add(w, m, (dem_real)R, at(0, 1.5*R, 0))
        : dem_body_add(w, m, shape_of(w, body), at(0, 1.5*R, 0), dem_quat_make(1, 0, 0, 0));
    CHECK_STR(dem_world_error_get(w), "");
    return w;
}
/* A body at rest on a plane. */
static dem_body_state at_rest(int body, int impulses) {
    dem_body b;
    dem_world *w = floor_world(body, PLANE, impulses, &b);
    dem_body_state s;
    int i;
    for (i = 0; i < 40; i++) {
        CHECK_EQ(dem_world_run(w, 0.01, 0, 0), DEM_OK);
        s = scene_state(w, b);
        scene_move(w, b, at(0, (double)s.velocity.y*0.9, 0), at(0.8*(double)s.spin.x, 0, 0.8*(double)s.spin.z));
    }
    CHECK_EQ(dem_world_run(w, 0.1, 0, 0), DEM_OK);
    s = scene_state(w, b);
    dem_world_destroy(w);
    s.spin = at(0, 0, 0);
    return s;
}
typedef struct slide { double hop, speed, spin; } slide;     /* over R, v and v/R */
enum { STATES = 40 };
/* The states of a body on a floor while it covers `way`, m, at 1 m/s. It begins in state s, as far before x = 0 as it
   comes behind it. alike: if not 0, the floor has the motion of the boxes of that floor. */
static void path_of(int body, int floor, int alike, int impulses, dem_body_state s, double way, dem_body_state *path) {
    const double v = 1;
    dem_body b;
    dem_world *w = floor_world(body, floor, impulses, &b);
    int k;
    if (alike) boxes_move(w, alike, 1);
    s.position.x = (dem_real)(-way/2);
    s.position.z = 0;
    if (floor == PERIODIC || floor == IMAGES) s.position.x += (dem_real)(10*R);
    dem_body_set(w, b, &s);
    for (k = 0; k < STATES; k++) {
        CHECK_EQ(dem_world_run(w, way/v/STATES, 0, 0), DEM_OK);
        path[k] = scene_state(w, b);
    }
    dem_world_destroy(w);
}
/* The largest differences between two paths. */
static slide paths_apart(const dem_body_state *x, const dem_body_state *y) {
    slide most = {0, 0, 0};
    int k;
    for (k = 0; k < STATES; k++) {
        most.hop = fmax(most.hop, fabs((double)(y[k].position.y - x[k].position.y))/R);
        most.speed = fmax(most.speed, (double)demi_length(demi_sub(y[k].velocity, x[k].velocity)));
        most.spin = fmax(most.spin, (double)demi_length(demi_sub(y[k].spin, x[k].spin))*R);
    }
    return most;
}
/* The state in which a body begins to slide, to fall, or to turn and tip; s: at rest. */
static dem_body_state start_of(int body, int start, dem_body_state s) {
    const int again = start == FALL_AGAIN, flat = body == POLYGON;
    s.velocity = at(1, 0, 0);
    if (start == FALL || again) {
        s.position.y = (dem_real)(1.7*R);
        s.velocity = at(1, flat ? -0.4 : again ? -0.9 : -0.6, again ? 0.3 : 0.2);   /* a polygon is 1 m long */
        s.spin = again ? at(-200, 170, 130) : at(150, 100, -80);
        s.orientation = dem_quat_about(flat ? at(0, 0, 1) : again ? at(0.7, -0.2, 0.4) : at(0.3, 0.5, 0.8), again ? 2 : 1);
    }
    if (start == TURN) {
        s.velocity = at(0.7, 0, 0.3);
        s.spin = at(40, 300, -90);
    }
    if (flat) s.velocity.z = s.spin.x = s.spin.y = 0;
    return s;
}
static int planar_floor(int floor) { return floor == PLANE || floor == PLANES || floor == PROFILES || floor == SQUARES; }
/* The area of the surface of all walls, m2. */
static double area_of(dem_world *w) {
    const demi_wall *s;
    double area = 0;
    int i, k;
    CHECK_EQ(demi_surfaces_make(w), 1);
    CHECK_EQ(w->surface_count, 1);
    for (i = 0, s = w->surfaces; i < s->element_count; i++) {
        dem_vec3 x[3];
        for (k = 0; k < 3; k++) x[k] = demi_at(s->vertices + 3*s->corners[3*i + k]);
        area += (double)demi_length(demi_cross(demi_sub(x[1], x[0]), demi_sub(x[2], x[0])))/2;
    }
    return area;
}
/* A plate of n x n squares of side R without thickness, closed: two facets lie on each other everywhere. */
static void plate_of(dem_world *w, dem_material m, int n, int crossed) {
    static dem_real v[3*64];
    static int32_t t[12*64];
    dem_mesh mesh;
    int i, k;
    for (i = 0; i < (n + 1)*(n + 1); i++) {
        v[3*i] = (dem_real)(R*(i%(n + 1)));
        v[3*i + 1] = 0;
        v[3*i + 2] = (dem_real)(R*(i/(n + 1)));
    }
    for (i = 0; i < n*n; i++) {
        const int a = i/n*(n + 1) + i%n, b = a + 1, c = a + n + 2, d = a + n + 1;
        const int up[6] = {a, d, b, b, d, c}, down[6] = {a, b, d, b, c, d}, other[6] = {a, b, c, a, c, d};
        for (k = 0; k < 6; k++) {
            t[12*i + k] = up[k];
            t[12*i + 6 + k] = crossed ? other[k] : down[k];
        }
    }
    mesh.vertex_count = (n + 1)*(n + 1);
    mesh.triangle_count = 4*n*n;
    mesh.vertices = v;
    mesh.triangles = t;
    dem_wall_mesh_add(w, m, &mesh);
}
/* Six prisms around an axis in one mesh, their triangles in an order of their own. */
static void prisms_of(dem_world *w, dem_material m) {
    dem_real v[3*36];
    int32_t t[24*6];
    dem_mesh mesh;
    int i, k;
    for (i = 0; i < 6; i++) {
        static const int32_t even[24] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5};
        static const int32_t odd[24] = {0, 2, 1, 3, 4, 5, 0, 1, 3, 1, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 5, 0, 3, 5};
        for (k = 0; k < 6; k++) {
            const double a = DEMI_PI/3*(i + k%3 - 1);
            v[18*i + 3*k] = (dem_real)(k%3 ? R*cos(a) : 0);
            v[18*i + 3*k + 1] = (dem_real)(k%3 ? R*sin(a) : 0);
            v[18*i + 3*k + 2] = (dem_real)(k/3*R);
        }
        for (k = 0; k < 24; k++) t[24*i + k] = 6*i + (i%2 ? odd[k] : even[k]);
    }
    mesh.vertex_count = 36;
    mesh.triangle_count = 48;
    mesh.vertices = v;
    mesh.triangles = t;
    dem_wall_mesh_add(w, m, &mesh);
}
/* Cells without a plane to compare with, and those that are known to differ from it. */
static int left_out(int body, int floor, int impulses) {
    if (body == POLYGON && !planar_floor(floor)) return 1;
    /* a contact with a fixed body is not one with a wall: tests/contact/test_flush.c compares blocks with one block */
    if (floor == FIXED) return 1;
    /* a belt carries what rubs on it, which no floor at rest does */
    if (floor == BELTS && floor_friction > 0) return 1;
    /* by springs each of two surfaces acts by itself on a polyhedron between them: up to 0.04 R, 0.17 v and 0.41 v/R */
    return !impulses && floor == BELTS && body >= CUBE;
}
/* How much more than the others a cell may differ. */
static double allowed(int body, int floor, int start, int impulses) {
    /* between both belts points share the weight, but for the tolerance of the solver */
    if (impulses && floor == BELTS && !(floor_tolerance > 0)) return 30;
    /* a face has more points than its rest determines, and how they share the weight is open. Where the floor turns, so do
       the directions of friction, and the shares matter: 4e-7 v and 1e-4 v/R. A plane and one mesh differ by as much. */
    if (impulses && floor == TURNING && body >= CUBE && start == SLIDE && floor_friction > 0) return fine ? 2e5 : 1;
    return !fine && start != SLIDE ? 10 : 1;    /* chaos of bounces, from 1e-7 on */
}
/* All cells of one response, without friction or with it, up to a start; the largest number, over its limit. A cell above
   its limit is printed. */
static double table_of(int impulses, int last, slide limit) {
    double worst = 0;
    int body, floor, start;
    for (body = 0; body < BODIES; body++) {
        const dem_body_state rest = at_rest(body, impulses);
        for (start = 0; start <= last; start++) {
            const dem_body_state s = start_of(body, start, rest);
            dem_body_state plane[STATES], alike[STATES], path[STATES];
            path_of(body, PLANE, 0, impulses, s, 4*R, plane);
            for (floor = MESH; floor < FLOORS; floor++) {
                const int moves = floor_friction > 0 && (floor == TURNING || floor == TABLED);
                slide q;
                double over;
                if (left_out(body, floor, impulses)) continue;
                if (moves) path_of(body, PLANE, floor, impulses, s, 4*R, alike);
                path_of(body, floor, 0, impulses, s, 4*R, path);
                q = paths_apart(path, moves ? alike : plane);
                over = fmax(q.hop/limit.hop, fmax(q.speed/limit.speed, q.spin/limit.spin));
                over /= allowed(body, floor, start, impulses);
                if (over > 1)
                    printf("    a %s %s on %s by %s, friction %g: hop %.3g R, speed %.3g, spin %.3g\n", bodies[body],
                           starts[start], floors[floor], impulses ? "impulses" : "springs", floor_friction, q.hop, q.speed,
                           q.spin);
                worst = fmax(worst, over);
            }
        }
    }
    return worst;
}

/* A floor of ten boxes. Five of them, a gate, rise from a time on; a cube slides onto these before, another one comes too
   late. The motion is set at once, or (start < 0) by gate_rise. */
static dem_world *gate_world(int impulses, double start, dem_body *b) {
    dem_material m;
    dem_shape cube;
    dem_motion rise = DEM_MOTION;
    dem_wall wall;
    dem_world *w = floor_world(CUBE, BOXES, impulses, b);
    dem_body_state s = scene_state(w, b[0]);
    m.id = cube.id = 1;
    CHECK_EQ(dem_world_dt_set(w, impulses ? DEM_R(1e-4) : DEM_R(4e-6)), DEM_OK);
    b[1] = dem_body_add(w, m, cube, at(-5*R, 0.8*R, 0), dem_quat_make(1, 0, 0, 0));
    s.position = at(-2*R, 0.8*R, 0);
    s.velocity = at(1, 0, 0);
    dem_body_set(w, b[0], &s);
    scene_move(w, b[1], at(0.4, 0, 0), at(0, 0, 0));
    rise.kind = DEM_MOTION_TRANSLATING;
    rise.velocity = at(0, 0.2, 0);
    rise.start = start;
    rise.ramp = 0.002;
    for (wall.id = 6; wall.id <= 10 && start >= 0; wall.id++) CHECK_EQ(dem_wall_motion_set(w, wall, &rise), DEM_OK);
    return w;
}
static void gate_rise(dem_world *w) {
    dem_motion rise = DEM_MOTION;
    dem_wall wall;
    rise.kind = DEM_MOTION_TRANSLATING;
    rise.velocity = at(0, 0.2, 0);
    rise.ramp = 0.002;
    for (wall.id = 6; wall.id <= 10; wall.id++) CHECK_EQ(dem_wall_motion_set(w, wall, &rise), DEM_OK);
}

int main(int argc, char **argv) {
    const slide same = {fine ? 1e-9 : 1e-4, fine ? 1e-9 : 1e-3, fine ? 1e-9 : 1e-3};
    test_begin(argc, argv);
    TEST("by springs every body slides, falls and turns on a floor of many parts as on one plane") {
        CHECK_NEAR(table_of(0, TURN, same), 0, 1);
    }
    TEST("by springs every body slides, falls and turns on a rough floor of parts as on a plane") {
        floor_friction = 0.4;
        CHECK_NEAR(table_of(0, TURN, same), 0, 1);
        floor_friction = 0;
    }
    TEST("by impulses every body slides, falls and turns on a floor of many parts as on one plane") {
        floor_tolerance = fine ? 1e-13 : 0;     /* m/s */
        CHECK_NEAR(table_of(1, TURN, same), 0, 1);
    }
    TEST("by impulses every body slides, falls and turns on a rough floor of parts as on a plane") {
        floor_friction = 0.4;
        CHECK_NEAR(table_of(1, TURN, same), 0, 1);
        floor_friction = floor_tolerance = 0;
    }
    TEST("by impulses every body slides over a floor of parts as over a plane, within the tolerance") {
        const slide limit = {fine ? 1e-6 : 1e-3, fine ? 1e-5 : 1e-2, fine ? 2e-5 : 1e-2};
        floor_tolerance = fine ? 1e-7 : 0;      /* m/s: below what is compared */
        CHECK_NEAR(table_of(1, SLIDE, limit), 0, 1);
        floor_tolerance = 0;
    }
    TEST("a body whose lowest corner is not one of its lowest face falls on meshes as on a plane") {
        int impulses, floor, k;                 /* by springs with an attraction, which needs the gap */
        for (impulses = 0; impulses < 2; impulses++)
            for (k = 0; k < 2; k++) {
                dem_body_state s, plane[STATES], path[STATES];
                double worst = 0;
                floor_range = impulses ? 0 : 0.1*R;
                floor_tolerance = fine && impulses ? 1e-13 : 0;
                memset(&s, 0, sizeof s);
                s.position.y = (dem_real)(0.8*R);
                s.velocity = at(1, -0.5, 0.1);
                s.orientation = dem_quat_about(at(0.1*k, 0, 1), DEM_R(0.04));
                path_of(KEEL, PLANE, 0, impulses, s, 4*R, plane);
                for (floor = MESH; floor < BELTS; floor++) {
                    slide q;
                    path_of(KEEL, floor, 0, impulses, s, 4*R, path);
                    q = paths_apart(path, plane);
                    if (fmax(q.speed, q.spin) > same.speed*allowed(KEEL, floor, FALL, impulses))
                        printf("    on %s by %s: hop %.3g R, speed %.3g, spin %.3g\n", floors[floor],
                               impulses ? "impulses" : "springs", q.hop, q.speed, q.spin);
                    worst = fmax(worst, fmax(q.speed, q.spin)/allowed(KEEL, floor, FALL, impulses));
                }
                CHECK_NEAR(worst, 0, same.speed);
            }
        floor_range = floor_tolerance = 0;
    }
    TEST("by springs elastic bodies that are thrown at such a floor, turning, bounce and keep their energy as on one plane") {
        uint64_t seed = 4;
        int body, floor, k;
        floor_restitution = 1;
        for (body = CLUMP; body <= UNION; body++)
            for (k = 0; k < 2; k++) {
                double worst = 0;
                dem_body_state s, plane[STATES], path[STATES];
                memset(&s, 0, sizeof s);
                s.position.y = (dem_real)(1.7*R);
                s.orientation = scene_turn(&seed);
                s.spin = scene_at(&seed, 600, -300, 600, -300, 600, -300);
                s.velocity = at(1, -0.5 - 0.3*scene_random(&seed), 0.2);
                path_of(body, PLANE, 0, 0, s, 5*R, plane);
                for (floor = MESH; floor < BELTS; floor++) {
                    slide q;
                    path_of(body, floor, 0, 0, s, 5*R, path);
                    q = paths_apart(path, plane);
                    if (fmax(q.speed, q.spin) > (fine ? 1e-6 : 1e-2))
                        printf("    a %s off %s: hop %.3g R, speed %.3g, spin %.3g\n", bodies[body], floors[floor], q.hop,
                               q.speed, q.spin);
                    worst = fmax(worst, fmax(q.speed, q.spin));
                }
                CHECK_NEAR(worst, 0, fine ? 1e-6 : 1e-2);
            }
        floor_restitution = 0.3;
    }
    TEST("each wall of a joined surface bears the load of the bodies on it") {
        int floor;
        for (floor = MESHES; floor <= PROFILES; floor++) {
            dem_body b;
            dem_world *w;
            dem_wall first, second;
            dem_wall_loads l, r;
            dem_material m;
            dem_shape cube;
            m.id = cube.id = 1;
            if (floor == PLANES || floor == PLANE_AND_MESH) continue;
            w = floor_world(CUBE, floor, 0, &b);
            dem_body_add(w, m, cube, at(-5*R, 0.8*R, 0), dem_quat_make(1, 0, 0, 0));
            dem_world_settle(w, 2, DEM_R(1e-6), 0, 0);
            first.id = 1;
            second.id = 2;
            dem_wall_loads_get(w, first, &l);
            dem_wall_loads_get(w, second, &r);
            CHECK_NEAR((double)l.force.y/(double)r.force.y, 3, 1e-3);    /* one and a half of a cube, and a half */
            dem_world_destroy(w);
        }
    }
    TEST("a wall that is added or removed in a run leaves the friction of bodies on the others as it was") {
        int kind;
        for (kind = 0; kind < 3; kind++) {      /* a ball, a cube, and a ball by impulses, at rest on a slope */
            dem_world_desc d = DEM_WORLD_DESC;
            const double q[4] = {-0.1, -0.1, 0.1, 0.1}, aside[4] = {0.1, -0.1, 0.2, 0.1};
            dem_world *w;
            dem_material m;
            dem_body b;
            dem_body_state s, t;
            dem_wall more;
            d.gravity = at(2, -9, 0);
            d.threads = 1;
            if (kind == 2) { d.response = DEM_RESPONSE_IMPULSES; d.dt = DEM_R(1e-4); }
            w = dem_world_create(&d);
            m = scene_material(w, 1e7, 0.3, 0.5, 0.5);
            floor_of(w, m, 1, q);
            b = kind == 1 ? dem_body_add(w, m, scene_box(w, 2*R, 2*R, 2*R), at(0, R, 0), dem_quat_make(1, 0, 0, 0))
                : dem_sphere_add(w, m, (dem_real)R, at(0, R, 0));
            CHECK_EQ(dem_world_run(w, 0.2, 0, 0), DEM_OK);
            s = scene_state(w, b);
            more = floor_of(w, m, 1, aside);
            CHECK_EQ(dem_world_run(w, 0.05, 0, 0), DEM_OK);
            t = scene_state(w, b);
            CHECK_NEAR((double)demi_length(demi_sub(t.position, s.position))/R, 0, fine ? 1e-6 : 1e-3);
            dem_wall_remove(w, more);
            CHECK_EQ(dem_world_run(w, 0.05, 0, 0), DEM_OK);
            t = scene_state(w, b);
            CHECK_NEAR((double)demi_length(demi_sub(t.position, s.position))/R, 0, fine ? 1e-6 : 1e-3);
            dem_world_destroy(w);
        }
    }
    TEST("a gate that is to rise later is part of the floor until then, and moves from then on as one that is set then") {
        int impulses, k;
        for (impulses = 0; impulses < 2; impulses++) {
            const int steps = impulses ? 100 : 2500;
            dem_body a[2], b[2];
            dem_world *later, *set = gate_world(impulses, -1, a);
            CHECK_EQ(dem_world_step(set, steps), DEM_OK);
            later = gate_world(impulses, dem_world_time_get(set), b);
            gate_rise(set);
            CHECK_EQ(dem_world_step(later, steps), DEM_OK);
            CHECK_NEAR((double)scene_state(later, b[0]).velocity.x, 1, fine ? 1e-6 : 1e-3);
            CHECK_EQ(dem_world_step(set, 2*steps), DEM_OK);
            CHECK_EQ(dem_world_step(later, 2*steps), DEM_OK);
            for (k = 0; k < 2; k++) {
                const dem_body_state s = scene_state(set, a[k]), t = scene_state(later, b[k]);
                /* impulses: the solver ends at 1e-6 of the speed, 15 R in this time */
                CHECK_NEAR((double)demi_length(demi_sub(s.position, t.position))/R, 0, fine ? impulses ? 1.5e-5 : 1e-9 : 1e-2);
                CHECK(k || (double)t.position.y > 1.8*R);       /* the gate bears the first cube */
                CHECK(!k || (double)t.position.x < -0.7*R);     /* and stops the other one */
            }
            dem_world_destroy(set);
            dem_world_destroy(later);
        }
    }
    TEST("a step in which a motion begins can be repeated after memory ran out, and goes on with the same bits") {
        int impulses;
        for (impulses = 0; impulses < 2; impulses++) {
            uint64_t end = 0;
            long k, calls = 1;
            for (k = 0; k <= calls; k++) {
                scene_memory c;
                dem_body b[2];
                dem_world *w;
                long before;
                floor_memory = &c;
                w = gate_world(impulses, 0.003, b);
                CHECK_EQ(dem_world_run(w, 0.00285, 0, 0), DEM_OK);
                CHECK_EQ(w->surface_count, 1);
                before = c.calls;
                c.refuse = k ? before + k : 0;
                while (dem_world_step(w, 1) == DEM_ERROR_MEMORY || dem_world_time_get(w) < 0.0031) continue;
                CHECK_EQ(w->surface_count, 2);
                if (!k) calls = c.calls - before;
                CHECK_EQ(dem_world_step(w, 20), DEM_OK);
                if (!k) end = dem_world_hash_get(w);
                CHECK_EQ(dem_world_hash_get(w), end);
                dem_world_destroy(w);
                CHECK_EQ(c.blocks, 0);
            }
            CHECK(calls > 20);
        }
        floor_memory = 0;
    }
    TEST("a restart before or after a motion begins goes on with the same bits") {
        int impulses, k;
        for (impulses = 0; impulses < 2; impulses++)
            for (k = 0; k < 4; k++) {
                dem_body b[2];
                dem_world *w = gate_world(impulses, 0.003, b), *again = gate_world(impulses, 0.003, b);
                CHECK_EQ(dem_world_run(w, k == 0 ? 0.001 : k == 1 ? 0.0029 : k == 2 ? 0.00296 : 0.004, 0, 0), DEM_OK);
                CHECK_EQ(dem_checkpoint_write(w, "build/tmp/gate.dem"), DEM_OK);
                CHECK_EQ(dem_checkpoint_read(again, "build/tmp/gate.dem"), DEM_OK);
                CHECK_EQ(again->surface_count, w->surface_count);
                CHECK_EQ(dem_world_step(w, 100), DEM_OK);
                CHECK_EQ(dem_world_step(again, 100), DEM_OK);
                CHECK_EQ(dem_world_hash_get(w), dem_world_hash_get(again));
                dem_world_destroy(w);
                dem_world_destroy(again);
            }
    }
    TEST("a program that leads a wall at rest, step by step, does not make its surface or the lists again") {
        dem_body b[2];
        dem_world *w = gate_world(0, -1, b);
        dem_motion rest = DEM_MOTION;
        dem_wall gate;
        uint64_t lists;
        int i;
        gate.id = 6;
        rest.kind = DEM_MOTION_TRANSLATING;
        CHECK_EQ(dem_world_step(w, 1), DEM_OK);
        lists = dem_counters_get(w).rebuilds;
        for (i = 0; i < 200; i++) {
            CHECK_EQ(dem_wall_motion_set(w, gate, &rest), DEM_OK);
            CHECK_EQ(dem_world_step(w, 1), DEM_OK);
        }
        CHECK_EQ(w->surface_count, 1);
        CHECK(dem_counters_get(w).rebuilds < lists + 20);
        CHECK_NEAR((double)scene_state(w, b[0]).velocity.x, 1, fine ? 1e-6 : 1e-3);
        dem_world_destroy(w);
    }
    TEST("of closed bodies that touch in one mesh the outside remains, however their facets are divided and turned") {
        int one, k;
        for (one = -2; one < 5; one++) {
            const dem_world_desc d = DEM_WORLD_DESC;
            dem_world *w = dem_world_create(&d);
            const dem_material m = scene_material(w, 1e7, 0.3, 0, 0);
            double area = 2*(13*4 + 13*20 + 4*20);
            if (one == 0) prisms_of(w, m);
            else if (one > 2) plate_of(w, m, 5, one == 4);
            else boxes_of(w, m, 10, one, 1.3*R, -4*R, 0, 10*R);
            if (one == 0) area = 6 + 3*sqrt(3.0);
            if (one > 2) area = 25;             /* of a plate one face remains, without holes */
            CHECK_REL(area_of(w)/(R*R), area, fine ? 1e-9 : 1e-4);
            CHECK_EQ(w->surfaces[0].open, one > 2);
            for (k = 0; k < w->surfaces[0].element_count && one < 3; k++) CHECK_EQ(w->surfaces[0].ends[k], 0);
            dem_world_destroy(w);
        }
    }
    TEST("a plane takes over a segment of a profile only if it holds the whole strip along z") {
        static const double normal[4][3] = {{0.6, 0.4, 0}, {0, 0, 1}, {0.6, 0.4, 0.5}, {0.6, 0.4, 0.1}};
        double moved[4];
        int impulses, i;
        for (impulses = 0; impulses < 2; impulses++)
            for (i = 0; i < 4; i++) {
                const dem_real x[4] = {DEM_R(-0.004), 0, 0, DEM_R(-0.006)};     /* a line through the ball */
                const int32_t ends[2] = {0, 1};
                dem_world_desc d = DEM_WORLD_DESC;
                dem_profile profile;
                dem_material m;
                dem_world *w;
                dem_body b;
                memset(&profile, 0, sizeof profile);
                profile.vertex_count = 2; profile.vertices = (dem_real *)x;
                profile.segment_count = 1; profile.segments = (int32_t *)ends;
                d.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
                d.dt = DEM_R(1e-6);
                w = dem_world_create(&d);
                m = scene_material(w, 1e7, 0.3, 0, 0);
                dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED);
                dem_wall_plane_add(w, m, at(-0.004, 0, 0), at(normal[i][0], normal[i][1], normal[i][2]));
                b = dem_sphere_add(w, m, DEM_R(0.0012), at(-0.0015, -0.0018, 0.05));
                CHECK_EQ(dem_world_step(w, 1), DEM_OK);
                moved[i] = (double)scene_state(w, b).position.x + 0.0015;
                CHECK(moved[i] > 1e-9);
                CHECK_REL(moved[i], moved[0], fine ? 1e-6 : 0.02);
                dem_world_destroy(w);
            }
    }
    TEST("where closed boxes touch no face remains between them, however they are stacked") {
        static const struct { int floor, facets; } cases[] = {{BOXES, 84}, {BOXES_IN_MESH, 12}, {DOUBLED, 2}, {MESHES, 4}};
        int i, k;
        for (i = 0; i < 4; i++) {
            dem_body b;
            dem_world *w = floor_world(BALL, cases[i].floor, 0, &b);
            int ends = 0;
            CHECK_EQ(dem_world_run(w, 0, 0, 0), DEM_OK);
            CHECK_EQ(demi_surfaces_make(w), 1);
            CHECK_EQ(w->surface_count, 1);
            CHECK_EQ(w->surfaces[0].element_count, cases[i].facets);     /* of boxes: 12 each, less 4 at 9 places; of one wall as few as can be */
            for (k = 0; k < w->surfaces[0].element_count; k++) ends += w->surfaces[0].ends[k] != 0;
            CHECK_EQ(ends > 0, i > 1);          /* boxes are closed, sheets are not */
            dem_world_destroy(w);
        }
    }
    TEST("no face remains between boxes side by side whose facets are divided among walls") {
        static const int32_t cube[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                         1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
        static const int in_second[] = {0x000, 0x03f, 0x555, 0x249, 0x00c, 0x7fe};      /* bits: triangles */
        int i, k, t;
        for (i = 0; i < 6; i++) {
            const dem_world_desc d = DEM_WORLD_DESC;
            dem_world *w = dem_world_create(&d);
            const dem_material m = scene_material(w, 1e7, 0.3, 0, 0);
            for (k = 0; k < 4; k++) {           /* the first half of either box, then the second */
                dem_real x[24];
                int32_t half[36];
                dem_mesh mesh;
                memset(&mesh, 0, sizeof mesh);
                for (t = 0; t < 8; t++) {
                    x[3*t] = DEM_R(R)*(dem_real)((k%2) + ((t + 1)/2%2));
                    x[3*t + 1] = DEM_R(R)*(dem_real)(t/2%2);
                    x[3*t + 2] = DEM_R(R)*(dem_real)(t/4);
                }
                mesh.vertex_count = 8; mesh.vertices = x; mesh.triangles = half;
                for (t = 0; t < 12; t++)
                    if ((in_second[i] >> t & 1) == k/2) memcpy(half + 3*mesh.triangle_count++, cube + 3*t, 3*sizeof *cube);
                if (mesh.triangle_count) CHECK(dem_wall_mesh_add(w, m, &mesh).id);
            }
            CHECK_REL(area_of(w)/(R*R), 10, fine ? 1e-9 : 1e-4);
            for (k = 0; k < w->surfaces[0].element_count; k++) CHECK_EQ(w->surfaces[0].ends[k], 0);
            dem_world_destroy(w);
        }
    }
    return test_end();
}
