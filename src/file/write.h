/* ---------------------------------------------------------------------------------------------
   >>write
   Output files: VTP, legacy VTK, extended XYZ and CSV. This part owns demi_out, the file being
   written, and demi_columns, the arrays that are written to it. It reads the world and does not
   change its state, except that a function which writes contacts may compute forces first.

   Files are replaced as a whole. demi_out_open creates a file of an unused name,
   path.XXXXXXXX.tmp. demi_out_close renames it to `path` if everything was written, and removes it
   otherwise, so that a file at `path` is always complete. If `path` is a symbolic link, the link
   stays and the file that it points to is replaced. Pipes and terminals are errors. A device such
   as /dev/null is written to directly. The FILE records write errors, and demi_out_close checks
   them once. Numbers have a decimal point in every locale.
   --------------------------------------------------------------------------------------------- */

/* A file being written. */
typedef struct demi_out {
    dem_world *world;
    const char *call, *path;    /* for error messages: the public function; the path it was given */
    char *place;                /* the file that is replaced: path, or the target of that link    */
    char *temporary;            /* place.XXXXXXXX.tmp; null: place itself is written to           */
    size_t room;                /* bytes of each of the two                                       */
    FILE *file;
} demi_out;

/* Writes the target of a symbolic link to `to`, without a zero at its end, and returns its length;
   -1 if `path` is not a link. ISO C has no function for this. On Unix, this is readlink of the C
   library, declared under another name instead of including its header, which would add its names
   to every program. Elsewhere a link is replaced by a file. */
#if (defined(__unix__) || defined(__linux__)) && (defined(__GNUC__) || defined(__TINYC__)) && \
    !defined(__CYGWIN__)
long demi_readlink(const char *path, char *to, size_t size) __asm__("readlink");
#elif defined(__APPLE__) && defined(__GNUC__)
long demi_readlink(const char *path, char *to, size_t size) __asm__("_readlink");
#else
static long demi_readlink(const char *path, char *to, size_t size) {
    (void)path; (void)to; (void)size;
    return -1;
}
#endif
enum { DEMI_LINK = 1024, DEMI_LINKS = 16 };   /* most bytes of a link's target; most links */
enum { DEMI_SUFFIX = 14 };                      /* bytes of .XXXXXXXX.tmp and the zero */
/* Replaces `place` by its target as long as it is a link. Returns 0 if a target is too long, or
   after DEMI_LINKS links, because they may form a circle. */
static int demi_link_follow(char *place, size_t room) {
    char to[DEMI_LINK];
    int i;
    for (i = 0; i < DEMI_LINKS; i++) {
        const long n = demi_readlink(place, to, sizeof to);
        const char *slash = strrchr(place, '/');
        const size_t folder = n < 1 || to[0] == '/' || !slash ? 0 : (size_t)(slash - place) + 1;
        if (n < 0) return 1;
        if ((size_t)n >= sizeof to || folder + (size_t)n + DEMI_SUFFIX > room) return 0;
        memcpy(place + folder, to, (size_t)n);
        place[folder + (size_t)n] = 0;
    }
    return 0;
}

static void demi_out_free(demi_out *o) {
    demi_free(o->world, o->place);
    demi_free(o->world, o->temporary);
}
/* Creates a file of an unused name that cannot be guessed. Mode "x" of C11 fails if the name
   exists, also as a link. Where the C library does not know this mode, we first test whether the
   name exists. Returns null if no file could be created. */
static FILE *demi_out_create(demi_out *o) {
    uint64_t random = (uint64_t)time(0) ^ (uint64_t)(uintptr_t)o << 20 ^ (uint64_t)clock() << 40 ^
        (uint64_t)(uintptr_t)o->temporary ^ (uint64_t)(1e9*fmod(demi_clock(), 1e6));
    FILE *file = 0;
    int tries;
    for (tries = 0; tries < 100 && !file; tries++) {
        sprintf(o->temporary, "%s.%08lx.tmp", o->place,
                (unsigned long)(demi_random(&random) >> 32));
        errno = 0;
        file = fopen(o->temporary, "wbx");
        if (file || errno == EEXIST) continue;
        if (errno != EINVAL) return 0;
        file = fopen(o->temporary, "rb");
        if (file) { fclose(file); file = 0; continue; }
        return fopen(o->temporary, "wb");
    }
    return file;
}
/* Closes a file and frees `o`. Renames the file to its place if everything was written; otherwise
   removes it and returns DEM_ERROR_FILE. Where rename cannot replace a file (Windows), the old file
   is removed first; a folder of that name never is. */
static dem_result demi_out_close(demi_out *o) {
    int whole = o->file && fflush(o->file) == 0 && !ferror(o->file), cause = errno;
    if (o->file && fclose(o->file) != 0 && whole) {
        whole = 0;
        cause = errno;
    }
    if (whole && o->temporary && rename(o->temporary, o->place) != 0) {
        cause = errno;
        whole = (cause == EEXIST || cause == EACCES) && remove(o->place) == 0 &&
                rename(o->temporary, o->place) == 0;
    }
    if (!whole) {
        if (o->file && o->temporary) remove(o->temporary);
        demi_fail(o->world, DEM_ERROR_FILE, "%s: cannot write %.200s: %s; check that its folder "
                  "exists, may be written to and has room", o->call, o->path,
                  cause ? strerror(cause) : "unknown cause");
    }
    demi_out_free(o);
    return whole ? DEM_OK : DEM_ERROR_FILE;
}

