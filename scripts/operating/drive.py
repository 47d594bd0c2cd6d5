"""Drive design: amplitude, frequency, angle and phase shift at which parts are fast, gently handled and cheap to drive.

NSGA-II (pymoo) searches the Pareto front of three objectives: the velocity that nearly all initial conditions reach,
the impact speed and the acceleration of the drive. A design must give one velocity to the required share of the initial
conditions, no chaos, at least the least useful velocity, at most the largest impact speed, and a displacement of the
drive within its limit. Because a drive keeps its amplitude only within a relative margin, all of this must hold in the
whole margin: the smallest velocity and the largest impact speed in it count.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd

from conveyor.solver.progress import bar
from operating.regimes import same
from operating.shares import brief_velocities, motions_of_conveyors, parameters_of, starts_of_box, velocities
from pipeline import fields, pareto
from pipeline.fields import AXES

SEARCHED = ("acceleration", "frequency", "angle", "phase_shift")
# Errors of the amplitude, as parts of the margin, at which the search follows a design, and at which it is checked.
SEARCH_ERRORS, CHECK_ERRORS = np.array([-1.0, 1.0]), np.array([-1.0, 0.0, 1.0])
FIRST_STARTS = 1  # initial conditions that reveal most designs with chaos, which cost most
TABLES = {
    "drive_front": (
        *(fields.number(name, AXES[name].metadata[b"unit"].decode(), "parameter of the design") for name in SEARCHED),
        fields.number("displacement", "m", "amplitude of the drive's displacement"),
        fields.number("velocity", "m/s", "smallest velocity, within the margin, that most initial conditions reach"),
        fields.number("impact_speed", "m/s", "largest speed of approach normal to the track within the margin"),
        fields.flag("checked", "whether full operating runs were made; the next columns are null without them"),
        fields.number("checked_velocity", "m/s", "mean over all initial conditions and errors of the amplitude"),
        fields.number("velocity_low", "m/s", "smallest velocity of any of these initial conditions"),
        fields.number("velocity_high", "m/s", "largest velocity of any of these initial conditions"),
        fields.number("impact_low", "m/s", "smallest impact speed of any of these initial conditions"),
        fields.number("impact_high", "m/s", "largest impact speed of any of these initial conditions"),
        fields.number("checked_share", "1", "least share, within the margin, that reaches one velocity"),
        fields.flag("confirmed", "whether the operating runs keep the constraints"),
        fields.flag("recommended", "whether it is one of the recommended settings"),
    ),
    "drive_generations": (
        fields.count("seed", "seed of the search"),
        fields.count("generation", "number of the generation, from 1"),
        fields.number("hypervolume", "1", "hypervolume of the front so far, relative to the front of all seeds"),
    ),
}


def designs_of(points: np.ndarray, bounds: dict) -> np.ndarray:
    """Designs, shape (k, 4), from points of the search, shape (k, 4).

    In place of the amplitude, points have the logarithm of its part normal to the track. The normal motion depends on
    this part and on the frequency only: two points with the same normal motion have offspring with this motion, too.
    """
    designs = points.copy()
    designs[:, 0] = np.exp(points[:, 0]) / np.maximum(np.sin(points[:, 2]), 1e-9)
    designs[:, 0] = designs[:, 0].clip(*bounds["acceleration"])
    return designs


def bounds_of_points(bounds: dict) -> np.ndarray:
    """Bounds of the search, shape (2, 4)."""
    ends = np.array([bounds[name] for name in SEARCHED]).T
    ends[:, 0] = np.log(np.maximum(ends[:, 0] * np.sin(ends[:, 2]), 1e-9))
    return ends


def displacement(designs: np.ndarray) -> np.ndarray:
    """Amplitude of the drive's displacement (m)."""
    return designs[:, 0] / (2.0 * np.pi * designs[:, 1]) ** 2


def rows_of_designs(designs: np.ndarray, starts: np.ndarray, model: dict) -> np.ndarray:
    """Packed parameters of designs, shape (k, 4), from each of some initial conditions, shape (k starts, 16)."""
    models = [model | dict(zip(SEARCHED[1:], design[1:], strict=True)) for design in designs]
    rows = [parameters_of(design[:1], starts, own) for design, own in zip(designs, models, strict=True)]
    return np.concatenate(rows)


