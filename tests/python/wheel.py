"""Packs the wheel, and checks that it holds every library that it needs but the runtimes of C and C++."""

import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

RUNTIMES = re.compile(r"(linux-vdso|ld-linux-[\w-]+|lib(c|m|gcc_s|stdc\+\+|pthread|dl|rt))\.so")

cmake, build = sys.argv[1:]
subprocess.run([cmake, "--build", build, "--target", "touchstone_wheel"], check=True, stdout=subprocess.DEVNULL)
(wheel,) = pathlib.Path(build, "wheel").glob("touchstone-*.whl")
with tempfile.TemporaryDirectory() as folder:
    zipfile.ZipFile(wheel).extractall(folder)
    package = pathlib.Path(folder, "touchstone")
    files = [*package.rglob("*.so*"), package / "bin/touchstone"]
    assert len(files) > 5, files
    for file in files:
        file.chmod(0o755)
        needs = subprocess.run(["ldd", file], check=True, capture_output=True, text=True).stdout.split("\n")
        outside = [line for line in needs if line.strip() and folder not in line and not RUNTIMES.match(line.strip().split("/")[-1])]
        assert not outside, f"{file.name} needs {outside}"
    program = "import touchstone; from touchstone import exact; print(touchstone.__version__)"
    subprocess.run([sys.executable, "-c", program], check=True, env={"PYTHONPATH": folder})
    subprocess.run([package / "bin/touchstone", "certify", "--count", "2"], check=True, stdout=subprocess.DEVNULL, env={})
print(f"{wheel.name}: {len(files)} programs, modules and libraries")
