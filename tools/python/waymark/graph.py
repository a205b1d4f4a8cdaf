"""Graphs: build, read, write, optimise, marginals; and edge types written in Python."""

import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from waymark import _waymark
from waymark.arrays import floats, require_unmasked
from waymark.errors import DriveWarning, UsageError
from waymark.results import Floats, Integers, Summary, seconds

Progress = Callable[[str, int | None, float | None], object] | None


class EdgeType:
    """An edge type written in Python: a measurement of one or more vertices.

    ``error`` gets the value of each vertex as an array, then each field as an array, or as a float
    if it is one number. It returns the error, ``dimension`` numbers. Its derivatives are taken by
    differences, unless ``jacobians`` returns them: a matrix for each vertex, dimension x degrees of
    freedom.

    With ``vectorized`` the functions get all edges at once: every array has one more dimension in
    front, and so has the result. That is much faster than one call per edge.

    >>> range_edge = waymark.EdgeType(
    ...     "EDGE_RANGE", ["VERTEX_SE2", "VERTEX_XY"], 1, {"measured": 1},
    ...     error=lambda pose, mark, measured: np.hypot(*(mark - pose[:2])) - measured)
    >>> range_edge.tag
    'EDGE_RANGE'
    """

    def __init__(
        self,
        tag: str,
        vertices: Sequence[str],
        dimension: int,
        fields: Mapping[str, int],
        error: Callable[..., npt.ArrayLike],
        jacobians: Callable[..., Sequence[npt.ArrayLike]] | None = None,
        vectorized: bool = False,
    ) -> None:
        if not tag or any(letter.isspace() for letter in tag):
            raise UsageError(f"tag: must be a word without blanks, got {tag!r}")
        if dimension < 1:
            raise UsageError(f"dimension: must be at least 1, got {dimension}")
        if isinstance(vertices, str) or not vertices:
            raise UsageError("vertices: expected the types of the vertices in a list")
        self._functions = _waymark.EdgeFunctions(
            tag, list(vertices), dimension, list(fields.items()), error, jacobians, vectorized
        )

    @property
    def tag(self) -> str:
        """Its name in a graph file."""
        return self._functions.tag


