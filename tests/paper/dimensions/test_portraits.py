"""Portraits whose dimension is known: a point, closed curves."""

import numpy as np
import pandas as pd
import pytest

from conveyor import Conveyor, Start, parameter_table, simulate
from conveyor_pipeline.paper.dimensions import portraits

SETTINGS = {
    "method": "event",
    "tolerance": 1e-8,
    "settling": 500,
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


def test_an_uncertain_dimension_is_left_out(monkeypatch):
    monkeypatch.setattr(portraits, "LARGEST_ERROR", 1e-6)
    table = made(axes={"acceleration": [40.0], "z0": [3e-4]})
    assert table.dimension.isna().all()
    assert table.error.notna().all()
    assert table.status.tolist() == ["interval too wide"]


@pytest.mark.parametrize("method", ["event", "euler"])
def test_the_portrait_of_the_paper_contains_the_run_from_its_beginning(method):
    conveyor = Conveyor(acceleration=40.0)
    options = {"method": method, "duration": 0.05, "tolerance": 1e-10, "step": 1e-6}
    points = portraits.portrait(parameter_table(conveyor, Start(3e-4)), options | {"estimator": "paper"})
    # Samples are 5 µs apart.
    run = simulate(conveyor, Start(3e-4), **options)
    assert len(points) == 10001
    truth = run.sample([0.0, 0.02, 0.05])
    np.testing.assert_allclose(points[[0, 4000, 10000]], np.column_stack([truth["z"], truth["vz"]]), rtol=1e-12, atol=0)


def test_a_settled_portrait_begins_after_the_settling_cycles():
    conveyor = Conveyor(acceleration=40.0)
    settings = SETTINGS | {"settling": 5, "samples": 3}
    points = portraits.portrait(parameter_table(conveyor, Start(3e-4)), settings)
    run = simulate(conveyor, Start(3e-4), duration=0.15, tolerance=1e-8)
    truth = run.sample(0.1 + 0.02 * portraits.SETTLED_INTERVAL * np.arange(3))
    np.testing.assert_allclose(points, np.column_stack([truth["z"], truth["vz"]]), rtol=1e-12, atol=0)
