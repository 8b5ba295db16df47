/* dem.h - version 0.1.0 - discrete-element (granular) simulation in one C99 header. MIT licence.

   dem.h simulates grains: spheres of any radius (discs in two dimensions), ellipsoids, convex
   polyhedra and rigid clusters of spheres. They touch, rub, roll and bounce on each other and on
   moving walls.

   Include it wherever you use it. Define DEM_IMPLEMENTATION before the include in exactly *one* C
   or C++ file. dem.c is such a file: compile it once (10 to 20 s with gcc at -O2), and your own
   files compile in a moment:

       cc -O2 -c dem.c                        (add -fopenmp for threads)
       cc -O2 program.c dem.o -lm

   Contents. Search for a tag to jump to its part.
     api/ - the public half: what programs include
       >>manual            guide: a complete program, the concepts in order, glossary, references
       >>api               results, vectors, ids, choices, contacts, the built-in contact laws
       >>law-rows          user-defined laws that take a row of contacts at once
       >>scene             building a scene: worlds, materials, bodies
       >>machine           walls, joints, feeds, outlets
       >>run               running it: the time step, runs, trials, contacts, measuring
       >>record            files, replays, checkpoints, outputs, slabs, effects, the report
     >>implementation - private code from here on; users need not read it
   Volume I, what a step does:
     core/ - what everything else stands on
       >>platform          compilers, OpenMP, the parallel loop
       >>printing          text with a decimal point in every locale
       >>maths             vectors, poses, random numbers
       >>layout            data structures: lists, contacts, walls, feeds, joints
       >>state             the state of a world, and short questions about it
       >>memory            arrays of each body, errors, allocation
       >>rows              a row for each field of a desc: its limits and what is done with it
       >>stream            bytes that are written, read, counted or hashed
       >>team              the worlds that step together: a single world, or slabs
     law/ - contact laws and materials
       >>laws              table of the built-in contact laws and their coefficients
       >>materials         materials, the pair table, damping from restitution
     body/ - shapes of grains, the grains, and how they move
       >>shapes            ellipsoids and clusters of spheres: mass properties, support points
       >>balls             spheres of clusters, in their present orientations
       >>closed            inside and outside of a mesh: shells, open edges, flipped triangles
       >>hulls             convex polyhedra: hull of points, faces, mass properties
       >>unions            several shapes as one body; polygons of planar worlds
       >>filed             contact histories between two lists, by slot
       >>bodies            grains: slots, arrays, insertion, removal
       >>integrators       kick, drift and prediction; rotation
       >>cell              periodic cells that deform: images, flow, motion
     surface/ - walls
       >>facets            weights of the faces, edges and corners of a surface
       >>sheets            connected facets of a surface, their orientation and open edges
       >>motions           poses of moving walls: rotation, oscillation, tables of poses; belts
       >>walls             planes, cylinders, profiles, meshes, walls of grains, sieves
       >>joins             facets of walls that move together: doubles, covers, dividing
       >>coarsen           facets in one plane merged to fewer
       >>tessellate        curved walls and sieves as surfaces of facets
       >>surfaces          one surface per rigid motion: weights of its edges and corners
       >>distances         distance of a point from an element of a wall
     search/ - which bodies may touch: from candidates to the pruned neighbour list
       >>search            broad phase: all pairs, grids, linked linear list, bins; candidates
       >>lists             candidates on walls; persistent contacts carried over to new lists
       >>near              the pruned neighbour list that forces use
       >>rebuild           rebuilding lists: effects in force, skin, order of bodies, domains
     contact/ - contacts and their forces, by shapes
       >>touch             narrow phase: candidates to contacts, geometry only
       >>respond           stages from rows of contacts of spheres to forces and torques
       >>choose            which stages a scene needs; user-defined laws
       >>noted             notes of the contacts of a step, for events
       >>finish            what contacts give to bodies, walls, ledger, cell and events
       >>pairs             lone spheres: the loop over the pruned neighbour list
       >>polyhedra         overlap of two polyhedra, or of one and a wall
       >>gaps              distance between polyhedra, and their contact points
       >>on-walls          contacts of spheres and ellipsoids with walls
       >>polyhedra-walls   contacts of polyhedra with flat walls and walls of grains
       >>polyhedra-round   polyhedra and curved pieces of walls, in closed form
       >>polyhedra-sieves  contacts of polyhedra with sieves
       >>continued         which contact of the step before a persistent contact continues
       >>ellipsoids        contact points of ellipsoids, a tile of pairs at a time
       >>flush             fixed polyhedra that touch: one surface
       >>meets             contact geometry of two spheres or ellipsoids
       >>meets-polyhedra   contact geometry of polyhedra with other bodies
       >>meet-tables       functions by shape and by wall; contact geometry on a wall
       >>persistent              contacts with walls and of other shapes: persistent contacts
       >>points            contacts at points of bodies to forces and torques
       >>persistent-respond      persistent contacts: coefficients and histories
       >>members           contacts of spheres that may be members of clusters
     impulse/ - rigid grains: constraints, joints, solvers
       >>impulses          rigid grains: the contacts and constraints of a step
       >>joints            hinges, ball joints, motors
       >>joints-solved     all joints at once: trees, loops, the bound on their energy
       >>towers            all contacts of bodies that rest on faces at once
       >>solvers           iterative solvers for impulses
       >>impulses-told     solved impulses to forces, contact history and energy losses
     scene/ - filling a scene: size distributions, fills, feeds
       >>sizes             size distributions: sieve curves, drawing of radii, classes
       >>placing           room for new grains: regions, random fills, packings
       >>groups            named sets of bodies, selections
       >>feed              feeds and outlets
     drive/ - what is led from outside while a scene runs
       >>rails             bodies with locked axes and prescribed velocities
       >>steering          new motions and belt speeds of walls, and the forces that follow
       >>servo             walls led to a target load
       >>growth            bodies that change their size
     run/ - the time step, the step, runs; a world begins and ends
       >>advice            the time step: what is chosen and what is too large
       >>ahead             half a step ahead, where impulses act
       >>ledger            account of energy
       >>responses         table of responses: what springs and impulses do
       >>stress            cells led to a strain or stress; stress and fabric of the whole
       >>fields            averages on a grid: solid fraction, velocity, stress
       >>events            contacts from beginning to end; spectra of impacts; wear
       >>features          what optional features add to a step
       >>step              one step of a scene, phase by phase
       >>runs              runs of many steps, until a time or until grains are at rest
       >>world             creating and destroying a world
     >>services - volume II: what reads a world, writes it, shares it out; no step calls it
     measure/ - what a world is like
       >>measure           counters, contacts, angle of repose, the digest
       >>parts             the scene as rows of fields: what checkpoints and slabs compare
       >>mixing            mixing and segregation of two components
       >>impacts           spectra of impact energies, wear
     file/ - reading and writing
       >>outlines          polygons with many corners cut into triangles
       >>read              reading meshes and profiles
       >>decompose         clusters of spheres that approximate a mesh
       >>read-tables       reading grains: columns and arrays recognised by name
       >>read-grains       reading grains: text, CSV, XYZ, dumps, VTK, VTP
       >>write             writing VTP, VTK, XYZ and CSV
       >>tables            tables of bodies, contacts, fields and residence times (CSV)
       >>checkpoint        writing the complete state, bit for bit
       >>restore           checking and reading a checkpoint
       >>changed           reading a checkpoint into a world that differs
       >>output            files and calls on a schedule
     report/ - what a scene costs, what is wrong with it, what it did
       >>check             likely mistakes in a scene, found before it runs
       >>trials            cost and accuracy of other choices, tried on copies of a scene
       >>effects           which effects are active, which never happened, what each costs
       >>report            the choices made, the effects in use, what happened
     slab/ - one scene on several threads or processes
       >>slabs             one scene on several threads or processes: data and messages
       >>slabs-step        one step of all slabs
       >>slabs-run         feeds into slabs; one step after another
       >>deal              distributing a world to slabs and collecting it again
     replay/ - replays in a browser
       >>viewer            the page that plays a replay, from examples/replay/viewer.html
       >>replay            writing a replay, frame by frame
*/

