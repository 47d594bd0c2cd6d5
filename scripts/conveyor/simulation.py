"""One call for every method: `simulate` follows one part on one conveyor."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .arguments import LONGEST, check_array, check_choice, check_flag, check_number, check_time, check_tolerance
from .methods import fixed_step
from .packing import AT_REST, check_row, conveyor_of
from .parameters import DEFAULT_STEP, DEFAULT_TOLERANCE, LAST, PARAMETERS
from .solver import plate, record, trajectory
from .solver.model import ACCELERATION, ANGLE, FREQUENCY, PHASE_SHIFT, PSI0, Conveyor, Start, pack
from .solver.record import SAMPLES, name_events
from .solver.status import OK, STATUS

EVENT_STATE = ("x", "vx", "z", "vz", "impact_speed")
METHODS = ("event", *fixed_step.METHODS)
SMALLEST_SHARE = 1e-6  # of a run, over which a mean velocity is taken
MOST_STEPS = 10**10  # fixed steps of a run, which take minutes


def plate_motion(conveyor: Conveyor | np.ndarray, times: ArrayLike) -> dict[str, np.ndarray]:
    """Position and velocity of the plate (Eqs. 3, 4, 10) at `times` (s): x, z in m; vx, vz in m/s; same shape.

    conveyor : a Conveyor, or a row of a table

    Examples
    --------
    >>> plate = plate_motion(Conveyor(acceleration=40.0), np.array([0.0, 0.01]))  # at its lowest and highest point
    >>> (1e6 * plate["z"]).round(1).tolist()  # µm
    [-84.3, 84.3]
    """
    row = check_row("conveyor", conveyor)
    acceleration, angle, frequency, psi0, shift = row[[ACCELERATION, ANGLE, FREQUENCY, PSI0, PHASE_SHIFT]].tolist()
    omega = 2.0 * math.pi * frequency
    phase = omega * check_array("times", times, -LONGEST, LONGEST, "s", least=0) + psi0
    a_x, a_z = acceleration * math.cos(angle), acceleration * math.sin(angle)
    return plate.motion(a_x, a_z, omega, shift, row[len(PARAMETERS) :], phase)


def mean_velocity(run, last: float = LAST) -> float:
    """Mean feeding velocity over the last part of a run, (x(T) - x((1 - last) T)) / (last T), m/s (Sect. 3.1)."""
    last = check_number("last", last, SMALLEST_SHARE, 1.0)
    x_before = run.x_last
    if last != LAST:
        x_before = float(run.sample(np.array([(1.0 - last) * run.duration]))["x"][0])
    return (run.x_end - x_before) / (last * run.duration)


@dataclass(frozen=True, kw_only=True)
class Run:
    """The result of `simulate`. It stores the final state; `sample` and `events` repeat the simulation.

    Attributes
    ----------
    conveyor, start, duration, method, tolerance, step, reuse : the arguments of `simulate`
    status : "ok", or why the run ended early: impacts are then those up to its end, all other numbers NaN
    z_end, vz_end, x_end, vx_end : state at the end, m and m/s
    impacts : number of impacts
    max_gap : largest distance between part and plate, m
    contact_fraction : share of the duration with a contact force
    impact_speed : largest speed of approach at an impact over the last quarter, m/s; 0 if there is none
    peak_force : largest contact force over the last quarter, N; 0 if there is none
    work : force evaluations (fixed step) or computed Taylor steps (event)
    repeats : Taylor steps of a settled motion that were used again (event)
    """

    conveyor: Conveyor
    start: Start
    duration: float
    method: str
    tolerance: float
    step: float
    reuse: bool
    status: str
    x_last: float
    z_end: float
    vz_end: float
    x_end: float
    vx_end: float
    impacts: int
    max_gap: float
    contact_fraction: float
    impact_speed: float
    peak_force: float
    work: int
    repeats: int
    event_count: int

    def __repr__(self) -> str:
        how = self.method if self.method == "event" else f"{self.method}, step {self.step:g} s"
        return f"Run({self.duration:g} s, {how}; {self.status}, {self.impacts} impacts)"

    mean_velocity = mean_velocity

    def sample(self, times: ArrayLike) -> dict[str, np.ndarray]:
        """The motion at `times` (s, any shape and order, within the run); of a fixed-step method, at the nearest step.

        Returns
        -------
        dict of float64 arrays of the shape of `times`: x, z (m), vx, vz (m/s), contact_force, friction_force (N);
        NaN after the point where a run ended early
        """
        times = check_array("times", times, 0.0, self.duration, "s", least=0)
        if self.method != "event":
            return fixed_step.sample(pack(self.conveyor, self.start), times, self.step, self.method)
        moments, place = np.unique(times, return_inverse=True)
        samples = np.empty((moments.size, len(SAMPLES)))
        if moments.size:
            parameters = pack(self.conveyor, self.start)[None]
            options = {"tolerance": self.tolerance, "reuse": self.reuse}
            (samples,), _ = trajectory.integrate(parameters, moments[None], **options)
        return {name: samples[place, k].reshape(times.shape) for k, name in enumerate(SAMPLES)}

    @cached_property
    def events(self) -> np.ndarray:
        """Events in order of time, with the state there.

        Returns
        -------
        structured array with the fields time (s); kind, one of record.EVENT_KINDS; x, z (m), vx, vz (m/s); and
        impact_speed, the speed (m/s) with which part and plate approach each other, NaN for all events but impacts
        """
        parameters = pack(self.conveyor, self.start)
        if self.method != "event":
            named = fixed_step.events(parameters, self.duration, self.step, self.method)
        else:
            times, kinds = np.empty(self.event_count), np.empty(self.event_count, np.int8)
            options = {"tolerance": self.tolerance, "reuse": self.reuse}
            options |= {"event_times": times[None], "event_kinds": kinds[None]}
            trajectory.integrate(parameters[None], np.array([[self.duration]]), **options)
            named = name_events(times, kinds)
        events = np.empty(len(named), [*named.dtype.descr, *((name, np.float64) for name in EVENT_STATE)])
        for name in named.dtype.names:
            events[name] = named[name]
        # An event may lie a rounding error behind the end.
        times = np.minimum(named["time"], self.duration)
        states, plates = self.sample(times), plate_motion(self.conveyor, times)
        for name in EVENT_STATE[:-1]:
            events[name] = states[name]
        approach = plates["vz"] - states["vz"]
        events["impact_speed"] = np.where(named["kind"] == "impact", approach, np.nan)
        return events


def check_run(duration: float, method: str, tolerance: float, step: float) -> tuple[float, float, float]:
    """Duration, tolerance and step as floats; ValueError that names the argument of `simulate` that cannot be used.

    Compiled functions would be compiled again for numbers of another type, such as np.float32.
    """
    duration = check_time("duration", duration)
    check_choice("method", method, METHODS)
    tolerance = check_tolerance(tolerance)
    step = check_time("step", step)
    if method != "event" and duration / step > MOST_STEPS:
        raise ValueError(f"step = {step!r} s makes more than {MOST_STEPS:g} steps of the duration of {duration!r} s")
    return duration, tolerance, step


def follow_by_events(
    parameters: np.ndarray, durations: np.ndarray, tolerance: float, feeding: bool, reuse: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Samples where the last quarters of runs begin and end, shape (n, 2, 6), and results, shape (n, 11).

    parameters, durations : shape (n, 16), and s, shape (n,)
    """
    times = durations[:, None] * np.array([1.0 - LAST, 1.0])
    return trajectory.integrate(parameters, times, tolerance=tolerance, feeding=feeding, reuse=reuse)


