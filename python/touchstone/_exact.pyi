from typing import Any, Callable

import numpy as np
import numpy.typing as npt

_Doubles = npt.NDArray[np.float64]
_Integers = npt.NDArray[np.int32]
_Items = npt.NDArray[np.void]
_Progress = Callable[[int], None]

def decision_layout() -> Any: ...
def decide(
    kind: str,
    queries: _Doubles,
    results: _Items,
    separation: float,
    norm: str,
    threads: int,
    progress: _Progress | None,
) -> list[Any]: ...
def decide_curves(
    kind: str,
    curves: list[list[tuple[list[list[float]], list[float]]]],
    results: _Items,
    separation: float,
    norm: str,
    threads: int,
    progress: _Progress | None,
) -> list[Any]: ...
def prove(
    kind: str,
    queries: _Doubles,
    separation: float,
    norm: str,
    claim: str,
    threads: int,
    progress: _Progress | None,
) -> tuple[int, bytes]: ...
def prove_step(
    before: _Doubles,
    after: _Doubles,
    faces: _Integers,
    edges: _Integers,
    points: _Integers,
    groups: _Integers,
    apart: _Integers,
    tetrahedra: _Integers,
    plane_triangles: _Integers,
    radii: _Doubles,
    separated: _Integers,
    separations: _Doubles,
    separation: float,
    norm: str,
    t_max: float,
    threads: int,
    label: str,
    progress: _Progress | None,
) -> tuple[str, str, bytes]: ...
def prove_mesh(
    vertices: _Doubles,
    faces: _Integers,
    edges: _Integers,
    points: _Integers,
    groups: _Integers,
    apart: _Integers,
    weld: bool,
    threads: int,
    label: str,
    progress: _Progress | None,
) -> tuple[str, str, bytes]: ...
def check(
    certificates: bytes | str,
    scenes: bytes | str | None,
    claim: str | None,
    separation: str | None,
    norm: str,
    rules: str,
) -> dict[str, Any]: ...
def methods() -> list[tuple[Any, ...]]: ...
def answer_layout() -> Any: ...
def solve(
    method: str,
    kind: str,
    queries: _Doubles,
    results: _Items,
    separation: float,
    norm: str,
    tolerance: float,
    max_checks: int,
    t_max: float,
    threads: int,
    progress: _Progress | None,
) -> int: ...
