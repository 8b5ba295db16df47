/* ---------------------------------------------------------------------------------------------
   >>machine
   What grains collide with and where they come from: walls and their motions, joints, feeds and
   outlets. Errors and descs are as in >>scene.
   --------------------------------------------------------------------------------------------- */

/* ---- walls ---- */
/* Walls repel grains and move as prescribed; grains do not move them. Functions that add a wall
   copy their data. In a periodic world a finite wall that is not longer than the period repeats
   along that axis. A longer one does not: it must extend beyond both faces by the largest radius
   and the range of the law, or the next step fails. */

/* The kind of a wall's motion. */
typedef enum dem_motion_kind {
    DEM_MOTION_FIXED = 0,          /* at rest */
    DEM_MOTION_TRANSLATING,        /* with `velocity` */
    DEM_MOTION_ROTATING,           /* at `speed` about `axis` through `point`, right-handed */
    /* displaced by velocity/|velocity| amplitude sin(2 pi frequency t + phase), t = time - start.
       If sin(phase) is not 0, only with a ramp or before the first step: the wall would jump */
    DEM_MOTION_OSCILLATING,
    DEM_MOTION_USER,               /* as `function` says */
    DEM_MOTION_TABLE,              /* through the poses of `table`, smoothly */
    DEM_MOTION_SERVO               /* along `velocity`, to and fro, so that grains bear `load` */
} dem_motion_kind;
/* A pose or, for DEM_MOTION_SERVO, a load of a wall at a time. */
typedef struct dem_motion_row {
    double time;                   /* s, after start; the first is 0, ascending */
    dem_vec3 position;             /* m, displacement from the pose in which the motion started */
    dem_quat rotation;             /* from that pose, about the displaced `point`; 0: not rotated */
    dem_real load;                 /* N, or Pa: see `load` of dem_motion; used instead of a pose */
} dem_motion_row;
/* The motion of a wall. It starts from the pose that the wall has when dem_wall_motion_set is
   called. */
typedef struct dem_motion {
    dem_motion_kind kind;
    /* m/s, of translating walls; of oscillating ones the direction only; of servo walls the
       direction in which they press, and their largest speed */
    dem_vec3 velocity;
    /* m; point and direction of the axis of rotation, to which dem_wall_loads also refers torques;
       axis 0 means along z. Rotating walls need an axis. */
    dem_vec3 point, axis;
    dem_real speed;                /* rad/s, of rotating walls */
    dem_real amplitude, frequency, phase;  /* m, Hz, rad: of oscillating walls */
    /* s. Until then rotating, translating and servo walls are at rest. A time in the past means
       now. */
    double start;
    /* The function of DEM_MOTION_USER. It must not rotate a mesh or profile that spans a period,
       because the ends stay joined to those of its images: use a table. */
    dem_motion_fn function;
    void *user;                    /* passed to function */
    /* s, >= 0. The speed (translating, rotating), amplitude (oscillating) or load (servo) rises as
       3 u^2 - 2 u^3, u = (time - start)/ramp, to its full value. 0 means at once. */
    double ramp;
    /* N, of servo walls: the force with which the wall presses the grains along `velocity`. A table
       replaces it: linear between rows, constant after the last. Servo walls whose motions are
       equal are one piston and bear the load together. They need DEM_RESPONSE_SPRINGS. */
    dem_real load;
    dem_real area;                 /* m2, >= 0: load is a stress (Pa) on it; 0 means a force (N) */
    dem_real travel;               /* m, >= 0, of servo walls: largest distance; 0 means no limit */
    /* The rows of DEM_MOTION_TABLE, at least 2. Between rows the pose is a cubic, so that velocity
       and spin are continuous (tangents of the parabola through three rows). The wall is at rest
       before the first row and after the last. With table_repeats = 1 the table starts again after
       its last row, which should equal the first. From row to row the wall rotates by less than
       pi. */
    const dem_motion_row *table;
    int table_count, table_repeats;
} dem_motion;
static const dem_motion DEM_MOTION_ZERO = DEM_ZERO;
#define DEM_MOTION DEM_MOTION_ZERO

/* How the segments of a profile share the force of a grain that touches several. */
typedef enum dem_edge_rule {
    /* The profile acts as one surface, however it is divided (>>facets): a flat one exerts exactly
       the force of a plane. */
    DEM_EDGE_RESOLVED = 0,
    /* [MIL] Fig 5.19: each segment exerts the force along the normal of its own line times a^2 (3 -
       2a), where a is its fraction of the chord inside the grain. Only for spheres and clusters,
       and without law_range. */
    DEM_EDGE_FRACTION
} dem_edge_rule;

