"""Parts on a track: when they arrive at given distances, and cycles that need not be followed.

A part may move for thousands of cycles. A motion that after a block of cycles differs from itself by no more than a
small part of the plate's largest speed repeats itself. Blocks that repeat the last one and contain neither a sample nor
an arrival are skipped.
"""

import math
from collections import namedtuple

from .horizontal import Horizontal
from .jit import compiled_inline, compiled_into_callers
from .pieces import clock_at
from .record import ARRIVED, next_time
from .vertical import FLIGHT

# When a motion repeats itself: cycles of a block, and the largest difference after a block, as a share of the plate's
# largest speed. On a track, blocks are whole periods of motions with the periods 1 to 6.
ON_TRACK = (60, 1e-10)
# Between two samples: periods 1 to 4 and 6, and a share of the tolerance, within which settled motions repeat steps.
CYCLES, SHARE = 12, 0.1
EVERY_CYCLE = (0, 0.0)  # nothing is skipped
ROUNDING = 1e-10  # relative, of a number of blocks

# The beginning of a block: the number of its first cycle; time into this cycle (s), w, v; velocity (m/s) and position
# (m) along the track; the furthest position since then (m).
Block = namedtuple("Block", "cycle t w v vx x furthest")
FIRST_BLOCK = Block(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@compiled_inline
def time_of_passage(ahead, vx, downhill, duration, advance):
    """Time (s) after which a part has gone the distance `ahead` > 0 (m) for the first time, NaN if it has not.

    vx : at the beginning, m/s
    downhill : deceleration in a flight, m/s²; 0 on a level track, and in a contact step, which is short
    duration, advance : of the flight or the step, s, and the distance that the part goes in it, m
    """
    if downhill == 0.0:
        return duration * ahead / advance if advance >= ahead else math.nan
    square = vx * vx - 2.0 * downhill * ahead
    speed = vx + math.sqrt(square) if square >= 0.0 else 0.0
    tau = 2.0 * ahead / speed if speed > 0.0 else math.inf  # the first root, without cancellation
    return min(tau, duration) if tau <= duration or advance >= ahead else math.nan


@compiled_inline
def furthest_way(vx, downhill, duration, advance):
    """The largest distance (m) that a part goes in a flight or a step; arguments as in `time_of_passage`."""
    turns = 0.0 < vx < downhill * duration
    return 0.5 * vx * vx / downhill if turns else advance


@compiled_into_callers
def record_arrivals(c, record, block, step, horizontal, x_end):
    """Record the arrivals in a record.Step that begins with a Horizontal motion and ends at x_end (m) along the track.

    Returns the Block with the furthest position.
    """
    downhill = c.downhill if step.piece.kind == FLIGHT else 0.0
    x, vx, duration, advance = horizontal.x, horizontal.vx, step.piece.duration, x_end - horizontal.x
    arrived = int(record.results[ARRIVED])
    while arrived < record.arrivals.size:
        tau = time_of_passage(record.distances[arrived] - x, vx, downhill, duration, advance)
        if math.isnan(tau):
            break
        record.arrivals[arrived] = step.begin + tau
        arrived += 1
    record.results[ARRIVED] = arrived
    furthest = max(block.furthest, x_end, x + furthest_way(vx, downhill, duration, advance))
    return Block(block.cycle, block.t, block.w, block.v, block.vx, block.x, furthest)


@compiled_into_callers
def has_arrived(record):
    """Whether the part has been at the last distance."""
    return record.arrivals.size > 0 and record.results[ARRIVED] == record.arrivals.size


@compiled_into_callers
def blocks_to_skip(c, block, repetition, motion, horizontal, time_left, distance_left):
    """How many of the next blocks of cycles repeat the last one, and contain neither a sample nor an arrival.

    repetition : see skip_blocks
    motion, horizontal : at the end of the last block
    time_left : to the next sample, s
    distance_left : from the furthest position in the last block to the next distance, m
    """
    cycles, same = repetition
    speed = max(c.a_x, c.a_z) / c.omega
    deviation = max(
        c.omega * speed * abs(motion.t - block.t),
        c.omega * abs(motion.w**2 - block.w**2),
        abs(motion.v - block.v),
        abs(horizontal.vx - block.vx),
    )
    if deviation > same * speed:
        return 0
    advance = horizontal.x - block.x
    blocks = time_left / (cycles * c.period)
    if advance > 0.0:
        blocks = min(blocks, distance_left / advance)
    return max(int((1.0 - ROUNDING) * blocks), 0)  # never beyond the sample by a rounding error


@compiled_into_callers
def skip_blocks(c, record, block, repetition, clock, motion, horizontal):
    """The Clock, Horizontal and Block with which a run goes on in a new cycle, after blocks that are skipped.

    repetition : cycles of a block, 0 to follow all cycles, and largest difference
    """
    cycles = repetition[0]
    if cycles == 0 or clock.cycle < block.cycle + cycles or not motion.touching:
        return clock, horizontal, block
    if clock.cycle == block.cycle + cycles:
        distance_left = math.inf
        if record.arrivals.size > 0:
            distance_left = record.distances[int(record.results[ARRIVED])] - block.furthest
        time_left = next_time(record) - clock.begin
        skipped = blocks_to_skip(c, block, repetition, motion, horizontal, time_left, distance_left)
        clock = clock_at(c, clock.origin, clock.first, clock.cycle + skipped * cycles)
        x = horizontal.x + skipped * (horizontal.x - block.x)
        horizontal = Horizontal(x, horizontal.vx, horizontal.sigma)
    block = Block(clock.cycle, motion.t, motion.w, motion.v, horizontal.vx, horizontal.x, horizontal.x)
    return clock, horizontal, block
