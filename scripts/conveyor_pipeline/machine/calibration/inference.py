"""The posterior of the parameters, given measured velocities.

A velocity counts with its density under the velocities of parts with random initial conditions (see `likelihood`), so
that several coexisting velocities, and chaos, are information instead of noise.
"""

import math
from typing import NamedTuple

import numpy as np
from tqdm import tqdm

from conveyor import UNITS
from conveyor.elementary import exp, log
from conveyor.progress import progress_bar
from conveyor_pipeline.machine.calibration.credible_intervals import open_ends, quantiles, summarize, with_errors
from conveyor_pipeline.machine.calibration.effort import EFFECTIVE, MOST_SEARCHES, SEARCHES
from conveyor_pipeline.machine.calibration.importance_sampling import Sample, monte_carlo_error, pooled, sample
from conveyor_pipeline.machine.calibration.likelihood import (
    Conditions,
    conditions_of,
    deviations,
    is_known,
    log_densities,
    velocities,
    widths,
)
from conveyor_pipeline.machine.calibration.measurements import Measurement
from conveyor_pipeline.machine.calibration.search_space import LOGARITHMIC, bounds_of, values_at

DETERMINED, OPEN, NOT_DETERMINED = "determined", "open to one side", "not determined"
NOT_CONVERGED = "not converged"
# Searches agree, and no further one follows, unless the Monte Carlo error of a best value, or of an end of an interval,
# is more than this share of the interval.
REPEATABLE = 0.25
# A set of parameters gets no further parts if even the first ones are this far below the best logarithmic likelihood.
HOPELESS = 30.0
# The search first takes measurements for less accurate than they are, so that it finds its way from far away.
INFLATIONS = (1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0)
# The first step of a search: place of its least inflation, most cycles before a measurement and during it, and the
# effective number of points at which it ends.
ROUGH, CYCLES, ENOUGH_ROUGH = 2, 20.0, 20.0
USUAL_ROUNDS = (15, 4)  # of the two steps of a search, after the first round of each
NUMBERS = ("best", "best_error", "low", "low_error", "high", "high_error")
WIDE = 0.8  # of the searched range: a wider interval determines nothing


Near = tuple[np.ndarray, np.ndarray] | None  # points of a related posterior and their weights, see `sample`


class Data(NamedTuple):
    """Measurements as arrays."""

    measured: list[Measurement]
    conditions: Conditions
    condition_of: np.ndarray  # number of the condition of each measurement, shape (r,)
    velocity: np.ndarray  # m/s, shape (r,)
    sd: np.ndarray  # m/s, shape (r,), NaN where none is given
    plate: np.ndarray  # largest velocity of the plate, m/s, shape (r,)


def data_of(measured: list[Measurement], model: dict) -> Data:
    """The measurements and their conditions."""
    conditions, condition_of = conditions_of(measured, model)
    velocity = np.array([row.velocity for row in measured])
    sd = np.array([math.nan if row.sd is None else row.sd for row in measured])
    return Data(measured, conditions, condition_of, velocity, sd, conditions.plate[condition_of])


def log_factors(simulated: np.ndarray, data: Data, settings: dict, inflations: tuple[float, ...]) -> np.ndarray:
    """Logarithm of the density of each measurement for each inflation of its standard deviation, shape (m, n, r).

    simulated : velocities under each condition, shape (n, k, parts)
    """
    spread = widths(simulated)[:, data.condition_of]
    arguments = (data.velocity, simulated[:, data.condition_of], data.sd, data.plate, settings["noise"], spread)
    return np.array([log_densities(*arguments, inflation) for inflation in inflations])


def runs_of_search(data: Data, settings: dict) -> int:
    """The usual number of runs of one search (see `search_once`)."""
    rough, fine = np.minimum(USUAL_ROUNDS, (settings["rough_rounds"], settings["rounds"])) * settings["points"]
    runs = (settings["first"] + rough) * settings["rough_parts"] + (settings["points"] + fine) * settings["parts"]
    return int(runs) * len(data.conditions.rows)


