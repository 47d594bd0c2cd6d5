"""The event-driven solver compared with closed forms, an independent slow solution, and its tolerance."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from reference import reference_mean_velocity
from scipy.integrate import quad
from scipy.linalg import expm

from conveyor import Conveyor, Start, plate_motion, simulate
from conveyor.solver.pieces import MAX_PIECES

AT_REST = Conveyor(acceleration=0.0)
REFERENCE = {
    (30.0, 0.0): 0.00709944242728,
    (40.0, 3e-4): 0.0650828019770,
    (47.0, 0.0): 0.0120966358597,
    (52.5, 0.0): 0.0660410919632,
}


@pytest.mark.parametrize(("acceleration", "z"), REFERENCE)
def test_reference_values(acceleration, z):
    run = simulate(Conveyor(acceleration=acceleration), Start(z), tolerance=1e-11)
    assert run.status == "ok"
    assert run.mean_velocity() == pytest.approx(REFERENCE[acceleration, z], rel=1e-9)


def test_free_fall():
    """A parabola and a uniform motion, up to the first impact at its exact time."""
    start = Start(z=0.02, vz=0.1)
    run = simulate(AT_REST, start, duration=0.1)
    impact = (0.1 + math.sqrt(0.1**2 + 2 * 9.81 * 0.02)) / 9.81
    assert run.events[0]["kind"] == "impact"
    assert run.events[0]["time"] == pytest.approx(impact, rel=1e-15)
    times = np.linspace(0.0, impact, 50)[:-1]
    sample = run.sample(times)
    np.testing.assert_allclose(sample["z"], 0.02 + 0.1 * times - 0.5 * 9.81 * times**2, rtol=0, atol=1e-17)
    np.testing.assert_array_equal(sample["contact_force"], 0.0)


@pytest.mark.parametrize("exponent", [1.0, 1.25, 1.5, 2.0, 3.0])
def test_undamped_impact(exponent):
    """Without damping, and with gravity too weak to matter, penetration and restitution have closed forms."""
    conveyor = replace(AT_REST, damping=0.0, exponent=exponent, gravity=1e-3, stiffness=5e5 if exponent < 2 else 5e9)
    speed = 0.35
    run = simulate(conveyor, Start("conveyor", -speed), duration=0.05, tolerance=1e-13)
    leave = run.events[run.events["kind"] == "separation"]["time"][0]
    deepest = (0.5 * (exponent + 1) * conveyor.mass * speed**2 / conveyor.stiffness) ** (1 / (exponent + 1))
    duration = 2 * deepest / speed * quad(lambda x: 2 * x / math.sqrt(1 - (1 - x * x) ** (exponent + 1)), 0, 1)[0]
    assert leave == pytest.approx(duration, rel=5e-6)
    sample = run.sample(np.array([0.5 * leave, leave]))
    assert -sample["z"][0] == pytest.approx(deepest, rel=5e-6)
    assert sample["vz"][1] == pytest.approx(speed, rel=1e-10)
    if exponent == 1.5:
        assert duration == pytest.approx(2.9432 * deepest / speed, rel=5e-5)


def test_hooke_contact_in_closed_form():
    """For p = 1 contact is a damped linear oscillator under harmonic forcing; the jumps between are parabolas."""
    conveyor = Conveyor(exponent=1.0, stiffness=2.4e3, acceleration=60.0)
    run = simulate(conveyor, Start(2e-4), duration=0.3, tolerance=1e-12)
    omega, mass, a_z = 100 * math.pi, conveyor.mass, 60.0 * math.sin(conveyor.angle)
    # (gap, its rate, cos θ, sin θ, 1)' = generator (…)
    generator = np.zeros((5, 5))
    generator[0, 1] = 1.0
    generator[1] = [-conveyor.stiffness / mass, -conveyor.damping / mass, -a_z, 0.0, -9.81]
    generator[2, 3], generator[3, 2] = -omega, omega
    vertical = run.events[np.isin(run.events["kind"], ["impact", "separation"])]
    assert len(vertical) > 20
    for begin, end in itertools.pairwise(vertical):
        if begin["kind"] != "impact":
            continue
        state, after = (run.sample(np.array([t]))["vz"][0] for t in (begin["time"], end["time"]))
        plate = plate_motion(conveyor, np.array([begin["time"], end["time"]]))
        phase = omega * begin["time"]
        vector = np.array([0.0, state - plate["vz"][0], math.cos(phase), math.sin(phase), 1.0])
        gap, rate = (expm(generator * (end["time"] - begin["time"])) @ vector)[:2]
        assert gap == pytest.approx(0.0, abs=1e-13)
        assert rate == pytest.approx(after - plate["vz"][1], rel=1e-8)


@pytest.mark.parametrize("tension", ["allow", "frictionless", "clip"])
@pytest.mark.parametrize("exponent", [1.0, 1.3, 1.5, 2.5])
def test_fast_against_slow(tension, exponent):
    stiffness = {1.0: 3e3, 1.3: 5e4, 1.5: 5e5, 2.5: 2e10}[exponent]
    conveyor = Conveyor(tension=tension, exponent=exponent, stiffness=stiffness, acceleration=44.0, psi0=1.0)
    fast = simulate(conveyor, Start(1e-4, 0.05), duration=0.1, tolerance=1e-12).mean_velocity()
    assert fast == pytest.approx(reference_mean_velocity(conveyor, Start(1e-4, 0.05), 0.1), rel=1e-8)


def test_stick_obeys_filippov():
    """While the part sticks, it moves with the plate; friction accelerates it and stays within its cone."""
    conveyor = Conveyor(acceleration=8.0, friction=0.6)
    run = simulate(conveyor, Start("conveyor"), duration=0.2, tolerance=1e-12)
    stick = run.events[run.events["kind"] == "stick"]["time"]
    slip = run.events[run.events["kind"] == "slip"]["time"]
    assert len(stick) > 5
    for begin in stick[:-1]:
        end = slip[slip > begin][0]
        times = np.linspace(begin, end, 40)[1:-1]
        sample, plate = run.sample(times), plate_motion(conveyor, times)
        np.testing.assert_allclose(sample["vx"], plate["vx"], rtol=0, atol=1e-14)
        assert (np.abs(sample["friction_force"]) <= conveyor.friction * sample["contact_force"] + 1e-15).all()
        pull = conveyor.mass * 8.0 * math.cos(conveyor.angle) * np.cos(100 * math.pi * times)
        np.testing.assert_allclose(sample["friction_force"], pull, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-9])
def test_stick_ends_with_its_friction(tolerance):
    """It ends at |ẍ_s| = μ F_c/m, up to a force that rounding cannot resolve: ten tolerances of the part's weight."""
    conveyor = Conveyor(acceleration=8.0, friction=0.6)
    run = simulate(conveyor, Start("conveyor"), duration=0.2, tolerance=tolerance)
    slip = run.events[run.events["kind"] == "slip"]["time"]
    assert len(slip) > 5
    a_x = 8.0 * math.cos(conveyor.angle) * np.abs(np.cos(100 * math.pi * slip))
    lack = a_x / conveyor.friction - run.sample(slip)["contact_force"] / conveyor.mass
    assert np.abs(lack).max() < 20.0 * tolerance * conveyor.gravity


