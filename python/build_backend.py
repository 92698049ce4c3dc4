"""What pip asks (PEP 517): CMake makes the wheel, by the target touchstone_wheel, and the source archive holds what that takes.

Without settings the wheel has the fast part. `pip wheel . -C TOUCHSTONE_BUILD_EXACT=ON …` sets options of CMake.
"""

import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SOURCES = ["CMakeLists.txt", "LICENSE", "pyproject.toml", "cmake", "exact", "fast", "filters", "python", "tests/portability"]
PARTS = {f"TOUCHSTONE_BUILD_{name}": "OFF" for name in ("EXACT", "DERIVATION", "ADAPTERS", "TOOL", "TESTS")}


def project():
    """Version and description of CMakeLists.txt."""
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r'project\(touchstone VERSION ([0-9.]+).*?DESCRIPTION "(.*?)"', text, re.DOTALL).groups()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    options = {"CMAKE_BUILD_TYPE": "Release", "Python_EXECUTABLE": sys.executable, "TOUCHSTONE_BUILD_PYTHON": "ON",
               "TOUCHSTONE_WERROR": "OFF", "CMAKE_UNITY_BUILD": "ON", "CMAKE_UNITY_BUILD_BATCH_SIZE": "16", **PARTS, **(config_settings or {})}
    try:
        import pybind11

        options.setdefault("pybind11_DIR", pybind11.get_cmake_dir())
    except ImportError:  # Debian's package for C++ has no module
        pass
    with tempfile.TemporaryDirectory() as build:
        defines = [f"-D{name}={value}" for name, value in options.items()]
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", *defines], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "touchstone_wheel"], check=True)
        (wheel,) = pathlib.Path(build, "wheel").glob("*.whl")
        shutil.copy(wheel, wheel_directory)
    return wheel.name


def build_sdist(sdist_directory, config_settings=None):
    version, description = project()
    top = f"touchstone-{version}"
    metadata = (ROOT / "python/METADATA.in").read_text()
    metadata = metadata.replace("@PROJECT_VERSION@", version).replace("@PROJECT_DESCRIPTION@", description).encode()
    with tarfile.open(pathlib.Path(sdist_directory, f"{top}.tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as archive:
        entry = tarfile.TarInfo(f"{top}/PKG-INFO")
        entry.size = len(metadata)
        archive.addfile(entry, io.BytesIO(metadata))
        for name in SOURCES:
            archive.add(ROOT / name, f"{top}/{name}", filter=lambda one: None if "__pycache__" in one.name else one)
    return os.path.basename(archive.name)
