"""Blocks: limits with closed forms, an independent integration by SciPy, and random blocks."""

import math
from dataclasses import replace
from time import process_time

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from random_conveyors import around_the_paper, tilted
from scipy.integrate import quad, solve_ivp

from conveyor import (
    Block,
    Conveyor,
    Harmonic,
    Start,
    block_transits,
    parameter_table,
    plate_motion,
    simulate,
    simulate_block,
)
from conveyor.solver.model import unpack

LOCKED = 1e9  # m², a moment of inertia per mass with which nothing turns
FLAT = Block(5e-3, 1e-3)
STILL = {"acceleration": 0.0, "angle": 0.0}


def final(run):
    """The state at the end of a run."""
    return {name: value.item() for name, value in run.sample(np.array(run.duration)).items()}


def corners_of(block, angle):
    """Offsets of the four corners from the centre (m), two arrays of the shape (4, n)."""
    x, z = 0.5 * block.length * np.array([-1, 1, -1, 1]), 0.5 * block.height * np.array([-1, -1, 1, 1])
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.outer(x, cosine) - np.outer(z, sine), np.outer(x, sine) + np.outer(z, cosine)


def at_corners(conveyor, block, times, x, vx, z, vz, angle, spin):
    """Offsets (m), gaps (m), their rates and slip velocities (m/s) of the corners, each of the shape (4, n).

    z : height of the centre above that at rest on the plate in its middle position
    """
    ox, oz = corners_of(block, angle)
    plate = plate_motion(conveyor, times)
    return ox, oz, z + 0.5 * block.height + oz - plate["z"], vz + spin * ox - plate["vz"], plate["vx"] - vx + spin * oz


def forces(conveyor, gaps, rates, closed=None):
    """Contact forces per mass (m/s²) from the law, written out again."""
    closed = gaps < 0.0 if closed is None else closed
    depth = np.maximum(-gaps, 0.0)
    force = 0.5 / conveyor.mass * (conveyor.stiffness * depth**conveyor.exponent - conveyor.damping * rates)
    return np.where(closed, force, 0.0)


@pytest.mark.parametrize("tension", ["allow", "frictionless", "clip"])
@pytest.mark.parametrize(("acceleration", "z"), [(30.0, 0.0), (40.0, 3e-4), (47.0, 0.0), (52.5, 0.0)])
def test_a_block_that_cannot_turn_is_a_point(acceleration, z, tension):
    conveyor = Conveyor(acceleration=acceleration, tension=tension)
    block = simulate_block(conveyor, replace(FLAT, inertia=LOCKED), Start(z=z), tolerance=1e-9)
    point = simulate(conveyor, Start(z=z), tolerance=1e-12)
    assert block.status == "ok"
    assert block.mean_velocity() == pytest.approx(point.mean_velocity(), rel=1e-6)
    assert final(block)["z"] == pytest.approx(point.z_end, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    "harmonics",
    # All code of blocks is compiled once more for plates with harmonics.
    [(), pytest.param((Harmonic(2, 0.1, 0.3, 0.2, -0.4),), marks=pytest.mark.long)],
    ids=["pure", "harmonic"],
)
def test_a_locked_block_is_a_point_on_a_tilted_track_with_static_friction(harmonics):
    model = {"inclination": 0.05, "phase_shift": 0.4, "static_friction": 0.2, "exponent": 1.2, "stiffness": 3e4}
    conveyor = Conveyor(**model, acceleration=45.0, harmonics=harmonics)
    block = simulate_block(conveyor, replace(FLAT, inertia=LOCKED), Start(z=2e-4), duration=0.2, tolerance=1e-9)
    point = simulate(conveyor, Start(z=2e-4), duration=0.2, tolerance=1e-12)
    assert block.x_end == pytest.approx(point.x_end, rel=1e-5)
    assert final(block)["vz"] == pytest.approx(point.vz_end, abs=1e-6)


