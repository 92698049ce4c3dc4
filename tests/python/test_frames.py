"""Frames of other formats: what they hold, and the reasons for errors."""

from __future__ import annotations

import itertools
import json
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

from touchstone import frames
from touchstone._tool import tool

meshio = pytest.importorskip("meshio", reason="python3-meshio is missing")
for module, package in ("vtkmodules", "vtk9"), ("h5py", "h5py"):
    pytest.importorskip(module, reason=f"python3-{package} is missing")

CORNERS = {
    "tetra": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "pyramid": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]],
    # VTK's wedge has its first triangle seen counterclockwise from outside.
    "wedge": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 1, 1], [1, 0, 1]],
    "hexahedron": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
}
VOLUMES = {"tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1}


def mesh_of(points, kind, cells):
    """A mesh of cells of one kind."""
    cells = np.array(cells, np.int64)
    number = frames.KINDS[kind][0]
    return frames.Mesh("mesh", np.array(points, float), np.full(len(cells), number), np.full(*cells.shape), cells.reshape(-1))


def volume(vertices, faces) -> float:
    """The volume that a surface bounds, positive if its triangles are seen counterclockwise from outside."""
    return float(np.linalg.det(np.asarray(vertices, float)[faces]).sum() / 6)


@pytest.mark.parametrize("kind", sorted(CORNERS))
def test_the_surface_of_a_cell_bounds_its_volume(kind):
    mesh = mesh_of(CORNERS[kind], kind, [range(len(CORNERS[kind]))])
    faces = frames.elements_of(mesh).faces
    assert volume(mesh.points + 3, faces) == pytest.approx(VOLUMES[kind], abs=1e-12)
    # Each edge is that of two faces, in opposite directions.
    edges = [(a, b) for face in faces.tolist() for a, b in itertools.pairwise([*face, face[0]])]
    assert sorted(edges) == sorted((b, a) for a, b in edges)
    assert len(set(edges)) == len(edges)


def test_faces_between_two_cells_are_not_of_the_surface():
    """A grid of cubes, each a hexahedron or six tetrahedra."""
    side = 3
    at = lambda x, y, z: x + (side + 1) * (y + (side + 1) * z)  # noqa: E731
    points = np.array([[x, y, z] for z in range(side + 1) for y in range(side + 1) for x in range(side + 1)], float)
    cubes = [
        [at(x + i, y + j, z + k) for i, j, k in CORNERS["hexahedron"]]
        for x, y, z in itertools.product(range(side), repeat=3)
    ]
    # The path of each order of axes from one corner to the opposite one is a tetrahedron.
    around = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
    tetrahedra = [[cube[i] for i in path] for cube in cubes for path in around]
    for kind, cells in ("hexahedron", cubes), ("tetra", tetrahedra):
        faces = frames.elements_of(mesh_of(points, kind, cells)).faces
        assert len(faces) == 6 * side * side * 2
        assert volume(points, faces) == pytest.approx(side**3, abs=1e-9)


# ---- Files: a body falls from z = 1 to -1 over a floor at 0, so both touch at 1/2. ----

FLOOR = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]
QUAD, POINTS = (9, [0, 1, 2, 3]), [*range(4, 8)]


def body(z, corners=3):
    return [[1, 1, z], [2, 1, z + 1], [1, 2, z + 1], [2, 2, z + 1]][:corners]


def words(*rows):
    return " ".join(str(number) for row in rows for number in row)


def array(kind, name, values, size=1):
    return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{size}" format="ascii">{values}</DataArray>'


def xml(kind, content):
    return f'<VTKFile type="{kind}" version="1.0"><{kind}>{content}</{kind}></VTKFile>'


def lists(cells, types=True):
    texts = words(*(corners for _, corners in cells)), words(np.cumsum([len(corners) for _, corners in cells]))
    arrays = array("Int64", "connectivity", texts[0]) + array("Int64", "offsets", texts[1])
    return arrays + (array("UInt8", "types", words([kind for kind, _ in cells])) if types else "")


def piece(points, cells, fields="", count=None):
    points_text = f"<Points>{array('Float64', 'Points', words(*points), 3)}</Points>"
    return (
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{count or len(cells)}">{points_text}<Cells>{lists(cells)}</Cells>{fields}</Piece>'
    )