@pytest.mark.parametrize(("acceleration", "z"), [(30.0, 0.0), (40.0, 3e-4), (47.0, 0.0)])
def test_errors_follow_the_tolerance(acceleration, z):
    answers = [
        simulate(Conveyor(acceleration=acceleration), Start(z), tolerance=10.0**-k).mean_velocity()
        for k in range(6, 13)
    ]
    for k, (loose, tight) in enumerate(itertools.pairwise(answers), start=6):
        assert abs(tight - loose) <= 100 * 10.0**-k * abs(tight)


def test_start_on_the_plate_at_relative_rest():
    """The part neither falls through nor gets stuck, whether the plate presses against it or moves away."""
    for psi0 in np.linspace(0.0, 2 * math.pi, 33):
        conveyor = Conveyor(acceleration=60.0, psi0=psi0)
        plate = plate_motion(conveyor, np.array([0.0]))
        run = simulate(conveyor, Start("conveyor", float(plate["vz"][0])), duration=0.1)
        assert run.status == "ok"
        times = np.linspace(0.0, 0.1, 500)
        assert (run.sample(times)["z"] - plate_motion(conveyor, times)["z"] > -3e-4).all()


def test_start_inside_the_plate():
    run = simulate(Conveyor(), Start(z=-2e-3), duration=0.1)
    assert run.status == "ok"
    assert "separation" in run.events["kind"]


