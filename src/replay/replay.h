/* ---------------------------------------------------------------------------------------------
   >>replay
   Replays ("films" in names): recordings of a run in one HTML file. The file contains the viewer,
   then blocks <script type="dem/NAME"> in the order in which they were written, so that an
   incomplete file can be played, too. NAME is head, shape, wall or value (JSON, each before the
   first frame that needs it), frame (base64) or report. This part owns dem_replay and the list
   w->look.films. It reads the world; before a frame it completes the half kick that is due.

   A frame contains only changes since the frame before. Numbers are little-endian. Counts, slots
   and other integers are varints: 7 bits in each byte, lowest first; the top bit is set if another
   byte follows. A frame consists of
       time           float64, s
       walls          count; for each: id, 0 (removed), or 1, position (m) and rotation w x y z (7
                      float32)
       gone           count; for each: slot
       new            count; for each: slot, material, shape, radius (float32, m); its position,
                      speed, orientation and number begin at 0
       grains         for each grain, in the order of slots:
           flags          one byte: 2 bits for each of x, y, z; 64; 128
           position       change of x, y, z in units of the resolution; 0, 1, 2 or 4 bytes if the
                          two bits are 0, 1, 2 or 3
           speed          if flag 64: one byte, 128 + 8 log2 of the speed in m/s (0: at rest)
           more flags     if flag 128: one byte
           orientation    if 1 of the second byte: 4 bytes; the three smallest components with 10
                          bits each, and in the top two bits the index of the one left out
           number         if 2 of the second byte: float32, the number that grains are coloured by
       values         count; for each: index, float32
       contacts       only if the head has "contacts":1. 0: those of an earlier frame remain.
                      Otherwise 1 + count, and for each: slot of a; slot of b + 1, or 0 for a wall;
                      for a wall the contact point minus the centre of a in units of the
                      resolution, 3 int16; 32768 + 64 log2 of the force in N, uint16

   Tests: tests/replay/test_replay.c reads replays back, tests/browser.sh plays them in a browser.
   --------------------------------------------------------------------------------------------- */

/* What the frames so far say about the body in a slot. */
typedef struct demi_seen {
    int32_t place[3];                /* position in units of the resolution */
    uint32_t generation, turn;       /* of the body; orientation as in the file */
    int32_t material, shape;
    float own, radius;               /* the user's number; m */
    unsigned char speed, there;      /* as in the file; 1: there is a body */
} demi_seen;
struct dem_replay {
    dem_world *world;
    demi_out out;
    dem_replay_desc desc;
    char title[200], number[64];     /* copies of the desc's; number: "" if there is none */
    int real;                        /* index of that number in desc.body_reals, or -1 */
    int group;                       /* index of the group that is the number, or -1 */
    double resolution;               /* m, of positions; 0: no frame yet */
    demi_seen *seen;                 /* x seen_count: one for each slot */
    float (*pose)[7];                /* by index of the wall: its pose when last written */
    int32_t *wall_told;              /* by index of the wall: its id when last written; 0: none */
    dem_contact_info *contacts;      /* of the present frame */
    unsigned char *bytes;            /* the frame being written, */
    size_t size;                     /* and its length so far */
    int seen_count, wall_count, shape_count, value_count, frames, failed;  /* failed: no memory */
    char names[DEM_REPLAY_VALUES][64];     /* of plotted values */
    double values[DEM_REPLAY_VALUES];
    int given[DEM_REPLAY_VALUES];    /* 1: set since the last frame */
    double begun;                    /* s, time of the first automatic frame */
    double due;                      /* intervals from there to the next one; below 0: none yet */
    dem_replay *next;                /* in the world's list of replays with automatic frames */
};

/* --- bytes of a frame, and JSON --- */

/* Appends `size` bytes to the frame; number: in little-endian order. If memory runs out, sets
   r->failed. */
