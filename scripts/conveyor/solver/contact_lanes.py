"""Contact steps of several trajectories side by side, which halves the time of labels.

`step` calls the functions of contact in plain loops over the lanes, which LLVM turns into vector code. A step in which
an event may be ends in contact, for its lane alone. Lanes follow Hertz contacts (exponent 1.5) whose force may pull.
All plates have the same number of harmonics.
"""

import numpy as np

from . import contact, model, plate, workspace
from .contact_law import expand_harmonic_hertz, expand_hertz
from .jit import compiled, compiled_inline, compiled_into_callers
from .pieces import MAX_PIECES
from .polynomial import ORDER, value_in_lane

# Eight lanes take about a tenth less time than four, also in code for registers of four numbers. A NumPy integer, see
# polynomial.FIRST_ROW.
LANES = np.int64(8)

# The rows of the memory, which has a column for each lane. The first nine are the arguments of `expand_hertz`, in its
# order: √penetration (√m), speed of approach (m/s), sine and cosine of the phase, and contact.Constants.
W, V, SINE, COSINE, GRAVITY, A_Z, OMEGA, STIFFNESS, DAMPING = range(9)
# Further constants; the time and the end of the motion (s); the number of steps taken, up to MAX_PIECES; the length of
# the step in the variable s up to which the series holds.
TOLERANCE, SCALE_V, TIME, END, STEPS, LENGTH = range(9, 15)
RATIO, ROOT = range(15, 17)  # contact.limiting_term
COS_SHIFT, SIN_SHIFT = range(17, 19)
# Row SERIES + row + n holds coefficient n of a row of a workspace's step, of which a lane keeps the first ones.
# Harmonics follow.
SERIES = 19
KEPT = (workspace.W, workspace.T, workspace.V, workspace.SINE, workspace.COSINE)
WAVES = SERIES + workspace.STEP

LINE = 64  # bytes, of a register and of a cache line
HUGE = 1e300
NONE = -1  # the row of a lane without a trajectory


@compiled_inline
def place(row, lane):
    """The place in the memory, as a flat array, of the number in a row and a lane; all unsigned."""
    return np.uint64(LANES * row) + lane


@compiled_inline
def value(memory, row, lane, s):
    """The value at `s` of a row of the series in a lane."""
    return value_in_lane(memory, place(SERIES + row, lane), np.uint64(LANES), s)


@compiled_inline
def step(memory, lanes, harmonics):
    """Expand the motions of the first `lanes` lanes, and take the steps in which no event can be.

    `harmonics` is the number of harmonics, which the compiler must know, because it writes the loop over them out; None
    for plates without. Returns an integer with a bit for each lane: 1 if the lane keeps its motion, so that
    contact.end_step must end it.

    The number of lanes is an argument because LLVM would unroll a short loop of constant length before it copies the
    functions into it. Unsigned places in one array spare it checks whether numbers overlap.
    """
    stride = np.uint64(LANES)
    if harmonics is not None:
        # A loop of its own, because the orders of the harmonics are not known.
        for k in range(lanes):
            lane = np.uint64(k)
            shift = memory[place(COS_SHIFT, lane)], memory[place(SIN_SHIFT, lane)]
            phase = memory[place(SINE, lane)], memory[place(COSINE, lane)]
            plate.begin_waves(memory, place(SERIES, lane), place(WAVES, lane), stride, harmonics, *shift, *phase)
    for k in range(lanes):
        lane = np.uint64(k)
        at = place(SERIES, lane)
        w, v, stiffness = memory[place(W, lane)], memory[place(V, lane)], memory[place(STIFFNESS, lane)]
        sine, cosine = memory[place(SINE, lane)], memory[place(COSINE, lane)]
        gravity, a_z, omega = memory[place(GRAVITY, lane)], memory[place(A_Z, lane)], memory[place(OMEGA, lane)]
        constants = gravity, a_z, omega, stiffness, memory[place(DAMPING, lane)]
        if harmonics is not None:
            shift = memory[place(COS_SHIFT, lane)], memory[place(SIN_SHIFT, lane)]
            waves = place(WAVES, lane), harmonics, *shift
            expand_harmonic_hertz(w, v, sine, cosine, *constants, memory, at, stride, False, *waves)
        else:
            expand_hertz(w, v, sine, cosine, *constants, memory, at, stride, False)
        tolerance, scale_v = memory[place(TOLERANCE, lane)], memory[place(SCALE_V, lane)]
        ratio, root = contact.limiting_term(memory, at, stride, tolerance, scale_v, stiffness, 1.5, w, v)
        memory[place(RATIO, lane)], memory[place(ROOT, lane)] = ratio, root
    # A loop of its own, because powers take one number at a time.
    for k in range(lanes):
        lane = np.uint64(k)
        length = memory[place(RATIO, lane)] ** memory[place(ROOT, lane)]
        at, tolerance = place(SERIES, lane), memory[place(TOLERANCE, lane)]
        memory[place(LENGTH, lane)] = min(length, plate.series_length(harmonics, memory, at, stride, tolerance))
    stopped = np.uint64(0)
    for k in range(lanes):
        lane = np.uint64(k)
        length = memory[place(LENGTH, lane)]
        w, v = memory[place(W, lane)], memory[place(V, lane)]
        sine, cosine = memory[place(SINE, lane)], memory[place(COSINE, lane)]
        time, steps = memory[place(TIME, lane)], memory[place(STEPS, lane)]
        new_w, new_v = value(memory, workspace.W, lane, length), value(memory, workspace.V, lane, length)
        lapse = value(memory, workspace.T, lane, length)
        # Comparisons with NaN are false.
        proper = (new_w < HUGE) & (abs(new_v) < HUGE)
        proper &= (lapse <= memory[place(END, lane)] - time) & (steps < MAX_PIECES)
        taken = proper & (new_w > 0.0) & ~((v < 0.0) & (new_v > 0.0))
        new_sine = value(memory, workspace.SINE, lane, length)
        new_cosine = value(memory, workspace.COSINE, lane, length)
        memory[place(W, lane)] = new_w if taken else w
        memory[place(V, lane)] = new_v if taken else v
        memory[place(SINE, lane)] = new_sine if taken else sine
        memory[place(COSINE, lane)] = new_cosine if taken else cosine
        memory[place(TIME, lane)] = time + lapse if taken else time
        memory[place(STEPS, lane)] = steps + 1.0 if taken else steps
        stopped |= np.uint64(not taken) << lane
    return np.int64(stopped)


