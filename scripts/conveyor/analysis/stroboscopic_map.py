"""The stroboscopic map: the vertical motion over exactly one excitation cycle, and its linearisation.

A state is the pair (δ, v) at the phase ψ0: penetration δ = z_s - z_p (m, negative in flight) and its rate v (m/s). The
pair determines the motion, since contact is δ > 0 and the sign of the contact force follows from δ and v.

Perturbations belong to (δ, Y) with Y = v + (d_c/m) max(δ, 0), for which the equations of motion

    δ̇ = Y - (d_c/m) max(δ, 0),   Ẏ = g + z̈_s - (k_c/m) max(δ, 0)^p

are continuous across impact and separation, so that the linearised flow needs no jump there. Its determinant over a
cycle is exp(-(d_c/m) T_contact), where T_contact is the time with a contact force. While the force would pull, `clip`
switches the damping off; the force is continuous there, and v takes the place of Y. Both Y and the determinant are
those of the contact law.
"""

import math
from collections.abc import Callable

import numpy as np

from ..solver import contact, contact_law, pieces, plate, polynomial, vertical, workspace
from ..solver.contact_law import ETA, ZETA, expand_tangents
from ..solver.jit import compiled, compiled_inline, copy
from ..solver.model import PSI0, TENSION_CLIP, VZ0, Z0
from ..solver.polynomial import ORDER, SIZE
from ..solver.status import OK
from ..solver.vertical import CONTACT, FLIGHT, LANDING, TIME_LIMIT
from ..solver.workspace import FIRST

# Longest period of a motion that is looked for, in excitation cycles.
MAX_PERIOD = 64
HIDDEN = 1e-6  # a determinant that is a smaller share of its two products is lost in rounding
# Features of a cycle.
IMPACTS, CONTACT_TIME, DAMPER_TIME, LONGEST_FLIGHT, AIRBORNE = range(5)
FEATURES = 5
AT_ONCE = 20_000  # cycles in one call of compiled code, during which Ctrl-C waits


def initial_states(parameters: np.ndarray, tolerance: float) -> np.ndarray:
    """States (δ in m, v in m/s), shape (n, 2), of the initial conditions in `parameters`, shape (n, 16)."""
    return find_initial_states(parameters, tolerance, plate.count_harmonics(parameters))


@compiled
def find_initial_states(parameters, tolerance, harmonics):
    """The compiled part of `initial_states`; `harmonics` as from plate.count_harmonics."""
    states = np.empty((len(parameters), 2))
    for i in range(len(parameters)):
        c = contact.compute_constants(parameters[i], tolerance, harmonics)
        q, rate = vertical.begin(c, parameters[i, Z0], parameters[i, VZ0], c.psi0)
        states[i, 0], states[i, 1] = -q, -rate
    return states


@compiled
def tangent_length(c, expansions):
    """Length of the step in the variable s up to which the expansions of all perturbations are accurate.

    The last two terms of η and ζ are below the tolerance there.
    A perturbation rings at the frequency of the contact, even if the motion itself is slow or at rest.
    """
    length = 1e300
    for order in (ORDER - 1, ORDER):
        allowed = math.inf
        for i in range(expansions.shape[0]):
            scale = c.omega * abs(expansions[i, ETA, 0]) + abs(expansions[i, ZETA, 0])
            last = max(c.omega * abs(expansions[i, ETA, order]), abs(expansions[i, ZETA, order]))
            if last > 0.0:
                allowed = min(allowed, c.tolerance * scale / last)
        length = min(length, allowed ** (1.0 / order))
    return length


@compiled_inline
def advance_tangent(c, series, tangent, expansions, motion, piece):
    """Advance perturbations of (δ, Y), rows of `tangent`, along a piece, and return the piece.

    A contact step is cut where the expansion of a perturbation is no longer accurate.
    """
    if piece.kind != CONTACT:
        # In flights and moments of rest at the surface the plate does not push.
        for i in range(tangent.shape[0]):
            tangent[i, 0] += tangent[i, 1] * piece.duration
        return piece
    for i in range(tangent.shape[0]):
        expansions[i, ETA, 0], expansions[i, ZETA, 0] = tangent[i, 0], tangent[i, 1]
    expand_tangents(c, series, FIRST, expansions, motion.pulled and c.tension == TENSION_CLIP)
    longest = tangent_length(c, expansions)
    if longest < piece.length:
        duration = polynomial.value(series, FIRST + workspace.T, longest)
        piece = vertical.cut_step(series, FIRST, longest, duration, contact.NOTHING)
    for i in range(tangent.shape[0]):
        tangent[i, 0] = polynomial.value(expansions[i, ETA], 0, piece.length)
        tangent[i, 1] = polynomial.value(expansions[i, ZETA], 0, piece.length)
    if piece.end == contact.FORCE_SIGN:
        switch_damping(c, tangent, piece.w, not motion.pulled)
    return piece