static void demi_film_put(dem_replay *r, const void *data, size_t size, int number) {
    if (r->failed || !demi_grow(r->world, DEMI_LOOSE, &r->bytes, 1, r->size + size)) {
        r->failed = 1;
        return;
    }
    memcpy(r->bytes + r->size, data, size);
    if (number && !demi_is_little_endian()) {
        const unsigned char *from = (const unsigned char *)data;
        size_t i;
        for (i = 0; i < size; i++) r->bytes[r->size + i] = from[size - 1 - i];
    }
    r->size += size;
}
static void demi_film_byte(dem_replay *r, int value) {
    const unsigned char byte = (unsigned char)value;
    demi_film_put(r, &byte, 1, 0);
}
/* Appends an integer as a varint. */
static void demi_film_count(dem_replay *r, uint32_t value) {
    for (; value > 127; value >>= 7) demi_film_byte(r, (int)(value & 127) | 128);
    demi_film_byte(r, (int)value);
}
/* Appends a float32, limited to its range. */
static void demi_film_real(dem_replay *r, double value) {
    const float number = (float)DEMI_MAX(-3e38, DEMI_MIN(3e38, value));
    demi_film_put(r, &number, sizeof number, 1);
}
/* Writes the frame to the file, as a block in base64. */
static void demi_film_block(dem_replay *r) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[4096];
    size_t i, n = 0;
    fputs("<script type=\"dem/frame\">", r->out.file);
    for (i = 0; i < r->size; i += 3) {
        const size_t left = r->size - i;
        const uint32_t v = (uint32_t)r->bytes[i] << 16 |
            (left > 1 ? (uint32_t)r->bytes[i + 1] << 8 : 0) | (left > 2 ? r->bytes[i + 2] : 0u);
        text[n++] = digits[v >> 18];
        text[n++] = digits[v >> 12 & 63];
        text[n++] = left > 1 ? digits[v >> 6 & 63] : '=';
        text[n++] = left > 2 ? digits[v & 63] : '=';
        if (n == sizeof text || left <= 3) { fwrite(text, 1, n, r->out.file); n = 0; }
    }
    fputs("</script>\n", r->out.file);
}
/* Writes text as a JSON string. It escapes <, so that the text cannot end the script block. */
static void demi_film_text(FILE *out, const char *text) {
    fputc('"', out);
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < 32 || c == '"' || c == '\\' || c == '<') fprintf(out, "\\u%04x", (unsigned)c);
        else fputc(c, out);
    }
    fputc('"', out);
}
/* Writes a JSON array of count x per numbers after other members of an object. */
static void demi_film_reals(FILE *out, const char *name, const dem_real *values, int count, int per,
                            int stride) {
    char number[32];
    int i, k;
    fprintf(out, ",\"%s\":[", name);
    for (i = 0; i < count; i++)
        for (k = 0; k < per; k++)
            fprintf(out, "%s%s", i + k ? "," : "",
                    demi_format_real(number, (double)values[i*stride + k], 7));
    fputs("]", out);
}

/* --- blocks before the frames that need them --- */

