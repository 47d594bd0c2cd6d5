"""The attractors of one conveyor, and their basins."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import arguments
from .analysis import stroboscopic_map
from .analysis.attractors import identity, labels, sampling, search
from .analysis.attractors.attractor_table import ChaoticSets
from .analysis.attractors.identity import Attractor, Attractors
from .columns import Columns
from .ensemble import sweep
from .packing import as_table, check_row, plate_peaks
from .parameters import DEFAULT_TOLERANCE, LAST, RANGES, UNITS
from .progress import progress_bar
from .solver import contact
from .solver.model import FREQUENCY, Conveyor

SAMPLES = 256
CYCLES = 2048  # excitation cycles over which a mean velocity is taken, whole periods up to MAX_PERIOD
SETTLED = 1e-3  # largest relative change of the mean velocity of a periodic motion after twice as many cycles
NEGLIGIBLE = 1e-6  # of the plate's largest velocity: a change that does not count


def attractors(
    conveyor: Conveyor | np.ndarray,
    *,
    samples: int = SAMPLES,
    cycles: int = labels.CYCLES,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Attractors:
    """All attractors that sampled initial conditions of a conveyor lead to.

    An attractor with a basin of less than about 1/`samples` of the samples may be missing. Where chaos is a long
    transient, the label of a single initial condition depends on the tolerance; the shares depend little on it.

    Parameters
    ----------
    conveyor : a Conveyor, or a row of a table
    samples : number of initial conditions, as in sampling.sampled_initial_conditions: in the air, no faster and no
        higher than a part that jumps over one or two cycles
    cycles, tolerance, threads, progress : as in `classify`

    Returns
    -------
    Attractors: `found`, each with its state of motion, period, orbit (with multipliers), states once per cycle, mean
    feeding velocity (m/s) and share of the samples; and `columns` of them. The mean velocity is that of 2048 cycles.
    For a periodic motion it is NaN if it has not settled by then, as with little friction or where a part slides away.

    Examples
    --------
    >>> found = attractors(Conveyor(acceleration=40.0)).found
    >>> [(one.state, one.period, round(one.share, 1)) for one in found]
    [('second', 1, 0.6), ('first', 1, 0.4)]
    """
    row = check_row("conveyor", conveyor)
    samples = arguments.check_count("samples", samples, 1, arguments.MOST_CYCLES)
    with progress_bar(total=1 + samples, label=progress) as shown:
        options = {"cycles": cycles, "tolerance": tolerance, "threads": threads, "progress": shown}
        return attractors_of_row(row, samples, options)


def attractors_of_row(row: np.ndarray, samples: int, options: dict[str, Any]) -> Attractors:
    """The Attractors of packed parameters, shape (16,), with the options of `classify`."""
    tolerance = labels.check_tolerance(options["tolerance"])
    table = search.find_attractors(as_table(row[None]), **options)
    conveyor = table.orbits.conveyors[0] if len(table.orbits.conveyors) else labels.distinct_rows(row[None])[0][0]
    at_top, constants = stroboscopic_map.begin_at_top(conveyor), contact.constants(row, tolerance)
    starts = sampling.sampled_initial_conditions(row, samples)
    starts = stroboscopic_map.pack_states(np.tile(at_top, (samples, 1)), starts, tolerance)
    found = [
        identity.orbit_attractor(conveyor, labels.regular_state(flight * row[FREQUENCY]), int(period), state)
        for state, period, flight in zip(
            (stroboscopic_map.state_of(constants, centre) for centre in table.orbits.centres),
            table.orbits.periods,
            table.orbits.flights,
            strict=True,
        )
    ]
    found += [Attractor("chaos", 0, None, np.full((1, 2), np.nan)) for _ in table.chaotic.low]
    known = Attractors(found, conveyor, table)
    labelled = labels.classify(as_table(starts), attractors=known, **options)
    known, numbers = with_unknown(known, labelled)
    known, numbers = without_transients(known, numbers)
    return known._replace(found=with_velocities(known.found, at_top, labelled, numbers, tolerance))


def with_unknown(known: Attractors, labelled: Columns) -> tuple[Attractors, np.ndarray]:
    """The attractors and those that the labels of n trajectories add to them, and the number of each one's, (n,)."""
    grown, numbers = known._replace(found=list(known.found)), labelled.attractor.copy()
    unknown = np.flatnonzero(numbers == identity.UNKNOWN)
    while len(unknown):
        k, unknown = unknown[0], unknown[1:]
        label = labelled.select([k])
        state, period = np.column_stack([label.delta, label.v]), int(label.period[0])
        new = Attractor(label.state[0], 0, None, state)
        if period:
            new = identity.orbit_attractor(known.conveyor, label.state[0], period, state[0])
            delta, v = new.strobes[:1].T
            # Where a motion approaches its orbit slowly, only the orbit tells that it is known.
            (numbers[k],) = identity.identify(grown, Columns({**label, "delta": delta, "v": v}))
        if numbers[k] == identity.UNKNOWN:
            grown.found.append(new)
            numbers[k] = len(grown.found) - 1
            numbers[unknown] = identity.identify(grown, labelled.select(unknown))
            unknown = unknown[numbers[unknown] == identity.UNKNOWN]
    return grown, numbers


