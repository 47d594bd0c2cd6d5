"""What remains of the paper's two states and of chaos if the part is a flat block: numbers for the pages."""

from typing import Any

import numpy as np
import pandas as pd

from conveyor.parameters import length_scale
from conveyor_pipeline.machine.operating.body_limits import TILT
from conveyor_pipeline.machine.operating.populations import ENDS

# Parts have two velocities where the upper quantile is this many times the lower one, or the lower one is negative.
TWICE = 2.0


def two_velocities(rows: pd.DataFrame, name: str) -> list[float]:
    """The amplitudes (m/s²) at which parts have two velocities: points or flat blocks."""
    is_wide = rows[f"velocity_95_{name}"] > TWICE * rows[f"velocity_05_{name}"]
    return rows.acceleration[is_wide].round(1).tolist()


def beside_points(bodies: pd.DataFrame) -> pd.DataFrame:
    """The rows of points and of the flattest blocks by the amplitude, with the suffixes _point and _flat."""
    flat = bodies[bodies.height == bodies.height.min()]
    return bodies[bodies.length.isna()].merge(flat, on="acceleration", suffixes=("_point", "_flat"))


def compare_flat(bodies: pd.DataFrame) -> dict[str, Any]:
    """Points beside the flattest blocks of the table `operating/bodies`.

    Returns
    -------
    length and height of the blocks in mm; the amplitudes at which points and blocks have two velocities; `above`, the
    lowest amplitude beyond all of them; `faster`, least and largest relative difference of the medians from there on,
    `stderr`, its least and largest standard error, and the relative spreads there; `slow`, the largest relative
    difference of the lower quantiles where all blocks ride. None stands for what the table does not contain.
    """
    model = bodies.attrs["model"]
    rows = beside_points(bodies)
    length = length_scale(model)
    two = {"points": two_velocities(rows, "point"), "flat": two_velocities(rows, "flat")}
    chaos = rows[rows.acceleration.round(1) > max([*two["points"], *two["flat"]], default=0.0)]
    ratio = chaos.velocity_50_flat / chaos.velocity_50_point
    errors = (chaos[f"velocity_50_stderr_{name}"] / chaos[f"velocity_50_{name}"] for name in ("point", "flat"))
    stderr = ratio * np.hypot(*errors)
    riding = rows[(rows.rides_point > 0.0) & (rows.rides_flat == 1.0)]
    slow = riding.velocity_05_flat / riding.velocity_05_point - 1.0

    def spread(name: str) -> list[float]:
        width = chaos[f"velocity_95_{name}"] - chaos[f"velocity_05_{name}"]
        relative = width / chaos[f"velocity_50_{name}"]
        return [relative.min(), relative.max()]

    return {
        "length": 1e3 * length * rows.length_flat.iloc[0],
        "height": 1e3 * length * rows.length_flat.iloc[0] * rows.height_flat.iloc[0],
        "tilt": TILT,
        "ends": ENDS,
        "twice": TWICE,
        "two": two,
        "begins_later": bool(two["points"] and two["flat"] and min(two["flat"]) > min(two["points"])),
        "above": round(chaos.acceleration.min(), 1) if len(chaos) else None,
        "faster": [ratio.min() - 1.0, ratio.max() - 1.0] if len(chaos) else None,
        "stderr": [stderr.min(), stderr.max()] if len(chaos) else None,
        "spread_points": spread("point") if len(chaos) else None,
        "spread_flat": spread("flat") if len(chaos) else None,
        "slow": float(np.abs(slow).max()) if len(riding) else None,
    }
