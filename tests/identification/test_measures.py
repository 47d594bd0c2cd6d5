"""Quantities from edges and four trajectories, compared with the functions of the claims."""

import numpy as np
import pandas as pd
import pytest
from project import read_config

from claims import about_states
from conveyor import ensemble
from conveyor.analysis.attractors.labels import classify
from conveyor.analysis.basins.hyperbola import Hyperbola, critical_height, mean_squared_error
from identification import edges, measures, printed
from identification.search_space import PARAMETERS, packed
from identification.settings import NUMBERS_OF_CLAIMS
from motion import critical
from pipeline import grid

CONFIG = read_config()
MODEL, OWN = CONFIG["model"], CONFIG["identification"]
PRINTED = np.array([MODEL[name] for name in PARAMETERS])
TRIPLE = CONFIG["regressions"]["height"]["paper"]
MEASURED = {
    "inside": 0.25,
    "interval": [29.0, 47.0],
    "starts": [0.0, 0.5e-3, 11],
    "moved_starts": [0.07e-3, 0.13e-3, 11],
    "critical": {"C07": 40.0, "C08": 35.0},
    "triple": TRIPLE,
    "bounds_of_b": [-28.0, 0.0],
}
# Contacts close to the printed one.
NEAR = {
    **OWN,
    "model": MODEL,
    "measured": MEASURED,
    "bounds": OWN["bounds"] | {"loss": [0.24, 0.253], "stiffness": [4.5e5, 5.5e5]},
    "contacts": {"loss": 4, "stiffness": 4},
    "heights": [0.0, 2e-5, 5e-5, 7e-5, 1e-4, 1.3e-4, 1.6e-4, 2e-4, 2.5e-4, 3e-4, 3.5e-4, 4e-4, 4.5e-4, 5e-4],
    "edges": OWN["edges"] | {"vertical_acceleration": {"start": 5.0, "stop": 11.0, "num": 5}},
}


@pytest.fixture(scope="module")
def direct() -> dict[str, float]:
    """All quantities at the printed parameters."""
    return printed.measure(PRINTED, "allow", printed.CONVERGED, NEAR, 1)


def test_edges_by_the_paper_method_lie_a_little_lower():
    """Its critical heights are 1 to 4 % lower (docs/claims.md), so its edges are lower, too."""
    euler = {"method": "euler", "duration": 1.0, "step": 5e-7, "settling": 1000}
    few = NEAR | {"heights": [5e-5, 1.3e-4], "euler": euler, "edges": NEAR["edges"] | {"resolution": 2e-3}}
    found = [printed.edges_at(PRINTED, "allow", method, few, 1) for method in (printed.EULER, printed.CONVERGED)]
    assert (0.99 * found[1] < found[0]).all() and (found[0] < found[1]).all()


def states(axes: dict, model: dict) -> pd.DataFrame:
    """A sweep with the columns that the claims read."""
    columns, parameters = grid.product(axes, MODEL_WITHOUT | model)
    velocity = ensemble.run(parameters, tolerance=1e-6)["mean_velocity"]
    return pd.DataFrame(columns | {"mean_velocity": velocity, "state": classify(parameters, tolerance=1e-6).state})


MODEL_WITHOUT = {name: value for name, value in MODEL.items() if name not in ("acceleration", "z0")}


def test_places_agree_with_the_claims_on_a_thin_axis(direct):
    """The claims use the first or the last amplitude of an axis, so the edge lies within one of its steps."""
    step = 0.25
    ends = np.concatenate([np.arange(28.25, 29.5, step), np.arange(48.75, 50.25, step)])
    table = states({"acceleration": ends, "z0": np.linspace(0.0, 0.5e-3, 11)}, {})
    assert 0.0 < about_states.second_from_rest(table) - direct["C01.critical_amplitude"] <= step
    low, high = about_states.two_states(table)
    assert 0.0 <= low - direct["C02.lower_end"] <= step
    assert 0.0 <= direct["C02.upper_end"] - high <= step
    table = states(
        {
            "acceleration": np.concatenate([np.arange(34.75, 36.0, step), np.arange(39.5, 40.75, step)]),
            "z0": np.linspace(0.07e-3, 0.13e-3, 11),
        },
        {},
    )
    low, high = about_states.two_states(table)
    assert 0.0 <= low - direct["C10.lower_end"] <= step
    assert 0.0 <= direct["C10.upper_end"] - high <= step


def test_critical_heights_and_their_fit_agree_with_the_claims(direct):
    settings = {
        "axes": {"acceleration": [29.0, 32.0, 35.0, 38.0, 40.0, 44.0, 47.0]},
        "model": MODEL_WITHOUT,
        "scan": {"start": 0.0, "stop": 0.5e-3, "num": 11},
        "resolution": 1e-8,
        "settling": 1000,
        "method": "event",
        "tolerance": 1e-6,
    }
    table = pd.DataFrame(critical.make(settings))
    for name, acceleration in (("C04.largest_height", 29.0), ("C07.height", 40.0), ("C08.height", 35.0)):
        assert direct[name] == pytest.approx(1e3 * about_states.critical_at(table, acceleration), abs=2e-4), name
    data = table[table.is_critical].sort_values("acceleration")
    one = printed.edges_at(PRINTED, "allow", printed.CONVERGED, NEAR, 1)
    curve = measures.edge_curve(np.array(NEAR["heights"]), one[None], PRINTED[3:])
    heights = curve.critical_height(data.acceleration.to_numpy()[None])[0]
    assert heights == pytest.approx(data.z0.to_numpy(), abs=3e-7)
    errors = [
        mean_squared_error(data.acceleration.to_numpy(), z0, Hyperbola(**TRIPLE))
        for z0 in (heights, data.z0.to_numpy())
    ]
    assert errors[0] == pytest.approx(errors[1], rel=0.02)
    assert direct["C09.error"] == pytest.approx(2.94e-11, rel=0.01)  # docs/claims.md, the note of C09


