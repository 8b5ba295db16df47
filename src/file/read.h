/* ---------------------------------------------------------------------------------------------
   >>read
   Input files: triangle meshes (STL, OBJ, the text format of [MIL]) and profiles. A file is loaded
   completely and given to the parser that also serves data in memory. This part owns demi_text, a
   text being read, which >>read-tables and >>read-grains use, too.

   The contents are not trusted: nothing is read past the end, every count is compared with the
   number of bytes before memory is allocated for it, and error messages name the line. A parser
   moves through the text with demi_text_line and demi_text_word, and reads the current word with
   demi_text_is, demi_text_real and demi_text_corner. OBJ and STL text contain no counts, so there
   are two passes: the first counts, the second fills arrays of the right size.
   ---------------------------------------------------------------------------------------------- */
#include <errno.h>

/* Most vertices or triangles: three times as many fit an int32. */
#define DEMI_ELEMENTS_MAX 700000000

/* ---- reading text ---- */

/* A text being read, which does not end with a zero, and what error messages need. A copy of the
   struct remembers a position. */
typedef struct demi_text {
    dem_world *world;
    const char *call, *name;    /* for error messages: the public function; the file or data      */
    const char *word;           /* the current word; null at the end of the text                  */
    size_t length;              /* of the word; 0 at the end of a line                            */
    const char *at, *line_end;  /* the rest of the line                                           */
    const char *next, *end;     /* the rest of the text, after this line                          */
    const char *data;           /* beginning of the text                                          */
    long line;                  /* number of the line, from 1; 0 before the first                 */
    char half[24];              /* 0.5 as printed in this locale, for its decimal point           */
    const char *part;           /* meshes: read the part of this name only; null: read all        */
    char *parts;                /* meshes: names of the parts found, DEMI_PARTS_MOST bytes        */
    int apart;                  /* STL: 1 within another part                                     */
    dem_mesh_health *health;    /* meshes: receives defects found in reading, not null            */
} demi_text;
enum { DEMI_PARTS_MOST = 160 };

/* Returns a text at its beginning, behind a byte order mark. Numbers in files have a decimal point
   in every locale, but strtod expects that of the locale: `half` stores it. */
static demi_text demi_text_make(dem_world *w, const char *call, const char *name, const char *data,
                                size_t size) {
    demi_text t;
    size_t length = name ? strlen(name) : 0;
    memset(&t, 0, sizeof t);
    t.world = w;
    t.call = call;
    t.name = !name ? "data" : length > 200 ? name + (length - 200) : name;
    t.data = data;
    t.end = data + size;
    t.next = size >= 3 && memcmp(data, "\xEF\xBB\xBF", 3) == 0 ? data + 3 : data;
    t.at = t.line_end = t.next;
    if (snprintf(t.half, sizeof t.half, "%.1f", 0.5) < 3) memcpy(t.half, "0.5", 4);
    return t;
}

/* Moves to the next word of the line. Returns 0 if there is none. */
static int demi_text_word(demi_text *t) {
    const char *p = t->at;
    while (p < t->line_end && (*p == ' ' || *p == '\t' || *p == '\v' || *p == '\f')) p++;
    t->word = p;
    while (p < t->line_end && !(*p == ' ' || *p == '\t' || *p == '\v' || *p == '\f')) p++;
    t->at = p;
    t->length = (size_t)(p - t->word);
    return t->length > 0;
}

/* Moves to the first word of the next line that has words. # begins a comment. Returns 0 at the end
   of the text. */
static int demi_text_line(demi_text *t) {
    while (t->next < t->end) {
        const char *p = t->next, *comment;
        t->at = p;
        t->line++;
        while (p < t->end && *p != '\n' && *p != '\r') p++;
        comment = (const char *)memchr(t->at, '#', (size_t)(p - t->at));
        t->line_end = comment ? comment : p;
        if (p < t->end) p += *p == '\r' && t->end - p > 1 && p[1] == '\n' ? 2 : 1;
        t->next = p;
        if (demi_text_word(t)) return 1;
    }
    t->at = t->line_end = t->end;
    t->word = 0;
    t->length = 0;
    return 0;
}

/* Fails with an error message about the current word. `where` says what is expected in its place
   and what to do. */
static dem_result demi_text_fail(const demi_text *t, const char *where) {
    char shown[44] = "'";
    size_t i, length = t->length < 40 ? t->length : 40;
    for (i = 0; i < length; i++)
        shown[i + 1] = (char)(t->word[i] >= 32 && t->word[i] < 127 ? t->word[i] : '?');
    shown[length + 1] = '\'';
    return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: found %s where %s", t->call,
                     t->name, t->line, t->length ? shown : t->word ? "the end of the line" :
                     "the end of the file", where);
}

static dem_result demi_text_memory(const demi_text *t) {
    return demi_fail(t->world, DEM_ERROR_MEMORY, "%s: %s: not enough memory for its contents; "
                     "free some, or simplify the mesh", t->call, t->name);
}