#include "api/manual.h"
#ifndef DEM_H
#define DEM_H
#include "api/api.h"
#include "api/law-rows.h"
#include "api/scene.h"
#include "api/machine.h"
#include "api/run.h"
#include "api/record.h"
#endif /* DEM_H */

/* ================================================================================================
   >>implementation - stop here if you only want to use it
   ============================================================================================== */
#if defined(DEM_IMPLEMENTATION) && !defined(DEM_IMPLEMENTATION_DONE)
#define DEM_IMPLEMENTATION_DONE
/* windows.h makes macros of these two words, <complex.h> one of I, and programs make them of any
   capital letter. Formulas below use them as names; the macros are back at the end. */
#pragma push_macro("near")
#pragma push_macro("far")
#pragma push_macro("A")
#pragma push_macro("B")
#pragma push_macro("C")
#pragma push_macro("D")
#pragma push_macro("E")
#pragma push_macro("F")
#pragma push_macro("G")
#pragma push_macro("H")
#pragma push_macro("I")
#pragma push_macro("J")
#pragma push_macro("K")
#pragma push_macro("L")
#pragma push_macro("M")
#pragma push_macro("N")
#pragma push_macro("P")
#pragma push_macro("Q")
#pragma push_macro("R")
#pragma push_macro("S")
#pragma push_macro("T")
#pragma push_macro("W")
#pragma push_macro("X")
#pragma push_macro("Y")
#undef near
#undef far
#undef A
#undef B
#undef C
#undef D
#undef E
#undef F
#undef G
#undef H
#undef I
#undef J
#undef K
#undef L
#undef M
#undef N
#undef P
#undef Q
#undef R
#undef S
#undef T
#undef W
#undef X
#undef Y
/* With a switch, some private functions have no user. */
#if defined(DEM_NO_FILES) || defined(DEM_NO_REPORTS) || defined(DEM_NO_SLABS) || \
    defined(DEM_NO_REPLAY) || defined(DEM_NO_IMPULSES) || defined(DEM_NO_TRIALS) || \
    defined(DEM_NO_POLYHEDRA)
