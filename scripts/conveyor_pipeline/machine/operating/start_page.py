"""What switching the drive on and off does to the parts, in words."""

import math

import numpy as np
import pandas as pd

from conveyor import throw_number
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.steepness import is_steep
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.operating.advice import EVEN, FAST
from conveyor_pipeline.machine.operating.chart import CERTAIN, stroke_per_amplitude
from conveyor_pipeline.machine.operating.populations import IDENTICAL, VARIED, differences
from conveyor_pipeline.machine.operating.ramps import (
    AT_REST,
    COUNTED,
    CYCLES,
    DOWN,
    DROPPED,
    FED,
    HOLD,
    JUMP_FIRST,
    PUSHED,
    REPEATS,
    RIDE,
    SLOWLY,
    STEP,
    UP,
    ramp_ends,
)
from conveyor_pipeline.machine.operating.start import LAST

# Smallest difference of shares of jumping parts at which the way of switching on counts, besides two standard errors.
DEPENDS = 0.05
FASTER = 0.1  # relative difference of median velocities at which it counts, too
# What precedes the motion at an amplitude, in words.
WAYS = {
    AT_REST: "switched on with the parts on the plate",
    DROPPED: "switched on as the parts fall onto the plate",
    FED: "parts fall onto the running plate",
    DOWN: "amplitude lowered slowly from above",
}


def ways_at(aim: str, start: pd.DataFrame, motions: pd.DataFrame) -> list[dict]:
    """The motion at the amplitude of an aim after each of WAYS."""
    rows = motions[motions.aim == aim].assign(way=lambda table: table.parts.map(WAYS))
    falling = start[(start.aim == SLOWLY) & (start.way == DOWN)]
    nearest = falling.iloc[[(falling.acceleration - rows.acceleration.iloc[0]).abs().argmin()]]
    ways = pd.concat([rows, nearest.assign(way=WAYS[DOWN])])
    return ways.replace({np.nan: None}).to_dict("records")


def extremes(ways: list[dict]) -> dict[str, dict]:
    """The ways after which most and fewest parts jump, and those with the largest and the smallest median velocity, if
    any part could be followed."""
    known = [way for way in ways if way["jumping"] is not None]
    extreme_ways = {}
    for names, key in ((("least", "most"), "jumping"), (("slowest", "fastest"), "velocity_50")):
        ordered = sorted(known, key=lambda way: way[key])
        extreme_ways |= dict(zip(names, (ordered[0], ordered[-1]), strict=True)) if known else {}
    return extreme_ways


def depends(ways: list[dict], parts: int) -> bool:
    """Whether the shares of jumping parts differ by more than DEPENDS and by more than their standard errors."""
    shares = [way["jumping"] for way in ways if way["jumping"] is not None]
    low, high = min(shares, default=0.0), max(shares, default=0.0)
    error = math.sqrt((low * (1.0 - low) + high * (1.0 - high)) / parts)
    return high - low > max(DEPENDS, CERTAIN * error)


def is_faster(extreme_ways: dict[str, dict]) -> bool:
    """Whether the medians of `extremes` differ by more than FASTER and by more than their standard errors."""
    if not extreme_ways:
        return False
    slow, fast = extreme_ways["slowest"], extreme_ways["fastest"]
    low, high = slow["velocity_50"], fast["velocity_50"]
    error = math.hypot(slow["velocity_50_stderr"] or 0.0, fast["velocity_50_stderr"] or 0.0)
    return high - low > max(FASTER * max(abs(low), abs(high)), CERTAIN * error)


def make(
    template: str,
    advice: pd.DataFrame,
    start: pd.DataFrame,
    start_motions: pd.DataFrame,
    start_limits: pd.DataFrame,
    pushes: pd.DataFrame,
    has_body: bool = False,
) -> str:
    """The page from its template and its tables; `has_body`: whether the config has blocks, which are not followed."""
    settings = start.attrs
    runs = []
    for row in advice.to_dict("records"):
        ways = ways_at(row["aim"], start, start_motions)
        pushes_of_aim = pushes[pushes.aim == row["aim"]].replace({np.nan: None}).to_dict("records")
        extreme_ways = extremes(ways)
        about = {key: row[key] for key in ("aim", "acceleration")} | extreme_ways
        about |= {"depends": depends(ways, settings["starts"]), "is_faster": is_faster(extreme_ways)}
        runs.append(about | {"ways": ways, "pushes": pushes_of_aim})
    if len(runs) == 2 and runs[0]["acceleration"] == runs[1]["acceleration"]:
        runs = [runs[0] | {"aim": f"{FAST} and {EVEN}"}]
    limits = {
        (row["way"], row["population"], row["share"]): row
        for row in start_limits.replace({np.nan: None}).to_dict("records")
    }
    values = {
        "runs": runs,
        "settings": settings,
        "spread": differences(settings)["spread"],
        "limits": limits,
        "some_jump": any(limits[UP, VARIED, share]["status"] != RIDE for share in LAST),
        "shares": LAST,
        "up": UP,
        "down": DOWN,
        "ride": RIDE,
        "jump_first": JUMP_FIRST,
        "identical": IDENTICAL,
        "varied": VARIED,
        "ends": ramp_ends(grid.axis_values("acceleration", settings["acceleration"])),
        "has_body": has_body,
        "slides": is_steep(settings["model"]),
        "stroke_per_amplitude": stroke_per_amplitude(settings["model"]["frequency"]),
        "throw_number_per_amplitude": throw_number(1.0, **settings["model"]),
        "failed": int(start_motions.failed.sum()),
        "step": STEP,
        "cycles": CYCLES,
        "hold": HOLD,
        "pushed": PUSHED,
        "counted": COUNTED,
        "repeats": REPEATS,
    }
    return render(template, values)
