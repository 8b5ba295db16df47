# CUBES in YADE: its polyhedra, pushed apart by kn times the volume they share. kn of a whole face on another one is that
# of dem.h's linear law, 10 kN/m. YADE's law has no dashpots; Newton's damping is how its own examples come to rest.
# yade -n -x yade_cubes.py FILE STEPS WARM DT; prints seconds of the processor, contacts a block, J, m sunk
import math, sys, time
from yade import polyhedra_utils
data, steps, warm, O.dt = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
half, side = 2.5e-3, 0.05
stuff = PolyhedraMat(density=2500, young=2*1e4/(4*half*half), poisson=2/7., frictionAngle=math.atan(0.5))
O.materials.append(stuff)
for k in range(3):
    O.bodies.append(utils.wall(0, axis=k, sense=1, material=stuff))
for k in range(2):
    O.bodies.append(utils.wall(side, axis=k, sense=-1, material=stuff))
corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
blocks = []
for line in open(data):
    n = [float(x) for x in line.split()]
    b = polyhedra_utils.polyhedra(stuff, v=corners)
    b.state.pos = Vector3(n[0], n[1], n[2])
    b.state.ori = Quaternion(n[3], n[4], n[5], n[6])
    blocks.append(b)
O.bodies.append(blocks)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Polyhedra_Aabb(), Bo1_Wall_Aabb()], verletDist=2e-4),
    InteractionLoop([Ig2_Wall_Polyhedra_PolyhedraGeom(), Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
                    [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
                    [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()]),
    NewtonIntegrator(damping=0.3, gravity=(0, 0, -9.81))]
high = sum(b.state.pos[2] for b in blocks)/len(blocks)
O.run(warm, True)
begun = time.process_time()
O.run(steps, True)
spent = time.process_time() - begun
touching = sum(1 for i in O.interactions if i.isReal and min(i.id1, i.id2) >= 5 and i.phys.normalForce.norm() > 0)
print("raw %.6f %.5f %.6g %.6g 0" % (spent, touching/len(blocks), utils.kineticEnergy(),
                                   high - sum(b.state.pos[2] for b in blocks)/len(blocks)))
