"""The results of a fusion as arrays of numpy. They refer to the memory of the result, read-only."""

import json
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from waymark import _waymark

if TYPE_CHECKING:
    import pandas

    from waymark.graph import Graph

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Texts = npt.NDArray[np.str_]

_SHAPES = {"position": (0, 2), "place": (0, 2), "sigma": (0, 2), "residual": (0, 2), "error": (0, 2),
           "fused_position": (0, 2), "fused_covariance": (0, 2, 2), "fused_error": (0, 2)}
_NO_TIME = np.iinfo(np.int64).min


def seconds(time_ns: Integers) -> Floats:
    """Convert nanoseconds to seconds; NaN where there is no time."""
    return np.where(time_ns == _NO_TIME, np.nan, time_ns * 1e-9)


@dataclass(frozen=True)
class Summary:
    """How the minimum was found."""

    converged: bool
    termination: str
    message: str
    initial_chi2: float
    chi2: float
    iterations: int
    start: str
    algorithm: str
    solver: str
    unknowns: int
    seconds: float
    notes: list[str]
    chi2_of_steps: Floats


@dataclass(frozen=True)
class Trajectory:
    """The fused poses, sorted as in the graph. Lengths in metres, angles in radians."""

    time_ns: Integers  #: (n,) on the time scale of the drive
    id: Integers  #: (n,) of the vertices in the graph
    pose: Floats  #: (n, 3) x, y in the frame (east, north), heading counter-clockwise from east
    place: Floats  #: (n, 2) latitude and longitude in degrees; NaN without a known frame
    covariance: Floats  #: (n, 3, 3) of the pose; NaN where it was not computed

    @property
    def time(self) -> Floats:
        """(n,) seconds on the time scale of the drive."""
        return seconds(self.time_ns)

    @property
    def x(self) -> Floats:
        return self.pose[:, 0]

    @property
    def y(self) -> Floats:
        return self.pose[:, 1]

    @property
    def heading(self) -> Floats:
        return self.pose[:, 2]

    @property
    def latitude(self) -> Floats:
        return self.place[:, 0]

    @property
    def longitude(self) -> Floats:
        return self.place[:, 1]

    @property
    def sigma(self) -> Floats:
        """(n, 3) standard deviations of x, y and heading."""
        return np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2))

    def __len__(self) -> int:
        return len(self.time_ns)

    def to_pandas(self) -> "pandas.DataFrame":
        """Return a DataFrame, a row per pose."""
        import pandas

        columns = {name: getattr(self, name) for name in ("time", "x", "y", "heading", "latitude", "longitude")}
        sigma = self.sigma
        columns.update(sigma_x=sigma[:, 0], sigma_y=sigma[:, 1], sigma_heading=sigma[:, 2])
        return pandas.DataFrame(columns)


@dataclass(frozen=True)
class Fixes:
    """The fixes of the drive, what became of them, and the fused result at each of them."""

    time_ns: Integers  #: (n,)
    id: Integers  #: (n,) of the pose at the fix
    source: Texts  #: (n,) receiver
    status: Texts  #: (n,) accepted, rejected or withheld
    reason: Texts  #: (n,) of the status
    quality: Texts  #: (n,) single, differential, float, fixed, ...
    position: Floats  #: (n, 2) of the antenna in the frame, m
    place: Floats  #: (n, 2) latitude and longitude of the antenna, degrees
    sigma: Floats  #: (n, 2) as the receiver states it, m
    residual: Floats  #: (n, 2) fix minus fused antenna, m
    nis: Floats  #: (n,) normalised innovation squared; NaN if the errors of fixes are not independent
    error: Floats  #: (n, 2) fix minus truth at the body point, m; NaN without truth
    fused_position: Floats  #: (n, 2) of the body point in the frame, m
    fused_covariance: Floats  #: (n, 2, 2) of it, m^2
    fused_error: Floats  #: (n, 2) fused minus truth, m; NaN without truth
    fused_heading_error: Floats  #: (n,) rad; NaN without a heading of the truth
    nees: Floats  #: (n,) normalised estimation error squared; NaN without truth

    @property
    def time(self) -> Floats:
        """(n,) seconds on the time scale of the drive."""
        return seconds(self.time_ns)

    @property
    def accepted(self) -> npt.NDArray[np.bool_]:
        """(n,) which fixes are in the graph."""
        return np.asarray(self.status == "accepted", dtype=np.bool_)

    def __len__(self) -> int:
        return len(self.time_ns)

    def to_pandas(self) -> "pandas.DataFrame":
        """Return a DataFrame, a row per fix; vectors have a column for x and one for y."""
        import pandas

        columns: dict[str, Any] = {"time": self.time}
        for field in fields(self):
            array = getattr(self, field.name)
            if array.ndim == 1 and field.name != "time_ns":
                columns[field.name] = array
            elif array.ndim == 2:
                names = ("latitude", "longitude") if field.name == "place" else (f"{field.name}_x", f"{field.name}_y")
                columns[names[0]], columns[names[1]] = array[:, 0], array[:, 1]
        return pandas.DataFrame(columns)


