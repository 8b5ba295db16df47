/* ---------------------------------------------------------------------------------------------
   >>layout
   The layout of the world, and the only places where memory comes from. Bodies live in flat arrays
   of four reals each, so that a gather touches one cache line and a drift is one long loop. Every
   array that grows is a field here; DEMI_GROW keeps what it holds, or leaves it alone and says so.

   Words of the code, beside those of the glossary:
       domain              a work group of some 2000 neighbouring bodies
       persistent contact  any contact other than sphere on sphere, for example with a wall. It is
                           stored in a list of its own and followed from step to step
       pruned neighbour list   the candidates that may touch within some steps; forces are computed
                           for these only
       species             spheres with the same material, radius and mass, all fixed or all free
       tile                some 32 or 64 pairs whose forces are computed together
   --------------------------------------------------------------------------------------------- */
enum { DEMI_MATERIALS = 64, DEMI_MEMORY = DEM_LAW_MEMORY + 1, DEMI_SOME = 16, DEMI_DOMAINS = 256,
      DEMI_LANES = 64/(int)sizeof(dem_real),    /* pairs computed together: widest vectors */
      DEMI_TILE = 4*DEMI_LANES,                 /* pairs computed at a time */
      DEMI_ROOM = DEMI_TILE + 16,                /* of a column of a tile: columns a power of two
                                                   apart would compete for the same cache lines */
      DEMI_NEAR_BALLS = 31, DEMI_BALLS_UNKNOWN = 255, DEMI_BALLS_ALL = 254 };

/* Coefficients of one contact, resolved: what the built-in laws need. */
enum { DEMI_KN, DEMI_CN, DEMI_KT, DEMI_CT, DEMI_MU, DEMI_MU_STATIC, DEMI_MU_ROLL, DEMI_R_EFF,
      DEMI_K_UN, DEMI_K_AD,                     /* hysteretic law */
      DEMI_COEFS };

/* Memory that a world holds hangs on one of two chains (demi_hold): what belongs to the scene and
   outlives a restart (materials, shapes, geometry of walls), and what a run works with. */
enum { DEMI_LOOSE, DEMI_SCENE, DEMI_RUN, DEMI_CHAINS };
struct demi_block;

/* Candidate pairs of all domains. Domain d owns entries d*stride .. d*stride + stride - 1. */
typedef struct demi_list {
    int stride;                    /* capacity per domain */
    int32_t *a, *b;                /* body indices, a < b */
    int32_t *place;                /* 1 + its entry in the near list, 0 when not near */
    unsigned char *image;          /* where in image_shift that stands which leads from a to b */
} demi_list;

/* Of two bodies that are near, which spheres of theirs are: part a[k] of one, b[k] of the other, in
   the order of contacts. >>kept notes them when it is first asked about the pair. */
typedef struct demi_near_balls {
    uint8_t count;                 /* DEMI_BALLS_UNKNOWN: not looked at since the list was made;
                                      DEMI_BALLS_ALL: no room for them */
    uint8_t a[DEMI_NEAR_BALLS], b[DEMI_NEAR_BALLS];
} demi_near_balls;
/* Near pairs of all domains: those candidates that touch or might before long. Domain d owns
   entries d*stride .. as above: pairs inside it, then, from a multiple of DEMI_LANES on, those that
   lead out. Numbers of a pair stand in columns: value e of the domain's entry p at
   memory[(d*columns + e)*stride + p]. */
typedef struct demi_near {
    int stride;                    /* capacity per domain, a multiple of DEMI_LANES */
    int32_t *a, *b, *k;            /* bodies, and their entry in the list of candidates */
    unsigned char *image;
    demi_near_balls *balls;        /* no room for them where all bodies are spheres */
    dem_real *memory;              /* w->memory_stride columns; zeros while a pair does not touch */
    int32_t *row;                  /* of species_coef; null where bodies are all alike, or of more
                                      species than have a table: */
    dem_real *coef;                /* then DEMI_PAIR_COLUMNS columns */
} demi_near;
enum { DEMI_M_EFF = DEMI_COEFS, DEMI_PAIR_COLUMNS };
/* Spheres alike in all that coefficients hang on. Every two of up to DEMI_SPECIES have a row of
   coefficients in a table; where there are more (radii drawn at random), near pairs have theirs. */
enum { DEMI_SPECIES = 32 };
typedef struct demi_species {
    dem_real radius, mass, inv_mass;           /* m; kg; 1/kg, 0: fixed */
    int32_t material, none;        /* 1 + index; 0, so that no byte of it is unknown */
} demi_species;

/* Sums of one domain over one step; combined in the order of domains. */
enum { DEMI_E_DASHPOT, DEMI_E_ELASTIC, DEMI_E_SHEAR_WORK, DEMI_E_SLIDE, DEMI_E_SHEAR_STORED,
      DEMI_E_ROLL,
       DEMI_E_GRAVITY, DEMI_E_FORCE, DEMI_E_WALLS, DEMI_E_TOLD, DEMI_ENERGIES };

/* Where a body touches a wall, before it is known what the law will say (see >>touch). */
typedef struct demi_touching {
    int32_t element;               /* of the wall; of facets: number of the face, edge or corner */
    dem_real overlap, share;       /* m; how often its force counts (facets: index, see >>facets) */
    dem_vec3 normal, point;        /* unit, body -> wall; m */
    dem_vec3 shift;                /* m, from the body to its image that the wall meets */
    dem_vec3 spread;               /* of polyhedra, as in demi_kept */
    dem_real slope, couple, deep;
    int32_t corner, corners;
} demi_touching;
/* A side or corner of a facet that a body reaches: what joins it to its neighbours (>>touch). */
typedef struct demi_link {
    dem_real distance;             /* in the body's measure */
    int32_t number, corner;        /* of the side (corner 0) or corner (1) */
    int32_t facet;                 /* among those reached */
    int32_t sides[2];              /* of a corner: the facet's sides there */
    int32_t place;                 /* where the side is nearest: its number, or a corner's */
    int32_t root;                  /* of facet i, in link i: union and find */
    dem_real more;                 /* how much more its place counts by pieces */
    dem_vec3 point;                /* from the body's centre */
} demi_link;

