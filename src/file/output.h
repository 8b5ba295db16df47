/* ---------------------------------------------------------------------------------------------
   >>output
   Scheduled outputs: files that are written and functions that are called at regular intervals of
   simulated time. dem_world_step calls demi_outputs_look, through the pointer in demi_lookers,
   before its first step and after every step. This part owns the outputs in w->look.

   The record of what each output has written (demi_written) is part of the state. A run that
   continues from a checkpoint therefore writes the same files as a run without interruption. Before
   it appends to a CSV file, it removes the lines of later times.
   Tests: tests/file/test_output.c.
   --------------------------------------------------------------------------------------------- */
static const char demi_output_columns[] = "steps bodies contacts kinetic rotational overlap_max";

/* Returns a copy of a text that lives as long as the world. Null if `text` is null or memory ran
   out. */
static char *demi_text_copy(dem_world *w, const char *text) {
    const size_t size = text ? strlen(text) + 1 : 0;
    char *copy = size ? (char *)demi_hold(w, DEMI_SCENE, size, 1) : 0;
    if (copy) memcpy(copy, text, size);
    return copy;
}
/* Returns where the last run of # in a path begins. *count receives its length, 0 if none. */
static size_t demi_output_marks(const char *path, size_t *count) {
    size_t end = strlen(path), begin;
    while (end > 0 && path[end - 1] != '#') end--;
    for (begin = end; begin > 0 && path[begin - 1] == '#'; begin--) {}
    *count = end - begin;
    return begin;
}
static const char demi_mixing_heading[] = "time,grains,part,cells,variance,lacey,kramer,"
    "segregation_x,segregation_y,segregation_z,segregation_radial,contact_segregation";
enum { DEMI_MIXING = 11 };
/* Writes the DEMI_MIXING values of that heading that follow the time. */
static dem_result demi_mixing_values(const dem_world *w, const dem_mixing_desc *d, double *value) {
    dem_mixing m;
    const dem_result result = dem_mixing_get(w, d, &m);
    if (result != DEM_OK) return result;
    value[0] = m.grains;
    value[1] = m.part;
    value[2] = m.cells;
    value[3] = m.variance;
    value[4] = m.lacey;
    value[5] = m.kramer;
    memcpy(value + 6, m.segregation, 3*sizeof *value);
    value[9] = m.segregation_radial;
    value[10] = m.contact_segregation;
    return DEM_OK;
}
static const char demi_outlet_heading[] =
    "time,grains,mass,sorted,sorted_mass,gangue,gangue_mass,back,back_mass,held,held_mass";
enum { DEMI_OUTLET = 10 };
/* Writes the DEMI_OUTLET values of this heading, all columns except the time. */
static dem_result demi_outlet_values(const dem_world *w, dem_outlet outlet, double *value) {
    dem_outlet_state s;
    const dem_result result = dem_outlet_get(w, outlet, &s);
    if (result != DEM_OK) return result;
    value[0] = (double)s.total;
    value[1] = s.total_mass;
    value[2] = (double)s.sorted;
    value[3] = s.sorted_mass;
    value[4] = (double)s.gangue;
    value[5] = s.gangue_mass;
    value[6] = (double)s.back_total;
    value[7] = s.back_total_mass;
    value[8] = (double)s.held_total;
    value[9] = s.held_total_mass;
    return DEM_OK;
}
/* Returns the names of the columns of a CSV file, without the time, separated by spaces. */
static const char *demi_output_names(const dem_output_desc *d) {
    return d->columns ? d->columns : demi_output_columns;
}
/* True if a line of the CSV file is the mixing of two components. */
static int demi_output_mixes(const dem_output_desc *d) {
    return d->mixing.cells[0] || d->mixing.cells[1] || d->mixing.cells[2];
}
/* Writes the first line of a CSV file to `heading`, of at least DEMI_CSV_LINE bytes. */
static void demi_output_heading(const dem_output_desc *d, char *heading) {
    char *c;
    if (d->wall.id) { strcpy(heading, demi_loads_heading); return; }
    if (d->outlet.id) { strcpy(heading, demi_outlet_heading); return; }
    if (demi_output_mixes(d)) { strcpy(heading, demi_mixing_heading); return; }
    strcpy(heading, "time ");
    demi_names_copy(demi_output_names(d), heading + 5);
    for (c = heading; *c; c++) if (*c == ' ') *c = ',';
}
/* Truncates a CSV file before its first line that has a time of `from` (s) or later, cannot be read
   as a number, or was cut short. Fails if the file has other columns. A file that does not exist is
   no error. */
