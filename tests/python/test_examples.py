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
    assert {path.name for path in FOLDER.glob("*.py")} == {*SAYS, "naive_cubic.py", "to_notebooks.py"}


@pytest.mark.parametrize("name", SAYS)
def test_scripts(name, tmp_path):
    done = subprocess.run([sys.executable, FOLDER / name], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [text for text in SAYS[name] if text not in done.stdout] == []
    if name == "time_and_error.py":
        assert "<svg" in (tmp_path / "time_and_error.svg").read_text()


@pytest.fixture(scope="module")
def notebooks(tmp_path_factory):
    """The folder of the examples as notebooks."""
    for name in ("nbformat", "nbconvert", "ipykernel"):
        pytest.importorskip(name)
    folder = tmp_path_factory.mktemp("notebooks")
    subprocess.run([sys.executable, FOLDER / "to_notebooks.py", folder], check=True)
    assert {path.stem for path in folder.iterdir()} == {pathlib.Path(name).stem for name in SAYS}
    return folder


@pytest.mark.parametrize("name", SAYS)
def test_notebooks(name, notebooks):
    """Executed by nbconvert."""
    import nbformat

    stem = pathlib.Path(name).stem
    command = [sys.executable, "-m", "nbconvert", "--execute", "--to", "notebook", "--output", f"{stem}_executed"]
    command += ["--ExecutePreprocessor.timeout=300", f"{stem}.ipynb"]
    done = subprocess.run(command, cwd=notebooks, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    executed = nbformat.read(notebooks / f"{stem}_executed.ipynb", as_version=4)
    printed = "".join(output.get("text", "") for cell in executed.cells[1:] for output in cell.outputs)
    assert [text for text in SAYS[name] if text not in printed] == []


def test_the_first_minute_of_the_document(tmp_path):
    """The five lines of docs/python.md, with fewer queries."""
    text = (FOLDER.parents[1] / "docs/python.md").read_text()
    code = text.split("```python\n")[1].split("```")[0].replace("10_000_000", "10_000")
    assert len(code.strip().splitlines()) == 5
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=dict(os.environ))
    assert "CertifiedResult: 10000 queries" in done.stdout
