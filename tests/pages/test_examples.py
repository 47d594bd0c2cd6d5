"""The Python sessions on pages of the site print what the pages show."""

import doctest
import re

import pytest
from project import ROOT

PAGES = ("tutorial", "library")


@pytest.mark.parametrize("page", PAGES)
def test_sessions_print_what_the_page_shows(page):
    text = (ROOT / f"docs/guides/{page}.md").read_text(encoding="utf-8")
    sessions = re.findall(r"^```pycon\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert sessions
    # One session: later blocks use the names of earlier ones.
    test = doctest.DocTestParser().get_doctest("\n".join(sessions), {}, page, None, None)
    assert doctest.DocTestRunner().run(test).failed == 0


def test_the_machine_of_the_tutorial_is_the_one_whose_chart_it_shows():
    page = (ROOT / "docs/guides/tutorial.md").read_text(encoding="utf-8")
    (overlay,) = re.findall(r"^```yaml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    assert overlay == (ROOT / "docs/guides/feeder.yaml").read_text(encoding="utf-8")
