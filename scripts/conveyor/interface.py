"""The public functions of the library besides `simulate`: they take a Conveyor and plain arrays, and check both.

Arrays given by keyword replace single parameters of the Conveyor and the Start with the same names. They broadcast
against each other, and results have their shape. Each function packs the parameters and calls the module that describes
the method. It checks the arguments that this module does not check itself.
"""

from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import arguments, ensemble
from .analysis import stroboscopic_map
from .analysis.attractors import labels, search
from .analysis.attractors.labels import Labels
from .analysis.bifurcations import continuation, periodic_orbits
from .analysis.bifurcations.continuation import Branch
from .analysis.bifurcations.periodic_orbits import Orbit
from .analysis.chaos import lyapunov
from .analysis.chaos.lyapunov import Spectrum
from .analysis.fractals import box_counting, correlation_sum
from .analysis.fractals.scaling_region import Dimension
from .arguments import LARGEST_COORDINATE, MOST_CYCLES
from .parameters import RANGES
from .simulation import DEFAULT_STEP, DEFAULT_TOLERANCE
from .solver.model import Conveyor, Start, pack, set_columns

AXES = (*(field.name for field in fields(Conveyor) if field.name in RANGES), "z", "vz")
LARGEST_PERIOD = 1024
AT_REST = Start()


class Runs(NamedTuple):
    """The ends of trajectories; every field has the shape of the arrays given to `sweep`."""

    mean_velocity: np.ndarray  # m/s, feeding velocity over the last quarter of the run (Sect. 3.1)
    z_end: np.ndarray  # m
    vz_end: np.ndarray  # m/s
    x_end: np.ndarray  # m
    vx_end: np.ndarray  # m/s
    max_gap: np.ndarray  # m, largest distance between part and plate
    impacts: np.ndarray  # int64
    contact_fraction: np.ndarray  # share of the duration with a contact force
    impact_speed: np.ndarray  # m/s, largest speed of approach at an impact over the last quarter; 0 if there is none
    peak_force: np.ndarray  # N, largest contact force over the last quarter; 0 if there is none
    status: np.ndarray  # str, "ok", or why the run ended early: then impacts are those up to its end, the rest is NaN


class Basin(NamedTuple):
    """The labels of a grid of initial conditions on one conveyor."""

    z: np.ndarray  # m, shape (n,)
    vz: np.ndarray  # m/s, shape (m,)
    state: np.ndarray  # str, shape (n, m): "first", "second", "chaos" or "undecided"
    period: np.ndarray  # int64, shape (n, m), excitation cycles; 0 for none


def pack_all(conveyor: Conveyor, start: Start, values: dict[str, ArrayLike]) -> tuple[np.ndarray, tuple[int, ...]]:
    """Packed parameters, shape (n, 16), one row for each point of the `values`, and the shape of the points."""
    arguments.check_type("conveyor", conveyor, Conveyor)
    arguments.check_type("start", start, Start)
    arrays = arguments.check_parameters(values, AXES)
    shape = next(iter(arrays.values())).shape if arrays else ()
    columns = {{"z": "z0", "vz": "vz0"}.get(name, name): array.ravel() for name, array in arrays.items()}
    if conveyor.static_friction is not None:
        columns = {"static_friction": conveyor.static_friction} | columns
    rows = np.tile(pack(conveyor, start), (int(np.prod(shape)), 1))
    set_columns(rows, columns)
    return rows, shape


def reshape(record: NamedTuple, shape: tuple[int, ...]) -> NamedTuple:
    """The record with its fields, of the shape (n,), in the shape of the points."""
    return type(record)(*(column.reshape(shape) for column in record))