def shortened(conditions: Conditions) -> Conditions:
    """The same conditions, but with at most CYCLES cycles before the measurement, and as many during it."""
    longest = CYCLES / conditions.rows["frequency"]
    begin, end = conditions.times.T
    before = np.minimum(begin, longest)
    return conditions._replace(times=np.column_stack([before, before + np.minimum(end - begin, longest)]))


def search_once(data: Data, settings: dict, number: int, near: Near, threads: int, bar: tqdm) -> Sample:
    """The sample of one search; its number makes its random numbers differ from those of the others.

    A posterior may fill a millionth of the bounds, so that most rounds only find the way to it. The first step follows
    few parts for a short time, and takes measurements for less accurate than they are. The second step begins with
    what it has found, and follows all parts for the whole time. The posterior comes from the second step alone.
    """
    sd = deviations(data.velocity, data.sd, data.plate, settings["noise"])

    def step(fine: bool, near: Near, first: int, enough: float) -> Sample:
        conditions, parts = data.conditions, settings["parts"]
        inflations = INFLATIONS
        if not fine:
            conditions, parts, inflations = shortened(conditions), settings["rough_parts"], INFLATIONS[ROUGH:]
        best, rounds = -math.inf, 0

        def worth(first_velocities: np.ndarray) -> np.ndarray:
            nonlocal best
            log_likelihood = log_factors(first_velocities, data, settings, inflations[:1])[0].sum(axis=1)
            best = max(best, log_likelihood.max())
            known = is_known(first_velocities, data.velocity, data.condition_of, inflations[0] * sd)
            return (log_likelihood > best - HOPELESS)[:, None] & ~known

        def follow(points: np.ndarray) -> np.ndarray:
            nonlocal rounds
            options = {"parts": parts, "seed": [settings["seed"], number, fine, rounds], "threads": threads}
            simulated = velocities(values_at(points, settings), conditions, settings, **options, worth=worth)
            rounds += 1
            bar.total = max(bar.total, bar.n + simulated.size)
            bar.update(simulated.size)
            return log_factors(simulated, data, settings, inflations)

        most_rounds = settings["rounds" if fine else "rough_rounds"]
        sizes = {"first": first, "points": settings["points"], "rounds": most_rounds, "enough": enough}
        return sample(follow, bounds_of(settings), **sizes, seed=[settings["seed"], number, fine], near=near)

    begun = bar.n
    rough = step(False, near, settings["first"], ENOUGH_ROUGH)
    posterior = step(True, (rough.points, rough.weights), settings["points"], settings["enough"])
    bar.total = max(bar.n, bar.total + (bar.n - begun) - runs_of_search(data, settings))
    return posterior


def search(
    data: Data,
    settings: dict,
    *,
    near: Near = None,
    searches: tuple[int, int] = (SEARCHES, MOST_SEARCHES),
    threads: int = 1,
    bar: tqdm | None = None,
) -> Sample:
    """A weighted sample of the posterior from independent searches, until they agree.

    near : points of a related posterior, in the coordinates of the search space, shape (n, d), and their weights
    searches : their number at first, which share the effective samples that are wanted, and at most
    bar : progress over the usual number of runs of all searches
    """
    first, limit = searches
    bar = progress_bar(total=first * runs_of_search(data, settings), label=None) if bar is None else bar
    settings_of_search = settings | {"enough": settings["enough"] / first}
    samples = []
    while len(samples) < limit:
        if len(samples) >= first:
            bar.total += runs_of_search(data, settings)
        samples.append(search_once(data, settings_of_search, len(samples), near, threads, bar))
        posterior = pooled(samples)
        if first <= len(samples) < limit and agree(posterior, settings):
            break
    return posterior


