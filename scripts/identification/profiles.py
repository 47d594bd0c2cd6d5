"""What the paper's numbers say of each parameter: the least total misfit over its value, its profile.

The total misfit is the sum of the squared misfits: as if the numbers had independent errors with half an accepted
interval for a standard deviation. That is √3 times what an error has which is as likely anywhere in the interval, so it
is generous; that critical heights which lie on one curve err independently is not. Where even the best parameters miss
by more than these errors allow, all errors are taken to be larger by one factor (Birge's ratio).
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import chi2

from identification import measures
from identification.edges import VERTICAL
from identification.fits import Fit, fit
from identification.misfits import numbers_of
from identification.printed import CONVERGED, EULER, NUMBERS, rows
from identification.search_space import LOSS, PARAMETERS, SEARCHED, STIFFNESS, bounds_of, searched, values_of
from pipeline import fields

SET = (
    fields.text("evidence", "set of the paper's numbers: see identification.evidence of the config"),
    fields.text("tension", "reading of a contact force that pulls"),
)
VALUES = tuple(fields.number(name, unit, "best value, or the one that is held") for name, unit in PARAMETERS.items())
TOTAL = fields.number("total", "1", "least sum of squared misfits, each in half an accepted interval")
STATUS = fields.text("status", "ok, at a bound (of the range that is searched), or not settled")
TABLES = {
    "profiles": (*SET, fields.text("parameter", "the one that is held"), *VALUES, TOTAL, STATUS),
    "optima": (
        *SET,
        *VALUES,
        TOTAL,
        fields.number("printed_total", "1", "the total at the printed parameters"),
        fields.count("numbers", "numbers of the paper in the total"),
        fields.number("scale", "1", "square of the factor on all errors: least total over degrees of freedom, or 1"),
        fields.number("rise", "1", "rise of a profile's total to the end of its interval of confidence"),
        fields.number("rise_of_all", "1", "rise of the total to the edge of the region of all four parameters"),
        STATUS,
    ),
    "frictions": (
        fields.number("friction", "1", "coefficient of friction, all else as printed"),
        fields.number("first_low", "cm/s", "first state's velocity at the lower end of the interval of two states"),
        fields.number("first_high", "cm/s", "at its upper end"),
        fields.number("fall", "cm/s", "fall of the second state's velocity from the lower to the upper end"),
    ),
    "implied": NUMBERS,
}
VELOCITIES = {
    "first_low": "C05.velocity_at_lower_end",
    "first_high": "C05.velocity_at_upper_end",
    "fall": "C06.fall",
}
FRICTIONS = 65  # values beside the printed other parameters
# Points of the pool that least squares start from, beside the result for the neighbouring value.
POOLED = 1
CORNER = 0.1  # of the range of the logarithm of the loss
EDGE = 0.01  # of the range of a logarithm: nearer than this a result is at a bound


class Space(NamedTuple):
    """What is left to search where one parameter is held.

    Attributes
    ----------
    bounds : shape (2, 3)
    whole : what is searched, shape (n, 4), of the rest, shape (n, 3)
    rest : the rest, shape (n, 3), of what is searched, shape (n, 4)
    """

    bounds: np.ndarray
    whole: Callable[[np.ndarray], np.ndarray]
    rest: Callable[[np.ndarray], np.ndarray]


def hold(parameter: str, value: float, bounds: np.ndarray, model: dict) -> Space:
    """The Space where one parameter is held at a value. A held damping gives the loss from the stiffness."""
    column = list(PARAMETERS).index(parameter)
    others = [place for place in range(len(SEARCHED)) if place != column]
    left = bounds[:, others].copy()

    def whole(rest: np.ndarray) -> np.ndarray:
        x = np.insert(rest, column, np.log(value), axis=1)
        if parameter == "damping":
            held = np.full(len(x), value)
            x = searched(np.column_stack([np.exp(x[:, 0]), held, np.exp(x[:, STIFFNESS]), np.exp(x[:, 3])]), model)
        return x

    if parameter == "damping":
        # The loss is a power of the stiffness, so that its bounds are bounds of the stiffness.
        ends = whole(left)[:, LOSS]
        slope = (ends[1] - ends[0]) / np.ptp(bounds[:, STIFFNESS])
        of_loss = np.sort(bounds[0, STIFFNESS] + (bounds[:, LOSS] - ends[0]) / slope)
        place = others.index(STIFFNESS)
        left[:, place] = max(left[0, place], of_loss[0]), min(left[1, place], of_loss[1])
    return Space(left, whole, lambda x: x[:, others])


def status_of(one: Fit, bounds: np.ndarray) -> str:
    low, high = bounds
    if not one.settled:
        return "not settled"
    margin = EDGE * (high - low)
    return "at a bound" if ((one.x < low + margin) | (one.x > high - margin)).any() else "ok"


class Pool(NamedTuple):
    """Points of the bounds, shape (n, 4), with their misfits, shape (n, m): where least squares may start."""

    x: np.ndarray
    misfits: np.ndarray

    def best(self, count: int, chosen: np.ndarray | slice = slice(None)) -> np.ndarray:
        """Those with the least totals among the chosen ones, shape (count, 4)."""
        totals = np.sum(self.misfits[chosen] ** 2, axis=1)
        return self.x[chosen][np.argsort(totals, kind="stable")[:count]]


def profile(
    misfits: Callable[[np.ndarray], np.ndarray],
    parameter: str,
    grid: np.ndarray,
    optimum: np.ndarray,
    pool: Pool,
    bounds: np.ndarray,
    model: dict,
) -> list[tuple[np.ndarray, float, str]]:
    """For each value of the grid what fits best beside it: what is searched, shape (4,), the total, and a status.

    From the optimum outwards, each value starts from the result of its neighbour, from where the last two lead, and
    from the best points of the pool that are near it; then, from either side, each that is worse than its neighbour
    starts from that one's result.
    """
    column = list(PARAMETERS).index(parameter)
    logs, of_pool = np.log(grid), np.log(values_of(pool.x, model))[:, column]
    half = 0.5 * (logs[1] - logs[0])
    middle = int(np.abs(logs - np.log(values_of(optimum[None], model))[0, column]).argmin())
    spaces = [hold(parameter, value, bounds, model) for value in grid]
    found: dict[int, Fit] = {}

    # Starts come again: where a profile rises, a value is worse than the neighbour from whose result it has started.
    @cache
    def searched_from(place: int, *start: float) -> Fit:
        space = spaces[place]
        return fit(lambda rest: misfits(space.whole(rest)), np.array([start]), space.bounds)

    def improve(place: int, starts: np.ndarray) -> None:
        fits = [searched_from(place, *start) for start in spaces[place].rest(starts)]
        found[place] = min([found[place], *fits] if place in found else fits, key=lambda one: one.total)

    def whole(place: int) -> np.ndarray:
        return spaces[place].whole(found[place].x[None])

    for places in (range(middle, len(grid)), range(middle - 1, -1, -1)):
        last = before = optimum[None]
        for place in places:
            near = pool.best(POOLED, np.abs(of_pool - logs[place]) <= half)
            improve(place, np.vstack([last, 2.0 * last - before, near]))
            before, last = last, whole(place)
    for way, places in ((1, range(len(grid) - 2, -1, -1)), (-1, range(1, len(grid)))):
        for place in places:
            if found[place + way].total < found[place].total:
                improve(place, whole(place + way))
    return [
        (whole(place)[0], found[place].total, status_of(found[place], spaces[place].bounds))
        for place in range(len(grid))
    ]


def grid_of(parameter: str, points: int, bounds: np.ndarray, model: dict) -> np.ndarray:
    """Values of a parameter in equal ratios, shape (points,).

    The ends of damping lie a little within those of the corners of loss and stiffness, where nothing is left to search.
    """
    corners = bounds.copy()
    corners[:, LOSS] += CORNER * np.ptp(bounds[:, LOSS]) * np.array([1.0, -1.0])
    column = list(PARAMETERS).index(parameter)
    return np.geomspace(*values_of(corners, model)[:, column], points)


def shifts_of(numbers: pd.DataFrame) -> dict[str, float]:
    """What the paper's method adds to the converged numbers at the printed parameters."""
    one, other = (
        numbers[(numbers["set"] == "printed") & (numbers.method == method)].set_index("number").value
        for method in (EULER, CONVERGED)
    )
    return (one - other).to_dict()


