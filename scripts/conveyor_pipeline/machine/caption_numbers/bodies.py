"""Numbers of the caption of the figure bodies."""

import pandas as pd

from conveyor.parameters import length_scale
from conveyor_pipeline.common.templates import format_number
from conveyor_pipeline.machine.operating.body_limits import (
    LONGEST,
    MOTIONS,
    OF_A_CELL,
    PARTS,
    POINTS,
    RIGHT,
    STATEMENT,
    TILT,
    TRACK,
)
from conveyor_pipeline.machine.operating.populations import ENDS


def verdict(difference: float, stderr: float, limit: float) -> str:
    """What a difference says about a statement that it is at most `limit`; empty if it agrees."""
    if difference <= limit:
        return ""
    return ", which does not decide it" if difference - 2.0 * stderr <= limit else ", so that it does not hold"


def numbers(*, bodies: pd.DataFrame, shapes: pd.DataFrame) -> dict:
    settings = bodies.attrs
    model, effort = settings["model"], settings["effort"]
    size = shapes.difference.abs()
    statements = {}
    for motion, limit in STATEMENT.items():
        rows = shapes[shapes.motion == motion]
        statements[motion] = {"limit": f"{100.0 * limit:g}", "difference": None}
        if rows.difference.notna().any():
            largest = rows.loc[rows.difference.abs().idxmax()]
            statements[motion] |= {
                "difference": 100.0 * abs(largest.difference),
                "stderr": 100.0 * largest.difference_stderr,
                "verdict": verdict(abs(largest.difference), largest.difference_stderr, limit),
            }
    errors = [100.0 * shapes.difference_stderr[shapes.motion == motion].median() for motion in MOTIONS]
    right = [100.0 * (size[shapes.motion == motion] <= RIGHT).mean() for motion in MOTIONS]
    amplitudes = [shapes.acceleration[shapes.motion == motion].iloc[0] for motion in MOTIONS]
    return {
        "parts": max(4, round(effort * PARTS)),
        "points": max(4, round(effort * POINTS)),
        "cells": [max(4, round(effort * OF_A_CELL[motion])) for motion in MOTIONS],
        "tilt": TILT,
        "ends": ENDS,
        "track": TRACK * length_scale(model),
        "longest": LONGEST / model["frequency"],
        "right": f"{100.0 * RIGHT:g}",
        "amplitudes": [format_number(amplitude) for amplitude in amplitudes],
        "enough": [f"{share:.0f}" for share in right],
        "errors": [f"{error:.2g}" for error in errors],
        **statements,
    }
