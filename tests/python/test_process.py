"""The process around the package: threads, interrupts, forks and memory."""

from __future__ import annotations

import concurrent.futures
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import touchstone


@pytest.fixture(scope="module")
def falling() -> dict[str, np.ndarray]:
    """Many triangles that move through each other."""
    random = np.random.default_rng(5)
    places = random.normal(size=(2000, 1, 3)) * 4
    before = (places + random.normal(size=(2000, 3, 3))).reshape(-1, 3)
    after = before + random.normal(size=before.shape) * 0.3
    return {"before": before, "after": after, "faces": np.arange(6000).reshape(-1, 3)}


@pytest.mark.parametrize("name", ["certified", "tight_inclusion", "distance", "Step", "holds_the_lock"])
def test_threads_run_at_the_same_time(name, queries, falling, only_released):
    call = {
        "certified": lambda: touchstone.solve("edge_edge", queries, threads=1, progress=False),
        "tight_inclusion": lambda: touchstone.tight_inclusion("edge_edge", queries, threads=1, progress=False),
        "distance": lambda: touchstone.distance("edge_edge", queries, threads=1, progress=False),
        "Step": lambda: touchstone.Step(**falling, threads=1, progress=False).is_free(),
        "holds_the_lock": lambda: sum(range(1000)),  # a planted fault
    }[name]
    workers, inside, most = 4, 0, 0
    start = threading.Barrier(workers)

    def work() -> None:
        nonlocal inside, most
        start.wait()
        for _ in range(10):
            inside += 1
            most = max(most, inside)
            call()
            inside -= 1

    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        for done in [pool.submit(work) for _ in range(workers)]:
            done.result()
    assert (most > 1) == (name != "holds_the_lock")


def interrupt_once_inside(call, error=touchstone.Interrupted) -> pytest.ExceptionInfo:
    """Call, and interrupt the call from another thread as soon as the package's own code releases the lock.

    The call shows no progress: isatty() of standard error releases the lock, too.
    """
    inside = threading.Event()

    def send() -> None:
        inside.wait()
        os.kill(os.getpid(), signal.SIGINT)

    def note(_, event, function) -> None:
        # What comes before, such as NumPy's checks of arrays, releases the lock, too.
        if event == "c_call" and (getattr(function, "__module__", None) or "").startswith("touchstone."):
            inside.set()

    sender = threading.Thread(target=send)
    sender.start()
    with pytest.raises(error) as caught:
        sys.setprofile(note)
        try:
            call()
        finally:
            sys.setprofile(None)
            inside.set()
    sender.join()
    return caught


@pytest.mark.parametrize("threads", [1, 3])
def test_an_interrupt_ends_a_batch_with_what_is_done(threads, only_released):
    # A vertex close to an oblique triangle at all times: each query takes all its boxes.
    query = np.zeros((8, 3))
    query[1:4] = query[5:8] = np.eye(3)
    query[0] = query[4] = 1 / 3 + 1e-9
    batch = np.tile(query, (200_000, 1, 1))

    def call() -> None:
        touchstone.tight_inclusion(
            "vertex_face", batch, tolerance=1e-12, max_checks=10_000, threads=threads, progress=False
        )

    caught = interrupt_once_inside(call)
    done = caught.value.result
    assert 0 < len(done) < len(batch)
    first = touchstone.tight_inclusion("vertex_face", query, tolerance=1e-12, max_checks=10_000)
    assert (done.checks == first.checks).all()
    assert f"after {len(done)} queries" in str(caught.value)


