"""The basins of a conveyor."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import arguments
from .analysis.attractors import labels, search
from .arguments import MOST_CYCLES
from .packing import parameter_table
from .parameters import DEFAULT_TOLERANCE
from .solver.model import Conveyor


class Basin(NamedTuple):
    """The labels of a grid of initial conditions on one conveyor."""

    z: np.ndarray  # m, shape (n,)
    vz: np.ndarray  # m/s, shape (m,)
    state: np.ndarray  # str, shape (n, m): "first", "second", "chaos" or "undecided"
    period: np.ndarray  # int64, shape (n, m), excitation cycles; 0 for none


def basin(
    conveyor: Conveyor,
    z: ArrayLike,
    vz: ArrayLike = 0.0,
    *,
    cycles: int = labels.CYCLES,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
) -> Basin:
    """The basins of attraction on a grid of initial conditions.

    The attractors of the conveyor are found first. Each trajectory is followed until it must end in one of them.

    Parameters
    ----------
    conveyor : the conveyor of all initial conditions
    z, vz : initial heights (m), of shape (n,) or a number, and velocities (m/s), of shape (m,) or a number; the grid is
        their product
    cycles, tolerance, threads : as in `classify`

    Returns
    -------
    Basin, with labels of shape (n, m)

    Examples
    --------
    >>> labels = basin(Conveyor(acceleration=40.0), z=[0.0, 2e-4, 4e-4])
    >>> labels.state[:, 0].tolist()
    ['first', 'second', 'second']
    """
    heights, speeds = np.atleast_1d(arguments.check_numbers("z", z), arguments.check_numbers("vz", vz))
    for name, array in (("z", heights), ("vz", speeds)):
        if array.ndim > 1:
            raise ValueError(f"{name} must be a number or of shape (n,), got the shape {array.shape}")
    options = {
        "cycles": arguments.check_count("cycles", cycles, 1, MOST_CYCLES),
        "tolerance": arguments.check_tolerance(tolerance),
        "threads": arguments.check_threads(threads),
    }
    try:
        parameters = parameter_table(conveyor, z0=heights[:, None], vz0=speeds)
    except ValueError as error:
        raise ValueError(f"z and vz: {error}") from None
    attractors = search.find_attractors(parameters[:1, 0], **options)
    labelled = labels.classify(parameters, attractors=attractors, **options)
    return Basin(heights.astype(np.float64), speeds.astype(np.float64), labelled.state, labelled.period)
