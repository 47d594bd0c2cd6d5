"""Periodic orbits: multipliers compared with a trace identity and finite differences, bifurcations with iteration."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start, classify, continue_orbit, parameter_table, periodic_orbit, simulate
from conveyor.analysis import stroboscopic_map
from conveyor.analysis.bifurcations import continuation, doubling_cascade, periodic_orbits
from conveyor.packing import as_table
from conveyor.solver.model import pack

CONVEYOR = Conveyor()
PARAMETERS = pack(CONVEYOR, Start())
DECAY = CONVEYOR.damping / CONVEYOR.mass


def settled(acceleration, z0, max_period=4, cycles=800):
    row = pack(Conveyor(acceleration=acceleration), Start(z0))
    state = stroboscopic_map.initial_states(row[None], periodic_orbits.ORBIT_TOLERANCE)[0]
    return periodic_orbits.settled_orbit(row, state, range(1, max_period + 1), cycles)


@pytest.fixture(scope="module")
def jumping():
    return settled(40.0, 3e-4)


@pytest.fixture(scope="module")
def branch(jumping):
    return continuation.follow_branch(jumping, "acceleration", (23.0, 64.0))


def test_orbit_repeats_itself(jumping):
    state = jumping.state.copy()
    _, strobes = stroboscopic_map.follow_map(pack(Conveyor(), Start()), periodic_orbits.ORBIT_TOLERANCE, state, 5)
    assert strobes == pytest.approx(np.tile(jumping.state, (5, 1)), rel=1e-8)
    assert jumping.stable
    assert jumping.period == 1


@pytest.mark.parametrize(
    ("acceleration", "z0", "period"), [(25.0, 0.0, 1), (40.0, 3e-4, 1), (58.0, 3e-4, 2), (62.0, 3e-4, 4)]
)
def test_known_periods(acceleration, z0, period):
    assert settled(acceleration, z0, cycles=2000).period == period


def test_product_of_multipliers_follows_from_the_time_in_contact(branch):
    determinants = np.array([orbit.determinant for orbit in branch.orbits])
    wanted = np.exp([-DECAY * orbit.contact_time for orbit in branch.orbits])
    assert determinants == pytest.approx(wanted, abs=1e-9)
    products = [math.prod(orbit.multipliers).real for orbit in branch.orbits]
    assert products == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("parameter", ["acceleration", "damping", "frequency", "exponent"])
def test_an_orbit_comes_back_to_its_unknowns(jumping, parameter):
    returns = periodic_orbits.ReturnMap(PARAMETERS, 3, parameter)
    unknown = returns.unknown(jumping)
    assert unknown[2] * returns.unit[2] == pytest.approx(getattr(CONVEYOR, parameter), rel=1e-15)
    assert returns.strobes(unknown) == pytest.approx(np.tile(unknown, (3, 1)), rel=1e-8)


def test_tests_of_bifurcations_are_determinants(branch):
    """det(M - 1) = (1 - μ1)(1 - μ2) and det(M + 1) = (1 + μ1)(1 + μ2), with real multipliers and with complex ones."""
    returns = periodic_orbits.ReturnMap(PARAMETERS, 1)
    kinds = set()
    for orbit in branch.orbits[::10]:
        less_one = returns.residual(returns.scaled(orbit.acceleration, orbit.state))[1]
        assert continuation.multiplier_test(orbit, 1.0) == pytest.approx(np.linalg.det(less_one), abs=1e-6)
        assert continuation.multiplier_test(orbit, -1.0) == pytest.approx(
            np.linalg.det(less_one + 2.0 * np.eye(2)), abs=1e-6
        )
        kinds.add(orbit.multipliers[0].imag == 0.0)
    assert kinds == {True, False}


def test_jumping_exists_down_to_its_fold(branch):
    """Below the fold, a part that jumps just above it settles to riding; at the fold a multiplier is +1."""
    fold = next(b for b in branch.bifurcations if b.kind == "fold")
    assert fold.multiplier == pytest.approx(1.0, abs=1e-6)
    stable = [orbit for orbit in branch.orbits if orbit.stable]
    near = min(stable, key=lambda orbit: abs(orbit.acceleration - fold.orbit.acceleration - 0.05))
    for change, jumps in ((0.05, True), (-0.05, False)):
        state = near.state.copy()
        row = pack(Conveyor(acceleration=fold.orbit.acceleration + change), Start())
        stroboscopic_map.follow_map(row, 1e-11, state, 4000)
        _, _, features = stroboscopic_map.monodromy(row, 1e-11, state, 1, 0.0)
        assert (features[0, stroboscopic_map.IMPACTS] > 0) == jumps


def test_a_branch_is_followed_around_its_turns(monkeypatch):
    """A closed branch, a circle half as large as the largest step: chords between its points stay within 2 % of it."""
    radius = 0.5 * continuation.LARGEST_STEP

    class Circle(periodic_orbits.ReturnMap):
        def residual(self, unknown):
            x, y, a = unknown
            return np.array([x * x + (a - 1.0) ** 2 - radius**2, y]), np.diag([2.0 * x, 1.0])

        def slope(self, unknown):
            return np.array([2.0 * (unknown[2] - 1.0), 0.0])

        def strobes(self, unknown):
            return unknown[None]

        def describe(self, unknown):
            row = as_table(self.row(unknown[2]))
            return periodic_orbits.Orbit(row, self.state(unknown), 1, (0.5 + 0j, 0.1 + 0j), 0.05, 1, 0.0, 0.5)

    monkeypatch.setattr(continuation, "ReturnMap", Circle)
    circle = Circle(PARAMETERS, 1)
    found = continuation.follow_branch(circle.describe(np.array([radius, 0.0, 1.0])), "acceleration", (0.0, 2.0))
    assert found.ends == ("closed", "closed")
    points = np.array([circle.scaled(orbit.acceleration, orbit.state) for orbit in found.orbits]) - [0.0, 0.0, 1.0]
    assert np.linalg.norm(points, axis=1) == pytest.approx(radius, rel=1e-6)
    middles = 0.5 * (points[1:] + points[:-1])
    assert np.linalg.norm(middles, axis=1).min() > 0.98 * radius


def test_period_doubling_agrees_with_iteration(branch):
    doubling = next(b for b in branch.bifurcations if b.kind == "period_doubling")
    assert doubling.multiplier == pytest.approx(-1.0, abs=1e-6)
    for change, period in ((-0.05, 1), (0.05, 2)):
        assert settled(doubling.orbit.acceleration + change, 3e-4, cycles=6000).period == period


def test_doubled_orbit_has_twice_the_period(branch):
    doubling = next(b for b in branch.bifurcations if b.kind == "period_doubling")
    double = continuation.find_doubled_orbit(doubling)
    assert double.period == 2
    returns = periodic_orbits.ReturnMap(PARAMETERS, 2)
    first, second = returns.strobes(returns.scaled(double.acceleration, double.state))
    assert np.abs(first - second).max() > 1e-3


def test_feigenbaum_of_a_geometric_sequence():
    amplitudes = 10.0 - 3.0 * doubling_cascade.FEIGENBAUM ** -np.arange(6.0)
    assert doubling_cascade.doubling_ratios(amplitudes) == pytest.approx(np.full(4, doubling_cascade.FEIGENBAUM))
    limit, error = doubling_cascade.accumulation_point(amplitudes)
    assert limit == pytest.approx(10.0)
    assert error < 1e-12


def test_error_of_the_accumulation_is_the_change_due_to_the_last_doubling():
    amplitudes = np.array([0.0, 1.0, 1.25, 1.3, 1.312])
    limit, error = doubling_cascade.accumulation_point(amplitudes)
    before, _ = doubling_cascade.accumulation_point(amplitudes[:-1])
    assert limit == pytest.approx(1.25 + 0.05**2 / (0.05 - 0.012))  # Aitken's process by hand
    assert error == pytest.approx(abs(limit - before))


def test_doublings_whose_distances_do_not_shrink_have_no_accumulation():
    for amplitudes in (np.array([0.0, 1.0, 3.0, 7.0, 15.0]), np.arange(5.0), np.ones(4), np.array([0.0, 1.0, 1.2])):
        assert all(math.isnan(value) for value in doubling_cascade.accumulation_point(amplitudes))


def test_no_orbit_is_found_without_one():
    assert settled(80.0, 0.0) is None


def test_a_grazing_has_its_larger_multiplier():
    """At 47.18 m/s² a micro-bounce begins on the branch of the riding part."""
    riding = settled(46.0, 0.0)
    found = continuation.follow_branch(riding, "acceleration", (45.0, 48.5)).bifurcations
    grazings = [one for one in found if one.kind == "grazing"]
    assert grazings
    for one in grazings:
        assert abs(one.multiplier) == pytest.approx(max(abs(value.real) for value in one.orbit.multipliers))
        assert abs(one.orbit.multipliers[0] - one.orbit.multipliers[1]) > 1e-3


@pytest.mark.parametrize(("acceleration", "period"), [(40.0, 1), (57.0, 2)])
def test_the_longest_flight_does_not_depend_on_the_phase_at_which_the_period_begins(acceleration, period):
    """In the first case the part flies whenever it does not touch: it has one impact per cycle."""
    conveyor, start = Conveyor(acceleration=acceleration), Start(3e-4)
    labelled = classify(parameter_table(conveyor, start)).longest_flight
    run = simulate(conveyor, start, duration=5.0)
    found = []
    for time in np.linspace(4.9, 4.92, 6):
        (z,), (vz,) = (run.sample(np.array([time]))[name] for name in ("z", "vz"))
        later = Conveyor(acceleration=acceleration, psi0=float(2.0 * np.pi * (50.0 * time % 1.0)))
        orbit = periodic_orbit(later, Start(z, vz), period=period, transient=0)
        found.append(orbit.longest_flight)
        assert period > 1 or orbit.longest_flight == pytest.approx(1.0 - 50.0 * orbit.contact_time, abs=1e-9)
    assert found == pytest.approx(len(found) * [float(labelled)], abs=1e-6)


def test_a_jump_of_the_multipliers_at_a_grazing_is_no_fold():
    """Without tension, the multipliers of this jumping motion jump past 1 and -1 where an impact begins."""
    contact = {"angle": 0.5, "mass": 1e-3, "stiffness": 5939725.0, "damping": 2.51, "tension": "clip"}
    conveyor = Conveyor(acceleration=31.0, **contact)
    found = continue_orbit(periodic_orbit(conveyor, Start(3e-3)), "acceleration", (1.0, 100.0)).bifurcations
    assert [one.kind for one in found if one.kind == "grazing"] == ["grazing"]
    for one in found:
        if one.kind != "grazing":
            assert abs(abs(one.multiplier) - 1.0) < 1e-6


def test_the_period_of_an_orbit_is_its_least_one():
    orbit = periodic_orbit(Conveyor(acceleration=57.0), Start(3e-4), period=8)
    assert orbit.period == 2
    assert orbit.multipliers == pytest.approx(
        periodic_orbit(Conveyor(acceleration=57.0), Start(3e-4), period=2).multipliers
    )


@pytest.fixture(scope="module")
def doubling():
    begin = periodic_orbit(Conveyor(acceleration=53.9), Start(3e-4))
    return continue_orbit(begin, "acceleration", (53.5, 54.5)).bifurcations[0]


@pytest.mark.parametrize("parameter", ["angle", "damping", "frequency", "stiffness", "mass", "gravity", "exponent"])
def test_a_branch_in_any_parameter_meets_the_bifurcations_of_the_amplitude(parameter, doubling):
    """The orbit doubles its period at one amplitude; the branch in the parameter comes back to its value there."""
    value = doubling.orbit.value(parameter)
    for change in (0.99, 1.01):
        moved = Conveyor(acceleration=doubling.orbit.acceleration, **{parameter: change * value})
        orbit = periodic_orbit(moved, doubling.orbit.state, transient=0)
        limits = sorted((orbit.value(parameter), (2.0 - change) * value))
        found = continue_orbit(orbit, parameter, limits)
        (same,) = (one for one in found.bifurcations if one.kind == "period_doubling")
        assert same.orbit.value(parameter) == pytest.approx(value, rel=1e-9)
        assert found.columns[parameter][0] == pytest.approx(limits[0], rel=3e-3)


def test_orbits_and_branches_are_short_in_a_notebook(branch):
    assert len(repr(branch)) < 1000
    assert repr(branch.orbits[0]).startswith("Orbit(64.")  # the fold turns the branch back


@pytest.mark.parametrize("conveyor", [{"damping": 10.0}, {"mass": 1e-5}])
def test_the_product_of_multipliers_is_not_rounding_where_damping_is_strong(conveyor):
    conveyor = Conveyor(acceleration=20.0, **conveyor)
    orbit = periodic_orbit(conveyor, Start())
    expected = -conveyor.damping / conveyor.mass * orbit.contact_time
    assert math.log(orbit.determinant) == pytest.approx(expected, rel=1e-6)


def test_a_branch_in_the_inclination_may_begin_at_a_track_that_is_nearly_level():
    orbit = periodic_orbit(Conveyor(acceleration=40.0, inclination=1e-3), Start(z=3e-4))
    branch = continue_orbit(orbit, "inclination", (-0.05, 0.05))
    assert branch.ends == ("limit", "limit") and len(branch.orbits) < 200
    assert "ends" not in repr(branch)
    assert "; ends: step and limit" in repr(branch._replace(ends=("step", "limit")))
