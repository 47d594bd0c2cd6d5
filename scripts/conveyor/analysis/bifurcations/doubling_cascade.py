"""Cascades of period doublings: their doublings, Feigenbaum's ratios and where they accumulate."""

import numpy as np
from numpy.typing import ArrayLike

from ...arguments import check_series
from ...packing import replace_parameters
from ...progress import progress_bar
from .continuation import Bifurcation, check_doubling, multiplier_test
from .periodic_orbits import orbit_near, settled_orbit

FEIGENBAUM = 4.669201609102990  # limit of the ratios of `doubling_ratios` (Feigenbaum 1978; digits: Briggs 1991)
RESOLVED = 1e-6  # of 1 + μ at a doubling of the cascade: six digits of its distance to the next one
SECANT_STEPS = 12  # after which a doubling of the cascade is not resolved


def doubling_cascade(first: Bifurcation, second: Bifurcation, *, progress: str | None = None) -> list[Bifurcation]:
    """Two successive period doublings and the doublings behind them, as far as double precision resolves them.

    The distance between doublings shrinks by Feigenbaum's ratio each time. Halfway to the next doubling the doubled
    orbit is about superstable, so that a trajectory reaches it at once. Newton's iteration follows it in â from there
    to the multiplier -1. The cascade ends early where the next doubling is too far from this guess.

    Parameters
    ----------
    first, second : period doublings in the amplitude, the second one of the doubled orbit
    progress : as in `sweep`; the bar counts doublings, whose number is not known before

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=47.2, stiffness=5e7), Start(z=3e-4))
    >>> (first,) = continue_orbit(orbit, "acceleration", (46.9, 47.5)).bifurcations
    >>> (second,) = continue_orbit(find_doubled_orbit(first), "acceleration", (46.9, 57.0)).bifurcations
    >>> cascade = doubling_cascade(first, second)
    >>> [(doubling.orbit.period, round(doubling.orbit.acceleration, 3)) for doubling in cascade]  # m/s²
    [(1, 47.392), (2, 56.401), (4, 58.354)]
    """
    for name, doubling in (("first", first), ("second", second)):
        check_doubling(name, doubling)
        if doubling.parameter != "acceleration":
            raise ValueError(f"{name} must be a bifurcation in the acceleration, got one in the {doubling.parameter}")
    if second.orbit.period != 2 * first.orbit.period:
        raise ValueError(f"second has the period {second.orbit.period}, not twice the period of first")
    cascade = [first, second]
    with progress_bar(label=progress, unit="doublings") as shown:
        while (doubling := next_doubling(*cascade[-2:])) is not None:
            cascade.append(doubling)
            shown.update()
    return cascade


def next_doubling(first: Bifurcation, second: Bifurcation) -> Bifurcation | None:
    """The period doubling behind two successive ones; None where double precision or the guess does not reach it."""
    last = second.orbit
    gap = (last.acceleration - first.orbit.acceleration) / FEIGENBAUM
    period = 2 * last.period

    def at(acceleration):
        return replace_parameters(last.parameters, acceleration=acceleration)

    before = settled_orbit(at(last.acceleration + 0.5 * gap), last.state, (period,), 30 * period)
    if before is None:
        return None
    orbit = orbit_near(at(last.acceleration + 0.6 * gap), before.state, period)
    for _ in range(SECANT_STEPS):
        if orbit is None or abs(multiplier_test(orbit, -1.0)) <= RESOLVED:
            break
        # A secant step in â, from which Newton's iteration starts on the secant of the states.
        value = multiplier_test(orbit, -1.0)
        part = value / (multiplier_test(before, -1.0) - value)
        acceleration = orbit.acceleration + part * (orbit.acceleration - before.acceleration)
        state = orbit.state + part * (orbit.state - before.state)
        before, orbit = orbit, orbit_near(at(acceleration), state, period)
        if abs(acceleration - last.acceleration - gap) > 0.5 * abs(gap) or acceleration == before.acceleration:
            return None
    if orbit is None or abs(multiplier_test(orbit, -1.0)) > RESOLVED:
        return None
    return Bifurcation("period_doubling", orbit, min(value.real for value in orbit.multipliers), "acceleration")


def doubling_ratios(amplitudes: ArrayLike) -> np.ndarray:
    """Feigenbaum's ratios (d_n - d_(n-1))/(d_(n+1) - d_n) of successive doublings, shape (n - 2,).

    Examples
    --------
    >>> doubling_ratios(np.array([54.21824, 61.27324, 62.47738, 62.7079])).round(2).tolist()
    [5.86, 5.22]
    """
    gaps = np.diff(check_series("amplitudes", amplitudes, may_be_nan=True))
    if not (np.abs(gaps[1:]) > 0.0).all():
        raise ValueError("amplitudes of successive doublings must be numbers that differ")
    return gaps[:-1] / gaps[1:]


def accumulation_point(amplitudes: ArrayLike) -> tuple[float, float]:
    """Limit of successive doublings by Aitken's process, and its error, the change by the last one; NaN for none.

    Examples
    --------
    >>> limit, error = accumulation_point(np.array([54.21824, 61.27324, 62.47738, 62.7079]))  # m/s²
    >>> round(limit, 3), round(error, 3)
    (62.762, 0.037)
    """
    amplitudes = check_series("amplitudes", amplitudes, may_be_nan=True)
    if len(amplitudes) < 4 or not (np.diff(np.abs(np.diff(amplitudes[-4:]))) < 0.0).all():
        return np.nan, np.nan
    before, gap = amplitudes[:-2], np.diff(amplitudes)
    limits = before - gap[:-1] ** 2 / (gap[1:] - gap[:-1])
    return float(limits[-1]), float(abs(limits[-1] - limits[-2]))
