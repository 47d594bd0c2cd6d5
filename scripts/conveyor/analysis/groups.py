"""The dimensionless groups of the vertical motion: what makes the vertical motion of two conveyors the same.

With the length g/ω² and the time 1/ω, the penetration x = δ ω²/g and its rate obey

    ẋ = y - D max(x, 0),   ẏ = 1 + Γ cos θ - K max(x, 0)^p,

    Γ = a_z/g,   D = d_c/(m ω),   K = (k_c/m) g^(p-1)/ω^(2p),

and p and the reading of tension. Nothing else enters: the angle of throw acts through a_z = â sin φ only, and neither
friction nor the horizontal motion act at all. A start adds ψ0, z0 ω²/g and ż0 ω/g.
"""

import math
from typing import NamedTuple

import numpy as np

from ..solver import model
from ..solver.model import PARAMETERS

# The groups that a derivative may be taken by, in the order of Groups.
NAMES = ("amplitude", "damping", "stiffness", "exponent")
# A conveyor whose units are those of its groups: g = 1, ω = 1, m = 1, φ = 90°.
FREQUENCY_OF_ONE = 0.5 / math.pi


class Groups(NamedTuple):
    """The groups of a vertical motion."""

    amplitude: float  # Γ = a_z/g
    damping: float  # D = d_c/(m ω)
    stiffness: float  # K = (k_c/m) g^(p-1)/ω^(2p)
    exponent: float  # p
    tension: int  # code of the reading of tension, see model.TENSION_MODES


def groups_of(parameters: np.ndarray) -> Groups:
    """The groups of packed parameters, shape (13,)."""
    acceleration, angle, frequency, _, stiffness, damping, _, mass, exponent, gravity, tension, *_ = parameters
    omega = 2.0 * math.pi * frequency
    return Groups(
        float(acceleration * math.sin(angle) / gravity),
        float(damping / (mass * omega)),
        float(stiffness / mass * gravity ** (exponent - 1.0) / omega ** (2.0 * exponent)),
        float(exponent),
        int(tension),
    )


def packed(groups: Groups, psi0: float = 0.0) -> np.ndarray:
    """Packed parameters, shape (13,), of the conveyor with g = ω = m = 1 that has these groups."""
    row = np.zeros(len(PARAMETERS))
    row[model.ACCELERATION], row[model.ANGLE], row[model.FREQUENCY] = groups.amplitude, 0.5 * math.pi, FREQUENCY_OF_ONE
    row[model.STIFFNESS], row[model.DAMPING], row[model.EXPONENT] = groups.stiffness, groups.damping, groups.exponent
    row[model.MASS] = row[model.GRAVITY] = 1.0
    row[model.TENSION], row[model.PSI0] = groups.tension, psi0
    return row


def units(parameters: np.ndarray) -> tuple[float, float]:
    """The units of length, g/ω² (m), and velocity, g/ω (m/s), of packed parameters."""
    omega, gravity = 2.0 * math.pi * parameters[model.FREQUENCY], parameters[model.GRAVITY]
    return float(gravity / omega**2), float(gravity / omega)


def amplitude_of(parameters: np.ndarray, ratio: float) -> float:
    """The amplitude â (m/s²) at which a_z/g is `ratio`, for packed parameters."""
    return float(ratio * parameters[model.GRAVITY] / math.sin(parameters[model.ANGLE]))


def slopes(parameters: np.ndarray) -> dict[str, np.ndarray]:
    """Derivatives of (D, K, p) by the parameters that are numbers, the amplitude apart: each of shape (3,).

    That by the exponent is at constant k_c in N/m^p, whose unit changes with p.
    """
    groups = groups_of(parameters)
    frequency, mass, gravity = (float(parameters[i]) for i in (model.FREQUENCY, model.MASS, model.GRAVITY))
    p, stiffness = groups.exponent, groups.stiffness
    length, _ = units(parameters)
    zero = np.zeros(3)
    return {
        "angle": zero,
        "frequency": np.array([-groups.damping, -2.0 * p * stiffness, 0.0]) / frequency,
        "psi0": zero,
        "stiffness": np.array([0.0, stiffness / float(parameters[model.STIFFNESS]), 0.0]),
        "damping": np.array([1.0 / (2.0 * math.pi * frequency * mass), 0.0, 0.0]),
        "friction": zero,
        "mass": np.array([-groups.damping, -stiffness, 0.0]) / mass,
        "exponent": np.array([0.0, stiffness * math.log(length), 1.0]),
        "gravity": np.array([0.0, (p - 1.0) * stiffness / gravity, 0.0]),
    }


def slopes_of_amplitude(parameters: np.ndarray, ratio: float, by_groups: np.ndarray) -> dict[str, float]:
    """Derivatives of the amplitude â (m/s²) of a bifurcation by each parameter, â/unit of it.

    ratio : Γ of the bifurcation
    by_groups : its derivatives by D, K and p, shape (3,)
    """
    amplitude = amplitude_of(parameters, ratio)
    found = {name: amplitude_of(parameters, float(by_groups @ slope)) for name, slope in slopes(parameters).items()}
    # â = Γ g/sin φ itself.
    found["angle"] -= amplitude / math.tan(parameters[model.ANGLE])
    found["gravity"] += amplitude / float(parameters[model.GRAVITY])
    return found
