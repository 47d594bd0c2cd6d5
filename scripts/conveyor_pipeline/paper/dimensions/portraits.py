"""Fractal dimensions of the phase portraits ż_p over z_p, over the axes of an entry of the config."""

import numpy as np

from conveyor import Dimension, box_dimension, correlation_dimension, sample_runs
from conveyor.parallel import for_each_chunk
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.paper.dimensions.limits import LARGEST_ERROR
from conveyor_pipeline.paper.orbits.published_estimates import (
    INTERVAL,
    SETTLED_INTERVAL,
    THEILER,
    box_dimension_of_paper,
)

TABLES = {
    "dimensions": (
        fields.number("dimension", "1", "dimension of the phase portrait ż_p over z_p (Eq. 25); null for no estimate"),
        fields.number("error", "1", "half-width of its 95 % interval; null if the points resolve too few scales"),
        fields.text("status", "ok, or why there is no dimension"),
    ),
}


# Samples of a settled motion: enough to know the dimension of chaos to ± 0.1 by boxes; fewer for the correlation sum,
# because the number of pairs grows with their square.
SAMPLES = {"box": 100_000, "correlation": 20_000}


def portrait(parameters: np.ndarray, settings: dict) -> np.ndarray:
    """Consecutive points (z_p in m, ż_p in m/s) of one trajectory, shape (samples, 2)."""
    frequency = parameters["frequency"]
    if settings["estimator"] == "paper":
        samples = round(settings["duration"] * frequency / INTERVAL) + 1
        times = INTERVAL * np.arange(samples) / frequency
    else:
        samples = settings.get("samples", SAMPLES[settings["estimator"]])
        times = settings["settling"] / frequency + SETTLED_INTERVAL * np.arange(samples) / frequency
    options = {name: settings[name] for name in ("method", "tolerance", "step") if name in settings}
    motion = sample_runs(parameters[None], times[None], columns=["z", "vz"], **options)
    return np.stack([motion.z[0], motion.vz[0]], axis=1)


def estimate(points: np.ndarray, settings: dict) -> Dimension:
    """The dimension of a portrait by the estimator of the settings."""
    if settings["estimator"] == "paper":
        return box_dimension_of_paper(points)
    return box_dimension(points) if settings["estimator"] == "box" else correlation_dimension(points, THEILER)


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of dimensions for the resolved `settings` of an entry of the config."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    results = np.empty((len(parameters), 2))

    def work(begin, end):
        for i in range(begin, end):
            results[i] = estimate(portrait(parameters[i], settings), settings)[:2]

    for_each_chunk(work, len(parameters), threads=threads, chunk=1, progress=progress)
    value, error = results.T
    wide = (error > LARGEST_ERROR) & (settings["estimator"] != "paper")
    status = np.select([np.isnan(value), wide], ["too few scales", "interval too wide"], "ok")
    return axes | {"dimension": np.where(wide, np.nan, value), "error": error, "status": status}
