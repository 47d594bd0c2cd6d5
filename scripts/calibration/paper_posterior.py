"""Which parameters the paper's numbers imply: the posterior of friction, damping, stiffness and angle.

The likelihood takes the misfits as independent, normally distributed errors with a standard deviation of half an
accepted interval. This makes the intervals wider, because the standard deviation of a uniform distribution over the
accepted interval is smaller by √3. Counting critical heights on one curve as independent makes them narrower. If even
the best parameters miss the changes of state by more than these errors allow, all errors are scaled up by one factor
(Birge's ratio). The prior is constant in the logarithms of the searched parameters, and both tension modes are equally
probable.
"""

import math
from collections.abc import Callable
from functools import partial

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.stats import chi2

from calibration.credible_intervals import CONFIDENCE, open_ends, summarize, with_errors
from calibration.edges import VERTICAL
from calibration.effort import ENOUGH, SEARCHES
from calibration.importance_sampling import EXACT, effective_number, log_sum, monte_carlo_error, normalize, sample
from calibration.paper_findings import DOWN_ALONE, VELOCITIES, misfit
from calibration.paper_numbers import (
    CONVERGED,
    EULER,
    PARAMETERS,
    converged_velocities,
    interpolate_edges,
    measure_by_table,
    measure_directly,
    searched,
)
from calibration.search_space import bounds_of, values_at
from conveyor.elementary import exp, log
from pipeline import fields

SET = fields.text("evidence", "set of the paper's numbers: all, end_left_out or paper_method")
VALUES = tuple(fields.number(name, unit, "parameter") for name, unit in PARAMETERS.items())
TOTAL = fields.number("total", "1", "sum of squared misfits, each in half an accepted interval")
SETS = "a set of evidence at its lowest total; at the printed parameters: euler, converged, or interpolated (edges)"
TENSION = fields.text("tension", "mode of a tensile contact force")
TABLES = {
    "numbers": (
        fields.text("set", SETS),
        fields.text("number", "CLAIM.QUANTITY"),
        fields.number("value", "see the claim", "measured"),
        fields.number("misfit", "1", "distance from the middle of the accepted interval over half its width"),
    ),
    "fits": (
        SET,
        TENSION,
        *VALUES,
        TOTAL,
        fields.number("printed_total", "1", "total at the printed parameters with this tension mode"),
        fields.count("numbers", "numbers of the paper in the total"),
        fields.number("scale", "1", "squared factor on all errors: least total over degrees of freedom, at least 1"),
        fields.number("region", "1", "rise of the total at the edge of the confidence region of all parameters"),
        fields.number("share", "1", "posterior probability of this tension mode"),
        fields.number("size", "1", "effective number of points"),
    ),
    "intervals": (
        SET,
        fields.text("parameter", "name"),
        fields.number("best", "see parameter", "median of the posterior; null for too few effective points"),
        fields.number("best_error", "see parameter", "standard error of the best value from search to search"),
        fields.number("low", "see parameter", "lower end of the credible interval"),
        fields.number("low_error", "see parameter", "standard error of the lower end from search to search"),
        fields.number("high", "see parameter", "upper end of the credible interval"),
        fields.number("high_error", "see parameter", "standard error of the upper end from search to search"),
        fields.flag("open_low", "whether only the lower bound of the search limits the interval"),
        fields.flag("open_high", "whether only the upper bound of the search limits the interval"),
        fields.number("covered", "1", "share of the searched range that the interval covers, on a logarithmic scale"),
    ),
    "samples": (
        SET,
        TENSION,
        *VALUES,
        TOTAL,
        fields.number("weight", "1", "share of the posterior"),
        fields.count("search", "number of the independent search that found it"),
    ),
    "frictions": (
        fields.number("friction", "1", "coefficient of friction, with the other printed parameters"),
        fields.number("first_low", "cm/s", "first state's velocity at the lower end of the interval with two states"),
        fields.number("first_high", "cm/s", "first state's velocity at the upper end"),
        fields.number("fall", "cm/s", "decrease of the second state's velocity from the lower to the upper end"),
    ),
}
# Sets of evidence: numbers that a set leaves out, and whether the difference between both methods at the printed
# parameters is added to the converged numbers. C01 and the upper end of C02 are the same quantity of the model, for
# which the paper gives two numbers. A, B and C of C09 are in no set, because they lie in a valley (figure fit_valley).
EVIDENCE = {
    "all": {"without": (), "shifted": False},
    "end_left_out": {"without": (DOWN_ALONE,), "shifted": False},
    "paper_method": {"without": (DOWN_ALONE,), "shifted": True},
}
# For each set of evidence and tension mode, by an effort of 1: contacts and angles in each round, rounds after the
# first one, and conveyors whose velocities are computed.
POINTS, ROUNDS, FOLLOWED = 4000, 5, 2000
SEED = 1
FRICTIONS = 65  # values of friction in the table `frictions`
# Decimals of a misfit. Splines come from LAPACK, whose last digits differ from processor to processor and would decide
# which points the search draws next.
ROUNDED = 6

