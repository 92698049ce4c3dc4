#!/usr/bin/env python3
"""Writes the measured parts of the documents: `./run results`.

docs/data contains the measurements as JSON, each file with its commands, their date and their results; published.json has what
others published, and its sources. They are the source of docs/results.md and docs/results.svg (results_document.py), but for
the last sections of results.md, which were measured once, and of the marked parts of README.md, docs/benchmarks.md and
docs/simulation.md. A marked part is between
<!-- made by ./run results: NAME --> and <!-- end -->; the function NAME below writes it.
"""

import argparse
import datetime
import glob
import json
import pathlib
import re
import shutil
import resource
import subprocess
import sys
import tempfile

import results_document
from results_document import grouped, place_of, rows_of, time_ratio

PROJECT = pathlib.Path(__file__).resolve().parent.parent

DATA = ["handcrafted", "simulation", ""]  # "": the built-in set
STEPS = {"cloth-ball": ["", *(f" --min-separation {d} --norm {norm}" for d in ("1e-8", "1e-2") for norm in ("linf", "l2"))],
         "armadillo-rollers": [""], "cloth-funnel": [""]}

SCENES = ["two-heads", "chain-of-rings", "twisting-mat", "dimpled-ball", "torus-on-cone"]
# The options of each simulation. (The quadratic program of the simulator with constraints is dense: the mat has too many
# contacts for it.)
SIMULATIONS = [*SCENES, *(f"{scene} --simulator constraint" for scene in SCENES if scene != "twisting-mat"),
               *(f"torus-on-cone --method tight_inclusion --tolerance 1e-{digits}" for digits in (1, 2, 3, 4, 6)),
               *(f"torus-on-cone --method {method}" for method in ("tccd", "fprf", "msrf", "rp", "accd")),
               *(f"torus-on-cone --distance {distance}" for distance in ("1e-2", "3e-3", "3e-4", "1e-4", "1e-5")),
               *(f"torus-on-cone --miss {one_in}" for one_in in ("1000000", "10000", "1000", "100", "10", "1")),
               *(f"torus-on-cone --miss-limit {n}" for n in range(1, 11))]

# The methods of the tables of all methods.
METHODS = ["certified", "tight_inclusion", "tight_inclusion_published", "tight_inclusion_released", "irf", "uirf", "fprf", "tccd",
           "rp", "rrp", "bsc", "msrf", "accd"]
DISTANCES = ["1e-2", "1e-8", "1e-16", "1e-30", "1e-100"]

# The simulations whose queries are the group `own-simulation` of the results: the four scenes of the paper, at least five million
# queries of each kind.
RECORDED = "build/own-simulation"
RECORDINGS = [f"simulate {scene} --record {RECORDED} --record-limit 2500"
              for scene in ("two-heads", "chain-of-rings", "dimpled-ball", "twisting-mat --steps 200")]

# The built-in families as files, of which each is a source of its own.
FAMILIES = "build/families"

# The adapters as plugins, which solve a query by a call, where the build has them.
ADAPTERS = "build/adapters"
BY_THE_CALL = {"c_function": "C, by the call", "tight_inclusion_adapter": "Tight-Inclusion's interface"}

# The methods of the table `judged`.
JUDGED = ["certified", "tight_inclusion", "tight_inclusion_published", "tight_inclusion_released", "tight_inclusion_float",
          "accd", "accd_limited", "cubic"]

def asked(methods):
    return " ".join(f"--method {name}" for name in methods)


