"""Exact continuous collision detection: whether and when moving primitives touch.

A query is an array of shape (8, 3): four points at t=0, then at t=1; a batch has the shape (N, 8, 3).

>>> import numpy as np, touchstone
>>> queries = np.random.default_rng(1).normal(size=(1000, 8, 3))
>>> touchstone.solve("edge_edge", queries)
CertifiedResult: 1000 queries, 201 collide

Ctrl-C during long work raises `Interrupted`, whose `result` is what was done until then. A function whose part this
build lacks raises ImportError, and one that needs the command line tool FileNotFoundError, with the way out.
"""

from typing import TYPE_CHECKING, NoReturn

from ._input import BatchResult, Interrupted
from ._version import commit as __commit__
from ._version import version as __version__
from .batch import (
    Answers,
    CertifiedResult,
    DistanceResult,
    TightInclusionResult,
    Verdict,
    distance,
    instruction_set,
    solve,
    tight_inclusion,
)
from .exact import (
    AlgebraicNumber,
    CheckReport,
    Curve,
    Decisions,
    Method,
    Rejection,
    check,
    decide,
    methods,
    prove,
)
from .judging import (
    Finding,
    FuzzReport,
    Judgement,
    Queries,
    View,
    WrongAnswer,
    families,
    fuzz,
    generate,
    judge,
    read,
    view,
    write,
)
from .scene import (
    ElementKind,
    Impact,
    IntersectionKind,
    LeastDistance,
    LineSearchLimit,
    PairKind,
    SceneProof,
    Step,
    VolumeKind,
    intersections,
    prove_mesh,
)

__all__ = [
    "AlgebraicNumber",
    "Answers",
    "BatchResult",
    "CertifiedResult",
    "CheckReport",
    "Curve",
    "Decisions",
    "DistanceResult",
    "ElementKind",
    "Finding",
    "FuzzReport",
    "Impact",
    "Interrupted",
    "IntersectionKind",
    "Judgement",
    "LeastDistance",
    "LineSearchLimit",
    "Method",
    "PairKind",
    "Queries",
    "Rejection",
    "SceneProof",
    "Step",
    "TightInclusionResult",
    "Verdict",
    "View",
    "VolumeKind",
    "WrongAnswer",
    "__commit__",
    "__version__",
    "check",
    "decide",
    "distance",
    "families",
    "fuzz",
    "generate",
    "instruction_set",
    "intersections",
    "judge",
    "methods",
    "prove",
    "prove_mesh",
    "read",
    "solve",
    "tight_inclusion",
    "view",
    "write",
]

#: Former names, refused for one version.
_FORMER_NAMES = {
    "certified": "solve(kind, queries)",
    "certify": "judge(solver, data)",
    "CurvedStep": "Step(control_points, ...)",
    "decide_curved": "decide(kind, [Curve(...), ...])",
}

if not TYPE_CHECKING:

    def __getattr__(name: str) -> NoReturn:
        if name in _FORMER_NAMES:
            raise AttributeError(f"touchstone.{name} has become touchstone.{_FORMER_NAMES[name]}")
        raise AttributeError(f"module 'touchstone' has no attribute {name!r}")
