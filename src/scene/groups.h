/* ---------------------------------------------------------------------------------------------
   >>groups
   Named sets of bodies (desc.groups) and selections of bodies by group, material, shape, size,
   region or list. Each body carries one bit for each group in bodies.groups, an array like the
   others: it is sorted, saved, restored and sent to slabs with the body, and ends with it. A body
   that is added later belongs to no group. Owns bodies.groups.
   --------------------------------------------------------------------------------------------- */

/* Returns the index of a group in desc.groups, -1 if there is none of this name. */
static int demi_group_find(const dem_world *w, const char *name) {
    const char *at;
    int k, n;
    for (k = 0; name && (at = demi_name(w->desc.groups, k, &n)) != 0; k++)
        if (strlen(name) == (size_t)n && !strncmp(at, name, (size_t)n)) return k;
    return -1;
}
DEM_API dem_group dem_group_get(const dem_world *w, const char *name) {
    dem_group id;
    id.id = 0;
    if (demi_null_look(w, __func__, name, "name")) return id;
    id.id = 1 + demi_group_find(w, name);
    if (!id.id)
        demi_refuse(w, __func__, "there is no group \"%.60s\"; desc.groups names \"%.200s\": add "
                    "the name there, or correct it", name, w->desc.groups ? w->desc.groups : "");
    return id;
}
/* True if body i is in the group, or if its id is 0. */
DEM_INLINE int demi_in_group(const dem_world *w, dem_group group, int i) {
    return !group.id || (w->bodies.groups[i] >> (group.id - 1) & 1);
}
/* Fails if an id is neither 0, unless `required`, nor that of a group. */
static dem_result demi_group_check(dem_world *w, const char *call, dem_group group, int required) {
    if (group.id >= !!required && group.id <= w->bodies.group_count) return DEM_OK;
    return demi_refuse(w, call, "group %d does not exist, desc.groups names %d; take the id from "
                       "dem_group_get", (int)group.id, w->bodies.group_count);
}
/* True if x is in the region, on a periodic axis with any of its images. */
static int demi_region_holds(const dem_world *w, const demi_periods *p, const dem_region *region,
                             const demi_region *g, dem_vec3 x, dem_real radius) {
    const dem_vec3 lo = region->box.lo, hi = region->box.hi;
    x = demi_v(demi_into(x.x, lo.x, p->period[0]), demi_into(x.y, lo.y, p->period[1]),
               demi_into(x.z, lo.z, p->period[2]));
    return x.x >= lo.x && x.x <= hi.x && x.y >= lo.y && x.y <= hi.y &&
        (w->desc.planar || (x.z >= lo.z && x.z <= hi.z)) && demi_region_has(g, x, radius);
}
/* Fails if a selection names what does not exist, or its region has no extent. */
static dem_result demi_selection_check(dem_world *w, const char *call, const dem_selection *s,
                                       demi_region *g) {
    int k;
    if (demi_group_check(w, call, s->group, 0) != DEM_OK ||
        (s->material.id && demi_material_index(w, call, s->material, &k) != DEM_OK) ||
        (s->shape.id && demi_shape_index(w, call, s->shape) < 0)) return DEM_ERROR_ARGUMENT;
    if (!(s->radius_min >= 0) || !(s->radius_max >= 0) || s->count < 0 || (s->count && !s->bodies))
        return demi_refuse(w, call, "the selection has radii from %g to %g m and %d bodies%s; "
                           "radii and count must be >= 0, and a count needs the array",
                           (double)s->radius_min, (double)s->radius_max, s->count,
                           s->count && !s->bodies ? " in a null array" : "");
    if (!s->region) return DEM_OK;
    return demi_region_check(w, call, s->region, 0, g) ? DEM_OK : DEM_ERROR_ARGUMENT;
}
/* Returns an array with 1 for each selected body, by index, and sets *count to their number. Null
   with an error message if the selection is wrong or memory ran out. The caller frees it. */
static unsigned char *demi_select(dem_world *w, const char *call, const dem_selection *s,
                                  int *count) {
    const demi_periods p = demi_periods_of(w);
    unsigned char *marks;
    demi_region g;
    int i;
    *count = 0;
    if (w->look.calling.who && w->look.calling.within) {
        demi_refuse(w, call, "called from a function that %s calls within a step, possibly on "
                    "several threads, and a selection needs memory of the world; make this call "
                    "between two steps, for example in an output of kind DEM_OUTPUT_CALL",
                    w->look.calling.who);
        return 0;
    }
    if (demi_selection_check(w, call, s, &g) != DEM_OK) return 0;
    marks = (unsigned char *)demi_alloc(w, (size_t)w->bodies.count + 1, 1);
    if (!marks) { demi_no_memory(w, call); return 0; }
    memset(marks, !s->bodies, (size_t)w->bodies.count + 1);
    for (i = 0; i < s->count; i++) {            /* bodies that have gone do not count */
        const dem_body b = s->bodies[i];
        if (b.slot < 1 || b.slot > (uint32_t)w->bodies.slot_count ||
            w->bodies.slot_generation[b.slot - 1] != b.generation ||
            w->bodies.slot_index[b.slot - 1] < 0) continue;
        marks[w->bodies.slot_index[b.slot - 1]] = 1;
    }
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real r = demi_radius(w, i);
        marks[i] = marks[i] && demi_in_group(w, s->group, i) &&
            (!s->material.id || w->bodies.material[i] == s->material.id) &&
            (!s->shape.id || (w->bodies.orienting && w->bodies.shape[i] == s->shape.id)) &&
            r >= s->radius_min && (!(s->radius_max > 0) || r <= s->radius_max) &&
            (!s->region || demi_region_holds(w, &p, s->region, &g, demi_at(w->bodies.pos + 4*i),
                                             r));
        *count += marks[i];
    }
    return marks;
}
DEM_API int dem_bodies_select(const dem_world *world, const dem_selection *s, dem_body *out,
                              int capacity) {
    if (demi_null_look(world, __func__, s, "selection")) return -1;
    dem_world *w = (dem_world *)world;          /* only the error message is written */
    int count, slot, n = 0;
    unsigned char *marks = demi_select(w, __func__, s, &count);
    if (!marks) return -1;
    for (slot = 0; slot < w->bodies.slot_count && out && n < capacity; slot++) {
        const int i = w->bodies.slot_index[slot];
        if (i >= 0 && marks[i]) out[n++] = dem_body_id_get(w, i);
    }
    demi_free(w, marks);
    return count;
}
DEM_API int dem_bodies_group_set(dem_world *w, const dem_selection *s, dem_group group,
                                 int member) {
    if (demi_null(w, __func__, s, "selection")) return -1;
    int count, i;
    unsigned char *marks = demi_group_check(w, __func__, group, 1) == DEM_OK
        ? demi_select(w, __func__, s, &count) : 0;
    if (!marks) return -1;
    for (i = 0; i < w->bodies.count; i++) {
        const uint32_t bit = (uint32_t)1 << (group.id - 1);
        if (marks[i])
            w->bodies.groups[i] = member ? w->bodies.groups[i] | bit : w->bodies.groups[i] & ~bit;
    }
    demi_free(w, marks);
    return count;
}
/* Sets velocity and spin of the selected bodies or, if `velocity` is null, whether they are fixed.
   In the order of slots, so that sums do not depend on the order of bodies. */
