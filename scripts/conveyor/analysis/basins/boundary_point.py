"""The boundary of a basin as the stable manifold of a saddle, and how it moves: an implicit function.

An initial condition on the boundary between two basins leads to neither attractor. It leads to a saddle X_s, an orbit
with one multiplier outside the unit circle and one inside. With l the left eigenvector of the unstable multiplier, the
initial state and its images X_{k+1} = Pⁿ(X_k) are determined by

    X_0 = initial state,   X_{k+1} - Pⁿ(X_k) = 0,   l·(X_N - X_s) = 0,

an error of the order |X_N - X_s|², which shrinks like the stable multiplier to the power N. All images are unknowns,
so that none of them is amplified by the unstable multiplier (multiple shooting). The last unknown is the height of the
initial condition or the amplitude at which it lies on the boundary.
"""

import math
from typing import NamedTuple

import numpy as np

from ... import linear_algebra
from ..bifurcations.bifurcation_points import FARTHEST, ITERATIONS, derivatives
from ..bifurcations.newton import newton
from ..dimensionless_groups import AMPLITUDE, DAMPING, EXPONENT, GROUP_NAMES, HEIGHT, PHASE, STIFFNESS, VELOCITY, Groups

# Images among which a saddle is looked for, and its longest period, in cycles.
SEARCHED, LONGEST = 60, 4
# Newton's last correction; how near the last image must come to the saddle, and how many images there are at most.
CONVERGED = 1e-11
NEAR = 1e-7
MOST = 200


class InitialCondition(NamedTuple):
    """An initial condition in the units g/ω² and g/ω."""

    height: float  # z0 ω²/g
    velocity: float  # ż0 ω/g
    psi0: float  # rad


class BoundaryPoint(NamedTuple):
    """An initial condition on the boundary of a basin."""

    launch: InitialCondition
    groups: Groups
    period: int  # of the saddle, excitation cycles
    saddle: np.ndarray  # (x, y) at the phase ψ0
    multipliers: tuple[float, float]  # of the saddle, the unstable one first
    images: np.ndarray  # of the initial condition, shape (N + 1, 2)
    moves: (
        np.ndarray
    )  # derivatives of the unknown by all groups, dimensionless_groups.GROUP_NAMES, shape (7,); its own is 0


# The groups besides height and amplitude that move a boundary, in this order.
OTHERS = (DAMPING, STIFFNESS, EXPONENT, VELOCITY, PHASE)


def scaled_state(launch: InitialCondition, groups: Groups) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The scaled state (x, y) of an initial condition at its phase, and its derivatives.

    Returns
    -------
    state, shape (2,); derivatives by (height, Γ), shape (2, 2), and by OTHERS, shape (2, 5). The derivative by ψ0 is
    that of the state in which a motion with a changed ψ0 passes the unchanged phase.
    """
    sine, cosine = math.sin(launch.psi0), math.cos(launch.psi0)
    x = -launch.height - groups.amplitude * cosine
    speed = groups.amplitude * sine - launch.velocity
    inside = 1.0 if x > 0.0 else 0.0
    damping = groups.damping * inside
    by_x_and_speed = np.array([[1.0, 0.0], [damping, 1.0]])
    by_unknown = linear_algebra.product(by_x_and_speed, np.array([[-1.0, -cosine], [0.0, sine]]))
    push = groups.stiffness * max(x, 0.0) ** groups.exponent
    # The part rises with its own velocity and falls with g, whatever the plate does.
    by_quantities = np.column_stack(
        [
            [0.0, inside * x],
            np.zeros(2),
            np.zeros(2),
            linear_algebra.product(by_x_and_speed, np.array([0.0, -1.0])),
            linear_algebra.product(by_x_and_speed, groups.amplitude * np.array([sine, cosine]))
            - np.array([speed, 1.0 + groups.amplitude * cosine - push]),
        ]
    )
    return np.array([x, speed + damping * x]), by_unknown, by_quantities


def find_saddle(launch: InitialCondition, groups: Groups) -> tuple[int, np.ndarray, int] | None:
    """The saddle that a trajectory comes nearest to, or None.

    Returns
    -------
    period : of the saddle, excitation cycles
    saddle : (x, y) at the phase ψ0, shape (2,)
    turn : number of its periods after which the trajectory is nearest
    """
    state, _, _ = scaled_state(launch, groups)
    expansion = derivatives(groups, state, SEARCHED, launch.psi0)
    if expansion is None:
        return None
    strobes = np.vstack([state, expansion.states])
    nearest = []
    for period in range(1, LONGEST + 1):
        moved = linear_algebra.length(strobes[period:] - strobes[:-period])
        # The first close returns belong to the saddle, the later ones to the attractor.
        turns = np.flatnonzero((moved[1:-1] < moved[:-2]) & (moved[1:-1] <= moved[2:])) + 1
        nearest += [(period, int(turn)) for turn in turns[:3]]
    for period, turn in nearest:
        saddle = find_fixed_point(groups, strobes[turn], period, launch.psi0)
        if saddle is None:
            continue
        first, second = linear_algebra.eigenvalues(derivatives(groups, saddle, period, launch.psi0).first[:, :2])
        if abs(second) < 1.0 < abs(first):
            return period, saddle, turn // period
    return None


def find_fixed_point(groups: Groups, state: np.ndarray, period: int, psi0: float) -> np.ndarray | None:
    """The fixed point (x, y) of Pⁿ that Newton's iteration finds from a state, or None."""

    def system(here):
        expansion = derivatives(groups, here, period, psi0)
        return None if expansion is None else (expansion.image - here, expansion.first[:, :2] - np.eye(2))

    return newton(system, state, converged=CONVERGED, iterations=ITERATIONS, largest=FARTHEST)


