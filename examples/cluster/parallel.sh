#!/usr/bin/env bash
# parallel.sh FOLDER WORKERS COMMAND…: a command of touchstone in pieces by GNU parallel, on this machine or, with
# parallel's --sshloginfile, on others with the same file system. Workers that are killed are started again.
#
# Example: parallel.sh run 4 touchstone certify queries --json all.json
set -euo pipefail
folder=$1 workers=$2
shift 2
# A shard ends with 1 for wrong answers, too; the status of the run is that of the merge.
seq 0 $((workers - 1)) |
  parallel --quote --jobs "$workers" --retries 3 --joblog "$folder.joblog" \
    "$@" --threads 1 --resume "$folder" --shard "{}/$workers" >"$folder.log" || true
exec "$1" merge "$folder"
