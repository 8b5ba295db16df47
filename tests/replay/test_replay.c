/* Replays (dem_replay_open): a reader of the format finds the state of the world in them. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const char film_path[] = "build/tmp/film.html";

/* ---- a reader, written from the description of the format alone ---- */

typedef struct film {
    char *text;                      /* the file */
    const char *at;                  /* where the next block is looked for */
    unsigned char bytes[400000];
    int size, pos;
    double time, resolution;
    int there[300], material[300], shape[300];
    double radius[300], speed[300], own[300];
    long place[300][3];
    unsigned turn[300];
    double wall[9][7];
    int wall_there[9], gone, fresh;
    double value[DEM_REPLAY_VALUES];
    int given;
    int links, link[2000][2];        /* contacts; slots of a and b, -1: a wall */
    double force[2000], point[2000][3];
} film;

static void film_read(film *f, const char *path) {
    FILE *in = fopen(path, "rb");
    const char *r;
    long size;
    memset(f, 0, sizeof *f);
    CHECK(in != 0);
    if (!in) return;
    fseek(in, 0, SEEK_END);
    size = ftell(in);
    rewind(in);
    f->text = (char *)calloc(1, (size_t)size + 1);
    CHECK_EQ((long)fread(f->text, 1, (size_t)size, in), size);
    fclose(in);
    f->at = strstr(f->text, "<script type=\"dem/head\">");
    r = f->at ? strstr(f->at, "\"resolution\":") : 0;
    CHECK(r != 0);
    if (r) f->resolution = atof(r + 13);
}
/* How many blocks of a kind, such as "dem/wall". */
static int film_blocks(const film *f, const char *kind) {
    char mark[40];
    const char *at = f->text;
    int n = 0;
    snprintf(mark, sizeof mark, "<script type=\"%s\">", kind);
    while (at && (at = strstr(at, mark)) != 0) { at++; n++; }
    return n;
}
static double film_number(film *f, int size) {     /* little-endian; 8: float64, 4: float32 */
    unsigned char b[8];
    double number;
    float single;
    int k;
    for (k = 0; k < size; k++) b[demi_is_little_endian() ? k : size - 1 - k] = f->bytes[f->pos++];
    if (size == 8) { memcpy(&number, b, 8); return number; }
    memcpy(&single, b, 4);
    return (double)single;
}
static long film_signed(film *f, int size) {
    long value = 0;
    int k;
    for (k = 0; k < size; k++) value |= (long)f->bytes[f->pos++] << 8*k;
    return size == 4 ? (long)(int32_t)(uint32_t)value : value >= 1L << (8*size - 1) ? value - (1L << 8*size) : value;
}
static int film_count(film *f) {
    int value = 0, bit = 0;
    do { value |= (f->bytes[f->pos] & 127) << bit; bit += 7; } while (f->bytes[f->pos++] & 128);
    return value;
}
static int film_next(film *f) {                    /* 0: there is no frame left */
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    static const char mark[] = "<script type=\"dem/frame\">";
    unsigned v = 0;
    int n = 0, k, i, s;
    const char *c;
    f->at = strstr(f->at, mark);
    if (!f->at) return 0;
    f->at += strlen(mark);
    f->size = f->pos = 0;
    for (c = f->at; *c != '<' && *c != '='; c++) {
        v = v << 6 | (unsigned)(strchr(digits, *c) - digits);
        if (++n%4 == 0) for (k = 2; k >= 0; k--) f->bytes[f->size++] = (unsigned char)(v >> 8*k);
    }
    if (n%4) { v <<= 6*(4 - n%4); for (k = 2; k > 3 - n%4; k--) f->bytes[f->size++] = (unsigned char)(v >> 8*k); }
    f->time = film_number(f, 8);
    for (n = film_count(f); n > 0; n--) {
        dem_wall wall;
        wall.id = film_count(f);
        s = 1 + demi_wall_place(wall);
        f->wall_there[s] = f->bytes[f->pos++];
        for (k = 0; k < 7 && f->wall_there[s]; k++) f->wall[s][k] = film_number(f, 4);
    }
    for (n = f->gone = film_count(f); n > 0; n--) f->there[film_count(f)] = 0;
    for (n = f->fresh = film_count(f); n > 0; n--) {
        s = film_count(f);
        f->there[s] = 1;
        f->material[s] = film_count(f);
        f->shape[s] = film_count(f);
        f->radius[s] = film_number(f, 4);
        f->place[s][0] = f->place[s][1] = f->place[s][2] = 0;
        f->speed[s] = f->own[s] = f->turn[s] = 0;
    }
    for (s = 0; s < 300; s++) {
        int flags, more;
        if (!f->there[s]) continue;
        flags = f->bytes[f->pos++];
        for (k = 0; k < 3; k++) {
            const int size = flags >> 2*k & 3;
            if (size) f->place[s][k] += film_signed(f, size == 3 ? 4 : size);
        }
        if (flags & 64) { i = f->bytes[f->pos++]; f->speed[s] = i ? pow(2, (i - 128)/8.0) : 0; }
        if (!(flags & 128)) continue;
        more = f->bytes[f->pos++];
        if (more & 1) { f->turn[s] = (unsigned)film_signed(f, 2) & 65535u; f->turn[s] |= (unsigned)film_signed(f, 2) << 16; }
        if (more & 2) f->own[s] = film_number(f, 4);
    }
    for (n = f->given = film_count(f); n > 0; n--) { s = film_count(f); f->value[s] = film_number(f, 4); }
    n = strstr(f->text, "\"contacts\":1") ? film_count(f) : 0;
    f->links = n - 1;
    for (i = 0; i < n - 1; i++) {
        f->link[i][0] = film_count(f);
        f->link[i][1] = film_count(f) - 1;
        for (k = 0; k < 3 && f->link[i][1] < 0; k++)
            f->point[i][k] = (double)(f->place[f->link[i][0]][k] + film_signed(f, 2))*f->resolution;
        f->force[i] = pow(2, ((film_signed(f, 2) & 65535) - 32768)/64.0);
    }
    CHECK_EQ(f->pos, f->size);
    return 1;
}
/* Is what the frame tells of every body what the world has? */
static void film_compare(const film *f, const dem_world *w) {
    const dem_bodies b = dem_bodies_get(w);
    int i, k, e, there = 0;
    for (i = 0; i < 300; i++) there += f->there[i];
    CHECK_EQ(there, b.count);
    CHECK_NEAR(f->time, dem_world_time_get(w), 0);
    for (i = 0; i < b.count; i++) {
        const int s = (int)b.slots[i];
        const dem_real *v = b.velocities + 4*i;
        const double speed = sqrt((double)(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]));
        for (k = 0; k < 3; k++)
            CHECK_NEAR((double)f->place[s][k]*f->resolution, (double)b.positions[4*i + k], 0.5001*f->resolution + 1e-7);
        CHECK_EQ(f->material[s], b.materials[i]);
        CHECK_EQ(f->shape[s], b.shapes ? b.shapes[i] : 0);
        CHECK_NEAR(f->radius[s], (double)b.positions[4*i + 3], 1e-9);
        if (speed > 1e-4) CHECK_NEAR(f->speed[s]/speed, 1, 0.045);
        if (b.real_count) CHECK_NEAR(f->own[s], (double)b.reals[i*b.real_count + b.real_count - 1], 1e-4);
        if (f->shape[s]) {
            const int left = (int)(f->turn[s] >> 30);
            double q[4], sum = 0, same = 0;
            int bit = 0;
            for (k = 0; k < 4; k++) {
                if (k == left) continue;
                q[k] = ((int)(f->turn[s] >> bit & 1023) - 511)/511.0*0.70710678;
                sum += q[k]*q[k];
                bit += 10;
            }
            q[left] = sqrt(sum < 1 ? 1 - sum : 0);
            for (e = 0; e < 4; e++) same += q[e]*(double)b.orientations[4*i + e];
            CHECK(fabs(same) > 1 - 4e-6);            /* rad, twice its root: 0.004 */
        }
    }
}

