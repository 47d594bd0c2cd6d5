"""Differences that a reader can see: thinned axes, visible differences, known values."""

import numpy as np
import pandas as pd
import pytest

from conveyor_pipeline.study.accuracy import observables
from conveyor_pipeline.study.accuracy.observables import Shown

CURVE = Shown(lambda settings: None, (), ("value", "state"), "a curve")
SIGNAL = Shown(lambda settings: None, ("time",), ("value",), "samples", per_motion=True)
AXES = {"acceleration": [20.0, 30.0, 40.0, 50.0, 60.0]}


def curve(**changes):
    """A table whose values range over 10; a line of 0.01 is 0.1 wide."""
    table = pd.DataFrame({**AXES, "value": [0.0, 2.0, 5.0, 7.0, 10.0], "state": "first"})
    for name, values in changes.items():
        for row, value in values.items():
            table.loc[row, name] = value
    return table


def test_thinned_axes_keep_their_ends_and_words():
    axes = {"acceleration": {"start": 20.0, "stop": 90.0, "num": 281}, "z0": [0.0, 1e-4], "tension": ["allow", "clip"]}
    found = observables.thin_axes(axes, 100)
    assert found["acceleration"][0] == 20.0
    assert found["acceleration"][-1] == 90.0
    assert found["z0"] == [0.0, 1e-4]
    assert found["tension"] == ["allow", "clip"]
    assert 50 <= np.prod([len(axis) for axis in found.values()]) <= 200
    assert observables.thin_axes({"z0": ["conveyor"]}, 1) == {"z0": ["conveyor"]}
    assert observables.thin_axes(AXES, 1000) == AXES


def test_a_line_hides_smaller_differences():
    found = curve(value={1: 2.04, 2: 5.2}, state={3: "second"})
    seen = observables.visible_differences(CURVE, curve(), found, AXES)
    assert list(seen.value) == [False, False, True, False, False]
    assert list(seen.state) == [False, False, False, True, False]


def test_missing_values_differ_and_uncomputed_values_do_not():
    seen = observables.visible_differences(CURVE, curve(), curve().drop(index=4), AXES)
    assert list(seen.value) == [False] * 4 + [True]
    assert list(seen.state) == [False] * 4 + [True]
    seen = observables.visible_differences(CURVE, curve(), curve().assign(value=np.nan), AXES)
    assert not seen.to_numpy().any()
    seen = observables.visible_differences(CURVE, curve(), curve(value={2: np.nan}), AXES)
    assert list(seen.value) == [False, False, True, False, False]


def test_samples_after_a_difference_are_not_known():
    axes = {"z0": [0.0, 1.0]}
    truth = pd.DataFrame({"z0": np.repeat([0.0, 1.0], 3), "time": [0.0, 1.0, 2.0] * 2, "value": [0.0, 5.0, 10.0] * 2})
    other = truth.assign(value=[0.0, 6.0, 10.0, 0.0, 5.0, 10.0])
    known = observables.robust_values(SIGNAL, truth, [truth, other], axes)
    assert list(known.value) == [True, False, False, True, True, True]


@pytest.mark.parametrize(("z0", "vz0"), [("conveyor", 0.0), (1e-4, 0.0)])
def test_shifted_initial_conditions_move_what_can_move(z0, vz0):
    seen = []
    shown = Shown(lambda settings: seen.append(settings["model"]) or curve(), (), ("value",), "a curve")
    model = {"frequency": 50.0, "z0": z0, "vz0": vz0}
    observables.observe_shifted(shown, {"axes": AXES, "model": model}, [1e-11])
    changed = "vz0" if z0 == "conveyor" else "z0"
    assert {name for name in model if seen[0][name] != model[name]} == {changed}


@pytest.mark.parametrize(("name", "unit"), [("z0", 1.0), ("vz0", 100.0 * np.pi)])
def test_shifts_along_an_axis_are_observed_together_and_separated(name, unit):
    calls = []

    def observe(settings):
        calls.append(settings)
        return pd.DataFrame({name: settings["axes"][name], "value": settings["axes"][name]})

    shown = Shown(observe, (), ("value",), "starts")
    axes, model = {name: [0.0, 1e-4]}, {"frequency": 50.0, "z0": "conveyor", "vz0": 0.0}
    shifts = [1e-11, -1e-11, 2e-11]
    tables = observables.observe_shifted(shown, {"axes": axes, "model": model}, shifts)
    assert len(calls) == 1
    for shift, table in zip(shifts, tables, strict=True):
        assert list(table[name]) == axes[name]
        assert list(table.value) == pytest.approx([value + unit * shift for value in axes[name]], abs=1e-18)