/* A triangle mesh: vertex_count x 3 coordinates (m), triangle_count x 3 vertex numbers from 0. */
typedef struct dem_mesh { int vertex_count, triangle_count; dem_real *vertices;
                         int32_t *triangles; } dem_mesh;
/* A profile: vertex_count x 2 coordinates (m), segment_count x 2 vertex numbers from 0. */
typedef struct dem_profile { int vertex_count, segment_count; dem_real *vertices;
                            int32_t *segments; } dem_profile;

/* Adds a plane through point (m). Grains are on the side to which normal points. */
DEM_API dem_wall dem_wall_plane_add(dem_world *world, dem_material material, dem_vec3 point,
                               dem_vec3 normal);
/* Adds an infinite cylinder of radius (m) about an axis through point (m). Grains are inside if
   inside = 1, and outside if inside = 0. */
DEM_API dem_wall dem_wall_cylinder_add(dem_world *world, dem_material material, dem_vec3 point,
                                  dem_vec3 axis,
                                  dem_real radius, int inside);
/* Adds a surface of revolution about an axis through point (m): straight pieces between count (2 to
   DEM_RINGS) rings of these radii (m, >= 0) at these heights (m, along the axis from point). It can
   be a finite cylinder, a cone, a disc with a hole, a tube with a funnel or a drum with its ends.
   Both sides repel. In an inner corner a grain touches both pieces; at an outer corner and at a rim
   it touches the ring. A grain too wide for a narrow part touches one side of it only. Ellipsoids
   and, with springs, polyhedra touch facets in its place (>>tessellate). Polygons have no contact
   with it; use a profile. */
enum { DEM_RINGS = 12 };
DEM_API dem_wall dem_wall_revolved_add(dem_world *world, dem_material material, dem_vec3 point,
                                  dem_vec3 axis, int count, const dem_real *radii,
                                  const dem_real *heights);
/* Adds one piece of a surface of revolution: an open cone between two points (m) with these radii
   (m, >= 0, not both 0). Equal radii make a finite cylinder. */
DEM_API dem_wall dem_wall_cone_add(dem_world *world, dem_material material, dem_vec3 from,
                                   dem_vec3 to,
                              dem_real radius_from, dem_real radius_to);
/* Adds a profile: segments in the x-y plane, extruded along z without end. Both sides repel. */
DEM_API dem_wall dem_wall_profile_add(dem_world *world, dem_material material,
                                 const dem_profile *profile,
                                 dem_edge_rule rule);
/* Adds a triangle mesh. Both sides repel. Meshes that do not move relative to each other act as one
   surface, however it is divided; so do profiles (>>surfaces). A wall is at rest until its motion
   begins. */
DEM_API dem_wall dem_wall_mesh_add(dem_world *world, dem_material material, const dem_mesh *mesh);
/* Adds a wall of spheres of one radius (m) at positions (count x 3, m), as in [MIL]. All forces are
   multiplied by share (0 < share <= 1), because overlapping spheres represent one surface. */
DEM_API dem_wall dem_wall_grains_add(dem_world *world, dem_material material, int count,
                                     const dem_real *positions,
                                     dem_real radius, dem_real share);

/* The kind of a sieve. Spheres and clusters have contact with all sieves, ellipsoids and polyhedra
   with infinite sieves except DEM_SIEVE_REDUCED, polygons with none. Ellipsoids and, with springs,
   polyhedra on plates without thickness touch facets in their place (>>tessellate). */
typedef enum dem_sieve_kind {
    DEM_SIEVE_NONE = 0,
    DEM_SIEVE_WIRES,               /* a square weave of round wires */
    DEM_SIEVE_BARS,                /* parallel round wires, across `along` */
    DEM_SIEVE_SQUARE,              /* a plate with square holes */
    DEM_SIEVE_ROUND,               /* a plate with round holes */
    DEM_SIEVE_SLOTS,               /* a plate with slots, longer along `along` */
    /* [ALK07] 4.3.3: a plane through which a sphere falls without contact if it is near enough to
       the middle of a square hole (dem_sieve_desc.model). It is cheaper and never blinds, but the
       clearance decides what passes. */
    DEM_SIEVE_REDUCED
} dem_sieve_kind;
/* A sieve: a plane with rows of holes, infinite or cut out as a disc. The cost per sphere does not
   depend on the number of holes; that of a polyhedron on a plate grows with the holes below it. */
