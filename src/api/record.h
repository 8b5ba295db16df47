/* ---------------------------------------------------------------------------------------------
   >>record
   A run in files: tables and pictures, replays, checkpoints, scheduled outputs. Slabs, which share
   one scene among processors. What a scene contains and what it costs. Errors are as in >>run.
   --------------------------------------------------------------------------------------------- */

#ifndef DEM_NO_FILES
/* ---- files ---- */

/* Defects of a mesh, as counted on reading. They never stop a run. */
typedef struct dem_mesh_health {
    int open_edges;           /* edges with one triangle */
    int crowded_edges;        /* edges with more than two triangles */
    int duplicates;           /* triangles with the same three corners as an earlier one */
    int shells;               /* pieces that are connected by edges with two triangles */
    int flipped;              /* triangles that face another way than most of their shell */
    int twisted_edges;        /* edges of shells that have one side only, like a Moebius strip */
    int slivers;              /* triangles: height below 1e-3 of the longest side, or no area */
    int merged_vertices;      /* vertices merged on reading, because they were equal (STL) */
    int split_faces;          /* faces of more than three corners, cut into triangles (OBJ) */
    int bent_faces;           /* of these: a corner is off their plane by > 1e-3 of their size */
    int crossed_faces;        /* of these: an edge crosses another, or they have no area */
    dem_box box;              /* m, bounds of the mesh */
    char hint[200];           /* a likely mistake of units, or "" */
} dem_mesh_health;
/* Reads the triangles of a file and, if `health` is not null, counts its defects. The contents
   identify the format: STL (text or binary), OBJ, or the text format of [MIL] (counts, vertices,
   corners counted from 1). OBJ faces of more than three corners become triangles that cover them
   once and keep their winding; a face that is not convex may have 10,000 corners. Error messages
   name file, line and reason. Free the mesh with dem_mesh_free. */
DEM_API dem_result dem_mesh_read(dem_world *world, const char *path, dem_mesh *mesh,
                                 dem_mesh_health *health);
/* Reads triangles from memory, `size` bytes at `data`, as dem_mesh_read does. name: for error
   messages; or null. */
DEM_API dem_result dem_mesh_parse(dem_world *world, const char *name, const void *data,
                                  size_t size, dem_mesh *mesh,
                                  dem_mesh_health *health);
/* Reads one named part of a file, such as the shell, the ends or the lifters of a drum. In an STL
   text file this is the solid of that name (the whole rest of its line). In an OBJ file these are
   the faces whose object (`o NAME`) or one of whose groups (`g NAME NAME`) has that name; a `g`
   line replaces the groups before it and leaves the object. If the file has no such part, the error
   message lists its parts. health: or null. */
DEM_API dem_result dem_mesh_part_read(dem_world *world, const char *path, const char *part,
                                      dem_mesh *mesh, dem_mesh_health *health);
/* Frees a mesh that this world has read. */
DEM_API void dem_mesh_free(dem_world *world, dem_mesh *mesh);
/* Scales a mesh about its origin (scale > 0; 1e-3: from mm to m), rotates it about the origin, and
   moves it by `to` (m, components up to 1e15). A rotation of zeros is none; any other length is
   normalised. Call it before the mesh becomes a wall or a shape. */
DEM_API dem_result dem_mesh_place(dem_world *world, dem_mesh *mesh, dem_real scale,
                                  dem_quat rotation, dem_vec3 to);
