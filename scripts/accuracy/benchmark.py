"""The solver against the paper's method, both compiled, both through `simulate`, one thread.

In each round every case gets its turn: some runs of the solver, some that compute every step of a settled motion anew,
then one of Euler, so that whatever else the machine does slows all. The truth is an independent integration, scipy's
DOP853 from event to event.
"""

from time import perf_counter

import numpy as np

from conveyor.methods import peers
from conveyor.simulation import Run, simulate
from conveyor.solver.model import Conveyor, Start, pack
from conveyor.solver.polynomial import ORDER
from conveyor.solver.progress import bar
from pipeline import fields

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

COLUMNS = {
    "Case": "{case}",
    "Motion": "{motion}",
    "â, m/s²": "{acceleration:g}",
    "z0, mm": "{height:g}",
    "Tolerance": "{tolerance:.0e} ({chosen})",
    "Taylor steps: computed, repeated": "{steps}, {repeated_steps}",
    "Events": "{events}",
    "Wall time, ms": "{ours:.3f}",
    "Euler, ms": "{theirs:.1f}",
    "Error of Euler": "{euler_error:.1e}",
    "Error (wanted)": "{error:.1e} (≤ {wanted_error:.0e})",
    "Speed against Euler (wanted, aim)": "{speed:.0f} (≥ {wanted_speed:g}, {wanted_aim:g})",
    "The same without repeated steps": "{speed_without:.0f}",
}


def part(settings: dict) -> tuple[Conveyor, Start]:
    """The conveyor and the start of a case."""
    model = dict(settings["model"])
    start = Start(model.pop("z0"), model.pop("vz0"))
    return Conveyor(**model), start


def timed(case: dict, duration: float, method: str, reuse: bool = True) -> tuple[float, Run]:
    """Wall time (s) of a run and its mean velocity, and the run."""
    conveyor, start = part(case)
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
        name: peers.run(pack(*part(case)), case["compared"], **TRUTH).mean_velocity for name, case in cases.items()
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


def report(found: dict[str, np.ndarray], cases: dict[str, dict], repeats: int) -> str:
    """The table in Markdown, with what is wanted of each case."""
    lines = [f"| {' | '.join(COLUMNS)} |", "|" + "---|" * len(COLUMNS)]
    missed = []
    for k, name in enumerate(found["case"]):
        row = {column: values[k] for column, values in found.items()}
        millis = {column: 1e3 * row[source] for column, source in (("height", "z0"), ("ours", "seconds"))}
        wanted = {f"wanted_{column}": value for column, value in cases[name]["wanted"].items()}
        millis["theirs"] = 1e3 * row["euler_seconds"]
        lines.append(f"| {' | '.join(cell.format(**row, **millis, **wanted) for cell in COLUMNS.values())} |")
        if row["chosen"] == "default" and (
            row["speed"] < wanted["wanted_speed"] or row["error"] > wanted["wanted_error"]
        ):
            missed.append(f"{name} ({row['speed']:.0f} of {wanted['wanted_speed']:g})")
    shorter = "".join(
        f" ({name}: of the first {case['compared']:g} s)"
        for name, case in cases.items()
        if case["compared"] != case["duration"]
    )
    verdict = (
        f"At the default tolerance these miss what is wanted: {', '.join(missed)}."
        if missed
        else ("At the default tolerance every case is as fast and as accurate as wanted.")
    )
    return (
        "# The solver against the paper's method\n\n"
        "Both through `simulate(…)` and `mean_velocity()`, without samples, on one thread; median wall times of "
        f"{repeats} rounds in which the methods alternate. Errors are relative, of the mean feeding velocity over the "
        f"last quarter{shorter}, against scipy's DOP853 from event to event at tolerance {TRUTH['tolerance']:g}. A "
        f"Taylor step of the solver finds {ORDER} derivatives of the contact force; once the vertical motion repeats "
        "itself, its steps are repeated instead of computed, which the last column does without. A tolerance marked as "
        "the loosest that keeps the error was chosen against the truth.\n\n" + "\n".join(lines) + f"\n\n{verdict}\n"
    )


def make(settings: dict, *, progress: str | None = None) -> dict:
    """The columns of the table and the report for the resolved cases, the default tolerance and the repeats."""
    found = columns(**settings, progress=progress)
    return {"benchmark": found, "report": report(found, settings["cases"], settings["repeats"])}
