#!/usr/bin/env bash
# Shows that two builds of the program give the same bytes: compare_programs.sh BEFORE AFTER [DATA_FOLDER]
#
# Both run over the bundled drive, the drives of examples/drives and the graphs of DATA_FOLDER (default:
# ../shared/data beside the repository; what is absent is named and left out). Every output file and what is
# printed is compared. Measured times are the only thing taken out before. Exit code 1 if anything differs.
set -uo pipefail
[[ $# -ge 2 ]] || { echo "usage: compare_programs.sh BEFORE AFTER [DATA_FOLDER]" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
before=$(realpath "$1") after=$(realpath "$2") data=$(realpath -m "${3:-$root/../shared/data}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$root"

# Times that were measured: keys and texts that end in seconds, ms or "s of ..."; the same for both sides.
without_times() {
  local timed='/<figure class="figure" id="seconds">/'  # of pages that compare runs
  local data='b'
  grep -q 'class="figure" id="seconds"' "$1" && data='s/.*/PAGE DATA/'
  sed -E -e '/^<script type="application.json" id="page-data">/{' -e "$data" -e '}' -e "$timed,/<\/figure>/d" \
         -e 's/("[a-z_]*seconds": )[0-9.eE+-]+/\1TIME/' \
         -e 's/"(solve|linearize|structure|total)_ms": [0-9.eE+-]+/"\1_ms": TIME/' \
         -e 's/[0-9]+([.][0-9]+)?(e-[0-9]+)? ?(ms|us)\b/TIME/g' \
         -e 's/\bin [0-9]+([.][0-9]+)? s\b/in TIME/g' \
         -e 's/(<td>converged<\/td><td class="number">[0-9]+<\/td><td class="number">)[0-9.]+/\1TIME/' \
         -e 's/(iterations?), [0-9.]+ s/\1, TIME/' \
         -e 's/^(time|all starts|  -> .*) +[0-9.]+ s.*/\1 TIME/' "$1"
}

differing=0 compared=0
# compare NAME ARGUMENTS...: runs both, with OUT standing for the folder of the results.
compare() {
  local name=$1 side file
  shift
  for side in before after; do
    rm -rf "$scratch/out"
    mkdir -p "$scratch/out"
    "${!side}" "${@//OUT/$scratch/out}" >"$scratch/out/stdout" 2>"$scratch/out/stderr"
    echo "exit code $?" >>"$scratch/out/stdout"
    rm -rf "${scratch:?}/$side"
    mv "$scratch/out" "$scratch/$side"
  done
  local bad=() files
  files=$(cd "$scratch" && find before after -type f ! -name 'report-seconds.*' | sed 's#^[a-z]*/##' | sort -u)
  while read -r file; do
    compared=$((compared + 1))
    if ! cmp -s <(without_times "$scratch/before/$file" 2>&1) <(without_times "$scratch/after/$file" 2>&1); then
      bad+=("$file")
    fi
  done <<<"$files"
  if [[ ${#bad[@]} -eq 0 ]]; then
    echo "same      $name ($(wc -l <<<"$files") files)"
    return
  fi
  differing=$((differing + ${#bad[@]}))
  echo "DIFFERENT $name: ${bad[*]}"
  for file in "${bad[@]:0:3}"; do
    diff <(without_times "$scratch/before/$file" 2>&1) <(without_times "$scratch/after/$file" 2>&1) |
      head -6 | cut -c1-200 | sed 's/^/    /'
  done
}

bundled=examples/berlin_potsdamer_platz/drive.yaml
compare "run, bundled drive, all modelings" run $bundled --out OUT/run --modeling all
compare "convert, bundled drive" convert $bundled -o OUT/drive.graph
compare "inspect" inspect examples/berlin_potsdamer_platz/odometry_50hz.csv examples/berlin_potsdamer_platz/gnss_5hz.csv
compare "sync, bundled drive" sync $bundled
compare "simulate" simulate --preset urban --duration 120 --seed 7 -o OUT/simulated
compare "info" info
for drive in examples/drives/*.yaml; do
  name=$(basename "$drive" .yaml)
  folder=$data/drives/${name%_raw}
  [[ -d $folder ]] || { echo "absent    $name"; continue; }
  compare "run, $name" run "$drive" --out OUT/run
  compare "run, $name, g1 g2 g3" run "$drive" --out OUT/run --modeling g1,g2,g3
done
for graph in "$data"/graphs/*.g2o "$data"/graphs/*.graph; do
  [[ -f $graph ]] || { echo "absent    graphs"; break; }
  compare "optimize, $(basename "$graph")" optimize "$graph" -o OUT/optimised.graph
done
echo "$compared files compared, $differing differ"
[[ $differing -eq 0 ]]