/* Abandons a file: removes it and frees `o`. An existing file at `path` stays. */
static void demi_out_drop(demi_out *o) {
    fclose(o->file);
    if (o->temporary) remove(o->temporary);
    demi_out_free(o);
}
/* True if an open file of this size (bytes) is a device, which a file must not replace. ISO C has
   no function for this. Everything in /dev except /dev/shm counts as a device. Elsewhere a device
   has size 0, but can be read from or does not allow a seek beyond its end. */
static int demi_is_device(const char *place, FILE *file, size_t size) {
    int reads;
    if (!strncmp(place, "/dev/", 5) && strncmp(place, "/dev/shm/", 9)) return 1;
    if (size) return 0;
    reads = fgetc(file) != EOF;
    clearerr(file);
    return reads || fseek(file, 1, SEEK_SET) != 0 || ftell(file) != 1 ||
        fseek(file, 0, SEEK_SET) != 0;
}
/* Opens a file under a temporary name. After a failure there is nothing to close. */
static dem_result demi_out_open(demi_out *o, dem_world *w, const char *call, const char *path) {
    size_t length;
    FILE *there;
    size_t size;
    if (!path) return demi_refuse(w, call, "path is null; give a file name");
    memset(o, 0, sizeof *o);
    o->world = w;
    o->call = call;
    o->path = path;
    length = strlen(path);
    o->room = length + DEMI_LINK + DEMI_SUFFIX;
    o->place = (char *)demi_alloc(w, o->room, 1);
    o->temporary = (char *)demi_alloc(w, o->room, 1);
    if (!o->place || !o->temporary) {
        demi_out_free(o);
        return demi_fail(w, DEM_ERROR_MEMORY, "%s: not enough memory for a file name; free some",
                         call);
    }
    memcpy(o->place, path, length + 1);
    there = fopen(path, "r+b");                 /* does not wait for the other end of a pipe */
    size = there ? demi_file_size(there) : 0;
    if (size == DEMI_ENDLESS) {
        fclose(there);
        demi_out_free(o);
        return demi_fail(w, DEM_ERROR_FILE, "%s: %.200s is a pipe or a terminal, must be a file, "
                         "because a file is written whole or not at all; write a file and send "
                         "that", call, path);
    }
    if (!demi_link_follow(o->place, o->room)) {
        if (there) fclose(there);
        demi_out_free(o);
        return demi_fail(w, DEM_ERROR_FILE, "%s: %.200s is a link that leads to itself or through "
                         "too many other links; give the file itself", call, path);
    }
    if (there && demi_is_device(o->place, there, size)) {
        demi_free(w, o->temporary);
        o->temporary = 0;
        o->file = there;
        return DEM_OK;
    }
    if (there) fclose(there);
    o->file = demi_out_create(o);
    return o->file ? DEM_OK : demi_out_close(o);
}

/* Writes one binary number of at most 8 bytes; turn: with its bytes in reverse order. */
static void demi_out_number(demi_out *o, const void *number, size_t size, int turn) {
    unsigned char bytes[8];
    size_t i;
    for (i = 0; i < size; i++) bytes[i] = ((const unsigned char *)number)[turn ? size - 1 - i : i];
    fwrite(bytes, 1, size, o->file);
}

/* An array of a file: `count` rows of `components` numbers. If data is null, the numbers are the
   integers first, first + step, and so on. */
typedef struct demi_column {
    const char *section;        /* the XML element of a VTP file that contains the array          */
    char name[24], type;        /* type: r dem_real, i int32, u uint32                            */
    int components, count;      /* numbers in a row; rows                                         */
    int first, step;
    void *data;                 /* or null                                                        */
} demi_column;
/* The arrays of a file, from demi_columns_begin until demi_columns_free. */
enum { DEMI_FILE_COLUMNS = 16 + DEMI_MEMORY + DEM_BODY_REALS };
typedef struct demi_columns {
    dem_world *world;
    const char *call;
    int count, failed;          /* arrays; 1: memory ran out, or an array has too many rows       */
    demi_column column[DEMI_FILE_COLUMNS];
} demi_columns;
static void demi_columns_begin(demi_columns *s, dem_world *w, const char *call) {
    memset(s, 0, sizeof *s);
    s->world = w;
    s->call = call;
}
static size_t demi_column_size(const demi_column *c) { /* bytes of one number */
    return c->type == 'r' ? sizeof(dem_real) : 4;
}
/* Adds an array of integers first, first + step, ..., which needs no memory. Returns it. */
static demi_column *demi_columns_range(demi_columns *s, const char *section, const char *name,
                                       int64_t count, int first, int step) {
    demi_column *c = &s->column[s->count++];
    s->failed |= count > 3*(int64_t)DEMI_ELEMENTS_MAX;
    c->section = section;
    snprintf(c->name, sizeof c->name, "%s", name);
    c->type = 'i';
    c->components = 1;
    c->count = s->failed ? 0 : (int)count;
    c->first = first;
    c->step = step;
    return c;
}
/* Adds an array, set to 0, and returns it; null after a failure. */
static void *demi_columns_add(demi_columns *s, const char *section, const char *name, char type,
                              int components, int64_t count) {
    demi_column *c = demi_columns_range(s, section, name, count, 0, 0);
    c->type = type;
    c->components = components;
    if (!s->failed)
        c->data = demi_alloc(s->world, (size_t)count*(size_t)components + 1, demi_column_size(c));
    s->failed |= !c->data;
    return c->data;
}
/* As demi_columns_add, for reals and for integers of one component. */
static dem_real *demi_columns_reals(demi_columns *s, const char *section, const char *name,
                                    int components, int64_t count) {
    return (dem_real *)demi_columns_add(s, section, name, 'r', components, count);
}
static int32_t *demi_columns_ints(demi_columns *s, const char *section, const char *name, char type,
                                  int64_t count) {
    return (int32_t *)demi_columns_add(s, section, name, type, 1, count);
}
/* Adds an array for each user-defined number of bodies. */
static void demi_columns_own(demi_columns *s, int64_t count, dem_real *own[DEM_BODY_REALS]) {
    char name[24];
    int k, length;
    for (k = 0; k < s->world->bodies.real_count; k++) {
        const char *word = demi_name(s->world->desc.body_reals, k, &length);
        sprintf(name, "%.*s", length, word);
        own[k] = demi_columns_reals(s, "PointData", name, 1, count);
    }
}
static void demi_columns_free(demi_columns *s) {
    while (s->count > 0) demi_free(s->world, s->column[--s->count].data);
}
/* Opens the file. If that fails or an array is missing, fails and frees the arrays: the caller has
   nothing to close or to free. */