def vary_friction(edges: measures.Edges, values: np.ndarray, settings: dict, follow: measures.Follow) -> dict:
    """The columns of the table of frictions: what friction alone changes beside the printed values, shape (4,)."""
    grid = np.tile(values, (FRICTIONS, 1))
    column = list(PARAMETERS).index("friction")
    grid[:, column] = np.linspace(*settings["bounds"]["friction"], FRICTIONS)
    found = measures.at(edges, grid, settings["model"]["tension"], settings, follow)
    return {"friction": grid[:, column], **{name: found[number] for name, number in VELOCITIES.items()}}


def make(
    edges: pd.DataFrame, front: pd.DataFrame, printed: pd.DataFrame, settings: dict, *, threads: int = 1
) -> dict[str, dict]:
    """The columns of the tables of profiles, optima, frictions, and of the numbers at the optima."""
    model, bounds, options = settings["model"], bounds_of(settings), settings["profiles"]
    interpolated, follow = measures.edges_of(edges, model), measures.by_events
    names = [name for group in settings["objectives"].values() for name in group]
    shifts = shifts_of(printed)
    sets = {
        evidence: numbers_of(
            settings,
            [name for name in names if name not in one["without"]],
            shifts if one["shifted"] else None,
        )
        for evidence, one in settings["evidence"].items()
    }
    given = np.array([model[name] for name in PARAMETERS])
    grids = {name: grid_of(name, options["points"], bounds, model) for name in PARAMETERS}
    drawn = np.random.default_rng(settings["search"]["seeds"][0]).uniform(
        *bounds, (settings["search"]["drawn"], len(SEARCHED))
    )
    of_profiles, of_optima = [], []
    for reading in VERTICAL:
        members = front[front.tension == reading][list(PARAMETERS)].to_numpy()
        points = np.vstack([searched(members, model), drawn])

        def quantities(x, reading=reading):
            return measures.at(interpolated, values_of(x, model), reading, settings, follow)

        at_points, at_given = quantities(points), quantities(searched(given[None], model))
        for evidence, numbers in sets.items():

            def misfits(x, numbers=numbers, quantities=quantities):
                return numbers.misfits(quantities(x))

            pool = Pool(points, numbers.misfits(at_points))
            best = fit(misfits, pool.best(settings["search"]["starts"]), bounds)
            of_set = {"evidence": evidence, "tension": reading}
            held = []
            for name, grid in grids.items():
                found = profile(misfits, name, grid, best.x, pool, bounds, model)
                for value, (x, total, status) in zip(grid, found, strict=True):
                    held.append((x, float(value), {**of_set, "parameter": name, "total": total, "status": status}))
            # A profile may come lower than the search that began it.
            x, _, lowest = min(held, key=lambda row: row[2]["total"])
            if lowest["total"] < best.total:
                best = fit(misfits, np.array([x, best.x]), bounds)
            of_profiles += [row | parameters_by_name(x, model) | {row["parameter"]: value} for x, value, row in held]
            of_optima.append(
                {
                    **of_set,
                    **parameters_by_name(best.x, model),
                    "total": best.total,
                    "printed_total": float(np.sum(numbers.misfits(at_given) ** 2)),
                    "numbers": len(numbers.of_paper),
                    "status": status_of(best, bounds),
                }
            )
    optima = with_rises(pd.DataFrame(of_optima), options["confidence"])
    return {
        "profiles": pd.DataFrame(of_profiles).to_dict("list"),
        "optima": optima.to_dict("list"),
        "frictions": vary_friction(interpolated, given, settings, follow),
        "implied": implied(optima, interpolated, settings, threads).to_dict("list"),
    }