/* Writes the head: title, resolution, gravity, periods and the name of the user's number. */
static void demi_film_head(dem_replay *r) {
    const dem_world_desc d = dem_world_desc_get(r->world);
    const demi_periods p = demi_periods_of(r->world);
    const dem_real gravity[3] = {d.gravity.x, d.gravity.y, d.gravity.z};
    FILE *out = r->out.file;
    char text[32];
    fprintf(out, "<script type=\"dem/head\">{\"version\":1,\"title\":");
    demi_film_text(out, r->title);
    fprintf(out, ",\"planar\":%d,\"resolution\":%s", d.planar,
            demi_format_real(text, r->resolution, 9));
    demi_film_reals(out, "gravity", gravity, 1, 3, 3);
    demi_film_reals(out, "period", p.period, 1, 3, 3);
    fputs(",\"number\":", out);
    if (*r->number) demi_film_text(out, r->number);
    else fputs("null", out);
    if (r->desc.contacts) fputs(",\"contacts\":1", out);
    fputs(",\"values\":[]}</script>\n", out);
}
/* Writes a shape: member spheres, pieces of a union, planes of faces, or semi-axes. */
static void demi_film_shape(dem_replay *r, int id) {
    const demi_shape *s = &r->world->shapes[id - 1];
    const dem_real axes[3] = {s->axes.x, s->axes.y, s->axes.z};
    dem_real planes[3*(DEM_POLYHEDRON_FACES + DEMI_ROUND_POINTS)];
    char text[32];
    int k, faces = s->faces;
    for (k = 0; k < 3*s->faces; k++) planes[k] = (dem_real)s->hull[k/3*4 + k%3];
    if (!s->count && !s->pieces && !faces && s->kind != DEMI_ELLIPSOID)
        for (; faces < DEMI_ROUND_POINTS; faces++) {       /* planes that touch it all around */
            const dem_vec3 n = demi_round_direction(faces);
            demi_put(planes + 3*faces, demi_scale(n, 1/demi_shape_rows[s->kind].support(s, n)));
        }
    fprintf(r->out.file, "<script type=\"dem/shape\">{\"id\":%d,\"radius\":%s", id,
            demi_format_real(text, (double)s->radius, 9));
    if (s->count) demi_film_reals(r->out.file, "parts", s->parts, s->count, 4, 4);
    else if (s->pieces) {
        fputs(",\"pieces\":[", r->out.file);
        for (k = 0; k < s->pieces; k++) {
            const demi_piece *o = s->piece + k;
            const double row[7] = {(double)o->at.x, (double)o->at.y, (double)o->at.z,
                                   (double)o->q.w, (double)o->q.x, (double)o->q.y, (double)o->q.z};
            int e;
            fprintf(r->out.file, "%s%d", k ? "," : "", (int)o->shape + 1);
            for (e = 0; e < 7; e++)
                fprintf(r->out.file, ",%s", demi_format_real(text, row[e], 9));
        }
        fputs("]", r->out.file);
    }
    else if (faces) demi_film_reals(r->out.file, "planes", planes, faces, 3, 3);
    else demi_film_reals(r->out.file, "axes", axes, 1, 3, 3);
    fputs("}</script>\n", r->out.file);
}
/* Writes the geometry of wall i in its own frame. */
static void demi_film_wall(dem_replay *r, int i) {
    const demi_wall *wall = &r->world->walls[i];
    const demi_wall_kind *kind = &demi_wall_kinds[wall->kind];
    const dem_sieve_desc *s = &wall->sieve;
    FILE *out = r->out.file;
    char text[32];
    int k, corners = wall->corners ? wall->element_count*kind->corners : 0;
    fprintf(out, "<script type=\"dem/wall\">{\"id\":%d,\"kind\":\"%s\",\"radius\":%s",
            (int)wall->id, kind->traits & DEMI_BALLS ? "grains" : kind->traits & DEMI_DRAWN
            ? "profile" : wall->ring_count ? "mesh" : kind->name,
            demi_format_real(text, (double)wall->radius, 9));
    if (wall->vertices)
        demi_film_reals(out, "vertices", wall->vertices, wall->vertex_count, 3, 3);
    for (k = 0; k < corners; k++)
        fprintf(out, "%s%ld", k ? "," : ",\"corners\":[", (long)wall->corners[k]);
    if (corners) fputs("]", out);
    for (k = 0; k < wall->ring_count*DEMI_RING_SIDES; k++) {
        dem_real at[3];
        int c;
        demi_ring_corner(wall, k/DEMI_RING_SIDES, k%DEMI_RING_SIDES, at);
        for (c = 0; c < 3; c++)
            fprintf(out, "%s%s", k + c ? "," : ",\"vertices\":[",
                    demi_format_real(text, (double)at[c], 7));
    }
    for (k = 0; k < 6*(wall->ring_count - 1)*DEMI_RING_SIDES; k++)
        fprintf(out, "%s%d", k ? "," : "],\"corners\":[", demi_ring_triangle(k/3, k%3));
    if (wall->ring_count) fputs("]", out);
    if (s->kind) {
        const dem_real hole[4] = {(dem_real)(int)s->kind, s->aperture, s->bar, s->length};
        demi_film_reals(out, "hole", hole, 1, 4, 4);
        fprintf(out, ",\"staggered\":%d,\"rim\":%s", s->staggered,
                demi_format_real(text, (double)s->radius, 9));
    }
    fputs("}</script>\n", out);
}

