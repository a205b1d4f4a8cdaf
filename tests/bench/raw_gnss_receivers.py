#!/usr/bin/env python3
"""Simulates raw GNSS receivers under an open sky, in a town and in a canyon, and fuses their drives:
raw_gnss_receivers.py PROGRAM FOLDER [--seeds N] [--duration S] [--run ARGUMENTS]

Way and odometry are those of `PROGRAM simulate --preset urban`; the pseudoranges and range rates of 48 satellites in
circular orbits take the place of the fixes. Their errors are those of plugins/gnss_raw/README.md with other sigmas: a
white part, reflections that last 30 s and come late, one value per satellite for the whole drive; the first two
times 10^((45 - C/N0) / 20). FOLDER gets a drive for each receiver and seed. A row per receiver: for each drive RMSE in
metres, mean NEES and the share inside 95 %. Nothing but Python is needed.
"""
import argparse
import bisect
import csv
import json
import math
import random
import shlex
import subprocess
from pathlib import Path

LIGHT_MPS, EARTH_RADPS, EARTH_GM = 299792458.0, 7.2921151467e-5, 3.986005e14
ORBIT_M, PLANES, SLOTS = 26_560_000.0, 6, 8
LASTING_S, SKEW, RATE_SIGMA_MPS, LOWEST_RAD = 30, 0.8, 0.1, math.radians(10)
# sigma of the white part, of reflections and of what stays, m; mean and spread of C/N0, dB-Hz; share of satellites
RECEIVERS = {"open": (0.3, 0.5, 1.5, 48, 1, 1.0), "town": (0.6, 2, 2, 38, 4, 0.8), "canyon": (0.6, 6, 2, 35, 6, 0.7)}
FIELDS = ["t", "system", "satellite", "pseudorange", "range_rate", "satellite_x", "satellite_y", "satellite_z",
          "satellite_vx", "satellite_vy", "satellite_vz", "elevation", "cn0"]
SENSOR = """sensors:
  - name: gnss_raw
    file: raw.csv
    columns: {time: t}
    options: {satellites_at: reception}

"""


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Place:
    """A moment of the vehicle: ECEF position, upward direction and velocity."""

    def __init__(self, truth, speed_mps):
        latitude, longitude = math.radians(float(truth["latitude_deg"])), math.radians(float(truth["longitude_deg"]))
        height, heading = float(truth["height_m"]), float(truth["heading_rad"])
        sin_b, cos_b, sin_l, cos_l = math.sin(latitude), math.cos(latitude), math.sin(longitude), math.cos(longitude)
        e2 = 6.69437999014e-3
        normal = 6378137.0 / math.sqrt(1 - e2 * sin_b**2)
        self.t = float(truth["time_s"])
        self.at = ((normal + height) * cos_b * cos_l, (normal + height) * cos_b * sin_l,
                   (normal * (1 - e2) + height) * sin_b)
        self.up = (cos_b * cos_l, cos_b * sin_l, sin_b)
        east, north = speed_mps * math.cos(heading), speed_mps * math.sin(heading)
        self.velocity = (-sin_l * east - sin_b * cos_l * north, cos_l * east - sin_b * sin_l * north, cos_b * north)


def in_orbit(satellite, t, axes_at):
    """Where a satellite is at t, in the axes of the Earth at another moment."""
    plane, slot = divmod(satellite, SLOTS)
    argument = 2 * math.pi * slot / SLOTS + 0.45 * plane + math.sqrt(EARTH_GM / ORBIT_M**3) * t
    node = 2 * math.pi * plane / PLANES - EARTH_RADPS * axes_at
    inclination = math.radians(55)
    x, y = ORBIT_M * math.cos(argument), ORBIT_M * math.sin(argument) * math.cos(inclination)
    return (x * math.cos(node) - y * math.sin(node), x * math.sin(node) + y * math.cos(node),
            ORBIT_M * math.sin(argument) * math.sin(inclination))


def as_received(satellite, t, at):
    """Where a satellite was when the signal left that arrives at t, in the axes of that moment."""
    travel_s = 0.075
    for _ in range(3):
        left = in_orbit(satellite, t - travel_s, t)
        travel_s = math.dist(left, at) / LIGHT_MPS
    return left


