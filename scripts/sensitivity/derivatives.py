"""Derivatives of bifurcation amplitudes and critical heights by each parameter and by each dimensionless group."""

from collections.abc import Callable, Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor import (
    GROUP_NAMES,
    GROUP_OF,
    PARAMETER_OF,
    PARAMETERS,
    UNITS,
    accumulation_point,
    amplitude_of,
    classify,
    derivatives_by_groups,
    derivatives_of_groups,
    differentiate_unknowns,
    find_bifurcation,
    groups_of,
    length_and_speed_units,
    locate_change,
    replace_parameters,
    scaled_start,
)
from conveyor.linear_algebra import product
from pipeline import fields, grid
from sensitivity.selection import COLUMNS, Selected, select_bifurcations

POINT = (
    fields.text("kind", "fold, period_doubling, grazing, accumulation, critical_amplitude or critical_height"),
    fields.count("period", "excitation cycles, of a bifurcation; 0 for none"),
    fields.number("acceleration", "m/s²", "amplitude of the excitation"),
    fields.number("z0", "m", "initial height; null for bifurcations"),
    *COLUMNS,
)
TABLES = {
    "derivatives": (
        *POINT,
        fields.text("moved", "differentiated quantity: acceleration or z0"),
        fields.text("moved_unit", "unit of the differentiated quantity"),
        fields.text("parameter", "varied parameter; all remaining ones are constant"),
        fields.text("parameter_unit", "unit of the parameter"),
        fields.number("value", "see parameter_unit", "value of the parameter"),
        fields.number("derivative", "moved_unit per parameter_unit", "derivative, from the derivatives by the groups"),
        fields.number(
            "difference",
            "moved_unit per parameter_unit",
            "finite difference between points solved again",
        ),
        fields.number("elasticity", "1", "relative change of the quantity by that of the parameter; null if one is 0"),
        fields.text("status", "ok, or the reason for no result, or that both derivatives disagree"),
    ),
    "groups": (
        *POINT,
        fields.text("moved", "differentiated quantity: amplitude Γ = a_z/g, or height z0 ω²/g"),
        fields.number("moved_value", "1", "value of the quantity"),
        fields.text("group", "damping d_c/(m ω), stiffness (k_c/m) g^(p-1)/ω^(2p), exponent, height, velocity ż0 ω/g"),
        fields.number("value", "1", "value of the group"),
        fields.number("derivative", "1", "derivative of the quantity by the group"),
        fields.number("elasticity", "1", "relative change of the quantity by that of the group; null if one is 0"),
        fields.text("status", "ok, or the reason for no result"),
    ),
}
# By an effort of 1.
DOUBLINGS = 8  # of the cascade, from which derivatives are extrapolated to its accumulation
HEIGHTS = 4  # amplitudes with a critical height, evenly spread
# Groups with an influence on bifurcations, and on points of basin boundaries.
BIFURCATION_GROUPS, BOUNDARY_GROUPS = ("damping", "stiffness", "exponent"), GROUP_NAMES[:-1]
INITIAL_CONDITION = ("z0", "vz0")
REST = (0.0, 0.0)  # m, m/s: the initial condition of Fig. 3, whose critical amplitude is differentiated
# The tension mode, which is not a number, and parameters of the motion along the track.
EXCLUDED = ("tension", "phase_shift", "static_friction")
# A change of state is located to this part of the amplitude or of the unit of length. It moves less than MOVE when a
# parameter changes, and lies within REACH of the amplitudes and heights in the table.
RESOLUTION, MOVE, REACH = 1e-14, 5e-3, {"acceleration": 0.1, "z0": 5e-3}
BOUNDARY_TOLERANCE = 1e-13  # of the contact steps of trajectories near a boundary
GROUP_DIFFERENCE = 1e-4  # relative change of a parameter in the differences that give derivatives of a boundary
DIFFERENCE = 3e-5  # relative change of a parameter in the finite differences that check the derivatives
# Largest relative difference of both results; absolute for elasticities below 1.
AGREEMENT = 1e-5


class CriticalPoint(NamedTuple):
    """A bifurcation, or a point of a basin boundary, with the derivatives of its amplitude or initial height."""

    kind: str
    period: int
    parameters: np.ndarray  # of the point, a table of shape ()
    quantity: str  # acceleration or z0
    status: str = "ok"
    derivatives: np.ndarray | None = None  # of the quantity's group by all groups, shape (7,); None without a result
    # The quantity (m/s² or m) for other parameters, NaN if not found; None without derivatives.
    solve: Callable[[np.ndarray], float] | None = None
    doubling: int = 0
    rides: bool = False

    @property
    def is_boundary(self) -> bool:
        """Whether this is a point of a basin boundary."""
        return self.kind.startswith("critical")


