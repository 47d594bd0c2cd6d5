"""Edges of basins, compared with the states on both sides, free fall, and solving again."""

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.analysis.attractors.labels import classify
from conveyor.analysis.basins import boundary_point
from conveyor.analysis.basins.boundary_point import InitialCondition, find_boundary_point
from conveyor.analysis.dimensionless_groups import (
    AMPLITUDE,
    GROUP_NAMES,
    HEIGHT,
    PHASE,
    VELOCITY,
    Groups,
    groups_of,
    length_and_speed_units,
)
from conveyor.solver.model import pack

ROW = pack(Conveyor(acceleration=40.0), Start())
GROUPS, (LENGTH, SPEED) = groups_of(ROW), length_and_speed_units(ROW)


@pytest.fixture(scope="module")
def edge():
    return find_boundary_point(InitialCondition(7.19e-5 / LENGTH, 0.0, 0.0), GROUPS, HEIGHT)


def test_both_sides_lead_to_different_states(edge):
    height = edge.launch.height * LENGTH
    rows = np.array([pack(Conveyor(acceleration=40.0), Start(height + part)) for part in (-1e-10, 1e-10)])
    assert classify(rows).state.tolist() == ["first", "second"]


def test_the_images_converge_to_the_saddle(edge):
    unstable, stable = edge.multipliers
    assert abs(unstable) > 1.0 > abs(stable) > 0.0
    distances = np.linalg.norm(edge.images - edge.saddle, axis=1)
    assert distances[-1] < boundary_point.NEAR
    ratios = distances[3:] / distances[2:-1]
    assert ratios[distances[3:] > 1e-8][1:] == pytest.approx(abs(stable), rel=0.1)


@pytest.mark.parametrize("velocity", [0.0, 0.15])
def test_a_later_point_of_the_same_flight_lies_on_the_same_edge(velocity):
    """dz = ż dt, dż = -g dt, dψ = ω dt: the equations of contact are not needed."""
    edge = find_boundary_point(InitialCondition(0.7, velocity, 0.0), GROUPS, HEIGHT)
    assert edge.moves[PHASE] - edge.moves[VELOCITY] == pytest.approx(velocity, abs=1e-8)


def test_the_edge_solved_again_moves_as_its_derivatives_say(edge):
    values = dict(zip(GROUP_NAMES, (*GROUPS[:4], *edge.launch), strict=True))
    for place, name in enumerate(GROUP_NAMES):
        if place == HEIGHT:
            continue
        step = 1e-5 * max(abs(values[name]), 1.0)
        ends = []
        for sign in (1.0, -1.0):
            *groups, height, velocity, psi0 = (values | {name: values[name] + sign * step}).values()
            ends.append(
                find_boundary_point(InitialCondition(height, velocity, psi0), Groups(*groups, 0), HEIGHT).launch.height
            )
        assert edge.moves[place] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-5, abs=1e-7)


def test_amplitude_and_height_are_two_sides_of_one_edge(edge):
    """The two derivatives are inverse to each other."""
    other = find_boundary_point(edge.launch, edge.groups, AMPLITUDE)
    assert other.groups.amplitude == pytest.approx(GROUPS.amplitude, rel=1e-9)
    assert other.moves[HEIGHT] * edge.moves[AMPLITUDE] == pytest.approx(1.0, rel=1e-6)


def test_an_initial_condition_far_from_any_edge_has_a_reason():
    assert isinstance(find_boundary_point(InitialCondition(0.0, 0.0, 0.0), GROUPS._replace(amplitude=0.1), HEIGHT), str)
