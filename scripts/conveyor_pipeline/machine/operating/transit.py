"""Transit: how fast parts with random initial conditions travel along a track, over the amplitude.

The transit velocity of a part is the length of the track over the time in which the part travels it. A part that has
not arrived after the longest time is late. Its velocity is the distance that it has travelled over this time, and
negative if it has moved back.
"""

import math

import numpy as np
import pandas as pd
from scipy.special import betainc

from conveyor import Block, Columns, block_transits, transits
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.machine.operating.parts import population, raise_blocks, tilts_of, with_calibration
from conveyor_pipeline.machine.operating.populations import (
    IDENTICAL,
    POPULATIONS,
    PROBABILITIES,
    QUANTILES,
    differences,
)

# Excitation cycles after which impacts and forces count, so that the drop onto the track does not.
DROP = 20
# rad, nearly a right angle: a block that has turned so far has landed on another side. A block whose centre only passes
# above a corner may fall back.
TIPPED = math.radians(80.0)


def quantile_fields() -> list:
    """The columns of the quantiles of the transit velocity and of their standard errors."""
    columns = []
    for name, probability in zip(QUANTILES, PROBABILITIES, strict=True):
        share = f"{100 * probability:g} % quantile of the transit velocity"
        columns += [fields.number(name, "m/s", share), fields.number(f"{name}_stderr", "m/s", "its standard error")]
    return columns


# What `summarize` returns.
MEASURES = (
    *quantile_fields(),
    fields.number("mean_velocity", "m/s", "mean of the transit velocity over all parts"),
    fields.number("spread", "1", "relative spread: 95 % quantile minus 5 % quantile, over the size of the median"),
    fields.number("late", "1", "share of the parts that have not arrived after the longest time"),
    fields.number("back", "1", "share of the parts that have moved back after the longest time"),
    fields.number("impact_speed", "m/s", "95 % quantile of the largest speed of approach of a part; 0 for no impacts"),
    fields.number("peak_force", "N", "95 % quantile of the largest contact force of a part"),
    fields.number("tipped", "1", "share of the blocks that tip over onto another side; null for points"),
    fields.count("failed", "parts whose run failed; the other columns do not contain them"),
)
TABLES = {
    "transit": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.text("population", f"{', '.join(POPULATIONS)}: parts with equal or with different parameters"),
        *MEASURES,
    )
}


def time_of_drop(frequency: np.ndarray, longest: float) -> np.ndarray:
    """Time (s) from which impacts and forces count, for frequencies in Hz and the longest time of a part (s)."""
    return np.minimum(DROP / frequency, 0.5 * longest)


def follow(
    rows: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None, **track: np.ndarray
) -> Columns:
    """What `transits` returns for a table of parameters, shape (n,).

    track : `lengths` (m) and `longest` (s), shape (k,), if they are not those of the settings
    """
    track = {"lengths": np.array([settings["length"]]), "longest": np.array([settings["longest"]])} | track
    begin = time_of_drop(rows["frequency"], track["longest"][0])
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    return transits(rows, begin=begin, **track, **options)


