#!/usr/bin/env bash
# mpirun.sh FOLDER WORKERS COMMAND…: a command of touchstone in pieces by mpirun. It ends all ranks when one fails; the
# run then goes on with the pieces that are left. An engine that starts each part alone serves better.
#
# Example: mpirun.sh run 4 touchstone certify queries --json all.json
set -euo pipefail
folder=$1 workers=$2
shift 2
# Open MPI asks root for it.
if [ "$(id -u)" = 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
for _ in 1 2 3; do
  mpirun --oversubscribe -n "$workers" "$@" --threads 1 --resume "$folder" --shard auto >"$folder.log" 2>&1 || true
  "$1" merge "$folder" >/dev/null 2>&1 || [ $? -ne 2 ] || continue
  break
done
exec "$1" merge "$folder"
