#!/usr/bin/env bash
# What hardens a program against its own defects, in binaries as they are: check_hardening.sh [--linked] FILE_OR_FOLDER...
# --linked: only what the linker does, which every build has; the compiler's part (stack protector, fortified functions) is
# that of packages. Ends with 1 and a line for each binary and property that is missing. Needs readelf.
set -euo pipefail
compiled=yes
[[ ${1-} != --linked ]] || { compiled=no; shift; }
[[ $# -gt 0 ]] || { echo "usage: check_hardening.sh [--linked] FILE_OR_FOLDER..." >&2; exit 2; }

seen=0
missing=0
complain() {
  echo "$1: $2"
  missing=$((missing + 1))
}

while IFS= read -r -d '' file; do
  [[ $(head -c 4 "$file" | tr -d '\0') == $'\177ELF' ]] || continue
  headers=$(readelf -W -l -h "$file")
  type=$(sed -n 's/^  Type: *\([A-Z]*\).*/\1/p' <<<"$headers")
  [[ $type == EXEC || $type == DYN ]] || continue  # not linked yet
  seen=$((seen + 1))
  dynamic=$(readelf -W -d "$file")
  symbols=$(readelf -W --dyn-syms "$file")
  [[ $type == DYN ]] || complain "$file" "not position independent (-fPIE -pie)"
  grep -q GNU_RELRO <<<"$headers" || complain "$file" "relocations stay writable (-z relro)"
  grep -qE 'BIND_NOW|Flags:.* NOW' <<<"$dynamic" || complain "$file" "relocations are bound late (-z now)"
  ! grep -q RWE <<<"$headers" || complain "$file" "a segment, or the stack, is both writable and executable"
  [[ $compiled == yes ]] || continue
  grep -q __stack_chk_fail <<<"$symbols" || complain "$file" "no stack protector (-fstack-protector-strong)"
  # Printing to a file is always replaced by the checked function; for copies the compiler often does not know the size.
  if grep -qE ' v?f?printf(@|$)' <<<"$symbols" && ! grep -qE ' __[a-z]+_chk(@|$)' <<<"$symbols"; then
    complain "$file" "no fortified function (-D_FORTIFY_SOURCE=2)"
  fi
done < <(find "$@" -type f -print0)

[[ $seen -gt 0 ]] || { echo "check_hardening.sh: no binary in $*" >&2; exit 2; }
echo "$seen binaries, $missing properties missing"
[[ $missing -eq 0 ]]