/* The mass properties of a closed mesh, and how well spheres fit it. */
typedef struct dem_spheres_fit {
    dem_real volume;          /* m3, of the mesh, exact */
    dem_vec3 centre;          /* m, centre of mass of the mesh, exact */
    dem_real inertia[6];      /* m5, of the mesh, exact, as in dem_cluster_desc */
    dem_real volume_error;    /* volume of the union of spheres over that of the mesh, less 1 */
    dem_real inertia_error;   /* the same of the moment that deviates most; computed on the grid */
    dem_real surface_error;   /* m, root mean square distance of the mesh from the union */
    dem_real wrong;           /* volume in only one of the two, over that of the mesh */
} dem_spheres_fit;
/* Approximates a closed mesh by `count` spheres (1 to 1000), for a cluster: writes positions (count
   x 3) and radii (count), in m, in the frame of the mesh. On a grid with 40 points along the
   longest side, each sphere is placed where it leaves the fewest points wrong; then all are placed
   again, one at a time, while that helps. fit: or null. A cluster of few spheres has the mass and
   moments of the body if it gets volume, centre and inertia of `fit` (DEM_CLUSTER_GIVEN).
   Inconsistent winding, a mesh that is inside out, and duplicate triangles do no harm. A shell
   inside another that faces the other way is a cavity. Errors: an open mesh, edges whose triangles
   do not pair, a surface with one side only, shells that cross or that face the same way as the
   shell around them, a mesh too thin for any sphere. */
DEM_API dem_result dem_mesh_spheres(dem_world *world, const dem_mesh *mesh, int count,
                                    dem_real *positions, dem_real *radii, dem_spheres_fit *fit);
/* A named part of a file that becomes a wall. */
typedef struct dem_wall_part {
    const char *name;         /* as for dem_mesh_part_read */
    dem_material material;
    dem_motion motion;        /* DEM_MOTION: the wall stays where it is */
} dem_wall_part;
/* Adds a machine from CAD: `count` (>= 1) named parts of a file (STL text, OBJ), each as a wall
   with its own material and motion. scale: m per unit of length of the file, > 0; 0: 1. walls:
   receives `count` ids; or null. If one part fails, no wall is added. */
DEM_API dem_result dem_wall_parts_add(dem_world *world, const char *path, dem_real scale, int count,
                                 const dem_wall_part *parts, dem_wall *walls);
/* Reads the segments of a profile in the text format of [MIL] in 2-D: the counts of vertices and
   segments, x y per vertex, two corners counted from 1 per segment. Free with dem_profile_free. */
DEM_API dem_result dem_profile_read(dem_world *world, const char *path, dem_profile *profile);
/* Reads the segments of a profile from memory, `size` bytes at `data`. name: for error messages; or
   null. */
DEM_API dem_result dem_profile_parse(dem_world *world, const char *name, const void *data,
                                     size_t size,
                                     dem_profile *profile);
/* Frees a profile that this world has read. */
DEM_API void dem_profile_free(dem_world *world, dem_profile *profile);

/* Spheres, as read from a file. Arrays for which the file has no data are null. */
typedef struct dem_grains {
    int count;
    dem_real *positions, *radii;     /* m, count x 3; m, count */
    dem_real *velocities, *spins;    /* m/s, count x 3; rad/s, count x 3 */
    int32_t *materials;              /* count: numbers of the file, 1: the first material added */
    int lines_left;                  /* dumps and XYZ: lines of later frames, which are not read */
    char ignored[240];               /* names of columns without use, or "" */
} dem_grains;
/* Reads grains from a file. The contents identify the format; lengths are in m:
   - text or CSV, one line per grain. Columns are separated by semicolons, tabs, commas or blanks,
     as in the first line. A decimal comma is allowed between semicolons or tabs. Cells may be
     quoted; # begins a comment. The first line, or a comment before it, names the columns; without
     names they are x y z r, or x y z r vx vy vz. An empty cell in a column that is used is an
     error.
   - extended XYZ with Properties (OVITO, ASE, dem_xyz_write), and dumps of LAMMPS and LIGGGHTS: the
     first frame. Pass the lines of another frame to dem_grains_parse.
   - legacy VTK, VTP and VTU (ParaView, LIGGGHTS, dem_vtp_write) as ASCII, base64 or raw bytes; a
     compressed file is an error.
   Names, in upper or lower case:
       position          x y z, or position, pos, points
       size              r or radius, d or diameter
       velocity          vx vy vz, or v, vel, velo, velocity
       angular velocity  wx wy wz, or omega, spin, angular_velocity
       material          material; otherwise type, if it is a number
   A component may follow a name, as in velocity:0, omegax, Position.X, and then a unit: (m), (mm),
   (cm), (um), (mm/s), (rad/s). `ignored` lists other columns, and the second of two that mean the
   same. Each sphere of a file of clusters becomes one grain. Error messages name file, line and
   reason. Free with dem_grains_free. */
