"""Speed of the solver compared with the paper's method, both compiled, both through `simulate`, in one thread.

Times are processor times of the thread, to which other load on the machine adds little. In each round, every case has
a turn: several runs of the solver, several runs without reuse of steps, and one run of Euler, so that all of them run
at the same clock frequency. The reference is an independent integration by SciPy's DOP853 with events.
"""

from time import thread_time

import numpy as np
import pandas as pd

from conveyor import ORDER, Run, progress_bar, simulate
from conveyor.methods import scipy_integrators
from pipeline import fields, grid
from pipeline.templates import render

TABLES = {
    "benchmark": (
        fields.text("case", "name of the case"),
        fields.text("motion", "motion of the part in words"),
        fields.text("chosen", "tolerance: the default, or the loosest that keeps the error against the reference"),
        fields.number("tolerance", "1", "relative error of a step"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height"),
        fields.number("duration", "s", "duration of the timed runs"),
        fields.number("compared", "s", "duration of the runs whose mean velocities are compared"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity, from an independent integration"),
        fields.number("error", "1", "relative error of the solver's mean velocity"),
        fields.number("euler_error", "1", "relative error of Euler's mean velocity"),
        fields.count("steps", "computed Taylor steps of a timed run"),
        fields.count("repeated_steps", "reused Taylor steps of a periodic motion in a timed run"),
        fields.count("evaluations", "derivatives of the contact force in a timed run"),
        fields.count("events", "events of a timed run"),
        fields.count("euler_steps", "steps of Euler in a timed run"),
        fields.number("seconds", "s", "median processor time of the solver"),
        fields.number("seconds_without", "s", "median processor time of the solver without reuse of steps"),
        fields.number("euler_seconds", "s", "median processor time of Euler"),
        fields.number("speed", "1", "time of Euler over time of the solver"),
        fields.number("speed_without", "1", "time of Euler over time of the solver without reuse of steps"),
        fields.count("repeats", "rounds of timed runs"),
    ),
}

# The motions that are compared, by their models. `loosest`: the largest tolerance that meets the goal of the error.
# `compared`: the time over which errors are computed (s); in chaos, no two methods agree later. `wanted`: the goals for
# the relative error of the mean velocity and for the speed, in units of Euler's, and what we would like beyond it.
CASES = {
    "A": {
        "motion": "jumping",
        "model": {"acceleration": 40.0, "z0": 0.3e-3},
        "loosest": 3.0e-9,
        "compared": 1.0,
        "wanted": {"error": 1.0e-9, "speed": 200.0, "aim": 1000.0},
    },
    "B": {
        "motion": "always in contact",
        "model": {"acceleration": 30.0},
        "loosest": 1.0e-9,
        "compared": 1.0,
        "wanted": {"error": 1.0e-9, "speed": 150.0, "aim": 600.0},
    },
    "C": {
        "motion": "micro-bounces",
        "model": {"acceleration": 47.0},
        "compared": 1.0,
        "wanted": {"error": 1.0e-9, "speed": 40.0, "aim": 200.0},
    },
    "D": {
        "motion": "chaos",
        "model": {"acceleration": 80.0},
        "loosest": 1.0e-8,
        "compared": 0.2,
        "wanted": {"error": 1.0e-6, "speed": 200.0, "aim": 500.0},
    },
}
DURATION, STEP = 1.0, 5.0e-7  # s, of the timed runs and of Euler, as in the paper
TRUTH = {"integrator": "DOP853", "treatment": "modes", "tolerance": 1e-13, "max_evaluations": 10_000_000}
# Runs of the solver per run of Euler.
RUNS = 20


def time_run(case: dict, duration: float, method: str, reuse: bool = True) -> tuple[float, Run]:
    """Processor time (s) of a run with its mean velocity, and the run."""
    conveyor, start = grid.conveyor_and_start(case["model"])
    accuracy = {"tolerance": case["tolerance"], "step": case["step"], "reuse": reuse}
    begin = thread_time()
    run = simulate(conveyor, start, duration=duration, method=method, **accuracy)
    run.mean_velocity()
    return thread_time() - begin, run


def measure_times(cases: list[dict], repeats: int, progress: str | None) -> np.ndarray:
    """Median processor times (s) of the solver, of the solver without reuse of steps, and of Euler: shape (3, cases).

    The first round, which compiles code, does not count.
    """
    spent = [[[], [], []] for _ in cases]
    for turn in progress_bar(range(repeats + 1), label=progress, unit="rounds"):
        for case, times in zip(cases, spent, strict=True):
            solver = [time_run(case, case["duration"], "event")[0] for _ in range(RUNS)]
            without = [time_run(case, case["duration"], "event", reuse=False)[0] for _ in range(RUNS)]
            euler = [time_run(case, case["duration"], "euler")[0]]
            if turn > 0:
                for method_times, new in zip(times, (solver, without, euler), strict=True):
                    method_times += new
    return np.array([[np.median(method_times) for method_times in times] for times in spent]).T


def list_runs(cases: dict[str, dict], default: float) -> list[dict]:
    """Every case at the default tolerance, and again at its loosest tolerance, if it has one."""
    rows = []
    for name, case in cases.items():
        rows.append({**case, "case": name, "tolerance": default, "chosen": "default"})
        if "loosest" in case:
            rows.append({**case, "case": name, "tolerance": case["loosest"], "chosen": "loosest that keeps the error"})
    return rows


def columns(model: dict, tolerance: float, repeats: int, *, progress: str | None = None) -> dict:
    """The columns of the table for the paper's conveyor, `model`, without its amplitude."""
    cases = {
        name: {**case, "model": {**model, **case["model"]}, "duration": DURATION, "step": STEP}
        for name, case in CASES.items()
    }
    rows = list_runs(cases, tolerance)
    runs = [time_run(case, case["duration"], "event")[1] for case in rows]
    eulers = [time_run(case, case["duration"], "euler")[1] for case in rows]
    truths = {
        name: scipy_integrators.run(grid.row_of(case["model"]), case["compared"], **TRUTH).mean_velocity
        for name, case in cases.items()
    }
    truth = np.array([truths[case["case"]] for case in rows])
    event = [time_run(case, case["compared"], "event")[1].mean_velocity() for case in rows]
    euler = [time_run(case, case["compared"], "euler")[1].mean_velocity() for case in rows]
    seconds, without, euler_seconds = measure_times(rows, repeats, progress)
    return {
        **pd.DataFrame(rows)[["case", "motion", "chosen", "tolerance", "duration", "compared"]],
        **pd.DataFrame([case["model"] for case in rows])[["acceleration", "z0"]],
        "mean_velocity": truth,
        "error": np.abs(np.array(event) / truth - 1.0),
        "euler_error": np.abs(np.array(euler) / truth - 1.0),
        "steps": np.array([run.work for run in runs]),
        "repeated_steps": np.array([run.repeats for run in runs]),
        "evaluations": np.array([run.work * ORDER for run in runs]),
        "events": np.array([run.event_count for run in runs]),
        "euler_steps": np.array([run.work for run in eulers]),
        "seconds": seconds,
        "seconds_without": without,
        "euler_seconds": euler_seconds,
        "speed": euler_seconds / seconds,
        "speed_without": euler_seconds / without,
        "repeats": np.full(len(rows), repeats),
    }


def report(template: str, table: dict[str, np.ndarray], repeats: int) -> str:
    """The page on the benchmark, with the goals of each case."""
    rows = [row | {"wanted": CASES[row["case"]]["wanted"]} for row in pd.DataFrame(table).to_dict("records")]

    def misses(row: dict) -> bool:
        return row["speed"] < row["wanted"]["speed"] or row["error"] > row["wanted"]["error"]

    values = {
        "rows": rows,
        "missed": [row for row in rows if row["chosen"] == "default" and misses(row)],
        "shorter": [{"name": name, **case} for name, case in CASES.items() if case["compared"] != DURATION],
        "repeats": repeats,
        "order": ORDER,
        "tolerance_of_truth": TRUTH["tolerance"],
    }
    return render(template, values)


def make(settings: dict, template: str, *, progress: str | None = None) -> dict:
    """The columns of the table, and the page from its template; `settings` are the arguments of `columns`."""
    columns_of_cases = columns(**settings, progress=progress)
    return {"benchmark": columns_of_cases, "report": report(template, columns_of_cases, settings["repeats"])}
