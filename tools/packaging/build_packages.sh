#!/usr/bin/env bash
# The Debian packages, built from this tree and looked over by lintian: build_packages.sh OUTDIR
set -euo pipefail
[[ $# -eq 1 ]] || { echo "usage: build_packages.sh OUTDIR" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# The same sources give the same packages: times are those of the last commit.
if [[ -z ${SOURCE_DATE_EPOCH-} ]] && time=$(git log -1 --format=%ct 2>/dev/null); then
  export SOURCE_DATE_EPOCH=$time
fi
umask 022
# Nothing is written into the source tree.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --preset package -B "$work" >/dev/null
cmake --build "$work"
cpack --config "$work/CPackConfig.cmake" -B "$work/cpack"
mv "$work"/cpack/*.deb "$out"
for package in "$out"/*.deb; do
  dpkg-deb -x "$package" "$work/installed"
done
tools/packaging/check_hardening.sh "$work/installed"
if command -v lintian >/dev/null; then
  lintian --fail-on error --tag-display-limit 0 "$out"/*.deb 2> >(grep -v "running with root privileges" >&2)
else
  echo "note: no lintian, the packages were not looked over" >&2
fi
ls -l "$out"/*.deb