def test_velocities_agree_with_the_claims(direct):
    """Up to the differences between initial conditions of one state after a second."""
    table = states({"acceleration": [29.0, 47.0], "z0": np.linspace(0.0, 0.4e-3, 41)}, {})
    first, second = (about_states.velocities(table, state) for state in ("first", "second"))
    assert direct["C05.velocity_at_lower_end"] == pytest.approx(first[0], abs=0.005)
    assert direct["C05.velocity_at_upper_end"] == pytest.approx(first[1], abs=0.02)
    assert direct["C06.fall"] == pytest.approx(second[0] - second[1], abs=0.005)


@pytest.fixture(scope="module")
def interpolated() -> measures.Edges:
    return measures.interpolate_edges(pd.DataFrame(edges.make(NEAR)))


def test_interpolated_edges_agree_with_the_search(interpolated, direct):
    found = measures.quantities_at(interpolated, PRINTED[None], "allow", NEAR)
    for name, value in found.items():
        assert value[0] == pytest.approx(direct[name], rel=2e-3), name


def test_the_config_lists_the_measured_quantities(direct):
    assert set(NUMBERS_OF_CLAIMS) == {name for name in direct if name not in ("C09.A", "C09.B", "C09.C")}


def test_friction_changes_only_velocities(interpolated):
    values = np.tile(PRINTED, (3, 1))
    values[:, 0] = 0.15, 0.20, 0.25
    found = measures.quantities_at(interpolated, values, "allow", NEAR)
    for name, value in found.items():
        if name[:3] in ("C05", "C06"):
            assert (np.diff(value) > 0.05).all(), name
        else:
            assert np.ptp(value) == 0.0, name


def test_velocities_scale_with_friction_and_the_slope_of_the_excitation(interpolated):
    """They are μ times a function of cot φ/μ and the vertical motion, because x/μ depends on a_x/μ only."""
    angle = np.radians(13.0)
    values = np.tile(PRINTED, (2, 1))
    values[1, 3] = angle
    values[1, 0] = values[0, 0] * np.tan(values[0, 3]) / np.tan(angle)
    rows = packed(values, "allow", MODEL)
    rows[:, 0] = 8.0 / np.sin(values[:, 3])
    velocities = measures.converged_velocities(rows) / values[:, 0]
    assert velocities[0] == pytest.approx(velocities[1], rel=1e-6)


def test_velocities_equal_the_velocities_of_runs():
    rows = np.repeat(packed(PRINTED[None], "clip", MODEL), 3, axis=0)
    rows[:, 0], rows[:, 11] = 40.0, [0.0, 1e-4, 3e-4]
    runs = ensemble.run(rows, tolerance=measures.TOLERANCE)
    assert measures.converged_velocities(rows).tolist() == runs["mean_velocity"].tolist()


def test_tension_modes_have_different_edges():
    """Only `frictionless` has the edges of `allow`, because the vertical motion does not depend on friction."""
    columns = pd.MultiIndex.from_product(
        [[0.2, 0.24, 0.26, 0.3], [4e5, 5e5, 6e5, 7e5], ["allow", "clip"], [0.0, 1e-4]],
        names=["loss", "stiffness", "tension", "z0"],
    ).to_frame(index=False)
    table = columns.assign(vertical_acceleration=np.where(columns.tension == "clip", 9.0, 8.0) + 1e4 * columns.z0)
    found = measures.interpolate_edges(table)
    rows = packed(PRINTED[None], "allow", MODEL)
    for reading, lowest in (("allow", 8.0), ("frictionless", 8.0), ("clip", 9.0)):
        assert measures.vertical_edges(found, rows, reading, MODEL)[0] == pytest.approx([lowest, lowest + 1.0])


def test_the_critical_height_is_the_lowest_that_leaves_the_first_state():
    """Also if the edge has a hump: lower heights that leave the first state count first."""
    heights = np.linspace(0.0, 4.0, 4001)
    found = measures.Curve(heights, np.interp(heights, range(5), [50.0, 40.0, 45.0, 30.0, 60.0])[None])
    wanted = np.array([[55.0, 42.0, 41.0, 35.0, 30.0, 20.0]])
    assert found.critical_height(wanted)[0] == pytest.approx([0.0, 0.8, 0.9, 8.0 / 3.0, 3.0, 3.0], abs=2e-3)


def test_the_largest_critical_height_is_extrapolated_to_the_lower_end():
    """With the slope of Eq. 13, if the second state begins above it: two conveyors with edges 1 m/s² apart."""
    heights = np.linspace(0.0, 5e-4, 501)
    falling = 50.0 - 4e4 * heights
    found = measures.Curve(heights, np.stack([np.maximum(falling, edge) for edge in (30.0, 31.0)]))
    one, other = measures.changes_of_state(found, MEASURED)["C04.largest_height"]
    below, above = critical_height(29.0 + np.array([-1e-4, 1e-4]), Hyperbola(**TRIPLE))
    slope = (above - below) / 2e-4
    assert one == pytest.approx(1e3 * (5e-4 - slope), rel=1e-3)
    assert other == pytest.approx(1e3 * (4.75e-4 - 2.0 * slope), rel=1e-3)


def test_a_table_with_a_missing_edge_is_an_error(interpolated):
    table = pd.DataFrame(
        {"loss": [0.2], "stiffness": [5e5], "tension": ["allow"], "z0": [0.0], "vertical_acceleration": [np.nan]}
    )
    with pytest.raises(ValueError, match=r"no edge was found at the loss 0\.2"):
        measures.interpolate_edges(table)