def follow_blocks(rows: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> Columns:
    """What `follow` returns, with airtime, largest_tilt and `tipped`, for blocks: parts with the section `body`."""
    block = Block(settings["body"]["length"], settings["body"]["height"])
    tilts = np.resize(tilts_of(settings), len(rows))  # the same in each population
    longest = settings["longest"]
    track = {"length": settings["length"], "longest": longest, "begin": time_of_drop(rows["frequency"], longest)}
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    run = block_transits(raise_blocks(rows, block, tilts), block, tilts, **track, **options)
    tipped = run.largest_tilt > TIPPED
    return Columns({**run, "arrival": run.arrival[:, None], "velocity": run.velocity[:, None], "tipped": tipped})


def follow_parts(rows: np.ndarray, settings: dict, **options) -> Columns:
    """`follow_blocks` if the settings have a `body`, else `follow`; populations lie below each other in the rows."""
    return (follow_blocks if "body" in settings else follow)(rows, settings, **options)


def quantiles(velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The quantiles of velocities, shape (n,), and their standard errors (Maritz and Jarrett 1978), shape (5,)."""
    values = np.quantile(velocity, PROBABILITIES)
    # Without the offset, equal velocities have the error 0 in spite of rounding.
    return values, maritz_jarrett(velocity - values[2])


def maritz_jarrett(data: np.ndarray) -> np.ndarray:
    """Standard errors of the quantiles of data, shape (n,) to (5,), as scipy.stats.mstats.mjci, whose import takes a
    second; NaN for too few data.
    """
    count = len(data)
    errors = np.full(len(PROBABILITIES), np.nan)
    data, x = np.sort(data), np.arange(1, count + 1, dtype=np.float64) / count
    for place, probability in enumerate(PROBABILITIES):
        above = int(count * probability + 0.5)
        if 1 < above < count:
            weights = betainc(above - 1, count - above, x) - betainc(above - 1, count - above, x - 1.0 / count)
            first, second = np.dot(weights, data), np.dot(weights, data**2)
            errors[place] = np.sqrt(second - first**2)
    return errors


def spread_of(values: np.ndarray) -> np.ndarray:
    """95 % quantile minus 5 % quantile, over the size of the median; NaN for a median of 0.

    values : quantiles at PROBABILITIES, shape (5, ...)
    """
    return (values[-1] - values[0]) / np.where(values[2], np.abs(values[2]), np.nan)


def spread_stderr(values: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Standard error of the relative spread; NaN for a median of 0.

    values, errors : quantiles at PROBABILITIES and their standard errors, shape (5, ...)
    """
    return np.hypot(errors[0], errors[-1]) / np.where(values[2], np.abs(values[2]), np.nan)


def upper(peaks: np.ndarray) -> float:
    """The 95 % quantile of the known numbers; NaN if there are none."""
    known = peaks[np.isfinite(peaks)]
    return float(np.quantile(known, PROBABILITIES[-1])) if len(known) else math.nan


def summarize(run: Columns) -> dict[str, float]:
    """The measures of a population from the rows of `follow` on a single track."""
    right = run.status == "ok"
    velocity, arrival = run.velocity[right, 0], run.arrival[right, 0]
    if not right.any():
        return dict.fromkeys((column.name for column in MEASURES), math.nan) | {"failed": len(right)}
    values, errors = quantiles(velocity)
    return {
        **dict(zip(QUANTILES, values, strict=True)),
        **{f"{name}_stderr": error for name, error in zip(QUANTILES, errors, strict=True)},
        "mean_velocity": velocity.mean(),
        "spread": spread_of(values),
        "late": np.isnan(arrival).mean(),
        "back": (velocity < 0.0).mean(),
        **{name: upper(run[name][right]) for name in ("impact_speed", "peak_force")},
        "tipped": run.tipped[right].mean() if "tipped" in run else math.nan,
        "failed": np.count_nonzero(~right),
    }


def summarize_populations(run: Columns, parts: int) -> pd.DataFrame:
    """The measures of populations of so many parts each, below each other in the rows of `follow`; a row for each."""
    begins = range(0, len(run.status), parts)
    return pd.DataFrame([summarize(run.select(slice(begin, begin + parts))) for begin in begins])


def measure(amplitudes: np.ndarray, settings: dict, kinds: tuple[str, ...] = POPULATIONS, **options) -> pd.DataFrame:
    """The table for some amplitudes (m/s²), shape (m,), and kinds of populations.

    settings : as in `population`; `length`, `longest` and `tolerance`
    options : `threads` and `progress`
    """
    # Parts without differences are followed once.
    differ = any(differences(settings).values())
    distinct = kinds if differ else (IDENTICAL,)
    rows = np.concatenate([population(amplitudes, settings, kind) for kind in distinct])
    table = summarize_populations(follow_parts(rows, settings, **options), settings["starts"]).assign(
        acceleration=np.tile(amplitudes, len(distinct)), population=np.repeat(distinct, len(amplitudes))
    )
    if not differ:
        table = pd.concat([table.assign(population=kind) for kind in kinds])
    return table.sort_values("acceleration", kind="stable", ignore_index=True)


def make(
    settings: dict,
    samples: pd.DataFrame | None = None,
    parameters: pd.DataFrame | None = None,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> pd.DataFrame:
    """The table for the settings of the config.

    samples, parameters : tables of a calibration, from whose samples the parameters of varied parts are drawn, too
    """
    settings = with_calibration(settings, samples, parameters)
    amplitudes = np.unique(grid.axis_values("acceleration", settings["acceleration"]))
    return measure(amplitudes, settings, threads=threads, progress=progress)
