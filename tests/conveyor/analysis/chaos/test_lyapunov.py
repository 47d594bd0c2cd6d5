"""Lyapunov exponents: the trace identity, an independent pair of trajectories, known limits, and riding parts."""

import tracemalloc

import numpy as np
import pytest

from conveyor import Columns, Conveyor, Start
from conveyor.analysis import stroboscopic_map
from conveyor.analysis.bifurcations import periodic_orbits
from conveyor.analysis.chaos import lyapunov
from conveyor.solver import contact
from conveyor.solver.model import FREQUENCY, pack

DECAY = Conveyor().damping / Conveyor().mass


def points(*pairs, **model):
    return np.array([pack(Conveyor(acceleration=a, **model), Start(z0)) for a, z0 in pairs])


PAIRS = ((25.0, 0.0), (40.0, 0.0), (40.0, 3e-4), (47.0, 0.0), (62.0, 0.0), (80.0, 0.0))


@pytest.mark.parametrize("tension", ["allow", "frictionless", "clip"])
def test_sum_of_exponents_follows_from_the_time_in_contact(tension):
    found = lyapunov.lyapunov_spectrum(points(*PAIRS, tension=tension), cycles=50, tolerance=1e-12)
    assert found.lambda_1 + found.lambda_2 == pytest.approx(-DECAY * found.contact_fraction, abs=1e-8)
    # Both moduli of a complex pair are equal, and any of them may come out as the larger one in a finite run.
    assert (found.lambda_1 >= found.lambda_2 - 0.5).all()


@pytest.mark.parametrize("conveyor", [{"damping": 20.0}, {"damping": 3.0}, {"mass": 1e-5}])
@pytest.mark.parametrize("acceleration", [20.0, 80.0])
def test_the_smaller_exponent_is_not_rounding_where_damping_is_strong(conveyor, acceleration):
    """Within a cycle, one perturbation becomes smaller than the rounding errors of the other one."""
    rows = points((acceleration, 3e-4), **conveyor)
    decay = Conveyor(**conveyor).damping / Conveyor(**conveyor).mass
    for found in (
        lyapunov.lyapunov_spectrum(rows, cycles=10, blocks=4, transient=20),
        lyapunov.lyapunov_spectrum_on_attractors(rows, cycles=10, blocks=4),
    ):
        assert found.status.tolist() == ["ok"]
        assert found.lambda_1 + found.lambda_2 == pytest.approx(-decay * found.contact_fraction, rel=1e-6)


def renormalised_exponent(row, state, transient=300, cycles=4000, distance=1e-9):
    """Largest exponent (1/s) from a neighbour set back to a distance after each cycle (Benettin et al. 1976)."""
    c = contact.constants(row, 1e-12)
    scale = np.array([c.scale_w**2, c.scale_v])
    here, total = np.array(state), 0.0
    there = here + distance * scale / np.sqrt(2.0)
    for n in range(transient + cycles):
        stroboscopic_map.follow_map(row, 1e-12, here, 1)
        stroboscopic_map.follow_map(row, 1e-12, there, 1)
        separation = (there - here) / scale
        stretch = np.hypot(*separation) / distance
        there = here + separation / stretch * scale
        total += np.log(stretch) if n >= transient else 0.0
    return total / (cycles * c.period)


def test_chaos_regular_motion_and_a_pair_of_trajectories():
    """Comparison with two trajectories whose distance is reset in each cycle, without variational equations."""
    rows = points((62.0, 0.0), (80.0, 0.0))
    found = lyapunov.lyapunov_spectrum(rows, transient=300, cycles=200)
    states = stroboscopic_map.initial_states(rows, 1e-12)
    pair = [renormalised_exponent(row, state) for row, state in zip(rows, states, strict=True)]
    assert pair[0] == pytest.approx(found.lambda_1[0], abs=0.2)
    assert abs(pair[1] - found.lambda_1[1]) < 5.0 * found.stderr[1]
    assert found.lambda_1[0] < 0.0 < found.lambda_1[1]


def test_signs(monkeypatch):
    """Signs for chaos, a settled motion, an undamped oscillation (zero), and a motion that cannot be followed."""
    spring = Conveyor(acceleration=0.0, damping=0.0, exponent=1.0, stiffness=3e3)
    rest = spring.mass * spring.gravity / spring.stiffness
    rows = np.array([*points((80.0, 0.0), (40.0, 3e-4)), pack(spring, Start()), pack(spring, Start())])
    states = np.array([[-1e-4, -0.05], [-1e-4, -0.05], [0.5 * rest, 0.0], [np.nan, 0.0]])
    assert lyapunov.signs(rows, states, tolerance=1e-8, threads=2).tolist() == [1, -1, 0, 0]
    looks, spectrum = [], lyapunov.spectrum_from

    def seen(parameters, states, cycles, **options):
        """Weak chaos, which the first estimate does not show, and a part that leaves the regular motion."""
        looks.append((cycles, len(parameters)))
        found = spectrum(parameters, states, cycles, **options)
        values = [1.0, -10.0, 10.0] if len(looks) == 1 else [10.0, 10.0]
        return Columns({**found, "lambda_1": np.array(values), "stderr": np.ones(len(values))})

    monkeypatch.setattr(lyapunov, "spectrum_from", seen)
    assert lyapunov.signs(rows[:3], states[:3], tolerance=1e-8).tolist() == [1, 1, 1]
    assert looks == [(400, 3), (2000, 2)]


