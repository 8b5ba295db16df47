/* separator.h - a corona electrostatic separator: rotor, electrode, feeder, brush, bins, and where each grain lands. MIT
   licence. Include it after dem.h and corona.h.

   x points to the side to which metal flies, y up, z along the axis of the rotor, which goes through the origin. The rotor
   rotates clockwise. The world is a slice of the machine, periodic along z, with its share of the feed. Grains slide down a
   plate onto the top of the rotor.

       separator_desc d = separator_desc_make();
       separator s;
       d.rate = 2000;
       if (separator_create(&s, &d) != DEM_OK) puts(s.error);
       while (dem_world_time_get(s.world) < 4 && separator_step(&s) == DEM_OK) continue;
       ... s.landed[0 .. s.landed_count - 1] ...
       separator_end(&s);

   The machine is that of the open program of [CRI14] (see corona.h): rotor 0.320 m, electrode 0.038 m, 0.267 m from axis
   to axis, 30 degrees above the horizontal, 30 kV, 44.8 revolutions a minute, fed over a width of 0.182 m. */
#ifndef SEPARATOR_H
#define SEPARATOR_H
#include <stdio.h>

enum { SEPARATOR_CLASSES = DEM_CLASSES, SEPARATOR_VARIANTS = 3, SEPARATOR_PARTS = 4, SEPARATOR_POINTS = 16 };
typedef enum separator_form {
    SEPARATOR_SPHERE, SEPARATOR_FLAKE, SEPARATOR_SHAVING, SEPARATOR_FRAGMENT
} separator_form;
typedef enum separator_stuff { SEPARATOR_METAL, SEPARATOR_PLASTIC, SEPARATOR_MIDDLING } separator_stuff;

/* A part of the feed. Each is a material of dem.h, with one class of the feed per variant of its form. */
typedef struct separator_part { separator_stuff stuff; separator_form form; double share; } separator_part;

typedef struct separator_desc {
    double rotor, electrode, distance;       /* m: radii; between axes */
    double angle, voltage, rpm;              /* rad; V; 1/min */
    double width, feed_width;                /* m: of the slice; of the whole machine's feed */
    double rate;                             /* grains/s of the whole machine */
    double feed_time;                        /* s, after which the feed ends; 0: no end */
    double feeder_speed, feeder_angle, feeder_length, feeder_edge;   /* m/s; rad below level; m; m, x where it ends */
    dem_sizes sizes;                         /* of the spheres of equal volume */
    int part_count;
    separator_part parts[SEPARATOR_PARTS];
    double density[3], permittivity, middling;   /* kg/m3, by stuff; of plastic; share of metal in middlings */
    double restitution, friction, drum_friction, plate_friction, rolling;   /* rolling: with the rotor */
    double bins;                             /* m, y of the plane of the bins */
    corona physics;                          /* charging, drag, wind: field, windows and kinds are filled in */
    double ions_begin, ions_end, brush_middle, brush_half, layer;    /* rad; m: depth of both windows */
    dem_response response;
    dem_cone cone;
    dem_solver solver;
    int sweeps, cold, threads;               /* cold: sweeps begin with no impulses, not with those of the step
                                                before */
    double tolerance, range, skin, dt;       /* as in dem_world_desc */
    double young;                            /* Pa, springs alone */
    dem_normal_law normal_law;
    double near_interval;                    /* s, from one list of near pairs to the next */
    uint64_t seed;
    int ledger;
} separator_desc;

typedef struct separator_landing { double x, mass, time; int part, fed_class; } separator_landing;

typedef struct separator {
    separator_desc desc;
    corona physics;
    dem_world *world;
    dem_material rotor_stuff, plate_stuff, part_stuff[SEPARATOR_PARTS];
    dem_wall rotor, electrode, plate;
    dem_feed feed;
    dem_outlet outlet;
    int class_count, class_part[SEPARATOR_CLASSES];
    dem_shape class_shape[SEPARATOR_CLASSES];
    dem_real points[SEPARATOR_CLASSES][3*SEPARATOR_POINTS], ones[SEPARATOR_POINTS];
    separator_landing *landed;
    int landed_count, landed_room;
    uint32_t *seen, seen_count;              /* generation that has been counted, by slot */
    uint64_t binned[SEPARATOR_CLASSES];
    double sweeps, residual_max;             /* sum over steps; m/s */
    int loaded_max;                          /* largest number of contacts with an impulse or force in a step */
    uint64_t steps, unbalanced;
    int near_steps;
    char error[600];
} separator;

