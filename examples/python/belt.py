"""python3 belt.py: the drag and the power of a conveyor belt over its speed, one run per core.

A finite belt is fed at one end and discharges at the other. A grain that comes to rest on the belt has gained the
momentum m V, so in steady flow the drag is the mass flow times the speed V, and the power is drag times V.
examples/belt.c is the same belt in C."""
import concurrent.futures
import math
import dem

FLOW = 300*2500*4/3*math.pi*0.004**3                            # kg/s: 300 grains/s


def belt(speed):
    with dem.World(gravity=(0, 0, -9.81), domain=(-1, -1, -0.05, 1, 1, 1), boundary=["open", "open", "outflow"], threads=1) as world:
        stone = world.material(density=2500, young=1e6, restitution=0.3, friction=0.6, rolling_friction=0.3)
        sheet = world.wall_mesh(stone, dem.Mesh(vertices=[(0, -1, 0), (0.3, -1, 0), (0.3, 1, 0), (0, 1, 0)],
                                                triangles=[(0, 1, 2), (0, 2, 3)]))
        sheet.surface_velocity_set((speed, 0, 0))
        world.feed(material=stone, amount=[1], radius=[0.004], rate=300, box=(0.02, -0.03, 0.006, 0.05, 0.03, 0.012))
        world.run(1)                                            # s: as many leave as arrive
        sheet.loads_reset()
        world.run(1)
        loads = sheet.loads
        return -loads.impulse[0]/loads.time, loads.work/loads.time


if __name__ == "__main__":
    with concurrent.futures.ThreadPoolExecutor() as pool:
        for speed, (drag, power) in zip((0.4, 0.5, 0.6), pool.map(belt, (0.4, 0.5, 0.6))):
            print("%.1f m/s: drag %.4f N, mass flow times speed %.4f N, power %.4f W" % (speed, drag, FLOW*speed, power))
