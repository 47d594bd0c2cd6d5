"""Dimensionless groups of a contact: closed forms, change of units, and the inverse."""

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.analysis.dimensionless_groups import contact_of_groups, groups_of, groups_of_contact
from conveyor.solver.model import pack


def packed(**changed):
    return pack(Conveyor(**changed), Start())


def test_the_loss_of_a_hooke_contact_is_twice_the_damping_ratio():
    mass = 0.7e-3
    _, loss = groups_of_contact(2e3, 0.3, packed(exponent=1.0, mass=mass))
    assert loss == pytest.approx(0.3 / np.sqrt(2e3 * mass))


def test_the_stiffness_is_the_group_of_the_vertical_motion():
    rows = packed(stiffness=3e5, damping=0.2, frequency=80.0, inclination=0.1)
    group, loss = groups_of_contact(3e5, 0.2, rows)
    groups = groups_of(rows)
    assert group == pytest.approx(groups.stiffness)
    assert loss == pytest.approx(groups.damping * groups.stiffness ** (-1.0 / 2.5))


def test_groups_do_not_depend_on_the_units():
    """Lengths in cm and masses in g: N = kg m/s², so that N/m^1.5 takes 10^(3 + 2 - 3) and N s/m 10^(3 + 2 - 2)."""
    si = packed()
    other = packed(mass=1e3 * 0.7e-3, gravity=1e2 * 9.81)
    assert groups_of_contact(5e5 * 1e2, 0.3e3, other) == pytest.approx(groups_of_contact(5e5, 0.3, si))


def test_groups_on_a_rising_track_follow_gravity_normal_to_it():
    level, rising = packed(gravity=9.81 * np.cos(0.4)), packed(inclination=0.4)
    assert groups_of_contact(5e5, 0.3, rising) == pytest.approx(groups_of_contact(5e5, 0.3, level))


def test_contacts_and_groups_are_inverse_for_many_conveyors():
    rows = np.stack([packed(frequency=50.0), packed(frequency=20.0, mass=0.1, exponent=1.2)])
    stiffness, damping = np.array([5e5, 2e6]), np.array([0.3, 4.0])
    found = contact_of_groups(*groups_of_contact(stiffness, damping, rows), rows)
    assert np.stack(found) == pytest.approx(np.stack([stiffness, damping]))
