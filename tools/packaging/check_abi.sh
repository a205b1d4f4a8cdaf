#!/usr/bin/env bash
# Does NEW_LIB still serve what was built against OLD_LIB?  check_abi.sh OLD_LIB NEW_LIB
# Compares functions, variables and the layout of every type in the public headers, which are looked for in the folder
# `include` beside or above each library. Needs debug information (-g) in both; without it only symbols are compared.
# Exit code 0: yes (symbols may have been added). 1: no, with abidiff's report. 2: wrong usage.
set -euo pipefail

[[ $# -eq 2 && -f ${1-} && -f ${2-} ]] || { echo "usage: check_abi.sh OLD_LIB NEW_LIB (two files)" >&2; exit 2; }
command -v abidiff >/dev/null || { echo "check_abi.sh: no abidiff; it is in Debian's package abigail-tools" >&2; exit 2; }

headers_of() {
  local folder
  folder=$(dirname "$(realpath "$1")")
  while [[ $folder != / ]]; do
    [[ -d $folder/include ]] && { echo "$folder/include"; return; }
    folder=$(dirname "$folder")
  done
  echo "check_abi.sh: no folder 'include' beside or above $1" >&2
  exit 2
}
old_headers=$(headers_of "$1")
new_headers=$(headers_of "$2")

for library in "$1" "$2"; do
  readelf -S "$library" | grep -q '\.debug_info' || echo "note: $library has no debug information: only its symbols are compared" >&2
done
status=0
abidiff --headers-dir1 "$old_headers" --headers-dir2 "$new_headers" --drop-private-types --no-added-syms \
  "$1" "$2" || status=$?
# abidiff's exit code is a sum: 1 error, 2 usage, 4 something changed, 8 surely incompatible.
if (( status & 3 )); then exit 2; fi
if (( status )); then
  echo "not compatible: raise the minor version (0.x) or the major one (from 1.0 on); plugins/README.md, \"ABI and versions\""
  exit 1
fi
echo "compatible"
