"""The start page of the report, the table of claims and the provenance."""

import json
import re

import pandas as pd
from markdown_it import MarkdownIt
from markupsafe import Markup

from claims.finding import format_interval
from claims.verdicts import VERDICTS, describe_claims
from report.page import render


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
    notice : `overlays`, sweep `points` of this config, and `paper_points` of the paper's config; {} without overlays
    findings : findings beyond the paper, a list in Markdown
    """
    shared = {
        "notice": notice,
        "claims": describe_claims(claims),
        "verdicts": VERDICTS,
        "interval": format_interval,
        "origin": json.loads(provenance),
    }
    links = {f"{name}_page": file for name, file in files.items()}
    linked = link_findings(findings, pages, files["claims"])
    return {
        "summary": render("summary.html", step=step, pages=pages, findings=linked, link=link, **links, **shared),
        "claims": render("claims.html", title="The paper's statements", **shared),
        "provenance": render("provenance.html", title="Provenance", **shared),
    }
