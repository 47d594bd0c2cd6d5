"""Is a point mass enough? Velocities of blocks of several shapes beside those of points, over the amplitude.

All lengths are in units of g cos α/ω². Parts are equal but for their shape, and differ in their initial conditions. The
track is short, so that parts which ride do not arrive: their velocity is that over the longest time.
"""

import numpy as np
import pandas as pd

from conveyor import (
    Block,
    Columns,
    Start,
    block_transits,
    conveyor_and_start,
    length_and_speed_units,
    plate_motion,
    simulate_block,
    throw_number,
    transits,
)
from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.operating.body_limits import (
    AMPLITUDES,
    LONGEST,
    MOTIONS,
    OF_A_CELL,
    PARTS,
    POINTS,
    THROWS,
    TILT,
    TOLERANCE,
    TRACK,
)
from conveyor_pipeline.machine.operating.parts import population, raise_blocks, tilts_of
from conveyor_pipeline.machine.operating.populations import IDENTICAL
from conveyor_pipeline.machine.operating.transit import quantiles, time_of_drop

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
        fields.text("motion", "what points do there: ride, coexist (ride or jump), or chaos"),
        LENGTH,
        HEIGHT,
        *MEASURED,
        fields.number("difference", "1", "relative difference of the median from that of points"),
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


def rides(run: Columns) -> np.ndarray:
    """Whether parts have neither left the plate nor hit it after the drop onto the track, shape (n,)."""
    return run.airtime == 0.0 if "airtime" in run else run.impact_speed == 0.0


def measure(rows: np.ndarray, shape: tuple[float, float] | None, settings: dict, **options) -> list[dict]:
    """The measures of parts of one shape, or of points, at each amplitude in a table of populations.

    shape : length in units of g cos α/ω² and height over length
    """
    model, parts = settings["model"], settings["starts"]
    unit, _ = length_and_speed_units(rows[0])
    length, longest = TRACK * unit, LONGEST / model["frequency"]
    begin = time_of_drop(rows["frequency"], longest)
    options |= {"tolerance": TOLERANCE, "begin": begin}
    if shape is None:
        run = transits(rows, np.array([length]), np.array([longest]), **options)
        velocity, tilt = run.velocity[:, 0], np.full(len(rows), np.nan)
    else:
        block, tilts = Block(shape[0] * unit, shape[0] * shape[1] * unit), np.resize(tilts_of(settings), len(rows))
        started = raise_blocks(rows, block, tilts)
        run = block_transits(started, block, tilts, length=length, longest=longest, **options)
        velocity, tilt = run.velocity, run.largest_tilt
    measures = []
    for first in range(0, len(rows), parts):
        own = slice(first, first + parts)
        right = run.status[own] == "ok"
        values, errors = quantiles(velocity[own][right]) if right.any() else np.full((2, 5), np.nan)
        measures.append(
            {
                "acceleration": rows["acceleration"][first],
                "length": shape[0] if shape else np.nan,
                "height": shape[1] if shape else np.nan,
                **dict(zip(("velocity_05", "velocity_50", "velocity_95"), values[::2], strict=True)),
                "velocity_50_stderr": errors[2],
                "rides": rides(run)[own][right].mean() if right.any() else np.nan,
                "largest_tilt": tilt[own][right].max(initial=np.nan if shape is None else 0.0),
                "failed": np.count_nonzero(~right),
            }
        )
    return measures


def landing_of(row: np.ndarray, shape: tuple[float, float], cycles: np.ndarray) -> pd.DataFrame:
    """Where the lower corners of a block are at times (excitation cycles) after the first of them touches the plate.

    row : a conveyor and an initial condition above the plate
    """
    conveyor, start = conveyor_and_start(row)
    unit, _ = length_and_speed_units(conveyor)
    block = Block(shape[0] * unit, shape[0] * shape[1] * unit)
    run = simulate_block(conveyor, block, Start(start.z), tilt=TILT, duration=3.0 / conveyor.frequency)

    def corners(times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        samples = run.sample(times)
        centre = samples["z"] + 0.5 * block.height * (1.0 - np.cos(samples["angle"]))
        lever = 0.5 * block.length * np.sin(samples["angle"])
        return centre - lever, centre + lever, plate_motion(conveyor, times)["z"], samples["angle"]

    times = np.linspace(0.0, run.duration / 2.0, 3001)
    rear, front, plate, _ = corners(times)
    touched = times[np.argmax(np.minimum(rear, front) <= plate)]
    rear, front, plate, angle = corners(np.clip(touched + cycles / conveyor.frequency, 0.0, run.duration))
    return pd.DataFrame({"time": cycles, "rear": rear, "front": front, "plate": plate, "angle": angle})


def logarithmic(ends: tuple[float, float], count: int) -> list[float]:
    """Numbers between two ends, evenly spaced in their logarithm, with three digits."""
    return [float(f"{value:.3g}") for value in np.geomspace(*ends, count)]


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, pd.DataFrame]:
    """The tables of curves and of the map for the settings of the config."""
    effort, model = settings["effort"], settings["model"]
    settings = {**settings, "body": {"tilt": TILT}}

    unit = throw_number(1.0, **model)
    curves = {**settings, "starts": max(4, round(effort * PARTS))}
    throws = np.linspace(*THROWS, max(3, round(effort * AMPLITUDES)))
    rows = population(throws / unit, curves, IDENTICAL)
    options = {"threads": threads, "progress": progress}
    table = pd.DataFrame([row for shape in (None, *SHAPES) for row in measure(rows, shape, curves, **options)])
    table["throw_number"] = np.tile(throws, len(SHAPES) + 1)
    cells = {**settings, "starts": max(4, round(effort * OF_A_CELL))}
    side = max(2, round(effort * CELLS))
    rows = population(np.array(list(MOTIONS.values())) / unit, cells, IDENTICAL)
    many = {**settings, "starts": max(4, round(effort * POINTS))}
    reference = population(np.array(list(MOTIONS.values())) / unit, many, IDENTICAL)
    points = [one["velocity_50"] for one in measure(reference, None, many, **options)]
    shapes = []
    for length in logarithmic(LENGTHS, side):
        for height in logarithmic(SLENDERNESS, side):
            for motion, own, point in zip(
                MOTIONS, measure(rows, (length, height), cells, **options), points, strict=True
            ):
                difference = own["velocity_50"] / point - 1.0 if point else np.nan
                shapes.append({"motion": motion, **own, "difference": difference})
    first = rows[list(MOTIONS).index("coexist") * cells["starts"]].copy()
    first["psi0"], first["z0"] = LANDING_PHASE, 3.0 * length_and_speed_units(first)[0]
    landing = landing_of(first, SHAPES[0], OUTLINES)
    return {"bodies": table, "body_shapes": pd.DataFrame(shapes), "landing": landing}
