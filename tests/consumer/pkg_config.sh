#!/usr/bin/env bash
# One compiler call with pkg-config's answer, and the program runs: pkg_config.sh PREFIX LIBDIR FOLDER SOURCE COMPILER [FLAGS...]
set -euo pipefail
prefix=$1 libdir=$2 folder=$3 source=$4
shift 4
command -v pkg-config >/dev/null || { echo "SKIPPED: no pkg-config"; exit 0; }
export PKG_CONFIG_PATH="$prefix/$libdir/pkgconfig" LD_LIBRARY_PATH="$prefix/$libdir"
pkg-config --exact-version=0.1.0 waymark || { echo "waymark.pc does not give the version" >&2; exit 1; }
mkdir -p "$folder"
read -ra answer <<< "$(pkg-config --cflags --libs waymark)"
"$@" -std=c++20 "$source" -o "$folder/consumer" "${answer[@]}"
"$folder/consumer"
