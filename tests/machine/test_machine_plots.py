"""Plots of the floor machine."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.figures import calibration, drive, operating, transit


def bands(amplitudes: list[float], **spread: float) -> pd.DataFrame:
    """A made-up table of transit, of two populations."""
    table = pd.DataFrame({"acceleration": amplitudes, "velocity_05": 0.01, "velocity_50": 0.02, "velocity_95": 0.03})
    table = pd.concat([table.assign(population=one) for one in ("identical", "varied")], ignore_index=True)
    table.attrs = {"spread": {"seed": 1, **spread}}
    return table


@pytest.mark.parametrize(
    ("spread", "count"), [({"friction": 0.0}, 1), ({"friction": 0.1}, 2), ({"calibrated": True}, 2)]
)
def test_equal_parts_are_drawn_once(spread, count):
    axes = style.figure(50.0, 40.0).subplots()
    transit.draw_bands(axes, bands([30.0, 40.0], **spread))
    assert len(axes.get_legend_handles_labels()[1]) == count


def test_a_single_amplitude_has_marks_and_bars_within_the_axis():
    axes = style.figure(50.0, 40.0).subplots()
    transit.draw_bands(axes, bands([40.0], friction=0.1))
    style.limit_x(axes, [40.0])
    assert axes.get_xlim() == pytest.approx((38.0, 42.0))
    assert {line.get_marker() for line in axes.get_lines() if len(line.get_xdata()) == 1} == {"o"}
    bars = [path.vertices[:, 1] for one in axes.collections for path in one.get_paths()]
    np.testing.assert_allclose(bars, [[1.0, 3.0], [1.0, 3.0]])


def test_a_search_without_a_design_says_so():
    names = ["acceleration", "velocity", "impact_speed", "checked_impact_speed"]
    names += ["checked_velocity", "checked_velocity_95", "checked", "recommended"]
    front = pd.DataFrame(columns=names, dtype=float).astype({"checked": bool, "recommended": bool})
    generations = pd.DataFrame({"seed": 1, "generation": [1, 2], "hypervolume": 0.0})
    with style.applied():
        pareto = drive.plot(front=front, generations=generations).axes[0]
    assert [text.get_text() for text in pareto.texts] == ["no design within the constraints"]


@pytest.mark.parametrize(("least", "labels"), [(0.11, 2), (0.3, 2), (0.03, 2)])
def test_short_logarithmic_axes_of_track_lengths_have_labels(least, labels):
    lengths = pd.DataFrame({"acceleration": 40.0, "regime": "several velocities", "length": [0.25, 0.5], "late": 0.0})
    lengths = lengths.assign(spread=[least, 0.9], spread_stderr=0.0, predicted=np.nan)
    with style.applied():
        figure = style.figure(80.0, 60.0)
        axes = figure.subplots()
        transit.draw_lengths(axes, lengths)
        style.lay_out(figure)
    low, high = axes.get_ylim()
    ticks = [*axes.get_yticklabels(), *axes.get_yticklabels(minor=True)]
    assert sum(bool(tick.get_text()) and low <= tick.get_position()[1] <= high for tick in ticks) >= labels


def test_a_calibration_that_has_not_converged_shows_the_measured_velocities_alone():
    fit = pd.DataFrame({"acceleration": [30.0, 40.0], "velocity": [0.05, 0.06], "sd": 0.001})
    none = pd.DataFrame()
    figure = calibration.plot(parameters=none, samples=none, fit=fit, prediction=none)
    (axes,) = figure.axes
    assert "not converged" in axes.get_title() and axes.get_ylabel().endswith("in cm/s")
    assert axes.yaxis.get_major_formatter()(0.05) == "5"


def test_advised_amplitudes_are_marked_with_their_aims():
    """One line with two words if both amplitudes are equal; else two labels, the second one a line lower."""
    for amplitudes, labels in (([40.0, 40.0], ["fast and even"]), ([80.0, 40.0], ["fast", "\neven"])):
        axes = Figure().subplots()
        axes.set_xlim(20.0, 90.0)
        operating.mark_advice(axes, pd.DataFrame({"aim": ["fast", "even"], "acceleration": amplitudes}))
        assert [text.get_text() for text in axes.texts] == labels
        assert [line.get_xdata()[0] for line in axes.lines] == amplitudes[: len(labels)]


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_labels_of_advised_amplitudes_lie_above_all_lines(scale):
    """In the lowest panel that has labels, on the right of an axis whose last amplitude is advised."""
    figure = Figure(figsize=(5.0, 1.2), layout="constrained")
    axes = figure.subplots()
    axes.set_yscale(scale)
    axes.plot([20.0, 90.0], [0.1, 5.0])
    axes.set_xlim(20.0, 90.0)
    operating.mark_advice(axes, pd.DataFrame({"aim": ["fast", "even"], "acceleration": [90.0, 50.0]}))
    style.lay_out(figure)
    top = axes.transData.transform((90.0, 5.0))[1]
    assert all(text.get_window_extent().y0 > top for text in axes.texts if text.get_text() == "fast")
