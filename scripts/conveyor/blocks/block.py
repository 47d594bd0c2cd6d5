"""Blocks on a conveyor: one run, and many parts on a track."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments import (
    LONGEST,
    check_array,
    check_number,
    check_threads,
    check_time,
    check_tolerance,
    check_type,
)
from conveyor.blocks import block_motion
from conveyor.blocks.corners import CORNERS, ROWS, STATE, X
from conveyor.blocks.steps import STAGES
from conveyor.columns import Columns
from conveyor.packing import AT_REST, as_rows, check_rows, conveyor_of, parameter_table
from conveyor.parallel import call_interruptibly, for_each_chunk
from conveyor.parameters import LAST
from conveyor.simulation import mean_velocity
from conveyor.solver import plate
from conveyor.solver.model import FREQUENCY, MASS, Conveyor, Start
from conveyor.solver.status import OK, STATUS

BLOCK_TOLERANCE = 1e-8
SMALLEST, LARGEST = 1e-6, 10.0  # m, of a block's length and height
# m², of `inertia`; a block with the largest one does not turn.
LEAST_INERTIA, LARGEST_INERTIA = 1e-24, 1e12
LONG = 1000  # excitation cycles of all blocks, which take some tenths of a second


@dataclass(frozen=True, slots=True)
class Block:
    """A planar rigid block, a part whose four corners can touch the plate.

    Attributes
    ----------
    length, height : m, along the track and normal to it, 1e-6 to 10
    inertia : moment of inertia around the centre over the mass, m²; None for a uniform mass, (length² + height²)/12

    Raises
    ------
    ValueError
        names the number that is outside its range
    """

    length: float
    height: float
    inertia: float | None = None

    def __post_init__(self):
        for name in ("length", "height"):
            check_number(name, getattr(self, name), SMALLEST, LARGEST, "m")
        if self.inertia is not None:
            check_number("inertia", self.inertia, LEAST_INERTIA, LARGEST_INERTIA, "m²")

    def row(self) -> list[float]:
        """Length, height and inertia, as block_motion.follow takes them."""
        uniform = (self.length**2 + self.height**2) / 12.0
        return [self.length, self.height, uniform if self.inertia is None else self.inertia]


@dataclass(frozen=True, kw_only=True)
class BlockRun:
    """The result of `simulate_block`. It stores the final state; `sample` repeats the simulation.

    Attributes
    ----------
    conveyor, block, start, tilt, duration, tolerance : the arguments of `simulate_block`
    status : "ok", or why the run ended early; all numbers but largest_tilt are then NaN
    x_end, vx_end, z_end, vz_end, angle_end, spin_end : state at the end, as from `sample`
    largest_tilt : largest size of the angle, rad; above π/2 the block has rolled over
    airtime : share of the duration without contact
    impact_speed : largest speed of approach of a corner at an impact over the last quarter, m/s; 0 if there is none
    peak_force : largest sum of the contact forces at the ends of steps over the last quarter, N
    flights, steps : numbers of flights and of Runge-Kutta steps
    """

    conveyor: Conveyor
    block: Block
    start: Start
    tilt: float
    duration: float
    tolerance: float
    status: str
    x_last: float
    x_end: float
    vx_end: float
    z_end: float
    vz_end: float
    angle_end: float
    spin_end: float
    largest_tilt: float
    airtime: float
    impact_speed: float
    peak_force: float
    flights: int
    steps: int

    mean_velocity = mean_velocity

    def sample(self, times: ArrayLike) -> dict[str, np.ndarray]:
        """The motion at `times` (s, any shape and order, within the run).

        Returns
        -------
        dict of float64 arrays of the shape of `times`: x, z (m), vx, vz (m/s) of the centre, angle (rad) and spin
        (rad/s); NaN after the point where a run ended early. As in `start`, z is the height above that at rest on the
        plate in its middle position, so that a block without tilt has the z of a point.
        """
        times = check_array("times", times, 0.0, self.duration, "s", least=0)
        # The run ends at its duration, so that the last step is the same for all times.
        moments, place = np.unique(np.append(times.ravel(), self.duration), return_inverse=True)
        rows = as_rows(parameter_table(self.conveyor, self.start))[None]
        blocks = np.array([self.block.row()])
        samples, _, _ = follow(rows, blocks, np.array([self.tilt]), moments[None], tolerance=self.tolerance)
        place = place.ravel()[:-1]
        return {name: samples[0, place, k].reshape(times.shape) for k, name in enumerate(block_motion.SAMPLES)}


def follow(rows, blocks, tilts, times, *, tolerance, since=None, distances=None):
    """What block_motion.follow fills: samples, shape (n, k, 6), arrivals, shape (n, d), and results, shape (n, 10)."""
    n, k = times.shape
    distances = np.empty(0) if distances is None else distances
    since = np.zeros(n) if since is None else since
    samples, arrivals = np.empty((n, k, len(block_motion.SAMPLES))), np.empty((n, len(distances)))
    results = np.zeros((n, block_motion.RESULTS))
    workspace = np.empty((4, STATE)), np.empty((STAGES, STATE)), np.empty((ROWS, CORNERS))
    times = np.array(times, order="C")  # numba would compile `follow` for each other layout
    options = tolerance, times, since, samples, distances, arrivals, results, workspace
    given = np.ascontiguousarray(rows), plate.count_harmonics(rows), blocks, tilts
    cycles = (times[:, -1] * rows[:, FREQUENCY]).sum()
    call_interruptibly(lambda: block_motion.follow(*given, *options), lambda: times.fill(0.0), is_long=cycles > LONG)
    return samples, arrivals, results


def simulate_block(
    conveyor: Conveyor | np.ndarray,
    block: Block,
    start: Start = AT_REST,
    *,
    tilt: float = 0.0,
    duration: float = 1.0,
    tolerance: float = BLOCK_TOLERANCE,
) -> BlockRun:
    """Follow one block on one conveyor. At t = 0, x, vx and the spin are zero.

    Parameters
    ----------
    conveyor : a Conveyor, or a row of a table, whose initial condition is the default of `start`; the contact of each
        corner has half of its stiffness and of its damping, so that a block that lands flat has the contact of a point
    block : length, height, and moment of inertia
    start : z is the height of the centre above its height at rest on the plate in its middle position
    tilt : initial angle, rad, -π to π; positive where the front is raised
    duration : s, above 0 and up to 1e6
    tolerance : relative error per step of the contact, 1e-14 to 1e-2

    Returns
    -------
    BlockRun, whose status says whether the block could be followed to the end

    Examples
    --------
    >>> run = simulate_block(Conveyor(acceleration=40.0), Block(5e-3, 1e-3), Start(z=3e-4), tilt=0.02)
    >>> run.status, round(100.0 * run.mean_velocity(), 2)  # cm/s; a point jumps, with 6.51 cm/s
    ('ok', 1.01)
    """
    conveyor, start = conveyor_of(conveyor, start)
    check_type("block", block, Block)
    tilt = check_number("tilt", tilt, -math.pi, math.pi, "rad")
    duration, tolerance = check_time("duration", duration), check_tolerance(tolerance)
    before = (1.0 - LAST) * duration
    rows, blocks = as_rows(parameter_table(conveyor, start))[None], np.array([block.row()])
    times, since = np.array([[before, duration]]), np.array([before])
    ((last, end),), _, (result,) = follow(rows, blocks, np.array([tilt]), times, tolerance=tolerance, since=since)
    code = int(result[block_motion.CODE])
    known = 1.0 if code == OK else math.nan
    names = ("x_end", "vx_end", "z_end", "vz_end", "angle_end", "spin_end")
    return BlockRun(
        conveyor=conveyor,
        block=block,
        start=start,
        tilt=tilt,
        duration=duration,
        tolerance=tolerance,
        status=STATUS[code],
        x_last=float(last[X]),
        **dict(zip(names, end.tolist(), strict=True)),
        largest_tilt=float(result[block_motion.TILT]),
        airtime=known * float(result[block_motion.AIRTIME]) / duration,
        impact_speed=known * float(result[block_motion.IMPACT_SPEED]),
        peak_force=known * conveyor.mass * float(result[block_motion.PEAK_FORCE]),
        flights=int(result[block_motion.FLIGHTS]),
        steps=int(result[block_motion.STEPS]),
    )


def block_transits(
    parameters: Conveyor | np.ndarray,
    block: Block,
    tilts: ArrayLike,
    *,
    length: float,
    longest: float,
    begin: ArrayLike,
    tolerance: float = BLOCK_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """Follow blocks along a track, each until its centre arrives or the longest time has passed.

    Parameters
    ----------
    parameters : from `parameter_table`, shape (n,); z0 as `start.z` of `simulate_block`
    block, tilts : the block, and the initial angles (rad), shape (n,)
    length, longest : m, of the track; s, after which a part is late
    begin : time (s) from which impacts, forces and flights count, below `longest`, shape (n,)
    tolerance, threads, progress : as in `sweep`

    Returns
    -------
    columns of the shape (n,): `arrival` (s, NaN if late), `velocity` (m/s; of late parts, their distance over the
    longest time), `impact_speed` (m/s) and `peak_force` (N), as of BlockRun, `airtime`, the share of the time without
    contact, all three from `begin` on and NaN for parts that arrive earlier; `largest_tilt` (rad); `status`. Numbers
    of failed runs are NaN.

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(acceleration=80.0), psi0=[0.0, 1.0])
    >>> run = block_transits(parameters, Block(5e-3, 1e-3), np.zeros(2), length=0.02, longest=1.0, begin=np.zeros(2))
    >>> run.status.tolist()
    ['ok', 'ok']
    """
    (rows, _), threads, tolerance = check_rows(parameters), check_threads(threads), check_tolerance(tolerance)
    check_type("block", block, Block)
    length = check_number("length", length, 0.0, math.inf, "m", above=True)
    longest = check_number("longest", longest, 0.0, LONGEST, "s", above=True)
    tilts, begin = check_array("tilts", tilts, -math.pi, math.pi, "rad"), check_array("begin", begin, 0.0, LONGEST, "s")
    if begin.max() > longest:
        raise ValueError(f"begin = {begin.max()!s} s is after longest = {longest!r} s")
    if not tilts.shape == begin.shape == (len(rows),):
        raise ValueError(
            f"tilts and begin have the shapes {tilts.shape} and {begin.shape}, but parameters have ({len(rows)},)"
        )
    arrival, travelled = np.empty(len(rows)), np.empty(len(rows))
    results = np.empty((len(rows), block_motion.RESULTS))
    distances, blocks = np.array([length]), np.tile(block.row(), (len(rows), 1))

    def work(first, behind):
        part = slice(first, behind)
        times = np.full((behind - first, 1), longest)
        options = {"tolerance": tolerance, "since": begin[part], "distances": distances}
        samples, arrivals, results[part] = follow(rows[part], blocks[part], tilts[part], times, **options)
        arrival[part], travelled[part] = arrivals[:, 0], samples[:, 0, X]
        return np.count_nonzero(results[part, block_motion.CODE] != OK)

    for_each_chunk(work, len(rows), threads=threads, chunk=16, progress=progress)
    late = np.isnan(arrival)
    ends = np.where(late, longest, arrival)
    known = ends > begin
    columns = {
        "arrival": arrival,
        "velocity": np.where(late, travelled, length) / ends,
        "impact_speed": np.where(known, results[:, block_motion.IMPACT_SPEED], np.nan),
        "peak_force": np.where(known, rows[:, MASS] * results[:, block_motion.PEAK_FORCE], np.nan),
        "airtime": np.where(known, results[:, block_motion.AIRTIME], np.nan) / np.where(known, ends - begin, np.nan),
        "largest_tilt": results[:, block_motion.TILT].copy(),
    }
    for column in columns.values():
        column[results[:, block_motion.CODE] != OK] = np.nan
    status = np.array(STATUS, dtype=object)[results[:, block_motion.CODE].astype(np.int64)]
    return Columns(columns | {"status": status})
