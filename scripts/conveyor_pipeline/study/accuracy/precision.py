"""Error, force evaluations and processor time of every method over its tolerances or steps, in one scene.

The reference is the solver at its tightest tolerance. It is checked by an independent integration: the error of SciPy's
DOP853 with modes at its tightest tolerance, which is one of the rows.

Times differ between runs and machines. They have a table of their own, so that the main table is reproducible.
"""

import math
from functools import partial
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor import Conveyor, Run, Start, classify, parameter_table, plate_motion, restart, simulate
from conveyor.methods import fixed_step, modes
from conveyor.solver.polynomial import ORDER
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.study.accuracy import scipy_integrators
from conveyor_pipeline.study.accuracy.scenes import TRUTH
from conveyor_pipeline.study.accuracy.scipy_integrators import IntegratorRun
from conveyor_pipeline.study.accuracy.timing import run_in_turns

RUN = (
    fields.text("method", "event, a fixed-step method, or an integrator of SciPy"),
    fields.text("treatment", "of impacts and slip: exact (with or without reuse), fixed step, sign, events or modes"),
    fields.number("tolerance", "1", "relative tolerance; null for fixed steps"),
    fields.number("step", "s", "time step; null for methods with a tolerance"),
)

TABLES = {
    "precision": (
        *RUN,
        fields.count("evaluations", "computed force evaluations; computed derivatives of the force for a Taylor step"),
        fields.count("repeated_evaluations", "force evaluations saved by reusing the steps of a periodic motion"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity over the last quarter"),
        fields.number("velocity_error", "1", "relative error of the mean velocity"),
        fields.number("state_error", "1", "largest error of ẋ, z, ż at the end, in units of the plate's motion"),
        fields.number("trajectory_error", "1", "rms error of x and z at fixed times, in units of the plate's motion"),
        fields.text("outcome", "ok, or the failure, independent of the status that the method reports"),
    ),
    "precision_times": (
        *RUN,
        fields.number("seconds", "s", "median processor time; every method runs in one thread"),
    ),
}

SAMPLE_INTERVAL = (
    19e-3  # s, between the times at which trajectories are compared: a multiple of each time step, with many phases
)
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13)
STEPS = (1e-3, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7)  # s
# Relative tolerances of SciPy's integrators, by how they treat impacts and slip reversals (see scipy_integrators). They
# take most of the time of this table, so that they run with as few tolerances as show their curves and failures: with
# `sign`, tighter tolerances take more evaluations than allowed, and only `modes` is worth many tolerances.
SCIPY = {
    "sign": {
        "RK45": (1e-4, 1e-6),
        "DOP853": (1e-4, 1e-6, 1e-8),
        "LSODA": (1e-4, 1e-6),
    },
    "events": {
        "RK45": (1e-4, 1e-6, 1e-8),
        "DOP853": (1e-4, 1e-6, 1e-8, 1e-11),
        "Radau": (1e-4,),
    },
    "modes": {
        "RK45": (1e-4, 1e-6, 1e-8),
        "DOP853": (1e-4, 1e-6, 1e-8, 1e-9, 1e-11, 1e-13),
        "Radau": (1e-4, 1e-6),
        "LSODA": (1e-4, 1e-6, 1e-8),
    },
}
MOST_EVALUATIONS = 4000  # of the force per excitation cycle of an integrator of SciPy, which then gives up
SECONDS = 0.1  # s of processor time, after which a run is not repeated
SHORT = 1e-3  # s, of runs that only compile or load the code of a method
# Treatments of the event-driven solver: with and without reuse of the steps of a periodic motion.
EXACT, NO_REUSE = "exact", "exact, nothing repeated"
# Outcomes of runs that lead to another state of motion, or whose part is deeper in the plate than the plate's stroke.
WRONG = "wrong state"
THROUGH = "through the plate"


class Method(NamedTuple):
    """One run of the chart; the tolerance or the step is None."""

    method: str
    treatment: str  # of impacts and slip reversals: EXACT, NO_REUSE, fixed step, or one of scipy_integrators.TREATMENTS
    tolerance: float | None
    step: float | None


class Result(NamedTuple):
    """The quantities of a run that all methods have."""

    mean_velocity: float  # m/s
    end: np.ndarray  # ẋ, z, ż (m/s, m, m/s), shape (3,)
    evaluations: int
    repeated: int  # evaluations saved by reusing the steps of a periodic motion
    status: str
    run: Run | IntegratorRun  # which has or gives the states at the sampled times


def methods(default: float) -> list[Method]:
    """All runs of a scene in the order of the table; `default` is the default tolerance of the solver."""
    tolerances = sorted({*TOLERANCES, default}, reverse=True)
    listed = [
        Method("event", treatment, tolerance, None) for treatment in (EXACT, NO_REUSE) for tolerance in tolerances
    ]
    listed += [Method(name, "fixed step", None, step) for name in fixed_step.METHODS for step in STEPS]
    for treatment, integrators in SCIPY.items():
        for name, tolerances in integrators.items():
            listed += [Method(name, treatment, tolerance, None) for tolerance in tolerances]
    return listed


def most_evaluations(frequency: float, duration: float) -> int:
    """Force evaluations after which a run of SciPy is given up."""
    return round(MOST_EVALUATIONS * duration * frequency)


