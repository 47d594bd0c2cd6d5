"""The stroboscopic map to second order: what its linearisation does when the state or a parameter changes.

Perturbations belong to (δ, Y) (see stroboscopic_map) and to six quantities, in this order:

    δ and Y at the beginning of the cycle, a_z (m/s²), d_c/m (1/s), k_c/m (of its unit), p.

The first derivatives solve the linearised equations of motion with the forces that a change of a parameter adds. The
second derivatives, by a state and one of the six quantities, solve the same equations, driven by products of first
derivatives. They jump where δ passes zero with the rate v. The damping has a kink there, whose second derivative is a
Dirac function; for p = 1 the spring has one, too. `clip` has another kink where the force begins or ceases to pull.
"""

import math

import numpy as np

from ..solver import contact, contact_law, plate, polynomial, workspace
from ..solver.contact import FORCE_SIGN, SEPARATION
from ..solver.contact_law import row_of
from ..solver.jit import compiled, compiled_inline, compiled_into_callers, no_refcount
from ..solver.model import TENSION_CLIP
from ..solver.polynomial import ORDER, SIZE
from ..solver.trajectory import IMPACT_LOST, MAX_PIECES, NOT_FINITE, OK, TOO_STIFF
from ..solver.vertical import CONTACT, FLIGHT, IMPACT, LIMIT, LOST, arrive, cut_step, is_finite, motion_at, next_piece
from ..solver.workspace import FIRST
from .stroboscopic_map import delta_and_v, tangent_length

# What is perturbed; the first two are the state.
DELTA, Y, AMPLITUDE, DAMPING, STIFFNESS, EXPONENT = range(6)
QUANTITIES = 6
# Products of perturbations ring at twice the frequency of each perturbation, so that steps are half as long.
PART = 0.5
# The derivative of w^(2p+1) by p has the factor log w, which is singular at w = 0. A step covers this part of the
# distance to w = 0. Below this part of the √penetration at rest the derivative is negligible and left out.
PART_OF_RADIUS = 0.2
LOG_EDGE = 1e-5


@compiled
def log_series(c, series, out):
    """Fill `out`, shape (SIZE,), with the Taylor coefficients of 2 log w of a contact step, 0 where w is left out."""
    w = row_of(series, FIRST + workspace.W)
    out[:] = 0.0
    if w[0] > branch_edge(c):
        out[0] = math.log(w[0])
        for n in range(1, ORDER):
            total = n * w[n]
            for k in range(1, n):
                total -= k * out[k] * w[n - k]
            out[n] = total / (n * w[0])
        for n in range(ORDER):
            out[n] *= 2.0


@compiled_inline
def branch_edge(c):
    """The √penetration (√m) from which on steps keep away from the branch point at w = 0."""
    return c.edge_w if c.edge_w > 0.0 else LOG_EDGE * c.scale_w


@compiled_inline
def product(a, b, n):
    """Coefficient n of the product of two series."""
    total = 0.0
    for k in range(n + 1):
        total += a[k] * b[n - k]
    return total


@compiled
def expand(c, series, first, second, free, count):
    """Taylor coefficients in s of the perturbations along a contact step, from their values at s = 0.

    first : shape (6, 2, SIZE), of δ and Y by each quantity
    second : shape (2, 6, 2, SIZE), of δ and Y by a state and a quantity
    free : whether the contact force is left out
    count : number of quantities that are wanted, from the first one on
    """
    series, first, second = no_refcount((series, first, second))
    w, square = row_of(series, FIRST + workspace.W), row_of(series, FIRST + workspace.SQUARE)
    spring, lift_w = row_of(series, FIRST + workspace.SPRING), row_of(series, FIRST + workspace.LIFT_W)
    damping = 0.0 if free else c.damping
    stiffness = 0.0 if free else c.stiffness
    # w^(2p-1) and w^(2p-3), the first and second derivatives of the spring times w.
    slope, bend = np.zeros(SIZE), np.zeros(SIZE)
    if c.exponent == 1.5:
        slope = square  # and w^(2p-3) is 1
    elif c.exponent == 1.0:
        slope = w
    else:
        contact_law.expand_power(c, series, FIRST, 2.0 * c.exponent - 1.0)
        slope = row_of(series, workspace.SCRATCH).copy()
        contact_law.expand_power(c, series, FIRST, 2.0 * c.exponent - 3.0)
        bend = row_of(series, workspace.SCRATCH).copy()
    # log w² itself, and times the spring's slope: with 1/p times that slope the derivative of p w^(2p-1) by p, over p.
    log, slope_by_exponent = np.zeros(SIZE), np.zeros(SIZE)
    by_exponent = count > EXPONENT
    if by_exponent:
        log_series(c, series, log)
    products = np.zeros((2, QUANTITIES, SIZE))
    for n in range(ORDER):
        if by_exponent:
            slope_by_exponent[n] = product(slope, log, n) + slope[n] / c.exponent
        for j in range(count):
            delta, y = first[j, 0], first[j, 1]
            drift = product(w, y, n) - damping * product(w, delta, n)
            push = -c.exponent * stiffness * product(slope, delta, n)
            if j == AMPLITUDE:
                push += lift_w[n]
            elif j == DAMPING and not free:
                drift -= product(w, square, n)
            elif j == STIFFNESS and not free:
                push -= spring[n]
            elif j == EXPONENT:
                push -= stiffness * product(spring, log, n)
            for i in range(2):
                if i > j:
                    continue  # derivatives by two states do not depend on their order
                of_both = second[i, j]
                products[i, j, n] = product(first[i, 0], delta, n)
                drift_of_both = product(w, of_both[1], n) - damping * product(w, of_both[0], n)
                curvature = products[i, j, n] if c.exponent == 1.5 else product(bend, products[i, j], n)
                pull = stiffness * ((c.exponent - 1.0) * curvature + product(slope, of_both[0], n))
                if j == DAMPING and not free:
                    drift_of_both -= product(w, first[i, 0], n)
                elif j == STIFFNESS and not free:
                    pull += product(slope, first[i, 0], n)
                elif j == EXPONENT:
                    pull += stiffness * product(slope_by_exponent, first[i, 0], n)
                of_both[0, n + 1] = drift_of_both / (n + 1)
                of_both[1, n + 1] = -c.exponent * pull / (n + 1)
                if i < j < 2:
                    second[j, i, 0, n + 1], second[j, i, 1, n + 1] = of_both[0, n + 1], of_both[1, n + 1]
            delta[n + 1] = drift / (n + 1)
            y[n + 1] = push / (n + 1)


