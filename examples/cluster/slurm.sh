#!/usr/bin/env bash
# slurm.sh FOLDER WORKERS COMMAND…: a command of touchstone in pieces as an array of Slurm, of at most 1001 tasks where
# the site has not set MaxArraySize. Tasks that fail are submitted again: only their unfinished pieces are done.
#
# Example: slurm.sh run 100 touchstone certify queries --json all.json
set -euo pipefail
folder=$1 workers=$2
shift 2
printf -v words '%q ' "$@" --threads 1 --resume "$folder" --shard
words+="\$SLURM_ARRAY_TASK_ID/$workers"
for _ in 1 2 3; do
  # Waits for all tasks.
  sbatch --wait --array="0-$((workers - 1))" --output "$folder-%a.log" --wrap "$words" >/dev/null || true
  "$1" merge "$folder" >/dev/null 2>&1 || [ $? -ne 2 ] || continue
  break
done
exec "$1" merge "$folder"
