"""Tables from a few bifurcations: identities between columns, selection, and rows for points that are not found."""

import numpy as np
import pandas as pd
import pytest
from project import read_config

from conveyor.analysis.bifurcations import doubling_cascade
from pipeline import grid
from sensitivity import curves, derivatives, selection

SETTINGS = read_config()["sensitivity"]
MODEL = {name: value for name, value in read_config()["model"].items() if name != "acceleration"}
COLUMNS = ("kind", "period", "acceleration", "delta", "v", "impacts")
# The fold, doublings and the lift-off of the paper's conveyor, to few digits.
ROWS = [
    ("grazing", 1, 45.6996, 8.9185e-06, -1.9e-05, 0),
    ("fold", 1, 23.97629, -3.3896e-04, 0.050419, 1),
    ("period_doubling", 1, 54.21824, -6.21988e-04, 0.015642, 1),
    ("period_doubling", 2, 61.27324, -4.0305e-04, 0.023476, 2),
]


@pytest.fixture(scope="module")
def tables():
    table = pd.DataFrame(ROWS, columns=COLUMNS)
    cascade = table[table.kind == "period_doubling"].assign(number=[1, 2])
    critical = pd.DataFrame(
        {"acceleration": [30.0, 40.0, 49.25], "z0": [2.574658e-4, 7.19072e-5, 1.3027e-6], "is_critical": True}
    )
    critical.attrs["model"] = MODEL
    return table, cascade, critical


@pytest.fixture(scope="module")
def made(tables):
    found = derivatives.make(*tables, {**SETTINGS, "effort": 0.3, "model": MODEL})
    return {kind: pd.DataFrame(columns) for kind, columns in found.items()}


@pytest.fixture(scope="module")
def chosen(tables):
    return selection.select_bifurcations(grid.row_of(MODEL), *tables[:2], 2)


def test_every_bifurcation_is_chosen_once(chosen):
    assert [(one.kind, one.period, one.doubling) for one in chosen] == [
        ("fold", 1, 0),
        ("grazing", 1, 0),
        ("period_doubling", 1, 1),
        ("period_doubling", 2, 2),
    ]
    assert [one.rides for one in chosen] == [False, True, False, False]
    assert all(one.point is not None for one in chosen)


def test_only_the_lowest_bifurcations_of_each_kind_are_chosen(tables, monkeypatch):
    """A fold above the first one, with one bifurcation of each kind; doublings of the cascade are not counted."""
    both = pd.concat([tables[0], tables[0].iloc[[0]].assign(acceleration=90.0)])
    monkeypatch.setattr(selection, "MOST", 1)
    found = selection.select_bifurcations(grid.row_of(MODEL), both, tables[1], 2)
    assert [(one.kind, one.acceleration > 80.0) for one in found].count(("fold", True)) == 0
    assert len(found) == len(ROWS)


def test_a_point_that_is_not_found_again_keeps_its_row_with_a_reason(tables):
    lost = tables[0].iloc[[1]].assign(acceleration=33.0)
    parameters = grid.row_of(MODEL)
    (one,) = selection.select_bifurcations(parameters, lost, tables[1].iloc[:0], 0)
    assert one.point is None
    rows = list(derivatives.physical_rows(derivatives.differentiate_bifurcation(parameters, one)))
    assert {row["status"] for row in rows} == {"not found again"}
    assert all(np.isnan(row["derivative"]) for row in rows)


@pytest.mark.parametrize("rows", [4, 0])
def test_a_conveyor_without_critical_heights_has_no_critical_amplitude(tables, rows):
    none = tables[2].assign(is_critical=False)
    none.attrs = tables[2].attrs
    found = derivatives.make(
        tables[0].iloc[:rows], tables[1].iloc[:0], none, {**SETTINGS, "effort": 0.3, "model": MODEL}
    )
    kinds = {"fold", "grazing", "period_doubling"} if rows else set()
    assert set(found["derivatives"]["kind"]) == set(found["groups"]["kind"]) == kinds