/* ---- the feed ---- */

static inline double separator_random(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return (double)((z ^ (z >> 31)) >> 11)/9007199254740992.0;
}
/* Points of a form, in mm; how many. A flake: a layer of seven spheres of radius 1, wider in its variants. A shaving: a
   twisted chain of spheres, 0.7 diameters apart. A fragment: sixteen random points on an ellipsoid as thick as 0.45 of
   its length, whose hull it is. */
static inline int separator_points(separator_form form, int variant, dem_real *points) {
    const int count = form == SEPARATOR_FLAKE ? 7 : form == SEPARATOR_SHAVING ? 4 + variant : SEPARATOR_POINTS;
    uint64_t state = (uint64_t)(7 + variant);
    int i, k;
    for (i = 0; i < count; i++) {
        double p[3] = {0, 0, 0};
        if (form == SEPARATOR_FLAKE && i < 6) {
            p[0] = 1.6*(1 + 0.15*variant)*cos(i*CORONA_PI/3);
            p[1] = 1.6*sin(i*CORONA_PI/3);
        } else if (form == SEPARATOR_SHAVING) {
            const double a = i*(0.4 + 0.2*variant)*CORONA_PI;
            p[0] = 1.4*i; p[1] = 0.5*cos(a); p[2] = 0.5*sin(a);
        } else if (form == SEPARATOR_FRAGMENT) {
            const double z = 2*(i + 0.5)/count - 1, a = 2*CORONA_PI*separator_random(&state), r = sqrt(1 - z*z);
            p[0] = r*cos(a); p[1] = 0.75*r*sin(a); p[2] = 0.45*z;
        }
        for (k = 0; k < 3; k++) points[3*i + k] = (dem_real)(1e-3*p[k]);
    }
    return count;
}
/* Adds a class: this part, in this variant of its form. The corona receives the points at which it can touch. */
static inline int separator_class_add(separator *s, int part, int variant) {
    const separator_form form = s->desc.parts[part].form;
    const int n = s->class_count;
    dem_real *points = s->points[n];
    dem_shape shape = {0};
    if (form != SEPARATOR_SPHERE) {
        const int count = separator_points(form, variant, points);
        dem_shape_info info;
        double axes[3];
        if (form == SEPARATOR_FRAGMENT) shape = dem_shape_polyhedron_add(s->world, count, points);
        else {
            dem_cluster_desc cluster = DEM_CLUSTER_DESC;
            cluster.count = count;
            cluster.positions = points;
            cluster.radius = DEM_R(1e-3);
            cluster.rays = 128;
            shape = dem_shape_cluster_add(s->world, &cluster);
        }
        if (!shape.id || dem_shape_get(s->world, shape, &info) != DEM_OK || shape.id >= CORONA_SHAPES) return 0;
        axes[0] = (double)info.semi_axes.x; axes[1] = (double)info.semi_axes.y; axes[2] = (double)info.semi_axes.z;
        s->physics.shapes[shape.id].count = count;
        s->physics.shapes[shape.id].points = points;
        s->physics.shapes[shape.id].radii = form == SEPARATOR_FRAGMENT ? 0 : s->ones;
        s->physics.shapes[shape.id].radius = info.radius;
        s->physics.shapes[shape.id].centre = info.centre;
        s->physics.shapes[shape.id].frame = info.frame;
        s->physics.shapes[shape.id].outline = corona_outline_make(axes);
    }
    s->class_part[n] = part;
    s->class_shape[n] = shape;
    s->class_count++;
    return 1;
}
static inline int separator_feed_add(separator *s, double x, double y) {
    const separator_desc *d = &s->desc;
    dem_feed_desc f = DEM_FEED_DESC;
    const double large = 2*(double)d->sizes.max;     /* flakes are wider than their spheres */
    int part, variant, k;
    for (part = 0; part < d->part_count; part++) {
        const int variants = d->parts[part].form == SEPARATOR_SPHERE ? 1 : SEPARATOR_VARIANTS;
        for (variant = 0; variant < variants; variant++) {
            k = s->class_count;
            if (!separator_class_add(s, part, variant)) return 0;
            f.radius[k] = d->sizes.min;
            f.sizes[k] = &d->sizes;
            f.amount[k] = d->parts[part].share/variants;
            f.materials[k] = s->part_stuff[part];
            f.shapes[k] = s->class_shape[k];
        }
    }
    f.material = s->part_stuff[0];
    f.class_count = s->class_count;
    f.rate = d->rate*d->width/d->feed_width;
    f.end = d->feed_time;
    f.box = dem_box_make((dem_real)(x + large), (dem_real)(y + large), 0, (dem_real)(x + large + 0.03),
                         (dem_real)(y + large + 0.012), (dem_real)d->width);
    f.velocity = dem_vec3_make((dem_real)(d->feeder_speed*cos(d->feeder_angle)),
                               (dem_real)(-d->feeder_speed*sin(d->feeder_angle)), 0);
    f.spread = (dem_real)(0.05*d->feeder_speed);
    f.seed = d->seed;
    s->feed = dem_feed_add(s->world, &f);
    return s->feed.id > 0;
}

