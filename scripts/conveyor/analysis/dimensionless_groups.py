"""The dimensionless groups of the vertical motion: conveyors with equal groups have the same vertical motion.

With the length g/ω² and the time 1/ω, the penetration x = δ ω²/g and its rate obey

    ẋ = y - D max(x, 0),   ẏ = 1 + Γ cos θ - K max(x, 0)^p,

    Γ = a_z/g,   D = d_c/(m ω),   K = (k_c/m) g^(p-1)/ω^(2p),

and p and the treatment of tension, where g is the gravity normal to the track, g cos α; D belongs to the damper of the
contact law. Nothing else matters: the angle of throw acts only through a_z = â sin φ, and friction and the motion along
the track do not act on the vertical motion. An initial condition adds ψ0, z0 ω²/g and ż0 ω/g.

By dimensional analysis of m z̈ = k z^p, an impact at the speed g/ω lasts about K^(-1/(p+1))/ω. The damper takes about
the share

    L = D K^(-1/(p+1))

of the speed in such an impact: to first order in the damping, and up to a factor of order one. Contacts with equal loss
L have nearly the same coefficient of restitution. For a Hooke contact (p = 1), L is twice the damping ratio. The power
of K in L belongs to the damper, too.

Searches over contacts go over K and L instead of k_c and d_c. The amplitudes at which states of motion change vary
least along lines of equal loss, and a rectangle of K and L has no corner in which all parts jump, or none.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import check_number
from ..elementary import cos, power
from ..packing import as_rows, one_row, refuse_harmonics
from ..parameters import length_scale, speed_scale
from ..solver import contact_law, model
from ..solver.model import PARAMETERS, Conveyor, normal_gravity

# A conveyor whose parameters equal its dimensionless groups: g = 1, ω = 1, m = 1, φ = 90°.
FREQUENCY_OF_ONE = 0.5 / math.pi


class Groups(NamedTuple):
    """The groups of a vertical motion."""

    amplitude: float  # Γ = a_z/g
    damping: float  # D = d_c/(m ω)
    stiffness: float  # K = (k_c/m) g^(p-1)/ω^(2p)
    exponent: float  # p
    tension: int  # code of the treatment of tension, see parameters.TENSION_MODES


def groups_of(conveyor: Conveyor | np.ndarray) -> Groups:
    """The groups of one conveyor, a Conveyor or a row of a table.

    Examples
    --------
    >>> groups = groups_of(Conveyor(acceleration=40.0))
    >>> round(groups.amplitude, 4), round(groups.damping, 4), round(groups.stiffness, 2)
    (0.8478, 1.3642, 72.15)
    """
    parameters = one_row(conveyor)
    refuse_harmonics(parameters, "a motion that depends on dimensionless groups alone")
    unit, unit_of_damping, exponent = units_of_contact(parameters)
    return Groups(
        float(parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE]) / normal_gravity(parameters)),
        float(parameters[model.DAMPING] / unit_of_damping),
        float(parameters[model.STIFFNESS] / unit),
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


def length_and_speed_units(conveyor: Conveyor | np.ndarray) -> tuple[float, float]:
    """The units of length, g/ω² (m), and velocity, g/ω (m/s), of a Conveyor or a row of a table.

    Examples
    --------
    >>> length, speed = length_and_speed_units(Conveyor())
    >>> round(1e6 * length, 1), round(1e3 * speed, 1)  # µm, mm/s
    (99.4, 31.2)
    """
    numbers = dict(zip(PARAMETERS, one_row(conveyor).tolist(), strict=False))  # behind them are those of harmonics
    return length_scale(numbers), speed_scale(numbers)


def distance(conveyor: Conveyor | np.ndarray, states: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The least distance of each state (δ in m, v in m/s), shape (…, 2), from others, shape (n, 2), in g/ω² and g/ω;
    inf for none.
    """
    differences = np.abs(others - states[..., None, :]) / length_and_speed_units(conveyor)
    return differences.max(axis=-1).min(axis=-1, initial=math.inf)


def amplitude_of(conveyor: Conveyor | np.ndarray, ratio: float) -> float:
    """The amplitude â (m/s²) at which a_z/g is `ratio`, for a Conveyor or a row of a table.

    Examples
    --------
    >>> round(amplitude_of(Conveyor(), 1.0), 2)  # the part can leave the plate above it
    47.18
    """
    parameters = one_row(conveyor)
    ratio = check_number("ratio", ratio, 0.0, 1e9)
    if parameters[model.ANGLE] == 0.0:
        raise ValueError("conveyor has the angle 0: its plate does not move normal to the track")
    return float(ratio * normal_gravity(parameters) / math.sin(parameters[model.ANGLE]))


def units_of_contact(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stiffness (N/m^p) of a contact with K = 1, damping (N s/m) with D = 1, and the exponent: each of shape (...)."""
    parameters = as_rows(parameters)
    mass, exponent = parameters[..., model.MASS], parameters[..., model.EXPONENT]
    omega = 2.0 * np.pi * parameters[..., model.FREQUENCY]
    gravity = parameters[..., model.GRAVITY] * cos(parameters[..., model.INCLINATION])
    unit_of_damping = contact_law.unit_of_damping(mass, omega, gravity)
    return mass * power(omega, 2.0 * exponent) / power(gravity, exponent - 1.0), unit_of_damping, exponent


def groups_of_contact(
    stiffness: ArrayLike, damping: ArrayLike, parameters: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The groups K and L of contacts.

    Parameters
    ----------
    stiffness, damping : k_c (N/m^p) and d_c (N s/m), arrays of equal shape, or numbers
    parameters : table with the conveyor, or with one row for each contact; its contact is not used

    Examples
    --------
    >>> group, loss = groups_of_contact(5e5, 0.3, parameter_table(Conveyor()))
    >>> stiffness, damping = contact_of_groups(group, loss, parameter_table(Conveyor()))
    >>> round(float(stiffness)), round(float(damping), 6)  # N/m^p, N s/m
    (500000, 0.3)
    """
    unit, unit_of_damping, exponent = units_of_contact(parameters)
    group = np.asarray(stiffness) / unit
    return group, np.asarray(damping) / unit_of_damping * power(group, contact_law.loss_power(exponent))


def contact_of_groups(group: ArrayLike, loss: ArrayLike, parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness k_c (N/m^p) and damping d_c (N s/m) from K and L: the inverse of `groups_of_contact`.

    Examples
    --------
    >>> stiffness, damping = contact_of_groups(72.15, 0.2463, parameter_table(Conveyor()))
    >>> round(float(stiffness), -4), round(float(damping), 3)  # N/m^p, N s/m
    (500000.0, 0.3)
    """
    unit, unit_of_damping, exponent = units_of_contact(parameters)
    group = np.asarray(group)
    return unit * group, unit_of_damping * np.asarray(loss) * power(group, -contact_law.loss_power(exponent))
