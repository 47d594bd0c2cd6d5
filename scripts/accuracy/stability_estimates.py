"""How far the paper's estimates carry.

The exponent by finite differences (Eq. 23) over perturbation, time and step, in motions whose exponent is known; the
dimension over the number of points of known sets and of phase portraits, and over the time of the run.
"""

import math

import numpy as np

from conveyor.analysis import stroboscopic_map
from conveyor.analysis.bifurcations import periodic_orbits
from conveyor.analysis.chaos import lyapunov
from conveyor.analysis.fractals import box_counting, correlation_sum
from conveyor.analysis.fractals.reference_sets import DIMENSIONS
from conveyor.analysis.fractals.scaling_region import Dimension
from conveyor.simulation import DEFAULT_TOLERANCE, simulate
from conveyor.solver.model import PARAMETERS, unpack
from conveyor.solver.progress import bar
from pipeline import fields, grid

TABLES = {
    "stability_estimates": (
        fields.text("panel", "what is varied: perturbation, time or step; known set, samples or run time"),
        fields.text("case", "motion or set"),
        fields.text("estimator", "event or euler for exponents; boxes, boxes as in the paper, or correlation sum"),
        fields.number("epsilon", "rad or m", "perturbation of the phase or of the initial height; null for dimensions"),
        fields.number("duration", "s", "time of the run; null for points of known sets and settled portraits"),
        fields.number("step", "s", "step of Euler; null for dimensions"),
        fields.number("samples", "1", "number of points; null for exponents"),
        fields.number("value", "1/s or 1", "the estimate: an exponent in 1/s, or a dimension"),
        fields.number("error", "1", "half-width of its 95 % interval; null for exponents"),
        fields.number("truth", "1/s or 1", "what it should be; null where nobody knows"),
        fields.number(
            "bound", "1/s", "estimate of a pair that is as far apart as the signal goes; null for dimensions"
        ),
    ),
}

LAST, SAMPLES = 0.25, 501  # of a run, as in Fig. 22
PERIODS, SETTLING = (1, 2, 4), 1000  # excitation cycles
# A settled orbit is a closed curve; the dimension of the chaotic attractor nobody knows.
CURVE = {"second": 1.0, "chaos": math.nan}
NONE = {"epsilon": math.nan, "duration": math.nan, "step": math.nan, "samples": math.nan, "bound": math.nan}


def parameters_of(case: dict, model: dict) -> np.ndarray:
    """Parameter vector of one motion, shape (1, 16)."""
    return grid.packed(model | {name: case[name] for name in ("acceleration", "z0")})[None]


def exponent_in_truth(case: dict, parameters: np.ndarray, model: dict) -> float:
    """The exponent (1/s) that the estimate of a case should find.

    A shift of the phase is a shift in time and neither grows nor dies on an orbit; another perturbation follows the
    larger Floquet multiplier there, and both the larger Lyapunov exponent in chaos.
    """
    state = stroboscopic_map.initial_states(parameters, DEFAULT_TOLERANCE)[0]
    orbit, _ = periodic_orbits.settled_orbit(parameters[0], case["acceleration"], state, PERIODS, SETTLING)
    if orbit is None:
        return float(lyapunov.spectrum(parameters, state[None]).lambda_1[0])
    if case["perturb"] == "psi0":
        return 0.0
    return math.log(abs(orbit.multipliers[0])) * model["frequency"] / orbit.period


def largest_estimate(parameters: np.ndarray, output: str, epsilon: float, duration: float) -> float:
    """The estimate (1/s) of a pair that is as far apart as the signal goes."""
    conveyor, start = unpack(parameters[0])
    signal = simulate(conveyor, start, duration=duration).sample(np.linspace(0.0, duration, 5001))[output]
    return math.log(np.ptp(signal) / epsilon) * math.log(1.0 / (1.0 - LAST)) / (LAST * duration)