/* --- a frame --- */

/* Appends walls that have moved, are new or are gone. The first pass counts them and writes the
   blocks of new walls. */
static void demi_film_walls(dem_replay *r) {
    dem_world *w = r->world;
    uint32_t changed = 0;
    int i, k, pass;
    if (!demi_grow(w, DEMI_LOOSE, &r->pose, sizeof *r->pose, (size_t)w->wall_count) ||
        !demi_grow(w, DEMI_LOOSE, &r->wall_told, sizeof *r->wall_told, (size_t)w->wall_count)) {
        r->failed = 1;
        return;
    }
    for (pass = 0; pass < 2; pass++) {
        if (pass) demi_film_count(r, changed);
        for (i = 0; i < w->wall_count; i++) {
            const demi_wall *wall = &w->walls[i];
            const int there = wall->kind != DEMI_WALL_NONE, known = r->wall_told[i] == wall->id;
            float now[7];
            double R[3][3];
            dem_quat q;
            if (r->wall_told[i] && !(there && known)) {
                changed += !pass;
                if (pass) {
                    demi_film_count(r, (uint32_t)r->wall_told[i]);
                    demi_film_byte(r, 0);
                    r->wall_told[i] = 0;
                }
            }
            if (!there) continue;
            for (k = 0; k < 9; k++) R[k/3][k%3] = (double)wall->pose.rotation[k];
            q = demi_quat_of(R);
            now[0] = (float)wall->pose.position.x; now[1] = (float)wall->pose.position.y;
            now[2] = (float)wall->pose.position.z;
            now[3] = (float)q.w; now[4] = (float)q.x; now[5] = (float)q.y; now[6] = (float)q.z;
            if (known && !memcmp(now, r->pose[i], sizeof now)) continue;
            if (!pass) {
                if (!known) demi_film_wall(r, i);
                changed++;
                continue;
            }
            r->wall_told[i] = wall->id;
            memcpy(r->pose[i], now, sizeof now);
            demi_film_count(r, (uint32_t)wall->id);
            demi_film_byte(r, 1);
            for (k = 0; k < 7; k++) demi_film_real(r, (double)now[k]);
        }
    }
}
/* True if the body in slot s is the one that was there, with the same radius, material and
   shape. */
static int demi_film_same(const dem_replay *r, const dem_bodies *b, int s) {
    const demi_bodies *bodies = &r->world->bodies;
    const demi_seen *old = &r->seen[s];
    const int i = s < bodies->slot_count ? bodies->slot_index[s] : -1;
    const float radius = i < 0 ? 0 : (float)b->positions[4*i + 3];
    return i >= 0 && bodies->slot_generation[s] == old->generation &&
        !memcmp(&radius, &old->radius, sizeof radius) && b->materials[i] == old->material &&
        (b->shapes ? b->shapes[i] : 0) == old->shape;
}
/* Appends the bodies that are gone, then the new ones, by slot. One that has changed is both. */
static void demi_film_cast(dem_replay *r, const dem_bodies *b) {
    const demi_bodies *bodies = &r->world->bodies;
    uint32_t gone = 0, fresh = 0;
    int s, pass;
    for (pass = 0; pass < 2; pass++) {
        if (pass) demi_film_count(r, gone);
        for (s = 0; s < r->seen_count; s++) {
            demi_seen *old = &r->seen[s];
            if (!old->there || demi_film_same(r, b, s)) continue;
            if (!pass) { gone++; continue; }
            old->there = 0;
            demi_film_count(r, (uint32_t)s);
        }
    }
    r->seen_count = bodies->slot_count;
    for (pass = 0; pass < 2; pass++) {
        if (pass) demi_film_count(r, fresh);
        for (s = 0; s < r->seen_count; s++) {
            const int i = bodies->slot_index[s];
            demi_seen *one = &r->seen[s];
            if (i < 0 || one->there) continue;
            if (!pass) { fresh++; continue; }
            memset(one, 0, sizeof *one);
            one->there = 1;
            one->generation = bodies->slot_generation[s];
            one->material = b->materials[i];
            one->shape = b->shapes ? b->shapes[i] : 0;
            one->radius = (float)b->positions[4*i + 3];
            demi_film_count(r, (uint32_t)s);
            demi_film_count(r, (uint32_t)one->material);
            demi_film_count(r, (uint32_t)one->shape);
            demi_film_real(r, (double)b->positions[4*i + 3]);
        }
    }
}
/* Returns a quaternion in 32 bits: the three smallest components with 10 bits each, and the index
   of the largest, which is made positive, in the top two bits. */
