#!/usr/bin/env python3
"""Damages the odometry of simulated drives, fuses them, and prints the errors beside those of the sound drives.

    odometry_faults.py PROGRAM FOLDER [--presets urban,rural,highway] [--seeds 3,4] [--faults slip,lock,...] [--live]

PROGRAM is the waymark program; drives and results are written below FOLDER. Faults begin 150 s after the start, or
where the vehicle next drives above 4 m/s; those that change the sign begin at a stop. With --live the drives are
replayed, and the poses are those that were published at their time.
"""

import argparse
import bisect
import csv
import datetime
import json
import math
import os
import subprocess

GPS_EPOCH = 315964800
LEAP_SECONDS = 18
BAD_INPUT = 3  # exit code


def read_csv(path):
    with open(path) as file:
        lines = [line for line in file if not line.startswith("#")]
    return lines[0], [[float(text) for text in line.split(",")] for line in lines[1:]]


def write_csv(path, header, rows, digits):
    with open(path, "w") as file:
        file.write(header)
        for row in rows:
            file.write(",".join("%.*f" % pair for pair in zip(digits, row)) + "\n")


def driving_from(rows, start_s, speed, length_s):
    """Index of the first sample from start_s on after which the speed stays above `speed` for length_s."""
    first = rows[0][0]
    since = None
    for i, row in enumerate(rows):
        if row[0] < first + start_s or row[1] <= speed:
            since = None
        elif since is None:
            since = i
        if since is not None and row[0] - rows[since][0] >= length_s:
            return since
    return None


def samples_during(rows, begin, length_s):
    return [row for row in rows[begin:] if row[0] <= rows[begin][0] + length_s]


def repeat(rows, columns):
    begin = driving_from(rows, 150, 4, 10)
    if begin is None:
        return False
    for row in samples_during(rows, begin, 20):
        for column in columns:
            row[column] = rows[begin][column]
    return True


def slip(rows, factors):
    for number, factor in enumerate(factors):
        begin = driving_from(rows, 150 + 60 * number, 4, 5)
        if begin is None:
            return number > 0
        for row in samples_during(rows, begin, 1):
            row[1] *= factor
    return True


def interpolated(rows, time):
    right = min(max(bisect.bisect_left(rows, [time]), 1), len(rows) - 1)
    a, b = rows[right - 1], rows[right]
    share = (time - a[0]) / (b[0] - a[0])
    return [(1 - share) * x + share * y for x, y in zip(a, b)]


def unwrapped(rows, column):
    for i in range(1, len(rows)):
        turns = round((rows[i][column] - rows[i - 1][column]) / (2 * math.pi))
        rows[i][column] -= 2 * math.pi * turns


class Backwards:
    """From a stop on, the vehicle drives back on its way for a time, and then forwards again."""

    def __init__(self, stop, length_s):
        self.stop, self.length_s = stop, length_s

    def when(self, time):
        """When the vehicle of the sound drive was where this one is."""
        since = time - self.stop
        if since <= 0:
            return time
        turns = min(1, since / self.length_s)
        back = 0.5 * self.length_s * (turns - math.sin(2 * math.pi * turns) / (2 * math.pi))
        on = max(0, since - self.length_s)
        return self.stop - back + (on * on / 8 if on < 4 else on - 2)

    def rate(self, time):
        return (self.when(time + 1e-3) - self.when(time - 1e-3)) / 2e-3


def reverse(folder, rows, length_s):
    moves = [i for i in range(len(rows) - 1) if rows[i][0] > rows[0][0] + 150]
    stop = next((rows[i][0] for i in moves if rows[i][1] < 0.01 <= rows[i + 1][1]), None)
    if stop is None:
        return False
    header, truth = read_csv(folder + "/truth.csv")
    unwrapped(truth, 4)
    backwards = Backwards(stop, length_s)
    with open(folder + "/gnss.json") as file:
        fixes = [json.loads(line) for line in file]
    for fix in fixes:
        if "lat" not in fix:
            continue
        utc = datetime.datetime.fromisoformat(fix["time"].replace("Z", "+00:00")).timestamp()
        time = utc - GPS_EPOCH + LEAP_SECONDS
        sound, moved = interpolated(truth, time), interpolated(truth, backwards.when(time))
        fix["lat"] += moved[1] - sound[1]
        fix["lon"] += moved[2] - sound[2]
        fix.pop("speed", None)
    with open(folder + "/gnss.json", "w") as file:
        file.writelines(json.dumps(fix) + "\n" for fix in fixes)
    places = [[row[0]] + interpolated(truth, backwards.when(row[0]))[1:] for row in truth]
    write_csv(folder + "/truth.csv", header, places, (2, 10, 10, 3, 6))
    sound = [list(row) for row in rows]
    for row in rows:
        reading, rate = interpolated(sound, backwards.when(row[0])), backwards.rate(row[0])
        row[1:] = [abs(reading[1] * rate), reading[2] * rate]
    return True


