"""The certified solver under four names of ipctk, the Python package of the IPC Toolkit.

Replace ``import ipctk`` by ``from touchstone import ipctk_names as ipctk`` where these functions are called:
names of arguments, defaults and results are the same. A result is ``(collides, toi)``.

With d the distance of the primitives at t=0 and d_min `min_distance`, both in L2:

- d <= d_min: ``(True, 0.0)``, decided exactly.
- Else the primitives may come as near as d_min + (1 - conservative_rescaling) (d - d_min). ``(True, toi)`` if they
  come that near up to tmax: then toi is before that time, by at most 1e-12 of it, and positive unless that time is below
  the least double. ``(False, inf)`` if they do not.

There is no tolerance and no limit of iterations: `tolerance` and `max_iterations` are accepted and have no effect.
For many queries use `touchstone.solve`, which takes them all in one call.
"""

from __future__ import annotations

from typing import Tuple

import numpy as np
import numpy.typing as npt

from ._input import ContactName, as_doubles, checked
from .batch import distance, solve

__all__ = ["edge_edge_ccd", "point_edge_ccd", "point_point_ccd", "point_triangle_ccd"]

Point = npt.ArrayLike


@checked
def _decide(
    kind: ContactName, points: Tuple[Point, ...], min_distance: float, tmax: float, conservative_rescaling: float
) -> Tuple[bool, float]:
    if not 0.0 <= conservative_rescaling <= 1.0:
        raise ValueError("conservative_rescaling must be in [0, 1]")
    if not 0.0 <= min_distance < np.inf:
        raise ValueError("min_distance must be finite and not negative")
    if not 0.0 <= tmax <= 1.0:
        raise ValueError("tmax must be in [0, 1]")
    rows = [as_doubles(point, "point").reshape(-1) for point in points]
    size = rows[0].size
    if size not in (2, 3) or any(row.size != size for row in rows):
        raise ValueError("points must all have two coordinates, or all three")
    query = np.zeros((8, 3))
    query[:, :size] = rows
    if not np.isfinite(query).all():
        return True, 0.0  # nothing moves
    at_start = distance(kind, query, norm="l2")
    lower = float(at_start.lower)
    if at_start.upper <= min_distance:
        return True, 0.0
    wanted = min_distance + (1.0 - conservative_rescaling) * (lower - min_distance)
    near = max(min_distance, min(wanted, float(np.nextafter(lower, 0.0))))
    answer = solve(kind, query, separation=near, norm="l2", t_max=tmax)
    return bool(answer.collides), float(answer.toi_lower) if answer.collides else np.inf


def point_triangle_ccd(
    p_t0: Point,
    t0_t0: Point,
    t1_t0: Point,
    t2_t0: Point,
    p_t1: Point,
    t0_t1: Point,
    t1_t1: Point,
    t2_t1: Point,
    min_distance: float = 0.0,
    tmax: float = 1.0,
    tolerance: float = 1e-6,
    max_iterations: int = 10_000_000,
    conservative_rescaling: float = 0.8,
) -> Tuple[bool, float]:
    """Return whether and when a point and a triangle collide.

    Examples
    --------
    >>> from touchstone import ipctk_names as ipctk
    >>> triangle = [0.0, 0, 0], [1, 0, 0], [0, 1, 0]
    >>> hit, toi = ipctk.point_triangle_ccd([0.25, 0.25, 1.0], *triangle, [0.25, 0.25, -1.0], *triangle)
    >>> hit, round(toi, 6)
    (True, 0.4)
    """
    points = (p_t0, t0_t0, t1_t0, t2_t0, p_t1, t0_t1, t1_t1, t2_t1)
    return _decide("vertex_face", points, min_distance, tmax, conservative_rescaling)


def edge_edge_ccd(
    ea0_t0: Point,
    ea1_t0: Point,
    eb0_t0: Point,
    eb1_t0: Point,
    ea0_t1: Point,
    ea1_t1: Point,
    eb0_t1: Point,
    eb1_t1: Point,
    min_distance: float = 0.0,
    tmax: float = 1.0,
    tolerance: float = 1e-6,
    max_iterations: int = 10_000_000,
    conservative_rescaling: float = 0.8,
) -> Tuple[bool, float]:
    """Return whether and when two edges collide."""
    points = (ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1)
    return _decide("edge_edge", points, min_distance, tmax, conservative_rescaling)


def point_edge_ccd(
    p_t0: Point,
    e0_t0: Point,
    e1_t0: Point,
    p_t1: Point,
    e0_t1: Point,
    e1_t1: Point,
    min_distance: float = 0.0,
    tmax: float = 1.0,
    tolerance: float = 1e-6,
    max_iterations: int = 10_000_000,
    conservative_rescaling: float = 0.8,
) -> Tuple[bool, float]:
    """Return whether and when a point and an edge collide, in two or three dimensions."""
    points = (p_t0, e0_t0, e1_t0, e0_t0, p_t1, e0_t1, e1_t1, e0_t1)
    return _decide("vertex_face", points, min_distance, tmax, conservative_rescaling)


def point_point_ccd(
    p0_t0: Point,
    p1_t0: Point,
    p0_t1: Point,
    p1_t1: Point,
    min_distance: float = 0.0,
    tmax: float = 1.0,
    tolerance: float = 1e-6,
    max_iterations: int = 10_000_000,
    conservative_rescaling: float = 0.8,
) -> Tuple[bool, float]:
    """Return whether and when two points collide, in two or three dimensions."""
    points = (p0_t0, p1_t0, p1_t0, p1_t0, p0_t1, p1_t1, p1_t1, p1_t1)
    return _decide("vertex_face", points, min_distance, tmax, conservative_rescaling)
