"""The oracle, certificates, and the list of methods: what needs GMP."""

from __future__ import annotations

import reprlib
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Callable, Literal, Sequence, Tuple, Type, Union, cast

import numpy as np
import numpy.typing as npt

from ._input import AnyName, BatchResult, Booleans, CellName, ContactName, Doubles, Interrupted, Norm, Result
from ._input import as_doubles, as_queries, checked, column, interruptible, load
from ._tool import Progress


@dataclass(frozen=True)
class AlgebraicNumber:
    """A real root of an integer polynomial: exact, and as precise as asked.

    Attributes
    ----------
    polynomial : tuple of int
        The coefficients, the constant one first; all roots are simple.
    lower, upper : Fraction
        The number is the only root between them, and the polynomial is not 0 there.

    Examples
    --------
    >>> from fractions import Fraction
    >>> from touchstone import AlgebraicNumber
    >>> root = AlgebraicNumber((-1, 0, 2), Fraction(0), Fraction(1))
    >>> float(root)
    0.7071067811865476
    >>> root.refine(Fraction(1, 10)).lower
    Fraction(11, 16)
    """

    polynomial: Tuple[int, ...]
    lower: Fraction
    upper: Fraction

    def value_at(self, t: Fraction) -> Fraction:
        """Return the value of the polynomial at t."""
        value = Fraction(0)
        for coefficient in reversed(self.polynomial):
            value = value * t + coefficient
        return value

    def refine(self, width: Fraction) -> AlgebraicNumber:
        """Return the same number in an interval of at most this width."""
        lower, upper = self.lower, self.upper
        is_positive_below = self.value_at(lower) > 0
        while upper - lower > width:
            middle = (lower + upper) / 2
            value = self.value_at(middle)
            if value == 0:
                lower, upper = (lower + middle) / 2, (middle + upper) / 2
            elif (value > 0) == is_positive_below:
                lower = middle
            else:
                upper = middle
        return AlgebraicNumber(self.polynomial, lower, upper)

    def __float__(self) -> float:
        """Return a double next to the number."""
        number = self
        while float(number.lower) != float(number.upper):
            if np.nextafter(float(number.lower), 2.0) == float(number.upper):
                break
            number = number.refine((number.upper - number.lower) / 2)
        return float(number.refine((number.upper - number.lower) / 8).upper)

    def __repr__(self) -> str:
        return f"AlgebraicNumber({self.polynomial}, {float(self)!r})"


Time = Union[Fraction, AlgebraicNumber, None]


def _time_from(parts: Any) -> Time:
    if parts is None:
        return None
    if len(parts) == 2:
        return Fraction(*parts)
    polynomial, lower, upper = parts
    return AlgebraicNumber(polynomial, Fraction(*lower), Fraction(*upper))


class Decisions(BatchResult):
    """Verdicts of the oracle."""

    collides: Booleans = column("The verdicts.")
    toi_lower: Doubles = column("The greatest double that is not above the time of impact; NaN without a collision.")
    toi_upper: Doubles = column("The least double that is not below the time of impact; NaN without a collision.")
    toi: Any = column(
        "The exact times of impact: a Fraction, an `AlgebraicNumber`, or None without a collision; of a batch an"
        " array of these objects."
    )


class FirstInversions(BatchResult):
    """Verdicts of the oracle about cells."""

    inverts: Booleans = column("The verdicts.")
    toi_lower: Doubles = column("The greatest double that is not above the first time; NaN without an inversion.")
    toi_upper: Doubles = column("The least double that is not below the first time; NaN without an inversion.")
    toi: Any = column("The exact first times, 0 if the volume is not positive at t=0; as in `Decisions`.")


@dataclass(frozen=True, eq=False)
class Curve:
    """A Bézier curve on which one point of a query moves, of a degree of its own.

    Attributes
    ----------
    control : array_like of shape (k + 1, 3)
        The control points from t=0 to t=1, with k from 0 (at rest) to 8.
    weights : array_like of shape (k + 1,), optional
        Positive weights, for a rational curve.
    """

    control: npt.ArrayLike
    weights: npt.ArrayLike = ()

    def _numbers(self) -> tuple[list[list[float]], list[float]]:
        points = as_doubles(self.control, "curves")
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"the control points of a curve have the shape (k + 1, 3), not {points.shape}")
        weights = as_doubles(self.weights, "weights") if np.size(self.weights) else np.empty(0)
        return points.tolist(), weights.reshape(-1).tolist()


def _numbers_of(query: Any) -> list[Any]:
    if not isinstance(query, (list, tuple)) or not all(isinstance(one, Curve) for one in query):
        raise ValueError(f"a query of curves is a list of four touchstone.Curve, not {reprlib.repr(query)}")
    if len(query) != 4:
        raise ValueError(f"a query has four curves, not {len(query)}")
    return [one._numbers() for one in query]


