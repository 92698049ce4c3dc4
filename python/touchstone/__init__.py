"""Exact continuous collision detection: whether and when moving primitives touch.

A query is an array of shape (8, 3): four points at t=0, then at t=1; a batch has the shape (N, 8, 3).

>>> import numpy as np, touchstone
>>> queries = np.random.default_rng(1).normal(size=(1000, 8, 3))
>>> touchstone.certified("edge_edge", queries)
CertifiedResult: 1000 queries, 201 collide
"""

from ._fast import instruction_set
from ._input import BatchResult, Interrupted
from ._version import commit as __commit__
from ._version import version as __version__
from .batch import (
    CertifiedResult,
    DistanceResult,
    Stage,
    TightInclusionResult,
    certified,
    distance,
    tight_inclusion,
)
from .exact import (
    AlgebraicNumber,
    Answers,
    CheckReport,
    Decisions,
    Method,
    Rejection,
    Verdict,
    check,
    decide,
    decide_curved,
    methods,
    prove,
    solve,
)
from .judging import (
    Finding,
    FuzzReport,
    Judgement,
    Queries,
    View,
    WrongAnswer,
    certify,
    families,
    fuzz,
    generate,
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
    "Stage",
    "Step",
    "TightInclusionResult",
    "Verdict",
    "View",
    "VolumeKind",
    "WrongAnswer",
    "__commit__",
    "__version__",
    "certified",
    "certify",
    "check",
    "decide",
    "decide_curved",
    "distance",
    "families",
    "fuzz",
    "generate",
    "instruction_set",
    "intersections",
    "methods",
    "prove",
    "prove_mesh",
    "read",
    "solve",
    "tight_inclusion",
    "view",
    "write",
]