/* True if the current word is this one, in upper or lower case. `word` is in lower case. */
static int demi_text_is(const demi_text *t, const char *word) {
    size_t i;
    if (t->length != strlen(word)) return 0;
    for (i = 0; i < t->length; i++) {
        char c = t->word[i];
        if ((c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c) != word[i]) return 0;
    }
    return 1;
}

/* Reads the current word as a coordinate: a decimal number with a point, within 1e15; nan, inf and
   hexadecimal numbers are errors. strtod rounds correctly, but needs a copy that ends with a zero
   and has the decimal point of the locale. */
static dem_result demi_text_number(demi_text *t, double *value) {
    char copy[160], *end = copy;
    size_t i, n = 0, point = strlen(t->half) - 2;
    int points = 0, bad = t->length == 0 || t->length > 120;
    double number = 0;
    for (i = 0; i < t->length && !bad; i++) {
        char c = t->word[i];
        if (c == '.' && points++ == 0) {
            memcpy(copy + n, t->half + 1, point);
            n += point;
        } else {
            bad = !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != 'e' && c != 'E';
            copy[n++] = c;
        }
    }
    copy[bad ? 0 : n] = 0;
    if (!bad) number = strtod(copy, &end);
    if (bad || end != copy + n || number > DEMI_FARTHEST || number < -DEMI_FARTHEST)
        return demi_text_fail(t, "a coordinate is expected, a decimal number within +-1e15 (m); "
                              "correct it or export the file again");
    *value = number == 0 ? 0 : number; /* -0 becomes 0: both are the same position */
    return DEM_OK;
}
static dem_result demi_text_real(demi_text *t, dem_real *value) {
    double number = 0;
    const dem_result result = demi_text_number(t, &number);
    if (result == DEM_OK) *value = (dem_real)number;
    return result;
}

/* Reads the first `length` bytes of the current word as an integer of at most 9 digits. Returns 0
   if they are no such number. */
static int demi_text_integer(const demi_text *t, size_t length, int32_t *value) {
    size_t i = length > 0 && (t->word[0] == '-' || t->word[0] == '+') ? 1 : 0;
    int32_t number = 0;
    if (length == i || length - i > 9) return 0;
    for (; i < length; i++) {
        if (t->word[i] < '0' || t->word[i] > '9') return 0;
        number = 10*number + (t->word[i] - '0');
    }
    *value = t->word[0] == '-' ? -number : number;
    return 1;
}

/* Reads the current word as the number of a vertex, from 1 to count; *corner counts from 0. In OBJ
   (back > 0), text from a slash on is ignored, and -1 is the last of the `back` vertices read so
   far. */
static dem_result demi_text_corner(const demi_text *t, int count, int back, int32_t *corner) {
    char where[160];
    const char *slash = t->length && back > 0 ? (const char *)memchr(t->word, '/', t->length) : 0;
    if (demi_text_integer(t, slash ? (size_t)(slash - t->word) : t->length, corner)) {
        if (*corner < 0 && back > 0) *corner += back + 1;
        if (*corner >= 1 && *corner <= count) {
            --*corner;
            return DEM_OK;
        }
    }
    demi_words(where, sizeof where, "a corner is expected, a whole number from 1 to %d, the number "
               "of vertices; correct it or export the file again", count);
    return demi_text_fail(t, where);
}

/* ---- meshes and profiles: width is 3 for triangles in space, 2 for segments in a plane ---- */

static void demi_mesh_free(dem_world *w, dem_mesh *mesh) {
    demi_free(w, mesh->vertices);
    demi_free(w, mesh->triangles);
    memset(mesh, 0, sizeof *mesh);
}

/* Allocates the arrays of a mesh. The counts must be checked against the size of the text. The
   caller frees in any case. */
static dem_result demi_mesh_allocate(const demi_text *t, dem_mesh *mesh, size_t width,
                                     size_t vertices, size_t elements) {
    if (vertices == 0 || elements == 0 || elements > DEMI_ELEMENTS_MAX ||
        vertices > 3*(size_t)DEMI_ELEMENTS_MAX)
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: found %.0f vertices and %.0f "
                         "triangles where 1 to %d are allowed; check the export", t->call, t->name,
                         (double)vertices, (double)elements, DEMI_ELEMENTS_MAX);
    mesh->vertex_count = (int)vertices;
    mesh->triangle_count = (int)elements;
    mesh->vertices = (dem_real *)demi_alloc(t->world, vertices*width, sizeof(dem_real));
    mesh->triangles = (int32_t *)demi_alloc(t->world, elements*width, sizeof(int32_t));
    return mesh->vertices && mesh->triangles ? DEM_OK : demi_text_memory(t);
}

/* Reads the text format of [MIL] Fig 5.11: two counts, then one line for each vertex, then one line
   of corners for each element. */
