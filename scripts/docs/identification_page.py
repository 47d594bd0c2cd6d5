"""The page on the parameters that the paper's numbers imply."""

import math

import numpy as np
import pandas as pd

from calibration import paper_findings as findings
from calibration.credible_intervals import CONFIDENCE
from calibration.edges import contacts_of
from calibration.importance_sampling import covariance
from calibration.paper_numbers import PARAMETERS
from calibration.paper_posterior import EVIDENCE
from claims.finding import format_interval
from pipeline.templates import render

SURE = 0.95  # probability from which a treatment of tension is identifiable


def correlations(samples: pd.DataFrame, evidence: str) -> dict[str, float]:
    """Correlation of the logarithm of the stiffness with the logarithm of each parameter, in one set of evidence."""
    rows = samples[samples.evidence == evidence]
    matrix = covariance(np.log(rows[list(PARAMETERS)].to_numpy()), (rows.weight / rows.weight.sum()).to_numpy())
    stiffness = list(PARAMETERS).index("stiffness")
    scaled = matrix[stiffness] / np.sqrt(np.diag(matrix) * matrix[stiffness, stiffness])
    return dict(zip(PARAMETERS, scaled, strict=True))


def make(
    template: str,
    numbers: pd.DataFrame,
    fits: pd.DataFrame,
    intervals: pd.DataFrame,
    samples: pd.DataFrame,
    frictions: pd.DataFrame,
) -> str:
    """The page from its template and the tables in results/identification."""
    settings = fits.attrs
    paper, triple = settings["numbers"], settings["measured"]["triple"]
    misfits = numbers.pivot(index="number", columns="set", values="misfit")
    shown = numbers[numbers["set"] != "interpolated"]
    left_out = fits[fits.evidence == "end_left_out"].set_index("tension")
    fitted = [name for name in paper if name not in EVIDENCE["end_left_out"]["without"]]
    values = {
        "settings": settings,
        "coarse": settings["effort"] < findings.ENOUGH,
        "confidence": 100.0 * CONFIDENCE,
        "contacts": contacts_of(settings["effort"]) ** 2,
        "format_interval": format_interval,
        "parameters": list(PARAMETERS),
        "numbers": {name: rows.to_dict("records") for name, rows in shown.groupby("number", sort=False)},
        "interpolation": (misfits.interpolated - misfits.converged).abs().max(),
        "up": paper[findings.UP_ALONE]["paper"],
        "down": paper[findings.DOWN_ALONE]["paper"],
        "widening": findings.contradiction(paper),
        "zero": -triple["A"] / triple["C"] - triple["B"],
        "accepted": findings.accepted_frictions(frictions, paper),
        "fits": fits.assign(printed_rise=fits.printed_total - fits.groupby("evidence").total.transform("min")).to_dict(
            "records"
        ),
        "factor": math.sqrt(fits[fits.evidence == "all"].scale.iloc[0]),
        "intervals": {name: rows.to_dict("records") for name, rows in intervals.groupby("evidence", sort=False)},
        "searches": samples.search.nunique(),
        "valley": correlations(samples, "end_left_out"),
        "left_out": left_out.to_dict("index") | {"worst": misfits.end_left_out[fitted].abs().max()},
        "identifiable": left_out.share.max() >= SURE,
    }
    return render(template, values)