static dem_result demi_columns_open(demi_columns *s, demi_out *o, const char *path) {
    const dem_result result = !s->failed ? demi_out_open(o, s->world, s->call, path)
        : demi_fail(s->world, DEM_ERROR_MEMORY, "%s: not enough memory for what is written; free "
                    "some", s->call);
    if (result != DEM_OK) demi_columns_free(s);
    return result;
}
static uint64_t demi_column_bytes(const demi_column *c) {
    return (uint64_t)c->count*(uint64_t)c->components*demi_column_size(c);
}
/* Writes the numbers of an array in binary form, row by row. */
static void demi_column_write(demi_out *o, const demi_column *c, int turn) {
    const size_t n = (size_t)c->count*(size_t)c->components, size = demi_column_size(c);
    size_t i;
    if (c->data && !turn) { fwrite(c->data, size, n, o->file); return; }
    for (i = 0; i < n; i++) {
        const int32_t number = c->first + (int32_t)i*c->step;
        demi_out_number(o, c->data ? (const char *)c->data + i*size : (const char *)&number, size,
                        turn);
    }
}

enum { DEMI_GRAIN_SPIN = 3, DEMI_GRAIN_ID, DEMI_GRAIN_MATERIAL };      /* columns for grains */
/* Makes and fills the arrays that are written for grains, with a row for each part of a body, such
   as a member sphere of a cluster. Positions are wrapped into a periodic domain. The order of the
   arrays is that of DEMI_GRAIN_SPIN and the following constants. The last two arrays make each
   point a cell, without which viewers do not draw it. */
static void demi_grain_columns(demi_columns *s, dem_world *w, const char *call) {
    const dem_real *places = demi_wrapped(w);
    const demi_bodies *b = &w->bodies;
    dem_real *pos, *radius, *vel, *spin, *orient = 0, *axes = 0, *own[DEM_BODY_REALS];
    int32_t *id, *material, *groups = 0;
    int64_t n = 0;
    int i, k, e;
    for (i = 0; i < b->count; i++) n += demi_parts_count(w, i);
    demi_columns_begin(s, w, call);
    pos = demi_columns_reals(s, "Points", "position", 3, n);
    radius = demi_columns_reals(s, "PointData", "radius", 1, n);
    vel = demi_columns_reals(s, "PointData", "velocity", 3, n);
    spin = demi_columns_reals(s, "PointData", "spin", 3, n);
    id = demi_columns_ints(s, "PointData", "id", 'u', n);
    material = demi_columns_ints(s, "PointData", "material", 'i', n);
    if (b->orienting) {
        orient = demi_columns_reals(s, "PointData", "orientation", 4, n);
        axes = demi_columns_reals(s, "PointData", "semi_axes", 3, n);
    }
    if (b->groups) groups = demi_columns_ints(s, "PointData", "groups", 'i', n);
    demi_columns_own(s, n, own);
    demi_columns_range(s, "Verts", "connectivity", n, 0, 1);
    demi_columns_range(s, "Verts", "offsets", n, 1, 1);
    for (i = 0, n = 0; i < b->count && !s->failed; i++)
        for (k = 0; k < demi_parts_count(w, i); k++, n++) {
            const demi_part p = demi_part_of(w, i, k);
            demi_put(pos + 3*n, demi_add(demi_at(places + 4*i), p.centre));
            radius[n] = p.radius;
            demi_put(vel + 3*n, demi_velocity_at(b->vel, b->spin, i, p.centre));
            demi_put(spin + 3*n, demi_at(b->spin + 4*i));
            id[n] = (int32_t)b->slot[i];
            material[n] = b->material[i];
            if (orient) demi_quat_put(orient + 4*n, demi_shape_of(w, i) ? p.q
                                                    : demi_quat_at(b->orient + 4*i));
            if (axes) {
                axes[3*n] = demi_shape_rows[p.kind].drawn(&p, demi_v(1, 0, 0)).x;
                axes[3*n + 1] = demi_shape_rows[p.kind].drawn(&p, demi_v(0, 1, 0)).y;
                axes[3*n + 2] = demi_shape_rows[p.kind].drawn(&p, demi_v(0, 0, 1)).z;
            }
            if (groups) groups[n] = (int32_t)b->groups[i];
            for (e = 0; e < b->real_count; e++) own[e][n] = b->reals[b->real_count*i + e];
        }
}

/* Writes arrays in the XML format of VTK and frees them. The XML tree describes the arrays. Their
   numbers follow in binary form, in the byte order of the machine, each array after its size in
   bytes. The first array contains the points; verts, lines and polys are the numbers of such
   cells. */
