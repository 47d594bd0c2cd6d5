"""Populations of parts: random initial conditions from a box, and parameters that differ from part to part.

The random numbers of a part do not depend on the conveyor, so that amplitudes and conveyors are compared with the same
parts.
"""

import math

import numpy as np
import pandas as pd

from conveyor import RANGES, UNITS, Block
from conveyor.analysis.map_states import plate_heights
from conveyor.elementary import cos, exp, log, sin
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.machine.operating.populations import COLUMNS, VARIED

ROUNDING = 1e-5  # largest relative error of a calibrated value in an overlay


def starts_of_box(settings: dict) -> np.ndarray:
    """Initial heights above the plate (m), velocities normal to it (m/s) and phases (rad), shape (n, 3)."""
    low, high = np.array([settings[name] for name in ("height", "vz0", "psi0")], dtype=np.float64).T
    return low + (high - low) * np.random.default_rng(settings["seed"]).random((settings["starts"], 3))


def tilts_of(settings: dict) -> np.ndarray:
    """Initial angles (rad) of blocks, uniform in ±tilt of the section `body`, shape (n,)."""
    uniform = np.random.default_rng([settings["seed"], 1]).random(settings["starts"])
    return settings["body"]["tilt"] * (2.0 * uniform - 1.0)


def raise_blocks(rows: np.ndarray, block: Block, tilts: np.ndarray) -> np.ndarray:
    """The table of parts, in which no tilted block begins in the plate: its lowest corner touches it instead.

    tilts : rad, in the shape of the rows, whose height is that of the centre above the one at rest
    """
    lowest = 0.5 * (block.length * np.abs(sin(tilts)) + block.height * (cos(tilts) - 1.0))
    rows = rows.copy()
    rows["z0"] = np.maximum(rows["z0"], plate_heights(rows) + lowest)
    return rows


def factors(spread: dict, count: int) -> np.ndarray:
    """Factors of the parameters in COLUMNS for each of `count` parts, shape (count, 5).

    They are lognormal with the median 1. `spread` has the relative standard deviation of each, and the `seed`.
    """
    deviations = np.array([spread[name] for name in COLUMNS])
    normal = np.random.default_rng(spread["seed"]).standard_normal((count, len(COLUMNS)))
    return exp(np.sqrt(log(1.0 + deviations**2)) * normal)


def calibrated_factors(samples: pd.DataFrame, settings: dict) -> np.ndarray:
    """Factors of the parameters in COLUMNS for each part, shape (n, 5), from samples of a calibration.

    settings : `model`, whose values the factors multiply; `starts` (n) and `spread`, whose seed assigns the samples
    """
    calibrated = np.ones((settings["starts"], len(COLUMNS)))
    order = np.random.default_rng(settings["spread"]["seed"]).permutation(len(samples))
    chosen = samples.iloc[np.resize(order, len(calibrated))]
    for column, name in enumerate(COLUMNS):
        if name in samples:
            calibrated[:, column] = chosen[name] / settings["model"][name]
    return calibrated


def with_calibration(settings: dict, samples: pd.DataFrame | None, parameters: pd.DataFrame | None) -> dict:
    """The settings for `population`, with the factors of calibrated parts if there are samples.

    samples, parameters : tables of a calibration, whose best values must be those of the model

    Raises
    ------
    JobError
        if the model has other values, for example those of an earlier calibration, or there are no samples because the
        search of the calibration has not converged
    """
    if samples is None:
        return settings
    if samples.empty:
        raise JobError("The search of the calibration has not converged, so that parts cannot be drawn from it")
    for row in parameters.itertuples():
        if not math.isclose(model_value := settings["model"][row.parameter], row.best, rel_tol=ROUNDING):
            raise JobError(
                f"model.{row.parameter} = {model_value} is not {row.best:.6g}, the calibrated value; "
                "name calibrated.yaml behind your config; if it is there, it is new now, so type the command again"
            )
    return {**settings, "calibrated": calibrated_factors(samples, settings)}


def check_ranges(rows: np.ndarray, settings: dict) -> None:
    """JobError for parts whose parameters lie outside the range of the model."""
    for name in (*COLUMNS, "static_friction"):
        (low, high), values = RANGES[name], rows[name]
        if ((values < low) | (values > high)).any():
            key = "friction" if name == "static_friction" else name
            other = "operating.acceleration" if key == "acceleration" else f"model.{name}"
            raise JobError(
                f"parts.{key} = {settings['spread'][key]} makes parts with {name} from {values.min():.4g} to "
                f"{values.max():.4g} {UNITS[name]}, outside [{low:g}, {high:g}]; give a smaller parts.{key}, or "
                f"another {other}"
            )


def population(amplitudes: np.ndarray, settings: dict, kind: str = VARIED) -> np.ndarray:
    """Parameters of n parts at each of m amplitudes (m/s²), shape (m n,).

    settings : `model`; `starts` (n), `seed` and the ends of the box of initial conditions. For varied parts, also
        `spread`, see `factors`, and, if parameters are uncertain, `calibrated`, see `calibrated_factors`
    kind : one of POPULATIONS
    """
    starts = starts_of_box(settings)
    height, velocity, phase = np.tile(starts, (len(amplitudes), 1)).T
    _, conveyors = grid.product({"acceleration": list(amplitudes)}, settings["model"])
    rows = np.repeat(conveyors, len(starts))
    if kind == VARIED:
        spread = factors(settings["spread"], len(starts))
        part_factors = spread * settings.get("calibrated", 1.0)
        # A calibration keeps a stated static friction. Otherwise it is equal to the friction.
        of_static = spread if "static_friction" in settings["model"] else part_factors
        for name, column in zip(COLUMNS, part_factors.T, strict=True):
            rows[name] *= np.tile(column, len(amplitudes))
        rows["static_friction"] *= np.tile(of_static[:, COLUMNS.index("friction")], len(amplitudes))
        rows["static_friction"] = np.maximum(rows["static_friction"], rows["friction"])
        check_ranges(rows, settings)
    rows["psi0"], rows["vz0"] = phase, velocity
    rows["z0"] = height + plate_heights(rows)
    return rows
