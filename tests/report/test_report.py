"""The report: what a reader sees in a browser, with verdicts and captions beside their statements and figures."""

import base64
import io
import json
import re
import time

import numpy as np
import pandas as pd
import pytest
from browser import chromium
from PIL import Image
from project import FIGURES
from selenium.webdriver.common.by import By

from claims import verdicts
from claims.finding import Finding
from figures.titles import title_of
from pipeline import tables
from report import figure_pages, summary

QUANTITY = {"is": "height in mm", "paper": 2.0, "accepted": [None, 2.5], "because": "<as read>"}
CLAIM = {"where": "Fig. 9", "statement": "It is low & small", "quantities": {"height": QUANTITY}}
FOUND = {
    "C01": Finding({"height": 1.75}, {"height": 2.25}),
    "C02": Finding({"height": 2.125}, {"height": 7.0}),
    "C03": Finding({}, {"height": 8.0}, "it is not"),
}
ORIGIN = {
    "commit": "abc",
    "clean": False,
    "config_sha256": "0123456789abcdef",
    "made": "2026-01-01T00:00:00+00:00",
    "system": "Linux",
    "processor": "one",
    "processors": 2,
    "threads": 1,
    "costs": {
        "figures": {"seconds": 4.0, "compiling": 0.0, "memory": 300.0, "jobs": 2},
        "everything": {"seconds": 4.0, "compiling": 0.0, "memory": 300.0, "jobs": 2},
    },
    "versions": ["numpy==1.0"],
}
PAGES = [
    {"heading": "Section 3", "file": "a.html", "figures": [{"name": "fig03", "number": "Fig. 3", "title": "A"}]},
]
FINDINGS = "- **Two exist**, &\n  low (`figures/fig03.pdf`, [C02](docs/claims.md)).\n- None (`figures/fig99.pdf`).\n"
NOTICE = {"overlays": ["my.yaml", "b.yaml"], "points": 1000, "paper_points": 2000}


def of_claims() -> pd.DataFrame:
    claims = dict.fromkeys(FOUND, CLAIM)
    made = verdicts.columns(claims, FOUND)
    return tables.make("claims", verdicts.TABLES["claims"], made, {"claims": claims}).to_pandas()


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    files = {name: f"{name}.html" for name in ("claims", "provenance")}
    return summary.make(of_claims(), json.dumps(ORIGIN), 5e-7, PAGES, files, NOTICE, FINDINGS)