/* One of a union: which of the world's shapes; its centre, m, and its principal axes in the
   union's. */
typedef struct demi_piece { int32_t shape; dem_vec3 at; dem_quat q; } demi_piece;
/* A shape, in its principal frame, per unit of mass and scale. */
typedef struct demi_shape {
    int kind;                      /* of its parts: DEMI_BALL, ...; of a union's first */
    int count;                     /* spheres of a cluster; 0: it is one part */
    dem_real *parts;               /* count x 4: centre, radius, m */
    dem_vec3 axes;                 /* m, of one part: lengths as its kind has them */
    int pieces;                    /* of a union; 0: it is none */
    demi_piece *piece;
    int corners, faces;            /* of a polyhedron */
    double *hull;                  /* faces x 4: unit normal over height, 1/m; height over the
                                      centre, m; then corners x 3, m */
    int32_t *rim;                  /* faces + 1 starts; then corners, turning left from outside */
    dem_vec3 inertia;              /* m2, principal moments per mass */
    double volume;                 /* m3 */
    dem_real radius;               /* m, of the bounding sphere */
    dem_real moment_arm;           /* m, how far from the centre a force may pass at most */
    dem_real thin, blunt, equal;   /* m, radii: smallest, of the flattest place, of equal volume */
    double light;                  /* share of the mass that a contact feels at least */
    dem_quat frame;                /* principal axes -> the frame it was given in */
    dem_vec3 centre;               /* m, centre of mass in that frame */
} demi_shape;

/* A contact that is kept by itself: every one but those of sphere and sphere, whose memory stands
   in the columns of the near list. Lives as long as the two touch. Within a domain they stand in
   the order of body a, pairs before walls, and that is the order in which forces are added. touch
   makes the list of a step from nothing (kept_next), each naming the one it continues among those
   of the step before (kept_now); respond takes over what is remembered and answers; then the two
   lists change places. So touch may begin anew, and nothing is lost when it runs out of room. */
typedef struct demi_kept {
    int32_t a, b;                  /* bodies (slots while there is no list); b -1: a wall */
    int32_t part_a, part_b;        /* spheres of clusters, else 0 */
    int32_t wall, element;
    int32_t send;                  /* 1 + where the force on b goes; 0: b is of this domain; with a
                                      wall: 1 + which of a step ago has ended in it; 0: none */
    int32_t from;                  /* which of its domain's a step ago it continues; -1: none */
    int32_t corner, corners;       /* which of how many of a polyhedron's contact; 0: alone */
    dem_vec3 normal, arm_a, arm_b; /* unit, a -> b; m, from the centres to where they push */
    dem_real overlap, deep;        /* m, 0: under way through a reduced hole, < 0: apart, see
                                      demi_kept_asked; over the smaller half width along the
                                      normal, of a sphere its radius */
    dem_real share, lift, grip;    /* how often it counts: damping, elastic force, friction */
    dem_real weight;               /* share before contacts are shared: see demi_kept_share */
    dem_real held;                 /* grip that comes to it from a step ago, < 0: all of it: see
                                      demi_kept_inherit */
    dem_real area, added, rate;    /* m2, A; what others add to it, over d^2; how A follows that */
    dem_real bend;                 /* 1/m: the normal turns by this times the way part_a goes */
    dem_vec3 axis;                 /* but for ways along the normal, and along this, if not 0: */
    dem_real along;                /* there by this, 1/m */
    dem_vec3 aside;                /* elastic force across the normal, over that along it */
    dem_real slope;                /* m of overlap per m of approach */
    dem_real inset;                /* the normal force passes at this part of arm_a */
    dem_vec3 spread;               /* m, from the centre of pressure to this corner */
    dem_real couple;               /* m: moment about the normal, over the normal force */
    dem_real r_eff, m_eff;         /* m; kg, of a sphere on a wall, by respond; else 0, see: */
    dem_vec3 felt;                 /* m, to here from where bodies are felt: their mass there is
                                      what dashpots go by */
    double lambda;                 /* of Perram and Wertheim, where to begin next; 0: unknown */
    dem_vec3 force;                /* N, on a */
    dem_vec3 shift;                /* with a wall: as above */
    /* what goes from step to step: respond writes it, touch does not */
    dem_real coef[DEMI_COEFS], root[2];        /* see demi_coefficients_rooted */
    dem_real coef_r;               /* m, what they are for: worked out anew when r_eff changes; 0:
                                      there are none yet */
    dem_real memory[DEMI_MEMORY];
} demi_kept;

/* What the grains of one domain do to one wall in one step. */
typedef struct demi_wall_sum { double force[3], torque[3], power; int contacts; } demi_wall_sum;

/* A domain: bodies that stand next to each other in the arrays, since the sort has put together
   what is near. It is what one thread works on at a time, and what the order of every sum
   follows: how many domains there are, and where they begin, is told by the number of bodies
   alone. A contact belongs to the domain of its lower body; a force on a body of a later domain
   waits in a slot and is fetched there, in the order of the list. So threads change who does the
   work, never what is added to what, and bits are the same for any number of them. Lists are one
   array each, in which every domain has a stretch of its own, as long as the longest needs: no
   thread waits for another to find room, and one that runs out says so in `overflow` and is
   asked again. */