static dem_result demi_csv_resume(dem_world *w, const char *path, const char *heading,
                                  double from) {
    const char *call = "dem_world_step";        /* the call that fails and is repeated */
    const size_t head = strlen(heading);
    char *data = 0, *line;
    size_t size = 0, keep;
    demi_out out;
    dem_result result;
    FILE *there = demi_open(path);
    if (!there) return DEM_OK;
    fclose(there);
    result = demi_load(w, call, path, &data, &size);
    if (result != DEM_OK || !size) { demi_free(w, data); return result; }
    if (size <= head || memcmp(data, heading, head) || data[head] != '\n') {
        demi_free(w, data);
        return demi_csv_other(w, call, path, heading);
    }
    for (keep = head + 1; keep < size; keep = (size_t)(line - data) + 1) {
        demi_text text;
        double time = 0;
        line = (char *)memchr(data + keep, '\n', size - keep);
        if (!line) break;
        text = demi_text_make(w, call, path, data + keep, (size_t)(line - data) - keep);
        text.word = data + keep;
        text.length = strcspn(data + keep, ",\n");
        if (demi_text_number(&text, &time) != DEM_OK || !(time < from)) break;
    }
    if (keep < size) {
        result = demi_out_open(&out, w, call, path);
        if (result == DEM_OK) {
            fwrite(data, 1, keep, out.file);
            result = demi_out_close(&out);
        }
    }
    demi_free(w, data);
    return result;
}
/* Appends a line to a CSV file. The first line of a run replaces all lines of an older file. The
   first line after a checkpoint was read follows the last line that the checkpoint records. */
static dem_result demi_output_line(dem_world *w, const demi_output *o, const char *path) {
    const dem_output_desc *d = &o->desc;
    double value[DEM_OUTPUT_COLUMNS];
    char heading[DEMI_CSV_LINE], line[DEMI_CSV_LINE];
    int count = DEMI_LOADS;
    dem_result result = DEM_OK;
    demi_output_heading(d, heading);
    memset(value, 0, sizeof value);
    if (d->wall.id && !demi_wall_there(w, d->wall))
        return demi_refuse(w, "dem_world_step", "output %d writes the loads of wall %d, which was "
                           "removed; remove the output too (dem_output_remove)", (int)o->id,
                           (int)d->wall.id);
    if (d->wall.id) result = demi_loads_values(w, "dem_world_step", d->wall, value);
    else if (d->outlet.id) {
        count = DEMI_OUTLET;
        result = demi_outlet_values(w, d->outlet, value);
    } else if (demi_output_mixes(d)) {
        count = DEMI_MIXING;
        result = demi_mixing_values(w, &d->mixing, value);
    } else {
        count = demi_names(demi_output_names(d), DEM_OUTPUT_COLUMNS);
        if (d->values) DEMI_USER(w, "an output of values", 0, d->values(w, value, d->user))
        else {
            const dem_counters c = dem_counters_get(w);
            const dem_totals t = dem_totals_get(w);
            value[0] = (double)c.steps;
            value[1] = w->bodies.count;
            value[2] = c.contacts + c.wall_contacts;
            value[3] = t.kinetic;
            value[4] = t.rotational;
            value[5] = (double)c.overlap_max;
        }
    }
    if (result != DEM_OK) return result;
    if (o->resumes) result = demi_csv_resume(w, path, heading, o->written.last +
                                             (double)w->clock.dt/2);
    if (result != DEM_OK) return result;
    demi_csv_line(line, w->clock.time, value, count);
    return demi_csv_append(w, "dem_world_step", path, heading, line);
}
/* Writes walls. If z0 and z1 are equal, profiles are extruded over the depth of the discs or the
   domain, or else over that of the bodies. */
