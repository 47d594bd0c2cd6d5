"""The figures of each section of the paper on a page, every figure above its caption."""

import base64
import io
from pathlib import Path

from docutils.core import publish_parts
from markupsafe import Markup
from PIL import Image

from figures.style import RESOLUTION
from report.page import render

# Of the values of a colour, 0 to 255, one in so many: no eye misses the others, and a picture takes fewer bytes. White
# stays white: 255 is one of them.
STEP = 5
# Of the pixels of a PNG file one in so many, in each direction: 300 dpi are enough for a screen.
REDUCED = 2
# Bytes of a page: the report holds it as an address, of which Chromium takes 2 MiB, four letters for three bytes.
LARGEST = 1_500_000
# Pixels of a browser in an inch; a figure is shown half as large again as in print.
SHOWN = 1.5 * 96


def picture(path: str) -> tuple[str, int]:
    """The PNG file of a figure as a data URI of a sixth of its bytes, and its width in a browser (pixels)."""
    with Image.open(path) as file:
        width = round(SHOWN * file.width / RESOLUTION)
        small = file.reduce(REDUCED)
    few = small.point([STEP * round(value / STEP) for value in range(256)] * len(small.getbands()))
    bytes_of = io.BytesIO()
    few.save(bytes_of, "WEBP", lossless=True, method=4)
    return f"data:image/webp;base64,{base64.b64encode(bytes_of.getvalue()).decode()}", width


def html(caption: str) -> Markup:
    """A caption, in reStructuredText, as HTML."""
    return Markup(
        publish_parts(caption, writer="html5", settings_overrides={"report_level": 2, "halt_level": 2})["body"]
    )


def of_figure(figure: dict[str, str]) -> dict:
    """What the page shows of a figure."""
    uri, width = picture(figure["png"])
    caption = html(Path(figure["rst"]).read_text(encoding="utf-8"))
    return figure | {"picture": Markup(uri), "width": width, "caption": caption}


def make(pages: dict[str, dict], told: dict[str, str]) -> dict[str, str]:
    """The pages by their names.

    Parameters
    ----------
    pages : by their names, with `heading` and `figures`: name, number, title, section, file, png and rst of each
    told : what stands on top, heading and text; nothing for the paper's config

    Raises
    ------
    ValueError
        names a page that is too large for a browser
    """
    made = {
        name: render(
            "figures.html", title=page["heading"], told=told, figures=[of_figure(figure) for figure in page["figures"]]
        )
        for name, page in pages.items()
    }
    for name, page in made.items():
        size = len(page.encode())
        if size > LARGEST:
            raise ValueError(
                f"{pages[name]['heading']}: its page of the report has {size / 1e6:.2f} MB, but browsers show at most "
                f"{LARGEST / 1e6:g} MB; put fewer figures on it"
            )
    return made