DEM_API dem_result dem_grains_read(dem_world *world, const char *path, dem_grains *grains);
/* Reads grains from memory, `size` bytes at `data`, as dem_grains_read does. name: for error
   messages; or null. */
DEM_API dem_result dem_grains_parse(dem_world *world, const char *name, const void *data,
                                    size_t size, dem_grains *grains);
/* Frees grains that this world has read. */
DEM_API void dem_grains_free(dem_world *world, dem_grains *grains);
/* Adds all grains as spheres of one material or, if its id is 0, of the materials whose numbers the
   file gives. If one grain has a bad value, none is added. */
DEM_API dem_result dem_grains_add(dem_world *world, dem_material material,
                                  const dem_grains *grains);

/* The functions below, except dem_wall_loads_csv_write, which appends, write to a temporary name
   and then rename the file, so that it is complete or absent. Links are followed; a pipe or a
   terminal is an error. In all files `id` is dem_body.slot less 1. */

/* Writes the bodies for ParaView (VTP): points with radius, velocity, spin, id, material and
   body_reals, with desc.groups also groups (bit id - 1: in that group). A cluster or union is one
   point per sphere or piece, all with its id. If bodies have orientations, also the orientation of
   the piece (quaternion w x y z) and its semi_axes (m). To draw them in ParaView: Glyph, a
   sphere of radius 1, scaled by semi_axes, rotated by orientation (quaternion). */
DEM_API dem_result dem_vtp_write(dem_world *world, const char *path);
/* Writes the same as a legacy VTK file, binary. */
DEM_API dem_result dem_vtk_write(dem_world *world, const char *path);
/* Writes the bodies for OVITO and ASE (extended XYZ): a chemical element that numbers the material
   (H: 1, He: 2), position, radius, velocity, body_reals and id. If bodies have orientations, also
   the orientation (x y z w) and semi-axes. The domain becomes the lattice. */
DEM_API dem_result dem_xyz_write(dem_world *world, const char *path);
/* Writes the contacts for ParaView (VTP), to show bonds, bridges and force chains: lines from
   centre to centre (with a wall: to the contact point), with force (N, on a), overlap (m), wall
   (id, 0: none) and the contact history under its names. Computes forces first if the scene has
   changed. */
DEM_API dem_result dem_contacts_vtp_write(dem_world *world, const char *path);
/* Writes the triangles of all meshes, profiles and surfaces of revolution in their present pose
   (VTP), with the id of the wall. Profiles are extruded from z0 to z1 (m, z0 < z1). While contacts
   are recorded (dem_events_record), the column `sliding` has the work of sliding on the facet or
   segment of each triangle, J, as returned by dem_wall_wear_facets_get. It is 0 on surfaces of
   revolution. */
DEM_API dem_result dem_walls_vtp_write(dem_world *world, const char *path, dem_real z0,
                                       dem_real z1);
/* Writes the surfaces of all bodies as polygons (VTP), with velocity (of each corner), id, material
   and body_reals. Polyhedra are drawn by their faces, round bodies by facets. */
DEM_API dem_result dem_surfaces_vtp_write(dem_world *world, const char *path);
/* Appends the loads of a wall to a CSV file: time (s), force (N), torque (N m), axial torque (N m),
   power (W), number of contacts. Writes the heading first if the file is new or empty. */
DEM_API dem_result dem_wall_loads_csv_write(dem_world *world, dem_wall wall, const char *path);

