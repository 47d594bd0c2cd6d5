"""States of motion and attractors: known labels, which do not depend on how runs are divided."""

import time

import numpy as np
import pytest
from tqdm import tqdm

from conveyor import Conveyor, Start, ensemble, initial_states, parameter_table, start_at
from conveyor.analysis import stroboscopic_map
from conveyor.analysis.attractors import attractor_table, chaotic_sets, convergence, labels, sampling, search
from conveyor.analysis.bifurcations import bifurcation_diagram
from conveyor.solver.model import PSI0, VZ0, Z0, pack
from conveyor_pipeline.common import grid

KNOWN = {
    (30.0, 0.0): ("first", 1),
    (40.0, 0.0): ("first", 1),
    (40.0, 3e-4): ("second", 1),
    (57.0, 3e-4): ("second", 2),
    (62.0, 3e-4): ("second", 4),
    (71.0, 0.0): ("second", 3),
    (80.0, 0.0): ("chaos", 0),
}


def points():
    return parameter_table(Conveyor(), acceleration=[a for a, _ in KNOWN], z0=[z0 for _, z0 in KNOWN])


@pytest.mark.parametrize("threads", [1, 2])
def test_known_states(threads):
    found = labels.classify(points(), threads=threads)
    assert list(zip(found.state, found.period, strict=True)) == list(KNOWN.values())


def test_state_does_not_depend_on_when_the_run_is_cut():
    for duration in (0.013, 0.2, 1.0):
        runs = ensemble.sweep(points(), duration=duration)
        later = ensemble.restart(points(), runs["z_end"], runs["vz_end"], duration)
        assert list(labels.classify(later).state) == [state for state, _ in KNOWN.values()]


def test_a_run_continues_in_a_copy():
    true = points()
    runs = ensemble.sweep(true, duration=0.013)
    later = ensemble.restart(true, runs["z_end"], runs["vz_end"], 0.013)
    assert (true == points()).all()
    assert (later != true).all()


def test_slow_transients_are_followed():
    """Just above the doubling a period of two is approached very slowly; it is neither chaos nor undecided."""
    found = labels.classify(parameter_table(Conveyor(acceleration=54.25), Start(3e-4)))
    assert (found.state, found.period) == ("second", 2)


def test_part_that_cannot_be_followed_is_undecided():
    row = pack(Conveyor(), Start())
    row[[Z0, VZ0]] = np.nan
    assert labels.classify(row[None]).state[0] == "undecided"


def test_an_exponent_of_zero_gives_no_state():
    """A part that rides on an undamped spring oscillates without end, with exponents of zero: unsettled, not chaos."""
    conveyor = Conveyor(acceleration=0.0, damping=0.0, exponent=1.0, stiffness=3e3)
    depth = conveyor.mass * conveyor.gravity / conveyor.stiffness  # at rest
    found = labels.classify(np.array([pack(conveyor, Start(z=-share * depth)) for share in (0.5, 0.9)]), cycles=400)
    assert list(found.state) == ["undecided"] * 2
    assert (found.cycles == 400).all()
    assert np.isnan(found.longest_flight).all()


def test_sweep_keeps_to_its_attractor():
    """Up from rest the part rides beyond 45 m/s², down from jumping it jumps below: hysteresis."""
    for amplitudes, z0, state in (
        (np.linspace(38.0, 45.0, 15), 0.0, "first"),
        (np.linspace(45.0, 38.0, 15), 3e-4, "second"),
    ):
        model = {"z0": z0}
        _, parameters = grid.product({"acceleration": list(amplitudes)}, model)
        diagram = bifurcation_diagram.bifurcation_diagram(parameters, transient=300, strobes=4, tolerance=1e-10)
        assert (diagram.status == "ok").all()
        assert np.ptp([diagram.delta, diagram.v], axis=2) == pytest.approx(0.0, abs=1e-7)
        last = np.column_stack([diagram.delta[:, -1], diagram.v[:, -1]])
        starts = start_at(parameters, last)
        assert initial_states(starts) == pytest.approx(last, abs=1e-14)
        assert set(labels.classify(starts).state) == {state}


# Amplitudes (m/s²) at which labels have been wrong: long transients, coexisting chaos, two chaotic attractors.
HARD = (52.5, 53.0, 61.25, 64.84, 72.19, 72.97, 83.25)


def random_starts(acceleration, count):
    """Initial conditions on one conveyor as on the maps, with any phase."""
    generator = np.random.default_rng(int(100 * acceleration))
    rows = np.tile(pack(Conveyor(acceleration=acceleration), Start()), (count, 1))
    rows[:, Z0] = generator.uniform(0.0, 5e-4, count)
    rows[:, PSI0] = generator.uniform(0.0, 2.0 * np.pi, count)
    return rows


