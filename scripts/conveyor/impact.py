"""A part that falls on a plate at rest: how fast it leaves, and the damper that makes it bounce as in an experiment.

The part hits the plate normally, at a speed v, and the gravity g cos α acts on it in the contact, too. So a drop on a
level plate rebounds to the height e² h. The speed at which the gap opens again is e v, with the coefficient of
restitution e. Without gravity, a Hooke contact (p = 1) of the damping ratio ζ < 1 has e = exp(-π ζ/√(1 - ζ²)) if the
force may pull; with any other exponent the linear damper makes e smaller at smaller speeds.

In units of v and L = (m v²/k_c)^(1/(p+1)), with the variable s of solver.contact_law (δ = w², dt = w ds), the motion is

    w' = v/2,   v' = w (G - max(w^(2p) + D v, 0 if `clip`)),   D = d_c L/(m v),   G = g cos α L/v²,

from w = 0 to w = 0, without a singularity for p = 1 and 3/2. It is integrated by the method of Dormand and Prince
(1980). Nothing slow is imported, so that a program can convert a restitution before it loads NumPy and Numba.
"""

import math
from collections.abc import Callable
from typing import Any

from .parameters import RANGES, TENSION_MODES, UNITS, check_number, normal_gravity
from .solver.law import spring_and_damper

TOLERANCE = 1e-12  # of a step, in the units above
WEAKEST = 1e-18  # D of a damper that changes no digit; the zero of its force is lost in rounding
NEGLIGIBLE = 1e-6  # a smaller restitution of a part that creeps out of a clipped contact counts as none
SLOWEST, FASTEST = 1e-6, RANGES["vz0"][1]  # m/s
CONTACT = ("stiffness", "damping", "mass", "exponent", "gravity", "inclination")


def restitution(conveyor: Any, speed: float) -> float:
    """The coefficient of restitution of a part that hits the plate at rest, with gravity in the contact.

    Parameters
    ----------
    conveyor : a Conveyor, a row of a table, or any object with its stiffness, damping, mass, exponent, gravity,
        inclination and tension
    speed : normal speed of the impact, 1e-6 to 100 m/s

    Returns
    -------
    speed at which the part leaves over the speed of the impact, in [0, 1], to about 1e-10 unless the part presses much
    deeper at rest than in the impact; 0 for a part that stays

    Examples
    --------
    >>> from conveyor import Conveyor
    >>> round(restitution(Conveyor(), 0.35), 3), round(restitution(Conveyor(), 0.1), 3)
    (0.752, 0.676)
    """
    model = contact_of(conveyor)
    damping, gravity, speed = groups(model, speed)
    return rebound(model["exponent"], model["damping"] / damping, gravity, model["tension"] == "clip")


def damping_of(restitution: float, speed: float, conveyor: Any) -> float:
    """The damping d_c (N s/m) with which a part has a coefficient of restitution: the inverse of `restitution`.

    Parameters
    ----------
    restitution : above 0 and at most 1
    speed : normal speed of the impact, 1e-6 to 100 m/s
    conveyor : as for `restitution`; its damping is not used

    Raises
    ------
    ValueError
        if the restitution or the speed is outside its range, or no admissible damping takes so much speed

    Examples
    --------
    >>> from conveyor import Conveyor
    >>> from conveyor.impact import restitution
    >>> damping = damping_of(0.5, 0.63, Conveyor(mass=0.8e-3))  # a drop of 20 mm
    >>> round(damping, 3), round(restitution(Conveyor(mass=0.8e-3, damping=damping), 0.63), 9)
    (0.847, 0.5)
    """
    wanted, model = check_number("restitution", restitution, 0.0, 1.0, above=True), contact_of(conveyor)
    unit, gravity, speed = groups(model, speed)

    def excess(damping: float) -> float:
        return rebound(model["exponent"], damping, gravity, model["tension"] == "clip") - wanted

    if excess(0.0) <= 0.0:  # a contact without damping takes nothing
        return 0.0
    limit = RANGES["damping"][1] / unit
    low, high = 0.0, min(1.0, limit)
    while excess(high) > 0.0:
        if high == limit:
            largest = f"the largest damping, {RANGES['damping'][1]:g} N s/m"
            raise ValueError(f"restitution = {restitution!r} needs more than {largest}, at {speed:g} m/s")
        low, high = high, min(2.0 * high, limit)
    return root(excess, low, high) * unit


def contact_of(conveyor: Any) -> dict[str, Any]:
    """The checked parameters of a contact; TypeError for an object that lacks one, ValueError outside its range."""
    if hasattr(conveyor, "__array_interface__"):  # a row of a table; its owner has loaded NumPy already
        from .packing import AT_REST, conveyor_of

        conveyor, _ = conveyor_of(conveyor, AT_REST)
    missing = [name for name in (*CONTACT, "tension") if not hasattr(conveyor, name)]
    if missing:
        raise TypeError(f"conveyor must be a Conveyor, got {conveyor!r} without {', '.join(missing)}")
    if not isinstance(conveyor.tension, str) or conveyor.tension not in TENSION_MODES:
        raise ValueError(f"conveyor.tension = {conveyor.tension!r} is not one of {', '.join(TENSION_MODES)}")
    numbers = {name: getattr(conveyor, name) for name in CONTACT}
    checked = {
        name: check_number(f"conveyor.{name}", value, *RANGES[name], UNITS[name]) for name, value in numbers.items()
    }
    return checked | {"tension": conveyor.tension}


