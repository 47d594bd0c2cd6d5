"""Error, force evaluations and processor time of every method over its tolerances or steps, in one scene.

The reference is the solver at its tightest tolerance. It is not its own judge: an independent integration, scipy's
DOP853 from event to event at its tightest tolerance, is among the rows, and its error is the difference of the two. For
one scene `reference_check` compares the reference with a solution in arithmetic of many digits.

Times differ from run to run and from machine to machine. They have a table of their own, so that what does not stays as
it is.
"""

import math
from functools import partial
from typing import NamedTuple

import numpy as np

from accuracy.timing import in_turns
from conveyor.analysis.attractors import labels
from conveyor.methods import fixed_step, peers
from conveyor.simulation import simulate
from conveyor.solver.model import conveyor_motion, pack
from conveyor.solver.polynomial import ORDER
from pipeline import fields, grid

RUN = (
    fields.text("method", "event, a fixed-step method, or one of scipy's integrators"),
    fields.text(
        "treatment",
        "of impacts and slip reversals: exact, with or without repeated steps, fixed step, sign, events or modes",
    ),
    fields.number("tolerance", "1", "relative tolerance; null for fixed steps"),
    fields.number("step", "s", "step; null for tolerances"),
)

TABLES = {
    "precision": (
        *RUN,
        fields.count("evaluations", "force evaluations that are computed; derivatives of the force for a Taylor step"),
        fields.count("repeated_evaluations", "those of a settled motion that are used again instead"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity over the last quarter"),
        fields.number("velocity_error", "1", "its relative error"),
        fields.number("state_error", "1", "largest error of ẋ, z, ż at the end, in units of the plate's motion"),
        fields.number(
            "trajectory_error", "1", "root mean square error of x and z at fixed times, in units of the plate's motion"
        ),
        fields.number(
            "event_error",
            "1",
            "largest error of a time of impact or separation, in cycles; null where their number is wrong, or unknown",
        ),
        fields.text("outcome", "ok, or what is wrong, whatever the run itself reports"),
    ),
    "precision_times": (
        *RUN,
        fields.number("seconds", "s", "median processor time; every method runs in one thread"),
        fields.count("repeats", "timed runs"),
    ),
}

TRUTH = 1e-14  # tolerance
SHORT = {"duration": 1e-3, "max_evaluations": 1000}  # of runs that only load or compile what the method needs
# Treatments of the event-driven solver: as it is, and with every step of a settled motion computed.
EXACT, ANEW = "exact", "exact, nothing repeated"
# Where a run ends in another state of motion, and where its part is deeper in the plate than the plate moves.
WRONG = "wrong state"
THROUGH = "through the plate"


class Method(NamedTuple):
    """One run of the chart; the tolerance or the step is None."""

    method: str
    treatment: str  # of impacts and slip reversals: EXACT, ANEW, fixed step, or one of peers.TREATMENTS
    tolerance: float | None
    step: float | None


class Result(NamedTuple):
    """What a run comes to, in the terms that all methods share."""

    mean_velocity: float  # m/s
    end: np.ndarray  # ẋ, z, ż (m/s, m, m/s), shape (3,)
    evaluations: int
    repeated: int  # evaluations of a settled motion that were used again
    status: str


def methods(settings: dict) -> list[Method]:
    """All runs of a scene in the order of the table."""
    listed = [Method("event", one, tolerance, None) for one in (EXACT, ANEW) for tolerance in settings["tolerances"]]
    listed += [Method(name, "fixed step", None, step) for name in fixed_step.METHODS for step in settings["steps"]]
    for treatment, integrators in settings["peers"].items():
        for name, tolerances in integrators.items():
            listed += [Method(name, treatment, tolerance, None) for tolerance in tolerances]
    return listed


def follow(method: Method, settings: dict) -> Result:
    """One run. A Taylor step of order n counts as n force evaluations: it finds n derivatives of the force."""
    conveyor, start = grid.conveyor_and_start(settings["model"])
    if method.treatment in peers.TREATMENTS:
        run = peers.run(
            pack(conveyor, start),
            settings["duration"],
            method.method,
            method.treatment,
            method.tolerance,
            settings["max_evaluations"],
        )
        return Result(run.mean_velocity, np.array([run.vx, run.z, run.vz]), run.evaluations, 0, run.status)
    accuracy = {"tolerance": method.tolerance} if method.step is None else {"step": method.step}
    reuse = method.treatment != ANEW
    run = simulate(conveyor, start, duration=settings["duration"], method=method.method, reuse=reuse, **accuracy)
    order = ORDER if method.method == "event" else 1
    end = np.array([run.vx_end, run.z_end, run.vz_end])
    return Result(run.mean_velocity(), end, order * run.work, order * run.repeats, run.status)


def sample_times(settings: dict) -> np.ndarray:
    """The fixed times (s) at which trajectories are compared."""
    interval = settings["sample_interval"]
    return interval * np.arange(1, int(settings["duration"] / interval * (1.0 + 1e-9)) + 1)


def contact_changes(events: np.ndarray) -> np.ndarray:
    """Times (s) of the impacts and separations among the events of a run."""
    return events["time"][np.isin(events["kind"], ["impact", "separation"])]


def trajectory(method: Method, settings: dict) -> tuple[np.ndarray, np.ndarray]:
    """x and z (m) at the fixed times, shape (n, 2), and the times (s) of impacts and separations."""
    conveyor, start = grid.conveyor_and_start(settings["model"])
    times, duration = sample_times(settings), settings["duration"]
    if method.treatment in peers.TREATMENTS:
        # To interpolate may take evaluations, too.
        limit = 2 * settings["max_evaluations"]
        run = peers.run(
            pack(conveyor, start), duration, method.method, method.treatment, method.tolerance, limit, times=times
        )
        return run.samples[:, [0, 2]], run.events
    accuracy = {"tolerance": method.tolerance} if method.step is None else {"step": method.step}
    reuse = method.treatment != ANEW
    run = simulate(conveyor, start, duration=duration, method=method.method, reuse=reuse, **accuracy)
    samples = run.sample(times)
    return np.stack([samples["x"], samples["z"]], axis=1), contact_changes(run.events)


def trajectory_errors(method: Method, truth: tuple[np.ndarray, np.ndarray], settings: dict) -> tuple[float, float]:
    """RMS error of x and z in units of the plate's motion, and largest error of an event time in cycles."""
    positions, events = trajectory(method, settings)
    scale = peers.scales(grid.packed(settings["model"]))[[0, 2]]
    error = math.sqrt(np.mean(((positions - truth[0]) / scale) ** 2))
    if len(events) != len(truth[1]):
        return error, math.nan
    conveyor, _ = grid.conveyor_and_start(settings["model"])
    return error, float(np.abs(events - truth[1]).max(initial=0.0) * conveyor.frequency)


def leads_to(settings: dict, end: np.ndarray) -> str:
    """State of motion that a run with this end leads to."""
    parameters = grid.packed(settings["model"])[None]
    later = labels.continued(parameters, end[1:2], end[2:3], settings["duration"])
    return str(labels.classify(later).state[0])


def outcome(result: Result, error: float, settings: dict, state: str) -> str:
    """ "ok", or what is wrong with a run, which its own status need not say; `state` is the right state of motion."""
    if result.status != "ok":
        return result.status
    conveyor, _ = grid.conveyor_and_start(settings["model"])
    plate = conveyor_motion(conveyor, np.array([settings["duration"], 0.5 / conveyor.frequency]))["z"]
    stroke = np.abs(plate).max()
    if result.end[1] < plate[0] - stroke:
        return THROUGH
    if not error < 1.0 or leads_to(settings, result.end) != state:
        return WRONG
    return "ok"


def make(settings: dict, timing: dict, *, progress: str | None = None) -> dict[str, dict[str, np.ndarray]]:
    """The columns of the tables of work and precision and of processor times, rows by method, tolerance and step.

    Parameters
    ----------
    settings : of one scene with its model
    timing : `repeats` and `seconds`, see `timing.in_turns`
    progress : name of a progress bar, or None
    """
    truth = follow(Method("event", ANEW, TRUTH, None), settings)
    _, *scale = peers.scales(grid.packed(settings["model"]))
    listed = methods(settings)
    for method in listed:
        follow(method, settings | SHORT)
    results, times = in_turns([partial(follow, method, settings) for method in listed], **timing, progress=progress)
    state = leads_to(settings, truth.end)
    velocity = np.array([result.mean_velocity for result in results])
    velocity_error = np.abs(velocity / truth.mean_velocity - 1.0)
    outcomes = [outcome(result, error, settings, state) for result, error in zip(results, velocity_error, strict=True)]
    reference = trajectory(Method("event", ANEW, TRUTH, None), settings)
    lost = (math.nan, math.nan)
    errors = [
        trajectory_errors(method, reference, settings) if found == "ok" else lost
        for method, found in zip(listed, outcomes, strict=True)
    ]
    run = {
        "method": np.array([method.method for method in listed]),
        "treatment": np.array([method.treatment for method in listed]),
        "tolerance": np.array([method.tolerance for method in listed], dtype=np.float64),
        "step": np.array([method.step for method in listed], dtype=np.float64),
    }
    return {
        "precision": {
            **run,
            "evaluations": np.array([result.evaluations for result in results]),
            "repeated_evaluations": np.array([result.repeated for result in results]),
            "mean_velocity": velocity,
            "velocity_error": velocity_error,
            "state_error": np.array([np.abs((result.end - truth.end) / scale).max() for result in results]),
            "trajectory_error": np.array([error for error, _ in errors]),
            "event_error": np.array([error for _, error in errors]),
            "outcome": np.array(outcomes),
        },
        "precision_times": {
            **run,
            "seconds": np.array([np.median(spent) for spent in times]),
            "repeats": np.array([len(spent) for spent in times]),
        },
    }
