"""The corners of a block: where they are, their modes, their contact forces, and friction in slip and in stick.

A corner has half of the contact's stiffness and of its damping. With the offset (o_x, o_z) of a corner from the centre,
its contact force N and friction f, both per mass of the block, and the moment of inertia per mass, I/m,

    z̈ = -g cos α + Σ N,    ẍ = -g sin α + Σ f,    (I/m) α̈ = Σ (o_x N - o_z f).

The slip velocity u = ẋ_s - ẋ of a corner then changes with the rate b - Σ_j (1 + o_z o_zj m/I) f_j, in which b contains
everything but friction. A corner that slips has the friction μN sign(u). The frictions of those that stick follow from
u̇ = 0, see `hold`. The contact forces depend on the state alone, so that these equations are linear.

A state is an array: x (m), vx (m/s), z (m), vz (m/s) of the centre, angle (rad; positive where the front is raised),
spin (rad/s).
`now` is an array of shape (14, 4) with what is known of each corner at one moment.
"""

import math
from collections import namedtuple

from ..solver import contact_law, friction, model, plate
from ..solver.jit import compiled, compiled_inline, copy

X, VX, Z, VZ, ANGLE, SPIN = range(6)
STATE = 6
CORNERS = 4
# Rows of `now`: offset from the centre (m), gap (m) and its rate (m/s), slip velocity (m/s); contact force and friction
# per mass (m/s²); one of the modes below; the contact force that spring and damper would have, and whether it is
# negative, which matters for `frictionless` and `clip`; whether it touches the plate without a slip velocity, and its
# best mode so far, in `choose_modes`; the weight and the rate w and b of `hold`.
OX, OZ, GAP, RATE, SLIP, FORCE, RUB, MODE, WHOLE, PULLED, RESTS, BEST, WEIGHT, NEED = range(14)
ROWS = 14
# What a corner does. With one of the last two it slips, and friction pushes it forward or backward.
FREE, STICK, FORWARD, BACKWARD = 0.0, 1.0, 2.0, 3.0
# The inverse of the weights in `hold`, for equal contact forces. Corners at equal heights share the friction as the
# contact force, so that all reach the limit of static friction together. It is large enough that neither the rounding
# of their heights nor a slow rotation decides.
REGULAR = 1e-5
LEAST_SHARE = 1e-6  # of the friction, for a corner that hardly touches the plate
ROUNDING = 1e-15  # share of the largest height of a centre by which rounding can change a gap
# The smallest size that counts as a step over a limit: of a gap (m), a slip velocity (m/s) and a force per mass (m/s²).
Margins = namedtuple("Margins", "gap slip force")
# Half of the length and of the height (m), the moment of inertia per mass (m²), the distance of a corner from the
# centre (m), and the Margins.
Body = namedtuple("Body", "half_length half_height inertia reach margins")


@compiled_inline
def body_of(c, size, z0, vz0):
    """The Body with a length, a height (m) and a moment of inertia per mass (m²), on a conveyor with contact.Constants.

    z0, vz0 : height above the one at rest (m; NaN: on the plate) and velocity (m/s) of its centre at the beginning
    """
    half_length, half_height = 0.5 * size[0], 0.5 * size[1]
    reach = math.hypot(half_length, half_height)
    fall = (0.0 if math.isnan(z0) else abs(z0)) + 0.5 * vz0 * vz0 / c.gravity
    gap = max(c.tolerance * c.scale_w * c.scale_w, ROUNDING * (reach + c.bounds.height + fall))
    slip = 0.1 * c.tolerance * (c.scale_v + (c.a_x + c.gravity) / c.omega)
    return Body(half_length, half_height, size[2], reach, Margins(gap, slip, c.tolerance * c.gravity))


@compiled_inline
def locate(c, body, theta, state, now):
    """Fill offsets, gaps, their rates and slip velocities of all corners at a phase (rad).

    Returns the pull along the track per mass (m/s²), see solver.friction.
    """
    sine, cosine = plate.sine_and_cosine(theta)
    height, rise, speed = plate.height(c, sine, cosine), plate.rise(c, sine, cosine), plate.speed(c, sine, cosine)
    up, along = math.sin(state[ANGLE]), math.cos(state[ANGLE])
    for i in range(CORNERS):
        x = body.half_length if i % 2 else -body.half_length
        z = body.half_height if i >= 2 else -body.half_height
        ox, oz = x * along - z * up, x * up + z * along
        now[OX, i], now[OZ, i] = ox, oz
        now[GAP, i] = state[Z] + oz - height
        now[RATE, i] = state[VZ] + state[SPIN] * ox - rise
        now[SLIP, i] = speed - state[VX] + state[SPIN] * oz
    return friction.pull(c, sine, cosine)