static uint32_t demi_film_turn(const dem_real *q) {
    int k, most = 0, bit = 0;
    uint32_t turn;
    for (k = 1; k < 4; k++) if (DEMI_ABS(q[k]) > DEMI_ABS(q[most])) most = k;
    turn = (uint32_t)most << 30;
    for (k = 0; k < 4; k++) {
        if (k == most) continue;
        turn |= (uint32_t)floor(511.5 + (double)(q[most] < 0 ? -q[k] : q[k])*1.41421356*511) << bit;
        bit += 10;
    }
    return turn;
}
/* Appends the changes of body i, in slot s, since the frame before. */
static void demi_film_grain(dem_replay *r, const dem_bodies *b, int s, int i) {
    demi_seen *one = &r->seen[s];
    const dem_real *v = b->velocities + 4*i;
    const double speed = sqrt((double)(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]));
    const int code = speed > 0 ? (int)floor(128.5 + 8*demi_log(speed)/0.69314718) : 0;
    const unsigned char told = (unsigned char)(speed > 0 ? DEMI_MAX(1, DEMI_MIN(255, code)) : 0);
    const uint32_t turn = b->shapes && b->shapes[i] ? demi_film_turn(b->orientations + 4*i) : 0;
    dem_body id;
    float own = 0;
    int k, flags = 0, more = 0;
    int32_t change[3];
    for (k = 0; k < 3; k++) {
        const double x = (double)b->positions[4*i + k]/r->resolution;
        const int32_t place = (int32_t)floor(DEMI_MAX(-1e9, DEMI_MIN(1e9, x)) + 0.5);
        change[k] = place - one->place[k];
        one->place[k] = place;
        flags |= (!change[k] ? 0 : change[k] >= -128 && change[k] < 128 ? 1 :
                  change[k] >= -32768 && change[k] < 32768 ? 2 : 3) << 2*k;
    }
    if (r->desc.number_fn) {
        id.slot = (uint32_t)s + 1;
        id.generation = one->generation;
        DEMI_USER(r->world, "dem_replay_frame_write", 1,
                  own = (float)r->desc.number_fn(r->world, id, r->desc.user))
    } else if (r->group >= 0) own = (float)(r->world->bodies.groups[i] >> r->group & 1);
    else if (r->real >= 0) own = (float)b->reals[b->real_count*i + r->real];
    if (told != one->speed) flags |= 64;
    if (turn != one->turn) more |= 1;
    if (memcmp(&own, &one->own, sizeof own)) more |= 2;    /* compares bits: it may be NaN */
    demi_film_byte(r, more ? flags | 128 : flags);
    for (k = 0; k < 3; k++) {
        const int size = flags >> 2*k & 3;
        const int16_t medium = (int16_t)change[k];
        if (size == 1) demi_film_byte(r, change[k] & 255);
        if (size == 2) demi_film_put(r, &medium, 2, 1);
        if (size == 3) demi_film_put(r, &change[k], 4, 1);
    }
    if (flags & 64) demi_film_byte(r, told);
    if (more) demi_film_byte(r, more);
    if (more & 1) demi_film_put(r, &turn, 4, 1);
    if (more & 2) demi_film_real(r, (double)own);
    one->speed = told;
    one->turn = turn;
    one->own = own;
}
/* Largest number of contacts in a frame. Each takes at most 18 bytes. */
enum { DEMI_FILM_CONTACTS = 50000 };
/* Appends the contacts of a frame that records them. Leaves out forces below 1 % of the largest,
   whose lines would be thin, and raises this limit until at most DEMI_FILM_CONTACTS are left. */
