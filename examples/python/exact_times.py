"""Exact times of impact as algebraic numbers."""

from fractions import Fraction

import numpy as np

import touchstone


def edges_that_meet() -> np.ndarray:
    """Return two edges in whole numbers whose time of impact is irrational."""
    random = np.random.default_rng(3)
    queries = random.integers(-3, 4, size=(200, 8, 3)).astype(float)
    decisions = touchstone.decide("edge_edge", queries)
    is_algebraic = [isinstance(time, touchstone.AlgebraicNumber) for time in decisions.toi]
    return queries[np.flatnonzero(is_algebraic)[0]]


if __name__ == "__main__":
    query = edges_that_meet()
    time = touchstone.decide("edge_edge", query).toi
    terms = " + ".join(f"{c} t^{i}" for i, c in enumerate(time.polynomial))
    print("the time of impact is the root of", terms, "between", time.lower, "and", time.upper)
    close = time.refine(Fraction(1, 10**50))
    digits = close.lower.numerator * 10**40 // close.lower.denominator
    print(f"its first forty digits: 0.{digits:040d}")
    answer = touchstone.solve("edge_edge", query)
    print("the certified solver encloses it:", answer.toi_lower, answer.toi_upper)
    print("a proof:", touchstone.check(touchstone.prove("edge_edge", query)))
