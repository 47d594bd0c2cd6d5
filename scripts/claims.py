"""Rule claims: the paper's checkable statements, what both methods give, and verdicts that follow from the numbers."""

import math

import numpy as np
import pandas as pd

from conveyor import tables
from findings import chaos, states
from findings.finding import Finding
from rule_log import logged

FINDINGS = {
    "C01": states.critical_acceleration,
    "C02": states.interval,
    "C03": states.onset_of_chaos,
    "C04": states.largest_critical_height,
    "C05": states.first_velocity,
    "C06": states.second_velocity,
    "C07": states.critical_height(40.0),
    "C08": states.critical_height(35.0),
    "C09": states.fit,
    "C10": states.interval,
    "C11": states.one_onset,
    "C12": states.impact_line,
    "C13": states.vertical_lines,
    "C14": states.horizontal_lines,
    "C15": chaos.no_period,
    "C16": chaos.irregular,
    "C17": states.overlap,
    "C18": chaos.height_estimate,
    "C19": chaos.phase_estimate,
    "C20": chaos.portraits,
    "C21": chaos.predicted_onset,
    "C22": states.euler_error,
    "C23": states.mapped,
}
REPRODUCED = "reproduced"
PUBLISHED_ONLY = "reproduced by the published method only"
NOT_REPRODUCED = "not reproduced"


def holds(values: tuple[float, ...], accepted: list[list[float | None]]) -> bool:
    """Whether every value lies in its accepted interval; null is no bound."""
    return all(
        (low is None or value >= low) and (high is None or value <= high) and not math.isnan(value)
        for value, (low, high) in zip(values, accepted, strict=True)
    )


def verdict(finding: Finding, accepted: list[list[float | None]]) -> str:
    """What the numbers say: the converged ones decide, those of the published method where there are no others."""
    published = bool(finding.published) and holds(finding.published, accepted)
    if holds(finding.converged, accepted) if finding.converged else published:
        return REPRODUCED
    return PUBLISHED_ONLY if published else NOT_REPRODUCED


def outside(finding: Finding, claim: dict) -> str:
    """Which quantities miss their accepted interval, in numbers."""
    texts = []
    for method, values in (("published method", finding.published), ("converged solution", finding.converged)):
        for value, interval, quantity in zip(values, claim["accepted"], claim["quantities"], strict=bool(values)):
            if not holds((value,), [interval]):
                texts.append(f"{quantity}: {value:.4g} by the {method} is not in {written(interval)}")
    return "; ".join(texts)


def written(interval: list[float | None]) -> str:
    low, high = interval
    return f"[{'-∞' if low is None else f'{low:.4g}'}, {'∞' if high is None else f'{high:.4g}'}]"


def columns(claims: dict[str, dict], found: dict[str, Finding]) -> dict[str, list]:
    """The columns of the table of claims."""
    verdicts = [verdict(found[name], claim["accepted"]) for name, claim in claims.items()]
    reasons = [
        "; ".join(filter(None, ("" if result == REPRODUCED else outside(found[name], claim), found[name].reason)))
        or None
        for result, (name, claim) in zip(verdicts, claims.items(), strict=True)
    ]
    return {
        "id": list(claims),
        **{name: [claim[name] for claim in claims.values()] for name in ("where", "statement", "quantities", "paper")},
        "published": [list(found[name].published) for name in claims],
        "converged": [list(found[name].converged) for name in claims],
        "accepted_low": [[low for low, _ in claim["accepted"]] for claim in claims.values()],
        "accepted_high": [[high for _, high in claim["accepted"]] for claim in claims.values()],
        "verdict": verdicts,
        "reason": reasons,
    }


def schema(reference: str) -> str:
    """The schema of the table SECTION/NAME; those of the sections `results` and `orbits` have one of their own each."""
    section, name = reference.split("/")
    return name if section in ("results", "orbits") else section


def report(rows: pd.DataFrame) -> str:
    """The table in Markdown."""

    def numbers(values) -> str:
        return ", ".join("–" if value is None or np.isnan(value) else f"{value:.4g}" for value in values) or "–"

    lines = [
        "# The paper's statements",
        "",
        "Each verdict follows from the numbers: `reproduced` if the converged ones lie in the accepted intervals (the "
        "published method's, where the statement is about the method), else `reproduced by the published method only` "
        "or `not reproduced`. What each number is, and why its interval is as wide as it is, says the section `claims` "
        "of the config.",
        "",
        "| | Where | Statement | Quantities | Paper | Published method | Converged | Accepted | Verdict |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows.itertuples():
        accepted = "; ".join(
            written([None if low is None or np.isnan(low) else low, None if high is None or np.isnan(high) else high])
            for low, high in zip(row.accepted_low, row.accepted_high, strict=True)
        )
        lines.append(
            f"| {row.id} | {row.where} | {row.statement} | {'; '.join(row.quantities)} | {numbers(row.paper)} "
            f"| {numbers(row.published)} | {numbers(row.converged)} | {accepted} | **{row.verdict}** |"
        )
    told = rows.dropna(subset="reason")
    for title, part in (("Reasons", told[told.verdict != REPRODUCED]), ("Notes", told[told.verdict == REPRODUCED])):
        lines += ["", f"## {title}", "", *(f"- **{row.id}** {row.reason}." for row in part.itertuples())]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        claims = snakemake.params.claims
        paths = dict(zip(snakemake.params.references, snakemake.input, strict=True))
        read = {reference: tables.read(path, schema(reference)) for reference, path in paths.items()}
        found = {
            name: FINDINGS[name]({role: read[reference] for role, reference in claim["tables"].items()})
            for name, claim in claims.items()
        }
        tables.write(snakemake.output.table, "claims", columns(claims, found), settings={"claims": claims})
        with open(snakemake.output.report, "w", encoding="utf-8") as file:
            file.write(report(tables.read(snakemake.output.table, "claims")))
