#!/usr/bin/env python3
"""Makes the tables and pictures of all methods from nothing: `./run reproduce`.

Measures anew into build/reproduced, a copy of the documents, and compares all counts with those of docs/data: they do not
depend on the machine. Times do, and are not compared. Seeds are fixed. At the end: time and disk.
"""

import argparse
import json
import pathlib
import shutil
import sys
import tempfile
import time

import documents

COUNTS = ["false_negatives", "false_positives", "undecided", "errors", "late_toi", "early_toi_upper"]
# What the counts of a row are about. A method that is asked a sample is asked as many as time allows.
KEYS = ["source", "kind", "level", "method", "timed", "judged", "min_separation", "norm", "tolerance", "max_checks"]


def counts_of(name, root):
    """The counts of a file of data, by what they are about."""
    data = json.loads((root / f"docs/data/{name}.json").read_text())
    if name != "certify":
        return {tuple(str(row[key]) for key in KEYS): [row[count] for count in COUNTS]
                for row in documents.rows_of(data)}
    return {(run["command"], method["name"]): [method.get(count) for count in COUNTS]
            for run in data["runs"] for method in run["result"]["methods"]}


def main():
    here = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(prog="./run reproduce", description="Makes the tables and pictures of all methods anew.")
    parser.add_argument("--data", type=pathlib.Path, default=here / "../shared/datasets", help="the public data [wang2021]")
    parser.add_argument("--out", type=pathlib.Path, default=here / "build/reproduced")
    parser.add_argument("--built-in", action="store_true", help="only what needs no public data: the built-in set")
    parser.add_argument("--quick", action="store_true", help="measure times briefly; counts are the same")
    options = parser.parse_args()
    options.tool, options.root, begin = here / "build/release/touchstone", options.out, time.monotonic()
    options.recorded, options.families = here / "build/own-simulation", here / "build/families"
    if not options.built_in and not (options.data / "handcrafted").is_dir():
        raise documents.Problem(f"{options.data}: no public data; name its folder (TOUCHSTONE_DATA), or use --built-in")
    shutil.rmtree(options.out, ignore_errors=True)
    shutil.copytree(here / "docs", options.out / "docs")
    shutil.copy(here / "README.md", options.out)
    names = ["certify"] if options.built_in else ["certify", "results", "separations", "filters"]
    if options.built_in:
        documents.COMMANDS["certify"], options.data = ["certify"], here
    different = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            documents.measure(name, options, pathlib.Path(folder))
            old, new = counts_of(name, here), counts_of(name, options.out)
            both = old.keys() & new.keys()
            for key in sorted(both, key=str):
                if old[key] != new[key]:
                    different += 1
                    named = [f"{count} {now}, published {then}" for count, now, then in zip(COUNTS, new[key], old[key]) if now != then]
                    print(f"{name}: {key}: {'; '.join(named)}")
            print(f"{name}: {len(both)} rows of counts compared; {len(new) - len(both)} are about another number of queries")
        if not options.built_in:
            for document, text in documents.documents(options, pathlib.Path(folder)).items():
                (options.out / document).write_text(text)
    disk = sum(file.stat().st_size for place in (options.out, options.recorded, options.families) for file in place.rglob("*") if file.is_file())
    print(f"{different} counts differ; {time.monotonic() - begin:.0f} s, {disk / 1e6:.1f} MB in {options.out}"
          f"{'' if options.built_in else f' and {options.recorded}'}")
    return 1 if different else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (documents.Problem, OSError, ValueError) as problem:
        print(f"./run reproduce: {problem}", file=sys.stderr)
        sys.exit(2)
