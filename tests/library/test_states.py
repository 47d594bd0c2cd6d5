"""States of motion and attractors: those that are known, however cut or started."""

import numpy as np
import pytest

from conveyor import Conveyor, Start, attractors, grid, states, sweep
from conveyor.lyapunov import initial_states
from conveyor.model import pack

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
    return np.array([pack(Conveyor(acceleration=a), Start(z0)) for a, z0 in KNOWN])


@pytest.mark.parametrize("threads", [1, 2])
def test_known_states(threads):
    found = states.classify(points(), threads=threads)
    assert list(zip(*map(list, found), strict=True)) == list(KNOWN.values())


def test_state_does_not_depend_on_when_the_run_is_cut():
    for duration in (0.013, 0.2, 1.0):
        runs = sweep.run(points(), duration=duration)
        later = states.continued(points(), runs["z_end"], runs["vz_end"], duration)
        assert list(states.classify(later)[0]) == [state for state, _ in KNOWN.values()]


def test_slow_transients_are_followed():
    """Just above the doubling a period of two is approached very slowly; it is neither chaos nor undecided."""
    state, period = states.classify(np.array([pack(Conveyor(acceleration=54.25), Start(3e-4))]))
    assert (state[0], period[0]) == ("second", 2)


def test_part_that_cannot_be_followed_is_undecided():
    row = pack(Conveyor(), Start())
    row[0] = np.nan
    assert states.classify(row[None])[0][0] == "undecided"


def test_sweep_keeps_to_its_attractor():
    """Up from rest the part rides beyond 45 m/s², down from jumping it jumps below: hysteresis."""
    for amplitudes, z0, state in (
        (np.linspace(38.0, 45.0, 15), 0.0, "first"),
        (np.linspace(45.0, 38.0, 15), 3e-4, "second"),
    ):
        model = {"z0": z0}
        _, parameters = grid.product({"acceleration": list(amplitudes)}, model)
        strobes, status = attractors.sweep(parameters, transient=300, strobes=4, tolerance=1e-10)
        assert (status == "ok").all()
        assert np.ptp(strobes, axis=1) == pytest.approx(0.0, abs=1e-7)
        starts = attractors.as_starts(parameters, strobes[:, -1], 1e-10)
        assert initial_states(starts, 1e-10) == pytest.approx(strobes[:, -1], abs=1e-14)
        assert set(states.classify(starts)[0]) == {state}
