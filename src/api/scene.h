/* ---------------------------------------------------------------------------------------------
   >>scene
   The parts of a scene, in the order in which a program builds it: the world, materials, grains
   and other bodies. Walls, joints, feeds and outlets follow in >>machine.

   Errors. A function that fails changes nothing. It returns an error code, an id of zeros or 0,
   and dem_world_error_get says why. A function fails if a value is out of range, if an id or a
   pointer is wrong, or if memory runs out; the comments below state only further reasons.
   Positions (m), velocities (m/s) and angular velocities (rad/s) must be finite and at most 1e15.

   Descs. Start from the constant of its name (DEM_WORLD_DESC) and set what differs. A field that is
   left 0 is absent or has the stated default; a required field must be set.
   --------------------------------------------------------------------------------------------- */

/* ---- world ---- */
/* The description of a world. dem_world_create_error_get checks it. */
typedef struct dem_world_desc {
    /* -- gravity and domain -- */
    dem_vec3 gravity;              /* m/s2 */
    /* m. Required on axes whose boundary is periodic or outflow, not needed on open axes. A
       periodic axis must be at least as long as four of the largest radii, two skins and two
       ranges of the law. */
    dem_box domain;
    dem_boundary boundary[3];      /* of the faces on the axes x, y and z */
    /* 1 makes the world two-dimensional: bodies are discs and polygons that move in the plane z = 0
       and rotate about z only. The z component of gravity is ignored. */
    int planar;
    dem_real thickness;            /* m, of discs and polygons along z; 0 means 1 m */

    /* -- contact laws, for DEM_RESPONSE_SPRINGS: see "choices" above -- */
    dem_normal_law normal_law;
    dem_tangent_law tangent_law;
    dem_rolling_law rolling_law;
    dem_tension tension;
    dem_load friction_load;
    dem_slider slider;
    dem_convention convention;

    /* -- user-defined law -- */
    /* replaces the normal, tangential and rolling law; null means the laws above */
    dem_law_fn law;
    /* The same law for rows of contacts of spheres, which is faster: DEM_LAW_ROWS defines it. It
       must return what law returns; dem.h uses whichever suits. It needs law. Null means that law
       is called for each contact, as it always is with law_who. */
    dem_law_rows_fn law_rows;
    void *law_user;                /* passed to law as c->user */
    int law_memory;                /* reals of contact history per contact, 0 to 16 */
    /* Names of these reals for dem_contacts_vtp_write, written as in body_reals. Null means
       memory0, memory1 and so on. */
    const char *law_memory_names;
    int law_vectors;               /* leading triples of them that are vectors, 0 to law_memory/3 */
    /* N/m, the largest stiffness of law; limits the time step. 0 means the stiffness of the
       built-in law. */
    dem_real law_stiffness;
    /* m, >= 0. law is also called for two bodies that do not touch while their gap is below
       law_range + law_range_radii (Ra + Rb), with c->overlap < 0. A wall counts with radius 0, an
       ellipsoid with its bounding sphere. Built-in laws that it calls need overlap > 0. 0 means no
       range. With both 0, law is called in contact only, at no extra cost. */
    dem_real law_range;
    dem_real law_range_radii;      /* >= 0; see law_range; 0 means no such range */
    int law_who;                   /* 1 fills in c->who: ids, radii, masses, contact point, time */
    /* Returns how fast law changes numbers on bodies; limits the time step. It needs law, law_who
       and body_reals. It is called before the first step and at least once in eight steps. A given
       dt above the stable limit is an error; a chosen dt is at most half of it. Null means
       that these rates do not limit dt. */
    dem_law_rate_fn law_rate;

    /* -- numbers on bodies -- */
    /* Names of numbers that every body and wall carries, such as "temperature charge": at most 8
       words of up to 23 letters, digits and _. Files use these names. The numbers begin as 0. With
       law_who, law reads them and returns their rates (per s). Null means no numbers. */
    const char *body_reals;
    /* Updates the numbers of a body after each step. Null means that each grows by rate dt. Numbers
       of walls stay as set; dem_wall_loads sums what they would gain. */
    dem_reals_fn body_reals_fn;
    void *body_reals_user;         /* passed to body_reals_fn */

    /* -- bodies that change their size -- */
    /* Returns the rate of the radius of a body, m/s: > 0 grows, < 0 wears. Mass follows at constant
       density, velocity and contact history stay. Each change of radii costs a new list and another
       computation of forces. Null means constant radii; see dem_body_radius_set. */
    dem_growth_fn growth;
    void *growth_user;             /* passed to growth */
    /* s, between two changes of radii; 0 means every step. A body that was added within an interval
       grows for all of it. In single precision changes below 6e-8 of a radius are lost: take a
       longer interval */
    dem_real growth_interval;

    /* -- groups -- */
    /* Names of sets of bodies, such as "coarse tracer": at most 32 words of up to 23 letters,
       digits and _. A body belongs to none until dem_bodies_group_set. Null means no groups. */
    const char *groups;

    /* -- force fields; both may be given and add up -- */
    dem_force_fn force;            /* force on a body; null means none */
    dem_body_force_fn body_force;  /* force and torque on a body; null means none */
    void *force_user;              /* passed to both */

    /* -- time stepping -- */
    dem_integrator integrator;
    /* s, the time step; 0 means chosen from the scene, see dem_step_advice_get */
    dem_real dt;
    /* 1 allows dt above the stable limit, to show what happens then. It switches off all checks of
       the step: of contacts, speeds, walls and law_rate; a chosen dt is not shortened either. */
    int allow_large_dt;
    /* m/s, typical impact speed. The time step and, in the linear and hysteretic law, a stiffness
       from Young's modulus depend on it. 0 means the largest speed expected from grains, walls and
       height of fall for the time step, and 1 m/s for the stiffness. */
    dem_real impact_speed;

    /* -- impulses -- */
    /* DEM_RESPONSE_IMPULSES needs dt > 0 and law null. Its steps are of second order
       (docs/impulses.md) for either value of integrator that it accepts, 0 and
       DEM_INTEGRATOR_SYMPLECTIC_EULER. law_range (m) is then the gap below which contacts are
       solved. If it is 0, dem.h takes three times the distance that the fastest point of a body or
       wall moves in a step, at most the largest radius R and at least 0.01 R. On a periodic axis of
       length P it is at most the larger of 0.1 R and 0.8 (P/2 - 2 R - skin), with skin 0 unless you
       set it.
       The fields that follow apply to impulses only. */
    dem_response response;
    dem_cone cone;
    dem_solver solver;
    int sweeps;                    /* most sweeps over all contacts in a step; 0 means 200 */
    /* m/s. The sweeps end when no contact changes its velocity by more in one sweep. 0 means when
       the root mean square change is below 0.05 g dt plus 1e-5 of the largest speed, and the
       largest change is below 30 times that. Where polyhedra lie on faces, and in towers of more
       than three bodies, the root mean square must also fall to a tenth of that and to half of its
       first value, or to 1e-5 of that (single precision: 3e-4). */
    dem_real tolerance;
    int cold_start;                /* 1 begins with zero impulses, not those of the last step */
    /* 1 ends the run with DEM_ERROR_STOPPED after a step whose sweeps did not reach the tolerance.
       With 0 it continues; dem_counters_get, the report and dem_progress_print count such steps. */
    int unsolved_stops;

    /* -- contact detection -- */
    dem_search search;
    /* m, margin of the neighbour list; 0 means chosen for speed; < 0 means none: the list is
       rebuilt in every step. */
    dem_real skin;

    /* -- other shapes -- */
    dem_rotation rotation;
    dem_overlap ellipsoid_overlap;
    dem_cluster_contacts cluster_contacts;
    int orientations;              /* 1 follows the orientations of spheres too */

    /* -- running -- */
    /* 0 to 1, in radii (see dem_counters.overlap_max): a step after which an overlap is larger ends
       the run with DEM_ERROR_STOPPED, because grains are jammed or too soft. 0 means off. The
       report and dem_progress_print name an overlap above 0.05. */
    dem_real overlap_stop;
    int ledger;                    /* 1 accounts for energy, see dem_ledger_get */
    /* Largest number of threads, 0 to 64; 0 means as many as OpenMP offers, at most 64. Fewer are
       used while that is faster; results are the same. */
    int threads;
    dem_allocator allocator;       /* memory functions; 0 means malloc and free */
} dem_world_desc;
static const dem_world_desc DEM_WORLD_DESC_ZERO = DEM_ZERO;
#define DEM_WORLD_DESC DEM_WORLD_DESC_ZERO

