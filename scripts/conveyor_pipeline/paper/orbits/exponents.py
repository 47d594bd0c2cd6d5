"""Lyapunov exponents on the attractors: from Floquet multipliers of periodic orbits, otherwise from stretching."""

import numpy as np
import pandas as pd

from conveyor import start_at
from conveyor.analysis.chaos.lyapunov import lyapunov_spectrum_on_attractors
from conveyor_pipeline.common import fields, grid

# Excitation cycles in a block, and blocks, from whose means the standard error is computed.
CYCLES, BLOCKS = 100, 20
TABLES = {
    "spectrum": (
        fields.ORBIT[1],
        fields.text("branch", "up or down, as in the table of strobes"),
        fields.number("lambda_1", "1/s", "larger vertical Lyapunov exponent"),
        fields.number("lambda_2", "1/s", "smaller vertical Lyapunov exponent"),
        fields.number("stderr", "1/s", "standard error of lambda_1 from block means; 0 for a periodic orbit"),
        fields.number("contact_fraction", "1", "time share with contact force; λ1 + λ2 = -(d_c/m) contact_fraction"),
        fields.text("status", "ok, or why there is no result"),
    ),
}


def parameters_on_attractors(strobes: pd.DataFrame, settings: dict) -> tuple[pd.DataFrame, np.ndarray]:
    """The last recorded state of each amplitude and branch, and parameters with these states, shape (n,)."""
    last = strobes[strobes.cycle == strobes.cycle.max()].reset_index(drop=True)
    parameters = np.full(len(last), grid.row_of(settings["model"]))
    parameters["acceleration"] = last.acceleration
    return last, start_at(parameters, last[["delta", "v"]].to_numpy(), tolerance=settings["tolerance"])


def make(
    strobes: pd.DataFrame, settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of the table of Lyapunov spectra from the table of strobes."""
    last, parameters = parameters_on_attractors(strobes, settings)
    options = {"cycles": CYCLES, "blocks": BLOCKS, "tolerance": settings["tolerance"]}
    vertical = lyapunov_spectrum_on_attractors(parameters, **options, threads=threads, progress=progress)
    return {"acceleration": last.acceleration, "branch": last.branch, **vertical}
