"""Plots: runs that have not settled, and the modules that plots import."""

import itertools
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from conveyor.solver.status import EVENT_LOST, GAVE_UP, NOT_FINITE, OK, STATUS, STEP_TOO_SMALL, STUCK
from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.figures import calibration, drive, transit
from conveyor_pipeline.paper.figures import fig08, fig15
from conveyor_pipeline.study.accuracy import precision, speed
from conveyor_pipeline.study.caption_numbers.work_precision import numbers
from conveyor_pipeline.study.figures import work_precision


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


def test_failures_are_listed_in_order():
    """A method that is right in each run is not listed."""
    runs = pd.DataFrame(
        [
            ("event", "exact", "ok"),
            ("euler", "fixed step", "wrong state"),
            ("DOP853", "events", "through the plate"),
            ("DOP853", "modes", "ok"),
            ("euler", "fixed step", "ok"),
        ],
        columns=["method", "treatment", "outcome"],
    )
    assert work_precision.failing_methods(runs) == [("euler", "fixed step"), ("DOP853", "events")]


def test_every_outcome_has_a_marker():
    of_runs = {STATUS[code] for code in (OK, GAVE_UP, STUCK, STEP_TOO_SMALL, EVENT_LOST, NOT_FINITE)}
    assert set(work_precision.OUTCOMES) == {*of_runs, precision.WRONG, precision.THROUGH}


def test_a_picture_does_not_wait_for_the_compiler():
    """Most plots need only names and units of the library; `simulate` is imported on first use."""
    code = (
        "import sys, make, draw, conveyor; from figures.plots import fig22; before = 'numba' in sys.modules; "
        "from conveyor import simulate; print(before, 'numba' in sys.modules, hasattr(conveyor, 'nothing'))"
    )
    scripts = Path(__file__).resolve().parents[2] / "scripts"
    run = subprocess.run([sys.executable, "-c", code], cwd=scripts, capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False", "True", "False"]


@pytest.mark.parametrize(("method", "name"), [("rk4", "RK4, fixed step"), ("DOP853", "SciPy's DOP853")])
def test_arrow_and_caption_compare_with_the_fastest_other_method(method, name):
    runs = pd.DataFrame(
        [
            ("event", speed.OWN, np.nan, 1e-10, 1e-12, "ok", 1e-4),
            ("euler", "fixed step", 5e-7, np.nan, 1e-3, "ok", 0.03),
            ("euler", "fixed step", 5e-3, np.nan, 1e-1, "wrong state", 0.001),
            (method, "events", np.nan, 1e-10, 1e-10, "ok", 0.004),
            ("DOP853", "modes", np.nan, 1e-9, 1e-8, "ok", 0.005),
            ("DOP853", "modes", np.nan, 1e-13, 1e-8, "ok", 0.05),
        ],
        columns=["method", "treatment", "step", "tolerance", "trajectory_error", "outcome", "seconds"],
    )
    runs["state_error"] = [1e-12, 1e-3, 1e-1, 1e-10, 1e-9, 2e-13]
    runs.attrs["duration"] = 0.5
    scenes = {f"{scene}{kind}": runs for scene in work_precision.NAMES for kind in ("", "_times")}
    figure = work_precision.plot(**scenes)
    for axes in figure.subfigs[0].axes:
        assert [text.get_text() for text in axes.texts if "×" in text.get_text()] == ["300×", "40×"]
    found = numbers(**scenes)
    assert [rival_name for *_, rival_name in found["comparisons"]] == [name] * 3
    assert found["difference"] == 2e-13


def test_a_calibration_that_has_not_converged_shows_the_measured_velocities_alone():
    fit = pd.DataFrame({"acceleration": [30.0, 40.0], "velocity": [0.05, 0.06], "sd": 0.001})
    none = pd.DataFrame()
    figure = calibration.plot(parameters=none, samples=none, fit=fit, prediction=none)
    (axes,) = figure.axes
    assert "not converged" in axes.get_title() and axes.get_ylabel().endswith("in cm/s")
    assert axes.yaxis.get_major_formatter()(0.05) == "5"