/* Creates an empty world. Returns null if a value of desc is out of range
   (dem_world_create_error_get(desc) says why), if memory runs out, or if version or DEM_REAL differ
   from those of the implementation; then it returns "". */
static inline dem_world *dem_world_create(const dem_world_desc *desc);
/* Returns the reason why dem_world_create refuses desc, or "" if it accepts desc. */
DEM_API const char *dem_world_create_error_get(const dem_world_desc *desc);
/* Frees a world and all that belongs to it. Null does nothing. The function of an output cannot
   destroy its world. */
DEM_API void dem_world_destroy(dem_world *world);
/* Returns the error message of the last call on this world that failed; "" if none failed. For a
   null world the message says that it is null.
   If a call that builds the scene fails (names that end in _add, _fill or _pack; dem_pair_set,
   dem_material_set, dem_wall_motion_set), the next run fails too and quotes its message. Otherwise
   a scene without its floor would run and return DEM_OK. Runs work again once the program has
   called dem_world_error_get or repeated the failed call with success. */
DEM_API const char *dem_world_error_get(const dem_world *world);
/* Returns a short text for a result, such as "out of memory". */
DEM_API const char *dem_result_name_get(dem_result result);
/* Returns the desc as given, with the present gravity, domain and dt, the search and integrator in
   use, and thickness and threads where they were 0. skin: present value; 0 before the first
   list or if desc.skin < 0. Other zeros stay 0, such as laws, sweeps and tolerance. */
DEM_API dem_world_desc dem_world_desc_get(const dem_world *world);

/* ---- materials ---- */
/* A material. Moduli, stiffnesses and the density may be at most 1e30 (SI), friction coefficients
   at most 1e9. */
