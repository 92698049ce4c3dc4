"""Readers of the meshes that other programs write: a file is read whole, or refused with what is not understood.

VTK's own readers (Debian's python3-vtk9) read .vtk, .vtu, .vtp, .vts, .vtr and .vti; .pvd, .pvtu, .pvtp and .vtm are lists of
such files. XDMF is read here (HDF5 by python3-h5py), .msh of Gmsh and .inp of Abaqus by meshio (python3-meshio). Whatever the
reader: the counts of points and cells are those that the text of the file states, and corners are among its points.
"""

from __future__ import annotations

import importlib
import mmap
import pathlib
import re
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Callable, Dict, Iterator, List, Sequence, Tuple
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
Fields = Dict[str, Callable[[], Any]]

# Kinds of cells that are read: VTK's number, and the number of corners, or the least one.
KINDS = {
    "vertex": (1, 1), "polyvertex": (2, 1), "line": (3, 2), "polyline": (4, 2), "triangle": (5, 3), "strip": (6, 3),
    "polygon": (7, 3), "pixel": (8, 4), "quad": (9, 4), "tetra": (10, 4), "voxel": (11, 8), "hexahedron": (12, 8),
    "wedge": (13, 6), "pyramid": (14, 5),
}  # fmt: skip
OF_ANY_SIZE = ("polyvertex", "polyline", "strip", "polygon")
# XDMF's numbers of kinds, from 1.
XDMF_KINDS = ("polyvertex", "polyline", "polygon", "triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron")
VTK_FILES = (".vtk", ".vtu", ".vtp", ".vts", ".vtr", ".vti")
LISTS = (".pvd", ".pvtu", ".pvtp", ".vtm")
FORMATS = (*VTK_FILES, *LISTS, ".xdmf", ".xmf", ".msh", ".inp")


class FrameError(ValueError):
    """A file that is not what is needed; the text names it, the reason and the way out."""


@dataclass(frozen=True)
class Mesh:
    """What a file holds at one time: cells by VTK's numbers of their kinds, with their corners in one row.

    Attributes
    ----------
    points : ndarray of shape (n, 2) or (n, 3)
    kinds, sizes : ndarray of shape (c,)
    corners : ndarray of shape (sum of the sizes,)
    of_points, of_cells : dict
        The fields by their names; each is read when it is asked for.
    """

    name: str
    points: Any
    kinds: Indices
    sizes: Indices
    corners: Indices
    of_points: Fields = field(default_factory=dict)
    of_cells: Fields = field(default_factory=dict)
    time: float | None = None

    def cells(self) -> List[Tuple[str, Indices]]:
        """Return the name and the corners, of shape (m, k), of the cells of each kind and size."""
        names = {number: name for name, (number, _) in KINDS.items()}
        starts = np.cumsum(self.sizes) - self.sizes
        result = []
        for kind, size in np.unique(np.stack([self.kinds, self.sizes], axis=1), axis=0):
            of_kind = (self.kinds == kind) & (self.sizes == size)
            name = names.get(int(kind), f"number {kind} of VTK")
            least = KINDS.get(name, (0, size + 1))[1]
            if size < least or (size > least and name not in OF_ANY_SIZE):
                some = f"{of_kind.sum()} cells of the type {name} with {size} corners"
                raise FrameError(f"{self.name}: {some} are not read, only {', '.join(KINDS)}")
            result.append((name, self.corners[starts[of_kind][:, None] + np.arange(size)]))
        return result


