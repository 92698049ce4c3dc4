"""The oracle, certificates and methods: against the fast part and the checker."""

from __future__ import annotations

from fractions import Fraction

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import touchstone

KINDS = ["vertex_face", "edge_edge"]
small_queries = arrays.arrays(np.float64, (8, 3), elements=st.integers(-3, 3).map(float))


def test_the_norm_is_l2_in_every_function_by_default():
    """Two points at rest, 0.9 apart on each axis: 1.56 apart in l2, 0.9 in linf."""
    points = np.array([[0.0, 0, 0], [0.9, 0.9, 0.9]])
    query = points[[0, 1, 1, 1, 0, 1, 1, 1]]
    for norm, is_near in [({}, False), ({"norm": "linf"}, True)]:
        near = {"separation": 1.0, **norm}
        assert touchstone.solve("vertex_face", query, **near).collides == is_near
        assert touchstone.decide("vertex_face", query, **near).collides == is_near
        assert touchstone.Step(points, points, points=[0, 1], **near).is_free() != is_near
        assert (touchstone.distance("vertex_face", query, **norm).upper <= 1.0) == is_near
        assert (touchstone.Step(points, points, points=[0, 1]).least_distance(**norm).upper <= 1.0) == is_near


@given(small_queries, st.sampled_from(KINDS), st.sampled_from([0.0, 0.5]), st.sampled_from(["linf", "l2"]))
@settings(max_examples=60)
def test_the_oracle_agrees_and_its_times_are_exact(query, kind, separation, norm):
    truth = touchstone.decide(kind, query, separation=separation, norm=norm)
    fast = touchstone.solve(kind, query, separation=separation, norm=norm)
    assert truth.collides == fast.collides
    time = truth.toi
    assert (time is None) == (not truth.collides)
    if time is None:
        assert np.isnan(truth.toi_lower)
        return
    if isinstance(time, Fraction):
        lower = upper = time
    else:
        # A root between two values of opposite signs.
        assert time.value_at(time.lower) * time.value_at(time.upper) < 0
        time = time.refine(Fraction(1, 2**80))
        lower, upper = time.lower, time.upper
        assert float(time) in (truth.toi_lower, truth.toi_upper)
    assert Fraction(float(truth.toi_lower)) <= lower and upper <= Fraction(float(truth.toi_upper))
    assert truth.toi_upper in (truth.toi_lower, np.nextafter(truth.toi_lower, 2))
    assert Fraction(float(fast.toi_lower)) <= lower and upper <= Fraction(float(fast.toi_upper))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("numbers", [3, 4])
@pytest.mark.parametrize("degree", [2, 3])
def test_arrays_of_curves_are_decided_like_each_query(kind, degree, numbers):
    random = np.random.default_rng(37)
    curves = random.integers(-8, 9, (60, degree + 1, 4, numbers)) / 4
    curves[..., 3:] = random.integers(1, 4, (60, degree + 1, 1, numbers - 3))
    truth = touchstone.decide(kind, curves)
    assert 3 < truth.collides.sum() < 57
    with pytest.raises(ValueError, match="from 1 to 8, not 0; repeat the control point"):
        touchstone.solve(kind, curves[:, :1])
    fast = touchstone.solve(kind, curves)
    assert (fast.collides == truth.collides).all()
    hits = truth.collides
    assert (fast.toi_lower[hits] <= truth.toi_upper[hits]).all()
    assert (fast.toi_upper[hits] >= truth.toi_lower[hits]).all()
    assert touchstone.tight_inclusion(kind, curves, tolerance=0.01, max_checks=2000).collides[hits].all()
    assert touchstone.check(touchstone.prove(kind, curves)).accepted == 60
    for i in (0, 1, 2):
        points = [touchstone.Curve(c[:, :3], c[:, 3:]) for c in np.moveaxis(curves[i], 1, 0)]
        assert touchstone.decide(kind, points).toi == touchstone.decide(kind, curves[i]).toi == truth[i].toi
        assert touchstone.solve(kind, curves[i]).collides == truth.collides[i]