typedef struct demi_domain {
    int begin, end;                /* bodies */
    int own, cross, walls;         /* candidates: pairs inside, pairs leading out, wall elements */
    int near_own, near_cross, near_end;    /* near: end of pairs inside; begin, end of the others */
    int near_shaped, near_shaped_cross, near_shaped_end;   /* after those: pairs not of spheres */
    int near_next_own, near_next_cross, near_next_end;     /* of the list being made */
    int near_next_shaped, near_next_shaped_cross, near_next_shaped_end;
    int contacts;                  /* of bodies with bodies */
    int kept, kept_next;           /* contacts kept by themselves: now; being found */
    int kept_walls;                /* those of them with walls */
    int kept_same;                 /* where touch looks first for one of a step ago */
    int touching_first;            /* where its places in touching_ begin */
    int overflow;                  /* a list ran out of room while being built: 1: pairs inside, 2:
                                      pairs leading out, 4: walls, 8: near pairs, 16: kept */
    double speed2, check, overlap; /* max |v|^2, sum |v|^2, max overlap over radius, of this step */
    double acceleration2;          /* max |a|^2 */
    double turn;                   /* m/s, max change of |spin| times moment_arm in the step */
    double turn_speed;             /* m/s, max |spin| times moment_arm */
    double turn_rate;              /* rad/s, max |spin| of those that are not spheres */
    double energy[DEMI_ENERGIES];
    uint64_t met[DEMI_MATERIALS];  /* as in demi_booked: by contacts that began since the search */
} demi_domain;

/* Two tables, of what touches and of what is touched: nothing else names a kind but its own
   functions.

   Shapes: kinds of a body's parts (a cluster is of balls). >>add-shape: a declaration in >>scene; a
   row here, and in the rows of walls how they touch it; functions, above demi_touches. A row:
   constant; NAME; name in sentences; how far apart two parts are, the other one of this kind or of
   one above (or less than that); how the two touch, for each kind above and its own, in that order.
   The functions of that NAME: demi_NAME_support, _thin, _equal, _curve, _drawn (>>shapes says what
   they tell) and _on_wall (>>kept).

   Walls. >>add-wall: a row here, a declaration in >>scene, functions, above demi_nears. A row:
   constant; corners of an element (0: it has none); places a candidate may give at most; traits;
   name in sentences; how near a sphere is to one element; how parts touch it, by their kinds in the
   order above; how its normals turn as a ball moves (0: not at all). demi_elements_touch serves any
   wall; planes and cylinders have copies with theirs inlined.

   0, or nothing, where two do not know each other: that is said when the second of the two is
   added. All know balls. */
enum {
    DEMI_FACETS = 1,               /* a surface of facets, see >>facets */
    DEMI_DRAWN = 2,                /* drawn out along its own z without end: seen at z = 0 */
    DEMI_BALLS = 4,                /* elements are grains: balls of `radius` about their corner */
    DEMI_FLAT = 8,                 /* a half space beyond z = 0 */
    DEMI_CROSSED = 16              /* rows take away where they cross: see demi_kept_crossed */
};
enum { DEMI_SIEVE_MOST = 25 };                  /* contacts of a grain with a sieve */
enum { DEMI_FLATS = 6 };        /* ways in which a polyhedron touches one wall */
enum { DEMI_RING_MOST = 2*DEM_RINGS - 1 };      /* pieces and rings of a surface of revolution */
#define DEMI_SHAPES(X) \
    X(BALL,      ball,      "sphere",    demi_balls_gap,      (demi_balls_touch)) \
    X(ELLIPSOID, ellipsoid, "ellipsoid", demi_ellipsoids_gap, \
      (demi_ellipsoids_touch, demi_ellipsoids_touch)) \
    X(POLYHEDRON, polyhedron, "polyhedron", demi_polyhedra_gap, \
      (demi_solid_round_touch, demi_solid_round_touch, demi_polyhedra_touch)) \
    /* the last */
#define DEMI_WALLS(X) \
    X(PLANE,    0, 7, DEMI_FLAT, "plane", \
      demi_plane_near, (demi_plane_spheres, demi_plane_ellipsoid, demi_flat_polyhedron), 0) \
    X(CYLINDER, 0, 7, 0, "cylinder", \
      demi_cylinder_near, (demi_cylinder_spheres, demi_cylinder_ellipsoid, demi_round_polyhedron), \
      demi_cylinder_bend) \
    X(PROFILE,  2, 7, DEMI_FACETS | DEMI_DRAWN, "profile", \
      demi_facet_distance, (demi_facets_spheres, demi_facets_ellipsoid, demi_flat_polyhedron), \
      demi_profile_bend) \
    X(SEGMENTS, 2, 7, DEMI_DRAWN, "profile of DEM_EDGE_FRACTION", \
      demi_facet_distance, (demi_segments_touch), 0) \
    X(MESH,     3, 7, DEMI_FACETS, "mesh", \
      demi_facet_distance, (demi_facets_spheres, demi_facets_ellipsoid, demi_flat_polyhedron), \
      demi_mesh_bend) \
    X(GRAINS,   1, 7, DEMI_BALLS, "wall of grains", \
      demi_grain_near, (demi_elements_touch, demi_grain_ellipsoid, demi_grain_polyhedron), \
      demi_grain_bend) \
    X(SIEVE,    0, DEMI_SIEVE_MOST, DEMI_CROSSED, "sieve", \
      demi_sieve_near, (demi_sieve_spheres, 0, demi_sieve_polyhedron), demi_sieve_bend) \
    X(REVOLVED, 0, DEMI_RING_MOST, DEMI_CROSSED, "surface of revolution", \
      demi_revolved_near, (demi_revolved_spheres, 0, demi_round_polyhedron), demi_revolved_bend) \
    /* the last */
