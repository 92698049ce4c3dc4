"""Batches of queries: solvers and distances, outside Python's lock."""

# What the extension modules return has no type.
# mypy: no-warn-return-any

from __future__ import annotations

import functools
from enum import IntEnum
from typing import Any, Callable, Type, TypeVar, cast, overload

import numpy as np
import numpy.typing as npt

from ._input import AnyName, BatchResult, Booleans, CellName, ContactName, Doubles, Function, Interrupted, Norm
from ._input import as_contact, as_queries, checked, column, load
from ._tool import Progress

_fast: Any = load("_fast")
_certified_type = np.dtype(_fast.certified_layout())
_inversion_type = np.dtype(_fast.inversion_layout())
_tight_inclusion_type = np.dtype(_fast.tight_inclusion_layout())
_distance_type = np.dtype(_fast.distance_layout())

Result = TypeVar("Result", bound=BatchResult)


def instruction_set() -> str:
    """Return the name of the instruction set that the solvers use on this processor."""
    return str(_fast.instruction_set())


def run_batch(
    result: Type[Result],
    item_type: np.dtype[Any],
    progress: bool | None,
    out: Result | None,
    work: Callable[..., int],
    kind: str,
    queries: npt.ArrayLike,
    *options: Any,
    curves: bool = True,
) -> Result:
    """Return the results of work(kind, array, items, *options, callback): how many queries it has done.

    They are written into the memory of `out` if that is given.
    """
    array, single = as_queries(queries, curves)
    if out is None:
        out = result(np.empty(() if single else len(array), dtype=item_type))
    elif type(out) is not result or out.array.shape != (() if single else (len(array),)):
        shape = f" of shape {out.array.shape}" if isinstance(out, BatchResult) else ""
        raise ValueError(
            f"out must be an earlier {result.__name__} for as many queries, not a {type(out).__name__}{shape}"
        )
    items = out.array.reshape(len(array))
    with Progress(result.__name__, False if single else progress, queries=len(array)) as bar:
        done = work(kind, array, items, *options, bar.callback)
    if done < len(array):
        raise Interrupted(result(items[:done]))
    return out


class CertifiedResult(BatchResult):
    """Answers of the certified solver."""

    collides: Booleans = column("The verdicts, always right.")
    toi_lower: Doubles = column("Below the time of impact, or both are 0; NaN without a collision.")
    toi_upper: Doubles = column("Not below the time of impact; NaN without a collision.")
    u: Doubles = column("The first parameter of the contact, without a bound; NaN without a collision.")
    v: Doubles = column("The second parameter of the contact, without a bound; NaN without a collision.")
    exact: Booleans = column("True if the last stage decided, in exact arithmetic.")


class Verdict(IntEnum):
    """The answer of a method."""

    NO = 0
    YES = 1
    UNDECIDED = 2
    ERROR = 3


class Answers(BatchResult):
    """Answers of a method by name."""

    @property
    def collides(self) -> Booleans:
        """True for yes and for undecided: what is to be taken for a collision."""
        return np.isin(self.verdict, (Verdict.YES, Verdict.UNDECIDED))[()]

    verdict: npt.NDArray[np.uint8] = column("The verdicts: see `Verdict`.")
    toi_lower: Doubles = column("Claimed not to be above the time of impact; NaN where the method has none.")
    toi_upper: Doubles = column("Claimed not to be below the time of impact; NaN where the method has none.")
    tolerance: Doubles = column("The claimed bound of the distance beyond contact; NaN where the method has none.")
    checks: npt.NDArray[np.uint32] = column("The number of steps that the method counts.")


def _not_in_the_former_order(function: Function) -> Function:
    """Refuse solve(method, kind, queries), which it was up to version 0.4, and name what it is now."""

    @functools.wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        if len(arguments) > 2:
            raise TypeError("solve(method, kind, queries) has become solve(kind, queries, method=...)")
        return function(*arguments, **options)

    return cast(Function, call)


