"""Frames of a simulation in the formats of meshio, as the archive that ``touchstone step`` reads.

    python3 -m touchstone.frames sim_*.vtu --out run.npz
    touchstone step run.npz

VTK, VTU, XDMF, Gmsh and others are read by meshio (Debian's python3-meshio). Triangles are faces, quads and polygons fans of
triangles; of tetrahedra, hexahedra, wedges and pyramids the surface is taken: the faces of one cell only. Tetrahedra are also
elements whose volume is to stay positive. Lines are edges of their own, vertices points. Cells with nodes on their edges are curved, and refused.
"""

from __future__ import annotations

import argparse
import importlib
import os
import pathlib
import re
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
# NumPy's functions on its file format have no types.
numpy_format: Any = np.lib.format
Path = Union[str, "os.PathLike[str]"]

# The faces of a volume's cell, in the order of VTK's corners; each is seen counterclockwise from outside.
SIDES: Dict[str, Tuple[Tuple[int, ...], ...]] = {
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}


class FrameError(ValueError):
    """A file that is not what is needed; the text names it, the reason and the way out."""


@dataclass(frozen=True)
class Elements:
    """The elements of all frames.

    Attributes
    ----------
    faces : ndarray of shape (m, 3)
    edges : ndarray of shape (k, 2)
        Those of no face.
    points : ndarray of shape (p,)
    tetrahedra : ndarray of shape (q, 4)
    notes : list of str
        What was read in another form.
    """

    faces: Indices
    edges: Indices
    points: Indices
    tetrahedra: Indices
    notes: List[str]

    @property
    def arrays(self) -> Dict[str, Indices]:
        """The arrays that an archive has, by their names."""
        return {"F": self.faces, "E": self.edges, "P": self.points, "T": self.tetrahedra}


@dataclass(frozen=True)
class Frame:
    """The places of the vertices, of shape (n, 3), and the mesh that has the elements."""

    name: str
    vertices: Doubles
    mesh: Any


def meshio() -> Any:
    """Return the module meshio."""
    try:
        return importlib.import_module("meshio")
    except ModuleNotFoundError:
        raise FrameError("meshio is missing: apt-get install python3-meshio, or pip install meshio") from None


def rows_once(rows: Indices) -> Tuple[Indices, npt.NDArray[np.bool_]]:
    """Return the first place of each set of vertices, and whether it is the only one."""
    _, first, count = np.unique(np.sort(rows, axis=1), axis=0, return_index=True, return_counts=True)
    order = np.argsort(first)
    return first[order].astype(np.int64), count[order] == 1


def fans(polygons: Indices) -> Indices:
    """Return the triangles of polygons of shape (m, k), around the first vertex of each."""
    fan = [polygons[:, [0, i, i + 1]] for i in range(1, polygons.shape[1] - 1)]
    triangles: Indices = np.stack(fan, axis=1).reshape(-1, 3)
    return triangles


def surface(cells: Sequence[Tuple[str, Indices]]) -> List[Indices]:
    """Return the polygons of shape (m, 3) and (m, 4) that bound the volumes of the cells."""
    sides: Dict[int, List[Indices]] = {3: [], 4: []}
    for kind, corners in cells:
        for side in SIDES.get(kind, ()):
            sides[len(side)].append(corners[:, list(side)])
    bounding = []
    for size, some in sides.items():
        polygons = np.concatenate(some) if some else np.empty((0, size), np.int64)
        first, alone = rows_once(polygons)
        bounding.append(polygons[first[alone]])
    return bounding


def elements_of(mesh: Any, name: str) -> Elements:
    """Return the elements of a mesh as meshio reads it.

    Raises
    ------
    FrameError
        For cells that are not straight, or nothing that could collide.
    """
    cells = [(str(block.type), np.asarray(block.data)) for block in mesh.cells]
    of_faces: List[Indices] = []
    of: Dict[str, List[Indices]] = {"line": [], "vertex": [], "tetra": []}
    polygons = 0
    for kind, corners in cells:
        if kind in of:
            of[kind].append(corners.astype(np.int64))
        elif kind == "triangle" or kind == "quad" or kind.startswith("polygon"):
            polygons += 0 if kind == "triangle" else len(corners)
            of_faces.append(fans(corners.astype(np.int64)))
        elif kind not in SIDES:
            read = ", ".join(("triangle", "quad", "polygon", "line", "vertex", *SIDES))
            raise FrameError(f"{name}: cells of the type {kind} are not read, only {read}")
    bounding = surface(cells)
    notes = []
    if polygons:
        notes.append(f"polygons read as fans of triangles: {polygons}")
    if sum(map(len, bounding)):
        notes.append(f"the surface of volumes: {len(bounding[0])} triangles, {len(bounding[1])} quads")
    faces = np.concatenate([*map(fans, bounding), *of_faces])
    first, _ = rows_once(faces)
    if len(first) < len(faces):
        notes.append(f"faces that stand there twice, read once: {len(faces) - len(first)}")
    result = Elements(
        faces[first],
        np.concatenate(of["line"] or [np.empty((0, 2), np.int64)]),
        np.concatenate(of["vertex"] or [np.empty((0, 1), np.int64)]).reshape(-1),
        np.concatenate(of["tetra"] or [np.empty((0, 4), np.int64)]),
        notes,
    )
    if not len(result.faces) + len(result.edges) + len(result.points):
        raise FrameError(f"{name}: nothing in it can collide: no face, edge or point, only vertices: {len(mesh.points)}")
    return result