#define DEMI_LIST(...) {__VA_ARGS__}            /* one field of a row that is a list: (a, b) */
#define DEMI_SHAPE_CONSTANT(KIND, NAME, WORD, GAP, TOUCH) DEMI_##KIND,
enum { DEMI_SHAPES(DEMI_SHAPE_CONSTANT) DEMI_SHAPE_KINDS };
#define DEMI_WALL_CONSTANT(KIND, C, M, T, N, NEAR, TOUCH, BEND) DEMI_WALL_##KIND,
enum { DEMI_WALL_NONE = 0, DEMI_WALLS(DEMI_WALL_CONSTANT) DEMI_WALL_KINDS };
typedef struct demi_wall_kind { int corners, most, traits; const char *name; } demi_wall_kind;
#define DEMI_WALL_KIND(KIND, CORNERS, MOST, TRAITS, NAME, NEAR, TOUCH, BEND) \
    {CORNERS, MOST, TRAITS, NAME},
static const demi_wall_kind demi_wall_kinds[] = {{0, 0, 0, "wall that was removed"},
    DEMI_WALLS(DEMI_WALL_KIND)};

/* Responses: how contacts act on bodies (desc.response, in the order of dem_response). A row: name
   in reports; history of a contact: reals (0: as contact laws have it), and bits of those that are
   components of vectors; traits; functions, see demi_response_row (0: nothing is to be done).
   History with impulses: friction and moment (vectors), the normal force and what of it cohesion
   takes, as forces; the normal velocity after the step and the one that was reversed (m/s), see
   demi_impulse_turns; and whether the contact slides, 1 or 0. */
enum {
    DEMI_LAWS = 1,                 /* contact laws give the forces, contact by contact */
    DEMI_LASTING = 2,              /* contacts have a duration, which limits the time step */
    DEMI_PRESSING = 4,             /* polyhedra: by pressure, on four points; else by gaps */
    DEMI_MIDWAY = 8,               /* contacts are found half a step ahead: the midpoint rule */
    DEMI_FORESEEN = 16,            /* contacts are found before they touch, as speeds require */
    DEMI_JOINTED = 32              /* joints and motors act */
};
enum { DEMI_IMPULSE_SLIDES = 10, DEMI_IMPULSE_REALS };
#define DEMI_RESPONSES(X) \
    X("springs", 0, 0, DEMI_LAWS | DEMI_LASTING | DEMI_PRESSING, \
      demi_springs_settle, 0, demi_springs, 0, demi_ledger_book, demi_springs_info) \
    X("impulses", DEMI_IMPULSE_REALS, 0x3f, DEMI_MIDWAY | DEMI_FORESEEN | DEMI_JOINTED, \
      demi_impulses_settle, demi_impulses_room, 0, demi_impulses, demi_impulses_due, \
      demi_impulses_info) \
    /* the last */
typedef struct demi_response_kind {
    const char *name;
    int memory, vectors, traits;
} demi_response_kind;
#define DEMI_RESPONSE_KIND(NAME, MEMORY, VECTORS, TRAITS, ...) {NAME, MEMORY, VECTORS, TRAITS},
static const demi_response_kind demi_response_kinds[] = {DEMI_RESPONSES(DEMI_RESPONSE_KIND)};

/* A piece of a triangle's side that ends at corners of other triangles. */
typedef struct demi_cut {
    dem_vec3 a, b;
    dem_real weight;               /* what it counts; 0: another facet looks after it */
    int32_t number, end[2];        /* of the piece: the edge's where it is one; of its ends */
    int32_t side;                  /* of the element */
} demi_cut;
/* A side of a triangle where its sheet may end, since no one triangle goes on there: 3*element +
   side; and the mean normals of the sheet at both its corners, unit, as its first facet turns. */
typedef struct demi_border { int32_t side; dem_vec3 normal[2]; } demi_border;

typedef struct demi_wall {
    int kind, material;            /* DEMI_WALL_..., index */
    int32_t id;                    /* dem_wall id; of an empty place: that of its last wall */
    int inside;                    /* cylinder */
    dem_edge_rule rule;
    dem_real radius, share;        /* cylinder; grains */
    dem_sieve_desc sieve;
    int ring_count;                /* of a surface of revolution: radii and heights, m */
    dem_real ring_radius[DEM_RINGS], ring_height[DEM_RINGS];
    int vertex_count, element_count;
    dem_real *vertices;            /* vertex_count x 3, in the wall's own frame */
    int32_t *corners;              /* element_count x 3 (mesh), x 2 (profile) */
    /* surfaces of facets (mesh, profile), see >>facets */
    int edge_count, cut_count, number_count;   /* numbers: of faces, edges, corners, cuts */
    int32_t *edges;                /* element_count x 3 (mesh): the edge from corner k to k + 1 */
    dem_real *weight;              /* how often each face, edge and corner counts, in this order */
    unsigned char *owns;           /* element_count: bit k: looks after edge k, 3 + k: corner k */
    int32_t *sheet;                /* element_count: which sheet it is of, from 1; < 0: it turns the
                                      other way round than the sheet's first; 0: it is a copy */
    dem_real *planes;              /* element_count x 4: unit normal and n.x of its plane, m; zeros:
                                      it is too thin to have one */
    dem_real plane_slack;          /* m, what rounding may do to a distance from a plane */
    demi_border *borders;          /* border_count: of sheets, by side (mesh) */
    int border_count;
    int32_t *cut_start;            /* element_count + 1 (null: none): pieces of edges in `cuts` */
    demi_cut *cuts;
    int group;                     /* walls of one group do not move against each other */
    int lone;                      /* its facets have neighbours of its own alone */
    dem_real span_lo[3], span_hi[3];   /* m, from where to where it goes, in a periodic world */
    int repeats[3];                /* along a periodic axis: it is not longer than the period */
    dem_real extent;               /* m, farthest vertex from the frame's origin; < 0: endless */
    dem_pose home, pose;           /* pose at motion start, pose now */
    dem_pose first;                /* as it was added */
    dem_pose mid;                  /* in the middle of the step just taken */
    dem_pose ahead, was;           /* impulses: a step later, see demi_ahead; that of a step ago */
    dem_motion motion;
    int symmetric;                 /* its motion leaves its surface in place: no search needed */
    dem_box box;                   /* local box of the elements */
    int cells[3];                  /* local grid of elements; 0: none */
    dem_real cell;                 /* m */
    int32_t *cell_start, *cell_items;
    int cell_item_count;
    dem_wall_loads loads;
    dem_real reals[DEM_BODY_REALS];/* the user's own */
} demi_wall;

