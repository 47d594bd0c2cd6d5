"""Attracting periodic orbits of a conveyor, most with a trapping region from which all motions end in the orbit.

The stroboscopic map is a homeomorphism of the plane. If the image of a closed curve lies inside another curve, so does
the image of all that it surrounds, and only points of the curve need checking. The curves are ellipses around a point
of the orbit. The first ellipse is so small that the motion is linear there. Each following ellipse is larger, at first
twice as large, and its image must come inside the ellipse before. The ellipses belong to a norm in which the
linearisation contracts in each period, not only in the long run.

Without these regions, the labels of 10,000 initial conditions on the paper's conveyor take 5.0 times as long at
40 m/s², 3.6 times as long at 52.5 m/s², and equally long in chaos.
"""

import math
from functools import partial

import numpy as np

from ... import linear_algebra
from ...parallel import call_interruptibly
from ...solver import contact, contact_law, plate
from ...solver.jit import compiled
from ...solver.pieces import BEGIN_OF_CYCLE
from ...solver.status import OK
from .. import stroboscopic_map
from ..bifurcations.newton import newton
from ..dimensionless_groups import distance, length_and_speed_units
from . import convergence, sampling
from .attractor_table import NO_ATTRACTORS, AttractingOrbits, AttractorTable, ChaoticSets, append_row
from .convergence import IN_CHAOTIC_SET, NOT_CONVERGED, PERIODIC, STAY, Trajectories

POINTS = 32  # of a curve
PERIODS = 32  # in which a curve must come inside the one before
# Of a slow orbit, a curve may take PATIENCE times as many periods as the linearisation.
PATIENCE = 4.0
# Lengths of the longer half-axes of the ellipses, in g/ω² and g/ω.
SMALLEST, LARGEST = 1e-3, 64.0
# Least growth from one ellipse to the next; the first ones are twice as large as the ones before. The finer one counts
# up to a share of the cycles that the search may take: many conveyors with few trajectories each gain little from it.
FINE_GROWTH, LEAST_GROWTH, FINE_SHARE = 1.05, 1.3, 0.01
# Spectral radii of a linearisation: a smaller one counts as FASTEST; above SLOW, no curve halves in PERIODS; above
# SLOWEST, checking a curve takes seconds.
FASTEST, SLOW, SLOWEST = 1e-4, 0.98, 0.9995
# Newton's iteration: its last correction in g/ω² and g/ω, the number of corrections, and the distance beyond which it
# has left the orbit.
CONVERGED, REFINEMENTS, FAR = 1e-10, 6, 0.01
LONGEST = 8  # excitation cycles, longest period of an orbit with a trapping region
NO_REGION = np.full(3, math.inf)  # the factor of an orbit without a trapping region, in which no state lies


@compiled
def comes_inside(parameters, tolerance, harmonics, centre, factor, period, radius, inner, periods, stopped):
    """Whether the image of an ellipse of a `radius` around a point of an orbit comes inside a smaller ellipse.

    All points must be inside after the same number of periods. The curve is then inside if the distance between
    neighbouring points is smaller than the distance of each point from the smaller ellipse.

    harmonics : as from plate.count_harmonics
    centre, factor : see AttractingOrbits
    period : excitation cycles, of the orbit
    inner : radius of the smaller ellipse
    periods : number of periods in which it must come inside
    stopped : bool, shape (1,), whether to end the search, with the result that it does not

    Returns
    -------
    inside : whether it does
    cycles : excitation cycles that all points of the curve were followed for
    """
    c, series = contact.compute_constants(parameters, tolerance, harmonics), contact.workspace()
    no_tangent, features = np.empty((0, 2)), np.zeros(stroboscopic_map.FEATURES)
    states, images = np.empty((POINTS, 2)), np.empty((POINTS, 2))
    for i in range(POINTS):
        angle = 2.0 * math.pi * i / POINTS
        across = radius * math.sin(angle) / factor[2]
        states[i, 0] = centre[0] + (radius * math.cos(angle) - factor[1] * across) / factor[0]
        states[i, 1] = contact_law.speed_of_approach(c, states[i, 0], centre[1] + across)
    before = math.inf
    for n in range(1, periods + 1):
        if stopped[0]:
            break
        size = gap = 0.0
        for i in range(POINTS):
            for _ in range(period):
                status = stroboscopic_map.advance(c, series, states[i], BEGIN_OF_CYCLE, c.period, no_tangent, features)
                if status != OK:
                    return False, n * period * POINTS
            images[i, 0], images[i, 1] = convergence.distance_components(c, centre, factor, states[i])
            distance = math.hypot(images[i, 0], images[i, 1])
            # A curve that is far outside itself and does not come back is most likely outside the basin.
            if distance > 2.0 * radius and distance >= before:
                return False, n * period * POINTS
            size = max(size, distance)
        for i in range(POINTS):
            gap = max(gap, math.hypot(images[i, 0] - images[i - 1, 0], images[i, 1] - images[i - 1, 1]))
        if size + gap <= inner:
            return True, n * period * POINTS
        before = size
    return False, periods * period * POINTS


