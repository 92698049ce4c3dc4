"""Judging of callables: every fault is found and placed, whatever a solver does to its process."""

from __future__ import annotations

import dataclasses
import json
import math
import os
import pathlib
import runpy
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import touchstone

ROOT = pathlib.Path(__file__).parents[2]


def query_at(x: float) -> np.ndarray:
    """A vertex that falls through a triangle at t=1/2; x names the query."""
    query = np.zeros((8, 3))
    query[1:4] = query[5:8] = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    query[:, 0] += x
    query[0] += [0.25, 0.25, 1]
    query[4] += [0.25, 0.25, -1]
    return query


@pytest.fixture(scope="module")
def eight() -> touchstone.Queries:
    return touchstone.Queries("vertex_face", np.array([query_at(x) for x in range(8)]), np.full(8, True))


def misbehaving(kind, query):
    """Do something else at each query."""
    x = int(query[1, 0])
    if x == 1:
        os.kill(os.getpid(), signal.SIGSEGV)
    if x == 2:
        os._exit(7)
    if x == 3:
        raise KeyError("no such thing")
    if x == 4:
        while True:
            time.sleep(1)
    if x == 5:
        return "yes"
    if x == 6:
        return True, 0.75
    print("query", x)
    return x == 0


def test_faults_are_placed(eight):
    judgement = touchstone.judge(misbehaving, eight, query_limit=20.0, threads=1)
    faults = {wrong.index: wrong.fault for wrong in judgement.wrong}
    assert faults == {1: "error", 2: "error", 3: "error", 5: "error", 6: "late_toi", 7: "false_negative"}
    reasons = {wrong.index: wrong.answer for wrong in judgement.wrong}
    assert reasons[1] == "crash: SIGSEGV" and reasons[2].startswith("exit")
    assert "KeyError: 'no such thing'" in reasons[3] and "a solver returns a bool, a time" in reasons[5]
    assert judgement.queries == 8
    assert judgement.count("errors") == 4 and judgement.count("false_negatives") == 1
    # A hang counts as undecided.
    assert judgement.to_dict()["methods"][0]["failures"]["hang"] == 1
    assert "misbehaving" in repr(judgement) and "misses" in str(judgement)
    assert judgement._repr_html_().count("<table>") == 2


@pytest.mark.parametrize(
    "value, verdict, lower, upper",
    [
        (True, 1, math.nan, math.nan),
        (np.bool_(False), 0, math.nan, math.nan),
        (None, 0, math.nan, math.nan),
        (math.nan, 0, math.nan, math.nan),
        (0.0, 1, 0.0, math.nan),
        (np.float32(0.5), 1, 0.5, math.nan),
        ((True, 0.25), 1, 0.25, math.nan),
        ((True, None), 1, math.nan, math.nan),
        ((False, 0.25), 0, math.nan, math.nan),
        ((np.bool_(True), 0.25, 0.5), 1, 0.25, 0.5),
    ],
)
def test_values_of_solvers(value, verdict, lower, upper):
    from touchstone._child import answer_from, items_of

    assert np.array_equal(answer_from(value), (verdict, lower, upper), equal_nan=True)
    if value is not None and not isinstance(value, tuple):
        assert np.array_equal(answer_from(items_of(np.array([value]), 1)[0]), (verdict, lower, upper), equal_nan=True)


@pytest.mark.parametrize("value", [1, "yes", (1, 0.5), (True,), (True, 1, 2, 3), [True], np.int64(0)])
def test_values_that_are_no_answers(value):
    from touchstone._child import answer_from

    with pytest.raises(TypeError, match="a solver returns"):
        answer_from(value)


