from typing import Any, Callable, Literal

import numpy as np
import numpy.typing as npt

_Doubles = npt.NDArray[np.float64]
_Integers = npt.NDArray[np.int32]
_Items = npt.NDArray[np.void]
_Progress = Callable[[int], None]
_Waiting = Callable[[], None]
_Rule = Callable[[int, int], bool]

def certified(
    kind: str,
    queries: _Doubles,
    results: _Items,
    separation: float,
    norm: str,
    toi_tolerance: float,
    t_max: float,
    threads: int,
    progress: _Progress | None,
) -> int: ...
def tight_inclusion(
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
def distance(
    kind: str, queries: _Doubles, results: _Items, t: float, norm: str, threads: int, progress: _Progress | None
) -> int: ...
def certified_layout() -> Any: ...
def tight_inclusion_layout() -> Any: ...
def distance_layout() -> Any: ...
def is_forked() -> bool: ...
def collision_layout() -> Any: ...
def instruction_set() -> str: ...

class Step:
    def __init__(
        self,
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
        can_collide: _Rule | None,
        separation: float,
        norm: str,
        toi_tolerance: float,
        t_max: float,
        threads: int,
    ) -> None: ...
    def moved(self, before: _Doubles, after: _Doubles, separation: float, norm: str) -> Step: ...
    def earliest(self, progress: _Waiting | None) -> tuple[float, float, _Items, _Items] | None: ...
    def collisions(self, progress: _Waiting | None) -> _Items: ...
    def inversions(self, progress: _Waiting | None) -> _Items: ...
    def starts_free(self, progress: _Waiting | None) -> bool: ...
    def is_free(self, progress: _Waiting | None) -> bool: ...
    def free_step_size(self, progress: _Waiting | None) -> float | None: ...
    def contacts(self, collisions: _Items | None, progress: _Waiting | None) -> _Items: ...
    def active_set(self, eta: float, norm: str, progress: _Waiting | None) -> _Items: ...
    def line_search_limit(
        self, p: float, norm: str, of_pair: bool, kept_volume: float, progress: _Waiting | None
    ) -> tuple[
        Literal["whole", "limited", "in_contact", "too_small", "inverted"],
        float,
        tuple[float, float],
        _Items,
        _Items,
    ]: ...
    def candidates(self, progress: _Waiting | None) -> _Items: ...
    def least_distance(
        self, t: float, norm: str, progress: _Waiting | None
    ) -> tuple[float, float, _Items] | None: ...
    def edges(self) -> _Integers: ...
    def query(self, kind: int, first: int, second: int) -> _Doubles: ...

def intersections(
    vertices: _Doubles,
    faces: _Integers,
    edges: _Integers,
    points: _Integers,
    groups: _Integers,
    apart: _Integers,
    weld: bool,
    threads: int,
    progress: _Waiting | None,
) -> _Items: ...
