"""Changes of bifurcation amplitudes and critical heights by one per cent of each parameter."""

from collections.abc import Callable, Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor import (
    accumulation_point,
    amplitude_of,
    classify,
    groups_of,
    length_and_speed_units,
    replace_parameters,
)
from conveyor.analysis.bifurcations.bifurcation_points import BifurcationPoint, find_bifurcation
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.paper.motion.boundary_scan import locate_change
from conveyor_pipeline.paper.sensitivity.limits import UNEVEN
from conveyor_pipeline.paper.sensitivity.selection import COLUMNS, select_bifurcations

TABLES = {
    "changes": (
        fields.text("kind", "fold, period_doubling, grazing, accumulation, critical_amplitude or critical_height"),
        fields.count("period", "excitation cycles, of a bifurcation; 0 for none"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height; null for bifurcations"),
        *COLUMNS,
        fields.text("moved", "quantity that changes: acceleration (m/s²) or z0 (m)"),
        fields.text("parameter", "varied parameter; all remaining ones are constant"),
        fields.number("change", "see moved", "change by 1 % of the parameter: half the difference of +1 % and -1 %"),
        fields.number("elasticity", "1", "relative change of the quantity by that of the parameter; null if it is 0"),
        fields.text("status", "ok, or the reason for no result"),
    ),
}
# By an effort of 1.
DOUBLINGS = 5  # of the cascade; the last four give the point at which it accumulates
HEIGHTS = 4  # amplitudes with a critical height, evenly spread
VARIED = ("acceleration", "angle", "frequency", "stiffness", "damping", "mass", "gravity")
PART = 0.01  # relative change of a parameter
# Steps to the changed parameters, each of which begins Newton's iteration at the line through the last two solutions.
STEPS = 5
# Largest difference of the changes by +1 % and -1 %, relative to their mean or to 1 % of the quantity's scale: else,
# another point was found, or the boundary is not smooth, and the status is UNEVEN.
LARGEST = 0.2
REST = (0.0, 0.0)  # m, m/s: the initial condition of Fig. 3, whose critical amplitude changes
# A change of state is located to this part of the amplitude or of the unit of length, and lies within REACH of the
# amplitudes and heights in the table. It moves less than MOVE when a parameter changes.
RESOLUTION, REACH = 1e-12, {"acceleration": 0.1, "z0": 5e-3}
MOVE = {"acceleration": 0.03, "z0": 0.1}
BOUNDARY_TOLERANCE = 1e-13  # of the contact steps of trajectories near a boundary


class MovedPoint(NamedTuple):
    """A bifurcation, or a point of a basin boundary, that moves with the parameters."""

    kind: str
    period: int
    parameters: np.ndarray  # of the point, a table of shape ()
    quantity: str  # acceleration or z0
    # The quantity (m/s² or m) for other parameters, NaN if not found; None if the point itself is not found.
    solve: Callable[[np.ndarray], float] | None = None
    status: str = "ok"
    doubling: int = 0
    rides: bool = False

    @property
    def is_boundary(self) -> bool:
        """Whether this is a point of a basin boundary."""
        return self.kind.startswith("critical")


def amplitude_group(point: BifurcationPoint, groups: NamedTuple) -> float:
    """Γ of a bifurcation for other groups D and K, which are reached in STEPS; NaN if it is not found again."""
    previous, current = point.unknown, point.unknown
    begin, end = (np.log(np.maximum([pair.damping, pair.stiffness], 1e-300)) for pair in (point.groups, groups))
    for step in range(1, STEPS + 1):
        damping, stiffness = np.exp(begin + step / STEPS * (end - begin))
        between = groups._replace(damping=float(damping), stiffness=float(stiffness)) if step < STEPS else groups
        bifurcation = find_bifurcation(point.kind, point.period, 2.0 * current - previous, between)
        if bifurcation is None:
            return np.nan
        previous, current = current, bifurcation.unknown
    return float(current[-1])


def moved_bifurcations(parameters: np.ndarray, selected: list) -> Iterator[MovedPoint]:
    """The bifurcations of the tables, as points that move."""
    for bifurcation in selected:
        point = bifurcation.point
        label = {name: getattr(bifurcation, name) for name in ("kind", "period", "doubling", "rides")}
        conveyor = replace_parameters(parameters, acceleration=bifurcation.acceleration)
        if point is None:
            yield MovedPoint(**label, parameters=conveyor, quantity="acceleration", status="not found again")
            continue
        find = cache(lambda groups, point=point: amplitude_group(point, groups))

        def solve(row, find=find, point=point):
            # The amplitude is an unknown: parameters with equal other groups share a solution.
            return amplitude_of(row, find(groups_of(row)._replace(amplitude=point.groups.amplitude)))

        conveyor = replace_parameters(parameters, acceleration=amplitude_of(parameters, point.groups.amplitude))
        yield MovedPoint(**label, parameters=conveyor, quantity="acceleration", solve=solve)


def moved_accumulation(parameters: np.ndarray, doublings: list[MovedPoint]) -> MovedPoint | None:
    """The accumulation point of period doublings; None where there is none, or where one of them is not found."""
    last = doublings[-4:]
    limit, _ = accumulation_point(np.array([float(doubling.parameters["acceleration"]) for doubling in last]))
    if np.isnan(limit) or any(doubling.solve is None for doubling in last):
        return None

    def solve(row):
        return accumulation_point(np.array([doubling.solve(row) for doubling in last]))[0]

    conveyor = replace_parameters(parameters, acceleration=limit)
    return MovedPoint("accumulation", 0, conveyor, "acceleration", solve)


def state_of(parameters: np.ndarray) -> np.ndarray:
    """The states of motion of a table of parameters, shape (n,), near a boundary of their basins."""
    return classify(parameters, tolerance=BOUNDARY_TOLERANCE).state


def moved_boundary(kind: str, parameters: np.ndarray, quantity: str) -> MovedPoint:
    """A point of a basin boundary near an initial condition."""
    scale = scale_of(parameters, quantity)

    def locate(row, reach):
        return locate_change(row[None], quantity, reach * scale, state_of, RESOLUTION * scale).item()

    value = locate(parameters, REACH[quantity])
    if np.isnan(value):
        return MovedPoint(kind, 0, parameters, quantity, status="no change of state near it")
    conveyor = replace_parameters(parameters, **{quantity: value})
    return MovedPoint(kind, 0, conveyor, quantity, lambda row: locate(row, MOVE[quantity]))


def scale_of(parameters: np.ndarray, quantity: str) -> float:
    """The amplitude (m/s²), or the unit of length (m), of one conveyor."""
    return float(parameters["acceleration"]) if quantity == "acceleration" else length_and_speed_units(parameters)[0]


def boundary_points(critical: pd.DataFrame, heights: int) -> Iterator[MovedPoint]:
    """The critical amplitude of a part from rest, and `heights` critical heights; none without a critical height."""
    parameters = grid.row_of({**critical.attrs["model"], "z0": 0.0})
    edges = critical[critical.is_critical].sort_values("acceleration", kind="stable")
    if edges.empty:
        return
    part = parameters.copy()
    part["z0"], part["vz0"] = REST
    # The amplitude whose critical height is closest to rest is the initial guess.
    part = replace_parameters(part, acceleration=edges.acceleration.iloc[int(np.argmin(abs(edges.z0 - part["z0"])))])
    yield moved_boundary("critical_amplitude", part, "acceleration")
    # Evenly spaced rows without the first and the last one.
    inner = np.linspace(0, len(edges) - 1, heights + 2)[1:-1].round().astype(int)
    for edge in edges.iloc[np.unique(inner)].itertuples():
        conveyor = replace_parameters(parameters, acceleration=edge.acceleration)
        conveyor["z0"] = edge.z0
        yield moved_boundary("critical_height", conveyor, "z0")


def change_by_one_per_cent(point: MovedPoint, parameter: str) -> tuple[float, str]:
    """Half the difference of the quantity between 1 % more and 1 % less of a parameter, and the status."""
    if point.solve is None:
        return np.nan, point.status
    value = float(point.parameters[point.quantity])
    ends = []
    for sign in (1.0, -1.0):
        row = point.parameters.copy()
        row[parameter] *= 1.0 + sign * PART
        ends.append(point.solve(row))
    change = 0.5 * (ends[0] - ends[1])
    if np.isnan(change):
        return np.nan, "not found again beside it"
    uneven = abs(ends[0] + ends[1] - 2.0 * value)
    if uneven > LARGEST * max(abs(change), PART * scale_of(point.parameters, point.quantity)):
        return np.nan, UNEVEN
    return change, "ok"


def rows_of_point(point: MovedPoint) -> Iterator[dict]:
    """The rows of a point, one for each parameter."""
    moved = float(point.parameters[point.quantity])
    for name in VARIED:
        if name == point.quantity:
            continue
        change, status = change_by_one_per_cent(point, name)
        yield {
            "kind": point.kind,
            "period": point.period,
            "acceleration": float(point.parameters["acceleration"]),
            "z0": float(point.parameters["z0"]) if point.is_boundary else np.nan,
            "doubling": point.doubling,
            "rides": point.rides,
            "moved": point.quantity,
            "parameter": name,
            "change": change,
            "elasticity": change / (PART * moved) if moved != 0.0 else np.nan,
            "status": status,
        }


def make(
    folds_and_doublings: pd.DataFrame, cascade: pd.DataFrame, critical: pd.DataFrame, settings: dict
) -> dict[str, np.ndarray]:
    """The columns of the table, for the section `sensitivity` of the config."""
    parameters = grid.row_of(settings["model"])
    doublings = max(1, round(settings["effort"] * DOUBLINGS))
    selected = select_bifurcations(parameters, folds_and_doublings, cascade, doublings)
    bifurcations = list(moved_bifurcations(parameters, selected))
    accumulation = moved_accumulation(parameters, [point for point in bifurcations if point.doubling])
    heights = max(1, round(settings["effort"] * HEIGHTS))
    points = [*bifurcations, *([accumulation] if accumulation else []), *boundary_points(critical, heights)]
    return fields.columns([row for point in points for row in rows_of_point(point)], TABLES["changes"])