def groups(model: dict[str, Any], speed: object) -> tuple[float, float, float]:
    """The damping with D = 1 (N s/m), the group G of an impact at a speed (m/s), see above, and the checked speed."""
    speed = check_number("speed", speed, SLOWEST, FASTEST, "m/s")
    length = (model["mass"] * speed**2 / model["stiffness"]) ** (1.0 / (model["exponent"] + 1.0))
    return model["mass"] * speed / length, normal_gravity(model) * length / speed**2, speed


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """A root of a function between two arguments of values with different signs (Illinois method)."""
    at_low, at_high = function(low), function(high)
    for _ in range(200):
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        value = function(middle)
        if value == 0.0 or abs(high - low) <= 4e-16 * abs(middle) or middle in (low, high):
            return middle
        if value * at_high < 0.0:
            low, at_low = high, at_high
        else:
            at_low *= 0.5
        high, at_high = middle, value
        if abs(high - low) <= 1e-13 * abs(high):
            return high
    return high


def rebound(exponent: float, damping: float, gravity: float, clip: bool) -> float:
    """The coefficient of restitution from p, D and G; `clip` says that the force cannot pull."""
    closed, power = True, 2.0 * exponent
    clip = clip and damping > WEAKEST
    # A part at rest presses deeper than a slow impact does, and falls faster by this penetration.
    rest = gravity ** (1.0 / exponent)
    scale_w, scale_v = 1.0 + math.sqrt(rest), 1.0 + math.sqrt(2.0 * gravity * rest)

    def force(w: float, v: float) -> float:
        return spring_and_damper(abs(w) ** power, damping, v)

    def rate(w: float, v: float) -> tuple[float, float]:
        return 0.5 * v, w * (gravity - (force(w, v) if closed else 0.0))

    def step(h: float) -> tuple[float, float, float]:
        """State after a step from (w, v), and its error; the coefficients of Dormand and Prince in one state each."""
        w1, v1 = rate(w, v)
        w2, v2 = rate(w + h * w1 / 5, v + h * v1 / 5)
        w3, v3 = rate(w + h * (3 * w1 + 9 * w2) / 40, v + h * (3 * v1 + 9 * v2) / 40)
        w4, v4 = rate(
            w + h * (44 / 45 * w1 - 56 / 15 * w2 + 32 / 9 * w3),
            v + h * (44 / 45 * v1 - 56 / 15 * v2 + 32 / 9 * v3),
        )
        w5, v5 = rate(
            w + h * (19372 / 6561 * w1 - 25360 / 2187 * w2 + 64448 / 6561 * w3 - 212 / 729 * w4),
            v + h * (19372 / 6561 * v1 - 25360 / 2187 * v2 + 64448 / 6561 * v3 - 212 / 729 * v4),
        )
        w6, v6 = rate(
            w + h * (9017 / 3168 * w1 - 355 / 33 * w2 + 46732 / 5247 * w3 + 49 / 176 * w4 - 5103 / 18656 * w5),
            v + h * (9017 / 3168 * v1 - 355 / 33 * v2 + 46732 / 5247 * v3 + 49 / 176 * v4 - 5103 / 18656 * v5),
        )
        new_w = w + h * (35 / 384 * w1 + 500 / 1113 * w3 + 125 / 192 * w4 - 2187 / 6784 * w5 + 11 / 84 * w6)
        new_v = v + h * (35 / 384 * v1 + 500 / 1113 * v3 + 125 / 192 * v4 - 2187 / 6784 * v5 + 11 / 84 * v6)
        w7, v7 = rate(new_w, new_v)
        error_w = 71 / 57600 * w1 - 71 / 16695 * w3 + 71 / 1920 * w4 - 17253 / 339200 * w5 + 22 / 525 * w6 - w7 / 40
        error_v = 71 / 57600 * v1 - 71 / 16695 * v3 + 71 / 1920 * v4 - 17253 / 339200 * v5 + 22 / 525 * v6 - v7 / 40
        return new_w, new_v, h * max(abs(error_w) / scale_w, abs(error_v) / scale_v)

    def is_over(w: float, v: float) -> bool:
        """Whether the part cannot leave: it has no energy left, or creeps."""
        square = w * w
        if 0.5 * v * v + square ** (exponent + 1.0) / (exponent + 1.0) <= gravity * square:
            return True
        # Where δ^(p-1) < D²/4, δ̇/δ > -D/2 holds on: δ falls at most exponentially. The speed at which a part creeps
        # may be below the error of a step, which is as often positive.
        creeps = (
            v <= 10.0 * TOLERANCE * scale_v
            and square ** (exponent - 1.0) < 0.25 * damping**2
            and -v < 0.5 * damping * square
        )
        return creeps and (not clip or max(-v, square**exponent / damping) < NEGLIGIBLE)

    w, v, length = 0.0, 1.0, 0.01 / (1.0 + math.sqrt(damping + gravity))
    while True:
        try:
            new_w, new_v, error = step(length)
        except OverflowError:  # a step that is much too long
            error = math.inf
        if not error <= TOLERANCE:
            length *= max(0.2, 0.9 * (TOLERANCE / error) ** 0.2)
            continue
        taken, length = length, length * min(5.0, 0.9 * (TOLERANCE / max(error, 1e-30)) ** 0.2)
        gap_opens = new_w <= 0.0
        if gap_opens:
            taken = root(lambda part: step(part)[0], 1e-9 * taken if w == 0.0 else 0.0, taken)
            new_w, new_v, _ = step(taken)
        if clip and (force(new_w, new_v) < 0.0) == closed:
            # The force passes zero, now or at the beginning of the step.
            if (force(w, v) < 0.0) != closed:
                w, v, _ = step(root(lambda part: force(*step(part)[:2]), 0.0, taken))
            closed = not closed
        elif gap_opens:
            return -new_v
        else:
            w, v = new_w, new_v
        if is_over(w, v):
            return 0.0