# The commands of each file of data. They run in the folder of the public data.
COMMANDS = {
    "results": [f"bench {data} {asked(METHODS)} --seconds 12 --judge 12000000" for data in ("handcrafted simulation", RECORDED)],
    "separations": [f"bench handcrafted simulation {asked(methods)} --norm {norm} "
                    f"{' '.join(f'--min-separation {d}' for d in DISTANCES)} --seconds 12"
                    for norm, methods in (("linf", ["tight_inclusion", "certified"]), ("l2", ["msrf", "fprf", "certified"]))],
    "filters": [f"bench {queries} {asked(METHODS[1:4])} --max-checks 100000 --repetitions 1 --seconds 100"
                for queries in (f"{FAMILIES}/vertex-face/*.csv {FAMILIES}/edge-edge/*.csv",
                                "--level 1:7 --family end-contact --family decimal-end-contact --count 10000")],
    "certify": [*(f"certify {data} {asked(JUDGED)}".replace("  ", " ") for data in DATA),
                "certify"],
    "files": ["bench handcrafted/*/*/*.csv simulation/*/queries/*.csv --method certified --method tccd "
              "--method rp --repetitions 15"],
    "patches": ["bench --repetitions 9"],
    "steps": [f"bench --step simulation/{step}/frames/*.ply --method certified --method tight_inclusion --judge 0 "
              f"--repetitions 7{separation}" for step, separations in STEPS.items() for separation in separations],
    "point_of_use": [f"bench --step simulation/{step}/frames/*.ply --method certified "
                     f"{' '.join(f'--plugin {ADAPTERS}/{name}.so' for name in BY_THE_CALL)} --judge 0 --singles 20000 --repetitions 7"
                     for step in STEPS],
    "bounds": ["derive"],
    "certificates": [f"prove {data} --threads 1".replace("  ", " ") for data in DATA],
    "step_proofs": [f"step simulation/{step}/frames/*.ply --earliest --candidates --threads 1" for step in STEPS],
    "simulations": [f"simulate {simulation}" for simulation in SIMULATIONS],
}

# Fields that no document shows.
DROPPED = {"wrong_answers", "failures", "mismatches", "files", "worst_input"}


class Problem(Exception):
    """A problem that the user can fix."""


# ---- Measuring -------------------------------------------------------------------------------------------------------


def run(command, statuses=(0,), **options):
    """The output of the command, which must end with one of these exit statuses."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode not in statuses:
        raise Problem(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def reduced(value):
    if isinstance(value, dict):
        return {key: reduced(part) for key, part in value.items() if key not in DROPPED}
    return [reduced(part) for part in value] if isinstance(value, list) else value


def compact(value):
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


def processor_time(work):
    """The result of the work, and the processor time of its programs in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    return work(), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def check_certificates(checker, proofs):
    """The number of certificates that touchstone-check accepts, and its processor time."""
    text = proofs.with_suffix("")
    run(["zstd", "-q", "-d", "-f", proofs, "-o", text])
    printed, seconds = processor_time(lambda: run([checker, text]))
    return {"accepted": int(re.search(r"accepted +(\d+)", printed)[1]), "checking_s": seconds, "text_bytes": text.stat().st_size}


def prove_step(command, options, folder):
    """Proves the first step between the frames, and checks the proof."""
    out, proofs = folder / "step.json", folder / "step.cert.zst"
    words = [path for word in command.split()
             for path in (sorted(glob.glob(word, root_dir=options.data)) if "*" in word else [word])]
    # Its exit status is 1 if there is a collision.
    _, seconds = processor_time(lambda: run([options.tool, *words, "--json", out, "--prove", proofs], (0, 1), cwd=options.data))
    result = json.loads(out.read_text())
    step = result["steps"][0]
    return {"command": f"touchstone {command}", "result": {
        **{name: result[name] for name in ("vertices", "edges", "faces")}, **{name: step[name] for name in ("candidates", "proof")},
        "proving_s": seconds, "file_bytes": proofs.stat().st_size,
        **check_certificates(options.tool.with_name("touchstone-check"), proofs)}}


def simulate(command, options, folder):
    """Runs a simulation, and judges its frames."""
    print(f"./run {command}", flush=True)
    frames, judged = folder / "frames", folder / "steps.json"
    words = command.split()[1:] + (["--steps", "3"] if options.quick else [])
    shutil.rmtree(frames, ignore_errors=True)
    result, steps_ = json.loads(run([options.tool.with_name("touchstone-simulate"), *words, "--out", frames])), []
    if result["frames"] > 1:  # its exit status is 1 if there is a collision
        run([options.tool, "step", frames, "--json", judged], (0, 1))
        steps_ = json.loads(judged.read_text())["steps"]
    colliding = sum(not step["free"] for step in steps_)
    return {"command": f"./run {command}", "result": result | {"colliding": colliding, "motions": len(steps_)}}