static dem_result demi_lists_read(demi_text *t, size_t width, dem_mesh *mesh) {
    int32_t count[2] = {0, 0};
    size_t i;
    int k;
    dem_result result;
    for (k = 0; k < 2; k++) {
        if (!(k ? demi_text_word(t) : demi_text_line(t)) ||
            !demi_text_integer(t, t->length, &count[k]) || count[k] < 1 ||
            count[k] > DEMI_ELEMENTS_MAX)
            return demi_text_fail(t, "the numbers of vertices and elements are expected, from 1 to "
                                  "700000000 (or an STL or OBJ file); correct the first line");
    }
    /* a line has at least two bytes, the last one byte: so memory is proportional to the file */
    if (2*((uint64_t)count[0] + (uint64_t)count[1]) > (uint64_t)(t->end - t->next) + 1)
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: found counts %ld and %ld, "
                         "but only %.0f bytes follow; copy the file again or correct the counts",
                         t->call, t->name, t->line, (long)count[0], (long)count[1],
                         (double)(t->end - t->next));
    result = demi_mesh_allocate(t, mesh, width, (size_t)count[0], (size_t)count[1]);
    for (k = 0; k < 2; k++)
        for (i = 0; i < (size_t)count[k]*width && result == DEM_OK; i++) {
            if (i%width > 0) demi_text_word(t);
            else if (demi_text_word(t))
                return demi_text_fail(t, "the line should end; give each vertex and each element a "
                                      "line of its own");
            else demi_text_line(t);
            result = k ? demi_text_corner(t, count[0], 0, mesh->triangles + i)
                       : demi_text_real(t, mesh->vertices + i);
        }
    if (result == DEM_OK && (demi_text_word(t) || demi_text_line(t)))
        return demi_text_fail(t, "the file should end; correct the counts in its first line");
    return result;
}

/* True if the text from `from` to `end`, without blanks at its ends, is the name of the part to be
   read. Adds the name to t->parts. */
static int demi_text_named(demi_text *t, const char *from, const char *end) {
    size_t size, have = strlen(t->parts);
    while (from < end && (*from == ' ' || *from == '\t')) from++;
    while (end > from && strchr(" \t\r\n", end[-1])) end--;
    size = (size_t)(end - from);
    if (size && have + size + 3 <= DEMI_PARTS_MOST)
        sprintf(t->parts + have, "%s%.*s", have ? ", " : "", (int)size, from);
    return size == strlen(t->part) && !memcmp(from, t->part, size);
}
/* True if a line of an OBJ file that begins with o or g names the part to be read. A name may
   contain blanks and #, or end where a comment begins, so both are tried. After g, each word is a
   group, too. */
static int demi_obj_part(demi_text *t, int group) {
    const char *from = t->at;
    int is = 0, words = 0;
    while (demi_text_word(t)) {
        words++;
        if (group) is |= demi_text_named(t, t->word, t->word + t->length);
    }
    if (!group || words > 1) is |= demi_text_named(t, from, t->line_end);
    return t->line_end < t->next && *t->line_end == '#' ? is | demi_text_named(t, from, t->next)
                                                         : is;
}
/* Moves to the next word of an OBJ face. A \ at the end of a line continues it on the next. */
static int demi_obj_word(demi_text *t) {
    int more = demi_text_word(t);
    while (more && demi_text_is(t, "\\")) more = demi_text_line(t);
    return more;
}
/* Reads a face of an OBJ file and writes its triangles to `out`. `vertices`: read so far. */
static dem_result demi_obj_face(demi_text *t, const dem_mesh *mesh, int vertices, demi_outline *o,
                                int32_t *out) {
    dem_mesh_health *h = t->health;
    for (o->count = 0; demi_obj_word(t); o->count++) {
        dem_result result;
        if (!demi_outline_grow(t->world, o)) return demi_text_memory(t);
        result = demi_text_corner(t, mesh->vertex_count, vertices, o->corner + o->count);
        if (result != DEM_OK) return result;
    }
    if (o->count < 3)
        return demi_text_fail(t, "a face needs three corners or more; complete it or remove it");
    if (!demi_outline_cut(o, mesh->vertices, out))
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: a face that is not convex "
                         "has %d corners, must be at most %d; export the mesh as triangles",
                         t->call, t->name, t->line, o->count, (int)DEMI_OUTLINE_MOST);
    h->split_faces += o->count > 3;
    h->bent_faces += o->bent;
    h->crossed_faces += o->crossed;
    return DEM_OK;
}
/* Reads OBJ: v and f lines, o and g lines if one part is to be read; other lines are ignored. Faces
   belong to the object named last and to each group of the last g line. With fill = 0 it counts and
   allocates. With fill = 1 it goes through the text twice, vertices first, because a face may
   precede its vertices. */
static dem_result demi_obj_pass(demi_text text, dem_mesh *mesh, int fill) {
    size_t vertices = 0, triangles = 0, axis;
    demi_outline outline;
    dem_result result = DEM_OK;
    int faces;
    memset(&outline, 0, sizeof outline);
    for (faces = !fill; faces < 2 && result == DEM_OK; faces++) {
        demi_text t = text;
        int object = 0, group = 0;
        for (vertices = 0; result == DEM_OK && demi_text_line(&t);) {
            if (t.part && demi_text_is(&t, "o")) object = demi_obj_part(&t, 0);
            else if (t.part && demi_text_is(&t, "g")) group = demi_obj_part(&t, 1);
            else if (demi_text_is(&t, "v")) {
                for (axis = 0; !faces && axis < 3 && result == DEM_OK; axis++) {
                    demi_text_word(&t);
                    result = demi_text_real(&t, &mesh->vertices[3*vertices + axis]);
                }
                vertices++;
            } else if (demi_text_is(&t, "f")) { /* a face may span lines: skip all its words */
                const int wanted = faces && (!t.part || object || group);
                int corners = 0;
                if (fill && wanted) {
                    result = demi_obj_face(&t, mesh, (int)vertices, &outline,
                                           mesh->triangles + 3*triangles);
                    corners = outline.count;
                } else while (demi_obj_word(&t)) corners++;
                if (wanted && corners > 2) triangles += (size_t)corners - 2;
            }
        }
    }
    demi_outline_free(text.world, &outline);
    return fill ? result : demi_mesh_allocate(&text, mesh, 3, vertices, triangles);
}

