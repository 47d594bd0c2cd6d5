"""Profile of each parameter: the least total misfit of the paper's numbers over its value.

The total misfit is the sum of the squared misfits, as for independent errors with a standard deviation of half an
accepted interval. This makes the intervals wider, because the standard deviation of a uniform distribution over the
accepted interval is smaller by √3. Counting critical heights on one curve as independent makes them narrower. If even
the best parameters miss by more than these errors allow, all errors are scaled up by one factor (Birge's ratio).
"""

from collections.abc import Callable
from functools import cache, partial
from operator import itemgetter
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import chi2

from identification import measures
from identification.edges import VERTICAL
from identification.findings import VELOCITIES
from identification.fits import Fit, fit
from identification.misfits import misfits
from identification.printed import CONVERGED, EULER, NUMBERS, number_rows
from identification.search_space import LOSS, PARAMETERS, SEARCHED, STIFFNESS, bounds_of, searched, values_of
from pipeline import fields

SET = (
    fields.text("evidence", "set of the paper's numbers: see identification.evidence of the config"),
    fields.text("tension", "mode of a tensile contact force"),
)
VALUES = tuple(fields.number(name, unit, "best value, or held value") for name, unit in PARAMETERS.items())
TOTAL = fields.number("total", "1", "least sum of squared misfits, each in half an accepted interval")
STATUS = fields.text("status", "ok, at a bound (of the search), or not settled (the fit has not converged)")
TABLES = {
    "profiles": (*SET, fields.text("parameter", "name of the held parameter"), *VALUES, TOTAL, STATUS),
    "optima": (
        *SET,
        *VALUES,
        TOTAL,
        fields.number("printed_total", "1", "total at the printed parameters"),
        fields.count("numbers", "numbers of the paper in the total"),
        fields.number("scale", "1", "squared factor on all errors: least total over degrees of freedom, at least 1"),
        fields.number("rise", "1", "rise of a profile's total at the ends of its confidence interval"),
        fields.number("rise_of_all", "1", "rise of the total at the edge of the confidence region of all parameters"),
        STATUS,
    ),
    "frictions": (
        fields.number("friction", "1", "coefficient of friction, with the other printed parameters"),
        fields.number("first_low", "cm/s", "first state's velocity at the lower end of the interval with two states"),
        fields.number("first_high", "cm/s", "first state's velocity at the upper end"),
        fields.number("fall", "cm/s", "decrease of the second state's velocity from the lower to the upper end"),
    ),
    "implied": NUMBERS,
}
FRICTIONS = 65  # values of friction in the table `frictions`
# Number of guesses from the pool for a value, in addition to the results of its neighbours.
POOLED = 1
CORNER = 0.1  # margin of the damping grid, over the range of the logarithm of the loss
EDGE = 0.01  # distance from a bound, over the range of the logarithm, at which a result is at the bound


class Space(NamedTuple):
    """The remaining search space with one parameter held.

    Attributes
    ----------
    bounds : shape (2, 3)
    whole : function from the remaining parameters, shape (n, 3), to all searched parameters, shape (n, 4)
    """

    bounds: np.ndarray
    whole: Callable[[np.ndarray], np.ndarray]


def hold_parameter(parameter: str, value: float, bounds: np.ndarray, model: dict) -> Space:
    """The Space with one parameter held at a value. With damping held, the loss follows from the stiffness."""
    column = list(PARAMETERS).index(parameter)
    left = np.delete(bounds, column, axis=1)

    def whole(rest: np.ndarray) -> np.ndarray:
        x = np.insert(rest, column, np.log(value), axis=1)
        if parameter != "damping":
            return x
        values = np.exp(x)
        values[:, column] = value
        return searched(values, model)

    if parameter == "damping":
        # The loss is a power of the stiffness, so that bounds of the loss are bounds of the stiffness.
        ends = whole(left)[:, LOSS]
        slope = (ends[1] - ends[0]) / np.ptp(bounds[:, STIFFNESS])
        low, high = np.sort(bounds[0, STIFFNESS] + (bounds[:, LOSS] - ends[0]) / slope)
        place = STIFFNESS - 1  # without the loss
        left[:, place] = max(left[0, place], low), min(left[1, place], high)
    return Space(left, whole)


def fit_status(result: Fit, bounds: np.ndarray) -> str:
    """The status of a fit, as described in the tables."""
    low, high = bounds
    if not result.settled:
        return "not settled"
    margin = EDGE * (high - low)
    return "at a bound" if ((result.x < low + margin) | (result.x > high - margin)).any() else "ok"