@dataclass(frozen=True)
class Residuals:
    """The residuals of all edges of one type at the minimum."""

    time_ns: Integers  #: (n,) the latest of the vertices of the edge; the least integer if there is none
    squared: Floats  #: (n,) e^T Omega e
    weight: Floats  #: (n,) of the robust loss; 1 without one
    whitened: Floats  #: (n, d) components with variance 1; NaN without information
    components: list[str]  #: names of the components
    role: str  #: measurement, process or prior

    @property
    def time(self) -> Floats:
        """(n,) seconds on the time scale of the drive; NaN for edges without a time."""
        return seconds(self.time_ns)

    def __len__(self) -> int:
        return len(self.time_ns)


@dataclass(frozen=True)
class State:
    """A number that was estimated beside the poses, such as the bias of the gyro."""

    name: str
    unit: str
    value: float  #: the last one, if it wanders
    sigma: float
    prior_sigma: float
    observed: bool  #: the drive tells more about it than the prior did
    time_ns: Integers  #: of the values; empty for a constant
    values: Floats  #: over time; empty for a constant

    @property
    def time(self) -> Floats:
        """Seconds on the time scale of the drive."""
        return seconds(self.time_ns)


class Result:
    """A fused drive. Its arrays are computed when they are first asked for."""

    def __init__(self, fused: "_waymark.Fused") -> None:
        self._fused = fused

    @property
    def modeling(self) -> str:
        """The GNSS modeling."""
        return self._fused.modeling

    @property
    def converged(self) -> bool:
        """Whether the result is a minimum."""
        return self.summary.converged

    @cached_property
    def summary(self) -> Summary:
        """How the minimum was found."""
        return Summary(**self._fused.summary())

    @cached_property
    def trajectory(self) -> Trajectory:
        """The fused poses with their covariances."""
        return Trajectory(**self._fused.trajectory())

    @cached_property
    def fixes(self) -> Fixes:
        """The fixes, and the fused result at each of them."""
        table: dict[str, Any] = self._fused.fixes()
        if not table:  # a drive without a receiver
            table = {field.name: np.empty(_SHAPES.get(field.name, (0,))) for field in fields(Fixes)}
        return Fixes(**table)

    @cached_property
    def residuals(self) -> dict[str, Residuals]:
        """The residuals of all edges, by the tag of their type."""
        return {tag: Residuals(**table) for tag, table in self._fused.residuals().items()}

    @cached_property
    def states(self) -> dict[str, State]:
        """The numbers that were estimated beside the poses, by name."""
        return {state["name"]: State(**state) for state in self._fused.states()}

    @cached_property
    def noise(self) -> list[dict[str, Any]]:
        """The estimated parameters of the noise; empty if it is as stated."""
        noise: list[dict[str, Any]] = json.loads(self._fused.noise_json())
        return noise

    @cached_property
    def metrics(self) -> dict[str, Any]:
        """The metrics of this modeling, as metrics.json of ``waymark run`` has them."""
        evaluations = json.loads(self._fused.metrics_json())["evaluations"]
        return next(one for one in evaluations if one["label"] == self.modeling)

    @cached_property
    def frame(self) -> dict[str, Any] | None:
        """UTM zone (negative in the south) and origin (easting, northing in m); None if it is not known."""
        return self._fused.frame()

    @property
    def time_scale(self) -> str:
        """Of all times: gps, utc or unix."""
        return self._fused.time_scale()

    @property
    def warnings(self) -> list[str]:
        """What is or may be wrong."""
        return self._fused.warnings()

    @property
    def notes(self) -> list[str]:
        """What was assumed and left out."""
        return self._fused.notes()

    @property
    def provenance(self) -> list[tuple[str, str]]:
        """Where the result comes from: inputs with fingerprints, settings, versions."""
        return self._fused.provenance()

    @property
    def files(self) -> list[str]:
        """The files that were written."""
        return self._fused.files()

    def graph(self) -> "Graph":
        """Return a copy of the graph at its minimum, to add edges or to optimise again."""
        from waymark.graph import Graph

        return Graph(self._fused.graph())

    def plot(self, axes: Any = None) -> Any:
        """Draw fixes and trajectory with matplotlib, and return the axes."""
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.subplots()[1]
        if len(self.fixes) > 0:
            for status, mark in (("accepted", "."), ("rejected", "x"), ("withheld", "+")):
                chosen = self.fixes.position[self.fixes.status == status]
                if len(chosen) > 0:
                    axes.plot(chosen[:, 0], chosen[:, 1], mark, label=f"fixes {status}")
        axes.plot(self.trajectory.x, self.trajectory.y, label=f"fused, {self.modeling}")
        axes.set_aspect("equal", "datalim")
        axes.set_xlabel("east [m]")
        axes.set_ylabel("north [m]")
        axes.legend()
        return axes

    def __repr__(self) -> str:
        state = "converged" if self.converged else "NOT converged"
        return f"<waymark.Result {self.modeling}: {state}, chi2 {self.summary.chi2:.6g}, {len(self.trajectory)} poses>"
