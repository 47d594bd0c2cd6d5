"""Restitution of an impact: closed forms, drops by the solver, and the damping that belongs to it."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from conveyor import Conveyor, Start, damping_of, parameter_table, restitution, simulate
from conveyor.parameters import TENSION_MODES

RANDOM = np.random.default_rng(7)


def bounce(conveyor: Conveyor, height: float) -> tuple[float, float]:
    """Speed of the impact of a part that the solver drops on a plate at rest, and its coefficient of restitution."""
    gravity = conveyor.gravity * math.cos(conveyor.inclination)
    speed = math.sqrt(2.0 * gravity * height)
    run = simulate(conveyor, Start(z=height), duration=speed / gravity * 1.5 + 0.1, tolerance=1e-13)
    assert run.status == "ok"
    (time,) = run.events["time"][run.events["kind"] == "separation"][:1]
    return speed, run.sample(np.array([time]))["vz"].item() / speed


def random_conveyor(tension: str) -> Conveyor:
    """A plate at rest, and a contact that bounces at most speeds."""
    exponent = RANDOM.choice([1.0, 1.5, 1.5, RANDOM.uniform(1.1, 2.5)])
    mass = 10.0 ** RANDOM.uniform(-4, -1)
    frequency = 2.0 * math.pi * 10.0 ** RANDOM.uniform(2, 3)
    # A Hooke contact of this frequency and of the damping ratio ζ, and others that have its force at 0.1 mm.
    stiffness = mass * frequency**2 * 1e-4 ** (1.0 - exponent)
    damping = 2.0 * RANDOM.uniform(0.0, 0.4) * mass * frequency
    return Conveyor(
        acceleration=0.0,
        mass=mass,
        stiffness=stiffness,
        damping=damping,
        exponent=exponent,
        inclination=RANDOM.choice([0.0, 0.1]),
        tension=tension,
    )


@pytest.mark.parametrize("tension", TENSION_MODES)
def test_a_part_that_the_solver_drops_bounces_as_computed(tension):
    checked = 0
    for _ in range(25):
        conveyor, height = random_conveyor(tension), 10.0 ** RANDOM.uniform(-3.5, -1)
        speed = math.sqrt(2.0 * conveyor.gravity * math.cos(conveyor.inclination) * height)
        if (expected := restitution(conveyor, speed)) > 0.02:
            assert bounce(conveyor, height) == pytest.approx((speed, expected), abs=1e-9)
            checked += 1
    assert checked > 15


@pytest.mark.parametrize("ratio", [0.0, 0.02, 0.1, 0.3, 0.6, 0.9])
def test_hooke_contact_with_gravity_has_the_closed_form_of_an_oscillator(ratio):
    """δ̈ = g - ω²δ - 2ζωδ̇ from δ = 0, δ̇ = v: a decaying oscillation around g/ω² whose first zero is the separation."""
    mass, omega, gravity, speed = 2e-3, 900.0, 9.81, 0.2
    conveyor = Conveyor(exponent=1.0, mass=mass, stiffness=mass * omega**2, damping=2.0 * ratio * mass * omega)
    damped, rest = omega * math.sqrt(1.0 - ratio**2), gravity / omega**2
    sine = (speed - ratio * omega * rest) / damped

    def depth(time):
        decay = math.exp(-ratio * omega * time)
        return rest + decay * (-rest * math.cos(damped * time) + sine * math.sin(damped * time))

    def rate(time):
        decay, turn = math.exp(-ratio * omega * time), damped * time
        motion = -rest * math.cos(turn) + sine * math.sin(turn)
        return decay * (damped * (rest * math.sin(turn) + sine * math.cos(turn)) - ratio * omega * motion)

    times = np.linspace(1e-6, 2.0 * math.pi / damped, 20001)
    depths = [depth(time) for time in times]
    after = next((place for place, value in enumerate(depths) if value < 0.0), None)
    expected = 0.0 if after is None else -rate(brentq(depth, times[after - 1], times[after], xtol=1e-16)) / speed
    assert restitution(conveyor, speed) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.7])
def test_clipped_hooke_contact_almost_without_gravity(ratio):
    """The force ends where kδ + dδ̇ = 0: Schwager and Pöschel 2007, Eq. 21, with β/ω = ratio."""
    mass, omega, damped = 1e-3, 1e5, math.sqrt(1.0 - ratio**2)
    contact = {"exponent": 1.0, "mass": mass, "stiffness": mass * omega**2, "damping": 2.0 * ratio * mass * omega}
    angle = math.atan2(2.0 * ratio * damped, 2.0 * ratio**2 - 1.0)
    conveyor = Conveyor(**contact, gravity=1e-3, tension="clip")
    assert restitution(conveyor, 100.0) == pytest.approx(math.exp(-ratio / damped * angle), abs=1e-9)


def clipped_hooke_contact(damping: float, stiffness: float, mass: float, gravity: float, speed: float) -> float:
    """Restitution where the force k δ + d δ̇ ends at its first zero, from the closed form in extended precision."""
    damping, stiffness, mass, gravity, speed = map(np.longdouble, (damping, stiffness, mass, gravity, speed))
    decay, rest = damping / (2 * mass), gravity * mass / stiffness
    turn = np.sqrt(stiffness / mass - decay**2)
    sine = (speed - decay * rest) / turn

    def state(time):
        shape, slope = sine * np.sin(turn * time), sine * np.cos(turn * time)
        shape, slope = shape - rest * np.cos(turn * time), slope + rest * np.sin(turn * time)
        return rest + np.exp(-decay * time) * shape, np.exp(-decay * time) * (turn * slope - decay * shape)

    low, high = 1.5 / turn, 4.7 / turn  # between the deepest points of the first and of the second swing
    while low < (middle := (low + high) / 2) < high:
        depth, rate = state(middle)
        low, high = (middle, high) if stiffness * depth + damping * rate > 0 else (low, middle)
    depth, rate = state(low)
    return float(np.sqrt(rate**2 - 2 * gravity * depth) / speed)


@pytest.mark.parametrize("speed", [0.01280565426622192, 0.3])
def test_a_weak_damper_does_not_pull_just_before_the_gap_opens(speed):
    """The zero of the force and the opening of the gap often fall into the same step."""
    for damping in np.append(0.0030088136791861743, np.geomspace(2e-4, 0.3, 20)):
        conveyor = Conveyor(damping=damping, exponent=1.0, tension="clip")
        numbers = (conveyor.stiffness, conveyor.mass, conveyor.gravity)
        expected = clipped_hooke_contact(damping, *numbers, speed)
        assert restitution(conveyor, speed) == pytest.approx(expected, abs=1e-11)
        assert damping_of(expected, speed, conveyor) == pytest.approx(damping, rel=1e-11 / (1.0 - expected))


@pytest.mark.parametrize("damping", [0.0, 5e-324, 1e-30, 1e-17, 1e-12])
def test_a_clipped_contact_almost_without_damping_keeps_the_speed(damping):
    assert restitution(Conveyor(damping=damping, tension="clip"), 0.1) == pytest.approx(1.0, abs=1e-11)


def test_slow_impacts_of_a_hertz_contact_bounce_less():
    values = [restitution(Conveyor(), speed) for speed in (0.03, 0.1, 0.3, 1.0, 3.0)]
    assert values == sorted(values)


@pytest.mark.parametrize("tension", TENSION_MODES)
@pytest.mark.parametrize("damping", [10.0, 1e3, 1e5])
def test_a_part_on_a_strong_damper_stays(damping, tension):
    assert restitution(Conveyor(damping=damping, tension=tension), 0.3) == pytest.approx(0.0, abs=1e-6)


def test_a_light_part_on_a_strong_damper_stays():
    """It creeps more slowly than the error of a step, so that its speed may never become negative."""
    conveyor = Conveyor(mass=1e-12, stiffness=1.7e3, damping=0.15, exponent=1.66, gravity=1e-3, tension="clip")
    assert restitution(conveyor, 5.4) == 0.0


@pytest.mark.parametrize("tension", TENSION_MODES)
@pytest.mark.parametrize("wanted", [0.01, 0.3, 0.5, 0.99, 1.0])
def test_damping_is_the_inverse_of_restitution(wanted, tension):
    for exponent, speed in ((1.0, 0.63), (1.5, 0.63), (1.5, 0.05), (2.3, 0.2)):
        conveyor = Conveyor(exponent=exponent, tension=tension)
        damping = damping_of(wanted, speed, conveyor)
        found = SimpleNamespace(**{name: getattr(conveyor, name) for name in conveyor.__slots__} | {"damping": damping})
        assert restitution(found, speed) == pytest.approx(wanted, abs=1e-10)


@pytest.mark.parametrize(
    ("wanted", "speed", "message"),
    [
        (0.0, 0.1, r"restitution = 0.0 must be a number in \(0, 1\]"),
        (1.2, 0.1, r"restitution = 1.2 must be a number in \(0, 1\]"),
        (math.nan, 0.1, "restitution = nan must be"),
        (0.5, 0.0, r"speed = 0.0 must be a number in \[1e-06, 100\] m/s"),
        (0.5, 1e-200, "speed = 1e-200 must be a number"),
        (0.5, True, "speed = True must be"),
        (0.5, "0.1", "speed = '0.1' must be"),
    ],
)
def test_impossible_arguments_are_refused(wanted, speed, message):
    with pytest.raises(ValueError, match=message):
        damping_of(wanted, speed, Conveyor())


def test_a_restitution_that_no_damping_gives_is_refused():
    with pytest.raises(ValueError, match=r"restitution = 1e-05 needs more than the largest damping, 1e\+06 N s/m"):
        damping_of(1e-5, 0.1, Conveyor(mass=1e6, stiffness=1e15))


@pytest.mark.parametrize(
    ("name", "value"),
    [(name, math.nan) for name in ("stiffness", "damping", "mass", "exponent", "gravity", "inclination")]
    + [("damping", math.inf), ("damping", -0.1), ("stiffness", 0.0), ("exponent", 0.0), ("mass", "1 g")]
    + [("tension", "pull"), ("tension", np.array(["clip", "allow"]))],
)
def test_impossible_parameters_of_any_object_are_named(name, value):
    conveyor = SimpleNamespace(**{name: getattr(Conveyor(), name) for name in Conveyor.__slots__} | {name: value})
    for call in (lambda: restitution(conveyor, 0.3), lambda: damping_of(0.5, 0.3, conveyor)):
        with pytest.raises(ValueError, match=rf"conveyor\.{name} = "):
            call()


def test_a_frame_is_no_conveyor():
    frame = pytest.importorskip("pandas").DataFrame(parameter_table(Conveyor(), mass=[1e-3, 2e-3]))
    with pytest.raises(ValueError, match=r"conveyor\.(stiffness|tension) = "):
        restitution(frame, 0.3)


def test_a_row_of_a_table_is_a_conveyor():
    conveyor = Conveyor(mass=2e-3, tension="clip", harmonics=[{"order": 2, "normal": 0.1}])
    table = parameter_table(conveyor, acceleration=[10.0, 20.0])
    for row in (table[0], table[:1], parameter_table(conveyor)):
        assert restitution(row, 0.3) == restitution(conveyor, 0.3)
        assert damping_of(0.5, 0.3, row) == damping_of(0.5, 0.3, conveyor)
    with pytest.raises(ValueError, match=r"conveyor must be one row of a table, got the shape \(2,\)"):
        restitution(table, 0.3)
    table["mass"] = math.nan
    with pytest.raises(ValueError, match="conveyor: parameters: mass = nan is outside"):
        restitution(table[0], 0.3)


def test_a_conveyor_is_needed():
    with pytest.raises(TypeError, match=r"conveyor must be a Conveyor, got 40\.0 without stiffness"):
        restitution(40.0, 0.1)