static dem_result demi_output_walls(dem_world *w, const dem_output_desc *d, const char *path) {
    dem_real z0 = d->z0, z1 = d->z1;
    int i;
    if (!(z0 < z1)) {
        z0 = w->desc.planar ? -w->desc.thickness/2 : w->desc.domain.lo.z;
        z1 = w->desc.planar ? w->desc.thickness/2 : w->desc.domain.hi.z;
    }
    if (!(z0 < z1)) {
        z0 = (dem_real)DEMI_FARTHEST;
        z1 = -z0;
        for (i = 0; i < w->bodies.count; i++) {
            z0 = DEMI_MIN(z0, w->bodies.pos[4*i + 2] - demi_radius(w, i));
            z1 = DEMI_MAX(z1, w->bodies.pos[4*i + 2] + demi_radius(w, i));
        }
    }
    return dem_walls_vtp_write(w, path, z0 < z1 ? z0 : 0, z0 < z1 ? z1 : 1);
}
/* The function that writes a file of each kind, in the order of dem_output_kind. 0 for the kinds
   that demi_output_write handles itself. */
static dem_result (*const demi_output_writers[])(dem_world *w, const char *path) = {
    0, dem_vtp_write, dem_xyz_write, dem_contacts_vtp_write, dem_checkpoint_write, 0,
    dem_surfaces_vtp_write, 0, dem_bodies_csv_write, dem_contacts_csv_write, 0};
enum { DEMI_OUTPUTS = (int)(sizeof demi_output_writers/sizeof *demi_output_writers) };
/* Writes output `number` of the present state, or calls the output's function. `o` must point to a
   copy, because that function may add outputs and so move the array. */
static dem_result demi_output_write(dem_world *w, const demi_output *o, int64_t number) {
    const dem_output_desc *d = &o->desc;
    size_t length = d->path ? strlen(d->path) : 0, marks = 0, at = 0;
    char digits[24], *path;
    dem_result result = DEM_OK;
    if (d->kind == DEM_OUTPUT_CALL) {
        int stop;
        DEMI_USER_FREE(w, stop = d->function(w, number, d->user))
        if (stop)
            result = demi_fail(w, DEM_ERROR_STOPPED, "dem_world_step: stopped by the function of "
                               "an output at %g s", w->clock.time);
        return result;
    }
    path = (char *)demi_alloc(w, length + sizeof digits, 1);
    if (!path) return demi_no_memory(w, "dem_world_step");
    at = demi_output_marks(d->path, &marks);
    sprintf(digits, "%0*lld", (int)DEMI_MIN(marks, 18), (long long)number);
    sprintf(path, "%.*s%s%s", (int)at, d->path, marks ? digits : "", d->path + at + marks);
    result = d->kind == DEM_OUTPUT_CSV ? demi_output_line(w, o, path)
        : d->kind == DEM_OUTPUT_WALLS ? demi_output_walls(w, d, path)
        : d->kind == DEM_OUTPUT_FIELD_CSV ? dem_field_csv_write(w, d->field, path)
        : demi_output_writers[d->kind](w, path);
    demi_free(w, path);
    return result;
}
/* Returns the index of the first output whose id is at least `id`, or the number of outputs. */
static int demi_output_place(const dem_world *w, int32_t id) {
    int i;
    for (i = 0; i < w->look.output_count && w->look.outputs[i].id < id; i++) {}
    return i;
}
/* Writes every output that is due at this step. An output that fails stops the run, and the next
   run tries it again. An output is recorded as written before it writes, so that a checkpoint
   contains the record of its own output. If the function of an output reads a checkpoint, the loop
   starts again with the time and the records of that checkpoint. */
