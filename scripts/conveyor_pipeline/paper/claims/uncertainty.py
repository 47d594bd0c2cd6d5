"""Uncertainty of the numbers of the paper's statements: their change with tighter tolerances."""

import json
import math

import pandas as pd

from conveyor_pipeline.paper.claims import verdicts


def differences(current: list[float], tighter: list[float]) -> list[float | None]:
    """The absolute change of each number; None if one of the two is NaN."""
    differences = [abs(before - after) for before, after in zip(current, tighter, strict=True)]
    return [None if math.isnan(value) else value for value in differences]


def make(settings: dict, references: list[str], read: list[pd.DataFrame], claims: pd.DataFrame) -> str:
    """The change of each converged number, and whether the verdict stays the same, by statement, as JSON.

    settings : `claims`, which refer to tables with tighter tolerances
    references, read : names of these tables, SECTION/NAME, and the tables
    claims : the table of all claims at the usual tolerances
    """
    tables = dict(zip(references, read, strict=True))
    before = claims.set_index("id")
    by_claim = {}
    for name, claim in settings["claims"].items():
        finding = verdicts.evaluate(claim, tables)
        tighter = verdicts.numbers(finding.converged, claim["quantities"])
        changes = differences(before.converged[name], tighter)
        same_verdict = verdicts.verdict(finding, claim["quantities"]) == before.verdict[name]
        by_claim[name] = {"changes": changes, "same_verdict": same_verdict}
    return json.dumps(by_claim, indent=1)
