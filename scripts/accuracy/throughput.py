"""Starts that one thread follows in a second: by the solver, by the paper's method, and by peers.

All follow the same starts for the same time, the methods in turns; what has to be compiled is compiled before. The
solver and the paper's method take all starts in one call, as sweeps do; peers take one after the other, heyoka in
batches as well.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from accuracy.precision import EXACT, TRUTH
from accuracy.timing import in_turns
from conveyor import ensemble
from conveyor.methods import heyoka_batch, heyoka_peer, peers
from pipeline import fields, grid

TABLES = {
    "throughput": (
        fields.text("method", "event, euler, or a peer"),
        fields.text("treatment", "of impacts and slip reversals: exact, fixed step, or modes; in batches or not"),
        fields.number("tolerance", "1", "relative tolerance; null for fixed steps"),
        fields.number("step", "s", "step; null for tolerances"),
        fields.count("starts", "that are followed, on one thread"),
        fields.number("seconds", "s", "median processor time of all of them"),
        fields.count("repeats", "timed turns"),
        fields.number("velocity_error", "1", "median of the relative errors of the mean feeding velocity"),
        fields.count("failed", "starts that are given up"),
        fields.text("outcome", "ok, or why nothing was followed"),
    ),
}


class Way(NamedTuple):
    """How starts are followed: a row of the table."""

    method: str
    treatment: str
    tolerance: float  # NaN for a fixed step
    step: float  # s, NaN for a tolerance
    # Of the parameters of starts, shape (n, 13), their mean velocities (m/s) over the last quarter, shape (n,), NaN
    # where a start is given up.
    follow: Callable[[np.ndarray], np.ndarray]


def together(rows: np.ndarray, **options) -> np.ndarray:
    found = ensemble.run(rows, threads=1, **options)
    return np.where(found["status"] == "ok", found["mean_velocity"], np.nan)


def one_by_one(rows: np.ndarray, name: str, duration: float, tolerance: float, limit: int) -> np.ndarray:
    return np.array([peers.run(row, duration, name, "modes", tolerance, limit).mean_velocity for row in rows])


def ways(settings: dict) -> list[Way]:
    """All rows of the table, in their order."""
    duration, limit, tolerance, step = (settings[name] for name in ("duration", "max_evaluations", "tolerance", "step"))
    lanes = settings["batch"]
    exact = partial(together, duration=duration, tolerance=tolerance)
    fixed = partial(together, duration=duration, method="euler", step=step)
    return [
        Way("event", EXACT, tolerance, np.nan, exact),
        Way("euler", "fixed step", np.nan, step, fixed),
        *(
            Way(
                name,
                "modes",
                wanted,
                np.nan,
                partial(one_by_one, name=name, limit=limit, duration=duration, tolerance=wanted),
            )
            for name, wanted in settings["peers"].items()
        ),
        *(
            Way(
                peers.HEYOKA,
                f"modes, in batches of {lanes}",
                wanted,
                np.nan,
                partial(heyoka_batch.mean_velocities, duration=duration, tolerance=wanted, lanes=lanes, limit=limit),
            )
            for name, wanted in settings["peers"].items()
            if name == peers.HEYOKA
        ),
    ]


def error_of(found: np.ndarray, truth: np.ndarray) -> float:
    """Median relative error where there is a velocity; NaN where there is none."""
    errors = np.abs(found / truth - 1.0)
    return float(np.median(errors[~np.isnan(errors)])) if (~np.isnan(errors)).any() else np.nan


def make(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table.

    Parameters
    ----------
    settings : the section of the config with the `duration` (s) of all runs, and the `tolerance` and the `step` (s) of
        the solver and of the paper's method, the `peers` with their tolerances and the `batch` of heyoka, and the `map`
        of initial conditions, with its `axes` and its `model`
    """
    _, rows = grid.product(settings["map"]["axes"], settings["map"]["model"])
    listed = ways(settings)
    truth = together(rows, duration=settings["duration"], tolerance=TRUTH)
    there = [way.method != peers.HEYOKA or heyoka_peer.installed() for way in listed]
    follow = [
        way.follow if is_there else lambda some: np.full(len(some), np.nan)
        for way, is_there in zip(listed, there, strict=True)
    ]
    for one in follow:
        one(rows[:2])  # a single one is followed by other code than several
    velocities, times = in_turns(
        [partial(one, rows) for one in follow],
        repeats=settings["repeats"],
        seconds=settings["seconds"],
        progress=progress,
    )
    return {
        **{
            name: np.array([getattr(way, name) for way in listed])
            for name in ("method", "treatment", "tolerance", "step")
        },
        "starts": np.full(len(listed), len(rows)),
        "seconds": np.where(there, [np.median(spent) for spent in times], np.nan),
        "repeats": np.where(there, [len(spent) for spent in times], 0),
        "velocity_error": np.array([error_of(found, truth) for found in velocities]),
        "failed": np.array([np.count_nonzero(np.isnan(found)) for found in velocities]),
        "outcome": np.array([peers.OK if is_there else peers.NOT_INSTALLED for is_there in there]),
    }
