"""Saving of figures."""

import pandas as pd
import pytest

from conveyor_pipeline.figures import style


def test_files_of_a_figure_have_one_layout(tmp_path):
    """The layout of a page, although the layout of a picture alone would differ slightly."""

    def position(*names):
        with style.applied():
            figure = style.figure(50.0, 40.0)
            axes = figure.subplots()
            axes.set(xlabel="time in s", ylabel="height in mm")
            style.save(figure, [str(tmp_path / name) for name in names])
        return axes.get_position().bounds

    page = position("a.pdf")
    assert position("b.png") == position("c.pdf", "c.png") == page


def test_positions_are_rounded(tmp_path):
    """Their last digits differ from run to run, so that pictures with equal layouts would have different bytes."""
    with style.applied():
        figure = style.figure(50.0, 60.0)
        parts = figure.subfigures(2, 1, height_ratios=(2.0, 1.0))
        panels = [*parts[0].subplots(1, 3), parts[1].subplots()]
        style.save(figure, [str(tmp_path / "a.png")])
    positions = [*(axes.get_position().bounds for axes in panels), *(part.bbox_relative.bounds for part in parts)]
    for position in positions:
        assert position == pytest.approx([round(number, 9) for number in position], abs=1e-15)


def test_a_legend_of_four_states_fits_a_column():
    with style.applied():
        figure = style.figure(style.COLUMN, 70.0)
        figure.subplots()
        style.state_legend(figure, pd.DataFrame({"state": list(style.STATE_COLOURS)}))
        style.lay_out(figure)
        legend = figure.legends[0].get_window_extent()
    assert len(figure.legends[0].get_texts()) == 4
    assert figure.bbox.x0 <= legend.x0 < legend.x1 <= figure.bbox.x1
