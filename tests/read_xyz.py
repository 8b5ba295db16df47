"""read_xyz.py DIR - opens the extended XYZ file that write_files wrote with ASE and compares."""
import os
import sys

try:
    import ase
    import ase.io
except ImportError:
    print("SKIP: ASE not found, XYZ file not opened (Debian package python3-ase)")
    sys.exit(0)

folder = sys.argv[1]
failures = 0


def check(right, what):
    global failures
    if not right:
        failures += 1
        print("FAILED", what)


def lines(kind):
    with open(os.path.join(folder, "expected.txt")) as file:
        return [[float(x) for x in line.split()[1:]] for line in file if line.split()[0] == kind]


def near(a, b):
    return abs(a - b) <= 1e-8*max(1, abs(b))     # nine digits are written


grains, (time,) = lines("grain"), lines("time")[0]
atoms = ase.io.read(os.path.join(folder, "grains.xyz"), format="extxyz")
check(len(atoms) == len(grains), "number of grains")
check(near(atoms.info["Time"], time), "time")
check(list(atoms.get_pbc()) == [False, False, True], "periodic along z only")
check(all(map(near, atoms.cell.lengths(), (1, 2, 1))), "size of the cell")
if len(atoms) == len(grains):
    for i, grain in enumerate(grains):
        found = [atoms.arrays["id"][i], atoms.get_atomic_numbers()[i], atoms.arrays["radius"][i]]
        found += list(atoms.positions[i]) + list(atoms.arrays["velo"][i])
        check(all(map(near, found, grain)), "grain %d: %s instead of %s" % (i, found, grain))

print("ASE %s: %s" % (ase.__version__, "%d failures" % failures if failures else "file read as written"))
sys.exit(failures > 0)
