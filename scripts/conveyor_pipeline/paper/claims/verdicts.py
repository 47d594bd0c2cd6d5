"""The paper's checkable statements: numbers by both methods, and the verdicts that follow from them."""

import importlib
import math
from collections.abc import Callable

import pandas as pd
import pyarrow as pa

from conveyor_pipeline.common import fields, tables
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.figures.titles import package_of
from conveyor_pipeline.paper.claims.finding import METHODS, Finding, format_interval

TABLES = {
    "claims": (
        fields.text("id", "name of the statement"),
        fields.text("where", "where the paper makes it"),
        fields.text("statement", "the statement in words"),
        fields.several("quantities", pa.string(), "", "names of its quantities, with units"),
        fields.several("paper", pa.float64(), "see quantities", "the paper's numbers; null where it gives none"),
        fields.several("paper_method", pa.float64(), "see quantities", "by the paper's method; empty if not concerned"),
        fields.several("converged", pa.float64(), "see quantities", "converged; empty if the statement is about Euler"),
        fields.several("accepted_low", pa.float64(), "see quantities", "smallest accepted numbers; null for no bound"),
        fields.several("accepted_high", pa.float64(), "see quantities", "largest accepted numbers; null for no bound"),
        fields.several("because", pa.string(), "", "reasons for the accepted intervals"),
        fields.text("verdict", "reproduced, reproduced by the paper's method only, or not reproduced"),
        fields.text("reason", "computed reason of any verdict other than reproduced; otherwise a note; null for none"),
    ),
}

REPRODUCED = "reproduced"
PAPER_METHOD_ONLY = "reproduced by the paper's method only"
NOT_REPRODUCED = "not reproduced"
VERDICTS = (REPRODUCED, PAPER_METHOD_ONLY, NOT_REPRODUCED)
# Columns of the table with one entry per quantity.
PER_QUANTITY = ("paper", "paper_method", "converged", "accepted_low", "accepted_high", "because")


def finding_of(claim: dict) -> Callable[..., Finding]:
    """The function that a claim names as `finding`; its module is in the folder `claims` of any floor."""
    module, function = claim["finding"].split(".")
    return getattr(importlib.import_module(f"{package_of(module, 'claims')}.{module}"), function)


def evaluate(claim: dict, read: dict[str, pd.DataFrame]) -> Finding:
    """The Finding of a claim, from the tables by reference."""
    tables_by_role = {role: read[reference] for role, reference in claim["tables"].items()}
    return finding_of(claim)(**tables_by_role, **claim.get("settings", {}))


def is_accepted(value: float, accepted: list[float | None]) -> bool:
    """Whether a value lies in its accepted interval; None is no bound."""
    low, high = accepted
    return not math.isnan(value) and (low is None or value >= low) and (high is None or value <= high)


def all_accepted(values: dict[str, float], quantities: dict[str, dict]) -> bool:
    """Whether each quantity lies in its interval; KeyError for a missing one."""
    return all(is_accepted(values[name], quantity["accepted"]) for name, quantity in quantities.items())


def verdict(finding: Finding, quantities: dict[str, dict]) -> str:
    """The verdict by the converged numbers, or by the paper's method if there are no converged ones."""
    by_paper = bool(finding.euler) and all_accepted(finding.euler, quantities)
    if all_accepted(finding.converged, quantities) if finding.converged else by_paper:
        return REPRODUCED
    return PAPER_METHOD_ONLY if by_paper else NOT_REPRODUCED


def describe_misses(finding: Finding, quantities: dict[str, dict]) -> str:
    """The quantities outside their accepted interval, in words."""
    texts = []
    for name, quantity in quantities.items():
        values = {method: getattr(finding, method)[name] for method in METHODS if getattr(finding, method)}
        misses = [
            f"{value:.4g} by the {METHODS[method]}"
            for method, value in values.items()
            if not is_accepted(value, quantity["accepted"])
        ]
        if misses:
            texts.append(
                f"{quantity['is']}: {' and '.join(misses)}; accepted: {format_interval(*quantity['accepted'])}"
            )
    return "; ".join(texts)


def numbers(values: dict[str, float], quantities: dict[str, dict]) -> list[float]:
    """The numbers by one method in the order of the quantities; empty if the statement does not concern the method."""
    return [values[name] for name in quantities] if values else []


def row(name: str, claim: dict, finding: Finding) -> dict:
    """The row of a claim."""
    quantities = claim["quantities"]
    result = verdict(finding, quantities)
    misses = "" if result == REPRODUCED else describe_misses(finding, quantities)
    return {
        "id": name,
        "where": claim["where"],
        "statement": claim["statement"],
        "quantities": [quantity["is"] for quantity in quantities.values()],
        "paper": [quantity["paper"] for quantity in quantities.values()],
        "paper_method": numbers(finding.euler, quantities),
        "converged": numbers(finding.converged, quantities),
        "accepted_low": [quantity["accepted"][0] for quantity in quantities.values()],
        "accepted_high": [quantity["accepted"][1] for quantity in quantities.values()],
        "because": [quantity["because"] for quantity in quantities.values()],
        "verdict": result,
        "reason": ". ".join(filter(None, (misses, finding.note))) or None,
    }


def columns(claims: dict[str, dict], findings: dict[str, Finding]) -> dict[str, list]:
    """The columns of the table of claims."""
    return fields.columns([row(name, claim, findings[name]) for name, claim in claims.items()], TABLES["claims"])


def describe_claims(claims: pd.DataFrame) -> list[dict]:
    """The rows of the table of claims for templates; `quantities` has a mapping for each quantity.

    Its keys are `name` and the columns with one entry per quantity. Numbers and texts that a claim does not have are
    None.
    """
    described = []
    for row in claims.to_dict("records"):
        # A claim that does not concern a method has no numbers by it.
        columns = {name: list(row[name]) or [None] * len(row["quantities"]) for name in PER_QUANTITY}
        quantities = [
            {"name": name, **dict(zip(columns, values, strict=True))}
            for name, *values in zip(row["quantities"], *columns.values(), strict=True)
        ]
        described.append(row | {"quantities": quantities, "reason": None if pd.isna(row["reason"]) else row["reason"]})
    return described


def report(template: str, rows: pd.DataFrame) -> str:
    """The page of claims."""
    values = {
        "rows": rows.to_dict("records"),
        "explained": rows.dropna(subset="reason").to_dict("records"),
        "reproduced": REPRODUCED,
        "interval": format_interval,
    }
    return render(template, values)


def make(settings: dict, references: list[str], template: str, read: list[pd.DataFrame]) -> dict:
    """The columns of the table of claims, and its page; `references` are the names of the tables, SECTION/NAME."""
    tables_by_name = dict(zip(references, read, strict=True))
    findings = {name: evaluate(claim, tables_by_name) for name, claim in settings["claims"].items()}
    made = columns(settings["claims"], findings)
    rows = tables.make("claims", TABLES["claims"], made, settings).to_pandas()
    return {"claims": made, "report": report(template, rows)}