def test_an_interrupt_ends_a_step(only_released):
    random = np.random.default_rng(1)
    before = random.normal(size=(60000, 3))  # minutes of pairs
    faces = np.arange(60000).reshape(-1, 3)
    step = touchstone.Step(before, before[::-1], faces=faces, progress=False)
    for search in (step.collisions, step.candidates, lambda: step.active_set(0.5), step.least_distance, lambda: touchstone.prove_mesh(before, faces, progress=False)):
        assert interrupt_once_inside(search).value.result is None
    # The step is as good as before.
    apart = before + 100.0 * (np.arange(60000)[:, None] // 3)
    assert step.moved(apart, apart).is_free()


@pytest.mark.parametrize("shown", [True, False])
def test_a_bar_shows_the_part_that_is_done(shown, queries, capsys, monkeypatch, only_released):
    clock = iter(range(10**9))
    monkeypatch.setattr("touchstone._tool.time.monotonic", lambda: float(next(clock)))
    touchstone.tight_inclusion("edge_edge", np.tile(queries, (20, 1, 1)), threads=1, progress=shown)
    step = touchstone.Step(*np.random.default_rng(1).normal(size=(2, 4500, 3)), faces=np.arange(4500).reshape(-1, 3), progress=shown)
    step.collisions()
    drawn = capsys.readouterr().err
    assert ("%|#" in drawn) == ("Step: " in drawn) == shown


def test_a_handler_of_signals_may_raise_what_it_likes(queries, only_released):
    class Stop(Exception):
        pass

    def stop(*_):
        raise Stop

    many = np.tile(queries, (1000, 1, 1))
    before = signal.signal(signal.SIGINT, stop)
    try:
        with pytest.raises(Stop):
            signal.raise_signal(signal.SIGINT)
        interrupt_once_inside(lambda: touchstone.solve("edge_edge", many, threads=1, progress=False), Stop)
    finally:
        signal.signal(signal.SIGINT, before)


def in_child(work, seconds: int = 120) -> int:
    """Run work in a child of fork(), and return its status; after some seconds it is ended."""
    child = os.fork()
    if child == 0:
        signal.alarm(seconds)
        try:
            work()
            os._exit(0)
        finally:
            os._exit(1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def test_a_fork_after_use_works(queries, falling):
    expected = touchstone.solve("edge_edge", queries).collides.sum()
    step = touchstone.Step(**falling)
    collisions, proof = step.collisions(), step.prove()

    def work() -> None:
        assert touchstone.solve("edge_edge", queries).collides.sum() == expected
        assert (step.collisions() == collisions).all()
        again = touchstone.Step(**falling)
        assert (again.collisions() == collisions).all()
        assert len(step.candidates()) == len(again.candidates()) > 0
        assert step.free_step_size() == again.free_step_size()
        assert step.prove() == proof

    for _ in range(5):
        assert in_child(work) == 0
    # A planted fault: a child that waits for a thread of its parent.
    assert in_child(threading.Event().wait, seconds=1) == -signal.SIGALRM


def resident_bytes() -> int:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.parametrize("leaked_bytes", [0, 100])
def test_nothing_leaks(leaked_bytes, queries):
    """With a planted leak, memory grows."""
    leaked = []
    small = {"before": np.eye(3), "after": np.eye(3) * 2, "faces": [[0, 1, 2]]}

    def calls(count: int) -> None:
        for i in range(count):
            query = queries[i % len(queries)]
            leaked.append(bytes(leaked_bytes) if leaked_bytes else None)
            touchstone.solve("edge_edge", query)
            touchstone.tight_inclusion("vertex_face", query, max_checks=10)
            touchstone.distance("vertex_face", query)
            if i % 100 == 0:
                touchstone.Step(**small).collisions()
                with pytest.raises(ValueError):
                    touchstone.solve("edge_edge", query * np.nan)

    calls(2000)
    before = resident_bytes()
    calls(100_000)
    assert (resident_bytes() - before < 4 << 20) == (leaked_bytes == 0)


# All that is asked in a process whose first call comes in this rounding mode, which its argument numbers.
IN_A_MODE = """
import ctypes, platform, sys
import numpy as np
shift = 10 if platform.machine() == "x86_64" else 22
assert ctypes.CDLL("libm.so.6").fesetround(int(sys.argv[1]) << shift) == 0
import touchstone
queries = (np.arange(24 * 50).reshape(-1, 8, 3) * 7919 % 13 - 6) / 2.0
for kind in ("edge_edge", "vertex_face"):
    for result in (touchstone.solve(kind, queries), touchstone.distance(kind, queries, t=0.5)):
        print(result, result.array.tolist())
    print(touchstone.decide(kind, queries).collides.tolist())
step = touchstone.Step(queries[:, :3].reshape(-1, 3), queries[:, 3:6].reshape(-1, 3), faces=np.arange(150).reshape(-1, 3))
print(step.earliest(), step.collisions().tolist(), step.free_step_size())
"""


def test_the_rounding_mode_of_the_first_call_does_not_matter():
    def answers(mode: int) -> str:
        command = [sys.executable, "-c", IN_A_MODE, str(mode)]
        return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout

    usual = answers(0)
    assert usual.count("True") > 10
    assert all(answers(mode) == usual for mode in (1, 2, 3))