def test_lines_are_curves_of_degree_1(queries):
    lines = queries[:100]
    for call, field in ((touchstone.decide, "toi"), (touchstone.solve, "collides")):
        assert (getattr(call("edge_edge", lines.reshape(100, 2, 4, 3)), field) == getattr(call("edge_edge", lines), field)).all()


@pytest.mark.parametrize("call", [touchstone.solve, touchstone.decide, touchstone.prove, touchstone.tight_inclusion])
def test_arrays_of_no_curves_are_refused(call):
    curves = np.ones((3, 3, 4, 4))
    for place, value, text in (
        ((1, 2, 3, 3), 0, r"weight \[2, 3, 3\] is not positive"),
        ((1, 2, 3, 3), np.inf, r"weight \[2, 3, 3\] is infinite"),
        ((1, 0, 1, 2), np.nan, r"coordinate \[0, 1, 2\] is NaN"),
    ):
        wrong = curves.copy()
        wrong[place] = value
        with pytest.raises(ValueError, match="query 1: " + text):
            call("edge_edge", wrong)
    for shape in ((2, 0, 4, 3), (2, 3, 4, 5), (2, 3, 3, 4), (2, 2, 3, 4, 3), (2, 10, 4, 3)):
        with pytest.raises(ValueError, match="shape|degree|curves"):
            call("edge_edge", np.ones(shape))


def test_curves_that_are_none_are_refused():
    rest = [touchstone.Curve([point]) for point in ([0, 0, 0], [1, 0, 0], [0, 1, 0])]
    for vertex in ([[[0, 0]]], [[]], [[[0, 0, np.nan]]], ([[0, 0, 1]] * 2, [1, 0])):
        with pytest.raises(ValueError, match="curve|weight|degree|coordinates must be finite"):
            touchstone.decide("vertex_face", [[touchstone.Curve(*vertex), *rest]])
    for vertex in ([["0", "0", "1"]], np.array([[0, 0, 2**53 + 1]]), np.ma.array([[0, 0, 1]], mask=[[1, 0, 0]])):
        with pytest.raises(ValueError, match="^curves"):
            touchstone.decide("vertex_face", [touchstone.Curve(vertex), *rest])
    for query, text in ((rest, "four curves, not 3"), ([[[0, 0, 1]], *rest], "list of four touchstone.Curve, not")):
        for queries in (query, [rest[:1] * 4, query]):
            with pytest.raises(ValueError, match=text):
                touchstone.decide("vertex_face", queries)


@pytest.mark.parametrize("threads", [1, 3])
def test_batches_are_their_queries(queries, threads):
    batch = touchstone.decide("edge_edge", queries[:100], threads=threads)
    assert [batch[i].toi for i in range(100)] == [touchstone.decide("edge_edge", q).toi for q in queries[:100]]
    assert (batch.collides == touchstone.solve("edge_edge", queries[:100]).collides).all()
    assert len(touchstone.decide("edge_edge", np.empty((0, 8, 3)))) == 0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("claim", ["time_of_impact", "collision"])
