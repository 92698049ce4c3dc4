"""Batches: the same answers in every form, zero-copy, and the reasons for errors."""

from __future__ import annotations

import functools
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import touchstone

KINDS = ["vertex_face", "edge_edge"]
BATCHES = {
    "certified": touchstone.solve,
    "tight_inclusion": touchstone.tight_inclusion,
    "distance": touchstone.distance,
}
each_batch = pytest.mark.parametrize("solve", BATCHES.values(), ids=BATCHES.keys())
each_kind = pytest.mark.parametrize("kind", KINDS)

def bits(result: touchstone.BatchResult) -> dict[str, bytes]:
    return {name: np.ascontiguousarray(field).tobytes() for name, field in result.to_dict().items()}


@each_batch
@each_kind
class TestForms:
    @pytest.mark.parametrize("threads", [1, 2, 3, 7])
    def test_threads_change_nothing(self, solve, kind, queries, threads):
        assert bits(solve(kind, queries, threads=threads)) == bits(solve(kind, queries))

    def test_one_query_is_a_batch_of_one(self, solve, kind, queries):
        for i in range(50):
            single, batch = solve(kind, queries[i]), solve(kind, queries[i : i + 1])
            assert bits(single) == bits(batch) == bits(solve(kind, queries[:50])[i])
            assert all(np.ndim(field) == 0 for field in single.to_dict().values())

    def test_no_query_is_legal(self, solve, kind):
        result = solve(kind, np.empty((0, 8, 3)))
        assert len(result) == 0
        assert all(field.shape == (0,) for field in result.to_dict().values())

    @pytest.mark.parametrize(
        "convert",
        [
            lambda q: q.astype(np.float32),
            lambda q: q.astype(np.float32).tolist(),
            lambda q: np.asfortranarray(q.astype(np.float32)),
            lambda q: q.astype(np.float32).astype(">f8"),
            lambda q: np.repeat(q.astype(np.float32), 2, axis=0)[::2],
            lambda q: q.astype(np.float32).astype(np.longdouble),
            lambda q: (1024 * q).astype(int),
        ],
    )
    def test_every_form_of_the_same_numbers(self, solve, kind, queries, convert):
        some = queries[:200]
        assert bits(solve(kind, convert(some))) == bits(solve(kind, np.array(convert(some), np.float64)))


def test_the_memory_of_an_array_is_used_without_a_copy(queries):
    from touchstone._input import as_queries

    assert as_queries(queries)[0] is queries
    assert np.shares_memory(as_queries(queries[3])[0], queries)
    queries.flags.writeable = False
    assert len(touchstone.solve("edge_edge", queries)) == len(queries)


def test_t_max_is_exact():
    query = np.zeros((8, 3))
    query[1:4] = query[5:8] = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    query[0], query[4] = [1, 1, 1], [1, 1, -1]
    assert touchstone.solve("vertex_face", query, t_max=0.5).collides
    assert not touchstone.solve("vertex_face", query, t_max=np.nextafter(0.5, 0)).collides
    assert touchstone.solve("vertex_face", query, t_max=0.5).exact and not touchstone.solve("vertex_face", query).exact


@each_batch
class TestErrors:
    @pytest.mark.parametrize(
        "bad, text",
        [
            (np.zeros((4, 24)), r"\(N, 8, 3\) or \(8, 3\).*, not \(4, 24\)"),
            (np.zeros(24), r"not \(24,\)"),
            (np.zeros((2, 3, 8)), r"not \(2, 3, 8\)"),
            (np.zeros((8, 3), dtype=complex), "not of complex128"),
            (np.full((8, 3), "a"), "not of <U1"),
            (np.full((2, 8, 3), 2**53 + 1), r"queries\[0, 0, 0\]: 9007199254740993 of int64"),
            (np.full((8, 3), np.longdouble(1) / 3), "is not a double; round it first"),
            (np.ma.array(np.zeros((8, 3)), mask=np.eye(8, 3)), "queries: 3 values are masked; select"),
            ([np.ma.array(np.zeros((8, 3)), mask=np.eye(8, 3))], "queries: 3 values are masked; select"),
            ([[0.0, 1.0], [2.0]], "queries: "),
        ],
    )
    def test_shapes_and_types(self, solve, bad, text):
        with pytest.raises(ValueError, match=text):
            solve("vertex_face", bad)

    @pytest.mark.parametrize("number, word", [(np.nan, "NaN"), (np.inf, "infinite"), (-np.inf, "infinite")])
    @pytest.mark.parametrize("place", [0, 2500, 3999])
    def test_the_index_of_what_is_not_finite(self, solve, queries, number, word, place):
        bad = queries.copy()
        bad[place, 5, 1] = number
        with pytest.raises(ValueError, match=rf"query {place}: coordinate \[5, 1\] is {word}"):
            solve("vertex_face", bad, threads=1)

    def test_a_result_is_no_answer(self, solve, queries):
        with pytest.raises(TypeError, match="neither true nor false"):
            bool(solve("vertex_face", queries[0]))