def spectral_radius(matrix: np.ndarray) -> float:
    """The largest absolute eigenvalue of a matrix."""
    return abs(linear_algebra.eigenvalues(matrix)[0])


def contracting_norm(matrix: np.ndarray) -> np.ndarray | None:
    """Upper triangular R, shape (2, 2), with |R M x| < |R x| for a matrix M and all x ≠ 0, and |x| ≤ |R x|.

    From Lyapunov's equation of M divided by the root of its spectral radius. None if M contracts too slowly, or not.
    """
    radius = spectral_radius(matrix)
    if not radius <= SLOW:
        return None
    map_of = (matrix / math.sqrt(max(radius, FASTEST))).T
    return factor_of(linear_algebra.solve(np.eye(4) - np.kron(map_of, map_of), np.eye(2).ravel()).reshape(2, 2))


def slow_norm(matrix: np.ndarray) -> np.ndarray | None:
    """R as from `contracting_norm`, in coordinates along the eigenvectors of M.

    Lyapunov's norm would make the ellipses narrow in a slow direction, from which motions come. None if M hardly
    contracts, or not.
    """
    if not spectral_radius(matrix) <= SLOWEST:
        return None
    values = linear_algebra.eigenvalues(matrix)
    inverse = linear_algebra.inverse(np.column_stack([linear_algebra.eigenvector(matrix, value) for value in values]))
    return None if inverse is None else factor_of(linear_algebra.product(inverse.conj().T, inverse).real)


def factor_of(square: np.ndarray) -> np.ndarray:
    """The upper triangular R, shape (2, 2), of a norm |R x| ≥ |x| whose square has a multiple of this matrix."""
    least = linear_algebra.eigenvalues(square)[1].real
    return linear_algebra.cholesky(square / least).T


def linearise(parameters: np.ndarray, tolerance: float, point: np.ndarray, period: int) -> tuple:
    """Where δ (m) and Y (m/s) are after a period, shape (2,), and the derivative, shape (2, 2); None if a cycle fails.

    period : excitation cycles
    """
    c = contact.constants(parameters, tolerance)
    state = stroboscopic_map.state_of(c, point)
    status, matrices, _ = stroboscopic_map.monodromy(parameters, tolerance, state, period, 0.0)
    if status != OK:
        return None
    return stroboscopic_map.smooth_state(c, state), linear_algebra.chain(matrices)


def refine_orbit(
    parameters: np.ndarray, tolerance: float, near: np.ndarray, period: int
) -> tuple[np.ndarray, np.ndarray] | None:
    """The point of an orbit `near` a point δ (m), Y (m/s), and the linearisation there in g/ω² and g/ω, or None.

    A motion on its way to a slow orbit seems to repeat itself when it is still far away. Newton's iteration goes on.
    """
    unit = np.array(length_and_speed_units(parameters))

    def system(scaled):
        linear = linearise(parameters, tolerance, scaled * unit, period)
        return None if linear is None else (linear[0] / unit - scaled, linear[1] * unit / unit[:, None] - np.eye(2))

    scaled = newton(system, near / unit, converged=CONVERGED, iterations=REFINEMENTS, farthest=FAR)
    linear = None if scaled is None else system(scaled)
    return None if linear is None else (scaled * unit, linear[1] + np.eye(2))


def find_trapping_region(
    parameters: np.ndarray, tolerance: float, state: np.ndarray, period: int, *, max_cycles: int
) -> tuple[tuple[np.ndarray, np.ndarray] | None, int]:
    """The largest trapping region around a point of an orbit that a search of about `max_cycles` cycles shows.

    parameters : float64, shape (16,), with the phase pieces.BEGIN_OF_CYCLE
    state : δ (m), v (m/s), shape (2,), at pieces.BEGIN_OF_CYCLE

    Returns
    -------
    region : centre, shape (2,), and factor, shape (3,); None for none
    spent : excitation cycles
    """
    c, unit = contact.constants(parameters, tolerance), np.array(length_and_speed_units(parameters))
    centre = stroboscopic_map.smooth_state(c, state)
    periods, linear = PERIODS, linearise(parameters, tolerance, centre, period)
    if linear is None:
        return None, 0
    matrix = linear[1] * unit / unit[:, None]
    if spectral_radius(matrix) <= SLOW:
        norm = contracting_norm(matrix)
    else:
        refined = refine_orbit(parameters, tolerance, centre, period)
        if refined is None:
            return None, 0
        centre, matrix = refined
        norm = slow_norm(matrix)
        periods = math.ceil(PATIENCE * math.log(0.5) / math.log(min(spectral_radius(matrix), SLOWEST)))
    if norm is None:
        return None, 0
    factor = (norm / unit)[np.triu_indices(2)]
    radius, growth, spent, harmonics = 0.5 * SMALLEST, 2.0, 0, plate.count_harmonics(parameters)
    while growth * radius <= LARGEST and spent < max_cycles:
        if growth <= (FINE_GROWTH if spent < FINE_SHARE * max_cycles else LEAST_GROWTH):
            break
        radii = growth * radius, radius
        search = partial(comes_inside, parameters, tolerance, harmonics, centre, factor, period, *radii, periods)
        stopped = np.zeros(1, dtype=np.bool_)
        inside, cycles = call_interruptibly(
            partial(search, stopped), partial(stopped.fill, True), is_long=periods > PERIODS
        )
        spent += cycles
        if inside:
            radius *= growth
        else:
            growth = math.sqrt(growth)
    return ((centre, factor / radius) if radius >= SMALLEST else None), spent


