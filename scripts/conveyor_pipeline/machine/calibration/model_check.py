"""Whether the model explains the measurements, and whether another parameter explains them much better.

The test of the model does not use the parts of the search again, because the search has favoured parameters whose parts
happened to agree with the measurements. For parameters from the posterior, new parts are followed. One half of them
gives the density, the other half replicates of the measurements. The p-value is the share of replicates that fit worse
than the measurements, averaged over the posterior (Gelman, Meng and Stern 1996). Two statistics are compared, because
each is blind where the other one sees: the shares of the single measurements (Fisher's sum), and how far the
measurements at one amplitude lie on one side of what is predicted there. The smaller p-value counts, times two
(Bonferroni).

A wrong model can pass this test. A soft contact, for example, makes up for a track that rises. The measurements are
still much more probable if the inclination is a parameter, too. The Bayes factor says so: the ratio of the evidences of
both searches, in which freedom that explains nothing is no advantage (Kass and Raftery 1995).
"""

import math

import numpy as np
from scipy.stats import rankdata
from tqdm import tqdm

from conveyor import UNITS
from conveyor.elementary import log
from conveyor.linear_algebra import dot, product
from conveyor_pipeline.machine.calibration.effort import EFFECTIVE_OF_EVIDENCE
from conveyor_pipeline.machine.calibration.importance_sampling import Sample
from conveyor_pipeline.machine.calibration.inference import (
    INFLATIONS,
    ROUGH,
    Data,
    centre,
    draw,
    search,
)
from conveyor_pipeline.machine.calibration.likelihood import deviations, log_densities, velocities, widths
from conveyor_pipeline.machine.calibration.measurements import Measurement
from conveyor_pipeline.machine.calibration.search_space import values_at

DECISIVE = (
    20.0  # Bayes factor from which the model without an alternative is rejected ("strong", Kass and Raftery 1995)
)
SIGNIFICANCE = 0.01  # p-value below which the model does not explain the measurements
UNLIKELY = 0.01  # share of replicates below which a single measurement does not fit


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
    predicted = np.sort(replicates(parts[data.condition_of], data, settings, settings["replicates"], random), axis=0)
    below = np.column_stack([np.searchsorted(*columns) for columns in zip(predicted.T, measured.T, strict=True)]) / len(
        predicted
    )
    belongs = data.condition_of[:, None] == np.arange(len(parts))
    sums = product(below - 0.5, belongs.astype(np.float64))
    return dot(sums**2, 12.0 / belongs.sum(axis=0))


def compare(
    parts: np.ndarray, data: Data, settings: dict, random: np.random.Generator
) -> tuple[float, np.ndarray, np.ndarray]:
    """p-value, shares of the single measurements, shape (r,), and replicates, for velocities of parts, shape (k, n)."""
    scored, other_half = np.split(np.where(np.isnan(parts), 0.0, parts), 2, axis=1)
    drawn = replicates(other_half[data.condition_of], data, settings, settings["replicates"], random)
    measured = np.vstack([data.velocity, drawn])
    spread = widths(scored)
    densities = [
        log_densities(column[:, None], scored[[condition]], sd, plate, settings["noise"], spread[[condition]])[:, 0]
        for column, condition, sd, plate in zip(
            measured.T, data.condition_of, data.sd[:, None], data.plate[:, None], strict=True
        )
    ]
    shares = tail_shares(np.column_stack(densities))
    sided = one_sidedness(measured, scored, data, settings, random)
    of_all = tail_shares(np.column_stack([log(shares).sum(axis=1), -sided]))[0]
    return min(1.0, len(of_all) * of_all.min()), shares[0], drawn


def differs(measured: Measurement, model: dict) -> bool:
    """Whether a measurement was made under other conditions than those of the model."""
    return any(model.get(name) != value for name, value in measured.changed.items())


def measured_columns(data: Data, settings: dict) -> dict:
    """The columns of the table of the fit that need no posterior."""
    return {
        "line": [row.line for row in data.measured],
        "acceleration": [row.acceleration for row in data.measured],
        "velocity": data.velocity,
        "changed": [differs(row, settings["model"]) for row in data.measured],
        "sd": deviations(data.velocity, data.sd, data.plate, settings["noise"]),
    }


def runs_of_check(data: Data, settings: dict) -> int:
    """The number of runs of `check_fit`."""
    return (1 + settings["checked"]) * len(data.conditions.rows) * 2 * settings["checked_parts"]


def check_fit(posterior: Sample, data: Data, settings: dict, *, threads: int = 1) -> dict:
    """The columns of the table of the fit."""
    drawn = posterior.points[draw(posterior, settings["checked"])]
    values = values_at(np.vstack([centre(posterior.points, posterior.weights), drawn]), settings)
    options = {"parts": 2 * settings["checked_parts"], "seed": settings["seed"] + settings["rounds"] + 1}
    followed = velocities(values, data.conditions, settings, **options, threads=threads)
    random = np.random.default_rng(settings["seed"])
    p_values, p_rows, simulated = zip(*(compare(parts, data, settings, random) for parts in followed), strict=True)
    p_value, p_row = np.mean(p_values), p_rows[0]
    low, middle, high = np.quantile(simulated[0], [0.05, 0.5, 0.95], axis=0)
    rows = len(data.velocity)
    return measured_columns(data, settings) | {
        "low": low,
        "median": middle,
        "high": high,
        "p_row": p_row,
        "fits": p_row >= UNLIKELY,
        "p_value": np.full(rows, p_value),
        "explained": np.full(rows, p_value >= SIGNIFICANCE),
    }


def settings_of_alternatives(data: Data, settings: dict) -> dict[str, dict]:
    """The settings of the search with one more parameter, by its name, for each that nobody has stated."""
    stated = {*settings["ranges"], *(name for row in data.measured for name in row.changed)}
    enough = {"enough": EFFECTIVE_OF_EVIDENCE}
    return {
        name: settings
        | enough
        | {"ranges": settings["ranges"] | {name: [settings["model"][name] + end for end in (-difference, difference)]}}
        for name, difference in settings["alternatives"].items()
        if name not in stated
    }


def compare_alternatives(
    posterior: Sample, data: Data, settings: dict, *, threads: int = 1, bar: tqdm | None = None
) -> list[dict]:
    """The rows of the table of alternatives: the posterior with one more parameter, against the one without."""
    random = np.random.default_rng(settings["seed"])
    rows = []
    for name, search_settings in settings_of_alternatives(data, settings).items():
        # What is found without the alternative shows where to begin, with any value of it. The first step of a search
        # takes measurements for less accurate than they are, which widens the posterior by the same factor.
        middle = centre(posterior.points, posterior.weights)
        known = middle + INFLATIONS[ROUGH] * (posterior.points - middle)
        near = np.column_stack([known, random.uniform(*search_settings["ranges"][name], len(known))]), posterior.weights
        # One search: an evidence needs no interval, and hardly differs between searches.
        extended = search(data, search_settings, near=near, searches=(1, 1), threads=threads, bar=bar)
        row = {"parameter": name, "unit": UNITS[name], "effective": extended.size}
        row |= {"value": math.nan, "log_bayes_factor": math.nan, "preferred": False}
        if extended.size >= EFFECTIVE_OF_EVIDENCE:
            gain = extended.log_evidence - posterior.log_evidence
            value = values_at(centre(extended.points, extended.weights)[None], search_settings)[name][0]
            row |= {"value": float(value), "log_bayes_factor": gain, "preferred": gain > math.log(DECISIVE)}
        rows.append(row)
    return rows
