"""The slow reference compared with closed forms and known mean velocities."""

import math

import numpy as np
import pytest
from reference import Plate, reference_mean_velocity, reference_segments, reference_states, states_at
from scipy.special import gamma

from conveyor import Conveyor, Start


def test_a_known_mean_velocity():
    """Of two other integrators, each converged to about 1e-10."""
    assert reference_mean_velocity(Conveyor(), Start(z=3e-4), 1.0) == pytest.approx(0.0650828019770, rel=3e-10)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 3.0])
def test_undamped_impact_on_a_plate_at_rest(exponent):
    """Penetration, duration and restitution of an undamped power-law impact; gravity is negligible."""
    speed = 0.5
    conveyor = Conveyor(acceleration=0.0, damping=0.0, exponent=exponent, stiffness=5e5, gravity=1e-3)
    depth = ((exponent + 1.0) * conveyor.mass * speed**2 / (2.0 * conveyor.stiffness)) ** (1.0 / (exponent + 1.0))
    share = 1.0 / (exponent + 1.0)
    lasting = 2.0 * depth / speed * math.sqrt(math.pi) * gamma(1.0 + share) / gamma(0.5 + share)
    segments = reference_segments(conveyor, Start(z="conveyor", vz=-speed), 1.5 * lasting)
    contact = [segment for segment in segments if segment.mode.contact]
    assert contact[-1].end == pytest.approx(lasting, rel=1e-4)
    # The contact is split at its deepest point.
    assert contact[0].state(contact[0].end)[0] == pytest.approx(-depth, rel=1e-4)
    assert segments[-1].state(contact[-1].end)[1] == pytest.approx(speed, rel=1e-10)


@pytest.mark.parametrize("tension", ["allow", "frictionless", "clip"])
def test_horizontal_motion_is_the_integral_of_the_friction_force(tension):
    conveyor, start = Conveyor(tension=tension), Start(z=3e-4)
    segments = reference_segments(conveyor, start, 0.06)
    momentum = 0.0
    nodes, weights = np.polynomial.legendre.leggauss(40)
    for segment in segments:
        half = 0.5 * (segment.end - segment.begin)
        # Samples belong to the segment that ends at or after them, so the nodes stay inside.
        force = states_at(conveyor, segments, segment.begin + half * (1.0 + nodes))["friction_force"]
        momentum += half * np.dot(weights, force)
    last = states_at(conveyor, segments, np.array([0.06]))
    assert momentum == pytest.approx(conveyor.mass * last["vx"][0], rel=1e-7)


def test_linear_contact_is_a_forced_damped_oscillator():
    """p = 1 and a_z < g: the part never leaves the plate, and the motion is a closed form."""
    conveyor = Conveyor(acceleration=30.0, exponent=1.0, stiffness=3e3, psi0=0.4)
    plate = Plate.of(conveyor)
    times = np.linspace(0.0, 0.05, 101)
    kappa, decay = conveyor.stiffness / conveyor.mass, conveyor.damping / conveyor.mass
    z0 = plate.z(0.0) - conveyor.gravity / kappa
    states = reference_states(conveyor, Start(z=z0, vz=plate.z(0.0, 1)), times)
    # q̈ + (d/m) q̇ + (k/m) q = -g - a_z cos θ, from q = -mg/k and q̇ = 0.
    a_z = conveyor.acceleration * math.sin(conveyor.angle)
    response = -a_z / (kappa - plate.omega**2 + 1j * plate.omega * decay)
    forced = response * np.exp(1j * (plate.omega * times + plate.psi0))
    root = -0.5 * decay + 1j * math.sqrt(kappa - 0.25 * decay**2)
    # The free part Re(c e^{rt}) cancels the forced one and its rate at t = 0.
    value, rate = -forced[0].real, (plate.omega * forced[0]).imag
    free = (complex(value, (root.real * value - rate) / root.imag) * np.exp(root * times)).real
    q = -conveyor.gravity / kappa + forced.real + free
    np.testing.assert_allclose(states["z"] - plate.z(times), q, rtol=0.0, atol=1e-14)
