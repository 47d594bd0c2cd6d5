"""Neighbourhoods of attracting orbits: trajectories in them stay; and the conveyor of an initial condition."""

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.analysis.attractors import attractor_table, convergence, sampling, trapping_regions
from conveyor.analysis.attractors.search import find_attractors
from conveyor.solver import contact
from conveyor.solver.model import PARAMETERS, PSI0, pack
from conveyor.solver.pieces import BEGIN_OF_CYCLE

TOLERANCE = 1e-6


def conveyor_of(acceleration, **rest):
    row = pack(Conveyor(acceleration=acceleration, **rest), Start())
    row[PSI0] = 0.0
    return row


def inside(row, centre, factor, count):
    """Random states (δ, v) in a neighbourhood, half of them at its edge, shape (count, 2)."""
    generator = np.random.default_rng(1)
    damping = contact.constants(row, TOLERANCE).damping
    angle = generator.uniform(0.0, 2.0 * np.pi, count)
    size = np.where(np.arange(count) % 2 == 0, 1.0, np.sqrt(generator.uniform(0.0, 1.0, count)))
    across = size * np.sin(angle) / factor[2]
    delta = centre[0] + (size * np.cos(angle) - factor[1] * across) / factor[0]
    return np.column_stack([delta, centre[1] + across - damping * np.maximum(delta, 0.0)])


@pytest.fixture(scope="module", params=[(30.0, {}), (40.0, {}), (53.0, {}), (56.0, {}), (40.0, {"tension": "clip"})])
def found(request):
    acceleration, rest = request.param
    row = conveyor_of(acceleration, **rest)
    return row, find_attractors(row[None], cycles=500, tolerance=TOLERANCE).orbits


def share_that_ends_there(row, orbits, k, scale):
    """Share of the initial conditions in the enlarged neighbourhood of orbit k that lead to it."""
    starts = inside(row, orbits.centres[k], orbits.factors[k] / scale, 60)
    motions = sampling.follow(np.tile(row, (60, 1)), starts, 1000, TOLERANCE)
    same = (motions.outcomes == convergence.PERIODIC) & (motions.periods == orbits.periods[k])
    return np.mean(same & (np.abs(motions.flights - orbits.flights[k]) < 1e-8))


def test_trajectories_from_a_neighbourhood_converge_to_its_orbit(found):
    row, orbits = found
    assert len(orbits.periods) >= 2
    assert [share_that_ends_there(row, orbits, k, 1.0) for k in range(len(orbits.periods))] == [1.0] * len(
        orbits.periods
    )


def test_neighbourhoods_are_not_much_smaller_than_basins(found):
    row, orbits = found
    assert min(share_that_ends_there(row, orbits, k, 8.0) for k in range(len(orbits.periods))) < 1.0


def test_a_curve_far_outside_does_not_enter():
    row = conveyor_of(40.0)
    row[PSI0] = BEGIN_OF_CYCLE
    (motions,) = sampling.sample_conveyors(row[None], 400, TOLERANCE)
    k = int(np.argmax(motions.flights))
    (centre, factor), spent = trapping_regions.find_trapping_region(
        row, TOLERANCE, motions.states[k], 1, max_cycles=10**6
    )
    options = trapping_regions.PERIODS, np.zeros(1, dtype=np.bool_)
    assert trapping_regions.comes_inside(row, TOLERANCE, None, centre, factor, 1, 1.0, 0.9, *options)[0]
    assert not trapping_regions.comes_inside(row, TOLERANCE, None, centre, factor, 1, 4.0, 1.0, *options)[0]
    # Fewer cycles show only a smaller region.
    (_, smaller), less = trapping_regions.find_trapping_region(
        row, TOLERANCE, motions.states[k], 1, max_cycles=spent // 4
    )
    assert less < spent and smaller[0] > factor[0]


def test_an_orbit_that_does_not_attract_has_no_neighbourhood():
    """A part on an undamped spring oscillates without end."""
    row = conveyor_of(0.0, damping=0.0, exponent=1.0, stiffness=3e3)
    row[PSI0] = BEGIN_OF_CYCLE
    state = np.array([1.5 * 0.7e-3 * 9.81 / 3e3, 0.0])
    assert trapping_regions.find_trapping_region(row, TOLERANCE, state, 1, max_cycles=10**6)[0] is None