typedef struct dem_sieve_desc {
    dem_sieve_kind kind;           /* required */
    dem_vec3 point;                /* m, centre of a hole, at half the thickness */
    dem_vec3 normal;               /* across the sieve; 0 means along z */
    /* Direction of the rows of holes; 0 means along x, or y if x is near the normal. The same holds
       for a direction within 0.001 rad of the normal. */
    dem_vec3 along;
    dem_real aperture;             /* m, required, > 0: clear width, side or diameter of a hole */
    dem_real bar;                  /* m, required, > 0: wire diameter, or width between two holes */
    dem_real length;               /* m, of slots, >= aperture; 0 means infinite */
    dem_real thickness;            /* m, of plates; 0 means a sheet with sharp rims */
    /* m, between the axes of the two layers of wires; 0 means one plane. `bar` puts one layer on
       the other; real wires wind between the two. */
    dem_real lift;
    int staggered;                 /* 1 puts round holes in a triangular pattern */
    dem_real radius;               /* m, of the disc; 0 means an infinite sieve */
    /* Rule of reduced holes. A sphere smaller than the hole falls if its centre is within (1 -
       clearance) b of the middle of the hole in both directions: b = aperture/2 - radius (model 0
       or 1) or aperture/2 (model 2) [ALK07] eq 4.20, 4.21. Once it falls, it falls to the end. */
    int model;
    dem_real clearance;            /* reduced holes: 0 open, 1 closed; zeta of [ALK07] */
} dem_sieve_desc;
static const dem_sieve_desc DEM_SIEVE_DESC_ZERO = DEM_ZERO;
#define DEM_SIEVE_DESC DEM_SIEVE_DESC_ZERO
/* Adds a sieve. */
DEM_API dem_wall dem_wall_sieve_add(dem_world *world, dem_material material,
                                    const dem_sieve_desc *desc);
/* Returns how many grains, clusters included, blind a sieve. Such a grain is stuck in a hole: it
   touches the sieve on opposite sides, and the wedge between the two contacts is so narrow that
   friction holds the grain. Grains faster than speed (m/s, relative to the sieve; 0 means any) do
   not count. Reduced holes never blind. Returns -1 on error, also while there is no list of
   contacts (see dem_contacts_get). */
DEM_API int dem_sieve_blinded_get(const dem_world *world, dem_wall sieve, dem_real speed);

/* Sets the motion of a wall, from its present pose on. Bodies on its rails follow at once. */
DEM_API dem_result dem_wall_motion_set(dem_world *world, dem_wall wall, const dem_motion *motion);
/* Sets the velocity of the surface of a wall (m/s), for a belt: the wall does not move with it. The
   velocity is in world axes and rotates with the wall from now on. At a contact the surface moves
   with the part of it across the contact normal, so a curved or closed surface moves along itself
   everywhere, also at rims. 0 stops it. */
DEM_API dem_result dem_wall_surface_velocity_set(dem_world *world, dem_wall wall,
                                                 dem_vec3 velocity);
/* Writes the velocity of the surface, in present world axes, to velocity. */
DEM_API dem_result dem_wall_surface_velocity_get(const dem_world *world, dem_wall wall,
                                                 dem_vec3 *velocity);
/* Writes the present pose of a wall to pose. */
DEM_API dem_result dem_wall_pose_get(const dem_world *world, dem_wall wall, dem_pose *pose);
/* Removes a wall. Ids of other walls stay valid. It is an error if an outlet moves with it. */
DEM_API dem_result dem_wall_remove(dem_world *world, dem_wall wall);

/* The loads of grains on a wall. Torques are about the point of its motion (of a wall without a
   motion: its own point, or the origin for profiles, meshes and walls of grains). */
typedef struct dem_wall_loads {
    dem_vec3 force;                /* N, of the last step */
    dem_vec3 torque;               /* N m, of the last step */
    dem_real torque_axial;         /* N m, component along the axis of its motion */
    /* W, from the wall to the grains: -(force . v + torque . w), and the power of friction on a
       surface that moves in itself (dem_wall_surface_velocity_set) */
    dem_real power;
    int contacts;                  /* present number */
    int touched;                   /* 1 if a grain has touched the wall since it was added */
    /* All that follow except `rate` are sums since dem_wall_loads_reset. */
    double impulse[3];             /* N s */
    double torque_impulse;         /* N m s, of torque_axial */
    double work;                   /* J, from the wall to the grains */
    double time;                   /* s, over which these sums extend */
    /* per s, last step: what laws gave to its numbers (desc.body_reals), in their units */
    double rate[DEM_BODY_REALS];
    double gained[DEM_BODY_REALS]; /* its sum over time */
} dem_wall_loads;
/* Writes the loads of a wall to loads. */
DEM_API dem_result dem_wall_loads_get(const dem_world *world, dem_wall wall, dem_wall_loads *loads);
/* Sets the sums of a wall's loads to 0. */
DEM_API dem_result dem_wall_loads_reset(dem_world *world, dem_wall wall);

