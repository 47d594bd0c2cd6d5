"""Eq. 13 fitted to the critical initial heights, and the valley of nearly equal fits."""

import numpy as np
import pandas as pd

from conveyor.analysis import regression
from conveyor.analysis.regression import Hyperbola
from pipeline import fields

TABLES = {
    "regressions": (
        fields.text(
            "fit", "pymoo, least_squares, paper (the paper's own triple) or valley (the best A and C for a given B)"
        ),
        fields.number("A", "m²/s²", "parameter of Eq. 13"),
        fields.number("B", "m/s²", "parameter of Eq. 13"),
        fields.number("C", "m", "parameter of Eq. 13"),
        fields.number("error", "m²", "mean squared error of Eq. 13"),
        fields.count(
            "evaluations", "number of triples, or of values of B, whose error was computed; 0 for given triples"
        ),
    ),
}


def make(critical: pd.DataFrame, settings: dict) -> dict[str, np.ndarray]:
    """The columns of a table of regressions from a table of critical heights."""
    low, high = settings["acceleration"]
    data = critical[critical.is_critical & critical.acceleration.between(low, high)]
    data = data.acceleration.to_numpy(), data.z0.to_numpy()
    paper = Hyperbola(**settings["paper"])
    bounds = {name: tuple(limits) for name, limits in settings["bounds"].items()}
    pymoo = regression.fit_pymoo(*data, bounds, settings["seed"], settings["evaluations"])
    least_squares = regression.fit_least_squares(*data, bounds["B"])
    valley = settings["valley"]
    valley, errors = regression.profile(*data, np.linspace(valley["start"], valley["stop"], int(valley["num"])))
    triples = np.vstack([pymoo.parameters, least_squares.parameters, paper, valley])
    return {
        "fit": np.array(["pymoo", "least_squares", "paper"] + ["valley"] * len(valley)),
        **dict(zip(Hyperbola._fields, triples.T, strict=True)),
        "error": np.array([pymoo.error, least_squares.error, regression.mean_squared_error(*data, paper), *errors]),
        "evaluations": np.array([pymoo.evaluations, least_squares.evaluations, 0] + [1] * len(valley)),
    }