static dem_result demi_outputs_look(dem_world *w) {
    int i;
    for (i = 0; i < w->look.output_count; i++) {
        const double now = w->clock.time, half = (double)w->clock.dt/2;
        const demi_output o = w->look.outputs[i];
        const dem_output_desc *d = &o.desc;
        const int reads = w->look.reads;
        demi_written *written = &w->look.outputs[i].written;
        dem_result result = DEM_OK;
        double number = (double)written->next;
        if (written->next == DEMI_OUTPUT_UNKNOWN)
            number = DEMI_MAX(ceil((now - half - d->start)/d->interval), 0);
        if (number < DEMI_OUTPUT_MOST) written->next = (int64_t)number;
        if (now + half < d->start + number*d->interval ||
            (d->end > 0 && now - half > d->end)) continue;
        number = DEMI_MAX(floor((now + half - d->start)/d->interval), number);
        if (!(number < DEMI_OUTPUT_MOST))
            return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_step: output %d would get number %g "
                             "at %g s, must be below %g, because its interval is %g s; give a "
                             "longer interval, or an end", (int)o.id, number, now, DEMI_OUTPUT_MOST,
                             d->interval);
        demi_finish(w);
        written->next = (int64_t)number + 1;
        written->last = now;
        result = demi_output_write(w, &o, (int64_t)number);
        if (reads != w->look.reads) {
            if (result != DEM_OK) return result;
            i = -1;
            continue;
        }
        i = demi_output_place(w, o.id);         /* its function may have removed outputs */
        if (i == w->look.output_count || w->look.outputs[i].id != o.id) i--;
        else if (result == DEM_OK) w->look.outputs[i].resumes = 0;
        else w->look.outputs[i].written = o.written;
        if (result != DEM_OK) return result;
    }
    return DEM_OK;
}
/* Resets the record of an output: nothing has been written yet. */
static void demi_output_begin(demi_output *o) {
    const dem_output_desc *d = &o->desc;
    const int kind = (int)d->kind;
    const double when[] = {d->start, d->interval};
    o->written.what = demi_hash(demi_hash(DEMI_HASH_START, &kind, sizeof kind), d->path,
                                d->path ? strlen(d->path) : 0);
    o->written.when = demi_hash(DEMI_HASH_START, when, sizeof when);
    o->written.next = DEMI_OUTPUT_UNKNOWN;
    o->written.last = -1e300;
    o->resumes = 1;
}
/* Called after a checkpoint was read. Each output continues the record in the checkpoint that has
   the same kind, path, start and interval. If there is none, it continues a record of the same kind
   and path, and its own start and interval determine when it writes next. */
