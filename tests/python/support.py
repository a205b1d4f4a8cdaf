"""What the tests of the Python package share: the bundled drive, as files and as arrays."""

import os
import pathlib

import numpy as np

ROOT = pathlib.Path(os.environ["WAYMARK_SOURCE_DIR"])
PROGRAM = os.environ["WAYMARK_PROGRAM"]
DRIVE = ROOT / "examples/berlin_potsdamer_platz/drive.yaml"


def read_csv(name: str) -> np.ndarray:
    """Read a log of the bundled drive as a structured array."""
    return np.genfromtxt(DRIVE.parent / name, delimiter=",", names=True)


def odometry() -> dict[str, np.ndarray]:
    log = read_csv("odometry_50hz.csv")
    return {"time": log["gps_sow_s"], "speed": log["v_mps"], "yaw_rate": log["yawrate_radps"]}


def gnss() -> dict[str, np.ndarray]:
    log = read_csv("gnss_5hz.csv")
    return {"time": log["gps_sow_s"], "latitude": log["lat_deg"], "longitude": log["lon_deg"],
            "height": log["h_m"], "accuracy": log["hacc_m_first_60s_only"]}


def truth() -> dict[str, np.ndarray]:
    log = read_csv("truth_5hz.csv")
    return {"time": log["gps_sow_s"], "latitude": log["lat_deg"], "longitude": log["lon_deg"],
            "height": log["h_m"], "heading": log["heading_rad_ccw_from_east"]}


def described() -> dict[str, object]:
    """The drive.yaml of the bundled drive with arrays in the place of its logs."""
    week = {"week": 1900}
    return {
        "name": "Berlin, Potsdamer Platz",
        "odometry": {"samples": odometry(), "time": week},
        "gnss": {"samples": gnss(), "time": week, "period": 1,
                 "accuracy": {"meaning": "drms", "default_sigma": 5}},
        "truth": {"samples": truth(), "time": week},
    }