class Graph:
    """A graph of vertices (unknowns) and edges (measurements).

    >>> graph = waymark.Graph()
    >>> graph.add_vertex(0, [0, 0, 0], fixed=True)
    >>> graph.add_vertex(1, [0.9, 0.2, 0.1])
    >>> graph.add_edge("EDGE_SE2", [0, 1], [1, 0, 0], np.eye(3))
    >>> graph.optimize().converged
    True
    >>> np.abs(graph.value(1) - [1, 0, 0]).max() < 1e-9
    True
    """

    def __init__(self, graph: "_waymark.Graph | None" = None) -> None:
        self._graph = _waymark.Graph() if graph is None else graph

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        *,
        format: str = "graph",
        lenient: bool = False,
        edge_types: Iterable[EdgeType] = (),
    ) -> "Graph":
        """Read a graph file: .graph or g2o (told apart by the first line), toro, covariance (GTSAM).

        ``edge_types`` are those written in Python that the file may hold. ``lenient`` skips lines that
        are wrong, with a warning. Raises InputError with file, line and column.
        """
        functions = [edge._functions for edge in edge_types]
        graph, told = _waymark.Graph.read(os.fspath(path), format, lenient, functions)
        for sentence in told:
            warnings.warn(sentence, DriveWarning, stacklevel=2)
        return cls(graph)

    def write(self, path: str | os.PathLike[str], *, format: str = "graph", profile: str = "") -> None:
        """Write a graph file: graph, g2o, toro or covariance. ``profile`` names the program that reads it."""
        self._graph.write(os.fspath(path), format, profile)

    def copy(self) -> "Graph":
        """Return a copy that shares nothing."""
        return Graph(self._graph.copy())

    # Vertices

    def add_vertex(
        self,
        id: int,
        value: npt.ArrayLike,
        *,
        type: str = "VERTEX_SE2",
        fixed: bool = False,
        time: float | None = None,
    ) -> None:
        """Add a vertex. ``value`` has the numbers of its type: x, y and heading for VERTEX_SE2."""
        self.add_vertices([id], np.asanyarray(value)[None], type=type, time=None if time is None else [time])
        if fixed:
            self.set_fixed([id])

    def add_vertices(
        self,
        ids: npt.ArrayLike,
        values: npt.ArrayLike,
        *,
        type: str = "VERTEX_SE2",
        time: npt.ArrayLike | None = None,
    ) -> None:
        """Add vertices of one type: ``values`` has a row for each, ``time`` is in seconds."""
        stamps = None if time is None else _nanoseconds(time)
        self._graph.add_vertices(type, _ids(ids), floats("values", values), stamps)

    def value(self, id: int) -> Floats:
        """Return the value of a vertex."""
        return self._graph.value(id)

    def set_values(self, ids: npt.ArrayLike, values: npt.ArrayLike) -> None:
        """Set the values of vertices, a row for each."""
        self._graph.set_values(_ids(ids), floats("values", values))

    def set_fixed(self, ids: npt.ArrayLike, fixed: bool = True) -> None:
        """Hold vertices at their values, or let them go."""
        self._graph.set_fixed(_ids(ids), fixed)

    def vertices(self, type: str = "VERTEX_SE2") -> tuple[Integers, Floats]:
        """Return the ids of the vertices of a type (n,) and their values, a row for each."""
        table = self._graph.vertices(type)
        return table["id"], table["value"]

    def times(self, type: str = "VERTEX_SE2") -> Floats:
        """Return the times of the vertices of a type in seconds; NaN for those without one."""
        return seconds(self._graph.vertices(type)["time_ns"])

    @property
    def vertex_types(self) -> dict[str, int]:
        """How many vertices there are, by type."""
        return self._graph.vertex_types()

    # Edges

    def add_edge(
        self,
        type: str | EdgeType,
        vertices: Sequence[int],
        fields: npt.ArrayLike,
        information: npt.ArrayLike,
        *,
        loss: str | None = None,
    ) -> None:
        """Add an edge: the ids of its vertices, the numbers of its fields, its information matrix.

        ``loss`` is a robust loss with its scale in standard deviations, such as "cauchy:1".
        """
        numbers, matrix = np.ravel(floats("fields", fields)), np.atleast_2d(floats("information", information))
        self.add_edges(type, [list(vertices)], [numbers], matrix, loss=loss)

    def add_edges(
        self,
        type: str | EdgeType,
        vertices: npt.ArrayLike,
        fields: npt.ArrayLike,
        information: npt.ArrayLike,
        *,
        loss: str | None = None,
    ) -> None:
        """Add edges of one type: ``vertices`` and ``fields`` have a row for each.

        ``information`` is one matrix for all (d, d), or one for each (n, d, d): symmetric and positive
        semidefinite. What a file may not hold (such a matrix, NaN, infinity) raises UsageError, and no edge
        is added.
        """
        if isinstance(type, EdgeType):
            self._graph.add_edge_type(type._functions)
            type = type.tag
        numbers, matrices = floats("fields", fields), floats("information", information)
        self._graph.add_edges(type, _ids(vertices), numbers, matrices, loss)

    def edges(self, type: str) -> tuple[Integers, Floats, Floats]:
        """Return the edges of a type: ids of their vertices, fields, information, a row for each."""
        table = self._graph.edges(type)
        return table["vertices"], table["fields"], table["information"]

    @property
    def edge_types(self) -> dict[str, int]:
        """How many edges there are, by type."""
        return self._graph.edge_types()

    def check_derivatives(self) -> list[str]:
        """Compare derivatives with differences of the errors. Return a sentence for each wrong one."""
        return self._graph.check_derivatives()

    # Minimum

    @property
    def chi2(self) -> float:
        """The sum of rho(e^T Omega e) over all edges, at the present values."""
        return self._graph.chi2()

    def optimize(
        self,
        *,
        start: str = "auto",
        algorithm: str = "dogleg",
        algorithm_options: Mapping[str, object] | None = None,
        solver: str = "auto",
        solver_options: Mapping[str, object] | None = None,
        threads: int = 1,
        max_iterations: int = 500,
        tolerance: float = 1e-6,
        progress: Progress = None,
    ) -> Summary:
        """Minimise chi2. Afterwards the graph has the best values found.

        ``start`` is the initial guess: "file" (the present values), "auto" (the best), or the name of
        a registered one.
        """
        choice = {
            "start": start,
            "algorithm": algorithm,
            "algorithm_options": {key: str(value) for key, value in (algorithm_options or {}).items()},
            "solver": solver,
            "solver_options": {key: str(value) for key, value in (solver_options or {}).items()},
            "threads": threads,
            "max_iterations": max_iterations,
            "tolerance": tolerance,
        }
        return Summary(**self._graph.optimize(choice, progress))

    def marginals(self, ids: npt.ArrayLike) -> Any:
        """Return the covariances of vertices at the minimum, in the chart of their types.

        The result is an array (n, d, d) if all have d degrees of freedom, else a list of arrays.
        Vertices that are fixed or held have zeros.
        """
        blocks = self._graph.marginals(_ids(ids))
        return np.stack(blocks) if len({block.shape for block in blocks}) == 1 else blocks

    def joint_marginal(self, ids: npt.ArrayLike) -> Floats:
        """Return the joint covariance of vertices, adjacent or not."""
        return self._graph.joint_marginal(_ids(ids))

    def __repr__(self) -> str:
        vertices = sum(self.vertex_types.values())
        return f"<waymark.Graph: {vertices} vertices, {sum(self.edge_types.values())} edges>"


def _ids(ids: npt.ArrayLike) -> Integers:
    require_unmasked("ids", ids)
    array = np.asarray(ids)
    if array.size > 0 and array.dtype.kind not in "iu":
        raise UsageError(f"ids: must be integers, got {array.dtype}")
    return np.asarray(array, dtype=np.int64)


def _nanoseconds(time: npt.ArrayLike) -> Integers:
    array = floats("time", time)
    if not np.all(np.abs(array) < 9.2e9):  # also for NaN
        raise UsageError("time: must be seconds of less than 292 years")
    whole = np.floor(array)
    nanoseconds = whole.astype(np.int64) * 1_000_000_000 + np.rint((array - whole) * 1e9).astype(np.int64)
    return np.asarray(nanoseconds, dtype=np.int64)