def differentiate_bifurcation(parameters: np.ndarray, bifurcation: Selected) -> CriticalPoint:
    """A bifurcation with the derivatives of its amplitude."""
    point = bifurcation.point
    label = {name: getattr(bifurcation, name) for name in ("kind", "period", "doubling", "rides")}
    moves = None if point is None else differentiate_unknowns(point)
    if moves is None:
        return CriticalPoint(
            **label,
            parameters=replace_parameters(parameters, acceleration=bifurcation.acceleration),
            quantity="acceleration",
            status="not found again" if point is None else "singular",
        )

    @cache
    def find_amplitude(groups):
        guess = point.unknown + product(moves, np.array(groups[1:4]) - point.groups[1:4])
        there = find_bifurcation(bifurcation.kind, bifurcation.period, guess, groups)
        return np.nan if there is None else there.groups.amplitude

    derivatives = np.zeros(len(GROUP_NAMES))
    for name in BIFURCATION_GROUPS:
        value = getattr(point.groups, name)
        step = GROUP_DIFFERENCE * (value if value > 0.0 else 1.0)
        ends = [find_amplitude(point.groups._replace(**{name: value + part})) for part in (step, -step)]
        derivatives[GROUP_NAMES.index(name)] = (ends[0] - ends[1]) / (2.0 * step)

    def solve(row):
        # The amplitude is an unknown: parameters with equal other groups share a solution.
        groups = groups_of(row)._replace(amplitude=point.groups.amplitude)
        return amplitude_of(row, find_amplitude(groups))

    here = replace_parameters(parameters, acceleration=amplitude_of(parameters, point.groups.amplitude))
    return CriticalPoint(**label, parameters=here, quantity="acceleration", derivatives=derivatives, solve=solve)


def aitken_weights(a: float, b: float, c: float) -> np.ndarray:
    """Derivatives of the limit a - (b - a)²/(c - 2b + a) of Aitken's process by the three amplitudes, shape (3,)."""
    part = (b - a) / (c - 2.0 * b + a)
    return np.array([(1.0 + part) ** 2, -2.0 * part * (1.0 + part), part**2])


def differentiate_accumulation(parameters: np.ndarray, doublings: list[CriticalPoint]) -> CriticalPoint | None:
    """The accumulation point of period doublings; None where there is none, or without their derivatives."""
    last = doublings[-4:]
    amplitudes = np.array([float(doubling.parameters["acceleration"]) for doubling in last])
    limit, _ = accumulation_point(amplitudes)
    if np.isnan(limit) or any(doubling.derivatives is None for doubling in doublings):
        return None
    slopes_of_last = np.array([doubling.derivatives for doubling in last[1:]])
    derivatives = product(slopes_of_last.T, aitken_weights(*amplitudes[1:]))

    def solve(row):
        return accumulation_point(np.array([doubling.solve(row) for doubling in last]))[0]

    here = replace_parameters(parameters, acceleration=limit)
    return CriticalPoint("accumulation", 0, here, "acceleration", derivatives=derivatives, solve=solve)


def state_of(parameters: np.ndarray) -> np.ndarray:
    """The states of motion of a table of parameters, shape (n,), near a boundary of their basins."""
    return classify(parameters, tolerance=BOUNDARY_TOLERANCE).state


def differentiate_boundary(kind: str, parameters: np.ndarray, quantity: str, reach: float) -> CriticalPoint:
    """A point of a basin boundary near an initial condition, with the derivatives of its amplitude or height.

    reach : how far the point may be from the initial condition, as a part of the amplitude or of the unit of length
    """
    scale = float(parameters["acceleration"]) if quantity == "acceleration" else length_and_speed_units(parameters)[0]

    def solve(row, reach=MOVE):
        return locate_change(row[None], quantity, reach * scale, state_of, RESOLUTION * scale).item()

    value = solve(parameters, reach)
    if np.isnan(value):
        return CriticalPoint(kind, 0, parameters, quantity, status="no change of state near it")
    here = replace_parameters(parameters, **{quantity: value})
    steps = difference_steps(here, GROUP_DIFFERENCE)
    by = {name: difference_quotient(solve, here, name, steps[name]) for name in PARAMETER_OF.values()}
    derivatives = derivatives_by_groups(quantity, here, by)
    if not np.isfinite(derivatives).all():
        return CriticalPoint(kind, 0, here, quantity, status="not found again beside it")
    return CriticalPoint(kind, 0, here, quantity, derivatives=derivatives, solve=solve)


def difference_quotient(
    function: Callable[[np.ndarray], float], parameters: np.ndarray, name: str, step: float
) -> float:
    """Derivative of a function of one row of parameters by one of them, by a central difference."""
    ends = []
    for sign in (1.0, -1.0):
        row = parameters.copy()
        row[name] += sign * step
        ends.append(function(row))
    return (ends[0] - ends[1]) / (2.0 * step)


def difference_steps(parameters: np.ndarray, part: float) -> dict[str, float]:
    """Step of the finite differences by each parameter: a part of its value, or of its scale if it may be 0."""
    length, velocity = length_and_speed_units(parameters)
    scales = {name: abs(float(parameters[name])) for name in PARAMETERS} | {"psi0": 1.0, "z0": length, "vz0": velocity}
    scales = {name: scale if scale > 0.0 else 1.0 for name, scale in scales.items()}
    return {name: part * float(scale) for name, scale in scales.items()}


