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

from . import _version
from ._input import BatchResult as BatchResult
from ._input import Interrupted as Interrupted
from .batch import (
    Answers as Answers,
    CertifiedResult as CertifiedResult,
    DistanceResult as DistanceResult,
    Inversions as Inversions,
    TightInclusionResult as TightInclusionResult,
    Verdict as Verdict,
    distance as distance,
    instruction_set as instruction_set,
    inversions as inversions,
    solve as solve,
    tight_inclusion as tight_inclusion,
)
from .exact import (
    AlgebraicNumber as AlgebraicNumber,
    CheckReport as CheckReport,
    Curve as Curve,
    Decisions as Decisions,
    FirstInversions as FirstInversions,
    Method as Method,
    Rejection as Rejection,
    check as check,
    decide as decide,
    first_inversions as first_inversions,
    methods as methods,
    prove as prove,
)
from .judging import (
    Finding as Finding,
    FuzzReport as FuzzReport,
    Judgement as Judgement,
    Queries as Queries,
    View as View,
    WrongAnswer as WrongAnswer,
    families as families,
    fuzz as fuzz,
    generate as generate,
    judge as judge,
    read as read,
    view as view,
    write as write,
)
from .scene import (
    CellKind as CellKind,
    ContactKind as ContactKind,
    Impact as Impact,
    IntersectionKind as IntersectionKind,
    LeastDistance as LeastDistance,
    LineSearchLimit as LineSearchLimit,
    PrimitiveKind as PrimitiveKind,
    SceneProof as SceneProof,
    Step as Step,
    intersections as intersections,
    prove_mesh as prove_mesh,
)

__version__ = _version.version
__commit__ = _version.commit

#: Former names, refused for one version.
_FORMER_NAMES = {
    "certified": "solve(kind, queries)",
    "certify": "judge(solver, data)",
    "CurvedStep": "Step(control_points, ...)",
    "decide_curved": "decide(kind, [Curve(...), ...])",
    "ElementKind": "PrimitiveKind(number)",
    "PairKind": "ContactKind(number)",
    "VolumeKind": "CellKind(number)",
}

if not TYPE_CHECKING:

    def __getattr__(name: str) -> NoReturn:
        if name in _FORMER_NAMES:
            raise AttributeError(f"touchstone.{name} has become touchstone.{_FORMER_NAMES[name]}")
        raise AttributeError(f"module 'touchstone' has no attribute {name!r}")
