#!/usr/bin/env python3
"""Prints what a run of ctest did: the seconds and tests of each part, the slowest tests, what was skipped and why; and at the
end what it showed, and what to run next.

    ctest --output-junit tests.xml --test-output-size-passed 1000000
    tests/summary.py tests.xml

A part is a test program, all its shards together, or a kind of test that is no program (documents, transcript, …).
"""

import argparse
import collections
import re
import sys
import xml.etree.ElementTree

RAN = re.compile(r"^\[(?: +OK|  FAILED) +\] ([^,\s]+).* \((\d+) ms\)$", re.MULTILINE)
SKIPPED = re.compile(r"^(?:MISSING|SKIPPED:?) (.*)$", re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description="Prints what a run of ctest did.")
    parser.add_argument("file", help="written by ctest --output-junit")
    parser.add_argument("--slowest", type=int, default=20, help="of the slowest tests so many (default: %(default)s)")
    options = parser.parse_args()
    parts, slowest, failed = collections.defaultdict(lambda: [0.0, 0, 0]), [], []
    skipped = collections.Counter()
    for case in xml.etree.ElementTree.parse(options.file).getroot().iter("testcase"):
        name, seconds = case.get("name"), float(case.get("time"))
        text = case.findtext("system-out") or ""
        tests = [(int(ms) / 1000, test) for test, ms in RAN.findall(text)] or [(seconds, name)]
        part = parts[re.split(r"[./]", name)[0]]
        part[0] += seconds
        if case.get("status") == "notrun" or case.find("skipped") is not None:
            skipped[name if not SKIPPED.search(text) else SKIPPED.search(text)[1]] += 1
            continue
        part[1] += len(tests)
        if case.get("status") == "fail":
            part[2] += 1
            failed.append(name)
        slowest += tests
        skipped.update(SKIPPED.findall(text))
    print(f"{'part':<26}{'seconds':>9}{'tests':>7}")
    for name, (seconds, tests, failures) in sorted(parts.items(), key=lambda item: -item[1][0]):
        print(f"{name:<26}{seconds:>9.1f}{tests:>7}{'  FAILED' if failures else ''}")
    total = [sum(column) for column in zip(*parts.values())] or [0, 0, 0]
    print(f"{'all':<26}{total[0]:>9.1f}{total[1]:>7}")
    print(f"the {options.slowest} slowest:")
    for seconds, name in sorted(slowest, reverse=True)[:options.slowest]:
        print(f"{seconds:>9.1f} s  {name}")
    for reason, count in skipped.most_common():
        print(f"skipped: {reason}" + (f" ({count} times)" if count > 1 else ""))
    print(f"\nasked: {total[1]:,} tests of {len(parts)} parts; {sum(skipped.values())} skipped")
    print(f"found: {'FAILED: ' + ', '.join(failed) if failed else 'all passed'}")
    print("next: ", "./run test NAME runs the tests whose name matches" if failed else
          "./run certify judges solvers; ./run test all: browsers, Python, documents too; ./run soak: hours")


if __name__ == "__main__":
    sys.exit(main())
