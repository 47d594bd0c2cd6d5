"""Texts avoid some phrases that hide who acts, or leave out a noun.

A line that needs such a phrase, because it quotes or names something, has the mark ALLOWED in a comment.
"""

import re
from pathlib import Path

import pytest
from project import ROOT

ALLOWED = "plain-english: ok"
# Each with a plain alternative.
PHRASES = {
    r"\b(is|are|was|were|be) told\b": "say who says it, or 'is determined'",
    r"\b(made|drawn) anew\b": "'made again', 'recomputed'",
    r"\bof those\b": "name them",
    r"\bof the starts\b": "'of the initial conditions'",
    r"\bthat which\b|\bthat of what\b": "use the noun",
    r"\b(once|long) wanted\b": "'goal'",
    r"\bis no(t)? more than that it\b": "say what it is",
    r"\bstands? (below|beside|above) (it|them|each)\b": "name the place",
    r"\b(holds?|stands?) (good )?of its\b": "use the noun",
    r"\bwhat is up to date\b": "'unchanged results'",
    r"\bwas meant otherwise\b": "'is wrong'",
    r"\bof one's own\b": "'your own'",
    r"\bhardly determined\b": "'poorly determined'",
    r"\bit is told by\b|\btold by what\b": "'is determined from'",
    r"\bfor ever\b": "'without end'",
    r"\bnot content\b": "say what is wrong",
    r"\bwith every bit as before\b": "'bit for bit identical'",
    r"\bnobody (gave|gives|says|looked)\b": "say what is missing",
    r"\bbesides? what\b": "name it",
}
# Pages, captions, messages, config, and the docstrings and comments of all scripts and tests but this one.
READ = [
    *(
        ROOT / file
        for file in (
            "README.md",
            ".ci/run",
            "CHANGELOG.md",
            "CONTRIBUTING.md",
            "config/README.md",
            "scripts/conveyor/README.md",
        )
    ),
    *sorted((ROOT / "config").rglob("*.yaml")),
    *sorted((ROOT / "workflow/report").glob("*.rst")),
    *sorted((ROOT / "workflow/templates").glob("*.*")),
    *sorted((ROOT / "workflow/templates/site").glob("*.md")),
    *sorted((ROOT / "workflow/rules").glob("*.smk")),
    *sorted((ROOT / "workflow/config").glob("*.py")),
    *sorted((ROOT / "scripts/report").glob("*.html")),
    *sorted((ROOT / "scripts").rglob("*.py")),
    *sorted(file for file in (ROOT / "tests").rglob("*.py") if file != Path(__file__)),
]


def old_phrases(text: str) -> list[str]:
    """The phrases to avoid in a text, except in marked lines; a phrase may continue on the next line."""
    kept = " ".join(line.strip(" #") for line in text.splitlines() if ALLOWED not in line)
    return [found[0] for pattern in PHRASES for found in re.finditer(pattern, kept, re.IGNORECASE)]


@pytest.mark.parametrize("file", READ, ids=lambda file: file.name)
def test_texts_are_in_plain_english(file: Path):
    assert old_phrases(file.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "text",
    ["A unit that was meant otherwise is told before", "all figures are made\nanew", "the largest of those"],
)
def test_a_planted_phrase_is_found(text):
    assert old_phrases(text)


def test_a_marked_line_is_allowed():
    assert old_phrases(f"the title is told <!-- {ALLOWED} -->") == []
