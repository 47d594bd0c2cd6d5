"""The operating chart in words: advice, a summary and a table, with all numbers from the tables."""

import math

import numpy as np
import pandas as pd

from conveyor.parameters import UNITS
from operating.regimes import AIMS, CHAOS, ONE, REGIMES_OF_AIMS, SEVERAL, UNKNOWN, summarize_amplitudes
from pipeline.templates import render

# If none of n independent initial conditions does something, then with 95 % confidence at most a share of 3/n does it:
# -log(0.05) is 2.996.
RULE_OF_THREE = 3.0
WORTH_CHANGING = 0.01  # relative gain of velocity from which a change of a parameter is named
MOST_CHANGES = 4  # that are named


def summarize_shares(shares: pd.DataFrame) -> dict:
    """The settings (`search`), amplitudes (m/s²) and throw numbers of the table of shares.

    `unseen_share` is the largest share of initial conditions that may lead to a motion that none of the tested ones
    leads to.
    """
    amplitudes = np.sort(shares.acceleration.unique())
    return {
        "search": shares.attrs,
        "unseen_share": RULE_OF_THREE / shares.attrs["starts"],
        "amplitudes": amplitudes,
        "step": np.diff(amplitudes).max(initial=0.0),
        "throw_numbers": (shares.vertical.min(), shares.vertical.max()),
    }


def summarize_regimes(regimes: pd.DataFrame) -> dict[str, list[dict]]:
    """The rows of the table of regimes, those with one regime, and the row in which chaos begins."""
    names = {"one": ONE, "several": SEVERAL, "only_chaos": CHAOS, "unknown": UNKNOWN}
    parts = {name: regimes[regimes.regime == regime] for name, regime in names.items()}
    parts |= {"rows": regimes, "chaos": regimes[regimes.states.str.contains("chaos")].head(1)}
    return {name: rows.to_dict("records") for name, rows in parts.items()}


def select_changes(aim: str, changes: pd.DataFrame) -> list[dict]:
    """The changes of one parameter that raise the velocity most and keep a regime of the aim."""
    faster = changes[(changes.aim == aim) & (changes.gain > WORTH_CHANGING)]
    faster = faster[faster.regime.isin(REGIMES_OF_AIMS[aim])]
    return faster.sort_values("gain", ascending=False).head(MOST_CHANGES).to_dict("records")


def make(
    template: str, shares: pd.DataFrame, regimes: pd.DataFrame, advice: pd.DataFrame, changes: pd.DataFrame
) -> str:
    """The page from its template and the tables of shares, regimes, advice and changes."""
    values = summarize_shares(shares) | summarize_regimes(regimes)
    if values["several"]:
        amplitudes = summarize_amplitudes(shares, shares.attrs["same_velocity"])
        several = amplitudes[amplitudes.regime == SEVERAL]
        values["most"] = several.loc[several.best_share.idxmax()].to_dict()
    recommended = {
        row["aim"]: row | {"changes": select_changes(row["aim"], changes)}
        for row in advice.replace({np.nan: None}).to_dict("records")
    }
    values |= {
        "units": UNITS,
        "options": advice.attrs,
        # The digits to which the ends of intervals of amplitudes are known.
        "digits": max(0, math.ceil(-math.log10(shares.attrs["resolution"]))),
        "throw_per_amplitude": shares.vertical.iloc[0] / shares.acceleration.iloc[0],
        **{aim: recommended.get(aim) for aim in AIMS},
    }
    return render(template, values)
