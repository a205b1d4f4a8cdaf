"""waymark.fuse(): the same results as the program, from files and from arrays; errors with their place."""

import csv
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time
import unittest
import unittest.mock
import warnings

import numpy as np

import waymark
from support import DRIVE, PROGRAM, described, gnss, odometry


class SameAsTheProgram(unittest.TestCase):
    """The program is the peer: both are one composition of one library."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        subprocess.run([PROGRAM, "run", str(DRIVE), "-o", cls.folder.name, "--quiet", "--covariance", "all"],
                       check=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cls.result = waymark.fuse(DRIVE)

    def file(self, name):
        return pathlib.Path(self.folder.name) / name

    def test_metrics_are_those_of_metrics_json_to_the_last_digit(self):
        told = json.loads(self.file("metrics.json").read_text())["evaluations"][0]
        self.assertEqual(self.result.metrics, told)

    def test_trajectory_is_that_of_the_graph_file_to_the_last_digit(self):
        graph = waymark.Graph.read(self.file("correlated.fused.graph"))
        ids, poses = graph.vertices()
        ids, poses = ids[has_time := np.isfinite(graph.times())], poses[has_time]
        np.testing.assert_array_equal(self.result.trajectory.id, ids)
        np.testing.assert_array_equal(self.result.trajectory.pose, poses)

    def test_trajectory_is_that_of_the_csv_file_to_its_digits(self):
        with open(self.file("correlated.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        of = self.result.trajectory
        self.assertEqual(len(rows), len(of))
        for name, ours in (("x", of.x), ("y", of.y), ("latitude", of.latitude), ("longitude", of.longitude)):
            column = next(key for key in rows[0] if key.startswith(name))
            np.testing.assert_allclose(ours, [float(row[column]) for row in rows], rtol=0, atol=1e-6)

    def test_written_files_are_those_of_the_program_byte_by_byte(self):
        with tempfile.TemporaryDirectory() as ours, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = waymark.fuse(DRIVE, out=ours)
            names = {pathlib.Path(file).name for file in result.files}
            self.assertIn("metrics.json", names)
            self.assertIn("report.html", names)
            for name in ("metrics.json", "correlated.csv", "correlated.epochs.csv", "correlated.fused.graph"):
                self.assertEqual((pathlib.Path(ours) / name).read_bytes(), self.file(name).read_bytes(), name)

    def test_fused_positions_are_nearer_to_the_truth_than_the_fixes(self):
        def rmse(errors):
            return np.sqrt(np.nanmean(np.sum(errors**2, axis=1)))

        fixes = self.result.fixes
        self.assertLess(rmse(fixes.fused_error), rmse(fixes.error) / 3)
        told = self.result.metrics["truth"]["fused"]["position"]["rmse_m"]
        self.assertAlmostEqual(rmse(fixes.fused_error), told, places=9)

    def test_residuals_of_all_edges_sum_up_to_chi2(self):
        squares = sum(np.sum(one.squared) for one in self.result.residuals.values())
        graph = self.result.graph()
        self.assertAlmostEqual(graph.chi2, self.result.summary.chi2, places=6)
        for one in self.result.residuals.values():
            whitened = np.nansum(one.whitened**2, axis=1)
            np.testing.assert_allclose(whitened, one.squared, rtol=1e-6, atol=1e-9)
        self.assertGreaterEqual(squares, graph.chi2 * (1 - 1e-12))  # a robust loss only lowers

    def test_residuals_of_fixes_are_fix_minus_fused_antenna(self):
        fixes = self.result.fixes  # the antenna of this drive is the body point, and no fix is late
        if "time_offset" not in self.result.states:
            np.testing.assert_allclose(fixes.residual, fixes.position - fixes.fused_position, atol=1e-9)

    def test_covariances_are_symmetric_and_positive_definite(self):
        covariance = self.result.trajectory.covariance
        self.assertFalse(np.isnan(covariance).any())
        np.testing.assert_allclose(covariance, np.swapaxes(covariance, 1, 2), rtol=1e-9)
        self.assertGreater(np.linalg.eigvalsh(covariance).min(), 0)

    def marginals_and_covariances(self, result):
        ids = result.trajectory.id[:: len(result.trajectory) // 5]
        return result.graph().marginals(ids), result.trajectory.covariance[np.isin(result.trajectory.id, ids)]

    def test_covariances_are_the_marginals_of_the_graph_if_the_noise_is_known(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stated = waymark.fuse(DRIVE, noise="stated")
        np.testing.assert_allclose(*self.marginals_and_covariances(stated), rtol=1e-6)

    def test_covariances_are_larger_by_what_is_not_known_of_the_noise(self):
        marginals, covariances = self.marginals_and_covariances(self.result)
        growth = np.trace(covariances, axis1=1, axis2=2) / np.trace(marginals, axis1=1, axis2=2)
        self.assertGreater(growth.min(), 1)
        self.assertLess(growth.max(), 2)

    def test_states_and_noise_are_those_of_summary_json(self):
        summary = json.loads(self.file("summary.json").read_text())["correlated"]
        self.assertEqual(self.result.noise, summary["noise"])
        for state in summary["states"]:
            self.assertEqual(self.result.states[state["name"]].sigma, state["sigma"])

    def test_arrays_refer_to_memory_of_the_result_and_cannot_be_written(self):
        for array in (self.result.trajectory.pose, self.result.trajectory.covariance, self.result.fixes.sigma):
            self.assertIsNotNone(array.base)
            with self.assertRaises(ValueError):
                array[0] = 0

    def test_arrays_outlive_the_result(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = waymark.fuse(DRIVE, modeling="g2", to_s=60)
        pose = result.trajectory.pose
        before = pose.copy()
        del result
        np.testing.assert_array_equal(pose, before)


@unittest.mock.patch("warnings.warn")
class Arrays(unittest.TestCase):
    def test_arrays_give_the_result_of_the_files_to_the_last_bit(self, _):
        files = waymark.fuse(DRIVE)
        arrays = waymark.fuse(described())
        np.testing.assert_array_equal(arrays.trajectory.pose, files.trajectory.pose)
        np.testing.assert_array_equal(arrays.trajectory.time_ns, files.trajectory.time_ns)
        np.testing.assert_array_equal(arrays.trajectory.covariance, files.trajectory.covariance)
        self.assertEqual(arrays.metrics, files.metrics)

    def test_plain_arguments_are_enough(self, _):
        fixes = gnss()
        sigma = np.full(len(fixes["time"]), 3.0)
        result = waymark.fuse(
            odometry=odometry(), modeling="g2",
            gnss={"time": fixes["time"], "latitude": fixes["latitude"], "longitude": fixes["longitude"],
                  "sigma": sigma})
        self.assertTrue(result.converged)
        np.testing.assert_allclose(result.fixes.sigma, 3.0, rtol=1e-3)  # on the ground; the grid has a scale

    def test_dates_and_nanoseconds_are_times_too(self, _):
        def with_time(table, name, time):
            return {name: time, **{key: column for key, column in table.items() if key != "time"}}

        drive, fixes = odometry(), gnss()
        fixes["sigma"] = np.full(len(fixes["time"]), 3.0)
        del fixes["accuracy"]
        epoch = np.datetime64("2016-06-06T00:00:00")
        results = []
        for name, convert in (
            ("time", lambda time: time),
            ("time_ns", lambda time: np.rint(time * 1e9).astype(np.int64)),
            ("time", lambda time: epoch + np.rint(time * 1e3).astype("timedelta64[ms]")),
        ):
            results.append(waymark.fuse(odometry=with_time(drive, name, convert(drive["time"])),
                                        gnss=with_time(fixes, name, convert(fixes["time"])), modeling="g2"))
        for other in results[1:]:
            np.testing.assert_allclose(other.trajectory.pose, results[0].trajectory.pose, atol=1e-6)

    def test_structured_arrays_and_pandas_are_tables_too(self, _):
        table = odometry()
        structured = np.rec.fromarrays(list(table.values()), names=list(table))
        tables = [table, structured]
        try:
            import pandas

            tables.append(pandas.DataFrame(table))
        except ImportError:
            pass
        chi2 = set()
        for one in tables:
            drive = described()
            drive["odometry"]["samples"] = one
            chi2.add(waymark.fuse(drive, modeling="g2").summary.chi2)
        self.assertEqual(len(chi2), 1)

    def test_further_sensors_come_from_arrays(self, _):
        drive = described()
        log = drive["truth"]["samples"]
        drive["sensors"] = [{
            "name": "heading", "time": {"week": 1900},
            "samples": {"time": log["time"], "heading": log["heading"]},
            "options": {"sigma_deg": 0.5, "offset": "off"}}]
        without = waymark.fuse(described(), modeling="g2")
        result = waymark.fuse(drive, modeling="g2")

        def heading_rms(of):
            return np.sqrt(np.nanmean(of.fixes.fused_heading_error**2))

        self.assertLess(heading_rms(result), heading_rms(without) / 2)

    def test_the_caller_may_change_his_arrays_afterwards(self, _):
        drive = described()
        result = waymark.fuse(drive, modeling="g2")
        before = result.trajectory.pose.copy()
        drive["odometry"]["samples"]["speed"][:] = 0
        np.testing.assert_array_equal(result.trajectory.pose, before)


class Errors(unittest.TestCase):
    def raised(self, kind, *arguments, **keywords):
        with self.assertRaises(kind) as caught:
            waymark.fuse(*arguments, **keywords)
        return caught.exception

    def test_a_wrong_key_has_file_line_and_column(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "drive.yaml"
            path.write_text("odometry: {file: a.csv}\ngnss: {file: b.csv, colums: {}}\n")
            error = self.raised(waymark.InputError, path)
        self.assertEqual((error.file, error.line, error.column), (str(path), 2, 21))
        self.assertIn("did you mean 'columns'?", str(error))
        self.assertIsInstance(error, ValueError)

    def test_a_missing_file_is_named(self):
        self.assertIn("nowhere.yaml", str(self.raised(waymark.InputError, "nowhere.yaml")))

    def test_unknown_modelings_and_options_are_usage(self):
        self.assertIn("correlated", str(self.raised(waymark.UsageError, DRIVE, modeling="correlatd")))
        self.raised(waymark.UsageError, DRIVE, options={"no_such_option": 1})
        self.raised(waymark.UsageError, DRIVE, algorithm="newton")
        self.raised(waymark.UsageError, DRIVE, threads=0)
        self.raised(waymark.UsageError, DRIVE, covariances="some")
        self.raised(waymark.UsageError)
        with self.assertRaises(TypeError):
            waymark.fuse_all(DRIVE, treads=2)

    def test_an_output_that_cannot_be_written_is_an_os_error(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder) / "file"
            place.write_text("")
            self.assertIsInstance(self.raised(waymark.OutputError, DRIVE, out=place, modeling="g2"), OSError)

    def test_wrong_columns_are_named(self):
        fixes = gnss()
        wrong = {"time": fixes["time"], "lattitude": fixes["latitude"], "longitude": fixes["longitude"]}
        error = self.raised(waymark.InputError, odometry=odometry(), gnss=wrong)
        self.assertIn("gnss: there is no", str(error))
        self.assertIn("latitude", str(error))
        short = {**odometry(), "speed": odometry()["speed"][:-1]}
        self.assertIn("'speed' has", str(self.raised(waymark.InputError, odometry=short, gnss=fixes)))
        self.assertIn("time", str(self.raised(waymark.UsageError, odometry={"speed": [1.0]}, gnss=fixes)))
        self.raised(waymark.UsageError, odometry=[1, 2, 3], gnss=fixes)
        self.raised(waymark.UsageError, odometry={"time": np.zeros((2, 2))}, gnss=fixes)

    def test_masked_entries_are_refused(self):
        fixes = {**gnss(), "latitude": np.ma.masked_less(gnss()["latitude"], 0)}
        fixes["latitude"][3] = np.ma.masked
        error = self.raised(waymark.UsageError, odometry=odometry(), gnss=fixes)
        self.assertIn("gnss: column 'latitude': has masked entries", str(error))

    def test_a_row_that_is_no_time_has_its_number(self):
        table = odometry()
        table["time"] = table["time"].copy()
        table["time"][6] = np.nan
        error = self.raised(waymark.InputError, odometry=table, gnss=gnss())
        self.assertEqual((error.file, error.line), ("odometry", 7))

    def test_impossible_places_are_counted_and_left_out(self):
        drive = described()
        drive["gnss"]["samples"]["latitude"][100] = 91.0
        with self.assertWarnsRegex(waymark.DriveWarning, "1 corrupt record"):
            waymark.fuse(drive, modeling="g2")

    def test_wrong_keys_of_a_dict_are_found(self):
        error = self.raised(waymark.InputError, {**described(), "gat": {}})
        self.assertIn("did you mean 'gate'?", str(error))

    def test_no_minimum_is_a_warning_and_a_result(self):
        with self.assertWarns(waymark.NotConverged):
            result = waymark.fuse(DRIVE, modeling="g2", max_iterations=1)
        self.assertFalse(result.converged)
        self.assertEqual(result.summary.termination, "max_iterations")


@unittest.mock.patch("warnings.warn")
class Hosting(unittest.TestCase):
    def test_progress_tells_works_and_iterations(self, _):
        told = []
        result = waymark.fuse(DRIVE, modeling="g2", progress=lambda *what: told.append(what))
        steps = [what for what in told if what[1] is not None]
        self.assertGreaterEqual(len(steps), result.summary.iterations)
        self.assertTrue(any("start and noise" in what[0] for what in told))
        self.assertAlmostEqual(steps[result.summary.iterations - 1][2], result.summary.chi2, places=3)

    def test_what_the_callback_raises_ends_the_work_and_arrives(self, _):
        calls = []

        def stop(work, iteration, chi2):
            calls.append(work)
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            waymark.fuse(DRIVE, progress=stop)
        self.assertEqual(len(calls), 1)
        self.assertTrue(waymark.fuse(DRIVE, modeling="g2").converged)  # the next one is not cancelled

    def test_ctrl_c_ends_the_work(self, _):
        def press(work, iteration, chi2):
            os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            waymark.fuse(DRIVE, progress=press)
        self.assertTrue(waymark.fuse(DRIVE, modeling="g2").converged)

    def test_ctrl_c_ends_the_search_for_the_noise(self, _):
        drive = described()
        for key in ("odometry", "gnss"):
            samples = drive[key]["samples"]
            drive[key]["samples"] = {name: np.concatenate([column + i * (200 if name == "time" else 0)
                                                           for i in range(8)])
                                     for name, column in samples.items()}
        del drive["truth"]
        reached = threading.Event()
        pressed = []

        def watch(work, iteration, chi2):
            if "noise" in work:
                reached.set()

        def press():
            reached.wait()
            time.sleep(0.1)
            pressed.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=press)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            waymark.fuse(drive, progress=watch)
        self.assertLess(time.monotonic() - pressed[0], 10)
        thread.join()

    def test_other_threads_run_while_a_drive_is_fused(self, _):
        counted = 0
        done = threading.Event()

        def work():
            waymark.fuse(DRIVE)
            done.set()

        thread = threading.Thread(target=work)
        thread.start()
        while not done.wait(0.001):
            counted += 1
        thread.join()
        self.assertGreater(counted, 50)

    def test_drives_may_be_fused_at_the_same_time(self, _):
        alone = waymark.fuse(DRIVE, modeling="g2")
        results = [None] * 3

        def work(i):
            results[i] = waymark.fuse(DRIVE, modeling="g2")

        threads = [threading.Thread(target=work, args=(i,)) for i in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal(result.trajectory.pose, alone.trajectory.pose)


if __name__ == "__main__":
    unittest.main()
