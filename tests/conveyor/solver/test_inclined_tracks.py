"""Inclined tracks, elliptical drives and static friction: closed forms, symmetries, and an independent solution."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from reference import reference_states
from scipy.integrate import simpson

from conveyor import Conveyor, Start, conveyor_and_start, parameter_table, plate_motion, simulate, sweep
from conveyor.parameters import TENSION_MODES

AT_REST = Conveyor(acceleration=0.0)
FEEDER = Conveyor(acceleration=40.0, inclination=0.08, phase_shift=0.7, static_friction=0.2, psi0=0.3)


def resting(conveyor):
    """An initial condition at the penetration at which a plate at rest carries the part."""
    weight = conveyor.mass * conveyor.gravity * math.cos(conveyor.inclination)
    return Start(-((weight / conveyor.stiffness) ** (1.0 / conveyor.exponent)))


def random_conveyor(rng):
    friction = rng.uniform(0.02, 0.6)
    conveyor = Conveyor(
        acceleration=rng.uniform(5.0, 60.0),
        angle=rng.uniform(0.1, 1.2),
        frequency=rng.uniform(25.0, 70.0),
        psi0=rng.uniform(0.0, 6.0),
        damping=10.0 ** rng.uniform(-1.5, 0.0),
        friction=friction,
        exponent=rng.choice([1.3, 1.5, 1.5, 2.0]),
        inclination=rng.uniform(-0.6, 0.6),
        phase_shift=rng.uniform(-6.0, 6.0),
        static_friction=friction * rng.choice([1.0, 1.05, 1.3, 2.0]),
        tension=str(rng.choice(["allow", "allow", "frictionless", "clip"])),
    )
    height = "conveyor" if rng.random() < 0.2 else rng.uniform(0.0, 5e-4)
    return conveyor, Start(height, rng.uniform(-0.1, 0.2))


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_part_on_a_still_incline_sticks_or_slides(sign):
    """It sticks up to tan α = μ_s, and slides beyond with g (sin α - μ cos α)."""
    for angle in (0.1, math.atan(0.3) - 1e-4, math.atan(0.3) + 1e-4, 1.0):
        conveyor = replace(AT_REST, inclination=sign * angle, friction=0.2, static_friction=0.3)
        run = simulate(conveyor, resting(conveyor), duration=0.1, tolerance=1e-12)
        slide = 9.81 * (math.sin(angle) - 0.2 * math.cos(angle)) if math.tan(angle) > 0.3 else 0.0
        assert run.vx_end == pytest.approx(-sign * slide * 0.1, rel=1e-9, abs=1e-14)
        assert run.x_end == pytest.approx(-sign * slide * 0.1**2 / 2.0, rel=1e-9, abs=1e-14)


def test_flight_over_an_incline_is_a_parabola_in_both_directions():
    conveyor = replace(AT_REST, inclination=0.3)
    times = np.linspace(0.0, 0.02, 21)
    sample = simulate(conveyor, Start(0.01), duration=0.02).sample(times)
    np.testing.assert_allclose(sample["z"], 0.01 - 0.5 * 9.81 * math.cos(0.3) * times**2, rtol=1e-14)
    np.testing.assert_allclose(sample["x"], -0.5 * 9.81 * math.sin(0.3) * times**2, rtol=1e-14)


@pytest.mark.parametrize(("share", "slips"), [(0.99, False), (1.01, True)])
def test_slip_on_a_stiff_level_conveyor_begins_at_its_closed_form(share, slips):
    """a_x = μ_s (g - a_z), as long as the part never leaves the plate."""
    angle, static = 0.3, 0.5
    amplitude = static * 9.81 / (math.cos(angle) + static * math.sin(angle))
    assert amplitude * math.sin(angle) < 9.81
    contact = {"stiffness": 1e10, "damping": 30.0, "friction": 0.4, "static_friction": static}
    conveyor = Conveyor(acceleration=share * amplitude, angle=angle, **contact)
    pressed = conveyor.mass * (9.81 + conveyor.acceleration * math.sin(angle)) / conveyor.stiffness
    start = Start(-conveyor.acceleration * math.sin(angle) / (100.0 * math.pi) ** 2 - pressed ** (1.0 / 1.5))
    run = simulate(conveyor, start, duration=0.08)  # its last quarter is a cycle
    assert run.impacts == 0
    assert ("slip" in run.events["kind"]) == slips
    assert (abs(run.mean_velocity()) > 1e-6) == slips


def test_mirror_images():
    """x turns into -x where α does into -α and ε into ε + π."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        conveyor, start = random_conveyor(rng)
        mirrored = replace(conveyor, inclination=-conveyor.inclination, phase_shift=conveyor.phase_shift + math.pi)
        times = np.linspace(0.0, 0.1, 101)
        here, there = (
            simulate(one, start, duration=0.1, tolerance=1e-12).sample(times) for one in (conveyor, mirrored)
        )
        np.testing.assert_array_equal(here["z"], there["z"])
        np.testing.assert_allclose(here["x"], -there["x"], rtol=0, atol=1e-11)
        np.testing.assert_allclose(here["vx"], -there["vx"], rtol=0, atol=1e-9)


