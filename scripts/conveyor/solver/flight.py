"""Flight: the part follows a parabola, and the search for the next impact passes none.

Above the plate's highest point there is nothing to hit, and one closed form covers that part of a flight. Below it the
part's acceleration relative to the plate, q̈ = -g - z̈_s, is at least -(g + the bound on z̈_s). The parabola with this
acceleration reaches the plate before the part does, so that a step to its root is safe.
"""

import math
from collections import namedtuple

from . import plate
from .jit import compiled, compiled_inline

# A part stays below the plate's highest point for sqrt(a_z / g) / π cycles at most, which is a thousand within
# parameters.RANGES, with about ten steps in each. A search of more steps has failed.
MAX_STEPS = 1_000_000
EPSILON = 2.220446049250313e-16
TURN = 2.0 * math.pi
# Shortest advance of the phase (rad) in a search for the largest gap: it leaves a root of the rate, and changes the gap
# by less than rounding errors.
LEAVE = 1e-7
# A gap below zero by more than this many rounding errors is an error of the search.
MOST_ERRORS = 1e6

# The take-off of a flight: height z (m), vertical velocity vz (m/s), phase theta (rad); contact.Constants.
Flight = namedtuple("Flight", "z vz theta c")


@compiled_inline
def gap(flight, tau):
    """Gap (m) and its rate (m/s) after the time `tau` (s) of a flight."""
    return gap_at_phase(flight, tau, *plate.sine_and_cosine(flight.theta + flight.c.omega * tau))


@compiled_inline
def gap_at_phase(flight, tau, sine, cosine):
    """`gap` for a known sine and cosine of the excitation's phase."""
    z, vz, _, c = flight
    q = z + (vz - 0.5 * c.gravity * tau) * tau - plate.height(c, sine, cosine)
    return q, vz - c.gravity * tau - plate.rise(c, sine, cosine)


@compiled_inline
def fall(flight, tau):
    """Acceleration (m/s²) with which the gap closes after the time `tau` (s) of a flight."""
    return flight.c.gravity + plate.lift(flight.c, *plate.sine_and_cosine(flight.theta + flight.c.omega * tau))


@compiled_inline
def time_of_fall(velocity, height, gravity):
    """Time (s) in which a part with an upward velocity (m/s) falls by a height ≥ 0 (m). No digits cancel."""
    root = math.sqrt(velocity * velocity + 2.0 * gravity * height)
    return (velocity + root) / gravity if velocity > 0.0 else 2.0 * height / (root - velocity)


@compiled_inline
def next_impact(flight, q, rate, limit):
    """Duration (s) of a Flight up to the next impact, and the speed of approach there (m/s).

    Parameters
    ----------
    flight : a Flight
    q, rate : gap ≥ 0 (m) and its rate (m/s) at take-off; q = 0 exactly after a separation
    limit : s, time at which the search ends

    Returns
    -------
    tau, speed : s, m/s (≥ 0); tau is infinite if there is no impact before `limit`, NaN if the search has failed
    """
    z, vz, _, c = flight
    gravity, bound, top = c.gravity, c.gravity + c.bounds.lift, c.bounds.height
    rounding = 4.0 * EPSILON * (abs(z) + top)
    tau = 0.0
    if q <= rounding:
        # On the plate the parabola allows no step. A bound on |d³q/dt³| with the actual q̈ does.
        tau = 2.0 * max(rate, 0.0) / bound
        jerk = c.bounds.jerk
        half = -0.5 * fall(flight, 0.0)
        root = math.sqrt(half * half + 2.0 / 3.0 * jerk * max(rate, 0.0))
        # The form of the root of a quadratic that does not cancel.
        if half < 0.0:
            tau = max(tau, 2.0 * max(rate, 0.0) / (root - half))
        elif jerk > 0.0:
            tau = max(tau, 3.0 * (half + root) / jerk)
        tau = max(tau, 1e-9 / c.omega)
        if tau >= limit:
            return math.inf, 0.0
        q, rate = gap(flight, tau)
    for _ in range(MAX_STEPS):
        velocity = vz - gravity * tau
        height = z + 0.5 * (vz + velocity) * tau
        # The rounding error of the longest distance so far, up or down.
        rounding = 4.0 * EPSILON * (abs(z) + abs(vz * tau) + 0.5 * gravity * tau * tau + top)
        if q <= rounding and rate <= 0.0:
            return tau, -rate
        if q < 0.0:
            return (tau if q > -MOST_ERRORS * rounding else math.nan), 0.0
        advance = 0.0
        if height > top + rounding:
            advance = time_of_fall(velocity, height - top, gravity)
        if advance <= 2.0 * EPSILON * tau:
            advance = time_of_fall(rate, q, bound)
            if advance <= 2.0 * EPSILON * tau:
                return tau, max(-rate, 0.0)
        tau += advance
        if tau >= limit:
            return math.inf, 0.0
        q, rate = gap(flight, tau)
    return math.nan, 0.0


@compiled
def highest_gap(flight, duration):
    """Largest gap (m) of a Flight that takes `duration` (s).

    It lies within an excitation cycle of the top of the parabola, because the plate has each of its heights there. It
    is at an end of this interval or at a root of the gap's rate. The search steps from root to root and passes none:
    with the bound on |d³q/dt³|, a step ends before the rate can have changed its sign. Near a root such steps converge
    quadratically, and a shortest step then leaves it.
    """
    _, vz, _, c = flight
    top, cycle = min(max(vz / c.gravity, 0.0), duration), TURN / c.omega
    tau, end = max(top - cycle, 0.0), min(top + cycle, duration)
    jerk, highest = c.bounds.jerk, gap(flight, end)[0]
    shortest = max(LEAVE / c.omega, 2.0 * EPSILON * end)  # which is more than the distance of two floats
    while tau < end:
        q, rate = gap(flight, tau)
        # The rate's distance from zero, and how fast it shrinks.
        closing = math.copysign(fall(flight, tau), rate * fall(flight, tau))
        root = math.sqrt(closing * closing + 2.0 * jerk * abs(rate))
        advance = 2.0 * abs(rate) / (root + closing) if closing > 0.0 else (root - closing) / jerk
        # While the bound on the rate, a concave function, falls to zero, the gap grows by half of this product or more.
        highest = max(highest, q + max(0.5 * rate * min(advance, end - tau), 0.0))
        tau += max(advance, shortest)
    return highest