@pytest.mark.parametrize("tension", ["allow", "frictionless", "clip"])
@pytest.mark.parametrize("z", [3e-4, -1e-4])
def test_nothing_moves_a_part_along_a_plate_at_rest(tension, z):
    run = simulate(replace(AT_REST, tension=tension), Start(z), duration=0.2)
    samples = run.sample(np.linspace(0.0, 0.2, 2001))
    assert (samples["contact_force"].min() < 0.0) == (tension != "clip")
    assert not (samples["x"].any() or samples["vx"].any() or samples["friction_force"].any())


def test_a_vertical_plate_moves_no_part_along_the_track():
    run = simulate(Conveyor(acceleration=12.0, angle=0.5 * math.pi), Start(3e-4), duration=1.0)
    assert run.impacts > 10
    assert run.x_end == run.vx_end == 0.0


@pytest.mark.parametrize("inclination", [0.0, 0.1])
def test_without_friction_only_gravity_acts_along_the_track(inclination):
    run = simulate(Conveyor(friction=0.0, inclination=inclination), Start(3e-4), duration=1.0)
    fall = 9.81 * math.sin(inclination)
    assert run.vx_end == pytest.approx(-fall, rel=1e-12)
    assert run.x_end == pytest.approx(-0.5 * fall, rel=1e-12)


def test_the_slip_changes_its_sign_without_friction_too():
    run = simulate(Conveyor(friction=0.0, acceleration=20.0), duration=0.2)
    assert np.sum(run.events["kind"] == "slip reversal") >= 18


def test_samples_do_not_disturb_a_run():
    """Any set of sample times gives bit for bit the same motion, in the requested order."""
    run = simulate(Conveyor(acceleration=80.0), Start(), duration=0.5)
    times = np.array([[0.4, 0.1], [0.25, 0.5]])
    sample = run.sample(times)
    assert sample["z"].shape == (2, 2)
    for place in np.ndindex(2, 2):
        alone = run.sample(np.array([times[place]]))
        assert all(alone[name][0] == sample[name][place] for name in sample)
    assert run.sample(np.array([0.5]))["x"][0] == run.x_end


def test_long_runs_keep_their_phase():
    """The settled motion after 1000 s equals the motion after 1 s."""
    run = simulate(Conveyor(acceleration=30.0), Start(), duration=1000.0)
    assert run.status == "ok"
    late = run.sample(np.linspace(999.9, 999.98, 5))["vz"]
    early = run.sample(np.linspace(4.9, 4.98, 5))["vz"]
    np.testing.assert_allclose(late, early, rtol=0, atol=1e-10)


def test_a_contact_that_is_too_stiff_is_a_status():
    """Its time constant m/d_c is 1e-9 s: no run of 0.1 s can follow it, and each run reports that quickly."""
    run = simulate(Conveyor(damping=1e6, mass=1e-3), Start("conveyor"), duration=0.1)
    assert run.status == "contact too stiff"
    assert math.isnan(run.z_end)
    assert run.work <= MAX_PIECES


@pytest.mark.parametrize("acceleration", [0.0, 1e-300, 2.220446049250313e-16, 1e-9])
def test_a_nearly_still_plate_is_not_passed(acceleration):
    """An undamped part on a plate at rest returns to its height, unless a root is lost to cancellation."""
    conveyor = Conveyor(acceleration=acceleration, damping=0.0)
    times = np.linspace(0.0, 0.3, 3001)
    gap = simulate(conveyor, Start("conveyor", vz=-0.07), duration=0.3).sample(times)["z"]
    deepest = (5.0 * 0.7e-3 * 0.07**2 / (4.0 * 5e5)) ** 0.4
    assert -1.1 * deepest < gap.min() < -deepest  # a little more, since the weight presses too
    assert gap.max() == pytest.approx(0.07**2 / (2.0 * 9.81), rel=1e-3)


