"""Fits of Eq. 13 to the critical initial heights, and the valley of nearly equal fits."""

import numpy as np
import pandas as pd

from conveyor_pipeline.common import fields
from conveyor_pipeline.paper.fit.hyperbola import Hyperbola, mean_squared_error
from conveyor_pipeline.paper.fit.hyperbola_fit import fit_hyperbola, fit_hyperbola_by_pymoo, hyperbola_profile

TABLES = {
    "regressions": (
        fields.text("fit", "pymoo, least_squares, paper (its A, B and C) or valley (the best A and C for a given B)"),
        fields.number("A", "m²/s²", "parameter of Eq. 13"),
        fields.number("B", "m/s²", "parameter of Eq. 13"),
        fields.number("C", "m", "parameter of Eq. 13"),
        fields.number("error", "m²", "mean squared error of Eq. 13"),
    ),
}

SEED = 1  # of pymoo's evolution strategy
EVALUATIONS = 5000  # at most; the search ends by itself after about 1000


def make(critical: pd.DataFrame, settings: dict) -> dict[str, np.ndarray]:
    """The columns of a table of regressions from a table of critical heights; no rows for too few amplitudes."""
    data = critical[critical.is_critical & critical.acceleration.between(*settings["acceleration"])]
    data = data.acceleration.to_numpy(), data.z0.to_numpy()
    names = [column.name for column in TABLES["regressions"]]
    if len(np.unique(data[0])) <= len(Hyperbola._fields):
        return {name: [] for name in names}
    bounds = settings["bounds"]
    valley = np.linspace(**settings["valley"])
    fits = {
        "pymoo": fit_hyperbola_by_pymoo(*data, bounds, SEED, EVALUATIONS),
        "least_squares": fit_hyperbola(*data, bounds["B"]),
    }
    if "paper" in settings:
        fits["paper"] = Hyperbola(**settings["paper"])
    rows = [(name, *triple, mean_squared_error(*data, triple)) for name, triple in fits.items()]
    rows += [("valley", *triple, error) for triple, error in zip(*hyperbola_profile(*data, valley), strict=True)]
    return pd.DataFrame(rows, columns=names).to_dict("list")
