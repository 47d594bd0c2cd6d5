"""Where to run a conveyor so that its parts arrive fast, or evenly, and which change of a parameter helps there.

There are two aims. `fast`: the 5 % quantile of the transit velocity is largest, so that nearly all parts are fast.
`even`: the relative spread is least among the amplitudes with at least half of that quantile. Both must hold within a
range of the amplitude, because no drive holds its amplitude exactly: a margin, or what its supply does. The parts are
the varied ones.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import pandas as pd

from conveyor import RANGES, throw_number
from conveyor.packing import plate_peaks
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.machine.operating.parts import population, with_calibration
from conveyor_pipeline.machine.operating.populations import EVEN, FAST, PROBABILITIES, VARIED
from conveyor_pipeline.machine.operating.transit import (
    MEASURES,
    follow_parts,
    measure,
    spread_of,
    summarize_populations,
)

RESAMPLES = 400  # of the parts, for the standard errors of changes
KEPT = 0.9  # of the 5 % quantile at the advised amplitude, which a controller must keep
HALVINGS = 6  # of the step between two amplitudes, to find how far the amplitude may be off
STILL = 0.01  # of the largest velocity of the plate: slower parts do not count as parts that move forward
ENOUGH = 0.5  # of the largest 5 % quantile, which an even amplitude must have
AIM = fields.text("aim", f"{FAST}: largest 5 % quantile of the transit velocity, {EVEN}: least relative spread")
TABLES = {
    "advice": (
        AIM,
        fields.number("acceleration", "m/s²", "recommended amplitude of the excitation"),
        fields.number("throw_number", "1", "throw number Γ"),
        *MEASURES,
        fields.number("lowest", "m/s²", "lowest amplitude of the range within which the advice must hold"),
        fields.number("highest", "m/s²", "highest amplitude of this range"),
        fields.number("velocity_worst", "m/s", "smallest 5 % quantile of the velocity within the range"),
        fields.number("worst", "m/s²", "amplitude with this quantile"),
        fields.number("spread_worst", "1", "largest relative spread within the range"),
        fields.number("held_low", "m/s²", f"lowest amplitude down to which {KEPT:g} of the 5 % quantile is kept"),
        fields.number(
            "held_high",
            "m/s²",
            "the highest one; both are null without a supply, or if the slowest parts do not move ahead",
        ),
        fields.text("states", "states of motion at the nearest amplitude of the table of shares, with their shares"),
        fields.number("states_acceleration", "m/s²", "that amplitude"),
        fields.number("point_acceleration", "m/s²", "what would be recommended if blocks were points; null for points"),
        fields.number("point_velocity", "m/s", "5 % quantile of the velocity there, of blocks; null for points"),
    ),
    "changes": (
        AIM,
        fields.text("parameter", "changed parameter"),
        fields.number("value", "SI", "new value of the parameter"),
        *MEASURES,
        fields.number("gain", "1", "relative change of the 5 % quantile of the velocity, with the same parts"),
        fields.number("gain_stderr", "1", "standard error of gain, from resamples of the parts"),
        fields.number("widening", "1", "relative change of the relative spread, with the same parts"),
        fields.number("widening_stderr", "1", "standard error of widening, from resamples of the parts"),
    ),
}


def moves_forward(transit: pd.DataFrame) -> bool:
    """Whether more than 5 % of the parts move forward, and not only a little, at any amplitude."""
    _, conveyors = grid.product({"acceleration": transit.acceleration.tolist()}, transit.attrs["model"])
    return bool((transit.velocity_95 > STILL * plate_peaks(conveyors).vx).any())


def best(scores: np.ndarray, worst_of: Callable[[int], float]) -> int | None:
    """The place with the largest worst score within the range; None if no score is above -inf.

    scores : shape (m,), NaN where a score is not known
    worst_of : the worst score within the range of a place, which is not above the score of the place
    """
    chosen, highest = None, -np.inf
    for place in np.argsort(-scores, kind="stable"):
        if not scores[place] > highest:  # nor are the scores of the remaining places
            break
        if (worst := worst_of(int(place))) > highest:
            chosen, highest = int(place), worst
    return chosen


def choose(rows: pd.DataFrame, around: Callable[[int], pd.DataFrame], inside: Callable[[int], slice]) -> dict[str, int]:
    """The place of the recommended amplitude of each aim that can be met.

    rows : measures of varied parts over the amplitude
    around : the measures within the range of a place, and at its ends
    inside : the places of `rows` within the range of a place, which bound the worst score
    """

    def bounds(scores: np.ndarray) -> np.ndarray:
        return np.array([scores[inside(place)].min() for place in range(len(scores))])

    slowest = rows.velocity_05.to_numpy()
    fast = best(bounds(slowest), lambda place: around(place).velocity_05.min(skipna=False))
    if fast is None:
        return {}
    needed = ENOUGH * around(fast).velocity_05.min()
    if needed <= 0.0:
        return {FAST: fast}

    def evenness(measures: pd.DataFrame) -> np.ndarray:
        return np.where(measures.velocity_05 >= needed, -measures.spread, -np.inf)

    def worst_evenness(place: int) -> float:
        return evenness(around(place)).min()

    even = best(bounds(evenness(rows)), worst_evenness)
    if even is None:
        return {FAST: fast}
    # Ranges that overlap may have their worst spread in common.
    return {FAST: fast, EVEN: fast if worst_evenness(fast) >= worst_evenness(even) else even}


def beyond(amplitudes: np.ndarray, low: float, high: float) -> np.ndarray:
    """Amplitudes between low and high that continue a table of ascending amplitudes at its ends, in its steps."""
    if len(amplitudes) < 2:
        return np.zeros(0)
    below = np.arange(amplitudes[0], low, amplitudes[0] - amplitudes[1])[1:]
    return np.concatenate([below, np.arange(amplitudes[-1], high, amplitudes[-1] - amplitudes[-2])[1:]])


def held_range(
    amplitudes: np.ndarray, slowest: np.ndarray, place: int, measure_at: Callable[[np.ndarray], pd.DataFrame]
) -> tuple[float, float]:
    """The amplitudes (m/s²) around a place of a table between which the 5 % quantile stays above KEPT of its value.

    Bisection between two amplitudes of the table. At an end of the table, the amplitude of this end. NaN if the slowest
    parts do not move ahead.

    slowest : the 5 % quantile of the velocity at the amplitudes
    measure_at : the measures at further amplitudes
    """
    if not slowest[place] > 0.0:
        return np.nan, np.nan
    lowest = KEPT * slowest[place]
    ends = []
    for step in (-1, 1):
        edge = place
        while 0 <= edge + step < len(amplitudes) and slowest[edge + step] >= lowest:
            edge += step
        good = amplitudes[edge]
        if 0 <= edge + step < len(amplitudes):
            bad = amplitudes[edge + step]
            for _ in range(HALVINGS):
                middle = 0.5 * (good + bad)
                good, bad = (middle, bad) if measure_at(np.array([middle])).velocity_05[0] >= lowest else (good, middle)
        ends.append(float(good))
    return ends[0], ends[1]


def with_parameter(model: dict, parameter: str, value: float) -> dict:
    """A model with another value of one parameter; the static friction keeps its ratio to a friction above 0."""
    changed = {**model, parameter: value}
    if parameter == "friction" and "static_friction" in model:
        static, friction = model["static_friction"], model["friction"]
        changed["static_friction"] = static * value / friction if friction else max(static, value)
    return changed


def relative_change(after: np.ndarray, before: np.ndarray) -> np.ndarray:
    """The change in units of the size before; NaN for a size of 0."""
    return (after - before) / np.where(before, np.abs(before), np.nan)


def effects(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Relative changes of the 5 % quantile and of the relative spread of velocities, shape (..., parts), stacked."""
    old, new = (np.quantile(velocity, PROBABILITIES, axis=-1) for velocity in (before, after))
    return np.stack([relative_change(new[0], old[0]), relative_change(spread_of(new), spread_of(old))])