typedef struct demi_field {
    int used;
    dem_field_desc desc;
    uint64_t samples;
    double next;                   /* s, time of the next sample */
    double *sums;                  /* demi_field_reals, see >>fields */
} demi_field;

enum { DEMI_FEED_SIZES = 64 };
typedef struct demi_feed {
    dem_feed_desc desc;
    dem_feed_state state;
    uint64_t random;
    uint64_t limit[DEM_CLASSES];   /* grains of each class, when limited */
    double mass[DEM_CLASSES];      /* kg, mean of a grain */
    double lo[DEM_CLASSES], hi[DEM_CLASSES];   /* m, ends of its sizes */
    double finer[DEM_CLASSES][DEMI_FEED_SIZES + 1]; /* share of the number, by ln r */
    int64_t next;                  /* class of the next grain, -1: not drawn yet */
    struct {                       /* and what it is */
        dem_real radius, reach;    /* m: of the sphere of its volume; of the one around it */
        dem_quat orientation;
        double mass;               /* kg */
    } drawn;
    uint64_t again;                /* step at which one that found no room tries again */
} demi_feed;
typedef struct demi_outlet {
    dem_outlet_desc desc;
    dem_outlet_state state;
    int zone;                      /* of its bits in bodies.zones; -1: it takes grains out */
} demi_outlet;

/* Saved whole. */
typedef struct demi_joint {
    dem_joint_desc desc;
    dem_joint_state state;
    int32_t id;
    double held;                   /* J, given in the last step by what it holds */
    double bank;                   /* J, what it has taken and may give back */
    dem_real left, apart;          /* m, gap that is left at the end of the step; of it, made by
                                      somebody who has moved a body */
    dem_vec3 arm[2], axis[2];      /* m, from the centre of a and b to the point; unit: as seen from
                                      body, wall or space */
} demi_joint;

/* One level of the hierarchical grid: the bodies of a class of radii, and cells of their own. */
typedef struct demi_level {
    double radius;                 /* m, largest of the class */
    double size[3];                /* m, of a cell */
    int cells[3], first;           /* cells stand from `first` on in w->cell_start */
    int count;                     /* bodies */
} demi_level;
/* classes of radii a factor sqrt 2 wide, before they are joined */
enum { DEMI_LEVELS = 24 };

/* Steps of one length: time is counted from their beginning, so that rounding does not add up. */
typedef struct demi_since { double time; uint64_t steps; double dt; } demi_since;

/* Box ends of the linked linear list on one axis. */
typedef struct demi_end { dem_real value; int32_t box; int32_t upper; } demi_end;

/* What holds between two materials. */
typedef struct demi_pair {
    dem_pair given;
    double damping;                /* damping ratio that gives its restitution */
} demi_pair;

/* The laws in force and where the memory of each begins (that of friction: at 0), see >>laws. */
struct demi_law_row;
typedef struct demi_laws {
    const struct demi_law_row *normal, *tangent, *rolling;
    int at_rolling, at_normal, memory, vectors;     /* reals; bits of those that are vectors */
    int at_sliding;                /* the real that says whether friction slides, the last of
                                      `memory`; DEMI_MEMORY: no pair has static friction */
} demi_laws;

/* --- what a world knows in numbers alone, by whose they are. Saved and copied whole: a field more
       is saved, too. Pointers, and what follows from other things, do not belong here. --- */

/* Why a chosen time step is shorter than t_c/50, for the report. */
enum { DEMI_HELD_NOT, DEMI_HELD_DASHPOT, DEMI_HELD_SPIN, DEMI_HELD_PRESSED, DEMI_HELD_RATE };
typedef struct demi_held {
    double from, limit, contacts;  /* s, t_c/50; s, or rad/s of a spin; that press the body */
    int32_t by, body;              /* DEMI_HELD_...; the body's id, 0: it is not known */
} demi_held;
typedef struct demi_timing {       /* >>step, >>advice */
    double time;                   /* s: since.time + (steps - since.steps) since.dt */
    demi_since since;              /* when the present dt came into force */
    uint64_t steps, rebuilds;
    uint64_t last_rebuild;         /* step */
    double run_end;                /* s: where the last run should have ended, */
    uint64_t run_steps;            /* and the step at which it did */
    dem_real dt;                   /* s */
    double half_kick;              /* s, of the step under way */
    double assumed_speed;          /* m/s, behind dt */
    double spin_elsewhere;         /* rad/s, fastest in slabs, of bodies that are not spheres */
    uint64_t press_due;            /* step at which what presses bodies is looked for next */
    uint64_t press_since;          /* step of the last change of the scene */
    demi_held held;
} demi_timing;
/* How far a world has got on its way to the next step. A change of the scene undoes dt_valid,
   forces_valid and primed; one of who is where, list_valid, too. dem_world_step makes good what is
   missing, in this order: */
