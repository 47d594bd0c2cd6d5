"""How far the paper's estimates carry.

The exponent by finite differences (Eq. 23) over perturbation, time and step, in motions whose exponent is known; the
dimension over the number of points of known sets and of phase portraits, and over the time of the run.
"""

import math

import numpy as np

from conveyor import (
    Dimension,
    box_dimension,
    conveyor_and_start,
    correlation_dimension,
    lyapunov_spectrum,
    periodic_orbit,
    simulate,
)
from conveyor.parameters import LAST
from conveyor.progress import progress_bar
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.paper.orbits.published_estimates import (
    INTERVAL,
    SETTLED_INTERVAL,
    THEILER,
    box_dimension_of_paper,
    finite_difference_exponent,
)
from conveyor_pipeline.paper.orbits.reference_sets import REFERENCE_DIMENSIONS

TABLES = {
    "stability_estimates": (
        fields.text("panel", "varied quantity: perturbation, time or step; or known set, samples or run time"),
        fields.text("case", "motion or set"),
        fields.text("estimator", "event or euler for exponents; boxes, boxes as in the paper, or correlation sum"),
        fields.number("epsilon", "rad or m", "perturbation of the phase or of the initial height; null for dimensions"),
        fields.number("duration", "s", "duration of the run; null for known sets and settled portraits"),
        fields.number("step", "s", "time step of Euler; null for dimensions"),
        fields.number("samples", "1", "number of points; null for exponents"),
        fields.number("value", "1/s or 1", "estimate: exponent in 1/s, or dimension"),
        fields.number("error", "1", "half-width of the 95 % interval; null for exponents"),
        fields.number("truth", "1/s or 1", "true value; null if it is unknown"),
        fields.number("bound", "1/s", "estimate for a separation as large as the signal's range; null for dimensions"),
    ),
}

# Values of the estimate of the exponent; each figure varies one of them. The perturbation is in rad or m.
USUAL = {"epsilon": 1e-8, "duration": 1.0, "step": 5e-7}
VARIED = {
    "perturbation": ("epsilon", (1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)),
    "time": ("duration", (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)),
    "step": ("step", (2e-7, 5e-7, 1e-6, 2e-6, 5e-6, 1e-5)),
}
# Periodic motion of period 2, and chaos.
CASES = {
    "orbit_phase": {"acceleration": 55.0, "z0": "conveyor", "perturb": "psi0", "output": "vx"},
    "orbit_height": {"acceleration": 55.0, "z0": 0.3e-3, "perturb": "z0", "output": "z"},
    "chaos_phase": {"acceleration": 80.0, "z0": "conveyor", "perturb": "psi0", "output": "vx"},
}
POINTS = (300, 1000, 3000, 10000, 30000, 100000)
CORRELATED = 30000  # largest number of points of a correlation sum, whose cost grows with the square
PORTRAITS = {"second": {"acceleration": 40.0, "z0": 0.3e-3}, "chaos": {"acceleration": 80.0, "z0": 0.0}}
BEGIN = 20.0  # s, first sample of a settled portrait
RUN_TIMES = (0.1, 0.2, 0.5, 1.0, 2.0, 4.0)  # s, from the beginning of the run: the paper's box counting, with Euler
SEED = 1
PERIODS, SETTLING = (1, 2, 4), 1000  # excitation cycles
# A periodic orbit is a closed curve; the dimension of the chaotic attractor is unknown.
CURVE = {"second": 1.0, "chaos": math.nan}
NONE = {"epsilon": math.nan, "duration": math.nan, "step": math.nan, "samples": math.nan, "bound": math.nan}


def parameters_of(case: dict, model: dict) -> np.ndarray:
    """The parameters of a case, shape (1,)."""
    return grid.row_of(model | {name: case[name] for name in ("acceleration", "z0")})[None]


def true_exponent(case: dict, parameters: np.ndarray, model: dict) -> float:
    """The true exponent (1/s) of a case.

    On a periodic orbit, a perturbation of the phase is a shift in time, which neither grows nor decays; any other
    perturbation follows the larger Floquet multiplier. In chaos, both follow the largest Lyapunov exponent.
    """
    orbit = periodic_orbit(parameters[0], period=PERIODS, transient=SETTLING)
    if orbit is None:
        return float(lyapunov_spectrum(parameters).lambda_1[0])
    if case["perturb"] == "psi0":
        return 0.0
    return math.log(abs(orbit.multipliers[0])) * model["frequency"] / orbit.period