@pytest.mark.parametrize(
    "solve",
    [
        touchstone.solve,
        touchstone.tight_inclusion,
        touchstone.distance,
        lambda *queries, **out: touchstone.solve(*queries, method="certified", **out),
    ],
)
def test_out_is_overwritten_and_returned(solve, queries):
    for of, other in ((queries, -queries), (queries[3], queries[4])):
        expected, out = bits(solve("edge_edge", of)), solve("vertex_face", other)
        assert bits(out) != expected
        memory = out.array
        assert solve("edge_edge", of, out=out) is out
        assert out.array is memory and bits(out) == expected
        for bad in (out.array, out[()] if out.array.ndim == 0 else out[:7], touchstone.decide("edge_edge", of)):
            with pytest.raises(ValueError, match=f"out must be an earlier {type(out).__name__}"):
                solve("edge_edge", queries[:8], out=bad)
    with pytest.raises(ValueError, match="their own layout"):
        solve("edge_edge", queries[::2], out=solve("edge_edge", queries)[::2])


@pytest.mark.parametrize("count", [0, 1, 2])
@pytest.mark.parametrize(
    "solve, options, error, text",
    [
        *((one, {"kind": "face"}, ValueError, "'vertex_vertex'.*, not 'face'") for one in BATCHES.values()),
        *((one, {"norm": "l1"}, ValueError, "norm must be 'linf' or 'l2', not 'l1'") for one in BATCHES.values()),
        *((one, {"threads": -1}, ValueError, "threads must not be negative") for one in BATCHES.values()),
        (touchstone.solve, {"separation": -1.0}, ValueError, "separation must be a finite number"),
        (touchstone.solve, {"separation": np.nan}, ValueError, "separation must be a finite number"),
        (touchstone.solve, {"t_max": 2.0}, ValueError, "t_max"),
        (touchstone.inversions, {"kind": "tetrahedron", "t_max": 2.0}, ValueError, "t_max"),
        (touchstone.solve, {"toi_tolerance": -1.0}, ValueError, "toi_tolerance"),
        (touchstone.tight_inclusion, {"tolerance": 0.0}, ValueError, "tolerance"),
        (touchstone.tight_inclusion, {"t_max": -1.0}, ValueError, "t_max"),
        (touchstone.distance, {"t": 1.5}, ValueError, "time|t must"),
        (touchstone.solve, {"kind": 0}, TypeError, "or 'plane_triangle', not 0 of type int"),
        (touchstone.solve, {"threads": 1.5}, TypeError, "threads: a whole number is needed, not 1.5 of type float"),
        (touchstone.solve, {"progress": "no"}, TypeError, "progress: True or False is needed, not 'no' of type str"),
        (touchstone.solve, {"t_max": None}, TypeError, "t_max: a real number is needed, not None of type NoneType"),
    ],
)
def test_options_that_are_none(solve, options, error, text, count):
    kind, *rest = ({"kind": "edge_edge"} | options).items()
    with pytest.raises(error, match=text):
        solve(kind[1], np.zeros((count, 8, 3)), **dict(rest))