@compiled_inline
def switch_damping(c, tangent, w, pulled):
    """Change perturbations from Y to v where `clip` switches the damping off (`pulled`) at w = √δ, and back."""
    if c.tension == TENSION_CLIP:
        sign = -1.0 if pulled else 1.0
        for i in range(tangent.shape[0]):
            tangent[i, 1] += sign * contact_law.smooth_slope(c, w * w) * tangent[i, 0]


@compiled_inline
def delta_and_v(motion):
    """The state, δ (m) and v (m/s), of a Motion."""
    if motion.touching:
        return motion.w * motion.w, motion.v
    # Up to rounding a part in flight is above the plate.
    return -max(motion.q, 0.0), -motion.rate


@compiled_inline
def count_piece(c, series, motion, piece, features):
    """Count a Piece that begins with a Motion among the features of its cycle."""
    if piece.kind == FLIGHT:
        features[AIRBORNE] += piece.duration
        if piece.end == LANDING:
            features[IMPACTS] += 1.0
            features[LONGEST_FLIGHT] = max(features[LONGEST_FLIGHT], features[AIRBORNE])
            features[AIRBORNE] = 0.0
    elif piece.kind == CONTACT and not (motion.pulled and c.tension == TENSION_CLIP):
        features[CONTACT_TIME] += piece.duration
        features[DAMPER_TIME] += contact_law.damper_time(c, series, FIRST, piece.length, piece.duration)


@compiled
def advance(c, series, state, phase, duration, tangent, features):
    """Advance `state` from a phase of the excitation by a time of at most one cycle; a code of status.STATUS.

    Parameters
    ----------
    c, series : contact.Constants and a contact.workspace to work in
    state : float64, shape (2,), δ (m) and v (m/s) at `phase` (rad); replaced
    duration : s
    tangent : float64, shape (2, 2), two perturbations of (δ, Y), replaced; shape (0, 2) for none
    features : float64, shape (5,), replaced: number of impacts, time with contact force (s), its
        `contact_law.damper_time` (s), longest flight that ended (s); AIRBORNE, the time (s) since the last separation,
        goes on from its last value
    """
    # Numbers of both perturbations lie side by side, so that one instruction works on both.
    expansions = np.zeros((SIZE, 3, tangent.shape[0])).T
    features[IMPACTS] = features[CONTACT_TIME] = features[DAMPER_TIME] = features[LONGEST_FLIGHT] = 0.0
    clock = pieces.clock_of(phase, 0)
    motion = vertical.motion_at(c, -state[0], -state[1], 0.0, phase)
    if motion.pulled:
        switch_damping(c, tangent, motion.w, True)
    while True:
        piece, after, next_clock, status = pieces.advance(c, series, clock, motion, duration - motion.t, False)
        if tangent.shape[0] > 0:
            length = piece.length
            piece = advance_tangent(c, series, tangent, expansions, motion, piece)
            if piece.length < length:
                after, next_clock, status = pieces.end_piece(c, series, clock, motion, piece)
        if status != OK:
            return status
        count_piece(c, series, motion, piece, features)
        motion, clock = after, next_clock
        if piece.end == TIME_LIMIT:
            if motion.pulled:
                switch_damping(c, tangent, motion.w, False)
            state[0], state[1] = delta_and_v(motion)
            return OK


def follow_map(
    parameters: np.ndarray,
    tolerance: float,
    state: np.ndarray,
    cycles: int,
    count: Callable[[int], object] = lambda cycles: None,
) -> tuple[int, np.ndarray]:
    """Advance `state` by a number of cycles.

    A motion that returns to a state bit for bit repeats itself from then on, and is copied. Most settled motions do.

    Parameters
    ----------
    parameters : float64, shape (16,)
    tolerance : of the contact steps
    state : float64, shape (2,), δ (m) and v (m/s) at the phase ψ0; replaced by the last state
    cycles : excitation cycles
    count : is called with numbers of cycles that are done

    Returns
    -------
    status : code of status.STATUS
    strobes : float64, shape (cycles, 2), δ and v after each cycle; NaN from a failure on
    """
    strobes = np.full((cycles, 2), np.nan)
    status, harmonics = OK, plate.count_harmonics(parameters)
    for begin in range(0, cycles, AT_ONCE):
        part = strobes[begin : begin + AT_ONCE]
        status = fill_map(parameters, tolerance, harmonics, state, part)
        if status != OK:
            break
        count(len(part))
    return status, strobes


