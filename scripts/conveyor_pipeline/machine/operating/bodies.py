"""Is a point mass enough? Velocities of blocks of several shapes beside those of points, over the amplitude.

All lengths are in units of g cos α/ω². Parts are equal but for their shape, and differ in their initial conditions. The
track is short, so that parts which ride do not arrive: their velocity is that over the longest time.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from conveyor import Block, Start, length_and_speed_units, plate_motion, simulate_block, throw_number
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.machine.operating import body_limits
from conveyor_pipeline.machine.operating.body_limits import MOTIONS, TILT
from conveyor_pipeline.machine.operating.parts import population
from conveyor_pipeline.machine.operating.populations import IDENTICAL
from conveyor_pipeline.machine.operating.transit import follow_parts, summarize

LENGTH = fields.number("length", "1", "length of the block in units of g cos α/ω²; null for points")
HEIGHT = fields.number("height", "1", "height over length; null for points")
MEASURED = (
    fields.number("velocity_05", "m/s", "5 % quantile of the transit velocity"),
    fields.number("velocity_50", "m/s", "median of the transit velocity"),
    fields.number("velocity_50_stderr", "m/s", "its standard error"),
    fields.number("velocity_95", "m/s", "95 % quantile of the transit velocity"),
    fields.number("rides", "1", "share of the parts without a flight after the drop onto the track"),
    fields.number("largest_tilt", "rad", "largest angle of a part; null for points"),
    fields.count("failed", "parts whose run failed; the other columns do not contain them"),
)
TABLES = {
    "bodies": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("throw_number", "1", "throw number Γ"),
        LENGTH,
        HEIGHT,
        *MEASURED,
    ),
    "body_shapes": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.text("motion", "what points do there on the paper's conveyor: ride, coexist (ride or jump), or chaos"),
        fields.number("points_ride", "1", "share of the points without a flight after the drop onto the track"),
        LENGTH,
        HEIGHT,
        *MEASURED,
        fields.number("difference", "1", "relative difference of the median from that of points"),
        fields.number("difference_stderr", "1", "its standard error"),
    ),
    "landing": (
        fields.number("time", "1", "time after the first corner touches the plate, in excitation cycles"),
        fields.number("rear", "m", "height of the lower rear corner of the block"),
        fields.number("front", "m", "height of its lower front corner"),
        fields.number("plate", "m", "height of the plate"),
        fields.number("angle", "rad", "angle of the block"),
    ),
}
# Shapes of the curves: on the paper's conveyor 5 × 1, 5 × 3 and 3 × 3 mm.
SHAPES = ((50.3, 0.2), (50.3, 0.6), (30.2, 1.0))
# The map: lengths, 1 to 40 mm on the paper's conveyor, and heights over length.
LENGTHS, SLENDERNESS, CELLS = (10.0, 400.0), (0.05, 1.2), 6
# The drawn landing: the phase at the start (rad), and times of the outlines after the first contact, in cycles.
LANDING_PHASE, OUTLINES = 0.0, np.array([-0.03, 0.0, 0.02, 0.04, 0.07, 0.11, 0.16])


def measure(rows: np.ndarray, shape: tuple[float, float] | None, settings: dict, progress: str | None) -> list[dict]:
    """The measures of parts of one shape, or of points, at each amplitude in a table of populations.

    shape : length in units of g cos α/ω² and height over length
    """
    unit, _ = length_and_speed_units(rows[0])
    length, height = shape or (np.nan, np.nan)
    longest = body_limits.LONGEST / settings["model"]["frequency"]
    followed = {**settings, "length": body_limits.TRACK * unit, "longest": longest, "tolerance": body_limits.TOLERANCE}
    if shape:
        followed["body"] = {"length": length * unit, "height": length * height * unit, "tilt": TILT}
    run = follow_parts(rows, followed, progress=progress)
    measures = []
    for first in range(0, len(rows), settings["starts"]):
        parts = run.select(slice(first, first + settings["starts"]))
        summary = summarize(parts)
        right = parts.select(parts.status == "ok")
        # Whether parts have neither left the plate nor hit it after the drop onto the track.
        ride = (right.airtime if shape else right.impact_speed) == 0.0
        measures.append(
            {
                "acceleration": rows["acceleration"][first],
                "length": length,
                "height": height,
                **{name: summary[name] for name in ("velocity_05", "velocity_50", "velocity_50_stderr", "velocity_95")},
                "rides": ride.mean() if len(ride) else np.nan,
                "largest_tilt": right.largest_tilt.max(initial=0.0) if shape else np.nan,
                "failed": summary["failed"],
            }
        )
    return measures


def relative_difference(blocks: dict, points: dict) -> dict[str, float]:
    """The relative difference between the medians of two populations, and its standard error; NaN if points stay."""
    median, reference = blocks["velocity_50"], points["velocity_50"] or np.nan
    error = math.hypot(blocks["velocity_50_stderr"], median / reference * points["velocity_50_stderr"])
    return {"difference": median / reference - 1.0, "difference_stderr": error / abs(reference)}


def trace_landing(model: dict, acceleration: float, shape: tuple[float, float]) -> pd.DataFrame:
    """Where the lower corners of a falling block are at OUTLINES, on a conveyor with an amplitude (m/s²)."""
    conveyor, _ = grid.conveyor_and_start(model | {"acceleration": acceleration, "psi0": LANDING_PHASE})
    unit, _ = length_and_speed_units(conveyor)
    block = Block(shape[0] * unit, shape[0] * shape[1] * unit)
    run = simulate_block(conveyor, block, Start(3.0 * unit), tilt=TILT, duration=3.0 / conveyor.frequency)

    def outlines(times: np.ndarray) -> pd.DataFrame:
        samples = run.sample(times)
        centre = samples["z"] + 0.5 * block.height * (1.0 - np.cos(samples["angle"]))
        lever = 0.5 * block.length * np.sin(samples["angle"])
        ends = {"rear": centre - lever, "front": centre + lever}
        return pd.DataFrame(ends | {"plate": plate_motion(conveyor, times)["z"], "angle": samples["angle"]})

    times = np.linspace(0.0, run.duration / 2.0, 3001)
    before = outlines(times)
    touched = times[np.argmax(before[["rear", "front"]].min(axis=1) <= before.plate)]
    table = outlines(np.clip(touched + OUTLINES / conveyor.frequency, 0.0, run.duration))
    table.insert(0, "time", OUTLINES)
    return table


def logarithmic(ends: tuple[float, float], count: int) -> list[float]:
    """Numbers between two ends, evenly spaced in their logarithm, with three digits."""
    return [float(f"{value:.3g}") for value in np.geomspace(*ends, count)]


def make(settings: dict, *, progress: str | None = None) -> dict[str, pd.DataFrame]:
    """The tables of curves and of the map for the settings of the config."""
    effort, model = settings["effort"], settings["model"]
    unit = throw_number(1.0, **model)

    def measure_shapes(shapes: Sequence, throws: np.ndarray, parts: int) -> list[dict]:
        followed = {**settings, "starts": max(4, round(effort * parts))}
        rows = population(throws / unit, followed, IDENTICAL)
        return [row for shape in shapes for row in measure(rows, shape, followed, progress)]

    throws = np.linspace(*body_limits.THROWS, max(3, round(effort * body_limits.AMPLITUDES)))
    table = pd.DataFrame(measure_shapes((None, *SHAPES), throws, body_limits.PARTS))
    table["throw_number"] = np.tile(throws, len(SHAPES) + 1)
    cells = max(2, round(effort * CELLS))
    of_map = list(itertools.product(logarithmic(LENGTHS, cells), logarithmic(SLENDERNESS, cells)))
    shapes = []
    for motion, throw in MOTIONS.items():
        (points,) = measure_shapes((None,), np.array([throw]), body_limits.POINTS)
        for blocks in measure_shapes(of_map, np.array([throw]), body_limits.OF_A_CELL[motion]):
            compared = relative_difference(blocks, points)
            shapes.append({"motion": motion, "points_ride": points["rides"], **blocks, **compared})
    landing = trace_landing(model, MOTIONS["coexist"] / unit, SHAPES[0])
    return {"bodies": table, "body_shapes": pd.DataFrame(shapes), "landing": landing}
