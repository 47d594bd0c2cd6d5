"""One step of each scheme in one lane: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

A lane is a column of a memory that holds a trajectory: its results so far, the forces at the present step, and the
constants of its conveyor. All functions are copied into the loops of fixed_step_lanes.
"""

from typing import NamedTuple

import numpy as np

from ..parameters import FIXED_STEP_METHODS as METHODS
from ..solver import plate
from ..solver.contact_lanes import LANES, place
from ..solver.jit import compiled_inline, compiled_into_callers
from .force_law import contact_acceleration, friction_acceleration, power_of_depth, simple_power
from .sine import sine_and_cosine

EULER, SEMI_IMPLICIT_EULER, RK4 = range(len(METHODS))
# Evaluations of the forces in a step of each method.
EVALUATIONS = (1, 1, 4)

# The columns of a trajectory's results, and the first rows of the memory, which has a column for each lane. In the
# memory CONTACT_TIME is a number of steps, and PEAK_FORCE is per mass. IMPACT_SPEED and PEAK_FORCE count since the last
# sample.
X, VX, Z, VZ, EVENTS, IMPACTS, CONTACT_TIME, MAX_GAP, FORCE_EVALUATIONS, STATUS, IMPACT_SPEED, PEAK_FORCE = range(12)
RESULTS = 12
# At the present step: gap (m), forces per mass (m/s²), whether the gap was last seen closed (1 or 0), the slip velocity
# (m/s) at the last step.
GAP, PUSH, RUB, IN_CONTACT, LAST_SLIP = range(12, 17)
# Constants: ω (rad/s), ψ0 (rad), plate.amplitudes; k_c/m, d_c/m, p, μ, μ_s, gravity normal to the track and down along
# it (m/s²); force_law.least_push and least_rub; cosine and sine of the phase shift.
OMEGA, PSI0, PLATE_Z, PLATE_VZ, PLATE_VX, PLATE_AX = range(17, 23)
STIFFNESS, DAMPING, EXPONENT, FRICTION, STATIC_FRICTION, GRAVITY, DOWNHILL = range(23, 30)
LEAST_PUSH, LEAST_RUB, COS_SHIFT, SIN_SHIFT = range(30, 34)
# The numbers of the plate's harmonics, as many as in the packed parameters.
WAVES = 34


class Kind(NamedTuple):
    """What the steps are compiled for, because steps that need less take less time.

    The vanished slip of `sticks` takes a sixth of the time of a sweep, `alike` plates save nearly half of it.
    """

    method: int  # the code of one of METHODS
    single: bool  # whether there is one trajectory only
    alike: bool  # whether all plates have the same Shapes
    sticks: bool  # whether there are static frictions larger than the friction
    has_powers: bool  # whether there are exponents other than 1 and 1.5
    # For each order from 0 to the highest, the first row of its harmonic in the memory, or 0; None without harmonics.
    waves: tuple[int, ...] | None


@compiled_inline
def shapes_at(kind, memory, lane, phase):
    """The Shapes of a plate at a phase (rad)."""
    sine, cosine = sine_and_cosine(phase)
    along = plate.add_phases(sine, cosine, memory[place(SIN_SHIFT, lane)], memory[place(COS_SHIFT, lane)])
    return add_waves(kind.waves, memory, lane, plate.shapes(sine, cosine, *along), sine, cosine)


@compiled_inline
def add_waves(waves, memory, lane, shapes, sine, cosine):
    """The Shapes with the harmonics of Kind.waves, at the phase with a sine and cosine."""
    if waves is None:
        return shapes
    added, s, c = plate.NO_SUMS, sine, cosine
    # A single loop whose bounds are known: LLVM writes it out. Else the loops over the lanes would not become vector
    # code, and steps with two harmonics would take eight times as long as without.
    for order in range(2, len(waves)):
        s, c = plate.add_phases(s, c, sine, cosine)
        if waves[order] > 0:
            harmonic = plate.numbers_at(memory, place(waves[order], lane), np.uint64(LANES))
            # The order is known to the compiler, which then divides by a constant.
            added = plate.add_harmonic(added, (float(order), *harmonic[1:]), s, c)
    return plate.add_sums(shapes, added)


@compiled_inline
def turn_plate(kind, memory, lane, i, step):
    """The plate's Shapes in step number i, of a length (s): at its end, where the next forces act.

    For RK4 also in its middle and, as reckoned from its beginning, at its end; else these are the first again.
    """
    omega, psi0 = memory[place(OMEGA, lane)], memory[place(PSI0, lane)]
    end = shapes_at(kind, memory, lane, omega * ((i + 1) * step) + psi0)
    if kind.method != RK4:
        return end, end, end
    phase, turn = omega * (i * step) + psi0, omega * step
    middle = shapes_at(kind, memory, lane, phase + 0.5 * turn)
    return end, middle, shapes_at(kind, memory, lane, phase + turn)


@compiled_inline
def written_shapes(shapes, at, stride):
    """The Shapes at a place of an array, whose four numbers have a distance of `stride`."""
    return plate.Shapes(
        shapes[at], shapes[at + stride], shapes[at + stride + stride], shapes[at + stride + stride + stride]
    )


