"""Pareto fronts of the misfits of the paper's numbers, which cannot all be fitted at once."""

from collections.abc import Callable

import numpy as np
import pandas as pd
from pymoo.operators.crossover.pcx import PCX
from pymoo.util.ref_dirs import get_reference_directions

from identification import measures
from identification.fits import fit
from identification.misfits import OBJECTIVES, misfits, root_mean_square
from identification.search_space import PARAMETERS, SEARCHED, bounds_of, values_of
from pipeline import fields, pareto

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


def search(evaluate: Evaluate, first: np.ndarray, bounds: np.ndarray, settings: dict, seed: int) -> pareto.Front:
    """Front of one tension mode; its hypervolumes are shares of the cube [0, worst]³.

    Parents are recombined along the directions in which they differ (PCX), because the valley of equally good contacts
    and angles is not aligned with any parameter.

    Parameters
    ----------
    evaluate : function from searched parameters, shape (n, 4), to objectives, shape (n, 3)
    first : points of the first generation, shape (k, 4); its remaining points are random
    bounds : shape (2, 4)
    settings : population, generations, worst
    """
    drawn = np.random.default_rng(seed).uniform(*bounds, (max(settings["population"] - len(first), 0), len(SEARCHED)))
    reference = np.full(len(OBJECTIVES), settings["worst"])
    front = pareto.search(
        lambda x: (evaluate(x), np.empty((len(x), 0))),
        np.vstack([first, drawn]),
        bounds,
        reference,
        settings,
        seed,
        crossover=PCX(),
    )
    return front._replace(volumes=[volume / reference.prod() for volume in front.volumes])


def distance(one: np.ndarray, other: np.ndarray) -> float:
    """Mean distance (largest difference of an objective) between members of a front and the nearest of the other."""
    distances = np.abs(one[:, None] - other[None]).max(axis=-1)
    return 0.5 * float(distances.min(axis=0).mean() + distances.min(axis=1).mean())


def status(fronts: list[pareto.Front], settings: dict) -> str:
    """Whether all searches of one tension mode have converged, and to the same front."""
    for front in fronts:
        earlier, last = front.volumes[3 * len(front.volumes) // 4 - 1], front.volumes[-1]
        if not abs(last - earlier) <= SETTLED * last:
            return "not converged: the hypervolume still grows"
    first = fronts[0]
    for front in fronts[1:]:
        if not abs(front.volumes[-1] - first.volumes[-1]) <= SETTLED * first.volumes[-1]:
            return "not converged: the seeds' hypervolumes differ"
        inside = [one.objectives[(one.objectives <= settings["worst"]).all(axis=1)] for one in (front, first)]
        if not distance(*inside) <= APART:
            return "not converged: the seeds' fronts are apart"
    return "converged"


def make(edges: pd.DataFrame, settings: dict) -> dict[str, pd.DataFrame]:
    """The tables of fronts and of generations."""
    model, options = settings["model"], settings["search"]
    interpolated = measures.interpolate_edges(edges)
    bounds = bounds_of(settings)
    groups = [settings["objectives"][name] for name in OBJECTIVES]
    numbers = {name: settings["numbers"][name] for group in groups for name in group}
    sizes = [len(group) for group in groups]
    drawn = np.random.default_rng(options["seeds"][0]).uniform(*bounds, (options["drawn"], len(SEARCHED)))
    members, history = [], []
    for tension in settings["readings"]:

        def misfits_at(x, tension=tension):
            return misfits(measures.quantities_at(interpolated, values_of(x, model), tension, settings), numbers, {})

        first = fit_compromises(misfits_at, sizes, drawn, bounds, options)
        found = [
            search(lambda x: objectives(misfits_at(x), sizes), first, bounds, options, seed)
            for seed in options["seeds"]
        ]
        verdict = status(found, options)
        for seed, one in zip(options["seeds"], found, strict=True):
            label = {"tension": tension, "seed": seed}
            columns = dict(zip(PARAMETERS, values_of(one.points, model).T, strict=True))
            columns |= dict(zip(OBJECTIVES, one.objectives.T, strict=True))
            members.append(pd.DataFrame(columns).assign(**label, status=verdict))
            growth = {"generation": np.arange(1, len(one.volumes) + 1), "hypervolume": one.volumes}
            history.append(pd.DataFrame(growth).assign(**label))
    front = pd.concat(members, ignore_index=True)
    best = pareto.non_dominated(front[list(OBJECTIVES)].to_numpy())
    front["on_front"] = np.isin(np.arange(len(front)), best)
    return {"front": front, "generations": pd.concat(history)}
