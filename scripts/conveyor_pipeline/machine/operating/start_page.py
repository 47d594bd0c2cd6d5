"""What switching the drive on and off does to the parts, in words."""

import math

import numpy as np
import pandas as pd

from conveyor import throw_number
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.operating.advice import EVEN, FAST
from conveyor_pipeline.machine.operating.chart import stroke
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
CERTAIN = 2.0
# What precedes the motion at an amplitude, in words.
WAYS = {
    AT_REST: "switched on with the parts on the plate",
    DROPPED: "switched on as the parts fall onto the plate",
    FED: "parts fall onto the running plate",
    DOWN: "amplitude lowered slowly from above",
}


def ways_at(aim: str, start: pd.DataFrame, motions: pd.DataFrame) -> list[dict]:
    """The motion at the amplitude of an aim after each of WAYS."""
    rows = motions[motions.aim == aim].assign(way=lambda own: own.parts.map(WAYS))
    falling = start[(start.aim == SLOWLY) & (start.way == DOWN)]
    nearest = falling.iloc[[(falling.acceleration - rows.acceleration.iloc[0]).abs().argmin()]]
    nearest = nearest.assign(way=WAYS[DOWN], repeating=np.nan)
    found = pd.concat([rows, nearest[["way", "velocity_05", "velocity_50", "jumping", "repeating", "failed"]]])
    return found.replace({np.nan: None}).to_dict("records")


def extremes(ways: list[dict]) -> dict[str, dict]:
    """The ways after which most and fewest parts jump, if any part could be followed."""
    known = sorted((way for way in ways if way["jumping"] is not None), key=lambda way: way["jumping"])
    return {"least": known[0], "most": known[-1]} if known else {}


def depends(ways: list[dict], parts: int) -> bool:
    """Whether the shares of jumping parts differ by more than DEPENDS and by more than their standard errors."""
    shares = [way["jumping"] for way in ways if way["jumping"] is not None]
    low, high = min(shares, default=0.0), max(shares, default=0.0)
    error = math.sqrt((low * (1.0 - low) + high * (1.0 - high)) / parts)
    return high - low > max(DEPENDS, CERTAIN * error)


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
        own = pushes[pushes.aim == row["aim"]].replace({np.nan: None}).to_dict("records")
        about = {key: row[key] for key in ("aim", "acceleration")} | extremes(ways)
        runs.append(about | {"ways": ways, "depends": depends(ways, settings["starts"]), "pushes": own})
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
        "stroke_per_amplitude": stroke(1.0, settings["model"]["frequency"]),
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
