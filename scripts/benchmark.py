"""Rule benchmark: the solver against the paper's method, both compiled, both through `simulate`, one thread.

In each round every case gets its turn: some runs of the solver, then one of Euler, so that whatever else the machine
does slows both. The truth is an independent integration, scipy's DOP853 from event to event.
"""

import sys
from time import perf_counter

import numpy as np
from tqdm import tqdm

from conveyor import peers, tables
from conveyor.model import Conveyor, Start, pack
from conveyor.polynomial import ORDER
from conveyor.simulation import Run, simulate
from rule_log import logged

TRUTH = {"integrator": "DOP853", "treatment": "modes", "tolerance": 1e-13, "max_evaluations": 10_000_000}
# Runs of the solver for each run of Euler.
RUNS = 20

HEAD = (
    "| Case | Motion | â, m/s² | z0, mm | Run, s | Taylor steps | Events | Wall time, ms | Euler, ms | Error of Euler "
    "| Error (wanted) | Speed against Euler (wanted, aim) |"
)
ROW = (
    "| {case} | {motion} | {acceleration:g} | {height:g} | {duration:g} | {steps} | {events} | {ours:.3f} "
    "| {theirs:.1f} | {euler_error:.1e} | {error:.1e} (≤ {wanted_error:.0e}) "
    "| {speed:.0f} (≥ {wanted_speed:g}, {wanted_aim:g}) |"
)


def part(settings: dict) -> tuple[Conveyor, Start]:
    """The conveyor and the start of a case."""
    model = dict(settings["model"])
    start = Start(model.pop("z0"), model.pop("vz0"))
    return Conveyor(**model), start


def timed(case: dict, duration: float, method: str) -> tuple[float, Run]:
    """Wall time (s) of a run and its mean velocity, and the run."""
    conveyor, start = part(case)
    begin = perf_counter()
    run = simulate(conveyor, start, duration=duration, method=method, tolerance=case["tolerance"], step=case["step"])
    run.mean_velocity()
    return perf_counter() - begin, run


def times(cases: dict[str, dict], repeats: int, progress: str | None) -> tuple[np.ndarray, np.ndarray]:
    """Median wall times (s) of the solver and of Euler, shape of `cases`; a first round, which compiles, apart."""
    ours: dict[str, list[float]] = {name: [] for name in cases}
    theirs: dict[str, list[float]] = {name: [] for name in cases}
    for turn in tqdm(range(repeats + 1), desc=progress, unit="round", disable=progress is None, file=sys.stderr):
        for name, case in cases.items():
            solver = [timed(case, case["duration"], "event")[0] for _ in range(RUNS)]
            euler = timed(case, case["duration"], "euler")[0]
            if turn > 0:
                ours[name] += solver
                theirs[name].append(euler)
    return np.array([np.median(spent) for spent in ours.values()]), np.array([np.median(s) for s in theirs.values()])


def columns(cases: dict[str, dict], repeats: int, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the benchmark's table for cases by name, each resolved as an entry of the config."""
    runs = [timed(case, case["duration"], "event")[1] for case in cases.values()]
    eulers = [timed(case, case["duration"], "euler")[1] for case in cases.values()]
    truths = [peers.run(pack(*part(case)), case["compared"], **TRUTH).mean_velocity for case in cases.values()]
    found = [timed(case, case["compared"], "event")[1].mean_velocity() for case in cases.values()]
    euler = [timed(case, case["compared"], "euler")[1].mean_velocity() for case in cases.values()]
    seconds, euler_seconds = times(cases, repeats, progress)
    truth = np.array(truths)
    return {
        "case": np.array(list(cases)),
        "motion": np.array([case["motion"] for case in cases.values()]),
        **{name: np.array([case["model"][name] for case in cases.values()]) for name in ("acceleration", "z0")},
        **{name: np.array([case[name] for case in cases.values()]) for name in ("duration", "compared")},
        "mean_velocity": truth,
        "error": np.abs(np.array(found) / truth - 1.0),
        "euler_error": np.abs(np.array(euler) / truth - 1.0),
        "steps": np.array([run.work for run in runs]),
        "evaluations": np.array([run.work * ORDER for run in runs]),
        "events": np.array([run.event_count for run in runs]),
        "euler_steps": np.array([run.work for run in eulers]),
        "seconds": seconds,
        "euler_seconds": euler_seconds,
        "speed": euler_seconds / seconds,
        "repeats": np.full(len(cases), repeats),
    }


def report(found: dict[str, np.ndarray], cases: dict[str, dict], repeats: int) -> str:
    """The table in Markdown, with what is wanted of each case."""
    lines = [HEAD, "|" + "---|" * HEAD.count(" | ") + "---|"]
    for k, case in enumerate(cases.values()):
        row = {name: values[k] for name, values in found.items()}
        millis = {name: 1e3 * row[source] for name, source in (("height", "z0"), ("ours", "seconds"))}
        wanted = {f"wanted_{name}": value for name, value in case["wanted"].items()}
        lines.append(ROW.format(**row, **millis, theirs=1e3 * row["euler_seconds"], **wanted))
    return (
        "# The solver against the paper's method\n\n"
        "Both through `simulate(…)` and `mean_velocity()`, without samples, on one thread; median wall times of "
        f"{repeats} rounds in which the methods alternate. Errors are relative, of the mean feeding velocity over the "
        "last quarter"
        + "".join(
            f" ({name}: of the first {case['compared']:g} s)"
            for name, case in cases.items()
            if case["compared"] != case["duration"]
        )
        + ", against scipy's DOP853 from event to event at tolerance "
        f"{TRUTH['tolerance']:g}. A Taylor step of the solver finds {ORDER} derivatives of the contact force.\n\n"
        + "\n".join(lines)
        + "\n"
    )


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        cases, repeats = snakemake.params.cases, snakemake.params.repeats
        found = columns(cases, repeats, progress="benchmark")
        tables.write(snakemake.output.table, "benchmark", found, settings={"cases": cases, "repeats": repeats})
        text = report(found, cases, repeats)
        print(text)
        with open(snakemake.output.report, "w", encoding="utf-8") as file:
            file.write(text)
