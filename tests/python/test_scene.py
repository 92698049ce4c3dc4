"""Steps of a scene: the answers of batches on their pairs, and the reasons for errors."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import touchstone
from touchstone import ContactKind, Step


def soup(seed: int, triangles: int = 40) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    before = (random.normal(size=(triangles, 1, 3)) * 3 + random.normal(size=(triangles, 3, 3))).reshape(-1, 3)
    after = before + random.normal(size=before.shape)
    return {"before": before, "after": after, "faces": np.arange(3 * triangles).reshape(-1, 3)}


def in_order(items: np.ndarray) -> list:
    """Items in an order that does not depend on the search."""
    return sorted(map(str, items.tolist()))


@given(st.integers(0, 1000), st.sampled_from([0.0, 0.01, 1.0]), st.sampled_from(["linf", "l2"]))
def test_collisions_are_those_of_the_candidates(seed, separation, norm):
    step = Step(**soup(seed, 8), separation=separation, norm=norm)
    expected = {}
    for pair in step.candidates():
        answer = touchstone.solve(
            ContactKind(pair["kind"]).name.lower(), step.query(pair["kind"], pair["pair"]), separation=separation, norm=norm
        )
        if answer.collides:
            expected[pair["kind"], *pair["pair"]] = (answer.toi_lower, answer.toi_upper)
    found = {(c["kind"], *c["pair"]): (c["toi_lower"], c["toi_upper"]) for c in step.collisions()}
    assert found == expected
    assert step.is_free() == (not found)
    impact = step.earliest()
    assert (impact is None) == (not found)
    if impact is not None:
        assert impact.toi_lower == min(lower for lower, _ in found.values())
        assert impact.toi_upper == min(upper for _, upper in found.values())


@pytest.mark.parametrize("dtype", [np.int32, np.int64, np.uint8])
def test_types_of_indices(dtype):
    scene = soup(1)
    expected = Step(**scene).collisions()
    assert len(expected) > 0
    scene["faces"] = scene["faces"].astype(dtype)
    for faces in (scene["faces"], np.asfortranarray(scene["faces"]), scene["faces"].tolist()):
        assert (Step(**{**scene, "faces": faces}).collisions() == expected).all()


def test_vertices_alone_are_free():
    places = np.arange(6.0).reshape(2, 3)
    step = Step(places, places)
    assert step.is_free() and step.prove().claim == "no_contact 1"


def test_moved_is_a_step_of_its_own():
    first, second = soup(3), soup(4)
    step = Step(**first)
    moved = step.moved(second["before"], second["after"])
    del step
    assert in_order(moved.collisions()) == in_order(Step(**second).collisions())
    wide = moved.moved(second["before"], second["after"], separation=0.5, norm="l2")
    assert in_order(wide.collisions()) == in_order(Step(**second, separation=0.5, norm="l2").collisions())
    # The next step keeps the separation.
    assert (wide.moved(second["before"], second["after"]).collisions() == wide.collisions()).all()


def test_points_edges_and_groups():
    before = np.array([[0.0, 0, 1], [-1, 0, 0], [1, 0, 0], [0, 0, 2]])
    after = np.array([[0.0, 0, -1], [-1, 0, 0], [1, 0, 0], [0, 0, -3]])
    step = Step(before, after, edges=[[1, 2]], points=[0, 3])
    kinds = {ContactKind(c["kind"]) for c in step.collisions()}
    assert kinds == {ContactKind.VERTEX_EDGE, ContactKind.VERTEX_VERTEX}
    assert step.edges.tolist() == [[1, 2]]
    apart = Step(before, after, edges=[[1, 2]], points=[0, 3], groups=[0, 1, 1, 2], apart=[[0, 2], [1, 2]])
    assert [(ContactKind(c["kind"]), *c["pair"]) for c in apart.collisions()] == [(ContactKind.VERTEX_EDGE, 0, 0)]


def test_spheres_and_capsules_of_different_radii():
    before = np.array([[0.0, 3, 9], [-9, 0, 0], [9, 0, 0], [0, 8, 9]])
    after = before * [1, 1, 0] + [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 9]]
    scene = dict(edges=[[1, 2]], points=[0, 3], groups=[0, 1, 1, 2])
    step = Step(before, after, **scene, radii=[2, 3, 0.5])
    # The axes are 5 = √(3² + 4²) apart at z = 4.
    assert [(c["kind"], *c["pair"]) for c in step.collisions()] == [(ContactKind.VERTEX_EDGE, 0, 0)]
    assert abs(step.earliest().toi_lower - 5 / 9) < 1e-9
    assert step.least_distance().lower == 2.5
    assert step.moved(after, after).least_distance().lower == -2.0
    assert step.prove().claim.startswith("earliest 0x1.1c71c71c71c7")
    thin = Step(before, after, **scene, radii=[2, 3, 0.5], separations={(1, 0): 2.75})
    assert thin.is_free() and abs(thin.moved(after, after).least_distance().lower - 0.25) == 0
    with pytest.raises(ValueError, match="groups 0 and 1 have two separations"):
        Step(before, after, **scene, separations={(0, 1): 1.0, (1, 0): 1.0})


def test_a_rule_for_pairs_of_vertices():
    scene = soup(4, 20)
    half = len(scene["before"]) // 2
    asked = set()

    def rule(a, b):
        asked.add((type(a), type(b)))
        return (a < half) != (b < half)

    groups = (np.arange(2 * half) >= half).astype(int)
    expected = Step(**scene, groups=groups, apart=[[0, 0], [1, 1]])
    step = Step(**scene, can_collide=rule)
    assert in_order(step.collisions()) == in_order(expected.collisions()) and len(step.collisions()) > 0
    assert asked == {(int, int)}
    assert step.least_distance().lower == expected.least_distance().lower
    with pytest.raises(ValueError, match="can_collide"):
        step.prove()

    def broken(a, b):
        raise KeyError("broken")

    with pytest.raises(KeyError, match="broken"):
        Step(**scene, can_collide=broken).earliest()
    with pytest.raises(TypeError, match="can_collide"):
        Step(**scene, can_collide=3)


def test_distances_active_sets_and_line_searches():
    triangle = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]])
    before = np.concatenate([triangle, triangle + [0.25, 0.25, 2]])
    after = np.concatenate([triangle, triangle + [0.25, 0.25, -2]])
    step = Step(before, after, faces=[[0, 1, 2], [3, 4, 5]])
    least = step.least_distance()
    assert least.lower == least.upper == 2.0 and len(least.pairs) > 0
    assert step.least_distance(t=0.25, norm="linf").lower == 1.0
    limit = step.line_search_limit(0.5)
    assert limit.status == "limited" and limit.distance_lower == 2.0 and 0.25 - 1e-9 < limit.step_size <= 0.25
    contacts = step.active_set(0.5)
    gap = contacts["points"][:, 0] - contacts["points"][:, 1]
    assert len(contacts) > 0 and np.allclose(gap, 0.5 * contacts["normal"], rtol=0, atol=1e-6)
    assert (contacts["normal_error"] < 1e-9).all() and contacts["has_side"].all()
    touching = step.moved(np.concatenate([triangle, triangle]), after)
    assert touching.line_search_limit(0.5).status == "in_contact" and touching.free_step_size() is None
    alone = Step(triangle, triangle, faces=[[0, 1, 2]])
    assert alone.earliest() is None and alone.least_distance() is None and alone.free_step_size() == 1.0
    short = Step(before, after, faces=[[0, 1, 2], [3, 4, 5]], t_max=0.25)
    assert short.is_free() and short.free_step_size() == 0.25


def test_curves():
    line = np.array([[[1, 1, 1.0], [1, 1, -1]], *([[x, y, 0]] * 2 for x, y in ((0, 0), (4, 0), (0, 4)))])
    bent = np.stack([line[:, 0], line[:, 0], line[:, 1]], axis=1)  # z = 1 - 2 t^2
    weighted = np.concatenate([line, np.ones((4, 2, 1))], axis=2)
    weighted[:, 1, 3] = 3
    for points, time in ((line, 0.5), (bent, np.sqrt(0.5)), (weighted, 0.25)):
        step = Step(points, faces=[[1, 2, 3]], points=[0])
        impact = step.earliest()
        assert impact.toi_lower <= time <= impact.toi_upper and len(step.collisions()) == 1
        assert step.moved(points, separation=0.125).earliest().toi_upper < time
        assert Step(points, faces=[[1, 2, 3]], points=[0], t_max=time - 1e-9).is_free()
    for ask in (step.free_step_size, step.least_distance, step.contacts, lambda: step.line_search_limit(0.5)):
        with pytest.raises(ValueError, match="straight lines are needed, not curves"):
            ask()
    for wrong in (line[0], line[:, :, :2], line[:, :1]):
        with pytest.raises(ValueError, match="control points must have the shape"):
            Step(wrong)


def test_contacts_of_collisions():
    triangle = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]])
    step = Step(
        np.concatenate([triangle, triangle / 4 + [0.5, 0.5, 2]]),
        np.concatenate([triangle, triangle / 4 + [0.5, 0.5, -2]]),
        faces=[[0, 1, 2], [3, 4, 5]],
    )
    contacts, collisions = step.contacts(), step.collisions()
    assert contacts["pair"].tolist() == collisions["pair"].tolist() and contacts["normal"].tolist() == [[0, 0, 1]] * 3
    exact = [[0.5 + x, 0.5 + y, 0] for x, y in [(0, 0), (1, 0), (0, 1)]]
    assert np.abs(contacts["points"] - np.array(exact)[:, None]).max() < 1e-9 and contacts["point_error"].max() < 1e-9
    some = step.contacts(step.earliest().pairs[::2])
    assert some["pair"].tolist() == step.earliest().pairs["pair"][::2].tolist()
    assert len(step.contacts(collisions[:0])) == 0
    for wrong in (contacts, np.zeros(3), [1]):
        with pytest.raises(ValueError, match="collisions"):
            step.contacts(wrong)
    for field, value, error in [("pair", 9, IndexError), ("kind", 7, ValueError), ("toi_lower", 2.0, ValueError)]:
        wrong = collisions.copy()
        wrong[field] = value
        with pytest.raises(error):
            step.contacts(wrong)


@pytest.mark.parametrize(
    "change, error, text",
    [
        ({"before": np.zeros((3, 2))}, ValueError, r"before must have the shape \(n, 3\), not \(3, 2\)"),
        ({"after": np.zeros((2, 3))}, ValueError, "as many rows"),
        ({"after": [[0, 0, 0], [0, np.nan, 0], [0, 0, 0]]}, ValueError, "vertex 1"),
        ({"faces": [[0, 1, 3]]}, IndexError, "face 0"),
        ({"faces": [[0, 1]]}, ValueError, r"faces must have the shape \(n, 3\), not \(1, 2\)"),
        ({"faces": [[0.0, 1.0, 2.0]]}, ValueError, "array of integers is needed, not of float64"),
        ({"faces": [[0, 1, 2**40]]}, IndexError, r"faces\[0, 2\]: 1099511627776"),
        ({"edges": [[0, -1]]}, IndexError, r"edges\[0, 1\]: -1"),
        ({"points": [7]}, IndexError, "7"),
        ({"groups": [0, 1]}, ValueError, "group"),
        ({"apart": [[0, 3]]}, ValueError, "apart names group 3, but no vertex is in it"),
        ({"radii": [[1.0]]}, ValueError, r"radii must have the shape \(g,\), not \(1, 1\)"),
        ({"radii": [-1.0]}, ValueError, "the radius of group 0 must be finite and not negative"),
        ({"separations": {(0, 0): np.inf}}, ValueError, "the separation of groups 0 and 0"),
        ({"separations": {0: 1.0}}, ValueError, "separations must have the shape"),
        ({"separation": -1}, ValueError, "separation must be a finite number"),
        ({"norm": "l3"}, ValueError, "norm must be"),
        ({"t_max": 3.0}, ValueError, "t_max"),
        ({"threads": -1}, ValueError, "threads"),
    ],
)
def test_errors(change, error, text):
    scene = {"before": np.zeros((3, 3)), "after": np.zeros((3, 3)), "faces": [[0, 1, 2]]}
    with pytest.raises(error, match=text):
        Step(**{**scene, **change})


def test_errors_of_methods():
    step = Step(np.eye(3), np.eye(3), faces=[[0, 1, 2]])
    for call, error, text in [
        (lambda: step.line_search_limit(1.0), ValueError, ""),
        (lambda: step.least_distance(t=2.0), ValueError, ""),
        (lambda: step.active_set(-1.0), ValueError, "separation"),
        (lambda: step.query(ContactKind.VERTEX_FACE, [0, 5]), IndexError, ""),
        (lambda: step.query(ContactKind.VERTEX_FACE, [0.5, 0.0]), ValueError, "pair: an array of integers is needed, not of float64"),
    ]:
        with pytest.raises(error, match=text):
            call()
    assert Fraction(step.free_step_size()) == 1


@pytest.mark.parametrize("scale", [2.0**-900, 1.0, 2.0**900])
def test_intersections_are_enclosed_and_named(scale):
    """An edge of the second face passes through the first one; the segment that they share is between doubles."""
    vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 2], [9, 9, 0]]) * scale
    faces = [[0, 1, 2], [3, 4, 5]]
    found = touchstone.intersections(vertices, faces)
    assert found["kind"].tolist() == [touchstone.IntersectionKind.EDGE_THROUGH_FACE]
    assert (found["elements"] == touchstone.PrimitiveKind.FACE).all() and found["numbers"].tolist() == [[0, 1]]
    ends = np.array([[1, 1, 0], [2, 2, 0]]) * scale
    assert (found["place"][0, :, 0] <= ends).all() and (ends <= found["place"][0, :, 1]).all()
    assert len(touchstone.intersections(vertices, faces, groups=[0, 0, 0, 1, 1, 1], apart=[[0, 1]])) == 0
    assert len(touchstone.intersections(vertices[:3], faces[:1])) == 0
    np.testing.assert_array_equal(touchstone.intersections(vertices, faces, threads=1), found)


def test_intersections_of_vertices_at_one_place_need_a_weld():
    soup = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    faces = [[0, 1, 2], [3, 5, 4]]
    assert len(touchstone.intersections(soup, faces)) == 1
    assert len(touchstone.intersections(soup, faces, weld=True)) == 0
    with pytest.raises(ValueError, match="vertex 2"):
        touchstone.intersections([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]])
    with pytest.raises(IndexError, match="face 0"):
        touchstone.intersections(soup, [[0, 1, 6]])


def test_a_step_keeps_its_cells_from_inverting(tmp_path):
    """Tetrahedra that turn over, are flat, and grow; and a triangle that turns over in the plane."""
    before = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    after = before * [-2, 1, 1]
    cells = [[0, 1, 2, 3], [0, 1, 1, 3], [1, 0, 2, 3]]
    step = touchstone.Step(before, after, tetrahedra=cells[:1], plane_triangles=[[0, 1, 2]])
    assert step.starts_free() and not step.is_free()
    found = step.inversions()
    assert found["kind"].tolist() == [touchstone.CellKind.TETRAHEDRON, touchstone.CellKind.PLANE_TRIANGLE]
    assert found["cell"].tolist() == [0, 0] and found["start"].tolist() == [1, 1]
    impact = step.earliest()
    assert len(impact.pairs) == 0 and impact.inversions.tolist() == found.tolist()
    assert 0.333 < step.free_step_size() < 1 / 3
    limit = step.line_search_limit(0.5, kept_volume=0.25)  # 1 - 3 t > 1/4
    assert limit.status == "limited" and 0.2499 < limit.step_size < 0.25 and limit.inversions["cell"].tolist() == [0, 0]
    at_rest = touchstone.Step(before, before, tetrahedra=cells)
    assert not at_rest.starts_free() and at_rest.free_step_size() is None
    assert at_rest.inversions()["cell"].tolist() == [1, 2]
    assert at_rest.line_search_limit(0.5).status == "inverted"
    assert step.moved(before, before).is_free()
    proof = step.prove(label="a solid and a triangle")
    assert proof.claim.startswith("earliest 0x1.5555555555555p-2") and proof.label == "a solid and a triangle"
    assert proof.label in touchstone.check(proof.certificate, claim="earliest").steps[0]
    with pytest.raises(IndexError, match="tetrahedron 0: vertex 4"):
        touchstone.Step(before, after, tetrahedra=[[0, 1, 2, 4]])
    with pytest.raises(ValueError, match="kept_volume"):
        step.line_search_limit(0.5, kept_volume=1.0)
