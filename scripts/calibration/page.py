"""The calibration in words, with all numbers from the tables."""

import numpy as np
import pandas as pd

from calibration.inference import DETERMINED, NOT_DETERMINED, OPEN, TOO_FEW, UNLIKELY
from pipeline.templates import render

WORST = 8  # rows that are named
# Names of the parameters in sentences.
NAMES = {"friction": "friction coefficient", "damping": "contact damping", "stiffness": "contact stiffness"}
WORTH = 0.02  # expected narrowing from which one more measurement is recommended


def make(
    template: str,
    parameters: pd.DataFrame,
    fit: pd.DataFrame,
    prediction: pd.DataFrame,
    next: pd.DataFrame,
    prefix: str,
) -> str:
    """The page from its template and the tables of the calibration."""
    rows = [
        {**row, "name": NAMES.get(row["parameter"], row["parameter"].replace("_", " "))}
        for row in parameters.replace({np.nan: None}).to_dict("records")
    ]
    best = next.loc[next.narrowing.idxmax()]
    worst = fit.sort_values("p_row").head(WORST)
    bands = prediction.assign(width=prediction.high - prediction.low)
    return render(
        template,
        {
            "settings": parameters.attrs,
            "prefix": prefix,
            "parameters": rows,
            "by_status": {
                status: [row for row in rows if row["status"] == status]
                for status in (DETERMINED, OPEN, NOT_DETERMINED)
            },
            "reliable": not (parameters.status == TOO_FEW).any(),
            "effective": float(parameters.effective.iloc[0]),
            "explained": bool(fit.explained.all()),
            "p_value": float(fit.p_value.iloc[0]),
            "count": len(fit),
            "unlikely": UNLIKELY,
            "misfits": int((~fit.fits).sum()),
            "worst": worst[~worst.fits].sort_values("line").to_dict("records"),
            "widest": bands.loc[bands.width.idxmax()].to_dict(),
            "prediction": prediction.to_dict("records"),
            "next": {"acceleration": float(best.acceleration), "narrowing": float(best.narrowing)},
            "worth": bool(best.narrowing >= WORTH),
            "next_by_name": {row["name"]: float(best[f"narrowing_{row['parameter']}"]) for row in rows},
        },
    )
