"""Peaks that are cut off before some noise, also in a recording of few phases.

A wave of few harmonics explains the readings between their extremes, and would exceed a flat extreme.
"""

import math

import numpy as np

from conveyor_pipeline.machine.excitation.harmonics import PHASES

HALVINGS = np.arange(5, 13)  # widths of the strips at both extremes, in halves of the span of the readings
LEAST = 8  # samples in a strip
# Standard errors by which the wave must exceed the readings in a strip, standard deviations of these readings, and
# errors that missing orders make by way of the readings between.
SURE, FLAT, EXPLAINED = 6.0, 4.0, 6.0
CHANCE = 1e-3  # that more orders seem to explain the readings between the extremes better
SINGULAR = 1e12  # condition number of samples at too few phases
SPARE = 6  # different phases that must remain beyond those that the unknowns need
# Width of a strip at each extreme, as a share of the span, and a share of the readings that no wave of a drive has in
# each of both strips: a cosine has 0.09 and 0.14, and hardly any wave with three harmonics of up to 0.35 has more.
FLAT_TOPS = ((0.02, 0.2), (0.05, 0.3))


def exceeds(values: np.ndarray, quantum: float, design: np.ndarray, width: float) -> bool:
    """Whether a wave that explains the values between strips of one width at their extremes exceeds the upper strip."""
    from scipy.special import fdtri

    strip = values >= values.max() - width
    if np.count_nonzero(strip) < LEAST:
        return False
    between = (values > values.min() + 2.0 * width) & (values < values.max() - 2.0 * width)
    part = design[:, between]
    count = np.count_nonzero(between)
    orders = len(design) // 2 - 1
    gram, products = part @ part.T, part @ values[between]
    if count <= 2 * len(design) or np.linalg.cond(gram) > SINGULAR:
        return False
    explained = products @ np.linalg.solve(gram, products)
    variance = max(values[between] @ values[between] - explained, 0.0) / (count - len(design))
    flat = values[strip].std() + quantum
    phases = np.arctan2(part[2 + orders], part[2]) / (2.0 * math.pi)
    separate = len(np.unique(np.round(PHASES * phases) % PHASES))
    # Between fewer phases, orders that are missing would hide by chance.
    for low in range(1, min(orders, (separate - SPARE) // 2)):
        rows = np.r_[: 2 + low, 2 + orders : 2 + orders + low]
        inverse = np.linalg.inv(gram[np.ix_(rows, rows)])
        mean = design[np.ix_(rows, strip)].mean(axis=1)
        coefficients = inverse @ products[rows]
        extra_terms = 2 * (orders - low)
        excess = coefficients @ mean - values[strip].mean()
        leverage = mean @ inverse @ mean
        chance = extra_terms * variance * fdtri(extra_terms, count - len(design), 1.0 - CHANCE)
        is_explained = explained - coefficients @ products[rows] < chance + (excess / EXPLAINED) ** 2 / leverage
        if is_explained and excess > max(SURE * math.sqrt(variance * leverage), FLAT * flat):
            return True
    return False


def has_flat_tops(readings: np.ndarray) -> bool:
    """Whether readings, shape (n,), stay at both extremes as only a wave whose peaks are cut off by a third does."""
    below, above = readings - readings.min(), readings.max() - readings
    return any(
        min((side <= width * below.max()).mean() for side in (below, above)) > share for width, share in FLAT_TOPS
    )


def is_cut_off(readings: np.ndarray, quantum: float, design: np.ndarray) -> bool:
    """Whether the peaks of one column are cut off above or below.

    readings : with the smallest step `quantum`, m/s², shape (n,)
    design : offset, drift, cosines and sines of the harmonics as rows, shape (2 + 2 K, n)
    """
    centred = readings - readings.mean()
    widths = np.ptp(readings) * 0.5**HALVINGS
    return any(exceeds(values, quantum, design, width) for values in (centred, -centred) for width in widths)