def _is_of_curves(queries: Any) -> bool:
    return isinstance(queries, (list, tuple)) and any(isinstance(one, Curve) for one in queries)


ArrayOrCurves = Union[npt.ArrayLike, Sequence[Curve], Sequence[Sequence[Curve]]]


def _decided(result: Type[Result], progress: bool | None, kind: str, queries: ArrayOrCurves, *options: Any) -> Result:
    module = load("_exact")
    array: Any
    single = _is_of_curves(queries)
    of_curves = single or (isinstance(queries, (list, tuple)) and any(map(_is_of_curves, queries)))
    if of_curves:
        array = [_numbers_of(query) for query in cast(Any, [queries] if single else queries)]
    else:
        array, single = as_queries(cast(npt.ArrayLike, queries), curves=True)
    numbers = np.dtype(module.decision_layout("inverts" if result is FirstInversions else "collides"))
    items = np.empty(len(array), dtype=numbers)
    with Progress(result.__name__, progress, queries=len(array)) as bar:
        decide_all: Any = module.decide_curves if of_curves else module.decide
        times = decide_all(kind, array, items, *options, bar.callback)
    done = len(times)
    found = np.empty(done, dtype=[*((n, numbers[n]) for n in numbers.names or ()), ("toi", "O")])
    for name in numbers.names or ():
        found[name] = items[name][:done]
    for i, time in enumerate(times):
        found["toi"][i] = _time_from(time)
    if done < len(array):
        raise Interrupted(result(found))
    return result(found.reshape(()) if single else found)


@checked
def decide(
    kind: ContactName,
    queries: ArrayOrCurves,
    *,
    separation: float = 0.0,
    norm: Norm = "l2",
    threads: int = 0,
    progress: bool | None = None,
) -> Decisions:
    """Decide queries by the oracle, in integers: the ground truth.

    Parameters
    ----------
    kind, separation, norm, threads, progress
        As for `solve`.
    queries : array_like, list of four Curve, or list of such lists
        An array as for `solve`. Or the curves of the points of a query, or of each of many, in the order v,
        f0, f1, f2 or ea0, ea1, eb0, eb1, each of its own degree.

    Raises
    ------
    ValueError
        As for `solve`, or if a curve is not valid.

    Examples
    --------
    >>> import numpy as np, touchstone
    >>> start = [[0.25, 0.25, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> end = [[0.25, 0.25, -2], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> touchstone.decide("vertex_face", start + end).toi
    Fraction(1, 3)

    A vertex on a parabola that touches a resting triangle:

    >>> vertex = touchstone.Curve([[0.25, 0.25, 1], [0.25, 0.25, -1], [0.25, 0.25, 1]])
    >>> touchstone.decide("vertex_face", [vertex, *(touchstone.Curve([point]) for point in start[1:])]).toi
    Fraction(1, 2)
    """
    return _decided(Decisions, progress, kind, queries, separation, norm, threads)


@checked
def first_inversions(
    kind: CellName, cells: ArrayOrCurves, *, threads: int = 0, progress: bool | None = None
) -> FirstInversions:
    """Decide cells by the oracle, in integers: the ground truth.

    Parameters
    ----------
    kind, cells, threads, progress
        As for `inversions`, and on curves as for `decide`; so are errors.

    Examples
    --------
    >>> import touchstone
    >>> base = [0, 0, 0], [1, 0, 0], [0, 1, 0]
    >>> touchstone.first_inversions("tetrahedron", [*base, [0, 0, 1], *base, [0, 0, -2]]).toi
    Fraction(1, 3)
    """
    return _decided(FirstInversions, progress, kind, cells, 0.0, "l2", threads)


@checked
def prove(
    kind: AnyName,
    queries: npt.ArrayLike,
    *,
    separation: float = 0.0,
    norm: Norm = "l2",
    claim: Literal["time_of_impact", "collision"] = "time_of_impact",
    threads: int = 0,
    progress: bool | None = None,
) -> bytes:
    """Prove the oracle's verdicts, for a checker that shares no code with it.

    Parameters
    ----------
    kind, queries, separation, norm, threads, progress
        As for `solve`, or of cells as for `first_inversions`, without a separation.
    claim : {"time_of_impact", "collision"}, optional
        The claim about queries that collide, or cells that invert.

    Returns
    -------
    bytes
        A stream of one certificate for each query (exact/CERTIFICATES.md).

    Raises
    ------
    ValueError
        As for `solve`.
    RuntimeError
        If a certificate would exceed the limits of the format.

    Examples
    --------
    >>> import numpy as np, touchstone
    >>> query = np.zeros((8, 3))
    >>> query[1:4] = query[5:8] = np.eye(3)
    >>> touchstone.check(touchstone.prove("vertex_face", query))
    CheckReport: 1 accepted, 0 rejected
    """
    array, _ = as_queries(queries, curves=True)
    with Progress("prove", progress, queries=len(array)) as bar:
        done, stream = load("_exact").prove(kind, array, separation, norm, claim, threads, bar.callback)
    if done < len(array):
        raise Interrupted(stream)
    return bytes(stream)