static void demi_film_contacts(dem_replay *r, const dem_bodies *b) {
    dem_world *w = r->world;
    const int due = r->desc.contacts && r->frames%r->desc.contacts == 0 && demi_contacts_known(w);
    const int count = due ? dem_contacts_get(w, 0, 0) : 0;
    const demi_periods periods = demi_periods_of(w);
    double least = 0;
    uint32_t kept = 0;
    int k, c;
    if (!r->desc.contacts) return;
    if (!due) { demi_film_count(r, 0); return; }
    if (!demi_grow(w, DEMI_LOOSE, &r->contacts, sizeof *r->contacts, (size_t)count + 1)) {
        r->failed = 1;
        return;
    }
    dem_contacts_get(w, r->contacts, count);
    for (k = 0; k < count; k++)
        least = fmax(least, (double)demi_length(r->contacts[k].force)/100);
    do {
        kept = 0;
        for (k = 0; k < count; k++)
            kept += least > 0 && (double)demi_length(r->contacts[k].force) >= least;
        least *= kept > DEMI_FILM_CONTACTS ? 1.25 : 1;
    } while (kept > DEMI_FILM_CONTACTS);
    demi_film_count(r, kept + 1);
    for (k = 0; k < count && kept; k++) {
        const dem_contact_info *o = r->contacts + k;
        const double force = (double)demi_length(o->force);
        const dem_real *at = b->positions + 4*w->bodies.slot_index[o->a.slot - 1];
        dem_real arm[3];
        uint16_t code;
        if (force < least) continue;
        demi_put(arm, demi_nearest(&periods, demi_sub(o->point, demi_at(at))));
        demi_film_count(r, o->a.slot - 1);
        demi_film_count(r, o->b.slot);
        for (c = 0; c < 3 && !o->b.slot; c++) {
            const double x = (double)arm[c]/r->resolution;
            const int16_t from = (int16_t)floor(DEMI_MAX(-32767, DEMI_MIN(32767, x)) + 0.5);
            demi_film_put(r, &from, 2, 1);
        }
        code = (uint16_t)DEMI_MAX(0, DEMI_MIN(65535, 32768.5 + 64*demi_log(force)/0.69314718));
        demi_film_put(r, &code, 2, 1);
    }
}
/* Before the first frame: chooses the resolution of positions and writes the head. */
static void demi_film_resolve(dem_replay *r, const dem_bodies *b) {
    dem_real least = 0;
    int i;
    for (i = 0; i < b->count; i++)
        if (!i || b->positions[4*i + 3] < least) least = b->positions[4*i + 3];
    r->resolution = r->desc.resolution > 0 ? (double)r->desc.resolution : b->count ?
        (double)least/32 : 1e-5;
    demi_film_head(r);
}
/* Fails if memory ran out or the file cannot be written. */
static dem_result demi_film_check(dem_replay *r, const char *call) {
    if (r->failed) return demi_no_memory(r->world, call);
    if (!ferror(r->out.file)) return DEM_OK;
    return demi_fail(r->world, DEM_ERROR_FILE, "%s: cannot write %.200s: %s; check that its folder "
                     "has room", call, r->out.path, errno ? strerror(errno) : "unknown cause");
}
DEM_API dem_result dem_replay_frame_write(dem_replay *r) {
    if (!r || demi_null_write(r->world, __func__, r, "replay")) return DEM_ERROR_ARGUMENT;
    dem_world *w = r->world;
    demi_calling was;
    double time;
    uint32_t values = 0;
    int s, k;
    errno = 0;
    dem_result result = demi_film_check(r, __func__);
    if (result != DEM_OK) return result;
    if (!demi_grow(w, DEMI_LOOSE, &r->seen, sizeof *r->seen, (size_t)w->bodies.slot_count + 1)) {
        r->failed = 1;
        return demi_film_check(r, __func__);
    }
    demi_finish(w);
    was = demi_calls(w, __func__, 1);
    const dem_bodies b = dem_bodies_get(w);
    if (!(r->resolution > 0)) demi_film_resolve(r, &b);
    for (; r->shape_count < w->shape_count; r->shape_count++)
        demi_film_shape(r, r->shape_count + 1);
    r->size = 0;
    time = dem_world_time_get(w);
    demi_film_put(r, &time, sizeof time, 1);
    demi_film_walls(r);
    demi_film_cast(r, &b);
    for (s = 0; s < r->seen_count; s++)
        if (r->seen[s].there) demi_film_grain(r, &b, s, w->bodies.slot_index[s]);
    for (k = 0; k < r->value_count; k++) values += (uint32_t)r->given[k];
    demi_film_count(r, values);
    for (k = 0; k < r->value_count; k++) {
        if (!r->given[k]) continue;
        demi_film_count(r, (uint32_t)k);
        demi_film_real(r, r->values[k]);
        r->given[k] = 0;
    }
    demi_film_contacts(r, &b);
    if (!r->failed) demi_film_block(r);
    demi_called(w, was);
    r->frames++;
    return demi_film_check(r, __func__);
}

