"""Fractal dimensions of the phase portraits ż_p over z_p, over the axes of an entry of the config."""

import math

import numpy as np

from conveyor import (
    Dimension,
    box_dimension,
    box_dimension_of_paper,
    correlation_dimension,
    for_each_chunk,
    sample_runs,
)
from pipeline import fields, grid

TABLES = {
    "dimensions": (
        fields.number("dimension", "1", "dimension of the phase portrait ż_p over z_p (Eq. 25); null for no estimate"),
        fields.number("error", "1", "half-width of its 95 % interval; null if the points resolve too few scales"),
        fields.number("scale_low", "1", "smallest scale of the scaling region, in units of the portrait's extent"),
        fields.number("scale_high", "1", "largest scale of the scaling region, in units of the portrait's extent"),
        fields.text("status", "ok, or why there is no dimension"),
    ),
}


def portrait(parameters: np.ndarray, settings: dict) -> np.ndarray:
    """Consecutive points (z_p in m, ż_p in m/s) of one trajectory, shape (samples, 2)."""
    times = settings["begin"] + settings["interval"] * np.arange(settings["samples"]) / parameters["frequency"]
    options = {name: settings[name] for name in ("method", "tolerance", "step") if name in settings}
    motion = sample_runs(parameters[None], times[None], columns=["z", "vz"], **options)
    return np.stack([motion.z[0], motion.vz[0]], axis=1)


def estimate(points: np.ndarray, settings: dict) -> Dimension:
    """The dimension of a portrait by the estimator of the settings."""
    match settings["estimator"]:
        case "paper":
            return box_dimension_of_paper(points, 0.5 ** np.arange(1, settings["octaves"] + 1))
        case "box":
            return box_dimension(points)
        case "correlation":
            return correlation_dimension(points, settings["theiler"])
    raise ValueError(f"estimator = {settings['estimator']!r} is not one of paper, box, correlation")


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of dimensions for the resolved `settings` of an entry of the config."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    results = np.empty((len(parameters), 4))

    def work(begin, end):
        for i in range(begin, end):
            results[i] = estimate(portrait(parameters[i], settings), settings)[:4]

    for_each_chunk(work, len(parameters), threads=threads, chunk=1, progress=progress)
    value, error, *scales = results.T
    wide = error > settings.get("largest_error", math.inf)
    status = np.select([np.isnan(value), wide], ["too few scales", "interval too wide"], "ok")
    columns = dict(zip(("scale_low", "scale_high"), scales, strict=True))
    return axes | {"dimension": np.where(wide, np.nan, value), "error": error, **columns, "status": status}
