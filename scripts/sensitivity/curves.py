"""Folds and period doublings, and the lift-off of a riding part, in two parameters: the amplitude and another one."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from conveyor.analysis.bifurcations import bifurcation_curves
from conveyor.analysis.bifurcations.bifurcation_curves import Curve, Path
from conveyor.analysis.bifurcations.bifurcation_points import GRAZING, Point
from conveyor.analysis.dimensionless_groups import amplitude_of
from conveyor.solver.model import ANGLE, PARAMETERS, UNITS
from conveyor.solver.parallel import for_each_chunk
from pipeline import fields, grid
from sensitivity.selection import COLUMNS, Selected, selected

OF_CURVE = (
    fields.text("kind", "fold, period_doubling or grazing (where a riding part begins to leave the plate)"),
    fields.count("period", "excitation cycles"),
    *COLUMNS,
    fields.number("begin", "m/s²", "amplitude at which the conveyor of the config has this bifurcation"),
    fields.text("parameter", "what is changed beside the amplitude"),
    fields.text("parameter_unit", "its unit"),
)
PLACE = (
    fields.number("value", "that of parameter_unit", "the parameter"),
    fields.number("acceleration", "m/s²", "amplitude of the excitation"),
    fields.number("amplitude_group", "1", "Γ = a_z/g"),
    fields.number("damping_group", "1", "D = d_c/(m ω)"),
    fields.number("stiffness_group", "1", "K = (k_c/m) g^(p-1)/ω^(2p)"),
)
TABLES = {
    "continued": (
        *OF_CURVE,
        fields.count("point", "number of the point along its curve"),
        *PLACE,
        fields.count("impacts", "impacts of the orbit per period"),
        fields.number(
            "normal_form", "1", "coefficient whose zero is a cusp or a generalised doubling; null for a grazing"
        ),
        fields.text("status", "ok, or at the ends of a curve why it goes no further"),
    ),
    "meetings": (
        *OF_CURVE,
        fields.text("meeting", "cusp, generalised doubling, or grazing"),
        *PLACE,
        fields.text("status", "ok, or why the place is only near the meeting"),
    ),
}
# How the groups D and K follow a parameter; the angle leaves both alone.
POWERS = {
    "damping": lambda p: Path(1.0, 0.0),
    "stiffness": lambda p: Path(0.0, 1.0),
    "frequency": lambda p: Path(-1.0, -2.0 * p),
}
ENDS = {
    bifurcation_curves.LIMIT: "limit of the config",
    bifurcation_curves.STEP: "no smooth curve beyond",
    bifurcation_curves.LENGTH: "number of points of the config",
    bifurcation_curves.CLOSED: "closed",
    bifurcation_curves.LOST: "no orbit beyond",
    bifurcation_curves.HALVED: "the orbit has half the period here",
}
STEEPEST = 0.49 * np.pi  # rad, of an angle of throw that is looked at


def curve_columns(one: Selected, parameter: str) -> dict:
    """The columns that name a curve."""
    return {
        "kind": one.kind,
        "period": one.period,
        "doubling": one.doubling,
        "rides": one.rides,
        "begin": one.acceleration,
        "parameter": parameter,
        "parameter_unit": UNITS[parameter],
    }


def place(parameters: np.ndarray, point: Point, parameter: str, part: float) -> dict:
    """Where a point of a curve is, in parameters and in groups."""
    here = parameters.copy()
    here[PARAMETERS.index(parameter)] *= np.exp(part)
    groups = point.groups
    return {
        "value": here[PARAMETERS.index(parameter)],
        "acceleration": amplitude_of(here, groups.amplitude),
        "amplitude_group": groups.amplitude,
        "damping_group": groups.damping,
        "stiffness_group": groups.stiffness,
    }


def follow_curve(point: Point, parameter: str, settings: dict) -> Curve:
    """The curve of a bifurcation."""
    path = POWERS[parameter](point.groups.exponent)
    reach = np.log(settings["factors"][parameter])
    limits = tuple(settings["amplitude"]), (-reach, reach)
    if point.kind == GRAZING:
        return bifurcation_curves.follow_grazing(point, path, *limits, step=0.5 * settings["step"])
    return bifurcation_curves.follow(point, path, *limits, longest_step=settings["step"], most=settings["points"])


def rows_of_curve(parameters: np.ndarray, one: Selected, parameter: str, curve: Curve) -> tuple[list[dict], list[dict]]:
    """The rows of its points and of its meetings."""
    name = curve_columns(one, parameter)
    last = len(curve.points) - 1
    points = []
    for n, (point, part, form, impacts) in enumerate(
        zip(curve.points, curve.parts, curve.normal_forms, curve.impacts, strict=True)
    ):
        end = curve.ends[0] if n == 0 else curve.ends[1] if n == last else None
        about = {"point": n, "impacts": impacts, "normal_form": form, "status": ENDS.get(end, "ok")}
        points.append({**name, **place(parameters, point, parameter, part), **about})
    meetings = [
        {**name, **place(parameters, one.point, parameter, one.part), "meeting": one.kind, "status": one.status}
        for one in curve.meetings
    ]
    return points, meetings


def rows_over_angle(parameters: np.ndarray, one: Selected, settings: dict) -> Iterator[dict]:
    """The curve over the angle of throw: Γ stays, so that â goes with 1/sin φ."""
    reach = np.log(settings["factors"]["angle"])
    highest = min(reach, np.log(STEEPEST / parameters[ANGLE]))
    parts = np.linspace(-reach, highest, 2 * int(np.ceil(reach / settings["step"])) + 1)
    for n, part in enumerate(parts):
        end = n in (0, len(parts) - 1)
        about = {"point": n, "impacts": 0, "normal_form": np.nan, "status": "limit of the config" if end else "ok"}
        yield {**curve_columns(one, "angle"), **place(parameters, one.point, "angle", part), **about}


def make(
    folds_and_doublings: pd.DataFrame,
    cascade: pd.DataFrame,
    settings: dict,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of both tables, by their kinds, for the section `sensitivity` of the config."""
    parameters = grid.packed(settings["model"])
    chosen = selected(
        parameters, folds_and_doublings, cascade, settings["longest_period"], settings["curves"]["doublings"]
    )
    chosen = [one for one in chosen if one.point is not None and (one.kind != GRAZING or one.rides)]
    tasks = [(one, parameter) for one in chosen for parameter in POWERS]
    found = [None] * len(tasks)

    def work(begin, end):
        for n in range(begin, end):
            one, parameter = tasks[n]
            found[n] = rows_of_curve(parameters, one, parameter, follow_curve(one.point, parameter, settings["curves"]))

    for_each_chunk(work, len(tasks), threads=threads, chunk=1, progress=progress)
    points = [row for rows, _ in found for row in rows]
    points += [row for one in chosen for row in rows_over_angle(parameters, one, settings["curves"])]
    return {
        "continued": fields.columns(points, TABLES["continued"]),
        "meetings": fields.columns([row for _, rows in found for row in rows], TABLES["meetings"]),
    }