@pytest.fixture(scope="module")
def hard():
    return np.concatenate([random_starts(acceleration, 3) for acceleration in HARD])


def test_labels_do_not_depend_on_other_initial_conditions(hard):
    """Alone, together, in reverse order and in threads, with and without shared attractors."""
    together = labels.classify(hard, threads=2)
    backwards = labels.classify(hard[::-1])
    alone = [labels.classify(row[None]) for row in hard[::3]]
    shared_by = search.find_attractors(hard, cycles=labels.CYCLES)
    shared = labels.classify(hard, attractors=shared_by)
    one_by_one = [labels.classify(row[None], attractors=shared_by) for row in hard[::3]]
    for name in ("state", "period", "longest_flight"):
        wanted = getattr(together, name)
        np.testing.assert_array_equal(getattr(backwards, name)[::-1], wanted)
        np.testing.assert_array_equal(np.concatenate([getattr(one, name) for one in alone]), wanted[::3])
        found = getattr(shared, name)
        np.testing.assert_array_equal(np.concatenate([getattr(one, name) for one in one_by_one]), found[::3])
        if (
            name == "longest_flight"
        ):  # the longest flight of the orbit, to which trajectories have converged only approximately
            np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-6)
        else:
            np.testing.assert_array_equal(found, wanted)
    assert shared.cycles.sum() < 0.8 * together.cycles.sum()
    assert {"first", "second", "chaos"} <= set(together.state)


def test_long_transients_are_not_chaos():
    """At 73 m/s² all trajectories settle to a period of 8, most of them after thousands of cycles."""
    found = labels.classify(random_starts(73.0, 8), cycles=60_000)
    assert set(found.period) == {8}
    assert np.median(found.cycles) > 1000
    early = labels.classify(random_starts(73.0, 8), cycles=400)
    assert (early.state == "chaos").any()  # trajectories that have not settled by then have a positive exponent so far


def test_a_conveyor_may_have_two_chaotic_attractors():
    rows = random_starts(53.0, 1)
    for tolerance in (1e-6, 1e-8):  # one exponent is small, and differs from zero only after a long time
        found = search.find_attractors(rows, cycles=labels.CYCLES, tolerance=tolerance)
        assert len(found.chaotic.low) == 2
    assert len(search.find_attractors(random_starts(40.0, 1), cycles=labels.CYCLES).chaotic.low) == 0
    # At 72.97 m/s² chaos is a long transient, so the label chaos must wait until the end of the search.
    assert len(search.find_attractors(random_starts(72.97, 1), cycles=labels.CYCLES).chaotic.low) == 0


@pytest.mark.parametrize("cycles", [500, 1000, 2000])
def test_transient_chaos_is_not_an_attractor(cycles):
    """At 73 m/s² all trajectories settle; some that settle late show that chaos is transient there."""
    assert len(search.find_attractors(random_starts(73.0, 1), cycles=cycles, tolerance=1e-8).chaotic.low) == 0


@pytest.mark.parametrize("settles_after", [None, 3])
def test_settling_in_the_second_half_counts_as_late(monkeypatch, settles_after):
    """A trajectory at 80 m/s², in chaos, that is made to settle some cycles after the first half of the search."""
    (row, _), cycles = attractor_table.distinct_rows(random_starts(80.0, 1)), 2000
    follow, halves = sampling.follow, []

    def interrupted(parameters, states, count, *rest):
        found = follow(parameters, states, count, *rest)
        if count == cycles:
            halves.append(count)
            if len(halves) == 2 and settles_after:
                found.outcomes[0], found.followed[0] = convergence.PERIODIC, settles_after
        return found

    probed = sampling.sample_conveyors(row, sampling.SHORT_SEARCH, 1e-8)
    monkeypatch.setattr(sampling, "follow", interrupted)
    (found,) = chaotic_sets.find_chaotic_sets(row, probed, cycles, 1e-8, max_cycles=10**6)
    assert (len(found.low) == 0 and len(halves) == 2) if settles_after else len(found.low) > 0


