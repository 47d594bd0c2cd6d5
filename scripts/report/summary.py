"""The start page of the report, the table of claims and the provenance."""

import json
import re
from collections import Counter

import pandas as pd
from markdown_it import MarkdownIt
from markupsafe import Markup

from claims.finding import format_interval
from claims.verdicts import VERDICTS
from report.page import render

LISTS = ("quantities", "paper", "paper_method", "converged", "accepted_low", "accepted_high", "because")


def describe_claim(row: pd.Series) -> dict:
    """The fields of a claim in the templates, with one entry per quantity."""
    # A claim that does not concern a method has no numbers by it.
    columns = {name: list(row[name]) or [None] * len(row.quantities) for name in LISTS}
    quantities = [dict(zip(LISTS, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    for quantity in quantities:
        quantity["name"] = quantity["quantities"]
        quantity["accepted"] = format_interval(quantity["accepted_low"], quantity["accepted_high"])
    reason = None if pd.isna(row.reason) else row.reason
    return {name: row[name] for name in ("id", "where", "statement", "verdict")} | {
        "quantities": quantities,
        "reason": reason,
    }


def count_verdicts(found: pd.Series) -> str:
    """The number of verdicts of each kind, in words."""
    counts = Counter(found)
    parts = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS)
    return f"{len(found)} statements of the paper: {parts}"


def link(file: str, place: str, text: str) -> Markup:
    """A link to a place on another page of the report."""
    view = f"{{content: 'html', contentPath: results['{file}'].data_uri + '#{place}'}}"
    return Markup('<a href="javascript:app.setView({})">{}</a>').format(Markup(view), text)


def link_findings(findings: str, pages: list[dict], claims_page: str) -> Markup:
    """The findings, in Markdown, as HTML with links to the figures and claims of the report.

    The file name of a figure that is not in the report stays as it is.
    """
    files = {figure["name"]: page["file"] for page in pages for figure in page["figures"]}

    def link_figure(found: re.Match) -> str:
        name = found[1]
        return link(files[name], name, name) if name in files else found[0]

    def link_claim(found: re.Match) -> str:
        return link(claims_page, found[1], found[1])

    html = re.sub(r"<code>figures/(\w+)\.pdf</code>", link_figure, MarkdownIt().render(findings))
    return Markup(re.sub(r'<a href="docs/claims.md">(\w+)</a>', link_claim, html))


def make(
    claims: pd.DataFrame,
    provenance: str,
    step: float,
    pages: list[dict],
    files: dict[str, str],
    notice: dict[str, str],
    findings: str = "",
) -> dict[str, str]:
    """The start page, the claims and the provenance, by name.

    Parameters
    ----------
    claims : the table of claims
    provenance : as JSON
    step : of the paper's method, s
    pages : the pages of figures in order, with `heading`, `file` and `figures`: name, number and title of each
    files : files of the other pages by name
    notice : heading and text on top of each page; empty for the paper's config
    findings : findings beyond the paper, a list in Markdown
    """
    shared = {
        "notice": notice,
        "claims": [describe_claim(row) for _, row in claims.iterrows()],
        "counted": count_verdicts(claims.verdict),
        "origin": json.loads(provenance),
    }
    links = {f"{name}_page": file for name, file in files.items()}
    linked = link_findings(findings, pages, files["claims"])
    return {
        "summary": render(
            "summary.html", step_us=f"{1e6 * step:g}", pages=pages, findings=linked, link=link, **links, **shared
        ),
        "claims": render("claims.html", title="The paper's statements", **shared),
        "provenance": render("provenance.html", title="Provenance", **shared),
    }
