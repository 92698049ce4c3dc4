"""The interpreter of a solver under test: reads the solver, then answers batch after batch.

python/bindings/python_solver.cpp is the other end of the socket.
"""

from __future__ import annotations

import math
import os
import pickle
import struct
import sys
import traceback
from typing import Any, BinaryIO, Dict, List, Tuple

import numpy as np

SOCKET = 3
REQUEST = struct.Struct("=qqqdqddi4x")
REPLY = struct.Struct("=qqq")
ANSWER = struct.Struct("=i4xddd")
QUERY_BYTES = 24 * 8
#: By their numbers in touchstone/plugin.h.
KINDS = {0: "vertex_face", 1: "edge_edge", 4: "tetrahedron", 5: "plane_triangle"}
NO, YES, UNDECIDED, ERROR = 0, 1, 2, 3

Answer = Tuple[int, float, float]


def answer_from(value: Any) -> Answer:
    """Return the verdict and the bounds of the time that a solver's value means.

    Raises
    ------
    TypeError
        If it is neither a bool, a time, nor both.
    """
    lower = upper = math.nan
    if isinstance(value, tuple) and 2 <= len(value) <= 3 and isinstance(value[0], (bool, np.bool_)):
        if value[0]:
            lower, upper, *_ = [math.nan if time is None else float(time) for time in value[1:]] + [math.nan]
        return (YES if value[0] else NO), lower, upper
    if isinstance(value, (bool, np.bool_)):
        return (YES if value else NO), lower, upper
    if value is None:
        return NO, lower, upper
    if isinstance(value, (float, np.floating)):
        return (YES, float(value), upper) if math.isfinite(value) else (NO, lower, upper)
    raise TypeError(f"a solver returns a bool, a time (a float or None) or (bool, time), not {value!r}")


def items_of(value: Any, count: int) -> List[Any]:
    """Return the values about the queries of a batch.

    Raises
    ------
    ValueError
        If a solver of batches returned arrays of another shape.
    """
    parts = [np.asarray(part) for part in (value if isinstance(value, tuple) else (value,))]
    if any(part.shape != (count,) for part in parts):
        raise ValueError(f"a solver of a batch of {count} returned shapes {[part.shape for part in parts]}")
    return list(zip(*parts)) if isinstance(value, tuple) else list(parts[0])


def ask(solver: Dict[str, Any], fields: List[Any], data: bytes) -> List[Answer]:
    """Return the solver's answers to a request about queries."""
    kind, count, tolerance, max_checks, separation, t_max, norm = fields
    queries = np.frombuffer(bytearray(data)).reshape(count, 8, 3)
    options = {
        "separation": separation,
        "norm": ("linf", "l2")[norm],
        "tolerance": tolerance,
        "max_checks": max_checks,
        "t_max": t_max,
    }
    given = {name: options[name] for name in solver["options"]}
    function = solver["function"]
    if solver["batch"]:
        return [answer_from(item) for item in items_of(function(KINDS[kind], queries, **given), count)]
    return [answer_from(function(KINDS[kind], query, **given)) for query in queries]


def serve(solver: Dict[str, Any], requests: BinaryIO, replies: BinaryIO) -> None:
    """Answer until the other end is closed.

    Each request has a number, which its reply repeats, together with the number of the process that writes it. A copy
    of this process that the solver made ends here, where it comes back from the solver.
    """
    process = os.getpid()
    while True:
        head = requests.read(REQUEST.size)
        if len(head) < REQUEST.size:
            return
        number, *fields = REQUEST.unpack(head)
        data = requests.read(fields[1] * QUERY_BYTES)
        try:
            answers = ask(solver, fields, data)
            reply = REPLY.pack(number, os.getpid(), -1) + b"".join(ANSWER.pack(*answer, math.nan) for answer in answers)
        except Exception as error:
            text = traceback.format_exception_only(type(error), error)[-1].strip().encode()
            reply = REPLY.pack(number, os.getpid(), len(text)) + text
        sys.stdout.flush()
        if os.getpid() != process:
            os._exit(0)
        replies.write(reply)
        replies.flush()


def main() -> None:
    """Serve the solver of the file that the command line names."""
    with open(sys.argv[-1], "rb") as file:
        path, program = pickle.load(file)
    sys.path[:] = path
    solver: Dict[str, Any] = pickle.loads(program)
    serve(solver, os.fdopen(os.dup(SOCKET), "rb"), os.fdopen(SOCKET, "wb"))


if __name__ == "__main__":
    main()
