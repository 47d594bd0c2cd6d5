"""Contact steps of several parts side by side, one in each lane of the processor's vector registers.

This module repeats contact.py for whole registers, because that halves the time of maps (`convergence_lanes` and
`vertical_lanes` use it). It takes the steps in which no event can be, which are most of them, with the operations of
contact.py in the same order, so that each lane gives the same bits. In all other cases the lane keeps its motion and
its series, and contact.py finds the event. Lanes follow Hertz contacts (exponent 1.5) whose force may pull.
"""

from types import FunctionType

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

from . import contact, model, unrolled
from .jit import compiled, compiled_inline, compiled_into_callers
from .polynomial import ORDER, SIZE
from .trajectory import MAX_PIECES
from .vectors import INTEGER, Memory, Vector, call, fma, power, where

# Eight lanes take about a tenth less time than four, also in code for registers of four numbers.
LANES = 8

# The rows of the memory, which has a column for each lane. The first nine are the arguments of `expand`, in its order:
# √penetration (√m), speed of approach (m/s), sine and cosine of the phase, and contact.Constants.
W, V, SINE, COSINE, GRAVITY, A_Z, OMEGA, STIFFNESS, DAMPING = range(9)
# Further constants; the time and the end of the motion (s); the number of steps taken, up to MAX_PIECES; the length of
# the step in the variable s up to which the series holds, and the time (s) that a step of this length takes.
TOLERANCE, SCALE_V, TIME, END, STEPS, LENGTH, LAPSE = range(9, 16)
# Row SERIES + SIZE k + n holds coefficient n of row k of a workspace's step.
SERIES = 16
KEPT = (contact.W, contact.T, contact.V, contact.SINE, contact.COSINE)
ROWS = SERIES + SIZE * len(KEPT)

LINE = 64  # bytes, of a register and of a cache line: a vector that crosses a line costs two accesses
HUGE = 1e300
NONE = -1  # the row of a lane without a trajectory

# The straight-line code of the expansion, for Vectors.
expand = FunctionType(unrolled.expand_hertz.__code__, {"fma": fma})


def maximum(a: Vector, b: Vector) -> Vector:
    """In each lane the larger number, or `a` if one is NaN."""
    return where(b > a, b, a)


def step_length(at: Memory, series: dict[tuple[int, int], Vector]) -> Vector:
    """The length of the step in the variable s, see contact.step_length."""
    w, v = at[W], at[V]
    square = w * w
    energy = v * v + 2.0 * at[STIFFNESS] * (square * square * w) / 2.5
    scale = maximum(call("sqrt", energy), at[SCALE_V])
    allowed = at[TOLERANCE] * scale
    turn = maximum(abs(series[contact.SINE, ORDER]), abs(series[contact.COSINE, ORDER]))
    last = maximum(abs(series[contact.V, ORDER]), scale * turn)
    before = abs(series[contact.V, ORDER - 1])
    length = power(allowed / before, 1.0 / (ORDER - 1), before > 0.0, HUGE)
    shorter = power(allowed / last, 1.0 / ORDER, last * length > before, HUGE)
    return where(shorter < length, shorter, length)


def value(series: dict[tuple[int, int], Vector], row: int, s: Vector) -> Vector:
    """Σ c_n sⁿ as in polynomial.value, without the coefficients beyond ORDER, which are zero."""
    s2 = s * s
    s4 = s2 * s2
    sums = []
    for n in range(4):
        last, *others = (series[row, k] for k in reversed(range(n, ORDER + 1, 4)))
        total = s.like(last)
        for coefficient in others:
            total = fma(total, s4, coefficient)
        sums.append(total)
    return (sums[0] + s * sums[1]) + s2 * (sums[2] + s * sums[3])


