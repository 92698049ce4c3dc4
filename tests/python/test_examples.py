"""The examples run, as scripts and as notebooks."""

from __future__ import annotations

import os
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


@pytest.mark.parametrize("name", SAYS)
def test_notebooks(name, tmp_path):
    """Each script as the cell of a notebook, executed by nbconvert."""
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    code = (FOLDER / name).read_text().replace("sys.argv", "['example']").replace("__file__", repr(str(FOLDER / name)))
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)]), tmp_path / "example.ipynb")
    command = [sys.executable, "-m", "nbconvert", "--execute", "--to", "notebook", "--output", "executed"]
    command += ["--ExecutePreprocessor.timeout=300", "example.ipynb"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    executed = nbformat.read(tmp_path / "executed.ipynb", as_version=4)
    printed = "".join(output.get("text", "") for output in executed.cells[0].outputs)
    assert [text for text in SAYS[name] if text not in printed] == []


def test_the_first_minute_of_the_document(tmp_path):
    """The five lines of docs/python.md, with fewer queries."""
    text = (FOLDER.parents[1] / "docs/python.md").read_text()
    code = text.split("```python\n")[1].split("```")[0].replace("10_000_000", "10_000")
    assert len(code.strip().splitlines()) == 5
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=dict(os.environ))
    assert "CertifiedResult: 10000 queries" in done.stdout
