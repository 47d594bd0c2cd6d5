"""The operating chart in words: advice, a summary and a table, with all numbers from the tables."""

import math
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from conveyor.parameters import UNITS
from operating.regimes import AIMS, CHAOS, ONE, REGIMES_OF_AIMS, SEVERAL, UNKNOWN, best_of
from pipeline.templates import render

# If none of n independent initial conditions does something, then with 95 % confidence at most a share of 3/n does it:
# -log(0.05) is 2.996.
RULE_OF_THREE = 3.0
WORTH_CHANGING = 0.01  # relative gain of velocity from which a change of a parameter is named
MOST_CHANGES = 4  # that are named


def rounded(value: float, digits: int = 3) -> str:
    """A number to some significant digits, without an exponent: "0.0648", "1240"."""
    return np.format_float_positional(float(f"{value:.{digits - 1}e}"), trim="-")


def numbers(low: float, high: float, factor: float = 1.0) -> str:
    """ "0.0648 to 0.141", or one number where both are equal to three digits."""
    if math.isnan(low):
        return "not known"
    both = [rounded(factor * value) for value in (low, high)]
    return both[0] if both[0] == both[1] else f"{both[0]} to {both[1]}"


def listed(parts: list[str]) -> str:
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)


def places(begin: pd.Series, end: pd.Series, resolution: float) -> str:
    """Intervals of amplitudes (m/s²), to the digits that are known."""
    digits = max(0, math.ceil(-math.log10(resolution)))
    ends = [(f"{first:.{digits}f}", f"{last:.{digits}f}") for first, last in zip(begin, end, strict=True)]
    return listed([first if first == last else f"{first} to {last}" for first, last in ends])


def regular(shares: pd.DataFrame, regimes: pd.DataFrame) -> dict[str, str]:
    """Where all initial conditions lead to one velocity, where to several, and which share reaches the largest one."""
    resolution = shares.attrs["resolution"]
    one, several = regimes[regimes.regime == ONE], regimes[regimes.regime == SEVERAL]
    found = {
        "one": listed(
            [
                f"{places([row.begin], [row.end], resolution)} m/s² ({row.states.replace(', ', ' and ')} state, "
                f"{numbers(row.velocity_low, row.best_high)} m/s)"
                for row in one.itertuples()
            ]
        )
        if len(one)
        else "",
        "several": places(several.begin, several.end, resolution) if len(several) else "",
    }
    if several.empty:
        return found
    best = best_of(shares, shares.attrs["same_velocity"])
    within = [best.acceleration.between(row.begin, row.end) for row in several.itertuples()]
    best = best[np.logical_or.reduce(within)]
    most = best.loc[best.best_share.idxmax()]
    return found | {
        "several_best": numbers(several.best_low.min(), several.best_high.max()),
        "several_share": numbers(several.best_share_low.min(), several.best_share_high.max(), 100.0),
        "most_share": f"{100.0 * most.best_share:.1f}",
        "most_stderr": f"{100.0 * most.stderr:.1f}",
        "most_at": f"{most.acceleration:.4g}",
        "most_best": f"{most.best:.3g}",
    }


def irregular(regimes: pd.DataFrame, resolution: float) -> dict[str, str]:
    """Where chaos begins, where there is nothing but chaos, and where the velocity is not known."""
    chaotic = regimes[regimes.states.str.contains("chaos")].begin.head(1)
    found = {"chaos": places(chaotic, chaotic, resolution) if len(chaotic) else ""}
    for name, regime in (("only", CHAOS), ("unknown", UNKNOWN)):
        rows = regimes[regimes.regime == regime]
        found[name] = places(rows.begin, rows.end, resolution) if len(rows) else ""
    return found


