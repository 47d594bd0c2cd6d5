"""Numbers of the caption of the figure bifurcation."""

import pandas as pd

from conveyor_pipeline.paper.claims.about_states import find_runs, format_runs
from conveyor_pipeline.paper.orbits.limits import MOST_ORBITS, SIGNIFICANT


def is_chaotic(spectrum: pd.DataFrame) -> pd.Series:
    """Whether the exponent of each motion is significantly positive."""
    return spectrum.lambda_1 > SIGNIFICANT * spectrum.stderr


def accumulation(*, spectrum: pd.DataFrame, cascade: pd.DataFrame) -> dict:
    """Where the period doublings accumulate, and where motions are chaotic before it and regular behind it."""
    limits = cascade.accumulation.dropna()
    if limits.empty:
        return {"accumulation": None}
    place = limits.iloc[-1]
    runs = {}
    for branch, rows in spectrum.sort_values("acceleration", kind="stable").groupby("branch"):
        early = rows[rows.acceleration < place]
        runs[branch] = find_runs(early.acceleration, is_chaotic(early))
    late = spectrum[spectrum.acceleration > place].sort_values("acceleration", kind="stable")
    regular = (late.lambda_1 < -SIGNIFICANT * late.stderr).groupby(late.acceleration).all()
    return {
        "accumulation": place,
        "is_beyond": place > spectrum.acceleration.max(),
        "early_up": format_runs(runs["up"], 2) if runs.get("up") else "nowhere",
        "early_down": format_runs(runs["down"], 2) if runs.get("down") else "nowhere",
        "regular_share": regular.mean(),
    }


def numbers(
    *, spectrum: pd.DataFrame, branches: pd.DataFrame, cascade: pd.DataFrame, bifurcations: pd.DataFrame
) -> dict:
    return accumulation(spectrum=spectrum, cascade=cascade) | {
        "orbits": len(branches) > 0,
        "bends": bifurcations.kind.isin(("fold", "period_doubling")).any(),
        "most": MOST_ORBITS,
        "ended": (branches.cycle == 1).sum() >= MOST_ORBITS,
    }
