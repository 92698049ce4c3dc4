"""Scenes: impacts, distances and step sizes of a moving mesh, and intersections of one at rest."""

# What the extension modules return has no type.
# mypy: no-warn-return-any

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Callable, Literal, Mapping, Tuple

import numpy as np
import numpy.typing as npt

from ._input import Doubles, Norm, as_doubles, as_indices, as_motion, as_vertices, checked, interruptible, load
from ._tool import Progress

_fast: Any = load("_fast")
Indices = npt.NDArray[np.int32]


class ContactKind(IntEnum):
    """The primitives of a pair, and the meaning of its two numbers."""

    VERTEX_FACE = 0
    EDGE_EDGE = 1
    VERTEX_EDGE = 2
    VERTEX_VERTEX = 3


class CellKind(IntEnum):
    """The cells of a mesh, which have a volume, or an area in the plane."""

    TETRAHEDRON = 0
    PLANE_TRIANGLE = 1


class PrimitiveKind(IntEnum):
    """The primitives of a mesh."""

    FACE = 0
    EDGE = 1
    POINT = 2


class IntersectionKind(IntEnum):
    """The way in which two elements intersect: the first of these that is true.

    An edge goes through a face if the inside of a face meets that of another one, or that of an edge.
    """

    DUPLICATES = 0
    FOLDED_FACES = 1
    COPLANAR_OVERLAP = 2
    EDGE_THROUGH_FACE = 3
    VERTEX_IN_FACE = 4
    EDGES_OVERLAP = 5
    EDGES_CROSS = 6
    VERTEX_ON_EDGE = 7
    VERTICES_COINCIDE = 8


@dataclass(frozen=True)
class Impact:
    """The earliest impact of a step.

    Attributes
    ----------
    toi_lower, toi_upper : float
        An enclosure of its time.
    pairs : structured ndarray
        The collisions that may be the first one, as `Step.collisions` has them.
    inversions : structured ndarray
        Likewise the inversions, as `Step.inversions` has them.
    """

    toi_lower: float
    toi_upper: float
    pairs: npt.NDArray[np.void]
    inversions: npt.NDArray[np.void]


@dataclass(frozen=True)
class LeastDistance:
    """The least distance of a step's pairs.

    Attributes
    ----------
    lower, upper : float
        An enclosure by doubles that are equal or neighbours.
    pairs : structured ndarray
        All pairs with this enclosure: `kind` and `pair`.
    """

    lower: float
    upper: float
    pairs: npt.NDArray[np.void]


@dataclass(frozen=True)
class LineSearchLimit:
    """The limit of a line search.

    Attributes
    ----------
    status : {"whole", "limited", "in_contact", "too_small", "inverted"}
        The reason for the step size; "inverted": a cell is flat or inverted at the start.
    step_size : float
        The step size that is allowed, rounded down.
    distance_lower, distance_upper : float
        An enclosure of the least distance at the start.
    pairs : structured ndarray
        The pairs that limit the step, or are in contact, as `Step.collisions` has them.
    inversions : structured ndarray
        The cells that limit the step, as `Step.inversions` has them.
    """

    status: Literal["whole", "limited", "in_contact", "too_small", "inverted"]
    step_size: float
    distance_lower: float
    distance_upper: float
    pairs: npt.NDArray[np.void]
    inversions: npt.NDArray[np.void]


@dataclass(frozen=True)
class SceneProof:
    """A claim about a scene with its proof.

    Attributes
    ----------
    claim : str
        "no_contact T" or "earliest LO HI" of a step; "intersections N" or "welded_intersections N" of a
        mesh at rest.
    rules : str
        What of the scene is left out, which weakens the claim, in the words of `check`: "1 pair of groups
        held apart"; empty if nothing is.
    label : str
        The label that was given.
    certificate : bytes
        A stream with this certificate, which `check` and touchstone-check read (exact/CERTIFICATES.md).
    """

    claim: str
    rules: str
    label: str
    certificate: bytes

    def __repr__(self) -> str:
        rules = f", {self.rules!r}" if self.rules else ""
        return f"SceneProof({self.claim!r}{rules}, {self.label!r}, {len(self.certificate)} bytes)"


def _proved(
    title: str,
    prove: Callable[..., Tuple[str, str, bytes]],
    arguments: Tuple[Any, ...],
    threads: int,
    label: str,
    show: bool | None,
) -> SceneProof:
    if _fast.is_forked():
        threads = 1  # the others of the pool are in the parent
    with Progress(title, show, queries=1000) as bar:
        claim, rules, certificate = interruptible(lambda: prove(*arguments, threads, label, bar.callback))
    return SceneProof(claim, rules, label, certificate)


