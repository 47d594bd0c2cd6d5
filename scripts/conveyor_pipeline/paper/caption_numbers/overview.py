"""Numbers of the caption of the figure overview."""

import pandas as pd

from conveyor_pipeline.paper.caption_numbers.fig22 import describe_exceptions
from conveyor_pipeline.paper.claims.about_chaos import positive_onset
from conveyor_pipeline.paper.claims.about_proofs import lowest_fold


def numbers(*, bifurcations: pd.DataFrame, estimate: pd.DataFrame) -> dict[str, float | str]:
    return {
        "fold": lowest_fold(bifurcations),
        "euler_positive": positive_onset(estimate),
        "exceptions": describe_exceptions(estimate),
    }
