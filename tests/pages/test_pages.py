"""Article, site and README: all numbers come from tables, and a page that cannot be made says why."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from project import ROOT, read_config
from prose import typed

from conveyor_pipeline.common.templates import render
from conveyor_pipeline.pages import article, facts, pages, site
from conveyor_pipeline.pages.config_keys import parse_file
from conveyor_pipeline.paper.claims.verdicts import NOT_REPRODUCED, PAPER_METHOD_ONLY, REPRODUCED, describe_claims

TEMPLATES = ROOT / "workflow/rules/pages"
FRAME = (TEMPLATES / "article.typ").read_text(encoding="utf-8")
# Pages with results; numbers in examples for users are not results.
PROSE = [
    TEMPLATES / "README.md",
    TEMPLATES / "article.md",
    *sorted((TEMPLATES / "site").glob("*.md")),
    *sorted((ROOT / "docs/guides").glob("*.md")),
]
KEPT = ("README.md", "metadata.yaml", "codecheck.yml")
FIGURES = read_config()["figures"]
CONFIG = [str(file) for file in sorted((ROOT / "config/defaults").rglob("*.yaml"))]

# -- no result is typed ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("template", PROSE, ids=lambda path: path.stem)
def test_no_number_of_a_page_is_typed(template):
    assert typed(template.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "text",
    [
        "accumulate at 62.77 m/s²",
        "$\\hat a = 62.77$",
        "$$\nz_0 = 31\n$$",
        "a share of `0.6` %",
        "fifty amplitudes",
        "C19 says 59",
    ],
)
def test_a_planted_result_is_found(text):
    article = (TEMPLATES / "article.md").read_text(encoding="utf-8")
    assert len(typed(f"{article}\nThe doublings {text}.\n")) == 1


@pytest.mark.parametrize(
    "text", ["see Figs. 13 and 18", "$\\omega^2 t_1$", "{{ fold }} m/s²", "`results/claims/C07.md`"]
)
def test_references_and_formulas_are_not_results(text):
    assert typed(text) == []


@pytest.mark.parametrize("name", KEPT)
def test_kept_pages_are_their_templates_filled(name):
    """The kept page equals its template, except for the fields."""
    template = (TEMPLATES / name).read_text(encoding="utf-8")
    parts = re.split(r"(\{% if.*?endif %\}|\{\{.*?\}\}|\{%.*?%\})", template, flags=re.DOTALL)
    kept = (ROOT / name).read_text(encoding="utf-8")
    if name == "codecheck.yml":
        assert re.findall(r"figures/(\w+)\.pdf", kept) == list(FIGURES)
        return
    text, place = "".join(kept.split()), 0
    for part in parts:
        if part[:2] not in ("{{", "{%"):
            words = "".join(part.split())
            assert words in text[place:], part
            place = text.index(words, place) + len(words)


# -- the facts ---------------------------------------------------------------------------------------------------------


def claim(verdict: str, low: float, high: float, value: float) -> dict:
    """A row of the table of claims with one quantity."""
    return {
        "id": "C07",
        "where": "Fig. 10",
        "statement": "a height",
        "quantities": ["height in mm"],
        "paper": [0.07],
        "paper_method": [],
        "converged": [value],
        "accepted_low": [low],
        "accepted_high": [high],
        "because": ["a digit"],
        "verdict": verdict,
        "reason": None,
    }


@pytest.mark.parametrize(
    ("low", "high", "value", "accepted", "margin"),
    [
        (0.065, 0.075, 0.072, "0.065 to 0.075", "0.003"),
        (0.065, 0.075, 0.08, "0.065 to 0.075", "-0.005"),
        (np.nan, 0.075, 0.07, "at most 0.075", "0.005"),
        (2.0, np.nan, 21.0, "at least 2", "19"),
        (0.065, 0.075, np.nan, "0.065 to 0.075", "–"),
    ],
)
def test_a_margin_is_the_distance_to_the_nearer_end(low, high, value, accepted, margin):
    (row,) = describe_claims(pd.DataFrame([claim(REPRODUCED, low, high, value)]))
    pages.add_uncertainty({"C07": row}, {})
    template = "{{ interval(accepted_low, accepted_high) }}; {{ margin | number }}; {{ paper_method | number }}"
    text = render(template, row["quantities"][0] | {"interval": facts.describe_interval})
    assert text == f"{accepted}; {margin}; –"


def test_verdicts_are_counted():
    table = pd.DataFrame(
        {"id": ["C01", "C02", "C03", "C04"], "verdict": [REPRODUCED, NOT_REPRODUCED, NOT_REPRODUCED, PAPER_METHOD_ONLY]}
    )
    found = facts.names_by_verdict(table)
    assert found == {"reproduced": ["C01"], "by_paper": ["C04"], "not_reproduced": ["C02", "C03"]}
    assert render("{{ not_reproduced | length }} ({{ not_reproduced | listed }})", found) == "2 (C02 and C03)"


def test_claims_with_limits_that_were_set_late_are_named():
    reasons = [["half a unit", "as above"], ["a line hides it; set when the numbers were known", "as above"]]
    assert facts.late_limits(pd.DataFrame({"id": ["C01", "C02"], "because": reasons})) == ["C02"]


def test_two_stable_motions_coexist_where_two_orbits_are_proved():
    """At 40 m/s², two orbits are stable; at 50 m/s², only one of two; at 60 m/s², two enclosures may hold one orbit."""
    orbits = pd.DataFrame(
        [
            (40.0, "stable", 1.0, 1.1, True),
            (40.0, "stable", 2.0, 2.1, True),
            (50.0, "stable", 1.0, 1.1, True),
            (50.0, "unstable", 2.0, 2.1, True),
            (60.0, "stable", 1.0, 1.1, True),
            (60.0, "stable", 1.05, 1.2, False),
        ],
        columns=["acceleration", "stability", "contact_time_low", "contact_time_high", "contained"],
    )
    bifurcations = pd.DataFrame(
        [
            ("fold", 24.0, True),
            ("fold", 23.0, False),
            ("period_doubling", 54.0, True),
            ("period_doubling", 56.0, False),
        ],
        columns=["kind", "acceleration_low", "proved"],
    )
    chaos = pd.DataFrame({"acceleration": [60.0, 70.0], "proved": [False, True]})
    found = facts.summarize_proofs(orbits, bifurcations, chaos)
    assert list(found["both_stable"]) == [40.0]
    assert (found["fold"], found["doublings_proved"], list(found["chaos_proved"])) == (24.0, 1, [70.0])
    assert (found["orbits_tried"], found["orbits_proved"]) == (6, 5)


# -- the config, key by key --------------------------------------------------------------------------------------------


def test_comments_belong_to_their_keys():
    text = '# file\n\nfirst:   # beside "first"\n  # above\n  # it\n  second: "a # b"   # c\n  third: {x: 1}   # d\n'
    found = list(parse_file(text))
    assert [tuple(key) for key in found] == [
        (("first",), "", 'beside "first"', ""),
        (("first", "second"), '"a # b"', "c", "above it"),
        (("first", "third"), "{x: 1}", "d", ""),
        (("first", "third", "x"), "1", "", ""),
    ]


def test_values_that_the_paper_leaves_open_are_found():
    found = pages.find_gaps([key for file in CONFIG for key in parse_file(Path(file).read_text(encoding="utf-8"))])
    assert {"model.gravity", "sweeps.amplitudes.axes.acceleration", "estimates.phase.epsilon"} <= {
        gap["key"] for gap in found
    }
    assert all(gap["comment"] for gap in found)


# -- media -------------------------------------------------------------------------------------------------------------

FIGURE = {"name": "fig02", "label": "Fig. 2", "title": "A part"}


def test_a_caption_has_its_subscripts_in_both_media():
    caption = "The mass m\\ :sub:`p` at\nthe height z\\ :sub:`s`."
    assert pages.to_markdown(caption, "print") == "The mass m~p~ at the height z~s~."
    assert pages.to_markdown(caption, "site") == "The mass m{sub}`p` at the height z{sub}`s`."


def test_an_article_without_its_figure_is_an_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Exception, match=r"fig99\.pdf"):
        article.typeset("# A title\n\n![a figure](/figures/fig99.pdf)\n", FRAME)


@pytest.fixture
def source(tmp_path):
    """A folder of pages for a small site."""
    folder = tmp_path / "source"
    folder.mkdir()
    return folder


def put(folder, text: str) -> None:
    """One page, index.md."""
    page = folder.parent / "index.md"
    page.write_text(text, encoding="utf-8")
    style = folder.parent / "site.css"
    style.write_text("", encoding="utf-8")
    site.gather(str(folder), {"": [str(page)]}, str(style), [], {"": []})


def test_a_broken_link_is_an_error(source, tmp_path):
    put(source, "# A page\n\n[there](nowhere.md)\n")
    with pytest.raises(RuntimeError, match=r"nowhere\.md"):
        site.build(str(source), str(tmp_path / "html"))


def test_formulas_need_no_network(source, tmp_path):
    put(source, "# A page\n\n$\\ddot z_p = -g$\n")
    site.build(str(source), str(tmp_path / "html"))
    page = (tmp_path / "html/index.html").read_text(encoding="utf-8")
    assert "<math" in page
    assert not re.search(r"(?:src|href)=\"https?://", page.split("<footer")[0])


def test_the_article_shows_every_figure_of_the_paper_once_and_in_order():
    text = (TEMPLATES / "article.md").read_text(encoding="utf-8")
    shown = re.findall(r'figure\("(fig\d\d)"\)', text)
    assert shown == [name for name in FIGURES if re.fullmatch(r"fig\d\d", name)]


def test_parts_travel_most_evenly_from_an_amplitude_on():
    """With an onset of chaos at 25 m/s²: at 30 m/s² parts are less even than at 20 m/s²."""
    varied = pd.DataFrame({"acceleration": [10.0, 20.0, 30.0, 40.0, 50.0], "spread": [1.0, 0.6, 0.9, 0.3, 0.5]})
    assert facts.evenest_from(varied, 25.0) == 40.0
    assert facts.evenest_from(varied.assign(spread=[0.1, 0.6, 0.9, 0.3, 0.5]), 25.0) is None
