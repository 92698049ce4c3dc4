"""The names of ipctk: the answers of the certified solver with the rules of the toolkit."""

from __future__ import annotations

import inspect

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import touchstone
from touchstone import ipctk_names as ipctk

coordinate = st.integers(-4, 4).map(float)


def points(count: int, size: int = 3):
    return st.lists(st.lists(coordinate, min_size=size, max_size=size), min_size=count, max_size=count)


def holds_its_promise(answer, kind, query, min_distance, rescaling):
    collides, toi = answer
    at_start = touchstone.distance(kind, query)
    if at_start.upper <= min_distance:
        assert answer == (True, 0.0)
        return
    assert toi > 0 and (collides or toi == np.inf)
    # Before toi nothing comes within min_distance; without a collision never.
    assert not touchstone.solve(
        kind, query, separation=min_distance, norm="l2", t_max=min(toi, 1.0)
    ).collides or rescaling == 1
    if touchstone.solve(kind, query, separation=min_distance, norm="l2").collides:
        assert collides


@given(points(8), st.sampled_from([0.0, 0.5]), st.sampled_from([0.0, 0.5, 0.8, 1.0]))
def test_answers(rows, min_distance, rescaling):
    for function, kind in ((ipctk.point_triangle_ccd, "vertex_face"), (ipctk.edge_edge_ccd, "edge_edge")):
        answer = function(*rows, min_distance=min_distance, conservative_rescaling=rescaling)
        holds_its_promise(answer, kind, np.array(rows), min_distance, rescaling)


@given(points(6, 2))
def test_points_and_edges_in_the_plane(rows):
    flat = [np.array(row) for row in rows]
    deep = [np.append(row, 0.0) for row in flat]
    assert ipctk.point_edge_ccd(*flat) == ipctk.point_edge_ccd(*deep)
    assert ipctk.point_point_ccd(*flat[:4]) == ipctk.point_point_ccd(*deep[:4])
    p, e0, e1, p_, e0_, e1_ = deep
    query = np.array([p, e0, e1, e0, p_, e0_, e1_, e0_])
    holds_its_promise(ipctk.point_edge_ccd(*deep), "vertex_face", query, 0.0, 0.8)


def test_names_of_arguments():
    names = list(inspect.signature(ipctk.point_edge_ccd).parameters)
    assert names[:6] == ["p_t0", "e0_t0", "e1_t0", "p_t1", "e0_t1", "e1_t1"]
    for function in map(vars(ipctk).get, ipctk.__all__):
        assert list(inspect.signature(function).parameters)[-5:] == [
            "min_distance", "tmax", "tolerance", "max_iterations", "conservative_rescaling",
        ]


def test_bad_arguments():
    good = [np.zeros(3), np.ones(3), np.zeros(3), np.ones(3)]
    for change, text in [
        ({"min_distance": -1.0}, "min_distance"),
        ({"tmax": 2.0}, "tmax"),
        ({"conservative_rescaling": 1.5}, "conservative_rescaling"),
    ]:
        with pytest.raises(ValueError, match=text):
            ipctk.point_point_ccd(*good, **change)
    with pytest.raises(ValueError, match="two coordinates, or all three"):
        ipctk.point_point_ccd(np.zeros(2), np.ones(3), np.zeros(3), np.ones(3))
    assert ipctk.point_point_ccd(*(np.full(3, np.nan),) * 4) == (True, 0.0)
