/* codes_services.h - functions that scenes pass to dem.h and that only take down what they see, and readers, which call
   everything that reads a world. What they see goes to note(), so that two runs can be compared by one number. A
   reader may call functions that fail: a failed call changes nothing either.

   Readers do not note what dem.h does not promise: wall time, memory, numbers of threads. */
#ifndef REL_CODES_SERVICES_H
#define REL_CODES_SERVICES_H

/* the file of a reader, which removes it */
static char scratch[80] = "build/tmp/relations.out";
CODE(note, static uint64_t noted; static void note(double x) {
    uint64_t u;
    memcpy(&u, &x, sizeof u);
    if (!(x <= 0 || x > 0)) u = 1;
    noted = (noted ^ u)*0x9e3779b97f4a7c15u;
    noted ^= noted >> 29;
} static void note_vec(dem_vec3 v) {
    note((double)v.x);
    note((double)v.y);
    note((double)v.z);
} static void note_all(const double *x, int count) {
    while (count-- > 0) note(*x++);
})
/* Notes the bytes of a file, or of all with numbers in place of ####, and removes them. Returns the number of bytes.
   The report of a replay, its last part, has wall times. The first number is not 0 if an output was added later. */
CODE(fold, static long fold(const char *path) {
    long bytes = 0;
    int k, i, c, missing = 0;
    for (k = 0; k < 10000 && missing < 200; k++) {
        const char *const last = "\"dem/report\"", *end = last;
        char name[200], *number;
        FILE *f;
        snprintf(name, sizeof name, "%s", path);
        number = strstr(name, "####");
        for (i = 3, c = k; number && i >= 0; i--, c /= 10) number[i] = (char)('0' + c%10);
        f = fopen(name, "rb");
        missing = f ? 0 : missing + 1;
        if (!f && !number) break;
        if (!f) continue;
        for (; *end && (c = fgetc(f)) != EOF; bytes++) {
            note(c);
            end = c == *end ? end + 1 : last;
        }
        fclose(f);
        remove(name);
        if (!number) break;
    }
    return bytes;
})
/* Writes a checkpoint and another one. Returns 0 if they differ. */
CODE(twice, static int twice(dem_world *w, const char *path) {
    char other[200];
    FILE *f;
    FILE *g;
    int c = 0, d = 0;
    snprintf(other, sizeof other, "%s2", path);
    if (dem_checkpoint_write(w, path) != DEM_OK || dem_checkpoint_write(w, other) != DEM_OK) return 1;
    f = fopen(path, "rb");
    g = fopen(other, "rb");
    while (f && g && c == d && c != EOF) {
        c = fgetc(f);
        d = fgetc(g);
    }
    if (f) fclose(f);
    if (g) fclose(g);
    remove(other);
    return c == d;
})
/* ---- calls of several functions ---- */
CODE(fill, static int fill(dem_world *w, dem_material m, int way, dem_real radius, dem_box box, int count) {
    dem_sizes s = DEM_SIZES;
    s.min = radius/2;
    s.max = radius;
    return way == 0 ? dem_spheres_fill(w, m, radius, dem_region_make(box), count, 5) :
        way == 1 ? dem_sizes_fill(w, m, &s, dem_region_make(box), count, 6) :
        dem_spheres_pack(w, m, radius, radius/10, dem_region_make(box), count);
})
CODE(rub, static dem_result rub(dem_world *w, dem_material m, dem_real friction) {
    dem_material_desc d;
    const dem_result result = dem_material_get(w, m, &d);
    d.friction = friction;
    if (d.friction_static < friction && d.friction_static > 0) d.friction_static = friction;
    return result == DEM_OK ? dem_material_set(w, m, &d) : result;
})
/* ---- walls and grains that were files ---- */
CODE(whole, static char content[1 << 18]; static size_t whole(const char *path) {
    FILE *f = fopen(path, "rb");
    const size_t n = f ? fread(content, 1, sizeof content, f) : 0;
    if (f) fclose(f);
    return n;
})
CODE(mesh_file, static dem_wall mesh_file(dem_world *w, dem_material m, int n, dem_real *x, int k, int32_t *t,
    int way) {
    dem_mesh a = {0, 0, 0, 0};
    dem_wall wall = {0};
    dem_wall_part part;
    dem_result read;
    FILE *f = fopen(scratch, "wb");
    int i;
    if (!f) return wall;
    for (i = 0; i < 3*n; i++) fprintf(f, "%s%.17g%s", i%3 ? " " : "v ", (double)x[i], i%3 == 2 ? "\n" : "");
    if (way > 1) fprintf(f, "g part\n");
    for (i = 0; i < 3*k; i++) fprintf(f, "%s%d%s", i%3 ? " " : "f ", 1 + t[i], i%3 == 2 ? "\n" : "");
    fclose(f);
    part.name = "part";
    part.material = m;
    part.motion = DEM_MOTION;
    if (way == 3) read = dem_wall_parts_add(w, scratch, 1, 1, &part, &wall);
    else if (way == 2) read = dem_mesh_part_read(w, scratch, "part", &a, 0);
    else if (way == 1) read = dem_mesh_parse(w, 0, content, whole(scratch), &a, 0);
    else read = dem_mesh_read(w, scratch, &a, 0);
    if (way < 3 && read == DEM_OK) read = dem_mesh_place(w, &a, 1, dem_quat_make(0, 0, 0, 0), dem_vec3_make(0, 0, 0));
    if (way < 3 && read == DEM_OK) wall = dem_wall_mesh_add(w, m, &a);
    dem_mesh_free(w, &a);
    remove(scratch);
    return wall;
})
CODE(profile_file, static dem_wall profile_file(dem_world *w, dem_material m, int n, dem_real *x, int k, int32_t *t,
    int way) {
    dem_profile a = {0, 0, 0, 0};
    dem_wall wall = {0};
    FILE *f = fopen(scratch, "wb");
    int i;
    if (!f) return wall;
    fprintf(f, "%d %d\n", n, k);
    for (i = 0; i < 2*n; i++) fprintf(f, "%.17g%s", (double)x[i], i%2 ? "\n" : " ");
    for (i = 0; i < 2*k; i++) fprintf(f, "%d%s", 1 + t[i], i%2 ? "\n" : " ");
    fclose(f);
    if ((way%2 ? dem_profile_parse(w, 0, content, whole(scratch), &a) : dem_profile_read(w, scratch, &a)) == DEM_OK)
        wall = dem_wall_profile_add(w, m, &a, DEM_EDGE_RESOLVED);
    dem_profile_free(w, &a);
    remove(scratch);
    return wall;
})
/* Writes the grains to a file and adds what it reads to a world of their own. Returns 0 if this has other grains: text
   has 9 digits, the other formats have floats. */