/* Reads STL as text: facet, three vertex lines, endfacet. With fill = 0 it counts and allocates. */
static dem_result demi_stl_pass(demi_text t, dem_mesh *mesh, int fill) {
    size_t facets = 0, axis;
    int corners = 3, ended = 0; /* corners of this facet so far; 1 after `endsolid` */
    t.apart = t.part != 0;
    while (demi_text_line(&t)) {
        int vertex = demi_text_is(&t, "vertex"), facet = demi_text_is(&t, "facet");
        int endfacet = demi_text_is(&t, "endfacet"), endsolid = demi_text_is(&t, "endsolid");
        if (t.part && demi_text_is(&t, "solid")) t.apart = !demi_text_named(&t, t.at, t.next);
        if (t.apart && !endsolid) continue;
        if (facet) facets++;
        if (!fill) continue;
        if (vertex ? corners == 3 : (facet || endfacet || endsolid) && corners < 3)
            return demi_text_fail(&t, "a facet should have three vertices; export the mesh as "
                                  "triangles");
        if (!vertex && !facet && !endfacet && !endsolid && !demi_text_is(&t, "outer") &&
            !demi_text_is(&t, "endloop") && !demi_text_is(&t, "solid"))
            return demi_text_fail(&t, "solid, facet, outer, vertex, endloop, endfacet or endsolid "
                                  "is expected; export the file again");
        if (facet) corners = 0;
        ended = endsolid;
        for (axis = 0; vertex && axis < 3; axis++) {
            size_t corner = 3*(facets - 1) + (size_t)corners;
            demi_text_word(&t);
            if (demi_text_real(&t, &mesh->vertices[3*corner + axis]) != DEM_OK)
                return DEM_ERROR_FORMAT;
        }
        corners += vertex;
    }
    if (!fill) return demi_mesh_allocate(&t, mesh, 3, 3*facets, facets);
    if (ended) return DEM_OK;
    return demi_text_fail(&t, "endsolid is expected; the file is cut short, so copy or export it "
                          "again");
}

