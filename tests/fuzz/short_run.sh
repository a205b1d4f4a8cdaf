#!/bin/sh
# short_run.sh PROGRAM SHARED_DATA FOLDER: the short run of every target, with seeds made in FOLDER, in 2 GB of memory.
set -eu
ulimit -v 2000000
here=$(cd "$(dirname "$0")" && pwd)
program=$1
mkdir -p "$3"
"$here/make_seeds.py" "$2" "$3/seeds"
cd "$3"
exec "$program" seeds 3000 1.2