def in_space(array: Any, name: str, what: str) -> Doubles:
    """Return an array of shape (n, 2) or (n, 3) as one of shape (n, 3)."""
    rows = np.asarray(array, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] not in (2, 3):
        raise FrameError(f"{name}: {what} must have 2 or 3 columns, not the shape {rows.shape}")
    if not np.isfinite(rows).all():
        raise FrameError(f"{name}: {what} must be finite")
    return np.pad(rows, ((0, 0), (0, 3 - rows.shape[1])))


def placed(mesh: Any, name: str, displacement: str | None) -> Frame:
    """Return the frame of a mesh, moved by a field of its vertices if there is one."""
    vertices = in_space(mesh.points, name, "points")
    if displacement is not None:
        if displacement not in mesh.point_data:
            raise FrameError(f"{name}: no field {displacement} of points; there are: {', '.join(mesh.point_data) or 'none'}")
        moved = in_space(mesh.point_data[displacement], name, displacement)
        vertices = vertices + moved
    return Frame(name, vertices, mesh)


def frames_of(path: pathlib.Path, displacement: str | None) -> Iterator[Frame]:
    """Yield the frames of a file: of XDMF all steps of its time series."""
    module = meshio()
    if not path.exists():
        raise FrameError(f"{path}: does not exist")
    try:
        if path.suffix in (".xdmf", ".xmf"):
            yield from steps_of(module, path, displacement)
            return
        mesh = module.read(path)
    except (Exception, SystemExit) as error:  # meshio ends the process for a format that it does not know
        if isinstance(error, FrameError):
            raise
        reason = "meshio cannot read it" if isinstance(error, SystemExit) else error
        raise FrameError(f"{path}: {reason}") from error
    yield placed(mesh, str(path), displacement)


def steps_of(module: Any, path: pathlib.Path, displacement: str | None) -> Iterator[Frame]:
    """Yield the steps of an XDMF file, or its one mesh."""
    try:
        reader = module.xdmf.TimeSeriesReader(path)
    except module.ReadError:
        yield placed(module.read(path), str(path), displacement)
        return
    with reader:
        points, cells = reader.read_points_cells()
        for step in range(reader.num_steps):
            time, point_data, cell_data = reader.read_data(step)
            mesh = module.Mesh(points, cells, point_data=point_data, cell_data=cell_data)
            yield placed(mesh, f"{path}, time {time:g}", displacement)


def groups_of(mesh: Any, name: str, field: str) -> List[str]:
    """Return the group of each vertex: the value that the cells around it have in a field.

    Raises
    ------
    FrameError
        If there is no such field, or a vertex belongs to cells of two groups.
    """
    if field not in mesh.cell_data:
        raise FrameError(f"{name}: no field {field} of cells; there are: {', '.join(mesh.cell_data) or 'none'}")
    corners, values = [], []
    for block, of_cells in zip(mesh.cells, mesh.cell_data[field]):
        cells = np.asarray(block.data)
        corners.append(cells.reshape(-1))
        values.append(np.repeat(np.asarray(of_cells).reshape(-1).astype(str), cells.shape[1]))
    of_corner, vertices = np.concatenate(values), np.concatenate(corners)
    groups = np.full(len(mesh.points), "none", dtype=object)
    groups[vertices] = of_corner
    others = np.flatnonzero(groups[vertices] != of_corner)
    if len(others):
        vertex, other = vertices[others[0]], of_corner[others[0]]
        raise FrameError(
            f"{name}: vertex {vertex} is in cells of two groups, {other} and {groups[vertex]}: give each group vertices of its own"
        )
    return [str(group) for group in groups]


