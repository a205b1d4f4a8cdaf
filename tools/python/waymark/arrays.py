"""Arguments as arrays of numpy."""

from typing import Any

import numpy as np
import numpy.typing as npt

from waymark.errors import UsageError


def require_unmasked(name: str, numbers: Any) -> None:
    """Raise UsageError for an array with masked entries: what they hold is no number."""
    if isinstance(numbers, np.ma.MaskedArray) and np.any(numbers.mask):
        raise UsageError(f"{name}: has masked entries; leave them out, or give NaN where a number may be missing")


def floats(name: str, numbers: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return an argument as numbers of 64 bits."""
    require_unmasked(name, numbers)
    return np.asarray(numbers, dtype=np.float64)
