"""The likelihood of measured velocities: velocities that some parameters can give, and the density under them.

Under one set of conditions (amplitude, times, known initial conditions), a number of parts with random initial
conditions are followed. Their velocities are a sample of what a measurement can give. They may be one value, several
values with nothing between them, or, in chaos, a whole range.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from conveyor import replace_parameters, sample_runs
from conveyor.analysis.map_states import plate_heights
from conveyor.elementary import exp, log
from conveyor.packing import plate_peaks
from conveyor.parameters import INITIAL_CONDITION
from conveyor_pipeline.common import grid
from conveyor_pipeline.machine.calibration.measurements import Measurement

TOLERANCE = 1e-5  # per contact step: errors of velocities stay far below those of a measurement
# The density around a part's velocity is as wide as the distance to its neighbour of this rank, times a factor, but at
# most a share of the standard deviation of all parts. It is narrow where parts share a velocity, and smooth in chaos.
NEIGHBOUR, WIDENED, OF_ALL = 4, 1.5, 0.4
# Least standard deviation of a measurement, as a share of the plate's largest velocity along the track: what the
# tolerance, and motions that have not settled, add.
FLOOR = 5e-4
# Share of measurements that may have any velocity; otherwise one mistake in the file would decide everything.
OUTLIERS = 0.02
FIRST = 4  # parts that are followed first
# Standard deviations of a measurement within which velocities are alike, and within which one is the measured one.
ALIKE, NEAR = 0.5, 4.0


class Conditions(NamedTuple):
    """Under which conditions parts are followed; k different ones."""

    rows: np.ndarray  # table of parameters, shape (k,), with NaN for unknown initial conditions
    times: np.ndarray  # begin and end of the measurement (s), shape (k, 2)

    @property
    def plate(self) -> np.ndarray:
        """Largest velocity of the plate along the track (m/s), shape (k,)."""
        return plate_peaks(self.rows).vx


def conditions_at(
    accelerations: Sequence[float],
    changed: Sequence[Mapping[str, float]],
    times: Sequence[tuple[float, float]],
    model: Mapping,
) -> Conditions:
    """The conditions at some amplitudes (m/s²) with changed parameters.

    changed : parameters that differ from the model, and known initial conditions
    times : time before a measurement and its duration (s)
    """
    rows = []
    for acceleration, changes in zip(accelerations, changed, strict=True):
        known = {name: value for name, value in changes.items() if name not in INITIAL_CONDITION}
        row = grid.row_of({**model, **known, "acceleration": acceleration})
        for name in INITIAL_CONDITION:
            row[name] = changes.get(name, math.nan)
        rows.append(row)
    before, lasts = np.array(times, dtype=np.float64).T
    return Conditions(np.array(rows), np.column_stack([before, before + lasts]))


def conditions_of(measured: Sequence[Measurement], model: Mapping) -> tuple[Conditions, np.ndarray]:
    """The different conditions of the measurements, and the number of the condition of each one, shape (n,)."""
    keys = [(row.acceleration, row.before, row.duration, tuple(sorted(row.changed.items()))) for row in measured]
    distinct = list(dict.fromkeys(keys))
    conditions = conditions_at(
        [key[0] for key in distinct], [dict(key[3]) for key in distinct], [key[1:3] for key in distinct], model
    )
    return conditions, np.array([distinct.index(key) for key in keys])


def velocities(
    values: Mapping[str, np.ndarray],
    conditions: Conditions,
    settings: dict,
    *,
    parts: int,
    seed: int,
    threads: int = 1,
    progress: str | None = None,
    worth: Callable[[np.ndarray], np.ndarray] | None = None,
) -> np.ndarray:
    """Mean velocities (m/s) of parts for each set of parameters and each of k conditions, shape (n, k, parts).

    NaN stands for a part that could not be followed. The initial conditions are low-discrepancy points (Sobol), shifted
    at random for each set of parameters and each condition, so that a rare motion that the parts of one set miss is not
    missed by all sets.

    Parameters
    ----------
    values : of parameters of the model, by name, each of shape (n,)
    settings : the box of initial conditions, and `static_friction`, which is at least the friction
    parts : number of parts per set and condition
    worth : function of the velocities of the first parts, shape (n, k, FIRST), which returns whether more parts are
        worth following, shape (n, k); where they are not, the first ones count several times
    """
    n, k = len(next(iter(values.values()))), len(conditions.rows)
    random = np.random.default_rng(seed)
    shift = random.random((n, k, 3))
    points = qmc.Sobol(3, scramble=False).random(1 << (parts - 1).bit_length())[:parts]
    low, high = np.array([settings[name] for name in ("height", "vz0", "psi0")], dtype=np.float64).T

    def follow(sets: np.ndarray, condition_numbers: np.ndarray, begin: int, end: int, label: str) -> np.ndarray:
        """The velocities of the parts begin to end for pairs of sets and conditions, shape (m, end - begin)."""
        count = end - begin
        drawn = (points[begin:end] + shift[sets, condition_numbers][:, None]) % 1.0
        height, speed, phase = np.moveaxis(low + (high - low) * drawn, -1, 0).reshape(3, -1)
        rows, times = (np.repeat(array[condition_numbers], count, axis=0) for array in conditions)
        rows["psi0"] = np.where(np.isnan(rows["psi0"]), phase, rows["psi0"])
        rows["vz0"] = np.where(np.isnan(rows["vz0"]), speed, rows["vz0"])
        rows = replace_parameters(rows, **{name: np.repeat(column[sets], count) for name, column in values.items()})
        rows["static_friction"] = np.maximum(rows["friction"], settings["static_friction"])
        height += plate_heights(rows)
        rows["z0"] = np.where(np.isnan(rows["z0"]), height, rows["z0"])
        return mean_velocities(rows, times, threads, progress and f"{progress}{label}").reshape(-1, count)

    first = parts if worth is None else min(FIRST, parts)
    sets, condition_numbers = np.indices((n, k)).reshape(2, -1)
    first_velocities = follow(sets, condition_numbers, 0, first, "").reshape(n, k, first)
    means = np.tile(first_velocities, -(-parts // first))[..., :parts]
    if first < parts:
        sets, condition_numbers = np.nonzero(worth(first_velocities))
        means[sets, condition_numbers, first:] = follow(sets, condition_numbers, first, parts, ", more parts")
    return means


def is_known(
    first_velocities: np.ndarray, measured: np.ndarray, condition_of: np.ndarray, sd: np.ndarray
) -> np.ndarray:
    """Whether the first parts have one velocity, and it is the measured one, so that more parts tell nothing new.

    Parameters
    ----------
    first_velocities : velocities under each condition, m/s, shape (n, k, parts)
    measured, sd : velocities and their standard deviations, m/s, shape (r,)
    condition_of : number of the condition of each of them, shape (r,)

    Returns
    -------
    known : bool, shape (n, k)
    """
    velocity = first_velocities.mean(axis=-1)
    alike = np.ptp(first_velocities, axis=-1)[:, condition_of] <= ALIKE * sd
    agrees = alike & (np.abs(measured - velocity[:, condition_of]) <= NEAR * sd)
    known = np.ones(first_velocities.shape[:2], dtype=bool)
    for column, condition in enumerate(condition_of):
        known[:, condition] &= agrees[:, column]
    return known


def mean_velocities(rows: np.ndarray, times: np.ndarray, threads: int, progress: str | None) -> np.ndarray:
    """Mean feeding velocity (m/s) between two times (s), shape (n, 2), of a table of parameters, shape (n,)."""
    options = {"tolerance": TOLERANCE, "threads": threads, "skip": True, "chunk": 256, "progress": progress}
    runs = sample_runs(rows, times, columns=["x"], **options)
    means = (runs.x[:, 1] - runs.x[:, 0]) / (times[:, 1] - times[:, 0])
    return np.where(runs.status == "ok", means, np.nan)


def widths(velocities: np.ndarray) -> np.ndarray:
    """Standard deviation (m/s) of the density around each velocity, shape (…, parts), as the velocities; see above."""
    order = np.argsort(velocities, axis=-1, kind="stable")
    ascending = np.take_along_axis(velocities, order, axis=-1)
    parts = velocities.shape[-1]
    rank = min(NEIGHBOUR, velocities.shape[-1] - 1)
    # The neighbour of some rank is the nearest end of one of the rank + 1 windows of neighbours around a value.
    distance = np.full_like(ascending, np.inf)
    for offset in range(rank + 1):
        spans = np.full_like(ascending, np.inf)
        inside = slice(offset, parts - rank + offset)
        below = ascending[..., inside] - ascending[..., : parts - rank]
        above = ascending[..., rank:] - ascending[..., inside]
        spans[..., inside] = np.maximum(below, above)
        distance = np.fmin(distance, spans)
    variance = np.ma.masked_invalid(velocities).var(axis=-1, keepdims=True).filled(np.nan)
    widest = OF_ALL * np.sqrt(variance)
    deviations = np.empty_like(velocities)
    np.put_along_axis(deviations, order, np.minimum(WIDENED * distance, widest), axis=-1)
    return deviations


def deviations(velocities: np.ndarray, sd: np.ndarray, plate: np.ndarray, noise: float) -> np.ndarray:
    """Standard deviation (m/s) of a measurement of `velocities` (m/s).

    sd : the given ones, NaN where there is none and the relative `noise` counts
    plate : largest velocity of the plate along the track (m/s)
    All arrays are of shapes that NumPy broadcasts.
    """
    deviation = np.where(np.isnan(sd), noise * np.abs(velocities), sd)
    return np.hypot(deviation, FLOOR * plate)


def log_densities(
    measured: np.ndarray,
    velocities: np.ndarray,
    sd: np.ndarray,
    plate: np.ndarray,
    noise: float,
    spread: np.ndarray | None = None,
    inflation: float = 1.0,
) -> np.ndarray:
    """Logarithm of the density of measured velocities (m/s), shape (n, r).

    Parameters
    ----------
    measured, sd, plate : m/s, of shapes that NumPy broadcasts to (n, r); these and `noise`: see `deviations`
    velocities : of the parts under the conditions of each measurement, m/s, shape (n, r, parts)
    spread : their `widths`
    inflation : factor of the standard deviation of the measurements
    """
    spread = widths(velocities) if spread is None else spread
    scale = np.hypot(inflation * deviations(velocities, sd[..., None], plate[..., None], noise), spread)
    z = (measured[..., None] - velocities) / scale
    density = exp(-0.5 * z**2) / (math.sqrt(2.0 * math.pi) * scale)
    mean = np.nan_to_num(density).sum(axis=-1) / velocities.shape[-1]
    outlier = 0.5 / np.maximum(plate, np.abs(measured))  # even over twice the plate's velocity
    return log((1.0 - OUTLIERS) * mean + OUTLIERS * outlier)