def test_a_turn_of_the_phase_shift_changes_nothing_but_roundings():
    for turns in (-1.0, 1.0):
        turned = replace(FEEDER, phase_shift=FEEDER.phase_shift + turns * 2.0 * math.pi)
        here, there = (simulate(one, Start(3e-4), duration=0.2) for one in (FEEDER, turned))
        assert there.x_end == pytest.approx(here.x_end, rel=1e-10)
        assert there.z_end == here.z_end


def test_the_plate_moves_on_an_ellipse():
    """A quarter turn ahead with a_x = a_z is a circle."""
    conveyor = Conveyor(angle=0.25 * math.pi, phase_shift=0.5 * math.pi)
    plate = plate_motion(conveyor, np.linspace(0.0, 0.02, 50))
    radius = conveyor.acceleration * math.sin(conveyor.angle) / (100.0 * math.pi) ** 2
    np.testing.assert_allclose(np.hypot(plate["x"], plate["z"]), radius, rtol=1e-12)
    np.testing.assert_allclose(plate["x"] * plate["vx"] + plate["z"] * plate["vz"], 0.0, atol=1e-15)


def test_an_independent_integrator_agrees():
    rng, kinds = np.random.default_rng(7), set()
    times = np.linspace(0.0, 0.06, 25)
    for _ in range(30):
        conveyor, start = random_conveyor(rng)
        run = simulate(conveyor, start, duration=0.06, tolerance=1e-13)
        kinds |= set(run.events["kind"])
        found, wanted = run.sample(times), reference_states(conveyor, start, times)
        for name, scale in (("x", 1e-3), ("vx", 1.0), ("z", 1e-3), ("vz", 1.0)):
            np.testing.assert_allclose(found[name], wanted[name], rtol=1e-7, atol=1e-7 * scale, err_msg=f"{conveyor}")
    assert {"stick", "slip", "slip reversal"} <= kinds


def test_friction_falls_from_static_to_sliding_where_a_slip_begins():
    conveyor = Conveyor(acceleration=8.0, friction=0.5, static_friction=0.6, phase_shift=0.4, inclination=0.05)
    run = simulate(conveyor, Start("conveyor"), duration=0.2, tolerance=1e-12)
    slips = run.events["time"][run.events["kind"] == "slip"]
    assert len(slips) > 5
    for shift, coefficient in ((-1e-9, 0.6), (1e-9, 0.5)):
        sample = run.sample(slips + shift)
        np.testing.assert_allclose(np.abs(sample["friction_force"]) / sample["contact_force"], coefficient, rtol=1e-5)
    # The part slips in the direction in which friction held it back.
    later = slips + 1e-6
    slip = plate_motion(conveyor, later)["vx"] - run.sample(later)["vx"]
    pull = 8.0 * math.cos(conveyor.angle) * np.cos(100.0 * math.pi * slips + 0.4) + 9.81 * math.sin(0.05)
    np.testing.assert_array_equal(np.sign(slip), np.sign(pull))