def record(options):
    """Simulates the scenes of the report, except those that an earlier run has recorded by the same command."""
    for command in RECORDINGS:
        words = command.split()[1:] + (["--steps", "3"] if options.quick else [])
        done = options.recorded.with_name(f"{options.recorded.name}-runs") / f"{words[0]}.json"
        if done.exists() and json.loads(done.read_text())["command"] == words:
            continue
        print(f"./run {command}", flush=True)
        done.parent.mkdir(parents=True, exist_ok=True)
        printed_ = run([options.tool.with_name("touchstone-simulate"),
                        *(str(options.recorded) if word == RECORDED else word for word in words)])
        done.write_text(json.dumps(json.loads(printed_) | {"command": words}))


def bench(command, words, options, folder):
    """Runs a command of bench. The rows name their sources as the command does."""
    out = folder / "rows.jsonl"
    run([options.tool, *words, "--json", out], (0, 1), cwd=options.data)  # 1 if a method is wrong
    text = out.read_text()
    for place, named in ((options.recorded, "own-simulation"), (options.families, "families")):
        text = text.replace(str(place), named)
    return {"command": f"touchstone {command}", "rows": [reduced(json.loads(line)) for line in text.splitlines()]}


def measure_one(name, command, options, folder):
    """Runs a command of the tool; returns the command with its result."""
    if name == "simulations":
        return simulate(command, options, folder)
    if name == "step_proofs":
        return prove_step(command, options, folder)
    if RECORDED in command:
        record(options)
    if FAMILIES in command:
        run([options.tool, "generate", "--count", "500", "--out", options.families])
    if options.quick:
        command = re.sub(r"--repetitions \d+", "--repetitions 1", re.sub(r"--seconds 12\b", "--seconds 0.1", command))
    print(f"touchstone {command}", flush=True)
    out, proofs = folder / "run.json", folder / "proofs.cert.zst"
    command_here = command
    for named, place in ((RECORDED, options.recorded), (FAMILIES, options.families), (ADAPTERS, options.tool.with_name("adapters"))):
        command_here = command_here.replace(named, str(place))
    words = [path for word in command_here.split()
             for path in (sorted(glob.glob(word, root_dir=options.data)) if "*" in word else [word])]
    if command.startswith("bench"):
        return bench(command, words, options, folder)
    words += ["--json", out] + (["--prove", proofs] if name == "certificates" else [])
    words += ["--table"] if command == "certify" else []
    # The exit status of certify is 1 if a method is wrong.
    program = [options.tool, *words] if command != "derive" else [options.tool.with_name("touchstone-derive"), *words[1:]]
    printed = run(program, (0, 1) if name == "certify" else (0,), cwd=options.data)
    result = {"command": f"touchstone {command}".replace(" derive", "-derive"), "result": reduced(json.loads(out.read_text()))}
    if command == "certify":
        result["printed"] = printed.splitlines()
    if name == "certificates":
        result["result"].update(check_certificates(options.tool.with_name("touchstone-check"), proofs))
    return result


