"""The paper's estimates: the Lyapunov exponent from pairs of trajectories (Eq. 23), and box counting (Sect. 4.2).

With the times at which phase portraits are sampled, also for other estimates.
"""

import numpy as np

from conveyor import Dimension, sample_runs
from conveyor.analysis.fractals.scaling_region import normalise
from conveyor.linear_algebra import fit_line
from conveyor.parameters import DEFAULT_STEP, LAST
from conveyor.progress import progress_bar

SAMPLES = 501  # times in the share LAST of a run: over 40 per cycle of the paper; more do not change the mean
# Excitation cycles between the points of portraits: ten time steps of the paper; in a settled motion the golden ratio,
# which spreads the points of a periodic one evenly over its orbit.
INTERVAL, SETTLED_INTERVAL = 2.5e-4, 0.6180339887498949
THEILER = 20  # points of a settled motion, which are twelve cycles: closer pairs are left out of a correlation sum
BOX_SIZES = 0.5 ** np.arange(1, 9)  # 1/2 to 1/256 of the extent; open: sizes at which the points resolve a curve


def finite_difference_exponent(
    parameters: np.ndarray,
    perturbed: np.ndarray,
    epsilon: float,
    *,
    output: str,
    duration: float = 1.0,
    last: float = LAST,
    method: str = "event",
    step: float = DEFAULT_STEP,
    progress: str | None = None,
    **options,
) -> np.ndarray:
    """The paper's estimate of the Lyapunov exponent, (1/t) log(|Δ output| / ε) (Eq. 23), averaged over a run's end.

    Returns float64, shape (n,), 1/s. A difference below the resolution of the signal counts as that resolution.

    Parameters
    ----------
    parameters, perturbed : tables, shape (n,): the trajectories and their neighbours
    epsilon : size of the perturbation, in the unit of the perturbed parameter
    output : the signal that is compared, a column of `sample_runs`
    last : the mean is taken over this last part of the run, a share in (0, 1)
    duration, method, step, progress, options : as in `sweep`
    """
    times = np.linspace((1.0 - last) * duration, duration, SAMPLES)
    if method != "event":
        times = np.rint(times / step) * step
    options |= {"columns": [output], "method": method, "step": step, "chunk": 16}
    moments = np.tile(times, (len(parameters), 1))
    with progress_bar(total=2 * len(parameters), label=progress) as shown:
        # Fixed steps of alike plates take less time, and a perturbed phase is another plate.
        tables = parameters, perturbed
        signal, shifted = (sample_runs(table, moments, progress=shown, **options)[output] for table in tables)
    resolution = np.finfo(np.float64).eps * np.maximum(np.abs(signal), np.abs(shifted)).max(axis=1, keepdims=True)
    difference = np.maximum(np.abs(shifted - signal), resolution)
    return np.mean(np.log(difference / epsilon) / times, axis=1)


def box_dimension_of_paper(points: np.ndarray) -> Dimension:
    """Box counting of `points`, shape (n, 2), without precautions: one grid, a line through the counts of all sizes.

    The error is twice the standard error of the slope, as if the counts scattered independently.
    """
    points = normalise(points)
    scales = BOX_SIZES
    boxes = ((points * (1.0 / size)).astype(np.int64) for size in scales)
    counts = np.array([len(np.unique(across << 32 | along)) for across, along in (box.T for box in boxes)], float)
    slope, _, error = fit_line(np.log(scales), np.log(counts))
    return Dimension(-slope, 2.0 * error, scales[-1], scales[0], scales, counts)
