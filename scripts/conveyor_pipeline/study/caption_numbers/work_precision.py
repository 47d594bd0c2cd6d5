"""Numbers of the caption of the figure work_precision."""

import pandas as pd

from conveyor_pipeline.study.accuracy import speed
from conveyor_pipeline.study.figures.work_precision import NAMES, method_name


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
        runs = speed.successful_runs(work, seconds)
        paper, *others = speed.factors(runs)
        comparisons.append((scene, paper, speed.fastest_fixed_steps(runs), others[0] if others else None))
    return {
        "comparisons": comparisons,
        "method_name": method_name,
        "equal_error": speed.EQUAL_ERROR,
        "difference": max(speed.independent_run(work).state_error for work in works),
    }
