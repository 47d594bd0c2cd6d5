"""The posterior of the parameters, given measured velocities.

A velocity counts with its density under the velocities of parts with random initial conditions (see `predicted`), so
that several coexisting velocities, and chaos, are information instead of noise.
"""

import math
from typing import NamedTuple

import numpy as np

from calibration.measurements import Measurement
from calibration.predicted import Conditions, conditions_of, log_densities, velocities, widths
from calibration.search_space import LOGARITHMIC, bounds_of, values_at
from conveyor import UNITS
from pipeline.credible_intervals import interval, open_ends
from pipeline.importance_sampling import Sample, sample

DETERMINED, OPEN, NOT_DETERMINED = "determined", "open to one side", "not determined"
TOO_FEW = "too few effective samples"
# A set of parameters gets no further parts if even the first ones are this far below the best logarithmic likelihood.
HOPELESS = 30.0
# The search first takes measurements for less accurate than they are, so that it finds its way from far away.
INFLATIONS = (1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0)
WIDE = 0.8  # of the searched range: a wider interval determines nothing


class Data(NamedTuple):
    """Measurements as arrays."""

    measured: list[Measurement]
    conditions: Conditions
    of: np.ndarray  # number of the condition of each measurement, shape (r,)
    velocity: np.ndarray  # m/s, shape (r,)
    sd: np.ndarray  # m/s, shape (r,), NaN where none is given
    plate: np.ndarray  # largest velocity of the plate, m/s, shape (r,)


def data_of(measured: list[Measurement], model: dict) -> Data:
    """The measurements and their conditions."""
    conditions, of = conditions_of(measured, model)
    velocity = np.array([one.velocity for one in measured])
    sd = np.array([math.nan if one.sd is None else one.sd for one in measured])
    return Data(measured, conditions, of, velocity, sd, conditions.plate[of])


def samples_of_interval(confidence: float) -> float:
    """The effective number of samples of which one lies outside an interval with this confidence."""
    return 1.0 / (1.0 - confidence)


def log_factors(found: np.ndarray, data: Data, settings: dict, inflations: tuple[float, ...]) -> np.ndarray:
    """Logarithm of the density of each measurement for each inflation of its standard deviation, shape (m, n, r).

    found : velocities under each condition, shape (n, k, parts)
    """
    spread = widths(found)[:, data.of]
    arguments = (data.velocity, found[:, data.of], data.sd, data.plate, settings, spread)
    return np.array([log_densities(*arguments, inflation) for inflation in inflations])


def search(
    data: Data, settings: dict, *, near: np.ndarray | None = None, threads: int = 1, progress: str | None = None
) -> Sample:
    """A weighted sample of the posterior.

    near : points of a related posterior, in the coordinates of the search space, shape (n, d)
    """
    best, rounds = -math.inf, 0

    def worth(few: np.ndarray) -> np.ndarray:
        nonlocal best
        found = log_factors(few, data, settings, INFLATIONS[:1])[0].sum(axis=1)
        best = max(best, found.max())
        return found > best - HOPELESS

    def follow(points: np.ndarray) -> np.ndarray:
        nonlocal rounds
        options = {"parts": settings["parts"], "seed": settings["seed"] + rounds, "threads": threads, "worth": worth}
        label = progress and f"{progress}: round {rounds} of at most {settings['rounds']}"
        found = velocities(values_at(points, settings), data.conditions, settings, **options, progress=label)
        rounds += 1
        return log_factors(found, data, settings, INFLATIONS)

    options = {name: settings[name] for name in ("first", "points", "rounds", "seed", "enough")}
    return sample(follow, bounds_of(settings), **options, near=near)


def draw(found: Sample, count: int) -> np.ndarray:
    """Places of `count` samples in proportion to their weights, evenly spaced in the sum of the weights."""
    places = np.searchsorted(np.cumsum(found.weights), (0.5 + np.arange(count)) / count)
    return np.minimum(places, len(found.weights) - 1)


def mode(found: Sample) -> int:
    """The place of the sample with the largest smoothed density, which the noise of likelihoods hardly affects."""
    weights, points = found.weights, found.points
    heavy = np.flatnonzero(weights > 1e-4 * weights.max())
    points, weights = points[heavy], weights[heavy] / weights[heavy].sum()
    centred = points - weights @ points
    covariance = (weights[:, None] * centred).T @ centred + 1e-12 * np.eye(points.shape[1])
    whitened = np.linalg.solve(np.linalg.cholesky(covariance), points.T).T
    width = found.size ** (-1.0 / (points.shape[1] + 4.0))
    apart = np.sum((whitened[:, None] - whitened) ** 2, axis=-1)
    return int(heavy[(np.exp(-0.5 * apart / width**2) @ weights).argmax()])


def summarize_parameters(found: Sample, settings: dict) -> list[dict]:
    """The rows of the table of parameters."""
    bounds, best = bounds_of(settings), mode(found)
    values, rows = values_at(found.points, settings), []
    reliable = found.size >= settings["effective"]
    for column, name in enumerate(settings["parameters"]):
        is_log = name in LOGARITHMIC
        ends = np.tile(found.points[best], (2, 1))
        ends[:, column] = bounds[:, column]
        range_low, range_high = values_at(ends, settings)[name]
        own = np.log(values[name]) if is_log else values[name]
        low, high = interval(own, found.weights, settings["confidence"])
        open_low, open_high = open_ends(found.points[:, column], found.weights, bounds[:, column])
        searched_low, searched_high = np.log([range_low, range_high]) if is_log else (range_low, range_high)
        is_wide = high - low > WIDE * (searched_high - searched_low)
        status = (
            NOT_DETERMINED if is_wide or (open_low and open_high) else OPEN if open_low or open_high else DETERMINED
        )
        if is_log:
            low, high = math.exp(low), math.exp(high)
        # An open end is the bound, beyond which smoothing may reach. The bounds of the damping belong to the best
        # stiffness only, so that its interval may be longer.
        low = min(low, range_low) if open_low else low
        high = max(high, range_high) if open_high else high
        if name != "damping":
            low, high = max(low, range_low), min(high, range_high)
        rows.append(
            {
                "parameter": name,
                "unit": UNITS[name],
                "best": values[name][best],
                "low": min(low, values[name][best]) if reliable else math.nan,
                "high": max(high, values[name][best]) if reliable else math.nan,
                "range_low": range_low,
                "range_high": range_high,
                "status": status if reliable else TOO_FEW,
                "effective": found.size,
            }
        )
    return rows
