"""Trajectories followed side by side: bit for bit equal to trajectories that are followed alone, for any neighbours."""

import os
import subprocess
import sys

import numpy as np
import pytest
from random_conveyors import for_lanes, on_map

from conveyor import Conveyor, Start
from conveyor.analysis.attractors import convergence, convergence_lanes, labels, search
from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS
from conveyor.solver.model import STIFFNESS, Z0, pack

TOLERANCE = 1e-7


def together(parameters, cycles, attractors=NO_ATTRACTORS):
    rows = attractors.rows_of(parameters)
    return convergence_lanes.follow_all_to_attractors(parameters, TOLERANCE, cycles, attractors, rows)


def one_by_one(parameters, cycles, attractors=NO_ATTRACTORS):
    """A single trajectory has no lane."""
    alone = [together(row[None], cycles, attractors) for row in parameters]
    return convergence.Trajectories(*map(np.concatenate, zip(*alone, strict=True)))


def assert_same(found, wanted, rows=slice(None)):
    for column, expected in zip(found, wanted, strict=True):
        np.testing.assert_array_equal(column[rows], expected[rows])


def test_bits_of_random_initial_conditions():
    parameters = for_lanes(60, seed=1)
    found = together(parameters, 150)
    assert_same(found, one_by_one(parameters, 150))
    assert {convergence.PERIODIC, convergence.NOT_CONVERGED} <= set(found.outcomes)


@pytest.mark.long
def test_bits_of_plates_with_harmonics():
    """Conveyors with two harmonics of different orders; some contacts are not for lanes."""
    rng = np.random.default_rng(5)
    waves = [
        [{"order": int(k), "normal": 0.1, "along": rng.uniform(0.0, 0.2)}, {"order": 7, "along": 0.1}]
        for k in rng.integers(2, 7, 30)
    ]
    contacts = [{}, {}, {"exponent": 1.0}, {"phase_shift": 0.3}, {"tension": "clip"}] * 6
    parameters = np.array(
        [
            pack(Conveyor(acceleration=rng.uniform(20.0, 80.0), harmonics=wave, **contact), Start(z=3e-4))
            for wave, contact in zip(waves, contacts, strict=True)
        ]
    )
    found = together(parameters, 150)
    assert_same(found, one_by_one(parameters, 150))
    assert {convergence.PERIODIC, convergence.NOT_CONVERGED} <= set(found.outcomes)


@pytest.mark.parametrize("acceleration", [40.0, 50.5, 53.0, 80.0])
def test_bits_of_maps_with_known_attractors(acceleration):
    parameters = on_map(acceleration, 40)
    attractors = search.find_attractors(parameters, cycles=4000, tolerance=TOLERANCE)
    assert len(attractors.orbits.periods) + len(attractors.chaotic.low) > 0
    assert_same(together(parameters, 4000, attractors), one_by_one(parameters, 4000, attractors))


@pytest.mark.parametrize("count", [0, 1, 2, 3, 7, 8, 9, 17])
def test_trajectories_may_be_fewer_than_lanes_and_in_any_order(monkeypatch, count):
    parameters = on_map(53.0, 17)[:count]
    wanted = one_by_one(on_map(53.0, 17), 300)
    monkeypatch.setattr(convergence_lanes, "SIDE_BY_SIDE", 1)
    found = together(parameters, 300)
    backwards = together(parameters[::-1].copy(), 300)
    assert_same([column[::-1] for column in backwards], found)
    assert_same(found, [column[:count] for column in wanted])


@pytest.mark.parametrize("side_by_side", [4, 1000])
def test_strobes_are_the_states_after_the_first_cycles(monkeypatch, side_by_side):
    """At 56 m/s² some trajectories settle soon; later strobes stay unchanged."""
    monkeypatch.setattr(convergence_lanes, "SIDE_BY_SIDE", side_by_side)
    parameters = on_map(56.0, 10)
    parameters[3] = for_lanes(8, seed=3)[7]  # not for lanes
    strobes, rows = np.full((10, 70, 2), np.nan), NO_ATTRACTORS.rows_of(parameters)
    found = convergence_lanes.follow_all_to_attractors(parameters, TOLERANCE, 90, NO_ATTRACTORS, rows, strobes)
    followed = found.followed
    assert followed.min() < 70 < followed.max()
    for k in range(10):
        assert np.isnan(strobes[k, followed[k] :]).all()
        for cycles in (1, 2, 40, 70):
            if cycles <= followed[k]:
                shorter = one_by_one(parameters[k : k + 1], cycles)
                np.testing.assert_array_equal(strobes[k, cycles - 1], shorter.states[0])


