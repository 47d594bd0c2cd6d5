"""The dimensionless groups of the vertical motion: conveyors with equal groups have the same vertical motion.

With the length g/ω² and the time 1/ω, the penetration x = δ ω²/g and its rate obey

    ẋ = y - D max(x, 0),   ẏ = 1 + Γ cos θ - K max(x, 0)^p,

    Γ = a_z/g,   D = d_c/(m ω),   K = (k_c/m) g^(p-1)/ω^(2p),

and p and the treatment of tension, where g is the gravity normal to the track, g cos α; D belongs to the damper of the
contact law. Nothing else matters: the angle of throw acts only through a_z = â sin φ, and friction and the motion along
the track do not act on the vertical motion. An initial condition adds ψ0, z0 ω²/g and ż0 ω/g.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..packing import as_rows, refuse_harmonics
from ..solver import contact_law, model
from ..solver.model import PARAMETERS, normal_gravity

# The groups in the order of their derivatives. The last three, z0 ω²/g, ż0 ω/g and ψ0, are the initial condition.
GROUP_NAMES = ("amplitude", "damping", "stiffness", "exponent", "height", "velocity", "phase")
AMPLITUDE, DAMPING, STIFFNESS, EXPONENT, HEIGHT, VELOCITY, PHASE = range(len(GROUP_NAMES))
# The parameters that an equation between the groups may determine, and their groups.
GROUP_OF = {"acceleration": AMPLITUDE, "z0": HEIGHT}
# Parameters that move a single group, and the exponent, which also moves K and therefore comes last.
PARAMETER_OF = {
    AMPLITUDE: "acceleration",
    DAMPING: "damping",
    STIFFNESS: "stiffness",
    HEIGHT: "z0",
    VELOCITY: "vz0",
    PHASE: "psi0",
    EXPONENT: "exponent",
}
# A conveyor whose parameters equal its dimensionless groups: g = 1, ω = 1, m = 1, φ = 90°.
FREQUENCY_OF_ONE = 0.5 / math.pi


class Groups(NamedTuple):
    """The groups of a vertical motion."""

    amplitude: float  # Γ = a_z/g
    damping: float  # D = d_c/(m ω)
    stiffness: float  # K = (k_c/m) g^(p-1)/ω^(2p)
    exponent: float  # p
    tension: int  # code of the treatment of tension, see parameters.TENSION_MODES


def groups_of(parameters: np.ndarray) -> Groups:
    """The groups of one conveyor, a row of a table of parameters.

    Examples
    --------
    >>> groups = groups_of(parameter_table(Conveyor(acceleration=40.0)))
    >>> round(groups.amplitude, 4), round(groups.damping, 4), round(groups.stiffness, 2)
    (0.8478, 1.3642, 72.15)
    """
    parameters = as_rows(parameters)
    refuse_harmonics(parameters, "a motion that depends on dimensionless groups alone")
    omega, gravity = 2.0 * math.pi * parameters[model.FREQUENCY], normal_gravity(parameters)
    mass, exponent = parameters[model.MASS], parameters[model.EXPONENT]
    return Groups(
        float(parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE]) / gravity),
        float(parameters[model.DAMPING] / contact_law.unit_of_damping(mass, omega, gravity)),
        float(parameters[model.STIFFNESS] / mass * gravity ** (exponent - 1.0) / omega ** (2.0 * exponent)),
        float(exponent),
        int(parameters[model.TENSION]),
    )


def packed(groups: Groups, psi0: float = 0.0) -> np.ndarray:
    """Packed parameters, shape (16,), of the conveyor with g = ω = m = 1 that has these groups."""
    row = np.zeros(len(PARAMETERS))
    row[model.ACCELERATION], row[model.ANGLE], row[model.FREQUENCY] = groups.amplitude, 0.5 * math.pi, FREQUENCY_OF_ONE
    row[model.STIFFNESS], row[model.DAMPING], row[model.EXPONENT] = groups.stiffness, groups.damping, groups.exponent
    row[model.MASS] = row[model.GRAVITY] = 1.0
    row[model.TENSION], row[model.PSI0] = groups.tension, psi0
    return row


def length_and_speed_units(parameters: np.ndarray) -> tuple[float, float]:
    """The units of length, g/ω² (m), and velocity, g/ω (m/s), of one conveyor.

    Examples
    --------
    >>> length, speed = length_and_speed_units(parameter_table(Conveyor()))
    >>> round(1e6 * length, 1), round(1e3 * speed, 1)  # µm, mm/s
    (99.4, 31.2)
    """
    parameters = as_rows(parameters)
    omega, gravity = 2.0 * math.pi * parameters[model.FREQUENCY], normal_gravity(parameters)
    return float(gravity / omega**2), float(gravity / omega)


def amplitude_of(parameters: np.ndarray, ratio: float) -> float:
    """The amplitude â (m/s²) at which a_z/g is `ratio`, for one conveyor.

    Examples
    --------
    >>> round(amplitude_of(parameter_table(Conveyor()), 1.0), 2)  # the part can leave the plate above it
    47.18
    """
    parameters = as_rows(parameters)
    return float(ratio * normal_gravity(parameters) / math.sin(parameters[model.ANGLE]))


def scaled_start(parameters: np.ndarray) -> tuple[float, float, float]:
    """The groups of one initial condition: z0 ω²/g, ż0 ω/g and ψ0 (rad).

    Examples
    --------
    >>> height, velocity, phase = scaled_start(parameter_table(Conveyor(), z0=3e-4))
    >>> round(height, 4), velocity, phase
    (3.0182, 0.0, 0.0)
    """
    parameters = as_rows(parameters)
    length, velocity = length_and_speed_units(parameters)
    return float(parameters[model.Z0] / length), float(parameters[model.VZ0] / velocity), float(parameters[model.PSI0])


def slopes(parameters: np.ndarray) -> dict[str, np.ndarray]:
    """Derivatives of all groups, in the order of GROUP_NAMES, by each parameter that is a number: shape (7,).

    The derivative by the exponent is at constant k_c in N/m^p, whose unit changes with p.
    """
    groups = groups_of(parameters)
    height, velocity_ratio, _ = scaled_start(parameters)
    value = dict(zip(PARAMETERS, map(float, parameters), strict=True))
    length, velocity = length_and_speed_units(parameters)
    ratio, damping, stiffness, p, _ = groups
    sine, cosine = math.sin(value["angle"]), math.cos(value["angle"])
    frequency, gravity, mass = value["frequency"], normal_gravity(parameters), value["mass"]
    by_mass, by_omega, by_gravity = contact_law.POWERS_IN_DAMPING
    of_gravity = {
        AMPLITUDE: -ratio / gravity,
        DAMPING: -by_gravity * damping / gravity,
        STIFFNESS: (p - 1.0) * stiffness / gravity,
        HEIGHT: -height / gravity,
        VELOCITY: -velocity_ratio / gravity,
    }
    rise, fall = math.cos(value["inclination"]), -value["gravity"] * math.sin(value["inclination"])
    by = {
        "acceleration": {AMPLITUDE: sine / gravity},
        "angle": {AMPLITUDE: value["acceleration"] * cosine / gravity},
        "frequency": {
            DAMPING: -by_omega * damping / frequency,
            STIFFNESS: -2.0 * p * stiffness / frequency,
            HEIGHT: 2.0 * height / frequency,
            VELOCITY: velocity_ratio / frequency,
        },
        "psi0": {PHASE: 1.0},
        "stiffness": {STIFFNESS: stiffness / value["stiffness"]},
        "damping": {DAMPING: 1.0 / contact_law.unit_of_damping(mass, 2.0 * math.pi * frequency, gravity)},
        "friction": {},
        "mass": {DAMPING: -by_mass * damping / mass, STIFFNESS: -stiffness / mass},
        "exponent": {STIFFNESS: stiffness * math.log(length), EXPONENT: 1.0},
        "gravity": {group: slope * rise for group, slope in of_gravity.items()},
        "inclination": {group: slope * fall for group, slope in of_gravity.items()},
        "phase_shift": {},
        "static_friction": {},
        "z0": {HEIGHT: 1.0 / length},
        "vz0": {VELOCITY: 1.0 / velocity},
    }
    table = {name: np.zeros(len(GROUP_NAMES)) for name in by}
    for name, entries in by.items():
        for group, slope in entries.items():
            table[name][group] = slope
    return table


def derivatives_of_groups(moved: str, parameters: np.ndarray, by: np.ndarray) -> dict[str, float]:
    """Derivatives of a parameter that an equation between the groups determines, by each of the other parameters.

    Returns them by the names of the parameters, in units of `moved` per unit of the parameter.

    Parameters
    ----------
    moved : a name in GROUP_OF
    parameters : a row of a table of parameters, at which the equation holds
    by : derivatives of the group of `moved`, Γ or z0 ω²/g, by all GROUP_NAMES, shape (7,); its own 0

    Examples
    --------
    >>> by = np.array([0.0, 0.37, 0.0, 0.0, 0.0, 0.0, 0.0])  # Γ = 0.37 D + constant
    >>> derivatives = derivatives_of_groups("acceleration", parameter_table(Conveyor()), by)
    >>> round(derivatives["damping"], 1)  # m/s² per N s/m
    79.4
    """
    of, own = slopes(as_rows(parameters)), GROUP_OF[moved]
    return {
        name: float((np.sum(by * slope) - slope[own]) / of[moved][own]) for name, slope in of.items() if name != moved
    }


def derivatives_by_groups(moved: str, parameters: np.ndarray, by: Mapping[str, float]) -> np.ndarray:
    """Derivatives of the group of `moved` by all GROUP_NAMES, shape (7,); the inverse of `derivatives_of_groups`.

    Parameters
    ----------
    moved : a name in GROUP_OF
    parameters : a row of a table of parameters, at which the equation holds
    by : derivatives of `moved` by the other parameters in PARAMETER_OF

    Examples
    --------
    >>> row, by = parameter_table(Conveyor()), np.array([0.0, 0.37, 0.0, 0.0, 0.0, 0.0, 0.0])
    >>> derivatives_by_groups("acceleration", row, derivatives_of_groups("acceleration", row, by)).round(12).tolist()
    [0.0, 0.37, 0.0, 0.0, 0.0, 0.0, 0.0]
    """
    of, own = slopes(as_rows(parameters)), GROUP_OF[moved]
    derivatives = np.zeros(len(GROUP_NAMES))
    for group, name in PARAMETER_OF.items():
        if group != own:
            rest = by[name] * of[moved][own] - np.sum(derivatives * of[name])
            derivatives[group] = rest / of[name][group]
    return derivatives
