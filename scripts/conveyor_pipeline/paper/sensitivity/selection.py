"""Selection of bifurcations from the tables of orbits, solved again in the dimensionless groups."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor import replace_parameters
from conveyor.analysis.bifurcations.bifurcation_points import GRAZING, SAME, BifurcationPoint, bifurcation_near
from conveyor_pipeline.common import fields
from conveyor_pipeline.paper.sensitivity.limits import LONGEST_PERIOD, MOST

COLUMNS = (
    fields.count("doubling", "number of the period doubling in the cascade of the jumping orbit; 0 for none"),
    fields.flag("rides", "for a grazing: whether the part never leaves the plate at smaller amplitudes"),
)


class Selected(NamedTuple):
    """A bifurcation of a table."""

    kind: str
    period: int
    acceleration: float  # m/s², from the table
    point: BifurcationPoint | None  # None if Newton's method does not find it again
    doubling: int  # number in the cascade; 0 for none
    rides: bool  # for a grazing: whether the part never leaves the plate at smaller amplitudes


def select_bifurcations(
    parameters: np.ndarray, bifurcations: pd.DataFrame, cascade: pd.DataFrame, doublings: int
) -> list[Selected]:
    """Folds, doublings and grazings up to LONGEST_PERIOD, by amplitude, then the first doublings of the cascade."""
    first = cascade.sort_values("number", kind="stable").head(doublings).assign(kind="period_doubling")
    candidates = bifurcations[bifurcations.period <= LONGEST_PERIOD].sort_values("acceleration", kind="stable")
    repeated = [
        ((first.period == row.period) & (abs(first.acceleration / row.acceleration - 1.0) < SAME)).any()
        and row.kind == "period_doubling"
        for row in candidates.itertuples()
    ]
    candidates = candidates[~np.array(repeated, dtype=bool)].assign(number=0)
    rows = pd.concat([candidates[candidates.groupby("kind").cumcount() < MOST], first])
    return [
        Selected(
            row["kind"],
            int(row.period),
            float(row.acceleration),
            bifurcation_near(
                replace_parameters(parameters, acceleration=row.acceleration),
                row["kind"],
                np.array([row.delta, row.v]),
                int(row.period),
            ),
            int(row.number),
            row["kind"] == GRAZING and row.impacts == 0,
        )
        for _, row in rows.iterrows()
    ]
