"""Article and site, made by `snakemake article site`: links and pictures, in a wide and a narrow browser.

CONVEYOR_RESULTS names the folder of the results; by default it is the folder of the paper's results.
"""

import os
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from browser import chromium
from project import ROOT, read_config

from conveyor_pipeline.figures.titles import title_of
from conveyor_pipeline.pages import article
from conveyor_pipeline.paper.claims.statements import read_claims

RESULTS = ROOT / os.environ.get("CONVEYOR_RESULTS", "results")
SITE = RESULTS / "site"
PAGES = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html"))
CONFIG = read_config()
WIDE, NARROW = (1600, 900), (360, 740)
# The interactive page has separate tests.
OWN = [page for page in PAGES if page not in ("companion.html", "search.html", "genindex.html", "py-modindex.html")]


class Links(HTMLParser):
    """Addresses of the links of a page, and the places in it to which links may point."""

    def __init__(self, text: str):
        super().__init__()
        self.found, self.places = [], set()
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.found.append(value)
            elif name in ("id", "name") and value:
                self.places.add(value)


@pytest.fixture(scope="module")
def links() -> dict[str, Links]:
    return {page: Links((SITE / page).read_text(encoding="utf-8")) for page in PAGES}


def broken(page: str, links: dict[str, Links]) -> list[str]:
    """The links of a page that point to a missing file or place of the site."""
    found = []
    for link in links[page].found:
        address = urlsplit(link)
        if address.scheme or address.netloc:
            continue
        target = Path(os.path.normpath((SITE / page).parent / unquote(address.path) if address.path else SITE / page))
        name = os.path.relpath(target, SITE)
        places = links[name].places if name in links else {unquote(address.fragment)}
        if not target.is_file() or (address.fragment and unquote(address.fragment) not in places):
            found.append(link)
    return found


def test_all_pages_are_there():
    wanted = {f"{path.stem}.html" for path in (ROOT / "workflow/rules/pages/site").glob("*.md")}
    guides = {f"guides/{path.stem}.html" for path in (ROOT / "docs/guides").glob("*.md")}
    assert wanted | guides | {"article.html", "companion.html"} <= set(PAGES)


@pytest.mark.parametrize("page", OWN)
def test_links_are_not_broken(page, links):
    assert broken(page, links) == []


def test_every_figure_and_claim_is_shown(links):
    figures = (SITE / "figures.html").read_text(encoding="utf-8")
    for name in CONFIG["figures"]:
        assert (SITE / f"_images/{name}.png").is_file()
        assert (SITE / f"figures/{name}.pdf").is_file()
        assert f"_images/{name}.png" in figures
        assert title_of(name).replace("'", "’").split("’")[0] in figures
    assert {claim.lower() for claim in read_claims()} <= links["claims.html"].places


def test_the_article_shows_all_figures_of_the_paper():
    text = (RESULTS / "article/article.md").read_text(encoding="utf-8")
    for number in range(1, 25):
        assert f"**Fig. {number}.**" in text
        assert f"fig{number:02d}.pdf)" in text
    for claim in read_claims():
        assert f"\n| {claim} |" in text
    assert "\n| everything | " in text  # the cost of the build


def test_the_article_is_made_from_its_text(monkeypatch):
    monkeypatch.chdir(ROOT)
    frame = (ROOT / "workflow/rules/pages/article.typ").read_text(encoding="utf-8")
    text = (RESULTS / "article/article.md").read_text(encoding="utf-8")
    assert (RESULTS / "article.pdf").read_bytes() == article.typeset(text, frame)


@pytest.fixture(scope="module")
def driver(tmp_path_factory):
    driver = chromium(tmp_path_factory.mktemp("profile"))
    yield driver
    driver.quit()


UNSEEN = "return [...document.images].filter((image) => !image.naturalWidth).map((image) => image.src)"
OVERFLOW = "return document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("page", OWN)
def test_pages_open_wide_and_narrow_without_an_error(page, size, driver):
    width, height = size
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": size == NARROW}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    driver.get((SITE / page).as_uri())
    assert driver.execute_script(OVERFLOW) <= 0
    assert driver.execute_script(UNSEEN) == []
    assert driver.get_log("browser") == []