@overload
def solve(
    kind: ContactName,
    queries: npt.ArrayLike,
    *,
    separation: float = ...,
    norm: Norm = ...,
    t_max: float = ...,
    toi_tolerance: float | None = ...,
    threads: int = ...,
    progress: bool | None = ...,
    out: CertifiedResult | None = ...,
) -> CertifiedResult: ...
@overload
def solve(
    kind: AnyName,
    queries: npt.ArrayLike,
    *,
    method: str,
    separation: float = ...,
    norm: Norm = ...,
    t_max: float = ...,
    tolerance: float | None = ...,
    max_checks: int | None = ...,
    threads: int = ...,
    progress: bool | None = ...,
    out: Answers | None = ...,
) -> Answers: ...
@_not_in_the_former_order
@checked
def solve(
    kind: AnyName,
    queries: npt.ArrayLike,
    *,
    method: str | None = None,
    separation: float = 0.0,
    norm: Norm = "l2",
    t_max: float = 1.0,
    toi_tolerance: float | None = None,
    tolerance: float | None = None,
    max_checks: int | None = None,
    threads: int = 0,
    progress: bool | None = None,
    out: Any = None,
) -> CertifiedResult | Answers:
    """Decide queries with the certified solver: exact verdicts, enclosed times of impact.

    Or with any method by its name, such as the published ones with their errors; it is asked all queries, also those
    outside of its terms.

    Parameters
    ----------
    kind : {"vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"}
        The primitives of all queries. With a `method` that answers them also "tetrahedron" or
        "plane_triangle": such a cell "collides" if it inverts.
    queries : array_like of shape (N, 8, 3) or (8, 3)
        Four points at t=0, then at t=1: v, f0, f1, f2 or ea0, ea1, eb0, eb1; or v, e0, e1 or v, w, and
        points without an effect, NaN too. Used without a copy if it is float64 and C-contiguous;
        anything else is converted, float32 exactly. Or of shape
        (N, k + 1, 4, 3) or (k + 1, 4, 3): control points of Bézier curves of degree k, 1 to 8, from
        t=0 to t=1; with 4 instead of 3 numbers, the last one a positive weight, rational curves.
    method : str, optional
        The name of one of `methods`; by default the certified solver.
    separation : float, optional
        The distance that counts as contact, in units of the coordinates.
    norm : {"linf", "l2"}, optional
        The norm of that distance.
    t_max : float, optional
        Only contacts up to this time count, in [0, 1].
    toi_tolerance : float, optional
        Without `method`: the maximum width of the enclosures of times, relative to their upper ends; by
        default 1e-12.
    tolerance : float, optional
        With `method`: of those that search down to one; by default 1e-6.
    max_checks : int, optional
        With `method`: of iterative ones, the maximum number of steps for a query; 0: no limit; by default
        1,000,000.
    threads : int, optional
        The maximum number of threads; 0: one for each core that the process may use. The results do not depend on it.
    progress : bool, optional
        Show a bar from the first second on; by default in terminals and notebooks.
    out : CertifiedResult or Answers, optional
        The result of an earlier call for as many queries: it is overwritten and returned. This saves
        the time of new memory, a fifth for large batches.

    Raises
    ------
    ValueError
        For a cell without `method`, another shape or type, a coordinate that is NaN or infinite, a weight that is not positive,
        options out of range or without effect, or an `out` of another function or number of queries; for an
        unknown method, with the names there are; for a separation, or curves, that it does not support.

    Examples
    --------
    A vertex that falls through a triangle:

    >>> import numpy as np, touchstone
    >>> start = [[0.25, 0.25, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> end = [[0.25, 0.25, -1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> query = np.array(start + end, dtype=float)
    >>> answer = touchstone.solve("vertex_face", query)
    >>> bool(answer.collides), answer.toi_lower <= 0.5 <= answer.toi_upper
    (True, True)
    >>> touchstone.solve("vertex_face", np.stack([query, query + 0.125])).collides
    array([ True,  True])

    The same vertex on a parabola that touches the triangle:

    >>> middle = [[0.25, 0.25, -1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> bool(touchstone.solve("vertex_face", [start, middle, start]).collides)
    True

    A method by name:

    >>> touchstone.Verdict(touchstone.solve("vertex_face", query, method="accd").verdict).name
    'YES'
    """
    if method is not None:
        if toi_tolerance is not None:
            raise ValueError("toi_tolerance is an option of the certified solver; a method by name has tolerance")
        module = load("_exact")
        limits = 1e-6 if tolerance is None else tolerance, 1_000_000 if max_checks is None else max_checks
        of_method = functools.partial(module.solve, method)
        layout = np.dtype(module.answer_layout())
        return run_batch(Answers, layout, progress, out, of_method, kind, queries, separation, norm, *limits, t_max, threads)
    as_contact(kind, "kind")
    if tolerance is not None or max_checks is not None:
        raise ValueError("tolerance and max_checks are options of a method by name; the certified solver has toi_tolerance")
    width = 1e-12 if toi_tolerance is None else toi_tolerance
    options = separation, norm, width, t_max, threads
    return run_batch(CertifiedResult, _certified_type, progress, out, _fast.certified, kind, queries, *options)


class Inversions(BatchResult):
    """Answers about cells."""

    inverts: Booleans = column("The verdicts, always right.")
    is_exact: Booleans = column("True if integers decided.")
    start: npt.NDArray[np.int8] = column("The signs of the volumes at t=0: 1, 0 (flat) or -1 (inverted).")
    toi_lower: Doubles = column("Below the first time; both are 0 unless `start` is 1; NaN without an inversion.")
    toi_upper: Doubles = column("Not below the first time; NaN without an inversion.")