typedef struct demi_stages {
    int dt_valid;                  /* 1: the time step suits the scene */
    int list_valid;                /* 2: candidates fit the bodies */
    int pairs_changed;             /* 0, or 1: what holds between materials has changed since */
    int forces_valid;              /* 3: forces are those of the present places and velocities */
    int primed;                    /* 4: half-step velocities are those of the step before */
    int moved;                     /* a step has moved and lacks its forces: memory ran out in it */
    int synced;                    /* no half kick is due: see demi_finish */
    int near_stale;                /* the near list lacks a pair of a body that joined */
    /* a rebuild or a new near list that ran out of memory had chosen these: tried again, it takes
       the same, since the counts they are chosen by may be gone */
    int skin_chosen, near_chosen;
} demi_stages;
typedef struct demi_margin {       /* >>rebuild, >>near: how long lists hold */
    double skin, gone, walls_gone; /* m: margin, farthest a body / a wall point went since */
    double step_gone;              /* m, farthest that any point of a body went in the last step */
    double skin_auto;              /* m: what the cost model proposes; 0: nothing yet */
    double span, age;              /* s: how long the near list is meant to last, lasts already */
    double slack;                  /* m: what velocities may bring by having changed since */
    double change, last_change;    /* m/s: most that a velocity may have changed since; last step */
    double creep;                  /* m: what that may have brought two bodies together */
    double reach;                  /* m: gap up to which a law is asked, of any two; 0: at touch */
} demi_margin;
typedef struct demi_in_force {     /* >>rebuild: worked out when the list is made */
    int tangent, rolling;          /* laws in force */
    int uniform;                   /* one radius, one mass, one material, nothing fixed */
    int fixed_count;
    int tight;                     /* some body is so long that its bounding sphere is no guide */
    int sticks, none;              /* has a pair static friction above that of sliding? 0 */
    int species_count;             /* DEMI_SPECIES + 1: more than that */
    demi_species species[DEMI_SPECIES];
    dem_real radius_min, radius_max;           /* m */
} demi_in_force;
typedef struct demi_levels {       /* >>search */
    int count, wide;               /* wide: radii differ so much that levels pay */
    demi_level level[DEMI_LEVELS]; /* the coarsest first; none in use: count is 0 */
    double fine;                   /* m, largest radius of the finest class */
    double tests[2];               /* estimated work of a search per body: by one grid, by levels */
} demi_levels;
typedef struct demi_booked {       /* >>ledger: sums since the beginning, and the largest seen */
    double energy[DEMI_ENERGIES], inserted, removed, throughput;       /* J */
    double overlap_max, speed_max; /* of the radius; m/s */
    uint64_t met[DEMI_MATERIALS];  /* bit j of i, i <= j: materials i and j have touched */
    double due[4];                 /* J: what the impulses of the next step will take, see
                                      demi_impulses_tell; what walls will do */
    double residual, residual_rms; /* m/s, of the last solve: largest, rms */
    uint64_t unsolved;             /* solves that did not reach their tolerance */
    int sweeps, none;              /* of the last solve; 0, so that no byte of it is unknown */
} demi_booked;

/* Bodies: who they are (slots, which never move) and where they stand in the arrays (indices, which
   change whenever the list is rebuilt). Part >>bodies owns them; integrators move them, contacts
   push them. What is done with each array: demi_body_arrays. */
typedef struct demi_bodies {
    int count, capacity;           /* bodies */
    dem_real *pos, *vel, *spin;    /* x 4; at the full step (predicted while a step is under way) */
    dem_real *half_vel, *half_spin;/* x 4; mean over the step just taken: at the half step */
    dem_real *last_pos;            /* x 4; one step ago (schemes that look back); impulses: places
                                      and orientations of the full step, while contacts are
                                      found at the half step */
    dem_real *last_orient;
    uint8_t *went;                 /* impulses: 1: it has made a step since it was put or set */
    dem_real *force, *torque;      /* x 4 */
    dem_real *inv_mass, *inv_inertia, *mass;     /* inv_inertia: 0 unless a sphere that moves */
    int backward;                  /* last_pos exists */
    int booked;                    /* the next exists: a ledger, and a scheme that predicts */
    dem_real *late;                /* x 4; m/s: by how much the last prediction fell short */
    int orienting;                 /* the next four exist */
    dem_real *orient;              /* x 4: w x y z, principal axes -> world */
    dem_real *angular;             /* x 4: angular momentum at the half step; shaped bodies only */
    dem_real *moment;              /* x 4: principal moments of inertia, kg m2; moment_arm, m */
    int32_t *shape;                /* dem_shape ids; 0: a sphere */
    int shaped;                    /* bodies that are not spheres */
    dem_real *centre;              /* x 4: spheres of clusters: centre from the body's, radius, m */
    int32_t *centre_start;           /* where those of each body begin */
    int centres_valid;               /* they fit the bodies and their orientations */
    uint32_t *slot;                /* of each body: who it is */
    int32_t *material;             /* 1 + index */
    int32_t *slot_index;           /* slot -> index, -1 when free */
    uint32_t *slot_generation;
    int slot_count, slot_capacity; /* slots used so far, room */
    /* chains of free slots (-1: none); pending ones rest until a rebuild */
    int slot_free, slot_pending;
    int real_count;                /* numbers of the user's per body; 0: the next two are null */
    dem_real *reals, *rates;       /* x real_count; 1/s: what laws bring, of the present forces */
    int zoned;                     /* the next exists */
    uint32_t *zones;               /* bit k: in the region of counting outlet k; 16 + k: known */
    uint8_t *ghost;              /* by slot; null outside >>slabs: 1: a copy, owned elsewhere */
    dem_real *scratch;             /* x 4, for permuting */
    int32_t *order, *cell_of;      /* permutation, cell of each body */
    dem_body_counts balance;
} demi_bodies;
/* The road of a contact's memory. While a list holds, memory of two spheres stands in columns of
   the near list, beside its pair; every other contact carries its own (demi_kept). A near list
   that is made anew takes columns over from the one before, pair by pair (near_last). Before a
   search, and when bodies come or go (demi_list_drop), indices are about to change: memory of
   spheres is filed here, by slot, and kept contacts name slots instead of indices. The next list
   fetches what is filed (demi_near_make), kept contacts move to the domains of their bodies
   (demi_kept_move), and what turns round on the way, because a body has got the lower index,
   changes its sign where it is a vector. Nothing is thrown away before all of the new list has
   its room: a rebuild that is refused memory can be asked for again. A checkpoint writes
   whatever of this there is. Entries start[row] .. start[row + 1] - 1 belong to the row, the
   pair's lower slot. */