@intrinsic(prefer_literal=True)
def step(typing_context, lanes, memory):
    """Expand the motion of each lane into its SERIES and LENGTH, and take the step if no event can be in it.

    lanes, memory : the number of lanes, and float64, shape (ROWS, lanes)
    Returns an integer with a bit for each lane: 1 if the lane keeps its motion, so that contact.end_step must end it.
    """

    def code(context, builder, signature, arguments):
        at = Memory(context, builder, signature, arguments)
        start = [at[row] for row in range(TOLERANCE)]
        w, v, sine, cosine, *_ = start
        series = {}
        expand(*start, series, 0)
        for row in KEPT:
            for n in range(ORDER + 1):
                at[SERIES + SIZE * row + n] = w.like(series[row, n])
        length = step_length(at, series)
        at[LENGTH] = length
        new_w, new_v, lapse, new_sine, new_cosine = (
            value(series, row, length) for row in (contact.W, contact.V, contact.T, contact.SINE, contact.COSINE)
        )
        at[LAPSE] = lapse
        # Comparisons with NaN are false.
        proper = (new_w < HUGE) & (abs(new_v) < HUGE) & (lapse <= at[END] - at[TIME]) & (at[STEPS] < MAX_PIECES)
        taken = proper & (new_w > 0.0) & ~((v < 0.0) & (new_v > 0.0))
        at[W], at[V] = where(taken, new_w, w), where(taken, new_v, v)
        at[SINE], at[COSINE] = where(taken, new_sine, sine), where(taken, new_cosine, cosine)
        at[TIME] = where(taken, at[TIME] + lapse, at[TIME])
        at[STEPS] = where(taken, at[STEPS] + 1.0, at[STEPS])
        return builder.zext(builder.bitcast((~taken).value, ir.IntType(w.lanes)), INTEGER)

    return types.int64(lanes, memory), code


def new_memory(lanes: int) -> np.ndarray:
    """The memory of a number of lanes, aligned to LINE, all zero."""
    numbers = np.zeros(ROWS * lanes + LINE // 8)
    first = (-numbers.ctypes.data % LINE) // 8
    return numbers[first : first + ROWS * lanes].reshape(ROWS, lanes)


@compiled
def can_follow(c):
    """Whether lanes can take the contact steps of a conveyor with these contact.Constants."""
    return contact.is_hertz(c) and c.tension == model.TENSION_ALLOW


@compiled_into_callers
def refill(lane, trajectories, waiting, running, count):
    """Give a lane the next trajectory, or NONE.

    Parameters
    ----------
    trajectories : int64, shape (lanes,), the number of the trajectory that each lane follows; changed
    waiting, running : the first trajectory that no lane has had yet; a bit for each lane with a trajectory
    count : the number of trajectories

    Returns
    -------
    waiting, running : from now on
    """
    if waiting == count:
        trajectories[lane] = NONE
        return waiting, running & ~(1 << lane)
    trajectories[lane] = waiting
    return waiting + 1, running | (1 << lane)


@compiled_inline
def set_constants(memory, lane, c):
    """Write the Constants of a lane into the memory."""
    memory[GRAVITY, lane] = c.gravity
    memory[A_Z, lane] = c.a_z
    memory[OMEGA, lane] = c.omega
    memory[STIFFNESS, lane] = c.stiffness
    memory[DAMPING, lane] = c.damping
    memory[TOLERANCE, lane] = c.tolerance
    memory[SCALE_V, lane] = c.scale_v


@compiled_inline
def set_motion(motion, lane, memory):
    """Write a vertical.Motion in contact into the memory."""
    memory[TIME, lane], memory[W, lane], memory[V, lane] = motion.t, motion.w, motion.v
    memory[SINE, lane], memory[COSINE, lane] = motion.sine, motion.cosine


@compiled_inline
def copy_series(memory, lane, series, at):
    """Copy the series of a lane's step into a contact.workspace, from row `at` on."""
    for row in range(len(KEPT)):
        for n in range(ORDER + 1):
            series[at + row, n] = memory[SERIES + SIZE * row + n, lane]
