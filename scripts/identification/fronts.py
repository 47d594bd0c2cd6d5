"""Pareto fronts of the misfits of the paper's numbers, which cannot all be fitted at once, by NSGA-II (pymoo)."""

from collections.abc import Callable

import numpy as np
import pandas as pd
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.callback import Callback
from pymoo.core.problem import Problem
from pymoo.indicators.hv import HV
from pymoo.operators.crossover.pcx import PCX
from pymoo.optimize import minimize
from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting
from pymoo.util.ref_dirs import get_reference_directions

from identification import measures
from identification.fits import fit
from identification.misfits import OBJECTIVES, numbers_of, root_mean_square
from identification.search_space import PARAMETERS, SEARCHED, bounds_of, values_of
from pipeline import fields

SEARCH = (
    fields.text("tension", "mode of a tensile contact force"),
    fields.count("seed", "seed of the search"),
)
TABLES = {
    "front": (
        *SEARCH,
        *(fields.number(name, unit, "parameter") for name, unit in PARAMETERS.items()),
        fields.number("places", "1", "root mean square misfit of the amplitudes and heights of changes of state"),
        fields.number("first_velocity", "1", "root mean square misfit of the first state's velocity"),
        fields.number("second_velocity", "1", "misfit of the decrease of the second state's velocity"),
        fields.flag("on_front", "whether no member of any tension mode and seed is better in all three"),
        fields.text("status", "converged, or why the search of its tension mode is not"),
    ),
    "generations": (
        *SEARCH,
        fields.count("generation", "number of the generation, from 1"),
        fields.number("hypervolume", "1", "share of the cube up to the worst misfits that the front dominates"),
    ),
}

# An objective with the weight zero could take any value.
LEAST_WEIGHT = 0.01
# A search has converged if the hypervolume changes at most by the first number in the last quarter of the generations
# and between seeds, and if a member of one seed's front has on average at most the second number as its distance (in
# misfits) from the nearest member of the other front.
SETTLED, APART = 0.01, 0.15

Evaluate = Callable[[np.ndarray], np.ndarray]


def objectives(misfits: np.ndarray, sizes: list[int]) -> np.ndarray:
    """Root mean square of each group, shape (n, 3), from misfits in the order of the groups, shape (n, m)."""
    parts = np.split(misfits, np.cumsum(sizes)[:-1], axis=-1)
    return np.stack([root_mean_square(part) for part in parts], axis=-1)


def fit_compromises(
    misfits: Evaluate, sizes: list[int], drawn: np.ndarray, bounds: np.ndarray, settings: dict
) -> np.ndarray:
    """Points near the front by least squares, one for each set of weights of the objectives: shape (k, 4).

    Parameters
    ----------
    misfits : function from searched parameters, shape (n, 4), to misfits in the order of the groups, shape (n, m)
    sizes : number of misfits in each group
    drawn, bounds : random points, shape (s, 4), the best of which are guesses, and bounds, shape (2, 4)
    settings : `weights`, number of partitions of the weights; `starts`, number of guesses
    """
    found, drawn_misfits = [], misfits(drawn)
    for weights in get_reference_directions("das-dennis", len(sizes), n_partitions=settings["weights"]):
        factors = np.repeat(np.sqrt(np.maximum(weights, LEAST_WEIGHT) / sizes), sizes)
        best = np.argsort(np.sum((factors * drawn_misfits) ** 2, axis=1), kind="stable")[: settings["starts"]]
        found.append(fit(lambda x, factors=factors: factors * misfits(x), drawn[best], bounds).x)
    return np.array(found)


class Archive(Callback):
    """All non-dominated members so far, and their hypervolume as a share of the cube [0, worst]³.

    A generation drops some of them, because its size is limited, so that its own hypervolume may fall.
    """

    def __init__(self, worst: float):
        super().__init__()
        self.indicator = HV(ref_point=np.full(len(OBJECTIVES), worst))
        self.cube = worst ** len(OBJECTIVES)
        self.x, self.values = np.empty((0, len(SEARCHED))), np.empty((0, len(OBJECTIVES)))
        self.shares = []

    def update(self, algorithm):
        x = np.vstack([self.x, algorithm.pop.get("X")])
        values = np.vstack([self.values, algorithm.pop.get("F")])
        # Sorts by the objectives and drops duplicates, so that the result does not depend on the order of discovery.
        values, rows = np.unique(values, axis=0, return_index=True)
        best = np.sort(non_dominated(values))
        self.x, self.values = x[rows][best], values[best]
        self.shares.append(float(self.indicator(self.values)) / self.cube)


