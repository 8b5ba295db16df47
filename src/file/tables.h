/* ---------------------------------------------------------------------------------------------
   >>tables
   Tables of the present state and of averages, as CSV: a line of names and one line per item.
   demi_out (>>write) makes the files complete or absent. Reads the world and does not change its
   state, except that dem_contacts_each computes forces if the scene has changed.
   --------------------------------------------------------------------------------------------- */
/* Writes numbers, each after a comma unless it is the first of a line; a whole number. */
static void demi_table_put(demi_out *o, int first, const double *value, int count) {
    char text[32];
    int k;
    for (k = 0; k < count; k++)
        fprintf(o->file, "%s%s", first && !k ? "" : ",", demi_format_cell(text, value[k]));
}
static void demi_table_vec(demi_out *o, dem_vec3 v) {
    const double value[3] = {(double)v.x, (double)v.y, (double)v.z};
    demi_table_put(o, 0, value, 3);
}
DEM_API dem_result dem_bodies_csv_write(dem_world *world, const char *path) {
    const dem_world *w = world;
    demi_periods p;
    demi_out o;
    dem_result result;
    int i, k, length;
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    result = demi_out_open(&o, world, __func__, path);
    if (result != DEM_OK) return result;
    p = demi_periods_of(w);
    demi_finish(world);
    fputs("id,material,radius,x,y,z,vx,vy,vz,wx,wy,wz", o.file);
    for (k = 0; k < w->bodies.real_count; k++) {
        const char *name = demi_name(w->desc.body_reals, k, &length);
        fprintf(o.file, ",%.*s", length, name);
    }
    if (w->bodies.averaged)
        fputs(",samples,vx_mean,vy_mean,vz_mean,vx_variance,vy_variance,vz_variance,wx_mean,"
              "wy_mean,wz_mean,wx_variance,wy_variance,wz_variance,fx_mean,fy_mean,fz_mean,"
              "fx_variance,fy_variance,fz_variance", o.file);
    fputc('\n', o.file);
    for (i = 0; i < w->bodies.count; i++) {
        const double radius = (double)demi_radius(w, i);
        dem_body_means m;
        fprintf(o.file, "%u,%d", (unsigned)w->bodies.slot[i], (int)w->bodies.material[i]);
        demi_table_put(&o, 0, &radius, 1);
        demi_table_vec(&o, demi_place_of(&p, demi_at(w->bodies.pos + 4*i)));
        demi_table_vec(&o, demi_at(w->bodies.vel + 4*i));
        demi_table_vec(&o, demi_at(w->bodies.spin + 4*i));
        for (k = 0; k < w->bodies.real_count; k++) {
            const double own = (double)w->bodies.reals[w->bodies.real_count*i + k];
            demi_table_put(&o, 0, &own, 1);
        }
        if (w->bodies.averaged && dem_body_means_get(w, dem_body_id_get(w, i), &m) == DEM_OK) {
            fprintf(o.file, ",%.0f", (double)m.samples);
            demi_table_put(&o, 0, m.velocity, 3);
            demi_table_put(&o, 0, m.velocity_variance, 3);
            demi_table_put(&o, 0, m.spin, 3);
            demi_table_put(&o, 0, m.spin_variance, 3);
            demi_table_put(&o, 0, m.force, 3);
            demi_table_put(&o, 0, m.force_variance, 3);
        }
        fputc('\n', o.file);
    }
    return demi_out_close(&o);
}
static void demi_table_contact(const dem_contact_info *c, dem_real *memory, void *user) {
    demi_out *o = (demi_out *)user;
    const double overlap = (double)c->overlap;
    (void)memory;
    fprintf(o->file, "%ld,%ld,%d", (long)c->a.slot - 1, c->wall ? -1L : (long)c->b.slot - 1,
            (int)c->wall);
    demi_table_vec(o, c->point);
    demi_table_vec(o, c->normal);
    demi_table_put(o, 0, &overlap, 1);
    demi_table_vec(o, c->force);
    fputc('\n', o->file);
}
DEM_API dem_result dem_contacts_csv_write(dem_world *world, const char *path) {
    demi_out o;
    dem_result result;
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    result = demi_contacts_settle(world, __func__);
    if (result == DEM_OK) result = demi_out_open(&o, world, __func__, path);
    if (result != DEM_OK) return result;
    fputs("a,b,wall,x,y,z,nx,ny,nz,overlap,fx,fy,fz\n", o.file);
    demi_contacts_visit(world, __func__, demi_table_contact, &o);
    return demi_out_close(&o);
}
DEM_API dem_result dem_field_csv_write(dem_world *world, dem_field field, const char *path) {
    const demi_field *f;
    demi_grid g;
    demi_out o;
    dem_result result;
    int at[3];
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    f = demi_field_find(world, __func__, field);
    if (!f) return DEM_ERROR_ARGUMENT;
    result = demi_out_open(&o, world, __func__, path);
    if (result != DEM_OK) return result;
    g = demi_grid_of(world, (demi_field *)f);
    fprintf(o.file, "x,y,z,grains,solid,density,vx,vy,vz%s%s\n", f->desc.stress ?
            ",temperature,pxx,pyy,pzz,pxy,pxz,pyz,coordination" : "", f->desc.variance ?
            ",grains_variance,solid_variance,density_variance,vx_variance,vy_variance,vz_variance"
            : "");
    for (at[2] = 0; at[2] < f->desc.cells[2]; at[2]++)
        for (at[1] = 0; at[1] < f->desc.cells[1]; at[1]++)
            for (at[0] = 0; at[0] < f->desc.cells[0]; at[0]++) {
                dem_field_cell c;
                double x[3];
                int k;
                dem_field_cell_get(world, field, at[0], at[1], at[2], &c);
                for (k = 0; k < 3; k++) x[k] = g.lo[k] + (at[k] + 0.5)*g.size[k];
                demi_table_put(&o, 1, x, 3);
                demi_table_put(&o, 0, &c.grains, 1);
                demi_table_put(&o, 0, &c.solid, 1);
                demi_table_put(&o, 0, &c.density, 1);
                demi_table_put(&o, 0, c.velocity, 3);
                if (f->desc.stress) {
                    demi_table_put(&o, 0, &c.temperature, 1);
                    demi_table_put(&o, 0, c.stress, 6);
                    demi_table_put(&o, 0, &c.coordination, 1);
                }
                if (f->desc.variance) {
                    demi_table_put(&o, 0, &c.grains_variance, 1);
                    demi_table_put(&o, 0, &c.solid_variance, 1);
                    demi_table_put(&o, 0, &c.density_variance, 1);
                    demi_table_put(&o, 0, c.velocity_variance, 3);
                }
                fputc('\n', o.file);
            }
    return demi_out_close(&o);
}
DEM_API dem_result dem_outlet_residence_csv_write(dem_world *world, dem_outlet outlet,
                                                  const char *path) {
    const demi_outlet *from;
    demi_out o;
    dem_result result;
    double sum = 0, total = 0;
    int k, used = 0;
    if (demi_null_write(world, __func__, world, "world")) return DEM_ERROR_ARGUMENT;
    from = demi_outlet_find(world, __func__, outlet);
    if (!from) return DEM_ERROR_ARGUMENT;
    if (!(from->desc.residence_bin > 0))
        return demi_refuse(world, __func__, "outlet %d has residence_bin 0 s, must be > 0 to "
                           "measure residence times; set it in its desc", (int)outlet.id);
    result = demi_out_open(&o, world, __func__, path);
    if (result != DEM_OK) return result;
    for (k = 0; k < DEM_RESIDENCE_BINS; k++) {
        total += (double)from->state.residence_count[k];
        if (from->state.residence_count[k]) used = k + 1;
    }
    fputs("time,grains,density,cumulated\n", o.file);
    for (k = 0; k < used; k++) {
        const double n = (double)from->state.residence_count[k], bin = from->desc.residence_bin;
        double value[4];
        sum += n;
        value[0] = (k + 0.5)*bin;
        value[1] = n;
        value[2] = n/total/bin;
        value[3] = sum/total;
        demi_table_put(&o, 1, value, 4);
        fputc('\n', o.file);
    }
    return demi_out_close(&o);
}
DEM_API dem_result dem_impacts_csv_write(dem_world *w, const char *path) {
    demi_out out;
    dem_result result;
    double seconds;
    char number[5][40];
    int a, b, i, k;
    if (demi_null_write(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    result = demi_events_needed(w, __func__);
    if (result == DEM_OK) result = demi_out_open(&out, w, __func__, path);
    if (result != DEM_OK) return result;
    seconds = DEMI_MAX(w->clock.time - w->events.n.since, 1e-300);
    fprintf(out.file, "material_a,material_b,from,to,impacts,losses,power\n");
    for (a = 0; a < w->material_count; a++)
        for (b = a; b < w->material_count; b++)
            for (i = 0; i < w->events.n.pairs; i++) {
                const demi_impacts *p = &w->events.pairs[i];
                for (k = 0; k < DEM_IMPACT_BINS && p->a == a && p->b == b; k++) {
                    if (!(p->impacts[k] > 0) && !(p->losses[k] > 0)) continue;
                    fprintf(out.file, "%d,%d,%s,%s,%s,%s,%s\n", a + 1, b + 1,
                            demi_format_real(number[0], demi_impact_limit(k), 6),
                            demi_format_real(number[1], demi_impact_limit(k + 1), 6),
                            demi_format_real(number[2], p->impacts[k]/seconds, 9),
                            demi_format_real(number[3], p->losses[k]/seconds, 9),
                            demi_format_real(number[4], p->energy[k]/seconds, 9));
                }
            }
    return demi_out_close(&out);
}
