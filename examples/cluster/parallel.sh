#!/usr/bin/env bash
# parallel.sh FOLDER PARTS COMMAND…: a command of touchstone in parts by GNU parallel, on this machine or, with
# parallel's --sshloginfile, on others with the same file system. Parts that are killed run again. FOLDER/I.json is the
# result of part I, FOLDER.json their sum.
#
# Example: parallel.sh run 8 touchstone certify queries --method tight_inclusion
set -euo pipefail
folder=$1 parts=$2
shift 2
mkdir -p "$folder"
# A part ends with 1 for wrong answers, too; the status of the run is that of the merge.
seq 0 $((parts - 1)) |
  parallel --quote --retries 3 --joblog "$folder.joblog" bash -c '"$@"; [ $? -le 1 ]' - \
    "$@" --threads 1 --shard "{}/$parts" --json "$folder/{}.json" >"$folder.log" || true
exec "$1" merge "$folder"/*.json --json "$folder.json"
