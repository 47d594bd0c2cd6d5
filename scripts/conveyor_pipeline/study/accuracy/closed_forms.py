"""Theory of isolated impacts, a bouncing rigid ball and a sliding part: closed forms, or a reduced equation."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from conveyor import Conveyor

MANY = 200_000  # phases of a cycle, for medians to five digits
SCIPY = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}  # options of SciPy for the dimensionless impact


def compression(conveyor: Conveyor, speed: float) -> float:
    """Largest penetration (m) of an undamped impact at a speed (m/s), from the conservation of energy."""
    power = conveyor.exponent + 1.0
    return (power * conveyor.mass * speed**2 / (2.0 * conveyor.stiffness)) ** (1.0 / power)


def undamped_duration(conveyor: Conveyor, speed: float) -> float:
    """Duration (s) of an undamped impact at a speed (m/s) (Hertz 1882 for p = 1.5; any p by the same integral)."""
    share = 1.0 / (conveyor.exponent + 1.0)
    integral = math.sqrt(math.pi) * math.gamma(1.0 + share) / math.gamma(0.5 + share)
    return 2.0 * compression(conveyor, speed) / speed * integral


def light_loss(exponent: float) -> float:
    """(1 - e)/β of a light damper: the work of F = d δ̇ along the undamped motion, 2 ∫ √(1 - x^(p+1)) dx over [0, 1]."""
    share = 1.0 / (exponent + 1.0)
    return 2.0 * share * math.gamma(share) * math.gamma(1.5) / math.gamma(share + 1.5)


def reduced_restitution(exponent: float, beta: float) -> float:
    """Coefficient of restitution of X'' = -(p+1)/2 X^p - β X' from X = 0, X' = 1 back to X = 0.

    X is the penetration over the undamped `compression`, and β = (d_c/m) compression/speed. The coefficient depends
    only on p and β (dimensional analysis as in Ramírez et al. 1999).
    """

    def rates(_, state):
        return state[1], -0.5 * (exponent + 1.0) * max(state[0], 0.0) ** exponent - beta * state[1]

    def separation(_, state):
        return state[0]

    separation.terminal, separation.direction = True, -1.0
    run = solve_ivp(rates, (0.0, 100.0), (0.0, 1.0), events=separation, **SCIPY)
    return -run.y_events[0][0][1]


def damping_ratio(restitution: float) -> float:
    """Damping ratio ζ of a linear contact that ends at zero penetration, from e = exp(-π ζ/√(1 - ζ²))."""
    loss = -math.log(restitution)
    return loss / math.hypot(math.pi, loss)


def restitution_without_tension(restitution: float) -> float:
    """Coefficient of restitution of a linear contact that ends at zero force (Schwager, Pöschel 2007).

    restitution : of the same contact if it ends at zero penetration
    """
    ratio = damping_ratio(restitution)
    frequency = math.sqrt(1.0 - ratio**2)
    return math.exp(-ratio / frequency * (math.pi - math.atan2(2.0 * ratio * frequency, frequency**2 - ratio**2)))


def rigid_range(restitution: float) -> tuple[float, float]:
    """Range of a_z/g in which a rigid ball's motion with one impact per cycle is stable (Luo, Han 1996).

    The lower end is a fold, the upper end a period doubling. For e = 1, the upper end agrees with the approximate map
    of Holmes (1982).
    """
    fold = math.pi * (1.0 - restitution) / (1.0 + restitution)
    return fold, math.hypot(fold, 2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2)


def two_frequencies(ratio: float, phase: float) -> tuple[float, float]:
    """A plate that vibrates along the track as -X [cos θ + r cos(2θ + phase)], and a part that always slides on it.

    Returns
    -------
    the amplitude of the plate's displacement in units of X, and the mean velocity of the part in units of Xω in the
    limit of small friction: the median of the plate's velocity, because friction pushes forwards for one half of the
    time and backwards for the other
    """
    theta = 2.0 * math.pi * (np.arange(MANY) + 0.5) / MANY
    displacement = np.cos(theta) + ratio * np.cos(2.0 * theta + phase)
    velocity = np.sin(theta) + 2.0 * ratio * np.sin(2.0 * theta + phase)
    return float(np.abs(displacement).max()), float(np.median(velocity))