static dem_result demi_vtp(demi_columns *s, const char *path, int verts, int lines, int polys) {
    demi_out o;
    char time[32];
    const char *section = "";
    uint64_t offset = 0, bytes;
    int i;
    dem_result result = demi_columns_open(s, &o, path);
    if (result != DEM_OK) return result;
    fprintf(o.file, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"%s\" header_type=\"UInt64\">\n<PolyData>\n<FieldData><DataArray "
            "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%s"
            "</DataArray></FieldData>\n<Piece NumberOfPoints=\"%d\" NumberOfVerts=\"%d\" "
            "NumberOfLines=\"%d\" NumberOfStrips=\"0\" NumberOfPolys=\"%d\">\n",
            demi_is_little_endian() ? "LittleEndian" : "BigEndian",
            demi_format_real(time, dem_world_time_get(s->world), 17), s->column[0].count, verts,
            lines, polys);
    for (i = 0; i < s->count; i++) {
        const demi_column *c = s->column + i;
        if (i > 0 && strcmp(c->section, section) != 0) fprintf(o.file, "</%s>\n", section);
        if (strcmp(c->section, section) != 0) fprintf(o.file, "<%s>\n", c->section);
        section = c->section;
        fprintf(o.file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
                "format=\"appended\" offset=\"%.0f\"/>\n", c->type == 'u' ? "UInt32" :
                c->type == 'i' ? "Int32" : sizeof(dem_real) == 4 ? "Float32" : "Float64", c->name,
                c->components, (double)offset);
        offset += 8 + demi_column_bytes(c);
    }
    fprintf(o.file, "</%s>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_", section);
    for (i = 0; i < s->count; i++) {
        bytes = demi_column_bytes(s->column + i);
        demi_out_number(&o, &bytes, sizeof bytes, 0);
        demi_column_write(&o, s->column + i, 0);
    }
    fputs("\n</AppendedData>\n</VTKFile>\n", o.file);
    demi_columns_free(s);
    return demi_out_close(&o);
}

DEM_API dem_result dem_vtp_write(dem_world *world, const char *path) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    demi_columns s;
    demi_grain_columns(&s, world, __func__);
    return demi_vtp(&s, path, s.column[0].count, 0, 0);
}

/* Contacts as line segments. While `ends` is null, demi_line_put only counts them. */
typedef struct demi_lines {
    const dem_world *w;
    int64_t count;
    int stride;                                    /* reals of history */
    dem_real *ends, *force, *overlap, *memory[DEMI_MEMORY];    /* x 6, m; x 3, N; x 1, m */
    int32_t *wall;                                 /* id; 0: a contact of two bodies */
} demi_lines;
/* Adds a contact: a segment from the centre of a to that of b or to the contact point on a wall. */
static void demi_line_put(const dem_contact_info *c, dem_real *memory, void *user) {
    demi_lines *l = (demi_lines *)user;
    const demi_periods p = demi_periods_of(l->w);
    const int64_t n = l->count++;
    dem_body_state a, b;
    dem_vec3 to = c->point;
    dem_real *end;
    int k;
    if (!l->ends || dem_body_get(l->w, c->a, &a) != DEM_OK) return;
    end = l->ends + 6*n;
    if (!c->wall && dem_body_get(l->w, c->b, &b) == DEM_OK) to = b.position;
    demi_put(end, a.position);
    if (p.offset < 0 || p.offset > 0) to = demi_add(a.position, demi_nearest(&p,
                                                    demi_sub(to, a.position)));
    demi_put(end + 3, to);
    for (k = 0; k < 3; k++)                     /* the periodic image of b nearest to a */
        end[3 + k] = end[k] + demi_image(end[3 + k] - end[k], p.half[k], p.period[k]);
    demi_put(l->force + 3*n, c->force);
    l->overlap[n] = c->overlap;
    l->wall[n] = c->wall;
    for (k = 0; k < l->stride; k++) l->memory[k][n] = memory[k];
}
DEM_API dem_result dem_contacts_vtp_write(dem_world *world, const char *path) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    demi_columns s;
    demi_lines l;
    char memory[24];
    int k, n, length;
    memset(&l, 0, sizeof l);
    l.w = world;
    n = demi_contacts_visit(world, __func__, demi_line_put, &l);
    if (n < 0) return DEM_ERROR_ARGUMENT;
    l.count = 0;
    l.stride = demi_memory_told(world);
    demi_columns_begin(&s, world, __func__);
    l.ends = demi_columns_reals(&s, "Points", "position", 3, 2*(int64_t)n);
    l.force = demi_columns_reals(&s, "CellData", "force", 3, n);
    l.overlap = demi_columns_reals(&s, "CellData", "overlap", 1, n);
    l.wall = demi_columns_ints(&s, "CellData", "wall", 'i', n);
    for (k = 0; k < l.stride; k++) {
        const char *name = demi_name(world->desc.law_memory_names, k, &length);
        if (demi_response_is(world, DEMI_LAWS) && k == world->laws.at_sliding)
            sprintf(memory, "sliding");
        else if (name) sprintf(memory, "%.*s", length, name);
        else sprintf(memory, "memory%d", k);
        l.memory[k] = demi_columns_reals(&s, "CellData", memory, 1, n);
    }
    demi_columns_range(&s, "Lines", "connectivity", 2*(int64_t)n, 0, 1);
    demi_columns_range(&s, "Lines", "offsets", n, 2, 2);
    if (!s.failed) demi_contacts_visit(world, __func__, demi_line_put, &l);
    return demi_vtp(&s, path, 0, n, 0);
}