/* The next four write tables (CSV): a line of names, then one line per item. `id` is as above. */

/* Writes the bodies: id, number of the material, (bounding) radius, position, velocity, spin and
   body_reals. If a field averages bodies (dem_field_desc.bodies), also the samples, and mean and
   variance of velocity, spin and force. dem_grains_read reads such a table. */
DEM_API dem_result dem_bodies_csv_write(dem_world *world, const char *path);
/* Writes the contacts: ids of a and b (-1: a wall), wall (0: none), point (m), normal (from a to
   b), overlap (m) and force (N, on a). Computes forces first if the scene has changed. */
DEM_API dem_result dem_contacts_csv_write(dem_world *world, const char *path);
/* Writes the cells of a field: centre (m) and what dem_field_cell_get returns. */
DEM_API dem_result dem_field_csv_write(dem_world *world, dem_field field, const char *path);
/* Writes the distribution of the residence times of an outlet with residence_bin: for each bin up
   to the last one in use its middle (s), its grains, their fraction per s, and the fraction of all
   grains up to its end. */
DEM_API dem_result dem_outlet_residence_csv_write(dem_world *world, dem_outlet outlet,
                                                  const char *path);

#endif /* DEM_NO_FILES */
#ifndef DEM_NO_REPLAY
/* ---- replay: a run in one HTML file ---- */

/* A replay plays in any browser, without network or other files. It shows grains of every shape,
   coloured by speed, size, material or a number of your choice, walls as they move, plots of values
   against time, and the report. The mouse rotates the view.

       dem_replay_desc desc = DEM_REPLAY_DESC;
       desc.interval = 0.01;                           // s, from frame to frame
       dem_replay *replay = dem_replay_open(world, "pile.html", &desc);
       dem_world_run(world, 1, 0, 0);
       dem_replay_close(replay);

   A grain at rest takes 1.3 bytes per frame, a moving one at most 31; docs/replay.md gives measured
   sizes. The replay is written to a new file, path.XXXXXXXX.tmp, which dem_replay_close renames to
   `path`. A run that is killed leaves that file; renamed to a name in .html it plays up to its last
   complete frame. */
typedef struct dem_replay dem_replay;
/* Largest number of values that a replay plots. */
enum { DEM_REPLAY_VALUES = 16 };
/* How a replay is recorded. Begin with DEM_REPLAY_DESC. */
typedef struct dem_replay_desc {
    const char *title;          /* copied; null means the name of the file */
    /* Name of the numbers by which grains can be coloured: one in desc.body_reals, a group in
       desc.groups (1: member, 0: not), or one for the values of number_fn. Null means the first
       name, or "number". Copied, at most 63 characters. */
    const char *number;
    /* returns the number of a body, for every frame; null means one of desc.body_reals */
    double (*number_fn)(const dem_world *world, dem_body body, void *user);
    void *user;                 /* passed to number_fn; or null */
    /* m, >= 0, of positions; 0 means 1/32 of the smallest radius in the first frame */
    dem_real resolution;
    /* s, >= 0: a run writes frames automatically, the first when it begins and then at the steps
       nearest to multiples of the interval. A frame that cannot be written ends the replay, not the
       run: dem_replay_close returns the error. 0 means frames only from dem_replay_frame_write. */
    double interval;
    /* >= 0: n records the contact forces in every n-th frame. The viewer draws them as lines
       between centres, or from a centre to the contact point with a wall, wider and redder for
       larger forces. A frame has at most the 50,000 largest, and none below 1 % of its largest. 0
       means none. */
    int contacts;
} dem_replay_desc;
static const dem_replay_desc DEM_REPLAY_DESC_ZERO = DEM_ZERO;
#define DEM_REPLAY_DESC DEM_REPLAY_DESC_ZERO
/* Opens a replay of the world. desc: or null, for DEM_REPLAY_DESC. Close the replay before its
   world is destroyed. */