def outcome_of_conveyor(
    velocity: np.ndarray, share: np.ndarray, impact: np.ndarray, is_chaos: np.ndarray, same_velocity: float
) -> dict[str, float]:
    """What the initial conditions of one conveyor reach: the `velocity` that most of them reach, with its share, its
    impact speed and the share of chaos; mean and extremes over all of them. NaN where a velocity is not known.

    velocity, share, impact, is_chaos : of each motion, shape (m,)
    """
    # Shares of the initial conditions that reach the velocity of each motion; an unknown velocity equals no other.
    shares = same(velocity[:, None], velocity, same_velocity) @ share
    most = shares.argmax()
    return {
        "velocity": velocity[most],
        "impact_speed": impact[most],
        "share": shares[most],
        "chaos": share[is_chaos].sum(),
        "mean": share @ velocity,
        "velocity_low": velocity.min(),
        "velocity_high": velocity.max(),
        "impact_low": impact.min(),
        "impact_high": impact.max(),
    }


# How outcomes at several amplitudes become one; all of these functions return NaN if one of the values is NaN.
OVERALL = dict.fromkeys(("velocity", "share", "velocity_low", "impact_low"), np.min)
OVERALL |= dict.fromkeys(("impact_speed", "chaos", "velocity_high", "impact_high"), np.max) | {"mean": np.mean}


def evaluate(
    designs: np.ndarray, settings: dict, errors: np.ndarray, *, measure: Callable = velocities, threads: int = 1
) -> pd.DataFrame:
    """The outcomes of designs, shape (k, 4): the worst within the margin, the mean over it, and its extremes.

    errors : of the amplitude, in parts of the margin
    measure : as in `motions_of_conveyors`
    """
    starts = starts_of_box(settings)
    varied = np.repeat(designs, len(errors), axis=0)
    varied[:, 0] *= np.tile(1.0 + settings["margin"] * errors, len(designs))
    rows = rows_of_designs(varied, starts, settings["model"])
    table = motions_of_conveyors(rows, len(starts), settings, measure=measure, threads=threads)
    columns = [table[name].to_numpy() for name in ("mean_velocity", "share", "impact_speed")]
    # Undecided motions count as chaos. Arrays take a tenth of the time of pandas' groups.
    columns.append(~table.state.isin(("first", "second")).to_numpy())
    first = np.flatnonzero(np.diff(table.conveyor)) + 1
    conveyors = zip(*(np.split(column, first) for column in columns), strict=True)
    each = [outcome_of_conveyor(*motions, settings["same_velocity"]) for motions in conveyors]
    columns = {name: np.array([one[name] for one in each]).reshape(len(designs), len(errors)) for name in OVERALL}
    outcome = {name: overall(columns[name], axis=1) for name, overall in OVERALL.items()}
    return pd.DataFrame(outcome | {"displacement": displacement(designs)})


