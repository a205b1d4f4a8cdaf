#!/usr/bin/env python3
"""Makes drives whose odometry is worth little, fuses them, and prints the errors beside those of the fixes.

    poor_odometry.py PROGRAM FOLDER [--courses lap,town,...] [--faults none,dead,...] [--seeds 1,2]

PROGRAM is the waymark program; drives and results are written below FOLDER. Each lasts eight minutes: odometry at
25 Hz, fixes at 1 Hz that are off by 2 m for half a minute (Gauss-Markov) and by 0.5 m each. Needs numpy.
"""

import argparse
import json
import os
import subprocess

import numpy as np

LENGTH_S = 480
RATE_HZ = 25
LATITUDE, LONGITUDE = np.radians(48.1), np.radians(11.5)

DRIVE_YAML = """odometry: {file: odometry.csv, columns: {time: time, speed: speed, yaw_rate: yaw_rate}}
gnss: {file: gnss.csv, columns: {time: time, latitude: lat, longitude: lon, accuracy: accuracy}}
truth: {file: truth.csv, columns: {time: time, latitude: lat, longitude: lon}}
"""


def blocks(t, speed, period_s, turn_s, sides, random):
    """Straight ways, each with a quarter turn at its end."""
    block = (t // period_s).astype(int)
    side = random.choice(sides, block.max() + 1)[block]
    return np.full_like(t, speed), np.where(t % period_s > period_s - turn_s, side * np.pi / 2 / turn_s, 0)


def lap(t, random):
    half_circle_s = np.pi * 40 / 14
    way_s = 80 / 14
    phase = t % (2 * (way_s + half_circle_s))
    bends = ((phase > way_s) & (phase < way_s + half_circle_s)) | (phase > 2 * way_s + half_circle_s)
    return np.full_like(t, 14), np.where(bends, 14 / 40, 0)


def roundabouts(t, random):
    phase = t % 30
    return np.full_like(t, 9), np.where(phase > 20, 9 / 18, np.where(phase > 18, -0.5, 0))


def field(t, random):
    side = np.where((t // 60).astype(int) % 2 == 0, 1, -1)
    return np.full_like(t, 3), np.where(t % 60 > 50, side * np.pi / 10, 0)


COURSES = {
    "lap": lap,
    "roundabouts": roundabouts,
    "carpark": lambda t, random: blocks(t, 3, 14, 4, [-1, 1, 1], random),
    "robot": lambda t, random: blocks(t, 1.2, 40, 3, [-1, 1], random),
    "town": lambda t, random: blocks(t, 10, 20, 4, [-1, 1, 0], random),
    "field": field,
}

FAULTS = {
    "none": lambda t, speed, turn: (speed, turn),
    "dead": lambda t, speed, turn: (speed, 0 * turn),
    "weak": lambda t, speed, turn: (speed, 0.3 * turn),
    "dropouts": lambda t, speed, turn: (speed, np.where(t % 200 > 120, 0, turn)),
    "slip": lambda t, speed, turn: (np.where(t % 240 > 120, 1.35 * speed, speed), turn),
    "bias": lambda t, speed, turn: (speed, turn + 0.2),
    "noise": lambda t, speed, turn: (speed, turn + np.random.default_rng(5).normal(0, 0.5, len(t))),
}


def write(path, header, rows, form):
    with open(path, "w") as file:
        file.write(header + "\n")
        for row in rows:
            file.write(form % tuple(row) + "\n")


def make(folder, course, fault, seed):
    random = np.random.default_rng(seed)
    t = np.arange(LENGTH_S * RATE_HZ) / RATE_HZ
    speed, turn = COURSES[course](t, random)
    heading = 0.7 + np.concatenate([[0], np.cumsum(turn / RATE_HZ)[:-1]])
    along = heading + turn / RATE_HZ / 2
    x = np.concatenate([[0], np.cumsum(speed / RATE_HZ * np.cos(along))[:-1]])
    y = np.concatenate([[0], np.cumsum(speed / RATE_HZ * np.sin(along))[:-1]])
    read_speed = 1.01 * speed + random.normal(0, 0.05, len(t))
    read_turn = turn + 0.002 + random.normal(0, 0.003, len(t))
    read_speed, read_turn = FAULTS[fault](t, read_speed, read_turn)

    at = np.arange(LENGTH_S - 1) * RATE_HZ
    decay = np.exp(-1 / 30)
    lasting = np.zeros((len(at), 2))
    lasting[0] = random.normal(0, 2, 2)
    for i in range(1, len(at)):
        lasting[i] = decay * lasting[i - 1] + random.normal(0, 2 * np.sqrt(1 - decay**2), 2)
    error = lasting + random.normal(0, 0.5, lasting.shape)

    def degrees(east, north):
        radii = 6378137 / np.sqrt(1 - 0.00669438 * np.sin(LATITUDE) ** 2)
        meridian = radii * (1 - 0.00669438) / (1 - 0.00669438 * np.sin(LATITUDE) ** 2)
        return (np.degrees(LATITUDE + north / meridian),
                np.degrees(LONGITUDE + east / (radii * np.cos(LATITUDE))))

    os.makedirs(folder, exist_ok=True)
    write(folder + "/odometry.csv", "time,speed,yaw_rate", zip(t, read_speed, read_turn), "%.3f,%.4f,%.6f")
    fixes = degrees(x[at] + error[:, 0], y[at] + error[:, 1])
    write(folder + "/gnss.csv", "time,lat,lon,accuracy", zip(t[at], *fixes), "%.3f,%.9f,%.9f,2.5")
    write(folder + "/truth.csv", "time,lat,lon", zip(t[::5], *degrees(x[::5], y[::5])), "%.3f,%.9f,%.9f")
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