def add_without_region(
    orbits: AttractingOrbits,
    candidates: list[tuple[np.ndarray, int, float]],
    at_top: np.ndarray,
    conveyor: np.ndarray,
    tolerance: float,
) -> AttractingOrbits:
    """The table of a conveyor's orbits with those candidates that attract, differ from its orbits and from each other.

    candidates : state at pieces.BEGIN_OF_CYCLE, period and longest flight of each
    at_top : the conveyor with the phase pieces.BEGIN_OF_CYCLE
    """
    c, known, count = contact.constants(conveyor, tolerance), np.empty((0, 2)), len(orbits.periods)
    for state, period, flight in candidates:
        if distance(conveyor, state, known) < SMALLEST:
            continue
        refined = refine_orbit(at_top, tolerance, stroboscopic_map.smooth_state(c, state), period)
        if refined is None or not spectral_radius(refined[1]) < 1.0:
            continue
        centre = refined[0]
        state = stroboscopic_map.state_of(c, centre)
        status, strobes = stroboscopic_map.follow_map(at_top, tolerance, state.copy(), period)
        reached = [convergence.find_reached_orbit(c, strobe, orbits, 0, count) >= 0 for strobe in strobes]
        if status == OK and not any(reached) and distance(conveyor, state, known) >= SMALLEST:
            known = np.concatenate([known, strobes])
            orbits = append_row(orbits, conveyor, centre, NO_REGION, period, flight)
    return orbits


def find_attracting_orbits(
    parameters: np.ndarray,
    sampled: Trajectories,
    chaotic: ChaoticSets,
    cycles: int,
    tolerance: float,
    *,
    max_cycles: int,
) -> AttractingOrbits:
    """The attracting orbits of a conveyor, shape (16,), that trajectories reach.

    Orbits with a trapping region come first. Orbits of more than LONGEST cycles, orbits that attract too slowly, and
    orbits for which no cycles are left, have none.

    Parameters
    ----------
    sampled : trajectories on the conveyor; those that have not converged and do not stay in a chaotic set are followed
        further, for at most `cycles`, one after the other, so that each slow orbit is approached only once
    chaotic : the known chaotic sets of the conveyor
    max_cycles : excitation cycles in all, after which no further orbit is searched for
    """
    at_top, constants = stroboscopic_map.begin_at_top(parameters), contact.constants(parameters, tolerance)
    seen, orbits, cycles_left, without_region = np.empty((0, 2)), NO_ATTRACTORS.orbits, max_cycles, []

    def add(state: np.ndarray, period: int, flight: float) -> None:
        nonlocal seen, orbits, cycles_left
        if distance(parameters, state, seen) < SMALLEST:
            return
        region = None
        if cycles_left > 0 and period <= LONGEST:
            status, strobes = stroboscopic_map.follow_map(at_top, tolerance, state.copy(), period)
            if status != OK:
                return
            seen = np.concatenate([seen, strobes])
            region, used = find_trapping_region(at_top, tolerance, state, period, max_cycles=cycles_left)
            cycles_left -= used
        if region is None:
            without_region.append((state, period, flight))
        else:
            orbits = append_row(orbits, parameters, *region, period, flight)

    for k in np.flatnonzero(sampled.outcomes == PERIODIC):
        add(sampled.states[k], int(sampled.periods[k]), sampled.flights[k])
    states = sampled.states[sampled.outcomes == NOT_CONVERGED]
    # Side by side, because most of them stay in a chaotic set.
    rows = np.repeat(parameters[None], len(states), axis=0)
    early = sampling.follow(rows, states, min(2 * STAY, cycles), tolerance, AttractorTable(orbits, chaotic))
    cycles_left -= int(early.followed.sum())
    for state in states[early.outcomes != IN_CHAOTIC_SET]:
        if cycles_left <= 0:
            break
        late = sampling.follow(parameters[None], state[None], cycles, tolerance, AttractorTable(orbits, chaotic))
        cycles_left -= int(late.followed[0])
        if late.outcomes[0] == NOT_CONVERGED:
            break
        is_new = convergence.find_reached_orbit(constants, late.states[0], orbits, 0, len(orbits.periods)) < 0
        if late.outcomes[0] == PERIODIC and is_new:
            add(late.states[0], int(late.periods[0]), late.flights[0])
    return add_without_region(orbits, without_region, at_top, parameters, tolerance)
