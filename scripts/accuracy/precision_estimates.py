"""Error over work of estimators of the largest Lyapunov exponent, of the dimension and of the fit."""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from conveyor import (
    REFERENCE_DIMENSIONS,
    box_dimension,
    box_dimension_of_paper,
    correlation_dimension,
    finite_difference_exponent,
    fit_hyperbola,
    fit_hyperbola_by_pymoo,
    initial_states,
    lyapunov_spectrum,
    normal_gravity,
    renormalised_exponent,
    settled_orbit,
    start_at,
)
from pipeline import fields, grid

TABLES = {
    "precision_estimates": (
        fields.text("quantity", "exponent, dimension or fit"),
        fields.text("estimator", "name of the estimator"),
        fields.number("work", "1", "simulated cycles, points or evaluations"),
        fields.number("error", "1", "relative error (exponent), error (dimension) or relative gap to the best fit"),
    ),
}

# A periodic orbit, whose exponent is known from its Floquet multipliers.
ORBIT = {"acceleration": 54.0, "z0": 0.3e-3}  # m/s², m
DURATIONS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)  # s
POINTS = (300, 1000, 3000, 10000, 30000)
SETS = 5  # point sets of each size; the median error is recorded
SEED = 1
TOLERANCE = 1e-12
AT_END = 1e-9  # share of a run
EPSILON = 1e-8  # distance of two trajectories, in units of the part at rest
EVALUATIONS = 1000  # largest number of evaluations of a fit


def exponent_rows(model: dict, durations: Sequence[float] = DURATIONS) -> list[dict]:
    """Three estimates of the exponent of a periodic orbit, whose true value follows from its Floquet multiplier."""
    row = grid.row_of(model | ORBIT)
    state = initial_states(row[None], TOLERANCE)[0]
    orbit = settled_orbit(row, ORBIT["acceleration"], state, (1, 2, 4), 1000)
    cycle = 1.0 / model["frequency"]
    truth = math.log(abs(orbit.multipliers[0])) / (orbit.period * cycle)
    here = start_at(row[None], orbit.state[None], TOLERANCE)
    there = here.copy()
    unit = normal_gravity(model) / (2.0 * math.pi * model["frequency"]) ** 2
    there["z0"] += EPSILON * unit
    # Without renormalisation, only the end of the run is compared.
    pair = {"output": "z", "last": AT_END, "samples": 1, "tolerance": TOLERANCE}
    rows = []
    for duration in durations:
        cycles = round(duration / cycle)
        estimates = {
            "pair of trajectories": finite_difference_exponent(here, there, EPSILON * unit, duration=duration, **pair)[
                0
            ],
            "pair, set back each cycle": renormalised_exponent(
                here[0], orbit.state, distance=EPSILON, transient=0, cycles=cycles, tolerance=TOLERANCE
            ),
            "variational equation": lyapunov_spectrum(
                here, orbit.state[None], transient=0, cycles=cycles // 2, blocks=2, tolerance=TOLERANCE
            ).lambda_1[0],
        }
        rows += [
            {"quantity": "exponent", "estimator": name, "work": cycles, "error": abs(value / truth - 1.0)}
            for name, value in estimates.items()
        ]
    return rows


def dimension_rows() -> list[dict]:
    """Median errors of the estimators of the dimension over sets of known dimension."""
    estimators = {
        "boxes": box_dimension,
        "boxes, as in the paper": box_dimension_of_paper,
        "correlation sum": lambda points: correlation_dimension(points, 0),
    }
    rows = []
    for name, estimate in estimators.items():
        for count in POINTS:
            rng = np.random.default_rng(SEED)
            errors = [
                abs(estimate(draw(rng, count)).value - truth)
                for _ in range(SETS)
                for draw, truth in REFERENCE_DIMENSIONS.items()
            ]
            rows.append({"quantity": "dimension", "estimator": name, "work": count, "error": np.nanmedian(errors)})
    return rows


def fit_rows(data: pd.DataFrame, regression: dict) -> list[dict]:
    """Relative gap of the mean squared error to the best fit, over the number of evaluated triples."""
    low, high = regression["acceleration"]
    rows = data[data.is_critical & data.acceleration.between(low, high)]
    values = rows.acceleration.to_numpy(), rows.z0.to_numpy()
    bounds = {name: tuple(interval) for name, interval in regression["bounds"].items()}
    found = {
        "CMA-ES (pymoo)": fit_hyperbola_by_pymoo(*values, bounds, SEED, EVALUATIONS),
        "least squares": fit_hyperbola(*values, bounds["B"]),
    }
    best = min(one.error for one in found.values())
    return [
        {"quantity": "fit", "estimator": name, "work": evaluations, "error": max(error / best - 1.0, 1e-16)}
        for name, one in found.items()
        for evaluations, error in one.history
    ]


def make(settings: dict, critical: pd.DataFrame | None = None) -> dict:
    """The columns of the table; a conveyor without a fit of Eq. 13 has no table of critical heights."""
    rows = exponent_rows(settings["model"])
    rows += dimension_rows()
    if critical is not None:
        rows += fit_rows(critical, settings["regression"])
    return fields.columns(rows, TABLES["precision_estimates"])
