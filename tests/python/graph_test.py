"""Graphs from Python against closed solutions of numpy, files, and edge types of C++ as peers."""

import pathlib
import tempfile
import threading
import traceback
import unittest

import numpy as np

import waymark


def wrapped(angle):
    return np.arctan2(np.sin(angle), np.cos(angle))


def relative_error(start, end, measured):
    """EDGE_SE2 in (t, theta) form, for any number of leading dimensions."""
    c, s = np.cos(start[..., 2]), np.sin(start[..., 2])
    x, y = end[..., 0] - start[..., 0], end[..., 1] - start[..., 1]
    dx, dy = c * x + s * y - measured[..., 0], -s * x + c * y - measured[..., 1]
    cz, sz = np.cos(measured[..., 2]), np.sin(measured[..., 2])
    heading = wrapped(end[..., 2] - start[..., 2] - measured[..., 2])
    return np.stack([cz * dx + sz * dy, -sz * dx + cz * dy, heading], axis=-1)


def relative_jacobians(start, end, measured):
    angle = start[2] + measured[2]
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    by_start, by_end = np.zeros((3, 3)), np.zeros((3, 3))
    by_end[:2, :2], by_end[2, 2] = turn, 1
    by_start[:2, :2], by_start[2, 2] = -turn, -1
    x, y = end[:2] - start[:2]
    c, s = np.cos(start[2]), np.sin(start[2])
    cz, sz = np.cos(measured[2]), np.sin(measured[2])
    by_start[:2, 2] = np.array([[cz, sz], [-sz, cz]]) @ [-s * x + c * y, -c * x - s * y]
    return by_start, by_end


def relative_type(tag="EDGE_RELATIVE", **more):
    return waymark.EdgeType(tag, ["VERTEX_SE2", "VERTEX_SE2"], 3, {"measured": 3}, relative_error, **more)


