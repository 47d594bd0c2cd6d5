"""The one place that saves figures."""

import re
import zlib

import matplotlib as mpl
import pytest
from PIL import Image

from figures import style


def streams(content):
    """The decompressed streams of a PDF."""
    for match in re.finditer(rb"stream\r?\n(.*?)\r?\nendstream", content, re.DOTALL):
        try:
            yield zlib.decompress(match.group(1))
        except zlib.error:
            yield match.group(1)


def line(y, path):
    with style.applied(), mpl.rc_context({"figure.constrained_layout.use": False}):
        figure = style.figure(50.0, 50.0)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.axis("off")
        axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
        axes.plot([0.0, 1.0], [y, 1.0], clip_on=False)
        style.save(figure, [str(path)])
    return path.read_bytes()


def test_no_negative_zeros(tmp_path):
    """A coordinate that misses zero by its last digit prints as zero, whatever its sign."""
    below, above = line(-1e-14, tmp_path / "below.pdf"), line(1e-14, tmp_path / "above.pdf")
    assert below == above
    text = b"\n".join(streams(below))
    assert b"0 0 m" in text
    assert not re.search(rb"(?<![\w.])-0(?![\w.])", text)


def test_negative_numbers_stay(tmp_path):
    text = b"\n".join(streams(line(-0.5, tmp_path / "line.pdf")))
    assert b" -1 m" in text  # clipped just outside the page
    assert style.NEGATIVE_ZERO.sub(b"0", b"-0 -0.5 1e-0 -0.0 10 -0\n") == b"0 -0.5 1e-0 0 10 0\n"


def test_pages_keep_no_digit_that_rounding_decides():
    """A coordinate that is off in its tenth decimal gives the same page; texts stay as they are."""
    one, other = (
        rf"1 0 0 1 {x} 247.5 cm (62.70\(89722\) 1.23456789) Tj -.12345678 0.00000001 l".encode()
        for x in ("342.4895041521", "342.4895041520")
    )
    assert style.TEXT_OR_NUMBER.sub(style.rounded, one) == style.TEXT_OR_NUMBER.sub(style.rounded, other)
    assert style.TEXT_OR_NUMBER.sub(style.rounded, one) == (
        rb"1 0 0 1 342.4895 247.5 cm (62.70\(89722\) 1.23456789) Tj -0.1235 0.0000 l"
    )


def test_each_file_is_drawn_once(tmp_path):
    drawn = []
    with style.applied():
        figure = style.figure(50.0, 40.0)
        figure.subplots().draw = drawn.append
        style.save(figure, [str(tmp_path / "a.pdf"), str(tmp_path / "a.png")])
    assert len(drawn) == 2


def test_pictures_have_no_more_than_colours(tmp_path):
    """No transparency, which takes a tenth of the bytes and of the time to write and read them."""
    with style.applied():
        figure = style.figure(50.8, 25.4)
        figure.subplots()
        style.save(figure, [str(tmp_path / "a.png")])
    with Image.open(tmp_path / "a.png") as picture:
        assert (picture.mode, picture.size) == ("RGB", (2 * style.RESOLUTION, style.RESOLUTION))
        assert picture.info["dpi"] == pytest.approx((style.RESOLUTION, style.RESOLUTION), rel=1e-4)


def test_files_of_a_figure_have_one_layout(tmp_path):
    """That of the first one, to the digit: a layout depends a little on what it is made for."""

    def position(*names):
        with style.applied():
            figure = style.figure(50.0, 40.0)
            axes = figure.subplots()
            axes.set(xlabel="time in s", ylabel="height in mm")
            style.save(figure, [str(tmp_path / name) for name in names])
        return axes.get_position().bounds

    page, picture = position("a.pdf"), position("a.png")
    assert page != picture
    assert position("b.pdf", "b.png") == page
    assert position("c.png", "c.pdf") == picture
