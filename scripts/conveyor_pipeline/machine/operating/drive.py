"""Drive design: amplitude, frequency, angle and phase shift at which parts are fast, gently handled and cheap to drive.

NSGA-II (pymoo) searches the Pareto front of three objectives: the 5 % quantile of the transit velocity, the impact
speed, and the peak acceleration of the drive. At most a small share of the parts may move back. The velocity must be
useful, and the impact speed and the displacement of the drive must keep their limits. Because a drive keeps its
amplitude only within a relative margin, the worst numbers within the margin count. The parts are the varied ones of the
transit table.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd

from conveyor import UNITS, Columns, parameter_table, replace_parameters
from conveyor.elementary import exp, log, sin
from conveyor.linear_algebra import length
from conveyor.packing import plate_peaks
from conveyor.progress import progress_bar
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.machine.operating import pareto
from conveyor_pipeline.machine.operating.parts import population
from conveyor_pipeline.machine.operating.transit import follow, summarize_populations

# Random designs of the first generation, in units of the population, because few of them meet all constraints.
DRAWN = 8
# Relative growth of the hypervolume in the last quarter of the generations up to which a search has settled.
SETTLED = 0.02
SEEDS = (1, 2)  # two searches; each must find nearly the front of both
MOST_CHECKED = 20  # designs with the transit of all parts, chosen to differ as much as possible
RECOMMENDED = 5  # of the confirmed designs
SEARCHED = ("acceleration", "frequency", "angle", "phase_shift")
# Errors of the amplitude, as parts of the margin, at which the search follows a design, and at which it is checked.
SEARCH_ERRORS, CHECK_ERRORS = np.array([-1.0, 1.0]), np.array([-1.0, 0.0, 1.0])
# The worst measures of a design within the margin: name, measure of transit, and which value is the worst one.
WORST = {
    "velocity": ("velocity_05", np.min),
    "impact_speed": ("impact_speed", np.max),
    "back": ("back", np.max),
    "late": ("late", np.max),
    "failed": ("failed", np.max),
    "velocity_50": ("velocity_50", np.min),
    "velocity_95": ("velocity_95", np.max),
}
CHECKED = ("velocity", "velocity_50", "velocity_95", "impact_speed", "back", "late")
RESULTANT = ", the root of the sum of squares of its largest values along the track and normal to it"
TABLES = {
    "drive_front": (
        *(fields.number(name, UNITS[name], "parameter of the design") for name in SEARCHED),
        fields.number("peak_acceleration", "m/s²", f"acceleration of the plate{RESULTANT}; â without harmonics"),
        fields.number("displacement", "m", f"displacement of the plate{RESULTANT}; â/ω² without harmonics"),
        fields.number("velocity", "m/s", "smallest 5 % quantile of the velocity within the margin, in the search"),
        fields.number("impact_speed", "m/s", "largest 95 % quantile of the impact speed within the margin"),
        fields.flag("checked", "whether all parts were followed along the track; the next columns are null otherwise"),
        fields.number("checked_velocity", "m/s", "smallest 5 % quantile of the transit velocity within the margin"),
        fields.number("checked_velocity_50", "m/s", "smallest median of the transit velocity within the margin"),
        fields.number("checked_velocity_95", "m/s", "largest 95 % quantile of the transit velocity within the margin"),
        fields.number("checked_impact_speed", "m/s", "largest 95 % quantile of the impact speed within the margin"),
        fields.number("checked_back", "1", "largest share of the parts that have moved back"),
        fields.number("checked_late", "1", "largest share of the parts that are late"),
        fields.flag("confirmed", "whether these numbers keep the constraints"),
        fields.flag("recommended", "whether it is one of the recommended settings"),
    ),
    "drive_generations": (
        fields.count("seed", "seed of the search"),
        fields.count("generation", "number of the generation, from 1"),
        fields.number("hypervolume", "1", "hypervolume of the front so far, relative to the front of all seeds"),
    ),
}


def designs_of(points: np.ndarray, bounds: dict) -> np.ndarray:
    """Designs, shape (k, 4), from points of the search of the same shape.

    In place of the amplitude, points have the logarithm of its part normal to the track. The normal motion depends on
    this part and on the frequency only: two points with the same normal motion have offspring with this motion, too.
    """
    designs = points.copy()
    designs[:, 0] = exp(points[:, 0]) / np.maximum(sin(points[:, 2]), 1e-9)
    designs[:, 0] = designs[:, 0].clip(*bounds["acceleration"])
    return designs


def bounds_of_points(bounds: dict) -> np.ndarray:
    """Bounds of the search, shape (2, 4)."""
    ends = np.array([bounds[name] for name in SEARCHED]).T
    ends[:, 0] = log(np.maximum(ends[:, 0] * sin(ends[:, 2]), 1e-9))
    return ends


def peaks_of(designs: np.ndarray, model: dict) -> Columns:
    """What `plate_peaks` returns for designs, shape (k, 4), with the harmonics of the model."""
    conveyor, _ = grid.conveyor_and_start(model)
    table = np.full(len(designs), parameter_table(conveyor))
    return plate_peaks(replace_parameters(table, **dict(zip(SEARCHED, designs.T, strict=True))))


def model_of(design: np.ndarray, model: dict) -> dict:
    """The model on a drive."""
    return model | dict(zip(SEARCHED[1:], design[1:], strict=True))


def evaluate(designs: np.ndarray, settings: dict, errors: np.ndarray, *, threads: int = 1) -> pd.DataFrame:
    """The worst measures within the margin of designs, shape (k, 4), and their displacements.

    errors : of the amplitude, in parts of the margin
    """
    rows = []
    for design in designs:
        design_settings = {**settings, "model": model_of(design, settings["model"])}
        rows.append(population(design[0] * (1.0 + settings["margin"] * errors), design_settings))
    run = follow(np.concatenate(rows), settings, threads=threads)
    measures = summarize_populations(run, settings["starts"])
    outcome = {
        name: worst(measures[measure].to_numpy(dtype=float).reshape(len(designs), len(errors)), axis=1)
        for name, (measure, worst) in WORST.items()
    }
    return pd.DataFrame(outcome | {"displacement": peaks_of(designs, settings["model"]).displacement})


def constraints(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """Positive where a constraint is violated, shape (k, 5)."""
    violations = [
        outcome.back - settings["back"],
        outcome.failed,
        1.0 - outcome.velocity / settings["velocity"],
        outcome.impact_speed / settings["impact_speed"] - 1.0,
        outcome.displacement / settings["displacement"] - 1.0,
    ]
    # A constraint on an unknown value counts as violated.
    return np.nan_to_num(np.column_stack(violations), nan=1.0)


def is_within(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """Whether designs keep all constraints."""
    return (constraints(outcome, settings) <= 0.0).all(axis=1)


def evaluate_few(designs: np.ndarray, settings: dict) -> pd.DataFrame:
    """What `evaluate` returns for the few parts and the short time of a search."""
    search_settings = {**settings, "starts": settings["search"]["parts"], "longest": settings["search"]["longest"]}
    return evaluate(designs, search_settings, SEARCH_ERRORS)


def search_outcomes(designs: np.ndarray, settings: dict) -> tuple[np.ndarray, np.ndarray]:
    """Objectives, shape (k, 3), all to be minimised, and constraints, shape (k, 5), of designs of the search.

    Designs with too large a displacement are not followed.
    """
    peaks = peaks_of(designs, settings["model"])
    outcome = pd.DataFrame({"displacement": peaks.displacement}).reindex(columns=[*WORST, "displacement"])
    within = outcome.displacement.to_numpy() <= settings["displacement"]
    if within.any():
        outcomes = evaluate_few(designs[within], settings)
        outcome.loc[within, outcomes.columns] = outcomes.to_numpy()
    objectives = objectives_of(outcome, peaks.acceleration)
    return np.where(np.isnan(objectives), np.inf, objectives), constraints(outcome, settings)


def last_growth(values: Sequence[float]) -> float:
    """Relative growth in the last quarter of the generations, from a value for each of them; inf from zero."""
    earlier = values[3 * len(values) // 4 - 1]
    return values[-1] / earlier - 1.0 if earlier > 0.0 else np.inf


def reference_point(settings: dict) -> np.ndarray:
    """The objectives of a worthless design: the reference point of the hypervolume."""
    return np.array([-settings["velocity"], settings["impact_speed"], settings["bounds"]["acceleration"][1]])


def search(settings: dict, seed: int, count: Callable[[], object]) -> pareto.Front:
    """The designs on the Pareto front of one seed, with their objectives: -velocity, impact speed and acceleration.

    count : called after each generation
    """
    bounds = bounds_of_points(settings["bounds"])

    def evaluate_points(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        outcomes = search_outcomes(designs_of(points, settings["bounds"]), settings)
        count()
        return outcomes

    drawn = np.random.default_rng(seed).uniform(*bounds, (DRAWN * settings["population"], bounds.shape[1]))
    front = pareto.search(evaluate_points, drawn, bounds, reference_point(settings), settings, seed, constraints=5)
    return front._replace(points=designs_of(front.points, settings["bounds"]))


def spread(objectives: np.ndarray, count: int) -> np.ndarray:
    """Indices of at most `count` designs that differ as much as possible, first the best in the first objective.

    Each further design is the farthest from all previous ones, in units of the range of each objective, shape (k, 3).
    """
    if len(objectives) == 0:
        return np.empty(0, dtype=np.int64)
    scaled = objectives / np.maximum(np.ptp(objectives, axis=0), 1e-300)
    chosen = [int(scaled[:, 0].argmin())]
    distance = length(scaled - scaled[chosen[0]])
    while len(chosen) < min(count, len(objectives)):
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, length(scaled - scaled[chosen[-1]]))
    return np.array(chosen)


def objectives_of(outcome: pd.DataFrame, acceleration: pd.Series) -> np.ndarray:
    """The objectives of designs, shape (k, 3), all to be minimised."""
    return np.column_stack([-outcome.velocity, outcome.impact_speed, acceleration])


def check(front: pd.DataFrame, settings: dict, *, threads: int = 1) -> pd.DataFrame:
    """A front with the transit of all parts for some designs, and the recommended ones among confirmed designs."""
    unknown = dict.fromkeys((f"checked_{name}" for name in CHECKED), np.nan)
    front = front.assign(checked=False, confirmed=False, recommended=False, **unknown)
    chosen = spread(objectives_of(front, front.peak_acceleration), MOST_CHECKED)
    if len(chosen) == 0:
        return front
    designs = front.loc[chosen, list(SEARCHED)].to_numpy()
    outcome = evaluate(designs, settings, CHECK_ERRORS, threads=threads)
    outcome.index = chosen
    front.loc[chosen, "checked"] = True
    front.loc[chosen, list(unknown)] = outcome[list(CHECKED)].to_numpy()
    is_confirmed = is_within(outcome, settings)
    front.loc[chosen, "confirmed"] = is_confirmed
    sure = outcome[is_confirmed]
    best = spread(objectives_of(sure, front.peak_acceleration[sure.index]), RECOMMENDED)
    front.loc[sure.index[best], "recommended"] = True
    return front


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, pd.DataFrame]:
    """The tables of the front and of the generations."""
    # One thread for each seed: the designs of one generation are too few for several threads.
    total = len(SEEDS) * settings["generations"]
    with progress_bar(total=total, label=progress, unit="generations") as shown, ThreadPoolExecutor(threads) as pool:
        searches = {seed: pool.submit(search, settings, seed, shown.update) for seed in SEEDS}
    fronts = {seed: future.result() for seed, future in searches.items()}
    designs, objectives = pareto.best_of(
        np.vstack([front.points for front in fronts.values()]),
        np.vstack([front.objectives for front in fronts.values()]),
    )
    whole = pareto.hypervolume(objectives, reference_point(settings))
    peaks = peaks_of(designs, settings["model"])
    front = pd.DataFrame(designs, columns=SEARCHED).assign(
        peak_acceleration=peaks.acceleration,
        displacement=peaks.displacement,
        velocity=-objectives[:, 0],
        impact_speed=objectives[:, 1],
    )
    history = [
        {"seed": seed, "generation": number, "hypervolume": volume / whole if whole else 0.0}
        for seed, front in fronts.items()
        for number, volume in enumerate(front.volumes, start=1)
    ]
    return {"drive_front": check(front, settings, threads=threads), "drive_generations": pd.DataFrame(history)}
