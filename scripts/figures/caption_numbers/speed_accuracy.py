"""Numbers of the caption of the figure speed_accuracy."""

import numpy as np
import pandas as pd

from accuracy import speed
from accuracy.reference_check import DIGITS
from figures.plots.speed_accuracy import method_name


def numbers(
    *,
    jumping: pd.DataFrame,
    jumping_times: pd.DataFrame,
    reference: pd.DataFrame,
    paper_step: float,
    equal_error: float,
) -> dict:
    runs = speed.successful_runs(jumping, jumping_times)
    paper, *others = speed.factors(runs, paper_step, equal_error)
    difference = reference.difference.abs().max()
    return {
        "paper_run": paper,
        "rival": others[0] if others else None,
        "rival_name": method_name(others[0].method) if others else None,
        "missing": list(jumping[jumping.outcome == "not installed"].method.unique()),
        "difference": difference,
        "digits": DIGITS,
        "agreeing": int(-np.log10(difference)),
    }
