#!/usr/bin/env bash
# slurm.sh FOLDER PARTS COMMAND…: a command of touchstone in parts as an array of Slurm, of at most 1001 tasks where
# the site has not set MaxArraySize. Tasks without a result are submitted again. FOLDER/I.json is the result of part I,
# FOLDER.json their sum.
#
# Example: slurm.sh run 100 touchstone certify queries --method tight_inclusion
set -euo pipefail
folder=$1 parts=$2
shift 2
mkdir -p "$folder"
printf -v words '%q ' "$@" --threads 1 --json "$folder"
words="${words% }/\$SLURM_ARRAY_TASK_ID.json --shard \$SLURM_ARRAY_TASK_ID/$parts"
tasks=0-$((parts - 1))
for _ in 1 2 3; do
  # Waits for all tasks.
  sbatch --wait --array="$tasks" --output "$folder-%a.log" --wrap "$words" >/dev/null || true
  tasks=$(for i in $(seq 0 $((parts - 1))); do [ -e "$folder/$i.json" ] || echo "$i"; done | paste -sd,)
  [ -n "$tasks" ] || break
done
exec "$1" merge "$folder"/*.json --json "$folder.json"