typedef struct dem_material_desc {
    dem_real density;              /* kg/m3, required, > 0 */
    /* Pa, required, > 0; may be 0 with impulses, or if a linear or hysteretic law has a
       stiffness */
    dem_real young;
    dem_real poisson;              /* >= 0 and < 0.5: nu; 0 is a physical value */
    /* Required, > 0 and <= 1: e, speed after a normal impact over speed before it; may be 0 with
       impulses. The hysteretic law takes either this or stiffness_unloading; they are related by
       e = sqrt(kn/kun) for a contact without adhesion. */
    dem_real restitution;
    dem_real friction;             /* sliding friction mu, >= 0 */
    /* Static friction mu_s, >= friction; 0 means equal to friction. The limit of friction is mu_s
       Fn until the contact slides, then mu Fn until the slip stops or reverses. */
    dem_real friction_static;
    dem_real rolling_friction;     /* mu_r, >= 0: the moment is at most mu_r R* Fn */
    /* N/m, kn of the linear and hysteretic law; 0 means from young and impact_speed [DIM04] */
    dem_real stiffness;
    dem_real stiffness_ratio;      /* kt/kn of these two laws; 0 means 2(1 - nu)/(2 - nu) */
    /* N/m, kun of the hysteretic law, >= stiffness; 0 means from restitution. Needs stiffness. */
    dem_real stiffness_unloading;
    /* stiffness_adhesion: N/m, kad of the hysteretic law, >= 0 (a negative slope in [ALK07]); 0
       means no adhesion */
    DEM_LAW_COEFFICIENTS(DEM_PROPERTY_FIELD)
} dem_material_desc;
static const dem_material_desc DEM_MATERIAL_DESC_ZERO = DEM_ZERO;
#define DEM_MATERIAL_DESC DEM_MATERIAL_DESC_ZERO

/* Adds a material. A world holds at most 64. */
DEM_API dem_material dem_material_add(dem_world *world, const dem_material_desc *desc);
/* Changes moduli, restitution and friction of a material, also while the world runs. Its pairs are
   mixed again, except those that dem_pair_set has replaced. Contacts keep their history; a chosen
   time step is chosen again. The density must stay the same, because bodies have their masses. A
   checkpoint that is written afterwards can be read only by a world whose material has been changed
   in the same way. */
DEM_API dem_result dem_material_set(dem_world *world, dem_material material,
                                    const dem_material_desc *desc);
/* Writes the present values of a material to desc. */
DEM_API dem_result dem_material_get(const dem_world *world, dem_material material,
                                    dem_material_desc *desc);

/* The contact properties of two materials. Unless dem_pair_set sets them, they are mixed from the
   materials, for walls as for grains:
   - restitution, the three friction coefficients and stiffness_adhesion by the geometric mean: a
     coefficient that is 0 in one of the two is 0 in the pair (friction_static 0 means friction);
   - moduli in series as for Hertz, 1/E* = sum (1 - nu^2)/E and 1/G* = sum (2 - nu)/G;
   - stiffness by the mean 2 ka kb/(ka + kb) if both give one; otherwise it follows from E*, or is
     the given one if E* is unknown because a material has no young;
   - stiffness_ratio by the geometric mean if both give one, otherwise from the mean nu. */
typedef struct dem_pair {
    dem_real young_eff;            /* Pa, E*, > 0; may be 0 where `young` may */
    dem_real shear_eff;            /* Pa, G* */
    dem_real restitution;          /* > 0 and <= 1: e; may be 0 with impulses */
    dem_real friction;             /* sliding friction mu, >= 0 */
    /* mu_s, >= friction; 0 means equal to friction, also when friction changes. Mixed: 0 if both
       materials leave it 0. */
    dem_real friction_static;
    dem_real rolling_friction;     /* mu_r: the moment is at most mu_r R* Fn */
    /* N/m, linear and hysteretic law; 0 means from E* and impact_speed for each pair of radii */
    dem_real stiffness;
    dem_real stiffness_ratio;      /* kt/kn, linear and hysteretic law */
    dem_real tangent_damping;      /* factor on the tangential dashpot, >= 0; mixed: 1 */
    /* N s/m, the normal dashpot of the linear and hysteretic law for all masses; 0 means from
       restitution (linear) or none (hysteretic) */
    dem_real normal_damping;
    /* mu_spin, >= 0: twisting friction, a moment about the normal up to mu_spin R* Fn; 0 when
       mixed. With springs: dem_law_twist. */
    dem_real spinning_friction;
    /* The next two are for impulses only: 0 when mixed, and must be 0 with springs. */
    /* N, >= 0: attractive force between bodies in contact. It holds until the gap exceeds 1e-3 of
       the smaller radius. */
    dem_real cohesion;
    /* m/N, >= 0: a spring of stiffness 1/compliance, evaluated at the end of the step. It is stable
       for any value; oscillations that the step does not resolve are damped. */
    dem_real compliance;
    /* stiffness_adhesion: N/m, kad of the hysteretic law; its kun is stiffness/restitution^2 */
    DEM_LAW_COEFFICIENTS(DEM_PROPERTY_FIELD)
    /* 1: bodies and walls of these materials pass through each other. They make no contacts, and
       laws that act at a distance are not called for them. The energy of springs that are in
       contact when this is set goes to the residual of the ledger. Mixed: 0. */
    int32_t ignored;
} dem_pair;
/* Writes the contact properties of two materials to pair. */
DEM_API dem_result dem_pair_get(const dem_world *world, dem_material a, dem_material b,
                                dem_pair *pair);
