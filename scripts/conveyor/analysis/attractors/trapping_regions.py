"""Attracting periodic orbits of a conveyor, each with a trapping region from which all motions end in the orbit.

The stroboscopic map is a homeomorphism of the plane. If the image of a closed curve lies inside another curve, so does
the image of all that it surrounds, and only points of the curve need checking. The curves are ellipses around a point
of the orbit. The first ellipse is so small that the motion is linear there. Each following ellipse is twice as large,
and its image must come inside the ellipse before. The ellipses belong to a norm in which the linearisation contracts in
each period, not only in the long run.
"""

import math
from functools import reduce

import numpy as np

from ...solver import contact
from ...solver.jit import compiled
from ...solver.model import PSI0
from ...solver.trajectory import BEGIN_OF_CYCLE, OK
from .. import stroboscopic_map
from ..dimensionless_groups import units
from .attractor_table import NO_ATTRACTORS, AttractingOrbits, append_row
from .convergence import PERIODIC, Trajectories, distance_components

POINTS = 32  # of a curve
PERIODS = 32  # in which a curve must come inside the one before
# Lengths of the longer half-axes of the ellipses, in g/ω² and g/ω.
SMALLEST, LARGEST = 1e-3, 64.0
# Spectral radii of a linearisation: a smaller one counts as FASTEST; with a larger one no curve halves in PERIODS.
FASTEST, SLOWEST = 1e-4, 0.98
LONGEST = 8  # excitation cycles, longest period of an orbit with a trapping region


@compiled
def comes_inside(parameters, tolerance, centre, factor, period, radius):
    """Whether an ellipse about a point of an orbit comes inside the ellipse of half its `radius`.

    All points must be inside after the same number of periods. The curve is then inside if the distance between
    neighbouring points is smaller than the distance of each point from the smaller ellipse.

    centre, factor : see AttractingOrbits
    period : excitation cycles, of the orbit
    """
    c, series = contact.constants(parameters, tolerance), contact.workspace()
    no_tangent, features = np.empty((0, 2)), np.zeros(stroboscopic_map.FEATURES)
    states, images = np.empty((POINTS, 2)), np.empty((POINTS, 2))
    for i in range(POINTS):
        angle = 2.0 * math.pi * i / POINTS
        across = radius * math.sin(angle) / factor[2]
        states[i, 0] = centre[0] + (radius * math.cos(angle) - factor[1] * across) / factor[0]
        states[i, 1] = centre[1] + across - c.damping * max(states[i, 0], 0.0)
    before = math.inf
    for _ in range(PERIODS):
        size = gap = 0.0
        for i in range(POINTS):
            for _ in range(period):
                status = stroboscopic_map.advance(c, series, states[i], BEGIN_OF_CYCLE, c.period, no_tangent, features)
                if status != OK:
                    return False
            images[i, 0], images[i, 1] = distance_components(c, centre, factor, states[i])
            size = max(size, math.hypot(images[i, 0], images[i, 1]))
        for i in range(POINTS):
            gap = max(gap, math.hypot(images[i, 0] - images[i - 1, 0], images[i, 1] - images[i - 1, 1]))
        if size + gap <= 0.5 * radius:
            return True
        # A curve that has left itself and does not come back is most likely outside the basin.
        if size > radius and size >= before:
            return False
        before = size
    return False


def contracting_norm(matrix: np.ndarray) -> np.ndarray | None:
    """Upper triangular R, shape (2, 2), with |R M x| < |R x| for a matrix M and all x ≠ 0, and |x| ≤ |R x|.

    From Lyapunov's equation of M divided by the root of its spectral radius. None if M contracts too slowly, or not.
    """
    radius = np.abs(np.linalg.eigvals(matrix)).max()
    if not radius <= SLOWEST:
        return None
    # The same digits as from scipy.linalg, which would take each job some tenths of a second to import.
    map_of = (matrix / math.sqrt(max(radius, FASTEST))).T
    square = np.linalg.solve(np.eye(4) - np.kron(map_of, map_of), np.eye(2).ravel()).reshape(2, 2)
    return np.linalg.cholesky(square / np.linalg.eigvalsh(square)[0], upper=True)


def find_trapping_region(
    parameters: np.ndarray, tolerance: float, state: np.ndarray, period: int
) -> tuple[np.ndarray, np.ndarray] | None:
    """Centre, shape (2,), and factor, shape (3,), of the largest trapping region of a point of an orbit; None for none.

    parameters : float64, shape (16,), with the phase trajectory.BEGIN_OF_CYCLE
    state : δ (m), v (m/s), shape (2,), at trajectory.BEGIN_OF_CYCLE
    """
    c, unit = contact.constants(parameters, tolerance), np.array(units(parameters))
    status, matrices, _ = stroboscopic_map.monodromy(parameters, tolerance, state.copy(), period)
    if status != OK:
        return None
    matrix = reduce(lambda product, following: following @ product, matrices)
    norm = contracting_norm(matrix * unit / unit[:, None])
    if norm is None:
        return None
    centre = np.array([state[0], state[1] + c.damping * max(state[0], 0.0)])
    factor = (norm / unit)[np.triu_indices(2)]
    radius = SMALLEST
    while radius <= LARGEST and comes_inside(parameters, tolerance, centre, factor, period, radius):
        radius *= 2.0
    return (centre, factor / (0.5 * radius)) if radius > SMALLEST else None


def find_attracting_orbits(parameters: np.ndarray, trajectories: Trajectories, tolerance: float) -> AttractingOrbits:
    """The attracting orbits that trajectories on a conveyor, shape (16,), have reached, each with a trapping region."""
    at_top, unit = parameters.copy(), np.array(units(parameters))
    at_top[PSI0] = BEGIN_OF_CYCLE
    seen, found = np.empty((0, 2)), NO_ATTRACTORS.orbits
    for k in np.flatnonzero((trajectories.outcomes == PERIODIC) & (trajectories.periods <= LONGEST)):
        state, period = trajectories.states[k], int(trajectories.periods[k])
        if (np.abs((seen - state) / unit).max(axis=1) < SMALLEST).any():
            continue
        status, strobes, _ = stroboscopic_map.follow(at_top, tolerance, state.copy(), period)
        if status != OK:
            continue
        seen = np.concatenate([seen, strobes])
        around = find_trapping_region(at_top, tolerance, state, period)
        if around is not None:
            found = append_row(found, parameters, *around, period, trajectories.flights[k])
    return found
