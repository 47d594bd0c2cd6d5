"""How bifurcations and critical heights move with each parameter, and the same with each dimensionless group."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor.analysis.basins import boundary_point
from conveyor.analysis.basins.boundary_point import InitialCondition
from conveyor.analysis.bifurcations import bifurcation_points, doubling_cascade
from conveyor.analysis.dimensionless_groups import (
    AMPLITUDE,
    HEIGHT,
    NAMES,
    amplitude_of,
    derivatives_of,
    groups_of,
    start_of,
    units,
)
from conveyor.solver.model import ACCELERATION, PARAMETERS, UNITS, VZ0, Z0
from pipeline import fields, grid
from sensitivity.selection import COLUMNS, Selected, at, selected

MOVED = (
    fields.text("kind", "fold, period_doubling, grazing, accumulation, critical_amplitude or critical_height"),
    fields.count("period", "excitation cycles; 0 where there is none"),
    fields.number("acceleration", "m/s²", "amplitude of the excitation"),
    fields.number("z0", "m", "height of the start; null where there is none"),
    *COLUMNS,
)
TABLES = {
    "derivatives": (
        *MOVED,
        fields.text("moved", "what moves: acceleration or z0"),
        fields.text("moved_unit", "its unit"),
        fields.text("parameter", "what it moves with, everything else being equal"),
        fields.text("parameter_unit", "its unit"),
        fields.number("value", "that of parameter_unit", "the parameter"),
        fields.number("derivative", "moved_unit per parameter_unit", "by the implicit function theorem"),
        fields.number("difference", "moved_unit per parameter_unit", "the same from points solved again"),
        fields.number(
            "elasticity", "1", "relative change of what moves over that of the parameter; null where one is 0"
        ),
        fields.text("status", "ok, or why there is no result, or that both ways disagree"),
    ),
    "groups": (
        *MOVED,
        fields.text("moved", "amplitude: Γ = a_z/g, or height: z0 ω²/g"),
        fields.number("moved_value", "1", "its value"),
        fields.text(
            "group", "damping: d_c/(m ω); stiffness: (k_c/m) g^(p-1)/ω^(2p); exponent; height; velocity: ż0 ω/g"
        ),
        fields.number("value", "1", "of the group"),
        fields.number("derivative", "1", "of what moves by the group"),
        fields.number("elasticity", "1", "relative change of what moves over that of the group; null where one is 0"),
        fields.text("status", "ok, or why there is no result"),
    ),
}
# Groups that move each kind: a start has some of its own.
OF_ORBITS, OF_STARTS = ("damping", "stiffness", "exponent"), NAMES[:-1]
STARTS = ("z0", "vz0")
# What is no number, and parameters of the motion along the track besides friction.
NEVER = ("tension", "phase_shift", "static_friction")


class Moved(NamedTuple):
    """Something that moves with the parameters."""

    kind: str
    period: int
    parameters: np.ndarray  # packed, at which it is
    doubling: int
    rides: bool
    moved: str  # acceleration or z0
    by: np.ndarray | None  # derivatives of its group by all groups, shape (7,)
    again: Callable[[np.ndarray], float]  # its value (m/s² or m) for other parameters, NaN where it is not found
    status: str

    @property
    def of_start(self) -> bool:
        return self.kind.startswith("critical")


def move_bifurcation(parameters: np.ndarray, one: Selected) -> Moved:
    """A bifurcation of an orbit."""
    moves = None if one.point is None else bifurcation_points.differentiate_unknowns(one.point)
    here = at(parameters, one.acceleration)
    if moves is None:
        status = "not found again" if one.point is None else "singular"
        return Moved(
            one.kind, one.period, here, one.doubling, one.rides, "acceleration", None, lambda row: np.nan, status
        )
    by = np.zeros(len(NAMES))
    by[1:4] = moves[-1]
    here = at(parameters, amplitude_of(parameters, one.point.groups.amplitude))
    found: dict[tuple, float] = {}

    def again(row):
        groups = groups_of(row)
        if (key := groups[1:]) not in found:
            change = np.array(key[:3]) - one.point.groups[1:4]
            there = bifurcation_points.find_bifurcation(
                one.kind, one.period, one.point.unknown + moves @ change, groups
            )
            found[key] = np.nan if there is None else there.groups.amplitude
        return amplitude_of(row, found[key])

    return Moved(one.kind, one.period, here, one.doubling, one.rides, "acceleration", by, again, "ok")


def weights(a: float, b: float, c: float) -> np.ndarray:
    """Derivatives of the limit a - (b - a)²/(c - 2b + a) of Aitken's process by the three amplitudes, shape (3,)."""
    part = (b - a) / (c - 2.0 * b + a)
    return np.array([(1.0 + part) ** 2, -2.0 * part * (1.0 + part), part**2])


