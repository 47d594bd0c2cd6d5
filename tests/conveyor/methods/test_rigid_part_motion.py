"""The rigid bouncing part: geometric series, the period-1 orbit, collapse and rest, the limit of a stiff contact."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from conveyor import Conveyor, Start, simulate
from conveyor.methods import rigid_part_motion, rigid_part_rest
from conveyor.methods.restitution import restitution_coefficients
from conveyor.solver import contact
from conveyor.solver.model import conveyor_motion, pack

G = 9.81
OMEGA = 100.0 * math.pi
PERIOD = 0.02


def vertical(acceleration, **others):
    """A conveyor that vibrates vertically with the given amplitude (m/s²)."""
    return Conveyor(acceleration=acceleration, angle=0.5 * math.pi, **others)


def impacts_of(parameters, duration, restitution):
    """Times (s) and speeds (m/s) of all impacts of a run, and the flights (s) before them."""
    return rigid_part_motion.samples_and_impacts(parameters, np.array([duration]), restitution)[1]


@pytest.mark.parametrize("e", [0.3, 0.5, 0.9])
def test_bouncing_on_a_plate_at_rest(e):
    """Speeds and times of flight are geometric series; their sum is finite, and rest follows."""
    height = 2e-3
    parameters = pack(Conveyor(acceleration=0.0), Start(z=height))
    speed = math.sqrt(2.0 * G * height)
    collapse = speed / G * (1.0 + e) / (1.0 - e)
    impacts = impacts_of(parameters, 1.5 * collapse, e)
    k = np.arange(len(impacts))
    assert len(impacts) > 10
    np.testing.assert_allclose(impacts["speed"], speed * e**k, rtol=1e-5)
    times = speed / G * (1.0 + 2.0 * e * (1.0 - e**k) / (1.0 - e))
    np.testing.assert_allclose(impacts["time"], times, rtol=1e-10)
    np.testing.assert_allclose(impacts["flight"], np.diff(times, prepend=0.0), rtol=1e-5)
    run = rigid_part_motion.run(parameters, 1.5 * collapse, e)
    assert (run.z, run.vz, run.max_gap, run.status) == (0.0, 0.0, height, "ok")


def test_elastic_bounces_keep_their_height():
    height = 2e-3
    parameters = pack(Conveyor(acceleration=0.0), Start(z=height))
    fall = math.sqrt(2.0 * height / G)
    impacts = impacts_of(parameters, 10.0, 1.0)
    np.testing.assert_allclose(impacts["time"], fall * (2.0 * np.arange(len(impacts)) + 1.0), rtol=1e-9)
    summits = rigid_part_motion.sample(parameters, 2.0 * fall * np.arange(20.0), 1.0)
    np.testing.assert_allclose(summits["z"], height, rtol=1e-9)
    np.testing.assert_allclose(summits["vz"], 0.0, atol=1e-9)


def test_restitution_as_a_table():
    """The coefficient is interpolated linearly in the table and constant outside."""
    parameters = pack(Conveyor(acceleration=0.0), Start(z=0.05))
    speeds, coefficients = np.array([0.15, 0.4, 0.8]), np.array([0.2, 0.5, 0.6])
    impacts = impacts_of(parameters, 1.0, (speeds, coefficients))
    found = impacts["speed"][1:6] / impacts["speed"][:5]
    assert impacts["speed"][0] > 0.8 > impacts["speed"][1] > 0.4 > impacts["speed"][2] > 0.15 > impacts["speed"][3]
    np.testing.assert_allclose(found, np.interp(impacts["speed"][:5], speeds, coefficients), rtol=1e-6)


@pytest.mark.parametrize("e", [0.3, 0.6, 0.8])
def test_period_one_orbit(e):
    """One impact per cycle: u = gT/2 + w with the plate at w = (gT/2)(1 - e)/(1 + e), so a_z ≥ πg(1 - e)/(1 + e)."""
    plate_speed = 0.5 * G * PERIOD * (1.0 - e) / (1.0 + e)
    least = math.pi * G * (1.0 - e) / (1.0 + e)
    assert least == pytest.approx(plate_speed * OMEGA)
    a_z = 1.05 * least
    # Of the two phases with this plate speed, the stable one has a decelerating plate, because a late impact is weaker.
    theta = math.pi - math.asin(plate_speed * OMEGA / a_z)
    for offset in (0.0, 1e-2):
        parameters = pack(vertical(a_z, psi0=theta + offset), Start(z="conveyor", vz=0.5 * G * PERIOD))
        impacts = impacts_of(parameters, 4.0, e)
        assert impacts["speed"][-1] == pytest.approx(0.5 * G * PERIOD + plate_speed, rel=1e-8)
        np.testing.assert_allclose(np.diff(impacts["time"])[-20:], PERIOD, rtol=1e-8)
        phase = (OMEGA * impacts["time"][-1] + theta + offset) % (2.0 * math.pi)
        assert phase == pytest.approx(theta, abs=1e-7)


def test_no_period_one_orbit_below_its_condition():
    e = 0.5
    least = math.pi * G * (1.0 - e) / (1.0 + e)
    assert least > 1.02 * G
    impacts = impacts_of(pack(vertical(1.01 * G), Start(z=1e-3)), 2.0, e)
    gaps = np.diff(impacts["time"][impacts["time"] > 1.0])
    assert len(gaps) > 10
    assert (np.abs(gaps - PERIOD) > 1e-4 * PERIOD).all()


@pytest.mark.parametrize("e", [0.0, 0.4, 0.7])
def test_collapse_on_a_gentle_plate(e):
    """Below a_z = g the bounces die out and the part moves with the plate from then on."""
    conveyor = Conveyor(acceleration=30.0)
    parameters = pack(conveyor, Start(z=3e-4))
    assert impacts_of(parameters, 2.0, e)["time"][-1] < 0.5
    times = np.linspace(0.5, 2.0, 301)
    samples, plate = rigid_part_motion.sample(parameters, times, e), conveyor_motion(conveyor, times)
    np.testing.assert_allclose(samples["z"], plate["z"], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(samples["vz"], plate["vz"], rtol=0.0, atol=1e-12)


def test_plastic_part_leaves_the_plate_when_it_falls_faster_than_g():
    """e = 0, a_z > g: take-off at a_z cos θ = -g, one flight per cycle, its end a root of the gap."""
    a_z = 1.3 * G
    leave = math.acos(-1.0 / 1.3)

    def gap(tau):
        z_s = -a_z / OMEGA**2 * np.cos(leave + OMEGA * tau)
        z_p = -a_z / OMEGA**2 * math.cos(leave) + a_z / OMEGA * math.sin(leave) * tau - 0.5 * G * tau**2
        return z_p - z_s

    tau = brentq(gap, 1e-3, PERIOD, xtol=1e-15)
    parameters = pack(vertical(a_z), Start(z="conveyor"))
    impacts = impacts_of(parameters, 50.5 * PERIOD, 0.0)
    expected = leave / OMEGA + tau + PERIOD * np.arange(50)
    np.testing.assert_allclose(impacts["time"], expected, rtol=0.0, atol=1e-9)
    run = rigid_part_motion.run(parameters, 50.0 * PERIOD, 0.0)
    flight = np.linspace(0.0, tau, 2001)
    assert run.max_gap == pytest.approx(gap(flight).max(), rel=1e-5)
    times = leave / OMEGA + np.array([1e-6, 0.5 * tau])
    samples = rigid_part_motion.sample(parameters, times, 0.0)
    plate = conveyor_motion(vertical(a_z), times)
    np.testing.assert_allclose(samples["z"] - plate["z"], gap(times - leave / OMEGA), rtol=1e-6, atol=1e-18)


@pytest.mark.parametrize("room", [0, 100])
def test_samples_do_not_change_the_impacts(room, monkeypatch):
    parameters = pack(Conveyor(acceleration=50.0), Start(z=1e-3))
    times = np.array([0.7, 0.2, 0.7])
    samples, impacts = rigid_part_motion.sample(parameters, times, 0.5), impacts_of(parameters, 0.7, 0.5)
    assert len(impacts) > 70
    monkeypatch.setattr(rigid_part_motion, "IMPACTS_OF_CYCLE", room)
    found, hits = rigid_part_motion.samples_and_impacts(parameters, times, 0.5)
    np.testing.assert_array_equal(hits, impacts)
    for name, values in samples.items():
        np.testing.assert_array_equal(found[name], values)


def test_friction_impulse_is_bounded():
    """An impact changes ẋ by at most μ (1 + e) u towards the plate, and by no more than the slip."""
    e, height = 0.5, 1e-3
    plate = {"acceleration": 100.0, "angle": 0.0, "psi0": -OMEGA * math.sqrt(2.0 * height / G) + 1.0}
    # A horizontal plate in its rest height of -a_z/ω² cos θ = 0, with θ = 1 rad at the impact.
    speed = math.sqrt(2.0 * G * height)
    plate_velocity = 100.0 / OMEGA * math.sin(1.0)
    time = math.sqrt(2.0 * height / G) + 1e-4
    for friction in (0.0, 0.1, 0.3, 3.0):
        parameters = pack(Conveyor(friction=friction, **plate), Start(z=height))
        vx = rigid_part_motion.sample(parameters, np.array([time]), e)["vx"][0]
        assert vx == pytest.approx(min(friction * (1.0 + e) * speed, plate_velocity), rel=1e-12)
    assert 0.3 * (1.0 + e) * speed < plate_velocity < 3.0 * (1.0 + e) * speed


# Mostly slip; stick in between; slip in both directions after stick; backward only; never; no friction; no motion.
@pytest.mark.parametrize(
    ("acceleration", "friction"),
    [(30.0, 0.15), (30.0, 0.6), (8.0, 0.6), (6.5, 0.6), (5.0, 0.6), (45.0, 0.02), (45.0, 0.0), (0.0, 0.0)],
)
def test_slip_and_stick_at_rest(acceleration, friction):
    """The closed form against small steps of ẍ = ±μ (g + a_z cos θ), which the plate's velocity bounds."""
    conveyor = Conveyor(acceleration=acceleration, friction=friction, psi0=0.7)
    times = np.linspace(0.0, 0.06, 31)
    a_x, a_z = (acceleration * shape(conveyor.angle) for shape in (math.cos, math.sin))
    start = Start(z="conveyor", vz=a_z / OMEGA * math.sin(0.7))
    samples = rigid_part_motion.sample(pack(conveyor, start), times, 0.0)
    h, x, vx, slow = 5e-7, 0.0, 0.0, []
    steps = round(times[-1] / h)
    theta = 0.7 + OMEGA * h * (np.arange(steps) + 0.5)
    plate_vx, hold = a_x / OMEGA * np.sin(theta), h * friction * (G + a_z * np.cos(theta))
    for i in range(steps + 1):
        if i % (steps // 30) == 0:
            slow.append((x, vx))
        if i < steps:
            before = vx
            vx += min(max(plate_vx[i] - vx, -hold[i]), hold[i])
            x += 0.5 * h * (before + vx)
    slow = np.array(slow)
    scale = max(np.abs(slow[:, 1]).max(), 1e-9)
    np.testing.assert_allclose(samples["vx"], slow[:, 1], rtol=0.0, atol=2e-4 * scale)
    np.testing.assert_allclose(samples["x"], slow[:, 0], rtol=0.0, atol=2e-4 * scale * times[-1])


@pytest.mark.parametrize("damping_ratio", [0.0, 0.05, 0.3, 0.6])
def test_restitution_of_a_linear_contact(damping_ratio):
    """p = 1: closed forms with and without tension; the speed does not matter."""
    zeta, root = damping_ratio, math.sqrt(1.0 - damping_ratio**2)
    pulled = math.exp(-math.pi * zeta / root)
    clipped = math.exp(-zeta / root * (math.pi - math.atan2(2.0 * zeta * root, 1.0 - 2.0 * zeta**2)))
    for tension, expected in (("allow", pulled), ("frictionless", pulled), ("clip", clipped)):
        mass, stiffness = 0.7e-3, 2e4
        damping = 2.0 * zeta * math.sqrt(stiffness * mass)
        conveyor = Conveyor(exponent=1.0, stiffness=stiffness, damping=damping, tension=tension)
        found = restitution_coefficients(pack(conveyor, Start()), np.array([0.01, 1.0]))
        np.testing.assert_allclose(found, expected, rtol=3e-6)


def test_restitution_of_a_hertz_contact():
    """It depends on d_c⁵u⁻¹ alone (k, m fixed), and falls from 1 to 0 as damping grows."""
    speeds = np.array([0.05, 0.35])

    def coefficients(damping, speeds=speeds):
        return restitution_coefficients(pack(Conveyor(damping=damping), Start()), speeds)

    np.testing.assert_allclose(coefficients(0.0), 1.0, rtol=1e-6)
    np.testing.assert_allclose(coefficients(0.3), coefficients(0.6, 32.0 * speeds), rtol=1e-6)
    falling = np.array([coefficients(damping) for damping in (0.0, 0.1, 0.3, 1.0, 3.0)])
    assert (np.diff(falling, axis=0) < 0.0).all()
    assert (coefficients(30.0) == 0.0).all()
    assert (coefficients(1e4) == 0.0).all()


def test_restitution_agrees_with_the_event_driven_solver():
    """An impact at 20 m/s is so short that gravity has no effect."""
    conveyor = Conveyor(acceleration=0.0, gravity=1e-3)
    run = simulate(conveyor, Start(z="conveyor", vz=-20.0), duration=1e-3, tolerance=1e-12)
    found = restitution_coefficients(pack(conveyor, Start()), np.array([20.0]))
    assert run.z_end > 0.0
    assert found[0] == pytest.approx(run.vz_end / 20.0, rel=1e-6)


def test_a_stiff_contact_tends_to_the_rigid_part():
    """At equal restitution, the mean velocity of the compliant model approaches that of the rigid part as k^-1/2."""
    mass, damping_ratio, start, duration = 0.7e-3, 0.1, Start(z=3e-4), 0.3
    differences = []
    for stiffness in (1e7, 1e9):
        damping = 2.0 * damping_ratio * math.sqrt(stiffness * mass)
        conveyor = Conveyor(exponent=1.0, stiffness=stiffness, damping=damping, tension="clip")
        parameters = pack(conveyor, start)
        (e,) = restitution_coefficients(parameters, np.array([0.1]))
        rigid = rigid_part_motion.run(parameters, duration, e)
        compliant = simulate(conveyor, start, duration=duration)
        assert rigid.impacts == compliant.impacts
        differences.append(compliant.mean_velocity() / rigid.mean_velocity - 1.0)
    assert abs(differences[1]) < 1e-3
    assert differences[0] / differences[1] == pytest.approx(10.0, rel=0.1)


def test_a_part_that_starts_below_the_plate_starts_on_it():
    conveyor = Conveyor(psi0=math.pi)
    below = rigid_part_motion.run(pack(conveyor, Start(z=-1e-3, vz=0.3)), 0.1, 0.5)
    assert below == rigid_part_motion.run(pack(conveyor, Start(z="conveyor", vz=0.3)), 0.1, 0.5)


def test_too_many_events():
    """Nearly elastic bounces shrink too slowly for one cycle of a very slow plate."""
    parameters = pack(vertical(1.0, frequency=0.01), Start(z="conveyor", vz=0.01))
    run = rigid_part_motion.run(parameters, 900.0, 0.99999)
    assert run.status == "too many events"
    assert math.isnan(run.z)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda p: rigid_part_motion.run(p, 0.0, 0.5), "duration"),
        (lambda p: rigid_part_motion.run(p, 1.0, 1.5), "restitution"),
        (lambda p: rigid_part_motion.run(p, 1.0, math.nan), "restitution"),
        (lambda p: rigid_part_motion.run(p, 1.0, ([0.2, 0.1], [0.5, 0.6])), "ascending"),
        (lambda p: rigid_part_motion.run(p, 1.0, ([0.2, 0.1, 0.3], [0.5, 0.6])), "equal length"),
        (lambda p: rigid_part_motion.sample(p, np.array([-1.0]), 0.5), "times"),
        (lambda p: restitution_coefficients(p, np.array([0.0])), "speeds"),
    ],
)
def test_errors_name_the_argument(call, word):
    with pytest.raises(ValueError, match=word):
        call(pack(Conveyor(), Start()))


