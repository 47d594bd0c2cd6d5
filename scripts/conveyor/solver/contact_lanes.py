"""Contact steps of several parts side by side, one in each lane of the processor's vector registers.

Most contact steps end where their series does: with no event, within the time that is left. Such steps are taken here,
with the operations of contact.py in the order of that code, so that a lane gives its very bits. Where an event may be
in the step, the lane is left to the scalar code with its series. Hertz contacts (exponent 1.5) of parts whose contact
force may pull only.
"""

from types import FunctionType

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from . import contact, model, unrolled
from .jit import compiled, compiled_inline, compiled_into_callers
from .polynomial import ORDER, SIZE
from .vectors import FLOAT, INTEGER, Memory, Vector, anywhere, call, fma, where

# The rows of the memory, which has a column for each lane. First of all what `expand` starts from, in this order: √
# penetration (√m), speed of approach (m/s), sine and cosine of the phase; the constants of contact.Constants.
W, V, SINE, COSINE, GRAVITY, A_Z, OMEGA, STIFFNESS, DAMPING = range(9)
# Further constants; the time and when it is over (s); the steps that were taken and how many may be; the length in s up
# to which the series is good, and the time (s) that a step of this length takes.
TOLERANCE, SCALE_V, TIME, END, STEPS, MOST, LENGTH, LAPSE = range(9, 17)
# Row SERIES + SIZE k + n holds coefficient n of row k of a workspace's step.
SERIES = 17
KEPT = (contact.W, contact.T, contact.V, contact.SINE, contact.COSINE)
ROWS = SERIES + SIZE * len(KEPT)

LINE = 64  # bytes, of a register and of the processor's cache: a vector that is not aligned to it costs two accesses
HUGE = 1e300

# The straight-line code of the expansion, for Vectors.
expand = FunctionType(unrolled.expand_hertz.__code__, {"fma": fma})


def power(x: Vector, exponent: float, wanted: Vector) -> Vector:
    """x^exponent by the C library, lane after lane, where it is `wanted`; HUGE elsewhere."""
    builder = x.builder
    found = cgutils.alloca_once_value(builder, x.like(HUGE).value)
    function = cgutils.get_or_insert_function(builder.module, ir.FunctionType(FLOAT, [FLOAT, FLOAT]), "llvm.pow.f64")
    with builder.if_then(anywhere(wanted)):
        for lane in map(ir.IntType(32), range(x.lanes)):
            with builder.if_then(builder.extract_element(wanted.value, lane)):
                one = builder.call(function, [builder.extract_element(x.value, lane), FLOAT(exponent)])
                builder.store(builder.insert_element(builder.load(found), one, lane), found)
    return Vector(builder, builder.load(found))


def maximum(a: Vector, b: Vector) -> Vector:
    return where(b > a, b, a)


def step_length(at: Memory, series: dict[tuple[int, int], Vector]) -> Vector:
    """Length in s at which the last two terms of the series are below the tolerance, see contact.step_length."""
    w, v = at[W], at[V]
    square = w * w
    energy = v * v + 2.0 * at[STIFFNESS] * (square * square * w) / 2.5
    scale = maximum(call("sqrt", energy), at[SCALE_V])
    allowed = at[TOLERANCE] * scale
    turn = maximum(abs(series[contact.SINE, ORDER]), abs(series[contact.COSINE, ORDER]))
    last = maximum(abs(series[contact.V, ORDER]), scale * turn)
    before = abs(series[contact.V, ORDER - 1])
    length = power(allowed / before, 1.0 / (ORDER - 1), before > 0.0)
    shorter = power(allowed / last, 1.0 / ORDER, last * length > before)
    return where(shorter < length, shorter, length)


def value(series: dict[tuple[int, int], Vector], row: int, s: Vector) -> Vector:
    """Σ c_n sⁿ, see polynomial.value; what that begins with, zeros, is left out."""
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
    """Expand the motion of each lane into its SERIES, LENGTH, and take the step where no event can be in it.

    lanes, memory : their number, and float64, shape (ROWS, lanes)
    Returns an integer with a bit for each lane: 1 where the motion stays, for contact.end_step to find where it ends.
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
        # What is no number is not smaller than any.
        proper = (new_w < HUGE) & (abs(new_v) < HUGE) & (lapse <= at[END] - at[TIME]) & (at[STEPS] < at[MOST])
        taken = proper & (new_w > 0.0) & ~((v < 0.0) & (new_v > 0.0))
        at[W], at[V] = where(taken, new_w, w), where(taken, new_v, v)
        at[SINE], at[COSINE] = where(taken, new_sine, sine), where(taken, new_cosine, cosine)
        at[TIME] = where(taken, at[TIME] + lapse, at[TIME])
        at[STEPS] = where(taken, at[STEPS] + 1.0, at[STEPS])
        return builder.zext(builder.bitcast((~taken).value, ir.IntType(w.lanes)), INTEGER)

    return types.int64(lanes, memory), code


@compiled
def room(lanes):
    """Room for the motions in lanes, all zero."""
    numbers = np.zeros(ROWS * lanes + LINE // 8)
    first = (-numbers.ctypes.data % LINE) // 8
    return numbers[first : first + ROWS * lanes].reshape(ROWS, lanes)


@compiled
def possible(c):
    """Whether steps of a conveyor with these contact.Constants can be taken here."""
    return contact.is_hertz(c) and c.tension == model.TENSION_ALLOW


@compiled_into_callers
def first_from(row, parameters, tolerance, left):
    """The first row, from number `row` on, that lanes can follow, or the number of rows; those before are `left`."""
    while row < len(parameters) and not possible(contact.constants(parameters[row], tolerance)):
        left[row] = True
        row += 1
    return row


@compiled_inline
def enter(memory, lane, c, most):
    """Write the Constants of a lane into the memory, and how many steps it may take before it is asked for."""
    memory[GRAVITY, lane] = c.gravity
    memory[A_Z, lane] = c.a_z
    memory[OMEGA, lane] = c.omega
    memory[STIFFNESS, lane] = c.stiffness
    memory[DAMPING, lane] = c.damping
    memory[TOLERANCE, lane] = c.tolerance
    memory[SCALE_V, lane] = c.scale_v
    memory[MOST, lane] = most


@compiled_inline
def return_to_lane(motion, lane, memory):
    """Let a vertical.Motion in contact go on with the others."""
    memory[TIME, lane], memory[W, lane], memory[V, lane] = motion.t, motion.w, motion.v
    memory[SINE, lane], memory[COSINE, lane] = motion.sine, motion.cosine


@compiled_inline
def fetch(memory, lane, series, at):
    """Copy the series of a lane's step into a contact.workspace, from row `at` on."""
    for row in range(len(KEPT)):
        for n in range(ORDER + 1):
            series[at + row, n] = memory[SERIES + SIZE * row + n, lane]
