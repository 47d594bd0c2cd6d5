"""Flight: the part follows a parabola, and no impact is ever jumped over.

While the part is in the air its acceleration relative to the plate, q̈ = -g - a_z cos θ, lies between -(g + a_z) and
a_z - g. The parabola of the lower bound reaches the plate before the part does, so a step to its root is safe.
"""

import math

from .jit import inlined

MAX_STEPS = 400
EPSILON = 2.220446049250313e-16


@inlined
def gap(z, vz, tau, theta, gravity, a_z, omega):
    """Gap (m) and its rate (m/s) after the time `tau` of a flight from z, vz at the phase `theta`."""
    phase = theta + omega * tau
    q = z + (vz - 0.5 * gravity * tau) * tau + a_z / (omega * omega) * math.cos(phase)
    rate = vz - gravity * tau - a_z / omega * math.sin(phase)
    return q, rate


@inlined
def next_impact(z, vz, q, rate, theta, gravity, a_z, omega, limit):
    """Duration (s) of the flight from gap q ≥ 0 (m) with its rate (m/s), approach speed at its end, and largest gap.

    Parameters
    ----------
    z, vz : height (m) and vertical velocity (m/s) of the part at take-off
    q, rate : gap (m) and its rate (m/s) there; q = 0 exactly after a separation
    theta : phase of the excitation at take-off, rad
    gravity, a_z, omega : m/s², m/s², rad/s
    limit : s, time at which the search ends

    Returns
    -------
    tau, speed, highest : s, m/s (≥ 0), m; tau is infinite if there is no impact before `limit`
    """
    bound = gravity + a_z
    resolution = 4.0 * EPSILON * (abs(z) + a_z / (omega * omega))
    highest = q
    tau = 0.0
    if q <= resolution:
        # From the plate the parabola has no room; the bound |d³q/dt³| ≤ a_z ω and the actual q̈ do.
        tau = 2.0 * max(rate, 0.0) / bound
        jerk = a_z * omega
        half = -0.5 * (gravity + a_z * math.cos(theta))
        root = math.sqrt(half * half + 2.0 / 3.0 * jerk * max(rate, 0.0))
        # Either form of the root of a quadratic where it does not cancel.
        if half < 0.0:
            tau = max(tau, 2.0 * max(rate, 0.0) / (root - half))
        elif jerk > 0.0:
            tau = max(tau, 3.0 * (half + root) / jerk)
        tau = max(tau, 1e-9 / omega)
        q, rate = gap(z, vz, tau, theta, gravity, a_z, omega)
    for _ in range(MAX_STEPS):
        if q <= resolution and rate <= 0.0:
            return tau, -rate, highest
        if q < 0.0:
            return tau, 0.0, highest
        advance = (rate + math.sqrt(rate * rate + 2.0 * bound * q)) / bound
        if advance <= 2.0 * EPSILON * tau:
            return tau, max(-rate, 0.0), highest
        previous = tau
        previous_rate = rate
        tau = min(tau + advance, limit)
        q, rate = gap(z, vz, tau, theta, gravity, a_z, omega)
        if previous_rate > 0.0 and rate <= 0.0:
            highest = max(highest, summit(z, vz, previous, tau, theta, gravity, a_z, omega))
        if tau == limit:
            return math.inf, 0.0, max(highest, q)
    return math.inf, 0.0, highest


@inlined
def summit(z, vz, low, high, theta, gravity, a_z, omega):
    """Largest gap between two times of a flight, its rate positive at the first one, by safeguarded Newton steps."""
    tau = 0.5 * (low + high)
    for _ in range(60):
        q, rate = gap(z, vz, tau, theta, gravity, a_z, omega)
        if rate > 0.0:
            low = tau
        else:
            high = tau
        # The gap is flat at its summit: a rate this small no longer changes its height.
        if abs(rate) * (high - low) <= 1e-14 * q:
            break
        newton = tau + rate / (gravity + a_z * math.cos(theta + omega * tau))
        tau = newton if low < newton < high else 0.5 * (low + high)
    return q
