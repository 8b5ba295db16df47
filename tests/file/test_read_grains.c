/* Grains from files: what dem.h writes, extended XYZ of others, text and CSV; and what is wrong with them. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */

static dem_world *heap(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material a, b;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(1e-5);
    world = dem_world_create(&desc);
    a = scene_material(world, 1e6, 0.5, 0.3, 0.1);
    b = scene_material(world, 1e6, 0.5, 0.3, 0.1);
    dem_wall_plane_add(world, a, at(0, 0, 0), at(0, 0, 1));
    (void)b;
    return world;
}
static dem_result parse(dem_world *world, const char *text, dem_grains *g) {
    return dem_grains_parse(world, "some.csv", text, strlen(text), g);
}
static void refused(dem_world *world, const char *text, const char *why) {
    dem_grains g;
    CHECK_EQ(parse(world, text, &g), DEM_ERROR_FORMAT);
    CHECK_STR(dem_world_error_get(world), "dem_grains_parse: some.csv");
    CHECK_STR(dem_world_error_get(world), why);
    CHECK(!g.positions && !g.count);
}

/* Reads two grains that lie as `pair` says; the text is named by its first words. */
static void pair_read(dem_world *world, const char *text, size_t size, dem_grains *g) {
    const double eps = fine ? 1e-15 : 1e-7;
    int k;
    CHECK_EQ(dem_grains_parse(world, "pair", text, size, g), DEM_OK);
    if (g->count != 2) {
        CHECK_EQ(g->count, 2);
        printf("        %.60s\n        %s\n", text, dem_world_error_get(world));
        return;
    }
    for (k = 0; k < 2; k++) {
        CHECK_NEAR(g->positions[3*k], k ? -0.1 : 0.1, eps);
        CHECK_NEAR(g->positions[3*k + 1], k ? 0.25 : 0.2, eps);
        CHECK_NEAR(g->positions[3*k + 2], k ? 0.35 : 0.3, eps);
        CHECK_NEAR(g->radii[k], k ? 0.02 : 0.01, eps);
        if (g->velocities) CHECK_NEAR(g->velocities[3*k + 2], k ? 2 : -1, 0);
        if (g->spins) CHECK_NEAR(g->spins[3*k + 1], k ? 7 : 5, 0);
    }
}
/* Base64 of bytes, behind `out`. */
static size_t base64(const unsigned char *bytes, size_t size, char *out) {
    static const char signs[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t i, n = 0;
    for (i = 0; i < size; i += 3) {
        const unsigned bits = (unsigned)bytes[i] << 16 | (i + 1 < size ? (unsigned)bytes[i + 1] << 8 : 0) |
            (i + 2 < size ? (unsigned)bytes[i + 2] : 0);
        out[n++] = signs[bits >> 18];
        out[n++] = signs[bits >> 12 & 63];
        out[n++] = i + 1 < size ? signs[bits >> 6 & 63] : '=';
        out[n++] = i + 2 < size ? signs[bits & 63] : '=';
    }
    return n;
}
/* A number in so many bytes, the highest first if big. */
static size_t bytes_put(unsigned char *out, const void *number, int size, int big) {
    const uint16_t one = 1;
    const unsigned char *from = (const unsigned char *)number;
    unsigned char first;
    int k;
    memcpy(&first, &one, 1);
    for (k = 0; k < size; k++) out[k] = from[(first == 1) == big ? size - 1 - k : k];
    return (size_t)size;
}
static size_t real_put(unsigned char *out, double number, int wide, int big) {
    const float narrow = (float)number;
    return bytes_put(out, wide ? (const void *)&number : (const void *)&narrow, wide ? 8 : 4, big);
}
/* The pair as VTK writes it. form 0: ascii, 1: base64 in the tags, 2: appended base64, 3: raw. */
static size_t pair_vtp(char *out, int form, int wide, int big, int head) {
    static const double numbers[4][6] = {{0.01, 0.02}, {1, 0, -1, 3, 0, 2}, {0, 5, 0, 0, 7, 0}, {0.1, 0.2, 0.3, -0.1, 0.25, 0.35}};
    static const char *const names[4] = {"radius", "velocity", "omega", "Points"};
    static const char *const formats[4] = {"ascii", "binary", "appended", "appended"};
    static char tail[2000];
    size_t n = 0, offset = 0;
    int a, k;
    n += (size_t)sprintf(out, "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%sEndian\" header_type=\"UInt%d\">\n"
                         " <PolyData>\n  <FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
                         "0</DataArray></FieldData>\n  <Piece NumberOfPoints=\"2\"\n NumberOfVerts=\"2\">\n   <PointData>\n",
                         big ? "Big" : "Little", 8*head);
    for (a = 0; a < 4; a++) {
        const int width = a ? 3 : 1;
        unsigned char bytes[80];
        uint64_t size = (uint64_t)(2*width*(wide ? 8 : 4));
        uint32_t half = (uint32_t)size;
        size_t m = bytes_put(bytes, head == 8 ? (const void *)&size : (const void *)&half, head, big);
        for (k = 0; k < 2*width; k++) m += real_put(bytes + m, numbers[a][k], wide, big);
        if (a == 3) n += (size_t)sprintf(out + n, "   </PointData>\n   <CellData>\n   </CellData>\n   <Points>\n");
        n += (size_t)sprintf(out + n, "    <DataArray type=\"Float%d\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"%s\" "
                             "RangeMin=\"0\" offset=\"%d\">\n", wide ? 64 : 32, names[a], width, formats[form], (int)offset);
        for (k = 0; form == 0 && k < 2*width; k++) n += (size_t)sprintf(out + n, " %.9g", numbers[a][k]);
        if (form == 1) n += base64(bytes, m, out + n);
        if (form == 2) offset += base64(bytes, m, tail + offset);
        if (form == 3) { memcpy(tail + offset, bytes, m); offset += m; }
        n += (size_t)sprintf(out + n, "\n<InformationKey name=\"L2_NORM_RANGE\"><Value index=\"0\">1</Value></InformationKey></DataArray>\n");
    }
    n += (size_t)sprintf(out + n, "   </Points>\n  </Piece>\n </PolyData>\n");
    if (form > 1) {
        n += (size_t)sprintf(out + n, "<AppendedData encoding=\"%s\">\n _", form == 2 ? "base64" : "raw");
        memcpy(out + n, tail, offset);
        n += offset;
    }
    return n + (size_t)sprintf(out + n, "\n</VTKFile>\n");
}

/* n numbers of legacy VTK, of float64 or of int32, as text or as bytes. */
static size_t vtk_put(char *out, const double *reals, const int32_t *wholes, int n, int binary) {
    unsigned char *bytes = (unsigned char *)out;
    size_t size = 0;
    int k;
    for (k = 0; k < n; k++)
        if (!binary) size += (size_t)sprintf(out + size, "%.9g\n", reals ? reals[k] : (double)wholes[k]);
        else size += reals ? real_put(bytes + size, reals[k], 1, 1) : bytes_put(bytes + size, wholes + k, 4, 1);
    return size;
}
/* The pair as VTK's own writer orders it: cells with a number each before the data of the points. One cell has both
   points, more have one each, some of them the same. */
static size_t pair_vtk(char *out, int cells, int binary) {
    static const double radii[2] = {0.01, 0.02}, speeds[6] = {1, 0, -1, 3, 0, 2};
    static const double places[6] = {0.1, 0.2, 0.3, -0.1, 0.25, 0.35};
    static const int32_t one[3] = {2, 0, 1}, many[12] = {1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1};
    static const int32_t block[6] = {7, 8, 9, 10, 11, 12};
    const int size = cells > 1 ? 2*cells : 3;
    size_t n = (size_t)sprintf(out, "# vtk DataFile Version 3.0\nx\n%s\nDATASET POLYDATA\nPOINTS 2 double\n",
                               binary ? "BINARY" : "ASCII");
    n += vtk_put(out + n, places, 0, 6, binary);
    n += (size_t)sprintf(out + n, "\nVERTICES %d %d\n", cells, size);
    n += vtk_put(out + n, 0, cells > 1 ? many : one, size, binary);
    n += (size_t)sprintf(out + n, "\nCELL_DATA %d\nSCALARS block int\nLOOKUP_TABLE default\n", cells);
    n += vtk_put(out + n, 0, block, cells, binary);
    n += (size_t)sprintf(out + n, "\nPOINT_DATA 2\nSCALARS radius double\nLOOKUP_TABLE default\n");
    n += vtk_put(out + n, radii, 0, 2, binary);
    n += (size_t)sprintf(out + n, "\nVECTORS v double\n");
    n += vtk_put(out + n, speeds, 0, 6, binary);
    return n + (size_t)sprintf(out + n, "\n");
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a snapshot reads back to the last bit from VTP and to nine digits from XYZ, and its world continues alike") {
        dem_world *world = heap(), *again = heap(), *text = heap();
        dem_material a, b, own;
        dem_grains g, x;
        dem_bodies bodies;
        int i, k;
        a.id = 1;
        b.id = 2;
        own.id = 0;
        CHECK_EQ(dem_spheres_fill(world, a, DEM_R(0.005),
                                  dem_region_make(box_of(-0.03, -0.03, 0.01, 0.03, 0.03, 0.06)), 40, 1), 40);
        CHECK_EQ(dem_spheres_fill(world, b, DEM_R(0.003),
                                  dem_region_make(box_of(-0.03, -0.03, 0.01, 0.03, 0.03, 0.06)), 40, 1), 40);
        dem_temperature_set(world, 0.05, 3);
        for (i = 0; i < 80; i++) {
            dem_body_state s = scene_state(world, dem_body_id_get(world, i));
            s.spin = at(i, 2, 3);
            dem_body_set(world, dem_body_id_get(world, i), &s);
        }
        CHECK_EQ(dem_vtp_write(world, "build/tmp/grains.vtp"), DEM_OK);
        CHECK_EQ(dem_xyz_write(world, "build/tmp/grains.xyz"), DEM_OK);
        CHECK_EQ(dem_grains_read(again, "build/tmp/grains.vtp", &g), DEM_OK);
        CHECK_EQ(dem_grains_read(text, "build/tmp/grains.xyz", &x), DEM_OK);
        bodies = dem_bodies_get(world);
        CHECK_EQ(g.count, 80);
        CHECK_EQ(x.count, 80);
        for (i = 0; i < 80; i++) {
            CHECK(g.materials && g.materials[i] == bodies.materials[i]);
            CHECK(g.radii[i] >= bodies.positions[4*i + 3] && g.radii[i] <= bodies.positions[4*i + 3]);
            for (k = 0; k < 3; k++) {
                CHECK_NEAR(g.positions[3*i + k], bodies.positions[4*i + k], 0);
                CHECK_NEAR(g.velocities[3*i + k], bodies.velocities[4*i + k], 0);
                CHECK_NEAR(g.spins[3*i + k], bodies.spins[4*i + k], 0);
                CHECK_NEAR(x.positions[3*i + k], bodies.positions[4*i + k], fine ? 1e-9 : 1e-7);
                CHECK_NEAR(x.velocities[3*i + k], bodies.velocities[4*i + k], fine ? 1e-8 : 1e-6);
            }
        }
        CHECK_EQ(dem_grains_add(again, own, &g), DEM_OK);
        CHECK_EQ(dem_grains_add(text, own, &x), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(text), "material is null and the file names no materials");
        CHECK_EQ(dem_grains_add(text, a, &x), DEM_OK);
        CHECK_EQ(dem_world_run_to(world, 0.02, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_run_to(again, 0.02, 0, 0), DEM_OK);
        CHECK_NEAR(dem_totals_get(again).kinetic, dem_totals_get(world).kinetic, (fine ? 1e-9 : 1e-3)*dem_totals_get(world).kinetic);
        CHECK_REL(dem_totals_get(text).mass, dem_totals_get(world).mass, 1e-6);
        g.materials[79] = 3;
        CHECK_EQ(dem_grains_add(again, own, &g), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(again), "material 3 does not exist");
        CHECK_EQ((int)dem_body_counts_get(again).present, 80);      /* all or nothing */
        dem_grains_free(again, &g);
        dem_grains_free(text, &x);
        dem_world_destroy(world);
        dem_world_destroy(again);
        dem_world_destroy(text);
    }

    TEST("text and CSV read by column names in any order, with diameters and comments, or by position; XYZ by "
         "Properties") {
        dem_world *world = heap();
        dem_grains g;
        CHECK_EQ(parse(world, "# made by hand\nname, d, z, y, x, vz\na, 0.02, 3, 2, 1, -5\nb,0.04,6,5,4,7 # last\n", &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        CHECK_NEAR(g.radii[1], 0.02, 1e-9);
        CHECK_NEAR(g.positions[0], 1, 0);
        CHECK_NEAR(g.positions[5], 6, 0);
        CHECK_NEAR(g.velocities[2], -5, 0);
        CHECK_NEAR(g.velocities[0], 0, 0);
        CHECK(!g.spins && !g.materials);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "1 2 3 .5\n4 5 6 .25", &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        CHECK_NEAR(g.positions[3], 4, 0);
        CHECK_NEAR(g.radii[0], 0.5, 0);
        CHECK(!g.velocities);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "1,2,3,.5,7,8,9\r\n", &g), DEM_OK);
        CHECK_EQ(g.count, 1);
        CHECK_NEAR(g.velocities[2], 9, 0);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "x,y,r,material\n1,2,.5,2\n", &g), DEM_OK);     /* discs */
        CHECK_NEAR(g.positions[2], 0, 0);
        CHECK_EQ(g.materials[0], 2);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "2\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=radius:R:1:id:I:1:pos:R:3:species:S:1 Time=3\n"
                       ".5 7 1 2 3 Si\n.25 8 4 5 6 O\n2\nanother frame\n", &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        CHECK_NEAR(g.radii[1], 0.25, 0);
        CHECK_NEAR(g.positions[5], 6, 0);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "0\nProperties=pos:R:3:radius:R:1\n", &g), DEM_OK);
        CHECK_EQ(g.count, 0);
        { dem_material none; none.id = 0; CHECK_EQ(dem_grains_add(world, none, &g), DEM_OK); }
        dem_grains_free(world, &g);
        dem_grains_free(world, &g);                  /* twice does no harm */
        dem_world_destroy(world);
    }

    TEST("table cells read as spreadsheets and programs write them") {
        static const char *const tables[] = {
            "12,5;3,25;8,75;2\n",                                      /* see below */
            "x;y;z;r\n0,1;0,2;0,3;0,01\n-0,1;0,25;0,35;0,02\n", "0,1;0,2;0,3;0,01\n-0,1;0,25;0,35;0,02\n",
            "x\ty\tz\tr\n0,1\t0,2\t0,3\t0,01\n-0,1\t0,25\t0,35\t0,02\n", "0.1\t0.2\t0.3\t0.01\n-0.1\t0.25\t0.35\t0.02\n",
            "sep=;\nx;y;z;r\n0.1;0.2;0.3;0.01\n-0.1;0.25;0.35;0.02\n", "sep=,\r\nx,y,z,r\r\n0.1,0.2,0.3,0.01\r\n-0.1,0.25,0.35,0.02\r\n",
            "\xEF\xBB\xBFX;Y;Z;Radius\r\n0.1;0.2;0.3;0.01\r\n-0.1;0.25;0.35;0.02\r\n",
            "\xEF\xBB\xBF" "0.1 0.2 0.3 0.01\n-0.1 0.25 0.35 0.02\n",
            ",x,y,z,r\n0,0.1,0.2,0.3,0.01\n1,-0.1,0.25,0.35,0.02\n",   /* pandas numbers its rows */
            "\"\",\"x\",\"y\",\"z\",\"r\"\n\"1\",0.1,0.2,0.3,0.01\n\"2\",-0.1,0.25,0.35,0.02\n",      /* R */
            "\"name\",\"x\",\"y\",\"z\",\"r\"\n\"a, b; \"\"c\"\"\",\"0.1\",0.2,0.3,0.01\n\"\",-0.1,0.25,0.35,0.02\n",
            "x (m),y (m),z (m),radius (m)\n0.1,0.2,0.3,0.01\n-0.1,0.25,0.35,0.02\n",
            "x [mm];y [mm];z [mm];d [cm]\n100;200;300;2\n-100;250;350;4\n",
            "x,y,z,r,\n0.1,0.2,0.3,0.01,\n-0.1,0.25,0.35,0.02,\n",     /* a separator at the end */
            "x,y,z,r,note\n0.1,0.2,0.3,0.01,\n-0.1,0.25,0.35,0.02,round\n",
            "#format x_y_z_r_matId\n# t=0\n0.1\t0.2\t0.3\t0.01\t0\n-0.1\t0.25\t0.35\t0.02\t0\n",      /* YADE */
            "# x y z radius\n0.1 0.2 0.3 0.01\n-0.1 0.25 0.35 0.02\n",                                 /* NumPy */
            "\"radius\",\"velocity:0\",\"velocity:1\",\"velocity:2\",\"spin:0\",\"spin:1\",\"spin:2\",\"id\",\"Points:0\",\"Points:1\",\"Points:2\"\n"
            "0.01,1,0,-1,0,5,0,0,0.1,0.2,0.3\n0.02,2,0,2,0,7,0,1,-0.1,0.25,0.35\n",                    /* ParaView */
            "Position.X Position.Y Position.Z Radius\n0.1 0.2 0.3 0.01\n-0.1 0.25 0.35 0.02\n",       /* OVITO */
            "id x y z omegax omegay omegaz radius \n1 0.1 0.2 0.3 0 5 0 0.01 \n2 -0.1 0.25 0.35 0 7 0 0.02 \n"};
        dem_world *world = heap();
        dem_grains g;
        size_t k;
        for (k = 1; k < sizeof tables/sizeof *tables; k++) {
            pair_read(world, tables[k], strlen(tables[k]), &g);
            dem_grains_free(world, &g);
        }
        CHECK_EQ(parse(world, tables[0], &g), DEM_OK);
        CHECK(!g.velocities);
        CHECK_NEAR(g.positions[0], 12.5, 0);
        CHECK_NEAR(g.radii[0], 2, 0);
        dem_grains_free(world, &g);
        dem_world_destroy(world);
    }

    TEST("an empty or bad cell is an error with its line, and the reader lists unused columns") {
        dem_world *world = heap();
        dem_grains g;
        refused(world, "x,y,z,r\n1,2,3,.5\n1,,3,.5\n", "line 3: cell 2 (y) is empty");
        refused(world, "x;y;z;r\n1;2;3;\n", "line 2: cell 4 (r) is empty");
        refused(world, "x\ty\tz\tr\n\t2\t3\t1\n", "line 2: cell 1 (x) is empty");
        refused(world, "x,y,z,r\n1,2,3\n", "line 2: cell 4 (r) is empty");
        refused(world, "x,y,z,r\n1,5,2,3,.5\n", "line 2: found '.5' where the line should end");
        refused(world, "x;y;z;r\n1.000,5;2;3;.5\n", "line 2: found '1.000,5'");
        refused(world, "x (inch),y,z,r\n1,2,3,.5\n", "line 1: the unit of column x (inch) is not known");
        refused(world, "x,y,z,mass\n1,2,3,.5\n", "columns x, y and r (radius) or d (diameter) are needed; not used: mass");
        refused(world, "id xs ys zs radius\n1 .5 .5 .5 1\n", "xs is a fraction of the box");
        CHECK_EQ(parse(world, "id,x,y,z,r,radius,fx,material\n7,1,2,3,.5,9,0,2\n", &g), DEM_OK);
        CHECK_STR(g.ignored, "id, radius, fx");
        CHECK_NEAR(g.radii[0], 0.5, 0);
        CHECK_EQ(g.materials[0], 2);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "type,x,y,z,r,material\n7,1,2,3,.5,2\n", &g), DEM_OK);       /* material before type */
        CHECK_EQ(g.materials[0], 2);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "type,x,y,z,r\nsand,1,2,3,.5\n2,1,2,3,.5\n", &g), DEM_OK);   /* a name is no number */
        CHECK(!g.materials);
        CHECK_STR(g.ignored, "type");
        dem_grains_free(world, &g);
        dem_world_destroy(world);
    }

    TEST("dumps of LAMMPS and LIGGGHTS read unchanged: the first frame, with velocities, spins and types") {
        static const char dump[] = "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n-1 1\n-1 1\n0 2\n"
            "ITEM: ATOMS id type type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius \n"
            "1 1 1 0.1 0.2 0.3 0 0 0 1 0 -1 0 0 0 0 5 0 0.01 \n2 2 2 -0.1 0.25 0.35 0 0 0 3 0 2 0 0 0 0 7 0 0.02 \n";
        static char two[2*sizeof dump];
        dem_world *world = heap();
        dem_grains g;
        size_t cut;
        snprintf(two, sizeof two, "%s%s", dump, dump);
        for (cut = 1; cut < 3; cut++) {
            pair_read(world, two, cut*(sizeof dump - 1), &g);
            CHECK(g.velocities && g.spins && g.materials && g.materials[1] == 2);
            CHECK_EQ(g.lines_left, cut == 2 ? 11 : 0);
            dem_grains_free(world, &g);
        }
        for (cut = 0; cut + 120 < sizeof dump; cut++) CHECK(dem_grains_parse(world, "cut", dump, cut, &g) != DEM_OK);
        dem_world_destroy(world);
    }

    TEST("VTP reads as ascii, base64 and raw, in either byte order, precision and header size; compressed VTP is "
         "rejected") {
        dem_world *world = heap();
        dem_grains g;
        static char text[6000];
        int form, k;
        for (form = 0; form < 4; form++)
            for (k = 0; k < 8; k++) {
                size_t size = pair_vtp(text, form, k & 1, k >> 1 & 1, k & 4 ? 8 : 4), cut;
                dem_grains narrow;
                CHECK_EQ(dem_grains_parse(world, "pair.vtp", text, size, &narrow), DEM_OK);
                CHECK(narrow.velocities && narrow.spins);
                /* as float 0.1 is 0.1 + 1.5e-9 */
                if (narrow.count == 2 && !(k & 1)) CHECK_NEAR(narrow.positions[3], -0.1, 1e-8);
                dem_grains_free(world, &narrow);
                if (k & 1) { pair_read(world, text, size, &g); dem_grains_free(world, &g); }
                for (cut = 0; cut < size; cut += 7)              /* cut anywhere: whole or refused */
                    if (dem_grains_parse(world, "cut", text, cut, &narrow) == DEM_OK) {
                        CHECK_EQ(narrow.count, 2);
                        dem_grains_free(world, &narrow);
                    }
            }
        CHECK_EQ(parse(world, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
                       "compressor=\"vtkZLibDataCompressor\">", &g), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "is compressed (vtkZLibDataCompressor)");
        dem_world_destroy(world);
    }

    TEST("legacy VTK reads as ParaView's and LIGGGHTS' text and as dem.h's binary") {
        static const char words[] = "# vtk DataFile Version 5.1\nvtk # output\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nTimeValue 1 1 double\n0 \n"
            "METADATA\nINFORMATION 0\n\nPOINTS 2 double\n0.1 0.2 0.3 -0.1\n0.25 0.35 \n\nMETADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION "
            "vtkDataArray\nDATA 2 0.374166 1 \n\nVERTICES 3 2\nOFFSETS vtktypeint64\n0 1 2 \nCONNECTIVITY vtktypeint64\n0 1 \nPOINT_DATA 2\n"
            "SCALARS id int\nLOOKUP_TABLE default\n0\n1\nFIELD FieldData 3\nradius 1 2 double\n0.01 0.02 \nMETADATA\nINFORMATION 0\n\n"
            "v 3 2 double\n1 0 -1 3 0 2 \nomega 3 2 double\n0 5 0 0 7 0\n";
        dem_world *world = heap(), *again = heap();
        dem_material a, none;
        dem_grains g;
        unsigned char bytes[800];
        size_t n, cut;
        int k;
        pair_read(world, words, sizeof words - 1, &g);
        CHECK(g.velocities && g.spins);
        dem_grains_free(world, &g);
        n = (size_t)sprintf((char *)bytes, "# vtk DataFile Version 5.1\nx\nBINARY\nDATASET POLYDATA\nPOINTS 2 float\n");
        for (k = 0; k < 6; k++) n += real_put(bytes + n, (k + 1)*0.5, 0, 1);
        n += (size_t)sprintf((char *)bytes + n, "\nVERTICES 3 2\nOFFSETS vtktypeint64\n");
        memset(bytes + n, 10, 24);                               /* bytes that look like ends of lines */
        n += 24 + (size_t)sprintf((char *)bytes + n + 24, "\nCONNECTIVITY vtktypeint64\n");
        memset(bytes + n, 35, 16);
        n += 16 + (size_t)sprintf((char *)bytes + n + 16, "\nPOINT_DATA 2\nSCALARS radius double 1\nLOOKUP_TABLE default\n");
        for (k = 0; k < 2; k++) n += real_put(bytes + n, 0.25*(k + 1), 1, 1);
        CHECK_EQ(dem_grains_parse(world, "bytes.vtk", bytes, n, &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        if (g.count == 2) {
            CHECK_NEAR(g.positions[5], 3, 0);
            CHECK_NEAR(g.radii[1], 0.5, 0);
        }
        dem_grains_free(world, &g);
        for (cut = 0; cut < n; cut++) CHECK(dem_grains_parse(world, "cut", bytes, cut, &g) != DEM_OK);
        a.id = 2;
        none.id = 0;
        CHECK_EQ(dem_spheres_fill(world, a, DEM_R(0.005),
                                  dem_region_make(box_of(-0.03, -0.03, 0.01, 0.03, 0.03, 0.06)), 30, 1), 30);
        dem_temperature_set(world, 0.05, 3);
        CHECK_EQ(dem_vtk_write(world, "build/tmp/grains.vtk"), DEM_OK);
        CHECK_EQ(dem_grains_read(again, "build/tmp/grains.vtk", &g), DEM_OK);
        CHECK_EQ(g.count, 30);
        CHECK(g.materials && g.velocities && g.spins);
        CHECK_EQ(dem_grains_add(again, none, &g), DEM_OK);
        CHECK_NEAR(dem_totals_get(again).kinetic, dem_totals_get(world).kinetic, 0);
        dem_grains_free(again, &g);
        dem_world_destroy(world);
        dem_world_destroy(again);
    }

    TEST("legacy VTK reads with data of cells before those of points, whatever the number of cells, as text and as "
         "bytes") {
        dem_world *world = heap();
        dem_grains g;
        int cells, binary;
        for (binary = 0; binary < 2; binary++)
            for (cells = 1; cells <= 6; cells++) {
                static char text[2000];
                pair_read(world, text, pair_vtk(text, cells, binary), &g);
                CHECK(g.velocities != 0);
                dem_grains_free(world, &g);
            }
        dem_world_destroy(world);
    }

    TEST("every failing allocation of the grain reader gives a memory error and leaves nothing behind") {
        static const char *const texts[] = {"x;y;z;r;vx;vy;vz;omegax;omegay;omegaz;type\n0,1;2;3;,5;1;2;3;4;5;6;1\n",
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 3\nPOINT_DATA 1\nSCALARS radius float\n"
            "LOOKUP_TABLE default\n.5\nVECTORS v float\n1 2 3\n", 0};
        static char vtp[6000];
        dem_world_desc desc = DEM_WORLD_DESC;
        scene_memory memory;
        dem_world *world;
        const size_t vtp_size = pair_vtp(vtp, 1, 1, 0, 4);
        int what;
        scene_memory_use(&memory, &desc);
        world = dem_world_create(&desc);
        for (what = 0; what < 3; what++) {
            const size_t before = memory.bytes;
            dem_result result = DEM_ERROR_MEMORY;
            dem_grains g;
            long k;
            for (k = 1; k < 60 && result != DEM_OK; k++) {
                memory.refuse = memory.calls + k;
                result = dem_grains_parse(world, "x", texts[what] ? texts[what] : vtp, texts[what] ? strlen(texts[what]) : vtp_size, &g);
                if (result == DEM_OK) break;
                CHECK_EQ(result, DEM_ERROR_MEMORY);
                CHECK_STR(dem_world_error_get(world), "memory");
                CHECK(!g.positions && !g.count);
                CHECK_EQ(memory.bytes, before);
            }
            CHECK(k > 3);
            memory.refuse = 0;
            dem_grains_free(world, &g);
            CHECK_EQ(memory.bytes, before);
        }
        dem_world_destroy(world);
    }

    TEST("an error in a grain file names its line and leaves nothing behind") {
        dem_world *world = heap();
        dem_grains g;
        refused(world, "", "line 0: found the end of the file where grains are expected");
        refused(world, "1 2 3\n", "4 columns are expected (x y z r), or 7");
        refused(world, "1 2 3 .5\n1 2 3\n", "line 2: found the end of the line where a number is expected for each column");
        refused(world, "1 2 3 .5\n1 2 3 .5 6\n", "line 2: found '6' where the line should end");
        refused(world, "1 2 3 .5\n1 2 nan .5\n", "line 2: found 'nan'");
        refused(world, "1 2 3 .5\n1 2 3 -1\n", "line 2: found '-1' where a radius");
        refused(world, "x y z\n1 2 3\n", "columns x, y and r (radius) or d (diameter) are needed");
        refused(world, "5\nno properties here\nH 1 2 3\n", "Properties=");
        refused(world, "5\nProperties=species:S:1:pos:R:3:radius:R:1\nH 1 2 3 .5\n", "1 lines of grains where its head announces 5");
        refused(world, "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 3\nPOINTS 99 float\n"
                "1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3\n",
                "cut short");
        refused(world, "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 3\nPOINTS 2 float\n"
                "1 2 3 4 5 6\nPOINT_DATA 2\nSCALARS radius float\nLOOKUP_TABLE default\n1 1\n", "has 2 points, must have 1");
        refused(world, "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 0 float\nPOINTS 1 float\n"
                "1 2 3\nPOINT_DATA 1\nSCALARS radius float\nLOOKUP_TABLE default\n1\n", "has 1 points, must have 0");
        refused(world, "tea and cakes\n", "numbers are expected, or names of columns");
        refused(world, "x y r material\n1 2 .5 1.5\n", "a material is expected, a whole number");
        refused(world, "<?xml version=\"1.0\"?><VTKFile>", "has no piece with points");
        CHECK_EQ(dem_grains_parse(world, 0, "a\0b", 3, &g), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "not text");
        CHECK_EQ(dem_grains_read(world, "build/tmp/there_is_none.csv", &g), DEM_ERROR_FILE);
        CHECK_EQ(dem_grains_read(world, 0, &g), DEM_ERROR_ARGUMENT);
        {                                            /* a VTP file cut anywhere is refused */
            dem_material a;
            FILE *f;
            static char bytes[8000];
            size_t size, cut;
            int whole = 0;
            a.id = 1;
            dem_sphere_add(world, a, DEM_R(0.01), at(0, 0, 1));
            dem_sphere_add(world, a, DEM_R(0.02), at(0, 1, 1));
            CHECK_EQ(dem_vtp_write(world, "build/tmp/cut.vtp"), DEM_OK);
            f = fopen("build/tmp/cut.vtp", "rb");
            CHECK(f != 0);
            size = f ? fread(bytes, 1, sizeof bytes, f) : 0;
            if (f) fclose(f);
            for (cut = 0; cut < size; cut++) {
                if (dem_grains_parse(world, "cut", bytes, cut, &g) == DEM_OK) { whole++; CHECK_EQ(g.count, 2); }
                dem_grains_free(world, &g);
            }
            CHECK(whole < 100);                      /* only what comes after the last array may be missing */
            CHECK_EQ(dem_grains_parse(world, "whole", bytes, size, &g), DEM_OK);
            dem_grains_free(world, &g);
        }
        dem_world_destroy(world);
    }
    TEST("dem_grains_add rejects velocities and spins that are finite but absurd, and adds no grain") {
        static const dem_real slow[3] = {1, 0, 0};
        dem_real place[3] = {1, 1, 1}, radius[1] = {DEM_R(0.001)}, fast[3] = {0, 0, 0};
        dem_world *world = heap();
        dem_material glass;
        uint64_t hash;
        int k;
        glass.id = 1;
        dem_sphere_add(world, glass, DEM_R(0.01), at(0, 0, 1));
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        hash = dem_world_hash_get(world);
        for (k = 0; k < 6; k++) {
            dem_grains g;
            memset(&g, 0, sizeof g);
            memset(fast, 0, sizeof fast);
            fast[k%3] = DEM_R(1e20);
            g.count = 1;
            g.positions = place;
            g.radii = radius;
            g.velocities = k < 3 ? fast : (dem_real *)slow;
            g.spins = k < 3 ? (dem_real *)slow : fast;
            CHECK_EQ(dem_grains_add(world, glass, &g), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error_get(world), k < 3 ? "dem_grains_add: velocity of body 0 is" : "dem_grains_add: spin of body 0 is");
            CHECK_EQ(dem_bodies_get(world).count, 1);
        }
        CHECK_EQ(dem_world_hash_get(world), hash);
        CHECK_EQ(scene_step(world, 10), DEM_OK);
        dem_world_destroy(world);
    }
    return test_end();
}