def row_count(harmonics: int | None) -> int:
    """The number of rows of a memory for plates with a number of harmonics, or None."""
    return WAVES + workspace.WAVE * (harmonics or 0)


def new_memory(rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A memory, all zero, as a flat array for loops over the lanes, and the same memory with the shape (rows, LANES).

    It begins at a cache line, because a vector that crosses a line costs two accesses.
    """
    numbers = np.zeros(rows * LANES + LINE // 8)
    first = (-numbers.ctypes.data % LINE) // 8
    memory = numbers[first : first + rows * LANES]
    return memory, memory.reshape(rows, LANES)


@compiled
def can_follow(c):
    """Whether lanes can take the contact steps of a conveyor with these contact.Constants."""
    return c.exponent == 1.5 and c.tension == model.TENSION_ALLOW


@compiled_into_callers
def refill(lane, trajectories, waiting, running, count):
    """Give a lane the next trajectory, or NONE; returns the new `waiting` and `running`.

    Parameters
    ----------
    trajectories : int64, shape (lanes,), the number of the trajectory that each lane follows; changed
    waiting, running : the first trajectory that no lane has had yet; a bit for each lane with a trajectory
    count : the number of trajectories
    """
    if waiting == count:
        trajectories[lane] = NONE
        return waiting, running & ~(1 << lane)
    trajectories[lane] = waiting
    return waiting + 1, running | (1 << lane)


@compiled_inline
def set_constants(flat, memory, lane, c):
    """Write the Constants of a lane into the memory."""
    memory[GRAVITY, lane] = c.gravity
    memory[A_Z, lane] = c.a_z
    memory[OMEGA, lane] = c.omega
    memory[STIFFNESS, lane] = c.stiffness
    memory[DAMPING, lane] = c.damping
    memory[TOLERANCE, lane] = c.tolerance
    memory[SCALE_V, lane] = c.scale_v
    memory[COS_SHIFT, lane], memory[SIN_SHIFT, lane] = c.cos_shift, c.sin_shift
    plate.write_waves(c.waves, flat, place(WAVES, np.uint64(lane)), np.uint64(LANES))


@compiled_inline
def set_motion(motion, lane, memory):
    """Write a vertical.Motion in contact into the memory."""
    memory[TIME, lane], memory[W, lane], memory[V, lane] = motion.t, motion.w, motion.v
    memory[SINE, lane], memory[COSINE, lane] = motion.sine, motion.cosine


@compiled_inline
def copy_series(memory, lane, series, at):
    """Copy the series of a lane's step into a contact.workspace, from row `at` on."""
    for row in KEPT:
        for n in range(ORDER + 1):
            series[np.uint64(at + row + n)] = memory[SERIES + row + n, lane]
