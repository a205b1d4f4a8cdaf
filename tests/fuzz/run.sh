#!/bin/sh
# Fuzzes for a while: tests/fuzz/run.sh SECONDS [TARGET...]; see README.md. Ends with 1 where anything was found.
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:?seconds for each target}
shift
mkdir -p build
shared=${WAYMARK_SHARED_DATA:-$PWD/../shared/data}

if [ -z "${WAYMARK_FUZZ_BUILT:-}" ]; then
  cmake --preset fuzz >build/fuzz_configure.log 2>&1 || { cat build/fuzz_configure.log; exit 2; }
  cmake --build --preset fuzz
fi
work=build/fuzz/work
mkdir -p "$work"
tests/fuzz/make_seeds.py "$shared" "$work/seeds"
# shellcheck disable=SC2046 # names of targets are words
[ $# -gt 0 ] || set -- $(grep -o 'Target{"[a-z0-9_]*' tests/fuzz/targets.cpp | cut -d'"' -f2)

found=0
printf '%-12s %10s %8s %8s %9s %8s\n' target runs seconds corpus coverage findings
for target in "$@"; do
  mkdir -p "$work/corpus/$target" "$work/found/$target"
  dictionary=
  [ ! -f "$work/seeds/$target.dict" ] || dictionary="-dict=$work/seeds/$target.dict"
  # What is kept of a finding is the input; -timeout, -rss_limit_mb and -malloc_limit_mb make hangs and greed findings.
  "build/fuzz/bin/waymark_fuzz_$target" -max_total_time="$seconds" -max_len=16384 -timeout=10 -rss_limit_mb=2048 \
    -malloc_limit_mb=256 -use_value_profile=1 -print_final_stats=1 -artifact_prefix="$work/found/$target/" $dictionary \
    "$work/corpus/$target" "$work/seeds/$target" >"$work/$target.log" 2>&1 || true
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$target.log")
  took=$(sed -n 's/^Done [0-9]* runs in \([0-9]*\) second.*/\1/p' "$work/$target.log")
  coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$work/$target.log" | tail -1)
  corpus=$(find "$work/corpus/$target" -type f | wc -l)
  findings=$(find "$work/found/$target" -type f | wc -l)
  printf '%-12s %10s %8s %8s %9s %8s\n' "$target" "${runs:--}" "${took:--}" "$corpus" "${coverage:--}" "$findings"
  [ "$findings" -eq 0 ] || found=1
done
[ "$found" -eq 0 ] || echo "findings lie in $work/found; each target's output in $work/TARGET.log"
exit "$found"