/* Legacy VTK in its binary form, in which numbers are big-endian. */
DEM_API dem_result dem_vtk_write(dem_world *world, const char *path) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    const char *real = sizeof(dem_real) == 4 ? "float" : "double";
    const double time = dem_world_time_get(world);
    const int turn = demi_is_little_endian();
    int32_t i, one = 1;
    demi_columns s;
    demi_out o;
    dem_result result;
    demi_grain_columns(&s, world, __func__);
    result = demi_columns_open(&s, &o, path);
    if (result != DEM_OK) return result;
    fputs("# vtk DataFile Version 3.0\ndem.h\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\n"
          "TIME 1 1 double\n", o.file);
    demi_out_number(&o, &time, sizeof time, turn);
    fprintf(o.file, "\nPOINTS %d %s\n", s.column[0].count, real);
    demi_column_write(&o, s.column, turn);
    fprintf(o.file, "\nVERTICES %d %.0f\n", s.column[0].count, 2*(double)s.column[0].count);
    for (i = 0; i < s.column[0].count; i++) {   /* a cell: number of its points, their indices */
        demi_out_number(&o, &one, sizeof one, turn);
        demi_out_number(&o, &i, sizeof i, turn);
    }
    fprintf(o.file, "\nPOINT_DATA %d\n", s.column[0].count);
    for (i = 1; i < s.count - 2; i++) {
        const demi_column *c = s.column + i;
        const char *type = c->type == 'u' ? "unsigned_int" : c->type == 'i' ? "int" : real;
        if (c->components == 3) fprintf(o.file, "VECTORS %s %s\n", c->name, type);
        else fprintf(o.file, "SCALARS %s %s %d\nLOOKUP_TABLE default\n", c->name, type,
                     c->components);
        demi_column_write(&o, c, turn);
        fputs("\n", o.file);
    }
    demi_columns_free(&s);
    return demi_out_close(&o);
}

/* Extended XYZ. The species is the material: H is 1, He is 2, and so on to Gd, 64, because ASE
   accepts only chemical elements. A domain becomes the lattice, with 1 m along an axis without
   extent. */
DEM_API dem_result dem_xyz_write(dem_world *world, const char *path) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    static const char elements[] =
        "H HeLiBeB C N O F NeNaMgAlSiP S ClArK CaScTiV CrMnFeCoNiCuZnGaGe"
        "AsSeBrKrRbSrY ZrNbMoTcRuRhPdAgCdInSnSbTeI XeCsBaLaCePrNdPmSmEuGd";
    const dem_world_desc desc = dem_world_desc_get(world);
    const dem_box d = desc.domain;
    demi_columns s;
    double length[3];
    char text[3][32], slant[32];
    const int32_t *material;
    demi_out o;
    int i, k, e;
    dem_result result;
    demi_grain_columns(&s, world, __func__);
    result = demi_columns_open(&s, &o, path);
    if (result != DEM_OK) return result;
    length[0] = (double)(d.hi.x - d.lo.x);
    length[1] = (double)(d.hi.y - d.lo.y);
    length[2] = (double)(d.hi.z - d.lo.z);
    fprintf(o.file, "%d\n", s.column[0].count);
    if (length[0] > 0 || length[1] > 0 || length[2] > 0) {
        for (k = 0; k < 3; k++) demi_format_real(text[k], length[k] > 0 ? length[k] : 1, 9);
        demi_format_real(slant, world->cell.offset, 9);     /* of a sheared cell; else 0 */
        fprintf(o.file, "Lattice=\"%s 0 0 %s %s 0 0 0 %s\" ", text[0], slant, text[1], text[2]);
        demi_format_real(text[0], (double)d.lo.x, 9);
        demi_format_real(text[1], (double)d.lo.y, 9);
        demi_format_real(text[2], (double)d.lo.z, 9);
        fprintf(o.file, "Origin=\"%s %s %s\" pbc=\"", text[0], text[1], text[2]);
        for (k = 0; k < 3; k++)
            fprintf(o.file, desc.boundary[k] == DEM_BOUNDARY_PERIODIC ? "T%s" : "F%s",
                    k < 2 ? " " : "\" ");
    }
    fprintf(o.file, "Properties=species:S:1:pos:R:3:radius:R:1:velo:R:3:%s",
            world->bodies.orienting ? "orientation:R:4:aspherical_shape:R:3:" : "");
    for (k = s.count - 2 - world->bodies.real_count; k < s.count - 2; k++)
        fprintf(o.file, "%s:R:1:", s.column[k].name);
    fprintf(o.file, "id:I:1 Time=%s\n", demi_format_real(text[0], dem_world_time_get(world), 12));
    material = (const int32_t *)s.column[DEMI_GRAIN_MATERIAL].data;
    for (i = 0; i < s.column[0].count; i++) {
        const char *element = elements + 2*((material[i] - 1) & 63);
        fprintf(o.file, "%.*s", element[1] == ' ' ? 1 : 2, element);
        for (k = 0; k < s.count - 2; k++) {
            const int n = s.column[k].components;
            const dem_real *x = (const dem_real *)s.column[k].data + (size_t)n*(size_t)i;
            for (e = 0; e < n && s.column[k].type == 'r' && k != DEMI_GRAIN_SPIN; e++)
                fprintf(o.file, " %s", demi_format_real(text[0],       /* quaternions: x y z w */
                                                        (double)x[n == 4 ? (e + 1)%4 : e], 9));
        }
        fprintf(o.file, " %lu\n",
                (unsigned long)((const uint32_t *)s.column[DEMI_GRAIN_ID].data)[i]);
    }
    demi_columns_free(&s);
    return demi_out_close(&o);
}