@compiled
def fill_map(parameters, tolerance, harmonics, state, strobes):
    """The compiled part of `follow_map`, which fills the array and returns the status.

    Numba runs Python code where a compiled function returns an array. Ctrl-C would be raised there, as a SystemError.
    """
    c = contact.compute_constants(parameters, tolerance, harmonics)
    series = contact.workspace()
    no_tangent, features = np.empty((0, 2)), np.zeros(FEATURES)
    cycles = len(strobes)
    mark = 0  # 0, 1, 3, 7, …: at last one is in the repeated part, a whole period before n (Brent 1980)
    for n in range(cycles):
        status = advance(c, series, state, c.psi0, c.period, no_tangent, features)
        if status != OK:
            return status
        copy(strobes[n], state)
        if mark < n and strobes[n, 0] == strobes[mark, 0] and strobes[n, 1] == strobes[mark, 1]:
            for later in range(n + 1, cycles):
                copy(strobes[later], strobes[later - n + mark])
            copy(state, strobes[cycles - 1])
            return OK
        if n == 2 * mark + 1:
            mark = n
    return OK


@compiled
def hides_determinant(matrix):
    """Whether the determinant of a matrix, shape (2, 2), is lost in rounding, or is not positive."""
    along, across = matrix[0, 0] * matrix[1, 1], matrix[0, 1] * matrix[1, 0]
    return along - across <= HIDDEN * (abs(along) + abs(across))


def monodromy(
    parameters: np.ndarray, tolerance: float, state: np.ndarray, cycles: int, airborne: float
) -> tuple[int, np.ndarray, np.ndarray]:
    """Advance `state` by a number of cycles, with the linearisation of each cycle.

    The monodromy matrix is the product of the matrices, the last one leftmost; its determinant is the product of their
    determinants without loss of digits.

    Parameters
    ----------
    parameters, tolerance, state, cycles : as in `follow_map`
    airborne : time since the last separation, s

    Returns
    -------
    status : code of status.STATUS
    matrices : float64, shape (cycles, 2, 2), ∂(δ, Y)_end/∂(δ, Y)_start of each cycle; 0 behind a failure
    features : float64, shape (cycles, 5), see `advance`; 0 behind a failure
    """
    matrices, features = np.zeros((cycles, 2, 2)), np.zeros((cycles, FEATURES))
    harmonics = plate.count_harmonics(parameters)
    status = fill_monodromy(parameters, tolerance, harmonics, state, airborne, matrices, features)
    return status, matrices, features


@compiled
def fill_monodromy(parameters, tolerance, harmonics, state, airborne, matrices, features):
    """The compiled part of `monodromy`, see `fill_map`."""
    c = contact.compute_constants(parameters, tolerance, harmonics)
    series = contact.workspace()
    cycle_features = np.zeros(FEATURES)
    cycle_features[AIRBORNE] = airborne
    for n in range(len(matrices)):
        tangent = np.eye(2)
        status = advance(c, series, state, c.psi0, c.period, tangent, cycle_features)
        copy(features[n], cycle_features)
        for k in range(2):
            copy(matrices[n, k], tangent[:, k])
        if status != OK:
            return status
    return OK


def repeated_period(strobes: np.ndarray, cycles: int, closeness: float) -> int:
    """The least period, up to MAX_PERIOD cycles, with which a motion repeats itself in its last `cycles`; 0 for none.

    strobes : its states in any units, shape (n, 2)
    closeness : largest difference from the states a period before, in these units
    """
    earlier = strobes[-2 : -2 - MAX_PERIOD : -1]
    for period in np.flatnonzero(np.abs(earlier - strobes[-1]).max(axis=1) <= closeness) + 1:
        before = strobes[max(0, len(strobes) - cycles - period) : len(strobes) - period]
        if len(before) == cycles and np.abs(strobes[-cycles:] - before).max() <= closeness:
            return int(period)
    return 0


def smooth_state(c, state: np.ndarray) -> np.ndarray:
    """δ and Y of a state (δ, v); `c` as for contact_law.smooth_speed."""
    return np.array([state[0], contact_law.smooth_speed(c, state[0], state[1])])


def state_of(c, smooth: np.ndarray) -> np.ndarray:
    """The state (δ, v) of δ and Y, the inverse of `smooth_state`."""
    return np.array([smooth[0], contact_law.speed_of_approach(c, smooth[0], smooth[1])])


def begin_at_top(parameters: np.ndarray) -> np.ndarray:
    """The same conveyors, shape (…, 16), with the phase pieces.BEGIN_OF_CYCLE."""
    parameters = np.array(parameters)
    parameters[..., PSI0] = pieces.BEGIN_OF_CYCLE
    return parameters


def pack_states(parameters: np.ndarray, states: np.ndarray, tolerance: float) -> np.ndarray:
    """Parameter vectors, shape (n, 16), that begin at stroboscopic states (δ in m, v in m/s), shape (n, 2)."""
    packed = np.array(parameters, dtype=np.float64)
    for row, (delta, v) in zip(packed, states, strict=True):
        c = contact.constants(row, tolerance)
        z, vz = plate.height_and_rise(c, *plate.sine_and_cosine(row[PSI0]))
        row[Z0], row[VZ0] = z - delta, vz - v
    return packed
