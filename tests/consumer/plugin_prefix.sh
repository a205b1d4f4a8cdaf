#!/bin/sh
# A plugin is installed into the prefix of the waymark that it was built against, or where --prefix says; the program
# finds those of its own prefix, even if that was moved.
# usage: plugin_prefix.sh CMAKE BUILD_OF_WAYMARK PREFIX BUILD_OF_PLUGIN FOLDER PLUGIN_SUBFOLDER
set -eu
cmake=$1 waymark_build=$2 prefix=$3 plugin_build=$4 folder=$5 subfolder=$6
fail() { echo "FAILED: $1"; exit 1; }

rm -rf "$folder"
mkdir -p "$folder"
grep -q "^CMAKE_INSTALL_PREFIX:PATH=$prefix\$" "$plugin_build/CMakeCache.txt" || fail "the prefix is not that of the package"
"$cmake" --install "$plugin_build" --prefix "$folder/other" >/dev/null
test -e "$folder/other/$subfolder/gnss_lever_arm.so" || fail "--prefix is ignored"
WAYMARK_PLUGIN_PATH="$folder/other/$subfolder" "$prefix/bin/waymark" info | grep -q EDGE_MY_ANTENNA || fail "WAYMARK_PLUGIN_PATH"

"$cmake" --install "$waymark_build" --prefix "$folder/before" >/dev/null
"$cmake" --install "$plugin_build" --prefix "$folder/before" >/dev/null
mv "$folder/before" "$folder/moved"
"$folder/moved/bin/waymark" info | grep -q EDGE_MY_ANTENNA || fail "the program does not look into its own prefix"
echo "found in every prefix"