CODE(grains_back, static int grains_back(dem_world *w, int way) {
    const dem_world_desc plain = DEM_WORLD_DESC;
    const dem_bodies b = dem_bodies_get(w);
    dem_world *own = dem_world_create(&plain);
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_material m;
    dem_grains g;
    int i, k, same = 0;
    const dem_result wrote = way == 0 ? dem_bodies_csv_write(w, scratch) : way == 1 ? dem_xyz_write(w, scratch) :
        way == 2 ? dem_vtp_write(w, scratch) : dem_vtk_write(w, scratch);
    memset(&g, 0, sizeof g);
    if (!own || wrote != DEM_OK) puts(dem_world_error_get(w));
    stuff.density = 1000;
    stuff.young = (dem_real)1e6;
    stuff.restitution = (dem_real)0.5;
    m = dem_material_add(own, &stuff);
    if ((way == 1 ? dem_grains_parse(own, 0, content, whole(scratch), &g) : dem_grains_read(own, scratch,
        &g)) != DEM_OK)
        puts(dem_world_error_get(own));
    else {
        const double part = way < 2 ? 5e-9 : 1e-7;
        const dem_bodies c = dem_grains_add(own, m, &g) == DEM_OK ? dem_bodies_get(own) : b;
        same = g.count == b.count && (c.positions != b.positions || !b.count);
        for (i = 0; i < b.count && same; i++)
            for (k = 0; k < 4; k++) {
                const double x = (double)b.positions[4*i + k];
                const double y = (double)(k < 3 ? g.positions[3*i + k] : g.radii[i]);
                same &= fabs(x - y) <= part*(fabs(x) + 1e-30) && !(y < (double)c.positions[4*i + k]) &&
                    !(y > (double)c.positions[4*i + k]);
            }
        dem_grains_free(own, &g);
    }
    dem_world_destroy(own);
    remove(scratch);
    return same;
})
/* ---- laws that call the others of dem.h: 3 reals of rolling, 4 of sliding, 1 of twisting, 1 of the overlap ---- */
CODE(law_hysteretic, static void law_hysteretic(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_contact own = *c;                      /* kun is 0 with other normal laws (dem_contact.kun) */
    if (!(own.kun > 0)) own.kun = 2*own.kn;
    dem_law_hysteretic(&own, memory + 8, f);
    dem_law_viscous(c, memory, f);
    dem_law_roll_constant(c, memory, f);
    dem_law_twist(c, memory + 7, f);
})
CODE(law_mindlin, static void law_mindlin(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_mindlin(c, memory + 3, f);
    dem_law_roll_epsd(c, memory, f);
    dem_law_twist(c, memory + 7, f);
})
CODE(law_rescaled, static void law_rescaled(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_mindlin_rescaled(c, memory + 3, f);
    dem_law_roll_step(c, memory, f);
})
CODE(law_stepped, static void law_stepped(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_vec3 v = dem_memory_rotate(c, dem_vec3_make(memory[0], memory[1], memory[2]));
    dem_law_linear(c, memory, f);
    dem_law_load(c, f, 0);
    dem_law_step(c, memory, f);
    memory[0] = v.x + f->tangent.x;
    memory[1] = v.y + f->tangent.y;
    memory[2] = v.z + f->tangent.z;
})
/* ---- functions of events, outputs and replays ---- */
CODE(hear, static void hear(const dem_event *e, void *user) {
    (void)user;
    note(e->kind);
    note(e->a.slot);
    note(e->b.slot);
    note(e->wall);
    note_vec(e->point);
    note_all(&e->begin, 2);
    note_all(&e->closing_speed, 9);
})
CODE(beat, static int beat(dem_world *w, int64_t number, void *user) {
    (void)user;
    note((double)number);
    note(dem_world_time_get(w));
    note(dem_totals_get(w).kinetic);
    return 0;
})
CODE(two_values, static void two_values(const dem_world *w, double *values, void *user) {
    (void)user;
    values[0] = dem_totals_get(w).kinetic;
    values[1] = dem_temperature_get(w);
})
CODE(shade, static double shade(const dem_world *w, dem_body body, void *user) {
    dem_body_state s;
    (void)user;
    return dem_body_get(w, body, &s) == DEM_OK ? (double)s.velocity.x : 0;
})
/* ---- readers ---- */
CODE(read_world, static void read_world(dem_world *w) {
    const dem_world_desc d = dem_world_desc_get(w);
    const dem_totals t = dem_totals_get(w);
    const dem_body_counts n = dem_body_counts_get(w);
    note_vec(d.gravity);
    note((double)d.dt);
    note(dem_world_time_get(w));
    note((double)dem_world_steps_get(w));
    note((double)(dem_world_hash_get(w) >> 12));
    note_all(&t.mass, 12);
    note((double)(n.inserted + 3*n.present + 5*n.removed + 7*n.left));
    note(dem_temperature_get(w));
    note(*dem_result_name_get(DEM_ERROR_MEMORY));
    note(*dem_world_create_error_get(&d));
    note(dem_world_create_checked(&d, DEM_VERSION + 1, sizeof(dem_real)) != 0);
    note(*dem_checkpoint_changes_get(w));
})
CODE(read_counters, static void read_counters(dem_world *w) {
    const dem_counters c = dem_counters_get(w);
    const dem_ledger l = dem_ledger_get(w);
    note((double)c.steps);
    note(c.contacts);
    note(c.wall_contacts);
    note((double)c.overlap_max);
    note((double)c.speed_max);
    note((double)c.residual);
    note((double)c.unsolved);
    note_all(&l.kinetic, 16);
})
CODE(read_bodies, static void read_bodies(dem_world *w) {
    const dem_bodies b = dem_bodies_get(w);
    int i;
    for (i = 0; i < b.count; i++) {
        const dem_body id = dem_body_id_get(w, i);
        dem_body_state s;
        dem_body_means m;
        dem_rail_state r;
        dem_real reals[8] = {0};
        note(id.slot);
        if (dem_body_get(w, id, &s) != DEM_OK) continue;
        note_vec(s.position);
        note_vec(s.force);
        note_vec(s.torque);
        note((double)s.mass);
        if (dem_body_reals_get(w, id, reals) == DEM_OK) note((double)reals[0]);
        if (dem_body_reaction_get(w, id, &r) == DEM_OK) note(r.work);
        if (dem_body_means_get(w, id, &m) == DEM_OK) note_all(m.velocity, 18);
    }
})
CODE(read_groups, static int above(dem_vec3 centre, dem_real radius, void *user) {
    (void)user;
    return centre.z + radius > 0;
} static void read_groups(dem_world *w) {
    const dem_region all = dem_region_make(dem_box_make(-1, -1, -1, 1, 1, 1));
    const dem_region half = dem_region_inside_make(all.box, above, 0);
    dem_selection s = DEM_SELECTION;
    dem_bodies_means m;
    dem_body some[8];
    int k, i;
    for (k = 0; k < 3; k++) {
        const int n = dem_bodies_select(w, &s, some, 8);
        note(n);
        for (i = 0; i < n && i < 8; i++) note(some[i].slot);
        if (dem_bodies_means_get(w, &s, &m) == DEM_OK) note_all(&m.mass, 16);
        s.region = k ? &half : &all;
        if (k == 1) s.group = dem_group_get(w, "coarse");
    }
})
CODE(read_materials, static void read_materials(dem_world *w) {
    FILE *out = tmpfile();
    int32_t a;
    int32_t b;
    for (a = 1; a < 4; a++) {
        dem_material m;
        dem_material_desc d;
        m.id = a;
        if (dem_material_get(w, m, &d) == DEM_OK) note((double)d.young);
        for (b = 1; b < 4; b++) {
            dem_material n;
            dem_pair p;
            dem_coefficients c;
            n.id = b;
            if (dem_pair_get(w, m, n, &p) == DEM_OK) note((double)p.restitution);
            if (dem_coefficients_get(w, m, n, (dem_real)1e-3, 0, &c) == DEM_OK) note(b);
        }
    }
    if (out) {
        dem_pairs_print(w, out);
        fclose(out);
    }
})
CODE(read_shapes, static void read_shapes(dem_world *w) {
    dem_shape s;
    dem_shape_info info;
    for (s.id = 1; s.id < 20 && dem_shape_get(w, s, &info) == DEM_OK; s.id++) {
        note((double)info.volume);
        note_vec(info.centre);
    }
})
CODE(read_walls, static void read_walls(dem_world *w) {
    dem_wall wall;
    for (wall.id = 1; wall.id < 14; wall.id++) {
        dem_pose p;
        dem_wall_loads l;
        dem_vec3 v;
        dem_servo s;
        dem_real reals[8] = {0};
        if (dem_wall_pose_get(w, wall, &p) == DEM_OK) note_vec(p.position);
        if (dem_wall_loads_get(w, wall, &l) == DEM_OK) {
            note_vec(l.force);
            note_vec(l.torque);
            note(l.contacts);
            note_all(l.impulse, 6);
        }
        if (dem_wall_surface_velocity_get(w, wall, &v) == DEM_OK) note_vec(v);
        if (dem_wall_reals_get(w, wall, reals) == DEM_OK) note((double)reals[0]);
        if (dem_wall_servo_get(w, wall, &s) == DEM_OK) note_all(&s.target, 4);
        note(dem_sieve_blinded_get(w, wall, 0));
    }
})
CODE(read_machine, static void read_machine(dem_world *w) {
    int32_t k;
    for (k = 1; k < 6; k++) {
        dem_joint j;
        dem_feed f;
        dem_outlet o;
        dem_joint_state joint;
        dem_feed_state fed;
        dem_outlet_state out;
        j.id = f.id = o.id = k;
        if (dem_joint_get(w, j, &joint) == DEM_OK) {
            note_vec(joint.force);
            note_all(&joint.turned, 2);
        }
        if (dem_feed_get(w, f, &fed) == DEM_OK) {
            note((double)(fed.total + fed.waiting));
            note(fed.mass);
        }
        if (dem_outlet_get(w, o, &out) == DEM_OK) {
            note((double)(out.total + out.held_total));
            note_all(&out.since, 2);
        }
    }
})
CODE(read_contacts, static void see(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)memory;
    (void)user;
    note(c->a.slot + 3.0*c->b.slot + 5.0*c->wall);
    note_vec(c->point);
    note_vec(c->force);
} static void read_contacts(dem_world *w) {
    static dem_contact_info some[40];
    static uint32_t pairs[80];
    const int n = dem_contacts_get(w, some, 40);
    int i;
    for (i = 0; i < n && i < 40; i++) see(&some[i], 0, 0);
    note(dem_contacts_each(w, see, 0));
    note(dem_bonds_make(w, 0, see, 0));
    dem_candidates_get(w, pairs, 40);
})
CODE(read_events, static void hear_open(const dem_event *e, void *user) {
    (void)user;
    note(e->begin);
    note_all(&e->force, 6);
} static void read_events(dem_world *w) {
    dem_impacts *p = (dem_impacts *)calloc(1, sizeof *p);
    dem_material all;
    dem_wall wall;
    all.id = 0;
    note(dem_events_open_each(w, hear_open, 0));
    if (p && dem_impacts_get(w, all, all, p) == DEM_OK) {
        note_all(&p->ended, 1);
        note_all(&p->lost_normal, 4);
        note_all(p->impacts, 3*DEM_IMPACT_BINS);
    }
    free(p);
    for (wall.id = 1; wall.id < 4; wall.id++) {
        double work[40] = {0};
        dem_wear wear;
        const int n = dem_wall_wear_facets_get(w, wall, work, 40);
        note_all(work, n < 40 ? n : 40);
        if (dem_wall_wear_get(w, wall, 1e-4, 1e9, &wear) == DEM_OK) note_all(&wear.seconds, 4);
    }
    dem_impacts_csv_write(w, scratch);
    fold(scratch);
})
CODE(read_stress, static void read_stress(dem_world *w) {
    dem_stress s;
    dem_cell_state c;
    if (dem_stress_get(w, &s) == DEM_OK) note_all(&s.volume, 2);
    if (dem_cell_state_get(w, &c) == DEM_OK) note_all(c.strain, 11);
})
CODE(read_fields, static void read_fields(dem_world *w) {
    dem_field f;
    dem_field_data d;
    dem_field_cell c;
    int i;
    int j;
    for (f.id = 1; f.id < 4; f.id++) {
        if (dem_field_get(w, f, &d) != DEM_OK) continue;
        note((double)d.samples);
        for (i = 0; i < 2; i++)
            for (j = 0; j < 2; j++) if (dem_field_cell_get(w, f, i, j, 0, &c) == DEM_OK) note_all(&c.grains, 20);
        note(dem_field_csv_write(w, f, scratch));
        fold(scratch);
    }
})
CODE(read_mixing, static void read_mixing(dem_world *w) {
    dem_mixing_desc d = DEM_MIXING_DESC;
    dem_mixing m;
    dem_repose r;
    const dem_box none = dem_box_make(0, 0, 0, 0, 0, 0);
    d.box = dem_box_make((dem_real)-0.02, (dem_real)-0.02, (dem_real)-0.02, (dem_real)0.02, (dem_real)0.02,
        (dem_real)0.02);
    d.cells[0] = d.cells[1] = d.cells[2] = 8;
    d.material.id = 1;
    if (dem_mixing_get(w, &d, &m) == DEM_OK) note_all(&m.fraction, 10);
    if (dem_repose_heap_get(w, none, &r) == DEM_OK) note(r.angle);
    if (dem_repose_drum_get(w, none, dem_vec3_make(0, 1, 0), &r) == DEM_OK) note(r.angle);
    note(dem_observer_height(w, 0));
    note(dem_observer_kinetic(w, 0));
    note(dem_observer_contacts(w, 0));
    note(dem_observer_walls(w, 0));
})
CODE(read_checks, static void read_checks(dem_world *w) {
    static dem_finding found[8];
    FILE *out = tmpfile();
    dem_advice a;
    if (dem_step_advice_get(w, &a) == DEM_OK) note((double)a.dt);
    dem_world_check(w, found, 8);
    if (!out) return;
    dem_world_check_print(w, out);
    dem_world_report(w, out);
    dem_progress_print(w, 0.5, 1, out);
    fclose(out);
})
CODE(read_effects, static void read_effects(dem_world *w) {
    static dem_effect effects[DEM_EFFECTS];
    FILE *out = tmpfile();
    const int n = dem_effects_get(w, 0, effects);
    int i;
    for (i = 0; i < n; i++) note(effects[i].state);
    if (!out) return;
    dem_effects_print(w, 0, out);
    fclose(out);
})
CODE(read_costs, static void read_costs(dem_world *w) {
    static dem_effect effects[DEM_EFFECTS];
    dem_effects_get(w, 1e-3, effects);
})
CODE(read_trials, static void read_trials(dem_world *w) {
    static dem_trials trials;
    dem_trials_desc d = DEM_TRIALS_DESC;
    FILE *out = tmpfile();
    d.duration = 70*(double)dem_world_desc_get(w).dt;
    d.seeds = 0;
    d.budget = 1;
    if (dem_trials_run(w, &d, &trials) == DEM_OK && out) dem_trials_print(&trials, out);
    if (out) fclose(out);
})
CODE(read_grains, static void read_grains(dem_world *w) {
    note(dem_vtp_write(w, scratch));
    fold(scratch);
    note(dem_vtk_write(w, scratch));
    fold(scratch);
    note(dem_xyz_write(w, scratch));
    fold(scratch);
    note(dem_bodies_csv_write(w, scratch));
    fold(scratch);
})
CODE(read_surfaces, static void read_surfaces(dem_world *w) {
    dem_wall wall;
    dem_outlet outlet;
    note(dem_contacts_vtp_write(w, scratch));
    fold(scratch);
    note(dem_contacts_csv_write(w, scratch));
    fold(scratch);
    note(dem_walls_vtp_write(w, scratch, 0, (dem_real)0.01));
    fold(scratch);
    note(dem_surfaces_vtp_write(w, scratch));
    fold(scratch);
    for (wall.id = 1; wall.id < 4; wall.id++) {
        if (dem_wall_loads_csv_write(w, wall, scratch) != DEM_OK) continue;
        fold(scratch);
    }
    for (outlet.id = 1; outlet.id < 3; outlet.id++) {
        if (dem_outlet_residence_csv_write(w, outlet, scratch) != DEM_OK) continue;
        fold(scratch);
    }
})
CODE(read_checkpoint, static void read_checkpoint(dem_world *w) {
    note(twice(w, scratch));
    remove(scratch);
})
CODE(read_sizes, static void read_sizes(dem_world *w) {
    dem_sizes s = DEM_SIZES;
    dem_real radius[16];
    double amount[16];
    int i;
    s.kind = DEM_SIZES_LOGNORMAL;
    s.median = (dem_real)1e-3;
    s.spread = 0.2;
    note(dem_sizes_finer_get(w, &s, (dem_real)1.1e-3));
    if (dem_sizes_draw(w, &s, 16, 5, radius) == DEM_OK) for (i = 0; i < 16; i++) note((double)radius[i]);
    note_all(amount, dem_sizes_classes_get(w, &s, 16, radius, amount));
})
/* Rotations, ellipsoids and a box from a mesh, in a world of its own. */
CODE(read_apart, static void read_apart(dem_world *w) {
    static dem_real corner[24];
    static int32_t face[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0,
        6, 2, 1, 3, 7, 1, 7, 5};
    const dem_world_desc d = dem_world_desc_get(w);
    const dem_quat q = dem_quat_multiply(dem_quat_about(dem_vec3_make(0, 1, 0), 1), dem_quat_about(dem_vec3_make(1,
        0, 0), 2));
    const dem_vec3 v = dem_quat_unrotate(q, dem_quat_rotate(q, dem_vec3_make(1, 2, 3)));
    dem_world_desc plain = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_ellipsoid a;
    dem_ellipsoid b;
    dem_world *own;
    dem_real x[12];
    dem_real r[4];
    dem_mesh m;
    int i;
    plain.dt = d.dt;
    own = dem_world_create(&plain);
    for (i = 0; i < 24; i++) corner[i] = (dem_real)((i/3 >> i%3 & 1)*1e-3);
    m.vertex_count = 8;
    m.triangle_count = 12;
    m.vertices = corner;
    m.triangles = face;
    note_vec(v);
    a.position = dem_vec3_make(0, 0, 0);
    a.semi_axes = dem_vec3_make(1, 2, 3);
    a.orientation = q;
    b = a;
    b.position.x = 2;
    note((double)dem_ellipsoids_contact_get(&a, &b, 0).scale);
    if (dem_mesh_spheres(own, &m, 1, x, r, 0) == DEM_OK) note((double)r[0]);
    stuff.density = 1000;
    stuff.young = (dem_real)1e6;
    stuff.restitution = (dem_real)0.5;
    note(dem_body_add(own, dem_material_add(own, &stuff), dem_shape_mesh_add(own, &m, 0), v, q).slot);
    dem_world_destroy(own);
})
/* Sets numbers to what they are. */
CODE(read_numbers, static void read_numbers(dem_world *w) {
    const dem_bodies b = dem_bodies_get(w);
    const size_t size = sizeof(dem_real)*(size_t)b.count*(size_t)b.real_count;
    dem_real *copy = size ? (dem_real *)malloc(size) : 0;
    if (!copy) return;
    memcpy(copy, b.reals, size);
    note((double)copy[0]);
    note(dem_bodies_reals_set(w, copy));
    free(copy);
})