/* ---- scenes ---- */

/* Memory that runs out at the k-th request. */
static int requests_left = -1;
static void *scarce(size_t size, void *user) {
    (void)user;
    if (requests_left == 0) return 0;
    if (requests_left > 0) requests_left--;
    return malloc(size);
}
static void give_back(void *p, size_t size, void *user) { (void)size; (void)user; free(p); }
static dem_world *scene(dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    desc.allocator.alloc_fn = scarce;
    desc.allocator.free_fn = give_back;
    desc.gravity.z = DEM_R(-9.81);
    desc.body_reals = "age warmth";
    desc.threads = 1;
    w = dem_world_create(&desc);
    *stuff = scene_material(w, 1e6, 0.5, 0.4, 0);
    dem_wall_plane_add(w, *stuff, at(0, 0, 0), at(0, 0, 1));
    return w;
}
static double number_now(const dem_world *w, dem_body body, void *user) {
    (void)w; (void)body;
    return *(const double *)user;
}
static double warmth_of(const dem_world *w, dem_body body, void *user) {
    dem_real reals[2];
    (void)user;
    return dem_body_reals_get(w, body, reals) == DEM_OK ? -(double)reals[1] : 0;
}

int main(int argc, char **argv) {
    static film f;
    test_begin(argc, argv);
    TEST("a replay holds times, positions to half its resolution, speeds to 4.5 %, orientations to 0.004 rad, and all "
         "values") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        dem_shape egg = dem_shape_ellipsoid_add(w, at(0.002, 0.001, 0.0015));
        dem_replay *film;
        int k, i;
        desc.number = "warmth";
        dem_bodies_fill(w, stuff, egg, dem_region_make(box_of(-0.01, -0.01, 0, 0.01, 0.01, 0.02)), 30, 1);
        dem_spheres_fill(w, stuff, DEM_R(0.001), dem_region_make(box_of(-0.01, -0.01, 0.02, 0.01, 0.01, 0.04)),
                         60, 2);
        film = dem_replay_open(w, film_path, &desc);
        CHECK(film != 0);
        for (k = 0; k < 6; k++) {
            if (k) CHECK_EQ(dem_world_run(w, DEM_R(0.01), 0, 0), DEM_OK);
            for (i = 0; i < dem_bodies_get(w).count; i++) {
                dem_real reals[2];
                reals[0] = 1; reals[1] = (dem_real)(300 + i + 100*k*(i%2));
                dem_body_reals_set(w, dem_body_id_get(w, i), reals);
            }
            CHECK_EQ(dem_replay_value_set(film, "kinetic energy (J)", dem_totals_get(w).kinetic), DEM_OK);
            if (k > 2) CHECK_EQ(dem_replay_value_set(film, "late", 10*k), DEM_OK);
            CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
            dem_checkpoint_write(w, k == 0 ? "build/tmp/film0.ckpt" : k == 5 ? "build/tmp/film5.ckpt" : "build/tmp/film.ckpt");
        }
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        CHECK_EQ(film_blocks(&f, "dem/frame"), 6);
        CHECK_EQ(film_blocks(&f, "dem/shape"), 1);
        CHECK_EQ(film_blocks(&f, "dem/wall"), 1);
        CHECK_EQ(film_blocks(&f, "dem/value"), 2);
        CHECK_EQ(film_blocks(&f, "dem/report"), 1);
        for (k = 0; k < 6; k++) {
            CHECK_EQ(film_next(&f), 1);
            CHECK_EQ(f.given, k > 2 ? 2 : 1);
            if (k > 2) CHECK_NEAR(f.value[1], 10*k, 0);
            if (k == 0 || k == 5) {
                CHECK_EQ(dem_checkpoint_read(w, k ? "build/tmp/film5.ckpt" : "build/tmp/film0.ckpt"), DEM_OK);
                film_compare(&f, w);
                CHECK_NEAR(f.value[0], dem_totals_get(w).kinetic, 1e-6*dem_totals_get(w).kinetic + 1e-20);
            }
        }
        CHECK_EQ(film_next(&f), 0);
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("a replay shows added and removed bodies, reused slots and changing walls in the right frame") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_motion motion = DEM_MOTION;
        dem_body first = dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 0.002));
        dem_wall wall;
        dem_replay *film = dem_replay_open(w, film_path, 0);
        int k;
        dem_sphere_add(w, stuff, DEM_R(0.002), at(0.01, 0, 0.002));
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        dem_body_remove(w, first);
        for (k = 0; k < 3; k++) {
            wall = dem_wall_cylinder_add(w, stuff, at(0, 0, 0.1), at(1, 0, 0), DEM_R(0.01), 0);
            if (k < 2) dem_wall_remove(w, wall);
        }
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity.x = 1;
        dem_wall_motion_set(w, wall, &motion);
        CHECK_EQ(dem_world_run(w, DEM_R(0.01), 0, 0), DEM_OK);
        dem_sphere_add(w, stuff, DEM_R(0.003), at(0, 0.05, 0.004));     /* into the slot of the first */
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        dem_wall_remove(w, wall);
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        CHECK_EQ(film_next(&f), 1);
        CHECK_EQ(f.fresh, 2);
        CHECK_EQ(f.wall_there[1], 1);
        CHECK_EQ(film_next(&f), 1);
        CHECK_EQ(f.fresh, 1);
        CHECK_EQ(f.gone, 1);
        film_compare(&f, w);
        CHECK_EQ(f.wall_there[1 + demi_wall_place(wall)], 1);
        CHECK_NEAR(f.wall[1 + demi_wall_place(wall)][0], dem_world_time_get(w), 1e-7);
        CHECK_EQ(film_next(&f), 1);
        CHECK_EQ(f.fresh + f.gone, 0);
        CHECK_EQ(f.wall_there[1 + demi_wall_place(wall)], 0);
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("the replay of a settling bed takes less than 10 bytes per grain and frame, and of one at rest less than 3") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay *film;
        long size[3];
        int k, part;
        FILE *in;
        dem_spheres_fill(w, stuff, DEM_R(0.001), dem_region_make(box_of(-0.008, -0.008, 0, 0.008, 0.008, 0.03)),
                         250, 2);
        size[0] = 0;
        for (part = 0; part < 3; part++) {                /* nothing; settling; at rest */
            film = dem_replay_open(w, film_path, 0);
            for (k = 0; k < (part ? 20 : 1); k++) {
                CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
                if (part == 1) dem_world_run(w, DEM_R(0.01), 0, 0);
            }
            CHECK_EQ(dem_replay_close(film), DEM_OK);
            in = fopen(film_path, "rb");
            fseek(in, 0, SEEK_END);
            size[part] = ftell(in);
            fclose(in);
        }
        CHECK((double)(size[1] - size[0])/(250*19) < 10);
        CHECK((double)(size[2] - size[0])/(250*19) < 3);
        dem_world_destroy(w);
    }
    TEST("every n-th frame of a replay has the forces above 1 % of its largest, within 1.1 %") {
        static dem_contact_info all[2000];
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        dem_replay *film;
        int k, i, n = 0, strong = 0, walls = 0;
        double most = 0;
        desc.contacts = -1;
        CHECK(dem_replay_open(w, film_path, &desc) == 0);
        CHECK_STR(dem_world_error_get(w), "contacts is -1");
        desc.contacts = 2;
        dem_spheres_fill(w, stuff, DEM_R(0.001), dem_region_make(box_of(-0.008, -0.008, 0, 0.008, 0.008, 0.03)), 250, 2);
        film = dem_replay_open(w, film_path, &desc);
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);                 /* no list of contacts yet: none */
        dem_world_run(w, 0.1, 0, 0);
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        n = dem_contacts_get(w, all, 2000);
        for (k = 0; k < n; k++) most = fmax(most, sqrt((double)demi_dot(all[k].force, all[k].force)));
        film_read(&f, film_path);
        for (k = 0; k < 2; k++) { CHECK(film_next(&f)); CHECK_EQ(f.links, -1); }
        CHECK(film_next(&f));
        for (k = i = 0; k < n; k++) {
            const double force = sqrt((double)demi_dot(all[k].force, all[k].force));
            if (force < 0.01*most || i >= f.links) continue;
            strong++;
            CHECK_EQ(f.link[i][0], (int)all[k].a.slot - 1);
            CHECK_EQ(f.link[i][1], (int)all[k].b.slot - 1);
            CHECK_NEAR(f.force[i]/force, 1, 0.011);
            if (all[k].wall) {
                walls++;
                CHECK_NEAR(f.point[i][0], (double)all[k].point.x, f.resolution);
                CHECK_NEAR(f.point[i][2], (double)all[k].point.z, f.resolution);
            }
            i++;
        }
        CHECK(f.links == strong && strong > 50 && walls > 10 && strong < n);
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("a replay shows number_fn under its name, and no title, name or report can end the page's scripts") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        dem_replay *film;
        const dem_real reals[2] = {1, 25};
        desc.title = "a </script> \"title\"\\";
        desc.number_fn = warmth_of;
        desc.number = "cold <b>";
        dem_body_reals_set(w, dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 1)), reals);
        film = dem_replay_open(w, film_path, &desc);
        CHECK_EQ(dem_replay_value_set(film, "</script>", 1), DEM_OK);
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        CHECK(strstr(f.text, "\"title\":\"a \\u003c/script> \\u0022title\\u0022\\u005c\"") != 0);
        CHECK(strstr(f.text, "\"number\":\"cold \\u003cb>\"") != 0);
        CHECK_EQ(film_next(&f), 1);
        CHECK_NEAR(f.own[0], -25, 0);
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("a number that is NaN in one frame returns in the next frame of a replay") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        static const double numbers[] = {5, NAN, NAN, 7, 7, NAN, -1};
        double now = 0;
        dem_replay *film;
        int k;
        desc.number_fn = number_now;
        desc.user = &now;
        dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 1));
        film = dem_replay_open(w, film_path, &desc);
        for (k = 0; k < 7; k++) {
            now = numbers[k];
            CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        }
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        for (k = 0; k < 7; k++) {
            CHECK_EQ(film_next(&f), 1);
            if (numbers[k] < 1e300) CHECK_NEAR(f.own[0], numbers[k], 0); else CHECK(f.own[0] != f.own[0]);
        }
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("bad replay values are rejected with an error, and the old file stays until the new one is closed") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        dem_replay *film;
        char name[80];
        int k;
        CHECK(!dem_replay_open(0, film_path, 0));
        CHECK(!dem_replay_open(w, 0, 0));
        CHECK_STR(dem_world_error_get(w), "dem_replay_open: path is null");
        CHECK(!dem_replay_open(w, "build/tmp/no/such/replay.html", 0));
        CHECK_STR(dem_world_error_get(w), "dem_replay_open: cannot write build/tmp/no/such/replay.html");
        desc.number = "charm";
        CHECK(!dem_replay_open(w, film_path, &desc));
        CHECK_STR(dem_world_error_get(w), "number is \"charm\", which desc.body_reals does not name");
        desc.number = 0;
        desc.resolution = -1;
        CHECK(!dem_replay_open(w, film_path, &desc));
        CHECK_STR(dem_world_error_get(w), "resolution is -1 m, must be >= 0");
        CHECK_EQ(dem_replay_frame_write(0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_replay_value_set(0, "a", 1), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_replay_close(0), DEM_ERROR_ARGUMENT);
        remove(film_path);
        film = dem_replay_open(w, film_path, 0);
        CHECK_EQ(dem_replay_close(film), DEM_OK);          /* no frame: still a page, with its report */
        film = dem_replay_open(w, film_path, 0);
        for (k = 0; k < DEM_REPLAY_VALUES; k++) {
            snprintf(name, sizeof name, "value %d", k);
            CHECK_EQ(dem_replay_value_set(film, name, k ? 1 : sqrt(-1.0)), DEM_OK);
        }
        CHECK_EQ(dem_replay_value_set(film, "one more", 1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "a replay draws at most 16");
        CHECK_EQ(dem_replay_value_set(film, "value 3", 1), DEM_OK);
        CHECK_EQ(dem_replay_value_set(film, "", 1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "dem_replay_value_set: name is empty");
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        film_read(&f, film_path);
        CHECK_EQ(film_blocks(&f, "dem/frame"), 0);
        free(f.text);
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        CHECK_EQ(film_next(&f), 1);
        CHECK_EQ(f.given, DEM_REPLAY_VALUES - 1);          /* what is no number leaves a gap */
        free(f.text);
        CHECK(system("ls build/tmp/film.html.* > build/tmp/beside 2> build/tmp/beside.err") != 0);
        dem_world_destroy(w);
    }
    TEST("a replay with an interval takes a frame at the start and after each interval, and changes no bit of the "
         "run") {
        dem_material stuff;
        dem_world *w = scene(&stuff), *bare = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        dem_replay *film[2];
        double dt;
        int k;
        dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 0.01));
        dem_sphere_add(bare, stuff, DEM_R(0.001), at(0, 0, 0.01));
        CHECK_EQ(dem_world_step(w, 7), DEM_OK);
        CHECK_EQ(dem_world_step(bare, 7), DEM_OK);
        desc.interval = -1;
        CHECK(!dem_replay_open(w, film_path, &desc));
        CHECK_STR(dem_world_error_get(w), "dem_replay_open: interval is -1 s, must be >= 0");
        desc.interval = 0.01;
        film[0] = dem_replay_open(w, film_path, &desc);
        desc.interval = 0.025;
        film[1] = dem_replay_open(w, "build/tmp/film2.html", &desc);
        dt = dem_world_time_get(w);
        for (k = 0; k < 2; k++) CHECK_EQ(dem_world_run(w, 0.03, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_step(w, (int)(0.041/(double)dem_counters_get(w).dt)), DEM_OK);
        CHECK_EQ(dem_world_step(bare, (int)(dem_world_steps_get(w) - 7)), DEM_OK);
        CHECK_EQ(dem_replay_close(film[0]), DEM_OK);
        CHECK_EQ(dem_world_step(w, 10), DEM_OK);
        CHECK_EQ(dem_replay_close(film[1]), DEM_OK);
        CHECK_EQ(dem_world_step(w, 10), DEM_OK);
        CHECK_EQ(dem_world_step(bare, 20), DEM_OK);
        CHECK(dem_world_hash_get(w) == dem_world_hash_get(bare));
        film_read(&f, film_path);
        CHECK_EQ(film_blocks(&f, "dem/frame"), 11);
        for (k = 0; k < 11; k++) {
            CHECK_EQ(film_next(&f), 1);
            CHECK_NEAR(f.time, dt + 0.01*k, 0.5001*(double)dem_counters_get(w).dt);
        }
        free(f.text);
        film_read(&f, "build/tmp/film2.html");
        CHECK_EQ(film_blocks(&f, "dem/frame"), 5);
        free(f.text);
        dem_world_destroy(w);
        dem_world_destroy(bare);
    }
    TEST("a replay with an interval continues after a checkpoint is read, with no frame twice and none missing") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        dem_replay *film;
        int k;
        dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 0.01));
        desc.interval = 0.01;
        film = dem_replay_open(w, film_path, &desc);
        CHECK_EQ(dem_world_run_to(w, 0.03, 0, 0), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(w, "build/tmp/film.ckpt"), DEM_OK);
        CHECK_EQ(dem_world_run_to(w, 0.05, 0, 0), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(w, "build/tmp/film.ckpt"), DEM_OK);
        CHECK_EQ(dem_world_run_to(w, 0.1, 0, 0), DEM_OK);
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        CHECK_EQ(film_blocks(&f, "dem/frame"), 11);
        for (k = 0; k < 11; k++) {
            CHECK_EQ(film_next(&f), 1);
            CHECK_NEAR(f.time, 0.01*k, 0.5001*(double)dem_counters_get(w).dt);
        }
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("a failing allocation in a replay is reported and loses only the replay") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_replay *film;
        int k, whole = 0, refused = 0;
        dem_result first, second;
        dem_replay_desc desc = DEM_REPLAY_DESC;
        desc.contacts = 1;
        dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 1));
        CHECK_EQ(dem_world_step(w, 1), DEM_OK);
        for (k = 0; k < 40 && !whole; k++) {
            requests_left = k;
            film = dem_replay_open(w, film_path, &desc);
            if (!film) { refused++; CHECK_STR(dem_world_error_get(w), "memory"); requests_left = -1; continue; }
            first = dem_replay_frame_write(film);
            second = dem_replay_frame_write(film);
            if (first != DEM_OK) { refused++; CHECK(second != DEM_OK); CHECK_STR(dem_world_error_get(w), "dem_replay_frame_write: out of memory"); }
            whole = first == DEM_OK && second == DEM_OK;
            requests_left = -1;
            CHECK_EQ(dem_replay_close(film), whole ? DEM_OK : DEM_ERROR_MEMORY);
        }
        CHECK(whole && refused > 4);
        CHECK_EQ(dem_world_run(w, DEM_R(0.001), 0, 0), DEM_OK);
        dem_world_destroy(w);
    }
    TEST("a replay changes no bit of a run") {
        dem_material stuff;
        dem_world *a = scene(&stuff), *b = scene(&stuff);
        dem_replay *film;
        int k;
        for (k = 0; k < 2; k++)
            dem_spheres_fill(k ? b : a, stuff, DEM_R(0.001),
                             dem_region_make(box_of(-0.005, -0.005, 0, 0.005, 0.005, 0.02)), 100, 2);
        dem_replay_desc desc = DEM_REPLAY_DESC;
        desc.contacts = 1;
        film = dem_replay_open(a, film_path, &desc);
        for (k = 0; k < 20; k++) {
            CHECK_EQ(dem_world_step(a, 50), DEM_OK);
            CHECK_EQ(dem_world_step(b, 50), DEM_OK);
            CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        }
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
        dem_world_destroy(a);
        dem_world_destroy(b);
    }
    TEST("a replay writes a body whose radius changes as gone and new in one frame") {
        dem_material stuff;
        dem_world *w = scene(&stuff);
        dem_body ball = dem_sphere_add(w, stuff, DEM_R(0.001), at(0, 0, 0.01));
        dem_replay *film = dem_replay_open(w, film_path, 0);
        int k;
        dem_sphere_add(w, stuff, DEM_R(0.001), at(0.01, 0, 0.02));
        for (k = 0; k < 3; k++) {
            if (k == 1) CHECK_EQ(dem_body_radius_set(w, ball, DEM_R(0.002)), DEM_OK);
            if (k == 1) CHECK_EQ(dem_world_step(w, 1), DEM_OK);
            CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        }
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        for (k = 0; k < 3; k++) {
            CHECK_EQ(film_next(&f), 1);
            CHECK_EQ(f.gone, k == 1);
            CHECK_EQ(f.fresh, k == 0 ? 2 : k == 1);
            CHECK_NEAR(f.radius[0], k ? 0.002 : 0.001, 1e-9);
        }
        film_compare(&f, w);
        free(f.text);
        dem_world_destroy(w);
    }
    TEST("a replay shows the radii, materials and shapes of a checkpoint that is read between two frames") {
        /* number 0: as before; 1: another radius; 2: another material; 3: another shape */
        static const char saved[] = "build/tmp/film.ckpt";
        int k;
        for (k = 0; k < 4; k++) {
            dem_world *w[2];                   /* recorded; writes the checkpoint */
            dem_replay *film;
            int i;
            for (i = 0; i < 2; i++) {
                dem_material stuff, other;
                dem_shape egg;
                const int what = i ? k : 0;
                w[i] = scene(&stuff);
                other = scene_material(w[i], 1e6, 0.5, 0.4, 0);
                egg = dem_shape_ellipsoid_add(w[i], at(0.001, 0.0005, 0.0005));
                if (what == 3) dem_body_add(w[i], stuff, egg, at(0, 0, 0.01), dem_quat_make(1, 0, 0, 0));
                else dem_sphere_add(w[i], what == 2 ? other : stuff, DEM_R(what == 1 ? 0.002 : 0.001), at(0, 0, 0.01));
                dem_body_add(w[i], other, egg, at(0.01, 0, 0.01), dem_quat_make(1, 0, 0, 0));
            }
            film = dem_replay_open(w[0], film_path, 0);
            CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
            CHECK_EQ(scene_step(w[1], 2), DEM_OK);
            CHECK_EQ(dem_checkpoint_write(w[1], saved), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(w[0], saved), DEM_OK);
            CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
            CHECK_EQ(dem_replay_close(film), DEM_OK);
            film_read(&f, film_path);
            CHECK_EQ(film_next(&f), 1);
            CHECK_EQ(film_next(&f), 1);
            CHECK_EQ(f.gone, k > 0);
            CHECK_EQ(f.fresh, k > 0);
            film_compare(&f, w[0]);
            free(f.text);
            for (i = 0; i < 2; i++) dem_world_destroy(w[i]);
        }
        remove(saved);
    }
    TEST("in a replay the force of a wall beyond a periodic face points to the nearest image of the wall") {
        static const dem_real at_wall[3] = {DEM_R(0.007), 0, 0};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_replay_desc show = DEM_REPLAY_DESC;
        dem_world *w;
        dem_material stuff;
        dem_replay *film;
        desc.threads = 1;
        desc.dt = DEM_R(1e-5);
        desc.domain = box_of(0, -1, -1, 0.1, 1, 1);
        desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
        w = dem_world_create(&desc);
        stuff = scene_material(w, 1e7, 0.5, 0, 0);
        CHECK(dem_wall_grains_add(w, stuff, 1, at_wall, DEM_R(0.005), 1).id > 0);
        dem_sphere_add(w, stuff, DEM_R(0.005), at(0.0971, 0, 0));      /* the wall's image is at 0.107 */
        show.contacts = 1;
        film = dem_replay_open(w, film_path, &show);
        CHECK_EQ(scene_step(w, 1), DEM_OK);
        CHECK_EQ(dem_replay_frame_write(film), DEM_OK);
        CHECK_EQ(dem_replay_close(film), DEM_OK);
        film_read(&f, film_path);
        CHECK_EQ(film_next(&f), 1);
        CHECK_EQ(f.links, 1);
        CHECK_NEAR(f.point[0][0], 0.10205, 2e-4);            /* the centre and about one radius */
        CHECK_NEAR(f.point[0][1], 0, 2e-4);
        CHECK_NEAR(f.point[0][2], 0, 2e-4);
        free(f.text);
        dem_world_destroy(w);
    }
    return test_end();
}
