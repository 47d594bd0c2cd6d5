"""Tables from a few bifurcations: closed forms, identities between columns, selection, and points that are lost."""

import numpy as np
import pandas as pd
import pytest
from project import read_config

from conveyor import groups_of
from conveyor.analysis.bifurcations.bifurcation_points import find_bifurcation
from conveyor_pipeline.common import grid
from conveyor_pipeline.paper.sensitivity import changes, curves, selection

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
    return pd.DataFrame(changes.make(*tables, {**SETTINGS, "effort": 0.3, "model": MODEL}))


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
    (point,) = changes.moved_bifurcations(parameters, [one])
    rows = list(changes.rows_of_point(point))
    assert {row["status"] for row in rows} == {"not found again"}
    assert all(np.isnan(row["change"]) for row in rows)


@pytest.mark.parametrize("rows", [4, 0])
def test_a_conveyor_without_critical_heights_has_no_critical_amplitude(tables, rows):
    none = tables[2].assign(is_critical=False)
    found = changes.make(tables[0].iloc[:rows], tables[1].iloc[:0], none, {**SETTINGS, "effort": 0.3, "model": MODEL})
    assert set(found["kind"]) == ({"fold", "grazing", "period_doubling"} if rows else set())


def test_every_point_is_found_again(made):
    assert set(made.status) == {"ok"}
    assert set(made.kind) == {"fold", "grazing", "period_doubling", "critical_amplitude", "critical_height"}


def test_changes_obey_dimensional_analysis(made):
    """â is m/s², k_c kg m^(1-p)/s², d_c kg/s: a change of the units of mass, length and time changes nothing else.

    Differences over 1 % are exact to about 1e-4.
    """
    for (kind, _), rows in made[made.moved == "acceleration"].groupby(["kind", "acceleration"]):
        found, near = rows.set_index("parameter").elasticity, {"abs": 2e-3}
        assert found["mass"] + found["stiffness"] + found["damping"] == pytest.approx(0.0, **near), kind
        assert found["gravity"] + (1.0 - MODEL["exponent"]) * found["stiffness"] == pytest.approx(1.0, **near), kind
        time = found["frequency"] + 2.0 * found["gravity"] + 2.0 * found["stiffness"] + found["damping"]
        assert time == pytest.approx(2.0, **near), kind
        angle = MODEL["angle"]
        assert found["angle"] == pytest.approx(-angle / np.tan(angle), **near), kind


def test_the_lift_off_of_a_linear_contact_changes_as_its_closed_form(tables):
    """It leaves the plate at a_z/g = |K - 1 + iD|/K, with K = k_c/(m ω²) and D = d_c/(m ω)."""
    model = MODEL | {"exponent": 1.0, "stiffness": 35000.0, "damping": 0.3}
    omega = 2.0 * np.pi * model["frequency"]

    def amplitude(mass):
        stiffness, damping = model["stiffness"] / (mass * omega**2), model["damping"] / (mass * omega)
        return abs(stiffness - 1.0 + 1j * damping) / stiffness * model["gravity"] / np.sin(model["angle"])

    groups = groups_of(grid.row_of(model))
    response = groups.stiffness - 1.0 + 1j * groups.damping
    phase = (np.pi + np.angle(response)) % (2.0 * np.pi)
    point = find_bifurcation("grazing", 1, np.array([phase, abs(response) / groups.stiffness]), groups)
    one = selection.Selected("grazing", 1, amplitude(model["mass"]), point, 0, True)
    (moved,) = changes.moved_bifurcations(grid.row_of(model), [one])
    change, status = changes.change_by_one_per_cent(moved, "mass")
    mass = model["mass"]
    assert status == "ok"
    assert change == pytest.approx(0.5 * (amplitude(1.01 * mass) - amplitude(0.99 * mass)), rel=1e-5)


@pytest.mark.parametrize(
    ("jump", "status"), [(0.0, "ok"), (1.0, changes.UNEVEN), (np.nan, "not found again beside it")]
)
def test_a_side_that_leads_to_another_point_counts_as_no_change(jump, status):
    row = grid.row_of(MODEL | {"acceleration": 40.0})
    point = changes.MovedPoint(
        "fold", 1, row, "acceleration", lambda other: 40.0 + (jump if other["mass"] > row["mass"] else 0.0)
    )
    change, found = changes.change_by_one_per_cent(point, "mass")
    assert found == status
    assert np.isnan(change) == (status != "ok")


def test_curves_in_parameters_and_in_groups(tables):
    factors = dict.fromkeys(("damping", "stiffness", "frequency", "angle"), 1.3)
    settings = {**SETTINGS, "model": MODEL, "effort": 0.3, "factors": factors}
    found = curves.make(tables[0].iloc[:3], tables[1], settings)
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
