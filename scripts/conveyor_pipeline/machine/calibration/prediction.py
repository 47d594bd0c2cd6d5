"""Velocities that the calibrated model predicts, and the amplitude at which one more velocity would help most.

The velocity of one part at an amplitude is uncertain for two reasons: its initial condition, and the parameters.
Samples of the posterior, each with several random initial conditions, contain both. The velocities at the two
neighbouring amplitudes of the table count as well, so that a line between two rows of the table does not miss a motion
that begins or ends there.

A velocity at another amplitude gives the samples new weights. Velocities of the samples themselves, with noise, serve
as possible results of this measurement. The expected narrowing of an interval follows from the mean of the parameter's
standard deviation after such a result, relative to the one before.
"""

import math

import numpy as np
import pandas as pd

from conveyor.elementary import exp, log
from conveyor.linear_algebra import product
from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.calibration.effort import sizes_of
from conveyor_pipeline.machine.calibration.likelihood import conditions_at, deviations, log_densities, velocities
from conveyor_pipeline.machine.calibration.measurements import CALIBRATED, DEFAULTS
from conveyor_pipeline.machine.calibration.search_space import LOGARITHMIC

TABLES = {
    "prediction": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("low", "m/s", "5 % quantile of the velocity of one part between the neighbouring amplitudes"),
        fields.number("median", "m/s", "median of the velocity of one part between the neighbouring amplitudes"),
        fields.number("high", "m/s", "95 % quantile of the velocity of one part between the neighbouring amplitudes"),
    ),
    "next": (
        fields.number("acceleration", "m/s²", "amplitude of one more measurement"),
        fields.number("narrowing", "1", "expected narrowing of the intervals, mean over the parameters"),
        *(
            fields.number(
                f"narrowing_{name}", "1", f"expected narrowing of the interval of {name}; null if not searched"
            )
            for name in CALIBRATED
        ),
    ),
}
ENDS = (0.05, 0.5, 0.95)
POSSIBLE = 256  # possible results of a measurement
BEYOND = 0.2  # relative distance beyond the measured amplitudes within which the next measurement is sought


def expected_narrowing(
    simulated: np.ndarray, values: np.ndarray, plate: float, noise: float, random: np.random.Generator
) -> np.ndarray:
    """Expected narrowing of the interval of each parameter by one velocity, shape (d,).

    Parameters
    ----------
    simulated : velocities of the parts of each sample, m/s, shape (n, parts)
    values : searched parameters, or their logarithms, shape (n, d)
    plate : largest velocity of the plate along the track, m/s
    noise : relative standard deviation of the velocity
    """
    simulated = np.where(np.isnan(simulated), 0.0, simulated)
    n, parts = simulated.shape
    place = random.permutation(n * parts)[:POSSIBLE]
    sample, part = np.divmod(place, parts)
    true = simulated[sample, part]
    accuracy = (np.array([math.nan]), np.array([plate]), noise)
    result = true + random.standard_normal(len(true)) * deviations(true, *accuracy)
    logs = log_densities(result[:, None], simulated, *accuracy)  # rows of possible results, columns of samples
    # The part that gave a result must not count as evidence for its own sample.
    other_parts = np.array([np.delete(simulated[s], p) for s, p in zip(sample, part, strict=True)])
    logs[np.arange(len(result)), sample] = log_densities(result, other_parts, *accuracy)
    weights = exp(logs - logs.max(axis=1, keepdims=True))
    weights /= weights.sum(axis=1, keepdims=True)
    mean = product(weights, values)
    after = np.sqrt(np.maximum(product(weights, values**2) - mean**2, 0.0)).mean(axis=0)
    return 1.0 - after / values.std(axis=0)


def make(
    samples: pd.DataFrame, fit: pd.DataFrame, settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, dict]:
    """The tables of predicted velocities and of possible next measurements."""
    return predict(samples, fit, settings | sizes_of(settings["effort"]), threads=threads, progress=progress)


def predict(
    samples: pd.DataFrame,
    fit: pd.DataFrame,
    settings: dict,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> dict[str, dict]:
    """Both tables, with amplitudes up to a relative distance BEYOND the measured ones; no rows without samples."""
    if samples.empty:
        return {name: fields.columns([], schema) for name, schema in TABLES.items()}
    low, high = fit.acceleration.min(), fit.acceleration.max()
    between = np.unique(np.linspace(low, high, settings["amplitudes"]))
    # Amplitudes that are nearly equal would otherwise ask for any number of further ones.
    step = max((high - low) / (settings["amplitudes"] - 1), BEYOND * high / settings["amplitudes"])
    count = math.floor(BEYOND * high / step)
    outside = np.concatenate([low - step * np.arange(1, count + 1), high + step * np.arange(1, count + 1)])
    amplitudes = np.concatenate([between, outside[outside > (1.0 - BEYOND) * low]])
    conditions = conditions_at(
        amplitudes,
        [{}] * len(amplitudes),
        [(DEFAULTS["before"], DEFAULTS["duration"])] * len(amplitudes),
        settings["model"],
    )
    chosen = samples.iloc[np.linspace(0, len(samples) - 1, settings["predicted"]).round().astype(int)]
    values = {name: chosen[name].to_numpy() for name in settings["ranges"]}
    options = {"parts": settings["predicted_parts"], "seed": settings["seed"], "threads": threads}
    simulated = velocities(values, conditions, settings, **options, progress=progress)
    random = np.random.default_rng(settings["seed"])
    columns = np.column_stack([log(column) if name in LOGARITHMIC else column for name, column in values.items()])
    columns = columns + 1e-12 * random.standard_normal(columns.shape)  # equal samples have no standard deviation
    gains = np.array(
        [
            expected_narrowing(simulated[:, place], columns, conditions.plate[place], settings["noise"], random)
            for place in range(len(amplitudes))
        ]
    )
    quantiles = np.array(
        [
            np.nanquantile(simulated[:, max(place - 1, 0) : min(place + 2, len(between))], ENDS)
            for place in range(len(between))
        ]
    ).T
    order = np.argsort(amplitudes, kind="stable")
    by_name = dict(zip(values, gains.T, strict=True))
    nothing = np.full(len(amplitudes), math.nan)
    return {
        "prediction": {"acceleration": between, **dict(zip(("low", "median", "high"), quantiles, strict=True))},
        "next": {
            "acceleration": amplitudes[order],
            "narrowing": gains.mean(axis=1)[order],
            **{f"narrowing_{name}": by_name.get(name, nothing)[order] for name in CALIBRATED},
        },
    }
