"""Whether a perturbation of the phase moves the impacts of a run, and what is left of it: the mechanism of Fig. 22."""

import math

import numpy as np

from conveyor import Run, conveyor_and_start, simulate
from conveyor.parameters import LAST
from conveyor.progress import progress_bar
from conveyor_pipeline.common import fields, grid

TABLES = {
    "moved_impacts": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.text("method", "euler, or event for the converged solution"),
        fields.number("step", "s", "time step of Euler; null for event"),
        fields.number("epsilon", "rad", "perturbation of the initial phase"),
        fields.number("time_shift", "s", "time by which the perturbation shifts the plate, ε/ω"),
        fields.number("time", "s", "time from the beginning of the run"),
        fields.number("difference", "m/s", "difference of the feeding velocities of both runs at that time"),
        fields.count("impacts", "impacts up to that time"),
        fields.count("moved", "impacts whose time is another one in the perturbed run; Euler: another step"),
        fields.number(
            "mean_shift",
            "1",
            "mean shift of the impacts of the last quarter of the run up to that time, in units of time_shift",
        ),
    ),
}
# Motions of period 1 in the first state, with short flights, below the onset of chaos. They start on the plate as in
# Fig. 22.
AMPLITUDES = (50.5, 53.0, 55.0, 57.0)  # m/s²
EPSILONS = (1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)  # rad; the first one is the perturbation of Fig. 22
STEPS = (5e-7, 2.5e-7, 5e-6)  # s; the first one is the paper's
DURATION = 1.0  # s
TIMES = np.linspace(0.0, DURATION, 51)[1:]  # s, ends of the excitation cycles of the paper
TOLERANCE = 1e-12  # of the converged solution: differences of 3e-11 s have to be exact


def impact_times(run: Run) -> np.ndarray:
    """Times of the impacts of a run (s), in order."""
    return run.events["time"][run.events["kind"] == "impact"]


def compare(run: Run, perturbed: Run, time_shift: float) -> list[dict]:
    """Differences between a run and its perturbed run up to each of TIMES; impacts are compared in their order.

    time_shift : time by which the perturbation shifts the plate, s
    """
    difference = np.abs(perturbed.sample(TIMES)["vx"] - run.sample(TIMES)["vx"])
    times, perturbed_times = impact_times(run), impact_times(perturbed)
    count = min(len(times), len(perturbed_times))
    # A larger phase is a later moment of the plate's motion, so that impacts come earlier. Impacts of a fixed-step
    # method have the times of its steps.
    earlier = times[:count] - perturbed_times[:count]
    resolution = 0.5 * run.step if run.method == "euler" else 0.0
    rows = []
    for time, apart in zip(TIMES, difference, strict=True):
        before = times[:count] <= time
        late = before & (times[:count] > (1.0 - LAST) * time)
        rows.append(
            {
                "time": time,
                "difference": apart,
                "impacts": int(before.sum()),
                "moved": int((np.abs(earlier[before]) > resolution).sum()),
                "mean_shift": float(earlier[late].mean() / time_shift) if late.any() else math.nan,
            }
        )
    return rows


def make(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table, for the model of the settings."""
    rows = []
    methods = [("event", math.nan), *(("euler", step) for step in STEPS)]
    runs = [(acceleration, *method) for acceleration in AMPLITUDES for method in methods]
    for acceleration, method, step in progress_bar(runs, label=progress, unit="runs"):
        row = grid.row_of(settings["model"] | {"acceleration": acceleration, "z0": "conveyor"})
        options = {"duration": DURATION, "method": method}
        options |= {"tolerance": TOLERANCE} if method == "event" else {"step": step}

        def follow(psi0, row=row, options=options):
            parameters = row.copy()
            parameters["psi0"] += psi0
            return simulate(*conveyor_and_start(parameters), **options)

        unperturbed = follow(0.0)
        for epsilon in EPSILONS:
            time_shift = epsilon / (2.0 * math.pi * float(row["frequency"]))
            case = {
                "acceleration": acceleration,
                "method": method,
                "step": step,
                "epsilon": epsilon,
                "time_shift": time_shift,
            }
            rows += [case | compared for compared in compare(unperturbed, follow(epsilon), time_shift)]
    return fields.columns(rows, TABLES["moved_impacts"])