class Pool(NamedTuple):
    """Points of the search space, shape (n, 4), with their misfits, shape (n, m): guesses for fits."""

    x: np.ndarray
    misfits: np.ndarray

    def best(self, count: int, chosen: np.ndarray | slice = slice(None)) -> np.ndarray:
        """The chosen points with the least totals, shape (count, 4)."""
        totals = np.sum(self.misfits[chosen] ** 2, axis=1)
        return self.x[chosen][np.argsort(totals, kind="stable")[:count]]


def find_profile(
    misfits: Callable[[np.ndarray], np.ndarray],
    parameter: str,
    grid: np.ndarray,
    optimum: np.ndarray,
    pool: Pool,
    bounds: np.ndarray,
    model: dict,
) -> list[tuple[np.ndarray, float, str]]:
    """The best fit for each value of a parameter: searched parameters, shape (4,), total, and status.

    From the optimum outwards, the guesses for a value are the result of its neighbour, the extrapolation of the last
    two results, and the best points of the pool near the value. Afterwards, from both sides, a value with a larger
    total than its neighbour is fitted again from the neighbour's result.
    """
    column = list(PARAMETERS).index(parameter)
    logs, pool_logs = np.log(grid), np.log(values_of(pool.x, model))[:, column]
    half = 0.5 * (logs[1] - logs[0])
    middle = int(np.abs(logs - np.log(values_of(optimum[None], model))[0, column]).argmin())
    spaces = [hold_parameter(parameter, value, bounds, model) for value in grid]
    found: dict[int, Fit] = {}

    # Guesses repeat: where a profile rises, a value has already been fitted from the result of its neighbour.
    @cache
    def fit_from(place: int, *guess: float) -> Fit:
        space = spaces[place]
        return fit(lambda rest: misfits(space.whole(rest)), np.array([guess]), space.bounds)

    def improve(place: int, guesses: np.ndarray) -> None:
        fits = [fit_from(place, *guess) for guess in np.delete(guesses, column, axis=1)]
        found[place] = min([found[place], *fits] if place in found else fits, key=lambda result: result.total)

    def whole(place: int) -> np.ndarray:
        return spaces[place].whole(found[place].x[None])

    for places in (range(middle, len(grid)), range(middle - 1, -1, -1)):
        last = before = optimum[None]
        for place in places:
            near = pool.best(POOLED, np.abs(pool_logs - logs[place]) <= half)
            improve(place, np.vstack([last, 2.0 * last - before, near]))
            before, last = last, whole(place)
    for direction, places in ((1, range(len(grid) - 2, -1, -1)), (-1, range(1, len(grid)))):
        for place in places:
            if found[place + direction].total < found[place].total:
                improve(place, whole(place + direction))
    return [
        (whole(place)[0], found[place].total, fit_status(found[place], spaces[place].bounds))
        for place in range(len(grid))
    ]


def grid_of(parameter: str, points: int, bounds: np.ndarray, model: dict) -> np.ndarray:
    """Values of a parameter in a geometric series, shape (points,).

    The values of damping end a little inside the corners of loss and stiffness, where the search space is empty.
    """
    corners = bounds.copy()
    corners[:, LOSS] += CORNER * np.ptp(bounds[:, LOSS]) * np.array([1.0, -1.0])
    column = list(PARAMETERS).index(parameter)
    return np.geomspace(*values_of(corners, model)[:, column], points)


def shifts_of(numbers: pd.DataFrame) -> dict[str, float]:
    """Differences of the numbers by the paper's method from the converged ones at the printed parameters."""
    one, other = (
        numbers[(numbers["set"] == "printed") & (numbers.method == method)].set_index("number").value
        for method in (EULER, CONVERGED)
    )
    return (one - other).to_dict()


def vary_friction(edges: measures.Edges, values: np.ndarray, settings: dict) -> pd.DataFrame:
    """The table of frictions: velocities over friction, with the other `values`, shape (4,)."""
    grid = np.tile(values, (FRICTIONS, 1))
    column = list(PARAMETERS).index("friction")
    grid[:, column] = np.linspace(*settings["bounds"]["friction"], FRICTIONS)
    found = measures.quantities_at(edges, grid, settings["model"]["tension"], settings)
    return pd.DataFrame({"friction": grid[:, column]} | {name: found[number] for name, number in VELOCITIES.items()})