def move_accumulation(parameters: np.ndarray, doublings: list[Moved]) -> Moved | None:
    """Where the doublings accumulate; None where there are not four of them, or one was not found again."""
    if len(doublings) < 4 or any(one.by is None for one in doublings):
        return None
    last = doublings[-4:]
    amplitudes = np.array([one.parameters[ACCELERATION] for one in last])
    by = weights(*amplitudes[1:]) @ np.array([one.by for one in last[1:]])

    def again(row):
        return doubling_cascade.accumulation(np.array([one.again(row) for one in last]))[0]

    here = at(parameters, doubling_cascade.accumulation(amplitudes)[0])
    return Moved("accumulation", 0, here, 0, False, "acceleration", by, again, "ok")


def find_boundary_point(kind: str, parameters: np.ndarray, unknown: int) -> Moved:
    """A start near the edge of a basin, moved onto it."""
    moved = "acceleration" if unknown == AMPLITUDE else "z0"

    def find_bifurcation(row):
        return boundary_point.find_boundary_point(InitialCondition(*start_of(row)), groups_of(row), unknown)

    edge = find_bifurcation(parameters)
    if isinstance(edge, str):
        return Moved(kind, 0, parameters, 0, False, moved, None, lambda row: np.nan, edge)
    here = parameters.copy()
    here[PARAMETERS.index(moved)] = value_of(edge, parameters, unknown)

    def again(row):
        there = find_bifurcation(row)
        return np.nan if isinstance(there, str) else value_of(there, row, unknown)

    return Moved(kind, edge.period, here, 0, False, moved, edge.moves, again, "ok")


def value_of(edge: boundary_point.BoundaryPoint, row: np.ndarray, unknown: int) -> float:
    """What was unknown of an edge, in m/s² or m."""
    if unknown == AMPLITUDE:
        return amplitude_of(row, edge.groups.amplitude)
    return edge.launch.height * units(row)[0]


def steps_of(parameters: np.ndarray, difference: float) -> dict[str, float]:
    """Step of the differences by each parameter: relative, for those of a start in parts of its scale."""
    length, velocity = units(parameters)
    scales = dict(zip(PARAMETERS, np.abs(parameters), strict=True)) | {"psi0": 1.0, "z0": length, "vz0": velocity}
    scales = {name: scale if scale > 0.0 else 1.0 for name, scale in scales.items()}
    return {name: difference * float(scale) for name, scale in scales.items()}


def about(one: Moved) -> dict:
    """The columns that both tables share."""
    row = one.parameters
    return {
        "kind": one.kind,
        "period": one.period,
        "acceleration": row[0],
        "z0": row[Z0] if one.of_start else np.nan,
        "doubling": one.doubling,
        "rides": one.rides,
        "moved": one.moved,
    }