def run_method(method: Method, conveyor: Conveyor, start: Start, duration: float) -> Result:
    """The result of a run. A Taylor step of order n counts as n force evaluations, for n derivatives of the force.

    Runs of SciPy interpolate at the sampled times. The other methods record their motion, which is sampled later.
    """
    if method.treatment in scipy_integrators.TREATMENTS:
        name, treatment, tolerance, _ = method
        parameters = parameter_table(conveyor, start)
        limit = most_evaluations(conveyor.frequency, duration)
        times = sample_times(duration)
        run = scipy_integrators.run(parameters, duration, name, treatment, tolerance, limit, times)
        return Result(run.mean_velocity, np.array([run.vx, run.z, run.vz]), run.evaluations, 0, run.status, run)
    accuracy = {"tolerance": method.tolerance} if method.step is None else {"step": method.step}
    reuse = method.treatment != NO_REUSE
    run = simulate(conveyor, start, duration=duration, method=method.method, reuse=reuse, **accuracy)
    order = ORDER if method.method == "event" else 1
    end = np.array([run.vx_end, run.z_end, run.vz_end])
    return Result(run.mean_velocity(), end, order * run.work, order * run.repeats, run.status, run)


def sample_times(duration: float) -> np.ndarray:
    """The fixed times (s) at which trajectories are compared."""
    return SAMPLE_INTERVAL * np.arange(1, int(duration / SAMPLE_INTERVAL * (1.0 + 1e-9)) + 1)


def sample_trajectory(run: Run | IntegratorRun, duration: float) -> np.ndarray:
    """x and z (m) at the fixed times, shape (n, 2)."""
    if isinstance(run, IntegratorRun):
        return run.samples[:, [0, 2]]
    samples = run.sample(sample_times(duration))
    return np.stack([samples["x"], samples["z"]], axis=1)


def trajectory_error(run: Run | IntegratorRun, truth: np.ndarray, settings: dict) -> float:
    """RMS error of x and z in units of the plate's motion."""
    scale = modes.scales(grid.row_of(settings["model"]))[[0, 2]]
    return math.sqrt(np.mean(((sample_trajectory(run, settings["duration"]) - truth) / scale) ** 2))


def find_states(settings: dict, ends: np.ndarray) -> np.ndarray:
    """The states of motion that runs lead to, from their `ends`, shape (n, 3)."""
    parameters = np.full(len(ends), grid.row_of(settings["model"]))
    return classify(restart(parameters, ends[:, 1], ends[:, 2], settings["duration"])).state


def judge_runs(results: list[Result], errors: np.ndarray, truth: Result, settings: dict) -> list[str]:
    """ "ok" for each run, or its failure, which its own status may not report.

    errors : relative errors of the mean velocities, shape (n,)
    """
    conveyor, _ = grid.conveyor_and_start(settings["model"])
    plate = plate_motion(conveyor, np.array([settings["duration"], 0.5 / conveyor.frequency]))["z"]
    lowest = plate[0] - np.abs(plate).max()
    outcomes = [THROUGH if result.status == "ok" and result.end[1] < lowest else result.status for result in results]
    ended = [place for place, outcome in enumerate(outcomes) if outcome == "ok"]
    right, *states = find_states(settings, np.array([truth.end, *(results[place].end for place in ended)]))
    for place, state in zip(ended, states, strict=True):
        if not errors[place] < 1.0 or state != right:
            outcomes[place] = WRONG
    return outcomes


def make(settings: dict, repeats: int, *, progress: str | None = None) -> dict[str, dict]:
    """The columns of the tables of work and precision and of processor times, rows by method, tolerance and step.

    repeats : rounds of timed runs, in each of which the methods alternate
    """
    scene = grid.conveyor_and_start(settings["model"])
    truth = run_method(Method("event", NO_REUSE, TRUTH, None), *scene, settings["duration"])
    _, *scale = modes.scales(grid.row_of(settings["model"]))
    listed = methods(settings["default"])
    for method in listed:
        run_method(method, *scene, SHORT)
    runs = [partial(run_method, method, *scene, settings["duration"]) for method in listed]
    results, times = run_in_turns(runs, repeats=repeats, seconds=SECONDS, progress=progress)
    run, columns = pd.DataFrame(listed), pd.DataFrame(results)
    velocity_error = (columns.mean_velocity / truth.mean_velocity - 1.0).abs()
    outcomes = judge_runs(results, velocity_error, truth, settings)
    reference = sample_trajectory(truth.run, settings["duration"])
    errors = [
        trajectory_error(result.run, reference, settings) if outcome == "ok" else math.nan
        for result, outcome in zip(results, outcomes, strict=True)
    ]
    return {
        "precision": {
            **run,
            "evaluations": columns.evaluations,
            "repeated_evaluations": columns.repeated,
            "mean_velocity": columns.mean_velocity,
            "velocity_error": velocity_error,
            "state_error": [np.abs((result.end - truth.end) / scale).max() for result in results],
            "trajectory_error": errors,
            "outcome": outcomes,
        },
        "precision_times": {
            **run,
            "seconds": [np.median(spent) for spent in times],
        },
    }