def make(
    edges: pd.DataFrame, front: pd.DataFrame, printed: pd.DataFrame, settings: dict, *, threads: int = 1
) -> dict[str, pd.DataFrame]:
    """The tables of profiles, optima, frictions, and of the numbers at the optima."""
    model, bounds, options = settings["model"], bounds_of(settings), settings["profiles"]
    interpolated, shifts = measures.interpolate_edges(edges), shifts_of(printed)
    names = [name for group in settings["objectives"].values() for name in group]
    printed_values = np.array([model[name] for name in PARAMETERS])
    grids = {name: grid_of(name, options["points"], bounds, model) for name in PARAMETERS}
    drawn = np.random.default_rng(settings["search"]["seeds"][0]).uniform(
        *bounds, (settings["search"]["drawn"], len(SEARCHED))
    )
    profile_rows, optimum_rows = [], []
    for tension in VERTICAL:
        members = front[front.tension == tension][list(PARAMETERS)].to_numpy()
        points = np.vstack([searched(members, model), drawn])

        def quantities(x, tension=tension):
            return measures.quantities_at(interpolated, values_of(x, model), tension, settings)

        at_points, at_printed = quantities(points), quantities(searched(printed_values[None], model))
        for evidence, one in settings["evidence"].items():
            numbers = {name: settings["numbers"][name] for name in names if name not in one["without"]}
            compare = partial(misfits, numbers=numbers, shifts=shifts if one["shifted"] else {})

            def misfits_at(x, compare=compare, quantities=quantities):
                return compare(quantities(x))

            pool = Pool(points, compare(at_points))
            best = fit(misfits_at, pool.best(settings["search"]["starts"]), bounds)
            label = {"evidence": evidence, "tension": tension}
            found = []
            for name, grid in grids.items():
                profile = find_profile(misfits_at, name, grid, best.x, pool, bounds, model)
                found += profile
                for value, (x, total, status) in zip(grid, profile, strict=True):
                    row = {"parameter": name, "total": total, "status": status} | parameters_by_name(x, model)
                    profile_rows.append(label | row | {name: value})
            # A profile may find a better fit than the search before it.
            x, lowest, _ = min(found, key=itemgetter(1))
            if lowest < best.total:
                best = fit(misfits_at, np.array([x, best.x]), bounds)
            optimum_rows.append(
                {
                    **label,
                    **parameters_by_name(best.x, model),
                    "total": best.total,
                    "printed_total": float(np.sum(compare(at_printed) ** 2)),
                    "numbers": len(numbers),
                    "status": fit_status(best, bounds),
                }
            )
    optima = add_rises(pd.DataFrame(optimum_rows), options["confidence"])
    return {
        "profiles": pd.DataFrame(profile_rows),
        "optima": optima,
        "frictions": vary_friction(interpolated, printed_values, settings),
        "implied": implied_numbers(optima, interpolated, settings, threads),
    }


def parameters_by_name(x: np.ndarray, model: dict) -> dict[str, float]:
    """The parameters by name, from searched parameters, shape (4,)."""
    return dict(zip(PARAMETERS, map(float, values_of(x[None], model)[0]), strict=True))


def add_rises(optima: pd.DataFrame, confidence: float) -> pd.DataFrame:
    """The optima with the rises of the total at the bounds of confidence intervals and regions.

    The scale of the errors comes from the best tension mode of a set of evidence, and holds for all of its modes.
    """
    least = optima.groupby("evidence").total.transform("min")
    scale = np.maximum(least / (optima.numbers - len(PARAMETERS)), 1.0)
    rises = {"rise": 1, "rise_of_all": len(PARAMETERS)}
    return optima.assign(scale=scale, **{name: scale * chi2.ppf(confidence, count) for name, count in rises.items()})


def implied_numbers(optima: pd.DataFrame, edges: measures.Edges, settings: dict, threads: int) -> pd.DataFrame:
    """Rows of numbers at the best parameters of each set of evidence over all tension modes."""
    best = optima.loc[optima.groupby("evidence", sort=False).total.idxmin()]
    return pd.concat(
        number_rows(
            optimum.evidence,
            np.array([getattr(optimum, name) for name in PARAMETERS]),
            optimum.tension,
            CONVERGED,
            edges,
            settings,
            threads,
        )
        for optimum in best.itertuples()
    )