# The last plate moves almost vertically, so that the part slips down the track where the plate hardly presses on it.
STEEP = {"inclination": 0.2, "angle": 1.4, "acceleration": 9.0}


@pytest.mark.parametrize("track", [{}, {"inclination": 0.15}, {"inclination": -0.1, "phase_shift": 0.7}, STEEP])
def test_stick_ends_where_friction_no_longer_holds_the_part(track):
    """The first phase at which |ẍ_s + g sin α| exceeds μ_s (g cos α + a_z cos θ), against a scan of one cycle."""
    conveyor = Conveyor(**{"acceleration": 6.0, "angle": 0.3, "friction": 0.1, "static_friction": 0.45} | track)
    c = contact.constants(pack(conveyor, Start()), 0.0)
    a_x, a_z = (conveyor.acceleration * shape(conveyor.angle) for shape in (math.cos, math.sin))
    ahead = np.linspace(0.0, 2.0 * math.pi, 100_001)
    found = []
    for theta in np.linspace(0.0, 6.2, 23):
        phase = theta + ahead
        pull = a_x * np.cos(phase + conveyor.phase_shift) + G * math.sin(conveyor.inclination)
        grip = 0.45 * (G * math.cos(conveyor.inclination) + a_z * np.cos(phase))
        slips = np.abs(pull) > grip
        assert slips.any()
        if not slips[0]:  # a part that slips does not stick
            found.append(rigid_part_rest.stick_end(c, theta))
            assert found[-1] == pytest.approx(ahead[slips.argmax()], abs=1e-4)
    assert len(found) > 5
