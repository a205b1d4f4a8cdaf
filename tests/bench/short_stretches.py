#!/usr/bin/env python3
"""Fuses short stretches of simulated drives that are sound, and prints what is claimed to be wrong with them.

    short_stretches.py PROGRAM FOLDER [--presets urban,two-odometries] [--seeds 1,2,3] [--lengths 60,90,135,200]

PROGRAM is the waymark program; drives of 15 minutes and results are written below FOLDER. A stretch begins every 150 s.
Told are warnings of clocks and of sources that are left out, errors, and results that are worse than raw GNSS.
"""

import argparse
import os
import re
import subprocess

DURATION_S = 900
EVERY_S = 150
PRESETS = "urban,rural,highway,mixed,two-odometries,varied,three-absolute"
CLAIMS = ("clock seems", "left out", "times as far", "error:")


def stretch_of(folder, begin_s, length_s):
    text = open(os.path.join(folder, "drive.yaml")).read()
    limits = f"{{from: {begin_s}, to: {begin_s + length_s}, scale:"
    path = os.path.join(folder, "stretch.yaml")
    with open(path, "w") as drive:
        drive.write(re.sub(r"\{scale:", limits, text, count=1))
    return path


def claims_of(program, drive, out):
    run = subprocess.run([program, "run", drive, "-o", out], capture_output=True, text=True)
    return [line for line in run.stderr.splitlines() if any(claim in line for claim in CLAIMS)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--presets", default=PRESETS)
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--lengths", default="60,90,135,200")
    options = parser.parse_args()
    for preset in options.presets.split(","):
        stretches = 0
        doubted = 0
        for seed in options.seeds.split(","):
            folder = os.path.join(options.folder, f"{preset}_{seed}")
            simulate = ["simulate", "--preset", preset, "--seed", seed, "--duration", str(DURATION_S), "-o", folder]
            subprocess.run([options.program, *simulate, "-q"], check=True)
            for length_s in map(int, options.lengths.split(",")):
                for begin_s in range(0, DURATION_S - length_s, EVERY_S):
                    drive = stretch_of(folder, begin_s, length_s)
                    claims = claims_of(options.program, drive, os.path.join(folder, "out"))
                    stretches += 1
                    doubted += bool(claims)
                    for claim in claims:
                        print(f"{preset} {seed}, {length_s} s from {begin_s} s: {claim}")
        print(f"{preset}: {doubted} of {stretches}", flush=True)


if __name__ == "__main__":
    main()