#define DEMI_LESS
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif

#include "core/platform.h"
#include "core/printing.h"
#include "core/maths.h"
#include "core/layout.h"
#include "core/state.h"
#include "core/memory.h"
#include "core/rows.h"
#include "core/stream.h"
#include "core/team.h"
#include "law/laws.h"
#include "law/materials.h"
#include "body/shapes.h"
#include "body/balls.h"
#include "body/closed.h"
#include "body/hulls.h"
#include "body/unions.h"
#include "body/filed.h"
#include "body/bodies.h"
#include "body/integrators.h"
#include "body/cell.h"
#include "surface/facets.h"
#include "surface/sheets.h"
#include "surface/motions.h"
#include "surface/walls.h"
#include "surface/joins.h"
#include "surface/coarsen.h"
#include "surface/tessellate.h"
#include "surface/surfaces.h"
#include "surface/distances.h"
#include "search/search.h"
#include "search/lists.h"
#include "search/near.h"
#include "search/rebuild.h"
#include "contact/touch.h"
#include "contact/respond.h"
#include "contact/choose.h"
#include "contact/noted.h"
#include "contact/finish.h"
#include "contact/pairs.h"
#ifndef DEM_NO_POLYHEDRA
#include "contact/polyhedra.h"
#include "contact/gaps.h"
#endif /* DEM_NO_POLYHEDRA */
#include "contact/on-walls.h"
#ifndef DEM_NO_POLYHEDRA
#include "contact/polyhedra-walls.h"
#include "contact/polyhedra-round.h"
#include "contact/polyhedra-sieves.h"
#endif /* DEM_NO_POLYHEDRA */
#include "contact/continued.h"
#include "contact/ellipsoids.h"
#ifndef DEM_NO_POLYHEDRA
#include "contact/flush.h"
#endif /* DEM_NO_POLYHEDRA */
#include "contact/meets.h"
#ifndef DEM_NO_POLYHEDRA
#include "contact/meets-polyhedra.h"
#endif /* DEM_NO_POLYHEDRA */
#include "contact/meet-tables.h"
#include "contact/persistent.h"
#include "contact/points.h"
#include "contact/persistent-respond.h"
#include "contact/members.h"
#ifndef DEM_NO_IMPULSES
#include "impulse/impulses.h"
#include "impulse/joints.h"
#include "impulse/joints-solved.h"
#include "impulse/towers.h"
#include "impulse/solvers.h"
#include "impulse/impulses-told.h"
#endif /* DEM_NO_IMPULSES */
#include "scene/sizes.h"
#include "scene/placing.h"
#include "scene/groups.h"
#include "scene/feed.h"
#include "drive/rails.h"
#include "drive/steering.h"
#include "drive/servo.h"
#include "drive/growth.h"
#include "run/advice.h"
#include "run/ahead.h"
#include "run/ledger.h"
#include "run/responses.h"
#include "run/stress.h"
#include "run/fields.h"
#include "run/events.h"
#include "run/features.h"
#include "run/step.h"
#include "run/runs.h"
#include "run/world.h"
/* ================================================================================================
   >>services - volume II: what reads a world, writes it to files or shares it out. No part above
   this line calls one below.
   ============================================================================================== */
