"""The solver against the paper's method, both compiled, both through `simulate`, one thread.

In each round every case gets its turn: some runs of the solver, some that compute every step of a settled motion anew,
then one of Euler, so that whatever else the machine does slows all. The truth is an independent integration, scipy's
DOP853 from event to event.
"""

from time import perf_counter

import numpy as np
import pandas as pd

from conveyor.methods import peers
from conveyor.simulation import Run, simulate
from conveyor.solver.polynomial import ORDER
from conveyor.solver.progress import bar
from pipeline import fields, grid
from pipeline.templates import render

TABLES = {
    "benchmark": (
        fields.text("case", "name of the case"),
        fields.text("motion", "what the part does"),
        fields.text(
            "chosen", "which tolerance this is: default, or the loosest that keeps the error, chosen against the truth"
        ),
        fields.number("tolerance", "1", "relative error of a step"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height"),
        fields.number("duration", "s", "length of the timed runs"),
        fields.number("compared", "s", "length of the runs whose mean velocities are compared"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity, from an independent integration"),
        fields.number("error", "1", "relative error of the solver's mean velocity"),
        fields.number("euler_error", "1", "relative error of Euler's mean velocity"),
        fields.count("steps", "Taylor steps that a timed run computes"),
        fields.count("repeated_steps", "Taylor steps of a settled motion that it repeats"),
        fields.count("evaluations", "derivatives of the contact force in a timed run"),
        fields.count("events", "events of a timed run"),
        fields.count("euler_steps", "steps of Euler in a timed run"),
        fields.number("seconds", "s", "median wall time of the solver"),
        fields.number("seconds_without", "s", "the same if every step is computed"),
        fields.number("euler_seconds", "s", "median wall time of Euler"),
        fields.number("speed", "1", "wall time of Euler over that of the solver"),
        fields.number("speed_without", "1", "the same if every step is computed"),
        fields.count("repeats", "rounds of timed runs"),
    ),
}

TRUTH = {"integrator": "DOP853", "treatment": "modes", "tolerance": 1e-13, "max_evaluations": 10_000_000}
# Runs of the solver for each run of Euler.
RUNS = 20


def timed(case: dict, duration: float, method: str, reuse: bool = True) -> tuple[float, Run]:
    """Wall time (s) of a run and its mean velocity, and the run."""
    conveyor, start = grid.conveyor_and_start(case["model"])
    accuracy = {"tolerance": case["tolerance"], "step": case["step"], "reuse": reuse}
    begin = perf_counter()
    run = simulate(conveyor, start, duration=duration, method=method, **accuracy)
    run.mean_velocity()
    return perf_counter() - begin, run


def times(cases: list[dict], repeats: int, progress: str | None) -> np.ndarray:
    """Median wall times (s) of the solver, of the solver that repeats no step, and of Euler: shape (3, cases).

    A first round, which compiles, does not count.
    """
    spent = [[[], [], []] for _ in cases]
    for turn in bar(range(repeats + 1), label=progress, unit="rounds"):
        for case, (ours, without, theirs) in zip(cases, spent, strict=True):
            solver = [timed(case, case["duration"], "event")[0] for _ in range(RUNS)]
            anew = [timed(case, case["duration"], "event", reuse=False)[0] for _ in range(RUNS)]
            euler = timed(case, case["duration"], "euler")[0]
            if turn > 0:
                ours += solver
                without += anew
                theirs.append(euler)
    return np.array([[np.median(one) for one in case] for case in spent]).T


def at_each_tolerance(cases: dict[str, dict], default: float) -> list[dict]:
    """Every case at the default tolerance, then those again for which another one was chosen."""
    rows = []
    for name, case in cases.items():
        rows.append({**case, "case": name, "tolerance": default, "chosen": "default"})
        if "loosest" in case:
            rows.append({**case, "case": name, "tolerance": case["loosest"], "chosen": "loosest that keeps the error"})
    return rows


def columns(cases: dict[str, dict], tolerance: float, repeats: int, *, progress: str | None = None) -> dict:
    """The columns of the benchmark's table for cases by name, each resolved as an entry of the config."""
    rows = at_each_tolerance(cases, tolerance)
    runs = [timed(case, case["duration"], "event")[1] for case in rows]
    eulers = [timed(case, case["duration"], "euler")[1] for case in rows]
    truths = {
        name: peers.run(grid.packed(case["model"]), case["compared"], **TRUTH).mean_velocity
        for name, case in cases.items()
    }
    truth = np.array([truths[case["case"]] for case in rows])
    found = [timed(case, case["compared"], "event")[1].mean_velocity() for case in rows]
    euler = [timed(case, case["compared"], "euler")[1].mean_velocity() for case in rows]
    seconds, without, euler_seconds = times(rows, repeats, progress)
    return {
        **{name: np.array([case[name] for case in rows]) for name in ("case", "motion", "chosen", "tolerance")},
        **{name: np.array([case["model"][name] for case in rows]) for name in ("acceleration", "z0")},
        **{name: np.array([case[name] for case in rows]) for name in ("duration", "compared")},
        "mean_velocity": truth,
        "error": np.abs(np.array(found) / truth - 1.0),
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


def report(template: str, found: dict[str, np.ndarray], settings: dict) -> str:
    """The page on the benchmark, with what is wanted of each case."""
    cases = settings["cases"]
    rows = [row | {"wanted": cases[row["case"]]["wanted"]} for row in pd.DataFrame(found).to_dict("records")]

    def misses(row: dict) -> bool:
        return row["speed"] < row["wanted"]["speed"] or row["error"] > row["wanted"]["error"]

    values = {
        "rows": rows,
        "missed": [row for row in rows if row["chosen"] == "default" and misses(row)],
        "shorter": [{"name": name, **case} for name, case in cases.items() if case["compared"] != case["duration"]],
        "repeats": settings["repeats"],
        "order": ORDER,
        "tolerance_of_truth": TRUTH["tolerance"],
    }
    return render(template, values)


def make(settings: dict, template: str, *, progress: str | None = None) -> dict:
    """The columns of the table, and the page from its template, for cases, the default tolerance and the repeats."""
    found = columns(**settings, progress=progress)
    return {"benchmark": found, "report": report(template, found, settings)}
