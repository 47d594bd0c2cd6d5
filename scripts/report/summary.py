"""The start page of the report, the table of claims and the provenance."""

import json
import re
from collections import Counter

import pandas as pd
from markdown_it import MarkdownIt
from markupsafe import Markup

from claims import verdicts
from report.page import render

LISTED = ("quantities", "paper", "paper_method", "converged", "accepted_low", "accepted_high", "because")


def claim(row: pd.Series) -> dict:
    """A row of the table of claims, its quantities one by one."""
    count = len(row.quantities)
    # A method that has no say has no numbers.
    columns = {name: list(row[name]) or [None] * count for name in LISTED}
    quantities = [dict(zip(LISTED, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    for one in quantities:
        one["name"] = one["quantities"]
        one["accepted"] = verdicts.interval(one["accepted_low"], one["accepted_high"])
    reason = None if pd.isna(row.reason) else row.reason
    return {name: row[name] for name in ("id", "where", "statement", "verdict")} | {
        "quantities": quantities,
        "reason": reason,
    }


def counted(found: pd.Series) -> str:
    """How many verdicts there are of each kind, in words."""
    counts = Counter(found)
    kinds = (verdicts.REPRODUCED, verdicts.PAPER_METHOD_ONLY, verdicts.NOT_REPRODUCED)
    parts = ", ".join(f"{counts[kind]} {kind}" for kind in kinds)
    return f"{len(found)} statements of the paper: {parts}"


def link(file: str, place: str, text: str) -> Markup:
    """A link to a place on another page of the report."""
    view = f"{{content: 'html', contentPath: results['{file}'].data_uri + '#{place}'}}"
    return Markup('<a href="javascript:app.setView({})">{}</a>').format(Markup(view), text)


def linked(findings: str, pages: list[dict], claims_page: str) -> Markup:
    """What was found, in Markdown, with links to the figures and claims of the report.

    A figure that the report does not have stays the name of a file.
    """
    files = {figure["name"]: page["file"] for page in pages for figure in page["figures"]}

    def figure(found: re.Match) -> str:
        name = found[1]
        return link(files[name], name, name) if name in files else found[0]

    def claim_of(found: re.Match) -> str:
        return link(claims_page, found[1], found[1])

    html = re.sub(r"<code>figures/(\w+)\.pdf</code>", figure, MarkdownIt().render(findings))
    return Markup(re.sub(r'<a href="docs/claims.md">(\w+)</a>', claim_of, html))


def make(
    claims: pd.DataFrame,
    provenance: str,
    step: float,
    pages: list[dict],
    files: dict[str, str],
    told: dict[str, str],
    findings: str = "",
) -> dict[str, str]:
    """The start page, the claims and the provenance, by their names.

    Parameters
    ----------
    claims : the table of claims
    provenance : as JSON
    step : of the paper's method, s
    pages : of the figures, in their order, with `heading`, `file` and `figures`: name, number and title of each
    files : of the other pages, by their names
    told : what stands on top, heading and text; nothing for the paper's config
    findings : what was found beyond the paper, a list in Markdown
    """
    shared = {
        "told": told,
        "claims": [claim(row) for _, row in claims.iterrows()],
        "counted": counted(claims.verdict),
        "origin": json.loads(provenance),
    }
    links = {f"{name}_page": file for name, file in files.items()}
    found = linked(findings, pages, files["claims"])
    return {
        "summary": render(
            "summary.html", step_us=f"{1e6 * step:g}", pages=pages, findings=found, link=link, **links, **shared
        ),
        "claims": render("claims.html", title="The paper's statements", **shared),
        "provenance": render("provenance.html", title="Provenance", **shared),
    }
