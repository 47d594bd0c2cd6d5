"""Contact steps in lanes: bit for bit equal to single steps, and no missed event."""

import functools

import numba
import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.solver import contact, contact_lanes, model, polynomial
from conveyor.solver.contact_lanes import COSINE, END, LENGTH, SERIES, SINE, STEPS, TIME, V, W
from conveyor.solver.pieces import MAX_PIECES
from conveyor.solver.workspace import FIRST

TOLERANCES = (1e-6, 1e-8, 1e-12)


@numba.njit(error_model="numpy")
def take_one(c, series, w, v, sine, cosine):
    length = contact.begin_step(c, series, FIRST, w, v, sine, cosine, False)
    return contact.end_step(c, series, FIRST, w, v, False, length)


@numba.njit(error_model="numpy")
def fill(flat, memory, lane, c):
    contact_lanes.set_constants(flat, memory, lane, c)


@functools.cache
def step_for(harmonics):
    """`contact_lanes.step` for plates with a number of harmonics, or None."""

    @numba.njit(error_model="numpy")
    def step(memory, lanes):
        return contact_lanes.step(memory, lanes, harmonics)

    return step


def random_waves(count, rng):
    """A number of harmonics of different orders."""
    return [
        {"order": int(k), "along": rng.uniform(0.0, 0.3), "normal": rng.uniform(0.0, 0.3), "normal_phase": 1.0}
        for k in rng.choice(np.arange(2, 9), count, replace=False)
    ]


def random_contacts(count, seed, harmonics=0):
    """Packed parameters; constants of conveyors; √penetration in units of that at rest, speed in that of a fall; phase.

    Impacts, and parts deep in the plate, on the way out, or about to turn round.
    """
    rng = np.random.default_rng(seed)
    conveyors = [
        Conveyor(
            acceleration=rng.uniform(0.0, 90.0) * (rng.random() < 0.9),
            frequency=rng.uniform(20.0, 100.0),
            stiffness=10.0 ** rng.uniform(3.5, 7.0),
            damping=rng.uniform(0.0, 1.0) * (rng.random() < 0.8),
            harmonics=random_waves(harmonics, rng),
        )
        for _ in range(count)
    ]
    tolerances = rng.choice(TOLERANCES, count)
    # Constants point to the harmonics in the parameters.
    rows = [model.pack(conveyor, Start()) for conveyor in conveyors]
    constants = [contact.constants(row, tolerance) for row, tolerance in zip(rows, tolerances, strict=True)]
    w = rng.uniform(0.0, 3.0, count) * (rng.random(count) < 0.8)
    v = np.where(w > 0.0, rng.uniform(-5.0, 5.0, count), rng.uniform(0.0, 5.0, count))
    turning = rng.random(count) < 0.2
    w[turning], v[turning] = rng.uniform(0.3, 0.9, turning.sum()), rng.uniform(-0.2, 0.0, turning.sum())
    w *= [c.scale_w for c in constants]
    v *= [c.scale_v for c in constants]
    return rows, constants, w, v, rng.uniform(0.0, 2.0 * np.pi, count)


LONG = pytest.mark.long


@pytest.mark.parametrize(
    ("lanes", "harmonics"),
    [(1, None), (4, None), (8, None), pytest.param(1, 2, marks=LONG), pytest.param(8, 2, marks=LONG)],
)
def test_steps_have_the_bits_of_single_ones(lanes, harmonics):
    _, constants, w, v, phase = random_contacts(400, lanes, harmonics or 0)
    series = contact.workspace()
    taken = 0
    for first in range(0, 400, lanes):
        flat, memory = contact_lanes.new_memory(contact_lanes.row_count(harmonics))
        rows = range(first, first + lanes)
        for lane, k in enumerate(rows):
            fill(flat, memory, lane, constants[k])
            start = w[k], v[k], np.sin(phase[k]), np.cos(phase[k])
            memory[[W, V, SINE, COSINE], lane] = start
            memory[[TIME, END], lane] = 0.001, 1.0
        before = memory.copy()
        stays = step_for(harmonics)(flat, lanes)
        assert (memory[:, lanes:] == 0.0).all()
        for lane, k in enumerate(rows):
            length, new_w, new_v, lapse, event = take_one(constants[k], series, *before[[W, V, SINE, COSINE], lane])
            # The rows that lanes keep are the first ones.
            kept = len(contact_lanes.KEPT) * polynomial.SIZE
            np.testing.assert_array_equal(memory[SERIES : SERIES + kept, lane], series[FIRST : FIRST + kept])
            if stays >> lane & 1:
                rows_of_motion = [W, V, SINE, COSINE, TIME, STEPS]
                assert (memory[rows_of_motion, lane] == before[rows_of_motion, lane]).all()
                continue
            taken += 1
            assert event == contact.NOTHING
            assert not v[k] < 0.0 < new_v  # a part that turns round may have left the plate in between
            assert memory[[W, V, TIME, LENGTH, STEPS], lane].tolist() == [new_w, new_v, 0.001 + lapse, length, 1.0]
    assert 200 < taken < 390


def test_a_step_stays_where_no_time_or_no_step_is_left_or_what_is_not_a_number():
    _, (c,), *_ = random_contacts(1, seed=0)
    flat, memory = contact_lanes.new_memory(contact_lanes.row_count(None))
    for lane in range(4):
        fill(flat, memory, lane, c)
        memory[[W, V, SINE, COSINE, TIME, END], lane] = c.scale_w, 0.0, 0.0, 1.0, 0.0, 1.0
    memory[END, 1] = 0.0
    memory[STEPS, 2] = MAX_PIECES
    memory[V, 3] = np.nan
    assert step_for(None)(flat, 4) == 0b1110


def test_what_can_be_followed_in_lanes():
    for conveyor, expected in (
        (Conveyor(), True),
        (Conveyor(exponent=1.0), False),
        (Conveyor(tension="clip"), False),
        (Conveyor(tension="frictionless"), False),
    ):
        assert contact_lanes.can_follow(contact.constants(model.pack(conveyor, Start()), 1e-8)) == expected
