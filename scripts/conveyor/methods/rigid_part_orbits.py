"""Closed forms of the rigid bouncing part's simplest orbit: one impact in each excitation cycle T.

It leaves the plate with g T/2 and returns with the same speed; with the plate's velocity V at the impact and the
coefficient of restitution e(u), the speed of approach u obeys u (1 + e(u)) = g T, and V = g T/2 - e u. The orbit exists
where the plate reaches V (a fold). Its linearisation, whose determinant is e e' with e' = d(e u)/du, has the multiplier
-1 where the plate's acceleration at the impact is -2 g (1 + e e') / ((1 + e') (1 + e)) (a period doubling).
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from scipy.optimize import brentq

from ..solver.model import Conveyor

STEP = 1e-4  # relative, of the numerical derivative of e(u) u


class RigidOrbit(NamedTuple):
    """The orbit with one impact in a cycle, and the amplitudes between which it is stable."""

    speed: float  # m/s, of approach
    restitution: float
    fold: float  # m/s², least amplitude â
    doubling: float  # m/s², amplitude â of its period doubling


def rigid_orbit(conveyor: Conveyor, restitution: Callable[[float], float]) -> RigidOrbit:
    """The rigid part's orbit with one impact in a cycle.

    Parameters
    ----------
    conveyor : its frequency, gravity, inclination and angle matter
    restitution : coefficient of restitution in [0, 1] as a function of the speed of approach (m/s)
    """
    gravity = conveyor.gravity * math.cos(conveyor.inclination)
    flight = gravity / conveyor.frequency  # g T, m/s
    speed = brentq(lambda u: u * (1.0 + restitution(u)) - flight, 0.5 * flight, flight, xtol=1e-14 * flight)
    e = restitution(speed)
    above, below = speed * (1.0 + STEP), speed * (1.0 - STEP)
    slope = (above * restitution(above) - below * restitution(below)) / (above - below)
    lift = 2.0 * math.pi * conveyor.frequency * (0.5 * flight - e * speed)  # ω V, m/s²
    fall = 2.0 * gravity * (1.0 + e * slope) / ((1.0 + slope) * (1.0 + e))
    vertical = math.sin(conveyor.angle)
    return RigidOrbit(speed, e, lift / vertical, math.hypot(lift, fall) / vertical)
