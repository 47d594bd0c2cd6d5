"""Pages of the report with the figures of each section of the paper and their captions."""

import base64
import io
from pathlib import Path

from docutils.core import publish_parts
from markupsafe import Markup
from PIL import Image

from figures.style import RESOLUTION
from report.page import render

# Colour values are rounded to multiples of this: invisible, but the picture takes fewer bytes. 255 is a multiple, so
# that white stays white.
STEP = 5
# Factor by which a PNG file is scaled down in each direction: 300 dpi are enough for a screen.
REDUCED = 2
# Largest page in bytes. The report stores a page as a data URI in base64, and Chromium accepts 2 MiB.
LARGEST = 1_500_000
# Browser pixels per inch of the figure: 1.5 times the size in print.
SHOWN = 1.5 * 96


def encode_picture(path: str) -> tuple[str, int]:
    """The PNG file of a figure as a data URI of a sixth of its bytes, and its width in a browser (pixels)."""
    with Image.open(path) as file:
        width = round(SHOWN * file.width / RESOLUTION)
        small = file.reduce(REDUCED)
    rounded = small.point([STEP * round(value / STEP) for value in range(256)] * len(small.getbands()))
    buffer = io.BytesIO()
    rounded.save(buffer, "WEBP", lossless=True, method=4)
    return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode()}", width


def to_html(caption: str) -> Markup:
    """A caption in reStructuredText as HTML."""
    return Markup(
        publish_parts(caption, writer="html5", settings_overrides={"report_level": 2, "halt_level": 2})["body"]
    )


def describe_figure(figure: dict[str, str]) -> dict:
    """The fields of a figure in the template."""
    uri, width = encode_picture(figure["png"])
    caption = to_html(Path(figure["rst"]).read_text(encoding="utf-8"))
    return figure | {"picture": Markup(uri), "width": width, "caption": caption}


def make(pages: list[dict], notice: dict[str, str]) -> list[str]:
    """The pages, in order.

    Parameters
    ----------
    pages : `heading` and `figures` of each page; a figure has name, number, title, section, file, png and rst
    notice : `overlays`, sweep `points` of this config, and `paper_points` of the paper's config; {} without overlays

    Raises
    ------
    ValueError
        names a page that is too large for a browser
    """
    made = []
    for page in pages:
        figures = [describe_figure(figure) for figure in page["figures"]]
        made.append(render("figures.html", title=page["heading"], notice=notice, figures=figures))
        size = len(made[-1].encode())
        if size > LARGEST:
            raise ValueError(
                f"{page['heading']}: its page of the report has {size / 1e6:.2f} MB, but browsers show at most "
                f"{LARGEST / 1e6:g} MB; put fewer figures on it"
            )
    return made
