#!/usr/bin/env bash
# One compiler call with pkg-config's answer, and the program runs.
# pkg_config.sh VERSION PREFIX LIBDIR FOLDER SOURCE COMPILER [FLAGS...]
set -euo pipefail
version=$1 prefix=$2 libdir=$3 folder=$4 source=$5
shift 5
command -v pkg-config >/dev/null || { echo "SKIPPED: no pkg-config"; exit 0; }
export PKG_CONFIG_PATH="$prefix/$libdir/pkgconfig" LD_LIBRARY_PATH="$prefix/$libdir"
pkg-config --exact-version="$version" waymark || { echo "waymark.pc does not give version $version" >&2; exit 1; }
mkdir -p "$folder"
read -ra answer <<< "$(pkg-config --cflags --libs waymark)"
"$@" -std=c++20 "$source" -o "$folder/consumer" "${answer[@]}"
"$folder/consumer"