def vtu(points, cells, *others, **more):
    return xml("UnstructuredGrid", "".join([piece(points, cells, **more), *(piece(*other) for other in others)]))


def vtp(points, lines, polys):
    counts = f'NumberOfPoints="{len(points)}" NumberOfLines="{len(lines)}" NumberOfPolys="{len(polys)}"'
    places = f"<Points>{array('Float64', 'Points', words(*points), 3)}</Points>"
    return xml("PolyData", f"<Piece {counts}>{places}<Lines>{lists(lines, False)}</Lines><Polys>{lists(polys, False)}</Polys></Piece>")


def vtk(dataset, version="3.0"):
    return f"# vtk DataFile Version {version}\nframe\nASCII\nDATASET {dataset}\n"


def grid(z, corners="0 1 2 3 4 5", time="", count=2, more=""):
    places = words(FLOOR[0], FLOOR[1], FLOOR[3], *body(z))
    return (
        f'<Grid>{time}<Topology TopologyType="Triangle" NumberOfElements="{count}"><DataItem DataType="Int" Dimensions="2 3" Format="XML">'
        f'{corners}</DataItem></Topology><Geometry GeometryType="XYZ"><DataItem Dimensions="6 3" Precision="8" Format="XML">{places}'
        f"</DataItem></Geometry>{more}</Grid>"
    )


def xdmf(*grids, times="", version="3.0"):
    series = f'<Grid GridType="Collection" CollectionType="Temporal">{times}{"".join(grids)}</Grid>'
    return f'<Xdmf Version="{version}"><Domain>{series}</Domain></Xdmf>'


def at(time):
    return f'<Time Value="{time}"/>'


def field(name, center, values, size):
    item = f'<DataItem Dimensions="{size}" Format="XML">{values}</DataItem>'
    return f'<Attribute Name="{name}" AttributeType="Vector" Center="{center}">{item}</Attribute>'


LIST = '<Time TimeType="List"><DataItem Dimensions="2" Format="XML">0 1</DataItem></Time>'
PVD = "".join(f'<DataSet timestep="{i}" part="{part}" file="{name}"/>' for i in (0, 1) for part, name in enumerate(("floor.vtu", f"b_{i}.vtu")))
BLOCKS = '<Block index="0"><DataSet index="0" file="floor.vtk"/><DataSet index="1"/></Block><DataSet index="1" file="b_{}.vtu"/>'
MSH = "$MeshFormat\n{} 0 8\n$EndMeshFormat\n$Nodes\n{}\n$EndNodes\n$Elements\n{}\n$EndElements\n"
INP = "*Heading\n*Node\n{}\n*Element, type=S4, elset=floor\n1, 1, 2, 3, 4\n** more\n*Element, type=S3\n2, 11, 12, 13\n"
ROWS = "\n".join(words(row) for row in FLOOR)


def nodes(z, comma):
    return "\n".join(comma.join(map(str, (tag, *place))) for tag, place in zip([1, 2, 3, 4, 11, 12, 13], [*FLOOR, *body(z)]))


def rows(z, corners=3):
    return "\n".join(words(row) for row in [*FLOOR, *body(z, corners)])