/* --- automatic frames; opening, values, closing --- */

/* Writes the frames that are due at this step. A frame that fails ends its replay, not the run;
   dem_replay_close returns the error. */
static void demi_films_look(dem_world *w) {
    dem_replay *r;
    for (r = w->look.films; r; r = r->next) {
        if (r->due < 0) { r->due = 0; r->begun = w->clock.time; }
        if (r->failed || w->clock.time < r->begun + r->due*r->desc.interval -
            (double)w->clock.dt/2) continue;
        r->due = floor((w->clock.time + (double)w->clock.dt/2 - r->begun)/r->desc.interval) + 1;
        dem_replay_frame_write(r);
    }
}

/* Removes a replay from the world's list and frees it. */
static void demi_film_free(dem_replay *r) {
    dem_world *w = r->world;
    dem_replay **at = &w->look.films;
    while (*at && *at != r) at = &(*at)->next;
    if (*at) *at = r->next;
    if (!w->look.films) w->look.films_look = 0;
    demi_free(w, r->seen);
    demi_free(w, r->pose);
    demi_free(w, r->wall_told);
    demi_free(w, r->contacts);
    demi_free(w, r->bytes);
    demi_free(w, r);
}
#define DEMI_OF dem_replay_desc
static const demi_field_row demi_replay_rows[] = {
    DEMI_ROW_FREE(DEMI_OF, title), DEMI_ROW_FREE(DEMI_OF, number),
    DEMI_ROW_FREE(DEMI_OF, number_fn), DEMI_ROW_FREE(DEMI_OF, user),
    DEMI_ROW_IF(resolution, DEMI_FROM, DBL_MAX, "m",
                "where 0 means 1/32 of the smallest radius", 0, 0, 0),
    DEMI_LIMITED_IF(DEMI_OF, interval, 'd', DEMI_FROM, DBL_MAX, "s",
                    "where 0 means frames only from dem_replay_frame_write", 0, 0, 0),
    DEMI_LIMITED(DEMI_OF, contacts, 'i', DEMI_FROM, INT_MAX, ""), DEMI_ROW_END};