def draw(posterior: Sample, count: int) -> np.ndarray:
    """Places of `count` samples in proportion to their weights, evenly spaced in the sum of the weights."""
    places = np.searchsorted(np.cumsum(posterior.weights), (0.5 + np.arange(count)) / count)
    return np.minimum(places, len(posterior.weights) - 1)


def centre(points: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Median of each coordinate of a weighted sample, shape (d,); a repetition with another seed hardly moves it."""
    return np.array([quantiles(column, weights, [0.5])[0] for column in points.T])


def summary_of(posterior: Sample, weights: np.ndarray, settings: dict) -> np.ndarray:
    """Best value and ends of the interval of each parameter, or their logarithms (LOGARITHMIC), shape (d, 3).

    The best values belong to the medians of the coordinates.

    weights : of the points, shape (n,), with the sum 1
    """

    def columns(points: np.ndarray) -> list[np.ndarray]:
        return [log(column) if name in LOGARITHMIC else column for name, column in values_at(points, settings).items()]

    summary = summarize(columns(posterior.points), weights)
    summary[:, 0] = np.concatenate(columns(centre(posterior.points, weights)[None]))
    return summary


def errors(posterior: Sample, settings: dict) -> np.ndarray:
    """Monte Carlo errors of what `summary_of` gives, shape (d, 3)."""
    return monte_carlo_error(
        posterior.weights, posterior.search, lambda weights: summary_of(posterior, weights, settings)
    )


def agree(posterior: Sample, settings: dict) -> bool:
    """Whether another set of searches would give nearly the same best values and intervals."""
    summary = summary_of(posterior, posterior.weights, settings)
    return bool(np.all(errors(posterior, settings) <= REPEATABLE * (summary[:, 2] - summary[:, 1])[:, None]))


def has_converged(posterior: Sample, settings: dict) -> bool:
    """Whether there are enough effective samples, and the searches agree."""
    return posterior.size >= EFFECTIVE and agree(posterior, settings)


def summarize_parameters(posterior: Sample, settings: dict) -> list[dict]:
    """The rows of the table of parameters; a search that has not converged has no numbers."""
    searches = {"effective": posterior.size, "searches": int(posterior.search.max()) + 1}
    if not has_converged(posterior, settings):
        nothing = dict.fromkeys((*NUMBERS, "range_low", "range_high"), math.nan) | {"status": NOT_CONVERGED}
        return [{"parameter": name, "unit": UNITS[name], **nothing, **searches} for name in settings["ranges"]]
    bounds = bounds_of(settings)
    middle = centre(posterior.points, posterior.weights)
    summary = summary_of(posterior, posterior.weights, settings)
    deviation = errors(posterior, settings)
    rows = []
    for column, name in enumerate(settings["ranges"]):
        is_log = name in LOGARITHMIC
        ends = np.tile(middle, (2, 1))
        ends[:, column] = bounds[:, column]
        range_low, range_high = values_at(ends, settings)[name]
        best, low, high = summary[column]
        open_low, open_high = open_ends(posterior.points[:, column], posterior.weights, bounds[:, column])
        searched = math.log(range_high / range_low) if is_log else range_high - range_low
        is_wide = high - low > WIDE * searched
        status = (
            NOT_DETERMINED if is_wide or (open_low and open_high) else OPEN if open_low or open_high else DETERMINED
        )
        if is_log:
            best, low, high = exp(summary[column])
        # An open end is the bound, beyond which smoothing may reach. The bounds of the damping belong to the best
        # stiffness only, so that its interval may be longer.
        low = min(low, range_low) if open_low else low
        high = max(high, range_high) if open_high else high
        if name != "damping":
            low, high = max(low, range_low), min(high, range_high)
        low, high = min(low, best), max(high, best)
        numbers = with_errors(np.array([best, low, high]), deviation[column], is_log)
        rows.append(
            {
                "parameter": name,
                "unit": UNITS[name],
                **numbers,
                "range_low": range_low,
                "range_high": range_high,
                "status": status,
                **searches,
            }
        )
    return rows
