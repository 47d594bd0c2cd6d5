"""Pareto fronts by NSGA-II (pymoo); all objectives are to be minimised."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.core.repair import Repair
from pymoo.indicators.hv import HV
from pymoo.operators.survival.rank_and_crowding import RankAndCrowding
from pymoo.operators.survival.rank_and_crowding.metrics import get_crowding_function
from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting

# Decimals of points. The powers in pymoo's operators have other last digits on other processors, which chaotic motions
# would amplify.
DECIMALS = 9


class Rounded(Repair):
    """Rounds the points of each generation before they are evaluated."""

    def _do(self, problem, points, **options):
        return points.round(DECIMALS)


def crowding(objectives: np.ndarray, **options: int) -> np.ndarray:
    """Ranks of NSGA-II's crowding distances: NumPy sorts equal numbers in another order on other processors."""
    distances = get_crowding_function("cd").do(objectives, **options)
    return np.argsort(np.argsort(distances, kind="stable")).astype(np.float64)


class Front(NamedTuple):
    """The non-dominated points of a search, shape (n, d), their objectives, shape (n, k), and the hypervolume after
    each generation.
    """

    points: np.ndarray
    objectives: np.ndarray
    volumes: list[float]


def non_dominated(objectives: np.ndarray) -> np.ndarray:
    """Ascending indices of the non-dominated rows of objectives, shape (n, k)."""
    if len(objectives) == 0:
        return np.empty(0, dtype=np.int64)
    return np.sort(NonDominatedSorting().do(objectives, only_non_dominated_front=True))


def best_of(points: np.ndarray, objectives: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The non-dominated points, each once, and their objectives.

    They are sorted by their objectives, so that they do not depend on the order of discovery.
    """
    objectives, places = np.unique(objectives, axis=0, return_index=True)
    best = non_dominated(objectives)
    return points[places][best], objectives[best]


def hypervolume(objectives: np.ndarray, reference: np.ndarray) -> float:
    """Volume that objectives, shape (n, k), dominate up to a reference point, shape (k,)."""
    return float(HV(ref_point=reference)(objectives)) if len(objectives) else 0.0


def search(
    evaluate: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    first: np.ndarray,
    bounds: np.ndarray,
    reference: np.ndarray,
    settings: dict,
    seed: int,
    *,
    constraints: int = 0,
) -> Front:
    """The front of all points within the constraints that any generation has.

    A generation drops some of them, because its size is limited, so that its own hypervolume may fall.

    Parameters
    ----------
    evaluate : function from points, shape (n, d), to objectives, shape (n, k), and constraints, shape (n, c), which are
        positive where they are violated; called once for each generation
    first : the first generation, shape (m, d)
    bounds : of the points, shape (2, d)
    reference : reference point of the hypervolume, shape (k,)
    settings : population, generations
    constraints : their number, c
    """

    class Searched(Problem):
        def _evaluate(self, x, out):
            out["F"], out["G"] = evaluate(x)

    sizes = {"n_var": bounds.shape[1], "n_obj": len(reference), "n_ieq_constr": constraints}
    algorithm = NSGA2(
        pop_size=settings["population"],
        sampling=first,
        repair=Rounded(),
        survival=RankAndCrowding(crowding_func=crowding),
    )
    generations = ("n_gen", settings["generations"])
    algorithm.setup(Searched(**sizes, xl=bounds[0], xu=bounds[1]), termination=generations, seed=seed)
    points, objectives, volumes = np.empty((0, bounds.shape[1])), np.empty((0, len(reference))), []
    while algorithm.has_next():
        algorithm.next()
        within = algorithm.pop.get("CV")[:, 0] <= 0.0
        points = np.vstack([points, algorithm.pop.get("X")[within]])
        points, objectives = best_of(points, np.vstack([objectives, algorithm.pop.get("F")[within]]))
        volumes.append(hypervolume(objectives, reference))
    return Front(points, objectives, volumes)
