"""Selection of bifurcations from the tables of orbits, solved again in the dimensionless groups."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor import groups_of, replace_parameters
from conveyor.analysis.bifurcations.bifurcation_points import (
    GRAZING,
    BifurcationPoint,
    at_phase_zero,
    find_bifurcation,
    touching_point,
)
from conveyor_pipeline.common import fields
from conveyor_pipeline.paper.sensitivity.limits import LONGEST_PERIOD, MOST

# Largest relative difference of the amplitudes of one bifurcation in two tables, or in a table and solved again.
SAME = 1e-6
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


def solve_again(parameters: np.ndarray, row: pd.Series) -> BifurcationPoint | None:
    """The bifurcation of a row of a table, solved in the groups; None if it is not found, or a different one is."""
    kind, period = row["kind"], int(row.period)
    here = replace_parameters(parameters, acceleration=row.acceleration)
    groups = groups_of(here)
    state = at_phase_zero(here, np.array([row.delta, row.v]))
    if state is None:
        return None
    is_grazing = kind == GRAZING
    guess = touching_point(groups, state, period) if is_grazing else np.append(state, groups.amplitude)
    point = None if guess is None else find_bifurcation(kind, period, guess, groups)
    is_same = point is not None and abs(point.groups.amplitude / groups.amplitude - 1.0) < SAME
    return point if is_same else None


def select_bifurcations(
    parameters: np.ndarray, bifurcations: pd.DataFrame, cascade: pd.DataFrame, doublings: int
) -> list[Selected]:
    """Folds, doublings and grazings up to LONGEST_PERIOD, by amplitude, then the first doublings of the cascade."""
    first = cascade.sort_values("number", kind="stable").head(doublings).assign(kind="period_doubling")
    others = bifurcations[bifurcations.period <= LONGEST_PERIOD].sort_values("acceleration", kind="stable")
    repeated = [
        ((first.period == row.period) & (abs(first.acceleration / row.acceleration - 1.0) < SAME)).any()
        and row.kind == "period_doubling"
        for row in others.itertuples()
    ]
    others = others[~np.array(repeated, dtype=bool)].assign(number=0)
    rows = pd.concat([others[others.groupby("kind").cumcount() < MOST], first])
    return [
        Selected(
            row["kind"],
            int(row.period),
            float(row.acceleration),
            solve_again(parameters, row),
            int(row.number),
            row["kind"] == GRAZING and row.impacts == 0,
        )
        for _, row in rows.iterrows()
    ]
