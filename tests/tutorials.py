#!/usr/bin/env python3
"""Follows tutorials and transcripts: runs what their pages print, and compares what they print with what happens.

    tests/tutorials.py --tool build/release/touchstone docs/tutorials/prove_a_step.md
    tests/tutorials.py --clone CLONE docs/tutorials/prove_a_step.md       # by its text alone, in a clean clone
    tests/tutorials.py --write tests/transcripts/step.md                  # write down what the commands print now

Of the blocks of a page, in their order:
- `sh` is run by bash; the first failure ends the page. In front of it, `<!-- not run: REASON -->` leaves it out, and
  `<!-- clone -->` leaves it out unless --clone is given: it builds what a test has already.
- A block that begins with the comment `NAME: …`, NAME with a full stop, is written to the file NAME; if NAME begins with
  examples/, that file of the repository must have this text.
- `text` must be printed by the `sh` block before: its lines in their order, blanks compared loosely, … for anything.
- `console` is a transcript: a line `$ COMMAND` (lines `> …` continue it), all lines that it prints, errors included, and
  its exit status as `[N]` unless it is 0. … stands for anything within a line, a line of … for any lines.

Their commands find the tool and its checker by name, plugins for tests in $PLUGINS, and the sources in $TOUCHSTONE_SOURCE;
`json FILE EXPRESSION…` prints Python expressions of a JSON file, which they call j (items of generators one a line; without
an expression all members); `refused ARGUMENT…` prints why the tool refuses its arguments, with the status 2.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"(?:<!-- (not run: [^>]+|clone) -->\n)?^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PRELUDE = """set -e
json() { python3 -c '
import json, sys
j = json.load(open(sys.argv[1]))
values = map(eval, sys.argv[2:] or ["(f\\"{key}: {value}\\" for key, value in j.items())"])
print(*("\\n".join(map(str, value)) if hasattr(value, "__next__") else value for value in values))' "$@"; }
refused() { touchstone "$@" 2>&1 | sed '/^Run with --help/d'; local status=$PIPESTATUS; [ $status = 2 ] || echo "[$status]"; }"""
STEP = re.compile(r"^\$ (.*\n(?:> .*\n)*)((?:(?!\$ ).*\n)*)", re.MULTILINE)


def faults_of(expected, printed):
    """The expected lines that are not printed, in this order."""
    lines = [" ".join(line.split()) for line in printed.splitlines()]
    for line in expected.splitlines():
        words = " ".join(line.split())
        pattern = re.compile(".*".join(map(re.escape, words.split("…"))))
        found = next((i for i, candidate in enumerate(lines) if pattern.fullmatch(candidate)), None)
        if found is None:
            yield line
        elif words != "…":
            lines = lines[found + 1:]


def rewritten(expected, printed):
    """What was printed, with the … of the expected lines that it matches."""
    patterns = [(line, re.compile(".*".join(map(re.escape, line.split("…"))))) for line in expected.splitlines()
                if "…" in line and line != "…"]
    return "".join(next((line for line, pattern in patterns if pattern.fullmatch(actual)), actual) + "\n"
                   for actual in printed.splitlines())


def transcript_fault(expected, printed):
    """True if a transcript's lines are not what was printed; … stands for anything, a line of … for any lines."""
    lines = [" ".join(line.split()) for line in expected.splitlines()]
    pattern = "".join(r"(?:.*\n)*?" if line == "…" else ".*".join(map(re.escape, line.split("…"))) + r"\n" for line in lines)
    return not re.fullmatch(pattern, "".join(" ".join(line.split()) + "\n" for line in printed.splitlines()))


def follow(page, folder, options):
    """The faults of a page."""
    text = page.read_text()
    script, expected, steps, blocks = [PRELUDE], [], [], 0
    for block in BLOCK.finditer(text):
        mark, language, body = block.groups("")
        name = re.match(r"(?://|#) ([\w./-]+\.\w+)(?::.*)?\n", body)
        if name and name[1].startswith("examples/"):
            if (ROOT / name[1]).read_text() != body.split("\n", 1)[1]:
                yield f"{page}: this is not {name[1]}"
        elif name:
            script.append(f"cat >'{name[1]}' <<'END_OF_FILE'\n{body}END_OF_FILE")
        elif language == "sh" and not mark.startswith("not run") and (mark != "clone" or options.clone):
            blocks += 1
            script.append(f"echo '@@ {blocks}'\n{body}")
        elif language == "text":
            expected.append((blocks, body))
        elif language == "console":
            for step in STEP.finditer(body):
                blocks += 1
                steps.append((blocks, step, block.start(3)))
                command = step[1].replace("\n> ", "\n")
                script.append(f"echo '@@ {blocks}'\nset +e -o pipefail\n{command}echo \"[$?]\"\nset -e +o pipefail")
    environment = os.environ | {"TERM": "dumb", "LC_ALL": "C.UTF-8"}
    if not options.clone:
        environment |= {"TOUCHSTONE_SOURCE": str(ROOT), "TOUCHSTONE_BUILD": str(options.tool.parent),
                        "PLUGINS": str(options.tool.parent / "tests/plugins"),
                        # The python3 of Debian, which has NumPy.
                        "PATH": f"{options.tool.parent}:/usr/bin:{os.environ['PATH']}",
                        "PYTHONPATH": str(options.tool.parent / "python"), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["bash", "-c", "\n".join(script)], cwd=folder, env=environment, text=True, errors="replace",
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    # Without lines of progress, which commands print on a machine so loaded that they take long.
    output = re.sub(r"^.* \[#*\.*\] +\d+ %.*\n", "", done.stdout, flags=re.MULTILINE)
    printed = dict(re.findall(r"^@@ (\d+)\n(.*?)(?=^@@ \d+\n|\Z)", output, re.DOTALL | re.MULTILINE))
    if options.verbose:
        print(done.stdout)
    if done.returncode != 0 or len(printed) != blocks or blocks == 0:
        yield f"{page}: block {len(printed)} of {blocks} ended with {done.returncode}\n{done.stdout[-2000:]}"
        return
    for block, step, start in reversed(steps):
        actual = printed[str(block)].removesuffix("[0]\n")
        if transcript_fault(step[2], actual):
            yield f"{page}: $ {step[1]}prints\n{actual}and not\n{step[2]}"
            text = text[:start + step.start(2)] + rewritten(step[2], actual) + text[start + step.end(2):]
    if options.write:
        page.write_text(text)
    for block, body in expected:
        for line in faults_of(body, printed[str(block)]):
            yield f"{page}: block {block} does not print: {line}\nbut:\n{printed[str(block)][-1500:]}"


def main():
    parser = argparse.ArgumentParser(description="Follows tutorials and transcripts.")
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--tool", type=pathlib.Path, default=ROOT / "build/release/touchstone")
    parser.add_argument("--clone", type=pathlib.Path, help="a clone, in which the page begins")
    parser.add_argument("--write", action="store_true", help="write what the commands of transcripts print into the pages")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    options.tool = options.tool.resolve()
    faults = []
    for page in options.pages:
        with tempfile.TemporaryDirectory() as folder:
            found = list(follow(page, options.clone or folder, options))
        print(f"{page}: {'followed' if not found else 'FAULTS'}", flush=True)
        faults += found
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