DEM_API dem_replay *dem_replay_open(dem_world *world, const char *path,
                                    const dem_replay_desc *desc);
/* Writes the present state as a frame. 30 to 300 frames make a good replay. */
DEM_API dem_result dem_replay_frame_write(dem_replay *replay);
/* Sets a value of the next frame, which the replay plots against time. name: 1 to 63 characters, at
   most 16 different names; it ends with the unit in brackets, and values with the same unit share a
   scale. A value that is not finite leaves a gap. */
DEM_API dem_result dem_replay_value_set(dem_replay *replay, const char *name, double value);
/* Adds the report, completes the file and frees the replay, also if it returns DEM_ERROR_FILE or
   DEM_ERROR_MEMORY. */
DEM_API dem_result dem_replay_close(dem_replay *replay);

#endif /* DEM_NO_REPLAY */
#ifndef DEM_NO_FILES
/* ---- checkpoints ---- */

/* Writes a checkpoint: the whole state, with bodies, walls, contact history, neighbour list,
   ledger, fields, counters, and what each scheduled output has written. An error if a body is not
   at a finite position and velocity; then an existing file stays. */
DEM_API dem_result dem_checkpoint_write(dem_world *world, const char *path);
/* Reads a checkpoint and replaces the state of the world, which then continues bit for bit. The
   world must have been built like the one that wrote it, with the same desc, materials, pairs,
   shapes, walls, fields, feeds and outlets. Functions and user pointers are not stored. Number of
   threads, allocator, allow_large_dt, unsolved_stops, overlap_stop, law_rows and user pointers may
   differ.
   Errors: a file that is cut short, damaged, or of another version, precision, DEM_DOMAIN_BODIES or
   memory layout; a file of another scene, for which the message names the first field that differs,
   with both values. */
DEM_API dem_result dem_checkpoint_read(dem_world *world, const char *path);
/* The same for a world that differs from the one that wrote the file. allowed: words, each the name
   of a field of dem_world_desc, such as "dt ledger orientations tangent_law", or "materials" (all
   but density, and the pairs that are mixtures of them) or "pairs" (also those of dem_pair_set); ""
   allows nothing. Fields named there keep the values of this world.
   Everything else must agree; domain, boundary, planar, thickness, response, body_reals,
   law_memory_names, groups, shapes, walls, fields, feeds and outlets always. Contact histories are
   converted where a law is the same, and begin at 0 if a law is user-defined and `law`,
   `law_memory` or the like differs. If the file has no ledger, the ledger begins with the present
   kinetic energy as `inserted` and the present elastic energy as `growth`. Otherwise `growth`
   receives the energy that springs hold more than in the file. */
DEM_API dem_result dem_checkpoint_read_changed(dem_world *world, const char *path,
                                               const char *allowed);
/* Returns what differed in the last checkpoint that dem_checkpoint_read_changed has read, such as
   "dt: 1e-05 there, 2e-05 here", or "". */
DEM_API const char *dem_checkpoint_changes_get(const dem_world *world);

#endif /* DEM_NO_FILES */
/* ---- outputs on a schedule ---- */

