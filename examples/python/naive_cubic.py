"""A solver as it is often written: the roots of the coplanarity cubic, then a test of the place.

Judge it, and see it convicted:

    python3 examples/python/judge_a_solver.py
"""

import numpy as np


def naive_cubic(kind, query, tolerance=1e-6):
    """Return the time of impact, or None: the method of textbooks, in floating point."""
    x0, x1 = query[:4], query[4:]
    if kind == "vertex_face":
        first, second, third = (0, 1), (2, 1), (3, 1)
    else:
        first, second, third = (2, 0), (1, 0), (3, 2)

    def difference(x, pair):
        return x[pair[0]] - x[pair[1]]

    # det(a + t a', b + t b', c + t c') at four times gives the cubic.
    times = np.array([0.0, 1.0, -1.0, 2.0])
    values = [
        np.linalg.det([difference(x0 + t * (x1 - x0), pair) for pair in (first, second, third)])
        for t in times
    ]
    roots = np.roots(np.polyfit(times, values, 3))
    for t in sorted(root.real for root in roots if abs(root.imag) < tolerance and 0 <= root.real <= 1):
        x = x0 + t * (x1 - x0)
        r, p, q = (difference(x, pair) for pair in (first, second, third))
        sign = 1 if kind == "vertex_face" else -1
        (u, v), *_ = np.linalg.lstsq(np.stack([p, sign * q], axis=1), r, rcond=None)
        inside = u >= 0 and v >= 0 and (u + v <= 1 if kind == "vertex_face" else max(u, v) <= 1)
        if inside:
            return t
    return None