def exponent_rows(settings: dict, model: dict, progress: str | None) -> list[dict]:
    """The paper's estimate with its perturbation, its time and its step varied one by one."""
    usual = {name: settings[name] for name in ("epsilon", "duration", "step")}
    varied = {
        "perturbation": [usual | {"epsilon": value} for value in settings["epsilons"]],
        "time": [usual | {"duration": value} for value in settings["durations"]],
        "step": [usual | {"step": value} for value in settings["steps"]],
    }
    rows = []
    for name, case in settings["cases"].items():
        here = parameters_of(case, model)
        truth = exponent_in_truth(case, here, model)
        for panel, runs in varied.items():
            for run in bar(runs, label=progress and f"{progress}: {name}, {panel}", unit="runs"):
                there = here.copy()
                there[:, PARAMETERS.index(case["perturb"])] += run["epsilon"]
                bound = largest_estimate(here, case["output"], run["epsilon"], run["duration"])
                for method in ("event", "euler"):
                    value = lyapunov.finite_difference_estimate(
                        here, there, **run, output=case["output"], last=LAST, samples=SAMPLES, method=method
                    )[0]
                    found = run | {"value": float(value), "error": math.nan, "truth": truth, "bound": bound}
                    rows.append({**NONE, "panel": panel, "case": name, "estimator": method, **found})
    return rows


def portrait(parameters: np.ndarray, times: np.ndarray, method: str) -> np.ndarray:
    """Points (z_p in m, ż_p in m/s) of one trajectory, shape (len(times), 2)."""
    conveyor, start = unpack(parameters)
    motion = simulate(conveyor, start, duration=times[-1], method=method).sample(times)
    return np.stack([motion["z"], motion["vz"]], axis=1)


def as_in_the_paper(points: np.ndarray, settings: dict) -> Dimension:
    """The dimension as the paper counts boxes."""
    return box_counting.box_dimension_of_paper(points, 0.5 ** np.arange(1, settings["octaves"] + 1))


def estimates(points: np.ndarray, theiler: int, settings: dict) -> dict[str, Dimension]:
    """The dimension of points by all ways that can bear their number."""
    found = {"boxes": box_counting.box_dimension(points), "boxes, as in the paper": as_in_the_paper(points, settings)}
    if len(points) <= settings["correlated"]:
        found["correlation sum"] = correlation_sum.correlation_dimension(points, theiler)
    return found


def dimension_rows(settings: dict, model: dict, seed: int, progress: str | None) -> list[dict]:
    """Dimensions of known sets and of settled portraits over the number of points, the paper's over the time."""
    rows = []

    def add(panel, case, found, truth, **run):
        rows.extend(
            {**NONE, "panel": panel, "case": case, "estimator": name, "truth": truth, **run}
            | {"value": one.value, "error": one.error}
            for name, one in found.items()
        )

    for count in bar(settings["samples"], label=progress and f"{progress}: points", unit="sizes"):
        rng = np.random.default_rng(seed)
        for draw, truth in DIMENSIONS.items():
            add("known set", draw.__name__, estimates(draw(rng, count), 0, settings), truth, samples=count)
        for name, case in settings["portraits"].items():
            times = settings["begin"] + settings["interval"] / model["frequency"] * np.arange(count)
            points = portrait(parameters_of(case, model)[0], times, "event")
            add("samples", name, estimates(points, settings["theiler"], settings), CURVE[name], samples=count)
    for name, case in settings["portraits"].items():
        for duration in settings["durations"]:
            count = round(duration * model["frequency"] / settings["paper_interval"]) + 1
            times = np.linspace(0.0, duration, count)
            points = portrait(parameters_of(case, model)[0], times, "euler")
            found = {"boxes, as in the paper": as_in_the_paper(points, settings)}
            add("run time", name, found, CURVE[name], samples=count, duration=duration)
    return rows


def make(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of estimates, from the section of the config of that name with the model."""
    model = settings["model"]
    rows = exponent_rows(settings["exponent"], model, progress)
    rows += dimension_rows(settings["dimension"], model, settings["seed"], progress)
    return fields.columns(rows, TABLES["stability_estimates"])
