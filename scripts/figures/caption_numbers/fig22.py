"""Numbers of the caption of the figure fig22."""

import pandas as pd

from claims.about_chaos import positive_onset, with_settled_motion
from figures.caption_numbers.bifurcation import is_chaotic


def numbers(
    *, converged: pd.DataFrame, spectrum: pd.DataFrame, states: pd.DataFrame, euler: pd.DataFrame | None = None
) -> dict[str, float]:
    settled = with_settled_motion(converged, states)
    positive = settled[settled["lambda"] > 0.0]
    counts = {"positive": len(positive), "periodic": int((positive.period > 0).sum())}
    if euler is None:
        return counts
    up = spectrum[(spectrum.branch == "up")].sort_values("acceleration", kind="stable")
    joined = pd.merge_asof(
        converged.sort_values("acceleration", kind="stable"),
        up[["acceleration", "lambda_1"]].assign(chaotic=is_chaotic(up)),
        on="acceleration",
        direction="nearest",
    )
    joined = joined[joined.chaotic]
    return counts | {
        "lowest_chaos": settled[settled.chaotic].acceleration.min(),
        "euler_positive": positive_onset(euler),
        "converged_positive": positive_onset(converged),
        "plateau": joined["lambda"].median(),
        "truth": joined.lambda_1.median(),
    }
