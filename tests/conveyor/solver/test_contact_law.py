"""The functions of the contact law against their definitions, which hold for any law, on random conveyors.

A test fails if a function does not belong to the law `spring_and_damper`, also with a damper that is not linear.
"""

import math

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyval

from conveyor import Conveyor, Start
from conveyor.analysis import dimensionless_groups, stroboscopic_map
from conveyor.solver import contact, contact_law, model, plate
from conveyor.solver.model import TENSION_MODES, pack
from conveyor.solver.status import OK
from conveyor.solver.workspace import FIRST, SPARE, T, V, W

SPEEDS = np.geomspace(0.03, 3.0, 10)  # of an impact, in units of g/ω
EXPONENTS = [1.0, 1.5, 1.7]


def random_conveyor(seed, exponent, tension="allow"):
    """Packed parameters with groups D from 0.1 to 10 and K from 10 to 1e4, and the units of length and velocity."""
    random = np.random.default_rng(seed)
    mass, frequency, gravity = random.uniform(0.5, 2.0, 3) * (0.7e-3, 50.0, 9.81)
    changed = {"mass": mass, "frequency": frequency, "gravity": gravity, "exponent": exponent, "tension": tension}
    row = pack(Conveyor(acceleration=random.uniform(30.0, 120.0), **changed), Start())
    unit_of_stiffness, unit_of_damping, _ = dimensionless_groups.units_of_contact(row)
    row[model.STIFFNESS] = unit_of_stiffness * 10.0 ** random.uniform(1.0, 4.0)
    row[model.DAMPING] = unit_of_damping * 10.0 ** random.uniform(-1.0, 1.0)
    return row, dimensionless_groups.length_and_speed_units(row)


def leave(c, w, v):
    """v at the separation of a part on a plate at rest from w, v at s = 0."""
    series, event = contact.workspace(), contact.NOTHING
    while event != contact.SEPARATION:
        length = contact.begin_step(c, series, FIRST, w, v, 0.0, 1.0, False)
        _, w, v, _, event = contact.end_step(c, series, FIRST, w, v, False, length)
    return v


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_series_of_the_sign_has_the_sign_of_the_force(exponent, sign):
    """All along steps that begin with an impact or in the contact; at an impact it has a simple zero at most."""
    seen = set()
    for seed in range(20):
        parameters, (length_unit, speed_unit) = random_conveyor(seed, exponent)
        c, series, random = contact.constants(parameters, 1e-9), contact.workspace(), np.random.default_rng(seed)
        for speed in SPEEDS:
            touching = random.random() < 0.5
            w0 = 0.0 if touching else math.sqrt(random.uniform(0.0, 0.3) * length_unit)
            v0 = speed * speed_unit * (1.0 if touching else random.choice([-1.0, 1.0]))
            phase = random.uniform(0.0, 2.0 * math.pi)
            length = contact.begin_step(c, series, FIRST, w0, v0, math.sin(phase), math.cos(phase), False)
            assert contact_law.expand_sign(c, series, FIRST, SPARE, sign)
            assert series[SPARE] != 0.0 or (touching and series[SPARE + 1] != 0.0)
            for s in length * np.array([1e-6, 0.1, 0.4, 0.7, 1.0]):
                w, v, of_sign = (polyval(s, contact_law.row_of(series, row)) for row in (FIRST + W, FIRST + V, SPARE))
                force, spring = contact_law.force(c, w, v), contact_law.force(c, w, 0.0)
                if w > 0.0 and abs(force) > 1e-6 * spring:
                    assert np.sign(of_sign) == sign * np.sign(force)
                    seen.add(np.sign(force))
    assert seen == {-1.0, 1.0}


