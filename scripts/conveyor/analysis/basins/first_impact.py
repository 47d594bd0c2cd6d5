"""The first impact (Eqs. 16 to 18), and the initial condition on the plate that leads to the same motion."""

import math
from typing import NamedTuple

import numpy as np

from ...packing import check_rows
from ...solver import contact, plate
from ...solver.flight import Flight, next_impact
from ...solver.jit import compiled
from ...solver.model import VZ0, Z0
from ...solver.vertical import begin, motion_at

TIME, VELOCITY, PHASE = range(3)


class FirstImpact(NamedTuple):
    """Time t1 (s), velocity ż1 of the part (m/s) and phase ψ1 = ωt1 + ψ0 (rad) of n motions; float64, shape (n,).

    A part that begins on the plate and presses on it has t1 = 0. One that begins below the surface has no impact: NaN.
    """

    time: np.ndarray
    velocity: np.ndarray
    phase: np.ndarray


@compiled
def find_first_impacts(parameters, harmonics):
    """Times, velocities and phases, float64, shape (n, 3), for `parameters`, shape (n, 16).

    harmonics : as from plate.count_harmonics
    """
    out = np.full((len(parameters), 3), np.nan)
    for i in range(parameters.shape[0]):
        c = contact.compute_constants(parameters[i], 1e-10, harmonics)
        theta, vz = c.psi0, parameters[i, VZ0]
        q, rate = begin(c, parameters[i, Z0], vz, theta)
        if q < 0.0:
            continue
        t1 = 0.0
        motion = motion_at(c, q, rate, 0.0, theta)
        if not motion.touching:
            # After this time the part would be below the lowest point of the plate.
            longest = 1.1 * (vz + math.sqrt(vz * vz + 2.0 * c.gravity * (motion.z + c.bounds.height))) / c.gravity
            t1, _ = next_impact(Flight(motion.z, vz, theta, c), q, rate, longest)
        out[i, TIME], out[i, VELOCITY], out[i, PHASE] = t1, vz - c.gravity * t1, theta + c.omega * t1
    return out


def first_impacts(parameters: np.ndarray) -> FirstImpact:
    """First impacts of the initial conditions in a table of `parameters`, shape (n,).

    Examples
    --------
    >>> impacts = first_impacts(parameter_table(Conveyor(acceleration=40.0), z0=[1e-3]))
    >>> bool(abs(impacts.velocity[0] + 9.81 * impacts.time[0]) < 1e-12)  # free fall
    True
    """
    rows, _ = check_rows(parameters)
    return FirstImpact(*find_first_impacts(rows, plate.count_harmonics(rows)).T)


def on_conveyor(parameters: np.ndarray, impacts: FirstImpact) -> np.ndarray:
    """The table of the same motions, begun on the conveyor with the phases and velocities of their first impacts.

    parameters, impacts : a table of the shape (n,), and the result of `first_impacts` for it

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(acceleration=40.0), z0=[1e-3])
    >>> on_conveyor(parameters, first_impacts(parameters))["vz0"].round(3).tolist()  # m/s
    [-0.138]
    """
    mapped = parameters.copy()
    mapped["psi0"] = impacts.phase % (2.0 * math.pi)
    mapped["z0"] = math.nan
    mapped["vz0"] = impacts.velocity
    return mapped