Quantities = Callable[[np.ndarray, str, bool], dict[str, np.ndarray]]


def number_rows(name: str, quantities: dict[str, np.ndarray], numbers: dict[str, dict]) -> pd.DataFrame:
    """Rows of the table of numbers, from quantities of shape (1,)."""
    values = {number: float(quantities[number][0]) for number in numbers}
    misfits = [float(misfit(value, numbers[number])) for number, value in values.items()]
    return pd.DataFrame({"set": name, "number": list(values), "value": list(values.values()), "misfit": misfits})


def infer(
    evidence: dict, shifts: dict[str, float], quantities: Quantities, settings: dict, seed: int = SEED
) -> tuple[pd.DataFrame, ...]:
    """Samples and fits of one set of evidence.

    Changes of state do not depend on friction and need no trajectory. They give a posterior of contact and angle, from
    which points are drawn for the trajectories; the velocities are the weights of these points.

    Parameters
    ----------
    shifts : by CLAIM.QUANTITY, added to the quantities before they are compared
    quantities : function from searched parameters, shape (n, 4), a tension mode, and whether velocities are wanted
    """
    bounds = bounds_of(settings, PARAMETERS)
    numbers = {name: one for name, one in settings["numbers"].items() if name not in evidence["without"]}

    def total(predicted: dict[str, np.ndarray]) -> np.ndarray:
        moved = {name: value + shifts.get(name, 0.0) for name, value in predicted.items() if name in numbers}
        return sum(misfit(value, numbers[name]).round(ROUNDED) ** 2 for name, value in moved.items())

    def of_states(y: np.ndarray, tension: str) -> np.ndarray:
        totals = total(quantities(np.column_stack([np.full(len(y), bounds[0, 0]), y]), tension, False))
        return -0.5 * totals[None, :, None]

    points, followed = (round(settings["effort"] * count) // SEARCHES for count in (POINTS, FOLLOWED))
    search = {"first": points, "points": points, "rounds": ROUNDS, "enough": math.inf, "widths": EXACT}
    posteriors = {
        (tension, number): sample(partial(of_states, tension=tension), bounds[:, 1:], **search, seed=[seed, number])
        for tension in VERTICAL
        for number in range(SEARCHES)
    }
    least = min(-2.0 * one.log_density.max() for one in posteriors.values())
    scale = max(least / (len(numbers) - len(PARAMETERS)), 1.0)
    random = np.random.default_rng(seed)
    samples, fits = [], []
    for (tension, number), states in posteriors.items():
        # All errors are scaled up: the density is raised to the power 1/scale. Some weights have underflowed to zero.
        kept = np.flatnonzero(states.weights)
        logs = log(states.weights[kept]) + states.log_density[kept] * (1.0 / scale - 1.0)
        chosen = random.choice(kept, followed, p=normalize(logs)[0])
        x = np.column_stack([random.uniform(*bounds[:, 0], len(chosen)), states.points[chosen]])
        totals = total(quantities(x, tension, True))
        velocities = -0.5 * totals - states.log_density[chosen]
        # The logarithms of weights also compare both tension modes, and the searches.
        log_weights = states.log_evidence + log_sum(logs) + velocities / scale
        rows = values_at(x, settings, PARAMETERS)
        samples.append(pd.DataFrame(rows).assign(tension=tension, search=number, total=totals, weight=log_weights))
    table = pd.concat(samples, ignore_index=True)
    table["weight"] = normalize(table.weight.to_numpy())[0]
    for tension in VERTICAL:
        own = table[table.tension == tension]
        best = minimize(
            lambda x, tension=tension: total(quantities(x[None], tension, True))[0],
            searched(settings, **own.loc[own.total.idxmin(), list(PARAMETERS)])[0],
            method="Nelder-Mead",
            bounds=bounds.T,
        )
        row = {name: float(value[0]) for name, value in values_at(best.x[None], settings, PARAMETERS).items()}
        printed = total(quantities(searched(settings), tension, True))
        fits.append({"tension": tension, **row, "total": float(best.fun), "printed_total": float(printed[0])})
    by_tension = table.groupby("tension", sort=False).weight
    return table, pd.DataFrame(fits).assign(
        numbers=len(numbers),
        scale=scale,
        region=scale * chi2.ppf(CONFIDENCE, len(PARAMETERS)),
        share=by_tension.sum().to_numpy(),
        size=by_tension.agg(lambda weights: effective_number(weights / weights.sum())).to_numpy(),
    )


def interval_rows(samples: pd.DataFrame, settings: dict) -> pd.DataFrame:
    """The median and the credible interval of each parameter, found on a logarithmic scale.

    The Monte Carlo errors come from the differences between the searches. Too few points give null.
    """
    ends = values_at(bounds_of(settings, PARAMETERS), settings, PARAMETERS)
    logs, bounds = ({name: log(np.asarray(of[name])) for name in PARAMETERS} for of in (samples, ends))
    weights, limits = samples.weight.to_numpy() / samples.weight.sum(), np.array(list(bounds.values()))

    def summary(shares: np.ndarray) -> np.ndarray:
        return np.clip(summarize(logs.values(), shares), limits[:, :1], limits[:, 1:])

    values = errors = np.full((len(PARAMETERS), 3), math.nan)
    if effective_number(weights) >= ENOUGH:
        values, errors = exp(summary(weights)), monte_carlo_error(weights, samples.search.to_numpy(), summary)
    rows = []
    for name, *numbers in zip(PARAMETERS, values, errors, strict=True):
        row = {"parameter": name, **with_errors(*numbers, is_log=True)}
        row["open_low"], row["open_high"] = open_ends(logs[name], weights, bounds[name])
        rows.append(row | {"covered": math.log(row["high"] / row["low"]) / np.ptp(bounds[name])})
    return pd.DataFrame(rows)


def make(edges: pd.DataFrame, settings: dict, *, threads: int = 1) -> dict[str, pd.DataFrame]:
    """The tables of numbers, fits, intervals, samples and frictions."""
    model, numbers = settings["model"], settings["numbers"]
    splines, printed = interpolate_edges(edges), searched(settings)

    def quantities(x: np.ndarray, tension: str, velocities: bool = True) -> dict[str, np.ndarray]:
        return measure_by_table(x, splines, tension, settings, converged_velocities if velocities else None)

    at_printed = {method: measure_directly(printed, method, settings, threads) for method in (EULER, CONVERGED)}
    shifts = {name: float(at_printed[EULER][name][0] - at_printed[CONVERGED][name][0]) for name in numbers}
    at_printed["interpolated"] = quantities(printed, model["tension"])
    rows = [number_rows(name, values, numbers) for name, values in at_printed.items()]
    tables: dict[str, list[pd.DataFrame]] = {"fits": [], "intervals": [], "samples": []}
    for name, evidence in EVIDENCE.items():
        samples, fits = infer(evidence, shifts if evidence["shifted"] else {}, quantities, settings)
        best = fits.loc[fits.total.idxmin()]
        at_best = quantities(searched(settings, **best[list(PARAMETERS)]), best.tension)
        rows.append(number_rows(name, at_best, numbers))
        of_evidence = {"samples": samples, "fits": fits, "intervals": interval_rows(samples, settings)}
        for kind, table in of_evidence.items():
            tables[kind].append(table.assign(evidence=name))
    grid = np.tile(printed, (FRICTIONS, 1))
    grid[:, 0] = log(np.linspace(*settings["ranges"]["friction"], FRICTIONS))
    along = quantities(grid, model["tension"])
    frictions = {"friction": exp(grid[:, 0])} | {name: along[number] for name, number in VELOCITIES.items()}
    return {kind: pd.concat(parts) for kind, parts in tables.items()} | {
        "numbers": pd.concat(rows),
        "frictions": pd.DataFrame(frictions),
    }
