"""Numbers of the caption of the figure work_precision."""

import pandas as pd

from accuracy import speed
from figures.plots.work_precision import NAMES, method_name


def independent_difference(work: pd.DataFrame) -> float:
    """Difference between the final states of the reference and of DOP853 with modes at its tightest tolerance."""
    runs = work[(work.method == "DOP853") & (work.treatment == "modes")]
    return float(runs.state_error[runs.tolerance.idxmin()])


def numbers(
    *,
    jumping: pd.DataFrame,
    riding: pd.DataFrame,
    bouncing: pd.DataFrame,
    jumping_times: pd.DataFrame,
    riding_times: pd.DataFrame,
    bouncing_times: pd.DataFrame,
) -> dict:
    works, times = (jumping, riding, bouncing), (jumping_times, riding_times, bouncing_times)
    comparisons = []
    for scene, work, seconds in zip(NAMES.values(), works, times, strict=True):
        paper, *others = speed.factors(speed.successful_runs(work, seconds))
        rival = others[0] if others else None
        comparisons.append((scene, paper, rival, rival and method_name(rival.method)))
    return {
        "comparisons": comparisons,
        "equal_error": speed.EQUAL_ERROR,
        "difference": max(map(independent_difference, works)),
    }
