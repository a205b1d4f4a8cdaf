#!/usr/bin/env bash
# Sets everything up, builds with warnings as errors and runs all tests: tools/test.sh [CTEST_ARGUMENTS...]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$root/tools/setup/install_packages.sh" test
cd "$root"
cmake --preset test >/dev/null
cmake --build --preset test
tests=$(($(nproc) + 1))  # together they wait a quarter of their time: for browsers, clocks and each other
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
ctest --preset test --parallel "$tests" "$@" | tee "$log" || status=$?
skipped=$(grep -c '\*\*\*Skipped' "$log" || true)
echo "tests skipped because data or packages are missing: $skipped"
exit "$status"
