#!/usr/bin/env python3
"""Shows that the same input gives the same bytes: for any number of threads, folder, locale and time zone.

determinism.py PROGRAM SOURCE_FOLDER [SHIM]   SHIM: of instruction_set_shim.cpp; with it, vector instructions are limited too

Wall times are the one exception. They stand under the keys `seconds` and `*_seconds` of JSON files, in the pages
(*.html) and in the figure `report-seconds`; these are not compared.

AVX2 gives the bytes of AVX-512, but for the name of the kernels. SSE2 has no fused multiply-add, and neither has the C
library without it (sines, logarithms). There the results are rounded otherwise, and these bounds hold:

- Positions of a modeling with stated noise (g1) differ by less than 1e-9 m, their sigmas by less than 1e-8 of themselves.
- The search for noise (correlated) ends elsewhere within its tolerance: positions differ by less than 0.01 sigma, and
  sigmas by less than 0.01 of themselves.
"""
import csv, json, os, pathlib, re, subprocess, sys, tempfile

program, source = map(os.path.abspath, sys.argv[1:3])
shim = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None
drive = pathlib.Path(source) / "examples/berlin_potsdamer_platz/drive.yaml"
surroundings = {
    "as it is": ({}, "1"),
    "two threads": ({}, "2"),
    "five threads": ({}, "5"),
    "another time zone": ({"TZ": "Asia/Kathmandu"}, "2"),
    "another locale": ({"LC_ALL": "de_DE.UTF-8", "LANGUAGE": "de"}, "2"),
    "the plain locale": ({"LC_ALL": "C"}, "1"),
}
rounded_otherwise = {
    "a C library without fused multiply-add": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"},
}
if shim:
    limited = lambda instructions: {"LD_PRELOAD": shim, "WAYMARK_TEST_INSTRUCTIONS": instructions}
    surroundings["AVX2"] = (limited("avx2"), "2")
    rounded_otherwise["SSE2"] = limited("sse2")
kernels = re.compile(rb"(?<=supernodes, )(avx512|avx2|portable)")
# Largest differences: of positions in sigmas and in metres, and of sigmas relative to themselves.
bounds = {"g1": (1, 1e-9, 1e-8), "correlated": (0.01, 1, 0.01)}


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k != "seconds" and not k.endswith("_seconds")}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def content(path):
    if path.suffix == ".json":
        return kernels.sub(b"", json.dumps(without_times(json.loads(path.read_text()))).encode())
    return kernels.sub(b"", path.read_bytes())


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


def differences(modeling, first, second):
    """Of two trajectories: of positions in sigmas and in metres, and of sigmas, relative. Infinite if the epochs differ."""
    tables = [list(csv.DictReader(found[f"out/{modeling}.csv"].decode().splitlines())) for found in (first, second)]
    if [row["stamp_ns"] for row in tables[0]] != [row["stamp_ns"] for row in tables[1]]:
        return (float("inf"),) * 3
    largest = [0.0, 0.0, 0.0]
    for a, b in zip(*tables):
        for axis in "xy":
            metres = abs(float(a[f"{axis}_m"]) - float(b[f"{axis}_m"]))
            sigma = float(a[f"sigma_{axis}_m"])
            found = (metres / sigma, metres, abs(float(b[f"sigma_{axis}_m"]) / sigma - 1))
            largest = [max(pair) for pair in zip(largest, found)]
    return largest


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
    for name, environment in rounded_otherwise.items():
        folder = pathlib.Path(scratch) / name.replace(" ", "_")
        folder.mkdir()
        found = results(folder, environment, "2")
        for modeling, bound in bounds.items():
            largest = differences(modeling, first, found)
            text = "positions {:.1e} sigma, {:.1e} m; sigmas {:.1e}".format(*largest)
            print(f"{name}: {modeling}: {text}")
            if any(a >= b for a, b in zip(largest, bound)):
                wrong.append(f"{name}: {modeling} differs by more than the bound: {text}")
if wrong:
    sys.exit("\n".join(wrong))