/* ---- bodies as surfaces ---- */

/* A sphere or ellipsoid is drawn with two poles and rings of points between them. */
enum { DEMI_ROUND_RINGS = 7, DEMI_ROUND_SIDES = 16,
       DEMI_ROUND_POINTS = 2 + DEMI_ROUND_RINGS*DEMI_ROUND_SIDES };
/* The polygons of all bodies. A first pass, with null pointers, counts points, polygons and links;
   a second pass fills the arrays. Data of a body are repeated at each of its points. */
typedef struct demi_surfaces {
    int64_t points, polygons, links;               /* links: corners of all polygons */
    dem_real *place, *velocity, *own[DEM_BODY_REALS]; /* points x 3: m, m/s; user-defined */
    int32_t *id, *material;        /* points */
    int32_t *link, *end;           /* links: the point; polygons: end of each among the links */
} demi_surfaces;
/* Adds a point at `arm` (m) from the body's centre. */
static void demi_surface_point(demi_surfaces *s, const dem_world *w, int body, dem_vec3 centre,
                               dem_vec3 arm) {
    const int64_t n = s->points++;
    int k;
    if (!s->place) return;
    demi_put(s->place + 3*n, demi_add(centre, arm));
    demi_put(s->velocity + 3*n, demi_velocity_at(w->bodies.vel, w->bodies.spin, body, arm));
    s->id[n] = (int32_t)w->bodies.slot[body];
    s->material[n] = w->bodies.material[body];
    for (k = 0; k < w->bodies.real_count; k++)
        s->own[k][n] = w->bodies.reals[w->bodies.real_count*body + k];
}
/* Adds a polygon; corners are counted from point `first`. */
static void demi_surface_polygon(demi_surfaces *s, int64_t first, const int32_t *corners,
                                 int count) {
    int k;
    if (s->link) {
        for (k = 0; k < count; k++) s->link[s->links + k] = (int32_t)(first + corners[k]);
        s->end[s->polygons] = (int32_t)(s->links + count);
    }
    s->links += count;
    s->polygons++;
}
/* Returns the direction of point i of a round part. The first and the last are the poles. */
static dem_vec3 demi_round_direction(int i) {
    const int ring = (i + DEMI_ROUND_SIDES - 1)/DEMI_ROUND_SIDES, side = (i - 1)%DEMI_ROUND_SIDES;
    const double polar = DEMI_PI*ring/(DEMI_ROUND_RINGS + 1);
    const double round = 2*DEMI_PI*side/(int)DEMI_ROUND_SIDES, out = demi_sin(polar);
    return demi_v((dem_real)(out*demi_cos(round)), (dem_real)(out*demi_sin(round)),
                  (dem_real)demi_cos(polar));
}
/* Adds a part without faces: the points that its kind gives for these directions. */
static void demi_surface_round(demi_surfaces *s, const dem_world *w, int body, dem_vec3 centre,
                               const demi_part *p) {
    const int64_t first = s->points;
    const int last = DEMI_ROUND_POINTS - 1;
    int i, k;
    for (i = 0; i < DEMI_ROUND_POINTS; i++) {
        dem_vec3 x = demi_shape_rows[p->kind].drawn(p, demi_round_direction(i));
        if (p->kind != DEMI_BALL) x = dem_quat_rotate(p->q, x);
        demi_surface_point(s, w, body, centre, demi_add(p->centre, x));
    }
    for (i = 0; i <= DEMI_ROUND_RINGS; i++)
        for (k = 0; k < DEMI_ROUND_SIDES; k++) {
            const int up = 1 + (i - 1)*DEMI_ROUND_SIDES, down = 1 + i*DEMI_ROUND_SIDES;
            const int next = (k + 1)%DEMI_ROUND_SIDES;
            int32_t c[4];
            c[0] = i ? up + k : 0;
            c[1] = i < DEMI_ROUND_RINGS ? down + k : last;
            c[2] = i && i < DEMI_ROUND_RINGS ? down + next : i ? up + next : down + next;
            c[3] = up + next;
            demi_surface_polygon(s, first, c, i && i < DEMI_ROUND_RINGS ? 4 : 3);
        }
}
/* Adds a convex polyhedron by its faces. */
static void demi_surface_hull(demi_surfaces *s, const dem_world *w, int body, dem_vec3 centre,
                              const demi_part *p) {
    const demi_shape *shape = p->shape;
    const int32_t *loops = shape->rim + shape->faces + 1;
    const double *x = shape->hull + 4*shape->faces;
    const int64_t first = s->points;
    int i;
    for (i = 0; i < shape->corners; i++, x += 3) {
        const dem_vec3 at = demi_v((dem_real)x[0], (dem_real)x[1], (dem_real)x[2]);
        demi_surface_point(s, w, body, centre,
                           demi_add(p->centre, dem_quat_rotate(p->q, demi_scale(at, p->scale))));
    }
    for (i = 0; i < shape->faces; i++)
        demi_surface_polygon(s, first, loops + shape->rim[i], shape->rim[i + 1] - shape->rim[i]);
}
/* Adds the parts of all bodies. */
static void demi_surfaces_draw(dem_world *w, demi_surfaces *s) {
    const dem_real *places = demi_wrapped(w);
    int i, k;
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < demi_parts_count(w, i); k++) {
            const demi_part p = demi_part_of(w, i, k);
            if (p.kind != DEMI_BALL && p.shape->faces)
                demi_surface_hull(s, w, i, demi_at(places + 4*i), &p);
            else demi_surface_round(s, w, i, demi_at(places + 4*i), &p);
        }
}
DEM_API dem_result dem_surfaces_vtp_write(dem_world *world, const char *path) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    demi_columns columns;
    demi_surfaces s;
    memset(&s, 0, sizeof s);
    demi_surfaces_draw(world, &s);
    demi_columns_begin(&columns, world, __func__);
    s.place = demi_columns_reals(&columns, "Points", "position", 3, s.points);
    s.velocity = demi_columns_reals(&columns, "PointData", "velocity", 3, s.points);
    s.id = demi_columns_ints(&columns, "PointData", "id", 'u', s.points);
    s.material = demi_columns_ints(&columns, "PointData", "material", 'i', s.points);
    demi_columns_own(&columns, s.points, s.own);
    s.link = demi_columns_ints(&columns, "Polys", "connectivity", 'i', s.links);
    s.end = demi_columns_ints(&columns, "Polys", "offsets", 'i', s.polygons);
    s.points = s.polygons = s.links = 0;
    if (!columns.failed) demi_surfaces_draw(world, &s);
    return demi_vtp(&columns, path, 0, 0, (int)s.polygons);
}