def _as_thickness(
    radii: npt.ArrayLike | None, separations: Mapping[Tuple[int, int], float] | None
) -> Tuple[Doubles, npt.NDArray[np.int32], Doubles]:
    """Return radii of shape (g,), and the groups (k, 2) and distances (k,) of separations."""
    of_groups = as_doubles([] if radii is None else radii, "radii")
    if of_groups.ndim != 1:
        raise ValueError(f"radii must have the shape (g,), not {of_groups.shape}")
    pairs = {} if separations is None else dict(separations)
    groups = as_indices(list(pairs), "separations", 2)
    return of_groups, groups, as_doubles(list(pairs.values()), "separations")


class Step:
    """A step of a mesh whose vertices move from t=0 to t=1, on straight lines or on Bézier curves.

    Two primitives collide if they have a common point at some time, or come within the separation. A
    cell inverts if its volume is 0 or negative at some time.
    Answers are exact, and the same for any number of threads. Vertices alone collide with nothing: a
    step without faces, edges and points is free.

    Parameters
    ----------
    before, after : array_like of shape (n, 3)
        The vertices at t=0 and at t=1; copied. On curves, `before` alone: the control points of each vertex
        from t=0 to t=1, of shape (n, degree + 1, 3), or (n, degree + 1, 4) with positive weights last. On
        curves, cells cannot invert, and methods about distances, contacts, step sizes and proofs raise
        ValueError.
    faces : array_like of int, shape (f, 3), optional
        The faces by the numbers of their vertices.
    edges : array_like of int, shape (e, 2), optional
        All edges; by default those of the faces.
    points : array_like of int, shape (p,), optional
        Vertices that are part of the scene in any case.
    groups : array_like of int, shape (n,), optional
        The group of each vertex, from 0 on; by default all are in group 0.
    apart : array_like of int, shape (k, 2), optional
        Pairs of groups that cannot collide, each the group of a vertex; the same group twice: not within it.
    tetrahedra : array_like of int, shape (m, 4), optional
        Cells a, b, c, d whose volume, with the sign of det(b - a, c - a, d - a), is to stay positive.
        They do not collide.
    plane_triangles : array_like of int, shape (k, 3), optional
        Cells whose area in the plane of x and y, positive if counterclockwise, is to stay so. They
        do not collide.
    radii : array_like of float, shape (g,), optional
        The radius of each group. Primitives are in contact within the separation and the greatest sum
        of the radii of a vertex of one and a vertex of the other: in "l2" vertices are spheres, and
        edges capsules. Distances are those of thick primitives, too.
    separations : mapping of (int, int) to float, optional
        Pairs of groups, in either order, with a distance in place of the sum of their radii; each the
        group of a vertex.
    can_collide : callable, optional
        A rule for pairs of vertices: two primitives can collide if `can_collide(i, j)` is true for a
        vertex of one and a vertex of the other that are in groups that can collide. It must be
        symmetric. It is called for the pairs found, from several threads, one at a time; what it
        raises ends the search.
    separation, norm, t_max, toi_tolerance, threads, progress : optional
        As for `solve`.

    Raises
    ------
    ValueError
        For another shape or type, for a coordinate that is NaN or infinite, naming its vertex, and
        for options out of range.
    IndexError
        For an index out of range, naming its element.

    Notes
    -----
    Ctrl-C ends a method with `Interrupted`, without a result, and also those that run on this step,
    or on one of the same mesh, in other threads.

    Examples
    --------
    A triangle falls on another one:

    >>> import numpy as np, touchstone
    >>> triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    >>> before = np.concatenate([triangle, triangle + [0.1, 0.1, 1]])
    >>> after = np.concatenate([triangle, triangle + [0.1, 0.1, -1]])
    >>> step = touchstone.Step(before, after, faces=[[0, 1, 2], [3, 4, 5]])
    >>> step.is_free()
    False
    >>> impact = step.earliest()
    >>> impact.toi_lower <= 0.5 <= impact.toi_upper
    True
    >>> step.line_search_limit(0.5).status
    'limited'
    """

    @checked
    def __init__(
        self,
        before: npt.ArrayLike,
        after: npt.ArrayLike | None = None,
        *,
        faces: npt.ArrayLike | None = None,
        edges: npt.ArrayLike | None = None,
        points: npt.ArrayLike | None = None,
        groups: npt.ArrayLike | None = None,
        apart: npt.ArrayLike | None = None,
        tetrahedra: npt.ArrayLike | None = None,
        plane_triangles: npt.ArrayLike | None = None,
        radii: npt.ArrayLike | None = None,
        separations: Mapping[Tuple[int, int], float] | None = None,
        can_collide: Callable[[int, int], bool] | None = None,
        separation: float = 0.0,
        norm: Norm = "l2",
        t_max: float = 1.0,
        toi_tolerance: float = 1e-12,
        threads: int = 0,
        progress: bool | None = None,
    ) -> None:
        self._progress = progress
        self._vertices = as_motion(before, after)
        self._separation: Tuple[float, Norm] = separation, norm
        self._options = t_max, toi_tolerance, threads
        self._elements = (
            as_indices(faces, "faces", 3),
            as_indices(edges, "edges", 2),
            as_indices(points, "points", None),
            as_indices(groups, "groups", None),
            as_indices(apart, "apart", 2),
            [as_indices(tetrahedra, "tetrahedra", 4), as_indices(plane_triangles, "plane_triangles", 3)],
        )
        self._thickness = _as_thickness(radii, separations)
        if can_collide is not None and not callable(can_collide):
            raise TypeError("can_collide: a function of two vertices is needed")
        self._can_collide = can_collide
        self._step = interruptible(
            lambda: _fast.Step(
                *self._vertices,
                *self._elements,
                *self._thickness,
                can_collide,
                separation,
                norm,
                toi_tolerance,
                t_max,
                threads,
            )
        )

    @checked
    def moved(
        self,
        before: npt.ArrayLike,
        after: npt.ArrayLike | None = None,
        *,
        separation: float | None = None,
        norm: Norm | None = None,
    ) -> Step:
        """Return the step of the same mesh between other places.

        It shares what does not depend on places, and keeps all options but those given.

        Parameters
        ----------
        before, after : array_like
            As for `Step`.
        separation, norm : optional
            As for `Step`; by default those of this step.
        """
        result = object.__new__(Step)
        result._vertices = as_motion(before, after)
        result._elements = self._elements
        result._thickness = self._thickness
        result._can_collide = self._can_collide
        result._options = self._options
        result._progress = self._progress
        result._separation = (
            self._separation[0] if separation is None else separation,
            self._separation[1] if norm is None else norm,
        )
        result._step = interruptible(
            lambda: self._step.moved(*result._vertices, *result._separation)
        )
        return result

    def _search(self, search: Callable[[Callable[..., None] | None], Any]) -> Any:
        with Progress("Step", self._progress) as bar:
            return interruptible(lambda: search(bar.callback))

    @property
    def edges(self) -> npt.NDArray[np.int32]:
        """All edges in the search, of shape (e, 2)."""
        return self._step.edges()

    def query(self, kind: ContactKind | int, pair: npt.ArrayLike) -> Doubles:
        """Return the query of a pair: an array of shape (8, 3).

        A vertex and an edge are the query of the vertex and the face (e0, e1, e0), two vertices that
        of the first one and the face (w, w, w).
        """
        first, second = as_indices(pair, "pair", None).tolist()
        return self._step.query(int(ContactKind(kind)), first, second)

    def earliest(self) -> Impact | None:
        """Return the earliest impact; None if the step is free."""
        found = self._search(self._step.earliest)
        return None if found is None else Impact(*found)

    def collisions(self) -> npt.NDArray[np.void]:
        """Return all collisions, an item each.

        Returns
        -------
        structured ndarray
            With the fields `kind` (see `ContactKind`), `pair` (two numbers), `toi_lower`, `toi_upper`,
            `u` and `v`. The order depends only on the step.
        """
        return self._search(self._step.collisions)

    @checked
    def contacts(self, collisions: npt.NDArray[np.void] | None = None) -> npt.NDArray[np.void]:
        """Return where collisions are, and from which side, with bounds of the errors.

        Parameters
        ----------
        collisions : structured ndarray, optional
            Some of this step's collisions, as from `collisions` or the `pairs` of `earliest`; by
            default all.

        Returns
        -------
        structured ndarray
            The fields of `collisions`, in their order, and

            - `points`, of shape (2, 3): on the first primitive and on the second, at the time of
              impact, each within `point_error` of the exact one;
            - `normal`, a unit vector from the second primitive to the first: the direction of the
              points, or, if they touch, that of the face's normal or the edges' cross product from
              which the first primitive comes;
            - `normal_error`: its greatest distance from the exact normal; infinity if there is none,
              as of parallel edges that touch, or no bound;
            - `has_side`: False if the opposite vector may be the normal, as of primitives that
              touch at rest.

        Raises
        ------
        ValueError
            For an array that is none of collisions.
        IndexError
            For a collision of another mesh.
        """
        if collisions is not None:
            layout = np.dtype(_fast.collision_layout())
            if getattr(collisions, "dtype", None) != layout:
                raise ValueError("collisions must be an array as Step.collisions returns it")
            collisions = np.ascontiguousarray(collisions)
        return self._search(lambda progress: self._step.contacts(collisions, progress))

    def inversions(self) -> npt.NDArray[np.void]:
        """Return all cells that invert, an item each, tetrahedra first.

        Returns
        -------
        structured ndarray
            With the fields `kind` (see `CellKind`), `cell` (its number among those of its kind),
            `start` (the sign of its volume at t=0: 1, 0 or -1), `toi_lower` and `toi_upper`; both are
            0 if it is flat or inverted at t=0.
        """
        return self._search(self._step.inversions)

    def starts_free(self) -> bool:
        """Return True if at t=0 the mesh does not intersect itself, and no cell is flat or inverted."""
        return self._search(self._step.starts_free)

    def is_free(self) -> bool:
        """Return True if there is no collision and no inversion."""
        return self._search(self._step.is_free)

    def free_step_size(self) -> float | None:
        """Return a maximal step size α, up to t_max, whose rounded step is free; None if not even α = 0 is.

        The step of α goes from x0 to fl(x0 + fl(α fl(x1 − x0))), and that of the next double is not
        free, unless α is t_max. Both are decided exactly.
        """
        return self._search(self._step.free_step_size)

    @checked
    def active_set(self, eta: float, *, norm: Norm = "l2") -> npt.NDArray[np.void]:
        """Return all pairs that come within a distance during the step, with their contacts.

        Parameters
        ----------
        eta : float
            The distance, in units of the coordinates.
        norm : {"linf", "l2"}, optional
            Its norm.

        Returns
        -------
        structured ndarray
            The fields of `contacts`, in the order of time.
        """
        return self._search(lambda progress: self._step.active_set(eta, norm, progress))

    @checked
    def line_search_limit(
        self, p: float, *, norm: Norm = "l2", of_pair: bool = False, kept_volume: float = 0.0
    ) -> LineSearchLimit:
        """Return the step size up to which all primitives stay p times as far apart as at the start.

        Up to it, all cells keep more than a part of their volumes, too.

        Parameters
        ----------
        p : float
            More than 0 and at most 1 − 2^-50.
        norm : {"linf", "l2"}, optional
            The norm of distances.
        of_pair : bool, optional
            False: the reference is the least distance of the scene. True: each pair's own.
        kept_volume : float, optional
            The part of its volume at t=0 of which a cell must keep more, in [0, 1). With 0, no
            cell inverts.
        """
        status, size, (lower, upper), pairs, inversions = self._search(
            lambda progress: self._step.line_search_limit(p, norm, of_pair, kept_volume, progress)
        )
        return LineSearchLimit(status, size, lower, upper, pairs, inversions)

    def candidates(self) -> npt.NDArray[np.void]:
        """Return all pairs whose swept boxes are within the separation, sorted.

        Returns
        -------
        structured ndarray
            With the fields `kind` and `pair`.
        """
        return self._search(self._step.candidates)

    @checked
    def least_distance(self, *, t: float = 0.0, norm: Norm = "l2") -> LeastDistance | None:
        """Return the least distance of all pairs at a time; None without pairs.

        Parameters
        ----------
        t : float, optional
            The time, in [0, 1].
        norm : {"linf", "l2"}, optional
            The norm of distances.
        """
        found = self._search(lambda progress: self._step.least_distance(t, norm, progress))
        return None if found is None else LeastDistance(*found)

    @checked
    def prove(self, *, label: str = "") -> SceneProof:
        """Prove that the step is free up to t_max, or the time of its earliest contact or inversion.

        Edges are numbered there by their larger vertex, then by the smaller.

        Parameters
        ----------
        label : str, optional
            A line of text for the certificate.

        Raises
        ------
        ValueError
            If the step has a rule `can_collide`, which certificates cannot have.
        RuntimeError
            If the certificate would exceed the limits of the format.

        Examples
        --------
        >>> import numpy as np, touchstone
        >>> triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
        >>> before = np.concatenate([triangle, triangle + [0.125, 0.125, 1]])
        >>> after = np.concatenate([triangle, triangle + [0.125, 0.125, 0.5]])
        >>> proof = touchstone.Step(before, after, faces=[[0, 1, 2], [3, 4, 5]]).prove()
        >>> proof.claim
        'no_contact 1'
        >>> touchstone.check(proof.certificate, claim="free")
        CheckReport: 1 accepted, 0 rejected
        """
        if self._can_collide is not None:
            raise ValueError("prove: certificates know groups alone, not a rule can_collide")
        t_max, _, threads = self._options
        arguments = (*self._vertices, *self._elements, *self._thickness, *self._separation, t_max)
        return _proved("Step.prove", load("_exact").prove_step, arguments, threads, label, self._progress)


