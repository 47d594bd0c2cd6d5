"""Lines of two sensors in one file, in any order: two drives fit them much better than one."""

import math

import numpy as np

from conveyor_pipeline.machine.excitation.harmonics import Fit, design_of, orders_of, project, sampling_rate

ROUNDS = 8
# Two sensors leave at most this share of what one fit leaves; two fits of one noise leave 68 %, of a sine 19 %.
LEFT = 0.15
USUAL = 0.99  # share of the lines that are no spikes
LEAST_LINES = 0.1  # share of the lines of the second sensor
MOST_UNEVEN = 0.5  # difference of the second sensor's share between the halves of the recording
LEAST_TURNS = 0.02  # changes from one sensor to the other per clear line: drives do not change at once and often


def mixture_of(time: np.ndarray, signals: np.ndarray, fitted: Fit) -> float | None:
    """Largest relative difference of the amplitudes of two sensors that a recording mixes, or None.

    Each line belongs to the sensor whose fit is nearer, and each fit uses its own lines (Späth 1979).
    """
    centred = time - fitted.middle
    design = design_of(centred, centred[-1], fitted.frequency, fitted.orders)
    wave = (fitted.amplitudes[:, :1] * np.exp(2j * math.pi * fitted.frequency * centred)).real
    is_second = (fitted.residual * wave).sum(axis=0) > 0.0
    for _ in range(ROUNDS):
        parts = (~is_second, is_second)
        if min(map(np.count_nonzero, parts)) < max(LEAST_LINES * len(time), 2 * len(design)):
            return None
        solutions = [np.linalg.lstsq(design[:, part].T, signals[:, part].T, rcond=None)[0] for part in parts]
        errors = np.array([((signals - solution.T @ design) ** 2).sum(axis=0) for solution in solutions])
        is_second = errors[1] < errors[0]
    # Where the signal is small, both fits are equally near.
    is_clear = np.abs(errors[1] - errors[0]) > np.median(np.abs(errors[1] - errors[0]))
    turns = np.diff(is_second[is_clear]).mean()
    first_share, last_share = (half.mean() for half in np.array_split(is_second[is_clear], 2))
    if abs(last_share - first_share) > MOST_UNEVEN:  # an amplitude that rises or falls
        return None
    sizes = (fitted.residual**2).sum(axis=0)
    is_usual = sizes <= np.quantile(sizes, USUAL)
    if errors.min(axis=0)[is_usual].sum() > LEFT * sizes[is_usual].sum() or turns < LEAST_TURNS:
        return None
    # Every second cycle may be another one, or there are harmonics of high orders.
    orders = orders_of(sampling_rate(time), fitted.frequency)
    halves = project(centred, fitted.residual, 0.5 * fitted.frequency, 2 * orders)[1]
    if (halves**2).sum() < 0.5 * sizes.sum():
        return None
    first, second = (np.hypot(solution[2], solution[2 + fitted.orders]) for solution in solutions)
    return float(np.abs(second / first - 1.0).max())
