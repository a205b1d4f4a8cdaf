#!/usr/bin/env python3
"""Shows that the same input gives the same bytes: for any number of threads, folder, locale and time zone.

determinism.py PROGRAM SOURCE_FOLDER

Wall times are the one exception. They stand under the keys `seconds` and `*_seconds` of JSON files, in the pages
(*.html) and in the figure `report-seconds`; these are not compared.
"""
import json, os, pathlib, subprocess, sys, tempfile

program, source = map(os.path.abspath, sys.argv[1:3])
drive = pathlib.Path(source) / "examples/berlin_potsdamer_platz/drive.yaml"
surroundings = {
    "as it is": ({}, "1"),
    "two threads": ({}, "2"),
    "five threads": ({}, "5"),
    "another time zone": ({"TZ": "Asia/Kathmandu"}, "2"),
    "another locale": ({"LC_ALL": "de_DE.UTF-8", "LANGUAGE": "de"}, "2"),
    "the plain locale": ({"LC_ALL": "C"}, "1"),
}


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k != "seconds" and not k.endswith("_seconds")}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def content(path):
    if path.suffix == ".json":
        return json.dumps(without_times(json.loads(path.read_text()))).encode()
    return path.read_bytes()


def results(folder, environment, threads):
    """All outputs of three commands, by name."""
    graph = "out/g1.graph"
    for command in (
        ["run", str(drive), "-m", "g1,correlated", "-o", "out", "--threads", threads],
        ["optimize", graph, "-o", "out/optimized.graph", "--covariance", "all", "--covariance-file", "out/covariance.csv",
         "--threads", threads],
        ["convert", graph, "-o", "out/converted.graph"],
    ):
        done = subprocess.run([program, *command], cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{command}: exit code {done.returncode}: {done.stderr}")
    files = sorted(p for p in (folder / "out").rglob("*") if p.is_file() and p.suffix != ".html" and p.stem != "report-seconds")
    return {str(p.relative_to(folder)): content(p) for p in files}


wrong = []
with tempfile.TemporaryDirectory() as scratch:
    first = None
    for number, (name, (environment, threads)) in enumerate(surroundings.items()):
        folder = pathlib.Path(scratch) / ("x" * (7 * number + 1))
        folder.mkdir()
        found = results(folder, environment, threads)
        first = first or found
        if found.keys() != first.keys():
            wrong.append(f"{name}: other files: {sorted(found.keys() ^ first.keys())}")
        wrong += [f"{name}: {file} differs" for file in first if found.get(file) != first[file]]
    print(f"{len(first)} files of {len(surroundings)} surroundings compared")
if wrong:
    sys.exit("\n".join(wrong))
