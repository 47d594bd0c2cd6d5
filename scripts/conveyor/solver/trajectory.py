"""Runs: the loop over the pieces of a motion, in which all that is recorded of a run follows each piece."""

import math

import numpy as np

from ..parallel import call_interruptibly
from . import contact, pieces, plate, repeated_steps
from .arrivals import EVERY_CYCLE, FIRST_BLOCK, has_arrived, record_arrivals, skip_blocks
from .horizontal import Horizontal, follow_horizontal, touch_down
from .jit import compiled_entry, no_refcount
from .model import FREQUENCY, VZ0, Z0
from .record import MAX_GAP, RESULTS, SAMPLED, SAMPLES, Record, Step, count_piece, end_record, is_sampled, record_end
from .status import OK
from .vertical import FLIGHT

LONG = 10_000  # excitation cycles of all runs, which take some tenths of a second


def integrate(
    parameters: np.ndarray,
    times: np.ndarray,
    *,
    tolerance: float,
    feeding: bool = True,
    reuse: bool = True,
    repetition: tuple[int, float] = EVERY_CYCLE,
    event_times: np.ndarray | None = None,
    event_kinds: np.ndarray | None = None,
    distances: np.ndarray | None = None,
    arrivals: np.ndarray | None = None,
    since: np.ndarray | None = None,
    vx0: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Follow parts until the last of their `times` and sample them there.

    With `distances`, a part is followed no further than the last of them.

    Parameters
    ----------
    parameters : float64, shape (n, 16), see parameters.PARAMETERS
    times : float64, shape (n, k), s, ascending, ≥ 0; a run ends at its last one
    tolerance : relative error per step of the contact
    feeding : whether the horizontal motion is wanted; without it its columns are NaN
    reuse : whether steps of a settled motion are repeated instead of computed (see repeated_steps)
    repetition : cycles of a block and largest difference; blocks in which a motion repeats itself are skipped (see
        arrivals), also by the counts in the results
    event_times, event_kinds : float64 (s) and int8, shape (n, m), filled with the first m events of each
    distances : float64, shape (d,), m along the track, ascending, > 0
    arrivals : float64, shape (n, d), filled with the first times (s) at which a part is at each distance, to a small
        part of a cycle; NaN for distances that it does not reach
    since : float64, shape (n,), s, from which impact speeds and forces count; by default the last but one of the
        `times`, or 0 where there is one only
    vx0 : float64, shape (n,), m/s, velocities along the track at t = 0; by default 0

    Returns
    -------
    samples, results : float64, shape (n, k, 6), the columns record.SAMPLES (m, m/s, N); shape (n, 11), see record
    """
    times = np.ascontiguousarray(times)  # numba would compile `follow`, for seconds, for each other layout
    n, k = times.shape
    samples, results = np.empty((n, k, len(SAMPLES))), np.zeros((n, RESULTS))
    if event_times is None or event_kinds is None:
        event_times, event_kinds = np.empty((n, 0)), np.empty((n, 0), np.int8)
    if distances is None or arrivals is None:
        distances, arrivals = np.empty(0), np.empty((n, 0))
    if since is None:
        since = np.ascontiguousarray(times[:, -2]) if k > 1 else np.zeros(n)
    if vx0 is None:
        vx0 = np.zeros(n)
    # Plain tuples, because numba takes several microseconds per call to find the type of a named tuple.
    records = (times, since, samples, event_times, event_kinds, arrivals, results)
    options = tolerance, feeding, reuse, repetition, plate.count_harmonics(parameters)
    series = contact.workspace(repeated_steps.PLACES)

    def run():
        # `follow` expects results of zero.
        follow(parameters, vx0, options, records, distances, series)

    def stop():
        results[:, SAMPLED] = k  # a run whose samples have all been taken ends

    cycles = times[:, -1] @ parameters[:, FREQUENCY]
    call_interruptibly(run, stop, is_long=cycles > LONG)
    return samples, results


@compiled_entry
def follow(parameters, vx0, options, records, distances, series):
    """The compiled part of `integrate`.

    Parameters
    ----------
    vx0 : see `integrate`
    options : tolerance, feeding, reuse and repetition, see `integrate`; plate.count_harmonics
    records : the fields of a Record but `distances`, each with one more axis in front, that of the runs
    distances : see `integrate`
    series : a workspace with repeated_steps.PLACES steps

    Only Python calls this function, because numba would compile the whole solver again into each compiled caller. The
    loop over the runs is here for the same reason: as a function of its own, it would take 3 s more to compile.
    """
    tolerance, feeding, reuse, repetition, harmonics = options
    times, since, samples, event_times, event_kinds, arrivals, results = no_refcount(records)
    series, distances = no_refcount((series, distances))
    for i in range(parameters.shape[0]):
        c = contact.compute_constants(parameters[i], tolerance, harmonics)
        repeated_steps.forget(series)
        motion, clock = pieces.begin(c, parameters[i, Z0], parameters[i, VZ0])
        record = no_refcount(
            Record(times[i], since[i], samples[i], event_times[i], event_kinds[i], distances, arrivals[i], results[i])
        )
        record.results[MAX_GAP] = max(motion.q, 0.0)
        horizontal, block = Horizontal(0.0, vx0[i], 0.0), FIRST_BLOCK
        if motion.touching:
            horizontal = touch_down(c, motion, horizontal)
        while True:
            limit = c.period - motion.t if motion.touching else math.inf
            piece, after, next_clock, status = pieces.advance(c, series, clock, motion, limit, reuse)
            if status != OK:
                break
            step = Step(series, clock.at, motion, piece, clock.begin + motion.t)
            count_piece(c, step, record)
            before = horizontal
            horizontal, status = follow_horizontal(c, step, horizontal, feeding, record)
            if status != OK or is_sampled(record):
                break
            record_end(record, step, after)
            block = record_arrivals(c, record, block, step, before, horizontal.x)
            if has_arrived(record):
                break
            motion, clock = pieces.next_cycle(c, next_clock, after, piece)
            if clock.pieces == 0:
                clock, horizontal, block = skip_blocks(c, record, block, repetition, clock, motion, horizontal)
            if piece.kind == FLIGHT and feeding:
                horizontal = touch_down(c, motion, horizontal)
        end_record(record, status, feeding)