# The files of a frame by the place of the body and the frame's number; a name without a number has all frames.
FALLS = {
    "pieces": lambda z, i: {f"a_{i}.vtu": vtu(FLOOR, [QUAD], (body(z), [(5, [0, 1, 2])]))},
    "polyline": lambda z, i: {f"a_{i}.vtu": vtu([*FLOOR, *body(z)], [QUAD, (4, [5, 4, 6])])},
    "strip": lambda z, i: {f"a_{i}.vtu": vtu([*FLOOR, *body(z, 4)], [QUAD, (6, POINTS)])},
    "polyvertex": lambda z, i: {f"a_{i}.vtu": vtu([*FLOOR, *body(z, 4)], [QUAD, (2, POINTS)])},
    "pixel": lambda z, i: {f"a_{i}.vtu": vtu([*FLOOR, *body(z, 4)], [(8, [0, 1, 3, 2]), (8, POINTS)])},
    "legacy 3": lambda z, i: {
        f"a_{i}.vtk": vtk("POLYDATA") + f"POINTS 7 double\n{rows(z)}\nPOLYGONS 1 5\n4 0 1 2 3\nLINES 1 4\n3 5 4 6\n"
    },
    "legacy 5.1": lambda z, i: {
        f"a_{i}.vtk": vtk("UNSTRUCTURED_GRID", "5.1") + f"POINTS 7 double\n{rows(z)}\nCELLS 3 7\nOFFSETS vtktypeint64\n0 4 7\n"
        "CONNECTIVITY vtktypeint64\n0 1 2 3 5 4 6\nCELL_TYPES 2\n9 4\n"
    },
    "vtp": lambda z, i: {f"a_{i}.vtp": vtp([*FLOOR, *body(z)], [(4, [5, 4, 6])], [QUAD])},
    "pvtu": lambda z, i: {
        "floor.vtu": vtu(FLOOR, [QUAD]),
        f"b_{i}.vtu": vtu(body(z), [(5, [0, 1, 2])]),
        f"a_{i}.pvtu": xml("PUnstructuredGrid", f'<Piece Source="floor.vtu"/><Piece Source="b_{i}.vtu"/>'),
    },
    "vtm": lambda z, i: {
        "floor.vtk": vtk("STRUCTURED_GRID") + f"DIMENSIONS 2 2 1\nPOINTS 4 double\n{words(*FLOOR[:2], FLOOR[3], FLOOR[2])}\n",
        f"b_{i}.vtu": vtu(body(z), [(5, [0, 1, 2])]),
        f"a_{i}.vtm": xml("vtkMultiBlockDataSet", BLOCKS.format(i)),
    },
    "pvd": lambda z, i: {
        "floor.vtu": vtu(FLOOR, [QUAD]), f"b_{i}.vtu": vtu(body(z), [(5, [0, 1, 2])]), "a.pvd": xml("Collection", PVD)
    },  # fmt: skip
    "inp": lambda z, i: {f"a_{i}.inp": INP.format(nodes(z, ", "))},
    "msh 2": lambda z, i: {f"a_{i}.msh": MSH.format("2.2", f"7\n{nodes(z, ' ')}", "2\n1 3 2 0 1 1 2 3 4\n2 2 2 0 2 11 12 13")},
    "msh 4": lambda z, i: {
        f"a_{i}.msh": MSH.format(
            "4.1", f"1 7 1 13\n2 1 0 7\n1\n2\n3\n4\n11\n12\n13\n{rows(z)}", "2 2 1 2\n2 1 3 1\n1 1 2 3 4\n2 1 2 1\n2 11 12 13"
        )
    },
    "xdmf": lambda z, i: {"a.xdmf": xdmf(grid(1), grid(-1))},
    "xdmf 2": lambda z, i: {"a.xdmf": xdmf(grid(1, time=at(0)), grid(-1, time=at(1)), version="2.0")},
    "xdmf times": lambda z, i: {"a.xdmf": xdmf(grid(1, time=at(0)), grid(-1, time=at(1)), times=LIST)},
}


def write(files):
    for name, text in files.items():
        pathlib.Path(name).write_text(text)


def impact(*arguments):
    """The enclosure of the earliest impact in an archive; None if there is none."""
    run = subprocess.run([tool(), "step", *arguments, "--earliest", "--json", "step.json"], stdout=subprocess.DEVNULL)
    found = json.loads(pathlib.Path("step.json").read_text())["steps"][0]
    assert run.returncode == int(found["toi_lower"] is not None)
    return found["toi_lower"], found["toi_upper"]