/* ---- the machine ---- */

static inline separator_desc separator_desc_make(void) {
    separator_desc d;
    memset(&d, 0, sizeof d);
    d.rotor = 0.160; d.electrode = 0.019; d.distance = 0.267;
    d.angle = CORONA_PI/6; d.voltage = 30e3; d.rpm = 44.8;
    d.width = 0.03; d.feed_width = 0.182;
    d.rate = 5000;
    d.feeder_speed = 0.72; d.feeder_angle = CORONA_PI/9; d.feeder_length = 0.07; d.feeder_edge = -0.015;
    d.sizes.kind = DEM_SIZES_EXPONENTIAL;
    d.sizes.by_count = 1;
    d.sizes.min = DEM_R(0.5e-3); d.sizes.scale = DEM_R(1e-3); d.sizes.max = DEM_R(2e-3);
    d.part_count = 2;
    d.parts[0].stuff = SEPARATOR_METAL; d.parts[0].share = 0.5;
    d.parts[1].stuff = SEPARATOR_PLASTIC; d.parts[1].share = 0.5;
    d.density[SEPARATOR_METAL] = 8400; d.density[SEPARATOR_PLASTIC] = 946;
    d.permittivity = 2.5; d.middling = 0.5;
    d.restitution = 0.1; d.friction = 0.2; d.drum_friction = 0.5; d.plate_friction = 0.3;
    d.bins = -0.5;
    d.physics = corona_make();
    d.physics.strength = 11.818*d.voltage + 514.9;    /* V/m, fitted by its authors to make plastic stay */
    d.physics.current = 1e-4;
    d.physics.onset = corona_onset(d.rotor, 1e-4, 0.21, 1, 0.8);
    d.physics.contact_time = 1e-4; d.physics.leak_time = 10; d.physics.brush_time = 5e-3;
    d.physics.scatter = 0.3;
    d.physics.range = 0.010;
    d.ions_begin = -CORONA_PI/18; d.ions_end = 5*CORONA_PI/18;
    d.brush_middle = 3*CORONA_PI/2; d.brush_half = acos(1 - 0.009/0.160); d.layer = 0.010;
    d.response = DEM_RESPONSE_IMPULSES;
    d.range = 2e-3; d.dt = 2.5e-4;
    d.young = 5e6;
    d.near_interval = 1e-3;
    d.seed = 1;
    d.threads = 1;
    return d;
}

