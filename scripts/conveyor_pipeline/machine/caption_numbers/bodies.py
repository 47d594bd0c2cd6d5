"""Numbers of the caption of the figure bodies."""

import math

import pandas as pd

from conveyor.parameters import length_scale
from conveyor_pipeline.common.templates import format_number
from conveyor_pipeline.machine.operating.body_limits import LONGEST, MOTIONS, PARTS, RIGHT, STATEMENT, TILT, TRACK
from conveyor_pipeline.machine.operating.populations import ENDS


def numbers(*, bodies: pd.DataFrame, shapes: pd.DataFrame) -> dict:
    settings = bodies.attrs
    model, size = settings["model"], shapes.difference.abs()
    largest = {motion: size[shapes.motion == motion].max() for motion in MOTIONS}
    statements = {
        motion: {
            "limit": f"{100.0 * limit:g}",
            "difference": None if math.isnan(largest[motion]) else 100.0 * largest[motion],
            "holds": bool(largest[motion] <= limit),
        }
        for motion, limit in STATEMENT.items()
    }
    right = [100.0 * (size[shapes.motion == motion] <= RIGHT).mean() for motion in MOTIONS]
    amplitudes = [shapes.acceleration[shapes.motion == motion].iloc[0] for motion in MOTIONS]
    return {
        "parts": max(4, round(settings["effort"] * PARTS)),
        "tilt": TILT,
        "ends": ENDS,
        "track": TRACK * length_scale(model),
        "longest": LONGEST / model["frequency"],
        "right": f"{100.0 * RIGHT:g}",
        "amplitudes": [format_number(amplitude) for amplitude in amplitudes],
        "enough": [f"{share:.0f}" for share in right],
        **statements,
    }