def point_columns(point: CriticalPoint) -> dict:
    """The columns that both tables share."""
    row = point.parameters
    return {
        "kind": point.kind,
        "period": point.period,
        "acceleration": float(row["acceleration"]),
        "z0": float(row["z0"]) if point.is_boundary else np.nan,
        "doubling": point.doubling,
        "rides": point.rides,
        "moved": point.quantity,
    }


def physical_rows(point: CriticalPoint) -> Iterator[dict]:
    """The rows of the table `derivatives` of a point, one for each parameter."""
    exact = None
    if point.derivatives is not None:
        exact = derivatives_of_groups(point.quantity, point.parameters, point.derivatives)
    moved = float(point.parameters[point.quantity])
    for name, step in difference_steps(point.parameters, DIFFERENCE).items():
        value = float(point.parameters[name])
        if name in (point.quantity, *EXCLUDED) or (name in INITIAL_CONDITION and not point.is_boundary):
            continue
        if name == "inclination" and value == 0.0:
            continue  # gravity normal to the track is largest there: no influence to first order
        row = {
            **point_columns(point),
            "moved_unit": UNITS[point.quantity],
            "parameter": name,
            "parameter_unit": UNITS[name],
            "value": value,
            "derivative": np.nan,
            "difference": np.nan,
            "elasticity": np.nan,
            "status": point.status,
        }
        if exact is not None:
            row["derivative"] = exact[name]
            row["difference"] = difference_quotient(point.solve, point.parameters, name, step)
            row["elasticity"] = exact[name] * value / moved if value != 0.0 and moved != 0.0 else np.nan
            # Makes derivatives dimensionless: scale of the parameter over scale of the quantity.
            scale = (
                step
                / DIFFERENCE
                / (abs(moved) if point.quantity == "acceleration" else length_and_speed_units(point.parameters)[0])
            )
            error = scale * abs(row["derivative"] - row["difference"])
            if not error <= AGREEMENT * max(1.0, scale * abs(row["derivative"])):
                row["status"] = "differences disagree" if np.isfinite(error) else "not found again beside it"
        yield row


def group_rows(point: CriticalPoint) -> Iterator[dict]:
    """The rows of the table `groups` of a point, one for each group."""
    own = GROUP_OF[point.quantity]
    groups = np.array([*groups_of(point.parameters)[:4], *scaled_start(point.parameters)])
    for name in BOUNDARY_GROUPS if point.is_boundary else BIFURCATION_GROUPS:
        place = GROUP_NAMES.index(name)
        if place == own:
            continue
        derivative = np.nan if point.derivatives is None else point.derivatives[place]
        relative = groups[place] / groups[own] if groups[place] != 0.0 and groups[own] != 0.0 else np.nan
        yield {
            **point_columns(point),
            "moved": GROUP_NAMES[own],
            "moved_value": groups[own],
            "group": name,
            "value": groups[place],
            "derivative": derivative,
            "elasticity": derivative * relative,
            "status": point.status,
        }


def boundary_points(critical: pd.DataFrame, heights: int) -> Iterator[CriticalPoint]:
    """The critical amplitude of a part from rest, and `heights` critical heights; none without a critical height."""
    parameters = grid.row_of({**critical.attrs["model"], "z0": 0.0})
    edges = critical[critical.is_critical].sort_values("acceleration", kind="stable")
    if edges.empty:
        return
    rest = parameters.copy()
    rest["z0"], rest["vz0"] = REST
    # The amplitude whose critical height is closest to rest is the initial guess.
    rest = replace_parameters(rest, acceleration=edges.acceleration.iloc[int(np.argmin(abs(edges.z0 - rest["z0"])))])
    yield differentiate_boundary("critical_amplitude", rest, "acceleration", REACH["acceleration"])
    # Evenly spaced rows without the first and the last one.
    inner = np.linspace(0, len(edges) - 1, heights + 2)[1:-1].round().astype(int)
    for edge in edges.iloc[np.unique(inner)].itertuples():
        here = replace_parameters(parameters, acceleration=edge.acceleration)
        here["z0"] = edge.z0
        yield differentiate_boundary("critical_height", here, "z0", REACH["z0"])


def make(
    folds_and_doublings: pd.DataFrame, cascade: pd.DataFrame, critical: pd.DataFrame, settings: dict
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of both tables, by their kinds, for the section `sensitivity` of the config."""
    parameters = grid.row_of(settings["model"])
    doublings = max(1, round(settings["effort"] * DOUBLINGS))
    chosen = select_bifurcations(parameters, folds_and_doublings, cascade, doublings)
    bifurcations = [differentiate_bifurcation(parameters, bifurcation) for bifurcation in chosen]
    accumulation = differentiate_accumulation(parameters, [point for point in bifurcations if point.doubling])
    heights = max(1, round(settings["effort"] * HEIGHTS))
    points = [*bifurcations, *([accumulation] if accumulation else []), *boundary_points(critical, heights)]
    physical = [row for point in points for row in physical_rows(point)]
    groups = [row for point in points for row in group_rows(point)]
    return {
        "derivatives": fields.columns(physical, TABLES["derivatives"]),
        "groups": fields.columns(groups, TABLES["groups"]),
    }
