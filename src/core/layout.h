/* ---------------------------------------------------------------------------------------------
   >>layout
   Data structures of the world, and the tables of shapes, walls and responses. Bodies are stored as
   flat arrays with four reals per body, so that a gather reads one cache line and a drift is one
   long loop.

   Words of the code, beside those of the glossary:
       word in names       meaning
       domain              a work group of some 2000 neighbouring bodies
       ball                a sphere of a pair: a member of a cluster, or a lone sphere
       near                the pruned neighbour list: the candidates that may touch within some
                           steps (>>near). Forces are computed for these only. The contact history
                           of two spheres is stored in its columns
       share, weight       the weight of a contact point (glossary)
       place               a contact point on a surface (demi_touching), or an index
       part                a member sphere, a piece of a union, or the whole body (glossary)
       memory              the contact history
       species             spheres with the same material, radius and mass, all fixed or all free
       tile                some 32 or 64 pairs whose forces are computed together
   --------------------------------------------------------------------------------------------- */
enum { DEMI_MATERIALS = 64, DEMI_MEMORY = DEM_LAW_MEMORY + 2, DEMI_SOME = 16, DEMI_DOMAINS = 256,
      DEMI_LANES = 64/(int)sizeof(dem_real),    /* reals in the widest vector register */
      DEMI_TILE = 4*DEMI_LANES,                 /* pairs of a tile */
      DEMI_ROOM = DEMI_TILE + 16,                /* column length of a tile: columns a power of two
                                                   apart would compete for the same cache lines */
      DEMI_NEAR_BALLS = 31, DEMI_BALLS_UNKNOWN = 255, DEMI_BALLS_ALL = 254 };

/* A loop over the rows q of a tile, which compilers vectorise. `full` is the number of rows,
   rounded up to a multiple of DEMI_LANES; results of the rows that pad it are ignored. */
