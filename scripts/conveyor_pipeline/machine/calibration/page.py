"""The calibration in words, with all numbers from the tables."""

import math

import numpy as np
import pandas as pd

from conveyor_pipeline.common.templates import format_significant, render
from conveyor_pipeline.machine.calibration.credible_intervals import CONFIDENCE
from conveyor_pipeline.machine.calibration.effort import EFFECTIVE, sizes_of
from conveyor_pipeline.machine.calibration.inference import (
    CYCLES,
    DETERMINED,
    INFLATIONS,
    NOT_CONVERGED,
    NOT_DETERMINED,
    OPEN,
    REPEATABLE,
    ROUGH,
)
from conveyor_pipeline.machine.calibration.likelihood import OUTLIERS
from conveyor_pipeline.machine.calibration.measurements import DEFAULTS, first_comments
from conveyor_pipeline.machine.calibration.model_check import DECISIVE, SIGNIFICANCE, UNLIKELY

WORST = 8  # rows that are named
SHOWN = 9  # amplitudes in the table of predicted velocities
# Names of the parameters in sentences.
NAMES = {"friction": "friction coefficient", "damping": "contact damping", "stiffness": "contact stiffness"}
CONSTANTS = {"confidence": CONFIDENCE, "decisive": DECISIVE, "outliers": OUTLIERS, "significance": SIGNIFICANCE}
CONSTANTS |= {"cycles": CYCLES, "inflation": INFLATIONS[ROUGH]}
WORTH = 0.02  # expected narrowing from which one more measurement is recommended


def power_of_ten(decades: float) -> str:
    """A factor in words, from its decimal logarithm; factors that no reader compares are powers of ten."""
    return format_significant(10.0**decades, 2) if abs(decades) < 3.0 else f"10^{decades:.0f}"


def make(
    template: str,
    parameters: pd.DataFrame,
    fit: pd.DataFrame,
    alternatives: pd.DataFrame,
    prediction: pd.DataFrame,
    next: pd.DataFrame,
    measurements: str,
    prefix: str,
) -> str:
    """The page from its template, the tables of the calibration and the text of the file of measurements."""
    settings = parameters.attrs | sizes_of(parameters.attrs["effort"]) | CONSTANTS
    of_search = {
        "settings": settings,
        "comments": first_comments(measurements),
        "effective": float(parameters.effective.iloc[0]),
        "searches": int(parameters.searches.iloc[0]),
        "needed": EFFECTIVE,
        "repeatable": REPEATABLE,
        "converged": not (parameters.status == NOT_CONVERGED).any(),
        "count": len(fit),
    }
    if not of_search["converged"]:
        return render(template, of_search)
    rows = [
        {**row, "name": NAMES.get(row["parameter"], row["parameter"].replace("_", " "))}
        for row in parameters.replace({np.nan: None}).to_dict("records")
    ]
    decades = alternatives.log_bayes_factor / math.log(10.0)
    alternative_rows = (
        alternatives.assign(factor=["" if math.isnan(exponent) else power_of_ten(exponent) for exponent in decades])
        .sort_values("log_bayes_factor", ascending=False, kind="stable")
        .to_dict("records")
    )
    best = next.loc[next.narrowing.idxmax()]
    worst = fit.sort_values("p_row", kind="stable").head(WORST)
    bands = prediction.assign(width=prediction.high - prediction.low)
    shown = np.unique(np.linspace(0, len(prediction) - 1, SHOWN).round().astype(int))
    return render(
        template,
        of_search
        | {
            "prefix": prefix,
            "parameters": rows,
            "by_status": {
                status: [row for row in rows if row["status"] == status]
                for status in (DETERMINED, OPEN, NOT_DETERMINED)
            },
            "explained": bool(fit.explained.all()),
            "fits": bool(fit.p_value.iloc[0] >= SIGNIFICANCE),
            "alternatives": alternative_rows,
            "preferred": [row for row in alternative_rows if row["preferred"]],
            "p_value": float(fit.p_value.iloc[0]),
            "changed": int(fit.changed.sum()),
            "defaults": DEFAULTS,
            "unlikely": UNLIKELY,
            "misfits": int((~fit.fits).sum()),
            "worst": worst[~worst.fits].sort_values("line", kind="stable").to_dict("records"),
            "step": 0.0 if len(prediction) < 2 else float(prediction.acceleration.diff().max()),
            "widest": bands.loc[bands.width.idxmax()].to_dict(),
            "prediction": prediction.iloc[shown].to_dict("records"),
            "next": {"acceleration": float(best.acceleration), "narrowing": float(best.narrowing)},
            "worth": bool(best.narrowing >= WORTH),
            "next_by_name": {row["name"]: float(best[f"narrowing_{row['parameter']}"]) for row in rows},
        },
    )