def test_every_form_of_a_right_solver_is_acquitted(eight):
    def single(kind, query, separation, norm):
        answer = touchstone.solve(kind, query, separation=separation, norm=norm)
        return bool(answer.collides), float(answer.toi_lower), float(answer.toi_upper)

    def batch(kind, queries, **options):
        answer = touchstone.solve(kind, queries, separation=options["separation"], norm=options["norm"])
        return answer.collides, answer.toi_lower

    class Callable:
        def __call__(self, kind, query):
            answer = touchstone.solve(kind, query)
            return float(answer.toi_lower) if answer.collides else None

    data = [eight, *touchstone.generate("edge_edge", count=1)]
    for solver, options in ((single, {}), (batch, {"batch": True}), (Callable(), {}), ("certified", {})):
        judgement = touchstone.judge(solver, data, promise="exact", query_limit=60.0, **options)
        assert judgement.wrong == [] and judgement.queries > 30
    near = touchstone.judge(single, eight, separation=0.5, norm="l2", promise="exact", query_limit=60.0)
    assert near.wrong == [] and near.to_dict()["separation"]["min_separation"] == 0.5
    contact = touchstone.judge("certified", eight, norm="linf")
    assert contact.to_dict()["separation"] == {"min_separation": 0.0, "norm": "linf"}


def copies_itself(kind, query):
    """A right answer, unless it is the copy's."""
    return os.fork() != 0


def fails_in_its_copy(kind, query):
    """A right answer; an exception in the copy."""
    if os.fork() == 0:
        raise ValueError("the copy")
    return True


@pytest.mark.parametrize("solver", [copies_itself, fails_in_its_copy])
def test_a_copy_of_the_solver_answers_nothing(solver, eight):
    judgement = touchstone.judge(solver, eight, promise="exact", query_limit=60.0, threads=1)
    assert judgement.wrong == [] and judgement.queries == 8


def test_bytes_that_are_no_reply_are_an_error(eight):
    def writes_to_the_socket(kind, query):
        os.write(3, bytes(24))
        return True

    judgement = touchstone.judge(writes_to_the_socket, eight, query_limit=60.0, threads=1)
    assert judgement.count("errors") == 8


@pytest.mark.parametrize("name", ["certified", "x" * 101])
def test_a_name_that_misleads_is_refused(name, eight):
    with pytest.raises(ValueError, match="name (is that of a built-in solver|has more than 100 bytes)"):
        touchstone.judge(copies_itself, eight, name=name)


def test_a_batch_is_many_queries_and_a_failure_costs_one():
    data = touchstone.Queries("edge_edge", np.random.default_rng(3).normal(size=(900, 8, 3)))
    unwanted = data.queries[200].copy()

    def batch(kind, queries):
        if len(queries) == 1:
            assert not (queries[0] == unwanted).all(), "unwanted"
        elif (queries == unwanted).all(axis=(1, 2)).any():
            raise ValueError("one of these")
        return touchstone.solve(kind, queries).collides if len(queries) > 1 else np.zeros(1, bool)

    # This solver misses what it is asked alone: the first query, and a batch that fails.
    collides = touchstone.solve("edge_edge", data.queries).collides
    judgement = touchstone.judge(batch, data, batch=True, threads=1, query_limit=60.0)
    failed = [one for one in judgement.wrong if "unwanted" in one.answer]
    assert [one.index for one in failed] == [200]
    missed = {one.index for one in judgement.wrong if one.fault == "false_negative"}
    colliding = set(np.flatnonzero(collides).tolist())
    assert missed < colliding and 2 * len(missed) < len(colliding)