def convert(paths: Sequence[Path], out: Path, *, displacement: str | None = None, groups: str | None = None) -> Elements:
    """Write the frames of some files into one archive for ``touchstone step``. One frame is in memory at a time.

    Parameters
    ----------
    paths : sequence of path-like
        The files in the order of time, a frame each; an XDMF file has all its steps.
    out : path-like
        The archive (.npz): `V` of the shape (T, n, 3), `F` (m, 3), `E` (k, 2), `P` (p,), `T` (q, 4). It appears when it is whole.
    displacement : str, optional
        A field of the vertices that is added to their places, as `solution` in polyfem's output.
    groups : str, optional
        A field of the cells. The group of each vertex is written, a line each, to `out` with the ending ``.groups``, for
        ``touchstone step --groups``.

    Returns
    -------
    Elements
        Those of all frames.

    Raises
    ------
    FrameError
        If a file cannot be read, or its elements are not those of the first.
    """
    out = pathlib.Path(out)
    first: Frame | None = None
    elements: Elements | None = None
    count = 0
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".frames-") as folder:
        places = pathlib.Path(folder) / "places"
        with open(places, "wb") as file:
            for path in paths:
                for frame in frames_of(pathlib.Path(path), displacement):
                    if first is None or elements is None:
                        first, elements = frame, elements_of(frame.mesh, frame.name)
                    elif not has_elements(frame, first, elements) or frame.vertices.shape != first.vertices.shape:
                        raise FrameError(f"{frame.name}: its elements are not those of {first.name}: all frames must have the same")
                    file.write(np.ascontiguousarray(frame.vertices, dtype="<f8").tobytes())
                    count += 1
        if first is None or elements is None:
            raise FrameError("no frame: name at least one file")
        whole = pathlib.Path(folder) / "whole.npz"
        with zipfile.ZipFile(whole, "w", allowZip64=True) as archive:
            with archive.open("V.npy", "w", force_zip64=True) as entry, open(places, "rb") as file:
                shape = (count, *first.vertices.shape)
                numpy_format.write_array_header_2_0(entry, {"descr": "<f8", "fortran_order": False, "shape": shape})
                while block := file.read(1 << 20):
                    entry.write(block)
            for name, array in elements.arrays.items():
                if len(array):
                    with archive.open(f"{name}.npy", "w") as entry:
                        numpy_format.write_array(entry, array)
        if groups is not None:
            lines = "".join(f"{group}\n" for group in groups_of(first.mesh, first.name, groups))
            (pathlib.Path(folder) / "groups").write_text(lines)
            os.replace(pathlib.Path(folder) / "groups", out.with_suffix(".groups"))
        os.replace(whole, out)
    return elements


def has_elements(frame: Frame, first: Frame, elements: Elements) -> bool:
    """Return whether a frame has the elements of the first one. Those of the same cells are not made again."""
    cells, first_cells = frame.mesh.cells, first.mesh.cells
    if len(cells) == len(first_cells) and all(
        a.type == b.type and np.array_equal(a.data, b.data) for a, b in zip(cells, first_cells)
    ):
        return True
    own = elements_of(frame.mesh, frame.name)
    return all(np.array_equal(array, elements.arrays[name]) for name, array in own.arrays.items())


def by_number(name: str) -> List[Tuple[str, int]]:
    """Return the key of a name in the order of its numbers: sim_2 comes before sim_10."""
    return [(text, int(number or 0)) for text, number in re.findall(r"(\D*)(\d*)", name)]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; 2 for bad input."""
    parser = argparse.ArgumentParser(
        prog="python3 -m touchstone.frames",
        description="Write frames that meshio reads (VTK, VTU, XDMF, Gmsh) into one archive for `touchstone step`.",
        epilog="Example: python3 -m touchstone.frames sim_*.vtu --out run.npz && touchstone step run.npz",
    )
    parser.add_argument(
        "files", nargs="+", metavar="FILE", help="a frame each, taken in the order of the numbers in their names; XDMF: all steps of each"
    )
    parser.add_argument("--out", required=True, metavar="FILE", help="the archive (.npz)")
    parser.add_argument("--displacement", metavar="FIELD", help="field of the vertices, added to their places")
    parser.add_argument("--groups", metavar="FIELD", help="field of the cells: the groups of the vertices, beside OUT (.groups)")
    options = parser.parse_args(arguments)
    try:
        if pathlib.Path(options.out).suffix != ".npz":
            raise FrameError(f"{options.out}: the archive's name must end in .npz")
        files = sorted(options.files, key=by_number)
        elements = convert(files, options.out, displacement=options.displacement, groups=options.groups)
    except (FrameError, OSError) as error:
        print(f"touchstone.frames: error: {error}", file=sys.stderr)
        return 2
    for note in elements.notes:
        print(f"touchstone.frames: {note}", file=sys.stderr)
    names = ("faces", "edges of their own", "points", "tetrahedra")
    counts = zip(map(len, elements.arrays.values()), names)
    print(f"written: {options.out}: " + ", ".join(f"{count} {what}" for count, what in counts if count))
    if options.groups:
        print(f"written: {pathlib.Path(options.out).with_suffix('.groups')}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