def ring(edge_type, count=60, seed=7):
    """A noisy drive around a circle with closures, with edges of a type."""
    random = np.random.default_rng(seed)
    angle = np.linspace(0, 4 * np.pi, count)
    truth = np.stack([50 * np.cos(angle), 50 * np.sin(angle), wrapped(angle + np.pi / 2)], axis=1)
    pairs = [(i, i + 1) for i in range(count - 1)] + [(i, i + count // 2) for i in range(0, count // 2, 5)]
    start, end = truth[[a for a, _ in pairs]], truth[[b for _, b in pairs]]
    measured = relative_error(start, end, np.zeros(3)) + random.normal(0, [0.1, 0.05, 0.01], (len(pairs), 3))
    graph = waymark.Graph()
    graph.add_vertices(np.arange(count), truth + random.normal(0, [0.5, 0.5, 0.05], truth.shape))
    graph.set_fixed([0])
    graph.add_edges(edge_type, pairs, measured, np.diag([100.0, 400.0, 10000.0]))
    return graph


class Graphs(unittest.TestCase):
    def test_minimum_and_marginals_are_those_of_least_squares(self):
        # Points on a line and distances between them along each axis: a linear problem.
        random = np.random.default_rng(3)
        count = 12
        pairs = np.array([(i, i + 1) for i in range(count - 1)] + [(i, i + 4) for i in range(0, count - 4, 2)])
        step = waymark.EdgeType("EDGE_STEP", ["VERTEX_XY", "VERTEX_XY"], 2, {"measured": 2},
                                error=lambda a, b, measured: b - a - measured)
        place = waymark.EdgeType("EDGE_PLACE", ["VERTEX_XY"], 2, {"measured": 2},
                                 error=lambda a, measured: a - measured)
        measured = random.normal(0, 1, (len(pairs), 2))
        root = random.normal(0, 1, (len(pairs), 2, 2))
        information = root @ np.swapaxes(root, 1, 2) + np.eye(2)
        graph = waymark.Graph()
        graph.add_vertices(range(count), random.normal(0, 5, (count, 2)), type="VERTEX_XY")
        graph.add_edges(step, pairs, measured, information)
        graph.add_edges(place, [[0]], [[1.0, 2.0]], 4 * np.eye(2))
        summary = graph.optimize()

        normal, right = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
        for (a, b), z, omega in zip(pairs, measured, information):
            row = np.zeros((2, 2 * count))
            row[:, 2 * a : 2 * a + 2], row[:, 2 * b : 2 * b + 2] = -np.eye(2), np.eye(2)
            normal += row.T @ omega @ row
            right += row.T @ omega @ z
        normal[:2, :2] += 4 * np.eye(2)
        right[:2] += 4 * np.array([1.0, 2.0])
        solution = np.linalg.solve(normal, right).reshape(count, 2)
        covariance = np.linalg.inv(normal)

        self.assertTrue(summary.converged)
        ids, values = graph.vertices("VERTEX_XY")
        np.testing.assert_array_equal(ids, range(count))
        np.testing.assert_allclose(values, solution, atol=1e-7)
        np.testing.assert_allclose(graph.joint_marginal(ids), covariance, atol=1e-8)
        for i, block in zip(ids, graph.marginals(ids)):
            np.testing.assert_allclose(block, covariance[2 * i : 2 * i + 2, 2 * i : 2 * i + 2], atol=1e-8)

    def test_files_keep_a_graph(self):
        graph = ring("EDGE_SE2")
        graph.optimize()
        with tempfile.TemporaryDirectory() as folder:
            for name, format in (("a.graph", "graph"), ("a.g2o", "g2o"), ("a.toro", "toro")):
                path = pathlib.Path(folder) / name
                graph.write(path, format=format)
                again = waymark.Graph.read(path, format=format)
                np.testing.assert_allclose(again.vertices()[1], graph.vertices()[1], atol=1e-12)
                self.assertAlmostEqual(again.chi2, graph.chi2, places=6)
                for ours, theirs in zip(again.edges("EDGE_SE2"), graph.edges("EDGE_SE2")):
                    np.testing.assert_allclose(ours, theirs, atol=1e-9)

    def test_a_wrong_line_has_its_place_and_may_be_skipped(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "wrong.g2o"
            path.write_text("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 zero\n")
            with self.assertRaises(waymark.InputError) as caught:
                waymark.Graph.read(path)
            self.assertEqual((caught.exception.file, caught.exception.line), (str(path), 2))
            with self.assertWarnsRegex(waymark.DriveWarning, "1 lines were skipped"):
                graph = waymark.Graph.read(path, lenient=True)
            self.assertEqual(graph.vertex_types, {"VERTEX_SE2": 1})

    def test_a_robust_loss_limits_an_outlier(self):
        place = waymark.EdgeType("EDGE_PLACE", ["VERTEX_SE2"], 2, {"measured": 2}, lambda a, z: a[:2] - z)
        graph = waymark.Graph()
        graph.add_vertex(0, [0, 0, 0])
        graph.add_edge("EDGE_PRIOR_SE2", [0], [0, 0, 0], np.diag([0, 0, 1]))
        graph.add_edges(place, [[0]] * 4, [[0, 0], [0.1, 0], [0, 0.1], [0.1, 0.1]], np.eye(2))
        graph.add_edge(place, [0], [100, 0], np.eye(2), loss="huber:1")
        graph.optimize()
        # The gradient of the four is 4 (x - 0.05); that of Huber's loss at a far outlier is its scale.
        np.testing.assert_allclose(graph.value(0), [0.05 + 1 / 4, 0.05, 0], atol=1e-3)

    def test_a_graph_that_may_be_moved_holds_its_first_vertex(self):
        graph = ring("EDGE_SE2")
        graph.set_fixed([0], False)
        summary = graph.optimize()
        self.assertTrue(summary.converged)
        self.assertTrue(summary.notes)
        np.testing.assert_array_equal(graph.marginals([0])[0], np.zeros((3, 3)))

    def test_copies_share_nothing(self):
        graph = ring("EDGE_SE2")
        other = graph.copy()
        before = other.vertices()[1]
        graph.optimize()
        np.testing.assert_array_equal(other.vertices()[1], before)

    def test_wrong_arguments_are_usage(self):
        graph = ring("EDGE_SE2")
        for wrong in (
            lambda: graph.add_vertex(0, [0, 0, 0]),
            lambda: graph.add_vertex(100, [0, 0]),
            lambda: graph.add_vertex(100, [0, 0, 0], type="VERTEX_SE3"),
            lambda: graph.add_vertex(1.5, [0, 0, 0]),
            lambda: graph.add_vertex(100, [0, 0, 0], time=np.nan),
            lambda: graph.add_edge("EDGE_SE2", [0, 777], [1, 0, 0], np.eye(3)),
            lambda: graph.add_edge("EDGE_SE2", [0, 0], [1, 0, 0], np.eye(3)),
            lambda: graph.add_edge("EDGE_SE2", [0, 1], [1, 0], np.eye(3)),
            lambda: graph.add_edge("EDGE_SE2", [0, 1], [1, 0, 0], np.eye(2)),
            lambda: graph.add_edge("EDGE_SE2", [0, 1], [1, 0, 0], np.eye(3), loss="cauchi:1"),
            lambda: graph.add_edge("EDGE_SE22", [0, 1], [1, 0, 0], np.eye(3)),
            lambda: graph.optimize(algorithm="newton"),
            lambda: graph.optimize(tolerance=-1),
            lambda: graph.marginals([777]),
            lambda: graph.value(777),
            lambda: graph.write("x", format="xml"),
            lambda: graph.edges("EDGE_SE2_XY"),
            lambda: relative_type(tag="two words"),
            lambda: graph.add_edge(waymark.EdgeType("EDGE_X", ["VERTEX_NO"], 1, {}, abs), [0], [], np.eye(1)),
            lambda: graph.add_edge(relative_type(tag="EDGE_SE2"), [0, 1], [1, 0, 0], np.eye(3)),
        ):
            with self.assertRaises(waymark.UsageError):
                wrong()

    def test_what_a_file_may_not_hold_is_refused(self):
        nan, inf = np.nan, np.inf
        skew = np.array([[1, 5, 0], [0, 1, 0], [0, 0, 1.0]])
        pairs, motions = [[0, 1], [1, 2]], np.array([[1, 0, 0], [1, 0, 0.0]])
        second = lambda bad: np.stack([np.eye(3), bad])
        edges = lambda fields, information: graph.add_edges("EDGE_SE2", pairs, fields, information)
        edge = lambda information: graph.add_edge("EDGE_SE2", [0, 1], [1, 0, 0], information)
        graph = ring("EDGE_SE2")
        before = graph.edge_types, graph.vertex_types, graph.chi2
        for words, wrong in (
            ("information: the information matrix is indefinite", lambda: edge(-np.eye(3))),
            ("information: edge 1: the information matrix is indefinite",
             lambda: edges(motions, second(np.diag([1, 1, -1e-3])))),
            ("information: edge 1: .*indefinite", lambda: edges(motions, second([[1, 2, 0], [2, 1, 0], [0, 0, 1]]))),
            ("information: the information matrix is not symmetric: 5 in row 0 and column 1, 0 opposite",
             lambda: edge(skew)),
            ("information: edge 1: .*not symmetric", lambda: edges(motions, second(skew.T))),
            ("information: row 2, column 1 is nan",
             lambda: edge([[1, 0, 0], [0, 1, 0], [0, nan, 1]])),
            ("information: edge 1: row 0, column 0 is inf", lambda: edges(motions, second(np.diag([inf, 1, 1])))),
            (r"fields: edge 1: measured\[2\] is nan", lambda: edges([[1, 0, 0], [1, 0, nan]], np.eye(3))),
            (r"fields: edge 0: measured\[0\] is -inf", lambda: edges([[-inf, 0, 0], [1, 0, nan]], np.eye(3))),
            ("values: vertex 71: heading is nan", lambda: graph.add_vertices([70, 71], [[0, 0, 0], [0, 0, nan]])),
            ("values: vertex 1: y is inf", lambda: graph.set_values([0, 1], [[0, 0, 0], [0, inf, 0]])),
        ):
            with self.subTest(words), self.assertRaisesRegex(waymark.UsageError, words):
                wrong()
        self.assertEqual((graph.edge_types, graph.vertex_types, graph.chi2), before)  # nothing was added

    def test_information_of_numpy_and_of_32_bits_is_accepted(self):
        random = np.random.default_rng(5)
        graph = ring("EDGE_SE2")
        for scale in (np.ones(3), np.array([1e-4, 1, 1e3])):
            root = scale[:, None] * random.normal(0, 1, (50, 3, 8))
            inverses = np.linalg.inv(root @ np.swapaxes(root, 1, 2))  # symmetric up to rounding
            for matrix in (inverses, inverses.astype(np.float32), np.zeros((50, 3, 3))):
                graph.add_edges("EDGE_SE2", [[0, 1]] * 50, [[1, 0, 0]] * 50, matrix)
        rank_one = np.outer([1, 2, 3], [1, 2, 3])  # no information along two axes
        graph.add_edge("EDGE_SE2", [0, 1], [1, 0, 0], rank_one)

    def test_masked_entries_are_refused(self):
        graph = ring("EDGE_SE2")
        masked = lambda rows: np.ma.masked_greater(np.array(rows), 98)
        for name, wrong in (
            ("values", lambda: graph.add_vertices([70], masked([[0, 0, 99.0]]))),
            ("values", lambda: graph.add_vertex(70, masked([0, 0, 99.0]))),
            ("values", lambda: graph.set_values([0], masked([[0, 0, 99.0]]))),
            ("ids", lambda: graph.marginals(masked([1, 99]))),
            ("time", lambda: graph.add_vertices([70], [[0, 0, 0]], time=masked([99.0]))),
            ("fields", lambda: graph.add_edge("EDGE_SE2", [0, 1], masked([1, 0, 99.0]), np.eye(3))),
            ("fields", lambda: graph.add_edges("EDGE_SE2", [[0, 1]], masked([[1, 0, 99.0]]), np.eye(3))),
            ("information", lambda: graph.add_edge("EDGE_SE2", [0, 1], [1, 0, 0], masked(99 * np.eye(3)))),
        ):
            with self.subTest(name), self.assertRaisesRegex(waymark.UsageError, f"^{name}: has masked entries"):
                wrong()
        graph.add_edge("EDGE_SE2", [0, 1], masked([1, 0, 0]), np.eye(3))  # nothing is masked in it


class PythonEdges(unittest.TestCase):
    """EDGE_SE2 of C++ is the peer: the same error has the same minimum."""

    def assert_same_minimum(self, edge_type, **how):
        peer, ours = ring("EDGE_SE2"), ring(edge_type)
        self.assertAlmostEqual(ours.chi2, peer.chi2, delta=1e-9 * peer.chi2)
        of_peer, of_ours = peer.optimize(start="file", tolerance=1e-12), ours.optimize(start="file", tolerance=1e-12, **how)
        self.assertTrue(of_ours.converged)
        self.assertAlmostEqual(of_ours.chi2, of_peer.chi2, delta=1e-9 * of_peer.chi2)
        np.testing.assert_allclose(ours.vertices()[1], peer.vertices()[1], atol=1e-6)
        ids = [1, 20, 59]
        np.testing.assert_allclose(ours.marginals(ids), peer.marginals(ids), rtol=1e-5, atol=1e-10)
        self.assertEqual(ours.check_derivatives(), [])

    def test_derivatives_by_differences(self):
        self.assert_same_minimum(relative_type())

    def test_derivatives_that_are_given(self):
        self.assert_same_minimum(relative_type(jacobians=relative_jacobians))

    def test_all_edges_at_once(self):
        self.assert_same_minimum(relative_type(vectorized=True))

    def test_several_threads(self):
        self.assert_same_minimum(relative_type(), threads=3)

    def test_every_algorithm(self):
        for algorithm in waymark.registered()["algorithms"]:
            with self.subTest(algorithm):
                self.assert_same_minimum(relative_type(), algorithm=algorithm)

    def test_a_wrong_derivative_is_told(self):
        def wrong(start, end, measured):
            by_start, by_end = relative_jacobians(start, end, measured)
            by_end[1, 2] += 0.5
            return by_start, by_end

        told = ring(relative_type(jacobians=wrong)).check_derivatives()
        self.assertEqual(len(told), 1)
        self.assertIn("row 1, column 2", told[0])

    def test_a_wrapped_angle_has_its_derivative(self):
        compass = waymark.EdgeType("EDGE_COMPASS", ["VERTEX_SE2"], 1, {"measured": 1},
                                   lambda pose, measured: [wrapped(pose[2] - measured)])
        graph = waymark.Graph()
        graph.add_vertex(0, [0, 0, 0])
        graph.add_edge("EDGE_PRIOR_SE2", [0], [0, 0, 0], np.diag([1, 1, 1e-9]))
        graph.add_edge(compass, [0], np.pi, [[1.0]])  # the error is at its jump
        self.assertEqual(graph.check_derivatives(), [])

    def test_files_keep_python_edges(self):
        edge_type = relative_type()
        graph = ring(edge_type)
        graph.optimize()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "own.graph"
            graph.write(path)
            again = waymark.Graph.read(path, edge_types=[edge_type])
            self.assertEqual(again.chi2, graph.chi2)
            with self.assertRaisesRegex(waymark.InputError, "EDGE_RELATIVE"):
                waymark.Graph.read(path)

    def test_what_an_error_raises_arrives_with_its_line_and_its_edge(self):
        def fails(start, end, measured):
            if measured[0] > 0 and start[0] < 0:
                raise ZeroDivisionError("no such distance")
            return relative_error(start, end, measured)

        graph = ring(waymark.EdgeType("EDGE_FAILS", ["VERTEX_SE2"] * 2, 3, {"measured": 3}, fails))
        before = graph.vertices()[1]
        try:
            graph.optimize()
            self.fail("the error was lost")
        except ZeroDivisionError as error:
            self.assertEqual(str(error), "no such distance")
            self.assertIn("in fails", "".join(traceback.format_tb(error.__traceback__)))
            self.assertRegex(error.__notes__[0], r"in EDGE_FAILS number \d+")
        np.testing.assert_array_equal(graph.vertices()[1], before)

    def test_wrong_results_of_functions_are_told(self):
        for error, jacobians, words in (
            (lambda a, z: a[:1], None, "error returned 1 numbers where 2 are expected"),
            (lambda a, z: "two", None, "could not convert string to float"),
            (lambda a, z: a - z, lambda a, z: [np.eye(2), np.eye(2)], "2 matrices for 1 vertices"),
            (lambda a, z: a - z, lambda a, z: [np.eye(3)], "9 numbers where 4"),
        ):
            graph = waymark.Graph()
            graph.add_vertex(0, [0, 0], type="VERTEX_XY")
            graph.add_edge(waymark.EdgeType("EDGE_WRONG", ["VERTEX_XY"], 2, {"measured": 2}, error, jacobians),
                           [0], [1, 2], np.eye(2))
            with self.assertRaisesRegex(ValueError, words):
                graph.optimize()

    def test_an_error_that_is_not_finite_ends_the_search(self):
        graph = ring(waymark.EdgeType("EDGE_NAN", ["VERTEX_SE2"] * 2, 3, {"measured": 3},
                                      lambda a, b, z: [np.nan] * 3))
        try:
            self.assertFalse(graph.optimize().converged)
        except waymark.InputError as error:
            self.assertIn("not finite", str(error))

    def test_a_graph_in_use_is_refused(self):
        graph = waymark.Graph()
        seen = []

        def looks(a, measured):
            try:
                graph.value(0)
            except waymark.UsageError as error:
                seen.append(str(error))
            return a - measured

        graph.add_vertex(0, [0, 0, 0])
        graph.add_edge(waymark.EdgeType("EDGE_LOOKS", ["VERTEX_SE2"], 3, {"measured": 3}, looks), [0],
                       [1, 2, 0.5], np.eye(3))
        graph.optimize()
        self.assertIn("in use", seen[0])
        np.testing.assert_allclose(graph.value(0), [1, 2, 0.5], atol=1e-6)

    def test_ctrl_c_ends_an_optimisation(self):
        def stop(work, iteration, chi2):
            raise KeyboardInterrupt

        graph = ring(relative_type())
        with self.assertRaises(KeyboardInterrupt):
            graph.optimize(progress=stop)
        self.assertTrue(graph.optimize().converged)

    def test_graphs_may_end_in_any_thread(self):
        edge_type = relative_type()
        graphs = [ring(edge_type) for _ in range(4)]
        threads = [threading.Thread(target=lambda: graphs.pop().optimize()) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(graphs, [])


if __name__ == "__main__":
    unittest.main()
