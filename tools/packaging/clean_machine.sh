#!/usr/bin/env bash
# A stranger's first hour: a bare Debian 12 in a scratch folder, the packages, and the commands of plugins/README.md as they stand
# there.  clean_machine.sh PACKAGES SCRATCH   (as root, with network; needs debootstrap)
# PACKAGES: folder that build_packages.sh filled. SCRATCH/rootfs is made where it is absent and is used again otherwise.
set -euo pipefail
[[ $# -eq 2 ]] || { echo "usage: clean_machine.sh PACKAGES SCRATCH" >&2; exit 2; }
packages=$(realpath "$1")
mkdir -p "$2"
scratch=$(realpath "$2")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$scratch/rootfs

if [[ ! -e $root/etc/debian_version ]]; then
  echo "== a bare Debian 12"
  debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian >"$scratch/debootstrap.log"
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
echo 'Dpkg::Use-Pty "0";' >"$root/etc/apt/apt.conf.d/99scratch"  # there is no /dev/pts

# The commands: every ```sh block of the tutorial's section, in order, nothing added.
rm -rf "$root/root/tutorial"
mkdir -p "$root/root/tutorial"
cp "$packages"/*.deb "$root/root/tutorial"
awk '/^## /{inside = /^## Writing a plugin in an afternoon/} /^```/{block = inside && /^```sh$/; next} inside && block' \
  "$here/../../plugins/README.md" >"$root/root/tutorial/commands.sh"
[[ -s $root/root/tutorial/commands.sh ]] || { echo "no commands in plugins/README.md" >&2; exit 1; }

echo "== the tutorial's commands"
chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C \
  bash -c 'cd /root/tutorial && set -exo pipefail && . ./commands.sh' 2>&1 | tee "$scratch/tutorial.log"

echo "== what must have come out"
for line in "EDGE_MY_ANTENNA .*\[gnss_lever_arm\]" "no problems found" "-> 0.18 " "^VERTEX_SE2 3 20 10 1.57079632679"; do
  grep -qe "$line" "$scratch/tutorial.log" || { echo "not found: $line" >&2; exit 1; }
  echo "found: $line"
done
[[ $(grep -c "no problems found" "$scratch/tutorial.log") -eq 2 ]] || { echo "the installed plugin was not loaded by itself" >&2; exit 1; }

echo "== the other packages, and out again without a trace"
chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C bash -c '
  set -euo pipefail
  cd /root/tutorial
  rm -r /usr/lib/*/waymark  # what the tutorial has installed
  apt-get install -y -qq ./*.deb >/dev/null
  waymark info >/dev/null
  grep -q SPDX-2.3 /usr/share/doc/waymark/waymark.spdx.json
  python3 -c "import waymark; print(waymark.fuse(\"/usr/share/doc/waymark-doc/examples/berlin_potsdamer_platz/drive.yaml\"))"
  apt-get purge -y -qq "*waymark*" >/dev/null
  left=$(find /usr /etc /var/lib/dpkg/info -name "*waymark*")
  [[ -z $left ]] || { echo "left behind: $left" >&2; exit 1; }'
rm "$root/etc/apt/apt.conf.d/99scratch"
echo "the clean machine's path is clear"
