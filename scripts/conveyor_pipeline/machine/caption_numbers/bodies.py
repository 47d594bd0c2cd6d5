"""Numbers of the caption of the figure bodies."""

import pandas as pd

from conveyor.parameters import length_scale
from conveyor_pipeline.common.templates import format_number
from conveyor_pipeline.machine.operating import body_limits as limits
from conveyor_pipeline.machine.operating.populations import ENDS


def verdict(difference: float, stderr: float, limit: float) -> str:
    """What a difference says about a statement that it is at most `limit`; empty if it agrees."""
    if difference <= limit:
        return ""
    return ", which does not decide it" if difference - 2.0 * stderr <= limit else ", so that it does not hold"


def numbers(*, bodies: pd.DataFrame, shapes: pd.DataFrame) -> dict:
    model, effort = bodies.attrs["model"], bodies.attrs["effort"]
    groups = {motion: shapes[shapes.motion == motion] for motion in limits.MOTIONS}
    statements = {}
    for motion, limit in limits.STATEMENT.items():
        sizes = groups[motion].difference.abs()
        statements[motion] = {"limit": f"{100.0 * limit:g}", "difference": None}
        if sizes.notna().any():
            difference, stderr = sizes.max(), groups[motion].difference_stderr[sizes.idxmax()]
            statements[motion] |= {"difference": 100.0 * difference, "stderr": 100.0 * stderr}
            statements[motion]["verdict"] = verdict(difference, stderr, limit)
    return {
        "parts": max(4, round(effort * limits.PARTS)),
        "points": max(4, round(effort * limits.POINTS)),
        "cells": [max(4, round(effort * limits.OF_A_CELL[motion])) for motion in limits.MOTIONS],
        "tilt": limits.TILT,
        "ends": ENDS,
        "track": limits.TRACK * length_scale(model),
        "longest": limits.LONGEST / model["frequency"],
        "right": f"{100.0 * limits.RIGHT:g}",
        "amplitudes": [format_number(rows.acceleration.iloc[0]) for rows in groups.values()],
        "enough": [f"{100.0 * (rows.difference.abs() <= limits.RIGHT).mean():.0f}" for rows in groups.values()],
        "errors": [f"{100.0 * rows.difference_stderr.median():.2g}" for rows in groups.values()],
        **statements,
    }