#include "measure/measure.h"
#include "measure/parts.h"
#include "measure/mixing.h"
#include "measure/impacts.h"
#ifndef DEM_NO_FILES
#include "file/outlines.h"
#include "file/read.h"
#include "file/decompose.h"
#include "file/read-tables.h"
#include "file/read-grains.h"
#include "file/write.h"
#include "file/tables.h"
#include "file/checkpoint.h"
#include "file/restore.h"
#include "file/changed.h"
#include "file/output.h"
#endif /* DEM_NO_FILES */
#ifndef DEM_NO_REPORTS
#include "report/check.h"
#ifndef DEM_NO_TRIALS
#include "report/trials.h"
#endif /* DEM_NO_TRIALS */
#include "report/effects.h"
#include "report/report.h"
#endif /* DEM_NO_REPORTS */
#ifndef DEM_NO_SLABS
#include "slab/slabs.h"
#include "slab/slabs-step.h"
#include "slab/slabs-run.h"
#include "slab/deal.h"
#endif /* DEM_NO_SLABS */
#ifndef DEM_NO_REPLAY
#include "replay/viewer.h"
#include "replay/replay.h"
#endif /* DEM_NO_REPLAY */
#ifdef DEMI_LESS
#pragma GCC diagnostic pop
#endif
#pragma pop_macro("Y")
#pragma pop_macro("X")
#pragma pop_macro("W")
#pragma pop_macro("T")
#pragma pop_macro("S")
#pragma pop_macro("R")
#pragma pop_macro("Q")
#pragma pop_macro("P")
#pragma pop_macro("N")
#pragma pop_macro("M")
#pragma pop_macro("L")
#pragma pop_macro("K")
#pragma pop_macro("J")
#pragma pop_macro("I")
#pragma pop_macro("H")
#pragma pop_macro("G")
#pragma pop_macro("F")
#pragma pop_macro("E")
#pragma pop_macro("D")
#pragma pop_macro("C")
#pragma pop_macro("B")
#pragma pop_macro("A")
#pragma pop_macro("far")
#pragma pop_macro("near")
#endif /* DEM_IMPLEMENTATION */

/* MIT License

   Copyright (c) 2026 the dem.h authors

   Permission is hereby granted, free of charge, to any person obtaining a copy
   of this software and associated documentation files (the "Software"), to deal
   in the Software without restriction, including without limitation the rights
   to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
   copies of the Software, and to permit persons to whom the Software is
   furnished to do so, subject to the following conditions:

   The above copyright notice and this permission notice shall be included in all
   copies or substantial portions of the Software.

   THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
   IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
   FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
   AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
   LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
   OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
   SOFTWARE.
*/
