"""The relative pose error of the program against an independent computation, by the definition of evo.

Usage: relative_pose_error.py PROGRAM SOURCE_FOLDER   (ctest calls it)

evo (github.com/MichaelGrupp/evo, `evo_rpe --delta D --delta_unit m --pairs_from_reference`) is in no Debian package.
Its definition is repeated here with homogeneous matrices, by numpy alone: E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) over pairs
of poses, with Q the reference and P the estimate; the pairs follow each other as soon as the reference has gone D.
"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("SKIPPED: python3-numpy is not installed")
    sys.exit(0)


def matrix(x, y, heading):
    """A pose in the plane as a rigid motion of space."""
    c, s = math.cos(heading), math.sin(heading)
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])


def pairs_by_path(reference, delta):
    ids, gone = [], 0.0
    for i, pose in enumerate(reference):
        before = reference[max(i - 1, 0)]
        gone += np.linalg.norm(pose[:3, 3] - before[:3, 3])
        if gone >= delta:
            ids.append(i)
            gone = 0.0
    return list(zip(ids, ids[1:]))


def relative_errors(reference, estimate, delta):
    """Translations [m] and rotations [rad] of all pairs."""
    translations, rotations = [], []
    for i, j in pairs_by_path(reference, delta):
        moved = np.linalg.inv(reference[i]) @ reference[j]
        error = np.linalg.inv(moved) @ (np.linalg.inv(estimate[i]) @ estimate[j])
        translations.append(np.linalg.norm(error[:3, 3]))
        # The angle of a rotation matrix about any axis.
        rotations.append(math.atan2(np.linalg.norm([error[2, 1] - error[1, 2], error[0, 2] - error[2, 0],
                                                    error[1, 0] - error[0, 1]]) / 2, (np.trace(error[:3, :3]) - 1) / 2))
    return translations, rotations


def number(text):
    return float(text) if text else math.nan


class RelativePoseError(unittest.TestCase):
    def compare(self, drive, *options):
        with tempfile.TemporaryDirectory(prefix="waymark_rpe_") as folder:
            subprocess.run([PROGRAM, "run", str(drive), "-o", folder, "-m", "g2", "--quiet", *options], check=True)
            metrics = json.loads((pathlib.Path(folder) / "metrics.json").read_text(encoding="utf-8"))
            poses = {}
            with (pathlib.Path(folder) / "g2.csv").open(encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    poses[row["stamp_ns"]] = [float(row[key]) for key in ("x_m", "y_m", "heading_rad")]
            reference, estimate = [], []
            with (pathlib.Path(folder) / "g2.epochs.csv").open(encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    if not row["fused_east_m"]:
                        continue
                    x, y, heading = poses[row["stamp_ns"]]
                    turned = math.radians(number(row["heading_error_deg"]))
                    estimate.append(matrix(x, y, heading))
                    reference.append(matrix(x - number(row["fused_east_m"]), y - number(row["fused_north_m"]),
                                            heading - turned))
        told = metrics["evaluations"][0]["truth"]["relative_pose_error"]
        self.assertGreaterEqual(len(told), 2)
        for of in told:
            translations, rotations = relative_errors(reference, estimate, of["distance_m"])
            self.assertEqual(of["translation"]["n"], len(translations))
            for name, unit, found in (("translation", "m", translations), ("rotation", "rad", rotations)):
                if not found:
                    continue
                rms = math.sqrt(np.mean(np.square(found)))
                print(f"{of['distance_m']:g} m: {len(found)} pairs, {name} rms {rms:.6g} {unit}, "
                      f"largest {max(found):.6g} {unit}")
                self.assertAlmostEqual(of[name][f"rms_{unit}"], rms, delta=1e-6 * rms)
                self.assertAlmostEqual(of[name][f"max_abs_{unit}"], max(found), delta=1e-6 * rms)

    def test_of_a_real_drive(self):
        self.compare(SOURCE / "examples/berlin_potsdamer_platz/drive.yaml")

    def test_of_a_simulated_drive(self):
        with tempfile.TemporaryDirectory(prefix="waymark_rpe_") as folder:
            subprocess.run([PROGRAM, "simulate", "--preset", "urban", "-o", folder, "--quiet"], check=True)
            self.compare(pathlib.Path(folder) / "drive.yaml")


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    SOURCE = pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