def test_the_example_convicts_the_naive_solver(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    judge_a_solver = runpy.run_path(str(ROOT / "examples/python/judge_a_solver.py"), run_name="__main__")
    said, naive_cubic = capsys.readouterr().out, judge_a_solver["naive_cubic"]
    assert "naive_cubic" in said and "false_negative" in said and "1 accepted, 0 rejected" in said
    report = touchstone.fuzz(naive_cubic, seconds=0, findings=2, query_limit=60.0)
    assert len(report.findings) == 2
    for finding in report.findings:
        truth = touchstone.decide(finding.kind, finding.query)
        assert truth.collides == finding.collides
        assert finding.certificate and touchstone.check(finding.certificate)
        answer = naive_cubic(finding.kind, finding.query)
        assert finding.what != "false_negative" or (answer is None and finding.collides)
    assert "groups" in repr(report) and report._repr_html_().count("<tr>") == 3


@pytest.mark.parametrize("kind", ["tetrahedron", "plane_triangle"])
def test_solvers_of_inversions_are_judged(kind):
    def of_ends(asked, query):  # a cell that is upright at both ends may invert between
        size = 3 if asked == "tetrahedron" else 2
        edges = (query.reshape(2, 4, 3)[:, 1:] - query.reshape(2, 4, 3)[:, :1])[:, :size, :size]
        return bool(np.linalg.det(edges).min() <= 0)

    def right(asked, query):
        answer = touchstone.inversions(asked, query)
        return bool(answer.inverts), float(answer.toi_lower)

    convicted = touchstone.judge(of_ends, kind=kind, count=8)
    assert convicted.count("false_negatives") > 8 and {wrong.kind for wrong in convicted.wrong} == {kind}
    assert not touchstone.judge(right, touchstone.generate(kind, count=8), promise="exact").wrong
    found = touchstone.fuzz(of_ends, kind=kind, queries=2000, only=["false_negative"], findings=1)
    assert found.findings[0].kind == kind and found.findings[0].certificate
    assert touchstone.first_inversions(kind, found.findings[0].query).inverts


def test_ctrl_c_ends_a_search_with_what_was_found(tmp_path):
    program = tmp_path / "search.py"
    program.write_text(
        "import touchstone\n"
        f"def asked(kind, query, mark={str(tmp_path / 'asked')!r}):\n"
        "    import pathlib\n"
        "    pathlib.Path(mark).touch()\n"
        "    return True\n"
        "try:\n"
        "    touchstone.fuzz(asked, seconds=0, queries=10**9, query_limit=60.0)\n"
        "except touchstone.Interrupted as interrupt:\n"
        "    print(interrupt.result.to_dict()['ended_by'])\n"
    )
    process = subprocess.Popen([sys.executable, program], stdout=subprocess.PIPE, text=True)
    while not (tmp_path / "asked").exists():
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=120)
    assert out == "interrupt\n" and process.returncode == 0


def curves(columns: int) -> touchstone.Queries:
    """A vertex on a parabola that touches the triangle, and the same moved up, on polynomial or rational curves."""
    start, middle = query_at(0)[:4], query_at(0)[4:]
    touching = np.array([start, middle, start])
    both = np.array([touching, touching + [[[0, 0, 2.0**-40]], [[0, 0, 0]], [[0, 0, 0]]]])
    both[1, :, 0, 2] += 2.0**-10
    weights = np.broadcast_to(np.array([1.0, 1, 2]).reshape(1, 3, 1, 1), (2, 3, 4, 1))
    numbers = both if columns == 3 else np.concatenate([both, weights], axis=-1)
    truth = touchstone.decide("vertex_face", numbers).collides
    return touchstone.Queries("vertex_face", numbers, truth, "curves")


DATA = {
    "vertex_face": lambda: touchstone.generate("vertex_face", family="hourglass", count=20)[0],
    "edge_edge": lambda: touchstone.generate("edge_edge", family="hourglass", count=20)[0],
    "parabolas": lambda: curves(3),
    "conics": lambda: curves(4),
}