def _at_rest(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike | None,
    edges: npt.ArrayLike | None,
    points: npt.ArrayLike | None,
    groups: npt.ArrayLike | None,
    apart: npt.ArrayLike | None,
) -> Tuple[Doubles, Indices, Indices, Indices, Indices, Indices]:
    return (
        as_vertices(vertices, "vertices"),
        as_indices(faces, "faces", 3),
        as_indices(edges, "edges", 2),
        as_indices(points, "points", None),
        as_indices(groups, "groups", None),
        as_indices(apart, "apart", 2),
    )


@checked
def intersections(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike | None = None,
    *,
    edges: npt.ArrayLike | None = None,
    points: npt.ArrayLike | None = None,
    groups: npt.ArrayLike | None = None,
    apart: npt.ArrayLike | None = None,
    weld: bool = False,
    threads: int = 0,
    progress: bool | None = None,
) -> npt.NDArray[np.void]:
    """Return where a mesh at rest intersects itself, exactly.

    Elements that have vertices in common intersect if they meet elsewhere. Faces without an area and
    edges without a length are what they are: segments and points.

    Parameters
    ----------
    vertices : array_like of shape (n, 3)
        The places of the vertices.
    faces : array_like of int, shape (f, 3), optional
        The faces by the numbers of their vertices. Vertices at the same place under two numbers are
        two vertices; see `weld`.
    edges : array_like of int, shape (e, 2), optional
        Edges of no face take part, too. One that is listed twice is one edge; one from a vertex to
        itself is a point.
    points : array_like of int, shape (p,), optional
        Vertices that are part of the mesh in any case.
    groups, apart : optional
        As for `Step`: groups of vertices, and those that are not examined.
    weld : bool, optional
        True: vertices at the same place, of the same group, are one, before elements are found.
    threads, progress : optional
        As for `solve`.

    Returns
    -------
    structured ndarray
        An item for each pair, in order, with the fields `kind` (see `IntersectionKind`), `elements`
        (two of `PrimitiveKind`), `numbers` (two, of faces, edges or points) and `place` of shape
        (2, 2, 3): for both ends of what they have in common, the same for a point, the lower and the
        upper ends of its coordinates. Of an area it is the least and the greatest corner.

    Raises
    ------
    ValueError
        For another shape or type, and for a coordinate that is NaN or infinite, naming its vertex.
    IndexError
        For an index out of range, naming its element.

    Examples
    --------
    >>> import touchstone
    >>> vertices = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [9, 9, 0]]
    >>> found = touchstone.intersections(vertices, [[0, 1, 2], [3, 4, 5]])
    >>> touchstone.IntersectionKind(found[0]["kind"]).name
    'EDGE_THROUGH_FACE'
    """
    arguments = _at_rest(vertices, faces, edges, points, groups, apart)
    with Progress("intersections", progress) as bar:
        return interruptible(
            lambda: _fast.intersections(*arguments, weld, threads, bar.callback)
        )