class Fading:
    """Gauss-Markov processes of variance 1, one for each satellite."""

    def __init__(self, rng):
        self.rng, self.last = rng, {}

    def at(self, satellite, t):
        value = self.rng.gauss(0, 1)
        if satellite in self.last:
            before_t, before = self.last[satellite]
            decay = math.exp((before_t - t) / LASTING_S)
            value = decay * before + math.sqrt(1 - decay**2) * value
        self.last[satellite] = (t, value)
        return value


def write_ranges(receiver, places, seed, path):
    white_m, multipath_m, slow_m, strength, spread, share = RECEIVERS[receiver]
    rng = random.Random(f"{receiver} {seed}")
    seen = [k for k in range(PLANES * SLOTS) if rng.random() < share]
    slow = {k: rng.gauss(0, slow_m) for k in seen}
    reflections, fading = Fading(rng), Fading(rng)
    bias_m, drift_mps = rng.uniform(-1e5, 1e5), rng.uniform(-50, 50)
    with open(path, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(FIELDS)
        before_t = places[0].t
        for place in places:
            bias_m += drift_mps * (place.t - before_t)
            before_t = place.t
            for k in seen:
                left = as_received(k, place.t, place.at)
                distance = math.dist(left, place.at)
                towards = [(a - b) / distance for a, b in zip(left, place.at)]
                elevation = math.asin(sum(a * b for a, b in zip(towards, place.up)))
                if elevation < LOWEST_RAD:
                    continue
                cn0 = min(50, strength + spread * fading.at(k, place.t))
                obliquity = math.sqrt(1 / max(0.2, math.sin(elevation)))
                weakness = 10 ** (max(0, 45 - cn0) / 20)
                late = math.expm1(SKEW * reflections.at(k, place.t)) / SKEW
                error = (white_m * rng.gauss(0, 1) + multipath_m * late) * weakness * obliquity + slow[k] * obliquity
                velocity = [after - before for before, after in zip(as_received(k, place.t - 0.5, place.at),
                                                                    as_received(k, place.t + 0.5, place.at))]
                rate = sum(u * (a - b) for u, a, b in zip(towards, velocity, place.velocity)) + drift_mps
                writer.writerow([f"{place.t:.3f}", 1, k + 1, f"{distance + bias_m + error:.4f}",
                                 f"{rate + RATE_SIGMA_MPS * weakness * rng.gauss(0, 1):.4f}",
                                 *(f"{x:.4f}" for x in left), *(f"{x:.5f}" for x in velocity), f"{elevation:.5f}",
                                 f"{cn0:.1f}"])


def make_drive(program, receiver, seed, duration_s, folder):
    subprocess.run([program, "simulate", "--preset", "urban", "--duration", str(duration_s), "--seed", str(seed), "-o",
                    folder, "-q"], check=True, stdout=subprocess.DEVNULL)
    odometry = [(float(row["time_s"]), float(row["speed_mps"])) for row in rows_of(folder / "odometry.csv")]
    truth = [row for row in rows_of(folder / "truth.csv") if float(row["time_s"]) % 1 < 1e-3]
    speed_at = lambda t: odometry[min(bisect.bisect_left(odometry, (t, -1e9)), len(odometry) - 1)][1]
    write_ranges(receiver, [Place(row, speed_at(float(row["time_s"]))) for row in truth], seed, folder / "raw.csv")
    drive = (folder / "drive.yaml").read_text()
    (folder / "raw.yaml").write_text(drive[:drive.index("gnss:\n")] + SENSOR + drive[drive.index("truth:\n"):])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--duration", type=int, default=240, help="seconds of each drive")
    parser.add_argument("--run", default="", help="further arguments of `PROGRAM run`, in quotes")
    given = parser.parse_args()
    for receiver in RECEIVERS:
        cells = []
        for seed in range(1, given.seeds + 1):
            folder = given.folder / f"{receiver}_{seed}"
            make_drive(given.program, receiver, seed, given.duration, folder)
            subprocess.run([given.program, "run", folder / "raw.yaml", "-o", folder / "out", "-q", *shlex.split(given.run)],
                           check=True, stderr=subprocess.DEVNULL)
            fused = json.loads((folder / "out/metrics.json").read_text())["evaluations"][0]["truth"]
            cells.append(f"{fused['fused']['position']['rmse_m']:5.2f} m {fused['consistency']['nees_mean']:4.1f} "
                         f"{100 * fused['consistency']['coverage_95']:3.0f} %")
        print(f"{receiver:8s}", " | ".join(cells), flush=True)


if __name__ == "__main__":
    main()
