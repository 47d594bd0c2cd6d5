"""Functions for a single conveyor that join several modules of the analysis: basins, periodic orbits and branches."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import arguments
from .analysis import stroboscopic_map
from .analysis.attractors import labels, search
from .analysis.bifurcations import continuation, periodic_orbits
from .analysis.bifurcations.continuation import Branch
from .analysis.bifurcations.periodic_orbits import Orbit
from .arguments import LARGEST_COORDINATE, MOST_CYCLES
from .packing import AT_REST, as_rows, parameter_table
from .parameters import DEFAULT_TOLERANCE, RANGES
from .solver.model import Conveyor, Start

LARGEST_PERIOD = 1024


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


def periodic_orbit(
    conveyor: Conveyor, start: Start = AT_REST, *, period: int = 1, transient: int = 1000
) -> Orbit | None:
    """The periodic orbit of the vertical motion that Newton's iteration finds from the end of a trajectory.

    Parameters
    ----------
    conveyor, start : conveyor and initial condition of the trajectory
    period : excitation cycles of the orbit, 1 to 1024; the orbit may have a shorter period that divides `period`
    transient : excitation cycles of the trajectory, up to 1e6; 0 begins Newton's iteration at `start`, which unstable
        orbits need

    Returns
    -------
    Orbit with its Floquet multipliers, at the phase ψ0; None where the iteration finds none

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=40.0), Start(z=3e-4))
    >>> orbit.period, orbit.impacts, orbit.stable
    (1, 1, True)
    """
    period = arguments.check_count("period", period, 1, LARGEST_PERIOD)
    transient = arguments.check_count("transient", transient, 0, MOST_CYCLES)
    row, tolerance = as_rows(parameter_table(conveyor, start)), periodic_orbits.ORBIT_TOLERANCE
    (state,) = stroboscopic_map.initial_states(row[None], tolerance)
    stroboscopic_map.follow_map(row, tolerance, state, transient)
    return periodic_orbits.orbit_near(row, conveyor.acceleration, state, period)


def continue_orbit(conveyor: Conveyor, orbit: Orbit, *, low: float, high: float) -> Branch:
    """The branch of an orbit in the amplitude of the excitation, with its folds, period doublings and grazings.

    Parameters
    ----------
    conveyor : its amplitude does not matter, because the orbit has its own
    orbit : of this conveyor, from `periodic_orbit`
    low, high : amplitudes in m/s² between which the branch is followed, on either side of the orbit's amplitude; a
        branch that reaches one of them ends at most 0.1 m/s² before it

    Returns
    -------
    Branch, with folds, period doublings and grazings located to about 1e-9 m/s²

    Examples
    --------
    >>> conveyor = Conveyor(acceleration=50.0)
    >>> branch = continue_orbit(conveyor, periodic_orbit(conveyor, Start(z=3e-4)), low=45.0, high=56.0)
    >>> [(point.kind, round(point.orbit.acceleration, 2)) for point in branch.bifurcations]
    [('period_doubling', 54.22)]
    """
    arguments.check_type("conveyor", conveyor, Conveyor)
    arguments.check_type("orbit", orbit, Orbit)
    acceleration = arguments.check_number("orbit.acceleration", orbit.acceleration, *RANGES["acceleration"], "m/s²")
    arguments.check_count("orbit.period", orbit.period, 1, LARGEST_PERIOD)
    arguments.check_count("orbit.impacts", orbit.impacts, 0, LARGEST_PERIOD * MOST_CYCLES)
    if np.shape(orbit.multipliers) != (2,) or np.asarray(orbit.multipliers).dtype.kind not in "iufc":
        raise ValueError(f"orbit.multipliers must be two numbers, got {orbit.multipliers!r}")
    state = arguments.check_array("orbit.state", orbit.state, -LARGEST_COORDINATE, LARGEST_COORDINATE)
    if state.shape != (2,):
        raise ValueError(f"orbit.state must be δ (m) and v (m/s), got the shape {state.shape}")
    low = arguments.check_number("low", low, RANGES["acceleration"][0], acceleration, "m/s²")
    high = arguments.check_number("high", high, acceleration, RANGES["acceleration"][1], "m/s²")
    parameters = parameter_table(conveyor)
    if not continuation.is_orbit(parameters, orbit):
        raise ValueError("orbit is no orbit of this conveyor; find one with periodic_orbit(conveyor, ...)")
    branch = continuation.follow_branch(parameters, orbit, (low, high))
    return branch._replace(
        orbits=[one for one in branch.orbits if low <= one.acceleration <= high],
        bifurcations=[one for one in branch.bifurcations if low <= one.orbit.acceleration <= high],
    )