/* ---- joints ---- */
/* Joints connect a body to another body, to a wall or to space. They need DEM_RESPONSE_IMPULSES and
   DEM_SOLVER_GAUSS_SEIDEL. After every sweep over the contacts all joints are solved together by a
   direct method; those of closed loops have a softness of 1e-6 of the inverse effective mass. The
   joined points and axes coincide in the middle of the next step, where contacts are found, too.
   Impulses of joints never add energy, for any number of sweeps (docs/impulses.md). Two bodies that
   are joined have no contact with each other unless `collide` is 1. */
typedef enum dem_joint_kind {
    DEM_JOINT_NONE = 0,
    /* a ball joint: keeps `point` of both together */
    DEM_JOINT_POINT,
    /* a hinge or axle: keeps `axis` of both together too */
    DEM_JOINT_REVOLUTE
} dem_joint_kind;
/* The motor of a revolute joint. */
typedef enum dem_motor {
    DEM_MOTOR_NONE = 0,
    DEM_MOTOR_SPEED,               /* rotates a against b at `speed`, by at most `torque` */
    DEM_MOTOR_TORQUE               /* exerts `torque` on a, and the opposite on b */
} dem_motor;
typedef struct dem_joint { int32_t id; } dem_joint;                          /* id counts from 1 */
/* A joint. Its point and axis refer to the present poses of the bodies. */
typedef struct dem_joint_desc {
    dem_joint_kind kind;           /* required: how the two are joined */
    dem_motor motor;
    dem_body a, b;                 /* a is required; b null means `wall`, or space */
    dem_wall wall;                 /* if b is null: moves with it; null means space, at rest */
    int collide;                   /* 1: the two bodies may touch each other */
    dem_vec3 point;                /* m, where the two are joined */
    dem_vec3 axis;                 /* of a revolute joint, not 0; planar worlds: along z */
    /* rad/s, of a against b about axis, right-handed; at most 1e12 in size */
    dem_real speed;
    /* N m, on a about axis; at most 1e12 in size. DEM_MOTOR_SPEED: the largest torque, >= 0; 0
       means no limit. */
    dem_real torque;
} dem_joint_desc;
static const dem_joint_desc DEM_JOINT_DESC_ZERO = DEM_ZERO;
#define DEM_JOINT_DESC DEM_JOINT_DESC_ZERO
/* The state of a joint. */
typedef struct dem_joint_state {
    /* N, N m about the joined point: on a (b has the opposite), of the last step, with the motor */
    dem_vec3 force, torque;
    dem_real motor_torque;         /* N m, on a about axis, of the last step */
    dem_real power;                /* W, from the motor to a and b; 0 without a motor */
    /* in the middle of the coming step: m between the points; sine of the angle of the axes */
    dem_real gap, tilt;
    double turned;                 /* rad, of a against b about axis since the joint was added */
    double work;                   /* J, of the motor */
} dem_joint_state;
#ifndef DEM_NO_IMPULSES
/* Adds a joint. It is an error if the response is DEM_RESPONSE_SPRINGS, if neither of the two can
   move, or if a sphere is joined without desc.orientations. A joint ends when one of its bodies or
   its wall is removed or leaves; its id is then invalid and is never used again. While both bodies
   are fixed, force, torque and power are 0; the joint acts again when one is released. Checkpoints
   contain joints. */
DEM_API dem_joint dem_joint_add(dem_world *world, const dem_joint_desc *desc);
/* Replaces the motor of a joint from the next step on. The values are those of dem_joint_desc. */
DEM_API dem_result dem_joint_motor_set(dem_world *world, dem_joint joint, dem_motor motor,
                                   dem_real speed, dem_real torque);
/* Writes the state of a joint to state. */
DEM_API dem_result dem_joint_get(const dem_world *world, dem_joint joint, dem_joint_state *state);
/* Removes a joint. */
DEM_API dem_result dem_joint_remove(dem_world *world, dem_joint joint);
#endif /* DEM_NO_IMPULSES */