/* ---- walls and their loads ---- */

/* Adds a surface of revolution; arguments as for demi_wall_draw. */
static void demi_rings_draw(const demi_wall *wall, int64_t *points, int64_t *triangles,
                            dem_real *place, int32_t *corners, int32_t *id) {
    const int64_t base = *points, first = *triangles;
    const int all = 2*(wall->ring_count - 1)*DEMI_RING_SIDES;
    int k, c;
    *points += wall->ring_count*DEMI_RING_SIDES;
    *triangles += all;
    if (!place) return;
    for (k = 0; k < wall->ring_count*DEMI_RING_SIDES; k++) {
        dem_real local[3];
        demi_ring_corner(wall, k/DEMI_RING_SIDES, k%DEMI_RING_SIDES, local);
        demi_put(place + 3*(base + k), demi_add(wall->pose.position,
                                                demi_rotate(wall->pose.rotation, demi_at(local))));
    }
    for (k = 0; k < all; k++) {
        for (c = 0; c < 3; c++)
            corners[3*(first + k) + c] = (int32_t)(base + demi_ring_triangle(k, c));
        id[first + k] = wall->id;
    }
}
/* Adds wall i in its present pose: points (of a profile at z[0], then at z[1]) and triangles (a
   segment a b, with A B above it, becomes a b B and a B A). Without arrays it only counts. Walls
   without triangles or segments add nothing. */
static void demi_wall_draw(const dem_world *w, int i, const dem_real *z, int64_t *points,
                           int64_t *triangles, dem_real *place, int32_t *corners, int32_t *id) {
    const demi_wall *wall = w->walls + i;
    int64_t k, up = wall->vertex_count, base = *points;
    int c, profile = demi_wall_is(wall, DEMI_DRAWN), sides = profile ? 2 : 1;
    dem_pose pose;
    dem_wall handle;
    handle.id = wall->id;
    if (wall->ring_count) {
        demi_rings_draw(wall, points, triangles, place, corners, id);
        return;
    }
    if (demi_wall_per(wall) < 2) return;
    *points += sides*up;
    *triangles += sides*(int64_t)wall->element_count;
    if (!place || dem_wall_pose_get(w, handle, &pose) != DEM_OK) return;
    for (k = 0; k < sides*up; k++) {
        dem_vec3 local = demi_at(wall->vertices + 3*(k%up));
        if (profile) local.z = z[k/up];
        demi_put(place + 3*(base + k), demi_add(pose.position, demi_rotate(pose.rotation, local)));
    }
    for (k = 0; k < sides*(int64_t)wall->element_count; k++) {
        int64_t at = *triangles - sides*(int64_t)wall->element_count + k;
        const int32_t *from = wall->corners + (profile ? k/2*2 : 3*k);
        int64_t to[3];
        to[0] = from[0];
        to[1] = profile && k%2 ? from[1] + up : from[1];
        to[2] = !profile ? from[2] : (k%2 ? from[0] : from[1]) + up;
        for (c = 0; c < 3; c++) corners[3*at + c] = (int32_t)(base + to[c]);
        id[at] = wall->id;
    }
}

/* Writes to `slide` the work of sliding on the facet of each of `count` triangles of wall i, J; 0
   if none is recorded. A segment of a profile is drawn as two triangles. */
static void demi_wall_slide(const dem_world *w, int i, int64_t count, dem_real *slide) {
    const demi_wall *wall = w->walls + i;
    const int sides = demi_wall_is(wall, DEMI_DRAWN) ? 2 : 1;
    const demi_worn *worn = w->events.walls + i;
    const int there = i < w->events.n.walls && worn->id == wall->id;
    int64_t k;
    for (k = 0; k < count; k++)
        slide[k] = there && k/sides < worn->count
            ? (dem_real)w->events.facets[worn->first + k/sides] : 0;
}
DEM_API dem_result dem_walls_vtp_write(dem_world *world, const char *path, dem_real z0,
                                       dem_real z1) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    int64_t points = 0, triangles = 0, p = 0, t = 0, first;
    const dem_real z[2] = {z0, z1};
    dem_real *place, *slide = 0;
    int32_t *corners, *id;
    demi_columns s;
    int i, profiles = 0;
    for (i = 0; i < world->wall_count; i++) {
        demi_wall_draw(world, i, z, &points, &triangles, 0, 0, 0);
        profiles += demi_wall_is(&world->walls[i], DEMI_DRAWN);
    }
    if (profiles && !(z1 > z0))
        return demi_refuse(world, __func__, "z0 is %g m and z1 is %g m, but z0 must be below z1 to "
                           "extrude a profile between them; change them", (double)z0, (double)z1);
    demi_columns_begin(&s, world, __func__);
    place = demi_columns_reals(&s, "Points", "position", 3, points);
    id = demi_columns_ints(&s, "CellData", "wall", 'i', triangles);
    if (world->events.n.on) slide = demi_columns_reals(&s, "CellData", "sliding", 1, triangles);
    corners = demi_columns_ints(&s, "Polys", "connectivity", 'i', 3*triangles);
    demi_columns_range(&s, "Polys", "offsets", triangles, 3, 3);
    for (i = 0; i < world->wall_count && !s.failed; i++) {
        first = t;
        demi_wall_draw(world, i, z, &p, &t, place, corners, id);
        if (slide) demi_wall_slide(world, i, t - first, slide + first);
    }
    return demi_vtp(&s, path, 0, 0, (int)triangles);
}

