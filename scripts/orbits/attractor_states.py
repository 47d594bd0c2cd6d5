"""Initial conditions on the attractors of the table of strobes."""

import numpy as np
import pandas as pd

from conveyor import start_at
from pipeline import grid


def parameters_on_attractors(strobes: pd.DataFrame, settings: dict) -> tuple[pd.DataFrame, np.ndarray]:
    """The last recorded state of each amplitude and branch, and parameters with these states, shape (n,)."""
    last = strobes[strobes.cycle == strobes.cycle.max()].reset_index(drop=True)
    parameters = np.full(len(last), grid.row_of(settings["model"]))
    parameters["acceleration"] = last.acceleration
    return last, start_at(parameters, last[["delta", "v"]].to_numpy(), settings["tolerance"])
