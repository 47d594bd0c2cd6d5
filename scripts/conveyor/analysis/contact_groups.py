"""Dimensionless groups of a contact, whose ranges fit any conveyor.

With ω = 2πf and the gravity g normal to the track, the stiffness is the group K = (k_c/m) g^(p-1)/ω^(2p), as in
`dimensionless_groups`. By dimensional analysis of m z̈ = k z^p, an impact at the speed g/ω lasts about K^(-1/(p+1))/ω.
The damper takes about the share

    L = D K^(-1/(p+1)),   D = d_c/(m ω),

of the speed in such an impact: to first order in the damping, and up to a factor of order one. Contacts with equal loss
L have nearly the same coefficient of restitution. For a Hooke contact (p = 1), L is twice the damping ratio. D and the
power of K in L belong to the damper of the contact law.

Searches over contacts go over K and L instead of k_c and d_c. The amplitudes at which states of motion change vary
least along lines of equal loss, and a rectangle of K and L has no corner in which all parts jump, or none.
"""

import numpy as np
from numpy.typing import ArrayLike

from ..elementary import cos, power
from ..packing import as_rows
from ..solver import contact_law, model


def units(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
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
    unit, unit_of_damping, exponent = units(parameters)
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
    unit, unit_of_damping, exponent = units(parameters)
    group = np.asarray(group)
    return unit * group, unit_of_damping * np.asarray(loss) * power(group, -contact_law.loss_power(exponent))