@compiled_inline
def push(c, now):
    """Fill the contact forces of all corners."""
    for i in range(CORNERS):
        now[WHOLE, i] = now[FORCE, i] = 0.0
        if now[MODE, i] != FREE:
            now[WHOLE, i] = 0.5 * contact_law.force(c, math.sqrt(max(-now[GAP, i], 0.0)), -now[RATE, i])
            if not (now[PULLED, i] and c.tension == model.TENSION_CLIP):
                now[FORCE, i] = now[WHOLE, i]


@compiled_inline
def hold(body, state, now, free, turn):
    """Fill the frictions of the corners that stick.

    With the rate b of its slip velocity without friction, each corner has the friction f = w (b - F - o_z M). F is the
    sum of these frictions and M that of their moments over the moment of inertia. The weights w are large, so that
    hardly anything of b is left. They stand in for the elasticity of the block: corners whose heights differ by less
    than about a thousandth of its length share the friction as their contact forces, and slip against each other by
    this difference times the spin. In a rigid block the difference, however small, would decide.

    Cramer's rule is written in pairs of corners, without cancellation, and leaves out the 1 of the determinant: at
    equal heights the sum of the frictions is exact.

    free, turn : rates (m/s², 1/s²) of the slip velocity of the centre and of the spin without these frictions
    """
    sticking, load, least, diagonal = 0, 0.0, math.inf, 0.0
    for i in range(CORNERS):
        if now[MODE, i] == STICK:
            sticking += 1
            load += now[FORCE, i]
            least = min(least, now[FORCE, i])
            diagonal += 1.0 + now[OZ, i] * now[OZ, i] / body.inertia
    if sticking == 0:
        return
    for i in range(CORNERS):
        now[WEIGHT, i] = 0.0
        now[NEED, i] = free + state[SPIN] * state[SPIN] * now[OX, i] + now[OZ, i] * turn
        if now[MODE, i] == STICK:
            share = max(now[FORCE, i] / load, LEAST_SHARE) if least > 0.0 else 1.0 / sticking
            now[WEIGHT, i] = share * sticking / (REGULAR * diagonal)
    determinant = 0.0
    for i in range(CORNERS):
        z, need = now[OZ, i], now[NEED, i]
        determinant += now[WEIGHT, i] * (1.0 + z * z / body.inertia)
        total = need
        for j in range(CORNERS):
            zj, needed = now[OZ, j], now[NEED, j]
            total += now[WEIGHT, j] * (need - needed + zj * (zj * need - z * needed) / body.inertia)
            for k in range(j):
                apart = zj - now[OZ, k]
                both = now[WEIGHT, j] * now[WEIGHT, k] * apart / body.inertia
                total += both * (need * apart - needed * (z - now[OZ, k]) + now[NEED, k] * (z - zj))
                if i == 0:
                    determinant += both * apart
        if now[MODE, i] == STICK:
            now[RUB, i] = now[WEIGHT, i] * total
    for i in range(CORNERS):
        if now[MODE, i] == STICK:
            now[RUB, i] /= determinant


@compiled_inline
def rub(c, body, pull, state, now):
    """Fill the frictions of all corners; returns the sum of the moments of the contact forces per mass (m²/s²)."""
    moment = slide = lever = 0.0
    for i in range(CORNERS):
        moment += now[OX, i] * now[FORCE, i]
        now[RUB, i] = 0.0
        slips = now[MODE, i] != FREE and now[MODE, i] != STICK
        if slips and not (now[PULLED, i] and c.tension != model.TENSION_ALLOW):
            now[RUB, i] = c.friction * now[FORCE, i] * (1.0 if now[MODE, i] == FORWARD else -1.0)
            slide += now[RUB, i]
            lever += now[OZ, i] * now[RUB, i]
    hold(body, state, now, pull - slide, (moment - lever) / body.inertia)
    return moment


@compiled_inline
def derive(c, body, theta, state, now, rates):
    """Fill the rates of a state at a phase (rad), and everything in `now` that depends on them."""
    pull = locate(c, body, theta, state, now)
    push(c, now)
    turn = rub(c, body, pull, state, now)
    lift, along = -c.gravity, -c.downhill
    for i in range(CORNERS):
        lift += now[FORCE, i]
        along += now[RUB, i]
        turn -= now[OZ, i] * now[RUB, i]
    rates[X], rates[Z], rates[ANGLE] = state[VX], state[VZ], state[SPIN]
    rates[VX], rates[VZ], rates[SPIN] = along, lift, turn / body.inertia