def test_a_part_sticks_where_sliding_friction_alone_could_not_hold_it():
    """If the slip vanishes with μ F_c < m |ẍ_s| ≤ μ_s F_c, the part sticks; with μ_s = μ it reverses at once."""
    level = Conveyor(acceleration=8.0, friction=0.3)
    higher = replace(level, static_friction=0.9)
    counts = []
    for conveyor in (level, higher):
        kinds = simulate(conveyor, resting(conveyor), duration=0.2).events["kind"]
        counts.append(((kinds == "stick").sum(), (kinds == "slip reversal").sum()))
    assert counts[0][1] > 5
    assert counts[1][0] >= 1
    assert counts[1][1] == 0


def energy_lack(run):
    """Energy (J) that a run gains beyond the work of the plate, the damper and friction, and the largest energy."""
    conveyor = run.conveyor
    edges = np.unique(np.concatenate([[0.0], run.events["time"], [run.duration]]))
    # Half-power ends of an impact are smooth in the angle of a cosine.
    angle = np.linspace(0.0, math.pi, 401)
    spans = [pair for pair in itertools.pairwise(edges) if pair[1] - pair[0] > 1e-12]
    times = np.concatenate([low + 0.5 * (high - low) * (1.0 - np.cos(angle)) for low, high in spans])
    times = np.clip(times.reshape(len(spans), -1), *(np.array(spans).T[:, :, None] + np.array([[[1e-14]], [[-1e-14]]])))
    sample = run.sample(times)
    power = sample["contact_force"] * sample["vz"] + sample["friction_force"] * sample["vx"]
    work = sum(
        simpson(row * 0.5 * (high - low) * np.sin(angle), x=angle)
        for row, (low, high) in zip(power, spans, strict=True)
    )
    height = sample["z"] * math.cos(conveyor.inclination) + sample["x"] * math.sin(conveyor.inclination)
    energy = 0.5 * (sample["vx"] ** 2 + sample["vz"] ** 2) + conveyor.gravity * height
    return energy.flat[-1] - energy.flat[0] - work / conveyor.mass, np.abs(energy).max()


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    acceleration=st.floats(0.0, 100.0),
    angle=st.floats(0.0, 0.5 * math.pi),
    inclination=st.floats(-1.4, 1.4),
    phase_shift=st.floats(-4.0 * math.pi, 4.0 * math.pi),
    friction=st.floats(0.0, 2.0),
    ratio=st.floats(1.0, 3.0),
    height=st.floats(0.0, 1e-3),
    tension=st.sampled_from(TENSION_MODES),
)
def test_the_energy_of_the_part_is_the_work_of_the_forces_on_it(friction, ratio, height, **model):
    conveyor = Conveyor(friction=friction, static_friction=friction * ratio, **model)
    run = simulate(conveyor, Start(height), duration=0.04, tolerance=1e-12)
    assert run.status == "ok"
    lack, size = energy_lack(run)
    assert abs(lack) <= 1e-6 * (size + 0.01)


def test_friction_without_static_friction_moves_both():
    apart = [simulate(Conveyor(acceleration=20.0, friction=mu), duration=0.1).mean_velocity() for mu in (0.1, 0.4)]
    parameters = parameter_table(Conveyor(), friction=[0.1, 0.4], acceleration=20.0)
    assert sweep(parameters, duration=0.1).mean_velocity.tolist() == apart
    assert [conveyor_and_start(row)[0].static_friction for row in parameters] == [0.1, 0.4]
    for wrong in ({"friction": 0.3}, {"static_friction": 0.1}):
        with pytest.raises(ValueError, match=r"static_friction = .* is below friction = "):
            parameter_table(Conveyor(friction=0.15, static_friction=0.2), **wrong)
    with pytest.raises(ValueError, match=r"static_friction = 0.1 is below friction = 0.15"):
        Conveyor(static_friction=0.1)


