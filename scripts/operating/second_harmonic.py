"""Whether a second harmonic beats the best pure cosine: the fastest drives of both kinds at equal peak accelerations.

Differential evolution (SciPy) searches frequency, angle, phase shift and, for drives of the second kind, share and
phase of a second harmonic in the direction of vibration. The amplitude follows from the peak acceleration. Bounds,
constraints and velocity are those of the drive design.
"""

import itertools
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
from scipy.optimize import OptimizeResult, differential_evolution

from conveyor import UNITS, progress_bar
from operating.drive import (
    CHECK_ERRORS,
    SEARCHED,
    SECOND_HARMONIC,
    constraints,
    evaluate,
    evaluate_few,
    largest,
    last_growth,
)
from pipeline import fields

KINDS = PURE, WITH_HARMONIC = ("pure", "with a second harmonic")
PEAKS = (0.5, 1.0)  # of the largest acceleration of the drive's bounds
SEEDS = (1, 2, 3)  # independent searches, whose spread shows how well they find the fastest drive
SHARES, PHASES = (0.0, 1.0), (-np.pi, np.pi)  # rad; with a larger share, the second harmonic would be the main one
POPULATION = 16  # drives for each searched number, as is usual for differential evolution
GENERATIONS = 60
# The fastest drives of the last generation that are followed with all parts: few parts deceive about the best one.
CONFIRMED = 8
# Relative growth of the velocity in the last quarter of the generations up to which a search has settled.
SETTLED = 0.01
TABLES = {
    "second_harmonic": (
        fields.number("peak_acceleration", "m/s²", "largest acceleration of the plate in the direction of vibration"),
        fields.text("kind", " or ".join(KINDS)),
        fields.count("seed", "seed of the search"),
        *(fields.number(name, UNITS[name], "of the fastest drive") for name in SEARCHED),
        fields.number("harmonic_share", "1", "acceleration of the second harmonic over the fundamental; 0 if pure"),
        fields.number("harmonic_phase", "rad", "phase of the second harmonic; 0 if pure"),
        fields.number("velocity_05", "m/s", "smallest 5 % quantile of the transit velocity within the margin"),
        fields.number("velocity_50", "m/s", "smallest median of the transit velocity within the margin"),
        fields.number("impact_speed", "m/s", "largest 95 % quantile of the impact speed within the margin"),
        fields.flag("within", "whether the drive keeps the constraints, followed with all parts"),
        fields.number("growth", "1", "relative growth of the velocity in the last quarter of the generations"),
        fields.flag("settled", f"whether this is at most {SETTLED}"),
    )
}


def bounds_of(kind: str, bounds: dict) -> list[tuple[float, float]]:
    """Bounds of the searched numbers."""
    return [bounds[name] for name in SEARCHED[1:]] + ([SHARES, PHASES] if kind == WITH_HARMONIC else [])


def designs_at(peak: float, points: np.ndarray) -> np.ndarray:
    """Designs with a peak acceleration in m/s², shape (k, 4) or (k, 6), from points, shape (k, 3) or (k, 5)."""
    designs = np.column_stack([np.ones(len(points)), points])
    designs[:, 0] = peak / largest(designs, 1.0)
    return designs


def costs(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """What the search minimises, shape (k,): minus the velocity (m/s) of a drive within the constraints.

    Any other drive has the sum of its relative violations, which is positive.
    """
    violations = constraints(outcome, settings).clip(min=0.0).sum(axis=1)
    return np.where(violations > 0.0, violations, -outcome.velocity.to_numpy(dtype=float))


def fastest(peak: float, kind: str, seed: int, settings: dict, count: Callable[[], object]) -> dict:
    """A row of the table: the fastest drive of one search.

    count : called after each generation
    """
    bounds = np.array(bounds_of(kind, settings["bounds"]))
    velocities = []  # the largest one up to each generation
    rng = np.random.default_rng(seed)

    def evaluate_points(points: np.ndarray) -> np.ndarray:
        return costs(evaluate_few(designs_at(peak, points.T), settings), settings)

    def after_generation(intermediate_result: OptimizeResult) -> None:
        velocities.append(max(0.0, -intermediate_result.fun))
        count()

    result = differential_evolution(
        evaluate_points,
        bounds,
        init=rng.uniform(*bounds.T, (POPULATION * len(bounds), len(bounds))),
        rng=rng,
        maxiter=GENERATIONS,
        tol=0.0,
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=after_generation,
    )
    designs = designs_at(peak, result.population[np.argsort(result.population_energies, kind="stable")[:CONFIRMED]])
    outcome = evaluate(designs, settings, CHECK_ERRORS)
    cost = costs(outcome, settings)
    best = int(cost.argmin())
    growth = last_growth(velocities)
    return {
        "peak_acceleration": peak,
        "kind": kind,
        "seed": seed,
        **dict.fromkeys(SECOND_HARMONIC, 0.0),
        **dict(zip(SEARCHED + SECOND_HARMONIC, designs[best].tolist(), strict=False)),
        "velocity_05": outcome.velocity[best],
        "velocity_50": outcome.velocity_50[best],
        "impact_speed": outcome.impact_speed[best],
        "within": cost[best] < 0.0,
        "growth": growth,
        "settled": growth <= SETTLED,
    }


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> pd.DataFrame:
    """The table for the settings of the drive design."""
    peaks = [share * settings["bounds"]["acceleration"][1] for share in PEAKS]
    searches = list(itertools.product(peaks, KINDS, SEEDS))
    total = GENERATIONS * len(searches)
    # One thread for each search: the drives of one generation are too few for several threads.
    with progress_bar(total=total, label=progress, unit="generations") as shown, ThreadPoolExecutor(threads) as pool:
        rows = pool.map(lambda search: fastest(*search, settings, shown.update), searches)
        return pd.DataFrame(list(rows))