static void demi_outputs_again(dem_world *w) {
    const double now = w->clock.time, half = (double)w->clock.dt/2;
    int i, k, pass;
    w->look.reads++;
    for (i = 0; i < w->look.output_count; i++) demi_output_begin(&w->look.outputs[i]);
    for (pass = 0; pass < 2; pass++)
        for (i = 0; i < w->look.output_count; i++) {
            demi_output *o = &w->look.outputs[i];
            for (k = 0; k < w->written_count && o->resumes == 1; k++) {
                demi_written *there = &w->written[k];
                if (there->what != o->written.what ||
                    (!pass && there->when != o->written.when)) continue;
                there->what = 0;                /* continued by one output only */
                o->resumes = 2;
                o->written.last = there->last;
                if (!pass) o->written.next = there->next;
                else if (there->last >= now - half && now >= o->desc.start - half)
                    o->written.next = (int64_t)DEMI_MIN(floor((now + half - o->desc.start)/
                        o->desc.interval) + 1, DEMI_OUTPUT_MOST);
            }
        }
}
/* Returns the part of an error message that says what is wrong with a desc; null: nothing is. */
static const char *demi_output_bad(const dem_world *w, const dem_output_desc *d) {
    if ((int)d->kind < 0 || (int)d->kind >= DEMI_OUTPUTS)
        return "kind is unknown, must be a DEM_OUTPUT_ value; start from DEM_OUTPUT_DESC";
    if (!demi_finite_double(d->interval) || !demi_finite_double(d->start) ||
        !demi_finite_double(d->end) || d->interval < DEMI_OUTPUT_LEAST || d->end < 0 ||
        fmax(d->interval, fmax(fabs(d->start), d->end)) > DEMI_FARTHEST)
        return "interval must be 1e-12 to 1e15 s, start within 1e15 s of 0, end 0 to 1e15 s; was "
            "a unit other than seconds meant?";
    if (fabs(w->clock.time - d->start)/d->interval >= DEMI_OUTPUT_MOST)
        return "start is more than 9e15 intervals from now; give a longer interval";
    if (d->kind == DEM_OUTPUT_CALL)
        return d->function ? 0 : "kind is DEM_OUTPUT_CALL, but function is null; give a function";
    if (!d->path || !*d->path) return "path is null or empty; give a file name, with #### in it "
        "if each output goes to a separate file";
    if (d->kind == DEM_OUTPUT_WALLS && !(d->z1 >= d->z0))
        return "z1 is below z0 or not a number; give z0 < z1 (m), between which profiles are "
            "extruded, or leave both 0 for the depth of the scene";
    if (d->kind == DEM_OUTPUT_FIELD_CSV && (d->field.id < 1 || d->field.id > w->field_count))
        return "field does not exist; give an id that dem_field_add returned";
    if (d->kind != DEM_OUTPUT_CSV) return 0;
    if (strchr(d->path, '#')) return "path of a CSV file has a #, but all its lines go to one "
        "file; leave the # out";
    if (!d->columns != !d->values)
        return "only one of columns and values is given; give both, or neither for the default "
            "columns";
    if ((d->wall.id != 0) + (d->outlet.id != 0) + (d->values != 0) + demi_output_mixes(d) > 1)
        return "more than one of wall, outlet, mixing and values is given; give only one of them";
    if (d->outlet.id < 0 || d->outlet.id > w->outlet_count)
        return "outlet does not exist; give an id that dem_outlet_add returned";
    if (d->wall.id && !demi_wall_there(w, d->wall)) return "wall does not "
        "exist; give an id that adding a wall returned";
    if (demi_names(demi_output_names(d), DEM_OUTPUT_COLUMNS) < 1) return "columns must be 1 to 32 "
        "words of at most 23 letters, digits and _, separated by one space";
    return 0;
}
DEM_API dem_output dem_output_add(dem_world *w, const dem_output_desc *desc) {
    dem_output id;
    demi_output *o;
    const char *bad;
    char *path = 0, *columns = 0;
    id.id = 0;
    if (demi_null(w, __func__, desc, "desc")) return id;
    if (desc->kind == DEM_OUTPUT_CSV && demi_output_mixes(desc) &&
        demi_mixing_check(w, __func__, &desc->mixing) != DEM_OK) return id;
    bad = demi_output_bad(w, desc);
    if (bad) {
        demi_refuse(w, __func__, "%s", bad);
        return id;
    }
    if (desc->path) path = demi_text_copy(w, desc->path);
    if (desc->columns) columns = demi_text_copy(w, desc->columns);
    if ((desc->path && !path) || (desc->columns && !columns) ||
        !demi_grow(w, DEMI_SCENE, &w->look.outputs, sizeof *w->look.outputs,
                   (size_t)w->look.output_count + 1)) {
        demi_free(w, path);
        demi_free(w, columns);
        demi_no_memory(w, __func__);
        return id;
    }
    o = &w->look.outputs[w->look.output_count++];
    memset(o, 0, sizeof *o);
    o->desc = *desc;
    o->desc.path = path;
    o->desc.columns = columns;
    id.id = o->id = ++w->look.output_last;
    demi_output_begin(o);
    w->look.outputs_look = demi_outputs_look;
    w->look.outputs_again = demi_outputs_again;
    demi_built(w, __func__);
    return id;
}
DEM_API dem_result dem_output_remove(dem_world *w, dem_output output) {
    demi_output *o;
    int i;
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    i = demi_output_place(w, output.id);
    if (i == w->look.output_count || w->look.outputs[i].id != output.id)
        return demi_refuse(w, __func__, "output %d does not exist; it was removed before or is of "
                           "another world: give what dem_output_add returned", (int)output.id);
    o = w->look.outputs + i;
    demi_free(w, (char *)o->desc.path);
    demi_free(w, (char *)o->desc.columns);
    w->look.output_count--;
    memmove(o, o + 1, (size_t)(w->look.output_count - i)*sizeof *o);
    return DEM_OK;
}
DEM_API dem_output dem_output_every_add(dem_world *w, dem_output_kind kind, const char *path,
                                        double interval) {
    dem_output_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.kind = kind;
    desc.path = path;
    desc.interval = interval;
    return dem_output_add(w, &desc);
}