def test_numbers_of_other_types_are_taken_exactly(queries):
    plain = touchstone.solve("edge_edge", queries, separation=0.125, t_max=1.0, threads=1)
    for number in (Fraction(1, 8), Decimal("0.125"), np.float32(0.125), np.array(0.125), np.longdouble(0.125)):
        other = touchstone.solve(
            "edge_edge", queries, separation=number, t_max=np.int8(1), threads=np.uint8(1), progress=np.False_
        )
        assert bits(other) == bits(plain)
    free = np.ma.array(queries, mask=False)
    assert bits(touchstone.solve("edge_edge", free, separation=0.125)) == bits(plain)


@pytest.mark.parametrize("kind, heights", [("tetrahedron", (3, 2)), ("plane_triangle", (2, 1))])
def test_cells_whose_height_is_known(kind, heights):
    """A point moves from one height to another above the others, which rest; NaN has no effect."""
    times = {(1, -2): Fraction(1, 3), (1, 0): 1, (1, 0.5): None, (0, 1): 0, (-1, 2): 0, (3, -1): Fraction(3, 4)}
    cells = np.zeros((6, 2, 4, 3))
    cells[:, :, 1, 0] = cells[:, :, 2, 1] = 1
    if kind == "plane_triangle":
        cells[:, :, 3] = cells[..., 2] = np.nan
    cells[(..., *heights)] = list(times)
    lines = cells.reshape(-1, 8, 3)
    found = touchstone.inversions(kind, lines)
    assert found.start.tolist() == [1, 1, 1, 0, -1, 1] and repr(found) == "Inversions: 6 cells, 5 invert"
    for i, time in enumerate(times.values()):
        assert found.inverts[i] == (time is not None) and (time is None or found.toi_lower[i] <= time <= found.toi_upper[i])
        assert bits(touchstone.inversions(kind, lines[i])) == bits(found[i])
    assert touchstone.solve(kind, lines, method="certified").collides.tolist() == found.inverts.tolist()
    for t_max in (0.75, np.nextafter(0.75, 0)):
        assert touchstone.inversions(kind, lines[5], t_max=t_max).inverts == (t_max == 0.75)
    parabolas = np.stack([cells[:, 0], cells.mean(axis=1), cells[:, 1]], axis=1)
    for queries in (lines, parabolas, [[touchstone.Curve(cell[:, point]) for point in range(4)] for cell in cells]):
        exact = touchstone.first_inversions(kind, queries)
        assert exact.toi.tolist() == list(times.values()) and exact.inverts.tolist() == found.inverts.tolist()
    for queries in (lines, parabolas):
        report = touchstone.check(touchstone.prove(kind, queries))
        assert report and (report.no_inversion, report.time_of_inversion) == (1, 5)
    lines[1, 6, 1] = np.nan
    for call in (touchstone.inversions, touchstone.first_inversions, touchstone.prove):
        with pytest.raises(ValueError, match=r"query 1: coordinate \[6, 1\] is NaN"):
            call(kind, lines)
    with pytest.raises(ValueError, match="a cell has no separation"):
        touchstone.prove(kind, lines[0], separation=1.0)
    with pytest.raises(ValueError, match="straight"):
        touchstone.inversions(kind, parabolas)


@pytest.mark.parametrize("kind, points", [("vertex_edge", [0, 1, 2, 1]), ("vertex_vertex", [0, 1, 1, 1])])
def test_a_point_and_an_edge_or_a_point_are_faces_without_an_area(kind, points, queries):
    for shape, places in ((8, 3), [0, 1]), ((3, 4, 3), [0, 1, 1]):
        given = queries[:300].reshape(-1, 2, 4, 3)[:, places] * 0.5
        faces = given[:, :, points].reshape(-1, *shape)
        given[:, :, max(points) + 1 :] = np.nan
        given = given.reshape(-1, *shape)
        last = given[7].reshape(-1, 4, 3)
        for call in (touchstone.solve, touchstone.tight_inclusion, functools.partial(touchstone.solve, method="certified")):
            assert bits(call(kind, given, separation=0.25)) == bits(call("vertex_face", faces, separation=0.25))
        truth = touchstone.decide("vertex_face", faces, separation=0.25)
        assert touchstone.decide(kind, given, separation=0.25).toi.tolist() == truth.toi.tolist() and 3 < truth.collides.sum() < 297
        assert touchstone.decide(kind, [touchstone.Curve(last[:, i]) for i in range(4)], separation=0.25).toi == truth.toi[7]
        assert touchstone.prove(kind, given[:20]) == touchstone.prove("vertex_face", faces[:20])
        if shape == (8, 3):
            assert bits(touchstone.distance(kind, given, t=0.25)) == bits(touchstone.distance("vertex_face", faces, t=0.25))
        last[0, 1, 2] = np.inf
        for call in (touchstone.solve, touchstone.tight_inclusion, touchstone.decide, touchstone.prove):
            with pytest.raises(ValueError, match=r"query 7: coordinate \[(0, )?1, 2\] is infinite"):
                call(kind, given)


