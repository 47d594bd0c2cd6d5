"""The textbook theory of throw conveyors: a part that is thrown once per cycle and lands without a bounce.

Assumptions: the impact is perfectly plastic; the part does not slip on the plate in contact; each cycle has one throw,
which ends before the next one begins. Stiffness, damping, friction and the initial condition do not matter.

The plate moves as z_s = -(a_z/ω²) cos θ normal to the track and x_s = -(a_x/ω²) cos(θ + ε) along it, with θ = ωt,
a_z = â sin φ, a_x = â cos φ and the phase shift ε. The track rises by the inclination α. With the throw number

    Γ = a_z/(g cos α)

the part leaves the plate where the plate's acceleration is that of the part in flight, a_z cos θ₀ = -g cos α:

    cos θ₀ = -1/Γ,   sin θ₀ > 0.

The flight lasts n/f. It ends where the parabola meets the plate again, z_s(θ₀) + ż_s(θ₀) n/f - g cos α (n/f)²/2 =
z_s(θ₁) with θ₁ = θ₀ + 2πn. Divided by a_z/ω², with N = 2πn and 1/Γ = -cos θ₀, this is

    cos θ₀ (N²/2 - 1 + cos N) + sin θ₀ (N - sin N) = 0,

so that the throw number of a flight follows from tan θ₀ in closed form:

    Γ² = 1 + tan² θ₀ = 1 + [(N²/2 - 1 + cos N)/(N - sin N)]².

There is no throw where Γ ≤ 1. The flight fills the cycle (n = 1) at Γ = √(1 + π²) ≈ 3.30; beyond it, there is no motion
with one throw per cycle.

Over one cycle the part moves in flight with the velocity of take-off, and downhill gravity pulls it back; from θ₁ to
θ₀ + 2π it moves with the plate:

    v/f = ẋ_s(θ₀) n/f - (g sin α/2) (n/f)² + x_s(θ₀) - x_s(θ₁).

For a level straight-line drive (α = ε = 0) x_s = z_s cot φ, and the equation of the flight times cot φ turns this into
the textbook formula v = g n² cot φ/(2 f).
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import check_array, check_parameter
from ..parameters import PARAMETERS, RANGES, UNITS, normal_gravity
from ..solver import plate
from ..solver.model import check_harmonics, pack_harmonics

LONGEST_THROW = math.sqrt(1.0 + math.pi**2)  # Γ at which the flight fills the cycle
SHORT = 5e-3  # rad, half the turn N below which its power series is free of cancellation
NO_HARMONICS = np.zeros(0)
HALVINGS = 60  # of [0, 1], beyond the precision of n


def check_arguments(acceleration: ArrayLike, others: Mapping[str, object], **parameters: float) -> tuple:
    """Amplitudes as an array, and parameters as floats; TypeError or ValueError names one that cannot be used."""
    for name in others:
        if name not in (*PARAMETERS, "harmonics"):
            raise TypeError(f"{name} is not one of {', '.join(PARAMETERS)}")
    numbers = (check_parameter(name, value) for name, value in parameters.items())
    amplitudes = check_array("acceleration", acceleration, *RANGES["acceleration"], UNITS["acceleration"], least=0)
    return amplitudes, *numbers


def throw_number(
    acceleration: ArrayLike,
    *,
    angle: float,
    gravity: float,
    inclination: float = 0.0,
    harmonics: Sequence[Mapping[str, float]] = (),
    **others: float | str,
) -> np.ndarray:
    """The throw number Γ at amplitudes (m/s²) of any shape; `others` do not matter.

    It is the plate's largest downward acceleration over g cos α, which is a_z/(g cos α) without harmonics.

    Examples
    --------
    >>> throw_number([40.0, 60.0], angle=np.radians(12.0), gravity=9.81).round(3).tolist()
    [0.848, 1.272]
    """
    numbers = {"angle": angle, "gravity": gravity, "inclination": inclination}
    acceleration, angle, gravity, inclination = check_arguments(acceleration, others, **numbers)
    share = plate.largest_fall(pack_harmonics(check_harmonics(harmonics)))
    gravity = normal_gravity({"gravity": gravity, "inclination": inclination})
    return acceleration * math.sin(angle) / gravity * share


def throw_number_of_flight(cycles: ArrayLike) -> np.ndarray:
    """The throw number Γ whose flight lasts n = `cycles` excitation cycles, 0 < n ≤ 1, same shape."""
    turn = 2.0 * math.pi * np.asarray(cycles, dtype=np.float64)
    half = np.maximum(0.5 * turn, SHORT)
    slope = (half - np.sin(half)) * (half + np.sin(half)) / (half - np.sin(half) * np.cos(half))
    return np.hypot(1.0, np.where(turn < 2.0 * SHORT, turn / 4.0 * (1.0 + turn * turn / 60.0), slope))


def flight_cycles(throw: ArrayLike) -> np.ndarray:
    """Duration n of the flight in excitation cycles at throw numbers Γ, same shape.

    0 for Γ ≤ 1 (no throw), NaN for Γ > LONGEST_THROW (no flight of less than a cycle).
    """
    throw = np.asarray(throw, dtype=np.float64)
    low, high = np.zeros(throw.shape), np.ones(throw.shape)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        longer = throw_number_of_flight(middle) < throw
        low, high = np.where(longer, middle, low), np.where(longer, high, middle)
    return np.select([throw <= 1.0, throw <= LONGEST_THROW], [0.0, 0.5 * (low + high)], np.nan)


def throw_velocity(
    acceleration: ArrayLike,
    *,
    angle: float,
    frequency: float,
    gravity: float,
    inclination: float = 0.0,
    phase_shift: float = 0.0,
    **others: float | str,
) -> np.ndarray:
    """Mean feeding velocity (m/s) at amplitudes (m/s²) of any shape; `others` do not matter.

    0 without a throw, NaN where the flight is longer than a cycle.

    Examples
    --------
    >>> velocity = throw_velocity([40.0, 60.0, 160.0], angle=np.radians(12.0), frequency=50.0, gravity=9.81)
    >>> velocity.round(4).tolist()
    [0.0, 0.0887, nan]
    """
    numbers = {"angle": angle, "gravity": gravity, "inclination": inclination}
    numbers |= {"frequency": frequency, "phase_shift": phase_shift}
    amplitude, angle, gravity, inclination, frequency, phase_shift = check_arguments(acceleration, others, **numbers)
    throw = throw_number(amplitude, angle=angle, gravity=gravity, inclination=inclination)
    cycles = flight_cycles(throw)
    omega = 2.0 * math.pi * frequency
    take_off = math.pi - np.arccos(1.0 / np.maximum(throw, 1.0))

    def plate_at(phase):
        return plate.motion(
            amplitude * math.cos(angle), amplitude * math.sin(angle), omega, phase_shift, NO_HARMONICS, phase
        )

    leaves, lands = plate_at(take_off), plate_at(take_off + 2.0 * math.pi * cycles)
    flight = cycles / frequency
    in_flight = leaves["vx"] * flight - 0.5 * gravity * math.sin(inclination) * flight**2
    return frequency * (in_flight + leaves["x"] - lands["x"])