typedef struct demi_filed {
    int32_t *start;                /* rows + 2 */
    int32_t *partner;              /* the higher slot; ~ of it when body a of the pair was that */
    dem_real *memory;              /* x stride */
    int count, rows;               /* entries; slots there were when they were filed */
    int stride;                    /* reals per entry */
} demi_filed;

/* What an output has written: state, saved whole. */
typedef struct demi_written {
    uint64_t what, when;           /* digests: of its kind and path; of its start and interval */
    int64_t next;                  /* number of the next; DEMI_OUTPUT_UNKNOWN: the first that is
                                      due, this moment included */
    double last;                   /* s: when it wrote; -1e300: not yet */
} demi_written;
enum { DEMI_OUTPUT_UNKNOWN = -1 };
#define DEMI_OUTPUT_MOST 9e15      /* numbers beyond are not all whole in a double */
#define DEMI_OUTPUT_LEAST 1e-12    /* s: shorter intervals are mistakes */
typedef struct demi_output {
    dem_output_desc desc;          /* its texts are the world's own */
    demi_written written;
    int32_t id;                    /* outputs are in the order of their ids, which ascend */
    int resumes;                   /* 1, or 2 where a file that was read knew of it: later lines of
                                      a CSV file have not been taken out yet */
} demi_output;

/* Which call has handed over to a function of the user's; null: none. within: 1 where lists and
   sums are half made, 0 where the world is whole and files of it may be written. */
typedef struct demi_calling { const char *who; int within; } demi_calling;

/* What looks at a world as it goes on. Not of its state, but for what outputs have written: it
   stays when that is read from a file. */
typedef struct demi_lookers {
    demi_calling calling;          /* see demi_calls */
    int tenths_told;               /* of this run, where progress is written into a file */
    int under_way;                 /* the user is looking: no step now */
    dem_replay *films;             /* open ones, which take their frames by themselves */
    void (*films_look)(dem_world *w);           /* null: there are none */
    int output_count, reads;       /* reads: of checkpoints, so far */
    int32_t output_last;           /* the last id that was given */
    demi_output *outputs;
    dem_result (*outputs_look)(dem_world *w);   /* null: there are none */
    void (*outputs_again)(dem_world *w);        /* the state has been read from a file */
} demi_lookers;

/* Contacts and bodies as solvers of impulses see them: made anew in every step (>>impulses). */
struct demi_meeting;
struct demi_impulse;
struct demi_beside;
struct demi_twist;
struct demi_mover;
struct demi_run_sums;
struct demi_rod;
struct demi_knot;
struct demi_link_of;
typedef struct demi_solver {
    struct demi_meeting *meetings; /* domain d's begin at meeting_first[d] */
    struct demi_impulse *contacts; /* by colour, and so are: */
    struct demi_beside *beside;
    struct demi_twist *twists;     /* null: nobody rolls or spins with friction */
    dem_vec3 *arms;                /* x 2, m; null: all are spheres */
    struct demi_mover *movers;     /* one per body and kept contact; some solvers: twice */
    dem_real *tensors;             /* x 6: inverse of its inertia, in the world's frame; null: all
                                      are spheres */
    dem_real *lifts;               /* x 4, m/s: what undoes overlaps, see demi_impulses_lift */
    uint64_t *colours;             /* of each body: those taken */
    int32_t *degrees;              /* of each body: how many contacts it has */
    dem_vec3 *vectors;             /* columns of one per contact, for some solvers */
    struct demi_run_sums *runs;    /* of each run of contacts in the last round */
    struct demi_rod *rods;         /* one per joint */
    int32_t *joined;               /* of each body: its first joint, see demi_joined */
    struct demi_knot *knots;       /* bodies and joints of the system that joints make */
    int32_t *knot_of, *rows;       /* of each body; of each entry of the factor */
    struct demi_link_of *links;
    double *blocks;                /* x 36: pivots, and entries below them */
    int knot_count, row_count, link_count, factored;
    int count, first, last, run;   /* contacts; of the colour being swept; its first run */
    int limited;                   /* contacts at their friction limit in the last unsolved step */
    int twisted;                   /* is there rolling or spinning friction? */
    int begins[65];                /* of each colour */
    int meeting_first[DEMI_DOMAINS], meeting_count[DEMI_DOMAINS];
    dem_real dt, step;             /* s; of some solvers, see there */
} demi_solver;

