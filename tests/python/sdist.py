"""The source archive builds with pip, without a network, and the package decides a query."""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "python"))
import build_backend  # noqa: E402

ANSWER = """
import importlib.metadata, numpy, touchstone
query = numpy.zeros((8, 3))
query[0], query[4] = (0.25, 0.25, 1), (0.25, 0.25, -2)
query[1:4] = query[5:] = (0, 0, 0), (1, 0, 0), (0, 1, 0)
answer = touchstone.solve("vertex_face", query)
assert answer.toi_lower <= 1 / 3 <= answer.toi_upper, answer
print(importlib.metadata.version("touchstone"), touchstone.__version__)
"""

with tempfile.TemporaryDirectory() as folder:
    archive = build_backend.build_sdist(folder)
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", f"{folder}/venv"], check=True)
    subprocess.run([f"{folder}/venv/bin/pip", "install", "--quiet", "--no-index", "--no-deps", "--no-build-isolation",
                    f"{folder}/{archive}"], check=True)
    said = subprocess.run([f"{folder}/venv/bin/python", "-c", ANSWER], check=True, capture_output=True, text=True, cwd=folder).stdout
    version, _ = build_backend.project()
    assert said == f"{version} {version}\n", said
print(archive)
