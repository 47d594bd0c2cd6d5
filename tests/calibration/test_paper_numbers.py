"""Quantities from edges and four trajectories, compared with the functions of the claims."""

import numpy as np
import pandas as pd
import pytest
from project import read_config
from scipy.interpolate import CubicSpline

from calibration import edges
from calibration import paper_numbers as numbers
from calibration.paper_numbers import PARAMETERS, parameters_at, searched
from calibration.search_space import values_at
from claims import about_states
from conveyor import ensemble
from conveyor.analysis.attractors.labels import classify
from conveyor.analysis.basins.hyperbola import Hyperbola, critical_height, mean_squared_error
from motion import critical
from pipeline import grid
from pipeline.rule_log import JobError
from scripts.calibration.settings import IDENTIFIED, NUMBERS_OF_CLAIMS

CONFIG = read_config()
MODEL, OWN = CONFIG["model"], CONFIG["identification"]
TRIPLE = CONFIG["regressions"]["height"]["paper"]
MEASURED = {
    "interval": [29.0, 47.0],
    "starts": [0.0, 0.5e-3, 11],
    "moved_starts": [0.07e-3, 0.13e-3, 11],
    "critical": {"C07": 40.0, "C08": 35.0},
    "triple": TRIPLE,
}
EULER = {"method": "euler", "duration": 1.0, "step": 5e-7, "settling": 1000, "mean_settling": 375}
# Contacts close to the printed one.
NEAR = {
    **OWN,
    "model": MODEL,
    "euler": EULER,
    "measured": MEASURED,
    "ranges": IDENTIFIED | {"damping": [0.24, 0.253], "stiffness": [65.0, 79.0]},
    "effort": 0.1,  # four losses and four groups
}
PRINTED = searched(NEAR)


@pytest.fixture(scope="module")
def direct() -> dict[str, float]:
    """All quantities at the printed parameters."""
    found = numbers.measure_directly(PRINTED, numbers.CONVERGED, NEAR, 1)
    return {name: float(value[0]) for name, value in found.items()}


def test_edges_by_the_paper_method_lie_a_little_lower():
    """Its critical heights are 1 to 4 % lower (docs/claims.md), so its edges are lower, too."""
    few = [5e-5, 1.3e-4]
    found = [numbers.edges_directly(PRINTED, method, NEAR, 1, few)[0] for method in (numbers.EULER, numbers.CONVERGED)]
    assert (0.99 * found[1] < found[0]).all() and (found[0] < found[1]).all()


def states(axes: dict, model: dict) -> pd.DataFrame:
    """A sweep with the columns that the claims read."""
    columns, parameters = grid.product(axes, MODEL_WITHOUT | model)
    velocity = ensemble.sweep(parameters, tolerance=1e-6)["mean_velocity"]
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
        "settling": 1000,
        "mean_settling": 375,
        "method": "event",
        "tolerance": 1e-6,
    }
    table = pd.DataFrame(critical.make(settings))
    for name, acceleration in (("C04.largest_height", 29.0), ("C07.height", 40.0), ("C08.height", 35.0)):
        assert direct[name] == pytest.approx(1e3 * about_states.critical_at(table, acceleration), abs=2e-4), name
    data = table[table.is_critical].sort_values("acceleration")
    amplitudes = CubicSpline(edges.HEIGHTS, numbers.edges_directly(PRINTED, numbers.CONVERGED, NEAR, 1), axis=1)
    fine = np.linspace(0.0, 5e-4, 1001)
    curve = numbers.Curve(fine, amplitudes(fine) / np.sin(MODEL["angle"]))
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
def splines():
    return numbers.interpolate_edges(pd.DataFrame(edges.make(NEAR)))


def test_interpolated_edges_agree_with_the_search(splines, direct):
    found = numbers.measure_by_table(PRINTED, splines, "allow", NEAR)
    for name, value in found.items():
        assert value[0] == pytest.approx(direct[name], rel=2e-3), name


def test_changes_of_state_need_no_trajectory(splines):
    found = numbers.measure_by_table(PRINTED, splines, "allow", NEAR)
    alone = numbers.measure_by_table(PRINTED, splines, "allow", NEAR, None)
    assert alone == {name: value for name, value in found.items() if name[:3] not in ("C05", "C06")}


def test_the_config_lists_the_measured_quantities(direct):
    assert set(NUMBERS_OF_CLAIMS) == set(direct)


def with_parameters(**changed):
    """Searched parameters of the printed conveyor with others."""
    return np.vstack([searched(NEAR, **row) for row in pd.DataFrame(changed).to_dict("records")])


