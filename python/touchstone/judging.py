"""Judging of solvers: ground truth for any callable, the search for wrong answers, and data."""

from __future__ import annotations

import html
import inspect
import json
import os
import pathlib
import pickle
import sys
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Callable, Dict, List, Literal, Sequence, Union

import numpy as np
import numpy.typing as npt

from ._input import Booleans, Doubles, Interrupted, Kind, Norm, as_queries, checked, html_table, interruptible, load
from ._tool import FOLDER, Run

Promise = Literal["conservative", "exact"]
Solver = Union[str, Callable[..., Any]]
PathLike = Union[str, "os.PathLike[str]"]


# ---- Queries --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Queries:
    """Queries of one kind with their recorded verdicts.

    Attributes
    ----------
    kind : {"vertex_face", "edge_edge", "tetrahedron", "plane_triangle"}
        The primitives, or the cell, which "collides" if it inverts.
    queries : ndarray of shape (N, 8, 3), or (N, degree + 1, 4, 3 or 4) on curves
        Four points at t=0, then at t=1.
    collides : ndarray of bool, shape (N,), or None
        The recorded verdicts, if there are any.
    name : str
        The file or the family that they are from.
    toi : dict of int to Fraction
        The recorded times of impact, by the number of the query.
    """

    kind: Kind
    queries: Doubles
    collides: Booleans | None = None
    name: str = "queries"
    toi: Dict[int, Fraction] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of queries."""
        return len(self.queries)

    def __repr__(self) -> str:
        text = f"Queries({self.name!r}: {len(self)} {self.kind}"
        if self.collides is not None:
            text += f", {np.count_nonzero(self.collides)} collide"
        return text + ")"


#: What the command line calls arguments of `read`.
_ARGUMENTS = (
    ("pass --kind vertex-face or --kind edge-edge", "give it by kind="),
    ("pass --kind", "give it by kind="),
    ("--round takes", "round=True takes"),
)


def _in_our_words(call: Callable[[], Any]) -> Any:
    try:
        return call()
    except ValueError as error:
        text = str(error)
        for theirs, ours in _ARGUMENTS:
            text = text.replace(theirs, ours)
        raise ValueError(text) from None


@checked
def read(path: PathLike, *, kind: Kind | None = None, round: bool = False) -> Queries:
    """Read a dataset as the command line tool does: .csv, .csv.zst, .npy or .npz.

    Parameters
    ----------
    path : path
        The file.
    kind : {"vertex_face", "edge_edge"}, optional
        The primitives; by default the path says them.
    round : bool, optional
        Round coordinates that are no doubles, instead of an error.

    Raises
    ------
    ValueError
        Naming file, line and reason.
    """
    os.stat(path)
    module = load("_data")
    found = interruptible(lambda: _in_our_words(lambda: module.read(os.fsencode(path), kind, round)))
    return _queries_from(found, str(path))


def _queries_from(found: Any, name: str) -> Queries:
    kind, queries, labels, times = found
    toi = {query: Fraction(*time) for query, time in times}
    return Queries(kind, queries, None if labels is None else labels.astype(bool), name, toi)


def write(path: PathLike, queries: Queries) -> None:
    """Write a dataset that `read` and the command line read: .csv with labels, or .npy without.

    Times of impact are not written.

    Raises
    ------
    ValueError
        For another ending of the name, a number that is not finite, a weight that is not positive,
        a number of labels that is not that of the queries, or a path that says another kind.
    """
    module = load("_data")
    if _in_our_words(lambda: module.kind_of(os.fsencode(path))) != queries.kind:
        raise ValueError(f"{path}: the path says another kind than {queries.kind}")
    _write(path, queries)


def _write(path: PathLike, queries: Queries) -> None:
    array, _ = as_queries(queries.queries, curves=True)
    labels = None if queries.collides is None else np.ascontiguousarray(queries.collides, dtype=bool)
    load("_data").write(os.fsencode(path), queries.kind, array, labels)


def families() -> List[str]:
    """Return the names of the families of the built-in set, about contact, on curves and about inversion.
    """
    return list(load("_data").families())


@checked
def generate(
    kind: Kind,
    *,
    family: str | None = None,
    count: int = 100,
    seed: int = 2021,
    separation: float = 0.0,
    norm: Norm = "l2",
) -> List[Queries]:
    """Return queries of the built-in set, whose truth is known by construction.

    Parameters
    ----------
    kind : {"vertex_face", "edge_edge", "tetrahedron", "plane_triangle"}
        The primitives, or the cell, which "collides" if it inverts.
    family : str, optional
        The name of one of `families`; by default all.
    count : int, optional
        The number of queries of each family.
    seed : int, optional
        The same seed gives the same queries on every machine.
    separation, norm : optional
        The distance that counts as contact. With one there are families more, with contact at exactly
        that distance; the truth of the others is not recorded then.

    Returns
    -------
    list of Queries
        One for each family that has this kind, with verdicts and rational times of impact.

    Raises
    ------
    ValueError
        For an unknown family, a negative number, or a separation of cells.
    """
    if min(count, seed) < 0:
        raise ValueError("count and seed must not be negative")
    found = interruptible(lambda: load("_data").generate(kind, family, seed, count, separation, norm))
    return [_queries_from(one, name) for name, one in found]


# ---- Solvers --------------------------------------------------------------------------------------


def _options_of(solver: Callable[..., Any]) -> List[str]:
    """Return the options that a callable takes."""
    known = ["separation", "norm", "tolerance", "max_checks", "t_max"]
    try:
        parameters = inspect.signature(solver).parameters.values()
    except (TypeError, ValueError):
        return []
    if any(one.kind is one.VAR_KEYWORD for one in parameters):
        return known
    return [name for name in known if any(name == one.name for one in parameters)]


def _solver_arguments(run: Run, solver: Solver, name: str | None, promise: Promise, batch: bool) -> List[Any]:
    """Return the arguments of the command line for a solver, for which its file is written.

    Raises
    ------
    ValueError
        If the solver cannot be sent to another process.
    """
    exact = ["--exact"] if promise == "exact" else []
    if isinstance(solver, str):
        return ["--method", solver, *exact]
    pickler: Any = pickle
    try:
        import cloudpickle as pickler  # type: ignore[import,no-redef]
    except ImportError:
        pass  # functions of modules alone
    try:
        program = pickler.dumps({"function": solver, "batch": batch, "options": _options_of(solver)})
    except Exception as error:
        raise ValueError(
            f"the solver cannot be sent to another process ({error}); define it in a module, or install"
            " cloudpickle (Debian: python3-cloudpickle)"
        ) from error
    if getattr(solver, "__module__", "") == "__main__" and pickler is pickle:
        raise ValueError(
            "the solver is defined in a script or a notebook, from where it cannot be sent to another"
            " process: install cloudpickle (Debian: python3-cloudpickle), or define it in a module"
        )
    file = run.folder / "solver.pickle"
    file.write_bytes(pickle.dumps(([os.path.abspath(one) for one in sys.path], program)))
    run.environment.update(
        TOUCHSTONE_PYTHON=sys.executable,
        TOUCHSTONE_PYTHON_SOLVER=str(file),
        TOUCHSTONE_PYTHON_NAME=name or str(getattr(solver, "__name__", type(solver).__name__)),
        TOUCHSTONE_PYTHON_SCRIPT=str(pathlib.Path(__file__).parent / "_child.py"),
    )
    return ["--plugin", FOLDER / "python_solver.so", "--allow-processes", *exact]


def _common_arguments(
    separation: float | None, norm: Norm, tolerance: float, max_checks: int, query_limit: float, memory_limit: float
) -> List[Any]:
    arguments = ["--tolerance", tolerance, "--max-checks", max_checks, "--query-limit", query_limit]
    arguments += ["--memory-limit", memory_limit]
    if separation is not None:
        arguments += ["--min-separation", separation.hex()]
    # Without one it is that of the data, whose norm is recorded; of contact, the norm of tolerances.
    return arguments if separation is None and norm == "l2" else [*arguments, "--norm", norm]


# ---- Judge ----------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class WrongAnswer:
    """An answer that breaks the promise of its solver.

    Attributes
    ----------
    source : str
        The file or the family of the query.
    index : int
        Its number there.
    kind : {"vertex_face", "edge_edge"}
        The primitives.
    fault : str
        The fault, such as "false_negative".
    answer, truth : str
        The answer and the truth, in words.
    """

    source: str
    index: int
    kind: Kind
    fault: str
    answer: str
    truth: str


@dataclass(frozen=True, eq=False)
class Judgement:
    """The judgement on a solver; its string is the table of `touchstone certify`.

    Attributes
    ----------
    wrong : list of WrongAnswer
        The answers that break the promise, the first thousand of each fault and source.
    """

    wrong: List[WrongAnswer]
    _data: Dict[str, Any] = field(repr=False)
    _text: str = field(repr=False)

    @property
    def method(self) -> Dict[str, Any]:
        """The counts of all faults, and the errors of times, by name."""
        return {**self._data["methods"][0]}

    @property
    def queries(self) -> int:
        """The number of queries."""
        return int(self._data["queries"])

    def count(self, fault: str) -> int:
        """Return the number of answers with a fault, such as "false_negatives"."""
        return int(self._data["methods"][0][fault])

    def to_dict(self) -> Dict[str, Any]:
        """Return everything, as ``touchstone certify --json`` writes it."""
        return self._data

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        name = self._data["methods"][0]["name"]
        return f"Judgement of {name}: {self.queries} queries, {len(self.wrong)} wrong answers"

    def _repr_html_(self) -> str:
        """Return tables for notebooks."""
        counts = [(k, v) for k, v in self.method.items() if isinstance(v, (int, str)) and k != "name"]
        first = [(w.source, w.index, w.kind, w.fault, w.answer, w.truth) for w in self.wrong[:10]]
        head = ["source", "query", "kind", "fault", "answer", "truth"]
        text = f"<p>{html.escape(repr(self))}</p>" + html_table(["fault", "answers"], counts)
        return text + (html_table(head, first) if first else "")


Data = Union[PathLike, Queries, Sequence[Queries], None]


def _write_data(run: Run, data: Data) -> List[Any]:
    """Return the paths of data for the command line, after writing what is in memory."""
    if data is None:
        return []
    if isinstance(data, (str, os.PathLike)):
        return [data]
    sets = [data] if isinstance(data, Queries) else list(data)
    if not sets:
        raise ValueError("data: there are no queries")
    paths = []
    for i, one in enumerate(sets):
        folder = run.folder / str(i) / one.kind.replace("_", "-")
        folder.mkdir(parents=True)
        # The file's name is that of the source in the report.
        name = "".join(c if c.isalnum() or c in "-_" else "_" for c in pathlib.Path(one.name).stem)
        paths.append(folder / f"{name}.{'npy' if one.collides is None else 'csv'}")
        _write(paths[-1], one)
    return paths


@checked
def judge(
    solver: Solver,
    data: Data = None,
    *,
    kind: Kind | None = None,
    batch: bool = False,
    name: str | None = None,
    promise: Promise = "conservative",
    separation: float | None = None,
    norm: Norm = "l2",
    tolerance: float = 1e-6,
    max_checks: int = 100_000,
    query_limit: float = 10.0,
    memory_limit: float = 4.0,
    count: int = 100,
    seed: int = 2021,
    threads: int = 0,
    progress: bool | None = None,
) -> Judgement:
    """Judge a solver by the exact truth.

    Parameters
    ----------
    solver : callable or str
        A function ``solver(kind, query)`` of an array of shape (8, 3). It returns a bool, a time (a
        float; None or NaN: no collision), or both as a tuple; a time claims not to be above the time
        of impact. Parameters called separation, norm, tolerance, max_checks and t_max are given to
        it. Or the name of one of `methods`. A callable runs in interpreters of its own: a crash, an
        exception or a hang costs one query.
    data : path, Queries or list of Queries, optional
        The queries: a file or a folder of datasets, or arrays; by default the built-in set. Those on
        curves are asked of methods by name; a callable takes straight lines alone.
    kind : {"vertex_face", "edge_edge", "tetrahedron", "plane_triangle"}, optional
        That of the built-in set, by default both about contact; or of files whose path does not tell.
        A cell "collides" if it inverts; its queries have the shape (N, 8, 3), too, and of a
        triangle in the plane x and y of the first three points count.
    batch : bool, optional
        True if the solver takes arrays of shape (N, 8, 3) and returns arrays of shape (N,). N grows from
        1 to 512 as the solver proves to be fast; after a failure its queries are asked with N=1.
    name : str, optional
        The name of the solver in the report: at most 100 bytes, and not that of one of `methods`.
    promise : {"conservative", "exact"}, optional
        With "exact" false positives are wrong answers, too.
    separation : float, optional
        The distance that counts as contact; by default that of the data.
    norm : {"linf", "l2"}, optional
        Its norm, and that of tolerances that the solver claims.
    tolerance, max_checks : optional
        Passed on to the solver.
    query_limit : float, optional
        Seconds that a query may take, including the start of an interpreter.
    memory_limit : float, optional
        GiB that the solver's process may allocate.
    count, seed : int, optional
        Of the built-in set: queries of each family and kind, and its seed.
    threads : int, optional
        The number of processes; 0: one for each core that the process may use.
    progress : bool, optional
        Show a line from the first second on; by default in terminals and notebooks.

    Raises
    ------
    ValueError
        For bad data, naming file and line, a solver that cannot be sent to another process, or one that
        answers nothing.

    Examples
    --------
    >>> import touchstone
    >>> def never(kind, query):
    ...     return False
    >>> judgement = touchstone.judge(never, touchstone.generate("edge_edge", family="hourglass", count=3))
    >>> judgement.queries, judgement.count("false_negatives") == len(judgement.wrong) > 0
    (3, True)
    """
    with Run() as run:
        result = run.folder / "result.json"
        command = ["certify", *_write_data(run, data), "--json", result, "--threads", threads]
        command += [] if kind is None else ["--kind", kind.replace("_", "-")]
        if data is None:
            command += ["--count", count, "--seed", seed]
        command += _solver_arguments(run, solver, name, promise, batch)
        command += _common_arguments(separation, norm, tolerance, max_checks, query_limit, memory_limit)
        text, _, interrupted = run.call(command, show=progress)
        parsed = json.loads(result.read_text())
        text = text.replace(f"{run.folder}{os.sep}", "")
        wrong = [
            WrongAnswer(
                pathlib.Path(one["file"]).stem if str(run.folder) in one["file"] else one["file"],
                one["index"],
                one["kind"].replace("-", "_"),
                one["fault"].replace(" ", "_"),
                one["answer"],
                one["truth"],
            )
            for one in parsed["methods"][0]["wrong_answers"]
        ]
    judgement = Judgement(wrong, parsed, text)
    if interrupted:
        raise Interrupted(judgement)
    return judgement


# ---- Fuzz -----------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Finding:
    """A wrong answer that the search has found.

    Attributes
    ----------
    what : str
        The fault, such as "false_negative".
    kind : {"vertex_face", "edge_edge"}
        The primitives.
    query : ndarray of shape (8, 3), or (degree + 1, 4, 3 or 4) on curves
        The simplest query with this fault.
    collides : bool
        The truth.
    truth, detail : str
        The truth, and what is wrong, in words.
    certificate : bytes or None
        The proof of the truth, for `check`.
    """

    what: str
    kind: Kind
    query: Doubles
    collides: bool
    truth: str
    detail: str
    certificate: bytes | None


def _finding_from(data: Dict[str, Any]) -> Finding:
    certificate = data["certificate"]
    is_straight = data["degree"] == 1 and not data["rational"]
    shape = (8, 3) if is_straight else (data["degree"] + 1, 4, 4 if data["rational"] else 3)
    return Finding(
        data["what"],
        data["kind"].replace("-", "_"),
        np.array(data["numbers"], dtype=float).reshape(shape),
        data["collides"],
        data["truth"],
        data["detail"],
        None if certificate is None else certificate.encode(),
    )


@dataclass(frozen=True, eq=False)
class FuzzReport:
    """The result of a search; its string is the report of `touchstone fuzz`.

    Attributes
    ----------
    findings : list of Finding
        The plainest wrong answer of each group; empty if nothing was found.
    queries : int
        The number of queries that were asked and judged.
    """

    findings: List[Finding]
    queries: int
    _data: Dict[str, Any] = field(repr=False)
    _text: str = field(repr=False)

    def to_dict(self) -> Dict[str, Any]:
        """Return everything, as ``touchstone fuzz --json`` writes it."""
        return self._data

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"FuzzReport: {self.queries} queries, {len(self.findings)} groups of wrong answers"

    def _repr_html_(self) -> str:
        """Return a table for notebooks."""
        rows = [(one.what, one.kind, one.truth, one.detail) for one in self.findings]
        return f"<p>{html.escape(repr(self))}</p>" + html_table(["fault", "kind", "truth", "detail"], rows)


@checked
def fuzz(
    solver: Solver,
    *,
    seconds: float = 10.0,
    queries: int = 0,
    findings: int = 20,
    kind: Kind | None = None,
    degrees: Sequence[Union[int, str]] = (),
    only: Sequence[str] = (),
    batch: bool = False,
    name: str | None = None,
    promise: Promise = "conservative",
    seed: int = 2021,
    separation: float | None = None,
    norm: Norm = "l2",
    tolerance: float = 1e-6,
    max_checks: int = 100_000,
    query_limit: float = 10.0,
    memory_limit: float = 4.0,
    progress: bool | None = None,
) -> FuzzReport:
    """Search for queries that a solver answers wrongly.

    Parameters
    ----------
    solver, batch, name, promise, separation, norm, tolerance, max_checks, query_limit, memory_limit, progress
        As for `judge`.
    seconds : float, optional
        The time of the search; 0: no limit.
    queries : int, optional
        The number of queries to ask; 0: no limit.
    findings : int, optional
        Groups of findings after which the search ends; 0: never.
    kind : {"vertex_face", "edge_edge", "tetrahedron", "plane_triangle"}, optional
        Only queries of this kind; by default those about contact.
    degrees : list of int or "rational", optional
        The degrees of the curves that points move on, 1 (straight lines, the default) to 8, or
        rational ones, for a method by name that answers them.
    only : list of str, optional
        Only these faults, such as "false_negative".
    seed : int, optional
        The same seed and number of queries give the same findings.

    Raises
    ------
    ValueError
        For options out of range, or a solver that cannot be sent to another process.

    Examples
    --------
    >>> import touchstone
    >>> def never(kind, query):
    ...     return False
    >>> report = touchstone.fuzz(never, findings=1, only=["false_negative"])
    >>> report.findings[0].what, bool(touchstone.check(report.findings[0].certificate))
    ('false_negative', True)
    """
    with Run() as run:
        result = run.folder / "result.json"
        command = ["fuzz", "--json", result, "--seed", seed, "--most-findings", findings]
        command += ["--seconds", seconds] if seconds else []
        command += ["--queries", queries] if queries else []
        command += [] if kind is None else ["--kind", kind.replace("_", "-")]
        command += [word for degree in degrees for word in ("--degree", degree)]
        command += [word for fault in only for word in ("--only", fault)]
        command += _solver_arguments(run, solver, name, promise, batch)
        command += _common_arguments(separation, norm, tolerance, max_checks, query_limit, memory_limit)
        text, _, interrupted = run.call(command, seconds=seconds, show=progress)
        data = json.loads(result.read_text())
    best = [data["findings"][group["best"]] for group in data["groups"]]
    report = FuzzReport([_finding_from(one) for one in best], data["queries"], data, text)
    if interrupted:
        raise Interrupted(report)
    return report


# ---- View -----------------------------------------------------------------------------------------


class View:
    """A page that shows queries: in a notebook by itself, elsewhere from a file."""

    def __init__(self, page: str) -> None:
        self.page = page

    def save(self, path: PathLike) -> None:
        """Write the page, which needs neither a network nor other files."""
        pathlib.Path(path).write_text(self.page, encoding="utf-8")

    def _repr_html_(self) -> str:
        """Return the page as a frame, for notebooks."""
        page = html.escape(self.page)
        return f'<iframe srcdoc="{page}" width="100%" height="700" style="border: 0"></iframe>'


@checked
def view(
    query: npt.ArrayLike | Finding | Queries,
    kind: Kind | None = None,
    *,
    separation: float | None = None,
    norm: Norm = "l2",
    methods: Sequence[str] = (),
) -> View:
    """Show queries in an interactive page, with the truth, its proof and the answers of methods.

    Parameters
    ----------
    query : array_like as for `solve`, Finding or Queries
        What to show; of many the first hundred.
    kind : {"vertex_face", "edge_edge"}, optional
        The primitives of an array.
    separation, norm : optional
        What counts as contact.
    methods : list of str, optional
        The names of `methods` to ask.

    Raises
    ------
    ValueError
        For an array without a kind, or as for `solve`.
    """
    if isinstance(query, Finding):
        query = Queries(query.kind, query.query[np.newaxis], None, query.what)
    if not isinstance(query, Queries):
        if kind is None:
            raise ValueError("view: name the kind of an array: kind='vertex_face' or 'edge_edge'")
        query = Queries(kind, as_queries(query, curves=True)[0])
    with Run() as run:
        page = run.folder / "page.html"
        command = ["view", *_write_data(run, query), "--out", page]
        command += [word for method in methods for word in ("--method", method)]
        if separation is not None:
            command += ["--min-separation", separation.hex(), "--norm", norm]
        run.call(command)
        return View(page.read_text(encoding="utf-8"))