def test_rider_is_a_damped_oscillator():
    """A part on a plate at rest: both exponents have the real part -d_c/(2m), whatever the stiffness."""
    rows = points((0.0, 0.0), exponent=1.0, stiffness=1e4)
    found = lyapunov.lyapunov_spectrum(rows, transient=20, cycles=100, tolerance=1e-13)
    assert found.lambda_1 == pytest.approx(-0.5 * DECAY, abs=1.0)
    assert found.lambda_1 + found.lambda_2 == pytest.approx(-DECAY, abs=1e-7)


def test_periodic_motions_have_the_exponents_of_their_multipliers():
    """Against Newton's orbit, and chaos bit for bit as it is followed. Riding, d_c/(2m) is lost in either direction."""
    rows = points((25.0, 0.0), (40.0, 3e-4), (62.0, 0.0), (80.0, 0.0))
    begun, periods = rows.copy(), (1, 1, 4)
    wanted = []
    for row, period in zip(begun, periods, strict=False):
        start = stroboscopic_map.initial_states(row[None], 1e-12)[0]
        orbit = periodic_orbits.settled_orbit(row, start, (period,), 400)
        row[:] = stroboscopic_map.pack_states(row[None], orbit.state[None], 1e-12)
        wanted.append(np.log(np.abs(orbit.multipliers)) * row[FREQUENCY] / period)
    options = {"cycles": 20, "blocks": 5, "tolerance": 1e-12}
    found = lyapunov.lyapunov_spectrum_on_attractors(begun, **options, threads=2)
    assert np.column_stack([found.lambda_1, found.lambda_2])[:3] == pytest.approx(np.array(wanted), rel=1e-6)
    assert found.lambda_1[0] == found.lambda_2[0] == pytest.approx(-0.5 * DECAY, rel=1e-9)
    assert found.lambda_1 + found.lambda_2 == pytest.approx(-DECAY * found.contact_fraction, abs=1e-8)
    assert (found.stderr[:3] == 0.0).all()
    followed = lyapunov.lyapunov_spectrum(begun, transient=0, **options)
    assert [column[3] for column in found.values()] == [column[3] for column in followed.values()]
    assert followed.stderr[3] > 0.0
    # Without any trajectory.
    assert (lyapunov.lyapunov_spectrum_on_attractors(begun[:3], **options).lambda_1 == found.lambda_1[:3]).all()
    # The length of a rotating perturbation depends on its direction at the end of a run.
    assert found.lambda_1[:3] == pytest.approx(followed.lambda_1[:3], abs=5.0)


@pytest.mark.parametrize(("noise", "period"), [(0.0, 3), (3e-14, 3), (1e-12, 0)])
def test_a_motion_repeats_itself_but_for_rounding(noise, period):
    """In units of g/ω² and g/ω."""
    unit = np.array([1e-4, 0.03])
    strobes = np.tile([[0.2, 0.0], [0.4, -1.0], [0.1, 1.0]], (100, 1)) * unit
    strobes += noise * unit * np.random.default_rng(1).uniform(-0.5, 0.5, strobes.shape)
    assert lyapunov.find_period(strobes, unit) == period
    strobes[-50] += 1e-6 * unit
    assert lyapunov.find_period(strobes, unit) == (period if noise == 0.0 else 0)


def test_standard_error_shrinks_with_the_run():
    rows = points((80.0, 0.0))
    errors = [lyapunov.lyapunov_spectrum(rows, cycles=cycles).stderr[0] for cycles in (20, 320)]
    assert 2.0 < errors[0] / errors[1] < 8.0  # 4 for independent blocks


def test_exponents_do_not_depend_on_threads():
    one, two = (lyapunov.lyapunov_spectrum(points(*PAIRS), cycles=10, threads=threads) for threads in (1, 2))
    assert all((one[name] == two[name]).all() for name in one)


def test_memory_does_not_grow_with_the_cycles_of_all_rows():
    """Motions that fail at once, so that the test is fast."""
    rows = np.tile(points((40.0, 0.0)), (100, 1))
    tracemalloc.start()
    found = lyapunov.lyapunov_spectrum(rows, np.full((100, 2), np.nan), transient=0, cycles=200, blocks=20)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert "ok" not in found.status
    assert peak < 2e6  # bytes; all cycles of all rows are 10 MB


def test_settings_are_checked():
    with pytest.raises(ValueError, match="blocks = 1 must be a whole number from 2"):
        lyapunov.lyapunov_spectrum(points((40.0, 0.0)), blocks=1)
