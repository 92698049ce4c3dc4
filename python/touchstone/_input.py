"""Arguments as the extension modules take them, and the base of all results."""

from __future__ import annotations

import functools
import html
import importlib
import numbers
import operator
import reprlib
from decimal import Decimal
from types import ModuleType
from typing import Any, Callable, Dict, Iterable, Literal, Sequence, Tuple, TypeVar, cast, get_args

import numpy as np
import numpy.typing as npt

ContactName = Literal["vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"]
CellName = Literal["tetrahedron", "plane_triangle"]
AnyName = Literal[ContactName, CellName]
#: Of data sets and of solvers under test.
Kind = Literal["vertex_face", "edge_edge", CellName]
Norm = Literal["linf", "l2"]
Doubles = npt.NDArray[np.float64]
Booleans = npt.NDArray[np.bool_]


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during long work.

    Attributes
    ----------
    result : object
        What was done until then: of a batch the results of its first queries, else as the
        function says; None if there is nothing.
    """

    def __init__(self, result: Any = None) -> None:
        done = f" after {len(result)} queries" if isinstance(result, BatchResult) else ""
        super().__init__(f"interrupted{done}; what is done is in .result of this exception")
        self.result = result


def interruptible(work: Callable[[], Any]) -> Any:
    """Return what work returns; Ctrl-C ends it by `Interrupted`."""
    try:
        return work()
    except KeyboardInterrupt as interrupt:
        raise Interrupted() from interrupt


def _wrong_type(reason: str, value: Any) -> TypeError:
    return TypeError(f"{reason}, not {reprlib.repr(value)} of type {type(value).__name__}")


def as_number(value: Any, name: str) -> float:
    """Return the double that a real number is.

    Raises
    ------
    TypeError
        For anything else.
    ValueError
        For a number that is no double.
    """
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, float):
        return value
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (numbers.Real, Decimal)):
        raise _wrong_type(f"{name}: a real number is needed", value)
    exact = int(value) if isinstance(value, numbers.Integral) else value
    try:
        double = float(exact)
    except OverflowError:
        raise ValueError(f"{name}: {reprlib.repr(value)} is beyond the range of doubles") from None
    if double != exact and exact == exact:
        raise ValueError(
            f"{name}: {reprlib.repr(value)} is not a double; pass float(…), the nearest one is {double!r}"
        )
    return double


def _as_whole_number(value: Any, name: str) -> int:
    try:
        return operator.index(value)
    except TypeError:
        raise _wrong_type(f"{name}: a whole number is needed", value) from None


def _as_flag(value: Any, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise _wrong_type(f"{name}: True or False is needed", value)
    return bool(value)


def _as_one_of(words: Any, others: Any = None, hint: str = "") -> Callable[[Any, str], str]:
    def as_word(value: Any, name: str) -> str:
        choices = " or ".join(map(repr, get_args(words)))
        if not isinstance(value, str):
            raise _wrong_type(f"{name} must be {choices}", value)
        if value not in get_args(words):
            of_others = hint if value in get_args(others) else ""
            raise ValueError(f"{name} must be {choices}, not {reprlib.repr(value)}{of_others}")
        return str(value)

    return as_word


as_contact = _as_one_of(ContactName, CellName, ", a cell: call inversions, or first_inversions for exact times")
#: By annotations, which are texts.
_CONVERSIONS: Dict[str, Callable[[Any, str], Any]] = {
    "float": as_number,
    "int": _as_whole_number,
    "bool": _as_flag,
    "ContactName": as_contact,
    "CellName": _as_one_of(CellName, ContactName, ", a contact: call solve, or decide for exact times"),
    "AnyName": _as_one_of(AnyName),
    "Kind": _as_one_of(Kind),
    "Norm": _as_one_of(Norm),
}
Function = TypeVar("Function", bound=Callable[..., Any])


def checked(function: Function) -> Function:
    """Convert a function's numbers, flags and words by their annotations, or refuse them by name."""
    code = function.__code__
    places = code.co_varnames[: code.co_argcount]
    conversions = {}
    for name, annotation in function.__annotations__.items():
        conversion = _CONVERSIONS.get(annotation.split(" | None")[0])
        if conversion is not None:
            conversions[name] = conversion, annotation.endswith(" | None")

    def converted(name: str, value: Any) -> Any:
        if name not in conversions or (value is None and conversions[name][1]):
            return value
        return conversions[name][0](value, name)

    @functools.wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        given = [converted(name, value) for name, value in zip(places, arguments)]
        return function(
            *given,
            *arguments[len(places) :],
            **{name: converted(name, value) for name, value in options.items()},
        )

    return cast(Function, call)