@compiled_inline
def forces(kind, memory, lane, vx, z, vz, shapes):
    """Gap (m), F_c/m, F_r/m (m/s², Eqs. 7, 11 and 12) and slip velocity (m/s) of a state."""
    gap = z - memory[place(PLATE_Z, lane)] * shapes.z
    exponent = memory[place(EXPONENT, lane)]
    power = power_of_depth(-gap, exponent) if kind.has_powers else simple_power(-gap, exponent)
    push = contact_acceleration(
        gap,
        memory[place(PLATE_VZ, lane)] * shapes.vz - vz,
        power,
        memory[place(STIFFNESS, lane)],
        memory[place(DAMPING, lane)],
        memory[place(LEAST_PUSH, lane)],
    )
    slip = memory[place(PLATE_VX, lane)] * shapes.vx - vx
    rub = friction_acceleration(push, slip, memory[place(FRICTION, lane)], memory[place(LEAST_RUB, lane)])
    return gap, push, rub, slip


@compiled_into_callers
def stick(memory, lane, gap, push, rub, slip, shapes):
    """F_r/m of a part that sticks if its slip has vanished, or `rub`; a part that sticks gets the plate's velocity."""
    vx = memory[place(VX, lane)]
    pull = memory[place(PLATE_AX, lane)] * shapes.ax + memory[place(DOWNHILL, lane)]
    static_friction = memory[place(STATIC_FRICTION, lane)]
    vanished = (static_friction > memory[place(FRICTION, lane)]) & (memory[place(LAST_SLIP, lane)] * slip <= 0.0)
    sticks = (gap <= 0.0) & vanished & (abs(pull) <= static_friction * push)
    memory[place(VX, lane)] = vx + slip if sticks else vx
    memory[place(LAST_SLIP, lane)] = 0.0 if sticks else slip
    return pull if sticks else rub


@compiled_inline
def find_forces(kind, memory, lane, shapes):
    """Write GAP, PUSH and RUB of the present state. Returns whether the gap has opened or closed."""
    vx, z, vz = memory[place(VX, lane)], memory[place(Z, lane)], memory[place(VZ, lane)]
    gap, push, rub, slip = forces(kind, memory, lane, vx, z, vz, shapes)
    if kind.sticks:
        rub = stick(memory, lane, gap, push, rub, slip, shapes)
    memory[place(GAP, lane)], memory[place(PUSH, lane)], memory[place(RUB, lane)] = gap, push, rub
    return (gap <= 0.0) != (memory[place(IN_CONTACT, lane)] > 0.0)


@compiled_into_callers
def count_step(memory, lane):
    """Update the totals over the run before a step is taken."""
    gap, push = memory[place(GAP, lane)], memory[place(PUSH, lane)]
    highest, strongest = memory[place(MAX_GAP, lane)], memory[place(PEAK_FORCE, lane)]
    # Without the zeros LLVM stores only where a number changes, and the next load waits for it.
    memory[place(MAX_GAP, lane)] = (gap if gap > highest else highest) + 0.0
    memory[place(PEAK_FORCE, lane)] = (push if push > strongest else strongest) + 0.0
    memory[place(CONTACT_TIME, lane)] += 0.0 if push == 0.0 else 1.0


@compiled_into_callers
def rk4_step(kind, memory, lane, state, gravity, downhill, shapes, step):
    """(x, vx, z, vz) one classical Runge-Kutta step (s) later; the rest as in `take_step`."""
    x, vx1, z, vz1 = state
    push1, rub1 = memory[place(PUSH, lane)], memory[place(RUB, lane)]
    half = 0.5 * step
    _, middle, end = shapes
    vx2, vz2 = vx1 + half * (rub1 - downhill), vz1 + half * (push1 - gravity)
    _, push2, rub2, _ = forces(kind, memory, lane, vx2, z + half * vz1, vz2, middle)
    vx3, vz3 = vx1 + half * (rub2 - downhill), vz1 + half * (push2 - gravity)
    _, push3, rub3, _ = forces(kind, memory, lane, vx3, z + half * vz2, vz3, middle)
    vx4, vz4 = vx1 + step * (rub3 - downhill), vz1 + step * (push3 - gravity)
    _, push4, rub4, _ = forces(kind, memory, lane, vx4, z + step * vz3, vz4, end)
    return (
        x + step / 6.0 * (vx1 + 2.0 * (vx2 + vx3) + vx4),
        vx1 + step / 6.0 * (rub1 + 2.0 * (rub2 + rub3) + rub4) - step * downhill,
        z + step / 6.0 * (vz1 + 2.0 * (vz2 + vz3) + vz4),
        vz1 + step * ((push1 + 2.0 * (push2 + push3) + push4) / 6.0 - gravity),
    )


@compiled_into_callers
def take_step(kind, memory, lane, shapes, step):
    """Advance a state by one step (s), with the forces in memory; `shapes` are those of `turn_plate`."""
    x, vx, z, vz = memory[place(X, lane)], memory[place(VX, lane)], memory[place(Z, lane)], memory[place(VZ, lane)]
    gravity, downhill = memory[place(GRAVITY, lane)], memory[place(DOWNHILL, lane)]
    if kind.method == RK4:
        x, vx, z, vz = rk4_step(kind, memory, lane, (x, vx, z, vz), gravity, downhill, shapes, step)
    else:
        next_vx = vx + step * (memory[place(RUB, lane)] - downhill)
        next_vz = vz + step * (memory[place(PUSH, lane)] - gravity)
        if kind.method == EULER:
            x, z = x + step * vx, z + step * vz
        else:
            x, z = x + step * next_vx, z + step * next_vz
        vx, vz = next_vx, next_vz
    memory[place(X, lane)], memory[place(VX, lane)], memory[place(Z, lane)], memory[place(VZ, lane)] = x, vx, z, vz
