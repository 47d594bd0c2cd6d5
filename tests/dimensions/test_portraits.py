"""Portraits whose dimension is known: a point, closed curves."""

import numpy as np
import pandas as pd
import pytest

from conveyor import Conveyor, Start, parameter_table, simulate
from dimensions import portraits

SETTINGS = {
    "method": "event",
    "tolerance": 1e-8,
    "begin": 10.0,
    "interval": 0.6180339887498949,
    "samples": 20000,
    "estimator": "box",
    "model": {"vz0": 0.0},
}


def made(**others) -> pd.DataFrame:
    return pd.DataFrame(portraits.make(SETTINGS | others))


def test_a_part_at_rest_has_no_dimension():
    table = made(axes={"acceleration": [0.0], "z0": [0.0]}, samples=1000)
    assert table.dimension.isna().all()
    assert table.status.tolist() == ["too few scales"]


def test_periodic_motions_are_curves():
    table = made(axes={"acceleration": [40.0], "z0": [0.0, 3e-4]})
    assert (table.status == "ok").all()
    assert ((table.dimension - 1.0).abs() <= table.error).all()
    assert (table.error < 0.1).all()


def test_an_uncertain_dimension_is_left_out():
    table = made(axes={"acceleration": [40.0], "z0": [3e-4]}, largest_error=1e-6)
    assert table.dimension.isna().all()
    assert table.error.notna().all()
    assert table.status.tolist() == ["interval too wide"]


def test_an_unknown_estimator_is_an_error():
    with pytest.raises(ValueError, match="'counting' is not one of paper, box, correlation"):
        made(axes={"acceleration": [40.0]}, model={"z0": 0.0, "vz0": 0.0}, samples=100, estimator="counting")


@pytest.mark.parametrize("method", ["event", "euler"])
def test_a_portrait_contains_the_motion_from_its_beginning(method):
    conveyor = Conveyor(acceleration=40.0)
    settings = {"method": method, "begin": 0.02, "interval": 0.5, "samples": 4, "tolerance": 1e-10, "step": 1e-6}
    points = portraits.portrait(parameter_table(conveyor, Start(3e-4)), settings)
    # Half an excitation cycle is 0.01 s.
    run = simulate(conveyor, Start(3e-4), duration=0.05, method=method, tolerance=1e-10, step=1e-6)
    truth = run.sample([0.02, 0.03, 0.04, 0.05])
    np.testing.assert_allclose(points, np.column_stack([truth["z"], truth["vz"]]), rtol=1e-12, atol=0)