static inline void separator_say(separator *s, const char *sentence) {
    snprintf(s->error, sizeof s->error, "%s", sentence);
}
/* Friction of the grains with a wall's material. */
static inline int separator_rub(separator *s, dem_material wall, double friction, double rolling) {
    int i;
    for (i = 0; i < s->desc.part_count; i++) {
        dem_pair pair;
        if (dem_pair_get(s->world, s->part_stuff[i], wall, &pair) != DEM_OK) return 0;
        pair.friction = pair.friction_static = (dem_real)friction;
        pair.rolling_friction = (dem_real)rolling;
        if (dem_pair_set(s->world, s->part_stuff[i], wall, &pair) != DEM_OK) return 0;
    }
    return 1;
}
static inline int separator_stuff_add(separator *s) {
    const separator_desc *d = &s->desc;
    dem_material_desc m = DEM_MATERIAL_DESC;
    int i;
    m.young = (dem_real)d->young;
    m.poisson = DEM_R(0.3);
    m.restitution = (dem_real)d->restitution;
    m.friction = (dem_real)d->friction;
    for (i = 0; i < d->part_count; i++) {
        const separator_stuff stuff = d->parts[i].stuff;
        corona_kind *kind;
        const double metal = stuff == SEPARATOR_METAL ? 1 : stuff == SEPARATOR_PLASTIC ? 0 : d->middling;
        m.density = (dem_real)(metal*d->density[SEPARATOR_METAL] + (1 - metal)*d->density[SEPARATOR_PLASTIC]);
        s->part_stuff[i] = dem_material_add(s->world, &m);
        if (!s->part_stuff[i].id) return 0;
        kind = &s->physics.kinds[s->part_stuff[i].id];
        kind->metal = metal;
        kind->permittivity = d->permittivity;
        kind->density = (double)m.density;
    }
    m.density = 7800;
    s->rotor_stuff = dem_material_add(s->world, &m);
    s->plate_stuff = dem_material_add(s->world, &m);
    return s->rotor_stuff.id && s->plate_stuff.id &&
        separator_rub(s, s->rotor_stuff, d->drum_friction, d->rolling) &&
        separator_rub(s, s->plate_stuff, d->plate_friction, 0);
}
/* Adds the rotor, the electrode, the feeder's plate with an upright back, and the feed. */
static inline int separator_walls_add(separator *s) {
    const separator_desc *d = &s->desc;
    const dem_vec3 origin = dem_vec3_make(0, 0, 0), along = dem_vec3_make(0, 0, 1);
    dem_motion turn = DEM_MOTION;
    dem_profile profile;
    dem_real corners[6];
    int32_t segments[4] = {0, 1, 1, 2};
    const double x = d->feeder_edge - d->feeder_length*cos(d->feeder_angle);
    const double y = d->rotor + 0.004 + d->feeder_length*sin(d->feeder_angle);
    s->rotor = dem_wall_cylinder_add(s->world, s->rotor_stuff, origin, along, (dem_real)d->rotor, 0);
    s->electrode = dem_wall_cylinder_add(s->world, s->plate_stuff, dem_vec3_make((dem_real)(d->distance*cos(d->angle)),
                                    (dem_real)(d->distance*sin(d->angle)), 0), along, (dem_real)d->electrode, 0);
    turn.kind = DEM_MOTION_ROTATING;
    turn.axis = along;
    turn.speed = (dem_real)-s->physics.speed;
    corners[0] = (dem_real)x; corners[1] = (dem_real)(y + 0.04);
    corners[2] = (dem_real)x; corners[3] = (dem_real)y;
    corners[4] = (dem_real)d->feeder_edge; corners[5] = (dem_real)(d->rotor + 0.004);
    profile.vertex_count = 3; profile.segment_count = 2;
    profile.vertices = corners; profile.segments = segments;
    s->plate = dem_wall_profile_add(s->world, s->plate_stuff, &profile, DEM_EDGE_RESOLVED);
    return s->rotor.id && s->electrode.id && s->plate.id &&
        dem_wall_motion_set(s->world, s->rotor, &turn) == DEM_OK && separator_feed_add(s, x, y);
}
static inline int separator_outlet_add(separator *s) {
    const double y = s->desc.bins - 0.05;            /* grains are counted at the bins and removed below */
    dem_outlet_desc o = DEM_OUTLET_DESC;
    o.box = dem_box_make(-2, (dem_real)(y - 2), -1, 2, (dem_real)y, 1);
    s->outlet = dem_outlet_add(s->world, &o);
    return s->outlet.id > 0;
}
static inline void separator_corona_set(separator *s) {
    const separator_desc *d = &s->desc;
    corona *c = &s->physics;
    *c = d->physics;
    c->field = corona_field_make(d->rotor, d->electrode, d->distance, d->angle, d->voltage);
    c->speed = d->rpm*2*CORONA_PI/60;
    c->ions.begin = d->ions_begin; c->ions.end = d->ions_end;
    c->brush.begin = d->brush_middle - d->brush_half; c->brush.end = d->brush_middle + d->brush_half;
    c->ions.depth = c->brush.depth = d->layer;
    c->bins = d->bins;
    c->period = d->width;
    if (d->response == DEM_RESPONSE_IMPULSES) {      /* the gap that impulses leave, at twice the rotor's speed */
        const double along = 2*c->speed*d->rotor*d->dt, gap = along*along/(2*d->rotor);
        if (gap > c->touch) c->touch = gap;
    }
}
static inline dem_result separator_refused(separator *s, dem_result result) {
    if (result != DEM_OK) separator_say(s, dem_world_error_get(s->world));
    return result;
}
/* Creates the machine. s must keep its address until separator_end. */
static inline dem_result separator_create(separator *s, const separator_desc *desc) {
    dem_world_desc d = DEM_WORLD_DESC;
    int i;
    memset(s, 0, sizeof *s);
    s->desc = *desc;
    for (i = 0; i < SEPARATOR_POINTS; i++) s->ones[i] = DEM_R(1e-3);
    separator_corona_set(s);
    d.gravity.y = DEM_R(-9.81);
    d.domain = dem_box_make(-2, -2, 0, 2, 2, (dem_real)desc->width);
    d.boundary[2] = DEM_BOUNDARY_PERIODIC;
    d.body_reals = CORONA_REALS;
    d.body_reals_fn = corona_reals;
    d.body_reals_user = &s->physics;
    d.body_force = corona_force;
    d.force_user = &s->physics;
    d.response = desc->response;
    d.threads = desc->threads;
    d.ledger = desc->ledger;
    d.dt = (dem_real)desc->dt;
    d.skin = (dem_real)desc->skin;
    if (desc->response == DEM_RESPONSE_IMPULSES) {
        d.cone = desc->cone;
        d.solver = desc->solver;
        d.sweeps = desc->sweeps;
        d.tolerance = (dem_real)desc->tolerance;
        d.cold_start = desc->cold;
        d.law_range = (dem_real)desc->range;
        /* A grain that falls at 4 m/s moves farther than its radius in a step. dem.h needs a range of twice that.
           Where steps are so long that this costs too much, a range for contacts on the rotor, at 1 m/s, is enough */
        d.allow_large_dt = desc->range < 8*desc->dt;
    } else d.normal_law = desc->normal_law;
    s->world = dem_world_create(&d);
    if (!s->world) { separator_say(s, dem_world_create_error_get(&d)); return DEM_ERROR_ARGUMENT; }
    if (!separator_stuff_add(s) || !separator_walls_add(s) || !separator_outlet_add(s))
        return separator_refused(s, DEM_ERROR_ARGUMENT);
    return DEM_OK;
}
static inline void separator_end(separator *s) {
    dem_world_destroy(s->world);
    corona_end(&s->physics);
    free(s->landed);
    free(s->seen);
    memset(s, 0, sizeof *s);
}