def compare(before: np.ndarray, after: np.ndarray, seed: int) -> dict[str, float]:
    """The effects of a change on the velocities of parts, shape (n,), and their standard errors.

    Resamples draw the same parts before and after the change (paired bootstrap: Efron and Tibshirani 1993).
    """
    if len(before) == 0:
        return dict.fromkeys(("gain", "widening", "gain_stderr", "widening_stderr"), np.nan)
    drawn = np.random.default_rng(seed).integers(len(before), size=(RESAMPLES, len(before)))
    (gain, widening), errors = effects(before, after), effects(before[drawn], after[drawn]).std(axis=-1, ddof=1)
    return {"gain": gain, "widening": widening, "gain_stderr": errors[0], "widening_stderr": errors[1]}


def neighbours(model: dict, changes: dict[str, float]) -> tuple[list[tuple[str, float]], list[tuple[str, float]]]:
    """Parameters with their values after changes up and down: those in the range of the model, and the others."""
    values = [(name, model[name] + sign * change) for name, change in changes.items() for sign in (-1.0, 1.0)]
    inside = [(name, value) for name, value in values if RANGES[name][0] <= value <= RANGES[name][1]]
    return inside, [pair for pair in values if pair not in inside]


def changes_at(acceleration: float, settings: dict, changes: dict[str, float], *, threads: int = 1) -> list[dict]:
    """Measures if one parameter at a time is increased or decreased, at an amplitude (m/s²)."""
    model = settings["model"]
    amplitude = np.array([acceleration])
    parts = settings["starts"]
    changed, _ = neighbours(model, changes)
    if not changed:
        return []
    models = [model, *(with_parameter(model, *change) for change in changed)]
    populations = [population(amplitude, {**settings, "model": changed_model}) for changed_model in models]
    run = follow_parts(np.concatenate(populations), settings, threads=threads)
    velocity, is_right = run.velocity[:, 0].reshape(-1, parts), (run.status == "ok").reshape(-1, parts)
    measures = summarize_populations(run, parts).to_dict("records")
    rows = []
    for place, (parameter, value) in enumerate(changed, start=1):
        both_right = is_right[0] & is_right[place]
        rows.append(
            measures[place]
            | compare(velocity[0, both_right], velocity[place, both_right], settings["seed"])
            | {"parameter": parameter, "value": value}
        )
    return rows


