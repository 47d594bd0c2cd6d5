"""Rule estimate: Lyapunov exponents from pairs of trajectories, as the paper estimates them (Eq. 23)."""

import numpy as np

from conveyor import grid, lyapunov, tables
from conveyor.model import PARAMETERS
from rule_log import logged


def columns(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of estimates for the resolved `settings` of an entry of the config."""
    options = {name: settings[name] for name in ("output", "duration", "last", "samples", "method")}
    options |= {name: settings[name] for name in ("tolerance", "step") if name in settings}
    axes, parameters = grid.product(settings["axes"], settings["model"])
    perturbed = parameters.copy()
    perturbed[:, PARAMETERS.index(settings["perturb"])] += settings["epsilon"]
    exponents = lyapunov.finite_difference_estimate(
        parameters, perturbed, settings["epsilon"], **options, threads=threads, progress=progress
    )
    return {**axes, "lambda": exponents}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(
            snakemake.output[0],
            "estimates",
            columns(settings, threads=snakemake.threads, progress=snakemake.wildcards.name),
            axes=list(settings["axes"]),
            settings=settings,
        )
