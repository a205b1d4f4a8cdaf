#!/usr/bin/env python3
"""Moves the fixes of simulated drives for five minutes, fuses them, and prints the errors beside those of the sound drives.

    biased_fixes.py PROGRAM FOLDER [--presets urban,highway,mixed] [--seeds 1,2,3,4] [--slides 0,5,20] [--metres 30]

PROGRAM is the waymark program; drives of 20 minutes and results are written below FOLDER. The fixes are displaced by
--metres from about 400 s on, and come back after 300 s. They take each of --slides seconds to move there and back.
"""

import argparse
import datetime
import json
import math
import os
import shutil
import subprocess

METRES_PER_DEGREE = 111200
BLOCK_S = 300


def displaced(line, begin_s, first_s, slide_s, metres, azimuth):
    report = json.loads(line)
    if "lat" not in report or "time" not in report:
        return line, first_s
    time_s = datetime.datetime.fromisoformat(report["time"].replace("Z", "+00:00")).timestamp()
    first_s = time_s if first_s is None else first_s
    since_s = time_s - first_s - begin_s
    left_s = BLOCK_S - since_s
    share = min(1, since_s / slide_s, left_s / slide_s) if slide_s > 0 else float(since_s >= 0 and left_s > 0)
    away = max(0, share) * metres / METRES_PER_DEGREE
    report["lat"] += away * math.cos(azimuth)
    report["lon"] += away * math.sin(azimuth) / math.cos(math.radians(report["lat"]))
    return json.dumps(report) + "\n", first_s


def move(sound, moved, begin_s, slide_s, metres, azimuth):
    shutil.copytree(sound, moved, dirs_exist_ok=True)
    first_s = None
    with open(os.path.join(sound, "gnss.json")) as source, open(os.path.join(moved, "gnss.json"), "w") as target:
        for line in source:
            line, first_s = displaced(line, begin_s, first_s, slide_s, metres, azimuth)
            target.write(line)


def fused(program, drive, out):
    """Returns the RMSE of the fused positions in m, and how many fixes were left out."""
    subprocess.run([program, "run", "-q", os.path.join(drive, "drive.yaml"), "-o", out], check=True,
                   stderr=subprocess.DEVNULL)
    with open(os.path.join(out, "metrics.json")) as file:
        result = json.load(file)["evaluations"][0]
    return result["truth"]["fused"]["position"]["rmse_m"], result["fixes"]["rejected"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--presets", default="urban,highway,mixed")
    parser.add_argument("--seeds", default="1,2,3,4")
    parser.add_argument("--slides", default="0,5,20")
    parser.add_argument("--metres", type=float, default=30)
    arguments = parser.parse_args()
    slides = [float(text) for text in arguments.slides.split(",")]
    sums = [0.0] * (len(slides) + 1)
    found = [0] * len(slides)
    count = 0
    print("RMSE [m] (fixes left out)", "sound", *("slide of %g s" % slide for slide in slides), sep="  ")
    for preset in arguments.presets.split(","):
        for seed in map(int, arguments.seeds.split(",")):
            sound = os.path.join(arguments.folder, "%s_%d" % (preset, seed))
            subprocess.run([arguments.program, "simulate", "-q", "--preset", preset, "--seed", str(seed), "--duration",
                            "1200", "-o", sound], check=True, stdout=subprocess.DEVNULL)
            results = [fused(arguments.program, sound, os.path.join(arguments.folder, "out"))]
            for i, slide_s in enumerate(slides):
                moved = os.path.join(arguments.folder, "moved")
                move(sound, moved, 350 + 37 * seed, slide_s, arguments.metres, 0.9 * seed)
                results.append(fused(arguments.program, moved, os.path.join(arguments.folder, "out")))
                found[i] += results[-1][1] > 0
            count += 1
            sums = [total + result[0] for total, result in zip(sums, results)]
            print("%-24s" % ("%s %d" % (preset, seed)), *("%.2f (%d)" % result for result in results), sep="  ",
                  flush=True)
    print("%-24s" % "mean", *("%.2f" % (total / count) for total in sums), sep="  ")
    print("%-24s" % "found", "-", *("%d of %d" % (n, count) for n in found), sep="  ")


if __name__ == "__main__":
    main()
