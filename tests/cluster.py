#!/usr/bin/python3
"""Runs the recipes of examples/cluster, each with a part killed, and compares the sums.

    tests/cluster.py --tool build/release/touchstone [ENGINE…]

Engines that this machine lacks are left out, loudly; where all are left out the status is 77. For Slurm a cluster of this
machine alone is started if none is there (as root).
"""

import argparse
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
RECIPES = {"parallel": "parallel.sh", "mpirun": "mpirun.sh", "slurm": "slurm.sh", "dask": "dask_run.py"}
PARTS = 3
SLURM = """ClusterName=touchstone
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
ReturnToService=2
SlurmctldTimeout=30
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
NodeName={host} NodeAddr=127.0.0.1 CPUs=2
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def kill_worker(folder):
    """Kill a process of a part of the run in this folder as soon as there is one; True if one was found."""
    for _ in range(6000):
        for process in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = process.read_bytes().split(b"\0")
            except OSError:
                continue
            is_of_run = any(word.startswith(f"{folder}/".encode()) for word in words)
            if b"--shard" in words and is_of_run and words[0].endswith(b"touchstone"):
                os.kill(int(process.parent.name), signal.SIGKILL)
                return True
        time.sleep(0.01)
    return False


def counts(result):
    """The result of a run without times, means and the order of its sources."""
    if isinstance(result, dict):
        return {key: counts(value) for key, value in result.items() if "_per_" not in key}
    if isinstance(result, list):
        return sorted(map(counts, result), key=json.dumps)
    return result


def start_slurm(folder):
    """Start a cluster of this machine; return its processes, or nothing where that is not possible."""
    if os.geteuid() != 0 or not all(map(shutil.which, ("munged", "slurmctld", "slurmd", "sbatch"))):
        return None
    host = socket.gethostname()
    (folder / "state").mkdir()
    (folder / "spool").mkdir()
    (folder / "slurm.conf").write_text(SLURM.format(host=host, folder=folder))
    (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
    os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
    key = pathlib.Path("/etc/munge/munge.key")
    if not key.exists():
        return None
    pathlib.Path("/run/munge").mkdir(exist_ok=True)
    shutil.chown("/run/munge", "munge", "munge")
    subprocess.run(["su", "munge", "-s", "/bin/sh", "-c", "munged"], capture_output=True)  # may run already
    processes = [subprocess.Popen([name, "-D"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                 for name in ("slurmctld", "slurmd")]
    for _ in range(40):
        states = subprocess.run(["sinfo", "-h", "-o", "%t"], capture_output=True, text=True).stdout
        if "idle" in states:
            return processes
        time.sleep(0.5)
    for process in processes:
        process.kill()
    return None


def run_engine(engine, tool, data, expected, folder):
    """Return what went wrong; nothing if all is well."""
    run = folder / "run"
    recipe = [ROOT / "examples/cluster" / RECIPES[engine], run, str(PARTS), tool, "certify", data, "--method", "cubic"]
    found = []
    killer = threading.Thread(target=lambda: found.append(kill_worker(run)))
    killer.start()
    done = subprocess.run(recipe, capture_output=True, text=True, cwd=folder)
    killer.join()
    if not found[0]:
        return "no worker was there to be killed"
    if done.returncode != 1:  # the cubic solver is wrong
        return f"status {done.returncode}: {done.stdout}{done.stderr}"
    if counts(json.loads(run.with_suffix(".json").read_text())) != expected:
        return "the sum differs from the result of one run"
    print(f"{engine}: {done.stdout.splitlines()[0]}, one killed, the same result")
    return None


def is_there(engine, folder):
    """Whether this machine can run the engine; for Slurm, its processes."""
    if engine == "dask":
        return subprocess.run(["/usr/bin/python3", "-c", "import distributed"], capture_output=True).returncode == 0
    return start_slurm(folder) if engine == "slurm" else shutil.which(engine) is not None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", required=True, type=pathlib.Path)
    parser.add_argument("engines", nargs="*", metavar="ENGINE", help=", ".join(RECIPES))
    arguments = parser.parse_args()
    tool = arguments.tool.resolve()
    engines = arguments.engines or list(RECIPES)
    faults = left_out = 0
    with tempfile.TemporaryDirectory(prefix="touchstone-cluster-") as name:
        top = pathlib.Path(name)
        data, one = top / "data", top / "one.json"
        subprocess.run([tool, "generate", "--out", data, "--count", "500"], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([tool, "certify", data, "--method", "cubic", "--json", one], stdout=subprocess.DEVNULL)
        expected = counts(json.loads(one.read_text()))
        for engine in engines:
            folder = top / engine
            folder.mkdir()
            processes = is_there(engine, folder)
            if not processes:
                print(f"{engine}: LEFT OUT, this machine has no {engine} that runs")
                left_out += 1
                continue
            fault = run_engine(engine, tool, data, expected, folder)
            if isinstance(processes, list):
                for process in processes:
                    process.kill()
                    process.wait()
            if fault:
                print(f"{engine}: FAULT: {fault}")
                faults += 1
    return 1 if faults else 77 if left_out == len(engines) else 0


if __name__ == "__main__":
    sys.exit(main())
