#!/usr/bin/python3
"""Run a command of touchstone in pieces by Dask: dask_run.py FOLDER WORKERS COMMAND…

Each shard is a process of its own, so a crash or Python's lock stops no worker. A shard that is killed runs again. With
the address of a scheduler in DASK_SCHEDULER_ADDRESS its workers are used, otherwise processes of this machine.

Example: dask_run.py run 4 touchstone certify queries --json all.json
"""

import os
import subprocess
import sys

from distributed import Client, LocalCluster


def run_shard(words: list[str], index: int, count: int) -> int:
    """Run a shard; fail if it was killed or could not read its input."""
    done = subprocess.run([*words, "--shard", f"{index}/{count}"], stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"shard {index} of {count} ended with {done.returncode}")
    return done.returncode


def main(folder: str, workers: int, command: list[str]) -> int:
    """Run all shards, and return the status of the merge."""
    words = [*command, "--threads", "1", "--resume", folder]
    address = os.environ.get("DASK_SCHEDULER_ADDRESS")
    cluster = address or LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    )
    with Client(cluster) as client:
        shards = [client.submit(run_shard, words, i, workers, pure=False, retries=3) for i in range(workers)]
        client.gather(shards, errors="skip")
    return subprocess.run([command[0], "merge", folder]).returncode


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], int(sys.argv[2]), sys.argv[3:]))