def describe_states(shares: pd.DataFrame, acceleration: float) -> dict[str, str | float]:
    """The states at the nearest amplitude of the table of shares, "chaos 85 %, second 15 %", and that amplitude."""
    nearest = shares.acceleration.iloc[(shares.acceleration - acceleration).abs().argmin()]
    by_state = (
        shares[shares.acceleration == nearest].groupby("state").share.sum().sort_values(ascending=False, kind="stable")
    )
    states = ", ".join(f"{state} {round(100.0 * share, 1):g} %" for state, share in by_state.items())
    return {"states": states, "states_acceleration": nearest}


def recommend(
    rows: pd.DataFrame, settings: dict, limits: tuple[float, float], threads: int
) -> tuple[dict[str, int], Callable[[int], pd.DataFrame], Callable[[np.ndarray], pd.DataFrame]]:
    """The places that `choose` returns; the measures around a place, and those at other amplitudes.

    rows : measures of varied parts over the amplitude
    limits : ends of the range within which the advice must hold, as multiples of the amplitude
    """
    amplitudes = rows.acceleration.to_numpy()
    (low, high) = limits

    def measure_at(further: np.ndarray) -> pd.DataFrame:
        return measure(further, settings, (VARIED,), threads=threads)

    def inside(place: int) -> slice:
        lowest, highest = amplitudes[place] * low, amplitudes[place] * high
        first, last = np.searchsorted(amplitudes, lowest, "right"), np.searchsorted(amplitudes, highest, "left")
        return slice(min(first, place), max(last, place + 1))

    @cache
    def around(place: int) -> pd.DataFrame:
        ends = np.array([amplitudes[place] * low, amplitudes[place] * high])
        return pd.concat([rows.iloc[inside(place)], measure_at(np.concatenate([ends, beyond(amplitudes, *ends)]))])

    return choose(rows, around, inside), around, measure_at


def make(
    transit: pd.DataFrame,
    shares: pd.DataFrame,
    settings: dict,
    samples: pd.DataFrame | None = None,
    parameters: pd.DataFrame | None = None,
    *,
    threads: int = 1,
) -> dict[str, dict]:
    """The columns of the tables of advice and of changes, without rows if no amplitude moves parts forward.

    samples, parameters : as in transit.make
    """
    followed = with_calibration(transit.attrs, samples, parameters)
    (low, high) = settings["range"]
    rows = transit[transit.population == VARIED].reset_index(drop=True)
    amplitudes = rows.acceleration.to_numpy()
    unit = throw_number(1.0, **followed["model"])
    places, around, measure_at = recommend(rows, followed, (low, high), threads)
    places = places if moves_forward(transit) else {}
    of_points = {}
    if "body" in followed and places:
        points = {name: value for name, value in followed.items() if name != "body"}
        of_points, *_ = recommend(measure(amplitudes, points, (VARIED,), threads=threads), points, (low, high), threads)
    advice, changes = [], []
    for aim, place in places.items():
        row = rows.iloc[place]
        within = around(place).reset_index(drop=True)
        held = (
            held_range(amplitudes, rows.velocity_05.to_numpy(), place, measure_at)
            if "supply" in settings
            else (np.nan,) * 2
        )
        worst = {
            "lowest": row.acceleration * low,
            "highest": row.acceleration * high,
            "velocity_worst": within.velocity_05.min(),
            "worst": within.acceleration[within.velocity_05.idxmin()],
            "spread_worst": within.spread.max(),
            "held_low": held[0],
            "held_high": held[1],
        }
        description = {"aim": aim, "throw_number": unit * row.acceleration} | describe_states(shares, row.acceleration)
        point_row = rows.iloc[of_points[aim]] if aim in of_points else {"acceleration": np.nan, "velocity_05": np.nan}
        description |= {"point_acceleration": point_row["acceleration"], "point_velocity": point_row["velocity_05"]}
        advice.append(row.to_dict() | worst | description)
        changed = changes_at(row.acceleration, followed, settings["changes"], threads=threads)
        changes += [{"aim": aim, **change} for change in changed]
    return {
        "advice": fields.columns(advice, TABLES["advice"]),
        "changes": fields.columns(changes, TABLES["changes"]),
    }