/* Sets what walls have, and asks for advice: both call functions, which try to change gravity in `meddle`. */
CODE(meddle, static dem_world *meddled; static void change_gravity(void) {
    if (meddled) dem_world_gravity_set(meddled, dem_vec3_make(1, 2, 0));
} static void law_meddling(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
    change_gravity();
} static int inside_meddling(dem_vec3 centre, dem_real radius, void *user) {
    (void)centre; (void)radius; (void)user;
    change_gravity();
    return 1;
} static void steer(dem_world *w) {
    dem_wall wall;
    dem_vec3 v;
    for (wall.id = 1; wall.id < 14; wall.id++)
        if (dem_wall_surface_velocity_get(w, wall, &v) == DEM_OK) dem_wall_surface_velocity_set(w, wall, v);
    dem_world_check(w, 0, 0);
    dem_world_error_get(w);
} static void meddle(dem_world *w) {
    meddled = w;
    steer(w);
    meddled = 0;
})
#define REL_SERVICE_CODES \
    R_(meddle, 0, 1), {"law_meddling", "", (void (*)(void))law_meddling, 0, 1}, \
    {"inside_meddling", "", (void (*)(void))inside_meddling, 0, 1}, {"steer", "", (void (*)(void))steer, 0, 1}, \
    R_(hear, 1, 1), R_(beat, 1, 1), R_(two_values, 1, 1), R_(shade, 1, 1), R_(read_world, 1, 1), R_(read_counters, \
        1, 1), \
    R_(read_bodies, 1, 1), R_(read_groups, 1, 1), R_(read_materials, 1, 1), R_(read_shapes, 1, 1), R_(read_walls, 1, \
        1), \
    R_(read_machine, 1, 1), R_(read_contacts, 1, 1), R_(read_events, 1, 1), R_(read_stress, 1, 1), R_(read_fields, \
        1, 1), \
    R_(read_mixing, 1, 1), R_(read_checks, 1, 1), R_(read_effects, 1, 1), R_(read_costs, 1, 1), R_(read_trials, 1, 1), \
    R_(read_grains, 1, 1), R_(read_surfaces, 1, 1), R_(read_checkpoint, 1, 1), R_(read_sizes, 1, 1), \
        R_(read_numbers, 1, 1), \
    R_(read_apart, 1, 1), R_(law_hysteretic, 1, 1), R_(law_mindlin, 1, 1), R_(law_rescaled, 1, 1), R_(law_stepped, 1, 1)
#endif