/* A scheduled output. */
typedef struct dem_output { int32_t id; } dem_output;                        /* id counts from 1 */
/* Largest number of columns of a CSV file, the time not counted. */
enum { DEM_OUTPUT_COLUMNS = 32 };
/* The action of an output. */
typedef enum dem_output_kind {
    DEM_OUTPUT_CALL = 0,     /* calls a function */
    DEM_OUTPUT_VTP,          /* dem_vtp_write */
    DEM_OUTPUT_XYZ,          /* dem_xyz_write */
    DEM_OUTPUT_CONTACTS,     /* dem_contacts_vtp_write */
    DEM_OUTPUT_CHECKPOINT,   /* dem_checkpoint_write */
    DEM_OUTPUT_CSV,          /* appends the time and some values as a line to a CSV file */
    DEM_OUTPUT_SURFACES,     /* dem_surfaces_vtp_write */
    DEM_OUTPUT_WALLS,        /* dem_walls_vtp_write, from z0 to z1 */
    DEM_OUTPUT_BODIES_CSV,   /* dem_bodies_csv_write */
    DEM_OUTPUT_CONTACTS_CSV, /* dem_contacts_csv_write */
    DEM_OUTPUT_FIELD_CSV     /* dem_field_csv_write, of `field` */
} dem_output_kind;
/* How an output works. Begin with DEM_OUTPUT_DESC. */
typedef struct dem_output_desc {
    dem_output_kind kind;
    /* Name of the file, copied. In "grains_####.vtp" the number of the output replaces ####; it is
       0 at `start`. Without # the file is replaced each time. The path of a CSV file has no #.
       DEM_OUTPUT_CALL: or null. */
    const char *path;
    double interval;         /* s, required, 1e-12 to 1e15 */
    double start, end;       /* s, times of the first and the last; end 0 means no last */
    /* CSV: what a line contains. One of five: the loads of this wall, as dem_wall_loads_csv_write;
       the counts of an outlet; the mixing of two components, if mixing.cells are set; the values
       that `values` writes, with `columns` as their names (1 to 32 words as in body_reals, copied);
       or, if none of these is set, steps, bodies, contacts, kinetic and rotational energy (J) and
       overlap_max */
    dem_wall wall;
    const char *columns;
    void (*values)(const dem_world *world, double *values, void *user);
    /* CALL: may change the world, but not step it. A return value other than 0 stops the run
       (DEM_ERROR_STOPPED). */
    int (*function)(dem_world *world, int64_t number, void *user);
    void *user;              /* passed to `values` and `function`; or null */
    dem_mixing_desc mixing;  /* CSV: see above */
    dem_field field;         /* FIELD_CSV: required */
    /* m, WALLS: profiles are extruded from z0 to z1 (z0 <= z1). If they are equal, as with
       dem_output_every_add: over desc.thickness (planar), over desc.domain along z if it has an
       extent, or else from the lowest to the highest body */
    dem_real z0, z1;
    /* CSV: grains that the outlet has counted (total, sorted, gangue, back, held) and their mass,
       kg, as in dem_outlet_state */
    dem_outlet outlet;
} dem_output_desc;
static const dem_output_desc DEM_OUTPUT_DESC_ZERO = DEM_ZERO;
#define DEM_OUTPUT_DESC DEM_OUTPUT_DESC_ZERO
#ifndef DEM_NO_FILES
/* Adds an output that a run writes automatically, at the steps nearest to start, start + interval
   and so on, in the order in which outputs were added. The first line of a CSV file replaces an
   older file of that name; a file with other columns is an error of the run. If a file cannot be
   written, the run stops with the state intact, and the next run tries that output again. Slabs
   have no outputs.
   After a restart: a checkpoint stores what each output has written. A world that reads it
   continues from there, with nothing missing and nothing twice, and removes later lines of a CSV
   file before it appends the next. Outputs are matched by kind and path, so add them before reading
   the checkpoint. Other outputs may be added, and times may differ.
   A function (DEM_OUTPUT_CALL) may add outputs, and write and read checkpoints; a checkpoint that
   it writes counts the present call as done. */
DEM_API dem_output dem_output_add(dem_world *world, const dem_output_desc *desc);
/* Adds an output by kind, path and interval (s) alone:
   dem_output_every_add(world, DEM_OUTPUT_VTP, "grains_####.vtp", 0.01). */
DEM_API dem_output dem_output_every_add(dem_world *world, dem_output_kind kind, const char *path,
                                        double interval);
/* Ends an output; files that it has written stay. Its id is never used again. To change an output,
   remove it and add another. The function of an output may remove any output, also its own. */
DEM_API dem_result dem_output_remove(dem_world *world, dem_output output);

