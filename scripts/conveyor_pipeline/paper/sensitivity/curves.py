"""Curves of folds, period doublings and the lift-off of a riding part over the amplitude and a second parameter."""

import numpy as np
import pandas as pd

from conveyor import amplitude_of
from conveyor.analysis.bifurcations.bifurcation_curves import (
    PATHS,
    BifurcationCurve,
    follow_bifurcation_curve,
    follow_grazing_curve,
)
from conveyor.analysis.bifurcations.bifurcation_points import GRAZING, BifurcationPoint
from conveyor.parallel import for_each_chunk
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.paper.sensitivity.selection import COLUMNS, Selected, select_bifurcations

CURVE = (
    fields.text("kind", "fold, period_doubling or grazing (at which a riding part begins to leave the plate)"),
    fields.count("period", "excitation cycles"),
    *COLUMNS,
    fields.number("begin", "m/s²", "amplitude of the bifurcation for the conveyor of the config"),
    fields.text("parameter", "varied parameter besides the amplitude"),
)
PLACE = (
    fields.number("value", "see parameter", "value of the varied parameter, in its SI unit"),
    fields.number("acceleration", "m/s²", "amplitude of the excitation"),
    fields.number("amplitude_group", "1", "Γ = a_z/g"),
    fields.number("damping_group", "1", "D = d_c/(m ω)"),
    fields.number("stiffness_group", "1", "K = (k_c/m) g^(p-1)/ω^(2p)"),
)
TABLES = {
    "continued": (
        *CURVE,
        fields.count("point", "number of the point along its curve"),
        *PLACE,
        fields.text("status", "ok, or at the ends of a curve the reason why it ends"),
    ),
    "meetings": (
        *CURVE,
        fields.text("meeting", "kind of the codimension-two point: cusp, generalised doubling, or grazing"),
        *PLACE,
        fields.text("status", "ok, or the reason why the point is only near the meeting"),
    ),
}
VARIED = ("damping", "stiffness", "frequency")
DOUBLINGS = 3  # of the cascade, by an effort of 1
POINTS = 250  # on each side of a curve, after which it ends
ENDS = {
    "limit": "limit of the config",
    "step": "no smooth curve beyond",
    "length": f"after {POINTS} points",
    "closed": "closed",
    "lost": "no orbit beyond",
    "period halving": "the orbit has half the period here",
}
LIMITS = (0.1, 5.0)  # a_z/g, within which curves are followed
STEP = 0.1  # longest step in x, y, log of a_z/g and log of the parameter
STEEPEST = 0.49 * np.pi  # rad, largest angle of throw of a curve


def place_columns(parameters: np.ndarray, point: BifurcationPoint, parameter: str, part: float) -> dict:
    """The columns with the parameters and groups of a point; `part` is the logarithm of the factor on `parameter`."""
    conveyor = parameters.copy()
    conveyor[parameter] *= np.exp(part)
    groups = point.groups
    return {
        "value": float(conveyor[parameter]),
        "acceleration": amplitude_of(conveyor, groups.amplitude),
        "amplitude_group": groups.amplitude,
        "damping_group": groups.damping,
        "stiffness_group": groups.stiffness,
    }


def angle_curve(point: BifurcationPoint, angle: float, reach: float) -> BifurcationCurve:
    """The curve over the angle of throw (rad), on which Γ is constant, so that â is proportional to 1/sin φ.

    reach : largest logarithm of the factor on the angle
    """
    highest = min(reach, np.log(STEEPEST / angle))
    parts = np.linspace(-reach, highest, 2 * int(np.ceil(reach / STEP)) + 1)
    count = len(parts)
    ends = "limit", "limit"
    return BifurcationCurve([point] * count, parts, np.full(count, np.nan), [], ends)


def follow_curve(parameters: np.ndarray, point: BifurcationPoint, parameter: str, factor: float) -> BifurcationCurve:
    """The curve of a bifurcation over a parameter, to a largest `factor` by which it decreases and increases."""
    reach = np.log(factor)
    if parameter == "angle":
        return angle_curve(point, parameters["angle"], reach)
    path = PATHS[parameter](point.groups.exponent)
    limits = LIMITS, (-reach, reach)
    if point.kind == GRAZING:
        return follow_grazing_curve(point, path, *limits, step=0.5 * STEP)
    return follow_bifurcation_curve(point, path, *limits, longest_step=STEP, max_points=POINTS)


def curve_rows(
    parameters: np.ndarray, bifurcation: Selected, parameter: str, curve: BifurcationCurve
) -> tuple[list[dict], list[dict]]:
    """The rows of the points and of the meetings of a curve."""
    name = {
        "kind": bifurcation.kind,
        "period": bifurcation.period,
        "doubling": bifurcation.doubling,
        "rides": bifurcation.rides,
        "begin": bifurcation.acceleration,
        "parameter": parameter,
    }
    last = len(curve.points) - 1
    points = []
    for n, (point, part) in enumerate(zip(curve.points, curve.log_ratios, strict=True)):
        end = curve.ends[0] if n == 0 else curve.ends[1] if n == last else None
        columns = {"point": n, "status": ENDS.get(end, "ok")}
        points.append({**name, **place_columns(parameters, point, parameter, part), **columns})
    meetings = [
        {
            **name,
            **place_columns(parameters, meeting.point, parameter, meeting.log_ratio),
            "meeting": meeting.kind,
            "status": meeting.status,
        }
        for meeting in curve.meetings
    ]
    return points, meetings


def make(
    folds_and_doublings: pd.DataFrame,
    cascade: pd.DataFrame,
    settings: dict,
    *,
    progress: str | None = None,
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of both tables, by their kinds, for the section `sensitivity` of the config."""
    parameters = grid.row_of(settings["model"])
    doublings = max(1, round(settings["effort"] * DOUBLINGS))
    chosen = select_bifurcations(parameters, folds_and_doublings, cascade, doublings)
    chosen = [choice for choice in chosen if choice.point is not None and (choice.kind != GRAZING or choice.rides)]
    tasks = [(bifurcation, parameter) for bifurcation in chosen for parameter in VARIED]
    tasks += [(bifurcation, "angle") for bifurcation in chosen]
    rows_of_curves = [None] * len(tasks)

    def work(begin, end):
        for n in range(begin, end):
            bifurcation, parameter = tasks[n]
            curve = follow_curve(parameters, bifurcation.point, parameter, settings["factors"][parameter])
            rows_of_curves[n] = curve_rows(parameters, bifurcation, parameter, curve)

    for_each_chunk(work, len(tasks), chunk=1, progress=progress)
    return {
        "continued": fields.columns([row for rows, _ in rows_of_curves for row in rows], TABLES["continued"]),
        "meetings": fields.columns([row for _, rows in rows_of_curves for row in rows], TABLES["meetings"]),
    }
