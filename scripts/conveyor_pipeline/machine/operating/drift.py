"""Why chaos feeds evenly: drift and diffusion of chaotic motions, and the spread of transit over the length of a track.

In chaos, the displacement is a random walk with a drift, so that the relative spread of the transit velocity falls with
the square root of the length. Where regular motions coexist, each part keeps its velocity, and the spread stays.
"""

from statistics import NormalDist

import numpy as np
import pandas as pd

from conveyor import sample_runs
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.machine.operating.parts import population, starts_of_box
from conveyor_pipeline.machine.operating.populations import IDENTICAL, PROBABILITIES
from conveyor_pipeline.machine.operating.random_walk import RANDOM_WALK_STATUS, random_walk, relative_spread
from conveyor_pipeline.machine.operating.regimes import CHAOS, SEVERAL
from conveyor_pipeline.machine.operating.transit import follow, quantiles, spread_of, spread_stderr

# By an effort of 1, with which the standard error of a diffusion coefficient is about 5 %.
AMPLITUDES = 8  # at most, among those at which all initial conditions end in chaos
RUNS = 64  # initial conditions per amplitude
CYCLES = 4096  # excitation cycles of each run
FORGOTTEN = 200  # excitation cycles before the first sample, after which the transient has decayed
RUN_FAILED = "a run failed"
LENGTHS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of tracks, in units of transit.length: shorter and longer than the user's
OF_EACH_REGIME = 3  # amplitudes in the table of track lengths
TABLES = {
    "drift": (
        fields.number("acceleration", "m/s²", "amplitude at which all initial conditions end in chaos"),
        fields.number("velocity", "m/s", "mean feeding velocity"),
        fields.number("velocity_stderr", "m/s", "standard error of velocity, from independent runs"),
        fields.number("velocity_1", "m/s", "mean over the lower half of the initial heights"),
        fields.number("velocity_1_stderr", "m/s", "standard error of velocity_1"),
        fields.number("velocity_2", "m/s", "mean over the upper half of the initial heights"),
        fields.number("velocity_2_stderr", "m/s", "standard error of velocity_2"),
        fields.number("diffusion", "m²/s", "diffusion coefficient: the variance of the displacement grows as 2 D t"),
        fields.number("diffusion_stderr", "m²/s", "standard error of diffusion, from independent runs"),
        fields.count("window", "excitation cycles over which correlations have decayed; 0 for none"),
        fields.text("status", f"{', '.join(RANDOM_WALK_STATUS)} or {RUN_FAILED}"),
    ),
    "track_lengths": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.text("regime", f"{SEVERAL} or {CHAOS}"),
        fields.number("length", "m", "length of the track"),
        fields.number("spread", "1", "relative spread of the transit velocity of identical parts"),
        fields.number("spread_stderr", "1", "standard error of the spread"),
        fields.number("predicted", "1", "relative spread by drift and diffusion; null outside chaos"),
        fields.number("late", "1", "share of the parts that have not arrived after the longest time"),
    ),
}


def amplitudes_in(regime: str, regimes: pd.DataFrame, settings: dict) -> np.ndarray:
    """The amplitudes (m/s²) of the transit table that lie in intervals with a regime, ascending."""
    axis = np.unique(grid.axis_values("acceleration", settings["acceleration"]))
    intervals = regimes[regimes.regime == regime]
    inside = (axis[:, None] >= intervals.begin.to_numpy()) & (axis[:, None] <= intervals.end.to_numpy())
    return axis[inside.any(axis=1)]


def spaced(amplitudes: np.ndarray, count: int) -> np.ndarray:
    """At most `count` of some ascending amplitudes, in the middles of equal parts of the list."""
    count = min(count, len(amplitudes))
    return amplitudes[((np.arange(count) + 0.5) * len(amplitudes) / max(count, 1)).astype(int)]


