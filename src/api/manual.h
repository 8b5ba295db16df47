/* ---------------------------------------------------------------------------------------------
   >>manual
   ---------------------------------------------------------------------------------------------
   This guide explains the concepts in the order in which a new user needs them. Every function and
   field is described where it is declared: in the parts >>api, >>scene, >>machine, >>run and
   >>record. The pages in docs/ hold derivations, comparisons and measured costs.

   --- 1. A complete program ---

   It pours glass beads into a heap, records a replay for a browser and measures the slope:

       #define DEM_IMPLEMENTATION
       #include "dem.h"
       #include <stdio.h>

       int main(void) {
           dem_world_desc desc = DEM_WORLD_DESC;           // all zero: every default
           desc.gravity.z = -9.81;                         // m/s2
           dem_world *world = dem_world_create(&desc);

           dem_material_desc glass_desc = DEM_MATERIAL_DESC;
           glass_desc.density = 2500;                      // kg/m3
           glass_desc.young = 1.5e7;                       // Pa; glass has 7e10: see section 6
           glass_desc.poisson = 0.23;
           glass_desc.restitution = 0.5;
           glass_desc.friction = 0.7;
           glass_desc.rolling_friction = 0.2;              // of the effective radius: section 4
           dem_material glass = dem_material_add(world, &glass_desc);

           dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
           dem_feed_desc feed = {glass, 1, {2e-3}, {600}}; // one class: radius 2 mm, 600 beads
           feed.limited = 1;                               // and no more than these
           feed.rate = 600;                                // beads per second
           feed.box = dem_box_make(-0.006, -0.006, 0.03, 0.006, 0.006, 0.04);      // m
           dem_feed_add(world, &feed);

           dem_replay_desc replay_desc = DEM_REPLAY_DESC;
           replay_desc.interval = 0.02;                    // s between frames
           dem_replay *replay = dem_replay_open(world, "heap.html", &replay_desc);
           // 1 s; then until all beads rest, for at most 2 s (0: default speed limit of rest)
           if (dem_world_run(world, 1, dem_progress_print, stderr) != DEM_OK ||
               dem_world_settle(world, 2, 0, dem_progress_print, stderr) != DEM_OK)
               puts(dem_world_error_get(world));
           dem_replay_close(replay);
           dem_repose slope;
           dem_box all = {{0, 0, 0}, {0, 0, 0}};           // all zero: the heaviest heap
           if (dem_repose_heap_get(world, all, &slope) == DEM_OK)
               printf("slope %.2f +- %.2f rad\n", slope.angle, slope.error);
           else puts(dem_world_error_get(world));          // why it cannot be measured
           dem_world_report(world, stdout);                // laws, time step, loads: section 11
           dem_world_destroy(world);
           return 0;
       }

   Most programs follow this order: world, materials, walls, grains, run, measure, destroy. So do
   the sections below.

   --- 2. Scope, units, signs ---

   A world holds bodies (grains), walls, and optionally feeds, outlets, fields and joints. Bodies
   are rigid. Contacts are either soft (springs: a contact law computes the force from the overlap)
   or rigid (impulses prevent overlap). Worlds are three-dimensional, or planar with discs and
   polygons. dem.h has no fluids, no breaking grains and no implicit integration of springs.
   User-defined contact laws can add effects: examples/laws has capillary bridges, bonds that break,
   heat and charge. dem.h draws nothing except replays; other results are files for other programs.

   All quantities are in SI units; angles are in radians. Rotations are right-handed.
       overlap             positive while two bodies touch, negative across a gap
       normal              unit vector from body a to body b; for a wall, from the grain to the wall
       closing_speed       positive while the two approach
       force->normal       positive: repulsion
       force->tangent, force->moment    act on body a; b receives the opposite
       stress              pressure is positive

   --- 3. The world and its options ---

   A world is created from a dem_world_desc. Start from DEM_WORLD_DESC, which is all zero, and set
   only the fields you need. Zero means "absent" or "default". dem_world_desc_get returns the
   present time step and other choices of dem.h, and dem_world_report prints most of them. An effect
   that is absent costs nothing.

       dem_world_desc desc = DEM_WORLD_DESC;
       desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
       desc.domain = dem_box_make(0, -1, -1, 0.05, 1, 1);  // m; only x is periodic
       dem_world *world = dem_world_create(&desc);
       if (!world) puts(dem_world_create_error_get(&desc));

       field                    what it sets                           default (0)
       ------------------------------------------------------------------------------------------
       gravity                  acceleration, m/s2                     none
       domain, boundary         a box, and what happens at its faces   open
       planar                   discs and polygons, moving in z = 0    three dimensions
       thickness                of discs and polygons along z, m       1 m
       response                 springs (soft) or impulses (rigid)     springs
       normal_law               law of the normal force                Hertz
       tangent_law              law of friction                        a spring, if friction is set
       rolling_law              rolling resistance (EPSD: section 5)   EPSD, if its friction is set
       tension                  may a dashpot attract?                 yes
       friction_load            the load L in Coulomb's limit mu L     the repulsive normal force
       slider                   how the tangential spring and dashpot  both lie behind one slider
                                share Coulomb's limit while sliding
       convention               definitions of R*, m*, E*, G*          1/R* = 1/Ra + 1/Rb, ...
                                (the other reproduces [MIL] only)
       law, law_...             a user-defined law: section 5          built-in laws
       body_reals, ...          user-defined numbers on bodies, walls  none
       growth, ...              bodies that change their size          constant radii
       groups                   named sets of bodies                   none
       force, body_force        force fields                           none
       integrator               time integration with springs          velocity Verlet
       dt                       time step, s                           chosen; impulses: required
       impact_speed             typical impact speed, m/s: for dt      estimated from the scene
                                for a stiffness derived from young     1 m/s
       cone, solver, ...        the solution of impulses               Coulomb, Gauss-Seidel
       search, skin             broad phase and its margin, m          chosen
       rotation, ...            choices for bodies other than spheres  SPIRAL, ...
       ledger                   account of energy                      no
       threads                  OpenMP threads, at most 64             all that OpenMP offers
   The comments at dem_world_desc name the remaining fields.

   --- 4. Materials ---

   A material has a density, Young's modulus, Poisson's ratio, a coefficient of restitution and
   coefficients of friction. Damping follows from the restitution. dem.h mixes the values for each
   pair of materials; dem_pair_set replaces them:

       dem_pair pair;
       dem_pair_get(world, glass, steel, &pair);
       pair.friction = 0.3;
       dem_pair_set(world, glass, steel, &pair);

   Sources of values:
       density, young, poisson   tables of materials; soften young (section 6)
       restitution               drop a grain on a plate: sqrt(rebound height / drop height)
       friction                  tilt a plate until a block with grains glued under it slides: the
                                 tangent of that angle
       rolling_friction          fit to a measured angle of repose; usually 0.01 to 0.3

   Sliding and rolling friction are 0 unless you set them. rolling_friction is mu_r in the largest
   moment, mu_r R* Fn. The effective radius R* is R/2 between two equal spheres and R at a wall:
   if your code limits the moment to mu_r R Fn, enter 2 mu_r here for sphere on sphere. LIGGGHTS's
   model epsd uses R*, as dem.h does: keep its values.

   --- 5. Choosing a contact law ---

   Normal force (desc.normal_law):
       DEM_NORMAL_HERTZ          elastic spheres; the stiffness grows with the overlap
       DEM_NORMAL_LINEAR         the contact time does not depend on the speed; takes a given
                                 stiffness (material or pair), otherwise derives one
       DEM_NORMAL_HYSTERETIC     plastic and sticky grains: unloading is stiffer than loading, and
                                 the contact may attract
   Friction (desc.tangent_law):
       DEM_TANGENT_SPRING        default: contacts hold at rest, so heaps stay
       DEM_TANGENT_MINDLIN_RESCALED   with Hertz: a change of the load of a sheared contact creates
                                 no energy. SPRING creates some when the contact is pressed,
                                 MINDLIN when it is released; this matters if restitution is near 1
       DEM_TANGENT_VISCOUS, _STEP     cheap, without contact history: heaps creep
   Rolling resistance (desc.rolling_law):
       DEM_ROLLING_EPSD          default: an elastic-plastic spring and a dashpot (EPSD, [AI11]);
                                 holds a grain on a slope
       DEM_ROLLING_CONSTANT      a constant torque; holds a grain on a slope, too
   The other choices reproduce published models; their comments in >>api say which. docs/theory.md
   derives the laws, docs/accuracy.md lists their costs.

   Rigid grains (desc.response = DEM_RESPONSE_IMPULSES) need no law. Their steps are much longer,
   each step solves all contacts together, and only they have joints and motors. Choose them for
   dense flows of stiff grains where contact forces need not be resolved in time: docs/impulses.md.

   A user-defined law is one function (dem_law_fn in >>api). It may call the built-in laws:

       static void sticky(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
           dem_law_hertz(c, memory, force);
           dem_law_spring(c, memory, force);               // needs 3 reals of contact history
           force->normal -= DEM_R(2e-3);                   // N, adhesion
       }
       desc.law = sticky; desc.law_memory = 3; desc.law_vectors = 1;

   law_memory is the number of reals of contact history; law_vectors: how many leading triples of
   them are vectors. Other fields are law_rows (the same law for many contacts at once, which is
   faster: >>law-rows), law_stiffness (N/m, largest stiffness of the law, which limits dt; 0: that
   of the built-in law), law_range (the law acts across gaps up to it), law_who (fills in
   c->who: ids, radii, masses, user-defined numbers) and law_rate, a function that returns how
   fast the law changes such numbers, so that dem.h can limit dt. Laws see the velocity at the
   time of the positions. The Verlet schemes and leapfrog predict it from the half-step velocity
   with the force of the step before. The half-step velocity itself gives unphysical static
   friction at size ratios above 3 [VYA25].

   `make law` tests a law for mistakes (docs/laws.md). docs/own_law.md is a tutorial.

   --- 6. Choosing a time step ---

   Springs need steps that resolve a collision. Leave desc.dt at 0: dem.h then takes a fiftieth of
   the shortest contact time t_c of the scene, or less where dashpots, many contacts on one grain,
   or fast rotation require it. It adapts the step when the scene changes or grains become much
   faster than assumed. A given dt is kept. A run stops with DEM_ERROR_TIME_STEP if dt exceeds
   t_c/20 or the largest stable step of contacts with their dashpots, friction and rolling
   resistance. dem_step_advice_get returns t_c, the limit and the contact that sets it.

   Hertz's law has t_c = 2.87 (m*^2/(R* E*^2 v))^(1/5), v the impact speed: about 10 us for glass
   beads of 3 mm diameter at 1 m/s. Therefore Young's modulus is usually reduced. E smaller by 100
   makes steps longer by 100^(2/5) = 6.3. Overlaps grow by the same factor in impacts, and by
   100^(2/3) = 22 under a given load, as in a bed at rest.

   Keep the largest overlap near 0.01 radii, where results hardly depend on the stiffness. The
   report warns above 0.05. Some results tolerate more: compared with E = 1 GPa, the angle of repose
   changes by 1 % when the largest overlap is 0.024 radii, the discharge rate at 0.065 and mill
   power at 0.073 (fits, docs/accuracy.md). The program in section 1 reaches 0.047. The speed of
   sound and adhesion depend on the true stiffness.

   Impulses need a given dt, in which the fastest grain moves by less than a tenth of its radius;
   1e-3 s is usual for slow grains of some millimetres.

   dem_trials_run tries longer and shorter steps, softer grains and other laws on copies of your
   scene and reports how far your results change (docs/accuracy.md).

   --- 7. Grains and other bodies ---

   Spheres are added singly (dem_sphere_add), from arrays (dem_spheres_add, dem_grains_read), at
   random places (dem_spheres_fill, dem_sizes_fill), as a packing (dem_spheres_pack) or during the
   run (feeds). Other bodies need a shape first; many bodies may share it:

       dem_shape egg = dem_shape_ellipsoid_add(world, dem_vec3_make(3e-3, 2e-3, 2e-3));
       dem_body body = dem_body_add(world, glass, egg, dem_vec3_make(0, 0, 0.1),
                                    dem_quat_make(1, 0, 0, 0));
       dem_region box = dem_region_make(dem_box_make(-0.02, -0.02, 0, 0.02, 0.02, 0.1));
       dem_bodies_fill(world, glass, egg, box, 100, 1);    // 100 bodies, seed 1

   Shapes are ellipsoids, clusters of spheres, convex polyhedra (from points or a mesh), unions of
   polyhedra or ellipsoids, and in planar worlds polygons. A body that dem_body_set makes `fixed`
   never moves. Spheres cost least; docs/shapes.md compares costs. Ellipsoids and polyhedra have
   no contact with profiles whose edges follow the rule of [MIL] (DEM_EDGE_FRACTION), with sieves
   cut out as a disc and with DEM_SIEVE_REDUCED. dem.h refuses such a pair when you add the second
   of the two.

   --- 8. Walls and motions ---

   Walls are rigid: planes, cylinders, cones and other surfaces of revolution, profiles (segments in
   the x-y plane, extended along z), triangle meshes (STL, OBJ), walls made of spheres, and sieves.
   A plane is solid on the side opposite to its normal. A cylinder is solid outside or inside, as
   you choose. All others repel on both sides. A wall is at rest until it gets a motion:

       dem_motion turn = DEM_MOTION;
       turn.kind = DEM_MOTION_ROTATING;
       turn.axis = dem_vec3_make(0, 1, 0);                 // through turn.point, here the origin
       turn.speed = 2;                                     // rad/s
       dem_wall_motion_set(world, drum, &turn);

   Other motions are translation, oscillation, a table of poses, and a function of yours.
   dem_wall_loads_get returns force, torque and power of the grains on a wall.

   --- 9. Feeds and outlets ---

   A feed adds grains of given sizes at random places in a box, at a rate or all at once (the
   program of section 1). An outlet removes grains whose centre is in a box, or only counts them, by
   size and mass:

       dem_outlet_desc out = DEM_OUTLET_DESC;
       out.box = dem_box_make(-0.1, -0.1, -0.2, 0.1, 0.1, -0.1);
       dem_outlet drain = dem_outlet_add(world, &out);
       dem_outlet_state state;
       dem_outlet_get(world, drain, &state);               // state.total, state.total_mass

   inserted = present + removed + left holds at every step (dem_body_counts_get). `left` counts
   grains taken out by outlets and outflow boundaries, `removed` those that you removed.

   --- 10. One step ---

   A step has six stages, in the order in which data flows (the code uses the same numbers):
       1 move      first half kick, drift, predicted velocity; walls follow their motions
       2 search    if bodies moved too far for the skin: sort bodies by cell, rebuild the candidate
                   list, carry contact history over
       3 touch     pairs to contacts: bodies, contact point, normal, overlap
       4 respond   contacts to forces and torques, by the contact law; with impulses all contacts
                   are solved together (docs/impulses.md)
       5 gather    sum the forces on each body in a fixed order
       6 kick      second half kick; ledger, counters, time

   --- 11. Measuring, checking, reporting ---

       dem_body_get, dem_bodies_get          one body; arrays of all bodies
       dem_contacts_get, dem_contacts_each   contacts with forces; with their contact history
       dem_events_record                     each contact from beginning to end, with its losses
       dem_impacts_get, dem_wall_wear_get    spectra of impacts, rates of collisions; wear of a wall
       dem_wall_loads_get                    force, torque, power, work on a wall
       dem_totals_get, dem_temperature_get   mass, momentum, energy; granular temperature
       dem_bodies_select,                    bodies by group, material, size or region: their ids;
         dem_bodies_means_get                their mass, velocity, energy
       dem_field_add, dem_field_get,         solid fraction, velocity, stress on a grid; all cells,
         dem_field_cell_get                  or one
       dem_repose_heap_get, _drum_get        angle of repose
       dem_ledger_get                        where the energy went
       dem_counters_get                      steps, lists, largest overlap, memory
       dem_world_hash_get                    a digest: equal runs have equal digests

   dem_world_report prints settings, properties of pairs, counts of bodies, loads of walls and flows
   of feeds and outlets. These lines need an explanation:
       dem.h           version, precision, memory; `domains` are work groups (glossary)
       time step       (springs) t_c, t_c/dt, the limit, and the contact that limits dt: make that
                       one softer or slower to get longer steps. A further line says why a chosen dt
                       is shorter than t_c/50
       effects         the laws in force; effects that you requested and that never happened.
                       dem_effects_print lists all effects and, given a budget of wall time, what
                       each costs
       overlap         the largest so far, in radii (section 6)
       ledger          (if switched on) energy in, stored and lost, and the residual: the error of
                       the time step. In oblique impacts it falls at least with the square of dt,
                       and at 25 steps per contact it is below 1e-3 of the energy lost

   Call dem_world_check_print before the first run. It prints likely mistakes: wrong units, grains
   that overlap, a missing floor, walls out of reach, a time step that is too large.

       dem_world_check_print(world, stdout);               // returns the number of findings

   If results look wrong after a run, read the report first, then use dem_trials_run (section 6).

   --- 12. Outputs, replays, checkpoints ---

       dem_output_every_add(world, DEM_OUTPUT_VTP, "grains_####.vtp", 0.01);   // s; for ParaView
       dem_output_every_add(world, DEM_OUTPUT_CHECKPOINT, "run.checkpoint", 1);

   dem_vtp_write, dem_xyz_write and others write one file at once. A replay is one HTML file that
   any browser plays (dem_replay_open). A checkpoint holds the complete state. To continue a run,
   build the same scene again and call dem_checkpoint_read; the run goes on bit for bit, and
   scheduled outputs continue without gaps or repetitions.

   --- 13. Lifetimes, errors, threads ---

   dem.h copies descs, arrays, meshes and profiles during the call. Functions and user pointers must
   stay valid as long as the world. Pointers that dem.h returns stay valid:
       dem_bodies_get, dem_field_get    until the next call that steps or changes the world
       dem_world_error_get              until the next call that fails
       dem_mesh_read and similar        until you free them (pass the world that read them)
   An id (dem_body, dem_wall, ...) stays valid until its object is removed. Ids are never reused: a
   new body in the same slot has another generation. All-zero ids name nothing. Indices into the
   arrays of dem_bodies_get change whenever bodies are sorted; ids do not. All memory comes from
   desc.allocator. After its first steps a run allocates memory only when there are more neighbour
   pairs than ever before.

   A function that can fail returns a dem_result, a null id or a null pointer, and stores one
   message:

       if (dem_world_run(world, 1, 0, 0) != DEM_OK) puts(dem_world_error_get(world));

   A message names the function, the value, the limit, the likely cause and the remedy. After a
   failed call the world is as it was before. If a call that builds the scene fails and the program
   does not read the message, the next run fails too, with the same message. Null worlds, descs and
   result pointers are errors, not crashes. A run that goes wrong (a force that is not finite, an
   overlap larger than a radius) stops at that step and says why. dem.h never exits or aborts, and
   it prints only where you call a function that prints.

   Laws, force fields, motions, regions, progress functions and observers may call every function
   that takes the world as const; within a step dem_bodies_select and dem_bodies_means_get fail.
   Calls that change the world fail there and leave it as it is; make
   them between runs. Progress functions (except that of dem_trials_run), functions given to
   dem_contacts_each or dem_events_record and functions that compute a value of a CSV output may
   also write files and replay frames. The
   function of an output of kind DEM_OUTPUT_CALL may change the world, but not step or destroy it.
   Laws, force fields and body_reals_fn are called from several threads.

   The same program and input give the same bits for any number of threads: how many work groups
   there are depends only on the numbers of spheres and of other bodies, and every sum has a fixed
   order. Compile with -ffp-contract=off to get the same bits from other compilers, systems and
   processors. Slabs (dem_slabs_create) distribute a scene to threads, or to processes over MPI or
   any other transport: docs/parallel.md.

   Different worlds may be used from different threads at the same time. Several threads may also
   read one world by functions that take it as const, while none changes it. These calls take const
   but are not safe on several threads, because they write to the world or allocate: calls that
   fail, dem_world_error_get, dem_progress_print, dem_world_report, dem_contacts_get,
   dem_stress_get, dem_mixing_get, dem_bodies_select, dem_bodies_means_get, dem_repose_heap_get,
   dem_repose_drum_get, and in a periodic world dem_bodies_get, which wraps positions into the box.

   --- 14. Compile-time options, extensions ---

       DEM_IMPLEMENTATION   compiles the implementation into this file
       DEM_REAL             double (default) or float: type of the state. All files of a program
                            must agree; dem_world_create returns null otherwise
       DEM_STATIC           makes every function static; use it with DEM_IMPLEMENTATION
       DEM_LAW              name of your contact law, evaluated by rows (docs/extending.md)
       DEM_NO_OPENMP        never uses OpenMP, even if the compiler offers it
       DEM_THREADS_FIXED    always uses desc.threads threads, also where fewer are faster
       DEM_NO_SPECIALIZE    no fused loops for frequent sets of laws: less code, slower, same bits
       DEM_NO_CLONES        gcc on x86-64 Linux: no second copy of the loops for AVX2: less code,
                            slower unless compiled for AVX2, same bits
       DEM_DOMAIN_BODIES    approximate number of spheres per work group (2048); changes the bits

   Switches leave out what a program does not need: less code, a shorter compilation, the same bits.
   A function that is switched off is not declared, so its use is a compile error with its name. No
   struct changes, so files compiled with different switches may be linked.

       DEM_NO_FILES         reading and writing of files, checkpoints, outputs; no replays and no
                            trials either
       DEM_NO_REPLAY        replays in a browser
       DEM_NO_REPORTS       dem_world_check, dem_effects_get, dem_world_report; no trials either
       DEM_NO_TRIALS        dem_trials_run, and the costs of effects
       DEM_NO_SLABS         one scene on several threads or processes as slabs
       DEM_NO_IMPULSES      rigid grains: dem_world_create refuses DEM_RESPONSE_IMPULSES; no joints
       DEM_NO_POLYHEDRA     polyhedra and polygons
       DEM_CORE             all of these

   These tags in the code list the edits for a new contact law (>>add-law), wall (>>add-wall), shape
   (>>add-shape), integrator (>>add-integrator), search (>>add-search), solver (>>add-solver), mesh
   format (>>add-format), effect in the report (>>add-effect), array with a value for each body
   (>>add-array), feature of the step (>>add-feature), joint (>>add-joint) or option (>>add-option).
   docs/extending.md and its four sister pages walk through most of them, and `make recipes` tests
   these pages. struct dem_world in >>layout says which part owns which data.

   --- 15. Glossary ---

       body, grain         a rigid particle of any shape; both words mean the same
       candidate           two bodies, or a body and a wall element, with a gap below the skin
       cluster             a rigid body of overlapping or separate spheres, its member spheres: a
                           clump in YADE, a multisphere in LIGGGHTS, a body of fix rigid in LAMMPS.
                           It never breaks; bonded spheres do (examples/laws/bond.h)
       contact history     numbers that a contact keeps from step to step: `memory` of a law
       contact point       where two bodies, or a body and a surface, touch; there may be several
       contact time, t_c   duration of a collision
       Coulomb's limit     the largest friction force, mu L
       domain              the box desc.domain. `domains` in the report and in dem_counters are
                           work groups
       effect              a law or feature that a scene may or may not use
       facet               a triangle of a mesh or a segment of a profile
       ghost               a slab's copy of a grain of its lower neighbour
       ledger              account of energy: supplied, stored, dissipated, and the residual
       part                a member sphere of a cluster, a piece of a union, or else the whole body
       reduced, effective  of two bodies: R* = Ra Rb/(Ra + Rb), m* likewise, E* in series (Hertz)
       skin                m: a candidate list holds all pairs with gaps below the skin, so that it
                           lasts until bodies have moved half as far
       slab                a slice of the scene between two parallel planes, computed separately
       slip                tangential velocity of one surface relative to the other at the contact
       slot                the number of a body (dem_body.slot); indices change, slots do not
       spin                angular velocity, as in the literature on granular gases
       sweep               one pass of the iterative solver over all contacts
       weight              factor on the force of a contact point, so that several points of one
                           surface or cluster act as one contact
       work group          some 2000 neighbouring spheres, or fewer bodies of other shapes, which
                           one thread computes at a time

   --- 16. References, by the keys used in this file ---

     [AI11]    Ai, Chen, Rotter & Ooi, Powder Technol. 206 (2011) 269: rolling resistance
     [ALK07]   Alkhaldi, Contact Investigations of Granular Mechanical Media in a Tumbling Sorting
               Machine, thesis, Stuttgart 2007: screening, hysteresis, MOLDYN
     [BAR96]   Baraff, SIGGRAPH (1996) 137: linear time for trees of joints
     [BER03]   van den Bergen, Collision Detection in Interactive 3D Environments (2003): expanding
               polytopes
     [BER23]   Berry, Zhang & Haeri, Powder Technol. 416 (2023) 118209: what clusters of spheres
               count twice
     [BIR00]   Birgin, Martinez & Raydan, SIAM J. Optim. 10 (2000) 1196: spectral gradients
     [CS79]    Cundall & Strack, Geotechnique 29 (1979) 47
     [DIM04]   Di Maio & Di Renzo, Chem. Eng. Sci. 59 (2004) 3461: linear stiffness for a speed
     [DIR05]   Di Renzo & Di Maio, Chem. Eng. Sci. 60 (2005) 1303: Mindlin by increments
     [DLM97]   Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840: splitting
     [DUF17]   Duff et al., J. Comput. Graph. Tech. 6 (2017) 1: a frame from one vector
     [ERI05]   Ericson, Real-Time Collision Detection (2005): closest point on a triangle
     [ELA19]   Elandt, Drumwright, Sherman & Ruina, IEEE/RSJ IROS (2019) 8238: pressure fields
     [EVA08]   Evans & Morriss, Statistical Mechanics of Nonequilibrium Liquids (2008): motion
               relative to the flow of a cell
     [FEN12]   Feng, Han & Owen, Comput. Methods Appl. Mech. Eng. 205 (2012) 169: a potential of
               the overlap's volume
     [FEA08]   Featherstone, Rigid Body Dynamics Algorithms, Springer 2008: Newton-Euler along trees
     [FIN92]   Fincham, Mol. Simul. 8 (1992) 165: leapfrog for rotation
     [GJK88]   Gilbert, Johnson & Keerthi, IEEE J. Robot. Autom. 4 (1988) 193: distance of convex
               bodies
     [GOL10]   Goldhirsch, Granul. Matter 12 (2010) 239: stress by coarse graining
     [HER82]   Hertz, J. reine angew. Math. 92 (1882) 156
     [HEY13]   Heyn, Anitescu, Tasora & Negrut, Int. J. Numer. Methods Eng. 95 (2013) 541: spectral
               gradients for cones
     [HOA61]   Hoare, Comm. ACM 4 (1961) 321: the k-th of many by exchanges
     [JEA99]   Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235: Gauss-Seidel over contacts
     [LAC54]   Lacey, J. Appl. Chem. 4 (1954) 257: mixing index
     [LEE72]   Lees & Edwards, J. Phys. C 5 (1972) 1921: images that move with the shear
     [MAZ11]   Mazhar, Heyn & Negrut, Multibody Syst. Dyn. 26 (2011) 37: collisions by bins
     [MAZ15]   Mazhar, Heyn, Negrut & Tasora, ACM Trans. Graph. 34 (2015) 32: accelerated gradients
     [MIL]     a thesis on tumbling mills on a GPU (our copy has neither author nor year): laws by
               the step, meshes, segments
     [MW47]    Mann & Whitney, Ann. Math. Stat. 18 (1947) 50: comparison of ranks
     [ODO15]   O'Donoghue & Candes, Found. Comput. Math. 15 (2015) 715: when to restart
     [OGA12]   Ogarko & Luding, Comput. Phys. Commun. 183 (2012) 931: hierarchical grids
     [PAI95]   Painleve, C. R. Acad. Sci. Paris 121 (1895) 112: a rod that friction jams
     [PW85]    Perram & Wertheim, J. Comput. Phys. 58 (1985) 409: contact function of ellipsoids
     [RUB15]   Rubio-Largo, Lind, Maza & Hidalgo, Comput. Part. Mech. 2 (2015) 127: granular gas of
               ellipsoids on GPUs
     [SIL10]   Silcowitz, Niebe & Erleben, Visual Comput. 26 (2010) 893: conjugate sweeps
     [SP07]    Schwager & Poeschel, Granul. Matter 9 (2007) 465: restitution of the linear dashpot
     [SPI24]   del Valle et al., Comput. Phys. Commun. 297 (2024) 109077: SPIRAL
     [STE96]   Stewart & Trinkle, Int. J. Numer. Methods Eng. 39 (1996) 2673: rigid bodies by steps
     [TAS10]   Tasora & Anitescu, J. Comput. Nonlinear Dyn. 5(3) (2010) 1: impulses in convex cones
     [THO13]   Thornton, Cummins & Cleary, Powder Technol. 233 (2013) 30: rescaling on unloading
     [TON12]   Tonge et al., ACM Trans. Graph. 31 (2012) 105: Jacobi with split masses
     [TSU92]   Tsuji, Tanaka & Ishida, Powder Technol. 71 (1992) 239: delta^(1/4) damping
     [VYA25]   Vyas et al., Comput. Phys. Commun. 310 (2025) 109524: law velocities at the full
               step
     [WEL62]   Welford, Technometrics 4 (1962) 419: variances in one pass
     [ZHO99]   Zhou et al., Physica A 269 (1999) 536: constant rolling torque
*/
