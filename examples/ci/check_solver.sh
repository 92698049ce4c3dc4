#!/bin/sh
# Builds a solver as a plugin, judges it on queries of known truth, then searches for false negatives. The findings
# stay in their folder, and a page that shows them. Exit status: 0 no fault, 1 wrong answers, 2 another error.
#
#   check_solver.sh SOURCE LIBRARY
#
# SOURCE: a folder with the CMakeLists.txt of the plugin (such as examples/plugin); LIBRARY: its file in the build folder,
# such as box_overlap.so. Variables:
#   TOUCHSTONE          the program touchstone (found in the path)
#   TOUCHSTONE_INCLUDE  the folder that contains touchstone/plugin.h (this project's)
#   FINDINGS            a folder, new or empty, for the findings (findings)
#   BUILD               the build folder (build-plugin)
#   FUZZ_LIMIT          the length of the search (--seconds 120)
#   FUZZ_ONLY           the kinds of findings that fail the check (false_negative); see touchstone fuzz --help
#   SOLVER_OPTIONS      for certify and fuzz, such as "--exact --max-checks 100000"
#   CERTIFY_OPTIONS     for certify, such as a folder of datasets
#   BASELINE            a file of known wrong answers, as certify --write-baseline writes it; only new ones fail
set -u

if [ $# -ne 2 ]; then
  echo "usage: check_solver.sh SOURCE LIBRARY" >&2
  exit 2
fi
touchstone=${TOUCHSTONE:-touchstone}
include=${TOUCHSTONE_INCLUDE:-$(cd "$(dirname "$0")/../../verify/include" && pwd)}
findings=${FINDINGS:-findings}
build=${BUILD:-build-plugin}
plugin=$build/$2

cmake -S "$1" -B "$build" -DCMAKE_BUILD_TYPE=Release -DTOUCHSTONE_INCLUDE="$include" && cmake --build "$build" || exit 2

# Both run whatever the result of the first, so that the folder holds all findings.
mkdir -p "$findings" || exit 2
# The words of these variables are options.
# shellcheck disable=SC2086
"$touchstone" certify --plugin "$plugin" ${SOLVER_OPTIONS:-} --json "$findings/certify.json" \
  ${BASELINE:+--baseline "$BASELINE"} ${CERTIFY_OPTIONS:-}
certified=$?

only=
for kind in ${FUZZ_ONLY:-false_negative}; do only="$only --only $kind"; done
# shellcheck disable=SC2086
"$touchstone" fuzz --plugin "$plugin" ${SOLVER_OPTIONS:-} $only ${FUZZ_LIMIT:---seconds 120} --json "$findings/fuzz.json"
fuzzed=$?
if [ $fuzzed -eq 1 ]; then "$touchstone" view "$findings/fuzz.json" --out "$findings/fuzz.html"; fi

echo "certify: $certified, fuzz: $fuzzed (0 nothing is wrong, 1 wrong answers); see $findings"
if [ $certified -eq 1 ] || [ $fuzzed -eq 1 ]; then exit 1; fi
if [ $certified -ne 0 ] || [ $fuzzed -ne 0 ]; then exit 2; fi
