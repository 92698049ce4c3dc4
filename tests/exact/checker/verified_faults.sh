#!/usr/bin/env bash
# verified_faults.sh [PATTERN]: each fault of verified_faults.txt (those whose name has the pattern) is planted in a
# copy of the checker's definitions. They compile, and then a proof fails: the table says which. Without a fault all
# compiles.
set -euo pipefail
readonly here=$(cd "$(dirname "$0")" && pwd)
readonly sources=$here/../../../exact/checker/verified
readonly folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

compile() { coqc -q -Q . Verified "$1" >output.txt 2>&1; }

# The theorem in whose proof the last compilation failed; nothing if it failed elsewhere.
failed_proof() {
  local line
  line=$(sed -n 's/^File "[^"]*", line \([0-9]*\).*/\1/p' output.txt | tail -1)
  head -n "${line:-0}" "$1" |
    sed -nE 's/^ *(Lemma|Theorem|Corollary) ([A-Za-z0-9_]+).*/\2/p; s/^(Fixpoint|Definition|Inductive|Record) .*/definition/p' |
    tail -1 | grep -v definition
}

cp "$sources"/*.v .
for file in Problem StepProblem Form Geometry Checker Step Proof Pairs Inversion StepProof StepPairs StepSequence; do
  compile "$file.v" || { echo "verified_faults.sh: $file.v does not compile without a fault" >&2; cat output.txt >&2; exit 1; }
done
mkdir sound
mv ./*.vo sound

status=0
while IFS=@ read -r name file text instead; do
  [[ $name == *"${1:-}"* ]] || continue
  cp "$sources"/*.v sound/*.vo .
  python3 - "$file" "$text" "$instead" <<'END'
import sys
file, text, instead = sys.argv[1:]
source = open(file).read()
if source.count(text) != 1:
    sys.exit(f"verified_faults.sh: {file} has {source.count(text)} times: {text}")
open(file, "w").write(source.replace(text, instead))
END
  stands='' failed=''
  case $file in
    Form.v) sources_after="Form Checker Proof Inversion" ;;
    Pairs.v | Inversion.v | StepSequence.v) sources_after=${file%.v} ;;
    StepProblem.v) sources_after="StepProblem Step StepProof StepPairs StepSequence" ;;
    Step.v) sources_after="Step StepProof" ;;
    *) sources_after="Checker Proof Inversion" ;;
  esac
  for source in $sources_after; do
    if ! compile "$source.v"; then
      failed=$(failed_proof "$source.v" || true)
      [ -n "$failed" ] && stands="$source.v, $failed"
      break
    fi
    # What depends on it is compiled anew.
    [ "$source" = Form ] && compile Geometry.v
  done
  if [ -n "$stands" ]; then
    printf '%-58s fails: %s\n' "$name" "$stands"
  else
    printf '%-58s NOT FOUND (%s)\n' "$name" "$(head -c 200 output.txt | tr '\n' ' ')"
    status=1
  fi
done < <(grep -v '^#' "$here/verified_faults.txt")
exit "$status"
