"""Plot the time of Tight-Inclusion against the error of its times of impact, for tolerances from 1 to 1e-9."""

import sys
import time

import numpy as np

import touchstone


def measure(count: int = 2000) -> list[tuple[float, float, float]]:
    """Return for each tolerance: itself, seconds a query, and the greatest error of a time."""
    queries = np.random.default_rng(2021).normal(size=(count, 8, 3))
    truth = touchstone.solve("edge_edge", queries)
    rows = []
    for tolerance in 10.0 ** -np.arange(0, 10):
        started = time.process_time()
        answer = touchstone.tight_inclusion("edge_edge", queries, tolerance=tolerance, threads=1)
        seconds = (time.process_time() - started) / count
        error = np.max(truth.toi_upper[truth.collides] - answer.toi[truth.collides])
        rows.append((tolerance, seconds, float(error)))
    return rows


if __name__ == "__main__":
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rows = np.array(measure())
    plt.loglog(rows[:, 1], rows[:, 2], "o-")
    plt.xlabel("processor time a query (s)")
    plt.ylabel("greatest error of a time of impact")
    plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "time_and_error.svg")
