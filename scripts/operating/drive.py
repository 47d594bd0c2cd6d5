"""Drive design: amplitude, frequency, angle and phase shift at which parts are fast, gently handled and cheap to drive.

NSGA-II (pymoo) searches the Pareto front of three objectives: the velocity that nearly all initial conditions reach,
the impact speed and the acceleration of the drive. A design must give one velocity (to a wanted share of the initial
conditions), no chaos, no feeding backwards, and a displacement of the drive within its limit.
"""

import numpy as np
import pandas as pd
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.callback import Callback
from pymoo.core.problem import Problem
from pymoo.indicators.hv import HV
from pymoo.optimize import minimize
from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting

from conveyor import ensemble
from conveyor.analysis.attractors.labels import Labels
from operating.regimes import same
from operating.shares import continue_settled, motions_of_conveyors, parameters_of, starts_of_box
from pipeline import fields
from pipeline.fields import AXES

SEARCHED = ("acceleration", "frequency", "angle", "phase_shift")
OUTCOMES = ("velocity", "impact_speed", "share", "chaos", "displacement")
TABLES = {
    "drive_front": (
        *(fields.number(name, AXES[name].metadata[b"unit"].decode(), "of the design") for name in SEARCHED),
        fields.number("displacement", "m", "amplitude of the drive's displacement"),
        fields.number("velocity", "m/s", "velocity of the motion that most initial conditions of the search reach"),
        fields.number("impact_speed", "m/s", "largest speed of approach normal to the track in a period"),
        fields.flag("checked", "whether a full operating run was made; the next columns are null without it"),
        fields.number("checked_velocity", "m/s", "mean over all initial conditions of the operating run"),
        fields.number("velocity_stderr", "m/s", "its standard error over the initial conditions"),
        fields.number("checked_share", "1", "share that reaches the velocity that most of them reach"),
        fields.flag("confirmed", "whether the operating run keeps the constraints"),
        fields.flag("recommended", "whether it is one of the recommended settings"),
    ),
    "drive_generations": (
        fields.count("seed", "of the search"),
        fields.count("generation", "from 1"),
        fields.number("hypervolume", "1", "of the front so far, relative to the front of all seeds"),
    ),
}


def rows_of_designs(designs: np.ndarray, starts: np.ndarray, model: dict) -> np.ndarray:
    """Packed parameters of designs, shape (k, 4), from each of some initial conditions, shape (k starts, 16)."""
    models = [model | dict(zip(SEARCHED[1:], design[1:], strict=True)) for design in designs]
    rows = [parameters_of(design[:1], starts, own) for design, own in zip(designs, models, strict=True)]
    return np.concatenate(rows)


def guaranteed(motions: pd.DataFrame, same_velocity: float) -> tuple[int, float]:
    """Row of the motion whose velocity most initial conditions get, and their share; chaos counts only if alone."""
    known = motions[motions.mean_velocity.notna()]
    if known.empty:
        return -1, 0.0
    shares = [
        known.share[same(known.mean_velocity.to_numpy(), one, same_velocity)].sum() for one in known.mean_velocity
    ]
    return int(known.index[np.argmax(shares)]), float(max(shares))


def evaluate(designs: np.ndarray, settings: dict, *, threads: int = 1) -> pd.DataFrame:
    """The OUTCOMES of designs, shape (k, 4), besides the mean over all initial conditions and its standard error."""
    starts = starts_of_box(settings)
    rows = rows_of_designs(designs, starts, settings["model"])
    table = motions_of_conveyors(rows, len(starts), settings, threads=threads)
    found = []
    for _, motions in table.groupby("conveyor"):
        most, share = guaranteed(motions, settings["same_velocity"])
        mean = (motions.share * motions.mean_velocity).sum(skipna=False)
        variance = (motions.share * (motions.mean_velocity - mean) ** 2).sum(skipna=False)
        chaos = motions.share[~motions.state.isin(("first", "second"))].sum()
        found.append((most, share, chaos, mean, np.sqrt(variance / len(starts))))
    columns = ("most", "share", "chaos", "mean", "stderr")
    outcome = pd.DataFrame(dict(zip(columns, np.array(found).T, strict=True)))
    motions = table.loc[outcome.most.clip(lower=0).astype(int)]
    labels = Labels(*(motions[name].to_numpy() for name in ("state", "period", "longest_flight", "cycles")))
    settled = continue_settled(rows[motions.place], labels, settings, threads=threads)
    # The last quarter of the run is a whole period.
    durations = 4.0 * np.maximum(labels.period, 1) / designs[:, 1]
    ends = ensemble.run(settled, duration=durations, tolerance=settings["tolerance"], needs="vertical", threads=threads)
    return outcome.assign(
        velocity=np.where(outcome.most >= 0, motions.mean_velocity.to_numpy(), 0.0),
        impact_speed=np.nan_to_num(ends["impact_speed"], nan=settings["impact_speed"]),
        displacement=designs[:, 0] / (2.0 * np.pi * designs[:, 1]) ** 2,
    )