def test_without_friction_a_level_block_has_the_vertical_motion_of_a_point():
    conveyor = Conveyor(acceleration=47.0, friction=0.0)
    times = np.linspace(0.0, 0.5, 101)
    block = simulate_block(conveyor, Block(4e-3, 3e-3), Start(z=1e-4), duration=0.5, tolerance=1e-10).sample(times)
    point = simulate(conveyor, Start(z=1e-4), duration=0.5, tolerance=1e-12).sample(times)
    np.testing.assert_allclose(block["z"], point["z"], atol=1e-10)
    np.testing.assert_allclose(block["vz"], point["vz"], atol=1e-6)
    assert np.abs(block["angle"]).max() < 1e-9


def test_samples_do_not_change_the_motion_and_count_from_the_middle_position_of_the_plate():
    run = simulate_block(Conveyor(acceleration=60.0), FLAT, Start(z=3e-4), tilt=0.02, duration=0.3)
    samples = run.sample(np.array([[0.3, 0.0], [0.1, 0.225]]))
    assert samples["x"].shape == (2, 2)
    assert samples["x"][0, 0] == run.x_end
    assert samples["z"][0, 1] == pytest.approx(3e-4, abs=1e-15)
    assert samples["angle"][0].tolist() == [final(run)["angle"], 0.02]
    assert run.mean_velocity(0.25) == pytest.approx((run.x_end - samples["x"][1, 1]) / 0.075, rel=1e-9)
    assert run.largest_tilt >= np.abs(run.sample(np.linspace(0.0, 0.3, 2001))["angle"]).max() - 1e-6


def test_samples_of_a_long_chaotic_run_are_those_of_the_run():
    """A step ends at the beginning of the last quarter; if it did not, a rounding would grow until the end."""
    run = simulate_block(Conveyor(acceleration=60.0), FLAT, Start(z=3e-4), tilt=0.02, duration=10.0)
    assert run.sample([10.0])["x"][0] == run.x_end


@pytest.mark.long  # all code of blocks is compiled once more for plates with harmonics
@pytest.mark.parametrize(("order", "stiffness"), [(100, 5e5), (20, 1e3)])
def test_slip_that_reverses_within_a_short_cycle_of_a_harmonic_is_found(order, stiffness):
    conveyor = Conveyor(acceleration=30.0, stiffness=stiffness, harmonics=[Harmonic(order, along=5.0)])
    block = simulate_block(conveyor, replace(FLAT, inertia=LOCKED), duration=0.5)
    assert block.mean_velocity() == pytest.approx(simulate(conveyor, duration=0.5).mean_velocity(), rel=1e-4)


def test_a_part_that_still_accelerates_does_not_keep_its_velocity_with_a_loose_tolerance():
    parameters = parameter_table(Conveyor(acceleration=40.0, friction=2e-4), z0=[3e-4])
    options = {"length": 1e3, "longest": 60.0, "begin": 0.0}
    locked = replace(FLAT, inertia=LOCKED)
    loose, tight = (block_transits(parameters, locked, 0.0, tolerance=own, **options) for own in (1e-3, 1e-8))
    assert loose.velocity == pytest.approx(tight.velocity, rel=0.05)


@pytest.mark.parametrize("friction", [0.0, 0.15])
def test_the_work_of_plate_damper_and_friction_is_the_change_of_energy(friction):
    """Friction is known from the slip velocity, because sticking takes hardly any time in these impacts."""
    conveyor, block = Conveyor(acceleration=90.0, friction=friction), Block(5e-3, 2e-3)
    times = np.linspace(0.0, 0.1, 400_001)
    run = simulate_block(conveyor, block, Start(z=3e-4), tilt=0.03, duration=0.1, tolerance=1e-10).sample(times)
    _, _, gaps, rates, slips = at_corners(conveyor, block, times, *run.values())
    plate, force = plate_motion(conveyor, times), forces(conveyor, gaps, rates)
    rub = friction * force * np.sign(slips)
    spring = conveyor.stiffness / conveyor.mass * 0.5 * np.maximum(-gaps, 0.0) ** 2.5 / 2.5
    inertia = (block.length**2 + block.height**2) / 12.0
    kinetic = 0.5 * (run["vx"] ** 2 + run["vz"] ** 2 + inertia * run["spin"] ** 2)
    energy = kinetic + conveyor.gravity * run["z"] + spring.sum(axis=0)
    damper = np.where(gaps < 0.0, -0.5 * conveyor.damping / conveyor.mass * rates**2, 0.0)
    power = force * plate["vz"] + rub * plate["vx"] + damper - rub * slips
    work = np.trapezoid(power.sum(axis=0), times)
    given_in = np.trapezoid(np.abs(power).sum(axis=0), times)
    assert abs(energy[-1] - energy[0] - work) < 1e-3 * given_in


