"""States of motion: first (moves with the plate), second (jumps), chaos; each with its period, none by guess.

A trajectory is followed from excitation cycle to excitation cycle until it repeats itself with a period of up to 64
cycles; the longest flight of the repeated motion tells the first state from the second. What does not repeat itself is
chaos only if the largest Lyapunov exponent of its conveyor is positive beyond its standard error. Else it is followed
further, and what is still open then is `undecided`.
"""

import math

import numpy as np

from . import contact, lyapunov, stroboscope
from .jit import kernel
from .model import FREQUENCY, PSI0, VZ0, Z0
from .parallel import for_each_chunk
from .trajectory import OK

STATES = ("first", "second", "chaos", "undecided")
FIRST, SECOND, CHAOS, UNDECIDED = range(len(STATES))

MAX_PERIOD = 64
# A state repeats itself if it comes back to this distance, in units of the part at rest. It must do so twice running.
CLOSE = 1e-6
# The second state spends most of a cycle in the air; micro-bounces of the first last a small part of it.
LONG_FLIGHT = 0.5
SEARCH_CYCLES = 200
PATIENT_CYCLES = 20_000
# An exponent is positive if it exceeds zero by this many standard errors.
SIGNIFICANT = 3.0


@kernel
def settle(c, series, state, max_cycles):
    """Follow `state` until it is periodic.

    Returns
    -------
    period, longest_flight : in excitation cycles (0: not periodic within `max_cycles`) and s (of the last 64 cycles, or
        of one period)
    """
    no_tangent = np.empty((0, 2))
    features = np.zeros(stroboscope.FEATURES)
    history = np.full((2 * MAX_PERIOD, 2), np.inf)
    flights = np.zeros(2 * MAX_PERIOD)
    scale_0 = c.scale_w * c.scale_w
    scale_1 = c.scale_v
    candidate = 0
    repeats = 0
    for n in range(max_cycles):
        if stroboscope.cycle(c, series, state, no_tangent, features) != OK:
            return 0, math.nan
        flights[n % (2 * MAX_PERIOD)] = max(features[stroboscope.LONGEST_FLIGHT], features[stroboscope.AIRBORNE])
        found = 0
        for period in range(1, min(n, MAX_PERIOD) + 1):
            past = (n - period) % (2 * MAX_PERIOD)
            if (
                abs(state[0] - history[past, 0]) <= CLOSE * scale_0
                and abs(state[1] - history[past, 1]) <= CLOSE * scale_1
            ):
                found = period
                break
        history[n % (2 * MAX_PERIOD), :] = state
        if found > 0 and found == candidate:
            repeats += 1
        else:
            candidate = found
            repeats = 0
        if candidate > 0 and repeats >= candidate:
            longest = 0.0
            for k in range(candidate):
                longest = max(longest, flights[(n - k) % (2 * MAX_PERIOD)])
            return candidate, longest
    longest = 0.0
    for k in range(min(MAX_PERIOD, max_cycles)):
        longest = max(longest, flights[k])
    return 0, longest


@kernel
def settle_points(parameters, states, tolerance, max_cycles, periods, flights):
    """`settle` for n points: fills `periods` (int64) and `flights` (in excitation cycles), advances `states`."""
    series = contact.workspace()
    for i in range(parameters.shape[0]):
        c = contact.constants(parameters[i], tolerance)
        periods[i], flight = settle(c, series, states[i], max_cycles)
        flights[i] = flight / c.period


def continued(parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, duration: float) -> np.ndarray:
    """Parameter vectors, shape (n, 13), whose starts are the ends of runs of `duration` (s) of `parameters`."""
    later = np.array(parameters, dtype=np.float64)
    cycles = parameters[:, FREQUENCY] * duration
    later[:, PSI0] = (parameters[:, PSI0] + 2.0 * math.pi * (cycles - np.floor(cycles))) % (2.0 * math.pi)
    later[:, Z0] = z_end
    later[:, VZ0] = vz_end
    return later


def classify(
    parameters: np.ndarray,
    *,
    tolerance: float = 1e-8,
    search_cycles: int = SEARCH_CYCLES,
    threads: int = 1,
    progress: str | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """State of motion that each start ends in.

    Parameters
    ----------
    parameters : float64, shape (n, 13), rows as from model.pack; after a run, those of `continued`
    tolerance : of the contact steps
    search_cycles : excitation cycles within which most points repeat themselves
    threads, progress : as in sweep.run

    Returns
    -------
    state, period : str (one of STATES) and int64 (in excitation cycles, 0 for none), shape (n,)
    """
    parameters = np.ascontiguousarray(parameters, dtype=np.float64)
    points = lyapunov.initial_states(parameters, tolerance)
    finite = np.isfinite(points).all(axis=1)
    codes = np.full(len(parameters), UNDECIDED)
    periods = np.zeros(len(parameters), dtype=np.int64)
    flights = np.full(len(parameters), math.nan)

    def search(indices, cycles, label):
        rows, states = parameters[indices], points[indices]
        found, flight = np.zeros(len(indices), dtype=np.int64), np.empty(len(indices))

        def work(begin, end):
            part = slice(begin, end)
            settle_points(rows[part], states[part], tolerance, cycles, found[part], flight[part])

        for_each_chunk(work, len(indices), threads=threads, chunk=16, progress=label)
        points[indices], periods[indices], flights[indices] = states, found, flight
        settled = indices[found > 0]
        codes[settled] = np.where(flights[settled] >= LONG_FLIGHT, SECOND, FIRST)

    search(np.flatnonzero(finite), search_cycles, progress)
    # Points that share a conveyor share its attractors; ψ0 only shifts the phase at which they are looked at.
    open_points = np.flatnonzero(finite & (periods == 0) & np.isfinite(flights))
    if len(open_points):
        shared = parameters[open_points].copy()
        shared[:, [PSI0, Z0, VZ0]] = 0.0
        _, first, group = np.unique(shared, axis=0, return_index=True, return_inverse=True)
        witnesses = open_points[first]
        exponent = lyapunov.spectrum(
            parameters[witnesses], points[witnesses], transient=search_cycles, tolerance=tolerance, threads=threads
        )
        chaotic = exponent.lambda_1 > SIGNIFICANT * exponent.stderr
        codes[open_points[chaotic[group]]] = CHAOS
        patient = open_points[~chaotic[group]]
        if len(patient):
            search(patient, PATIENT_CYCLES, progress and f"{progress}: long transients")
            still = patient[periods[patient] == 0]
            if len(still):
                exponent = lyapunov.spectrum(
                    parameters[still], points[still], transient=0, tolerance=tolerance, threads=threads
                )
                codes[still[exponent.lambda_1 > SIGNIFICANT * exponent.stderr]] = CHAOS
                # Longer periods than are searched for are still regular motion.
                regular = exponent.lambda_1 < -SIGNIFICANT * exponent.stderr
                codes[still[regular]] = np.where(flights[still[regular]] >= LONG_FLIGHT, SECOND, FIRST)
    return np.array(STATES)[codes], periods
