"""Frames of a simulation in other formats, as the archive that ``touchstone step`` reads.

    python3 -m touchstone.frames FOLDER --out run.npz
    touchstone step run.npz

Triangles are faces, quads and polygons fans of triangles; of tetrahedra, hexahedra, wedges and pyramids the surface is taken: the
faces of one cell only. Tetrahedra are also cells whose volume is to stay positive. Lines are edges of their own, vertices points.
Cells with nodes on their edges are curved, and refused. All frames have the same cells.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import re
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Dict, List, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._mesh_files import FORMATS, KINDS, Doubles, FrameError, Indices, Mesh, field_of, in_space, meshes_of

# NumPy's functions on its file format have no types.
numpy_format: Any = np.lib.format
Path = Union[str, "os.PathLike[str]"]

# Kinds of the same shape whose corners VTK has in another order.
AROUND = {"pixel": "quad", "voxel": "hexahedron"}
# The faces of a volume's cell, in the order of VTK's corners; each is seen counterclockwise from outside.
SIDES: Dict[str, Tuple[Tuple[int, ...], ...]] = {
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}


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
        What was read, and what in another form.
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


# ---- Elements ----


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


def windows(cells: Indices, size: int) -> Indices:
    """Return the consecutive corners of cells as rows; every other triangle of a strip is turned."""
    rows = np.stack([cells[:, i : i + size] for i in range(cells.shape[1] - size + 1)], axis=1)
    if size == 3:
        rows[:, 1::2] = rows[:, 1::2, [1, 0, 2]]
    result: Indices = rows.reshape(-1, size)
    return result


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


def elements_of(mesh: Mesh) -> Elements:
    """Return the elements of a mesh.

    Raises
    ------
    FrameError
        For cells that are not straight, or nothing that could collide.
    """
    cells = mesh.cells()
    for i, (kind, corners) in enumerate(cells):
        if kind in AROUND:
            cells[i] = AROUND[kind], corners[:, [0, 1, 3, 2, 4, 5, 7, 6][: corners.shape[1]]]
    notes = []
    bounding = surface(cells)
    of: Dict[int, List[Indices]] = {size: [np.empty((0, size), np.int64)] for size in (1, 2, 3, 4)}
    of[3] += map(fans, bounding)
    polygons = 0
    for kind, corners in cells:
        if kind in ("triangle", "quad", "polygon"):
            polygons += len(corners) if corners.shape[1] > 3 else 0
            of[3].append(fans(corners))
        elif kind not in SIDES or kind == "tetra":
            size = {"line": 2, "polyline": 2, "strip": 3, "tetra": 4}.get(kind, 1)
            of[size].append(windows(corners, size))
    if polygons:
        notes.append(f"polygons read as fans of triangles: {polygons}")
    if sum(map(len, bounding)):
        notes.append(f"the surface of volumes: {len(bounding[0])} triangles, {len(bounding[1])} quads")
    points, edges, faces, tetrahedra = (np.concatenate(some) for some in of.values())
    first, _ = rows_once(faces)
    if len(first) < len(faces):
        notes.append(f"faces that stand there twice, read once: {len(faces) - len(first)}")
    if not len(faces) + len(edges) + len(points):
        raise FrameError(f"{mesh.name}: nothing in it can collide: no face, edge or point, only vertices: {len(mesh.points)}")
    return Elements(faces[first], edges, points.reshape(-1), tetrahedra, notes)


# ---- Fields ----


def placed(mesh: Mesh, displacement: str | None) -> Doubles:
    """Return the places of the vertices, moved by a field if there is one."""
    vertices = in_space(mesh.points, mesh.name, "points")
    if displacement is None:
        return vertices
    moved = field_of(mesh.of_points, displacement, len(vertices), mesh.name, "points")
    return in_space(vertices + in_space(moved, mesh.name, displacement), mesh.name, "places")


def groups_of(mesh: Mesh, name: str) -> List[str]:
    """Return the group of each vertex: the value that the cells around it have in a field.

    Raises
    ------
    FrameError
        If there is no such field, or a vertex belongs to cells of two groups.
    """
    values = field_of(mesh.of_cells, name, len(mesh.kinds), mesh.name, "cells")
    if values.size != len(values):
        raise FrameError(f"{mesh.name}: the field {name} must have one column, not the shape {values.shape}")
    of_corner, vertices = np.repeat(values.reshape(-1).astype(str), mesh.sizes), mesh.corners
    groups = np.full(len(mesh.points), "none", dtype=object)
    groups[vertices] = of_corner
    others = np.flatnonzero(groups[vertices] != of_corner)
    if len(others):
        vertex, other = vertices[others[0]], of_corner[others[0]]
        raise FrameError(
            f"{mesh.name}: vertex {vertex} is in cells of two groups, {other} and {groups[vertex]}: give each group vertices of its own"
        )
    return [str(group) for group in groups]


# ---- Frames ----


def in_order(paths: Sequence[Path], order: str | None) -> Tuple[List[pathlib.Path], str]:
    """Return the files in the order of time, and how that is known.

    Raises
    ------
    FrameError
        If the order is doubtful: the names of a folder differ in more than numbers, or have the same; a list is in the order of
        the alphabet, as a shell writes it for a pattern, and not in that of the numbers.
    """
    files, others = [pathlib.Path(path) for path in paths], []
    if len(files) == 1 and files[0].is_dir():
        entries, order = sorted(files[0].iterdir()), order or "numbers"
        files = [file for file in entries if file.suffix.lower() in FORMATS]
        others = [file.name for file in entries if file not in files]
    split = [re.split(r"(\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)", str(file)) for file in files]
    if order == "given" or (order is None and (files != sorted(files) or any(words[::2] != split[0][::2] for words in split))):
        return files, "as given"
    ranked = sorted(zip(([Decimal(word) for word in words[1::2]] for words in split), files, split), key=lambda item: item[0])
    for (number, file, words), (other_number, other, other_words) in zip(ranked, ranked[1:]):
        if words[::2] != other_words[::2] or number == other_number:
            how = "have the same numbers" if words[::2] == other_words[::2] else "differ in more than numbers"
            raise FrameError(f"the order of time is doubtful: {file} and {other} {how}: list all in order, with --order given")
    result = [file for _, file, _ in ranked]
    if order is None and files != result:
        first = next(file for file, other in zip(files, result) if file != other)
        text = f"{first} comes too early for its number"
        raise FrameError(f"the order of time is doubtful: {text}: --order numbers, or --order given")
    left_out = f", others left out: {len(others)}, among them {others[0]}" if others else ""
    return result, f"by the numbers in their names{left_out}"


def require_next(mesh: Mesh, first: Mesh, before: Mesh, order: str | None) -> None:
    """Raise a FrameError if the cells of a frame are not those of the first, or its time is not after the one before."""
    if len(mesh.points) != len(first.points) or not all(
        np.array_equal(getattr(mesh, what), getattr(first, what)) for what in ("kinds", "sizes", "corners")
    ):
        counts = " and ".join(f"{len(some.points)} points, {len(some.kinds)} cells" for some in (mesh, first))
        raise FrameError(f"{mesh.name}: its cells are not those of {first.name} ({counts}): all frames must have the same")
    if order is None and mesh.time is not None and before.time is not None and mesh.time <= before.time:
        times = f"{mesh.name} has the time {mesh.time:g}, but {before.name} before it {before.time:g}"
        raise FrameError(f"the order of time is doubtful: {times}: list the files in order, or --order given")


def convert(
    paths: Sequence[Path], out: Path, *, displacement: str | None = None, groups: str | None = None, order: str | None = None
) -> Elements:
    """Write the frames of some files into one archive for ``touchstone step``. Three frames are in memory at a time.

    Parameters
    ----------
    paths : sequence of path-like
        The files in the order of time, a frame each, or one folder of them; an XDMF or .pvd file has all its steps.
    out : path-like
        The archive (.npz): `V` of the shape (T, n, 3), `F` (m, 3), `E` (k, 2), `P` (p,), `T` (q, 4). It appears when it is whole.
    displacement : str, optional
        A field of the vertices that is added to their places, as `solution` in polyfem's output.
    groups : str, optional
        A field of the cells. The group of each vertex is written, a line each, to `out` with the ending ``.groups``, for
        ``touchstone step --groups``.
    order : {"given", "numbers"}, optional
        `given`: as the files are given, whatever their names and times say. `numbers`: by the numbers in their names, as in a
        folder. By default as given, unless that is doubtful.

    Returns
    -------
    Elements
        Those of all frames; the first note says what was read.

    Raises
    ------
    FrameError
        If a file cannot be read whole, its cells are not those of the first, or the order is doubtful.
    """
    out = pathlib.Path(out)
    files, how = in_order(paths, order)
    first: Mesh | None = None
    count, equal = 0, []
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".frames-") as folder:
        places = pathlib.Path(folder) / "places"
        with open(places, "wb") as file:
            for mesh in (mesh for path in files for mesh in meshes_of(path)):
                vertices = placed(mesh, displacement)
                if first is None:
                    first = before = mesh
                    start = last = vertices
                    elements, moving = elements_of(mesh), np.zeros(len(vertices), np.bool_)
                    first_groups = groups_of(mesh, groups) if groups is not None else None
                else:
                    require_next(mesh, first, before, order)
                    moving |= (vertices != start).any(axis=1)
                    equal += [f"{before.name} and {mesh.name}"] if np.array_equal(vertices, last) else []
                    if groups in mesh.of_cells and groups_of(mesh, str(groups)) != first_groups:
                        raise FrameError(f"{mesh.name}: its groups are not those of {first.name}: all frames must have the same")
                file.write(np.ascontiguousarray(vertices, dtype="<f8").tobytes())
                before, last, count = mesh, vertices, count + 1
        if first is None:
            raise FrameError(f"no frame: name files, or a folder that has some: {', '.join(FORMATS)}")
        write_archive(pathlib.Path(folder) / "whole.npz", places, (count, *start.shape), elements)
        if first_groups is not None:
            (pathlib.Path(folder) / "groups").write_text("".join(f"{group}\n" for group in first_groups))
            os.replace(pathlib.Path(folder) / "groups", out.with_suffix(".groups"))
        os.replace(pathlib.Path(folder) / "whole.npz", out)
    cells = [f"{(first.kinds == number).sum()} {kind}" for kind, (number, _) in KINDS.items() if number in first.kinds]
    names = first.name if count == 1 else f"{first.name} … {before.name}, {how if len(files) > 1 else 'as in the file'}"
    read = f"frames: {count} ({names}); vertices: {len(start)}, of which {moving.sum()} move; cells of each: {', '.join(cells)}"
    elements.notes.insert(0, read)
    fields = first.of_points if equal and displacement is None else {}
    vectors = [key for key, array in fields.items() if np.shape(array())[1:] in ((2,), (3,))]
    if vectors:
        text = f"frames that are equal: {len(equal)}, first {equal[0]}; there are fields of vectors: {', '.join(vectors)}"
        elements.notes.append(f"{text} (--displacement adds one to the places)")
    return elements


def write_archive(path: pathlib.Path, places: pathlib.Path, shape: Tuple[int, ...], elements: Elements) -> None:
    """Write the places of all frames, which stand in a file, and the elements."""
    with zipfile.ZipFile(path, "w", allowZip64=True) as archive:
        with archive.open("V.npy", "w", force_zip64=True) as entry, open(places, "rb") as file:
            numpy_format.write_array_header_2_0(entry, {"descr": "<f8", "fortran_order": False, "shape": shape})
            while block := file.read(1 << 20):
                entry.write(block)
        for name, array in elements.arrays.items():
            if len(array):
                with archive.open(f"{name}.npy", "w") as entry:
                    numpy_format.write_array(entry, array)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; 2 for bad input."""
    parser = argparse.ArgumentParser(
        prog="python3 -m touchstone.frames",
        description=f"Write frames of other formats ({', '.join(FORMATS)}) into one archive for `touchstone step`.",
        epilog="Example: python3 -m touchstone.frames FOLDER --out run.npz && touchstone step run.npz",
    )
    parser.add_argument("files", nargs="+", metavar="FILE", help="a frame each in the order of time, or a folder; XDMF, .pvd: all steps")
    parser.add_argument("--out", required=True, metavar="FILE", help="the archive (.npz)")
    parser.add_argument("--displacement", metavar="FIELD", help="field of the vertices, added to their places")
    parser.add_argument("--groups", metavar="FIELD", help="field of the cells: the groups of the vertices, beside OUT (.groups)")
    order = "as given, whatever names and times say, or by the numbers in the names, as in a folder (default: as given, unless doubtful)"
    parser.add_argument("--order", choices=("given", "numbers"), help=order)
    options = parser.parse_args(arguments)
    try:
        if pathlib.Path(options.out).suffix != ".npz":
            raise FrameError(f"{options.out}: the archive's name must end in .npz")
        elements = convert(
            options.files, options.out, displacement=options.displacement, groups=options.groups, order=options.order
        )
    except (FrameError, OSError) as error:
        print(f"touchstone.frames: error: {error}", file=sys.stderr)
        return 2
    print(f"read: {elements.notes[0]}", flush=True)
    for note in elements.notes[1:]:
        print(f"touchstone.frames: {note}", file=sys.stderr)
    names = ("faces", "edges of their own", "points", "tetrahedra")
    counts = zip(map(len, elements.arrays.values()), names)
    print(f"written: {options.out}: " + ", ".join(f"{count} {what}" for count, what in counts if count))
    if options.groups:
        print(f"written: {pathlib.Path(options.out).with_suffix('.groups')}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