@pytest.mark.parametrize("name", DATA)
@pytest.mark.parametrize("ending", ["csv", "npy"])
def test_data_survive_a_file_and_are_judged(name, ending, tmp_path, tool):
    written = DATA[name]()
    assert written.collides is not None and not written.collides.all()
    path = tmp_path / f"x-{written.kind.replace('_', '-')}.{ending}"
    touchstone.write(path, written)
    again = touchstone.read(path)
    assert again.kind == written.kind and again.queries.shape == written.queries.shape
    # A fraction has no sign of zero.
    expected = written.queries + 0.0 if ending == "csv" else written.queries
    assert again.queries.tobytes() == expected.tobytes()
    assert again.collides is None if ending == "npy" else (again.collides == written.collides).all()
    for data in (written, path, [written, curves(3)]):
        judgement = touchstone.judge("certified", data, promise="exact")
        assert judgement.wrong == [] and judgement.queries == len(written) + (2 if isinstance(data, list) else 0)
        assert judgement.method["queries"] == judgement.queries
    assert touchstone.view(written).page.count("<script") > 0
    # The command line reads the same.
    done = subprocess.run([tool, "certify", path, "--method", "certified"], capture_output=True, text=True)
    assert done.returncode == 0 and str(len(written)) in done.stdout


@pytest.mark.parametrize("degree, rational, shape", [(1, False, (8, 3)), (3, False, (4, 4, 3)), (1, True, (2, 4, 4))])
def test_findings_have_the_shape_of_their_degree(degree, rational, shape):
    from touchstone.judging import _finding_from

    numbers = np.random.default_rng(degree).uniform(1, 2, size=shape)
    finding = _finding_from({
        "what": "late_toi", "kind": "edge-edge", "degree": degree, "rational": rational,
        "numbers": json.loads(json.dumps(numbers.ravel().tolist())),
        "collides": True, "truth": "at 0", "detail": "", "certificate": None,
    })
    assert finding.query.tobytes() == numbers.tobytes() and finding.query.shape == shape
    assert touchstone.view(finding).page.count("<script") > 0


def test_a_search_on_curves_is_for_methods_that_answer_them():
    with pytest.raises(ValueError, match="answers no queries on straight lines"):
        touchstone.fuzz("subdivision", queries=10)
    report = touchstone.fuzz("certified", queries=100, degrees=[2, "rational"])
    assert report.findings == [] and report.queries == 100


@pytest.mark.parametrize("change, text", [
    ({"queries": np.full((1, 8, 3), np.nan)}, "query 0: coordinate .* is NaN"),
    ({"queries": np.zeros((1, 3, 4, 4))}, "weight .* is not positive"),
    ({"collides": np.array([True])}, "as many labels as queries"),
])
def test_what_is_no_dataset_is_not_written(change, text, tmp_path):
    path = tmp_path / "x_vf.csv"
    with pytest.raises(ValueError, match=text):
        touchstone.write(path, dataclasses.replace(curves(3), **change))
    with pytest.raises(ValueError, match=r"must end in \.csv or \.npy"):
        touchstone.write(tmp_path / "x_vf.txt", curves(3))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("kind", "options"),
    [(kind, {}) for kind in ("vertex_face", "edge_edge", "tetrahedron", "plane_triangle")]
    + [(kind, {"separation": 0.125, "norm": "l2"}) for kind in ("vertex_face", "edge_edge")],
)
def test_every_family_is_generated_with_its_truth(kind, options):
    """The verdicts are those of the certified solver, and it encloses the recorded times."""
    known = [one for one in touchstone.generate(kind, count=4, **options) if one.collides is not None]
    assert len(known) > 3 and all(one.name.startswith("separation") if options else one.name in touchstone.families() for one in known)
    assert sum(len(one.toi) for one in known) > len(known)
    for one in known:
        answers = touchstone.solve(kind, one.queries, method="certified", **options)
        assert (one.collides == answers.collides).all() and all(one.collides[i] for i in one.toi)
        for i, time in one.toi.items():
            assert answers.toi_lower[i] <= time <= answers.toi_upper[i]


def test_read_rounds_on_demand(tmp_path):
    path = tmp_path / "x_vf.csv"
    path.write_text("1,3,1,1,1,1\n" * 8)
    with pytest.raises(ValueError, match=r":1:1: not exactly a double \(round=True takes the nearest\)"):
        touchstone.read(path)
    assert (touchstone.read(path, round=True).queries[..., 0] == 1 / 3).all()


