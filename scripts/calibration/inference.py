"""The posterior of the parameters, given measured velocities, and whether the model explains the measurements.

A velocity counts with its density under the velocities of parts with random initial conditions (see `predicted`), so
that several coexisting velocities, and chaos, are information instead of noise.

The test of the model does not use these parts again, because the search has favoured parameters whose parts happened to
agree with the measurements. For parameters from the posterior, new parts are followed. One half of them gives the
density, the other half replicates of the measurements. The p-value is the share of replicates that fit worse than the
measurements, averaged over the posterior (Gelman, Meng and Stern 1996). Two statistics are compared, because each is
blind where the other one sees: the shares of the single measurements (Fisher's sum), and how far the measurements at
one amplitude lie on one side of what is predicted there. The smaller p-value counts, times two (Bonferroni).
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr
from scipy.stats import rankdata

from calibration.measurements import CALIBRATED, Measurement, parse
from calibration.predicted import Conditions, conditions_of, deviations, log_densities, velocities, widths
from calibration.sampler import sample
from calibration.search_space import LOGARITHMIC, bounds_of, values_at
from conveyor.parameters import RANGES, UNITS
from pipeline import fields
from pipeline.importance_sampling import Sample

DETERMINED, OPEN, NOT_DETERMINED = "determined", "open to one side", "not determined"
TOO_FEW = "too few effective samples"
TABLES = {
    "parameters": (
        fields.text("parameter", "parameter of the model"),
        fields.text("unit", "its unit"),
        fields.number("best", "SI", "value at the mode of the posterior"),
        fields.number("low", "SI", "lower end of the 95 % interval; null if the sample is too small for intervals"),
        fields.number("high", "SI", "upper end of the 95 % interval; null if the sample is too small for intervals"),
        fields.number("range_low", "SI", "lower end of the searched range"),
        fields.number("range_high", "SI", "upper end of the searched range"),
        fields.text("status", f"{DETERMINED}, {OPEN}, {NOT_DETERMINED}, or {TOO_FEW}"),
        fields.number("effective", "1", "effective number of samples of the posterior"),
    ),
    "samples": (
        *(fields.number(name, UNITS[name], "value in this sample of the posterior") for name in CALIBRATED),
        fields.number("log_likelihood", "1", "logarithm of the likelihood"),
    ),
    "fit": (
        fields.count("line", "line of the file of measurements"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("velocity", "m/s", "measured velocity"),
        fields.number("sd", "m/s", "standard deviation of the measurement"),
        fields.number("low", "m/s", "5 % quantile of what the best parameters give, noise included"),
        fields.number("median", "m/s", "median of what the best parameters give"),
        fields.number("high", "m/s", "95 % quantile of what the best parameters give, noise included"),
        fields.number("p_row", "1", "share of replicates of this measurement that fit worse, for the best parameters"),
        fields.flag("fits", "whether this share is not small"),
        fields.number(
            "p_value",
            "1",
            "share of replicates of all measurements that fit worse, mean over the posterior; equal in all rows",
        ),
        fields.flag("explained", "whether the model explains the measurements; equal in all rows"),
    ),
}
# A set of parameters gets no further parts if even the first ones are this far below the best logarithmic likelihood.
HOPELESS = 30.0
# The search first takes measurements for less accurate than they are, so that it finds its way from far away.
INFLATIONS = (1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0)
OPEN_DENSITY = 0.2  # of the largest density of a parameter: an end of the range with more is open
UNLIKELY = 0.01  # share of replicates below which a single measurement does not fit
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


def log_factors(found: np.ndarray, data: Data, settings: dict, inflations: tuple[float, ...]) -> np.ndarray:
    """Logarithm of the density of each measurement for each inflation of its standard deviation, shape (m, n, r).

    found : velocities under each condition, shape (n, k, parts)
    """
    spread = widths(found)[:, data.of]
    arguments = (data.velocity, found[:, data.of], data.sd, data.plate, settings, spread)
    return np.array([log_densities(*arguments, inflation) for inflation in inflations])


def search(data: Data, settings: dict, *, threads: int = 1, progress: str | None = None) -> Sample:
    """A weighted sample of the posterior."""
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
    return sample(follow, bounds_of(settings), **options)


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


def smoothed_interval(values: np.ndarray, found: Sample, confidence: float) -> tuple[float, float]:
    """The central interval of a parameter, shape (n,), after smoothing by Silverman's rule.

    Smoothing makes intervals a little wider, and less dependent on the few samples at their ends.
    """
    width = smoothing(values, found)
    grid = np.linspace(values.min() - 4.0 * width, values.max() + 4.0 * width, 2000)
    below = ndtr((grid[:, None] - values) / width) @ found.weights
    low, high = np.interp([0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence], below, grid)
    return float(low), float(high)


def smoothing(values: np.ndarray, found: Sample) -> float:
    """Silverman's width for a weighted sample."""
    mean = found.weights @ values
    deviation = math.sqrt(found.weights @ (values - mean) ** 2)
    return max(1.06 * deviation * found.size**-0.2, 1e-9 * max(abs(mean), 1.0))