/* Replaces the contact properties of two materials, in both orders. Start from dem_pair_get. */
DEM_API dem_result dem_pair_set(dem_world *world, dem_material a, dem_material b,
                                const dem_pair *pair);

/* The coefficients of the built-in laws for two spheres. */
typedef struct dem_coefficients {
    dem_real r_eff, m_eff;         /* m, kg: effective radius and mass */
    dem_real kn, cn, kt, ct;       /* see dem_contact: kn d^(3/2) + cn d^(1/4) v or kn d + cn v */
    dem_real kun;                  /* N/m, hysteretic law; otherwise 0 */
    /* beta = -ln e / sqrt(pi^2 + ln^2 e); larger with DEM_TENSION_COMPENSATED; 0 with impulses */
    dem_real damping_ratio;
    dem_real contact_time;         /* s, at the impact speed; hysteretic law: [ALK07] eq 2.45 */
    DEM_LAW_COEFFICIENTS(DEM_COEFFICIENT_FIELD)                /* kad */
} dem_coefficients;
/* Computes the coefficients for spheres of radius_a and radius_b (m). radius_b = 0 means a wall of
   material b. The impact speed is that of the desc, or 1 m/s if it is 0 there. */
DEM_API dem_result dem_coefficients_get(const dem_world *world, dem_material a, dem_material b,
                                        dem_real radius_a, dem_real radius_b,
                                        dem_coefficients *out);
/* Prints contact properties of all pairs of materials, one line per pair: moduli, restitution,
   friction and stiffness; with impulses also spinning friction, cohesion and compliance. */
DEM_API void dem_pairs_print(const dem_world *world, FILE *out);

/* ---- grains ---- */

/* Adds a sphere, or in a planar world a disc, at rest. radius > 0 and position in m. */
DEM_API dem_body dem_sphere_add(dem_world *world, dem_material material, dem_real radius,
                                dem_vec3 position);
/* Adds count spheres, all or none. positions: count x 3, m. velocities: count x 3, m/s, or null for
   rest. radii: count, m, or null if all have `radius`. */
DEM_API dem_result dem_spheres_add(dem_world *world, dem_material material, int count,
                                   const dem_real *positions,
                                   const dem_real *velocities, const dem_real *radii,
                                   dem_real radius);
/* Returns nonzero if a body with this bounding radius (m) may have its centre here. */
typedef int (*dem_inside_fn)(dem_vec3 centre, dem_real radius, void *user);
/* A region for new bodies. */
typedef struct dem_region {
    /* m, required. Bodies lie wholly inside. If the box spans the domain on a periodic axis, it has
       no faces there and centres may be anywhere. */
    dem_box box;
    /* 'x', 'y' or 'z' restricts the region to the cylinder inscribed in the box along that axis,
       elliptic if the box is not square. Centres then lie in an ellipse whose half axes are smaller
       by the radius. 0 means the whole box. */
    int cylinder;
    dem_inside_fn inside;          /* restricts the region further; null means no restriction */
    void *user;                    /* passed to inside */
} dem_region;
static const dem_region DEM_REGION_ZERO = DEM_ZERO;
#define DEM_REGION DEM_REGION_ZERO
/* Returns the region that is a whole box. */
DEM_INLINE dem_region dem_region_make(dem_box box) {
    dem_region region = DEM_REGION;
    region.box = box;
    return region;
}
/* Returns the region of a box in which inside(centre, radius, user) is nonzero. */
DEM_INLINE dem_region dem_region_inside_make(dem_box box, dem_inside_fn inside, void *user) {
    dem_region region = dem_region_make(box);
    region.inside = inside;
    region.user = user;
    return region;
}
/* Adds up to count spheres of one radius (m) at random positions in a region, one after the other.
   The same seed gives the same positions. A position is free if the sphere there overlaps no body
   (a body that is not a sphere counts with its bounding sphere), also across periodic faces, and
   touches no wall. What the material ignores (dem_pair) does not count. No position is free behind
   a plane, on the wrong side of a cylinder or in a sieve; the inside of a closed mesh counts like
   its outside. Returns how many were added. If these are fewer than count, 2000 tries for one
   sphere failed; dem_world_error_get says so, but the world can run. */
DEM_API int dem_spheres_fill(dem_world *world, dem_material material, dem_real radius,
                             dem_region region, int count, uint64_t seed);
/* The kind of a size distribution. F(r) is the fraction finer than radius r. All are truncated to
   min <= r <= max and scaled to 1. */