#undef DEMI_OF
DEM_API dem_replay *dem_replay_open(dem_world *w, const char *path, const dem_replay_desc *desc) {
    static const dem_replay_desc zero = {0, 0, 0, 0, 0, 0, 0};
    const dem_replay_desc d = desc ? *desc : zero;
    const char *slash;
    dem_replay *r;
    size_t k;
    int i, n, group, real = w && w->bodies.real_count && !d.number_fn ? 0 : -1;
    if (demi_null_write(w, __func__, w, "world")) return 0;
    if (demi_rows_check(w, __func__, demi_replay_rows, &d, "",
                        "start from DEM_REPLAY_DESC and set only what differs")) return 0;
    for (i = 0; d.number && !d.number_fn && i < w->bodies.real_count; i++) {
        const char *name = demi_name(w->desc.body_reals, i, &n);
        if (strlen(d.number) == (size_t)n && !strncmp(name, d.number, (size_t)n)) break;
        real = i + 1;
    }
    group = d.number_fn ? -1 : demi_group_find(w, d.number);
    if (group >= 0) real = -1;
    if (d.number && !d.number_fn && group < 0 && (real < 0 || real >= w->bodies.real_count)) {
        demi_refuse(w, __func__, "number is \"%.60s\", which desc.body_reals does not "
                    "name, nor desc.groups; name it there, or give number_fn", d.number);
        return 0;
    }
    r = (dem_replay *)demi_alloc(w, 1, sizeof *r);
    if (!r) { demi_no_memory(w, __func__); return 0; }
    r->world = w;
    r->desc = d;
    r->real = real;
    r->group = group;
    if (demi_out_open(&r->out, w, __func__, path) != DEM_OK) { demi_free(w, r); return 0; }
    r->out.path = r->out.place;                 /* a copy: the caller's text may not last */
    slash = strrchr(path, '/');
    demi_words(r->title, sizeof r->title, "%s", d.title ? d.title : slash ? slash + 1 : path);
    if (real >= 0) {
        const char *name = demi_name(w->desc.body_reals, real, &n);
        demi_words(r->number, sizeof r->number, "%.*s", n, name);
    } else if (d.number_fn || group >= 0)
        demi_words(r->number, sizeof r->number, "%s", d.number ? d.number : "number");
    for (k = 0; k < sizeof demi_viewer/sizeof *demi_viewer; k++) fputs(demi_viewer[k], r->out.file);
    r->due = -1;
    if (d.interval > 0) {
        r->next = w->look.films;
        w->look.films = r;
        w->look.films_look = demi_films_look;
    }
    return r;
}
DEM_API dem_result dem_replay_value_set(dem_replay *r, const char *name, double value) {
    int k;
    if (!r || demi_null_write(r->world, __func__, r, "replay")) return DEM_ERROR_ARGUMENT;
    if (!name || !*name || strlen(name) >= sizeof r->names[0])
        return demi_refuse(r->world, __func__, "name is %.80s, must have 1 to %d "
                           "letters", name ? *name ? name : "empty" : "null",
                           (int)sizeof r->names[0] - 1);
    for (k = 0; k < r->value_count && strcmp(r->names[k], name) != 0; k++) {}
    if (k == DEM_REPLAY_VALUES)
        return demi_refuse(r->world, __func__, "\"%.60s\" would be value %d, but a "
                           "replay draws at most %d; leave some out", name, k + 1,
                           (int)DEM_REPLAY_VALUES);
    if (k == r->value_count) {
        r->value_count++;
        strcpy(r->names[k], name);
        fputs("<script type=\"dem/value\">{\"name\":", r->out.file);
        demi_film_text(r->out.file, name);
        fputs("}</script>\n", r->out.file);
    }
    r->values[k] = value;
    r->given[k] = value > -1e300 && value < 1e300;         /* NaN and infinity leave a gap */
    return DEM_OK;
}
DEM_API dem_result dem_replay_close(dem_replay *r) {
    dem_result result;
    if (!r || demi_null_write(r->world, __func__, r, "replay")) return DEM_ERROR_ARGUMENT;
    if (r->failed) {                            /* a frame is missing: the file is removed */
        demi_out_drop(&r->out);
        result = demi_film_check(r, __func__);
        demi_film_free(r);
        return result;
    }
    if (!r->frames) {                           /* the viewer reports a replay without frames */
        const dem_bodies b = dem_bodies_get(r->world);
        demi_film_resolve(r, &b);
    }
    fputs("<script type=\"dem/report\">", r->out.file);
#ifndef DEM_NO_REPORTS
    dem_world_report(r->world, r->out.file);
#endif
    fputs("</script>\n", r->out.file);
    r->out.call = __func__;
    result = demi_out_close(&r->out);
    demi_film_free(r);
    return result;
}

#if defined(__clang__)
#pragma STDC FP_CONTRACT DEFAULT
#elif defined(__GNUC__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
