"""read_vtk.py DIR - opens what write_files wrote with VTK, the library under ParaView, and compares."""
import os
import sys

try:
    import vtk
except ImportError:
    print("SKIP: VTK not found, VTP and VTK files not opened (Debian package python3-vtk9)")
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


def read(name, reader):
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(name))
    reader.AddObserver("WarningEvent", lambda *_: errors.append(name))
    reader.SetFileName(os.path.join(folder, name))
    if name.endswith(".vtk"):
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllFieldsOn()
    reader.Update()
    check(not errors, name + ": VTK complained")
    return reader.GetOutput()


def near(a, b):
    return abs(a - b) <= 1e-12*max(1, abs(b))


grains, (time,), walls = lines("grain"), lines("time")[0], lines("walls")[0]
for name, reader, clock in (("grains.vtp", vtk.vtkXMLPolyDataReader(), "TimeValue"),
                            ("grains.vtk", vtk.vtkPolyDataReader(), "TIME")):
    data = read(name, reader)
    check(data.GetNumberOfPoints() == len(grains), name + ": number of points")
    check(data.GetNumberOfVerts() == len(grains), name + ": number of vertices")
    field = data.GetFieldData().GetArray(clock)
    check(field is not None and near(field.GetValue(0), time), name + ": time")
    arrays = {n: data.GetPointData().GetArray(n) for n in ("id", "material", "radius", "velocity", "spin")}
    for n, array in arrays.items():
        check(array is not None, "%s: array %s is missing" % (name, n))
    if None in arrays.values() or data.GetNumberOfPoints() != len(grains):
        continue
    for i, grain in enumerate(grains):
        found = [arrays[n].GetTuple1(i) for n in ("id", "material", "radius")]
        found += data.GetPoint(i) + arrays["velocity"].GetTuple3(i) + arrays["spin"].GetTuple3(i)
        check(all(map(near, found, grain)), "%s: grain %d: %s instead of %s" % (name, i, found, grain))

def has_areas(data):
    """Is no polygon flat to a line? Of any number of corners."""
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(data)
    sizes.Update()
    areas = sizes.GetOutput().GetCellData().GetArray("Area")
    return all(areas.GetValue(i) > 0 for i in range(data.GetNumberOfCells()))

data = read("walls.vtp", vtk.vtkXMLPolyDataReader())
check([data.GetNumberOfPoints(), data.GetNumberOfPolys()] == walls, "walls.vtp: corners and triangles")
check(has_areas(data), "walls.vtp: areas")

data = read("surfaces.vtp", vtk.vtkXMLPolyDataReader())
check(data.GetNumberOfPoints() == 114*len(grains) and data.GetNumberOfPolys() == 128*len(grains),
      "surfaces.vtp: points and polygons")
check(has_areas(data), "surfaces.vtp: areas")

print("VTK %s: %s" % (vtk.vtkVersion().GetVTKVersion(),
                      "%d failures" % failures if failures else "all files read as written"))
sys.exit(failures > 0)
