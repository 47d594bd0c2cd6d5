"""Single steps of the contact and what friction does in them, against energies and impulses."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.solver import contact, friction, vertical
from conveyor.solver.horizontal import Segment
from conveyor.solver.model import pack
from conveyor.solver.record import Step
from conveyor.solver.workspace import FIRST, SPRING


def constants(tolerance, **model):
    return contact.constants(pack(Conveyor(**model), Start()), tolerance)


def segment(sigma, mu):
    """One that begins with its contact step, at the plate's lowest point."""
    return Segment(sigma, mu, x=0.0, vx=0.0, s=0.0, t=0.0, sine=0.0, cosine=1.0, z=0.0, vz=0.0, w=0.0, v=0.0)


def piece(duration, length):
    return vertical.Piece(vertical.CONTACT, duration, length, contact.NOTHING, 0.0, 0.0, 0.0, 1.0, False)


@pytest.mark.parametrize("exponent", [1.0, 1.5])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_a_step_errs_by_its_tolerance(exponent, tolerance):
    """Without damping, on a plate at rest, v²/2 + k δ^(p+1)/(m (p+1)) - g δ stays as it was at the impact."""
    stiffness = 5e5 if exponent == 1.5 else 3e3
    c = constants(tolerance, acceleration=0.0, damping=0.0, exponent=exponent, stiffness=stiffness)
    for speed in np.geomspace(c.scale_v, 1e3 * c.scale_v, 20):
        series, w, v, sine, cosine = contact.workspace(), 0.0, speed, 0.0, 1.0
        steps, event = 0, contact.NOTHING
        while event != contact.SEPARATION:
            length = contact.begin_step(c, series, FIRST, w, v, sine, cosine, False)
            _, w, v, lapse, event = contact.end_step(c, series, FIRST, w, v, False, length)
            phase = math.atan2(sine, cosine) + c.omega * lapse
            sine, cosine = math.sin(phase), math.cos(phase)
            steps += 1
            spring = c.stiffness * w ** (2.0 * exponent + 2.0) / (exponent + 1.0) - c.gravity * w * w
            assert abs(0.5 * v * v + spring - 0.5 * speed * speed) <= steps * tolerance * speed * speed
        assert v == pytest.approx(-speed, rel=steps * tolerance + 1e-14)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
def test_a_part_that_the_plate_leaves_behind_separates_once(tolerance):
    """At its top the plate falls with a > g. Next to its surface, where the spring is nothing, a part comes out of it
    with v² = v0² + 2 (a - g) δ0, and no step, however long it could be, swings through to the other side.
    """
    c = constants(tolerance, acceleration=100.0, angle=0.5 * math.pi, damping=0.0)
    pull = c.a_z - c.gravity
    for speed in c.rest_speed * np.geomspace(1.0, 10.0, 30):
        depth = 0.5 * speed * speed / pull
        for share in (0.1, 1.0, 10.0):
            w, v0 = math.sqrt(depth), -share * speed
            series, v, event = contact.workspace(), v0, contact.NOTHING
            for _ in range(20):
                length = contact.begin_step(c, series, FIRST, w, v, 0.0, -1.0, False)
                _, w, v, _, event = contact.end_step(c, series, FIRST, w, v, False, length)
                if event != contact.NOTHING:
                    break
            assert (event, w) == (contact.SEPARATION, 0.0)
            assert v == pytest.approx(-math.hypot(v0, speed), rel=1e-4, abs=tolerance * c.scale_v)


def test_slip_may_end_before_the_force_pulls():
    """A force that gives 1.2 m/s and then takes 0.5 m/s back has ended a slip of 1 m/s in between."""
    c = constants(1e-8, acceleration=0.0)._replace(damping=2.0)
    lapse, fastest = 0.01, 25.0  # a part that separates as fast all the time is pulled for damping × fastest × lapse
    pulled = c.damping * fastest * lapse
    assert pulled == pytest.approx(0.5)
    slips = segment(1.0, 1.0), piece(lapse, 1.0)
    assert not friction.keeps_slipping(c, *slips, 1.0, 0.0, 1.2 - pulled, fastest)
    assert friction.keeps_slipping(c, *slips, 1.0, 0.0, 0.9 - pulled, fastest)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_part_at_relative_rest_stays_within_the_cone_of_friction(sign):
    """Filippov: it rests while |ẍ_s| ≤ μ F_c/m, and else slips with the sign of ẍ_s, also without friction."""
    c = constants(1e-8)
    assert friction.direction_at_rest(c, sign * 0.2 * 9.0 * (1.0 - 1e-4), 9.0, 0.2) == 0.0
    assert friction.direction_at_rest(c, sign * 0.2 * 9.0 * (1.0 + 1e-4), 9.0, 0.2) == sign
    assert friction.direction_at_rest(c, sign * 1e-12, 9.0, 0.0) == sign


@pytest.mark.parametrize(("roots", "lasting"), [([0.3], True), ([0.3, 0.6], False), ([0.3, 1.5], True)])
def test_slip_that_follows_stick_lasts_while_the_force_is_too_small(roots, lasting):
    """A force that is missing from 0.3 of a step on, and is back at 0.6 of it: from there on the slip may end."""
    c = constants(1e-8)._replace(stiffness=1.0, damping=0.0, friction=1.0, a_x=1e-12)
    series, margin = contact.workspace(), np.ones(1)
    for root in roots:
        margin = np.convolve(margin, [1.0, -1.0 / root])
    series[FIRST + SPRING : FIRST + SPRING + len(margin)] = margin
    step = Step(series, FIRST, vertical.motion_at(c, -1.0, 0.0, 0.0, 0.0), piece(1.0, 1.0), 0.0)
    end, lasts = friction.stick_end(c, step, segment(0.0, 1.0))
    assert end == pytest.approx(0.3, abs=1e-5)
    assert lasts == lasting


@pytest.mark.parametrize("acceleration", [20.0, 80.0])
def test_a_part_at_the_surface_rests_enters_or_leaves(acceleration):
    """At the plate's top, where the plate presses on the part or, at 80 m/s², falls away from it."""
    c = constants(1e-9, acceleration=acceleration, psi0=math.pi)
    motions = [vertical.motion_at(c, 0.0, rate * c.rest_speed, 0.0, c.psi0) for rate in (-2.0, -0.5, 0.0, 0.5, 2.0)]
    presses = acceleration == 20.0
    assert [motion.touching for motion in motions] == [True, True, presses, presses, False]
    assert [vertical.is_grazing(c, motion) for motion in motions[:4]] == [False, presses, True, True]
    assert not any(motion.v < 0.0 for motion in motions if motion.touching)
