"""The large run of docs/results.md: at least sixty million recorded queries, in parts, and all steps of a simulation.

`./run results large` records what `./run simulate` asks of collision detection, splits it into files, and judges it by the
recipe for GNU parallel of examples/cluster, of which processes are killed on the way. It takes about an hour on two cores, and
50 GB in build/large.
"""

import json
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))
import cluster  # noqa: E402  (the test of the same recipes)

SCENES = ["two-heads", "chain-of-rings", "dimpled-ball", "twisting-mat --steps 200"]
LIMIT = 40000  # of queries of a kind in a motion
FEWEST = 60_000_000
FILE = 1_000_000  # queries
# The methods that answer all queries; the others answer as many of each file as these seconds for all of them allow.
ON_ALL = ["certified", "tight_inclusion", "tccd"]
SAMPLED = ["irf", "uirf", "fprf", "rp", "rrp", "bsc", "msrf", "accd"]
SECONDS_OF_SAMPLES = 240
WORKERS = 2
PARTS = 16
KILLS = 2  # the recipe starts a part three times


def kill_workers(folder, kills, stop):
    """Kill a process of a part at moments spread over the run; the list `kills` counts them."""
    moments = sorted(random.Random(60).sample(range(1, PARTS), KILLS))
    while moments and not stop.wait(0.05):
        if len(list(folder.glob("*.json"))) < moments[0]:
            continue
        if cluster.kill_worker(folder):
            kills.append(moments.pop(0))


def in_parts(command, folder, options):
    """The sum of the parts of a command, with its cost."""
    shutil.rmtree(folder, ignore_errors=True)
    kills, stop, begin = [], threading.Event(), time.monotonic()
    killer = threading.Thread(target=kill_workers, args=(folder, kills, stop))
    killer.start()
    recipe = ROOT / "examples/cluster/parallel.sh"
    done = subprocess.run([recipe, folder, str(PARTS), options.tool, *command], capture_output=True, text=True, check=False)
    stop.set()
    killer.join()
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return {"result": json.loads(folder.with_suffix(".json").read_text()), "kills": len(kills),
            "seconds": time.monotonic() - begin,
            "greatest_memory_bytes": 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss}


def oracle_and_methods(results):
    """The time of the oracle and of each method a query, from results that have it, as those of parts."""
    sums = {}
    for of in results:
        for name, queries, ns in [("oracle", of["queries"], 1e3 * of["us_per_query"]),
                                  *((m["name"], m["queries"], m["ns_per_query"]) for m in of["methods"] if m["queries"])]:
            time_, count = sums.get(name, (0.0, 0))
            sums[name] = time_ + ns * queries, count + queries
    return {name: time_ / count for name, (time_, count) in sums.items()}


def in_one_run(command, options, out):
    """The result of a command, which may end with wrong answers."""
    done = subprocess.run([options.tool, *command, "--json", out], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stderr}")
    return json.loads(out.read_text())


def split(file, folder):
    """Write the arrays and labels of a file as files into a folder. Return their sizes."""
    import numpy  # which checking the documents does not need

    queries = numpy.load(file, mmap_mode="r")
    labels = json.loads((file.parent / "mma_bool" / f"{file.stem}_mma_bool.json").read_text())
    (folder / "mma_bool").mkdir(parents=True, exist_ok=True)
    starts = range(0, len(queries), FILE)
    for i, start in enumerate(starts):
        name = f"{file.stem}-{i:05}"
        (folder / "mma_bool" / f"{name}_mma_bool.json").write_text(json.dumps(labels[start:start + FILE]))
        numpy.save(folder / f"{name}.npy", queries[start:start + FILE])
    return [min(FILE, len(queries) - start) for start in starts]


def measure(options, run):
    """The rows of docs/data/large.json. \\param run: runs a command, and raises if it fails"""
    place = options.recorded.with_name("large")
    recorded, store, frames = place / "recorded", place / "store", place / "frames"
    place.mkdir(parents=True, exist_ok=True)
    simulator = options.tool.with_name("touchstone-simulate")
    for scene in SCENES:
        words = scene.split() + (["--steps", "3"] if options.quick else [])
        done = place / f"{words[0]}.json"
        if not done.exists():
            print(f"./run simulate {scene} --record {recorded} --record-limit {LIMIT}", flush=True)
            out = ["--out", frames] if "twisting-mat" in words else []
            done.write_text(run([simulator, *words, "--record", recorded, "--record-limit", str(LIMIT), *out]))
    shutil.rmtree(store, ignore_errors=True)
    sizes = [split(file, store / file.parent.name) for file in sorted(recorded.glob("*/*.npy"))]
    if sum(map(sum, sizes)) < FEWEST and not options.quick:
        raise RuntimeError(f"only {sum(map(sum, sizes)):,} queries were recorded")
    judging = ["certify", store, *(word for name in ON_ALL for word in ("--method", name))]
    sampling = ["certify", store, *(word for name in SAMPLED for word in ("--method", name)), "--seconds",
                str(2 if options.quick else SECONDS_OF_SAMPLES)]
    stepping = ["step", frames, "--earliest"]

    def told(command):
        words = "touchstone " + " ".join(str(word).replace(str(place), "build/large") for word in command)
        print(words, flush=True)
        return words

    judged = {"command": told(judging), **in_parts(judging, place / "judged", options), "pieces": sum(map(len, sizes)), "scenes": SCENES,
              "bytes": sum(file.stat().st_size for file in store.rglob("*") if file.is_file())}
    judged["ns"] = oracle_and_methods([json.loads(file.read_text()) for file in (place / "judged").glob("*.json")])
    steps = {"command": told(stepping), "result": in_one_run(stepping, options, place / "stepped.json")["steps"]}
    steps["result"] = {"steps": len(steps["result"]), "colliding": sum(not step["free"] for step in steps["result"])}
    sampled = {"command": told(sampling), "result": in_one_run(sampling, options, place / "sampled.json")}
    sampled["ns"] = oracle_and_methods([sampled["result"]])
    judged["recording_seconds"] = sum(json.loads((place / f"{scene.split()[0]}.json").read_text())["seconds"]["total"]
                                       for scene in SCENES)
    return [judged, steps, sampled]
