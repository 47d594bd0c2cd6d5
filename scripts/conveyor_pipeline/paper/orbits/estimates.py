"""Lyapunov exponents from pairs of trajectories, as the paper estimates them (Eq. 23)."""

import numpy as np

from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.paper.orbits.published_estimates import finite_difference_exponent

TABLES = {
    "estimates": (fields.number("lambda", "1/s", "Lyapunov exponent by finite differences (Eq. 23)"),),
}


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of estimates for the resolved `settings` of an entry of the config."""
    options = {name: settings[name] for name in ("output", "duration", "last", "method")}
    options |= {name: settings[name] for name in ("tolerance", "step") if name in settings}
    axes, parameters = grid.product(settings["axes"], settings["model"])
    perturbed = parameters.copy()
    perturbed[settings["perturb"]] += settings["epsilon"]
    exponents = finite_difference_exponent(
        parameters, perturbed, settings["epsilon"], **options, threads=threads, progress=progress
    )
    return {**axes, "lambda": exponents}
