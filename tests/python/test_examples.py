"""The examples run."""

from __future__ import annotations

import pathlib
import subprocess
import sys

import pytest

FOLDER = pathlib.Path(__file__).parents[2] / "examples/python"

SAYS = {
    "missed_contact.py": ["step 2: free", "step 3: 17798 collisions", "step 4: free"],
    "time_and_error.py": [],
    "exact_times.py": ["the time of impact is the root of", "1 accepted, 0 rejected"],
    "judge_a_solver.py": ["naive_cubic", "false_negative", "1 accepted, 0 rejected"],
}


def test_every_example_is_tested():
    assert {path.name for path in FOLDER.glob("*.py")} == {*SAYS, "naive_cubic.py"}


@pytest.mark.parametrize("name", SAYS)
def test_scripts(name, tmp_path):
    done = subprocess.run([sys.executable, FOLDER / name], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [text for text in SAYS[name] if text not in done.stdout] == []
    if name == "time_and_error.py":
        assert "<svg" in (tmp_path / "time_and_error.svg").read_text()