/* Reads a little-endian uint32. */
static uint32_t demi_little32(const char *data) {
    const unsigned char *b = (const unsigned char *)data;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* Binary STL has 80 bytes of any content, the number of triangles (uint32), and 50 bytes for each
   triangle: a normal, three corners (12 floats) and two more bytes. All numbers are little-endian.
   A file is recognised by its size. */
static int demi_stl_binary_is(demi_text t) {
    const size_t size = (size_t)(t.end - t.data);
    return size >= 84 && size == 84 + 50*(uint64_t)demi_little32(t.data + 80);
}
static dem_result demi_stl_binary_pass(demi_text t, dem_mesh *mesh, int fill) {
    const char *data = t.data;
    const size_t count = demi_little32(data + 80);
    size_t i, k;
    if (!fill) return demi_mesh_allocate(&t, mesh, 3, 3*count, count);
    for (i = 0; i < count; i++)
        for (k = 0; k < 9; k++) {
            size_t byte = 84 + 50*i + 12 + 4*k;
            uint32_t bits = demi_little32(data + byte);
            float value;
            memcpy(&value, &bits, sizeof value);
            if ((bits >> 23 & 255) == 255 || fabs((double)value) > DEMI_FARTHEST) /* nan, inf */
                return demi_fail(t.world, DEM_ERROR_FORMAT, "%s: %s byte %.0f: found a coordinate "
                                 "of triangle %.0f that is not a number within +-1e15 (m); export "
                                 "the mesh again", t.call, t.name, (double)byte, (double)i + 1);
            mesh->vertices[9*i + k] = value == 0 ? 0 : (dem_real)value;
        }
    return DEM_OK;
}

/* Merges vertices that are exactly equal. Needed for STL, which gives the position of each corner
   instead of the number of a vertex. */
static dem_result demi_mesh_merge(const demi_text *t, dem_mesh *mesh) {
    size_t i, count = (size_t)mesh->vertex_count, unique = 0;
    int32_t *first = demi_first_equal(t->world, mesh->vertices, count, 3*sizeof(dem_real));
    dem_real *vertices = 0;
    for (i = 0; first && i < count; i++) unique += first[i] == (int32_t)i;
    if (first) vertices = (dem_real *)demi_alloc(t->world, 3*unique, sizeof(dem_real));
    for (i = 0, unique = 0; vertices && i < count; i++) { /* count = 3 triangles */
        mesh->triangles[i] = first[i] < (int32_t)i ? mesh->triangles[first[i]] : (int32_t)unique;
        if (first[i] == (int32_t)i)
            memcpy(vertices + 3*unique++, mesh->vertices + 3*i, 3*sizeof(dem_real));
    }
    demi_free(t->world, first);
    if (!vertices) return demi_text_memory(t);
    demi_free(t->world, mesh->vertices);
    mesh->vertices = vertices;
    mesh->vertex_count = (int)unique;
    t->health->merged_vertices = (int)(count - unique);
    return DEM_OK;
}

/* Prints a number with a decimal point in every locale. Returns `buffer`, of at least 32 bytes. */
static const char *demi_format_real(char *buffer, double value, int digits) {
    snprintf(buffer, 32, "%.*g", digits, value);
    return demi_pointed(buffer);
}

/* Fills in the part of a mesh's health that each triangle gives separately: bounding box, number of
   slivers and a hint on units. */
static void demi_health_shapes(const dem_mesh *mesh, dem_mesh_health *health) {
    double lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0}, extent = 0;
    char number[32];
    int i, k, axis;
    for (i = 0; i < mesh->triangle_count; i++) {
        double p[3][3], side[3][3], longest = 0, area = 0;
        for (k = 0; k < 3; k++) {
            const ptrdiff_t corner = mesh->triangles[3*(ptrdiff_t)i + k];
            const dem_real *vertex = mesh->vertices + 3*corner;
            for (axis = 0; axis < 3; axis++) {
                double x = p[k][axis] = (double)vertex[axis];
                if (x < lo[axis] || i + k == 0) lo[axis] = x;
                if (x > hi[axis] || i + k == 0) hi[axis] = x;
            }
        }
        for (k = 0; k < 3; k++) {
            double *s = side[k];
            for (axis = 0; axis < 3; axis++) s[axis] = p[(k + 1)%3][axis] - p[k][axis];
            longest = fmax(longest, sqrt(s[0]*s[0] + s[1]*s[1] + s[2]*s[2]));
        }
        for (axis = 0; axis < 3; axis++) {
            int b = (axis + 1)%3, c = (axis + 2)%3;
            double x = side[0][b]*side[1][c] - side[0][c]*side[1][b];
            area += x*x;
        }
        area = sqrt(area); /* of the parallelogram: the height times the longest side */
        health->slivers += !(area > 0 && area >= 1e-3*longest*longest);
    }
    health->box = dem_box_make((dem_real)lo[0], (dem_real)lo[1], (dem_real)lo[2], (dem_real)hi[0],
                               (dem_real)hi[1], (dem_real)hi[2]);
    for (axis = 0; axis < 3; axis++) extent = fmax(extent, hi[axis] - lo[axis]);
    if (extent > 50 || extent < 1e-3)
        demi_words(health->hint, sizeof health->hint, "largest extent is %s m: the file may %s; "
                   "multiply its vertices by %s", demi_format_real(number, extent, 4), extent > 50 ?
                   "be in millimetres" : "have been scaled to metres twice", extent > 50 ?
                   "0.001" : "1000");
}

/* Fills in the part that depends on other triangles: edges, duplicates and winding (>>closed). */
static dem_result demi_health_edges(const demi_text *t, const dem_mesh *mesh,
                                    dem_mesh_health *health) {
    demi_closed c;
    const int found = demi_closed_find(t->world, mesh, &c);
    health->open_edges = c.open;
    health->crowded_edges = c.crowded;
    health->duplicates = c.duplicates;
    health->shells = c.shells;
    health->flipped = c.flipped;
    health->twisted_edges = c.twisted;
    demi_closed_free(t->world, &c);
    return found ? DEM_OK : demi_text_memory(t);
}

/* >>add-format: formats of meshes, one row for each, in the order in which they are tried. Binary
   STL comes first, because it may begin with `solid`, too. Contents that no row recognises must be
   in the format of [MIL] (demi_lists_read), which is also that of profiles. */