typedef enum dem_sizes_kind {
    DEM_SIZES_UNIFORM = 0,         /* F grows linearly with r */
    DEM_SIZES_LOGNORMAL,           /* log-normal, by median and spread */
    DEM_SIZES_WEIBULL,             /* Weibull or Rosin-Rammler: F = 1 - exp(-(r/scale)^modulus) */
    DEM_SIZES_SIEVE_CURVE,         /* the fraction that passes each of `count` sieves */
    DEM_SIZES_NORMAL,              /* normal, by median and deviation */
    /* exponential beyond min with mean `scale` (docs/separator.md): F = 1 - exp(-(r - min)/(scale -
       min)) */
    DEM_SIZES_EXPONENTIAL
} dem_sizes_kind;
enum { DEM_SIEVES = 32 };          /* largest number of sieves of a sieve curve */
/* A size distribution, by radius. */
typedef struct dem_sizes {
    dem_sizes_kind kind;
    int by_count;                  /* 1: F is a fraction of the number; 0 means of the mass */
    /* m, 1e-15 <= min <= max < 1e15. 0 means the default of the kind. Log-normal: the median times
       exp(-6 spread) and exp(6 spread); normal: 6 deviations from the median, min at least 1e-3 of
       the median; sieve curve: its ends; Weibull and exponential: max where F = 1 - 1e-9. The
       others are required: min of Weibull and exponential, both of uniform. */
    dem_real min, max;
    dem_real median;               /* m, log-normal and normal, > 0 */
    double spread;                 /* log-normal, > 0 and < 10: standard deviation of ln r */
    dem_real scale;                /* m, > 0: of Weibull; exponential: the mean, > min */
    double modulus;                /* Weibull, > 0.05 and < 1000 */
    int count;                     /* number of sieves, 2 to 32 */
    dem_real radius[DEM_SIEVES];   /* m, half the apertures, > 0, ascending */
    /* Fraction that passes each sieve, ascending, the last 1. F is linear between two sieves;
       grains that pass the first have its radius. */
    double passing[DEM_SIEVES];
    dem_real deviation;            /* m, normal, > 0: standard deviation */
} dem_sizes;
static const dem_sizes DEM_SIZES_ZERO = DEM_ZERO;
#define DEM_SIZES DEM_SIZES_ZERO
/* Returns the fraction finer than a radius (m), of mass or number as by_count says; -1 on error. */
DEM_API double dem_sizes_finer_get(dem_world *world, const dem_sizes *sizes, dem_real radius);
/* Draws count radii (m) at random or, with seed 0, at equal steps of the distribution of numbers,
   ascending: then a few hundred radii represent it within 1 %. Mass is proportional to r^3, in
   planar worlds to r^2. */
DEM_API dem_result dem_sizes_draw(dem_world *world, const dem_sizes *sizes, int count,
                                  uint64_t seed, dem_real *radii);
/* Divides a distribution into at most class_count (1 to 16) classes, whose bounds have equal
   ratios, for the fields radius and amount of dem_feed_desc (with by_mass = 1 - by_count). radius
   (m) is that of a grain of the mean mass of its class; the amounts sum to 1. Returns the number of
   classes that are not empty; 0 on error. */
DEM_API int dem_sizes_classes_get(dem_world *world, const dem_sizes *sizes, int class_count,
                              dem_real *radius, double *amount);
/* Adds up to count spheres, as dem_spheres_fill does, with radii as dem_sizes_draw gives them for
   its seed 0, largest first, while there is most room. seed is for the positions. */
DEM_API int dem_sizes_fill(dem_world *world, dem_material material, const dem_sizes *sizes,
                           dem_region region, int count, uint64_t seed);
/* Adds spheres on a hexagonal close packing, in layers along z, with a gap of padding (m, >= 0)
   between surfaces: at most count (0: all that fit), at those sites that lie in the region and are
   free as in dem_spheres_fill. In a planar world the packing is a triangular lattice. Spheres at
   opposite periodic faces do not overlap, but the lattice does not continue across the faces.
   Returns how many were added. */
DEM_API int dem_spheres_pack(dem_world *world, dem_material material, dem_real radius,
                             dem_real padding, dem_region region, int count);
/* Removes a body. Its id becomes invalid. */
DEM_API dem_result dem_body_remove(dem_world *world, dem_body body);

/* The state of a body. dem_body_set uses position, velocity, spin, orientation and fixed and
   ignores the rest; dem_body_radius_set sets the radius. */
struct dem_body_state {
    dem_vec3 position, velocity, spin;   /* m, m/s, rad/s */
    dem_vec3 force, torque;        /* N, N m: of the last step, without gravity */
    /* m, kg, kg m2. For a body that is not a sphere: the radius of its bounding sphere and the
       smallest principal moment. */
    dem_real radius, mass, inertia;
    dem_material material;
    int fixed;                     /* 1: the body never moves, whatever forces act on it */
    /* Rotates the frame in which the shape was given into the world. dem_body_set accepts any
       length but 0. Spheres have one if desc.orientations is 1. */
    dem_quat orientation;
    dem_shape shape;               /* id 0 for a sphere */
    dem_vec3 moments;              /* kg m2, about the principal axes */
    const dem_real *reals;         /* desc.body_reals, valid until the next step; null: none */
};
/* Writes the state of a body to state. */
DEM_API dem_result dem_body_get(const dem_world *world, dem_body body, dem_body_state *state);
/* Sets position, velocity, spin, orientation and fixed. Start from dem_body_get. A body on a rail
   keeps its velocity and spin along and about locked axes. */
