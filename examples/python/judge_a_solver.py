"""Judge a solver of thirty lines, and see it convicted (naive_cubic.py)."""

import pathlib
import sys

import touchstone

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from naive_cubic import naive_cubic

if __name__ == "__main__":
    # The built-in set: degenerate queries whose truth is known by construction.
    judgement = touchstone.judge(naive_cubic, count=2)
    print(judgement)

    # A search for the simplest query that it answers wrongly.
    report = touchstone.fuzz(naive_cubic, seconds=10)
    print(report)
    finding = report.findings[0]
    print("proof of the truth:", touchstone.check(finding.certificate))
    touchstone.view(finding).save("finding.html")