def search_numbers(shares: pd.DataFrame) -> dict[str, str]:
    """Initial conditions, amplitudes and resolution of the table of shares."""
    search = shares.attrs
    amplitudes = np.sort(shares.acceleration.unique())
    return {
        "starts": str(search["starts"]),
        "heights_mm": numbers(*search["height"], 1e3),
        "velocities": numbers(*search["vz0"]),
        "phases": numbers(*search["psi0"]),
        "amplitudes": str(len(amplitudes)),
        "lowest": f"{amplitudes[0]:g}",
        "highest": f"{amplitudes[-1]:g}",
        "vertical": numbers(shares.vertical.min(), shares.vertical.max()),
        "others": f"{100.0 * RULE_OF_THREE / search['starts']:.2g}",
        "resolution": f"{search['resolution']:.2g}",
        "step": f"{np.diff(amplitudes).max(initial=0.0):.3g}",
        "same_velocity": f"{100.0 * search['same_velocity']:g}",
    }


def rows_of(regimes: pd.DataFrame, shares: pd.DataFrame) -> list[list[str]]:
    """The cells of the table, a row for each interval of amplitudes."""
    unit = shares.vertical.iloc[0] / shares.acceleration.iloc[0]
    return [
        [
            places([row.begin], [row.end], shares.attrs["resolution"]),
            numbers(row.begin, row.end, unit),
            row.regime,
            row.states,
            numbers(row.best_low, row.best_high),
            numbers(row.best_share_low, row.best_share_high, 100.0),
            numbers(row.velocity_low, row.velocity_low),
        ]
        for row in regimes.itertuples()
    ]


def with_unit(parameter: str, value: float) -> str:
    """ "0.17", "49 Hz"; angles in degrees."""
    if UNITS[parameter] == "rad":
        return f"{rounded(math.degrees(value))}°"
    return rounded(value, 4) + ("" if UNITS[parameter] == "1" else f" {UNITS[parameter]}")


def written_change(row: NamedTuple, before: float) -> str:
    """ "friction of 0.17 (now 0.15): +12 %, one velocity"."""
    values = f"{with_unit(row.parameter, row.value)} (now {with_unit(row.parameter, before)})"
    return f"{row.parameter.replace('_', ' ')} of {values}: {100.0 * row.gain:+.0f} %, {row.regime}"


def advised(shares: pd.DataFrame, advice: pd.DataFrame, changes: pd.DataFrame) -> dict[str, Any]:
    """What to do, by its aim; an aim that cannot be met is None."""
    options, model = advice.attrs, shares.attrs["model"]
    found = dict.fromkeys(AIMS)
    for row in advice.itertuples():
        faster = changes[(changes.aim == row.aim) & (changes.gain > WORTH_CHANGING)]
        faster = faster[faster.regime.isin(REGIMES_OF_AIMS[row.aim])]
        faster = faster.sort_values("gain", ascending=False).head(MOST_CHANGES)
        length = options.get("part_length")
        found[row.aim] = {
            "acceleration": rounded(row.acceleration, 4),
            "throw_number": rounded(row.throw_number),
            "state": row.state,
            "period": str(row.period),
            "velocity": rounded(row.mean_velocity),
            "parts": rounded(60.0 * row.mean_velocity / length) if length else "",
            "all": row.stderr == 0.0,
            "share": f"{100.0 * row.share:.1f}",
            "stderr": f"{100.0 * row.stderr:.1f}",
            "knock": "" if np.isnan(row.knock) else rounded(row.knock, 2),
            "largest_kick": rounded(row.largest_kick, 2),
            "impact_speed": rounded(row.impact_speed, 2),
            "peak_force": rounded(row.peak_force, 2),
            "weights": rounded(row.peak_force / (model["mass"] * model["gravity"]), 2),
            "textbook": "" if np.isnan(row.textbook) else rounded(row.textbook),
            "changes": [written_change(change, model[change.parameter]) for change in faster.itertuples()],
        }
    return found | {
        "margin": f"{100.0 * options['margin']:g}",
        "part_length": f"{1e3 * options['part_length']:g}" if "part_length" in options else "",
    }


def make(
    template: str, shares: pd.DataFrame, regimes: pd.DataFrame, advice: pd.DataFrame, changes: pd.DataFrame
) -> str:
    """The page from its template and the tables of shares, regimes, advice and changes."""
    resolution = shares.attrs["resolution"]
    values = regular(shares, regimes) | irregular(regimes, resolution) | search_numbers(shares)
    return render(template, values | advised(shares, advice, changes) | {"rows": rows_of(regimes, shares)})