#define DEMI_ROWS(full) { int g, l; \
    for (g = 0; g < (full); g += DEMI_LANES) { \
        DEMI_VECTOR \
        for (l = 0; l < DEMI_LANES; l++) { const int q = g + l;
#define DEMI_ROWS_END }}}

/* Coefficients of one contact, as the built-in laws need them. */
#define DEMI_COEF_CONSTANT(PROPERTY, COEFFICIENT, UNIT) DEMI_COEF_##COEFFICIENT,
enum { DEMI_KN, DEMI_CN, DEMI_KT, DEMI_CT, DEMI_MU, DEMI_MU_STATIC, DEMI_MU_ROLL, DEMI_MU_SPIN,
      DEMI_R_EFF,
      DEMI_K_UN,                                /* hysteretic law: unloading */
      DEM_LAW_COEFFICIENTS(DEMI_COEF_CONSTANT) DEMI_COEFS };

/* Every allocation of a world is linked into one of two lists ("chains", see demi_hold): data of
   the scene that survive a restart (materials, shapes, geometry of walls), and work arrays of a
   run. DEMI_LOOSE: in no list. */
enum { DEMI_LOOSE, DEMI_SCENE, DEMI_RUN, DEMI_CHAINS };
struct demi_block;

/* Candidate pairs of all work groups (broad phase). Group d owns the entries from d*stride to
   d*stride + stride - 1. */
typedef struct demi_list {
    int stride;                    /* capacity per work group */
    int32_t *a, *b;                /* body indices, a < b */
    int32_t *place;                /* 1 + entry in the pruned neighbour list; 0: not in it */
    unsigned char *image;          /* offset in image_shift of the shift to b's nearest image */
} demi_list;

/* With impulses: pairs of member spheres of two bodies that may touch: part a[k] of one body, b[k]
   of the other, in the order of contacts. >>persistent fills it when it first computes the pair. */
typedef struct demi_near_balls {
    uint8_t count;                 /* pairs; DEMI_BALLS_UNKNOWN: not computed since the list was
                                      built; DEMI_BALLS_ALL: too many, test all */
    uint8_t a[DEMI_NEAR_BALLS], b[DEMI_NEAR_BALLS];
} demi_near_balls;
/* The pruned neighbour list of all work groups: candidates that touch or may touch soon. Group d
   owns the entries d*stride .. as above: first the pairs inside the group, then, from a multiple of
   DEMI_LANES on, the pairs with a body of a later group. The reals of a pair are stored in columns:
   value e of entry p of the group is memory[(d*columns + e)*stride + p]. */
typedef struct demi_near {
    int stride;                    /* capacity per work group, a multiple of DEMI_LANES */
    int32_t *a, *b, *k;            /* body indices; entry in the candidate list */
    int32_t *ball_a, *ball_b;      /* effects.clustered: spheres (bodies.centre_start), else null */
    unsigned char *image;          /* as in demi_list */
    unsigned char *on;             /* likewise: 1: may have a contact history */
    int32_t *hit;                  /* likewise: entries of the group that touch, ascending */
    demi_near_balls *balls;        /* null if pairs see all bodies as lone spheres, or
                                      effects.clustered */
    dem_real *memory;              /* contact history of two spheres: w->memory_stride columns, 0
                                      while the pair does not touch */
    int32_t *row;                  /* row of species_coef; unused if all bodies are alike or there
                                      are more than DEMI_SPECIES species */
    dem_real *coef;                /* in that second case: DEMI_PAIR_COLUMNS columns */
} demi_near;
enum { DEMI_M_EFF = DEMI_COEFS,
      DEMI_TILE_COLUMNS,                        /* those that stages read; the others: */
      DEMI_CN_ROOT = DEMI_TILE_COLUMNS,         /* of clusters: see demi_coefficients_rooted */
      DEMI_CT_ROOT, DEMI_PAIR_COLUMNS };
/* A species: spheres that are equal in everything that coefficients depend on. For up to
   DEMI_SPECIES species a table has a row of coefficients for every two of them. With more (radii
   drawn at random), every pair of the pruned list stores its own coefficients. */
enum { DEMI_SPECIES = 32 };
typedef struct demi_species {
    dem_real radius, mass, inv_mass;           /* m; kg; 1/kg, 0: fixed */
    int32_t material, shape;       /* 1 + index; dem_shape id of its cluster, 0: a lone sphere */
} demi_species;

/* Energies that each work group sums over one step, J; added in the order of work groups.
   DEMI_E_TOLD: what user-defined laws report. */
enum { DEMI_E_DASHPOT, DEMI_E_ELASTIC, DEMI_E_SHEAR_WORK, DEMI_E_SLIDE, DEMI_E_SHEAR_STORED,
       DEMI_E_ROLL,
       DEMI_E_GRAVITY, DEMI_E_FORCE, DEMI_E_WALLS, DEMI_E_CELL, DEMI_E_TOLD, DEMI_E_GROWTH,
       DEMI_ENERGIES };

/* What each work group sums over its contacts and bodies in a cell that deforms. DEMI_CELL_VIRIAL:
   9 products of the force on a and the vector from a to b, N m, row by row; DEMI_CELL_FLUX: m v v,
   N m, xx yy zz xy xz yz; DEMI_CELL_STIFF, DEMI_CELL_DAMP: 3 each, of contacts, for a strain along
   each axis, N m and N m s. */
enum { DEMI_CELL_VIRIAL = 0, DEMI_CELL_FLUX = 9, DEMI_CELL_STIFF = 15, DEMI_CELL_DAMP = 18,
       DEMI_CELL_SUMS = 21 };

/* A contact point of a body and a wall as >>touch finds it: geometry, before any law is called. */
typedef struct demi_touching {
    int32_t element;               /* of the wall; of facets: number of the face, edge or corner */
    int32_t base;                  /* of facets: added to it in the end, see demi_view */
    dem_real overlap, share;       /* m; weight of its force (of facets: see >>facets) */
    dem_vec3 normal, point;        /* unit, body -> wall; m */
    dem_vec3 shift;                /* m, from the body to its image that touches the wall */
    dem_vec3 spread;               /* this and the rest: of polyhedra, as in demi_persistent */
    dem_real slope, couple, deep;
    int32_t corner, corners;
    int32_t wall, rank;            /* this and the rest: as in demi_persistent_more, if part > 0 */
    dem_real part;
    dem_vec3 lean, turn;
} demi_touching;
/* A side or corner of a facet within reach of a body. >>touch uses these links to find which facets
   are connected and whether they form a ring around the body. */
typedef struct demi_link {
    dem_real distance;             /* to the body's centre, in the metric of the body's part */
    int32_t number, corner;        /* number of the side (corner 0) or of the corner (corner 1) */
    int32_t facet;                 /* its facet, counted among those in reach */
    int32_t sides[2];              /* of a corner: numbers of the facet's two sides there */
    int32_t place;                 /* the side's nearest point: its own number, or a corner's */
    int32_t root;                  /* of facet i, in link i: union-find of connected facets */
    dem_real more;                 /* correction of the contact point's weight for rings */
    dem_vec3 point, middle;        /* nearest; middle of the side; from the body's centre */
} demi_link;

/* A piece of a union: index of its shape; its centre, m, and its orientation in the union's
   principal frame. */
typedef struct demi_piece { int32_t shape; dem_vec3 at; dem_quat q; } demi_piece;
/* A shape in its principal frame, for unit mass and scale 1. */
typedef struct demi_shape {
    int kind;                      /* of its parts: DEMI_BALL, ...; of a union's first piece */
    int count;                     /* member spheres of a cluster; 0: one part */
    int lone;                      /* 1: a cluster of one sphere, at its centre of mass */
    dem_real *parts;               /* count x 4: centre, radius, m */
    dem_vec3 axes;                 /* m, semi-axes or other lengths of a single part, by kind */
    int pieces;                    /* of a union; 0: no union */
    demi_piece *piece;
    int corners, faces;            /* of a polyhedron */
    double *hull;                  /* faces x 4: unit normal divided by height, 1/m, and height
                                      above the centre, m; then corners x 3, m */
    int32_t *rim;                  /* faces + 1 starts; then the corners of each face,
                                      anticlockwise seen from outside */
    dem_vec3 inertia;              /* m2, principal moments per mass */
    double volume;                 /* m3 */
    dem_real radius;               /* m, of the bounding sphere */
    dem_real moment_arm;           /* m, largest lever arm of a contact force about the centre */
    dem_real thin, blunt, equal;   /* m, radii: smallest, of the flattest point, of equal volume */
    double light;                  /* smallest effective mass at a contact, over the mass */
    dem_quat frame;                /* rotation from principal axes to the frame it was given in */
    dem_vec3 centre;               /* m, centre of mass in that frame */
} demi_shape;

/* What only few persistent contacts need (demi_persistent_odd). */
typedef struct demi_persistent_more {
    dem_vec3 felt;                 /* m, to the contact point from the point at which effective
                                      masses are evaluated for the dashpot */
    dem_real area, added, rate; /* A of demi_persistent_share, m2; A/d^2 - 1; d(A/d^2)/d(added) */
    dem_vec3 axis;                 /* unless 0: displacements along this unit vector */
    dem_real along;                /* rotate the normal by `along`, 1/m, instead of by `bend` */
    dem_vec3 aside;                /* elastic force across the normal, over that along it */
    dem_vec3 outset;               /* m, to the contact point from where the normal force acts */
    dem_vec3 spread;               /* m, from the centre of pressure to this point */
    dem_real couple;               /* m: moment about the normal, over the normal force */
    /* if a polyhedron touches several walls of one surface in one contact: */
    dem_real part;                 /* this wall's part of it; 0: all */
    dem_vec3 lean, turn;           /* 1, m: what the wall's force and moment have beyond that part,
                                      over the normal force */
    int32_t rank;                  /* 0: the first wall; others continue what the first does */
} demi_persistent_more;
/* A persistent contact: any contact except sphere on sphere and, with springs, except those of
   spheres of clusters. (The history of two spheres is in the pruned neighbour list.) It exists as
   long as the two touch. The contacts of a work group are in the order of body a, pairs before
   walls; forces are added in this order. In each step,
       touch builds the list persistent_next from scratch
   and finds for each contact the one of the previous step (persistent_now) that it continues.
   respond continues the history of that contact and computes the forces. Then the two lists are
   swapped, so touch can start again with more room. Reading and writing it takes most of the time,
   so what the next step needs comes first, and what few contacts need last. */
typedef struct demi_persistent {
    int32_t a, b;                  /* bodies (slots while there is no list); b -1: a wall */
    int32_t part_a, part_b;        /* member spheres or pieces, else 0 */
    int32_t wall, element;
    int32_t send;                  /* pair: 1 + entry of cross_force for the force on b; 0: b is in
                                      this work group. Wall: 1 + old contact that ended and whose
                                      springs this one takes over; 0: none */
    int32_t from;                  /* old contact of its group that it continues; -1: none;
                                      -2: memory is set (>>flush) */
    int32_t corner, corners;       /* number of this point and number of points of the contact of
                                      two polyhedra, or of one and a wall; corners 0: one point */
    int32_t odd;                   /* 0: `more` counts as 0, whatever it contains */
    int32_t row; /* its coefficients, see demi_persistent_row; -1: no law was asked */
    double lambda;                 /* parameter of Perram and Wertheim; 0: unknown */
    dem_vec3 normal, arm_a;        /* unit, a -> b; m, from a's centre to the contact point */
    dem_real grip;                 /* weight of friction */
    dem_real memory[DEMI_MEMORY];  /* contact history: memory_stride reals; touch does not set it */
    dem_vec3 arm_b;                /* m, from b's centre */
    dem_real overlap, deep; /* m; < 0: a gap; 0: no force (demi_persistent_asked). deep: overlap
                                      over the smaller half width (of a sphere: its radius) */
    dem_real share, lift;          /* weights of damping, elastic force; */
    dem_real weight;               /* before contacts are merged: demi_persistent_share */
    dem_real held;                 /* friction weight that it inherits from the previous step; < 0:
                                      all of it, see demi_persistent_inherit */
    dem_real bend, slope;          /* per distance: turn of the normal, 1/m; change of overlap */
    dem_real r_eff;                /* m */
    dem_vec3 force;                /* N, on a */
    dem_vec3 shift;                /* with a wall: as in demi_touching */
    demi_persistent_more more;
} demi_persistent;
/* Coefficients of persistent contacts. Those that agree in the first fields share a row, unless
   there are many kinds of them. */
typedef struct demi_coefs_row {
    dem_real r_eff, inv[2];        /* m; 1/kg, of both bodies, of a wall 0 */
    int32_t material[2], shape[2]; /* bodies.material, bodies.shape; of a wall: -1 - its index; 0 */
    dem_real m_eff;                /* kg, of a sphere on a wall; 0: differs between contacts */
    dem_real coef[DEMI_COEFS], root[2];        /* see demi_coefficients_rooted */
} demi_coefs_row;

/* Fixed polyhedra that touch (>>flush): a body, with its pieces and links; from one body to another
   that it touches. */
typedef struct demi_flush_row {
    dem_vec3 at;                   /* m */
    dem_real radius;               /* m, of the bounding sphere */
    int32_t slot, material;
    int32_t first, count, from, to;        /* first piece, pieces; links from .. to - 1 */
} demi_flush_row;
typedef struct demi_flush_link {
    dem_vec3 way;                  /* m, between their centres */
    int32_t to, faced;             /* row; 1: they have a part of a face in common */
} demi_flush_link;
typedef struct demi_flush {
    int valid, count, slots;       /* 1: it fits the list of candidates; rows, 0: no links; slots */
    int piece_count, link_count;
    int32_t *of;                   /* the row of each slot, or -1 */
    demi_flush_row *rows;
    struct demi_flush_piece *pieces;
    demi_flush_link *links;
    uint64_t digest;               /* of the bodies that it was made for */
} demi_flush;

/* Force (N), torque (Nm), power (W) and contacts that the grains of one work group exert on one
   wall in one step. */
typedef struct demi_wall_sum { double force[3], torque[3], power; int contacts; } demi_wall_sum;

/* A domain is a work group: a range of consecutive bodies, which are neighbours in space because
   bodies are sorted by cell. One thread computes a whole group. The number of groups and their
   boundaries depend only on the numbers of bodies and of those that pairs do not see as lone
   spheres (demi_lone). A contact belongs to the group of its body with the lower index. A force on
   a body of a later group is stored in cross_force, and that group adds it in the order of the
   list. So the number of threads changes who computes, but never the order of a sum, and results
   have the same bits for any number of threads. Each list is one array in which every group has its
   own segment, so threads never wait for each other to allocate. A group whose segment is too short
   sets `overflow`, and the list is built again with more room. */
typedef struct demi_domain {
    int begin, end;                /* bodies */
    int own, cross, walls;         /* candidates: pairs inside the group, pairs with a body of a
                                      later group, wall elements */
    int near_own, near_cross, near_end;    /* pruned list: end of pairs inside; begin and end of
                                      pairs with later groups; */
    int near_shaped, near_shaped_cross, near_shaped_end;   /* behind them, the same for all other
                                      pairs of bodies: >>persistent finds their contacts */
    int near_lone[2];              /* number of pairs of two lone spheres (demi_lone), which come
                                      first among the pairs inside, and among those with later
                                      groups; 0 unless effects.clustered */
    int near_next_own, near_next_cross, near_next_end;     /* the same of the list being built */
    int near_next_shaped, near_next_shaped_cross, near_next_shaped_end;
    int contacts, merging;         /* between bodies; the most entries for the same two bodies */
    int persistent, persistent_next; /* persistent contacts in persistent_now and persistent_next */
    int persistent_walls;          /* those with walls */
    /* impulses, 1: a contact of polyhedra has several points; a contact has three or more */
    int faced, seated;
    int persistent_same;           /* where demi_persistent_same starts its search */
    int coefs;                     /* rows in use of w->coefs */
    int touching_first;            /* begin of its segment of w->touching */
    int overflow;                  /* lists that ran out of room: 1 pairs inside, 2 pairs with later
                                      groups, 4 walls, 8 pruned list, 16 persistent contacts */
    double speed2, check, overlap; /* max |v|^2, sum |v|^2, max overlap over radius, of this step */
    double acceleration2;          /* max |a|^2 */
    double turn;                   /* square of the max change of |spin| times moment_arm in the
                                      step, (m/s)^2 */
    double turn_speed, turn_rate;  /* squares of max |spin| times moment_arm, (m/s)^2, and of max
                                      |spin| of those that are not spheres, (rad/s)^2 */
    double energy[DEMI_ENERGIES], cell[DEMI_CELL_SUMS];
    uint64_t met[DEMI_MATERIALS];  /* as in demi_booked, since the last rebuild */
} demi_domain;

/* Two tables dispatch the narrow phase: shapes of bodies and kinds of walls. No other code names a
   kind, except that kind's own functions.

   Shapes: kinds of a body's parts (the parts of a cluster are balls, that is spheres).
   >>add-shape: a declaration in >>scene; a row here, and in the rows of walls the function for
   contacts with it; its functions, above demi_touches. A row has these fields:
     constant;
     NAME, which names the functions demi_NAME_support, _thin, _equal, _curve, _drawn (described in
       >>shapes) and _on_wall (>>meets);
     name in messages;
     function that returns the gap of two parts, the other one of this kind or of a kind above (it
       may return less than the gap);
     functions that find contacts with each kind above and with its own kind, in that order.

   Walls. >>add-wall: a row here, a declaration in >>machine, functions, above demi_tessellations. A
   row:
     constant;
     corners of an element (0: elements have none);
     largest number of contact points of one candidate;
     traits;
     name in messages;
     function that returns the distance of a sphere from one element;
     functions that find contacts with parts, by the parts' kinds in the order above;
     function that returns how the normal rotates as a member sphere moves (0: it does not).
   demi_elements_touch works for any wall; planes and cylinders have inlined copies of it.

   0, or no entry: this combination is not supported, and adding the second of the two fails with a
   message. Every wall and shape supports balls. */
enum {
    DEMI_FACETS = 1,               /* a surface of facets, see >>facets */
    DEMI_DRAWN = 2,                /* infinite along its local z; contacts are found at z = 0 */
    DEMI_BALLS = 4,                /* elements are grains: spheres of `radius` about their corner */
    DEMI_FLAT = 8,                 /* the half space beyond z = 0 */
    DEMI_CROSSED = 16,             /* has points of negative weight, as where the wires of a sieve
                                      cross: demi_persistent_crossed */
    DEMI_SMOOTH = 32,              /* has no edges */
    DEMI_ONLY_GAPS = 64            /* its function for polyhedra finds gaps, not pressure */
};
enum { DEMI_SIEVE_MOST = 25 };                  /* contact points of a grain with a sieve */
enum { DEMI_FLATS = 6 };        /* contacts that a polyhedron may have with one surface */
enum { DEMI_FLATS_WALLS = 24 };                 /* parts of these, if it is of several walls */
enum { DEMI_RING_MOST = 2*DEM_RINGS - 1 };      /* pieces and rings of a surface of revolution */
/* Cosine of 1.8 degrees: faces this nearly perpendicular to a normal are in face contact. */
#define DEMI_FLUSH 0.9995
/* c->from of a contact that has taken over the history of another one, c->memory. */
enum { DEMI_TAKEN_OVER = -2 };
/* Up to four contact points: x midway between both surfaces, gaps along the normal. */
typedef struct demi_spots {
    int count;
    demi_d3 normal, x[4];          /* unit, from a to b; m */
    double gap[4];                 /* m; negative: overlap */
} demi_spots;
#ifdef DEM_NO_POLYHEDRA            /* nothing adds one, so no table is asked */
#define demi_solid_round_touch 0
#define demi_polyhedra_touch 0
#define demi_flat_polyhedron 0
#define demi_round_polyhedron 0
#define demi_grain_polyhedron 0
#define demi_sieve_polyhedron 0
#define demi_flush_make(w) 1
#define demi_flush_share(to, from) 1
#define demi_flush_within(w, c, p, q, gap, spots) 0
#define demi_flush_follow(w, c, p, q) (void)0
#endif
#define DEMI_SHAPES(X) \
    X(BALL,      ball,      "sphere",    demi_balls_gap,      (demi_balls_touch)) \
    X(ELLIPSOID, ellipsoid, "ellipsoid", demi_ellipsoids_gap, \
      (demi_ellipsoids_touch, demi_ellipsoids_touch)) \
    X(POLYHEDRON, polyhedron, "polyhedron", demi_polyhedra_gap, \
      (demi_solid_round_touch, demi_solid_round_touch, demi_polyhedra_touch)) \
    /* the last */
#define DEMI_WALLS(X) \
    X(PLANE,    0, 7, DEMI_FLAT | DEMI_SMOOTH, "plane", demi_plane_near, \
      (demi_plane_spheres, demi_plane_ellipsoid, demi_flat_polyhedron), 0, 0) \
    X(CYLINDER, 0, 7, DEMI_SMOOTH | DEMI_ONLY_GAPS, "cylinder", demi_cylinder_near, \
      (demi_cylinder_spheres, demi_cylinder_ellipsoid, demi_round_polyhedron), \
      demi_cylinder_bend, demi_cylinder_tessellate) \
    X(PROFILE,  2, 7, DEMI_FACETS | DEMI_DRAWN, "profile", demi_facet_distance, \
      (demi_facets_spheres, demi_facets_ellipsoid, demi_flat_polyhedron), demi_profile_bend, 0) \
    X(SEGMENTS, 2, 7, DEMI_DRAWN, "profile of DEM_EDGE_FRACTION", demi_facet_distance, \
      (demi_segments_touch), 0, 0) \
    X(MESH,     3, 7, DEMI_FACETS, "mesh", demi_facet_distance, \
      (demi_facets_spheres, demi_facets_ellipsoid, demi_flat_polyhedron), demi_mesh_bend, 0) \
    X(GRAINS,   1, 7, DEMI_BALLS, "wall of grains", demi_grain_near, \
      (demi_elements_touch, demi_grain_ellipsoid, demi_grain_polyhedron), demi_grain_bend, 0) \
    X(SIEVE,    0, DEMI_SIEVE_MOST, DEMI_CROSSED, "sieve", demi_sieve_near, \
      (demi_sieve_spheres, 0, demi_sieve_polyhedron), demi_sieve_bend, demi_sieve_tessellate) \
    X(REVOLVED, 0, DEMI_RING_MOST, DEMI_CROSSED | DEMI_ONLY_GAPS, "surface of revolution", \
      demi_revolved_near, (demi_revolved_spheres, 0, demi_round_polyhedron), demi_revolved_bend, \
      demi_revolved_tessellate) \
    /* the last */
#define DEMI_LIST(...) {__VA_ARGS__}            /* a list as one field of a row: (a, b) */
/* True if entry k of such a list, given as text, names a function: false if it is 0 or missing. */
static int demi_listed(const char *list, int k) {
    for (; list && k > 0; k--) list = strchr(list + 1, ',');
    return list && *list && list[1 + (list[1] == ' ')] != '0';
}
#define DEMI_SHAPE_CONSTANT(KIND, NAME, WORD, GAP, TOUCH) DEMI_##KIND,
enum { DEMI_SHAPES(DEMI_SHAPE_CONSTANT) DEMI_SHAPE_KINDS };
#define DEMI_WALL_CONSTANT(KIND, C, M, T, N, NEAR, TOUCH, BEND, TESSELLATE) DEMI_WALL_##KIND,
enum { DEMI_WALL_NONE = 0, DEMI_WALLS(DEMI_WALL_CONSTANT) DEMI_WALL_KINDS };
/* touch, tessellate: the functions of the row as text, see demi_listed. Shapes without a function
   of their own use the tessellation (>>tessellate). */
typedef struct demi_wall_kind {
    int corners, most, traits;
    const char *name, *touch, *tessellate;
} demi_wall_kind;
#define DEMI_WALL_KIND(KIND, CORNERS, MOST, TRAITS, NAME, NEAR, TOUCH, BEND, TESSELLATE) \
    {CORNERS, MOST, TRAITS, NAME, #TOUCH, #TESSELLATE},
static const demi_wall_kind demi_wall_kinds[] = {{0, 0, 0, "wall that was removed", "", "0"},
    DEMI_WALLS(DEMI_WALL_KIND)};

/* Responses: how contacts act on bodies (desc.response, in the order of dem_response). A row: name
   in reports; reals in a contact's history (0: the contact laws decide) and a bit for each real
   that is a vector component; traits; functions, see demi_response_row (0: none needed).
   The history with impulses is: friction force and moment (vectors); the normal force and the part
   of it that cohesion takes, N; the normal velocity after the step and the velocity that was
   reversed, m/s (see demi_impulse_turns); 1 if the contact slides, else 0; the normal for which the
   force was solved (a vector); and what the coming step will lose by it along the normal, by slip
   and by rolling, J. */
enum {
    DEMI_LAWS = 1,                 /* contact laws give the force of each contact */
    DEMI_LASTING = 2,              /* contacts have a duration, which limits the time step */
    DEMI_PRESSING = 4,             /* contacts of polyhedra: pressure on four points; else gaps */
    DEMI_MIDWAY = 8,               /* contacts are found at the half step: the midpoint rule */
    DEMI_FORESEEN = 16,            /* contacts are found ahead of time, at a gap that depends on the
                                      speeds */
    DEMI_JOINTED = 32              /* joints and motors act */
};
enum { DEMI_IMPULSE_SLIDES = 10, DEMI_IMPULSE_NORMAL = 11, DEMI_IMPULSE_LOST = 14,
       DEMI_IMPULSE_REALS = 17 };
#define DEMI_RESPONSES(X) \
    X("springs", 0, 0, DEMI_LAWS | DEMI_LASTING | DEMI_PRESSING, \
      demi_springs_settle, 0, demi_springs, 0, demi_ledger_book, demi_springs_info) \
    DEMI_IMPULSE_RESPONSE(X) \
    /* the last */
#ifdef DEM_NO_IMPULSES
#define DEMI_IMPULSE_RESPONSE(X)
#define demi_joints_in_force(w) 0
#else
#define DEMI_IMPULSE_RESPONSE(X) \
    X("impulses", DEMI_IMPULSE_REALS, 0x383f, DEMI_MIDWAY | DEMI_FORESEEN | DEMI_JOINTED, \
      demi_impulses_settle, demi_impulses_room, 0, demi_impulses, demi_impulses_due, \
      demi_impulses_info)
#endif
typedef struct demi_response_kind {
    const char *name;
    int memory, vectors, traits;
} demi_response_kind;
#define DEMI_RESPONSE_KIND(NAME, MEMORY, VECTORS, TRAITS, ...) {NAME, MEMORY, VECTORS, TRAITS},
static const demi_response_kind demi_response_kinds[] = {DEMI_RESPONSES(DEMI_RESPONSE_KIND)};

/* A side of a triangle at which its sheet (>>sheets: connected facets) may end, because no single
   triangle continues there. side: 3*element + side. normal: mean normals of the sheet at both ends,
   unit, oriented as the sheet's first facet. */
typedef struct demi_border { int32_t side; dem_vec3 normal[2]; } demi_border;

/* A wall, or a surface that several walls are joined to (>>surfaces). */
typedef struct demi_wall {
    int kind, material;            /* DEMI_WALL_..., index */
    int32_t id;                    /* dem_wall id; of a removed wall: its old id */
    int inside;                    /* cylinder: the grains are inside */
    dem_edge_rule rule;
    dem_real radius, share;        /* m, of a cylinder or of the grains; weight of all contacts */
    dem_sieve_desc sieve;
    int ring_count;                /* of a surface of revolution: radii and heights, m */
    dem_real ring_radius[DEM_RINGS], ring_height[DEM_RINGS];
    int vertex_count, element_count;
    dem_real *vertices;            /* vertex_count x 3, m, in the wall's own frame */
    int32_t *corners;              /* element_count x 3 (mesh), x 2 (profile) */
    /* surfaces of facets (mesh, profile), see >>facets */
    int edge_count, number_count;  /* number_count: faces, edges and corners */
    int32_t *edges;                /* element_count x 3 (mesh): the edge from corner k to k + 1 */
    dem_real *weight;              /* weights of faces, edges and corners, in this order */
    unsigned char *owns;           /* element_count: bit k: this facet accounts for edge k;
                                      bit 3 + k: for corner k */
    unsigned char *ends;           /* element_count: bit k: the surface ends at side k (profile:
                                      corner k), where no single other facet continues it */
    int32_t *sheet;                /* element_count: number of its sheet, from 1; < 0: oriented
                                      against the sheet's first facet */
    dem_real *planes;              /* element_count x 4: unit normal and n.x of its plane, m; zeros:
                                      too thin to have a plane */
    dem_real plane_slack;          /* m, bound on the rounding error of a distance from a plane */
    demi_border *borders;          /* border_count: of sheets, by side (mesh) */
    int border_count;
    int chain;                     /* list of its arrays: DEMI_SCENE; DEMI_RUN if it is joined */
    int32_t *whose;                /* number_count, of a joined surface: the wall of each face, edge
                                      and corner */
    int lead;                      /* of a joined surface: the wall that it moves with */
    int joined;                    /* wall: 1 + index of its joined surface; 0: it is its own */
    int scale;                     /* tessellation: 1 + the scale of the bodies that it is for, see
                                      >>surfaces; else 0 */
    dem_vec3 step[2];              /* m, tessellation: it repeats in its frame by these; 0: not */
    int covered;                   /* 1: other walls are in the same place */
    int group;                     /* walls of one group do not move relative to each other, and
                                      the same materials ignore them (pistons: >>servo) */
    uint64_t ignorers;             /* materials that ignore it, when surfaces were made */
    int lone, wraps;               /* 1: no facet has neighbours in periodic images; some have */
    int open;                      /* 1: it may be a sheet: facets with open edges or repeated; a
                                      surface of revolution that is not closed; a plate without
                                      thickness */
    dem_real span_lo[3], span_hi[3];   /* m, extent in a periodic world */
    int repeats[3];                /* 1: repeats along a periodic axis, since it is not longer than
                                      the period */
    dem_real extent;               /* m, farthest vertex from the frame's origin; < 0: infinite */
    dem_pose home, pose;           /* when its motion started; now */
    dem_pose first;                /* when it was added */
    dem_pose mid;                  /* in the middle of the last step */
    dem_pose ahead, was;           /* impulses: one step ahead, see demi_ahead; one step ago */
    dem_motion motion;
    dem_vec3 glide;                /* m/s, velocity of its surface, in its frame; >>steering sets
                                      it, >>motions uses it */
    int glides;                    /* 1: that is not 0 */
    int idle;                      /* 1: its motion has not begun and leaves it where it was set */
    dem_servo servo;               /* of DEM_MOTION_SERVO, when its speed was chosen: >>servo */
    int symmetric;                 /* 1: its motion maps the surface onto itself, so it never makes
                                      a rebuild necessary */
    dem_box box;                   /* local box of the elements */
    int cells[3];                  /* local grid of elements; 0: none */
    dem_real cell;                 /* m */
    int32_t *cell_start, *cell_items;
    int cell_item_count;
    dem_wall_loads loads;
    dem_real reals[DEM_BODY_REALS];/* user-defined numbers */
} demi_wall;

/* A field of averages on a grid. */
typedef struct demi_field {
    int used;
    dem_field_desc desc;
    uint64_t samples;
    double next;                   /* s, time of the next sample */
    double *sums;                  /* demi_field_reals, see >>fields */
} demi_field;

enum { DEMI_FEED_SIZES = 64 };
/* A feed. */
typedef struct demi_feed {
    dem_feed_desc desc;
    dem_feed_state state;
    uint64_t random;               /* state of its random numbers */
    uint64_t limit[DEM_CLASSES];   /* number of grains of each class, if limited */
    double mass[DEM_CLASSES];      /* kg, mean mass of a grain */
    double lo[DEM_CLASSES], hi[DEM_CLASSES];   /* m, smallest and largest radius */
    double finer[DEM_CLASSES][DEMI_FEED_SIZES + 1]; /* cumulative number distribution, at equal
                                      steps of ln r */
    int64_t next;                  /* class of the next grain, -1: not drawn yet */
    struct {                       /* the next grain */
        dem_real radius, reach;    /* m: of the sphere of equal volume; of the bounding sphere */
        dem_quat orientation;
        double mass;               /* kg */
    } drawn;
    uint64_t again;                /* step of the next try, after one that found no room */
} demi_feed;
/* An outlet. */
typedef struct demi_outlet {
    dem_outlet_desc desc;
    dem_outlet_state state;
    int zone;                      /* number of its bits in bodies.zones; -1: it removes grains */
} demi_outlet;

/* A joint. Checkpoints store the whole struct. */
typedef struct demi_joint {
    dem_joint_desc desc;
    dem_joint_state state;
    int32_t id;
    double held;                   /* J, work of its constraint in the last step */
    double bank;                   /* J, energy that it has taken and may return */
    dem_real left, apart;          /* m: gap at the end of the step; the part of it that moving a
                                      body from outside has made */
    dem_vec3 arm[2], axis[2];      /* of a and b: m, from the centre to the joint's point; unit, in
                                      the frame of the body, the wall or space */
} demi_joint;

/* A rail. Checkpoints store the whole struct. */
typedef struct demi_rail {
    dem_body body;
    dem_rail_state state;
    dem_quat start;                /* orientation at the last step */
    dem_vec3 turn;                 /* rad/s, not spheres: spin of the step */
    dem_vec3 at, seen, on;         /* m, position at the last step: as if its path had crossed no
                                      periodic face; as it was; in the frame of its wall */
} demi_rail;

/* One level of the hierarchical grid: a class of radii with its own cells. */
typedef struct demi_level {
    double radius;                 /* m, largest of the class */
    double size[3];                /* m, of a cell */
    int cells[3], first;           /* its cells begin at w->cell_start[first] */
    int count;                     /* bodies */
} demi_level;
/* largest number of levels: classes of radii a factor sqrt 2 wide, before they are joined */
enum { DEMI_LEVELS = 24 };

/* Start of the steps of the present length. The time is computed from it, so that rounding errors
   do not accumulate. */
typedef struct demi_since { double time; uint64_t steps; double dt; } demi_since;

/* An end of a box on one axis, for the linked linear list. */
typedef struct demi_end { dem_real value; int32_t box; int32_t upper; } demi_end;

/* Properties of a pair of materials. */
typedef struct demi_pair {
    dem_pair given;
    double damping;                /* damping ratio that gives its restitution */
    int own;                       /* 1: dem_pair_set has set it, so it is no mixture */
} demi_pair;

/* The laws in force, and where in the contact history the reals of each law begin (those of
   friction at 0), see >>laws. */
struct demi_law_row;
typedef struct demi_laws {
    const struct demi_law_row *normal, *tangent, *rolling;
    int at_rolling, at_normal, memory, vectors;     /* first reals; number of reals; bits of those
                                      that are vector components */
    int at_sliding;                /* index of the real that is 1 while friction slides, behind
                                      those of the laws; DEMI_MEMORY: no pair has static friction */
    int at_twisting;               /* index of the moment of the twisting spring, likewise behind
                                      them; DEMI_MEMORY: no pair has spinning friction */
    int at_grip;                   /* of the last weight of friction, if contacts of clusters are
                                      merged; else DEMI_MEMORY */
} demi_laws;