def test_conveyors_that_are_probed_side_by_side_do_not_disturb_each_other(monkeypatch):
    """Some have one or two chaotic sets, some have none, some cannot be followed in lanes."""
    alike = [Conveyor(acceleration=a) for a in (40.0, 53.0, 65.0, 73.0, 80.0, 89.0)]
    rows = np.array([pack(one, Start()) for one in (*alike, Conveyor(acceleration=80.0, tension="clip"))])
    options = {"cycles": 2000, "tolerance": 1e-6}
    alone = [search.find_attractors(row[None], **options) for row in attractor_table.distinct_rows(rows)[0]]
    for together in (3, 16):
        monkeypatch.setattr(search, "TOGETHER", together)
        found = search.find_attractors(rows, **options)
        assert len(found.chaotic.low) >= 4
        for table, wanted in zip(found, attractor_table.concatenate(alone), strict=True):
            for column, expected in zip(table, wanted, strict=True):
                np.testing.assert_array_equal(column, expected)


def test_a_period_is_the_shortest():
    """Close to its period doubling, a motion first returns after twice its period, from the other side."""
    found = labels.classify(np.array([pack(Conveyor(acceleration=72.98), Start(2.3e-4))]))
    assert found.period[0] == 2


def test_longest_flight_covers_the_end_of_the_search():
    """A part that falls from a large height onto a weakly damped contact bounces higher at first than at the end."""
    parameters = pack(Conveyor(acceleration=5.0, damping=0.05, psi0=np.pi), Start(z=0.05))
    (state,), count = stroboscopic_map.initial_states(parameters[None], 1e-8), 200
    _, _, features = stroboscopic_map.monodromy(parameters, 1e-8, state.copy(), count, 0.0)
    flights = features[:, [stroboscopic_map.LONGEST_FLIGHT, stroboscopic_map.AIRBORNE]].max(axis=1)
    found = sampling.follow(parameters[None], state[None], count, 1e-8)
    assert found.outcomes[0] == convergence.NOT_CONVERGED
    assert flights[: stroboscopic_map.MAX_PERIOD].max() > 2.0 * flights[-stroboscopic_map.MAX_PERIOD :].max()
    assert found.flights[0] == pytest.approx(flights[-stroboscopic_map.MAX_PERIOD :].max(), rel=1e-6)


def test_motions_of_one_state_differ():
    """At 50.5 m/s² a part jumps over one cycle or over two, with velocities of 0.066 and 0.126 m/s."""
    rows = np.array([pack(Conveyor(acceleration=50.5), Start(z)) for z in (0.0, 0.05e-3)])
    found = labels.classify(rows)
    assert list(found.state) == ["second", "second"]
    assert found.longest_flight[1] > 1.0 > found.longest_flight[0]


def test_boxes_contain_a_motion_and_its_neighbourhood():
    """A point within a box's size of any strobe, on every side, lies in a box that counts as visited."""
    strobes = np.random.default_rng(2).normal(size=(500, 2)) * [1e-5, 0.1]
    low, size, visited = chaotic_sets.cover_by_boxes(strobes)
    for shift in ((0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0)):
        places = np.floor((strobes + np.array(shift) * size * (1.0 - 1e-9) - low) / size).astype(int)
        assert places.min() >= 0
        assert places.max() < len(visited)
        assert visited[places[:, 0], places[:, 1]].all()
    assert visited.mean() < 0.1


def test_a_trajectory_that_begins_in_a_trapping_region_is_followed_for_no_whole_cycle():
    """Its label is that of the trajectory that is followed without known attractors."""
    rows = random_starts(40.0, 30)
    known = search.find_attractors(rows, cycles=labels.CYCLES)
    found, wanted = labels.classify(rows, attractors=known), labels.classify(rows)
    assert 0.0 < (found.cycles == 0).mean() < 1.0
    assert found.state.tolist() == wanted.state.tolist()
    assert found.period.tolist() == wanted.period.tolist()
    assert wanted.cycles.min() > 0


@pytest.mark.long
def test_the_bar_moves_evenly_where_the_last_trajectories_take_longest():
    class Steps(tqdm):
        def update(self, n=1):
            steps.append((time.process_time() - begin, n))

    steps, begin = [], 0.0
    accelerations = np.repeat([30.0, 80.0], 150)
    labels.classify(parameter_table(Conveyor(), acceleration=accelerations, z0=3e-4), cycles=200)  # compiles
    begin = time.process_time()
    with Steps(disable=True) as shown:
        labels.classify(parameter_table(Conveyor(), acceleration=accelerations, z0=3e-4), cycles=6000, progress=shown)
    times, rows = np.transpose(steps)
    assert 0.25 < np.interp(150, np.cumsum(rows), times) / times[-1] < 0.75


def test_without_exponents_what_has_not_converged_is_undecided():
    chaotic = parameter_table(Conveyor(acceleration=80.0), z0=3e-4)
    assert labels.classify(chaotic, cycles=400).state == "chaos"
    found = labels.classify(chaotic, cycles=400, exponents=False)
    assert found.state == "undecided"
    assert np.isnan(found.longest_flight)
