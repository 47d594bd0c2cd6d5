"""Numbers of the caption of the figure fig22."""

import math

import pandas as pd

from conveyor_pipeline.paper.caption_numbers.bifurcation import is_chaotic
from conveyor_pipeline.paper.claims.about_chaos import join_nearest, positive_onset, with_settled_motion


def describe_exceptions(table: pd.DataFrame) -> str:
    """At how many amplitudes from the onset on the estimate is not positive, in words; empty for none."""
    above = table[table.acceleration >= positive_onset(table)]
    count = int((above["lambda"] <= 0.0).sum())
    return f", with exceptions at {count} of {len(above)} amplitudes" if count else ""


def numbers(
    *, converged: pd.DataFrame, spectrum: pd.DataFrame, states: pd.DataFrame, euler: pd.DataFrame
) -> dict[str, float | str | None]:
    settled = with_settled_motion(converged, states)
    positive = settled[settled["lambda"] > 0.0]
    counts = {"positive": len(positive), "periodic": int((positive.period > 0).sum())}
    up = spectrum[spectrum.branch == "up"]
    joined = join_nearest(converged, up[["acceleration", "lambda_1"]].assign(chaotic=is_chaotic(up)))
    joined = joined[joined.chaotic]
    begin, end = positive_onset(euler), positive_onset(converged)
    between = states[states.acceleration.between(begin, end, inclusive="left")]
    rides = len(between) > 0 and (between.state == "first").all()
    return counts | {
        "lowest_chaos": settled[settled.chaotic].acceleration.min(),
        "longest_flight": between.longest_flight.max() if rides else None,
        "euler_positive": begin,
        "euler_exceptions": describe_exceptions(euler),
        "converged_positive": end,
        "converged_exceptions": describe_exceptions(converged),
        "time_shift": converged.attrs["epsilon"] / (2.0 * math.pi * converged.attrs["model"]["frequency"]),
        "plateau": joined["lambda"].median(),
        "truth": joined.lambda_1.median(),
    }
