#!/usr/bin/python3
"""Run a command of touchstone in parts by Dask: dask_run.py FOLDER PARTS COMMAND…

Each part is a process of its own, so a crash or Python's lock stops no worker. A part that is killed runs again. With
the address of a scheduler in DASK_SCHEDULER_ADDRESS its workers are used, otherwise processes of this machine.
FOLDER/I.json is the result of part I, FOLDER.json their sum.

Example: dask_run.py run 8 touchstone certify queries --method tight_inclusion
"""

import glob
import os
import subprocess
import sys

from distributed import Client, LocalCluster


def run_part(words: list[str], folder: str, index: int, count: int) -> int:
    """Run a part; fail if it was killed or could not read its input."""
    done = subprocess.run(
        [*words, "--threads", "1", "--shard", f"{index}/{count}", "--json", f"{folder}/{index}.json"],
        stdout=subprocess.DEVNULL,
    )
    if done.returncode not in (0, 1):
        raise RuntimeError(f"part {index} of {count} ended with {done.returncode}")
    return done.returncode


def main(folder: str, count: int, command: list[str]) -> int:
    """Run all parts, and return the status of the merge."""
    os.makedirs(folder, exist_ok=True)
    address = os.environ.get("DASK_SCHEDULER_ADDRESS")
    cluster = address or LocalCluster(threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1")
    with Client(cluster) as client:
        parts = [client.submit(run_part, command, folder, i, count, pure=False, retries=3) for i in range(count)]
        client.gather(parts, errors="skip")
    results = sorted(glob.glob(f"{glob.escape(folder)}/*.json"))
    return subprocess.run([command[0], "merge", *results, "--json", f"{folder}.json"]).returncode


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], int(sys.argv[2]), sys.argv[3:]))