def rocking(block, gravity):
    """Half of the diagonal (m), its angle to the height, and the square of Housner's frequency p² = 3g/(4R)."""
    half = 0.5 * math.hypot(block.length, block.height)
    return half, math.atan2(block.length, block.height), 0.75 * gravity / half


def release(block, tilt):
    """Start and tilt of a block that stands on its rear corner, raised at the front."""
    half, slender, _ = rocking(block, 9.81)
    return Start(z=half * math.cos(slender - tilt) - 0.5 * block.height)


STIFF = {**STILL, "friction": 10.0, "mass": 1.0, "exponent": 1.0, "tension": "clip"}


def test_a_free_block_rocks_as_housner_says():
    """Bull. Seismol. Soc. Am. 53 (1963): the time until the other corner hits, and the loss of speed there."""
    block, tilt = Block(0.1, 0.4), 0.1
    _, slender, p2 = rocking(block, 9.81)

    def rate(angle):
        return math.sqrt(2.0 * p2 * (math.cos(slender - tilt) - math.cos(slender - angle)))

    quarter, _ = quad(lambda s: 2.0 * s / rate(tilt - s * s), 0.0, math.sqrt(tilt))
    of_slender_blocks = math.acosh(1.0 / (1.0 - tilt / slender)) / math.sqrt(p2)
    assert quarter == pytest.approx(of_slender_blocks, rel=0.05)
    # Contacts that are stiff and take the whole speed of a corner.
    conveyor = Conveyor(**STIFF, stiffness=1e8, damping=4e4)
    run = simulate_block(conveyor, block, release(block, tilt), tilt=tilt, duration=1.5 * quarter, tolerance=1e-7)
    times = np.linspace(0.0, 1.5 * quarter, 60_001)
    samples = run.sample(times)
    assert run.status == "ok"
    level = np.flatnonzero(samples["angle"] < 0.0)[0]
    assert times[level] == pytest.approx(quarter, rel=2e-3)
    before, after = (np.interp(times[level] + shift, times, samples["spin"]) for shift in (-5e-4, 1.5e-3))
    assert before == pytest.approx(-rate(0.0), rel=0.01)
    assert after / before == pytest.approx(1.0 - 1.5 * math.sin(slender) ** 2, rel=0.02)


def test_a_corner_that_hits_a_stiff_linear_contact_rebounds_as_a_damped_oscillator():
    block, tilt = Block(5e-3, 2e-3), 0.4
    stiffness, damping, mass = 1e9, 300.0, 1e-3
    conveyor = Conveyor(
        **STILL, friction=0.0, stiffness=stiffness, damping=damping, mass=mass, exponent=1.0, gravity=1e-3
    )
    start = Start(z=3e-3, vz=-0.3)
    run = simulate_block(conveyor, block, start, tilt=tilt, duration=0.02, tolerance=1e-10)
    ox, oz = corners_of(block, np.array([tilt]))
    lever = ox[np.argmin(oz)].item()
    inertia = (block.length**2 + block.height**2) / 12.0
    # The mass that the corner moves, and the damping ratio of its contact.
    own = mass / (1.0 + lever**2 / inertia)
    ratio = 0.5 * damping / (2.0 * math.sqrt(0.5 * stiffness * own))
    restitution = math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))
    hit = (3e-3 + 0.5 * block.height + oz.min()) / 0.3
    samples = run.sample(np.array([hit + 5e-4]))
    rate = samples["vz"] + samples["spin"] * lever
    assert rate.item() / 0.3 == pytest.approx(restitution, rel=2e-3)
    assert samples["spin"].item() == pytest.approx(lever * own / (mass * inertia) * 0.3 * (1.0 + restitution), rel=2e-3)