def parameters_by_name(x: np.ndarray, model: dict) -> dict[str, float]:
    """The parameters by their names, of what is searched, shape (4,)."""
    return dict(zip(PARAMETERS, map(float, values_of(x[None], model)[0]), strict=True))


def with_rises(optima: pd.DataFrame, confidence: float) -> pd.DataFrame:
    """The optima with the rises of the total that bound intervals and regions of this confidence.

    One scale serves all readings of a set of evidence: that of the best of them.
    """
    least = optima.groupby("evidence").total.transform("min")
    scale = np.maximum(least / (optima.numbers - len(PARAMETERS)), 1.0)
    rises = {"rise": 1, "rise_of_all": len(PARAMETERS)}
    return optima.assign(scale=scale, **{name: scale * chi2.ppf(confidence, of) for name, of in rises.items()})


def implied(optima: pd.DataFrame, edges: measures.Edges, settings: dict, threads: int) -> pd.DataFrame:
    """Rows of numbers at the best parameters of each set of evidence, under whichever reading."""
    best = optima.loc[optima.groupby("evidence", sort=False).total.idxmin()]
    return pd.concat(
        rows(
            one.evidence,
            np.array([getattr(one, name) for name in PARAMETERS]),
            one.tension,
            CONVERGED,
            edges,
            settings,
            threads,
        )
        for one in best.itertuples()
    )