def measure(name, options, folder):
    """Writes docs/data/NAME.json anew, with a line for each run."""
    rows = [measure_one(name, command, options, folder) for command in COMMANDS[name]]
    data = {"date": datetime.datetime.now(datetime.timezone.utc).date().isoformat()}
    if name == "results":
        processor = re.search("model name\\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
        data |= {"machine": processor[1] if processor else "unknown processor",
                 "version": run([options.tool, "--version"]).strip()}
    lines = ",\n".join(compact(row) for row in rows)
    (options.root / f"docs/data/{name}.json").write_text(f'{compact(data)[:-1]},"runs":[\n{lines}\n]}}\n')


# ---- The marked parts ------------------------------------------------------------------------------------------------


def rounded(x):
    """Two significant digits: 0.97, 1.0, 12, 1,300."""
    digits = 1 - int(f"{x:.1e}".split("e")[1])
    return f"{round(x, digits):,.{max(digits, 0)}f}"


def table(columns, rows):
    lines = [f"| {' | '.join(columns)} |", "|" + "---|" * len(columns)]
    return lines + [f"| {' | '.join(map(str, row))} |" for row in rows]


def made_by(data, command=None):
    return [f"`{command or data['runs'][0]['command']}`, {data['date']}:", ""]


def by_name(group):
    return {m["name"]: m for m in group["methods"]}


# The solvers of README.md's table, as a reader knows them.
COMPARED = {"certified": "Touchstone", "tight_inclusion": "Tight-Inclusion, with a proved filter",
            "tight_inclusion_released": "Tight-Inclusion, with the filter of its releases", "accd": "additive CCD",
            "cubic": "roots of the cubic"}
OURS = ["certified", "tight_inclusion"]


def summary(results_, certify, steps_):
    """The first sentences of README.md, a number each."""
    of_others = [row for row in rows_of(results_) if row["method"] not in OURS]
    others = {row["method"] for row in of_others}
    missing = {row["method"] for row in of_others if row["false_negatives"] and row["source"] != "own-simulation"}
    truth = certify["runs"][-1]["result"]
    exact = by_name(truth)["certified"]
    step = step_of(steps_["runs"][0])
    of = step["times"][0]  # one thread
    return [f"Rounding makes the usual answers wrong: of {len(others)} published methods and variants, as implemented here, "
            f"{len(missing)} miss collisions of the",
            f"public data of Wang et al. 2021. Of the {truth['collisions']:,} collisions in {truth['queries']:,} hard queries, whose truth "
            f"is known by construction, Touchstone misses {exact['false_negatives']:,}, with",
            f"{exact['false_positives']:,} false alarms. The first contact in a step of {step['faces']:,} triangles "
            f"takes {1e3 * (of['trees_processor_s'] + of['earliest_processor_s']):.0f} ms on one core."]


def compared(certify):
    of = next(one["result"] for name, one in zip(DATA, certify["runs"]) if not name)
    methods = by_name(of)
    return table(["solver", "misses", "false alarms", "time"],
                 [[f"{named} (`{name}`)", f"{methods[name]['false_negatives']:,}", f"{methods[name]['false_positives']:,}",
                   rounded(methods[name]["ns_per_query"] / methods["certified"]["ns_per_query"])]
                  for name, named in COMPARED.items()])


def results(data):
    places, cells = {}, {}
    for row in rows_of(data):
        place = places.setdefault((row["source"], row["kind"]), place_of(row))
        time = rounded(time_ratio(row)) + "*" * (row["timed"] < row["queries"])
        cells.setdefault(row["method"], {})[place] = f"{row['false_negatives']} / {row['false_positives']} / {time}"
    return made_by(data, " && ".join(one["command"] for one in data["runs"])) + table(
        ["method", *places.values()],
        [[f"`{method}`", *(of.get(place, "–") for place in places.values())] for method, of in cells.items()])


def printed(data):
    lines = data["runs"][-1]["printed"]
    total = next(i for i, line in enumerate(lines) if line.startswith("total"))
    return made_by(data, "./run certify --table") + ["```", *lines[:2], "…", *lines[total:], "```"]


def judged(data):
    rows = []
    for name, of in zip(DATA, (one["result"] for one in data["runs"])):
        truth = [name or "built-in set", f"{of['queries']:,}", f"{of['collisions']:,}",
                 f"{of['label_mismatches']} of {of['labels']:,}", f"{of['toi_mismatches']} of {of['tois']:,}"]
        exact = next(m for m in of["methods"] if m["name"] == "certified")
        for m in of["methods"]:
            asked = "" if m["queries"] == of["queries"] else f", {m['queries']:,} of them"
            rows.append([*truth, f"`{m['name']}`{asked}", m["false_negatives"], m["late_toi"], f"{m['false_positives']:,}",
                         rounded(m["ns_per_query"] / exact["ns_per_query"])])
            truth = [""] * len(truth)
    return made_by(data, "touchstone certify …") + table(
        ["data", "queries", "collisions", "wrong labels", "wrong recorded times", "method", "false negatives",
         "late times of impact", "false positives", "time"], rows)


def files(data):
    scenes = {}
    for row in rows_of(data):
        scenes.setdefault(row["source"].split("/")[1], {}).setdefault(row["kind"], {})[row["method"]] = row

    def cells(of):
        if not of:
            return [""] * 3
        tccd, rp = (rounded(of[method]["ns_per_query"] / of["certified"]["ns_per_query"]) for method in ("tccd", "rp"))
        return [tccd, of["tccd"]["false_positives"], rp]

    return made_by(data) + table(
        ["scene", *(f"{text}, {kind}" for kind in ("vertex-face", "edge-edge")
                    for text in ("`tccd`", "its false positives", "`rp`"))],
        [[scene, *cells(kinds.get("vertex-face")), *cells(kinds.get("edge-edge"))] for scene, kinds in scenes.items()])


def passes(row):
    return rounded(row["ns_per_query"] / row["pass_ns_per_query"])


def patches(data):
    rows = []
    for place, of in grouped(rows_of(data), place_of).items():
        what = f"{place}, {of[0]['queries']:,}"
        for row in of:
            sample = "" if row["timed"] == row["queries"] else f", {row['timed']:,} of them"
            rows.append([what, f"`{row['method']}`{sample}", passes(row), row["false_negatives"], row["false_positives"],
                         f"{row['toi_error']['p50']:.1e} / {row['toi_error']['max']:.1e}"])
            what = ""
    return made_by(data) + table(["queries", "method", "passes", "false negatives", "false positives",
                                  "error of the time of impact, median / greatest"], rows)


def step_of(run_):
    """The row of the whole step in a run of bench --step."""
    return next(row for row in run_["rows"] if "step" in row)


def scene_of(run_):
    """The step of a run of a command about one, and its separation."""
    separation = re.search(r"--min-separation (\S+) --norm (\S+)", run_["command"])
    d = f"{separation[1]} {'L2' if separation[2] == 'l2' else 'L∞'}" if separation else 0
    return re.search(r"simulation/([^/]*)", run_["command"])[1], d


def by_kind(run_):
    """The rows of each kind of a run of bench --step, by their method."""
    kinds = grouped((row for row in run_["rows"] if "method" in row), lambda row: row["kind"])
    return {kind: {row["method"]: row for row in of} for kind, of in kinds.items()}


def steps(data):
    rows = []
    for one in data["runs"]:
        step, d = scene_of(one)
        for kind, methods in by_kind(one).items():
            counts = step_of(one)[kind.replace("-", "_")]
            rows.append([f"{step}, {kind}", d, f"{counts['candidates']:,}", f"{counts['collisions']:,}",
                         *(passes(methods[name]) for name in ("certified", "tight_inclusion"))])
    return made_by(data, "touchstone bench --step FRAME0 FRAME1 …") + table(
        ["step", "d", "candidates", "collisions", "`certified`", "`tight_inclusion`"], rows)


def whole_steps(data):
    rows = []
    for one in data["runs"]:
        step = step_of(one)
        of = step["times"][0]  # one thread

        def in_passes(*parts):
            return rounded(sum(of[f"{part}_processor_s"] for part in parts) / step["memory_pass_s"])

        rows.append([*scene_of(one), f"{step['vertices']:,} / {step['edges']:,} / {step['faces']:,}",
                     f"{1e3 * step['memory_pass_s']:.2f} ms", in_passes("trees"), in_passes("candidates"),
                     in_passes("trees", "earliest"), in_passes("trees", "collisions")])
    return made_by(data, "touchstone bench --step FRAME0 FRAME1 …") + table(
        ["step", "d", "vertices / edges / faces", "pass", "trees", "candidates", "earliest impact, trees included",
         "all collisions, trees included"], rows)


def one_at_a_time(data):
    rows = []
    for one in data["runs"]:
        for kind, methods in by_kind(one).items():
            of = methods["certified"]
            batch, single = of["ns_per_query"], of["single"]
            rows.append([f"{scene_of(one)[0]}, {kind}", rounded(batch),
                         *(rounded(single[f"{part}_ns"]) for part in ("mean", "p50", "p99")), f"{single['mean_ns'] / batch:.1f}",
                         *(rounded(methods[name]["ns_per_query"]) for name in BY_THE_CALL)])
    return made_by(data, "touchstone bench --step FRAME0 FRAME1 …") + table(
        ["step", "in a batch", "alone: mean", "median", "99 %", "mean, in that of a batch", *BY_THE_CALL.values()], rows)


def line_searches(data):
    rows = []
    for one in data["runs"]:
        of = step_of(one)["times"][0]  # one thread
        times = [of[f"{part}_processor_s"] for part in ("earliest", "free_step_size", "limit_of_scene", "limit_of_pairs")]
        rows.append([scene_of(one)[0], f"{1e3 * times[0]:.1f} ms",
                     *(f"{1e3 * time:.1f} ms ({time / times[0]:.1f})" for time in times[1:])])
    return made_by(data, "touchstone bench --step FRAME0 FRAME1 …") + table(
        ["step", "`earliest`", "`free_step_size`", "`line_search_limit` of the scene", "of pairs"], rows)


def bounds(data):
    rows = [[row["expression"], row["precision"], row["published_constant"] or "",
             *(f"{row[of]:.4g} u" if row[of] else ""
               for of in ("published_units", "rigorous_units", "gappa_units", "observed_units")),
             f"{row['tightness']:.2f}"]
            for row in data["runs"][0]["result"]["bounds"] if not row["expression"].startswith("paper_")]
    return made_by(data) + table(["expression", "precision", "published constant", "its model", "our bound", "Gappa's",
                                  "worst observed", "tightness"], rows)


def certificates(data):
    rows = []
    for name, of in zip(DATA, (one["result"] for one in data["runs"])):
        count, subintervals = of["certificates"], {int(number): amount for number, amount in of["subintervals"].items()}
        shown = [*(subintervals.get(i, 0) for i in range(4)), sum(amount for i, amount in subintervals.items() if i > 3)]
        times = of["oracle_us_per_query"], of["us_per_certificate"], 1e6 * of["checking_s"] / count
        rows.append([name or "built-in set", f"{count:,}", f"{of['accepted']:,}",
                     f"{of['no_collision']:,}", f"{of['time_of_impact']:,}", " / ".join(f"{n:,}" for n in shown),
                     f"{of['bytes_per_certificate']:.0f} ({of['file_bytes'] / count:.0f})",
                     *(f"{rounded(time)} µs" for time in times)])
    return made_by(data, "touchstone prove …") + table(
        ["data", "certificates", "accepted", "no collision", "time of impact", "subintervals: none / 1 / 2 / 3 / more",
         "bytes each (compressed)", "deciding", "proving", "checking"], rows)


def step_proofs(data):
    rows = []
    for one in data["runs"]:
        of = one["result"]
        rows.append([scene_of(one)[0], f"{of['faces']:,}", f"{sum(of['candidates'].values()):,}",
                     f"{of['proof']['directions']:,} / {of['proof']['certificates']:,}",
                     "yes" if of["accepted"] == 1 else "no", f"{1e-6 * of['text_bytes']:.1f} ({1e-6 * of['file_bytes']:.2f})",
                     f"{rounded(of['proving_s'])} s", f"{rounded(of['checking_s'])} s"])
    return made_by(data, "touchstone step FRAME0 FRAME1 --earliest --threads 1 --prove FILE && touchstone-check FILE") + table(
        ["step", "faces", "pairs whose boxes meet", "pairs with a direction / with subintervals", "accepted", "MB (compressed)",
         "deciding and proving", "checking"], rows)


def simulations(data, of):
    """The runs whose command satisfies `of`, each with its result."""
    return [(one["command"].removeprefix("./run simulate "), one["result"]) for one in data["runs"] if of(one["command"])]


def share(run_):
    return f"{100 * run_['seconds']['detection'] / run_['seconds']['total']:.1f} %"


def scenes(data):
    chosen = dict(simulations(data, lambda command: not re.search("--(method|distance|miss)", command)))
    rows = []
    for scene in SCENES:
        barrier, constraint = chosen[scene], chosen.get(f"{scene} --simulator constraint")
        rows.append([scene, f"{barrier['vertices']:,} / {barrier['faces']:,}", barrier["time_steps"],
                     *(cell for one in (barrier, constraint) for cell in
                       ((f"{one['motions']:,}", one["colliding"], one["steps_of_zero"], share(one)) if one else 4 * ["–"]))])
    return made_by(data, "./run simulate SCENE --out FOLDER && ./run step FOLDER") + table(
        ["scene", "vertices / faces", "time steps", "barrier: motions", "that collide", "steps of 0", "share of CCD",
         "constraints: motions", "that collide", "steps of 0", "share of CCD"], rows)


def chart(title, names, unit, values):
    """A bar chart in Markdown."""
    return ["", "```mermaid", "xychart-beta", f'    title "{title}"', f'    x-axis [{", ".join(names)}]',
            f'    y-axis "{unit}"', f'    bar [{", ".join(values)}]', "```"]


def detections(data):
    rows = [[f"`{run_['method']}`", f"{run_['tolerance']:.0e}" if run_["method"] == "tight_inclusion" else "",
             f"{run_['motions']:,}", run_["colliding"], run_["steps_of_zero"], run_["unfinished"],
             rounded(run_["seconds"]["detection"]), rounded(run_["seconds"]["total"]), share(run_)]
            for command, run_ in simulations(data, lambda command: re.search("torus-on-cone( --method.*)?$", command))]
    by_tolerance = [row for row in rows if row[1]]
    return made_by(data, "./run simulate torus-on-cone --method NAME --tolerance δ") + table(
        ["method", "δ", "motions", "that collide", "steps of 0", "time steps without an end", "CCD, s", "in all, s",
         "share of CCD"], rows) + chart(
             "Tight-Inclusion over its δ: motions until the end, or until all steps are 0", [row[1] for row in by_tolerance],
             "motions", [row[2] for row in by_tolerance])


def distances(data):
    runs = simulations(data, lambda command: re.search("torus-on-cone( --distance.*)?$", command))
    rows = [[command.partition("--distance ")[2] or "1e-3", f"{run_['motions']:,}", run_["colliding"],
             f"{1e3 * run_['seconds']['detection'] / run_['calls']:.2f}", share(run_)] for command, run_ in runs]
    rows.sort(key=lambda row: -float(row[0]))
    return made_by(data, "./run simulate torus-on-cone --distance d") + table(
        ["d, m", "motions", "that collide", "CCD, ms a call", "share of CCD"], rows) + chart(
            "Collision detection over the distance of barriers", [row[0] for row in rows], "ms a call", [row[3] for row in rows])


def misses(data):
    rows = [[f"{run_['missed_one_in']:,}", f"{run_['candidates']:,}", run_["missed"], f"{run_['motions']:,}",
             run_["colliding"]] for _, run_ in simulations(data, lambda command: "--miss " in command)]
    return made_by(data, "./run simulate torus-on-cone --miss N --out FOLDER && ./run step FOLDER") + table(
        ["one query missed in", "queries", "missed contacts", "motions", "that collide"], rows)


def one_miss(data):
    rows = [[run_["missed_limit"], f"{run_['candidates']:,}", f"{run_['motions']:,}", run_["colliding"]]
            for _, run_ in simulations(data, lambda command: "--miss-limit" in command)]
    return made_by(data, "./run simulate torus-on-cone --miss-limit N --out FOLDER && ./run step FOLDER") + table(
        ["N", "queries", "motions", "that collide"], rows)


# The marked parts of the documents, in their order, each with its files of data.
PARTS = {"README.md": [(summary, "results", "certify", "steps"), (compared, "certify")],
         "docs/benchmarks.md": [(results, "results"), (printed, "certify"), (judged, "certify"), (files, "files"), (patches, "patches"), (steps, "steps"),
                                (whole_steps, "steps"), (one_at_a_time, "point_of_use"),
                                (line_searches, "point_of_use"), (bounds, "bounds"), (certificates, "certificates"),
                                (step_proofs, "step_proofs")],
         "docs/simulation.md": [(scenes, "simulations"), (detections, "simulations"), (distances, "simulations"),
                                (misses, "simulations"), (one_miss, "simulations")]}


# ---- Documents -------------------------------------------------------------------------------------------------------


def with_parts(document, text, root):
    """The text of a document with regenerated marked parts."""
    parts = {part.__name__: (part, data) for part, *data in PARTS[document]}
    mark = re.compile(r"(<!-- made by \./run results: (\w+) -->)\n.*?<!-- end -->", re.DOTALL)
    found = [name for _, name in mark.findall(text)]
    if found != list(parts):
        raise Problem(f"{document}: marked are the parts {found}, not {list(parts)}")

    def made(match):
        part, data = parts[match[2]]
        lines = part(*(json.loads((root / f"docs/data/{name}.json").read_text()) for name in data))
        return "\n".join([match[1], "", *lines, "", "<!-- end -->"])

    return mark.sub(made, text)


def documents(options, folder):
    """The correct texts of all documents, by name."""
    made = {document: with_parts(document, (options.root / document).read_text(), options.root) for document in PARTS}

    def read(name):
        return json.loads((options.root / f"docs/data/{name}.json").read_text())

    measured_once = re.search("## A large run.*", (options.root / "docs/results.md").read_text(), re.DOTALL)[0]
    text = results_document.document(*map(read, ("results", "separations", "filters", "published")))
    return made | {"docs/results.md": f"{text}\n{measured_once}",
                   "docs/results.svg": results_document.picture(options.tool, rows_of(read("results")), folder, run)}


def differences(root, made):
    """The first wrong line of each document."""
    for document, text in made.items():
        file = root / document
        old, new = (file.read_text() if file.exists() else "").split("\n"), text.split("\n")
        for i in range(max(len(old), len(new))):
            if old[i:i + 1] != new[i:i + 1]:
                yield f"{document}:{i + 1}: the data gives: {''.join(new[i:i + 1])}"
                break


def main():
    parser = argparse.ArgumentParser(prog="./run results", description="Measures, and writes the documents' numbers.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"measure only: {' '.join(COMMANDS)} (default: all)")
    parser.add_argument("--check", action="store_true", help="only check that data and documents agree")
    parser.add_argument("--write", action="store_true", help="write the documents from docs/data, without measuring")
    parser.add_argument("--quick", action="store_true", help="measure times briefly, for a test of this program")
    parser.add_argument("--data", type=pathlib.Path, default=PROJECT / "../shared/datasets", help="the public data")
    parser.add_argument("--tool", type=pathlib.Path, default=PROJECT / "build/release/touchstone")
    parser.add_argument("--root", type=pathlib.Path, default=PROJECT, help="the folder of the documents")
    options = parser.parse_args()
    options.tool = options.tool.resolve()  # commands run in another folder
    options.recorded, options.families = (options.tool.parent.parent / pathlib.Path(name).name for name in (RECORDED, FAMILIES))
    if not set(options.names) <= set(COMMANDS):
        parser.error(f"NAME is one of {' '.join(COMMANDS)}")
    with tempfile.TemporaryDirectory() as name:
        if not options.check and not options.write:
            for data in options.names or COMMANDS:
                measure(data, options, pathlib.Path(name))
        made = documents(options, pathlib.Path(name))
    if options.check:
        found = list(differences(options.root, made))
        print("\n".join(found) or f"{len(made)} documents agree with their data")
        return 1 if found else 0
    for document, text in made.items():
        (options.root / document).write_text(text)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Problem, OSError, ValueError) as problem:
        print(f"./run results: {problem}", file=sys.stderr)
        sys.exit(2)