def test_contacts_and_cells_are_not_taken_for_each_other():
    for calls, kind, text in (
        ((*BATCHES.values(), touchstone.decide), "tetrahedron", "'vertex_vertex', not 'tetrahedron', a cell: call inversions, or first_inv"),
        ((touchstone.inversions, touchstone.first_inversions), "edge_edge", "triangle', not 'edge_edge', a contact: call solve, or decide"),
        ((lambda kind, queries: touchstone.generate(kind),), "vertex_edge", "'plane_triangle', not 'vertex_edge'"),
    ):
        for call in calls:
            with pytest.raises(ValueError, match=text):
                call(kind, [])


def step(**options):
    return touchstone.Step(np.eye(3), np.eye(3), faces=[[0, 1, 2]], **options)


@pytest.mark.parametrize(
    "call",
    [
        lambda **options: touchstone.solve("edge_edge", np.zeros((8, 3)), **options),
        lambda **options: touchstone.tight_inclusion("edge_edge", np.zeros((8, 3)), **options),
        lambda **options: touchstone.decide("edge_edge", np.zeros((8, 3)), **options),
        lambda **options: touchstone.decide("edge_edge", [touchstone.Curve(np.zeros((1, 3)))] * 4, **options),
        lambda **options: touchstone.prove("edge_edge", np.zeros((8, 3)), **options),
        lambda **options: touchstone.check(b"", **options),
        lambda **options: touchstone.solve("edge_edge", np.zeros((8, 3)), method="accd", **options),
        lambda **options: touchstone.judge("accd", **options),
        lambda **options: touchstone.fuzz("accd", **options),
        lambda **options: touchstone.generate("edge_edge", **options),
        lambda **options: touchstone.view(np.zeros((8, 3)), "edge_edge", **options),
        step,
        lambda **options: step().moved(np.eye(3), np.eye(3), **options),
        lambda separation=0.0, norm="l2": step().active_set(separation, norm=norm),
    ],
)
def test_options_of_wrong_types_are_named(call):
    for number, error, text in [
        (Fraction(1, 3), ValueError, r"Fraction\(1, 3\) is not a double; pass float"),
        (Decimal("0.1"), ValueError, r"Decimal\('0.1'\) is not a double"),
        (2**53 + 1, ValueError, "9007199254740993 is not a double"),
        (10**400, ValueError, "10+.* is beyond the range of doubles"),
        ("0.5", TypeError, "a real number is needed, not '0.5' of type str"),
        (True, TypeError, "a real number is needed, not True of type bool"),
        ([0.5], TypeError, r"a real number is needed, not \[0.5\] of type list"),
    ]:
        with pytest.raises(error, match=f"^(separation|eta): {text}"):
            call(separation=number)
    with pytest.raises(TypeError, match="^norm must be 'linf' or 'l2', not 2 of type int"):
        call(norm=2)


def test_results_in_tables(queries):
    pandas = pytest.importorskip("pandas")
    result = touchstone.solve("edge_edge", queries)
    table = pandas.DataFrame(result.array)
    assert list(table.columns) == ["collides", "exact", "toi_lower", "toi_upper", "u", "v"]
    assert table.collides.sum() == result.collides.sum() > 0
    assert result._repr_html_().count("<tr>") == 11
    assert repr(result).startswith("CertifiedResult: 4000 queries, ")