def open_ends(values: np.ndarray, found: Sample, bounds: tuple[float, float]) -> tuple[bool, bool]:
    """Whether the density of a searched coordinate, shape (n,), is not small at the lower and at the upper bound."""
    width = smoothing(values, found)
    grid = np.linspace(*bounds, 200)
    density = np.exp(-0.5 * ((grid[:, None] - values) / width) ** 2) @ found.weights
    # At a bound, half of the smoothed density lies beyond it.
    return tuple(bool(2.0 * density[end] > OPEN_DENSITY * density.max()) for end in (0, -1))


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
        low, high = smoothed_interval(own, found, settings["confidence"])
        open_low, open_high = open_ends(found.points[:, column], found, bounds[:, column])
        searched_low, searched_high = np.log([range_low, range_high]) if is_log else (range_low, range_high)
        is_wide = high - low > WIDE * (searched_high - searched_low)
        status = (
            NOT_DETERMINED if is_wide or (open_low and open_high) else OPEN if open_low or open_high else DETERMINED
        )
        if is_log:
            low, high = math.exp(low), math.exp(high)
        # Smoothing may reach beyond a bound. The bounds of the damping belong to the best stiffness only.
        low = min(low, range_low) if open_low else low if name == "damping" else max(low, range_low)
        high = max(high, range_high) if open_high else high if name == "damping" else min(high, range_high)
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


def replicates(parts: np.ndarray, data: Data, settings: dict, count: int, random: np.random.Generator) -> np.ndarray:
    """Replicates of the measurements (m/s), shape (count, r), from velocities of parts, shape (r, parts)."""
    rows = np.arange(len(parts))
    true = parts[rows, random.integers(parts.shape[1], size=(count, len(parts)))]
    noise = random.standard_normal(true.shape)
    return true + noise * deviations(true, data.sd, data.plate, settings["noise"])


def tail_shares(values: np.ndarray) -> np.ndarray:
    """Share of all rows whose value is at most as large, for each row and each column, shape as `values`, (m, n)."""
    return rankdata(values, method="max", axis=0) / len(values)


def one_sidedness(
    measured: np.ndarray, parts: np.ndarray, data: Data, settings: dict, random: np.random.Generator
) -> np.ndarray:
    """How far measurements under one condition lie on one side of the predicted velocities, shape (m,).

    For a right model, the share of predicted velocities below a measurement is uniform between 0 and 1 (probability
    integral transform). The sum of squares of its means under the conditions, in units of their standard deviations, is
    small if no condition has all measurements on one side.

    measured : m/s, shape (m, r)
    parts : velocities of parts under each condition, shape (k, parts)
    """
    predicted = np.sort(replicates(parts[data.of], data, settings, settings["replicates"], random), axis=0)
    below = np.column_stack([np.searchsorted(*columns) for columns in zip(predicted.T, measured.T, strict=True)]) / len(
        predicted
    )
    belongs = data.of[:, None] == np.arange(len(parts))
    return ((below - 0.5) @ belongs) ** 2 @ (12.0 / belongs.sum(axis=0))


def compare(
    parts: np.ndarray, data: Data, settings: dict, random: np.random.Generator
) -> tuple[float, np.ndarray, np.ndarray]:
    """p-value, shares of the single measurements, shape (r,), and replicates, for velocities of parts, shape (k, n)."""
    scored, other = np.split(np.where(np.isnan(parts), 0.0, parts), 2, axis=1)
    drawn = replicates(other[data.of], data, settings, settings["replicates"], random)
    measured = np.vstack([data.velocity, drawn])
    spread = widths(scored)
    densities = [
        log_densities(column[:, None], scored[[of]], sd, plate, settings, spread[[of]])[:, 0]
        for column, of, sd, plate in zip(measured.T, data.of, data.sd[:, None], data.plate[:, None], strict=True)
    ]
    shares = tail_shares(np.column_stack(densities))
    sided = one_sidedness(measured, scored, data, settings, random)
    of_all = tail_shares(np.column_stack([np.log(shares).sum(axis=1), -sided]))[0]
    return min(1.0, len(of_all) * of_all.min()), shares[0], drawn


def check_fit(found: Sample, data: Data, settings: dict, *, threads: int = 1, progress: str | None = None) -> dict:
    """The columns of the table of the fit."""
    places = np.concatenate([[mode(found)], draw(found, settings["checked"])])
    values = {name: column[places] for name, column in values_at(found.points, settings).items()}
    options = {"parts": 2 * settings["checked_parts"], "seed": settings["seed"] + settings["rounds"] + 1}
    progress = progress and f"{progress}: check"
    followed = velocities(values, data.conditions, settings, **options, threads=threads, progress=progress)
    random = np.random.default_rng(settings["seed"])
    p_values, p_rows, drawn = zip(*(compare(parts, data, settings, random) for parts in followed), strict=True)
    p_value, p_row = np.mean(p_values), p_rows[0]
    low, middle, high = np.quantile(drawn[0], [0.05, 0.5, 0.95], axis=0)
    rows = len(data.velocity)
    return {
        "line": [one.line for one in data.measured],
        "acceleration": [one.acceleration for one in data.measured],
        "velocity": data.velocity,
        "sd": deviations(data.velocity, data.sd, data.plate, settings["noise"]),
        "low": low,
        "median": middle,
        "high": high,
        "p_row": p_row,
        "fits": p_row >= UNLIKELY,
        "p_value": np.full(rows, p_value),
        "explained": np.full(rows, p_value >= settings["significance"]),
    }


def calibrate(
    measured: list[Measurement], settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, dict]:
    """The columns of the tables of parameters, of samples and of the fit, from measurements."""
    data = data_of(measured, settings["model"])
    found = search(data, settings, threads=threads, progress=progress)
    chosen = draw(found, settings["samples"])
    values = values_at(found.points[chosen], settings)
    others = {name: np.full(len(chosen), value) for name, value in settings["model"].items() if name in CALIBRATED}
    return {
        "parameters": fields.columns(summarize_parameters(found, settings), TABLES["parameters"]),
        "samples": {**others, **values, "log_likelihood": found.log_density[chosen]},
        "fit": check_fit(found, data, settings, threads=threads, progress=progress),
    }


def make(measurements: str, settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, dict]:
    """The tables from the text of the file of measurements."""
    measured = parse(measurements, settings["measurements"], settings, RANGES)
    return calibrate(measured, settings, threads=threads, progress=progress)
