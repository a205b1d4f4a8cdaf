"""Works that memory.sh runs under valgrind: every kind of call of the package, on little data."""

import warnings

import numpy as np

import waymark
from support import DRIVE, described


def fuse():
    result = waymark.fuse(DRIVE, modeling="g2", to_s=20)
    arrays = [result.trajectory.pose, result.trajectory.covariance, result.fixes.residual, result.residuals,
              result.states, result.noise, result.metrics, result.provenance]
    graph = result.graph()
    del result
    assert np.isfinite(arrays[0]).all() and np.isfinite(arrays[1]).all()
    assert graph.optimize().converged
    assert waymark.fuse({**described(), "time": {"to": 20}}, modeling="g2").converged


def fail():
    for arguments in ({"modeling": "no"}, {"options": {"no": 1}}, {"threads": 0}, {"data": "nowhere"}):
        try:
            waymark.fuse(DRIVE, **arguments)
        except waymark.Error as error:
            assert str(error)
        else:
            raise AssertionError(arguments)


def interrupt():
    def stop(work, iteration, chi2):
        raise KeyboardInterrupt

    try:
        waymark.fuse(DRIVE, modeling="g2", to_s=20, progress=stop)
    except KeyboardInterrupt:
        return
    raise AssertionError("it was not interrupted")


def edges():
    for vectorized in (False, True):
        step = waymark.EdgeType("EDGE_STEP", ["VERTEX_XY", "VERTEX_XY"], 2, {"measured": 2},
                                lambda a, b, z: b - a - z, vectorized=vectorized)
        graph = waymark.Graph()
        graph.add_vertices(range(5), 0.9 * np.arange(10).reshape(5, 2), type="VERTEX_XY")
        graph.set_fixed([0])
        graph.add_edges(step, [(i, i + 1) for i in range(4)], np.ones((4, 2)), np.eye(2), loss="huber:1")
        assert graph.optimize(threads=2).converged
        np.testing.assert_allclose(graph.value(4), [4, 4.9], atol=1e-6)
        graph.marginals(range(5))
        graph.joint_marginal([1, 4])
        graph.copy().check_derivatives()
    broken = waymark.EdgeType("EDGE_BROKEN", ["VERTEX_XY"], 2, {}, lambda a: a / 0 if a is None else [1])
    graph.add_edge(broken, [1], [], np.eye(2))
    try:
        graph.optimize()
    except waymark.UsageError:
        return
    raise AssertionError("a wrong error went through")


warnings.simplefilter("ignore")
for work in (fuse, fail, interrupt, edges):
    work()
    print("done:", work.__name__, flush=True)
