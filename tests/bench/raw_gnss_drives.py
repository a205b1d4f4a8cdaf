#!/usr/bin/env python3
"""Makes the drives that plugins/gnss_raw/MEASUREMENTS.md measures: raw_gnss_drives.py SHARED_DATA OUTDIR

SHARED_DATA holds drives/berlin_potsdamer_platz, drives/berlin_potsdamer_platz_raw and drives/urbannav_hk_tst.
OUTDIR gets librsf.yaml (libRSF's pseudoranges with range rates of GPS), rinex.yaml (the RINEX file of the same
receiver) and urbannav.yaml (RINEX); and, to compare, drives with fixes: receiver_fixes.yaml (the u-blox's own, every
second), single_point_fixes.yaml (from libRSF's pseudoranges), urbannav_fixes.yaml (RTKLIB's). UrbanNav has no
odometry: it is imitated from the truth, 5 Hz, with a scale of 0.8 % and a gyro bias of 0.8 mrad/s. Nothing but Python
is needed.
"""
import csv
import math
import sys
from pathlib import Path

FIELDS = ["t", "system", "satellite", "pseudorange", "range_rate", "satellite_x", "satellite_y", "satellite_z",
          "satellite_vx", "satellite_vy", "satellite_vz", "elevation_deg", "cn0"]
LIBRSF = """sensors:
  - name: gnss_raw
    file: librsf.csv
    columns: {time: t, elevation: {column: elevation_deg, unit: deg}}
    time: {week: 1900}
"""
BERLIN = """time: {{scale: gps}}
odometry: {{file: {drive}/odometry_50hz.csv, columns: {{time: gps_sow_s, speed: v_mps, yaw_rate: yawrate_radps}},
           time: {{week: 1900}}}}
truth:
  file: {drive}/truth_5hz.csv
  columns: {{time: gps_sow_s, latitude: lat_deg, longitude: lon_deg, height: h_m, heading: heading_rad_ccw_from_east}}
  time: {{week: 1900}}
"""
URBANNAV = """time: {{scale: gps}}
odometry: {{file: urbannav_odometry.csv, columns: {{time: t, speed: speed, yaw_rate: yaw_rate}}, time: {{week: 2158}}}}
truth:
  file: {drive}/truth_1hz.csv
  columns: {{time: gps_sow_s, latitude: lat_deg, longitude: lon_deg, height: h_m, heading: heading_rad_ccw_from_east}}
  time: {{week: 2158}}
"""
RECEIVER_FIXES = """gnss:
  file: {drive}/gnss_5hz.csv
  columns: {{time: gps_sow_s, latitude: lat_deg, longitude: lon_deg, height: h_m, accuracy: hacc_m_first_60s_only}}
  time: {{week: 1900}}
  accuracy: {{meaning: drms, default_sigma: 5}}
  period: 1
"""
SINGLE_POINT_FIXES = """gnss:
  file: single_point_fixes.csv
  columns: {time: t, latitude: latitude, longitude: longitude, accuracy: sigma}
  time: {week: 1900}
"""
SCALE, BIAS_RADPS, RATE_HZ = 1.008, 0.0008, 5
BERLIN_START_S = 126641.7  # of its week; libRSF counts from here


def rates_of(path):
    """Range rate and velocity of each satellite, by time in tenths of a second, system and number."""
    with open(path) as file:
        return {(round(10 * float(r["gps_sow_s"])), int(r["system"]), int(r["sat"])):
                [r["range_rate_mps"], r["sat_vx_mps"], r["sat_vy_mps"], r["sat_vz_mps"]] for r in csv.DictReader(file)}


def write_librsf_table(ranges, rates, path):
    """Joins libRSF's lines `pseudorange3 t range variance x y z satellite system elevation cn0` with range rates."""
    known = rates_of(rates)
    with open(ranges) as file, open(path, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(FIELDS)
        for line in file:
            word, *numbers = line.split()
            if word != "pseudorange3":
                continue
            t, distance, _, x, y, z, satellite, system, elevation, cn0 = numbers
            stamp = float(t) + BERLIN_START_S
            rate, vx, vy, vz = known.get((round(10 * stamp), int(float(system)), int(float(satellite))), [""] * 4)
            writer.writerow([f"{stamp:.3f}", int(float(system)), int(float(satellite)), distance, rate, x, y, z,
                             vx, vy, vz, elevation, cn0])


def write_single_point_fixes(fixes, path):
    """Puts fixes of libRSF's time on that of the week, with their mean sigma per axis."""
    with open(fixes) as file, open(path, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["t", "latitude", "longitude", "sigma"])
        for r in csv.DictReader(file):
            sigma = math.hypot(float(r["sig_e_m"]), float(r["sig_n_m"])) / math.sqrt(2)
            writer.writerow([f"{float(r['t_s']) + BERLIN_START_S:.3f}", r["lat_deg"], r["lon_deg"], f"{sigma:.3f}"])


def imitate_odometry(truth, path):
    with open(truth) as file:
        rows = [(float(r["gps_sow_s"]), float(r["speed_mps"]), float(r["heading_rad_ccw_from_east"]))
                for r in csv.DictReader(file)]
    with open(path, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["t", "speed", "yaw_rate"])
        for (t, speed, heading), (t_next, speed_next, heading_next) in zip(rows, rows[1:]):
            yaw_rate = math.remainder(heading_next - heading, 2 * math.pi) / (t_next - t)
            for k in range(round(RATE_HZ * (t_next - t))):
                part = k / RATE_HZ / (t_next - t)
                writer.writerow([f"{t + k / RATE_HZ:.3f}", f"{SCALE * (speed + part * (speed_next - speed)):.5f}",
                                 f"{yaw_rate + BIAS_RADPS:.6f}"])


def main():
    drives, out = Path(sys.argv[1]).resolve() / "drives", Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    raw, berlin, urbannav = (drives / name for name in
                             ("berlin_potsdamer_platz_raw", "berlin_potsdamer_platz", "urbannav_hk_tst"))
    write_librsf_table(raw / "libRSF_input.txt", raw / "doppler_gps.csv", out / "librsf.csv")
    imitate_odometry(urbannav / "truth_1hz.csv", out / "urbannav_odometry.csv")
    (out / "librsf.yaml").write_text(BERLIN.format(drive=berlin) + LIBRSF)
    (out / "rinex.yaml").write_text(BERLIN.format(drive=berlin) + f"""gnss:
  file: {raw}/rover.obs
  navigation: [{raw}/brdc1580.16n, {raw}/brdc1580.16g]
  antenna: [0.5, 0]
""")
    (out / "urbannav.yaml").write_text(URBANNAV.format(drive=urbannav) + f"""gnss:
  file: {urbannav}/20210517.light-urban.tste.ublox.m8t.GC.obs
  navigation: {urbannav}/hksc137c.nav
""")
    (out / "receiver_fixes.yaml").write_text(BERLIN.format(drive=berlin) + RECEIVER_FIXES.format(drive=berlin))
    write_single_point_fixes(raw / "spp_fixes_own.csv", out / "single_point_fixes.csv")
    (out / "single_point_fixes.yaml").write_text(BERLIN.format(drive=berlin) + SINGLE_POINT_FIXES)
    (out / "urbannav_fixes.yaml").write_text(
        URBANNAV.format(drive=urbannav) + f"gnss: {{file: {urbannav}/rtklib_single_m8t.pos}}\n")


if __name__ == "__main__":
    sys.exit(__doc__) if len(sys.argv) != 3 else main()
