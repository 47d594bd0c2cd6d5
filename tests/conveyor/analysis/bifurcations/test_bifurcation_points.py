"""Bifurcations in dimensionless groups, compared with closed forms and with continuation."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.analysis import stroboscopic_map
from conveyor.analysis.bifurcations import bifurcation_points, continuation, periodic_orbits
from conveyor.analysis.bifurcations.bifurcation_points import find_bifurcation
from conveyor.analysis.bifurcations.newton import difference_quotients
from conveyor.analysis.dimensionless_groups import Groups, amplitude_of, groups_of, length_and_speed_units, packed
from conveyor.solver import contact
from conveyor.solver.model import PARAMETERS, pack

PAPER = pack(Conveyor(), Start())
# (x, y, Γ) close to the first fold and the first doubling of the paper's conveyor.
GUESSES = {"fold": (-3.41, 1.614, 0.50815), "period_doubling": (-6.257, 0.5009, 1.1491)}


def of_paper(kind):
    return find_bifurcation(kind, 1, GUESSES[kind], groups_of(PAPER))


def rigid(kind, damping_ratio):
    """Speed at an impact and push of the plate, with Γ = √(speed² + push²), of a ball with a linear contact."""
    restitution = math.exp(-math.pi * damping_ratio / math.sqrt(1.0 - damping_ratio**2))
    speed = math.pi * (1.0 - restitution) / (1.0 + restitution)
    push = 0.0 if kind == "fold" else -2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2
    return speed, push


@pytest.mark.parametrize("kind", ["fold", "period_doubling"])
@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_a_stiff_linear_contact_is_the_rigid_bouncing_ball(kind, ratio):
    """Fold and doubling of the ball have closed forms; its restitution follows from D/(2 √K)."""
    speed, push = rigid(kind, ratio)
    amplitude, phase = math.hypot(speed, push), math.atan2(speed, push)
    stiffness = 1e9
    groups = Groups(amplitude, 2.0 * ratio * math.sqrt(stiffness), stiffness, 1.0, 0)
    flown = 2.0 * math.pi - phase
    state = (push - math.pi * flown + 0.5 * flown**2 - amplitude, flown - math.pi)
    point = find_bifurcation(kind, 1, (*state, amplitude), groups)
    assert point.groups.amplitude == pytest.approx(amplitude, rel=3e-4)


def alike(groups, **changed):
    """Another conveyor with the same groups D, K and p."""
    other = Conveyor(**changed)
    omega = 2.0 * math.pi * other.frequency
    stiffness = (
        groups.stiffness * other.mass * omega ** (2.0 * groups.exponent) / other.gravity ** (groups.exponent - 1)
    )
    damping = groups.damping * other.mass * omega
    return pack(Conveyor(**changed, stiffness=stiffness, damping=damping), Start())


def test_two_conveyors_with_the_same_groups_have_the_same_scaled_fold():
    """The continuation in SI units does not use the groups; the other conveyor is a bowl feeder on the Moon."""
    groups = groups_of(PAPER)
    other = alike(groups, frequency=100.0, angle=0.35, mass=5e-3, gravity=1.62, friction=0.4)
    assert groups_of(other)[1:] == pytest.approx(groups[1:])
    start = stroboscopic_map.initial_states(pack(Conveyor(), Start(3e-4))[None], 1e-13)[0]
    jumping = periodic_orbits.settled_orbit(PAPER, start, (1,), 400)
    ratios = []
    for parameters in (PAPER, other):
        state = jumping.state / length_and_speed_units(PAPER) * length_and_speed_units(parameters)
        row = parameters.copy()
        row[PARAMETERS.index("acceleration")] = amplitude_of(parameters, groups.amplitude)
        orbit = periodic_orbits.orbit_near(row, state, 1)
        assert orbit.multipliers == pytest.approx(jumping.multipliers, rel=1e-7)
        limits = amplitude_of(parameters, 0.505), amplitude_of(parameters, 1.0)
        branch = continuation.follow_branch(orbit, "acceleration", limits)
        (fold,) = [found for found in branch.bifurcations if found.kind == "fold"]
        ratios.append(fold.orbit.acceleration / amplitude_of(parameters, 1.0))
    assert ratios[0] == pytest.approx(ratios[1], rel=1e-8)
    assert ratios[0] == pytest.approx(of_paper("fold").groups.amplitude, rel=1e-8)


def test_groups_of_the_scaled_conveyor_are_unchanged():
    groups = groups_of(PAPER)
    assert groups_of(packed(groups)) == pytest.approx(groups)


def test_a_state_at_another_phase_is_moved_to_phase_zero():
    row = PAPER.copy()
    row[PARAMETERS.index("acceleration")] = 40.0
    orbit = periodic_orbits.orbit_near(row, np.array([-6.2e-4 * 0.9, 0.03]), 1)
    assert orbit is not None
    length, _ = length_and_speed_units(row)
    here = bifurcation_points.at_phase_zero(row, orbit.state)
    assert here[0] == pytest.approx(orbit.state[0] / length)
    # A cycle that begins a quarter later.
    later = row.copy()
    later[PARAMETERS.index("psi0")] = 0.5 * math.pi
    c = contact.constants(row, 1e-13)
    state, features = orbit.state.copy(), np.zeros(stroboscopic_map.FEATURES)
    stroboscopic_map.advance(c, contact.workspace(), state, 0.0, 0.25 * c.period, np.empty((0, 2)), features)
    assert bifurcation_points.at_phase_zero(later, state) == pytest.approx(here, rel=1e-8)


def test_difference_quotients_of_functions_with_known_derivatives():
    here = np.array([0.3, -1.1])
    slopes_there = difference_quotients(lambda u: np.array([u[0] ** 2 * u[1], math.sin(u[1]), 4.0 * u[0]]), here, 1e-5)
    assert slopes_there == pytest.approx(np.array([[-0.66, 0.09], [0.0, math.cos(-1.1)], [4.0, 0.0]]), abs=1e-7)