/* ---- rails ---- */
/* A rail locks axes of a body: along and about them it does not respond to forces, but moves as
   prescribed. It needs DEM_RESPONSE_SPRINGS. Slabs and periodic cells that deform refuse rails. It
   is an error if the body is fixed, and in planar worlds to lock Z, SPIN_X or SPIN_Y. */

/* The axes of the world that a rail locks, as a sum: of translation, then of rotation. */
enum { DEM_RAIL_X = 1, DEM_RAIL_Y = 2, DEM_RAIL_Z = 4, DEM_RAIL_SPIN_X = 8, DEM_RAIL_SPIN_Y = 16,
       DEM_RAIL_SPIN_Z = 32, DEM_RAIL_ALL = 63 };
/* A rail. Components of velocity and spin along axes that are not locked are ignored. */
typedef struct dem_rail_desc {
    int axes;                      /* 0 to 63: sum of DEM_RAIL_ constants; 0 means no rail */
    dem_vec3 velocity;             /* m/s, along locked axes */
    dem_vec3 spin;                 /* rad/s, about locked axes */
    /* Along and about locked axes the body also follows the pose of this wall, as if it were part
       of it, so any motion of a wall is a path for a body. Null means none, as after the removal of
       the wall. */
    dem_wall wall;
} dem_rail_desc;
static const dem_rail_desc DEM_RAIL_DESC_ZERO = DEM_ZERO;
#define DEM_RAIL_DESC DEM_RAIL_DESC_ZERO
/* The reaction of a rail: what it exerts on the body. */
typedef struct dem_rail_state {
    dem_rail_desc desc;            /* as set */
    dem_vec3 force;                /* N, at the present time */
    dem_vec3 torque;               /* N m, about the body's centre */
    double power;                  /* W, of the rail on the body */
    double work;                   /* J, since the rail was set */
} dem_rail_state;
/* Puts a body on a rail, changes its rail, or takes it off (axes 0). Its velocity and spin along
   locked axes become the prescribed ones at once. The forces and torques of dem_body_get include
   those of the rail. */
DEM_API dem_result dem_body_rail_set(dem_world *world, dem_body body, const dem_rail_desc *desc);
/* Writes the state of a body's rail to state. It is an error if the body has none. */
DEM_API dem_result dem_body_reaction_get(const dem_world *world, dem_body body,
                                         dem_rail_state *state);

/* ---- feed and outlets ---- */
enum { DEM_CLASSES = 16 };         /* largest number of size classes */
enum { DEM_RESIDENCE_BINS = 64 };  /* bins of the distribution of residence times */
typedef struct dem_feed { int32_t id; } dem_feed;                            /* id counts from 1 */
typedef struct dem_outlet { int32_t id; } dem_outlet;                        /* id counts from 1 */

/* A feed adds grains while the world runs, at random free positions in a region (free as in
   dem_spheres_fill), at a rate or all at once. A grain for which there is no room waits; none is
   lost. Most grains join the present neighbour list. The list is rebuilt for the first grain of a
   new radius or material, and for every grain if the world has bodies that are not spheres. */
typedef struct dem_feed_desc {
    dem_material material;         /* required */
    int class_count;               /* required, 1 to 16: size classes */
    dem_real radius[DEM_CLASSES];  /* m, required */
    /* > 0: relative amounts of the classes, or with `limited` grains (kg with by_mass) */
    double amount[DEM_CLASSES];
    int limited;                   /* 1: the feed ends after `amount`, drawn without replacement */
    int by_mass;                   /* 1: amount and rate are in kg and kg/s instead of grains */
    /* 1/s, grains due; 0 means all as room permits, and needs limited */
    double rate;
    /* s, time of the world. A feed that is added later catches up with what was due since start. */
    double start;
    double end;                    /* s, 0 or >= start; 0 means no end */
    dem_box box;                   /* m, required: centres lie inside (dem_region: whole bodies) */
    int round;                     /* 1: only the vertical elliptic cylinder inscribed in the box */
    dem_vec3 velocity;             /* m/s, of new grains */
    dem_real spread;               /* m/s, largest random change of each component of velocity */
    uint64_t seed;                 /* of random positions, sizes and velocities */
    dem_inside_fn inside;          /* restricts the box further, as in dem_region */
    void *inside_user;             /* passed to inside */
    /* A mixture: for each class, if not 0, its material; its shape, in random orientations and with
       the volume of a sphere of `radius`; and the distribution of its radius (copied). */
    dem_material materials[DEM_CLASSES];
    dem_shape shapes[DEM_CLASSES];
    const dem_sizes *sizes[DEM_CLASSES];
} dem_feed_desc;
static const dem_feed_desc DEM_FEED_DESC_ZERO = DEM_ZERO;
#define DEM_FEED_DESC DEM_FEED_DESC_ZERO
/* The state of a feed. */
typedef struct dem_feed_state {
    uint64_t fed[DEM_CLASSES], total;  /* grains added, per class and in all */
    double mass;                   /* kg, added */
    uint64_t waiting;              /* grains due but without room; by mass at a rate: 0 or 1 */
    int done;                      /* 1: no more grains will be added */
} dem_feed_state;
/* Adds a feed. */
DEM_API dem_feed dem_feed_add(dem_world *world, const dem_feed_desc *desc);
/* Writes the state of a feed to state. */
DEM_API dem_result dem_feed_get(const dem_world *world, dem_feed feed, dem_feed_state *state);

