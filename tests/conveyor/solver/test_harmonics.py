"""Plates with harmonics: another integrator, balances, the properties of every motion, and who refuses them."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference import accelerations, plate_at, reference_states

from conveyor import (
    Conveyor,
    Harmonic,
    Start,
    classify,
    conveyor_and_start,
    groups_of,
    lyapunov_spectrum,
    parameter_table,
    periodic_orbit,
    plate_motion,
    simulate,
    sweep,
    throw_number,
    transits,
)
from conveyor.analysis import stroboscopic_map
from conveyor.analysis.attractors.search import find_attractors
from conveyor.analysis.map_states import plate_heights
from conveyor.packing import plate_peaks
from conveyor.solver import contact, plate
from conveyor.solver.model import pack

COMPILES = pytest.mark.long  # the solver has other code for plates with harmonics
DURATION = 0.04  # s; later, chaos may have amplified rounding errors
TWO = (Harmonic(2, 0.1, 1.0, 0.05, -2.0), Harmonic(3, 0.05, 0.3, 0.1, 0.4))


def random_conveyor(generator: np.random.Generator, **changed) -> Conveyor:
    """A conveyor with up to four harmonics."""
    orders = generator.choice(np.arange(2, 9), generator.integers(1, 5), replace=False)
    waves = [(generator.uniform(0.0, 0.3), generator.uniform(-3.0, 3.0)) for _ in range(2 * len(orders))]
    harmonics = [Harmonic(int(order), *waves[2 * k], *waves[2 * k + 1]) for k, order in enumerate(orders)]
    values = {
        "acceleration": generator.uniform(20.0, 60.0),
        "angle": generator.uniform(0.15, 0.4),
        "psi0": generator.uniform(0.0, 6.0),
        "phase_shift": generator.uniform(-1.0, 1.0),
        "inclination": generator.uniform(-0.1, 0.1),
    }
    return Conveyor(**values | changed, harmonics=harmonics)


@COMPILES
@pytest.mark.parametrize("seed", range(6))
def test_dop853_agrees(seed):
    generator = np.random.default_rng(seed)
    exponent = [1.0, 1.5, 1.5, 2.2][seed % 4]
    contact = {"exponent": exponent, "stiffness": 1500.0 if exponent == 1.0 else 5e5}
    conveyor, times = random_conveyor(generator, **contact), np.linspace(0.0, DURATION, 201)
    start = Start(z=generator.uniform(2e-4, 1e-3))
    run = simulate(conveyor, start, duration=DURATION, tolerance=1e-13)
    assert run.impacts > 0
    sample, expected = run.sample(times), reference_states(conveyor, start, times)
    for name, values in expected.items():
        assert np.abs(sample[name] - values).max() < 1e-9 * np.abs(values).max()
    height, rise, _ = np.array([plate_at(conveyor, t) for t in times]).T
    depth = height - expected["z"]
    force = conveyor.stiffness * np.maximum(depth, 0.0) ** exponent + conveyor.damping * (rise - expected["vz"])
    force[depth < 0.0] = 0.0
    assert np.abs(sample["contact_force"] - force).max() < 1e-6 * np.abs(force).max()


@COMPILES
def test_runge_kutta_converges_to_a_part_that_rides():
    """With the orders of TWO, for which the steps are compiled in another test, too."""
    conveyor = Conveyor(acceleration=12.0, angle=0.2, psi0=2.0, inclination=0.05, phase_shift=0.7, harmonics=TWO)
    height, rise, _ = plate_at(conveyor, 0.0)
    start = Start(z=height - 6e-6, vz=rise)  # about as deep as at rest
    exact = simulate(conveyor, start, duration=0.02, tolerance=1e-13)
    assert exact.impacts == 0
    errors = [
        abs(simulate(conveyor, start, duration=0.02, method="rk4", step=step).vz_end - exact.vz_end)
        for step in (4e-6, 2e-6, 1e-6)
    ]
    assert errors[2] < 1e-9 * abs(exact.vz_end)
    assert errors[1] / errors[2] > 8.0 or errors[1] < 1e-13


def test_plate_moves_as_defined():
    """Velocities and accelerations are derivatives of the positions and velocities, which have no mean."""
    conveyor = random_conveyor(np.random.default_rng(7))
    times, h = np.arange(500) / 500 / conveyor.frequency, 1e-6
    plate, before, after = (plate_motion(conveyor, times + shift) for shift in (0.0, -h, h))
    expected = np.array([accelerations(conveyor, t) for t in times]).T
    for name, acceleration in zip("zx", expected, strict=True):
        assert np.allclose((after[name] - before[name]) / (2.0 * h), plate[f"v{name}"], atol=1e-6)
        assert np.allclose((after[f"v{name}"] - before[f"v{name}"]) / (2.0 * h), acceleration, atol=1e-3)
        assert abs(plate[name].mean()) < 1e-15 and abs(plate[f"v{name}"].mean()) < 1e-13
    assert plate_heights(parameter_table(conveyor, z0=[0.0]))[0] == pytest.approx(plate["z"][0], rel=1e-14)


@COMPILES
def test_a_table_may_hold_plates_with_and_without_harmonics():
    """Plates of one table have the same number of harmonics; those of a pure plate have no amplitude."""
    pure, harmonic = Conveyor(acceleration=45.0), Conveyor(acceleration=45.0, harmonics=[{"order": 2, "normal": 0.1}])
    table = parameter_table(harmonic, z0=[3e-4, 3e-4])
    table["harmonics"][1, 1:] = 0.0
    runs = sweep(table, duration=0.1, tolerance=1e-13)
    assert runs.mean_velocity[0] == simulate(harmonic, Start(z=3e-4), duration=0.1, tolerance=1e-13).mean_velocity()
    (alone,) = sweep(parameter_table(pure, z0=[3e-4]), duration=0.1, tolerance=1e-13).mean_velocity
    assert runs.mean_velocity[1] == pytest.approx(alone, rel=1e-11)


@st.composite
def harmonics(draw):
    orders = draw(st.lists(st.integers(2, 20), min_size=1, max_size=4, unique=True))
    share, phase = st.floats(0.0, 1.5), st.floats(-4.0, 4.0)
    return [Harmonic(order, draw(share), draw(phase), draw(share), draw(phase)) for order in orders]


@COMPILES
@settings(max_examples=80, deadline=None)
@given(
    waves=harmonics(),
    acceleration=st.floats(0.0, 150.0),
    angle=st.floats(0.0, 0.5 * math.pi),
    exponent=st.sampled_from([1.0, 1.5, 2.3]),
    tension=st.sampled_from(["allow", "frictionless", "clip"]),
    phase=st.floats(-3.0, 3.0),
    z=st.one_of(st.just("conveyor"), st.floats(-1e-5, 3e-3)),
    psi0=st.floats(0.0, 6.0),
)
def test_no_motion_fails(waves, acceleration, angle, exponent, tension, phase, z, psi0):
    """Every run ends well, never falls through the plate, and knows its largest gap."""
    stiffness = 1500.0 if exponent == 1.0 else 5e5
    conveyor = Conveyor(
        acceleration, angle, psi0=psi0, exponent=exponent, stiffness=stiffness, tension=tension, harmonics=waves
    )
    conveyor = Conveyor(**{name: getattr(conveyor, name) for name in conveyor.__slots__} | {"phase_shift": phase})
    run = simulate(conveyor, Start(z=z), duration=0.1)
    assert run.status == "ok"
    times = np.linspace(0.0, 0.1, 3001)
    sample, plate = run.sample(times), plate_motion(conveyor, times)
    assert all(np.isfinite(values).all() for values in sample.values())
    gap = sample["z"] - plate["z"]
    assert gap.max() <= run.max_gap + 1e-12
    assert (sample["contact_force"][gap > 1e-12] == 0.0).all()
    assert gap.min() > -3e-3


@COMPILES
def test_fixed_steps_approach_the_events():
    conveyor = Conveyor(acceleration=40.0, harmonics=TWO, phase_shift=0.3)
    exact = simulate(conveyor, Start(z=3e-4), duration=0.04, tolerance=1e-12)
    for method in ("euler", "semi_implicit_euler", "rk4"):
        errors = [
            abs(simulate(conveyor, Start(z=3e-4), duration=0.04, method=method, step=step).x_end - exact.x_end)
            for step in (4e-6, 1e-6, 2.5e-7)
        ]
        assert errors[2] < 3e-3 * abs(exact.x_end)
        assert errors[2] < 0.5 * errors[0]


@COMPILES
def test_transit_agrees_with_a_run():
    conveyor = Conveyor(acceleration=60.0, harmonics=TWO)
    found = transits(parameter_table(conveyor, z0=[3e-4]), np.array([0.03]), np.array([3.0]), begin=0.1)
    (arrival,) = found["arrival"][0]
    run = simulate(conveyor, Start(z=3e-4), duration=3.0)
    assert run.sample(np.array([arrival]))["x"][0] == pytest.approx(0.03, rel=2e-3)


@COMPILES
def test_linearisation_agrees_with_differences():
    conveyor = Conveyor(acceleration=40.0, harmonics=TWO)
    orbit = periodic_orbit(conveyor, Start(z=3e-4))
    assert orbit.period == 1 and orbit.impacts > 0
    parameters = pack(conveyor, Start())[None]
    _, matrices, features = stroboscopic_map.monodromy(parameters[0], 1e-12, orbit.state.copy(), 1, 0.0)
    damping = conveyor.damping / conveyor.mass
    assert np.linalg.det(matrices[0]) == pytest.approx(math.exp(-damping * features[0, 1]), rel=1e-8)
    assert np.prod(orbit.multipliers) == pytest.approx(np.linalg.det(matrices[0]), rel=1e-6)
    images = []
    for shift in ((1e-8, 0.0), (-1e-8, 0.0)):
        state = orbit.state + shift
        stroboscopic_map.follow_map(parameters[0], 1e-13, state, 1)
        images.append(state)
    difference = (images[0] - images[1]) / 2e-8
    assert np.allclose(difference, matrices[0][:, 0], rtol=1e-4)


@COMPILES
def test_labels_and_exponents():
    conveyor = Conveyor(harmonics=TWO)
    found = classify(parameter_table(conveyor, acceleration=[20.0, 40.0, 90.0], z0=3e-4))
    assert found.state.tolist() == ["first", "second", "chaos"]
    table = parameter_table(conveyor, acceleration=[40.0, 90.0], z0=3e-4)
    exponents = lyapunov_spectrum(table, transient=100, cycles=50, blocks=4)
    assert exponents.lambda_1[0] < 0.0 < exponents.lambda_1[1]
    total = -conveyor.damping / conveyor.mass * exponents.contact_fraction
    assert np.allclose(exponents.lambda_1 + exponents.lambda_2, total, rtol=1e-6)


@COMPILES
def test_known_attractors_give_the_labels_of_single_searches():
    rows = parameter_table(Conveyor(acceleration=40.0, harmonics=TWO), z0=np.linspace(0.0, 5e-4, 40))
    attractors = find_attractors(rows[:1], cycles=300)
    assert len(attractors.orbits.periods) >= 2
    found, alone = (classify(rows, cycles=300, tolerance=1e-8, **known) for known in ({"attractors": attractors}, {}))
    assert found.state.tolist() == alone.state.tolist()
    assert len(set(found.state)) == 2


def test_a_row_of_a_table_moves_the_plate_as_its_conveyor_does():
    conveyor = random_conveyor(np.random.default_rng(4), phase_shift=0.3, psi0=0.7)
    table, times = parameter_table(conveyor, acceleration=[conveyor.acceleration, 20.0]), np.linspace(0.0, 0.1, 7)
    for row in (table[0], table[:1], parameter_table(conveyor)):
        moved, expected = plate_motion(row, times), plate_motion(conveyor, times)
        assert all((moved[name] == expected[name]).all() for name in expected)
    with pytest.raises(ValueError, match=r"conveyor must be one row of a table, got the shape \(2,\)"):
        plate_motion(table, times)


def test_throw_number_is_the_largest_downward_acceleration():
    conveyor = random_conveyor(np.random.default_rng(3), inclination=0.1)
    times = np.linspace(0.0, 1.0 / conveyor.frequency, 20_001)
    fall = max(-accelerations(conveyor, t)[0] for t in times) / (conveyor.gravity * math.cos(0.1))
    model = {name: getattr(conveyor, name) for name in ("angle", "gravity", "inclination", "harmonics")}
    assert throw_number(conveyor.acceleration, **model) == pytest.approx(fall, rel=1e-6)


def test_packed_parameters_keep_harmonics():
    conveyor = random_conveyor(np.random.default_rng(5), static_friction=0.2)
    again, _ = conveyor_and_start(parameter_table(conveyor))
    assert [h.order for h in again.harmonics] == sorted(h.order for h in conveyor.harmonics)
    assert np.allclose(again.harmonics, conveyor.harmonics, rtol=1e-14)


@pytest.mark.parametrize(
    ("harmonic", "message"),
    [
        ({"order": 1}, "whole number from 2 to 100"),
        ({"order": 2.0}, "whole number"),
        ({"order": 2, "normal": -0.1}, "normal = -0.1"),
        ({"order": 2, "phase": 0.1}, "must have an order"),
        ({"normal": 0.1}, "must have an order"),
        ({"order": 2, "along": math.nan}, "along = nan"),
    ],
)
def test_bad_harmonics_are_refused(harmonic, message):
    with pytest.raises(ValueError, match=message):
        Conveyor(harmonics=[harmonic])


def test_orders_are_distinct():
    with pytest.raises(ValueError, match="each once"):
        Conveyor(harmonics=[{"order": 2}, {"order": 2, "normal": 0.1}])


def test_what_cannot_take_harmonics_says_so():
    parameters = parameter_table(Conveyor(harmonics=TWO))
    with pytest.raises(ValueError, match="no harmonics"):
        groups_of(parameters)


def test_peaks_of_the_plate_are_those_of_its_dense_motion():
    """The speed along the track; accelerations and displacements along the track and normal to it, combined."""
    generator = np.random.default_rng(5)
    for _ in range(5):
        conveyor = random_conveyor(generator)
        times = np.linspace(0.0, 1.0 / conveyor.frequency, 20_001)
        motion = plate_motion(conveyor, times)
        peaks = plate_peaks(parameter_table(conveyor, psi0=[0.0, 1.0]))
        assert peaks.vx == pytest.approx(np.abs(motion["vx"]).max(), rel=1e-6)
        displacement = math.hypot(np.abs(motion["x"]).max(), np.abs(motion["z"]).max())
        assert peaks.displacement == pytest.approx(displacement, rel=1e-6)
        pulled = np.array([accelerations(conveyor, t) for t in times[::10]])
        assert peaks.acceleration == pytest.approx(math.hypot(*np.abs(pulled).max(axis=0)), rel=1e-4)


def test_peaks_of_a_pure_plate_are_its_amplitudes():
    table = parameter_table(Conveyor(phase_shift=0.7), acceleration=[20.0, 50.0], frequency=[40.0, 60.0])
    peaks, omega = plate_peaks(table), 2.0 * math.pi * table["frequency"]
    assert (peaks.acceleration == table["acceleration"]).all()
    assert (peaks.displacement == table["acceleration"] / omega**2).all()
    assert peaks.vx == pytest.approx(table["acceleration"] * math.cos(Conveyor().angle) / omega, rel=1e-15)


def test_the_pull_keeps_its_direction_where_it_is_said_to():
    """Whatever two phases: between them, also through more than half a cycle, the pull has one sign."""
    c = contact.constants(pack(Conveyor(phase_shift=0.4), Start()), 1e-8)

    def pull(phase):
        return plate.pull_share(c, math.sin(phase), math.cos(phase))

    kept = 0
    for begin in np.linspace(0.0, 6.2, 40):
        for turn in np.linspace(0.05, 6.2, 60):
            if plate.keeps_direction(c, pull(begin), pull(begin + turn), turn):
                signs = np.sign([pull(begin + share * turn) for share in np.linspace(0.0, 1.0, 200)])
                assert abs(signs.sum()) == len(signs), (begin, turn)
                kept += 1
    assert kept > 100