@pytest.mark.parametrize("name", FALLS)
def test_a_file_is_read_whole(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for i, z in enumerate((1.0, -1.0)):
        files = FALLS[name](z, i)
        write(files)
    given = sorted(map(str, tmp_path.glob(f"a*{pathlib.Path(list(files)[-1]).suffix}")))
    assert frames.main([*given, "--out", "run.npz"]) == 0
    lower, upper = impact("run.npz")
    assert lower <= 0.5 <= upper < lower + 1e-9
    read = capsys.readouterr().out.splitlines()[0]
    moved = (np.diff(np.load("run.npz")["V"], axis=0) != 0).any(axis=(0, 2)).sum()
    assert read.startswith("read: frames: 2 (") and f"of which {moved} move" in read


@pytest.mark.parametrize(
    "order, names, result",
    [
        (None, "start end", "start end"),
        (None, "end start", "end start"),
        (None, "a_2 b_1", "a_2 b_1"),
        (None, "frame_10 frame_9", "doubtful: frame_10.vtu comes too early for its number"),
        (None, "frame_9 frame_10", "frame_9 frame_10"),
        (None, "frame_3 frame_2 frame_1", "frame_3 frame_2 frame_1"),
        (None, "frame_0.5 frame_10 frame_1e-1", "doubtful: frame_0.5.vtu comes too early"),
        (None, "frame_01 frame_1", "doubtful: frame_01.vtu and frame_1.vtu have the same numbers"),
        (None, "frame_1.1 frame_1.10", "doubtful: frame_1.1.vtu and frame_1.10.vtu have the same numbers"),
        ("given", "frame_10 frame_9", "frame_10 frame_9"),
        ("numbers", "frame_10 frame_9 frame_0.5 frame_1e-1 frame_0.25", "frame_1e-1 frame_0.25 frame_0.5 frame_9 frame_10"),
        ("numbers", "a_1 b_2", "doubtful: a_1.vtu and b_2.vtu differ in more than numbers"),
        ("folder", "frame_10 frame_9 frame_0.5 frame_1e-1", "frame_1e-1 frame_0.5 frame_9 frame_10"),
        ("folder", "frame_1 frame_01", "doubtful: "),
        ("folder", "start end", "doubtful: "),
    ],
)
def test_the_order_of_time_is_known_or_refused(order, names, result, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files = [pathlib.Path(f"{name}.vtu") for name in names.split()]
    if order == "folder":
        pathlib.Path("f").mkdir()
        write({f"f/{file}": "" for file in [*files, "run.log"]})
        order, files = None, [pathlib.Path("f")]
    if "doubtful" in result:
        with pytest.raises(frames.FrameError, match=result):
            frames.in_order(files, order)
    else:
        assert " ".join(file.name[:-4] for file in frames.in_order(files, order)[0]) == result


GOOD = {"a.vtu": vtu([*FLOOR, *body(1)], [QUAD, (5, [4, 5, 6])])}
TRIANGLE = [(5, [0, 1, 2])]
TIME = '<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray></FieldData>'
GHOST = f"<CellData>{array('UInt8', 'vtkGhostType', '1')}</CellData>"
REFUSED = {
    "missing": ({}, ["none.vtu"], "none.vtu: does not exist"),
    "no XML": ({"a.vtu": "not XML"}, ["a.vtu"], "a.vtu: it is no VTK file, or ends before </VTKFile>"),
    "cut off": ({"a.vtu": GOOD["a.vtu"][:-3]}, ["a.vtu"], "ends before </VTKFile>"),
    "short": ({"a.vtu": vtu(body(1), [(5, [0, 1])])}, ["a.vtu"], "a.vtu: 1 cells of the type triangle with 2 corners are not read"),
    "more": ({"a.vtu": vtu(body(1), TRIANGLE * 2, count=1)}, ["a.vtu"], "a.vtu: it states 1 cells, but lists 2"),
    "types": ({"a.vtk": vtk("UNSTRUCTURED_GRID") + f"POINTS 4 double\n{ROWS}\nCELLS 2 8\n3 0 1 2\n3 1 2 3\nCELL_TYPES 1\n5\n"}, ["a.vtk"],
              "a.vtk: it states 2 cells, but lists 1"),
    "half": ({"a.vtk": vtk("POLYDATA") + f"POINTS 4 double\n{ROWS}\nPOLYGONS 2 8\n3 0 1 2\n"}, ["a.vtk"], "states 8 numbers, but has 4"),
    "twice": ({"a.vtk": vtk("POLYDATA") + f"POINTS 4 double\n{ROWS}\nPOLYGONS 1 4\n3 0 1 2\nPOLYGONS 1 4\n3 1 2 3\n"}, ["a.vtk"],
              "a.vtk: it states 4 points and 2 cells, but read were 4 and 1"),
    "index": ({"a.vtu": vtu(body(1), [(3, [0, 1]), (5, [0, 1, 3])])}, ["a.vtu"], "a.vtu: cell 1: point 3, but there are 3, counted from 0"),
    "negative": ({"a.vtp": vtp(body(1), [(4, [0, -1])], [])}, ["a.vtp"], "a.vtp: cell 0: point -1, but there are 3, counted from 0"),
    "curved": ({"a.vtu": vtu(body(1) * 2, [(22, [0, 1, 2, 3, 4, 5])])}, ["a.vtu"], "1 cells of the type number 22 of VTK with 6 corners are not"),
    "ghost": ({"a.vtu": vtu(body(1), TRIANGLE, fields=GHOST)}, ["a.vtu"], "a.vtu: ghost points or cells are not read"),
    "nothing": ({"a.vtu": vtu(body(1), [])}, ["a.vtu"], "nothing in it can collide: no face, edge or point, only vertices: 3"),
    "nan": ({"a.vtu": vtu([[0, 0, "nan"], *body(1)], TRIANGLE)}, ["a.vtu"], "a.vtu: points must be finite"),
    "piece": ({"a.pvtu": xml("PUnstructuredGrid", '<Piece Source="b.vtu"/>')}, ["a.pvtu"], "b.vtu: does not exist"),
    "series": ({**GOOD, "a.pvd": xml("Collection", '<DataSet timestep="0" file="a.vtu"/><DataSet timestep="1" file="b.vtu"/>')}, ["a.pvd"],
               "b.vtu: does not exist"),
    "part": ({**GOOD, "b.vtu": vtu(body(1), TRIANGLE), "a.pvd": xml("Collection", "".join(
        f'<DataSet timestep="{i}" file="{name}"/>' for i, name in ((0, "a.vtu"), (0, "b.vtu"), (1, "a.vtu"))))}, ["a.pvd"],
        r"a.pvd, time 1: its cells are not those of a.pvd, time 0 \(7 points, 2 cells and 10 points, 3 cells\)"),
    "backwards": ({**GOOD, "a.pvd": xml("Collection", "".join(f'<DataSet timestep="{i}" file="a.vtu"/>' for i in (1, 0)))}, ["a.pvd"],
                  "the order of time is doubtful: a.pvd, time 0 has the time 0, but a.pvd, time 1 before it 1"),
    "times": ({f"{name}.vtu": GOOD["a.vtu"].replace("<Piece", TIME.format(time) + "<Piece", 1) for name, time in (("y", 2), ("x", 1))},
              ["y.vtu", "x.vtu"], "the order of time is doubtful: x.vtu has the time 1, but y.vtu before it 2"),
    "topology": ({"a.xdmf": xdmf(grid(1, time=at(0)), grid(-1, "0 1 2 3 5 4", at(1)))}, ["a.xdmf"], "a.xdmf, time 1: its cells are not those of"),
    "xdmf index": ({"a.xdmf": xdmf(grid(1, "0 1 2 3 4 6"))}, ["a.xdmf"], "grid 0: cell 1: point 6, but there are 6, counted from 0"),
    "xdmf count": ({"a.xdmf": xdmf(grid(1, count=3))}, ["a.xdmf"], "its Topology states 3 elements, but 2 were read of 6 numbers"),
    "xdmf list": ({"a.xdmf": xdmf(grid(1, time=at(0)), grid(-1, time=at(2)), times=LIST)}, ["a.xdmf"],
                  r"not understood: times \[0.0, 1.0\] in the list of the series, and \[2.0\] of grid 1"),
    "xdmf beside": ({"a.xdmf": xdmf(grid(1)).replace("<Domain>", f"<Domain>{grid(2)}")}, ["a.xdmf"], "not understood: grids beside the series"),
    "xdmf part": ({"a.xdmf": xdmf(grid(1, more="<Set/>"))}, ["a.xdmf"], "a.xdmf: not understood: Set in Grid: write .vtu"),
    "two nodes": ({"a.inp": INP.format(nodes(1, ", ")) + "*Node, nset=b\n14, 0, 0, 0\n"}, ["a.inp"],
                  r"a.inp: not understood: \*Node, nset=b: read are \*HEADING, one \*NODE"),
    "comment": ({"a.inp": INP.format(nodes(1, ", ") + "\n** more\n14, 0, 0, 0")}, ["a.inp"],
                "a.inp: its nodes and elements are 32 and 9 numbers, but read were 28 and 9"),
    "msh": ({"a.msh": MSH.format("2.2", f"8\n{nodes(1, ' ')}\n14 0 0 0", "2\n2 2 2 0 2 11 12 13") * 2}, ["a.msh"], r"it has 2 sections \$Nodes"),
    "obj": ({"a.obj": "v 0 0 0\nl 1 -1\n"}, ["a.obj"], "a.obj: `touchstone step` reads .obj itself: touchstone step A.obj B.obj"),
    "stl": ({"a.stl": ""}, ["a.stl"], "a.stl: unknown format: read are .vtk, .vtu, "),
    "displacement": (GOOD, ["a.vtu", "--displacement", "u"], "a.vtu: no field u of points; there are: none"),
    "groups": (GOOD, ["a.vtu", "--groups", "part"], "a.vtu: no field part of cells; there are: none"),
    "two groups": ({"a.vtu": vtu(FLOOR, [*TRIANGLE, (5, [0, 2, 3])], fields=f"<CellData>{array('Int8', 'body', '1 2')}</CellData>")},
                   ["a.vtu", "--groups", "body"], "a.vtu: vertex 0 is in cells of two groups, 1 and 2"),
    "archive": (GOOD, ["a.vtu", "--out", "run.txt"], "must end in .npz"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_understood_is_refused(name, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files, arguments, text = REFUSED[name]
    write(files)
    assert frames.main(["--out", "run.npz", *arguments]) == 2
    assert re.search(text, capsys.readouterr().err)
    assert not list(tmp_path.glob("run*")) and not list(tmp_path.glob(".frames*"))


def test_a_missing_reader_is_named(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "vtkmodules.vtkCommonCore", None)
    write(GOOD)
    assert frames.main(["a.vtu", "--out", "run.npz"]) == 2
    assert "vtk is missing: apt-get install python3-vtk9, or pip install vtk" in capsys.readouterr().err


def test_a_displacement_is_added_and_equal_frames_are_told(tmp_path, monkeypatch, capsys):
    """A time series with HDF5 and an included mesh, of places at rest and displacements that are exact."""
    monkeypatch.chdir(tmp_path)  # where meshio writes the data of XDMF
    random = np.random.default_rng(7)
    rest = np.round(random.normal(size=(9, 3)), 2)
    moved = random.integers(-8, 8, size=(12, 9, 3)) / 4
    with meshio.xdmf.TimeSeriesWriter("run.xdmf") as writer:
        writer.write_points_cells(rest, [("triangle", np.array([[0, 1, 2]])), ("quad", np.array([[3, 4, 5, 6]]))])
        for i, of_points in enumerate(moved):
            writer.write_data(float(i), point_data={"solution": of_points})
    frames.convert(["run.xdmf"], "run.npz", displacement="solution")
    run = np.load("run.npz")
    np.testing.assert_array_equal(run["V"], rest + moved)
    np.testing.assert_array_equal(run["F"], [[0, 1, 2], [3, 4, 5], [3, 5, 6]])
    assert frames.main(["run.xdmf", "--out", "run.npz"]) == 0
    told = capsys.readouterr()
    assert "of which 0 move; cells of each: 1 triangle, 1 quad" in told.out
    assert "frames that are equal: 11, first run.xdmf, time 0 and run.xdmf, time 1; there are fields of vectors: solution" in told.err


def test_the_tool_judges_what_is_written(tmp_path):
    """A triangle of body 2 falls from 1 to -1 through a tetrahedron of body 1, whose highest vertex is at 1/2."""
    body = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 0.5]]
    for i, z in enumerate((1.0, -1.0)):
        points = np.array([*body, [0, 0, z], [3, 0, z], [0, 3, z]], float)
        cells = [("tetra", [[0, 1, 2, 3]]), ("triangle", [[4, 5, 6]])]
        meshio.Mesh(points, cells, cell_data={"body": [[1], [2]]}).write(tmp_path / f"{i}.vtk")
    command = [sys.executable, "-m", "touchstone.frames", "0.vtk", "1.vtk", "--out", "run.npz", "--groups", "body"]
    subprocess.run(command, cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
    assert np.load(tmp_path / "run.npz")["T"].tolist() == [[0, 1, 2, 3]]
    step = [tool(), "step", "run.npz", "--groups", "run.groups", "--earliest", "--json", "step.json"]
    assert subprocess.run(step, cwd=tmp_path, stdout=subprocess.DEVNULL).returncode == 1
    found = json.loads((tmp_path / "step.json").read_text())["steps"][0]
    assert found["toi_lower"] <= 0.25 <= found["toi_upper"]
    assert subprocess.run([*step, "--apart", "1", "2"], cwd=tmp_path, stdout=subprocess.DEVNULL).returncode == 0
