"""Frames of other formats: what they hold, and the reasons for errors."""

from __future__ import annotations

import itertools
import json
import subprocess
import sys

import numpy as np
import pytest

from touchstone import frames
from touchstone._tool import tool

meshio = pytest.importorskip("meshio", reason="python3-meshio is missing")

CORNERS = {
    "tetra": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "pyramid": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]],
    # VTK's wedge has its first triangle seen counterclockwise from outside.
    "wedge": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 1, 1], [1, 0, 1]],
    "hexahedron": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
}
VOLUMES = {"tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1}


def volume(vertices, faces) -> float:
    """The volume that a surface bounds, positive if its triangles are seen counterclockwise from outside."""
    return float(np.linalg.det(np.asarray(vertices, float)[faces]).sum() / 6)


@pytest.mark.parametrize("kind", sorted(CORNERS))
def test_the_surface_of_a_cell_bounds_its_volume(kind):
    mesh = meshio.Mesh(np.array(CORNERS[kind], float), [(kind, np.arange(len(CORNERS[kind]))[None])])
    faces = frames.elements_of(mesh, "mesh").faces
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
        faces = frames.elements_of(meshio.Mesh(points, [(kind, np.array(cells))]), "mesh").faces
        assert len(faces) == 6 * side * side * 2
        assert volume(points, faces) == pytest.approx(side**3, abs=1e-9)


def test_what_is_written_is_what_the_frames_hold(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where meshio writes the data of XDMF
    random = np.random.default_rng(7)
    places = random.normal(size=(12, 9, 3))
    cells = [("triangle", [[0, 1, 2]]), ("quad", [[3, 4, 5, 6]]), ("line", [[0, 7]]), ("vertex", [[8]])]
    for i, frame in enumerate(places):
        meshio.Mesh(frame, cells).write(tmp_path / f"sim_{i}.vtu")
    # By their numbers, so 2 comes before 10.
    names = sorted(str(path) for path in tmp_path.glob("sim_*.vtu"))
    assert names[2].endswith("sim_10.vtu")
    assert frames.main([*names, "--out", str(tmp_path / "run.npz")]) == 0
    run = np.load(tmp_path / "run.npz")
    np.testing.assert_array_equal(run["V"], places)
    np.testing.assert_array_equal(run["F"], [[0, 1, 2], [3, 4, 5], [3, 5, 6]])
    np.testing.assert_array_equal(run["E"], [[0, 7]])
    np.testing.assert_array_equal(run["P"], [8])

    # The same as a time series of places at rest and displacements that are exact.
    rest = np.round(places[0], 2)
    moved = random.integers(-8, 8, size=places.shape) / 4
    with meshio.xdmf.TimeSeriesWriter(tmp_path / "run.xdmf") as writer:
        writer.write_points_cells(rest, [(kind, np.array(some)) for kind, some in cells[:2]])
        for i, field in enumerate(moved):
            writer.write_data(float(i), point_data={"solution": field})
    frames.convert([tmp_path / "run.xdmf"], tmp_path / "series.npz", displacement="solution")
    np.testing.assert_array_equal(np.load(tmp_path / "series.npz")["V"], rest + moved)


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


def test_bad_input_is_named(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)

    def write(name, points, cells, **data):
        meshio.Mesh(points, cells, **data).write(name)

    write("flat.vtk", np.pad(square, ((0, 0), (0, 1))), [("triangle", [[0, 1, 2], [0, 2, 3]])], cell_data={"body": [[1, 2]]})
    write("other.vtk", np.pad(square, ((0, 0), (0, 1))), [("triangle", [[0, 1, 2], [1, 2, 3]])])
    write("curved.vtu", np.zeros((6, 3)), [("triangle6", [[0, 1, 2, 3, 4, 5]])])
    write("nan.vtk", np.full((3, 3), np.nan), [("triangle", [[0, 1, 2]])])
    (tmp_path / "broken.vtu").write_text("not XML")
    (tmp_path / "nothing.obj").write_text("v 0 0 0\nv 1 0 0\n")
    for arguments, text in (
        (["none.vtu"], "none.vtu: does not exist"),
        (["broken.vtu"], "broken.vtu: "),
        (["curved.vtu"], "cells of the type triangle6 are not read"),
        (["nothing.obj"], "nothing in it can collide: no face, edge or point, only vertices: 2"),
        (["nan.vtk"], "nan.vtk: points must be finite"),
        (["flat.vtk", "other.vtk"], "other.vtk: its elements are not those of flat.vtk"),
        (["flat.vtk", "--displacement", "u"], "no field u of points; there are: none"),
        (["flat.vtk", "--groups", "part"], "no field part of cells; there are: body"),
        (["flat.vtk", "--groups", "body"], "vertex 0 is in cells of two groups, 1 and 2"),
    ):
        assert frames.main([*arguments, "--out", "run.npz"]) == 2, arguments
        assert text in capsys.readouterr().err
    assert frames.main(["flat.vtk", "--out", "run.txt"]) == 2
    assert "must end in .npz" in capsys.readouterr().err
    assert not list(tmp_path.glob("run*")) and not list(tmp_path.glob(".frames*"))