def constraints(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """Positive where a constraint is violated, shape (k, 5)."""
    violations = [
        settings["share"] - outcome.share,
        outcome.chaos,
        1.0 - outcome.velocity / settings["velocity"],
        outcome.impact_speed / settings["impact_speed"] - 1.0,
        outcome.displacement / settings["displacement"] - 1.0,
    ]
    # A constraint on an unknown value counts as violated.
    return np.nan_to_num(np.column_stack(violations), nan=1.0)


def is_within(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """Whether designs keep all constraints."""
    return (constraints(outcome, settings) <= 0.0).all(axis=1)


def search_outcomes(designs: np.ndarray, settings: dict) -> tuple[np.ndarray, np.ndarray]:
    """Objectives, shape (k, 3), all to be minimised, and constraints, shape (k, 5), of designs of the search.

    Designs with too large a displacement are not followed, and designs that break a constraint with the first initial
    conditions are not followed from the remaining ones.
    """
    outcome = pd.DataFrame({"displacement": displacement(designs)}).reindex(columns=[*OVERALL, "displacement"])
    within = outcome.displacement.to_numpy() <= settings["displacement"]
    for starts in (FIRST_STARTS, settings["starts"]):
        if not within.any():
            break
        few = {**settings, "starts": starts}
        found = evaluate(designs[within], few, SEARCH_ERRORS, measure=brief_velocities)
        outcome.loc[within, found.columns] = found.to_numpy()
        within = is_within(outcome, settings)
    objectives = np.column_stack([-outcome.velocity, outcome.impact_speed, designs[:, 0]])
    return np.where(np.isnan(objectives), np.inf, objectives), constraints(outcome, settings)


def reference_point(settings: dict) -> np.ndarray:
    """The objectives of a worthless design: the reference point of the hypervolume."""
    return np.array([-settings["velocity"], settings["impact_speed"], settings["bounds"]["acceleration"][1]])


def search(settings: dict, seed: int, count: Callable[[], object]) -> pareto.Front:
    """The designs on the Pareto front of one seed, with their objectives: -velocity, impact speed and acceleration.

    count : called after each generation
    """
    bounds = bounds_of_points(settings["bounds"])

    def evaluate(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = search_outcomes(designs_of(points, settings["bounds"]), settings)
        count()
        return found

    # Many random designs find the narrow ranges with one velocity; the best ones go on.
    drawn = np.random.default_rng(seed).uniform(*bounds, (settings["drawn"], len(SEARCHED)))
    front = pareto.search(evaluate, drawn, bounds, reference_point(settings), settings, seed, constraints=5)
    return front._replace(points=designs_of(front.points, settings["bounds"]))


def spread(objectives: np.ndarray, count: int) -> np.ndarray:
    """Indices of at most `count` designs that differ as much as possible, first the best in the first objective.

    Each further design is the farthest from all previous ones, in units of the range of each objective, shape (k, 3).
    """
    if len(objectives) == 0:
        return np.empty(0, dtype=np.int64)
    scaled = objectives / np.maximum(np.ptp(objectives, axis=0), 1e-300)
    chosen = [int(scaled[:, 0].argmin())]
    distance = np.linalg.norm(scaled - scaled[chosen[0]], axis=1)
    while len(chosen) < min(count, len(objectives)):
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(scaled - scaled[chosen[-1]], axis=1))
    return np.array(chosen)


CHECKED = {
    **{"mean": "checked_velocity", "share": "checked_share"},
    **{name: name for name in ("velocity_low", "velocity_high", "impact_low", "impact_high")},
}


def check(front: pd.DataFrame, settings: dict, *, threads: int = 1) -> pd.DataFrame:
    """A front with full operating runs of some designs, and the recommended ones of the designs that they confirm."""
    front = front.assign(checked=False, confirmed=False, recommended=False, **dict.fromkeys(CHECKED.values(), np.nan))
    objectives = np.column_stack([-front.velocity, front.impact_speed, front.acceleration])
    chosen = spread(objectives, settings["checked"])
    if len(chosen) == 0:
        return front
    designs = front.loc[chosen, list(SEARCHED)].to_numpy()
    outcome = evaluate(designs, settings, CHECK_ERRORS, threads=threads)
    front.loc[chosen, "checked"] = True
    front.loc[chosen, list(CHECKED.values())] = outcome[list(CHECKED)].to_numpy()
    front.loc[chosen, "confirmed"] = is_within(outcome, settings)
    sure = np.flatnonzero(front.confirmed)
    front.loc[sure[spread(objectives[sure], settings["recommended"])], "recommended"] = True
    return front


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, pd.DataFrame]:
    """The tables of the front and of the generations."""
    # Designs with unsettled motions are refused, chaotic or not.
    few = {**settings, **settings["search"], "followed": 1, "exponents": False}
    # One thread for each seed: the designs of one generation are too few for several threads.
    total = len(settings["seeds"]) * settings["generations"]
    with bar(total=total, label=progress, unit="generations") as shown, ThreadPoolExecutor(threads) as pool:
        searches = {seed: pool.submit(search, few, seed, shown.update) for seed in settings["seeds"]}
    fronts = {seed: one.result() for seed, one in searches.items()}
    designs, objectives = pareto.best_of(
        np.vstack([front.points for front in fronts.values()]),
        np.vstack([front.objectives for front in fronts.values()]),
    )
    whole = pareto.hypervolume(objectives, reference_point(settings))
    front = pd.DataFrame(designs, columns=SEARCHED)
    front = front.assign(displacement=displacement(designs), velocity=-objectives[:, 0], impact_speed=objectives[:, 1])
    history = [
        {"seed": seed, "generation": number, "hypervolume": volume / whole if whole else 0.0}
        for seed, found in fronts.items()
        for number, volume in enumerate(found.volumes, start=1)
    ]
    return {"drive_front": check(front, settings, threads=threads), "drive_generations": pd.DataFrame(history)}