/* An outlet removes the grains, fixed ones included, whose centre is in a region, and counts them;
   dem_body_counts counts them as left. It checks whenever the neighbour list is rebuilt and every
   64 steps: a grain is up to half a skin or 64 steps inside before it is removed, so that many
   grains that leave one by one cost little. A region thinner than half a skin may miss grains.
   Bodies that are not spheres count with the radius of their bounding sphere.
   With `keep` an outlet only counts the grains that enter, go back and are inside. The discharge
   through a plane is what enters the box behind it. */
typedef struct dem_outlet_desc {
    dem_wall frame;                /* the region moves with this wall; null means at rest */
    /* m, required, in that frame; lo < hi on every axis (planar worlds: z may be 0 to 0) */
    dem_box box;
    dem_real beyond;               /* m: only grains this far or farther from the frame's z axis */
    dem_real wanted_min, wanted_max;  /* m, radii meant to leave here; max 0 means no limit */
    int class_count;               /* size classes to count in, 0 to 16 */
    dem_real radius[DEM_CLASSES];  /* m, ascending; a grain counts in the nearest class */
    dem_material material;         /* only grains of this material; id 0 means all */
    int keep;                      /* 1: grains stay and are only counted; at most 16 such */
    /* s, >= 0: width of a bin of residence times, which run from the insertion of a grain (grains
       that were there before: from dem_outlet_add) until the outlet counts it; 0: not measured */
    double residence_bin;
} dem_outlet_desc;
static const dem_outlet_desc DEM_OUTLET_DESC_ZERO = DEM_ZERO;
#define DEM_OUTLET_DESC DEM_OUTLET_DESC_ZERO
/* The counts of an outlet: grains that were removed or, with `keep`, that entered. */
typedef struct dem_outlet_state {
    uint64_t count[DEM_CLASSES], total;     /* grains, per class and in all */
    double mass[DEM_CLASSES], total_mass;   /* kg */
    uint64_t sorted, gangue;       /* grains of wanted radii, and others: [ALK07] s_i and g_i */
    double sorted_mass, gangue_mass;        /* kg */
    double since, last;            /* s: when counting began; when the last grain was counted */
    /* `keep` only: grains that went back, and grains that are inside now. Grains that were inside
       when counting began have not entered. */
    uint64_t back[DEM_CLASSES], held[DEM_CLASSES], back_total, held_total;
    double back_mass[DEM_CLASSES], held_mass[DEM_CLASSES];      /* kg */
    double back_total_mass, held_total_mass;                    /* kg */
    /* residence_bin only: sums over the counted grains, per class, of their residence times, s, and
       of the squares, s2: the mean of class k is residence[k]/count[k]. Grains per bin; the last
       bin has all longer times. */
    double residence[DEM_CLASSES], residence_square[DEM_CLASSES];
    uint64_t residence_count[DEM_RESIDENCE_BINS];
} dem_outlet_state;
/* Adds an outlet. The wall that is its frame cannot be removed. */
DEM_API dem_outlet dem_outlet_add(dem_world *world, const dem_outlet_desc *desc);
/* Writes the counts of an outlet to state. */
DEM_API dem_result dem_outlet_get(const dem_world *world, dem_outlet outlet,
                                  dem_outlet_state *state);
/* Sets the counts of an outlet to 0. dem_body_counts stays; grains inside have not entered. */
DEM_API dem_result dem_outlet_reset(dem_world *world, dem_outlet outlet);
