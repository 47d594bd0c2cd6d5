"""Rule lyapunov: exponents on the attractors over the amplitude, from the variational equation."""

import numpy as np
import pandas as pd

from conveyor import attractors, grid, lyapunov, tables
from rule_log import logged


def starts_on_attractors(strobes: pd.DataFrame, settings: dict) -> tuple[pd.DataFrame, np.ndarray]:
    """The last recorded state of each amplitude and branch, and parameter vectors that start there, shape (n, 13)."""
    last = strobes[strobes.cycle == strobes.cycle.max()].reset_index(drop=True)
    _, parameters = grid.product({"acceleration": [0.0]}, settings["model"])
    parameters = np.repeat(parameters, len(last), axis=0)
    parameters[:, 0] = last.acceleration
    return last, attractors.as_starts(parameters, last[["delta", "v"]].to_numpy(), settings["tolerance"])


def columns(
    strobes: pd.DataFrame, settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of the table of spectra from the table of strobes."""
    last, parameters = starts_on_attractors(strobes, settings)
    options = {"tolerance": settings["tolerance"], "threads": threads}
    vertical = lyapunov.spectrum(
        parameters, transient=0, cycles=settings["cycles"], blocks=settings["blocks"], progress=progress, **options
    )
    found = {name: getattr(vertical, name) for name in vertical._fields}
    return {"acceleration": last.acceleration, "branch": last.branch, **found}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        strobes = tables.read(snakemake.input[0], "strobes")
        found = columns(strobes, settings, threads=snakemake.threads, progress="exponents")
        tables.write(snakemake.output[0], "spectrum", found, settings=settings)
