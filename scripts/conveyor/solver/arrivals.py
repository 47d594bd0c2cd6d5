"""Parts on a track: when they arrive at given distances, and cycles that need not be followed.

A part may move for thousands of cycles. A motion that after a block of cycles differs from itself by no more than a
small part of the plate's largest speed repeats itself. Blocks that repeat the last one and contain neither a sample nor
an arrival are skipped.
"""

import math
from collections import namedtuple

from .horizontal import Horizontal
from .jit import compiled_into_callers
from .pieces import clock_at
from .record import ARRIVED, next_time

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


@compiled_into_callers
def record_arrivals(record, block, step, x_begin, x_end):
    """Record the arrivals in a record.Step between two positions along the track (m); the Block with the furthest one.

    A flight is uniform along the track, and a contact step is short.
    """
    arrived = int(record.results[ARRIVED])
    while arrived < record.arrivals.size and x_end >= record.distances[arrived]:
        tau = step.piece.duration * (record.distances[arrived] - x_begin) / (x_end - x_begin)
        record.arrivals[arrived] = step.begin + tau
        arrived += 1
    record.results[ARRIVED] = arrived
    return Block(block.cycle, block.t, block.w, block.v, block.vx, block.x, max(block.furthest, x_end))


@compiled_into_callers
def has_arrived(record):
    """Whether the part has been at the last distance."""
    return record.arrivals.size > 0 and record.results[ARRIVED] == record.arrivals.size


@compiled_into_callers
def blocks_to_skip(c, block, repetition, motion, horizontal, left, ahead):
    """How many of the next blocks of cycles repeat the last one, and contain neither a sample nor an arrival.

    repetition : see skip_blocks
    motion, horizontal : at the end of the last block
    left : time to the next sample, s
    ahead : from the furthest position in the last block to the next distance, m
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
    blocks = left / (cycles * c.period)
    if advance > 0.0:
        blocks = min(blocks, ahead / advance)
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
        ahead = math.inf
        if record.arrivals.size > 0:
            ahead = record.distances[int(record.results[ARRIVED])] - block.furthest
        left = next_time(record) - clock.begin
        skipped = blocks_to_skip(c, block, repetition, motion, horizontal, left, ahead)
        clock = clock_at(c, clock.origin, clock.first, clock.cycle + skipped * cycles)
        x = horizontal.x + skipped * (horizontal.x - block.x)
        horizontal = Horizontal(x, horizontal.vx, horizontal.sigma)
    block = Block(clock.cycle, motion.t, motion.w, motion.v, horizontal.vx, horizontal.x, horizontal.x)
    return clock, horizontal, block