DEM_API dem_result dem_body_set(dem_world *world, dem_body body, const dem_body_state *state);

/* Sets the radius of a body, m, > 0 (dem_body_state.radius; all lengths of its shape scale with
   it). Mass and moments of inertia follow from the density of the material. Velocity, spin and
   contacts with their history stay. The next step checks the time step, or chooses it again. The
   ledger counts the kinetic energy of the new mass as `inserted`, and what springs gain as
   `growth`. See desc.growth for radii that change all the time. */
DEM_API dem_result dem_body_radius_set(dem_world *world, dem_body body, dem_real radius);

/* Returns the granular temperature, m2/s2: the mass-weighted mean square deviation of velocities
   from their mean, per axis (two in a planar world), over all bodies that can move. Returns 0 for
   fewer than two bodies. */
DEM_API double dem_temperature_get(const dem_world *world);
/* Sets the granular temperature (m2/s2, >= 0). seed 0 scales the deviations from the mean velocity;
   any other seed draws velocities from Maxwell's distribution, with equal mean energy for all
   masses. The mean velocity and the spins stay. It is an error if fewer than two bodies can move,
   or if seed is 0 and the present temperature is 0. */
DEM_API dem_result dem_temperature_set(dem_world *world, double temperature, uint64_t seed);

/* The arrays of all bodies. Their order changes when the neighbour list is rebuilt; slots identify
   the bodies. Pointers are valid until the next step or change. */
typedef struct dem_bodies {
    int count;
    const dem_real *positions;     /* count x 4: x, y, z [m], (bounding) radius [m] */
    const dem_real *velocities;    /* count x 4: x, y, z [m/s], 0 */
    const dem_real *spins;         /* count x 4: x, y, z [rad/s], 0 */
    const dem_real *forces;        /* count x 4: x, y, z [N], 0; gravity is not included */
    const dem_real *torques;       /* count x 4: x, y, z [N m], 0 */
    const dem_real *masses;        /* count [kg] */
    const uint32_t *slots;         /* count: slot of dem_body less 1; see dem_body_id_get */
    const int32_t *materials;      /* count: ids of dem_material */
    /* count x 4: w, x, y, z, from principal axes to the world; null if none is followed */
    const dem_real *orientations;
    const int32_t *shapes;         /* count: ids of dem_shape, 0: sphere; null if orientations is */
    int real_count;                /* numbers per body (desc.body_reals) */
    const dem_real *reals;         /* count x real_count; null if there are none */
    const dem_real *rates;         /* count x real_count, per s, of the last step; null likewise */
    const uint32_t *groups;        /* bit id - 1: in that group; null without desc.groups */
} dem_bodies;
/* Returns the arrays of all bodies; zeros for a null world. */
DEM_API dem_bodies dem_bodies_get(const dem_world *world);
/* Returns the id of the body at this index of the arrays; zeros if there is none. */
DEM_API dem_body dem_body_id_get(const dem_world *world, int index);

/* Which bodies: those that fulfil every condition. DEM_SELECTION, all zero, selects every body. */
typedef struct dem_selection {
    dem_group group;               /* only members of this group; id 0 means any */
    dem_material material;         /* only of this material; id 0 means any */
    dem_shape shape;               /* only of this shape; id 0 means any, spheres included */
    dem_real radius_min, radius_max;   /* m, only of these (bounding) radii; max 0 means no limit */
    /* Only bodies whose centre is in this region, or on a periodic axis one of its images. Null
       means anywhere. */
    const dem_region *region;
    int count;                     /* of bodies */
    /* Only these; ids of bodies that are gone do not count. Null means any. */
    const dem_body *bodies;
} dem_selection;
static const dem_selection DEM_SELECTION_ZERO = DEM_ZERO;
#define DEM_SELECTION DEM_SELECTION_ZERO
/* Returns the group with this name in desc.groups. */
DEM_API dem_group dem_group_get(const dem_world *world, const char *name);
/* Writes the ids of the selected bodies, in the order of their slots, at most `capacity`
   of them. Returns how many are selected, -1 on error. `out` or null, to count them. Selections
   are made between steps: laws and other functions that a step calls cannot make them. */
DEM_API int dem_bodies_select(const dem_world *world, const dem_selection *selection, dem_body *out,
                              int capacity);
/* Makes the selected bodies members of a group (member = 1), or takes them out (0). A body may be
   in many groups. Members stay members when bodies are sorted, restarted or dealt to slabs. Returns
   how many bodies are selected, -1 on error. */
DEM_API int dem_bodies_group_set(dem_world *world, const dem_selection *selection, dem_group group,
                                 int member);
/* Gives the selected bodies a velocity (m/s) and a spin (rad/s), as dem_body_set does. Returns
   their number, -1 on error. */
DEM_API int dem_bodies_velocity_set(dem_world *world, const dem_selection *selection,
                                    dem_vec3 velocity, dem_vec3 spin);
/* Freezes the selected bodies (fixed = 1), which then never move, or frees them (0). Returns their
   number, -1 on error. */
