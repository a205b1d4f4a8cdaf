#!/usr/bin/env bash
# Compares the speed of two commits: compare_commits.sh BEFORE [AFTER]   (AFTER: HEAD)
#
# Both are built in a folder of their own and run the same jobs on the same input. Prints a table in Markdown:
# instructions (callgrind, repeatable), and processor times, measured in turn, with the median of their ratios.
#   REPEAT=7      timed runs of each job and commit
#   BUILDS=DIR    keeps the builds there for the next comparison
#   GRAPHS="..."  further graph files to optimise
set -euo pipefail
[[ $# -ge 1 && $# -le 2 ]] || { echo "usage: compare_commits.sh BEFORE [AFTER]" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
repeat=${REPEAT:-7}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
builds=$(realpath -m "${BUILDS:-$scratch/builds}")
mkdir -p "$builds"

# built COMMIT: builds it if that has not been done, and prints its folder of programs.
built() {
  local commit folder
  commit=$(git -C "$root" rev-parse --verify --short=12 "$1^{commit}")
  folder=$builds/$commit
  if [[ ! -e $folder/done ]]; then
    echo "building $1 ($commit)" >&2
    rm -rf "$folder"
    mkdir -p "$folder"
    git -C "$root" archive "$commit" | tar -x -C "$folder"
    (cd "$folder" && cmake --preset quickstart -DWAYMARK_BUILD_TESTS=ON -DWAYMARK_BUILD_BENCHMARKS=ON &&
      cmake --build build/release --target waymark waymark_instructions) >"$folder/log" 2>&1 ||
      { tail -20 "$folder/log" >&2; exit 1; }
    touch "$folder/done"
  fi
  echo "$folder/build/release/bin"
}

before=$(built "$1")
after=$(built "${2:-HEAD}")

# instructions PROGRAM ARGUMENTS...: of the whole process, in millions.
instructions() {
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null |
    awk '/Collected/ { printf "%.1f", $NF / 1e6 }'
}

# seconds PROGRAM ARGUMENTS...: processor time.
seconds() {
  local TIMEFORMAT='%U %S'
  { time "$@" >/dev/null 2>&1; } 2>&1 | awk '{ printf "%.3f", $1 + $2 }'
}

median() { sort -g | awk '{ v[NR] = $1 } END { printf "%.3f", NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }

# row NAME counted|timed ARGUMENTS...: one job of the program by both commits.
row() {
  local name=$1 kind=$2 i of_before of_after
  shift 2
  printf '| %s |' "$name"
  if [[ $kind == counted ]]; then
    of_before=$(instructions "$before/waymark" "$@")
    of_after=$(instructions "$after/waymark" "$@")
    printf ' %s | %s | %s |' "$of_before" "$of_after" "$(awk "BEGIN { printf \"%.3f\", $of_after / $of_before }")"
  else
    printf ' | | |'
  fi
  : >"$scratch/before"; : >"$scratch/after"; : >"$scratch/ratios"
  for ((i = 0; i < repeat; i++)); do
    of_before=$(seconds "$before/waymark" "$@")
    of_after=$(seconds "$after/waymark" "$@")
    echo "$of_before" >>"$scratch/before"
    echo "$of_after" >>"$scratch/after"
    awk "BEGIN { print $of_after / ($of_before > 0 ? $of_before : 0.001) }" >>"$scratch/ratios"
  done
  printf ' %s | %s | %s |\n' "$(median <"$scratch/before")" "$(median <"$scratch/after")" "$(median <"$scratch/ratios")"
}

# The inputs are made by the first commit, so that both read the same bytes.
drive=$root/examples/berlin_potsdamer_platz/drive.yaml
hour=$scratch/hour
"$before/waymark" simulate --preset paper-8 --seed 1 -o "$hour" -q
"$before/waymark" convert "$hour/drive.yaml" -m g1 -o "$scratch/g1.graph" -q
"$before/waymark" convert "$hour/drive.yaml" -m g2 -o "$scratch/g2.graph" -q

echo "| Job | million instructions before | after | ratio | s before | s after | median ratio |"
echo "|---|---|---|---|---|---|---|"
row "run, bundled drive, g2" counted run "$drive" -m g2 --out "$scratch/out" -q
row "run, bundled drive, default" counted run "$drive" --out "$scratch/out" -q
row "run, an hour, g2" timed run "$hour/drive.yaml" -m g2 --out "$scratch/out" -q
row "run, an hour, default" timed run "$hour/drive.yaml" --out "$scratch/out" -q
for modeling in g1 g2; do
  row "optimize, an hour, $modeling" counted optimize "$scratch/$modeling.graph" --start file -o "$scratch/fused.graph" -q
done
for graph in ${GRAPHS:-}; do
  row "optimize, $(basename "$graph")" counted optimize "$graph" -o "$scratch/fused.graph" -q
done

# Steps of an optimisation: instructions for each edge, pose or number.
for program in before after; do
  "$root/tests/bench/count_instructions.sh" "${!program}/waymark_instructions" drive block_cholesky >"$scratch/steps.$program"
done
echo
echo "| Step (drive, block_cholesky) | before | after | unit |"
echo "|---|---|---|---|"
join <(awk '{ print $1, $2, $4 }' "$scratch/steps.before" | sort) <(awk '{ print $1, $2 }' "$scratch/steps.after" | sort) |
  awk '{ printf "| %s | %s | %s | instructions per %s |\n", $1, $2, $4, $3 }'
