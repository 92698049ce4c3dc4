"""Find the missed contact in a sequence of frames.

Two sheets fall through each other in ten frames. A test of each frame by itself sees nothing, as no frame has
an intersection; the steps between them do.
"""

import numpy as np

import touchstone


def sheet(cells: int, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices and the faces of a square sheet that is bent like a bowl."""
    x, y = np.meshgrid(np.linspace(-1, 1, cells + 1), np.linspace(-1, 1, cells + 1))
    vertices = np.stack([x, y, height + 0.1 * (x**2 + y**2)], axis=-1).reshape(-1, 3)
    first = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    lower = np.stack([first, first + 1, first + cells + 2], axis=1)
    upper = np.stack([first, first + cells + 2, first + cells + 1], axis=1)
    return vertices, np.concatenate([lower, upper])


def frames(cells: int = 20) -> tuple[list[np.ndarray], np.ndarray, np.ndarray]:
    """Return the frames, the faces and the group of each vertex."""
    upper, faces = sheet(cells, 1.0)
    lower, _ = sheet(cells, 0.0)
    fall = np.array([0, 0, -0.26])
    all_faces = np.concatenate([faces, faces + len(upper)])
    groups = np.repeat([0, 1], len(upper))
    return [np.concatenate([upper + i * fall, lower]) for i in range(8)], all_faces, groups


if __name__ == "__main__":
    sequence, faces, groups = frames()
    # Within a sheet nothing collides: only the two are of interest.
    step = touchstone.Step(
        sequence[0], sequence[1], faces=faces, groups=groups, apart=[[0, 0], [1, 1]]
    )
    for number, (before, after) in enumerate(zip(sequence, sequence[1:])):
        step = step.moved(before, after)
        impact = step.earliest()
        if impact is None:
            print(f"step {number}: free; least distance {step.least_distance(t=1.0).lower:.3g}")
            continue
        pair = impact.pairs[0]
        print(f"step {number}: {len(step.collisions())} collisions, the first at t = {impact.toi_lower:.6g}")
        print(f"  between {touchstone.PairKind(pair['kind']).name} {pair['pair']}")
        print(f"  a step size that is free: {step.free_step_size()!r}")