def as_array(values: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    """Return the array that NumPy makes of values.

    Raises
    ------
    ValueError
        If values are masked, or no array.
    """
    parts = values if isinstance(values, (list, tuple)) else (values,)
    count = sum(np.count_nonzero(part.mask) for part in parts if isinstance(part, np.ma.MaskedArray))
    if count:
        raise ValueError(f"{name}: {count} values are masked; select what is to be used, or call filled(…)")
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name}: no array of numbers: {error}") from None


def as_doubles(values: npt.ArrayLike, name: str) -> Doubles:
    """Return an array of float64 in C's order: the same memory where it is one already.

    Raises
    ------
    ValueError
        For another type than numbers, and for a number that is not a double.
    """
    array = as_array(values, name)
    if array.dtype == np.float64 and array.flags.c_contiguous and array.flags.aligned:
        return array
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: an array of real numbers is needed, not of {array.dtype}")
    with np.errstate(over="ignore"):
        doubles: Doubles = np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)
    if array.dtype.itemsize > 4 and array.dtype != np.float64:
        exact = doubles.astype(np.longdouble) == array.astype(np.longdouble)
        changed = ~(exact | np.isnan(doubles)) | (np.isinf(doubles) & np.isfinite(array))
        if changed.any():
            place = [int(i) for i in np.argwhere(changed)[0]]
            raise ValueError(
                f"{name}{place}: {array[tuple(place)]} of {array.dtype} is not a double; round it first"
            )
    return doubles


def as_queries(values: npt.ArrayLike, curves: bool = False) -> Tuple[Doubles, bool]:
    """Return queries of shape (N, 8, 3), and whether it is a single query of shape (8, 3).

    With `curves` also of shape (N, k + 1, 4, 3) or (N, k + 1, 4, 4), and a single one without N.
    """
    array = as_doubles(values, "queries")
    if array.shape == (8, 3):
        return array.reshape(1, 8, 3), True
    if array.ndim == 3 and array.shape[1:] == (8, 3):
        return array, False
    if curves and array.shape[-2:] in ((4, 3), (4, 4)) and array.ndim in (3, 4) and array.shape[-3] > 0:
        return (array.reshape(1, *array.shape), True) if array.ndim == 3 else (array, False)
    others = ", on curves (N, k + 1, 4, 3) or (N, k + 1, 4, 4)" if curves else ""
    raise ValueError(f"queries must have the shape (N, 8, 3) or (8, 3){others}, not {array.shape}")


def as_vertices(values: npt.ArrayLike, name: str) -> Doubles:
    """Return positions of vertices of shape (n, 3)."""
    array = as_doubles(values, name)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} must have the shape (n, 3), not {array.shape}")
    return array


def as_motion(before: npt.ArrayLike, after: npt.ArrayLike | None) -> Tuple[Doubles, Doubles]:
    """Return places at both ends, of shape (n, 3); or, without `after`, control points, twice."""
    if after is not None:
        return as_vertices(before, "before"), as_vertices(after, "after")
    points = as_doubles(before, "before")
    if points.ndim != 3 or points.shape[2] not in (3, 4) or points.shape[1] < 2:
        raise ValueError(f"control points must have the shape (n, degree + 1, 3 or 4), not {points.shape}")
    return points, points