def non_dominated(values: np.ndarray) -> np.ndarray:
    """Indices of the non-dominated rows of objectives, shape (n, 3)."""
    return NonDominatedSorting().do(values, only_non_dominated_front=True)


def search(
    evaluate: Evaluate, first: np.ndarray, bounds: np.ndarray, settings: dict, seed: int
) -> tuple[np.ndarray, np.ndarray, list[float]]:
    """Front of one tension mode: searched parameters, shape (n, 4), objectives, shape (n, 3), and hypervolumes.

    Parents are recombined along the directions in which they differ (PCX), because the valley of equally good contacts
    and angles is not aligned with any parameter.

    Parameters
    ----------
    evaluate : function from searched parameters, shape (n, 4), to objectives, shape (n, 3)
    first : points of the first generation, shape (k, 4); its remaining points are random
    bounds : shape (2, 4)
    settings : population, generations, worst
    """

    class Misfits(Problem):
        def __init__(self):
            super().__init__(n_var=len(SEARCHED), n_obj=len(OBJECTIVES), xl=bounds[0], xu=bounds[1])

        def _evaluate(self, x, out):
            out["F"] = evaluate(x)

    drawn = np.random.default_rng(seed).uniform(*bounds, (max(settings["population"] - len(first), 0), len(SEARCHED)))
    archive = Archive(settings["worst"])
    minimize(
        Misfits(),
        NSGA2(pop_size=settings["population"], sampling=np.vstack([first, drawn]), crossover=PCX()),
        ("n_gen", settings["generations"]),
        seed=seed,
        callback=archive,
    )
    return archive.x, archive.values, archive.shares


def distance(one: np.ndarray, other: np.ndarray) -> float:
    """Mean distance (largest difference of an objective) between members of a front and the nearest of the other."""
    distances = np.abs(one[:, None] - other[None]).max(axis=-1)
    return 0.5 * float(distances.min(axis=0).mean() + distances.min(axis=1).mean())


def status(fronts: list[np.ndarray], volumes: list[list[float]], settings: dict) -> str:
    """Whether all searches of one tension mode have converged, and to the same front."""
    for shares in volumes:
        earlier = shares[3 * len(shares) // 4 - 1]
        if not abs(shares[-1] - earlier) <= SETTLED * shares[-1]:
            return "not converged: the hypervolume still grows"
    for shares, front in zip(volumes[1:], fronts[1:], strict=True):
        if not abs(shares[-1] - volumes[0][-1]) <= SETTLED * volumes[0][-1]:
            return "not converged: the seeds' hypervolumes differ"
        inside = [one[(one <= settings["worst"]).all(axis=1)] for one in (front, fronts[0])]
        if not distance(*inside) <= APART:
            return "not converged: the seeds' fronts are apart"
    return "converged"


def make(edges: pd.DataFrame, settings: dict) -> dict[str, dict]:
    """The columns of the tables of fronts and of generations."""
    model, options = settings["model"], settings["search"]
    interpolated = measures.interpolate_edges(edges, model)
    bounds = bounds_of(settings)
    groups = [settings["objectives"][name] for name in OBJECTIVES]
    numbers = numbers_of(settings, [name for group in groups for name in group])
    sizes = [len(group) for group in groups]
    drawn = np.random.default_rng(options["seeds"][0]).uniform(*bounds, (options["drawn"], len(SEARCHED)))
    members, history = [], []
    for tension in settings["readings"]:

        def misfits(x, tension=tension):
            found = measures.quantities_at(
                interpolated, values_of(x, model), tension, settings, measures.converged_velocities
            )
            return numbers.misfits(found)

        first = fit_compromises(misfits, sizes, drawn, bounds, options)
        found = [
            search(lambda x: objectives(misfits(x), sizes), first, bounds, options, seed) for seed in options["seeds"]
        ]
        verdict = status([values for _, values, _ in found], [shares for *_, shares in found], options)
        for seed, (x, values, shares) in zip(options["seeds"], found, strict=True):
            label = {"tension": tension, "seed": seed}
            columns = dict(zip(PARAMETERS, values_of(x, model).T, strict=True))
            columns |= dict(zip(OBJECTIVES, values.T, strict=True))
            members.append(pd.DataFrame(columns).assign(**label, status=verdict))
            growth = {"generation": np.arange(1, len(shares) + 1), "hypervolume": shares}
            history.append(pd.DataFrame(growth).assign(**label))
    front = pd.concat(members, ignore_index=True)
    best = non_dominated(front[list(OBJECTIVES)].to_numpy())
    front["on_front"] = np.isin(np.arange(len(front)), best)
    return {"front": front.to_dict("list"), "generations": pd.concat(history).to_dict("list")}
