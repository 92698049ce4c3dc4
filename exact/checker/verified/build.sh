#!/usr/bin/env bash
# build.sh FOLDER: proves the checker, extracts and compiles it: FOLDER/touchstone-check-verified. What the theorems
# assume is written to FOLDER/assumptions.txt.
set -euo pipefail
readonly sources=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
cd "$1"
cp "$sources"/*.v "$sources"/*.ml .
for file in Problem StepProblem Form Geometry Checker Step; do
  coqc -q -Q . Verified "$file.v"
done
for file in Proof Pairs Inversion StepProof StepPairs StepSequence; do
  coqc -q -Q . Verified "$file.v"
done | tee assumptions.txt
# Axioms begin a line. No one is allowed that the real numbers of Coq's standard library do not have.
readonly real_numbers='Axioms:|ClassicalDedekindReals\.sig_(not|forall)_dec|FunctionalExtensionality\.functional_extensionality_dep'
if grep -E '^[^ ]' assumptions.txt | grep -vE "^($real_numbers)( :|$)"; then
  echo "build.sh: an axiom that is not one of Coq's reals" >&2
  exit 1
fi
coqc -q -Q . Verified Extract.v
ocamlfind ocamlopt -package zarith,unix -linkpkg -w -a -inline 100 integers.ml checker.mli checker.ml certificate.ml \
  elaborate.ml step_hints.ml step_certificate.ml main.ml -o touchstone-check-verified
