"""Saving of figures."""

import pandas as pd
import pytest

from conveyor_pipeline.figures import style


def test_files_of_a_figure_have_the_layout_of_a_page():
    """The layout of a picture alone would differ slightly."""

    def position(write):
        with style.applied():
            figure = style.figure(50.0, 40.0)
            axes = figure.subplots()
            axes.set(xlabel="time in s", ylabel="height in mm")
            write(figure)
        return axes.get_position().bounds

    assert position(style.encode) == position(style.lay_out)


@pytest.mark.parametrize("heights", [[1e-4], [0.0], [0.0, 1e-4]])
def test_a_map_with_one_value_on_an_axis_is_not_empty(heights):
    table = pd.DataFrame([(x, z) for x in (1.0, 2.0) for z in heights], columns=["psi0", "z0"]).assign(state="chaos")
    with style.applied():
        axes = style.figure(50.0, 40.0).subplots()
        style.state_map(axes, table, "z0", "psi0")
    (mesh,) = axes.collections
    low, high = mesh.get_coordinates()[0, [0, -1], 0]
    assert low < min(heights) and high > max(heights)


def test_a_legend_of_four_states_fits_a_column():
    with style.applied():
        figure = style.figure(style.COLUMN, 70.0)
        figure.subplots()
        style.state_legend(figure, pd.DataFrame({"state": list(style.STATE_COLOURS)}))
        style.lay_out(figure)
        legend = figure.legends[0].get_window_extent()
    assert len(figure.legends[0].get_texts()) == 4
    assert figure.bbox.x0 <= legend.x0 < legend.x1 <= figure.bbox.x1