def test_friction_changes_only_velocities(splines):
    found = numbers.measure_by_table(with_parameters(friction=[0.15, 0.20, 0.25]), splines, "allow", NEAR)
    for name, value in found.items():
        if name[:3] in ("C05", "C06"):
            assert (np.diff(value) > 0.05).all(), name
        else:
            assert np.ptp(value) == 0.0, name


def test_velocities_scale_with_friction_and_the_slope_of_the_excitation():
    """They are μ times a function of cot φ/μ and the vertical motion, because x/μ depends on a_x/μ only."""
    angle, friction = MODEL["angle"], MODEL["friction"]
    other = np.radians(13.0)
    frictions = np.array([friction, friction * np.tan(angle) / np.tan(other)])
    rows = parameters_at(with_parameters(friction=frictions, angle=[angle, other]), "allow", NEAR)
    rows["acceleration"] = 8.0 / np.sin(rows["angle"])
    velocities = numbers.converged_velocities(rows) / frictions
    assert velocities[0] == pytest.approx(velocities[1], rel=1e-6)


def test_velocities_equal_the_velocities_of_runs():
    rows = np.repeat(parameters_at(PRINTED, "clip", NEAR), 3, axis=0)
    rows["acceleration"], rows["z0"] = 40.0, [0.0, 1e-4, 3e-4]
    runs = ensemble.sweep(rows, tolerance=numbers.TOLERANCE)
    assert numbers.converged_velocities(rows).tolist() == runs["mean_velocity"].tolist()


def test_each_tension_mode_has_its_edges():
    columns = pd.MultiIndex.from_product(
        [[0.2, 0.24, 0.26, 0.3], [40.0, 60.0, 80.0, 90.0], ["allow", "clip"], [0.0, 1e-4]],
        names=["loss", "group", "tension", "z0"],
    ).to_frame(index=False)
    table = columns.assign(vertical_acceleration=np.where(columns.tension == "clip", 9.0, 8.0) + 1e4 * columns.z0)
    found = numbers.interpolate_edges(table)
    for tension, lowest in (("allow", 8.0), ("clip", 9.0)):
        assert found[tension](np.log([[0.25, 70.0]]))[0] == pytest.approx([lowest, lowest + 1.0])


def test_parameters_and_searched_parameters_are_inverse():
    changed = {"friction": [0.15, 0.3], "damping": [0.3, 0.2], "stiffness": [5e5, 1e5], "angle": [0.2, 0.25]}
    x = with_parameters(**changed)
    assert {name: value.tolist() for name, value in values_at(x, NEAR, PARAMETERS).items()} == {
        name: pytest.approx(value) for name, value in changed.items()
    }
    rows = parameters_at(x, "clip", NEAR)
    assert rows["friction"].tolist() == pytest.approx([0.15, 0.3])
    assert rows["tension"].tolist() == [2.0, 2.0]


def test_the_critical_height_is_the_lowest_that_leaves_the_first_state():
    """Also if the edge has a hump: lower heights that leave the first state count first."""
    heights = np.linspace(0.0, 4.0, 4001)
    found = numbers.Curve(heights, np.interp(heights, range(5), [50.0, 40.0, 45.0, 30.0, 60.0])[None])
    wanted = np.array([[55.0, 42.0, 41.0, 35.0, 30.0, 20.0]])
    assert found.critical_height(wanted)[0] == pytest.approx([0.0, 0.8, 0.9, 8.0 / 3.0, 3.0, 3.0], abs=2e-3)


def test_the_largest_critical_height_is_extrapolated_to_the_lower_end():
    """With the slope of Eq. 13, if the second state begins above it: two conveyors with edges 1 m/s² apart."""
    heights = np.linspace(0.0, 5e-4, 501)
    falling = 50.0 - 4e4 * heights
    found = numbers.Curve(heights, np.stack([np.maximum(falling, edge) for edge in (30.0, 31.0)]))
    one, other = numbers.changes_of_state(found, MEASURED, 0.25)["C04.largest_height"]
    below, above = critical_height(29.0 + np.array([-1e-4, 1e-4]), Hyperbola(**TRIPLE))
    slope = (above - below) / 2e-4
    assert one == pytest.approx(1e3 * (5e-4 - slope), rel=1e-3)
    assert other == pytest.approx(1e3 * (4.75e-4 - 2.0 * slope), rel=1e-3)


def test_a_table_with_a_missing_edge_is_an_error():
    table = pd.DataFrame(
        {"loss": [0.2], "group": [72.0], "tension": ["allow"], "z0": [0.0], "vertical_acceleration": [np.nan]}
    )
    with pytest.raises(JobError, match=r"no edge was found at the loss 0\.2"):
        numbers.interpolate_edges(table)