def positions(rows: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> np.ndarray:
    """Positions x (m) of parts, shape (n, cycles + 1), once per excitation cycle; NaN where a run failed."""
    cycles = FORGOTTEN + np.arange(max(64, round(settings["effort"] * CYCLES)) + 1)
    times = cycles / rows["frequency"][:, None]
    options = {"tolerance": settings["tolerance"], "threads": threads, "chunk": 8, "progress": progress}
    return sample_runs(rows, times, columns=["x"], **options).x


def drift_at(acceleration: float, x: np.ndarray, is_low: np.ndarray, period: float) -> dict:
    """A row of the table of drift.

    x : positions of the runs, shape (n, k); is_low : whether each begins in the lower half of the heights, shape (n,)
    """
    known = np.isfinite(x).all(axis=1)
    row = dict.fromkeys((column.name for column in TABLES["drift"]), np.nan)
    row |= {"acceleration": acceleration, "window": 0, "status": RUN_FAILED}
    if not known.all():
        return row
    displacements = np.diff(x, axis=1)
    whole, *sets = (random_walk(displacements[selected], period) for selected in (known, is_low, ~is_low))
    row |= {"velocity": whole.velocity, "velocity_stderr": whole.velocity_stderr, "status": whole.status}
    row |= {"diffusion": whole.diffusion, "diffusion_stderr": whole.diffusion_stderr, "window": whole.window}
    for number, chaotic in enumerate(sets, start=1):
        row |= {f"velocity_{number}": chaotic.velocity, f"velocity_{number}_stderr": chaotic.velocity_stderr}
    return row


def drift_table(amplitudes: np.ndarray, settings: dict, **options) -> pd.DataFrame:
    """The table of drift for amplitudes in chaos (m/s²), shape (m,)."""
    columns = [column.name for column in TABLES["drift"]]
    if len(amplitudes) == 0:
        return pd.DataFrame(columns=columns)
    runs = {**settings, "starts": max(4, round(settings["effort"] * RUNS))}
    height = starts_of_box(runs)[:, 0]
    is_low = np.argsort(np.argsort(height, kind="stable")) < len(height) // 2
    rows = population(amplitudes, runs, IDENTICAL)
    x = positions(rows, settings, **options).reshape(len(amplitudes), len(height), -1)
    period = 1.0 / settings["model"]["frequency"]
    rows = [drift_at(acceleration, paths, is_low, period) for acceleration, paths in zip(amplitudes, x, strict=True)]
    return pd.DataFrame(rows, columns=columns)


def lengths_table(regimes: pd.DataFrame, drifts: pd.DataFrame, settings: dict, **options) -> pd.DataFrame:
    """The table of track lengths, at a few amplitudes with coexisting motions and a few in chaos."""
    factors = np.array(LENGTHS)
    track = {"lengths": factors * settings["length"], "longest": factors * settings["longest"]}
    deviations = NormalDist().inv_cdf(PROBABILITIES[-1])
    tables = []
    candidates = {SEVERAL: amplitudes_in(SEVERAL, regimes, settings), CHAOS: drifts.acceleration.to_numpy()}
    for regime, amplitudes in candidates.items():
        for acceleration in spaced(amplitudes, OF_EACH_REGIME):
            run = follow(population(np.array([acceleration]), settings, IDENTICAL), settings, **track, **options)
            right = run.status == "ok"
            values, errors = zip(*(quantiles(velocity) for velocity in run.velocity[right].T), strict=True)
            drift = drifts[drifts.acceleration == acceleration]
            predicted = np.full(len(factors), np.nan)
            if regime == CHAOS:
                predicted = relative_spread(*drift[["velocity", "diffusion"]].iloc[0], track["lengths"], deviations)
            tables.append(
                pd.DataFrame(
                    {
                        "acceleration": acceleration,
                        "regime": regime,
                        "length": track["lengths"],
                        "spread": spread_of(np.array(values).T),
                        "spread_stderr": spread_stderr(np.array(values).T, np.array(errors).T),
                        "predicted": predicted,
                        "late": np.isnan(run.arrival[right]).mean(axis=0),
                    }
                )
            )
    columns = [column.name for column in TABLES["track_lengths"]]
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(columns=columns)


def make(regimes: pd.DataFrame, settings: dict, *, threads: int = 1, progress: str | None = None) -> dict:
    """The tables of drift and of track lengths for the settings of the config."""
    options = {"threads": threads, "progress": progress}
    chaotic = spaced(
        amplitudes_in(CHAOS, regimes, settings), max(OF_EACH_REGIME, round(settings["effort"] * AMPLITUDES))
    )
    drifts = drift_table(chaotic, settings, **options)
    return {"drift": drifts, "track_lengths": lengths_table(regimes, drifts, settings, **options)}
