"""Lyapunov exponents from the variational equation.

They multiply the exact linearisation of the stroboscopic map, and satisfy
λ1 + λ2 = -(d_c/m) × (share of time with contact force) identically.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from ... import arguments
from ...arguments import MOST_BLOCKS, MOST_CYCLES, MOST_VALUES
from ...columns import Columns
from ...packing import check_rows
from ...parallel import for_each_chunk
from ...parameters import DEFAULT_TOLERANCE
from ...solver import contact, contact_law, plate
from ...solver.jit import compiled_entry
from ...solver.model import FREQUENCY, Conveyor
from ...solver.status import NOT_FINITE, OK, STATUS
from .. import stroboscopic_map
from ..dimensionless_groups import length_and_speed_units
from ..stroboscopic_map import AT_ONCE
from . import stretching

# Cycles within which a motion near its attractor repeats itself bit for bit, if it ever does.
REPEATS_WITHIN = 400
# A part that rides a stiff contact may never repeat itself bit for bit. Its motion counts as repeated, with a period of
# up to MAX_PERIOD cycles, if each of the last WATCHED cycles differs from the one a period before by at most ROUNDING,
# in g/ω² and g/ω.
ROUNDING, WATCHED = 1e-13, 100
# Excitation cycles after which the sign is decided. Weak chaos shows only after the second number.
LOOKS = (400, 2000)
BLOCKS = 20
# A second stretch that is smaller than the first by more than this logarithm is lost in rounding; λ1 + λ2 gives it.
LOST = -20.0
SIGNIFICANT = 3.0  # standard errors by which an exponent with a sign differs from zero


@compiled_entry
def fill_stretches(parameters, state, tolerance, harmonics, tangent, stretches, contact_times):
    """Follow a trajectory, and the stretching of its perturbations in each cycle; a code of status.STATUS.

    Parameters
    ----------
    parameters : float64, shape (16,)
    state : float64, shape (2,), δ (m) and v (m/s) at the phase ψ0; replaced by the last state
    tolerance : of the contact steps
    harmonics : as from plate.count_harmonics
    tangent : float64, shape (2, 2), two perturbations; replaced
    stretches : float64, shape (cycles, 2), see stretching, to fill up to a failure
    contact_times : float64, shape (cycles,), s, to fill up to a failure
    """
    c = contact.compute_constants(parameters, tolerance, harmonics)
    series = contact.workspace()
    features = np.zeros(stroboscopic_map.FEATURES)
    # Velocities count in units of ω × length, which makes both directions comparable.
    for n in range(len(stretches)):
        for k in range(2):
            tangent[k, 1] *= c.omega
        status = stroboscopic_map.advance(c, series, state, c.psi0, c.period, tangent, features)
        if status != OK:
            return status
        for k in range(2):
            tangent[k, 1] /= c.omega
        logs = stretches[n]
        stretching.orthonormalise(tangent, logs)
        if logs[1] < logs[0] + LOST:
            logs[1] = contact_law.log_contraction(c, features[stroboscopic_map.DAMPER_TIME]) - logs[0]
            tangent[1, 0], tangent[1, 1] = -tangent[0, 1], tangent[0, 0]
        contact_times[n] = features[stroboscopic_map.CONTACT_TIME]
    return OK


def lyapunov_spectrum(
    parameters: Conveyor | np.ndarray,
    states: ArrayLike | None = None,
    *,
    transient: int = 200,
    cycles: int = 100,
    blocks: int = 20,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """Both Lyapunov exponents of the motion normal to the track, from its linearisation.

    Parameters
    ----------
    parameters : from `parameter_table`, of any shape with n rows
    states : float64, shape (n, 2), stroboscopic states to begin with (default: the initial conditions in `parameters`);
        NaN for a motion that failed
    transient : excitation cycles that are discarded at the beginning, up to 1e6
    cycles, blocks : mean over `blocks` (2 to 1e4) blocks of `cycles` (1 to 1e6) excitation cycles
    tolerance, threads, progress : as in `sweep`

    Returns
    -------
    columns of the shape of `parameters`: lambda_1, the larger exponent, and lambda_2 (1/s); stderr (1/s), the standard
    error of lambda_1 from the means of the blocks, which is too small where correlations last longer than a block;
    contact_fraction, the share of the time with contact force; and status, "ok" or why the numbers are NaN

    Examples
    --------
    >>> spectrum = lyapunov_spectrum(parameter_table(Conveyor(), acceleration=[40.0, 80.0], z0=3e-4))
    >>> (spectrum.lambda_1 > 0.0).tolist()  # 1/s: chaos at 80 m/s²
    [False, True]
    >>> bool(np.allclose(spectrum.lambda_1 + spectrum.lambda_2, -0.3 / 0.7e-3 * spectrum.contact_fraction))
    True
    """
    parameters, shape = check_rows(parameters)
    tolerance = arguments.check_tolerance(tolerance)
    threads = arguments.check_threads(threads)
    arguments.check_count("transient", transient, 0, MOST_CYCLES)
    arguments.check_count("cycles", cycles, 1, MOST_CYCLES)
    arguments.check_count("blocks", blocks, 2, MOST_BLOCKS)
    if len(parameters) * blocks * cycles > MOST_VALUES:
        counted = f"blocks = {blocks} of cycles = {cycles} for {len(parameters)} trajectories"
        raise ValueError(f"{counted} are more than {MOST_VALUES:g} cycles; take fewer of them")
    if states is None:
        states = stroboscopic_map.initial_states(parameters, tolerance)
    else:
        states = arguments.check_states("states", states, (len(parameters), 2), may_be_nan=True)
    values, errors = np.empty((2, len(parameters), 2))
    contact_times = np.empty(len(parameters))
    codes = np.zeros(len(parameters), dtype=np.int64)
    harmonics = plate.count_harmonics(parameters)

    def work(begin, end):
        for i in range(begin, end):
            tangent, discarded = np.eye(2), (np.empty((transient, 2)), np.empty(transient))
            # The cycles of one row at a time: for many rows they would take gigabytes.
            measured = np.full((blocks * cycles, 2), np.nan), np.full(blocks * cycles, np.nan)
            for logs, contacts in (discarded, measured):
                for first in range(0, len(logs), AT_ONCE):
                    if codes[i] == OK:
                        target = logs[first : first + AT_ONCE], contacts[first : first + AT_ONCE]
                        row_arguments = parameters[i], states[i], tolerance, harmonics
                        codes[i] = fill_stretches(*row_arguments, tangent, *target)
            values[i], errors[i] = stretching.exponents(measured[0], blocks)
            contact_times[i] = measured[1].mean()

    for_each_chunk(work, len(parameters), threads=threads, chunk=4, progress=progress)
    period = 1.0 / parameters[:, FREQUENCY]
    # Where damping is so strong that a perturbation underflows within a cycle, no exponent is known.
    codes[(codes == OK) & ~np.isfinite(values).all(axis=1)] = NOT_FINITE
    values[codes != OK] = np.nan
    # Where both exponents are equal, the first tangent vector may have grown a little less.
    order = np.argsort(-values, axis=1, kind="stable")
    values, errors = (np.take_along_axis(numbers / period[:, None], order, axis=1) for numbers in (values, errors))
    # The durations of the pieces of a cycle may add up to slightly more than the period.
    contact_fraction = np.minimum(contact_times / period, 1.0)
    columns = {"lambda_1": values[:, 0], "lambda_2": values[:, 1], "stderr": errors[:, 0]}
    columns |= {"contact_fraction": contact_fraction, "status": np.array(STATUS, dtype=object)[codes]}
    return Columns({name: column.reshape(shape) for name, column in columns.items()})


def spectrum_from(
    parameters: np.ndarray, states: np.ndarray, cycles: int, *, tolerance: float, threads: int = 1
) -> Columns:
    """Exponents of motions over a number of cycles, from `states`, shape (n, 2), at pieces.BEGIN_OF_CYCLE."""
    counted = {"transient": 0, "cycles": cycles // BLOCKS, "blocks": BLOCKS}
    at_top = stroboscopic_map.begin_at_top(parameters)
    return lyapunov_spectrum(at_top, states, **counted, tolerance=tolerance, threads=threads)


def signs(parameters: np.ndarray, states: np.ndarray, *, tolerance: float, threads: int = 1) -> np.ndarray:
    """The signs of the larger exponents of motions, 1 or -1, int64, shape (n,); 0 where neither is significant.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack
    states : float64, shape (n, 2), stroboscopic states at pieces.BEGIN_OF_CYCLE
    tolerance, threads : as in `sweep`
    """
    sign = np.zeros(len(parameters), dtype=np.int64)
    for cycles in LOOKS:
        rows = np.flatnonzero(sign < 1)
        of_them = spectrum_from(parameters[rows], states[rows], cycles, tolerance=tolerance, threads=threads)
        # A failed motion has NaN here and keeps the sign 0. A sign that is not positive is checked again
        # after more cycles.
        different = np.abs(of_them.lambda_1) > SIGNIFICANT * of_them.stderr
        sign[rows] = np.where(different, np.sign(of_them.lambda_1), 0.0)
    return sign


def find_period(strobes: np.ndarray, unit: np.ndarray) -> int:
    """The number of cycles after which a motion repeats itself at the end of its strobes, shape (n, 2); 0 for none.

    unit : g/ω² and g/ω, shape (2,)
    """
    same = np.flatnonzero((strobes[:-1] == strobes[-1]).all(axis=1))
    if len(same):
        return len(strobes) - 1 - int(same[-1])
    return stroboscopic_map.repeated_period(strobes / unit, WATCHED, ROUNDING)


def repeating_motion(
    parameters: np.ndarray, state: np.ndarray, tolerance: float
) -> tuple[int, tuple[float, float], float]:
    """Period and Floquet multipliers of a motion that repeats itself from `state` on, or soon after.

    Parameters
    ----------
    parameters : float64, shape (16,)
    state : float64, shape (2,), δ (m) and v (m/s) at the phase ψ0; replaced
    tolerance : of the contact steps

    Returns
    -------
    period : excitation cycles after which the motion repeats itself; 0 if it does not
    logarithms : of the moduli of the Floquet multipliers, the larger one first
    contact_time : time with contact force in a period, s
    """
    nothing = 0, (math.nan, math.nan), math.nan
    status, strobes = stroboscopic_map.follow_map(parameters, tolerance, state, REPEATS_WITHIN)
    period = find_period(strobes, np.array(length_and_speed_units(parameters))) if status == OK else 0
    if not period:
        return nothing
    status, matrices, features = stroboscopic_map.monodromy(parameters, tolerance, state, period, 0.0)
    constants = contact.constants(parameters, tolerance)
    contractions = contact_law.log_contraction(constants, features[:, stroboscopic_map.DAMPER_TIME])
    logarithms = stretching.log_multipliers(matrices, contractions)
    if status != OK or not math.isfinite(logarithms[0]):
        return nothing
    return period, logarithms, float(features[:, stroboscopic_map.CONTACT_TIME].cumsum()[-1])


def lyapunov_spectrum_on_attractors(
    parameters: np.ndarray,
    *,
    cycles: int,
    blocks: int,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """Both vertical Lyapunov exponents of motions that begin on their attractors, or close to them.

    A motion that repeats itself within REPEATS_WITHIN cycles, but for rounding, has the exponents of its Floquet
    multipliers, with a standard error of 0. Any other motion is followed by `lyapunov_spectrum`.

    Parameters
    ----------
    parameters, cycles, blocks, tolerance, threads, progress : as in `lyapunov_spectrum`, with the shape (n,)

    Returns
    -------
    the columns of `lyapunov_spectrum`, shape (n,)

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), acceleration=[40.0, 80.0], z0=3e-4)
    >>> settled = sweep(parameters, duration=20.0)
    >>> parameters = restart(parameters, settled.z_end, settled.vz_end, 20.0)
    >>> spectrum = lyapunov_spectrum_on_attractors(parameters, cycles=100, blocks=20)
    >>> (spectrum.stderr == 0.0).tolist()  # a periodic orbit, and chaos
    [True, False]
    """
    parameters, _ = check_rows(parameters)
    tolerance, threads = arguments.check_tolerance(tolerance), arguments.check_threads(threads)
    states = stroboscopic_map.initial_states(parameters, tolerance)
    logarithms, contact_times = np.empty((len(parameters), 2)), np.empty(len(parameters))
    periods = np.zeros(len(parameters), dtype=np.int64)

    def work(begin, end):
        for i in range(begin, end):
            periods[i], logarithms[i], contact_times[i] = repeating_motion(parameters[i], states[i], tolerance)

    for_each_chunk(work, len(parameters), threads=threads, chunk=4)
    followed = lyapunov_spectrum(
        parameters[periods == 0],
        transient=0,
        cycles=cycles,
        blocks=blocks,
        tolerance=tolerance,
        threads=threads,
        progress=progress,
    )
    time = np.maximum(periods, 1) / parameters[:, FREQUENCY]
    lambda_1, lambda_2 = (logarithms / time[:, None]).T
    spectrum = {"lambda_1": lambda_1, "lambda_2": lambda_2, "stderr": np.zeros(len(time))}
    spectrum["contact_fraction"] = np.minimum(contact_times / time, 1.0)
    spectrum["status"] = np.full(len(time), STATUS[OK], dtype=object)
    for name, values in followed.items():
        spectrum[name][periods == 0] = values
    return Columns(spectrum)