def test_certificates_are_accepted_and_changed_ones_are_not(queries, kind, claim):
    stream = touchstone.prove(kind, queries[:50], separation=0.125, norm="l2", claim=claim)
    report = touchstone.check(stream)
    assert report and report.accepted == 50 and report.rejected == 0
    collisions = touchstone.solve(kind, queries[:50], separation=0.125, norm="l2").collides.sum()
    assert report.no_collision == 50 - collisions
    assert touchstone.check(stream, separation=0.125, norm="l2")
    assert not touchstone.check(stream, separation=0.25, norm="l2")
    assert not touchstone.check(stream, claim="no_collision")
    assert not touchstone.check(stream[: len(stream) // 2])
    cut = touchstone.check(b"\n".join(stream.split(b"\n")[:-2]))
    assert not cut and cut.rejections[0].line > 0 and cut.rejections[0].reason


def test_certificates_of_tetrahedra():
    points = "point 0 0 0\npoint 1 0 0\npoint 0 1 0\npoint 0 0 1\n"
    flat = points.replace("0 0 1", "0 0 0")
    query = f"touchstone-certificates 2\nquery tetrahedron\n{points}{flat}claim inversion\n"
    report = touchstone.check(query + "contact time 1\nat plane\nend\ncertificates 1\n", claim="inversion")
    assert report and report.accepted == report.inversion == 1
    assert report.no_inversion == report.time_of_inversion == report.collision == 0


def test_certificates_of_meshes():
    mesh = "vertices 2\n0 0 0\n0 0 0\nfaces 0\nedges 0\npoints 2\n0\n1\ngroups 0\napart 0\n"
    stream = f"touchstone-meshes 1\nmesh a\n{mesh}claim intersections 1\n0 1 1 1\nseparations\nend\nmeshes 1\n"
    report = touchstone.check(stream, scenes=mesh, claim="intersections 1")
    assert report and report.accepted == 1
    assert report.meshes == ("mesh a\n2 vertices, 0 faces, 0 edges of no face, 2 points\nclaim intersections 1\n",)
    assert not touchstone.check(stream, claim="free")
    assert not touchstone.check(stream.replace("0 1 1 1\n", "0 1\n"))
    apart = stream.replace("apart 0\n", "apart 1\n0 0\n").replace("intersections 1\n0 1 1 1\n", "intersections 0\n")
    rule = "1 group held apart from itself"
    assert touchstone.check(apart).summary == f"1 mesh: no two elements that can meet intersect; {rule}"
    assert touchstone.check(apart, claim="free", rules=rule) and not touchstone.check(apart, claim="free")


def test_errors(queries):
    for call, text in [
        (lambda: touchstone.decide("edge_edge", np.stack([queries[0], queries[0] * np.inf])), "query 1: coordinate"),
        (lambda: touchstone.prove("edge_edge", queries[0], claim="no_collision"), "claim must be"),
        (lambda: touchstone.solve("edge_edge", queries, method="frobnicate"), "no method is called frobnicate .there are: certified"),
        (lambda: touchstone.solve("edge_edge", queries, method="cubic", separation=1.0), "knows no separation but 0"),
        (lambda: touchstone.check(b"", claim="frobnicate"), ""),
    ]:
        with pytest.raises(ValueError, match=text):
            call()


def test_a_missing_library_is_explained(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "touchstone._exact", None)
    with pytest.raises(ImportError, match="./run python in the sources"):
        touchstone.decide("edge_edge", np.zeros((8, 3)))


def test_the_named_functions_answer_as_their_methods(queries):
    for kind in KINDS:
        certified, method = touchstone.solve(kind, queries), touchstone.solve(kind, queries, method="certified")
        assert (certified.collides == method.collides).all()
        assert np.array_equal(certified.toi_lower, method.toi_lower, equal_nan=True)
        assert np.array_equal(certified.toi_upper, method.toi_upper, equal_nan=True)
        ours, method = touchstone.tight_inclusion(kind, queries), touchstone.solve(kind, queries, method="tight_inclusion")
        assert (ours.collides == method.collides).all()
        assert np.array_equal(ours.toi, method.toi_lower, equal_nan=True)
        assert (ours.checks == method.checks).all()


def test_methods_answer_curves_of_their_degrees():
    """A vertex falls on a parabola, touches a triangle at t = 1/2, and rises again."""
    curves = np.array([[[[1, 1, z], [0, 0, 0], [4, 0, 0], [0, 4, 0]] for z in (1, -1, 1)]], float)
    for method in ("certified", "tight_inclusion", "sampling"):
        assert touchstone.solve("vertex_face", curves, method=method).collides.all()
    with pytest.raises(ValueError, match="cubic does not answer queries on curves of this degree"):
        touchstone.solve("vertex_face", curves, method="cubic")
    with pytest.raises(ValueError, match="inversion_cubic does not answer .* about a vertex_face"):
        touchstone.solve("vertex_face", curves[:, [0, 2]].reshape(1, 8, 3), method="inversion_cubic")