def sweep(
    conveyor: Conveyor,
    start: Start = AT_REST,
    *,
    duration: float = 1.0,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    threads: int = 1,
    **values: ArrayLike,
) -> Runs:
    """Follow a part for each point of some arrays of parameters.

    Parameters
    ----------
    conveyor, start, duration, method, tolerance, step : as in `simulate`
    threads : the results do not depend on it
    values : arrays by the names of Conveyor's and Start's numbers, in their units

    Returns
    -------
    Runs, whose fields have the shape of the `values`

    Raises
    ------
    ValueError, TypeError
        name the argument that cannot be used

    Examples
    --------
    >>> runs = sweep(Conveyor(), duration=0.5, acceleration=np.array([20.0, 40.0])[:, None], z=[0.0, 3e-4])
    >>> runs.mean_velocity.shape
    (2, 2)
    >>> runs.status.tolist()
    [['ok', 'ok'], ['ok', 'ok']]
    >>> bool(runs.mean_velocity[1, 1] > runs.mean_velocity[1, 0])  # at 40 m/s² a part that jumps is faster
    True
    """
    rows, shape = pack_all(conveyor, start, values)
    duration = arguments.check_time("duration", duration)
    options = {"duration": duration, "method": method, "tolerance": tolerance, "step": step, "threads": threads}
    return reshape(Runs(**ensemble.run(rows, **options)), shape)


def classify(
    conveyor: Conveyor,
    start: Start = AT_REST,
    *,
    cycles: int = labels.CYCLES,
    tolerance: float = 1e-8,
    threads: int = 1,
    **values: ArrayLike,
) -> Labels:
    """The label of the attractor that each initial condition leads to: its state of motion and its period.

    Parameters
    ----------
    conveyor, start : the parameters that are not among the `values`
    cycles : excitation cycles after which the search for a period ends, up to 1e6
    tolerance, threads, values : as in `sweep`

    Returns
    -------
    Labels, whose fields have the shape of the `values`; attractors.labels describes how a label is found

    Raises
    ------
    ValueError, TypeError
        name the argument that cannot be used

    Examples
    --------
    >>> found = classify(Conveyor(), acceleration=[40.0, 57.0, 80.0], z=3e-4)
    >>> list(zip(found.state.tolist(), found.period.tolist()))
    [('second', 1), ('second', 2), ('chaos', 0)]
    """
    cycles = arguments.check_count("cycles", cycles, 1, MOST_CYCLES)
    tolerance, threads = arguments.check_tolerance(tolerance), arguments.check_threads(threads)
    rows, shape = pack_all(conveyor, start, values)
    return reshape(labels.classify(rows, cycles=cycles, tolerance=tolerance, threads=threads), shape)