@pytest.mark.parametrize("tension", TENSION_MODES)
@pytest.mark.parametrize("exponent", EXPONENTS)
def test_damper_contracts_areas_by_its_factor(exponent, tension):
    """The determinant of the linearised map over one cycle, in which a part lands and takes off."""
    for seed in range(10):
        row, (length_unit, speed_unit) = random_conveyor(seed, exponent, tension)
        state = np.array([-0.5 * length_unit, 0.1 * speed_unit])
        status, matrices, features = stroboscopic_map.monodromy(row, 1e-12, state, 1, 0.0)
        assert status == OK
        assert features[0, stroboscopic_map.IMPACTS] > 0
        damper_time = features[0, stroboscopic_map.DAMPER_TIME]
        contraction = math.exp(contact_law.log_contraction(contact.constants(row, 1e-12), damper_time))
        (a, b), (d, e) = matrices[0]
        assert a * e - b * d == pytest.approx(contraction, rel=1e-7, abs=1e-9 * (abs(a * e) + abs(b * d)))


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_conveyors_with_equal_groups_have_the_same_motion(exponent):
    """Of different masses, frequencies and gravities: the states after one cycle, in units of g/ω² and g/ω."""
    for seed in range(10):
        row, units = random_conveyor(seed, exponent)
        alike, state = dimensionless_groups.packed(dimensionless_groups.groups_of(row)), np.array([-0.5, 0.1])
        _, strobes = stroboscopic_map.follow_map(row, 1e-12, state * units, 1)
        _, scaled = stroboscopic_map.follow_map(alike, 1e-12, state.copy(), 1)
        assert strobes / units == pytest.approx(scaled, rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_contacts_of_equal_loss_take_equal_shares_of_the_speed(exponent):
    """In impacts at the speed g/ω on a plate at rest, for contacts so stiff that gravity hardly acts in an impact."""
    conveyor, loss = Conveyor(acceleration=0.0, exponent=exponent), 1e-3
    table = pack(conveyor, Start())
    _, speed = dimensionless_groups.length_and_speed_units(table)
    shares = []
    for group in 10.0 ** np.array([7.0, 9.0, 11.0]):
        row = table.copy()
        row[[model.STIFFNESS, model.DAMPING]] = dimensionless_groups.contact_of_groups(group, loss, table)
        shares.append(1.0 + leave(contact.constants(row, 1e-12), 0.0, speed) / speed)
    assert shares == pytest.approx(np.full(3, shares[0]), rel=0.02)
    assert 0.1 * loss < shares[0] < 10.0 * loss


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_rates_along_a_step_are_those_of_its_series(exponent):
    """The force, and Y, into whose rate only the spring enters; and the inverse and the slope of Y."""
    for seed in range(20):
        parameters, (length_unit, speed_unit) = random_conveyor(seed, exponent)
        c, series, random = contact.constants(parameters, 1e-9), contact.workspace(), np.random.default_rng(seed)
        w0, phase = math.sqrt(random.uniform(0.05, 0.3) * length_unit), random.uniform(0.0, 2.0 * math.pi)
        sine, cosine = math.sin(phase), math.cos(phase)
        length = contact.begin_step(c, series, FIRST, w0, 0.5 * speed_unit, sine, cosine, False)
        contact_law.expand_force(c, series, FIRST, SPARE, 1.0)
        rows = [contact_law.row_of(series, row) for row in (FIRST + W, FIRST + V, FIRST + T, SPARE)]
        (w, v, t, product), *beside = ([polyval(s * length, row) for row in rows] for s in (0.3, 0.2999, 0.3001))
        (before, after), lapse = (np.array(beside), beside[1][2] - beside[0][2])
        force, press = (
            contact_law.force(c, w, v),
            c.gravity + plate.lift(c, *plate.sine_and_cosine(phase + c.omega * t)),
        )
        assert product == pytest.approx(w * force, rel=1e-7)
        rise = (contact_law.force(c, *after[:2]) - contact_law.force(c, *before[:2])) / lapse
        assert contact_law.force_rate(c, w, v, press) == pytest.approx(rise, rel=1e-4, abs=1e-5 * c.omega * abs(force))
        smooth = [contact_law.smooth_speed(c, one[0] ** 2, one[1]) for one in (before, after)]
        rate = press - contact_law.force(c, w, 0.0)
        assert (smooth[1] - smooth[0]) / lapse == pytest.approx(rate, rel=1e-4, abs=1e-5 * (c.gravity + abs(force)))
        assert contact_law.speed_of_approach(c, w * w, contact_law.smooth_speed(c, w * w, v)) == pytest.approx(v)
        shift = 1e-5 * w * w
        slope = [contact_law.smooth_speed(c, w * w + side * shift, v) / (2.0 * shift) for side in (-1.0, 1.0)]
        assert contact_law.smooth_slope(c, w * w) == pytest.approx(slope[1] - slope[0], rel=1e-5)