@compiled
def cross_surface(c, first, second, speed, w):
    """Jump of second derivatives where δ passes zero at a speed (m/s), due to the kinks of damping and spring.

    The spring contributes up to the √penetration `w` where it is switched on: all for p = 1, nothing for p = 3/2.
    """
    stiffness = c.stiffness * c.exponent * w ** (2.0 * c.exponent - 2.0)
    for i in range(2):
        for j in range(QUANTITIES):
            both = first[i, 0, 0] * first[j, 0, 0] / speed
            second[i, j, 0, 0] -= c.damping * both
            second[i, j, 1, 0] -= stiffness * both


@compiled
def switch(c, first, second, delta, pulled):
    """Change from Y to v = Y - (d_c/m) δ where `clip` switches the damping off (`pulled`), and back."""
    sign = -1.0 if pulled else 1.0
    # The second derivatives by d_c/m contain a first derivative by the state, and so must change before it.
    for i in range(2):
        for j in range(QUANTITIES):
            second[i, j, 1, 0] += sign * c.damping * second[i, j, 0, 0]
        second[i, DAMPING, 1, 0] += sign * first[i, 0, 0]
    for j in range(QUANTITIES):
        first[j, 1, 0] += sign * c.damping * first[j, 0, 0]
    first[DAMPING, 1, 0] += sign * delta


@compiled
def cross_force(c, first, second, w, v, acceleration):
    """Jump of second derivatives where `clip` cuts the force, in (δ, v); `acceleration` is that of δ there (m/s²)."""
    delta = w * w
    slope = c.stiffness * c.exponent * delta ** (c.exponent - 1.0)
    rate = abs(slope * v + c.damping * acceleration)
    change = np.empty(QUANTITIES)
    for j in range(QUANTITIES):
        change[j] = slope * first[j, 0, 0] + c.damping * first[j, 1, 0]
    change[DAMPING] += v
    change[STIFFNESS] += delta**c.exponent
    change[EXPONENT] += c.stiffness * delta**c.exponent * math.log(delta)
    for i in range(2):
        for j in range(QUANTITIES):
            second[i, j, 1, 0] -= change[i] * change[j] / rate


@compiled
def fly(c, first, second, motion, piece):
    """Advance the perturbations along a piece without a contact force."""
    tau = piece.duration
    for j in range(QUANTITIES):
        first[j, 0, 0] += tau * first[j, 1, 0]
        for i in range(2):
            second[i, j, 0, 0] += tau * second[i, j, 1, 0]
    # ∫ z̈_s/a_z dt and its integral over the piece.
    begin, speed = plate.shapes(c, motion.sine, motion.cosine)
    end, last_speed = plate.shapes(c, piece.sine, piece.cosine)
    first[AMPLITUDE, 0, 0] += (begin - end) / c.omega**2 - speed * tau / c.omega
    first[AMPLITUDE, 1, 0] += (last_speed - speed) / c.omega