def cells(page: str, place: str) -> list[str]:
    """The texts of the cells of a statement."""
    part = page.split(f'id="{place}"')[1].split("</tbody>")[0]
    return [re.sub(r"<[^>]+>", "", cell).strip() for cell in re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", part, re.DOTALL)]


def test_claims_have_their_numbers_verdicts_and_reasons(pages):
    text = "It is low &amp; small (Fig. 9)"
    accepted = "[-∞, 2.5]: &lt;as read&gt;"
    assert cells(pages["claims"], "C01") == ["C01", text, "height in mm", "2", "1.75", "2.25", accepted, "reproduced"]
    only = cells(pages["claims"], "C02")
    assert only[4:6] == ["2.125", "7"]
    assert only[7] == "reproduced by the paper&#39;s method only"
    assert only[9] == "height in mm: 7 by the converged solution; accepted: [-∞, 2.5]."
    # A method that a claim does not concern has no number.
    assert cells(pages["claims"], "C03")[4:6] == ["–", "8"]
    assert "it is not." in cells(pages["claims"], "C03")[9]


def test_the_start_page_counts_the_verdicts_and_names_the_config(pages):
    start = pages["summary"]
    counted = "3 statements of the paper: 1 reproduced, 1 reproduced by the paper&#39;s method only, 1 not reproduced"
    assert counted in start
    made = "Made with my.yaml, b.yaml: coarse axes, 1,000 sweep points instead of 2,000."
    assert 0 < start.index(made) < start.index(counted) < start.index("Fig. 3: A")
    assert "0.5 µs" in start
    for name in ("claims", "provenance"):
        assert pages[name].index(made) < pages[name].index("<table")


def test_findings_link_to_their_figures_and_claims(pages):
    start = pages["summary"]
    view = "javascript:app.setView({content: 'html', contentPath: results['%s'].data_uri + '#%s'})"
    assert "<strong>Two exist</strong>, &amp;\nlow (" in start
    assert (
        f'(<a href="{view % ("a.html", "fig03")}">fig03</a>, <a href="{view % ("claims.html", "C02")}">C02</a>)'
        in start
    )
    # This figure is not in the report.
    assert "<li>None (<code>figures/fig99.pdf</code>).</li>" in start
    assert start.index("Two exist") < start.index("3 statements of the paper")


def test_the_provenance_is_shown(pages):
    for text in ("abc", "<td>no</td>", "0123456789abcdef", "2026-01-01", "Linux", "numpy==1.0", "<td>4 s</td>"):
        assert text in pages["provenance"]


def test_pictures_keep_white_and_colours_in_few_bytes(tmp_path):
    pixels = np.full((400, 600, 3), 255, dtype=np.uint8)
    pixels[100:200, 100:300] = 0, 114, 178
    Image.fromarray(pixels).save(tmp_path / "figure.png")
    uri, width = figure_pages.encode_picture(tmp_path / "figure.png")
    assert width == 144  # 1 inch in print, 1.5 times as large on the screen
    assert uri.startswith("data:image/webp;base64,")
    found = np.asarray(Image.open(io.BytesIO(base64.b64decode(uri.split(",")[1]))).convert("RGB"), dtype=np.int64)
    assert np.abs(found - pixels[::2, ::2]).max() <= 2  # of 255
    assert (found[pixels[::2, ::2, 0] == 255] == 255).all()


def test_white_stays_white_among_many_colours(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (400, 400, 3), dtype=np.uint8)
    pixels[:, 100:200] |= 248  # as at the edge of a letter
    pixels[:, 200:] = 255
    Image.fromarray(pixels).save(tmp_path / "figure.png")
    uri, _ = figure_pages.encode_picture(tmp_path / "figure.png")
    with Image.open(io.BytesIO(base64.b64decode(uri.split(",")[1]))) as found:
        assert found.getpixel((150, 100)) == (255, 255, 255)


def test_a_page_too_large_for_browsers_is_refused(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (1400, 1400, 3), dtype=np.uint8)
    Image.fromarray(pixels).save(tmp_path / "noise.png")
    (tmp_path / "noise.rst").write_text("Noise.\n")
    noise = {"name": "noise", "number": "noise", "title": "N", "section": "", "file": "noise.pdf"}
    noise |= {kind: str(tmp_path / f"noise.{kind}") for kind in ("png", "rst")}
    one = {"heading": "Noise", "figures": [noise]}
    assert figure_pages.make([one], {})[0].count("<figure") == 1
    with pytest.raises(ValueError, match=r"Noise: its page of the report has \d\.\d\d MB"):
        figure_pages.make([one | {"figures": [noise, noise]}], {})


def test_a_caption_with_a_mistake_is_an_error():
    assert figure_pages.to_html("m\\ :sub:`p`\n") == "<p>m<sub>p</sub></p>\n"
    with pytest.raises(Exception, match="Unknown interpreted text role"):
        figure_pages.to_html("m :no:`p`\n")


@pytest.fixture(scope="module")
def report(built) -> str:
    run = built.snakemake("--report", "report.html")
    assert run.returncode == 0, run.stdout
    return (built.folder / "report.html").as_uri()


@pytest.fixture(scope="module")
def browser(report, tmp_path_factory):
    driver = chromium(tmp_path_factory.mktemp("profile"))
    driver.set_window_size(1300, 900)
    driver.get(report)
    yield driver
    driver.quit()


def until(condition) -> None:
    for _ in range(200):
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError("never true")


def seen(browser, element) -> bool:
    """Whether an element has a size, and its top is in the window."""
    box = "const box = arguments[0].getBoundingClientRect(); "
    return browser.execute_script(box + "return box.height > 5 && box.top >= 0 && box.top < innerHeight", element)


def test_the_report_opens_with_the_summary(browser):
    until(lambda: browser.find_elements(By.CSS_SELECTOR, ".prose h1"))
    heading, notice = (browser.find_element(By.CSS_SELECTOR, f".prose {name}") for name in ("h1", ".notice"))
    assert heading.text == "Dynamics of a vibratory conveyor"
    assert notice.text.startswith("Made with overlay.yaml: a config other than the paper's.")
    assert seen(browser, heading)
    assert seen(browser, notice)
    # Sections in the paper's order.
    assert [one.text for one in browser.find_elements(By.CSS_SELECTOR, ".prose p strong")][1:] == [
        "Section 3.1",
        "Section 3.2",
        "Section 4.2",
    ]


def test_figure_and_caption_are_visible_together(browser, built):
    for figure in FIGURES:
        title = f"Fig. {int(figure[3:])}: {title_of(figure)}"
        browser.execute_script("app.setView({content: 'rulegraph'})")
        until(lambda title=title: browser.find_elements(By.LINK_TEXT, title))
        browser.find_element(By.LINK_TEXT, title).click()
        until(lambda: browser.find_elements(By.TAG_NAME, "iframe"))
        browser.switch_to.frame(browser.find_element(By.TAG_NAME, "iframe"))
        until(lambda figure=figure: browser.find_elements(By.ID, figure))
        shown = browser.find_element(By.ID, figure)
        picture, caption = (shown.find_element(By.TAG_NAME, name) for name in ("img", "figcaption"))
        until(lambda picture=picture: browser.execute_script("return arguments[0].complete", picture))
        assert browser.execute_script("return arguments[0].naturalWidth", picture) > 900
        assert seen(browser, picture)
        assert caption.rect["y"] >= picture.rect["y"] + picture.rect["height"]
        text = " ".join((built.folder / f"results/captions/{figure}.rst").read_text().split())
        assert " ".join(caption.text.split()).startswith(text[:200])
        browser.switch_to.default_content()


def test_sections_claims_and_provenance_are_in_the_menu(browser):
    assert browser.execute_script("return Object.keys(categories).sort()") == ["Claims", "Figures", "Provenance"]
    sections = browser.execute_script("return Object.values(results).map(one => one.labels.section).filter(Boolean)")
    assert sorted(sections) == ["3.1", "3.2", "4.2"]
    assert all(
        one == "text/html" for one in browser.execute_script("return Object.values(results).map(x => x.mime_type)")
    )


def test_no_page_of_the_report_has_errors(browser):
    errors = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert errors == []
