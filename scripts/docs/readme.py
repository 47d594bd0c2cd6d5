"""The README, its numbers filled in from the tables."""

import numpy as np
import pandas as pd
from jinja2 import Environment, StrictUndefined

from figures.captions import bifurcation, fig10


def claim(claims: pd.DataFrame, name: str, column: str, place: int = 0) -> float:
    """One number of a claim."""
    return claims.set_index("id").loc[name, column][place]


def numbers(found: dict[str, pd.DataFrame]) -> dict[str, str]:
    """All that the template asks for, in words.

    Parameters
    ----------
    found : the tables claims, benchmark, edge, edge_euler, spectrum and cascade
    """
    claims, benchmark = found["claims"], found["benchmark"]
    default = benchmark[benchmark.chosen == "default"]
    edges = fig10({"converged": found["edge"], "euler": found["edge_euler"]}, {})
    chaos = bifurcation({"spectrum": found["spectrum"], "cascade": found["cascade"]}, {"longest_period": 0})
    return {
        "euler_positive": f"{claim(claims, 'C19', 'paper_method'):g}",
        "converged_positive": f"{claim(claims, 'C19', 'converged'):g}",
        "scatter": f"{claim(claims, 'C03', 'converged'):g}",
        "first_error": f"{100.0 * claim(claims, 'C22', 'paper_method', 0):.1f}",
        "second_error": f"{100.0 * claim(claims, 'C22', 'paper_method', 1):.1f}",
        "heights_least": edges["least"],
        "heights_most": edges["most"],
        "heights_most_at": edges["most_at"],
        "accumulation": chaos["accumulation"],
        "early_up": chaos["early_up"],
        "speeds": ", ".join(f"{row.speed:.0f} ({row.motion})" for row in default.itertuples()),
        "speeds_without": ", ".join(f"{row.speed_without:.0f}" for row in default.itertuples()),
        "tolerance": f"{default.tolerance.iloc[0]:.0e}".replace("e-0", "e-"),
        "worst_error": f"{np.max(default.error):.0e}".replace("e-0", "e-"),
        "wanted_missed": ", ".join(
            f"{row.case} ({row.speed:.0f} of {wanted:g})"
            for row in default.itertuples()
            if row.speed < (wanted := benchmark.attrs["cases"][row.case]["wanted"]["speed"])
        )
        or "none",
    }


def readme(template: str, figures: dict[str, dict], values: dict[str, str]) -> str:
    """The README from its template, the entries of the figures and the numbers."""
    environment = Environment(undefined=StrictUndefined, keep_trailing_newline=True)
    return environment.from_string(template).render(figures=figures, **values)


def make(template: str, figures: dict[str, dict], **found: pd.DataFrame) -> str:
    """The README from its template, the entries of the figures, and the tables that `numbers` asks for."""
    return readme(template, figures, numbers(found))