@compiled_into_callers
def press(c, series, first, second, motion, piece, count):
    """Advance the perturbations along a contact step, and return the step, cut where they are no longer accurate."""
    expand(c, series, first, second, motion.pulled and c.tension == TENSION_CLIP, count)
    longest = PART * tangent_length(c, first[: Y + 1])
    edge = branch_edge(c)
    if c.edge_w == 0.0 and count <= EXPONENT:
        pass  # there is no branch point
    elif motion.w > edge:
        longest = min(longest, PART_OF_RADIUS * motion.w / abs(0.5 * motion.v))
    else:
        longest = min(longest, piece.length)
        while polynomial.value(series, FIRST + workspace.W, longest) > 4.0 * edge:
            longest *= 0.5
    if longest < piece.length:
        duration = polynomial.value(series, FIRST + workspace.T, longest)
        piece = cut_step(series, FIRST, longest, duration, contact.NOTHING)
    for j in range(count):
        for of in range(2):
            first[j, of, 0] = polynomial.value(first[j, of], 0, piece.length)
            for i in range(2):
                second[i, j, of, 0] = polynomial.value(second[i, j, of], 0, piece.length)
    return piece


@compiled
def cycle(parameters, tolerance, state, first, second, count):
    """Advance `state` by one excitation cycle, and fill the first coefficients of `first` and `second`.

    Returns a code of trajectory.STATUS and the number of impacts.

    Parameters
    ----------
    parameters, tolerance, state : see `cycles`
    first : float64, shape (6, 2, SIZE), filled with the derivatives of δ and Y by each quantity
    second : float64, shape (2, 6, 2, SIZE), filled with those by a state and a quantity
    count : number of quantities that are wanted; p, the last one, takes several times as long as the others
    """
    c = contact.constants(parameters, tolerance)
    series = contact.workspace()
    first[:] = 0.0
    second[:] = 0.0
    first[DELTA, 0, 0] = first[Y, 1, 0] = 1.0
    motion = motion_at(c, -state[0], -state[1], 0.0, c.psi0)
    clip = c.tension == TENSION_CLIP
    if motion.pulled and clip:
        switch(c, first, second, state[0], True)
    impacts = 0
    for _ in range(MAX_PIECES):
        piece = next_piece(c, series, FIRST, motion, c.period - motion.t)
        if piece.kind == CONTACT:
            piece = press(c, series, first, second, motion, piece, count)
        else:
            if piece.kind == FLIGHT and piece.end == LOST:
                return IMPACT_LOST, impacts
            impacts += piece.end == IMPACT
            fly(c, first, second, motion, piece)
        following = arrive(c, motion, piece, c.psi0)
        free = motion.pulled and clip
        if piece.end == IMPACT or (piece.end == SEPARATION and not following.touching and not free):
            if piece.v != 0.0:
                switched = c.edge_w if piece.end == IMPACT else min(c.edge_w, motion.w)
                cross_surface(c, first, second, abs(piece.v), switched)
        elif piece.end == FORCE_SIGN and clip:
            delta = piece.w * piece.w
            if not motion.pulled:
                switch(c, first, second, delta, True)
            cross_force(c, first, second, piece.w, piece.v, c.gravity + plate.lift(c, piece.sine, piece.cosine))
            if motion.pulled:
                switch(c, first, second, delta, False)
        motion = following
        if not is_finite(motion):
            return NOT_FINITE, impacts
        if piece.end == LIMIT:
            state[0], state[1] = delta_and_v(motion)
            if motion.pulled and clip:
                switch(c, first, second, state[0], False)
            return OK, impacts
    return TOO_STIFF, impacts


def cycles(parameters, tolerance, state, number, count):
    """Advance `state` by a number of cycles, with the derivatives of each.

    Parameters
    ----------
    parameters : float64, shape (16,)
    tolerance : of the contact steps
    state : float64, shape (2,), δ (m) and v (m/s) at the phase ψ0; replaced by the last state
    number : of cycles, n
    count : number k of quantities, from the first one on; p, the last one, takes several times as long as the others

    Returns
    -------
    status : code of trajectory.STATUS; the other results are valid where it is OK
    first : float64, shape (n, 2, k), ∂(δ, Y) at the end of each cycle by the quantities at its beginning
    second : float64, shape (n, 2, 2, k), derivatives of first[..., :2] by the same quantities
    states : float64, shape (n, 2), δ and v after each cycle
    impacts : int64, shape (n,), impacts in each cycle
    """
    # Not compiled, because numba would compile all of `cycle` once more.
    first, second = np.empty((number, 2, count)), np.empty((number, 2, 2, count))
    states, impacts = np.empty((number, 2)), np.empty(number, dtype=np.int64)
    of_one = np.empty((QUANTITIES, 2, SIZE))
    of_two = np.empty((2, QUANTITIES, 2, SIZE))
    status = OK
    for n in range(number):
        status, impacts[n] = cycle(parameters, tolerance, state, of_one, of_two, count)
        states[n] = state
        first[n] = of_one[:count, :, 0].T
        second[n] = of_two[:, :count, :, 0].transpose(2, 0, 1)
        if status != OK:
            break
    return status, first, second, states, impacts
