"""Parameters of the drive from its harmonics, with standard errors.

The conventions are the model's. The phase of the excitation θ is zero where the fundamental normal to the track has its
maximum, so that

    normal = â sin φ [cos θ + Σ normal_k cos(kθ + normal_phase_k)],
    along = â cos φ [cos(θ + ε) + Σ along_k cos(kθ + along_phase_k)].

â cos φ and â sin φ are the amplitudes of the two fundamentals, so φ lies between 0 and π/2. A plate that throws
backwards has an ε near π. Shares are positive, and phases lie in (-π, π].

Standard errors come from the recording itself. What remains without the harmonics, shifted by k f, is the error of
harmonic k as a slow function of time. Its spectrum near zero tells the variance of its mean, whether the noise is white
or coloured, and also where the amplitude or the phase of the drive wanders. Amplitude (real part) and phase (imaginary
part) have spectra of their own. All standard errors are scaled such that ±1.96 of them is a 95 % interval, although
the variance is estimated from few numbers.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import f as f_distribution
from scipy.stats import t as t_distribution

from conveyor_pipeline.machine.excitation.gravity import NO_GRAVITY, Gravity, wrap
from conveyor_pipeline.machine.excitation.harmonics import Fit, drift_between_axes, duration_of, phases_of
from conveyor_pipeline.machine.excitation.modulation import modulation_of
from conveyor_pipeline.machine.excitation.reading import AXES, Recording, turn
from conveyor_pipeline.machine.excitation.sample_times import CHECKED

PARAMETERS = {"acceleration": "m/s²", "frequency": "Hz", "angle": "rad", "phase_shift": "rad"}
SHARES = ("along", "along_phase", "normal", "normal_phase")
# Frequencies on either side of a harmonic, in units of 1/T, and the first of them, among which a line beside the drive
# stands out by this factor, which noise hardly reaches.
MOST_SIDEBANDS, NEAREST, BESIDE = 24, 3, 3.0
SLOW = 3  # first of them, at which a wandering phase shows
# A random walk of the phase has a slope whose variance is this multiple of what the SLOW frequencies would say of white
# noise; it counts where their power is clearly above the noise.
WALK, CLEAR = 12.0, 2.0
BLOCKS = 4096  # at most, into which the recording is summed; a block is short against the period of every sideband
NORMAL = 1.96  # half width of a 95 % interval in standard errors
# Chance that any harmonic counts as above the noise, if there are none: an overlay with a false one would change the
# model, while a true one that is missed for this reason lies within 1.3 times the limit of a chance of 1 %.
CHANCE = 1e-4
# Sidebands on either side whose mean power is the noise of a harmonic: its power must exceed each of these means, as
# noise may rise towards it. The limit for few sidebands is higher.
WINDOWS = (3, 6, 12, 24)
# 95 % quantile of the size of a complex number of pure noise, over 1.96: for shares below the noise, which have a bias.
BELOW = math.sqrt(-2.0 * math.log(0.05)) / NORMAL


class Noise(NamedTuple):
    """Relative errors of the harmonics as slow functions of time, at frequencies m/T."""

    amplitude: np.ndarray  # complex, real part of the error, axis j, order k, sideband m, shape (2, K, M)
    phase: np.ndarray  # complex, imaginary part of the error (rad), same shape
    slow: np.ndarray  # the phase again, at the SLOW first frequencies, shape (2, K, SLOW)
    power: np.ndarray  # mean of both sides of both parts together, from the first sideband on, shape (2, K, 1 + M)
    added: np.ndarray  # variance of an amplitude or a phase from the steps of the converter, shape (2, K)
    degrees: int  # of freedom of each variance

    @property
    def student(self) -> float:
        """Factor from a standard deviation of few degrees of freedom to one whose 1.96-fold is a 95 % interval."""
        return float(t_distribution.ppf(0.975, self.degrees)) / NORMAL


def step_variance(recording: Recording, fit: Fit) -> np.ndarray:
    """Variance of each amplitude (m²/s⁴) from the steps of the converter, shape (2,).

    Steps act as noise if the noise is larger than a step. Otherwise they distort the signal. If the samples fall on
    ever new phases, the steps q make harmonics with the mean square 0.0246 q³/A (from Blachman 1985). If every cycle
    is sampled at the same phases, only the samples of one cycle average the errors of the steps.
    """
    step = recording.quanta.max()
    noise = np.maximum((fit.residual**2).mean(axis=1) - step**2 / 12.0, 0.0)
    distortion = 0.0123 * step**3 / np.abs(fit.amplitudes[:, 0]) + step**2 / (6.0 * phases_of(recording.time, fit))
    return distortion * np.exp(-4.0 * math.pi**2 * noise / step**2)


def timing_variance(recording: Recording, fit: Fit) -> np.ndarray:
    """Variance of each amplitude (m²/s⁴) from errors of the times that the noise does not show, shape (2, K).

    Errors of the phase with the variance σ² reduce an amplitude of order k by k² σ²/2. Rounded times whose errors
    repeat in every cycle make harmonics, as the steps of a converter do.
    """
    part = slice(0, CHECKED)
    scatter = modulation_of(recording.time[part], fit._replace(residual=fit.residual[:, part])).scatter
    orders = np.arange(1, fit.orders + 1)
    rounding = 2.0 * math.pi * fit.frequency * recording.resolution
    repeated = rounding**2 / (12.0 * phases_of(recording.time, fit)) * np.abs(fit.amplitudes[:, :1]) ** 2
    return repeated + (0.5 * orders**2 * scatter**2 * np.abs(fit.amplitudes)) ** 2


def relative_difference(fitted: Fit, other: Fit) -> np.ndarray:
    """Difference of the harmonics of two fits over those of the first, shape (2, K); their phases refer to the
    fundamental normal to the track."""
    orders = np.arange(1, fitted.orders + 1)
    first, second = (fit.amplitudes * np.exp(-1j * orders * np.angle(fit.amplitudes[1, 0])) for fit in (fitted, other))
    return np.abs(second / first - 1.0)


def wander_variance(fit: Fit, phase: np.ndarray) -> np.ndarray:
    """Relative variance of the amplitude of each order if the phase of the drive wanders slowly, shape (K,).

    A phase with the variance σ² against a constant frequency reduces the amplitude of order k by k² σ²/2. `phase` has
    the errors of the phase by axis, order and sideband.
    """
    weights = np.abs(fit.amplitudes[:, 0]) ** 2
    wander = 2.0 * (np.abs(weights @ phase[:, 0]) ** 2).sum() / weights.sum() ** 2
    return (0.5 * np.arange(1, fit.orders + 1) ** 2 * wander) ** 2


def noise_of(recording: Recording, fit: Fit, others: tuple[Fit, ...] = ()) -> Noise:
    """The errors of the harmonics near their frequencies; `others` are fits with other times of the samples."""
    time = recording.time - fit.middle
    count = len(recording.time)
    duration = duration_of(recording.time)
    cycles = fit.frequency * duration
    last = min(MOST_SIDEBANDS, math.ceil(cycles) - 1)
    shifts = np.arange(1, last + 1)
    begins = np.linspace(0, count, min(count, BLOCKS), endpoint=False).astype(np.int64)
    sizes = np.diff([*begins, count])
    middles = np.add.reduceat(time, begins) / sizes
    turns = np.exp(-2j * math.pi * shifts[:, None] * middles / duration)  # shape (M, blocks)
    first = np.exp(-2j * math.pi * fit.frequency * time)
    # What the fit takes out of the noise, too.
    scale = 2.0 / count * math.sqrt(count / (count - 2.0 * fit.orders - 2.5))
    above, below = np.empty((2, 2, fit.orders, len(shifts)), dtype=np.complex128)
    wave = np.ones_like(first)
    for order in range(fit.orders):
        wave *= first
        for axis in range(2):
            blocks = np.add.reduceat(fit.residual[axis] * wave, begins)
            above[axis, order], below[axis, order] = scale * (turns @ blocks), scale * (np.conj(turns) @ blocks)
    size = fit.amplitudes[:, :, None]
    above, below = above / size, below / size
    added = (step_variance(recording, fit)[:, None] + timing_variance(recording, fit)) / np.abs(fit.amplitudes) ** 2
    for other in others:
        added += relative_difference(fit, other) ** 2
    pair = 0.5 * (above + np.conj(below)), -0.5j * (above - np.conj(below))
    added += wander_variance(fit, pair[1])
    amplitude, phase = pair
    return Noise(
        amplitude, phase, pair[1][..., :SLOW], sum(np.abs(part) ** 2 for part in pair), added, 2 * amplitude.shape[-1]
    )


def variance(error: np.ndarray) -> np.ndarray:
    """Variance of the mean of a slow function of time, from its spectrum near zero along the last axis.

    The mean over all frequencies, or over the nearest ones if it is clearly larger, as where another vibration lies
    beside the drive.
    """
    power = np.abs(error) ** 2
    mean, near = power.mean(axis=-1), power[..., :NEAREST].mean(axis=-1)
    return np.where(near > BESIDE * mean, near, mean)


def values_of(amplitudes: np.ndarray, frequency: float) -> dict[str, float]:
    """The value of each of PARAMETERS."""
    along, normal = amplitudes[:, 0]
    return {
        "acceleration": math.hypot(abs(along), abs(normal)),
        "frequency": frequency,
        "angle": math.atan2(abs(normal), abs(along)),
        "phase_shift": float(wrap(np.angle(along) - np.angle(normal))),
    }


def parameters(
    recording: Recording, fit: Fit, noise: Noise, gravity: Gravity = NO_GRAVITY, rate_error: float = 0.0
) -> dict[str, tuple[float, float]]:
    """Value and standard error of each of PARAMETERS.

    Where gravity deviates, the scale or the mount of the sensor is wrong by this much, or not at all, if the sensor has
    an offset. An interval contains both, so the deviation widens it once, beside the noise. The scale may be that of
    one axis alone, which changes the angle. So do a sensor that its third axis shows turned, and a phase that drifts.

    rate_error : relative standard error of the sampling rate
    """
    along, normal = fit.amplitudes[:, 0]
    acceleration = math.hypot(abs(along), abs(normal))
    cosine, sine = abs(along) / acceleration, abs(normal) / acceleration
    by_axis, added = noise.amplitude[:, 0], noise.added[:, 0]
    # The phase ωt, to which every harmonic contributes with its weight in the least squares.
    orders = np.arange(1, fit.orders + 1)
    weights = orders * np.abs(fit.amplitudes) ** 2
    total = (orders * weights).sum()
    phase = np.einsum("jk,jkm->m", weights, noise.phase) / total
    # A phase that wanders looks like another frequency.
    near, slow = variance(phase), variance(np.einsum("jk,jkm->m", weights, noise.slow) / total)
    spread = max(near, slow, WALK * (slow - CLEAR * near)) + (weights**2 * noise.added).sum() / total**2
    errors = {
        "acceleration": acceleration**2
        * (variance(cosine**2 * by_axis[0] + sine**2 * by_axis[1]) + cosine**4 * added[0] + sine**4 * added[1]),
        # The slope of a straight line through the phase of white noise (Rife and Boorstyn 1974).
        "frequency": 12.0 * spread / (2.0 * math.pi * duration_of(recording.time)) ** 2,
        "angle": (sine * cosine) ** 2 * (variance(by_axis[1] - by_axis[0]) + added.sum()),
        "phase_shift": variance(noise.phase[0, 0] - noise.phase[1, 0]) + added.sum(),
    }
    # Any phase between begin and end may be the right one.
    drift = 0.5 * abs(drift_between_axes(recording.time, fit)) / NORMAL
    values = values_of(fit.amplitudes, fit.frequency)

    def change(name: str, mount: float, scale: ArrayLike, rate: float) -> float:
        scales = 1.0 + np.broadcast_to(scale, 2)[:, None]
        changed = values_of(scales * turn(fit.amplitudes, mount), fit.frequency * (1.0 + rate))
        return wrap(changed[name] - values[name]) if name == "phase_shift" else changed[name] - values[name]

    known = gravity.if_present
    scales = (known.size - 1.0) * np.array([[1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])  # of both axes, or of one
    return {
        name: (
            values[name],
            math.hypot(noise.student * math.sqrt(errors[name]), change(name, known.noise, known.noise, rate_error))
            + max(abs(change(name, known.lean, scale, 0.0)) for scale in scales) / NORMAL
            + abs(change(name, 0.0, [math.hypot(1.0, recording.across) - 1.0, 0.0], 0.0)) / NORMAL
            + (drift if name == "phase_shift" else 0.0),
        )
        for name in PARAMETERS
    }


def shares_of(amplitudes: np.ndarray, orders: np.ndarray) -> dict[str, np.ndarray]:
    """Shares and phases of the harmonics of some orders, by column name."""
    zero = np.angle(amplitudes[1, 0])
    columns = {}
    for axis, name in enumerate(AXES):
        columns[name] = np.abs(amplitudes[axis, 1:] / amplitudes[axis, 0])
        columns[f"{name}_phase"] = wrap(np.angle(amplitudes[axis, 1:]) - orders * zero)
    return columns


def harmonics(fit: Fit, noise: Noise, gravity: Gravity = NO_GRAVITY) -> dict[str, np.ndarray]:
    """Shares and phases of the harmonics of orders 2 and higher with their standard errors, and which of them are above
    the noise, by column name, each of shape (K - 1,)."""
    orders = np.arange(2, fit.orders + 1)
    tests = 2 * len(orders)
    columns: dict[str, np.ndarray] = {"order": orders}
    turned = turn(fit.amplitudes, math.hypot(gravity.if_present.lean, gravity.if_present.noise))
    values, rotated = shares_of(fit.amplitudes, orders), shares_of(turned, orders)
    for axis, name in enumerate(AXES):
        share, phase = values[name], values[f"{name}_phase"]
        variances = variance(noise.amplitude[axis]) + noise.added[axis], variance(noise.phase[axis]) + noise.added[axis]
        # A wrong mount shows harmonics of one axis in the other.
        leaked = np.abs(turned[axis] / fit.amplitudes[axis] - 1.0)[1:] ** 2
        systematic = 2.0 * noise.added[axis, 1:] + leaked
        above = np.ones(len(orders), dtype=bool)
        for window in WINDOWS:
            power = noise.power[axis, 1:, :window]
            limit = f_distribution.isf(CHANCE / max(tests, 1), 2, 4 * power.shape[-1])
            above &= limit * (power.mean(axis=-1) + systematic) < 1.0
        relative = noise.student * np.sqrt(variances[0][1:] + variances[0][0])
        columns[name] = share
        columns[f"{name}_stderr"] = np.hypot(share * relative * np.where(above, 1.0, BELOW), rotated[name] - share)
        columns[f"{name}_phase"] = phase
        of_zero = variance(noise.phase[1])[0] + noise.added[1, 0]
        error = noise.student * np.sqrt(variances[1][1:] + orders**2 * of_zero)
        error = np.hypot(error, wrap(rotated[f"{name}_phase"] - phase))
        # A harmonic below the noise may have any phase.
        columns[f"{name}_phase_stderr"] = np.where(above, error, math.pi / NORMAL)
        columns[f"{name}_above_noise"] = above
    columns["above_noise"] = columns["along_above_noise"] | columns["normal_above_noise"]
    return columns