def as_indices(values: npt.ArrayLike | None, name: str, columns: int | None) -> npt.NDArray[np.int32]:
    """Return indices of shape (n, columns), or (n,) without columns, as int32; None: no indices."""
    array = as_array([] if values is None else values, name)
    shape = (0,) if columns is None else (0, columns)
    if array.size == 0:
        return np.empty(shape, dtype=np.int32)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: an array of integers is needed, not of {array.dtype}")
    if array.ndim != len(shape) or array.shape[1:] != shape[1:]:
        text = "(n,)" if columns is None else f"(n, {columns})"
        raise ValueError(f"{name} must have the shape {text}, not {array.shape}")
    outside = (array < 0) | (array > np.iinfo(np.int32).max)
    if outside.any():
        place = [int(i) for i in np.argwhere(outside)[0]]
        raise IndexError(f"{name}{place}: {array[tuple(place)]} is not in [0, 2^31-1]")
    return np.ascontiguousarray(array, dtype=np.int32)


def load(name: str) -> ModuleType:
    """Return an extension module that not every build has.
    """
    try:
        return importlib.import_module(f".{name}", __package__)
    except ImportError as error:
        raise ImportError(
            f"{error}\ntouchstone: this needs the module {name}. A package that pip builds has the fast"
            " part alone: for all of it use ./run python in the sources. If the error above names a"
            " library, install that: on Debian 12 libgmpxx4ldbl, libtbb12, libfmt9, libzip4, libzstd1."
        ) from error


def html_table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a table for notebooks."""
    cells = "".join(f"<th>{html.escape(name)}</th>" for name in head)
    body = "".join(
        "<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><tr>{cells}</tr>{body}</table>"


class Column(property):
    """A field of the array of a `BatchResult`, as an attribute of the field's name."""

    def __init__(self, doc: str) -> None:
        super().__init__(lambda result: result._field(self._name))
        self.__doc__ = doc  # that of a class derived from property would stand before its argument

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name


def column(doc: str) -> Any:
    """Return a `Column`, for a declaration that says the type of its values."""
    return Column(doc)


Result = TypeVar("Result", bound="BatchResult")


class BatchResult:
    """Results of queries: an item each in a structured array, and its fields as attributes.

    Of a single query the fields are scalars.

    Attributes
    ----------
    array : ndarray
        The structured array, which ``pandas.DataFrame`` takes as it is.
    """

    def __init__(self, array: npt.NDArray[np.void]) -> None:
        self.array = array

    def _field(self, name: str) -> Any:
        value = self.array[name]
        return value[()] if isinstance(value, np.ndarray) else value

    def _verdict(self) -> str:
        return (self.array.dtype.names or ("array",))[0]

    def __len__(self) -> int:
        """Return the number of queries, or cells."""
        return int(self.array.size)

    def __bool__(self) -> bool:
        """Refuse, because a result is not an answer.

        Raises
        ------
        TypeError
            Always.
        """
        raise TypeError(f"a {type(self).__name__} is neither true nor false: ask for its .{self._verdict()}")

    def __getitem__(self: Result, key: Any) -> Result:
        """Return the results of some queries, as NumPy selects them."""
        return type(self)(self.array[key])

    def to_dict(self) -> dict[str, Any]:
        """Return the fields by name, each an array, or a number for a single query."""
        return {name: self._field(name) for name in self.array.dtype.names or ()}

    def __repr__(self) -> str:
        if self.array.ndim == 0:
            fields = ", ".join(f"{name}={value}" for name, value in self.to_dict().items())
            return f"{type(self).__name__}({fields})"
        verdict = self._verdict()
        text = f"{type(self).__name__}: {len(self)} {'cells' if verdict == 'inverts' else 'queries'}"
        if verdict in ("collides", "inverts"):
            text += f", {np.count_nonzero(self.array[verdict])} {verdict[:-1]}"
        return text

    def _repr_html_(self) -> str:
        """Return a table of the first ten results, for notebooks."""
        names = self.array.dtype.names or ()
        rows = np.atleast_1d(self.array)[:10]
        return f"<p>{self!r}</p>" + html_table(["", *names], ([i, *row] for i, row in enumerate(rows)))
