#!/usr/bin/env bash
# The Python package under valgrind: memory.sh BUILD, a folder that was built with WAYMARK_WITH_PYTHON.
# Fails if an error or a definite leak passes through the package or a library of Waymark.
set -euo pipefail
[[ $# -eq 1 ]] || { echo "usage: memory.sh BUILD" >&2; exit 2; }
build=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
log=$(mktemp)
trap 'rm -f "$log"' EXIT

PYTHONPATH=$build/python PYTHONMALLOC=malloc PYTHONDONTWRITEBYTECODE=1 OPENBLAS_NUM_THREADS=1 \
  WAYMARK_SOURCE_DIR=$here/../.. WAYMARK_PROGRAM=$build/bin/waymark \
  valgrind --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite --num-callers=40 --log-file="$log" \
  --suppressions=/usr/lib/valgrind/python3.supp /usr/bin/python3 "$here/memory.py"

# A report is the lines up to an empty one; those of Python and numpy alone are not ours.
ours=$(awk -v RS= '/_waymark|libwaymark/ && /Invalid|uninitialised|Mismatched|definitely lost in/' \
       <(sed 's/^==[0-9]*== *//' "$log"))
if [[ -n $ours ]]; then
  echo "$ours" >&2
  exit 1
fi
grep -E "ERROR SUMMARY|definitely lost:" "$log" | sed 's/^==[0-9]*== *//'
echo "no error passes through the package"
