"""Is a point mass enough? Velocities of blocks of several shapes beside those of points, over the amplitude.

All lengths are in units of g cos α/ω². Parts are equal but for their shape, and differ in their initial conditions. The
track is short, so that parts which ride do not arrive: their velocity is that over the longest time.
"""

import itertools
import math

import numpy as np
import pandas as pd

from conveyor import Block, length_and_speed_units, plate_motion, simulate_block, throw_number
from conveyor_pipeline.common import fields
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


def trace_landing(conveyor: np.ndarray, shape: tuple[float, float]) -> pd.DataFrame:
    """Where the lower corners of a block of a shape are at OUTLINES; the row has its height above the plate, too."""
    unit, _ = length_and_speed_units(conveyor)
    length, height, frequency = shape[0] * unit, shape[0] * shape[1] * unit, conveyor["frequency"]
    run = simulate_block(conveyor, Block(length, height), tilt=TILT, duration=3.0 / frequency)

    def outlines(times: np.ndarray) -> pd.DataFrame:
        samples = run.sample(times)
        centre = samples["z"] + 0.5 * height * (1.0 - np.cos(samples["angle"]))
        lever = 0.5 * length * np.sin(samples["angle"])
        ends = {"rear": centre - lever, "front": centre + lever}
        return pd.DataFrame(ends | {"plate": plate_motion(run.conveyor, times)["z"], "angle": samples["angle"]})

    times = np.linspace(0.0, run.duration / 2.0, 3001)
    before = outlines(times)
    touched = times[np.argmax(before[["rear", "front"]].min(axis=1) <= before.plate)]
    table = outlines(np.clip(touched + OUTLINES / frequency, 0.0, run.duration))
    table.insert(0, "time", OUTLINES)
    return table


def logarithmic(ends: tuple[float, float], count: int) -> list[float]:
    """Numbers between two ends, evenly spaced in their logarithm, with three digits."""
    return [float(f"{value:.3g}") for value in np.geomspace(*ends, count)]


def make(settings: dict, *, progress: str | None = None) -> dict[str, pd.DataFrame]:
    """The tables of curves and of the map for the settings of the config."""
    effort, model = settings["effort"], settings["model"]
    unit = throw_number(1.0, **model)
    curves = {**settings, "starts": max(4, round(effort * body_limits.PARTS))}
    throws = np.linspace(*body_limits.THROWS, max(3, round(effort * body_limits.AMPLITUDES)))
    rows = population(throws / unit, curves, IDENTICAL)
    table = pd.DataFrame([row for shape in (None, *SHAPES) for row in measure(rows, shape, curves, progress)])
    table["throw_number"] = np.tile(throws, len(SHAPES) + 1)
    side = max(2, round(effort * CELLS))
    lengths, heights = logarithmic(LENGTHS, side), logarithmic(SLENDERNESS, side)
    shapes = []
    for motion, throw in MOTIONS.items():
        of_points = {**settings, "starts": max(4, round(effort * body_limits.POINTS))}
        of_cells = {**settings, "starts": max(4, round(effort * body_limits.OF_A_CELL[motion]))}
        (points,) = measure(population(np.array([throw]) / unit, of_points, IDENTICAL), None, of_points, progress)
        rows = population(np.array([throw]) / unit, of_cells, IDENTICAL)
        for shape in itertools.product(lengths, heights):
            (blocks,) = measure(rows, shape, of_cells, progress)
            compared = relative_difference(blocks, points)
            shapes.append({"motion": motion, "points_ride": points["rides"], **blocks, **compared})
    (first,) = population(np.array([MOTIONS["coexist"]]) / unit, {**settings, "starts": 1}, IDENTICAL)
    first["psi0"], first["vz0"], first["z0"] = LANDING_PHASE, 0.0, 3.0 * length_and_speed_units(first)[0]
    return {"bodies": table, "body_shapes": pd.DataFrame(shapes), "landing": trace_landing(first, SHAPES[0])}
