"""Blocks on a conveyor: one run, and many parts on a track."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import LONGEST, check_array, check_number, check_threads, check_time, check_tolerance, check_type
from ..columns import Columns
from ..packing import AT_REST, check_column, check_rows, conveyor_of
from ..parallel import call_interruptibly, for_each_chunk
from ..parameters import LAST
from ..simulation import mean_velocity
from ..solver import plate
from ..solver.model import FREQUENCY, MASS, Conveyor, Start, pack
from ..solver.status import OK, STATUS
from . import block_motion
from .corners import CORNERS, ROWS, STATE, X
from .steps import STAGES

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
    length, height : m, along the track and normal to it, 1e-6 to 10; a block that is thinner than it presses into the
        plate touches with its upper corners, too
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


@dataclass(frozen=True, kw_only=True)
class BlockRun:
    """The result of `simulate_block`. `sample` repeats the simulation.

    Attributes
    ----------
    conveyor, block, start, tilt, duration, tolerance : the arguments of `simulate_block`
    status : "ok", or why the run ended early; all numbers but largest_tilt are then NaN
    x_end : position of the centre at the end, m
    largest_tilt : largest size of the angle, rad; above π/2 the block has rolled over
    airtime : share of the last quarter without contact, in which all corners are above the plate
    impact_speed : largest speed of approach of a corner at an impact over the last quarter, m/s; 0 if there is none
    peak_force : largest sum of the contact forces at the ends of steps over the last quarter, N
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
    largest_tilt: float
    airtime: float
    impact_speed: float
    peak_force: float

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
        # The run ends at its duration, and a step ends where the last quarter begins, so that all steps are those of
        # `simulate_block`.
        moments, place = np.unique(np.append(times, self.duration), return_inverse=True)
        arguments = pack(self.conveyor, self.start)[None], self.block, np.array([self.tilt]), moments
        (samples,), _ = follow(*arguments, tolerance=self.tolerance, since=(1.0 - LAST) * self.duration)
        return {name: samples[place[:-1], k].reshape(times.shape) for k, name in enumerate(block_motion.SAMPLES)}


def follow(rows, block, tilts, times, *, tolerance, since, distance=math.inf):
    """What block_motion.follow fills: samples, shape (n, k, 6), and results, shape (n, 6)."""
    n, times = len(rows), np.array(times, dtype=np.float64)
    inertia = (block.length**2 + block.height**2) / 12.0 if block.inertia is None else block.inertia
    size = float(block.length), float(block.height), float(inertia)
    samples, results = np.empty((n, times.size, len(block_motion.SAMPLES))), np.zeros((n, block_motion.RESULTS))
    workspace = np.empty((4, STATE)), np.empty((STAGES, STATE)), np.empty((ROWS, CORNERS))
    arguments = np.ascontiguousarray(rows), plate.count_harmonics(rows), size, tilts, tolerance, times
    options = np.full(n, since), samples, distance, results, workspace
    cycles = times[-1] * rows[:, FREQUENCY].sum()
    call_interruptibly(
        lambda: block_motion.follow(*arguments, *options), lambda: times.fill(0.0), is_long=cycles > LONG
    )
    return samples, results


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
    start : z is the height of the centre above its height at rest on the plate in its middle position. A tilted block
        that starts low has a corner in the plate, which pushes it out.
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
    arguments = pack(conveyor, start)[None], block, np.array([tilt]), np.array([before, duration])
    ((last, end),), (result,) = follow(*arguments, tolerance=tolerance, since=before)
    code, largest_tilt, airtime, impact_speed, peak_force, _ = result.tolist()
    known = 1.0 if code == OK else math.nan
    return BlockRun(
        conveyor=conveyor,
        block=block,
        start=start,
        tilt=tilt,
        duration=duration,
        tolerance=tolerance,
        status=STATUS[int(code)],
        x_last=float(last[X]),
        x_end=float(end[X]),
        largest_tilt=largest_tilt,
        airtime=known * airtime / (duration - before) if before < duration else math.nan,
        impact_speed=known * impact_speed,
        peak_force=known * conveyor.mass * peak_force,
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
    block, tilts : the block, and the initial angles (rad), a number or of shape (n,)
    length, longest : m, of the track; s, after which a part is late
    begin : time (s) from which impacts, forces and flights count, at most `longest`, a number or of shape (n,)
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
    tilts = check_column("tilts", tilts, rows.shape[:1], -math.pi, math.pi, unit="rad").copy()
    begin = check_column("begin", begin, rows.shape[:1], 0.0, LONGEST, unit="s").copy()
    if (begin > longest).any():
        raise ValueError(f"begin = {begin.max()!s} s is after longest = {longest!r} s")
    travelled, results = np.empty(len(rows)), np.empty((len(rows), block_motion.RESULTS))

    def work(begin_row, stop):
        part = slice(begin_row, stop)
        arguments = rows[part], block, tilts[part], [longest]
        samples, results[part] = follow(*arguments, tolerance=tolerance, since=begin[part], distance=length)
        travelled[part] = samples[:, 0, X]
        return np.count_nonzero(results[part, block_motion.CODE] != OK)

    for_each_chunk(work, len(rows), threads=threads, chunk=16, progress=progress)
    codes, largest_tilt, airtime, impact_speed, peak_force, arrival = results.T
    late = np.isnan(arrival)
    ends = np.where(late, longest, arrival)
    known = np.where(ends > begin, 1.0, np.nan)
    columns = {
        "arrival": arrival.copy(),
        "velocity": np.where(late, travelled, length) / ends,
        "impact_speed": known * impact_speed,
        "peak_force": known * rows[:, MASS] * peak_force,
        "airtime": known * airtime / (known * (ends - begin)),
        "largest_tilt": largest_tilt.copy(),
    }
    for column in columns.values():
        column[codes != OK] = np.nan
    return Columns(columns | {"status": np.array(STATUS, dtype=object)[codes.astype(np.int64)]})