static int demi_selected_set(dem_world *w, const char *call, const dem_selection *s,
                             const dem_vec3 *velocity, dem_vec3 spin, int fixed) {
    int count, slot;
    unsigned char *marks = demi_select(w, call, s, &count);
    if (!marks) return -1;
    for (slot = 0; slot < w->bodies.slot_count; slot++) {
        const int i = w->bodies.slot_index[slot];
        dem_body_state state;
        if (i < 0 || !marks[i] || dem_body_get(w, dem_body_id_get(w, i), &state) != DEM_OK)
            continue;
        if (velocity) { state.velocity = *velocity; state.spin = spin; }
        else state.fixed = fixed;
        if (dem_body_set(w, dem_body_id_get(w, i), &state) != DEM_OK) count = -1;
        if (count < 0) break;
    }
    demi_free(w, marks);
    return count;
}
DEM_API int dem_bodies_velocity_set(dem_world *w, const dem_selection *s, dem_vec3 velocity,
                                    dem_vec3 spin) {
    if (demi_null(w, __func__, s, "selection")) return -1;
    if (!demi_place(velocity) || !demi_place(spin)) {
        demi_refuse(w, __func__, "velocity or spin is not finite, or beyond %g "
                    "m/s or rad/s; check what it was computed from", DEMI_FARTHEST);
        return -1;
    }
    return demi_selected_set(w, __func__, s, &velocity, spin, 0);
}
DEM_API int dem_bodies_fixed_set(dem_world *w, const dem_selection *s, int fixed) {
    if (demi_null(w, __func__, s, "selection")) return -1;
    return demi_selected_set(w, __func__, s, 0, demi_v(0, 0, 0), fixed);
}
DEM_API int dem_bodies_remove(dem_world *w, const dem_selection *s) {
    if (demi_null(w, __func__, s, "selection")) return -1;
    int count, i;
    unsigned char *marks = demi_select(w, __func__, s, &count);
    if (!marks) return -1;
    if (count && !demi_list_drop(w)) {
        demi_no_memory(w, __func__);
        count = -1;
    }
    /* backwards: the last body, which takes the index, has been looked at */
    for (i = w->bodies.count - 1; i >= 0 && count > 0; i--)
        if (marks[i]) demi_body_lose(w, i, &w->bodies.balance.removed);
    demi_free(w, marks);
    if (count > 0) demi_scene_changed(w);
    return count;
}
DEM_API dem_result dem_bodies_means_get(const dem_world *world, const dem_selection *s,
                                        dem_bodies_means *out) {
    if (demi_null_look(world, __func__, s, "selection") ||
        demi_null_look(world, __func__, out, "out")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;          /* only the error message is written */
    const demi_periods p = demi_periods_of(w);
    int count, slot, k;
    unsigned char *marks = demi_select(w, __func__, s, &count);
    if (!marks) return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    for (slot = 0; slot < w->bodies.slot_count; slot++) {
        const int i = w->bodies.slot_index[slot];
        const double m = i < 0 ? 0 : (double)w->bodies.mass[i];
        dem_real x[3];
        double v2 = 0;
        if (i < 0 || !marks[i]) continue;
        demi_put(x, demi_place_of(&p, demi_at(w->bodies.pos + 4*i)));
        out->mass += m;
        out->radius += (double)demi_radius(w, i);
        for (k = 0; k < 3; k++) {
            const double v = (double)w->bodies.vel[4*i + k];
            out->centre[k] += m*(double)x[k];
            out->velocity[k] += m*v;
            out->spin[k] += (double)w->bodies.spin[4*i + k];
            out->force[k] += (double)w->bodies.force[4*i + k];
            v2 += v*v;
        }
        out->kinetic += m*v2/2;
        out->rotational += (double)demi_dot(demi_angular_of(w, i), demi_at(w->bodies.spin + 4*i))/2;
    }
    for (k = 0; k < 3 && count; k++) {
        out->centre[k] /= out->mass;
        out->velocity[k] /= out->mass;
        out->spin[k] /= count;
    }
    if (count) out->radius /= count;
    out->bodies = count;
    demi_free(w, marks);
    return DEM_OK;
}