/* ---- where grains land ---- */

static inline int separator_class_of(const separator *s, int32_t material, int32_t shape) {
    int k;
    for (k = 0; k < s->class_count; k++)
        if (s->part_stuff[s->class_part[k]].id == material && s->class_shape[k].id == shape) return k;
    return 0;
}
static inline int separator_seen_grow(separator *s, uint32_t slot) {
    uint32_t *more;
    if (slot < s->seen_count) return 1;
    more = (uint32_t *)realloc(s->seen, 2*((size_t)slot + 1)*sizeof *more);
    if (!more) return 0;
    memset(more + s->seen_count, 0, (2*((size_t)slot + 1) - s->seen_count)*sizeof *more);
    s->seen = more;
    s->seen_count = 2*(slot + 1);
    return 1;
}
static inline int separator_land(separator *s, double x, double mass, int fed_class) {
    separator_landing *l;
    if (s->landed_count == s->landed_room) {
        const int room = 2*s->landed_room + 256;
        l = (separator_landing *)realloc(s->landed, (size_t)room*sizeof *l);
        if (!l) return 0;
        s->landed = l;
        s->landed_room = room;
    }
    l = &s->landed[s->landed_count++];
    l->x = x; l->mass = mass; l->time = dem_world_time_get(s->world);
    l->fed_class = fed_class; l->part = s->class_part[fed_class];
    return 1;
}
/* Counts each grain once when it has passed the plane of the bins; present: by class, the grains that have not. */
static inline dem_result separator_tally(separator *s, uint64_t *present) {
    const dem_bodies b = dem_bodies_get(s->world);
    int i;
    memset(present, 0, SEPARATOR_CLASSES*sizeof *present);
    for (i = 0; i < b.count; i++) {
        const int k = separator_class_of(s, b.materials[i], b.shapes ? b.shapes[i] : 0);
        const double x = (double)b.reals[b.real_count*i + CORONA_LANDING];
        const uint32_t slot = b.slots[i], generation = dem_body_id_get(s->world, i).generation + 1;
        if (!(x > 0 || x < 0)) { present[k]++; continue; }
        if (!separator_seen_grow(s, slot)) return DEM_ERROR_MEMORY;
        if (s->seen[slot] == generation) continue;
        s->seen[slot] = generation;
        s->binned[k]++;
        if (!separator_land(s, x, (double)b.masses[i], k)) return DEM_ERROR_MEMORY;
    }
    return DEM_OK;
}
/* Returns 1 if for each class the grains fed are those landed plus those present. */
static inline int separator_balanced(const separator *s, const uint64_t *present) {
    const dem_body_counts balance = dem_body_counts_get(s->world);
    dem_feed_state fed;
    uint64_t sum = 0;
    int k, ok;
    if (dem_feed_get(s->world, s->feed, &fed) != DEM_OK) return 0;
    ok = balance.inserted == fed.total;
    for (k = 0; k < s->class_count; k++) {
        ok = ok && fed.fed[k] == s->binned[k] + present[k];
        sum += s->binned[k] + present[k];
    }
    return ok && sum == fed.total;
}
/* Takes some steps, then counts landed grains and checks that every grain fed has landed or is present. */
static inline dem_result separator_advance(separator *s, int steps) {
    uint64_t present[SEPARATOR_CLASSES];
    dem_counters counters;
    const dem_result result = separator_refused(s, dem_world_step(s->world, steps));
    if (result != DEM_OK) return result;
    if (separator_tally(s, present) != DEM_OK) {
        separator_say(s, "separator_step: no memory to count what has landed");
        return DEM_ERROR_MEMORY;
    }
    counters = dem_counters_get(s->world);
    s->sweeps += counters.sweeps;
    if ((double)counters.residual > s->residual_max) s->residual_max = (double)counters.residual;
    if (counters.contacts + counters.wall_contacts > s->loaded_max)
        s->loaded_max = counters.contacts + counters.wall_contacts;
    s->steps++;
    s->unbalanced += !separator_balanced(s, present);
    return DEM_OK;
}
/* Runs for about near_interval, in which the list of near grains stays: with impulses one step at a time, with springs all
   steps at once. */
