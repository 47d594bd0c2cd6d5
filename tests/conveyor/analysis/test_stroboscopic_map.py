"""The stroboscopic map against `simulate`: two consumers of one engine, one motion."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start, plate_motion, simulate
from conveyor.analysis import stroboscopic_map
from conveyor.solver import contact, contact_law
from conveyor.solver.model import TENSION_MODES, pack
from conveyor.solver.status import OK

CYCLES = 6
STIFFNESS = {1.0: 3e3, 1.3: 5e4, 1.5: 5e5, 2.0: 5e7, 2.5: 2e10, 3.0: 5e12}


def strobes_of(conveyor, start, tolerance=1e-12):
    """δ (m) and v (m/s) after each cycle, and the features of the cycles."""
    parameters = pack(conveyor, start)
    (state,) = stroboscopic_map.initial_states(parameters[None], tolerance)
    _, _, features = stroboscopic_map.monodromy(parameters, tolerance, state.copy(), CYCLES, 0.0)
    code, strobes = stroboscopic_map.follow_map(parameters, tolerance, state, CYCLES)
    assert code == OK
    return strobes, features


@pytest.mark.parametrize("tension", TENSION_MODES)
@pytest.mark.parametrize("exponent", STIFFNESS)
@pytest.mark.parametrize(("acceleration", "z0", "psi0"), [(30.0, 0.0, 0.0), (47.0, 0.0, 2.0), (60.0, 3e-4, 4.0)])
def test_map_is_the_motion_at_whole_cycles(tension, exponent, acceleration, z0, psi0):
    """States, impacts, time in contact and longest flight of a riding, a bouncing and a jumping part."""
    conveyor = Conveyor(
        acceleration=acceleration, psi0=psi0, tension=tension, exponent=exponent, stiffness=STIFFNESS[exponent]
    )
    strobes, features = strobes_of(conveyor, Start(z0))
    duration = CYCLES / conveyor.frequency
    run = simulate(conveyor, Start(z0), duration=duration, tolerance=1e-12)
    times = np.arange(1, CYCLES + 1) / conveyor.frequency
    times[-1] = duration
    sample, plate = run.sample(times), plate_motion(conveyor, times)
    unit = 9.81 / (2.0 * math.pi * conveyor.frequency)
    assert strobes[:, 0] == pytest.approx(plate["z"] - sample["z"], abs=1e-8 * unit / 314.0)
    assert strobes[:, 1] == pytest.approx(plate["vz"] - sample["vz"], abs=1e-8 * unit)
    # An impact or a stop at the very end of a cycle may fall on either side.
    impacts = run.events[run.events["kind"] == "impact"]["time"]
    assert features[:, stroboscopic_map.IMPACTS].sum() == len(impacts) == run.impacts
    assert features[:, stroboscopic_map.CONTACT_TIME].sum() == pytest.approx(run.contact_fraction * duration, rel=1e-9)
    leaving = run.events[run.events["kind"] == "separation"]["time"]
    flights = [(impacts[impacts > begin] - begin).min() for begin in leaving if (impacts > begin).any()]
    if z0 > plate["z"][0]:
        flights.append(impacts[0])  # the start is in the air
    if flights:
        assert features[:, stroboscopic_map.LONGEST_FLIGHT].max() == pytest.approx(max(flights), rel=1e-6)


@pytest.mark.parametrize("tension", TENSION_MODES)
@pytest.mark.parametrize("exponent", STIFFNESS)
def test_linearised_map_is_the_derivative_of_the_map(tension, exponent):
    """Columns of the monodromy matrix in (δ, Y) against central differences of the map itself."""
    conveyor = Conveyor(acceleration=60.0, tension=tension, exponent=exponent, stiffness=STIFFNESS[exponent])
    parameters = pack(conveyor, Start())
    c = contact.constants(parameters, 1e-13)

    def advanced(q, y):
        """(δ, Y) one cycle after a state in the air with (δ, Y) = (q, y)."""
        _, strobes = stroboscopic_map.follow_map(parameters, 1e-13, np.array([q, y]), 1)
        delta, v = strobes[0]
        clipped = conveyor.tension == "clip" and delta > 0.0
        assert not clipped or contact_law.force(c, math.sqrt(delta), v) > 0.0
        return np.array([delta, contact_law.smooth_speed(c, delta, v)])

    here = np.array([-2e-4, 0.05])
    _, matrices, features = stroboscopic_map.monodromy(parameters, 1e-13, here.copy(), 1, 0.0)
    assert features[0, stroboscopic_map.IMPACTS] > 0
    for column, step in enumerate((1e-9, 1e-6)):
        ahead = np.zeros(2)
        ahead[column] = step
        slope = (advanced(*(here + ahead)) - advanced(*(here - ahead))) / (2.0 * step)
        assert matrices[0][:, column] == pytest.approx(slope, rel=2e-5)


@pytest.mark.parametrize(("acceleration", "z0"), [(30.0, 0.0), (40.0, 3e-4), (55.0, 3e-4), (62.0, 0.0), (80.0, 0.0)])
def test_what_repeats_itself_is_copied_bit_for_bit(acceleration, z0):
    """Riding, jumping with one, two and four cycles, and chaos, against each cycle followed."""
    parameters, tolerance, cycles = pack(Conveyor(acceleration=acceleration), Start(z0)), 1e-10, 500
    (state,), found = stroboscopic_map.initial_states(parameters[None], tolerance), np.zeros(stroboscopic_map.FEATURES)
    end = state.copy()
    status, strobes = stroboscopic_map.follow_map(parameters, tolerance, end, cycles)
    assert status == OK
    c, series = contact.constants(parameters, tolerance), contact.workspace()
    for n in range(cycles):
        stroboscopic_map.advance(c, series, state, c.psi0, c.period, np.empty((0, 2)), found)
        np.testing.assert_array_equal(strobes[n], state)
    np.testing.assert_array_equal(end, state)


def test_time_in_the_air_goes_on_over_cycles():
    """A flight of many cycles is one flight."""
    conveyor = Conveyor(acceleration=1.0)
    _, features = strobes_of(conveyor, Start(z=0.05))
    assert (features[:, stroboscopic_map.IMPACTS][:-1] == 0.0).all()
    assert features[:-1, stroboscopic_map.AIRBORNE] == pytest.approx(np.arange(1, CYCLES) / conveyor.frequency)


@pytest.mark.parametrize(("period", "expected"), [(1, 1), (3, 3), (64, 64), (65, 0)])
def test_the_least_period_is_found(period, expected):
    strobes = np.tile(np.random.default_rng(1).random((period, 2)), (256 // period + 1, 1))[:256]
    assert stroboscopic_map.repeated_period(strobes, 64, 1e-9) == expected
    strobes[-1] += 1e-8
    assert stroboscopic_map.repeated_period(strobes, 64, 1e-9) == 0
