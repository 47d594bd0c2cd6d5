"""The page of the simulation study of the calibration."""

import math

import numpy as np
import pandas as pd
from scipy.stats import chi2

from calibration import study
from calibration.credible_intervals import CONFIDENCE
from calibration.model_check import DECISIVE, SIGNIFICANCE
from calibration.study import COMPARED, MANY, NARROW, PARAMETERS, RIGHT
from pipeline.templates import render

# Parameters whose logarithmic likelihood is smaller than that of the true ones by no more than this are in the
# confidence region (likelihood ratio).
ALLOWED = 0.5 * chi2.ppf(0.95, len(PARAMETERS))


def summarize(kind: str, sets: pd.DataFrame) -> dict:
    """Coverage, widths and errors of the data sets of one kind."""
    reliable = sets.dropna(subset=[f"{name}_low" for name in PARAMETERS])
    row = {"kind": kind, "sets": len(sets), "reliable": len(reliable), "rejected": int((~sets.explained).sum())}
    widths = {
        name: 0.5 * (reliable[f"{name}_high"] - reliable[f"{name}_low"]) / reliable[f"{name}_best"]
        for name in PARAMETERS
    }
    narrow = (widths["friction"] <= NARROW) & (widths["damping"] <= NARROW)
    row["narrow"], row["wide"] = int(narrow.sum()), int((~narrow).sum())
    row["left_open"] = int((reliable.gain_of_distant[~narrow] >= -ALLOWED).sum())
    for name in PARAMETERS:
        true, best, low, high = (reliable[f"{name}{ending}"] for ending in ("", "_best", "_low", "_high"))
        row[name] = {
            "covered": int(((low <= true) & (true <= high)).sum()),
            "width": float(widths[name].median()),
            "error": float(np.abs(best / true - 1.0).median()),
        }
    return row | {
        "decades": [float(end) / math.log(10.0) for end in (sets.gain_of_truth.min(), sets.gain_of_truth.max())],
        "covered": sum(row[name]["covered"] for name in PARAMETERS),
        "in_band": float(sets.in_band.mean()),
    }


def make(template: str, calibration_study: pd.DataFrame) -> str:
    """The page from its template and the table of the study."""
    by_kind = dict(list(calibration_study.groupby("kind", sort=False)))
    return render(
        template,
        {
            "conveyors": study.CONVEYORS,
            "throw_number": study.THROW_NUMBER,
            "amplitudes": study.AMPLITUDES,
            "poor": study.POOR,
            "noise": calibration_study.attrs["calibration"]["noise"],
            "confidence": CONFIDENCE,
            "significance": SIGNIFICANCE,
            "decisive": DECISIVE,
            "parts": study.PARTS,
            "differences": study.WRONG,
            "count": len(calibration_study),
            "narrow": NARROW,
            "many": MANY,
            "compared": COMPARED,
            "right": [summarize(kind, by_kind[kind]) for kind in RIGHT if kind in by_kind],
            "wrong": [summarize(kind, sets) for kind, sets in by_kind.items() if kind not in RIGHT],
        },
    )
