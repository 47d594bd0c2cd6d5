"""Numbers of the caption of the figure fit_valley."""

import numpy as np
import pandas as pd

from conveyor_pipeline.paper.claims.about_states import flat_part
from conveyor_pipeline.paper.fit.hyperbola import Hyperbola, critical_height


def numbers(*, fit: pd.DataFrame) -> dict[str, float]:
    flat = flat_part(fit)
    amplitudes = np.linspace(*fit.attrs["acceleration"], 200)
    heights = [critical_height(amplitudes, Hyperbola(row.A, row.B, row.C)) for row in flat.itertuples()]
    return {"apart": 1e6 * np.ptp(heights, axis=0).max(), "factor": flat.A.max() / flat.A.min()}
