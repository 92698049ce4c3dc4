#!/usr/bin/env bash
# tidy.sh BUILD_FOLDER FILE: clang-tidy of a file of BUILD_FOLDER's compile_commands.json, unless the same text passed
# the same checks before. The text is preprocessed, comments included, so an unchanged file, in any folder, costs a
# second.
set -euo pipefail
build=$1 file=$2
cache=${XDG_CACHE_HOME:-$HOME/.cache}/touchstone/tidy
mkdir -p "$cache"

# A command in CMake's format, with a line each: "command": "…", "file": "…".
command=$(awk -v file="$file" '
  /^  "command": / { command = $0 }
  /^  "file": / && index($0, "\"" file "\"") { print command; exit }' "$build/compile_commands.json" |
  sed -e 's/^  "command": "//' -e 's/",$//' -e 's/\\"/"/g' -e 's/\\\\/\\/g' \
    -e 's/ -o [^ ]* / /')
[ -n "$command" ] || { echo "tidy.sh: $build does not compile $file" >&2; exit 1; }

# A unit of several sources (*.cxx, made by CMake) includes them, which a check would report, and a local name of one
# may hide a global one of another; the compiler checks that in each source.
checks=() configuration=.clang-tidy
[[ $file == *.cxx ]] && checks=(--checks=-bugprone-suspicious-include --extra-arg=-Wno-shadow)
[[ $file == "$PWD"/tests/* ]] && configuration=tests/.clang-tidy
key=$({
  clang-tidy --version
  cat .clang-tidy "$configuration" cmake/tidy.sh
  eval "$command -E -C -P"
} | sha256sum | cut -d ' ' -f 1)
[ -e "$cache/$key" ] && exit 0
clang-tidy --quiet -p "$build" "${checks[@]}" --extra-arg=-Wno-unknown-warning-option --extra-arg=-Qunused-arguments "$file" \
  2> >(grep -v 'warnings generated' >&2)
touch "$cache/$key"