#endif /* DEM_NO_FILES */
#ifndef DEM_NO_SLABS
/* ---- slabs: one scene on many processors ---- */

/* How slabs in different processes communicate; all zero for a single process. Processes form a
   ring in the order of their slabs (the last is below the first), and make the same calls in the
   same order. Both functions return 0, or another value to stop the run; slabs cannot be used after
   that. docs/parallel.md shows both for MPI. */
typedef struct dem_transport {
    /* Sends to the process below and to the one above, and receives from both. Sizes are in bytes,
       known on both ends, and may be 0. Both neighbours may be the same process: what it sends up
       then arrives from below. */
    int (*exchange_fn)(const void *to_lower, size_t to_lower_size,
                       void *from_lower, size_t from_lower_size,
                       const void *to_upper, size_t to_upper_size,
                       void *from_upper, size_t from_upper_size, void *user);
    /* Replaces each of `count` values by its sum (sum = 1) or maximum (sum = 0) over processes. */
    int (*reduce_fn)(double *values, int count, int sum, void *user);
    void *user;                /* passed to both; or null */
} dem_transport;

/* How a scene is divided. Begin with DEM_SLABS_DESC. */
typedef struct dem_slabs_desc {
    int axis;                  /* 0, 1, 2: borders are planes x, y, z = const */
    /* required, 1 to 1024: number of slabs in all processes; only runs with the same number have
       the same bits */
    int count;
    /* this process holds the slabs first to first + local - 1; local 0 means all */
    int first, local;
    dem_transport transport;   /* required if another process holds slabs */
    /* borders move if the work of the busiest slab exceeds this many times the mean, >= 1; 0 means
       1.1. Below 0 borders do not move. */
    dem_real balance;
    int balance_interval;      /* rebuilds between two checks of the balance; 0 means 8 */
} dem_slabs_desc;
static const dem_slabs_desc DEM_SLABS_DESC_ZERO = DEM_ZERO;
#define DEM_SLABS_DESC DEM_SLABS_DESC_ZERO

/* The slabs that one process holds. */
typedef struct dem_slabs dem_slabs;

/* Creates slabs from a world: copies its grains to them, with everything a step needs. The world
   stays as it is, and may be destroyed. Every process builds the same world and passes its own
   `first` and `local`. Feeds and outlets continue in the slabs. Errors, which
   dem_world_error_get(world) returns: impulses, bodies on rails, a deformed cell, a field with
   variance; a recording of contacts if several processes hold the slabs; processes that have built
   different scenes. */
DEM_API dem_slabs *dem_slabs_create(dem_world *world, const dem_slabs_desc *desc);
/* Destroys slabs and frees their memory. */
DEM_API void dem_slabs_destroy(dem_slabs *slabs);
/* Advances all slabs by `steps` time steps (>= 0). Errors as for dem_world_step; DEM_ERROR_STOPPED
   also if the transport has failed. */
DEM_API dem_result dem_slabs_step(dem_slabs *slabs, int steps);
/* Copies the state of all slabs into a world of the same scene, in every process: grains, contact
   history, walls, loads, fields, feeds, outlets, ledger, time. The world can then be measured,
   written, stepped, or divided into slabs again, without effect on these slabs. It has no neighbour
   list until dem_candidates_rebuild; after that it continues as the slabs would. */
DEM_API dem_result dem_slabs_collect(dem_slabs *slabs, dem_world *world);
/* Sets the time integrals of wall loads and the largest overlap to 0, in this process's slabs. */
DEM_API void dem_slabs_loads_reset(dem_slabs *slabs);
/* Returns the error message of the last failed call on these slabs, or "". */
DEM_API const char *dem_slabs_error_get(const dem_slabs *slabs);

