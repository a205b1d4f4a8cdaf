"""Fusing a drive: the main job of ``waymark run``, from a drive.yaml or from arrays."""

import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from waymark import _waymark
from waymark.arrays import require_unmasked
from waymark.errors import DriveWarning, NotConverged, UsageError
from waymark.results import Result

#: Columns of a log by their quantity: a dict, a structured array or a DataFrame of pandas.
Table = Any
Drive = str | os.PathLike[str] | Mapping[str, Any] | None
#: Called with the work, the number of the iteration and chi2. Both are None between optimisations.
Progress = Callable[[str, int | None, float | None], object] | None


def fuse(
    drive: Drive = None,
    *,
    odometry: Table = None,
    gnss: Table = None,
    truth: Table = None,
    modeling: str | None = None,
    options: Mapping[str, object] | None = None,
    calibrate: str | Mapping[str, str] | None = None,
    noise: str | None = None,
    gate: bool | None = None,
    gnss_loss: str | None = None,
    initial_guess: str | None = None,
    withhold: int | None = None,
    outage: str | None = None,
    causal: bool = False,
    from_s: float | None = None,
    to_s: float | None = None,
    sync: bool = False,
    data: str | os.PathLike[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    covariances: str = "all",
    algorithm: str | None = None,
    algorithm_options: Mapping[str, object] | None = None,
    solver: str | None = None,
    solver_options: Mapping[str, object] | None = None,
    threads: int = 1,
    max_iterations: int | None = None,
    tolerance: float | None = None,
    plugins: Sequence[str | os.PathLike[str]] = (),
    progress: Progress = None,
) -> Result:
    """Fuse a drive with one modeling, as ``waymark run`` does, and return its result.

    ``drive`` is the name of a drive.yaml, or the content of one as a dict. Arrays take the place of
    logs: ``odometry`` has the columns time, speed and yaw_rate, ``gnss`` has time, latitude,
    longitude and sigma, ``truth`` has time, latitude and longitude. In a dict, the key ``samples`` of
    any log does the same.

    The other arguments are the options of ``waymark run``, by the same names. ``out`` writes the
    folder that it writes; without it nothing is written. ``covariances`` says for which poses they
    are computed: "all", "fixes" or "none" (those at the fixes are computed anyway).

    Raises UsageError for wrong arguments and InputError for a wrong input. A result that is no
    minimum is returned with the warning NotConverged.

    >>> result = waymark.fuse(drive, modeling="g2")
    >>> result.modeling
    'g2'
    """
    given = {key: value for key, value in locals().items() if key != "modeling"}
    results = fuse_all(modelings=None if modeling is None else [modeling], **given)
    if len(results) != 1:
        raise UsageError("modeling: fuse() takes one; fuse_all() takes several")
    return next(iter(results.values()))


def fuse_all(
    drive: Drive = None, *, modelings: Iterable[str] | None = ("all",), **arguments: Any
) -> dict[str, Result]:
    """Fuse a drive once for each modeling, by default all of them. The logs are read once.

    The arguments are those of fuse().

    >>> results = waymark.fuse_all(drive, modelings=["g1", "g2"])
    >>> list(results)
    ['g1', 'g2']
    """
    logs: dict[str, dict[str, Any]] = {}
    path, text = _description(drive, arguments, logs)
    progress = arguments.pop("progress", None)
    choice = _choice(arguments)
    if modelings is not None:
        choice["modelings"] = [modelings] if isinstance(modelings, str) else list(modelings)
    fused = _waymark.fuse(path, text, logs, choice, progress)
    results = {one.modeling: Result(one) for one in fused}
    for sentence in fused[0].warnings():
        warnings.warn(sentence, DriveWarning, stacklevel=3)
    for name, result in results.items():
        if not result.converged:
            warnings.warn(f"{name}: {result.summary.message}", NotConverged, stacklevel=3)
    return results


def registered(plugins: Sequence[str | os.PathLike[str]] = ()) -> dict[str, list[str]]:
    """Return the names of everything that is registered, by kind.

    >>> waymark.registered()["algorithms"]
    ['gauss_newton', 'levenberg_marquardt', 'dogleg']
    """
    return _waymark.registered([os.fspath(plugin) for plugin in plugins])


def _description(
    drive: Drive, arguments: dict[str, Any], logs: dict[str, dict[str, Any]]
) -> tuple[str, str | None]:
    """Return the name and the text of a drive.yaml, and move the arrays of a dict into ``logs``."""
    tables = {key: arguments.pop(key, None) for key in ("odometry", "gnss", "truth")}
    tables = {key: table for key, table in tables.items() if table is not None}
    if isinstance(drive, (str, os.PathLike)):
        if tables:
            raise UsageError(f"{next(iter(tables))}: a drive.yaml names its logs itself; load it as a dict")
        return os.fspath(drive), None
    if drive is None and not tables:
        raise UsageError("drive: name a drive.yaml, or give arrays as odometry and gnss")
    content = dict(drive or {})
    for key, table in tables.items():
        entry = dict(content.get(key) or {})
        if "file" in entry or "samples" in entry:
            raise UsageError(f"{key}: it is given twice, in the drive and as an argument")
        content[key] = {**entry, "samples": table}
    return "drive", json.dumps(_without_samples(content, "", logs), indent=1, default=_plain)


def _without_samples(entry: Any, name: str, logs: dict[str, dict[str, Any]]) -> Any:
    """Return an entry of a drive with a name of memory in the place of each table of samples."""
    if isinstance(entry, Mapping):
        inner = {key: _without_samples(value, f"{name}.{key}" if name else str(key), logs)
                 for key, value in entry.items() if key != "samples"}
        if "samples" in entry:
            table, is_unix = _columns(name, entry["samples"])
            logs[name] = table
            inner["file"] = "memory://" + name
            if is_unix:
                inner["time"] = {"scale": "unix", **inner.get("time", {})}
        return inner
    if isinstance(entry, (list, tuple)):
        return [_without_samples(value, f"{name}[{i}]", logs) for i, value in enumerate(entry)]
    return entry


def _columns(name: str, table: Table) -> tuple[dict[str, Any], bool]:
    """Return the columns of a table as arrays, and whether its times are dates (POSIX time)."""
    names = getattr(getattr(table, "dtype", None), "names", None)  # of a structured array
    if names is None:
        try:
            names = list(table)
            columns = {str(key): table[key] for key in names}
        except (TypeError, KeyError, IndexError):
            raise UsageError(f"{name}: expected columns by name: a dict, a structured array or a DataFrame") from None
    else:
        columns = {key: table[key] for key in names}
    for key, column in columns.items():
        require_unmasked(f"{name}: column '{key}'", column)
        columns[key] = array = np.asarray(column)
        if array.ndim != 1:
            raise UsageError(f"{name}: column '{key}' must have one dimension, it has {array.ndim}")
        if array.dtype.kind not in "fiubM":
            raise UsageError(f"{name}: column '{key}' must hold numbers, it holds {array.dtype}")
    time = columns.get("time", columns.get("time_ns"))
    if time is None:
        raise UsageError(f"{name}: there is no column 'time' (seconds or datetime64) or 'time_ns'")
    is_unix = time.dtype.kind == "M"
    if is_unix:
        columns.pop("time", None)
        columns["time_ns"] = time.astype("datetime64[ns]").astype(np.int64)
    return columns, is_unix


def _plain(value: Any) -> Any:
    """Convert numbers of numpy and names of files for JSON."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise UsageError(f"drive: {value!r} has no place in a drive.yaml")


def _words(given: Mapping[str, object]) -> dict[str, str]:
    """Return options as texts, as the command line and drive.yaml have them."""
    return {key: json.dumps(value) if isinstance(value, bool) else str(value) for key, value in given.items()}


def _choice(arguments: dict[str, Any]) -> dict[str, Any]:
    """Return the choices for the job by its names."""
    choice = {key: value for key, value in arguments.items() if value is not None}
    unknown = set(choice) - _ARGUMENTS
    if unknown:
        raise TypeError(f"fuse_all() got an unexpected keyword argument '{sorted(unknown)[0]}'")
    if "options" in choice:
        choice["modeling_options"] = [f"{key}={value}" for key, value in _words(choice.pop("options")).items()]
    calibrate = choice.get("calibrate")
    if isinstance(calibrate, Mapping):
        choice["calibrate"] = [f"{key}={value}" for key, value in calibrate.items()]
    elif calibrate is not None:
        choice["calibrate"] = str(calibrate).split(",")
    for key in ("algorithm_options", "solver_options"):
        if key in choice:
            choice[key] = _words(choice[key])
    if "data" in choice:
        choice["data_folder"] = os.fspath(choice.pop("data"))
    if "out" in choice:
        choice["out"] = os.fspath(choice["out"])
    choice["plugins"] = [os.fspath(plugin) for plugin in choice.get("plugins", ())]
    choice.setdefault("covariances", "all")
    return choice


_ARGUMENTS = {
    "options", "calibrate", "noise", "gate", "gnss_loss", "initial_guess", "withhold", "outage", "causal",
    "from_s", "to_s", "sync", "data", "out", "covariances", "algorithm", "algorithm_options", "solver",
    "solver_options", "threads", "max_iterations", "tolerance", "plugins",
}