def physical_rows(one: Moved, difference: float, agreement: float) -> Iterator[dict]:
    """One row for each parameter."""
    exact = None if one.by is None else derivatives_of(one.moved, one.parameters, one.by)
    moved = one.parameters[PARAMETERS.index(one.moved)]
    for name, step in steps_of(one.parameters, difference).items():
        place = PARAMETERS.index(name)
        value = one.parameters[place]
        # A level track is where gravity normal to it is largest: to first order nothing moves with its inclination.
        if (
            name in (one.moved, *NEVER)
            or (name in STARTS and not one.of_start)
            or (name == "inclination" and not value)
        ):
            continue
        row = {
            **about(one),
            "moved_unit": UNITS[one.moved],
            "parameter": name,
            "parameter_unit": UNITS[name],
            "value": value,
            "derivative": np.nan,
            "difference": np.nan,
            "elasticity": np.nan,
            "status": one.status,
        }
        if exact is not None:
            ends = []
            for sign in (1.0, -1.0):
                there = one.parameters.copy()
                there[place] += sign * step
                ends.append(one.again(there))
            row["derivative"], row["difference"] = exact[name], (ends[0] - ends[1]) / (2.0 * step)
            row["elasticity"] = exact[name] * value / moved if value != 0.0 and moved != 0.0 else np.nan
            # In what the step is a part of, over the scale of what moves.
            scale = step / difference / (abs(moved) if one.moved == "acceleration" else units(one.parameters)[0])
            error = scale * abs(row["derivative"] - row["difference"])
            if not error <= agreement * max(1.0, scale * abs(row["derivative"])):
                row["status"] = "differences disagree" if np.isfinite(error) else "not found again beside it"
        yield row


def group_rows(one: Moved) -> Iterator[dict]:
    """One row for each group."""
    own = AMPLITUDE if one.moved == "acceleration" else HEIGHT
    groups = np.array([*groups_of(one.parameters)[:4], *start_of(one.parameters)])
    for name in OF_STARTS if one.of_start else OF_ORBITS:
        place = NAMES.index(name)
        if place == own:
            continue
        derivative = np.nan if one.by is None else one.by[place]
        relative = groups[place] / groups[own] if groups[place] != 0.0 and groups[own] != 0.0 else np.nan
        yield {
            **about(one),
            "moved": NAMES[own],
            "moved_value": groups[own],
            "group": name,
            "value": groups[place],
            "derivative": derivative,
            "elasticity": derivative * relative,
            "status": one.status,
        }


def starts(critical: pd.DataFrame, settings: dict) -> Iterator[Moved]:
    """The critical amplitude of the start at rest, and critical heights."""
    parameters = grid.packed({**critical.attrs["model"], "z0": 0.0})
    edges = critical[critical.is_critical].sort_values("acceleration")
    rest = parameters.copy()
    rest[Z0], rest[VZ0] = settings["rest"]["z0"], settings["rest"]["vz0"]
    if len(edges):
        # The start on the edge next to the one at rest is a guess of it.
        rest = at(rest, edges.acceleration.iloc[int(np.argmin(abs(edges.z0 - rest[Z0])))])
    yield find_boundary_point("critical_amplitude", rest, AMPLITUDE)
    # Evenly among them, without the first and the last one.
    inner = np.linspace(0, len(edges) - 1, settings["heights"] + 2)[1:-1].round().astype(int)
    for edge in edges.iloc[np.unique(inner)].itertuples() if len(edges) else ():
        here = at(parameters, edge.acceleration)
        here[Z0] = edge.z0
        yield find_boundary_point("critical_height", here, HEIGHT)


def columns(rows: list[dict], kind: str) -> dict[str, np.ndarray]:
    """Rows as the columns of a kind of table."""
    return {column.name: np.array([row[column.name] for row in rows]) for column in TABLES[kind]}


def make(
    folds_and_doublings: pd.DataFrame, cascade: pd.DataFrame, critical: pd.DataFrame, settings: dict
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of both tables, by their kinds, for the section `sensitivity` of the config."""
    parameters = grid.packed(settings["model"])
    chosen = selected(parameters, folds_and_doublings, cascade, settings["longest_period"], settings["doublings"])
    bifurcations = [move_bifurcation(parameters, one) for one in chosen]
    accumulation = move_accumulation(parameters, [one for one in bifurcations if one.doubling])
    moved = [*bifurcations, *([accumulation] if accumulation else []), *starts(critical, settings)]
    physical = [row for one in moved for row in physical_rows(one, settings["difference"], settings["agreement"])]
    groups = [row for one in moved for row in group_rows(one)]
    return {
        "derivatives": fields.columns(physical, TABLES["derivatives"]),
        "groups": fields.columns(groups, TABLES["groups"]),
    }