typedef struct demi_mesh_format {
    int (*is)(demi_text t);             /* true if the contents look like this format */
    /* reads the text: with fill = 0 it counts and allocates, with fill = 1 it fills the arrays */
    dem_result (*pass)(demi_text t, dem_mesh *mesh, int fill);
    /* by_place is 1 if corners are positions, of which equal ones must be merged; binary is 1 if
       the file may contain bytes that are not text */
    int by_place, binary;
} demi_mesh_format;
static int demi_stl_is(demi_text t) {
    demi_text_line(&t);
    return demi_text_is(&t, "solid") || demi_text_is(&t, "facet");
}
static int demi_obj_is(demi_text t) {
    static const char *const words[] = {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"};
    size_t i;
    int is = 0;
    demi_text_line(&t);
    for (i = 0; i < sizeof words/sizeof *words; i++) is |= demi_text_is(&t, words[i]);
    return is;
}
static const demi_mesh_format demi_mesh_formats[] = {
    {demi_stl_binary_is, demi_stl_binary_pass, 1, 1},
    {demi_stl_is, demi_stl_pass, 1, 0},
    {demi_obj_is, demi_obj_pass, 0, 0},
};
/* Returns the format of the contents, or null for that of [MIL]. */
static const demi_mesh_format *demi_mesh_format_of(demi_text t) {
    size_t i;
    for (i = 0; i < sizeof demi_mesh_formats/sizeof *demi_mesh_formats; i++)
        if (demi_mesh_formats[i].is(t)) return &demi_mesh_formats[i];
    return 0;
}

/* Removes vertices that no triangle uses: those of other parts. */
static dem_result demi_mesh_compact(const demi_text *t, dem_mesh *mesh) {
    int32_t *to = (int32_t *)demi_alloc(t->world, (size_t)mesh->vertex_count, sizeof *to);
    int i, n = 0;
    if (!to) return demi_text_memory(t);
    for (i = 0; i < 3*mesh->triangle_count; i++) to[mesh->triangles[i]] = 1;
    for (i = 0; i < mesh->vertex_count; i++) {
        if (!to[i]) continue;
        memmove(mesh->vertices + 3*n, mesh->vertices + 3*i, 3*sizeof *mesh->vertices);
        to[i] = n++;
    }
    for (i = 0; i < 3*mesh->triangle_count; i++) mesh->triangles[i] = to[mesh->triangles[i]];
    mesh->vertex_count = n;
    demi_free(t->world, to);
    return DEM_OK;
}
/* Reads a mesh (width 3) or the segments of a profile (width 2) from memory. The contents identify
   the format. part: name of the part to be read, or null. health: or null. An error leaves an empty
   mesh. */
static dem_result demi_parse(dem_world *w, const char *call, const char *name, const char *data,
                             size_t size, size_t width, const char *part, dem_mesh *mesh,
                             dem_mesh_health *health) {
    char parts[DEMI_PARTS_MOST] = "";
    dem_mesh_health found;
    demi_text t = demi_text_make(w, call, name, data, size);
    const demi_mesh_format *format = width == 3 ? demi_mesh_format_of(t) : 0;
    dem_result result;
    memset(&found, 0, sizeof found);
    t.part = part;
    t.parts = parts;
    t.health = &found;
    if (!(format && format->binary) && memchr(data, 0, size)) {
        result = demi_fail(w, DEM_ERROR_FORMAT, "%s: %s: found %.0f bytes that are not text%s; "
                           "the file is cut short or has another format, so copy or export it "
                           "again",
                           call, t.name, (double)size, width == 2 ? "" : ", where a binary STL "
                           "has 84 bytes and 50 for each triangle in its count");
    } else if (format) {
        result = format->pass(t, mesh, 0);
        if (part && (!mesh->triangle_count || !parts[0]))
            result = demi_fail(w, DEM_ERROR_FORMAT, "%s: %s has no triangles of a part \"%.60s\", "
                               "must be one of: %s; use one of these names, or read the whole mesh",
                               call, t.name, part, parts[0] ? parts : "(the file has no names)");
        if (result == DEM_OK) result = format->pass(t, mesh, 1);
        if (result == DEM_OK && format->by_place) result = demi_mesh_merge(&t, mesh);
        if (result == DEM_OK && part) result = demi_mesh_compact(&t, mesh);
    } else if (part) {
        result = demi_fail(w, DEM_ERROR_FORMAT, "%s: %s has a format without named parts; use a "
                           "text STL or an OBJ file, or read the whole mesh", call, t.name);
    } else {
        result = demi_lists_read(&t, width, mesh);
    }
    if (result == DEM_OK && health) {
        *health = found;
        demi_health_shapes(mesh, health);
        result = demi_health_edges(&t, mesh, health);
    }
    if (result != DEM_OK) {
        demi_mesh_free(w, mesh);
        if (health) memset(health, 0, sizeof *health);
    }
    return result;
}

/* Opens a file for reading; null if it cannot. Mode "rb" would wait for the other end of a pipe,
   "r+b" does not. Only "rb" opens a file without write permission. */
static FILE *demi_open(const char *path) {
    FILE *file = fopen(path, "r+b");
    return file ? file : fopen(path, "rb");
}
/* Returns the size of an open file in bytes and goes to its beginning. DEMI_ENDLESS: it is a pipe
   or a terminal, which have no size. DEMI_ENDLESS - 1: the size does not fit a long. The size of a
   device is 0. */
#define DEMI_ENDLESS ((size_t)-1)
static size_t demi_file_size(FILE *file) {
    const int known = fseek(file, 0, SEEK_END) == 0;
    const long size = known ? ftell(file) : -1;
    if (!known || fseek(file, 0, SEEK_SET) != 0) return DEMI_ENDLESS;
    return size < 0 ? DEMI_ENDLESS - 1 : (size_t)size;
}
/* Loads a complete file to *bytes, which the caller frees, also after a failure. Stops with an
   error if it reads more than the size when the file was opened, since a device may have no end. */
static dem_result demi_load(dem_world *w, const char *call, const char *path, char **bytes,
                            size_t *size) {
    FILE *file;
    size_t length;
    dem_result result = DEM_OK;
    *size = 0;
    if (!path)
        return demi_refuse(w, call, "path is null; give a file name");
    file = demi_open(path);
    length = file ? demi_file_size(file) : 0;
    if (length == DEMI_ENDLESS)
        result = demi_fail(w, DEM_ERROR_FILE, "%s: %.200s is a pipe or a terminal, must be a "
                           "file; save its output to a file and read that", call, path);
    if (file) errno = 0;
    while (file && !feof(file) && !ferror(file) && result == DEM_OK && *size <= length) {
        if (demi_grow(w, DEMI_LOOSE, bytes, 1, *size + 65536)) {
            const size_t room = demi_room(*bytes, 1) - *size;
            *size += fread(*bytes + *size, 1, DEMI_MIN(room, length + 1 - *size), file);
        } else result = demi_fail(w, DEM_ERROR_MEMORY, "%s: %.200s: not enough memory to load "
                                  "more than %.0f bytes; free some", call, path, (double)*size);
    }
    if (result == DEM_OK && file && *size > length)
        result = demi_fail(w, DEM_ERROR_FILE, "%s: %.200s is a device, or grows while it is read, "
                           "must be a file that does not change; copy it and read the copy", call,
                           path);
    if (result == DEM_OK && (!file || ferror(file)))
        result = demi_fail(w, DEM_ERROR_FILE, "%s: cannot read %.200s: %s; check its name and "
                           "permissions", call, path, errno ? strerror(errno) : "unknown cause");
    if (file) fclose(file);
    return result;
}

/* Does what demi_parse does, for a file. */
static dem_result demi_read(dem_world *w, const char *call, const char *path, size_t width,
                            const char *part, dem_mesh *mesh, dem_mesh_health *health) {
    char *bytes = 0;
    size_t size;
    dem_result result = demi_load(w, call, path, &bytes, &size);
    if (result == DEM_OK) result = demi_parse(w, call, path, bytes, size, width, part,
                                              mesh, health);
    demi_free(w, bytes);
    return result;
}

/* Empties a mesh and its health. Returns 1, and fails, if there is no world or no mesh. */
static int demi_mesh_begin(dem_world *w, const char *call, dem_mesh *mesh,
                           dem_mesh_health *health) {
    if (demi_null_write(w, call, w, "world")) return 1;
    if (mesh) memset(mesh, 0, sizeof *mesh);
    if (health) memset(health, 0, sizeof *health);
    return demi_null_write(w, call, mesh, "mesh");
}
DEM_API dem_result dem_mesh_parse(dem_world *world, const char *name, const void *data, size_t size,
                          dem_mesh *mesh, dem_mesh_health *health) {
    if (demi_mesh_begin(world, __func__, mesh, health) ||
        demi_null_write(world, __func__, data, "data")) return DEM_ERROR_ARGUMENT;
    return demi_parse(world, __func__, name, (const char *)data, size, 3, 0, mesh, health);
}

DEM_API dem_result dem_mesh_read(dem_world *world, const char *path, dem_mesh *mesh,
                                 dem_mesh_health *health) {
    if (demi_mesh_begin(world, __func__, mesh, health)) return DEM_ERROR_ARGUMENT;
    return demi_read(world, __func__, path, 3, 0, mesh, health);
}

DEM_API dem_result dem_mesh_part_read(dem_world *world, const char *path, const char *part,
                                      dem_mesh *mesh, dem_mesh_health *health) {
    if (demi_mesh_begin(world, __func__, mesh, health) ||
        demi_null_write(world, __func__, part, "part")) return DEM_ERROR_ARGUMENT;
    return demi_read(world, __func__, path, 3, part, mesh, health);
}
DEM_API void dem_mesh_free(dem_world *world, dem_mesh *mesh) {
    if (world && mesh) demi_mesh_free(world, mesh);
}

DEM_API dem_result dem_mesh_place(dem_world *w, dem_mesh *mesh, dem_real scale, dem_quat rotation,
                                  dem_vec3 to) {
    if (demi_null_write(w, __func__, mesh, "mesh")) return DEM_ERROR_ARGUMENT;
    const dem_quat q = demi_quat_most(rotation) > 0 ? demi_quat_unit(rotation)
        : dem_quat_make(1, 0, 0, 0);
    int i;
    if (!(scale > 0) || !demi_finite(scale) || !demi_quat_finite(rotation) || !demi_place(to))
        return demi_refuse(w, __func__, "scale is %g, must be finite and > 0; rotation and "
                           "translation must be finite, and the translation within 1e15 m",
                           (double)scale);
    for (i = 0; i < mesh->vertex_count; i++)
        demi_put(mesh->vertices + 3*i, demi_add(to,
                 dem_quat_rotate(q, demi_scale(demi_at(mesh->vertices + 3*i), scale))));
    return DEM_OK;
}
/* Makes one part of a mesh file into a wall that will have this id. The wall is not yet added to
   the world. */
static dem_result demi_part_make(dem_world *w, const char *path, dem_real scale,
                                 const dem_wall_part *part, dem_wall id, demi_wall *wall) {
    dem_mesh mesh;
    dem_result result = dem_mesh_part_read(w, path, part->name, &mesh, 0);
    if (result != DEM_OK) return result;
    result = dem_mesh_place(w, &mesh, scale, dem_quat_make(0, 0, 0, 0), demi_v(0, 0, 0));
    if (result == DEM_OK && !demi_mesh_make(w, part->material, &mesh, wall))
        result = DEM_ERROR_ARGUMENT;
    dem_mesh_free(w, &mesh);
    if (result != DEM_OK) return result;
    wall->pose = wall->ahead = wall->was = wall->first = wall->home;
    return demi_motion_lay(w, id, &part->motion, wall, wall);
}
/* All checks come before the first wall is added, so that an error leaves the world as it was. If
   memory runs out later, the walls added so far are removed. */
DEM_API dem_result dem_wall_parts_add(dem_world *w, const char *path, dem_real scale, int count,
                                 const dem_wall_part *parts, dem_wall *walls) {
    char sentence[sizeof w->error];
    const int some = scale > 0 || scale < 0 || !demi_finite(scale);    /* 0: none is given */
    dem_result result = DEM_OK;
    demi_wall *made;
    dem_wall wall = demi_no_wall;
    int i;
    for (i = 0; i < count && walls; i++) walls[i] = demi_no_wall;
    if (demi_null(w, __func__, parts, "parts")) return DEM_ERROR_ARGUMENT;
    if (count < 1)
        return demi_refuse(w, __func__, "count is %d, must be > 0", count);
    made = (demi_wall *)demi_alloc(w, (size_t)count, sizeof *made);
    if (!made) return demi_no_memory(w, __func__);
    for (i = 0; i < count && result == DEM_OK; i++) {
        wall.id = w->wall_count + i + 1;
        result = demi_part_make(w, path, some ? scale : 1, parts + i, wall, made + i);
    }
    if (result == DEM_OK && !DEMI_GROW(w, w->walls, (size_t)w->wall_count + (size_t)count))
        result = demi_no_memory(w, __func__);
    for (i = 0; i < count && result == DEM_OK; i++) {
        wall = demi_wall_enter(w, "dem_wall_mesh_add", made + i);
        memset(made + i, 0, sizeof *made);
        made[i].id = wall.id;
        result = wall.id ? DEM_OK : DEM_ERROR_ARGUMENT;
        if (walls) walls[i] = wall;
    }
    memcpy(sentence, w->error, sizeof sentence);
    for (i = count - 1; i >= 0; i--) {          /* after an error: removes those added so far */
        wall.id = made[i].id;
        if (wall.id && result != DEM_OK) demi_wall_leave(w, wall);
        if (walls && result != DEM_OK) walls[i] = demi_no_wall;
        demi_wall_free(w, made + i);
    }
    demi_free(w, made);
    if (result == DEM_OK) { demi_built(w, __func__); return DEM_OK; }
    return demi_fail(w, result, "%s: %.440s", __func__, sentence);
}

/* Turns a mesh of width 2 into a profile. Fails if a segment has the same corner twice; then it
   frees the profile. */
static dem_result demi_profile_take(dem_world *w, const char *call, const char *name,
                                    const dem_mesh *lists, dem_profile *profile) {
    int i;
    profile->vertex_count = lists->vertex_count;
    profile->segment_count = lists->triangle_count;
    profile->vertices = lists->vertices;
    profile->segments = lists->triangles;
    for (i = 0; i < profile->segment_count; i++) {
        const int32_t *segment = profile->segments + 2*(size_t)i;
        if (segment[0] != segment[1]) continue;
        dem_profile_free(w, profile);
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: found segment %d with the same corner "
                         "twice where two corners are expected; correct it or remove it", call,
                         name ? name : "data", i + 1);
    }
    return DEM_OK;
}