static inline dem_result separator_step(separator *s) {
    const double dt = (double)dem_counters_get(s->world).dt;
    const int steps = dt > 0 ? (int)(s->desc.near_interval/dt + 0.5) : 1;
    const int springs = s->desc.response == DEM_RESPONSE_SPRINGS && steps > 1;
    dem_result result = DEM_OK;
    int i;
    if (!corona_near_update(&s->physics, s->world)) {
        separator_say(s, "separator_step: no memory for the forces between near grains");
        return DEM_ERROR_MEMORY;
    }
    if (springs) return separator_advance(s, steps);
    for (i = 0; result == DEM_OK && (i < steps || !i); i++) result = separator_advance(s, 1);
    return result;
}
/* Returns the number of grains that have not landed. */
static inline uint64_t separator_present(const separator *s) {
    dem_feed_state fed;
    uint64_t binned = 0;
    int k;
    for (k = 0; k < s->class_count; k++) binned += s->binned[k];
    return dem_feed_get(s->world, s->feed, &fed) == DEM_OK ? fed.total - binned : 0;
}
/* Call this after dem_checkpoint_read: the grains that had landed before were counted by the earlier program. */
static inline dem_result separator_restored(separator *s) {
    uint64_t present[SEPARATOR_CLASSES];
    dem_feed_state fed;
    dem_result result = separator_tally(s, present);
    int k;
    if (result == DEM_OK) result = separator_refused(s, dem_feed_get(s->world, s->feed, &fed));
    for (k = 0; k < s->class_count && result == DEM_OK; k++) s->binned[k] = fed.fed[k] - present[k];
    s->landed_count = 0;
    return result;
}
#endif
