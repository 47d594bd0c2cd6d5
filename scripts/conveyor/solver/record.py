"""What is recorded of a run: samples, events, and statistics of its pieces."""

import math
from collections import namedtuple

import numpy as np

from .contact import FORCE_SIGN, SEPARATION
from .flight import highest_gap
from .jit import compiled_inline, compiled_into_callers
from .model import TENSION_CLIP
from .peaks import peak_of_step
from .status import OK
from .vertical import CONTACT, FLIGHT, TIME_LIMIT, flight_from

# Columns of a sample.
X, VX, Z, VZ, CONTACT_FORCE, FRICTION_FORCE = range(6)
SAMPLES = ("x", "vx", "z", "vz", "contact_force", "friction_force")

# Kinds of events.
IMPACT, SEPARATED, SLIP_REVERSAL, STICK, SLIP, TENSION_BEGINS, TENSION_ENDS = range(7)
EVENT_KINDS = ("impact", "separation", "slip reversal", "stick", "slip", "tension begins", "tension ends")

# Columns of the results of runs: the status code, numbers of events and of impacts, the time with contact force (s),
# the largest gap (m), numbers of computed and of repeated contact steps; the largest speed of approach at an impact
# (m/s) and the largest contact force (N) from the time `since` of the Record on, 0 where there is none; the numbers of
# times with a sample and of distances at which the part has arrived.
CODE, EVENTS, IMPACTS, CONTACT_TIME, MAX_GAP, STEPS, REPEATS, IMPACT_SPEED, PEAK_FORCE, SAMPLED, ARRIVED = range(11)
RESULTS = 11

# Arrays to fill for one run: `samples`, shape (k, 6), at the `times` (s), shape (k,); times (s) and kinds of the first
# m events, shape (m,); `arrivals` (s) at the `distances` (m), shape (d,); `results`, shape (11,). Impact speeds and
# forces count from the time `since` (s) on.
Record = namedtuple("Record", "times since samples event_times event_kinds distances arrivals results")
# A piece of a run: the workspace, the first row of the series of a contact step in it, the vertical.Motion at the
# beginning of the piece, the vertical.Piece, and the time (s) at which it begins.
Step = namedtuple("Step", "series at motion piece begin")


def name_events(times: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """Events as a structured array with the fields `time` (s) and `kind` (one of EVENT_KINDS), from their numbers."""
    events = np.empty(len(times), dtype=[("time", np.float64), ("kind", "U14")])
    events["time"], events["kind"] = times, np.array(EVENT_KINDS)[kinds]
    return events


@compiled_inline
def is_sampled(record):
    """Whether a run is at its end, because all samples have been taken."""
    return record.results[SAMPLED] == record.times.size


@compiled_inline
def next_time(record):
    """The next time (s) at which a sample is wanted; NaN, which no time reaches, if all samples have been taken."""
    return math.nan if is_sampled(record) else record.times[int(record.results[SAMPLED])]


@compiled_inline
def next_sample(record):
    """The next sample to fill, float64, shape (6,)."""
    sampled = int(record.results[SAMPLED])
    record.results[SAMPLED] = sampled + 1
    return record.samples[sampled]


@compiled_inline
def record_event(record, time, kind):
    """Record the time (s) and kind of an event if there is room, and count it."""
    events = int(record.results[EVENTS])
    if events < record.event_times.size:
        record.event_times[events] = time
        record.event_kinds[events] = kind
    record.results[EVENTS] = events + 1


@compiled_into_callers
def record_end(record, step, after):
    """Record the event, if any, that ends a Step, before the Motion `after` it."""
    piece, time = step.piece, step.begin + step.piece.duration
    if piece.kind == FLIGHT:
        record_event(record, time, IMPACT)
    elif piece.end == SEPARATION and not after.touching:
        record_event(record, time, SEPARATED)
    elif piece.end == FORCE_SIGN:
        record_event(record, time, TENSION_ENDS if step.motion.pulled else TENSION_BEGINS)


@compiled_into_callers
def count_piece(c, step, record):
    """Add a piece to the statistics of a run."""
    motion, piece, results = step.motion, step.piece, record.results
    since, end = record.since, record.times[-1]
    if piece.kind == FLIGHT:
        highest = highest_gap(flight_from(c, motion), min(piece.duration, end - step.begin))
        results[MAX_GAP] = max(results[MAX_GAP], highest)
        if step.begin + piece.duration < end:
            results[IMPACTS] += 1
            if step.begin + piece.duration >= since:
                results[IMPACT_SPEED] = max(results[IMPACT_SPEED], piece.v)
    elif piece.kind == CONTACT:
        results[REPEATS if piece.repeated else STEPS] += 1
        if not (motion.pulled and c.tension == TENSION_CLIP):
            # A repeated step has the duration of the kept one, but counts up to the end of the cycle.
            lasts = c.period - motion.t if piece.end == TIME_LIMIT else piece.duration
            results[CONTACT_TIME] += min(lasts, end - step.begin)
            if step.begin + piece.duration > since:
                force = peak_of_step(c, step, since - step.begin, end - step.begin)
                results[PEAK_FORCE] = max(results[PEAK_FORCE], c.mass * force)


@compiled_into_callers
def end_record(record, status, feeding):
    """Write the status of a run into its Record, and NaN where there is no result."""
    record.results[CODE] = status
    # The durations of the pieces may add up to slightly more than the run.
    record.results[CONTACT_TIME] = min(record.results[CONTACT_TIME], record.times[-1])
    if status != OK:
        record.results[IMPACT_SPEED] = record.results[PEAK_FORCE] = math.nan
    if not feeding:
        record.samples[:, X] = record.samples[:, VX] = record.samples[:, FRICTION_FORCE] = math.nan
    record.samples[int(record.results[SAMPLED]) :] = math.nan
    record.arrivals[int(record.results[ARRIVED]) :] = math.nan