DEM_API dem_result dem_profile_parse(dem_world *world, const char *name, const void *data,
                                     size_t size, dem_profile *profile) {
    dem_mesh lists = {0, 0, 0, 0};
    dem_result result;
    if (demi_null_write(world, __func__, profile, "profile")) return DEM_ERROR_ARGUMENT;
    memset(profile, 0, sizeof *profile);
    if (demi_null_write(world, __func__, data, "data")) return DEM_ERROR_ARGUMENT;
    result = demi_parse(world, __func__, name, (const char *)data, size, 2, 0, &lists, 0);
    if (result != DEM_OK) return result;
    return demi_profile_take(world, __func__, name, &lists, profile);
}

DEM_API dem_result dem_profile_read(dem_world *world, const char *path, dem_profile *profile) {
    dem_mesh lists = {0, 0, 0, 0};
    dem_result result;
    if (demi_null_write(world, __func__, profile, "profile")) return DEM_ERROR_ARGUMENT;
    memset(profile, 0, sizeof *profile);
    result = demi_read(world, __func__, path, 2, 0, &lists, 0);
    if (result != DEM_OK) return result;
    return demi_profile_take(world, __func__, path, &lists, profile);
}

DEM_API void dem_profile_free(dem_world *world, dem_profile *profile) {
    if (!world || !profile) return;
    demi_free(world, profile->vertices);
    demi_free(world, profile->segments);
    memset(profile, 0, sizeof *profile);
}
