#!/usr/bin/env bash
# Installs the Debian packages listed in packages.txt, as far as they are missing: tools/setup/install_packages.sh [build|test|all|cluster]
# build: what the program needs; test: what its tests need, too; all (default): everything but the
# daemons of a cluster; cluster: only those. With sudo if you are not root.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case ${1:-all} in
  build) wanted=' build ' ;;
  test) wanted=' build test ' ;;
  all) wanted=' build test hand ' ;;
  cluster) wanted=' cluster ' ;;
  *) echo "usage: $0 [build|test|all|cluster]" >&2; exit 2 ;;
esac

missing=()
while read -r need package _; do
  [[ $wanted == *" $need "* ]] || continue
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done < "$here/packages.txt"
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "you are not root and there is no sudo: install these packages as root: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing: ${missing[*]}" >&2
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