def test_the_largest_gap_covers_all_flights():
    """A part that is dropped on a plate at rest never reaches its initial height again."""
    run = simulate(AT_REST, Start(z=5e-3), duration=0.3)
    assert run.impacts > 3
    assert run.max_gap == pytest.approx(5e-3, rel=1e-12)


@pytest.mark.parametrize("speed", [1e-2, 5e-2])
def test_small_bounces_go_on(speed):
    """An undamped part on a plate at rest jumps to the same height again and again, however low."""
    conveyor = replace(AT_REST, damping=0.0)
    depth = (conveyor.mass * conveyor.gravity / conveyor.stiffness) ** (1.0 / conveyor.exponent)  # at rest
    velocity = speed * math.sqrt(2.0 * conveyor.gravity * depth)
    run = simulate(conveyor, Start("conveyor", velocity), duration=0.1, tolerance=1e-8)
    assert run.impacts > 5
    impacts, separations = (run.events[run.events["kind"] == kind]["time"] for kind in ("impact", "separation"))
    flights = impacts[1:] - separations[: len(impacts) - 1]
    np.testing.assert_allclose(flights, 2.0 * velocity / conveyor.gravity, rtol=1e-2)


@pytest.mark.parametrize("acceleration", [30.0, 47.0])
def test_steps_of_a_settled_motion_are_used_again(acceleration):
    """The vertical motion settles within a second; from then on no step is computed, and the results are equal."""
    short, long = (simulate(Conveyor(acceleration=acceleration), duration=duration) for duration in (1.0, 20.0))
    assert long.work < 1.2 * short.work
    tight = simulate(Conveyor(acceleration=acceleration), duration=20.0, tolerance=1e-13)
    assert long.mean_velocity() == pytest.approx(tight.mean_velocity(), rel=1e-8)
    assert (long.z_end, long.vz_end) == pytest.approx((tight.z_end, tight.vz_end), rel=1e-7)
    assert long.impacts == tight.impacts
    assert len(long.events) == len(tight.events)


@pytest.mark.parametrize("acceleration", [2.0, 8.0])
def test_a_part_that_rides_on_a_vertical_plate_has_no_events(acceleration):
    """Below g the part never leaves the plate, and without horizontal motion it neither slips nor begins to stick."""
    conveyor = Conveyor(acceleration=acceleration, angle=0.5 * math.pi, friction=0.6)
    assert len(simulate(conveyor, Start("conveyor"), duration=0.1).events) == 0


@pytest.mark.parametrize("psi0", [0.0, math.pi])
def test_a_plate_presses_against_or_leaves_a_part_at_relative_rest(psi0):
    """At the phase 0 the plate accelerates upwards and presses, at π it falls away by (a_z - g) t²/2: 2.7 m/s² t²/2."""
    conveyor = Conveyor(acceleration=60.0, psi0=psi0)
    run = simulate(conveyor, Start("conveyor"), duration=0.01)
    moment = np.array([1e-4])
    sample, plate = run.sample(moment), plate_motion(conveyor, moment)
    gap = sample["z"][0] - plate["z"][0]
    if psi0 == 0.0:
        assert sample["contact_force"][0] > 0.0
        assert gap < 0.0
        assert run.impacts == 0
    else:
        assert sample["contact_force"][0] == 0.0
        assert gap == pytest.approx(0.5 * (60.0 * math.sin(conveyor.angle) - 9.81) * 1e-8, rel=1e-2)


def test_a_run_that_ends_in_the_air_counts_nothing_behind_its_end():
    run = simulate(AT_REST, Start(z=1e-3, vz=1.0), duration=0.05)
    assert (run.impacts, run.event_count, run.impact_speed) == (0, 0, 0.0)
    assert run.max_gap == run.z_end == pytest.approx(1e-3 + 0.05 - 0.5 * AT_REST.gravity * 0.05**2)