def test_errors(eight, tmp_path):
    (tmp_path / "x.npy").touch()
    lock = threading.Lock()
    for call, error, text in [
        (lambda: touchstone.read(tmp_path / "x.npy"), ValueError, "path does not say .*; give it by kind="),
        (lambda: touchstone.read(tmp_path / "none_ee.npy"), FileNotFoundError, ""),
        (lambda: touchstone.write(tmp_path / "edge-edge.csv", eight), ValueError, "says another kind"),
        (lambda: touchstone.judge("frobnicate", eight), ValueError, "no method is called frobnicate"),
        (lambda: touchstone.judge("certified", []), ValueError, "there are no queries"),
        (lambda: touchstone.generate("edge_edge", family="frobnicate"), ValueError, "unknown|family|no family"),
        (lambda: touchstone.judge(lambda kind, query: lock.locked(), eight), ValueError, "cannot be sent to another process"),
        (lambda: touchstone.view(eight.queries), ValueError, "name the kind"),
    ]:
        with pytest.raises(error, match=text):
            call()


def test_pages(eight, tmp_path):
    page = touchstone.view(eight, methods=["accd"])
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page.page
    assert "<html" in page.page and page._repr_html_().startswith("<iframe srcdoc=")
    assert touchstone.view(eight.queries[0], "vertex_face").page.count("<script") > 0


def test_without_the_tool_only_judging_is_missing(monkeypatch, eight):
    monkeypatch.setattr("touchstone._tool.FOLDER", pathlib.Path("/nowhere"))
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(FileNotFoundError, match="./run python in the sources"):
        touchstone.judge("certified", eight)
    hourglass = touchstone.generate("edge_edge", family="hourglass", count=3)[0]
    assert hourglass.name in touchstone.families() and len(hourglass) == 3 and hourglass.collides is not None
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    before = np.concatenate([triangle, triangle + [0.125, 0.125, 1]])
    after = np.concatenate([triangle, triangle + [0.125, 0.125, -1]])
    scene = dict(faces=[[0, 1, 2], [3, 4, 5]], groups=[0] * 3 + [1] * 3, apart=[[0, 0]])
    proof = touchstone.Step(before, after, **scene).prove(label="it falls")
    assert proof.claim.startswith("earliest ") and touchstone.check(proof.certificate, claim="earliest")
    assert proof.rules == "1 group held apart from itself" and proof.rules in touchstone.check(proof.certificate).steps[0]
    assert proof.label == "it falls" and b"\nstep it falls\n" in proof.certificate
    short = touchstone.Step(before, after, faces=scene["faces"], t_max=0.25, separation=0.125, norm="l2").prove()
    assert short.claim == "no_contact 1/4"
    assert touchstone.check(short.certificate, claim=short.claim, separation=0.125, norm="l2")
    assert not touchstone.check(short.certificate, claim="free")
    # Edges in any order and direction, some twice, one from a vertex to itself.
    edges = [[5, 3], [1, 0], [4, 3], [2, 1], [0, 1], [5, 4], [2, 0]]
    anyhow = touchstone.Step(before, after, edges=[*edges, [4, 4]]).prove()
    assert anyhow == touchstone.Step(before, after, edges=sorted(sorted(e) for e in edges[:4] + edges[5:]), points=[4]).prove()
    assert anyhow.claim.startswith("earliest ") and touchstone.check(anyhow.certificate)
    for places, faces, claim in [(before, scene["faces"], "intersections 0"), (before * [1, 1, 0], scene["faces"], "intersections 1")]:
        rest = touchstone.prove_mesh(places, faces, label="at rest")
        assert rest.claim == claim and touchstone.check(rest.certificate, claim=claim)
    with pytest.raises(RuntimeError, match="items, more than 4194304"):
        touchstone.prove_mesh(before, scene["faces"], groups=scene["groups"], apart=np.zeros((1 << 22, 2), dtype=np.int32))