@compiled_inline
def violation(c, body, pull, state, now):
    """By how much (m/s²) the modes of the corners contradict Coulomb's law; 0 if they do not."""
    moment = rub(c, body, pull, state, now)
    worst = 0.0
    for i in range(CORNERS):
        rate = pull + state[SPIN] * state[SPIN] * now[OX, i] + now[OZ, i] * moment / body.inertia
        for j in range(CORNERS):
            rate -= (1.0 + now[OZ, i] * now[OZ, j] / body.inertia) * now[RUB, j]
        if now[MODE, i] == STICK:
            worst = max(worst, abs(now[RUB, i]) - c.static_friction * now[FORCE, i])
        elif now[RESTS, i]:
            worst = max(worst, -rate if now[MODE, i] == FORWARD else rate)
    return worst


@compiled
def choose_modes(c, body, theta, state, slips, now, rates):
    """Give each corner that touches the plate the mode that Coulomb's law demands, and fill the rates of the state.

    A corner with a slip velocity slips. For those without, all combinations of stick and of slip either way are tried
    (Filippov's conditions); the first one that contradicts the law least is right. Combinations with more stick come
    first, because static friction holds what does not slide.

    slips : the corner whose static friction has just been overcome, or -1
    """
    pull = locate(c, body, theta, state, now)
    push(c, now)
    has_friction = c.friction + c.static_friction > 0.0
    for i in range(CORNERS):
        now[RESTS, i] = has_friction and now[MODE, i] != FREE and abs(now[SLIP, i]) <= body.margins.slip
        if now[MODE, i] != FREE:
            now[MODE, i] = FORWARD if now[SLIP, i] > 0.0 else BACKWARD
    least = math.inf
    ways = (STICK, FORWARD, BACKWARD) if pull >= 0.0 else (STICK, BACKWARD, FORWARD)
    for combination in range(3 ** int(now[RESTS].sum())):
        digits = combination
        for i in range(CORNERS):
            if now[RESTS, i]:
                now[MODE, i], digits = ways[digits % 3], digits // 3
        if slips >= 0 and now[MODE, slips] == STICK:
            continue
        worst = violation(c, body, pull, state, now)
        if worst < least:
            least = worst
            copy(now[BEST], now[MODE])
        if least <= 0.0:
            break
    copy(now[MODE], now[BEST])
    derive(c, body, theta, state, now, rates)


@compiled
def begin(c, body, theta, z0, vz0, tilt, state, now, rates):
    """Fill the `state` at the beginning of a run at a phase (rad), and its rates and `now` there."""
    if math.isnan(z0):
        z0 = plate.height(c, *plate.sine_and_cosine(theta))
    state[X], state[Z], state[ANGLE] = 0.0, z0 + body.half_height, tilt
    state[VX], state[VZ], state[SPIN] = 0.0, vz0, 0.0
    now[:] = 0.0
    locate(c, body, theta, state, now)
    for i in range(CORNERS):
        now[MODE, i] = FORWARD if now[GAP, i] <= 0.0 else FREE
    push(c, now)
    for i in range(CORNERS):
        now[PULLED, i] = now[WHOLE, i] < 0.0
    choose_modes(c, body, theta, state, -1, now, rates)


@compiled
def touch(now, margin):
    """Close the contacts of all corners that are at the plate and approach it, open those that leave it.

    Returns the largest speed of approach of a new contact (m/s).
    """
    speed = 0.0
    for i in range(CORNERS):
        if now[MODE, i] == FREE and now[GAP, i] <= margin and now[RATE, i] < 0.0:
            now[MODE, i], now[PULLED, i] = FORWARD, 0.0
            speed = max(speed, -now[RATE, i])
        elif now[MODE, i] != FREE and now[GAP, i] >= (-margin if now[RATE, i] > 0.0 else margin):
            now[MODE, i] = FREE
    return speed


@compiled
def keep_sticking(now, state):
    """Remove the error of a step in the slip velocity of corners that stick."""
    total, count = 0.0, 0
    for i in range(CORNERS):
        if now[MODE, i] == STICK:
            total += now[SLIP, i]
            count += 1
    if count > 0:
        state[VX] += total / count
