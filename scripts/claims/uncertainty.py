"""How sure the numbers of the paper's statements are: by how much tighter tolerances change them."""

import json
import math

import pandas as pd

from claims import verdicts


def differences(now: list[float], tighter: list[float]) -> list[float | None]:
    """By how much each number changes; None where one of both is none."""
    found = [abs(one - other) for one, other in zip(now, tighter, strict=True)]
    return [None if math.isnan(value) else value for value in found]


def make(settings: dict, references: list[str], read: list[pd.DataFrame], claims: pd.DataFrame) -> str:
    """Differences of the converged numbers, and the verdict by the tighter ones, of each statement, as JSON.

    Parameters
    ----------
    settings : `claims`, entries of the config whose tables are those of tighter tolerances
    references, read : these tables with their names, SECTION/NAME
    claims : the table of all claims as they are
    """
    tables = dict(zip(references, read, strict=True))
    before = claims.set_index("id")
    found = {}
    for name, claim in settings["claims"].items():
        finding = verdicts.find(claim, tables)
        now = before.loc[name, "converged"]
        tighter = [finding.converged[quantity] for quantity in claim["quantities"]] if finding.converged else []
        verdict = verdicts.verdict(finding, claim["quantities"])
        found[name] = {"changes": differences(now, tighter), "same_verdict": verdict == before.verdict[name]}
    return json.dumps(found, indent=1)