/* One slab. */
typedef struct dem_slab {
    int grains, ghosts;        /* its own grains; copies of grains of the lower neighbour */
    double lo, hi;             /* m, its borders; -1e300, 1e300: none on that side */
    double work;               /* candidates + 4 per body, at the last rebuild */
    double seconds;            /* wall time spent on it so far */
    uint64_t bytes;            /* sent to its neighbours so far, as if in other processes */
} dem_slab;
/* Describes one slab of this process; index: first to first + local - 1. */
DEM_API dem_result dem_slab_get(const dem_slabs *slabs, int index, dem_slab *slab);
/* Counters of slabs. */
typedef struct dem_slabs_counters {
    double time;               /* s, simulated */
    uint64_t steps, rebuilds, border_moves;
    uint64_t migrated;         /* grains that changed slabs, in this process */
    dem_real skin, dt;         /* m, s, in use */
} dem_slabs_counters;
/* Returns the counters of slabs. */
DEM_API dem_slabs_counters dem_slabs_counters_get(const dem_slabs *slabs);

#endif /* DEM_NO_SLABS */
#ifndef DEM_NO_REPORTS
/* ---- effects: what a scene contains, what has happened, and what each effect costs ---- */

/* The state of an effect. */
typedef enum dem_effect_state {
    DEM_EFFECT_OFF,                /* the scene does not contain it; it costs nothing */
    DEM_EFFECT_IDLE,               /* the scene contains it, but it has not happened so far */
    DEM_EFFECT_ACTIVE
} dem_effect_state;
/* An effect of the scene, such as friction, walls or the ledger. */
typedef struct dem_effect {
    const char *name;
    dem_effect_state state;
    /* fraction of the time of a step that is saved without the effect; its standard error */
    double share, error;
    int measured;                  /* 1: share was measured; 0: no budget, or it cannot be */
    /* number of pairs of materials, walls and the like that have the effect and that nothing has
       touched; 0: everything in the scene has happened */
    int missing;
    char text[200];                /* what acts; why nothing acts; what has not happened */
} dem_effect;
/* Number of effects. */
enum { DEM_EFFECTS = 19 };
#ifndef DEM_NO_TRIALS
/* Writes for every effect whether it is off, idle or active, and returns their number. It finds a
   material with rolling friction on which nothing has rolled, or a wall that nothing has touched.
   It can miss contacts of spheres that begin and end between two neighbour lists. If `budget` (s of
   wall time, >= 0) is not 0, it also measures what each effect costs: two copies of the world, one
   without the effect, take steps in turn. User-defined laws (by pointer) and fields are called
   twice instead of being left out, and friction is left out together with rolling friction. Shares
   need not add up to 1; on a busy machine they are noise. User-defined functions are called for the
   copies, too. The world does not change. Returns -1 also if the scene would not run. */
DEM_API int dem_effects_get(dem_world *world, double budget, dem_effect effects[DEM_EFFECTS]);
/* Prints the effects as lines of text. A share outside -0.1 to 1, or with an error above 0.1, is
   printed as "too noisy". */
DEM_API void dem_effects_print(dem_world *world, double budget, FILE *out);
#endif /* DEM_NO_TRIALS */

/* ---- report ---- */

/* Prints the report: bodies, time step and what limits it, contact detection, laws and effects,
   what the scene contains but has not happened, the largest overlap, pairs of materials, loads of
   walls, joints, feeds, outlets, and the ledger. It calls a user-defined force field and
   desc.growth once per body. */
DEM_API void dem_world_report(const dem_world *world, FILE *out);
#endif /* DEM_NO_REPORTS */

/* Creates a world if `version` and `real_size` (bytes of dem_real) are those of the implementation,
   and returns null otherwise. Call dem_world_create, which passes both. */
DEM_API dem_world *dem_world_create_checked(const dem_world_desc *desc, int version,
                                            size_t real_size);
/* Creates an empty world; see dem_world_desc. */
static inline dem_world *dem_world_create(const dem_world_desc *desc) {
    return dem_world_create_checked(desc, DEM_VERSION, sizeof(dem_real));
}

#ifdef __cplusplus
}
#endif