def basin(
    conveyor: Conveyor,
    z: ArrayLike,
    vz: ArrayLike = 0.0,
    *,
    cycles: int = labels.CYCLES,
    tolerance: float = 1e-8,
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

    Raises
    ------
    ValueError, TypeError
        name the argument that cannot be used

    Examples
    --------
    >>> found = basin(Conveyor(acceleration=40.0), z=[0.0, 2e-4, 4e-4])
    >>> found.state[:, 0].tolist()
    ['first', 'second', 'second']
    """
    heights, speeds = np.atleast_1d(arguments.check_numbers("z", z), arguments.check_numbers("vz", vz))
    for name, array in (("z", heights), ("vz", speeds)):
        if array.ndim > 1:
            raise ValueError(f"{name} must be a number or of shape (n,), got the shape {array.shape}")
    cycles = arguments.check_count("cycles", cycles, 1, MOST_CYCLES)
    tolerance, threads = arguments.check_tolerance(tolerance), arguments.check_threads(threads)
    rows, shape = pack_all(conveyor, AT_REST, {"z": heights[:, None], "vz": speeds})
    attractors = search.find_attractors(rows[:1], cycles=cycles, tolerance=tolerance, threads=threads)
    found = labels.classify(rows, cycles=cycles, attractors=attractors, tolerance=tolerance, threads=threads)
    grid = heights.astype(np.float64), speeds.astype(np.float64)
    return Basin(*grid, found.state.reshape(shape), found.period.reshape(shape))


def lyapunov_spectrum(
    conveyor: Conveyor,
    start: Start = AT_REST,
    *,
    transient: int = 200,
    cycles: int = 100,
    blocks: int = 20,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    **values: ArrayLike,
) -> Spectrum:
    """Both Lyapunov exponents of the vertical motion, from its linearisation.

    Parameters
    ----------
    conveyor, start : the parameters that are not among the `values`
    transient : excitation cycles that are discarded at the beginning, up to 1e6
    cycles, blocks : mean over `blocks` (2 to 1e4) blocks of `cycles` (1 to 1e6) excitation cycles; the standard error
        comes from the means of the blocks
    tolerance, threads, values : as in `sweep`

    Returns
    -------
    Spectrum, whose fields have the shape of the `values`; exponents in 1/s

    Raises
    ------
    ValueError, TypeError
        name the argument that cannot be used

    Examples
    --------
    >>> found = lyapunov_spectrum(Conveyor(), acceleration=[40.0, 80.0], z=3e-4)
    >>> (found.lambda_1 > 0.0).tolist()  # 1/s: chaos at 80 m/s²
    [False, True]
    >>> bool(np.allclose(found.lambda_1 + found.lambda_2, -0.3 / 0.7e-3 * found.contact_fraction))
    True
    """
    rows, shape = pack_all(conveyor, start, values)
    counts = {"transient": transient, "cycles": cycles, "blocks": blocks}
    return reshape(lyapunov.spectrum(rows, **counts, tolerance=tolerance, threads=threads), shape)


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

    Raises
    ------
    ValueError, TypeError
        name the argument that cannot be used

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=40.0), Start(z=3e-4))
    >>> orbit.period, orbit.impacts, orbit.stable
    (1, 1, True)
    """
    period = arguments.check_count("period", period, 1, LARGEST_PERIOD)
    transient = arguments.check_count("transient", transient, 0, MOST_CYCLES)
    rows, _ = pack_all(conveyor, start, {})
    (state,) = stroboscopic_map.initial_states(rows, periodic_orbits.TOLERANCE)
    stroboscopic_map.follow(rows[0], periodic_orbits.TOLERANCE, state, transient)
    return periodic_orbits.orbit_near(rows[0], conveyor.acceleration, state, period)


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

    Raises
    ------
    ValueError, TypeError
        name the argument that cannot be used

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
    parameters = pack(conveyor, AT_REST)
    if not continuation.is_orbit(parameters, orbit):
        raise ValueError("orbit is no orbit of this conveyor; find one with periodic_orbit(conveyor, ...)")
    branch = continuation.follow_branch(parameters, orbit, (low, high))
    return branch._replace(
        orbits=[one for one in branch.orbits if low <= one.acceleration <= high],
        bifurcations=[one for one in branch.bifurcations if low <= one.orbit.acceleration <= high],
    )


def box_dimension(points: ArrayLike) -> Dimension:
    """The box-counting dimension of `points`, shape (n, 2), in any units, see fractals.box_counting.

    Returns
    -------
    Dimension; its value and error are NaN if the points resolve fewer than three octaves

    Raises
    ------
    ValueError
        says why the points cannot be used

    Examples
    --------
    >>> points = np.random.default_rng(1).random((20_000, 2))  # a filled square
    >>> found = box_dimension(points)
    >>> bool(abs(found.value - 2.0) < found.error)
    True
    """
    return box_counting.box_dimension(check_points(points))


def correlation_dimension(points: ArrayLike, theiler: int = 0) -> Dimension:
    """The correlation dimension of consecutive `points`, shape (n, 2), in any units, see fractals.correlation_sum.

    Parameters
    ----------
    points : samples of one trajectory, in order
    theiler : pairs of points at most this number of samples apart do not count, 0 to n - 1

    Returns
    -------
    Dimension; its value and error are NaN if the points resolve fewer than three octaves

    Raises
    ------
    ValueError
        names the argument that cannot be used

    Examples
    --------
    >>> angle = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, 10_000)
    >>> found = correlation_dimension(np.column_stack([np.cos(angle), np.sin(angle)]))
    >>> bool(abs(found.value - 1.0) < found.error < 0.1)
    True
    """
    points = check_points(points)
    return correlation_sum.correlation_dimension(points, arguments.check_count("theiler", theiler, 0, len(points) - 1))


def check_points(points: ArrayLike) -> np.ndarray:
    """`points` as a float64 array of the shape (n, 2); ValueError for another shape or values not finite."""
    points = arguments.check_array("points", points, -LARGEST_COORDINATE, LARGEST_COORDINATE)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"points must have the shape (n, 2), got {points.shape}")
    return points