@checked
def prove_mesh(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike | None = None,
    *,
    edges: npt.ArrayLike | None = None,
    points: npt.ArrayLike | None = None,
    groups: npt.ArrayLike | None = None,
    apart: npt.ArrayLike | None = None,
    weld: bool = False,
    label: str = "",
    threads: int = 0,
    progress: bool | None = None,
) -> SceneProof:
    """Prove which elements of a mesh at rest intersect: these pairs, and no others.

    Elements are numbered there: the faces as they are given, the edges of no face by their larger vertex,
    then by the smaller, and the points without an edge by their vertex.

    Parameters
    ----------
    vertices, faces, edges, points, groups, apart, weld, threads, progress
        As for `intersections`.
    label : str, optional
        A line of text for the certificate.

    Raises
    ------
    ValueError, IndexError
        As `intersections`.
    RuntimeError
        If the certificate would exceed the limits of the format.

    Examples
    --------
    >>> import touchstone
    >>> vertices = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [9, 9, 0]]
    >>> proof = touchstone.prove_mesh(vertices, [[0, 1, 2], [3, 4, 5]])
    >>> proof.claim
    'intersections 1'
    >>> touchstone.check(proof.certificate)
    CheckReport: 1 accepted, 0 rejected
    """
    arguments = (*_at_rest(vertices, faces, edges, points, groups, apart), weld)
    return _proved("prove_mesh", load("_exact").prove_mesh, arguments, threads, label, progress)