def read_as(rows, late_s=0, speed=1, yaw_rate=1):
    for row in rows:
        row[0], row[1], row[2] = row[0] + late_s, row[1] * speed, row[2] * yaw_rate
    return True


FAULTS = {
    "sound": lambda folder, rows: True,
    "speed repeats": lambda folder, rows: repeat(rows, [1]),
    "yaw rate repeats": lambda folder, rows: repeat(rows, [2]),
    "lock": lambda folder, rows: slip(rows, [0.05]),
    "slip": lambda folder, rows: slip(rows, [2.5]),
    "six slips": lambda folder, rows: slip(rows, [2.5, 0.05] * 3),
    "reverse 20 s": lambda folder, rows: reverse(folder, rows, 20),
    "reverse 60 s": lambda folder, rows: reverse(folder, rows, 60),
    "km/h as m/s": lambda folder, rows: read_as(rows, speed=3.6),
    "m/s as km/h": lambda folder, rows: read_as(rows, speed=1 / 3.6),
    "deg/s as rad/s": lambda folder, rows: read_as(rows, yaw_rate=math.degrees(1)),
    "rad/s as deg/s": lambda folder, rows: read_as(rows, yaw_rate=math.radians(1)),
    "clockwise": lambda folder, rows: read_as(rows, yaw_rate=-1),
    "3 s late": lambda folder, rows: read_as(rows, late_s=3),
    "18 s late": lambda folder, rows: read_as(rows, late_s=18),
}


def drive_with(program, folder, fault, preset, seed):
    """Writes a drive with a fault. Returns whether it has a place for the fault."""
    subprocess.run([program, "simulate", "-q", "--preset", preset, "--seed", seed, "-o", folder], check=True)
    header, rows = read_csv(folder + "/odometry.csv")
    if not FAULTS[fault](folder, rows):
        return False
    write_csv(folder + "/odometry.csv", header, rows, (3, 5, 7))
    return True


def quietly(command):
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)


def fused(program, folder):
    """Returns (RMSE, inside 95 % [%]); None for a drive that is refused."""
    command = [program, "run", "-q", folder + "/drive.yaml", "-o", folder + "/out"]
    run = subprocess.run(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    if run.returncode == BAD_INPUT:
        return None
    run.check_returncode()
    with open(folder + "/out/metrics.json") as file:
        truth = json.load(file)["evaluations"][0]["truth"]
    return truth["fused"]["position"]["rmse_m"], 100 * truth["consistency"]["coverage_95"]


def lived(program, folder):
    """Returns the same of the poses that were published at once, from the first tracking on."""
    quietly([program, "live", "-q", folder + "/drive.yaml", "-o", "csv:" + folder + "/live.csv?rate=5"])
    _, truth = read_csv(folder + "/truth.csv")
    metres = math.pi * 6371000 / 180
    squares, inside, tracks = [], 0, False
    with open(folder + "/live.csv") as file:
        for row in csv.DictReader(file):
            tracks = tracks or row["state"] == "tracking"
            if not tracks:
                continue
            place = interpolated(truth, float(row["time"]))
            y = metres * (float(row["latitude"]) - place[1])
            x = metres * (float(row["longitude"]) - place[2]) * math.cos(math.radians(place[1]))
            xx, xy, yy = (float(row[name]) for name in ("var_x", "cov_xy", "var_y"))
            inside += (yy * x * x - 2 * xy * x * y + xx * y * y) / (xx * yy - xy * xy) < 5.991
            squares.append(x * x + y * y)
    return math.sqrt(sum(squares) / len(squares)), 100 * inside / len(squares)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--presets", default="urban,rural,highway")
    parser.add_argument("--seeds", default="3,4")
    parser.add_argument("--faults", default=",".join(FAULTS))
    parser.add_argument("--live", action="store_true")
    given = parser.parse_args()
    drives = [(preset, seed) for preset in given.presets.split(",") for seed in given.seeds.split(",")]
    print("RMSE of fused positions [m] (inside 95 % [%])")
    print("%-18s" % "fault" + "".join("%15s" % " ".join(drive) for drive in drives))
    for fault in given.faults.split(","):
        cells = []
        for preset, seed in drives:
            folder = os.path.join(given.folder, "_".join([fault.translate(str.maketrans(" /", "__")), preset, seed]))
            if not drive_with(given.program, folder, fault, preset, seed):
                cells.append("-")
                continue
            errors = (lived if given.live else fused)(given.program, folder)
            cells.append("%.2f (%.0f)" % errors if errors else "refused")
        print("%-18s" % fault + "".join("%15s" % cell for cell in cells), flush=True)


if __name__ == "__main__":
    main()