@checked
def inversions(
    kind: CellName,
    cells: npt.ArrayLike,
    *,
    toi_tolerance: float = 1e-12,
    t_max: float = 1.0,
    threads: int = 0,
    progress: bool | None = None,
    out: Inversions | None = None,
) -> Inversions:
    """Decide whether and when the volumes of moving cells are 0 or negative: exact verdicts, enclosed first times.

    Parameters
    ----------
    kind : {"tetrahedron", "plane_triangle"}
        The cells, whose volumes and areas are those of `Step`.
    cells : array_like of shape (N, 8, 3) or (8, 3)
        Four points at t=0, then at t=1, on straight lines. The fourth one and z of a triangle have no effect, NaN too.
    toi_tolerance, t_max, threads, progress, out
        As for `solve`, and so are errors.

    Examples
    --------
    >>> import touchstone
    >>> base = [0, 0, 0], [1, 0, 0], [0, 1, 0]
    >>> answer = touchstone.inversions("tetrahedron", [*base, [0, 0, 1], *base, [0, 0, -1]])
    >>> bool(answer.inverts), answer.toi_lower <= 0.5 <= answer.toi_upper
    (True, True)
    """
    options = toi_tolerance, t_max, threads
    return run_batch(Inversions, _inversion_type, progress, out, _fast.inversions, kind, cells, *options)


class TightInclusionResult(BatchResult):
    """Answers of Tight-Inclusion."""

    collides: Booleans = column("False: certainly no contact. True: contact, or nearly so.")
    toi: Doubles = column("Not above the time of impact; NaN where `collides` is False.")
    tolerance: Doubles = column("The tolerance that was achieved; NaN where `collides` is False.")
    checks: npt.NDArray[np.int64] = column("The number of boxes examined.")


@checked
def tight_inclusion(
    kind: ContactName,
    queries: npt.ArrayLike,
    *,
    separation: float = 0.0,
    norm: Norm = "l2",
    tolerance: float = 1e-6,
    max_checks: int = 1_000_000,
    t_max: float = 1.0,
    threads: int = 0,
    progress: bool | None = None,
    out: TightInclusionResult | None = None,
) -> TightInclusionResult:
    """Decide queries with Tight-Inclusion: no collision is missed, some are reported too many.

    Parameters
    ----------
    kind, queries, separation, norm, t_max, threads, progress, out
        As for `solve`; of curves, those of degree 2 or 3. With ``norm="l2"`` the answers are conservative.
    tolerance : float, optional
        Boxes whose image is this small are not split, in units of the coordinates.
    max_checks : int, optional
        After this many boxes the answer is a conservative yes; 0: no limit.

    Raises
    ------
    ValueError
        As for `solve`, and for curves of another degree.

    Examples
    --------
    >>> import numpy as np, touchstone
    >>> query = np.zeros((8, 3))
    >>> query[1:4] = query[5:8] = np.eye(3)
    >>> answer = touchstone.tight_inclusion("vertex_face", query)
    >>> bool(answer.collides), int(answer.checks)
    (False, 7)
    """
    options = separation, norm, tolerance, max_checks, t_max, threads
    work = _fast.tight_inclusion
    return run_batch(TightInclusionResult, _tight_inclusion_type, progress, out, work, kind, queries, *options)


class DistanceResult(BatchResult):
    """Distances, each enclosed by doubles that are equal or neighbours."""

    lower: Doubles = column("Not above the distances.")
    upper: Doubles = column("Not below the distances.")


@checked
def distance(
    kind: ContactName,
    queries: npt.ArrayLike,
    *,
    t: float = 0.0,
    norm: Norm = "l2",
    threads: int = 0,
    progress: bool | None = None,
    out: DistanceResult | None = None,
) -> DistanceResult:
    """Enclose the distances of the queries' primitives at a time.

    Parameters
    ----------
    kind, queries, threads, progress, out
        As for `solve`; straight lines alone.
    t : float, optional
        The time, in [0, 1].
    norm : {"linf", "l2"}, optional
        The norm of the distances.

    Raises
    ------
    ValueError
        As for `solve`, and for a time outside [0, 1].

    Examples
    --------
    >>> import numpy as np, touchstone
    >>> query = np.zeros((8, 3))
    >>> query[1:4] = query[5:8] = np.eye(3)
    >>> touchstone.distance("vertex_face", query, norm="linf")
    DistanceResult(lower=0.3333333333333333, upper=0.33333333333333337)
    """
    options = t, norm, threads
    return run_batch(DistanceResult, _distance_type, progress, out, _fast.distance, kind, queries, *options, curves=False)