def test_failures_keep_their_row_and_disturb_nobody():
    calm = on_map(40.0, 24)
    parameters = calm.copy()
    parameters[[0, 5, 23], 0] = np.nan
    parameters[7, STIFFNESS] = np.inf
    parameters[8, STIFFNESS] = 1e300
    parameters[9, Z0] = np.inf
    bad = [0, 5, 7, 8, 9, 23]
    good = np.setdiff1d(np.arange(24), bad)
    found, alone = together(parameters, 200), one_by_one(parameters, 200)
    assert_same(found, alone)
    assert_same(found, one_by_one(calm, 200), good)
    with pytest.raises(ValueError, match=r"parameters\[0\]: acceleration = nan is outside"):
        labels.classify(parameters, cycles=200, tolerance=TOLERANCE)


def test_a_contact_too_stiff_to_be_followed_ends():
    """A heavily damped contact takes too many steps in a cycle: its trajectory fails, in a lane and alone."""
    parameters = on_map(40.0, 8)
    parameters[3] = pack(Conveyor(damping=1e6, stiffness=1e15), Start())
    found = together(parameters, 50)
    assert np.flatnonzero(found.outcomes == convergence.FAILED).tolist() == [3]
    assert (found.periods[3], found.followed[3]) == (0, 0)
    assert np.isnan([*found.states[3], found.flights[3]]).all()
    assert_same(found, one_by_one(parameters, 50))
    found, found_labels = together(parameters, 200), labels.classify(parameters, cycles=200, tolerance=TOLERANCE)
    assert found_labels.state[3] == "undecided"
    assert set(np.delete(found_labels.state, 3)) <= {"first", "second"}
    assert_same([found_labels.period, found_labels.cycles], [found.periods, found.followed])


@pytest.mark.parametrize("threads", [1, 2])
def test_labels_do_not_depend_on_threads_or_chunks(threads, monkeypatch):
    parameters = np.concatenate([for_lanes(70, seed=2), on_map(80.0, 30)])
    monkeypatch.setattr(convergence_lanes, "SIDE_BY_SIDE", 1000)
    wanted = labels.classify(parameters, cycles=300, tolerance=TOLERANCE)
    monkeypatch.undo()
    for length in (16, 64, 2048):
        monkeypatch.setattr(labels, "TOGETHER", length)
        found = labels.classify(parameters, cycles=300, tolerance=TOLERANCE, threads=threads)
        assert_same(found.values(), wanted.values())


# Says what it has to compile: all that no cache holds, and at last a function that is in none.
LABELS = """
import numba
import numpy as np
from numba.core import event

compiled = []
event.register("numba:compile", type("Listener", (event.Listener,), {
    "on_start": lambda self, told: compiled.append(told.data["dispatcher"].py_func.__qualname__),
    "on_end": lambda self, told: None,
})())

from conveyor import Conveyor, Start
from conveyor.analysis.attractors import labels
from conveyor.solver.model import pack

labels.classify(np.array([pack(Conveyor(), Start(1e-6 * k)) for k in range(8)]), cycles=3)
numba.njit(lambda x: x)(1.0)
print(*compiled)
"""


@pytest.mark.long
def test_a_process_finds_what_another_one_compiled():
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    for _ in range(2):
        run = subprocess.run(
            [sys.executable, "-c", LABELS], env=environment, check=True, capture_output=True, text=True
        )
    assert run.stdout.split() == ["<lambda>"]


@pytest.mark.parametrize("follow", [one_by_one, together])
def test_a_flight_counts_from_the_first_whole_cycle(follow):
    """Parts that fall for five cycles and begin in the middle of one, followed for three whole cycles."""
    conveyor = Conveyor(psi0=0.0)
    found = follow(np.repeat(pack(conveyor, Start(z=0.05))[None], convergence_lanes.SIDE_BY_SIDE, axis=0), 3)
    assert found.outcomes.tolist() == [convergence.NOT_CONVERGED] * convergence_lanes.SIDE_BY_SIDE
    assert found.flights == pytest.approx(3.0 / conveyor.frequency)