def is_within(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """Whether designs keep all constraints."""
    return (constraints(outcome, settings) <= 0.0).all(axis=1)


def constraints(outcome: pd.DataFrame, settings: dict) -> np.ndarray:
    """Positive where a constraint is violated, shape (k, 4): share, chaos, displacement, and feeding backwards."""
    displacement = outcome.displacement / settings["displacement"] - 1.0
    return np.column_stack([settings["share"] - outcome.share, outcome.chaos, displacement, -outcome.velocity])


class Front(Callback):
    """Keeps the designs within the constraints that none betters, and the hypervolume after each generation."""

    def __init__(self, reference: np.ndarray):
        super().__init__()
        self.reference, self.volumes = reference, []
        self.designs, self.objectives = np.empty((0, len(SEARCHED))), np.empty((0, len(reference)))

    def update(self, algorithm):
        within = algorithm.pop.get("CV")[:, 0] <= 0.0
        designs = np.vstack([self.designs, algorithm.pop.get("X")[within]])
        objectives = np.vstack([self.objectives, algorithm.pop.get("F")[within]])
        self.designs, self.objectives = best_of_designs(designs, objectives)
        self.volumes.append(hypervolume(self.objectives, self.reference))


def best_of_designs(designs: np.ndarray, objectives: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Designs that no other design betters, each once, sorted by their objectives."""
    if len(designs) == 0:
        return designs, objectives
    objectives, places = np.unique(objectives, axis=0, return_index=True)
    best = np.sort(NonDominatedSorting().do(objectives, only_non_dominated_front=True))
    return designs[places][best], objectives[best]


def hypervolume(objectives: np.ndarray, reference: np.ndarray) -> float:
    """Volume that objectives, shape (k, 3), dominate up to a reference point."""
    return float(HV(ref_point=reference)(objectives)) if len(objectives) else 0.0


def search(settings: dict, seed: int, *, threads: int = 1) -> Front:
    """The Pareto front of one seed; objectives are to be minimised: -velocity, impact speed, acceleration."""
    low, high = np.array([settings["bounds"][name] for name in SEARCHED]).T

    class Designs(Problem):
        def __init__(self):
            super().__init__(n_var=len(SEARCHED), n_obj=3, n_ieq_constr=4, xl=low, xu=high)

        def _evaluate(self, x, out):
            outcome = evaluate(x, settings, threads=threads)
            out["F"] = np.column_stack([-outcome.velocity, outcome.impact_speed, x[:, 0]])
            out["G"] = constraints(outcome, settings)

    front = Front(np.array([0.0, settings["impact_speed"], high[0]]))
    algorithm = NSGA2(pop_size=settings["population"])
    minimize(Designs(), algorithm, ("n_gen", settings["generations"]), seed=seed, callback=front)
    return front


def spread(values: np.ndarray, count: int) -> np.ndarray:
    """Places of at most `count` of some values, evenly spread in their order from the smallest to the largest."""
    order = np.argsort(values, kind="stable")
    places = np.linspace(0, len(order) - 1, min(count, len(order)))
    return order[np.unique(np.round(places).astype(np.int64))]


def make(settings: dict, *, threads: int = 1) -> dict[str, dict]:
    """The columns of the tables of the front and of the generations."""
    few = {**settings, **settings["search"]}
    fronts = {seed: search(few, seed, threads=threads) for seed in settings["seeds"]}
    designs, objectives = best_of_designs(
        np.vstack([front.designs for front in fronts.values()]),
        np.vstack([front.objectives for front in fronts.values()]),
    )
    whole = hypervolume(objectives, next(iter(fronts.values())).reference)
    front = pd.DataFrame(designs, columns=SEARCHED)
    front["displacement"] = front.acceleration / (2.0 * np.pi * front.frequency) ** 2
    front["velocity"], front["impact_speed"] = -objectives[:, 0], objectives[:, 1]
    chosen = spread(front.velocity.to_numpy(), settings["checked"])
    front["checked"] = front.index.isin(chosen)
    front["confirmed"] = front["recommended"] = False
    front[["checked_velocity", "velocity_stderr", "checked_share"]] = np.nan
    if len(chosen):
        outcome = evaluate(designs[chosen], settings, threads=threads)
        columns = ["checked_velocity", "velocity_stderr", "checked_share"]
        front.loc[chosen, columns] = outcome[["mean", "stderr", "share"]].to_numpy()
        front.loc[chosen, "confirmed"] = is_within(outcome, settings)
        sure = np.flatnonzero(front.confirmed)
        front.loc[sure[spread(front.velocity.to_numpy()[sure], settings["recommended"])], "recommended"] = True
    history = [
        {"seed": seed, "generation": number, "hypervolume": volume / whole if whole else 0.0}
        for seed, found in fronts.items()
        for number, volume in enumerate(found.volumes, start=1)
    ]
    return {
        "drive_front": front.to_dict("list"),
        "drive_generations": fields.columns(history, TABLES["drive_generations"]),
    }