def without_transients(known: Attractors, numbers: np.ndarray) -> tuple[Attractors, np.ndarray]:
    """The attractors without the chaotic sets in which no sample ends, and the new number of each sample's."""
    remains, orbits = np.ones(len(known.found), dtype=np.bool_), len(known.table.orbits.periods)
    sets = slice(orbits, orbits + len(known.table.chaotic.low))
    remains[sets] = np.isin(np.arange(len(remains)), numbers)[sets]
    chaotic = ChaoticSets(*(column[remains[sets]] for column in known.table.chaotic))
    found = [attractor for attractor, is_kept in zip(known.found, remains, strict=True) if is_kept]
    return Attractors(found, known.conveyor, known.table._replace(chaotic=chaotic)), (np.cumsum(remains) - 1)[numbers]


def with_velocities(
    found: list[Attractor], row: np.ndarray, labelled: Columns, numbers: np.ndarray, tolerance: float
) -> list[Attractor]:
    """The attractors with shares of the samples, mean velocities, and a state for those that have none.

    numbers : of the attractor of each label, shape (n,)
    """
    states = []
    for k, attractor in enumerate(found):
        rows = np.flatnonzero(numbers == k)[:1]
        state = attractor.strobes[0]
        if not attractor.period and len(rows):
            state = np.array([labelled.delta[rows[0]], labelled.v[rows[0]]])
        states.append(state)
    starts = stroboscopic_map.pack_states(np.tile(row, (len(found), 1)), np.array(states).reshape(-1, 2), tolerance)
    periods = np.array([max(attractor.period, 1) for attractor in found])
    cycles = periods * np.ceil(CYCLES * LAST / periods) / LAST
    durations = cycles / row[FREQUENCY]
    velocities = sweep(as_table(starts), duration=durations, tolerance=tolerance).mean_velocity
    is_periodic = np.array([attractor.period > 0 for attractor in found], dtype=np.bool_)
    periodic = as_table(starts[is_periodic])
    longer = sweep(periodic, duration=2.0 * durations[is_periodic], tolerance=tolerance).mean_velocity
    change = np.abs(longer - velocities[is_periodic])
    is_settled = change <= SETTLED * np.abs(longer) + NEGLIGIBLE * plate_peaks(periodic).vx
    velocities[is_periodic] = np.where(is_settled, velocities[is_periodic], np.nan)
    return [
        attractor._replace(
            strobes=attractor.strobes if attractor.period else state[None],
            mean_velocity=float(velocity),
            share=float(np.mean(numbers == k)),
        )
        for k, (attractor, state, velocity) in enumerate(zip(found, states, velocities, strict=True))
    ]


class Basin(NamedTuple):
    """The labels of a grid of initial conditions on one conveyor."""

    z: np.ndarray  # m, shape (n,)
    vz: np.ndarray  # m/s, shape (m,)
    state: np.ndarray  # str, shape (n, m): "first", "second", "chaos" or "undecided"
    period: np.ndarray  # int64, shape (n, m), excitation cycles; 0 for none
    attractor: np.ndarray  # int64, shape (n, m), number among `attractors`
    attractors: Attractors  # that samples or the grid lead to; shares are those of the samples

    def __repr__(self) -> str:
        return f"Basin({len(self.z)} heights × {len(self.vz)} velocities)\n{self.attractors!r}"


def basin(
    conveyor: Conveyor | np.ndarray,
    z: ArrayLike,
    vz: ArrayLike = 0.0,
    *,
    cycles: int = labels.CYCLES,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Basin:
    """The basins of attraction on a grid of initial conditions.

    The attractors of the conveyor are found first. Each trajectory is followed until it must end in one of them, or in
    another one, which is added to them.

    Parameters
    ----------
    conveyor : the conveyor of all initial conditions, a Conveyor or a row of a table
    z, vz : initial heights (m), of shape (n,) or a number, and velocities (m/s), of shape (m,) or a number; the grid is
        their product
    cycles, tolerance, threads, progress : as in `classify`

    Returns
    -------
    Basin, with labels of shape (n, m), and the number of the attractor for each

    Examples
    --------
    >>> labels = basin(Conveyor(acceleration=40.0), z=[0.0, 2e-4, 4e-4])
    >>> labels.state[:, 0].tolist()
    ['first', 'second', 'second']
    """
    heights = np.atleast_1d(arguments.check_array("z", z, *RANGES["z0"], UNITS["z0"]))
    speeds = np.atleast_1d(arguments.check_array("vz", vz, *RANGES["vz0"], UNITS["vz0"]))
    for name, array in (("z", heights), ("vz", speeds)):
        if array.ndim > 1:
            raise ValueError(f"{name} must be a number or of shape (n,), got the shape {array.shape}")
    if heights.size * speeds.size > arguments.MOST_VALUES:
        raise ValueError(f"z and vz have {heights.size * speeds.size} points, more than {arguments.MOST_VALUES:g}")
    row = check_row("conveyor", conveyor)
    parameters = np.full((heights.size, speeds.size), as_table(row))
    parameters["z0"], parameters["vz0"] = heights[:, None], speeds
    with progress_bar(total=1 + SAMPLES + parameters.size, label=progress) as shown:
        options = {"cycles": cycles, "tolerance": tolerance, "threads": threads, "progress": shown}
        sampled = attractors_of_row(row, SAMPLES, options)
        labelled = labels.classify(parameters.reshape(-1), attractors=sampled, **options)
    known, numbers = with_unknown(sampled, labelled)
    count, at_top = len(sampled.found), stroboscopic_map.begin_at_top(sampled.conveyor)
    added = with_velocities(known.found[count:], at_top, labelled, numbers - count, options["tolerance"])
    known = known._replace(found=sampled.found + [one._replace(share=0.0) for one in added])
    about = (column.reshape(parameters.shape) for column in (labelled.state, labelled.period, numbers))
    return Basin(heights, speeds, *about, known)
