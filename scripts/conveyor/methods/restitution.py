"""Coefficients of restitution of the compliant contact, from the solver's contact steps."""

import numpy as np

from ..arguments import LARGEST_COORDINATE, check_array
from ..packing import as_rows
from ..solver import contact
from ..solver.jit import compiled
from ..solver.workspace import FIRST

CONTACT_TOLERANCE = 1e-14  # of the contact steps that follow an impact
MAX_CONTACT_STEPS = 10_000  # of one impact; an undamped one takes about ten
OVERDAMPED = 40.0  # d_c/m times the duration of an undamped impact; over six times critical for a linear contact
CREEPING = 20.0  # durations of an undamped impact; a contact that takes longer creeps back without a separation


def restitution_coefficient(parameters: np.ndarray, speed: float) -> float:
    """Speed of separation over `speed` of approach (m/s) in the compliant contact, without gravity and excitation.

    The solver's contact steps follow the impact. The coefficient is 0 if the contact is so damped that it creeps back
    without a separation. ArithmeticError if the impact does not end within MAX_CONTACT_STEPS.
    """
    alone = contact.constants(as_rows(parameters), CONTACT_TOLERANCE)._replace(
        gravity=0.0, a_z=0.0, scale_v=speed, harmonics=0
    )
    share = 1.0 / (alone.exponent + 1.0)
    duration = 3.0 * (speed * speed / (2.0 * share * alone.stiffness)) ** share / speed
    if alone.damping * duration > OVERDAMPED:
        return 0.0
    series = contact.workspace()
    w, v, time, pulled = 0.0, speed, 0.0, False
    for _ in range(MAX_CONTACT_STEPS):
        length = contact.begin_step(alone, series, FIRST, w, v, 0.0, 1.0, pulled)
        _, w, v, lapse, end = contact.end_step(alone, series, FIRST, w, v, pulled, length)
        if end == contact.SEPARATION:
            return -v / speed
        if end == contact.FORCE_SIGN:
            pulled = not pulled
        time += lapse
        if time > CREEPING * duration:
            return 0.0
    raise ArithmeticError(f"an impact at {speed:g} m/s does not end within {MAX_CONTACT_STEPS} contact steps")


def restitution_coefficients(parameters: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """Coefficients of restitution of the compliant contact for `speeds` of approach (m/s, positive), shape (k,).

    They belong to the contact alone, without gravity and excitation, and are accurate to about 1e-6. A speed that is
    not positive raises ValueError.
    """
    speeds = check_array("speeds", speeds, np.finfo(np.float64).tiny, LARGEST_COORDINATE, "m/s")
    return np.array([restitution_coefficient(parameters, speed) for speed in speeds])


@compiled
def restitution_at(speed, speeds, coefficients):
    """Linear interpolation in a table over ascending `speeds` (m/s), constant beyond its ends."""
    k = np.searchsorted(speeds, speed)
    if k == 0:
        return coefficients[0]
    if k == len(speeds):
        return coefficients[-1]
    share = (speed - speeds[k - 1]) / (speeds[k] - speeds[k - 1])
    return coefficients[k - 1] + share * (coefficients[k] - coefficients[k - 1])
