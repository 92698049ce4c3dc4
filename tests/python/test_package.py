"""The package itself: its version, its types, and the examples of its documentation."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pathlib
import pkgutil
import re
import subprocess
import sys

import pytest

import touchstone

ROOT = pathlib.Path(__file__).parents[2]
MODULES = [
    name
    for _, name, _ in pkgutil.walk_packages(touchstone.__path__, "touchstone.")
    if not name.split(".")[-1].startswith("_") or name.endswith("_input")
]


class Finder(doctest.DocTestFinder):
    """Finds functions also behind a decorator."""

    def _from_module(self, module, object):
        return super()._from_module(module, inspect.unwrap(object))


@pytest.mark.parametrize("name", ["touchstone", *MODULES])
def test_examples_of_docstrings(name):
    module = importlib.import_module(name)
    found = Finder().find(module, name)
    runner = doctest.DocTestRunner()
    assert [one.name for one in found if runner.run(one).failed] == []
    source = pathlib.Path(module.__file__).read_text()
    assert sum(len(one.examples) for one in found) == len(re.findall(r"^ *>>> ", source, re.MULTILINE))


def test_the_version_is_that_of_the_project():
    text = (ROOT / "CMakeLists.txt").read_text()
    assert f"VERSION {touchstone.__version__} " in text
    assert touchstone.__commit__ == "" or len(touchstone.__commit__.split("-")[0]) >= 7
    assert touchstone.instruction_set() in {"scalar", "avx2", "avx512", "neon"}


def test_the_recipe_of_conda_says_what_the_project_says():
    recipe = (ROOT / "packaging/meta.yaml").read_text()
    pattern = re.search(r'load_file="../CMakeLists.txt", regex_pattern="(.*?)"', recipe)[1]
    assert re.search(pattern, (ROOT / "CMakeLists.txt").read_text())[1] == touchstone.__version__
    needed = re.findall(r"Requires-Dist: (.*?)(>=.*)", (ROOT / "python/METADATA.in").read_text())
    run = re.search(r"^  run: \[(.*)\]$", recipe, re.MULTILINE)[1].split(", ")
    assert {f"{name} {version}" for name, version in needed} | {"python", "tbb"} == set(run)
    options = "".join(path.read_text() for path in (ROOT / "CMakeLists.txt", *(ROOT / "cmake").glob("*.cmake")))
    assert [one for one in re.findall(r"-D(TOUCHSTONE_\w+)", recipe) if f"option({one} " not in options] == []


def test_former_names_are_refused_with_the_new_ones():
    for name, new in (("certified", "solve"), ("certify", "judge"), ("decide_curved", "decide"), ("CurvedStep", "Step"),
                      ("PairKind", "ContactKind"), ("VolumeKind", "CellKind"), ("ElementKind", "PrimitiveKind"), ("frobnicate", None)):
        text = rf"^touchstone\.{name} has become touchstone\.{new}\(" if new else "has no attribute 'frobnicate'"
        with pytest.raises(AttributeError, match=text):
            getattr(touchstone, name)
    with pytest.raises(TypeError, match=r"has become solve\(kind, queries, method="):
        touchstone.solve("accd", "edge_edge", [])
    for wrong, text in (({"tolerance": 0.5}, "has toi_tolerance"), ({"method": "accd", "toi_tolerance": 0.5}, "has tolerance")):
        with pytest.raises(ValueError, match=text):
            touchstone.solve("edge_edge", [], **wrong)


def test_the_fast_part_needs_neither_gmp_nor_cgal():
    module = importlib.import_module("touchstone._fast")
    libraries = subprocess.run(["ldd", module.__file__], check=True, capture_output=True, text=True).stdout
    assert "libstdc++" in libraries
    assert not any(name in libraries for name in ("gmp", "mpfr", "CGAL", "boost", "zip"))


def test_importing_the_package_loads_the_fast_part_alone():
    code = "import sys, touchstone; print([m for m in sys.modules if m.startswith('touchstone._')])"
    loaded = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout
    assert "touchstone._fast" in loaded and "touchstone._exact" not in loaded


def package_folder() -> pathlib.Path:
    return pathlib.Path(touchstone.__file__).parent


def test_types_are_strict(tmp_path):
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, package_folder()]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_a_user_of_the_package_is_checked(tmp_path):
    user = tmp_path / "user.py"
    user.write_text("import touchstone\nanswer: str = touchstone.solve('edge_edge', []).collides\n")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", user]
    done = subprocess.run(command, capture_output=True, text=True, cwd=package_folder().parent)
    assert "Incompatible types in assignment" in done.stdout and "Found 1 error" in done.stdout
