"""Boundaries of basins over the initial height: at which z0 does the label change?

A scan of z0 shows the changes between neighbours, and bisection encloses each change. There may be several changes:
along z0 the basins of the states are stripes, which are narrow where a state has just appeared.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

# Changes of state of one conveyor that are located. Where chaos is a long transient, each height has its own label.
MOST = 16


class Crossings(NamedTuple):
    """Changes of state along z0, sorted by conveyor and height; every field has the shape (k,)."""

    point: np.ndarray  # int64, row of the conveyor
    height: np.ndarray  # m, the highest z0 found to lead to the state below
    located: np.ndarray  # bool, whether bisection has located it; otherwise it lies between two heights of the scan
    below: np.ndarray  # str, label just below
    above: np.ndarray  # str, label just above


def find_crossings(
    parameters: np.ndarray, heights: np.ndarray, decide: Callable[[np.ndarray], np.ndarray], resolution: float
) -> Crossings:
    """All changes of state that a scan of z0 shows; bisection locates at most MOST of each conveyor.

    The critical one and the lowest ones are located.

    Parameters
    ----------
    parameters : from `parameter_table`, shape (n,); their z0 does not matter
    heights : z0 of the scan, m, ascending, shape (h,); the scan may miss stripes narrower than their distance
    decide : gives the state of motion, str, shape (m,), for a table of shape (m,)
    resolution : width of the interval that encloses a change, m
    """

    def states_at(points: np.ndarray, z0: np.ndarray) -> np.ndarray:
        rows = parameters[points]
        rows["z0"] = z0
        return decide(rows)

    scan = states_at(np.repeat(np.arange(len(parameters)), len(heights)), np.tile(heights, len(parameters)))
    scan = scan.reshape(len(parameters), len(heights))
    point, left = np.nonzero(scan[:, 1:] != scan[:, :-1])
    low, high = heights[left], heights[left + 1]
    below, above = scan[point, left], scan[point, left + 1]
    rank = np.arange(len(point)) - np.searchsorted(point, point)
    located = (rank < MOST - 1) | select_critical(point, below)
    chosen = np.flatnonzero(located)
    low[chosen], above[chosen] = _bisect(
        lambda places, z0: states_at(point[chosen[places]], z0),
        *(column[chosen] for column in (low, high, below, above)),
        resolution,
    )
    return Crossings(point, low, located, below, above)


def locate_change(
    parameters: np.ndarray,
    quantity: str,
    reach: float,
    decide: Callable[[np.ndarray], np.ndarray],
    resolution: float,
) -> np.ndarray:
    """The value of a parameter at which the state changes, near its value in each row; shape (n,), by bisection.

    It is NaN where the state is the same at both ends of the interval. Of several changes, bisection finds one.

    Parameters
    ----------
    parameters : from `parameter_table`, shape (n,)
    quantity : name of the parameter, such as z0 or acceleration
    reach : half the width of the interval around the parameter's value in `parameters`, in the parameter's unit
    decide : gives the state of motion, str, shape (m,), for a table of shape (m,)
    resolution : width of the interval that encloses the change, in the parameter's unit
    """
    low, high = parameters[quantity] - reach, parameters[quantity] + reach

    def states_at(places, values):
        rows = parameters[places]
        rows[quantity] = values
        return decide(rows)

    below, above = (states_at(np.arange(len(parameters)), values) for values in (low, high))
    changed = np.flatnonzero(below != above)
    values = np.full(len(parameters), np.nan)
    values[changed], _ = _bisect(
        lambda places, middle: states_at(changed[places], middle),
        *(column[changed] for column in (low, high, below, above)),
        resolution,
    )
    return values


def _bisect(states_at, low, high, below, above, resolution):
    """The lower ends of intervals that enclose changes of state, narrowed to a resolution, and the states above.

    states_at : gives the states of some intervals, by their places, at values of the quantity
    low, high, below, above : ends of the intervals and the states there, shape (k,); replaced
    """
    # Neighbouring numbers have none between them, whatever the resolution.
    smallest = 2.0 * np.spacing(np.maximum(np.abs(low), np.abs(high)))
    while (wide := np.flatnonzero(high - low > np.maximum(resolution, smallest))).size:
        middle = 0.5 * (low[wide] + high[wide])
        state = states_at(wide, middle)
        lower = state == below[wide]
        low[wide[lower]] = middle[lower]
        high[wide[~lower]], above[wide[~lower]] = middle[~lower], state[~lower]
    return low, above


def select_critical(point: np.ndarray, below: np.ndarray) -> np.ndarray:
    """Which of some `Crossings` is the critical z0 of its conveyor: bool, shape (k,).

    It is the lowest crossing at which the first state ends: a part released lower is certain to move with the plate.
    (The height above which *only* the second state is found need not exist: where the second state is young, parts that
    fall from still higher land in the first state again.)
    """
    leaves = np.flatnonzero(below == "first")
    chosen = np.zeros(len(point), dtype=bool)
    chosen[leaves[np.unique(point[leaves], return_index=True)[1]]] = True
    return chosen
