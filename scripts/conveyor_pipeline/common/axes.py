"""Axes of the config: lists of values, or {start, stop, num}. No slow imports."""

import math
from collections.abc import Mapping, Sequence

Axis = Sequence[float | str] | Mapping[str, float]


def ends(axis: Axis) -> Sequence[float | str]:
    """The values of an axis, or the first and the last one."""
    return [axis["start"], axis["stop"]] if isinstance(axis, Mapping) else axis


def count_values(axis: Axis) -> int:
    """Number of values of an axis."""
    return int(axis["num"]) if isinstance(axis, Mapping) else len(axis)


def count_points(axes: Mapping[str, Axis]) -> int:
    """Number of points in the product of axes."""
    return math.prod(map(count_values, axes.values()))
