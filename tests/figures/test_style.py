"""The one place that saves figures."""

import pytest
from PIL import Image

from figures import style


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
