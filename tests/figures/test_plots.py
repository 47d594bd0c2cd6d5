"""Plots: runs that have not settled, and the modules that plots import."""

import itertools
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from project import ROOT

from conveyor_pipeline.figures import style
from conveyor_pipeline.paper.figures import fig08, fig15


def sweep(low: float, high: float) -> pd.DataFrame:
    """Five initial conditions at each of five amplitudes, two of which have velocities between `low` and `high`."""
    amplitudes = np.repeat([50.0, 51.0, 52.0, 53.0, 54.0], 5)
    velocity = np.where(amplitudes > 52.5, np.tile(np.linspace(low, high, 5), 5), 0.1)
    about = {"state": "second", "period": 1, "longest_flight": 0.9}
    return pd.DataFrame({"acceleration": amplitudes, "mean_velocity": velocity, **about})


def test_unsettled_runs_are_found_where_most_velocities_scatter():
    assert fig08.unsettled(sweep(0.1, 0.2)) == pytest.approx((54.0, 0.125))


def test_settled_runs_do_not_count_as_scattered():
    assert fig08.unsettled(sweep(0.1, 0.102)) is None
    one_aside = sweep(0.1, 0.1)
    one_aside.loc[24, "mean_velocity"] = 0.2
    assert fig08.unsettled(one_aside) is None


def test_coexisting_jumps_do_not_count_as_unsettled():
    """Two motions with flights of 0.9 and 1.8 cycles, of which each has its own velocity."""
    both = sweep(0.1, 0.1)
    both.loc[::2, ["mean_velocity", "longest_flight"]] = 0.2, 1.8
    assert fig08.unsettled(both) is None
    assert fig08.unsettled(both.assign(longest_flight=0.9)) is not None


def test_chaos_does_not_count_as_unsettled():
    assert fig08.unsettled(sweep(0.1, 0.2).assign(state="chaos")) is None


def test_equal_values_stay_below_the_end_of_an_axis_from_zero():
    with style.applied():
        axes = style.figure(50.0, 40.0).subplots()
        axes.plot([0.0, 1.0], [0.3, 0.3 + 1e-12])
        style.from_zero(axes)
    assert axes.get_ylim() == pytest.approx((0.0, 0.306))


@pytest.mark.parametrize(("low", "high"), [(0.35, 0.8), (0.02, 0.9), (0.3, 40.0), (2.0, 2000.0)])
def test_some_powers_or_digits_of_a_logarithmic_axis_are_labelled(low, high):
    with style.applied():
        figure = style.figure(80.0, 40.0)
        axes = figure.subplots()
        axes.set_xscale("log")
        axes.plot([low, high], [1.0, 2.0])
        style.label_powers(axes.xaxis)
        style.lay_out(figure)
        left, right = axes.get_xlim()
        ticks = [*axes.get_xticklabels(), *axes.get_xticklabels(minor=True)]
        boxes = [t.get_window_extent() for t in ticks if t.get_text() and left <= t.get_position()[0] <= right]
    boxes.sort(key=lambda box: box.x0)
    assert len(boxes) >= 2
    assert all(one.x1 < other.x0 for one, other in itertools.pairwise(boxes))


@pytest.mark.parametrize("inclination", [0.0, 0.5])
def test_the_line_of_fig_15_follows_gravity_normal_to_the_track(inclination):
    falls = pd.DataFrame({"acceleration": [30.0, 40.0, 50.0, 60.0], "impact_velocity": -0.2, "impact_phase": 7.0})
    falls.attrs["model"] = {"frequency": 50.0, "gravity": 9.81, "inclination": inclination, "psi0": 0.3}
    line = fig15.plot(impacts=falls).axes[0].lines[0]
    fall = 0.2 / (9.81 * np.cos(inclination))  # s, until a part that starts at rest has this velocity
    assert line.get_ydata() == pytest.approx([0.3 + 2.0 * np.pi * 50.0 * fall, 0.3])


def test_a_picture_and_its_caption_do_not_wait_for_the_compiler():
    """Most of them need only names and units of the library; `simulate` is imported on first use."""
    code = (
        "import sys, conveyor; from conveyor_pipeline import make; "
        "from conveyor_pipeline.figures import captions, plots; "
        "from conveyor_pipeline.paper.figures import fig22; before = 'numba' in sys.modules; "
        "from conveyor import simulate; print(before, 'numba' in sys.modules, hasattr(conveyor, 'nothing'))"
    )
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT / "scripts", capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False", "True", "False"]