@pytest.mark.parametrize("method", ["euler", "semi_implicit_euler", "rk4"])
def test_fixed_steps_converge_to_the_events(method):
    exact = simulate(FEEDER, Start(3e-4), duration=0.05, tolerance=1e-12)
    errors = []
    for step in (2e-6, 5e-7):
        run = simulate(FEEDER, Start(3e-4), duration=0.05, method=method, step=step)
        errors.append(abs(run.x_end - exact.x_end))
        assert run.peak_force == pytest.approx(exact.peak_force, rel=2e-2)
        assert run.impact_speed == pytest.approx(exact.impact_speed, rel=2e-2)
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 2e-6


@pytest.mark.parametrize("method", ["euler", "semi_implicit_euler", "rk4"])
def test_fixed_steps_stick_on_a_still_incline(method):
    conveyor = replace(AT_REST, inclination=0.25, friction=0.2, static_friction=0.3)
    run = simulate(conveyor, resting(conveyor), duration=0.05, method=method, step=1e-5)
    # The inner evaluations of Runge-Kutta have friction without stick, and creep by a part of a step.
    assert abs(run.x_end) < (1e-6 if method == "rk4" else 1e-12)
    slides = replace(conveyor, inclination=0.35)
    run = simulate(slides, resting(slides), duration=0.05, method=method, step=1e-5)
    assert run.vx_end == pytest.approx(-9.81 * (math.sin(0.35) - 0.2 * math.cos(0.35)) * 0.05, rel=1e-3)


@pytest.mark.parametrize("exponent", [1.0, 1.3, 1.5, 2.0])
def test_peaks_agree_with_a_dense_sample(exponent):
    stiffness = {1.0: 2e3, 1.3: 2e5, 1.5: 5e5, 2.0: 5e7}[exponent]
    conveyor = replace(FEEDER, exponent=exponent, stiffness=stiffness, acceleration=70.0)
    run = simulate(conveyor, Start(3e-4), duration=0.2, tolerance=1e-8)
    sample = run.sample(np.linspace(0.15, 0.2, 100_001))
    assert run.peak_force == pytest.approx(sample["contact_force"].max(), rel=1e-6)
    assert run.peak_force >= sample["contact_force"].max() * (1.0 - 1e-12)
    hits = run.events["time"][(run.events["kind"] == "impact") & (run.events["time"] > 0.15)]
    approach = plate_motion(conveyor, hits)["vz"] - run.sample(hits - 1e-10)["vz"]
    assert run.impact_speed == pytest.approx(approach.max(), rel=1e-6)


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_the_peak_force_counts_from_the_last_quarter_on(share):
    """The last quarter begins within a contact: what the contact did before does not count."""
    conveyor, start = Conveyor(acceleration=40.0), Start(3e-4)
    events = simulate(conveyor, start, duration=0.1).events
    impact, separation = (events["time"][events["kind"] == kind][1] for kind in ("impact", "separation"))
    since = impact + share * (separation - impact)
    run = simulate(conveyor, start, duration=since / 0.75)
    sample = run.sample(np.linspace(since, run.duration, 20_001))
    assert run.peak_force == pytest.approx(sample["contact_force"].max(), rel=1e-5)


def test_a_part_that_never_lands_has_no_peaks():
    run = simulate(AT_REST, Start(0.1), duration=0.1)
    assert (run.impact_speed, run.peak_force) == (0.0, 0.0)
    still = simulate(AT_REST, resting(AT_REST), duration=0.1)
    assert still.impact_speed == 0.0
    assert still.peak_force == pytest.approx(AT_REST.mass * AT_REST.gravity, rel=1e-9)
