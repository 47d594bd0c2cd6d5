"""The largest Lyapunov exponent from pairs of trajectories, as in the paper."""

import numpy as np

from ...methods import fixed_step
from ...packing import as_rows
from ...parallel import for_each_chunk
from ...parameters import DEFAULT_STEP, DEFAULT_TOLERANCE
from ...solver import trajectory
from ...solver.record import SAMPLES


def finite_difference_exponent(
    parameters: np.ndarray,
    perturbed: np.ndarray,
    epsilon: float,
    *,
    output: str = "vx",
    duration: float = 1.0,
    last: float = 0.25,
    samples: int = 501,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    threads: int = 1,
    progress: str | None = None,
) -> np.ndarray:
    """The paper's estimate of the Lyapunov exponent, (1/t) log(|Δ output| / ε) (Eq. 23), averaged over a run's end.

    Returns float64, shape (n,), 1/s. A difference below the resolution of the signal counts as that resolution.
    ValueError if `last` leaves no end of the run, or takes all of it.

    Parameters
    ----------
    parameters, perturbed : tables, shape (n,): the trajectories and their neighbours
    epsilon : size of the perturbation, in the unit of the perturbed parameter
    output : the signal that is compared, one of record.SAMPLES
    last, samples : the mean is taken over `samples` equidistant times in the last part of the run
    duration, method, tolerance, step, threads, progress : as in `sweep`

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), acceleration=[40.0, 80.0], z0=3e-4)
    >>> perturbed = replace_parameters(parameters, z0=3e-4 + 1e-9)
    >>> exponents = finite_difference_exponent(parameters, perturbed, 1e-9, output="z", duration=0.5)
    >>> (exponents > 0.0).tolist()  # the neighbours separate at 80 m/s²
    [False, True]
    """
    if not 0.0 < last < 1.0:
        raise ValueError(f"last = {last!r} must be a share of the run in (0, 1): at its beginning Eq. 23 has no value")
    column = SAMPLES.index(output)
    feeding = output not in ("z", "vz", "contact_force")
    times = np.linspace((1.0 - last) * duration, duration, samples)
    if method != "event":
        indices = np.rint(times / step).astype(np.int64)
        times = indices * step
    tables = np.stack([as_rows(parameters), as_rows(perturbed)])
    signals = np.empty((*tables.shape[:2], len(times)))

    def work(begin, end):
        # Fixed steps of alike plates take less time, and a perturbed phase is another plate.
        for rows, signal in zip(tables, signals, strict=True):
            if method == "event":
                moments = np.tile(times, (end - begin, 1))
                samples, _ = trajectory.integrate(rows[begin:end], moments, tolerance=tolerance, feeding=feeding)
            else:
                _, samples, _ = fixed_step.follow(rows[begin:end], step, indices[-1], method, indices)
            signal[begin:end] = samples[:, :, column]

    # Chunks of fixed-step runs fill the lanes of a register.
    for_each_chunk(work, tables.shape[1], threads=threads, chunk=1 if method == "event" else 16, progress=progress)
    here, there = signals
    resolution = np.finfo(np.float64).eps * np.maximum(np.abs(here), np.abs(there)).max(axis=1, keepdims=True)
    difference = np.maximum(np.abs(there - here), resolution)
    return np.mean(np.log(difference / epsilon) / times, axis=1)
