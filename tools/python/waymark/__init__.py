"""Waymark: where a vehicle has been, by fusing odometry and GNSS in a pose graph.

>>> import waymark
>>> result = waymark.fuse(drive)
>>> result.converged
True
>>> result.trajectory.pose.shape
(8543, 3)
"""

from waymark._waymark import version as __version__
from waymark.errors import (
    DriveWarning,
    Error,
    InputError,
    NotConverged,
    OutputError,
    PluginError,
    UsageError,
)
from waymark.fusion import fuse, fuse_all, registered
from waymark.graph import EdgeType, Graph
from waymark.results import Fixes, Residuals, Result, State, Summary, Trajectory

__all__ = [
    "DriveWarning",
    "EdgeType",
    "Error",
    "Fixes",
    "Graph",
    "InputError",
    "NotConverged",
    "OutputError",
    "PluginError",
    "Residuals",
    "Result",
    "State",
    "Summary",
    "Trajectory",
    "UsageError",
    "__version__",
    "fuse",
    "fuse_all",
    "registered",
]
