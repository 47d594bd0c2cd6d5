"""The paper's checkable statements, what both methods give, and verdicts that follow from the numbers."""

import math
from collections.abc import Iterable

import pandas as pd
import pyarrow as pa

from claims import about_chaos, about_states
from claims.finding import METHODS, Finding
from pipeline import fields, tables
from pipeline.templates import render

TABLES = {
    "claims": (
        fields.text("id", "name of the statement"),
        fields.text("where", "where the paper makes it"),
        fields.text("statement", "what it says"),
        fields.several("quantities", pa.string(), "", "what its numbers are, with units"),
        fields.several("paper", pa.float64(), "see quantities", "the paper's numbers; null where it gives none"),
        fields.several(
            "paper_method",
            pa.float64(),
            "see quantities",
            "by the paper's method, computed here; empty where it has no say",
        ),
        fields.several("converged", pa.float64(), "see quantities", "converged; empty where the statement is on Euler"),
        fields.several("accepted_low", pa.float64(), "see quantities", "least numbers that bear it out; null for none"),
        fields.several("accepted_high", pa.float64(), "see quantities", "largest ones; null for none"),
        fields.several("because", pa.string(), "", "why the accepted numbers are these"),
        fields.text("verdict", "reproduced, reproduced by the paper's method only, or not reproduced"),
        fields.text("reason", "computed reason of any other verdict than reproduced; else a note, null for none"),
    ),
}

# Where the functions stand that the claims of the config name.
FINDINGS = {"about_chaos": about_chaos, "about_states": about_states}
REPRODUCED = "reproduced"
PAPER_METHOD_ONLY = "reproduced by the paper's method only"
NOT_REPRODUCED = "not reproduced"
NAMES = {"euler": "paper's method", "converged": "converged solution"}


def find(claim: dict, read: dict[str, pd.DataFrame]) -> Finding:
    """The Finding of a claim of the config, from the tables by their references."""
    module, function = claim["finding"].split(".")
    tables_by_role = {role: read[reference] for role, reference in claim["tables"].items()}
    return getattr(FINDINGS[module], function)(**tables_by_role, **claim.get("settings", {}))


def holds(value: float, accepted: list[float | None]) -> bool:
    """Whether a value lies in its accepted interval; null is no bound."""
    low, high = accepted
    return not math.isnan(value) and (low is None or value >= low) and (high is None or value <= high)


def all_hold(values: dict[str, float], quantities: dict[str, dict]) -> bool:
    """Whether each quantity lies in its interval; KeyError for one that is missing."""
    return all(holds(values[name], quantity["accepted"]) for name, quantity in quantities.items())


def verdict(finding: Finding, quantities: dict[str, dict]) -> str:
    """What the numbers say: the converged ones decide, those of the paper's method where there are no others."""
    by_paper = bool(finding.euler) and all_hold(finding.euler, quantities)
    if all_hold(finding.converged, quantities) if finding.converged else by_paper:
        return REPRODUCED
    return PAPER_METHOD_ONLY if by_paper else NOT_REPRODUCED


def outside(finding: Finding, quantities: dict[str, dict]) -> str:
    """Which quantities miss their accepted interval, in numbers."""
    texts = []
    for method in METHODS:
        for name, value in getattr(finding, method).items():
            quantity = quantities[name]
            if not holds(value, quantity["accepted"]):
                texts.append(
                    f"{quantity['is']}: {value:.4g} by the {NAMES[method]} is not in {written(quantity['accepted'])}"
                )
    return "; ".join(texts)


def written(interval: list[float | None]) -> str:
    low, high = interval
    return f"[{'-∞' if low is None else f'{low:.4g}'}, {'∞' if high is None else f'{high:.4g}'}]"


def interval(low: float | None, high: float | None) -> str:
    """An accepted interval of the table of claims, in which NaN, too, is no bound."""
    return written([None if bound is None or math.isnan(bound) else bound for bound in (low, high)])


def columns(claims: dict[str, dict], found: dict[str, Finding]) -> dict[str, list]:
    """The columns of the table of claims."""
    quantities = [claim["quantities"] for claim in claims.values()]
    verdicts = [verdict(found[name], claim["quantities"]) for name, claim in claims.items()]
    reasons = [
        "; ".join(filter(None, ("" if result == REPRODUCED else outside(found[name], one), found[name].note))) or None
        for result, name, one in zip(verdicts, claims, quantities, strict=True)
    ]

    def listed(of) -> list[list]:
        return [[of(quantity) for quantity in one.values()] for one in quantities]

    def numbers(method: str) -> list[list[float]]:
        values = [getattr(found[name], method) for name in claims]
        return [[of[name] for name in one] if of else [] for of, one in zip(values, quantities, strict=True)]

    return {
        "id": list(claims),
        **{name: [claim[name] for claim in claims.values()] for name in ("where", "statement")},
        "quantities": listed(lambda quantity: quantity["is"]),
        "paper": listed(lambda quantity: quantity["paper"]),
        "paper_method": numbers("euler"),
        "converged": numbers("converged"),
        "accepted_low": listed(lambda quantity: quantity["accepted"][0]),
        "accepted_high": listed(lambda quantity: quantity["accepted"][1]),
        "because": listed(lambda quantity: quantity["because"]),
        "verdict": verdicts,
        "reason": reasons,
    }


def numbers(values: Iterable[float | None]) -> str:
    """Numbers of a claim in a cell of the page, with dashes for missing ones."""
    return ", ".join("–" if value is None or math.isnan(value) else f"{value:.4g}" for value in values) or "–"


def report(template: str, rows: pd.DataFrame) -> str:
    """The table of claims as a page."""
    values = {
        "rows": rows.to_dict("records"),
        "explained": rows.dropna(subset="reason").to_dict("records"),
        "reproduced": REPRODUCED,
        "numbers": numbers,
        "interval": interval,
    }
    return render(template, values)


def make(settings: dict, references: list[str], template: str, read: list[pd.DataFrame]) -> dict:
    """The columns of the table of claims and the page, from the tables that `references` name as SECTION/NAME."""
    tables_by_name = dict(zip(references, read, strict=True))
    found = {name: find(claim, tables_by_name) for name, claim in settings["claims"].items()}
    made = columns(settings["claims"], found)
    rows = tables.make("claims", TABLES["claims"], made, settings).to_pandas()
    return {"claims": made, "report": report(template, rows)}