def test_differences_agree(made):
    table = made["derivatives"]
    assert set(table.status) == {"ok"}
    moving = table[table.elasticity.abs() > 0.01]
    assert np.abs(moving.difference / moving.derivative - 1.0).max() < 1e-4
    assert set(table.kind) == {"fold", "grazing", "period_doubling", "critical_amplitude", "critical_height"}


def test_friction_moves_nothing_and_the_phase_only_boundaries(made):
    table = made["derivatives"]
    assert (table[table.parameter == "friction"].derivative == 0.0).all()
    phases = table[table.parameter == "psi0"].set_index("kind").derivative
    assert (phases[["fold", "grazing", "period_doubling"]] == 0.0).all()
    assert (phases[["critical_amplitude", "critical_height"]] != 0.0).all()


def test_elasticities_by_groups_and_by_parameters_are_one(made):
    """d_c and k_c act through one group each."""
    physical, groups = made["derivatives"], made["groups"]
    for name in ("damping", "stiffness"):
        left = physical[physical.parameter == name].set_index(["kind", "acceleration"]).elasticity
        right = groups[groups.group == name].set_index(["kind", "acceleration"]).elasticity
        both = left.notna() & right.notna()
        assert both.sum() >= 4
        assert left[both].to_numpy() == pytest.approx(right[both].to_numpy(), rel=1e-10)


def test_weights_are_the_derivatives_of_aitkens_process():
    amplitudes = np.array([54.0, 61.0, 62.4, 62.7])
    found = derivatives.aitken_weights(*amplitudes[1:])
    assert found.sum() == pytest.approx(1.0)
    for place in range(3):
        ends = []
        for sign in (1.0, -1.0):
            changed = amplitudes.copy()
            changed[1 + place] += sign * 1e-6
            ends.append(doubling_cascade.accumulation_point(changed)[0])
        assert found[place] == pytest.approx((ends[0] - ends[1]) / 2e-6, rel=1e-5)


def test_curves_in_parameters_and_in_groups(tables):
    factors = dict.fromkeys(("damping", "stiffness", "frequency", "angle"), 1.3)
    settings = {**SETTINGS, "model": MODEL, "effort": 0.3, "factors": factors}
    found = curves.make(tables[0].iloc[:3], tables[1], settings, threads=2)
    continued = pd.DataFrame(found["continued"])
    assert len(continued.groupby(["kind", "begin", "parameter"])) == 3 * 4
    paper = {"damping": 0.3, "stiffness": 5e5, "frequency": 50.0}
    for (_, _, parameter), rows in continued.groupby(["kind", "begin", "parameter"]):
        assert rows.status.iloc[0] == rows.status.iloc[-1] == "limit of the config"
        assert (rows.status.iloc[1:-1] == "ok").all()
        if parameter == "angle":
            vertical = (rows.acceleration * np.sin(rows.value)).to_numpy()
            assert vertical == pytest.approx(9.81 * rows.amplitude_group.to_numpy())
            assert np.ptp(rows.amplitude_group) == 0.0
            continue
        ratio = rows.value / paper[parameter]
        damping = {"damping": ratio, "stiffness": 1.0, "frequency": 1.0 / ratio}[parameter]
        stiffness = {"damping": 1.0, "stiffness": ratio, "frequency": ratio**-3}[parameter]
        first = rows.damping_group.iloc[0] / np.broadcast_to(damping, len(rows))[0]
        assert rows.damping_group.to_numpy() == pytest.approx(first * np.broadcast_to(damping, len(rows)))
        first = rows.stiffness_group.iloc[0] / np.broadcast_to(stiffness, len(rows))[0]
        assert rows.stiffness_group.to_numpy() == pytest.approx(first * np.broadcast_to(stiffness, len(rows)))
        assert ratio.min() == pytest.approx(1.0 / 1.3, rel=0.1)
        assert ratio.max() == pytest.approx(1.3, rel=0.1)