/* Fails because the first line of a CSV file is another one. */
static dem_result demi_csv_other(dem_world *w, const char *call, const char *path,
                                 const char *heading) {
    return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s has other columns than %.100s; remove the "
                     "file, or give another path", call, path, heading);
}
/* Appends a line to a CSV file, and before it the heading if the file is new or empty. There is no
   temporary file here. Instead, the line is written in one piece. If the last line of the file was
   cut short (by a full disk or a killed run), the new one begins on a line of its own. A file whose
   first line is not the heading stays as it is. */
enum { DEMI_CSV_LINE = 1200 };
static dem_result demi_csv_append(dem_world *w, const char *call, const char *path,
                                  const char *heading, const char *line) {
    char text[2*DEMI_CSV_LINE];
    int n = 0, last = '\n', whole, cause;
    FILE *file;
    if (!path) return demi_refuse(w, call, "path is null; give a file name");
    errno = 0;
    file = fopen(path, "r+b");                  /* does not wait for a pipe, which is an error */
    whole = !file || demi_file_size(file) != DEMI_ENDLESS;
    if (file) fclose(file);
    file = whole ? fopen(path, "a+b") : 0;
    whole = file && fseek(file, 0, SEEK_END) == 0;
    if (whole && ftell(file) > 0) {
        const size_t head = strlen(heading);
        if (fseek(file, 0, SEEK_SET) || fread(text, 1, head, file) != head ||
            memcmp(text, heading, head) || fgetc(file) != '\n') {
            fclose(file);
            return demi_csv_other(w, call, path, heading);
        }
        whole = fseek(file, -1, SEEK_END) == 0;
        last = whole ? fgetc(file) : last;
        whole = whole && fseek(file, 0, SEEK_END) == 0; /* C requires it between read and write */
        n = snprintf(text, sizeof text, "%s", last == '\n' ? "" : "\n");
    } else n = snprintf(text, sizeof text, "%s\n", heading);
    n += snprintf(text + n, sizeof text - (size_t)n, "%s\n", line);
    whole = whole && fwrite(text, 1, (size_t)n, file) == (size_t)n && fflush(file) == 0;
    cause = errno;
    if (file) fclose(file);
    if (whole) return DEM_OK;
    return demi_fail(w, DEM_ERROR_FILE, "%s: cannot write %.200s: %s; check that its folder "
                     "exists, may be written to and has room", call, path,
                     cause ? strerror(cause) : "unknown cause");
}
/* Prints a number as the cell of a table, with nothing if there is none: it is not finite. */
static const char *demi_format_cell(char *buffer, double value) {
    return demi_finite_double(value) ? demi_format_real(buffer, value, 9) : "";
}
/* Writes the time (s) and `count` values to `line`, of DEMI_CSV_LINE bytes, without a line end. */
static void demi_csv_line(char *line, double time, const double *value, int count) {
    char number[32];
    int i, n = snprintf(line, DEMI_CSV_LINE, "%s", demi_format_real(number, time, 12));
    for (i = 0; i < count; i++)
        n += snprintf(line + n, (size_t)(DEMI_CSV_LINE - n), ",%s",
                      demi_format_cell(number, value[i]));
}
static const char demi_loads_heading[] = "time,fx,fy,fz,tx,ty,tz,torque_axial,power,contacts";
enum { DEMI_LOADS = 9 };
/* Writes the DEMI_LOADS values of that heading that follow the time. */
static dem_result demi_loads_values(dem_world *w, const char *call, dem_wall wall, double *value) {
    dem_wall_loads c;
    if (dem_wall_loads_get(w, wall, &c) != DEM_OK)
        return demi_refuse(w, call, "wall %ld does not exist; give one that was added and not "
                           "removed", (long)wall.id);
    value[0] = (double)c.force.x;
    value[1] = (double)c.force.y;
    value[2] = (double)c.force.z;
    value[3] = (double)c.torque.x;
    value[4] = (double)c.torque.y;
    value[5] = (double)c.torque.z;
    value[6] = (double)c.torque_axial;
    value[7] = (double)c.power;
    value[8] = c.contacts;
    return DEM_OK;
}
DEM_API dem_result dem_wall_loads_csv_write(dem_world *world, dem_wall wall, const char *path) {
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    double value[DEMI_LOADS];
    char line[DEMI_CSV_LINE];
    if (demi_loads_values(world, __func__, wall, value) != DEM_OK) return DEM_ERROR_ARGUMENT;
    demi_csv_line(line, dem_world_time_get(world), value, DEMI_LOADS);
    return demi_csv_append(world, __func__, path, demi_loads_heading, line);
}