DEM_API int dem_bodies_fixed_set(dem_world *world, const dem_selection *selection, int fixed);
/* Removes the selected bodies, with one new list for all. Returns their number, -1 on error. */
DEM_API int dem_bodies_remove(dem_world *world, const dem_selection *selection);
/* Sums and means over selected bodies; zeros if there are none. */
typedef struct dem_bodies_means {
    int bodies;                    /* their number */
    double mass;                   /* kg, sum */
    double centre[3];              /* m, of mass; positions in the periodic box */
    double velocity[3];            /* m/s, of the centre of mass */
    double spin[3], radius;        /* rad/s and m: means over bodies */
    double force[3];               /* N, sum: of the last step, without gravity */
    double kinetic, rotational;    /* J, sums, those of fixed bodies included */
} dem_bodies_means;
/* Writes the sums and means of the selected bodies to `means`. */
DEM_API dem_result dem_bodies_means_get(const dem_world *world, const dem_selection *selection,
                                        dem_bodies_means *means);

/* The next five functions copy the numbers (desc.body_reals) of one body, of all bodies in the
   order of dem_bodies_get (count x real_count) or of a wall: out of the world (_get) or into it
   (_set). Values must be finite. Laws use them from the next step on. It is an error if
   desc.body_reals names none. */
DEM_API dem_result dem_body_reals_get(const dem_world *world, dem_body body, dem_real *reals);
DEM_API dem_result dem_body_reals_set(dem_world *world, dem_body body, const dem_real *reals);
DEM_API dem_result dem_bodies_reals_set(dem_world *world, const dem_real *reals);
DEM_API dem_result dem_wall_reals_get(const dem_world *world, dem_wall wall, dem_real *reals);
DEM_API dem_result dem_wall_reals_set(dem_world *world, dem_wall wall, const dem_real *reals);

/* ---- bodies that are not spheres ---- */

/* Adds an ellipsoid with these semi-axes (m, > 0) along x, y and z of its frame. The longest may be
   at most 1000 times the shortest. Not in planar worlds. */
DEM_API dem_shape dem_shape_ellipsoid_add(dem_world *world, dem_vec3 semi_axes);

/* How the mass properties of a cluster are found. */
typedef enum dem_cluster_mass {
    /* volume shared by several spheres counts once, integrated along parallel rays */
    DEM_CLUSTER_UNION = 0,
    DEM_CLUSTER_SUM,               /* every sphere counts in full */
    DEM_CLUSTER_GIVEN              /* volume, centre and inertia are given */
} dem_cluster_mass;
/* A rigid cluster of spheres, in a frame of your choice. */
typedef struct dem_cluster_desc {
    int count;                     /* required, 1 to 1000: number of spheres */
    const dem_real *positions;     /* m, required: count x 3 */
    const dem_real *radii;         /* m, > 0: one each; null means that all have `radius` */
    dem_real radius;               /* m, of all spheres if radii is null */
    dem_cluster_mass mass;
    /* DEM_CLUSTER_UNION: rays per side of the outline, 16 to 4096; 0 means 512. It is an error if
       rays are more than a quarter of the smallest radius apart. */
    int rays;
    /* The rest is for DEM_CLUSTER_GIVEN. */
    dem_real volume;               /* m3 */
    dem_vec3 centre;               /* m, centre of mass */
    /* m5, moments of inertia about the centre per density: xx, yy, zz, xy, xz, yz. Off-diagonal
       ones are elements of the tensor: xy is -(integral of x y). */
    dem_real inertia[6];
} dem_cluster_desc;
static const dem_cluster_desc DEM_CLUSTER_DESC_ZERO = DEM_ZERO;
#define DEM_CLUSTER_DESC DEM_CLUSTER_DESC_ZERO
/* Adds a cluster and computes its principal axes. Not in planar worlds. */
DEM_API dem_shape dem_shape_cluster_add(dem_world *world, const dem_cluster_desc *desc);

/* Faces of a polyhedron, at most. */
enum { DEM_POLYHEDRON_FACES = 100 };
#if !defined(DEM_NO_POLYHEDRA)
/* Adds a convex polyhedron: the convex hull of points (count x 3, m, 4 to 10,000), in a frame of
   your choice. Points inside the hull, or within 1e-10 of its size (single precision: 1e-6) of a
   face, are dropped. If more than DEM_POLYHEDRON_FACES faces remain, this tolerance is raised up to
   1e-5. It is an error if still more remain, or if the points lie in a plane. Not in planar worlds.
   Two polyhedra repel each other by a pressure field in the volume they share ([ELA19],
   >>polyhedra), a polyhedron and a sphere or ellipsoid at the nearest point. dem_contacts_get
   reports a contact of two polyhedra, or of one with a wall, as four points over which its force is
   spread; counters count it once. With impulses it has up to four points, each with its own gap
   (>>gaps); counters count the points with a repulsive force. */
DEM_API dem_shape dem_shape_polyhedron_add(dem_world *world, int count, const dem_real *points);
/* Adds the convex hull of a mesh (dem_mesh_read: STL, OBJ). It is an error, which says where, if
   the mesh lies deeper inside its hull than dent (m, >= 0; 0 accepts convex meshes only, up to
   round-off). The mesh must bound a body, as for dem_mesh_spheres; for an open mesh pass its
   vertices to dem_shape_polyhedron_add. Not in planar worlds. */