def module(name: str, package: str) -> Any:
    """Return a module, which this package of pip brings."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        debian = {"vtk": "vtk9"}.get(package, package)
        raise FrameError(f"{package} is missing: apt-get install python3-{debian}, or pip install {package}") from None


def vtk(name: str) -> Any:
    """Return a module of VTK."""
    return module(f"vtkmodules.{name}", "vtk")


# ---- Fields ----


def in_space(array: Any, name: str, what: str) -> Doubles:
    """Return an array of shape (n, 2) or (n, 3) as one of shape (n, 3)."""
    given = np.asarray(array)
    if given.ndim != 2 or given.shape[1] not in (2, 3):
        raise FrameError(f"{name}: {what} must have 2 or 3 columns, not the shape {given.shape}")
    rows = given.astype(np.float64)
    if not np.isfinite(rows).all():
        raise FrameError(f"{name}: {what} must be finite")
    if given.dtype.kind in "iu" and (abs(rows) > 2**53).any():
        raise FrameError(f"{name}: {what} must be numbers that a double holds")
    return np.pad(rows, ((0, 0), (0, 3 - rows.shape[1])))


def field_of(fields: Fields, key: str, rows: int, name: str, what: str) -> Any:
    """Return a field that has as many rows as there are points or cells."""
    if key not in fields:
        raise FrameError(f"{name}: no field {key} of {what}; there are: {', '.join(fields) or 'none'}")
    array = np.asarray(fields[key]())
    if len(array) != rows:
        raise FrameError(f"{name}: the field {key} has {len(array)} rows, but there are {rows} {what}")
    return array


# ---- Files ----


def checked(mesh: Mesh, points: int, cells: int) -> Mesh:
    """Return a mesh that has the counts that its file states, and corners that are among its points."""
    read = len(mesh.points), len(mesh.kinds)
    if read != (points, cells):
        raise FrameError(f"{mesh.name}: it states {points} points and {cells} cells, but read were {read[0]} and {read[1]}")
    if len(mesh.sizes) != cells or mesh.sizes.sum() != len(mesh.corners):
        raise FrameError(f"{mesh.name}: its {len(mesh.corners)} corners are not those of {cells} cells")
    outside = np.flatnonzero((mesh.corners < 0) | (mesh.corners >= points))
    if len(outside):
        cell = np.searchsorted(np.cumsum(mesh.sizes), outside[0], "right")
        raise FrameError(f"{mesh.name}: cell {cell}: point {mesh.corners[outside[0]]}, but there are {points}, counted from 0")
    if any(f[key]().any() for f in (mesh.of_points, mesh.of_cells) for key in f if key.startswith("vtkGhost")):
        raise FrameError(f"{mesh.name}: ghost points or cells are not read: write it without them")
    return mesh


def stated(path: pathlib.Path) -> Tuple[int, int]:
    """Return the number of points and of cells that the text of a VTK file states."""
    is_legacy = path.suffix.lower() == ".vtk"
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        if not is_legacy and text.rfind(b"</VTKFile>") < 0:
            raise FrameError(f"{path}: it is no VTK file, or ends before </VTKFile>")
        appended = -1 if is_legacy else text.find(b"<AppendedData")

        def found(legacy: bytes, xml: bytes) -> List[List[int]]:
            pattern = rb"(?i)\n(?:%s)[ \t]+(\d[\d \t]*)" % legacy if is_legacy else rb"\b(?:%s)\s*=\s*[\"']([-\d\s]+)" % xml
            matches = re.compile(pattern).finditer(text, 0, len(text) if appended < 0 else appended)
            return [[int(n) for n in match[1].split()] for match in matches]

        points = found(b"POINTS", b"NumberOfPoints")
        cells = found(b"CELLS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS", b"NumberOf(?:Cells|Verts|Lines|Strips|Polys)")
        extent = found(b"DIMENSIONS", b"WholeExtent")
        # From version 5 on the first number is that of the places where cells begin, and the end of the last.
        more = 1 if re.match(rb"# vtk DataFile Version (?:[5-9]|\d\d)", text[:40]) else 0
        count = sum(max(0, n[0] - more) for n in cells)
        require_lists(text, path, count, is_legacy and more == 0)
    if not extent:
        return sum(n[0] for n in points), count
    sides = [n - 1 for n in extent[0]] if is_legacy else [b - a for a, b in zip(extent[0][::2], extent[0][1::2])]
    return int(np.prod([n + 1 for n in sides])), int(np.prod([max(1, n) for n in sides]))


def require_lists(text: Any, path: pathlib.Path, count: int, is_old: bool) -> None:
    """Raise a FrameError if the lists of cells in a text have others than it states: VTK takes what is stated, and may crash."""
    ends = rb"<DataArray(?=[^>]*\"offsets\")(?=[^>]*\"ascii\")[^>]*>([^<]*)"
    found = sum(len(match[1].split()) for match in re.finditer(ends, text))
    found += sum(int(match[1]) for match in re.finditer(rb"(?i)\nCELL_TYPES[ \t]+(\d+)\s", text))
    if found not in (0, count):
        raise FrameError(f"{path}: it states {count} cells, but lists {found}")
    if is_old and re.match(rb"[^\n]*\n[^\n]*\nASCII", text[:512]):
        numbers = rb"(?i)\n(?:CELLS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS)[ \t]+\d+[ \t]+(\d+)\s+([-\d\s]*)"
        for size, words in re.findall(numbers, text):
            if len(words.split()) != int(size):
                raise FrameError(f"{path}: a list of cells states {int(size)} numbers, but has {len(words.split())}")


def vtk_data(path: pathlib.Path) -> Any:
    """Return the data set of a VTK file.

    Raises
    ------
    FrameError
        If VTK reports anything, even if it goes on.
    """
    core = vtk("vtkCommonCore")
    core.vtkLogger.SetStderrVerbosity(core.vtkLogger.VERBOSITY_OFF)
    said = core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(said)
    if path.suffix.lower() == ".vtk":
        reader = vtk("vtkIOLegacy").vtkGenericDataObjectReader()
        for what in ("Scalars", "Vectors", "Normals", "Tensors", "Fields"):
            getattr(reader, f"ReadAll{what}On")()
    else:
        reader = vtk("vtkIOXML").vtkXMLGenericDataObjectReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutputDataObject(0)
    if said.GetOutput().strip() or data is None:
        reason = re.sub(r"(?:ERROR|Warning): In .*\n|\(0x[0-9a-f]+\)", "", said.GetOutput()).strip().partition("\n")[0]
        raise FrameError(f"{path}: VTK cannot read it whole: {reason}")
    return data


def read_vtk(path: pathlib.Path) -> Mesh:
    """Return the mesh of a VTK file with one data set."""
    counts, data, numbers = stated(path), vtk_data(path), vtk("util.numpy_support").vtk_to_numpy
    time = data.GetFieldData().GetArray("TimeValue")
    if any(map(data.IsA, ("vtkStructuredGrid", "vtkRectilinearGrid", "vtkImageData"))):
        grid = vtk("vtkFiltersCore").vtkAppendFilter()
        grid.AddInputData(data)
        grid.Update()
        data = grid.GetOutput()
    lists: List[Tuple[Any, Tuple[str, ...]]] = []  # of cells, and their kinds by the number of corners
    if data.IsA("vtkUnstructuredGrid"):
        lists = [(data.GetCells(), ())]
    elif data.IsA("vtkPolyData"):
        lists = [(data.GetVerts(), ("vertex", "polyvertex")), (data.GetLines(), ("line", "polyline"))]
        lists += [(data.GetPolys(), ("triangle", "polygon")), (data.GetStrips(), ("strip", "strip"))]
    else:
        raise FrameError(f"{path}: {data.GetClassName()} is no mesh of points and cells")
    kinds, sizes, corners = ([np.empty(0, np.int64)] for _ in range(3))
    for cells, names in lists:
        if cells.GetNumberOfCells():
            sizes.append(np.diff(numbers(cells.GetOffsetsArray())))
            corners.append(numbers(cells.GetConnectivityArray()))
            (number, size), (others, _) = (KINDS[name] for name in names or ("strip", "strip"))
            kinds.append(np.where(sizes[-1] == size, number, others) if names else numbers(data.GetCellTypesArray()))
    fields: List[Fields] = []
    for attributes in (data.GetPointData(), data.GetCellData()):
        arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
        fields.append({str(array.GetName()): partial(numbers, array) for array in arrays if array is not None})
    points = numbers(data.GetPoints().GetData()) if data.GetNumberOfPoints() else np.empty((0, 3))
    rows = (np.concatenate(some).astype(np.int64) for some in (kinds, sizes, corners))
    at = time.GetTuple1(0) if time is not None and time.GetNumberOfTuples() == 1 else None
    return checked(replace(Mesh(str(path), points, *rows), of_points=fields[0], of_cells=fields[1], time=at), *counts)


def joined(meshes: Sequence[Mesh], name: str) -> Mesh:
    """Return one mesh of several, the points of each after those before, with the fields that all have."""

    def common(of: Sequence[Fields]) -> Fields:
        def array(key: str) -> Any:
            return np.concatenate([fields[key]() for fields in of])

        return {key: partial(array, key) for key in of[0] if all(key in fields for fields in of)}

    before = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    return Mesh(
        name,
        np.concatenate([in_space(mesh.points, mesh.name, "points") for mesh in meshes]),
        np.concatenate([mesh.kinds for mesh in meshes]),
        np.concatenate([mesh.sizes for mesh in meshes]),
        np.concatenate([mesh.corners + first for mesh, first in zip(meshes, before)]),
        common([mesh.of_points for mesh in meshes]),
        common([mesh.of_cells for mesh in meshes]),
        time=meshes[0].time,
    )


def listed(path: pathlib.Path) -> Iterator[Mesh]:
    """Yield the meshes of a list of files: of .pvd one for each time, of others one of all files."""
    is_series, is_blocks = (path.suffix.lower() == suffix for suffix in (".pvd", ".vtm"))
    times: Dict[float | None, List[pathlib.Path]] = {}
    for entry in ElementTree.parse(path).getroot().iter():
        file = entry.get("file") or entry.get("Source")
        if file or (entry.tag in ("DataSet", "Piece") and not is_blocks):  # a block without a file is empty
            if not file:
                raise FrameError(f"{path}: {entry.tag} {entry.attrib} names no file")
            times.setdefault(float(entry.get("timestep", "0")) if is_series else None, []).append(path.parent / file)
    if not times:
        raise FrameError(f"{path}: it names no file")
    for time, files in times.items():
        mesh = joined([mesh for file in files for mesh in meshes_of(file)], f"{path}, time {time:g}" if is_series else str(path))
        yield replace(mesh, time=time) if is_series else mesh


def read_meshio(path: pathlib.Path) -> Mesh:
    """Return the mesh of a .msh or .inp file as meshio reads it, if that is all that the text states."""
    text, is_gmsh = path.read_bytes(), path.suffix.lower() == ".msh"
    check = counts_of_gmsh(text, path) if is_gmsh else words_of_abaqus(text, path)
    mesh = getattr(module("meshio", "meshio"), "gmsh" if is_gmsh else "abaqus").read(path)
    blocks = [(str(block.type), np.asarray(block.data, np.int64).reshape(len(block.data), -1)) for block in mesh.cells]
    if not is_gmsh:  # each row has the number of the node or cell first
        words = mesh.points.size + len(mesh.points), sum(corners.size + len(corners) for _, corners in blocks)
        if words != check:
            text_of = f"{check[0]} and {check[1]} numbers, but read were {words[0]} and {words[1]}"
            raise FrameError(f"{path}: its nodes and elements are {text_of}")
        check = len(mesh.points), sum(len(corners) for _, corners in blocks)
    of_cells: Fields = {key: partial(np.concatenate, arrays) for key, arrays in mesh.cell_data.items()}
    return checked(Mesh(str(path), mesh.points, *of_blocks(blocks, path), {}, of_cells), *check)


def of_blocks(blocks: Sequence[Tuple[str, Indices]], path: pathlib.Path) -> Tuple[Indices, Indices, Indices]:
    """Return the kinds, the sizes and the corners of cells of shape (m, k) for each kind."""
    for kind, corners in blocks:
        if kind not in KINDS:
            raise FrameError(f"{path}: {len(corners)} cells of the type {kind} are not read, only {', '.join(KINDS)}")
    counts = [len(corners) for _, corners in blocks]
    kinds = np.repeat(np.array([KINDS[kind][0] for kind, _ in blocks], np.int64), counts)
    sizes = np.repeat(np.array([corners.shape[1] for _, corners in blocks], np.int64), counts)
    return kinds, sizes, np.concatenate([np.empty(0, np.int64), *(corners.reshape(-1) for _, corners in blocks)])


def counts_of_gmsh(text: bytes, path: pathlib.Path) -> Tuple[int, int]:
    """Return the number of nodes and of elements that a .msh file states."""
    form = re.search(rb"\$MeshFormat\s+([24])\S*\s+([01])", text)
    if form is None or b"$NodeData" in text or b"$ElementNodeData" in text:
        what = "it has no $MeshFormat of version 2 or 4" if form is None else "$NodeData: write places, or .vtu files"
        raise FrameError(f"{path}: not understood: {what}")
    counts = []
    for section in ("Nodes", "Elements"):
        places = [match.end() for match in re.finditer(rb"(?m)^\$%s\s*?\n" % section.encode(), text)]
        if len(places) != 1:
            raise FrameError(f"{path}: it has {len(places)} sections ${section}, not one")
        in_text = text[places[0] : places[0] + 80].split(b"\n")[0].split()
        is_binary = (form[1], form[2]) == (b"4", b"1")
        words: Any = np.frombuffer(text, "<u8", 2, places[0]) if is_binary else in_text
        counts.append(int(words[form[1] == b"4"]))
    return counts[0], counts[1]


def words_of_abaqus(text: bytes, path: pathlib.Path) -> Tuple[int, int]:
    """Return how many numbers an .inp file has as nodes and as elements, if it is nothing but a mesh."""
    words, sections = {"NODE": 0, "ELEMENT": 0}, [""]
    for line in text.decode().splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            sections.append(line[1:].split(",")[0].strip().upper())
            is_known = sections[-1] in ("HEADING", "NODE", "ELEMENT", "NSET", "ELSET")
            if not is_known or sections.count("NODE") > 1 or re.search(r"(?i)\b(SYSTEM|INPUT)\b", line):
                raise FrameError(f"{path}: not understood: {line}: read are *HEADING, one *NODE, *ELEMENT, *NSET and *ELSET")
        elif sections[-1] in words:
            words[sections[-1]] += len([word for word in line.split(",") if word.strip()])
    return words["NODE"], words["ELEMENT"]


# ---- XDMF ----


def understood(element: Any, path: pathlib.Path, attributes: str, children: str) -> Any:
    """Return an element of XDMF if it has no other attributes and children than those named."""
    unknown = [f'{element.tag} {key}="{value}"' for key, value in element.attrib.items() if key not in attributes.split()]
    unknown += [f"{child.tag} in {element.tag}" for child in element if child.tag not in children.split()]
    if unknown:
        raise FrameError(f"{path}: not understood: {', '.join(unknown)}: write .vtu files, or simpler XDMF")
    return element


def numbers_of(parent: Any, path: pathlib.Path, whole: bool = False) -> Any:
    """Return the array of the one DataItem of an element; of whole numbers if they must be."""
    items = parent.findall("DataItem")
    if len(items) != 1:
        raise FrameError(f"{path}: {parent.tag} must have one DataItem, not {len(items)}")
    item = understood(items[0], path, "Name ItemType Dimensions NumberType DataType Precision Format Version", "")
    kind = item.get("NumberType", item.get("DataType", "Float")).lower()
    text, form = (item.text or "").strip(), item.get("Format", "XML").upper()
    if form not in ("XML", "HDF") or kind not in ("float", "int", "uint") or item.get("ItemType", "Uniform") != "Uniform":
        raise FrameError(f"{path}: not understood: DataItem {item.attrib}")
    if form == "HDF":
        file, _, inside = text.rpartition(":")
        with module("h5py", "h5py").File(path.parent / file, "r") as archive:
            array = archive[inside][()]
    else:
        array = np.array(text.split(), "i8" if whole else kind[0] + item.get("Precision", "4"))
    shape = [int(n) for n in item.get("Dimensions", str(array.size)).split()]
    if whole and array.dtype.kind not in "iu":
        raise FrameError(f"{path}: {parent.tag} must have whole numbers, not {array.dtype}")
    if array.size != np.prod(shape):
        raise FrameError(f"{path}: a DataItem in {parent.tag} has {array.size} numbers, but states the dimensions {shape}")
    return array.reshape(shape)


def topology(element: Any, path: pathlib.Path) -> Tuple[Indices, Indices, Indices]:
    """Return the kinds, the sizes and the corners of the cells of a Topology."""
    understood(element, path, "Name TopologyType Type NumberOfElements Dimensions NodesPerElement", "DataItem")
    kind = element.get("TopologyType", element.get("Type", "")).lower()
    kind = {"quadrilateral": "quad", "tetrahedron": "tetra"}.get(kind, kind)
    data, blocks = numbers_of(element, path, whole=True).astype(np.int64).reshape(-1), []
    if kind == "mixed":
        at = 0
        while at < len(data):
            kind = dict(enumerate(XDMF_KINDS, 1)).get(int(data[at]), f"number {data[at]} of XDMF")
            at += 2 if kind in OF_ANY_SIZE else 1
            size = int(data[at - 1]) if kind in OF_ANY_SIZE else KINDS.get(kind, (0, 1))[1]
            blocks.append((kind, data[None, at : at + size]))
            at += max(size, 1)
    else:
        size = int(element.get("NodesPerElement", KINDS.get(kind, (0, 1))[1]))
        at = len(data) // size * size
        blocks.append((kind if kind in XDMF_KINDS else f"{kind or 'none'} of XDMF", data[:at].reshape(-1, size)))
    cells = of_blocks(blocks, path)
    count = element.get("NumberOfElements", element.get("Dimensions", str(len(cells[0]))))
    if at != len(data) or np.prod([int(n) for n in count.split()]) != len(cells[0]):
        raise FrameError(f"{path}: its Topology states {count} elements, but {len(cells[0])} were read of {len(data)} numbers")
    return cells


def grid_parts(grid: Any, root: Any, path: pathlib.Path) -> Tuple[Dict[str, List[Any]], List[Any]]:
    """Return the elements of a grid by their tags, and the grids of which it includes some."""
    include = "{http://www.w3.org/2003/XInclude}include"
    understood(grid, path, "Name GridType", f"Topology Geometry Time Attribute Information {include}")
    parts, others = list(grid), []
    for element in grid.findall(include):
        found = re.fullmatch(r"xpointer\((?:/Xdmf)?(.*)/\*\[self::Topology or self::Geometry\]\)", element.get("xpointer", ""))
        others.append(root.find("." + found[1]) if found else None)
        if others[-1] is None:
            raise FrameError(f"{path}: not understood: include {element.attrib}")
        parts += [part for part in others[-1] if part.tag in ("Topology", "Geometry")]
    of = {tag: [part for part in parts if part.tag == tag] for tag in ("Topology", "Geometry", "Time", "Attribute")}
    if [len(of["Topology"]), len(of["Geometry"])] != [1, 1] or len(of["Time"]) > 1:
        raise FrameError(f"{path}: a grid must have one Topology, one Geometry and at most one Time")
    return of, others


def steps(path: pathlib.Path) -> Iterator[Mesh]:
    """Yield the steps of an XDMF file, or its one mesh."""
    root = ElementTree.parse(path).getroot()
    domains = understood(root, path, "Version", "Domain Information").findall("Domain")
    grids = [grid for domain in domains for grid in understood(domain, path, "Name", "Grid Information").findall("Grid")]
    series = [grid for grid in grids if grid.get("CollectionType") == "Temporal"]
    unused, times = [grid for grid in grids if grid not in series], []
    if len(series) > 1 or (len(grids) > 1 and not series):
        raise FrameError(f"{path}: not understood: {len(series or grids)} grids that are not the steps of one series")
    if series:
        grids = understood(series[0], path, "Name GridType CollectionType", "Grid Time Information").findall("Grid")
        for element in series[0].findall("Time"):
            if understood(element, path, "TimeType", "DataItem").get("TimeType") != "List":
                raise FrameError(f"{path}: not understood: {element.attrib}")
            times += numbers_of(element, path).reshape(-1).tolist()
    last: Tuple[Any, Any] = (None, None)
    for i, grid in enumerate(grids):
        of, others = grid_parts(grid, root, path)
        unused = [other for other in unused if other is not grid and other not in others]
        geometry = understood(of["Geometry"][0], path, "Name GeometryType Type", "DataItem")
        columns = {"xyz": 3, "xy": 2}.get(geometry.get("GeometryType", geometry.get("Type", "XYZ")).lower())
        own = [float(understood(time, path, "Value TimeType", "").get("Value")) for time in of["Time"]]
        if columns is None or (times and (len(times) != len(grids) or own not in ([], [times[i]]))):
            what = geometry.attrib if columns is None else f"times {times} in the list of the series, and {own} of grid {i}"
            raise FrameError(f"{path}: not understood: {what}")
        time = times[i] if times else own[0] if own else None
        fields: Dict[str, Fields] = {"node": {}, "cell": {}}
        for part in of["Attribute"]:
            fields.setdefault(part.get("Center", "Node").lower(), {})[part.get("Name", "")] = partial(numbers_of, part, path)
        if last[0] is not of["Topology"][0]:
            last = of["Topology"][0], topology(of["Topology"][0], path)
        points = numbers_of(geometry, path)
        name = f"{path}, " + (f"grid {i}" if time is None else f"time {time:g}")
        mesh = Mesh(name, points.reshape(-1, columns), *last[1])
        mesh = replace(mesh, of_points=fields["node"], of_cells=fields["cell"], time=time)
        yield checked(mesh, points.size // columns, len(mesh.kinds))
    if unused:
        names = ", ".join(str(grid.get("Name")) for grid in unused)
        raise FrameError(f"{path}: not understood: grids beside the series: {names}")


# ---- All formats ----


def meshes_of(path: pathlib.Path) -> Iterator[Mesh]:
    """Yield the meshes of a file: of XDMF and .pvd all steps.

    Raises
    ------
    FrameError
        If the file cannot be read whole.
    """
    suffix = path.suffix.lower()
    if not path.exists():
        raise FrameError(f"{path}: does not exist")
    if suffix in (".obj", ".ply"):
        raise FrameError(f"{path}: `touchstone step` reads {suffix} itself: touchstone step A{suffix} B{suffix}, or a folder")
    if suffix not in FORMATS:
        raise FrameError(f"{path}: unknown format: read are {', '.join(FORMATS)}; .obj and .ply by `touchstone step` itself")
    try:
        if suffix in (".xdmf", ".xmf"):
            yield from steps(path)
        elif suffix in LISTS:
            yield from listed(path)
        else:
            yield read_vtk(path) if suffix in VTK_FILES else read_meshio(path)
    except FrameError:
        raise
    except Exception as error:  # of a reader
        raise FrameError(f"{path}: it cannot be read: {type(error).__name__}: {error}") from error