def reference(conveyor, block, start, tilt, duration, width):
    """The final state by DOP853 with events where corners touch and leave; friction is smoothed over ±width (m/s).

    Without friction, or where no corner ever stops to slip, this is the exact motion.
    """
    inertia = (block.length**2 + block.height**2) / 12.0
    state, time = np.array([0.0, 0.0, start.z, start.vz, tilt, 0.0]), 0.0
    *_, gaps, _, _ = at_corners(conveyor, block, np.zeros(1), *state[:, None])
    closed = gaps[:, 0] <= 0.0

    def rates(t, y, closed):
        ox, oz, gaps, rates, slips = at_corners(conveyor, block, np.array([t]), *y[:, None])
        force = forces(conveyor, gaps, rates, closed[:, None])
        rub = conveyor.friction * force * np.tanh(slips / width)
        turn = (ox * force - oz * rub).sum() / inertia
        return [y[1], rub.sum(), y[3], force.sum() - conveyor.gravity, y[5], turn]

    def gap_of(corner, direction):
        def event(t, y, closed):
            return at_corners(conveyor, block, np.array([t]), *y[:, None])[2][corner, 0]

        event.terminal, event.direction = True, direction
        return event

    while time < duration:
        events = [gap_of(corner, 1.0 if closed[corner] else -1.0) for corner in range(4)]
        solution = solve_ivp(
            rates,
            (time, duration),
            state,
            method="DOP853",
            rtol=1e-10,
            atol=1e-13,
            max_step=2e-4,
            events=events,
            args=(closed.copy(),),
        )
        time, state = solution.t[-1], solution.y[:, -1]
        for corner, moments in enumerate(solution.t_events):
            closed[corner] ^= len(moments) > 0
    return dict(zip(("x", "vx", "z", "vz", "angle", "spin"), state, strict=True))


def random_case(seed, **model):
    rng = np.random.default_rng(seed)
    block = Block(rng.uniform(1e-3, 8e-3), rng.uniform(1e-3, 6e-3))
    conveyor = Conveyor(acceleration=rng.uniform(30.0, 90.0), psi0=rng.uniform(0.0, 6.0), **model)
    # A start above the plate, so that both methods begin in flight.
    start = Start(z=rng.uniform(4e-4, 9e-4), vz=rng.uniform(-0.3, 0.3))
    return conveyor, block, start, rng.uniform(-0.1, 0.1)