def saturated_estimate(parameters: np.ndarray, output: str, epsilon: float, duration: float) -> float:
    """The estimate (1/s) of a pair whose separation has saturated at the range of the signal."""
    conveyor, start = conveyor_and_start(parameters[0])
    signal = simulate(conveyor, start, duration=duration).sample(np.linspace(0.0, duration, 5001))[output]
    return math.log(np.ptp(signal) / epsilon) * math.log(1.0 / (1.0 - LAST)) / (LAST * duration)


def exponent_rows(model: dict, progress: str | None) -> list[dict]:
    """The published estimate with its perturbation, its duration and its step varied one at a time."""
    varied = {panel: [USUAL | {name: value} for value in values] for panel, (name, values) in VARIED.items()}
    rows = []
    for name, case in CASES.items():
        table = parameters_of(case, model)
        truth = true_exponent(case, table, model)
        for panel, runs in varied.items():
            for run in progress_bar(runs, label=progress and f"{progress}: {name}, {panel}", unit="runs"):
                shifted = table.copy()
                shifted[case["perturb"]] += run["epsilon"]
                bound = saturated_estimate(table, case["output"], run["epsilon"], run["duration"])
                for method in ("event", "euler"):
                    (value,) = finite_difference_exponent(table, shifted, **run, output=case["output"], method=method)
                    estimated = run | {"value": float(value), "error": math.nan, "truth": truth, "bound": bound}
                    rows.append({**NONE, "panel": panel, "case": name, "estimator": method, **estimated})
    return rows


def portrait(parameters: np.ndarray, times: np.ndarray, method: str) -> np.ndarray:
    """Points (z_p in m, ż_p in m/s) of one trajectory, shape (len(times), 2)."""
    conveyor, start = conveyor_and_start(parameters)
    motion = simulate(conveyor, start, duration=times[-1], method=method).sample(times)
    return np.stack([motion["z"], motion["vz"]], axis=1)


def estimate_dimensions(points: np.ndarray, theiler: int) -> dict[str, Dimension]:
    """The dimension of points by all estimators; the correlation sum only of at most CORRELATED points."""
    estimated = {
        "boxes": box_dimension(points),
        "boxes, as in the paper": box_dimension_of_paper(points),
    }
    if len(points) <= CORRELATED:
        estimated["correlation sum"] = correlation_dimension(points, theiler)
    return estimated


def dimension_rows(model: dict, progress: str | None) -> list[dict]:
    """Dimensions of known sets and settled portraits over the number of points, published ones over the duration."""
    rows = []

    def add(panel, case, estimated, truth, **run):
        rows.extend(
            {**NONE, "panel": panel, "case": case, "estimator": name, "truth": truth, **run}
            | {"value": estimate.value, "error": estimate.error}
            for name, estimate in estimated.items()
        )

    for count in progress_bar(POINTS, label=progress and f"{progress}: points", unit="sizes"):
        rng = np.random.default_rng(SEED)
        for draw, truth in REFERENCE_DIMENSIONS.items():
            estimated = estimate_dimensions(draw(rng, count), 0)
            add("known set", draw.__name__, estimated, truth, samples=count)
        for name, case in PORTRAITS.items():
            times = BEGIN + SETTLED_INTERVAL / model["frequency"] * np.arange(count)
            points = portrait(parameters_of(case, model)[0], times, "event")
            estimated = estimate_dimensions(points, THEILER)
            add("samples", name, estimated, CURVE[name], samples=count)
    for name, case in PORTRAITS.items():
        for duration in RUN_TIMES:
            count = round(duration * model["frequency"] / INTERVAL) + 1
            times = np.linspace(0.0, duration, count)
            points = portrait(parameters_of(case, model)[0], times, "euler")
            estimated = {"boxes, as in the paper": box_dimension_of_paper(points)}
            add("run time", name, estimated, CURVE[name], samples=count, duration=duration)
    return rows


def make(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of estimates, for the model of the settings."""
    model = settings["model"]
    rows = exponent_rows(model, progress)
    rows += dimension_rows(model, progress)
    return fields.columns(rows, TABLES["stability_estimates"])
