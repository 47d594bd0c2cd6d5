"""Numbers of the caption of the figure throw."""

import numpy as np
import pandas as pd

from conveyor_pipeline.machine.figures.throw import proved_fold

TEXTBOOK_AGREES = 0.1  # largest relative difference from the textbook velocity that counts as agreement


def numbers(*, throws: pd.DataFrame, bifurcations: pd.DataFrame) -> dict:
    jumps = throws[(throws.state == "second") & (throws.vertical < 1.0)].groupby("conveyor", sort=False).vertical.min()
    likeliest = throws.loc[throws.groupby(["conveyor", "vertical"], sort=False).share.idxmax()]
    likeliest = likeliest[(likeliest.vertical > 1.0) & likeliest.textbook.notna()]
    close = (likeliest.mean_velocity - likeliest.textbook).abs() <= TEXTBOOK_AGREES * likeliest.textbook
    fold = proved_fold(throws, bifurcations)
    return {
        "jumps": jumps.to_dict(),
        "fold": None if np.isnan(fold) else fold,
        "within": TEXTBOOK_AGREES,
        "agree": close.groupby(likeliest.conveyor, sort=False).agg(["sum", "count"]).to_dict("index"),
    }