struct dem_mesh;
DEM_API dem_shape dem_shape_mesh_add(dem_world *world, const struct dem_mesh *mesh, dem_real dent);
#endif

/* Adds a union: count (1 to 1000) polyhedra, polygons or ellipsoids as one rigid body, in a frame
   of your choice. Each piece is a shape of this world, with a position (count x 3, m) and an
   orientation (count x 4; null means none is rotated). Mass, moments and contact forces are the
   sums over the pieces: overlapping pieces count twice. Clusters and unions cannot be pieces. */
DEM_API dem_shape dem_shape_union_add(dem_world *world, int count, const dem_shape *shapes,
                                      const dem_real *positions, const dem_real *orientations);
#if !defined(DEM_NO_POLYHEDRA)
/* Adds a polygon in a planar world: corners in sequence, clockwise or anticlockwise (count x 2, m,
   3 to 98). A concave polygon becomes the union of convex pieces, which are shapes too. The mass is
   density x area x desc.thickness. For contacts the polygon is a prism of thickness 4/3
   sqrt(area/pi), which gives it the volume of the sphere with the same area of cross-section. It is
   an error if sides cross. */
DEM_API dem_shape dem_shape_polygon_add(dem_world *world, int count, const dem_real *points);
#endif

/* Properties of a shape. */
typedef struct dem_shape_info {
    int spheres;                   /* of a cluster; otherwise 0 */
    int corners, faces;            /* of a polyhedron, or the prism of a polygon; otherwise 0 */
    dem_real volume;               /* m3 */
    dem_vec3 centre;               /* m, centre of mass in the frame in which the shape was given */
    dem_quat frame;                /* rotates the principal axes into that frame */
    dem_vec3 inertia;              /* m5, principal moments of inertia per density */
    dem_vec3 semi_axes;            /* m, of the ellipsoid with the same moments */
    /* m, of the smallest sphere about the centre that contains it (a polygon: its prism) */
    dem_real radius;
    int pieces;                    /* of a union; otherwise 0 */
} dem_shape_info;
/* Writes the properties of a shape to info. */
DEM_API dem_result dem_shape_get(const dem_world *world, dem_shape shape, dem_shape_info *info);

/* Adds a body of a shape at rest, with its centre of mass at position (m) and rotated by
   orientation (any length but 0) from the frame in which the shape was given. It is an error if a
   wall has no contact with this shape: DEM_EDGE_FRACTION profiles and some sieves (dem_sieve_kind)
   have none with ellipsoids and polyhedra; sieves, cones and other surfaces of revolution have none
   with polygons. */
DEM_API dem_body dem_body_add(dem_world *world, dem_material material, dem_shape shape,
                              dem_vec3 position, dem_quat orientation);
/* Adds count bodies of a shape, all or none. positions: count x 3, m. The other arrays may be null:
   orientations (count x 4: w, x, y, z; null: not rotated), velocities and spins (count x 3: m/s and
   rad/s in the world's frame; null: at rest), scales (count, > 0: factor on all lengths of the
   shape; null: 1). */
DEM_API dem_result dem_bodies_add(dem_world *world, dem_material material, dem_shape shape,
                                  int count, const dem_real *positions,
                                  const dem_real *orientations, const dem_real *velocities,
                                  const dem_real *spins, const dem_real *scales);
/* Adds up to count bodies of a shape in random orientations, as dem_spheres_fill does. Bounding
   spheres do not overlap, so that every body is free to rotate. */
DEM_API int dem_bodies_fill(dem_world *world, dem_material material, dem_shape shape,
                            dem_region region, int count, uint64_t seed);

/* An ellipsoid outside any world, for analysis. In m; orientation of any length, 0 means none. */
typedef struct dem_ellipsoid { dem_vec3 position, semi_axes; dem_quat orientation; } dem_ellipsoid;
/* The contact of two ellipsoids. */
typedef struct dem_ellipsoid_contact {
    /* W0: scaled by it about their centres, the two touch in one point. < 1 if they overlap. */
    dem_real scale;
    dem_real lambda;               /* 0 to 1, maximises the function of Perram and Wertheim */
    dem_vec3 point, normal;        /* m, of that contact; unit vector from a to b */
    /* m, overlaps as in dem_overlap; negative if the two are apart, where depth_chord is 0 */
    dem_real depth_normal, depth_chord, depth_conservative;
    int iterations;                /* evaluations of that function */
} dem_ellipsoid_contact;
/* Returns the contact of two ellipsoids. lambda is an initial guess, or 0. */
DEM_API dem_ellipsoid_contact dem_ellipsoids_contact_get(const dem_ellipsoid *a,
                                                     const dem_ellipsoid *b, dem_real lambda);

/* Numbers of bodies. inserted = present + removed + left holds at all times. `left` counts those
   that left through outflow boundaries and outlets. */
typedef struct dem_body_counts { uint64_t inserted, present, removed, left; } dem_body_counts;
/* Returns the numbers of bodies. */
DEM_API dem_body_counts dem_body_counts_get(const dem_world *world);
