#!/usr/bin/env python3
"""Makes drives whose odometry is worth little, fuses them, and prints the errors beside those of the fixes.

    poor_odometry.py PROGRAM FOLDER [--courses lap,town,...] [--faults none,dead,...] [--seeds 1,2]

PROGRAM is the waymark program; drives and results are written below FOLDER. Each lasts eight minutes: odometry at
25 Hz, fixes at 1 Hz that are off by 2 m for half a minute (Gauss-Markov) and by 0.5 m each.
"""

import argparse
import json
import math
import os
import random
import subprocess

LENGTH_S = 480
RATE_HZ = 25
LATITUDE, LONGITUDE = math.radians(48.1), math.radians(11.5)

DRIVE_YAML = """odometry: {file: odometry.csv, columns: {time: time, speed: speed, yaw_rate: yaw_rate}}
gnss: {file: gnss.csv, columns: {time: time, latitude: lat, longitude: lon, accuracy: accuracy}}
truth: {file: truth.csv, columns: {time: time, latitude: lat, longitude: lon}}
"""


def blocks(speed, period_s, turn_s, sides):
    """Straight ways, each with a quarter turn at its end."""

    def course(drawn):
        side = [drawn.choice(sides) for _ in range(int(LENGTH_S / period_s) + 1)]
        quarter = math.pi / 2 / turn_s
        return lambda t: (speed, side[int(t / period_s)] * quarter if t % period_s > period_s - turn_s else 0)

    return course


def lap(drawn):
    half_circle_s = math.pi * 40 / 14
    way_s = 80 / 14

    def motion(t):
        phase = t % (way_s + half_circle_s)
        return 14, 14 / 40 if phase > way_s else 0

    return motion


def roundabouts(drawn):
    return lambda t: (9, 9 / 18 if t % 30 > 20 else -0.5 if t % 30 > 18 else 0)


def field(drawn):
    return lambda t: (3, (1 if int(t / 60) % 2 == 0 else -1) * math.pi / 10 if t % 60 > 50 else 0)


COURSES = {
    "lap": lap,
    "roundabouts": roundabouts,
    "carpark": blocks(3, 14, 4, [-1, 1, 1]),
    "robot": blocks(1.2, 40, 3, [-1, 1]),
    "town": blocks(10, 20, 4, [-1, 1, 0]),
    "field": field,
}

FAULTS = {
    "none": lambda t, speed, turn, drawn: (speed, turn),
    "dead": lambda t, speed, turn, drawn: (speed, 0),
    "weak": lambda t, speed, turn, drawn: (speed, 0.3 * turn),
    "strong": lambda t, speed, turn, drawn: (speed, 1.15 * turn),
    "dropouts": lambda t, speed, turn, drawn: (speed, 0 if t % 200 > 120 else turn),
    "slip": lambda t, speed, turn, drawn: (1.35 * speed if t % 240 > 120 else speed, turn),
    "bias": lambda t, speed, turn, drawn: (speed, turn + 0.2),
    "noise": lambda t, speed, turn, drawn: (speed, turn + drawn.gauss(0, 0.5)),
}


def degrees(east, north):
    flattening = 1 - 0.00669438 * math.sin(LATITUDE) ** 2
    normal = 6378137 / math.sqrt(flattening)
    meridian = normal * (1 - 0.00669438) / flattening
    return (math.degrees(LATITUDE + north / meridian),
            math.degrees(LONGITUDE + east / (normal * math.cos(LATITUDE))))


def make(folder, course, fault, seed):
    drawn = random.Random(seed)
    motion = COURSES[course](drawn)
    decay = math.exp(-1 / 30)
    lasting = [drawn.gauss(0, 2), drawn.gauss(0, 2)]
    x, y, heading = 0.0, 0.0, 0.7
    os.makedirs(folder, exist_ok=True)
    with open(folder + "/odometry.csv", "w") as odometry, open(folder + "/gnss.csv", "w") as gnss, \
            open(folder + "/truth.csv", "w") as truth:
        odometry.write("time,speed,yaw_rate\n")
        gnss.write("time,lat,lon,accuracy\n")
        truth.write("time,lat,lon\n")
        for i in range(LENGTH_S * RATE_HZ):
            t = i / RATE_HZ
            speed, turn = motion(t)
            read = FAULTS[fault](t, 1.01 * speed + drawn.gauss(0, 0.05), turn + 0.002 + drawn.gauss(0, 0.003), drawn)
            odometry.write("%.3f,%.4f,%.6f\n" % ((t,) + read))
            if i % 5 == 0:
                truth.write("%.3f,%.9f,%.9f\n" % ((t,) + degrees(x, y)))
            if i % RATE_HZ == 0:
                east, north = (place + off + drawn.gauss(0, 0.5) for place, off in zip((x, y), lasting))
                gnss.write("%.3f,%.9f,%.9f,2.5\n" % ((t,) + degrees(east, north)))
                lasting = [decay * off + drawn.gauss(0, 2 * math.sqrt(1 - decay**2)) for off in lasting]
            along = heading + turn / RATE_HZ / 2
            x += speed / RATE_HZ * math.cos(along)
            y += speed / RATE_HZ * math.sin(along)
            heading += turn / RATE_HZ
    with open(folder + "/drive.yaml", "w") as file:
        file.write(DRIVE_YAML)


def errors(program, folder):
    """RMSE of the fused positions and of the fixes, in metres; or the exit code."""
    done = subprocess.run([program, "run", folder + "/drive.yaml", "-o", folder + "/out", "-q"], capture_output=True)
    if done.returncode != 0:
        return "exit %d" % done.returncode
    with open(folder + "/out/metrics.json") as file:
        truth = json.load(file)["evaluations"][0]["truth"]
    return "%.2f/%.2f" % (truth["fused"]["position"]["rmse_m"], truth["gnss"]["position"]["rmse_m"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--courses", default=",".join(COURSES))
    parser.add_argument("--faults", default=",".join(FAULTS))
    parser.add_argument("--seeds", default="1,2")
    arguments = parser.parse_args()
    print("| course | fault | fused/raw, m |\n|---|---|---|")
    for course in arguments.courses.split(","):
        for fault in arguments.faults.split(","):
            found = []
            for seed in arguments.seeds.split(","):
                folder = "%s/%s_%s_%s" % (arguments.folder, course, fault, seed)
                make(folder, course, fault, int(seed))
                found.append(errors(arguments.program, folder))
            print("| %s | %s | %s |" % (course, fault, ", ".join(found)), flush=True)


if __name__ == "__main__":
    main()