def name_results(before: Sequence, after: Sequence, results: Sequence, duration: ArrayLike) -> dict:
    """What `follow_by_events` returns, by name: columns of `ensemble.sweep`, and what only a Run has.

    before, after, results : the numbers of one run, or the columns of many
    """
    return {
        "x_last": before[record.X],
        "x_end": after[record.X],
        "vx_end": after[record.VX],
        "z_end": after[record.Z],
        "vz_end": after[record.VZ],
        "max_gap": results[record.MAX_GAP],
        "impacts": results[record.IMPACTS],
        "contact_fraction": results[record.CONTACT_TIME] / duration,
        "impact_speed": results[record.IMPACT_SPEED],
        "peak_force": results[record.PEAK_FORCE],
        "status": results[record.CODE],
        "work": results[record.STEPS],
        "repeats": results[record.REPEATS],
        "event_count": results[record.EVENTS],
    }


def simulate(
    conveyor: Conveyor | np.ndarray,
    start: Start = AT_REST,
    *,
    duration: float = 1.0,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    reuse: bool = True,
) -> Run:
    """Follow one part on one conveyor. At t = 0, x and vx are zero.

    Parameters
    ----------
    conveyor : a Conveyor, or a row of a table, whose initial condition is the default of `start`
    start : see model.Start
    duration : s, above 0 and up to 1e6
    method : "event" for the exact event loop, or one of fixed_step: "euler" (the paper's), "semi_implicit_euler", "rk4"
    tolerance : relative error per Taylor step, 1e-14 to 1e-2; used by "event"
    step : time step in s; the duration must be a whole number of steps; used by the fixed-step methods
    reuse : whether Taylor steps of a settled motion are used again (see repeated_steps); used by "event"

    Returns
    -------
    Run, whose status says whether the part could be followed to the end

    Examples
    --------
    >>> run = simulate(Conveyor(acceleration=40.0), Start(z=3e-4), duration=0.5)
    >>> run.status, run.impacts
    ('ok', 25)
    >>> run.sample(np.array([0.0, 0.25]))["z"].shape  # m
    (2,)
    >>> impacts = run.events[run.events["kind"] == "impact"]
    >>> phases, speeds = 2.0 * np.pi * (50.0 * impacts["time"] % 1.0), impacts["impact_speed"]  # the impact map
    >>> len(speeds), round(speeds[-1].item(), 3)  # m/s
    (25, 0.112)
    """
    conveyor, start = conveyor_of(conveyor, start)
    duration, tolerance, step = check_run(duration, method, tolerance, step)
    check_flag("reuse", reuse)
    rows = pack(conveyor, start)[None]
    if method == "event":
        samples, results = follow_by_events(rows, np.array([duration]), tolerance, True, reuse)
        run = name_results(*samples[0].tolist(), results[0].tolist(), duration)
    else:
        columns = fixed_step.run(rows, duration, step, method)
        run = {name: column.item() for name, column in columns.items() if name != "mean_velocity"}
    code = run.pop("status")
    if code != OK:
        run["max_gap"] = run["contact_fraction"] = math.nan
    run |= {name: int(run[name]) for name in ("impacts", "work", "repeats", "event_count")}
    options = {"method": method, "tolerance": tolerance, "step": step, "reuse": reuse}
    return Run(conveyor=conveyor, start=start, duration=duration, status=STATUS[int(code)], **options, **run)