/* A world, by owners: each part writes its own, all read. Where more write, they are named. */
struct dem_world {
    /* >>world */
    dem_world_desc desc;           /* as given, with choices filled in */
    dem_world_desc asked;          /* as given */
    char real_names[DEM_BODY_REALS*24];    /* what body_reals of both point to, */
    char memory_names[DEM_LAW_MEMORY*24];     /* and law_memory_names */
    /* >>memory: sentences (demi_fail), and all that was allocated */
    char error[512];
    char refusal[512];             /* of the first call that builds the scene and was refused */
    int refused;                   /* calls that were, since dem_world_error_get was read */
    char refused_calls[24][32];    /* their names */
    size_t bytes;
    struct demi_block *chains[DEMI_CHAINS];
    /* numbers alone, saved and copied whole */
    demi_timing clock;             /* >>step; dt and what hangs on it: >>advice */
    demi_stages stage;             /* undone by whoever changes the scene, made good by >>step */
    demi_margin margin;            /* skin: >>rebuild; the near list's: >>near; gone: >>step */
    demi_in_force effects;         /* >>rebuild */
    demi_levels levels;            /* >>search */
    demi_booked booked;            /* >>ledger; what comes and goes: >>bodies, >>feed, >>step */
    /* >>materials */
    int material_count;
    dem_material_desc materials[DEMI_MATERIALS];
    demi_pair *pairs;              /* DEMI_MATERIALS x DEMI_MATERIALS */
    /* >>shapes */
    int shape_count;
    demi_shape *shapes;
    /* >>bodies; moved by >>integrators, pushed by >>respond and >>kept */
    demi_bodies bodies;
    demi_filed filed;
    /* >>walls; weights of facets: >>facets; poses and loads: >>step */
    int wall_count;
    demi_wall *walls;
    double wall_fastest;           /* m/s, fastest wall point of the step */
    dem_real wall_period[3], ring_period[3];   /* m, of walls; of a ring of slabs */
    int repeating;                 /* does any wall repeat? */
    int facets_valid;              /* what facets count fits the walls and their motions */
    /* >>measure, >>feed, >>placing, >>advice */
    int field_count;
    demi_field *fields;
    int feed_count, outlet_count;
    demi_feed *feeds;
    demi_outlet *outlets;
    int joint_count, joint_last;   /* >>joints: how many, and the last id */
    demi_joint *joints;
    int written_count;             /* >>output: those of the file that was read last */
    demi_written *written;
    struct demi_sphere *crowd;
    struct demi_node *crowd_nodes;
    dem_real *crowd_turned;        /* x 4 */
    double dt_share;               /* trials: of the step that would be chosen; 0: all of it */
    struct demi_press *press;      /* what presses bodies, while a step is judged */
    struct demi_press_whole *press_whole;
    /* >>rebuild: laws in force, domains */
    int normal;                    /* law in force */
    demi_laws laws;                /* their rows; not used where the user's own acts */
    int memory_stride, vector_mask;/* reals per contact; which of them are vectors */
    int composed;                  /* one stage per law even where one for all would do (tests) */
    int domain_count;
    demi_domain *domains;          /* counts of each list by who makes it */
    /* >>search */
    dem_real image_shift[27*4];    /* m, from a body to another's image; 0: none */
    int32_t *cell_start;
    int cells[3], cell_axes[3];    /* along x, y, z; the axes, that of the fewest cells first */
    double cell_origin[3], cell_size[3];
    demi_end *lll_ends[3];
    struct demi_pair_key *lll_table;
    int32_t *lll_rows, *lll_row_start;
    int bins[3];                   /* of boxes, along the axes: see demi_rows_bins */
    double bin_size[3];            /* m */
    int32_t *bin_of;               /* bodies x 6: the first bin, how many more, along each axis */
    int32_t *bin_start, *bin_items;/* bodies of each bin, in their order */
    int lll_valid, lll_boxes, lll_size;
    /* >>lists: candidates of pairs and on walls; contacts that last */
    demi_list own, cross;
    int join_room;                 /* candidates that newcomers may bring, see demi_list_join */
    int *cross_incoming_start;     /* domain_count + 1 */
    int32_t *cross_incoming;       /* entries of `cross`, by domain of b, ascending */
    dem_real *cross_force;          /* x 6: force and torque on the far end */
    int cross_entries;
    int wall_stride;               /* wall candidates per domain */
    int32_t *wall_body, *wall_id, *wall_element;
    dem_real *wall_gap;            /* m, between grain and element when the list was made, or a
                                      little less */
    dem_real *wall_shift;          /* x 3, m: from the grain to its image that is near */
    demi_wall_sum *wall_sums;      /* domain_count x wall_count */
    /* where a law answers rates of the user's numbers: domain_count x wall_count x real_count, and
       beside cross_force x real_count; else null */
    double *wall_rates;
    dem_real *cross_rate;
    int touching_valid;            /* the next three have room for the present candidates */
    demi_touching *touching;       /* of one body and wall, by domain */
    int32_t *touching_table;
    demi_link *touching_links;
    int kept_first[DEMI_DOMAINS + 1];   /* where those of domain d begin, in either list */
    demi_kept *kept_now, *kept_next;
    /* >>near */
    demi_near near, near_last;     /* in use, and the one before: swapped when made anew */
    dem_real *species_coef;        /* row a*species_count + b: DEMI_PAIR_COLUMNS of species a and b;
                                      as they were when lists were made */
    int species_vary;              /* columns that are not the same for all near pairs: 1 << each */
    struct demi_quiet *quiet;      /* what may push each few bodies, see demi_domain_quiet */
    int near_fresh, near_due;      /* being made after a search; slabs: some list is due */
    struct demi_solver solver;     /* >>impulses */
    /* >>respond */
    void (*kernel)(dem_world *w, int domain);
    demi_lookers look;             /* >>step, >>output, >>replay */
};
/* A wall's id is its place in `walls`, from 1, plus DEMI_WALLS_MOST for every wall that has been in
   this place before: an id of a wall that was removed names nothing, and places are used again. */
enum { DEMI_WALLS_MOST = 1 << 18 };
static int demi_wall_place(dem_wall wall) { return (int)(((uint32_t)wall.id - 1)%DEMI_WALLS_MOST); }
static int demi_wall_there(const dem_world *w, dem_wall wall) {
    const int place = demi_wall_place(wall);
    return wall.id > 0 && place < w->wall_count && w->walls[place].id == wall.id &&
        w->walls[place].kind != DEMI_WALL_NONE;
}
