#!/bin/sh
# short_run.sh PROGRAM SHARED_DATA FOLDER: the short run of every target, with seeds made in FOLDER.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=$1
mkdir -p "$3"
"$here/make_seeds.py" "$2" "$3/seeds"
cd "$3"
exec "$program" seeds 3000 1.2