@dataclass(frozen=True)
class Rejection:
    """The reason why a certificate was not accepted.

    Attributes
    ----------
    line : int
        The line at fault, from 1.
    label : str
        The certificate's label; may be empty.
    reason : str
        The reason.
    """

    line: int
    label: str
    reason: str


@dataclass(frozen=True)
class CheckReport:
    """The checker's report; true if all was accepted and the stream is complete.

    Attributes
    ----------
    no_collision, collision, time_of_impact : int
        The numbers of accepted certificates of queries, by their claims.
    no_inversion, inversion, time_of_inversion : int
        The same of tetrahedra.
    steps, meshes : tuple of str
        What accepted certificates of steps and of meshes at rest prove.
    summary : str
        What all of these prove together, such as "184 steps, each from where the last one ended: no two
        primitives touch"; empty if one is rejected or there is nothing to be said of all.
    rejected : int
        The number of rejected ones.
    rejections : tuple of Rejection
        The first of these.
    """

    no_collision: int
    collision: int
    time_of_impact: int
    no_inversion: int
    inversion: int
    time_of_inversion: int
    steps: Tuple[str, ...]
    meshes: Tuple[str, ...]
    summary: str
    rejected: int
    rejections: Tuple[Rejection, ...]

    @property
    def accepted(self) -> int:
        """The number of accepted certificates."""
        of_queries = self.no_collision + self.collision + self.time_of_impact
        of_cells = self.no_inversion + self.inversion + self.time_of_inversion
        return of_queries + of_cells + len(self.steps) + len(self.meshes)

    def __bool__(self) -> bool:
        """Return True if nothing was rejected."""
        return self.rejected == 0

    def __repr__(self) -> str:
        return f"CheckReport: {self.accepted} accepted, {self.rejected} rejected"


@checked
def check(
    certificates: bytes | str,
    *,
    scenes: bytes | str | None = None,
    claim: str | None = None,
    separation: float | None = None,
    norm: Norm = "l2",
    rules: str = "",
) -> CheckReport:
    """Check certificates by the checker, which shares no code with the oracle.

    Parameters
    ----------
    certificates : bytes or str
        A stream of certificates, as `prove`, `Step.prove` and the commands write it.
    scenes : bytes or str, optional
        The scenes that certificates of steps or of meshes have to be about.
    claim : str, optional
        Reject every other claim: "no_collision", "collision", "time_of_impact"; of tetrahedra
        "no_inversion", "inversion", "time_of_inversion"; of steps "free",
        "sequence" (free, and each begins where the last one ended), "no_contact T" or "earliest"; of
        meshes "free" or "intersections N".
    separation : float, optional
        Reject what is about another distance.
    norm : {"linf", "l2"}, optional
        The norm of that distance.
    rules : str, optional
        Reject whatever has other rules, which weaken a claim, than these, in the words of the report:
        "1 pair of groups held apart". Without it and without scenes "free" and "sequence" reject all.

    Raises
    ------
    ValueError
        If the claim is none.
    """
    distance = None if separation is None else separation.hex()
    report = interruptible(lambda: load("_exact").check(certificates, scenes, claim, distance, norm, rules))
    report["rejections"] = tuple(Rejection(*one) for one in report["rejections"])
    return CheckReport(**report)


@dataclass(frozen=True)
class Method:
    """A method that `solve` knows.

    Attributes
    ----------
    name : str
        Its name.
    promise : {"none", "conservative", "exact"}
        Its promise about its answers.
    reference : str
        The key of the work that describes it in docs/references.bib; may be empty.
    is_baseline : bool
        True for a published method, here for comparison, with its known errors.
    is_tolerance_driven : bool
        True if it searches down to a tolerance.
    norms : tuple of str
        The norms of the separations that it supports.
    """

    name: str
    promise: Literal["none", "conservative", "exact"]
    reference: str
    is_baseline: bool
    is_tolerance_driven: bool
    norms: Tuple[Norm, ...]


def methods() -> list[Method]:
    """Return all methods, ours first.

    Examples
    --------
    >>> import touchstone
    >>> [method.name for method in touchstone.methods()][:2]
    ['certified', 'tight_inclusion']
    """
    return [Method(*fields) for fields in load("_exact").methods()]
