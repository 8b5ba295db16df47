# CLUMPS in YADE: linear springs and dashpots, of every two spheres that touch.
# yade -n -x yade_clumps.py FILE STEPS WARM DT; prints seconds of the processor, contacts a block, J, m sunk
import math, sys, time
data, steps, warm, O.dt = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
r, side = 1.25e-3, 0.05
# two in series have half of kn and cn: 10 kN/m; restitution 0.3 of two clumps that meet in line
stuff = ViscElMat(density=2500, kn=2e4, ks=2e4*2/7., cn=2*0.6475, cs=0.6475, frictionAngle=math.atan(0.5))
O.materials.append(stuff)
for k in range(3):
    O.bodies.append(utils.wall(0, axis=k, sense=1, material=stuff))
for k in range(2):
    O.bodies.append(utils.wall(side, axis=k, sense=-1, material=stuff))
blocks = []
for line in open(data):
    n = [float(x) for x in line.split()]
    at, turn = Vector3(n[0], n[1], n[2]), Quaternion(n[3], n[4], n[5], n[6])
    spheres = [utils.sphere(at + turn*Vector3(x, y, z), r, material=stuff)
               for z in (-r, r) for y in (-r, r) for x in (-r, r)]
    blocks.append(O.bodies[O.bodies.appendClumped(spheres, discretization=0)[0]])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=5e-5),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                    [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
                    [Law2_ScGeom_ViscElPhys_Basic()]),
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81))]
high = sum(b.state.pos[2] for b in blocks)/len(blocks)
O.run(warm, True)
begun = time.process_time()
O.run(steps, True)
spent = time.process_time() - begun
touching = sum(1 for i in O.interactions if i.isReal and min(i.id1, i.id2) >= 5)
print("raw %.6f %.5f %.6g %.6g 0" % (spent, touching/len(blocks), utils.kineticEnergy(),
                                   high - sum(b.state.pos[2] for b in blocks)/len(blocks)))
