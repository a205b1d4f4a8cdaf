#!/usr/bin/env bash
# Instructions of each step per edge, pose or line: count_instructions.sh PROGRAM drive|grid|FILE SOLVER...
set -euo pipefail
program=$(realpath "$1")
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
valgrind --tool=callgrind --instr-atstart=no --collect-atstart=no --callgrind-out-file="$folder/count" \
    "$program" "$@" 2>"$folder/log" >&2 || { cat "$folder/log" >&2; exit 1; }
for file in $(ls -v "$folder"/count.*); do
  awk '/^desc: Trigger: Client Request:/ { name = $5; units = $6; unit = $7 }
       /^totals:/ { if (name != "") printf "%-32s %12.1f per %s\n", name, $2 / units, unit }' "$file"
done