@pytest.mark.parametrize(
    ("norm_of", "stretch", "radii", "too_slow"),
    [
        (trapping_regions.contracting_norm, [[1.0, 20.0], [1.0, 1.0]], (0.0, 0.98), (0.999, 1.0, 2.0)),
        (trapping_regions.slow_norm, 1.0, (0.98, 0.9995), (1.0,)),
    ],
)
def test_norm_contracts_in_each_step(norm_of, stretch, radii, too_slow):
    generator = np.random.default_rng(1)
    for _ in range(200):
        matrix = generator.normal(size=(2, 2)) * stretch
        matrix *= generator.uniform(*radii) / np.abs(np.linalg.eigvals(matrix)).max()
        norm = norm_of(matrix)
        assert np.linalg.norm(norm @ matrix @ np.linalg.inv(norm), 2) < 1.0
        assert np.linalg.norm(np.linalg.inv(norm), 2) <= 1.0 + 1e-9
        for radius in too_slow:
            assert norm_of(matrix * radius / np.abs(np.linalg.eigvals(matrix)).max()) is None


SLOW_CONVEYOR = {
    "frequency": 60.0,
    "angle": 0.2634,
    "mass": 3.96e-3,
    "stiffness": 4.673e6,
    "damping": 2.03,
    "friction": 0.3226,
    "inclination": 0.01777,
    "tension": "clip",
}


@pytest.mark.long
def test_slow_orbits_have_neighbourhoods_in_which_motions_stay():
    """Next to its period doubling, an orbit attracts with the multiplier 0.999; it is approached from 400 cycles on."""
    row = conveyor_of(42.31691002563875, **SLOW_CONVEYOR)
    orbits = find_attractors(row[None], cycles=20_000, tolerance=TOLERANCE).orbits
    (slow,) = np.flatnonzero((orbits.periods == 2) & (orbits.flights * 60.0 < 1.0))
    starts = inside(row, orbits.centres[slow], orbits.factors[slow], 6)
    motions = sampling.follow(np.tile(row, (6, 1)), starts, 20_000, TOLERANCE)
    assert (motions.followed > 1000).all()
    assert (motions.periods == 2).all()
    np.testing.assert_allclose(motions.flights, orbits.flights[slow], rtol=1e-3)
    edge = sampling.sampled_initial_conditions(row)[1:2]
    assert sampling.follow(row[None], edge, 20_000, TOLERANCE).followed[0] > 10_000
    table = attractor_table.AttractorTable(orbits, attractor_table.NO_ATTRACTORS.chaotic)
    assert sampling.follow(row[None], edge, 20_000, TOLERANCE, table).followed[0] < 1500


def test_orbits_can_be_left_out():
    assert len(find_attractors(conveyor_of(40.0)[None], cycles=500, orbits=False).orbits.periods) == 0


def at_zero(rows):
    """Rows whose phases and initial conditions are zero."""
    changed = rows.copy()
    changed[:, [PARAMETERS.index(name) for name in ("psi0", "z0", "vz0")]] = 0.0
    return changed


def test_places_of_conveyors_in_any_order():
    generator = np.random.default_rng(1)
    of_each = np.array([conveyor_of(a) for a in (50.0, 30.0, 40.0)])
    index = generator.integers(0, 3, 40)
    rows = of_each[index]
    rows[:, PSI0] = generator.uniform(0.0, 6.0, 40)
    sorted_rows, numbers = attractor_table.distinct_rows(rows)
    assert sorted_rows[:, 0].tolist() == [30.0, 40.0, 50.0]
    np.testing.assert_array_equal(sorted_rows[numbers], at_zero(rows))
    table = attractor_table.NO_ATTRACTORS.orbits
    for _ in range(2):
        table = attractor_table.append_row(table, of_each[2], np.zeros(2), np.ones(3), 1, 0.0)
    places = attractor_table.find_places(np.concatenate([of_each[:1], table.conveyors]), sorted_rows)
    assert places.tolist() == [[0, 0], [1, 3], [0, 1]]
    places = attractor_table.AttractorTable(table, attractor_table.NO_ATTRACTORS.chaotic).rows_of(rows)
    assert [tuple(places[k]) for k in range(40)] == [{0: (0, 0), 1: (0, 0), 2: (0, 2)}[k] + (0, 0) for k in index]
    assert attractor_table.distinct_rows(rows[:0])[0].shape == (0, 16)


@pytest.mark.parametrize("name", [name for name in PARAMETERS if name not in ("psi0", "z0", "vz0")])
def test_conveyors_differ_if_any_parameter_differs(name):
    rows = np.tile(conveyor_of(40.0), (4, 1))
    rows[2:, PARAMETERS.index(name)] += 1.0
    sorted_rows, numbers = attractor_table.distinct_rows(rows)
    assert numbers.tolist() == [0, 0, 1, 1]
    np.testing.assert_array_equal(sorted_rows, at_zero(rows[::2]))
