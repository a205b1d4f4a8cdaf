#!/usr/bin/env bash
# Sets everything up and fuses the bundled real drive with each GNSS modeling: tools/quickstart.sh [OUTPUT_FOLDER]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=${1:-$root/out/berlin_potsdamer_platz}

"$root/tools/setup/install_packages.sh" build
cd "$root"
cmake --preset quickstart >/dev/null
cmake --build --preset quickstart
exec build/release/bin/waymark run examples/berlin_potsdamer_platz/drive.yaml --out "$out" --modeling all