@pytest.mark.parametrize("seed", range(6))
def test_scipy_finds_the_same_motion_without_friction(seed):
    conveyor, block, start, tilt = random_case(seed, friction=0.0)
    run = simulate_block(conveyor, block, start, tilt=tilt, duration=0.03, tolerance=1e-11)
    expected = reference(conveyor, block, start, tilt, 0.03, 1.0)
    assert final(run)["angle"] == pytest.approx(expected["angle"], abs=1e-7)
    assert final(run)["z"] == pytest.approx(expected["z"], abs=1e-10)
    assert final(run)["vz"] == pytest.approx(expected["vz"], abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_scipy_finds_the_same_motion_with_smoothed_friction(seed):
    """The error of smoothing falls with its width; slip, stick and their changes have none here."""
    conveyor, block, start, tilt = random_case(seed)
    run = simulate_block(conveyor, block, start, tilt=tilt, duration=0.02, tolerance=1e-11)
    wide, narrow = (reference(conveyor, block, start, tilt, 0.02, width) for width in (4e-4, 1e-4))
    for name, size in (("x", 1e-3), ("vx", 0.1), ("angle", 0.1), ("z", 1e-3)):
        own = final(run)[name]
        smoothing = abs(wide[name] - narrow[name])
        assert abs(own - narrow[name]) < smoothing + 1e-6 * size, name


@pytest.mark.parametrize("acceleration", [32.0, 40.0, 56.0])
def test_settled_motions_do_not_depend_on_the_tolerance(acceleration):
    runs = [
        simulate_block(Conveyor(acceleration=acceleration), Block(5e-3, 3e-3), Start(z=3e-4), tilt=0.02, tolerance=one)
        for one in (1e-7, 1e-8, 1e-10)
    ]
    loose, default, tight = (run.mean_velocity() for run in runs)
    assert default == pytest.approx(tight, rel=2e-5)
    assert loose == pytest.approx(tight, rel=2e-4)


@pytest.mark.parametrize(
    ("psi0", "start", "tilt"),
    [
        (1.9901245943337187, Start(0.00013682031477009227, -0.049941201401343255), 0.0255937292184951),
        (2.48975089632114, Start(0.00045221174666074663, -0.12857124873025122), -0.008091693664650788),
    ],
)
def test_a_corner_that_has_just_left_the_plate_may_come_back_within_a_step(psi0, start, tilt):
    """After 2 s and 0.5 s, a corner leaves from just below the plate and is pulled down again: no endless events."""
    conveyor = Conveyor(acceleration=63.62050744092845, psi0=psi0, static_friction=0.15)
    block = Block(0.004999622882002608, 0.0029997737292015644)
    assert simulate_block(conveyor, block, start, tilt=tilt, duration=2.5, tolerance=1e-7).status == "ok"


def test_the_fast_motion_of_a_flat_block_rocks_from_edge_to_edge_in_two_cycles():
    conveyor, block = Conveyor(acceleration=45.0, psi0=2.0), Block(5e-3, 1e-3)
    run = simulate_block(conveyor, block, Start(z=4e-4, vz=0.1), tilt=0.03, duration=4.0)
    assert run.mean_velocity() > 1.5 * simulate(conveyor, Start(z=3e-4)).mean_velocity()
    times = np.linspace(3.0, 3.08, 2001)
    angle = run.sample(times)["angle"]
    assert angle[1000:].tolist() == pytest.approx(angle[:1001].tolist(), abs=1e-4)
    assert np.abs(angle[500:] - angle[:-500]).max() > 0.1
    assert angle.min() < -0.1 and angle.max() > 0.1


@pytest.mark.parametrize(("stiffness", "z", "tolerance"), [(1e9, 10.0, 1e-8), (1e11, 0.5, 1e-8), (1e7, 0.5, 1e-10)])
def test_a_block_that_falls_from_a_height_onto_a_stiff_plate_is_followed(stiffness, z, tolerance):
    """Rounding of the height is then larger than the depth that the tolerance allows."""
    conveyor = Conveyor(acceleration=40.0, stiffness=stiffness)
    run = simulate_block(conveyor, FLAT, Start(z=z), tilt=0.02, duration=3.0, tolerance=tolerance)
    assert run.status == "ok"


def test_a_block_may_roll_over():
    run = simulate_block(Conveyor(acceleration=120.0), Block(3e-3, 3e-3), Start(z=3e-4), tilt=0.1)
    assert run.status == "ok"
    assert run.largest_tilt > 0.5 * math.pi


def test_transits_skip_the_cycles_of_a_settled_motion():
    parameters = parameter_table(Conveyor(acceleration=32.0), z0=[1e-4, 3e-4], psi0=[0.0, 2.0])
    options = {"longest": 4.0, "begin": np.array([0.4, 0.4])}
    late = block_transits(parameters, FLAT, np.array([0.02, -0.01]), length=1.0, **options)
    assert late.status.tolist() == ["ok", "ok"]
    assert np.isnan(late.arrival).all()
    for k, tilt in enumerate((0.02, -0.01)):
        start = Start(z=parameters["z0"][k].item())
        conveyor = Conveyor(acceleration=32.0, psi0=parameters["psi0"][k].item())
        run = simulate_block(conveyor, FLAT, start, tilt=tilt, duration=4.0)
        assert late.velocity[k] == pytest.approx(run.x_end / 4.0, rel=1e-5)
    arrived = block_transits(parameters, FLAT, np.array([0.02, -0.01]), length=0.02, **options)
    assert (arrived.arrival < 4.0).all()
    assert arrived.airtime.tolist() == [0.0, 0.0]
    np.testing.assert_allclose(arrived.velocity, late.velocity, rtol=0.05)


def test_the_time_in_the_air_counts_from_any_moment_of_a_settled_motion():
    """Skipped cycles count as followed ones; of a block that does not turn, it is that of a point."""
    conveyor, locked = Conveyor(acceleration=40.0), Block(5e-3, 1e-3, LOCKED)
    point = simulate(conveyor, Start(z=3e-4), duration=20.0)
    parameters = parameter_table(conveyor, z0=[3e-4] * 4)
    begin = np.array([1.0, 5.0, 10.0, 19.0])
    late = block_transits(parameters, locked, 0.0, length=1e3, longest=20.0, begin=begin)
    assert late.airtime == pytest.approx(1.0 - point.contact_fraction, abs=5e-3)
    run = simulate_block(conveyor, locked, Start(z=3e-4), duration=2.0)
    assert run.airtime == pytest.approx(late.airtime[0], abs=5e-3)


@pytest.mark.parametrize(("slope", "stays"), [(0.3, True), (0.55, True), (0.65, False)])
@pytest.mark.parametrize("height", [1e-4, 1e-3, 5e-3])
def test_static_friction_holds_a_block_as_a_point(height, slope, stays):
    """On an inclined plate at rest, in equilibrium; both lower corners reach the limit together."""
    angle, length = math.atan(slope), 5e-3
    conveyor = Conveyor(acceleration=0.0, inclination=angle, friction=0.2, static_friction=0.6)
    weight = conveyor.gravity * math.cos(angle)
    loads = 0.5 * weight * (1.0 + height / length * slope * np.array([1.0, -1.0]))  # per mass, of the lower end first
    depths = (conveyor.mass * loads / (0.5 * conveyor.stiffness)) ** (1.0 / conveyor.exponent)
    tilt = math.asin((depths[0] - depths[1]) / length)
    start = Start(z=-depths.mean() + 0.5 * height * (math.cos(tilt) - 1.0))
    run = simulate_block(conveyor, Block(length, height), start, tilt=tilt, duration=0.3)
    assert run.status == "ok"
    assert (abs(run.x_end) < 1e-7) == stays


@pytest.mark.parametrize(("exponent", "stiffness", "damping"), [(1.0, 2e4, 7.5), (1.5, 5e5, 2.0)])
def test_a_strong_damper_pushes_most_at_the_first_moment_of_an_impact(exponent, stiffness, damping):
    conveyor = Conveyor(acceleration=60.0, exponent=exponent, stiffness=stiffness, damping=damping)
    point = simulate(conveyor, Start(z=4e-4), duration=0.06)
    run = simulate_block(conveyor, Block(5e-3, 1e-3, LOCKED), Start(z=4e-4), duration=0.06)
    assert run.peak_force == pytest.approx(point.peak_force, rel=3e-3)


SIZES = st.floats(math.log(1e-4), math.log(0.1)).map(math.exp)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), SIZES, SIZES, st.floats(-1.5, 1.5))
@example(2240550, math.exp(-8.0), math.exp(-8.0), 0.0)  # the times of its last piece add up to less than its duration
@example(1, math.exp(-4.0), math.exp(-8.0), 0.0)  # all four corners stick
@example(543841560, 0.049787068367863944, 0.005983008510498413, 0.0)  # rounding of the gaps is above the tolerance
def test_random_blocks_do_not_fall_through_the_plate(seed, length, height, tilt):
    conveyor, _ = unpack(tilted(around_the_paper(1, seed), seed)[0])
    block, begin = Block(length, height), process_time()
    lift = 0.5 * (length * abs(math.sin(tilt)) + height * (math.cos(tilt) - 1.0))
    start = Start(z=lift + plate_motion(conveyor, np.zeros(1))["z"].item(), vz=0.1)
    run = simulate_block(conveyor, block, start, tilt=tilt, duration=3.0 / conveyor.frequency)
    assert process_time() - begin < 20.0
    assert run.status == "ok"
    times = np.linspace(0.0, run.duration, 601)
    samples = run.sample(times)
    assert all(np.isfinite(column).all() for column in samples.values())
    _, _, gaps, *_ = at_corners(conveyor, block, times, *samples.values())
    # All energy of the block, seen from the plate, in the spring of one corner.
    fall = samples["vz"] - plate_motion(conveyor, times)["vz"]
    energy = 0.5 * (fall**2 + (length**2 + height**2) / 12.0 * samples["spin"] ** 2).max()
    pull = conveyor.gravity + conveyor.acceleration
    power, spring = conveyor.exponent + 1.0, 0.5 * conveyor.stiffness / conveyor.mass / (conveyor.exponent + 1.0)
    depth = (2.0 * energy / spring) ** (1.0 / power) + (2.0 * pull / spring) ** (1.0 / conveyor.exponent)
    assert -gaps.min() <= 1.1 * depth
