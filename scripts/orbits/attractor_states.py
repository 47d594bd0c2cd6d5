"""Initial conditions on the attractors of the table of strobes."""

import numpy as np
import pandas as pd

from conveyor.analysis import stroboscopic_map
from pipeline import grid


def parameters_on_attractors(strobes: pd.DataFrame, settings: dict) -> tuple[pd.DataFrame, np.ndarray]:
    """The last recorded state of each amplitude and branch, and parameter vectors with these states, shape (n, 16)."""
    last = strobes[strobes.cycle == strobes.cycle.max()].reset_index(drop=True)
    parameters = np.tile(grid.packed(settings["model"]), (len(last), 1))
    parameters[:, 0] = last.acceleration
    return last, stroboscopic_map.pack_states(parameters, last[["delta", "v"]].to_numpy(), settings["tolerance"])