def find_boundary_point(launch: InitialCondition, groups: Groups, unknown: int) -> BoundaryPoint | str:
    """The point of a basin's boundary next to an initial condition that is nearly on it, or the reason for none.

    unknown : dimensionless_groups.HEIGHT or AMPLITUDE, which is changed until the motion begins on the boundary
    """
    near = find_saddle(launch, groups)
    if near is None:
        return "the start comes near no saddle"
    period, saddle, turn = near
    state, _, _ = scaled_state(launch, groups)
    images = [state]
    for _ in range(turn):
        images.append(derivatives(groups, images[-1], period, launch.psi0).image)
    while len(images) <= MOST:
        solution = _shoot(launch, groups, unknown, period, saddle, np.array([*images, *[saddle] * 4]))
        if isinstance(solution, str):
            return solution
        launch, groups, saddle, images = solution
        if linear_algebra.length(images[-1] - saddle) < NEAR:
            return _moved(launch, groups, unknown, period, saddle, images)
    return "the start does not come close to the saddle"


def _linearised(launch, groups, period, saddle, images, *, exponent=False):
    """Residuals of the multiple shooting, their derivatives by the images and (height, Γ), and by OTHERS."""
    at_saddle = derivatives(groups, saddle, period, launch.psi0, exponent=exponent)
    if at_saddle is None:
        return None
    values = linear_algebra.eigenvalues(at_saddle.first[:, :2])
    left = linear_algebra.eigenvector(at_saddle.first[:, :2].T, values[0].real)
    # How the saddle moves with Γ, D, K (and p).
    along = linear_algebra.solve(np.eye(2) - at_saddle.first[:, :2], at_saddle.first[:, 2:])
    state, by_unknown, by_quantities = scaled_state(launch, groups)
    count = len(images)
    residual = np.zeros(2 * count + 1)
    jacobian, others = np.zeros((2 * count + 1, 2 * count + 2)), np.zeros((2 * count + 1, len(OTHERS)))
    residual[:2] = images[0] - state
    jacobian[:2, :2], jacobian[:2, -2:], others[:2] = np.eye(2), -by_unknown, -by_quantities
    groups_moved = at_saddle.first.shape[1] - 3
    for k in range(count - 1):
        rows, here, there = slice(2 * k + 2, 2 * k + 4), slice(2 * k, 2 * k + 2), slice(2 * k + 2, 2 * k + 4)
        expansion = derivatives(groups, images[k], period, launch.psi0, exponent=exponent)
        if expansion is None:
            return None
        residual[rows] = images[k + 1] - expansion.image
        jacobian[rows, here], jacobian[rows, there] = -expansion.first[:, :2], np.eye(2)
        jacobian[rows, -1] = -expansion.first[:, 2]
        others[rows, :groups_moved] = -expansion.first[:, 3:]
    residual[-1] = linear_algebra.dot(left, images[-1] - saddle)
    jacobian[-1, 2 * count - 2 : 2 * count] = left
    jacobian[-1, -1] = -linear_algebra.dot(left, along[:, 0])
    others[-1, :groups_moved] = -linear_algebra.product(along[:, 1:].T, left)
    return residual, jacobian, others, tuple(value.real for value in values)


def _shoot(launch, groups, unknown, period, saddle, images):
    """Newton's iteration on the images and the height or Γ; the saddle follows Γ."""
    column = -2 if unknown == HEIGHT else -1
    for _ in range(ITERATIONS):
        linearised = _linearised(launch, groups, period, saddle, images)
        if linearised is None:
            return "the motion is lost"
        residual, jacobian, _, _ = linearised
        wanted = np.column_stack([jacobian[:, :-2], jacobian[:, column]])
        step = linear_algebra.solve(wanted, -residual)
        if step is None or not np.abs(step).max() < FARTHEST:
            return "no start near it lies on the edge"
        images = images + step[:-1].reshape(-1, 2)
        if unknown == HEIGHT:
            launch = launch._replace(height=launch.height + float(step[-1]))
        else:
            groups = groups._replace(amplitude=groups.amplitude + float(step[-1]))
            saddle = find_fixed_point(groups, saddle, period, launch.psi0)
            if saddle is None:
                return "the saddle is lost"
        if np.abs(step).max() < CONVERGED:
            return launch, groups, saddle, images
    return "Newton's iteration does not converge"


def _moved(launch, groups, unknown, period, saddle, images):
    """The BoundaryPoint, with the derivatives by the implicit function theorem."""
    _, jacobian, others, values = _linearised(launch, groups, period, saddle, images, exponent=True)
    count = len(images)
    own, other = (-2, -1) if unknown == HEIGHT else (-1, -2)
    right = -np.column_stack([others, jacobian[:, other]])
    unknowns = np.column_stack([jacobian[:, : 2 * count], jacobian[:, own]])
    *moved, by_other = linear_algebra.solve(unknowns, right)[-1]
    moves = np.zeros(len(GROUP_NAMES))
    moves[list(OTHERS)] = moved
    moves[AMPLITUDE if unknown == HEIGHT else HEIGHT] = by_other
    return BoundaryPoint(launch, groups, period, saddle, tuple(values), images, moves)
